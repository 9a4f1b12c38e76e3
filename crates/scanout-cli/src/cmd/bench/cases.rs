//! What `scanout bench` draws, and what the pixels of its own cases are.

use std::path::PathBuf;

use scanout_bench::lines::{self, Line};
use scanout_bench::scenes::{self, Data};

use super::LINES;
use crate::cmd::demo::model;
use crate::error::{Error, Result};
use crate::scene_builder::load_model;

/// The cases without any option.
const STANDARD: [&str; 19] = [
    "5000:flat:320x240",
    "5000:gouraud:320x240",
    "5000:textured:320x240",
    "5000:wire:320x240",
    "5000:phong:320x240",
    "5000:hidden:320x240",
    "70000:flat:640x480",
    "70000:gouraud:640x480",
    "70000:textured:640x480",
    "earth:textured:640x480",
    "earth:wire:640x480",
    "teapot:gouraud:640x480",
    "teapot:hidden:640x480",
    "empty:flat:640x480",
    "fill:flat:640x480",
    "fill:gouraud:640x480",
    "fill:textured:640x480",
    "lines:long:320x240",
    "lines:short:320x240",
];

/// How a model of the user's is drawn.
const LOOKS: [&str; 4] = ["flat", "gouraud", "textured", "wire"];

/// Names and frame hashes of the standard cases, one a line; the test of the program writes them when blessed.
const HASHES: &str = include_str!("hashes.txt");

/// Something to measure.
pub struct Case {
    /// `SOURCE:LOOK:WIDTHxHEIGHT`, or `lines:...`.
    pub name: String,
    /// What is drawn.
    pub content: Content,
}

/// What a case draws.
pub enum Content {
    /// A frame of a scene.
    Frame(Box<Data>),
    /// A thousand lines.
    Lines(Vec<Line>),
}

impl Case {
    /// The hash of the frame, if it is known.
    pub fn expected(&self) -> Option<u64> {
        HASHES.lines().find_map(|line| {
            let hash = line.strip_prefix(&*self.name)?.trim();
            u64::from_str_radix(hash, 16).ok()
        })
    }

    /// Pixels that one run draws.
    pub fn pixels(&self) -> u64 {
        match &self.content {
            Content::Frame(data) => data.pixels(),
            Content::Lines(lines) => (lines::mean_pixels(lines) * LINES as f64).round() as u64,
        }
    }
}

/// The cases that the options ask for, in the standard order, then the user's models, then the user's own names.
pub fn chosen(words: &[String], models: &[PathBuf]) -> Result<Vec<Case>> {
    let (own, words): (Vec<_>, Vec<_>) = words
        .iter()
        .partition(|word| word.matches(':').count() >= 2 && !STANDARD.contains(&word.as_str()));
    let wanted =
        |name: &str| words.is_empty() && own.is_empty() || words.iter().any(|w| name.contains(*w));
    let mut cases = Vec::new();
    // With models of the user's own and no words, those alone.
    if models.is_empty() || !words.is_empty() {
        for name in STANDARD.into_iter().filter(|name| wanted(name)) {
            cases.push(standard(name)?);
        }
    }
    for path in models {
        let source = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        let names = LOOKS.map(|look| format!("{source}:{look}:640x480"));
        let names: Vec<_> = names.iter().filter(|name| wanted(name)).collect();
        if names.is_empty() {
            continue;
        }
        let model = load_model(path, None)?;
        for name in names {
            let data = Data::of_model(parsed(name)?, model.clone());
            cases.push(Case { name: name.clone(), content: Content::Frame(Box::new(data)) });
        }
    }
    for name in own {
        cases.push(standard(name)?);
    }
    if cases.is_empty() {
        let sources = "5000, 70000, earth, teapot, empty, fill, lines, flat, gouraud, textured";
        return Err(Error::usage(
            "no case has one of these words in its name",
            format_args!("try one of {sources}, or leave --cases away"),
        ));
    }
    Ok(cases)
}

fn parsed(name: &str) -> Result<scenes::Case> {
    let remedy = "for example 5000:phong:800x600 or models/torus.obj:flat:320x240";
    scenes::Case::parse(name).map_err(|what| Error::usage(what, remedy))
}

/// A case by its name alone.
fn standard(name: &str) -> Result<Case> {
    if let Some(rest) = name.strip_prefix("lines:") {
        let lines = match rest.split(':').next() {
            Some("long") => lines::long(),
            Some("short") => lines::short(),
            _ => return Err(Error::usage(format_args!("{name}: no such lines"), "long or short")),
        };
        return Ok(Case { name: name.into(), content: Content::Lines(lines) });
    }
    let case = parsed(name)?;
    let data = match case.source.as_str() {
        "earth" => Data::of_model(case, model::earth()?),
        "teapot" => Data::of_model(case, model::teapot()?),
        _ => Data::new(case).map_err(Error::Failed)?,
    };
    Ok(Case { name: name.into(), content: Content::Frame(Box::new(data)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(words: &[&str]) -> Vec<String> {
        let words: Vec<String> = words.iter().map(ToString::to_string).collect();
        chosen(&words, &[]).unwrap().into_iter().map(|case| case.name).collect()
    }

    #[test]
    fn words_choose() {
        assert_eq!(names(&[]), STANDARD);
        assert_eq!(names(&["lines"]), ["lines:long:320x240", "lines:short:320x240"]);
        assert_eq!(names(&["5000:wire", "empty"]), ["5000:wire:320x240", "empty:flat:640x480"]);
        assert_eq!(names(&["400:phong:8x6"]), ["400:phong:8x6"]);
        assert_eq!(names(&["5000:flat:320x240"]), ["5000:flat:320x240"]);
        assert!(chosen(&["flatt".into()], &[]).is_err());
        assert!(chosen(&["400:flatt:8x6".into()], &[]).is_err());
    }

    #[test]
    fn every_standard_case_has_a_hash() {
        for case in chosen(&[], &[]).unwrap() {
            assert!(case.expected().is_some(), "{}", case.name);
        }
    }

    #[test]
    fn a_fill_counts_all_its_sheets_and_lines_their_own_pixels() {
        let pixels = |word: &str| chosen(&[word.into()], &[]).unwrap()[0].pixels();
        assert_eq!(pixels("fill:flat"), 8 * 640 * 480);
        assert_eq!(pixels("teapot:gouraud"), 640 * 480);
        assert!((130_000..140_000).contains(&pixels("lines:long")));
    }
}
