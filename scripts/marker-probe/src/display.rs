//! An ST7789 behind an SPI whose wires are lines of text: what a display is told leaves the machine byte by byte, each with the level
//! of D/C, and another program may be the display.
//!
//! ```text
//!  wire 0 2a          D/C low: a command
//!  wire 1 0000013f    D/C high: parameters or pixels, up to 80 bytes a line
//!  wire r 1           the reset pin
//! ```

use core::cell::{Cell, RefCell};
use core::convert::Infallible;
use core::fmt::Write;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use embedded_hal::spi::{ErrorType as SpiErrorType, Operation, SpiDevice};
use mipidsi::interface::SpiInterface;
use mipidsi::models::ST7789;
use mipidsi::options::{Orientation, Rotation};
use mipidsi::{Builder, Display};

use super::Line;

/// The display stands upright in its memory of 240 x 320; the frame lies.
pub fn orientation() -> Orientation {
    Orientation::new().rotate(Rotation::Deg90)
}

/// The wires of a display.
pub struct Wires<'a> {
    say: RefCell<&'a mut dyn FnMut(&str)>,
    data: Cell<bool>,
}

/// Data in and out.
pub struct Bus<'a>(&'a Wires<'a>);
/// D/C.
pub struct Select<'a>(&'a Wires<'a>);
/// Reset.
pub struct Reset<'a>(&'a Wires<'a>);
/// Nobody waits for a display of text.
pub struct NoDelay;

/// A display on wires.
pub type Panel<'a> = Display<SpiInterface<'a, Bus<'a>, Select<'a>>, ST7789, Reset<'a>>;

impl<'a> Wires<'a> {
    /// Wires that end in `say`.
    pub fn new(say: &'a mut dyn FnMut(&str)) -> Self {
        Self { say: RefCell::new(say), data: Cell::new(false) }
    }

    /// Starts a display on them; `None` when it can't be.
    pub fn start(&'a self, buffer: &'a mut [u8]) -> Option<Panel<'a>> {
        let bus = SpiInterface::new(Bus(self), Select(self), buffer);
        let builder = Builder::new(ST7789, bus).reset_pin(Reset(self)).orientation(orientation());
        builder.init(&mut NoDelay).ok()
    }

    fn line(&self, kind: char, bytes: &[u8]) {
        let mut line = Line::default();
        let _ = write!(line, "wire {kind} ");
        for byte in bytes {
            let _ = write!(line, "{byte:02x}");
        }
        let _ = line.write_char('\n');
        (self.say.borrow_mut())(line.text());
    }
}

impl SpiErrorType for Bus<'_> {
    type Error = Infallible;
}

impl SpiDevice for Bus<'_> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let kind = if self.0.data.get() { '1' } else { '0' };
        for operation in operations {
            // A display without a wire back: nothing is read.
            if let Operation::Write(bytes) = operation {
                bytes.chunks(80).for_each(|bytes| self.0.line(kind, bytes));
            }
        }
        Ok(())
    }
}

impl PinErrorType for Select<'_> {
    type Error = Infallible;
}

impl OutputPin for Select<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.data.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.data.set(true);
        Ok(())
    }
}

impl PinErrorType for Reset<'_> {
    type Error = Infallible;
}

impl OutputPin for Reset<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.line('r', &[0]);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.line('r', &[1]);
        Ok(())
    }
}

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}
