//! What can be wrong with a byte stream.

use core::fmt;

use super::command::name;

/// The first thing wrong, and where. The model stays at it: a stream with a fault has no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelError {
    /// Bytes before the one at fault, since the model was made.
    pub at: u64,
    /// What is wrong.
    pub fault: Fault,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A byte while the reset pin is low.
    HeldInReset,
    /// A data byte before any command.
    DataBeforeCommand(u8),
    /// A command that an ST7789 doesn't have.
    UnknownCommand(u8),
    /// A command's parameters ended early, by the next command or when a picture was asked.
    MissingParameters {
        /// The command.
        command: u8,
        /// Parameters it takes.
        needed: u8,
        /// Parameters that came.
        given: u8,
    },
    /// A data byte after the last parameter.
    TooManyParameters {
        /// The command.
        command: u8,
        /// Parameters it takes.
        most: u8,
    },
    /// A parameter that has no meaning here.
    BadParameter {
        /// The command.
        command: u8,
        /// The parameter.
        value: u8,
    },
    /// Pixels while the controller sleeps: `SLPOUT` (11h) is missing.
    PixelsAsleep,
    /// A window, partial area or scroll area that ends before it starts.
    Reversed {
        /// The command.
        command: u8,
        /// First and last address.
        ends: [u16; 2],
    },
    /// A window, partial area or scroll area beyond the memory, as `MADCTL` turns it.
    OutsideMemory {
        /// The command that set it.
        command: u8,
        /// First and last address.
        ends: [u16; 2],
        /// Addresses there are.
        count: u16,
    },
    /// `RAMWRC` (3Ch) without a `RAMWR` (2Ch) since the window or `MADCTL` was set.
    NothingToContinue,
    /// A command, or the picture's end, within a pixel.
    PixelCut {
        /// Bytes of the pixel that came.
        given: u8,
        /// Bytes a pixel has.
        needed: u8,
    },
    /// A picture was asked while the controller sleeps.
    Asleep,
    /// A picture was asked and `DISPON` (29h) is missing.
    DisplayOff,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "byte {}: {}", self.at, self.fault)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Fault::HeldInReset => write!(f, "a byte while the reset pin is low"),
            Fault::DataBeforeCommand(byte) => {
                write!(f, "data {byte:02x}h before any command; is D/C low for commands?")
            }
            Fault::UnknownCommand(command) => write!(f, "an ST7789 has no command {command:02x}h"),
            Fault::MissingParameters { command, needed, given } => {
                write!(f, "{} takes {needed} parameters and has {given}", name(command))
            }
            Fault::TooManyParameters { command, most } => {
                write!(f, "{} takes {most} parameters and has more", name(command))
            }
            Fault::BadParameter { command, value } => {
                write!(f, "{} with {value:02x}h, which the model doesn't know", name(command))
            }
            Fault::PixelsAsleep => {
                write!(f, "pixels while the controller sleeps; send SLPOUT (11h) first")
            }
            Fault::Reversed { command, ends: [first, last] } => {
                write!(f, "{} from {first} to {last}: ends before it starts", name(command))
            }
            Fault::OutsideMemory { command, ends: [first, last], count } => {
                let name = name(command);
                write!(f, "{name} from {first} to {last}: there are {count} in this orientation")
            }
            Fault::NothingToContinue => {
                write!(f, "RAMWRC (3Ch) without RAMWR (2Ch) since the window was set")
            }
            Fault::PixelCut { given, needed } => {
                write!(f, "a pixel ends after {given} of {needed} bytes")
            }
            Fault::Asleep => write!(f, "no picture: the controller sleeps; send SLPOUT (11h)"),
            Fault::DisplayOff => write!(f, "no picture: the display is off; send DISPON (29h)"),
        }
    }
}

impl core::error::Error for ModelError {}
impl core::error::Error for Fault {}
