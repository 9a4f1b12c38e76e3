//! 4 x 4 matrices in Q32.32: object to world, world to eye, eye to clip.
//!
//! ```text
//! | m00 m01 m02 m03 | | x |      row major: m[row][column]; column vectors: A B v applies B first
//! | m10 m11 m12 m13 | | y |      the translation is the last column
//! | m20 m21 m22 m23 | | z |      entries in [-2^31, 2^31), resolution 2^-32
//! | m30 m31 m32 m33 | | w |
//! ```
//!
//! Sums of products are exact in 128 bits and rounded to nearest once; what leaves the format
//! saturates. A product skips exact zeros: perspective times view takes 17 of the 64
//! products, placement times placement 40.
//!
//! What it will not do: project (see the transform stage), invert projections.

use super::shift_right_nearest;
use super::{Q16, Quat, Vec3, add_product, div_by_large, q32_from_f64, saturate64};
use core::ops::Mul;

const ONE: i64 = 1 << 32;

/// A 4 x 4 matrix, Q32.32, row major, for column vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mat4 {
    /// `m[row][column]`, Q32.32.
    pub m: [[i64; 4]; 4],
}

impl Mat4 {
    /// Changes nothing.
    pub const IDENTITY: Mat4 = Mat4::diagonal(ONE, ONE, ONE);

    const fn diagonal(x: i64, y: i64, z: i64) -> Mat4 {
        Mat4 { m: [[x, 0, 0, 0], [0, y, 0, 0], [0, 0, z, 0], [0, 0, 0, ONE]] }
    }

    /// Moves by `t` (system B, equation 11), exact.
    pub const fn translation(t: Vec3) -> Mat4 {
        let mut matrix = Mat4::IDENTITY;
        matrix.m[0][3] = t.x.to_q32();
        matrix.m[1][3] = t.y.to_q32();
        matrix.m[2][3] = t.z.to_q32();
        matrix
    }

    /// Scales each axis (system B, equation 8), exact.
    pub const fn scaling(s: Vec3) -> Mat4 {
        Mat4::diagonal(s.x.to_q32(), s.y.to_q32(), s.z.to_q32())
    }

    /// Scales all axes alike, exact.
    pub const fn uniform_scale(s: Q16) -> Mat4 {
        Mat4::diagonal(s.to_q32(), s.to_q32(), s.to_q32())
    }

    /// Rotates (system B, equation 10); see [`Quat::to_mat4`].
    pub const fn rotation(q: &Quat) -> Mat4 {
        q.to_mat4()
    }

    /// Host convenience: each entry to nearest, saturating; NaN gives 0.
    pub const fn from_f64(m: [[f64; 4]; 4]) -> Mat4 {
        let mut out = [[0; 4]; 4];
        let mut i = 0;
        while i < 16 {
            out[i / 4][i % 4] = q32_from_f64(m[i / 4][i % 4]);
            i += 1;
        }
        Mat4 { m: out }
    }

    /// Host convenience: each entry to the nearest f64.
    pub const fn to_f64(&self) -> [[f64; 4]; 4] {
        let mut out = [[0.0; 4]; 4];
        let mut i = 0;
        while i < 16 {
            out[i / 4][i % 4] = self.m[i / 4][i % 4] as f64 / 4294967296.0;
            i += 1;
        }
        out
    }

    /// `self * other`: first `other`, then `self`. Nearest; saturates.
    pub const fn mul(&self, other: &Mat4) -> Mat4 {
        let mut out = [[0; 4]; 4];
        let mut i = 0;
        while i < 16 {
            let (row, column) = (i / 4, i % 4);
            out[row][column] = self.product_entry(other, row, column);
            i += 1;
        }
        Mat4 { m: out }
    }

    #[inline(never)]
    const fn product_entry(&self, other: &Mat4, row: usize, column: usize) -> i64 {
        let mut sum = 0i128;
        let mut k = 0;
        while k < 4 {
            let (a, b) = (self.m[row][k], other.m[k][column]);
            if a != 0 && b != 0 {
                sum = add_product(sum, a, b);
            }
            k += 1;
        }
        saturate64(shift_right_nearest(sum, 32))
    }

