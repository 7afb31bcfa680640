//! Numbers of several runs side by side, in the vectors of a machine.
//!
//! In: nothing. Out: the operations of generated code on four numbers in AVX2 and on eight in AVX-512. Each operation
//! is rounded alone and functions are those of `f64`, one number after the other: so in each place there are the bits
//! of `f64`.

mod functions;

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::NullaryFnOnce;

use super::slopes::Slopes;
use super::{Both, Scalar};

/// A vector of a machine, with what runs side by side need besides.
pub trait Vector: Slopes {
    /// What is true in some places.
    type Mask: Copy + Debug + From<bool>;

    /// The mask of these places, the first one the lowest bit.
    fn mask(bits: u8) -> Self::Mask;
    /// The places of a mask.
    fn bits(mask: Self::Mask) -> u8;
    /// Where a number is below that of `other`; not where one of them is none.
    fn below(self, other: Self) -> Self::Mask;
    /// The numbers of `yes` where the mask is true, elsewhere those of `no`.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The opposite.
    #[must_use]
    fn negated(self) -> Self;
    /// The square roots.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The number at a place, read where the vector lies in memory.
    fn at(&self, place: usize) -> &f64;
    /// The same, to be written.
    fn at_mut(&mut self, place: usize) -> &mut f64;
}

/// Numbers side by side.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<V>(pub V);

impl<V: Vector> Lanes<V> {
    /// The numbers that `of` gives for the places.
    pub fn each(mut of: impl FnMut(usize) -> f64) -> Self {
        let mut numbers = V::filled(0.0).numbers();
        numbers.as_mut().iter_mut().enumerate().for_each(|(lane, number)| *number = of(lane));
        Self(V::new(numbers))
    }

    /// A number for each place.
    pub fn side_by_side(numbers: &[f64]) -> Self {
        Self::each(|place| numbers[place])
    }

    /// The number at a place.
    pub fn get(self, lane: usize) -> f64 {
        self.0.numbers().as_ref()[lane]
    }

    /// A function of each.
    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let mut numbers = self.0.numbers();
        numbers.as_mut().iter_mut().for_each(|number| *number = of(*number));
        Self(V::new(numbers))
    }

    /// A function of each of two.
    fn map_both(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let (mut numbers, others) = (self.0.numbers(), other.0.numbers());
        numbers.as_mut().iter_mut().zip(others.as_ref()).for_each(|(number, other)| *number = of(*number, *other));
        Self(V::new(numbers))
    }
}

/// Replaces numbers at the places of `mask`.
#[inline(always)]
pub fn replace<V: Vector>(to: &mut [Lanes<V>], mask: V::Mask, from: &[Lanes<V>]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = Lanes::select(mask, *from, *to);
    }
}

/// Writes the numbers of all states at a place into `to`.
#[inline]
pub fn take<V: Vector>(place: usize, of: &[Lanes<V>], to: &mut [f64]) {
    for (to, of) in to.iter_mut().zip(of) {
        *to = *of.0.at(place);
    }
}

/// The numbers at a place.
pub fn at<V: Vector>(place: usize, of: &[Lanes<V>]) -> Vec<f64> {
    of.iter().map(|of| *of.0.at(place)).collect()
}

/// Puts numbers of all states at a place.
#[inline]
pub fn put<V: Vector>(place: usize, to: &mut [Lanes<V>], numbers: &[f64]) {
    for (to, number) in to.iter_mut().zip(numbers) {
        *to.0.at_mut(place) = *number;
    }
}

/// The natural logarithms of numbers, those of `libm` to the bit.
pub fn logarithms<V: Vector>(of: V::Numbers) -> V::Numbers {
    V::vectorized(Function::<V, _> { of, function: Logarithm })
}

/// Their exponentials, those of `libm` to the bit.
pub fn exponentials<V: Vector>(of: V::Numbers) -> V::Numbers {
    V::vectorized(Function::<V, _> { of, function: Exponential })
}

/// A function of numbers side by side.
trait OfAll {
    fn replace(self, numbers: &mut [f64]);
}

struct Logarithm;

