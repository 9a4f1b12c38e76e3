//! The law: a picture is a pure function. The same frame by spans and by tiles, in bands of any height, forwards and
//! backwards, on several threads, with `==` on every word of colour and depth.

mod common;

use common::{Memory, Picture, camera, draw, material, object, scene, sphere};
use scanout::camera::{Camera, projection};
use scanout::frame::{Frame, Needed, Part, Preparation, Settings, Traversal};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::{Cluster, Mesh, Normals, Sphere};
use scanout::mesh_clusters::clusters;
use scanout::output::{Mono, PixelFormat, Rgb332, Rgb565, Rgb888};
use scanout::scene::{Background, Fog, Mode, Object, Scene};
use scanout::texture::{Filter, Texels, Texture, Wrap};

const SIZE: Settings = Settings::new(160, 120);

fn check<F: PixelFormat>(name: &str, scene: &Scene) {
    let whole: Picture<F> = draw(scene, SIZE, SIZE.height, false);
    let background: Picture<F> = draw(&Scene { objects: &[], ..*scene }, SIZE, SIZE.height, false);
    assert!(whole != background, "{name}: nothing was drawn");
    in_parts(name, scene, &whole);
    for dither in [false, true] {
        let settings = Settings { dither, ..SIZE };
        let whole: Picture<F> = draw(scene, settings, SIZE.height, false);
        for traversal in
            [Traversal::Spans, Traversal::Baseline, Traversal::Pixels, Traversal::Tiles]
        {
            for (lines, backwards) in [(1, false), (7, false), (7, true), (SIZE.height, true)] {
                let other: Picture<F> =
                    draw(scene, Settings { traversal, ..settings }, lines, backwards);
                assert!(
                    whole == other,
                    "{name}: {traversal:?}, bands of {lines}, backwards {backwards}"
                );
            }
        }
    }
}

/// Prepared in parts, the last first, and drawn in bands of equal work: the same counts, the same pixels. So it is when the
/// store has room for what is kept and no more, and when the caller forgets a part.
fn in_parts<F: PixelFormat>(name: &str, scene: &Scene, whole: &Picture<F>) {
    let most = Needed::at_most(scene);
    for traversal in [Traversal::Spans, Traversal::Pixels] {
        let settings = Settings { traversal, ..SIZE };
        let mut memory = Memory::new(most);
        let stats = Frame::prepare(scene, settings, memory.store()).unwrap().stats();
        let kept = Needed { primitives: stats.primitives as usize, ..most };
        for (parts, needed, forget) in (1..=5).map(|parts| (parts, most, None)).chain([
            (3, kept, None),
            (4, most, Some(Step::Vertices)),
            (4, most, Some(Step::Primitives)),
        ]) {
            let mut memory = Memory::new(needed);
            let mut memory_of_parts = vec![Part::default(); parts];
            let mut preparation =
                Preparation::new(scene, settings, memory.store(), &mut memory_of_parts).unwrap();
            let mut vertices: Vec<_> = preparation.vertex_parts().collect();
            if forget == Some(Step::Vertices) {
                vertices.pop();
            }
            vertices.into_iter().rev().for_each(|part| part.run());
            let mut primitives: Vec<_> = preparation.primitive_parts().collect();
            if forget == Some(Step::Primitives) {
                primitives.pop();
            }
            primitives.into_iter().rev().for_each(|part| part.run());
            let frame = preparation.finish().unwrap();
            let name = format!("{name}: {traversal:?}, {parts} parts, forgot {forget:?}");
            assert_eq!(frame.stats(), stats, "{name}");
            let words = F::words(SIZE.width as usize);
            let mut colour = Vec::new();
            let mut depth = Vec::new();
            for rows in frame.bands(parts as u16) {
                let mut band = vec![F::Word::default(); rows.len() * words];
                let mut band_depth = vec![0; rows.len() * SIZE.width as usize];
                frame.draw_rows::<F>(rows, &mut band, &mut band_depth).unwrap();
                colour.append(&mut band);
                depth.append(&mut band_depth);
            }
            assert!(*whole == Picture { colour, depth }, "{name}");
        }
    }
}

