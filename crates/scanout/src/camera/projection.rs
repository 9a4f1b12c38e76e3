//! Eye to clip: perspective and orthographic projections.
//!
//! ```text
//!       perspective                              orthographic
//!  | fx  0   0            0            |    | 2/width  0         0           0           |
//!  | 0   fy  0            0            |    | 0        2/height  0           0           |
//!  | 0   0   -f / (f-n)   -f n / (f-n) |    | 0        0         -1 / (f-n)  -n / (f-n)  |
//!  | 0   0   -1           0            |    | 0        0         0           1           |
//!
//!  fy = 1 / tan(fovy / 2), fx = fy / aspect
//! ```
//!
//! z runs from 0 (near) to w (far), so that depth is an unsigned number. System B's equation 13
//! lets z / w run from +1 (near) to -1 (far): `z_B = w - 2 z`.
//!
//! Entries are Q32.32, each rounded to nearest once from exact products (for [`perspective`], from
//! a cotangent with an error of 2^-29 (1 + cot^2)).
//!
//! What it will not do: an infinite far plane, reversed depth; for sheared frusta see
//! [`super::Camera::off_axis`].

use super::{CameraError, entry};
use crate::math::{Angle, Mat4, Q16, div_nearest};

/// Perspective with a vertical field of view of `fovy` (0 - 180 degrees, both excluded) and
/// `aspect` = width / height.
///
/// # Errors
///
/// [`CameraError::FieldOfView`], [`CameraError::Size`] for `aspect` <= 0 or a matrix out of range,
/// [`CameraError::Depth`] unless 0 < near < far.
pub const fn perspective(
    fovy: Angle,
    aspect: Q16,
    near: Q16,
    far: Q16,
) -> Result<Mat4, CameraError> {
    if fovy.0 < 2 || fovy.0 >= 1 << 31 {
        return Err(CameraError::FieldOfView);
    }
    if aspect.0 <= 0 {
        return Err(CameraError::Size);
    }
    let (sin, cos) = Angle(fovy.0 >> 1).sin_cos();
    let Some(fy) = div_nearest((cos as i128) << 32, sin as i128) else {
        return Err(CameraError::FieldOfView);
    };
    let Some(fx) = entry((fy as i128) << 16, aspect.0 as i128) else {
        return Err(CameraError::Size);
    };
    with_factors(fx, fy, near, far)
}

/// Perspective with `focal` = 1 / tan(fovy / 2) given as a number (system B's `fov_const`) and
/// `aspect` = height / width (B's `aspect_ratio`, equation 14): fx = focal * aspect, fy = focal.
///
/// # Errors
///
/// [`CameraError::FieldOfView`] for `focal` <= 0, [`CameraError::Size`] for `aspect` <= 0,
/// [`CameraError::Depth`] unless 0 < near < far.
pub const fn perspective_focal(
    focal: Q16,
    aspect_height_over_width: Q16,
    near: Q16,
    far: Q16,
) -> Result<Mat4, CameraError> {
    if focal.0 <= 0 {
        return Err(CameraError::FieldOfView);
    }
    if aspect_height_over_width.0 <= 0 {
        return Err(CameraError::Size);
    }
    let fx = focal.0 as i64 * aspect_height_over_width.0 as i64; // Q32.32, exact
    with_factors(fx, focal.to_q32(), near, far)
}

/// The perspective matrix of the module's figure with fx and fy in Q32.32.
pub(super) const fn with_factors(
    fx: i64,
    fy: i64,
    near: Q16,
    far: Q16,
) -> Result<Mat4, CameraError> {
    if near.0 <= 0 || far.0 <= near.0 {
        return Err(CameraError::Depth);
    }
    let (n, f) = (near.0 as i128, far.0 as i128);
    // f / (f - n) is a ratio of Q16s; f n is Q32, so f n / (f - n) is Q16.
    let (Some(a), Some(b)) = (entry(-f << 32, f - n), entry((-f * n) << 16, f - n)) else {
        return Err(CameraError::Depth);
    };
    const ONE: i64 = 1 << 32;
    Ok(Mat4 { m: [[fx, 0, 0, 0], [0, fy, 0, 0], [0, 0, a, b], [0, 0, -ONE, 0]] })
}

/// Orthographic: a box of `width` x `height` world units about the view axis. `near` and `far` are
/// distances along it and may be negative (behind the eye), as nothing is divided by them.
///
/// # Errors
///
/// [`CameraError::Size`] for a width or height <= 0, [`CameraError::Depth`] unless near < far.
pub const fn orthographic(
    width: Q16,
    height: Q16,
    near: Q16,
    far: Q16,
) -> Result<Mat4, CameraError> {
    if width.0 <= 0 || height.0 <= 0 {
        return Err(CameraError::Size);
    }
    let (Some(x), Some(y)) = (entry(2 << 48, width.0 as i128), entry(2 << 48, height.0 as i128))
    else {
        return Err(CameraError::Size);
    };
    parallel(x, y, near, far)
}

/// Orthographic by system E's windowing transform: `pixels_per_unit` pixels of a frame of `frame` =
/// (width, height) pixels to each world unit, the view axis at the frame's middle.
///
/// # Errors
///
/// [`CameraError::Size`] for a scale <= 0 or an empty frame, [`CameraError::Depth`] unless near <
/// far.
pub const fn windowing(
    pixels_per_unit: Q16,
    frame: (u16, u16),
    near: Q16,
    far: Q16,
) -> Result<Mat4, CameraError> {
    if pixels_per_unit.0 <= 0 {
        return Err(CameraError::Size);
    }
    let twice = (pixels_per_unit.0 as i128) << 17; // 2 pixels a unit, Q32.32
    let (Some(x), Some(y)) = (entry(twice, frame.0 as i128), entry(twice, frame.1 as i128)) else {
        return Err(CameraError::Size);
    };
    parallel(x, y, near, far)
}

/// The orthographic matrix of the module's figure with its first two factors in Q32.32.
const fn parallel(x: i64, y: i64, near: Q16, far: Q16) -> Result<Mat4, CameraError> {
    if far.0 <= near.0 {
        return Err(CameraError::Depth);
    }
    let (n, f) = (near.0 as i128, far.0 as i128);
    let (Some(a), Some(b)) = (entry(-1 << 48, f - n), entry(-n << 32, f - n)) else {
        return Err(CameraError::Depth);
    };
    Ok(Mat4 { m: [[x, 0, 0, 0], [0, y, 0, 0], [0, 0, a, b], [0, 0, 0, 1 << 32]] })
}
