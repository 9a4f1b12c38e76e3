//! Everything that can go wrong, in words for the display and the serial port: what happened, where, what to do.

use core::cell::RefCell;
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
    // Not in the middle of a letter, of which each has four bytes at most.
    let cut = (NAME - 3..=NAME).rev().find_map(|end| text.get(..end));
    Name::try_from(cut.unwrap_or(text)).unwrap_or_default()
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

/// What is wrong with a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFault {
    /// No such file or folder.
    Missing,
    /// A folder where a file was expected, or the other way round.
    Kind,
    /// It has no byte.
    Empty,
    /// It has been read already.
    Twice,
    /// The OBJ file is malformed.
    Obj(obj::Error),
    /// The picture is malformed.
    Ppm(ppm::Error),
    /// It is well-formed, but can't be shown.
    Model(ModelFault),
}

impl FileFault {
    /// Says it; the file's name stands before.
    pub fn tell(&self, to: Sink<'_>) {
        to(match self {
            FileFault::Missing => b": no such file; copy it onto the card",
            FileFault::Kind => b": a folder and a file are confused; check the path",
            FileFault::Empty => b": the file is empty; copy it again",
            FileFault::Twice => b": named twice; the model and its texture are two files",
            FileFault::Obj(_) | FileFault::Ppm(_) => b", ",
            FileFault::Model(_) => b": ",
        });
        match self {
            FileFault::Obj(error) => error.tell(to),
            FileFault::Ppm(error) => error.tell(to),
            FileFault::Model(fault) => fault.tell(to),
            _ => {}
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
    /// A file, by its path.
    File(Name, FileFault),
    /// `show.txt`, at a line.
    Show {
        /// The line.
        line: u32,
        /// What is wrong.
        what: &'static str,
    },
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
            Fault::File(ref path, _) => ("%", [Value::Text(path), none]),
            Fault::Show { line, what } => {
                ("show.txt, line %: %", [Value::Number(line as usize), Value::Text(what)])
            }
            Fault::Frame => ("the frame doesn't fit the memory; simplify the model", [none; 2]),
            Fault::Display => ("the display takes no data; check its wires and power", [none; 2]),
        };
        fill(what, &values, to);
        if let Fault::File(_, fault) = self {
            fault.tell(to);
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::display(f, |to| self.tell(to))
    }
}

impl core::error::Error for Fault {}

/// A fault has been left in [`Faults`].
#[derive(Clone, Copy, Debug)]
pub struct Failed;

/// Where whoever meets a fault leaves it. What is returned then is [`Failed`], so that a hundred bytes aren't moved at each `?`.
#[derive(Debug, Default)]
pub struct Faults(RefCell<Option<Fault>>);

impl Faults {
    /// Leaves a fault. One that is there already stays: it is the cause of those after it.
    #[inline(never)]
    pub fn leave(&self, fault: Fault) -> Failed {
        self.0.borrow_mut().get_or_insert(fault);
        Failed
    }

    /// Leaves a file's fault.
    #[inline(never)]
    pub fn leave_file(&self, path: &str, fault: FileFault) -> Failed {
        self.leave(Fault::File(name(path), fault))
    }

    /// Whether the fault that was left is such a one.
    pub fn is(&self, such: impl FnOnce(&Fault) -> bool) -> bool {
        self.0.borrow().as_ref().is_some_and(such)
    }

    /// The fault that was left; then there is none any more.
    pub fn take(&self) -> Option<Fault> {
        self.0.take()
    }
}
