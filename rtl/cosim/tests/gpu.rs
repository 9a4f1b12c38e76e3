//! `gpu.sv`: a model is written over Wishbone, and the pictures that come out of the pins are the library's frames.

mod common;

use std::path::Path;

use common::{ARRANGEMENTS, difference, doubled, pack};
use scanout::camera::{Camera, Screen, projection};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::{Mono, PixelFormat, Rgb888};
use scanout::scene::{Background, Material, Mode, Object, Scene};
use scanout::transform::{ClipMatrix, Vertex};
use scanout_assets::{LoadOptions, load};
use scanout_cosim::monitor::{self, Monitor, Seen};
use scanout_cosim::register_map as map;
use scanout_cosim::spin::{self, Spin, board_spin};
use scanout_cosim::{Model, Port};
use scanout_head::stereo::{Arrangement, compose};

const INK: [u8; 3] = [255, 255, 255];
const BLACK: [u8; 3] = [0; 3];

/// A GPU on one clock, its host and its monitor.
struct Gpu {
    model: Model,
    clocks: [Port; 2],
    pins: [Port; 5],
    monitor: Monitor,
    seen: Vec<Seen>,
    /// Bits of `control` that a picture is drawn with.
    control: u32,
}

impl Gpu {
    fn new(name: &str) -> Gpu {
        let model = Model::new(name);
        let mut gpu = Gpu {
            clocks: ["clk", "clk_pixel"].map(|n| model.port(n)),
            pins: ["hsync", "vsync", "r", "g", "b"].map(|n| model.port(n)),
            monitor: Monitor::new(monitor::Mode::VGA),
            seen: Vec::new(),
            control: 0,
            model,
        };
        for level in [0, 1] {
            for name in ["rst_n", "pixel_rst_n"] {
                let port = gpu.model.port(name);
                gpu.model.set(port, level);
            }
            (0..4).for_each(|_| gpu.clock());
        }
        gpu
    }

    fn clock(&mut self) {
        for level in [0, 1] {
            for port in self.clocks {
                self.model.set(port, level);
            }
            self.model.eval();
        }
        let [hsync, vsync, r, g, b] = self.pins.map(|p| self.model.get(p) as u8);
        self.seen.extend(self.monitor.clock(hsync == 1, vsync == 1, [r, g, b]));
    }

    fn bus(&mut self, address: u32, write: Option<u32>) -> u32 {
        let set = |model: &mut Model, name: &str, value: u32| {
            let port = model.port(name);
            model.set(port, value);
        };
        for (name, value) in [
            ("wb_cyc", 1),
            ("wb_stb", 1),
            ("wb_we", write.is_some().into()),
            ("wb_adr", address),
            ("wb_sel", 15),
            ("wb_dat_w", write.unwrap_or(0)),
        ] {
            set(&mut self.model, name, value);
        }
        let [ack, err, data] = ["wb_ack", "wb_err", "wb_dat_r"].map(|n| self.model.port(n));
        self.clock();
        assert_eq!((self.model.get(ack), self.model.get(err)), (1, 0), "0x{address:x}");
        let word = self.model.get(data) as u32;
        set(&mut self.model, "wb_cyc", 0);
        set(&mut self.model, "wb_stb", 0);
        self.clock();
        word
    }

    fn write(&mut self, address: u32, word: u32) {
        self.bus(address, Some(word));
    }

    fn read(&mut self, address: u32) -> u32 {
        self.bus(address, None)
    }

    /// Stops, and waits until nothing is being drawn.
    fn stop(&mut self, spin: bool) {
        let spin = u32::from(spin) << map::CONTROL_SPIN_LSB;
        self.write(map::CONTROL, spin);
        while self.read(map::STATUS) & map::STATUS_DRAWING_MASK != 0 {}
    }

    fn load(&mut self, mesh: &Mesh) {
        assert!(mesh.positions.len() <= 1024 && mesh.edges.len() <= 4096);
        for (i, p) in (0..).zip(mesh.positions) {
            let [x, y, z] = p.map(|v| u32::from(v as u16));
            self.write(map::VERTEX + 2 * i + 1, z);
            self.write(map::VERTEX + 2 * i, y << 16 | x);
        }
        for (i, e) in (0..).zip(mesh.edges) {
            self.write(map::EDGE + i, u32::from(e[1]) << 16 | u32::from(e[0]));
        }
        self.write(map::MODEL, (mesh.edges.len() as u32) << 16 | mesh.positions.len() as u32);
    }

