//! Bakes system B's models C and A with their textures, for the build scripts of the Pico and the Pico 2.

use std::path::{Path, PathBuf};
use std::{env, fs};

use scanout_assets::{Limits, LoadOptions, TextureFormat, bake, load, load_image};

/// Each model and its texture's format with feature `palette`, so that both kinds of palettes are drawn.
const MODELS: [(&str, TextureFormat); 2] =
    [("a", TextureFormat::Palette16), ("c", TextureFormat::Palette256)];

/// Writes `a.mesh` and `c.mesh` to cargo's folder; `here` is the board's own.
pub fn models(here: &Path) {
    let out = PathBuf::from(env::var("OUT_DIR").unwrap_or_default());
    let models = here.join("../../models/system-b");
    let palette = env::var_os("CARGO_FEATURE_PALETTE").is_some();
    for (name, format) in MODELS {
        let (obj, ppm) =
            (models.join(name).with_extension("obj"), models.join(name).with_extension("ppm"));
        println!("cargo::rerun-if-changed={}", obj.display());
        println!("cargo::rerun-if-changed={}", ppm.display());
        let mut model = load(&obj, &LoadOptions::default()).expect("the repository's own model");
        let (image, _) =
            load_image(&ppm, &Limits::default()).expect("the repository's own picture");
        model.images = vec![image];
        model.parts[0].material.texture = Some(0);
        let format = if palette { format } else { TextureFormat::Rgb565 };
        let baked = bake::to_binary_as(&model, format).expect("it is small");
        fs::write(out.join(name).with_extension("mesh"), baked).expect("cargo's own folder");
    }
}
