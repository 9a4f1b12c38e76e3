//! Frames without their lens's distortion, so that the pipeline's straight lines fit them.

use scanout_ar::Lens;

use crate::image_out::Picture;

/// Remembers for each pixel of the straight picture where it comes from.
#[derive(Default)]
pub struct Straightener {
    lens: Option<(Lens, usize, usize)>,
    /// Index of the upper left of four pixels, and the weights of right and lower, 0 - 256; or outside.
    map: Vec<Option<(u32, u16, u16)>>,
}

impl Straightener {
    /// The picture as a lens without distortion, but else the same, would see it: bilinear, black where nothing was seen.
    pub fn straighten(&mut self, picture: Picture, lens: &Lens) -> Picture {
        if lens.distortion == [0.0; 5] || picture.width < 2 || picture.height < 2 {
            return picture;
        }
        let (width, height) = (picture.width, picture.height);
        if self.lens != Some((*lens, width, height)) {
            self.map = map(lens, width, height);
            self.lens = Some((*lens, width, height));
        }
        let pixels = self.map.iter().map(|place| {
            let Some((index, right, lower)) = *place else { return [0; 3] };
            let at = index as usize;
            let [a, b, c, d] = [at, at + 1, at + width, at + width + 1].map(|i| picture.pixels[i]);
            let (x, y) = (u32::from(right), u32::from(lower));
            std::array::from_fn(|i| {
                let upper = u32::from(a[i]) * (256 - x) + u32::from(b[i]) * x;
                let under = u32::from(c[i]) * (256 - x) + u32::from(d[i]) * x;
                ((upper * (256 - y) + under * y + (1 << 15)) >> 16) as u8
            })
        });
        Picture { pixels: pixels.collect(), width, height }
    }
}

fn map(lens: &Lens, width: usize, height: usize) -> Vec<Option<(u32, u16, u16)>> {
    let mut map = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let ray = lens.straight().ray([x as f64 + 0.5, y as f64 + 0.5]);
            let place = lens.project([ray[0], ray[1], 1.0]).and_then(|[x, y]| {
                // Pixel centres lie at .5.
                let (x, y) = (x - 0.5, y - 0.5);
                let inside =
                    x >= 0.0 && y >= 0.0 && x <= (width - 1) as f64 && y <= (height - 1) as f64;
                inside.then(|| {
                    let (column, row) = ((x as usize).min(width - 2), (y as usize).min(height - 2));
                    let part = |x: f64, whole: usize| ((x - whole as f64) * 256.0).round() as u16;
                    ((row * width + column) as u32, part(x, column), part(y, row))
                })
            });
            map.push(place);
        }
    }
    map
}
