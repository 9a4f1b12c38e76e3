//! Lines of one value straight into memory: the fast path of a wireframe.
//!
//! The same pixels as [`walk`](super::walk), by another equation. While `n <= 1024`,
//!
//! ```text
//! q(i) = floor((2 m i + n) / (2 n)) = (2^31 + 2^20 + i * slope) >> 32,     slope = m floor((2^32 - 1) / n)
//! ```
//!
//! **Proof.** `(2 m i + n) / (2 n)` is a multiple of `1 / (2 n)`, so its fraction is at most `1 - 1 / (2 n)`. The right
//! side's argument is the same number plus an excess of `(2^20 - i e) / 2^32`, where `e = m 2^32 / n - slope` is within
//! `0..=m`. As `i m <= 2^20` the excess is not negative, and it is below `1 / (2 n)` as `2^20 2 n <= 2^31`; so it never
//! reaches the next whole number. The slope of `m = n` fits 32 bits too.
//!
//! So a pixel costs an addition, a shift and a store, in a line that isn't steep a multiplication too, and no comparison.
//! Lines are drawn from the top down. Where that is backwards, `q` rounds halves the other way, so
//! `floor((2 m i + n - 1) / (2 n))` is wanted: the same with `2^31 / n` less.
//!
//! Every pixel lies in the box of both ends, so that one test, of the box's last cell, serves all of a line.
//!
//! Hardware and lines that need clipping use the error term instead.

// Stores without a test for each, see `Cells`; without the feature `simd` each is tested.
#![cfg_attr(feature = "simd", allow(unsafe_code))]

use core::hint::black_box;

use super::{ClipRect, LineEnd, walk_cells};

/// Rows of cells that lines of one value are drawn in.
///
/// ```
/// use scanout::raster::line::{ClipRect, Field};
///
/// let mut cells = [b'.'; 8 * 4];
/// let clip = ClipRect { x0: 0, y0: 0, x1: 8, y1: 4 };
/// let mut field = Field::new(&mut cells, 8, clip).unwrap();
/// assert!(field.line([7, 3], [0, 0], b'#'));
/// assert!(!field.line([0, 0], [8, 0], b'#'), "outside");
/// assert_eq!(&cells, b"##........##........##........##");
/// ```
#[derive(Debug)]
pub struct Field<'m, T> {
    cells: &'m mut [T],
    stride: u32,
    width: u32,
    height: u32,
}

impl<'m, T: Copy> Field<'m, T> {
    /// The cells of a rectangle, its rows `stride` apart: `cells[(y - clip.y0) * stride + (x - clip.x0)]`. `None` where they do not
    /// hold it all, where it is empty, wider or higher than 16,384 or `stride` above 65,536.
    #[inline]
    pub fn new(cells: &'m mut [T], stride: usize, clip: ClipRect) -> Option<Self> {
        let (width, height) = (clip.x1.wrapping_sub(clip.x0), clip.y1.wrapping_sub(clip.y0));
        let fits = clip.x0 < clip.x1
            && clip.y0 < clip.y1
            && stride.wrapping_sub(1) < 1 << 16
            && (width | height) as u32 <= 1 << 14;
        if !fits || (height as usize - 1) * stride + width as usize > cells.len() {
            return None;
        }
        Some(Self { cells, stride: stride as u32, width: width as u32, height: height as u32 })
    }

    /// All of the cells.
    pub(crate) fn cells(&mut self) -> &mut [T] {
        self.cells
    }

    /// Draws a line, its ends as column and row; false, and nothing is drawn, where an end is outside or it has more than
    /// 1024 steps.
    #[inline(always)]
    pub fn line(&mut self, a: [u32; 2], b: [u32; 2], value: T) -> bool {
        // From the top down.
        let (a, b) = if b[1] < a[1] { (b, a) } else { (a, b) };
        if a[0].max(b[0]) >= self.width || b[1] >= self.height {
            return false;
        }
        let dy = b[1] - a[1];
        let right = b[0].wrapping_sub(a[0]) as i32;
        let dx = right.unsigned_abs();
        if dx.max(dy) > LONGEST {
            return false;
        }
        let index = a[1] * self.stride + a[0];
        if dy > dx {
            let slope = u32::MAX / dy * dx;
            // To the left the index is the whole part of a number that shrinks from just below the next whole one.
            let back = i64::from(right >> 31) as u64;
            let at = u64::from(index) << 32 | u64::from(HALF ^ back as u32);
            let step = (u64::from(self.stride) << 32)
                .wrapping_add((u64::from(slope) ^ back).wrapping_sub(back));
            self.steep(at, step, dy + 1, value);
            return true;
        }
        let inverse = u32::MAX / dx.max(1);
        let side = if right < 0 { usize::MAX } else { 1 };
        let fraction = if right < 0 { HALF - inverse / 2 } else { HALF };
        let down = side.wrapping_add(self.stride as usize);
        self.flat(index as usize, [side, down], [fraction, inverse * dy], dx + 1, value);
        true
    }

