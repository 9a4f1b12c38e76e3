//! Shade: a fragment's colour from its vertex colour, texel and fog.
//!
//! | operation | closed form | rounding |
//! |---|---|---|
//! | modulate | `a b / 255` | to nearest, exact |
//! | fog, blend | `(a (255 - f) + b f) / 255` | to nearest, exact |
//!
//! Division by 255 is `(t + (t >> 8)) >> 8` with `t = n + 128`, exact for n up to 65025 = 255^2.

use crate::math::{NARROW, high_product};
use crate::scene::Fog;

/// `n / 255` rounded to nearest, exact for 0 <= n <= 65025 = 255^2.
#[inline(always)]
pub fn div255(n: u32) -> u8 {
    let t = n + 128;
    ((t + (t >> 8)) >> 8) as u8
}

/// Multiplies two colours channel by channel, 255 being one.
#[inline(always)]
pub fn modulate(a: [u8; 3], b: [u8; 3]) -> [u8; 3] {
    core::array::from_fn(|i| div255(a[i] as u32 * b[i] as u32))
}

/// A colour that multiplies RGB565 texels: the texel widened by bit replication, [`modulate`]d, cut to its top bits.
pub trait Tint {
    /// The texel times the colour.
    fn tint(&self, texel: u16) -> u16;
}

impl<T: Tint> Tint for &T {
    #[inline(always)]
    fn tint(&self, texel: u16) -> u16 {
        (*self).tint(texel)
    }
}

/// A colour prepared for few texels, in the way that suits the machine.
#[cfg(target_pointer_width = "64")]
pub type Factors = InLanes;
/// A colour prepared for few texels, in the way that suits the machine.
#[cfg(not(target_pointer_width = "64"))]
pub type Factors = ByChannels;

/// A product a channel. `floor((a b + 127) / (255 2^(8 - bits)))`, the top five or six bits of `a b / 255` to nearest, is taken by the
/// reciprocal 32897 = ceil(2^26 / 2040), which is exact for what is below 2^16. In place of 127 times that is added what a machine's instruction
/// has room for: anything from 4,177,411 to 4,178,811 gives the same.
#[derive(Clone, Copy, Debug)]
pub struct ByChannels([u32; 3]);

impl ByChannels {
    const RECIPROCAL: u32 = 32897;
    const ROUND: u32 = 255 << 14;

    /// Of a colour.
    #[inline(always)]
    pub fn new(rgb: [u8; 3]) -> Self {
        ByChannels(rgb.map(|c| c as u32 * Self::RECIPROCAL))
    }
}

impl Tint for ByChannels {
    #[inline(always)]
    fn tint(&self, texel: u16) -> u16 {
        let texel = texel as u32;
        let (r, g, b) = (texel >> 11, (texel >> 5) & 63, texel & 31);
        let top = |wide: u32, channel: usize, bits: u32| {
            (wide * self.0[channel] + Self::ROUND) >> (31 - bits)
        };
        let r = top((r * 33) >> 2, 0, 5);
        let g = top((g * 65) >> 4, 1, 6);
        let b = top((b * 33) >> 2, 2, 5);
        ((r << 11) | (g << 5) | b) as u16
    }
}

/// A product a channel, in lanes of 64 bits.
///
/// ```text
/// bit   63       56       48    40    32       24    16    8        0
///        [ red 8 ]               [ green 8 ]         [ blue 8 ]        a texel's channels
///                 [ red 16       ]     [ green 16     ] [ blue 16    ] times the colour's, the high half of the product
/// ```
///
/// A product with a sum of powers of two puts a copy of the texel at each lane; the powers are so far apart that copies of 16 bits don't
/// touch. The last product gathers the lanes' top bits in the same way.
#[derive(Clone, Copy, Debug)]
pub struct InLanes {
    /// The channels times 2^56.
    factors: [u64; 3],
}

impl InLanes {
    /// The bits of a channel that a texel has, and those that are repeated below.
    const TOP: u64 = InLanes::lanes(0xf8, 0xfc, 0xf8);
    const AGAIN: u64 = InLanes::lanes(0x07, 0x03, 0x07);

    /// A byte in each lane.
    const fn lanes(r: u64, g: u64, b: u64) -> u64 {
        r << 56 | g << 32 | b << 8
    }

    /// Of a colour.
    #[inline(always)]
    pub fn new(rgb: [u8; 3]) -> Self {
        InLanes { factors: rgb.map(|c| (c as u64) << 56) }
    }

