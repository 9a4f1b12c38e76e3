//! The display model: an ST7789 as its wires see it. Bytes and the level of D/C go in, a picture comes out, or the
//! first thing that a real display would have made nonsense of.
//!
//! ```text
//!  byte, D/C --feed--> command, parameters --> registers (window, MADCTL, COLMOD, ...)
//!                      pixels --> address counter, wraps in the window --> memory, 240 x 320
//!  reset pin --reset->                                                      |
//!                                         picture: RGB565 as sent <---------+----> seen: RGB888 as the eye gets it
//! ```
//!
//! The memory is that of the chip, upright; `MADCTL` turns addresses:
//!
//! ```text
//!  MV 0:  column = x, row = y        MV 1:  column = y, row = x        then MX: column = 239 - column, MY: row = 319 - row
//!
//!      00: upright       60: 90 (MX MV)     C0: 180 (MY MX)    A0: 270 degrees (MY MV)
//!      +--> x                  y <--+                ^ y           ^ x
//!      |                            |                |             |
//!      v y                          v x         x <--+             +--> y         + is address (0, 0)
//! ```
//!
//! Pixels are 16 bits (`COLMOD` 05h, 55h), two bytes, high first, or 18 bits (06h, 66h), three bytes, top six bits
//! each; 18 is the controller's default. Both are widened to 8 bits by bit replication.
//!
//! What is wrong is in [`Fault`]; after one, nothing more is taken and there is no picture. Stricter than glass: pixels
//! while asleep, windows beyond the memory, and spare or missing parameters are errors, though the chip would ignore some of them.
//!
//! | | as modelled |
//! |---|---|
//! | software reset | keeps memory, `MADCTL`, `COLMOD`; all else as after power-on |
//! | reset pin | keeps memory (a real one doesn't promise that); see [`DisplayModel::untouched`] |
//! | BGR, inversion, partial mode, scrolling | at display, in [`DisplayModel::seen`] alone |
//! | voltages, gamma, brightness, tearing line, idle colours | their parameters are counted, no more |
//! | time | none: that 5 ms (120 ms before the next sleep) are left after `SLPOUT` can't be seen in bytes |
//! | reading | answers are not given; bytes sent while reading are ignored |
//!
//! # Example
//!
//! A driver's bytes, taken from its pins, and the picture that they make:
//!
//! ```
//! use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::{Orientation, Rotation}};
//! use scanout::{frame::Band, output::Rgb565};
//! use scanout_display::{band, model::{NoDelay, Wires}};
//!
//! let (wires, mut buffer) = (Wires::default(), [0; 512]);
//! let landscape = Orientation::new().rotate(Rotation::Deg90);
//! let mut display = Builder::new(ST7789, SpiInterface::new(wires.spi(), wires.dc(), &mut buffer))
//!     .reset_pin(wires.reset())
//!     .orientation(landscape)
//!     .init(&mut NoDelay)
//!     .unwrap();
//! let band = Band::<Rgb565> { top: 16, rows: 2, width: 320, colour: &[0xf800; 640], depth: &[] };
//! band::show(&mut display, &band)?;
//!
//! let picture = wires.model().picture()?.upright(landscape);
//! assert_eq!((picture.width, picture.height, picture.at(319, 17)), (320, 240, 0xf800));
//! assert_eq!(wires.model().untouched(), 320 * 238);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A firmware's bytes, taken from an emulator: [`DisplayModel::feed`] with the level of D/C, [`DisplayModel::reset`] with that of
//! the reset pin.

mod command;
mod error;
mod picture;
mod registers;
#[cfg(test)]
mod tests;
mod wires;

use std::vec;
use std::vec::Vec;

use command::{Command, Takes};
pub use error::{Fault, ModelError};
pub use picture::Picture;
pub use registers::{PixelSize, Registers};
use scanout::output::{PixelFormat, Rgb565, widen565};
pub use wires::{NoDelay, Wires, WiresDc, WiresInterface, WiresReset, WiresSpi};

/// Columns of the memory.
pub const MEMORY_COLUMNS: u16 = 240;
/// Rows of the memory.
pub const MEMORY_ROWS: u16 = 320;

/// How the glass is made, which the byte stream doesn't tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Glass {
    /// Its sub-pixels stand blue first, so that `MADCTL`'s BGR bit is needed for true colours.
    pub bgr: bool,
    /// It shows the complement, so that `INVON` is needed (IPS panels).
    pub inverted: bool,
}

/// What went over the wires.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts {
    /// All bytes.
    pub bytes: u64,
    /// Commands.
    pub commands: u64,
    /// Bytes of parameters.
    pub parameters: u64,
    /// Bytes of pixels.
    pub pixel_bytes: u64,
    /// Pixels.
    pub pixels: u64,
    /// Memory writes begun (`RAMWR`).
    pub writes: u64,
    /// Times that the window was full; the next pixel would be its first again.
    pub windows_filled: u64,
    /// Pixels written after their window was full.
    pub wrapped_pixels: u64,
    /// Pulses of the reset pin.
    pub resets: u64,
}