/// A step of preparing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Vertices,
    Primitives,
}

fn checkerboard() -> Vec<[u8; 3]> {
    (0..60 * 40 + 30 * 20 + 15 * 10)
        .map(|i| if (i / 5 + i / 300) % 2 == 0 { [250, 240, 200] } else { [180, 40, i as u8] })
        .collect()
}

/// Every mode, with and without texture, fog and smooth lines, two objects that cut each other.
#[test]
fn every_mode_in_every_order() {
    let mesh_data = sphere(16, 12);
    let mesh = mesh_data.mesh();
    let texels = checkerboard();
    let small_texels: Vec<u16> = (0..16 * 8).map(|i| (i * 40503) as u16).collect();
    let small = Texture::new(16, 8, Texels::Rgb565(&small_texels)).unwrap();
    let mut texture = Texture::new(60, 40, Texels::Rgb888(&texels)).unwrap();
    (texture.levels, texture.wrap) = (3, [Wrap::Mirror, Wrap::Border]);
    texture.filter = Filter::Bilinear;
    for mode in [Mode::Points, Mode::Wire, Mode::Hidden, Mode::Flat, Mode::Gouraud, Mode::Phong] {
        for variant in 0..3 {
            let mut m = material();
            m.texture = (variant == 1).then_some(&texture);
            m.two_sided = variant == 2;
            let mut first = object(&mesh, &m, mode);
            (first.smooth_lines, first.point_size) = (variant == 1, 1 + 3 * variant as u8);
            // The second object's own material: another texture, of the kind that is fetched the short way.
            let mut other = m;
            other.texture = (variant > 0).then_some(&small);
            let mut second = first;
            second.material = &other;
            second.transform = Mat4::translation(Vec3::from_f64([0.7, 0.3, 0.2]));
            let objects = [first, second];
            let mut scene = scene(camera(160, 120), &objects);
            if variant == 2 {
                scene.fog =
                    Some(Fog::Exponential { colour: [90, 90, 120], density: Q16::from_f64(0.3) });
            }
            check::<Rgb565>(&format!("{mode:?} {variant}"), &scene);
        }
    }
}

/// Textures with a palette: drawn as their colours are, in every order.
#[test]
fn palettes() {
    let mesh_data = sphere(16, 12);
    let mesh = mesh_data.mesh();
    let palette: Vec<u16> = (0..256).map(|i| (i * 40503) as u16).collect();
    let eight: Vec<u8> = (0..60 * 40).map(|i| (i / 7 % 16) as u8).collect();
    let four: Vec<u8> = eight.chunks(2).map(|pair| pair[0] | pair[1] << 4).collect();
    let colours: Vec<u16> = eight.iter().map(|&i| palette[usize::from(i)]).collect();
    for filter in [Filter::Nearest, Filter::Bilinear] {
        for mode in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
            let draw_with = |texels| {
                let mut texture = Texture::new(60, 40, texels).unwrap();
                texture.filter = filter;
                let mut m = material();
                m.texture = Some(&texture);
                let objects = [object(&mesh, &m, mode)];
                let scene = scene(camera(160, 120), &objects);
                if mode == Mode::Gouraud && matches!(texels, Texels::Palette4 { .. }) {
                    check::<Rgb565>(&format!("palette {filter:?}"), &scene);
                }
                draw::<Rgb565>(&scene, SIZE, SIZE.height, false)
            };
            let expected = draw_with(Texels::Rgb565(&colours));
            let palette = &palette[..];
            let same = [
                draw_with(Texels::Palette8 { indices: &eight, palette }),
                draw_with(Texels::Palette4 { indices: &four, palette: &palette[..16] }),
            ];
            assert!(same.iter().all(|picture| *picture == expected), "{mode:?} {filter:?}");
        }
    }
}

