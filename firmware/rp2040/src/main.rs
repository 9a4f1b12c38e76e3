//! Raspberry Pi Pico (RP2040, Cortex-M0+) with an ST7789 of 320 x 240: models C and A of system B, baked into flash, turn in
//! bands of four lines, within 32 KB of memory. What it says goes to UART0. With feature `dma` there are two bands of three
//! lines: one is sent while the other is drawn.
//!
//! | display | Pico | |
//! |---|---|---|
//! | SCL | GP18, pin 24 | SPI0 clock, 62.5 MHz |
//! | SDA | GP19, pin 25 | SPI0 data |
//! | CS | GP17, pin 22 | |
//! | DC | GP16, pin 21 | |
//! | RES | GP20, pin 26 | |
//! | VCC, BLK / GND | 3V3, pin 36 / pin 38 | |
//!
//! UART0: GP0 (pin 1), 115,200 baud. With `dma` GP21 (pin 27) is high while a band is sent and nothing waits for it.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod chip;
#[cfg(all(target_os = "none", feature = "dma"))]
mod dma;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware: cargo build -p rp2040 --release --target thumbv6m-none-eabi");
    std::process::exit(2);
}
