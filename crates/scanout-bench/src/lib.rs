//! What is measured: the scenes and lines of `scanout bench`, of the instruction counts and of the peers in `benches/`.
//!
//! | module | holds |
//! |---|---|
//! | [`scenes`] | a case by its name, its data, its scene |
//! | [`sphere`] | the UV sphere of 400, 5,000 or 70,000 triangles and its texture |
//! | [`layers`] | eight sheets that each cover the whole picture: fill rates |
//! | [`memory`] | the caller's memory; a frame drawn by one thread or by several |
//! | [`lines`] | random long and short lines |
//!
//! It measures nothing itself.

pub mod layers;
pub mod lines;
pub mod memory;
pub mod scenes;
pub mod sphere;
