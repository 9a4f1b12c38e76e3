//! Along a row: texel coordinates by second differences where they are proven to be the definition's, and nowhere else.
//!
//! The planes of 1/w and s/w are linear, so from a pixel where `Q`, `s` and `r` are known, `i` pixels further right
//!
//! ```text
//! s(i) = s + d i / (1 + p i)              d = (gs K - s gq) / Q the slope, p = gq / Q
//!      = s + d i - d p (1 - p n) i^2 + e    |e| <= |d| p^2 n^3 (4/27 + 1.07 |p| n)      0 <= i <= n
//! ```
//!
//! A block of n pixels is walked by adding; the value strays from the definition's by at most `e`, by what the definition
//! itself rounds (`q` without its fraction bits, `r` down: together 2^-20 of s on each side where q >= 2^20) and by
//! what is rounded here. Where no texel's border lies within that margin, the texel is the definition's; elsewhere, a few
//! pixels in a hundred, the definition is computed. So pixels are the same bits, without a division and 64-bit products at each.
//!
//! | value | format |
//! |---|---|
//! | coordinate, slope, margin | 21 fraction bits of a texel, modulo 2048 texels |
//! | p | 32 fraction bits, below 1/32 |
//!
//! What it will not do: blocks that leave the texture, 16 texels a pixel and more, gradients beyond 32 bits; there every pixel is
//! computed from the definition.

use super::perspective::{Perspective, column_and_row, integer_q, reciprocal};
use crate::interpolate::Plane;

/// Fraction bits of a coordinate.
const FRACTION: u32 = 21;

/// How many more these are than a margin's for a slope of 1.
const MORE: u32 = FRACTION - 16;

/// The longest block in pixels.
const LONGEST: u32 = 32;

/// The least 1/w (without fraction bits) that the margin holds for.
const LEAST_Q: u32 = 1 << 20;

/// The largest side of a texture that the margin holds for.
const LARGEST: u32 = 1 << 10;

// A block that leaves the texture is seen by its ends: it is at most 512 texels long.
const _: () = assert!(LARGEST + 512 < 1 << (32 - FRACTION));

/// A triangle's way along its rows.
#[derive(Clone, Copy, Debug)]
pub struct Along {
    /// Changes a column: 1/w, s/w, t/w.
    gradients: [i32; 3],
    size: [u32; 2],
    shift: [u32; 2],
    /// Pixels in a block; 1 where blocks are of no use.
    length: u32,
    /// Bound of the remainder for a slope of 1, 16 fraction bits.
    bend_error: u32,
    /// Bound of what is rounded, in a coordinate's format: what the definition rounds, four units a pixel for the slope, two a pixel
    /// squared for the bend.
    rounded: [u32; 2],
}

/// Texel coordinates from pixel to pixel, with so many fraction bits.
#[derive(Clone, Copy, Debug)]
pub struct Block<const FRACTION: u32> {
    /// The coordinates less the margin.
    pub(super) at: [u32; 2],
    pub(super) step: [u32; 2],
    pub(super) bend: [u32; 2],
    /// A texel is certain where both fractions, in the uppermost bits, lie below: 1 less twice the margin. (A shift needs no mask in a
    /// register.)
    pub(super) limit: u32,
}

impl Block<FRACTION> {
    /// A single pixel, by the definition: values of the planes as for [`Along::block`].
    #[inline(never)]
    pub fn one(perspective: &Perspective, size: [u64; 2], q: u32, st: [u32; 2]) -> Self {
        let r = reciprocal(integer_q(q));
        let texel = column_and_row(size, perspective.shift, st, r);
        Block { at: texel.map(|v| (v as u32) << FRACTION), limit: u32::MAX, ..Block::NONE }
    }
}

impl<const FRACTION: u32> Block<FRACTION> {
    /// Nothing is certain.
    pub(super) const NONE: Self = Block { at: [0; 2], step: [0; 2], bend: [0; 2], limit: 0 };

    /// Below which fractions are certain with a margin in units of a coordinate, which isn't 0.
    #[inline(always)]
    pub(super) const fn limit(margin: u32) -> u32 {
        (margin << (33 - FRACTION)).wrapping_neg()
    }

