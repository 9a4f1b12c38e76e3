//! Words on a display without a frame buffer: the text is drawn anew on each band.
//!
//! 6 x 10 pixels a letter, white on dark blue, wrapped at words: 51 letters a line on 320 pixels.

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Baseline, Text};
use heapless::String;
use scanout_display::band::SendError;
use scanout_display::flush::{BlockingInterface, flush};
use scanout_display::target::BandTarget;
use scanout_display::window::Area;

/// Longest message in bytes; more is cut.
pub const LENGTH: usize = 320;
/// Pixels from letter to letter and from line to line.
const STEP: (u16, u16) = (6, 12);
/// Pixels at each edge.
const MARGIN: u16 = 6;
/// Behind the letters.
const PAPER: u16 = 0x0008;

/// A message being written.
pub type Words = String<LENGTH>;

/// Shows a heading and a message on the whole area, with as many rows at a time as `colour` holds.
///
/// # Errors
/// When `colour` holds no row, or the bus fails.
pub fn show<I: BlockingInterface>(
    interface: &mut I,
    area: Area,
    colour: &mut [u16],
    heading: &str,
    message: &str,
) -> Result<(), SendError<I::Error>> {
    let width = usize::from(area.width);
    let lines = (colour.len() / width.max(1)) as u16;
    if lines == 0 {
        return Err(SendError::Length { needed: width, given: colour.len() });
    }
    let mut top = 0;
    while top < area.height {
        let rows = lines.min(area.height - top);
        let band = &mut colour[..usize::from(rows) * width];
        band.fill(PAPER);
        write(&mut BandTarget::new(band, (area.width, area.height), top), heading, message);
        flush(interface, area, top, band)?;
        top += rows;
    }
    Ok(())
}

fn write(target: &mut BandTarget<'_>, heading: &str, message: &str) {
    let (style, title) = (
        MonoTextStyle::new(&FONT_6X10, Rgb565::WHITE),
        MonoTextStyle::new(&FONT_6X10, Rgb565::YELLOW),
    );
    let letters = usize::from((target.size().width as u16).saturating_sub(2 * MARGIN) / STEP.0);
    let (rows, mut y) = (target.rows(), MARGIN);
    let mut line = |text: &str, style| {
        // Only what touches the band.
        if y + STEP.1 > rows.start && y < rows.end {
            let place = Point::new(MARGIN.into(), y.into());
            // A band cannot fail.
            let _ = Text::with_baseline(text, place, style, Baseline::Top).draw(target);
        }
        y = y.saturating_add(STEP.1);
    };
    line(heading, title);
    line("", style);
    wrap(message, letters, |text| line(text, style));
}

/// Cuts a text into lines of at most `letters` letters, at spaces where there are any.
fn wrap(text: &str, letters: usize, mut line: impl FnMut(&str)) {
    for paragraph in text.split('\n') {
        let mut rest = paragraph;
        while let Some((end, _)) = rest.char_indices().nth(letters) {
            // A line may end right before a space.
            let whole = rest[end..].starts_with(' ');
            let space = if whole { Some(end) } else { rest[..end].rfind(' ') };
            let cut = space.filter(|&at| at > 0).unwrap_or(end.max(1));
            line(&rest[..cut]);
            rest = rest[cut..].trim_start();
        }
        line(rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn lines(text: &str, letters: usize) -> Vec<std::string::String> {
        let mut lines = Vec::new();
        wrap(text, letters, |line| lines.push(line.into()));
        lines
    }

    #[test]
    fn lines_break_at_words() {
        assert_eq!(lines("no SD card answers; insert", 10), ["no SD card", "answers;", "insert"]);
        assert_eq!(lines("abcdefghijkl", 5), ["abcde", "fghij", "kl"]);
        assert_eq!(lines("a\nb", 5), ["a", "b"]);
        assert_eq!(lines("aäöüß", 2), ["aä", "öü", "ß"]);
    }
}
