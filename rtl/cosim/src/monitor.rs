//! A monitor: reads VGA pins clock by clock, measures the mode, says what is wrong with it, and rebuilds the picture.
//!
//! ```text
//!      vsync  ‾‾|__________|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾|__
//!                 sync        back porch   picture   front porch     (lines)
//!      hsync  ‾|_|‾|_|‾|_|‾|_|‾|_|‾|_|‾|_|‾
//!               sync, back porch, picture, front porch               (clocks)
//! ```
//!
//! Only the two syncs tell where the picture is, as with a real monitor: a line's pixels begin a back porch after its horizontal
//! sync, and the picture's first line is as many horizontal syncs after the vertical one as the porch has lines. The
//! polarity of a sync is the level that takes less time. What is outside of the picture must be black: monitors clamp
//! their black level there.
//!
//! What is measured as porches is where light is seen: a picture with a lit frame around it measures them exactly, a dark one
//! shows wider porches, which is no fault.

use std::mem;

/// One direction of a mode: horizontally in pixel clocks, vertically in lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The picture.
    pub active: usize,
    /// From the picture to the sync.
    pub front: usize,
    /// The sync.
    pub sync: usize,
    /// From the sync to the picture.
    pub back: usize,
    /// Whether the sync is high.
    pub positive: bool,
}

impl Axis {
    /// All of it.
    pub const fn total(&self) -> usize {
        self.active + self.front + self.sync + self.back
    }
}

/// A video mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// A line, in pixel clocks.
    pub horizontal: Axis,
    /// A frame, in lines.
    pub vertical: Axis,
}

impl Mode {
    /// 640x480 at 60 Hz, 25.175 MHz: table 3.1 of system C.
    pub const VGA: Mode = Mode {
        horizontal: Axis { active: 640, front: 16, sync: 96, back: 48, positive: false },
        vertical: Axis { active: 480, front: 10, sync: 2, back: 33, positive: false },
    };
    /// 800x600 at 60 Hz, 40 MHz (VESA DMT).
    pub const SVGA: Mode = Mode {
        horizontal: Axis { active: 800, front: 40, sync: 128, back: 88, positive: true },
        vertical: Axis { active: 600, front: 1, sync: 4, back: 23, positive: true },
    };

    /// Pixel clocks of a frame.
    pub const fn clocks(&self) -> usize {
        self.horizontal.total() * self.vertical.total()
    }

    /// Frames a second at a pixel clock in Hz.
    pub fn refresh(&self, pixel_clock: f64) -> f64 {
        pixel_clock / self.clocks() as f64
    }
}

/// A frame that the monitor has seen from one vertical sync to the next.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The picture's pixels from the top left, as the pins had them.
    pub pixels: Vec<[u8; 3]>,
    /// What was measured; porches up to the light that was seen.
    pub measured: Mode,
    /// What differs from the mode, in words; empty when nothing does.
    pub faults: Vec<String>,
}

#[derive(Clone, Copy)]
struct Sample {
    hsync: bool,
    vsync: bool,
    rgb: [u8; 3],
}

/// The monitor, set to a mode.
pub struct Monitor {
    mode: Mode,
    /// Since the last leading edge of the vertical sync, once its polarity is known.
    samples: Vec<Sample>,
    /// Clocks of the last whole phase of vsync low and high.
    phases: [Option<usize>; 2],
    /// Clocks since vsync changed; `None` before the first change.
    since: Option<usize>,
    locked: bool,
}

impl Monitor {
    /// A monitor that expects this mode.
    pub fn new(mode: Mode) -> Monitor {
        Monitor { mode, samples: Vec::new(), phases: [None; 2], since: None, locked: false }
    }

    /// One pixel clock. A frame is returned with the first clock of the next one; what comes before the polarity of the vertical
    /// sync is known is not seen.
    pub fn clock(&mut self, hsync: bool, vsync: bool, rgb: [u8; 3]) -> Option<Seen> {
        let mut seen = None;
        if let Some(last) = self.samples.last()
            && last.vsync != vsync
        {
            self.phases[usize::from(last.vsync)] = self.since;
            self.since = Some(0);
            let [Some(low), Some(high)] = self.phases else {
                self.samples.clear();
                self.push(hsync, vsync, rgb);
                return None;
            };
            let positive = high < low;
            if vsync == positive {
                let samples = mem::take(&mut self.samples);
                seen = self.locked.then(|| look(&self.mode, &samples, positive));
                self.locked = true;
            } else if !self.locked {
                self.samples.clear();
            }
        }
        self.push(hsync, vsync, rgb);
        seen
    }

    fn push(&mut self, hsync: bool, vsync: bool, rgb: [u8; 3]) {
        self.since = self.since.map(|n| n + 1);
        self.samples.push(Sample { hsync, vsync, rgb });
        // No vertical sync: keep what the next change is compared with.
        if !self.locked && self.since.is_none() {
            self.samples.drain(..self.samples.len() - 1);
        }
    }
}

/// The lengths of the runs of one level that `sync` has, all of which are equal; the fault otherwise.
fn equal(name: &str, lengths: impl Iterator<Item = usize>, faults: &mut Vec<String>) -> usize {
    let mut lengths = lengths.enumerate();
    let Some((_, first)) = lengths.next() else { return 0 };
    if let Some((line, other)) = lengths.find(|&(_, n)| n != first) {
        faults.push(format!(
            "{name} of line {line} after the vertical sync is {other} clocks, the first was {first}"
        ));
    }
    first
}

