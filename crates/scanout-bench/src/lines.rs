//! Lines: random long and short ones at 320 x 240, all inside the picture.

use scanout::raster::line::{ClipRect, LineEnd};

/// Width of the picture.
pub const WIDTH: u16 = 320;
/// Height of the picture.
pub const HEIGHT: u16 = 240;
/// Lines in a set.
pub const COUNT: usize = 1000;

/// The whole picture.
pub const CLIP: ClipRect = ClipRect { x0: 0, y0: 0, x1: WIDTH as i32, y1: HEIGHT as i32 };

/// A pair of ends with depth and colour.
pub type Line = [LineEnd; 2];

struct Random(u64);

impl Random {
    fn below(&mut self, n: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % u64::from(n)) as u32
    }

    fn end(&mut self, x: i32, y: i32) -> LineEnd {
        let rgb = [0; 3].map(|_: u8| self.below(256) as u8);
        LineEnd { x, y, z: self.below(0xffff) << 16, rgb }
    }
}

/// Both ends anywhere in the picture.
pub fn long() -> Vec<Line> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let end = |random: &mut Random| {
        let (x, y) = (random.below(WIDTH.into()), random.below(HEIGHT.into()));
        random.end(x as i32, y as i32)
    };
    (0..COUNT).map(|_| [end(&mut random), end(&mut random)]).collect()
}

/// The second end at most 16 pixels from the first in x and in y.
pub fn short() -> Vec<Line> {
    let mut random = Random(0xd1b5_4a32_d192_ed03);
    let mut lines = Vec::new();
    while lines.len() < COUNT {
        let (x, y) = (random.below(WIDTH.into()) as i32, random.below(HEIGHT.into()) as i32);
        let (dx, dy) = (random.below(33) as i32 - 16, random.below(33) as i32 - 16);
        if CLIP.contains(x + dx, y + dy) {
            lines.push([random.end(x, y), random.end(x + dx, y + dy)]);
        }
    }
    lines
}

/// Pixels a line on average.
pub fn mean_pixels(lines: &[Line]) -> f64 {
    let pixels = |[a, b]: &Line| f64::from(a.x.abs_diff(b.x).max(a.y.abs_diff(b.y)) + 1);
    lines.iter().map(pixels).sum::<f64>() / lines.len() as f64
}
