//! Flush: a band's memory goes to the bus as it is.
//!
//! Colour memory is `u16`, the display wants the high byte first. [`wire_bytes`] swaps the bytes where the pixels are
//! (one pass, two pixels a word; nothing on a big-endian machine) and gives the memory as bytes, so DMA sends
//! the buffer that the pipeline drew in: no second buffer, no copy. The band is spent by that; the next band is drawn
//! over it.
//!
//! | | blocking | asynchronous |
//! |---|---|---|
//! | the bus | [`BlockingInterface`] | [`AsyncInterface`] |
//! | a band | [`flush`](fn@flush) | [`flush_async`] |
//! | a frame | [`show`], one buffer | [`DoubleBuffer::show`], two: one is sent while the next is drawn |
//!
//! [`SpiLink`](crate::spi::SpiLink) is both interfaces over SPI; two methods make one of any other bus.
//!
//! What it will not do: retry. After an error of the bus the next frame begins with a window of its own, so showing a
//! whole frame again recovers whatever the display received.

mod double;

use core::fmt;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

use scanout::frame::{BandError, DrawError, Frame};

pub use double::DoubleBuffer;

use crate::band::SendError;
use crate::target::BandTarget;
use crate::window::{Area, CASET, RAMWR, RASET, Window};

/// A display's bus that returns when the bytes are sent.
pub trait BlockingInterface {
    /// The bus's error.
    type Error: fmt::Debug;
    /// Sends a command's byte with D/C low, then its parameters with D/C high.
    ///
    /// # Errors
    /// What the bus says.
    fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), Self::Error>;
    /// Sends bytes with D/C high.
    ///
    /// # Errors
    /// What the bus says.
    fn data(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;
}

/// A display's bus that sends while the processor does something else.
///
/// The future of [`data`](Self::data) must start the transfer when it is first polled, as those of HALs with DMA do;
/// then [`DoubleBuffer`] draws beneath it.
#[allow(async_fn_in_trait)] // whether the futures are Send is the bus's affair, and one-core executors don't ask
pub trait AsyncInterface {
    /// The bus's error.
    type Error: fmt::Debug;
    /// Sends a command's byte with D/C low, then its parameters with D/C high.
    ///
    /// # Errors
    /// What the bus says.
    async fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), Self::Error>;
    /// Sends bytes with D/C high.
    ///
    /// # Errors
    /// What the bus says.
    async fn data(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;
}

/// Pixels as the display receives them: swaps their bytes in place (on little-endian machines) and gives them.
///
/// ```
/// let mut colour = [0xf800, 0x001f];
/// assert_eq!(scanout_display::flush::wire_bytes(&mut colour), [0xf8, 0x00, 0x00, 0x1f]);
/// ```
pub fn wire_bytes(colour: &mut [u16]) -> &[u8] {
    if cfg!(target_endian = "little") {
        // Two at a time, since the band is gone through once more for this.
        let (first, pairs, last) = bytemuck::pod_align_to_mut::<u16, u32>(colour);
        for pixel in first.iter_mut().chain(last) {
            *pixel = pixel.swap_bytes();
        }
        for pair in pairs {
            *pair = pair.swap_bytes().rotate_left(16);
        }
    }
    bytemuck::cast_slice(colour)
}

/// The window of whole rows of the area's width from row `top` on.
fn window_of<E>(area: Area, top: u16, pixels: usize) -> Result<Window, SendError<E>> {
    let width = (area.width as usize).max(1);
    if !pixels.is_multiple_of(width) {
        return Err(SendError::Length { needed: pixels.next_multiple_of(width), given: pixels });
    }
    // More rows than u16 holds are outside in any case.
    let rows = u16::try_from(pixels / width).unwrap_or(u16::MAX);
    Ok(area.window(top, rows, area.width)?)
}

/// Sends rows of the area's width, from row `top` of the frame on; `colour` holds the sent bytes afterwards.
///
/// # Errors
/// When `colour` is not whole rows within the area, or the bus fails.
pub fn flush<I: BlockingInterface>(
    interface: &mut I,
    area: Area,
    top: u16,
    colour: &mut [u16],
) -> Result<(), SendError<I::Error>> {
    let window = window_of(area, top, colour.len())?;
    let mut send = || {
        interface.command(CASET, &window.caset())?;
        interface.command(RASET, &window.raset())?;
        interface.command(RAMWR, &[])?;
        interface.data(wire_bytes(colour))
    };
    send().map_err(SendError::Bus)
}

