//! `scanout ar`: a model on a marker in a film.
//!
//! ```text
//!  source -> grey -> markers -> pose -> (filter) -> camera and placement -> the pipeline, over the frame -> sink
//! ```
//!
//! A frame that can't be read, or shows no marker, is told and the film goes on.

mod camera;
mod overlay;
mod show;
mod straighten;

use std::io::Write;
use std::path::Path;

use scanout_ar::pose::board::{grid_place, solve_board};
use scanout_ar::pose::filter::{OneEuro, PoseFilter};
use scanout_ar::pose::track::Track;
use scanout_ar::{Detection, Detector, GreyImage, Lens, Pose};
use scanout_video::{Frame, Sink, SinkFormat, Source, VideoError};
use serde_json::json;

use self::camera::Cameras;
use self::overlay::Overlay;
use self::straighten::Straightener;
use crate::args::ar::{ArArgs, Grid};
use crate::error::{Error, Result};
use crate::image_out::{self, Picture, is_dash};
use crate::narrate;

/// Runs through the film.
pub fn run(args: &ArArgs) -> Result<()> {
    if [&args.output, &args.json].iter().all(|path| path.as_deref().is_some_and(is_dash)) {
        let what = "frames and poses can't both go to standard output";
        return Err(Error::usage(what, "name a file for one of them"));
    }
    let format = match &args.output {
        Some(path) => Some((path, SinkFormat::for_path(path).ok_or_else(|| no_format(path))?)),
        None => None,
    };
    let mut augmenter = Augmenter::new(args)?;
    let mut source = Source::open(&args.source, args.fps).map_err(video)?;
    let mut poses = args.json.as_deref().map(image_out::open).transpose()?;
    let Some((path, format)) = format else {
        if args.json.is_some() {
            while let Some(step) = augmenter.next(&mut source, &mut poses) {
                step?;
            }
            return augmenter.summary(&source, None);
        }
        return show::run(args, augmenter, source);
    };
    let mut sink = Sink::create(path, format, source.rate()).map_err(video)?;
    while let Some(step) = augmenter.next(&mut source, &mut poses) {
        let (picture, time) = step?;
        let (width, height) = (picture.width, picture.height);
        let frame = Frame { width, height, rgb: picture.pixels, time };
        if let Err(error) = sink.write(&frame) {
            if error.ends() {
                return Err(video(error));
            }
            narrate!("scanout: {error}");
        }
    }
    let written = sink.count();
    sink.finish().map_err(video)?;
    augmenter.summary(&source, Some((path, written)))
}

fn no_format(path: &Path) -> Error {
    let what = format_args!("{}: no format for this name", path.display());
    Error::usage(what, "end it in .y4m, .mjpeg or .png, or name a folder without an ending")
}

fn video(error: VideoError) -> Error {
    if error.is_broken_pipe() { Error::BrokenPipe } else { Error::Failed(error.to_string()) }
}

/// Everything between source and sink.
struct Augmenter {
    marker: String,
    id: u16,
    size: f64,
    board: Option<(Grid, f64)>,
    cameras: Cameras,
    detector: Detector,
    track: Track,
    filter: Option<PoseFilter>,
    overlay: Option<Overlay>,
    straightener: Straightener,
    grey: Vec<u8>,
    frames: usize,
    lost: usize,
    seen: usize,
    was_seen: Option<bool>,
}

impl Augmenter {
    fn new(args: &ArArgs) -> Result<Self> {
        let filter = (!args.no_filter).then(OneEuro::default);
        let mut detector = Detector::new(&[args.marker.dictionary]);
        detector.film = !args.no_tracking;
        Ok(Self {
            marker: args.marker.to_string(),
            id: args.marker.id,
            size: args.size.0,
            board: args.board.zip(args.gap).map(|(grid, gap)| (grid, gap.0)),
            cameras: Cameras::new(args)?,
            detector,
            track: Track::new(filter),
            filter: filter.map(PoseFilter::new),
            overlay: args.model.as_ref().map(|model| Overlay::new(model, args)).transpose()?,
            straightener: Straightener::default(),
            grey: Vec::new(),
            frames: 0,
            lost: 0,
            seen: 0,
            was_seen: None,
        })
    }

    /// The next picture and its time; `None` at the end. Frames that can't be read are told and passed over.
    fn next(
        &mut self,
        source: &mut Source,
        poses: &mut Option<Box<dyn Write>>,
    ) -> Option<Result<(Picture, f64)>> {
        loop {
            match source.next()? {
                Ok(frame) => {
                    let time = frame.time;
                    return Some(self.augment(frame, poses).map(|picture| (picture, time)));
                }
                Err(error) => {
                    narrate!("scanout: {error}");
                    self.lost += 1;
                    // Nothing came at all: that's a failure, not a film with a hole.
                    if error.ends() && self.frames == 0 {
                        return Some(Err(video(error)));
                    }
                }
            }
        }
    }

