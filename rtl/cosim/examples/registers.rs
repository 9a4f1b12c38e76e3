//! Writes what the description of the control registers becomes: `cargo run --example registers`.

use std::path::Path;
use std::{fs, io};

use scanout_cosim::registers::{constants, document, register_file};

fn main() -> io::Result<()> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::write(here.join("../control_registers.sv"), register_file())?;
    fs::write(here.join("../registers.md"), document())?;
    fs::write(here.join("src/register_map.rs"), constants())
}
