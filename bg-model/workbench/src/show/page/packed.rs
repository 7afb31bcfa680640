//! Texts of the page in a third of their size, and the program in it.
//!
//! In: bytes. Out: base64 (RFC 4648) of the bytes deflated (RFC 1951), which `page/loader.js` unpacks in the browser.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec;

/// How hard it is tried, 0 to 10: more gains little and takes long.
const LEVEL: u8 = 6;

/// The bytes, packed: letters, digits, `+`, `/` and `=`.
pub fn packed(bytes: &[u8]) -> String {
    STANDARD.encode(compress_to_vec(bytes, LEVEL))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_there_again() {
        let text = "</script> \u{2212}".repeat(100);
        let packed = packed(text.as_bytes());
        assert!(
            packed.len() < text.len() / 5 && packed.chars().all(|c| c.is_ascii_alphanumeric() || "+/=".contains(c))
        );
        let bytes = miniz_oxide::inflate::decompress_to_vec(&STANDARD.decode(packed).unwrap()).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), text);
    }
}
