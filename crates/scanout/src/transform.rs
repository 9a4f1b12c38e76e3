//! Transform: mesh positions to clip coordinates, and clip coordinates to the screen.
//!
//! ```text
//! clip = (m p + 2^14) >> 15            m: block floating point, p = (px, py, pz, 2^15), exact products
//! W = w << lz                          leading one moved to bit 31
//! r = floor((2^63 - 1) / W)            recip32
//! x = half_width  + ((x_c r >> 31) half_width  + 2^(31 - lz)) >> (32 - lz)           1/16 pixel
//! y = half_height - ((y_c r >> 31) half_height + 2^(31 - lz)) >> (32 - lz)
//! z = ((z_c r >> 31) 65535 2^16) >> (32 - lz)                                        U16.16
//! 1/w = r 2^(lz - 63)
//! ```
//!
//! Clip coordinates are homogeneous: a common factor cancels. So a matrix is kept as 32-bit integers with one power of two
//! a draw, chosen so that no row can overflow: the precision is 30 bits whatever the units of the scene.
//!
//! | value | format | range |
//! |---|---|---|
//! | matrix entry | i32, common power of two | the sum of a row's sizes below 2^30 + 2 |
//! | clip coordinate | i32, the same power of two | below 2^30 + 2 |
//! | screen position | Q28.4 | within +-2^29, or flagged [`GUARD`] |
//! | depth | U16.16 | [0, 65535.0] |
//!
//! Error of a screen position of a vertex inside the view volume: 1/32 pixel (rounding) and 2^-28 of w. What it will not do:
//! positions wider than 16 bits (split the mesh).

use crate::math::{Mat4, NARROW, leading_zeros, mixed_product, recip32, seldom};

/// The vertex lies before the near plane (or has no positive w).
pub const NEAR: u8 = 1 << 5;
/// The vertex lies beyond the far plane.
pub const FAR: u8 = 1 << 6;
/// The vertex lies beyond the guard band: |x| or |y| above 8192 w.
pub const GUARD: u8 = 1 << 7;
/// Any reason to send a primitive through the clip stage.
pub const CLIP: u8 = NEAR | FAR | GUARD;
/// The flags of a vertex that nobody has asked for yet: no projection gives them.
pub(crate) const PENDING: u8 = CLIP | 1;
/// log2 of the guard band in units of w.
pub const GUARD_BITS: u32 = 13;

/// A matrix from mesh positions (Q1.15) to clip coordinates: `true value = m 2^(exponent - 32)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClipMatrix {
    /// Rows x, y, z, w.
    pub m: [[i32; 4]; 4],
    /// Power of two that was taken out of the Q32.32 entries.
    pub exponent: i32,
}

/// `v 2^-shift` rounded to nearest; `shift` may be negative.
#[inline(never)]
fn scale(v: i64, shift: i32) -> i32 {
    if shift > 0 { ((v >> (shift - 1)).wrapping_add(1) >> 1) as i32 } else { (v << -shift) as i32 }
}

/// The sum of a row's sizes, saturating.
#[inline(never)]
fn row_size(row: &[i64; 4]) -> u64 {
    row.iter().fold(0, |sum, v| sum.saturating_add(v.unsigned_abs()))
}

impl ClipMatrix {
    /// Takes the common power of two out of an object-to-clip matrix.
    pub fn new(object_to_clip: &Mat4) -> ClipMatrix {
        let norm = object_to_clip.m.iter().map(row_size).fold(1, u64::max);
        let exponent = (64 - norm.leading_zeros()) as i32 - 30;
        let mut m = [[0; 4]; 4];
        for (to, &from) in m.as_flattened_mut().iter_mut().zip(object_to_clip.m.as_flattened()) {
            *to = scale(from, exponent);
        }
        ClipMatrix { m, exponent }
    }

    /// [`apply`](Self::apply) for what is rarely done: a call instead of the code.
    #[inline(never)]
    pub(crate) fn apply_one(&self, p: [i16; 3]) -> [i32; 4] {
        self.apply(p)
    }

    /// The clip coordinates x, y, z, w of a position. Cost: twelve 32 x 16 bit multiplications.
    #[inline(always)]
    pub fn apply(&self, p: [i16; 3]) -> [i32; 4] {
        let p = p.map(i64::from);
        self.m.map(|row| {
            let sum = row[0] as i64 * p[0]
                + row[1] as i64 * p[1]
                + row[2] as i64 * p[2]
                + ((row[3] as i64) << 15);
            ((sum + (1 << 14)) >> 15) as i32
        })
    }
}

