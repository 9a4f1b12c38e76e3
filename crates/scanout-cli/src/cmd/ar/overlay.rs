//! The model on the marker, drawn by the pipeline.
//!
//! ```text
//!  file -> marker: up out of the paper, middle of its foot on the marker's middle, as long as --model-size
//!  marker -> camera: the pose          camera -> eye: y and z change sign (the pipeline looks along -z, y up)
//!
//!  x_clip = 2 fx / W x - (2 cx / W - 1) z        pixel = (x_clip / w + 1) W / 2 = fx X / Z + cx
//!  y_clip = 2 fy / H y + (2 cy / H - 1) z        w = -z
//! ```
//!
//! A principal point off the middle shears the frustum. Pixel centres lie at .5 in intrinsics, markers and pipeline alike.

use std::path::Path;

use scanout::camera::{Camera, Viewpoint};
use scanout::math::{Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::Rgb888;
use scanout::scene::{Material, Mode, Object};
use scanout_ar::{Lens, Pose};

use crate::args::ar::ArArgs;
use crate::args::{DrawMode, PixelFormat};
use crate::cmd::info::scene_args;
use crate::draw;
use crate::error::{Error, Result};
use crate::image_out::Picture;
use crate::scene_builder::placed::{Affine, compose, matrix};
use crate::scene_builder::{Stage, load_model};
use crate::values::{Colour, Up};

/// How far the marker is away in the pipeline's world: Q16.16 is fine there whatever the unit.
const DISTANCE: f64 = 256.0;

/// A model that stands on a marker.
pub struct Overlay {
    stage: Stage,
    /// The file's coordinates to the marker's, metres.
    placement: Affine,
    /// Middle and radius of the model in the marker's axes, metres.
    ball: ([f64; 3], f64),
    /// Half the side of the paper that hides what is below it, metres.
    paper: Option<f64>,
}

impl Overlay {
    /// Loads the model.
    pub fn new(path: &Path, args: &ArArgs) -> Result<Self> {
        let mut scene = scene_args(&[]);
        scene.mode = args.mode;
        scene.smooth_lines = args.smooth_lines;
        // System A's manner: black where the wire is, the camera elsewhere.
        let lines = matches!(args.mode, Some(DrawMode::Wire | DrawMode::Hidden));
        scene.color = args.color.or(lines.then_some(Colour([0; 3])));
        let stage = Stage::with_models(vec![load_model(path, None)?], &scene)?;
        let points = &stage.subject.points;
        let upright = |p: &[f64; 3]| match args.up {
            Up::Y => [p[0], -p[2], p[1]],
            Up::Z => *p,
        };
        let [mut low, mut high] = [[f64::MAX; 3], [f64::MIN; 3]];
        for point in points.iter().map(upright) {
            low = std::array::from_fn(|i| low[i].min(point[i]));
            high = std::array::from_fn(|i| high[i].max(point[i]));
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]);
        // A model without a foot (an upright line) is measured by its height.
        let side = if side > 0.0 { side } else { high[2] - low[2] };
        let scale = args.model_size.unwrap_or(args.size).0 / if side > 0.0 { side } else { 1.0 };
        let sink = args.sink.map_or(0.0, |sink| sink.0);
        let foot = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, low[2]];
        let turn = match args.up {
            Up::Y => [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
            Up::Z => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        let placement: Affine = std::array::from_fn(|i| {
            let shift = -foot[i] * scale - if i == 2 { sink } else { 0.0 };
            let [a, b, c] = turn[i].map(|x| x * scale);
            [a, b, c, shift]
        });
        let height = (high[2] - low[2]) * scale;
        let middle = [0.0, 0.0, height / 2.0 - sink];
        let half = [0, 1].map(|i| (high[i] - low[i]) / 2.0 * scale);
        let radius = (half[0] * half[0] + half[1] * half[1] + height * height / 4.0).sqrt();
        let paper = args.sink.map(|_| 2.0 * radius.max(args.size.0));
        Ok(Self { stage, placement, ball: (middle, radius), paper })
    }

    /// Draws the model over a frame.
    ///
    /// # Errors
    /// What the pipeline refuses.
    pub fn draw(&self, lens: &Lens, pose: &Pose, frame: Picture) -> Result<Picture> {
        let middle = pose.apply(self.ball.0);
        let unit = DISTANCE / pose.translation[2].max(1e-6);
        // Depth has 16 bits: the planes stand as near as model and paper allow.
        let reach = self.paper.map_or(self.ball.1, |half| self.ball.1.max(1.5 * half));
        let (radius, distance) = (reach * unit * 1.02, middle[2] * unit);
        let far = distance + radius;
        if far <= 0.01 {
            return Ok(frame);
        }
        let near = (distance - radius).max(far / 512.0).max(0.01);
        let size = (frame.width, frame.height);
        let camera = camera(lens, size, near, far);
        let marker = to_eye(pose, unit);
        let to_world = compose(&marker, &self.placement);
        let draw = |paper: Option<[u8; 3]>| {
            let sheet = self.paper.unwrap_or(0.0);
            let material = Material {
                colour: paper.unwrap_or_default(),
                ambient: Q16::ONE,
                diffuse: Q16::ZERO,
                two_sided: true,
                ..Material::default()
            };
            let mesh = Mesh {
                positions: &[
                    [-32767, -32767, 0],
                    [32767, -32767, 0],
                    [32767, 32767, 0],
                    [-32767, 32767, 0],
                ],
                triangles: &[[0, 1, 2], [0, 2, 3]],
                ..Mesh::default()
            };
            let place = [[sheet, 0.0, 0.0, 0.0], [0.0, sheet, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
            let transform = matrix(&compose(&marker, &place));
            let others = [Object { transform, ..Object::new(&mesh, &material, Mode::Flat) }];
            let others = if paper.is_some() { &others[..] } else { &[] };
            self.stage.with_scene_at(camera, &to_world, others, &frame.pixels, |scene| {
                let (Ok(width), Ok(height)) = (u16::try_from(size.0), u16::try_from(size.1)) else {
                    return Err(Error::failed("frame", "it is too large", "make it smaller"));
                };
                let options = draw::Options {
                    format: PixelFormat::Rgb888,
                    dither: false,
                    bands: None,
                    threads: draw::processors(),
                };
                draw::scene::<Rgb888>(scene, (width, height), &options)
            })
        };
        let Some(_) = self.paper else {
            return draw(None).map(|pixels| Picture { pixels, ..frame });
        };
        // Paper that hides but isn't seen: where two colours of it differ, it is the nearest, and the camera's pixel stays.
        let (black, white) = (draw(Some([0; 3]))?, draw(Some([255; 3]))?);
        let pixels = black.iter().zip(&white).zip(&frame.pixels);
        let pixels = pixels.map(|((a, b), camera)| if a == b { *a } else { *camera }).collect();
        Ok(Picture { pixels, ..frame })
    }
}

/// The marker's axes (metres) to the pipeline's world: the camera's axes with y and z turned about, scaled.
fn to_eye(pose: &Pose, unit: f64) -> Affine {
    std::array::from_fn(|i| {
        let sign = if i == 0 { unit } else { -unit };
        let [a, b, c] = pose.rotation[i].map(|x| x * sign);
        [a, b, c, pose.translation[i] * sign]
    })
}

/// The pipeline's camera of a lens without distortion.
fn camera(lens: &Lens, (width, height): (usize, usize), near: f64, far: f64) -> Camera {
    let (w, h) = (width as f64, height as f64);
    let ([fx, fy], [cx, cy]) = (lens.focal, lens.centre);
    let depth = far / (far - near);
    let projection = Mat4::from_f64([
        [2.0 * fx / w, 0.0, 1.0 - 2.0 * cx / w, 0.0],
        [0.0, 2.0 * fy / h, 2.0 * cy / h - 1.0, 0.0],
        [0.0, 0.0, -depth, -depth * near],
        [0.0, 0.0, -1.0, 0.0],
    ]);
    Camera { view: Mat4::IDENTITY, projection, viewpoint: Viewpoint::Point(Vec3::ZERO) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point of the marker appears where the lens says, to a fiftieth of a pixel, which is what Q16.16 leaves: no half pixel is lost
    /// between intrinsics, camera and screen, nor with the principal point off the middle.
    #[test]
    fn points_appear_where_the_lens_says() {
        let lens = Lens { focal: [610.0, 600.0], centre: [350.0, 200.0], distortion: [0.0; 5] };
        let rotation = [[0.8, 0.6, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, -1.0]];
        let pose = Pose { rotation, translation: [0.05, -0.02, 0.5] };
        let unit = DISTANCE / 0.5;
        let camera = camera(&lens, (640, 480), 0.2 * unit, 0.9 * unit);
        let place = matrix(&to_eye(&pose, unit));
        for point in [[0.0, 0.0, 0.0], [0.04, 0.04, 0.0], [-0.04, 0.03, 0.08]] {
            let world = place.transform_point(Vec3::from_f64(point));
            // Q32.32 to Q16.16.
            let [x, y, z] = [0, 1, 2].map(|i| world[i] as f64 / 4294967296.0);
            let clip = camera.projection.transform_point(Vec3::from_f64([x, y, z]));
            let [x, y, _, w] = clip.map(|value| value as f64);
            let pixel = [(x / w + 1.0) * 320.0, (1.0 - y / w) * 240.0];
            let want = lens.project(pose.apply(point)).unwrap();
            assert!((0..2).all(|i| (pixel[i] - want[i]).abs() < 0.02), "{pixel:?} {want:?}");
        }
    }
}
