//! QSPI2 with the SD card: SPI mode 0, chip select held by hand, FIFO of 8 bytes.

use core::convert::Infallible;

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use player::spi_card::Clocked;

use rv64::register::Register;

const SCKDIV: Register = Register(0x1005_0000);
const SCKMODE: Register = Register(0x1005_0004);
const CSID: Register = Register(0x1005_0010);
const CSDEF: Register = Register(0x1005_0014);
const CSMODE: Register = Register(0x1005_0018);
const FMT: Register = Register(0x1005_0040);
const TXDATA: Register = Register(0x1005_0048);
const RXDATA: Register = Register(0x1005_004c);
const FCTRL: Register = Register(0x1005_0060);

/// The peripheral clock of an FU540, Hz.
const TLCLK: u32 = 500_000_000;
/// CSMODE: asserted until changed; never asserted.
const HOLD: u32 = 2;
const OFF: u32 = 3;
/// The frame of CMD58 begins so.
const CMD58: u8 = 0x40 | 58;

/// The card's SPI device.
pub struct Qspi2 {
    /// CMD58 has been sent and its answer not yet been read.
    asked_ocr: bool,
}

impl Qspi2 {
    /// The controller, as an SPI master of one wire each way.
    pub fn new() -> Self {
        FCTRL.write(0);
        SCKMODE.write(0);
        CSID.write(0);
        CSDEF.write(1);
        CSMODE.write(OFF);
        FMT.write(8 << 16);
        Qspi2 { asked_ocr: false }
    }

    fn clock(hertz: u32) {
        SCKDIV.write(TLCLK / (2 * hertz) - 1);
    }

    fn exchange(&mut self, byte: u8) -> u8 {
        while TXDATA.read() >> 31 != 0 {}
        TXDATA.write(byte.into());
        loop {
            let answer = RXDATA.read();
            if answer >> 31 == 0 {
                return answer as u8;
            }
        }
    }

    /// QEMU 10 answers CMD58 with the idle bit still set, which no card does that has left the idle state; it is taken out.
    fn mended(&mut self, byte: u8) -> u8 {
        if self.asked_ocr && byte != 0xff {
            self.asked_ocr = false;
            return byte & !1;
        }
        byte
    }

    fn operate(&mut self, operation: &mut Operation<'_, u8>) {
        match operation {
            Operation::Write(bytes) => {
                self.asked_ocr = bytes.len() == 6 && bytes[0] == CMD58;
                for &byte in bytes.iter() {
                    self.exchange(byte);
                }
            }
            Operation::Read(into) => into.iter_mut().for_each(|slot| *slot = self.exchange(0xff)),
            Operation::TransferInPlace(bytes) => {
                bytes.iter_mut().for_each(|slot| *slot = self.exchange(*slot));
            }
            Operation::Transfer(into, bytes) => {
                for index in 0..into.len().max(bytes.len()) {
                    let answer = self.exchange(bytes.get(index).copied().unwrap_or(0xff));
                    let answer = self.mended(answer);
                    if let Some(slot) = into.get_mut(index) {
                        *slot = answer;
                    }
                }
            }
            // Nobody asks for one in the middle of a transaction with a card.
            Operation::DelayNs(_) => {}
        }
    }
}

impl ErrorType for Qspi2 {
    type Error = Infallible;
}

impl SpiDevice for Qspi2 {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        CSMODE.write(HOLD);
        operations.iter_mut().for_each(|operation| self.operate(operation));
        CSMODE.write(OFF);
        Ok(())
    }
}

impl Clocked for Qspi2 {
    fn slow(&mut self) {
        Self::clock(400_000);
        // 80 clocks with chip select high.
        for _ in 0..10 {
            self.exchange(0xff);
        }
    }

    fn fast(&mut self) {
        Self::clock(20_000_000);
    }
}
