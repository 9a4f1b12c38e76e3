//! Frames of the head-tracked window: system C's room behind the glass, seen by two eyes, composed row by row in a memory of a few kilobytes.

use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::hash::{FORMAT_RGB888, FrameHash};
use scanout::math::{Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::{Rgb565, widen565};
use scanout::scene::{Light, LightKind, Material, Mode, Object, Scene};
use scanout::transform::Vertex;
use scanout_head::room;
use scanout_head::screen::{Screen, eyes};
use scanout_head::stereo::{Arrangement, Place, mix};

/// Width of the frame in pixels.
const WIDTH: usize = 64;

/// Height of the frame in pixels.
const HEIGHT: usize = 48;

/// The screen's sides in millimetres.
const SIZE: [f64; 2] = [132.0, 99.0];

/// Lines of the room.
const LINES: usize = 82;

/// Parts of a millimetre in a position of the mesh.
const PARTS: f64 = 200.0;

/// Where the middle between the eyes is, millimetres.
pub const MIDDLES: [[f64; 3]; 4] =
    [[0.0, 0.0, 300.0], [60.0, -20.0, 250.0], [-90.0, 40.0, 400.0], [10.0, 5.0, 120.0]];

/// How the eyes become one picture.
pub const ARRANGEMENTS: [(&str, Arrangement); 4] = [
    ("dubois", Arrangement::AnaglyphDubois),
    ("rows", Arrangement::Interlaced),
    ("halves", Arrangement::SideBySideHalf),
    ("over", Arrangement::TopBottom),
];

/// The room's points and lines, and the cube in it.
struct Scenery {
    points: [[i16; 3]; 2 * LINES],
    lines: [[u16; 2]; LINES],
    cube: [[i16; 3]; 8],
}

impl Scenery {
    fn new() -> Scenery {
        let place = |p: [f64; 3]| p.map(|v| libm::round(v * PARTS) as i16);
        let (mut points, mut lines) = ([[0; 3]; 2 * LINES], [[0; 2]; LINES]);
        let (mut point, mut line) = (points.iter_mut(), lines.iter_mut());
        room::walls(
            SIZE,
            |p| {
                if let Some(slot) = point.next() {
                    *slot = place(p);
                }
            },
            |ends| {
                if let Some(slot) = line.next() {
                    *slot = ends.map(|i| i as u16);
                }
            },
        );
        let [low, high] = room::cube(SIZE[1]);
        let corner = |i: usize| {
            core::array::from_fn(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] })
        };
        Scenery { points, lines, cube: core::array::from_fn(|i| place(corner(i))) }
    }
}

/// Two triangles a side, counter-clockwise from outside; bit 0 of an index is x, bit 1 y, bit 2 z.
const CUBE: [[u16; 3]; 12] = [
    [4, 5, 7],
    [4, 7, 6],
    [1, 0, 2],
    [1, 2, 3],
    [0, 4, 6],
    [0, 6, 2],
    [5, 1, 3],
    [5, 3, 7],
    [6, 7, 3],
    [6, 3, 2],
    [0, 1, 5],
    [0, 5, 4],
];

/// Draws one row of what an eye sees in a picture of `size` pixels.
fn row(
    scenery: &Scenery,
    screen: &Screen,
    eye: [f64; 3],
    size: (usize, usize),
    y: usize,
    colour: &mut [u16; WIDTH],
) -> Option<()> {
    let room = Mesh { positions: &scenery.points, edges: &scenery.lines, ..Mesh::default() };
    let cube = Mesh { positions: &scenery.cube, triangles: &CUBE, ..Mesh::default() };
    let green = Material { colour: [60, 200, 90], ..Material::default() };
    let amber = Material { colour: [250, 170, 40], ..Material::default() };
    let mut objects =
        [Object::new(&room, &green, Mode::Wire), Object::new(&cube, &amber, Mode::Flat)];
    for object in &mut objects {
        // Positions are in 1 / 32768.
        object.transform = Mat4::uniform_scale(Q16::from_f64(32_768.0 / PARTS));
    }
    let lights = [Light { kind: LightKind::Directional(Vec3::Z), colour: [255; 3] }];
    let mut scene = Scene::new(screen.camera(eye, 20.0, 1000.0).ok()?, &objects);
    scene.lights = &lights;
    let store = Store {
        vertices: &mut [Vertex::default(); 2 * LINES + 8],
        primitives: &mut [Primitive::default(); LINES + 12],
        objects: &mut [ObjectState::default(); 2],
    };
    let frame = Frame::prepare(&scene, Settings::new(size.0 as u16, size.1 as u16), store).ok()?;
    let y = y as u16;
    frame.draw_rows::<Rgb565>(y..y + 1, colour, &mut [0; WIDTH]).ok()
}

/// The hash of a frame.
pub fn hash(middle: [f64; 3], how: Arrangement) -> Option<u64> {
    let scenery = Scenery::new();
    let screen = Screen::new(SIZE[0], SIZE[1], 10.0).ok()?;
    let (share, sizes) = (how.share(), how.eye_sizes(WIDTH, HEIGHT));
    let part = screen.part(share.0, share.1);
    let at = eyes(&screen, screen.before(middle), 63.0);
    let mut hash = FrameHash::new(WIDTH as u16, HEIGHT as u16, FORMAT_RGB888);
    let mut rows = [[0; WIDTH]; 2];
    for y in 0..HEIGHT {
        // Which row of either eye's picture this row of the frame shows.
        let mut needed = [None; 2];
        for x in [0, WIDTH - 1] {
            match how.place(WIDTH, HEIGHT, x, y) {
                Place::Both => needed = [Some(y); 2],
                Place::Left { y, .. } => needed[0] = Some(y),
                Place::Right { y, .. } => needed[1] = Some(y),
            }
        }
        for (side, y) in needed.into_iter().enumerate() {
            if let Some(y) = y {
                row(&scenery, &part, at[side], sizes[side], y, &mut rows[side])?;
            }
        }
        for x in 0..WIDTH {
            let pixel = match (how.place(WIDTH, HEIGHT, x, y), how.coefficients()) {
                (Place::Left { x, .. }, _) => widen565(rows[0][x]),
                (Place::Right { x, .. }, _) => widen565(rows[1][x]),
                (Place::Both, Some(weights)) => {
                    mix(&weights, widen565(rows[0][x]), widen565(rows[1][x]))
                }
                (Place::Both, None) => return None,
            };
            hash.update(&pixel);
        }
    }
    Some(hash.finish())
}
