//! What the caller of the pipeline provides: the frame's store, colour and depth.

use std::ops::Range;

use scanout::frame::{Frame, Needed, ObjectState, Part, Preparation, Primitive, Settings, Store};
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

    /// The frame's store, colour and depth memory.
    pub fn all(&mut self) -> (Store<'_>, &mut [u16], &mut [u16]) {
        let store = Store {
            vertices: &mut self.vertices,
            primitives: &mut self.primitives,
            objects: &mut self.objects,
        };
        (store, &mut self.colour, &mut self.depth)
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
        let (store, colour, depth) = self.all();
        let frame = Frame::prepare(scene, settings, store).expect("a scene that can be drawn");
        (frame, colour, depth)
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

    /// The same in parts, one after another. What `twice` names is done twice, so that two counts tell what it costs.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    #[inline(never)]
    pub fn draw_in_parts(
        &mut self,
        scene: &Scene,
        settings: Settings,
        parts: &mut [Part],
        bands: u16,
        twice: Option<(Step, usize)>,
    ) {
        let of = |step| twice.and_then(|(this, k)| (this == step).then_some(k));
        let (store, colour, depth) = self.all();
        let width = usize::from(settings.width);
        let mut preparation =
            Preparation::new(scene, settings, store, parts).expect("a scene that can be drawn");
        preparation.vertex_parts().for_each(|part| part.run());
        if let Some(k) = of(Step::Vertices) {
            preparation.vertex_parts().skip(k).take(1).for_each(|part| part.run());
        }
        preparation.primitive_parts().for_each(|part| part.run());
        if let Some(k) = of(Step::Primitives) {
            preparation.primitive_parts().skip(k).take(1).for_each(|part| part.run());
        }
        let frame = preparation.finish().expect("a scene that can be drawn");
        let mut draw = |rows: Range<u16>| {
            let place = usize::from(rows.start) * width..usize::from(rows.end) * width;
            frame
                .draw_rows::<Rgb565>(rows, &mut colour[place.clone()], &mut depth[place])
                .expect("memory for all rows");
        };
        frame.bands(bands).for_each(&mut draw);
        if let Some(k) = of(Step::Bands) {
            frame.bands(bands).skip(k).take(1).for_each(draw);
        }
    }
}

/// A step that can be done in parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Transform and light.
    Vertices,
    /// Cull.
    Primitives,
    /// Drawing.
    Bands,
}
