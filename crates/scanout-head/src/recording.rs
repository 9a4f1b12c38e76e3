//! A viewer's movement in a file: recorded, replayed, compared.
//!
//! ```text
//! time_s,x_mm,y_mm,z_mm
//! 0.000000,0.0,0.0,600.0
//! 0.016667,1.5,0.2,599.1
//! 0.033333,,,                      looked and found nobody
//! ```
//!
//! The first line is the head. Times are seconds and grow; lines that begin with `#` and empty lines are left out.

use std::fmt;
use std::io::{self, BufRead, Write};

use crate::source::{Sample, Source};

/// The first line.
pub const HEAD: &str = "time_s,x_mm,y_mm,z_mm";

/// The most samples that are read: a day at 100 a second.
const MOST: usize = 8_640_000;

/// How long nobody is found between the end of a replay and its next beginning, seconds.
const PAUSE: f64 = 2.0;

/// Why a recording can't be read.
#[derive(Debug)]
pub enum RecordingError {
    /// Reading failed.
    Io(io::Error),
    /// A line is wrong: its number, what it is, what it should be.
    Line(usize, String, &'static str),
    /// There is no sample in it.
    Empty,
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "{error}"),
            Self::Line(number, what, remedy) => write!(f, "line {number}: {what}; {remedy}"),
            Self::Empty => write!(f, "no sample in it; record one with --record"),
        }
    }
}

impl std::error::Error for RecordingError {}

/// Reads a recording.
///
/// # Errors
/// With the number of the line that is wrong.
pub fn read(from: impl BufRead) -> Result<Vec<Sample>, RecordingError> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut head = false;
    for (index, line) in from.lines().enumerate() {
        let line = line.map_err(RecordingError::Io)?;
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let wrong = |what: String, remedy| RecordingError::Line(index + 1, what, remedy);
        if !head {
            if line != HEAD {
                let what =
                    format!("it begins with '{}'", line.chars().take(40).collect::<String>());
                return Err(wrong(what, "the first line must be time_s,x_mm,y_mm,z_mm"));
            }
            head = true;
            continue;
        }
        let sample = parse(line).map_err(|(what, remedy)| wrong(what, remedy))?;
        if samples.last().is_some_and(|last| sample.time <= last.time) {
            let what = format!("time {} is not after the one before", sample.time);
            return Err(wrong(what, "sort the lines by time"));
        }
        if samples.len() == MOST {
            return Err(wrong("too many samples".into(), "8640000 are read at most"));
        }
        samples.push(sample);
    }
    if samples.is_empty() { Err(RecordingError::Empty) } else { Ok(samples) }
}

fn parse(line: &str) -> Result<Sample, (String, &'static str)> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let [time, place @ ..] = fields.as_slice() else { unreachable!("split gives at least one") };
    if place.len() != 3 {
        return Err((format!("{} fields", fields.len()), "give time_s,x_mm,y_mm,z_mm"));
    }
    let number = |text: &str| match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number.abs() <= 1e9 => Ok(number),
        _ => Err((format!("'{text}' is no number"), "give a finite one below 1e9")),
    };
    let time = number(time)?;
    if place.iter().all(|field| field.is_empty()) {
        return Ok(Sample { time, eye: None });
    }
    let eye = [number(place[0])?, number(place[1])?, number(place[2])?];
    Ok(Sample { time, eye: Some(eye) })
}

/// Writes a recording sample by sample.
pub struct Recorder<W: Write> {
    to: W,
    last: Option<f64>,
}

impl<W: Write> Recorder<W> {
    /// Begins with the head.
    ///
    /// # Errors
    /// Writing failed.
    pub fn new(mut to: W) -> io::Result<Self> {
        writeln!(to, "{HEAD}")?;
        Ok(Self { to, last: None })
    }

    /// Adds a sample; one that is not later than the last one by a microsecond is left out.
    ///
    /// # Errors
    /// Writing failed.
    pub fn add(&mut self, sample: &Sample) -> io::Result<()> {
        let time = (sample.time * 1e6).round() / 1e6;
        if self.last.is_some_and(|last| time <= last) {
            return Ok(());
        }
        self.last = Some(time);
        match sample.eye {
            Some([x, y, z]) => writeln!(self.to, "{time:.6},{x:.3},{y:.3},{z:.3}"),
            None => writeln!(self.to, "{time:.6},,,"),
        }
    }

