//! One scene through the pipeline, on several threads.

use std::fmt;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use scanout::frame::{self, BandError, Needed, ObjectState, Primitive, Settings, Store};
use scanout::output::PixelFormat;
use scanout::scene::Scene;
use scanout::transform::Vertex;

use super::Options;
use crate::error::{Error, Result};

/// What the pipeline counted and how long it took.
#[derive(Clone, Debug)]
pub struct Report {
    /// The pipeline's own counts.
    pub stats: frame::Stats,
    /// Memory for what was prepared, bytes.
    pub store: usize,
    /// Memory for one band, colour and depth, bytes.
    pub band: usize,
    /// Bands drawn.
    pub bands: usize,
    /// Threads that drew them.
    pub threads: usize,
    /// Transform, light, cull.
    pub prepare: Duration,
    /// Clip, setup, raster, interpolate, texture, depth, shade, output.
    pub draw: Duration,
}

/// Draws a scene of one eye: its colour memory, `F::words(width)` words a row, and the report.
pub fn draw<F: PixelFormat>(
    scene: &Scene,
    (width, height): (u16, u16),
    lines: u16,
    options: &Options,
) -> Result<(Vec<F::Word>, Report)> {
    let failed = |error: &dyn fmt::Display| Error::failed("scene", error, "change the options");
    let start = Instant::now();
    let needed = Needed::at_most(scene);
    let mut vertices = vec![Vertex::default(); needed.vertices];
    let mut primitives = vec![Primitive::default(); needed.primitives];
    let mut objects = vec![ObjectState::default(); needed.objects];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut objects };
    let settings = Settings { dither: options.dither, ..Settings::new(width, height) };
    let prepared = frame::Frame::prepare(scene, settings, store).map_err(|error| failed(&error))?;
    let prepare = start.elapsed();

    let start = Instant::now();
    let row = F::words(width.into());
    let mut words = vec![F::Word::default(); row * usize::from(height)];
    let bands = usize::from(height.div_ceil(lines));
    let threads = options.threads.min(bands);
    let mut depths = vec![0; threads * usize::from(width) * usize::from(lines)];
    draw_bands::<F>(&prepared, &mut words, &mut depths, lines).map_err(|error| failed(&error))?;
    let band =
        usize::from(lines) * (row * size_of::<F::Word>() + usize::from(width) * size_of::<u16>());
    let report = Report {
        stats: prepared.stats(),
        store: needed.bytes(),
        band,
        bands,
        threads,
        prepare,
        draw: start.elapsed(),
    };
    Ok((words, report))
}

/// Draws all rows of a prepared frame into `colour`, `F::words(width)` a row, in bands of `lines` lines. `depths` holds
/// the depth memory of one band, `width * lines` words, for each thread; a thread takes the next band when it has
/// finished one.
///
/// # Errors
/// When `colour` is too short for the frame, or `depths` for one band.
pub fn draw_bands<F: PixelFormat>(
    frame: &frame::Frame,
    colour: &mut [F::Word],
    depths: &mut [u16],
    lines: u16,
) -> std::result::Result<(), BandError> {
    let Settings { width, height, .. } = frame.settings();
    let rows = |band: usize| -> Range<u16> {
        let top = band as u16 * lines;
        top..top.saturating_add(lines).min(height)
    };
    let bands = colour.chunks_mut(F::words(width.into()) * usize::from(lines));
    let queue = Mutex::new(bands.enumerate());
    let work = |depth: &mut [u16]| -> std::result::Result<(), BandError> {
        loop {
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((band, colour)) = next else { return Ok(()) };
            frame.draw_rows::<F>(rows(band), colour, depth)?;
        }
    };
    let mut depths = depths.chunks_mut(usize::from(width) * usize::from(lines));
    let own = depths.next().unwrap_or_default();
    std::thread::scope(|scope| {
        let others: Vec<_> = depths.map(|depth| scope.spawn(|| work(depth))).collect();
        let mine = work(own);
        let all = others
            .into_iter()
            .map(|other| other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        all.fold(mine, |sum, one| sum.and(one))
    })
}

/// Bytes that a scene's prepared contents need at most.
pub fn memory(scene: &Scene) -> usize {
    Needed::at_most(scene).bytes()
}

impl Report {
    /// For `--json`: counts, bytes, microseconds.
    pub fn json(&self) -> serde_json::Value {
        let micros = |time: Duration| time.as_micros() as u64;
        serde_json::json!({
            "objects_culled": self.stats.objects_culled,
            "vertices": self.stats.vertices,
            "triangles": self.stats.triangles,
            "back_facing": self.stats.back_facing,
            "outside": self.stats.outside,
            "clipped": self.stats.clipped,
            "primitives": self.stats.primitives,
            "store_bytes": self.store,
            "band_bytes": self.band,
            "bands": self.bands,
            "threads": self.threads,
            "prepare_us": micros(self.prepare),
            "draw_us": micros(self.draw),
        })
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.stats;
        let mut line = |name: &str, value: &dyn fmt::Display, note: &str| {
            writeln!(f, "{name:<18}{value:>10}  {note}")
        };
        line("vertices", &s.vertices, "transform, light")?;
        line("triangles", &s.triangles, "looked at")?;
        line("back-facing", &s.back_facing, "cull: away or without area")?;
        line("outside", &s.outside, "cull: no pixel centre in the frame")?;
        line("objects culled", &s.objects_culled, "cull: whole meshes")?;
        line("clipped", &s.clipped, "clip: cut by near, far or guard band")?;
        line("primitives", &s.primitives, "drawn")?;
        line("store bytes", &self.store, "memory for what is prepared, at most")?;
        line("band bytes", &self.band, "colour and depth of one band")?;
        line("bands", &self.bands, "")?;
        line("threads", &self.threads, "")?;
        line("prepare us", &self.prepare.as_micros(), "transform, light, cull")?;
        let note = "clip, setup, raster, interpolate, texture, depth, shade, output";
        write!(f, "{:<18}{:>10}  {note}", "draw us", self.draw.as_micros())
    }
}
