//! The scripts of pages, packed as a page has them: once, and not for each report.

#[path = "src/show/page/packed.rs"]
mod packed;

use std::path::Path;

fn main() {
    let out = std::env::var("OUT_DIR").expect("cargo says it");
    for name in ["report", "plain", "worker"] {
        let source = format!("page/dist/{name}.js");
        println!("cargo::rerun-if-changed={source}");
        let script = std::fs::read(&source).unwrap_or_else(|fault| panic!("{source}: {fault}"));
        let packed = packed::packed(&script);
        std::fs::write(Path::new(&out).join(format!("{name}.packed")), packed).expect("cargo's folder can be written");
    }
}
