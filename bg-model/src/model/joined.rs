//! Tables of several models, joined to one in other numbers.
//!
//! In: models of the same kind, one of their tables. Out: the table each of whose numbers is made of those of all
//! models.

use alloc::vec;

use crate::model::scalar::Scalar;

/// The table whose numbers `of` makes of those of `models` in the same place.
pub fn joined<Mo, S: Scalar, T: Scalar, const C: usize>(
    models: &[&Mo],
    table: impl Fn(&Mo) -> &[S; C],
    of: fn(&[S]) -> T,
) -> [T; C] {
    let mut joined = [T::from_f64(0.0); C];
    join(models.len(), &|model, place| table(models[model])[place], of, &mut joined);
    joined
}

/// Of any kind of models, and whatever the length of the tables: `number` is that of a model in a place.
fn join<S: Scalar, T: Scalar>(models: usize, number: &dyn Fn(usize, usize) -> S, of: fn(&[S]) -> T, joined: &mut [T]) {
    let mut numbers = vec![S::from_f64(0.0); models];
    for (place, joined) in joined.iter_mut().enumerate() {
        numbers.iter_mut().enumerate().for_each(|(model, to)| *to = number(model, place));
        *joined = of(&numbers);
    }
}
