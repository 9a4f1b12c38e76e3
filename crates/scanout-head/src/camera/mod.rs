//! A camera beside the screen that sees the viewer: the face and its eyes, or a marker on cap or glasses.
//!
//! ```text
//!   side view       y                               the camera's axes in the viewer's coordinates:
//!      camera [=>   |  - - - - - marker               right    = (-1, 0, 0)     it faces the viewer
//!      place, tilt  |               o eyes            down     = (0, -cos tilt, sin tilt)
//!           screen  |                                 forward  = (0, sin tilt, cos tilt)
//!                   +------------------- z
//! ```
//!
//! The sample is the middle between the eyes, or the marker's middle, as the detector of `scanout-ar` finds it; where the eyes are
//! from there is the calibration's origin (see [`Calibration`](crate::tracker::Calibration)), fixed along the viewer's axes. The
//! head's angles move nothing.
//!
//! ```text
//!  camera --frames--> a thread that keeps the newest --> a thread that looks at it --> the newest place --> Source::poll
//! ```
//!
//! So neither a slow look nor a slow picture makes the other late, and frames that nobody had time for are left out.

mod face;
mod marker;

pub use face::FaceFinder;
pub use marker::{Marker, MarkerFinder};

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use scanout_ar::Lens;
use scanout_ar::calibration::Calibration;
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

/// Reads a calibration: OpenCV's YAML or JSON, as `scanout calibrate` writes it.
///
/// # Errors
/// A line that says what is wrong.
pub fn calibration(text: &str) -> Result<Sight, String> {
    Calibration::read(text).map(Sight::Calibrated).map_err(|error| error.to_string())
}

impl Sight {
    /// The lens for pictures of this size; `None` when it fits none of that shape.
    fn lens(&self, width: usize, height: usize) -> Option<Lens> {
        match self {
            Self::FieldOfView(degrees) => Lens::from_field_of_view(width, height, *degrees),
            Self::Calibrated(calibration) => calibration.for_size(width, height),
        }
    }
}

/// Finds the viewer in frames.
pub trait Find: Send {
    /// Where the viewer is, mm in the viewer's coordinates; `None` when nobody is seen.
    fn find(&mut self, frame: &Frame) -> Option<V3>;
}

/// The samples of a whole film of `rate` frames a second, unless it says its own: one a frame, with nobody where the marker
/// isn't seen. Lost frames are told to `tell`.
///
/// # Errors
/// The film can't be opened or breaks off.
pub fn film(
    path: &Path,
    rate: f64,
    finder: &mut dyn Find,
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

/// What the threads hand on.
#[derive(Default)]
struct Shared {
    /// The newest frame and when it came.
    frame: Mutex<Option<(Instant, Frame)>>,
    /// There is a new frame, or the end.
    arrived: Condvar,
    newest: Mutex<Option<(Instant, Option<V3>)>>,
    notice: Mutex<Option<String>>,
    ends: AtomicBool,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What is behind it is replaced whole, so a thread that panicked has left nothing half done.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A camera that goes on by itself.
pub struct Camera {
    shared: Arc<Shared>,
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
        finder: Box<dyn Find>,
        epoch: Instant,
    ) -> Result<Self, VideoError> {
        let frames = scanout_video::Source::open(path, rate)?;
        let shared = Arc::new(Shared::default());
        // Nobody waits for these threads: a camera that has stopped sending would never let its own end.
        std::thread::spawn({
            let shared = shared.clone();
            move || read(frames, &shared)
        });
        std::thread::spawn({
            let shared = shared.clone();
            move || look(finder, &shared)
        });
        Ok(Self { shared, epoch })
    }
}

/// Takes frames as they come.
fn read(mut frames: scanout_video::Source, shared: &Shared) {
    while !shared.ends.load(Relaxed) {
        let Some(frame) = frames.next() else { break };
        match frame {
            // It has arrived now; looking at it is a part of the latency.
            Ok(frame) => *lock(&shared.frame) = Some((Instant::now(), frame)),
            Err(error) => {
                *lock(&shared.notice) = Some(error.to_string());
                if error.ends() {
                    break;
                }
            }
        }
        shared.arrived.notify_one();
    }
    shared.ends.store(true, Relaxed);
    let _frame = lock(&shared.frame); // so that the other thread is either waiting or hasn't looked yet
    shared.arrived.notify_one();
}

/// Looks at the newest frame, again and again, and at the last one.
fn look(mut finder: Box<dyn Find>, shared: &Shared) {
    loop {
        let mut slot = lock(&shared.frame);
        while slot.is_none() && !shared.ends.load(Relaxed) {
            slot = shared.arrived.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
        let Some((arrived, frame)) = slot.take() else { break };
        drop(slot);
        let eye = finder.find(&frame);
        *lock(&shared.newest) = Some((arrived, eye));
    }
}

impl Source for Camera {
    fn poll(&mut self, _now: f64) -> Option<Sample> {
        let newest = lock(&self.shared.newest).take();
        newest.map(|(at, eye)| Sample {
            time: at.saturating_duration_since(self.epoch).as_secs_f64(),
            eye,
        })
    }

    fn silence_is_loss(&self) -> bool {
        true
    }

    fn notice(&mut self) -> Option<String> {
        lock(&self.shared.notice).take()
    }
}

impl Drop for Camera {
    fn drop(&mut self) {
        self.shared.ends.store(true, Relaxed);
        let _frame = lock(&self.shared.frame);
        self.shared.arrived.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
