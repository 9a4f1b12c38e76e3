//! What the benchmarks draw: the same scenes for instruction counts, for times and for the peers.

pub mod lines;
#[cfg(feature = "peers")]
pub mod peers;
pub mod scenes;
