//! Threads that stay, and a frame divided among them.
//!
//! A frame has three steps - transform and light, cull, draw - and each is handed out in parts, more than there are threads: a
//! thread takes the next part when it has finished one. The caller's thread works too, so one thread needs no other.

use std::cell::RefCell;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};
use scanout::frame::{BandError, Frame, Needed, Part, Preparation, PrepareError, Settings, Store};
use scanout::output::PixelFormat;
use scanout::scene::Scene;

/// Parts of a step for each thread, so that none waits long for another.
const PARTS: usize = 4;
/// Bands for each thread: no more than one, for each band looks through all primitives and sets up again those on its border
/// (3 % of a frame of 48,000 triangles); they are cut to hold equal work.
const BANDS: usize = 1;
/// Scenes with fewer vertices and primitives are prepared by one thread: waking another takes longer.
const LEAST: usize = 2000;

/// A number of threads that work together.
#[derive(Clone, Debug)]
pub struct Threads {
    count: usize,
    /// The caller's thread and the others; none for one thread.
    pool: Option<Arc<ThreadPool>>,
}

thread_local! {
    /// A thread can belong to one pool.
    static POOL: RefCell<Option<Arc<ThreadPool>>> = const { RefCell::new(None) };
}

impl Threads {
    /// This many threads, at least one, of which the caller's is one. The others are started when they are first asked for, as many
    /// as there are processors or were asked for then; they stay, and nobody who asks later gets more.
    pub fn get(count: usize) -> Threads {
        let start = || {
            let all = count.max(super::processors());
            let pool = ThreadPoolBuilder::new().num_threads(all).use_current_thread().build();
            pool.ok().map(Arc::new)
        };
        let pool = (count > 1).then(|| {
            POOL.with_borrow_mut(|pool| {
                *pool = pool.take().or_else(start);
                pool.clone()
            })
        });
        let pool = pool.flatten();
        let most = pool.as_ref().map_or(1, |pool| pool.current_num_threads());
        Threads { count: count.clamp(1, most), pool }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Hands out items; each is worked on once. A panic of one thread becomes the caller's.
    fn run<T: Send>(&self, items: impl Iterator<Item = T> + Send, work: impl Fn(T) + Sync) {
        let Some(pool) = &self.pool else { return items.for_each(work) };
        let queue = Mutex::new(items);
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
        let all = || {
            while let Some(item) = next() {
                work(item);
            }
        };
        // The caller belongs to the pool, so what the others have not begun by the end it takes back: on a busy machine it
        // waits for nobody who is not at work.
        pool.in_place_scope(|scope| {
            for _ in 1..self.count {
                scope.spawn(|_| all());
            }
            all();
        });
    }

    /// Memory for the parts in which these threads prepare a scene.
    pub fn parts(&self, scene: &Scene) -> Vec<Part> {
        let needed = Needed::at_most(scene);
        let divide = self.pool.is_some() && needed.vertices + needed.primitives >= LEAST;
        vec![Part::default(); if divide { self.count * PARTS } else { 0 }]
    }

    /// [`Frame::prepare`] with all threads; `parts` is what [`parts`](Self::parts) gave.
    ///
    /// # Errors
    /// As [`Frame::prepare`].
    pub fn prepare<'a>(
        &self,
        scene: &'a Scene<'a>,
        settings: Settings,
        store: Store<'a>,
        parts: &'a mut [Part],
    ) -> Result<Frame<'a>, PrepareError> {
        let mut preparation = Preparation::new(scene, settings, store, parts)?;
        self.run(preparation.vertex_parts(), |part| part.run());
        self.run(preparation.primitive_parts(), |part| part.run());
        preparation.finish()
    }

    /// The rows of a frame in bands of about equal work, as many as these threads draw well.
    pub fn bands(&self, frame: &Frame) -> Vec<Range<u16>> {
        let count = if self.pool.is_some() { self.count * BANDS } else { 1 };
        frame.bands(count as u16).collect()
    }

    /// Draws bands, which follow one another from the top, into `colour`, `F::words(width)` a row, and `depth`, `width` a row.
    ///
    /// # Errors
    /// When the memory is too short for the bands, or these are not the frame's.
    pub fn draw<F: PixelFormat>(
        &self,
        frame: &Frame,
        bands: &[Range<u16>],
        colour: &mut [F::Word],
        depth: &mut [u16],
    ) -> Result<(), BandError> {
        let width = usize::from(frame.settings().width);
        let (mut colours, mut depths) = (colour, depth);
        let pieces = bands.iter().map(|rows| {
            let colour = split_off(&mut colours, rows.len() * F::words(width));
            let depth = split_off(&mut depths, rows.len() * width);
            (rows.clone(), colour, depth)
        });
        let outcome = Mutex::new(Ok(()));
        self.run(pieces, |(rows, colour, depth)| {
            if let Err(error) = frame.draw_rows::<F>(rows, colour, depth) {
                *outcome.lock().unwrap_or_else(PoisonError::into_inner) = Err(error);
            }
        });
        outcome.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The first words of a slice, which loses them; fewer where it has fewer: drawing tells what is missing.
fn split_off<'a, T>(from: &mut &'a mut [T], words: usize) -> &'a mut [T] {
    let all = std::mem::take(from);
    let (first, rest) = all.split_at_mut(words.min(all.len()));
    *from = rest;
    first
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn every_item_once_by_any_number_of_threads() {
        for count in [5, 2, 1, 0] {
            let threads = Threads::get(count);
            let seen: Vec<_> = (0..100).map(|_| AtomicU32::new(0)).collect();
            for round in 1..50 {
                threads.run(0..100, |i: usize| {
                    seen[i].fetch_add(1, Ordering::Relaxed);
                });
                assert!(seen.iter().all(|n| n.load(Ordering::Relaxed) == round), "{count}");
            }
        }
        assert_eq!(Threads::get(0).count(), 1);
        assert_eq!(Threads::get(2).count(), 2);
    }

    #[test]
    #[should_panic(expected = "seven")]
    fn a_panic_is_the_callers() {
        Threads::get(3).run(0..10, |i| assert!(i != 7, "seven"));
    }
}