/// A [`ClipMatrix`] for many positions in a row, in the way that suits the machine.
#[cfg(target_pointer_width = "64")]
pub(crate) type ManyPositions = WideMatrix;
/// A [`ClipMatrix`] for many positions in a row, in the way that suits the machine.
#[cfg(not(target_pointer_width = "64"))]
pub(crate) type ManyPositions = HalvedMatrix;

/// Entries widened, half a unit in the last place added to the last column.
#[cfg_attr(not(target_pointer_width = "64"), allow(dead_code))]
pub(crate) struct WideMatrix([[i64; 4]; 4]);

#[cfg_attr(not(target_pointer_width = "64"), allow(dead_code))]
impl WideMatrix {
    /// Of a matrix.
    #[inline]
    pub fn new(matrix: &ClipMatrix) -> WideMatrix {
        WideMatrix(matrix.m.map(|row| {
            let [x, y, z, w] = row.map(i64::from);
            [x, y, z, (w << 15) + (1 << 14)]
        }))
    }

    /// As [`ClipMatrix::apply`].
    #[inline(always)]
    pub fn apply(&self, p: [i16; 3]) -> [i32; 4] {
        let p = p.map(i64::from);
        [0, 1, 2, 3].map(|i: usize| {
            let row = &self.0[i];
            ((row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]) >> 15) as i32
        })
    }
}

/// Entries in halves, `m = high 2^15 + low` with |low| <= 2^14, so that products and sums keep to 32 bits.
///
/// The sum of three products of low halves is at most 3 2^14 2^15 < 2^31 - 2^14; whole multiples of 2^15 may be added after the shift,
/// modulo 2^32, as the result is below 2^31.
pub(crate) struct HalvedMatrix([HalvedRow; 4]);

struct HalvedRow {
    high: [i32; 3],
    low: [i32; 3],
    last: i32,
}

impl HalvedMatrix {
    /// Of a matrix.
    #[inline]
    pub fn new(matrix: &ClipMatrix) -> HalvedMatrix {
        HalvedMatrix(matrix.m.map(|[x, y, z, last]| {
            let high = [x, y, z].map(|m| (m + (1 << 14)) >> 15);
            let low = [x - (high[0] << 15), y - (high[1] << 15), z - (high[2] << 15)];
            HalvedRow { high, low, last }
        }))
    }

    /// As [`ClipMatrix::apply`].
    #[inline(always)]
    pub fn apply(&self, p: [i16; 3]) -> [i32; 4] {
        let p = p.map(i32::from);
        [0, 1, 2, 3].map(|i: usize| {
            let HalvedRow { high, low, last } = &self.0[i];
            let rest = low[0] * p[0] + low[1] * p[1] + low[2] * p[2] + (1 << 14);
            [0, 1, 2].iter().fold(last.wrapping_add(rest >> 15), |sum, &k: &usize| {
                sum.wrapping_add(high[k].wrapping_mul(p[k]))
            })
        })
    }
}

/// The screen that clip coordinates map to: half its width and height in 1/16 pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Viewport {
    half: [i64; 2],
}

/// A vertex on the screen, as kept for the frame: five words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Vertex {
    /// Column, Q28.4.
    pub x: i32,
    /// Row, Q28.4.
    pub y: i32,
    /// Depth, U16.16.
    pub z: u32,
    /// Mantissa of 1/w: `1/w = inv_w 2^(exponent - 63)`, top bit set.
    pub inv_w: u32,
    /// Colour: lit in the mode Gouraud, the surface's own in others.
    pub rgb: [u8; 3],
    /// Exponent of 1/w in the low five bits; [`NEAR`], [`FAR`], [`GUARD`].
    pub flags: u8,
}

impl Vertex {
    /// What memory for vertices may begin as, in a static too.
    pub const EMPTY: Vertex = Vertex { x: 0, y: 0, z: 0, inv_w: 0, rgb: [0; 3], flags: 0 };

    /// Exponent of 1/w, 0 - 31.
    #[inline(always)]
    pub fn exponent(&self) -> u32 {
        self.flags as u32 & 31
    }
}

impl Viewport {
    /// The viewport of a frame, each side at most 4096 pixels.
    pub fn new(width: u16, height: u16) -> Viewport {
        Viewport { half: [width as i64 * 8, height as i64 * 8] }
    }

    /// Half the width and height, in 1/16 pixel.
    pub fn half(&self) -> [i64; 2] {
        self.half
    }

    /// Which planes of the view volume need the clip stage for this vertex.
    #[inline(always)]
    pub fn clip_flags(c: &[i32; 4]) -> u8 {
        // Most vertices need none: one test of all the signs tells.
        let outside = if NARROW { Self::outside_narrow(c) } else { Self::outside_wide(c) };
        if outside { Self::flags_outside(c[0], c[1], c[2], c[3]) } else { 0 }
    }

