//! Output: colours of 8 bits a channel become pixels in their final format, with or without ordered dither.
//!
//! | format | id | word | bits, top first | without dither |
//! |---|---|---|---|---|
//! | [`Rgb888`] | 1 | `[u8; 3]` | R8, G8, B8 | as it is |
//! | [`Rgb565`] | 2 | `u16` | R5 G6 B5 | top bits |
//! | [`Rgb332`] | 3 | `u8` | R3 G3 B2 (system C's VGA) | top bits |
//! | [`Mono`] | 4 | `u8` = 8 pixels, leftmost in the top bit | lit when luma >= 128 | |
//!
//! Keeping the top bits makes bins of equal width, and widening by bit replication has a mean error of 0 over them,
//! which rounding to nearest does no better; and in hardware it is wiring.
//!
//! Dither adds a threshold from the 4 x 4 Bayer matrix `b(x mod 4, y mod 4)` in 0 - 15 before the cut. For a channel that
//! keeps n bits: `v - (v >> n) + (b << 4 >> n)`, so black and white stay as they are. For one bit a pixel is lit when
//! `luma > 16 b + 7`, `luma = (77 R + 150 G + 29 B) >> 8`.
//!
//! What it will not do: gamma, error diffusion (a pixel would depend on its neighbours).

use core::ops::Range;

use crate::memory::fill;
use crate::shade::{Tint, modulate, modulate565};

/// The 4 x 4 Bayer matrix, `BAYER[y & 3][x & 3]`, 0 - 15.
pub const BAYER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// A pixel format that the pipeline can draw in directly.
pub trait PixelFormat: Copy + 'static {
    /// A word of colour memory.
    type Word: Copy + Default + PartialEq + core::fmt::Debug + Send + Sync;
    /// A pixel ready to store.
    type Pixel: Copy;
    /// The format's number in the frame hash.
    const ID: u8;
    /// Bits a pixel.
    const BITS: usize;

    /// Words of colour memory in a row of `width` pixels.
    fn words(width: usize) -> usize;
    /// Converts a colour without dither: the same at every place.
    fn encode(rgb: [u8; 3]) -> Self::Pixel;
    /// Converts a colour with dither for the pixel at (x, y) of the frame.
    fn encode_dithered(rgb: [u8; 3], x: i32, y: i32) -> Self::Pixel;
    /// An RGB565 texel times a colour, without dither.
    #[inline(always)]
    fn modulate565(texel: u16, rgb: [u8; 3]) -> Self::Pixel {
        Self::encode(modulate(widen565(texel), rgb))
    }
    /// The same where the colour is prepared, if it is for this format.
    #[inline(always)]
    fn tint(_: &impl Tint, texel: u16, rgb: [u8; 3]) -> Self::Pixel {
        Self::modulate565(texel, rgb)
    }
    /// Stores a pixel at column `x` of a row.
    fn store(row: &mut [Self::Word], x: usize, pixel: Self::Pixel);
    /// The colour at column `x` of a row, widened to 8 bits a channel by bit replication.
    fn load(row: &[Self::Word], x: usize) -> [u8; 3];
    /// Colour memory as pixels, where a word is a pixel.
    fn pixels(_words: &mut [Self::Word]) -> Option<&mut [Self::Pixel]> {
        None
    }
    /// A row as RGB565 pixels, where it is: several are then drawn side by side.
    fn rgb565(_row: &mut [Self::Word]) -> Option<&mut [u16]> {
        None
    }
    /// Walks along some columns of a row of `colours` and `depths`, both `width` pixels wide, with a state that `step` brings to the
    /// next pixel: where `test` passes, the pixel becomes what `pixel` makes of the state and a number that counts from 0.
    #[inline(always)]
    fn walk<S>(
        colours: &mut [Self::Word],
        depths: &mut [u16],
        (width, row, columns): (usize, usize, Range<usize>),
        mut state: S,
        test: impl Fn(&S, &mut u16) -> bool,
        pixel: impl Fn(&S, usize) -> Self::Pixel,
        step: impl Fn(S) -> S,
    ) {
        let words = Self::words(width);
        let (Some(colours), Some(depths)) = (
            colours.get_mut(row * words..(row + 1) * words),
            depths.get_mut(row * width + columns.start..row * width + columns.end),
        ) else {
            return;
        };
        for (i, depth) in depths.iter_mut().enumerate() {
            if test(&state, depth) {
                Self::store(colours, columns.start + i, pixel(&state, i));
            }
            state = step(state);
        }
    }
    /// Fills `width` pixels of a row.
    fn fill(row: &mut [Self::Word], width: usize, pixel: Self::Pixel);
    /// Gives the bytes of a row in the order of the frame hash (see [`hash`](crate::hash)).
    fn bytes(row: &[Self::Word], width: usize, sink: &mut impl FnMut(&[u8]));
}

/// A channel dithered to its top `bits` bits (left in place).
#[inline(always)]
fn dither(v: u8, bits: u32, b: u8) -> u8 {
    v - (v >> bits) + (((b as u32) << 4 >> bits) as u8)
}

