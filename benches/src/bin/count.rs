//! `count CASE FRAMES`: prepares everything, then draws the frame FRAMES times: what `instructions.py` runs in valgrind.
//!
//! A case is `SOURCE:LOOK:WIDTHxHEIGHT` (see `scenes::Case`), with a prefix `prepare:` to stop before drawing or `scalar:` to draw
//! pixel by pixel, or
//! `lines:long|short:KIND`, which draws a thousand lines a frame:
//!
//! | kind | what is drawn |
//! |---|---|
//! | `fill` | RGB565 words of one value, `Field::line` |
//! | `flat` | the same through `walk_cells` |
//! | `colour` | colour interpolated, to RGB565 |
//! | `depth` | one value, depth interpolated and tested |
//! | `full` | colour and depth: `walk` |
//!
//! A prefix `parts:N:B:` prepares in N parts and draws in B bands of equal work, one after another; with `twice:S:K:` before it, the
//! K-th part of step S (`vertices`, `primitives`, `bands`) is done twice, which tells what it costs.
//!
//! With the feature `peers` the prefix `peer:NAME:` lets a peer draw the sphere (`embedded-3dgfx`, `euc`, `retrofire`)
//! or the lines (`embedded-graphics`, `tiny-skia`).
//!
//! `count CASE 0` prints, separated by tabs, what the frame consists of: triangles, vertices, primitives kept, bytes
//! of the store, bytes of colour and depth, frame hash; for lines their number and mean length in pixels.

use std::env;
use std::hint::black_box;
use std::process::ExitCode;

use scanout::frame::{Part, Settings, Traversal};
use scanout::output::{PixelFormat, Rgb565};
use scanout::raster::line::{Field, LineEnd, walk, walk_cells};
use scanout_benches::lines::{self, CLIP, HEIGHT, Line, WIDTH};
use scanout_benches::memory::Step;
use scanout_benches::scenes::{Case, Data};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [case, frames] = arguments.as_slice() else {
        eprintln!("usage: count CASE FRAMES (for example 5000:gouraud:320x240 3)");
        return ExitCode::from(2);
    };
    let done = match frames.parse() {
        Err(_) => Err(format!("{frames}: not a number of frames")),
        Ok(frames) => run(case, frames),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("count: {message}");
            ExitCode::from(2)
        }
    }
}

fn run(case: &str, frames: u32) -> Result<(), String> {
    if let Some(name) = case.strip_prefix("lines:") {
        return draw_lines(name, frames);
    }
    #[cfg(feature = "peers")]
    if let Some(name) = case.strip_prefix("peer:") {
        return draw_peer(name, frames);
    }
    if case.starts_with("parts:") || case.starts_with("twice:") {
        return draw_in_parts(case, frames);
    }
    let (case, prepare_only) = match case.strip_prefix("prepare:") {
        Some(rest) => (rest, true),
        None => (case, false),
    };
    let (case, traversal) = match case.strip_prefix("scalar:") {
        Some(rest) => (rest, Traversal::Pixels),
        None => (case, Traversal::Spans),
    };
    let data = Data::new(Case::parse(case)?)?;
    data.with(|scene, settings, memory| {
        let settings = Settings { traversal, ..settings };
        if frames == 0 {
            let (frame, colour, depth) = memory.prepare(scene, settings);
            let hash = frame.hash::<Rgb565>(settings.height, colour, depth);
            let stats = frame.stats();
            let needed = scanout::frame::Needed {
                vertices: stats.vertices as usize,
                primitives: stats.primitives as usize,
                objects: scene.objects.len(),
            };
            println!(
                "{}\t{}\t{}\t{}\t{}\t{:016x}",
                stats.triangles,
                stats.vertices,
                stats.primitives,
                needed.bytes(),
                (colour.len() + depth.len()) * 2,
                hash.expect("memory for all rows"),
            );
        }
        for _ in 0..frames {
            if prepare_only {
                black_box(memory.prepare(black_box(scene), settings));
            } else {
                memory.draw(black_box(scene), settings);
                black_box(&mut *memory);
            }
        }
    });
    Ok(())
}

fn draw_in_parts(case: &str, frames: u32) -> Result<(), String> {
    let name = case;
    let wrong = || format!("{name}: not [twice:STEP:K:]parts:N:B:CASE");
    let number = |word: &str| word.parse::<u16>().map_err(|_| wrong());
    let (mut case, mut twice) = (case, None);
    if let Some(rest) = case.strip_prefix("twice:") {
        let [step, k, rest] = words(rest).ok_or_else(wrong)?;
        let step = match step {
            "vertices" => Step::Vertices,
            "primitives" => Step::Primitives,
            "bands" => Step::Bands,
            _ => return Err(wrong()),
        };
        (case, twice) = (rest, Some((step, number(k)?.into())));
    }
    let rest = case.strip_prefix("parts:").ok_or_else(wrong)?;
    let [parts, bands, case] = words(rest).ok_or_else(wrong)?;
    let (mut parts, bands) = (vec![Part::default(); number(parts)?.into()], number(bands)?);
    Data::new(Case::parse(case)?)?.with(|scene, settings, memory| {
        for _ in 0..frames {
            memory.draw_in_parts(black_box(scene), settings, &mut parts, bands, twice);
            black_box(&mut *memory);
        }
    });
    Ok(())
}

