//! PPM and PGM pictures, read from byte chunks of any size without an allocator.
//!
//! P6 and P5 (binary), P3 and P2 (text), `maxval` 1 to 65535. A sample `s` becomes `round(255 s / maxval)`. Exactly one
//! byte of white space separates a binary picture's header from its first texel, which may itself look like white
//! space or like a comment. Grey samples are repeated into R, G, B. Bytes after the last texel are ignored.
//!
//! Not read: bitmaps (P1, P4) and PAM (P7).

use crate::text::{self, Sink, Value};
use core::fmt;

/// Greatest width and height.
pub const SIDE: u32 = 65_535;

/// What the parser found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The header is complete; `width * height` texels follow.
    Header {
        /// Texels in a row, 1 to [`SIDE`].
        width: u32,
        /// Rows, 1 to [`SIDE`].
        height: u32,
    },
    /// The next texel, row by row from the top: R, G, B.
    Texel([u8; 3]),
}

/// What is wrong with the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The first two bytes are not P2, P3, P5 or P6.
    Magic,
    /// Something in the header or in a text picture is not a decimal number.
    NotANumber,
    /// Width or height is 0 or greater than [`SIDE`].
    Size,
    /// `maxval` is 0 or greater than 65535.
    MaxVal,
    /// A sample is greater than `maxval`.
    Sample,
    /// The file ends before the last texel.
    Truncated,
}

/// An error and the offset of the byte that shows it. It stays: every later call returns it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Error {
    /// Offset from the beginning of the file.
    pub byte: u64,
    /// What is wrong.
    pub kind: ErrorKind,
}

impl Error {
    /// What `Display` writes, for machines without room for `core::fmt`.
    pub fn tell(&self, to: Sink<'_>) {
        let what = match self.kind {
            ErrorKind::Magic => "not a PPM or PGM; it must begin with P6, P5, P3 or P2",
            ErrorKind::NotANumber => "not a decimal number; export it again",
            ErrorKind::Size => "width and height must be 1 to 65535; export it again",
            ErrorKind::MaxVal => "the greatest sample value must be 1 to 65535; export it again",
            ErrorKind::Sample => {
                "a sample is greater than the header's greatest value; export it again"
            }
            ErrorKind::Truncated => "the file ends before its last texel; copy it again",
        };
        text::fill("byte %: %", &[Value::Number(self.byte as usize), Value::Text(what)], to);
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::display(f, |to| self.tell(to))
    }
}

impl core::error::Error for Error {}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Magic,
    /// Header numbers (0 width, 1 height, 2 maxval), or 3: samples in text.
    Number(u8),
    Binary,
    Done,
}

/// The push parser, under 100 bytes.
#[derive(Clone, Debug)]
pub struct Parser {
    state: State,
    offset: u64,
    kind: u8,
    comment: bool,
    /// The number being read; `None` between numbers.
    value: Option<u32>,
    width: u32,
    height: u32,
    maxval: u32,
    /// High byte of a two-byte sample.
    high: Option<u8>,
    texel: [u8; 3],
    channel: usize,
    left: u64,
    failed: Option<Error>,
}

impl Default for Parser {
    fn default() -> Self {
        Self::new()
    }
}

impl Parser {
    /// A parser before the first byte.
    pub const fn new() -> Self {
        Self {
            state: State::Magic,
            offset: 0,
            kind: 0,
            comment: false,
            value: None,
            width: 0,
            height: 0,
            maxval: 0,
            high: None,
            texel: [0; 3],
            channel: 0,
            left: 0,
            failed: None,
        }
    }

    /// True when the last texel has been reported.
    pub fn is_done(&self) -> bool {
        self.state == State::Done
    }

