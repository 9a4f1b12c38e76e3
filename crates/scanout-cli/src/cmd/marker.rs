//! `scanout marker`: a marker to print, as PNG, SVG or PDF.
//!
//! ```text
//!  quiet |#|#|#|#|#|#| quiet        the black square, border and cells, is SIZE wide;
//!        |#| | |#| |#|              the paper around it must stay white
//! ```

use std::fmt::Write as _;
use std::io::Write as _;

use crate::args::ar::MarkerArgs;
use crate::error::{Error, Result};
use crate::image_out::{self, ending, png_error};
use crate::narrate;

/// The cells of a marker, border and quiet zone: true where black.
struct Sheet {
    /// Cells in a row of the sheet.
    side: usize,
    /// Cells in a row of the black square.
    square: usize,
    black: Vec<bool>,
}

/// Draws the marker.
pub fn run(args: &MarkerArgs) -> Result<()> {
    let sheet = Sheet::new(args);
    let millimetres = args.size.0 * 1000.0;
    let bytes = match ending(&args.output).as_str() {
        "png" => png(&sheet, args)?,
        "svg" => svg(&sheet, millimetres, &args.marker.to_string()).into_bytes(),
        "pdf" => pdf(&sheet, millimetres, &args.marker.to_string())?.into_bytes(),
        _ => {
            let what = format_args!("{}: no format for this name", args.output.display());
            return Err(Error::usage(what, "end it in .png, .svg or .pdf"));
        }
    };
    let mut sink = image_out::open(&args.output)?;
    sink.write_all(&bytes)
        .and_then(|()| sink.flush())
        .map_err(|error| Error::io(&args.output, &error))?;
    narrate!(
        "scanout: wrote {}: {}, its black square {millimetres} mm wide; print it at 100 % and measure it",
        args.output.display(),
        args.marker,
    );
    Ok(())
}

impl Sheet {
    fn new(args: &MarkerArgs) -> Self {
        let dictionary = args.marker.dictionary;
        let (square, quiet) = (usize::from(dictionary.side) + 2, usize::from(args.quiet));
        let side = square + 2 * quiet;
        let code = dictionary.code(args.marker.id.into()).unwrap_or(0);
        let inside = |i: usize| i.checked_sub(quiet).filter(|&i| i < square);
        let black = |i: usize| match (inside(i % side), inside(i / side)) {
            (Some(column), Some(row)) => !dictionary.is_white(code, column, row),
            _ => false,
        };
        Self { side, square, black: (0..side * side).map(black).collect() }
    }

    /// Black cells as runs: column, row, length.
    fn runs(&self) -> Vec<(usize, usize, usize)> {
        let mut runs = Vec::new();
        for (row, cells) in self.black.chunks(self.side).enumerate() {
            let mut column = 0;
            for run in cells.chunk_by(|a, b| a == b) {
                if run[0] {
                    runs.push((column, row, run.len()));
                }
                column += run.len();
            }
        }
        runs
    }
}

/// A whole number of dots a cell, so that every cell is equally wide; the file says how many dots a metre that makes.
fn png(sheet: &Sheet, args: &MarkerArgs) -> Result<Vec<u8>> {
    let ideal = args.size.0 / 0.0254 * f64::from(args.dpi) / sheet.square as f64;
    let dots = ideal.round().max(1.0) as usize;
    let width = sheet.side * dots;
    if width > 20_000 {
        let what = format_args!("the picture would be {width} pixels wide");
        return Err(Error::usage(what, "choose a smaller --size or --dpi, or an .svg or .pdf"));
    }
    let mut pixels = Vec::with_capacity(width * width);
    for row in sheet.black.chunks(sheet.side) {
        let line: Vec<u8> =
            row.iter().flat_map(|&black| vec![if black { 0 } else { 255 }; dots]).collect();
        (0..dots).for_each(|_| pixels.extend_from_slice(&line));
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, width as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let metre = ((sheet.square * dots) as f64 / args.size.0).round() as u32;
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: metre, yppu: metre, unit }));
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels));
    written.map_err(|error| Error::io(&args.output, &png_error(error)))?;
    Ok(bytes)
}

fn svg(sheet: &Sheet, millimetres: f64, name: &str) -> String {
    let whole = millimetres * sheet.side as f64 / sheet.square as f64;
    let side = sheet.side;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{whole}mm\" height=\"{whole}mm\" viewBox=\"0 0 {side} {side}\" \
         shape-rendering=\"crispEdges\">\n<title>{name}</title>\n<rect width=\"{side}\" height=\"{side}\" fill=\"#fff\"/>\n<path d=\""
    );
    for (column, row, length) in sheet.runs() {
        let _ = write!(text, "M{column} {row}h{length}v1h-{length}z");
    }
    text.push_str("\"/>\n</svg>\n");
    text
}

/// A page of A4 with the marker in its middle and its name below; larger markers have a page of their own size.
fn pdf(sheet: &Sheet, millimetres: f64, name: &str) -> Result<String> {
    let points = 72.0 / 25.4;
    let whole = millimetres * sheet.side as f64 / sheet.square as f64;
    let (page_w, page_h) = (210.0f64.max(whole + 20.0), 297.0f64.max(whole + 40.0));
    if page_h > 5000.0 {
        return Err(Error::usage("a PDF page is at most 5 m high", "write an .svg instead"));
    }
    let cell = millimetres / sheet.square as f64;
    let (left, top) = ((page_w - whole) / 2.0, (page_h + whole) / 2.0);
    let mut content = String::new();
    for (column, row, length) in sheet.runs() {
        let x = (left + column as f64 * cell) * points;
        let y = (top - (row + 1) as f64 * cell) * points;
        let (w, h) = (length as f64 * cell * points, cell * points);
        let _ = writeln!(content, "{x:.4} {y:.4} {w:.4} {h:.4} re");
    }
    let (x, y) = (left * points, (top - whole - 6.0) * points);
    let _ = write!(
        content,
        "f\nBT /F1 9 Tf {x:.3} {y:.3} Td ({name}, black square {millimetres} mm) Tj ET\n"
    );
    let (width, height) = (page_w * points, page_h * points);
    let objects = [
        "<< /Type /Catalog /Pages 2 0 R >>".to_string(),
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_string(),
        format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.3} {height:.3}] /Contents 4 0 R \
             /Resources << /Font << /F1 << /Type /Font /Subtype /Type1 /BaseFont /Helvetica >> >> >> >>"
        ),
        format!("<< /Length {} >>\nstream\n{content}endstream", content.len()),
    ];
    let mut text = String::from("%PDF-1.4\n");
    let mut offsets = Vec::new();
    for (index, object) in objects.iter().enumerate() {
        offsets.push(text.len());
        let _ = write!(text, "{} 0 obj\n{object}\nendobj\n", index + 1);
    }
    let start = text.len();
    let _ = write!(text, "xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
    for offset in offsets {
        let _ = writeln!(text, "{offset:010} 00000 n ");
    }
    let _ = write!(
        text,
        "trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n",
        objects.len() + 1
    );
    Ok(text)
}
