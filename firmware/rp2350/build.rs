//! Bakes system B's models C and A with their textures, and says where the linker scripts lie.

use std::path::{Path, PathBuf};
use std::{env, fs};

use scanout_assets::{Limits, LoadOptions, bake, load, load_image};

fn main() {
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let here = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let arm = env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("arm");
    println!("cargo::rustc-link-search={here}/{}", if arm { "arm" } else { "riscv" });
    println!("cargo::rerun-if-changed=arm/memory.x");
    println!("cargo::rerun-if-changed=riscv/memory.x");
    if !arm {
        // riscv-rt includes neither by itself; the chip crate makes the second.
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
        println!("cargo::rustc-link-arg-bins=-Tdevice.x");
    }
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");

    let out = PathBuf::from(env::var("OUT_DIR").unwrap_or_default());
    let models = Path::new(&here).join("../../models/system-b");
    for name in ["a", "c"] {
        let (obj, ppm) =
            (models.join(name).with_extension("obj"), models.join(name).with_extension("ppm"));
        println!("cargo::rerun-if-changed={}", obj.display());
        println!("cargo::rerun-if-changed={}", ppm.display());
        let mut model = load(&obj, &LoadOptions::default()).expect("the repository's own model");
        let (image, _) =
            load_image(&ppm, &Limits::default()).expect("the repository's own picture");
        model.images = vec![image];
        model.parts[0].material.texture = Some(0);
        let baked = bake::to_binary(&model).expect("it is small");
        fs::write(out.join(name).with_extension("mesh"), baked).expect("cargo's own folder");
    }
}
