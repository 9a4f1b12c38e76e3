//! Colour and depth along a line.
//!
//! For a line of `n` steps from value `v0` to `v1`, with `d = v1 - v0` and
//! `k = max(0, ceil(log2 n) - 12)`, which is 0 while `n <= 4096`:
//!
//! ```text
//! step     = sign(d) * floor((|d| << F) / n)
//! value(i) = ((v0 << F) + i * step + half) >> F          half = 2^(F - 1)
//! ```
//!
//! - a colour channel is U8.0 and `F = 20 + k`: system D's 12.20, rounded to nearest at the output;
//! - a depth is U16.16 and keeps `k` more bits; the same equation with `F = 16 + k`, whole steps of
//!   the 16-bit depth for `v`, gives U16.0. One 32-bit divider serves both.
//!
//! So the formats are the FPGA's until the line is longer than any screen is wide, and then the
//! fraction grows with the line.
//!
//! **Error.** Truncation loses less than one unit of `2^-F` a step, so less than `n 2^-F` in all,
//! and `n <= 2^(12 + k)`: less than `2^-8` of a colour step, or `2^-4` of a depth step, always
//! towards `v0`. One rounding to nearest follows. A colour is therefore less than `1/2 + 2^-8` from
//! the exact rational and a depth less than `1/2 + 2^-4`. Both end colours are exact: at `i = 0`
//! nothing is lost, and at `i = n` the value is less than `2^-8 < 1/2` from the whole number `v1`.

use super::LineEnd;

/// The largest `n` for which `k = 0` and every attribute fits 32 bits.
pub const SHORT: u32 = 4096;

/// The largest depth, 65535.0 in U16.16.
const FARTHEST: u32 = 0xffff << 16;

/// Attributes along a line; those that aren't wanted are 0.
pub trait Ramp {
    /// Red, green, blue, U8.0 each.
    fn rgb(&self) -> [u8; 3];
    /// Depth, U16.0.
    fn depth(&self) -> u16;
    /// From `i` to `i + 1`.
    fn advance(&mut self);
}

/// `n <= SHORT`: four 32-bit accumulators, two to a word, so that one addition steps two of them.
///
/// On every pixel of the line each lane lies between its end values, so within `0..2^32`, and the
/// word equals `high << 32 | low` even though steps may be negative.
pub struct ShortRamp<const COLOUR: bool, const DEPTH: bool> {
    /// Red U8.20, green U8.20.
    rg: u64,
    rg_step: u64,
    /// Depth U16.16, blue U8.20.
    zb: u64,
    zb_step: u64,
}

impl<const COLOUR: bool, const DEPTH: bool> ShortRamp<COLOUR, DEPTH> {
    /// At step `i`.
    #[inline(always)]
    pub fn new(start: &LineEnd, end: &LineEnd, n: u32, i: u32) -> Self {
        let n = n.max(1);
        let lane = |from: u32, to: u32, half: u32| {
            let size = u64::from(from.abs_diff(to) / n);
            (u64::from(from + half), if to < from { size.wrapping_neg() } else { size })
        };
        let channel = |c: usize| {
            let value = |e: &LineEnd| u32::from(e.rgb[c]) << 20;
            if COLOUR { lane(value(start), value(end), 1 << 19) } else { (0, 0) }
        };
        let (r, g, b) = (channel(0), channel(1), channel(2));
        let z =
            if DEPTH { lane(start.z.min(FARTHEST), end.z.min(FARTHEST), 1 << 15) } else { (0, 0) };
        let pair = |high: u64, low: u64| (high << 32).wrapping_add(low);
        let (rg_step, zb_step) = (pair(r.1, g.1), pair(z.1, b.1));
        let i = u64::from(i);
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
        [(self.rg >> 52) as u8, (self.rg >> 20) as u8, (self.zb >> 20) as u8]
    }

    #[inline(always)]
    fn depth(&self) -> u16 {
        (self.zb >> 48) as u16
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.rg = self.rg.wrapping_add(self.rg_step);
        self.zb = self.zb.wrapping_add(self.zb_step);
    }
}

/// Any `n` up to 2^31: one 64-bit accumulator an attribute (52 bits at most are used).
pub struct LongRamp<const COLOUR: bool, const DEPTH: bool> {
    now: [i64; 4],
    step: [i64; 4],
    bits: u32,
}

impl<const COLOUR: bool, const DEPTH: bool> LongRamp<COLOUR, DEPTH> {
    /// At step `i`.
    #[inline(never)]
    pub fn new(start: &LineEnd, end: &LineEnd, n: u32, i: u32) -> Self {
        let n = n.max(1);
        let bits = (32 - (n - 1).leading_zeros()).saturating_sub(12);
        let mut ramp = Self { now: [0; 4], step: [0; 4], bits };
        let wanted = [COLOUR, COLOUR, COLOUR, DEPTH];
        for c in (0..4).filter(|&c| wanted[c]) {
            let value = |e: &LineEnd| match c {
                3 => i64::from(e.z.min(FARTHEST)) << bits,
                _ => i64::from(e.rgb[c]) << (20 + bits),
            };
            let half = if c == 3 { 1 << (15 + bits) } else { 1 << (19 + bits) };
            let (from, to) = (value(start), value(end));
            ramp.step[c] = (to - from) / i64::from(n);
            ramp.now[c] = from + half + ramp.step[c] * i64::from(i);
        }
        ramp
    }

    /// Moves on by `count` steps at once.
    #[inline]
    pub fn advance_by(&mut self, count: u32) {
        for (now, step) in self.now.iter_mut().zip(self.step) {
            *now += step * i64::from(count);
        }
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
