//! Wires to the model, for drivers that expect a bus: mipidsi's `Interface`, or a `SpiDevice` and pins beneath it.
//!
//! ```text
//!   Builder::new(ST7789, wires.interface())                              one step above the bus
//!   Builder::new(ST7789, SpiInterface::new(wires.spi(), wires.dc(), ..)) each byte with the level of D/C
//!          .reset_pin(wires.reset())
//! ```
//!
//! All ends belong to one model, which [`Wires::model`] looks at. A byte that the model refuses comes back as the bus's
//! error, so a driver stops where it went wrong.

use std::cell::{Cell, Ref, RefCell, RefMut};
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};
use embedded_hal_async::delay::DelayNs as AsyncDelayNs;
use embedded_hal_async::spi::SpiDevice as AsyncSpiDevice;
use mipidsi::interface::{Interface, InterfaceKind};

use super::{DisplayModel, ModelError};

#[derive(Debug, Default)]
struct Shared {
    model: RefCell<DisplayModel>,
    dc: Cell<bool>,
}

/// A model with wires to it.
#[derive(Clone, Debug, Default)]
pub struct Wires(Rc<Shared>);

impl Wires {
    /// Wires to a model.
    pub fn new(model: DisplayModel) -> Self {
        Wires(Rc::new(Shared { model: RefCell::new(model), dc: Cell::new(false) }))
    }

    /// The model.
    ///
    /// # Panics
    /// While [`model_mut`](Self::model_mut)'s answer lives.
    pub fn model(&self) -> Ref<'_, DisplayModel> {
        self.0.model.borrow()
    }

    /// The model, to change it.
    ///
    /// # Panics
    /// While another borrow lives.
    pub fn model_mut(&self) -> RefMut<'_, DisplayModel> {
        self.0.model.borrow_mut()
    }

    /// An interface for mipidsi.
    pub fn interface(&self) -> WiresInterface {
        WiresInterface(self.clone())
    }

    /// The SPI device.
    pub fn spi(&self) -> WiresSpi {
        WiresSpi(self.clone())
    }

    /// The D/C pin.
    pub fn dc(&self) -> WiresDc {
        WiresDc(self.clone())
    }

    /// The reset pin.
    pub fn reset(&self) -> WiresReset {
        WiresReset(self.clone())
    }
}

/// mipidsi's interface to the model.
#[derive(Clone, Debug)]
pub struct WiresInterface(Wires);

impl Interface for WiresInterface {
    type Word = u8;
    type Error = ModelError;
    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, args: &[u8]) -> Result<(), ModelError> {
        let mut model = self.0.model_mut();
        model.feed(command, false)?;
        model.feed_all(args, true)
    }

    fn send_pixels<const N: usize>(
        &mut self,
        pixels: impl IntoIterator<Item = [u8; N]>,
    ) -> Result<(), ModelError> {
        let mut model = self.0.model_mut();
        pixels.into_iter().try_for_each(|pixel| model.feed_all(&pixel, true))
    }

    fn send_repeated_pixel<const N: usize>(
        &mut self,
        pixel: [u8; N],
        count: u32,
    ) -> Result<(), ModelError> {
        self.send_pixels((0..count).map(|_| pixel))
    }
}

/// The SPI device; reads give zeros.
#[derive(Clone, Debug)]
pub struct WiresSpi(Wires);

impl WiresSpi {
    fn operate(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ModelError> {
        let (mut model, data) = (self.0.model_mut(), self.0.0.dc.get());
        for operation in operations {
            match operation {
                Operation::Read(into) => into.fill(0),
                Operation::Write(bytes) => model.feed_all(bytes, data)?,
                Operation::Transfer(into, bytes) => {
                    into.fill(0);
                    model.feed_all(bytes, data)?;
                }
                Operation::TransferInPlace(bytes) => {
                    model.feed_all(bytes, data)?;
                    bytes.fill(0);
                }
                Operation::DelayNs(_) => {}
            }
        }
        Ok(())
    }
}

impl spi::Error for ModelError {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl spi::ErrorType for WiresSpi {
    type Error = ModelError;
}

impl SpiDevice for WiresSpi {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ModelError> {
        self.operate(operations)
    }
}

impl AsyncSpiDevice for WiresSpi {
    async fn transaction(
        &mut self,
        operations: &mut [Operation<'_, u8>],
    ) -> Result<(), ModelError> {
        self.operate(operations)
    }
}

/// The D/C pin; low at first.
#[derive(Clone, Debug)]
pub struct WiresDc(Wires);

impl digital::ErrorType for WiresDc {
    type Error = Infallible;
}

impl OutputPin for WiresDc {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.0.dc.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.0.dc.set(true);
        Ok(())
    }
}

/// The reset pin; high at first.
#[derive(Clone, Debug)]
pub struct WiresReset(Wires);

impl digital::ErrorType for WiresReset {
    type Error = Infallible;
}

impl OutputPin for WiresReset {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.model_mut().reset(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.model_mut().reset(true);
        Ok(())
    }
}

/// A delay that doesn't wait: the model has no time.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _ns: u32) {}
}

impl AsyncDelayNs for NoDelay {
    async fn delay_ns(&mut self, _ns: u32) {}
}
