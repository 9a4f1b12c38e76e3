//! `Q16`: the user's scalar, Q16.16.
//!
//! value = n / 2^16, n an i32: range [-32768, 32768 - 2^-16], resolution 2^-16 (system A's 32-bit
//! format).
//!
//! | operation | rounding | beyond the range |
//! |---|---|---|
//! | `+`, `-`, negation, `abs` | exact | saturates |
//! | `*` | floor | wraps: the middle 32 bits of the 64-bit product (system A's `mult32_inst`) |
//! | `mul_nearest` | nearest, ties upwards | saturates |
//! | `/` | nearest, ties away from zero | saturates, also for a divisor of zero (0 / 0 = 0) |
//! | `recip` | towards zero, 2^32 / n (system A's `inv32_inst`) | saturates |
//! | `sqrt` | floor | zero for a negative number |
//!
//! What it will not do: other fraction widths, and no silent conversion from floats.

use super::root::isqrt64;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number in Q16.16. The field is the raw integer: `Q16(65536)` is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[repr(transparent)]
pub struct Q16(pub i32);

impl Q16 {
    /// 0.
    pub const ZERO: Q16 = Q16(0);
    /// 1.
    pub const ONE: Q16 = Q16(1 << 16);
    /// 1/2.
    pub const HALF: Q16 = Q16(1 << 15);
    /// -32768.
    pub const MIN: Q16 = Q16(i32::MIN);
    /// 32768 - 2^-16.
    pub const MAX: Q16 = Q16(i32::MAX);

    /// An integer, exact.
    #[inline]
    pub const fn from_int(n: i16) -> Q16 {
        Q16((n as i32) << 16)
    }

    /// `num / den`, nearest, ties away from zero. Saturates, also for `den` = 0 (0 / 0 = 0).
    pub const fn from_ratio(num: i32, den: i32) -> Q16 {
        if den == 0 {
            return Q16(if num > 0 {
                i32::MAX
            } else if num < 0 {
                i32::MIN
            } else {
                0
            });
        }
        let (n, d) = ((num.unsigned_abs() as u64) << 16, den.unsigned_abs() as u64);
        let q = ((n + d / 2) / d) as i64;
        Q16(saturate32(if (num < 0) != (den < 0) { -q } else { q }))
    }

