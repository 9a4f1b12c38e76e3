//! Pictures in a terminal.
//!
//! The terminal is asked what it can show (module `query`); `TERM` is never trusted, because it doesn't survive ssh,
//! containers and multiplexers. `--terminal` forces a way. With `NO_COLOR` set, the automatic choice is characters.

mod encode;
mod query;

use std::io::{self, IsTerminal, Write};

pub use encode::shrunk;

use crate::args::Terminal;
use crate::error::{Error, Result};
use crate::image_out::Picture;

/// What a terminal answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// It answered at all, so it understands control sequences.
    pub answers: bool,
    /// The kitty graphics protocol.
    pub kitty: bool,
    /// Sixel graphics (DA1 attribute 4).
    pub sixel: bool,
    /// 24-bit colours in text.
    pub colour24: bool,
    /// Size in characters: columns, rows.
    pub cells: (usize, usize),
    /// Size of a character in pixels: width, height.
    pub cell: (usize, usize),
}

impl Abilities {
    /// What is supposed of a stream that can't be asked: 80 x 24 characters of 10 x 20 pixels.
    pub const UNKNOWN: Self = Self {
        answers: false,
        kitty: false,
        sixel: false,
        colour24: false,
        cells: (80, 24),
        cell: (10, 20),
    };

    /// The best way that these abilities allow.
    pub fn best(&self, no_color: bool) -> Terminal {
        match self {
            _ if no_color => Terminal::Ascii,
            Self { kitty: true, .. } => Terminal::Kitty,
            Self { sixel: true, .. } => Terminal::Sixel,
            Self { answers: true, .. } => Terminal::HalfBlocks,
            _ => Terminal::Ascii,
        }
    }
}

/// Has the user asked for no colours (`NO_COLOR` set and not empty, <https://no-color.org>)?
pub fn no_color() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Will [`show`] show anything?
pub fn will_show(how: Terminal) -> bool {
    match how {
        Terminal::Off => false,
        Terminal::Auto => io::stdout().is_terminal(),
        _ => true,
    }
}

/// Shows a picture on standard output, no larger than the terminal, and tells which way was taken.
///
/// # Errors
/// [`Error::BrokenPipe`] and other failures to write.
pub fn show(picture: &Picture, how: Terminal) -> Result<Terminal> {
    if !will_show(how) {
        return Ok(Terminal::Off);
    }
    let asked = if io::stdout().is_terminal() { query::ask() } else { Abilities::UNKNOWN };
    let way = if how == Terminal::Auto { asked.best(no_color()) } else { how };
    let mut bytes = Vec::new();
    match way {
        Terminal::Kitty => encode::kitty(&mut bytes, picture, &asked),
        Terminal::Sixel => encode::sixel(&mut bytes, picture, &asked),
        Terminal::HalfBlocks => encode::half_blocks(&mut bytes, picture, &asked),
        _ => encode::ascii(&mut bytes, picture, &asked),
    }
    let mut out = io::stdout().lock();
    out.write_all(&bytes).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))?;
    Ok(way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_way() {
        let silent = Abilities::UNKNOWN;
        assert_eq!(silent.best(false), Terminal::Ascii);
        let plain = Abilities { answers: true, ..silent };
        assert_eq!(plain.best(false), Terminal::HalfBlocks);
        assert_eq!(plain.best(true), Terminal::Ascii);
        let sixel = Abilities { sixel: true, ..plain };
        assert_eq!(sixel.best(false), Terminal::Sixel);
        let both = Abilities { kitty: true, ..sixel };
        assert_eq!(both.best(false), Terminal::Kitty);
        assert_eq!(both.best(true), Terminal::Ascii);
    }
}