    /// The point (x, y, z, 1) transformed, Q32.32: exact before one rounding to nearest; saturates.
    pub const fn transform_point(&self, p: Vec3) -> [i64; 4] {
        let mut out = [0; 4];
        let mut row = 0;
        while row < 4 {
            let sum = self.row_dot(row, p) + ((self.m[row][3] as i128) << 16);
            out[row] = saturate64(shift_right_nearest(sum, 16));
            row += 1;
        }
        out
    }

    /// The direction (x, y, z, 0) transformed, its first three components in Q32.32: exact before
    /// one rounding to nearest; saturates. Normals need the inverse's transpose when axes are
    /// scaled unlike.
    pub const fn transform_direction(&self, d: Vec3) -> [i64; 3] {
        let mut out = [0; 3];
        let mut row = 0;
        while row < 3 {
            out[row] = self.direction_entry(row, d);
            row += 1;
        }
        out
    }

    #[inline(never)]
    const fn direction_entry(&self, row: usize, d: Vec3) -> i64 {
        saturate64(shift_right_nearest(self.row_dot(row, d), 16))
    }

    /// First three entries of a row times a vector: Q32 x Q16 = Q48, below 2^96.
    const fn row_dot(&self, row: usize, v: Vec3) -> i128 {
        let [x, y, z] = v.raw();
        let (x, y, z) = (x as i64, y as i64, z as i64);
        let m = &self.m[row];
        add_product(add_product(add_product(0, m[0], x), m[1], y), m[2], z)
    }

    /// The inverse of a rotation and translation: transposed, and the translation turned back.
    /// Rounded to nearest; a point comes back to within 2^-26 of its and the translation's length.
    ///
    /// Right only if the upper left 3 x 3 is a rotation and the last row 0 0 0 1; neither is
    /// checked.
    pub const fn inverse_rigid(&self) -> Mat4 {
        let m = &self.m;
        let mut out = Mat4::IDENTITY;
        let mut i = 0;
        while i < 9 {
            out.m[i / 3][i % 3] = m[i % 3][i / 3];
            i += 1;
        }
        out.move_back(m)
    }

    /// The last column set to minus this matrix's 3 x 3 times the translation of `m`.
    const fn move_back(mut self, m: &[[i64; 4]; 4]) -> Mat4 {
        let mut row = 0;
        while row < 3 {
            self.m[row][3] = moved_back(&self.m[row], m);
            row += 1;
        }
        self
    }

    /// The inverse of any affine matrix (last row 0 0 0 1), by cofactors.
    ///
    /// Each row is first scaled by a power of two to 40 bits, so that a placement in millimetres or
    /// kilometres keeps its relative precision; error about 2^-38 times the condition number,
    /// relative to the greatest entry of its column. `None` when the determinant is zero, the last
    /// row is another, or an entry of the inverse exceeds Q32.32.
    pub const fn inverse_affine(&self) -> Option<Mat4> {
        let m = &self.m;
        if m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != ONE {
            return None;
        }
        // b = rows at 40 bits; row i of the matrix is b[i] * 2^down[i].
        let mut b = [[0i64; 3]; 3];
        let mut down = [0i32; 3];
        let mut i = 0;
        while i < 3 {
            (b[i], down[i]) = row_at_40_bits(&m[i]);
            i += 1;
        }
        let det = add_wide_product(
            add_wide_product(
                add_wide_product(0, cofactor(&b, 0, 0), b[0][0]),
                cofactor(&b, 0, 1),
                b[0][1],
            ),
            cofactor(&b, 0, 2),
            b[0][2],
        );
        if det == 0 {
            return None;
        }
        // The determinant at 63 bits, so that a quotient keeps 63 bits too.
        let det_down = 65 - det.unsigned_abs().leading_zeros() as i32;
        let det = shift_nearest(det, -det_down);
        let mut out = Mat4::IDENTITY;
        i = 0;
        while i < 9 {
            let (r, c) = (i / 3, i % 3);
            match entry(&b, &det, r, c, 64 - down[c] - det_down) {
                Some(entry) => out.m[r][c] = entry,
                None => return None,
            }
            i += 1;
        }
        Some(out.move_back(m))
    }
}