/// A frame's samples, from the leading edge of the vertical sync to the next.
fn look(mode: &Mode, samples: &[Sample], v_positive: bool) -> Seen {
    let mut faults = Vec::new();
    let high = samples.iter().filter(|s| s.hsync).count();
    let h_positive = high < samples.len() / 2;
    let on = |i: usize| samples[i].hsync == h_positive;
    let edges = |to: bool| (1..samples.len()).filter(move |&i| on(i) == to && on(i - 1) != to);
    let leading: Vec<usize> = edges(true).collect();
    let trailing: Vec<usize> = edges(false).collect();
    let (Some(&first), false) = (leading.first(), trailing.is_empty()) else {
        faults.push("there is no horizontal sync".into());
        return Seen { pixels: Vec::new(), measured: *mode, faults };
    };
    let line = equal("the length", leading.windows(2).map(|w| w[1] - w[0]), &mut faults);
    let after_first = trailing.iter().filter(|&&t| t > first);
    let pulses: Vec<(usize, usize)> = leading.iter().copied().zip(after_first.copied()).collect();
    let sync = equal("the horizontal sync", pulses.iter().map(|p| p.1 - p.0), &mut faults);
    let line = line.max(1);
    let v_clocks = samples.iter().take_while(|s| s.vsync == v_positive).count();
    for (what, clocks) in [("the frame", samples.len()), ("the vertical sync", v_clocks)] {
        if clocks % line != 0 {
            faults.push(format!("{what} is {clocks} clocks, not whole lines of {line}"));
        }
    }

    // Where the mode says the picture is.
    let Mode { horizontal: h, vertical: v } = *mode;
    let (width, height) = (h.active, v.active);
    let above = pulses.iter().position(|p| p.0 >= v_clocks).unwrap_or(0) + v.back;
    let top_left = pulses.get(above - 1).map_or(0, |p| p.1 + h.back);
    let mut pixels = vec![[0; 3]; width * height];
    // The box of light, relative to the picture: left, right, top, bottom (half-open).
    let mut light = [i64::MAX, i64::MIN, i64::MAX, i64::MIN];
    let mut outside = None;
    for (i, sample) in samples.iter().enumerate() {
        let from = i as i64 - top_left as i64;
        let mut y = from.div_euclid(line as i64);
        let mut x = from.rem_euclid(line as i64);
        // What comes after the next horizontal sync belongs to the next line.
        if x >= (line - h.back - sync) as i64 {
            (x, y) = (x - line as i64, y + 1);
        }
        if (0..width as i64).contains(&x) && (0..height as i64).contains(&y) {
            pixels[y as usize * width + x as usize] = sample.rgb;
        } else if sample.rgb != [0; 3] && outside.is_none() {
            outside = Some((x, y));
        }
        if sample.rgb != [0; 3] {
            light = [light[0].min(x), light[1].max(x + 1), light[2].min(y), light[3].max(y + 1)];
        }
    }
    if let Some((x, y)) = outside {
        faults.push(format!("light outside of the picture, at pixel {x} of line {y}"));
    }
    let lines = samples.len() / line;
    let v_sync = v_clocks / line;
    let measured = if light[0] > light[1] {
        // Dark: the porches cannot be seen, so the mode's are believed.
        let rest = |axis: &Axis, total: usize, sync: usize| Axis {
            front: total.saturating_sub(axis.active + axis.back + sync),
            sync,
            ..*axis
        };
        Mode { horizontal: rest(&h, line, sync), vertical: rest(&v, lines, v_sync) }
    } else {
        let lit = |axis: &Axis, low: i64, high: i64, total: usize, sync: usize| Axis {
            active: (high - low) as usize,
            back: (axis.back as i64 + low).max(0) as usize,
            front: (total as i64 - sync as i64 - axis.back as i64 - high).max(0) as usize,
            sync,
            ..*axis
        };
        Mode {
            horizontal: lit(&h, light[0], light[1], line, sync),
            vertical: lit(&v, light[2], light[3], lines, v_sync),
        }
    };
    let measured = Mode {
        horizontal: Axis { positive: h_positive, ..measured.horizontal },
        vertical: Axis { positive: v_positive, ..measured.vertical },
    };
    let mut compare = |what: &str, unit: &str, got: usize, wanted: usize| {
        if got != wanted {
            faults.push(format!("{what} is {got} {unit}, the mode's is {wanted}"));
        }
    };
    compare("a line", "clocks", line, h.total());
    compare("the horizontal sync", "clocks", sync, h.sync);
    compare("a frame", "lines", lines, v.total());
    compare("the vertical sync", "lines", v_sync, v.sync);
    for (what, got, wanted) in
        [("horizontal", h_positive, h.positive), ("vertical", v_positive, v.positive)]
    {
        if got != wanted {
            let sign = |positive| if positive { "positive" } else { "negative" };
            let (got, wanted) = (sign(got), sign(wanted));
            faults.push(format!("the {what} sync is {got}, the mode's is {wanted}"));
        }
    }
    Seen { pixels, measured, faults }
}
