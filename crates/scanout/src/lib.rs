//! The scanout pipeline.
#![no_std]
#![forbid(unsafe_code)]

pub mod camera;
pub mod clip;
pub mod cull;
pub mod depth;
pub mod interpolate;
pub mod light;
pub mod math;
pub mod mesh;
pub mod output;
pub mod raster;
pub mod scene;
pub mod setup;
pub mod shade;
pub mod texture;
pub mod transform;