// What follows is done once an object: calls, since loops of few steps are written out elsewhere.

/// Minus a row times the translation of `m`.
#[inline(never)]
const fn moved_back(row: &[i64; 4], m: &[[i64; 4]; 4]) -> i64 {
    let sum = add_product(add_product(0, row[0], m[0][3]), row[1], m[1][3]);
    let sum = add_product(sum, row[2], m[2][3]);
    saturate64(shift_right_nearest(sum.saturating_neg(), 32))
}

/// The first three entries with 40 bits, and how far down they were moved for that.
#[inline(never)]
const fn row_at_40_bits(row: &[i64; 4]) -> ([i64; 3], i32) {
    let all = row[0].unsigned_abs() | row[1].unsigned_abs() | row[2].unsigned_abs();
    let down = 24 - all.leading_zeros() as i32;
    ([at_40_bits(row[0], down), at_40_bits(row[1], down), at_40_bits(row[2], down)], down)
}

/// An entry of the inverse.
#[inline(never)]
const fn entry(b: &[[i64; 3]; 3], det: &i128, r: usize, c: usize, by: i32) -> Option<i64> {
    quotient(cofactor(b, c, r), *det, by)
}

/// `n 2^-down`, nearest; below 2^41.
#[inline(never)]
const fn at_40_bits(n: i64, down: i32) -> i64 {
    if down <= 0 { n << -down } else { (n >> down) + ((n >> (down - 1)) & 1) }
}

/// A cofactor of a matrix whose entries have 40 bits: 81 bits.
#[inline(never)]
const fn cofactor(b: &[[i64; 3]; 3], r: usize, c: usize) -> i128 {
    let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
    add_product(add_product(0, b[r1][c1], b[r2][c2]), b[r1][c2], -b[r2][c1])
}

/// `sum + a b`, within 127 bits.
#[inline(never)]
const fn add_wide_product(sum: i128, a: i128, b: i64) -> i128 {
    sum + a * b as i128
}

/// `n / det * 2^by`, the quotient taken at full width; `det` has 63 bits. `None` beyond 64 bits.
#[inline(never)]
const fn quotient(n: i128, det: i128, by: i32) -> Option<i64> {
    if n == 0 {
        return Some(0);
    }
    let up = n.unsigned_abs().leading_zeros() as i32 - 1;
    let size = div_by_large(n.unsigned_abs() << up, det.unsigned_abs() as u64);
    let by = by - up;
    if by >= size.leading_zeros() as i32 {
        return None;
    }
    let negative = (n < 0) != (det < 0);
    let entry = shift_nearest(if negative { -(size as i128) } else { size as i128 }, by);
    if entry == saturate64(entry) as i128 { Some(entry as i64) } else { None }
}

/// `n * 2^by`, nearest when `by` is negative.
const fn shift_nearest(n: i128, by: i32) -> i128 {
    if by >= 0 {
        n << by
    } else if by > -127 {
        shift_right_nearest(n, -by as u32)
    } else {
        0
    }
}

impl Default for Mat4 {
    /// The identity.
    fn default() -> Mat4 {
        Mat4::IDENTITY
    }
}

