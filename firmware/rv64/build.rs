//! Where `sections.ld` lies, for the boards' linker scripts, which include it.

fn main() {
    println!("cargo::rerun-if-changed=sections.ld");
    println!(
        "cargo::rustc-link-search={}",
        std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default()
    );
}
