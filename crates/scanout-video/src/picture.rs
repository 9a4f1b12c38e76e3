//! Single pictures: PNG, JPEG, PPM and PGM, told by content.

use std::io::{Cursor, Write};
use std::path::Path;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::error::{VideoError, name_of};
use crate::frame::Frame;
use crate::ppm;

/// Longest side of a picture, pixels.
pub(crate) const SIDE: usize = 8192;

/// Reads a picture from a file.
///
/// # Errors
/// [`VideoError`], a line.
pub fn read_picture(path: &Path) -> Result<Frame, VideoError> {
    let name = name_of(path);
    let bytes = std::fs::read(path).map_err(|error| VideoError::io(&name, &error))?;
    decode_picture(&bytes)
        .map_err(|what| VideoError::end(&name, what, "convert it to PNG, JPEG or PPM"))
}

/// Reads a picture from bytes.
///
/// # Errors
/// What is wrong, without a name.
pub fn decode_picture(bytes: &[u8]) -> Result<Frame, String> {
    if bytes.starts_with(b"\x89PNG") {
        png(bytes)
    } else if bytes.starts_with(&[0xff, 0xd8]) {
        jpeg(bytes)
    } else if bytes.starts_with(b"P5") || bytes.starts_with(b"P6") {
        match ppm::read(&mut Cursor::new(bytes)) {
            Ok(Some(frame)) => Ok(frame),
            Ok(None) => Err("PPM: it is empty".into()),
            Err(error) => Err(error.to_string()),
        }
    } else if bytes.is_empty() {
        Err("it is empty".into())
    } else {
        Err("it is no picture that this program reads".into())
    }
}

pub(crate) fn jpeg(bytes: &[u8]) -> Result<Frame, String> {
    let options = DecoderOptions::default()
        .set_max_width(SIDE)
        .set_max_height(SIDE)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let damaged = |_| "JPEG: it is damaged".to_string();
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().ok_or("JPEG: it has no size")?;
    let data = decoder.decode().map_err(damaged)?;
    let (pixels, rest) = data.as_chunks::<3>();
    if pixels.len() != width * height || !rest.is_empty() {
        return Err("JPEG: it is damaged".into());
    }
    Ok(Frame { width, height, rgb: pixels.to_vec(), time: 0.0 })
}

fn png(bytes: &[u8]) -> Result<Frame, String> {
    let damaged = |_| "PNG: it is damaged".to_string();
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(damaged)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.max(height) > SIDE {
        return Err(format!("PNG: {width} x {height} is larger than {SIDE} pixels"));
    }
    let size = reader.output_buffer_size().ok_or("PNG: it is too large")?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data).map_err(damaged)?;
    let rgb: Vec<[u8; 3]> = match reader.output_color_type().0 {
        png::ColorType::Grayscale => data.iter().map(|&grey| [grey; 3]).collect(),
        png::ColorType::GrayscaleAlpha => data.chunks_exact(2).map(|p| [p[0]; 3]).collect(),
        png::ColorType::Rgb => data.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
        png::ColorType::Rgba => data.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect(),
        png::ColorType::Indexed => return Err("PNG: its palette is missing".into()),
    };
    Ok(Frame { width, height, rgb, time: 0.0 })
}

/// Writes a PNG of 8 bits a channel.
///
/// # Errors
/// Failures to write.
pub fn write_png(to: impl Write, frame: &Frame) -> std::io::Result<()> {
    let mut encoder = png::Encoder::new(to, frame.width as u32, frame.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let failed = |error| match error {
        png::EncodingError::IoError(error) => error,
        other => std::io::Error::other(other),
    };
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(frame.rgb.as_flattened()).map_err(failed)?;
    writer.finish().map_err(failed)
}
