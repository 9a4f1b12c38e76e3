//! Which of the two poses of a flat marker it is, decided by the last frames.
//!
//! Both poses are followed from frame to frame; each adds up its squared errors, with the older ones fading. The one with the
//! smaller sum is shown, and another takes its place only when it is clearly better, so that noise in one frame doesn't flip the
//! model.
//!
//! ```text
//!  sum_k = fade sum_k + error_k^2           k = 1, 2
//!  usual = fade usual + min error_k^2
//!  change when  sum_shown > sum_other + usual + least
//! ```

use super::Pose;
use super::filter::{OneEuro, PoseFilter};
use super::planar::{Solution, solve_square};
use super::rotation::angle;
use crate::lens::Lens;
use crate::quad::Corners;

/// What of the sum is left in the next frame.
const FADE: f64 = 0.9;
/// By how much the other sum must be better at least, squared pixels.
const LEAST: f64 = 0.002;

/// One marker over time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Track {
    filter: Option<PoseFilter>,
    state: Option<State>,
}

#[derive(Clone, Copy, Debug)]
struct State {
    time: f64,
    poses: [Pose; 2],
    sums: [f64; 2],
    usual: f64,
    shown: usize,
}

impl Track {
    /// A track that filters its poses, or doesn't.
    pub fn new(filter: Option<OneEuro>) -> Self {
        Self { filter: filter.map(PoseFilter::new), state: None }
    }

    /// Takes the corners seen at `time` seconds; gives the pose that is shown, filtered, and the unfiltered solution. `None` when
    /// the corners have no pose. After half a second without corners everything before is forgotten.
    pub fn update(
        &mut self,
        time: f64,
        lens: &Lens,
        size: f64,
        corners: &Corners,
    ) -> Option<(Pose, Solution)> {
        let mut solutions = solve_square(lens, size, corners)?;
        let remembered = self.state.filter(|state| (0.0..0.5).contains(&(time - state.time)));
        let costs =
            |solutions: &[Solution; 2]| [0, 1].map(|k| solutions[k].error * solutions[k].error);
        let state = match remembered {
            None => {
                if let Some(filter) = &mut self.filter {
                    filter.reset();
                }
                let sums = costs(&solutions);
                let poses = solutions.map(|s| s.pose);
                State { time, poses, sums, usual: sums[0].min(sums[1]), shown: 0 }
            }
            Some(mut state) => {
                // Which is whose successor: the pairing that turns less.
                let turn = |i: usize, k: usize| {
                    angle(&state.poses[i].rotation, &solutions[k].pose.rotation)
                };
                if turn(0, 0) + turn(1, 1) > turn(0, 1) + turn(1, 0) {
                    solutions.swap(0, 1);
                }
                let costs = costs(&solutions);
                for k in 0..2 {
                    state.sums[k] = FADE * state.sums[k] + costs[k];
                    state.poses[k] = solutions[k].pose;
                }
                state.usual = FADE * state.usual + costs[0].min(costs[1]);
                let other = 1 - state.shown;
                if state.sums[state.shown] > state.sums[other] + state.usual + LEAST {
                    state.shown = other;
                }
                state.time = time;
                state
            }
        };
        self.state = Some(state);
        let shown = solutions[state.shown];
        let pose = match &mut self.filter {
            Some(filter) => filter.filter(time, &shown.pose),
            None => shown.pose,
        };
        Some((pose, shown))
    }
}

#[cfg(test)]
mod tests {
    use super::super::rotation::{from_vector, multiply};
    use super::super::square;
    use super::*;

    #[test]
    fn one_noisy_frame_does_not_flip() {
        let lens = Lens::from_field_of_view(640, 480, 56.0).unwrap();
        let facing = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        // Far away: perspective hardly shows, so the two poses are hard to tell apart.
        let rotation = multiply(&from_vector([0.35, 0.0, 0.0]), &facing);
        let want = Pose { rotation, translation: [0.0, 0.0, 1.5] };
        let exact = square(0.08).map(|p| lens.project(want.apply(p)).unwrap());
        let (mut seed, mut alone, mut tracked) = (7u32, 0, 0);
        let mut track = Track::new(None);
        for i in 0..200 {
            let noisy = exact.map(|corner| {
                corner.map(|x| {
                    seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                    x + (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5) * 1.2
                })
            });
            let flipped = |pose: &Pose| angle(&pose.rotation, &want.rotation) > 0.5;
            alone += usize::from(flipped(&solve_square(&lens, 0.08, &noisy).unwrap()[0].pose));
            let (pose, _) = track.update(f64::from(i) / 30.0, &lens, 0.08, &noisy).unwrap();
            tracked += usize::from(flipped(&pose));
        }
        assert!(alone > 5, "the test must be hard: {alone}");
        assert!(tracked * 4 < alone, "{tracked} of {alone}");
    }
}
