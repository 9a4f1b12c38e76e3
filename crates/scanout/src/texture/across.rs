//! Across a small triangle: texel coordinates by a quadratic where it is proven to give the definition's texel, and nowhere else.
//!
//! With the corners' weights `l0 + l1 + l2 = 1` (linear on the screen), the middle `m` of the corners' 1/w, `u_i` the place of corner i
//! in the texture less that of corner 0, and `b_i = q_i / m - 1`, a texel coordinate less corner 0's is, exactly,
//!
//! ```text
//!             l1 u1 (1 + b1) + l2 u2 (1 + b2)       G
//!     u  =   --------------------------------  =  -----      G, E linear, G = 0 at corner 0, |E| <= T = max |b_i|
//!               1 + l0 b0 + l1 b1 + l2 b2         1 + E
//!
//!        =   G (1 - E + T^2 / 2) + e                |e| <= |G| T^2 (1/2 + 1.07 T)       T <= 1/16
//! ```
//!
//! A small triangle's 1/w hardly changes, so `e` is far below a texel. Six gradients are all that is made for a triangle: no
//! planes of 1/w, s/w, t/w, and no reciprocal a run. A row's pixels follow by second differences. The value strays
//! from the definition's by `e`, by what the definition rounds (2^-21 of s) and by what is rounded here; where no texel's border lies within
//! that margin, the texel is the definition's. Elsewhere, two pixels in a hundred, `1 / (1 + E) = 1 - E + E^2 - E^3 + ...` leaves a margin a few times smaller, and
//! where that doesn't decide either, the definition is computed.
//!
//! | value | format |
//! |---|---|
//! | coordinate, step, margin | 16 fraction bits of a texel |
//! | G; its changes a sixteenth of a pixel | 20 fraction bits; the same integer is the change a pixel in 16 |
//! | E; its changes a sixteenth of a pixel | 26 fraction bits; the same integer is the change a pixel in 22 |
//!
//! What it will not do: triangles beyond 32 pixels or 64 texels, with more than 16 texels a pixel or hardly any area, those that reach into
//! the next repeat, and those whose 1/w changes by more than an eighth.

use super::along::Block;
use super::perspective::reciprocal;
use crate::raster::small::LARGEST;
use crate::setup::Triangle;

/// The largest margin that is worth its while: pixels without a certain texel cost as much as ten others.
const WIDEST: u32 = 1 << 10;

/// A small triangle's way through a texture.
#[derive(Clone, Copy, Debug)]
pub struct Across {
    /// Corner 0 less the centre of pixel (0, 0), Q28.4.
    corner: [i32; 2],
    /// Its coordinates less the margin.
    at: [u32; 2],
    /// Changes of G in x and y, an axis each.
    slopes: [[i32; 2]; 2],
    /// E at corner 0 less T^2 / 2, and its changes in x and y.
    bend: [i32; 3],
    /// `T^2 / 2`.
    half: i32,
    /// Changes of G times those of E along x, 16 fraction bits.
    curve: [i32; 2],
    margin: u32,
    /// Of [`closer`](Self::closer).
    closer: u32,
}

