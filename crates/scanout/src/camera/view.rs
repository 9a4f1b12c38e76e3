//! World to eye: the u, v, w basis of system E (and system A's camera).
//!
//! ```text
//!   w = (eye - focal point) / |...|     points backwards: what is seen has negative w
//!   u = up x w / |up x w|               right
//!   v = w x u                           up, made perpendicular
//!
//!       | ux uy uz  -u . eye |
//!  Mv = | vx vy vz  -v . eye |
//!       | wx wy wz  -w . eye |
//!       | 0  0  0   1        |
//! ```
//!
//! The cross product up x (eye - focal point) is exact, so `up` counts as parallel only when it is
//! so bit for bit. Axes are Q2.30 with an error of at most 2^-28.5 a component, so a point's error
//! is below 2^-28 times its distance from the eye plus 2^-28 times the eye's from the origin.
//!
//! What it will not do: roll (turn `up` instead).

use super::CameraError;
use crate::math::{Mat4, Vec3, normalise, shift_right_nearest};

/// World to eye for a viewer at `eye` who looks at `focal_point` with `up` upwards on the screen.
///
/// # Errors
///
/// [`CameraError::NoGaze`] when eye and focal point coincide, [`CameraError::UpAlongGaze`] when
/// `up` is zero or parallel to the gaze.
pub const fn look_at(eye: Vec3, focal_point: Vec3, up: Vec3) -> Result<Mat4, CameraError> {
    let (e, f, t) = (eye.raw(), focal_point.raw(), up.raw());
    let back = [e[0] as i64 - f[0] as i64, e[1] as i64 - f[1] as i64, e[2] as i64 - f[2] as i64];
    let Some(w) = normalise(back) else { return Err(CameraError::NoGaze) };
    let Some(u) = direction(cross([t[0] as i64, t[1] as i64, t[2] as i64], back)) else {
        return Err(CameraError::UpAlongGaze);
    };
    let v = cross([w[0] as i64, w[1] as i64, w[2] as i64], [u[0] as i64, u[1] as i64, u[2] as i64]);
    let Some(v) = direction(v) else { return Err(CameraError::UpAlongGaze) };
    Ok(from_basis(u, v, w, eye))
}

/// Outer product, exact for components below 2^62.
pub(super) const fn cross(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    const fn minor(a: i64, b: i64, c: i64, d: i64) -> i128 {
        a as i128 * b as i128 - c as i128 * d as i128
    }
    [minor(a[1], b[2], a[2], b[1]), minor(a[2], b[0], a[0], b[2]), minor(a[0], b[1], a[1], b[0])]
}

/// Direction of a wide vector, Q2.30; `None` for zero.
pub(super) const fn direction(v: [i128; 3]) -> Option<[i32; 3]> {
    let all = v[0].unsigned_abs() | v[1].unsigned_abs() | v[2].unsigned_abs();
    let down = 128 - all.leading_zeros();
    if down <= 61 {
        return normalise([v[0] as i64, v[1] as i64, v[2] as i64]);
    }
    let down = down - 61;
    normalise([(v[0] >> down) as i64, (v[1] >> down) as i64, (v[2] >> down) as i64])
}

/// The matrix with rows u, v, w (Q2.30) for an eye in Q16.16.
pub(super) const fn from_basis(u: [i32; 3], v: [i32; 3], w: [i32; 3], eye: Vec3) -> Mat4 {
    const fn row(a: [i32; 3], eye: [i32; 3]) -> [i64; 4] {
        let sum = a[0] as i128 * eye[0] as i128
            + a[1] as i128 * eye[1] as i128
            + a[2] as i128 * eye[2] as i128;
        let moved = shift_right_nearest(-sum, 14) as i64; // Q46 to Q32
        [(a[0] as i64) << 2, (a[1] as i64) << 2, (a[2] as i64) << 2, moved]
    }
    let e = eye.raw();
    Mat4 { m: [row(u, e), row(v, e), row(w, e), [0, 0, 0, 1 << 32]] }
}
