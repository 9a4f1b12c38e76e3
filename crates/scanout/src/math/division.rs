//! Division for machines of 32 bits, where one of 64 bits is a call of hundreds of instructions.
//!
//! A divisor below 2^16 leaves remainders of 16 bits, so the dividend can be taken 16 bits at a time by 32-bit divisions, as by
//! hand; without any division, digits of eight bits are guessed from the seeds of reciprocals. Elsewhere the machine's own division
//! is as good.

use super::recip::RECIP_SEED;

/// A machine of 32 bits: 64-bit shifts and divisions are calls.
pub(crate) const NARROW: bool = cfg!(target_pointer_width = "32");

/// A machine without any division (Armv6-M, known by what else it lacks): one of 32 bits is a call of a hundred instructions.
pub(crate) const NO_DIVISION: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// A machine that has no instruction for leading zeros, and a long way to count them.
const NO_LEADING_ZEROS: bool = NO_DIVISION
    || cfg!(all(
        any(target_arch = "riscv32", target_arch = "riscv64"),
        not(target_feature = "zbb")
    ));

/// How many leading zeros `n`, which isn't 0, has.
#[inline(always)]
pub(crate) const fn leading_zeros(n: u32) -> u32 {
    if NO_LEADING_ZEROS { zeros_by_halves(n) } else { n.leading_zeros() }
}

/// The same for `n` that isn't 0, half by half.
#[inline(always)]
const fn zeros_by_halves(mut n: u32) -> u32 {
    let mut zeros = 0;
    if n >> 16 == 0 {
        (n, zeros) = (n << 16, 16);
    }
    if n >> 24 == 0 {
        (n, zeros) = (n << 8, zeros + 8);
    }
    if n >> 28 == 0 {
        (n, zeros) = (n << 4, zeros + 4);
    }
    if n >> 30 == 0 {
        (n, zeros) = (n << 2, zeros + 2);
    }
    zeros + (n >> 31 == 0) as u32
}

/// `floor((2^47 - 1) / q)` for `q` in [2^15, 2^24), without a division: four digits of eight bits, each guessed from the seeds
/// of [`recip32_newton`](super::recip32_newton), which are right to 2^-9, and set right by one at most.
#[inline(never)]
pub(crate) fn reciprocal_by_seeds(q: u32) -> u32 {
    let s = leading_zeros(q) - 8;
    let q = q << s;
    let seed = RECIP_SEED[(q >> 15) as usize & 255] as u32;
    // (2^47 - 1) 2^s: what is above 32 bits is below q; the rest is ones, then s zeros.
    let mut rest = (1i32 << (15 + s)) - 1;
    let low = u32::MAX << s;
    let mut quotient = 0u32;
    for shift in [24, 16, 8, 0] {
        let dividend = ((rest as u32) << 8) | ((low >> shift) & 255);
        let mut digit = ((dividend >> 16) * seed) >> 23;
        rest = dividend.wrapping_sub(digit.wrapping_mul(q)) as i32;
        if rest < 0 {
            rest += q as i32;
            digit -= 1;
        } else if rest >= q as i32 {
            rest -= q as i32;
            digit += 1;
        }
        quotient = (quotient << 8) + digit;
    }
    quotient
}

/// Division by `d` from 1 below 2^24 without a division: digits of eight bits, guessed from the same seeds.
///
/// The divisor is shifted up to 24 bits, and so is what remains of each digit; so a dividend, below `256 d`, has at most 32.
struct BySeeds {
    shift: u32,
    /// Shifted.
    d: u32,
    seed: u32,
    /// What remains of the digits so far, shifted.
    rest: u32,
}

impl BySeeds {
    #[inline(always)]
    fn new(d: u32) -> BySeeds {
        let shift = leading_zeros(d) - 8;
        let d = d << shift;
        BySeeds { shift, d, seed: RECIP_SEED[(d >> 15) as usize & 255] as u32, rest: 0 }
    }

