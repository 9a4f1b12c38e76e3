//! retrofire-core 0.4: floats, shaders as closures, 32-bit depth.

use retrofire_core::prelude::*;
use retrofire_core::render::{Model, render, shader};
use retrofire_core::util::Dims;
use retrofire_core::util::pixfmt::Rgb565;

use super::{Drawer, FloatMesh, intensity, light};
use crate::scenes::COLOUR;

/// A Gouraud sphere by retrofire.
pub struct Retrofire {
    faces: Vec<Tri<usize>>,
    vertices: Vec<Vertex3<[f32; 3]>>,
    size: [u16; 2],
    target: Framebuf<Colorbuf<Buf2<u16>, Rgb565>, Buf2<f32>>,
}

impl Retrofire {
    /// A sphere of so many triangles on a picture of this size.
    pub fn new(triangles: usize, size: [u16; 2]) -> Retrofire {
        let mesh = FloatMesh::sphere(triangles);
        // Its y axis points down and z away from the eye: half a turn about x.
        let turned = |p: &[f32; 3]| vertex(pt3(p[0], -p[1], -p[2]), *p);
        let dims = Dims(size[0].into(), size[1].into());
        Retrofire {
            // Clockwise on the screen is its front.
            faces: mesh.triangles.iter().map(|&[a, b, c]| tri(a, c, b)).collect(),
            vertices: mesh.positions.iter().map(turned).collect(),
            size,
            target: Framebuf {
                color_buf: Colorbuf::new(Buf2::new(dims)),
                depth_buf: Buf2::new(dims),
            },
        }
    }
}

impl Drawer for Retrofire {
    fn draw(&mut self) {
        self.target.color_buf.buf.data_mut().fill(0);
        // It compares reciprocals of distances.
        self.target.depth_buf.data_mut().fill(0.0);
        let (light, [r, g, b]) = (light(), COLOUR.map(|c| f32::from(c) / 255.0));
        let shader = shader::new(
            |v: Vertex3<[f32; 3]>, matrix: &ProjMat3<Model>| {
                let i = intensity(v.attrib, light);
                vertex(matrix.apply(&v.pos), rgb(r * i, g * i, b * i))
            },
            |fragment: Frag<Color3f>, _| fragment.var.to_color4(),
        );
        let [width, height] = self.size.map(f32::from);
        let (aspect, focal) = (width / height, 1.0 / 22.5f32.to_radians().tan());
        let project = perspective(focal / aspect, aspect, 1.0..10.0);
        let matrix = translate((0.0, 0.0, 3.0)).to().then(&project);
        let dims = Dims(self.size[0].into(), self.size[1].into());
        render(
            &self.faces,
            &self.vertices,
            &shader,
            &matrix,
            viewport(dims.into()),
            &mut self.target,
            &Context::default(),
        );
    }

    fn picture(&self) -> Vec<u16> {
        self.target.color_buf.buf.data().to_vec()
    }
}
