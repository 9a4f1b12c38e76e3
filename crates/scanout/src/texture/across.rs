//! Across a small triangle: texel coordinates by a polynomial where it is proven to give the definition's texel, and nowhere else.
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
//! planes of 1/w, s/w, t/w, and no reciprocal a run. Multiplied out, G (1 - E + T^2 / 2) is a polynomial of second degree in
//! columns X and rows Y from the pixel of corner 0, whose six coefficients cost nine products an axis; a row begins with two of
//! its partial sums, and its pixels follow by second differences, which are exact. The value strays from the definition's by `e`,
//! by what the definition rounds (2^-21 of s) and by what is rounded here; where no texel's border lies within that margin, the
//! texel is the definition's. Elsewhere, one or two pixels in a hundred, `1 / (1 + E) = 1 - E + E^2 - E^3 + ...` leaves a margin
//! a few times smaller, and where that doesn't decide either, the definition is computed.
//!
//! | value | format |
//! |---|---|
//! | polynomial, coordinate, step | 22 fraction bits of a texel, modulo 1024 texels |
//! | margin | 16 fraction bits |
//! | G; its changes a sixteenth of a pixel | 20 fraction bits; the same integer is the change a pixel in 16 |
//! | E; its changes a sixteenth of a pixel | 26 fraction bits; the same integer is the change a pixel in 22 |
//!
//! What it will not do: triangles beyond 32 pixels or 64 texels, with more than 16 texels a pixel or hardly any area, those that
//! reach into the next repeat, those whose 1/w changes by more than an eighth, or by a 32nd a pixel, and those whose texels a pixel
//! times that change come to a quarter.

use super::MAX_SIZE;
use super::along::Block;
use super::perspective::reciprocal;
use crate::math::{leading_zeros, mixed_product, quotient};
use crate::raster::small::LARGEST;
use crate::setup::Triangle;

/// The largest margin that is worth its while: pixels without a certain texel cost as much as ten others.
const WIDEST: u32 = 1 << 10;

/// Fraction bits of the polynomial.
const FRACTION: u32 = 22;

// A coordinate has room beside them.
const _: () = assert!(MAX_SIZE as u64 <= 1 << (32 - FRACTION));

/// A coordinate X columns and Y rows from a pixel: `c + x X + y Y + xx X^2 + xy X Y + yy Y^2`.
#[derive(Clone, Copy, Debug, Default)]
struct Polynomial {
    c: i32,
    x: i32,
    y: i32,
    xx: i32,
    xy: i32,
    yy: i32,
}

/// A small triangle's way through a texture.
#[derive(Clone, Copy, Debug)]
pub struct Across {
    /// The pixel of corner 0.
    from: [i32; 2],
    /// The coordinates less the margin, from there on.
    way: [Polynomial; 2],
    /// [`Block::limit`].
    limit: u32,
    detail: Detail,
}

