//! An SD card in SPI mode, by embedded-sdmmc: CRC7 on commands, CRC16 on data, at most 400 kHz until it has started.
//!
//! The order of the SD specification (part 1, section 6.4.1): 80 clocks with chip select high, CMD0, CMD8, CMD59, CMD55
//! and ACMD41, CMD58; then the fast clock and CMD17 for each sector.

use core::cell::Cell;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use embedded_sdmmc::sdcard::spi::{AcquireOpts, Error};
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx, SdCard};

use crate::card::Card;
use crate::fault::CardFault;

/// The SPI device of a card: its clock can be changed.
pub trait Clocked: SpiDevice {
    /// 100 to 400 kHz, and 80 clocks with chip select and data high.
    fn slow(&mut self);
    /// As fast as card and wires allow, at most 25 MHz.
    fn fast(&mut self);
}

/// What went over the card's wires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Bytes, in either direction at once.
    pub bytes: u32,
    /// Commands.
    pub commands: u32,
}

/// An SD card.
pub struct SpiCard<S: Clocked, D: DelayNs> {
    card: SdCard<Counting<S>, D>,
}

impl<S: Clocked, D: DelayNs> SpiCard<S, D> {
    /// A card on an SPI device of mode 0. Nothing is sent yet.
    pub fn new(spi: S, delay: D) -> Self {
        let options = AcquireOpts { use_crc: true, acquire_retries: 20 };
        let counting = Counting { spi, traffic: Cell::default() };
        SpiCard { card: SdCard::new_with_options(counting, delay, options) }
    }

    /// What went over the wires since the beginning.
    pub fn traffic(&self) -> Traffic {
        self.card.spi(|counting| counting.traffic.get())
    }
}

impl<S: Clocked, D: DelayNs> BlockDevice for SpiCard<S, D> {
    type Error = Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Error> {
        self.card.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Error> {
        self.card.write(blocks, start)
    }

    fn num_blocks(&self) -> Result<BlockCount, Error> {
        self.card.num_blocks()
    }
}

impl<S: Clocked, D: DelayNs> Card for SpiCard<S, D> {
    fn start(&self) -> Result<(), Error> {
        self.card.mark_card_uninit();
        self.card.spi(|counting| counting.spi.slow());
        // Reading a sector is what starts the card and tells why it didn't.
        let started = self.card.read(&mut [Block::new()], BlockIdx(0));
        self.card.spi(|counting| counting.spi.fast());
        match started {
            // Read again later, as often as it takes.
            Err(Error::CrcError(..)) | Ok(()) => Ok(()),
            Err(error) => Err(error),
        }
    }

    #[inline(never)]
    fn fault(error: &Error) -> CardFault {
        match error {
            Error::CardNotFound => CardFault::Missing,
            Error::CrcError(..) => CardFault::Checksum,
            Error::Transport
            | Error::TimeoutReadBuffer
            | Error::TimeoutWaitNotBusy
            | Error::TimeoutCommand(_)
            | Error::TimeoutACommand(_) => CardFault::Gone,
            _ => CardFault::Refused,
        }
    }
}

/// Counts what it passes on.
struct Counting<S> {
    spi: S,
    traffic: Cell<Traffic>,
}

impl<S: ErrorType> ErrorType for Counting<S> {
    type Error = S::Error;
}

impl<S: SpiDevice> SpiDevice for Counting<S> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), S::Error> {
        let mut traffic = self.traffic.get();
        for operation in operations.iter() {
            traffic.bytes += match operation {
                Operation::Read(bytes) | Operation::TransferInPlace(bytes) => bytes.len() as u32,
                Operation::Write(bytes) => {
                    // A command frame: start bits 01, five bytes, CRC7 and a stop bit.
                    let command = bytes.len() == 6 && bytes[0] >> 6 == 1;
                    traffic.commands += u32::from(command);
                    bytes.len() as u32
                }
                Operation::Transfer(into, bytes) => into.len().max(bytes.len()) as u32,
                Operation::DelayNs(_) => 0,
            };
        }
        self.traffic.set(traffic);
        self.spi.transaction(operations)
    }
}
