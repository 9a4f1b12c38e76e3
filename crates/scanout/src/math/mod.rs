//! Fixed-point arithmetic: everything the vertex stages compute with, in integers alone.
//!
//! | type or function | format | range | rounding |
//! |---|---|---|---|
//! | [`Q16`] | Q16.16 in an i32 | [-32768, 32768) | see each operation |
//! | [`Angle`] | U0.32 turns in a u32 | wraps | nearest |
//! | [`Vec3`] | 3 x Q16.16 | as Q16 | see each operation |
//! | [`Unit3`], [`Quat`] | Q2.30 in i32s | [-2, 2), in use [-1, 1] | nearest |
//! | [`Mat4`] | 4 x 4 Q32.32 in i64s, row major, column vectors | +-2^31 | nearest |
//! | [`isqrt32`], [`isqrt64`] | integers | all | floor |
//! | [`recip32`] | 32-bit mantissa | [2^31, 2^32) | floor |
//!
//! Contract of the module: **nothing here panics**, for any input, in debug builds too. A sum that
//! leaves its format saturates; the product `Q16 * Q16` keeps the middle 32 bits as hardware does;
//! what has no answer (the direction of a zero vector) is an `Option`.
//!
//! Floating point appears only in `from_f64` and `to_f64`: host conveniences at the door, never
//! called by the pipeline.
//!
//! What it will not do: arbitrary formats, logarithms, inverse trigonometry.

mod division;
mod fixed;
mod mat;
mod product;
mod quat;
mod recip;
mod root;
mod trig;
mod unit;
mod vec;

pub(crate) use division::{
    NARROW, NO_DIVISION, floor, leading_zeros, quotient, reciprocal_by_seeds,
};
pub use fixed::Q16;
pub use mat::Mat4;
pub use quat::Quat;
pub use recip::{normalise_mantissa, recip32, recip32_newton};
pub use root::{isqrt32, isqrt64, rsqrt32};
pub use trig::Angle;
pub use unit::{Unit3, normalise, normalise_q14};
pub use vec::Vec3;

/// The tables, for circuits and firmware that hold them in a ROM of their own.
pub mod tables {
    pub use super::recip::RECIP_SEED;
    pub use super::root::RSQRT_SEED;
    pub use super::trig::SINE;
}

pub(crate) use fixed::{add_product, div_by_large, div_nearest, q32_from_f64};
pub(crate) use fixed::{saturate32, saturate64, shift_right_nearest};
pub(crate) use product::{high_product, mixed_product};

/// Tells the compiler which way of two is the rarer one.
#[cold]
#[inline(always)]
pub(crate) fn seldom() {}

/// Registers are so few that a branch in a loop moves others about.
const FEW_REGISTERS: bool = cfg!(target_arch = "arm");

/// The larger one, `v` as a rule.
#[inline(always)]
pub(crate) fn at_least<T: Ord + Copy>(v: T, least: T) -> T {
    if FEW_REGISTERS {
        return v.max(least);
    }
    if v < least {
        seldom();
        return least;
    }
    v
}

/// The smaller one, `v` as a rule.
#[inline(always)]
pub(crate) fn at_most<T: Ord + Copy>(v: T, most: T) -> T {
    if FEW_REGISTERS {
        return v.min(most);
    }
    if v > most {
        seldom();
        return most;
    }
    v
}

#[cfg(test)]
pub(crate) mod testing {
    //! A generator of test numbers (xorshift64*), the same numbers in every run.

    pub(crate) struct Random(pub(crate) u64);

    impl Random {
        pub(crate) fn new() -> Self {
            Random(0x9e37_79b9_7f4a_7c15)
        }

        pub(crate) fn u64(&mut self) -> u64 {
            self.0 ^= self.0 >> 12;
            self.0 ^= self.0 << 25;
            self.0 ^= self.0 >> 27;
            self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
        }

        pub(crate) fn u32(&mut self) -> u32 {
            (self.u64() >> 32) as u32
        }

        pub(crate) fn i32(&mut self) -> i32 {
            self.u32() as i32
        }

        /// Any magnitude alike: a random i32 shifted down by 0 - 31 bits.
        pub(crate) fn spread(&mut self) -> i32 {
            let n = self.i32();
            n >> (self.u32() & 31)
        }

        /// In [low, high].
        pub(crate) fn range(&mut self, low: i64, high: i64) -> i64 {
            low + (self.u64() % (high - low + 1) as u64) as i64
        }

        /// In [-1, 1).
        pub(crate) fn unit(&mut self) -> f64 {
            self.i32() as f64 / 2147483648.0
        }
    }
}
