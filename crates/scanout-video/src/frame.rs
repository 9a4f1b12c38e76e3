//! One picture of a film.

/// A picture and when it was taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// R, G, B, rows from the top; `width * height` of them.
    pub rgb: Vec<[u8; 3]>,
    /// Seconds since the first frame.
    pub time: f64,
}

impl Frame {
    /// Its grey levels, rows from the top: (77 R + 150 G + 29 B + 128) / 256, rounded down (Rec. 601).
    pub fn grey(&self, to: &mut Vec<u8>) {
        to.clear();
        to.extend(self.rgb.iter().map(|&[r, g, b]| {
            let sum = 77 * u32::from(r) + 150 * u32::from(g) + 29 * u32::from(b);
            ((sum + 128) >> 8) as u8
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_of_black_and_white() {
        let rgb = vec![[0; 3], [255; 3], [255, 0, 0]];
        let mut grey = vec![9];
        Frame { width: 3, height: 1, rgb, time: 0.0 }.grey(&mut grey);
        assert_eq!(grey, [0, 255, 77]);
    }
}
