//! `--reference`: are two pictures equal, and where not?

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::image_out::Picture;

/// How two pictures of one size differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Pixels that differ.
    pub pixels: usize,
    /// The largest difference of a channel, 1 - 255.
    pub largest: u8,
    /// The first pixel that differs, column and row.
    pub first: (usize, usize),
    /// White to red where they differ (brighter = more), the picture dimmed elsewhere.
    pub picture: Picture,
}

/// Compares two pictures of one size; `None` when equal.
pub fn compare(got: &Picture, expected: &Picture) -> Option<Difference> {
    let mut picture = got.clone();
    let (mut pixels, mut largest, mut first) = (0, 0, None);
    for (i, (a, b)) in got.pixels.iter().zip(&expected.pixels).enumerate() {
        let most = (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
        picture.pixels[i] = if most == 0 { a.map(|v| v / 4) } else { [255, most, most] };
        if most > 0 {
            pixels += 1;
            largest = largest.max(most);
            first.get_or_insert((i % got.width, i / got.width));
        }
    }
    first.map(|first| Difference { pixels, largest, first, picture })
}

/// Reads a PNG or PPM (P6, 8 bits) picture.
pub fn read(path: &Path) -> Result<Picture> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| BufReader::new(file).read_to_end(&mut bytes))
        .map_err(|error| Error::io(path, &error))?;
    let picture = if bytes.starts_with(b"P6") { ppm(&bytes) } else { png(&bytes) };
    picture.map_err(|what| Error::failed(path.display(), what, "give a PNG, or a PPM (P6, 255)"))
}

fn ppm(bytes: &[u8]) -> std::result::Result<Picture, String> {
    let mut rest = &bytes[2..];
    let mut header = [0usize; 3];
    for value in &mut header {
        loop {
            rest = rest.trim_ascii_start();
            let Some(comment) = rest.strip_prefix(b"#") else { break };
            let end = comment.iter().position(|byte| *byte == b'\n').unwrap_or(comment.len());
            rest = &comment[end..];
        }
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let text = std::str::from_utf8(&rest[..digits]).unwrap_or_default();
        *value = text.parse().map_err(|_| "bad PPM header".to_string())?;
        rest = &rest[digits..];
    }
    let [width, height, most] = header;
    let data = rest.get(1..).unwrap_or_default();
    let wanted = width.checked_mul(height).and_then(|area| area.checked_mul(3));
    if most != 255 || wanted.is_none_or(|n| n == 0 || data.len() < n) {
        return Err("PPM cut short or not of 8 bits".into());
    }
    Ok(Picture { width, height, pixels: triples(&data[..3 * width * height]) })
}

/// R, G, B, R, G, B, ... as pixels.
pub fn triples(bytes: &[u8]) -> Vec<[u8; 3]> {
    bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

fn png(bytes: &[u8]) -> std::result::Result<Picture, String> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let size = reader.output_buffer_size().ok_or("too large")?;
    let mut data = vec![0; size];
    let info = reader.next_frame(&mut data).map_err(|error| error.to_string())?;
    let data = &data[..info.buffer_size()];
    let pixels = match info.color_type {
        png::ColorType::Rgb => triples(data),
        png::ColorType::Rgba => data.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect(),
        png::ColorType::Grayscale => data.iter().map(|v| [*v; 3]).collect(),
        png::ColorType::GrayscaleAlpha => data.chunks_exact(2).map(|p| [p[0]; 3]).collect(),
        png::ColorType::Indexed => return Err("palette left unexpanded".into()),
    };
    Ok(Picture { width: info.width as usize, height: info.height as usize, pixels })
}

/// Where the difference picture goes: beside `output`, or here with the reference's name.
pub fn difference_path(output: Option<&Path>, reference: &Path) -> PathBuf {
    match output.filter(|path| !crate::image_out::is_dash(path)) {
        Some(path) => path.with_extension("difference.png"),
        None => {
            let stem = reference.file_stem().unwrap_or_default();
            Path::new(stem).with_extension("difference.png")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_have_no_difference() {
        let picture = Picture::filled(4, 3, [9, 8, 7]);
        assert_eq!(compare(&picture, &picture), None);
    }

    #[test]
    fn one_pixel_is_found() {
        let a = Picture::filled(4, 3, [9, 8, 7]);
        let mut b = a.clone();
        b.pixels[6] = [9, 18, 6];
        let difference = compare(&b, &a).unwrap();
        assert_eq!((difference.pixels, difference.largest, difference.first), (1, 10, (2, 1)));
        assert_eq!(difference.picture.pixels[6], [255, 10, 10]);
        assert_eq!(difference.picture.pixels[0], [2, 2, 1]);
    }

    #[test]
    fn ppm_with_comment_and_cut_ppm() {
        let good = ppm(b"P6 # made by hand\n1 2\n255\nabcdef").unwrap();
        assert_eq!(good.pixels, [*b"abc", *b"def"]);
        assert!(ppm(b"P6 1 2 255 abcde").is_err());
        assert!(ppm(b"P6").is_err());
        assert!(ppm(b"P6 99999999999 99999999999 255 a").is_err());
    }

    #[test]
    fn png_round_trip() {
        let mut picture = Picture::filled(5, 2, [1, 2, 3]);
        picture.pixels[3] = [255, 0, 128];
        let mut bytes = Vec::new();
        crate::image_out::png(&mut bytes, &picture).unwrap();
        assert_eq!(png(&bytes).unwrap(), picture);
    }
}
