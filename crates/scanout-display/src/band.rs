//! Bands through `mipidsi`: one window, one memory write, and the band's pixels in one go.
//!
//! Two doors. [`show`] takes mipidsi's `Display`, which knows its orientation and offset. [`write`](fn@write) takes the
//! `Interface` beneath it (a `SpiInterface`, a `ParallelInterface` of 8 or 16 wires, or one's own) and an [`Area`].
//! Both send
//!
//! ```text
//! 2A x0 x0 x1 x1   2B y0 y0 y1 y1   2C   hi lo  hi lo  hi lo ...        (one 16-bit word a pixel where the bus has 16 wires)
//! ```
//!
//! mipidsi's interfaces take pixels from an iterator: its SPI one fills a buffer and sends that, so a band is copied
//! once, in pieces of that buffer (512 bytes serve well). Who wants the copy gone, or DMA, uses
//! [`flush`](crate::flush), which sends the band's memory itself.

use core::fmt;

use embedded_graphics_core::pixelcolor::{self, raw::RawU16};
use embedded_graphics_core::prelude::OriginDimensions;
use embedded_hal::digital::OutputPin;
use mipidsi::Display;
use mipidsi::interface::{Interface, InterfacePixelFormat};
use mipidsi::models::Model;
use scanout::frame::Band;
use scanout::output::Rgb565;

use crate::window::{Area, CASET, Outside, RAMWR, RASET, Window};

/// Why a band was not shown. `E` is the bus's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SendError<E> {
    /// The band is not within the display.
    Outside(Outside),
    /// The colour memory is not what width and rows say.
    Length {
        /// Pixels needed: rows x width, or a multiple of the width.
        needed: usize,
        /// Pixels given.
        given: usize,
    },
    /// The bus failed; the picture on the display is undefined from this band on.
    Bus(E),
}

impl<E> From<Outside> for SendError<E> {
    fn from(outside: Outside) -> Self {
        SendError::Outside(outside)
    }
}

/// Errors of embedded-hal's buses are `Debug` and no more.
impl<E: fmt::Debug> fmt::Display for SendError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SendError::Outside(outside) => outside.fmt(f),
            SendError::Length { needed, given } => {
                write!(f, "the band has {given} pixels of colour memory; {needed} are needed")
            }
            SendError::Bus(e) => write!(f, "the display's bus failed: {e:?}"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for SendError<E> {}

/// A word of a display bus, 8 or 16 bits: how a pixel is made of it.
pub trait Word: Copy + sealed::Sealed {
    /// Sends pixels; memory write has been commanded.
    #[doc(hidden)]
    fn send<I: Interface<Word = Self>>(interface: &mut I, pixels: &[u16]) -> Result<(), I::Error>;
}

impl Word for u8 {
    fn send<I: Interface<Word = u8>>(interface: &mut I, pixels: &[u16]) -> Result<(), I::Error> {
        interface.send_pixels(pixels.iter().map(|pixel| pixel.to_be_bytes()))
    }
}

impl Word for u16 {
    fn send<I: Interface<Word = u16>>(interface: &mut I, pixels: &[u16]) -> Result<(), I::Error> {
        interface.send_pixels(pixels.iter().map(|&pixel| [pixel]))
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
}

/// The band's pixels, when there are as many as it says.
fn pixels<'b, E>(band: &Band<'b, Rgb565>) -> Result<&'b [u16], SendError<E>> {
    let needed = band.rows as usize * band.width as usize;
    band.colour.get(..needed).ok_or(SendError::Length { needed, given: band.colour.len() })
}

/// Shows a band on a display that mipidsi has started; the frame's pixel (0, 0) is the display's.
///
/// # Errors
/// When the band is not within the display as it is turned now, or the bus fails.
pub fn show<I, M, R>(
    display: &mut Display<I, M, R>,
    band: &Band<'_, Rgb565>,
) -> Result<(), SendError<I::Error>>
where
    I: Interface,
    M: Model<ColorFormat = pixelcolor::Rgb565>,
    pixelcolor::Rgb565: InterfacePixelFormat<I::Word>,
    R: OutputPin,
{
    let (size, pixels) = (display.size(), pixels(band)?);
    // A display's sides are u16 in mipidsi. The display adds its offset itself.
    let area = Area { left: 0, top: 0, width: size.width as u16, height: size.height as u16 };
    let Window { columns, rows } = area.window(band.top, band.rows, band.width)?;
    // Rgb565 of embedded-graphics is the same 16 bits; the conversions vanish.
    let colours = pixels.iter().map(|&pixel| pixelcolor::Rgb565::from(RawU16::new(pixel)));
    display.set_pixels(columns[0], rows[0], columns[1], rows[1], colours).map_err(SendError::Bus)
}

/// Writes a band through mipidsi's interface, to a display that is awake and takes 16 bits a pixel.
///
/// # Errors
/// When the band is not within the area, or the bus fails.
pub fn write<I: Interface>(
    interface: &mut I,
    area: Area,
    band: &Band<'_, Rgb565>,
) -> Result<(), SendError<I::Error>>
where
    I::Word: Word,
{
    let pixels = pixels(band)?;
    let window = area.window(band.top, band.rows, band.width)?;
    let mut send = || {
        interface.send_command(CASET, &window.caset())?;
        interface.send_command(RASET, &window.raset())?;
        interface.send_command(RAMWR, &[])?;
        I::Word::send(interface, pixels)
    };
    send().map_err(SendError::Bus)
}
