//! A folder of pictures as a film.

use std::path::{Path, PathBuf};

use crate::error::{VideoError, name_of};

/// The pictures in a folder, by name; numbers without leading zeros count as numbers.
pub fn pictures(folder: &Path) -> Result<Vec<PathBuf>, VideoError> {
    let name = name_of(folder);
    let entries = std::fs::read_dir(folder).map_err(|error| VideoError::io(&name, &error))?;
    let known = |path: &PathBuf| {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        ["png", "jpg", "jpeg", "ppm", "pgm"].contains(&ending.as_str())
    };
    let mut paths: Vec<PathBuf> =
        entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).filter(known).collect();
    if paths.is_empty() {
        let what = "there is no picture in this folder";
        return Err(VideoError::end(&name, what, "it must hold PNG, JPEG, PPM or PGM files"));
    }
    paths.sort_by_cached_key(|path| key(&path.file_name().unwrap_or_default().to_string_lossy()));
    Ok(paths)
}

/// Text and numbers in turn.
fn key(name: &str) -> Vec<(String, u64)> {
    let mut parts = vec![(String::new(), 0u64)];
    let mut in_number = false;
    for character in name.chars() {
        let digit = character.to_digit(10);
        if digit.is_none() && in_number {
            parts.push((String::new(), 0));
        }
        in_number = digit.is_some();
        let Some(last) = parts.last_mut() else { break };
        match digit {
            Some(digit) => last.1 = last.1.saturating_mul(10).saturating_add(digit.into()),
            None => last.0.push(character),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_comes_after_nine() {
        let mut names = ["a10.png", "a9.png", "a009b.png", "b1.png"];
        names.sort_by_cached_key(|name| key(name));
        assert_eq!(names, ["a9.png", "a009b.png", "a10.png", "b1.png"]);
    }
}
