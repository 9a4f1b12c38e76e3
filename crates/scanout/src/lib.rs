//! The scanout pipeline.
#![no_std]
#![forbid(unsafe_code)]

pub mod camera;
pub mod clip;
pub mod cull;
pub mod depth;
pub mod frame;
pub mod hash;
pub mod interpolate;
pub mod light;
pub mod math;
pub mod mesh;
pub mod mesh_edges;
pub mod output;
pub mod raster;
pub mod scene;
pub mod setup;
pub mod shade;
pub mod texture;
pub mod transform;
