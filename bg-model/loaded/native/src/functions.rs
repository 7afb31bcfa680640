//! The functions that machine code calls: those that interpreters call.
//!
//! Sine and cosine of one angle are one call, in which the angle is reduced once: the same bits.

use bg_expressions::expr::Function;
use bg_model::scalar::Scalar;
use libm::sincos;

/// A function of one argument or of two, by its address; its name is no name of another library's.
pub struct Called {
    pub name: &'static str,
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "a module calls functions by their names"))]
    pub address: *const u8,
}

macro_rules! functions {
    ($($function:ident $name:ident ($($argument:ident),*) $method:ident;)*) => {
        $(
            /// A module calls it by its name.
            #[cfg_attr(
                target_arch = "wasm32",
                expect(unsafe_code, reason = "the name is no name of another library's"),
                unsafe(no_mangle)
            )]
            extern "C" fn $name($($argument: f64),*) -> f64 {
                Scalar::$method($($argument),*)
            }
        )*

        /// What machine code calls for a function; none of those that are instructions.
        pub fn called(function: Function) -> Option<Called> {
            match function {
                Function::Sqrt | Function::Abs => None,
                $(Function::$function => Some(Called {
                    name: stringify!($name),
                    address: $name as *const u8,
                }),)*
            }
        }
    };
}

functions! {
    Sin bg_native_sine(x) sin;
    Cos bg_native_cosine(x) cos;
    Tan bg_native_tangent(x) tan;
    Asin bg_native_arc_sine(x) asin;
    Acos bg_native_arc_cosine(x) acos;
    Atan2 bg_native_arc_tangent(y, x) atan2;
    Exp bg_native_exponential(x) exp;
    Ln bg_native_logarithm(x) ln;
    Tanh bg_native_hyperbolic_tangent(x) tanh;
    Pow bg_native_power(x, exponent) powf;
}

/// Sine and cosine of an angle, rad.
pub const SINE_AND_COSINE: &str = "bg_native_sine_and_cosine";

/// Sine and cosine, into two places.
#[cfg(not(target_arch = "wasm32"))]
pub extern "C" fn sine_and_cosine(x: f64, both: &mut [f64; 2]) {
    (both[0], both[1]) = sincos(x);
}

/// Sine and cosine, in two places that stay as they are until the next call.
#[cfg(target_arch = "wasm32")]
#[expect(unsafe_code, reason = "the name is no name of another library's")]
#[unsafe(no_mangle)]
extern "C" fn bg_native_sine_and_cosine(x: f64) -> *const f64 {
    thread_local! {
        static BOTH: std::cell::Cell<[f64; 2]> = const { std::cell::Cell::new([0.0; 2]) };
    }
    BOTH.with(|both| {
        both.set(sincos(x).into());
        both.as_ptr().cast_const().cast()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_at_once_are_those_of_single_calls() {
        let mut random = fastrand::Rng::with_seed(3);
        let edges = [
            0.0,
            -0.0,
            1e-300,
            1.05e-8,
            1.49e-8,
            -1.3e-8,
            std::f64::consts::FRAC_PI_4,
            1e5,
            1e22,
            f64::MAX,
            f64::INFINITY,
        ];
        let random = (0..100_000).map(|_| (2.0 * random.f64() - 1.0) * 2.0_f64.powi(random.i32(-40..40)));
        for x in edges.into_iter().chain(random) {
            let mut both = [0.0; 2];
            sine_and_cosine(x, &mut both);
            let alone = [Scalar::sin(x), Scalar::cos(x)];
            assert_eq!(both.map(f64::to_bits), alone.map(f64::to_bits), "{x:e}");
        }
    }
}
