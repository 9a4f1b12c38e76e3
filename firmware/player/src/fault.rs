//! Everything that can go wrong, in words for the display and the serial port: what happened, where, what to do.

use core::fmt;

use heapless::String;
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

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Part::Positions => "positions (v)",
            Part::TextureCoordinates => "texture coordinates (vt)",
            Part::Normals => "normals (vn)",
            Part::Triangles => "triangles",
        })
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

impl fmt::Display for ModelFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelFault::Nothing => f.write_str("no faces (f) to draw; is this the right file?"),
            ModelFault::TooMany { line, part, most } => {
                write!(
                    f,
                    "line {line}: more than the {most} {part} that fit the memory; simplify the model"
                )
            }
            ModelFault::Undefined { line } => {
                write!(
                    f,
                    "line {line}: refers to a v, vt or vn that has not been defined before it"
                )
            }
            ModelFault::TooFar { line } => {
                write!(f, "line {line}: a coordinate beyond 2000; scale the model down")
            }
            ModelFault::Texture { width, height, most } => write!(
                f,
                "{width} x {height} texels; at most {most} fit the memory, and 1024 a side; scale the picture down"
            ),
        }
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

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Card { fault: CardFault::Missing, .. } => {
                f.write_str("no SD card answers; insert one, or check its wires")
            }
            Fault::Card { fault: CardFault::Gone, sector, .. } => {
                write!(f, "the SD card went silent at sector {sector}; insert it again")
            }
            Fault::Card { fault: CardFault::Checksum, sector, tries } => write!(
                f,
                "sector {sector} came with a wrong checksum {tries} times; shorten the wires, slow the clock, or copy the card"
            ),
            Fault::Card { fault: CardFault::Refused, sector, .. } => {
                write!(f, "the SD card refuses to read sector {sector}; copy it to another card")
            }
            Fault::Format(what) => {
                write!(f, "no FAT32 on the SD card ({what}); format it as FAT32")
            }
            Fault::Damaged(what) => {
                write!(f, "the card's file system is damaged ({what}); repair it on a PC")
            }
            Fault::Missing(path) => write!(f, "{path}: no such file; copy it onto the card"),
            Fault::Kind(path) => {
                write!(f, "{path}: a folder and a file are confused; check the path")
            }
            Fault::Empty(path) => write!(f, "{path}: the file is empty; copy it again"),
            Fault::Show { line, what } => write!(f, "show.txt, line {line}: {what}"),
            Fault::Obj(path, error) => write!(f, "{path}, {error}"),
            Fault::Ppm(path, error) => write!(f, "{path}, {error}"),
            Fault::Model(path, fault) => write!(f, "{path}: {fault}"),
            Fault::Frame => f.write_str("the frame doesn't fit the memory; simplify the model"),
            Fault::Display => f.write_str("the display takes no data; check its wires and power"),
        }
    }
}

impl core::error::Error for Fault {}
