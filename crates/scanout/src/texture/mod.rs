//! Texture: a fragment's texel, perspective-correct, from planes and one integer reciprocal.
//!
//! ```text
//! q   = plane of 1/w (U24.8), floor to an integer, at least 1
//! r   = floor((2^47 - 1) / q)                       the reciprocal that all machines share
//! s   = (plane of s/w * r) >> shift                 sub-texel coordinate, 1/4096 texel
//! ```
//!
//! `q`, `s/w` and `t/w` are block floating point: [`setup`](crate::setup) scales each so that the largest of the three vertices
//! fills its format, and only the ratio counts. A texel coordinate is exact to about 2^-20 of the triangle's span of
//! the texture. Dividing once a pixel is the definition; any faster way must give the same `r`. See [`TextureSetup`].
//!
//! | step | closed form |
//! |---|---|
//! | nearest | texel `floor(s)` |
//! | bilinear | texels around `s - 1/2`, weights `floor(256 frac)`, sum of four 16-bit products rounded to nearest |
//! | mip level | the number of levels l >= 1 with `q < T_l` (below) |
//! | repeat, mirror, clamp, border | on integer texel coordinates (system B's Figure 7) |
//!
//! **Mip levels.** The area of the texture that one pixel covers is `K / q^3` on a plane in perspective (the Jacobian of
//! s/q, t/q), so the level `round(log2(area) / 2)` depends on `q` alone: level l or more where `q < T_l`,
//! `T_l = cbrt(K / 2^(2l - 1))`. One comparison a level instead of derivatives a pixel. What it will not do: anisotropic
//! or trilinear filtering.

mod across;
mod along;
mod packed;
mod palette;
mod perspective;

pub use across::Across;
pub use along::{Along, Block};
pub(crate) use packed::Packed;
pub use palette::RepeatPalette;
pub(crate) use perspective::Plain;
pub use perspective::{
    General, Perspective, Repeat565, Sampler, TextureSetup, integer_q, reciprocal,
};

use crate::output::widen565;

/// The largest width and height of a texture.
pub const MAX_SIZE: u16 = 1024;

/// The most mip levels of a texture: 1024 down to 1.
pub const MAX_LEVELS: u8 = 11;

/// Fraction bits of a sub-texel coordinate.
pub const SUBTEXEL_BITS: u32 = 12;

/// Texels of a texture, rows from the top; mip levels follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels<'a> {
    /// 5-6-5 bits, red in the top bits; widened by bit replication.
    Rgb565(&'a [u16]),
    /// 8 bits a channel, R, G, B.
    Rgb888(&'a [[u8; 3]]),
    /// A byte a texel, which is the index of its colour.
    Palette8 {
        /// Indices.
        indices: &'a [u8],
        /// Up to 256 colours, 5-6-5 bits. With 256 no index needs to be looked at by [`Texture::check`].
        palette: &'a [u16],
    },
    /// Four bits a texel: texel 2 n is the low half of byte n, texel 2 n + 1 the high half, over the ends of rows and levels.
    Palette4 {
        /// Indices, two a byte.
        indices: &'a [u8],
        /// Up to 16 colours, 5-6-5 bits. With 16 no index needs to be looked at by [`Texture::check`].
        palette: &'a [u16],
    },
}

impl Texels<'_> {
    /// How many texels there are.
    pub fn len(&self) -> usize {
        match self {
            Texels::Rgb565(t) => t.len(),
            Texels::Rgb888(t) => t.len(),
            Texels::Palette8 { indices, .. } => indices.len(),
            Texels::Palette4 { indices, .. } => 2 * indices.len(),
        }
    }

    /// Colours of the palette and how many there may be.
    fn palette(&self) -> Option<(usize, usize)> {
        match self {
            Texels::Rgb565(_) | Texels::Rgb888(_) => None,
            Texels::Palette8 { palette, .. } => Some((palette.len(), 256)),
            Texels::Palette4 { palette, .. } => Some((palette.len(), 16)),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The texel at an index, widened to 8 bits a channel; black outside.
    #[inline(always)]
    fn get(&self, index: usize) -> [u8; 3] {
        match self {
            Texels::Rgb565(t) => t.get(index).map_or([0; 3], |&p| widen565(p)),
            Texels::Rgb888(t) => t.get(index).copied().unwrap_or([0; 3]),
            Texels::Palette8 { indices, palette } => {
                widen565(palette::colour(palette, palette::eight_bits(indices, index)))
            }
            Texels::Palette4 { indices, palette } => {
                widen565(palette::colour(palette, palette::four_bits(indices, index)))
            }
        }
    }
}

/// What lies outside [0, 1) of a texture coordinate (system B's Figure 7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texture repeats, every second time mirrored.
    Mirror,
    /// The outermost texel continues.
    Clamp,
    /// The border colour.
    Border,
}

/// How a texel is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Filter {
    /// The texel that the coordinate lies in.
    #[default]
    Nearest,
    /// Four texels weighted with 8 bits.
    Bilinear,
}

