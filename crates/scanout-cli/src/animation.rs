//! Moving pictures: GIF with a palette for each frame, APNG, or a folder of PNGs.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::image_out::{self, Picture, png_error};

/// The containers of a moving picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    /// GIF, 256 colours a frame.
    Gif,
    /// Animated PNG, exact colours.
    Apng,
    /// `frame-0000.png`, `frame-0001.png`, ... in a folder.
    Folder,
}

/// The container for `path`: `-` and `.gif` are GIF, `.png` and `.apng` APNG, a name without ending a folder.
pub fn container_for(path: &Path) -> Result<Container> {
    if image_out::is_dash(path) || image_out::is_discard(path) {
        return Ok(Container::Gif);
    }
    match image_out::ending(path).as_str() {
        _ if path.is_dir() => Ok(Container::Folder),
        "gif" => Ok(Container::Gif),
        "png" | "apng" => Ok(Container::Apng),
        "" => Ok(Container::Folder),
        _ => Err(Error::usage(
            format_args!("{}: no moving picture for this name", path.display()),
            "end it in .gif or .png, or name a folder",
        )),
    }
}

/// A frame ready to be written; making it is the costly part and may happen on any thread.
pub enum Encoded {
    /// With its palette.
    Gif(Box<gif::Frame<'static>>),
    /// As it is.
    Picture(Picture),
}

/// Prepares a frame for a container.
///
/// # Panics
/// When a GIF's side exceeds 65,535 pixels, which [`crate::values::Resolution`] excludes.
pub fn encode(container: Container, picture: Picture, delay: u16) -> Encoded {
    if container != Container::Gif {
        return Encoded::Picture(picture);
    }
    let (w, h) = (picture.width as u16, picture.height as u16);
    let mut frame = gif::Frame::from_rgb_speed(w, h, picture.pixels.as_flattened(), 10);
    frame.delay = delay;
    frame.make_lzw_pre_encoded();
    Encoded::Gif(Box::new(frame))
}

/// A moving picture being written.
pub struct Writer {
    path: PathBuf,
    kind: Kind,
}

enum Kind {
    Gif(gif::Encoder<Box<dyn Write>>),
    Apng(png::Writer<BufWriter<File>>),
    Folder(usize),
}

impl Writer {
    /// Begins a moving picture of `frames` frames that loops for ever, `fps` a second (GIF counts in 1/100 s).
    pub fn create(path: &Path, size: (usize, usize), frames: u32, fps: u16) -> Result<Self> {
        let kind = match container_for(path)? {
            Container::Gif => Self::gif(image_out::open(path)?, size),
            Container::Apng => Self::apng(path, size, frames, fps),
            Container::Folder => {
                image_out::create_folder(path, "end the name in .gif or .png, or name a folder")?;
                Ok(Kind::Folder(0))
            }
        };
        let kind = kind.map_err(|error| Error::io(path, &error))?;
        Ok(Self { path: path.into(), kind })
    }

    fn gif(sink: Box<dyn Write>, (w, h): (usize, usize)) -> io::Result<Kind> {
        let mut encoder = gif::Encoder::new(sink, w as u16, h as u16, &[]).map_err(gif_error)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(gif_error)?;
        Ok(Kind::Gif(encoder))
    }

    fn apng(path: &Path, (w, h): (usize, usize), frames: u32, fps: u16) -> io::Result<Kind> {
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, w as u32, h as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(frames, 0).map_err(png_error)?;
        encoder.set_frame_delay(1, fps).map_err(png_error)?;
        Ok(Kind::Apng(encoder.write_header().map_err(png_error)?))
    }

    /// Adds the next frame.
    pub fn push(&mut self, frame: &Encoded) -> Result<()> {
        let done = match (&mut self.kind, frame) {
            (Kind::Gif(encoder), Encoded::Gif(frame)) => {
                encoder.write_lzw_pre_encoded_frame(frame).map_err(gif_error)
            }
            (Kind::Apng(writer), Encoded::Picture(picture)) => {
                writer.write_image_data(picture.pixels.as_flattened()).map_err(png_error)
            }
            (Kind::Folder(next), Encoded::Picture(picture)) => {
                let path = self.path.join(format!("frame-{next:04}.png"));
                *next += 1;
                File::create(path).and_then(|file| {
                    let mut sink = BufWriter::new(file);
                    image_out::png(&mut sink, picture)?;
                    sink.flush()
                })
            }
            _ => unreachable!("frames are encoded for the writer's container"),
        };
        done.map_err(|error| Error::io(&self.path, &error))
    }

    /// Ends the moving picture.
    pub fn finish(self) -> Result<()> {
        let done = match self.kind {
            Kind::Gif(encoder) => {
                encoder.into_inner().map_err(gif_error).and_then(|mut sink| sink.flush())
            }
            Kind::Apng(writer) => writer.finish().map_err(png_error),
            Kind::Folder(_) => Ok(()),
        };
        done.map_err(|error| Error::io(&self.path, &error))
    }
}

fn gif_error(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}
