//! Stereo pictures against ffmpeg's filter stereo3d: equal within one level, most of them equal.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use scanout_head::stereo::{Arrangement, compose};

/// Width and height of an eye's whole picture.
const SIZE: (usize, usize) = (64, 48);

type Pixel = [u8; 3];

fn main() -> ExitCode {
    let [left, right] = [1, 2].map(noise);
    let mut failed = false;
    for (how, name, most) in [
        (Arrangement::AnaglyphGrey, "arcg", 0),
        (Arrangement::Anaglyph, "arcc", 0),
        (Arrangement::AnaglyphHalfColour, "arch", 0),
        (Arrangement::AnaglyphDubois, "arcd", 1),
        (Arrangement::SideBySide, "sbsl", 0),
        (Arrangement::SideBySideHalf, "sbs2l", 0),
        (Arrangement::TopBottom, "abl", 0),
        (Arrangement::TopBottomHalf, "ab2l", 0),
        (Arrangement::Interlaced, "irl", 0),
    ] {
        for swapped in [false, true] {
            let name = if swapped && !name.starts_with("ar") {
                format!("{}r", name.trim_end_matches('l'))
            } else {
                name.into()
            };
            // For an anaglyph ffmpeg swaps by its input, so the pictures are exchanged for both.
            let both = if swapped { [&right, &left] } else { [&left, &right] };
            let ours = ours(how, both[0], both[1]);
            let theirs = match theirs(how, &name, both, [&left, &right]) {
                Ok(picture) => picture,
                Err(why) if why.starts_with("SKIPPED") => {
                    println!("{why}");
                    return ExitCode::SUCCESS;
                }
                Err(why) => {
                    println!("{name}: {why}");
                    failed = true;
                    continue;
                }
            };
            let apart = |(a, b): (&u8, &u8)| a.abs_diff(*b);
            let pairs = || ours.as_flattened().iter().zip(theirs.as_flattened());
            let worst = pairs().map(apart).max().unwrap_or(0);
            let differ = pairs().filter(|(a, b)| a != b).count();
            let count = pairs().count();
            let equal = ours.len() == theirs.len() && worst <= most && differ * 2 < count;
            let verdict = if equal { "ok" } else { "FAILED" };
            println!(
                "stereo {name:5} {count} values, {differ} differ, at most by {worst} ... {verdict}"
            );
            failed |= !equal;
        }
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// A picture of noise, all extremes in it.
fn noise(seed: u64) -> Vec<Pixel> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut byte = || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        match (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as u32 {
            n if n % 8 == 0 => 0,
            n if n % 8 == 1 => 255,
            n => (n >> 8) as u8,
        }
    };
    (0..SIZE.0 * SIZE.1).map(|_| [byte(), byte(), byte()]).collect()
}

/// The size of the frame that ffmpeg makes: whole pictures beside or above each other, rows of both in turn.
fn frame(how: Arrangement) -> (usize, usize) {
    let (w, h) = SIZE;
    match how {
        Arrangement::SideBySide | Arrangement::SideBySideHalf => (2 * w, h),
        Arrangement::TopBottom | Arrangement::TopBottomHalf => (w, 2 * h),
        _ => (w, h),
    }
}

fn ours(how: Arrangement, left: &[Pixel], right: &[Pixel]) -> Vec<Pixel> {
    let (width, height) = frame(how);
    let mut out = vec![[0; 3]; width * height];
    compose(how, left, right, &mut out, width);
    out
}

/// ffmpeg's picture. `swapped` are the pictures for the left and the right eye, `both` the same unswapped: names that end in r
/// exchange them, anaglyphs have no such names.
fn theirs(
    how: Arrangement,
    name: &str,
    swapped: [&Vec<Pixel>; 2],
    both: [&Vec<Pixel>; 2],
) -> Result<Vec<Pixel>, String> {
    let (w, mut h) = SIZE;
    let mut eyes = if how.coefficients().is_some() { swapped } else { both }.map(Vec::clone);
    if how == Arrangement::Interlaced {
        // ffmpeg puts all rows of both between each other, we every second one of each: hand it those.
        let first = |of: &Vec<Pixel>| usize::from(of != swapped[0]);
        eyes = eyes.map(|eye| {
            let rows = eye.chunks_exact(w).skip(first(&eye)).step_by(2);
            rows.flatten().copied().collect()
        });
        h /= 2;
    }
    let [left, right] = &eyes;
    let rows = left.chunks_exact(w).zip(right.chunks_exact(w));
    let side_by_side: Vec<u8> =
        rows.flat_map(|(l, r)| l.iter().chain(r)).flatten().copied().collect();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("stereo.py");
    let mut child = Command::new(python())
        .arg(script)
        .args([name, &w.to_string(), &h.to_string()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("SKIPPED: no Python ({error}); install python3"))?;
    // One that ends early has told why on standard error.
    let _ = child.stdin.take().expect("piped").write_all(&side_by_side);
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().into());
    }
    Ok(output.stdout.as_chunks::<3>().0.to_vec())
}

/// The Python to ask, as for the other judges.
fn python() -> PathBuf {
    let venv = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/venv/bin/python");
    match std::env::var_os("SCANOUT_PYTHON") {
        Some(path) => path.into(),
        None if venv.exists() => venv,
        None => "python3".into(),
    }
}
