//! A camera beside the screen that sees a marker on the viewer's cap or glasses.
//!
//! ```text
//!   side view       y                               the camera's axes in the viewer's coordinates:
//!      camera [=>   |  - - - - - marker               right    = (-1, 0, 0)     it faces the viewer
//!      place, tilt  |               o eyes            down     = (0, -cos tilt, sin tilt)
//!           screen  |                                 forward  = (0, sin tilt, cos tilt)
//!                   +------------------- z
//! ```
//!
//! The marker's middle, as the detector of `scanout-ar` finds it, is the sample; where the eyes are from there is the
//! calibration's origin (see [`Calibration`](crate::tracker::Calibration)), fixed along the viewer's axes: the head's angles move nothing.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use scanout_ar::calibration::Calibration;
use scanout_ar::pose::track::Track;
use scanout_ar::{Detector, Dictionary, GreyImage, Lens};
use scanout_video::Frame;
pub use scanout_video::VideoError;

use crate::V3;
use crate::source::{Sample, Source};

/// Where the camera is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// Its lens, mm in the viewer's coordinates.
    pub place: V3,
    /// How far it looks up, degrees; negative looks down.
    pub tilt: f64,
}

impl Mount {
    /// A place in the camera's axes (right, down, forward), mm, in the viewer's coordinates.
    pub fn to_viewer(&self, [right, down, forward]: V3) -> V3 {
        let (sin, cos) = libm::sincos(self.tilt.to_radians());
        let [x, y, z] = self.place;
        [x - right, y - down * cos + forward * sin, z + down * sin + forward * cos]
    }
}

/// How the camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// Degrees across the picture's width, without distortion.
    FieldOfView(f64),
    /// Calibrated, for pictures of this shape and any size.
    Calibrated(Calibration),
}

/// What is worn.
#[derive(Clone, Copy, Debug)]
pub struct Marker {
    /// Its dictionary.
    pub dictionary: Dictionary,
    /// Its number.
    pub id: u16,
    /// Side of its black square, mm.
    pub size: f64,
}

impl Marker {
    /// The marker `DICTIONARY:NUMBER`, for example `aruco4x4_50:7`, with a black square of `size` mm; `None` when there is none
    /// of that name.
    pub fn by_name(name: &str, size: f64) -> Option<Self> {
        let (dictionary, id) = name.split_once(':')?;
        let dictionary = Dictionary::by_name(&dictionary.to_ascii_lowercase())?;
        let id = id.parse().ok().filter(|&id: &u16| usize::from(id) < dictionary.len())?;
        Some(Self { dictionary, id, size })
    }
}

/// Reads a calibration: OpenCV's YAML or JSON, as `scanout calibrate` writes it.
///
/// # Errors
/// A line that says what is wrong.
pub fn calibration(text: &str) -> Result<Sight, String> {
    Calibration::read(text).map(Sight::Calibrated).map_err(|error| error.to_string())
}

/// Finds the marker in frames.
pub struct Finder {
    detector: Detector,
    marker: Marker,
    sight: Sight,
    mount: Mount,
    track: Track,
    grey: Vec<u8>,
}

impl Finder {
    /// Looks for this marker.
    pub fn new(marker: Marker, sight: Sight, mount: Mount) -> Self {
        let detector = Detector::new(&[marker.dictionary]);
        Self { detector, marker, sight, mount, track: Track::new(None), grey: Vec::new() }
    }

    /// Where the marker's middle is, mm in the viewer's coordinates; `None` when it isn't seen.
    pub fn find(&mut self, frame: &Frame) -> Option<V3> {
        let (width, height) = (frame.width, frame.height);
        let lens = match self.sight {
            Sight::FieldOfView(degrees) => Lens::from_field_of_view(width, height, degrees)?,
            Sight::Calibrated(calibration) => calibration.for_size(width, height)?,
        };
        frame.grey(&mut self.grey);
        let image = GreyImage::new(width, height, width, &self.grey)?;
        let found = self.detector.detect(&image).ok()?;
        // Of several with this number the one that agrees best: a reflection is worse.
        let mine = found.iter().filter(|one| one.id == self.marker.id);
        let best = mine.max_by(|a, b| a.agreement.total_cmp(&b.agreement))?;
        let (pose, _) = self.track.update(frame.time, &lens, self.marker.size, &best.corners)?;
        let ahead = pose.translation[2] > 0.0 && pose.translation.iter().all(|x| x.is_finite());
        ahead.then(|| self.mount.to_viewer(pose.translation))
    }
}

