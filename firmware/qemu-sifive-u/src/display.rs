//! The display's SPI device and D/C pin. The pin is a GPIO; the data leave through semihosting in records that carry the pin's
//! level (a UART would do as well, but QEMU's takes seconds a frame).

use core::convert::Infallible;
use core::sync::atomic::{AtomicUsize, Ordering};

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};
use player::wire;

use crate::semihosting::{self, Stuck};
use rv64::register::Register;

/// The GPIO's output values.
const OUTPUT: Register = Register(0x1006_000c);
/// The GPIO's output enables.
const ENABLE: Register = Register(0x1006_0008);

/// D/C on GPIO pin 0.
pub struct DataCommand;

impl DataCommand {
    /// The pin, low.
    pub fn new() -> Self {
        OUTPUT.write(0);
        ENABLE.write(1);
        DataCommand
    }
}

impl digital::ErrorType for DataCommand {
    type Error = Infallible;
}

impl OutputPin for DataCommand {
    fn set_low(&mut self) -> Result<(), Infallible> {
        OUTPUT.write(0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        OUTPUT.write(1);
        Ok(())
    }
}

/// Bytes of a record that broke off; they are filled up, or the other end would take what comes next for them. Who uses the
/// display's bus uses this, one hart at a time.
static OWED: AtomicUsize = AtomicUsize::new(0);

/// The SPI device.
pub struct Wire;

impl Wire {
    /// Marks the end of a frame.
    ///
    /// # Errors
    /// When nobody takes it.
    pub fn end_frame(&mut self) -> Result<(), Stuck> {
        self.piece(&wire::END)
    }

    fn piece(&mut self, bytes: &[u8]) -> Result<(), Stuck> {
        loop {
            let owed = OWED.load(Ordering::Relaxed);
            if owed == 0 {
                break;
            }
            let some = owed.min(8);
            semihosting::write(&[0; 8][..some])?;
            OWED.store(owed - some, Ordering::Relaxed);
        }
        semihosting::write(bytes).inspect_err(|stuck| self.owe(bytes.len() - stuck.sent))
    }

    fn owe(&self, bytes: usize) {
        OWED.store(bytes, Ordering::Relaxed);
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Stuck> {
        let data = OUTPUT.read() & 1 != 0;
        for piece in bytes.chunks(wire::MOST) {
            self.piece(&wire::head(data, piece.len()))?;
            // A head without its bytes: all of them are owed.
            self.piece(piece).inspect_err(|stuck| self.owe(piece.len() - stuck.sent))?;
        }
        Ok(())
    }
}

impl spi::Error for Stuck {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl spi::ErrorType for Wire {
    type Error = Stuck;
}

impl SpiDevice for Wire {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Stuck> {
        for operation in operations {
            match operation {
                Operation::Write(bytes) | Operation::Transfer(_, bytes) => self.write(bytes)?,
                Operation::TransferInPlace(bytes) => self.write(bytes)?,
                // Nothing comes back on these wires.
                Operation::Read(bytes) => bytes.fill(0),
                Operation::DelayNs(_) => {}
            }
        }
        Ok(())
    }
}
