//! What the emulator does for its guest: the display's bytes out, the end of the program.
//!
//! RISC-V Semihosting 1.0, with the operations of Arm's "Semihosting for AArch32 and AArch64".

use core::arch::asm;
use core::sync::atomic::{AtomicUsize, Ordering};

use embedded_hal::delay::DelayNs;

use crate::board::Clock;

/// Opens a file: name, mode, length of the name. Gives a handle, or -1.
const SYS_OPEN: usize = 0x01;
/// Writes: handle, bytes, their number. Gives the number of those left.
const SYS_WRITE: usize = 0x05;
/// Ends the program: reason, exit code.
const SYS_EXIT_EXTENDED: usize = 0x20;
/// The reason "the program has ended".
const APPLICATION_EXIT: usize = 0x2_0026;
/// Mode "w".
const TO_WRITE: usize = 4;
/// How long nothing may be taken before the line counts as dead, microseconds.
const PATIENCE: u64 = 500_000;
/// No handle yet.
const NONE: usize = usize::MAX;

static HANDLE: AtomicUsize = AtomicUsize::new(NONE);

/// Does an operation on a block of words.
///
/// # Safety
/// The block is what the operation wants.
unsafe fn call<const N: usize>(operation: usize, block: [usize; N]) -> usize {
    let mut result = operation;
    // SAFETY: the three instructions, all of 32 bits, are what marks the call; it changes a0 and what the block points to.
    unsafe {
        asm!(
            ".option push",
            ".option norvc",
            ".balign 16",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") result,
            in("a1") block.as_ptr(),
        );
    }
    result
}

/// Nobody takes the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stuck {
    /// Bytes that did go out.
    pub sent: usize,
}

/// Sends bytes to the emulator's console, from either hart, one at a time.
///
/// # Errors
/// When nobody takes one for half a second.
pub fn write(bytes: &[u8]) -> Result<(), Stuck> {
    if HANDLE.load(Ordering::Relaxed) == NONE {
        let name = b":tt\0";
        // SAFETY: a name that ends in a zero, its length without that.
        let handle = unsafe { call(SYS_OPEN, [name.as_ptr() as usize, TO_WRITE, 3]) };
        HANDLE.store(handle, Ordering::Relaxed);
    }
    let handle = HANDLE.load(Ordering::Relaxed);
    let (mut sent, mut since) = (0, Clock::now());
    while sent < bytes.len() {
        let rest = &bytes[sent..];
        // SAFETY: the bytes are there.
        let left = unsafe { call(SYS_WRITE, [handle, rest.as_ptr() as usize, rest.len()]) };
        // A reader that is slower than this takes a part, or nothing for a while.
        let taken = rest.len().saturating_sub(left);
        if taken > 0 {
            sent += taken;
            since = Clock::now();
        } else if Clock::now() - since > PATIENCE {
            return Err(Stuck { sent });
        }
    }
    Ok(())
}

/// Ends the emulator.
pub fn exit(code: usize) -> ! {
    // What the UART still has in its FIFO goes out first.
    Clock {}.delay_ms(5);
    // SAFETY: the operation reads two words.
    unsafe { call(SYS_EXIT_EXTENDED, [APPLICATION_EXIT, code]) };
    loop {
        core::hint::spin_loop();
    }
}