    fn matrix(&mut self, matrix: &ClipMatrix, eye: u32) {
        for (i, &word) in (0..).zip(matrix.m.as_flattened()) {
            self.write(map::MATRIX + 16 * eye + i, word as u32);
        }
    }

    /// Draws one picture with what was written, and waits until a frame of it was seen.
    fn picture(&mut self) -> Vec<[u8; 3]> {
        let before = self.read(map::PICTURES);
        let control = self.control | map::CONTROL_RUN_MASK | map::CONTROL_COMMIT_MASK;
        self.write(map::CONTROL, control);
        while self.read(map::STATUS) & map::STATUS_DRAWING_MASK == 0 {}
        self.write(map::CONTROL, self.control);
        while self.read(map::PICTURES) == before {
            (0..1000).for_each(|_| self.clock());
        }
        // It is shown from the next blank on; the frame after that is whole.
        self.seen.clear();
        while self.seen.len() < 2 {
            self.clock();
        }
        let seen = self.seen.pop().expect("two frames");
        assert_eq!(seen.faults, [""; 0]);
        seen.pixels
    }
}

/// The library's frame.
fn frame(objects: &[Object], camera: Camera, width: u16, height: u16) -> Vec<[u8; 3]> {
    frame_over(BLACK, objects, camera, width, height)
}

fn frame_over(
    background: [u8; 3],
    objects: &[Object],
    camera: Camera,
    width: u16,
    height: u16,
) -> Vec<[u8; 3]> {
    let background = Background::Colour(background);
    let scene = Scene { background, ..Scene::new(camera, objects) };
    let needed = Needed::at_most(&scene);
    let mut vertices = vec![Vertex::default(); needed.vertices];
    let mut primitives = vec![Primitive::default(); needed.primitives];
    let mut states = vec![ObjectState::default(); needed.objects];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
    let frame = Frame::prepare(&scene, Settings::new(width, height), store).expect("a frame");
    let count = width as usize * height as usize;
    let (mut colour, mut depth) = (vec![[0; 3]; count], vec![0; count]);
    frame.draw_rows::<Rgb888>(0..height, &mut colour, &mut depth).expect("rows");
    colour
}

fn camera(azimuth: f64, elevation: f64, distance: f64) -> Camera {
    let lens = projection::perspective(
        Angle::from_degrees_f64(45.0),
        Q16::from_ratio(4, 3),
        Q16::from_ratio(1, 10),
        Q16::from_int(20),
    );
    let (a, e) = (azimuth.to_radians(), elevation.to_radians());
    let eye = [distance * e.cos() * a.sin(), distance * e.sin(), distance * e.cos() * a.cos()];
    let lens = lens.expect("a lens");
    Camera::look_at(Vec3::from_f64(eye), Vec3::ZERO, Vec3::Y, lens).expect("a camera")
}

fn model(name: &str) -> scanout_assets::Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    load(folder.join(name), &LoadOptions::default()).expect(name)
}

fn clip_matrix(camera: &Camera, transform: &Mat4) -> ClipMatrix {
    ClipMatrix::new(&camera.projection.mul(&camera.view).mul(transform))
}

/// Frames of each model: more with SCANOUT_LONG.
fn views(usual: u32) -> u32 {
    let long = std::env::var_os("SCANOUT_LONG").is_some_and(|v| !v.is_empty());
    if long { 6 * usual } else { usual }
}