impl OfAll for Logarithm {
    #[inline(always)]
    fn replace(self, numbers: &mut [f64]) {
        functions::ln(numbers);
    }
}

struct Exponential;

impl OfAll for Exponential {
    #[inline(always)]
    fn replace(self, numbers: &mut [f64]) {
        functions::exp(numbers);
    }
}

struct Function<V: Vector, F> {
    of: V::Numbers,
    function: F,
}

impl<V: Vector, F: OfAll> NullaryFnOnce for Function<V, F> {
    type Output = V::Numbers;

    #[inline(always)]
    fn call(mut self) -> V::Numbers {
        self.function.replace(self.of.as_mut());
        self.of
    }
}

/// All numbers are equal.
impl<V: Vector> PartialEq for Lanes<V> {
    fn eq(&self, other: &Self) -> bool {
        self.0.numbers().as_ref() == other.0.numbers().as_ref()
    }
}

/// In one order where all numbers are.
impl<V: Vector> PartialOrd for Lanes<V> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let (numbers, others) = (self.0.numbers(), other.0.numbers());
        let mut each = numbers.as_ref().iter().zip(others.as_ref()).map(|(number, other)| number.partial_cmp(other));
        let first = each.next().flatten()?;
        each.all(|order| order == Some(first)).then_some(first)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $of:ident;)*) => { $(
        impl<V: Vector> $trait for Lanes<V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$of(other.0))
            }
        }
    )* };
}
operators! {
    Add add plus;
    Sub sub minus;
    Mul mul times;
    Div div over;
}

impl<V: Vector> Neg for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.negated())
    }
}

