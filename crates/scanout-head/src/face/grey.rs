//! A picture's grey levels, and the same picture smaller.

/// Grey levels, rows from the top.
#[derive(Clone, Copy, Debug)]
pub struct Grey<'a> {
    pub(super) levels: &'a [u8],
    pub(super) width: usize,
    pub(super) height: usize,
}

impl<'a> Grey<'a> {
    /// A picture of `width` levels a row; `None` unless it has whole rows, at least one, and sides of at most 8,192.
    pub fn new(levels: &'a [u8], width: usize) -> Option<Self> {
        if levels.is_empty() || width == 0 || !levels.len().is_multiple_of(width) {
            return None;
        }
        let height = levels.len() / width;
        // 65,536 times a place fits 31 bits with room for a box beside the picture.
        (width.max(height) <= 8_192).then_some(Self { levels, width, height })
    }

    /// Half of each side: the mean of 2 x 2 levels, rounded to nearest; an odd last row or column is left out.
    pub fn halved(&self, to: &mut Vec<u8>) -> Option<usize> {
        let (width, height) = (self.width / 2, self.height / 2);
        to.clear();
        for row in 0..height {
            let line = &self.levels[2 * row * self.width..][..2 * self.width];
            let (upper, lower) = line.split_at(self.width);
            let pairs = upper.chunks_exact(2).zip(lower.chunks_exact(2));
            to.extend(pairs.map(|(a, b)| {
                let sum = u16::from(a[0]) + u16::from(a[1]) + u16::from(b[0]) + u16::from(b[1]);
                ((sum + 2) / 4) as u8
            }));
        }
        (!to.is_empty()).then_some(width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_means() {
        let grey = Grey::new(&[1, 2, 9, 3, 4, 9, 7, 7, 7], 3).unwrap();
        let mut half = Vec::new();
        assert_eq!(grey.halved(&mut half), Some(1));
        assert_eq!(half, [3]);
        assert!(Grey::new(&[1, 2, 3], 2).is_none() && Grey::new(&[], 0).is_none());
        assert_eq!(Grey::new(&[1], 1).unwrap().halved(&mut half), None);
    }
}
