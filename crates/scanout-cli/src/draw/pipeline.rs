//! One scene through the pipeline, on several threads.

use std::fmt;
use std::time::{Duration, Instant};

use scanout::frame::{self, Needed, ObjectState, Primitive, Settings, Store};
use scanout::output::PixelFormat;
use scanout::scene::Scene;
use scanout::transform::Vertex;

use super::{Options, Threads};
use crate::error::{Error, Result};

/// What the pipeline counted and how long it took.
#[derive(Clone, Debug)]
pub struct Report {
    /// The pipeline's own counts.
    pub stats: frame::Stats,
    /// Memory for what was prepared, bytes.
    pub store: usize,
    /// Memory for the highest band, colour and depth, bytes.
    pub band: usize,
    /// Bands drawn; together they have colour and depth memory for the whole frame.
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
    let threads = Threads::get(options.threads);
    let mut parts = threads.parts(scene);
    let prepared =
        threads.prepare(scene, settings, store, &mut parts).map_err(|error| failed(&error))?;
    let prepare = start.elapsed();

    let start = Instant::now();
    let row = F::words(width.into());
    let mut words = vec![F::Word::default(); row * usize::from(height)];
    let mut depth = vec![0; usize::from(width) * usize::from(height)];
    let bands = match options.bands {
        Some(lines) => {
            let tops = (0..height).step_by(lines.max(1).into());
            tops.map(|top| top..top.saturating_add(lines).min(height)).collect()
        }
        None => threads.bands(&prepared),
    };
    threads.draw::<F>(&prepared, &bands, &mut words, &mut depth).map_err(|error| failed(&error))?;
    let lines = bands.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
    let band = lines * (row * size_of::<F::Word>() + usize::from(width) * size_of::<u16>());
    let report = Report {
        stats: prepared.stats(),
        store: needed.bytes(),
        band,
        bands: bands.len(),
        threads: threads.count().min(bands.len()),
        prepare,
        draw: start.elapsed(),
    };
    Ok((words, report))
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
        line("band bytes", &self.band, "colour and depth of the highest band")?;
        line("bands", &self.bands, "")?;
        line("threads", &self.threads, "")?;
        line("prepare us", &self.prepare.as_micros(), "transform, light, cull")?;
        let note = "clip, setup, raster, interpolate, texture, depth, shade, output";
        write!(f, "{:<18}{:>10}  {note}", "draw us", self.draw.as_micros())
    }
}
