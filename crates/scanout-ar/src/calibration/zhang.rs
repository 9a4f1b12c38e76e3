//! Intrinsics from several views of a flat grid.
//!
//! A first guess of the focal lengths comes from the homographies with the principal point in the middle; then everything (focal lengths,
//! principal point, five distortion coefficients, a pose a view) is fitted together to the least squared error in pixels.
//!
//! Source: Zhang, "A flexible new technique for camera calibration", 2000.

use crate::homography::Homography;
use crate::lens::Lens;
use crate::pose::refine::moved;
use crate::pose::{Pose, rotation};
use crate::solve::solve;

/// What was fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The lens.
    pub lens: Lens,
    /// The grid's pose in each view.
    pub poses: Vec<Pose>,
    /// Root mean square distance between seen and projected corners, pixels.
    pub error: f64,
    /// The same for each view.
    pub errors: Vec<f64>,
}

/// Why there is no calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CalibrateError {
    /// Fewer than three views.
    Views(usize),
    /// The views are all seen from the same direction, so that nothing tells focal length from distance.
    Directions,
}

impl std::fmt::Display for CalibrateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Views(count) => write!(
                f,
                "the whole board is seen in {count} pictures only; take at least 3, better 10 to 20, the board held at a slant"
            ),
            Self::Directions => f.write_str(
                "the views are too much alike; tilt the board by 20 to 45 degrees, each time to another side",
            ),
        }
    }
}

impl std::error::Error for CalibrateError {}

const INNER: usize = 9;

/// Fits a lens. `grid` holds the corners in the board's plane (x right, y up; any unit), each view where they were seen, in the same
/// order; `size` is the pictures' width and height.
///
/// # Errors
/// [`CalibrateError`].
pub fn calibrate(
    grid: &[[f64; 2]],
    views: &[Vec<[f64; 2]>],
    size: (usize, usize),
) -> Result<Fitted, CalibrateError> {
    if views.len() < 3 {
        return Err(CalibrateError::Views(views.len()));
    }
    let centre = [size.0 as f64 / 2.0, size.1 as f64 / 2.0];
    let maps: Vec<[f64; 9]> = views
        .iter()
        .map(|view| homography(grid, view))
        .collect::<Option<_>>()
        .ok_or(CalibrateError::Directions)?;
    let focal = focal(&maps, centre, size)?;
    let mut lens = Lens { focal, centre, distortion: [0.0; 5] };
    let points: Vec<[f64; 3]> = grid.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let mut poses: Vec<Pose> = maps.iter().map(|map| pose(map, &lens)).collect();
    for (pose, view) in poses.iter_mut().zip(views) {
        *pose = crate::pose::refine::refine(pose, &lens, &points, view);
    }
    let mut damping = 1e-3;
    let mut cost = total(&lens, &poses, &points, views);
    for _ in 0..60 {
        let Some((next_lens, next_poses)) = step(&lens, &poses, &points, views, damping) else {
            break;
        };
        let next = total(&next_lens, &next_poses, &points, views);
        if next < cost {
            let gain = (cost - next) / cost;
            (lens, poses, cost) = (next_lens, next_poses, next);
            damping = (damping * 0.2).max(1e-9);
            if gain < 1e-9 {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    let count = (grid.len() * views.len()) as f64;
    let errors = poses.iter().zip(views).map(|(pose, view)| pose.error(&lens, &points, view));
    Ok(Fitted { errors: errors.collect(), lens, poses, error: (cost / count).sqrt() })
}

/// A homography through many points, from coordinates of size 1: h8 = 1.
fn homography(grid: &[[f64; 2]], view: &[[f64; 2]]) -> Option<[f64; 9]> {
    let frame = |points: &[[f64; 2]]| {
        let n = points.len() as f64;
        let middle = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
        let spread =
            points.iter().map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1])).sum::<f64>() / n;
        (middle, spread)
    };
    let ((gm, gs), (vm, vs)) = (frame(grid), frame(view));
    let (mut matrix, mut right) = ([[0.0; 8]; 8], [0.0; 8]);
    for (from, to) in grid.iter().zip(view) {
        let [u, v] = [0, 1].map(|i| (from[i] - gm[i]) / gs);
        let [x, y] = [0, 1].map(|i| (to[i] - vm[i]) / vs);
        for (row, value) in [
            ([u, v, 1.0, 0.0, 0.0, 0.0, -x * u, -x * v], x),
            ([0.0, 0.0, 0.0, u, v, 1.0, -y * u, -y * v], y),
        ] {
            for i in 0..8 {
                for k in 0..8 {
                    matrix[i][k] += row[i] * row[k];
                }
                right[i] += row[i] * value;
            }
        }
    }
    let h = Homography(solve(matrix, right)?);
    // Back to the given coordinates.
    let [a, b, c, d, e, f, g, i] = h.0;
    let n = [[a, b, c], [d, e, f], [g, i, 1.0]];
    let to_unit = [[1.0 / gs, 0.0, -gm[0] / gs], [0.0, 1.0 / gs, -gm[1] / gs], [0.0, 0.0, 1.0]];
    let from_unit = [[vs, 0.0, vm[0]], [0.0, vs, vm[1]], [0.0, 0.0, 1.0]];
    let all = rotation::multiply(&from_unit, &rotation::multiply(&n, &to_unit));
    Some(std::array::from_fn(|k| all[k / 3][k % 3]))
}

