//! Sipeed Maix Dock (M1 or M1W module, Kendryte K210: two harts, RV64GC, 390 MHz) with its 2.4" display (ST7789, 320 x 240) and its
//! microSD slot: the player, in machine mode. System B's board. **Not run on hardware.**
//!
//! | part | pins | K210 |
//! |---|---|---|
//! | display, 8 bits side by side | D0 - D7 of SPI0, the module's own | SPI0, octal, 15 MHz |
//! | CS, WR | IO36, IO39 | SPI0 SS3, SPI0 SCLK |
//! | RST, D/C | IO37, IO38 | GPIOHS 1, 0 |
//! | microSD CLK, MOSI, MISO | IO27, IO28, IO26 | SPI1 SCLK, D0, D1, 19.5 MHz |
//! | microSD CS | IO29 | GPIOHS 2 |
//! | messages | IO5, the USB port's second channel | UARTHS, 115,200 baud |
//!
//! Pins are those of the dock's connectors: plug in display and card, there is nothing to wire. Registers: Kendryte's K210 datasheet V0.1.5
//! (memory map, FPIOA) and its stand-alone SDK's headers (SYSCTL, DesignWare SSI).
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod chip;
#[cfg(target_os = "none")]
mod spi;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!(
        "this is firmware: cargo build -p k210 --release --target riscv64gc-unknown-none-elf"
    );
    std::process::exit(2);
}