/// The samples of a whole film of `rate` frames a second, unless it says its own: one a frame, with nobody where the marker
/// isn't seen. Lost frames are told to `tell`.
///
/// # Errors
/// The film can't be opened or breaks off.
pub fn film(
    path: &Path,
    rate: f64,
    finder: &mut Finder,
    mut tell: impl FnMut(&VideoError),
) -> Result<Vec<Sample>, VideoError> {
    let mut frames = scanout_video::Source::open(path, rate)?;
    let mut samples = Vec::new();
    while let Some(frame) = frames.next() {
        match frame {
            Ok(frame) => samples.push(Sample { time: frame.time, eye: finder.find(&frame) }),
            Err(error) if error.ends() => return Err(error),
            Err(error) => tell(&error),
        }
    }
    Ok(samples)
}

#[derive(Default)]
struct Shared {
    newest: Mutex<Option<(Instant, Option<V3>)>>,
    notice: Mutex<Option<String>>,
    ends: AtomicBool,
}

/// A camera that goes on by itself: a thread looks at each frame as it comes.
pub struct Camera {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    epoch: Instant,
}

impl Camera {
    /// Opens a source and begins to look; the samples' times count from `epoch`.
    ///
    /// # Errors
    /// The source can't be opened.
    pub fn start(
        path: &Path,
        rate: f64,
        mut finder: Finder,
        epoch: Instant,
    ) -> Result<Self, VideoError> {
        let shared = Arc::new(Shared::default());
        let (tell, told) = std::sync::mpsc::channel();
        // A source may not move between threads, so the thread that reads it opens it.
        let thread = std::thread::spawn({
            let (shared, path) = (shared.clone(), path.to_path_buf());
            move || match scanout_video::Source::open(&path, rate) {
                Ok(frames) => {
                    let _ = tell.send(Ok(())); // whoever asked is still waiting
                    look(frames, &mut finder, &shared);
                }
                Err(error) => _ = tell.send(Err(error)),
            }
        });
        // A thread that ends without a word has panicked; its message is on standard error.
        told.recv().unwrap_or(Ok(()))?;
        Ok(Self { shared, thread: Some(thread), epoch })
    }
}

fn look(mut frames: scanout_video::Source, finder: &mut Finder, shared: &Shared) {
    while !shared.ends.load(Relaxed) {
        let Some(frame) = frames.next() else { break };
        // The frame has arrived now; looking at it is a part of the latency.
        let arrived = Instant::now();
        match frame {
            Ok(frame) => {
                let eye = finder.find(&frame);
                *shared.newest.lock().unwrap_or_else(PoisonError::into_inner) =
                    Some((arrived, eye));
            }
            Err(error) => {
                *shared.notice.lock().unwrap_or_else(PoisonError::into_inner) =
                    Some(error.to_string());
                if error.ends() {
                    break;
                }
            }
        }
    }
}

impl Source for Camera {
    fn poll(&mut self, _now: f64) -> Option<Sample> {
        let newest = self.shared.newest.lock().unwrap_or_else(PoisonError::into_inner).take();
        newest.map(|(at, eye)| Sample {
            time: at.saturating_duration_since(self.epoch).as_secs_f64(),
            eye,
        })
    }

    fn silence_is_loss(&self) -> bool {
        true
    }

    fn notice(&mut self) -> Option<String> {
        self.shared.notice.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Drop for Camera {
    fn drop(&mut self) {
        self.shared.ends.store(true, Relaxed);
        // A camera that has stopped sending would never let its thread end, so nobody waits for it.
        drop(self.thread.take());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_have_names() {
        let marker = Marker::by_name("ArUco4x4_50:7", 50.0).unwrap();
        assert_eq!((marker.dictionary.name, marker.id), ("aruco4x4_50", 7));
        for wrong in ["aruco4x4_50", "aruco4x4_50:50", "aruco4x4_50:-1", "april:1", ":1"] {
            assert!(Marker::by_name(wrong, 50.0).is_none(), "{wrong}");
        }
    }

    #[test]
    fn the_camera_faces_the_viewer() {
        let mount = Mount { place: [0.0, 150.0, 0.0], tilt: -10.0 };
        let ahead = mount.to_viewer([0.0, 0.0, 1000.0]);
        assert!(ahead[2] > 984.0 && ahead[1] < -20.0, "down and out of the glass: {ahead:?}");
        let aside = mount.to_viewer([100.0, 0.0, 500.0]);
        assert!(
            (aside[0] + 100.0).abs() < 1e-9,
            "the picture's right is the viewer's left: {aside:?}"
        );
        let below = mount.to_viewer([0.0, 100.0, 500.0]);
        let level = mount.to_viewer([0.0, 0.0, 500.0]);
        assert!(below[1] < level[1] - 98.0);
    }
}
