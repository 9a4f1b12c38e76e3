//! `transform.sv` and `project.sv`, and the library's `transform`.

use scanout::math::Mat4;
use scanout::transform::{ClipMatrix, FAR, GUARD, NEAR, Viewport};
use scanout_cosim::{Model, Random, Stalls, Stream, exchange};

const NO_STALLS: Stalls = Stalls::NONE;
const STALLS: Stalls = Stalls { source: 30, sink: 30 };

fn short() -> bool {
    std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty())
}

fn count(usual: usize) -> usize {
    if short() { usual / 20 } else { usual }
}

fn random_position(random: &mut Random) -> [i16; 3] {
    [(); 3].map(|()| match random.below(6) {
        0 => i16::MIN,
        1 => i16::MAX,
        2 => 0,
        _ => random.u64() as i16,
    })
}

/// A matrix whose rows use all bits, or hardly any, or are the extremes of their range.
fn random_matrix(random: &mut Random) -> ClipMatrix {
    let size = f64::exp2(random.range(-20, 20) as f64);
    let mut unit = || random.range(-1_000_000, 1_000_000) as f64 * 1e-6;
    let mut m = [(); 4].map(|()| [(); 4].map(|()| unit() * size));
    match random.below(4) {
        0 => m[3] = [0.0, 0.0, 0.0, size],
        1 => m[0] = [0.0, -size, 0.0, 0.0],
        2 => m[3][3] = 2.0 * size,
        _ => {}
    }
    ClipMatrix::new(&Mat4::from_f64(m))
}

/// The four words of clip coordinates, in the order of the streams.
fn w_first([x, y, z, w]: [i32; 4]) -> [u64; 4] {
    [w, x, y, z].map(|v| u64::from(v as u32))
}

fn load(model: &mut Model, matrix: &ClipMatrix) {
    let [write, address, data, swap] =
        ["write", "write_address", "write_data", "swap"].map(|name| model.port(name));
    for (i, &word) in matrix.m.as_flattened().iter().enumerate() {
        model.set(write, 1);
        model.set(address, i as u64);
        model.set(data, word);
        model.clock();
    }
    model.set(write, 0);
    model.set(swap, 1);
    model.clock();
    model.set(swap, 0);
}

fn check_transform(name: &str) -> f64 {
    let mut model = Model::new(name);
    model.reset();
    let source = Stream::new(&model, "s", &["position", "tag"]);
    let sink = Stream::new(&model, "m", &["data", "tag"]);
    let mut random = Random::new(7);
    // The clocks that the last vertex' words take.
    let last_words = match name {
        "transform_1" => 22.0,
        "transform_3" => 7.0,
        _ => 4.0,
    };
    let mut clocks = 0.0;
    for round in 0..count(100) {
        let matrix = random_matrix(&mut random);
        load(&mut model, &matrix);
        let positions: Vec<[i16; 3]> = (0..100).map(|_| random_position(&mut random)).collect();
        let (mut words, mut expected) = (Vec::new(), Vec::new());
        for (tag, &p) in positions.iter().enumerate() {
            let word = p.iter().rev().fold(0, |word, &v| word << 16 | u64::from(v as u16));
            words.push(vec![word, tag as u64]);
            let words = w_first(matrix.apply(p));
            expected.extend(words.map(|word| vec![word, tag as u64]));
        }
        let stalls = if round % 2 == 0 { NO_STALLS } else { STALLS };
        let got = exchange(&mut model, &source, &words, &sink, 400, stalls, &mut random);
        for (i, p) in positions.iter().enumerate() {
            let words = 4 * i..4 * i + 4;
            assert_eq!(got.received[words.clone()], expected[words], "{name}: {p:?} {matrix:?}");
        }
        if round % 2 == 0 {
            // Between the first words of the first and the last vertex.
            clocks = (got.output_clocks as f64 - last_words) / 99.0;
        }
    }
    clocks
}

#[test]
fn clip_coordinates_are_the_librarys() {
    for (name, clocks) in [("transform_1", 28.0), ("transform_3", 8.0), ("transform_12", 5.0)] {
        assert_eq!(check_transform(name), clocks, "{name}: clocks a vertex");
    }
}

