//! Normals of every corner: from the file, flat, or smooth.
//!
//! Smooth normals sum the face normals around a position, each corner weighted by Max's rule ("Weights for Computing
//! Vertex Normals from Facet Normals", 1999): `a x b / (|a|^2 |b|^2)` for the two polygon edges a, b that leave the
//! corner. It is exact on a sphere and needs no arc cosine, so every host computes the same bits. Faces that
//! meet at more than the crease angle do not smooth each other, unless the file gives smoothing groups.
//!
//! Result: Q2.14, unit length 16384, rounded to nearest.

use crate::load::{LoadOptions, NormalSource};
use crate::raw::{NONE, Raw, SMOOTHING_UNSPECIFIED};
use crate::triangulate::{cross, dot, newell, sub};
use std::collections::HashMap;

/// Positions that more corners share are smoothed without regard to creases, which would take quadratic time.
const VALENCE_LIMIT: usize = 256;

/// Unit vector in the direction of `v`, or `None` for a vector without one.
pub(crate) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let greatest = v[0].abs().max(v[1].abs()).max(v[2].abs());
    // `max` ignores a NaN; the sum does not.
    if !(v[0] + v[1] + v[2]).is_finite() || greatest == 0.0 {
        return None;
    }
    // Scaled first, so that the squares neither overflow nor vanish.
    let v = v.map(|x| x / greatest);
    let length = dot(v, v).sqrt();
    Some(v.map(|x| x / length))
}

/// Q2.14, nearest.
pub(crate) fn to_q14(v: [f64; 3]) -> [i16; 3] {
    v.map(|x| (x * 16384.0).round() as i16)
}

/// One normal a corner, Q2.14. Faces without area get the normals of their neighbours, or +z.
pub(crate) fn corner_normals(raw: &Raw, options: &LoadOptions) -> Vec<[i16; 3]> {
    let mut face_normals = Vec::with_capacity(raw.faces.len());
    let mut points = Vec::new();
    for face in 0..raw.faces.len() {
        points.clear();
        points.extend(raw.face(face).iter().map(|c| raw.positions[c.position as usize]));
        face_normals.push(unit(newell(&points)));
    }
    let from_file = |normal: u32| {
        let index =
            (options.normals == NormalSource::FromFile && normal != NONE).then_some(normal)?;
        unit(raw.normals[index as usize].map(f64::from))
    };
    let all_given = options.normals == NormalSource::FromFile
        && raw.corners.iter().all(|c| from_file(c.normal).is_some());
    let smooth = if all_given || options.normals == NormalSource::Flat {
        Vec::new()
    } else {
        smooth_normals(raw, &face_normals, options.crease_degrees)
    };
    let mut result = Vec::with_capacity(raw.corners.len());
    for (index, face_normal) in face_normals.iter().enumerate() {
        for corner in raw.face(index) {
            let computed = || smooth.get(result.len()).copied().flatten().or(*face_normal);
            let normal = from_file(corner.normal).or_else(computed);
            result.push(to_q14(normal.unwrap_or([0.0, 0.0, 1.0])));
        }
    }
    result
}

fn smooth_normals(
    raw: &Raw,
    face_normals: &[Option<[f64; 3]>],
    crease_degrees: f64,
) -> Vec<Option<[f64; 3]>> {
    let crease = crease_degrees.clamp(0.0, 180.0).to_radians().cos();
    let count = raw.corners.len();
    let mut face_of = Vec::with_capacity(count);
    let mut weighted = Vec::with_capacity(count);
    for face in 0..raw.faces.len() {
        let corners = raw.face(face);
        let at = |i: usize| raw.positions[corners[i % corners.len()].position as usize];
        for i in 0..corners.len() {
            let a = sub(at(i + 1), at(i));
            let b = sub(at(i + corners.len() - 1), at(i));
            let size = dot(a, a) * dot(b, b);
            let weight = cross(a, b).map(|x| x / size);
            weighted.push(if weight.iter().all(|x| x.is_finite()) { weight } else { [0.0; 3] });
            face_of.push(face);
        }
    }
    let (places, first, ring) = rings(raw);
    let mut result = Vec::with_capacity(count);
    let mut whole: HashMap<u32, [f64; 3]> = HashMap::new();
    for corner in 0..count {
        let place = places[corner];
        let around = &ring[first[place as usize] as usize..first[place as usize + 1] as usize];
        let sum_over = |keep: &dyn Fn(usize) -> bool| {
            let mut sum = [0.0; 3];
            for &other in around {
                if keep(other as usize) {
                    let w = weighted[other as usize];
                    sum = [sum[0] + w[0], sum[1] + w[1], sum[2] + w[2]];
                }
            }
            sum
        };
        let face = face_of[corner];
        let group = raw.faces[face].smoothing;
        let sum = if group == 0 {
            [0.0; 3]
        } else if around.len() > VALENCE_LIMIT {
            *whole.entry(place).or_insert_with(|| sum_over(&|_| true))
        } else if group == SMOOTHING_UNSPECIFIED {
            sum_over(&|other| match (face_normals[face], face_normals[face_of[other]]) {
                (Some(a), Some(b)) => dot(a, b) >= crease,
                _ => true,
            })
        } else {
            sum_over(&|other| raw.faces[face_of[other]].smoothing == group)
        };
        result.push(unit(sum));
    }
    result
}

