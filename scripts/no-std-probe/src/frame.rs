//! One frame through every stage, in memory of the stack.

use scanout::camera::{Camera, projection};
use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::hash::{FORMAT_RGB565, FrameHash};
use scanout::math::{Angle, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::Rgb565;
use scanout::scene::{Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::{Texels, Texture};
use scanout::transform::Vertex;

/// Width of the frame in pixels.
const WIDTH: usize = 160;

/// Height of the frame in pixels.
const HEIGHT: usize = 120;

/// Rows in a band.
const ROWS: usize = 8;

/// The hash of a frame that shows a textured, lit quadrilateral and its edges seen from (0, 0, `distance`), in drawing mode number
/// `mode`.
pub fn hash(distance: Q16, mode: u8) -> Option<u64> {
    let texels = [[255, 128, 0], [0, 64, 255], [0, 64, 255], [255, 128, 0]];
    let texture = Texture::new(2, 2, Texels::Rgb888(&texels)).ok()?;
    let mesh = Mesh {
        positions: &[
            [-20000, -20000, 0],
            [20000, -20000, 0],
            [20000, 20000, 0],
            [-20000, 20000, 0],
        ],
        colours: &[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]],
        uvs: &[[0, 65536], [65536, 65536], [65536, 0], [0, 0]],
        triangles: &[[0, 1, 2], [0, 2, 3]],
        uv_triangles: &[[0, 1, 2], [0, 2, 3]],
        edges: &[[0, 1], [1, 2], [2, 3], [3, 0]],
        ..Mesh::default()
    };
    let material = Material { texture: Some(&texture), ..Material::default() };
    let modes = [Mode::Points, Mode::Wire, Mode::Hidden, Mode::Flat, Mode::Gouraud, Mode::Phong];
    let objects = [Object::new(&mesh, &material, *modes.get(usize::from(mode))?)];
    let lens = projection::perspective(
        Angle::from_degrees(Q16::from_int(45)),
        Q16::from_ratio(4, 3),
        Q16::ONE,
        Q16::from_int(10),
    )
    .ok()?;
    let eye = Vec3::new(Q16::ZERO, Q16::ZERO, distance);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).ok()?;
    let lights = [Light { kind: LightKind::Directional(Vec3::Z), colour: [255; 3] }];
    let mut scene = Scene::new(camera, &objects);
    scene.lights = &lights;

    let store = Store {
        vertices: &mut [Vertex::default(); 4],
        primitives: &mut [Primitive::default(); 8],
        objects: &mut [ObjectState::default(); 1],
    };
    let frame = Frame::prepare(&scene, Settings::new(WIDTH as u16, HEIGHT as u16), store).ok()?;
    let (mut colour, mut depth) = ([0; WIDTH * ROWS], [0; WIDTH * ROWS]);
    let mut hash = FrameHash::new(WIDTH as u16, HEIGHT as u16, FORMAT_RGB565);
    let drawn = frame.draw_bands::<Rgb565, ()>(ROWS as u16, &mut colour, &mut depth, |band| {
        for &pixel in band.colour.iter() {
            hash.update(&pixel.to_be_bytes());
        }
        Ok(())
    });
    drawn.ok().map(|_| hash.finish())
}
