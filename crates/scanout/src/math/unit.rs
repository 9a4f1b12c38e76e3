//! Directions: unit vectors in Q2.30, and how a vector becomes one.
//!
//! ```text
//! n(v) = v / |v|
//! ```
//!
//! | function | in | out | error |
//! |---|---|---|---|
//! | [`normalise`] | 3 x i64, any scale | Q2.30 | at most 2^-29 a component |
//! | [`normalise_q14`] | 3 x i32, any scale | Q2.14 | at most one unit (2^-14) a component |
//!
//! A vector has no scale for the normalisations: they read integers, and every format with them.
//!
//! What it will not do: keep a direction at unit length by itself; a sum of directions wants
//! normalising.

use super::fixed::saturate32;
use super::root::{isqrt64, rsqrt32};
use super::{Q16, Vec3};
use core::ops::Neg;

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

    /// Outer product in Q2.30, one rounding to nearest a component; of length one only if the two
    /// are perpendicular.
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

/// The direction of an integer vector of any scale, Q2.30: error at most 2^-29 a component. `None`
/// for zero.
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
        scaled[i] = at_31_bits(v[i], bits);
        sum += (scaled[i] * scaled[i]) as u64;
        i += 1;
    }
    let floor = isqrt64(sum) as u64;
    // sqrt(sum) >= floor + 1/2 exactly when sum > floor^2 + floor.
    let length = (if sum - floor * floor > floor { floor + 1 } else { floor }) as i64;
    let mut unit = [0i32; 4];
    i = 0;
    while i < 4 {
        unit[i] = component(scaled[i], length);
        i += 1;
    }
    Some(unit)
}

// Calls, since loops of four steps are written out.

/// A component of a vector whose greatest has so many bits, at 31 bits.
#[inline(never)]
const fn at_31_bits(v: i64, bits: u32) -> i64 {
    let wide =
        if bits <= 31 { v << (31 - bits) } else { (v >> (bits - 31)) + ((v >> (bits - 32)) & 1) };
    // Rounding may reach 2^31; one less keeps four squares within 64 bits.
    let most = (1i64 << 31) - 1;
    if wide > most {
        most
    } else if wide < -most {
        -most
    } else {
        wide
    }
}

/// `v / length` in Q2.30, nearest.
#[inline(never)]
const fn component(v: i64, length: i64) -> i32 {
    let magnitude = ((v.abs() << 30) + length / 2) / length;
    if v < 0 { -magnitude as i32 } else { magnitude as i32 }
}

