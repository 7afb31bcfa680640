//! Where a number that is not finite comes from.
//!
//! In: the values of inputs and laws. Out: the first that is not finite, and what to do about it.

use crate::model::scalar::Scalar;

/// An input or an element whose value is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// `input`, `table`, or the element's kind.
    pub kind: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
}

impl Origin {
    /// The first of these kinds and names whose value is not finite.
    pub fn first<S: Scalar>(values: &[(&'static str, &'static str, S)]) -> Option<Self> {
        let values = values.iter().map(|&(kind, name, value)| Self { kind, name, value: value.to_f64() });
        values.into_iter().find(|origin| !origin.value.is_finite())
    }

    /// What to do about it.
    pub(crate) fn action(&self) -> &'static str {
        match self.kind {
            "input" => "give it finite numbers there",
            "algebraic loop" => {
                "Newton's iteration finds no solution of these laws there: they may have none, or not be smooth at it"
            }
            "table" => "its argument is beyond its points: add points, or write `held` or `continued` after them",
            "closed loop" => {
                "the mechanism comes to a pose there in which a dependent body may turn either way: leave it out of \
                `dependent`"
            }
            _ => "keep what its law divides by, or takes a root, power or logarithm of, in range",
        }
    }
}
