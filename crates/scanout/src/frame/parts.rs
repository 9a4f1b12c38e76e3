//! Preparing in parts, for several threads: the same frame, whoever prepares which part.
//!
//! ```text
//!               vertex parts            primitive parts
//!   new ----+-- transform, light --+--- cull, list ---+---- finish
//!           +-- transform, light --+--- cull, list ---+
//!           +-- ...             all before any        +
//! ```
//!
//! Vertices and primitives are divided by number, whatever object they belong to. Each part has its own piece of the store's
//! primitives; drawing goes from piece to piece, so the order is that of the scene and nothing is moved. Differences from
//! [`Frame::prepare`] that no pixel shows: without AVX2 all vertices of mode `Gouraud` are lit, not only those that are needed.

use core::mem::take;
use core::ops::Range;

use super::prepare::{List, Outline, TOGETHER, most_primitives};
use super::{Frame, PrepareError, Primitive, Settings, Stats, Store};
use crate::scene::{Mode, Scene};
use crate::transform::Vertex;

/// Memory of [`Preparation`] for one part: what it has listed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part {
    state: State,
    /// Its place in the store's primitives.
    first: usize,
    /// How many primitives it has listed, and room for as many.
    listed: usize,
    stats: Stats,
}

/// How far a part has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum State {
    #[default]
    New,
    Transformed,
    /// Its list is complete.
    Listed,
}

impl Part {
    /// Its primitives in the store.
    pub(super) fn listed(&self) -> Range<usize> {
        self.first..self.first + self.listed
    }
}

/// A frame being prepared, in as many parts as there is memory for: [`Frame::prepare`] divided.
///
/// First every [`VertexPart`] is run, then every [`PrimitivePart`], each on any thread, then the frame is finished. What has not
/// been run by then, [`finish`](Self::finish) makes good alone, so the frame is always right.
///
/// More parts than threads share the work more evenly. The store should hold [`Needed::at_most`](super::Needed::at_most): each part
/// gets its share of it for its list, and when one list does not fit, all is prepared anew in one.
///
/// ```
/// use scanout::frame::{Frame, Part, Preparation, PrepareError, Settings, Store};
/// use scanout::scene::Scene;
///
/// /// Prepares by a thread a part. (Programs that draw many frames keep their threads.)
/// fn prepare<'a>(
///     scene: &'a Scene<'a>,
///     settings: Settings,
///     store: Store<'a>,
///     parts: &'a mut [Part],
/// ) -> Result<Frame<'a>, PrepareError> {
///     let mut preparation = Preparation::new(scene, settings, store, parts)?;
///     std::thread::scope(|threads| {
///         for part in preparation.vertex_parts() {
///             threads.spawn(|| part.run());
///         }
///     });
///     std::thread::scope(|threads| {
///         for part in preparation.primitive_parts() {
///             threads.spawn(|| part.run());
///         }
///     });
///     preparation.finish()
/// }
/// ```
#[derive(Debug)]
pub struct Preparation<'a> {
    outline: Outline<'a>,
    vertices: &'a mut [Vertex],
    primitives: &'a mut [Primitive],
    parts: &'a mut [Part],
    /// Primitives at most, of the objects that are seen.
    most: usize,
}

