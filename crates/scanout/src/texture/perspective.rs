//! Perspective: from planes in 1/w, s/w and t/w to a texel, and the mip level that a pixel needs.
//!
//! Setup takes whole repeats off the texture coordinates, so that they are small and not negative, multiplies them by the
//! corners' 1/w and scales each of the two products by a power of two to fill 31 bits (block floating point).

use super::{MAX_LEVELS, SUBTEXEL_BITS, Texture, Wrap};
use crate::interpolate::Plane;
use crate::setup::Triangle;

/// A triangle's texture coordinates, ready for every pixel.
#[derive(Clone, Copy, Debug)]
pub struct TextureSetup<'a> {
    /// The texture.
    pub texture: &'a Texture<'a>,
    /// s/w and t/w, block floating point.
    pub st: [Plane; 2],
    /// Shifts that bring `plane * r` to 1/4096 texel.
    pub shift: [u32; 2],
    /// Whole texels of level 0 to add: what was taken off before the division to keep numbers small.
    pub base: [i32; 2],
    /// Mip thresholds: level l or more where `q < thresholds[l - 1]`; 0 beyond the last level.
    pub thresholds: [u32; MAX_LEVELS as usize - 1],
}

/// The reciprocal that all machines share: `floor((2^47 - 1) / q)` for `q` the plane's value without its 8 fraction bits,
/// at least 1.
///
/// | q | r |
/// |---|---|
/// | [1, 2^23] | [2^24 - 1, 2^47 - 1] |
#[inline(always)]
pub fn reciprocal(q: u32) -> u64 {
    ((1u64 << 47) - 1) / q as u64
}

/// The integer part of the 1/w plane's value, at least 1.
#[inline(always)]
pub fn integer_q(plane_value: u32) -> u32 {
    (plane_value >> 8).max(1)
}

impl<'a> TextureSetup<'a> {
    /// Sets a triangle's texture up from its corners' texture coordinates (Q16.16) and 1/w (integers, the largest in
    /// [2^22, 2^23)).
    pub fn new(t: &Triangle, texture: &'a Texture<'a>, uv: [[i32; 2]; 3], q: [u32; 3]) -> Self {
        let size = [texture.width, texture.height].map(i64::from);
        let mut setup = TextureSetup {
            texture,
            st: [Plane::default(); 2],
            shift: [47; 2],
            base: [0; 2],
            thresholds: [0; MAX_LEVELS as usize - 1],
        };
        // Distances from the base in 1/4096 texel, rounded to nearest: [0, 2^38).
        let mut local = [[0i64; 2]; 3];
        for axis in 0..2 {
            let low = uv[0][axis].min(uv[1][axis]).min(uv[2][axis]);
            let repeats = low >> 16;
            setup.base[axis] = match texture.wrap[axis] {
                Wrap::Repeat => 0,
                Wrap::Mirror => (repeats & 1) * size[axis] as i32,
                Wrap::Clamp | Wrap::Border => repeats * size[axis] as i32,
            };
            for corner in 0..3 {
                let u = uv[corner][axis] as i64 - ((repeats as i64) << 16);
                local[corner][axis] = (u * size[axis] + 8) >> (16 - SUBTEXEL_BITS);
            }
            let products = [0, 1, 2].map(|i| local[i][axis] as u64 * q[i] as u64);
            let largest = products[0].max(products[1]).max(products[2]);
            let drop = (64 - largest.leading_zeros()).saturating_sub(31);
            setup.shift[axis] = 47 - drop;
            setup.st[axis] = t.plane(products.map(|p| ((p + ((1 << drop) >> 1)) >> drop) as u32));
        }
        if texture.levels > 1 {
            setup.thresholds = thresholds(t, &local, q, texture.levels);
        }
        setup
    }

    /// Where pixel (x, y) lies in the texture, 1/4096 texel of level 0, and its mip level, for its 1/w `q` and the
    /// reciprocal `r` of that.
    #[inline(always)]
    pub fn locate(&self, x: i32, y: i32, q: u32, r: u64) -> ([i64; 2], u8) {
        let st = [0, 1].map(|i| {
            let product = (self.st[i].at(x, y) as u64).wrapping_mul(r);
            let sub = product.wrapping_add(1 << (self.shift[i] - 1)) >> self.shift[i];
            sub as i64 + ((self.base[i] as i64) << SUBTEXEL_BITS)
        });
        let mut level = 0;
        if self.texture.levels > 1 {
            level = self.thresholds.iter().take_while(|&&threshold| q < threshold).count() as u8;
        }
        (st, level)
    }

    /// The texel of pixel (x, y).
    #[inline(always)]
    pub fn at(&self, x: i32, y: i32, q: u32, r: u64) -> [u8; 3] {
        let ([s, t], level) = self.locate(x, y, q, r);
        self.texture.sample(s, t, level)
    }
}

