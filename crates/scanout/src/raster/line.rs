//! Lines by Bresenham's algorithm, with colour and depth along them.
//!
//! Takes two ends in whole pixels and reports every pixel of the line that lies inside a clip
//! rectangle, in order. Source: J. E. Bresenham, "Algorithm for computer control of a digital
//! plotter", IBM Systems Journal 4(1), 1965; the order of set-up and the colour steps are those of
//! system D (an FPGA line unit: swap the axes of a steep line, swap the ends of one that runs right
//! to left, three 12.20 dividers, rounding at the output).
//!
//! # Which pixels
//!
//! The *major* axis is x when `|dx| >= |dy|`, else y. The ends are put in order of increasing major
//! coordinate, so a line and its reverse are one line. With `n = |d major|` and `m = |d minor|`,
//! pixel `i` of `0..=n` lies at
//!
//! ```text
//! major = major0 + i
//! minor = minor0 + sign(d minor) * q(i)        q(i) = floor((2 m i + n) / (2 n))
//! ```
//!
//! which is the exact line rounded to the nearest pixel, half a pixel going towards the far end
//! (the textbook's "step when 2e >= major"). Both ends are drawn.
//!
//! ```text
//!   i = 0 1 2 3 4 5      n = 5, m = 2
//!       # .               q = 0 0 1 1 2 2
//!           # #
//!               # #
//! ```
//!
//! # Clipping
//!
//! `q` never decreases, so the visible pixels are one interval of `i`. Its ends come from the
//! closed form, exactly (i64); the error term starts there. Clipping never moves a visible pixel.
//!
//! # Colour and depth
//!
//! Linear in `i`; see `line/ramp.rs` for the equation and its proof. Both end colours are exact; a
//! colour is less than `1/2 + 2^-8` of a step from the exact rational, a depth less than
//! `1/2 + 2^-4`.
//!
//! When both ends are one pixel, the nearer end is reported (of equally near ones the darker).
//!
//! # Limits
//!
//! Coordinates are valid within `±2^26` pixels; one beyond is taken as the nearest valid one.
//! Nothing here panics. No line width, no stipple; smooth lines are in `smooth_line`.

mod fill;
mod place;
pub(super) mod ramp;

pub use fill::{Field, fill_cells};
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
pub(crate) use fill::{HALF, LONGEST};

use place::{Cell, Pixel, Place};
use ramp::{LongRamp, Ramp, SHORT, ShortRamp};

/// The largest magnitude of a coordinate, in pixels.
pub const MAX_COORDINATE: i32 = 1 << 26;

/// One end of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LineEnd {
    /// Column in whole pixels, 0 at the left edge of the frame, within [`MAX_COORDINATE`].
    pub x: i32,
    /// Row in whole pixels, 0 at the top edge of the frame, within [`MAX_COORDINATE`].
    pub y: i32,
    /// Depth, U16.16, `0..=65535.0`; a larger one is taken as 65535.0.
    pub z: u32,
    /// Red, green, blue; U8.0 each.
    pub rgb: [u8; 3],
}

/// A rectangle of pixels: columns `x0..x1`, rows `y0..y1` (half-open). Empty when either is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ClipRect {
    /// First column.
    pub x0: i32,
    /// First row.
    pub y0: i32,
    /// One past the last column.
    pub x1: i32,
    /// One past the last row.
    pub y1: i32,
}

impl ClipRect {
    /// Whether pixel (x, y) is inside.
    #[inline(always)]
    #[must_use]
    pub const fn contains(&self, x: i32, y: i32) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }
}

/// Walks the line from `a` to `b`: `plot(x, y, depth, colour)` once for each pixel inside `clip`,
/// in order of increasing major coordinate. The same calls result from `b` to `a`.
///
/// Cost: four 32-bit divisions a line (and none of 64 bits while it has at most 4097 pixels and
/// needs no clipping), then additions and one comparison a pixel.
#[inline]
pub fn walk(a: &LineEnd, b: &LineEnd, clip: ClipRect, plot: impl FnMut(i32, i32, u16, [u8; 3])) {
    walk_with::<true, true>(a, b, clip, plot);
}

