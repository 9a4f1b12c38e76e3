//! `clip.sv` and the library's `clip::line`.

use scanout::clip::{Corner, line};
use scanout_cosim::{Model, Random, Stalls, Stream, exchange};

const LIMIT: i64 = (1 << 30) + 2;

fn count(usual: usize) -> usize {
    if std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty()) {
        usual / 50
    } else {
        usual
    }
}

/// Clip coordinates of an end: in view, beside a plane, or anywhere.
fn random_end(random: &mut Random) -> [i32; 4] {
    let bits = random.range(4, 30);
    let w = match random.below(8) {
        0 => random.range(-2, 2),
        1 => random.range(-(1 << bits), 0),
        _ => random.range(1, 1 << bits),
    };
    let mut side = |reach: i64| match random.below(10) {
        0 => random.range(-LIMIT, LIMIT),
        1 => reach + random.range(-1, 1),
        2 => -reach + random.range(-1, 1),
        _ => random.range(-reach.abs(), reach.abs()),
    };
    let (x, y, z) = (side(w << 13), side(w << 13), side(w));
    [x, y, z, w].map(|v| v.clamp(-LIMIT, LIMIT) as i32)
}

fn words([x, y, z, w]: [i32; 4]) -> [u64; 4] {
    [w, x, y, z].map(|v| u64::from(v as u32))
}

#[test]
fn clipped_ends_are_the_librarys() {
    let mut random = Random::new(4);
    let (mut sent, mut wanted) = (Vec::new(), Vec::new());
    let (mut whole, mut cut, mut gone) = (0, 0, 0);
    for _ in 0..count(5000) {
        let ends = [random_end(&mut random), random_end(&mut random)];
        sent.extend(ends.map(words).as_flattened().iter().map(|&v| vec![v]));
        let corner = |clip| Corner { clip, ..Corner::default() };
        match line(corner(ends[0]), corner(ends[1])) {
            Some(left) => {
                let left = left.map(|corner| corner.clip);
                if left == ends {
                    whole += 1
                } else {
                    cut += 1
                }
                wanted.extend(left.map(words).as_flattened().iter().map(|&v| vec![v]));
            }
            None => gone += 1,
        }
    }
    let enough = count(200);
    assert!(
        whole > enough && cut > enough && gone > enough,
        "{whole} whole, {cut} cut, {gone} gone"
    );
    for stalls in [Stalls::NONE, Stalls { source: 30, sink: 30 }] {
        let mut model = Model::new("clip");
        model.reset();
        let source = Stream::new(&model, "s", &["data"]);
        let sink = Stream::new(&model, "m", &["data"]);
        let got = exchange(&mut model, &source, &sent, &sink, wanted.len(), stalls, &mut random);
        for (i, (got, wanted)) in got.received.iter().zip(&wanted).enumerate() {
            assert_eq!(
                got,
                wanted,
                "line {} of those left, word {} of w x y z w x y z",
                i / 8,
                i % 8
            );
        }
    }
}
