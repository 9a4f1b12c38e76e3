//! Depth, 1/w, s/w and t/w in three registers of 64 bits, for machines that have them and their long products.
//!
//! ```text
//! bit 63               32 31                0
//!     [ depth            ][ 1/w             ]     one addition steps both
//!     [ s/w 2^(52 - shift)                  ]     the high half of its product with r is floor(s/w r / 2^(shift + 12)), the texel's
//!     [ t/w 2^(52 - shift)                  ]     column, whatever the triangle's shift
//! ```
//!
//! The lower half's plane has exact constants, not modulo 2^32, so that nothing of it goes over into the upper one; 1/w is positive at every
//! covered pixel, as its error is 2^-18 of its largest, and s/w and t/w aren't negative, as they are lifted. The texel is that of [`perspective`].

use super::perspective::{self, NUMERATOR, Perspective};
use super::{Repeat565, SUBTEXEL_BITS};
use crate::depth;
use crate::interpolate::WidePlane;
use crate::math::{high_product, seldom};
use crate::setup::Triangle;

/// A small triangle's depth and plain texture, ready for every pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packed {
    zq: WidePlane,
    s: WidePlane,
    t: WidePlane,
}

/// A pixel's values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackedPixel {
    zq: u64,
    s: u64,
    t: u64,
}

impl Packed {
    /// From three corners' depths, texture coordinates and 1/w; `None` for a triangle that reaches far from the frame, has less than half
    /// a pixel's area, is 2^17 times as far away at one corner as at another, or on which the texture repeats too often.
    #[inline(always)]
    pub(crate) fn new(
        t: &Triangle,
        z: [u32; 3],
        uv: [[i32; 2]; 3],
        q: [u32; 3],
        size: [u64; 2],
    ) -> Option<Packed> {
        // Gradients below 2^53 / 2^8, times less than 2^16: constants are exact.
        let least = q[0].min(q[1]).min(q[2]);
        if !t.small || t.area < 256 || least < 64 {
            return None;
        }
        let (local, _) = perspective::local(uv, size.map(|size| size as u32));
        let ([s, tt], shift) = Perspective::values(&local, q);
        // The definition's products are modulo 2^64: they are distances times 2^(shift - 1), and distances times 1/w are below 2^(79 - shift).
        let beyond = |i: usize| local[i].iter().any(|&distance| distance >> (64 - shift[i]) != 0);
        if shift[0].min(shift[1]) < 20 || least < 1 << 15 && [0, 1].into_iter().any(beyond) {
            return None;
        }
        let lift = t.lift() as u64;
        let [z, q, s, tt] = t.exact_planes([z, q.map(|q| q << 8), s, tt]);
        let over = |upper: [i64; 3], lower: [i64; 3]| {
            let both = |i: usize| ((upper[i] as u64) << 32).wrapping_add(lower[i] as u64);
            WidePlane { c: both(0), gx: both(1), gy: both(2) }
        };
        let z = [z[0] + depth::HALF as i64, z[1], z[2]];
        let at_the_top = |[c, gx, gy]: [i64; 3], i: usize| {
            let c = (c as u64).wrapping_add(lift);
            let [c, gx, gy] =
                [c, gx as u64, gy as u64].map(|v| v << (64 - SUBTEXEL_BITS - shift[i]));
            WidePlane { c, gx, gy }
        };
        let (s, t) = (at_the_top(s, 0), at_the_top(tt, 1));
        Some(Packed { zq: over(z, q), s, t })
    }

    /// The values at (x, y).
    #[inline(always)]
    pub(crate) fn at(&self, x: i32, y: i32) -> PackedPixel {
        PackedPixel { zq: self.zq.at(x, y), s: self.s.at(x, y), t: self.t.at(x, y) }
    }

    /// Those of the next pixel to the right.
    #[inline(always)]
    pub(crate) fn step(&self, pixel: PackedPixel) -> PackedPixel {
        PackedPixel {
            zq: pixel.zq.wrapping_add(self.zq.gx),
            s: pixel.s.wrapping_add(self.s.gx),
            t: pixel.t.wrapping_add(self.t.gx),
        }
    }