#[inline(always)]
fn dithered(rgb: [u8; 3], bits: [u32; 3], x: i32, y: i32) -> [u8; 3] {
    let b = BAYER[(y & 3) as usize][(x & 3) as usize];
    [dither(rgb[0], bits[0], b), dither(rgb[1], bits[1], b), dither(rgb[2], bits[2], b)]
}

/// Brightness of a colour, 0 - 255: `(77 R + 150 G + 29 B) >> 8`.
#[inline]
pub fn luma(rgb: [u8; 3]) -> u8 {
    ((77 * rgb[0] as u32 + 150 * rgb[1] as u32 + 29 * rgb[2] as u32) >> 8) as u8
}

/// Widens an RGB565 pixel to 8 bits a channel by bit replication.
#[inline(always)]
pub fn widen565(p: u16) -> [u8; 3] {
    let (r, g, b) = ((p >> 11) as u8, (p >> 5 & 63) as u8, (p & 31) as u8);
    [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2]
}

/// What all formats share whose words are pixels.
macro_rules! a_word_is_a_pixel {
    ($word:ty, $fill:expr) => {
        type Word = $word;
        type Pixel = $word;

        fn words(width: usize) -> usize {
            width
        }
        #[inline(always)]
        fn store(row: &mut [$word], x: usize, pixel: $word) {
            row[x] = pixel;
        }
        #[inline(always)]
        fn pixels(words: &mut [$word]) -> Option<&mut [$word]> {
            Some(words)
        }
        #[inline(always)]
        fn walk<S>(
            colours: &mut [$word],
            depths: &mut [u16],
            (width, row, columns): (usize, usize, Range<usize>),
            mut state: S,
            test: impl Fn(&S, &mut u16) -> bool,
            pixel: impl Fn(&S, usize) -> $word,
            step: impl Fn(S) -> S,
        ) {
            // Of one length, so that one test is enough.
            let cells = colours.len().min(depths.len());
            let (colours, depths) = (&mut colours[..cells], &mut depths[..cells]);
            let place = row * width + columns.start..row * width + columns.end;
            if let (Some(colours), Some(depths)) =
                (colours.get_mut(place.clone()), depths.get_mut(place))
            {
                for (i, (colour, depth)) in colours.iter_mut().zip(depths).enumerate() {
                    if test(&state, depth) {
                        *colour = pixel(&state, i);
                    }
                    state = step(state);
                    // Runs are short: keeps the compiler from unrolling.
                    core::hint::black_box(());
                }
            }
        }
        fn fill(row: &mut [$word], width: usize, pixel: $word) {
            $fill(&mut row[..width], pixel);
        }
    };
}

/// 8 bits a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rgb888 {}

impl PixelFormat for Rgb888 {
    a_word_is_a_pixel!([u8; 3], <[_]>::fill);
    const ID: u8 = 1;
    const BITS: usize = 24;

    #[inline(always)]
    fn encode(rgb: [u8; 3]) -> [u8; 3] {
        rgb
    }
    #[inline(always)]
    fn encode_dithered(rgb: [u8; 3], _x: i32, _y: i32) -> [u8; 3] {
        rgb
    }
    #[inline(always)]
    fn load(row: &[[u8; 3]], x: usize) -> [u8; 3] {
        row[x]
    }
    fn bytes(row: &[[u8; 3]], width: usize, sink: &mut impl FnMut(&[u8])) {
        row[..width].iter().for_each(|p| sink(p));
    }
}

/// 5-6-5 bits in a `u16`, red in the top bits; sent and hashed high byte first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rgb565 {}

impl PixelFormat for Rgb565 {
    a_word_is_a_pixel!(u16, fill);
    const ID: u8 = 2;
    const BITS: usize = 16;

    #[inline(always)]
    fn encode(rgb: [u8; 3]) -> u16 {
        (rgb[0] as u16 & 0xf8) << 8 | (rgb[1] as u16 & 0xfc) << 3 | (rgb[2] as u16) >> 3
    }
    #[inline(always)]
    fn encode_dithered(rgb: [u8; 3], x: i32, y: i32) -> u16 {
        Self::encode(dithered(rgb, [5, 6, 5], x, y))
    }
    #[inline(always)]
    fn modulate565(texel: u16, rgb: [u8; 3]) -> u16 {
        modulate565(texel, rgb)
    }
    #[inline(always)]
    fn tint(tint: &impl Tint, texel: u16, _rgb: [u8; 3]) -> u16 {
        tint.tint(texel)
    }
    #[inline(always)]
    fn load(row: &[u16], x: usize) -> [u8; 3] {
        widen565(row[x])
    }
    #[inline(always)]
    fn rgb565(row: &mut [u16]) -> Option<&mut [u16]> {
        Some(row)
    }
    fn bytes(row: &[u16], width: usize, sink: &mut impl FnMut(&[u8])) {
        row[..width].iter().for_each(|p| sink(&p.to_be_bytes()));
    }
}

