//! What the boards with two RV64 harts share, in machine mode with nothing beneath it.
//!
//! | module | what |
//! |---|---|
//! | [`start`](mod@start) | from reset to a board's `main`: stacks, cleared memory, the second hart, traps, panics; `sections.ld` beside it |
//! | [`register`] | a device's register |
//! | [`clint`] | time: the core-local interruptor's mtime |
//! | [`uart`] | SiFive's UART, which the K210 has as UARTHS: messages |
//!
//! What it will not do: interrupts, more than two harts, memory in more than one piece.
#![no_std]

pub mod clint;
pub mod register;
#[cfg(target_arch = "riscv64")]
pub mod start;
pub mod uart;
