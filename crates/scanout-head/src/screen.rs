//! The physical screen: where it stands, and what an eye before it sees.
//!
//! ```text
//!   side view                      y          top leans back by `tilt`
//!            \                     |
//!             \  screen            |    eye   up     = (0, cos tilt, -sin tilt)
//!              \                   |     o    normal = (0, sin tilt,  cos tilt)
//!               o middle     ------+------ z  right  = (1, 0, 0)
//!                \
//! ```
//!
//! The camera is `scanout`'s off-axis one (Kooima 2009): a point of the scene appears where the straight line from the eye
//! to it meets the screen, whether it lies behind the glass or in front of it. World units are millimetres, Q16.16, so
//! everything within 32 m of the screen's middle can be drawn.

use scanout::camera::{Camera, CameraError, Screen as Corners};
use scanout::math::{Q16, Vec3};

use crate::V3;

/// A flat, rectangular screen in the viewer's coordinates (see the crate), millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Its middle.
    pub middle: V3,
    /// Unit vector along the lower edge, to the viewer's right.
    pub right: V3,
    /// Unit vector along the left edge, upwards, perpendicular to `right`.
    pub up: V3,
    /// Width and height of the picture itself, without the frame, mm.
    pub size: [f64; 2],
}

/// The least and the greatest side of a screen, mm.
pub const SIDES: [f64; 2] = [10.0, 20_000.0];

/// The nearest that [`Screen::before`] lets an eye come to the glass, mm.
pub const LEAST_DISTANCE: f64 = 20.0;

/// The farthest that [`Screen::before`] lets an eye be from the screen's middle along each axis, mm.
pub const GREATEST_DISTANCE: f64 = 20_000.0;

/// Why there is no such screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScreenError {
    /// A side is not within [`SIDES`].
    Size([f64; 2]),
    /// The tilt is not between -89 and 89 degrees.
    Tilt(f64),
}

impl core::fmt::Display for ScreenError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Size([w, h]) => {
                write!(f, "a screen of {w} x {h} mm; each side must be 10 to 20000 mm")
            }
            Self::Tilt(t) => write!(f, "a tilt of {t} degrees; it must lie between -89 and 89"),
        }
    }
}

impl core::error::Error for ScreenError {}

impl Screen {
    /// A screen of `width` x `height` mm around the origin whose top leans back by `tilt` degrees.
    ///
    /// # Errors
    /// A side outside [`SIDES`], or a tilt that is not within 89 degrees.
    pub fn new(width: f64, height: f64, tilt: f64) -> Result<Screen, ScreenError> {
        if ![width, height].iter().all(|side| (SIDES[0]..=SIDES[1]).contains(side)) {
            return Err(ScreenError::Size([width, height]));
        }
        if !(-89.0..=89.0).contains(&tilt) {
            return Err(ScreenError::Tilt(tilt));
        }
        let (sin, cos) = libm::sincos(tilt.to_radians());
        Ok(Screen {
            middle: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            up: [0.0, cos, -sin],
            size: [width, height],
        })
    }

    /// Out of the glass, towards the viewer: `right` x `up`.
    pub fn normal(&self) -> V3 {
        let ([a, b, c], [d, e, f]) = (self.right, self.up);
        [b * f - c * e, c * d - a * f, a * e - b * d]
    }

    /// The place at `x` half widths to the right and `y` half heights above the middle; the corners are at -1 and 1.
    pub fn at(&self, x: f64, y: f64) -> V3 {
        let [w, h] = self.size;
        core::array::from_fn(|i| {
            self.middle[i] + self.right[i] * (x * w / 2.0) + self.up[i] * (y * h / 2.0)
        })
    }

    /// A place's coordinates along the screen's own axes (right, up, out of the glass) from its middle.
    pub fn own(&self, place: V3) -> V3 {
        let from: V3 = core::array::from_fn(|i| place[i] - self.middle[i]);
        [self.right, self.up, self.normal()]
            .map(|axis| (0..3).map(|i| from[i] * axis[i]).sum::<f64>())
    }

    /// The place with these coordinates along the screen's own axes: the inverse of [`Self::own`].
    pub fn place(&self, [x, y, z]: V3) -> V3 {
        let n = self.normal();
        core::array::from_fn(|i| self.middle[i] + self.right[i] * x + self.up[i] * y + n[i] * z)
    }

    /// The nearest place to `eye` from which the screen can be seen: at least [`LEAST_DISTANCE`] before the glass and at most
    /// [`GREATEST_DISTANCE`] away. What isn't finite becomes the place 600 mm before the middle.
    pub fn before(&self, eye: V3) -> V3 {
        if !eye.iter().all(|x| x.is_finite()) {
            return self.place([0.0, 0.0, 600.0]);
        }
        let [x, y, z] = self.own(eye);
        let far = GREATEST_DISTANCE;
        self.place([x.clamp(-far, far), y.clamp(-far, far), z.clamp(LEAST_DISTANCE, far)])
    }

