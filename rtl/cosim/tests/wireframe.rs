//! `wireframe.sv`, from vertices to line pixels, and the library's wireframe frames.

use std::path::Path;

use scanout::camera::{Camera, Screen, projection};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Mat4, Q16, Quat, Vec3};
use scanout::mesh::Mesh;
use scanout::output::Rgb888;
use scanout::scene::{Material, Mode, Object, Scene};
use scanout::transform::{ClipMatrix, Vertex};
use scanout_assets::{LoadOptions, load};
use scanout_cosim::{Model, Random};

/// Clocks of one picture, apart: the vertex pass and all of it.
#[derive(Clone, Copy, Debug, Default)]
struct Clocks {
    vertices: u64,
    all: u64,
}

struct Gpu {
    model: Model,
    random: Random,
}

impl Gpu {
    fn new() -> Gpu {
        let mut model = Model::new("wireframe_8k");
        model.reset();
        Gpu { model, random: Random::new(1) }
    }

    fn set(&mut self, name: &str, value: i64) {
        let port = self.model.port(name);
        self.model.set(port, value);
    }

    fn load(&mut self, mesh: &Mesh) {
        for (i, p) in mesh.positions.iter().enumerate() {
            let word = p.iter().rev().fold(0, |word, &v| word << 16 | i64::from(v as u16));
            self.set("vertex_write", 1);
            self.set("vertex_address", i as i64);
            self.set("vertex_word", word);
            self.model.clock();
        }
        self.set("vertex_write", 0);
        for (i, e) in mesh.edges.iter().enumerate() {
            self.set("edge_write", 1);
            self.set("edge_address", i as i64);
            self.set("edge_word", i64::from(e[1]) << 16 | i64::from(e[0]));
            self.model.clock();
        }
        self.set("edge_write", 0);
        self.set("vertices", mesh.positions.len() as i64);
        self.set("edges", mesh.edges.len() as i64);
    }

    /// Draws; `stall` percent of clocks take no pixel.
    fn draw(
        &mut self,
        matrix: &ClipMatrix,
        [width, height]: [u16; 2],
        stall: u64,
    ) -> (Vec<bool>, Clocks) {
        for (i, &word) in matrix.m.as_flattened().iter().enumerate() {
            self.set("matrix_write", 1);
            self.set("matrix_address", i as i64);
            self.set("matrix_word", i64::from(word));
            self.model.clock();
        }
        self.set("matrix_write", 0);
        self.set("width", i64::from(width));
        self.set("height", i64::from(height));
        self.set("start", 1);
        self.model.clock();
        self.set("start", 0);
        let [valid, ready, x, y, done] =
            ["m_valid", "m_ready", "m_x", "m_y", "done"].map(|name| self.model.port(name));
        let begin = self.model.clocks();
        let mut plane = vec![false; usize::from(width) * usize::from(height)];
        let mut clocks = Clocks::default();
        loop {
            let take = stall == 0 || !self.random.percent(stall);
            self.model.set(ready, u64::from(take));
            self.model.eval();
            if take && self.model.get(valid) == 1 {
                let (x, y) = (self.model.get(x) as usize, self.model.get(y) as usize);
                assert!(x < width.into() && y < height.into(), "pixel {x}, {y} is outside");
                plane[y * usize::from(width) + x] = true;
                if clocks.vertices == 0 {
                    clocks.vertices = self.model.clocks() - begin;
                }
            }
            if self.model.get(done) == 1 {
                clocks.all = self.model.clocks() - begin;
                return (plane, clocks);
            }
            self.model.clock();
            assert!(self.model.clocks() - begin < 20_000_000, "never done");
        }
    }
}

/// The library's frame of a white wireframe on black.
fn frame(mesh: &Mesh, transform: Mat4, camera: Camera, [width, height]: [u16; 2]) -> Vec<bool> {
    let material = Material { colour: [255; 3], ..Material::default() };
    let objects = [Object { transform, ..Object::new(mesh, &material, Mode::Wire) }];
    let scene = Scene::new(camera, &objects);
    let needed = Needed::at_most(&scene);
    let mut vertices = vec![Vertex::default(); needed.vertices];
    let mut primitives = vec![Primitive::default(); needed.primitives];
    let mut states = vec![ObjectState::default(); needed.objects];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
    let frame = Frame::prepare(&scene, Settings::new(width, height), store).expect("a frame");
    let count = usize::from(width) * usize::from(height);
    let (mut colour, mut depth) = (vec![[0; 3]; count], vec![0; count]);
    frame.draw_rows::<Rgb888>(0..height, &mut colour, &mut depth).expect("rows");
    colour.into_iter().map(|pixel| pixel != [0; 3]).collect()
}

/// Draws with both and compares; clocks, and how many pixels are set.
fn compare(
    gpu: &mut Gpu,
    mesh: &Mesh,
    transform: Mat4,
    camera: Camera,
    size: [u16; 2],
    stall: u64,
    what: &str,
) -> (Clocks, usize) {
    let matrix = ClipMatrix::new(&camera.projection.mul(&camera.view).mul(&transform));
    let expected = frame(mesh, transform, camera, size);
    let (got, clocks) = gpu.draw(&matrix, size, stall);
    let wrong = got.iter().zip(&expected).filter(|(a, b)| a != b).count();
    if let Some(at) = got.iter().zip(&expected).position(|(a, b)| a != b) {
        let width = usize::from(size[0]);
        let (x, y) = (at % width, at / width);
        panic!("{what}: {wrong} pixels differ, first {x}, {y}: got {}", got[at]);
    }
    (clocks, expected.iter().filter(|&&set| set).count())
}