#[test]
fn shipped_models_as_wireframes_are_the_librarys_frames() {
    if common::netlists_only() {
        return;
    }
    let mut gpu = Gpu::new("gpu_plane");
    gpu.stop(false);
    gpu.write(map::INK, pack(INK));
    assert_eq!(gpu.read(map::MAGIC), map::MAGIC_RESET);
    assert_eq!(gpu.read(map::SIZE), 480 << 16 | 640);
    for name in ["cube.obj", "torus.obj", "sphere.obj", "teapot.obj", "system-b/a.obj"] {
        let model = model(name);
        let mesh = model.parts[0].mesh.as_mesh();
        gpu.load(&mesh);
        let material = Material { colour: INK, ..Material::default() };
        let object = Object::new(&mesh, &material, Mode::Wire);
        for view in 0..views(3) {
            let turn = f64::from(view);
            // From afar, and so near that lines leave the screen.
            let camera = camera(
                77.0 * turn + 20.0,
                31.0 * turn - 40.0,
                if view % 2 == 0 { 4.0 } else { 2.6 },
            );
            gpu.matrix(&clip_matrix(&camera, &object.transform), 0);
            let picture = gpu.picture();
            let wanted: Vec<_> = frame(&[object], camera, 640, 480)
                .iter()
                .map(|p| common::pins(*p, [3, 3, 2]))
                .collect();
            assert_eq!(difference(&picture, &wanted, 640), None, "{name}, view {view}");
            assert!(wanted.iter().filter(|&&p| p != [0; 3]).count() > 200, "{name}, view {view}");
            let clocks = gpu.read(map::CLOCKS);
            println!(
                "{name}: {} vertices, {} edges, {clocks} clocks",
                mesh.positions.len(),
                mesh.edges.len()
            );
            assert!(clocks < 800 * 525, "{name} takes longer than a frame");
        }
    }
}

#[test]
fn stand_alone_turns_the_model_without_a_host() {
    if common::netlists_only() {
        return;
    }
    let mut gpu = Gpu::new("gpu_plane");
    gpu.stop(true);
    // What the ULX3S shows: 529 vertices and 1,520 edges.
    let model = model("teapot.obj");
    let mesh = model.parts[0].mesh.as_mesh();
    gpu.load(&mesh);
    let (camera, spin) = board_spin();
    for (i, &word) in (0..).zip(&Spin::table(&spin, &spin)) {
        gpu.write(map::SPIN + i, word);
    }
    gpu.write(map::SPEED, 37);
    let first = gpu.read(map::ANGLE);
    gpu.write(map::CONTROL, map::CONTROL_RUN_MASK | map::CONTROL_SPIN_MASK);
    gpu.seen.clear();
    while gpu.seen.len() < 6 {
        gpu.clock();
    }
    let material = Material { colour: INK, ..Material::default() };
    // A frame of the library with exactly this matrix: identity camera, the matrix as the object's.
    let wanted = |angle: u32| {
        let matrix = spin.matrix(angle);
        let transform = Mat4 { m: matrix.m.map(|row| row.map(i64::from)) };
        assert_eq!(
            ClipMatrix::new(&transform).m,
            matrix.m,
            "the library keeps the matrix as it is"
        );
        let camera = Camera { projection: Mat4::IDENTITY, view: Mat4::IDENTITY, ..camera };
        let object = Object { transform, ..Object::new(&mesh, &material, Mode::Wire) };
        frame(&[object], camera, 640, 480)
            .iter()
            .map(|p| common::pins(*p, [3, 3, 2]))
            .collect::<Vec<_>>()
    };
    // Every frame shows the next angle: 60 pictures a second of 1,520 edges at 25 MHz.
    let seen = &gpu.seen[2..];
    let angle = |i: u32| (first + 37 * i) % 1024;
    let begin =
        (0..8).find(|&i| seen[0].pixels == wanted(angle(i))).expect("one of the first angles");
    for (i, seen) in (0..).zip(seen) {
        assert_eq!(difference(&seen.pixels, &wanted(angle(begin + i)), 640), None, "frame {i}");
    }
}

#[test]
fn the_small_configurations() {
    if common::netlists_only() {
        return;
    }
    small_configuration("gpu_up5k", true);
    small_configuration("gpu_in_view", false);
}

