//! From a shot to a frame: drives the pipeline, puts two eyes together, converts formats, hashes.
//!
//! The law makes this easy: bands of any height, on any number of threads, give the same pixels.

mod pipeline;
mod threads;

use std::num::NonZero;

use scanout::hash::FrameHash;
use scanout::output::{Mono, PixelFormat, Rgb332, Rgb565, Rgb888};

pub use pipeline::{Report, memory};
pub use threads::Threads;

use crate::args;
use crate::error::Result;
use crate::image_out::Picture;
use crate::scene_builder::{Shot, Stage};
use crate::stereo;

/// How a frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Pixels as the display takes them.
    pub format: args::PixelFormat,
    /// Ordered dither.
    pub dither: bool,
    /// Lines in a band, at least 1; bands of equal work, by threads, when `None`.
    pub bands: Option<u16>,
    /// Threads that draw, at least 1.
    pub threads: usize,
}

impl Options {
    /// From the command line.
    pub fn new(args: &args::PictureArgs) -> Self {
        Self {
            format: args.format,
            dither: args.dither,
            bands: args.bands,
            threads: args.threads.map_or_else(processors, usize::from),
        }
    }
}

/// Processors that this program may use.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// A finished frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its pixels, widened to 8 bits a channel.
    pub picture: Picture,
    /// Its bytes as a display takes them.
    pub bytes: Vec<u8>,
    /// See [`scanout::hash`].
    pub hash: u64,
    /// Counts and times, one an eye.
    pub reports: Vec<Report>,
}

/// Draws a shot.
///
/// # Errors
/// A camera that can't be, or what the pipeline refuses.
pub fn frame(stage: &Stage, shot: &Shot, options: &Options) -> Result<Frame> {
    match options.format {
        args::PixelFormat::Rgb888 => frame_as::<Rgb888>(stage, shot, options),
        args::PixelFormat::Rgb565 => frame_as::<Rgb565>(stage, shot, options),
        args::PixelFormat::Rgb332 => frame_as::<Rgb332>(stage, shot, options),
        args::PixelFormat::Mono => frame_as::<Mono>(stage, shot, options),
    }
}

/// Draws a shot for a screen that takes 8 bits a channel: the picture alone.
///
/// # Errors
/// As [`frame`].
pub fn picture(stage: &Stage, shot: &Shot, options: &Options) -> Result<Picture> {
    let (width, height) = (shot.size.0.into(), shot.size.1.into());
    let words = words::<Rgb888>(stage, shot, options)?.0;
    Ok(Picture { width, height, pixels: words })
}

/// Draws one eye's scene: its colour memory, `F::words(width)` words a row.
///
/// # Errors
/// What the pipeline refuses.
pub fn scene<F: PixelFormat>(
    scene: &scanout::scene::Scene,
    size: (u16, u16),
    options: &Options,
) -> Result<Vec<F::Word>> {
    Ok(pipeline::draw::<F>(scene, size, options)?.0)
}

fn frame_as<F: PixelFormat>(stage: &Stage, shot: &Shot, options: &Options) -> Result<Frame> {
    let (words, reports) = words::<F>(stage, shot, options)?;
    let (width, height) = shot.size;
    let row = F::words(width.into());
    let mut bytes = Vec::with_capacity(words.len() * size_of::<F::Word>());
    for row in words.chunks(row) {
        F::bytes(row, width.into(), &mut |part| bytes.extend_from_slice(part));
    }
    let mut hash = FrameHash::new(width, height, F::ID);
    hash.update(&bytes);
    let load =
        |row: &[F::Word]| -> Vec<[u8; 3]> { (0..width.into()).map(|x| F::load(row, x)).collect() };
    let pixels = words.chunks(row).flat_map(load).collect();
    let picture = Picture { width: width.into(), height: height.into(), pixels };
    Ok(Frame { picture, bytes, hash: hash.finish(), reports })
}

/// The frame's colour memory. Two eyes are drawn with 8 bits a channel, put together, and converted then.
fn words<F: PixelFormat>(
    stage: &Stage,
    shot: &Shot,
    options: &Options,
) -> Result<(Vec<F::Word>, Vec<Report>)> {
    let Some((how, _)) = shot.view.stereo else {
        let mut eyes =
            stage.with_scenes(shot, |scene, size| pipeline::draw::<F>(scene, size, options))?;
        let (words, report) = eyes.remove(0);
        return Ok((words, vec![report]));
    };
    let eyes = stage.with_scenes(shot, |scene, (width, height)| {
        let (pixels, report) = pipeline::draw::<Rgb888>(scene, (width, height), options)?;
        Ok((Picture { width: width.into(), height: height.into(), pixels }, report))
    })?;
    let picture = stereo::compose(how, &eyes[0].0, &eyes[1].0);
    Ok((encode::<F>(&picture, options.dither), eyes.into_iter().map(|eye| eye.1).collect()))
}

/// A picture in a format's words.
fn encode<F: PixelFormat>(picture: &Picture, dither: bool) -> Vec<F::Word> {
    let row = F::words(picture.width);
    let mut words = vec![F::Word::default(); row * picture.height];
    for ((y, from), to) in picture.rows().enumerate().zip(words.chunks_mut(row)) {
        for (x, rgb) in from.iter().enumerate() {
            let pixel =
                if dither { F::encode_dithered(*rgb, x as i32, y as i32) } else { F::encode(*rgb) };
            F::store(to, x, pixel);
        }
    }
    words
}
