//! From reset, or a boot ROM, to a board's `main`; and the ends: trap, panic.
//!
//! ```text
//! first hart    paint both stacks, clear .bss, tell | main, on stack_1
//! second hart   wait to be told                     | second, on stack_2
//! others        sleep
//! ```
//!
//! The floating-point unit is switched on (mstatus.FS), since the compiler may move data through its registers.

use core::panic::PanicInfo;

use scanout_assets::text::{Value, fill};

/// Unused stack keeps this, so that its deepest point can be told.
pub const PAINT: u64 = 0x5ca7_5ca7_5ca7_5ca7;

/// Defines `start`, where the linker script of `sections.ld` begins, and the panic handler.
///
/// `harts`: the numbers of the first and of the second; `main`, `second`: what they do, `fn() -> !`; `say`: sends text,
/// `fn(&[u8])`; `stop`: ends after a trap or panic, `fn() -> !`.
#[macro_export]
macro_rules! start {
    (harts: $one:literal, $two:literal; main: $main:path; second: $second:path; say: $say:path; stop: $stop:path;) => {
        core::arch::global_asm!(
            ".section .start, \"ax\"",
            ".global start",
            "start:",
            "la t0, trap",
            "csrw mtvec, t0",
            "csrw mie, zero",
            "li t0, 0x2000",
            "csrs mstatus, t0",
            "csrr t0, mhartid",
            "li t1, {one}",
            "beq t0, t1, 1f",
            "li t1, {two}",
            "beq t0, t1, 3f",
            "0:",
            "wfi",
            "j 0b",
            "1:",
            "la sp, stack_1",
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
            "la sp, stack_2",
            "call {second}",
            ".balign 4",
            "trap:",
            "csrr a0, mcause",
            "csrr a1, mepc",
            "csrr a2, mtval",
            "call {trap}",
            ".section .data",
            ".balign 4",
            "cleared:",
            ".word 0",
            one = const $one,
            two = const $two,
            paint = const $crate::start::PAINT,
            main = sym enter_first,
            second = sym enter_second,
            trap = sym enter_trap,
        );

        extern "C" fn enter_first() -> ! {
            $main()
        }

        extern "C" fn enter_second() -> ! {
            $second()
        }

        extern "C" fn enter_trap(cause: usize, at: usize, value: usize) -> ! {
            $crate::start::tell_trap(cause, at, value, $say);
            $stop()
        }

        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
            $crate::start::tell_panic(info, $say);
            $stop()
        }
    };
}

/// Says which trap was taken: mcause, mepc, mtval.
pub fn tell_trap(cause: usize, at: usize, value: usize, say: fn(&[u8])) {
    let values = [Value::Number(cause), Value::Hex(at), Value::Hex(value)];
    fill("trap % at %, value %\n", &values, &mut |text| say(text));
}

/// Says that there is a panic, and where if feature `locations` is on.
pub fn tell_panic(info: &PanicInfo<'_>, say: fn(&[u8])) {
    say(b"panic");
    // The place alone: the message would draw in formatting of everything.
    if let (true, Some(place)) = (cfg!(feature = "locations"), info.location()) {
        let values = [Value::Text(place.file()), Value::Number(place.line() as usize)];
        fill(": %:%", &values, &mut |text| say(text));
    }
    say(b"\n");
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
