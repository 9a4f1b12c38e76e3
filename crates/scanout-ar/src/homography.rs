//! Homographies: maps of the plane that keep straight lines straight.
//!
//! ```text
//!  | x w |   | h0 h1 h2 |   | u |
//!  | y w | = | h3 h4 h5 | * | v |          from marker coordinates (u, v) to the picture (x, y)
//!  |   w |   | h6 h7  1 |   | 1 |
//! ```

use crate::quad::Corners;

/// A homography; its last entry is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography(pub [f64; 8]);

impl Homography {
    /// The one that maps (0, 0), (1, 0), (1, 1), (0, 1) to four corners in this order; `None` when three of them lie on a line.
    ///
    /// Source: Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989, section 2.2.3.
    pub fn from_unit_square(corners: &Corners) -> Option<Self> {
        let [[x0, y0], [x1, y1], [x2, y2], [x3, y3]] = *corners;
        let (dx1, dx2, sx) = (x1 - x2, x3 - x2, x0 - x1 + x2 - x3);
        let (dy1, dy2, sy) = (y1 - y2, y3 - y2, y0 - y1 + y2 - y3);
        let determinant = dx1 * dy2 - dx2 * dy1;
        let g = (sx * dy2 - dx2 * sy) / determinant;
        let h = (dx1 * sy - sx * dy1) / determinant;
        let map = Self([
            x1 - x0 + g * x1,
            x3 - x0 + h * x3,
            x0,
            y1 - y0 + g * y1,
            y3 - y0 + h * y3,
            y0,
            g,
            h,
        ]);
        (determinant.abs() > 1e-9 && map.0.iter().all(|entry| entry.is_finite())).then_some(map)
    }

    /// This map after the plane was stretched: (u, v) becomes (u / side, v / side) first.
    #[must_use]
    pub fn over_side(&self, side: f64) -> Self {
        let mut map = *self;
        for i in [0, 1, 3, 4, 6, 7] {
            map.0[i] /= side;
        }
        map
    }

    /// Where (u, v) falls.
    pub fn map(&self, u: f64, v: f64) -> [f64; 2] {
        let h = &self.0;
        let w = 1.0 / (h[6] * u + h[7] * v + 1.0);
        [(h[0] * u + h[1] * v + h[2]) * w, (h[3] * u + h[4] * v + h[5]) * w]
    }

    /// Where (u, v) falls and the derivatives there: `[dx/du, dx/dv, dy/du, dy/dv]`.
    pub fn map_with_derivatives(&self, u: f64, v: f64) -> ([f64; 2], [f64; 4]) {
        let h = &self.0;
        let w = 1.0 / (h[6] * u + h[7] * v + 1.0);
        let [x, y] = [(h[0] * u + h[1] * v + h[2]) * w, (h[3] * u + h[4] * v + h[5]) * w];
        let derivatives = [
            (h[0] - x * h[6]) * w,
            (h[1] - x * h[7]) * w,
            (h[3] - y * h[6]) * w,
            (h[4] - y * h[7]) * w,
        ];
        ([x, y], derivatives)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: Corners = [[20.0, 10.0], [80.0, 22.0], [70.0, 70.0], [12.0, 50.0]];

    #[test]
    fn corners_go_to_corners() {
        let map = Homography::from_unit_square(&CORNERS).unwrap().over_side(6.0);
        for (uv, want) in [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]].iter().zip(CORNERS) {
            let got = map.map(uv[0], uv[1]);
            assert!((got[0] - want[0]).abs() < 1e-9 && (got[1] - want[1]).abs() < 1e-9);
        }
    }

    #[test]
    fn derivatives_are_differences() {
        let map = Homography::from_unit_square(&CORNERS).unwrap().over_side(6.0);
        let (at, d) = map.map_with_derivatives(2.0, 3.5);
        let e = 1e-6;
        let (du, dv) = (map.map(2.0 + e, 3.5), map.map(2.0, 3.5 + e));
        let differences = [du[0] - at[0], dv[0] - at[0], du[1] - at[1], dv[1] - at[1]];
        assert!((0..4).all(|i| (differences[i] / e - d[i]).abs() < 1e-3), "{differences:?} {d:?}");
    }

    #[test]
    fn flat_corners_have_none() {
        let flat = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        assert_eq!(Homography::from_unit_square(&flat), None);
    }
}
