//! `line.sv` and the library's `raster::line`, pixel by pixel.

use scanout::raster::line::{ClipRect, LineEnd, walk};
use scanout_cosim::{Exchange, Model, Random, Stalls, Stream, exchange};

const EVERYWHERE: ClipRect = ClipRect { x0: i32::MIN, y0: i32::MIN, x1: i32::MAX, y1: i32::MAX };

/// Columns and rows of the configurations: 12 bits with a sign.
const FARTHEST: i64 = 2047;

fn end(x: i64, y: i64, rgb: [u8; 3]) -> LineEnd {
    LineEnd { x: x as i32, y: y as i32, z: 0, rgb }
}

/// One in this many of the usual number, for netlists.
fn count(usual: usize) -> usize {
    if std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty()) {
        usual / 50
    } else {
        usual
    }
}

fn pack(rgb: [u8; 3]) -> u64 {
    rgb.iter().fold(0, |word, &c| word << 8 | u64::from(c))
}

/// What the model must give: column, row, colour, last.
fn expected(lines: &[[LineEnd; 2]], colour: bool) -> Vec<Vec<u64>> {
    let mut pixels = Vec::new();
    for [a, b] in lines {
        walk(a, b, EVERYWHERE, |x, y, _, rgb| {
            let twelve = |v: i32| v as u64 & 0xfff;
            pixels.push(vec![twelve(x), twelve(y), if colour { pack(rgb) } else { 0 }, 0]);
        });
        pixels.last_mut().expect("a line has a pixel")[3] = 1;
    }
    pixels
}

fn draw(name: &str, lines: &[[LineEnd; 2]], stalls: Stalls, seed: u64) -> Exchange {
    let mut model = Model::new(name);
    model.reset();
    let ends = ["a_x", "a_y", "b_x", "b_y", "a_rgb", "b_rgb"];
    let source = Stream::new(&model, "s", &ends);
    let sink = Stream::new(&model, "m", &["x", "y", "rgb", "last"]);
    let words: Vec<Vec<u64>> = lines
        .iter()
        .map(|[a, b]| {
            vec![a.x as u64, a.y as u64, b.x as u64, b.y as u64, pack(a.rgb), pack(b.rgb)]
        })
        .collect();
    let wanted = expected(lines, name == "line_rgb");
    let mut random = Random::new(seed);
    let got = exchange(&mut model, &source, &words, &sink, wanted.len(), stalls, &mut random);
    for (i, (got, wanted)) in got.received.iter().zip(&wanted).enumerate() {
        assert_eq!(got, wanted, "{name}: pixel {i} of [x, y, rgb, last]");
    }
    got
}

fn random_line(random: &mut Random, size: i64) -> [LineEnd; 2] {
    let mut colour = || {
        // The extremes as often as all others.
        [(); 3].map(|()| match random.below(4) {
            0 => 0,
            1 => 255,
            _ => random.below(256) as u8,
        })
    };
    let rgb = [colour(), colour()];
    let mut place = || random.range(-size, size);
    let (x, y) = (place(), place());
    let (dx, dy) = (place(), place());
    let far = |v: i64| v.clamp(-FARTHEST - 1, FARTHEST);
    [end(x, y, rgb[0]), end(far(x + dx), far(y + dy), rgb[1])]
}

fn random_lines(number: usize, seed: u64) -> Vec<[LineEnd; 2]> {
    let mut random = Random::new(seed);
    (0..number)
        .map(|i| {
            // Mostly short ones, as in meshes; some across the whole range.
            let size = [2, 8, 30, 100, 300, FARTHEST][if i % 64 == 5 { 5 } else { i % 5 }];
            random_line(&mut random, size)
        })
        .collect()
}

#[test]
fn twenty_thousand_random_lines_with_stalls() {
    for name in ["line_flat", "line_rgb"] {
        for (part, stalls) in [(0, 0), (0, 40), (60, 0), (30, 30)]
            .map(|(source, sink)| Stalls { source, sink })
            .into_iter()
            .enumerate()
        {
            let lines = random_lines(count(6000), part as u64 + 10);
            draw(name, &lines, stalls, part as u64);
        }
    }
}

#[test]
fn a_pixel_every_clock_whatever_the_lengths() {
    let mut random = Random::new(5);
    // Points, lines of two pixels, and everything beside one another.
    for (sizes, number) in
        [([0, 0, 0], 500), ([0, 1, 2], 3000), ([1, 1, 5], 3000), ([3, 0, 900], 600)]
    {
        let lines: Vec<[LineEnd; 2]> = (0..count(number))
            .map(|_| {
                let size = sizes[random.below(3) as usize];
                random_line(&mut random, size)
            })
            .collect();
        for name in ["line_flat", "line_rgb"] {
            let got = draw(name, &lines, Stalls::NONE, 0);
            assert_eq!(got.output_clocks, got.received.len() as u64, "{name}, lines of {sizes:?}");
        }
    }
}

/// Every slope of every length up to 24, and every colour difference over every length up to 64.
#[test]
fn every_slope_and_every_colour_difference() {
    let mut lines = Vec::new();
    for dx in -24..=24 {
        for dy in -24..=24 {
            lines.push([end(3, -5, [10, 20, 30]), end(3 + dx, -5 + dy, [200, 0, 31])]);
        }
    }
    let lengths = if count(50) == 50 { 64 } else { 3 };
    for n in (1..=lengths).chain([127, 128, 129, 255, 256, 257, 511, 513, 1023, 1025, 2047, 4095]) {
        if n > 300 && count(50) < 50 {
            break;
        }
        for d in (0..=255).step_by(if n > 64 { 51 } else { 1 }) {
            let (from, to) = (end(-2048, 0, [0, d, 255]), end(n - 2048, n / 3, [d, 0, 255 - d]));
            lines.push([from, to]);
        }
    }
    draw("line_flat", &lines, Stalls::NONE, 1);
    draw("line_rgb", &lines, Stalls::NONE, 1);
}

/// System D's test: a line in each octant and on each border between octants, red to blue.
#[test]
fn the_sixteen_lines_of_system_d() {
    const RED: [u8; 3] = [255, 0, 0];
    const BLUE: [u8; 3] = [0, 0, 255];
    let ends = [(9, 0), (9, 4), (9, 9), (4, 9), (0, 9), (-4, 9), (-9, 9), (-9, 4)];
    let lines: Vec<[LineEnd; 2]> = ends
        .into_iter()
        .flat_map(|(x, y)| [(x, y), (-x, -y)])
        .map(|(x, y)| [end(20, 20, RED), end(20 + x, 20 + y, BLUE)])
        .collect();
    let got = draw("line_rgb", &lines, Stalls::NONE, 2);
    let mut table = String::new();
    for pixel in &got.received {
        let [x, y, rgb, last] = pixel[..] else { unreachable!() };
        table += &format!("{x},{y} {rgb:06x}{}", if last == 1 { "\n" } else { "  " });
    }
    let golden = include_str!("sixteen_lines.txt");
    assert!(table == golden, "got\n{table}\nexpected\n{golden}");
}

#[test]
fn of_ends_on_one_pixel_the_darker_is_drawn() {
    let a = end(5, -7, [1, 255, 0]);
    let b = end(5, -7, [2, 0, 0]);
    draw("line_rgb", &[[a, b], [b, a]], Stalls::NONE, 3);
}
