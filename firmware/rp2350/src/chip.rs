//! What is the RP2350's own.

use rp235x_hal::block::ImageDef;

pub use rp235x_hal as hal;

/// Tells the ROM that this is a program, and for which of the two kinds of cores. It looks in the first 4 KB.
#[cfg_attr(target_arch = "arm", unsafe(link_section = ".start_block"))]
#[cfg_attr(target_arch = "riscv32", unsafe(link_section = ".init.rust"))]
#[used]
static IMAGE: ImageDef = ImageDef::secure_exe();

/// The timer.
macro_rules! timer {
    ($chip:ident, $clocks:ident) => {
        hal::Timer::new_timer0($chip.TIMER0, &mut $chip.RESETS, &$clocks)
    };
}
pub(crate) use timer;
