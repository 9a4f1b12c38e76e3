//! `scanout render`: one picture, to a file, to standard output or to the terminal.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::args::{OutputFormat, RenderArgs};
use crate::compare::{self, Difference};
use crate::draw::{self, Frame, Options, Report};
use crate::error::{Error, Result};
use crate::image_out::{self, Picture, is_dash};
use crate::scene_builder::view::Fit;
use crate::scene_builder::{Shot, Stage};
use crate::{blank, narrate, terminal};

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
    // The reference is in memory before anything is written.
    let reference = args.reference.as_deref().map(|path| Reference::new(path, args)).transpose()?;
    let picture = &args.scene.picture;
    let size = (picture.resolution.width, picture.resolution.height);
    let mut stage = Stage::load(&args.scene)?;
    let shot = stage.shot(&args.scene, size, Fit::Tight)?;
    let options = Options::new(picture);
    let frame = draw::frame(&stage, &shot, &options)?;
    blank::tell(&mut stage, &shot, &options, &args.scene.camera, &frame)?;

    if let (Some(path), Some(format)) = (&args.output, format) {
        image_out::write(path, format, &frame.picture, &frame.bytes)?;
        if !to_stdout {
            narrate!("scanout: wrote {}", path.display());
        }
    } else if nowhere {
        terminal::show(&frame.picture, args.terminal, 0)?;
    }
    if args.hash {
        print(&format!("{:016x}\n", frame.hash))?;
    }
    let difference = match &reference {
        Some(reference) => reference.compare(&frame.picture)?,
        None => None,
    };
    if args.json {
        let mut answer = json(&frame, &stage, &shot, args);
        if let Some(reference) = &reference {
            answer["reference"] = reference.json(difference.as_ref());
        }
        print(&format!("{answer:#}\n"))?;
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
    match reference {
        Some(reference) => reference.tell(difference.as_ref()),
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
        "mode": stage.mode().name(),
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

/// `--reference`: the picture to compare with, and where a difference goes.
struct Reference<'a> {
    path: &'a Path,
    picture: Picture,
    difference: PathBuf,
    format: OutputFormat,
}

impl<'a> Reference<'a> {
    /// Reads the picture. None of the files may be another one of them.
    fn new(path: &'a Path, args: &RenderArgs) -> Result<Self> {
        let output = args.output.as_deref();
        if output.is_some_and(|output| image_out::same_file(output, path)) {
            return Err(Error::usage(
                format_args!("{}: the reference and OUT are the same file", path.display()),
                "give another name to -o",
            ));
        }
        let difference = match &args.difference {
            Some(path) => path.clone(),
            None => compare::difference_path(output, path),
        };
        let taken = [Some(path), output].into_iter().flatten();
        if taken.into_iter().any(|taken| image_out::same_file(taken, &difference)) {
            return Err(Error::usage(
                format_args!("{}: the difference would replace this file", difference.display()),
                "give another name to --difference",
            ));
        }
        let to_stdout = output.is_some_and(is_dash) || args.hash || args.json;
        if is_dash(&difference) && to_stdout {
            return Err(Error::usage(
                "the difference can't go to standard output too",
                "name a file with --difference",
            ));
        }
        let format = image_out::format_for(&difference, None)?;
        Ok(Self { path, picture: compare::read(path)?, difference, format })
    }

    /// Compares; a difference is drawn, and where there is none the picture of an earlier one goes away.
    fn compare(&self, got: &Picture) -> Result<Option<Difference>> {
        let expected = &self.picture;
        if (got.width, got.height) != (expected.width, expected.height) {
            return Err(Error::failed(
                self.path.display(),
                format_args!(
                    "measures {} x {} and the picture {} x {}",
                    expected.width, expected.height, got.width, got.height
                ),
                "give --resolution to match",
            ));
        }
        let difference = compare::compare(got, expected);
        match &difference {
            Some(difference) => {
                let picture = &difference.picture;
                let raw = picture.pixels.as_flattened();
                image_out::write(&self.difference, self.format, picture, raw)?;
            }
            None if self.difference.is_file() => {
                fs::remove_file(&self.difference)
                    .map_err(|error| Error::io(&self.difference, &error))?;
            }
            None => {}
        }
        Ok(difference)
    }

    fn json(&self, difference: Option<&Difference>) -> serde_json::Value {
        serde_json::json!({
            "file": self.path.display().to_string(),
            "equal": difference.is_none(),
            "different_pixels": difference.map_or(0, |d| d.pixels),
            "largest_difference": difference.map_or(0, |d| d.largest),
            "first_difference": difference.map(|d| [d.first.0, d.first.1]),
            "difference_file": difference.map(|_| self.difference.display().to_string()),
        })
    }

    /// A difference is told, and the answer is [`Error::Unequal`].
    fn tell(&self, difference: Option<&Difference>) -> Result<()> {
        let Some(difference) = difference else {
            narrate!("scanout: equals {}", self.path.display());
            return Ok(());
        };
        narrate!(
            "scanout: {}: {} of {} pixels differ, by up to {}, first at {},{}; see {}",
            self.path.display(),
            difference.pixels,
            self.picture.pixels.len(),
            difference.largest,
            difference.first.0,
            difference.first.1,
            self.difference.display(),
        );
        Err(Error::Unequal)
    }
}
