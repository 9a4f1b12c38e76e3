//! Two band buffers: while one is sent, the next band is drawn in the other.
//!
//! ```text
//! processor  draw 0 | w | draw 1 | w | draw 2 | w | ...        w: the window's 11 bytes
//! bus               | w | send 0 | w | send 1 | w | ...
//! ```
//!
//! A frame takes the longer of drawing and sending, not their sum: at 40 MHz 16 lines of 320 pixels are sent in 2 ms.
//! Depth memory is needed by the drawing alone, so there is one: bands of 16 lines take 2 x 10,240 + 10,240 bytes.
//!
//! It is one task: the transfer is started by a first poll, drawing then runs to its end, and the transfer is awaited.
//! A HAL that splits a transfer goes on with the second piece only when polled again, so give it bands that its DMA
//! sends in one (most: 65,535 bytes).
//!
//! What it will not do: overlap the last band with the next frame, whose vertices have to be prepared in between.

use core::future::poll_fn;
use core::pin::pin;
use core::task::Poll;

use scanout::frame::{DrawError, Frame};

use super::{AsyncInterface, fits, lines_of, open, window_of, wire_bytes};
use crate::band::SendError;
use crate::target::BandTarget;
use crate::window::Area;

/// Two buffers of colour and one of depth; the caller's memory.
#[derive(Debug)]
pub struct DoubleBuffer<'m> {
    front: &'m mut [u16],
    back: &'m mut [u16],
    depth: &'m mut [u16],
}

impl<'m> DoubleBuffer<'m> {
    /// Joins the memory; the smallest of the three decides how many lines a band has.
    pub fn new(colour: [&'m mut [u16]; 2], depth: &'m mut [u16]) -> Self {
        let [front, back] = colour;
        DoubleBuffer { front, back, depth }
    }

    /// Draws a frame in bands, lets `on_top` draw on each, and sends it while the next one is drawn.
    ///
    /// The frame's width must be the area's.
    ///
    /// # Errors
    /// When the memory is too small for a row, the frame doesn't fit the area, or the bus fails.
    pub async fn show<I: AsyncInterface>(
        &mut self,
        frame: &Frame<'_>,
        interface: &mut I,
        area: Area,
        mut on_top: impl FnMut(&mut BandTarget<'_>),
    ) -> Result<(), DrawError<SendError<I::Error>>> {
        let (width, height) = (frame.settings().width, frame.settings().height);
        let memory = self.front.len().min(self.back.len());
        let lines = lines_of(width, memory, self.depth.len()).map_err(DrawError::Band)?;
        fits(frame, area).map_err(DrawError::Sink)?;

        let depth = &mut *self.depth;
        let mut draw = |top: u16, colour: &mut [u16]| {
            let bottom = height.min(top.saturating_add(lines));
            let length = (bottom - top) as usize * width as usize;
            let band = &mut colour[..length];
            frame.draw_rows_rgb565(top..bottom, band, depth)?;
            on_top(&mut BandTarget::new(band, (width, height), top));
            Ok((bottom, length))
        };
        let (mut sending, mut drawing) = (&mut *self.front, &mut *self.back);
        let mut top = 0;
        let (mut bottom, mut length) = draw(top, sending).map_err(DrawError::Band)?;
        loop {
            let window = window_of(area, top, length).map_err(DrawError::Sink)?;
            let bus = |e| DrawError::Sink(SendError::Bus(e));
            open(interface, window).await.map_err(bus)?;
            let transfer = interface.data(wire_bytes(&mut sending[..length]));
            if bottom >= height {
                return transfer.await.map_err(bus);
            }
            let (sent, drawn) = beneath(transfer, || draw(bottom, drawing)).await;
            sent.map_err(bus)?;
            top = bottom;
            (bottom, length) = drawn.map_err(DrawError::Band)?;
            core::mem::swap(&mut sending, &mut drawing);
        }
    }
}

/// Starts a transfer, works, and waits for the transfer.
async fn beneath<F: Future, T>(transfer: F, work: impl FnOnce() -> T) -> (F::Output, T) {
    let mut transfer = pin!(transfer);
    let started = poll_fn(|context| Poll::Ready(transfer.as_mut().poll(context))).await;
    let worked = work();
    match started {
        Poll::Ready(output) => (output, worked),
        Poll::Pending => (transfer.await, worked),
    }
}
