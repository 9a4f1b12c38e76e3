//! `scanout bench`: how fast this machine draws, and whether it draws the same pixels.
//!
//! Each case is drawn again and again for a while, with each number of threads in turn, so that a slow moment of the
//! machine hits all of them. A frame is everything that repeats: clear, transform, light, cull and drawing all rows,
//! RGB565 colour and 16-bit depth; loading and allocating are done before. The scenes are those of the crate
//! `scanout-bench`, whose instructions `benches/instructions.py` counts.

mod cases;
mod table;

use std::cell::RefCell;
use std::hint::black_box;
use std::time::{Duration, Instant};

use scanout::frame::Part;
use scanout::hash::FrameHash;
use scanout::output::{PixelFormat, Rgb565};
use scanout::raster::line::fill_cells;
use scanout_bench::lines::{CLIP, COUNT, HEIGHT, Line, WIDTH};
use scanout_bench::scenes::Data;

use self::cases::{Case, Content};
use self::table::Table;
use crate::args::BenchArgs;
use crate::draw::{Threads, processors};
use crate::error::{Error, Result};
use crate::narrate;

/// The end of `scanout bench --help`.
pub const EXPLANATION: &str = "Times are those of one frame, or of 1,000 lines: the minimum and the median of all \
runs; rates and speed-up (against the first number of threads) are of the minimum. Times of different machines or \
moments can't be compared to the percent; close other programs. 'same' after the hash means: these are the pixels \
that every machine draws. 'fill' draws eight sheets over the whole picture, and all their pixels count.\n\n\
Examples:\n  \
scanout bench --cases gouraud,lines --time 2\n  \
scanout bench --model dragon.ply --cases dragon --threads 1,2\n  \
scanout bench --cases 5000:phong:800x600 --json";

/// The least runs of a case that make a median.
const LEAST_RUNS: usize = 3;

/// What was measured of a case with one number of threads.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Threads that drew.
    pub threads: usize,
    /// Times of all runs, ascending.
    pub times: Vec<Duration>,
    /// The shortest time with the first number of threads, as a multiple of this one's.
    pub speed_up: f64,
}

impl Measured {
    fn minimum(&self) -> Duration {
        self.times[0]
    }

    fn median(&self) -> Duration {
        self.times[self.times.len() / 2]
    }
}

/// Measures and prints.
pub fn run(args: &BenchArgs) -> Result<()> {
    let threads = threads(&args.threads);
    let cases = cases::chosen(&args.cases, &args.model)?;
    if cfg!(debug_assertions) {
        narrate!("scanout: this is a debug build, many times slower; build with --release");
    }
    let mut table = Table::new(args.json, &cases);
    let mut other = Vec::new();
    for case in &cases {
        let (hash, measured) = measure(case, &threads, Duration::from_secs_f64(args.time))?;
        if case.expected().is_some_and(|expected| expected != hash) {
            other.push(case.name.as_str());
        }
        table.add(case, hash, &measured)?;
    }
    table.finish()?;
    if other.is_empty() {
        return Ok(());
    }
    Err(Error::failed(
        other.join(", "),
        "this machine draws other pixels than every other",
        "please report it with the output of 'scanout bench --json'",
    ))
}

/// The numbers of threads: those asked for, else one, two, and one a processor.
fn threads(asked: &[u16]) -> Vec<usize> {
    if !asked.is_empty() {
        return asked.iter().map(|&threads| threads.into()).collect();
    }
    let most = processors();
    let mut threads = vec![1, 2.min(most), most];
    threads.dedup();
    threads
}

/// The frame's hash, and the times with each number of threads.
fn measure(case: &Case, threads: &[usize], time: Duration) -> Result<(u64, Vec<Measured>)> {
    match &case.content {
        Content::Frame(data) => measure_frames(&case.name, data, threads, time),
        Content::Lines(lines) => {
            let mut cells = vec![0; usize::from(WIDTH) * usize::from(HEIGHT)];
            draw_lines(lines, &mut cells);
            let hash = hash(&cells, [WIDTH, HEIGHT]);
            let mut draw = || draw_lines(black_box(lines), black_box(&mut cells));
            Ok((hash, timed(&mut [(1, &mut draw)], time)))
        }
    }
}

