//! STL, text and binary (also binary files whose header begins with `solid`).
//!
//! STL repeats every corner in every triangle; equal coordinates are joined here. Facet normals are ignored: they only
//! repeat what the corners say, and are often zero; smooth normals come from the geometry. The colour bits that
//! some programs hide in a binary facet are not read.

use super::Source;
use crate::error::{At, LoadError};
use crate::model::MaterialBuf;
use crate::number::Number;
use crate::raw::{Corner, NONE, Raw, SMOOTHING_UNSPECIFIED, usable};
use std::collections::HashMap;

const HEADER: usize = 84;
const FACET: usize = 50;

/// True when the size that the header announces is the file's (a text file would have to fake that).
pub(crate) fn looks_binary(bytes: &[u8]) -> bool {
    facets(bytes).is_some_and(|count| HEADER as u64 + count * FACET as u64 == bytes.len() as u64)
}

fn facets(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]).into())
}

pub(crate) fn read(source: &Source<'_>) -> Result<Raw, LoadError> {
    let mut mesh = Mesh::default();
    mesh.raw.materials.push(MaterialBuf::default());
    let text = source.bytes.trim_ascii_start().starts_with(b"solid")
        && !looks_binary(source.bytes)
        && !source.bytes[..source.bytes.len().min(1024)].contains(&0);
    if text {
        mesh.text(source)?
    } else {
        mesh.binary(source)?
    }
    Ok(mesh.raw)
}

#[derive(Default)]
struct Mesh {
    raw: Raw,
    known: HashMap<[u64; 3], u32>,
}

impl Mesh {
    fn corner(&mut self, xyz: [f64; 3]) {
        // Adding zero makes -0 equal to 0.
        let next = self.raw.positions.len() as u32;
        let position = *self.known.entry(xyz.map(|x| (x + 0.0).to_bits())).or_insert(next);
        if position == next {
            self.raw.positions.push(xyz);
        }
        self.raw.corners.push(Corner { position, uv: NONE, normal: NONE });
    }

    fn binary(&mut self, source: &Source<'_>) -> Result<(), LoadError> {
        let bytes = source.bytes;
        let Some(count) = facets(bytes) else {
            let what =
                "neither text STL ('solid') nor long enough for a binary header; copy it again";
            return Err(LoadError::malformed(source.name, At::Byte(bytes.len() as u64), what));
        };
        let have = ((bytes.len() - HEADER) / FACET) as u64;
        if have < count {
            let what =
                format!("the header announces {count} facets, {have} follow; copy the file again");
            return Err(LoadError::malformed(source.name, At::Byte(80), what));
        }
        if count > u64::from(source.limits.elements) / 3 {
            return Err(LoadError::too_large(
                source.name,
                format!("{count} facets; simplify the mesh"),
            ));
        }
        let body = &bytes[HEADER..HEADER + count as usize * FACET];
        for (index, facet) in body.chunks_exact(FACET).enumerate() {
            for corner in facet[12..48].chunks_exact(12) {
                let xyz = std::array::from_fn(|i| {
                    let b = &corner[4 * i..4 * i + 4];
                    f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                });
                if !usable(&xyz) {
                    let at = At::Byte((HEADER + index * FACET) as u64);
                    let what = "a coordinate is not finite or beyond 1e30; mend the facet";
                    return Err(LoadError::malformed(source.name, at, what));
                }
                self.corner(xyz);
            }
            self.raw.end_face(0, SMOOTHING_UNSPECIFIED);
        }
        Ok(())
    }

