//! The player on QEMU's machine `sifive_u`, in machine mode, without anything beneath it.
//!
//! | part | address | does |
//! |---|---|---|
//! | harts 1 and 2 (U54, RV64GC) | | render and send; hart 0 (E51) and others sleep |
//! | QSPI2 | 0x1005_0000 | SD card in SPI mode |
//! | GPIO pin 0 | 0x1006_0000 | the display's D/C |
//! | semihosting | | the display's data, in `player::wire`'s records, since QEMU has no display |
//! | UART0 | 0x1001_0000 | messages |
//! | CLINT | 0x0200_0000 | time, 1 MHz |
//!
//! Addresses and registers: SiFive FU540-C000 Manual v1p4, chapters 9, 13, 17, 19.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod display;
#[cfg(target_os = "none")]
mod sd;
#[cfg(target_os = "none")]
mod semihosting;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware: firmware/run builds it and runs it in QEMU");
    std::process::exit(2);
}