/// The mip thresholds of a triangle: `T_1 = cbrt(texture area * q0 q1 q2 / (2 screen area))`, rounded down, then each next
/// one by the factor `2^(-2/3)` = 41285 / 65536.
fn thresholds(
    t: &Triangle,
    st: &[[i64; 2]; 3],
    q: [u32; 3],
    levels: u8,
) -> [u32; MAX_LEVELS as usize - 1] {
    let d = |i: usize, axis: usize| (st[i][axis] - st[0][axis]) as i128;
    // 1/2^24 texel^2 against 1/2^8 pixel^2.
    let texture_area = (d(1, 0) * d(2, 1) - d(2, 0) * d(1, 1)).unsigned_abs();
    let cube = q.iter().map(|&q| q as u128).product::<u128>();
    let scale = 1 + 2 * SUBTEXEL_BITS - 8;
    let product = texture_area.saturating_mul(cube >> 16) / ((t.area as u128) << (scale - 16));
    let mut threshold = cube_root(product);
    let mut out = [0; MAX_LEVELS as usize - 1];
    for slot in &mut out[..levels as usize - 1] {
        *slot = threshold;
        threshold = ((threshold as u64 * 41285) >> 16) as u32;
    }
    out
}

/// `min(floor(cbrt(n)), 2^25 - 1)`, one bit a step.
fn cube_root(n: u128) -> u32 {
    (0..25).rev().fold(0u32, |root, bit| {
        let tried = root | 1 << bit;
        if (tried as u128).pow(3) <= n { tried } else { root }
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Filter, Texels};
    use super::*;

    #[test]
    fn cube_roots() {
        for n in [0u128, 1, 7, 8, 26, 27, 1 << 60, (1 << 60) - 1, u128::MAX] {
            let r = cube_root(n) as u128;
            assert!(r.pow(3) <= n && ((r + 1).pow(3) > n || r == (1 << 25) - 1));
        }
    }

    /// 1/w of three distances as the vertex stage delivers it.
    fn q_of(w: [f64; 3]) -> [u32; 3] {
        let nearest = w.iter().fold(f64::MAX, |a, &b| a.min(b));
        w.map(|w| (nearest / w * ((1 << 23) - 1) as f64) as u32)
    }

    struct Case {
        v: [[i32; 2]; 3],
        uv: [[i32; 2]; 3],
        w: [f64; 3],
    }

    fn cases() -> impl Iterator<Item = Case> {
        let mut seed = 5u64;
        let mut random = move |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) % n
        };
        (0..400).map(move |_| Case {
            v: [(); 3].map(|()| [random(16 * 640) as i32, random(16 * 480) as i32]),
            uv: [(); 3].map(|()| [random(4 << 16) as i32 - (2 << 16), random(1 << 16) as i32]),
            w: [(); 3].map(|()| 1.0 + random(1000) as f64 / 100.0),
        })
    }

    /// Exact s, t (texels) and the area of texture a pixel covers, at the centre of pixel (x, y), in f64.
    fn exact(case: &Case, size: [f64; 2], x: f64, y: f64) -> ([f64; 2], f64) {
        let at = |x: f64, y: f64| {
            let p = [x * 16.0 + 8.0, y * 16.0 + 8.0];
            let v = case.v.map(|v| v.map(f64::from));
            let cross = |a: [f64; 2], b: [f64; 2]| {
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
            };
            let l = [
                cross(v[1], v[2]) / case.w[0],
                cross(v[2], v[0]) / case.w[1],
                cross(v[0], v[1]) / case.w[2],
            ];
            let sum: f64 = l.iter().sum();
            [0, 1].map(|k| {
                (0..3).map(|i| l[i] * case.uv[i][k] as f64).sum::<f64>() / sum / 65536.0 * size[k]
            })
        };
        let (a, b, c) = (at(x, y), at(x + 1e-3, y), at(x, y + 1e-3));
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() * 1e6;
        (a, area)
    }

    #[test]
    fn coordinates_and_levels_match_real_numbers() {
        let texels = [[0u8; 3]; 256 * 128 * 4 / 3 + 2];
        let mut texture = Texture::new(256, 128, Texels::Rgb888(&texels)).unwrap();
        (texture.levels, texture.filter) = (8, Filter::Nearest);
        let (mut worst, mut near_miss, mut pixels) = (0f64, 0, 0);
        for case in cases() {
            let Some(t) = Triangle::new(case.v) else { continue };
            let q = q_of(case.w);
            let setup = TextureSetup::new(&t, &texture, case.uv, q);
            let q_plane = t.plane(q.map(|q| q << 8));
            for y in (t.min[1]..t.max[1]).step_by(5) {
                for x in (t.min[0]..t.max[0]).step_by(5).filter(|&x| t.covers(x, y)) {
                    let q = integer_q(q_plane.at(x, y));
                    let ([s, _], level) = setup.locate(x, y, q, reciprocal(q));
                    let (st, area) = exact(&case, [256.0, 128.0], x as f64, y as f64);
                    let got = s as f64 / 4096.0;
                    // Whole repeats are dropped for `Repeat`.
                    let off = (got - st[0] + 128.0).rem_euclid(256.0) - 128.0;
                    worst = worst.max(off.abs());
                    let lod = area.log2() / 2.0;
                    pixels += 1;
                    if ((lod + 0.5).floor().clamp(0.0, 7.0) - level as f64).abs() > 0.0 {
                        near_miss += 1;
                        let fraction = (lod + 0.5) - (lod + 0.5).round();
                        assert!(fraction.abs() < 0.02, "level {level} for {lod}");
                    }
                }
            }
        }
        assert!(pixels > 10_000);
        assert!(worst < 1.0 / 1000.0, "off by {worst} texel");
        assert!(near_miss * 100 < pixels, "{near_miss} of {pixels}");
    }
}
