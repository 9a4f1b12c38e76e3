//! From samples to the eye of the next picture: calibration, filter, prediction; and what happens when the viewer is lost.
//!
//! ```text
//!  found:  target = filtered + speed * prediction          not found for 0.3 s:  target = rest
//!  eye = target + offset        offset decays: half of it in 0.1 s when found, in 0.4 s when lost
//! ```
//!
//! Whenever the target changes its meaning (lost, found again), the offset takes up the difference, so the eye never jumps.
//! Prediction is off unless asked for: it makes what trembles tremble more, by the factor that the tests measure.

use crate::V3;
use crate::one_euro::{OneEuro, Settings};
use crate::source::Sample;

/// How long a viewer who is not seen is believed to stand still, seconds.
pub const PATIENCE: f64 = 0.3;

/// How long a source may be silent before its last place counts as where it still is, seconds.
const HOLD: f64 = 0.05;

/// Half-lives of the offset, seconds: found, lost.
const HALF_LIVES: [f64; 2] = [0.1, 0.4];

/// The farthest that a prediction may reach, mm along each axis.
const PREDICTION_REACH: f64 = 60.0;

/// From a source's coordinates to the viewer's: `origin + scale * place`, axis by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// Where the source's zero is, mm in the viewer's coordinates.
    pub origin: V3,
    /// Factors along x, y, z; -1 turns an axis round.
    pub scale: V3,
}

impl Default for Calibration {
    /// The source speaks in the viewer's coordinates.
    fn default() -> Self {
        Self { origin: [0.0; 3], scale: [1.0; 3] }
    }
}

impl Calibration {
    /// A place in the viewer's coordinates.
    pub fn apply(&self, place: V3) -> V3 {
        std::array::from_fn(|i| self.origin[i] + self.scale[i] * place[i])
    }
}

/// How a tracker behaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// From the source to the viewer's coordinates.
    pub calibration: Calibration,
    /// The filter; `None` takes samples as they are.
    pub filter: Option<Settings>,
    /// How far ahead the eye is predicted, seconds; 0 is off.
    pub prediction: f64,
    /// Where the eye is when nobody is there, mm.
    pub rest: V3,
    /// See [`Source::silence_is_loss`](crate::source::Source::silence_is_loss).
    pub silence_is_loss: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            calibration: Calibration::default(),
            filter: Some(Settings::default()),
            prediction: 0.0,
            rest: [0.0, 0.0, 600.0],
            silence_is_loss: true,
        }
    }
}

/// Follows a viewer.
#[derive(Clone, Debug)]
pub struct Tracker {
    options: Options,
    axes: [OneEuro; 3],
    /// The last filtered place and its time.
    seen: Option<(f64, V3)>,
    /// The last place as it came.
    raw: V3,
    /// Since when the source has been looking and finding nobody.
    absent: Option<f64>,
    found: bool,
    offset: V3,
    eye: V3,
    now: Option<f64>,
}

impl Tracker {
    /// Nobody has been seen yet: the eye is at rest.
    pub fn new(options: Options) -> Self {
        let axes = [OneEuro::new(options.filter.unwrap_or_default()); 3];
        let (offset, eye) = ([0.0; 3], options.rest);
        Self {
            options,
            axes,
            seen: None,
            raw: [0.0; 3],
            absent: None,
            found: false,
            offset,
            eye,
            now: None,
        }
    }

    /// Is the viewer seen?
    pub fn found(&self) -> bool {
        self.found
    }

    /// The eye of the picture at `now`, mm, with the newest sample if there is a new one.
    pub fn update(&mut self, now: f64, sample: Option<Sample>) -> V3 {
        match sample {
            Some(Sample { time, eye: Some(place) }) if place.iter().all(|x| x.is_finite()) => {
                self.see(time, self.options.calibration.apply(place));
            }
            Some(Sample { time, eye: None }) => _ = self.absent.get_or_insert(time),
            _ => self.hold(now),
        }
        let dt = self.now.map_or(0.0, |before| (now - before).max(0.0));
        self.now = Some(now);
        let last = if self.options.silence_is_loss { self.seen.map(|seen| seen.0) } else { None };
        let since = self.absent.or(last);
        let lost = self.seen.is_none() || since.is_some_and(|since| now - since > PATIENCE);
        if lost == self.found {
            // The target changes its meaning; the offset keeps the eye where it is.
            self.found = !lost;
            let target = self.target();
            self.offset = std::array::from_fn(|i| self.eye[i] - target[i]);
        }
        let keep = (-dt / HALF_LIVES[usize::from(lost)]).exp2();
        let target = self.target();
        self.offset = self.offset.map(|x| x * keep);
        self.eye = std::array::from_fn(|i| target[i] + self.offset[i]);
        self.eye
    }

