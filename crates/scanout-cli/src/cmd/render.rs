//! `scanout render`: one picture, to a file, to standard output or to the terminal.

use std::io::{self, Write};
use std::path::Path;

use crate::args::RenderArgs;
use crate::draw::{self, Frame, Options, Report};
use crate::error::{Error, Result};
use crate::image_out::{self, is_dash};
use crate::scene_builder::view::Fit;
use crate::scene_builder::{Shot, Stage};
use crate::{compare, narrate, terminal};

/// Draws the picture and does with it what the options say.
pub fn run(args: &RenderArgs) -> Result<()> {
    let to_stdout = args.output.as_deref().is_some_and(is_dash);
    let answers = args.hash || args.json;
    if to_stdout && answers {
        return Err(Error::usage(
            "picture and answer can't both go to standard output",
            "name a file with -o",
        ));
    }
    let nowhere = args.output.is_none() && !answers && args.reference.is_none() && !args.stats;
    if nowhere && !terminal::will_show(args.terminal) {
        return Err(Error::usage(
            "nowhere to put the picture",
            "give -o OUT, or -o - for standard output",
        ));
    }
    // A bad name is told before the work, not after.
    let format = match &args.output {
        Some(path) => Some(image_out::format_for(path, args.output_format)?),
        None => None,
    };
    let picture = &args.scene.picture;
    let size = (picture.resolution.width, picture.resolution.height);
    let stage = Stage::load(&args.scene)?;
    let shot = stage.shot(&args.scene, size, Fit::Tight)?;
    let frame = draw::frame(&stage, &shot, &Options::new(picture))?;

    if let (Some(path), Some(format)) = (&args.output, format) {
        image_out::write(path, format, &frame.picture, &frame.bytes)?;
        if !to_stdout {
            narrate!("scanout: wrote {}", path.display());
        }
    } else if nowhere {
        terminal::show(&frame.picture, args.terminal)?;
    }
    if args.hash {
        print(&format!("{:016x}\n", frame.hash))?;
    }
    if args.json {
        print(&format!("{:#}\n", json(&frame, &stage, &shot, args)))?;
    }
    if args.stats {
        for (eye, report) in frame.reports.iter().enumerate() {
            if frame.reports.len() > 1 {
                narrate!("eye {}", ["left", "right"][eye]);
            }
            narrate!("{report}");
        }
        narrate!("hash {:016x}", frame.hash);
    }
    match &args.reference {
        Some(reference) => check(&frame, reference, args),
        None => Ok(()),
    }
}

fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))
}

/// What `--json` prints. Lengths in the files' units, times in microseconds.
fn json(frame: &Frame, stage: &Stage, shot: &Shot, args: &RenderArgs) -> serde_json::Value {
    let world = shot.view.world();
    serde_json::json!({
        "width": shot.size.0,
        "height": shot.size.1,
        "format": format!("{:?}", args.scene.picture.format).to_lowercase(),
        "mode": stage.mode.name(),
        "hash": format!("{:016x}", frame.hash),
        "camera": {
            "position": shot.view.eye(),
            "focal_point": shot.view.focal,
            "view_up": shot.view.basis[1],
            "view_angle": shot.view.fovy,
            "world_scale": world.scale,
        },
        "frames": frame.reports.iter().map(Report::json).collect::<Vec<_>>(),
    })
}

/// Compares with the reference; a difference is told, drawn, and the answer is [`Error::Unequal`].
fn check(frame: &Frame, reference: &Path, args: &RenderArgs) -> Result<()> {
    let expected = compare::read(reference)?;
    let got = &frame.picture;
    if (got.width, got.height) != (expected.width, expected.height) {
        return Err(Error::failed(
            reference.display(),
            format_args!(
                "measures {} x {} and the picture {} x {}",
                expected.width, expected.height, got.width, got.height
            ),
            "give --resolution to match",
        ));
    }
    let Some(difference) = compare::compare(got, &expected) else {
        narrate!("scanout: equals {}", reference.display());
        return Ok(());
    };
    let path = match &args.difference {
        Some(path) => path.clone(),
        None => compare::difference_path(args.output.as_deref(), reference),
    };
    image_out::write(&path, crate::args::OutputFormat::Png, &difference.picture, &[])?;
    narrate!(
        "scanout: {}: {} of {} pixels differ, by up to {}, first at {},{}; see {}",
        reference.display(),
        difference.pixels,
        got.pixels.len(),
        difference.largest,
        difference.first.0,
        difference.first.1,
        path.display(),
    );
    Err(Error::Unequal)
}