/// The direction of an integer vector of any scale, Q2.14, for every pixel of Phong shading: error
/// at most one unit (2^-14) a component. Zero gives zero.
///
/// ```text
/// t = v 2^k, truncated, so that the greatest component has 16 bits
/// m = (tx^2 + ty^2 + tz^2) / 4, times four when below 2^30
/// r = round(t rsqrt32(m) / 2^33)           one bit more when m was not raised
/// ```
///
/// Cost: three products of 16 x 16 bits, [`rsqrt32`], three products of 17 x 32 -> 64 bits. No
/// division.
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

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::testing::Random;

    fn exact(v: [f64; 3]) -> [f64; 3] {
        let most = v[0].abs().max(v[1].abs()).max(v[2].abs());
        let v = v.map(|x| x / most);
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        v.map(|x| x / length)
    }

    fn worst(got: [i32; 3], one: f64, exact: [f64; 3]) -> f64 {
        (0..3).map(|i| (got[i] as f64 / one - exact[i]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn normalise_stays_within_its_bound() {
        let mut random = Random::new();
        let mut most = 0.0f64;
        for i in 0..300_000u32 {
            let down = i % 63;
            let mut component = || (random.u64() as i64) >> (down + random.u32() % 64).min(63);
            let v = [component(), component(), component()];
            let Some(unit) = normalise(v) else {
                assert_eq!(v, [0; 3]);
                continue;
            };
            most = most.max(worst(unit, 1073741824.0, exact(v.map(|n| n as f64))));
        }
        std::println!("normalise: error 2^{}", most.log2());
        assert!(most <= 2.0f64.powi(-29));
        assert_eq!(normalise([0; 3]), None);
        assert_eq!(normalise([0, -1, 0]), Some([0, -(1 << 30), 0]));
        assert_eq!(normalise([i64::MIN, 0, 0]), Some([-(1 << 30), 0, 0]));
        assert_eq!(normalise([i64::MAX, 0, 0]), Some([1 << 30, 0, 0]));
        let corner = normalise([i64::MIN; 3]).unwrap();
        assert!(worst(corner, 1073741824.0, exact([-1.0; 3])) <= 2.0f64.powi(-29));
    }

    #[test]
    fn normalise_does_not_see_scale() {
        let mut random = Random::new();
        for _ in 0..20_000 {
            let v = [random.i32() as i64, random.i32() as i64, random.i32() as i64];
            assert_eq!(normalise(v), normalise(v.map(|n| n << 30)));
            assert_eq!(normalise(v.map(|n| -n)), normalise(v).map(|u| u.map(|n| -n)));
        }
    }

    #[test]
    fn normalise_q14_stays_within_one_unit() {
        let mut random = Random::new();
        let mut most = 0.0f64;
        for i in 0..600_000u32 {
            let v = if i & 1 == 0 {
                let down = i % 31;
                [random.i32() >> down, random.i32() >> down, random.i32() >> down]
            } else {
                [random.spread(), random.spread(), random.spread()]
            };
            if v == [0; 3] {
                continue;
            }
            most = most.max(worst(normalise_q14(v), 16384.0, exact(v.map(|n| n as f64))));
        }
        std::println!("normalise_q14: error {} units", most * 16384.0);
        assert!(most * 16384.0 <= 1.0);
        assert_eq!(normalise_q14([0; 3]), [0; 3]);
        assert_eq!(normalise_q14([-7, 0, 0]), [-16384, 0, 0]);
        assert_eq!(normalise_q14([0, i32::MIN, 0]), [0, -16384, 0]);
        assert_eq!(normalise_q14([0, 0, i32::MAX]), [0, 0, 16384]);
        let corner = normalise_q14([i32::MIN; 3]);
        assert!(worst(corner, 16384.0, exact([-1.0; 3])) * 16384.0 <= 1.0);
    }

    #[test]
    fn normalise_q14_keeps_unit_normals() {
        // Interpolated normals are near unit length already: every axis pair at that length.
        for x in 0..=16384i32 {
            let y = ((16384.0f64 * 16384.0 - (x * x) as f64).sqrt()) as i32;
            let got = normalise_q14([x, -y, 0]);
            let want = exact([x as f64, -y as f64, 0.0]);
            assert!(worst(got, 16384.0, want) * 16384.0 <= 1.0, "{x}");
        }
    }

    #[test]
    fn products_of_directions() {
        let mut random = Random::new();
        for _ in 0..50_000 {
            let mut direction = || {
                let v = [random.i32() as i64, random.i32() as i64, random.i32() as i64 | 1];
                let [x, y, z] = normalise(v).unwrap();
                Unit3 { x, y, z }
            };
            let (a, b) = (direction(), direction());
            let float = |u: Unit3| [u.x, u.y, u.z].map(|n| n as f64 / 1073741824.0);
            let (p, q) = (float(a), float(b));
            let dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
            let half = 2.0f64.powi(-31);
            assert!((a.dot(b) as f64 / 1073741824.0 - dot).abs() <= half * 1.000001);
            let cross = a.cross(b);
            let want = [0, 1, 2]
                .map(|i| p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3]);
            assert!(worst([cross.x, cross.y, cross.z], 1073741824.0, want) <= half * 1.000001);
            let v = a.to_vec3().to_f64();
            let q14 = a.to_q14();
            for i in 0..3 {
                assert!((v[i] - p[i]).abs() <= 0.5 / 65536.0);
                assert!((q14[i] as f64 / 16384.0 - p[i]).abs() <= 0.5 / 16384.0);
            }
        }
        assert_eq!(Unit3::X.cross(Unit3::Y), Unit3::Z);
        assert_eq!((-Unit3::X).dot(Unit3::X), -(1 << 30));
        let wild = Unit3 { x: i32::MIN, y: i32::MIN, z: i32::MIN };
        assert_eq!(wild.dot(wild), i32::MAX);
        assert_eq!((-wild).x, i32::MAX);
        let up = Unit3 { x: 0, y: i32::MIN, z: i32::MAX };
        assert_eq!(up.cross(wild).x, i32::MAX);
    }
}
