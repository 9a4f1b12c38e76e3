//! Vectors: positions and directions in Q16.16, unit vectors in Q2.30, and the normalisations between them.
//!
//! ```text
//! a . b = ax bx + ay by + az bz          a x b = (ay bz - az by, az bx - ax bz, ax by - ay bx)
//! n(v)  = v / |v|                        o(a, b) = a - b (a . b) / (b . b)
//! ```
//!
//! | function | in | out | error |
//! |---|---|---|---|
//! | [`normalise`] | 3 x i64, any scale | Q2.30 | at most 2^-29 a component |
//! | [`normalise_q14`] | 3 x i32, any scale | Q2.14 | at most one unit (2^-14) a component |
//!
//! A vector has no scale for the normalisations: they read integers, and every format with them.
//!
//! What it will not do: swizzles, two- and four-component vectors.

use super::fixed::saturate32;
use super::root::{isqrt64, rsqrt32};
use super::{Q16, div_nearest, shift_right_nearest};
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

    /// Inner product in Q32.32: exact; saturates from 2^31 upwards (components up to 26,754 can't reach it).
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

    /// The part of this vector perpendicular to `against`: `a - b (a . b) / (b . b)` (system A's `orthogonalize`).
    ///
    /// The products are exact; one rounding to nearest a component, saturating. A zero `against` changes nothing.
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

/// A direction, 3 x Q2.30: `1 << 30` is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Unit3 {
    /// Right, Q2.30.
    pub x: i32,
    /// Up, Q2.30.
    pub y: i32,
    /// Towards the viewer, Q2.30.
    pub z: i32,
}

impl Unit3 {
    /// To the right.
    pub const X: Unit3 = Unit3 { x: 1 << 30, y: 0, z: 0 };
    /// Up.
    pub const Y: Unit3 = Unit3 { x: 0, y: 1 << 30, z: 0 };
    /// Towards the viewer.
    pub const Z: Unit3 = Unit3 { x: 0, y: 0, z: 1 << 30 };

    /// Inner product in Q2.30: the sum is exact, one rounding to nearest; saturates.
    pub const fn dot(self, other: Unit3) -> i32 {
        let x = self.x as i64 * other.x as i64;
        let y = self.y as i64 * other.y as i64;
        let z = self.z as i64 * other.z as i64;
        let sum = x.saturating_add(y).saturating_add(z);
        saturate32(sum.saturating_add(1 << 29) >> 30)
    }

    /// Outer product in Q2.30, one rounding to nearest a component; of length one only if the two are perpendicular.
    pub const fn cross(self, other: Unit3) -> Unit3 {
        const fn minor(a: i32, b: i32, c: i32, d: i32) -> i32 {
            let difference = (a as i64 * b as i64).saturating_sub(c as i64 * d as i64);
            saturate32(difference.saturating_add(1 << 29) >> 30)
        }
        Unit3 {
            x: minor(self.y, other.z, self.z, other.y),
            y: minor(self.z, other.x, self.x, other.z),
            z: minor(self.x, other.y, self.y, other.x),
        }
    }

    /// In Q16.16, nearest.
    pub const fn to_vec3(self) -> Vec3 {
        const fn narrow(n: i32) -> Q16 {
            Q16(((n as i64 + (1 << 13)) >> 14) as i32)
        }
        Vec3 { x: narrow(self.x), y: narrow(self.y), z: narrow(self.z) }
    }

    /// In Q2.14, nearest: the format of mesh normals.
    pub const fn to_q14(self) -> [i32; 3] {
        const fn narrow(n: i32) -> i32 {
            ((n as i64 + (1 << 15)) >> 16) as i32
        }
        [narrow(self.x), narrow(self.y), narrow(self.z)]
    }
}

impl Neg for Unit3 {
    type Output = Unit3;
    /// Saturates.
    fn neg(self) -> Unit3 {
        Unit3 { x: self.x.saturating_neg(), y: self.y.saturating_neg(), z: self.z.saturating_neg() }
    }
}

