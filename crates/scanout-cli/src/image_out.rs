//! Pictures in files: PNG, PPM (P6) and raw, to a file or to standard output.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::args::OutputFormat;
use crate::error::{Error, Result};

/// A picture of 8 bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// R, G, B, rows from the top; `width * height` of them.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(width: usize, height: usize, rgb: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![rgb; width * height] }
    }

    /// Its rows, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[[u8; 3]]> {
        self.pixels.chunks_exact(self.width)
    }

    /// Stretched to another size, the nearest pixel for each; the same picture when the size is.
    pub fn stretched(&self, width: usize, height: usize) -> Self {
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let row = (2 * y + 1) * self.height / (2 * height) * self.width;
            pixels.extend(
                (0..width).map(|x| self.pixels[row + (2 * x + 1) * self.width / (2 * width)]),
            );
        }
        Self { width, height, pixels }
    }
}

/// Is this path the sign for standard input or output?
pub fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Is this where bytes go to vanish?
pub fn is_discard(path: &Path) -> bool {
    path.as_os_str() == "/dev/null"
}

/// Do both names mean one file that exists? Devices and standard output are no files.
pub fn same_file(a: &Path, b: &Path) -> bool {
    let real = |path: &Path| path.canonicalize().ok().filter(|path| path.is_file());
    !is_dash(a) && !is_dash(b) && (a == b || real(a).is_some_and(|a| Some(a) == real(b)))
}

/// Makes a folder and those above it, unless it is there.
pub fn create_folder(path: &Path, remedy: &str) -> Result<()> {
    fs::create_dir_all(path).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
            Error::failed(path.display(), "is not a folder", remedy)
        }
        _ => Error::io(path, &error),
    })
}

/// A file or standard output, buffered.
pub fn open(path: &Path) -> Result<Box<dyn Write>> {
    if is_dash(path) {
        return Ok(Box::new(BufWriter::new(io::stdout().lock())));
    }
    let file = File::create(path).map_err(|error| Error::io(path, &error))?;
    Ok(Box::new(BufWriter::new(file)))
}

/// The lower-case ending of a file's name, or nothing.
pub fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// The format for `path`: `forced`, or by its ending; `-` means PNG.
pub fn format_for(path: &Path, forced: Option<OutputFormat>) -> Result<OutputFormat> {
    if let Some(format) = forced {
        return Ok(format);
    }
    if is_dash(path) {
        return Ok(OutputFormat::Png);
    }
    if is_discard(path) {
        return Ok(OutputFormat::Raw);
    }
    match ending(path).as_str() {
        "png" => Ok(OutputFormat::Png),
        "ppm" | "pnm" => Ok(OutputFormat::Ppm),
        "raw" | "bin" => Ok(OutputFormat::Raw),
        _ => Err(Error::usage(
            format_args!("{}: no format for this name", path.display()),
            "end it in .png, .ppm or .raw, or give --output-format",
        )),
    }
}

/// Writes a picture; `raw` holds the bytes for [`OutputFormat::Raw`].
pub fn write(path: &Path, format: OutputFormat, picture: &Picture, raw: &[u8]) -> Result<()> {
    let mut sink = open(path)?;
    encode(&mut sink, format, picture, raw)
        .and_then(|()| sink.flush())
        .map_err(|error| Error::io(path, &error))
}

fn encode(
    sink: &mut dyn Write,
    format: OutputFormat,
    picture: &Picture,
    raw: &[u8],
) -> io::Result<()> {
    match format {
        OutputFormat::Png => png(sink, picture),
        OutputFormat::Ppm => {
            write!(sink, "P6\n{} {}\n255\n", picture.width, picture.height)?;
            sink.write_all(picture.pixels.as_flattened())
        }
        OutputFormat::Raw => sink.write_all(raw),
    }
}

/// Encodes a PNG of 8 bits a channel without colour space, so that equal pixels give equal files.
pub fn png(sink: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    let mut encoder = png::Encoder::new(sink, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(png_error)?;
    writer.write_image_data(picture.pixels.as_flattened()).map_err(png_error)?;
    writer.finish().map_err(png_error)
}

/// The input or output error inside a PNG error, so that a closed pipe is known as one.
pub fn png_error(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checks() -> Picture {
        let pixels = (0..6).map(|i| [i as u8 * 40, 255 - i as u8, 7]).collect();
        Picture { width: 3, height: 2, pixels }
    }

    #[test]
    fn ppm_is_p6() {
        let mut out = Vec::new();
        encode(&mut out, OutputFormat::Ppm, &checks(), &[]).unwrap();
        assert!(out.starts_with(b"P6\n3 2\n255\n\x00\xff\x07"));
        assert_eq!(out.len(), 11 + 18);
    }

    #[test]
    fn stretching_keeps_whole_multiples() {
        let twice = checks().stretched(6, 4);
        assert_eq!(twice.stretched(3, 2), checks());
        assert_eq!(checks().stretched(3, 2), checks());
        assert_eq!(twice.pixels[0], twice.pixels[7]);
    }

    #[test]
    fn formats_by_name() {
        let of = |name: &str| format_for(Path::new(name), None).ok();
        assert_eq!(of("a.PNG"), Some(OutputFormat::Png));
        assert_eq!(of("-"), Some(OutputFormat::Png));
        assert_eq!(of("x.y/a.ppm"), Some(OutputFormat::Ppm));
        assert_eq!(of("a.jpg"), None);
        assert_eq!(of("/dev/null"), Some(OutputFormat::Raw));
    }
}
