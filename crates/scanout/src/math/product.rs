//! Products of 32 x 32 bits: 64 bits, for machines whose own product has 32; upper halves of those of 64 x 64 bits.

use super::NO_DIVISION;

/// `a b`.
#[inline(always)]
pub(crate) const fn product(a: u32, b: u32) -> u64 {
    // Armv6-M has no long product either, and the compiler's call multiplies 64 bits by 64.
    if NO_DIVISION { by_halves(a, b) } else { a as u64 * b as u64 }
}

/// `a b`.
#[inline(always)]
pub(crate) const fn mixed_product(a: i32, b: u32) -> i64 {
    if !NO_DIVISION {
        return a as i64 * b as i64;
    }
    let over = (a >> 31) as u32 & b;
    (by_halves(a as u32, b) as i64).wrapping_sub((over as i64) << 32)
}

/// The upper half of a product of 64 x 64 bits: one instruction where registers have 64.
#[inline(always)]
pub(crate) const fn high_product(a: u64, b: u64) -> u64 {
    ((a as u128 * b as u128) >> 64) as u64
}

/// By four products of 16 x 16 bits.
#[inline(never)]
const fn by_halves(a: u32, b: u32) -> u64 {
    let (a0, a1, b0, b1) = (a & 0xffff, a >> 16, b & 0xffff, b >> 16);
    let low = a0 * b0;
    // (2^16 - 1)^2 + 2^16 - 1 < 2^32
    let middle = a1 * b0 + (low >> 16);
    let other = a0 * b1 + (middle & 0xffff);
    let high = a1 * b1 + (middle >> 16) + (other >> 16);
    (high as u64) << 32 | ((other << 16) | (low & 0xffff)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::testing::Random;

    #[test]
    fn halves_are_the_product() {
        let mut random = Random::new();
        let ends = [0, 1, 0xffff, 0x1_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_0000, u32::MAX];
        let pairs = ends.into_iter().flat_map(|a| ends.map(|b| (a, b)));
        let more = (0..100_000).map(|_| (random.spread() as u32, random.u32()));
        for (a, b) in pairs.chain(more) {
            assert_eq!(by_halves(a, b), a as u64 * b as u64, "{a} {b}");
            let s = a as i32;
            let over = (s >> 31) as u32 & b;
            let mixed = (by_halves(a, b) as i64).wrapping_sub((over as i64) << 32);
            assert_eq!(mixed, s as i64 * b as i64, "{s} {b}");
        }
    }
}
