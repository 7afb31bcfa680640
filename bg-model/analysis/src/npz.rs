//! Arrays for numpy.
//!
//! In: numbers and texts. Out: the bytes of an `.npz` file, which `numpy.load(..)` reads.
//! Method: an archive of `.npy` arrays that are stored, not compressed. The format of an array: `numpy.lib.format`,
//! version 1.0.

use std::io::{Cursor, Error, Write};

use bg_model::nalgebra::DMatrix;

use crate::thinning::canonical;

/// An array as numpy stores it.
#[derive(Clone, Debug)]
pub struct Array {
    /// The type of its elements, such as `<f8`.
    kind: String,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl Array {
    /// Numbers, row by row; what is no number has one form.
    #[must_use]
    pub fn numbers(shape: &[usize], values: &[f64]) -> Self {
        let bytes = values.iter().flat_map(|value| canonical(*value).to_le_bytes()).collect();
        Self { kind: "<f8".to_owned(), shape: shape.to_vec(), bytes }
    }

    /// Complex numbers, each by its real and its imaginary part.
    #[must_use]
    pub fn complex(values: &[[f64; 2]]) -> Self {
        Self { kind: "<c16".to_owned(), ..Self::numbers(&[values.len()], values.as_flattened()) }
    }

    /// The entries of a matrix.
    #[must_use]
    pub fn matrix(matrix: &DMatrix<f64>) -> Self {
        let by_rows = matrix.transpose();
        Self::numbers(&[matrix.nrows(), matrix.ncols()], by_rows.as_slice())
    }

    /// Texts in UTF-32, all as long as the longest.
    pub fn texts<'a>(texts: impl Iterator<Item = &'a str>) -> Self {
        let texts: Vec<Vec<char>> = texts.map(|text| text.chars().collect()).collect();
        let width = texts.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let padded =
            texts.iter().flat_map(|text| (0..width).map(|k| text.get(k).map_or(0, |&character| u32::from(character))));
        let bytes = padded.flat_map(u32::to_le_bytes).collect();
        Self { kind: format!("<U{width}"), shape: vec![texts.len()], bytes }
    }

    /// The bytes of an `.npy` file.
    fn npy(&self) -> Vec<u8> {
        let shape: String = self.shape.iter().map(|length| format!("{length}, ")).collect();
        let header = format!("{{'descr': '{}', 'fortran_order': False, 'shape': ({shape}), }}", self.kind);
        // Magic, version and length of the header take 10 bytes; all together is a multiple of 64 and ends with a new
        // line.
        let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((length as u16).to_le_bytes());
        bytes.extend(format!("{header:<width$}\n", width = length - 1).bytes());
        bytes.extend(&self.bytes);
        bytes
    }
}

/// The bytes of an archive of these arrays, by their names.
///
/// # Errors
/// None in practice: writing to memory does not fail.
pub fn archive(arrays: &[(&str, Array)]) -> Result<Vec<u8>, Error> {
    let mut bytes = Cursor::new(Vec::new());
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, array) in arrays {
        let (mut entry, config) = archive.new_file(format!("{name}.npy")).start().map_err(Error::other)?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(&array.npy())?;
        let (_, described) = writer.finish().map_err(Error::other)?;
        entry.finish(described).map_err(Error::other)?;
    }
    archive.finish().map_err(Error::other)?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_has_one_form() {
        let [positive, negative] = [f64::NAN, -f64::NAN].map(|none| Array::numbers(&[2], &[1.5, none]).npy());
        assert_eq!(positive, negative);
        assert_eq!(positive[positive.len() - 16..][..8], 1.5_f64.to_le_bytes());
    }
}
