//! The stack of the module: laws may be long, and the compiler calls itself for what is in them. The browser's own
//! stack, which holds the calls, is enough for a sum of 20000 terms; brackets and functions are at most 100 deep.
//! Its table of functions: machine code of models, which is made while it runs, has its places there.

/// Bytes.
const STACK: usize = 1 << 24;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|name| name == "wasm32") {
        for argument in [&format!("-zstack-size={STACK}"), "--export-table", "--growable-table"] {
            println!("cargo::rustc-link-arg-bins={argument}");
        }
    }
}
