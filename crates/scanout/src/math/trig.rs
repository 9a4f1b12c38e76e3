//! Angles, sine, cosine and tangent.
//!
//! An angle is a fraction of a turn, U0.32: 2^32 is one turn, so that it wraps where angles wrap
//! and no multiple of a turn is ever lost or gained. Sine and cosine come out in Q2.30.
//!
//! ```text
//!   fold to the first octant:  p in [0, 2^29], the rest by symmetry
//!   split:                     p = i 2^22 + d,  i in 0..=128,  |d| <= 2^21
//!                              b = 2 pi d / 2^32,  |b| <= pi / 1024
//!   sin(a + b) = sin a + cos a sin b - sin a (1 - cos b)    sin b = b - b^3 / 6
//!   cos(a + b) = cos a - sin a sin b - cos a (1 - cos b)    1 - cos b = b^2 / 2
//! ```
//!
//! The table holds sin(i 90 / 256 degrees) for i in 0..256 (1 KB), computed by the compiler in
//! 128-bit integers. Error: at most 2^-29.8 (tested over a dense sample). Folding makes the
//! symmetries exact: sin(-a) = -sin a, sin(180 - a) = sin a, cos a = sin(90 - a); multiples of 90
//! degrees are exact.
//!
//! What it will not do: inverse functions.

use super::Q16;
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// An angle in turns, U0.32: `Angle(1 << 30)` is 90 degrees. Wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[repr(transparent)]
pub struct Angle(pub u32);

/// sin(i * 90 / 256 degrees) in Q2.30, nearest; 1024 bytes.
pub static SINE: [u32; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = sine_exact(i as i128);
        i += 1;
    }
    table
};

/// sin(i * 90 / 256 degrees) in Q2.30 by Taylor's series in Q2.60, for the table.
const fn sine_exact(i: i128) -> u32 {
    const PI_Q60: i128 = 3_622_009_729_038_561_421; // pi * 2^60
    let x = (PI_Q60 * i) >> 9;
    let square = (x * x) >> 60;
    let (mut term, mut sum, mut k) = (x, x, 1);
    while term != 0 && k < 40 {
        term = -((term * square) >> 60) / ((k + 1) * (k + 2));
        sum += term;
        k += 2;
    }
    ((sum + (1 << 29)) >> 30) as u32
}

/// sin and cos of the table's angle `i` in 0..=128, Q2.30.
#[inline]
const fn table(i: usize) -> (i64, i64) {
    (SINE[i] as i64, if i == 0 { 1 << 30 } else { SINE[256 - i] as i64 })
}

impl Angle {
    /// 0 degrees.
    pub const ZERO: Angle = Angle(0);
    /// 90 degrees.
    pub const QUARTER: Angle = Angle(1 << 30);
    /// 180 degrees.
    pub const HALF: Angle = Angle(1 << 31);

    /// Degrees in Q16.16, nearest: error at most half of 2^-32 turn.
    pub const fn from_degrees(degrees: Q16) -> Angle {
        Angle((((degrees.0 as i64) << 16) + 180).div_euclid(360) as u32)
    }

