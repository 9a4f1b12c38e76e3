//! Scan-out to a display: bands of pixels go to an ST7789 or a relative of it, and a model of the display decodes
//! what went over the wires back into a picture.
//!
//! ```text
//!                  band ---- mipidsi's Display, or its Interface: SPI, 8 and 16 parallel wires
//!  Frame --rows-->  |
//!                  flush --- bytes in place, no copy: blocking, or asynchronous beneath the drawing of the next band
//!                    |
//!                 DoubleBuffer                                  wires
//!                    |                                            |
//!                  target: text and meters on top               model (feature `std`): bytes -> picture -> hash
//! ```
//!
//! | module | what | memory besides the band |
//! |---|---|---|
//! | [`window`] | the frame's place in the controller's memory, in each orientation | - |
//! | [`band`] | a band through `mipidsi` as one window | mipidsi's own |
//! | [`flush`] | a band's own bytes to the bus, blocking or asynchronous; whole frames; two band buffers | - |
//! | [`init`] | the start-up sequence, for those who don't use mipidsi's | - |
//! | [`spi`] | four-wire SPI: a `SpiDevice` and the D/C pin | 64 bytes of stack, only beneath mipidsi |
//! | [`target`] | embedded-graphics on a band | - |
//! | `model` | the display model for tests | 300 KB, on a PC |
//!
//! A pixel on the wire is RGB565, high byte first. A band of n lines and w columns costs `2 n w + 11` bytes: column
//! and row window (5 each), memory write (1), pixels. So a frame of 320x240 in bands of 16 lines is 153,765 bytes.
//!
//! # Without feature `std`
//!
//! Neither allocator nor operating system; nothing here panics, and every error of the bus comes back as the
//! HAL's own type.
//!
//! # What it will not do
//!
//! Draw pixel by pixel through a trait, keep a frame buffer, read from the display, wait for its tearing signal.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

pub mod band;
pub mod flush;
pub mod init;
#[cfg(feature = "std")]
pub mod model;
pub mod spi;
pub mod target;
pub mod window;