/// What the iCEBreaker shows: 320x240 in single-port memory, one multiplier; with clip stages or without.
fn small_configuration(name: &str, clip: bool) {
    let mut gpu = Gpu::new(name);
    gpu.stop(false);
    let model = model("torus.obj");
    let mesh = model.parts[0].mesh.as_mesh();
    gpu.load(&mesh);
    let (camera, spin) = board_spin();
    let material = Material { colour: INK, ..Material::default() };
    for angle in (0..1024).step_by(if clip && views(1) != 1 { 16 } else { 128 }) {
        let matrix = spin.matrix(angle);
        gpu.matrix(&matrix, 0);
        let picture = gpu.picture();
        let transform = Mat4 { m: matrix.m.map(|row| row.map(i64::from)) };
        assert_eq!(
            ClipMatrix::new(&transform).m,
            matrix.m,
            "the library keeps the matrix as it is"
        );
        let camera = Camera { projection: Mat4::IDENTITY, view: Mat4::IDENTITY, ..camera };
        let object = Object { transform, ..Object::new(&mesh, &material, Mode::Wire) };
        let wanted: Vec<_> =
            frame(&[object], camera, 320, 240).iter().map(|p| common::pins(*p, [4; 3])).collect();
        assert_eq!(
            difference(&picture, &common::doubled(&wanted, 320), 640),
            None,
            "angle {angle}"
        );
    }
    println!("torus.obj at 320x240: {} clocks", gpu.read(map::CLOCKS));
    assert_eq!(gpu.read(map::STATUS) & map::STATUS_INCOMPLETE_MASK, 0);
    for (view, distance) in [1.2, 0.7, 0.3].into_iter().enumerate() {
        let near = self::camera(57.0 * view as f64, 20.0, distance);
        gpu.matrix(&clip_matrix(&near, &Mat4::IDENTITY), 0);
        let picture = gpu.picture();
        let incomplete = gpu.read(map::STATUS) & map::STATUS_INCOMPLETE_MASK != 0;
        // Without the clip stages an edge that leaves the screen is left out, and that is told.
        assert_eq!(incomplete, !clip, "{name} from {distance}");
        if clip {
            let object = Object::new(&mesh, &material, Mode::Wire);
            let wanted: Vec<_> =
                frame(&[object], near, 320, 240).iter().map(|p| common::pins(*p, [4; 3])).collect();
            let wanted = common::doubled(&wanted, 320);
            assert_eq!(difference(&picture, &wanted, 640), None, "{name} from {distance}");
        }
    }
}

#[test]
fn the_boards_tables_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for name in spin::BOARD_MODELS {
        for (file, wanted) in spin::board_tables(&root, name) {
            let path = root.join("boards/models").join(name).join(file);
            let found = std::fs::read_to_string(&path).unwrap_or_default();
            let remedy = "cargo run --example board_models";
            assert!(found == wanted, "{} is not what the model gives: {remedy}", path.display());
        }
    }
}

/// System C's cube: 12 edges in three groups, front, back and sides; each group has its colour.
struct Cube {
    positions: Vec<[i16; 3]>,
    groups: [[[u16; 2]; 4]; 3],
    colours: [[u8; 3]; 3],
}

impl Cube {
    fn new(colours: [[u8; 3]; 3]) -> Cube {
        let corner =
            |i: u16| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 18000i16 } else { -18000 });
        let ring =
            |z: u16| [[0, 1], [1, 3], [3, 2], [2, 0]].map(|e: [u16; 2]| e.map(|v| v + 4 * z));
        let groups = [ring(1), ring(0), [0, 1, 2, 3].map(|v| [v, v + 4])];
        Cube { positions: (0..8).map(corner).collect(), groups, colours }
    }

    /// Into a GPU that is stopped.
    fn load(&self, gpu: &mut Gpu) {
        gpu.stop(false);
        let all = self.groups.concat();
        gpu.load(&Mesh { positions: &self.positions, edges: &all, ..Mesh::default() });
        for (i, e) in (0..).zip(&all) {
            let group = i / 4;
            gpu.write(map::EDGE + i, group << 30 | u32::from(e[1]) << 16 | u32::from(e[0]));
        }
        for (i, rgb) in self.colours.into_iter().enumerate() {
            gpu.write([map::PALETTE0, map::PALETTE1, map::PALETTE2][i], pack(rgb));
        }
    }

    /// The library's frame: the groups one after the other.
    fn frame(
        &self,
        background: [u8; 3],
        transform: Mat4,
        camera: Camera,
        (width, height): (usize, usize),
    ) -> Vec<[u8; 3]> {
        let meshes = self.groups.each_ref().map(|edges| Mesh {
            positions: &self.positions,
            edges,
            ..Mesh::default()
        });
        let materials = self.colours.map(|colour| Material { colour, ..Material::default() });
        let objects = [0, 1, 2]
            .map(|i| Object { transform, ..Object::new(&meshes[i], &materials[i], Mode::Wire) });
        frame_over(background, &objects, camera, width as u16, height as u16)
    }
}

