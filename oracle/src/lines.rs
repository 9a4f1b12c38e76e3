//! Lines: the walker of `scanout` against the textbook's closed form and against Pillow.
//!
//! A Bresenham line between pixels, drawn in the direction in which its major coordinate increases: `k` steps along the major
//! direction take the minor coordinate by
//!
//! ```text
//!   floor((2 k minor + major) / (2 major))        "step when 2e >= major": ties go with the line
//! ```
//!
//! Pillow is asked through `lines.py`, which reads the text that [`table`] writes: a line each, `x0 y0 x1 y1: x,y x,y ...`.

use std::path::{Path, PathBuf};
use std::process::Command;

use scanout::raster::line::{ClipRect, LineEnd, walk};

use crate::random::Random;

/// A pixel: column, row.
pub type Pixel = (i32, i32);

/// A line and the pixels drawn for it, in the order drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Both ends.
    pub ends: [Pixel; 2],
    /// Its pixels.
    pub pixels: Vec<Pixel>,
}

/// The 16 lines of system D from one centre: one in each octant and the eight borders between octants.
#[must_use]
pub fn octants() -> Vec<[Pixel; 2]> {
    let centre = (100, 100);
    let to = |(dx, dy): Pixel| [centre, (centre.0 + dx, centre.1 + dy)];
    let signs = [(1, 1), (1, -1), (-1, 1), (-1, -1)];
    let inside = signs.iter().flat_map(|(x, y)| [(x * 60, y * 25), (x * 25, y * 60)]);
    let diagonal = signs.iter().map(|(x, y)| (x * 50, y * 50));
    let axis = [(60, 0), (-60, 0), (0, 60), (0, -60)];
    inside.chain(diagonal).chain(axis).map(to).collect()
}

/// `count` random lines in a square of 200 pixels; every fourth is short, where ties are frequent.
#[must_use]
pub fn random(count: usize, seed: u64) -> Vec<[Pixel; 2]> {
    let mut random = Random::new(seed);
    let mut end = |size| (random.range(0, size), random.range(0, size));
    (0..count).map(|i| if i % 4 == 0 { [end(12), end(12)] } else { [end(200), end(200)] }).collect()
}

/// The pixels by the closed form.
#[must_use]
pub fn closed_form(ends: [Pixel; 2]) -> Line {
    let [(x0, y0), (x1, y1)] = ends;
    let steep = (y1 - y0).abs() > (x1 - x0).abs();
    let major_minor = |(x, y): Pixel| if steep { (y, x) } else { (x, y) };
    let (mut from, mut to) = (major_minor(ends[0]), major_minor(ends[1]));
    if to.0 < from.0 {
        std::mem::swap(&mut from, &mut to);
    }
    let (major, minor) = (to.0 - from.0, (to.1 - from.1).abs());
    let steps = |k: i32| (2 * k * minor + major).checked_div(2 * major).unwrap_or(0);
    let at = |k| (from.0 + k, from.1 + (to.1 - from.1).signum() * steps(k));
    Line { ends, pixels: (0..=major).map(|k| major_minor(at(k))).collect() }
}

/// The pixels by `scanout`.
#[must_use]
pub fn walked(ends: [Pixel; 2]) -> Line {
    let [a, b] = ends.map(|(x, y)| LineEnd { x, y, z: 0, rgb: [255; 3] });
    let clip = ClipRect { x0: -1 << 20, y0: -1 << 20, x1: 1 << 20, y1: 1 << 20 };
    let mut pixels = Vec::new();
    walk(&a, &b, clip, |x, y, _, _| pixels.push((x, y)));
    Line { ends, pixels }
}

/// The text that `lines.py` reads.
#[must_use]
pub fn table(lines: &[Line]) -> String {
    let row = |line: &Line| {
        let [(x0, y0), (x1, y1)] = line.ends;
        let pixels: Vec<String> = line.pixels.iter().map(|(x, y)| format!("{x},{y}")).collect();
        format!("{x0} {y0} {x1} {y1}: {}\n", pixels.join(" "))
    };
    lines.iter().map(row).collect()
}

/// What Pillow said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All lines are equal; the message counts them.
    Equal(String),
    /// Some are not; the message names them.
    Differ(String),
    /// There is no Python with Pillow; the message says what to install.
    Missing(String),
}

/// The Python to ask: `SCANOUT_PYTHON`, or that of the virtual environment that `./test` makes, or `python3`.
fn python() -> PathBuf {
    let venv = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/venv/bin/python");
    match std::env::var_os("SCANOUT_PYTHON") {
        Some(path) => path.into(),
        None if venv.exists() => venv,
        None => "python3".into(),
    }
}

/// Runs `lines.py` with `arguments`.
fn ask(arguments: &[&std::ffi::OsStr]) -> Verdict {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("lines.py");
    let output = match Command::new(python()).arg(script).args(arguments).output() {
        Ok(output) => output,
        Err(error) => {
            return Verdict::Missing(format!("SKIPPED: no Python ({error}); install python3"));
        }
    };
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    match output.status.code() {
        Some(0) => Verdict::Equal(text(&output.stdout)),
        Some(77) => Verdict::Missing(text(&output.stderr)),
        _ => Verdict::Differ(text(&output.stdout) + &text(&output.stderr)),
    }
}

/// Whether Pillow can be asked; the error says what to install.
///
/// # Errors
/// When there is no Python or no Pillow.
pub fn pillow_present() -> Result<(), String> {
    match ask(&["--check".as_ref()]) {
        Verdict::Missing(why) => Err(why),
        _ => Ok(()),
    }
}

/// Asks Pillow about lines, through a file at `path`.
///
/// # Errors
/// When the file cannot be written.
pub fn ask_pillow(lines: &[Line], path: &Path) -> std::io::Result<Verdict> {
    std::fs::write(path, table(lines))?;
    Ok(ask(&[path.as_os_str()]))
}
