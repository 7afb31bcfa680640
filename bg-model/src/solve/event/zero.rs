//! The zero of a function of one variable between a point where it is positive and one where it is not.

/// How exactly a zero is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precision {
    /// An absolute value that counts as zero.
    pub zero: f64,
    /// An absolute value from which on the search may stop where rounding keeps it from falling.
    pub rounding: f64,
}

/// The zero of `f` between `right`, where it is positive, and `wrong`, where it is not, and its value there.
///
/// Newton's method from `guess` with the slope `slope`, then secants, inside the narrowing bracket; bisection where that
/// fails. At a jump the point on the wrong side. The bracket's ends are not evaluated. A value that is not a number
/// counts as the wrong side.
pub(super) fn zero(
    mut right: f64,
    mut wrong: f64,
    guess: f64,
    mut slope: f64,
    precision: Precision,
    mut f: impl FnMut(f64) -> f64,
) -> (f64, f64) {
    // Secants need at most ten steps; then halving the bracket needs one for each bit.
    const SECANTS: usize = 12;
    const STEPS: usize = SECANTS + 1080;
    let mut at = if guess > right && guess < wrong { guess } else { 0.5 * (right + wrong) };
    let mut value = f(at);
    let mut best = (at, value);
    let mut wrong_value = f64::NAN;
    let mut stalls = 0;
    for step in 0..STEPS {
        if value.abs() <= precision.zero || (stalls >= 2 && best.1.abs() <= precision.rounding) {
            break;
        }
        if value > 0.0 {
            right = at;
        } else {
            (wrong, wrong_value) = (at, value);
        }
        let newton = at - value / slope;
        let is_inside = newton > right && newton < wrong && step < SECANTS;
        if (newton - at).abs() <= 2.0 * f64::EPSILON * at.abs() && value.abs() <= precision.rounding {
            break;
        }
        let next = if is_inside { newton } else { 0.5 * (right + wrong) };
        if next <= right || next >= wrong {
            break;
        }
        let next_value = f(next);
        slope = (next_value - value) / (next - at);
        (at, value) = (next, next_value);
        if value.abs() < best.1.abs() || best.1.is_nan() {
            (best, stalls) = ((at, value), 0);
        } else {
            stalls += 1;
        }
    }
    if best.1.abs() <= precision.rounding { best } else { (wrong, wrong_value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Precision = Precision { zero: 1e-16, rounding: 1e-10 };

    #[test]
    fn a_smooth_zero_takes_few_evaluations() {
        let mut evaluations = 0;
        let (at, value) = zero(0.0, 2.0, 0.7, -1.0, EXACT, |x| {
            evaluations += 1;
            0.5 - x * x
        });
        assert!((at - 0.5_f64.sqrt()).abs() <= 2e-16 && value.abs() < 3e-16, "{at}");
        assert!(evaluations <= 7, "{evaluations}");
    }

    #[test]
    fn a_bad_guess_and_slope_are_made_up_for() {
        for slope in [f64::NAN, 0.0, 1.0, -1e9, -1e-9] {
            let (at, _) = zero(0.0, 1.0, 2.0, slope, EXACT, |x| libm::cos(1.5 * x * x * x + 0.5));
            assert!((at - libm::cbrt((core::f64::consts::FRAC_PI_2 - 0.5) / 1.5)).abs() < 1e-15, "{slope}: {at}");
        }
    }

    #[test]
    fn at_a_jump_the_wrong_side_is_found() {
        let (at, value) = zero(0.0, 1.0, 0.3, -1.0, EXACT, |x| if x < 0.6 { 0.5 } else { -0.25 });
        assert_eq!((at, value), (0.6, -0.25));
        let (at, _) = zero(0.0, 1.0, 0.3, -1.0, EXACT, |x| if x < 0.6 { 0.5 } else { f64::NAN });
        assert_eq!(at, 0.6);
    }

    #[test]
    fn a_zero_of_high_multiplicity_ends() {
        let (at, _) = zero(0.0, 1.0, 0.9, -1.0, EXACT, |x| -(x - 0.25) * (x - 0.25) * (x - 0.25));
        assert!((at - 0.25).abs() < 1e-3, "{at}");
    }
}