/// Clip coordinates of every size, on and beside the planes where flags change.
fn random_clip(random: &mut Random) -> [i32; 4] {
    let limit = (1 << 30) + 2;
    let bits = random.range(1, 30);
    let w = match random.below(8) {
        0 => random.range(-3, 3),
        1 => (1i64 << random.below(31)).min(limit),
        2 => ((1i64 << random.below(31)) - 1).min(limit),
        3 => random.range(-limit, limit),
        _ => random.range(1, 1 << bits),
    };
    let mut side = |bound: i64| match random.below(8) {
        0 => bound + random.range(-1, 1),
        1 => -bound + random.range(-1, 1),
        2 => random.range(-limit, limit),
        3 => 0,
        _ => random.range(-bound.abs(), bound.abs()),
    };
    let (near_x, wide_y) = (side(w), side(w << 13));
    let z = match random.below(6) {
        0 => random.range(-1, 1),
        1 => w + random.range(-1, 1),
        _ => random.range(0, w.max(1)),
    };
    [near_x, wide_y, z, w].map(|v| v.clamp(-limit, limit) as i32)
}

fn check_project(name: &str) {
    let depth = name == "project_depth";
    let mut model = Model::new(name);
    model.reset();
    let source = Stream::new(&model, "s", &["data", "tag"]);
    let sink = Stream::new(&model, "m", &["x", "y", "z", "inverse", "exponent", "flags", "tag"]);
    let (width_port, height_port) = (model.port("width"), model.port("height"));
    let mut random = Random::new(8);
    for (round, (width, height)) in
        [(640, 480), (320, 240), (1, 1), (4095, 4095), (333, 4095), (800, 600)]
            .into_iter()
            .enumerate()
    {
        model.set(width_port, width);
        model.set(height_port, height);
        let viewport = Viewport::new(width as u16, height as u16);
        let corners: Vec<[i32; 4]> = (0..count(4000)).map(|_| random_clip(&mut random)).collect();
        let words: Vec<Vec<u64>> = corners
            .iter()
            .enumerate()
            .flat_map(|(i, c)| w_first(*c).map(|word| vec![word, i as u64 & 0xff]))
            .collect();
        let stalls = if round % 2 == 0 { NO_STALLS } else { STALLS };
        let got = exchange(&mut model, &source, &words, &sink, corners.len(), stalls, &mut random);
        let mut projected = 0;
        for (i, (got, c)) in got.received.iter().zip(&corners).enumerate() {
            let v = viewport.project(c);
            let flag = |bit: u8| u64::from(v.flags & bit != 0);
            let flags = flag(NEAR) | flag(FAR) << 1 | flag(GUARD) << 2;
            assert_eq!(got[5..], [flags, i as u64 & 0xff], "{name}: flags and tag of {c:?}");
            if flags == 0 {
                projected += 1;
                let z = if depth { u64::from(v.z) } else { 0 };
                let wanted = [
                    u64::from(v.x as u32),
                    u64::from(v.y as u32),
                    z,
                    u64::from(v.inv_w),
                    u64::from(v.exponent()),
                ];
                assert_eq!(got[..5], wanted, "{name}: x y z inverse exponent of {c:?}");
            }
        }
        assert!(projected * 5 > corners.len(), "too few corners in view: {projected}");
    }
}

#[test]
fn screen_positions_are_the_librarys() {
    check_project("project");
    check_project("project_depth");
}

#[test]
fn clocks_of_a_vertex_in_view() {
    for (name, expected) in [("project", 79), ("project_depth", 98)] {
        let mut model = Model::new(name);
        model.reset();
        let (width, height) = (model.port("width"), model.port("height"));
        model.set(width, 640);
        model.set(height, 480);
        let source = Stream::new(&model, "s", &["data", "tag"]);
        let sink = Stream::new(&model, "m", &["x", "y"]);
        // lz = 2: a camera whose w row uses all bits.
        let words =
            vec![
                vec![vec![(1 << 29) + 12345, 0], vec![1000, 0], vec![2000, 0], vec![3000, 0]];
                101
            ]
            .concat();
        let mut random = Random::new(1);
        let got = exchange(&mut model, &source, &words, &sink, 101, NO_STALLS, &mut random);
        assert_eq!((got.output_clocks - 1) / 100, expected, "{name}: clocks a vertex with lz 2");
    }
}
