//! OBJ through the streaming parser, with its materials and textures.

use super::{Source, Textures, find_file, mtl};
use crate::error::{At, LoadError};
use crate::load::read_file;
use crate::model::MaterialBuf;
use crate::obj::{self, Element, Event};
use crate::raw::{Corner, NONE, Raw, SMOOTHING_UNSPECIFIED, UvMap, usable};
use std::collections::HashMap;

/// Bytes fed between two checks of the limits.
const CHUNK: usize = 1 << 20;

struct State {
    raw: Raw,
    names: HashMap<String, u32>,
    libraries: Vec<String>,
    material: u32,
    smoothing: u32,
    element: Element,
    line_from: Option<u32>,
    /// Greatest index of each kind and the line that asks for it.
    needed: [(u64, u32); 3],
    any_colour: bool,
    colour_max: f64,
    colours: Vec<[f32; 3]>,
    short: u64,
    bad_line: Option<u32>,
    ignored: HashMap<String, u64>,
}

/// Reads the file; see [`crate::obj`] for what is understood.
pub(crate) fn read(source: &Source<'_>) -> Result<Raw, LoadError> {
    let mut state = State::new();
    let mut parser = obj::Parser::new();
    let fail = |error: obj::Error| {
        let text = error.to_string();
        let what = text.split_once(": ").map_or(text.as_str(), |(_, what)| what);
        LoadError::malformed(source.name, At::Line(error.line), what)
    };
    for chunk in source.bytes.chunks(CHUNK) {
        // Line numbers within a chunk are the parser's; events carry none, so elements note where they are.
        for line in chunk.split_inclusive(|&b| b == b'\n' || b == b'\r') {
            let at = parser.line();
            parser.feed(line, &mut |event| state.event(event, at)).map_err(fail)?;
        }
        state.raw.check(source.name, source.limits)?;
    }
    let at = parser.line();
    parser.finish(&mut |event| state.event(event, at)).map_err(fail)?;
    state.finish(source)
}

impl State {
    fn new() -> Self {
        let mut raw = Raw::default();
        raw.materials.push(MaterialBuf::default());
        Self {
            raw,
            names: HashMap::new(),
            libraries: Vec::new(),
            material: 0,
            smoothing: SMOOTHING_UNSPECIFIED,
            element: Element::Face,
            line_from: None,
            needed: [(0, 0); 3],
            any_colour: false,
            colour_max: 0.0,
            colours: Vec::new(),
            short: 0,
            bad_line: None,
            ignored: HashMap::new(),
        }
    }

    fn event(&mut self, event: Event<'_>, line: u32) {
        match event {
            Event::Position { xyz, colour } => {
                let xyz = xyz.map(|n| n.to_f64());
                if !usable(&xyz) {
                    self.bad_line.get_or_insert(line);
                }
                self.raw.positions.push(xyz);
                if colour.is_some() && !self.any_colour {
                    self.any_colour = true;
                    self.colours.resize(self.raw.positions.len() - 1, [1.0; 3]);
                }
                if self.any_colour {
                    let rgb = colour.map_or([1.0; 3], |c| c.map(|n| n.to_f64()));
                    self.colour_max = rgb.into_iter().fold(self.colour_max, f64::max);
                    self.colours.push(rgb.map(|c| c as f32));
                }
            }
            Event::Uv([u, v]) => self.raw.uvs.push([u.to_f64(), 1.0 - v.to_f64()]),
            Event::Normal(xyz) => self.raw.normals.push(xyz.map(|n| n.to_f64() as f32)),
            Event::Begin(element) => {
                self.element = element;
                self.line_from = None;
            }
            Event::Corner(corner) => self.corner(corner, line),
            Event::End => {
                if self.element == Element::Face {
                    let kept = self.raw.end_face(self.material, self.smoothing);
                    self.short += u64::from(!kept);
                }
            }
            Event::Material(name) => self.use_material(&String::from_utf8_lossy(name)),
            Event::Library(names) => {
                let names = String::from_utf8_lossy(names).into_owned();
                if self.libraries.len() < 256 && !self.libraries.contains(&names) {
                    self.libraries.push(names);
                }
            }
            Event::Smoothing(group) => self.smoothing = group.min(SMOOTHING_UNSPECIFIED - 1),
            Event::Object(_) | Event::Group(_) => {}
            Event::Ignored(word) => {
                if self.ignored.len() < 16 {
                    let word = word[..word.len().min(20)].escape_ascii().to_string();
                    *self.ignored.entry(word).or_default() += 1;
                }
            }
        }
    }

    fn corner(&mut self, corner: obj::Corner, line: u32) {
        let wanted = [Some(corner.position), corner.uv, corner.normal];
        for (needed, index) in self.needed.iter_mut().zip(wanted) {
            let count = index.map_or(0, |i| u64::from(i) + 1);
            if count > needed.0 {
                *needed = (count, line);
            }
        }
        match self.element {
            Element::Face => self.raw.corners.push(Corner {
                position: corner.position,
                uv: corner.uv.unwrap_or(NONE),
                normal: corner.normal.unwrap_or(NONE),
            }),
            Element::Line => {
                if let Some(from) = self.line_from.replace(corner.position) {
                    self.raw.lines.push([from, corner.position, self.material]);
                }
            }
            Element::Points => self.raw.points.push([corner.position, self.material]),
        }
    }