fn model(name: &str) -> scanout_assets::Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    load(folder.join(name), &LoadOptions::default()).expect(name)
}

fn perspective() -> Mat4 {
    projection::perspective(
        Angle::from_degrees_f64(50.0),
        Q16::from_ratio(4, 3),
        Q16::from_ratio(1, 10),
        Q16::from_int(20),
    )
    .expect("a lens")
}

fn around(azimuth: f64, elevation: f64, distance: f64) -> Camera {
    let (a, e) = (azimuth.to_radians(), elevation.to_radians());
    let eye = [distance * e.cos() * a.sin(), distance * e.sin(), distance * e.cos() * a.cos()];
    Camera::look_at(Vec3::from_f64(eye), Vec3::ZERO, Vec3::Y, perspective()).expect("a camera")
}

/// Eight corners of a cube with sides of length 1; bit i of the number is the sign along axis i.
const CUBE: [[i16; 3]; 8] = {
    const LOW: i16 = -16384;
    const HIGH: i16 = 16384;
    let mut corners = [[LOW; 3]; 8];
    let mut i = 0;
    while i < 24 {
        if ((i / 3) >> (i % 3)) & 1 == 1 {
            corners[i / 3][i % 3] = HIGH;
        }
        i += 1;
    }
    corners
};

fn cube_edges() -> Vec<[u16; 2]> {
    let mut edges = Vec::new();
    for a in 0..8u16 {
        for bit in 0..3 {
            if a >> bit & 1 == 0 {
                edges.push([a, a | 1 << bit]);
            }
        }
    }
    edges
}

/// System A's cube of 8 vertices and 12 edges, turning about x, without perspective; 72 frames.
#[test]
fn the_cube_of_system_a() {
    let edges = cube_edges();
    let mesh = Mesh { positions: &CUBE, edges: &edges, ..Mesh::default() };
    let mut gpu = Gpu::new();
    gpu.load(&mesh);
    let lens = projection::orthographic(
        Q16::from_int(4),
        Q16::from_ratio(5, 2),
        Q16::from_int(1),
        Q16::from_int(10),
    )
    .expect("a lens");
    let eye = Vec3::from_f64([0.4, 0.3, 4.0]);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).expect("a camera");
    for step in 0..72 {
        let angle = Angle::from_degrees_f64(f64::from(step) * 5.0);
        let turn = Quat::from_axis_angle(Vec3::X, angle).expect("an axis").to_mat4();
        let (_, set) =
            compare(&mut gpu, &mesh, turn, camera, [320, 200], 10 * (step as u64 % 3), "cube");
        assert!(set > 300, "frame {step}: {set} pixels");
    }
}

/// System C's cube behind the screen, seen from 100 positions of the viewer.
#[test]
fn the_cube_of_system_c() {
    let edges = cube_edges();
    let mesh = Mesh { positions: &CUBE, edges: &edges, ..Mesh::default() };
    let mut gpu = Gpu::new();
    gpu.load(&mesh);
    let mut random = Random::new(2);
    for step in 0..100 {
        // A unit is 100 pixels of system C: the screen is 6.4 x 4.8 and lies in z = 0, the cube 1.5 behind.
        let mut place = |low: i64, high: i64| random.range(low, high) as f64 / 100.0;
        let eye = [place(-320, 320), place(-240, 240), place(50, 640)];
        let (near, far) = (Q16::from_ratio(1, 10), Q16::from_int(20));
        let screen = Screen::centred(Q16::from_ratio(64, 10), Q16::from_ratio(48, 10));
        let camera = Camera::off_axis(Vec3::from_f64(eye), &screen, near, far).expect("a camera");
        let size = Mat4::uniform_scale(Q16::from_int(3));
        let away = Mat4::translation(Vec3::from_f64([0.3, -0.2, -2.5]));
        let (_, set) =
            compare(&mut gpu, &mesh, away.mul(&size), camera, [640, 480], step % 2 * 20, "cube");
        assert!(set > 50, "viewer {eye:?}: {set} pixels");
    }
}

/// The shipped models from outside, from close by, and from inside, where edges cross every plane.
#[test]
fn shipped_models() {
    let mut gpu = Gpu::new();
    for name in [
        "cube.obj",
        "torus.obj",
        "sphere.obj",
        "teapot.obj",
        "system-b/a.obj",
        "earth.obj",
        "hand.glb",
    ] {
        let model = model(name);
        let mesh = model.parts[0].mesh.as_mesh();
        assert!(mesh.positions.len() <= 8192 && mesh.edges.len() < 16384, "{name} is too large");
        gpu.load(&mesh);
        for view in 0..6u64 {
            let distance = [3.0, 2.2, 1.1, 0.7, 0.3, 6.0][view as usize];
            let angle = 57.0 * view as f64;
            let camera = around(angle, 20.0 - 0.2 * angle, distance);
            let what = format!("{name} from {distance}");
            let (clocks, set) =
                compare(&mut gpu, &mesh, Mat4::IDENTITY, camera, [640, 480], 0, &what);
            assert!(set > 100, "{what}: {set} pixels");
            let (v, e) = (mesh.positions.len() as u64, mesh.edges.len() as u64);
            println!(
                "{what}: {v} vertices, {e} edges, {set} pixels set; {} clocks, {:.1} a vertex, {:.1} an edge",
                clocks.all,
                clocks.vertices as f64 / v as f64,
                (clocks.all - clocks.vertices) as f64 / e as f64,
            );
            // 60 pictures a second at 25 MHz.
            assert!(clocks.all < 25_000_000 / 60, "{what}: {} clocks", clocks.all);
        }
    }
}