/// The same, asynchronously.
///
/// # Errors
/// When `colour` is not whole rows within the area, or the bus fails.
pub async fn flush_async<I: AsyncInterface>(
    interface: &mut I,
    area: Area,
    top: u16,
    colour: &mut [u16],
) -> Result<(), SendError<I::Error>> {
    let window = window_of(area, top, colour.len())?;
    open(interface, window).await.map_err(SendError::Bus)?;
    interface.data(wire_bytes(colour)).await.map_err(SendError::Bus)
}

/// Sets the window and commands the memory write.
async fn open<I: AsyncInterface>(interface: &mut I, window: Window) -> Result<(), I::Error> {
    interface.command(CASET, &window.caset()).await?;
    interface.command(RASET, &window.raset()).await?;
    interface.command(RAMWR, &[]).await
}

/// The rows that fit the memory: an error when there is not one.
fn lines_of(width: u16, colour: usize, depth: usize) -> Result<u16, BandError> {
    let row = (width as usize).max(1);
    match colour.min(depth) / row {
        0 => Err(BandError::Memory { colour: row, depth: row }),
        lines => Ok(u16::try_from(lines).unwrap_or(u16::MAX)),
    }
}

/// Draws a frame in bands as tall as the memory allows, lets `on_top` draw on each, and sends it.
///
/// The frame's width must be the area's.
///
/// # Errors
/// When the memory is too small for a row, the frame doesn't fit the area, or the bus fails.
pub fn show<I: BlockingInterface>(
    frame: &Frame<'_>,
    interface: &mut I,
    area: Area,
    colour: &mut [u16],
    depth: &mut [u16],
    mut on_top: impl FnMut(&mut BandTarget<'_>),
) -> Result<(), DrawError<SendError<I::Error>>> {
    let (width, height) = (frame.settings().width, frame.settings().height);
    let lines = lines_of(width, colour.len(), depth.len()).map_err(DrawError::Band)?;
    fits(frame, area).map_err(DrawError::Sink)?;
    let mut top = 0;
    while top < height {
        let bottom = height.min(top.saturating_add(lines));
        let band = &mut colour[..(bottom - top) as usize * width as usize];
        frame.draw_rows_rgb565(top..bottom, band, depth).map_err(DrawError::Band)?;
        on_top(&mut BandTarget::new(band, (width, height), top));
        flush(interface, area, top, band).map_err(DrawError::Sink)?;
        top = bottom;
    }
    Ok(())
}

/// Whether a frame has the area's width and no more rows; said before anything is drawn or sent.
fn fits<E>(frame: &Frame<'_>, area: Area) -> Result<(), SendError<E>> {
    let (width, height) = (frame.settings().width, frame.settings().height);
    area.window(0, height, width)?;
    if width == area.width {
        return Ok(());
    }
    Err(SendError::Length { needed: area.width as usize, given: width as usize })
}

/// Runs a future to its end by asking it again and again: an executor for firmware that has none.
pub fn block_on<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
        core::hint::spin_loop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_must_be_whole_and_within() {
        let area = Area { left: 0, top: 0, width: 8, height: 4 };
        assert_eq!(window_of::<()>(area, 2, 16).unwrap().rows, [2, 3]);
        let cut = window_of::<()>(area, 0, 9);
        assert_eq!(cut, Err(SendError::Length { needed: 16, given: 9 }));
        assert!(matches!(window_of::<()>(area, 3, 16), Err(SendError::Outside(_))));
        assert!(matches!(window_of::<()>(area, 0, 0), Err(SendError::Outside(_))));
        assert!(matches!(window_of::<()>(area, 0, 8 << 20), Err(SendError::Outside(_))));
    }

    #[test]
    fn bytes_are_swapped_wherever_the_band_begins_and_ends() {
        for (first, end) in [(0, 8), (1, 8), (0, 7), (1, 7), (3, 3), (4, 5), (5, 6)] {
            let mut colour = [0x0102, 0x0304, 0x0506, 0x0708, 0x090a, 0x0b0c, 0x0d0e, 0x0f10];
            let expected: [u8; 16] = core::array::from_fn(|i| i as u8 + 1);
            let sent = wire_bytes(&mut colour[first..end]);
            assert_eq!(sent, &expected[2 * first..2 * end], "{first}..{end}");
        }
    }

    #[test]
    fn memory_decides_the_lines() {
        assert_eq!(lines_of(320, 320 * 16 + 319, 320 * 20), Ok(16));
        let needed = BandError::Memory { colour: 320, depth: 320 };
        assert_eq!(lines_of(320, 319, 9999), Err(needed));
    }
}
