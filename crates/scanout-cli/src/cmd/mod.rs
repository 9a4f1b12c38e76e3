//! One module a command.

pub mod ar;
pub mod bake;
pub mod bench;
pub mod calibrate;
pub mod completions;
pub mod demo;
pub mod info;
pub mod lines;
pub mod man;
pub mod marker;
pub mod render;
pub mod turntable;
pub mod view;
pub mod window;