#[test]
fn every_format() {
    let mesh_data = sphere(16, 12);
    let mesh = mesh_data.mesh();
    let m = material();
    let objects = [object(&mesh, &m, Mode::Gouraud)];
    let picture: Vec<[u8; 3]> =
        (0..160 * 120).map(|i| [(i % 160) as u8, (i / 160) as u8, 99]).collect();
    let mut scene = scene(camera(160, 120), &objects);
    scene.background = Background::Image(&picture);
    check::<Rgb888>("rgb888", &scene);
    check::<Rgb565>("rgb565", &scene);
    check::<Rgb332>("rgb332", &scene);
    check::<Mono>("mono", &scene);
}

/// A camera inside the mesh: triangles cross the near plane and reach far outside the screen.
#[test]
fn clipped_scenes() {
    let mesh_data = sphere(10, 8);
    let mesh = mesh_data.mesh();
    let mut m = material();
    m.two_sided = true;
    let lens = projection::perspective(
        Angle::from_degrees(Q16::from_int(100)),
        Q16::from_ratio(4, 3),
        Q16::from_f64(0.01),
        Q16::from_int(10),
    )
    .unwrap();
    let eye = Vec3::from_f64([0.3, 0.1, 0.75]);
    let camera = Camera::look_at(eye, Vec3::from_f64([-1.0, 0.0, 0.6]), Vec3::Y, lens).unwrap();
    for mode in [Mode::Flat, Mode::Gouraud, Mode::Phong, Mode::Wire, Mode::Hidden] {
        let objects = [object(&mesh, &m, mode)];
        check::<Rgb888>(&format!("inside, {mode:?}"), &scene(camera, &objects));
    }
}

/// RGB565 is drawn eight pixels at a time where the machine can, RGB888 one at a time: the first is the second, encoded.
#[test]
fn eight_at_a_time_is_one_at_a_time() {
    let texels: Vec<u16> = (0..32 * 27).map(|i| (i * 40503) as u16).collect();
    let texture = Texture::new(32, 27, Texels::Rgb565(&texels)).unwrap();
    for (segments, rings) in [(5, 4), (16, 12), (60, 40)] {
        let mesh_data = sphere(segments, rings);
        let mesh = mesh_data.mesh();
        for (mode, textured) in
            [(Mode::Flat, false), (Mode::Gouraud, false), (Mode::Flat, true), (Mode::Gouraud, true)]
        {
            let mut m = material();
            m.texture = textured.then_some(&texture);
            m.two_sided = true;
            let objects = [object(&mesh, &m, mode)];
            // Widths that are and are not multiples of eight, and one narrower than that.
            for width in [160, 157, 5] {
                let settings = Settings::new(width, 120);
                let scene = scene(camera(160, 120), &objects);
                let fast: Picture<Rgb565> = draw(&scene, settings, 50, false);
                let slow: Picture<Rgb888> = draw(&scene, settings, 120, false);
                let encoded: Vec<u16> = slow.colour.iter().map(|&c| Rgb565::encode(c)).collect();
                assert!(fast.depth == slow.depth, "{mode:?} {textured} {width}");
                assert!(fast.colour == encoded, "{mode:?} {textured} {width}");
            }
        }
    }
}

