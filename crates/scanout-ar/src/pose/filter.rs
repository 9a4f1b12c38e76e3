//! The One Euro filter: a low pass whose cut-off rises with speed, so that what stands still doesn't tremble and what moves doesn't lag.
//!
//! ```text
//!  alpha(f) = 1 / (1 + 1 / (2 pi f dt))
//!  speed' = speed' + alpha(1 Hz) (speed - speed')        cut-off = minimum + beta |speed'|
//!  x' = x' + alpha(cut-off) (x - x')
//! ```
//!
//! Source: Casiez, Roussel and Vogel, "1 Euro Filter", 2012. The translation is filtered in pieces of the distance to the marker a
//! second, the rotation in radians a second along the shortest arc.

use super::Pose;
use super::rotation::{from_vector, multiply, to_vector, transpose};
use core::f64::consts::PI;
use libm::sqrt;

/// How strongly a pose is filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneEuro {
    /// Cut-off at rest, Hz.
    pub minimum: f64,
    /// How much the cut-off rises, Hz for each radian (or distance to the marker) a second.
    pub beta: f64,
}

impl Default for OneEuro {
    fn default() -> Self {
        Self { minimum: 1.5, beta: 60.0 }
    }
}

/// A filter and what it remembers.
#[derive(Clone, Copy, Debug, Default)]
pub struct PoseFilter {
    /// How strongly it filters.
    pub settings: OneEuro,
    state: Option<State>,
}

#[derive(Clone, Copy, Debug)]
struct State {
    time: f64,
    pose: Pose,
    speed: [f64; 3],
    spin: [f64; 3],
}

impl PoseFilter {
    /// A filter that remembers nothing.
    pub fn new(settings: OneEuro) -> Self {
        Self { settings, state: None }
    }

    /// Forgets: the next pose is taken as it is.
    pub fn reset(&mut self) {
        self.state = None;
    }

    /// The filtered pose at `time` seconds. A time that doesn't go forward leaves the filter as it was and gives the pose back.
    pub fn filter(&mut self, time: f64, pose: &Pose) -> Pose {
        let Some(last) = self.state else {
            self.state = Some(State { time, pose: *pose, speed: [0.0; 3], spin: [0.0; 3] });
            return *pose;
        };
        let dt = time - last.time;
        if dt <= 0.0 || !dt.is_finite() {
            return *pose;
        }
        let slow = alpha(1.0, dt);
        let distance = length(last.pose.translation).max(1e-9);
        let shift: [f64; 3] =
            core::array::from_fn(|i| pose.translation[i] - last.pose.translation[i]);
        let speed: [f64; 3] = core::array::from_fn(|i| {
            last.speed[i] + slow * (shift[i] / dt / distance - last.speed[i])
        });
        let arc = to_vector(&multiply(&pose.rotation, &transpose(&last.pose.rotation)));
        let spin: [f64; 3] =
            core::array::from_fn(|i| last.spin[i] + slow * (arc[i] / dt - last.spin[i]));
        let OneEuro { minimum, beta } = self.settings;
        let a = alpha(minimum + beta * length(speed), dt);
        let b = alpha(minimum + beta * length(spin), dt);
        let filtered = Pose {
            translation: core::array::from_fn(|i| last.pose.translation[i] + a * shift[i]),
            rotation: multiply(&from_vector(arc.map(|x| x * b)), &last.pose.rotation),
        };
        self.state = Some(State { time, pose: filtered, speed, spin });
        filtered
    }
}

fn alpha(cutoff: f64, dt: f64) -> f64 {
    1.0 / (1.0 + 1.0 / (2.0 * PI * cutoff * dt))
}

fn length(v: [f64; 3]) -> f64 {
    sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::super::rotation::{IDENTITY, angle};
    use super::*;

    #[test]
    fn calms_what_stands_and_follows_what_moves() {
        let mut filter = PoseFilter::default();
        let (mut seed, mut worst) = (1u32, 0.0f64);
        let mut noise = || {
            seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
            (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5) * 0.004
        };
        let at = |time: f64, n: [f64; 2]| Pose {
            rotation: from_vector([0.5 + n[0], 0.1, time]),
            translation: [n[1] + time, 0.0, 1.0],
        };
        for i in 0..90 {
            let pose = filter.filter(f64::from(i) / 30.0, &at(0.0, [noise(), noise()]));
            if i > 30 {
                worst = worst.max(pose.translation[0].abs());
                worst = worst.max(angle(&pose.rotation, &at(0.0, [0.0; 2]).rotation));
            }
        }
        assert!(worst < 0.0013, "trembles by {worst} instead of 0.002");
        // One radian and one distance a second: behind by less than 30 ms.
        let mut pose = at(0.0, [0.0; 2]);
        for i in 0..60 {
            pose = filter.filter(3.0 + f64::from(i) / 30.0, &at(f64::from(i) / 30.0, [0.0; 2]));
        }
        let lag = 59.0 / 30.0 - pose.translation[0];
        assert!(lag > 0.0 && lag < 0.03, "{lag}");
    }

    #[test]
    fn time_that_stands_still_changes_nothing() {
        let mut filter = PoseFilter::default();
        let pose = |x| Pose { rotation: IDENTITY, translation: [x, 0.0, 1.0] };
        filter.filter(0.0, &pose(0.0));
        assert_eq!(filter.filter(0.0, &pose(5.0)), pose(5.0));
        assert_eq!(filter.filter(f64::NAN, &pose(5.0)), pose(5.0));
        assert!(filter.filter(0.03, &pose(0.001)).translation[0] < 0.001);
    }
}
