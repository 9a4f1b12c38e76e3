//! PLY: text, binary of either byte order; `.ply.gz` is unpacked by the loader.
//!
//! | element | properties read |
//! |---|---|
//! | `vertex` | `x y z`, `nx ny nz`, `red green blue` (or `r g b`, `diffuse_red` ...), `u v`, `s t`, `texture_u texture_v` |
//! | `face` | list `vertex_indices` or `vertex_index`; list `texcoord` (two numbers a corner) |
//! | `tristrips` | list `vertex_indices`, -1 begins a new strip |
//! | `edge` | `vertex1`, `vertex2` |
//!
//! Everything else is skipped. Integer colours are scaled from their type's range, floating ones from [0, 1]. v goes up in
//! the file and is turned downwards. A `comment TextureFile NAME` names the texture.

mod header;
mod values;

use self::header::{Element, Header, Kind, Property};
use self::values::Values;
use super::{Source, Textures};
use crate::error::{At, LoadError};
use crate::model::MaterialBuf;
use crate::raw::{Corner, NONE, Raw, SMOOTHING_UNSPECIFIED, usable};

/// Reads the file.
pub(crate) fn read(source: &Source<'_>) -> Result<Raw, LoadError> {
    let (header, values) = header::parse(source)?;
    let mut ply = Ply { raw: Raw::default(), values, source, with_uvs: false, with_normals: false };
    ply.raw.materials.push(MaterialBuf::default());
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" if ply.raw.positions.is_empty() => ply.vertices(element)?,
            "face" => ply.faces(element)?,
            "tristrips" => ply.strips(element)?,
            "edge" => ply.edges(element)?,
            _ => ply.skip(element)?,
        }
    }
    ply.finish(&header)
}

struct Ply<'a> {
    raw: Raw,
    values: Values<'a>,
    source: &'a Source<'a>,
    with_uvs: bool,
    with_normals: bool,
}

/// What a scalar property of a vertex is for: a slot of the value array.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "nx" => 3,
        "ny" => 4,
        "nz" => 5,
        "red" | "r" | "diffuse_red" => 6,
        "green" | "g" | "diffuse_green" => 7,
        "blue" | "b" | "diffuse_blue" => 8,
        "u" | "s" | "texture_u" | "texture_s" => 9,
        "v" | "t" | "texture_v" | "texture_t" => 10,
        _ => return None,
    })
}

/// A colour channel as 8 bits.
fn channel(value: f64, kind: Kind) -> u8 {
    let most = match kind {
        Kind::U8 | Kind::I8 => 255.0,
        Kind::U16 | Kind::I16 => 65535.0,
        Kind::U32 | Kind::I32 => 4_294_967_295.0,
        Kind::F32 | Kind::F64 => 1.0,
    };
    (value / most * 255.0).round().clamp(0.0, 255.0) as u8
}

