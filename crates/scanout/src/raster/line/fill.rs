//! Lines of one value straight into memory: the fast path of a wireframe.
//!
//! The same pixels as [`walk`](super::walk), by another equation. While `n <= 4096`,
//!
//! ```text
//! q(i) = floor((2 m i + n) / (2 n)) = (2^31 + i * slope) >> 32,     slope = ceil(m 2^32 / n)
//! ```
//!
//! **Proof.** `(2 m i + n) / (2 n)` is a multiple of `1 / (2 n)`, so its fraction is at most
//! `1 - 1 / (2 n)`. The right side's argument is the same number plus an excess below
//! `i / 2^32 <= n / 2^32`, which is below `1 / (2 n)` as `2 n^2 <= 2^25 < 2^32`; so the excess
//! never reaches the next whole number.
//!
//! The low 32 bits are an accumulator whose carry is the step sideways: an addition with carry on a
//! PC, and no comparison. Hardware and lines that need clipping use the error term instead.

use super::{Cell, ClipRect, LineEnd, Path, walk_cells};

/// Stores `value` in every cell of the line from `a` to `b` inside `clip`, in the buffer of
/// [`walk_cells`]: `cells[(y - clip.y0) * stride + (x - clip.x0)]`. Cells beyond the buffer's end
/// are left out. Depth and colour of the ends aren't used.
///
/// Cost: two 32-bit divisions a line. On x86-64, one byte a cell: about 125 instructions a line and
/// 6 (steep) to 8 a pixel.
pub fn fill_cells<T: Copy>(
    cells: &mut [T],
    stride: usize,
    clip: ClipRect,
    a: &LineEnd,
    b: &LineEnd,
    value: T,
) {
    let Some(path) = Path::unclipped(a, b, clip) else {
        return walk_cells::<false, false>(a, b, clip, stride, |index, _, _| {
            if let Some(cell) = cells.get_mut(index) {
                *cell = value;
            }
        });
    };
    let Cell { index, forward, diagonal } = Cell::first(&path, clip, stride);
    let (n, m) = (path.n, path.rise as u32 / 2);
    let count = n + 1;
    if m == 0 || m == n {
        // No step or every step is sideways; the slope of the latter doesn't fit 32 bits.
        let stride = if m == 0 { forward } else { diagonal };
        fill(cells, index, count, 0, value, |index, _| index.wrapping_add(stride));
        return;
    }
    // m 2^32 / n in two 32-bit divisions, as m < n <= 2^12.
    let (high, rest) = ((m << 16) / n, (m << 16) % n);
    let slope = (high << 16) + (rest << 16).div_ceil(n);
    match (path.steep, path.sideways > 0) {
        (true, true) => fill(cells, index, count, slope, value, |index, carry| {
            index.wrapping_add(forward).wrapping_add(usize::from(carry))
        }),
        (true, false) => fill(cells, index, count, slope, value, |index, carry| {
            index.wrapping_add(forward).wrapping_sub(usize::from(carry))
        }),
        (false, _) => fill(cells, index, count, slope, value, |index, carry| {
            index.wrapping_add(if carry { diagonal } else { forward })
        }),
    }
}

#[inline(always)]
fn fill<T: Copy>(
    cells: &mut [T],
    mut index: usize,
    count: u32,
    slope: u32,
    value: T,
    next: impl Fn(usize, bool) -> usize,
) {
    let mut fraction = 1u32 << 31;
    let mut pixel = || {
        if let Some(cell) = cells.get_mut(index) {
            *cell = value;
        }
        let (sum, carry) = fraction.overflowing_add(slope);
        fraction = sum;
        index = next(index, carry);
    };
    for _ in 0..count / 4 {
        pixel();
        pixel();
        pixel();
        pixel();
    }
    for _ in 0..count % 4 {
        pixel();
    }
}

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

    #[test]
    fn the_slope_gives_every_step_of_long_lines() {
        for n in [4096u32, 4095, 4093, 2049, 1021] {
            for m in (1..n).step_by(37) {
                let slope = (u64::from(m) << 32).div_ceil(u64::from(n));
                for i in 0..=n {
                    let q = (2 * m * i + n) / (2 * n);
                    assert_eq!(((1 << 31) + u64::from(i) * slope) >> 32, u64::from(q));
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
