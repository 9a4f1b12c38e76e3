//! Lanes: eight pixels side by side, for machines with vector registers.
//!
//! [`U32x8`] and [`U16x8`] hold eight integers and do to each what the scalar code does to one, modulo 2^32 and 2^16. On x86-64
//! they are SSE2 registers, which every such processor has; elsewhere, and without the feature `simd`, they are arrays.
//! Both are tested to give the same bits. What they will not do: anything that is not exact.

#[cfg(any(test, not(all(feature = "simd", target_arch = "x86_64"))))]
mod array;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
mod sse2;

#[cfg(not(all(feature = "simd", target_arch = "x86_64")))]
pub use array::{U16x8, U32x8};
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
pub use sse2::{U16x8, U32x8};

/// How many pixels lie side by side.
pub const LANES: usize = 8;

/// Whether drawing eight pixels at a time pays on this machine.
pub const AVAILABLE: bool = cfg!(all(feature = "simd", target_arch = "x86_64"));

#[cfg(all(test, feature = "simd", target_arch = "x86_64"))]
mod tests {
    use super::{array, sse2};

    /// Every operation on random lanes, extremes among them: the arrays are the definition.
    #[test]
    fn sse2_is_the_array() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let v = (seed >> 32) as u32;
            [v, v, 0, u32::MAX, 0x7fff_ffff, 0x8000_0000, v & 0xffff, v << 16]
                [seed as usize >> 3 & 7]
        };
        for _ in 0..20_000 {
            let (value, step, other) = (random(), random(), random());
            let wide = (sse2::U32x8::ramp(value, step), array::U32x8::ramp(value, step));
            let sum =
                (wide.0.add(sse2::U32x8::splat(other)), wide.1.add(array::U32x8::splat(other)));
            assert_eq!(sum.0.to_array(), sum.1.to_array());
            assert_eq!(sum.0.high().to_array(), sum.1.high().to_array());
            let a: [u16; 8] = core::array::from_fn(|_| random() as u16);
            let b: [u16; 8] = core::array::from_fn(|_| random() as u16);
            let s = (sse2::U16x8::load(&a), sse2::U16x8::load(&b));
            let t = (array::U16x8::load(&a), array::U16x8::load(&b));
            assert_eq!(s.0.add(s.1).to_array(), t.0.add(t.1).to_array());
            assert_eq!(s.0.mul(s.1).to_array(), t.0.mul(t.1).to_array());
            assert_eq!(s.0.and(s.1).to_array(), t.0.and(t.1).to_array());
            assert_eq!(s.0.or(s.1).to_array(), t.0.or(t.1).to_array());
            assert_eq!(s.0.below(s.1).to_array(), t.0.below(t.1).to_array());
            assert_eq!(s.0.below(s.1).bits(), t.0.below(t.1).bits());
            assert_eq!(s.0.not_negative().to_array(), t.0.not_negative().to_array());
            let (v, w) = (value as u16, step as u16);
            assert_eq!(sse2::U16x8::ramp(v, w).to_array(), array::U16x8::ramp(v, w).to_array());
            assert_eq!(s.0.shl::<3>().to_array(), t.0.shl::<3>().to_array());
            assert_eq!(s.0.shr::<5>().to_array(), t.0.shr::<5>().to_array());
            for count in 0..10 {
                let (m, n) = (sse2::U16x8::first(count), array::U16x8::first(count));
                assert_eq!(m.to_array(), n.to_array());
                assert_eq!(m.select(s.0, s.1).to_array(), n.select(t.0, t.1).to_array());
            }
        }
    }
}