/// As [`walk`] for a line of one colour: `plot(x, y, depth)`. One division a line.
#[inline]
pub fn walk_flat(a: &LineEnd, b: &LineEnd, clip: ClipRect, mut plot: impl FnMut(i32, i32, u16)) {
    walk_with::<false, true>(a, b, clip, |x, y, z, _| plot(x, y, z));
}

/// [`walk`] with only the attributes that are needed; the others are reported as 0 and cost
/// nothing. `walk_with::<false, false>` has no division for a line that needs no clipping.
#[inline]
pub fn walk_with<const COLOUR: bool, const DEPTH: bool>(
    a: &LineEnd,
    b: &LineEnd,
    clip: ClipRect,
    mut plot: impl FnMut(i32, i32, u16, [u8; 3]),
) {
    let Some(path) = Path::unclipped(a, b, clip) else {
        return walk_general::<COLOUR, DEPTH, _>(a, b, clip, Pixel::first, |path, p, z, rgb| {
            let (x, y) = if path.steep { (p.minor, p.major) } else { (p.major, p.minor) };
            plot(x, y, z, rgb);
        });
    };
    let ramp = ShortRamp::<COLOUR, DEPTH>::new(path.start, path.end, path.n, 0);
    let at = Pixel::first(&path);
    if path.steep {
        trace(&path, at, ramp, |p, z, rgb| plot(p.minor, p.major, z, rgb));
    } else {
        trace(&path, at, ramp, |p, z, rgb| plot(p.major, p.minor, z, rgb));
    }
}

/// [`walk_with`] that reports where a pixel is stored instead of where it is on the screen:
/// `plot(cell, depth, colour)` with `cell = (y - clip.y0) * stride + (x - clip.x0)`, the index in a
/// buffer whose first cell is the top left pixel of `clip` (a frame, or one band of it). The
/// multiplication happens once a line, not once a pixel. `stride` is in cells, at least the width
/// of `clip`. Cost of `<false, false>` on x86-64, storing one byte: 12 instructions a pixel and
/// about 115 a line.
#[inline]
pub fn walk_cells<const COLOUR: bool, const DEPTH: bool>(
    a: &LineEnd,
    b: &LineEnd,
    clip: ClipRect,
    stride: usize,
    mut plot: impl FnMut(usize, u16, [u8; 3]),
) {
    let first = |path: &Path| Cell::first(path, clip, stride);
    let Some(path) = Path::unclipped(a, b, clip) else {
        return walk_general::<COLOUR, DEPTH, _>(a, b, clip, first, |_, c, z, rgb| {
            plot(c.index, z, rgb);
        });
    };
    let ramp = ShortRamp::<COLOUR, DEPTH>::new(path.start, path.end, path.n, 0);
    trace(&path, first(&path), ramp, |c, z, rgb| plot(c.index, z, rgb));
}

/// The inner loop: report, then step the position and the attributes.
#[inline(always)]
fn trace<P: Place, R: Ramp>(
    path: &Path,
    mut at: P,
    mut ramp: R,
    mut plot: impl FnMut(&P, u16, [u8; 3]),
) {
    let Path { mut error, rise, run, mut steps, .. } = *path;
    let rise_and_wrap = rise - run;
    loop {
        plot(&at, ramp.depth(), ramp.rgb());
        if steps == 0 {
            return;
        }
        steps -= 1;
        // Both outcomes are computed, and one is selected: no branch to mispredict.
        let wrapped = error + rise_and_wrap;
        error += rise;
        if error >= 0 {
            error = wrapped;
            at.diagonal();
        } else {
            at.forward();
        }
        ramp.advance();
    }
}