    fn use_material(&mut self, name: &str) {
        let next = self.raw.materials.len() as u32;
        self.material = match self.names.get(name) {
            Some(&known) => known,
            // A hostile file may name a new material a line.
            None if next >= 65_536 => {
                self.raw.warnings.warn("more than 65536 materials; the rest are grey");
                0
            }
            None => {
                self.names.insert(name.into(), next);
                self.raw
                    .materials
                    .push(MaterialBuf { name: name.into(), ..MaterialBuf::default() });
                next
            }
        };
    }

    fn finish(mut self, source: &Source<'_>) -> Result<Raw, LoadError> {
        if let Some(line) = self.bad_line {
            return Err(LoadError::malformed(
                source.name,
                At::Line(line),
                "a coordinate is beyond 1e30; mend the vertex",
            ));
        }
        let have = [self.raw.positions.len(), self.raw.uvs.len(), self.raw.normals.len()];
        for ((needed, line), (have, what)) in self.needed.into_iter().zip(have.into_iter().zip([
            "positions",
            "texture coordinates",
            "normals",
        ])) {
            if needed > have as u64 {
                return Err(LoadError::malformed(
                    source.name,
                    At::Line(line),
                    format!("asks for number {needed} of {have} {what}; is the file complete?"),
                ));
            }
        }
        if self.raw.uvs.iter().any(|uv| !usable(uv)) {
            return Err(LoadError::malformed(
                source.name,
                At::File,
                "a texture coordinate is beyond 1e30; mend it",
            ));
        }
        // Some programs write colours 0 to 255.
        let unit = if self.colour_max > 1.0 { 1.0 } else { 255.0 };
        self.raw.colours = self
            .colours
            .iter()
            .map(|c| c.map(|x| (x * unit).round().clamp(0.0, 255.0) as u8))
            .collect();
        self.raw.warnings.counted(self.short, "faces of fewer than three corners were dropped");
        let mut ignored: Vec<_> = self.ignored.drain().collect();
        ignored.sort();
        for (word, count) in ignored {
            self.raw.warnings.counted(count, format!("'{word}' lines are not understood"));
        }
        self.materials(source);
        Ok(self.raw)
    }

    fn materials(&mut self, source: &Source<'_>) {
        let white = !self.raw.colours.is_empty();
        let mut textures = Textures::default();
        let mut defined = vec![false; self.raw.materials.len()];
        for names in std::mem::take(&mut self.libraries) {
            for path in library_files(&names, source) {
                let Some(path) = path else {
                    let folders: Vec<_> = source.base.into_iter().collect();
                    let missing = source.missing(&folders);
                    self.raw.warnings.warn(format!("material file '{names}' {missing}"));
                    continue;
                };
                let bytes = match read_file(&path, source.limits.file_bytes) {
                    Ok(bytes) => bytes,
                    Err(error) => {
                        self.raw.warnings.warn(error.to_string());
                        continue;
                    }
                };
                let file = path.display().to_string();
                let folders: Vec<_> = path.parent().into_iter().chain(source.base).collect();
                for mut found in mtl::read(&bytes, &file, &mut self.raw.warnings) {
                    let Some(&index) = self.names.get(&found.material.name) else { continue };
                    // The first definition counts, as elsewhere.
                    if std::mem::replace(&mut defined[index as usize], true) {
                        continue;
                    }
                    if let Some(name) = found.texture {
                        self.raw.texture_named = true;
                        if found.uv_map != UvMap::IDENTITY {
                            self.raw.uv_maps.insert(index, found.uv_map);
                        }
                        found.material.texture = textures.load(
                            &name,
                            &folders,
                            source,
                            &mut self.raw.images,
                            &mut self.raw.warnings,
                        );
                    }
                    self.raw.materials[index as usize] = found.material;
                }
            }
        }
        for (index, material) in self.raw.materials.iter_mut().enumerate() {
            if defined[index] {
                continue;
            }
            if index > 0 {
                let text = format!("material '{}' is not defined; grey is used", material.name);
                self.raw.warnings.warn(text);
            }
            if white {
                material.colour = [255; 3];
            }
        }
    }
}

/// The files of a `mtllib` line: one name with spaces, or else several names.
fn library_files(names: &str, source: &Source<'_>) -> Vec<Option<std::path::PathBuf>> {
    let folders: Vec<_> = source.base.into_iter().collect();
    match find_file(names, &folders) {
        Some(path) => vec![Some(path)],
        None => {
            let words: Vec<_> = names.split_whitespace().take(64).collect();
            if words.len() < 2 {
                return vec![None];
            }
            let found: Vec<_> = words.iter().map(|name| find_file(name, &folders)).collect();
            if found.iter().all(Option::is_none) { vec![None] } else { found }
        }
    }
}

#[cfg(test)]
#[path = "obj_tests.rs"]
mod tests;