    /// Host convenience: degrees as a float, nearest; wraps. NaN gives 0; beyond +-2^31 turns it
    /// saturates.
    pub const fn from_degrees_f64(degrees: f64) -> Angle {
        let scaled = degrees * (4294967296.0 / 360.0);
        Angle((if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i64 as u32)
    }

    /// `num / den` of a turn, nearest; wraps. `den` = 0 gives 0.
    pub const fn from_ratio(num: i32, den: i32) -> Angle {
        if den == 0 {
            return Angle(0);
        }
        let (num, den) = (num as i64, den as i64);
        let (num, den) = if den < 0 { (-num, -den) } else { (num, den) };
        // Without whole turns, so that 63 bits hold it.
        Angle((((num.rem_euclid(den) << 32) + den / 2) / den) as u32)
    }

    /// Sine and cosine in Q2.30, error at most 2^-29.8. Exact at multiples of 90 degrees, exactly
    /// symmetric.
    ///
    /// Cost: two table reads, eight products of 32 x 32 -> 64 bits.
    pub const fn sin_cos(self) -> (i32, i32) {
        // Quadrant by the two top bits, measured from the nearer end of the quadrant on the x axis.
        let r = self.0 & 0x3fff_ffff;
        let p = if self.0 & 1 << 30 != 0 { (1 << 30) - r } else { r };
        let (s, c) = if p > 1 << 29 {
            let (c, s) = octant((1 << 30) - p);
            (s, c)
        } else {
            octant(p)
        };
        let quadrant = self.0 >> 30;
        (if quadrant >= 2 { -s } else { s }, if quadrant == 1 || quadrant == 2 { -c } else { c })
    }

    /// Sine in Q2.30; see [`Angle::sin_cos`].
    pub const fn sin(self) -> i32 {
        self.sin_cos().0
    }

    /// Cosine in Q2.30; see [`Angle::sin_cos`].
    pub const fn cos(self) -> i32 {
        self.sin_cos().1
    }

    /// Tangent in Q32.32: sine over cosine, nearest. `None` where the cosine is zero.
    ///
    /// Error: at most `2^-29 (1 + t^2)` for a tangent of `t`, since the cosine's error grows as it
    /// vanishes.
    pub const fn tan(self) -> Option<i64> {
        let (s, c) = self.sin_cos();
        super::div_nearest((s as i128) << 32, c as i128)
    }
}

/// sin and cos of `p` in [0, 2^29] units of 2^-32 turn.
const fn octant(p: u32) -> (i32, i32) {
    const TAU_Q29: i64 = 3_373_259_426; // 2 pi * 2^29, 32 bits
    let i = (p + (1 << 21)) >> 22;
    let d = p as i64 - ((i as i64) << 22);
    let b = (d * TAU_Q29 + (1 << 22)) >> 23; // Q38, 30 bits and a sign
    let h = (b * b) >> 31; // b^2 / 2 in Q46, 29 bits
    let sin_b = b - ((b * h) >> 46) / 3; // Q38
    let (s, c) = table(i as usize);
    let sin = s + ((c * sin_b - ((s * h) >> 8) + (1 << 37)) >> 38);
    let cos = c + ((-s * sin_b - ((c * h) >> 8) + (1 << 37)) >> 38);
    (sin as i32, cos as i32)
}

impl Add for Angle {
    type Output = Angle;
    /// Wraps.
    fn add(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_add(other.0))
    }
}

impl Sub for Angle {
    type Output = Angle;
    /// Wraps.
    fn sub(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_sub(other.0))
    }
}

impl AddAssign for Angle {
    /// Wraps.
    fn add_assign(&mut self, other: Angle) {
        *self = *self + other;
    }
}

impl SubAssign for Angle {
    /// Wraps.
    fn sub_assign(&mut self, other: Angle) {
        *self = *self - other;
    }
}

impl Neg for Angle {
    type Output = Angle;
    /// Wraps.
    fn neg(self) -> Angle {
        Angle(self.0.wrapping_neg())
    }
}