/// Corners grouped by place (equal coordinates, whatever their index): the place of each corner, and for place `p` its
/// corners `ring[first[p]..first[p + 1]]`.
fn rings(raw: &Raw) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut place_of_position = vec![NONE; raw.positions.len()];
    let mut places = Vec::with_capacity(raw.corners.len());
    for corner in &raw.corners {
        let slot = &mut place_of_position[corner.position as usize];
        if *slot == NONE {
            // Adding zero makes -0 equal to 0.
            let key = raw.positions[corner.position as usize].map(|x| (x + 0.0).to_bits());
            let next = known.len() as u32;
            *slot = *known.entry(key).or_insert(next);
        }
        places.push(*slot);
    }
    let mut first = vec![0u32; known.len() + 1];
    for &place in &places {
        first[place as usize + 1] += 1;
    }
    for i in 1..first.len() {
        first[i] += first[i - 1];
    }
    let mut fill = first.clone();
    let mut ring = vec![0u32; places.len()];
    for (corner, &place) in places.iter().enumerate() {
        ring[fill[place as usize] as usize] = corner as u32;
        fill[place as usize] += 1;
    }
    (places, first, ring)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::Corner;

    fn raw(positions: &[[f64; 3]], faces: &[&[u32]], smoothing: u32) -> Raw {
        let mut raw = Raw { positions: positions.to_vec(), ..Raw::default() };
        raw.normals.push([0.0, -2.0, 0.0]);
        for face in faces {
            raw.corners.extend(face.iter().map(|&p| Corner {
                position: p,
                uv: NONE,
                normal: NONE,
            }));
            raw.end_face(0, smoothing);
        }
        raw
    }

    /// Two unit squares that meet in the y axis at a right angle: z = 0 and x = 0.
    const ROOF: [[f64; 3]; 6] =
        [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., -1.], [0., 1., -1.]];
    const ROOF_FACES: [&[u32]; 2] = [&[0, 1, 2, 3], &[0, 3, 5, 4]];

    #[test]
    fn a_crease_separates_and_a_wide_limit_joins() {
        let mut model = raw(&ROOF, &ROOF_FACES, SMOOTHING_UNSPECIFIED);
        let mut options = LoadOptions { crease_degrees: 60.0, ..LoadOptions::default() };
        let sharp = corner_normals(&model, &options);
        assert_eq!(sharp[..4], [[0, 0, 16384]; 4]);
        assert_eq!(sharp[4..], [[-16384, 0, 0]; 4]);
        options.crease_degrees = 100.0;
        let soft = corner_normals(&model, &options);
        assert_eq!(soft[0], [-11585, 0, 11585]);
        assert_eq!(soft[1], [0, 0, 16384]);
        assert_eq!(soft[0], soft[4]);
        options.normals = NormalSource::Flat;
        assert_eq!(corner_normals(&model, &options), sharp);
        // Smoothing groups of the file overrule the crease.
        model = raw(&ROOF, &ROOF_FACES, 1);
        options = LoadOptions::default();
        assert_eq!(corner_normals(&model, &options), soft);
        model = raw(&ROOF, &ROOF_FACES, 0);
        assert_eq!(corner_normals(&model, &options), sharp);
    }

    #[test]
    fn file_normals_are_normalised_and_holes_filled() {
        let mut model = raw(&ROOF, &ROOF_FACES, SMOOTHING_UNSPECIFIED);
        model.corners[0].normal = 0;
        let normals = corner_normals(&model, &LoadOptions::default());
        assert_eq!(normals[0], [0, -16384, 0]);
        assert_eq!(normals[1], [0, 0, 16384]);
    }

    #[test]
    fn unit_survives_extremes() {
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([f64::NAN, 1.0, 0.0]), None);
        assert_eq!(unit([0.0, 1e-320, 0.0]), Some([0.0, 1.0, 0.0]));
        assert_eq!(unit([1e300, 0.0, 0.0]), Some([1.0, 0.0, 0.0]));
    }
}
