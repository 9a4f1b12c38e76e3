//! 4 x 4 matrices in Q32.32: object to world, world to eye, eye to clip.
//!
//! ```text
//! | m00 m01 m02 m03 | | x |      row major: m[row][column]; column vectors, so A B v applies B first
//! | m10 m11 m12 m13 | | y |      the translation is the last column
//! | m20 m21 m22 m23 | | z |      entries in [-2^31, 2^31), resolution 2^-32
//! | m30 m31 m32 m33 | | w |
//! ```
//!
//! Sums of products are exact in 128 bits and rounded to nearest once; what leaves the format saturates. A product
//! skips exact zeros, so the sparse matrices of cameras and placements cost a third of the 64 products.
//!
//! What it will not do: project (see the transform stage), invert projections.

use super::{Q16, Quat, Vec3, q32_from_f64, saturate64, shift_right_nearest};
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
            let mut sum = 0i128;
            let mut k = 0;
            while k < 4 {
                let (a, b) = (self.m[row][k], other.m[k][column]);
                if a != 0 && b != 0 {
                    sum = sum.saturating_add(a as i128 * b as i128);
                }
                k += 1;
            }
            out[row][column] = saturate64(shift_right_nearest(sum, 32));
            i += 1;
        }
        Mat4 { m: out }
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

    /// The direction (x, y, z, 0) transformed, its first three components in Q32.32: exact before one rounding to
    /// nearest; saturates. Normals need the inverse's transpose when axes are scaled unlike.
    pub const fn transform_direction(&self, d: Vec3) -> [i64; 3] {
        let mut out = [0; 3];
        let mut row = 0;
        while row < 3 {
            out[row] = saturate64(shift_right_nearest(self.row_dot(row, d), 16));
            row += 1;
        }
        out
    }

    /// First three entries of a row times a vector: Q32 x Q16 = Q48, below 2^96.
    const fn row_dot(&self, row: usize, v: Vec3) -> i128 {
        let [x, y, z] = v.raw();
        let m = &self.m[row];
        m[0] as i128 * x as i128 + m[1] as i128 * y as i128 + m[2] as i128 * z as i128
    }

    /// The inverse of a rotation and translation: transposed, and the translation turned back. Rounded to nearest.
    ///
    /// Right only if the upper left 3 x 3 is a rotation and the last row 0 0 0 1; neither is checked.
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
            let mut sum = 0i128;
            let mut k = 0;
            while k < 3 {
                sum = sum.saturating_sub(self.m[row][k] as i128 * m[k][3] as i128);
                k += 1;
            }
            self.m[row][3] = saturate64(shift_right_nearest(sum, 32));
            row += 1;
        }
        self
    }

    /// The inverse of any affine matrix (last row 0 0 0 1), by cofactors.
    ///
    /// Each row is first scaled by a power of two to 40 bits, so that a placement in millimetres or kilometres keeps
    /// its relative precision; error about 2^-38 times the condition number, relative to the greatest entry of its
    /// column. `None` when the determinant is zero, the last row is another, or an entry of the inverse exceeds Q32.32.
    pub const fn inverse_affine(&self) -> Option<Mat4> {
        let m = &self.m;
        if m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != ONE {
            return None;
        }
        // b = rows at 40 bits; row i of the matrix is b[i] * 2^down[i].
        let mut b = [[0i128; 3]; 3];
        let mut down = [0i32; 3];
        let mut i = 0;
        while i < 3 {
            let all = m[i][0].unsigned_abs() | m[i][1].unsigned_abs() | m[i][2].unsigned_abs();
            down[i] = 24 - all.leading_zeros() as i32;
            let mut k = 0;
            while k < 3 {
                b[i][k] = shift_nearest(m[i][k] as i128, -down[i]);
                k += 1;
            }
            i += 1;
        }
        // Cofactors at 81 bits, determinant at 123.
        let mut cofactor = [[0i128; 3]; 3];
        i = 0;
        while i < 9 {
            let (r, c) = (i / 3, i % 3);
            let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
            cofactor[r][c] = b[r1][c1] * b[r2][c2] - b[r1][c2] * b[r2][c1];
            i += 1;
        }
        let det = b[0][0] * cofactor[0][0] + b[0][1] * cofactor[0][1] + b[0][2] * cofactor[0][2];
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
            let n = cofactor[c][r];
            if n != 0 {
                // n / det * 2^(64 - down - det_down), the quotient taken at full width.
                let up = n.unsigned_abs().leading_zeros() as i32 - 1;
                let quotient = (n << up) / det;
                let by = 64 - down[c] - det_down - up;
                let wide = quotient.unsigned_abs().leading_zeros() as i32;
                if by >= wide {
                    return None;
                }
                let entry = shift_nearest(quotient, by);
                if entry != saturate64(entry) as i128 {
                    return None;
                }
                out.m[r][c] = entry as i64;
            } else {
                out.m[r][c] = 0;
            }
            i += 1;
        }
        Some(out.move_back(m))
    }
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