    /// The texel's channels, widened.
    #[inline(always)]
    fn widen(texel: u16) -> u64 {
        // Blue's lowest bit goes from 0 to 11, green's from 5 to 34, red's from 11 to 59; those that are repeated from 2, 9, 13 to 8, 32, 56.
        let texel = texel as u64;
        (texel * (1 << 11 | 1 << 29 | 1 << 48)) & InLanes::TOP
            | (texel * (1 << 6 | 1 << 23 | 1 << 43)) & InLanes::AGAIN
    }

    /// Products divided by 255 as in [`div255`], 257 t / 2^16, and cut.
    #[inline(always)]
    fn gather(products: u64) -> u16 {
        let t = products + (InLanes::lanes(128, 128, 128) >> 8);
        let quotients = high_product(t, 257 << 48) & (InLanes::TOP >> 8);
        (quotients.wrapping_mul(1 << 45 | 1 << 27 | 1 << 8) >> 48) as u16
    }
}

impl Tint for InLanes {
    #[inline(always)]
    fn tint(&self, texel: u16) -> u16 {
        let wide = InLanes::widen(texel);
        let lane = |i: usize, mask| high_product(wide & mask, self.factors[i]);
        let (r, g) = (InLanes::lanes(255, 0, 0), InLanes::lanes(0, 255, 0));
        InLanes::gather(lane(0, r) | lane(1, g) | lane(2, InLanes::lanes(0, 0, 255)))
    }
}

/// A grey, which multiplies all of [`InLanes`]' lanes by one product.
#[derive(Clone, Copy, Debug)]
pub struct Grey(u64);

impl Grey {
    /// Of a colour that is one.
    #[inline(always)]
    pub fn new([r, g, b]: [u8; 3]) -> Option<Grey> {
        (r == g && g == b).then_some(Grey((r as u64) << 56))
    }
}

impl Tint for Grey {
    #[inline(always)]
    fn tint(&self, texel: u16) -> u16 {
        InLanes::gather(high_product(InLanes::widen(texel), self.0))
    }
}

/// An RGB565 texel times a colour.
#[inline(always)]
pub fn modulate565(texel: u16, rgb: [u8; 3]) -> u16 {
    match Grey::new(rgb) {
        Some(grey) if !NARROW => grey.tint(texel),
        _ => Factors::new(rgb).tint(texel),
    }
}

/// A table a channel, 224 bytes: for one colour and many texels.
#[derive(Clone, Copy, Debug)]
pub struct Tables {
    red: [u16; 32],
    green: [u16; 64],
    blue: [u8; 32],
}

impl Tables {
    /// Cost: 128 products.
    #[inline(never)]
    pub fn new(rgb: [u8; 3]) -> Tables {
        let factors = Factors::new(rgb);
        let mut tables = Tables { red: [0; 32], green: [0; 64], blue: [0; 32] };
        for (i, (red, blue)) in (0..).zip(tables.red.iter_mut().zip(&mut tables.blue)) {
            *red = factors.tint(i << 11);
            *blue = factors.tint(i) as u8;
        }
        for (i, green) in (0..).zip(&mut tables.green) {
            *green = factors.tint(i << 5);
        }
        tables
    }
}

impl Tint for Tables {
    #[inline(always)]
    fn tint(&self, texel: u16) -> u16 {
        let [r, g, b] = [texel >> 11, (texel >> 5) & 63, texel & 31].map(usize::from);
        self.red[r] | self.green[g] | u16::from(self.blue[b])
    }
}

/// `a` where `weight` is 0, `b` where it is 255, linear between.
#[inline(always)]
pub fn blend(a: [u8; 3], b: [u8; 3], weight: u8) -> [u8; 3] {
    let f = weight as u32;
    core::array::from_fn(|i| div255(a[i] as u32 * (255 - f) + b[i] as u32 * f))
}

/// `255 exp(-i / 8)` for i in 0 - 64.
const EXP: [u8; 65] = [
    255, 225, 199, 175, 155, 136, 120, 106, 94, 83, 73, 64, 57, 50, 44, 39, 35, 30, 27, 24, 21, 18,
    16, 14, 13, 11, 10, 9, 8, 7, 6, 5, 5, 4, 4, 3, 3, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
];

/// Fog prepared for a frame.
///
/// `weight(w)` for a distance `w` in U16.16 world units is
/// - linear: `255 (w - start) / (end - start)`, through one multiplication by `round(2^40 255 / (end - start))`, floor;
/// - exponential: `255 - 255 exp(-x)`, `x = density w` in U.16 floor, from a table of `exp(-i / 8)` interpolated linearly,
///   within 2/255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FogWeights {
    /// Colour of the fog.
    pub colour: [u8; 3],
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Linear { start: u32, length: u32, factor: u64 },
    Exponential { density: u32 },
}

