//! The two SPIs (Synopsys DesignWare SSI, FIFOs of 32): SPI1 with the card, byte for byte both ways; SPI0 with the display, eight
//! wires side by side, out only.

use core::convert::Infallible;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use player::spi_card::Clocked;
use rv64::register::Register;

use crate::chip::{CARD_SELECT, CLOCK, DATA_COMMAND};

/// An SSI at its address.
#[derive(Clone, Copy)]
struct Ssi(usize);

const DISPLAY: Ssi = Ssi(0x5200_0000);
const CARD: Ssi = Ssi(0x5300_0000);

/// Words of a FIFO.
const FIFO: u32 = 32;

impl Ssi {
    fn at(self, offset: usize) -> Register {
        Register(self.0 + offset)
    }

    fn enable(self, on: bool) {
        self.at(0x08).write(on.into());
    }

    /// Bits a second, rounded down; dividers are even.
    fn clock(self, hertz: u32) {
        self.at(0x14).write(CLOCK.div_ceil(hertz).next_multiple_of(2));
    }

    /// Eight bits a word, mode 0; `way`: transfer mode and frame format.
    fn start(self, way: u32, instruction: u32, select: u32) {
        self.enable(false);
        self.at(0x2c).write(0);
        self.at(0x4c).write(0);
        self.at(0x00).write(7 << 16 | way);
        self.at(0xf4).write(instruction);
        self.at(0x118).write(0);
        self.at(0x10).write(1 << select);
    }

    /// Words waiting to be sent.
    fn waiting(self) -> u32 {
        self.at(0x20).read()
    }

    /// Words received.
    fn received(self) -> u32 {
        self.at(0x24).read()
    }

    /// Waits until the last bit is out: transmitter empty and not busy.
    fn finish(self) {
        while self.at(0x28).read() & 0b101 != 0b100 {}
    }
}

/// The display's bus.
pub struct DisplayBus;

impl DisplayBus {
    /// Eight wires (frame format 3), out only (transfer mode 1). A transfer's first word is its instruction, which goes out as the others
    /// do: 8 bits long, in the frame's format.
    pub fn new() -> Self {
        DISPLAY.start(3 << 21 | 1 << 8, 2 << 8 | 2, 3);
        // An ST7789 takes a byte in 66 ns.
        DISPLAY.clock(15_000_000);
        DISPLAY.enable(true);
        DisplayBus
    }
}

impl ErrorType for DisplayBus {
    type Error = Infallible;
}

impl SpiDevice for DisplayBus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            let bytes: &[u8] = match operation {
                Operation::Write(bytes) | Operation::Transfer(_, bytes) => bytes,
                Operation::TransferInPlace(bytes) => bytes,
                // Nothing comes back on these wires.
                Operation::Read(bytes) => {
                    bytes.fill(0);
                    continue;
                }
                Operation::DelayNs(_) => continue,
            };
            for &byte in bytes {
                while DISPLAY.waiting() >= FIFO {}
                DISPLAY.at(0x60).write(byte.into());
            }
        }
        // D/C may change now.
        DISPLAY.finish();
        Ok(())
    }
}

/// The display's D/C.
pub struct DataCommand;

impl digital::ErrorType for DataCommand {
    type Error = Infallible;
}

impl OutputPin for DataCommand {
    fn set_low(&mut self) -> Result<(), Infallible> {
        DATA_COMMAND.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        DATA_COMMAND.set(true);
        Ok(())
    }
}

/// The card's SPI device. Its chip select is a pin, since the SSI's own would rise whenever the FIFO runs empty.
pub struct CardSpi;

impl CardSpi {
    /// One wire each way.
    pub fn new() -> Self {
        CARD.start(0, 0, 0);
        CardSpi
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        CARD.at(0x60).write(byte.into());
        while CARD.received() == 0 {}
        CARD.at(0x60).read() as u8
    }

    fn speed(&mut self, hertz: u32) {
        CARD.enable(false);
        CARD.clock(hertz);
        CARD.enable(true);
    }
}

impl ErrorType for CardSpi {
    type Error = Infallible;
}

impl SpiDevice for CardSpi {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        CARD_SELECT.set(false);
        for operation in operations {
            match operation {
                Operation::Write(bytes) => bytes.iter().for_each(|&byte| {
                    self.exchange(byte);
                }),
                Operation::Read(into) => {
                    into.iter_mut().for_each(|slot| *slot = self.exchange(0xff));
                }
                Operation::TransferInPlace(bytes) => {
                    bytes.iter_mut().for_each(|slot| *slot = self.exchange(*slot));
                }
                Operation::Transfer(into, bytes) => {
                    for index in 0..into.len().max(bytes.len()) {
                        let answer = self.exchange(bytes.get(index).copied().unwrap_or(0xff));
                        if let Some(slot) = into.get_mut(index) {
                            *slot = answer;
                        }
                    }
                }
                // Nobody asks for one in the middle of a transaction with a card.
                Operation::DelayNs(_) => {}
            }
        }
        CARD_SELECT.set(true);
        Ok(())
    }
}

impl Clocked for CardSpi {
    fn slow(&mut self) {
        self.speed(400_000);
        // 80 clocks with chip select high.
        for _ in 0..10 {
            self.exchange(0xff);
        }
    }

    fn fast(&mut self) {
        self.speed(20_000_000);
    }
}
