//! Straight lines through many points: total least squares, weighted.

use libm::sqrt;

/// A line `n . p = c` with a unit normal n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The unit normal.
    pub normal: [f64; 2],
    /// The distance from the origin along it.
    pub offset: f64,
}

/// Weighted sums of points, from which a line is fitted. Coordinates should be small (relative to a nearby origin).
#[derive(Clone, Copy, Debug, Default)]
pub struct LineSums {
    weight: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl LineSums {
    /// Adds a point.
    pub fn add(&mut self, [x, y]: [f64; 2], weight: f64) {
        self.weight += weight;
        self.x += weight * x;
        self.y += weight * y;
        self.xx += weight * x * x;
        self.xy += weight * x * y;
        self.yy += weight * y * y;
    }

    /// The line with the least squared distances, and their mean. `None` without weight.
    pub fn fit(&self) -> Option<(Line, f64)> {
        if self.weight <= 0.0 {
            return None;
        }
        let (mx, my) = (self.x / self.weight, self.y / self.weight);
        let xx = self.xx / self.weight - mx * mx;
        let xy = self.xy / self.weight - mx * my;
        let yy = self.yy / self.weight - my * my;
        // The direction of the greatest extent turns by half the angle of (xx - yy, 2 xy) from the x axis; the normal is at right angles.
        let difference = sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
        let normal = if difference == 0.0 {
            [0.0, 1.0]
        } else if xx > yy {
            let cosine = sqrt((1.0 + (xx - yy) / difference) / 2.0);
            [-xy / (difference * cosine), cosine]
        } else {
            let sine = sqrt((1.0 + (yy - xx) / difference) / 2.0);
            [-sine, xy / (difference * sine)]
        };
        let line = Line { normal, offset: normal[0] * mx + normal[1] * my };
        Some((line, ((xx + yy - difference) / 2.0).max(0.0)))
    }
}

impl Line {
    /// The signed distance of a point.
    pub fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        self.normal[0] * x + self.normal[1] * y - self.offset
    }

    /// Where two lines cross; `None` when they are parallel.
    pub fn crossing(&self, other: &Line) -> Option<[f64; 2]> {
        let [a, b] = self.normal;
        let [c, d] = other.normal;
        let determinant = a * d - b * c;
        if determinant.abs() < 1e-6 {
            return None;
        }
        Some([
            (self.offset * d - b * other.offset) / determinant,
            (a * other.offset - self.offset * c) / determinant,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_points_and_a_crossing() {
        let mut sums = LineSums::default();
        for x in 0..9 {
            let x = f64::from(x);
            sums.add([x, 2.0 - x / 2.0], 1.0 + x);
        }
        let (line, mean) = sums.fit().unwrap();
        assert!(mean < 1e-12 && line.distance([20.0, -8.0]).abs() < 1e-9);
        let upright = Line { normal: [1.0, 0.0], offset: 4.0 };
        let [x, y] = line.crossing(&upright).unwrap();
        assert!((x - 4.0).abs() < 1e-9 && y.abs() < 1e-9);
        assert_eq!(upright.crossing(&upright), None);
        assert_eq!(LineSums::default().fit(), None);
    }
}
