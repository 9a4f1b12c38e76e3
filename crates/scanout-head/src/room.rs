//! System C's room: depth needs references, so behind the glass is a box of lines, and in it C's cube.
//!
//! ```text
//!   side view      C's z   640            740         980           1279
//!                           |glass         |  cube     |              | back wall
//!    viewer  o              |              |___________|              |
//!              z > 0        0                                      -639/480 of the screen's height
//! ```
//!
//! C's screen is 640 x 480 of its units; here one of its units is the screen's height / 480, and the room is as wide as the screen.

use crate::V3;

/// Lines along each edge of a wall.
pub const CELLS: usize = 8;

/// C's lengths, in shares of the screen's height.
const UNIT: f64 = 1.0 / 480.0;

/// The corners of C's cube on a screen of this height, mm: the least and the greatest coordinates. x and y are 200 to 440 of 640
/// and 120 to 360 of 480, so its middle is the screen's; z is 740 to 980 with the glass at 640.
pub fn cube(height: f64) -> [V3; 2] {
    let c = |n: f64| n * UNIT * height;
    [[c(-120.0), c(-120.0), c(640.0 - 980.0)], [c(120.0), c(120.0), c(640.0 - 740.0)]]
}

/// Depth of the room behind a screen of this height, mm.
pub fn depth(height: f64) -> f64 {
    639.0 * UNIT * height
}

/// The points and the lines (pairs of indices) of the room behind a screen of `width` x `height` mm: a grid of [`CELLS`] lines on the
/// four walls along the view and on the back wall.
///
/// `point` is told each point in turn, `line` each pair of indices.
pub fn walls(
    [width, height]: [f64; 2],
    mut point: impl FnMut(V3),
    mut line: impl FnMut([usize; 2]),
) {
    let (w, h, d) = (width / 2.0, height / 2.0, depth(height));
    let mut count = 0;
    let mut segment = |a: V3, b: V3| {
        point(a);
        point(b);
        line([count, count + 1]);
        count += 2;
    };
    for i in 0..=CELLS {
        let share = i as f64 / CELLS as f64;
        let (x, y, z) = (w * (2.0 * share - 1.0), h * (2.0 * share - 1.0), -d * share);
        for side in [-1.0, 1.0] {
            // Floor and ceiling, left and right wall: along the view; the corner edges belong to the floor and the ceiling.
            segment([x, side * h, 0.0], [x, side * h, -d]);
            if i != 0 && i != CELLS {
                segment([side * w, y, 0.0], [side * w, y, -d]);
            }
            // Around the view.
            segment([-w, side * h, z], [w, side * h, z]);
            segment([side * w, -h, z], [side * w, h, z]);
        }
        if i != 0 && i != CELLS {
            // The back wall; its frame is there already.
            segment([x, -h, -d], [x, h, -d]);
            segment([-w, y, -d], [w, y, -d]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_twice_and_all_on_the_walls() {
        let (mut points, mut lines) = (Vec::new(), Vec::new());
        walls([520.0, 290.0], |p| points.push(p), |l| lines.push(l));
        let d = depth(290.0);
        for p in &points {
            let on = [p[0].abs() == 260.0, p[1].abs() == 145.0, p[2] == -d];
            assert!(on.contains(&true), "{p:?}");
        }
        let mut ends: Vec<_> = lines
            .iter()
            .map(|l| {
                let mut ends = l.map(|i| points[i].map(|x| (x * 16.0).round() as i64));
                ends.sort_unstable();
                ends
            })
            .collect();
        let count = ends.len();
        ends.sort_unstable();
        ends.dedup();
        assert_eq!(ends.len(), count);
        // 9 + 7 along the view and 18 around it on each pair of walls, 14 on the back wall.
        assert_eq!(count, 2 * (9 + 7 + 9 + 9) + 14);
    }

    #[test]
    fn the_cube_is_system_c_s() {
        let [low, high] = cube(480.0);
        assert_eq!((low, high), ([-120.0, -120.0, -340.0], [120.0, 120.0, -100.0]));
    }
}