impl Mul<i32> for Angle {
    type Output = Angle;
    /// A multiple, wraps: exact modulo one turn.
    fn mul(self, n: i32) -> Angle {
        Angle(self.0.wrapping_mul(n as u32))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;
    use std::f64::consts::TAU;

    const ONE: i32 = 1 << 30;

    fn radians(angle: Angle) -> f64 {
        angle.0 as f64 / 4294967296.0 * TAU
    }

    fn sample() -> impl Iterator<Item = Angle> {
        let mut random = Random::new();
        let edges = (0..=1024u32).flat_map(|i| {
            (-2..=2).map(move |d| Angle((i << 22).wrapping_add(1 << 21).wrapping_add_signed(d)))
        });
        let dense = (0..u32::MAX).step_by(19_937).map(Angle);
        edges.chain(dense).chain((0..100_000).map(move |_| Angle(random.u32())))
    }

    #[test]
    fn sine_and_cosine_stay_within_their_bound() {
        let mut worst = 0.0f64;
        for angle in sample() {
            let (s, c) = angle.sin_cos();
            let (sin, cos) = radians(angle).sin_cos();
            worst = worst.max((s as f64 / ONE as f64 - sin).abs());
            worst = worst.max((c as f64 / ONE as f64 - cos).abs());
        }
        std::println!("sin_cos: error 2^{}", worst.log2());
        assert!(worst <= 2.0f64.powf(-29.8));
    }

    #[test]
    fn the_table_is_the_nearest_sine() {
        for (i, &entry) in SINE.iter().enumerate() {
            let exact = (i as f64 / 1024.0 * TAU).sin() * ONE as f64;
            assert_eq!(entry as f64, exact.round(), "{i}");
        }
        assert_eq!(core::mem::size_of_val(&SINE), 1024);
    }

    #[test]
    fn quarters_are_exact_and_symmetries_hold_bit_for_bit() {
        assert_eq!(Angle(0).sin_cos(), (0, ONE));
        assert_eq!(Angle::QUARTER.sin_cos(), (ONE, 0));
        assert_eq!(Angle::HALF.sin_cos(), (0, -ONE));
        assert_eq!(Angle(3 << 30).sin_cos(), (-ONE, 0));
        for a in sample() {
            let (s, c) = a.sin_cos();
            assert_eq!((-a).sin_cos(), (-s, c), "-{a:?}");
            assert_eq!((Angle::HALF - a).sin_cos(), (s, -c), "180 - {a:?}");
            assert_eq!((Angle::HALF + a).sin_cos(), (-s, -c), "180 + {a:?}");
            assert_eq!((Angle::QUARTER - a).sin_cos(), (c, s), "90 - {a:?}");
            assert!(s.abs() <= ONE && c.abs() <= ONE);
        }
    }

    #[test]
    fn system_a_512_sines_of_the_first_quadrant_agree() {
        // A's table maps the closed interval [0, 90] to 512 entries of Q16.16.
        for i in 0..512 {
            let angle = Angle::from_ratio(i, 4 * 511);
            let exact = (i as f64 / (4.0 * 511.0) * TAU).sin() * 65536.0;
            assert_eq!((angle.sin() + (1 << 13)) >> 14, exact.round() as i32, "{i}");
        }
    }

    #[test]
    fn tangent_stays_within_its_bound() {
        assert_eq!(Angle::QUARTER.tan(), None);
        assert_eq!(Angle(3 << 30).tan(), None);
        assert_eq!(Angle(1 << 29).tan(), Some(1 << 32));
        for angle in sample() {
            let Some(t) = angle.tan() else { continue };
            let exact = radians(angle).tan();
            if exact.abs() > 1000.0 {
                continue; // the cosine has few bits left; the bound says so
            }
            let bound = 2.0f64.powi(-29) * (1.0 + exact * exact);
            assert!((t as f64 / 4294967296.0 - exact).abs() <= bound, "{angle:?}");
        }
    }

    #[test]
    fn angles_convert_to_nearest_and_wrap() {
        for degrees in -32768..=32767i16 {
            let expected = (degrees as f64 / 360.0).rem_euclid(1.0) * 4294967296.0;
            let angle = Angle::from_degrees(Q16::from_int(degrees));
            assert_eq!(angle.0, expected.round() as u64 as u32, "{degrees}");
            assert_eq!(Angle::from_degrees_f64(degrees as f64), angle);
            assert_eq!(Angle::from_ratio(degrees as i32, 360), angle);
            assert_eq!(Angle::from_ratio(-(degrees as i32), -360), angle);
        }
        assert_eq!(Angle::from_degrees(Q16::from_int(360)), Angle::ZERO);
        assert_eq!(Angle::from_degrees(Q16::from_int(-90)), Angle(3 << 30));
        assert_eq!(Angle::from_ratio(1, 0), Angle::ZERO);
        assert_eq!(Angle::from_ratio(i32::MIN, i32::MIN), Angle::ZERO);
        assert_eq!(Angle::from_degrees_f64(f64::NAN), Angle::ZERO);
        assert_eq!(Angle::QUARTER * -3, Angle::QUARTER);
        assert_eq!(Angle(u32::MAX) + Angle(1), Angle::ZERO);
        let mut angle = Angle::ZERO;
        angle -= Angle::QUARTER;
        angle += Angle::HALF;
        assert_eq!(angle, Angle::QUARTER);
    }
}
