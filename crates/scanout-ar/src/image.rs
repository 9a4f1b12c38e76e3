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

    /// Bilinear values at `N` points in a line, `step` from one to the next, to 1/2048 of a pixel; as [`GreyImage::sample`].
    pub fn line<const N: usize>(&self, from: [f64; 2], step: [f64; 2]) -> [f32; N] {
        const ONE: f64 = 65536.0;
        // 16 fractional bits; far away they stop at the ends of 32 bits. A half of the 11 bits that are used is for rounding.
        let [x, y] = from.map(|x| ((x - 0.5) * ONE) as i32);
        let [dx, dy] = step.map(|x| (x * ONE) as i32);
        let inside = |x: i32, dx: i32, pixels: usize| {
            let end = i64::from(x) + i64::from(dx) * N as i64;
            let inside = 0..(pixels as i64 - 1) << 16;
            inside.contains(&x.into()) && inside.contains(&end)
        };
        if !inside(x, dx, self.width) || !inside(y, dy, self.height) {
            let at = |i: usize| {
                self.sample(from[0] + step[0] * i as f64, from[1] + step[1] * i as f64) as f32
            };
            return core::array::from_fn(at);
        }
        let (mut x, mut y) = (x, y);
        core::array::from_fn(|_| {
            let start = (y >> 16) as usize * self.stride + (x >> 16) as usize;
            let (fx, fy) = (x >> 5 & 2047, y >> 5 & 2047);
            (x, y) = (x + dx, y + dy);
            let pair = |start: usize| {
                let [a, b] = [start, start + 1].map(|i| i32::from(self.pixels[i]));
                (a << 11) + (b - a) * fx
            };
            let (top, bottom) = (pair(start), pair(start + self.stride));
            ((top << 11) + (bottom - top) * fy) as f32 * (1.0 / 4194304.0)
        })
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
    fn lines_are_samples() {
        let pixels: [u8; 48] = core::array::from_fn(|i| (i * i * 37 % 251) as u8);
        let image = GreyImage::new(8, 6, 8, &pixels).unwrap();
        for (from, step) in [
            ([1.3, 4.9], [0.71, -0.43]),
            ([0.5, 0.5], [0.0, 0.9]),
            ([6.4, 3.0], [-0.8, 0.01]),
            // Partly and wholly beyond the edge.
            ([5.0, 1.0], [1.5, 0.5]),
            ([-9e9, 9e9], [1e9, 1.0]),
        ] {
            let line = image.line::<7>(from, step);
            for (i, value) in line.into_iter().enumerate() {
                let [x, y] = [0, 1].map(|axis| from[axis] + step[axis] * i as f64);
                // Two neighbours may be 250 apart: 250 / 2048 in either direction, and 16 bits for the steps.
                let want = image.sample(x, y);
                assert!((f64::from(value) - want).abs() < 0.3, "{from:?} {i}: {value}, {want}");
            }
        }
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
