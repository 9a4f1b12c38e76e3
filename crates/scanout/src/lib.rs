//! The scanout pipeline.
#![no_std]
#![forbid(unsafe_code)]

pub mod camera;
pub mod math;
pub mod mesh;
pub mod raster;
pub mod scene;
pub mod texture;