/// The walk of a line of any length that may need clipping; `first` makes the first position.
#[cold]
#[inline(never)]
fn walk_general<const COLOUR: bool, const DEPTH: bool, P: Place>(
    a: &LineEnd,
    b: &LineEnd,
    clip: ClipRect,
    first: impl FnOnce(&Path) -> P,
    mut plot: impl FnMut(&Path, &P, u16, [u8; 3]),
) {
    let limit = |v: i32| v.clamp(-MAX_COORDINATE, MAX_COORDINATE);
    let clamp = |e: &LineEnd| LineEnd { x: limit(e.x), y: limit(e.y), ..*e };
    let (a, b) = (clamp(a), clamp(b));
    let mut path = Path::new(&a, &b);
    if path.clip(clip).is_none() {
        return;
    }
    let (at, path) = (first(&path), &path);
    let &Path { start, end, n, first: i, .. } = path;
    let report = |p: &P, z, rgb| plot(path, p, z, rgb);
    if n <= SHORT {
        trace(path, at, ShortRamp::<COLOUR, DEPTH>::new(start, end, n, i), report);
    } else {
        trace(path, at, LongRamp::<COLOUR, DEPTH>::new(start, end, n, i), report);
    }
}

/// A line in canonical form (the ends in order of increasing major coordinate), or the visible part
/// of one, ready to walk.
struct Path<'a> {
    /// The end with the smaller major coordinate.
    start: &'a LineEnd,
    end: &'a LineEnd,
    steep: bool,
    /// Steps along the major axis from end to end, `0..=2^27`.
    n: u32,
    /// `i` of the first visible pixel.
    first: u32,
    /// Steps from there to the last visible pixel.
    steps: u32,
    /// Where the first visible pixel is.
    major: i32,
    minor: i32,
    /// +1 or -1: the direction of the minor axis.
    sideways: i32,
    /// `(2 m i + n) mod 2 n - 2 n`, in `-2 n..0`.
    error: i32,
    /// `2 m`.
    rise: i32,
    /// `2 n`.
    run: i32,
}

impl<'a> Path<'a> {
    /// The path of a short line with both ends in `clip`.
    #[inline(always)]
    fn unclipped(a: &'a LineEnd, b: &'a LineEnd, clip: ClipRect) -> Option<Self> {
        if !clip.contains(a.x, a.y) || !clip.contains(b.x, b.y) {
            return None;
        }
        if a.x.abs_diff(b.x) > SHORT || a.y.abs_diff(b.y) > SHORT {
            return None;
        }
        Some(Self::new(a, b))
    }

    /// Both ends' coordinates differ by at most 2^27.
    #[inline(always)]
    fn new(a: &'a LineEnd, b: &'a LineEnd) -> Self {
        let (dx, dy) = (a.x.abs_diff(b.x), a.y.abs_diff(b.y));
        let steep = dy > dx;
        let (n, m, from, to) =
            if steep { (dy, dx, (a.y, a.x), (b.y, b.x)) } else { (dx, dy, (a.x, a.y), (b.x, b.y)) };
        let backwards = from.0 > to.0 || (n == 0 && (a.z, a.rgb) > (b.z, b.rgb));
        let (start, end, (major, minor), far) =
            if backwards { (b, a, to, from.1) } else { (a, b, from, to.1) };
        Self {
            start,
            end,
            steep,
            n,
            first: 0,
            steps: n,
            major,
            minor,
            sideways: if far < minor { -1 } else { 1 },
            error: -(n as i32),
            rise: 2 * m as i32,
            run: 2 * n as i32,
        }
    }

