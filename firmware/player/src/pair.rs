//! Two harts make a frame: one renders and the other sends, as in system B, or both do both. One hart alone makes it, too.
//!
//! ```text
//!  relay   hart 0   draw 0 | draw 1 | draw 2 | ...            two buffers of colour, one of depth
//!          hart 1            send 0 | send 1 | send 2 | ...
//!
//!  both    hart 0   draw 0 | send 0 | draw 2 | send 2 | ...   a buffer of colour and one of depth each
//!          hart 1   draw 1 |   ...    send 1 | draw 3 | ...
//! ```
//!
//! Hand-over is by [`Turns`]: a value and an atomic count of whose turn it is. A buffer of a relay is drawn into at its
//! even turns and sent at its odd ones; the bus is used by band k at its turn k. Taking a turn synchronises with the end of the
//! one before (acquire, release), so what the other hart wrote is seen.
//!
//! Preparing the frame (transform, light, cull) stays with hart 0. What it will not do: prepare the next frame beneath the
//! sending of this one's last bands.

#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};

use scanout::frame::Frame;
use scanout_display::band::SendError;
use scanout_display::flush::{BlockingInterface, flush};
use scanout_display::window::Area;

use crate::show::Harts as Sharing;

/// A machine's harts.
pub trait Harts {
    /// Whether there is a second one.
    const TWO: bool;

    /// Runs `here` on this hart and `there` on the other, and returns when both have ended.
    fn join(&self, here: &mut dyn FnMut(), there: &mut (dyn FnMut() + Send));
}

/// A machine of one hart.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Harts for Alone {
    const TWO: bool = false;

    fn join(&self, here: &mut dyn FnMut(), there: &mut (dyn FnMut() + Send)) {
        here();
        there();
    }
}

/// A machine of two harts: the second one runs [`serve`](Mailbox::serve) for ever.
#[derive(Debug)]
pub struct Mailbox {
    state: AtomicUsize,
    job: UnsafeCell<Option<Job>>,
}

/// Work on loan; who lends it waits until it is done.
type Job = &'static mut (dyn FnMut() + Send);

// States of a mailbox.
const EMPTY: usize = 0;
const BEING_FILLED: usize = 1;
const FULL: usize = 2;

// SAFETY: `job` is reached by the hart that moved the state from EMPTY to BEING_FILLED until it stores FULL, then by the
// serving hart until that stores EMPTY; each store releases what the next load acquires. Jobs are `Send`.
unsafe impl Sync for Mailbox {}

impl Mailbox {
    /// An empty one, for a static.
    pub const fn new() -> Self {
        Mailbox { state: AtomicUsize::new(EMPTY), job: UnsafeCell::new(None) }
    }

    /// Does what the other hart asks, for ever. For one hart only: a second one would find the mailbox emptied.
    pub fn serve(&self) -> ! {
        loop {
            self.serve_once();
        }
    }

    fn serve_once(&self) {
        while self.state.load(Ordering::Acquire) != FULL {
            wait();
        }
        // SAFETY: the state is FULL, so the content is this hart's; see `Sync`.
        if let Some(job) = unsafe { (*self.job.get()).take() } {
            job();
        }
        self.state.store(EMPTY, Ordering::Release);
    }
}

impl Default for Mailbox {
    fn default() -> Self {
        Self::new()
    }
}

impl Harts for Mailbox {
    const TWO: bool = true;

    fn join(&self, here: &mut dyn FnMut(), there: &mut (dyn FnMut() + Send)) {
        /// Waits for the other hart even if this one's work panics: the job is borrowed from the stack.
        struct Done<'a>(&'a Mailbox);
        impl Drop for Done<'_> {
            fn drop(&mut self) {
                while self.0.state.load(Ordering::Acquire) != EMPTY {
                    wait();
                }
            }
        }
        move_on(&self.state, EMPTY, BEING_FILLED);
        // SAFETY: only the lifetime changes. `Done` keeps this call, and so the loan, until the job has ended.
        let job = unsafe { core::mem::transmute::<&mut (dyn FnMut() + Send), Job>(there) };
        // SAFETY: this hart moved the state to BEING_FILLED, so the content is its; see `Sync`.
        unsafe { *self.job.get() = Some(job) };
        self.state.store(FULL, Ordering::Release);
        let done = Done(self);
        here();
        drop(done);
    }
}

