//! The window's geometry, against rays: the eye, the pixel and the thing seen in it lie on one straight line.

mod support;

use scanout::camera::Camera;
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Mat4, Q16};
use scanout::mesh::Mesh;
use scanout::output::Rgb888;
use scanout::scene::{Material, Mode, Object, Scene};
use scanout::transform::{CLIP, ClipMatrix, Vertex, Viewport};
use scanout_head::V3;
use scanout_head::screen::Screen;
use support::Random;

/// Near and far plane, mm.
const PLANES: [f64; 2] = [20.0, 4000.0];

/// Eye positions.
const EYES: usize = 1000;

/// A screen of one of three tilts and an eye anywhere before it.
fn setting(random: &mut Random, index: usize) -> (Screen, V3) {
    let tilt = [0.0, 15.0, -25.0][index % 3];
    let screen = Screen::new(520.0, 290.0, tilt).unwrap();
    let own = [
        random.between(-500.0, 500.0),
        random.between(-350.0, 350.0),
        random.between(280.0, 1200.0),
    ];
    (screen, screen.place(own))
}

/// Where on the screen a ray from the eye to `place` passes, in pixels from the top left corner: f64, without the library.
fn pixel_of(screen: &Screen, eye: V3, place: V3, [w, h]: [f64; 2]) -> [f64; 2] {
    let (eye, place) = (screen.own(eye), screen.own(place));
    let t = eye[2] / (eye[2] - place[2]);
    let [x, y] = [0, 1].map(|i| eye[i] + (place[i] - eye[i]) * t);
    [(x / screen.size[0] + 0.5) * w, (0.5 - y / screen.size[1]) * h]
}

/// The vertex of a place in mm, through the pipeline.
fn vertex(camera: &Camera, place: V3, size: [u16; 2]) -> Vertex {
    let object = Mat4::from_f64([
        [1.0, 0.0, 0.0, place[0]],
        [0.0, 1.0, 0.0, place[1]],
        [0.0, 0.0, 1.0, place[2]],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let matrix = camera.projection.mul(&camera.view).mul(&object);
    Viewport::new(size[0], size[1]).project(&ClipMatrix::new(&matrix).apply([0; 3]))
}

#[test]
fn eye_pixel_and_thing_are_collinear() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let size = [640u16, 360];
    let (mut worst, mut judged, mut before) = (0.0f64, 0, 0);
    for index in 0..EYES {
        let (screen, eye) = setting(&mut random, index);
        let camera = screen.camera(eye, PLANES[0], PLANES[1]).unwrap();
        for _ in 0..20 {
            // Behind the glass and in front of it, up to 80 mm before the eye.
            let nearest = screen.own(eye)[2] - 80.0;
            let own = [
                random.between(-260.0, 260.0),
                random.between(-145.0, 145.0),
                random.between(-600.0, nearest),
            ];
            let place = screen.place(own);
            let expected = pixel_of(&screen, eye, place, size.map(f64::from));
            let seen = vertex(&camera, place, size);
            if seen.flags & CLIP != 0 || expected.iter().any(|x| x.abs() > 4000.0) {
                continue; // far outside the picture: the clip stage's
            }
            let got = [seen.x, seen.y].map(|x| f64::from(x) / 16.0);
            worst = worst.max((got[0] - expected[0]).abs()).max((got[1] - expected[1]).abs());
            judged += 1;
            before += usize::from(own[2] > 0.0);
        }
    }
    println!(
        "{judged} places ({before} before the glass), {EYES} eyes: at most {worst:.4} pixel apart"
    );
    assert!(judged > 15_000 && before > 3_000, "{judged} {before}");
    // Positions are snapped to 1/16 pixel, so 1/32 is the least that can be asked.
    assert!(worst < 0.04, "{worst}");
}

/// A box in mm along the viewer's axes, with a colour for each side.
struct Cube {
    middle: V3,
    half: f64,
}

const COLOURS: [[u8; 3]; 6] =
    [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], [0, 255, 255], [255, 0, 255]];

impl Cube {
    /// The colour that a ray from `eye` through `through` hits first, black for none (slab method).
    fn hit(&self, eye: V3, through: V3) -> [u8; 3] {
        let (mut enter, mut leave, mut side) = (f64::MIN, f64::MAX, 0);
        for i in 0..3 {
            let direction = through[i] - eye[i];
            let (a, b) = (self.middle[i] - self.half - eye[i], self.middle[i] + self.half - eye[i]);
            let (low, high) = (a / direction, b / direction);
            // A ray that runs along the axis enters at the low side.
            let (near, far, first) =
                if low < high { (low, high, 2 * i) } else { (high, low, 2 * i + 1) };
            if near > enter {
                (enter, side) = (near, first);
            }
            leave = leave.min(far);
        }
        if enter < leave && enter > 0.0 { COLOURS[side] } else { [0; 3] }
    }

