//! What a camera does to rays: focal lengths, principal point, distortion.
//!
//! ```text
//!  x = X / Z,  y = Y / Z                                     the camera's axes: x right, y down, z forward
//!  r2 = x^2 + y^2,   radial = 1 + k1 r2 + k2 r2^2 + k3 r2^3
//!  x' = x radial + 2 p1 x y + p2 (r2 + 2 x^2)
//!  y' = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
//!  pixel = (fx x' + cx, fy y' + cy)
//! ```
//!
//! Source: Brown, "Decentering distortion of lenses", 1966, as OpenCV numbers the coefficients: k1, k2, p1, p2, k3. Here pixel
//! centres lie at .5, so the principal point is OpenCV's plus 0.5; [`Lens::from_opencv`] and the calibration files convert.

use libm::tan;

/// A camera's intrinsics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// fx, fy in pixels.
    pub focal: [f64; 2],
    /// cx, cy in pixels; the first pixel's centre is (0.5, 0.5).
    pub centre: [f64; 2],
    /// k1, k2, p1, p2, k3.
    pub distortion: [f64; 5],
}

impl Lens {
    /// A lens without distortion for pictures of `width` x `height` pixels, `degrees` of field of view across the width (between 0
    /// and 180, both excluded), the principal point in the middle. `None` for other angles or an empty picture.
    pub fn from_field_of_view(width: usize, height: usize, degrees: f64) -> Option<Self> {
        if !(degrees > 0.0 && degrees < 180.0) || width == 0 || height == 0 {
            return None;
        }
        let (width, height) = (width as f64, height as f64);
        let focal = width / 2.0 / tan(degrees.to_radians() / 2.0);
        Some(Self { focal: [focal; 2], centre: [width / 2.0, height / 2.0], distortion: [0.0; 5] })
    }

    /// From OpenCV's camera matrix (row by row) and coefficients, whose pixel centres lie at .0. `None` when a focal length is not
    /// positive or anything is not finite.
    pub fn from_opencv(matrix: &[f64; 9], distortion: &[f64; 5]) -> Option<Self> {
        let lens = Self {
            focal: [matrix[0], matrix[4]],
            centre: [matrix[2] + 0.5, matrix[5] + 0.5],
            distortion: *distortion,
        };
        let all = lens.focal.iter().chain(&lens.centre).chain(&lens.distortion);
        let good = all.clone().all(|x| x.is_finite()) && lens.focal.iter().all(|&f| f > 0.0);
        good.then_some(lens)
    }

    /// OpenCV's camera matrix, row by row.
    pub fn to_opencv(&self) -> [f64; 9] {
        let ([fx, fy], [cx, cy]) = (self.focal, self.centre);
        [fx, 0.0, cx - 0.5, 0.0, fy, cy - 0.5, 0.0, 0.0, 1.0]
    }

    /// The same lens on a picture that was scaled by these factors.
    #[must_use]
    pub fn scaled(&self, across: f64, down: f64) -> Self {
        Self {
            focal: [self.focal[0] * across, self.focal[1] * down],
            centre: [self.centre[0] * across, self.centre[1] * down],
            ..*self
        }
    }

    /// The same lens without distortion.
    #[must_use]
    pub fn straight(&self) -> Self {
        Self { distortion: [0.0; 5], ..*self }
    }

    /// Where a point in the camera's axes falls, pixels; `None` when it isn't in front of the camera.
    pub fn project(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        (z > 1e-9).then(|| {
            let [x, y] = self.distorted([x / z, y / z]);
            [self.focal[0] * x + self.centre[0], self.focal[1] * y + self.centre[1]]
        })
    }

    /// Distorts a ray given as x / z, y / z.
    pub fn distorted(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }

    /// The ray x / z, y / z that falls on a pixel: the inverse of [`Lens::project`], by fixed-point iteration to 1e-10 where the
    /// distortion can be inverted; elsewhere the last step.
    pub fn ray(&self, pixel: [f64; 2]) -> [f64; 2] {
        let goal = [0, 1].map(|i| (pixel[i] - self.centre[i]) / self.focal[i]);
        if self.distortion == [0.0; 5] {
            return goal;
        }
        let mut ray = goal;
        for _ in 0..50 {
            let got = self.distorted(ray);
            let off = [goal[0] - got[0], goal[1] - got[1]];
            ray = [ray[0] + off[0], ray[1] + off[1]];
            if off[0].abs() + off[1].abs() < 1e-10 {
                break;
            }
        }
        if ray.iter().all(|x| x.is_finite()) { ray } else { goal }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_and_pixels_are_inverse() {
        let lens = Lens {
            focal: [600.0, 610.0],
            centre: [320.5, 240.5],
            distortion: [-0.3, 0.12, 0.001, -0.0005, -0.02],
        };
        for pixel in [[0.5, 0.5], [639.5, 479.5], [320.0, 17.0]] {
            let [x, y] = lens.ray(pixel);
            let back = lens.project([x * 3.0, y * 3.0, 3.0]).unwrap();
            assert!((0..2).all(|i| (back[i] - pixel[i]).abs() < 1e-6), "{pixel:?} {back:?}");
        }
        assert_eq!(lens.project([0.0, 0.0, 3.0]), Some([320.5, 240.5]));
        assert_eq!(lens.project([0.0, 0.0, -3.0]), None);
        assert_eq!(Lens::from_opencv(&lens.to_opencv(), &lens.distortion), Some(lens));
    }

    #[test]
    fn a_right_angle_across_the_width() {
        let lens = Lens::from_field_of_view(640, 480, 90.0).unwrap();
        assert!((lens.focal[0] - 320.0).abs() < 1e-9 && lens.centre == [320.0, 240.0]);
        assert_eq!(Lens::from_field_of_view(640, 480, 180.0), None);
        assert_eq!(Lens::from_field_of_view(0, 480, 60.0), None);
    }
}
