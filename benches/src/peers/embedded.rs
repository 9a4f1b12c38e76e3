//! embedded-3dgfx 0.7: floats for vertices, integers for pixels, a draw target of embedded-graphics, 16-bit depth.

use core::convert::Infallible;

use embedded_3dgfx::Z_MAX_VALUE;
use embedded_3dgfx::ZDepth;
use embedded_3dgfx::engine::K3dengine;
use embedded_3dgfx::pipeline::command_buffer::CommandBuffer;
use embedded_3dgfx::pipeline::renderer::FrameCtx;
use embedded_3dgfx::pipeline::vertex::mesh::{Geometry, K3dMesh, RenderMode};
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{IntoStorage, Rgb565, RgbColor};
use embedded_graphics::primitives::Rectangle;
use nalgebra::{Point3, Vector3};

use super::{Drawer, FloatMesh, light};
use crate::scenes::COLOUR;

/// A frame in memory as embedded-graphics' draw target.
#[derive(Clone, Debug)]
pub struct Canvas {
    size: [u16; 2],
    /// Rows from the top.
    pub pixels: Vec<Rgb565>,
}

impl Canvas {
    /// A black picture.
    pub fn new(size: [u16; 2]) -> Canvas {
        Canvas { size, pixels: vec![Rgb565::BLACK; size[0] as usize * size[1] as usize] }
    }

    /// RGB565.
    pub fn picture(&self) -> Vec<u16> {
        self.pixels.iter().map(|p| p.into_storage()).collect()
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.size[0].into(), self.size[1].into())
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb565;
    type Error = Infallible;

    #[inline]
    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        let [width, height] = self.size.map(u32::from);
        for Pixel(p, colour) in pixels {
            let (x, y) = (p.x as u32, p.y as u32);
            if x < width && y < height {
                self.pixels[(y * width + x) as usize] = colour;
            }
        }
        Ok(())
    }

    #[inline]
    fn fill_solid(&mut self, area: &Rectangle, colour: Rgb565) -> Result<(), Infallible> {
        let [width, height] = self.size.map(i64::from);
        let (x, y) = (i64::from(area.top_left.x), i64::from(area.top_left.y));
        let (right, bottom) = (x + i64::from(area.size.width), y + i64::from(area.size.height));
        let (x, right) = (x.clamp(0, width) as usize, right.clamp(0, width) as usize);
        for row in y.clamp(0, height) as usize..bottom.clamp(0, height) as usize {
            let start = row * width as usize;
            self.pixels[start + x..start + right.max(x)].fill(colour);
        }
        Ok(())
    }

    #[inline]
    fn clear(&mut self, colour: Rgb565) -> Result<(), Infallible> {
        self.pixels.fill(colour);
        Ok(())
    }
}

/// Room for the primitives of the largest sphere.
const COMMANDS: usize = 32 * 1024;

/// A sphere by embedded-3dgfx.
pub struct Embedded {
    mesh: FloatMesh,
    face_normals: Vec<[f32; 3]>,
    smooth: bool,
    engine: K3dengine,
    commands: Box<CommandBuffer<COMMANDS>>,
    canvas: Canvas,
    depth: Vec<ZDepth>,
}

impl Embedded {
    /// A sphere of so many triangles on a picture of this size, Gouraud or flat.
    pub fn new(triangles: usize, size: [u16; 2], smooth: bool) -> Embedded {
        let mesh = FloatMesh::sphere(triangles);
        let normal = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| Vector3::from(mesh.positions[i]));
            (b - a).cross(&(c - a)).normalize().into()
        };
        let face_normals = mesh.triangles.iter().map(normal).collect();
        let mut engine = K3dengine::new(size[0], size[1]);
        engine.camera.set_position(Point3::new(0.0, 0.0, 3.0));
        engine.camera.set_target(Point3::origin());
        engine.camera.set_fovy(45f32.to_radians());
        engine.camera.set_near_far(1.0, 10.0);
        let depth = vec![Z_MAX_VALUE; size[0] as usize * size[1] as usize];
        let (commands, canvas) = (Box::new(CommandBuffer::new()), Canvas::new(size));
        Embedded { mesh, face_normals, smooth, engine, commands, canvas, depth }
    }
}

impl Drawer for Embedded {
    fn draw(&mut self) {
        let geometry = Geometry {
            vertices: &self.mesh.positions,
            faces: &self.mesh.triangles,
            normals: &self.face_normals,
            vertex_normals: if self.smooth { &self.mesh.positions } else { &[] },
            ..Geometry::default()
        };
        let mut mesh = K3dMesh::new(geometry);
        let [r, g, b] = COLOUR;
        mesh.set_color(Rgb565::new(r >> 3, g >> 2, b >> 3));
        // It turns the light's z around.
        let [x, y, z] = light();
        let light = Vector3::new(x, y, -z);
        mesh.set_render_mode(if self.smooth {
            RenderMode::GouraudLightDir(light)
        } else {
            RenderMode::SolidLightDir(light)
        });
        self.canvas.pixels.fill(Rgb565::BLACK);
        self.commands.clear();
        self.engine
            .record(std::iter::once(&mesh), &mut *self.commands, None)
            .expect("room for all commands");
        let [width, height] = self.canvas.size.map(usize::from);
        let mut frame = FrameCtx { zbuffer: &mut self.depth, width, height };
        self.engine
            .execute(&mut self.canvas, &mut frame, &*self.commands, None)
            .expect("a frame that can be drawn");
    }

    fn picture(&self) -> Vec<u16> {
        self.canvas.picture()
    }
}
