//! Boards: several markers that are fixed to one another, flat or not.
//!
//! Each marker that is seen proposes its two poses for the whole board; the one that fits all seen corners best is refined on all of
//! them. So a board is found by any one marker, and known the better the more are seen.

use super::planar::{Solution, solve_square};
use super::refine::refine;
use super::{Pose, square};
use crate::lens::Lens;
use crate::quad::Corners;

/// A marker's place on a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The marker's number.
    pub id: u16,
    /// From the marker's axes to the board's.
    pub pose: Pose,
}

/// A marker of a grid of `columns` x `rows`, numbered from `first` by rows from the top left, whose markers are `size` wide and `gap`
/// apart; the board's origin is its middle, x right, y up, z out of the paper. `None` when there is no such marker.
pub fn grid_place(
    (columns, rows): (u16, u16),
    size: f64,
    gap: f64,
    first: u16,
    id: u16,
) -> Option<Place> {
    let index = id.checked_sub(first)?;
    if columns == 0 || u32::from(index) >= u32::from(columns) * u32::from(rows) {
        return None;
    }
    let step = size + gap;
    let place = |index: u16, count: u16| (f64::from(index) - f64::from(count - 1) / 2.0) * step;
    let translation = [place(index % columns, columns), -place(index / columns, rows), 0.0];
    Some(Place { id, pose: Pose { rotation: super::rotation::IDENTITY, translation } })
}

/// The pose of a board from the markers that are seen, each with its place and corners; all have the side `size`. `points` and `seen`
/// are working memory of four entries a marker; of more markers than fit, the first are used. `None` when no marker has a pose.
pub fn solve_board<'a>(
    lens: &Lens,
    size: f64,
    markers: impl Iterator<Item = (Place, &'a Corners)> + Clone,
    points: &mut [[f64; 3]],
    seen: &mut [[f64; 2]],
) -> Option<Solution> {
    let most = points.len().min(seen.len()) / 4;
    let mut count = 0;
    for (place, corners) in markers.clone().take(most) {
        for (point, corner) in square(size).into_iter().zip(corners) {
            points[count] = place.pose.apply(point);
            seen[count] = *corner;
            count += 1;
        }
    }
    let (points, seen) = (&points[..count], &seen[..count]);
    let mut best: Option<Solution> = None;
    for (place, corners) in markers.take(most) {
        for solution in solve_square(lens, size, corners).into_iter().flatten() {
            let pose = solution.pose.after(&place.pose.inverse());
            let error = pose.error(lens, points, seen);
            if best.is_none_or(|best| error < best.error) {
                best = Some(Solution { pose, error });
            }
        }
    }
    let pose = refine(&best?.pose, lens, points, seen);
    let error = pose.error(lens, points, seen);
    error.is_finite().then_some(Solution { pose, error })
}

#[cfg(test)]
mod tests {
    use super::super::rotation::{angle, from_vector, multiply};
    use super::*;

    #[test]
    fn a_board_is_known_better_than_its_markers() {
        let lens = Lens::from_field_of_view(640, 480, 56.0).unwrap();
        let facing = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        let rotation = multiply(&from_vector([0.4, -0.2, 0.1]), &facing);
        let want = Pose { rotation, translation: [0.02, -0.03, 0.7] };
        let mut seed = 3u32;
        let seen: [(Place, Corners); 6] = core::array::from_fn(|i| {
            let place = grid_place((3, 2), 0.05, 0.01, 10, 10 + i as u16).unwrap();
            let corners = square(0.05).map(|point| {
                lens.project(want.apply(place.pose.apply(point))).unwrap().map(|x| {
                    seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                    x + (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5) * 0.4
                })
            });
            (place, corners)
        });
        let solve = |count: usize| {
            let markers = seen[..count].iter().map(|(place, corners)| (*place, corners));
            let solution =
                solve_board(&lens, 0.05, markers, &mut [[0.0; 3]; 24], &mut [[0.0; 2]; 24])
                    .unwrap();
            angle(&solution.pose.rotation, &want.rotation)
        };
        assert!(solve(6) < 0.01 && solve(6) < solve(1), "{} {}", solve(6), solve(1));
        let none = core::iter::empty::<(Place, &Corners)>();
        assert_eq!(solve_board(&lens, 0.05, none, &mut [], &mut []), None);
        assert_eq!(grid_place((3, 2), 1.0, 0.0, 10, 16), None);
        assert_eq!(grid_place((3, 2), 1.0, 0.0, 10, 9), None);
    }
}
