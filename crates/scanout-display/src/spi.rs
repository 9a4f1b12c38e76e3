//! Four-wire SPI: a `SpiDevice` (clock, data, chip select) and the D/C pin, low for a command's byte, high for its
//! parameters and for pixels.
//!
//! One type serves three: mipidsi's `Interface`, so that mipidsi starts the display; then, taken back with
//! `Display::release`, [`flush`](crate::flush)'s blocking and asynchronous interfaces, which send a band's memory as it
//! is. A blocking HAL gives the first two, an asynchronous one the third.
//!
//! ```text
//! CS   ‾\____________________________________/‾
//! D/C  ‾‾\____/‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾
//! data    2C   hi lo hi lo hi lo ...                each edge of D/C between two transactions of the SpiDevice
//! ```

use core::fmt;

use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use embedded_hal_async::spi::SpiDevice as AsyncSpiDevice;
use mipidsi::interface::{Interface, InterfaceKind};

use crate::flush::{AsyncInterface, BlockingInterface};

/// Bytes gathered on the stack for pixels that come from an iterator (mipidsi's own drawing).
const GATHER: usize = 64;

/// A display's SPI device and D/C pin.
#[derive(Clone, Copy, Debug)]
pub struct SpiLink<S, D> {
    spi: S,
    dc: D,
}

impl<S, D> SpiLink<S, D> {
    /// A link over a device in SPI mode 0 or 3, at most 62.5 MHz for an ST7789, and the pin wired to D/C.
    pub fn new(spi: S, dc: D) -> Self {
        SpiLink { spi, dc }
    }

    /// Gives both back.
    pub fn release(self) -> (S, D) {
        (self.spi, self.dc)
    }
}

/// What failed. `S` and `D` are the HAL's own errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiError<S, D> {
    /// The SPI device.
    Spi(S),
    /// The D/C pin.
    DataCommand(D),
}

impl<S: fmt::Debug, D: fmt::Debug> fmt::Display for SpiError<S, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SpiError::Spi(e) => write!(f, "SPI: {e:?}"),
            SpiError::DataCommand(e) => write!(f, "D/C pin: {e:?}"),
        }
    }
}

impl<S: fmt::Debug, D: fmt::Debug> core::error::Error for SpiError<S, D> {}

impl<S: SpiDevice, D: OutputPin> BlockingInterface for SpiLink<S, D> {
    type Error = SpiError<S::Error, D::Error>;

    fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), Self::Error> {
        self.dc.set_low().map_err(SpiError::DataCommand)?;
        self.spi.write(&[command]).map_err(SpiError::Spi)?;
        self.dc.set_high().map_err(SpiError::DataCommand)?;
        if parameters.is_empty() { Ok(()) } else { self.data(parameters) }
    }

    fn data(&mut self, bytes: &[u8]) -> Result<(), Self::Error> {
        self.spi.write(bytes).map_err(SpiError::Spi)
    }
}

impl<S: AsyncSpiDevice, D: OutputPin> AsyncInterface for SpiLink<S, D> {
    type Error = SpiError<S::Error, D::Error>;

    async fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), Self::Error> {
        self.dc.set_low().map_err(SpiError::DataCommand)?;
        self.spi.write(&[command]).await.map_err(SpiError::Spi)?;
        self.dc.set_high().map_err(SpiError::DataCommand)?;
        if parameters.is_empty() { Ok(()) } else { AsyncInterface::data(self, parameters).await }
    }

    async fn data(&mut self, bytes: &[u8]) -> Result<(), Self::Error> {
        self.spi.write(bytes).await.map_err(SpiError::Spi)
    }
}

impl<S: SpiDevice, D: OutputPin> Interface for SpiLink<S, D> {
    type Word = u8;
    type Error = SpiError<S::Error, D::Error>;
    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, args: &[u8]) -> Result<(), Self::Error> {
        BlockingInterface::command(self, command, args)
    }

    fn send_pixels<const N: usize>(
        &mut self,
        pixels: impl IntoIterator<Item = [u8; N]>,
    ) -> Result<(), Self::Error> {
        let (mut gathered, mut length) = ([0; GATHER], 0);
        for byte in pixels.into_iter().flatten() {
            gathered[length] = byte;
            length += 1;
            if length == GATHER {
                BlockingInterface::data(self, &gathered)?;
                length = 0;
            }
        }
        if length == 0 { Ok(()) } else { BlockingInterface::data(self, &gathered[..length]) }
    }

    fn send_repeated_pixel<const N: usize>(
        &mut self,
        pixel: [u8; N],
        count: u32,
    ) -> Result<(), Self::Error> {
        self.send_pixels((0..count).map(|_| pixel))
    }
}
