//! Division for machines of 32 bits, where one of 64 bits is a call of hundreds of instructions.
//!
//! A divisor below 2^16 leaves remainders of 16 bits, so the dividend can be taken 16 bits at a time by 32-bit divisions, as by
//! hand. Elsewhere the machine's own division is as good.

/// A machine of 32 bits: 64-bit shifts and divisions are calls.
pub(crate) const NARROW: bool = cfg!(target_pointer_width = "32");

/// `floor(n / d)` for `d` from 1 below 2^16: 32 bits, then 16 and 16.
#[inline]
fn by_digits(n: u64, d: u32) -> u64 {
    let (high, low) = ((n >> 32) as u32, n as u32);
    let (top, rest) = if high == 0 { (0, 0) } else { (high / d, high % d) };
    let next = (rest << 16) | (low >> 16);
    let (middle, rest) = (next / d, next % d);
    let bottom = ((rest << 16) | (low & 0xffff)) / d;
    ((top as u64) << 32) | ((middle << 16) | bottom) as u64
}

/// `floor(n / d)` for positive `d`.
#[inline(always)]
pub(crate) fn floor(n: i64, d: i64) -> i64 {
    if NARROW { narrow_floor(n, d) } else { n / d + ((n % d) >> 63) }
}

#[inline(never)]
fn narrow_floor(n: i64, d: i64) -> i64 {
    // floor(n / d) = -1 - floor((-1 - n) / d)
    let sign = n >> 63;
    let size = (n ^ sign) as u64;
    let quotient = if d < 1 << 16 { by_digits(size, d as u32) } else { size / d as u64 };
    quotient as i64 ^ sign
}

/// `n 2^32 / d` without what is behind the point, for |n| below 2^31 and `d` not 0, |d| below 2^16.
#[inline(always)]
pub(crate) fn fraction(n: i64, d: i64) -> i64 {
    if NARROW { narrow_fraction(n as i32, d as i32) } else { (n << 32) / d }
}

#[inline(never)]
fn narrow_fraction(n: i32, d: i32) -> i64 {
    let (size, by) = (n.unsigned_abs(), d.unsigned_abs());
    let (whole, rest) = (size / by, size % by);
    let (high, rest) = ((rest << 16) / by, (rest << 16) % by);
    let low = (rest << 16) / by;
    let quotient = (((whole as u64) << 32) | ((high << 16) | low) as u64) as i64;
    if (n ^ d) < 0 { -quotient } else { quotient }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::testing::Random;

    #[test]
    fn digits_are_division() {
        let mut random = Random::new();
        for i in 0..200_000u32 {
            let n = ((random.i32() as i64) << 32 | random.i32() as u32 as i64) >> (i % 60);
            let d = ((random.i32() as u32 >> (i % 31)) as i64).max(1);
            assert_eq!(narrow_floor(n, d), n.div_euclid(d), "{n} {d}");
            assert_eq!(floor(n, d), n.div_euclid(d), "{n} {d}");
            let (n, d) =
                (n as i32 >> 1, (d as i32 & 0xffff).max(1) * if i & 1 == 0 { 1 } else { -1 });
            assert_eq!(narrow_fraction(n, d), ((n as i64) << 32) / d as i64, "{n} {d}");
            assert_eq!(fraction(n as i64, d as i64), ((n as i64) << 32) / d as i64, "{n} {d}");
        }
    }
}