/// An ST7789 with its glass.
#[derive(Clone, Debug)]
pub struct DisplayModel {
    glass: Glass,
    /// Pixels, 8 bits a channel, by the chip's own rows.
    memory: Vec<[u8; 3]>,
    written: Vec<bool>,
    registers: Registers,
    reset_low: bool,
    command: Option<Command>,
    parameters: [u8; 64],
    given: u8,
    /// Where the next pixel goes, by address; none after the window was changed.
    cursor: Option<(u16, u16)>,
    full: bool,
    pixel: [u8; 3],
    pixel_given: u8,
    counts: Counts,
    fault: Option<ModelError>,
}

impl Default for DisplayModel {
    fn default() -> Self {
        DisplayModel::new(Glass::default())
    }
}

impl DisplayModel {
    /// A display just powered on: asleep, its memory never written.
    pub fn new(glass: Glass) -> Self {
        let pixels = MEMORY_COLUMNS as usize * MEMORY_ROWS as usize;
        DisplayModel {
            glass,
            memory: vec![[0; 3]; pixels],
            written: vec![false; pixels],
            registers: Registers::RESET,
            reset_low: false,
            command: None,
            parameters: [0; 64],
            given: 0,
            cursor: None,
            full: false,
            pixel: [0; 3],
            pixel_given: 0,
            counts: Counts::default(),
            fault: None,
        }
    }

    /// Takes a byte; `data` is the level of D/C while its last bit is clocked in.
    ///
    /// # Errors
    /// The first fault of the stream, again and again.
    pub fn feed(&mut self, byte: u8, data: bool) -> Result<(), ModelError> {
        if let Some(error) = self.fault {
            return Err(error);
        }
        let taken = if self.reset_low {
            Err(Fault::HeldInReset)
        } else if data {
            self.data(byte)
        } else {
            self.begin(byte)
        };
        let at = self.counts.bytes;
        self.counts.bytes += 1;
        taken.map_err(|fault| *self.fault.insert(ModelError { at, fault }))
    }

    /// Takes bytes at one level of D/C.
    ///
    /// # Errors
    /// The first fault of the stream.
    pub fn feed_all(&mut self, bytes: &[u8], data: bool) -> Result<(), ModelError> {
        bytes.iter().try_for_each(|&byte| self.feed(byte, data))
    }

    /// The reset pin's level: low (`false`) resets, high lets go.
    pub fn reset(&mut self, high: bool) {
        if !high && !self.reset_low {
            self.registers = Registers::RESET;
            (self.command, self.cursor) = (None, None);
            (self.given, self.pixel_given) = (0, 0);
            self.counts.resets += 1;
        }
        self.reset_low = !high;
    }

    /// Counts since the model was made.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The registers now.
    pub fn registers(&self) -> Registers {
        self.registers
    }

    /// The first fault.
    pub fn fault(&self) -> Option<ModelError> {
        self.fault
    }

    /// Pixels that were never written: a real display shows noise there.
    pub fn untouched(&self) -> usize {
        self.written.iter().filter(|&&written| !written).count()
    }

    /// Makes every pixel untouched again, so that the next frame can be seen to write each.
    pub fn forget(&mut self) {
        self.written.fill(false);
    }

    /// The memory as RGB565 as it was sent, upright, whatever the window or `MADCTL` is now. Pixels sent with 18 bits
    /// are cut to 16.
    ///
    /// # Errors
    /// The stream's fault; or the display is asleep or off, or a command or pixel is incomplete.
    pub fn picture(&self) -> Result<Picture<u16>, ModelError> {
        self.showing()?;
        let pixels = self.memory.iter().map(|&rgb| Rgb565::encode(rgb)).collect();
        Ok(Picture { width: MEMORY_COLUMNS, height: MEMORY_ROWS, pixels })
    }

    /// What the eye sees, upright: colour order, inversion, partial mode and scrolling applied.
    ///
    /// # Errors
    /// As [`picture`](Self::picture).
    pub fn seen(&self) -> Result<Picture<[u8; 3]>, ModelError> {
        self.showing()?;
        let (swap, columns) = (self.registers.bgr() != self.glass.bgr, MEMORY_COLUMNS as usize);
        let complement = self.registers.inverted != self.glass.inverted;
        let mut pixels = Vec::with_capacity(self.memory.len());
        for row in 0..MEMORY_ROWS {
            let Some(from) = self.registers.shown(row) else {
                pixels.resize(pixels.len() + columns, [0; 3]);
                continue;
            };
            pixels.extend(self.memory[from as usize * columns..][..columns].iter().map(|&rgb| {
                let [r, g, b] = if complement { rgb.map(|v| !v) } else { rgb };
                if swap { [b, g, r] } else { [r, g, b] }
            }));
        }
        Ok(Picture { width: MEMORY_COLUMNS, height: MEMORY_ROWS, pixels })
    }

