//! Where the camera stands: from options, or so that the model fills the view.
//!
//! ```text
//!            up                 eye = focal + back * distance
//!            |   back           azimuth turns the basis about the view's up axis, elevation about `right`,
//!            |  /               roll about `back`
//!      focal +----- right
//! ```
//!
//! All in f64 and in the coordinates of the model's file. [`View::cameras`] moves to the pipeline's world (see
//! [`World`]) and fixed point.

use scanout::camera::{Camera, CameraError, Screen, projection};
use scanout::math::{Angle, Mat4, Q16, Vec3};

use super::vector::{V3, along, cross, dot, length, minus, normalised, sin_cos, turned};
use crate::args::{CameraArgs, Stereo};
use crate::error::{Error, Result};
use crate::stereo::{arrangement, eye_sizes, proportions};
use crate::values::Up;

/// How much of the view a fitted model leaves free, as a factor of its size.
const MARGIN: f64 = 1.06;

/// The radius that a scene has in the pipeline's world: large enough that Q16.16 is fine, small enough that a
/// distant camera fits.
const RADIUS: f64 = 64.0;

/// The farthest that a camera may stand in the pipeline's world.
const REACH: f64 = 8192.0;

/// The farthest that a camera may stand from the subject's middle, and look at, in radii: depth has 16 bits.
const FAR_AWAY: f64 = 100_000.0;

/// Refuses a place out of reach, and names the option that gave it.
fn within_reach(subject: &Subject, option: &str, place: V3) -> Result<()> {
    let limit = subject.radius * FAR_AWAY;
    let distance = length(minus(place, subject.centre));
    if distance <= limit {
        return Ok(());
    }
    let [x, y, z] = subject.centre;
    Err(Error::usage(
        format_args!("{option} is {distance:.4e} away from the model"),
        format_args!("stay within {limit:.4e} of its middle {x:.4},{y:.4},{z:.4}"),
    ))
}

/// What is to be seen: the ball around it, and its points.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Middle of the bounding box.
    pub centre: V3,
    /// Distance of the farthest point from the middle, above 0.
    pub radius: f64,
    /// The points.
    pub points: Vec<V3>,
}

/// From the file's coordinates to the pipeline's world: `(p - origin) * scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct World {
    /// The subject's centre.
    pub origin: V3,
    /// World units a unit of the file.
    pub scale: f64,
}

impl World {
    /// A place.
    pub fn point(&self, p: V3) -> Vec3 {
        Vec3::from_f64(minus(p, self.origin).map(|x| x * self.scale))
    }

    /// A length.
    pub fn length(&self, l: f64) -> Q16 {
        Q16::from_f64(l * self.scale)
    }
}

/// A camera on its way: a place and a basis that the options or the mouse turn.
#[derive(Clone, Debug)]
pub struct View {
    /// What it looks at.
    pub focal: V3,
    /// Unit vectors right, up and back (towards the viewer).
    pub basis: [V3; 3],
    /// The axis about which azimuth turns.
    pub axis: V3,
    /// From eye to focal point.
    pub distance: f64,
    /// Vertical field of view, degrees.
    pub fovy: f64,
    /// Enlargement of the picture.
    pub zoom: f64,
    /// Parallel projection; the picture is as large as the perspective one at the focal point.
    pub orthographic: bool,
    /// Two eyes and their distance.
    pub stereo: Option<(Stereo, Option<f64>)>,
    /// The right eye's picture where the left eye's belongs.
    pub swap_eyes: bool,
    /// The axis about which the model turns, a unit vector.
    pub turn_axis: V3,
    /// The off-axis eye and screen.
    pub window: Option<(V3, [f64; 2])>,
    centre: V3,
    radius: f64,
}

/// What the distance must allow for when it is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// This picture: tight around the points.
    Tight,
    /// A turn of the model about [`View::turn_axis`]: tight around the points wherever it brings them.
    Turn,
    /// Any turn of the model: around the ball.
    Ball,
}

/// Pictures of a turn that are looked at to fit it; the points of a finer turn lie within 1 / 500 of these.
const SWEEP: i32 = 48;

