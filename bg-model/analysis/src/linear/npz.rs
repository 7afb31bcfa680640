//! A linear model as arrays of numpy.
//!
//! In: a linear model. Out: the bytes of an `.npz` file: `numpy.load(..)` gives A, B, C, D, eigenvalues, names, the
//! state.
//! Method: an archive of `.npy` arrays that are stored, not compressed. The format of an array: `numpy.lib.format`,
//! version 1.0.

use std::io::{Cursor, Error, Write};

use bg_model::nalgebra::DMatrix;

use super::state_space::{Named, StateSpace};
use crate::thinning::canonical;

impl StateSpace {
    /// The bytes of an `.npz` file with the arrays `A`, `B`, `C`, `D`, `eigenvalues` (complex, both of a pair),
    /// `states`, `inputs`, `outputs` and their units `state_units`, `input_units`, `output_units`; of the operating
    /// point `t`, `point` (all states), `point_names`, `point_rates`.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn npz(&self) -> Result<Vec<u8>, Error> {
        let mut eigenvalues = Vec::new();
        for mode in &self.modes {
            eigenvalues.push([mode.real, mode.imaginary]);
            if mode.imaginary > 0.0 {
                eigenvalues.push([mode.real, -mode.imaginary]);
            }
        }
        let column = |value: fn(&super::state_space::PointState) -> f64| {
            let values: Vec<f64> = self.point.iter().map(value).collect();
            Array::numbers(&[values.len()], &values)
        };
        let mut arrays = vec![
            ("A", Array::matrix(&self.a)),
            ("B", Array::matrix(&self.b)),
            ("C", Array::matrix(&self.c)),
            ("D", Array::matrix(&self.d)),
            (
                "eigenvalues",
                Array { kind: "<c16".to_owned(), ..Array::numbers(&[eigenvalues.len()], eigenvalues.as_flattened()) },
            ),
            ("t", Array::numbers(&[], &[self.t])),
            ("point", column(|state| state.value)),
            ("point_rates", column(|state| state.rate)),
            ("point_names", Array::texts(self.point.iter().map(|state| state.name.as_str()))),
        ];
        let named = [
            ("states", "state_units", &self.states),
            ("inputs", "input_units", &self.inputs),
            ("outputs", "output_units", &self.outputs),
        ];
        for (names, units, of) in named {
            arrays.push((names, Array::texts(of.iter().map(|Named { name, .. }| name.as_str()))));
            arrays.push((units, Array::texts(of.iter().map(|Named { unit, .. }| unit.as_str()))));
        }
        archive(&arrays)
    }
}

/// An array as numpy stores it.
struct Array {
    /// The type of its elements, such as `<f8`.
    kind: String,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl Array {
    fn numbers(shape: &[usize], values: &[f64]) -> Self {
        let bytes = values.iter().flat_map(|value| canonical(*value).to_le_bytes()).collect();
        Self { kind: "<f8".to_owned(), shape: shape.to_vec(), bytes }
    }

    fn matrix(matrix: &DMatrix<f64>) -> Self {
        let by_rows = matrix.transpose();
        Self::numbers(&[matrix.nrows(), matrix.ncols()], by_rows.as_slice())
    }

    /// Texts in UTF-32, all as long as the longest.
    fn texts<'a>(texts: impl Iterator<Item = &'a str>) -> Self {
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

/// The bytes of an archive of these arrays.
fn archive(arrays: &[(&str, Array)]) -> Result<Vec<u8>, Error> {
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
