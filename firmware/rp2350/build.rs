//! Bakes system B's models C and A with their textures, and says where the linker scripts lie.

#[path = "../rp2040/bake.rs"]
mod bake;

use std::env;
use std::path::Path;

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
    bake::models(Path::new(&here));
}
