//! ESP32-C3 (RV32IMC) with an ST7789 of 320 x 240: models C and A of system B, baked into flash, turn in bands of 16 lines.
//!
//! | display | ESP32-C3-DevKitM-1 | |
//! |---|---|---|
//! | SCL | GPIO6 | SPI2 clock, 40 MHz |
//! | SDA | GPIO7 | SPI2 data |
//! | CS | GPIO10 | |
//! | DC | GPIO4 | |
//! | RES | GPIO5 | |
//! | VCC, BLK / GND | 3V3 / GND | |
//!
//! Messages: UART0 (GPIO21), 115,200 baud, which the board's USB socket shows.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware: cargo build --release --target riscv32imc-unknown-none-elf");
    std::process::exit(2);
}