impl Across {
    /// From a triangle, its corners' texture coordinates (Q16.16) and 1/w (integers, the largest in [2^22, 2^23)).
    #[inline(never)]
    pub fn new(t: &Triangle, uv: [[i32; 2]; 3], q: [u32; 3], size: [u32; 2]) -> Option<Across> {
        let [a, b, c] = t.corners;
        let extent = |i: usize| a[i].max(b[i]).max(c[i]) - a[i].min(b[i]).min(c[i]);
        let [width, height] = [extent(0), extent(1)];
        let (low, high) = (q[0].min(q[1]).min(q[2]), q[0].max(q[1]).max(q[2]));
        let middle = (low + high) / 2;
        let normal = (t.area as u32).leading_zeros();
        // Twice the area is at least 1/8 pixel.
        if width.max(height) > LARGEST || normal > 26 || (high - low) * 8 > middle {
            return None;
        }
        // 2^34 / middle; products below 2^31.
        let ratio = (1 << 31) / (middle >> 3).max(1);
        let b = q.map(|q| ((q as i32 - middle as i32) * ratio as i32 + (1 << 13)) >> 14);
        let most = b[0].unsigned_abs().max(b[1].unsigned_abs()).max(b[2].unsigned_abs());

        let ([d1, d2], inverse) = (t.sides(), reciprocal((t.area as u32) << (normal - 9)) as u32);
        let [by_x, by_y] = [[d2[1], -d1[1]], [-d2[0], d1[0]]];
        // A gradient of what is `first` at corner 1, `second` at corner 2 and 0 at corner 0: `n 2^(32 - fewer) / area`, nearest.
        // Those of less than a pixel have small `n`, which leave room for more bits.
        let (more, fewer) = if normal > 22 { (normal - 22, 3) } else { (0, 25 - normal) };
        let mut room = 0;
        let mut gradient = |first: i32, second: i32, weights: [i32; 2], fewer: u32| {
            let n = first * weights[0] + second * weights[1];
            room |= n.unsigned_abs() >> (30 - more);
            let high = (((n << more) as i64 * ((inverse << 7) as i64)) >> 32) as i32;
            (high + ((1 << fewer) >> 1)) >> fewer
        };

        let mut across = Across {
            corner: t.corners[0].map(|v| v - 8),
            at: [0; 2],
            slopes: [[0; 2]; 2],
            bend: [0; 3],
            half: (((most * most) >> 21) << 6) as i32,
            curve: [0; 2],
            margin: 0,
            closer: 0,
        };
        let [e1, e2] = [b[1] - b[0], b[2] - b[0]];
        across.bend = [
            (b[0] << 6) - across.half,
            gradient(e1, e2, by_x, fewer),
            gradient(e1, e2, by_y, fewer),
        ];
        let mut texels = 0;
        for axis in 0..2 {
            let places = uv.map(|uv| uv[axis]);
            let repeats = places[0].min(places[1]).min(places[2]) & !0xffff;
            let [u0, u1, u2] = places.map(|u| u.wrapping_sub(repeats) as u32);
            if u0.max(u1).max(u2) > 1 << 16 {
                return None;
            }
            let [u0, u1, u2] = [u0, u1, u2].map(|u| ((u * size[axis] + 8) >> 4) as i32);
            let (u1, u2) = (u1 - u0, u2 - u0);
            if u1.unsigned_abs().max(u2.unsigned_abs()) >= 1 << 18 {
                return None;
            }
            let over_w = |u: i32, b: i32| u + (((u >> 2) * (b >> 2) + (1 << 15)) >> 16);
            let (u1, u2) = (over_w(u1, b[1]), over_w(u2, b[2]));
            texels = texels.max(u1.unsigned_abs()).max(u2.unsigned_abs());
            across.at[axis] = ((u0 << 4) + 8) as u32;
            across.slopes[axis] =
                [gradient(u1, u2, by_x, fewer - 2), gradient(u1, u2, by_y, fewer - 2)];
        }
        let (texels, most) = ((texels >> 12) + 1, (most >> 10) + 1);
        let by_x = across.bend[1];
        let steepest = across.slopes[0][0].unsigned_abs().max(across.slopes[1][0].unsigned_abs());
        // What is multiplied along a row keeps to 32 bits.
        if by_x.unsigned_abs() >= 1 << 18
            || texels * by_x.unsigned_abs() >= 3 << 20
            || steepest >= 1 << 20
            || most * steepest >= 3 << 24
        {
            return None;
        }
        for (curve, [slope, _]) in across.curve.iter_mut().zip(across.slopes) {
            *curve = ((slope >> 6).checked_mul(by_x)? + (1 << 15)) >> 16;
        }
        let margins = margins(
            size[0].max(size[1]),
            texels,
            most,
            [width, height].map(|v| (v >> 4) as u32 + 1),
        );
        [across.margin, across.closer] = margins;
        if across.margin > WIDEST || room != 0 {
            return None;
        }
        across.at = across.at.map(|at| at.wrapping_sub(across.margin));
        Some(across)
    }

    /// The `count` pixels from (x, y) on, all covered.
    #[inline(always)]
    pub fn block(&self, x: i32, y: i32, count: u32) -> Block {
        let (x, y) = (16 * x - self.corner[0], 16 * y - self.corner[1]);
        let [start, by_x, by_y] = self.bend;
        let e = plane(start, [by_x, by_y], x, y) >> 8;
        let mut block = Block { limit: (1 << 16) - 2 * self.margin, ..Block::NONE };
        for axis in 0..2 {
            let slope = self.slopes[axis];
            let g = plane(0, slope, x, y);
            let bent = ((g >> 12) * e) >> 10;
            block.at[axis] = self.at[axis].wrapping_add(((g >> 4) - bent) as u32);
            if count > 1 {
                let turn = ((g >> 12) * by_x + (slope[0] >> 4) * e + (1 << 13)) >> 14;
                block.step[axis] = (slope[0] - turn - self.curve[axis]) as u32;
                block.bend[axis] = (-2 * self.curve[axis]) as u32;
            }
        }
        block
    }

