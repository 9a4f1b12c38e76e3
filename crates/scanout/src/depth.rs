//! Depth: a 16-bit z-buffer, 0 at the near plane, 65535 at the far plane and where nothing is drawn.
//!
//! Depth is linear on the screen (z/w), so it is a [`Plane`] in U16.16. A fragment's depth is
//! that rounded to nearest; the fragment passes when strictly nearer than what is stored, so of two equal ones the
//! first drawn stays. What it will not do: a linear-in-distance buffer.

use crate::interpolate::Plane;
use crate::math::seldom;

/// What the depth memory holds where nothing has been drawn.
pub const FAR: u16 = 0xffff;

/// The largest depth of a vertex, U16.16: 65535.0.
pub const MAX: u32 = 0xffff_0000;

/// Half a step of a plane's value.
pub(crate) const HALF: u32 = 0x8000;

/// A plane's value (U16.16) rounded to nearest.
#[inline(always)]
pub fn round(value: u32) -> u16 {
    (value.wrapping_add(HALF) >> 16) as u16
}

/// A depth plane with half a step added: [`whole`] of its values is [`round`] of the plane's.
#[inline(always)]
pub fn biased(z: &Plane) -> Plane {
    Plane { c: z.c.wrapping_add(HALF), ..*z }
}

/// The whole steps of a [`biased`] plane's value.
#[inline(always)]
pub fn whole(value: u32) -> u16 {
    (value >> 16) as u16
}

/// Tests a fragment and stores its depth when it passes.
#[inline(always)]
pub fn test(stored: &mut u16, depth: u16) -> bool {
    let pass = depth < *stored;
    if pass {
        *stored = depth;
    } else {
        seldom();
    }
    pass
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearer_passes_equal_does_not() {
        let mut stored = FAR;
        assert!(test(&mut stored, 100));
        assert!(!test(&mut stored, 100));
        assert!(!test(&mut stored, 101));
        assert!(test(&mut stored, 99));
        assert_eq!(stored, 99);
    }

    #[test]
    fn the_largest_vertex_depth_does_not_wrap() {
        assert_eq!(round(MAX), 0xffff);
        assert_eq!(round(MAX + 0x7fff), 0xffff);
        assert_eq!(round(0), 0);
    }
}
