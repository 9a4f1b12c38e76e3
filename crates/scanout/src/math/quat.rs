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
//! Components are Q2.30, in [-1, 1], rounded to nearest. A product of unit quaternions drifts from
//! unit length by less than 2^-29 a product; [`Quat::renormalise`] brings it back. An animation
//! that sets its angle afresh (B's turntable) never drifts at all.
//!
//! What it will not do: interpolate (slerp), Euler angles.

use super::fixed::saturate32;
use super::unit::normalise4;
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

    /// Rotation by `angle` about `axis` (any length), counter-clockwise seen from the axis' tip.
    /// `None` for a zero axis.
    ///
    /// Error: at most 2^-28.5 a component. The lowest bit of `angle` (2^-32 turn) is lost in
    /// halving it.
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
    ///
    /// Made from [`Quat::from_axis_angle`], an entry is off by at most 2^-26.5.
    pub const fn to_mat4(self) -> Mat4 {
        let Quat { s, x, y, z } = self;
        let (nx, ny, nz) = (x.saturating_neg(), y.saturating_neg(), z.saturating_neg());
        // 2 (a b + c d): Q60 to Q32.
        #[inline(never)]
        const fn twice(a: i32, b: i32, c: i32, d: i32) -> i64 {
            let sum = (a as i64 * b as i64).saturating_add(c as i64 * d as i64);
            sum.saturating_add(1 << 26) >> 27
        }
        const ONE: i64 = 1 << 32;
        Mat4 {
            m: [
                [ONE - twice(y, y, z, z), twice(x, y, nz, s), twice(x, z, y, s), 0],
                [twice(x, y, z, s), ONE - twice(x, x, z, z), twice(y, z, nx, s), 0],
                [twice(x, z, ny, s), twice(y, z, x, s), ONE - twice(x, x, y, y), 0],
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
    /// Hamilton's product: first `other`, then `self`. Each component exact before one rounding to
    /// nearest; saturates.
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

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;
    use std::f64::consts::TAU;

    fn axis_angle(random: &mut Random) -> (Vec3, Angle) {
        let axis = Vec3::from_f64([random.unit(), random.unit(), random.unit()].map(|x| x * 9.0));
        (axis, Angle(random.u32()))
    }

    /// Rodrigues' formula: another road than the quaternion's.
    fn rodrigues(axis: Vec3, angle: Angle) -> [[f64; 3]; 3] {
        let a = axis.to_f64();
        let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
        let a = a.map(|x| x / length);
        let (sin, cos) = (angle.0 as f64 / 4294967296.0 * TAU).sin_cos();
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        let mut m = [[0.0; 3]; 3];
        for r in 0..3 {
            for c in 0..3 {
                let same = if r == c { cos } else { 0.0 };
                m[r][c] = same + (1.0 - cos) * a[r] * a[c] + sin * cross[r][c];
            }
        }
        m
    }

    #[test]
    fn system_b_equation_10_is_the_rotation_matrix() {
        let mut random = Random::new();
        let mut worst = 0.0f64;
        for _ in 0..50_000 {
            let (axis, angle) = axis_angle(&mut random);
            let Some(q) = Quat::from_axis_angle(axis, angle) else { continue };
            let (m, exact) = (q.to_mat4().to_f64(), rodrigues(axis, angle));
            for r in 0..3 {
                for c in 0..3 {
                    worst = worst.max((m[r][c] - exact[r][c]).abs());
                }
            }
            assert_eq!(m[3], [0.0, 0.0, 0.0, 1.0]);
        }
        std::println!("to_mat4 of from_axis_angle: error 2^{}", worst.log2());
        assert!(worst <= 2.0f64.powf(-26.5));
        assert_eq!(Quat::from_axis_angle(Vec3::ZERO, Angle::HALF), None);
        assert_eq!(Quat::IDENTITY.to_mat4(), Mat4::IDENTITY);
        let y = Quat::from_axis_angle(Vec3::Y, Angle::QUARTER).unwrap();
        assert_eq!(y.rotate(Vec3::Z), Vec3::X);
    }

    #[test]
    fn system_b_90_steps_of_4_degrees_return_to_the_start() {
        let axis = Vec3::from_f64([0.3, 1.0, -0.2]);
        let at = |step: i16| {
            let angle = Angle::from_degrees(Q16::from_int(4 * step));
            Quat::from_axis_angle(axis, angle).unwrap().to_mat4()
        };
        assert_eq!(at(90), at(0));
        assert_eq!(at(90 * 91), at(0));
        assert_eq!(at(0), Mat4::IDENTITY);
        for step in 1..90 {
            assert_ne!(at(step), at(0));
            assert_eq!(at(step), at(step + 90), "{step}");
        }
    }

    #[test]
    fn products_compose_and_conjugates_undo() {
        let mut random = Random::new();
        for _ in 0..20_000 {
            let ((a, t), (b, u)) = (axis_angle(&mut random), axis_angle(&mut random));
            let (Some(p), Some(q)) = (Quat::from_axis_angle(a, t), Quat::from_axis_angle(b, u))
            else {
                continue;
            };
            let (m, n) = ((p * q).to_mat4().to_f64(), (p.to_mat4() * q.to_mat4()).to_f64());
            let back = (p * p.conj()).to_mat4().to_f64();
            for r in 0..4 {
                for c in 0..4 {
                    assert!((m[r][c] - n[r][c]).abs() <= 2.0f64.powi(-26));
                    let same = if r == c { 1.0 } else { 0.0 };
                    assert!((back[r][c] - same).abs() <= 2.0f64.powi(-27));
                }
            }
        }
        // i j = k
        let i = Quat { s: 0, x: 1 << 30, y: 0, z: 0 };
        let j = Quat { s: 0, x: 0, y: 1 << 30, z: 0 };
        assert_eq!(i * j, Quat { s: 0, x: 0, y: 0, z: 1 << 30 });
        assert_eq!(j * i, Quat { s: 0, x: 0, y: 0, z: -(1 << 30) });
    }

    #[test]
    fn renormalise_brings_back_unit_length() {
        let step = Quat::from_axis_angle(Vec3::from_f64([1.0, 2.0, 3.0]), Angle(123_456_789));
        let mut q = Quat::IDENTITY;
        for _ in 0..10_000 {
            q = (q * step.unwrap()).renormalise();
        }
        let length = |q: Quat| {
            [q.s, q.x, q.y, q.z].iter().map(|&n| (n as f64 / 1073741824.0).powi(2)).sum::<f64>()
        };
        assert!((length(q) - 1.0).abs() <= 2.0f64.powi(-28));
        let mut random = Random::new();
        for _ in 0..20_000 {
            let wild =
                Quat { s: random.spread(), x: random.i32(), y: random.spread(), z: random.i32() };
            assert!((length(wild.renormalise()) - 1.0).abs() <= 2.0f64.powi(-28));
        }
        let zero = Quat { s: 0, x: 0, y: 0, z: 0 };
        assert_eq!(zero.renormalise(), Quat::IDENTITY);
        let least = Quat { s: i32::MIN, x: i32::MIN, y: i32::MIN, z: i32::MIN };
        assert_eq!(least.renormalise().s, -(1 << 29));
        let _ = (least * least, least.conj() * least, least.to_mat4()); // saturate, don't panic
    }

    #[test]
    fn rotate_stays_within_its_bound() {
        let mut random = Random::new();
        for _ in 0..50_000 {
            let (axis, angle) = axis_angle(&mut random);
            let v = Vec3::from_f64([random.unit(), random.unit(), random.unit()].map(|x| x * 9e3));
            let Some(q) = Quat::from_axis_angle(axis, angle) else { continue };
            let (got, m, p) = (q.rotate(v).to_f64(), rodrigues(axis, angle), v.to_f64());
            let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            for r in 0..3 {
                let exact = m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2];
                let bound = 2.0f64.powi(-17) + length * 2.0f64.powi(-26);
                assert!((got[r] - exact).abs() <= bound);
            }
        }
    }
}
