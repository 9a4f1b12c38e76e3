//! Properties of frames that follow from the definitions, and what the five systems say in numbers.

mod common;

use common::{Memory, Owned, Picture, camera, draw, material, object, scene, sphere};
use scanout::camera::{Camera, Viewpoint, projection};
use scanout::frame::{BandError, Frame, Needed, Part, Preparation, PrepareError, Settings, Stats};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::{Cluster, Mesh, Normals};
use scanout::output::{Rgb565, Rgb888};
use scanout::scene::{Background, Light, Mode, Object, Scene};
use scanout::texture::{Texels, Texture};

struct Random(u64);
impl Random {
    fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % n as u64) as u32
    }
    fn unit(&mut self) -> f64 {
        self.below(1 << 30) as f64 / (1 << 29) as f64 - 1.0
    }
}

/// A camera whose clip space is the mesh's own: x, y in [-1, 1) fill the frame, z from 0 at +1 to 1 at -1.
fn flat_camera() -> Camera {
    let mut projection = Mat4::IDENTITY;
    projection.m[2][2] = -(1 << 31);
    projection.m[2][3] = 1 << 31;
    Camera { view: Mat4::IDENTITY, projection, viewpoint: Viewpoint::Direction(Vec3::Z) }
}

fn unlit() -> scanout::scene::Material<'static> {
    scanout::scene::Material {
        ambient: Q16::ONE,
        diffuse: Q16::ZERO,
        specular: Q16::ZERO,
        two_sided: true,
        ..material()
    }
}

