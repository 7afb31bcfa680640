//! The stack of the module: laws may be long, and the compiler calls itself for what is in them. The browser's own
//! stack, which holds the calls, is enough for a sum of 20000 terms; brackets and functions are at most 100 deep.

/// Bytes.
const STACK: usize = 1 << 24;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|name| name == "wasm32") {
        println!("cargo::rustc-link-arg-bins=-zstack-size={STACK}");
    }
}
