//! SPI0 by DMA: a write is started by its future's first poll and goes on by itself, so that the processor draws meanwhile.
//!
//! ```text
//! processor   start | draws the next band        | polls | ...
//! DMA, SPI          | a byte whenever the SPI's FIFO has room | the FIFO's last bytes
//! free pin    ______/‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾\____________
//! ```
//!
//! The pin is high while a write goes on and nothing waits for it: a logic analyser, or the emulator, sees from it what of a
//! frame is sent beneath the drawing.
//!
//! What it will not do: read by DMA (a display is never read); sleep while it waits.

use core::convert::Infallible;
use core::future::poll_fn;
use core::sync::atomic::{Ordering, fence};
use core::task::Poll;

use crate::chip::hal;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{ErrorType, SpiBus};
use embedded_hal_async::spi::SpiBus as AsyncSpiBus;
use hal::dma::{CH0, Channel, SingleChannel, WriteTarget};
use hal::pac;
use hal::spi::{Enabled, Spi, SpiDevice, ValidSpiPinout};

/// The bus, its DMA channel, and the pin that is high while the processor is free.
pub struct DmaBus<P: ValidSpiPinout<pac::SPI0>, F> {
    spi: Spi<Enabled, pac::SPI0, P, 8>,
    channel: Channel<CH0>,
    free: F,
}

impl<P: ValidSpiPinout<pac::SPI0>, F: OutputPin<Error = Infallible>> DmaBus<P, F> {
    /// Joins them; the pin goes low.
    ///
    /// # Safety
    /// The future of an asynchronous write must not be leaked (`core::mem::forget`) before it is ready: its bytes are
    /// read until its end, and only its end or its drop waits for that.
    pub unsafe fn new(
        spi: Spi<Enabled, pac::SPI0, P, 8>,
        channel: Channel<CH0>,
        mut free: F,
    ) -> Self {
        let Ok(()) = free.set_low();
        DmaBus { spi, channel, free }
    }

    /// Starts to send; the channel is idle.
    fn start(&mut self, bytes: &[u8]) {
        let (data, _) = self.spi.tx_address_count();
        let request = <pac::SPI0 as SpiDevice>::tx_dreq();
        // The band is in memory before the DMA reads it.
        fence(Ordering::SeqCst);
        let channel = self.channel.ch();
        // SAFETY: the DMA reads these bytes, which are borrowed until it has ended (see `new`), and writes to the SPI's data alone.
        unsafe {
            channel.ch_al1_ctrl().write(|w| {
                // Chained to itself: to none.
                w.data_size().bits(0).incr_read().set_bit().incr_write().clear_bit();
                w.treq_sel().bits(request).chain_to().bits(self.channel.id()).en().set_bit()
            });
            channel.ch_read_addr().write(|w| w.bits(bytes.as_ptr() as u32));
            channel.ch_trans_count().write(|w| w.bits(bytes.len() as u32));
            channel.ch_al2_write_addr_trig().write(|w| w.bits(data));
        }
    }

    fn is_sending(&self) -> bool {
        self.channel.ch().ch_ctrl_trig().read().busy().bit_is_set()
    }

    /// Until the last byte is on the wires; drops what came in meanwhile.
    fn settle(&mut self) {
        while self.is_sending() || self.spi.is_busy() {}
        // The bytes may be written to again.
        fence(Ordering::SeqCst);
        // SAFETY: reading takes bytes out of the FIFO of received ones, whose owner is borrowed here.
        let registers = unsafe { &*pac::SPI0::ptr() };
        while registers.sspsr().read().rne().bit_is_set() {
            registers.sspdr().read();
        }
    }
}

/// A write that has begun. Its end, also by a drop, waits until its bytes are read.
struct Sending<'b, P: ValidSpiPinout<pac::SPI0>, F: OutputPin<Error = Infallible>>(
    &'b mut DmaBus<P, F>,
);

impl<P: ValidSpiPinout<pac::SPI0>, F: OutputPin<Error = Infallible>> Drop for Sending<'_, P, F> {
    fn drop(&mut self) {
        let Ok(()) = self.0.free.set_low();
        self.0.settle();
    }
}

impl<P: ValidSpiPinout<pac::SPI0>, F> ErrorType for DmaBus<P, F> {
    type Error = Infallible;
}

impl<P: ValidSpiPinout<pac::SPI0>, F: OutputPin<Error = Infallible>> AsyncSpiBus for DmaBus<P, F> {
    async fn write(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        if bytes.is_empty() {
            return Ok(());
        }
        self.start(bytes);
        let sending = Sending(self);
        let Ok(()) = sending.0.free.set_high();
        let mut begun = false;
        poll_fn(|context| {
            if begun {
                let Ok(()) = sending.0.free.set_low();
            }
            begun = true;
            if !sending.0.is_sending() {
                return Poll::Ready(());
            }
            // There is no interrupt: who waits asks again.
            context.waker().wake_by_ref();
            Poll::Pending
        })
        .await;
        Ok(())
    }

    async fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        self.spi.read(words)
    }

    async fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        self.spi.transfer(read, write)
    }

    async fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        self.spi.transfer_in_place(words)
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        self.spi.flush()
    }
}

/// For whoever starts the display, before there is anything to draw.
impl<P: ValidSpiPinout<pac::SPI0>, F> SpiBus for DmaBus<P, F> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        self.spi.write(bytes)
    }

    fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        self.spi.read(words)
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        self.spi.transfer(read, write)
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        self.spi.transfer_in_place(words)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        self.spi.flush()
    }
}