impl Ply<'_> {
    fn fail(&self, what: impl Into<String>) -> LoadError {
        LoadError::malformed(self.source.name, self.values.at(), what)
    }

    fn truncated(&self, element: &Element) -> LoadError {
        self.fail(format!(
            "the file ends, or is not numeric, within its {} '{}' elements; copy it again",
            element.count, element.name
        ))
    }

    fn vertices(&mut self, element: &Element) -> Result<(), LoadError> {
        let slots: Vec<_> = element
            .properties
            .iter()
            .map(|p| if p.list.is_none() { slot(&p.name) } else { None })
            .collect();
        let has =
            |range: std::ops::Range<usize>| range.into_iter().all(|s| slots.contains(&Some(s)));
        if !has(0..3) {
            return Err(self.fail("vertices have no x, y, z; export positions"));
        }
        let with_colours = has(6..9);
        (self.with_normals, self.with_uvs) = (has(3..6), has(9..11));
        let kinds = |s: usize| {
            slots
                .iter()
                .position(|&x| x == Some(s))
                .map_or(Kind::U8, |i| element.properties[i].kind)
        };
        let colour_kinds = [kinds(6), kinds(7), kinds(8)];
        for _ in 0..element.count {
            let mut v = [0.0; 11];
            for (property, slot) in element.properties.iter().zip(&slots) {
                match (slot, property.list) {
                    (&Some(slot), None) => {
                        v[slot] = self
                            .values
                            .number(property.kind)
                            .ok_or_else(|| self.truncated(element))?;
                    }
                    _ => self.skip_property(element, property)?,
                }
            }
            if !usable(&v[..3]) || (self.with_uvs && !usable(&v[9..11])) {
                return Err(self.fail("a coordinate is not finite or beyond 1e30; mend the vertex"));
            }
            self.raw.positions.push([v[0], v[1], v[2]]);
            if self.with_normals {
                self.raw.normals.push([v[3] as f32, v[4] as f32, v[5] as f32]);
            }
            if self.with_uvs {
                self.raw.uvs.push([v[9], 1.0 - v[10]]);
            }
            if with_colours {
                self.raw.colours.push(std::array::from_fn(|i| channel(v[6 + i], colour_kinds[i])));
            }
            self.raw.check(self.source.name, self.source.limits)?;
        }
        Ok(())
    }

    /// A corner whose indices are those of vertex `index`.
    fn corner(&self, index: f64) -> Result<Corner, LoadError> {
        let count = self.raw.positions.len();
        if !(index >= 0.0 && index < count as f64) {
            return Err(self.fail(format!(
                "vertex {index} of {count} is asked for; indices count from 0 (is the file complete?)"
            )));
        }
        let index = index as u32;
        let with = |yes: bool| if yes { index } else { NONE };
        Ok(Corner { position: index, uv: with(self.with_uvs), normal: with(self.with_normals) })
    }

    /// The length of a list.
    fn length(&mut self, element: &Element, property: &Property) -> Result<u64, LoadError> {
        let Some(kind) = property.list else { return Ok(1) };
        let length = self.values.number(kind).ok_or_else(|| self.truncated(element))?;
        if length < 0.0 || length.fract() != 0.0 {
            return Err(self.fail(format!("a list of length {length}; export the file again")));
        }
        Ok(length as u64)
    }

    fn faces(&mut self, element: &Element) -> Result<(), LoadError> {
        let mut short = 0;
        for _ in 0..element.count {
            let begin = self.raw.corners.len();
            let mut corner_uvs = begin;
            for property in &element.properties {
                match property.name.as_str() {
                    "vertex_indices" | "vertex_index" if property.list.is_some() => {
                        for _ in 0..self.length(element, property)? {
                            let index = self
                                .values
                                .number(property.kind)
                                .ok_or_else(|| self.truncated(element))?;
                            let corner = self.corner(index)?;
                            self.raw.corners.push(corner);
                            self.raw.check(self.source.name, self.source.limits)?;
                        }
                    }
                    "texcoord" if property.list.is_some() => {
                        for _ in 0..self.length(element, property)? / 2 {
                            let mut next = || self.values.number(property.kind);
                            let (Some(u), Some(v)) = (next(), next()) else {
                                return Err(self.truncated(element));
                            };
                            if !usable(&[u, v]) {
                                return Err(
                                    self.fail("a texture coordinate is not finite; mend the face")
                                );
                            }
                            self.raw.uvs.push([u, 1.0 - v]);
                            if let Some(corner) = self.raw.corners.get_mut(corner_uvs) {
                                corner.uv = self.raw.uvs.len() as u32 - 1;
                            }
                            corner_uvs += 1;
                            self.raw.check(self.source.name, self.source.limits)?;
                        }
                    }
                    _ => self.skip_property(element, property)?,
                }
            }
            short += u64::from(!self.raw.end_face(0, SMOOTHING_UNSPECIFIED));
        }
        self.raw.warnings.counted(short, "faces of fewer than three corners were dropped");
        Ok(())
    }

    fn strips(&mut self, element: &Element) -> Result<(), LoadError> {
        for _ in 0..element.count {
            for property in &element.properties {
                if property.list.is_none() || !property.name.starts_with("vertex_ind") {
                    self.skip_property(element, property)?;
                    continue;
                }
                // The two corners before, and how many of the strip came already.
                let (mut before, mut seen) = ([None; 2], 0u64);
                for _ in 0..self.length(element, property)? {
                    let index =
                        self.values.number(property.kind).ok_or_else(|| self.truncated(element))?;
                    if index < 0.0 {
                        (before, seen) = ([None; 2], 0);
                        continue;
                    }
                    let corner = self.corner(index)?;
                    if let [Some(a), Some(b)] = before {
                        // Every second triangle of a strip runs the other way.
                        let (a, b) = if seen % 2 == 0 { (a, b) } else { (b, a) };
                        self.raw.corners.extend([a, b, corner]);
                        self.raw.end_face(0, SMOOTHING_UNSPECIFIED);
                        self.raw.check(self.source.name, self.source.limits)?;
                    }
                    before = [before[1], Some(corner)];
                    seen += 1;
                }
            }
        }
        Ok(())
    }

    fn edges(&mut self, element: &Element) -> Result<(), LoadError> {
        for _ in 0..element.count {
            let mut ends = [None; 2];
            for property in &element.properties {
                let end = match property.name.as_str() {
                    "vertex1" if property.list.is_none() => 0,
                    "vertex2" if property.list.is_none() => 1,
                    _ => {
                        self.skip_property(element, property)?;
                        continue;
                    }
                };
                let index =
                    self.values.number(property.kind).ok_or_else(|| self.truncated(element))?;
                ends[end] = Some(self.corner(index)?.position);
            }
            if let [Some(a), Some(b)] = ends {
                self.raw.lines.push([a, b, 0]);
            }
            self.raw.check(self.source.name, self.source.limits)?;
        }
        Ok(())
    }

    fn skip(&mut self, element: &Element) -> Result<(), LoadError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for _ in 0..element.count {
            for property in &element.properties {
                self.skip_property(element, property)?;
            }
        }
        Ok(())
    }

    fn skip_property(&mut self, element: &Element, property: &Property) -> Result<(), LoadError> {
        for _ in 0..self.length(element, property)? {
            self.values.number(property.kind).ok_or_else(|| self.truncated(element))?;
        }
        Ok(())
    }

    fn finish(mut self, header: &Header) -> Result<Raw, LoadError> {
        self.raw.warnings.counted(header.unknown, "header lines are not understood");
        let material = &mut self.raw.materials[0];
        if !self.raw.colours.is_empty() {
            material.colour = [255; 3];
        }
        if let Some(name) = header.texture.as_ref().filter(|_| !self.raw.uvs.is_empty()) {
            self.raw.texture_named = true;
            let folders: Vec<_> = self.source.base.into_iter().collect();
            material.texture = Textures::default().load(
                name,
                &folders,
                self.source,
                &mut self.raw.images,
                &mut self.raw.warnings,
            );
            if material.texture.is_some() {
                material.colour = [255; 3];
            }
        }
        Ok(self.raw)
    }
}

/// A place for messages: a line of a text body, a byte of a binary one.
fn place(text: bool, line: u32, byte: usize) -> At {
    if text { At::Line(line) } else { At::Byte(byte as u64) }
}

#[cfg(test)]
mod tests;