/// What [`Across::closer`] needs.
#[derive(Clone, Copy, Debug)]
struct Detail {
    /// Corner 0 less the centre of pixel (0, 0), Q28.4.
    corner: [i32; 2],
    /// Its coordinates, 16 fraction bits.
    at: [u32; 2],
    /// Changes of G in x and y, an axis each.
    slopes: [[i32; 2]; 2],
    /// E at corner 0 less T^2 / 2, and its changes in x and y.
    bend: [i32; 3],
    /// `T^2 / 2`.
    half: i32,
    margin: u32,
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
        let normal = leading_zeros(t.area as u32 | 1);
        // Twice the area is at least 1/8 pixel.
        if width.max(height) > LARGEST || normal > 26 || (high - low) * 8 > middle {
            return None;
        }
        // 2^34 / middle; products below 2^31.
        let ratio = quotient(1 << 31, middle >> 3);
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
            let high = (mixed_product(n << more, inverse << 7) >> 32) as i32;
            (high + ((1 << fewer) >> 1)) >> fewer
        };

        let half = (((most * most) >> 21) << 6) as i32;
        let [e1, e2] = [b[1] - b[0], b[2] - b[0]];
        let bend =
            [(b[0] << 6) - half, gradient(e1, e2, by_x, fewer), gradient(e1, e2, by_y, fewer)];
        let (mut at, mut slopes) = ([0; 2], [[0; 2]; 2]);
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
            at[axis] = ((u0 << 4) + 8) as u32;
            slopes[axis] = [gradient(u1, u2, by_x, fewer - 2), gradient(u1, u2, by_y, fewer - 2)];
        }
        let (texels, most) = ((texels >> 12) + 1, (most >> 10) + 1);
        let largest = |a: &[i32]| a.iter().fold(0, |most, v| v.unsigned_abs().max(most));
        let (slope, turn) = (largest(slopes.as_flattened()), largest(&bend[1..]));
        // What is multiplied keeps to 31 bits: a slope without its last 6 bits times a change of E.
        if slope >= 1 << 20 || turn >= 1 << 17 || ((slope >> 8) + 1) * ((turn >> 4) + 1) > 1 << 24 {
            return None;
        }
        let box_size = [width, height].map(|v| (v >> 4) as u32 + 1);
        let [margin, closer] = margins(size[0].max(size[1]), texels, most, box_size);
        if margin > WIDEST || room != 0 {
            return None;
        }
        let corner = t.corners[0].map(|v| v - 8);
        let mut across = Across {
            from: t.corners[0].map(|v| v >> 4),
            way: [Polynomial::default(); 2],
            limit: Block::<FRACTION>::limit(margin << (FRACTION - 16)),
            detail: Detail { corner, at, slopes, bend, half, margin: closer },
        };
        // From corner 0 to the centre of its pixel.
        let [x, y] = t.corners[0].map(|v| 8 - (v & 15));
        let [start, ex, ey] = bend;
        let e = plane(start, [ex, ey], x, y) >> 8;
        for ((way, at), [gx, gy]) in across.way.iter_mut().zip(at).zip(slopes) {
            let g = plane(0, [gx, gy], x, y);
            let [short, short_x, short_y] = [g >> 10, gx >> 6, gy >> 6];
            let turned = |gx: i32, ex: i32| (gx * e + ((short * ex) >> 4)) >> 6;
            let nearest = |n: i32| (n + (1 << 9)) >> 10;
            *way = Polynomial {
                c: (at.wrapping_sub(margin) << (FRACTION - 16)) as i32,
                x: (gx << (FRACTION - 16)) - turned(short_x, ex),
                y: (gy << (FRACTION - 16)) - turned(short_y, ey),
                xx: -nearest(short_x * ex),
                xy: -nearest(short_x * ey + short_y * ex),
                yy: -nearest(short_y * ey),
            };
            way.c = way.c.wrapping_add((g << (FRACTION - 20)) - ((short * e) >> 6));
        }
        Some(across)
    }

    /// The pixels of a row from (x, y) on, all covered.
    #[inline(always)]
    pub fn block(&self, x: i32, y: i32) -> Block<FRACTION> {
        let (x, y) = (x - self.from[0], y - self.from[1]);
        let mut block = Block { limit: self.limit, ..Block::NONE };
        for (axis, way) in self.way.iter().enumerate() {
            let row =
                way.c.wrapping_add(y.wrapping_mul(way.y.wrapping_add(y.wrapping_mul(way.yy))));
            let slope = way.x.wrapping_add(y.wrapping_mul(way.xy));
            let half_turn = x.wrapping_mul(way.xx);
            let mean = slope.wrapping_add(half_turn);
            block.at[axis] = row.wrapping_add(x.wrapping_mul(mean)) as u32;
            block.step[axis] = mean.wrapping_add(half_turn).wrapping_add(way.xx) as u32;
            block.bend[axis] = way.xx.wrapping_mul(2) as u32;
        }
        block
    }

    /// The texel of a covered pixel by a smaller margin, if that is certain.
    #[cold]
    #[inline(never)]
    pub fn closer(&self, x: i32, y: i32) -> Option<[u32; 2]> {
        let Detail { corner, at, slopes, bend: [start, by_x, by_y], half, margin } = self.detail;
        let (x, y) = (16 * x - corner[0], 16 * y - corner[1]);
        let e = plane(start + half, [by_x, by_y], x, y) >> 8;
        let square = (e * e) >> 18;
        let bent = e - square + ((square * e) >> 18);
        let at = [0, 1].map(|axis: usize| {
            let g = plane(0, slopes[axis], x, y);
            let u = (g >> 4) - (((g >> 10) * bent) >> 12);
            at[axis].wrapping_sub(margin).wrapping_add(u as u32)
        });
        Block::<16> { at, limit: Block::<16>::limit(margin), ..Block::NONE }.texel()
    }
}

/// The value of a plane, in range at covered pixels.
#[inline(always)]
fn plane(start: i32, [by_x, by_y]: [i32; 2], x: i32, y: i32) -> i32 {
    start.wrapping_add(by_x.wrapping_mul(x)).wrapping_add(by_y.wrapping_mul(y))
}

