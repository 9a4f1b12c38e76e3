//! Bakes system B's models C and A with their textures, and names esp-hal's linker script.

use std::path::{Path, PathBuf};
use std::{env, fs};

use scanout_assets::{Limits, LoadOptions, bake, load, load_image};

fn main() {
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    println!("cargo::rustc-link-arg-bins=-Tlinkall.x");
    let here = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let out = PathBuf::from(env::var("OUT_DIR").unwrap_or_default());
    let models = Path::new(&here).join("../../models/system-b");
    for name in ["a", "c"] {
        let file = |ending| models.join(name).with_extension(ending);
        println!("cargo::rerun-if-changed={}", file("obj").display());
        println!("cargo::rerun-if-changed={}", file("ppm").display());
        let mut model =
            load(file("obj"), &LoadOptions::default()).expect("the repository's own model");
        let image = load_image(file("ppm"), &Limits::default());
        model.images = vec![image.expect("the repository's own picture").0];
        model.parts[0].material.texture = Some(0);
        let baked = bake::to_binary(&model).expect("it is small");
        fs::write(out.join(name).with_extension("mesh"), baked).expect("cargo's own folder");
    }
}
