//! A file's bytes as text, in the encoding that they say.
//!
//! In: bytes. Out: text, by the byte order mark, else by `encoding=".."` of the XML declaration, else as UTF-8. Source:
//! XML 1.0, appendix F; names of encodings are those of the WHATWG Encoding Standard.

use encoding_rs::{Encoding, UTF_8};

use crate::ImportError;

/// The text of a file.
///
/// # Errors
/// Its encoding is not known, or has no such bytes.
pub fn text(bytes: &[u8]) -> Result<String, ImportError> {
    let label = declared(bytes);
    let encoding = match (Encoding::for_bom(bytes), label) {
        (Some((encoding, _)), _) => encoding,
        (None, Some(label)) => Encoding::for_label(label)
            .ok_or_else(|| ImportError::Encoding { encoding: String::from_utf8_lossy(label).into_owned() })?,
        (None, None) => UTF_8,
    };
    let (text, encoding, has_faults) = encoding.decode(bytes);
    if has_faults { Err(ImportError::Encoding { encoding: encoding.name().to_owned() }) } else { Ok(text.into_owned()) }
}

/// What the XML declaration names.
fn declared(bytes: &[u8]) -> Option<&[u8]> {
    let bytes = bytes.strip_prefix(b"<?xml")?;
    let declaration = &bytes[..bytes.windows(2).position(|pair| pair == b"?>")?];
    let (word, quotes) = (b"encoding", |byte: &u8| *byte == b'"' || *byte == b'\'');
    let after = &declaration[declaration.windows(word.len()).position(|part| part == word)? + word.len()..];
    let inside = &after[after.iter().position(quotes)? + 1..];
    Some(&inside[..inside.iter().position(quotes)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_read_in_the_encoding_that_they_say() {
        let latin = b"<?xml version=\"1.0\" encoding='ISO-8859-1'?><robot name=\"\xe9paule\"/>";
        assert!(text(latin).expect("latin-1").contains("épaule"));
        assert!(text(b"\xff\xfe<\0a\0/\0>\0").expect("UTF-16").contains("<a/>"));
        assert_eq!(text("<a>é</a>".as_bytes()).expect("UTF-8"), "<a>é</a>");
        for (bytes, message) in [
            (&b"<a>\xe9</a>"[..], "the file is not in UTF-8: save it in UTF-8, or name its encoding in the first line"),
            (
                b"<?xml encoding='none'?>",
                "the file is not in none: save it in UTF-8, or name its encoding in the first line",
            ),
        ] {
            assert_eq!(text(bytes).expect_err("not text").to_string(), message);
        }
    }
}
