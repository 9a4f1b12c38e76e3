//! From input to picture, measured: how old the newest sample in a picture is when the picture is handed to the screen.
//!
//! What the program can't see is not in it: the tracker's own delay before its sample arrives, and the time from the window system to
//! the light of the screen.

/// Ages of samples when their first picture was shown.
#[derive(Clone, Debug, Default)]
pub struct Latency {
    ages: Vec<f32>,
    /// Pictures shown, with a new sample in them or not.
    pictures: u64,
    drawn: Option<f64>,
    shown: Option<f64>,
}

/// The most ages kept: an hour at 60 a second.
const MOST: usize = 216_000;

/// What was measured, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Samples that reached a picture.
    pub samples: usize,
    /// Pictures shown.
    pub pictures: u64,
    /// The youngest.
    pub minimum: f64,
    /// The middle.
    pub median: f64,
    /// 95 of 100 are younger.
    pub most: f64,
}

impl Latency {
    /// A picture was drawn with a sample of this time, the newest there was.
    pub fn drawn(&mut self, sample: Option<f64>) {
        self.drawn = sample;
    }

    /// That picture was handed to the screen at `now`.
    pub fn shown(&mut self, now: f64) {
        self.pictures += 1;
        let Some(time) = self.drawn.take().filter(|&time| Some(time) != self.shown) else { return };
        self.shown = Some(time);
        if self.ages.len() < MOST {
            self.ages.push((now - time).max(0.0) as f32);
        }
    }

    /// The summary, once there was a sample.
    pub fn summary(&self) -> Option<Summary> {
        let mut ages = self.ages.clone();
        ages.sort_unstable_by(f32::total_cmp);
        let at = |share: usize| f64::from(ages[(ages.len() - 1) * share / 100]);
        (!ages.is_empty()).then(|| Summary {
            samples: ages.len(),
            pictures: self.pictures,
            minimum: at(0),
            median: at(50),
            most: at(95),
        })
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [minimum, median, most] = [self.minimum, self.median, self.most].map(|s| s * 1e3);
        write!(
            f,
            "from input to picture: {median:.1} ms (median; least {minimum:.1}, 95 % within {most:.1}) over {} samples in \
             {} pictures; the tracker's and the screen's own delays are not in it",
            self.samples, self.pictures
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_counts_once_when_its_first_picture_is_shown() {
        let mut latency = Latency::default();
        assert_eq!(latency.summary(), None);
        for (sample, now) in [(1.0, 1.25), (1.0, 1.5), (2.0, 2.5), (3.0, 3.125)] {
            latency.drawn(Some(sample));
            latency.shown(now);
        }
        latency.drawn(None);
        latency.shown(9.0);
        let summary = latency.summary().unwrap();
        assert_eq!((summary.samples, summary.pictures), (3, 5));
        assert_eq!((summary.minimum, summary.median, summary.most), (0.125, 0.25, 0.25));
    }
}