impl Mul for Mat4 {
    type Output = Mat4;
    /// See [`Mat4::mul`].
    fn mul(self, other: Mat4) -> Mat4 {
        Mat4::mul(&self, &other)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::Angle;
    use crate::math::testing::Random;

    fn random_matrix(random: &mut Random, zeros: bool) -> Mat4 {
        let mut m = [[0; 4]; 4];
        for entry in m.iter_mut().flatten() {
            if !(zeros && random.u32() & 1 == 0) {
                *entry = (random.u64() as i64) >> random.range(20, 63);
            }
        }
        Mat4 { m }
    }

    #[test]
    fn products_round_once() {
        let mut random = Random::new();
        for i in 0..20_000 {
            let a = random_matrix(&mut random, i & 1 == 0);
            let b = random_matrix(&mut random, i & 2 == 0);
            let got = a * b;
            for r in 0..4 {
                for c in 0..4 {
                    let sum: i128 = (0..4).map(|k| a.m[r][k] as i128 * b.m[k][c] as i128).sum();
                    let exact = (sum + (1 << 31)).div_euclid(1 << 32);
                    assert_eq!(got.m[r][c] as i128, exact);
                }
            }
        }
        let wild = Mat4 { m: [[i64::MIN; 4]; 4] };
        assert_eq!((wild * wild).m, [[i64::MAX; 4]; 4]);
        assert_eq!((Mat4::IDENTITY * wild).m, wild.m);
    }

    #[test]
    fn points_move_and_directions_do_not() {
        let mut random = Random::new();
        for _ in 0..20_000 {
            let m = random_matrix(&mut random, false);
            let v = Vec3::new(Q16(random.spread()), Q16(random.spread()), Q16(random.spread()));
            let (p, d) = (m.transform_point(v), m.transform_direction(v));
            let raw = v.raw();
            for r in 0..4 {
                let turned: i128 = (0..3).map(|k| m.m[r][k] as i128 * raw[k] as i128).sum();
                let nearest = |n: i128| saturate64((n + (1 << 15)).div_euclid(1 << 16));
                assert_eq!(p[r], nearest(turned + ((m.m[r][3] as i128) << 16)));
                if r < 3 {
                    assert_eq!(d[r], nearest(turned));
                }
            }
        }
        let t = Vec3::from_f64([1.5, -2.0, 3.25]);
        let placed = Mat4::translation(t).transform_point(Vec3::X);
        assert_eq!(
            placed,
            [Q16::from_f64(2.5).to_q32(), -2 * ONE, Q16::from_f64(3.25).to_q32(), ONE]
        );
    }

    #[test]
    fn system_b_placement_is_translation_rotation_scale() {
        let q = Quat::from_axis_angle(Vec3::Z, Angle::QUARTER).unwrap();
        let m = Mat4::translation(Vec3::from_f64([10.0, 20.0, 30.0]))
            * Mat4::rotation(&q)
            * Mat4::scaling(Vec3::from_f64([2.0, 3.0, 4.0]));
        let p = m.transform_point(Vec3::from_f64([1.0, 1.0, 1.0]));
        assert_eq!(p, [7 * ONE, 22 * ONE, 34 * ONE, ONE]);
        let half = Mat4::uniform_scale(Q16::HALF);
        assert_eq!((half * Mat4::uniform_scale(Q16::from_int(2))), Mat4::IDENTITY);
        assert_eq!(Mat4::default(), Mat4::IDENTITY);
    }

    #[test]
    fn rigid_inverse_undoes() {
        let mut random = Random::new();
        for _ in 0..5_000 {
            let mut v =
                || Vec3::from_f64([random.unit(), random.unit(), random.unit()].map(|x| x * 50.0));
            let (axis, t) = (v(), v());
            let Some(q) = Quat::from_axis_angle(axis, Angle(random.u32())) else { continue };
            let m = Mat4::translation(t) * q.to_mat4();
            let both = (m.inverse_rigid() * m).to_f64();
            let affine = (m.inverse_affine().unwrap() * m).to_f64();
            for r in 0..4 {
                for c in 0..4 {
                    let same = if r == c { 1.0 } else { 0.0 };
                    assert!(
                        (both[r][c] - same).abs() <= 2.0f64.powi(if c == 3 { -20 } else { -26 })
                    );
                    assert!(
                        (affine[r][c] - same).abs() <= 2.0f64.powi(if c == 3 { -24 } else { -30 })
                    );
                }
            }
        }
    }

    #[test]
    fn affine_inverse_keeps_relative_precision_at_any_scale() {
        let mut random = Random::new();
        let mut worst = 0.0f64;
        for _ in 0..20_000 {
            let axis = Vec3::from_f64([random.unit(), random.unit(), random.unit()]);
            let Some(q) = Quat::from_axis_angle(axis, Angle(random.u32())) else { continue };
            // Scales from 1/500 to 2000, unlike on the three axes.
            let mut scale = || Q16::from_f64(2.0f64.powf(random.unit() * 10.0 + 1.0));
            let s = Vec3::new(scale(), scale(), scale());
            let m = Mat4::scaling(s) * q.to_mat4();
            let inverse = m.inverse_affine().unwrap().to_f64();
            // The exact inverse of the matrix as stored, in f64 by cofactors.
            let a = m.to_f64();
            let cofactor = |r: usize, c: usize| {
                let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
                a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1]
            };
            let det: f64 = (0..3).map(|c| a[0][c] * cofactor(0, c)).sum();
            for c in 0..3 {
                let most = (0..3).map(|r| (cofactor(c, r) / det).abs()).fold(0.0, f64::max);
                for (r, row) in inverse.iter().enumerate().take(3) {
                    let error = (row[c] - cofactor(c, r) / det).abs();
                    worst = worst.max((error - 2.0f64.powi(-33)) / most);
                }
            }
        }
        std::println!("inverse_affine: error 2^{} of the column", worst.log2());
        assert!(worst <= 2.0f64.powi(-36));
    }

