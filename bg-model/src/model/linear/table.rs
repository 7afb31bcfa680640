//! Factorisation and solution by tables of steps, for patterns that are too large to be unrolled.
//!
//! In: the steps that the compiler planned. Out: the same values, in the same order of operations, as unrolled code
//! has. Method: compressed rows (Davis, Direct Methods for Sparse Linear Systems, 2006, section 2.1) of products of
//! factors.

use super::{Field, Pivot};
use crate::model::scalar::Scalar;

/// How one factor is calculated: minus c times an entry of J, plus 1 for a pivot, minus products of earlier factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// The entry of J, where it has one.
    pub entry: Option<u32>,
    /// The end of its products in the table of products; they begin where those of the slot before end.
    pub end: u32,
    /// Whether it is a pivot, which becomes its reciprocal.
    pub is_pivot: bool,
    /// Whether its row is an unknown's equation: it has the entry as it is, without c and without 1.
    pub of_unknown: bool,
    /// The pivot that it is divided by, where it is.
    pub scale: Option<u32>,
}

/// Writes the factors of I - `c` J. Gives whether no pivot is too small.
pub fn eliminate<S: Scalar, F: Field<S>>(
    slots: &[Slot],
    products: &[(u32, u32)],
    c: F,
    entries: &[S],
    factors: &mut [F],
) -> bool {
    let minus = -c;
    let mut is_regular = true;
    let mut begin = 0;
    for (index, slot) in slots.iter().enumerate() {
        let products = products[begin..slot.end as usize].iter();
        let mut products = products.map(|&(left, right)| factors[left as usize] * factors[right as usize]);
        begin = slot.end as usize;
        let entry = slot.entry.map(|entry| {
            let entry = entries[entry as usize];
            if slot.of_unknown { F::real(entry) } else { minus.scaled(entry) }
        });
        let mut first = || entry.or_else(|| products.next().map(|product| -product));
        factors[index] = if slot.is_pivot {
            let first = first();
            let pivot = if slot.of_unknown {
                Pivot::of_unknown(first.unwrap_or(F::real(S::from_f64(0.0))))
            } else {
                let one = F::real(S::from_f64(1.0));
                Pivot::new(first.map_or(one, |first| one + first))
            };
            products.fold(pivot, Pivot::minus).reciprocal(&mut is_regular)
        } else {
            let first = first();
            let value = products.fold(first.unwrap_or(F::real(S::from_f64(0.0))), |value, product| value - product);
            slot.scale.map_or(value, |by| value * factors[by as usize])
        };
    }
    is_regular
}

/// Replaces `b` by the solution. A step (row, factor, column) subtracts factor times `b[column]` from `b[row]`, or,
/// where row and column are equal, multiplies `b[row]` by the factor.
pub fn substitute<S: Scalar, F: Field<S>>(steps: &[(u32, u32, u32)], factors: &[F], b: &mut [F]) {
    for steps in steps.chunk_by(|(one, ..), (next, ..)| one == next) {
        let (row, ..) = steps[0];
        let mut value = b[row as usize];
        for &(_, slot, column) in steps {
            let factor = factors[slot as usize];
            value = if column == row { value * factor } else { value - factor * b[column as usize] };
        }
        b[row as usize] = value;
    }
}
