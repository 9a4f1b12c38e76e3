//! Interpolate: attributes as plane equations, evaluated exactly at pixel centres.
//!
//! ```text
//! a(x, y) = c + gx x + gy y      (modulo 2^32)      x, y: pixel column and row of the frame
//! ```
//!
//! `c`, `gx` and `gy` are rounded once, in [`setup`](crate::setup); from then on the value of a pixel is an exact integer
//! function of its place, so the order in which pixels are visited cannot change it. The arithmetic is modulo 2^32: in
//! a sliver the gradients may exceed 32 bits, but at a covered pixel the true value is back in range, and so is the
//! wrapped one.
//!
//! | attribute | format of `a` | error at a covered pixel of a triangle of up to 4096 pixels |
//! |---|---|---|
//! | depth | U16.16 | 1/16 step |
//! | colour channel | U8.16 (in 32 bits) | 1/16 level |
//! | 1/w (`q`) | U24.8, the largest of the three in [2^22, 2^23) | 2^-18 of the largest |
//! | s/w, t/w | U32.0, the largest of the three below 2^31 | 2^-18 of the largest |
//!
//! What it will not do: extrapolate. Only pixels whose centre is inside the triangle may be asked.

/// An attribute's plane over the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Plane {
    /// Value at pixel (0, 0), modulo 2^32.
    pub c: u32,
    /// Change from one column to the next, modulo 2^32.
    pub gx: u32,
    /// Change from one row to the next, modulo 2^32.
    pub gy: u32,
}

impl Plane {
    /// The plane that is `value` everywhere.
    #[inline]
    pub const fn constant(value: u32) -> Plane {
        Plane { c: value, gx: 0, gy: 0 }
    }

    /// The value at pixel (x, y).
    #[inline(always)]
    pub fn at(&self, x: i32, y: i32) -> u32 {
        self.c
            .wrapping_add(self.gx.wrapping_mul(x as u32))
            .wrapping_add(self.gy.wrapping_mul(y as u32))
    }
}

/// A plane whose arithmetic is modulo 2^64.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WidePlane {
    /// Value at pixel (0, 0).
    pub c: u64,
    /// Change from one column to the next.
    pub gx: u64,
    /// Change from one row to the next.
    pub gy: u64,
}

impl WidePlane {
    /// The value at pixel (x, y).
    #[inline(always)]
    pub(crate) fn at(&self, x: i32, y: i32) -> u64 {
        self.c
            .wrapping_add(self.gx.wrapping_mul(x as u64))
            .wrapping_add(self.gy.wrapping_mul(y as u64))
    }
}

/// A colour channel's plane value (U8.16) rounded to nearest: 0 - 255.
#[inline(always)]
pub fn channel(value: u32) -> u8 {
    (value.wrapping_add(0x8000) >> 16) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_and_comes_back() {
        // A gradient of 2^31 a column overflows on the way and is exact on arrival.
        let plane = Plane { c: 7, gx: 1 << 31, gy: 3 };
        assert_eq!(plane.at(2, 5), 22);
        assert_eq!(plane.at(-2, -2), 1);
    }

    #[test]
    fn channel_rounds_to_nearest() {
        assert_eq!(channel(255 << 16), 255);
        assert_eq!(channel((254 << 16) + 0x7fff), 254);
        assert_eq!(channel((254 << 16) + 0x8000), 255);
        assert_eq!(channel(0u32.wrapping_sub(0x1000)), 0);
    }
}