    #[test]
    fn affine_inverse_has_an_answer_or_none() {
        let singular = Mat4::scaling(Vec3::from_f64([1.0, 0.0, 1.0]));
        assert_eq!(singular.inverse_affine(), None);
        let mut flat = Mat4::IDENTITY;
        flat.m[2] = [ONE, ONE, 0, 5];
        assert_eq!(flat.inverse_affine(), None);
        assert_eq!(Mat4 { m: [[0; 4]; 4] }.inverse_affine(), None);
        let mut projective = Mat4::IDENTITY;
        projective.m[3][2] = 1;
        assert_eq!(projective.inverse_affine(), None);
        let mut tiny = Mat4::IDENTITY;
        tiny.m[0][0] = 1; // 2^-32: its inverse, 2^32, is out of range
        assert_eq!(tiny.inverse_affine(), None);
        tiny.m[0][0] = 4; // 2^30 is not
        assert_eq!(tiny.inverse_affine().unwrap().m[0][0], 1 << 62);
        let mut random = Random::new();
        for _ in 0..20_000 {
            let mut m = Mat4 { m: [[0; 4]; 4] };
            for entry in m.m.iter_mut().flatten() {
                *entry = (random.u64() as i64) >> random.range(0, 63);
            }
            m.m[3] = [0, 0, 0, ONE];
            let _ = m.inverse_affine(); // must not panic
            let _ = m.inverse_rigid();
        }
        let wild = Mat4 { m: [[i64::MIN; 4], [i64::MAX; 4], [1, -1, i64::MIN, 0], [0, 0, 0, ONE]] };
        let _ = wild.inverse_affine();
        let far = Vec3::new(Q16::MIN, Q16::MIN, Q16::MIN);
        assert_eq!(wild.transform_point(far)[0], i64::MAX);
    }

    #[test]
    fn floats_convert_at_the_door() {
        let m = [[1.5, -2.25, 0.0, 1e6], [0.0, 1e-9, 0.0, 0.0], [0.0; 4], [0.0, 0.0, 0.0, 1.0]];
        let back = Mat4::from_f64(m).to_f64();
        for (got, want) in back.iter().flatten().zip(m.iter().flatten()) {
            assert!((got - want).abs() <= 2.0f64.powi(-33));
        }
        assert_eq!(Mat4::from_f64([[f64::INFINITY; 4]; 4]).m, [[i64::MAX; 4]; 4]);
        assert_eq!(Mat4::from_f64([[f64::NAN; 4]; 4]).m, [[0; 4]; 4]);
    }
}
