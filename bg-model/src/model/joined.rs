//! Tables of several models, joined to one in other numbers.
//!
//! In: models of the same kind, their tables. Out: tables each of whose numbers is made of those of all models.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::scalar::Scalar;

/// The numbers of all tables, one table after the other: `of` makes each of those of all models in the same place, and
/// `table` is the table of a model by the numbers of both. Compiled once for each kind of numbers, and not for each
/// model.
pub fn joined<'a, S: Scalar, T: Scalar>(
    models: usize,
    tables: usize,
    table: &dyn Fn(usize, usize) -> &'a [S],
    of: fn(&[S]) -> T,
) -> Vec<T> {
    let mut numbers = vec![S::from_f64(0.0); models];
    let mut joined = Vec::new();
    for place in 0..tables {
        let each: Vec<&[S]> = (0..models).map(|model| table(model, place)).collect();
        for index in 0..each[0].len() {
            numbers.iter_mut().zip(&each).for_each(|(number, table)| *number = table[index]);
            joined.push(of(&numbers));
        }
    }
    joined
}

/// The first numbers of `rest`, as many as a table has, which are no longer in `rest` then.
///
/// # Panics
/// There are fewer.
pub fn taken<T: Copy, const C: usize>(rest: &mut &[T]) -> [T; C] {
    let (first, others) = rest.split_first_chunk().expect("the numbers of all tables are there");
    *rest = others;
    *first
}
