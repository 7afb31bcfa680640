//! The stack of the module: laws may be long, and the compiler calls itself for what is in them.

/// Bytes. A browser has its own, which is smaller: see decision 66.
const STACK: usize = 1 << 24;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|name| name == "wasm32") {
        println!("cargo::rustc-link-arg-bins=-zstack-size={STACK}");
    }
}
