//! `stereo_place.sv` and `stereo_mix.sv`: each place and each mixture is the library's.

use scanout_cosim::{Model, Random};
use scanout_head::stereo::{Arrangement, Place, mix};

type Rgb = [u8; 3];

fn pack([r, g, b]: Rgb) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

/// Codes of the anaglyphs.
const ANAGLYPHS: [(u32, Arrangement); 4] = [
    (1, Arrangement::Anaglyph),
    (5, Arrangement::AnaglyphGrey),
    (6, Arrangement::AnaglyphHalfColour),
    (7, Arrangement::AnaglyphDubois),
];

/// What a pixel is made of.
struct Case {
    code: u32,
    right: bool,
    left_rgb: Rgb,
    right_rgb: Rgb,
    /// Whether the eyes' pixels are drawn, left and right.
    set: [bool; 2],
    under: Rgb,
}

/// The mixer's channels: those that are drawn, and red, green, blue.
fn mixed(model: &mut Model, case: &Case) -> (u64, Rgb) {
    let ports =
        ["arrangement", "s_right", "s_left_set", "s_right_set"].map(|name| model.port(name));
    let values = [case.code, case.right.into(), case.set[0].into(), case.set[1].into()];
    for (port, value) in ports.into_iter().zip(values) {
        model.set(port, value);
    }
    let ports = ["s_left_rgb", "s_right_rgb", "s_under_rgb"].map(|name| model.port(name));
    for (port, rgb) in ports.into_iter().zip([case.left_rgb, case.right_rgb, case.under]) {
        model.set(port, pack(rgb));
    }
    model.eval();
    let [_, r, g, b] = (model.get(model.port("m_rgb")) as u32).to_be_bytes();
    (model.get(model.port("m_set")), [r, g, b])
}

fn any(random: &mut Random) -> Rgb {
    // Extremes often: that is where sums overflow.
    [0; 3].map(|_: u8| match random.below(4) {
        0 => 0,
        1 => 255,
        _ => random.below(256) as u8,
    })
}

fn cases(seed: u64, codes: u64) -> impl Iterator<Item = Case> {
    let mut random = Random::new(seed);
    let count = if std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty()) {
        4000
    } else {
        60_000
    };
    (0..count).map(move |_| Case {
        code: random.below(codes) as u32,
        right: random.below(2) == 1,
        left_rgb: any(&mut random),
        right_rgb: any(&mut random),
        set: [0; 2].map(|_: u8| random.below(3) > 0),
        under: any(&mut random),
    })
}

/// What the library makes of two eyes' pixels.
fn wanted(case: &Case, left: Rgb, right: Rgb) -> Rgb {
    match ANAGLYPHS.iter().find(|(code, _)| *code == case.code) {
        Some((_, how)) => mix(&how.coefficients().expect("an anaglyph has weights"), left, right),
        None if case.right => right,
        None => left,
    }
}

#[test]
fn channels_are_one_eyes_each() {
    let mut model = Model::new("stereo_mix_1");
    for case in cases(1, 4) {
        let (set, rgb) = mixed(&mut model, &case);
        // What is drawn, channel by channel, and nothing where nothing is.
        assert_eq!(rgb, wanted(&case, case.left_rgb, case.right_rgb), "code {}", case.code);
        let drawn = wanted(&case, [case.set[0].into(); 3], [case.set[1].into(); 3]);
        let bits = drawn.iter().fold(0, |bits, &bit| bits << 1 | u64::from(bit));
        assert_eq!(set, bits, "code {}", case.code);
    }
}

#[test]
fn every_mixture_is_the_librarys() {
    for (name, dubois) in [("stereo_mix_2", false), ("stereo_mix_3", true)] {
        let mut model = Model::new(name);
        for case in cases(2, 8) {
            // Without Dubois' weights that code is half colour.
            let known = Case { code: if dubois { case.code } else { case.code.min(6) }, ..case };
            let filled = |set, rgb| if set { rgb } else { case.under };
            let left = filled(case.set[0], case.left_rgb);
            let right = filled(case.set[1], case.right_rgb);
            let (set, rgb) = mixed(&mut model, &case);
            assert_eq!(
                rgb,
                wanted(&known, left, right),
                "{name}: code {}, {left:?} {right:?}",
                case.code
            );
            assert_eq!(set, 7);
        }
    }
}

#[test]
fn every_place_is_the_librarys() {
    const SIZE: (usize, usize) = (45, 35);
    let halves = [
        (2, Arrangement::SideBySide),
        (2, Arrangement::SideBySideHalf),
        (3, Arrangement::Interlaced),
        (4, Arrangement::TopBottom),
        (4, Arrangement::TopBottomHalf),
    ];
    let mut model = Model::new("stereo_place");
    let inputs = ["arrangement", "s_x", "s_y"].map(|name| model.port(name));
    let outputs = ["m_x", "m_y", "m_right"].map(|name| model.port(name));
    let mut seen = [false; 9];
    for (code, how) in halves.into_iter().chain(ANAGLYPHS) {
        seen[Arrangement::ALL.iter().position(|&each| each == how).expect("one of all")] = true;
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                for (port, value) in inputs.into_iter().zip([code, x as u32, y as u32]) {
                    model.set(port, value);
                }
                model.eval();
                let got = outputs.map(|port| model.get(port) as usize);
                let wanted = match how.place(SIZE.0, SIZE.1, x, y) {
                    Place::Both => [x, y, 0],
                    Place::Left { x, y } => [x, y, 0],
                    Place::Right { x, y } => [x, y, 1],
                };
                assert_eq!(got, wanted, "{how:?} at {x}, {y}");
            }
        }
    }
    assert_eq!(seen, [true; 9]);
}