/// Clouds of small triangles of all shapes, whose textures repeat within them, are drawn the same whatever the processor offers.
#[test]
fn clouds_of_small_triangles() {
    let mut seed = 9u64;
    let mut random = |n: u32| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (((seed >> 32) * n as u64) >> 32) as i32
    };
    let texels: Vec<u16> = (0..64 * 64).map(|i| (i * 40503) as u16).collect();
    let mut drawn = 0;
    for case in 0..60 {
        let size = [(1, 1), (2, 1), (3, 2), (7, 5), (64, 64)][case % 5];
        let texture = Texture::new(size.0, size.1, Texels::Rgb565(&texels)).unwrap();
        let reach = [300, 1500, 6000, 30_000][case % 4];
        // Along the line of sight, so that 1/w varies a hundredfold within a triangle.
        let needles = case % 4 == 2 && case % 3 != 0;
        let mut positions = Vec::new();
        for _ in 0..400 {
            let centre = [(); 3].map(|()| random(50_000) - 25_000);
            for _ in 0..3 {
                let mut at = |c: i32| (c + random(2 * reach) - reach as i32).clamp(-32768, 32767);
                let mut position = centre.map(|c| at(c) as i16);
                if needles {
                    let near = random(3) == 0;
                    let narrow = if near { 2000 } else { 10 };
                    position = [position[0] / narrow, position[1] / narrow, position[2]];
                    if near {
                        position[2] = (32767 - random(60)) as i16;
                    }
                }
                positions.push(position);
            }
        }
        let spread = [1 << 14, 1 << 16, 5 << 16][case % 3];
        let uvs: Vec<[i32; 2]> = positions
            .iter()
            .map(|_| [(); 2].map(|()| random(2 * spread) - spread as i32))
            .collect();
        let colours: Vec<[u8; 3]> =
            positions.iter().map(|_| [(); 3].map(|()| random(256) as u8)).collect();
        let normals = vec![[0, 0, 1 << 14]; positions.len()];
        let triangles: Vec<[u16; 3]> = (0..400).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Mesh {
            positions: &positions,
            normals: Normals::Vertex(&normals),
            colours: &colours,
            uvs: &uvs,
            triangles: &triangles,
            uv_triangles: &triangles,
            ..Mesh::default()
        };
        let mut m = material();
        (m.two_sided, m.ambient) = (case % 2 == 0, Q16::ONE);
        m.texture = (case % 7 < 5).then_some(&texture);
        // Near enough that some must be clipped, and 1/w varies much within a triangle.
        let lens = projection::perspective(
            Angle::from_degrees(Q16::from_int(90)),
            Q16::from_ratio(4, 3),
            Q16::from_f64(if case % 4 < 2 { 0.3 } else { 0.001 }),
            Q16::from_int(10),
        )
        .unwrap();
        let eye = Vec3::from_f64([0.0, 0.0, if case % 3 == 0 { 0.2 } else { 1.001 }]);
        let camera = Camera::look_at(eye, Vec3::from_f64([0.0, 0.0, -5.0]), Vec3::Y, lens).unwrap();
        for mode in [Mode::Flat, Mode::Gouraud] {
            let objects = [object(&mesh, &m, mode)];
            let scene = scene(camera, &objects);
            let whole: Picture<Rgb565> = draw(&scene, SIZE, 120, false);
            drawn += whole.depth.iter().filter(|&&z| z != u16::MAX).count();
            for (traversal, lines) in [
                (Traversal::Spans, 9),
                (Traversal::Baseline, 120),
                (Traversal::Baseline, 1),
                (Traversal::Pixels, 120),
                (Traversal::Tiles, 120),
            ] {
                let settings = Settings { traversal, ..SIZE };
                let other: Picture<Rgb565> = draw(&scene, settings, lines, false);
                assert!(whole == other, "cloud {case}, {mode:?}, {traversal:?}, {lines} lines");
            }
            let slow: Picture<Rgb888> = draw(&scene, SIZE, 120, false);
            let encoded: Vec<u16> = slow.colour.iter().map(|&c| Rgb565::encode(c)).collect();
            assert!(whole.colour == encoded && whole.depth == slow.depth, "cloud {case}, {mode:?}");
        }
    }
    assert!(drawn > 120 * 2000, "{drawn} pixels");
}

