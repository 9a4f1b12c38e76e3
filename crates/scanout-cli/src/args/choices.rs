//! Options with a fixed list of values.

use clap::ValueEnum;

/// How surfaces are drawn.
#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DrawMode {
    /// A square at each vertex
    Points,
    /// Every edge
    Wire,
    /// Edges, without those behind faces
    Hidden,
    /// One colour a triangle
    Flat,
    /// Lit at the vertices
    Gouraud,
    /// Lit at each pixel
    Phong,
    /// Lit at the vertices, with the model's textures
    #[default]
    Textured,
}

impl DrawMode {
    /// All of them, in the order of the window's keys 1 - 7.
    pub const ALL: [Self; 7] = [
        Self::Points,
        Self::Wire,
        Self::Hidden,
        Self::Flat,
        Self::Gouraud,
        Self::Phong,
        Self::Textured,
    ];

    /// The mode's name on the command line.
    pub fn name(self) -> &'static str {
        ["points", "wire", "hidden", "flat", "gouraud", "phong", "textured"][self as usize]
    }
}

/// Formats of models.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum InputFormat {
    Obj,
    Stl,
    Ply,
    Gltf,
    Glb,
}

/// How a texel is chosen.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureFilter {
    /// The texel under the pixel
    Nearest,
    /// Four texels, weighted
    Bilinear,
    /// As bilinear, in smaller pictures farther away
    Mipmap,
}

/// What lies outside a texture.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureWrap {
    /// The texture again
    Repeat,
    /// The texture again, mirrored every second time
    Mirror,
    /// The outermost texel
    Clamp,
    /// Black
    Border,
}

/// Two eyes in one picture; the aliases are ffmpeg's.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stereo {
    /// For red-cyan glasses: all colours
    #[value(aliases = ["anaglyph-colour", "anaglyph-color", "arcc"])]
    Anaglyph,
    /// For red-cyan glasses: without colours
    #[value(aliases = ["anaglyph-gray", "arcg"])]
    AnaglyphGrey,
    /// For red-cyan glasses: the left eye without colours
    #[value(aliases = ["anaglyph-half-color", "arch"])]
    AnaglyphHalfColour,
    /// For red-cyan glasses: colours by Dubois' least squares
    #[value(aliases = ["arcd"])]
    AnaglyphDubois,
    /// Left eye in the left half
    #[value(aliases = ["sbsl"])]
    SideBySide,
    /// Left eye in the left half, squeezed, as televisions take it
    #[value(aliases = ["sbs2l"])]
    SideBySideHalf,
    /// Left eye in the upper half
    #[value(aliases = ["abl"])]
    TopBottom,
    /// Left eye in the upper half, squeezed
    #[value(aliases = ["ab2l"])]
    TopBottomHalf,
    /// Left eye in the even lines
    #[value(aliases = ["irl"])]
    Interlaced,
}

/// Pixels as the display takes them.
#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelFormat {
    /// 24 bits
    #[default]
    Rgb888,
    /// 16 bits
    Rgb565,
    /// 8 bits
    Rgb332,
    /// 1 bit
    Mono,
}

/// Formats of pictures.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputFormat {
    /// Portable Network Graphics
    Png,
    /// Portable pixmap, P6
    Ppm,
    /// The frame's bytes as a display takes them, and nothing else
    Raw,
}

/// How a picture is shown in a terminal.
#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Terminal {
    /// Ask the terminal; NO_COLOR or TERM=dumb means ascii, unasked
    #[default]
    Auto,
    /// The kitty graphics protocol
    Kitty,
    /// Sixel graphics
    Sixel,
    /// Two pixels a character, 24-bit or 256 colours
    HalfBlocks,
    /// Characters of growing weight
    Ascii,
    /// No picture in the terminal
    Off,
}