    /// Whether there is a picture to look at.
    fn showing(&self) -> Result<(), ModelError> {
        if let Some(error) = self.fault {
            return Err(error);
        }
        let fault = match self.check_complete() {
            Err(fault) => fault,
            Ok(()) if !self.registers.awake => Fault::Asleep,
            Ok(()) if !self.registers.on => Fault::DisplayOff,
            Ok(()) => return Ok(()),
        };
        Err(ModelError { at: self.counts.bytes, fault })
    }

    /// Whether the command before has all its parameters and the last pixel all its bytes.
    fn check_complete(&self) -> Result<(), Fault> {
        if let Some(Command { code, takes: Takes::Parameters(needed, _), .. }) = self.command
            && self.given < needed
        {
            return Err(Fault::MissingParameters { command: code, needed, given: self.given });
        }
        if self.pixel_given > 0 {
            let needed = self.registers.pixel.bytes();
            return Err(Fault::PixelCut { given: self.pixel_given, needed });
        }
        Ok(())
    }

    /// Takes a command's byte.
    fn begin(&mut self, code: u8) -> Result<(), Fault> {
        self.check_complete()?;
        let command = command::find(code).ok_or(Fault::UnknownCommand(code))?;
        self.counts.commands += 1;
        (self.command, self.given) = (Some(command), 0);
        match (command.takes, code) {
            (Takes::Parameters(0, 0), 0x01) => {
                self.cursor = None;
                self.registers.apply(code, &[])
            }
            (Takes::Parameters(0, 0), _) => self.registers.apply(code, &[]),
            (Takes::Pixels, 0x2c) => {
                self.registers.check_window()?;
                let Registers { window, .. } = self.registers;
                self.cursor = Some((window.columns[0], window.rows[0]));
                self.full = false;
                self.counts.writes += 1;
                Ok(())
            }
            (Takes::Pixels, _) if self.cursor.is_none() => Err(Fault::NothingToContinue),
            _ => Ok(()),
        }
    }

    /// Takes a byte of data.
    fn data(&mut self, byte: u8) -> Result<(), Fault> {
        let command = self.command.ok_or(Fault::DataBeforeCommand(byte))?;
        match command.takes {
            Takes::Answer => Ok(()),
            Takes::Pixels => self.pixel_byte(byte),
            Takes::Parameters(_, most) if self.given == most => {
                Err(Fault::TooManyParameters { command: command.code, most })
            }
            Takes::Parameters(_, most) => {
                self.parameters[self.given as usize] = byte;
                self.given += 1;
                self.counts.parameters += 1;
                if self.given < most {
                    return Ok(());
                }
                if matches!(command.code, 0x2a | 0x2b | 0x36) {
                    self.cursor = None;
                }
                self.registers.apply(command.code, &self.parameters[..most as usize])
            }
        }
    }

    /// Takes a byte of a pixel.
    fn pixel_byte(&mut self, byte: u8) -> Result<(), Fault> {
        if !self.registers.awake {
            return Err(Fault::PixelsAsleep);
        }
        self.pixel[self.pixel_given as usize] = byte;
        self.pixel_given += 1;
        self.counts.pixel_bytes += 1;
        if self.pixel_given < self.registers.pixel.bytes() {
            return Ok(());
        }
        self.pixel_given = 0;
        let [a, b, _] = self.pixel;
        let rgb = match self.registers.pixel {
            PixelSize::Bits16 => widen565(u16::from_be_bytes([a, b])),
            PixelSize::Bits18 => self.pixel.map(|v| v & 0xfc | v >> 6),
        };
        self.write(rgb)
    }

    /// Writes a pixel and steps: along the row, then down, then from the start again.
    fn write(&mut self, rgb: [u8; 3]) -> Result<(), Fault> {
        let (x, y) = self.cursor.ok_or(Fault::NothingToContinue)?;
        let index = self.registers.index(x, y);
        (self.memory[index], self.written[index]) = (rgb, true);
        self.counts.pixels += 1;
        self.counts.wrapped_pixels += self.full as u64;
        let ([left, right], [top, bottom]) =
            (self.registers.window.columns, self.registers.window.rows);
        self.cursor = Some(match (x < right, y < bottom) {
            (true, _) => (x + 1, y),
            (false, true) => (left, y + 1),
            (false, false) => {
                self.full = true;
                self.counts.windows_filled += 1;
                (left, top)
            }
        });
        Ok(())
    }
}