    /// To the next pixel.
    #[inline(always)]
    pub fn step(&mut self) {
        for axis in 0..2 {
            self.at[axis] = self.at[axis].wrapping_add(self.step[axis]);
            self.step[axis] = self.step[axis].wrapping_add(self.bend[axis]);
        }
    }

    /// The texel, if it is certain.
    #[inline(always)]
    pub fn texel(&self) -> Option<[u32; 2]> {
        let [s, t] = self.at;
        let whole = 32 - FRACTION;
        (s << whole < self.limit && t << whole < self.limit)
            .then_some([s >> FRACTION, t >> FRACTION])
    }
}

impl Along {
    /// From a triangle's planes, whose gradients fit 32 bits where `fits`, and its corners' 1/w.
    #[inline]
    pub fn new(
        perspective: &Perspective,
        q_plane: &Plane,
        q: [u32; 3],
        size: [u32; 2],
        fits: bool,
    ) -> Along {
        let gradient = |plane: &Plane| plane.gx as i32;
        let [s, t] = &perspective.st;
        let gradients = [gradient(q_plane), gradient(s), gradient(t)];
        let least = q[0].min(q[1]).min(q[2]);
        let usable = fits && least >= LEAST_Q && size[0].max(size[1]) <= LARGEST;
        // p, rounded up to 16 fraction bits: at covered pixels the plane lies above its least corner, but for rounding.
        let p =
            gradients[0].unsigned_abs() / ((least << 8).saturating_sub(1 << 13) >> 16).max(1) + 1;
        // Blocks with p^2 n^3 up to 3/32 leave few pixels uncertain.
        let mut length = LONGEST;
        let square = if p < 1 << 11 { p * p } else { u32::MAX };
        while length > 2
            && (square as u64 * (length * length * length) as u64 > 3 << 27 || p * length > 1 << 13)
        {
            length -= length.div_ceil(8);
        }
        let cube = length * length * length;
        let shift = perspective.shift;
        if !usable || length < 4 {
            return Along { gradients, size, shift, length: 1, bend_error: 0, rounded: [0; 2] };
        }
        // 4/27 + 1.07 |p| n in 5 fraction bits, rounded up; p n is at most 1/8.
        let factor = 6 + ((p * length) >> 10);
        // And what a slope's own error, 2^-20 of it, comes to.
        let bend_error = ((square as u64 * cube as u64 * factor as u64) >> 21) as u32 + 4;
        let n = length;
        let of = |size: u32| ((size / 5 + 4) << MORE) + 4 * n + 2 * n * n;
        let rounded = [of(size[0]), of(size[1])];
        Along { gradients, size, shift, length, bend_error, rounded }
    }

    /// How many pixels a block may have.
    #[inline(always)]
    pub fn length(&self) -> u32 {
        self.length
    }

    /// A block of `count` pixels, two at least, from one with these values of the planes.
    #[inline]
    pub fn block(&self, q: u32, st: [u32; 2], count: u32) -> Block<FRACTION> {
        if count < 2 || count > self.length || q >> 8 < LEAST_Q {
            return Block::NONE;
        }
        let r = reciprocal(q >> 8) as u32;
        let p = ((self.gradients[0] as i64 * r as i64) >> 23) as i32;
        // p n in 16 fraction bits.
        let over = (p >> 16) * self.length as i32;
        let (mut block, mut margin) = (Block::NONE, 0);
        for (axis, &over_w) in st.iter().enumerate() {
            let (shift, size) = (self.shift[axis] - (FRACTION - 12), self.size[axis] << FRACTION);
            let at = (over_w as u64 * r as u64) >> shift;
            if at >= size as u64 {
                return Block::NONE;
            }
            let at = at as u32;
            let slope = (self.gradients[axis + 1] as i64 * r as i64) >> shift;
            let slope = slope - ((at as i32 as i64 * p as i64) >> 32);
            if slope.unsigned_abs() >= 1 << (20 + MORE) {
                return Block::NONE;
            }
            let slope = slope as i32;
            // 24 fraction bits, then a coordinate's.
            let bent = ((slope as i64 * p as i64) >> (24 + MORE)) as i32;
            let bend = -((bent - (((bent >> 6) * over) >> 10) + (1 << (7 - MORE))) >> (8 - MORE));
            let bent_away = ((slope.unsigned_abs() >> MORE) * self.bend_error) >> (16 - MORE);
            let own = self.rounded[axis] + bent_away;
            let last = count - 1;
            let end = at
                .wrapping_add((slope as u32).wrapping_mul(last))
                .wrapping_add((bend as u32).wrapping_mul(last * last));
            // Between the ends the coordinate is monotonic.
            let inside = |v: u32| v.wrapping_sub(2 * own) < size.saturating_sub(4 * own);
            if !inside(at) || !inside(end) {
                return Block::NONE;
            }
            block.at[axis] = at;
            block.step[axis] = slope.wrapping_add(bend) as u32;
            block.bend[axis] = (2 * bend) as u32;
            margin = margin.max(own);
        }
        if margin >= 1 << (14 + MORE) {
            return Block::NONE;
        }
        let [s, t] = block.at;
        let at = [s.wrapping_sub(margin), t.wrapping_sub(margin)];
        Block { at, limit: Block::<FRACTION>::limit(margin), ..block }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::super::{Repeat565, Sampler, Texels, Texture, integer_q};
    use super::*;
    use crate::setup::Triangle;

    struct Random(u64);
    impl Random {
        fn next(&mut self, n: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) % n
        }
    }

