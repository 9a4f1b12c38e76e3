//! `Vec3`: positions and directions in the world, 3 x Q16.16.
//!
//! ```text
//! a . b = ax bx + ay by + az bz          a x b = (ay bz - az by, az bx - ax bz, ax by - ay bx)
//! |a|   = sqrt(a . a)                    o(a, b) = a - b (a . b) / (b . b)
//! ```
//!
//! Products are exact; each operation states its one rounding. What leaves [-32768, 32768)
//! saturates. Directions of length one have a type of their own, [`Unit3`].
//!
//! What it will not do: swizzles, two- and four-component vectors.

use super::fixed::saturate32;
use super::root::isqrt64;
use super::{Q16, Unit3, div_nearest, normalise};
use core::ops::{Add, Neg, Sub};

/// A position or direction in the world, 3 x Q16.16.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
pub struct Vec3 {
    /// Right, Q16.16.
    pub x: Q16,
    /// Up, Q16.16.
    pub y: Q16,
    /// Towards the viewer of an unmoved camera, Q16.16.
    pub z: Q16,
}

impl Vec3 {
    /// The origin.
    pub const ZERO: Vec3 = Vec3 { x: Q16::ZERO, y: Q16::ZERO, z: Q16::ZERO };
    /// One to the right.
    pub const X: Vec3 = Vec3 { x: Q16::ONE, y: Q16::ZERO, z: Q16::ZERO };
    /// One up.
    pub const Y: Vec3 = Vec3 { x: Q16::ZERO, y: Q16::ONE, z: Q16::ZERO };
    /// One towards the viewer.
    pub const Z: Vec3 = Vec3 { x: Q16::ZERO, y: Q16::ZERO, z: Q16::ONE };

    /// From components.
    #[inline]
    pub const fn new(x: Q16, y: Q16, z: Q16) -> Vec3 {
        Vec3 { x, y, z }
    }

    /// Host convenience: each component to nearest, saturating; NaN gives 0.
    pub const fn from_f64(v: [f64; 3]) -> Vec3 {
        Vec3 { x: Q16::from_f64(v[0]), y: Q16::from_f64(v[1]), z: Q16::from_f64(v[2]) }
    }

    /// Host convenience: exact.
    pub const fn to_f64(self) -> [f64; 3] {
        [self.x.to_f64(), self.y.to_f64(), self.z.to_f64()]
    }

    /// The raw integers, x, y, z.
    #[inline]
    pub const fn raw(self) -> [i32; 3] {
        [self.x.0, self.y.0, self.z.0]
    }

    /// Inner product in Q32.32: exact; saturates from 2^31 upwards (components up to 26,754 can't
    /// reach it).
    #[inline]
    pub const fn dot(self, other: Vec3) -> i64 {
        let x = self.x.0 as i64 * other.x.0 as i64;
        let y = self.y.0 as i64 * other.y.0 as i64;
        let z = self.z.0 as i64 * other.z.0 as i64;
        x.saturating_add(y).saturating_add(z)
    }

    /// Outer product, each component exact before one rounding to nearest; saturates.
    pub const fn cross(self, other: Vec3) -> Vec3 {
        const fn minor(a: Q16, b: Q16, c: Q16, d: Q16) -> Q16 {
            let difference = (a.0 as i64 * b.0 as i64).saturating_sub(c.0 as i64 * d.0 as i64);
            Q16(saturate32(difference.saturating_add(0x8000) >> 16))
        }
        Vec3 {
            x: minor(self.y, other.z, self.z, other.y),
            y: minor(self.z, other.x, self.x, other.z),
            z: minor(self.x, other.y, self.y, other.x),
        }
    }

    /// Each component times `factor`, nearest; saturates.
    pub const fn scale(self, factor: Q16) -> Vec3 {
        Vec3 {
            x: self.x.mul_nearest(factor),
            y: self.y.mul_nearest(factor),
            z: self.z.mul_nearest(factor),
        }
    }

    /// Length, floor: error in [0, 2^-16); saturates.
    pub const fn length(self) -> Q16 {
        let [x, y, z] = self.raw();
        let [x, y, z] = [x.unsigned_abs() as u64, y.unsigned_abs() as u64, z.unsigned_abs() as u64];
        // At most 3 * 2^62, below 2^64.
        Q16(saturate32(isqrt64(x * x + y * y + z * z) as i64))
    }

    /// The direction, error at most 2^-29 a component; `None` for the zero vector.
    pub const fn normalise(self) -> Option<Unit3> {
        let [x, y, z] = self.raw();
        match normalise([x as i64, y as i64, z as i64]) {
            Some([x, y, z]) => Some(Unit3 { x, y, z }),
            None => None,
        }
    }

