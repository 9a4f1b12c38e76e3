//! Light, eight vertices at a time: white light from afar, in the mesh's own coordinates.
//!
//! Normals, directions, weights and intensities are 16-bit numbers, so that `pmaddwd` multiplies them exactly.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::EIGHT;
use super::memory::{gather, load, store, triangles};
use crate::light::{ONE, PlainLight};
use crate::transform::Vertex;

/// The word of a vertex that holds its colour, in the low three bytes.
const COLOUR: usize = 4;

/// See [`Avx2::light`](super::Avx2::light).
#[target_feature(enable = "avx2")]
pub fn light(light: &PlainLight, normals: &[[i16; 3]], vertices: &mut [Vertex]) {
    let count = normals.len().min(vertices.len());
    let (eights, rest) = vertices[..count].as_chunks_mut::<EIGHT>();
    let (normal_eights, normal_rest) = normals[..count].as_chunks::<EIGHT>();
    for (vertices, normals) in eights.iter_mut().zip(normal_eights) {
        eight(light, normals, vertices);
    }
    // The last ones in a group that is filled up.
    if !rest.is_empty() {
        let (mut last, mut last_normals) = ([Vertex::EMPTY; EIGHT], [[0; 3]; EIGHT]);
        last[..rest.len()].copy_from_slice(rest);
        last_normals[..rest.len()].copy_from_slice(normal_rest);
        eight(light, &last_normals, &mut last);
        rest.copy_from_slice(&last[..rest.len()]);
    }
}

/// Two 16-bit numbers in a word.
#[inline]
fn pair(low: i32, high: i32) -> i32 {
    (low & 0xffff) | high << 16
}

#[inline]
#[target_feature(enable = "avx2")]
fn eight(light: &PlainLight, normals: &[[i16; 3]; EIGHT], vertices: &mut [Vertex; EIGHT]) {
    // SAFETY: 48 bytes either way, any bits are a value.
    let normals = unsafe { &*(normals as *const [[i16; 3]; EIGHT]).cast::<[[u16; 3]; EIGHT]>() };
    let [x, y, z] = triangles(normals);
    let (zero, one) = (_mm256_setzero_si256(), _mm256_set1_epi32(ONE));
    let mut sum = _mm256_set1_epi32(light.ambient);
    for &(towards, weight) in &light.lamps[..light.count] {
        let [a, b, c] = towards.map(|v| _mm256_set1_epi32(pair(v, 0)));
        let [ax, by, cz] =
            [_mm256_madd_epi16(a, x), _mm256_madd_epi16(b, y), _mm256_madd_epi16(c, z)];
        let dot = _mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(ax, by), cz), 14);
        let dot = _mm256_min_epi32(_mm256_max_epi32(dot, zero), one);
        let part = _mm256_madd_epi16(dot, _mm256_set1_epi32(pair(weight, 0)));
        sum = _mm256_add_epi32(sum, _mm256_srai_epi32(part, 14));
    }
    let intensity = _mm256_min_epi32(_mm256_max_epi32(sum, _mm256_set1_epi32(light.floor)), one);
    // Each channel: c I + 1/2, the half as a product with one.
    let intensity = _mm256_or_si256(intensity, _mm256_set1_epi32(pair(0, 1)));
    let half = _mm256_set1_epi32(pair(0, ONE / 2));
    let lit = |channel: __m256i| {
        let product = _mm256_madd_epi16(_mm256_or_si256(channel, half), intensity);
        _mm256_srli_epi32(product, 14)
    };
    // SAFETY: there are eight.
    let word = unsafe { gather::<_, COLOUR>(&vertices[..], load(&[0, 1, 2, 3, 4, 5, 6, 7])) };
    let byte = _mm256_set1_epi32(0xff);
    let r = lit(_mm256_and_si256(word, byte));
    let g = lit(_mm256_and_si256(_mm256_srli_epi32(word, 8), byte));
    let b = lit(_mm256_and_si256(_mm256_srli_epi32(word, 16), byte));
    let flags = _mm256_andnot_si256(_mm256_set1_epi32(0xff_ffff), word);
    let rg = _mm256_or_si256(r, _mm256_slli_epi32(g, 8));
    let word = _mm256_or_si256(_mm256_or_si256(rg, _mm256_slli_epi32(b, 16)), flags);
    let mut words = [0; EIGHT];
    store(&mut words, word);
    for (vertex, word) in vertices.iter_mut().zip(words) {
        let at: *mut i32 = (vertex as *mut Vertex).cast();
        // SAFETY: a vertex is five words, this the last (repr(C), asserted where it is declared), any bits are a value.
        unsafe { at.add(COLOUR).write(word) };
    }
}

#[cfg(test)]
mod tests {
    use crate::avx2::Avx2;
    use crate::camera::Viewpoint;
    use crate::light::Lighting;
    use crate::math::{Mat4, Q16, Vec3};
    use crate::scene::{Light, LightKind, Material};
    use crate::transform::Vertex;

    /// Random lights, normals (of any length) and colours, extremes among them, against one at a time.
    #[test]
    fn eight_are_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut seed = 11u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 32) as u32
        };
        let (mut dark, mut bright) = (0, 0);
        for case in 0..3000 {
            let lights: [Light; 8] = core::array::from_fn(|_| Light {
                kind: LightKind::Directional({
                    let [x, y, z] = [(); 3].map(|()| Q16(random() as i32 >> 8));
                    Vec3 { x, y, z }
                }),
                colour: [(random() >> (24 + case % 2 * 3)) as u8; 3],
            });
            let lights = &lights[..case as usize % 9];
            let mut weight = || Q16((random() >> 15) as i32 - 2000);
            let material = Material { ambient: weight(), diffuse: weight(), ..Material::default() };
            let floor = if case % 4 == 0 { weight() } else { Q16::ZERO };
            let viewpoint = Viewpoint::Point(Vec3::ZERO);
            let lighting = Lighting::new(lights, floor, &viewpoint, &material, &Mat4::IDENTITY);
            let plain = lighting.plain().expect("plain light");
            let normals: [[i16; 3]; 21] = core::array::from_fn(|_| {
                [(); 3].map(|()| {
                    let v = random();
                    [v as i16, (v as i16) >> 1, 1 << 14, i16::MIN][(v >> 28) as usize % 4]
                })
            });
            let old: [Vertex; 21] = core::array::from_fn(|_| Vertex {
                x: random() as i32,
                y: random() as i32,
                z: random(),
                inv_w: random(),
                rgb: [(); 3].map(|()| (random() >> 24) as u8),
                flags: random() as u8,
            });
            let mut got = old;
            avx2.light(&plain, &normals, &mut got[..21 - case as usize % 8]);
            for (i, (got, old)) in got.iter().zip(&old).enumerate() {
                let mut want = *old;
                if i < 21 - case as usize % 8 {
                    want.rgb = lighting.lit_in_mesh(old.rgb, normals[i], [0; 3]);
                    dark += (want.rgb == [0; 3]) as u32;
                    bright += (want.rgb == old.rgb) as u32;
                }
                assert_eq!(*got, want, "{:?} {plain:?}", normals[i]);
            }
        }
        assert!(dark > 100 && bright > 5000, "{dark} {bright}");
    }
}