#[test]
fn system_c_s_cube_in_line_memories_without_a_framebuffer() {
    if common::netlists_only() {
        return;
    }
    let colours = [[255, 0, 0], [0, 255, 0], [0, 0, 255]];
    let cube = Cube::new(colours);
    let mut gpu = Gpu::new("gpu_lines");
    cube.load(&mut gpu);
    for view in 0..views(16) {
        // The viewer moves about before the window.
        let turn = f64::from(view);
        let camera =
            camera(25.0 * (turn * 0.7).sin(), 20.0 * (turn * 1.1).cos(), 2.0 + 0.1 * (turn % 8.0));
        gpu.matrix(&clip_matrix(&camera, &Mat4::IDENTITY), 0);
        let picture = gpu.picture();
        let wanted: Vec<_> = cube
            .frame(BLACK, Mat4::IDENTITY, camera, (640, 480))
            .iter()
            .map(|p| common::pins(*p, [3, 3, 2]))
            .collect();
        assert_eq!(difference(&picture, &wanted, 640), None, "view {view}");
        assert_eq!(gpu.read(map::STATUS) & map::STATUS_INCOMPLETE_MASK, 0);
        assert!(colours.map(|c| common::pins(c, [3, 3, 2])).iter().all(|c| wanted.contains(c)));
    }
}

/// Two eyes before system C's window of 6.4 x 4.8, through the share of it that each half shows.
fn eyes(how: Option<Arrangement>) -> [Camera; 2] {
    let (width, height) = how.map_or((1.0, 1.0), Arrangement::share);
    let screen = Screen::centred(Q16::from_f64(6.4 * width), Q16::from_f64(4.8 * height));
    [-0.4, 0.4].map(|x| {
        let eye = Vec3::from_f64([x, 0.3, 5.0]);
        Camera::off_axis(eye, &screen, Q16::from_ratio(1, 10), Q16::from_int(20)).expect("a camera")
    })
}

/// Every arrangement as it is seen through the pins of a GPU that shows `size` pixels in 640x480, beside what the library composes
/// of its two frames; `draw` is the library's frame of an eye.
fn stereo_is_the_librarys(
    gpu: &mut Gpu,
    codes: &[(u32, Option<Arrangement>)],
    transform: &Mat4,
    size: (usize, usize),
    draw: impl Fn(Camera, (usize, usize)) -> Vec<[u8; 3]>,
) {
    for &(code, how) in codes {
        let cameras = eyes(how);
        for (eye, camera) in (0..).zip(&cameras) {
            gpu.matrix(&clip_matrix(camera, transform), eye);
        }
        gpu.control = code << map::CONTROL_ARRANGEMENT_LSB;
        let picture = gpu.picture();
        let sizes = how.map_or([size; 2], |how| how.eye_sizes(size.0, size.1));
        let left = draw(cameras[0], sizes[0]);
        let wanted = match how {
            None => left,
            Some(how) => {
                let right = draw(cameras[1], sizes[1]);
                assert!(left != right, "{how:?}: two eyes see two pictures");
                let mut wanted = vec![BLACK; size.0 * size.1];
                compose(how, &left, &right, &mut wanted, size.0);
                wanted
            }
        };
        let wanted = if size.0 < 640 { doubled(&wanted, size.0) } else { wanted };
        assert_eq!(difference(&picture, &wanted, 640), None, "code {code}, {how:?}");
        assert_eq!(gpu.read(map::STATUS) & map::STATUS_INCOMPLETE_MASK, 0);
    }
}

