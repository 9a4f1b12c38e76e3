//! Smooth (anti-aliased) lines, one pixel wide.
//!
//! Takes two ends in sixteenths of a pixel; reports, for each column of the major axis, the two
//! pixels that the line's centre lies between, weighted by nearness. Source: X. Wu, "An efficient
//! antialiasing technique", SIGGRAPH 1991, with sub-pixel ends; here in closed form, so that a
//! clipped, banded or reversed line has the same weights.
//!
//! # Which pixels
//!
//! The major axis is x when `|dx| >= |dy|`, else y; the ends are put in order of increasing major
//! coordinate, so a line equals its reverse. Let `(M0, m0)`, `(M1, m1)` be the ends in sixteenths
//! (Q28.4), `D = M1 - M0`, `d = m1 - m0`. Column `c` has its centre at `16 c + 8`, which is
//! `u = 16 c + 8 - M0` sixteenths after the start. There the line lies, in 1/256 of a pixel after
//! the centre of row 0, rounded to nearest,
//!
//! ```text
//! P(c) = 16 (m0 - 8) + floor((32 d u + D) / (2 D))           (d u = 0 when D = 0)
//! row  = P >> 8,  f = P & 255
//! ```
//!
//! and pixel `row` has weight `255 - f`, pixel `row + 1` weight `f`.
//!
//! ```text
//!   row      -- o ------ o --   pixel centres: 255 - f
//!                  ..--'
//!            ..--'' line        f = distance below the centre of `row`
//!   row + 1  -- o ------ o --   f
//! ```
//!
//! # Ends
//!
//! The line reaches half a pixel beyond both ends along the major axis (square caps), so that an
//! end at a pixel's centre covers that whole pixel and an axis-parallel line through pixel centres
//! is Bresenham's, at full weight. A column that the line `[M0 - 8, M1 + 8)` covers for only `e` of
//! its sixteen sixteenths has
//!
//! ```text
//! total = (255 e + 8) >> 4
//! weight(row + 1) = (f e + 8) >> 4,   weight(row) = total - weight(row + 1)
//! ```
//!
//! # Weights
//!
//! U8.0, 255 = opaque. The two weights of a column add up to 255 exactly, in an end column to
//! `total`. Pixels of weight 0 aren't reported.
//!
//! # Colour and depth
//!
//! As along a Bresenham line (`line::ramp`) with sixteenths for steps: `n = D`, `i = u` limited to
//! `0..=D`. Both pixels of a column have the same.
//!
//! # Limits
//!
//! Coordinates within `±2^25` pixels (the guard band); one beyond is taken as the nearest valid
//! one. Nothing here panics. Weights are linear; the caller blends, in order. Cost: ten 64-bit
//! divisions a line and a few for each bit of its length in columns when rows clip it; additions
//! only in each column.

use super::line::ramp::{LongRamp, Ramp};
use super::line::{ClipRect, LineEnd};

/// The largest magnitude of a coordinate, Q28.4: 2^25 pixels.
pub const MAX_SMOOTH_COORDINATE: i32 = 1 << 29;

/// One end of a smooth line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SmoothEnd {
    /// Right of the frame's left edge, Q28.4 pixels; the centre of pixel 0 is at 8. Within
    /// [`MAX_SMOOTH_COORDINATE`].
    pub x: i32,
    /// Down from the frame's top edge, Q28.4 pixels, likewise.
    pub y: i32,
    /// Depth, U16.16, `0..=65535.0`; a larger one is taken as 65535.0.
    pub z: u32,
    /// Red, green, blue; U8.0 each.
    pub rgb: [u8; 3],
}

