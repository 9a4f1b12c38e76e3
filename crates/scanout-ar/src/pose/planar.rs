//! The two poses that a flat marker may have.
//!
//! Seen from afar, a square that leans towards the viewer looks like one that leans away; only the small difference of perspective
//! tells them apart. IPPE finds both exactly: the homography's derivative at the marker's middle fixes the rotation up to this
//! choice.
//!
//! Source: Collins and Bartoli, "Infinitesimal Plane-Based Pose Estimation", 2014, sections 4 and 5.

use super::refine::refine;
use super::rotation::{cross, multiply};
use super::{Pose, square};
use crate::homography::Homography;
use crate::lens::Lens;
use crate::quad::Corners;
use crate::solve::solve;
use libm::sqrt;

/// A pose and its error: root mean square over the corners, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// The pose.
    pub pose: Pose,
    /// Its error, pixels.
    pub error: f64,
}

/// Both poses of a marker with side `size`, refined, the better one first; seen front-on they may be one and the same. `None` when
/// the corners can't be a square before the camera.
pub fn solve_square(lens: &Lens, size: f64, corners: &Corners) -> Option<[Solution; 2]> {
    let points = square(size);
    let rays = corners.map(|corner| lens.ray(corner));
    let rotations = rotations(&rays)?;
    let one = |rotation| {
        let translation = translation(&points, &rays, &rotation)?;
        let pose = refine(&Pose { rotation, translation }, lens, &points, corners);
        let error = pose.error(lens, &points, corners);
        error.is_finite().then_some(Solution { pose, error })
    };
    match rotations.map(one) {
        [Some(a), Some(b)] if b.error < a.error => Some([b, a]),
        [Some(a), Some(b)] => Some([a, b]),
        [Some(one), None] | [None, Some(one)] => Some([one, one]),
        [None, None] => None,
    }
}

/// The rotations for the rays of top left, top right, bottom right and bottom left.
fn rotations(rays: &[[f64; 2]; 4]) -> Option<[super::rotation::Matrix3; 2]> {
    // From the unit square, v downwards, to x right, y up about the middle, of side 1: u = x + 1/2, v = 1/2 - y.
    let map = Homography::from_unit_square(rays)?;
    let ([p, q], d) = map.map_with_derivatives(0.5, 0.5);
    let j = [[d[0], -d[1]], [d[2], -d[3]]];
    // Turns the camera's axis to the ray through the marker's middle.
    let t = sqrt(p * p + q * q);
    let towards = if t < 1e-9 {
        super::rotation::IDENTITY
    } else {
        super::rotation::from_vector([
            -q / t * libm::atan2(t, 1.0),
            p / t * libm::atan2(t, 1.0),
            0.0,
        ])
    };
    let b = [0, 1].map(|i| {
        let middle = [p, q][i];
        [0, 1].map(|k| towards[i][k] - middle * towards[2][k])
    });
    let determinant = b[0][0] * b[1][1] - b[0][1] * b[1][0];
    if determinant.abs() < 1e-12 {
        return None;
    }
    let inverse = [
        [b[1][1] / determinant, -b[0][1] / determinant],
        [-b[1][0] / determinant, b[0][0] / determinant],
    ];
    let a = [0, 1].map(|i| [0, 1].map(|k| inverse[i][0] * j[0][k] + inverse[i][1] * j[1][k]));
    // The greatest singular value.
    let (x, y) = (a[0][0] * a[0][0] + a[0][1] * a[0][1], a[1][0] * a[1][0] + a[1][1] * a[1][1]);
    let z = a[0][0] * a[1][0] + a[0][1] * a[1][1];
    let gamma = sqrt(((x + y) + sqrt((x - y) * (x - y) + 4.0 * z * z)) / 2.0);
    if gamma < 1e-12 || !gamma.is_finite() {
        return None;
    }
    let r = a.map(|row| row.map(|x| x / gamma));
    let rest = |i: usize, k: usize| {
        let one = if i == k { 1.0 } else { 0.0 };
        one - r[0][i] * r[0][k] - r[1][i] * r[1][k]
    };
    let (c, d) = (sqrt(rest(0, 0).max(0.0)), sqrt(rest(1, 1).max(0.0)));
    let d = if rest(0, 1) < 0.0 { -d } else { d };
    Some([1.0, -1.0].map(|sign| {
        let (first, second) = ([r[0][0], r[1][0], sign * c], [r[0][1], r[1][1], sign * d]);
        let third = cross(first, second);
        let columns = core::array::from_fn(|i| [first[i], second[i], third[i]]);
        multiply(&towards, &columns)
    }))
}

/// The translation that fits a rotation, by linear least squares; `None` when it isn't before the camera.
fn translation(
    points: &[[f64; 3]; 4],
    rays: &[[f64; 2]; 4],
    rotation: &super::rotation::Matrix3,
) -> Option<[f64; 3]> {
    let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for (point, ray) in points.iter().zip(rays) {
        let turned = super::rotation::apply(rotation, *point);
        for (axis, &ray) in ray.iter().enumerate() {
            // (turned + t)[axis] = ray (turned + t)[2]
            let mut row = [0.0, 0.0, -ray];
            row[axis] = 1.0;
            let value = ray * turned[2] - turned[axis];
            for i in 0..3 {
                for k in 0..3 {
                    matrix[i][k] += row[i] * row[k];
                }
                right[i] += row[i] * value;
            }
        }
    }
    solve(matrix, right).filter(|t| t[2] > 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::rotation::{angle, from_vector};
    use super::*;

    #[test]
    fn both_poses_are_found_and_the_right_one_first() {
        let lens = Lens {
            focal: [600.0, 605.0],
            centre: [310.0, 250.0],
            distortion: [-0.25, 0.1, 0.001, -0.001, 0.0],
        };
        let facing = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        let mut ambiguous = 0;
        for (i, lean) in [0.0, 0.02, 0.3, 0.8, 1.2].into_iter().enumerate() {
            for turn in 0..8 {
                let turn = f64::from(turn) * 0.8;
                let rotation = multiply(
                    &multiply(&from_vector([lean, lean * 0.3, 0.0]), &facing),
                    &from_vector([0.0, 0.0, turn]),
                );
                let want =
                    Pose { rotation, translation: [0.1 * i as f64 - 0.2, 0.1 - turn / 40.0, 0.8] };
                let corners = square(0.08).map(|p| lens.project(want.apply(p)).unwrap());
                let [first, second] = solve_square(&lens, 0.08, &corners).unwrap();
                assert!(first.error < 1e-6, "{lean} {turn}: {first:?}");
                assert!(angle(&first.pose.rotation, &want.rotation) < 1e-4, "{lean} {turn}");
                assert!(
                    (0..3).all(|k| {
                        (first.pose.translation[k] - want.translation[k]).abs() < 1e-5
                    })
                );
                // The other one leans the other way and fits less well.
                if angle(&second.pose.rotation, &want.rotation) > 0.1 {
                    assert!(second.error > 0.01);
                    ambiguous += 1;
                }
            }
        }
        assert!(ambiguous >= 16, "{ambiguous}");
    }

    #[test]
    fn corners_that_are_no_square_have_no_pose() {
        let lens = Lens::from_field_of_view(640, 480, 60.0).unwrap();
        assert_eq!(solve_square(&lens, 1.0, &[[5.0, 5.0]; 4]), None);
        let nan = [[f64::NAN; 2]; 4];
        assert_eq!(solve_square(&lens, 1.0, &nan), None);
    }
}