    /// The quotient's next four digits, for the dividend's next word.
    #[inline(always)]
    fn digits(&mut self, word: u32) -> u32 {
        let (mut quotient, mut shift) = (0u32, 32);
        // Bytes that are zero have the digit zero.
        while self.rest == 0 && shift != 0 && word >> (shift - 8) == 0 {
            shift -= 8;
        }
        while shift != 0 {
            shift -= 8;
            let dividend = (self.rest << 8) + (((word >> shift) & 255) << self.shift);
            let mut digit = ((dividend >> 16) * self.seed) >> 23;
            let mut rest = dividend.wrapping_sub(digit.wrapping_mul(self.d));
            if rest as i32 >> 24 < 0 {
                rest = rest.wrapping_add(self.d);
                digit -= 1;
            } else if rest >= self.d {
                rest -= self.d;
                digit += 1;
            }
            self.rest = rest;
            quotient = (quotient << 8) + digit;
        }
        quotient
    }
}

/// `floor(n / d)` for `d` from 1 below 2^24.
#[inline(never)]
fn by_seeds(n: u64, d: u32) -> u64 {
    let mut division = BySeeds::new(d);
    let high = division.digits((n >> 32) as u32);
    (high as u64) << 32 | division.digits(n as u32) as u64
}

/// `floor(n / d)` for `d` from 1 below 2^24.
#[inline(always)]
pub(crate) fn quotient(n: u32, d: u32) -> u32 {
    // With 1 instead of 0, which never comes, no check remains.
    let d = d.max(1);
    if NO_DIVISION { short_by_seeds(n, d) } else { n / d }
}

#[inline(never)]
fn short_by_seeds(n: u32, d: u32) -> u32 {
    BySeeds::new(d).digits(n)
}

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
    // floor(n / d) = -1 - floor((-1 - n) / d)
    let sign = n >> 63;
    // With 1 instead of 0, which never comes, no check remains.
    let (size, d) = ((n ^ sign) as u64, (d | (d == 0) as i64) as u64);
    (if NARROW { narrow_quotient(size, d) } else { size / d }) as i64 ^ sign
}

#[inline(never)]
fn narrow_quotient(n: u64, d: u64) -> u64 {
    match d {
        ..0x100_0000 if NO_DIVISION => by_seeds(n, d as u32),
        ..0x1_0000 => by_digits(n, d as u32),
        _ => n / d,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::testing::Random;

    #[test]
    fn reciprocals_by_seeds_are_division() {
        let least = 1 << 15;
        for q in (least..1 << 24).step_by(13).chain((0..4096).map(|i| (1 << 24) - 1 - i)) {
            assert_eq!(reciprocal_by_seeds(q) as u64, ((1u64 << 47) - 1) / q as u64, "{q}");
        }
        for q in (15..24).flat_map(|bit| [(1 << bit), (1 << bit) + 1, (2 << bit) - 1]) {
            assert_eq!(reciprocal_by_seeds(q) as u64, ((1u64 << 47) - 1) / q as u64, "{q}");
        }
    }

    #[test]
    fn zeros_are_counted() {
        for bit in 0..32 {
            for n in [1u32 << bit, u32::MAX >> bit, (1 << bit) | 1] {
                assert_eq!(zeros_by_halves(n), n.leading_zeros(), "{n:#x}");
            }
        }
    }

    #[test]
    fn digits_are_division() {
        let mut random = Random::new();
        for i in 0..200_000u32 {
            let n = ((random.i32() as i64) << 32 | random.i32() as u32 as i64) >> (i % 60);
            let d = ((random.i32() as u32 >> (i % 31)) as i64).max(1);
            assert_eq!(narrow_quotient(n as u64, d as u64), n as u64 / d as u64, "{n} {d}");
            let few = (d as u32 >> 8).max(1);
            assert_eq!(by_seeds(n as u64, few), n as u64 / few as u64, "{n} {few}");
            assert_eq!(short_by_seeds(n as u32, few), n as u32 / few, "{n} {few}");
            assert_eq!(floor(n, d), n.div_euclid(d), "{n} {d}");
        }
    }
}
