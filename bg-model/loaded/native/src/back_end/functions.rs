//! The functions that machine code calls: those that interpreters call.
//!
//! Sine and cosine of one angle are one call, in which the angle is reduced once: the same bits.

use bg_expressions::expr::Function;
use bg_model::scalar::Scalar;
use libm::sincos;

/// A function of one argument or of two, by its address; its name is no name of another library's.
pub struct Called {
    pub name: &'static str,
    pub address: *const u8,
}

macro_rules! functions {
    ($($function:ident $name:ident ($($argument:ident),*) $method:ident;)*) => {
        $(extern "C" fn $name($($argument: f64),*) -> f64 {
            Scalar::$method($($argument),*)
        })*

        /// What machine code calls for a function; none of those that are instructions.
        pub fn called(function: Function) -> Option<Called> {
            match function {
                Function::Sqrt | Function::Abs => None,
                $(Function::$function => Some(Called {
                    name: concat!("bg_native_", stringify!($name)),
                    address: $name as *const u8,
                }),)*
            }
        }
    };
}

functions! {
    Sin sine(x) sin;
    Cos cosine(x) cos;
    Tan tangent(x) tan;
    Asin arc_sine(x) asin;
    Acos arc_cosine(x) acos;
    Atan2 arc_tangent(y, x) atan2;
    Exp exponential(x) exp;
    Ln logarithm(x) ln;
    Tanh hyperbolic_tangent(x) tanh;
    Pow power(x, exponent) powf;
}

/// Sine and cosine of an angle, rad.
pub const SINE_AND_COSINE: &str = "bg_native_sine_and_cosine";

/// Sine and cosine, into two places.
pub extern "C" fn sine_and_cosine(x: f64, both: &mut [f64; 2]) {
    (both[0], both[1]) = sincos(x);
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
