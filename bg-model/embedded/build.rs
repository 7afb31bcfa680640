//! Tells the linker of the controller's memory; on a desktop there is nothing to tell.

use std::path::Path;
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        let out = env::var("OUT_DIR").expect("cargo gives a build script a folder");
        fs::copy("memory.x", Path::new(&out).join("memory.x")).expect("memory.x can be copied");
        println!("cargo:rustc-link-search={out}");
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
    }
}
