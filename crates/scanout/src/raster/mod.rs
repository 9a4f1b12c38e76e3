//! Raster: triangles, lines and points become pixels. Coverage is exact, so any traversal finds the same pixels.

pub mod line;
pub mod point;
pub(crate) mod small;
pub mod smooth_line;
pub mod triangle;
