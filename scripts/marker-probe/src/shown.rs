//! The display at the other end of the wires.

use std::io::BufRead;

use scanout_display::model::{DisplayModel, Glass};

use super::{HEIGHT, WIDTH, display};

/// Decodes the wires' lines and prints `frame N hash H` for each frame that fills the display, as the machine itself says it of the pixels that
/// it drew. Other lines are passed over.
///
/// # Errors
/// Bytes that a display doesn't understand, pixels that are missing.
pub fn print(lines: impl BufRead) -> Result<(), String> {
    let mut model = DisplayModel::new(Glass::default());
    let mut frames = 0;
    let mut check = |model: &mut DisplayModel| -> Result<(), String> {
        if model.counts().pixels == 0 {
            return Ok(());
        }
        if model.untouched() != 0 || model.counts().pixels != (WIDTH * HEIGHT) as u64 {
            let (pixels, untouched) = (model.counts().pixels, model.untouched());
            return Err(format!("frame {frames}: {pixels} pixels came, {untouched} are untouched"));
        }
        let picture = model.picture().map_err(|error| error.to_string())?;
        let picture = picture.upright(display::orientation());
        if (usize::from(picture.width), usize::from(picture.height)) != (WIDTH, HEIGHT) {
            return Err(format!("frame {frames} is {} x {}", picture.width, picture.height));
        }
        println!("frame {frames} hash {:016x}", picture.hash());
        frames += 1;
        Ok(())
    };
    for line in lines.lines() {
        let line = line.map_err(|error| error.to_string())?;
        let Some(line) = line.strip_prefix("wire ") else { continue };
        let (kind, text) = line.split_once(' ').ok_or("a wire without bytes")?;
        let bytes: Option<Vec<u8>> = (0..text.len() / 2)
            .map(|i| u8::from_str_radix(text.get(2 * i..2 * i + 2)?, 16).ok())
            .collect();
        let bytes = bytes.ok_or_else(|| format!("no bytes: {text}"))?;
        match (kind, &bytes[..]) {
            // Each frame begins with a reset.
            ("r", [0]) => {
                check(&mut model)?;
                model = DisplayModel::new(Glass::default());
                model.reset(false);
            }
            ("r", [1]) => model.reset(true),
            ("0" | "1", bytes) => {
                model.feed_all(bytes, kind == "1").map_err(|error| error.to_string())?;
            }
            _ => return Err(format!("no wire: {line}")),
        }
    }
    check(&mut model)
}
