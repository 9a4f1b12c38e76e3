//! Square roots of integers.
//!
//! - [`isqrt32`], [`isqrt64`]: `floor(sqrt(n))`, exact for every input, by the bit-a-step method:
//!   16 or 32 steps of one
//!   comparison, one subtraction and shifts, so a circuit makes a bit a clock.
//! - [`rsqrt32`]: `2^46 / sqrt(m)` by a table and one Newton step, for normalising vectors at
//!   pixels.
//!
//! What it will not do: roots of fractions (shift first), cube roots.

/// `floor(sqrt(n))`, exact.
///
/// Cost: 16 steps without multiplication or division.
pub const fn isqrt32(n: u32) -> u16 {
    let (mut rest, mut root, mut bit) = (n, 0u32, 1u32 << 30);
    while bit != 0 {
        if rest >= root + bit {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
        bit >>= 2;
    }
    root as u16
}

/// `floor(sqrt(n))`, exact.
///
/// Cost: a step for each two bits of `n`, without multiplication or division.
#[inline(never)]
pub const fn isqrt64(n: u64) -> u32 {
    // The highest even power of two in n; 1 for 0.
    let (mut rest, mut root, mut bit) = (n, 0u64, 1u64 << ((63 - (n | 1).leading_zeros()) & !1));
    while bit != 0 {
        if rest >= root + bit {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
        bit >>= 2;
    }
    root as u32
}

/// Seeds of [`rsqrt32`]: `2^31 / sqrt(m)` at the middle of each of the 384 steps of 2^23 in [2^30,
/// 2^32). 768 bytes.
pub static RSQRT_SEED: [u16; 384] = {
    let mut table = [0; 384];
    let mut i = 0;
    while i < 384 {
        // m = (2 (128 + i) + 1) 2^22, so 2^31 / sqrt(m) = sqrt(2^40 / (2 (128 + i) + 1)).
        table[i] = isqrt64((1 << 40) / (2 * (128 + i as u64) + 1)) as u16;
        i += 1;
    }
    table
};

/// About `2^46 / sqrt(m)` for `m` in [2^30, 2^32): a result in [2^30 - 2^13, 2^31],
/// relative error in [-2^-17.4, 2^-31].
///
/// The closed form is the definition, and all three machines share it:
///
/// ```text
/// s  = seed[(m >> 23) - 128]                  16 bits, s = floor(sqrt(2^40 / (2 (m >> 23) + 1)))
/// e  = 3 * 2^30 - floor(s^2 m / 2^32)         s^2 m / 2^32 is about 2^30
/// y  = floor(s e / 2^16)                      Newton: y = s (3 - m s^2) / 2
/// ```
///
/// Cost: a table read and three products of 32 x 32 bits at most. A smaller `m` is read as 2^30.
#[inline]
pub const fn rsqrt32(m: u32) -> u32 {
    let m = if m < 1 << 30 { 1 << 30 } else { m };
    let s = RSQRT_SEED[(m >> 23) as usize - 128] as u32;
    let square = (s as u64 * s as u64) as u32 as u64; // below 2^32
    let e = (3u64 << 30) - ((square * m as u64) >> 32);
    ((s as u64 * e) >> 16) as u32
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;

    #[test]
    fn roots_are_exact_about_every_square_of_16_bits() {
        for root in 0..=0xffffu32 {
            let square = root * root;
            assert_eq!(isqrt32(square), root as u16);
            assert_eq!(isqrt64(square as u64), root);
            if root > 0 {
                assert_eq!(isqrt32(square - 1), root as u16 - 1);
            }
            assert_eq!(isqrt32(square + root), root as u16);
        }
        assert_eq!(isqrt32(u32::MAX), 0xffff);
    }

    #[test]
    fn roots_are_exact_for_64_bits() {
        let mut random = Random::new();
        for i in 0..200_000u64 {
            let root = if i < 1000 { u32::MAX - i as u32 } else { random.u32() >> (i & 31) };
            let square = root as u64 * root as u64;
            assert_eq!(isqrt64(square), root);
            assert_eq!(isqrt64(square + 2 * root as u64), root);
            if root > 0 {
                assert_eq!(isqrt64(square - 1), root - 1);
            }
            let n = random.u64() >> (i & 63);
            assert_eq!(isqrt64(n) as u64, n.isqrt());
            assert_eq!(isqrt32(n as u32), (n as u32).isqrt() as u16);
        }
        assert_eq!(isqrt64(u64::MAX), u32::MAX);
    }

    #[test]
    fn reciprocal_root_stays_within_its_bound() {
        let (mut least, mut most) = (0.0f64, -1.0f64);
        let dense = ((1u32 << 30)..=u32::MAX).step_by(4093);
        let edges = (128..512u32).flat_map(|i| [i << 23, (i << 23) + 0x7f_ffff]);
        for m in dense.chain(edges) {
            let exact = 70368744177664.0 / (m as f64).sqrt();
            let error = rsqrt32(m) as f64 / exact - 1.0;
            (least, most) = (least.min(error), most.max(error));
        }
        std::println!("rsqrt32: relative error in [2^{}, {most:e}]", (-least).log2());
        assert!(most <= 2.0f64.powi(-31) && least >= -(2.0f64.powf(-17.4)));
        assert_eq!(rsqrt32(u32::MAX) >> 13, (1 << 17) - 1);
        assert!(rsqrt32(1 << 30) <= 1 << 31);
        assert_eq!(rsqrt32(0), rsqrt32(1 << 30));
    }
}