/// Three words between colons, the last with all that follows.
fn words(name: &str) -> Option<[&str; 3]> {
    name.splitn(3, ':').collect::<Vec<_>>().try_into().ok()
}

fn line_set(name: &str) -> Result<Vec<Line>, String> {
    match name {
        "long" => Ok(lines::long()),
        "short" => Ok(lines::short()),
        _ => Err(format!("{name}: lines are long or short")),
    }
}

#[cfg(feature = "peers")]
fn draw_peer(name: &str, frames: u32) -> Result<(), String> {
    use scanout_benches::peers::{Drawer, Embedded, EmbeddedGraphics, Euc, Retrofire, TinySkia};
    let (peer, rest) = name.split_once(':').ok_or(format!("{name}: not PEER:CASE"))?;
    let mut drawer: Box<dyn Drawer> = if let Some(set) = rest.strip_prefix("lines:") {
        let lines = line_set(set)?;
        match peer {
            "embedded-graphics" => Box::new(EmbeddedGraphics::new(lines)),
            "tiny-skia" => Box::new(TinySkia::new(lines)),
            _ => return Err(format!("{peer}: draws no lines here")),
        }
    } else {
        let case = Case::parse(rest)?;
        let triangles =
            case.source.parse().map_err(|_| format!("{rest}: peers draw spheres only"))?;
        match (peer, case.look.as_str()) {
            ("embedded-3dgfx", "flat") => Box::new(Embedded::new(triangles, case.size, false)),
            ("embedded-3dgfx", "gouraud") => Box::new(Embedded::new(triangles, case.size, true)),
            ("euc", "gouraud") => Box::new(Euc::new(triangles, case.size)),
            ("retrofire", "gouraud") => Box::new(Retrofire::new(triangles, case.size)),
            _ => return Err(format!("{name}: not drawn here")),
        }
    };
    for _ in 0..frames {
        drawer.draw();
        black_box(&mut drawer);
    }
    Ok(())
}

fn draw_lines(name: &str, frames: u32) -> Result<(), String> {
    let (set, kind) = name.split_once(':').unwrap_or((name, "fill"));
    let lines = line_set(set)?;
    let draw: fn(&Line, &mut [u16], &mut [u16]) = match kind {
        "fill" => |_, _, _| (),
        "flat" => flat,
        "colour" => colour,
        "depth" => depth,
        "full" => full,
        _ => return Err(format!("lines:{name}: fill, flat, colour, depth or full")),
    };
    if frames == 0 {
        println!("{}\t{:.1}", lines.len(), lines::mean_pixels(&lines));
    }
    let pixels = WIDTH as usize * HEIGHT as usize;
    let (mut colours, mut depths) = (vec![0; pixels], vec![u16::MAX; pixels]);
    for _ in 0..frames {
        if kind == "fill" {
            fill(&lines, &mut colours);
        } else {
            lines.iter().for_each(|line| draw(black_box(line), &mut colours, &mut depths));
        }
        black_box((&mut colours, &mut depths));
    }
    Ok(())
}

const STRIDE: usize = WIDTH as usize;

fn fill(lines: &[Line], colours: &mut [u16]) {
    let Some(mut field) = Field::new(colours, STRIDE, CLIP) else { return };
    for line in lines {
        fill_one(black_box(line), &mut field);
    }
}

#[inline(never)]
fn fill_one([a, b]: &Line, field: &mut Field<u16>) {
    let place = |end: &LineEnd| [end.x as u32, end.y as u32];
    field.line(place(a), place(b), Rgb565::encode(a.rgb));
}

#[inline(never)]
fn flat([a, b]: &Line, colours: &mut [u16], _: &mut [u16]) {
    let value = Rgb565::encode(a.rgb);
    walk_cells::<false, false>(a, b, CLIP, STRIDE, |i, _, _| colours[i] = value);
}

#[inline(never)]
fn colour([a, b]: &Line, colours: &mut [u16], _: &mut [u16]) {
    walk_cells::<true, false>(a, b, CLIP, STRIDE, |i, _, rgb| colours[i] = Rgb565::encode(rgb));
}

#[inline(never)]
fn depth([a, b]: &Line, colours: &mut [u16], depths: &mut [u16]) {
    let value = Rgb565::encode(a.rgb);
    walk_cells::<false, true>(a, b, CLIP, STRIDE, |i, z, _| {
        if z <= depths[i] {
            depths[i] = z;
            colours[i] = value;
        }
    });
}

#[inline(never)]
fn full([a, b]: &Line, colours: &mut [u16], depths: &mut [u16]) {
    walk(a, b, CLIP, |x, y, z, rgb| {
        let i = y as usize * STRIDE + x as usize;
        if z <= depths[i] {
            depths[i] = z;
            colours[i] = Rgb565::encode(rgb);
        }
    });
}
