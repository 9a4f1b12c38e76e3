//! `time` with an optional number of ROUNDS: times of scanout and of its peers, side by side in one run, as ratios.
//!
//! Every contestant of a group draws one frame in turn, ROUNDS times (default 200; fewer for large frames); the median
//! and the minimum count. Times of different runs or machines say nothing; the ratios within one do.

use std::env;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use scanout::output::{PixelFormat, Rgb565, widen565};
use scanout::raster::line::fill_cells;
use scanout_benches::lines::{self, CLIP, HEIGHT, Line, WIDTH};
use scanout_benches::peers::{Drawer, Embedded, EmbeddedGraphics, Euc, Retrofire, TinySkia};
use scanout_benches::scenes::{BACKGROUND, Case, Data};

type Contestant<'a> = (&'static str, Box<dyn FnMut() + 'a>);

fn main() -> ExitCode {
    let rounds = match env::args().nth(1).map(|s| s.parse()) {
        None => 200,
        Some(Ok(rounds)) if rounds > 0 => rounds,
        _ => {
            eprintln!("usage: time [ROUNDS]");
            return ExitCode::from(2);
        }
    };
    // embedded-3dgfx makes its list of commands on the stack before it is boxed.
    let run = std::thread::Builder::new().stack_size(256 << 20).spawn(move || run(rounds));
    match run.map(std::thread::JoinHandle::join) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

fn run(rounds: usize) {
    println!("| case | against | medians | minima |");
    println!("|---|---|---:|---:|");
    for (triangles, size) in [(400, [320, 240]), (5_000, [320, 240]), (70_000, [640, 480])] {
        let rounds = if triangles == 70_000 { rounds.div_ceil(5) } else { rounds };
        for look in ["flat", "gouraud", "textured", "wire"] {
            spheres(triangles, size, look, rounds);
        }
    }
    line_set("1,000 long lines", &lines::long(), rounds);
    line_set("1,000 short lines", &lines::short(), rounds);
}

/// scanout with one thread, and the peers that draw spheres so.
fn spheres(triangles: usize, size: [u16; 2], look: &str, rounds: usize) {
    let name = format!("{triangles}:{look}:{}x{}", size[0], size[1]);
    let data = Data::new(Case::parse(&name).expect("a case")).expect("a sphere");
    let mut peers: Vec<(&str, Box<dyn Drawer>)> = Vec::new();
    match look {
        "flat" => {
            peers.push(("embedded-3dgfx 0.7", Box::new(Embedded::new(triangles, size, false))));
        }
        "gouraud" => {
            peers.push(("embedded-3dgfx 0.7", Box::new(Embedded::new(triangles, size, true))));
            peers.push(("euc 0.5", Box::new(Euc::new(triangles, size))));
            peers.push(("retrofire-core 0.4", Box::new(Retrofire::new(triangles, size))));
        }
        _ => {}
    }
    for (_, drawer) in &mut peers {
        drawer.draw();
    }
    data.with(|scene, settings, memory| {
        memory.draw(scene, settings);
        for (peer, drawer) in &peers {
            compare(&name, peer, &memory.colour, &drawer.picture(), BACKGROUND);
        }
        let mut contestants: Vec<Contestant> =
            vec![("one thread", Box::new(|| memory.draw(black_box(scene), settings)))];
        for (peer, drawer) in &mut peers {
            contestants.push((peer, Box::new(|| drawer.draw())));
        }
        report(&name, contestants, rounds);
    });
}

/// Says on standard error how a peer's picture differs from ours: pixels drawn, and the mean difference of a channel.
fn compare(name: &str, peer: &str, ours: &[u16], theirs: &[u16], background: [u8; 3]) {
    let clear = Rgb565::encode(background);
    let [mine, other] = [(ours, clear), (theirs, 0)]
        .map(|(picture, clear)| picture.iter().filter(|&&p| p != clear).count());
    let both = ours.iter().zip(theirs).filter(|&(&a, &b)| a != clear && b != 0);
    let difference = |(a, b): (&u16, &u16)| {
        let (a, b) = (widen565(*a), widen565(*b));
        a.iter().zip(b).map(|(&a, b)| u64::from(a.abs_diff(b))).sum::<u64>()
    };
    let sum: u64 = both.map(difference).sum();
    let mean = sum as f64 / 3.0 / mine.max(1) as f64;
    eprintln!("{name}: {peer} draws {other} pixels, scanout {mine}; mean difference {mean:.1}");
}

/// One-coloured lines.
fn line_set(name: &str, lines: &[Line], rounds: usize) {
    let mut cells = vec![0u16; WIDTH as usize * HEIGHT as usize];
    let mut embedded = EmbeddedGraphics::new(lines.to_vec());
    let mut skia = TinySkia::new(lines.to_vec());
    let draw = |cells: &mut Vec<u16>| {
        for [a, b] in black_box(lines) {
            fill_cells(cells, WIDTH.into(), CLIP, a, b, Rgb565::encode(a.rgb));
        }
        black_box(cells);
    };
    draw(&mut cells);
    embedded.draw();
    skia.draw();
    compare(name, "embedded-graphics", &cells, &embedded.picture(), [0; 3]);
    compare(name, "tiny-skia", &cells, &skia.picture(), [0; 3]);
    let contestants: Vec<Contestant> = vec![
        ("one thread", Box::new(|| draw(&mut cells))),
        ("embedded-graphics 0.8", Box::new(|| embedded.draw())),
        ("tiny-skia 0.12", Box::new(|| skia.draw())),
    ];
    report(name, contestants, rounds);
}

/// Measures in turn and prints the first one's median and minimum divided by each other one's.
fn report(name: &str, mut contestants: Vec<Contestant>, rounds: usize) {
    let mut times = vec![Vec::with_capacity(rounds); contestants.len()];
    for _ in 0..rounds {
        for ((_, draw), times) in contestants.iter_mut().zip(&mut times) {
            let start = Instant::now();
            draw();
            times.push(start.elapsed().as_nanos());
        }
    }
    times.iter_mut().for_each(|times| times.sort_unstable());
    let ratio = |i: usize, at: usize| times[0][at] as f64 / times[i][at] as f64;
    for (i, (other, _)) in contestants.iter().enumerate().skip(1) {
        println!("| {name} | {other} | {:.2} | {:.2} |", ratio(i, rounds / 2), ratio(i, 0));
    }
}