/// A texture of up to 1024 x 1024 texels, any size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture<'a> {
    /// Width of level 0, 1 - 1024.
    pub width: u16,
    /// Height of level 0, 1 - 1024.
    pub height: u16,
    /// Mip levels present, 1 - 11; level k measures max(1, size >> k), stored after level k - 1.
    pub levels: u8,
    /// The texels.
    pub texels: Texels<'a>,
    /// Outside modes of u and v.
    pub wrap: [Wrap; 2],
    /// How a texel is chosen.
    pub filter: Filter,
    /// Colour outside for `Wrap::Border`.
    pub border: [u8; 3],
}

/// What is wrong with a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureError {
    /// Width or height is 0 or above 1024.
    Size {
        /// The width given.
        width: u16,
        /// The height given.
        height: u16,
    },
    /// The number of mip levels is 0 or above 11.
    Levels(u8),
    /// Fewer texels than the levels need.
    Texels {
        /// How many the levels need.
        needed: usize,
        /// How many there are.
        present: usize,
    },
    /// The palette has no colour, or more than its indices can tell apart.
    Palette {
        /// How many it has.
        colours: usize,
        /// How many it may have.
        most: usize,
    },
    /// A texel's index lies beyond the palette.
    Colour {
        /// Number of the texel.
        texel: usize,
        /// Colours of the palette.
        colours: usize,
    },
}

impl core::fmt::Display for TextureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match *self {
            TextureError::Size { width, height } => {
                write!(f, "texture of {width} x {height} texels; each side must be 1 to {MAX_SIZE}")
            }
            TextureError::Levels(n) => write!(f, "{n} mip levels; there must be 1 to {MAX_LEVELS}"),
            TextureError::Texels { needed, present } => {
                write!(f, "{present} texels where the levels need {needed}")
            }
            TextureError::Palette { colours, most } => {
                write!(f, "a palette of {colours} colours; there must be 1 to {most}")
            }
            TextureError::Colour { texel, colours } => {
                write!(f, "texel {texel} has an index beyond the palette's {colours} colours")
            }
        }
    }
}

impl core::error::Error for TextureError {}

