//! A cube's wireframe on the marker, in system A's manner: a plane of one bit a pixel, mixed with the camera's pixels as they go to the
//! display.

use scanout::camera::{Camera, Viewpoint};
use scanout::frame::{Band, Frame, ObjectState, Primitive, Settings, Store};
use scanout::hash::FrameHash;
use scanout::math::{Mat4, Vec3};
use scanout::mesh::Mesh;
use scanout::output::{Mono, PixelFormat, Rgb565};
use scanout::overlay::mix_row;
use scanout::scene::{Material, Mode, Object, Scene};
use scanout::transform::Vertex;
use scanout_ar::{Lens, Pose};

use super::{HEIGHT, WIDTH};

/// Rows in a band.
const ROWS: usize = 16;
/// World units a metre.
const UNIT: f64 = 512.0;
const H: i16 = 16384;

static POSITIONS: [[i16; 3]; 8] = [
    [-H, -H, 0],
    [H, -H, 0],
    [H, H, 0],
    [-H, H, 0],
    [-H, -H, 32767],
    [H, -H, 32767],
    [H, H, 32767],
    [-H, H, 32767],
];
static EDGES: [[u16; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The hash of the frame's RGB565 bytes.
pub fn hash(camera: &[u8], lens: &Lens, pose: Option<&Pose>, size: f64) -> Option<u64> {
    let mut hash = FrameHash::new(WIDTH as u16, HEIGHT as u16, Rgb565::ID);
    draw(camera, lens, pose, size, |band| {
        Rgb565::bytes(band.colour, band.colour.len(), &mut |bytes| hash.update(bytes));
        Some(())
    })?;
    Some(hash.finish())
}

/// Draws the cube, if there is a pose, over the camera's picture, and hands the bands from the top to `send`. `None` when drawing or
/// sending fails.
pub fn draw(
    camera: &[u8],
    lens: &Lens,
    pose: Option<&Pose>,
    size: f64,
    mut send: impl FnMut(&Band<Rgb565>) -> Option<()>,
) -> Option<()> {
    let mesh = Mesh { positions: &POSITIONS, edges: &EDGES, ..Mesh::default() };
    let material = Material { colour: [255; 3], ..Material::default() };
    let transform = match pose {
        Some(pose) => eye(pose, size),
        None => Mat4::IDENTITY,
    };
    let objects = [Object { transform, ..Object::new(&mesh, &material, Mode::Wire) }];
    let shown = if pose.is_some() { &objects[..] } else { &[] };
    let scene = Scene::new(projection(lens), shown);
    let (mut vertices, mut primitives) = ([Vertex::default(); 8], [Primitive::default(); 12]);
    let mut states = [ObjectState::default(); 1];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
    let frame = Frame::prepare(&scene, Settings::new(WIDTH as u16, HEIGHT as u16), store).ok()?;
    const ROW: usize = WIDTH / 8;
    let (mut plane, mut depth) = ([0; ROW * ROWS], [0; WIDTH * ROWS]);
    let mut words = [0; WIDTH * ROWS];
    let drawn = frame.draw_bands::<Mono, ()>(ROWS as u16, &mut plane, &mut depth, |band| {
        let rows = band.colour.chunks(ROW).zip(words.chunks_mut(WIDTH)).enumerate();
        for (y, (bits, words)) in rows {
            let row = &camera[(usize::from(band.top) + y) * WIDTH..][..WIDTH];
            for (x, &grey) in row.iter().enumerate() {
                Rgb565::store(words, x, Rgb565::encode([grey; 3]));
            }
            mix_row::<Rgb565>(bits, words, WIDTH, [0; 3]);
        }
        let colour = &words[..usize::from(band.rows) * WIDTH];
        let Band { top, rows, width, .. } = band;
        send(&Band { top, rows, width, colour, depth: &[] }).ok_or(())
    });
    drawn.ok()
}

/// The cube's axes (side 1, on the paper) to the pipeline's eye: y and z turned about.
fn eye(pose: &Pose, size: f64) -> Mat4 {
    let row = |i: usize| {
        let sign = if i == 0 { UNIT } else { -UNIT };
        let [a, b, c] = pose.rotation[i].map(|x| x * size * sign);
        [a, b, c, pose.translation[i] * sign]
    };
    Mat4::from_f64([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]])
}

/// The pipeline's camera of this lens.
fn projection(lens: &Lens) -> Camera {
    let (w, h) = (WIDTH as f64, HEIGHT as f64);
    let ([fx, fy], [cx, cy]) = (lens.focal, lens.centre);
    let (near, far) = (16.0, 2048.0);
    let depth = far / (far - near);
    let projection = Mat4::from_f64([
        [2.0 * fx / w, 0.0, 1.0 - 2.0 * cx / w, 0.0],
        [0.0, 2.0 * fy / h, 2.0 * cy / h - 1.0, 0.0],
        [0.0, 0.0, -depth, -depth * near],
        [0.0, 0.0, -1.0, 0.0],
    ]);
    Camera { view: Mat4::IDENTITY, projection, viewpoint: Viewpoint::Point(Vec3::ZERO) }
}