    /// Host convenience: nearest, ties away from zero, saturating; NaN gives 0.
    pub const fn from_f64(x: f64) -> Q16 {
        let scaled = x * 65536.0;
        // The addition may round up just below a half; 53 bits leave that to values beyond Q16's
        // resolution.
        Q16(saturate32((if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i64))
    }

    /// Host convenience: exact.
    pub const fn to_f64(self) -> f64 {
        self.0 as f64 / 65536.0
    }

    /// The same number in Q32.32, exact.
    #[inline]
    pub const fn to_q32(self) -> i64 {
        (self.0 as i64) << 16
    }

    /// Product rounded to nearest, ties upwards; saturates.
    #[inline]
    pub const fn mul_nearest(self, other: Q16) -> Q16 {
        Q16(saturate32((self.0 as i64 * other.0 as i64 + 0x8000) >> 16))
    }

    /// `2^32 / n` towards zero (system A: `inv32_inst`); saturates for |n| <= 2, and gives `MAX`
    /// for zero.
    #[inline]
    pub const fn recip(self) -> Q16 {
        if self.0 == 0 { Q16::MAX } else { Q16(saturate32((1i64 << 32) / self.0 as i64)) }
    }

    /// Square root, floor: error in [0, 2^-16). Zero for a negative number.
    pub const fn sqrt(self) -> Q16 {
        if self.0 <= 0 { Q16::ZERO } else { Q16(isqrt64((self.0 as u64) << 16) as i32) }
    }

    /// Magnitude; `MIN` gives `MAX`.
    #[inline]
    pub const fn abs(self) -> Q16 {
        Q16(self.0.saturating_abs())
    }

    /// `low` when below, `high` when above (`high` wins when they are crossed).
    #[inline]
    pub const fn clamp(self, low: Q16, high: Q16) -> Q16 {
        let n = if self.0 < low.0 { low.0 } else { self.0 };
        Q16(if n > high.0 { high.0 } else { n })
    }
}

impl Add for Q16 {
    type Output = Q16;
    /// Saturates.
    #[inline]
    fn add(self, other: Q16) -> Q16 {
        Q16(self.0.saturating_add(other.0))
    }
}

impl Sub for Q16 {
    type Output = Q16;
    /// Saturates.
    #[inline]
    fn sub(self, other: Q16) -> Q16 {
        Q16(self.0.saturating_sub(other.0))
    }
}

impl AddAssign for Q16 {
    /// Saturates.
    #[inline]
    fn add_assign(&mut self, other: Q16) {
        *self = *self + other;
    }
}

impl SubAssign for Q16 {
    /// Saturates.
    #[inline]
    fn sub_assign(&mut self, other: Q16) {
        *self = *self - other;
    }
}

impl Neg for Q16 {
    type Output = Q16;
    /// Saturates: `-MIN` is `MAX`.
    #[inline]
    fn neg(self) -> Q16 {
        Q16(self.0.saturating_neg())
    }
}

impl Mul for Q16 {
    type Output = Q16;
    /// The middle 32 bits of the 64-bit product: floor, and wraps beyond the range (system A).
    #[inline]
    fn mul(self, other: Q16) -> Q16 {
        Q16(((self.0 as i64 * other.0 as i64) >> 16) as i32)
    }
}

impl Div for Q16 {
    type Output = Q16;
    /// Nearest, ties away from zero; saturates, also for a divisor of zero (0 / 0 = 0).
    #[inline]
    fn div(self, other: Q16) -> Q16 {
        Q16::from_ratio(self.0, other.0)
    }
}

/// The nearest i32 that exists.
#[inline]
pub(crate) const fn saturate32(n: i64) -> i32 {
    if n > i32::MAX as i64 {
        i32::MAX
    } else if n < i32::MIN as i64 {
        i32::MIN
    } else {
        n as i32
    }
}

// 128-bit arithmetic is a few instructions on machines of 64 bits and a page of them on smaller ones, where it is a call.

/// The nearest i64 that exists.
#[cfg_attr(target_pointer_width = "64", inline)]
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
pub(crate) const fn saturate64(n: i128) -> i64 {
    if n > i64::MAX as i128 {
        i64::MAX
    } else if n < i64::MIN as i128 {
        i64::MIN
    } else {
        n as i64
    }
}

/// `n / 2^bits`, nearest, ties upwards; `bits` in 1 - 126. Exact in that no intermediate sum
/// overflows.
#[cfg_attr(target_pointer_width = "64", inline)]
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
pub(crate) const fn shift_right_nearest(n: i128, bits: u32) -> i128 {
    (n >> bits) + ((n >> (bits - 1)) & 1)
}

/// `sum + a b`, saturating.
#[cfg_attr(target_pointer_width = "64", inline)]
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
pub(crate) const fn add_product(sum: i128, a: i64, b: i64) -> i128 {
    sum.saturating_add(a as i128 * b as i128)
}

/// `floor(n / d)` for `d` of at least 2^62, by digits of 32 bits (Knuth, The Art of Computer Programming, volume 2, 4.3.1,
/// algorithm D).
pub(crate) const fn div_by_large(n: u128, d: u64) -> u128 {
    let (high, mut low) = ((n >> 64) as u64, n as u64);
    let (mut quotient, mut rest, mut d) = ((high / d) as u128, high % d, d);
    // The divisor's top bit must be set; the rest is below the divisor.
    while d >> 63 == 0 {
        d <<= 1;
        rest = rest << 1 | low >> 63;
        low <<= 1;
    }
    let (d_high, d_low) = (d >> 32, d & 0xffff_ffff);
    let mut digits = 0;
    while digits < 2 {
        let digit = low >> 32;
        low <<= 32;
        let (mut q, mut r) = (rest / d_high, rest % d_high);
        // At most two too large.
        while q >> 32 != 0 || q * d_low > (r << 32 | digit) {
            q -= 1;
            r += d_high;
            if r >> 32 != 0 {
                break;
            }
        }
        rest = (rest << 32 | digit).wrapping_sub(q.wrapping_mul(d));
        quotient = quotient << 32 | q as u128;
        digits += 1;
    }
    quotient
}

/// `n / d`, nearest, ties away from zero, saturated; `None` for `d` = 0.
pub(crate) const fn div_nearest(n: i128, d: i128) -> Option<i64> {
    if d == 0 {
        return None;
    }
    let (a, b) = (n.unsigned_abs(), d.unsigned_abs());
    // Remainder compared from above, so that nothing can overflow.
    let (q, r) = (a / b, a % b);
    let q = if r >= b - r { q + 1 } else { q };
    let q = if q > i64::MAX as u128 { i64::MAX as i128 } else { q as i128 };
    Some(if (n < 0) != (d < 0) { -q as i64 } else { q as i64 })
}

/// A float in Q32.32, nearest, saturating; NaN gives 0.
pub(crate) const fn q32_from_f64(x: f64) -> i64 {
    let scaled = x * 4294967296.0;
    // From 2^52 upwards every f64 is an integer, and adding a half would round it wrongly.
    if scaled >= 4503599627370496.0 || scaled <= -4503599627370496.0 {
        scaled as i64
    } else if scaled < 0.0 {
        (scaled - 0.5) as i64
    } else {
        (scaled + 0.5) as i64
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;

    #[test]
    fn division_by_large_numbers_is_exact() {
        let mut random = Random::new();
        let edges = [
            1 << 62,
            (1 << 62) + 1,
            (1 << 63) - 1,
            1 << 63,
            (1 << 63) + 1,
            u64::MAX,
            0xffff_ffff << 32,
        ];
        for i in 0..200_000usize {
            let d = if i % 2 == 0 { edges[i / 2 % 7] } else { random.u64() | 1 << 62 };
            let n = (random.u64() as u128) << 64 | random.u64() as u128;
            // Also numerators about a multiple of the divisor.
            let near = (n >> 64) * d as u128;
            for n in [n >> (i % 128), near, near.wrapping_sub(1), near + d as u128 - 1] {
                assert_eq!(div_by_large(n, d), n / d as u128, "{n} / {d}");
            }
        }
    }

    const EDGES: [i32; 13] =
        [0, 1, -1, 2, -2, 3, 0x7fff, 0x8000, 0x10000, -0x10000, i32::MAX, i32::MIN, i32::MIN + 1];

    fn pairs() -> impl Iterator<Item = (i32, i32)> {
        let mut random = Random::new();
        let edges = EDGES.into_iter().flat_map(|a| EDGES.into_iter().map(move |b| (a, b)));
        edges.chain((0..200_000).map(move |_| (random.spread(), random.spread())))
    }

    fn saturated(x: f64) -> f64 {
        x.clamp(Q16::MIN.to_f64(), Q16::MAX.to_f64())
    }

    #[test]
    fn system_a_multiply_keeps_the_middle_32_bits() {
        for (a, b) in pairs() {
            let product = (a as i128 * b as i128) as u64;
            let middle = (product >> 16) as u32 as i32;
            assert_eq!((Q16(a) * Q16(b)).0, middle, "{a} * {b}");
        }
        // System A's format: 1.5 * -2.25 = -3.375.
        assert_eq!(Q16::from_f64(1.5) * Q16::from_f64(-2.25), Q16::from_f64(-3.375));
    }

    #[test]
    fn system_a_reciprocal_is_2_to_32_over_n() {
        for (n, _) in pairs().filter(|p| p.0.unsigned_abs() > 2) {
            let exact = 4294967296.0 / n as f64;
            assert_eq!(Q16(n).recip().0 as f64, exact.trunc(), "{n}");
        }
        assert_eq!(Q16(2).recip(), Q16::MAX);
        assert_eq!(Q16(-2).recip(), Q16::MIN);
        assert_eq!(Q16(-1).recip(), Q16::MIN);
        assert_eq!(Q16::ZERO.recip(), Q16::MAX);
        assert_eq!(Q16::from_int(4).recip(), Q16::from_f64(0.25));
    }

    #[test]
    fn sums_and_nearest_products_and_quotients_saturate() {
        for (a, b) in pairs() {
            let (p, q) = (Q16(a), Q16(b));
            let (x, y) = (p.to_f64(), q.to_f64());
            assert_eq!((p + q).to_f64(), saturated(x + y));
            assert_eq!((p - q).to_f64(), saturated(x - y));
            assert_eq!((-p).to_f64(), saturated(-x));
            assert_eq!(p.abs().to_f64(), saturated(x.abs()));
            let half = 0.5 / 65536.0;
            assert!((p.mul_nearest(q).to_f64() - saturated(x * y)).abs() <= half, "{a} {b}");
            if b != 0 {
                assert!((p / q).to_f64() - saturated(x / y) <= half * 1.000001, "{a} {b}");
                assert!((p / q).to_f64() - saturated(x / y) >= -half * 1.000001, "{a} {b}");
            }
        }
        assert_eq!(Q16::ONE / Q16::ZERO, Q16::MAX);
        assert_eq!(-Q16::ONE / Q16::ZERO, Q16::MIN);
        assert_eq!(Q16::ZERO / Q16::ZERO, Q16::ZERO);
        assert_eq!(Q16::from_ratio(-1, 3), -Q16::from_ratio(1, 3));
    }

    #[test]
    fn square_root_is_the_floor() {
        for (n, _) in pairs() {
            let root = Q16(n).sqrt().0 as i64;
            let square = if n > 0 { (n as i64) << 16 } else { 0 };
            assert!(root * root <= square && square < (root + 1) * (root + 1), "{n}");
        }
    }

    #[test]
    fn floats_convert_at_the_door() {
        for (n, _) in pairs() {
            assert_eq!(Q16::from_f64(Q16(n).to_f64()).0, n);
            assert_eq!(Q16::from_f64((n as f64 + 0.49) / 65536.0).0, n);
            assert_eq!(Q16::from_f64((n as f64 - 0.49) / 65536.0).0, n);
            assert_eq!(q32_from_f64(Q16(n).to_f64()), Q16(n).to_q32());
        }
        assert_eq!(Q16::from_f64(f64::NAN), Q16::ZERO);
        assert_eq!(Q16::from_f64(1e300), Q16::MAX);
        assert_eq!(Q16::from_f64(f64::NEG_INFINITY), Q16::MIN);
        assert_eq!(q32_from_f64(f64::NAN), 0);
        assert_eq!(q32_from_f64(1e300), i64::MAX);
        assert_eq!(q32_from_f64(1048576.0 + 1.0 / 4294967296.0), (1 << 52) + 1);
        assert_eq!(q32_from_f64(-0.75 / 4294967296.0), -1);
        assert_eq!(Q16::from_int(i16::MIN), Q16::MIN);
    }

    #[test]
    fn clamp_never_panics() {
        assert_eq!(Q16(5).clamp(Q16(1), Q16(3)), Q16(3));
        assert_eq!(Q16(-5).clamp(Q16(1), Q16(3)), Q16(1));
        assert_eq!(Q16(2).clamp(Q16(1), Q16(3)), Q16(2));
        assert_eq!(Q16(2).clamp(Q16(3), Q16(1)), Q16(1));
    }

    #[test]
    fn wide_helpers_round_to_nearest() {
        for n in -40i128..=40 {
            assert_eq!(shift_right_nearest(n, 3), (n + 4).div_euclid(8));
            for d in (-9..=9).filter(|&d| d != 0) {
                let exact = n as f64 / d as f64;
                assert_eq!(div_nearest(n, d), Some(exact.round() as i64), "{n} / {d}");
            }
        }
        assert_eq!(shift_right_nearest(i128::MAX, 1), 1 << 126);
        assert_eq!(div_nearest(i128::MIN, -1), Some(i64::MAX));
        assert_eq!(div_nearest(i128::MAX, i128::MIN), Some(-1));
        assert_eq!(div_nearest(1, 0), None);
        assert_eq!(saturate64(i128::MIN), i64::MIN);
        assert_eq!(saturate64(i128::MAX), i64::MAX);
    }
}