impl<'a> Texture<'a> {
    /// A texture without mip levels that repeats, nearest texel.
    ///
    /// # Errors
    /// When a side is not 1 - 1024 or the slice is shorter than width x height.
    pub fn new(width: u16, height: u16, texels: Texels<'a>) -> Result<Texture<'a>, TextureError> {
        let texture = Texture {
            width,
            height,
            levels: 1,
            texels,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Nearest,
            border: [0; 3],
        };
        texture.check().map(|()| texture)
    }

    /// Width and height of a level.
    #[inline]
    pub fn level_size(&self, level: u8) -> [u16; 2] {
        [(self.width >> level).max(1), (self.height >> level).max(1)]
    }

    /// Index of a level's first texel; for `levels`, the number of texels needed.
    #[inline]
    pub fn level_offset(&self, level: u8) -> usize {
        (0..level).map(|k| self.level_size(k).map(usize::from)).map(|[w, h]| w * h).sum()
    }

    /// Checks sizes, once a frame and object, so that sampling need not; of a palette that is not full every index, too.
    ///
    /// # Errors
    /// As [`TextureError`] lists.
    pub fn check(&self) -> Result<(), TextureError> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 || width > MAX_SIZE || height > MAX_SIZE {
            return Err(TextureError::Size { width, height });
        }
        if self.levels == 0 || self.levels > MAX_LEVELS {
            return Err(TextureError::Levels(self.levels));
        }
        let needed = self.level_offset(self.levels);
        if self.texels.len() < needed {
            return Err(TextureError::Texels { needed, present: self.texels.len() });
        }
        match self.texels.palette() {
            Some((colours, most)) if colours == 0 || colours > most => {
                Err(TextureError::Palette { colours, most })
            }
            Some((colours, most)) if colours < most => {
                match palette::beyond(&self.texels, needed, colours) {
                    Some(texel) => Err(TextureError::Colour { texel, colours }),
                    None => Ok(()),
                }
            }
            _ => Ok(()),
        }
    }

    /// The texel at column `x`, row `y` of a level, any integers, after the outside modes.
    #[inline]
    fn texel(&self, offset: usize, size: [u16; 2], x: i32, y: i32) -> [u8; 3] {
        match (outside(x, size[0], self.wrap[0]), outside(y, size[1], self.wrap[1])) {
            (Some(x), Some(y)) => self.texels.get(offset + y * size[0] as usize + x),
            _ => self.border,
        }
    }

    /// The colour at (s, t), 1/4096 texel of level 0, at a mip level.
    #[inline]
    pub fn sample(&self, s: i64, t: i64, level: u8) -> [u8; 3] {
        let (size, offset) = if level == 0 {
            ([self.width, self.height], 0)
        } else {
            (self.level_size(level), self.level_offset(level))
        };
        let (s, t) = if level == 0 {
            (s, t)
        } else {
            (scale_to_level(s, size[0], self.width), scale_to_level(t, size[1], self.height))
        };
        match self.filter {
            Filter::Nearest => {
                self.texel(offset, size, (s >> SUBTEXEL_BITS) as i32, (t >> SUBTEXEL_BITS) as i32)
            }
            Filter::Bilinear => {
                let half = 1i64 << (SUBTEXEL_BITS - 1);
                let (s, t) = (s - half, t - half);
                let (x, y) = ((s >> SUBTEXEL_BITS) as i32, (t >> SUBTEXEL_BITS) as i32);
                let fx = (s >> (SUBTEXEL_BITS - 8)) as u32 & 255;
                let fy = (t >> (SUBTEXEL_BITS - 8)) as u32 & 255;
                let tap = |dx, dy| self.texel(offset, size, x + dx, y + dy);
                let (a, b, c, d) = (tap(0, 0), tap(1, 0), tap(0, 1), tap(1, 1));
                core::array::from_fn(|i| {
                    let top = a[i] as u32 * (256 - fx) + b[i] as u32 * fx;
                    let bottom = c[i] as u32 * (256 - fx) + d[i] as u32 * fx;
                    ((top * (256 - fy) + bottom * fy + 0x8000) >> 16) as u8
                })
            }
        }
    }
}

/// A sub-texel coordinate of level 0 in a smaller level; exact for sizes that halve without remainder, floor otherwise.
#[inline]
fn scale_to_level(s: i64, size: u16, full: u16) -> i64 {
    if full.is_power_of_two() {
        s >> (full.trailing_zeros() - size.trailing_zeros())
    } else {
        (s * size as i64).div_euclid(full as i64)
    }
}

