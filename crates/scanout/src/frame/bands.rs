//! Bands of about equal work, for threads.
//!
//! ```text
//! work of a primitive of h rows = SET_UP + ROW h + h^2 / 2          spread evenly over its rows
//! work of a row of the frame    = its pixels (clear, output)
//! ```
//!
//! The unit is about one instruction. A primitive's width is not known here; its height stands in for it. One primitive in
//! every few is looked at: how rows are divided cannot change a pixel.

use core::ops::Range;

use super::{Frame, Kind};

/// Setting a triangle or line up.
const SET_UP: u64 = 128;
/// A row of it.
const ROW: u64 = 16;
/// Primitives looked at, at most twice as many.
const LOOK_AT: usize = 1024;
/// The frame's rows are counted in this many heaps.
const HEAPS: usize = 64;

impl Frame<'_> {
    /// Cuts the frame's rows into `count` bands from the top that take about the same time to draw, each one row or more;
    /// into as many as there are rows, when there are fewer. Cost: some 20,000 instructions.
    pub fn bands(&self, count: u16) -> Bands {
        let height = self.settings.height as usize;
        let rows = height.div_ceil(HEAPS);
        let mut work = [0; HEAPS];
        for (heap, work) in work.iter_mut().enumerate() {
            let own = height.min((heap + 1) * rows).saturating_sub(heap * rows);
            *work = (own * self.settings.width as usize) as u64;
        }
        let listed: usize = self.lists().map(<[_]>::len).sum();
        let step = (listed / LOOK_AT).max(1);
        for primitive in self.lists().flat_map(|list| list.iter().step_by(step)) {
            let (top, bottom) = (primitive.top as usize, primitive.bottom as usize);
            let h = (bottom - top) as u64;
            let edges = match primitive.kind() {
                Kind::Edge if primitive.tag == Kind::Edge as u8 => primitive.rgb[0] as u64 + 1,
                _ => 1,
            };
            let all = (SET_UP * edges + ROW * h + h * h / 2) * step as u64;
            let (first, last) = (top / rows, (bottom - 1) / rows);
            let each = all / (last - first + 1) as u64;
            work[first..=last].iter_mut().for_each(|work| *work += each);
        }
        Bands {
            work,
            all: work.iter().sum(),
            rows,
            height,
            count: count.max(1).into(),
            next: 0,
            top: 0,
        }
    }
}

/// The rows of a frame in bands; see [`Frame::bands`].
#[derive(Clone, Debug)]
pub struct Bands {
    work: [u64; HEAPS],
    all: u64,
    /// Rows in a heap.
    rows: usize,
    height: usize,
    count: usize,
    next: usize,
    top: usize,
}

impl Bands {
    /// The row above which the first `k` shares of the work are.
    fn cut(&self, k: usize) -> usize {
        let mut wanted = self.all * k as u64 / self.count as u64;
        for (heap, &work) in self.work.iter().enumerate() {
            if wanted < work {
                return heap * self.rows + (wanted * self.rows as u64 / work) as usize;
            }
            wanted -= work;
        }
        self.height
    }
}

impl Iterator for Bands {
    type Item = Range<u16>;

    fn next(&mut self) -> Option<Range<u16>> {
        let top = self.top;
        self.next += 1;
        if top >= self.height || self.next > self.count {
            return None;
        }
        // A row for each that follows, where there are so many.
        let follow = self.count - self.next;
        let bottom = self.cut(self.next).min(self.height.saturating_sub(follow)).max(top + 1);
        self.top = if follow == 0 { self.height } else { bottom };
        Some(top as u16..self.top as u16)
    }
}
