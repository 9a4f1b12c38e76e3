//! Peers: crates from the package registry that draw the same sphere, or lines, in the same run.
//!
//! They get the same camera, light, size and triangles; how they compute is theirs. Each draws once before it is
//! measured, and its picture is compared with scanout's, so that a peer that draws something else is noticed.

mod embedded;
mod euc;
mod lines;
mod retrofire;

pub use self::embedded::Embedded;
pub use self::euc::Euc;
pub use self::lines::{EmbeddedGraphics, TinySkia};
pub use self::retrofire::Retrofire;

use crate::scenes::LIGHT;
use crate::sphere::sphere;

/// Something that draws a frame.
pub trait Drawer {
    /// Draws it.
    fn draw(&mut self);
    /// The last frame, RGB565 on black.
    fn picture(&self) -> Vec<u16>;
}

/// The sphere in floats, as the peers want it.
#[derive(Clone, Debug, Default)]
pub struct FloatMesh {
    /// Positions, radius 1; they are the normals too.
    pub positions: Vec<[f32; 3]>,
    /// Indices into `positions`, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
}

impl FloatMesh {
    /// The sphere with this many triangles.
    ///
    /// # Panics
    /// When there is none.
    pub fn sphere(triangles: usize) -> FloatMesh {
        let mesh = sphere(triangles);
        FloatMesh {
            positions: mesh.positions.iter().map(|p| p.map(|v| f32::from(v) / 32767.0)).collect(),
            triangles: mesh.triangles.iter().map(|t| t.map(usize::from)).collect(),
        }
    }
}

/// The unit vector towards the light.
pub fn light() -> [f32; 3] {
    let length = LIGHT.iter().map(|v| v * v).sum::<f64>().sqrt();
    LIGHT.map(|v| (v / length) as f32)
}

/// 0.2 ambient and 0.8 diffuse light on a unit normal.
pub fn intensity(normal: [f32; 3], light: [f32; 3]) -> f32 {
    let dot: f32 = normal.iter().zip(light).map(|(n, l)| n * l).sum();
    0.2 + 0.8 * dot.max(0.0)
}

/// R, G, B in [0, 1] to RGB565.
#[inline(always)]
pub fn pack([r, g, b]: [f32; 3]) -> u16 {
    ((r * 255.0) as u16 & 0xf8) << 8 | ((g * 255.0) as u16 & 0xfc) << 3 | (b * 255.0) as u16 >> 3
}