/// The points in all positions of a turn.
fn swept(points: &[V3], centre: V3, axis: V3) -> Vec<V3> {
    let angles = (0..SWEEP).map(|step| 360.0 * f64::from(step) / f64::from(SWEEP));
    let turned_to =
        |angle| move |p: &V3| along(centre, turned(minus(*p, centre), axis, angle), 1.0);
    angles.flat_map(|angle| points.iter().map(turned_to(angle))).collect()
}

impl View {
    /// The view that the options ask for, of a picture `aspect` = width / height.
    pub fn new(args: &CameraArgs, subject: &Subject, aspect: f64, fit: Fit) -> Result<Self> {
        let (mut axis, front) = match args.up {
            Up::Y => ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            Up::Z => ([0.0, 0.0, 1.0], [0.0, -1.0, 0.0]),
        };
        if let Some(up) = args.camera_view_up {
            axis = normalised(up.0).ok_or_else(|| {
                Error::usage("--camera-view-up has no direction", "give a vector longer than 0")
            })?;
        }
        let focal = args.camera_focal_point.map_or(subject.centre, |focal| focal.0);
        within_reach(subject, "--camera-focal-point", focal)?;
        let position = args.camera_position.map_or(subject.centre, |position| position.0);
        within_reach(subject, "--camera-position", position)?;
        let eye = args.eye.map_or([0.0; 3], |eye| eye.0);
        within_reach(subject, "--eye", along(subject.centre, eye, 1.0))?;
        let standing = args.camera_position.map(|position| minus(position.0, focal));
        let back = match standing {
            None => front,
            Some(gaze) => normalised(gaze).ok_or_else(|| {
                Error::usage("camera and focal point are the same", "move --camera-position")
            })?,
        };
        let right = normalised(cross(axis, back)).filter(|_| dot(axis, back).abs() < 0.999_999);
        let right = match right {
            Some(right) => right,
            None if args.camera_view_up.is_some() => {
                return Err(Error::usage(
                    "--camera-view-up points along the view",
                    "choose another direction",
                ));
            }
            None => [1.0, 0.0, 0.0],
        };
        let turn_axis = match args.rotation_axis {
            None => axis,
            Some(axis) => normalised(axis.0).ok_or_else(|| {
                Error::usage("--rotation-axis has no direction", "give a vector longer than 0")
            })?,
        };
        let mut view = Self {
            focal,
            turn_axis,
            basis: [right, cross(back, right), back],
            axis,
            distance: args.eye.map_or(standing.map_or(1.0, length), |eye| eye.0[2]),
            fovy: args.camera_view_angle,
            zoom: args.zoom,
            orthographic: args.orthographic,
            stereo: args.stereo.map(|how| (how, args.eye_distance)),
            swap_eyes: args.swap_eyes,
            window: args.eye.zip(args.screen).map(|(eye, screen)| (eye.0, screen.0)),
            centre: subject.centre,
            radius: subject.radius,
        };
        let unless_placed = |angle| if standing.is_some() { 0.0 } else { angle };
        // A screen is placed upright and seen from its front.
        let (azimuth, elevation) = if view.window.is_some() { (0.0, 0.0) } else { (30.0, 20.0) };
        view.orbit(
            args.azimuth.unwrap_or(unless_placed(azimuth)),
            args.elevation.unwrap_or(unless_placed(elevation)),
        );
        view.roll(args.roll);
        if standing.is_none() && view.window.is_none() {
            let centred = args.camera_focal_point.is_none();
            match fit {
                Fit::Tight if centred => view.fit_points(&subject.points, aspect),
                Fit::Turn if centred => {
                    let points = swept(&subject.points, subject.centre, view.turn_axis);
                    view.fit_points(&points, aspect);
                }
                _ => view.fit_ball(aspect),
            }
        }
        Ok(view)
    }

    /// Walks around the subject: to the right, and upwards; degrees.
    pub fn orbit(&mut self, azimuth: f64, elevation: f64) {
        self.basis = self.basis.map(|v| turned(v, self.axis, azimuth));
        let right = self.basis[0];
        self.basis = self.basis.map(|v| turned(v, right, -elevation));
    }