impl FogWeights {
    /// Prepares a fog. A linear fog whose end is not beyond its start begins and ends at `start`.
    pub fn new(fog: &Fog) -> FogWeights {
        match *fog {
            Fog::Linear { colour, start, end } => {
                let start = start.0.max(0) as u32;
                let length = (end.0.max(0) as u32).saturating_sub(start).max(1);
                let factor = ((255u64 << 40) + length as u64 / 2) / length as u64;
                FogWeights { colour, kind: Kind::Linear { start, length, factor } }
            }
            Fog::Exponential { colour, density } => {
                FogWeights { colour, kind: Kind::Exponential { density: density.0.max(0) as u32 } }
            }
        }
    }

    /// How much of the fog's colour is seen at distance `w`, U16.16.
    #[inline]
    pub fn weight(&self, w: u32) -> u8 {
        match self.kind {
            Kind::Linear { start, length, factor } => {
                let d = w.saturating_sub(start).min(length) as u64;
                ((d * factor) >> 40).min(255) as u8
            }
            Kind::Exponential { density } => {
                let x = (density as u64 * w as u64) >> 16;
                let i = (x >> 13) as usize;
                if i >= 64 {
                    return 255;
                }
                let f = (x & 0x1fff) as u32;
                let e = (EXP[i] as u32 * (0x2000 - f) + EXP[i + 1] as u32 * f + 0x1000) >> 13;
                255 - e as u8
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{PixelFormat, Rgb565, widen565};

    #[test]
    fn a_product_of_a_texel_is_widened_modulated_and_cut() {
        let check = |texel: u16, rgb: [u8; 3]| {
            let expected = Rgb565::encode(modulate(widen565(texel), rgb));
            assert_eq!(ByChannels::new(rgb).tint(texel), expected, "{texel:#x} {rgb:?}");
            assert_eq!(InLanes::new(rgb).tint(texel), expected, "{texel:#x} {rgb:?}");
            let grey = Grey::new(rgb);
            assert!(grey.is_none_or(|grey| grey.tint(texel) == expected), "{texel:#x} {rgb:?}");
            assert_eq!(grey.is_some(), rgb == [rgb[0]; 3]);
        };
        for c in 0..=255 {
            for texel in (0..32).map(|v| v << 11 | v).chain((0..64).map(|v| v << 5)) {
                check(texel, [c; 3]);
                check(texel | 0xf81f, [c, 255 - c, 99]);
            }
            check(0xffff, [255, c, 0]);
        }
        for rgb in [[9, 99, 199], [199, 99, 9], [255, 0, 255], [1, 254, 2], [77; 3]] {
            let tables = Tables::new(rgb);
            for texel in 0..=u16::MAX {
                check(texel, rgb);
                assert_eq!(tables.tint(texel), modulate565(texel, rgb), "{texel:#x}");
            }
        }
    }
    use crate::math::Q16;

    #[test]
    fn division_by_255_is_exact() {
        for n in 0..=255 * 255u32 {
            assert_eq!(div255(n) as u32, (2 * n + 255) / 510);
        }
    }

    #[test]
    fn one_is_neutral_and_ends_are_exact() {
        let a = [1, 128, 255];
        assert_eq!(modulate(a, [255; 3]), a);
        assert_eq!(modulate(a, [0; 3]), [0; 3]);
        assert_eq!(blend(a, [9; 3], 0), a);
        assert_eq!(blend(a, [9; 3], 255), [9; 3]);
    }

    #[test]
    fn fog_matches_its_formula() {
        let linear = FogWeights::new(&Fog::Linear {
            colour: [0; 3],
            start: Q16(2 << 16),
            end: Q16(10 << 16),
        });
        let exponential =
            FogWeights::new(&Fog::Exponential { colour: [0; 3], density: Q16(1 << 15) });
        for i in 0..20_000u32 {
            let w = i * 77;
            let d = w as f64 / 65536.0;
            let l = ((d - 2.0) / 8.0).clamp(0.0, 1.0) * 255.0;
            assert!((linear.weight(w) as f64 - l).abs() <= 1.0, "{d}");
            let e = 255.0 - 255.0 * (-0.5 * d).exp();
            assert!((exponential.weight(w) as f64 - e).abs() <= 2.0, "{d}");
        }
        assert_eq!(linear.weight(u32::MAX), 255);
        assert_eq!(exponential.weight(u32::MAX), 255);
    }
}
