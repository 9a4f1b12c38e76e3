//! The display of an emulated board: reads `player::wire`'s records from standard input, decodes them with the display model,
//! and shows each frame in the terminal or a window, prints its hash, or writes it as a picture.
//!
//! See `monitor --help`.

mod show;
#[cfg(feature = "window")]
mod window;

use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use mipidsi::options::{Orientation, Rotation};
use monitor::expected::hashes;
use player::wire::Decoder;
use scanout_display::model::{DisplayModel, Glass};

const HELP: &str = "\
The display of an emulated board, on the PC.

Usage: qemu-system-riscv64 ... | monitor [--hashes] [--show terminal|window] [--png FILE] [--expect OBJ ...]

  --hashes          a line a frame on standard output: number, hash
  --show HOW        frames in this terminal, or in a window (built with --features window)
  --png FILE        the last frame as a picture
  --frames NUMBER   stop after so many
  --expect OBJ      the frames must be system B's scene with this model, as the PC draws it; with
  --texture PPM     this picture, and
  --palette NUMBER  reduced to so many colours, 1 to 256, and
  --scale NUMBER    this size (default 1); needs --frames, which must all come
  --list            print what should come, a line a frame, and read nothing
  --pause SECONDS   take nothing for so long after the first frame (tests a display that stops answering)

Exit codes: 0 done, 1 the bytes are not what a display understands or a frame differs, 2 wrong option.
";

#[derive(Default)]
struct Options {
    hashes: bool,
    show: Option<show::How>,
    png: Option<String>,
    frames: Option<u32>,
    pause: f64,
    expect: Option<PathBuf>,
    texture: Option<PathBuf>,
    palette: Option<usize>,
    scale: f64,
    list: bool,
}

fn main() -> ExitCode {
    let options = match options(std::env::args().skip(1)) {
        Ok(Some(options)) => options,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(what) => {
            eprintln!("monitor: {what}; see monitor --help");
            return ExitCode::from(2);
        }
    };
    let result = match options.show {
        None => run(options, None),
        Some(show::How::Terminal) => {
            show::Screen::terminal().and_then(|screen| run(options, Some(screen)))
        }
        #[cfg(feature = "window")]
        Some(show::How::Window) => {
            window::main(|shared| run(options, Some(show::Screen::Window(shared))))
        }
        #[cfg(not(feature = "window"))]
        Some(show::How::Window) => {
            Err("built without windows; build it with --features window".into())
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("monitor: {what}");
            ExitCode::FAILURE
        }
    }
}

fn options(mut words: impl Iterator<Item = String>) -> Result<Option<Options>, String> {
    let mut options = Options { scale: 1.0, ..Options::default() };
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} wants a value"));
        match word.as_str() {
            "--hashes" => options.hashes = true,
            "--list" => options.list = true,
            "--show" => options.show = Some(show::How::parse(&value()?)?),
            "--png" => options.png = Some(value()?),
            "--expect" => options.expect = Some(value()?.into()),
            "--texture" => options.texture = Some(value()?.into()),
            "--palette" => {
                let value = value()?;
                let colours = value.parse().ok().filter(|colours| (1..=256).contains(colours));
                options.palette =
                    Some(colours.ok_or(format!("{value} is no number of colours, 1 to 256"))?);
            }
            "--scale" => {
                let value = value()?;
                options.scale = value.parse().map_err(|_| format!("{value} is no scale"))?;
            }
            "--frames" => {
                let value = value()?;
                options.frames =
                    Some(value.parse().map_err(|_| format!("{value} is no number of frames"))?);
            }
            "--pause" => {
                let value = value()?;
                options.pause =
                    value.parse().map_err(|_| format!("{value} is no number of seconds"))?;
            }
            "--help" | "-h" => return Ok(None),
            _ => return Err(format!("{word} is no option")),
        }
    }
    if options.palette.is_some() && options.texture.is_none() {
        return Err("--palette needs --texture".into());
    }
    if options.expect.is_some() && options.frames.is_none() {
        return Err("--expect needs --frames".into());
    }
    Ok(Some(options))
}

fn run(options: Options, mut screen: Option<show::Screen>) -> Result<(), String> {
    let mut decoder = Decoder::new(DisplayModel::new(Glass::default()));
    let turned = Orientation::new().rotate(Rotation::Deg90);
    let (mut input, mut bytes) = (io::stdin().lock(), vec![0; 1 << 16]);
    let (mut frames, mut last) = (0, None);
    let expected = match &options.expect {
        Some(obj) => {
            let scale = scanout::math::Q16::from_f64(options.scale);
            let frames = options.frames.unwrap_or(0);
            Some(hashes(obj, options.texture.as_deref(), options.palette, scale, frames)?)
        }
        None => None,
    };
    if options.list {
        for (index, hash) in expected.iter().flatten().enumerate() {
            println!("{} {hash:016x}", index + 1);
        }
        return Ok(());
    }
    'all: loop {
        let count = input.read(&mut bytes).map_err(|error| format!("standard input: {error}"))?;
        if count == 0 {
            break;
        }
        for &byte in &bytes[..count] {
            if !decoder.feed(byte).map_err(|error| format!("after frame {frames}: {error}"))? {
                continue;
            }
            let picture = decoder
                .model
                .picture()
                .map_err(|error| format!("after frame {frames}: {error}"))?;
            let picture = picture.upright(turned);
            let untouched = decoder.model.untouched();
            decoder.model.forget();
            frames += 1;
            if options.hashes {
                let incomplete = if untouched > 0 {
                    format!(" {untouched} pixels never sent")
                } else {
                    String::new()
                };
                // A reader that has gone is no fault.
                let line = writeln!(io::stdout(), "{frames} {:016x}{incomplete}", picture.hash());
                if line.is_err() {
                    break 'all;
                }
            }
            if let Some(expected) = &expected {
                let (got, want) = (picture.hash(), expected[frames as usize - 1]);
                if got != want || untouched > 0 {
                    return Err(format!(
                        "frame {frames} is {got:016x} ({untouched} pixels never sent) and should be {want:016x}"
                    ));
                }
            }
            if let Some(screen) = &mut screen
                && !screen.show(&picture)
            {
                break 'all;
            }
            last = Some(picture);
            if frames == 1 && options.pause > 0.0 {
                std::thread::sleep(std::time::Duration::from_secs_f64(options.pause));
            }
            if options.frames == Some(frames) {
                break 'all;
            }
        }
    }
    if expected.is_some() {
        let all = options.frames.unwrap_or(0);
        if frames < all {
            return Err(format!("{frames} frames came instead of {all}"));
        }
        println!("{frames} frames, each the PC's bit for bit");
    }
    if let (Some(path), Some(picture)) = (&options.png, last) {
        show::png(path, &picture).map_err(|error| format!("{path}: {error}"))?;
    }
    Ok(())
}
