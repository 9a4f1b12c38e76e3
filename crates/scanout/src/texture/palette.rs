//! Palettes: texels that are indices of colours, for parts whose memory does not hold a colour a texel.
//!
//! | texels | bytes a texel | palette |
//! |---|---|---|
//! | [`Palette8`](super::Texels::Palette8) | 1 | up to 256 colours, 512 bytes |
//! | [`Palette4`](super::Texels::Palette4) | 1/2 | up to 16 colours, 32 bytes |
//!
//! A texel is its colour, as if the texture had been RGB565: every filter and every wrap mixes colours, never indices.

use super::perspective::{Perspective, Plain, local, texel_of_repeat};
use super::{Filter, Sampler, Texels, Texture, Wrap};
use crate::output::widen565;
use crate::setup::Triangle;

/// The index of texel `at`, a byte each; 0 outside.
#[inline(always)]
pub(super) fn eight_bits(indices: &[u8], at: usize) -> u8 {
    indices.get(at).copied().unwrap_or(0)
}

/// The index of texel `at`, four bits each, the low ones first; 0 outside.
#[inline(always)]
pub(super) fn four_bits(indices: &[u8], at: usize) -> u8 {
    indices.get(at >> 1).map_or(0, |pair| pair >> (4 * (at & 1)) & 15)
}

/// A colour; black outside, which [`Texture::check`] has excluded.
#[inline(always)]
pub(super) fn colour(palette: &[u16], index: u8) -> u16 {
    palette.get(index as usize).copied().unwrap_or(0)
}

/// The first of `count` texels whose index is not below `colours`.
pub(super) fn beyond(texels: &Texels, count: usize, colours: usize) -> Option<usize> {
    match texels {
        Texels::Palette8 { indices, .. } => {
            indices.iter().take(count).position(|&index| index as usize >= colours)
        }
        Texels::Palette4 { indices, .. } => {
            (0..count).find(|&at| four_bits(indices, at) as usize >= colours)
        }
        Texels::Rgb565(_) | Texels::Rgb888(_) => None,
    }
}

/// Nearest texels of a texture with a palette that repeats and has one level, any size.
#[derive(Clone, Copy, Debug)]
pub struct RepeatPalette<'a> {
    indices: &'a [u8],
    palette: &'a [u16],
    size: [u64; 2],
    four_bits: bool,
}

impl<'a> RepeatPalette<'a> {
    /// `None` when the texture is not of this kind.
    pub fn new(texture: &Texture<'a>) -> Option<Self> {
        let (indices, palette, four_bits) = match texture.texels {
            Texels::Palette8 { indices, palette } => (indices, palette, false),
            Texels::Palette4 { indices, palette } => (indices, palette, true),
            Texels::Rgb565(_) | Texels::Rgb888(_) => return None,
        };
        let plain = texture.filter == Filter::Nearest
            && texture.levels == 1
            && texture.wrap == [Wrap::Repeat; 2];
        let size = [texture.width, texture.height].map(u64::from);
        plain.then_some(RepeatPalette { indices, palette, size, four_bits })
    }
}

impl Plain for RepeatPalette<'_> {
    #[inline(always)]
    fn size(&self) -> [u64; 2] {
        self.size
    }
    #[inline(always)]
    fn stored(&self, at: usize) -> u16 {
        let index =
            if self.four_bits { four_bits(self.indices, at) } else { eight_bits(self.indices, at) };
        colour(self.palette, index)
    }
}

impl Sampler for RepeatPalette<'_> {
    type Setup = Perspective;
    const RGB565: bool = true;

    #[inline(always)]
    fn setup(&self, t: &Triangle, uv: [[i32; 2]; 3], q: [u32; 3]) -> Perspective {
        let (local, _) = local(uv, self.size.map(|size| size as u32));
        Perspective::new(t, &local, q).0
    }
    #[inline(always)]
    fn perspective(setup: &Perspective) -> &Perspective {
        setup
    }
    #[inline(always)]
    fn texel565(&self, setup: &Perspective, st: [u32; 2], r: u64) -> u16 {
        self.stored(texel_of_repeat(self.size, setup.shift, st, r))
    }
    #[inline(always)]
    fn texel(&self, setup: &Perspective, st: [u32; 2], _q: u32, r: u64) -> [u8; 3] {
        widen565(self.texel565(setup, st, r))
    }
}

