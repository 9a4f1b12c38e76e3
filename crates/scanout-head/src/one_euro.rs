//! The One Euro filter, one axis: a low pass whose cut-off rises with speed, so that what rests doesn't tremble and what moves
//! doesn't lag.
//!
//! ```text
//!  alpha(f) = 1 / (1 + 1 / (2 pi f dt))
//!  speed' = speed' + alpha(1 Hz) ((x - x') / dt - speed')        cut-off = minimum + beta |speed'|
//!  x' = x' + alpha(cut-off) (x - x')
//! ```
//!
//! Source: Casiez, Roussel and Vogel, "1 Euro Filter", CHI 2012, with the speed against the last filtered value. The defaults are
//! for a head: at 60 samples a second a tremble of 0.80 mm (standard deviation) becomes 0.32 mm, and a head that moves 300 mm in
//! 0.8 s is followed 3 ms behind and never more than 4.2 mm off (`tests/steadiness.rs`, which prints these numbers).

use core::f64::consts::PI;

/// How strongly a value is filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Cut-off at rest, Hz, above 0.
    pub minimum: f64,
    /// How much the cut-off rises, Hz for each mm/s.
    pub beta: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { minimum: 1.5, beta: 0.1 }
    }
}

/// The cut-off of the speed's own low pass, Hz.
const SPEED_CUTOFF: f64 = 1.0;

/// One axis and what it remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OneEuro {
    /// How strongly it filters.
    pub settings: Settings,
    last: Option<(f64, f64, f64)>,
}

impl OneEuro {
    /// A filter that remembers nothing.
    pub fn new(settings: Settings) -> Self {
        Self { settings, last: None }
    }

    /// Forgets: the next value is taken as it is.
    pub fn reset(&mut self) {
        self.last = None;
    }

    /// The filtered value for `x` at `time` seconds. A time that doesn't go forward changes nothing and gives the last result.
    pub fn filter(&mut self, time: f64, x: f64) -> f64 {
        let Some((before, value, speed)) = self.last else {
            self.last = Some((time, x, 0.0));
            return x;
        };
        let dt = time - before;
        if dt.is_nan() || dt <= 0.0 || !x.is_finite() {
            return value;
        }
        let speed = speed + alpha(SPEED_CUTOFF, dt) * ((x - value) / dt - speed);
        let cutoff = self.settings.minimum + self.settings.beta * speed.abs();
        let value = value + alpha(cutoff, dt) * (x - value);
        self.last = Some((time, value, speed));
        value
    }

    /// The smoothed speed, a second.
    pub fn speed(&self) -> f64 {
        self.last.map_or(0.0, |last| last.2)
    }
}

fn alpha(cutoff: f64, dt: f64) -> f64 {
    1.0 / (1.0 + 1.0 / (2.0 * PI * cutoff * dt))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_reached_and_never_passed() {
        let mut filter = OneEuro::default();
        assert_eq!(filter.filter(0.0, 5.0), 5.0);
        let mut last = 5.0;
        for i in 1..120 {
            let value = filter.filter(f64::from(i) / 60.0, 105.0);
            assert!(value >= last && value <= 105.0);
            last = value;
        }
        assert!(last > 104.9, "{last}");
    }

    #[test]
    fn time_that_stands_still_and_nonsense_change_nothing() {
        let mut filter = OneEuro::default();
        filter.filter(1.0, 10.0);
        let before = filter;
        for (time, x) in [(1.0, 50.0), (0.5, 50.0), (f64::NAN, 50.0), (2.0, f64::NAN)] {
            assert_eq!(filter.filter(time, x), 10.0);
        }
        assert_eq!(filter, before);
        filter.reset();
        assert_eq!(filter.filter(0.0, 3.0), 3.0);
    }
}