fn wait() {
    // A PC's threads may share a processor.
    #[cfg(any(test, feature = "std"))]
    std::thread::yield_now();
    core::hint::spin_loop();
}

/// A value that is used in turns: turn 0 first, then turn 1, and so on, each once.
#[derive(Debug)]
pub struct Turns<T> {
    /// Twice the turn that may be taken, plus one while it is taken.
    next: AtomicUsize,
    value: UnsafeCell<T>,
}

// SAFETY: the value is reached only by who moved `next` from 2 n to 2 n + 1, which one hart does, and before the next one
// can do so with n + 1 this one has stored 2 n + 2. So it is like a lock around a value that is sent from hart to hart.
unsafe impl<T: Send> Sync for Turns<T> {}

impl<T> Turns<T> {
    /// A value before its turn 0.
    pub const fn new(value: T) -> Self {
        Turns { next: AtomicUsize::new(0), value: UnsafeCell::new(value) }
    }

    /// Waits for a turn and takes it. A turn that was taken before never comes again.
    pub fn take<R>(&self, turn: usize, with: impl FnOnce(&mut T) -> R) -> R {
        let (open, taken) = (2 * turn, 2 * turn + 1);
        move_on(&self.next, open, taken);
        // SAFETY: this hart alone has taken the turn; see `Sync`.
        let result = with(unsafe { &mut *self.value.get() });
        self.next.store(taken + 1, Ordering::Release);
        result
    }

    /// The value, when all turns are over.
    pub fn into_inner(self) -> T {
        self.value.into_inner()
    }
}

/// Waits until `state` is `from` and makes it `to`; what was written before that is seen then.
#[inline(never)]
fn move_on(state: &AtomicUsize, from: usize, to: usize) {
    while state.compare_exchange_weak(from, to, Ordering::Acquire, Ordering::Relaxed).is_err() {
        wait();
    }
}

/// Memory for two harts.
#[derive(Debug)]
pub struct Buffers<'m> {
    /// Colour, one band each; one hart alone uses the first.
    pub colour: [&'m mut [u16]; 2],
    /// Depth, one band each; a relay and one hart alone use the first.
    pub depth: [&'m mut [u16]; 2],
}

/// Why a frame was not shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// The memory is too small for a row, or the frame doesn't fit the display.
    Memory,
    /// The bus failed.
    Bus,
}

type Outcome = Result<(), Wrong>;

/// Draws and sends a frame, in bands as tall as the smallest buffer allows.
///
/// # Errors
/// After the first failure the other bands are drawn, since the other hart waits for its turns, and not sent.
pub fn show<I: BlockingInterface<Error: Send> + Send>(
    frame: &Frame<'_>,
    interface: &mut I,
    area: Area,
    buffers: &mut Buffers<'_>,
    harts: &impl Harts,
    sharing: Sharing,
) -> Outcome {
    let ([front, back], [near, far]) = (&mut buffers.colour, &mut buffers.depth);
    let (width, height) = (frame.settings().width, frame.settings().height);
    let memory = front.len().min(back.len()).min(near.len()).min(far.len());
    let lines = (memory / usize::from(width.max(1))).min(height.into()) as u16;
    if lines == 0 {
        return Err(Wrong::Memory);
    }
    let bands = Bands { frame, area, lines };
    match sharing {
        Sharing::Relay => relay(&bands, interface, [&mut **front, &mut **back], near, harts),
        Sharing::Both | Sharing::One => {
            let step = if sharing == Sharing::Both { 2 } else { 1 };
            let bus = Turns::new((interface, Ok(())));
            let (mut one, mut other) = (Ok(()), Ok(()));
            let mut here = || one = bands.share(&bus, 0, step, front, near);
            if sharing == Sharing::Both {
                harts.join(&mut here, &mut || other = bands.share(&bus, 1, step, back, far));
            } else {
                here();
            }
            one.and(other).and(bus.into_inner().1)
        }
    }
}