    fn augment(&mut self, frame: Frame, poses: &mut Option<Box<dyn Write>>) -> Result<Picture> {
        frame.grey(&mut self.grey);
        let lens = self.cameras.lens(frame.width, frame.height)?;
        let found: Vec<Detection> =
            match GreyImage::new(frame.width, frame.height, frame.width, &self.grey) {
                Some(image) => match self.detector.detect(&image) {
                    Ok(found) => found.to_vec(),
                    Err(error) => {
                        narrate!("scanout: frame {}: {error}", self.frames);
                        Vec::new()
                    }
                },
                None => Vec::new(),
            };
        let pose = self.pose(frame.time, &lens, &found);
        self.tell(pose.is_some(), &found);
        if let Some(to) = poses {
            let line = self.record(&frame, &found, pose);
            writeln!(to, "{line}")
                .and_then(|()| to.flush())
                .map_err(|error| Error::io(Path::new("poses"), &error))?;
        }
        self.frames += 1;
        let picture = Picture { width: frame.width, height: frame.height, pixels: frame.rgb };
        let picture = self.straightener.straighten(picture, &lens);
        match (&self.overlay, pose) {
            (Some(overlay), Some((pose, _))) => overlay.draw(&lens.straight(), &pose, picture),
            _ => Ok(picture),
        }
    }

    /// The pose of the marker or board, and its error in pixels.
    fn pose(&mut self, time: f64, lens: &Lens, found: &[Detection]) -> Option<(Pose, f64)> {
        let Some((Grid(columns, rows), gap)) = self.board else {
            // Of several copies the one that is seen best.
            let ours = found.iter().filter(|one| one.id == self.id);
            let best = ours.max_by(|a, b| a.agreement.total_cmp(&b.agreement))?;
            let (pose, solution) = self.track.update(time, lens, self.size, &best.corners)?;
            return Some((pose, solution.error));
        };
        let places = found.iter().filter_map(|one| {
            let place = grid_place((columns, rows), self.size, gap, self.id, one.id)?;
            Some((place, &one.corners))
        });
        let count = 4 * found.len();
        let (mut points, mut seen) = (vec![[0.0; 3]; count], vec![[0.0; 2]; count]);
        let solution = solve_board(lens, self.size, places, &mut points, &mut seen)?;
        let pose = match &mut self.filter {
            Some(filter) => filter.filter(time, &solution.pose),
            None => solution.pose,
        };
        Some((pose, solution.error))
    }

    /// Tells when the marker comes and goes.
    fn tell(&mut self, seen: bool, found: &[Detection]) {
        self.seen += usize::from(seen);
        if self.was_seen == Some(seen) || (self.was_seen.is_none() && seen) {
            self.was_seen = Some(seen);
            return;
        }
        self.was_seen = Some(seen);
        if seen {
            narrate!("scanout: frame {}: the marker is seen again", self.frames);
        } else if self.board.is_some() {
            narrate!("scanout: frame {}: no marker of the board is seen", self.frames);
        } else if found.is_empty() {
            narrate!("scanout: frame {}: {} is not seen", self.frames, self.marker);
        } else {
            let mut others: Vec<String> = found.iter().map(|one| one.id.to_string()).collect();
            others.dedup();
            let others = others.join(", ");
            narrate!(
                "scanout: frame {}: {} is not seen, but {others} is",
                self.frames,
                self.marker
            );
        }
    }

    fn record(
        &self,
        frame: &Frame,
        found: &[Detection],
        pose: Option<(Pose, f64)>,
    ) -> serde_json::Value {
        let name = self.detector.dictionaries()[0].name;
        let markers: Vec<_> = found
            .iter()
            .map(|one| {
                json!({
                    "marker": format!("{name}:{}", one.id),
                    "corners": one.corners,
                    "agreement": one.agreement,
                })
            })
            .collect();
        let pose = pose.map(|(pose, error)| {
            json!({ "rotation": pose.rotation, "translation": pose.translation, "error": error })
        });
        json!({ "frame": self.frames, "time": frame.time, "pose": pose, "markers": markers })
    }

    fn summary(&self, source: &Source, written: Option<(&Path, usize)>) -> Result<()> {
        if self.frames == 0 {
            return Err(Error::failed(
                source.name(),
                "no frame could be read",
                "give a folder of pictures, y4m or MJPEG",
            ));
        }
        let lost = if self.lost > 0 { format!(", {} lost", self.lost) } else { String::new() };
        let places = match written {
            Some((path, count)) if !is_dash(path) => {
                format!("; wrote {count} to {}", path.display())
            }
            _ => String::new(),
        };
        narrate!("scanout: {} frames{lost}, the marker in {}{places}", self.frames, self.seen);
        if self.seen == 0 {
            narrate!(
                "scanout: {} was never seen; check its name, that all of its white edge is in the picture, and the light",
                self.marker
            );
        }
        Ok(())
    }
}
