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
//! The low 32 bits are an accumulator whose carry is the step sideways: an addition with carry on a PC, and no comparison.
//! Lines are drawn from the top down. Where that is backwards, `q` rounds halves the other way, so
//! `floor((2 m i + n - 1) / (2 n))` is wanted: the same with `2^31 / n` less.
//!
//! # Runs
//!
//! A long line that isn't steep is drawn row by row. Row `k` begins at the smallest `i` with `q(i) = k`:
//!
//! ```text
//! i(k) = ceil(n (2 k - 1) / (2 m))    0 < k <= m;      i(0) = 0,  i(m + 1) = n + 1
//!      = (2^20 - 1 + floor(s / 2) + (k - 1) s) >> 20,      s = floor(n 2^20 / m)
//! ```
//!
//! **Proof.** `n (2 k - 1) / (2 m)` is a multiple of `1 / (2 m)`, and the sum without `2^20 - 1` lacks at most `k` units of
//! `2^-20` of it. What is whole stays so as `k < 2^20`; what isn't is above a whole number by `1 / (2 m)` or more, and still
//! by a unit or more without those `k`, as `2 m (m + 1) <= 2^20` for `m <= 700`.
//!
//! So all rows but the first and the last have `floor(n / m)` pixels or one more, by the carry of an accumulator. Two stores of
//! `W` neighbours, which may overlap, draw a row of `W` to `2 W` pixels.
//!
//! Hardware and lines that need clipping use the error term instead.

use core::hint::black_box;

use super::{ClipRect, LineEnd, walk_cells};

/// Lines with fewer steps aren't worth the set-up of runs.
const WORTH_RUNS: u32 = 24;

/// Stores `value` in every cell of the line from `a` to `b` inside `clip`, in the buffer of
/// [`walk_cells`]: `cells[(y - clip.y0) * stride + (x - clip.x0)]`. Cells beyond the buffer's end
/// are left out. Depth and colour of the ends aren't used.
///
/// Cost: one 32-bit division a line. On x86-64, two bytes a cell: about 75 instructions a line and 6 to 7 a pixel, fewer in a
/// long line that is far from 45 degrees.
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
    let drawn = Field::new(stride, clip).is_some_and(|f| f.fill(cells, place(a), place(b), value));
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

/// A buffer small enough for the fast path: every index of a line fits 31 bits.
#[derive(Clone, Copy)]
pub struct Field {
    stride: u32,
    width: u32,
    height: u32,
}

impl Field {
    /// The buffer of [`walk_cells`].
    #[inline(always)]
    pub fn new(stride: usize, clip: ClipRect) -> Option<Self> {
        let (width, height) = (clip.x1.wrapping_sub(clip.x0), clip.y1.wrapping_sub(clip.y0));
        let fits = clip.x0 < clip.x1
            && clip.y0 < clip.y1
            && stride.wrapping_sub(1) < 1 << 16
            && (width | height) as u32 <= 1 << 14;
        fits.then_some(Self { stride: stride as u32, width: width as u32, height: height as u32 })
    }

    /// [`fill_cells`] for ends as column and row; false, and nothing is drawn, where an end is outside or the line is long.
    #[inline(always)]
    pub fn fill<T: Copy>(self, cells: &mut [T], a: [u32; 2], b: [u32; 2], value: T) -> bool {
        let Self { stride, width, height } = self;
        if a[0] >= width || b[0] >= width || a[1] >= height || b[1] >= height {
            return false;
        }
        // From the top down.
        let (a, b) = if b[1] < a[1] { (b, a) } else { (a, b) };
        let dy = b[1] - a[1];
        let right = b[0].wrapping_sub(a[0]) as i32;
        let dx = right.unsigned_abs();
        let index = a[1] * stride + a[0];
        if dy > dx {
            if dy > LONGEST {
                return false;
            }
            let slope = u32::MAX / dy * dx;
            // To the left the index is the whole part of a number that shrinks from just below the next whole one.
            let back = i64::from(right >> 31) as u64;
            let at = u64::from(index) << 32 | u64::from(HALF ^ back as u32);
            let step = (u64::from(stride) << 32)
                .wrapping_add((u64::from(slope) ^ back).wrapping_sub(back));
            fill_steep(cells, at, step, dy + 1, value);
        } else if (WORTH_RUNS..4096).contains(&dx)
            && dy * 4 <= dx * 3
            && dy <= MOST_RUNS
            && ((b[1] * stride + b[0].max(a[0])) as usize) < cells.len()
        {
            let (index, across) = if right < 0 {
                (b[1] * stride + b[0], stride.wrapping_neg())
            } else {
                (index, stride)
            };
            fill_runs(cells, index, across, dx, dy, value);
        } else if dx > LONGEST {
            return false;
        } else {
            let inverse = u32::MAX / dx.max(1);
            let slope = inverse * dy;
            let (at, across) = (index, stride);
            if right < 0 {
                let fraction = HALF - inverse / 2;
                let trace = Trace { at, across, fraction, slope, value };
                trace.draw::<true>(cells, dx + 1);
            } else {
                let trace = Trace { at, across, fraction: HALF, slope, value };
                trace.draw::<false>(cells, dx + 1);
            }
        }
        true
    }
}

