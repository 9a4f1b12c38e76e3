//! `scanout bake`: the compact binary that firmware links, and the tables that hardware reads.

use std::fs;
use std::path::Path;

use scanout_assets::bake;

use crate::args::BakeArgs;
use crate::error::{Error, Result};
use crate::image_out::{create_folder, is_dash};
use crate::narrate;
use crate::scene_builder::load_model;

/// Writes `NAME.mesh` and the `.hex` tables with their README into the folder.
pub fn run(args: &BakeArgs) -> Result<()> {
    if is_dash(&args.output) {
        return Err(Error::usage(
            "bake writes several files, which can't go to standard output",
            "name a folder with -o",
        ));
    }
    let model = load_model(&args.model, args.input_format)?;
    create_folder(&args.output, "name a folder, or move the file away")?;
    let stem = args.model.file_stem().filter(|_| !is_dash(&args.model));
    let stem = Path::new(stem.unwrap_or("model".as_ref()));
    let binary = args.output.join(stem.with_extension("mesh"));
    bake::write_binary(&model, &binary).map_err(|error| Error::io(&binary, &error))?;
    let hex = bake::write_hex(&model, &args.output);
    let hex = hex.map_err(|error| Error::io(&args.output, &error))?;
    for path in [binary].iter().chain(&hex) {
        let bytes = fs::metadata(path).map_or(0, |data| data.len());
        narrate!("scanout: wrote {} ({bytes} bytes)", path.display());
    }
    Ok(())
}
