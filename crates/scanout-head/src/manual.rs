//! The viewer moved by hand: keys step (as system C's five buttons do), a mouse places.

use crate::V3;
use crate::source::{Sample, Source};

/// How far a key moves the viewer, mm.
pub const STEP: f64 = 10.0;

/// How far from the middle of the screen a hand may move the viewer: half widths, mm.
const REACH: [f64; 2] = [1500.0, 1000.0];

/// The nearest and the farthest that a hand may place the viewer before the screen, mm.
const DISTANCES: [f64; 2] = [100.0, 3000.0];

/// A viewer that keys and the mouse move.
#[derive(Clone, Debug, PartialEq)]
pub struct Manual {
    eye: V3,
    moved: Option<f64>,
}

impl Manual {
    /// Begins at `eye`, mm.
    pub fn new(eye: V3) -> Self {
        let mut manual = Self { eye: [0.0, 0.0, 600.0], moved: None };
        manual.set(eye, 0.0);
        manual
    }

    /// Where the viewer is, mm.
    pub fn eye(&self) -> V3 {
        self.eye
    }

    /// Moves by steps of [`STEP`] mm to the right, upwards, away from the screen, at `time` seconds.
    pub fn step(&mut self, steps: V3, time: f64) {
        self.set(std::array::from_fn(|i| self.eye[i] + steps[i] * STEP), time);
    }

    /// Places the viewer, within reach, at `time` seconds. What isn't finite is ignored.
    pub fn set(&mut self, eye: V3, time: f64) {
        if eye.iter().all(|x| x.is_finite()) {
            let [x, y, z] = eye;
            let [w, h] = REACH;
            self.eye = [x.clamp(-w, w), y.clamp(-h, h), z.clamp(DISTANCES[0], DISTANCES[1])];
            self.moved = Some(time);
        }
    }
}

impl Source for Manual {
    fn poll(&mut self, _now: f64) -> Option<Sample> {
        self.moved.take().map(|time| Sample { time, eye: Some(self.eye) })
    }

    fn silence_is_loss(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_places_within_reach() {
        let mut manual = Manual::new([0.0, 0.0, 600.0]);
        assert!(manual.poll(0.0).is_some() && manual.poll(0.1).is_none());
        manual.step([2.0, -1.0, 0.0], 0.15);
        let sample = Sample { time: 0.15, eye: Some([20.0, -10.0, 600.0]) };
        assert_eq!(manual.poll(0.2), Some(sample));
        (0..1000).for_each(|_| manual.step([0.0, 0.0, -1.0], 0.3));
        assert_eq!(manual.eye()[2], 100.0);
        manual.set([f64::NAN, 0.0, 0.0], 0.4);
        assert_eq!(manual.eye(), [20.0, -10.0, 100.0]);
    }
}
