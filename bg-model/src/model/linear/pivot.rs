//! A place of the diagonal during an elimination without row exchanges.
//!
//! In: its first value and the products that are subtracted from it. Out: its reciprocal, and whether it is large
//! enough. Method: a pivot has lost digits where its value is far below what it was before; the values that it had are
//! unchanged by a scaling of the states (d_i a_ij / d_j), as are the products that are subtracted. Duff, Erisman, Reid,
//! Direct Methods for Sparse Matrices, 2nd edition 2017, section 4.3, on growth as the measure of stability.

use super::{Field, SMALLEST_PIVOT};
use crate::model::scalar::Scalar;

/// A pivot that is not finished.
#[derive(Clone, Copy, Debug)]
pub struct Pivot<F> {
    value: F,
    /// The largest size so far; of a state at least 1: the 1 of I - c J.
    largest: f64,
}

impl<F> Pivot<F> {
    /// The pivot of this first value in the row of an unknown.
    #[inline(always)]
    pub fn of_unknown<S: Scalar>(value: F) -> Self
    where
        F: Field<S>,
    {
        Self { value, largest: value.size() }
    }

    /// The pivot of this first value in the row of a state.
    #[inline(always)]
    pub fn new<S: Scalar>(value: F) -> Self
    where
        F: Field<S>,
    {
        Self { value, largest: larger(value.size(), 1.0) }
    }

    /// The pivot after `product` is subtracted.
    #[inline(always)]
    #[must_use]
    pub fn minus<S: Scalar>(self, product: F) -> Self
    where
        F: Field<S>,
    {
        let value = self.value - product;
        Self { value, largest: larger(value.size(), self.largest) }
    }

    /// The reciprocal. `is_regular` stays true if the pivot is finite and not below [`SMALLEST_PIVOT`].
    #[inline(always)]
    pub fn reciprocal<S: Scalar>(self, is_regular: &mut bool) -> F
    where
        F: Field<S>,
    {
        let (size, reciprocal) = (self.value.size(), F::real(S::from_f64(1.0)) / self.value);
        // The square of a large complex pivot overflows and leaves zero.
        *is_regular &= (size >= SMALLEST_PIVOT * self.largest) & (size < f64::INFINITY) & (reciprocal.size() > 0.0);
        reciprocal
    }
}

/// The larger number; `b` where `a` is none.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;

    use super::*;

    fn reciprocal(first: f64, products: &[f64]) -> (f64, bool) {
        let mut is_regular = true;
        let pivot = products.iter().fold(Pivot::new::<f64>(first), |pivot, product| pivot.minus::<f64>(*product));
        (pivot.reciprocal::<f64>(&mut is_regular), is_regular)
    }

    #[test]
    fn a_pivot_is_measured_by_what_it_was() {
        assert_eq!(reciprocal(4.0, &[2.0]), (0.5, true));
        assert!(reciprocal(1e-7, &[]).1 && !reciprocal(1e-9, &[]).1);
        // Large throughout: nothing is lost.
        assert!(reciprocal(1e12, &[-1e12, 1e3]).1);
        // Large in between: half of the digits are lost.
        assert!(!reciprocal(1.0, &[-1e9, 1e9]).1);
        assert!(!reciprocal(1.0, &[1.0]).1);
        assert!(!reciprocal(f64::NAN, &[]).1 && !reciprocal(1.0, &[f64::NEG_INFINITY]).1);
    }

    #[test]
    fn a_complex_pivot_may_lose_its_real_part() {
        let mut is_regular = true;
        let pivot = Pivot::new::<f64>(Complex::new(1.0, 2.0)).minus::<f64>(Complex::new(1.0, 0.0));
        assert_eq!(pivot.reciprocal::<f64>(&mut is_regular), Complex::new(0.0, -0.5));
        assert!(is_regular);
    }

    #[test]
    fn a_complex_pivot_whose_square_overflows_is_no_pivot() {
        for (size, expected) in [(1e150, true), (1e160, false)] {
            let mut is_regular = true;
            Pivot::new::<f64>(Complex::new(size, size)).reciprocal::<f64>(&mut is_regular);
            assert_eq!(is_regular, expected, "{size}");
        }
        assert!(reciprocal(1e300, &[]).1);
    }

    #[test]
    fn one_small_pivot_is_enough() {
        let mut is_regular = true;
        Pivot::new::<f64>(0.0).reciprocal::<f64>(&mut is_regular);
        Pivot::new::<f64>(1.0).reciprocal::<f64>(&mut is_regular);
        assert!(!is_regular);
    }
}
