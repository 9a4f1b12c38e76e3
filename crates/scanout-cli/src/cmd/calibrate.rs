//! `scanout calibrate`: intrinsics from pictures of a chessboard.

use std::io::Write as _;

use scanout_ar::GreyImage;
use scanout_ar::calibration::{Calibration, chessboard, zhang};
use scanout_video::Source;

use crate::args::ar::{CalibrateArgs, Grid};
use crate::error::{Error, Result};
use crate::image_out;
use crate::narrate;

/// Pictures with the board at most: more don't make it better.
const MOST: usize = 60;

/// Finds the board in each picture and fits the lens.
pub fn run(args: &CalibrateArgs) -> Result<()> {
    let Grid(columns, rows) = args.board;
    if columns.min(rows) < 3 {
        let what = "the board needs at least 3 x 3 inner corners";
        return Err(Error::usage(what, "count where four squares meet, not squares"));
    }
    let failed = |error: scanout_video::VideoError| Error::Failed(error.to_string());
    let mut source = Source::open(&args.source, 30.0).map_err(failed)?;
    let (columns, rows) = (usize::from(columns), usize::from(rows));
    let (mut views, mut size, mut pictures) = (Vec::new(), None, 0);
    let mut grey = Vec::new();
    while let Some(next) = source.next() {
        if views.len() == MOST {
            narrate!("scanout: {MOST} pictures are enough; the others are left out");
            break;
        }
        let number = pictures;
        pictures += 1;
        let frame = match next {
            Ok(frame) => frame,
            Err(error) => {
                narrate!("scanout: {error}");
                continue;
            }
        };
        let this = (frame.width, frame.height);
        if *size.get_or_insert(this) != this {
            narrate!(
                "scanout: picture {number}: it has another size than the first; it is left out"
            );
            continue;
        }
        frame.grey(&mut grey);
        let image = GreyImage::new(frame.width, frame.height, frame.width, &grey);
        match image.and_then(|image| chessboard::find(&image, columns, rows)) {
            Some(corners) => views.push(corners),
            None => narrate!(
                "scanout: picture {number}: the board of {columns} x {rows} inner corners is not seen whole"
            ),
        }
    }
    let name = source.name().to_string();
    let Some(size) = size else {
        return Err(Error::failed(name, "no picture could be read", "give PNG, JPEG or PPM files"));
    };
    let square = args.square.0;
    let grid: Vec<[f64; 2]> = (0..columns * rows)
        .map(|i| [(i % columns) as f64 * square, -((i / columns) as f64) * square])
        .collect();
    let fitted = zhang::calibrate(&grid, &views, size)
        .map_err(|error| Error::Failed(format!("{name}: {error}")))?;
    let text = Calibration { lens: fitted.lens, size: Some(size) }.to_yaml(Some(fitted.error));
    let mut sink = image_out::open(&args.output)?;
    sink.write_all(text.as_bytes())
        .and_then(|()| sink.flush())
        .map_err(|error| Error::io(&args.output, &error))?;
    let [fx, fy] = fitted.lens.focal;
    let worst = fitted.errors.iter().fold(0.0f64, |most, &error| most.max(error));
    narrate!(
        "scanout: {} of {pictures} pictures; focal lengths {fx:.1}, {fy:.1} px; error {:.3} px, in the worst picture {worst:.3} px",
        views.len(),
        fitted.error,
    );
    if fitted.error > 1.0 {
        narrate!(
            "scanout: that is much; is the board flat, are the pictures sharp, and is --board right?"
        );
    }
    Ok(())
}