    /// The corners of a side, in order.
    fn side(&self, side: usize) -> [V3; 4] {
        let (axis, high) = (side / 2, side % 2);
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
            let mut ends = [0; 3];
            (ends[axis], ends[(axis + 1) % 3], ends[(axis + 2) % 3]) = (high, u, v);
            std::array::from_fn(|i| self.middle[i] + [-self.half, self.half][ends[i]])
        })
    }

    /// Is the eye on the outer side of a side's plane?
    fn faces(&self, side: usize, eye: V3) -> bool {
        let from_middle = eye[side / 2] - self.middle[side / 2];
        if side % 2 == 1 { from_middle > self.half } else { from_middle < -self.half }
    }

    /// The picture that the pipeline draws.
    fn drawn(&self, camera: Camera, [width, height]: [u16; 2]) -> Vec<[u8; 3]> {
        let m = 32767;
        let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { m } else { -m });
        let positions: [[i16; 3]; 8] = std::array::from_fn(corner);
        // The corners of each side, counter-clockwise seen from outside.
        let triangles: Vec<[[u16; 3]; 2]> = (0..6usize)
            .map(|side| {
                let (axis, high) = (side / 2, side % 2);
                let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                let base = high << axis;
                let (u, v) = if high == 1 { (u, v) } else { (v, u) };
                let k = [base, base | u, base | u | v, base | v].map(|k| k as u16);
                [[k[0], k[1], k[2]], [k[0], k[2], k[3]]]
            })
            .collect();
        let meshes: Vec<Mesh> = triangles
            .iter()
            .map(|t| Mesh { positions: &positions, triangles: t, ..Mesh::default() })
            .collect();
        let materials: Vec<Material> = COLOURS
            .iter()
            .map(|&colour| Material {
                colour,
                ambient: Q16::ONE,
                diffuse: Q16::ZERO,
                ..Material::default()
            })
            .collect();
        let s = self.half * 32768.0 / 32767.0;
        let [x, y, z] = self.middle;
        let transform = Mat4::from_f64([
            [s, 0.0, 0.0, x],
            [0.0, s, 0.0, y],
            [0.0, 0.0, s, z],
            [0.0, 0.0, 0.0, 1.0],
        ]);
        let objects: Vec<Object> = meshes
            .iter()
            .zip(&materials)
            .map(|(mesh, material)| Object { transform, ..Object::new(mesh, material, Mode::Flat) })
            .collect();
        let scene = Scene::new(camera, &objects);
        let needed = Needed::at_most(&scene);
        let mut vertices = vec![Vertex::default(); needed.vertices];
        let mut primitives = vec![Primitive::default(); needed.primitives];
        let mut states = vec![ObjectState::default(); needed.objects];
        let store =
            Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
        let frame = Frame::prepare(&scene, Settings::new(width, height), store).unwrap();
        let pixels = usize::from(width) * usize::from(height);
        let (mut colour, mut depth) = (vec![[0; 3]; pixels], vec![0; pixels]);
        frame.draw_rows::<Rgb888>(0..height, &mut colour, &mut depth).unwrap();
        colour
    }
}

/// Does a polygon have a point in an upright rectangle (Sutherland and Hodgman's clipping)?
fn touches(polygon: &[[f64; 2]], [low, high]: [[f64; 2]; 2]) -> bool {
    let mut left = polygon.to_vec();
    for (axis, bound, sign) in
        [(0, low[0], 1.0), (0, high[0], -1.0), (1, low[1], 1.0), (1, high[1], -1.0)]
    {
        let inside = |p: &[f64; 2]| (p[axis] - bound) * sign;
        let mut kept = Vec::new();
        for (i, a) in left.iter().enumerate() {
            let b = &left[(i + 1) % left.len()];
            let (da, db) = (inside(a), inside(b));
            if da >= 0.0 {
                kept.push(*a);
            }
            if (da < 0.0) != (db < 0.0) {
                let t = da / (da - db);
                kept.push([0, 1].map(|k| a[k] + (b[k] - a[k]) * t));
            }
        }
        left = kept;
    }
    !left.is_empty()
}

