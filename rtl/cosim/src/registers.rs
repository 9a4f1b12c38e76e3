//! The control registers: one description, from which the register file, the constants for drivers and the document
//! are written (`cargo run --example registers`). A test compares the files with what the description gives now.

mod write;

pub use write::{constants, document, register_file};

/// What a bus may do with a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Hardware's value; writing has no effect.
    ReadOnly,
    /// Keeps what is written.
    ReadWrite,
    /// Set by hardware, cleared by writing 1.
    Sticky,
    /// Writing 1 gives a pulse of one clock; reads 0.
    Pulse,
}

/// Some bits of a register.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Lower case; the port of the register file is REGISTER_FIELD, or REGISTER where both are the same.
    pub name: &'static str,
    /// Lowest bit.
    pub lsb: u32,
    /// Width.
    pub bits: u32,
    /// Value after reset.
    pub reset: u32,
    /// What the bus may do.
    pub access: Access,
    /// For the document: meaning, unit, range.
    pub text: &'static str,
}

/// A word of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Register {
    /// Lower case.
    pub name: &'static str,
    /// Address in words.
    pub address: u32,
    /// From the lowest bit up, no two of them overlapping.
    pub fields: &'static [Field],
}

/// A memory that the bus can only write.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Lower case.
    pub name: &'static str,
    /// Address of the first word, a multiple of `words`.
    pub address: u32,
    /// A power of two.
    pub words: u32,
    /// For the document.
    pub text: &'static str,
}

/// Bits of a word address.
pub const ADDRESS_BITS: u32 = 13;
/// What the first register reads: "SCO1".
pub const MAGIC: u32 = 0x5343_4f31;

const fn field(
    name: &'static str,
    lsb: u32,
    bits: u32,
    reset: u32,
    access: Access,
    text: &'static str,
) -> Field {
    Field { name, lsb, bits, reset, access, text }
}

use Access::{Pulse, ReadOnly, ReadWrite, Sticky};

const fn whole(name: &'static str, address: u32, fields: &'static [Field]) -> Register {
    Register { name, address, fields }
}

