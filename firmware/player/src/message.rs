//! Words on a display without a frame buffer: the text is drawn anew on each band.
//!
//! 6 x 10 pixels a letter, white on dark blue, wrapped at words: 51 letters a line on 320 pixels.

use embedded_graphics::geometry::{OriginDimensions, Point};
use embedded_graphics::image::GetPixel;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::BinaryColor;
use heapless::Vec;
use scanout_display::band::SendError;
use scanout_display::flush::{BlockingInterface, flush};
use scanout_display::window::Area;

/// Longest message in bytes; more is cut.
pub const LENGTH: usize = 320;
/// Pixels from letter to letter and from line to line.
const STEP: (u16, u16) = (6, 12);
/// Pixels at each edge.
const MARGIN: u16 = 6;
/// Behind the letters.
const PAPER: u16 = 0x0008;
/// Of the heading's letters.
const TITLE: u16 = 0xffe0;
/// Of the message's letters.
const INK: u16 = 0xffff;

/// A message being written.
pub type Words = Vec<u8, LENGTH>;

/// Appends what still fits.
pub fn append(words: &mut Words, text: &[u8]) {
    let room = LENGTH - words.len();
    // It fits.
    let _ = words.extend_from_slice(&text[..text.len().min(room)]);
}

/// Shows a heading and a message, both UTF-8, on the whole area, with as many rows at a time as `colour` holds.
///
/// # Errors
/// When `colour` holds no row, or the bus fails.
pub fn show<I: BlockingInterface>(
    interface: &mut I,
    area: Area,
    colour: &mut [u16],
    heading: &[u8],
    message: &[u8],
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
        Rows { pixels: &mut *band, width: area.width, top }.write(heading, message);
        flush(interface, area, top, band)?;
        top += rows;
    }
    Ok(())
}

/// Rows of the area, `width` pixels each, from row `top` on.
struct Rows<'b> {
    pixels: &'b mut [u16],
    width: u16,
    top: u16,
}

impl Rows<'_> {
    /// The heading and the message, as far as they touch these rows.
    fn write(&mut self, heading: &[u8], message: &[u8]) {
        let letters = usize::from(self.width.saturating_sub(2 * MARGIN) / STEP.0);
        let mut y = MARGIN;
        self.line(heading, y, TITLE);
        y += STEP.1;
        wrap(message, letters, &mut |text| {
            y = y.saturating_add(STEP.1);
            self.line(text, y, INK);
        });
    }

    /// A line of letters, its highest row at `y`. Letter by letter and pixel by pixel: that is small, and a message may take its
    /// time.
    fn line(&mut self, text: &[u8], y: u16, ink: u16) {
        let size = FONT_6X10.character_size;
        let per_row = FONT_6X10.image.size().width / size.width;
        for (place, &letter) in text.iter().filter(|&&byte| begins(byte)).enumerate() {
            // What is not ASCII is a question mark.
            let code = u32::from(if matches!(letter, b' '..=b'~') { letter } else { b'?' } - b' ');
            let glyph = (code % per_row * size.width, code / per_row * size.height);
            let left = usize::from(MARGIN) + place * usize::from(STEP.0);
            for (row, column) in
                (0..size.height).flat_map(|row| (0..size.width).map(move |column| (row, column)))
            {
                let dot = Point::new((glyph.0 + column) as i32, (glyph.1 + row) as i32);
                let x = left + column as usize;
                let below = (usize::from(y) + row as usize).checked_sub(self.top.into());
                if let Some(below) = below
                    && x < self.width.into()
                    && let Some(pixel) = self.pixels.get_mut(below * usize::from(self.width) + x)
                    && FONT_6X10.image.pixel(dot) == Some(BinaryColor::On)
                {
                    *pixel = ink;
                }
            }
        }
    }
}

/// Whether a letter begins with this byte of UTF-8.
fn begins(byte: u8) -> bool {
    byte & 0xc0 != 0x80
}

/// The byte at which letter number `letters` begins, if there are as many and one.
fn beyond(text: &[u8], letters: usize) -> Option<usize> {
    let mut count = 0;
    text.iter().position(|&byte| {
        count += usize::from(begins(byte));
        count > letters
    })
}

/// Cuts a text into lines of at most `letters` letters, at spaces where there are any.
fn wrap(text: &[u8], letters: usize, line: &mut dyn FnMut(&[u8])) {
    for paragraph in text.split(|&byte| byte == b'\n') {
        let mut rest = paragraph;
        while let Some(end) = beyond(rest, letters) {
            // A line may end right before a space.
            let space = rest[..=end].iter().rposition(|&byte| byte == b' ');
            let cut = space.filter(|&at| at > 0).unwrap_or(end.max(1));
            line(&rest[..cut]);
            rest = rest[cut..].trim_ascii_start();
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
        wrap(text.as_bytes(), letters, &mut |line| {
            lines.push(std::string::String::from_utf8(line.to_vec()).unwrap());
        });
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