/// How far a coordinate may stray from the definition's, in 16 fraction bits, by the polynomial and in [`Across::closer`]: from the
/// texture's larger side, the most texels from corner 0, `T` in 1/1024, and the box in pixels; `sum` is width + height.
///
/// | from | at most |
/// |---|---|
/// | the definition: 1/w without its fraction bits, planes, their lift | `size / 37` |
/// | `u_i (1 + b_i)` to 12 bits | 16 |
/// | `q_i / m` to 2^-11 of itself, in G and E; to 18 bits in G | `texels T / 16 + texels / 4 + T / 16` |
/// | G's gradients to a unit, over the box | `sum + 2` |
/// | **polynomial:** `e` | `texels T^2 / 28` |
/// | E's gradients to a unit, over the box; E to 18 bits; in G E | `texels (sum / 64 + 5 / 16)` |
/// | G without 6 bits, the same in all products, times E | `(sum + 1) T / 16` |
/// | what is cut off coefficients | `sum^2 / 128 + sum / 64 + 1` |
/// | **closer:** E^4; E^2 and E^3 to 18 bits | `texels T / 60 + texels / 2` |
/// | E's gradients to a unit, over the box; E to 18 bits; in G E | `texels (sum + 12) / 30` |
/// | G to 10 bits where it is multiplied | `T / 16` |
#[inline]
fn margins(size: u32, texels: u32, bend: u32, [width, height]: [u32; 2]) -> [u32; 2] {
    let sum = width + height;
    let common = 24 + size / 32 + sum;
    let for_a_texel = bend * bend * 5 + bend * 8 + sum * 2 + 80;
    let polynomial = bend / 16 + 4 + ((texels * for_a_texel + sum * (sum + 8 * bend)) >> 7);
    let closer = bend / 4 + ((texels * (bend * 12 + sum * 5 + 200)) >> 7);
    [common + polynomial, common + closer]
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
        let (mut certain, mut uncertain) = (0u32, 0u32);
        // Of triangles in depth: by either margin.
        let mut deep = [0u32; 2];
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
            let margin = across.limit.wrapping_neg() >> 11;
            let typical = (case % 5 != 0) as u32;
            let in_depth = typical * (depth == 1 << 20) as u32;
            let (setup, _) = sampler.setup_and_fit(&t, uv, q);
            let q_plane = t.plane(q.map(|q| q << 8));
            for y in t.min()[1]..t.max()[1] {
                let Some(first) = (t.min()[0]..t.max()[0]).find(|&x| t.covers(x, y)) else {
                    continue;
                };
                let end = (first..t.max()[0]).find(|&x| !t.covers(x, y)).unwrap_or(t.max()[0]);
                let mut block = across.block(first, y);
                for x in first..end {
                    let st = setup.st.map(|p| p.at(x, y));
                    let r = reciprocal(integer_q(q_plane.at(x, y)));
                    let texel = sampler.texel565(&setup, st, r) as u32;
                    match block.texel() {
                        Some([s, t]) => {
                            certain += 1;
                            assert_eq!(t * sides[0] + s, texel, "{v:?} {uv:?} {q:?} at {x}, {y}");
                        }
                        None => {
                            uncertain += typical;
                            deep[0] += in_depth;
                        }
                    }
                    match across.closer(x, y) {
                        Some([s, t]) => assert_eq!(t * sides[0] + s, texel, "{v:?} {uv:?} {q:?}"),
                        None => deep[1] += in_depth,
                    }
                    for (axis, &size) in sides.iter().enumerate() {
                        let got = block.at[axis].wrapping_add(margin).wrapping_sub(8 << 6);
                        let expected = exact(&t, uv.map(|uv| uv[axis]), q, size, [x, y]);
                        // Modulo 1024 texels.
                        let off = got.wrapping_sub((expected * 4194304.0).round() as i64 as u32);
                        let off = (off as i32 as f64).abs() / margin as f64;
                        worst = worst.max(off);
                        assert!(off < 1.0, "{off} {margin}: {v:?} {uv:?} {q:?} at {x}, {y}");
                    }
                    block.step();
                }
            }
        }
        std::println!(
            "{certain} certain, {uncertain} not; {deep:?} in depth; {taken:?}; {worst} of the margin"
        );
        assert!(certain > 20 * uncertain && deep[0] > 2 * deep[1]);
        assert!(taken[1] > 5_000);
    }
}
