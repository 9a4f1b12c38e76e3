//! `scanout lines --octants`: the 16 lines of system D, as a picture and as a table of pixels.
//!
//! One line in each octant and one on each border of two octants, from the middle of the picture, red at the start and
//! blue at the end. Lines are numbered counter-clockwise from the x axis: even ones are borders (0 to the right, 2 the
//! diagonal, 4 upwards, ...), odd ones lie in octants, with a slope of 2/5 or 5/2.
//!
//! ```text
//!      6  5 4 3  2
//!       \ | | | /            the table: one pixel a line of text,
//!     7 .\|.|.|/. 1              line x y r g b
//!     8 ---  +  --- 0        x to the right and y down from the top left corner,
//!     9 ./|.|.|\. 15         in order from the start to the end
//! ```

use std::io::Write as _;

use scanout::raster::line::{ClipRect, LineEnd, walk};

use crate::args::{LinesArgs, OutputFormat};
use crate::error::{Error, Result};
use crate::image_out::{self, Picture, is_dash};
use crate::narrate;

/// A pixel of a line: column, row, colour.
type Pixel = (i32, i32, [u8; 3]);

/// Draws the lines.
pub fn run(args: &LinesArgs) -> Result<()> {
    let dashes = [&args.output, &args.table].into_iter().flatten().filter(|path| is_dash(path));
    if dashes.count() > 1 {
        return Err(Error::usage(
            "picture and table can't both go to standard output",
            "name a file for one of them",
        ));
    }
    let (width, height) = (args.resolution.width, args.resolution.height);
    let format = match &args.output {
        Some(path) => Some(image_out::format_for(path, args.output_format)?),
        None => None,
    };
    let lines = octants(width, height);
    if let (Some(path), Some(format)) = (&args.output, format) {
        draw(&lines, width, height, format, path)?;
    }
    if let Some(path) = &args.table {
        let mut text = String::from("# line x y r g b\n");
        for (index, line) in lines.iter().enumerate() {
            for (x, y, [r, g, b]) in line {
                text.push_str(&format!("{index} {x} {y} {r} {g} {b}\n"));
            }
        }
        let mut sink = image_out::open(path)?;
        sink.write_all(text.as_bytes())
            .and_then(|()| sink.flush())
            .map_err(|error| Error::io(path, &error))?;
    }
    for path in [&args.output, &args.table].into_iter().flatten().filter(|path| !is_dash(path)) {
        narrate!("scanout: wrote {}", path.display());
    }
    Ok(())
}

fn draw(
    lines: &[Vec<Pixel>],
    width: u16,
    height: u16,
    format: OutputFormat,
    path: &std::path::Path,
) -> Result<()> {
    let mut picture = Picture::filled(width.into(), height.into(), [0; 3]);
    for (x, y, rgb) in lines.iter().flatten() {
        picture.pixels[*y as usize * picture.width + *x as usize] = *rgb;
    }
    image_out::write(path, format, &picture, picture.pixels.as_flattened())
}

/// The pixels of the 16 lines in a frame of this size, each from its start in the middle.
fn octants(width: u16, height: u16) -> Vec<Vec<Pixel>> {
    // Directions of the first quadrant, y upwards; a quarter turn makes each next four.
    const FIRST: [(i32, i32); 4] = [(5, 0), (5, 2), (5, 5), (2, 5)];
    let (cx, cy) = (i32::from(width) / 2, i32::from(height) / 2);
    let reach = i32::from(width.min(height)) / 2 - i32::from(width.min(height) > 16) * 4;
    let clip = ClipRect { x0: 0, y0: 0, x1: width.into(), y1: height.into() };
    let mut lines = Vec::new();
    for quarter in 0..4 {
        for (x, y) in FIRST {
            let (x, y) = (0..quarter).fold((x, y), |(x, y), _| (-y, x));
            let end = (cx + x * reach / 5, cy - y * reach / 5);
            let at = |(x, y), rgb| LineEnd { x, y, z: 0, rgb };
            let mut line: Vec<Pixel> = Vec::new();
            let (start, end) = (at((cx, cy), [255, 0, 0]), at(end, [0, 0, 255]));
            walk(&start, &end, clip, |x, y, _, rgb| line.push((x, y, rgb)));
            // The walk's direction is canonical; the table's is from the start.
            if line.first().is_some_and(|first| (first.0, first.1) != (cx, cy)) {
                line.reverse();
            }
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_lines_from_pure_red_to_pure_blue() {
        let lines = octants(241, 241);
        assert_eq!(lines.len(), 16);
        for line in &lines {
            assert_eq!(line.first(), Some(&(120, 120, [255, 0, 0])));
            assert_eq!(line.last().map(|pixel| pixel.2), Some([0, 0, 255]));
            let (dx, dy) = (line[line.len() - 1].0 - 120, line[line.len() - 1].1 - 120);
            assert_eq!(line.len() as i32, dx.abs().max(dy.abs()) + 1);
        }
        let ends: Vec<_> = lines.iter().map(|line| line[line.len() - 1]).collect();
        assert_eq!((ends[0].0, ends[0].1), (236, 120), "to the right");
        assert_eq!((ends[4].0, ends[4].1), (120, 4), "upwards");
        assert_eq!((ends[1].0, ends[1].1), (236, 120 - 46), "first octant");
    }

    #[test]
    fn tiny_pictures_hold() {
        for side in [1, 2, 15, 16, 17] {
            octants(side, side);
        }
    }
}