/// The direction of an integer vector of any scale, Q2.30: error at most 2^-29 a component. `None` for zero.
///
/// ```text
/// s = power of two that brings the greatest component to [2^30, 2^31)
/// l = round(sqrt(sum of (v s)^2))         r = round(v s 2^30 / l)
/// ```
///
/// Cost: one [`isqrt64`], three 64-bit divisions.
pub const fn normalise(v: [i64; 3]) -> Option<[i32; 3]> {
    match normalise4([v[0], v[1], v[2], 0]) {
        Some([x, y, z, _]) => Some([x, y, z]),
        None => None,
    }
}

/// [`normalise`] for four components.
pub(super) const fn normalise4(v: [i64; 4]) -> Option<[i32; 4]> {
    let mut all = 0u64;
    let mut i = 0;
    while i < 4 {
        all |= v[i].unsigned_abs();
        i += 1;
    }
    if all == 0 {
        return None;
    }
    // The greatest component's bits decide; their union has the same leading one.
    let bits = 64 - all.leading_zeros();
    let mut scaled = [0i64; 4];
    let mut sum = 0u64;
    i = 0;
    while i < 4 {
        let wide = if bits <= 31 {
            v[i] << (31 - bits)
        } else {
            shift_right_nearest(v[i] as i128, bits - 31) as i64
        };
        // Rounding may reach 2^31; one less keeps four squares within 64 bits.
        let most = (1i64 << 31) - 1;
        scaled[i] = if wide > most {
            most
        } else if wide < -most {
            -most
        } else {
            wide
        };
        sum += (scaled[i] * scaled[i]) as u64;
        i += 1;
    }
    let floor = isqrt64(sum) as u64;
    // sqrt(sum) >= floor + 1/2 exactly when sum > floor^2 + floor.
    let length = (if sum - floor * floor > floor { floor + 1 } else { floor }) as i64;
    let mut unit = [0i32; 4];
    i = 0;
    while i < 4 {
        let magnitude = ((scaled[i].abs() << 30) + length / 2) / length;
        unit[i] = if scaled[i] < 0 { -magnitude as i32 } else { magnitude as i32 };
        i += 1;
    }
    Some(unit)
}

/// The direction of an integer vector of any scale, Q2.14, for every pixel of Phong shading: error at most one unit
/// (2^-14) a component. Zero gives zero.
///
/// ```text
/// t = v 2^k, truncated, so that the greatest component has 16 bits
/// m = (tx^2 + ty^2 + tz^2) / 4, times four when below 2^30
/// r = round(t rsqrt32(m) / 2^33)           one bit more when m was not raised
/// ```
///
/// Cost: three products of 16 x 16 bits, [`rsqrt32`], three products of 17 x 32 -> 64 bits. No division.
#[inline]
pub const fn normalise_q14(v: [i32; 3]) -> [i32; 3] {
    let [ax, ay, az] = [v[0].unsigned_abs(), v[1].unsigned_abs(), v[2].unsigned_abs()];
    let all = ax | ay | az;
    if all == 0 {
        return [0; 3];
    }
    let lead = all.leading_zeros();
    // Left-justify, keep 16 bits rounded to nearest; a carry out of the top is held back.
    const fn narrow(n: u32, lead: u32) -> u32 {
        let wide = n << lead;
        let rounded = (wide >> 16) + ((wide >> 15) & 1);
        if rounded > 0xffff { 0xffff } else { rounded }
    }
    let [tx, ty, tz] = [narrow(ax, lead), narrow(ay, lead), narrow(az, lead)];
    let sum = (tx * tx) as u64 + (ty * ty) as u64 + (tz * tz) as u64;
    let m = (sum >> 2) as u32; // in [2^28, 3 * 2^30)
    // rsqrt32(m) = 2^46 / sqrt(m) and |t| = 2 sqrt(m): t 2^14 / |t| = t rsqrt32(m) / 2^33.
    let (m, down) = if m < 1 << 30 { (m << 2, 32) } else { (m, 33) };
    let r = rsqrt32(m) as u64;
    const fn component(v: i32, t: u32, r: u64, down: u32) -> i32 {
        let magnitude = ((t as u64 * r + (1 << (down - 1))) >> down) as i32;
        if v < 0 { -magnitude } else { magnitude }
    }
    [component(v[0], tx, r, down), component(v[1], ty, r, down), component(v[2], tz, r, down)]
}
