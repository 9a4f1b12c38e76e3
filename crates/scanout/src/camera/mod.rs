//! Cameras: where the viewer stands and how space becomes clip space.
//!
//! ```text
//!  clip = projection * view * world          visible: -w <= x, y <= w  and  0 <= z <= w
//!
//!            y (v)                           z = 0 at the near plane, z = w at the far plane
//!            |    far                        w = distance along the view axis (perspective)
//!       _____|______                         w = 1 (orthographic)
//!       \    |     /                         x right, y up
//!        \___|____/  near
//!         \  |   /
//!          \ |  /     the camera looks along -z (-w of system E's u, v, w basis)
//!           eye------ x (u)
//! ```
//!
//! | constructor | view | projection | source |
//! |---|---|---|---|
//! | [`Camera::look_at`] | [`view::look_at`] | any of [`projection`] | systems A and E |
//! | [`Camera::off_axis`] | along a [`Screen`]'s normal | frustum through it | Kooima 2009; system C |
//! | [`Camera::stereo_pair`] | parallel axes | sheared towards the convergence distance | |
//!
//! Formats: matrices Q32.32, rounded to nearest once an entry; positions Q16.16; see
//! [`crate::math`].
//!
//! Nothing here panics: a camera that can't be is a [`CameraError`].
//!
//! What it will not do: animate, follow a mouse, lens distortion.

pub mod projection;
mod screen;
pub mod view;

pub use screen::Screen;

use crate::math::{Mat4, Q16, Vec3, div_nearest, saturate32, saturate64, shift_right_nearest};

/// From where a surface is seen, for specular light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// A perspective eye in the world, Q16.16.
    Point(Vec3),
    /// Parallel rays (orthographic): the vector points towards the viewer.
    Direction(Vec3),
}

/// A camera: where it stands and how it projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World to eye, Q32.32.
    pub view: Mat4,
    /// Eye to clip, Q32.32; visible: -w <= x, y <= w and 0 <= z <= w.
    pub projection: Mat4,
    /// From where surfaces are seen.
    pub viewpoint: Viewpoint,
}

/// Why there is no such camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraError {
    /// The eye and the focal point are the same.
    NoGaze,
    /// The up vector is zero or parallel to the gaze.
    UpAlongGaze,
    /// The field of view is zero, 180 degrees or more, or the focal factor isn't positive.
    FieldOfView,
    /// Width, height, aspect ratio, scale or frame isn't positive, or the matrix would leave its
    /// format.
    Size,
    /// The near plane isn't in front of the eye, or the far plane isn't beyond the near plane.
    Depth,
    /// The screen's corners don't span a rectangle.
    NoScreen,
    /// The eye lies in the screen's plane or behind it.
    BehindScreen,
    /// The eye distance is negative or the convergence distance isn't positive.
    Stereo,
    /// The camera's projection isn't a perspective one.
    NotPerspective,
}

impl core::fmt::Display for CameraError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            CameraError::NoGaze => "the eye and the focal point are the same",
            CameraError::UpAlongGaze => "the up vector is zero or parallel to the gaze",
            CameraError::FieldOfView => "the field of view must lie between 0 and 180 degrees",
            CameraError::Size => {
                "width, height, aspect ratio and scale must be positive and in range"
            }
            CameraError::Depth => "the planes must satisfy 0 < near < far",
            CameraError::NoScreen => "the screen's three corners must span a rectangle",
            CameraError::BehindScreen => "the eye must be in front of the screen",
            CameraError::Stereo => "eye distance must be >= 0 and convergence distance > 0",
            CameraError::NotPerspective => "a stereo pair needs a perspective projection",
        })
    }
}

impl core::error::Error for CameraError {}

impl Camera {
    /// A camera at `eye` looking at `focal_point`, with any projection.
    ///
    /// # Errors
    ///
    /// Those of [`view::look_at`].
    pub const fn look_at(
        eye: Vec3,
        focal_point: Vec3,
        up: Vec3,
        projection: Mat4,
    ) -> Result<Camera, CameraError> {
        let view = match view::look_at(eye, focal_point, up) {
            Ok(view) => view,
            Err(error) => return Err(error),
        };
        let viewpoint = if is_perspective(&projection) {
            Viewpoint::Point(eye)
        } else {
            Viewpoint::Direction(axis(&view, 2))
        };
        Ok(Camera { view, projection, viewpoint })
    }