    /// The part of the screen in its middle with these shares of width and height: the window of an eye whose picture is
    /// a half of the screen in natural proportions.
    pub fn part(&self, width: f64, height: f64) -> Screen {
        Screen { size: [self.size[0] * width, self.size[1] * height], ..*self }
    }

    /// The corners as the pipeline takes them, mm in Q16.16 to nearest.
    pub fn corners(&self) -> Corners {
        let corner = |x, y| Vec3::from_f64(self.at(x, y));
        Corners {
            lower_left: corner(-1.0, -1.0),
            lower_right: corner(1.0, -1.0),
            upper_left: corner(-1.0, 1.0),
        }
    }

    /// What `eye` sees through the screen, from `near` to `far` mm before it along the normal. Objects between the eye and the
    /// glass are seen when they lie beyond `near`.
    ///
    /// # Errors
    /// Those of [`Camera::off_axis`]: the eye is not in front of the glass, or not 0 < near < far.
    pub fn camera(&self, eye: V3, near: f64, far: f64) -> Result<Camera, CameraError> {
        let [near, far] = [near, far].map(Q16::from_f64);
        Camera::off_axis(Vec3::from_f64(eye), &self.corners(), near, far)
    }
}

/// Where the two eyes are when the middle between them is at `middle`: `distance` mm apart along the screen's width, left
/// first. The head's roll is not asked: eyes that are not level with the screen cannot be served by one anyway.
pub fn eyes(screen: &Screen, middle: V3, distance: f64) -> [V3; 2] {
    [-0.5, 0.5]
        .map(|side| core::array::from_fn(|i| middle[i] + screen.right[i] * (side * distance)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_screen_leans_back_and_looks_up() {
        let screen = Screen::new(500.0, 300.0, 30.0).unwrap();
        let top = screen.at(0.0, 1.0);
        assert!(top[1] > 129.0 && top[1] < 130.0 && top[2] < -74.9 && top[2] > -75.1, "{top:?}");
        let normal = screen.normal();
        assert!((normal[1] - 0.5).abs() < 1e-12 && normal[2] > 0.86, "{normal:?}");
    }

    #[test]
    fn own_and_place_are_inverse() {
        let screen =
            Screen { middle: [3.0, -4.0, 5.0], ..Screen::new(500.0, 300.0, -17.0).unwrap() };
        for place in [[0.0; 3], [100.0, -50.0, 600.0], [-7.0, 8.0, -9.0]] {
            let back = screen.place(screen.own(place));
            assert!((0..3).all(|i| (back[i] - place[i]).abs() < 1e-9), "{back:?} {place:?}");
        }
        let corner = screen.own(screen.at(1.0, -1.0));
        assert!((0..3).all(|i| (corner[i] - [250.0, -150.0, 0.0][i]).abs() < 1e-9));
    }

    #[test]
    fn an_eye_stays_before_the_glass() {
        let screen = Screen::new(500.0, 300.0, 40.0).unwrap();
        for eye in [[0.0, 0.0, -500.0], [0.0; 3], [1e12, -1e12, 1e12], [0.0, 1000.0, -1000.0]] {
            let eye = screen.before(eye);
            assert!(screen.own(eye)[2] >= LEAST_DISTANCE - 1e-6, "{eye:?}");
            assert!(screen.camera(eye, 1.0, 30_000.0).is_ok(), "{eye:?}");
        }
        let normal = screen.before([f64::NAN, 0.0, 0.0]);
        assert!((screen.own(normal)[2] - 600.0).abs() < 1e-9);
        let fine = [12.0, 34.0, 567.0];
        let kept = screen.before(fine);
        assert!((0..3).all(|i| (kept[i] - fine[i]).abs() < 1e-9));
    }

    #[test]
    fn impossible_screens() {
        assert_eq!(Screen::new(5.0, 300.0, 0.0), Err(ScreenError::Size([5.0, 300.0])));
        assert!(Screen::new(f64::NAN, 300.0, 0.0).is_err());
        assert_eq!(Screen::new(500.0, 300.0, 90.0), Err(ScreenError::Tilt(90.0)));
        assert!(Screen::new(500.0, 300.0, f64::NAN).is_err());
    }

    #[test]
    fn eyes_lie_along_the_width() {
        let screen = Screen::new(500.0, 300.0, 20.0).unwrap();
        assert_eq!(eyes(&screen, [1.0, 2.0, 3.0], 63.0), [[-30.5, 2.0, 3.0], [32.5, 2.0, 3.0]]);
    }
}
