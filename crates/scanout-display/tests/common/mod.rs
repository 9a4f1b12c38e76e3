//! A scene whose picture has no symmetry: two triangles that cut each other over a background that differs everywhere.
#![allow(dead_code)]

use scanout::camera::{Camera, projection};
use scanout::frame::{Band, Frame, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::Rgb565;
use scanout::scene::{Background, Material, Mode, Object, Scene};
use scanout::transform::Vertex;

/// Prepares the scene and gives the frame.
pub fn with_frame<T>(width: u16, height: u16, then: impl FnOnce(&Frame) -> T) -> T {
    let mesh = Mesh {
        positions: &[
            [-28000, -20000, -9000],
            [26000, -12000, 9000],
            [-3000, 24000, 0],
            [-20000, 18000, 9000],
            [22000, 20000, -9000],
            [0, -26000, 4000],
        ],
        colours: &[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3], [20, 90, 160], [255, 160, 0]],
        triangles: &[[0, 1, 2], [3, 5, 4]],
        ..Mesh::default()
    };
    let material = Material { ambient: Q16::ONE, ..Material::default() };
    let objects = [Object::new(&mesh, &material, Mode::Gouraud)];
    let lens = projection::perspective(
        Angle::from_degrees(Q16::from_int(45)),
        Q16::from_ratio(width as i32, height as i32),
        Q16::ONE,
        Q16::from_int(10),
    );
    let eye = Vec3::from_f64([0.3, 0.2, 2.6]);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens.unwrap()).unwrap();
    let picture: Vec<[u8; 3]> = (0..width as usize * height as usize)
        .map(|i| (i as u32).wrapping_mul(2654435761).to_be_bytes())
        .map(|[r, g, b, _]| [r / 2, g / 2, b / 2])
        .collect();
    let mut scene = Scene::new(camera, &objects);
    scene.background = Background::Image(&picture);
    let (mut vertices, mut primitives) = ([Vertex::default(); 6], [Primitive::default(); 2]);
    let mut states = [ObjectState::default(); 1];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
    let frame = Frame::prepare(&scene, Settings::new(width, height), store).unwrap();
    assert_eq!(frame.stats().primitives, 2, "both triangles are seen");
    then(&frame)
}

/// The whole frame at once, and its hash.
pub fn whole(frame: &Frame) -> (Vec<u16>, u64) {
    let pixels = frame.settings().width as usize * frame.settings().height as usize;
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let height = frame.settings().height;
    frame.draw_rows::<Rgb565>(0..height, &mut colour, &mut depth).unwrap();
    assert!(depth.iter().any(|&z| z != u16::MAX), "something was drawn");
    let hash = frame.hash::<Rgb565>(height, &mut vec![0; pixels], &mut depth).unwrap();
    (colour, hash)
}

/// Draws in bands of `lines` lines.
pub fn bands<E: std::fmt::Debug>(
    frame: &Frame,
    lines: u16,
    sink: impl FnMut(Band<Rgb565>) -> Result<(), E>,
) {
    let words = frame.settings().width as usize * lines as usize;
    frame.draw_bands(lines, &mut vec![0; words], &mut vec![0; words], sink).unwrap();
}