    /// Moves the first and the last pixel into `clip`; `None` when no pixel is inside.
    fn clip(&mut self, clip: ClipRect) -> Option<()> {
        let ClipRect { x0, y0, x1, y1 } = clip;
        let (major, minor) = if self.steep { ((y0, y1), (x0, x1)) } else { ((x0, x1), (y0, y1)) };
        let (n, m) = (i64::from(self.n), i64::from(self.rise / 2));
        let mut first = (i64::from(major.0) - i64::from(self.major)).max(0);
        let mut last = (i64::from(major.1) - 1 - i64::from(self.major)).min(n);
        // The values of q that are inside.
        let origin = i64::from(self.minor);
        let (lowest, highest) = if self.sideways > 0 {
            (i64::from(minor.0) - origin, i64::from(minor.1) - 1 - origin)
        } else {
            (origin - (i64::from(minor.1) - 1), origin - i64::from(minor.0))
        };
        if lowest > m || highest < 0 || highest < lowest {
            return None;
        }
        // q(i) >= lowest  <=>  2 m i >= 2 n lowest - n; here m >= lowest > 0.
        if lowest > 0 {
            first = first.max((2 * n * lowest - n + 2 * m - 1) / (2 * m));
        }
        // q(i) <= highest  <=>  2 m i < 2 n (highest + 1) - n; here m > highest >= 0.
        if highest < m {
            last = last.min((2 * n * (highest + 1) - n - 1) / (2 * m));
        }
        if first > last {
            return None;
        }
        self.first = first as u32;
        self.steps = (last - first) as u32;
        self.major += first as i32;
        if first > 0 {
            let position = 2 * m * first + n;
            self.minor += self.sideways * (position / (2 * n)) as i32;
            self.error = (position % (2 * n) - 2 * n) as i32;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::{string::String, vec::Vec};

    type Plotted = (i32, i32, u16, [u8; 3]);
    const EVERYWHERE: ClipRect =
        ClipRect { x0: i32::MIN, y0: i32::MIN, x1: i32::MAX, y1: i32::MAX };
    const RED: [u8; 3] = [255, 0, 0];
    const BLUE: [u8; 3] = [0, 0, 255];

    fn end(x: i32, y: i32) -> LineEnd {
        LineEnd { x, y, ..LineEnd::default() }
    }

    fn pixels(a: &LineEnd, b: &LineEnd, clip: ClipRect) -> Vec<Plotted> {
        let mut out = Vec::new();
        walk(a, b, clip, |x, y, z, rgb| out.push((x, y, z, rgb)));
        out
    }

    fn picture(lines: &[[i32; 4]], clip: ClipRect, width: usize, height: usize) -> String {
        let mut cells = std::vec![b'.'; width * height];
        for &[x0, y0, x1, y1] in lines {
            walk_flat(&end(x0, y0), &end(x1, y1), clip, |x, y, _| {
                let cell = &mut cells[y as usize * width + x as usize];
                assert_eq!(*cell, b'.', "a pixel drawn twice at {x}, {y}");
                *cell = b'#';
            });
        }
        cells
            .chunks(width)
            .map(|row| std::str::from_utf8(row).unwrap())
            .collect::<Vec<_>>()
            .join(" ")
    }

    struct Random(u64);

    impl Random {
        fn below(&mut self, n: u32) -> i32 {
            self.0 ^= self.0 >> 12;
            self.0 ^= self.0 << 25;
            self.0 ^= self.0 >> 27;
            ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % u64::from(n)) as i32
        }

        fn end(&mut self, size: u32) -> LineEnd {
            let half = size as i32 / 2;
            LineEnd {
                x: self.below(size) - half,
                y: self.below(size) - half,
                z: (self.below(0xffff) as u32) << 16 | self.below(0x10000) as u32,
                rgb: [0; 3].map(|_: u8| self.below(256) as u8),
            }
        }
    }

    /// The module's equations, pixel by pixel, in i128.
    fn closed_form(a: &LineEnd, b: &LineEnd) -> Vec<Plotted> {
        let steep = a.y.abs_diff(b.y) > a.x.abs_diff(b.x);
        let turn = |e: &LineEnd| if steep { (e.y, e.x) } else { (e.x, e.y) };
        let backwards =
            turn(a).0 > turn(b).0 || (a.x, a.y) == (b.x, b.y) && (a.z, a.rgb) > (b.z, b.rgb);
        let (a, b) = if backwards { (b, a) } else { (a, b) };
        let (n, d) = (i128::from(turn(b).0 - turn(a).0), i128::from(turn(b).1 - turn(a).1));
        let mut k = 0;
        while 1 << (12 + k) < n {
            k += 1;
        }
        let ramp = |v0: i128, v1: i128, extra: i32, f: i32, i: i128| {
            let step = (((v1 - v0).abs() << extra) / n.max(1)) * (v1 - v0).signum();
            ((v0 << extra) + i * step + (1 << (f - 1))) >> f
        };
        (0..=n)
            .map(|i| {
                let q = (2 * d.abs() * i + n).checked_div(2 * n).unwrap_or(0);
                let (major, minor) =
                    (i128::from(turn(a).0) + i, i128::from(turn(a).1) + d.signum() * q);
                let (x, y) = if steep { (minor, major) } else { (major, minor) };
                let z = ramp(a.z.into(), b.z.into(), k, 16 + k, i);
                let c = |c: usize| ramp(a.rgb[c].into(), b.rgb[c].into(), 20 + k, 20 + k, i) as u8;
                (x as i32, y as i32, z as u16, [c(0), c(1), c(2)])
            })
            .collect()
    }

    #[test]
    fn pictures() {
        let clip = ClipRect { x0: 0, y0: 0, x1: 8, y1: 5 };
        assert_eq!(picture(&[[0, 0, 5, 2]], clip, 6, 3), "##.... ..##.. ....##");
        assert_eq!(picture(&[[5, 2, 0, 0]], clip, 6, 3), "##.... ..##.. ....##");
        // A tie goes towards the right end, upwards and downwards.
        assert_eq!(picture(&[[0, 0, 2, 1]], clip, 3, 2), "#.. .##");
        assert_eq!(picture(&[[0, 1, 2, 0]], clip, 3, 2), ".## #..");
        assert_eq!(picture(&[[0, 0, 1, 2]], clip, 2, 3), "#. .# .#");
        assert_eq!(
            picture(&[[0, 0, 0, 3], [2, 1, 6, 1], [2, 3, 2, 3]], clip, 8, 5),
            "#....... #.#####. #....... #.#..... ........"
        );
        assert_eq!(
            picture(&[[-3, -1, 9, 5]], clip, 8, 5),
            "........ ##...... ..##.... ....##.. ......##"
        );
    }

    #[test]
    fn the_sixteen_lines_of_system_d() {
        // Eight octants and their eight borders, red start to blue end.
        let ends = [(9, 0), (9, 4), (9, 9), (4, 9), (0, 9), (-4, 9), (-9, 9), (-9, 4)];
        for (x, y) in ends.into_iter().flat_map(|(x, y)| [(x, y), (-x, -y)]) {
            let (a, b) =
                (LineEnd { rgb: RED, ..end(20, 20) }, LineEnd { rgb: BLUE, ..end(20 + x, 20 + y) });
            let line = pixels(&a, &b, EVERYWHERE);
            assert_eq!(line.len(), 10);
            assert_eq!(line, closed_form(&a, &b));
            assert!(line.contains(&(20, 20, 0, RED)) && line.contains(&(20 + x, 20 + y, 0, BLUE)));
            for pair in line.windows(2) {
                assert!(pair[0].0.abs_diff(pair[1].0).max(pair[0].1.abs_diff(pair[1].1)) == 1);
                assert!(pair[0].3[0].abs_diff(pair[1].3[0]).abs_diff(28) <= 1);
            }
        }
    }

    #[test]
    fn equals_closed_form_reverse_and_cells() {
        let mut random = Random(1);
        for i in 0..20_000 {
            let size = [3, 12, 60, 300][i % 4];
            let (a, b) = (random.end(size), random.end(size));
            let line = pixels(&a, &b, EVERYWHERE);
            assert_eq!(line, pixels(&b, &a, EVERYWHERE));
            if i % 4 < 3 || i % 16 == 3 {
                assert_eq!(line, closed_form(&a, &b));
                let frame = ClipRect { x0: -200, y0: -160, x1: 200, y1: 160 };
                let mut cells = Vec::new();
                walk_cells::<true, true>(&a, &b, frame, 401, |c, z, rgb| {
                    cells.push((c as i32 % 401 - 200, c as i32 / 401 - 160, z, rgb));
                });
                assert_eq!(cells, line);
            }
        }
    }

    #[test]
    fn clipping_never_moves_a_pixel() {
        let mut random = Random(2);
        for i in 0..20_000 {
            let size = [8, 40, 200, 20_000][i % 4];
            if i % 4 == 3 && i % 64 != 3 {
                continue;
            }
            let (a, b) = (random.end(size), random.end(size));
            let (p, q) = (random.end(size), random.end(size));
            let clip = ClipRect { x0: p.x, y0: p.y, x1: p.x.max(q.x), y1: p.y.max(q.y) };
            let mut expected = closed_form(&a, &b);
            expected.retain(|p| clip.contains(p.0, p.1));
            assert_eq!(pixels(&a, &b, clip), expected, "{a:?} {b:?} {clip:?}");
            let (stride, mut cells) = ((clip.x1 - clip.x0) as usize + i % 3, Vec::new());
            walk_cells::<true, true>(&a, &b, clip, stride, |c, z, rgb| {
                let (row, column) = ((c / stride) as i32, (c % stride) as i32);
                cells.push((clip.x0 + column, clip.y0 + row, z, rgb));
            });
            assert_eq!(cells, expected);
            let mut flat = Vec::new();
            walk_with::<false, false>(&b, &a, clip, |x, y, z, rgb| flat.push((x, y, z, rgb)));
            expected.iter_mut().for_each(|p| (p.2, p.3) = (0, [0; 3]));
            assert_eq!(flat, expected);
        }
    }

    #[test]
    fn attributes_stay_near_the_exact_rational() {
        let mut random = Random(3);
        for size in [20, 500, 4096, 4098, 30_000, 1 << 22] {
            for _ in 0..20 {
                let (a, b) = (random.end(size), random.end(size));
                let line = pixels(&a, &b, ClipRect { x0: -9000, y0: -9000, x1: 9000, y1: 9000 });
                let steep = a.y.abs_diff(b.y) > a.x.abs_diff(b.x);
                let (from, to) = if steep { (a.y, b.y) } else { (a.x, b.x) };
                let n = i64::from(to - from);
                for (x, y, z, rgb) in line {
                    let i = i64::from(if steep { y } else { x } - from);
                    // Errors times |n|, in units of 2^-8 and 2^-16.
                    let exact = |v0: i64, v1: i64| v0 * n + (v1 - v0) * i;
                    for (c, got) in rgb.into_iter().enumerate() {
                        let error = exact(a.rgb[c].into(), b.rgb[c].into()) - i64::from(got) * n;
                        let error = error.abs();
                        assert!(256 * error < (128 + 1) * n.abs());
                        assert!(i != 0 && i != n || error == 0);
                    }
                    let error = exact(a.z.into(), b.z.into()).abs_diff((i64::from(z) * n) << 16);
                    assert!(error < (0x8000 + 0x1000) * n.unsigned_abs());
                }
            }
        }
    }

    #[test]
    fn extremes_neither_overflow_nor_panic() {
        let values = [i32::MIN, -MAX_COORDINATE, -1, 0, 3, MAX_COORDINATE, i32::MAX];
        let small = ClipRect { x0: 0, y0: 0, x1: 4, y1: 4 };
        let corner = ClipRect { x0: i32::MAX - 3, y0: i32::MAX - 3, x1: i32::MAX, y1: i32::MAX };
        let inside_out = ClipRect { x0: i32::MAX, y0: 0, x1: i32::MIN, y1: i32::MAX };
        for i in 0..values.len().pow(4) {
            let v = [0, 1, 2, 3].map(|d| values[i / values.len().pow(d) % values.len()]);
            let a = LineEnd { z: u32::MAX, rgb: [255; 3], ..end(v[0], v[1]) };
            let b = end(v[2], v[3]);
            let line = pixels(&a, &b, small);
            assert!(line.len() <= 4 && line.iter().all(|p| small.contains(p.0, p.1)));
            assert_eq!(line, pixels(&b, &a, small));
            assert!(pixels(&a, &b, corner).iter().all(|p| corner.contains(p.0, p.1)));
            assert_eq!(pixels(&a, &b, inside_out), []);
        }
        let far = LineEnd { z: u32::MAX, ..end(1, 1) };
        assert_eq!(pixels(&far, &far, small), [(1, 1, 65535, [0; 3])]);
        let far = MAX_COORDINATE;
        assert_eq!(pixels(&end(-far, -far), &end(far, far), small).len(), 4);
    }
}