/// Walks the smooth line from `a` to `b`: `plot(x, y, depth, colour, weight)` for each pixel inside
/// `clip` with a weight above 0, in order of increasing major coordinate, at most two a column. The
/// same calls result from `b` to `a`.
pub fn walk_smooth(
    a: &SmoothEnd,
    b: &SmoothEnd,
    clip: ClipRect,
    mut plot: impl FnMut(i32, i32, u16, [u8; 3], u8),
) {
    let line = SmoothLine::new(a, b);
    let (columns, rows) = if line.steep {
        ((clip.y0, clip.y1), (clip.x0, clip.x1))
    } else {
        ((clip.x0, clip.x1), (clip.y0, clip.y1))
    };
    let Some((first, last)) = line.visible(columns, rows) else { return };
    let (p, remainder) = line.position(first);
    let (mut p, mut remainder) = (p, remainder);
    // 512 d = p_step * 2 D + remainder_step: what one column adds.
    let run = 2 * line.length.max(1);
    let (p_step, remainder_step) = ((512 * line.d).div_euclid(run), (512 * line.d).rem_euclid(run));
    let mut u = line.along(first);
    let mut ramp = LongRamp::<true, true>::new(&line.start, &line.end, line.length as u32, u);
    let mut column = first;
    loop {
        let covered = line.covered(column);
        let (row, f) = ((p >> 8) as i32, (p & 255) as u32);
        let below = (f * covered + 8) >> 4;
        let above = ((255 * covered + 8) >> 4) - below;
        let (z, rgb) = (ramp.depth(), ramp.rgb());
        for (row, weight) in [(row, above), (row + 1, below)] {
            if weight != 0 && row >= rows.0 && row < rows.1 {
                let (x, y) = if line.steep { (row, column) } else { (column, row) };
                plot(x, y, z, rgb, weight as u8);
            }
        }
        if column == last {
            return;
        }
        column += 1;
        p += p_step;
        remainder += remainder_step;
        if remainder >= run {
            remainder -= run;
            p += 1;
        }
        let next = line.along(column);
        ramp.advance_by(next - u);
        u = next;
    }
}

/// A line in canonical form; coordinates in sixteenths.
struct SmoothLine {
    steep: bool,
    /// Only depth and colour are used of these.
    start: LineEnd,
    end: LineEnd,
    /// `M0`.
    major: i64,
    /// `m0`.
    minor: i64,
    /// `D`, `0..=2^30`.
    length: i64,
    /// `d`, `-D..=D`.
    d: i64,
}

impl SmoothLine {
    fn new(a: &SmoothEnd, b: &SmoothEnd) -> Self {
        let limit = |v: i32| i64::from(v.clamp(-MAX_SMOOTH_COORDINATE, MAX_SMOOTH_COORDINATE));
        let split =
            |e: &SmoothEnd| ((limit(e.x), limit(e.y)), LineEnd { x: 0, y: 0, z: e.z, rgb: e.rgb });
        let ((mut from, mut start), (mut to, mut end)) = (split(a), split(b));
        let steep = from.1.abs_diff(to.1) > from.0.abs_diff(to.0);
        if steep {
            (from, to) = ((from.1, from.0), (to.1, to.0));
        }
        if from.0 > to.0 || (from == to && (start.z, start.rgb) > (end.z, end.rgb)) {
            (from, start, to, end) = (to, end, from, start);
        }
        let (length, d) = (to.0 - from.0, to.1 - from.1);
        Self { steep, start, end, major: from.0, minor: from.1, length, d }
    }

    /// Sixteenths from the start to the centre of `column`.
    fn u(&self, column: i32) -> i64 {
        16 * i64::from(column) + 8 - self.major
    }

    /// `u` limited to the line: where its attributes are taken.
    fn along(&self, column: i32) -> u32 {
        self.u(column).clamp(0, self.length) as u32
    }

    /// `P(column)` and the remainder of its division, `0..2 D`.
    ///
    /// `d u` takes 61 bits, so it is divided before it is scaled:
    /// `floor((32 d u + D) / 2 D) = 16 (d u div D) + floor((32 (d u mod D) + D) / 2 D)`.
    fn position(&self, column: i32) -> (i64, i64) {
        let length = self.length.max(1);
        let slope = self.d * self.u(column);
        let rest = 32 * slope.rem_euclid(length) + length;
        let p = 16 * (self.minor - 8 + slope.div_euclid(length)) + rest / (2 * length);
        (p, rest % (2 * length))
    }

    /// Sixteenths of `column` that the line covers along its major axis, `0..=16`.
    fn covered(&self, column: i32) -> u32 {
        let left = 16 * i64::from(column);
        let from = (self.major - 8).max(left);
        let to = (self.major + self.length + 8).min(left + 16);
        (to - from).clamp(0, 16) as u32
    }

