//! Functions of `f64` that Rust's core library lacks, for all that runs without `std` too.
//!
//! Each is exact or correctly rounded, or products in a fixed order: the bits are those of `std` on any machine.

use super::Scalar;

/// Square root.
#[cfg(feature = "std")]
#[inline(always)]
pub fn root(of: f64) -> f64 {
    of.sqrt()
}

/// Square root.
#[cfg(not(feature = "std"))]
#[inline(always)]
pub fn root(of: f64) -> f64 {
    libm::sqrt(of)
}

/// What comes after the point, with the sign of the number.
pub fn fraction(of: f64) -> f64 {
    of - libm::trunc(of)
}

/// The remainder from 0 to below `modulus`, which is above 0.
pub fn modulo(of: f64, modulus: f64) -> f64 {
    let rest = of % modulus;
    if rest < 0.0 { rest + modulus } else { rest }
}

/// The number to a whole `exponent`, by squares.
#[inline(always)]
pub fn power<S: Scalar>(of: S, exponent: u32) -> S {
    let (mut result, mut square, mut rest) = (of.alike(1.0), of, exponent);
    while rest > 0 {
        if rest % 2 == 1 {
            result = result * square;
        }
        square = square * square;
        rest /= 2;
    }
    result
}

/// The larger number; not a number where one of them is none, which a comparison would pass over.
#[inline(always)]
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// The first number that is not finite, with its place.
#[inline(never)]
pub(crate) fn first_not_finite(numbers: &[f64]) -> Option<(usize, f64)> {
    numbers.iter().copied().enumerate().find(|(_, value)| !value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_the_standard_library() {
        let numbers = [-1e17, -7.25, -1.0, -0.3, 0.0, 0.1, 0.999_999_999, 1.0, 2.7, 63.5, 1e9 + 0.1, 1e300];
        for x in numbers {
            assert_eq!(fraction(x).to_bits(), x.fract().to_bits(), "{x}");
            assert_eq!(modulo(x, 4.0).to_bits(), x.rem_euclid(4.0).to_bits(), "{x}");
            assert_eq!(root(x.abs()).to_bits(), libm::sqrt(x.abs()).to_bits(), "{x}");
            for exponent in 0..8 {
                assert_eq!(power(x, exponent).to_bits(), x.powi(exponent as i32).to_bits(), "{x} {exponent}");
            }
        }
    }
}
