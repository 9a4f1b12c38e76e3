//! Where a marker stands in front of the camera.
//!
//! A pose takes a point of the marker to the camera's axes:
//!
//! ```text
//!  marker: x right, y up, z out of the paper towards the viewer         camera: x right, y down, z forward
//!
//!      y                                                                    z (forward)
//!      |                                                                   /
//!      |____ x        p_camera = R p_marker + t                           /____ x
//!     /                                                                  |
//!    z                                                                   y
//! ```
//!
//! [`planar`] gives both poses that a flat marker may have, [`refine`] the one with the least error in pixels, [`track`] decides
//! between both by the last frames, [`filter`] calms what is left, [`board`] takes several markers for one.

pub mod board;
pub mod filter;
pub mod planar;
pub mod refine;
pub mod rotation;
pub mod track;

use crate::lens::Lens;
use rotation::Matrix3;

/// A rigid motion from a marker's axes to the camera's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// R, row by row.
    pub rotation: Matrix3,
    /// t, in the unit of the marker's size.
    pub translation: [f64; 3],
}

impl Pose {
    /// A point of the marker in the camera's axes.
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = rotation::apply(&self.rotation, point);
        core::array::from_fn(|i| turned[i] + self.translation[i])
    }

    /// This pose after another: what `first` takes to the marker's axes, taken on to the camera's.
    #[must_use]
    pub fn after(&self, first: &Pose) -> Pose {
        Pose {
            rotation: rotation::multiply(&self.rotation, &first.rotation),
            translation: self.apply(first.translation),
        }
    }

    /// From the camera's axes back to the marker's.
    #[must_use]
    pub fn inverse(&self) -> Pose {
        let rotation = rotation::transpose(&self.rotation);
        let back = rotation::apply(&rotation, self.translation);
        Pose { rotation, translation: back.map(|x| -x) }
    }

    /// Root mean square distance between seen and projected points, pixels; infinite when a point lies behind the camera.
    pub fn error(&self, lens: &Lens, points: &[[f64; 3]], seen: &[[f64; 2]]) -> f64 {
        let mut sum = 0.0;
        for (point, seen) in points.iter().zip(seen) {
            let Some(at) = lens.project(self.apply(*point)) else { return f64::INFINITY };
            sum += (at[0] - seen[0]) * (at[0] - seen[0]) + (at[1] - seen[1]) * (at[1] - seen[1]);
        }
        libm::sqrt(sum / points.len().max(1) as f64)
    }
}

/// The corners of a marker with this side in its own axes, in the order of [`crate::Detection::corners`].
pub fn square(size: f64) -> [[f64; 3]; 4] {
    let h = size / 2.0;
    [[-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0], [-h, -h, 0.0]]
}
