//! Everything that can go wrong, in words for the display and the serial port: what happened, where, what to do.

use core::fmt;

use heapless::String;
use scanout_assets::text::{self, Sink, Value, fill};
use scanout_assets::{obj, ppm};

/// Longest path and word kept for a message; longer ones are cut.
pub const NAME: usize = 64;

/// A name for a message.
pub type Name = String<NAME>;

/// As much of a text as a [`Name`] holds.
pub fn name(text: &str) -> Name {
    let mut name = Name::new();
    for letter in text.chars() {
        if name.push(letter).is_err() {
            break;
        }
    }
    name
}

/// What of a model there is too much of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Positions, `v`.
    Positions,
    /// Texture coordinates, `vt`.
    TextureCoordinates,
    /// Normals, `vn`.
    Normals,
    /// Triangles, of which a polygon of n corners has n - 2.
    Triangles,
}

impl Part {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Part::Positions => "positions (v)",
            Part::TextureCoordinates => "texture coordinates (vt)",
            Part::Normals => "normals (vn)",
            Part::Triangles => "triangles",
        }
    }
}

/// What is wrong with a model besides its syntax.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFault {
    /// The file has no faces.
    Nothing,
    /// More than there is memory for.
    TooMany {
        /// Line of the file.
        line: u32,
        /// Of what.
        part: Part,
        /// What there is memory for.
        most: usize,
    },
    /// A face refers to something that has not been defined before it.
    Undefined {
        /// Line of the file.
        line: u32,
    },
    /// A coordinate beyond 2,000 units.
    TooFar {
        /// Line of the file.
        line: u32,
    },
    /// The texture does not fit.
    Texture {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// Texels that there is memory for.
        most: usize,
    },
}

impl ModelFault {
    /// Says it.
    pub fn tell(&self, to: Sink<'_>) {
        let number = |number: u32| Value::Number(number as usize);
        let none = Value::Text("");
        let (what, values) = match *self {
            ModelFault::Nothing => ("no faces (f) to draw; is this the right file?", [none; 3]),
            ModelFault::TooMany { line, part, most } => (
                "line %: more than the % % that fit the memory; simplify the model",
                [number(line), Value::Number(most), Value::Text(part.name())],
            ),
            ModelFault::Undefined { line } => (
                "line %: refers to a v, vt or vn that has not been defined before it",
                [number(line), none, none],
            ),
            ModelFault::TooFar { line } => (
                "line %: a coordinate beyond 2000; scale the model down",
                [number(line), none, none],
            ),
            ModelFault::Texture { width, height, most } => (
                "% x % texels; at most % fit the memory, and 1024 a side; scale the picture down",
                [number(width), number(height), Value::Number(most)],
            ),
        };
        fill(what, &values, to);
    }
}

/// What a card says when it fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CardFault {
    /// Nothing answers.
    Missing,
    /// It answered before and does no more.
    Gone,
    /// The data's checksum is wrong.
    Checksum,
    /// It answers with an error.
    Refused,
}

/// What went wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The card, at a sector, after so many tries.
    Card {
        /// What it says.
        fault: CardFault,
        /// The sector, 512 bytes each.
        sector: u32,
        /// How often it was asked.
        tries: u32,
    },
    /// No FAT volume is on the card.
    Format(&'static str),
    /// The file system contradicts itself.
    Damaged(&'static str),
    /// No such file or folder.
    Missing(Name),
    /// A folder where a file was expected, or the other way round.
    Kind(Name),
    /// A file without a byte.
    Empty(Name),
    /// `show.txt`, at a line.
    Show {
        /// The line.
        line: u32,
        /// What is wrong.
        what: &'static str,
    },
    /// The OBJ file is malformed.
    Obj(Name, obj::Error),
    /// The picture is malformed.
    Ppm(Name, ppm::Error),
    /// The model can't be shown.
    Model(Name, ModelFault),
    /// The frame can't be prepared.
    Frame,
    /// The display doesn't take what is sent.
    Display,
}

impl Fault {
    /// Says it, without `core::fmt`.
    pub fn tell(&self, to: Sink<'_>) {
        let none = Value::Text("");
        let (what, values) = match *self {
            Fault::Card { fault, sector, tries } => (
                match fault {
                    CardFault::Missing => "no SD card answers; insert one, or check its wires",
                    CardFault::Gone => "the SD card went silent at sector %; insert it again",
                    CardFault::Checksum => {
                        "sector % came with a wrong checksum % times; shorten the wires, slow the clock, or copy the card"
                    }
                    CardFault::Refused => {
                        "the SD card refuses to read sector %; copy it to another card"
                    }
                },
                [Value::Number(sector as usize), Value::Number(tries as usize)],
            ),
            Fault::Format(what) => {
                ("no FAT32 on the SD card (%); format it as FAT32", [Value::Text(what), none])
            }
            Fault::Damaged(what) => (
                "the card's file system is damaged (%); repair it on a PC",
                [Value::Text(what), none],
            ),
            Fault::Missing(ref path) => {
                ("%: no such file; copy it onto the card", [Value::Text(path), none])
            }
            Fault::Kind(ref path) => {
                ("%: a folder and a file are confused; check the path", [Value::Text(path), none])
            }
            Fault::Empty(ref path) => {
                ("%: the file is empty; copy it again", [Value::Text(path), none])
            }
            Fault::Show { line, what } => {
                ("show.txt, line %: %", [Value::Number(line as usize), Value::Text(what)])
            }
            Fault::Obj(ref path, _) | Fault::Ppm(ref path, _) => ("%, ", [Value::Text(path), none]),
            Fault::Model(ref path, _) => ("%: ", [Value::Text(path), none]),
            Fault::Frame => ("the frame doesn't fit the memory; simplify the model", [none; 2]),
            Fault::Display => ("the display takes no data; check its wires and power", [none; 2]),
        };
        fill(what, &values, to);
        match self {
            Fault::Obj(_, error) => error.tell(to),
            Fault::Ppm(_, error) => error.tell(to),
            Fault::Model(_, fault) => fault.tell(to),
            _ => {}
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::display(f, |to| self.tell(to))
    }
}

impl core::error::Error for Fault {}
