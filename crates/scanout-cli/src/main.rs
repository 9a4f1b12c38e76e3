//! The `scanout` program.
fn main() {}
