//! Where a line is: on the screen, or in a buffer.

use super::{ClipRect, Path};

/// A position on the line that the two kinds of step move.
pub trait Place {
    /// One step along the major axis.
    fn forward(&mut self);
    /// One step along both axes.
    fn diagonal(&mut self);
}

/// A pixel as (major, minor).
pub struct Pixel {
    /// Along the major axis.
    pub major: i32,
    /// Along the minor axis.
    pub minor: i32,
    /// +1 or -1.
    sideways: i32,
}

impl Pixel {
    /// The first pixel of a path.
    #[inline(always)]
    pub fn first(path: &Path) -> Self {
        Self { major: path.major, minor: path.minor, sideways: path.sideways }
    }
}

impl Place for Pixel {
    #[inline(always)]
    fn forward(&mut self) {
        self.major += 1;
    }

    #[inline(always)]
    fn diagonal(&mut self) {
        self.major += 1;
        self.minor += self.sideways;
    }
}

/// An index; steps are added modulo the word, so that they may be negative.
pub struct Cell {
    /// `(y - clip.y0) * stride + (x - clip.x0)`
    pub index: usize,
    /// What a step along the major axis adds.
    pub forward: usize,
    /// What a step along both axes adds.
    pub diagonal: usize,
}

impl Cell {
    /// The cell of the first pixel of a path, in a buffer that begins at the corner of `clip`.
    #[inline(always)]
    pub fn first(path: &Path, clip: ClipRect, stride: usize) -> Self {
        let &Path { major, minor, .. } = path;
        let (x, y, forward, sideways) =
            if path.steep { (minor, major, stride, 1) } else { (major, minor, 1, stride) };
        let (column, row) = (x.abs_diff(clip.x0) as usize, y.abs_diff(clip.y0) as usize);
        let diagonal = if path.sideways < 0 {
            forward.wrapping_sub(sideways)
        } else {
            forward.wrapping_add(sideways)
        };
        Self { index: row.wrapping_mul(stride).wrapping_add(column), forward, diagonal }
    }
}

impl Place for Cell {
    #[inline(always)]
    fn forward(&mut self) {
        self.index = self.index.wrapping_add(self.forward);
    }

    #[inline(always)]
    fn diagonal(&mut self) {
        self.index = self.index.wrapping_add(self.diagonal);
    }
}
