//! Logarithms and exponentials of numbers side by side.
//!
//! In: numbers. Out: what `libm` gives for each, to the bit: the same operations in the same order, for numbers of an
//! ordinary size without branches, so that a compiler makes them in vectors. Where one of the numbers is another,
//! `libm` is called for each. Source: `e_log.c` and `e_exp.c` of FreeBSD's msun, after which those of the crate `libm`
//! 0.2 are made.

use std::f64::consts::LOG2_E;

/// The natural logarithm of 2 in two parts: a multiple of the first by a small whole number is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Coefficients of the logarithm.
const LN: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];
/// Coefficients of the exponential.
const EXP: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];
/// The bits of an exponent of 0, and those of the root of 1/2, in the upper half of a number.
const EXPONENT: u64 = 0x3ff0_0000;
const ROOT: u64 = 0x3fe6_a09e;

/// Replaces numbers by their natural logarithms.
#[inline(always)]
pub fn ln(numbers: &mut [f64]) {
    let mut are_plain = true;
    for x in &*numbers {
        // Not 1, whose logarithm is an exact 0.
        are_plain &= *x >= f64::MIN_POSITIVE && *x <= f64::MAX && *x != 1.0;
    }
    if are_plain {
        for x in numbers {
            *x = plain_ln(*x);
        }
    } else {
        for x in numbers {
            *x = libm::log(*x);
        }
    }
}

/// Replaces numbers by their exponentials.
#[inline(always)]
pub fn exp(numbers: &mut [f64]) {
    const SMALLEST: f64 = 1e-8;
    const LARGEST: f64 = 700.0;
    let mut are_plain = true;
    for x in &*numbers {
        are_plain &= x.abs() >= SMALLEST && x.abs() <= LARGEST;
    }
    if are_plain {
        for x in numbers {
            *x = plain_exp(*x);
        }
    } else {
        for x in numbers {
            *x = libm::exp(*x);
        }
    }
}

/// The logarithm of a positive, normal number that is not 1: ln(2^k (1 + f)) with 1 + f between the roots of 1/2 and 2.
#[inline(always)]
fn plain_ln(x: f64) -> f64 {
    let upper = (x.to_bits() >> 32) + (EXPONENT - ROOT);
    let k = f64::from((upper >> 20) as i32 - 0x3ff);
    let f = f64::from_bits(((upper & 0xf_ffff) + ROOT) << 32 | x.to_bits() & 0xffff_ffff) - 1.0;
    let half = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (LN[1] + w * (LN[3] + w * LN[5]));
    let odd = z * (LN[0] + w * (LN[2] + w * (LN[4] + w * LN[6])));
    s * (half + (odd + even)) + k * LN_2[1] - half + f + k * LN_2[0]
}

/// The exponential of a number that is neither small nor large: 2^k times that of what is left, at most half of ln 2.
#[inline(always)]
fn plain_exp(x: f64) -> f64 {
    // In the upper half of a number, as the original compares.
    const HALF_OF_LN_2: u64 = 0x3fd6_2e42;
    let is_near = x.abs().to_bits() >> 32 <= HALF_OF_LN_2;
    let nearest = LOG2_E * x + if x < 0.0 { -0.5 } else { 0.5 };
    let k = if is_near { 0.0 } else { nearest };
    // Bounded by the caller.
    let k = k as i32;
    let (high, low) = (x - f64::from(k) * LN_2[0], f64::from(k) * LN_2[1]);
    let rest = high - low;
    let square = rest * rest;
    let c = rest - square * (EXP[0] + square * (EXP[1] + square * (EXP[2] + square * (EXP[3] + square * EXP[4]))));
    let y = 1.0 + (rest * c / (2.0 - c) - low + high);
    y * f64::from_bits(((0x3ff + k) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with `libm` at numbers of both signs and many sizes, in groups as they come.
    fn compare(of: fn(&mut [f64]), expected: fn(f64) -> f64, numbers: impl Iterator<Item = f64>) {
        let numbers: Vec<f64> = numbers.collect();
        for group in numbers.chunks(8) {
            let mut found = group.to_vec();
            of(&mut found);
            for (x, found) in group.iter().zip(found) {
                let expected = expected(*x);
                assert!(
                    found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
                    "{x:e}: {found:e}"
                );
            }
        }
    }

    /// Numbers of all mantissas and of exponents from `from` to `to`.
    fn spread(from: f64, to: f64) -> impl Iterator<Item = f64> {
        const COUNT: u32 = 200_000;
        (0..COUNT).map(move |i| libm::exp2(from + (to - from) * f64::from(i) / f64::from(COUNT)))
    }

    #[test]
    fn they_are_those_of_libm() {
        compare(ln, libm::log, spread(-1022.0, 1023.9));
        compare(ln, libm::log, spread(-2.0, 2.0));
        compare(exp, libm::exp, spread(-40.0, 11.0));
        compare(exp, libm::exp, spread(-40.0, 11.0).map(|x| -x));
        let bounds = [0.5 * std::f64::consts::LN_2, 1.5 * std::f64::consts::LN_2];
        let beside = bounds.into_iter().flat_map(|x| {
            [0x3fd6_2e42_u64, 0x3fd6_2e43, 0x3ff0_a2b1, 0x3ff0_a2b2, 0x3ff0_a2b3]
                .into_iter()
                .flat_map(move |upper| [f64::from_bits(upper << 32), f64::from_bits(upper << 32 | 0xffff_ffff), x])
        });
        compare(exp, libm::exp, beside.clone());
        compare(exp, libm::exp, beside.map(|x| -x));
        let special = [0.0, -0.0, 1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -3.0, 5e-324, 800.0, -800.0, 1e-300];
        for of in special {
            compare(ln, libm::log, [2.5, of].into_iter());
            compare(exp, libm::exp, [2.5, of].into_iter());
        }
    }
}
