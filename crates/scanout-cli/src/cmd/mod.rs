//! One module a command.

pub mod bake;
pub mod bench;
pub mod completions;
pub mod demo;
pub mod info;
pub mod lines;
pub mod man;
pub mod render;
pub mod turntable;
pub mod view;
pub mod window;
