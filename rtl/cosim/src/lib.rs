//! Drives verilated modules from Rust tests, whose golden model is the library itself.
//!
//! ```text
//! Source -> s_valid, s_ready, data ports -> module -> m_valid, m_ready, data ports -> Sink
//! ```
//!
//! [`Model`] is a verilated configuration of `rtl/configurations.txt`; its ports are found by name. [`exchange`] feeds one
//! stream and collects another while both stall at random, checks the rules of the handshake on the way (a word that is
//! offered stays until it is taken) and counts clocks.
//!
//! Registers begin with random values, as in hardware: what a reset forgets shows.

mod model;
pub mod monitor;
mod random;
pub mod register_map;
pub mod registers;
pub mod spin;
mod stream;
pub mod tmds;

pub use model::{Model, Port};
pub use random::Random;
pub use stream::{Exchange, Stalls, Stream, exchange};
