//! What a program that has to succeed printed.

use std::process::Output;

/// Its text; panics with what it said of `arguments` where it failed.
pub fn text_of(output: Output, arguments: &[&str]) -> String {
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}
