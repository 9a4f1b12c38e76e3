//! Lanes as arrays: the definition.
// Beside SSE2 it is there to be compared, not used.
#![cfg_attr(test, allow(dead_code))]

use super::LANES;

/// Eight `u32`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct U32x8([u32; LANES]);

/// Eight `u16`. A mask has all bits of a lane set or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct U16x8([u16; LANES]);

impl U32x8 {
    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(value: u32) -> Self {
        Self([value; LANES])
    }
    /// `value + i step` in lane i, modulo 2^32.
    #[inline(always)]
    pub fn ramp(value: u32, step: u32) -> Self {
        Self(core::array::from_fn(|i| value.wrapping_add(step.wrapping_mul(i as u32))))
    }
    /// The sum modulo 2^32.
    #[inline(always)]
    pub fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i].wrapping_add(other.0[i])))
    }
    /// The lanes.
    #[inline(always)]
    pub fn to_array(self) -> [u32; LANES] {
        self.0
    }
    /// The upper halves.
    #[inline(always)]
    pub fn high(self) -> U16x8 {
        U16x8(self.0.map(|v| (v >> 16) as u16))
    }
}

impl U16x8 {
    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(value: u16) -> Self {
        Self([value; LANES])
    }
    /// Reads memory.
    #[inline(always)]
    pub fn load(from: &[u16; LANES]) -> Self {
        Self(*from)
    }
    /// Writes memory.
    #[inline(always)]
    pub fn store(self, to: &mut [u16; LANES]) {
        *to = self.0;
    }
    /// The lanes.
    #[cfg(test)]
    pub fn to_array(self) -> [u16; LANES] {
        self.0
    }
    /// `value + i step` in lane i, modulo 2^16.
    #[inline(always)]
    pub fn ramp(value: u16, step: u16) -> Self {
        Self(core::array::from_fn(|i| value.wrapping_add(step.wrapping_mul(i as u16))))
    }
    /// A mask of the lanes whose top bit is clear: not negative as signed numbers.
    #[inline(always)]
    pub fn not_negative(self) -> Self {
        Self(self.0.map(|v| if v >> 15 == 0 { 0xffff } else { 0 }))
    }
    /// A mask of the first `count` lanes.
    #[inline(always)]
    pub fn first(count: usize) -> Self {
        Self(core::array::from_fn(|i| if i < count { 0xffff } else { 0 }))
    }
    /// A mask of the lanes that are smaller than the other's.
    #[inline(always)]
    pub fn below(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| if self.0[i] < other.0[i] { 0xffff } else { 0 }))
    }
    /// Of a mask: bit i is set where lane i is.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        (0..LANES).fold(0, |bits, i| bits | (self.0[i] as u32 >> 15) << i)
    }
    /// Of a mask: `yes` where set, `no` elsewhere.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        Self(core::array::from_fn(|i| (self.0[i] & yes.0[i]) | (!self.0[i] & no.0[i])))
    }
    /// The sum modulo 2^16.
    #[inline(always)]
    pub fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i].wrapping_add(other.0[i])))
    }
    /// The product modulo 2^16.
    #[inline(always)]
    pub fn mul(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i].wrapping_mul(other.0[i])))
    }
    /// Bitwise and.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] & other.0[i]))
    }
    /// Bitwise or.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] | other.0[i]))
    }
    /// Shifted left by N bits.
    #[inline(always)]
    pub fn shl<const N: i32>(self) -> Self {
        Self(self.0.map(|v| v << N))
    }
    /// Shifted right by N bits.
    #[inline(always)]
    pub fn shr<const N: i32>(self) -> Self {
        Self(self.0.map(|v| v >> N))
    }
}