fn measure_frames(
    name: &str,
    data: &Data,
    threads: &[usize],
    time: Duration,
) -> Result<(u64, Vec<Measured>)> {
    data.with(|scene, settings, memory| {
        let size = [settings.width, settings.height];
        let mut hashes = Vec::new();
        // One set of memory for all: what lies in the cache afterwards is the same for each.
        let memory = RefCell::new(memory);
        let draw = |count: usize, parts: &mut [Part]| {
            let threads = Threads::get(count);
            let memory = &mut **memory.borrow_mut();
            let (store, colour, depth) = memory.all();
            let frame = threads
                .prepare(black_box(scene), settings, store, parts)
                .expect("a scene that can be drawn");
            let bands = threads.bands(&frame);
            threads.draw::<Rgb565>(&frame, &bands, colour, depth).expect("memory for all rows");
        };
        // The most first, for nobody gets more later.
        Threads::get(threads.iter().copied().max().unwrap_or(1));
        let mut parts: Vec<_> =
            threads.iter().map(|&count| (count, Threads::get(count).parts(scene))).collect();
        for (count, parts) in &mut parts {
            draw(*count, parts);
            hashes.push(hash(&memory.borrow().colour, size));
        }
        if hashes.iter().any(|&hash| hash != hashes[0]) {
            let what = "threads changed the picture";
            return Err(Error::failed(name, what, "please report this fault of scanout"));
        }
        let draw = &draw;
        let mut draws: Vec<_> =
            parts.iter_mut().map(|(count, parts)| move || draw(*count, parts)).collect();
        let mut contestants: Vec<(usize, &mut dyn FnMut())> = Vec::new();
        for (&threads, draw) in threads.iter().zip(&mut draws) {
            contestants.push((threads, draw));
        }
        Ok((hashes[0], timed(&mut contestants, time)))
    })
}

fn draw_lines(lines: &[Line], cells: &mut [u16]) {
    for [a, b] in lines {
        fill_cells(cells, WIDTH.into(), CLIP, a, b, Rgb565::encode(a.rgb));
    }
}

fn hash(colour: &[u16], [width, height]: [u16; 2]) -> u64 {
    let mut hash = FrameHash::new(width, height, Rgb565::ID);
    Rgb565::bytes(colour, colour.len(), &mut |bytes| hash.update(bytes));
    hash.finish()
}

/// Runs the contestants in turn until each has had its time.
fn timed(contestants: &mut [(usize, &mut dyn FnMut())], time: Duration) -> Vec<Measured> {
    let mut times = vec![Vec::new(); contestants.len()];
    let start = Instant::now();
    let all = time * contestants.len() as u32;
    while start.elapsed() < all || times[0].len() < LEAST_RUNS {
        for ((_, draw), times) in contestants.iter_mut().zip(&mut times) {
            let start = Instant::now();
            draw();
            times.push(start.elapsed());
        }
    }
    times.iter_mut().for_each(|times| times.sort_unstable());
    let first = times[0][0].as_secs_f64();
    let measured = |(times, (threads, _)): (Vec<Duration>, &(usize, _))| {
        let speed_up = first / times[0].as_secs_f64().max(1e-9);
        Measured { threads: *threads, times, speed_up }
    };
    times.into_iter().zip(&*contestants).map(measured).collect()
}

/// Lines in a set, for the table.
const LINES: usize = COUNT;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimum_median_and_speed_up() {
        let mut order = Vec::new();
        let log = RefCell::new(&mut order);
        let mut one = || log.borrow_mut().push(1);
        let mut two = || {
            log.borrow_mut().push(2);
            std::thread::sleep(Duration::from_millis(2));
        };
        let measured = timed(&mut [(1, &mut one), (2, &mut two)], Duration::ZERO);
        assert_eq!(order, [1, 2, 1, 2, 1, 2], "in turn, at least {LEAST_RUNS} times");
        assert_eq!(measured.iter().map(|m| m.threads).collect::<Vec<_>>(), [1, 2]);
        assert!(measured[1].minimum() >= Duration::from_millis(2));
        assert!(measured[1].median() >= measured[1].minimum());
        assert!((measured[0].speed_up - 1.0).abs() < 1e-9 && measured[1].speed_up < 1.0);
    }

    #[test]
    fn threads_without_a_choice_begin_with_one() {
        assert_eq!(threads(&[3, 1]), [3, 1]);
        let threads = threads(&[]);
        assert!(threads[0] == 1 && threads.windows(2).all(|pair| pair[0] < pair[1]), "{threads:?}");
    }
}
