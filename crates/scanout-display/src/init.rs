//! Starting an ST7789: the sequence that mipidsi sends, as a table, for buses that mipidsi doesn't drive.
//!
//! | step | command | parameter | wait |
//! |---|---|---|---|
//! | software reset | 01 | | 150 ms |
//! | sleep out | 11 | | 10 ms (5 are asked; 120 before the next sleep) |
//! | address mode | 36 | orientation, colour order | |
//! | inversion | 20 or 21 | | |
//! | 16 bits a pixel | 3A | 55 | 10 ms |
//! | normal mode | 13 | | 10 ms |
//! | display on | 29 | | 120 ms |
//!
//! With a blocking SPI or parallel bus use mipidsi's `Builder`; it also pulses a reset pin. What is sent here is tested
//! to be what mipidsi sends. Voltages and gamma stay as the controller has them after reset.

use embedded_hal::delay::DelayNs;
use embedded_hal_async::delay::DelayNs as AsyncDelayNs;
use mipidsi::options::{ColorInversion, ColorOrder, Orientation};

use crate::flush::{AsyncInterface, BlockingInterface};
use crate::window::madctl;

/// How the panel is mounted and made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Which way is up.
    pub orientation: Orientation,
    /// Order of the glass's sub-pixels.
    pub order: ColorOrder,
    /// IPS panels with an ST7789 need `Inverted` to show colours as they are.
    pub inversion: ColorInversion,
}

impl Default for Setup {
    fn default() -> Self {
        Setup {
            orientation: Orientation::new(),
            order: ColorOrder::Rgb,
            inversion: ColorInversion::Normal,
        }
    }
}

/// A command, its parameter if it has one, and how long to wait after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The command.
    pub command: u8,
    /// Its parameter.
    pub parameter: Option<u8>,
    /// Milliseconds to wait.
    pub wait_ms: u8,
}

impl Setup {
    /// The sequence.
    pub fn steps(&self) -> [Step; 7] {
        let step = |command, parameter, wait_ms| Step { command, parameter, wait_ms };
        let inversion = match self.inversion {
            ColorInversion::Normal => 0x20,
            ColorInversion::Inverted => 0x21,
        };
        [
            step(0x01, None, 150),
            step(0x11, None, 10),
            step(0x36, Some(madctl(self.orientation, self.order)), 0),
            step(inversion, None, 0),
            step(0x3a, Some(0x55), 10),
            step(0x13, None, 10),
            step(0x29, None, 120),
        ]
    }

    /// Starts the display.
    ///
    /// # Errors
    /// What the bus says.
    pub fn start<I: BlockingInterface>(
        &self,
        interface: &mut I,
        delay: &mut impl DelayNs,
    ) -> Result<(), I::Error> {
        for step in self.steps() {
            interface.command(step.command, step.parameter.as_slice())?;
            delay.delay_ms(step.wait_ms as u32);
        }
        Ok(())
    }

    /// Starts the display, asynchronously.
    ///
    /// # Errors
    /// What the bus says.
    pub async fn start_async<I: AsyncInterface>(
        &self,
        interface: &mut I,
        delay: &mut impl AsyncDelayNs,
    ) -> Result<(), I::Error> {
        for step in self.steps() {
            interface.command(step.command, step.parameter.as_slice()).await?;
            delay.delay_ms(step.wait_ms as u32).await;
        }
        Ok(())
    }
}
