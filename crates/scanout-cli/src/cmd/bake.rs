//! `scanout bake`: the compact binary that firmware links, and the tables that hardware reads.

use std::fs;
use std::path::Path;

use scanout_assets::{TextureFormat, bake};

use crate::args::{BakeArgs, PaletteSize};
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
    let format = match args.palette {
        None => TextureFormat::Rgb565,
        Some(PaletteSize::Sixteen) => TextureFormat::Palette16,
        Some(PaletteSize::TwoHundredAndFiftySix) => TextureFormat::Palette256,
    };
    bake::write_binary_as(&model, format, &binary).map_err(|error| Error::io(&binary, &error))?;
    if let Some(colours) = format.colours() {
        if model.images.is_empty() {
            narrate!("scanout: --palette has nothing to do: the model has no texture");
        }
        for image in &model.images {
            let paletted = image.to_palette(colours);
            narrate!(
                "scanout: {}: {} colours, off by {:.1} of 255 a channel (root mean square)",
                image.name,
                paletted.used,
                paletted.error()
            );
        }
    }
    let hex = bake::write_hex(&model, &args.output);
    let hex = hex.map_err(|error| Error::io(&args.output, &error))?;
    for path in [binary].iter().chain(&hex) {
        let bytes = fs::metadata(path).map_or(0, |data| data.len());
        narrate!("scanout: wrote {} ({bytes} bytes)", path.display());
    }
    Ok(())
}
