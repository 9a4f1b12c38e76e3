//! Corners from the grey values along the sides, before it is known which marker it is.
//!
//! Across each side profiles are sampled; on each the edge lies at the mean of the places where the grey rises outwards, weighted
//! by the square of the rise. A line is fitted to them, and the lines' crossings are the corners.
//!
//! Source: the edge refinement of AprilTag 3 (Krogius, Haggenmiller and Olson, 2019).

use crate::image::GreyImage;
use crate::line::{Line, LineSums};
use crate::quad::{Corners, is_convex, twice_area};
use libm::sqrt;

/// Steps of a profile on either side.
const REACH: i32 = 3;

/// Moves the corners of a dark quadrilateral on light ground to where its edges are; edges may be up to 3 pixels off. Sides without
/// any edge stay. `None` when what comes out is no quadrilateral.
pub fn refine(image: &GreyImage, corners: &Corners) -> Option<Corners> {
    let origin = corners[0];
    let area = twice_area(corners) / 2.0;
    let mut lines = [Line { normal: [0.0; 2], offset: 0.0 }; 4];
    for (side, line) in lines.iter_mut().enumerate() {
        let (a, b) = (corners[side], corners[(side + 1) % 4]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = sqrt(dx * dx + dy * dy);
        if length < 4.0 {
            return None;
        }
        // Clockwise on the screen: outwards is on the left.
        let outward = [dy / length, -dx / length];
        // Not beyond the border into the cells, an eighth or a sixth of the marker wide.
        let step = (0.15 * area / length / f64::from(REACH)).clamp(0.4, 1.0);
        let count = ((length / 3.0) as usize).clamp(6, 24);
        let mut sums = LineSums::default();
        for i in 0..count {
            // Corners are rounded off by blur.
            let along = 0.1 + 0.8 * (i as f64 + 0.5) / count as f64;
            let (x, y) = (a[0] + dx * along, a[1] + dy * along);
            let step_out = outward.map(|axis| axis * step);
            let inmost = f64::from(REACH);
            let start = [x - step_out[0] * inmost, y - step_out[1] * inmost];
            let values = image.line::<{ 2 * REACH as usize + 1 }>(start, step_out);
            let (mut weight, mut moment) = (0.0, 0.0);
            for (i, pair) in values.windows(2).enumerate() {
                let rise = f64::from(pair[1] - pair[0]);
                if rise > 0.0 {
                    weight += rise * rise;
                    moment += rise * rise * i as f64;
                }
            }
            if weight > 4.0 {
                let t = (moment / weight + 0.5 - inmost) * step;
                let point = [x + outward[0] * t - origin[0], y + outward[1] * t - origin[1]];
                sums.add(point, sqrt(weight));
            }
        }
        *line = match sums.fit() {
            Some((line, _)) => line,
            None => Line {
                normal: outward,
                offset: outward[0] * (a[0] - origin[0]) + outward[1] * (a[1] - origin[1]),
            },
        };
    }
    let mut fine = *corners;
    for (i, to) in fine.iter_mut().enumerate() {
        let [x, y] = lines[(i + 3) % 4].crossing(&lines[i])?;
        let moved = [x + origin[0], y + origin[1]];
        let (dx, dy) = (moved[0] - to[0], moved[1] - to[1]);
        // A corner that ran away came from profiles of something else.
        if dx * dx + dy * dy > f64::from(4 * REACH * REACH) {
            return None;
        }
        *to = moved;
    }
    is_convex(&fine).then_some(fine)
}
