//! Wavefront OBJ, read from byte chunks of any size without an allocator.
//!
//! Feed the bytes as they come from a disk, a card or a wire; each finished element calls the sink. A line may be as
//! long as it likes (a polygon's corners are reported one by one); only a single word is bounded, by [`WORD`] bytes.
//!
//! Read: `v` (with `w` or with colours `x y z r g b`), `vt`, `vn`, `f`, `l`, `p` (with negative indices), `usemtl`,
//! `mtllib`, `o`, `g`, `s`, comments, line ends of any system, a backslash before the line end as continuation.
//! Free-form curves and everything else unknown is reported as [`Event::Ignored`] and skipped.
//! Numbers stay decimal ([`Number`]), so firmware takes integers from them and a PC takes `f64`.
//!
//! Not done here: resolving forward references (an index beyond what was read so far is reported as it is), MTL files.
//!
//! ```
//! use scanout_assets::obj::{Event, Parser};
//! let mut parser = Parser::new();
//! let mut corners = 0;
//! let mut sink = |event: Event<'_>| corners += usize::from(matches!(event, Event::Corner(_)));
//! parser.feed(b"v 0 0 0\nv 1 0 0\nv 0 ", &mut sink)?;
//! parser.feed(b"1 0\nf 1 2 -1", &mut sink)?;
//! parser.finish(&mut sink)?;
//! assert_eq!(corners, 3);
//! # Ok::<(), scanout_assets::obj::Error>(())
//! ```

use crate::number::{Number, sign, whole};
use crate::text::{self, Sink, Value};
use core::fmt;

/// Longest word (or name, with its spaces) in bytes.
pub const WORD: usize = 512;

/// What an element line describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// `f`: a polygon.
    Face,
    /// `l`: a polyline.
    Line,
    /// `p`: points.
    Points,
}

/// A corner of an element; indices count from 0 from the beginning of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Index of the position.
    pub position: u32,
    /// Index of the texture coordinate.
    pub uv: Option<u32>,
    /// Index of the normal.
    pub normal: Option<u32>,
}