    /// A window into the world: what `eye` sees through the rectangle `screen` (Kooima's
    /// generalised perspective projection). The view axis is the screen's normal, whatever the eye
    /// looks at.
    ///
    /// ```text
    ///  vr, vu, vn = screen's right, up, normal         va, vb, vc = corners - eye
    ///  d = -vn . va      W = vr . (vb - va)      H = vu . (vc - va)
    ///  x_clip = (2 d / W) x + (vr . (va + vb) / W) z    y likewise    w = -z
    /// ```
    ///
    /// The screen's own plane may lie anywhere against near and far; a point on the screen appears
    /// where it is.
    ///
    /// # Errors
    ///
    /// [`CameraError::Depth`], [`CameraError::NoScreen`], [`CameraError::BehindScreen`], or
    /// [`CameraError::Size`] when the eye is so far aside that the matrix leaves Q32.32.
    pub const fn off_axis(
        eye: Vec3,
        screen: &Screen,
        near: Q16,
        far: Q16,
    ) -> Result<Camera, CameraError> {
        screen::off_axis(eye, screen, near, far)
    }

    /// [`Camera::off_axis`] for two eyes, left first.
    ///
    /// # Errors
    ///
    /// Those of [`Camera::off_axis`].
    pub const fn off_axis_pair(
        left: Vec3,
        right: Vec3,
        screen: &Screen,
        near: Q16,
        far: Q16,
    ) -> Result<[Camera; 2], CameraError> {
        match (
            Camera::off_axis(left, screen, near, far),
            Camera::off_axis(right, screen, near, far),
        ) {
            (Ok(left), Ok(right)) => Ok([left, right]),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
    }

    /// This camera's left and right eye: `eye_distance` apart along u, axes parallel, frusta
    /// sheared so that a point at `convergence` along the view axis has no parallax (nearer points
    /// stand out of the screen).
    ///
    /// ```text
    ///  left:   x_eye + e / 2,   m02 + m00 e / (2 c)          right: the opposite
    /// ```
    ///
    /// # Errors
    ///
    /// [`CameraError::NotPerspective`]; [`CameraError::Stereo`] for `eye_distance` < 0 or
    /// `convergence` <= 0; [`CameraError::Size`] when the shear leaves Q32.32.
    pub const fn stereo_pair(
        &self,
        eye_distance: Q16,
        convergence: Q16,
    ) -> Result<[Camera; 2], CameraError> {
        let Viewpoint::Point(eye) = self.viewpoint else {
            return Err(CameraError::NotPerspective);
        };
        if !is_perspective(&self.projection) {
            return Err(CameraError::NotPerspective);
        }
        if eye_distance.0 < 0 || convergence.0 <= 0 {
            return Err(CameraError::Stereo);
        }
        // m00 e / (2 c) in Q32.32 and e / 2 in Q32.32.
        let scale = self.projection.m[0][0] as i128 * eye_distance.0 as i128;
        let Some(shear) = entry(scale, convergence.0 as i128 * 2) else {
            return Err(CameraError::Size);
        };
        let half = (eye_distance.0 as i64) << 15;
        match (self.shifted(eye, half, shear), self.shifted(eye, -half, -shear)) {
            (Ok(left), Ok(right)) => Ok([left, right]),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
    }

    /// This camera with eye space moved by `x` (so the eye moves by -`x`) and the frustum sheared.
    const fn shifted(&self, eye: Vec3, x: i64, shear: i64) -> Result<Camera, CameraError> {
        let mut camera = *self;
        let (Some(moved), Some(sheared)) =
            (camera.view.m[0][3].checked_add(x), camera.projection.m[0][2].checked_add(shear))
        else {
            return Err(CameraError::Size);
        };
        camera.view.m[0][3] = moved;
        camera.projection.m[0][2] = sheared;
        const fn along(eye: Q16, u: i64, x: i64) -> Q16 {
            let step = shift_right_nearest(u as i128 * x as i128, 48);
            Q16(saturate32((eye.0 as i64).saturating_sub(saturate64(step))))
        }
        let u = &self.view.m[0];
        camera.viewpoint = Viewpoint::Point(Vec3 {
            x: along(eye.x, u[0], x),
            y: along(eye.y, u[1], x),
            z: along(eye.z, u[2], x),
        });
        Ok(camera)
    }
}

/// Does the last row use x, y or z?
const fn is_perspective(projection: &Mat4) -> bool {
    let row = &projection.m[3];
    row[0] != 0 || row[1] != 0 || row[2] != 0
}

/// A row of the view's rotation as a vector in the world, Q16.16, nearest.
const fn axis(view: &Mat4, row: usize) -> Vec3 {
    const fn narrow(n: i64) -> Q16 {
        Q16(((n + (1 << 15)) >> 16) as i32)
    }
    let m = &view.m[row];
    Vec3 { x: narrow(m[0]), y: narrow(m[1]), z: narrow(m[2]) }
}

/// `n / d` to nearest if it fits a matrix entry.
const fn entry(n: i128, d: i128) -> Option<i64> {
    match div_nearest(n, d) {
        Some(i64::MAX) | None => None,
        Some(q) if q == -i64::MAX => None,
        Some(q) => Some(q),
    }
}

#[cfg(test)]
mod tests;
