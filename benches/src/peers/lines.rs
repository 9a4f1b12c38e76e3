//! Lines: embedded-graphics (integers, pixel by pixel into a draw target) and tiny-skia (paths, RGBA).

use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::{Drawable, Point, Primitive};
use embedded_graphics::primitives::{Line as Segment, PrimitiveStyle};
use scanout::output::{PixelFormat, Rgb565 as Ours};
use tiny_skia::{Paint, PathBuilder, Pixmap, PremultipliedColorU8, Stroke, Transform};

use super::Drawer;
use super::embedded::Canvas;
use crate::lines::{HEIGHT, Line, WIDTH};

/// Lines by embedded-graphics, one pixel wide, one colour each.
#[derive(Debug)]
pub struct EmbeddedGraphics {
    lines: Vec<Line>,
    canvas: Canvas,
}

impl EmbeddedGraphics {
    /// These lines on a picture of 320 x 240.
    pub fn new(lines: Vec<Line>) -> EmbeddedGraphics {
        EmbeddedGraphics { lines, canvas: Canvas::new([WIDTH, HEIGHT]) }
    }
}

impl Drawer for EmbeddedGraphics {
    fn draw(&mut self) {
        for [a, b] in &self.lines {
            let [r, g, blue] = a.rgb;
            let style = PrimitiveStyle::with_stroke(Rgb565::new(r >> 3, g >> 2, blue >> 3), 1);
            let segment = Segment::new(Point::new(a.x, a.y), Point::new(b.x, b.y));
            segment.into_styled(style).draw(&mut self.canvas).expect("a canvas cannot fail");
        }
    }

    fn picture(&self) -> Vec<u16> {
        self.canvas.picture()
    }
}

/// Hairlines by tiny-skia without anti-aliasing, one colour each.
#[derive(Debug)]
pub struct TinySkia {
    lines: Vec<Line>,
    canvas: Pixmap,
}

impl TinySkia {
    /// These lines on a picture of 320 x 240.
    ///
    /// # Panics
    /// Never: the picture has a size.
    pub fn new(lines: Vec<Line>) -> TinySkia {
        let canvas = Pixmap::new(WIDTH.into(), HEIGHT.into()).expect("a picture with a size");
        TinySkia { lines, canvas }
    }
}

impl Drawer for TinySkia {
    fn draw(&mut self) {
        let stroke = Stroke { width: 0.0, ..Stroke::default() };
        let mut paint = Paint { anti_alias: false, ..Paint::default() };
        for [a, b] in &self.lines {
            let [red, green, blue] = a.rgb;
            paint.set_color_rgba8(red, green, blue, 255);
            let mut path = PathBuilder::new();
            path.move_to(a.x as f32 + 0.5, a.y as f32 + 0.5);
            path.line_to(b.x as f32 + 0.5, b.y as f32 + 0.5);
            // A path of a single point is none.
            if let Some(path) = path.finish() {
                self.canvas.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
            }
        }
    }

    fn picture(&self) -> Vec<u16> {
        let channels = |p: &PremultipliedColorU8| [p.red(), p.green(), p.blue()];
        self.canvas.pixels().iter().map(|p| Ours::encode(channels(p))).collect()
    }
}
