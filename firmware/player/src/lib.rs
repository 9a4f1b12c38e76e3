//! What every board's firmware shares: a model and its texture from an SD card, system B's scene, its frames in bands on a
//! display, and what to say when something of that fails. The board crates beside this one bring pins and clocks.
//!
//! ```text
//!  SD card --card--> volume, files --chunks--> model: positions, triangles, texels      fault: card, file, model, display
//!                    (MBR or bare,  (512 B)       |                                       |
//!                     FAT16/FAT32)              scene --Frame--> play: one or two harts   message: on the display
//!                                                                  |                      and on the serial port
//!                                                               display
//! ```
//!
//! | module | what |
//! |---|---|
//! | [`scene`] | system B's camera, light and turntable |
//! | [`model`] | OBJ and PPM into the caller's memory, chunk by chunk, integers only |
//! | [`card`] | block devices that fail, retries, what was read; MBR and bare volumes; files by long names |
//! | [`spi_card`] | an SD card in SPI mode: slow start, then fast |
//! | [`show`](mod@show) | `show.txt`, which says what to show |
//! | [`fault`] | everything that can go wrong, in words |
//! | [`message`] | words on a display without a frame buffer |
//! | [`pair`] | two harts: one renders and one sends, or both do both |
//! | [`play`](mod@play) | the loop: start, load, frames; faults are shown and tried again |
//! | [`wire`] | a display's bytes and D/C line over a serial line, for emulators, which have no display |
//!
//! No allocator, no floating point. What it will not do: write to the card.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
// Two harts share memory in `pair`, beside its reasons.
#![deny(unsafe_code)]

pub mod card;
pub mod fault;
pub mod message;
pub mod model;
#[cfg(target_has_atomic = "ptr")]
pub mod pair;
#[cfg(target_has_atomic = "ptr")]
pub mod play;
pub mod scene;
pub mod show;
pub mod spi_card;
pub mod wire;
