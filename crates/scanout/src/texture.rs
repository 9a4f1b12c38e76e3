//! Textures.

/// Texels of a texture, rows from the top; mip levels follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels<'a> {
    /// 5-6-5 bits, red in the top bits; widened by bit replication.
    Rgb565(&'a [u16]),
    /// 8 bits a channel, R, G, B.
    Rgb888(&'a [[u8; 3]]),
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
