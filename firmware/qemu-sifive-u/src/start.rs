//! From reset to `main`: stacks, cleared memory, the second hart held back until then; and the ends: exit, trap, panic.

use core::arch::global_asm;

use scanout_assets::text::{Value, fill};

use crate::board;
use crate::semihosting::exit;
use crate::uart::Console;

// Hart 1 clears .bss and goes on to `main`; hart 2 waits for that and serves hart 1; the others sleep. The floating-point unit is
// switched on (mstatus.FS), since the compiler may move data through its registers.
global_asm!(
    ".section .start, \"ax\"",
    ".global start",
    "start:",
    "la t0, trap",
    "csrw mtvec, t0",
    "csrw mie, zero",
    "csrr t0, mhartid",
    "li t1, 1",
    "beq t0, t1, 1f",
    "li t1, 2",
    "beq t0, t1, 3f",
    "0:",
    "wfi",
    "j 0b",
    "1:",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "la sp, stack_1",
    // Unused stack keeps this, so that its deepest point can be told.
    "la t0, stacks_start",
    "li t1, {paint}",
    "5:",
    "sd t1, 0(t0)",
    "addi t0, t0, 8",
    "bltu t0, sp, 5b",
    "la t0, bss_start",
    "la t1, bss_end",
    "2:",
    "bgeu t0, t1, 4f",
    "sd zero, 0(t0)",
    "addi t0, t0, 8",
    "j 2b",
    "4:",
    "fence rw, rw",
    "la t0, cleared",
    "li t1, 1",
    "sw t1, 0(t0)",
    "call {main}",
    "3:",
    "la t0, cleared",
    "6:",
    "lw t1, 0(t0)",
    "beqz t1, 6b",
    "fence rw, rw",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "la sp, stack_2",
    "call {second}",
    ".balign 4",
    "trap:",
    "csrr a0, mcause",
    "csrr a1, mepc",
    "csrr a2, mtval",
    "call {fault}",
    ".section .data",
    ".balign 4",
    "cleared:",
    ".word 0",
    paint = const PAINT,
    main = sym main,
    second = sym second,
    fault = sym fault,
);

const PAINT: u64 = 0x5ca7_5ca7_5ca7_5ca7;

extern "C" fn main() -> ! {
    board::run()
}

extern "C" fn second() -> ! {
    board::HARTS.serve()
}

extern "C" fn fault(cause: usize, at: usize, value: usize) -> ! {
    let values = [Value::Number(cause), Value::Hex(at), Value::Hex(value)];
    fill("trap % at %, value %\n", &values, &mut |text| Console.write(text));
    exit(1)
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    Console.write(b"panic");
    // The place alone: the message would draw in formatting of everything.
    if let (true, Some(place)) = (cfg!(feature = "locations"), info.location()) {
        let values = [Value::Text(place.file()), Value::Number(place.line() as usize)];
        fill(": %:%", &values, &mut |text| Console.write(text));
    }
    Console.write(b"\n");
    exit(1)
}

/// Bytes of stack that were never used: of the first hart's and of the second's.
pub fn stack_left() -> [usize; 2] {
    unsafe extern "C" {
        static stacks_start: u64;
        static stack_2: u64;
        static stack_1: u64;
    }
    let untouched = |from: *const u64, to: *const u64| {
        let mut at = from;
        // SAFETY: between the linker script's symbols lies memory, aligned to 16; another hart's stack changes only above.
        while at < to && unsafe { at.read_volatile() } == PAINT {
            at = at.wrapping_add(1);
        }
        at as usize - from as usize
    };
    [
        untouched(&raw const stack_2, &raw const stack_1),
        untouched(&raw const stacks_start, &raw const stack_2),
    ]
}
