//! Generated code and run time are of one version: the one that generated code may name is this crate's, and all
//! packages ask for it.

/// The crate's version, as every package of the library has it.
const VERSION: &str = env!("CARGO_PKG_VERSION");

#[test]
fn generated_code_of_this_version_is_welcome() {
    let code = include_str!("../src/private.rs");
    let accepted = format!("(\"{VERSION}\") => {{}};");
    assert!(code.contains(&accepted), "src/private.rs does not accept code of bg-macros {VERSION}");
    assert!(code.contains(&format!("and bg-model {VERSION} is to run it")), "its message has another version");
}