/// All registers, by address.
pub const REGISTERS: &[Register] = &[
    whole("magic", 0x00, &[field("magic", 0, 32, MAGIC, ReadOnly, "0x53434f31, \"SCO1\"")]),
    whole(
        "size",
        0x01,
        &[
            field("width", 0, 16, 0, ReadOnly, "width of an eye's picture in pixels"),
            field("height", 16, 16, 0, ReadOnly, "its height"),
        ],
    ),
    whole(
        "control",
        0x02,
        &[
            field(
                "run",
                0,
                1,
                1,
                ReadWrite,
                "1: pictures are drawn, one after the other; 0: the last one stays",
            ),
            field(
                "spin",
                1,
                1,
                1,
                ReadWrite,
                "1: stand-alone, the matrix comes from the spin table; 0: from `matrix`",
            ),
            field(
                "camera",
                2,
                1,
                0,
                ReadWrite,
                "1: the camera under the drawing, where there is one",
            ),
            field(
                "arrangement",
                4,
                3,
                0,
                ReadWrite,
                "0 one eye, 1 anaglyph, 2 side by side, 3 interlaced, 4 top and bottom, anaglyphs: 5 grey, 6 half colour, 7 Dubois; \
                 `features.stereo` says which there are, another one is 0",
            ),
            field(
                "commit",
                8,
                1,
                0,
                Pulse,
                "the words in `matrix` take effect with the next picture",
            ),
        ],
    ),
    whole(
        "status",
        0x03,
        &[
            field("drawing", 0, 1, 0, ReadOnly, "a picture is being drawn"),
            field(
                "committed",
                1,
                1,
                0,
                ReadOnly,
                "a commit waits for the next picture: don't write `matrix`",
            ),
            field("late", 2, 1, 0, Sticky, "the camera came too late for a pixel"),
            field(
                "incomplete",
                3,
                1,
                0,
                Sticky,
                "a line found no line memory, or came after the blank, or left the screen where there are no clip stages: a picture was not complete",
            ),
        ],
    ),
    whole(
        "pictures",
        0x04,
        &[field("pictures", 0, 32, 0, ReadOnly, "pictures drawn since reset, modulo 2^32")],
    ),
    whole(
        "clocks",
        0x05,
        &[field(
            "clocks",
            0,
            32,
            0,
            ReadOnly,
            "clocks from the beginning of the last picture to its last pixel",
        )],
    ),
    whole(
        "ink",
        0x06,
        &[field(
            "ink",
            0,
            24,
            0x00ff_ffff,
            ReadWrite,
            "colour of lines in a one-bit plane: red, green, blue from the top",
        )],
    ),
    whole(
        "background",
        0x07,
        &[field("background", 0, 24, 0, ReadWrite, "colour where nothing is drawn")],
    ),
    whole(
        "model",
        0x08,
        &[
            field(
                "vertices",
                0,
                16,
                0,
                ReadWrite,
                "vertices in `vertex`; 0: as many as the built-in model has",
            ),
            field(
                "edges",
                16,
                16,
                0,
                ReadWrite,
                "edges in `edge`; 0: as many as the built-in model has",
            ),
        ],
    ),
    whole(
        "speed",
        0x09,
        &[field("speed", 0, 10, 4, ReadWrite, "steps of 1/1024 turn a picture, two's complement")],
    ),
    whole(
        "angle",
        0x0a,
        &[field("angle", 0, 10, 0, ReadOnly, "of the last picture, in 1/1024 turn")],
    ),
    whole(
        "features",
        0x0b,
        &[
            field(
                "way",
                0,
                2,
                0,
                ReadOnly,
                "to the screen: 0 planes of one bit, 1 colour framebuffer, 2 line memories",
            ),
            field(
                "stereo",
                4,
                2,
                0,
                ReadOnly,
                "arrangements: 0 none, 1 those to 3, 2 those to 6 (7 is as 6), 3 all",
            ),
        ],
    ),
    whole(
        "palette0",
        0x0c,
        &[field(
            "palette0",
            0,
            24,
            0x00ff_ffff,
            ReadWrite,
            "colour of group 0 (line memories and colour framebuffer)",
        )],
    ),
    whole(
        "palette1",
        0x0d,
        &[field("palette1", 0, 24, 0x00ff_0000, ReadWrite, "colour of group 1")],
    ),
    whole(
        "palette2",
        0x0e,
        &[field("palette2", 0, 24, 0x0000_ff00, ReadWrite, "colour of group 2")],
    ),
    whole(
        "palette3",
        0x0f,
        &[field("palette3", 0, 24, 0x0000_00ff, ReadWrite, "colour of group 3")],
    ),
];

/// All windows, by address.
pub const WINDOWS: &[Window] = &[
    Window {
        name: "matrix",
        address: 0x0100,
        words: 32,
        text: "clip matrix, rows x, y, z, w of four words each: 32 bits with sign, one power of two in common (`ClipMatrix::m`); \
               from word 16 on the right eye's",
    },
    Window {
        name: "spin",
        address: 0x0200,
        words: 512,
        text: "0 - 255: sines of a quarter turn, Q2.30; 256 + 4 k: A, B, C of matrix word k: A + (B cos + C sin + 2^29 >> 30); \
               from word 320 on the right eye's",
    },
    Window {
        name: "vertex",
        address: 0x0800,
        words: 2048,
        text: "vertex v: word 2 v + 1 is z (low half); then word 2 v is y, x (x low), which stores all three: Q1.15 each",
    },
    Window {
        name: "edge",
        address: 0x1000,
        words: 4096,
        text: "edge e: vertices b, a (a low), 16 bits each",
    },
];
