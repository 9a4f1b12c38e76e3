//! The pose with the least squared error in pixels, from one that is near (Levenberg and Marquardt).

use super::Pose;
use super::rotation::{from_vector, multiply};
use crate::lens::Lens;
use crate::solve::solve;

/// Steps at most.
const STEPS: usize = 12;

/// Improves a pose; `points` and `seen` are as many, at least 3. What can't be improved comes back as it was.
pub fn refine(start: &Pose, lens: &Lens, points: &[[f64; 3]], seen: &[[f64; 2]]) -> Pose {
    let mut pose = *start;
    let mut error = pose.error(lens, points, seen);
    let mut damping = 1e-6;
    for _ in 0..STEPS {
        let Some((matrix, right)) = equations(&pose, lens, points, seen) else { break };
        let mut damped = matrix;
        for (i, row) in damped.iter_mut().enumerate() {
            row[i] *= 1.0 + damping;
        }
        let Some(step) = solve(damped, right) else { break };
        let next = moved(&pose, &step);
        let next_error = next.error(lens, points, seen);
        if next_error < error {
            let gain = error - next_error;
            (pose, error) = (next, next_error);
            damping *= 0.1;
            if gain < 1e-9 {
                break;
            }
        } else {
            damping *= 30.0;
            if damping > 1e3 {
                break;
            }
        }
    }
    pose
}

/// A pose turned by a small vector about the object's own place and shifted.
pub(crate) fn moved(pose: &Pose, step: &[f64; 6]) -> Pose {
    let turn = from_vector([step[0], step[1], step[2]]);
    Pose {
        rotation: multiply(&turn, &pose.rotation),
        translation: core::array::from_fn(|i| pose.translation[i] + step[3 + i]),
    }
}

type Equations = ([[f64; 6]; 6], [f64; 6]);

/// The normal equations of a step; `None` when a point is behind the camera.
fn equations(
    pose: &Pose,
    lens: &Lens,
    points: &[[f64; 3]],
    seen: &[[f64; 2]],
) -> Option<Equations> {
    let (mut matrix, mut right) = ([[0.0; 6]; 6], [0.0; 6]);
    for (point, seen) in points.iter().zip(seen) {
        let at = pose.apply(*point);
        let arm: [f64; 3] = core::array::from_fn(|i| at[i] - pose.translation[i]);
        let pixel = lens.project(at)?;
        // Differences: the distortion's derivatives are long, and this is as exact as needed.
        let e = 1e-6 * at[2];
        let mut slope = [[0.0; 3]; 2];
        for axis in 0..3 {
            let (mut more, mut less) = (at, at);
            more[axis] += e;
            less[axis] -= e;
            let (more, less) = (lens.project(more)?, lens.project(less)?);
            for k in 0..2 {
                slope[k][axis] = (more[k] - less[k]) / (2.0 * e);
            }
        }
        for k in 0..2 {
            let [a, b, c] = slope[k];
            // A turn w moves the point by w x arm.
            let row = [
                c * arm[1] - b * arm[2],
                a * arm[2] - c * arm[0],
                b * arm[0] - a * arm[1],
                a,
                b,
                c,
            ];
            let rest = seen[k] - pixel[k];
            for i in 0..6 {
                for j in 0..6 {
                    matrix[i][j] += row[i] * row[j];
                }
                right[i] += row[i] * rest;
            }
        }
    }
    Some((matrix, right))
}