    /// The texel of a covered pixel by a smaller margin, if that is certain.
    #[cold]
    #[inline(never)]
    pub fn closer(&self, x: i32, y: i32) -> Option<[u32; 2]> {
        let (x, y) = (16 * x - self.corner[0], 16 * y - self.corner[1]);
        let [start, by_x, by_y] = self.bend;
        let e = plane(start + self.half, [by_x, by_y], x, y) >> 8;
        let square = (e * e) >> 18;
        let bent = e - square + ((square * e) >> 18);
        let at = [0, 1].map(|axis: usize| {
            let g = plane(0, self.slopes[axis], x, y);
            let u = (g >> 4) - (((g >> 10) * bent) >> 12);
            self.at[axis].wrapping_add(self.margin).wrapping_sub(self.closer).wrapping_add(u as u32)
        });
        Block { at, limit: (1 << 16) - 2 * self.closer, ..Block::NONE }.texel()
    }
}

/// The value of a plane, in range at covered pixels.
#[inline(always)]
fn plane(start: i32, [by_x, by_y]: [i32; 2], x: i32, y: i32) -> i32 {
    start.wrapping_add(by_x.wrapping_mul(x)).wrapping_add(by_y.wrapping_mul(y))
}

/// How far a coordinate may stray from the definition's, in 16 fraction bits, along a row and in [`Across::closer`]: from the texture's
/// larger side, the most texels from corner 0, `T` in 1/1024, and the box in pixels.
///
/// | from | at most |
/// |---|---|
/// | the definition: 1/w without its fraction bits, planes | `size / 45` |
/// | `u_i (1 + b_i)` to 12 bits | 16 |
/// | `q_i / m` to 2^-11 of itself, in G and E; to 18 bits in G | `texels T / 16 + texels / 4 + T / 16` |
/// | G's gradients to a unit, over the box | `width + height + 2` |
/// | E's gradients to a unit, over the box; E to 18 bits; in G E | `texels (width + height + 12) / 30` |
/// | **along a row:** `e` | `texels T^2 / 28` |
/// | E's gradients and E in the changes along x | `texels (width + height + 12) / 15` |
/// | G to 8 bits where it is multiplied | `3 T / 4` |
/// | steps: their rounding, slopes to 12 bits, gradients of E in them | `width / 2 + width T / 64 + width texels / 16` |
/// | curve: its rounding, slopes to 10 bits | `width^2 / 2 + width T / 8` |
/// | **closer:** E^4; E^2 and E^3 to 18 bits | `texels T / 60 + texels / 2` |
/// | G to 10 bits where it is multiplied | `T / 16` |
#[inline]
fn margins(size: u32, texels: u32, bend: u32, [width, height]: [u32; 2]) -> [u32; 2] {
    let sum = width + height;
    let common = 24 + size / 32 + sum;
    let for_a_texel = bend * bend * 5 + bend * 8 + sum * 13 + 180 + width * 8;
    let for_a_column = 8 + width * 8 + bend * 3;
    let along = bend + ((texels * for_a_texel) >> 7) + ((width * for_a_column) >> 4);
    let closer = bend / 4 + ((texels * (bend * 12 + sum * 5 + 200)) >> 7);
    [common + along, common + closer]
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::super::{Repeat565, Sampler, Texels, Texture, integer_q};
    use super::*;

    struct Random(u64);
    impl Random {
        fn next(&mut self, n: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) % n
        }
    }

    /// The exact coordinate in texels at the centre of pixel (x, y), without its repeats.
    fn exact(t: &Triangle, u: [i32; 3], q: [u32; 3], size: u32, at: [i32; 2]) -> f64 {
        let p = at.map(|v| 16.0 * v as f64 + 8.0);
        let v = t.corners.map(|v| v.map(f64::from));
        let least = u[0].min(u[1]).min(u[2]) & !0xffff;
        let (mut over, mut under) = (0.0, 0.0);
        for (i, (u, q)) in u.into_iter().zip(q).enumerate() {
            let (a, b) = (v[(i + 1) % 3], v[(i + 2) % 3]);
            let weight = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            let place = (((u - least) as u32 * size + 8) >> 4) as f64 / 4096.0;
            over += weight * q as f64 * place;
            under += weight * q as f64;
        }
        over / under
    }

    /// Every certain texel is the definition's; coordinates stray by less than the margin, and most triangles such as models have are
    /// taken.
    #[test]
    fn what_is_certain_is_the_definition() {
        let texels: [u16; 250 * 256] = core::array::from_fn(|i| i as u16);
        let mut random = Random(9);
        let (mut certain, mut uncertain, mut undecided) = (0u32, 0u32, 0u32);
        let (mut taken, mut worst) = ([0u32; 2], 0f64);
        for case in 0..60_000usize {
            let size = [(256, 250), (16, 16), (250, 256), (1, 64)][case % 4];
            let texture = Texture::new(size.0, size.1, Texels::Rgb565(&texels)).unwrap();
            let sampler = Repeat565::new(&texture).unwrap();
            let extent = [512, 200, 90][case % 3];
            let v = [(); 3]
                .map(|()| [2000 + random.next(extent) as i32, 90_000 + random.next(extent) as i32]);
            let Some(t) = Triangle::new(v) else { continue };
            // Up to 64 texels from anywhere, or on the texture's borders.
            let spread = [1 << 12, 1 << 14, 1 << 16][case / 3 % 3];
            let from = [0, 1].map(|_| random.next((1 << 18) + 1 - spread) as i32 - (1 << 17));
            let mut uv = [(); 3].map(|()| from.map(|from| from + random.next(spread + 1) as i32));
            if case % 5 == 0 {
                uv = uv.map(|uv| uv.map(|v| v & !0xfff));
            }
            let depth = [1, 1 << 12, 1 << 16, 1 << 20][case / 9 % 4];
            let top = (1 << 22) + random.next(1 << 22) as u32;
            let mut q = [(); 3].map(|()| top - random.next(depth) as u32);
            q[case % 3] = top;
            let sides = sampler.size.map(|size| size as u32);
            let across = Across::new(&t, uv, q, sides);
            taken[across.is_some() as usize] += 1;
            let Some(across) = across else { continue };
            let margin = across.margin;
            let typical = (case % 5 != 0) as u32;
            let (setup, _) = sampler.setup_and_fit(&t, uv, q);
            let q_plane = t.plane(q.map(|q| q << 8));
            for y in t.min()[1]..t.max()[1] {
                let Some(first) = (t.min()[0]..t.max()[0]).find(|&x| t.covers(x, y)) else {
                    continue;
                };
                let end = (first..t.max()[0]).find(|&x| !t.covers(x, y)).unwrap_or(t.max()[0]);
                let mut block = across.block(first, y, (end - first) as u32);
                for x in first..end {
                    let st = setup.st.map(|p| p.at(x, y));
                    let r = reciprocal(integer_q(q_plane.at(x, y)));
                    let texel = sampler.texel565(&setup, st, r) as u32;
                    match block.texel() {
                        Some([s, t]) => {
                            certain += 1;
                            assert_eq!(t * sides[0] + s, texel, "{v:?} {uv:?} {q:?} at {x}, {y}");
                        }
                        None => uncertain += typical,
                    }
                    match across.closer(x, y) {
                        Some([s, t]) => assert_eq!(t * sides[0] + s, texel, "{v:?} {uv:?} {q:?}"),
                        None => undecided += typical,
                    }
                    for (axis, &size) in sides.iter().enumerate() {
                        let got = block.at[axis].wrapping_add(margin) as i32 - 8;
                        let expected = exact(&t, uv.map(|uv| uv[axis]), q, size, [x, y]);
                        let off = (got as f64 - expected * 65536.0).abs() / margin as f64;
                        worst = worst.max(off);
                        assert!(off < 1.0, "{off} {margin}: {v:?} {uv:?} {q:?} at {x}, {y}");
                    }
                    block.step();
                }
            }
        }
        std::println!(
            "{certain} certain, {uncertain} not, {undecided} not by less; {taken:?}; {worst} of the margin"
        );
        assert!(certain > 20 * uncertain && uncertain > 2 * undecided);
        assert!(taken[1] > 5_000);
    }
}
