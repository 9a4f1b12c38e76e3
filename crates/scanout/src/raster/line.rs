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
//! With `k = max(0, ceil(log2 n) - 12)`, which is 0 for every line of up to 4097 pixels:
//!
//! ```text
//! step  = sign(d) * floor((|d| << F) / n)      F = 20 + k for a channel U8.0
//! value = (v0 << F + i * step + half) >> F     F = 16 + k for a depth (v in units of 1/65536: k)
//! ```
//!
//! So a colour is system D's 12.20 and a depth U16.16 until the line leaves any screen, and then the
//! fraction grows with the line. **Error**: truncation loses less than one unit of `2^-F` a step,
//! hence less than `n 2^-F` in all, and `n <= 2^(12 + k)`: less than `2^-8` of a colour step and
//! `2^-4` of a depth step before the one rounding to nearest. A reported colour is therefore
//! less than `1/2 + 2^-8` from the exact rational, a depth less than `1/2 + 2^-4`; and both end
//! *colours* are exact, because they are whole and `2^-8 < 1/2`.
//!
//! When both ends are one pixel, the nearer end is reported (of equally near ones the darker).
//!
//! # Limits
//!
//! Coordinates are valid within `±2^26` pixels; one beyond is taken as the nearest valid one.
//! Nothing here panics. No line width, no stipple; smooth lines are in `smooth_line`.

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
/// Cost: four 32-bit divisions a line (none of 64 bits while it has at most 4097 pixels and needs
/// no clipping), then additions and one comparison a pixel.
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
    let Some((line, steps)) = Line::new(a, b).clipped(clip) else { return };
    match (steps.steep, line.is_short()) {
        (false, true) => {
            let ramp = ShortRamp::<COLOUR, DEPTH>::new(&line, steps.first);
            trace(&steps, ramp, plot);
        }
        (true, true) => {
            let ramp = ShortRamp::<COLOUR, DEPTH>::new(&line, steps.first);
            trace(&steps, ramp, |u, v, z, rgb| plot(v, u, z, rgb));
        }
        (steep, false) => {
            let ramp = LongRamp::<COLOUR, DEPTH>::new(&line, steps.first);
            let mut turned =
                |u, v, z, rgb| if steep { plot(v, u, z, rgb) } else { plot(u, v, z, rgb) };
            trace(&steps, ramp, &mut turned);
        }
    }
}

/// The inner loop: pixel, attributes, step. Reports (major, minor).
#[inline(always)]
fn trace<R: Ramp>(steps: &Steps, mut ramp: R, mut plot: impl FnMut(i32, i32, u16, [u8; 3])) {
    let Steps { mut major, mut minor, sideways, mut error, rise, run, last, .. } = *steps;
    loop {
        plot(major, minor, ramp.depth(), ramp.rgb());
        if major == last {
            return;
        }
        major += 1;
        error += rise;
        if error >= 0 {
            error -= run;
            minor += sideways;
        }
        ramp.advance();
    }
}

/// A line in canonical form: the ends in order of increasing major coordinate.
struct Line {
    steep: bool,
    start: LineEnd,
    end: LineEnd,
    /// Steps along the major axis, `0..=2^27`.
    n: u32,
    /// Distance along the minor axis, `0..=n`.
    m: u32,
}

/// The visible part of a line, ready to walk.
struct Steps {
    steep: bool,
    /// Number of the first visible pixel.
    first: u32,
    major: i32,
    minor: i32,
    /// Major coordinate of the last visible pixel.
    last: i32,
    /// +1 or -1: the direction of the minor axis.
    sideways: i32,
    /// `(2 m i + n) mod 2 n - 2 n`, in `-2 n..0`.
    error: i32,
    /// `2 m`.
    rise: i32,
    /// `2 n`.
    run: i32,
}

impl Line {
    #[inline(always)]
    fn new(a: &LineEnd, b: &LineEnd) -> Self {
        let (mut start, mut end) = (*a, *b);
        for e in [&mut start, &mut end] {
            e.x = e.x.clamp(-MAX_COORDINATE, MAX_COORDINATE);
            e.y = e.y.clamp(-MAX_COORDINATE, MAX_COORDINATE);
            e.z = e.z.min(0xffff << 16);
        }
        let (dx, dy) = (start.x.abs_diff(end.x), start.y.abs_diff(end.y));
        let steep = dy > dx;
        let backwards = if steep {
            start.y > end.y
        } else if dx != 0 {
            start.x > end.x
        } else {
            (start.z, start.rgb) > (end.z, end.rgb)
        };
        if backwards {
            (start, end) = (end, start);
        }
        let (n, m) = if steep { (dy, dx) } else { (dx, dy) };
        Self { steep, start, end, n, m }
    }

    /// Whether every attribute fits 32 bits with `k = 0`.
    #[inline(always)]
    fn is_short(&self) -> bool {
        self.n <= 4096
    }

    /// `k` of the module's equations.
    #[inline(always)]
    fn extra_bits(&self) -> u32 {
        if self.is_short() { 0 } else { (self.n - 1).ilog2() + 1 - 12 }
    }

    #[inline(always)]
    fn clipped(self, clip: ClipRect) -> Option<(Self, Steps)> {
        let Self { steep, ref start, ref end, n, m } = self;
        let turn = |e: &LineEnd| if steep { (e.y, e.x) } else { (e.x, e.y) };
        let ((major, minor), (last, far)) = (turn(start), turn(end));
        let mut steps = Steps {
            steep,
            first: 0,
            major,
            minor,
            last,
            sideways: if far < minor { -1 } else { 1 },
            error: -(n as i32),
            rise: 2 * m as i32,
            run: 2 * n as i32,
        };
        if !(clip.contains(start.x, start.y) && clip.contains(end.x, end.y)) {
            steps.clip(clip, n, m)?;
        }
        Some((self, steps))
    }
}

