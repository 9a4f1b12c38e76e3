//! One module a format; each makes a `Raw` of bytes.

pub(crate) mod gltf;
pub(crate) mod mtl;
pub(crate) mod obj;
pub(crate) mod ply;
pub(crate) mod stl;

use crate::error::Warnings;
use crate::image::load_image;
use crate::load::Limits;
use crate::model::Image;
use std::path::{Path, PathBuf};

/// A file's content and where it comes from.
pub(crate) struct Source<'a> {
    /// For messages.
    pub name: &'a str,
    pub bytes: &'a [u8],
    /// Folder of the file, for files that it refers to.
    pub base: Option<&'a Path>,
    pub limits: &'a Limits,
}

impl Source<'_> {
    /// Why a file that this one names is not there, and what to do; to follow its name.
    pub(crate) fn missing(&self, folders: &[&Path]) -> String {
        if folders.is_empty() {
            format!("is not read: {} has no folder to look in; name the model's file", self.name)
        } else {
            "not found; put it beside the model".into()
        }
    }
}

/// Finds a file that another file names, as forgiving as users expect: backslashes, absolute paths of somebody else's
/// computer (tried beside the referring file), other capitals. Only regular files count.
pub(crate) fn find_file(name: &str, folders: &[&Path]) -> Option<PathBuf> {
    let name = name.trim().trim_matches('"').replace('\\', "/");
    if name.is_empty() || name.contains('\0') {
        return None;
    }
    let last = name.rsplit('/').next().unwrap_or(&name);
    for folder in folders {
        // `join` with an absolute path gives that path.
        for candidate in [folder.join(&name), folder.join(last)] {
            if candidate.is_file() {
                return Some(candidate);
            }
        }
    }
    let lower = last.to_lowercase();
    folders.iter().find_map(|folder| {
        let mut found: Vec<_> = std::fs::read_dir(folder)
            .ok()?
            .take(10_000)
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|p| p.file_name().is_some_and(|n| n.to_string_lossy().to_lowercase() == lower))
            .filter(|p| p.is_file())
            .collect();
        found.sort();
        found.into_iter().next()
    })
}

/// Textures of one model, each file loaded once; missing or broken ones are warnings.
#[derive(Default)]
pub(crate) struct Textures {
    known: Vec<(PathBuf, Option<usize>)>,
}

/// Distinct textures a model may have.
const TEXTURES: usize = 256;

impl Textures {
    /// The index in `images` of the texture called `name`.
    pub(crate) fn load(
        &mut self,
        name: &str,
        folders: &[&Path],
        source: &Source<'_>,
        images: &mut Vec<Image>,
        warnings: &mut Warnings,
    ) -> Option<usize> {
        let Some(path) = find_file(name, folders) else {
            warnings.warn(format!("texture '{name}' {}", source.missing(folders)));
            return None;
        };
        if let Some((_, index)) = self.known.iter().find(|(known, _)| *known == path) {
            return *index;
        }
        if self.known.len() >= TEXTURES {
            warnings.warn(format!("more than {TEXTURES} textures; the rest are ignored"));
            return None;
        }
        let index = match load_image(&path, source.limits) {
            Ok((image, notes)) => {
                notes.into_iter().for_each(|w| warnings.warn(w.text));
                images.push(image);
                Some(images.len() - 1)
            }
            Err(error) => {
                warnings.warn(error.to_string());
                None
            }
        };
        self.known.push((path, index));
        index
    }
}
