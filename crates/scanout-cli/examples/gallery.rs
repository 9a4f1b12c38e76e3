//! Draws the README's picture: `cargo run --release -p scanout-cli --example gallery`. With `--check` it compares instead and
//! fails when the picture is not what the program draws now.

use std::ffi::OsString;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Size of one picture; three lie side by side, two one above the other.
const SIZE: (usize, usize) = (320, 240);

/// Model and options of each picture.
const PICTURES: [&[&str]; 6] = [
    &["earth.obj", "--azimuth", "100"],
    &["teapot.obj", "--mode", "phong", "--specular", "0.4", "--ambient", "0.1", "--diffuse", "0.7"],
    &["torus.obj", "--mode", "textured", "--azimuth", "30", "--elevation", "20"],
    &["teapot.obj", "--mode", "hidden", "--azimuth", "-25"],
    &["torus.obj", "--mode", "wire", "--elevation", "35"],
    &["hand.glb", "--stereo", "anaglyph", "--elevation", "10", "--ambient", "0.3"],
];

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    match gallery(&root) {
        Ok(rgb) => finish(&root.join("docs/gallery.png"), &rgb),
        Err(error) => fail(&error),
    }
}

fn fail(error: &str) -> ExitCode {
    eprintln!("gallery: {error}");
    ExitCode::FAILURE
}

/// The rows of the whole picture.
fn gallery(root: &Path) -> Result<Vec<u8>, String> {
    let (width, height) = SIZE;
    let mut rgb = vec![0; width * 3 * height * 2 * 3];
    for (i, picture) in PICTURES.iter().enumerate() {
        let rows = draw(root, i, picture)?;
        for (y, row) in rows.chunks_exact(width * 3).enumerate() {
            let to = ((i / 3 * height + y) * 3 + i % 3) * width * 3;
            rgb[to..to + width * 3].copy_from_slice(row);
        }
    }
    Ok(rgb)
}

/// One picture, through the program itself.
fn draw(root: &Path, index: usize, options: &[&str]) -> Result<Vec<u8>, String> {
    let out =
        std::env::temp_dir().join(format!("scanout-gallery-{}-{index}.png", std::process::id()));
    let mut arguments: Vec<OsString> = vec!["scanout".into(), "render".into()];
    arguments.push(root.join("models").join(options[0]).into());
    arguments.extend(options[1..].iter().map(OsString::from));
    arguments.extend(["--resolution".into(), format!("{},{}", SIZE.0, SIZE.1).into()]);
    arguments.extend(["-o".into(), out.clone().into()]);
    // The exit code of a library call cannot be looked at; a missing file can.
    let _ = scanout_cli::run(arguments);
    let rows = read(&out).map_err(|e| format!("{}: {e}", options[0]));
    let _ = std::fs::remove_file(out);
    rows
}

/// The pixels of an RGB PNG of 8 bits a channel.
fn read(path: &PathBuf) -> Result<Vec<u8>, String> {
    let file = File::open(path).map_err(|e| e.to_string())?;
    let mut reader =
        png::Decoder::new(BufReader::new(file)).read_info().map_err(|e| e.to_string())?;
    let mut rows = vec![0; reader.output_buffer_size().ok_or("too large")?];
    reader.next_frame(&mut rows).map_err(|e| e.to_string())?;
    Ok(rows)
}

/// Writes the picture, or compares it.
fn finish(path: &PathBuf, rgb: &[u8]) -> ExitCode {
    if std::env::args().any(|a| a == "--check") {
        return match read(path) {
            Ok(rows) if rows == rgb => ExitCode::SUCCESS,
            Ok(_) => {
                fail("docs/gallery.png is stale; run the example without --check and look at it")
            }
            Err(error) => fail(&format!("docs/gallery.png: {error}")),
        };
    }
    let write = || -> Result<(), png::EncodingError> {
        let file = File::create(path)?;
        let mut encoder = png::Encoder::new(file, SIZE.0 as u32 * 3, SIZE.1 as u32 * 2);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        encoder.write_header()?.write_image_data(rgb)
    };
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error.to_string()),
    }
}