    /// Whether there is any flag, in 64 bits.
    #[inline(always)]
    fn outside_wide(c: &[i32; 4]) -> bool {
        let [x, y, z, w] = c.map(i64::from);
        let guard = w << GUARD_BITS;
        z | (w - 1) | (w - z) | (guard - x) | (guard + x) | (guard - y) | (guard + y) < 0
    }

    /// The same in 32 bits: x <= 2^13 w is floor((x - 1) / 2^13) < w, and -x - 1 is !x.
    #[inline(always)]
    fn outside_narrow(&[x, y, z, w]: &[i32; 4]) -> bool {
        let over = |v: i32| (w - 1 - ((v - 1) >> GUARD_BITS)) | (w - 1 - (!v >> GUARD_BITS));
        z | (w - 1) | (w - z) | over(x) | over(y) < 0
    }

    #[cold]
    #[inline(never)]
    fn flags_outside(x: i32, y: i32, z: i32, w: i32) -> u8 {
        let [x, y, z, w] = [x, y, z, w].map(i64::from);
        let mut flags = 0;
        if z < 0 || w <= 0 {
            flags |= NEAR;
        }
        if z > w {
            flags |= FAR;
        }
        if x.abs().max(y.abs()) > w << GUARD_BITS {
            flags |= GUARD;
        }
        flags
    }

    /// [`project`](Self::project) for what is rarely done: a call instead of the code.
    #[inline(never)]
    pub(crate) fn project_one(&self, c: &[i32; 4]) -> Vertex {
        self.project(c)
    }

    /// Projects clip coordinates. Where a clip flag is set only the flags mean anything.
    #[inline(always)]
    pub fn project(&self, c: &[i32; 4]) -> Vertex {
        let flags = Self::clip_flags(c);
        if flags != 0 {
            return Vertex { flags, ..Vertex::default() };
        }
        let w = c[3] as u32;
        let lz = leading_zeros(w);
        let r = recip32(w << lz);
        let ratio = |v: i32| mixed_product(v, r) >> 31;
        // Ratios are below 2^(45 - lz) in size, so nothing is lost on the left.
        let places = |v: i32, half: i64| (((ratio(v) * half) << lz) + (1 << 31)) >> 32;
        let x = self.half[0] + places(c[0], self.half[0]);
        let y = self.half[1] - places(c[1], self.half[1]);
        let z = (((ratio(c[2]) as u64 * 65535) << 16) >> (32 - lz)) as u32;
        Vertex {
            x: x as i32,
            y: y as i32,
            z: z.min(crate::depth::MAX),
            inv_w: r,
            rgb: [0; 3],
            flags: lz as u8,
        }
    }
}

