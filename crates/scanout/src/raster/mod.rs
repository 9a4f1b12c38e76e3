//! Triangles, lines and points to pixels.

pub mod line;
