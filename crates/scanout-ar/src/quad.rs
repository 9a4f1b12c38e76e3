//! Outlines that are quadrilaterals.
//!
//! ```text
//!        A            A: the point farthest from the middle       C: the point farthest from A
//!       / \           B, D: those farthest from the line AC on its two sides
//!      /   \ B
//!   D .     /         Then each corner again as the point farthest from its neighbours' diagonal; the quadrilateral must have
//!      \   /          nearly the outline's area. Last, a line is fitted to the middle of each side (total least squares,
//!       \./           outliers left out), and the lines' crossings are the corners.
//!        C
//! ```

use crate::contour::{Outline, Point};
use crate::line::{Line, LineSums};
use libm::sqrt;

/// Four corners, clockwise on the screen (y down), in pixels.
pub type Corners = [[f64; 2]; 4];

/// Twice the area of a polygon of four corners; positive clockwise on the screen.
pub fn twice_area(corners: &Corners) -> f64 {
    (0..4)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum()
}

/// The length of the shortest side, pixels.
pub fn shortest_side(corners: &Corners) -> f64 {
    let squared = (0..4).map(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])
    });
    sqrt(squared.fold(f64::INFINITY, f64::min))
}

/// Do the corners turn the same way all around, clockwise on the screen?
pub fn is_convex(corners: &Corners) -> bool {
    (0..4).all(|i| {
        let (a, b, c) = (corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]);
        (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) > 0.0
    })
}

/// Could these be the corners of a square before a camera whose field of view is at most 110 degrees across `width` pixels?
///
/// Opposite sides of a square differ only by perspective: the nearer one is longer by (d + s / 2) / (d - s / 2) at most, d being its
/// distance and s its side, and d / s is the focal length over the side in pixels. `slack` pixels are the corners' error.
pub fn is_square_in_perspective(corners: &Corners, width: usize, slack: f64) -> bool {
    let side = |i: usize| {
        let (a, b) = (corners[i % 4], corners[(i + 1) % 4]);
        sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]))
    };
    let longest = (0..4).map(side).fold(0.0, f64::max);
    let half = longest / (2.0 * 0.35 * width as f64);
    // Nearly a third more for lenses that distort.
    let most = if half < 0.9 { 1.3 * (1.0 + half) / (1.0 - half) } else { f64::INFINITY };
    [0, 1].into_iter().all(|i| {
        let (a, b) = (side(i), side(i + 2));
        a.max(b) - slack <= most * (a.min(b) + slack)
    })
}

/// Could this outline be a marker at all? Its length and area tell.
pub fn is_plausible(outline: &Outline, least_side: usize) -> bool {
    let length = outline.length as i64;
    // A square's outline along cracks has 16 times its area as squared length; seen at a slant of 1 to 8, 40 times; along diagonals
    // twice that; noise makes it longer still.
    length >= 4 * least_side as i64 && length * length < 110 * outline.area
}

/// The quadrilateral that an outline is, if it is one. All of its points must have been kept.
pub fn from_outline(outline: &Outline, points: &[Point]) -> Option<Corners> {
    let n = points.len();
    if n < 16 || n < outline.length {
        return None;
    }
    let sum = points
        .iter()
        .fold([0i64; 2], |sum, point| [sum[0] + i64::from(point[0]), sum[1] + i64::from(point[1])]);
    let middle = sum.map(|sum| (sum / n as i64) as i32);
    let from = |origin: [i32; 2]| {
        move |point: &Point| {
            let (x, y) = (i32::from(point[0]) - origin[0], i32::from(point[1]) - origin[1]);
            x * x + y * y
        }
    };
    let at = |index: usize| points[index].map(i32::from);
    let a = farthest(points, 0, n, from(middle));
    let c = farthest(points, 0, n, from(at(a)));
    // In the outline's order: a, b, c, d.
    let (a, c) = (a.min(c), a.max(c));
    let mut corner = [a, 0, c, 0];
    let area = outline.area as f64;
    let mut rough = [[0.0; 2]; 4];
    for round in 0..2 {
        for i in [1, 3, 0, 2] {
            if round == 0 && i % 2 == 0 {
                continue;
            }
            let (before, after) = (corner[(i + 3) % 4], corner[(i + 1) % 4]);
            let (p, q) = (at(before), at(after));
            let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
            // Outside of a clockwise outline is on the left of p -> q.
            let outward = |point: &Point| {
                (i32::from(point[0]) - p[0]) * dy - (i32::from(point[1]) - p[1]) * dx
            };
            let count = (after + n - before) % n;
            corner[i] = farthest(points, before, count, outward);
        }
        rough = corner.map(|index| at(index).map(f64::from));
        let ratio = twice_area(&rough) / 2.0 / area;
        let least = if round == 0 { 0.6 } else { 0.7 };
        if !(least..1.35).contains(&ratio) {
            return None;
        }
    }
    if !is_convex(&rough) {
        return None;
    }
    let fine = fit_sides(points, &corner)?;
    let ratio = twice_area(&fine) / 2.0 / area;
    ((0.8..1.25).contains(&ratio) && is_convex(&fine)).then_some(fine)
}