/// 1/w of three vertices as integers with a common power of two, the largest in [2^22, 2^23), and that power: the true
/// `1/w` in clip units is `q 2^(exponent - 54)`.
#[inline]
pub fn common_inverse_w(v: [&Vertex; 3]) -> ([u32; 3], u32) {
    let exponent = v[0].exponent().max(v[1].exponent()).max(v[2].exponent());
    let shift = |v: &Vertex| {
        let drop = 9 + exponent - v.exponent();
        // By the shift that the machine has.
        let q = if NARROW {
            v.inv_w.checked_shr(drop).unwrap_or(0)
        } else {
            (v.inv_w as u64 >> drop) as u32
        };
        if q == 0 {
            seldom();
            return 1;
        }
        q
    };
    (v.map(shift), exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u64);
    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        }
    }

    #[test]
    fn screen_positions_match_real_numbers() {
        let mut random = Random(1);
        let (mut worst, mut worst_z, mut inside) = (0f64, 0f64, 0);
        for scene_scale in [1e-3, 1.0, 1e3] {
            for _ in 0..20_000 {
                let mut m = [[0f64; 4]; 4];
                for row in &mut m {
                    for v in row.iter_mut() {
                        *v = random.unit() * scene_scale;
                    }
                }
                m[3][3] = 2.5 * scene_scale;
                let matrix = Mat4::from_f64(m);
                // What was given to the transform, including the rounding of its matrix to Q32.32.
                let exact = matrix.to_f64();
                let p = [(); 3].map(|()| (random.unit() * 32767.0) as i16);
                let f = [p[0] as f64 / 32768.0, p[1] as f64 / 32768.0, p[2] as f64 / 32768.0, 1.0];
                let c = exact.map(|row| row.iter().zip(f).map(|(a, b)| a * b).sum::<f64>());
                let ratio = [0, 1, 2].map(|i| c[i] / c[3]);
                if c[3] < 0.05 * scene_scale || ratio[0].abs() > 1.0 || ratio[1].abs() > 1.0 {
                    continue;
                }
                let v = Viewport::new(640, 480).project(&ClipMatrix::new(&matrix).apply(p));
                if v.flags & CLIP != 0 {
                    assert!(ratio[2] < 1e-6 || ratio[2] > 1.0 - 1e-6);
                    continue;
                }
                inside += 1;
                worst = worst
                    .max((v.x as f64 - (ratio[0] + 1.0) * 5120.0).abs())
                    .max((v.y as f64 - (1.0 - ratio[1]) * 3840.0).abs());
                worst_z = worst_z.max((v.z as f64 / 65536.0 - ratio[2] * 65535.0).abs());
                let w = 2f64.powi(54 - v.exponent() as i32) / (v.inv_w >> 9) as f64;
                let w = w * 2f64.powi(ClipMatrix::new(&matrix).exponent - 32);
                assert!((w / c[3] - 1.0).abs() < 1e-5, "w {w} {}", c[3]);
            }
        }
        assert!(inside > 5000, "{inside}");
        assert!(worst < 0.501, "{worst} / 16 pixel");
        assert!(worst_z < 0.01, "{worst_z} steps of depth");
    }

    #[test]
    fn the_block_exponent_keeps_rows_in_range() {
        let mut random = Random(2);
        for i in 0..1000 {
            let size = 2f64.powi(i % 56 - 28);
            let m = ClipMatrix::new(&Mat4::from_f64(
                [(); 4].map(|()| [(); 4].map(|()| random.unit() * size)),
            ));
            for corner in 0..8 {
                let p = [0, 1, 2].map(|k| if corner >> k & 1 == 0 { i16::MIN } else { i16::MAX });
                assert!(m.apply(p).iter().all(|c| c.unsigned_abs() <= (1 << 30) + 4));
                assert_eq!(WideMatrix::new(&m).apply(p), m.apply(p));
                assert_eq!(HalvedMatrix::new(&m).apply(p), m.apply(p));
            }
        }
        assert_eq!(ClipMatrix::new(&Mat4 { m: [[0; 4]; 4] }).apply([1, 2, 3]), [0; 4]);
    }

    #[test]
    fn a_clip_scale_cancels() {
        let c = [12_345_678, -23_456_789, 30_000_000, 56_789_012];
        let viewport = Viewport::new(320, 240);
        let (a, b) = (viewport.project(&c), viewport.project(&c.map(|v| v * 8)));
        assert_eq!((a.x, a.y, a.inv_w, a.flags), (b.x, b.y, b.inv_w, b.flags + 3));
        assert!(a.z.abs_diff(b.z) < 64, "depth in 1/65536 of a step");
    }

    #[test]
    fn one_test_of_the_signs_is_all_tests() {
        let mut random = Random(3);
        for i in 0..200_000 {
            let size = 2f64.powi(i % 31);
            let near = |w: i32| (w as i64 * 8192).clamp(-(1 << 30), 1 << 30) as i32;
            let mut c = [(); 4].map(|()| (random.unit() * size) as i32);
            let w = c[3];
            match i % 7 {
                0 => c[0] = near(w) + i % 3 - 1,
                1 => c[0] = -near(w) + i % 3 - 1,
                2 => c[1] = near(w) + i % 3 - 1,
                3 => c[1] = -near(w) + i % 3 - 1,
                4 => c[2] = w + i % 3 - 1,
                5 => c[2] = i % 3 - 1,
                _ => c[3] = i % 3 - 1,
            }
            let guard = (c[3] as i64) << GUARD_BITS;
            let outside = [
                (NEAR, c[2] < 0 || c[3] <= 0),
                (FAR, c[2] > c[3]),
                (GUARD, [c[0], c[1]].iter().any(|v| v.unsigned_abs() as i64 > guard)),
            ];
            let expected =
                outside.iter().fold(0, |all, &(flag, set)| if set { all | flag } else { all });
            assert_eq!(Viewport::clip_flags(&c), expected, "{c:?}");
            assert_eq!(Viewport::outside_wide(&c), expected != 0, "{c:?}");
            assert_eq!(Viewport::outside_narrow(&c), expected != 0, "{c:?}");
        }
    }

    #[test]
    fn what_cannot_be_projected_is_flagged() {
        let viewport = Viewport::new(320, 240);
        assert_eq!(viewport.project(&[0, 0, -1, 10]).flags, NEAR);
        assert_eq!(viewport.project(&[0, 0, 11, 10]).flags, FAR);
        assert_eq!(viewport.project(&[0, 0, 0, 0]).flags, NEAR);
        assert_eq!(viewport.project(&[0, 8192 * 10 + 1, 5, 10]).flags, GUARD);
        assert_eq!(viewport.project(&[0, -8192 * 10, 5, 10]).flags & CLIP, 0);
    }
}
