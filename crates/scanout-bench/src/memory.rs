//! What the caller of the pipeline provides: the frame's store, colour and depth.

use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::output::Rgb565;
use scanout::scene::Scene;
use scanout::transform::Vertex;

/// The caller's memory: the frame's store, colour and depth.
#[derive(Clone, Debug)]
pub struct Memory {
    vertices: Vec<Vertex>,
    primitives: Vec<Primitive>,
    objects: Vec<ObjectState>,
    /// RGB565, rows from the top.
    pub colour: Vec<u16>,
    /// 16 bits a pixel.
    pub depth: Vec<u16>,
}

impl Memory {
    /// Enough for a scene, and for a frame of this size in one band.
    pub fn new(scene: &Scene, width: u16, height: u16) -> Memory {
        let needed = Needed::at_most(scene);
        let pixels = width as usize * height as usize;
        Memory {
            vertices: vec![Default::default(); needed.vertices],
            primitives: vec![Default::default(); needed.primitives],
            objects: vec![Default::default(); needed.objects],
            colour: vec![0; pixels],
            depth: vec![0; pixels],
        }
    }

    /// Prepares a scene; the frame, colour and depth memory.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    pub fn prepare<'a>(
        &'a mut self,
        scene: &'a Scene<'a>,
        settings: Settings,
    ) -> (Frame<'a>, &'a mut [u16], &'a mut [u16]) {
        let store = Store {
            vertices: &mut self.vertices,
            primitives: &mut self.primitives,
            objects: &mut self.objects,
        };
        let frame = Frame::prepare(scene, settings, store).expect("a scene that can be drawn");
        (frame, &mut self.colour, &mut self.depth)
    }

    /// Prepares a scene and draws all of it, one thread, one band.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    #[inline(never)]
    pub fn draw(&mut self, scene: &Scene, settings: Settings) {
        let (frame, colour, depth) = self.prepare(scene, settings);
        frame.draw_rows::<Rgb565>(0..settings.height, colour, depth).expect("memory for all rows");
    }
}
