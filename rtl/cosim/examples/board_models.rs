//! Writes the tables of the models that the boards show: `cargo run --example board_models`.

use std::path::Path;
use std::{fs, io};

use scanout_cosim::spin;

fn main() -> io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for name in spin::BOARD_MODELS {
        let folder = root.join("boards/models").join(name);
        fs::create_dir_all(&folder)?;
        for (file, text) in spin::board_tables(&root, name) {
            fs::write(folder.join(file), text)?;
        }
    }
    Ok(())
}
