//! Cameras.

use crate::math::{Mat4, Vec3};

/// From where a surface is seen, for specular light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// A perspective eye in the world, Q16.16.
    Point(Vec3),
    /// Parallel rays (orthographic): the vector points towards the viewer.
    Direction(Vec3),
}

/// A camera: where it stands and how it projects.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// World to eye, Q32.32.
    pub view: Mat4,
    /// Eye to clip, Q32.32; visible: -w <= x, y <= w and 0 <= z <= w.
    pub projection: Mat4,
    /// From where surfaces are seen.
    pub viewpoint: Viewpoint,
}
