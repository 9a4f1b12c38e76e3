//! SiFive's UART: messages (FU540-C000 Manual v1p4, chapter 13).

use crate::register::Register;

/// The transmitter's FIFO has no room.
const FULL: u32 = 1 << 31;

/// A UART at an address.
#[derive(Clone, Copy)]
pub struct Uart(pub usize);

impl Uart {
    /// Switches its transmitter on; a bit takes `clocks` of the UART's own.
    pub fn start(self, clocks: u32) {
        Register(self.0 + 0x18).write(clocks - 1);
        Register(self.0 + 0x08).write(1);
    }

    /// Sends text.
    pub fn write(self, text: &[u8]) {
        let data = Register(self.0);
        for &byte in text {
            while data.read() & FULL != 0 {}
            data.write(byte.into());
        }
    }
}
