//! A fixed-function 3D pipeline for small machines: no operating system, no allocator, no floating point.
//!
//! The same integer arithmetic runs on a PC, on a microcontroller and, as RTL, in an FPGA, so a frame has one right answer, bit
//! for bit, on all three.
//!
//! ```text
//!  mesh, camera, lights
//!        |
//!   transform -> light -> clip -> cull        every vertex once, into the caller's Store
//!        |
//!      setup -> raster -> interpolate         edge functions and planes, exact
//!                 |
//!             texture -> depth -> shade       a fragment
//!                 |
//!              output -> scan-out             bands of rows in their final format
//! ```
//!
//! Each stage is a module of that name; its first lines give its equations, number formats and rounding. `frame` joins
//! them: [`frame::Frame::prepare`] runs the first row of stages, [`frame::Frame::draw_rows`] the others.
//! [`frame::Preparation`] and [`frame::Frame::bands`] cut both for threads, whose number no pixel depends on.
//!
//! # Conventions
//!
//! - World: right-handed, y up; the camera looks along -z of its own basis. Front faces are counter-clockwise.
//! - Screen: x right, y down, pixel centres at .5, top-left fill rule, 4 sub-pixel bits.
//! - Texture coordinates: u right, v down, (0, 0) the outer corner of the first texel.
//! - Depth: 16 bits, 0 near, 65535 far; strictly nearer passes.
//! - Lines: Bresenham, both ends drawn, the same pixels from either end.
//!
//! # Example
//!
//! A triangle in 32 lines of memory at a time:
//!
//! ```
//! use scanout::camera::{Camera, projection};
//! use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
//! use scanout::math::{Angle, Mat4, Q16, Vec3};
//! use scanout::mesh::Mesh;
//! use scanout::output::Rgb565;
//! use scanout::scene::{Background, Material, Mode, Object, Scene};
//! use scanout::transform::Vertex;
//!
//! let mesh = Mesh {
//!     positions: &[[-20000, -20000, 0], [20000, -20000, 0], [0, 20000, 0]],
//!     colours: &[[255, 0, 0], [0, 255, 0], [0, 0, 255]],
//!     triangles: &[[0, 1, 2]],
//!     ..Mesh::default()
//! };
//! let material = Material { ambient: Q16::ONE, ..Material::default() };
//! let objects = [Object::new(&mesh, &material, Mode::Flat)];
//! let lens = projection::perspective(
//!     Angle::from_degrees(Q16::from_int(45)),
//!     Q16::from_ratio(4, 3),
//!     Q16::ONE,
//!     Q16::from_int(10),
//! )?;
//! let camera = Camera::look_at(Vec3::from_f64([0.0, 0.0, 3.0]), Vec3::ZERO, Vec3::Y, lens)?;
//! let scene = Scene::new(camera, &objects);
//!
//! let (mut vertices, mut primitives) = ([Vertex::default(); 3], [Primitive::default(); 1]);
//! let mut states = [ObjectState::default(); 1];
//! let store = Store {
//!     vertices: &mut vertices,
//!     primitives: &mut primitives,
//!     objects: &mut states,
//! };
//! let frame = Frame::prepare(&scene, Settings::new(320, 240), store)?;
//!
//! let (mut colour, mut depth) = ([0; 320 * 32], [0; 320 * 32]);
//! let mut lit = 0;
//! frame.draw_bands::<Rgb565, ()>(32, &mut colour, &mut depth, |band| {
//!     lit += band.colour.iter().filter(|&&pixel| pixel != 0).count();
//!     Ok(()) // here a driver would send the band to the display
//! }).unwrap();
//! assert_eq!(lit, 6962);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![no_std]
// `unsafe` is in four places, `lanes::sse2`, `avx2`, `memory` and `raster::line::fill`, each beside its reason.
#![deny(unsafe_code)]

mod avx2;
pub mod camera;
pub mod clip;
pub mod cull;
pub mod depth;
mod features;
pub mod frame;
pub mod hash;
pub mod interpolate;
mod lanes;
pub mod light;
pub mod math;
mod memory;
pub mod mesh;
pub mod mesh_clusters;
pub mod mesh_edges;
pub mod output;
pub mod overlay;
pub mod raster;
pub mod scene;
pub mod setup;
pub mod shade;
pub mod texture;
pub mod transform;