/// Focal lengths with the principal point given: the columns of each homography are at right angles and equally long.
fn focal(
    maps: &[[f64; 9]],
    centre: [f64; 2],
    size: (usize, usize),
) -> Result<[f64; 2], CalibrateError> {
    let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    for map in maps {
        let column = |k: usize| {
            let (x, y, z) = (map[k], map[3 + k], map[6 + k]);
            let v = [x - centre[0] * z, y - centre[1] * z, z];
            let length =
                (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] * (size.0 * size.0) as f64).sqrt();
            v.map(|value| value / length)
        };
        let (a, b) = (column(0), column(1));
        let (p, q) = ([0, 1, 2].map(|i| a[i] + b[i]), [0, 1, 2].map(|i| a[i] - b[i]));
        for (s, t) in [(a, b), (p, q)] {
            // s0 t0 / fx^2 + s1 t1 / fy^2 = - s2 t2
            let row = [s[0] * t[0], s[1] * t[1]];
            for i in 0..2 {
                for k in 0..2 {
                    matrix[i][k] += row[i] * row[k];
                }
                right[i] -= row[i] * s[2] * t[2];
            }
        }
    }
    // Square pixels hold the two together where the views don't.
    let trace = matrix[0][0] + matrix[1][1];
    let hold = 1e-3 * trace;
    let held =
        [[matrix[0][0] + hold, matrix[0][1] - hold], [matrix[1][0] - hold, matrix[1][1] + hold]];
    let inverse = solve(held, right).ok_or(CalibrateError::Directions)?;
    let focal = inverse.map(|x| 1.0 / x.max(0.0).sqrt());
    let width = size.0.max(size.1) as f64;
    let possible = focal.iter().all(|f| f.is_finite() && (0.1..50.0).contains(&(f / width)));
    if possible { Ok(focal) } else { Err(CalibrateError::Directions) }
}

/// The pose that a homography of the plane means.
fn pose(map: &[f64; 9], lens: &Lens) -> Pose {
    let column = |k: usize| {
        let z = map[6 + k];
        [
            (map[k] - lens.centre[0] * z) / lens.focal[0],
            (map[3 + k] - lens.centre[1] * z) / lens.focal[1],
            z,
        ]
    };
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (a, b, t) = (column(0), column(1), column(2));
    let sign = if t[2] < 0.0 { -1.0 } else { 1.0 };
    let scale = sign * 2.0 / (length(a) + length(b));
    let a = a.map(|x| x * sign / length(a));
    let along: f64 = (0..3).map(|i| a[i] * b[i] * sign).sum();
    let b: [f64; 3] = std::array::from_fn(|i| b[i] * sign - a[i] * along);
    let b = b.map(|x| x / length(b));
    let c = rotation::cross(a, b);
    Pose {
        rotation: std::array::from_fn(|i| [a[i], b[i], c[i]]),
        translation: t.map(|x| x * scale),
    }
}

fn total(lens: &Lens, poses: &[Pose], points: &[[f64; 3]], views: &[Vec<[f64; 2]>]) -> f64 {
    let one = |(pose, view): (&Pose, &Vec<[f64; 2]>)| {
        let error = pose.error(lens, points, view);
        error * error * points.len() as f64
    };
    poses.iter().zip(views).map(one).sum()
}

/// A lens with its nine numbers changed.
fn changed(lens: &Lens, step: &[f64]) -> Lens {
    Lens {
        focal: [lens.focal[0] + step[0], lens.focal[1] + step[1]],
        centre: [lens.centre[0] + step[2], lens.centre[1] + step[3]],
        distortion: std::array::from_fn(|i| lens.distortion[i] + step[4 + i]),
    }
}

