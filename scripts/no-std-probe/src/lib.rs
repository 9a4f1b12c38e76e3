//! A firmware in miniature: no std, no allocator, its own panic handler, and one frame through every stage.
//!
//! It links only if nothing beneath it links std (two panic handlers) or alloc (no allocator). `scripts/no-std-check` then looks
//! at the symbols and instructions of the result.
#![no_std]

mod frame;

use scanout::math::Q16;
use scanout_assets as _;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

/// The hash of a frame (see [`frame::hash`]), so that nothing is optimised away; 0 where it cannot be prepared.
#[unsafe(no_mangle)]
pub extern "C" fn scanout_probe(distance: i16, mode: u8) -> u64 {
    frame::hash(Q16::from_int(distance), mode).unwrap_or(0)
}