/// Brings an integer texel coordinate inside, or says that it is in the border.
#[inline(always)]
fn outside(x: i32, size: u16, wrap: Wrap) -> Option<usize> {
    let n = size as i32;
    if (0..n).contains(&x) {
        return Some(x as usize);
    }
    match wrap {
        Wrap::Repeat if size.is_power_of_two() => Some((x & (n - 1)) as usize),
        Wrap::Repeat => Some(x.rem_euclid(n) as usize),
        Wrap::Mirror => {
            let m = x.rem_euclid(2 * n);
            Some(if m < n { m } else { 2 * n - 1 - m } as usize)
        }
        Wrap::Clamp => Some(x.clamp(0, n - 1) as usize),
        Wrap::Border => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_modes_of_figure_7() {
        let row = |wrap| {
            (-5..9).map(move |x| outside(x, 4, wrap).map_or('.', |i| (b'0' + i as u8) as char))
        };
        assert!(row(Wrap::Repeat).eq("30123012301230".chars()));
        assert!(row(Wrap::Mirror).eq("33210012332100".chars()));
        assert!(row(Wrap::Clamp).eq("00000012333333".chars()));
        assert!(row(Wrap::Border).eq(".....0123.....".chars()));
        let odd = |wrap| {
            (-4..7).map(move |x| outside(x, 3, wrap).map_or('.', |i| (b'0' + i as u8) as char))
        };
        assert!(odd(Wrap::Repeat).eq("20120120120".chars()));
        assert!(odd(Wrap::Mirror).eq("22100122100".chars()));
    }

    #[test]
    fn nearest_floors_and_bilinear_weighs() {
        let texels = [[0, 0, 0], [255, 100, 8], [0, 0, 0], [255, 100, 8]];
        let mut texture = Texture::new(2, 2, Texels::Rgb888(&texels)).unwrap();
        assert_eq!(texture.sample(4095, 0, 0), [0, 0, 0]);
        assert_eq!(texture.sample(4096, 0, 0), [255, 100, 8]);
        texture.filter = Filter::Bilinear;
        assert_eq!(texture.sample(2048, 2048, 0), [0, 0, 0], "texel centres are texels");
        assert_eq!(texture.sample(4096 + 2048, 2048, 0), [255, 100, 8]);
        assert_eq!(texture.sample(4096, 2048, 0), [128, 50, 4], "half way");
        assert_eq!(texture.sample(0, 0, 0), [128, 50, 4], "across the seam of a repeat");
        texture.wrap = [Wrap::Clamp; 2];
        assert_eq!(texture.sample(0, 0, 0), [0, 0, 0]);
        texture.wrap = [Wrap::Border; 2];
        texture.border = [100; 3];
        assert_eq!(texture.sample(-4096, 2048, 0), [100; 3]);
    }

    #[test]
    fn levels_lie_one_after_another() {
        let texels: [[u8; 3]; 4 * 3 + 2 + 1] = core::array::from_fn(|i| [i as u8; 3]);
        let mut texture = Texture::new(4, 3, Texels::Rgb888(&texels)).unwrap();
        texture.levels = 3;
        assert_eq!(texture.check(), Ok(()));
        assert_eq!(texture.sample(3 << 12, 2 << 12, 0), [11; 3]);
        assert_eq!(texture.sample(3 << 12, 2 << 12, 1), [13; 3]);
        assert_eq!(texture.sample(3 << 12, 2 << 12, 2), [14; 3]);
        texture.levels = 4;
        assert_eq!(texture.check(), Err(TextureError::Texels { needed: 16, present: 15 }));
    }

    #[test]
    fn wrong_textures_are_refused() {
        let texels = [[0; 3]; 8];
        assert!(Texture::new(0, 4, Texels::Rgb888(&texels)).is_err());
        assert!(Texture::new(1025, 1, Texels::Rgb888(&texels)).is_err());
        assert!(Texture::new(3, 3, Texels::Rgb888(&texels)).is_err());
    }
}
