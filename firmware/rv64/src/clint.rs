//! Time: mtime of SiFive's core-local interruptor (FU540-C000 Manual v1p4, chapter 9; the K210 has the same).

use embedded_hal::delay::DelayNs;

const MTIME: usize = 0x0200_bff8;

/// The clock; `TENTHS`: steps of mtime in ten microseconds, 10 at 1 MHz.
#[derive(Clone, Copy)]
pub struct Clock<const TENTHS: u64>;

impl<const TENTHS: u64> Clock<TENTHS> {
    /// Steps since reset.
    pub fn now() -> u64 {
        // SAFETY: the register is there on both machines; 64 bits are read at once.
        unsafe { (MTIME as *const u64).read_volatile() }
    }
}

impl<const TENTHS: u64> DelayNs for Clock<TENTHS> {
    /// Waits for so long or up to two steps longer.
    fn delay_ns(&mut self, ns: u32) {
        let end = Self::now() + u64::from(ns) * TENTHS / 10_000 + 1;
        while Self::now() < end {
            core::hint::spin_loop();
        }
    }
}
