//! Instruction counts and times of what the crate `scanout-bench` defines, and of the peers that draw the same.

pub use scanout_bench::{lines, memory, scenes, sphere};

#[cfg(feature = "peers")]
pub mod peers;
