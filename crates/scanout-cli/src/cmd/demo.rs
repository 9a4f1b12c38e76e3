//! `scanout` alone: shows what the pipeline does, on whatever there is.

use std::path::Path;

use scanout_assets::Model;

use crate::args::{DemoArgs, DrawMode, OutputFormat};
use crate::cmd::info::scene_args;
use crate::cmd::turntable::{self, Turn};
use crate::cmd::view::Viewer;
use crate::draw::{self, Frame, Options};
use crate::error::Result;
use crate::image_out;
use crate::scene_builder::Stage;
use crate::scene_builder::view::Fit;
use crate::window::{self, NoWindow, Setting};
use crate::{narrate, terminal};

pub mod model;

/// Shows the demonstration: a window, or the terminal and files.
pub fn run(args: &DemoArgs) -> Result<()> {
    let earth = model::earth()?;
    if !args.no_window {
        match in_window(&earth) {
            Ok(outcome) => {
                outcome?;
                try_next();
                return Ok(());
            }
            Err(NoWindow(why)) => narrate!("scanout: no window ({why})"),
        }
    }
    image_out::create_folder(&args.output, "name a folder with -o, or move the file away")?;
    files(&earth, &args.output)?;
    // Last, and with room for the text after it, so that it stays in sight.
    if terminal::will_show(args.terminal) {
        let picture = still(&earth, &["--elevation", "25"])?.picture;
        terminal::show(&picture, args.terminal, TRY_NEXT)?;
    }
    try_next();
    Ok(())
}

/// Turns the Earth in a window until it is closed.
fn in_window(earth: &Model) -> std::result::Result<Result<()>, NoWindow> {
    let scene = scene_args(&["--resolution", "800,600"]);
    let size = (800, 600);
    let viewer = Stage::with_models(vec![earth.clone()], &scene).and_then(|stage| {
        let shot = stage.shot(&scene, size, Fit::Ball)?;
        Ok(Viewer::new(stage, shot, Options::new(&scene.picture), "the Earth".into()).spinning())
    });
    match viewer {
        Ok(mut viewer) => {
            viewer.keys_when_shown = true;
            window::run(&mut viewer, Setting { size, frames: None })
        }
        Err(error) => Ok(Err(error)),
    }
}

/// One picture a mode, a stereo pair, a picture for a display of 1 bit, and a turntable.
fn files(earth: &Model, folder: &Path) -> Result<()> {
    narrate!("scanout: drawing into {}", folder.display());
    let teapot = model::teapot()?;
    let write = |name: &str, model: &Model, options: &[&str]| {
        let frame = still(model, options)?;
        let path = folder.join(name).with_extension("png");
        image_out::write(&path, OutputFormat::Png, &frame.picture, &frame.bytes)?;
        narrate!("  {:<28} hash {:016x}", path.display().to_string(), frame.hash);
        Ok(())
    };
    for mode in DrawMode::ALL {
        let model = if mode == DrawMode::Textured { earth } else { &teapot };
        write(mode.name(), model, &["--mode", mode.name()])?;
    }
    write("anaglyph", &teapot, &["--stereo", "anaglyph", "--mode", "phong"])?;
    write("mono", earth, &["--format", "mono", "--dither", "--background", "black"])?;
    let scene = scene_args(&[]);
    let stage = Stage::with_models(vec![earth.clone()], &scene)?;
    let shot = stage.shot(&scene, (320, 240), Fit::Turn)?;
    let path = folder.join("turntable.gif");
    let turn = Turn { frames: 45, fps: 20 };
    turntable::write(&stage, &shot, &Options::new(&scene.picture), turn, &path)?;
    narrate!("  {}", path.display());
    Ok(())
}

/// A picture of a model with some options.
fn still(model: &Model, options: &[&str]) -> Result<Frame> {
    let args = scene_args(options);
    let stage = Stage::with_models(vec![model.clone()], &args)?;
    let size = (args.picture.resolution.width, args.picture.resolution.height);
    let shot = stage.shot(&args, size, Fit::Tight)?;
    draw::frame(&stage, &shot, &Options::new(&args.picture))
}

/// Lines that [`try_next`] writes.
const TRY_NEXT: usize = 6;

/// What to do now.
fn try_next() {
    // Where the repository is, a model is at hand and cargo runs the program.
    let model = Path::new("models/teapot.obj");
    let (model, how) = if model.is_file() {
        ("models/teapot.obj", " (from here: cargo run --release -- COMMAND ...)")
    } else {
        ("MODEL", "")
    };
    narrate!("Try next{how}:");
    for (command, why) in [
        (format!("view {model}"), "look at it in a window"),
        (format!("render {model} -o a.png"), "draw it; add --mode hidden, --stereo anaglyph"),
        (format!("turntable {model} -o a.gif"), "let it turn"),
        (format!("info {model}"), "what it needs on a microcontroller"),
        ("--help".into(), "everything else"),
    ] {
        narrate!("  scanout {command:<40} {why}");
    }
}
