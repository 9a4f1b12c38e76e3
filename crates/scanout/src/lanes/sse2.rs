//! Lanes as SSE2 registers, which are part of x86-64: nothing to detect.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::LANES;

/// Calls intrinsics.
macro_rules! sse2 {
    ($e:expr) => {{
        // SAFETY: SSE2 is part of x86-64, and nothing else is asked of the caller by the intrinsics used here, which work on
        // values; the two that touch memory say more where they are.
        #[allow(clippy::macro_metavars_in_unsafe)]
        unsafe {
            $e
        }
    }};
}

/// Eight `u32`: lanes 0 - 3 and 4 - 7.
#[derive(Clone, Copy, Debug)]
pub struct U32x8([__m128i; 2]);

/// Eight `u16`. A mask has all bits of a lane set or none.
#[derive(Clone, Copy, Debug)]
pub struct U16x8(__m128i);

impl U32x8 {
    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(value: u32) -> Self {
        Self([sse2!(_mm_set1_epi32(value as i32)); 2])
    }
    /// `value + i step` in lane i, modulo 2^32.
    #[inline(always)]
    pub fn ramp(value: u32, step: u32) -> Self {
        let step = |n: u32| step.wrapping_mul(n) as i32;
        sse2!({
            let low = _mm_set_epi32(step(3), step(2), step(1), 0);
            let low = _mm_add_epi32(low, _mm_set1_epi32(value as i32));
            Self([low, _mm_add_epi32(low, _mm_set1_epi32(step(4)))])
        })
    }
    /// The sum modulo 2^32.
    #[inline(always)]
    pub fn add(self, other: Self) -> Self {
        sse2!(Self([_mm_add_epi32(self.0[0], other.0[0]), _mm_add_epi32(self.0[1], other.0[1])]))
    }
    /// The lanes.
    #[inline(always)]
    pub fn to_array(self) -> [u32; LANES] {
        let mut lanes = [0; LANES];
        let (low, high) = lanes.split_at_mut(LANES / 2);
        // SAFETY: each half is the 16 bytes that are written; the instruction asks no alignment.
        unsafe {
            _mm_storeu_si128(low.as_mut_ptr().cast(), self.0[0]);
            _mm_storeu_si128(high.as_mut_ptr().cast(), self.0[1]);
        }
        lanes
    }
    /// The upper halves. A signed shift leaves them in range of the pack, which keeps their bits.
    #[inline(always)]
    pub fn high(self) -> U16x8 {
        let [low, high] = self.0;
        sse2!(U16x8(_mm_packs_epi32(_mm_srai_epi32::<16>(low), _mm_srai_epi32::<16>(high))))
    }
}

impl U16x8 {
    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(value: u16) -> Self {
        sse2!(Self(_mm_set1_epi16(value as i16)))
    }
    /// Reads memory.
    #[inline(always)]
    pub fn load(from: &[u16; LANES]) -> Self {
        // SAFETY: the reference covers the 16 bytes read, and the instruction asks no alignment. There is no safe way to
        // name this instruction; `array::U16x8::load` is the twin it is tested against.
        Self(unsafe { _mm_loadu_si128(from.as_ptr().cast()) })
    }
    /// Writes memory.
    #[inline(always)]
    pub fn store(self, to: &mut [u16; LANES]) {
        // SAFETY: as in `load`; the reference is exclusive.
        unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), self.0) }
    }
    /// The lanes.
    #[cfg(test)]
    pub fn to_array(self) -> [u16; LANES] {
        let mut lanes = [0; LANES];
        self.store(&mut lanes);
        lanes
    }
    /// `value + i step` in lane i, modulo 2^16.
    #[inline(always)]
    pub fn ramp(value: u16, step: u16) -> Self {
        sse2!({
            let lane = _mm_set_epi16(7, 6, 5, 4, 3, 2, 1, 0);
            let ramp = _mm_mullo_epi16(_mm_set1_epi16(step as i16), lane);
            Self(_mm_add_epi16(_mm_set1_epi16(value as i16), ramp))
        })
    }
    /// A mask of the lanes whose top bit is clear: not negative as signed numbers.
    #[inline(always)]
    pub fn not_negative(self) -> Self {
        sse2!({
            let zero = _mm_setzero_si128();
            Self(_mm_cmpeq_epi16(_mm_srai_epi16::<15>(self.0), zero))
        })
    }
    /// A mask of the first `count` lanes.
    #[inline(always)]
    pub fn first(count: usize) -> Self {
        sse2!({
            let lane = _mm_set_epi16(7, 6, 5, 4, 3, 2, 1, 0);
            Self(_mm_cmpgt_epi16(_mm_set1_epi16(count.min(LANES) as i16), lane))
        })
    }
    /// A mask of the lanes that are smaller than the other's: those where the other's saturating difference is not 0.
    #[inline(always)]
    pub fn below(self, other: Self) -> Self {
        sse2!({
            let zero = _mm_setzero_si128();
            let not = _mm_cmpeq_epi16(_mm_subs_epu16(other.0, self.0), zero);
            Self(_mm_xor_si128(not, _mm_cmpeq_epi16(zero, zero)))
        })
    }
    /// Of a mask: bit i is set where lane i is.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        sse2!(_mm_movemask_epi8(_mm_packs_epi16(self.0, _mm_setzero_si128()))) as u32
    }
    /// Of a mask: `yes` where set, `no` elsewhere.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        sse2!(Self(_mm_or_si128(_mm_and_si128(self.0, yes.0), _mm_andnot_si128(self.0, no.0))))
    }
    /// The sum modulo 2^16.
    #[inline(always)]
    pub fn add(self, other: Self) -> Self {
        sse2!(Self(_mm_add_epi16(self.0, other.0)))
    }
    /// The product modulo 2^16.
    #[inline(always)]
    pub fn mul(self, other: Self) -> Self {
        sse2!(Self(_mm_mullo_epi16(self.0, other.0)))
    }
    /// Bitwise and.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        sse2!(Self(_mm_and_si128(self.0, other.0)))
    }
    /// Bitwise or.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        sse2!(Self(_mm_or_si128(self.0, other.0)))
    }
    /// Shifted left by N bits.
    #[inline(always)]
    pub fn shl<const N: i32>(self) -> Self {
        sse2!(Self(_mm_slli_epi16::<N>(self.0)))
    }
    /// Shifted right by N bits.
    #[inline(always)]
    pub fn shr<const N: i32>(self) -> Self {
        sse2!(Self(_mm_srli_epi16::<N>(self.0)))
    }
}