impl Steps {
    /// Moves the first and the last pixel into `clip`; `None` when no pixel is inside.
    #[cold]
    fn clip(&mut self, clip: ClipRect, n: u32, m: u32) -> Option<()> {
        let ClipRect { x0, y0, x1, y1 } = clip;
        let (major, minor) = if self.steep { ((y0, y1), (x0, x1)) } else { ((x0, x1), (y0, y1)) };
        let (n, m) = (i64::from(n), i64::from(m));
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
        self.last = (i64::from(self.major) + last) as i32;
        self.major = (i64::from(self.major) + first) as i32;
        if first > 0 {
            let position = 2 * m * first + n;
            self.minor += self.sideways * (position / (2 * n)) as i32;
            self.error = (position % (2 * n) - 2 * n) as i32;
        }
        Some(())
    }
}

/// Attributes along a line.
trait Ramp {
    fn rgb(&self) -> [u8; 3];
    fn depth(&self) -> u16;
    fn advance(&mut self);
}

/// `k = 0`: four 32-bit accumulators, two to a word, so that one addition steps two attributes.
///
/// Each lane stays within `0..2^32` on every pixel of the line (it lies between its end values), so
/// the word always equals `high << 32 | low` though the steps may be negative.
struct ShortRamp<const COLOUR: bool, const DEPTH: bool> {
    /// Red U8.20, green U8.20.
    rg: u64,
    rg_step: u64,
    /// Depth U16.16, blue U8.20.
    zb: u64,
    zb_step: u64,
}

impl<const COLOUR: bool, const DEPTH: bool> ShortRamp<COLOUR, DEPTH> {
    #[inline(always)]
    fn new(line: &Line, first: u32) -> Self {
        let n = line.n.max(1);
        let lane = |used: bool, from: u32, to: u32, half: u32| {
            if !used {
                return (0, 0);
            }
            let size = u64::from(from.abs_diff(to) / n);
            (u64::from(from + half), if to < from { size.wrapping_neg() } else { size })
        };
        let channel = |c: usize| {
            let (from, to) = (line.start.rgb[c], line.end.rgb[c]);
            lane(COLOUR, u32::from(from) << 20, u32::from(to) << 20, 1 << 19)
        };
        let (r, g, b) = (channel(0), channel(1), channel(2));
        let z = lane(DEPTH, line.start.z, line.end.z, 1 << 15);
        let pair = |high: u64, low: u64| (high << 32).wrapping_add(low);
        let (rg_step, zb_step) = (pair(r.1, g.1), pair(z.1, b.1));
        let i = u64::from(first);
        Self {
            rg: pair(r.0, g.0).wrapping_add(rg_step.wrapping_mul(i)),
            rg_step,
            zb: pair(z.0, b.0).wrapping_add(zb_step.wrapping_mul(i)),
            zb_step,
        }
    }
}

impl<const COLOUR: bool, const DEPTH: bool> Ramp for ShortRamp<COLOUR, DEPTH> {
    #[inline(always)]
    fn rgb(&self) -> [u8; 3] {
        if COLOUR {
            [(self.rg >> 52) as u8, (self.rg >> 20) as u8, (self.zb >> 20) as u8]
        } else {
            [0; 3]
        }
    }

    #[inline(always)]
    fn depth(&self) -> u16 {
        if DEPTH { (self.zb >> 48) as u16 } else { 0 }
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.rg = self.rg.wrapping_add(self.rg_step);
        self.zb = self.zb.wrapping_add(self.zb_step);
    }
}

/// Any `k`: one 64-bit accumulator an attribute (at most 48 bits are used).
struct LongRamp<const COLOUR: bool, const DEPTH: bool> {
    now: [i64; 4],
    step: [i64; 4],
    bits: u32,
}

impl<const COLOUR: bool, const DEPTH: bool> LongRamp<COLOUR, DEPTH> {
    #[inline(never)]
    fn new(line: &Line, first: u32) -> Self {
        let (k, n) = (line.extra_bits(), i64::from(line.n.max(1)));
        let mut ramp = Self { now: [0; 4], step: [0; 4], bits: k };
        for c in 0..4 {
            if (c < 3 && !COLOUR) || (c == 3 && !DEPTH) {
                continue;
            }
            let value = |e: &LineEnd| match c {
                3 => i64::from(e.z) << k,
                _ => i64::from(e.rgb[c]) << (20 + k),
            };
            let half = if c == 3 { 1 << (15 + k) } else { 1 << (19 + k) };
            let (from, to) = (value(&line.start), value(&line.end));
            ramp.step[c] = (to - from) / n;
            ramp.now[c] = from + half + ramp.step[c] * i64::from(first);
        }
        ramp
    }
}

impl<const COLOUR: bool, const DEPTH: bool> Ramp for LongRamp<COLOUR, DEPTH> {
    #[inline(always)]
    fn rgb(&self) -> [u8; 3] {
        [0, 1, 2].map(|c| (self.now[c] >> (20 + self.bits)) as u8)
    }

    #[inline(always)]
    fn depth(&self) -> u16 {
        (self.now[3] >> (16 + self.bits)) as u16
    }

    #[inline(always)]
    fn advance(&mut self) {
        for (now, step) in self.now.iter_mut().zip(self.step) {
            *now += step;
        }
    }
}