impl<V: Vector> Scalar for Lanes<V> {
    type Pair = Both<Self>;
    type Switch = V::Mask;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(V::filled(value))
    }
    /// The first number: what it stands for in checks has been checked for each.
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.get(0)
    }
    #[inline(always)]
    fn alike(self, value: f64) -> Self {
        Self(self.0.alike(value))
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * self.alike(factor)
    }
    #[inline(always)]
    fn select(switch: V::Mask, negative: Self, positive: Self) -> Self {
        Self(V::select(switch, negative.0, positive.0))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.larger(other.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sin(self) -> Self {
        self.map(Scalar::sin)
    }
    fn cos(self) -> Self {
        self.map(Scalar::cos)
    }
    fn tan(self) -> Self {
        self.map(Scalar::tan)
    }
    fn asin(self) -> Self {
        self.map(Scalar::asin)
    }
    fn acos(self) -> Self {
        self.map(Scalar::acos)
    }
    fn atan2(self, x: Self) -> Self {
        self.map_both(x, Scalar::atan2)
    }
    fn exp(self) -> Self {
        Self(V::new(exponentials::<V>(self.0.numbers())))
    }
    fn ln(self) -> Self {
        Self(V::new(logarithms::<V>(self.0.numbers())))
    }
    fn tanh(self) -> Self {
        self.map(Scalar::tanh)
    }
    fn powf(self, exponent: Self) -> Self {
        self.map_both(exponent, Scalar::powf)
    }
}

#[cfg(target_arch = "x86_64")]
pub use machines::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod machines {
    use std::arch::x86_64::{__m256d, __m512d, _CMP_LT_OQ};
    use std::fmt;
    use std::sync::OnceLock;

    use pulp::x86::{V3, V4};
    use pulp::{NullaryFnOnce, bytemuck};

    use super::{Slopes, Vector};

    /// Places of AVX2: all bits of a number, or none.
    #[derive(Clone, Copy, Debug)]
    pub struct Mask4(__m256d);

    impl From<bool> for Mask4 {
        #[inline(always)]
        fn from(all: bool) -> Self {
            Self(pulp::cast([if all { u64::MAX } else { 0 }; 4]))
        }
    }

    /// Places of AVX-512: a bit for each number.
    #[derive(Clone, Copy, Debug)]
    pub struct Mask8(u8);

    impl From<bool> for Mask8 {
        #[inline(always)]
        fn from(all: bool) -> Self {
            Self(if all { u8::MAX } else { 0 })
        }
    }

    macro_rules! vector {
        (
            $(#[$doc:meta])* $vector:ident of $lanes:literal: $all:ident of $machine:ident, $mask:ident, $kept:ident;
            { $($of:ident = $operation_set:ident.$operation:ident;)* }
            $abs:item
            $($own:item)*
        ) => {
            $(#[$doc])*
            #[derive(Clone, Copy)]
            pub struct $vector {
                all: $all,
                machine: $machine,
            }

            /// The machine, once it was asked for: a look at it is a call, which would keep values out of registers.
            static $kept: OnceLock<$machine> = OnceLock::new();

            impl $vector {
                #[inline(always)]
                fn machine() -> $machine {
                    *$kept.get().expect("who keeps numbers in such vectors has asked whether the machine has them")
                }
            }

            impl fmt::Debug for $vector {
                fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                    self.numbers().fmt(formatter)
                }
            }

            impl Slopes for $vector {
                type Numbers = [f64; $lanes];

                const LANES: usize = $lanes;
                const MUST_BE_INLINED: bool = true;

                fn is_at_hand() -> bool {
                    $machine::try_new().map(|machine| $kept.get_or_init(|| machine)).is_some()
                }
                #[inline(always)]
                fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output {
                    Self::machine().vectorize(of)
                }
                #[inline(always)]
                fn new(numbers: [f64; $lanes]) -> Self {
                    Self { all: pulp::cast(numbers), machine: Self::machine() }
                }
                #[inline(always)]
                fn numbers(self) -> [f64; $lanes] {
                    pulp::cast(self.all)
                }
                #[inline(always)]
                fn filled(value: f64) -> Self {
                    Self::new([value; $lanes])
                }
                #[inline(always)]
                fn alike(self, value: f64) -> Self {
                    Self { all: pulp::cast([value; $lanes]), ..self }
                }
                $(
                    #[inline(always)]
                    fn $of(self, other: Self) -> Self {
                        Self { all: self.machine.$operation_set.$operation(self.all, other.all), ..self }
                    }
                )*
                #[inline(always)]
                $abs
            }

            impl Vector for $vector {
                type Mask = $mask;

                #[inline(always)]
                fn at(&self, place: usize) -> &f64 {
                    &bytemuck::cast_ref::<_, [f64; $lanes]>(&self.all)[place]
                }
                #[inline(always)]
                fn at_mut(&mut self, place: usize) -> &mut f64 {
                    &mut bytemuck::cast_mut::<_, [f64; $lanes]>(&mut self.all)[place]
                }

                $(
                    #[inline(always)]
                    $own
                )*
            }
        };
    }

    vector! {
        /// A vector of AVX2.
        Avx2 of 4: __m256d of V3, Mask4, AVX2;
        {
        plus = avx._mm256_add_pd;
        minus = avx._mm256_sub_pd;
        times = avx._mm256_mul_pd;
        over = avx._mm256_div_pd;
        // The second one where one of them is no number.
        larger = avx._mm256_max_pd;
        }

        fn abs(self) -> Self {
            Self { all: self.machine.avx._mm256_andnot_pd(self.alike(-0.0).all, self.all), ..self }
        }
        fn mask(bits: u8) -> Mask4 {
            Mask4(pulp::cast(std::array::from_fn::<u64, 4, _>(|lane| if bits >> lane & 1 == 1 { u64::MAX } else { 0 })))
        }
        fn bits(mask: Mask4) -> u8 {
            let places: [u64; 4] = pulp::cast(mask.0);
            places.iter().enumerate().fold(0, |bits, (lane, place)| bits | ((place & 1) as u8) << lane)
        }
        fn below(self, other: Self) -> Mask4 {
            Mask4(self.machine.avx._mm256_cmp_pd::<_CMP_LT_OQ>(self.all, other.all))
        }
        fn select(mask: Mask4, yes: Self, no: Self) -> Self {
            Self { all: yes.machine.avx._mm256_blendv_pd(no.all, yes.all, mask.0), ..yes }
        }
        fn negated(self) -> Self {
            Self { all: self.machine.avx._mm256_xor_pd(self.all, self.alike(-0.0).all), ..self }
        }
        fn sqrt(self) -> Self {
            Self { all: self.machine.avx._mm256_sqrt_pd(self.all), ..self }
        }
    }

    vector! {
        /// A vector of AVX-512.
        Avx512 of 8: __m512d of V4, Mask8, AVX512;
        {
        plus = avx512f._mm512_add_pd;
        minus = avx512f._mm512_sub_pd;
        times = avx512f._mm512_mul_pd;
        over = avx512f._mm512_div_pd;
        // The second one where one of them is no number.
        larger = avx512f._mm512_max_pd;
        }

        fn abs(self) -> Self {
            Self { all: self.machine.avx512f._mm512_abs_pd(self.all), ..self }
        }
        fn mask(bits: u8) -> Mask8 {
            Mask8(bits)
        }
        fn bits(mask: Mask8) -> u8 {
            mask.0
        }
        fn below(self, other: Self) -> Mask8 {
            Mask8(self.machine.avx512f._mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.all, other.all))
        }
        fn select(mask: Mask8, yes: Self, no: Self) -> Self {
            Self { all: yes.machine.avx512f._mm512_mask_blend_pd(mask.0, no.all, yes.all), ..yes }
        }
        fn negated(self) -> Self {
            Self { all: self.machine.avx512dq._mm512_xor_pd(self.all, self.alike(-0.0).all), ..self }
        }
        fn sqrt(self) -> Self {
            Self { all: self.machine.avx512f._mm512_sqrt_pd(self.all), ..self }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::tests::everything;

    /// Numbers of all kinds, as many as there are places.
    fn numbers<V: Vector>(from: usize) -> Lanes<V> {
        const KINDS: [f64; 9] = [1.5, -0.3, -0.0, 1e308, f64::MIN_POSITIVE, f64::INFINITY, f64::NAN, -7e-300, 0.9];
        Lanes::each(|lane| KINDS[(from + lane) % KINDS.len()])
    }

    /// What is expected of two numbers.
    type OfTwo = fn(f64, f64) -> f64;

    fn same(of: f64, expected: f64) -> bool {
        of.to_bits() == expected.to_bits() || of.is_nan() && expected.is_nan()
    }

    fn checked<V: Vector>() {
        if !V::is_at_hand() {
            return;
        }
        for (a, b) in (0..9).flat_map(|a| (0..9).map(move |b| (numbers::<V>(a), numbers::<V>(b)))) {
            let results: [(Lanes<V>, OfTwo); 9] = [
                (a + b, |a, b| a + b),
                (a - b, |a, b| a - b),
                (a * b, |a, b| a * b),
                (a / b, |a, b| a / b),
                (-a, |a, _| -a),
                (a.abs(), |a, _| a.abs()),
                (a.larger(b), |a, b| if a > b { a } else { b }),
                (a.sqrt(), |a, _| a.sqrt()),
                (Lanes::select(V::below(a.0, b.0), a, b), |a, b| if a < b { a } else { b }),
            ];
            for (case, (result, expected)) in results.into_iter().enumerate() {
                for lane in 0..V::LANES {
                    let (a, b) = (a.get(lane), b.get(lane));
                    assert!(same(result.get(lane), expected(a, b)), "{case}: {a} {b} {}", result.get(lane));
                }
            }
            for bits in [0, 0b101, 0b1010] {
                assert_eq!(V::bits(V::mask(bits)), bits);
            }
            for lane in 0..V::LANES {
                let mut both = [0.0; 2];
                take(lane, &[b, a], &mut both);
                assert!(same(both[1], a.get(lane)));
            }
        }
        let (x, y) = (Lanes::<V>::each(|lane| 0.3 + 0.1 * lane as f64), Lanes::each(|lane| 0.9 - 0.1 * lane as f64));
        let all = everything(x, y);
        for lane in 0..V::LANES {
            assert_eq!(all.get(lane).to_bits(), everything(x.get(lane), y.get(lane)).to_bits());
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn each_place_has_the_bits_of_a_number_by_itself() {
        checked::<Avx2>();
        checked::<Avx512>();
    }
}
