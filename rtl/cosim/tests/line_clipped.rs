//! `line_clipped.sv` and the library's clipped walk; `clip_alu.sv` and a division.

use scanout::raster::line::{ClipRect, LineEnd, walk_with};
use scanout_cosim::{Model, Random, Stalls, Stream, exchange};

fn count(usual: usize) -> usize {
    if std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty()) {
        usual / 20
    } else {
        usual
    }
}

#[test]
fn a_product_divided() {
    let mut model = Model::new("clip_alu");
    let controls = ["load", "accumulate", "twice", "use_word", "invert", "carry", "quotient"]
        .into_iter()
        .chain(["use_input", "divide", "shift", "run", "prepare"])
        .map(|name| model.port(name))
        .collect::<Vec<_>>();
    let [load, quotient, use_input, use_word, divide, run, prepare, s_data, word, other, last, r] =
        [
            "load",
            "quotient",
            "use_input",
            "use_word",
            "divide",
            "run",
            "prepare",
            "s_data",
            "word",
            "other",
            "last",
            "accumulator",
        ]
        .map(|name| model.port(name));
    let mut random = Random::new(1);
    for i in 0..count(4000) {
        let bits = random.range(1, 14);
        let divisor = random.range(1, (1 << bits) - 1).max(1) as u64;
        let factor = match i % 4 {
            0 => 0,
            1 => divisor,
            _ => random.below(divisor + 1),
        };
        let number = random.below(1 << 12);
        // One clock to prepare, then an operation with these controls until its last clock.
        let operation = |model: &mut Model, on: &[scanout_cosim::Port]| {
            for &port in &controls {
                model.set(port, u64::from(on.contains(&port)));
            }
            model.set(prepare, 1);
            model.set(word, divisor);
            model.clock();
            model.set(prepare, 0);
            model.set(run, 1);
            for _ in 0..=3 * 12 {
                model.eval();
                let (ends, next) = (model.get(last) == 1, model.get(other) == 1);
                model.clock();
                model.set(word, if next { factor } else { divisor });
                if ends {
                    model.set(run, 0);
                    return;
                }
            }
            panic!("{number} {factor} / {divisor}: no end");
        };
        model.set(s_data, number);
        operation(&mut model, &[load, use_input]);
        operation(&mut model, &[divide, use_word]);
        let product = number * factor;
        assert_eq!(model.get(r), product % divisor, "{number} {factor} / {divisor}: rest");
        // The rest is not negative: the quotient comes out with one added.
        operation(&mut model, &[load, quotient]);
        assert_eq!(model.get(r), product / divisor + 1, "{number} {factor} / {divisor}");
    }
}

fn end(x: i64, y: i64) -> LineEnd {
    LineEnd { x: x as i32, y: y as i32, ..LineEnd::default() }
}

/// Columns and rows: 23 bits with a sign.
const FARTHEST: i64 = (1 << 22) - 1;

fn random_line(random: &mut Random, [width, height]: [i64; 2]) -> [LineEnd; 2] {
    let reach = [0, 3, 20, 700, 40_000, FARTHEST][random.below(6) as usize];
    let mut place = |size: i64| {
        let v = match random.below(8) {
            // On the border and just beside it.
            0 => random.range(-1, 1),
            1 => size - 1 + random.range(-1, 1),
            _ => random.range(-reach, size - 1 + reach),
        };
        v.clamp(-FARTHEST - 1, FARTHEST)
    };
    [end(place(width), place(height)), end(place(width), place(height))]
}

#[test]
fn visible_pixels_never_move() {
    let mut model = Model::new("line_clipped");
    model.reset();
    let source = Stream::new(&model, "s", &["a_x", "a_y", "b_x", "b_y", "on_screen"]);
    let sink = Stream::new(&model, "m", &["x", "y", "last"]);
    let (width_port, height_port) = (model.port("width"), model.port("height"));
    let mut random = Random::new(9);
    for (round, size) in
        [[640, 480], [320, 240], [1024, 1024], [1, 1], [5, 3], [7, 1000]].into_iter().enumerate()
    {
        // The last line may still be on its way to vanishing.
        let busy = model.port("busy");
        while model.get(busy) == 1 {
            model.clock();
        }
        model.set(width_port, size[0]);
        model.set(height_port, size[1]);
        let clip = ClipRect { x0: 0, y0: 0, x1: size[0] as i32, y1: size[1] as i32 };
        let lines: Vec<_> = (0..count(4000)).map(|_| random_line(&mut random, size)).collect();
        let mut expected = Vec::new();
        let mut cut = 0;
        for [a, b] in &lines {
            let before = expected.len();
            walk_with::<false, false>(a, b, clip, |x, y, _, _| {
                expected.push(vec![x as u64, y as u64, 0]);
            });
            if expected.len() > before {
                expected.last_mut().expect("not empty")[2] = 1;
                cut += u32::from(!clip.contains(a.x, a.y) || !clip.contains(b.x, b.y));
            }
        }
        assert!(cut > count(100) as u32, "only {cut} lines cross the border");
        let words: Vec<Vec<u64>> = lines
            .iter()
            .map(|[a, b]| {
                let on_screen = clip.contains(a.x, a.y) && clip.contains(b.x, b.y);
                [a.x, a.y, b.x, b.y, i32::from(on_screen)].map(|v| v as u64).to_vec()
            })
            .collect();
        let stalls = Stalls { source: 20 * (round as u64 % 2), sink: 30 * (round as u64 / 2 % 2) };
        let got = exchange(&mut model, &source, &words, &sink, expected.len(), stalls, &mut random);
        assert!(got.received == expected, "{size:?}: pixels differ");
    }
}
