//! From the boot ROM to `main`: stacks, cleared memory, the second hart held back until then; and the ends: trap, panic.

use core::arch::global_asm;

use scanout_assets::text::{Value, fill};

use crate::board;
use crate::chip::Console;

// Hart 0 clears .bss and goes on to `main`; hart 1 waits for that and serves hart 0. The floating-point unit is switched on
// (mstatus.FS), since the compiler may move data through its registers.
global_asm!(
    ".section .start, \"ax\"",
    ".global start",
    "start:",
    "la t0, trap",
    "csrw mtvec, t0",
    "csrw mie, zero",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "csrr t0, mhartid",
    "bnez t0, 3f",
    "la sp, stack_1",
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
    "la sp, stack_2",
    "call {second}",
    ".balign 4",
    "trap:",
    "csrr a0, mcause",
    "csrr a1, mepc",
    "call {fault}",
    ".section .data",
    ".balign 4",
    "cleared:",
    ".word 0",
    main = sym main,
    second = sym second,
    fault = sym fault,
);

extern "C" fn main() -> ! {
    board::run()
}

extern "C" fn second() -> ! {
    board::HARTS.serve()
}

extern "C" fn fault(cause: usize, at: usize) -> ! {
    let values = [Value::Number(cause), Value::Hex(at)];
    fill("trap % at %\n", &values, &mut |text| Console.write(text));
    stop()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    Console.write(b"panic\n");
    stop()
}

fn stop() -> ! {
    loop {
        core::hint::spin_loop();
    }
}