/// What the parser found. Names are bytes: OBJ does not say in which encoding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<'a> {
    /// `v`: a position, and the colour after it if there is one (commonly 0 to 1 a channel).
    Position {
        /// x, y, z.
        xyz: [Number; 3],
        /// r, g, b as the file gives them.
        colour: Option<[Number; 3]>,
    },
    /// `vt`: u, v, with v upwards as the file has it (v is 0 when the file gives only u).
    Uv([Number; 2]),
    /// `vn`: a normal of any length.
    Normal([Number; 3]),
    /// An element begins.
    Begin(Element),
    /// One corner of it.
    Corner(Corner),
    /// The element ends.
    End,
    /// `usemtl`: the material of the elements that follow.
    Material(&'a [u8]),
    /// `mtllib`: the rest of the line, which may name one file with spaces or several files.
    Library(&'a [u8]),
    /// `o`: an object's name.
    Object(&'a [u8]),
    /// `g`: a group's name.
    Group(&'a [u8]),
    /// `s`: the smoothing group, 0 for `off`.
    Smoothing(u32),
    /// A line whose first word is unknown.
    Ignored(&'a [u8]),
}

/// What is wrong with a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A word is not a finite decimal number.
    NotANumber,
    /// A line has too few numbers.
    TooFewNumbers,
    /// A corner is not `v`, `v/t`, `v//n` or `v/t/n`.
    BadCorner,
    /// A corner's index is 0 or reaches before the first element.
    BadIndex,
    /// A word is longer than [`WORD`].
    WordTooLong,
    /// More than 2^32 - 1 elements or lines.
    TooMany,
}

/// Bytes of the offending word that an error keeps.
const EXCERPT: usize = 24;

/// An error and where it is. After an error the parser refuses every further byte with the same error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Error {
    /// Line, from 1.
    pub line: u32,
    /// What is wrong.
    pub kind: ErrorKind,
    word: [u8; EXCERPT],
    length: u8,
}

impl Error {
    /// What `Display` writes, for machines without room for `core::fmt`.
    pub fn tell(&self, to: Sink<'_>) {
        text::fill("line %: ", &[Value::Number(self.line as usize)], to);
        let what = match self.kind {
            ErrorKind::NotANumber => "'%' is not a finite number; mend the line",
            ErrorKind::TooFewNumbers => "too few numbers; v and vn need 3, vt needs 1",
            ErrorKind::BadCorner => "'%' is not a corner; write v, v/t, v//n or v/t/n",
            ErrorKind::BadIndex => {
                "'%' refers to no element; indices count from 1, or back from -1"
            }
            ErrorKind::WordTooLong => "a word is longer than 512 bytes; is this OBJ?",
            ErrorKind::TooMany => "more than 2^32 elements; split the file",
        };
        let word = &self.word[..usize::from(self.length).min(EXCERPT)];
        text::fill(what, &[Value::Escaped(word)], to);
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::display(f, |to| self.tell(to))
    }
}

impl core::error::Error for Error {}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// Before or in the first word.
    Keyword,
    /// `v`, `vt`, `vn`: index into the counters.
    Numbers(usize),
    Element(Element),
    Name(Name),
    /// Comments, unknown lines.
    Skip,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Name {
    Material,
    Library,
    Object,
    Group,
    Smoothing,
}

/// The push parser, about 650 bytes.
#[derive(Clone, Debug)]
pub struct Parser {
    word: [u8; WORD],
    length: usize,
    line: u32,
    mode: Mode,
    numbers: [Number; 7],
    count: usize,
    /// Positions, texture coordinates and normals so far.
    totals: [u32; 3],
    /// A backslash was read; the next byte decides what it means.
    backslash: bool,
    /// A carriage return was read; a line feed after it belongs to it.
    carriage_return: bool,
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
            word: [0; WORD],
            length: 0,
            line: 1,
            mode: Mode::Keyword,
            numbers: [Number { mantissa: 0, exponent: 0 }; 7],
            count: 0,
            totals: [0; 3],
            backslash: false,
            carriage_return: false,
            failed: None,
        }
    }

    /// The line being read, from 1.
    pub fn line(&self) -> u32 {
        self.line
    }

    /// Reads a chunk of any size and reports what it completes. O(bytes).
    ///
    /// # Errors
    /// The first malformed line, and the same error ever after.
    pub fn feed(&mut self, chunk: &[u8], sink: &mut impl FnMut(Event<'_>)) -> Result<(), Error> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        for &byte in chunk {
            if let Err(kind) = self.byte(byte, sink) {
                let error = self.fail(kind);
                self.failed = Some(error);
                return Err(error);
            }
        }
        Ok(())
    }

    /// The file ends here; a last line without a line end is completed.
    ///
    /// # Errors
    /// As [`Parser::feed`].
    pub fn finish(&mut self, sink: &mut impl FnMut(Event<'_>)) -> Result<(), Error> {
        self.feed(b"\n", sink)
    }

    fn byte(&mut self, byte: u8, sink: &mut impl FnMut(Event<'_>)) -> Result<(), ErrorKind> {
        let after_return = core::mem::take(&mut self.carriage_return);
        match byte {
            b'\n' if after_return => Ok(()),
            b'\n' | b'\r' => {
                self.carriage_return = byte == b'\r';
                let result = if core::mem::take(&mut self.backslash) {
                    self.space(sink)
                } else {
                    self.end_line(sink)
                };
                result?;
                self.line = self.line.checked_add(1).ok_or(ErrorKind::TooMany)?;
                Ok(())
            }
            _ => {
                if core::mem::take(&mut self.backslash) {
                    self.character(b'\\', sink)?;
                }
                match byte {
                    b'\\' => {
                        self.backslash = true;
                        Ok(())
                    }
                    b' ' | b'\t' | 0x0b | 0x0c => self.space(sink),
                    _ => self.character(byte, sink),
                }
            }
        }
    }

    fn character(&mut self, byte: u8, sink: &mut impl FnMut(Event<'_>)) -> Result<(), ErrorKind> {
        if self.mode == Mode::Skip {
            return Ok(());
        }
        // A comment may follow a line's numbers; in a name '#' is a letter.
        if byte == b'#' && self.length == 0 && !matches!(self.mode, Mode::Name(_)) {
            self.end_elements(sink)?;
            self.mode = Mode::Skip;
            return Ok(());
        }
        if self.length == WORD {
            if self.mode == Mode::Keyword {
                sink(Event::Ignored(&self.word));
                self.mode = Mode::Skip;
                return Ok(());
            }
            return Err(ErrorKind::WordTooLong);
        }
        self.word[self.length] = byte;
        self.length += 1;
        Ok(())
    }

    fn space(&mut self, sink: &mut impl FnMut(Event<'_>)) -> Result<(), ErrorKind> {
        if self.length == 0 {
            return Ok(());
        }
        match self.mode {
            Mode::Keyword => self.keyword(sink),
            Mode::Numbers(_) => self.number()?,
            Mode::Element(element) => {
                let corner = self.corner(element)?;
                sink(Event::Corner(corner));
                self.length = 0;
            }
            Mode::Name(_) => return self.character(b' ', sink),
            Mode::Skip => {}
        }
        Ok(())
    }

    fn end_line(&mut self, sink: &mut impl FnMut(Event<'_>)) -> Result<(), ErrorKind> {
        if !matches!(self.mode, Mode::Name(_)) {
            self.space(sink)?;
        }
        self.end_elements(sink)?;
        if let Mode::Name(name) = self.mode {
            let text = self.word[..self.length].trim_ascii();
            match name {
                Name::Material => sink(Event::Material(text)),
                Name::Library => sink(Event::Library(text)),
                Name::Object => sink(Event::Object(text)),
                Name::Group => sink(Event::Group(text)),
                Name::Smoothing => {
                    let group = Number::parse(text).map_or(0, |n| n.to_q16() >> 16);
                    sink(Event::Smoothing(u32::try_from(group).unwrap_or(0)));
                }
            }
        }
        self.mode = Mode::Keyword;
        self.length = 0;
        self.count = 0;
        Ok(())
    }

    /// Ends a line of numbers or corners; its last word is complete.
    fn end_elements(&mut self, sink: &mut impl FnMut(Event<'_>)) -> Result<(), ErrorKind> {
        match self.mode {
            Mode::Element(_) => sink(Event::End),
            Mode::Numbers(which) => {
                if self.count < [3, 1, 3][which] {
                    return Err(ErrorKind::TooFewNumbers);
                }
                let n = &self.numbers;
                let xyz = [n[0], n[1], n[2]];
                match which {
                    0 => {
                        let colour = (self.count >= 6).then(|| [n[3], n[4], n[5]]);
                        sink(Event::Position { xyz, colour });
                    }
                    1 => sink(Event::Uv([
                        n[0],
                        if self.count > 1 { n[1] } else { Number::default() },
                    ])),
                    _ => sink(Event::Normal(xyz)),
                }
                self.totals[which] = self.totals[which].checked_add(1).ok_or(ErrorKind::TooMany)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn keyword(&mut self, sink: &mut impl FnMut(Event<'_>)) {
        self.mode = match &self.word[..self.length] {
            b"v" => Mode::Numbers(0),
            b"vt" => Mode::Numbers(1),
            b"vn" => Mode::Numbers(2),
            b"f" | b"fo" => Mode::Element(Element::Face),
            b"l" => Mode::Element(Element::Line),
            b"p" => Mode::Element(Element::Points),
            b"usemtl" => Mode::Name(Name::Material),
            b"mtllib" => Mode::Name(Name::Library),
            b"o" => Mode::Name(Name::Object),
            b"g" => Mode::Name(Name::Group),
            b"s" => Mode::Name(Name::Smoothing),
            other => {
                sink(Event::Ignored(other));
                Mode::Skip
            }
        };
        if let Mode::Element(element) = self.mode {
            sink(Event::Begin(element));
        }
        self.length = 0;
        self.count = 0;
    }

    fn number(&mut self) -> Result<(), ErrorKind> {
        let number = Number::parse(&self.word[..self.length]).ok_or(ErrorKind::NotANumber)?;
        // Extra numbers are checked and dropped, as every other reader does.
        if let Some(slot) = self.numbers.get_mut(self.count) {
            *slot = number;
            self.count += 1;
        }
        self.length = 0;
        Ok(())
    }

    fn corner(&self, element: Element) -> Result<Corner, ErrorKind> {
        let mut parts = self.word[..self.length].split(|&b| b == b'/');
        let mut next = |which: usize| match parts.next() {
            None | Some([]) => Ok(None),
            Some(text) => self.index(text, self.totals[which]).map(Some),
        };
        let (position, uv, normal) = (next(0)?, next(1)?, next(2)?);
        match position {
            Some(position) if parts.next().is_none() => Ok(match element {
                Element::Points => Corner { position, uv: None, normal: None },
                _ => Corner { position, uv, normal },
            }),
            _ => Err(ErrorKind::BadCorner),
        }
    }

    /// `text` counts from 1, or backwards from the `total` elements so far.
    fn index(&self, text: &[u8], total: u32) -> Result<u32, ErrorKind> {
        let (negative, digits) = sign(text);
        let value = whole(digits).ok_or(ErrorKind::BadCorner)?;
        let index = match u32::try_from(value) {
            Ok(value) if value > 0 && negative => total.checked_sub(value),
            Ok(value) if !negative => value.checked_sub(1),
            _ => None,
        };
        index.ok_or(ErrorKind::BadIndex)
    }

    fn fail(&self, kind: ErrorKind) -> Error {
        let mut word = [0; EXCERPT];
        let length = self.length.min(EXCERPT);
        word[..length].copy_from_slice(&self.word[..length]);
        Error { line: self.line, kind, word, length: length as u8 }
    }
}

#[cfg(all(test, feature = "std"))]
#[path = "obj_tests.rs"]
mod tests;
