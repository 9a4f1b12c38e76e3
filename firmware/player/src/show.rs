//! `show.txt` in the card's root: what to show. Lines of a word and its value; `#` begins a comment.
//!
//! | line | meaning | without it |
//! |---|---|---|
//! | `model PATH` | OBJ file, folders separated by `/`, long names allowed | `model.obj` |
//! | `texture PATH` | PPM or PGM picture | no texture |
//! | `scale NUMBER` | size, greater than 0 and at most 100 | 1 |
//! | `frames NUMBER` | stop after so many; 0: never | 0 |
//! | `harts one`, `relay` or `both` | one draws and sends; the second sends; both draw and send | `relay` where there are two |
//!
//! Without the file, `model.obj` is shown.

use heapless::String;
use scanout::math::Q16;
use scanout_assets::number::{Number, whole};

use crate::fault::Fault;

/// Longest path in bytes.
pub const PATH: usize = 128;

/// Who does what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harts {
    /// One hart draws a band, then sends it.
    One,
    /// One draws, the other sends.
    Relay,
    /// Both draw and send, every second band each.
    Both,
}

/// What to show.
#[derive(Clone, Debug, PartialEq)]
pub struct Show {
    /// OBJ file.
    pub model: String<PATH>,
    /// Picture; empty for none.
    pub texture: String<PATH>,
    /// Size of the model.
    pub scale: Q16,
    /// How many frames; 0: without end.
    pub frames: u32,
    /// Who does what, if it says so.
    pub harts: Option<Harts>,
}

impl Default for Show {
    fn default() -> Self {
        let mut model = String::new();
        // It fits.
        let _ = model.push_str("model.obj");
        Show { model, texture: String::new(), scale: Q16::ONE, frames: 0, harts: None }
    }
}

impl Show {
    /// Reads the file's text; what it doesn't say stays as it is.
    ///
    /// # Errors
    /// The first line that isn't understood.
    #[inline(never)]
    pub fn read(&mut self, text: &[u8]) -> Result<(), Fault> {
        for (index, line) in text.split(|&byte| byte == b'\n').enumerate() {
            let line = line.trim_ascii();
            if line.is_empty() || line[0] == b'#' {
                continue;
            }
            self.line(line).map_err(|what| Fault::Show { line: index as u32 + 1, what })?;
        }
        Ok(())
    }

    fn line(&mut self, line: &[u8]) -> Result<(), &'static str> {
        let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        let (word, value) = (&line[..end], line[end..].trim_ascii());
        match word {
            b"model" => path(value, &mut self.model)?,
            b"texture" => path(value, &mut self.texture)?,
            b"scale" => {
                self.scale = Number::parse(value)
                    .map(|number| Q16(number.to_q16()))
                    .filter(|scale| scale.0 > 0 && *scale <= Q16::from_int(100))
                    .ok_or("scale wants a number above 0 and at most 100")?;
            }
            b"frames" => {
                self.frames = whole(value.strip_prefix(b"+").unwrap_or(value))
                    .and_then(|frames| frames.try_into().ok())
                    .ok_or("frames wants a whole number; 0 is without end")?;
            }
            b"harts" => {
                self.harts = Some(match value {
                    b"one" => Harts::One,
                    b"relay" => Harts::Relay,
                    b"both" => Harts::Both,
                    _ => return Err("harts wants one, relay or both"),
                });
            }
            _ => return Err("unknown word; write model, texture, scale, frames or harts"),
        }
        Ok(())
    }
}

#[inline(never)]
fn path(value: &[u8], to: &mut String<PATH>) -> Result<(), &'static str> {
    let text = core::str::from_utf8(value).map_err(|_| "the path is not UTF-8")?;
    if text.is_empty() {
        return Err("a path is missing");
    }
    to.clear();
    to.push_str(text).map_err(|_| "the path is longer than 128 bytes")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &[u8]) -> Result<Show, Fault> {
        let mut show = Show::default();
        show.read(text).map(|()| show)
    }

    #[test]
    fn words_and_values() {
        let text = b"# a turn\r\nmodel my models/a b.obj\r\ntexture x.ppm\r\n\r\nscale 3.5e-1\nframes 90\nharts both";
        let show = parse(text).unwrap();
        assert_eq!(show.model, "my models/a b.obj");
        assert_eq!((show.texture.as_str(), show.scale), ("x.ppm", Q16(22938)));
        assert_eq!((show.frames, show.harts), (90, Some(Harts::Both)));
        assert_eq!(parse(b"").unwrap(), Show::default());
    }

    #[test]
    fn what_is_wrong_has_its_line() {
        for (text, at) in [
            ("\nscale 0", 2),
            ("scale -1", 1),
            ("scale 101", 1),
            ("frames many", 1),
            ("frames", 1),
            ("frames -1", 1),
            ("frames 1.5", 1),
            ("frames 4294967296", 1),
            ("harts three", 1),
            ("modle a.obj", 1),
            ("model", 1),
        ] {
            match parse(text.as_bytes()) {
                Err(Fault::Show { line, .. }) => assert_eq!(line, at, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
        let long = ["model ", &"x".repeat(129)].concat();
        assert!(parse(long.as_bytes()).is_err());
    }
}
