//! The judges at work. A harness of its own, so that a judge who is not installed is counted as ignored, never as passed.

use libtest_mimic::{Arguments, Failed, Trial};
use scanout_oracle::judge::Report;
use scanout_oracle::lines::{self, Line, Verdict};
use scanout_oracle::llvmpipe::{Llvmpipe, LoadError};
use scanout_oracle::model;
use scanout_oracle::pipeline::Pipeline;
use scanout_oracle::random::{Kind, Random, triangle, vertex};
use scanout_oracle::{Renderer, Texture, Triangle, Wrap, reference};

/// Pixels of a picture's side. A power of two: see `llvmpipe`.
const SIDE: u32 = 128;

/// Triangles of each kind; there are six kinds.
fn count() -> usize {
    let long = std::env::var_os("SCANOUT_LONG").is_some_and(|value| !value.is_empty());
    if long { 20_000 } else { 2_000 }
}

fn judge() -> Llvmpipe {
    Llvmpipe::new(SIDE, SIDE).expect("the trials that need it are ignored when it is missing")
}

fn ours() -> Pipeline {
    Pipeline { width: SIDE, height: SIDE }
}

/// Calls `visit` with `count()` triangles of each kind.
fn for_each_triangle(seed: u64, mut visit: impl FnMut(Kind, &Triangle)) {
    for kind in Kind::ALL {
        let mut random = Random::new(seed);
        for _ in 0..count() {
            visit(kind, &triangle(&mut random, kind, SIDE, SIDE));
        }
    }
}

/// One report for each kind; prints them, and fails when one does not pass or `limit` says what is wrong.
fn by_kind(
    seed: u64,
    mut visit: impl FnMut(&mut Report, &Triangle),
    limit: impl Fn(&Report) -> Result<(), String>,
) -> Result<(), Failed> {
    let mut reports: Vec<(Kind, Report)> = Vec::new();
    for_each_triangle(seed, |kind, triangle| {
        if reports.last().is_none_or(|(last, _)| *last != kind) {
            reports.push((kind, Report::default()));
        }
        let last = reports.len() - 1;
        visit(&mut reports[last].1, triangle);
    });
    let mut total = Report::default();
    for (kind, report) in &reports {
        println!("    {kind:?}: {report}");
        total.add(report);
    }
    println!("    all: {total}");
    for (kind, report) in &reports {
        if !report.passes() {
            return Err(format!("{kind:?}: {report}").into());
        }
        limit(report).map_err(|why| format!("{kind:?}: {why}: {report}"))?;
        let enough = report.triangles >= 2_000 && report.pixels >= report.triangles;
        assert!(enough, "{kind:?} judges too little: {report}");
    }
    assert!(total.is_conclusive(), "too many pixels were not judged: {total}");
    Ok(())
}

/// The textures in turn: sizes that are powers of two and not, every wrap.
fn texture(turn: usize) -> Texture {
    let (width, height) = [(64, 64), (256, 16), (100, 37), (1, 1)][turn % 4];
    Texture { width, height, wrap: [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][turn / 4 % 3] }
}

/// llvmpipe as judge: is it itself right? Coverage equal, colour within 1/255, depth within one step of 1/65536.
fn llvmpipe_equals_the_exact_picture() -> Result<(), Failed> {
    let mut judge = judge();
    println!("    {}, {} bits of depth", judge.description(), judge.depth_bits());
    // What it counts as judged must be no further off than its bound allows: half a step, and a rounding of colours.
    by_kind(1, |report, triangle| report.colour_depth(&mut judge, triangle), within(0.5))
}

/// The nearest texel, except where the exact coordinate is within llvmpipe's own rounding of a border between texels.
fn llvmpipe_equals_the_exact_texels() -> Result<(), Failed> {
    let (mut judge, mut turn) = (judge(), 0);
    let visit = |report: &mut Report, triangle: &Triangle| {
        turn += 1;
        report.texels(&mut judge, triangle, &texture(turn));
    };
    by_kind(2, visit, |_| Ok(()))
}

/// Nothing further off than its last rounding and `slack`.
fn within(slack: f64) -> impl Fn(&Report) -> Result<(), String> {
    move |report| {
        let close = report.colour_error.max(report.depth_error) <= 0.5 + slack;
        if close { Ok(()) } else { Err(format!("further off than 0.5 + {slack}")) }
    }
}

/// `scanout` against the exact rationals: every pixel judged, and off by no more than the last rounding and 1/16.
fn scanout_equals_the_exact_picture() -> Result<(), Failed> {
    let mut ours = ours();
    by_kind(3, |report, triangle| report.colour_depth(&mut ours, triangle), within(1.0 / 16.0))
}

/// `scanout`'s nearest texels, except where the exact coordinate is within its own rounding of a border between texels.
fn scanout_equals_the_exact_texels() -> Result<(), Failed> {
    let (mut ours, mut turn) = (ours(), 0);
    let visit = |report: &mut Report, triangle: &Triangle| {
        turn += 1;
        report.texels(&mut ours, triangle, &texture(turn));
    };
    by_kind(8, visit, |_| Ok(()))
}