/// The largest `n` of this path.
const LONGEST: u32 = 1024;

/// `2^31 + d`
const HALF: u32 = (1 << 31) + (1 << 20);

/// A steep line: the index and its fraction in one number, which never falls, so that beyond the end is the end.
#[inline(never)]
fn fill_steep<T: Copy>(cells: &mut [T], mut at: u64, step: u64, count: u32, value: T) {
    let mut pixel = |at: u64| cells.get_mut((at >> 32) as usize).map(|cell| *cell = value);
    for _ in 0..count / 4 {
        let [second, third, fourth] = [1, 2, 3].map(|i| at.wrapping_add(step.wrapping_mul(i)));
        if pixel(at).is_none()
            || pixel(second).is_none()
            || pixel(third).is_none()
            || pixel(fourth).is_none()
        {
            return;
        }
        at = at.wrapping_add(step.wrapping_mul(4));
    }
    if count & 2 != 0 {
        let second = at.wrapping_add(step);
        if pixel(at).is_none() || pixel(second).is_none() {
            return;
        }
        at = second.wrapping_add(step);
    }
    if count & 1 != 0 {
        let _ = pixel(at);
    }
}

/// A line that isn't steep from the top down, pixel by pixel.
struct Trace<T> {
    at: u32,
    /// What a carry adds.
    across: u32,
    fraction: u32,
    slope: u32,
    value: T,
}

impl<T: Copy> Trace<T> {
    /// Draws `count` pixels. The index of each is never below that of the one before, or, with `LEFT`, never more
    /// than one below it.
    #[inline(always)]
    fn draw<const LEFT: bool>(mut self, cells: &mut [T], count: u32) {
        let mut fours = count / 4;
        while fours > 0 {
            // Without this the compiler would add multiples of the slope to one fraction, and lose the carries.
            self.slope = black_box(self.slope);
            if !self.block::<4, LEFT>(cells) {
                return self.rest::<LEFT>(cells, fours * 4 + count % 4);
            }
            fours -= 1;
        }
        if count & 2 != 0 && !self.block::<2, LEFT>(cells) {
            return self.rest::<LEFT>(cells, count & 3);
        }
        if count & 1 != 0
            && let Some(cell) = cells.get_mut(self.at as usize)
        {
            *cell = self.value;
        }
    }

    /// The next `N` pixels if they are well inside the buffer. One test for all, of the last: the compiler can prove the
    /// others from it.
    #[inline(always)]
    fn block<const N: usize, const LEFT: bool>(&mut self, cells: &mut [T]) -> bool {
        // Steps to the left are 0 or `across`, some columns to the right of where they should be.
        let column = |j: usize| if LEFT { N - 1 - j } else { 0 };
        let mut fraction = self.fraction;
        let mut at = self.at.wrapping_sub(column(0) as u32) as usize;
        let mut places = [0; N];
        for place in &mut places {
            *place = at;
            let (sum, carry) = fraction.overflowing_add(self.slope);
            fraction = sum;
            at += usize::from(!LEFT) + if carry { self.across as usize } else { 0 };
        }
        if places[N - 1] + column(0) >= cells.len() {
            return false;
        }
        for j in (0..N).rev() {
            cells[places[j] + column(j)] = self.value;
        }
        self.fraction = fraction;
        self.at = (at as u32).wrapping_sub(if LEFT { 1 } else { 0 });
        true
    }

