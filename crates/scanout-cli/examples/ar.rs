//! Draws the README's picture of `scanout ar`: the printed marker, the photograph, the result.
//! `cargo run --release -p scanout-cli --example ar`; with `--check` it compares instead and fails when the picture is not what the
//! program draws now.
//!
//! The photograph, `docs/ar-photograph.png`, is made by `oracle/ar/photograph.py`.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use scanout_video::{Frame, read_picture, write_png};

const HEIGHT: usize = 400;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    match draw(&root).and_then(|picture| finish(&root.join("docs/ar.png"), &picture)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ar: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Marker, photograph and result side by side.
fn draw(root: &Path) -> Result<Frame, String> {
    let photograph = root.join("docs/ar-photograph.png");
    let marker =
        run("marker.png", &["marker", "aruco4x4_50:7", "--size", "80mm", "--dpi", "60"], &[])?;
    let model = root.join("models/teapot.obj");
    let options = ["ar", "--marker", "aruco4x4_50:7", "--size", "80mm", "--model-size", "120mm"];
    let files = [("--source", photograph.as_path()), ("--model", model.as_path())];
    let result = run("result.png", &options, &files)?;
    let photograph = read_picture(&photograph).map_err(|error| error.to_string())?;
    let panels = [marker, photograph, result];
    let width = panels.iter().map(|panel| panel.width + 8).sum::<usize>() - 8;
    let mut rgb = vec![[255; 3]; width * HEIGHT];
    let mut left = 0;
    for panel in &panels {
        let top = (HEIGHT - panel.height) / 2;
        for (y, row) in panel.rgb.chunks_exact(panel.width).enumerate() {
            rgb[(top + y) * width + left..][..panel.width].copy_from_slice(row);
        }
        left += panel.width + 8;
    }
    Ok(Frame { width, height: HEIGHT, rgb, time: 0.0 })
}

/// What the program writes.
fn run(name: &str, options: &[&str], files: &[(&str, &Path)]) -> Result<Frame, String> {
    let out = std::env::temp_dir().join(format!("scanout-{}-{name}", std::process::id()));
    let mut arguments: Vec<OsString> = vec!["scanout".into()];
    arguments.extend(options.iter().map(OsString::from));
    for (option, path) in files {
        arguments.extend([OsString::from(option), OsString::from(path)]);
    }
    arguments.extend(["-o".into(), out.clone().into()]);
    // The exit code of a library call cannot be looked at; a missing file can.
    let _ = scanout_cli::run(arguments);
    let frame = read_picture(&out).map_err(|error| error.to_string());
    let _ = std::fs::remove_file(out);
    frame
}

/// Writes the picture, or compares it.
fn finish(path: &Path, picture: &Frame) -> Result<(), String> {
    if std::env::args().any(|argument| argument == "--check") {
        let kept = read_picture(path).map_err(|error| error.to_string())?;
        let same = kept == *picture;
        let stale = "docs/ar.png is stale; run the example without --check and look at it";
        return if same { Ok(()) } else { Err(stale.into()) };
    }
    let file = std::fs::File::create(path).map_err(|error| error.to_string())?;
    write_png(std::io::BufWriter::new(file), picture).map_err(|error| error.to_string())
}
