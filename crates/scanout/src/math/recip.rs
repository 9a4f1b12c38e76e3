//! The reciprocal that all three machines share.
//!
//! ```text
//! recip32(m) = floor((2^63 - 1) / m)      m in [2^31, 2^32), result in [2^31, 2^32)
//! ```
//!
//! `m` is a mantissa with its top bit set, U0.32 in [1/2, 1); the result is 1/m in U1.31. The
//! closed form is the definition. [`recip32`] computes it with the machine's division,
//! [`recip32_newton`] with a 256-entry table and products of 32 x 32 -> 64 bits, as a circuit or a
//! core without a 64-bit divider does. They agree for every `m`.
//!
//! What it will not do: reciprocals of numbers that aren't normalised; see [`normalise_mantissa`].

use super::NARROW;
use super::product::{mixed_product, product};

/// `floor((2^63 - 1) / m)`, exact, for `m` >= 2^31. The top bit of `m` is taken as set.
///
/// Cost: one 64-bit division; on machines of 32 bits [`recip32_newton`]'s.
#[inline]
pub const fn recip32(m: u32) -> u32 {
    if NARROW {
        return recip32_newton(m);
    }
    (((1u64 << 63) - 1) / (m | 1 << 31) as u64) as u32
}

/// Seeds of [`recip32_newton`]: the reciprocal at the middle of each of the 256 steps of 2^23. 512
/// bytes.
pub static RECIP_SEED: [u16; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        // m = (2 (256 + i) + 1) 2^22, so 2^63 / m / 2^16 = 2^25 / (513 + 2 i).
        table[i] = ((1u32 << 25) / (513 + 2 * i as u32)) as u16;
        i += 1;
    }
    table
};

/// [`recip32`] without a division: seed, two Newton steps, fix-up. Equal to it for every `m`.
///
/// The seed is right to 2^-9, the first step makes that 2^-18, the second 2^-36 less the
/// truncation. Newton's step `r (2 - m r)` never exceeds `1 / m` and truncation only lowers it, so
/// the fix-up only ever adds, at most three times.
///
/// Cost: a table read, five products of 32 x 32 -> 64 bits, at most three subtractions.
#[inline]
pub const fn recip32_newton(m: u32) -> u32 {
    let m = m | 1 << 31;
    let mut r = (RECIP_SEED[(m >> 23) as usize & 255] as u32) << 16;
    let mut step = 0;
    while step < 2 {
        // 1 - m r in Q32: below 2^-8 in magnitude, so 25 bits and a sign.
        let e = ((1i64 << 63).wrapping_sub(product(m, r) as i64)) >> 31;
        r = r.wrapping_add((mixed_product(e as i32, r) >> 32) as u32);
        step += 1;
    }
    let mut rest = ((1 << 63) - 1) - product(m, r);
    while rest >= m as u64 {
        rest -= m as u64;
        r += 1;
    }
    r
}

/// The leading one of `n` moved to bit 31: `(m, shift)` with `m = floor(n * 2^shift / 2^32)`, so
/// that `m` is in [2^31, 2^32) and `n = m * 2^(32 - shift)`, truncated below `m`'s last bit (exact
/// for `n` < 2^32).
///
/// `shift` is the number of leading zeros, 0 - 63; zero gives `(0, 64)`.
#[inline]
pub const fn normalise_mantissa(n: u64) -> (u32, u32) {
    let shift = n.leading_zeros();
    if shift == 64 { (0, 64) } else { (((n << shift) >> 32) as u32, shift) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::testing::Random;

    fn check(m: u32) {
        let exact = (((1u128 << 63) - 1) / m as u128) as u32;
        assert!(exact >= 1 << 31);
        assert_eq!(recip32(m), exact, "{m:#x}");
        assert_eq!(recip32_newton(m), exact, "{m:#x}");
    }

    #[test]
    fn newton_equals_the_closed_form() {
        // The ends of every step of the table, powers of two, and a dense sample.
        for i in 256..512u32 {
            for d in 0..64 {
                check((i << 23) + d);
                check((i << 23) + 0x7f_ffff - d);
                check((i << 23) + 0x40_0000 - 32 + d);
            }
        }
        for bit in 0..31 {
            check(1 << 31 | 1 << bit);
            check(!(1 << bit));
        }
        for m in (1 << 31..=u32::MAX).step_by(1021) {
            check(m);
        }
        let mut random = Random::new();
        for _ in 0..2_000_000 {
            let m = random.u32() | 1 << 31;
            assert_eq!(recip32(m), recip32_newton(m), "{m:#x}");
        }
    }

    #[test]
    #[ignore = "all 2^31 mantissas: 8 seconds in a release build"]
    fn newton_equals_the_closed_form_everywhere() {
        for m in 1 << 31..=u32::MAX {
            assert_eq!(recip32(m), recip32_newton(m), "{m:#x}");
        }
    }

    #[test]
    fn the_top_bit_is_taken_as_set() {
        assert_eq!(recip32(0), u32::MAX);
        assert_eq!(recip32_newton(0), u32::MAX);
        assert_eq!(recip32(u32::MAX), 1 << 31);
        assert_eq!(recip32_newton(u32::MAX), 1 << 31);
    }

    #[test]
    fn mantissas_are_left_justified() {
        assert_eq!(normalise_mantissa(0), (0, 64));
        assert_eq!(normalise_mantissa(1), (1 << 31, 63));
        assert_eq!(normalise_mantissa(u64::MAX), (u32::MAX, 0));
        let mut random = Random::new();
        for i in 0..10_000 {
            let n = random.u64() >> (i & 63) | 1;
            let (m, shift) = normalise_mantissa(n);
            assert!(m >= 1 << 31);
            assert_eq!(m as u128, ((n as u128) << shift) >> 32);
            if n <= u32::MAX as u64 {
                assert_eq!(n, m as u64 >> (shift - 32));
            }
        }
    }
}
