//! Tables of several models, joined to one in other numbers.
//!
//! In: models of the same kind, one of their tables. Out: the table each of whose numbers is made of those of all
//! models.

use alloc::vec::Vec;

use crate::model::scalar::Scalar;

/// The table whose numbers `of` makes of those of `models` in the same place.
pub fn joined<Mo, S: Scalar, T: Scalar, const C: usize>(
    models: &[&Mo],
    table: impl Fn(&Mo) -> &[S; C],
    of: fn(&[S]) -> T,
) -> [T; C] {
    let mut joined = [T::from_f64(0.0); C];
    let tables: Vec<&[S]> = models.iter().map(|model| &table(model)[..]).collect();
    join(&tables, of, &mut joined);
    joined
}

/// Whatever the length of the tables.
fn join<S: Scalar, T: Scalar>(tables: &[&[S]], of: fn(&[S]) -> T, joined: &mut [T]) {
    let mut numbers = Vec::with_capacity(tables.len());
    for (place, joined) in joined.iter_mut().enumerate() {
        numbers.clear();
        numbers.extend(tables.iter().map(|table| table[place]));
        *joined = of(&numbers);
    }
}