    /// Tilts the camera, clockwise for the camera; degrees.
    pub fn roll(&mut self, degrees: f64) {
        let back = self.basis[2];
        self.basis = self.basis.map(|v| turned(v, back, -degrees));
    }

    /// Cotangents of half the fields of view: horizontal and vertical, without zoom.
    fn focal_factors(&self, aspect: f64) -> (f64, f64) {
        let (sin, cos) = sin_cos(self.fovy / 2.0);
        (cos / sin / aspect, cos / sin)
    }

    /// Places the eye so that the ball around the subject's middle just fits, however the model turns.
    pub fn fit_ball(&mut self, aspect: f64) {
        let (fx, fy) = self.focal_factors(aspect);
        let f = fx.max(fy); // the narrower field of view decides
        let radius = self.radius + length(minus(self.focal, self.centre));
        // The ball touches the frustum's sides: sin(half angle) = radius / distance.
        let factor = if self.orthographic { f } else { (1.0 + f * f).sqrt() };
        self.distance = radius * factor * 1.02;
    }

    /// Places the eye and the focal point so that the points fill the view in this direction.
    fn fit_points(&mut self, points: &[V3], aspect: f64) {
        let (fx, fy) = self.focal_factors(aspect);
        let factors = [fx * MARGIN, fy * MARGIN];
        // Moving the middle changes the distance and the other way round; a few rounds settle within a pixel.
        for round in 0..=6 {
            let (focal, basis, flat) = (self.focal, self.basis, self.orthographic);
            let deep = |rel: V3| if flat { 0.0 } else { dot(rel, basis[2]) };
            let rels = || points.iter().map(|p| minus(*p, focal));
            // Each eye sees a point e to the side, e deep / distance of which the sheared frustum takes back:
            // distance >= deep + (|x| + e |deep| / distance) fx, solved for the distance.
            let eye = self.stereo.and_then(|(_, apart)| apart).unwrap_or(0.0) / 2.0;
            let by_both_eyes = |rel: V3| {
                let b = deep(rel) + dot(rel, basis[0]).abs() * fx;
                b / 2.0 + (b * b / 4.0 + eye * deep(rel).abs() * fx).sqrt()
            };
            let distance = rels()
                .map(|rel| {
                    let side = |i: usize| dot(rel, basis[i]).abs() * factors[i];
                    (deep(rel) + side(0).max(side(1))).max(by_both_eyes(rel))
                })
                .fold(self.radius * 1e-6, f64::max);
            self.distance = distance;
            if round == 6 {
                break; // the last look only chooses the distance, so that no point is pushed out
            }
            for axis in &basis[..2] {
                // Where the outermost points appear, and at which depth.
                let seen = rels().map(|rel| {
                    let depth = (distance - deep(rel)).max(f64::MIN_POSITIVE);
                    (dot(rel, *axis) / depth, depth)
                });
                let start = ((f64::MAX, 0.0), (f64::MIN, 0.0));
                let (low, high) = seen.fold(start, |(low, high), at| {
                    (if at.0 < low.0 { at } else { low }, if at.0 > high.0 { at } else { high })
                });
                // Moving the camera by m moves a point at depth d by m / d.
                let shift = (low.0 + high.0) / (1.0 / low.1 + 1.0 / high.1);
                if shift.is_finite() {
                    self.focal = along(self.focal, *axis, shift);
                }
            }
        }
    }

    /// Where the eye is.
    pub fn eye(&self) -> V3 {
        match self.window {
            Some((eye, _)) => (0..3).fold(self.focal, |sum, i| along(sum, self.basis[i], eye[i])),
            // A parallel eye stands outside the subject, so that nothing is cut off.
            None if self.orthographic => {
                along(self.focal, self.basis[2], self.distance.max(self.radius * 2.5))
            }
            None => along(self.focal, self.basis[2], self.distance),
        }
    }

    /// The pipeline's world for this view.
    pub fn world(&self) -> World {
        let reach = length(minus(self.eye(), self.centre)) + self.radius;
        let scale = (RADIUS / self.radius).min(REACH / reach);
        World { origin: self.centre, scale }
    }