/// Draws on this hart what the other sends.
fn relay<I: BlockingInterface<Error: Send> + Send>(
    bands: &Bands<'_>,
    interface: &mut I,
    colour: [&mut [u16]; 2],
    depth: &mut [u16],
    harts: &impl Harts,
) -> Outcome {
    let slots = colour.map(Turns::new);
    let (mut drawn, mut sent) = (Ok(()), Ok(()));
    let mut draw = || {
        for band in 0..bands.count() {
            slots[band % 2]
                .take(band / 2 * 2, |colour| bands.draw(band, colour, depth, &mut drawn));
        }
    };
    let mut send = || {
        for band in 0..bands.count() {
            let turn = band / 2 * 2 + 1;
            slots[band % 2].take(turn, |colour| bands.send(band, colour, interface, &mut sent));
        }
    };
    harts.join(&mut draw, &mut send);
    drawn.and(sent)
}

/// A frame cut into bands of some lines.
struct Bands<'f> {
    frame: &'f Frame<'f>,
    area: Area,
    lines: u16,
}

impl Bands<'_> {
    fn count(&self) -> usize {
        self.frame.settings().height.div_ceil(self.lines).into()
    }

    /// The rows of a band, and its part of a buffer of colour.
    fn of<'c>(&self, band: usize, colour: &'c mut [u16]) -> (Range<u16>, &'c mut [u16]) {
        let rows = rows(band, self.lines, self.frame.settings().height);
        let pixels = rows.len() * usize::from(self.frame.settings().width);
        (rows, &mut colour[..pixels])
    }

    #[inline(never)]
    fn draw(&self, band: usize, colour: &mut [u16], depth: &mut [u16], outcome: &mut Outcome) {
        let (rows, colour) = self.of(band, colour);
        if self.frame.draw_rows_rgb565(rows, colour, depth).is_err() {
            *outcome = Err(Wrong::Memory);
        }
    }

    /// Sends a band, unless one before it failed.
    #[inline(never)]
    fn send<I: BlockingInterface>(
        &self,
        band: usize,
        colour: &mut [u16],
        interface: &mut I,
        outcome: &mut Outcome,
    ) {
        let (rows, colour) = self.of(band, colour);
        if outcome.is_ok() {
            *outcome = match flush(interface, self.area, rows.start, colour) {
                Ok(()) => Ok(()),
                Err(SendError::Bus(_)) => Err(Wrong::Bus),
                Err(_) => Err(Wrong::Memory),
            };
        }
    }

    /// Draws and sends every `step`th band from `first` on; the bus is used by band k at its turn k.
    #[inline(never)]
    fn share<I: BlockingInterface>(
        &self,
        bus: &Turns<(&mut I, Outcome)>,
        first: usize,
        step: usize,
        colour: &mut [u16],
        depth: &mut [u16],
    ) -> Outcome {
        let mut drawn = Ok(());
        for band in (first..self.count()).step_by(step) {
            self.draw(band, colour, depth, &mut drawn);
            bus.take(band, |(interface, sent)| self.send(band, colour, *interface, sent));
        }
        drawn
    }
}

/// The rows of band `index`; empty beyond the last.
fn rows(index: usize, lines: u16, height: u16) -> Range<u16> {
    let top = (index * usize::from(lines)).min(height.into()) as u16;
    top..height.min(top.saturating_add(lines))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_come_in_order() {
        let cell = Turns::new(std::vec::Vec::new());
        std::thread::scope(|scope| {
            for first in [3, 1, 2, 0] {
                let cell = &cell;
                scope.spawn(move || {
                    for turn in (first..4000).step_by(4) {
                        cell.take(turn, |order| order.push(turn));
                    }
                });
            }
        });
        assert!(cell.take(4000, |order| order.iter().copied().eq(0..4000)));
    }

    #[test]
    fn a_mailbox_runs_both_jobs_and_waits() {
        static MAILBOX: Mailbox = Mailbox::new();
        std::thread::spawn(|| MAILBOX.serve());
        let (mut here, mut there) = (0u32, 0u32);
        for round in 1..=1000 {
            MAILBOX.join(&mut || here += 1, &mut || there += 2);
            assert_eq!((here, there), (round, 2 * round));
        }
    }

    #[test]
    fn bands_cover_the_frame() {
        for lines in [1, 7, 16, 239, 240, 241] {
            let mut next = 0;
            for band in 0..usize::from(240u16.div_ceil(lines)) {
                let rows = rows(band, lines, 240);
                assert!(rows.start == next && rows.end > next);
                next = rows.end;
            }
            assert_eq!(next, 240);
            assert!(rows(999, lines, 240).is_empty());
        }
    }
}
