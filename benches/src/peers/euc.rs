//! euc 0.5: floats, a pipeline of shaders, 32-bit depth.

use euc::{Pipeline, Target, buffer::Buffer2d, rasterizer::Triangles};
use vek::{Mat4, Vec3, Vec4};

use super::{Drawer, FloatMesh, intensity, light, pack};
use crate::scenes::COLOUR;

struct Shader<'a> {
    matrix: Mat4<f32>,
    positions: &'a [[f32; 3]],
    light: [f32; 3],
}

impl Pipeline for Shader<'_> {
    type Vertex = usize;
    type VsOut = Vec3<f32>;
    type Pixel = u16;

    #[inline(always)]
    fn vert(&self, &index: &usize) -> ([f32; 4], Vec3<f32>) {
        let p = self.positions[index];
        let clip = self.matrix * Vec4::new(p[0], p[1], p[2], 1.0);
        let colour = Vec3::from(COLOUR.map(|c| f32::from(c) / 255.0));
        (clip.into_array(), colour * intensity(p, self.light))
    }

    #[inline(always)]
    fn frag(&self, colour: &Vec3<f32>) -> u16 {
        pack(colour.into_array())
    }
}

/// A Gouraud sphere by euc.
#[derive(Debug)]
pub struct Euc {
    mesh: FloatMesh,
    indices: Vec<usize>,
    size: [u16; 2],
    colour: Buffer2d<u16>,
    depth: Buffer2d<f32>,
}

impl Euc {
    /// A sphere of so many triangles on a picture of this size.
    pub fn new(triangles: usize, size: [u16; 2]) -> Euc {
        let mesh = FloatMesh::sphere(triangles);
        let indices = mesh.triangles.iter().flatten().copied().collect();
        let pixels = size.map(usize::from);
        let (colour, depth) = (Buffer2d::new(pixels, 0), Buffer2d::new(pixels, 1.0));
        Euc { mesh, indices, size, colour, depth }
    }
}

impl Drawer for Euc {
    fn draw(&mut self) {
        self.colour.clear(0);
        self.depth.clear(1.0);
        let [width, height] = self.size.map(f32::from);
        let angle = 45f32.to_radians();
        let matrix = Mat4::perspective_fov_rh_no(angle, width, height, 1.0, 10.0)
            * Mat4::translation_3d(Vec3::new(0.0, 0.0, -3.0));
        Shader { matrix, positions: &self.mesh.positions, light: light() }.draw::<Triangles<_>, _>(
            &self.indices,
            &mut self.colour,
            Some(&mut self.depth),
        );
    }

    fn picture(&self) -> Vec<u16> {
        self.colour.as_ref().to_vec()
    }
}