#[cfg(test)]
mod tests {
    use super::super::TextureError;
    use super::*;
    extern crate std;
    use std::vec::Vec;

    /// Every filter, wrap and level gives what the colours themselves give.
    #[test]
    fn a_palette_is_its_colours() {
        // 7 x 5 and its levels 3 x 2 and 1 x 1: an odd number of texels, so that halves of bytes cross rows and levels.
        let indices: Vec<u8> = (0..7 * 5 + 3 * 2 + 1).map(|i| (i * 11 % 16) as u8).collect();
        let pairs: Vec<u8> =
            indices.chunks(2).map(|p| p[0] | p.get(1).unwrap_or(&0) << 4).collect();
        let palette: Vec<u16> = (0..16u32).map(|i| (i * 40503 + 977) as u16).collect();
        let colours: Vec<u16> = indices.iter().map(|&i| palette[i as usize]).collect();
        let new = |texels| Texture { levels: 3, ..Texture::new(7, 5, texels).unwrap() };
        let expected = new(Texels::Rgb565(&colours));
        for texture in [
            new(Texels::Palette8 { indices: &indices, palette: &palette }),
            new(Texels::Palette4 { indices: &pairs, palette: &palette }),
        ] {
            assert_eq!(texture.check(), Ok(()));
            for filter in [Filter::Nearest, Filter::Bilinear] {
                for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Border] {
                    let ours = Texture { filter, wrap: [wrap; 2], ..texture };
                    let theirs = Texture { filter, wrap: [wrap; 2], ..expected };
                    for level in 0..3 {
                        for s in (-9000..50_000).step_by(611) {
                            let t = s * 7 % 30_000;
                            assert_eq!(ours.sample(s, t, level), theirs.sample(s, t, level));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn wrong_palettes_are_refused() {
        let (palette, indices) = ([0u16; 257], [3u8; 4]);
        let eight = |colours: usize, indices| {
            Texture::new(2, 2, Texels::Palette8 { indices, palette: &palette[..colours] }).map(drop)
        };
        assert_eq!(eight(256, &indices[..]), Ok(()));
        assert_eq!(eight(4, &indices[..]), Ok(()));
        assert_eq!(eight(0, &indices[..]), Err(TextureError::Palette { colours: 0, most: 256 }));
        assert_eq!(
            eight(257, &indices[..]),
            Err(TextureError::Palette { colours: 257, most: 256 })
        );
        assert_eq!(eight(3, &indices[..]), Err(TextureError::Colour { texel: 0, colours: 3 }));
        assert_eq!(eight(3, &[0, 1, 2, 3]), Err(TextureError::Colour { texel: 3, colours: 3 }));
        assert_eq!(eight(9, &[0, 1, 2]), Err(TextureError::Texels { needed: 4, present: 3 }));
        let four = |colours: usize, indices| {
            Texture::new(3, 1, Texels::Palette4 { indices, palette: &palette[..colours] }).map(drop)
        };
        assert_eq!(four(16, &[0xff, 0xff]), Ok(()));
        assert_eq!(four(17, &[0, 0]), Err(TextureError::Palette { colours: 17, most: 16 }));
        assert_eq!(four(5, &[0x40, 0x45]), Err(TextureError::Colour { texel: 2, colours: 5 }));
        // What fills up the last byte is no texel.
        assert_eq!(four(5, &[0x40, 0xf4]), Ok(()));
        assert_eq!(four(16, &[0xff]), Err(TextureError::Texels { needed: 3, present: 2 }));
    }
}