/// Whole pictures against a ray tracer: a pixel shows what the ray through its centre hits, or a side that the rays through points
/// at most half a pixel away along each axis reach.
#[test]
fn pictures_are_those_of_a_ray_tracer() {
    let mut random = Random(0xd1b5_4a32_d192_ed03);
    let size = [72u16, 40];
    let (mut pixels, mut cube_pixels, mut edge) = (0, 0, 0);
    for index in 0..EYES {
        let (screen, eye) = setting(&mut random, index);
        // Behind the glass, in front of it, and cut by it.
        let depth = [-250.0, 90.0, 0.0][index / 3 % 3];
        let middle = [random.between(-120.0, 120.0), random.between(-60.0, 60.0), depth];
        let half = random.between(30.0, 70.0);
        let cube = Cube { middle, half };
        let camera = screen.camera(eye, PLANES[0], PLANES[1]).unwrap();
        let drawn = cube.drawn(camera, size);
        let [w, h] = size.map(f64::from);
        let at = |x: f64, y: f64| screen.at(x / w * 2.0 - 1.0, 1.0 - y / h * 2.0);
        for (i, got) in drawn.iter().enumerate() {
            let x = (i % usize::from(size[0])) as f64 + 0.5;
            let y = (i / usize::from(size[0])) as f64 + 0.5;
            let expected = cube.hit(eye, at(x, y));
            pixels += 1;
            cube_pixels += usize::from(expected != [0; 3]);
            if *got == expected {
                continue;
            }
            edge += 1;
            let square = [[x - 0.5, y - 0.5], [x + 0.5, y + 0.5]];
            let near = match COLOURS.iter().position(|colour| colour == got) {
                // A convex thing's side is seen as a whole or not at all.
                Some(side) => {
                    let corners = cube.side(side).map(|p| pixel_of(&screen, eye, p, [w, h]));
                    cube.faces(side, eye) && touches(&corners, square)
                }
                // Past the outline: one of the square's corners is.
                None => (0..4).any(|k| {
                    let corner = at(square[k % 2][0], square[k / 2][1]);
                    cube.hit(eye, corner) == [0; 3]
                }),
            };
            assert!(
                near,
                "eye {eye:?}, cube {middle:?}, pixel {x}, {y}: {got:?}, ray {expected:?}"
            );
        }
    }
    println!(
        "{EYES} eyes, {pixels} pixels, {cube_pixels} of them cube: {edge} differ, each within half a pixel of an edge"
    );
    assert!(cube_pixels > 100_000, "{cube_pixels}");
    assert!(edge * 100 < cube_pixels, "only rounding at edges may differ: {edge}");
}

/// System C's whole projection unit in its own integers: `dx = |x - xv| * (640 - zv) / (z - zv)`, cut off, added to or taken from
/// the viewer's x.
fn system_c(viewer: [i64; 3], place: [i64; 3]) -> [i64; 2] {
    let (screen, depth) = (640 - viewer[2], place[2] - viewer[2]);
    [0, 1].map(|i| {
        let step = (place[i] - viewer[i]).abs() * screen / depth;
        if place[i] < viewer[i] { viewer[i] - step } else { viewer[i] + step }
    })
}

/// C's screen of 640 x 480 units in our axes: x right, y up, z towards the viewer, from the screen's middle.
fn from_c([x, y, z]: [f64; 3]) -> V3 {
    [x - 320.0, 240.0 - y, 640.0 - z]
}

#[test]
fn system_c_s_numbers_give_system_c_s_pixels() {
    let screen = Screen::new(640.0, 480.0, 0.0).unwrap();
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    // C's start, its extremes, and 996 others.
    let mut viewers = vec![[320, 240, 0], [0, 0, 0], [639, 479, 639], [0, 479, 620]];
    while viewers.len() < EYES {
        viewers.push([640.0, 480.0, 620.0].map(|most| random.between(0.0, most) as i64));
    }
    // C's cube, and places all over C's world behind the screen.
    let mut places: Vec<[i64; 3]> = (0..8)
        .map(|k| {
            let pick = |bit: i64, low, high| if k & bit == 0 { low } else { high };
            [pick(1, 200, 440), pick(2, 120, 360), pick(4, 740, 980)]
        })
        .collect();
    places.extend((0..12).map(|_| {
        [(0.0, 639.0), (0.0, 479.0), (641.0, 1279.0)]
            .map(|(low, high)| random.between(low, high) as i64)
    }));
    let mut equal = 0;
    for viewer in viewers {
        let camera = screen.camera(from_c(viewer.map(|v| v as f64)), 0.5, 2000.0).unwrap();
        for place in &places {
            let ours = vertex(&camera, from_c(place.map(|v| v as f64)), [640, 480]);
            assert_eq!(ours.flags & CLIP, 0);
            let c = system_c(viewer, *place);
            for (i, ours) in [ours.x, ours.y].map(i64::from).into_iter().enumerate() {
                // C cuts off towards the viewer. Ours is the place itself, to 1/16 pixel; cut off likewise it is C's number,
                // unless the exact place lies that close to a whole one.
                let cut = if place[i] < viewer[i] { (ours + 15) >> 4 } else { ours >> 4 };
                equal += usize::from(cut == c[i]);
                let (low, high) =
                    if place[i] < viewer[i] { (c[i] - 1, c[i]) } else { (c[i], c[i] + 1) };
                assert!(
                    (16 * low..=16 * high).contains(&ours),
                    "viewer {viewer:?}, place {place:?}: {} and C's {}",
                    ours as f64 / 16.0,
                    c[i]
                );
            }
        }
    }
    println!(
        "system C: {equal} of 40000 coordinates are C's number, the others within 1/32 pixel of it"
    );
    assert!(equal > 38_000, "{equal}");
}
