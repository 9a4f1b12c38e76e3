//! Quaternions: rotations by an axis and an angle (system B, equations 9 and 10).
//!
//! ```text
//! q = cos(t / 2) + sin(t / 2) (rx i + ry j + rz k) = s + x i + y j + z k
//!
//!     | 1 - 2 (y^2 + z^2)   2 (x y - z s)       2 (x z + y s)     |
//! R = | 2 (x y + z s)       1 - 2 (x^2 + z^2)   2 (y z - x s)     |      (10)
//!     | 2 (x z - y s)       2 (y z + x s)       1 - 2 (x^2 + y^2) |
//! ```
//!
//! Components are Q2.30, in [-1, 1], rounded to nearest. A product of unit quaternions drifts from unit length by
//! less than 2^-29 a product; [`Quat::renormalise`] brings it back. An animation that sets its angle afresh (B's
//! turntable) never drifts at all.
//!
//! What it will not do: interpolate (slerp), Euler angles.

use super::fixed::saturate32;
use super::vec::normalise4;
use super::{Angle, Mat4, Q16, Vec3};
use core::ops::Mul;

/// A rotation: unit quaternion `s + x i + y j + z k`, Q2.30.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Quat {
    /// Scalar part, Q2.30.
    pub s: i32,
    /// i, Q2.30.
    pub x: i32,
    /// j, Q2.30.
    pub y: i32,
    /// k, Q2.30.
    pub z: i32,
}

impl Quat {
    /// No rotation.
    pub const IDENTITY: Quat = Quat { s: 1 << 30, x: 0, y: 0, z: 0 };

    /// Rotation by `angle` about `axis` (any length), counter-clockwise seen from the axis' tip. `None` for a zero axis.
    ///
    /// Error: at most 2^-28.5 a component. The lowest bit of `angle` (2^-32 turn) is lost in halving it.
    pub const fn from_axis_angle(axis: Vec3, angle: Angle) -> Option<Quat> {
        const fn part(sin: i32, axis: i32) -> i32 {
            ((sin as i64 * axis as i64 + (1 << 29)) >> 30) as i32
        }
        let Some(axis) = axis.normalise() else { return None };
        let (sin, cos) = Angle(angle.0 >> 1).sin_cos();
        Some(Quat { s: cos, x: part(sin, axis.x), y: part(sin, axis.y), z: part(sin, axis.z) })
    }

    /// The opposite rotation.
    pub const fn conj(self) -> Quat {
        Quat {
            s: self.s,
            x: self.x.saturating_neg(),
            y: self.y.saturating_neg(),
            z: self.z.saturating_neg(),
        }
    }

    /// Brought back to unit length, error at most 2^-29 a component. Zero gives the identity.
    pub const fn renormalise(self) -> Quat {
        match normalise4([self.s as i64, self.x as i64, self.y as i64, self.z as i64]) {
            Some([s, x, y, z]) => Quat { s, x, y, z },
            None => Quat::IDENTITY,
        }
    }

    /// The rotation's matrix (system B, equation 10), Q32.32, each entry rounded to nearest once.
    pub const fn to_mat4(self) -> Mat4 {
        let [s, x, y, z] = [self.s as i64, self.x as i64, self.y as i64, self.z as i64];
        // 2 (a b + c d): Q60 to Q32.
        const fn twice(a: i64, b: i64, c: i64, d: i64) -> i64 {
            (a * b).saturating_add(c * d).saturating_add(1 << 26) >> 27
        }
        const ONE: i64 = 1 << 32;
        Mat4 {
            m: [
                [ONE - twice(y, y, z, z), twice(x, y, -z, s), twice(x, z, y, s), 0],
                [twice(x, y, z, s), ONE - twice(x, x, z, z), twice(y, z, -x, s), 0],
                [twice(x, z, -y, s), twice(y, z, x, s), ONE - twice(x, x, y, y), 0],
                [0, 0, 0, ONE],
            ],
        }
    }

    /// The vector rotated, nearest: error at most 2^-17 + |v| 2^-26. Saturates.
    ///
    /// Cost: that of the matrix; to rotate many vectors, make the matrix once.
    pub const fn rotate(self, v: Vec3) -> Vec3 {
        const fn narrow(n: i64) -> Q16 {
            Q16(saturate32(n.saturating_add(0x8000) >> 16))
        }
        let [x, y, z] = self.to_mat4().transform_direction(v);
        Vec3 { x: narrow(x), y: narrow(y), z: narrow(z) }
    }
}

impl Default for Quat {
    /// The identity.
    fn default() -> Quat {
        Quat::IDENTITY
    }
}

impl Mul for Quat {
    type Output = Quat;
    /// Hamilton's product: first `other`, then `self`. Each component exact before one rounding to nearest; saturates.
    fn mul(self, other: Quat) -> Quat {
        fn sum(p: [(i32, i32); 4]) -> i32 {
            let total = p
                .iter()
                .fold(1i64 << 29, |total, &(a, b)| total.saturating_add(a as i64 * b as i64));
            saturate32(total >> 30)
        }
        let (a, b, n) = (self, other, self.conj());
        Quat {
            s: sum([(a.s, b.s), (n.x, b.x), (n.y, b.y), (n.z, b.z)]),
            x: sum([(a.s, b.x), (a.x, b.s), (a.y, b.z), (n.z, b.y)]),
            y: sum([(a.s, b.y), (n.x, b.z), (a.y, b.s), (a.z, b.x)]),
            z: sum([(a.s, b.z), (a.x, b.y), (n.y, b.x), (a.z, b.s)]),
        }
    }
}
