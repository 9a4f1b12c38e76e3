//! Judges from outside for the pixels of `scanout`.
//!
//! Three renderers answer the same three questions about one triangle (see [`Renderer`]): which pixels does it cover, which
//! colour and depth have they, which texel does each show.
//!
//! | renderer | arithmetic | written by |
//! |---|---|---|
//! | [`mod@reference`] | exact rationals in `i128`, the definition itself | this crate, without a look at `scanout` |
//! | [`llvmpipe::Llvmpipe`] | floats and 8 sub-pixel bits | the Mesa project |
//! | [`pipeline::Pipeline`] | the integers that ship | `scanout` |
//!
//! [`judge`] compares an answer with the exact one and reports how far it is off; [`model`] does so with whole frames. Lines have a judge of their own: Pillow,
//! called through `lines.py` beside this crate (see [`lines`]).
//!
//! # Conventions
//! Those of `scanout`: x right, y down, pixel centres at .5, 4 sub-pixel bits, top-left rule, depth 0 at the near plane.
//! Where GL's differ, [`llvmpipe`] converts.
//!
//! # What this crate will not do
//! It is no renderer: nothing here is fast, and nothing that ships depends on it.

pub mod judge;
pub mod lines;
pub mod llvmpipe;
pub mod model;
pub mod pipeline;
pub mod random;
pub mod reference;
pub mod triangle;

mod gl;

pub use triangle::{
    Coverage, Fragment, Picture, Renderer, Rounding, Texel, Texture, Triangle, Vertex, Wrap,
};