    /// Every certain texel is the definition's, and most are certain where triangles are such as models have.
    #[test]
    fn what_is_certain_is_the_definition() {
        let texels: [u16; 250 * 256] = core::array::from_fn(|i| i as u16);
        let mut random = Random(9);
        let (mut certain, mut uncertain) = (0u32, 0u32);
        for case in 0..6000u32 {
            let size = [(256, 250), (16, 16), (250, 256), (1, 64)][case as usize % 4];
            let texture = Texture::new(size.0, size.1, Texels::Rgb565(&texels)).unwrap();
            let sampler = Repeat565::new(&texture).unwrap();
            let extent = [4000, 900, 300][case as usize % 3];
            let v = [(); 3].map(|()| [random.next(extent) as i32, random.next(extent) as i32]);
            let Some(t) = Triangle::new(v) else { continue };
            let repeats = [1, 1, 3][case as usize / 3 % 3] << 16;
            let uv = [(); 3].map(|()| [random.next(repeats) as i32, random.next(repeats) as i32]);
            // From nearly flat to steep.
            let depth = [1 << 14, 1 << 19, 1 << 22, (1 << 23) - 1][case as usize / 9 % 4];
            let mut q = [(); 3].map(|()| (1 << 23) - 1 - random.next(depth) as u32);
            q[0] = (1 << 23) - 1;
            let (setup, fits) = sampler.setup_and_fit(&t, uv, q);
            let q_plane = t.plane(q.map(|q| q << 8));
            let sides = [size.0, size.1].map(u32::from);
            let along = Along::new(&setup, &q_plane, q, sides, fits);
            for y in t.min()[1]..t.max()[1] {
                let Some(first) = (t.min()[0]..t.max()[0]).find(|&x| t.covers(x, y)) else {
                    continue;
                };
                let end = (first..t.max()[0]).find(|&x| !t.covers(x, y)).unwrap_or(t.max()[0]);
                let mut block = Block::NONE;
                let mut next = first;
                for x in first..end {
                    let values = [&q_plane, &setup.st[0], &setup.st[1]].map(|p| p.at(x, y));
                    let st = [values[1], values[2]];
                    if x == next {
                        let count = (end - x).min(along.length() as i32);
                        block = if count < 2 {
                            Block::one(&setup, sampler.size, values[0], st)
                        } else {
                            along.block(values[0], st, count as u32)
                        };
                        next += count;
                    }
                    let r = reciprocal(integer_q(values[0]));
                    let texel = sampler.texel565(&setup, st, r) as u32;
                    match block.texel() {
                        Some([s, t]) => {
                            certain += 1;
                            assert_eq!(t * sides[0] + s, texel, "{v:?} {uv:?} {q:?} at {x}, {y}");
                        }
                        None => uncertain += 1,
                    }
                    block.step();
                }
            }
        }
        std::println!("{certain} certain, {uncertain} not");
        assert!(certain > uncertain);
    }
}