/// The index of the first point with the greatest value among `count` points from `start` on, around the end.
fn farthest(points: &[Point], start: usize, count: usize, value: impl Fn(&Point) -> i32) -> usize {
    let (mut best, mut most) = (start, i32::MIN);
    let (first, rest) = around(points, start, count);
    for (index, point) in first.iter().enumerate() {
        let value = value(point);
        if value > most {
            (best, most) = (start + index, value);
        }
    }
    for (index, point) in rest.iter().enumerate() {
        let value = value(point);
        if value > most {
            (best, most) = (index, value);
        }
    }
    best
}

/// `count` points from `start` on, around the end: those before it and those behind it.
fn around(points: &[Point], start: usize, count: usize) -> (&[Point], &[Point]) {
    let (before, behind) = points.split_at(start);
    if count <= behind.len() {
        (&behind[..count], &[])
    } else {
        (behind, &before[..count - behind.len()])
    }
}

/// The crossings of lines through the middle parts of the sides.
fn fit_sides(points: &[Point], corner: &[usize; 4]) -> Option<Corners> {
    let n = points.len();
    let origin = points[corner[0]].map(f64::from);
    let mut lines = [Line { normal: [0.0; 2], offset: 0.0 }; 4];
    for (side, line) in lines.iter_mut().enumerate() {
        let start = corner[side];
        let count = (corner[(side + 1) % 4] + n - start) % n;
        if count < 4 {
            return None;
        }
        // Blur rounds the corners off.
        let skip = (count / 8).max(1);
        let (first, rest) = around(points, (start + skip) % n, (count + 1 - 2 * skip).max(2));
        let middle = || {
            let relative = |point: &Point| [0, 1].map(|i| f64::from(point[i]) - origin[i]);
            first.iter().chain(rest).map(relative)
        };
        let mut sums = LineSums::default();
        middle().for_each(|point| sums.add(point, 1.0));
        let (mut fitted, mut mean) = sums.fit()?;
        // Steps of a straight side are a sixth at most; where it is more, without spurs: points more than twice as far off as usual.
        if mean > 0.25 {
            let limit = (4.0 * mean).max(0.75);
            let mut sums = LineSums::default();
            for point in middle() {
                let distance = fitted.distance(point);
                if distance * distance <= limit {
                    sums.add(point, 1.0);
                }
            }
            (fitted, mean) = sums.fit()?;
        }
        // A side that is no line: more than a pixel and a fortieth of its length off.
        let allowed = 1.0 + count as f64 / 40.0;
        if mean > allowed * allowed {
            return None;
        }
        *line = fitted;
    }
    let mut corners = [[0.0; 2]; 4];
    for (i, to) in corners.iter_mut().enumerate() {
        let [x, y] = lines[(i + 3) % 4].crossing(&lines[i])?;
        *to = [x + origin[0], y + origin[1]];
    }
    Some(corners)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::contour::follow;
    use crate::threshold::words;
    use std::vec;
    use std::vec::Vec;

    /// The quadrilaterals of what `inside` says of pixel centres.
    fn quads(inside: impl Fn(f64, f64) -> bool) -> Vec<Corners> {
        let (width, height) = (100, 80);
        let mut bits = vec![0u32; words(width) * height];
        for y in 1..height - 1 {
            for x in 1..width - 1 {
                if inside(x as f64 + 0.5, y as f64 + 0.5) {
                    bits[y * words(width) + x / 32] |= 1 << (x % 32);
                }
            }
        }
        let mut found = vec![];
        let mut points = [[0; 2]; 900];
        follow(&bits, (width, height), &mut bits.clone(), &mut points, |outline, points| {
            if is_plausible(&outline, 6) {
                found.extend(from_outline(&outline, points));
            }
        });
        found
    }

    #[test]
    fn corners_of_a_slanted_quadrilateral() {
        let want: Corners = [[20.0, 10.0], [80.0, 22.0], [70.0, 70.0], [12.0, 50.0]];
        let inside = |x: f64, y: f64| {
            (0..4).all(|i| {
                let (a, b) = (want[i], want[(i + 1) % 4]);
                (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0
            })
        };
        let found = quads(inside);
        assert_eq!(found.len(), 1);
        assert!(twice_area(&found[0]) > 0.0);
        for corner in want {
            let near = |got: &[f64; 2]| {
                let (x, y) = (got[0] - corner[0], got[1] - corner[1]);
                (x * x + y * y).sqrt() < 0.5
            };
            assert!(found[0].iter().any(near), "{corner:?} in {found:?}");
        }
    }

    #[test]
    fn discs_triangles_and_specks_are_none() {
        assert!(quads(|x, y| (x - 50.0).powi(2) + (y - 40.0).powi(2) < 900.0).is_empty());
        assert!(quads(|x, y| x > 20.0 && y > 10.0 && x + y < 80.0).is_empty());
        assert!(quads(|x, y| (20.0..25.0).contains(&x) && (20.0..25.0).contains(&y)).is_empty());
    }

    #[test]
    fn a_small_square_is_hardly_changed_by_perspective() {
        let small = [[100.0, 100.0], [120.0, 100.0], [115.0, 130.0], [105.0, 130.0]];
        assert!(!is_square_in_perspective(&small, 640, 0.0));
        // As large as the picture, such a trapezium is possible.
        let large = small.map(|corner| corner.map(|x| (x - 100.0) * 15.0));
        assert!(is_square_in_perspective(&large, 640, 0.0));
        let thin = [[100.0, 100.0], [120.0, 110.0], [120.0, 115.0], [100.0, 105.0]];
        assert!(is_square_in_perspective(&thin, 640, 0.0));
    }
}