    fn text(&mut self, source: &Source<'_>) -> Result<(), LoadError> {
        let mut short = 0;
        let mut inside = false;
        let mut line_number = 0;
        for line in source.bytes.split(|&b| b == b'\n') {
            line_number += 1;
            let fail =
                |what: &str| Err(LoadError::malformed(source.name, At::Line(line_number), what));
            let mut words = line.split(|b| b.is_ascii_whitespace()).filter(|word| !word.is_empty());
            match words.next().map(<[u8]>::to_ascii_lowercase).as_deref() {
                Some(b"vertex") => {
                    let mut xyz = [0.0; 3];
                    for x in &mut xyz {
                        let number = words.next().and_then(Number::parse).map(Number::to_f64);
                        *x = match number {
                            Some(number) if usable(&[number]) => number,
                            _ => return fail("a vertex needs three finite numbers; mend the line"),
                        };
                    }
                    if !inside {
                        return fail("a vertex outside 'outer loop'; is the file complete?");
                    }
                    self.corner(xyz);
                }
                Some(b"outer") => inside = true,
                Some(b"endloop" | b"endfacet") if inside => {
                    inside = false;
                    short += u64::from(!self.raw.end_face(0, SMOOTHING_UNSPECIFIED));
                    self.raw.check(source.name, source.limits)?;
                }
                None | Some(b"solid" | b"endsolid" | b"facet" | b"endloop" | b"endfacet") => {}
                Some(_) => {
                    return fail(
                        "not a line of STL (solid, facet, outer loop, vertex); is this STL?",
                    );
                }
            }
        }
        if inside {
            let what = "the file ends inside a facet; copy it again";
            return Err(LoadError::malformed(source.name, At::Line(line_number), what));
        }
        self.raw.warnings.counted(short, "facets of fewer than three corners were dropped");
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Format, LoadOptions, load_bytes};
    use crate::model::Model;

    const TETRAHEDRON: [[[f32; 3]; 3]; 4] = {
        let (o, x, y, z) = ([0.0, 0., 0.], [1.0, 0., 0.], [0., 1.0, 0.], [0., 0., 1.0]);
        [[o, y, x], [o, x, z], [o, z, y], [x, y, z]]
    };

    fn binary(title: &[u8]) -> Vec<u8> {
        let mut bytes = title.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((TETRAHEDRON.len() as u32).to_le_bytes());
        for facet in TETRAHEDRON {
            bytes.extend([0; 12]);
            facet.as_flattened().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn text() -> String {
        let mut text = String::from("solid a tetrahedron\r\n");
        for facet in TETRAHEDRON {
            text += "  facet normal 0 0 0\r\n outer loop\r\n";
            for [x, y, z] in facet {
                text += &format!("\tvertex {x:e} {y} {z}\r\n");
            }
            text += " endloop\r\nendfacet\r\n";
        }
        text + "endsolid"
    }

    fn load(bytes: &[u8]) -> Result<Model, LoadError> {
        load_bytes(bytes, Some(Format::Stl), "t.stl", None, &LoadOptions::default())
    }

    #[test]
    fn text_and_binary_agree() {
        let a = load(text().as_bytes()).unwrap();
        let b = load(&binary(b"solid but binary")).unwrap();
        assert_eq!(a.parts, b.parts);
        assert_eq!((a.parts[0].mesh.positions.len(), a.stats.edges, a.stats.triangles), (4, 6, 4));
        let sniffed = load_bytes(&binary(b"x"), None, "-", None, &LoadOptions::default()).unwrap();
        assert_eq!(sniffed.parts, a.parts);
    }

    #[test]
    fn broken_files_are_one_line() {
        let good = binary(b"");
        for (bytes, message) in [
            (
                &good[..200],
                "t.stl: byte 80: the header announces 4 facets, 2 follow; copy the file again",
            ),
            (&good[..30], "t.stl: byte 30: neither text"),
            (
                b"solid\nfacet normal 0 0 0\nouter loop\nvertex 1 2 nan",
                "t.stl:4: a vertex needs three",
            ),
            (b"solid\nvertex 1 2 3", "t.stl:2: a vertex outside"),
            (b"solid\nouter loop", "t.stl:2: the file ends inside"),
            (b"solid\nwhat", "t.stl:2: not a line of STL"),
            (b"solid x\nendsolid", "t.stl: no vertices"),
        ] {
            let error = load(bytes).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        let mut infinite = good.clone();
        infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(load(&infinite).unwrap_err().to_string().contains("byte 84"));
        let mut absurd = good;
        absurd[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(load(&absurd).is_err());
    }

    #[test]
    fn every_truncation_is_survived() {
        let whole = text();
        for end in 0..whole.len() {
            let _ = load(&whole.as_bytes()[..end]);
        }
        let whole = binary(b"solid");
        for end in 0..whole.len() {
            assert!(load(&whole[..end]).is_err());
        }
    }
}