    /// Reads a chunk of any size and reports what it completes. O(bytes).
    ///
    /// # Errors
    /// The first malformed byte, and the same error ever after.
    pub fn feed(&mut self, chunk: &[u8], sink: &mut impl FnMut(Event)) -> Result<(), Error> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        for &byte in chunk {
            if self.state == State::Done {
                break;
            }
            if let Err(kind) = self.byte(byte, sink) {
                return Err(self.fail(kind));
            }
            self.offset += 1;
        }
        Ok(())
    }

    /// The file ends here.
    ///
    /// # Errors
    /// [`ErrorKind::Truncated`] when texels are missing, at the byte where they should be.
    pub fn finish(&mut self, sink: &mut impl FnMut(Event)) -> Result<(), Error> {
        if matches!(self.state, State::Number(_)) {
            // The last number of a text picture may end with the file.
            self.comment = false;
            self.feed(b"\n", sink)?;
            self.offset -= u64::from(self.state != State::Done);
        }
        match (self.failed, self.state) {
            (Some(error), _) => Err(error),
            (None, State::Done) => Ok(()),
            (None, State::Magic) => Err(self.fail(ErrorKind::Magic)),
            (None, _) => Err(self.fail(ErrorKind::Truncated)),
        }
    }

    fn fail(&mut self, kind: ErrorKind) -> Error {
        let error = Error { byte: self.offset, kind };
        self.failed = Some(error);
        error
    }

    fn byte(&mut self, byte: u8, sink: &mut impl FnMut(Event)) -> Result<(), ErrorKind> {
        match self.state {
            State::Magic => self.magic(byte),
            State::Number(which) => self.text(which, byte, sink),
            State::Binary => {
                if self.maxval < 256 {
                    return self.sample(u32::from(byte), sink);
                }
                match self.high.take() {
                    None => {
                        self.high = Some(byte);
                        Ok(())
                    }
                    Some(high) => self.sample(u32::from(high) << 8 | u32::from(byte), sink),
                }
            }
            State::Done => Ok(()),
        }
    }

    fn magic(&mut self, byte: u8) -> Result<(), ErrorKind> {
        match (self.offset, byte) {
            (0, b'P') => Ok(()),
            (1, b'2' | b'3' | b'5' | b'6') => {
                self.kind = byte;
                Ok(())
            }
            (2, b'#' | b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c) => {
                self.comment = byte == b'#';
                self.state = State::Number(0);
                Ok(())
            }
            _ => Err(ErrorKind::Magic),
        }
    }

    fn text(&mut self, which: u8, byte: u8, sink: &mut impl FnMut(Event)) -> Result<(), ErrorKind> {
        if self.comment {
            if !matches!(byte, b'\n' | b'\r') {
                return Ok(());
            }
            self.comment = false;
        }
        match byte {
            b'0'..=b'9' => {
                let value = self.value.unwrap_or(0);
                // Ten million is beyond every limit; stopping there keeps the arithmetic small.
                self.value = Some((value * 10 + u32::from(byte - b'0')).min(10_000_000));
                Ok(())
            }
            // A comment right after a number ends with the white space that ends the number.
            b'#' => {
                self.comment = true;
                Ok(())
            }
            b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c => match self.value.take() {
                Some(value) => self.number(which, value, sink),
                None => Ok(()),
            },
            _ => Err(ErrorKind::NotANumber),
        }
    }

    fn number(
        &mut self,
        which: u8,
        value: u32,
        sink: &mut impl FnMut(Event),
    ) -> Result<(), ErrorKind> {
        match which {
            0 | 1 => {
                if value == 0 || value > SIDE {
                    return Err(ErrorKind::Size);
                }
                *(if which == 0 { &mut self.width } else { &mut self.height }) = value;
                self.state = State::Number(which + 1);
            }
            2 => {
                if value == 0 || value > 65_535 {
                    return Err(ErrorKind::MaxVal);
                }
                self.maxval = value;
                self.left = u64::from(self.width) * u64::from(self.height);
                let text = matches!(self.kind, b'2' | b'3');
                self.state = if text { State::Number(3) } else { State::Binary };
                sink(Event::Header { width: self.width, height: self.height });
            }
            _ => return self.sample(value, sink),
        }
        Ok(())
    }

    fn sample(&mut self, value: u32, sink: &mut impl FnMut(Event)) -> Result<(), ErrorKind> {
        if value > self.maxval {
            return Err(ErrorKind::Sample);
        }
        let byte = ((510 * value + self.maxval) / (2 * self.maxval)) as u8;
        if matches!(self.kind, b'2' | b'5') {
            self.texel = [byte; 3];
            self.channel = 2;
        } else {
            self.texel[self.channel] = byte;
        }
        self.channel += 1;
        if self.channel == 3 {
            self.channel = 0;
            sink(Event::Texel(self.texel));
            self.left -= 1;
            if self.left == 0 {
                self.state = State::Done;
            }
        }
        Ok(())
    }
}

#[cfg(all(test, feature = "std"))]
#[path = "ppm_tests.rs"]
mod tests;