/// Triangles with distinct depths in any order give one picture.
#[test]
fn order_of_opaque_triangles_does_not_matter() {
    let mut random = Random(1);
    for round in 0..20 {
        let mut soup = Owned::default();
        for i in 0..60u16 {
            // Parallel to the screen, each at its own depth.
            let z = 30_000 - 1000 * i as i32;
            for _ in 0..3 {
                soup.positions.push([
                    (random.unit() * 32000.0) as i16,
                    (random.unit() * 32000.0) as i16,
                    z as i16,
                ]);
                soup.colours.push([random.below(256) as u8, random.below(256) as u8, i as u8]);
            }
            soup.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        let m = unlit();
        let settings = Settings::new(200, 150);
        let draw_it = |soup: &Owned| -> Picture<Rgb888> {
            let mesh = soup.mesh();
            let objects = [object(&mesh, &m, Mode::Flat)];
            draw(&scene(flat_camera(), &objects), settings, 150, false)
        };
        let first = draw_it(&soup);
        let mut shuffled = soup.clone();
        for i in (1..shuffled.triangles.len()).rev() {
            shuffled.triangles.swap(i, random.below(i as u32 + 1) as usize);
        }
        assert!(first == draw_it(&shuffled), "round {round}");
    }
}

/// Two triangles that share an edge, anywhere: no pixel twice, none missing. Counted through colour order: each pixel of the
/// quad gets exactly one of the two colours, and drawing them in either order gives the same picture.
#[test]
fn shared_edges_have_no_seam() {
    let mut random = Random(2);
    let m = unlit();
    for _ in 0..200 {
        // A convex quad on one depth: with equal depths the first drawn wins, so an overlap would show as a change.
        let p = [(-1, -1), (1, -1), (1, 1), (-1, 1)].map(|(x, y)| {
            let mut reach = |s: i32| s as f64 * (0.3 + 0.6 * (random.unit() + 1.0) / 2.0) * 32000.0;
            [reach(x) as i16, reach(y) as i16, 0]
        });
        let mut quad =
            Owned { positions: vec![p[0], p[1], p[2], p[0], p[2], p[3]], ..Owned::default() };
        quad.colours = vec![[255, 0, 0]; 3];
        quad.colours.extend([[0, 0, 255]; 3]);
        let settings = Settings::new(97, 83);
        let pictures = [[[0u16, 1, 2], [3, 4, 5]], [[3, 4, 5], [0, 1, 2]]].map(|triangles| {
            let own = Owned { triangles: triangles.to_vec(), ..quad.clone() };
            let mesh = own.mesh();
            let objects = [object(&mesh, &m, Mode::Flat)];
            draw::<Rgb888>(&scene(flat_camera(), &objects), settings, 83, false)
        });
        assert!(pictures[0] == pictures[1]);
        // No hole: a row's covered pixels are one run.
        for row in pictures[0].colour.chunks(97) {
            let drawn: Vec<bool> = row.iter().map(|c| *c != [16, 24, 40]).collect();
            let runs = drawn.windows(2).filter(|w| w[0] != w[1]).count();
            assert!(runs <= 2);
        }
    }
}

/// What crosses the screen's edge keeps every pixel: a window of a larger frame equals the smaller frame.
#[test]
fn the_screen_edge_cuts_nothing_but_pixels() {
    let mesh_data = sphere(20, 14);
    let mesh = mesh_data.mesh();
    let texels: Vec<[u8; 3]> = (0..32 * 32).map(|i| [(i * 7) as u8, (i / 3) as u8, 80]).collect();
    let texture = Texture::new(32, 32, Texels::Rgb888(&texels)).unwrap();
    let mut m = material();
    m.texture = Some(&texture);
    for mode in [Mode::Flat, Mode::Gouraud, Mode::Phong, Mode::Wire, Mode::Hidden, Mode::Points] {
        // Large: 256 x 256. Small: its middle 64 x 64, by a projection scaled four times.
        let eye = Vec3::from_f64([0.2, 0.3, 2.0]);
        let lens = |scale: i64| {
            let mut p = projection::perspective(
                Angle::from_degrees(Q16::from_int(90)),
                Q16::ONE,
                Q16::ONE,
                Q16::from_int(10),
            )
            .unwrap();
            for row in 0..2 {
                p.m[row].iter_mut().for_each(|v| *v *= scale);
            }
            p
        };
        let cam = |scale| {
            Camera::look_at(eye, Vec3::from_f64([0.3, 0.4, 0.0]), Vec3::Y, lens(scale)).unwrap()
        };
        let mut o = object(&mesh, &m, mode);
        o.point_size = 3;
        let objects = [o];
        let large: Picture<Rgb888> =
            draw(&scene(cam(1), &objects), Settings::new(256, 256), 256, false);
        let small: Picture<Rgb888> =
            draw(&scene(cam(4), &objects), Settings::new(64, 64), 64, false);
        let mut differ = 0;
        for y in 0..64 {
            for x in 0..64 {
                differ +=
                    (small.colour[y * 64 + x] != large.colour[(y + 96) * 256 + x + 96]) as u32;
            }
        }
        // The two cameras round a vertex alike up to the last bit of 1/16 pixel; a handful of pixels may follow.
        assert!(differ <= 12, "{mode:?}: {differ} pixels differ");
    }
}

/// A frame moved by whole pixels moves its pixels, exactly: the same mesh through matrices that differ by 5 and 3 pixels.
#[test]
fn whole_pixel_moves_move_pixels() {
    let mut random = Random(4);
    let mut soup = Owned::default();
    for i in 0..40u16 {
        for _ in 0..3 {
            // Multiples of 64 are whole 1/16 pixels in a frame of 128 x 128 pixels (32768 = 1024 / 16 pixel).
            let mut at = || (random.below(700) as i32 - 350) as i16 * 64;
            soup.positions.push([at(), at(), at()]);
            soup.colours.push([random.below(256) as u8, random.below(256) as u8, i as u8]);
            soup.normals.push([0, 0, 16384]);
        }
        soup.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        soup.edges.push([3 * i, 3 * i + 1]);
    }
    let mesh = soup.mesh();
    let m = unlit();
    for mode in [Mode::Gouraud, Mode::Flat, Mode::Wire, Mode::Hidden] {
        let mut o = object(&mesh, &m, mode);
        let pixel = 1i64 << (32 - 6);
        let mut picture = |dx: i64, dy: i64| -> Picture<Rgb888> {
            o.transform.m[0][3] = dx * pixel;
            o.transform.m[1][3] = -dy * pixel;
            let objects = [o];
            draw(&scene(flat_camera(), &objects), Settings::new(128, 128), 128, false)
        };
        let (still, moved) = (picture(0, 0), picture(5, 3));
        for y in 0..125 {
            for x in 0..123 {
                let (a, b) = (y * 128 + x, (y + 3) * 128 + x + 5);
                assert_eq!(still.colour[a], moved.colour[b], "{mode:?} {x},{y}");
                assert_eq!(still.depth[a], moved.depth[b], "{mode:?} {x},{y}");
            }
        }
    }
}

/// A mesh with one normal a triangle looks the same in the modes Flat and Gouraud, textured in perspective too.
#[test]
fn face_normals_make_gouraud_flat() {
    let mesh_data = sphere(10, 8);
    let normals: Vec<[i16; 3]> = (0..mesh_data.triangles.len())
        .map(|i| mesh_data.normals[mesh_data.triangles[i][0] as usize])
        .collect();
    let mesh = Mesh { normals: Normals::Face(&normals), ..mesh_data.mesh() };
    let texels: Vec<u16> = (0..16 * 16).map(|i| (i * 40503) as u16).collect();
    let texture = Texture::new(16, 16, Texels::Rgb565(&texels)).unwrap();
    let m = scanout::scene::Material { texture: Some(&texture), ..material() };
    let [flat, gouraud] = [Mode::Flat, Mode::Gouraud].map(|mode| -> Picture<Rgb888> {
        let objects = [object(&mesh, &m, mode)];
        draw(&scene(camera(160, 120), &objects), Settings::new(160, 120), 120, false)
    });
    assert!(flat == gouraud);
}

/// An object whose bounding sphere lies outside the view costs no vertices and changes no pixel.
#[test]
fn objects_out_of_view_are_culled_whole() {
    let mesh_data = sphere(10, 8);
    let bounds = Some(scanout::mesh::Sphere { centre: [0; 3], radius: 30_000 });
    let mesh = Mesh { bounds, ..mesh_data.mesh() };
    let m = material();
    let seen = object(&mesh, &m, Mode::Gouraud);
    let away = Object { transform: Mat4::translation(Vec3::from_f64([50.0, 0.0, 0.0])), ..seen };
    let settings = Settings::new(160, 120);
    let alone: Picture<Rgb888> = draw(&scene(camera(160, 120), &[seen]), settings, 120, false);
    for objects in [[seen, away], [away, seen]] {
        let s = scene(camera(160, 120), &objects);
        assert!(alone == draw(&s, settings, 50, false));
        let mut memory = Memory::new(Needed::at_most(&s));
        let stats = Frame::prepare(&s, settings, memory.store()).unwrap().stats();
        assert_eq!((stats.objects_culled, stats.vertices), (1, mesh.positions.len() as u32));
    }
}

/// Hidden-line removal keeps only lines that a shaded picture would show, and some of all edges.
#[test]
fn hidden_lines_are_hidden() {
    let mesh_data = sphere(16, 12);
    let mesh = mesh_data.mesh();
    let m = material();
    let lit = |mode| -> usize {
        let objects = [object(&mesh, &m, mode)];
        let p: Picture<Rgb888> =
            draw(&scene(camera(320, 240), &objects), Settings::new(320, 240), 240, false);
        p.colour.iter().filter(|&&c| c != [16, 24, 40]).count()
    };
    let (wire, hidden) = (lit(Mode::Wire), lit(Mode::Hidden));
    assert!(hidden * 10 > wire * 4 && hidden * 10 < wire * 7, "{hidden} of {wire}");
}

/// System A: a vertex list and an edge list, orthographic, origin at the screen's centre:
/// address = (160 + x) + (100 - y) * 320, black where drawn over the camera's picture.
#[test]
fn system_a_addresses_and_overlay() {
    // Whole pixels in a frame of 320 x 200: x / 160 and y / 100 of clip space.
    let ends = [[-100i32, 40], [57, -63]];
    let positions: Vec<[i16; 3]> =
        ends.iter().map(|e| [(e[0] * 200) as i16, (e[1] * 200) as i16, 0]).collect();
    let edges = [[0u16, 1]];
    let mesh = Mesh { positions: &positions, edges: &edges, ..Mesh::default() };
    let mut m = unlit();
    m.colour = [0; 3];
    // One clip unit is 32768 position units = 163.84 pixels at 200 units a pixel.
    let mut o = object(&mesh, &m, Mode::Wire);
    o.transform = Mat4::from_f64([
        [32768.0 / 200.0 / 160.0, 0.0, 0.0, 0.001],
        [0.0, 32768.0 / 200.0 / 100.0, 0.0, -0.001],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let picture: Vec<[u8; 3]> = (0..320 * 200).map(|i| [(i % 251) as u8 + 1, 7, 9]).collect();
    let objects = [o];
    let mut s = scene(flat_camera(), &objects);
    s.background = Background::Image(&picture);
    let p: Picture<Rgb888> = draw(&s, Settings::new(320, 200), 200, false);
    let black: Vec<usize> = (0..320 * 200).filter(|&i| p.colour[i] == [0; 3]).collect();
    for e in ends {
        let address = (160 + e[0]) + (100 - e[1]) * 320;
        assert!(black.contains(&(address as usize)), "{e:?}");
    }
    assert_eq!(black.len(), 158, "both ends drawn, one pixel a column");
    assert!(
        (0..320 * 200).all(|i| black.contains(&i) || p.colour[i] == picture[i]),
        "the rest is the camera's"
    );
}

/// Prepares a scene at once and in parts, which must come to the same.
fn tried(scene: &Scene, settings: Settings, needed: Needed) -> Result<Stats, PrepareError> {
    let mut memory = Memory::new(needed);
    let whole = Frame::prepare(scene, settings, memory.store()).map(|frame| frame.stats());
    for count in 1..=4 {
        let (mut memory, mut parts) = (Memory::new(needed), vec![Part::default(); count]);
        let in_parts = Preparation::new(scene, settings, memory.store(), &mut parts).and_then(
            |mut preparation| {
                preparation.vertex_parts().for_each(|part| part.run());
                preparation.primitive_parts().for_each(|part| part.run());
                preparation.finish().map(|frame| frame.stats())
            },
        );
        assert_eq!(in_parts, whole, "{count} parts");
    }
    whole
}

/// Too little memory is an error with the number, never a missing triangle.
#[test]
fn too_little_memory_is_said() {
    let mesh_data = sphere(8, 6);
    let mesh = mesh_data.mesh();
    let m = material();
    let objects = [object(&mesh, &m, Mode::Flat)];
    let scene = scene(camera(64, 48), &objects);
    let settings = Settings::new(64, 48);
    let most = Needed::at_most(&scene);
    let mut memory = Memory::new(most);
    let exact =
        Frame::prepare(&scene, settings, memory.store()).unwrap().stats().primitives as usize;
    assert!(exact < most.primitives);
    match tried(&scene, settings, Needed { primitives: exact - 1, ..most }) {
        Err(PrepareError::Store { needed, given }) => {
            assert_eq!((needed.primitives, given.primitives), (exact, exact - 1));
        }
        other => panic!("{other:?}"),
    }
    let error = tried(&scene, settings, Needed { vertices: 3, ..most }).unwrap_err();
    assert!(format!("{error}").contains(&format!("needs {}", most.vertices)), "{error}");
    let mut memory = Memory::new(Needed { primitives: exact, ..most });
    let frame = Frame::prepare(&scene, settings, memory.store()).unwrap();
    let short = frame.draw_rows::<Rgb565>(0..3, &mut [0; 64 * 3 - 1], &mut [0; 64 * 3]);
    assert_eq!(short, Err(BandError::Memory { colour: 192, depth: 192 }));
    assert_eq!(
        frame.draw_rows::<Rgb565>(40..49, &mut [], &mut []),
        Err(BandError::Rows { height: 48 })
    );
}

/// Wrong meshes, textures, sizes, lights and backgrounds are refused, never drawn and never a panic.
#[test]
fn wrong_scenes_are_refused() {
    let mesh_data = sphere(4, 4);
    let good = mesh_data.mesh();
    let m = material();
    let settings = Settings::new(64, 48);
    let try_mesh = |mesh: &Mesh, mode| {
        let objects = [object(mesh, &m, mode)];
        let scene = scene(camera(64, 48), &objects);
        tried(&scene, settings, Needed::at_most(&scene)).map(|_| ())
    };
    let index = Err(PrepareError::Index { object: 0, element: 1 });
    let lengths = Err(PrepareError::Lengths { object: 0 });
    assert_eq!(
        try_mesh(
            &Mesh { triangles: &[[0, 1, 2], [0, 1, 999]], uv_triangles: &[], ..good },
            Mode::Flat
        ),
        index
    );
    assert_eq!(try_mesh(&Mesh { edges: &[[0, 1], [0, 999]], ..good }, Mode::Wire), index);
    assert_eq!(
        try_mesh(&Mesh { normals: Normals::Vertex(&[[0; 3]]), ..good }, Mode::Gouraud),
        lengths
    );
    assert_eq!(try_mesh(&Mesh { normals: Normals::Face(&[[0; 3]]), ..good }, Mode::Flat), lengths);
    assert_eq!(try_mesh(&Mesh { colours: &[[0; 3]], ..good }, Mode::Flat), lengths);
    assert_eq!(try_mesh(&Mesh { clusters: &[Cluster::default()], ..good }, Mode::Flat), lengths);
    assert_eq!(try_mesh(&Mesh { uv_triangles: &[[0; 3]], ..good }, Mode::Flat), lengths);
    let far_uvs = vec![[999u16; 3]; good.triangles.len()];
    assert!(matches!(
        try_mesh(&Mesh { uv_triangles: &far_uvs, ..good }, Mode::Flat),
        Err(PrepareError::Index { .. })
    ));

    let scene_of = |f: &dyn Fn(&mut Scene)| {
        let mut s = scene(camera(64, 48), &[]);
        f(&mut s);
        tried(&s, settings, Needed::at_most(&s)).map(|_| ())
    };
    assert_eq!(scene_of(&|_| ()), Ok(()));
    let lights: Vec<Light> = vec![common::LIGHT; 9];
    let lights: &'static [Light] = lights.leak();
    assert_eq!(scene_of(&|s| s.lights = lights), Err(PrepareError::Lights(9)));
    assert_eq!(
        scene_of(&|s| s.background = Background::Image(&[[0; 3]; 5])),
        Err(PrepareError::Background { needed: 64 * 48, given: 5 })
    );
    let s = scene(camera(64, 48), &[]);
    let size = tried(&s, Settings::new(0, 48), Needed::at_most(&s)).unwrap_err();
    assert_eq!(size, PrepareError::Size { width: 0, height: 48 });
}

/// Random matrices and meshes, degenerate ones among them: no panic, whatever comes out.
#[test]
fn random_scenes_never_panic() {
    let mut random = Random(8);
    for round in 0..600 {
        let mut own = Owned::default();
        for _ in 0..30 {
            own.positions.push([(); 3].map(|()| random.below(65536) as u16 as i16));
            own.normals.push([(); 3].map(|()| random.below(65536) as u16 as i16));
            own.uvs.push([(); 2].map(|()| (random.below(1 << 30) as i32) << (random.below(3))));
        }
        for _ in 0..20 {
            own.triangles.push([(); 3].map(|()| random.below(30) as u16));
            own.edges.push([(); 2].map(|()| random.below(30) as u16));
        }
        let mesh = own.mesh();
        let texels = [[200u8, 100, 50]; 7 * 5];
        let texture = Texture::new(7, 5, Texels::Rgb888(&texels)).unwrap();
        let mut m = material();
        (m.texture, m.two_sided) = (Some(&texture), random.below(2) == 0);
        let modes =
            [Mode::Points, Mode::Wire, Mode::Hidden, Mode::Flat, Mode::Gouraud, Mode::Phong];
        let mut any =
            |size: f64| Mat4::from_f64([(); 4].map(|()| [(); 4].map(|()| random.unit() * size)));
        let sizes = [1e-6, 1.0, 1e4, 1e9];
        let o = Object { transform: any(sizes[round % 4]), ..object(&mesh, &m, modes[round % 6]) };
        let objects = [o];
        let mut s = scene(flat_camera(), &objects);
        if round % 3 != 0 {
            s.camera.projection = any(sizes[round / 4 % 4]);
        }
        let settings = Settings::new(1 + random.below(90) as u16, 1 + random.below(90) as u16);
        draw::<Rgb565>(&s, settings, 17, false);
    }
}