    /// The first and last column with a pixel inside columns `columns` and rows `rows`.
    fn visible(&self, columns: (i32, i32), rows: (i32, i32)) -> Option<(i32, i32)> {
        let first = ((self.major - 8) >> 4).max(i64::from(columns.0));
        let last = ((self.major + self.length + 7) >> 4).min(i64::from(columns.1) - 1);
        if first > last || rows.0 >= rows.1 {
            return None;
        }
        // `row` of a column with something inside: rows.0 - 1 <= row < rows.1. As P is monotonic,
        // those columns are one interval; bisection finds its ends without wider arithmetic.
        let (low, high) = (256 * (i64::from(rows.0) - 1), 256 * i64::from(rows.1));
        let count = |before: &dyn Fn(i64) -> bool| {
            let (mut from, mut to) = (first, last + 1);
            while from < to {
                let middle = from + (to - from) / 2;
                if before(self.position(middle as i32).0) {
                    from = middle + 1;
                } else {
                    to = middle;
                }
            }
            from
        };
        let inside = |c: i64| (low..high).contains(&self.position(c as i32).0);
        let (from, to) = match (inside(first) && inside(last), self.d >= 0) {
            (true, _) => (first, last + 1),
            (false, true) => (count(&|p| p < low), count(&|p| p < high)),
            (false, false) => (count(&|p| p >= high), count(&|p| p >= low)),
        };
        if from < to { Some((from as i32, to as i32 - 1)) } else { None }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::{string::String, vec::Vec};

    type Plotted = (i32, i32, u16, [u8; 3], u8);
    const EVERYWHERE: ClipRect =
        ClipRect { x0: i32::MIN, y0: i32::MIN, x1: i32::MAX, y1: i32::MAX };

    fn end(x: i32, y: i32) -> SmoothEnd {
        SmoothEnd { x, y, ..SmoothEnd::default() }
    }

    fn pixels(a: &SmoothEnd, b: &SmoothEnd, clip: ClipRect) -> Vec<Plotted> {
        let mut out = Vec::new();
        walk_smooth(a, b, clip, |x, y, z, rgb, weight| out.push((x, y, z, rgb, weight)));
        out
    }

    /// Weights as hexadecimal digits (weight / 16), '.' for none.
    fn picture(a: (i32, i32), b: (i32, i32), width: usize, height: usize) -> String {
        let mut cells = std::vec![b'.'; width * height];
        let clip = ClipRect { x0: 0, y0: 0, x1: width as i32, y1: height as i32 };
        walk_smooth(&end(a.0, a.1), &end(b.0, b.1), clip, |x, y, _, _, weight| {
            let cell = &mut cells[y as usize * width + x as usize];
            assert_eq!(*cell, b'.', "a pixel drawn twice at {x}, {y}");
            *cell = b"0123456789abcdef"[usize::from(weight >> 4)];
        });
        cells.chunks(width).map(|r| std::str::from_utf8(r).unwrap()).collect::<Vec<_>>().join(" ")
    }

    struct Random(u64);

    impl Random {
        fn below(&mut self, n: u32) -> i32 {
            self.0 ^= self.0 >> 12;
            self.0 ^= self.0 << 25;
            self.0 ^= self.0 >> 27;
            ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % u64::from(n)) as i32
        }

        fn end(&mut self, size: u32) -> SmoothEnd {
            let half = size as i32 / 2;
            SmoothEnd {
                x: self.below(size) - half,
                y: self.below(size) - half,
                z: (self.below(0xffff) as u32) << 16 | self.below(0x10000) as u32,
                rgb: [0; 3].map(|_: u8| self.below(256) as u8),
            }
        }
    }

    #[test]
    fn pictures() {
        // Through pixel centres along an axis or a diagonal: Bresenham's pixels, opaque.
        assert_eq!(picture((24, 24), (56, 24), 5, 3), "..... .fff. .....");
        assert_eq!(picture((8, 8), (40, 40), 3, 3), "f.. .f. ..f");
        assert_eq!(picture((24, 24), (24, 24), 3, 3), "... .f. ...");
        // Half way between two rows; then ends a quarter of a pixel after and before a centre.
        assert_eq!(picture((8, 16), (40, 16), 3, 2), "777 888");
        assert_eq!(picture((12, 8), (36, 8), 4, 1), "bfb.");
        assert_eq!(picture((8, 8), (72, 40), 5, 3), "f7... .8f7. ...8f");
        assert_eq!(picture((8, 8), (24, 72), 2, 5), "f. b4 78 3c .f");
    }

