//! What the firmware needs of a machine: a start, a stack, text out by semihosting, an end.
//!
//! Semihosting: Arm, "Semihosting for AArch32 and AArch64"; RISC-V, "RISC-V Semihosting" 1.0 (the same operations, another trap).

use core::arch::{asm, global_asm};

/// Prints bytes to a zero.
const SYS_WRITE0: usize = 0x04;
/// Ends the program: reason, exit code.
const SYS_EXIT_EXTENDED: usize = 0x20;
/// The reason "the program has ended".
const APPLICATION_EXIT: usize = 0x2_0026;

// The vector table, all of it faults but for the start. Then the coprocessor access register lets the program use the
// floating-point registers, which the compiler may need for moves; a Cortex-M without them ignores that.
#[cfg(target_arch = "arm")]
global_asm!(
    ".section .start, \"ax\"",
    ".word stack_top",
    ".word start",
    ".rept 14",
    ".word trap",
    ".endr",
    ".global start",
    ".type start, %function",
    ".thumb_func",
    "start:",
    "ldr r0, =0xe000ed88",
    "movs r1, #15",
    "lsls r1, r1, #20",
    "str r1, [r0]",
    "bl {main}",
    ".type trap, %function",
    ".thumb_func",
    "trap:",
    "bl {fault}",
    ".ltorg",
    main = sym main,
    fault = sym fault,
);

// Traps go to the end; the floating-point unit is switched on as above.
#[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
global_asm!(
    ".section .start, \"ax\"",
    ".global start",
    "start:",
    "la t0, trap",
    "csrw mtvec, t0",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "la sp, stack_top",
    "call {main}",
    ".balign 4",
    "trap:",
    "call {fault}",
    main = sym main,
    fault = sym fault,
);

extern "C" fn main() -> ! {
    crate::run(print);
    exit(0)
}

extern "C" fn fault() -> ! {
    print("fault\n");
    exit(1)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    print("panic\n");
    exit(1)
}

fn print(line: &str) {
    // In pieces, so that each can end in the zero that the operation wants.
    for piece in line.as_bytes().chunks(63) {
        let mut text = [0; 64];
        text[..piece.len()].copy_from_slice(piece);
        // SAFETY: `text` holds a zero behind the piece.
        unsafe { call(SYS_WRITE0, text.as_ptr().cast()) };
    }
}

fn exit(code: usize) -> ! {
    // SAFETY: the operation reads two words.
    unsafe { call(SYS_EXIT_EXTENDED, [APPLICATION_EXIT, code].as_ptr().cast()) };
    loop {}
}

/// Asks the debugger or emulator to do `operation`.
///
/// # Safety
/// `argument` points to what the operation reads.
unsafe fn call(operation: usize, argument: *const u8) {
    #[cfg(target_arch = "arm")]
    // SAFETY: the trap is left with nothing changed but r0.
    unsafe {
        asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument);
    }
    #[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
    // SAFETY: the trap is left with nothing changed but a0. The three instructions, all of 32 bits, are what marks it.
    unsafe {
        asm!(
            ".option push",
            ".option norvc",
            ".balign 16",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => _,
            in("a1") argument,
        );
    }
}