    /// `count` pixels near the ends of the buffer.
    #[cold]
    #[inline(never)]
    fn rest<const LEFT: bool>(self, cells: &mut [T], count: u32) {
        let Self { mut at, across, mut fraction, slope, value } = self;
        for _ in 0..count {
            if let Some(cell) = cells.get_mut(at as usize) {
                *cell = value;
            }
            let (sum, carry) = fraction.overflowing_add(slope);
            fraction = sum;
            let step = if LEFT { u32::MAX } else { 1 };
            at = at.wrapping_add(step).wrapping_add(if carry { across } else { 0 });
        }
    }
}

/// The largest `m` for which 20 fraction bits suffice.
const MOST_RUNS: u32 = 700;

/// A line that isn't steep, row by row; all its cells are in the buffer and their indices fit 32 bits.
#[inline(never)]
fn fill_runs<T: Copy>(cells: &mut [T], index: u32, across: u32, n: u32, m: u32, value: T) {
    let mut fill = |from: u32, to: u32| {
        if let Some(cells) = cells.get_mut(from as usize..to as usize) {
            cells.fill(value);
        }
    };
    if m == 0 {
        return fill(index, index + n + 1);
    }
    let slope = (n << 20) / m;
    let first = (slope / 2 + ((1 << 20) - 1)) >> 20;
    fill(index, index + first);
    let run = Run {
        at: index.wrapping_add(first).wrapping_add(across),
        across,
        length: slope >> 20,
        fraction: (slope / 2 + ((1 << 20) - 1)) << 12,
        slope: slope << 12,
        count: m - 1,
    };
    let at = match run.length {
        1 => run.fill::<T, 1>(cells, value),
        2..4 => run.fill::<T, 2>(cells, value),
        4..8 => run.fill::<T, 4>(cells, value),
        8..16 => run.fill::<T, 8>(cells, value),
        _ => run.fill_long(cells, value),
    };
    let end = index.wrapping_add(n + 1).wrapping_add(across.wrapping_mul(m));
    if let Some(cells) = cells.get_mut(at as usize..end as usize) {
        cells.fill(value);
    }
}

/// The rows between the first and the last.
struct Run {
    at: u32,
    across: u32,
    length: u32,
    fraction: u32,
    slope: u32,
    count: u32,
}

impl Run {
    /// Rows of `W` to `2 W` cells. Where the last begins.
    #[inline(always)]
    fn fill<T: Copy, const W: usize>(self, cells: &mut [T], value: T) -> u32 {
        let Run { mut at, across, length, mut fraction, slope, count } = self;
        let apart = (length as usize).wrapping_sub(W) as u32;
        let onwards = across.wrapping_add(W as u32);
        for _ in 0..count {
            let (sum, carry) = fraction.overflowing_add(slope);
            fraction = sum;
            let first = at as usize;
            let second = first + apart as usize + usize::from(carry);
            // The later one first: it proves to the compiler that the other one is inside too.
            for from in [second, first] {
                let Some(cells) = cells.get_mut(from..from + W) else { return at };
                cells.fill(value);
            }
            at = (second as u32).wrapping_add(onwards);
        }
        at
    }

    #[inline(always)]
    fn fill_long<T: Copy>(self, cells: &mut [T], value: T) -> u32 {
        let Run { mut at, across, length, mut fraction, slope, count } = self;
        for _ in 0..count {
            let (sum, carry) = fraction.overflowing_add(slope);
            fraction = sum;
            let end = at as usize + length as usize + usize::from(carry);
            if let Some(cells) = cells.get_mut(at as usize..end) {
                cells.fill(value);
            }
            at = (end as u32).wrapping_add(across);
        }
        at
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
    fn runs_begin_where_they_should() {
        for n in (1..4096u32).step_by(41).chain([4095]) {
            for m in (1..=MOST_RUNS.min(n)).step_by(17).chain([MOST_RUNS.min(n)]) {
                let slope = u64::from((n << 20) / m);
                for k in 1..=u64::from(m) {
                    let begin = ((1 << 20) - 1 + slope / 2 + (k - 1) * slope) >> 20;
                    assert_eq!(begin, (u64::from(n) * (2 * k - 1)).div_ceil(2 * u64::from(m)));
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
