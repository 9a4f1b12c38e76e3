//! Meshes and textures for scanout: from files to the small integers that the pipeline reads.
//!
//! Two layers:
//!
//! - [`obj`], [`ppm`], [`number`] and [`bake::read`] need neither allocator nor operating system. Firmware feeds them
//!   the chunks that its card reader delivers; the PC's loader is built on the same code.
//! - With the feature `std` (on by default), [`load`] reads OBJ + MTL, STL, PLY and glTF/GLB with their textures (PPM,
//!   PGM, PNG, JPEG) into a [`Model`], and [`bake`] writes what firmware links and what hardware's `$readmemh` reads.
//!
//! What comes out is fixed point (see `scanout::mesh`): positions Q1.15 on **one** grid a model, so that seams between
//! parts stay watertight, normals Q2.14, texture coordinates Q16.16 with v downwards. [`Placement`] reports the scale
//! and offset that lead back to the file's coordinates. All arithmetic on the way is IEEE `+ - * /` and square root,
//! so every host loads the same bits.
//!
//! Bad input is an error of one line with file and line (or byte) and the remedy; what can be drawn in spite of a flaw is
//! drawn, with a [`Warning`]. No reader panics, recurses, or allocates more than [`Limits`] allows, on any input.
//!
//! Cost, measured: an OBJ of 980,000 triangles (29 MB) takes 1.8 s and 231 MB on one core of a server, about 100 bytes a
//! corner at the peak, and a binary STL of as many 2.2 s and 354 MB.
//!
//! Not done: skinning, animation, morph targets, compressed glTF, curved OBJ surfaces, texture maps other than colour.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

pub mod bake;
pub mod number;
pub mod obj;
pub mod ppm;
pub mod text;

#[cfg(feature = "std")]
mod assemble;
#[cfg(feature = "std")]
mod closed;
#[cfg(feature = "std")]
mod error;
#[cfg(feature = "std")]
mod image;
#[cfg(feature = "std")]
mod load;
#[cfg(feature = "std")]
mod model;
#[cfg(feature = "std")]
mod normals;
#[cfg(feature = "std")]
mod palette;
#[cfg(feature = "std")]
mod raw;
#[cfg(feature = "std")]
mod reader;
#[cfg(feature = "std")]
mod sniff;
#[cfg(feature = "std")]
mod triangulate;

#[cfg(feature = "std")]
pub use error::{At, LoadError, LoadErrorKind, Warning, WarningLevel};
#[cfg(feature = "std")]
pub use image::load_image;
#[cfg(feature = "std")]
pub use load::{Format, Limits, LoadOptions, NormalSource, load, load_bytes};
#[cfg(feature = "std")]
pub use model::{Image, MaterialBuf, MeshBuf, Model, NormalsBuf, Part, Placement, Stats};
#[cfg(feature = "std")]
pub use palette::{Paletted, TextureFormat};