#[test]
fn two_eyes_in_planes_of_one_bit() {
    if common::netlists_only() {
        return;
    }
    const BACK: [u8; 3] = [40, 0, 90];
    let ink = [250, 180, 60];
    let mut gpu = Gpu::new("gpu_eyes");
    gpu.stop(false);
    assert_eq!(gpu.read(map::FEATURES), 1 << map::FEATURES_STEREO_LSB);
    gpu.write(map::INK, pack(ink));
    gpu.write(map::BACKGROUND, pack(BACK));
    let model = model("teapot.obj");
    let mesh = model.parts[0].mesh.as_mesh();
    gpu.load(&mesh);
    let material = Material { colour: ink, ..Material::default() };
    let size = Mat4::uniform_scale(Q16::from_int(3));
    let transform = Mat4::translation(Vec3::from_f64([0.0, 0.0, -1.5])).mul(&size);
    let object = Object { transform, ..Object::new(&mesh, &material, Mode::Wire) };
    // What this screen does not have shows the left eye.
    let mut codes: Vec<_> = ARRANGEMENTS.into_iter().filter(|&(code, _)| code < 4).collect();
    codes.extend([(4, None), (7, None)]);
    stereo_is_the_librarys(&mut gpu, &codes, &transform, (640, 480), |camera, (width, height)| {
        frame_over(BACK, &[object], camera, width as u16, height as u16)
    });
    // Stand-alone: each eye has its own words in the table.
    let how = Arrangement::Anaglyph;
    let spins = eyes(Some(how))
        .map(|camera| Spin::new(&camera.projection.mul(&camera.view), [0.2, 1.0, 0.0], 3.0));
    for (i, &word) in (0..).zip(&Spin::table(&spins[0], &spins[1])) {
        gpu.write(map::SPIN + i, word);
    }
    gpu.control = 1 << map::CONTROL_ARRANGEMENT_LSB | map::CONTROL_SPIN_MASK;
    let angle = gpu.read(map::ANGLE);
    let picture = gpu.picture();
    let [left, right] = spins.map(|spin| {
        let transform = Mat4 { m: spin.matrix(angle).m.map(|row| row.map(i64::from)) };
        let [camera, _] = eyes(None);
        let camera = Camera { projection: Mat4::IDENTITY, view: Mat4::IDENTITY, ..camera };
        frame_over(BACK, &[Object { transform, ..object }], camera, 640, 480)
    });
    let mut wanted = vec![BLACK; 640 * 480];
    compose(how, &left, &right, &mut wanted, 640);
    assert_eq!(difference(&picture, &wanted, 640), None, "stand-alone");
}

#[test]
fn all_nine_arrangements_in_a_colour_framebuffer() {
    if common::netlists_only() {
        return;
    }
    const BACK: [u8; 3] = [30, 60, 20];
    // RGB888, each pixel twice in both directions.
    let mut gpu = Gpu::new("gpu_stereo");
    let cube = Cube::new([[255, 131, 7], [66, 250, 129], [93, 31, 222]]);
    cube.load(&mut gpu);
    assert_eq!(gpu.read(map::SIZE), 240 << 16 | 320);
    assert_eq!(gpu.read(map::FEATURES), 1 << map::FEATURES_WAY_LSB | 3 << map::FEATURES_STEREO_LSB);
    gpu.write(map::BACKGROUND, pack(BACK));
    let size = Mat4::uniform_scale(Q16::from_int(3));
    let transform = Mat4::translation(Vec3::from_f64([0.3, -0.2, -1.5])).mul(&size);
    stereo_is_the_librarys(&mut gpu, &ARRANGEMENTS, &transform, (320, 240), |camera, size| {
        cube.frame(BACK, transform, camera, size)
    });
}

#[test]
fn a_dithered_framebuffer_of_one_bit() {
    if common::netlists_only() {
        return;
    }
    // A colour's luma is where its dither is: half of a line's pixels are lit, a quarter, all.
    let mut gpu = Gpu::new("gpu_mono");
    let cube = Cube::new([[128; 3], [70, 60, 50], INK]);
    cube.load(&mut gpu);
    let back = [0, 0, 160];
    gpu.write(map::BACKGROUND, pack(back));
    for (turn, camera) in eyes(None).into_iter().enumerate() {
        let away = Mat4::translation(Vec3::from_f64([0.0, 0.0, -1.0 - turn as f64]));
        let transform = away.mul(&Mat4::uniform_scale(Q16::from_int(3)));
        gpu.matrix(&clip_matrix(&camera, &transform), 0);
        let picture = gpu.picture();
        // Nothing is drawn where a colour of no object is.
        let coloured = cube.frame([1, 2, 3], transform, camera, (640, 480));
        let lit = |(i, &rgb): (usize, &[u8; 3])| {
            let mut row = [0];
            let (x, y) = ((i % 640) as i32, (i / 640) as i32);
            Mono::store(&mut row, 0, Mono::encode_dithered(rgb, x, y));
            if rgb == [1, 2, 3] { back } else { Mono::load(&row, 0) }
        };
        let wanted: Vec<_> = coloured.iter().enumerate().map(lit).collect();
        assert_eq!(difference(&picture, &wanted, 640), None, "view {turn}");
        for level in [BLACK, INK] {
            assert!(wanted.iter().filter(|&&p| p == level).count() > 100, "{level:?}");
        }
    }
}
