//! The off-axis camera: an eye before a screen that stands in the world (head tracking, mirrors,
//! walls of displays).
//!
//! ```text
//!  upper left  c---------------.
//!              |               |             va = a - eye   vr = (b - a) / |b - a|   right
//!              |    screen     |             vb = b - eye   vu = (c - a) / |c - a|   up
//!              |               |             vc = c - eye   vn = vr x vu             to the eye
//!  lower left  a---------------b  lower right
//!
//!                      eye                   d = -vn . va   the eye's distance from the plane
//! ```
//!
//! R. Kooima, *Generalized Perspective Projection* (2009), with the near plane cancelled:
//!
//! ```text
//!  2 n / (r - l) = 2 d / W          (r + l) / (r - l) = vr . (va + vb) / W
//! ```
//!
//! System C's formula x' = xv + (x - xv) (640 - zv) / (z - zv) is the case of an upright screen of
//! 640 x 480 world units.
//!
//! Inner products are exact sums of Q2.30 x Q16.16 in 128 bits; each entry is rounded to nearest
//! once. Against Kooima's own formula in f64 an entry's error is at most 2^-27 times the ratio that
//! magnifies it: the distance from the eye to the screen's corners over the screen's side (tested).
//! System C's cube falls within 2^-22 pixel of C's formula.
//!
//! What it will not do: curved or slanted (non-rectangular) screens: vu is made perpendicular to
//! vr.

use super::projection::with_factors;
use super::view::{cross, direction, from_basis};
use super::{Camera, CameraError, Viewpoint, entry};
use crate::math::{Q16, Vec3, normalise};

/// A rectangle in the world, seen from its front: three corners, Q16.16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Screen {
    /// Lower left corner.
    pub lower_left: Vec3,
    /// Lower right corner.
    pub lower_right: Vec3,
    /// Upper left corner.
    pub upper_left: Vec3,
}

impl Screen {
    /// A screen of `width` x `height` in the plane z = 0, its middle at the origin, facing +z.
    pub const fn centred(width: Q16, height: Q16) -> Screen {
        // Exact size: the odd half unit goes to the left and the bottom.
        let (right, top) = (width.0 >> 1, height.0 >> 1);
        let (left, bottom) = (right.saturating_sub(width.0), top.saturating_sub(height.0));
        const fn at(x: i32, y: i32) -> Vec3 {
            Vec3 { x: Q16(x), y: Q16(y), z: Q16(0) }
        }
        Screen {
            lower_left: at(left, bottom),
            lower_right: at(right, bottom),
            upper_left: at(left, top),
        }
    }
}

/// `b - a`, exact.
const fn from_to(a: Vec3, b: Vec3) -> [i64; 3] {
    let (a, b) = (a.raw(), b.raw());
    [b[0] as i64 - a[0] as i64, b[1] as i64 - a[1] as i64, b[2] as i64 - a[2] as i64]
}

/// Q2.30 x Q16.16, exact, Q46.
const fn dot(a: [i32; 3], b: [i64; 3]) -> i128 {
    a[0] as i128 * b[0] as i128 + a[1] as i128 * b[1] as i128 + a[2] as i128 * b[2] as i128
}

const fn wide(a: [i32; 3]) -> [i64; 3] {
    [a[0] as i64, a[1] as i64, a[2] as i64]
}

/// See [`Camera::off_axis`].
pub(super) const fn off_axis(
    eye: Vec3,
    screen: &Screen,
    near: Q16,
    far: Q16,
) -> Result<Camera, CameraError> {
    let across = from_to(screen.lower_left, screen.lower_right);
    let upwards = from_to(screen.lower_left, screen.upper_left);
    let (Some(vr), Some(vn)) = (normalise(across), direction(cross(across, upwards))) else {
        return Err(CameraError::NoScreen);
    };
    let Some(vu) = direction(cross(wide(vn), wide(vr))) else {
        return Err(CameraError::NoScreen);
    };
    let va = from_to(eye, screen.lower_left);
    let (width, height) = (dot(vr, across), dot(vu, upwards));
    let distance = -dot(vn, va);
    if distance <= 0 {
        return Err(CameraError::BehindScreen);
    }
    let (Some(fx), Some(fy), Some(sx), Some(sy)) = (
        entry(distance << 33, width),
        entry(distance << 33, height),
        entry((2 * dot(vr, va) + width) << 32, width),
        entry((2 * dot(vu, va) + height) << 32, height),
    ) else {
        return Err(CameraError::Size);
    };
    let mut projection = match with_factors(fx, fy, near, far) {
        Ok(matrix) => matrix,
        Err(error) => return Err(error),
    };
    projection.m[0][2] = sx;
    projection.m[1][2] = sy;
    let view = from_basis(vr, vu, vn, eye);
    Ok(Camera { view, projection, viewpoint: Viewpoint::Point(eye) })
}
