//! How far a head leans to a shoulder.

/// A turn in the picture, as cosine and sine, Q.8; the sine is positive when the head's right in the picture is lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lean {
    pub(super) cos: i32,
    pub(super) sin: i32,
}

impl Lean {
    /// Upright.
    pub const NONE: Self = Self { cos: 256, sin: 0 };

    /// About 25 degrees each way: with [`NONE`](Self::NONE), each within 12 degrees of the next where heads are.
    pub(super) const SIDES: [Self; 2] = [Self { cos: 232, sin: -108 }, Self { cos: 232, sin: 108 }];

    /// That of a level line that now points along (`right`, `down`); upright for nothing.
    pub fn along(right: f64, down: f64) -> Self {
        let length = libm::hypot(right, down);
        if length.is_nan() || length <= 0.0 {
            return Self::NONE;
        }
        let [cos, sin] = [right, down].map(|x| libm::round(256.0 * x / length) as i32);
        Self { cos, sin }
    }

    /// How far the picture must go on about a box's middle: codes reach from -128 to 127, and places are rounded down.
    pub(super) fn reach(self, side: i32) -> i32 {
        (((self.cos.abs() + self.sin.abs()) * side) >> 9) + 1
    }

    /// The head's (right, down) in the picture, times 256.
    pub(super) fn turned(self, [right, down]: [i64; 2]) -> [i64; 2] {
        let (cos, sin) = (i64::from(self.cos), i64::from(self.sin));
        [right * cos - down * sin, right * sin + down * cos]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_line_becomes_that_line() {
        let lean = Lean::along(3.0, 4.0);
        assert_eq!((lean.cos, lean.sin), (154, 205));
        assert_eq!(lean.turned([10, 0]), [1540, 2050]);
        assert_eq!(lean.turned([0, 10]), [-2050, 1540]);
        assert_eq!(Lean::along(0.0, 0.0), Lean::NONE);
        assert_eq!(Lean::along(5.0, 0.0), Lean::NONE);
    }
}