/// One step of Levenberg and Marquardt over everything.
fn step(
    lens: &Lens,
    poses: &[Pose],
    points: &[[f64; 3]],
    views: &[Vec<[f64; 2]>],
    damping: f64,
) -> Option<(Lens, Vec<Pose>)> {
    let size = INNER + 6 * poses.len();
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right = vec![0.0; size];
    let small: [f64; INNER] = [1e-3, 1e-3, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6];
    for (index, (pose, view)) in poses.iter().zip(views).enumerate() {
        for (point, seen) in points.iter().zip(view) {
            let pixel = lens.project(pose.apply(*point))?;
            let mut rows = [[0.0; INNER + 6]; 2];
            for k in 0..INNER + 6 {
                let (e, other) = if k < INNER {
                    let mut step = [0.0; INNER];
                    step[k] = small[k];
                    (small[k], changed(lens, &step).project(pose.apply(*point))?)
                } else {
                    let mut step = [0.0; 6];
                    let e = if k < INNER + 3 { 1e-6 } else { 1e-6 * pose.translation[2].abs() };
                    step[k - INNER] = e;
                    (e, lens.project(moved(pose, &step).apply(*point))?)
                };
                (0..2).for_each(|axis| rows[axis][k] = (other[axis] - pixel[axis]) / e);
            }
            let place = |k: usize| if k < INNER { k } else { index * 6 + k };
            for (axis, row) in rows.iter().enumerate() {
                let rest = seen[axis] - pixel[axis];
                for i in 0..INNER + 6 {
                    for k in 0..=i {
                        matrix[place(i)][place(k)] += row[i] * row[k];
                    }
                    right[place(i)] += row[i] * rest;
                }
            }
        }
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] *= 1.0 + damping;
    }
    let step = cholesky(matrix, right)?;
    let poses = poses.iter().zip(step[INNER..].chunks_exact(6));
    let poses = poses.map(|(pose, step)| moved(pose, &std::array::from_fn(|i| step[i])));
    Some((changed(lens, &step[..INNER]), poses.collect()))
}

/// As [`solve`], of any size.
#[allow(clippy::needless_range_loop)] // As the textbook writes it.
fn cholesky(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = right.len();
    for i in 0..n {
        for j in 0..=i {
            let sum = matrix[i][j] - (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum::<f64>();
            if i != j {
                matrix[i][j] = sum / matrix[j][j];
            } else if sum > 0.0 && sum.is_finite() {
                matrix[i][i] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    for i in 0..n {
        right[i] -= (0..i).map(|k| matrix[i][k] * right[k]).sum::<f64>();
        right[i] /= matrix[i][i];
    }
    for i in (0..n).rev() {
        right[i] -= (i + 1..n).map(|k| matrix[k][i] * right[k]).sum::<f64>();
        right[i] /= matrix[i][i];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::rotation::{from_vector, multiply};

    /// Views of a 9 x 6 grid under a known lens, with `noise` pixels of error.
    fn views(
        lens: &Lens,
        count: usize,
        tilt: f64,
        noise: f64,
    ) -> (Vec<[f64; 2]>, Vec<Vec<[f64; 2]>>) {
        let grid: Vec<[f64; 2]> =
            (0..54).map(|i| [(i % 9) as f64 * 0.025, -((i / 9) as f64) * 0.025]).collect();
        let facing = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        let mut seed = 1u32;
        let views = (0..count).map(|view| {
            let angle = view as f64 * 1.3;
            let lean = from_vector([tilt * angle.cos(), tilt * angle.sin(), 0.2 * angle.sin()]);
            let pose = Pose {
                rotation: multiply(&lean, &facing),
                translation: [-0.1 + 0.02 * angle.sin(), -0.06 + 0.02 * angle.cos(), 0.35],
            };
            let mut shake = || {
                seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5) * noise
            };
            let see = |p: &[f64; 2]| lens.project(pose.apply([p[0], p[1], 0.0])).unwrap();
            grid.iter().map(see).map(|p| p.map(|x| x + shake())).collect()
        });
        let views = views.collect();
        (grid, views)
    }

    #[test]
    fn a_known_lens_is_found() {
        let lens = Lens {
            focal: [620.0, 615.0],
            centre: [330.0, 232.0],
            distortion: [-0.28, 0.09, 0.001, -0.0008, 0.01],
        };
        let (grid, exact) = views(&lens, 10, 0.5, 0.0);
        let fitted = calibrate(&grid, &exact, (640, 480)).unwrap();
        assert!(fitted.error < 1e-4, "{fitted:?}");
        assert!((0..2).all(|i| (fitted.lens.focal[i] - lens.focal[i]).abs() < 0.01), "{fitted:?}");
        assert!((0..2).all(|i| (fitted.lens.centre[i] - lens.centre[i]).abs() < 0.01));
        assert!((0..5).all(|i| (fitted.lens.distortion[i] - lens.distortion[i]).abs() < 0.01));
        let (grid, noisy) = views(&lens, 12, 0.5, 0.3);
        let fitted = calibrate(&grid, &noisy, (640, 480)).unwrap();
        assert!((fitted.lens.focal[0] - 620.0).abs() < 4.0, "{:?}", fitted.lens);
        assert!((0.05..0.2).contains(&fitted.error));
    }

    #[test]
    fn views_that_cannot_tell_are_refused() {
        let lens = Lens { focal: [600.0; 2], centre: [320.0, 240.0], distortion: [0.0; 5] };
        let (grid, few) = views(&lens, 2, 0.5, 0.0);
        assert_eq!(calibrate(&grid, &few, (640, 480)), Err(CalibrateError::Views(2)));
        let (grid, flat) = views(&lens, 6, 0.0, 0.0);
        assert_eq!(calibrate(&grid, &flat, (640, 480)), Err(CalibrateError::Directions));
    }
}
