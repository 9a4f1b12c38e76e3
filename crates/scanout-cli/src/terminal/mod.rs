//! Pictures in a terminal.
//!
//! The terminal is asked what it can show (module `query`); `TERM` is never trusted, because it doesn't survive ssh,
//! containers and multiplexers. `--terminal` forces a way. With `NO_COLOR` set, or `TERM=dumb`, the terminal is asked nothing
//! and the automatic choice is characters.

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
    pub fn best(&self) -> Terminal {
        match self {
            Self { kitty: true, .. } => Terminal::Kitty,
            Self { sixel: true, .. } => Terminal::Sixel,
            Self { answers: true, .. } => Terminal::HalfBlocks,
            _ => Terminal::Ascii,
        }
    }
}

/// Is the terminal to be spared control sequences: `NO_COLOR` set and not empty (<https://no-color.org>), or `TERM=dumb`?
pub fn plain() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || std::env::var_os("TERM").is_some_and(|value| value == "dumb")
}

/// Does the user say that text may have 24-bit colours?
fn truecolour() -> bool {
    std::env::var("COLORTERM").is_ok_and(|value| value == "truecolor" || value == "24bit")
}

/// The rows of a picture that are left where text takes its place.
const LEAST_ROWS: usize = 10;

/// Will [`show`] show anything?
pub fn will_show(how: Terminal) -> bool {
    match how {
        Terminal::Off => false,
        Terminal::Auto => io::stdout().is_terminal(),
        _ => true,
    }
}

/// Shows a picture on standard output, so that `lines` more lines of text leave it in sight, and tells which way was taken.
///
/// # Errors
/// [`Error::BrokenPipe`] and other failures to write.
pub fn show(picture: &Picture, how: Terminal, lines: usize) -> Result<Terminal> {
    if !will_show(how) {
        return Ok(Terminal::Off);
    }
    let mut asked = Abilities::UNKNOWN;
    if io::stdout().is_terminal() {
        // Only these two ways depend on the answers.
        let matters = matches!(how, Terminal::Auto | Terminal::HalfBlocks);
        asked = query::ask(matters && !plain());
    }
    asked.colour24 |= truecolour();
    asked.cells.1 = asked.cells.1.saturating_sub(lines).max(LEAST_ROWS);
    let way = if how == Terminal::Auto { asked.best() } else { how };
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
        assert_eq!(silent.best(), Terminal::Ascii);
        let plain = Abilities { answers: true, ..silent };
        assert_eq!(plain.best(), Terminal::HalfBlocks);
        let sixel = Abilities { sixel: true, ..plain };
        assert_eq!(sixel.best(), Terminal::Sixel);
        let both = Abilities { kitty: true, ..sixel };
        assert_eq!(both.best(), Terminal::Kitty);
    }
}
