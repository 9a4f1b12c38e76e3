//! Two harts make a frame: one renders and the other sends, as in system B, or both do both.
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
use core::sync::atomic::{AtomicUsize, Ordering};

use scanout::frame::{BandError, DrawError, Frame};
use scanout_display::band::SendError;
use scanout_display::flush::{BlockingInterface, flush};
use scanout_display::window::Area;

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
        let filling = (EMPTY, BEING_FILLED);
        while self
            .state
            .compare_exchange_weak(filling.0, filling.1, Ordering::Acquire, Ordering::Relaxed)
            .is_err()
        {
            wait();
        }
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
        while self
            .next
            .compare_exchange_weak(open, taken, Ordering::Acquire, Ordering::Relaxed)
            .is_err()
        {
            wait();
        }
        // SAFETY: this hart alone has taken the turn; see `Sync`.
        let result = with(unsafe { &mut *self.value.get() });
        self.next.store(taken + 1, Ordering::Release);
        result
    }
}

/// Memory for two harts.
#[derive(Debug)]
pub struct Buffers<'m> {
    /// Colour, one band each.
    pub colour: [&'m mut [u16]; 2],
    /// Depth, one band each; a relay uses the first.
    pub depth: [&'m mut [u16]; 2],
}

/// What a frame's bands come to.
type Shown<I> = Result<(), DrawError<SendError<<I as BlockingInterface>::Error>>>;

/// The rows of a band that the memory allows, or how much would be needed.
fn lines(frame: &Frame<'_>, memory: [usize; 4]) -> Result<u16, BandError> {
    let row = usize::from(frame.settings().width).max(1);
    match memory.into_iter().min().unwrap_or(0) / row {
        0 => Err(BandError::Memory { colour: row, depth: row }),
        lines => Ok(lines.min(u16::MAX.into()) as u16),
    }
}

/// The rows of band `index`; empty beyond the last.
fn rows(index: usize, lines: u16, height: u16) -> core::ops::Range<u16> {
    let top = (index * usize::from(lines)).min(height.into()) as u16;
    top..height.min(top.saturating_add(lines))
}

/// Draws on this hart what the other sends.
///
/// # Errors
/// When the memory is too small for a row, the frame doesn't fit the area, or the bus fails; the other bands are then drawn
/// and not sent.
pub fn relay<I: BlockingInterface<Error: Send> + Send>(
    frame: &Frame<'_>,
    interface: &mut I,
    area: Area,
    buffers: &mut Buffers<'_>,
    harts: &impl Harts,
) -> Shown<I> {
    let [front, back] = &mut buffers.colour;
    let depth = &mut *buffers.depth[0];
    let lines = lines(frame, [front.len(), back.len(), depth.len(), usize::MAX])
        .map_err(DrawError::Band)?;
    let (width, height) = (usize::from(frame.settings().width), frame.settings().height);
    let bands = usize::from(height.div_ceil(lines));
    let slots = [Turns::new(&mut **front), Turns::new(&mut **back)];
    let (mut drawn, mut sent) = (Ok(()), Ok(()));
    let mut draw = || {
        for band in 0..bands {
            let rows = rows(band, lines, height);
            // A band is drawn even after a failure: the other hart waits for its turn.
            let result = slots[band % 2].take(band / 2 * 2, |colour| {
                let colour = &mut colour[..rows.len() * width];
                frame.draw_rows_rgb565(rows, colour, depth)
            });
            drawn = drawn.and(result);
        }
    };
    let mut send = || {
        for band in 0..bands {
            let rows = rows(band, lines, height);
            slots[band % 2].take(band / 2 * 2 + 1, |colour| {
                if sent.is_ok() {
                    sent = flush(interface, area, rows.start, &mut colour[..rows.len() * width]);
                }
            });
        }
    };
    harts.join(&mut draw, &mut send);
    drawn.map_err(DrawError::Band)?;
    sent.map_err(DrawError::Sink)
}

/// Draws and sends on both harts, every second band each.
///
/// # Errors
/// As [`relay`].
pub fn both<I: BlockingInterface<Error: Send> + Send>(
    frame: &Frame<'_>,
    interface: &mut I,
    area: Area,
    buffers: &mut Buffers<'_>,
    harts: &impl Harts,
) -> Shown<I> {
    let ([front, back], [near, far]) = (&mut buffers.colour, &mut buffers.depth);
    let memory = [front.len(), back.len(), near.len(), far.len()];
    let lines = lines(frame, memory).map_err(DrawError::Band)?;
    let (width, height) = (usize::from(frame.settings().width), frame.settings().height);
    let bands = usize::from(height.div_ceil(lines));
    // The bus, and whether it still works.
    let bus = Turns::new((interface, Ok(())));
    let work = |first: usize, colour: &mut [u16], depth: &mut [u16]| {
        let mut drawn = Ok(());
        for band in (first..bands).step_by(2) {
            let rows = rows(band, lines, height);
            let colour = &mut colour[..rows.len() * width];
            drawn = drawn.and(frame.draw_rows_rgb565(rows.clone(), colour, depth));
            bus.take(band, |(interface, sent)| {
                if sent.is_ok() {
                    *sent = flush(*interface, area, rows.start, colour);
                }
            });
        }
        drawn
    };
    let (mut one, mut other) = (Ok(()), Ok(()));
    harts.join(&mut || one = work(0, front, near), &mut || other = work(1, back, far));
    one.and(other).map_err(DrawError::Band)?;
    bus.take(bands, |(_, sent)| core::mem::replace(sent, Ok(()))).map_err(DrawError::Sink)
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
