//! Eight vertices or triangles at a time in AVX2 registers, where the processor has them.
//!
//! Everything here exists a second time, one at a time and in integers, in [`transform`](crate::transform),
//! [`cull`](crate::cull), [`setup`](crate::setup) and the frame's fills. Those are the definition; this is tested to give the same bits.
//!
//! Wide products and divisions are done in `f64`, as *exact integer arithmetic*: every sum and product stays below 2^53, and
//! a quotient `n / d` of integers with |n| < 2^53 lies at least `1 / d` below the next integer unless it is one, while its
//! rounding error is below `1 / d`, so its floor is the integer floor. Where a bound cannot be kept, the lane or the group is left to
//! the scalar code.
//!
//! | module | does | scalar twin |
//! |---|---|---|
//! | `project` | positions to screen vertices, 4 at a time | `ClipMatrix::apply`, `Viewport::project` |
//! | `light` | colours of 8 vertices under white light from afar | `Lighting::lit_in_mesh` |
//! | `facing` | which of 8 triangles can be seen | `ObjectPass::triangles` |
//! | `planes` | edges and planes of 8 triangles | `Triangle::new`, `Triangle::plane`, `TextureSetup::new` |
//! | `edges` | edges of one colour, 8 at a time | `Field::line` |
//! | `strips` | their pixels, 16 side by side | `Target::fill_runs` |
//!
//! The token [`Avx2`] is proof that the processor can; elsewhere, and without the feature `simd`, there is none.

// Without the token, what it would work on is described and never read.
#![cfg_attr(not(all(feature = "simd", target_arch = "x86_64")), allow(dead_code))]

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod detect;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod edges;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod facing;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod light;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod memory;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod planes;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod project;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod strips;

#[cfg(not(all(feature = "simd", target_arch = "x86_64")))]
mod none;

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
pub use detect::Avx2;
#[cfg(not(all(feature = "simd", target_arch = "x86_64")))]
pub use none::Avx2;

use core::ops::Range;

use crate::texture::Repeat565;
use crate::transform::Vertex;

/// How many triangles, or pixels, lie side by side.
pub const EIGHT: usize = 8;
/// Columns of a strip.
pub const STRIP: usize = 2 * EIGHT;

/// Which of eight triangles can be seen, bit by bit, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// False for a group that must be looked at one by one: one of its triangles needs the clip stage, has an index out of range or
    /// is wider or higher than 2047 pixels.
    pub plain: bool,
    /// Bits of those that face the right way and have a pixel centre in their box.
    pub kept: u32,
    /// Bits of those that show their back.
    pub back: u32,
    /// How many face away or have no area, in this group and those passed over.
    pub turned: u32,
    /// How many face the right way and miss every pixel centre, there too.
    pub outside: u32,
    /// First rows.
    pub top: [i32; EIGHT],
    /// One past the last rows.
    pub bottom: [i32; EIGHT],
}

/// What triangles are made from.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// As in the mesh.
    pub triangles: &'a [[u16; 3]],
    /// The object's, on the screen.
    pub vertices: &'a [Vertex],
    /// Indices of texture coordinates, parallel to `triangles`; empty without texture.
    pub uv_triangles: &'a [[u16; 3]],
    /// Texture coordinates, Q16.16.
    pub uvs: &'a [[i32; 2]],
    /// The texture.
    pub texture: Option<Repeat565<'a>>,
    /// Colours come from the vertices.
    pub gouraud: bool,
    /// The rows to be drawn.
    pub rows: (i32, i32),
    /// Width of a row in pixels, at least [`STRIP`].
    pub width: i32,
}

/// A plane from the pixel at which a triangle's first strip begins, eight triangles' side by side.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct Planes {
    /// Value at the first pixel.
    pub start: [i32; EIGHT],
    /// Change a column.
    pub gx: [i32; EIGHT],
    /// Change a row.
    pub gy: [i32; EIGHT],
}

/// Eight tiny triangles, set up.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct Triangles {
    /// Bits of those that are what this is for; the others must go the general way.
    pub ready: u32,
    /// First column of the first strip: the triangle's, or a strip's width before the right border.
    pub x: [i32; EIGHT],
    /// First column that may be covered, cut to the frame.
    pub left: [i32; EIGHT],
    /// One past the last such column.
    pub right: [i32; EIGHT],
    /// First row that may be covered, cut to the band.
    pub top: [i32; EIGHT],
    /// Number of rows, none or less when outside.
    pub rows: [i32; EIGHT],
    /// The three edge functions; 16 bits hold them.
    pub edges: [Planes; 3],
    /// Depth, half a step added.
    pub depth: Planes,
    /// Colour channels, half a level added.
    pub colour: [Planes; 3],
    /// 1/w, s/w and t/w.
    pub q: Planes,
    /// See `q`.
    pub st: [Planes; 2],
    /// Shifts from products of `st` and the reciprocal of `q` to whole texels.
    pub shift: [[i32; EIGHT]; 2],
}

/// Colour and depth memory of the rows being drawn.
#[derive(Debug)]
pub struct Pixels<'m> {
    /// RGB565.
    pub colours: &'m mut [u16],
    /// Depths.
    pub depths: &'m mut [u16],
    /// Width of a row, at least [`STRIP`].
    pub width: usize,
    /// The first row.
    pub top: i32,
}

/// 16-bit colour memory that lines of one value are drawn in.
#[derive(Debug)]
pub struct Plain<'m> {
    /// `rows` times `width` and more.
    pub cells: &'m mut [u16],
    /// Width of a row.
    pub width: usize,
    /// Number of rows.
    pub rows: usize,
    /// The first row.
    pub top: i32,
    /// What is stored.
    pub value: u16,
}

/// Lanes of a group.
pub type Lanes = Range<usize>;
