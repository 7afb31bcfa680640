//! Two numbers that generated code calculates with at once.
//!
//! In: two numbers. Out: the same operations on both, each rounded as if it were alone. Pairs of `f64` are vectors of
//! the machine where it has them in every build; elsewhere, and for other scalars, one number is done after the other.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use wide::f64x2;

/// Two numbers of type `S`.
pub trait Pair<S>:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The pair of these.
    fn new(first: S, second: S) -> Self;
    /// The first number.
    fn first(self) -> S;
    /// The second number.
    fn second(self) -> S;
    /// The pair in which the numbers marked by `true` have the other sign.
    fn turned(self, first: bool, second: bool) -> Self;
}

/// Two numbers, one done after the other.
#[derive(Clone, Copy, Debug)]
pub struct Both<S>(S, S);

impl<S> Pair<S> for Both<S>
where
    S: Copy + Debug + Add<Output = S> + Sub<Output = S> + Mul<Output = S> + Div<Output = S> + Neg<Output = S>,
{
    #[inline(always)]
    fn new(first: S, second: S) -> Self {
        Self(first, second)
    }
    #[inline(always)]
    fn first(self) -> S {
        self.0
    }
    #[inline(always)]
    fn second(self) -> S {
        self.1
    }
    #[inline(always)]
    fn turned(self, first: bool, second: bool) -> Self {
        Self(if first { -self.0 } else { self.0 }, if second { -self.1 } else { self.1 })
    }
}

/// Two `f64` in a vector of the machine.
#[derive(Clone, Copy, Debug)]
pub struct PairOfDoubles(f64x2);

impl Pair<f64> for PairOfDoubles {
    #[inline(always)]
    fn new(first: f64, second: f64) -> Self {
        Self(f64x2::new([first, second]))
    }
    #[inline(always)]
    fn first(self) -> f64 {
        self.0.to_array()[0]
    }
    #[inline(always)]
    fn second(self) -> f64 {
        self.0.to_array()[1]
    }
    #[inline(always)]
    fn turned(self, first: bool, second: bool) -> Self {
        let sign = |is_turned| if is_turned { -0.0 } else { 0.0 };
        Self(self.0 ^ f64x2::new([sign(first), sign(second)]))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident;)*) => { $(
        impl $trait for PairOfDoubles {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl<S: $trait<Output = S>> $trait for Both<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )* };
}
operators! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits<P: Pair<f64>>(of: P) -> [u64; 2] {
        [of.first().to_bits(), of.second().to_bits()]
    }

    fn results<P: Pair<f64>>() -> Vec<[u64; 2]> {
        let numbers = [(1.0, -3.0), (0.1, 1e308), (-0.0, f64::MIN_POSITIVE), (f64::INFINITY, 7e-300)];
        let pairs = numbers.map(|(first, second)| P::new(first, second));
        let turned = [(false, false), (true, false), (false, true), (true, true)];
        let mut results: Vec<_> =
            pairs.iter().flat_map(|pair| turned.map(|(first, second)| bits(pair.turned(first, second)))).collect();
        for a in pairs {
            for b in pairs {
                results.extend([a + b, a - b, a * b, a / b].map(bits));
            }
        }
        results
    }

    #[test]
    fn vectors_round_like_numbers() {
        let is_number = |result: &[u64; 2]| result.map(|bits| !f64::from_bits(bits).is_nan());
        let (vectors, numbers) = (results::<PairOfDoubles>(), results::<Both<f64>>());
        assert_eq!(vectors.len(), 80);
        for (vector, number) in vectors.iter().zip(&numbers) {
            // The sign of what is not a number means nothing.
            assert_eq!(is_number(vector), is_number(number));
            for lane in 0..2 {
                assert!(vector[lane] == number[lane] || f64::from_bits(number[lane]).is_nan());
            }
        }
    }
}
