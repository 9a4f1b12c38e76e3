//! `scanout turntable`: the model turning once about the axis that points up.

use std::path::Path;

use crate::animation::{self, Container, Encoded, Writer};
use crate::args::TurntableArgs;
use crate::draw::{self, Options};
use crate::error::{Error, Result};
use crate::image_out::is_dash;
use crate::scene_builder::view::Fit;
use crate::scene_builder::{Shot, Stage};
use crate::{blank, narrate, progress};

/// How a turntable is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// Pictures in a turn.
    pub frames: u16,
    /// Pictures a second.
    pub fps: u16,
}

/// Draws the turntable.
pub fn run(args: &TurntableArgs) -> Result<()> {
    animation::container_for(&args.output)?;
    if args.fps > 50 && animation::container_for(&args.output)? == Container::Gif {
        narrate!(
            "scanout: browsers slow a GIF of more than 50 pictures a second; a .png keeps pace"
        );
    }
    let picture = &args.scene.picture;
    let size = (picture.resolution.width, picture.resolution.height);
    let mut stage = Stage::load(&args.scene)?;
    let shot = stage.shot(&args.scene, size, Fit::Turn)?;
    let turn = Turn { frames: args.frames, fps: args.fps };
    let options = Options::new(picture);
    blank::tell_first(&mut stage, &shot, &options, &args.scene.camera)?;
    write(&stage, &shot, &options, turn, &args.output)?;
    if !is_dash(&args.output) {
        narrate!("scanout: wrote {} ({} frames)", args.output.display(), args.frames);
    }
    Ok(())
}

/// Draws a turn from `shot` on into `path`, several frames at once, and writes them in order.
///
/// # Errors
/// As drawing and writing.
pub fn write(stage: &Stage, shot: &Shot, options: &Options, turn: Turn, path: &Path) -> Result<()> {
    let container = animation::container_for(path)?;
    let size = (shot.size.0.into(), shot.size.1.into());
    let mut writer = Writer::create(path, size, turn.frames.into(), turn.fps)?;
    let bar = progress::bar(turn.frames.into(), "turntable");
    let numbers: Vec<u16> = (0..turn.frames).collect();
    for batch in numbers.chunks(options.threads.max(1)) {
        for encoded in batch_of(stage, shot, options, turn, container, batch) {
            writer.push(&encoded?)?;
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    writer.finish()
}

/// One thread a frame: making a GIF's palette costs more than drawing.
fn batch_of(
    stage: &Stage,
    shot: &Shot,
    options: &Options,
    turn: Turn,
    container: Container,
    batch: &[u16],
) -> Vec<Result<Encoded>> {
    // GIF counts in 1/100 s and rounding each frame alike would change the duration of the turn.
    let time =
        |frame: u16| (200 * u32::from(frame) + u32::from(turn.fps)) / (2 * u32::from(turn.fps));
    let one = |frame: u16| {
        let angle = 360.0 * f64::from(frame) / f64::from(turn.frames);
        let shot = Shot { turn: shot.turn + angle, ..shot.clone() };
        let options = Options { threads: 1, ..*options };
        let picture = draw::frame(stage, &shot, &options)?.picture;
        Ok(animation::encode(container, picture, (time(frame + 1) - time(frame)) as u16))
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = batch.iter().map(|frame| scope.spawn(move || one(*frame))).collect();
        let lost = || Err(Error::failed("turntable", "a drawing thread ended", "report this"));
        workers.into_iter().map(|worker| worker.join().unwrap_or_else(|_| lost())).collect()
    })
}