    /// A hand that rests stays where it is, and the filter must arrive there.
    fn hold(&mut self, now: f64) {
        if !self.options.silence_is_loss
            && self.absent.is_none()
            && self.seen.is_some_and(|(time, _)| now - time > HOLD)
        {
            self.see(now, self.raw);
        }
    }

    fn see(&mut self, time: f64, place: V3) {
        if self.seen.is_some_and(|(before, _)| time <= before) {
            return;
        }
        (self.absent, self.raw) = (None, place);
        if !self.found {
            self.axes.iter_mut().for_each(OneEuro::reset);
        }
        // Without a filter it runs along all the same, for its speed.
        let filtered = std::array::from_fn(|i| self.axes[i].filter(time, place[i]));
        self.seen = Some((time, if self.options.filter.is_some() { filtered } else { place }));
    }

    fn target(&self) -> V3 {
        match self.seen {
            Some((_, place)) if self.found => std::array::from_fn(|i| {
                let ahead = self.axes[i].speed() * self.options.prediction;
                place[i] + ahead.clamp(-PREDICTION_REACH, PREDICTION_REACH)
            }),
            _ => self.options.rest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: f64, x: f64) -> Option<Sample> {
        Some(Sample { time, eye: Some([x, 0.0, 600.0]) })
    }

    #[test]
    fn a_lost_viewer_glides_back_and_never_jumps() {
        let mut tracker = Tracker::new(Options::default());
        let mut last = tracker.update(0.0, None);
        assert_eq!(last, [0.0, 0.0, 600.0]);
        let mut phase_ends = Vec::new();
        for frame in 1..600 {
            let now = f64::from(frame) / 60.0;
            // Seen at 200 mm for 3 s, away for 4 s (the source looks and finds nobody), seen at -150 mm.
            let sample = match now {
                now if now < 3.0 => at(now, 200.0),
                now if now < 7.0 => Some(Sample { time: now, eye: None }),
                now => at(now, -150.0),
            };
            let eye = tracker.update(now, sample);
            let step = (eye[0] - last[0]).abs();
            assert!(step < 50.0, "a jump of {step} mm at {now}");
            last = eye;
            if frame % 60 == 59 {
                phase_ends.push((now, eye[0], tracker.found()));
            }
        }
        let near = |index: usize, x: f64, found: bool| {
            let (now, got, was) = phase_ends[index];
            assert!((got - x).abs() < 5.0 && was == found, "{now} s: {got} mm, found {was}");
        };
        near(2, 200.0, true);
        near(6, 0.0, false);
        near(9, -150.0, true);
        assert!(phase_ends[3].1 > 20.0, "it glides: {:?}", phase_ends[3]);
    }

    #[test]
    fn a_hand_that_rests_is_not_lost() {
        let options = Options { silence_is_loss: false, filter: None, ..Options::default() };
        let mut tracker = Tracker::new(options);
        tracker.update(0.0, at(0.0, 100.0));
        let eye = tracker.update(1000.0, None);
        assert!((eye[0] - 100.0).abs() < 1e-6 && tracker.found(), "{eye:?}");
        // One step of a key, and silence: the filter arrives all the same.
        let options = Options { silence_is_loss: false, ..Options::default() };
        let mut tracker = Tracker::new(options);
        tracker.update(0.0, at(0.0, 100.0));
        tracker.update(1.0, at(1.0, 110.0));
        let eyes = (1..120).map(|i| tracker.update(1.0 + f64::from(i) / 60.0, None)[0]);
        assert!((eyes.last().unwrap() - 110.0).abs() < 0.1);
    }

    #[test]
    fn calibration_turns_and_moves() {
        let calibration = Calibration { origin: [1.0, 2.0, 600.0], scale: [-1.0, 1.0, 2.0] };
        assert_eq!(calibration.apply([10.0, 20.0, 30.0]), [-9.0, 22.0, 660.0]);
    }

    #[test]
    fn nonsense_and_old_samples_move_nothing() {
        let mut tracker = Tracker::new(Options { filter: None, ..Options::default() });
        tracker.update(1.0, at(1.0, 50.0));
        let eye = tracker.update(1.1, at(0.9, -500.0));
        let nonsense = Some(Sample { time: 1.15, eye: Some([f64::NAN, 0.0, 0.0]) });
        let after = tracker.update(1.15, nonsense);
        assert!(eye[0] > 0.0 && after[0] >= eye[0] && after[0] <= 50.0, "{eye:?} {after:?}");
    }
}