    /// The part of this vector perpendicular to `against`: `a - b (a . b) / (b . b)` (system A's
    /// `orthogonalize`).
    ///
    /// The products are exact; one rounding to nearest a component, saturating. A zero `against`
    /// changes nothing.
    pub const fn orthogonalise(self, against: Vec3) -> Vec3 {
        const fn dot(a: [i32; 3], b: [i32; 3]) -> i128 {
            a[0] as i128 * b[0] as i128 + a[1] as i128 * b[1] as i128 + a[2] as i128 * b[2] as i128
        }
        const fn rest(a: i32, b: i32, ab: i128, bb: i128) -> Q16 {
            match div_nearest(b as i128 * ab, bb) {
                Some(part) => Q16(saturate32((a as i64).saturating_sub(part))),
                None => Q16(a),
            }
        }
        let (a, b) = (self.raw(), against.raw());
        let (ab, bb) = (dot(a, b), dot(b, b));
        Vec3 {
            x: rest(a[0], b[0], ab, bb),
            y: rest(a[1], b[1], ab, bb),
            z: rest(a[2], b[2], ab, bb),
        }
    }
}

impl Add for Vec3 {
    type Output = Vec3;
    /// Saturates.
    fn add(self, other: Vec3) -> Vec3 {
        Vec3 { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for Vec3 {
    type Output = Vec3;
    /// Saturates.
    fn sub(self, other: Vec3) -> Vec3 {
        Vec3 { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Neg for Vec3 {
    type Output = Vec3;
    /// Saturates.
    fn neg(self) -> Vec3 {
        Vec3 { x: -self.x, y: -self.y, z: -self.z }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;

    fn vector(random: &mut Random) -> Vec3 {
        Vec3::new(Q16(random.spread()), Q16(random.spread()), Q16(random.spread()))
    }

    fn saturated(x: f64) -> f64 {
        x.clamp(-32768.0, Q16::MAX.to_f64())
    }

    #[test]
    fn products_round_once() {
        let mut random = Random::new();
        let half = 0.5 / 65536.0;
        for _ in 0..100_000 {
            let (a, b) = (vector(&mut random), vector(&mut random));
            let ([ax, ay, az], [bx, by, bz]) = (a.raw(), b.raw());
            let exact = ax as i128 * bx as i128 + ay as i128 * by as i128 + az as i128 * bz as i128;
            assert_eq!(a.dot(b) as i128, exact.clamp(i64::MIN as i128, i64::MAX as i128));
            let cross = a.cross(b).to_f64();
            let (p, q) = (a.to_f64(), b.to_f64());
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let exact = saturated(p[j] * q[k] - p[k] * q[j]);
                assert!((cross[i] - exact).abs() <= half, "{a:?} x {b:?}");
                let scaled = a.scale(b.x).to_f64()[i];
                assert!((scaled - saturated(p[i] * q[0])).abs() <= half);
                assert_eq!((a + b).to_f64()[i], saturated(p[i] + q[i]));
                assert_eq!((a - b).to_f64()[i], saturated(p[i] - q[i]));
            }
            let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            let error = saturated(length) - a.length().to_f64();
            assert!((-1e-9..1.0 / 65536.0 + 1e-9).contains(&error));
        }
        assert_eq!(Vec3::X.cross(Vec3::Y), Vec3::Z);
        let far = Vec3::new(Q16::MIN, Q16::MIN, Q16::MIN);
        assert_eq!(far.dot(far), i64::MAX);
        assert_eq!(far.length(), Q16::MAX);
        assert_eq!((-far).x, Q16::MAX);
        assert_eq!(far.cross(Vec3::new(Q16::MAX, Q16::MIN, Q16::MIN)).x, Q16::ZERO);
    }

    #[test]
    fn system_a_orthogonalise_leaves_a_perpendicular_part() {
        let mut random = Random::new();
        for _ in 0..100_000 {
            let a =
                Vec3::from_f64([random.unit(), random.unit(), random.unit()].map(|x| x * 100.0));
            let b =
                Vec3::from_f64([random.unit(), random.unit(), random.unit()].map(|x| x * 100.0));
            let rest = a.orthogonalise(b);
            let (p, q) = (a.to_f64(), b.to_f64());
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let factor = dot(p, q) / dot(q, q);
            for i in 0..3 {
                let exact = p[i] - q[i] * factor;
                assert!((rest.to_f64()[i] - exact).abs() <= 0.5001 / 65536.0, "{a:?} {b:?}");
            }
        }
        assert_eq!(Vec3::X.orthogonalise(Vec3::ZERO), Vec3::X);
        assert_eq!(Vec3::X.orthogonalise(Vec3::X), Vec3::ZERO);
        let far = Vec3::new(Q16::MIN, Q16::MIN, Q16::MIN);
        assert_eq!(far.orthogonalise(far), Vec3::ZERO);
    }
}
