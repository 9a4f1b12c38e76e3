//! The window's content: asks the source, follows the head, draws, measures.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::Instant;

use scanout_head::latency::Latency;
use scanout_head::manual::Manual;
use scanout_head::recording::Recorder;
use scanout_head::screen::Screen;
use scanout_head::source::{Sample, Source};
use scanout_head::tracker::{Calibration, Tracker};

use crate::draw::{self, Options};
use crate::error::{Error, Result};
use crate::image_out::Picture;
use crate::narrate;
use crate::scene_builder::{Shot, Stage};
use crate::window::{Content, Input};

/// How far the viewer moves while the mouse crosses the window: widths and heights of the screen.
const MOUSE_REACH: [f64; 2] = [1.6, 1.6];

/// Who moves the viewer.
pub enum Head {
    /// The mouse (true) or the keys.
    Hand(Manual, bool),
    /// The network or a recording.
    Other(Box<dyn Source>),
}

impl Head {
    /// The source.
    pub fn source(&mut self) -> &mut dyn Source {
        match self {
            Self::Hand(manual, _) => manual,
            Self::Other(source) => &mut **source,
        }
    }
}

/// Writes where the head was.
pub struct Record {
    path: PathBuf,
    to: Recorder<BufWriter<File>>,
    lost: bool,
}

impl Record {
    /// Creates the file.
    pub fn create(path: &Path) -> Result<Self> {
        let file = File::create(path).map_err(|error| Error::io(path, &error))?;
        let to = Recorder::new(BufWriter::new(file)).map_err(|error| Error::io(path, &error))?;
        Ok(Self { path: path.into(), to, lost: false })
    }

    /// Adds what the source said, in the viewer's coordinates, and once that the viewer was lost.
    fn add(
        &mut self,
        now: f64,
        sample: Option<Sample>,
        found: bool,
        c: &Calibration,
    ) -> Result<()> {
        let sample = match sample {
            Some(Sample { time, eye: Some(place) }) => Sample { time, eye: Some(c.apply(place)) },
            // The source's own word, or its silence; once.
            Some(nobody) if !self.lost => nobody,
            None if !found && !self.lost => Sample { time: now, eye: None },
            _ => return Ok(()),
        };
        self.lost = sample.eye.is_none();
        self.to.add(&sample).map_err(|error| Error::io(&self.path, &error))
    }

    /// Hands over what is buffered.
    pub fn finish(mut self) -> Result<()> {
        self.to.flush().map_err(|error| Error::io(&self.path, &error))?;
        narrate!("scanout: wrote {}", self.path.display());
        Ok(())
    }
}

/// The scene behind the glass and who looks at it.
pub struct Viewer {
    /// The scene.
    pub stage: Stage,
    /// The camera, which the eye moves.
    pub shot: Shot,
    /// How it is drawn.
    pub options: Options,
    /// The glass.
    pub screen: Screen,
    /// Who moves the viewer.
    pub head: Head,
    /// Follows the head.
    pub tracker: Tracker,
    /// From the head's to the viewer's coordinates.
    pub calibration: Calibration,
    /// The file that is being written.
    pub record: Option<Record>,
    /// From input to picture.
    pub latency: Latency,
    /// The beginning of time.
    pub epoch: Instant,
    /// The newest sample's time.
    pub newest: Option<f64>,
    /// Does the window cover the whole screen?
    pub fullscreen: bool,
}

impl Viewer {
    /// The picture at `now` seconds.
    pub fn picture(&mut self, now: f64, width: u16, height: u16) -> Result<Picture> {
        let sample = self.head.source().poll(now);
        if let Some(notice) = self.head.source().notice() {
            narrate!("scanout: {notice}");
        }
        let eye = self.tracker.update(now, sample);
        if let Some(record) = &mut self.record {
            record.add(now, sample, self.tracker.found(), &self.calibration)?;
        }
        if let Some(Sample { time, eye: Some(_) }) = sample {
            self.newest = Some(time);
        }
        let own = self.screen.own(self.screen.before(eye));
        self.shot.view.window = Some((own, self.screen.size));
        self.shot.size = (width, height);
        draw::picture(&self.stage, &self.shot, &self.options)
    }

    fn now(&self) -> f64 {
        self.epoch.elapsed().as_secs_f64()
    }
}

impl Content for Viewer {
    fn draw(&mut self, width: u16, height: u16, _: f64) -> Result<Picture> {
        let picture = self.picture(self.now(), width, height)?;
        self.latency.drawn(self.newest);
        Ok(picture)
    }

    fn shown(&mut self) {
        self.latency.shown(self.now());
    }

    fn input(&mut self, input: Input) {
        let now = self.now();
        let [w, h] = self.screen.size;
        let Head::Hand(manual, mouse) = &mut self.head else { return };
        let [x, y, z] = manual.eye();
        match input {
            Input::Cursor(u, v) if *mouse => {
                let [reach_x, reach_y] = MOUSE_REACH;
                manual.set([u * reach_x * w / 2.0, v * reach_y * h / 2.0, z], now);
            }
            Input::Arrow(right, up) => manual.step([right.into(), up.into(), 0.0], now),
            Input::Zoom(notches) => manual.step([0.0, 0.0, -2.0 * notches], now),
            Input::Key('+' | '=') => manual.step([0.0, 0.0, -1.0], now),
            Input::Key('-') => manual.step([0.0, 0.0, 1.0], now),
            Input::Key('r') => manual.set([0.0, 0.0, 600.0], now),
            _ => manual.set([x, y, z], now),
        }
    }

    fn moves(&self) -> bool {
        true
    }

    fn fullscreen(&self) -> bool {
        self.fullscreen
    }

    fn title(&self) -> String {
        "window".into()
    }

    fn rate(&mut self, _: f64, _: f64) {}
}