    /// Stores a value.
    #[inline(always)]
    fn put(&mut self, at: usize, value: T) {
        debug_assert!(at < self.cells.len());
        #[cfg(feature = "simd")]
        // SAFETY: `line` draws only lines with both ends inside the rectangle, which `new` has found inside the slice, and a line stays in
        // the box of its ends: by the proof above every step sideways, of `0..=n`, is within `0..=m`.
        unsafe {
            *self.cells.get_unchecked_mut(at) = value;
        }
        #[cfg(not(feature = "simd"))]
        if let Some(cell) = self.cells.get_mut(at) {
            *cell = value;
        }
    }

    /// A steep line: the index and its fraction are one number.
    #[inline(always)]
    fn steep(&mut self, mut at: u64, step: u64, count: u32, value: T) {
        let mut next = || {
            self.put((at >> 32) as usize, value);
            at = at.wrapping_add(step);
        };
        for _ in 0..count / 4 {
            next();
            next();
            next();
            next();
        }
        for _ in 0..count % 4 {
            next();
        }
    }

    /// A line that isn't steep: from cell to cell is `side`, with a step down `down`, by the carries of a fraction.
    #[inline(always)]
    fn flat(
        &mut self,
        mut at: usize,
        [side, down]: [usize; 2],
        [mut fraction, mut slope]: [u32; 2],
        count: u32,
        value: T,
    ) {
        let mut next = |slope: u32| {
            self.put(at, value);
            let (sum, carry) = fraction.overflowing_add(slope);
            fraction = sum;
            at = at.wrapping_add(if carry { down } else { side });
        };
        for _ in 0..count / 4 {
            // Without this the compiler would add multiples of the slope to one fraction, and compare to find the carries.
            slope = black_box(slope);
            next(slope);
            next(slope);
            next(slope);
            next(slope);
        }
        for _ in 0..count % 4 {
            next(slope);
        }
    }
}

/// Stores `value` in every cell of the line from `a` to `b` inside `clip`, in the buffer of
/// [`walk_cells`]: `cells[(y - clip.y0) * stride + (x - clip.x0)]`. Cells beyond the buffer's end
/// are left out. Depth and colour of the ends aren't used.
///
/// Cost: one 32-bit division a line; for many lines use [`Field`].
#[inline]
pub fn fill_cells<T: Copy>(
    cells: &mut [T],
    stride: usize,
    clip: ClipRect,
    a: &LineEnd,
    b: &LineEnd,
    value: T,
) {
    let place = |e: &LineEnd| [e.x.wrapping_sub(clip.x0) as u32, e.y.wrapping_sub(clip.y0) as u32];
    let drawn =
        Field::new(cells, stride, clip).is_some_and(|mut f| f.line(place(a), place(b), value));
    if !drawn {
        fill_any(cells, stride, clip, a, b, value);
    }
}

/// [`fill_cells`] of any line.
#[cold]
#[inline(never)]
fn fill_any<T: Copy>(
    cells: &mut [T],
    stride: usize,
    clip: ClipRect,
    a: &LineEnd,
    b: &LineEnd,
    value: T,
) {
    walk_cells::<false, false>(a, b, clip, stride, |index, _, _| {
        if let Some(cell) = cells.get_mut(index) {
            *cell = value;
        }
    });
}

/// The largest `n` of this path.
pub(crate) const LONGEST: u32 = 1024;