impl<'a> Preparation<'a> {
    /// Checks the scene, computes the objects' matrices and which of them are seen. Without `parts` all is left to
    /// [`finish`](Self::finish).
    ///
    /// # Errors
    /// As [`Frame::prepare`]; what only a look at every primitive can tell, `finish` says.
    pub fn new(
        scene: &'a Scene<'a>,
        settings: Settings,
        store: Store<'a>,
        parts: &'a mut [Part],
    ) -> Result<Preparation<'a>, PrepareError> {
        let (outline, vertices, primitives) = Outline::new(scene, settings, store)?;
        parts.fill(Part::default());
        let most = outline.passes().map(|(pass, _)| most_primitives(pass.object)).sum();
        Ok(Preparation { outline, vertices, primitives, parts, most })
    }

    /// The first step's parts: transform and light. They may run at the same time.
    pub fn vertex_parts(&mut self) -> impl Iterator<Item = VertexPart<'_>> {
        let (outline, count) = (&self.outline, self.parts.len());
        let mut rest = &mut self.vertices[..outline.vertices];
        let mut first = 0;
        self.parts.iter_mut().enumerate().map(move |(k, part)| {
            let end = share(outline.vertices, k + 1, count);
            let (vertices, others) = take(&mut rest).split_at_mut(end - first);
            rest = others;
            let own = VertexPart { outline, first, vertices, part };
            first = end;
            own
        })
    }

    /// The second step's parts: cull. They may run at the same time, when all of the first step have run.
    pub fn primitive_parts(&mut self) -> impl Iterator<Item = PrimitivePart<'_>> {
        let (outline, most, count) = (&self.outline, self.most, self.parts.len());
        let ready = self.parts.iter().all(|part| part.state != State::New);
        let vertices = &self.vertices[..outline.vertices];
        let given = self.primitives.len();
        // Of a store that is smaller, everyone gets less.
        let place = move |number: usize| {
            if most <= given { number } else { share(given, number, most) }
        };
        let mut rest = &mut *self.primitives;
        let mut first = 0;
        self.parts.iter_mut().enumerate().map(move |(k, part)| {
            let end = cut(outline, share(most, k + 1, count));
            part.first = place(first);
            let (primitives, others) = take(&mut rest).split_at_mut(place(end) - part.first);
            rest = others;
            let numbers = first..end;
            first = end;
            PrimitivePart { outline, ready, numbers, vertices, primitives, part }
        })
    }

    /// The frame. Parts that have not run, and lists that did not fit, are made good here, by one thread.
    ///
    /// # Errors
    /// As [`Frame::prepare`], and the same.
    pub fn finish(self) -> Result<Frame<'a>, PrepareError> {
        let Preparation { outline, vertices, primitives, parts, .. } = self;
        if parts.is_empty() || parts.iter().any(|part| part.state != State::Listed) {
            return outline.prepare(vertices, primitives);
        }
        let seen = outline.passes().count();
        let mut stats =
            Stats { objects_culled: (outline.objects.len() - seen) as u32, ..Stats::default() };
        for part in &*parts {
            stats.triangles += part.stats.triangles;
            stats.back_facing += part.stats.back_facing;
            stats.outside += part.stats.outside;
            stats.clipped += part.stats.clipped;
            stats.primitives += part.listed as u32;
        }
        Ok(outline.frame(vertices, primitives, parts, stats))
    }
}

/// Some of a frame's vertices, of one object or several.
#[derive(Debug)]
pub struct VertexPart<'p> {
    outline: &'p Outline<'p>,
    /// Number of the first vertex.
    first: usize,
    vertices: &'p mut [Vertex],
    part: &'p mut Part,
}

impl VertexPart<'_> {
    /// Transforms and lights them.
    pub fn run(self) {
        let own = self.first..self.first + self.vertices.len();
        for (pass, first) in self.outline.passes() {
            let positions = overlap(&own, first, pass.object.mesh.positions.len());
            if !positions.is_empty() {
                let at = first + positions.start - self.first;
                let vertices = &mut self.vertices[at..at + positions.len()];
                pass.run_vertices(positions, vertices);
            }
        }
        self.part.state = State::Transformed;
    }
}

/// Some of a frame's triangles, edges and points, of one object or several.
#[derive(Debug)]
pub struct PrimitivePart<'p> {
    outline: &'p Outline<'p>,
    /// All vertex parts have run.
    ready: bool,
    /// Numbers of its primitives, were all of them kept.
    numbers: Range<usize>,
    vertices: &'p [Vertex],
    primitives: &'p mut [Primitive],
    part: &'p mut Part,
}

impl PrimitivePart<'_> {
    /// Culls them and lists what is left. Does nothing when a vertex part has not run.
    pub fn run(self) {
        if !self.ready {
            return;
        }
        self.part.state = State::Transformed;
        let mut list = List { primitives: self.primitives, len: 0, stats: Stats::default() };
        let mut first = 0;
        for (pass, first_vertex) in self.outline.passes() {
            let count = most_primitives(pass.object);
            let numbers = overlap(&self.numbers, first, count);
            first += count;
            if numbers.is_empty() {
                continue;
            }
            let end = first_vertex + pass.object.mesh.positions.len();
            let vertices = &self.vertices[first_vertex..end];
            if pass.run_primitives(numbers, vertices, &mut list).is_err() {
                return;
            }
        }
        if list.len <= list.primitives.len() {
            (self.part.listed, self.part.stats) = (list.len, list.stats);
            self.part.state = State::Listed;
        }
    }
}

/// `whole k / of`, rounded down; numbers of vertices and primitives are below 2^32.
fn share(whole: usize, k: usize, of: usize) -> usize {
    (whole as u64 * k as u64 / of as u64) as usize
}

/// What a range has in common with `count` numbers from `first` on, counted from there.
fn overlap(range: &Range<usize>, first: usize, count: usize) -> Range<usize> {
    let place = |n: usize| n.clamp(first, first + count) - first;
    place(range.start)..place(range.end)
}

/// Where primitives may be cut at or before a number: not within edges that may become one.
fn cut(outline: &Outline, number: usize) -> usize {
    let mut first = 0;
    for (pass, _) in outline.passes() {
        let object = pass.object;
        let count = most_primitives(object);
        if number < first + count {
            let mut kind = first;
            if object.mode == Mode::Hidden && number >= first + object.mesh.triangles.len() {
                kind += object.mesh.triangles.len();
            }
            return kind + (number - kind) / TOGETHER * TOGETHER;
        }
        first += count;
    }
    number
}
