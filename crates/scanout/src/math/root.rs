//! Square roots of integers.
//!
//! - [`isqrt32`], [`isqrt64`]: `floor(sqrt(n))`, exact for every input, by the bit-a-step method: 16 or 32 steps of one
//!   comparison, one subtraction and shifts; no division and no multiplication, so a circuit makes a bit a clock.
//! - [`rsqrt32`]: `2^46 / sqrt(m)` by a table and one Newton step, for normalising vectors at pixels.
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
/// Cost: 32 steps without multiplication or division.
pub const fn isqrt64(n: u64) -> u32 {
    let (mut rest, mut root, mut bit) = (n, 0u64, 1u64 << 62);
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

/// Seeds of [`rsqrt32`]: `2^31 / sqrt(m)` at the middle of each of the 384 steps of 2^23 in [2^30, 2^32). 768 bytes.
static RSQRT_SEED: [u16; 384] = {
    let mut table = [0; 384];
    let mut i = 0;
    while i < 384 {
        // m = (2 (128 + i) + 1) 2^22, so 2^31 / sqrt(m) = sqrt(2^40 / (2 (128 + i) + 1)).
        table[i] = isqrt64((1 << 40) / (2 * (128 + i as u64) + 1)) as u16;
        i += 1;
    }
    table
};

/// About `2^46 / sqrt(m)` for `m` in [2^30, 2^32): a result in (2^30 - 2^14, 2^31], relative error in (-2^-16.9, 0].
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
