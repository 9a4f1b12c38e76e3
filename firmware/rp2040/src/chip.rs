//! What is the RP2040's own.

pub use rp2040_hal as hal;

/// The second stage of the boot: the ROM copies it into memory, and it makes the flash readable.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_GENERIC_03H;

/// The timer.
macro_rules! timer {
    ($chip:ident, $clocks:ident) => {
        hal::Timer::new($chip.TIMER, &mut $chip.RESETS, &$clocks)
    };
}
pub(crate) use timer;