    /// Hands over what is buffered.
    ///
    /// # Errors
    /// Writing failed.
    pub fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// A recording as a source: it begins at the first [`poll`](Source::poll). One that repeats finds nobody after its end and begins
/// again two seconds later.
#[derive(Clone, Debug)]
pub struct Replay {
    samples: Vec<Sample>,
    start: Option<f64>,
    /// The next sample to be given.
    next: usize,
    repeats: bool,
}

impl Replay {
    /// Replays `samples`, which are sorted by time, once or again and again.
    pub fn new(samples: Vec<Sample>, repeats: bool) -> Self {
        Self { samples, start: None, next: 0, repeats }
    }

    /// From the first to the last sample, seconds.
    pub fn duration(&self) -> f64 {
        match (self.samples.first(), self.samples.last()) {
            (Some(first), Some(last)) => last.time - first.time,
            _ => 0.0,
        }
    }
}

impl Source for Replay {
    fn poll(&mut self, now: f64) -> Option<Sample> {
        let first = self.samples.first()?.time;
        let mut start = *self.start.get_or_insert(now);
        if self.repeats && now - start > self.duration() + PAUSE {
            (start, self.next) = (now, 0);
            self.start = Some(start);
        }
        let due = |sample: &Sample| sample.time - first <= now - start + 1e-9;
        let mut newest = None;
        while let Some(sample) = self.samples.get(self.next).filter(|sample| due(sample)) {
            newest = Some(Sample { time: sample.time - first + start, eye: sample.eye });
            self.next += 1;
        }
        if newest.is_none() && self.repeats && self.next == self.samples.len() {
            return Some(Sample { time: now, eye: None });
        }
        newest
    }

    /// What was lost is written in the recording; a hand that rested is silent in it too.
    fn silence_is_loss(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples() -> Vec<Sample> {
        let at = |time, eye| Sample { time, eye };
        vec![
            at(10.0, Some([1.0, 2.0, 600.0])),
            at(10.5, Some([-1.25, 2.0, 600.125])),
            at(10.75, None),
            at(11.0, Some([0.0, 0.0, 500.0])),
        ]
    }

    #[test]
    fn what_is_recorded_is_read() {
        let mut file = Vec::new();
        let mut recorder = Recorder::new(&mut file).unwrap();
        for sample in samples() {
            recorder.add(&sample).unwrap();
            recorder.add(&sample).unwrap(); // the same time again is left out
        }
        assert_eq!(read(&file[..]).unwrap(), samples());
    }

    #[test]
    fn wrong_lines_are_told_by_number() {
        for (text, number, what) in [
            ("x,y\n", 1, "begins with 'x,y'"),
            ("# a\n\ntime_s,x_mm,y_mm,z_mm\n0,1,2\n", 4, "3 fields"),
            ("time_s,x_mm,y_mm,z_mm\n0,1,2,3,4\n", 2, "5 fields"),
            ("time_s,x_mm,y_mm,z_mm\n0,1,a,3\n", 2, "'a' is no number"),
            ("time_s,x_mm,y_mm,z_mm\n0,1,,3\n", 2, "'' is no number"),
            ("time_s,x_mm,y_mm,z_mm\nnan,1,2,3\n", 2, "'nan' is no number"),
            ("time_s,x_mm,y_mm,z_mm\n1,1,2,3\n1,1,2,3\n", 3, "not after"),
        ] {
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("line {number}: ")), "{error}");
            assert!(error.contains(what), "{error}");
        }
        assert!(matches!(read(&b"time_s,x_mm,y_mm,z_mm\n"[..]), Err(RecordingError::Empty)));
        assert!(matches!(read(&b"\xff\xfe"[..]), Err(RecordingError::Io(_))));
    }

    #[test]
    fn a_replay_keeps_its_pace_and_begins_again() {
        let mut replay = Replay::new(samples(), true);
        let eye = |sample: Option<Sample>| sample.and_then(|sample| sample.eye);
        assert_eq!(eye(replay.poll(100.0)), Some([1.0, 2.0, 600.0]));
        assert_eq!(replay.poll(100.4), None);
        // Late: the newest that is due.
        assert_eq!(replay.poll(100.8), Some(Sample { time: 100.75, eye: None }));
        assert_eq!(eye(replay.poll(101.0)), Some([0.0, 0.0, 500.0]));
        assert_eq!(replay.poll(102.9), Some(Sample { time: 102.9, eye: None }), "nobody");
        assert_eq!(eye(replay.poll(103.1)), Some([1.0, 2.0, 600.0]));
        let mut once = Replay::new(samples(), false);
        once.poll(0.0);
        once.poll(1.0);
        assert_eq!(once.poll(100.0), None);
    }
}