    #[test]
    fn weights_add_up_and_ends_are_partial() {
        let mut random = Random(1);
        for _ in 0..5_000 {
            let (a, b) = (random.end(2000), random.end(2000));
            let line = pixels(&a, &b, EVERYWHERE);
            assert_eq!(line, pixels(&b, &a, EVERYWHERE));
            let steep = a.y.abs_diff(b.y) > a.x.abs_diff(b.x);
            let major = |p: &Plotted| if steep { p.1 } else { p.0 };
            let (from, to) = if steep { (a.y, b.y) } else { (a.x, b.x) };
            let (from, to) = (from.min(to) - 8, from.max(to) + 8);
            for column in line.chunk_by(|p, q| major(p) == major(q)) {
                let c = major(&column[0]);
                let covered = to.min(16 * c + 16) - from.max(16 * c);
                let sum: u32 = column.iter().map(|p| u32::from(p.4)).sum();
                assert_eq!(sum as i32, (255 * covered + 8) >> 4);
                assert!(column.len() <= 2);
            }
        }
    }

    #[test]
    fn equals_the_closed_form_inside_any_window() {
        let mut random = Random(2);
        for i in 0..6_000 {
            let size = [100, 900, 5000][i % 3];
            let (a, b) = (random.end(size), random.end(size));
            let (p, q) = (random.end(size / 16), random.end(size / 16));
            let clip = ClipRect { x0: p.x, y0: p.y, x1: p.x.max(q.x), y1: p.y.max(q.y) };
            let mut expected = pixels(&a, &b, EVERYWHERE);
            for &(x, y, z, rgb, weight) in &expected {
                // The centre line's distance from this pixel, in i128 and in 1/256 of a pixel.
                let steep = a.y.abs_diff(b.y) > a.x.abs_diff(b.x);
                let turn = |v: (i32, i32)| if steep { (v.1, v.0) } else { v };
                let (from, to, at) = (turn((a.x, a.y)), turn((b.x, b.y)), turn((x, y)));
                let (from, to, start, end) =
                    if from.0 > to.0 { (to, from, b, a) } else { (from, to, a, b) };
                let length = i128::from(to.0 - from.0).max(1);
                let d = i128::from(to.1 - from.1);
                let p = (32
                    * (d * i128::from(16 * at.0 + 8 - from.0) + length * i128::from(from.1 - 8))
                    + length)
                    .div_euclid(2 * length);
                let distance = (p - 256 * i128::from(at.1)) as i32;
                assert!((-256..256).contains(&distance));
                let full = if distance >= 0 { 255 - distance } else { 256 + distance };
                assert!(i32::from(weight) <= full);
                // Colour and depth against the exact rational, as in `line::ramp`.
                let i = i128::from((16 * at.0 + 8 - from.0).clamp(0, to.0 - from.0));
                let exact = |v0: i128, v1: i128| v0 * length + (v1 - v0) * i;
                let error = exact(start.z.into(), end.z.into()) - ((i128::from(z) * length) << 16);
                assert!(error.abs() < (0x8000 + 0x1000) * length);
                for (c, got) in rgb.into_iter().enumerate() {
                    let error = exact(start.rgb[c].into(), end.rgb[c].into());
                    let error = (error - i128::from(got) * length).abs();
                    assert!(256 * error < 129 * length);
                }
                let (low, high) = (from.0 - 8, to.0 + 8);
                if low <= 16 * at.0 && high >= 16 * at.0 + 16 {
                    assert_eq!(i32::from(weight), full);
                }
            }
            expected.retain(|p| clip.contains(p.0, p.1));
            assert_eq!(pixels(&a, &b, clip), expected);
        }
    }

    #[test]
    fn extremes_neither_overflow_nor_panic() {
        let m = MAX_SMOOTH_COORDINATE;
        let values = [i32::MIN, -m, -1, 0, 24, m, i32::MAX];
        let small = ClipRect { x0: 0, y0: 0, x1: 4, y1: 4 };
        let inside_out = ClipRect { x0: i32::MAX, y0: 0, x1: i32::MIN, y1: i32::MAX };
        for i in 0..values.len().pow(4) {
            let v = [0, 1, 2, 3].map(|d| values[i / values.len().pow(d) % values.len()]);
            let a = SmoothEnd { z: u32::MAX, rgb: [255; 3], ..end(v[0], v[1]) };
            let b = end(v[2], v[3]);
            let line = pixels(&a, &b, small);
            assert!(line.len() <= 8 && line.iter().all(|p| small.contains(p.0, p.1)));
            assert_eq!(line, pixels(&b, &a, small));
            assert_eq!(pixels(&a, &b, inside_out), []);
        }
        assert_eq!(pixels(&end(-m, -m), &end(m, m), small).len(), 4);
    }
}