/// `scanout`'s nearest texels against llvmpipe's, pixel against pixel.
fn scanout_equals_llvmpipe_in_texels() -> Result<(), Failed> {
    let (mut ours, mut judge, mut turn) = (ours(), judge(), 0);
    let visit = |report: &mut Report, triangle: &Triangle| {
        turn += 1;
        report.texels_against(&mut ours, &mut judge, triangle, &texture(turn));
    };
    by_kind(9, visit, |_| Ok(()))
}

/// `scanout` against llvmpipe, pixel against pixel.
fn scanout_equals_llvmpipe() -> Result<(), Failed> {
    let (mut ours, mut judge) = (ours(), judge());
    by_kind(4, |report, triangle| report.against(&mut ours, &mut judge, triangle), |_| Ok(()))
}

/// Eight points around the picture in clockwise order, seen from anywhere in it: a corner of a quadrilateral beyond each of its
/// corners, and a point between each two. No line from one to the next enters the picture.
fn ring(random: &mut Random) -> [(i32, i32); 8] {
    let side = SIDE as i32 * 16;
    let mut beyond = |positive: bool| {
        let distance = random.range(1, side);
        if positive { side + distance } else { -distance }
    };
    let corners = [(false, false), (true, false), (true, true), (false, true)];
    let corners = corners.map(|(x, y)| (beyond(x), beyond(y)));
    std::array::from_fn(|i| {
        let ((ax, ay), (bx, by)) = (corners[i / 2], corners[(i / 2 + 1) % 4]);
        if i % 2 == 0 { (ax, ay) } else { ((ax + bx).div_euclid(2), (ay + by).div_euclid(2)) }
    })
}

/// Fans around a common corner: every pixel inside exactly once, by every renderer.
fn shared_edges_are_drawn_once(renderers: &mut [&mut dyn Renderer]) -> Result<(), Failed> {
    let mut random = Random::new(5);
    for fan in 0..300 {
        let side = SIDE as i32 * 16;
        let (x, y) = (random.range(0, side), random.range(0, side));
        // Every third centre lies on a pixel's centre, so that the spokes meet there.
        let centre = if fan % 3 == 0 { (x & !15 | 8, y & !15 | 8) } else { (x, y) };
        let ring = ring(&mut random);
        for renderer in &mut *renderers {
            let mut times = vec![0; (SIDE * SIDE) as usize];
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                let corners = [centre, a, b].map(|(x, y)| vertex(&mut random, x, y));
                let coverage = renderer.coverage(&Triangle(corners));
                times
                    .iter_mut()
                    .zip(&coverage.pixels)
                    .for_each(|(n, p)| *n += i32::from(p.is_some()));
            }
            if let Some(i) = times.iter().position(|&n| n != 1) {
                let (x, y) = (i as u32 % SIDE, i as u32 / SIDE);
                let name = renderer.name();
                return Err(format!("fan {fan}: {name} draws ({x}, {y}) {} times", times[i]).into());
            }
        }
    }
    Ok(())
}

/// Pairs of triangles through llvmpipe's depth test: where the exact depths are two steps apart, the nearer one shows.
fn llvmpipe_shows_the_nearer_triangle() -> Result<(), Failed> {
    let (mut judge, mut random, mut decided) = (judge(), Random::new(6), 0);
    for _ in 0..500 {
        let pair = [(); 2].map(|()| triangle(&mut random, Kind::Large, SIDE, SIDE));
        let steady = pair.iter().all(|triangle| judge.rounding(triangle).depth < 0.5);
        let exact = pair.map(|triangle| reference::exact(&triangle, judge.size()));
        let mut painted = pair;
        for (triangle, red) in painted.iter_mut().zip([1, 2]) {
            triangle.0.iter_mut().for_each(|v| v.colour = [red, 0, 0]);
        }
        judge.clear();
        judge.draw(&painted, None, true);
        for (i, [red, ..]) in judge.read_colours().into_iter().enumerate() {
            let [a, b] = [0, 1].map(|n| exact[n].pixels[i].map(|e| e.depth.to_f64() / 65536.0));
            let nearer = match (a, b) {
                (Some(a), Some(b)) if steady && (a - b).abs() > 2.0 => 1 + u8::from(b < a),
                (Some(_), Some(_)) => continue,
                // Nothing is nearer than what is there: the far plane itself fails "strictly nearer".
                (a, b) if a.or(b).is_some_and(|z| z > 65533.0) => continue,
                (a, b) => u8::from(a.is_some()) + 2 * u8::from(b.is_some()),
            };
            decided += usize::from(nearer > 0);
            if red != nearer {
                return Err(format!("pixel {i} of {pair:?} shows {red} instead of {nearer}").into());
            }
        }
    }
    assert!(decided > 100_000, "only {decided} pixels were decided");
    println!("    500 pairs, {decided} pixels decided by depth: 0 differ");
    Ok(())
}