    /// A pixel's texel, as it is stored.
    #[inline(always)]
    pub(crate) fn texel(&self, sampler: &Repeat565, pixel: &PackedPixel) -> u16 {
        // Of the whole register: were it of its lower half, the compiler would step a copy.
        let mut q = (pixel.zq >> 8) & 0xff_ffff;
        if q == 0 {
            seldom();
            q = 1;
        }
        let r = NUMERATOR / q;
        let (size, texels) = (sampler.size, sampler.texels);
        let [mut x, y] = [high_product(pixel.s, r), high_product(pixel.t, r)];
        // Whole repeats are taken off at setup: few triangles reach into the next one.
        if x >= size[0] {
            x %= size[0];
        }
        // A row below the last is beyond the texels, too.
        match texels.get((y * size[0] + x) as usize) {
            Some(&texel) => texel,
            None => {
                seldom();
                texels.get((y % size[1] * size[0] + x) as usize).copied().unwrap_or(0)
            }
        }
    }
}

impl PackedPixel {
    /// The whole steps of depth.
    #[inline(always)]
    pub(crate) fn depth(&self) -> u16 {
        depth::whole((self.zq >> 32) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::super::perspective::{integer_q, reciprocal};
    use super::super::{Sampler, Texels, Texture};
    use super::*;
    use crate::math::testing::Random;

    /// Depths and texels are those of the planes, of any triangle, however steep, far or small.
    #[test]
    fn pixels_are_the_planes() {
        let texels: [u16; 61 * 32] = core::array::from_fn(|i| (i * 40503) as u16);
        let texture = Texture::new(61, 32, Texels::Rgb565(&texels)).unwrap();
        let sampler = Repeat565::new(&texture).unwrap();
        let mut random = Random::new();
        let mut below = |n: u32| random.u32() % n;
        let (mut refused, mut pixels, mut slivers) = (0, 0, 0);
        for i in 0..20_000u64 {
            let reach = [24, 400, 9000][i as usize % 3];
            let left = [0, 3000][(i % 7 == 0) as usize];
            let v = [(); 3].map(|()| [(); 2].map(|()| below(reach) as i32 - left));
            let Some(t) = Triangle::new(v) else { continue };
            let range = [0x1000, 0x1_0000, 0xa_0000, 0x4000_0000][i as usize / 3 % 4];
            let mut uv = [(); 3].map(|()| [(); 2].map(|()| below(range) as i32 - 0x800));
            let z = [(); 3].map(|()| below(0xffff_0001));
            let mut q = [(); 3].map(|()| 1 + (below(1 << 23) >> below(18)));
            q[0] |= 1 << 22;
            if i % 5 == 0 {
                // Values that need no shift, at a corner far away: products beyond 64 bits.
                uv[0] = uv[0].map(|u| u >> 24);
                q[1..].iter_mut().for_each(|q| *q = *q % 128 + 60);
            }
            let Some(packed) = Packed::new(&t, z, uv, q, sampler.size) else {
                refused += 1;
                continue;
            };
            slivers += (t.area < 1024) as u32;
            let ([z_plane, q_plane], setup) = sampler.setup_with(&t, z, uv, q);
            for y in t.min()[1].max(0)..t.max()[1].min(60) {
                let mut walked: Option<PackedPixel> = None;
                for x in (t.min()[0].max(0)..t.max()[0].min(80)).filter(|&x| t.covers(x, y)) {
                    let pixel = walked.map_or_else(|| packed.at(x, y), |left| packed.step(left));
                    assert_eq!(pixel.depth(), depth::round(z_plane.at(x, y)), "{v:?} {x} {y}");
                    let r = reciprocal(integer_q(q_plane.at(x, y)));
                    let st = setup.st.map(|plane| plane.at(x, y));
                    let expected = sampler.texel565(&setup, st, r);
                    assert_eq!(packed.texel(&sampler, &pixel), expected, "{v:?} {uv:?} {x} {y}");
                    walked = Some(pixel);
                    pixels += 1;
                }
            }
        }
        assert!(
            refused > 1000 && pixels > 500_000 && slivers > 200,
            "{refused} {pixels} {slivers}"
        );
    }
}