/// With clusters and without: the same counts, the same pixels, prepared at once and in parts, from near and far.
#[test]
fn clusters_change_nothing() {
    let mesh_data = sphere(40, 40);
    let all: Vec<Cluster> = clusters(&mesh_data.positions, &mesh_data.triangles).collect();
    let bounds = Some(Sphere { centre: [0; 3], radius: 29_500 });
    let without = Mesh { bounds, ..mesh_data.mesh() };
    let with = Mesh { clusters: &all, ..without };
    // Turned away for this test's camera: a picture that shows it is one that misses triangles.
    let wrong: Vec<Cluster> = all.iter().rev().copied().collect();
    let wrong = Mesh { clusters: &wrong, ..without };
    let stats = |scene: &Scene, settings: Settings| {
        let mut memory = Memory::new(Needed::at_most(scene));
        Frame::prepare(scene, settings, memory.store()).unwrap().stats()
    };
    for mode in [Mode::Points, Mode::Wire, Mode::Hidden, Mode::Flat, Mode::Gouraud, Mode::Phong] {
        for (case, two_sided, place) in [
            (0, false, [0.0, 0.0, 0.0]),
            (1, true, [0.0, 0.0, 0.0]),
            (2, false, [1.1, 0.4, -1.0]),
            (3, false, [0.3, 0.2, 1.4]),
            (4, false, [0.2, 0.1, -6.5]),
            (5, false, [0.0, 0.3, 2.5]),
        ] {
            let mut m = material();
            m.two_sided = two_sided;
            let place = Mat4::translation(Vec3::from_f64(place));
            let draw_with = |mesh: &Mesh, traversal| {
                let objects = [Object { transform: place, ..object(mesh, &m, mode) }];
                let scene = scene(camera(160, 120), &objects);
                let settings = Settings { traversal, ..SIZE };
                let picture = draw::<Rgb565>(&scene, settings, SIZE.height, false);
                (picture, stats(&scene, settings))
            };
            for traversal in [Traversal::Pixels, Traversal::Spans] {
                let (picture, counts) = draw_with(&without, traversal);
                let (same, same_counts) = draw_with(&with, traversal);
                assert!(picture == same, "{mode:?} {case} {traversal:?}");
                assert_eq!(counts, same_counts, "{mode:?} {case} {traversal:?}");
                let objects = [Object { transform: place, ..object(&with, &m, mode) }];
                in_parts("clusters", &scene(camera(160, 120), &objects), &same);
            }
            let used = mode == Mode::Flat && case == 0;
            if used {
                let (picture, _) = draw_with(&without, Traversal::Pixels);
                assert!(
                    draw_with(&wrong, Traversal::Pixels).0 != picture,
                    "clusters are not asked"
                );
            }
        }
    }
}

/// Several threads draw bands of one prepared frame.
#[test]
fn threads_share_a_frame() {
    let mesh_data = sphere(32, 24);
    let mesh = mesh_data.mesh();
    let m = material();
    let objects = [object(&mesh, &m, Mode::Phong)];
    let scene = scene(camera(160, 120), &objects);
    let whole: Picture<Rgb565> = draw(&scene, SIZE, 120, false);
    let mut memory = Memory::new(Needed::at_most(&scene));
    let frame = Frame::prepare(&scene, SIZE, memory.store()).unwrap();
    let (mut colour, mut depth) = (vec![0u16; 160 * 120], vec![0u16; 160 * 120]);
    std::thread::scope(|threads| {
        for (i, (c, d)) in colour.chunks_mut(160 * 13).zip(depth.chunks_mut(160 * 13)).enumerate() {
            let frame = &frame;
            threads.spawn(move || {
                let top = i as u16 * 13;
                frame.draw_rows::<Rgb565>(top..120.min(top + 13), c, d).unwrap();
            });
        }
    });
    assert!(colour == whole.colour && depth == whole.depth);
}

/// The hash is the same for any bands and differs when a pixel does.
#[test]
fn hashes() {
    let mesh_data = sphere(16, 12);
    let mesh = mesh_data.mesh();
    let m = material();
    let objects = [object(&mesh, &m, Mode::Gouraud)];
    let scene = scene(camera(160, 120), &objects);
    let hash = |scene: &Scene, lines: u16| {
        let mut memory = Memory::new(Needed::at_most(scene));
        let frame = Frame::prepare(scene, SIZE, memory.store()).unwrap();
        frame.hash::<Rgb565>(lines, &mut [0; 160 * 120], &mut [0; 160 * 120]).unwrap()
    };
    let whole = hash(&scene, 120);
    assert_eq!(whole, hash(&scene, 1));
    assert_eq!(whole, hash(&scene, 7));
    let moved =
        [Object { transform: Mat4::translation(Vec3::from_f64([0.02, 0.0, 0.0])), ..objects[0] }];
    assert_ne!(whole, hash(&Scene { objects: &moved, ..scene }, 7));
}
