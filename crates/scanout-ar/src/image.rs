//! Grey pictures and how they are sampled.
//!
//! Pixel (x, y) covers [x, x + 1) x [y, y + 1), so its **centre lies at (x + 0.5, y + 0.5)**, as everywhere in scanout. OpenCV puts
//! the centre at (x, y): its coordinates are ours minus 0.5.

/// A grey picture in the caller's memory.
#[derive(Clone, Copy, Debug)]
pub struct GreyImage<'a> {
    width: usize,
    height: usize,
    stride: usize,
    pixels: &'a [u8],
}

impl<'a> GreyImage<'a> {
    /// A picture of `width` x `height` pixels, 0 black to 255 white, rows from the top, `stride` bytes from row to row.
    ///
    /// `None` unless `width <= stride` and all rows lie within `pixels`.
    pub fn new(width: usize, height: usize, stride: usize, pixels: &'a [u8]) -> Option<Self> {
        let end = match height.checked_sub(1) {
            Some(rows) => rows.checked_mul(stride)?.checked_add(width)?,
            None => 0,
        };
        (width <= stride && end <= pixels.len()).then_some(Self { width, height, stride, pixels })
    }

    /// Pixels in a row.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Row `y` from the top.
    ///
    /// # Panics
    /// When `y` is not below the height.
    pub fn row(&self, y: usize) -> &'a [u8] {
        &self.pixels[y * self.stride..][..self.width]
    }

    /// Bilinear value at a point, pixel centres at .5; beyond the edge the edge's pixels go on. 0 - 255; 0 for a picture without
    /// pixels.
    pub fn sample(&self, x: f64, y: f64) -> f64 {
        if self.width == 0 || self.height == 0 {
            return 0.0;
        }
        let x = (x - 0.5).max(0.0).min((self.width - 1) as f64);
        let y = (y - 0.5).max(0.0).min((self.height - 1) as f64);
        // Not negative: truncation is floor.
        let (column, line) = (x as usize, y as usize);
        let (fx, fy) = (x - column as f64, y - line as f64);
        let right = (column + 1).min(self.width - 1);
        let below = (line + 1).min(self.height - 1);
        let at = |x: usize, y: usize| f64::from(self.pixels[y * self.stride + x]);
        let top = at(column, line) + (at(right, line) - at(column, line)) * fx;
        let bottom = at(column, below) + (at(right, below) - at(column, below)) * fx;
        top + (bottom - top) * fy
    }
}

/// Halves a picture: each pixel the mean of 2 x 2, rounded to nearest; an odd last row or column is left out. `to` holds
/// `(width / 2) * (height / 2)` pixels.
///
/// # Panics
/// When `to` is shorter.
pub fn halve(from: &GreyImage, to: &mut [u8]) {
    let (width, height) = (from.width / 2, from.height / 2);
    for y in 0..height {
        let (upper, lower) = (from.row(2 * y), from.row(2 * y + 1));
        let to = &mut to[y * width..][..width];
        let pairs = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
        for (to, (a, b)) in to.iter_mut().zip(pairs) {
            // Two pixels in a word: this becomes vector instructions.
            let (a, b) = (u16::from_le_bytes(*a), u16::from_le_bytes(*b));
            let sum = (a & 255) + (a >> 8) + (b & 255) + (b >> 8);
            *to = ((sum + 2) >> 2) as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centres_lie_at_one_half() {
        let pixels = [0, 100, 200, 40];
        let image = GreyImage::new(2, 2, 2, &pixels).unwrap();
        assert_eq!(image.sample(0.5, 0.5), 0.0);
        assert_eq!(image.sample(1.5, 0.5), 100.0);
        assert_eq!(image.sample(1.0, 1.0), 85.0);
        assert_eq!(image.sample(-7.0, 9.0), 200.0);
        assert_eq!(image.sample(f64::NAN, f64::NAN), 0.0);
    }

    #[test]
    fn sizes_that_do_not_fit_are_none() {
        assert!(GreyImage::new(3, 2, 3, &[0; 5]).is_none());
        assert!(GreyImage::new(3, 2, 4, &[0; 7]).is_some());
        assert!(GreyImage::new(3, 1, 2, &[0; 7]).is_none());
        assert!(GreyImage::new(1, usize::MAX, usize::MAX, &[0; 7]).is_none());
        assert!(GreyImage::new(0, 0, 0, &[]).is_some());
    }

    #[test]
    fn halving_rounds_and_leaves_odd_edges_out() {
        let image = GreyImage::new(3, 3, 3, &[1, 2, 9, 2, 2, 9, 9, 9, 9]).unwrap();
        let mut half = [0; 1];
        halve(&image, &mut half);
        assert_eq!(half, [2]);
    }
}
