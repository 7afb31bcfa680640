//! The zero of a function of one variable between a point where it is positive and one where it is not.

/// How exactly a zero is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precision {
    /// An absolute value that counts as zero.
    pub zero: f64,
    /// An absolute value from which on the search may stop where rounding keeps it from falling.
    pub rounding: f64,
}

/// The search for the zero of a function between `right`, where it is positive, and `wrong`, where it is not: it says
/// where it asks for a value and is told it.
///
/// Newton's method from a guess with a slope there, then secants, inside the narrowing bracket; bisection where that
/// fails. At a jump the point on the wrong side. The bracket's ends are not evaluated. A value that is not a number
/// counts as the wrong side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    right: f64,
    /// With the value there, once it is known.
    wrong: (f64, f64),
    slope: f64,
    precision: Precision,
    /// Where the value is asked for.
    at: f64,
    /// The last place and the value there, once there is one.
    last: Option<(f64, f64)>,
    /// The place with the least value.
    best: (f64, f64),
    /// Values since that.
    stalls: u32,
    steps: usize,
}

impl Search {
    pub fn new(right: f64, wrong: f64, guess: f64, slope: f64, precision: Precision) -> Self {
        let at = if guess > right && guess < wrong { guess } else { 0.5 * (right + wrong) };
        let (wrong, best) = ((wrong, f64::NAN), (at, f64::NAN));
        Self { right, wrong, slope, precision, at, last: None, best, stalls: 0, steps: 0 }
    }

    /// Where the value is asked for.
    pub fn at(&self) -> f64 {
        self.at
    }

    /// Takes the value there; gives the zero and the value in it once it is found.
    pub fn take(&mut self, value: f64) -> Option<(f64, f64)> {
        // Secants need at most ten steps; then halving the bracket needs one for each bit.
        const SECANTS: usize = 12;
        const STEPS: usize = SECANTS + 1080;
        let (at, precision) = (self.at, self.precision);
        if let Some((last, before)) = self.last.replace((at, value)) {
            self.slope = (value - before) / (at - last);
        }
        if value.abs() < self.best.1.abs() || self.best.1.is_nan() {
            (self.best, self.stalls) = ((at, value), 0);
        } else {
            self.stalls += 1;
        }
        let is_stalled = self.stalls >= 2 && self.best.1.abs() <= precision.rounding;
        if self.steps == STEPS || value.abs() <= precision.zero || is_stalled {
            return Some(self.found());
        }
        if value > 0.0 {
            self.right = at;
        } else {
            self.wrong = (at, value);
        }
        let (right, wrong, newton) = (self.right, self.wrong.0, at - value / self.slope);
        let is_inside = newton > right && newton < wrong && self.steps < SECANTS;
        let next = if is_inside { newton } else { 0.5 * (right + wrong) };
        let is_settled = (newton - at).abs() <= 2.0 * f64::EPSILON * at.abs() && value.abs() <= precision.rounding;
        if is_settled || next <= right || next >= wrong {
            return Some(self.found());
        }
        (self.at, self.steps) = (next, self.steps + 1);
        None
    }

    fn found(&self) -> (f64, f64) {
        if self.best.1.abs() <= self.precision.rounding { self.best } else { self.wrong }
    }
}

/// The zero of `f` as [`Search`] finds it, and the value there.
pub(super) fn zero(mut search: Search, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    loop {
        if let Some(found) = search.take(f(search.at())) {
            return found;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Precision = Precision { zero: 1e-16, rounding: 1e-10 };

    #[test]
    fn a_smooth_zero_takes_few_evaluations() {
        let mut evaluations = 0;
        let (at, value) = zero(Search::new(0.0, 2.0, 0.7, -1.0, EXACT), |x| {
            evaluations += 1;
            0.5 - x * x
        });
        assert!((at - 0.5_f64.sqrt()).abs() <= 2e-16 && value.abs() < 3e-16, "{at}");
        assert!(evaluations <= 7, "{evaluations}");
    }

    #[test]
    fn a_bad_guess_and_slope_are_made_up_for() {
        for slope in [f64::NAN, 0.0, 1.0, -1e9, -1e-9] {
            let (at, _) = zero(Search::new(0.0, 1.0, 2.0, slope, EXACT), |x| libm::cos(1.5 * x * x * x + 0.5));
            assert!((at - libm::cbrt((core::f64::consts::FRAC_PI_2 - 0.5) / 1.5)).abs() < 1e-15, "{slope}: {at}");
        }
    }

    #[test]
    fn at_a_jump_the_wrong_side_is_found() {
        let (at, value) = zero(Search::new(0.0, 1.0, 0.3, -1.0, EXACT), |x| if x < 0.6 { 0.5 } else { -0.25 });
        assert_eq!((at, value), (0.6, -0.25));
        let (at, _) = zero(Search::new(0.0, 1.0, 0.3, -1.0, EXACT), |x| if x < 0.6 { 0.5 } else { f64::NAN });
        assert_eq!(at, 0.6);
    }

    #[test]
    fn a_zero_of_high_multiplicity_ends() {
        let (at, _) = zero(Search::new(0.0, 1.0, 0.9, -1.0, EXACT), |x| -(x - 0.25) * (x - 0.25) * (x - 0.25));
        assert!((at - 0.25).abs() < 1e-3, "{at}");
    }
}
