//! `scanout` alone: shows what the pipeline does, on whatever there is.

use std::fs;
use std::path::Path;

use scanout_assets::Model;

use crate::args::{DemoArgs, DrawMode, OutputFormat, SceneArgs};
use crate::cmd::info::scene_args;
use crate::cmd::turntable::{self, Turn};
use crate::cmd::view::Viewer;
use crate::draw::{self, Options};
use crate::error::{Error, Result};
use crate::image_out;
use crate::scene_builder::Stage;
use crate::scene_builder::view::Fit;
use crate::window::{self, KEYS, Setting};
use crate::{narrate, terminal};

mod model;

/// Shows the demonstration: a window, or the terminal and files.
pub fn run(args: &DemoArgs) -> Result<()> {
    let (model, name) = model::load()?;
    if !args.no_window {
        let scene = scene_args(&["--resolution", "960,720"]);
        let stage = Stage::with_models(vec![model.clone()], &scene)?;
        let size = (scene.picture.resolution.width, scene.picture.resolution.height);
        let shot = stage.shot(&scene, size, Fit::Ball)?;
        let mut viewer =
            Viewer::new(stage, shot, Options::new(&scene.picture), name.into()).spinning();
        match window::run(&mut viewer, Setting { size, frames: None }) {
            Ok(outcome) => {
                outcome?;
                narrate!("{KEYS}");
                return try_next(name);
            }
            Err(why) => narrate!("scanout: no window ({})", why.0),
        }
    }
    fs::create_dir_all(&args.output).map_err(|error| Error::io(&args.output, &error))?;
    let scene = scene_args(&[]);
    if terminal::will_show(args.terminal) {
        let stage = Stage::with_models(vec![model.clone()], &scene)?;
        let shot = stage.shot(&scene, (640, 480), Fit::Tight)?;
        let picture = draw::picture(&stage, &shot, &Options::new(&scene.picture))?;
        terminal::show(&picture, args.terminal)?;
    }
    files(&model, &scene, &args.output)?;
    try_next(name)
}

/// One picture a mode, a stereo pair, a display's 16 colours of dither, and a turntable.
fn files(model: &Model, scene: &SceneArgs, folder: &Path) -> Result<()> {
    narrate!("scanout: drawing into {}", folder.display());
    for mode in DrawMode::ALL {
        still(model, folder, mode.name(), &["--mode", mode.name()])?;
    }
    still(model, folder, "anaglyph", &["--stereo", "anaglyph", "--mode", "gouraud"])?;
    still(model, folder, "mono", &["--format", "mono", "--dither", "--background", "black"])?;
    let stage = Stage::with_models(vec![model.clone()], scene)?;
    let shot = stage.shot(scene, (320, 240), Fit::Ball)?;
    let path = folder.join("turntable.gif");
    let turn = Turn { frames: 45, fps: 20 };
    turntable::write(&stage, &shot, &Options::new(&scene.picture), turn, &path)?;
    narrate!("  {}", path.display());
    Ok(())
}

fn still(model: &Model, folder: &Path, name: &str, options: &[&str]) -> Result<()> {
    let args = scene_args(options);
    let stage = Stage::with_models(vec![model.clone()], &args)?;
    let size = (args.picture.resolution.width, args.picture.resolution.height);
    let shot = stage.shot(&args, size, Fit::Tight)?;
    let frame = draw::frame(&stage, &shot, &Options::new(&args.picture))?;
    let path = folder.join(name).with_extension("png");
    image_out::write(&path, OutputFormat::Png, &frame.picture, &frame.bytes)?;
    narrate!("  {:<28} hash {:016x}", path.display().to_string(), frame.hash);
    Ok(())
}

/// What to do now.
fn try_next(name: &str) -> Result<()> {
    narrate!("Try next:");
    for line in [
        "scanout view MODEL                 look at a model of yours",
        "scanout render MODEL -o a.png      draw it; --mode hidden, --stereo anaglyph, --format mono --dither",
        "scanout turntable MODEL -o a.gif   let it turn",
        "scanout info MODEL                 what it needs on a microcontroller",
        "scanout --help                     everything else",
    ] {
        narrate!("  {line}");
    }
    if Path::new("models").is_dir() {
        narrate!("Models are in ./models; shown was {name}.");
    }
    Ok(())
}