    /// The near and the far plane: as tight as the ball allows, since depth has 16 bits.
    fn planes(&self) -> (f64, f64) {
        let middle = dot(minus(self.eye(), self.centre), self.basis[2]);
        let far = (middle + self.radius * 1.02).max(self.radius * 0.1);
        let near = (middle - self.radius * 1.02).max(far / 512.0);
        (near, far)
    }

    /// The cameras for a frame of `width` x `height` pixels with the size of each eye's picture: one, or left and right.
    pub fn cameras(&self, width: u16, height: u16) -> Result<Vec<(Camera, (u16, u16))>> {
        let cameras = match self.stereo {
            None => self.camera(width, height, 0.0).map(|camera| vec![(camera, (width, height))]),
            Some((how, _)) if eye_sizes(how, width, height).iter().any(|s| s.0.min(s.1) == 0) => {
                return Err(Error::usage("the picture is too small for two eyes", "enlarge it"));
            }
            Some((how, distance)) => {
                let half = distance.unwrap_or(self.distance / 30.0) / 2.0;
                let half = if self.swap_eyes { -half } else { half };
                let eye = |size: (u16, u16), x| {
                    let (w, h) = proportions(how, size, (width, height));
                    self.camera(w, h, x).map(|camera| (camera, size))
                };
                let [left, right] = eye_sizes(how, width, height);
                eye(left, -half).and_then(|left| Ok(vec![left, eye(right, half)?]))
            }
        };
        cameras.map_err(|error| {
            Error::failed("camera", error, "change the --camera options, --zoom or --eye")
        })
    }

    /// One eye, `x` to the right of the middle; the plane through the focal point stays where it is in the picture.
    fn camera(&self, width: u16, height: u16, x: f64) -> std::result::Result<Camera, CameraError> {
        let world = self.world();
        let (near, far) = self.planes();
        let (near, far) = (world.length(near), world.length(far));
        let [right, up, _] = self.basis;
        if let Some((_, [w, h])) = self.window {
            // A half in natural proportions is a window half as large.
            let share = self.stereo.map_or((1.0, 1.0), |(how, _)| arrangement(how).share());
            let (w, h) = (w * share.0, h * share.1);
            let corner = |i: f64, j: f64| {
                world.point(along(along(self.focal, right, i * w / 2.0), up, j * h / 2.0))
            };
            let screen = Screen {
                lower_left: corner(-1.0, -1.0),
                lower_right: corner(1.0, -1.0),
                upper_left: corner(-1.0, 1.0),
            };
            return Camera::off_axis(world.point(along(self.eye(), right, x)), &screen, near, far);
        }
        let aspect = Q16::from_ratio(width.into(), height.into());
        let mut matrix = if self.orthographic {
            let (pixels, height) = (height, 2.0 * self.distance / self.focal_factors(1.0).1);
            let width = height * f64::from(width) / f64::from(pixels);
            projection::orthographic(world.length(width), world.length(height), near, far)?
        } else {
            projection::perspective(Angle::from_degrees_f64(self.fovy), aspect, near, far)?
        };
        magnify(&mut matrix, self.zoom);
        let camera =
            Camera::look_at(world.point(self.eye()), world.point(self.focal), up_of(up), matrix)?;
        if x == 0.0 {
            return Ok(camera);
        }
        let pair = camera.stereo_pair(world.length(x.abs() * 2.0), world.length(self.distance))?;
        Ok(pair[usize::from(x > 0.0)])
    }
}

fn up_of(up: V3) -> Vec3 {
    Vec3::from_f64(up.map(|x| x * 256.0))
}

