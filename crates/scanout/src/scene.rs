//! What a frame shows: objects, materials, lights, fog, background, seen by one camera.

use crate::camera::Camera;
use crate::math::{Mat4, Q16, Vec3};
use crate::mesh::Mesh;
use crate::texture::Texture;

/// How an object is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mode {
    /// One square of [`Object::point_size`] pixels a position, depth-tested.
    Points,
    /// Every edge, nothing hidden (system A).
    Wire,
    /// Edges with what lies behind faces removed.
    Hidden,
    /// One colour a triangle, lit by its face normal (system B).
    Flat,
    /// Lit at the vertices, colour interpolated linearly on the screen (systems D and E).
    #[default]
    Gouraud,
    /// Normals interpolated, lit at every pixel.
    Phong,
}

/// How a surface reflects light (Phong's weights, system B's equations 3 to 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material<'a> {
    /// Colour R, G, B; multiplies vertex colours and texels.
    pub colour: [u8; 3],
    /// KA, weight of the ambient light, Q16.16 in [0, 1].
    pub ambient: Q16,
    /// KD, weight of diffuse reflection, Q16.16 in [0, 1].
    pub diffuse: Q16,
    /// KE, weight of specular reflection, Q16.16 in [0, 1]. B asks KA + KD + KE <= 1; a larger sum saturates.
    pub specular: Q16,
    /// Exponent of the specular term, 1 - 1024.
    pub shininess: u16,
    /// Texture, used by the modes `Flat`, `Gouraud` and `Phong` when the mesh has texture coordinates.
    pub texture: Option<&'a Texture<'a>>,
    /// Draw back faces too, lit from their own side.
    pub two_sided: bool,
}

impl Default for Material<'_> {
    /// White, 0.2 ambient and 0.8 diffuse, not shiny.
    fn default() -> Self {
        Material {
            colour: [255; 3],
            ambient: Q16::from_ratio(1, 5),
            diffuse: Q16::from_ratio(4, 5),
            specular: Q16::ZERO,
            shininess: 1,
            texture: None,
            two_sided: false,
        }
    }
}

/// A mesh placed in the world.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// The mesh.
    pub mesh: &'a Mesh<'a>,
    /// Its surface.
    pub material: &'a Material<'a>,
    /// Object to world, Q32.32; the last row must be 0 0 0 1. Mesh position 1.0 (= 32768) is one unit of the object.
    pub transform: Mat4,
    /// How it is drawn.
    pub mode: Mode,
    /// Anti-aliased lines in the modes `Wire` and `Hidden`.
    pub smooth_lines: bool,
    /// Side of a point in pixels, 1 - 64.
    pub point_size: u8,
}

impl<'a> Object<'a> {
    /// A mesh at the world's origin, one unit large, with thin lines and points.
    pub const fn new(mesh: &'a Mesh<'a>, material: &'a Material<'a>, mode: Mode) -> Object<'a> {
        let transform = Mat4::IDENTITY;
        Object { mesh, material, transform, mode, smooth_lines: false, point_size: 1 }
    }
}

/// A source of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light; the vector points **towards** the light, any length but zero, Q16.16.
    Directional(Vec3),
    /// A point in the world, Q16.16.
    Point(Vec3),
}

/// A light and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub kind: LightKind,
    /// Its colour, 255 = full.
    pub colour: [u8; 3],
}

impl Light {
    /// Whether it is white and from afar, which the feature `all-lights` is not needed for.
    pub(crate) fn is_plain(&self) -> bool {
        matches!(self.kind, LightKind::Directional(_)) && self.colour == [self.colour[0]; 3]
    }
}

/// Fog by distance along the view axis (clip w), in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fog {
    /// None before `start`, all at `end`, linear between.
    Linear {
        /// Colour of the fog.
        colour: [u8; 3],
        /// Distance where it begins, Q16.16.
        start: Q16,
        /// Distance where nothing else is seen, Q16.16, greater than `start`.
        end: Q16,
    },
    /// `1 - exp(-density * distance)`.
    Exponential {
        /// Colour of the fog.
        colour: [u8; 3],
        /// Density a world unit, Q16.16.
        density: Q16,
    },
}

/// What a frame shows where nothing is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background<'a> {
    /// One colour.
    Colour([u8; 3]),
    /// A picture, R, G, B rows from the top, exactly the frame's width x height (system A's camera).
    Image(&'a [[u8; 3]]),
}

/// A frame's content.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The camera.
    pub camera: Camera,
    /// What is drawn, in order.
    pub objects: &'a [Object<'a>],
    /// The lights; none means ambient light only.
    pub lights: &'a [Light],
    /// The least brightness of a lit surface (B's L_min), Q16.16 in [0, 1].
    pub light_floor: Q16,
    /// Fog, if any.
    pub fog: Option<Fog>,
    /// What lies behind everything.
    pub background: Background<'a>,
}

impl<'a> Scene<'a> {
    /// Objects on black, without lights or fog: ambient light only.
    pub const fn new(camera: Camera, objects: &'a [Object<'a>]) -> Scene<'a> {
        Scene {
            camera,
            objects,
            lights: &[],
            light_floor: Q16::ZERO,
            fog: None,
            background: Background::Colour([0; 3]),
        }
    }
}
