//! Raspberry Pi Pico 2 (RP2350) with an ST7789 of 320 x 240, on either kind of its cores: Cortex-M33
//! (`thumbv8m.main-none-eabihf`) or Hazard3 (`riscv32imac-unknown-none-elf`). What it does and its wiring are those
//! of the Pico: see `../rp2040/src/main.rs`; the two boards have the same pins.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../rp2040/src/board.rs"]
mod board;
#[cfg(target_os = "none")]
mod chip;
#[cfg(all(target_os = "none", feature = "dma"))]
#[path = "../../rp2040/src/dma.rs"]
mod dma;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!(
        "this is firmware: cargo build -p rp2350 --release --target thumbv8m.main-none-eabihf"
    );
    std::process::exit(2);
}