fn magnify(matrix: &mut Mat4, zoom: f64) {
    for row in 0..2 {
        matrix.m[row][row] = (matrix.m[row][row] as f64 * zoom) as i64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cmd::info::scene_args;

    /// The corners of a box that lies far from the origin.
    fn subject() -> Subject {
        let corner = |i: u8| {
            std::array::from_fn(|axis| {
                [1000.0, -50.0, 7.0][axis] + [3.0, 1.0, 2.0][axis] * f64::from(i >> axis & 1)
            })
        };
        let centre = [1001.5, -49.5, 8.0];
        let points: Vec<V3> = (0..8).map(corner).collect();
        Subject { centre, radius: length(minus(points[0], centre)), points }
    }

    /// The farthest that a point lies from the picture's middle: 1 is the edge.
    fn reach(camera: &Camera, world: &World, points: &[V3]) -> f64 {
        let matrix = camera.projection.mul(&camera.view);
        let one = |p: &V3| {
            let [x, y, z, w] = matrix.transform_point(world.point(*p)).map(|v| v as f64);
            assert!(0.0 < z && z < w, "between near and far");
            (x.abs() / w).max(y.abs() / w)
        };
        points.iter().map(one).fold(0.0, f64::max)
    }

    #[test]
    fn the_model_fills_the_view() {
        for options in ["", "--orthographic", "--up +Z", "--azimuth 200 --elevation -70 --roll 9"] {
            for aspect in [(640, 480), (100, 400)] {
                let args = scene_args(&options.split_whitespace().collect::<Vec<_>>()).camera;
                let ratio = f64::from(aspect.0) / f64::from(aspect.1);
                let view = View::new(&args, &subject(), ratio, Fit::Tight).unwrap();
                let camera = view.cameras(aspect.0, aspect.1).unwrap()[0].0;
                let reach = reach(&camera, &view.world(), &subject().points);
                assert!((0.93..0.96).contains(&reach), "{options} {aspect:?}: {reach}");
            }
        }
    }

    #[test]
    fn a_fitted_ball_stays_inside_however_it_turns() {
        for options in ["", "--orthographic", "--camera-view-angle 90"] {
            for size in [(640, 480), (100, 400)] {
                let args = scene_args(&options.split_whitespace().collect::<Vec<_>>()).camera;
                let ratio = f64::from(size.0) / f64::from(size.1);
                let mut view = View::new(&args, &subject(), ratio, Fit::Ball).unwrap();
                let mut most = 0.0;
                for _ in 0..30 {
                    let camera = view.cameras(size.0, size.1).unwrap()[0].0;
                    most = f64::max(most, reach(&camera, &view.world(), &subject().points));
                    view.orbit(12.0, 0.0);
                }
                assert!(most < 1.0 && most > 0.6, "{options} {size:?}: {most}");
            }
        }
    }

    #[test]
    fn both_eyes_see_the_whole_model() {
        for apart in ["0.1", "3", "20", "200"] {
            let args = scene_args(&["--stereo", "anaglyph", "--eye-distance", apart]).camera;
            let view = View::new(&args, &subject(), 1.5, Fit::Tight).unwrap();
            let both = view.cameras(600, 400).unwrap();
            let reaches = both.iter().map(|eye| reach(&eye.0, &view.world(), &subject().points));
            let most = reaches.fold(0.0, f64::max);
            assert!((0.9..1.001).contains(&most), "{apart}: {most}");
        }
    }

    #[test]
    fn a_fitted_turn_fills_the_view_and_stays_inside() {
        let args = scene_args(&[]).camera;
        let view = View::new(&args, &subject(), 1.5, Fit::Turn).unwrap();
        let camera = view.cameras(600, 400).unwrap()[0].0;
        let ring = swept(&subject().points, subject().centre, view.turn_axis);
        let most = reach(&camera, &view.world(), &ring);
        assert!((0.93..0.96).contains(&most), "{most}");
    }

    #[test]
    fn a_placed_camera_stands_where_it_was_told() {
        let place = ["--camera-position", "1001.5,-49.5,30", "--azimuth", "90"];
        let view = View::new(&scene_args(&place).camera, &subject(), 1.0, Fit::Tight).unwrap();
        assert_eq!(view.eye(), [1023.5, -49.5, 8.0]);
        let up = ["--camera-position", "1001.5,100,8"];
        assert!(View::new(&scene_args(&up).camera, &subject(), 1.0, Fit::Tight).is_ok());
    }
}