/// `2^31 + d`
pub(crate) const HALF: u32 = (1 << 31) + (1 << 20);

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::{vec, vec::Vec};

    const STRIDE: usize = 4100;
    const CLIP: ClipRect = ClipRect { x0: -3, y0: 5, x1: 4097, y1: 205 };

    fn end(x: i32, y: i32) -> LineEnd {
        LineEnd { x: CLIP.x0 + x, y: CLIP.y0 + y, ..LineEnd::default() }
    }

    /// The cells of a line by both equations; the buffer is clean again afterwards.
    fn check(cells: &mut [u8], a: LineEnd, b: LineEnd) {
        let mut walked = Vec::new();
        walk_cells::<false, false>(&a, &b, CLIP, STRIDE, |index, _, _| walked.push(index));
        fill_cells(cells, STRIDE, CLIP, &a, &b, 1);
        for &index in &walked {
            assert_eq!(cells[index], 1, "{a:?} {b:?}");
            cells[index] = 0;
        }
        // Nothing else: the neighbours that a wrong step would have hit.
        for &index in &walked {
            for near in [1, STRIDE - 1, STRIDE, STRIDE + 1] {
                let (after, before) = (index + near, index.wrapping_sub(near));
                assert!(cells.get(after).is_none_or(|&c| c == 0), "{a:?} {b:?}");
                assert!(cells.get(before).is_none_or(|&c| c == 0), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn equals_the_walk() {
        let mut cells = vec![0; STRIDE * 200];
        // Every slope of every length to 60, in all directions.
        for dx in -60..=60 {
            for dy in -60..=60 {
                check(&mut cells, end(70, 70), end(70 + dx, 70 + dy));
            }
        }
        // The longest lines; the first doesn't fit the fast path.
        for n in [4097, 4096, 4095, 4093, 3001] {
            for dy in (-99..=99).step_by(6) {
                check(&mut cells, end(0, 100), end(n, 100 + dy));
            }
        }
        // Clipped.
        for dy in -40..=40 {
            check(&mut cells, end(-20, 10), end(80, 10 + dy));
        }
        assert!(cells.iter().all(|&c| c == 0));
    }

    /// Every line in a small field that fills its buffer, and some in a larger one.
    #[test]
    fn equals_the_walk_at_the_ends_of_the_buffer() {
        for (width, height, skip) in [(9, 7, 1), (61, 47, 211)] {
            let clip = ClipRect { x0: 5, y0: -2, x1: 5 + width, y1: -2 + height };
            let end = |i: i32| LineEnd {
                x: clip.x0 + i % width,
                y: clip.y0 + i / width,
                ..LineEnd::default()
            };
            let (count, stride) = (width * height, width as usize);
            // Whole, and with its last cells missing.
            for length in [count as usize, count as usize - 4] {
                for i in (0..count * count).step_by(skip) {
                    let (a, b) = (end(i / count), end(i % count));
                    let (mut walked, mut filled) = (vec![0; length], vec![0; length]);
                    walk_cells::<false, false>(&a, &b, clip, stride, |index, _, _| {
                        if let Some(cell) = walked.get_mut(index) {
                            *cell = 1u8;
                        }
                    });
                    fill_cells(&mut filled, stride, clip, &a, &b, 1);
                    assert_eq!(walked, filled, "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn the_slope_gives_every_step() {
        for n in (1..=1024u32).step_by(31).chain([1, 2, 3, 4, 1021, 1023, 1024]) {
            for m in (0..=n).step_by(13).chain([n]) {
                let inverse = u32::MAX / n;
                let slope = u64::from(inverse * m);
                for i in 0..=n {
                    let q = |half: u32| (u64::from(half) + u64::from(i) * slope) >> 32;
                    assert_eq!(q(HALF), u64::from((2 * m * i + n) / (2 * n)));
                    assert_eq!(q(HALF - inverse / 2), u64::from((2 * m * i + n - 1) / (2 * n)));
                }
            }
        }
    }

    #[test]
    fn a_short_buffer_is_no_panic() {
        let mut cells = [0; 10];
        fill_cells(&mut cells, STRIDE, CLIP, &end(2, 0), &end(40, 30), 7);
        assert_eq!(cells, [0, 0, 7, 0, 0, 0, 0, 0, 0, 0]);
        fill_cells(&mut cells, 0, CLIP, &end(2, 0), &end(40, 30), 7);
        fill_cells(&mut cells, usize::MAX, CLIP, &end(2, 9), &end(40, 150), 7);
        fill_cells::<u8>(&mut [], STRIDE, CLIP, &end(2, 9), &end(2, 9), 7);
    }
}