/// The shipped models, lit and textured, from all around: frames of `scanout` against the exact picture and against llvmpipe.
fn models_equal(llvmpipe: bool) -> Result<(), Failed> {
    const SIZE: (u32, u32) = (256, 256);
    let mut judge = llvmpipe.then(|| Llvmpipe::new(SIZE.0, SIZE.1).expect("a judge"));
    let texture = Texture { width: 64, height: 64, wrap: Wrap::Repeat };
    let names = model::shipped()?;
    assert!(names.len() >= 4, "only {names:?}");
    for path in &names {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let model = model::load(path)?;
        let looks: &[Option<Texture>] =
            if model::has_texture_coordinates(&model) { &[None, Some(texture)] } else { &[None] };
        for &texture in looks {
            let mut total = [Report::default(); 2];
            for turn in (0..64).step_by(9) {
                let reports = model::shoot(&model, turn, texture, SIZE).judge(judge.as_mut());
                total.iter_mut().zip(&reports).for_each(|(sum, report)| sum.add(report));
            }
            let report = total[usize::from(llvmpipe)];
            let look = if texture.is_some() { "textured" } else { "lit" };
            println!("    {name}, {look}: {report}");
            if !report.passes() || !report.is_conclusive() {
                return Err(format!("{name}, {look}: {report}").into());
            }
        }
    }
    Ok(())
}

/// All lines in both directions.
fn all_lines() -> Vec<Line> {
    let mut ends = lines::octants();
    assert_eq!(ends.len(), 16);
    ends.extend(lines::random(1_000, 7));
    ends.extend(ends.clone().into_iter().map(|[a, b]| [b, a]));
    ends.into_iter().map(lines::walked).collect()
}

fn lines_equal_the_closed_form() -> Result<(), Failed> {
    let lines = all_lines();
    for line in &lines {
        if *line != lines::closed_form(line.ends) {
            return Err(format!("{line:?}, expected {:?}", lines::closed_form(line.ends)).into());
        }
    }
    println!("    {} lines: 0 differ", lines.len());
    Ok(())
}

fn lines_equal_pillow() -> Result<(), Failed> {
    let path = std::env::temp_dir().join(format!("scanout-lines-{}.txt", std::process::id()));
    let verdict = lines::ask_pillow(&all_lines(), &path)?;
    std::fs::remove_file(&path)?;
    match verdict {
        Verdict::Equal(message) => {
            println!("    {message}");
            Ok(())
        }
        Verdict::Differ(message) | Verdict::Missing(message) => Err(message.into()),
    }
}

fn main() {
    let mut arguments = Arguments::from_args();
    // One at a time: the reports stay together, and llvmpipe uses all cores by itself.
    arguments.test_threads = arguments.test_threads.or(Some(1));

    let no_llvmpipe = match Llvmpipe::new(SIDE, SIDE) {
        Ok(_) => false,
        Err(missing @ LoadError::Missing(_)) => {
            println!("SKIPPED: {missing}");
            true
        }
        Err(unusable) => {
            eprintln!("{unusable}");
            std::process::exit(1);
        }
    };
    let no_pillow = match lines::pillow_present() {
        Ok(()) => false,
        Err(why) => {
            println!("{why}");
            true
        }
    };
    let exact = |name, run: fn() -> Result<(), Failed>| Trial::test(name, run);
    let llvmpipe = |name, run| exact(name, run).with_ignored_flag(no_llvmpipe);
    let pillow = |name, run| exact(name, run).with_ignored_flag(no_pillow);
    let trials = vec![
        llvmpipe("llvmpipe_equals_the_exact_picture", llvmpipe_equals_the_exact_picture),
        llvmpipe("llvmpipe_equals_the_exact_texels", llvmpipe_equals_the_exact_texels),
        llvmpipe("llvmpipe_shows_the_nearer_triangle", llvmpipe_shows_the_nearer_triangle),
        llvmpipe("llvmpipe_draws_shared_edges_once", || {
            shared_edges_are_drawn_once(&mut [&mut judge()])
        }),
        exact("scanout_equals_the_exact_picture", scanout_equals_the_exact_picture),
        exact("scanout_draws_shared_edges_once", || {
            shared_edges_are_drawn_once(&mut [&mut ours()])
        }),
        exact("scanout_equals_the_exact_texels", scanout_equals_the_exact_texels),
        llvmpipe("scanout_equals_llvmpipe", scanout_equals_llvmpipe),
        llvmpipe("scanout_equals_llvmpipe_in_texels", scanout_equals_llvmpipe_in_texels),
        exact("models_equal_the_exact_picture", || models_equal(false)),
        llvmpipe("models_equal_llvmpipe", || models_equal(true)),
        exact("lines_equal_the_closed_form", lines_equal_the_closed_form),
        pillow("lines_equal_pillow", lines_equal_pillow),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