/// 3-3-2 bits in a byte, red in the top bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rgb332 {}

impl PixelFormat for Rgb332 {
    a_word_is_a_pixel!(u8, <[_]>::fill);
    const ID: u8 = 3;
    const BITS: usize = 8;

    #[inline(always)]
    fn encode(rgb: [u8; 3]) -> u8 {
        (rgb[0] & 0xe0) | (rgb[1] & 0xe0) >> 3 | rgb[2] >> 6
    }
    #[inline(always)]
    fn encode_dithered(rgb: [u8; 3], x: i32, y: i32) -> u8 {
        Self::encode(dithered(rgb, [3, 3, 2], x, y))
    }
    #[inline(always)]
    fn load(row: &[u8], x: usize) -> [u8; 3] {
        let (r, g, b) = (row[x] >> 5, row[x] >> 2 & 7, row[x] & 3);
        [r << 5 | r << 2 | r >> 1, g << 5 | g << 2 | g >> 1, b * 85]
    }
    fn bytes(row: &[u8], width: usize, sink: &mut impl FnMut(&[u8])) {
        sink(&row[..width]);
    }
}

/// One bit a pixel, eight pixels a byte, the leftmost in the top bit; a row is whole bytes, its rest is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mono {}

impl PixelFormat for Mono {
    type Word = u8;
    type Pixel = bool;
    const ID: u8 = 4;
    const BITS: usize = 1;

    fn words(width: usize) -> usize {
        width.div_ceil(8)
    }
    #[inline(always)]
    fn encode(rgb: [u8; 3]) -> bool {
        luma(rgb) >= 128
    }
    #[inline(always)]
    fn encode_dithered(rgb: [u8; 3], x: i32, y: i32) -> bool {
        luma(rgb) as u32 > 16 * BAYER[(y & 3) as usize][(x & 3) as usize] as u32 + 7
    }
    #[inline(always)]
    fn store(row: &mut [u8], x: usize, pixel: bool) {
        let bit = 0x80 >> (x & 7);
        let byte = &mut row[x >> 3];
        *byte = if pixel { *byte | bit } else { *byte & !bit };
    }
    #[inline(always)]
    fn load(row: &[u8], x: usize) -> [u8; 3] {
        [if row[x >> 3] & (0x80 >> (x & 7)) != 0 { 255 } else { 0 }; 3]
    }
    fn fill(row: &mut [u8], width: usize, pixel: bool) {
        let words = Self::words(width);
        row[..words].fill(if pixel { 0xff } else { 0 });
        if pixel && width & 7 != 0 {
            row[words - 1] = (0xff00u32 >> (width & 7)) as u8;
        }
    }
    fn bytes(row: &[u8], width: usize, sink: &mut impl FnMut(&[u8])) {
        sink(&row[..Self::words(width)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round_trip<F: PixelFormat>() {
        let mut row = [F::Word::default(); 16];
        for v in 0..=255u8 {
            for x in 0..16 {
                F::store(&mut row, x, F::encode([v, 255 - v, v ^ 0x55]));
                let once = F::load(&row, x);
                F::store(&mut row, x, F::encode(once));
                assert_eq!(F::load(&row, x), once, "storing what was loaded changes nothing");
            }
        }
    }

    #[test]
    fn widened_pixels_store_unchanged() {
        round_trip::<Rgb888>();
        round_trip::<Rgb565>();
        round_trip::<Rgb332>();
        round_trip::<Mono>();
    }

    fn extremes<F: PixelFormat>() {
        for (rgb, x, y) in (0..32).map(|i| ([255 * (i as u8 & 1); 3], i / 2 % 4, i / 8)) {
            let mut row = [F::Word::default(); 1];
            F::store(&mut row, 0, F::encode_dithered(rgb, x, y));
            assert_eq!(F::load(&row, 0), rgb);
        }
    }

    #[test]
    fn dither_keeps_black_and_white() {
        extremes::<Rgb565>();
        extremes::<Rgb332>();
        extremes::<Mono>();
    }

    #[test]
    fn dither_keeps_the_mean() {
        for v in 0..=255u32 {
            let mut sum = [0u32; 2];
            for i in 0..16 {
                let rgb = [v as u8; 3];
                sum[0] += dithered(rgb, [5, 6, 5], i & 3, i >> 2)[0] as u32 >> 3;
                sum[1] += Mono::encode_dithered(rgb, i & 3, i >> 2) as u32;
            }
            assert!((sum[0] as i32 * 255 - v as i32 * 31 * 16).abs() <= 255 * 16 / 2, "{v}");
            assert!((sum[1] as i32 * 255 - v as i32 * 16).abs() <= 255, "{v}: {}", sum[1]);
        }
    }

    #[test]
    fn mono_packs_from_the_top_bit() {
        let mut row = [0u8; 2];
        Mono::store(&mut row, 0, true);
        Mono::store(&mut row, 9, true);
        assert_eq!(row, [0x80, 0x40]);
        Mono::fill(&mut row, 11, true);
        assert_eq!(row, [0xff, 0xe0]);
    }
}
