//! A method that serves several systems.

use crate::problems::*;
use bg_model::integrator::{AnyMethod, Integrator};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Span, integrate};

const STEP: f64 = 1e-3;

const SPAN: Span = Span { t0: 0.0, t_end: 1.0 };

/// The bits of the two states at the end of a run.
fn small(method: &mut AnyMethod) -> SVector<u64, 2> {
    let oscillator: Rate<2, 0> = |_, x, _| [x[1], -x[0] * x[0] * x[0]];
    let start = SVector::from([2.0, 0.0]);
    let finish = integrate(&smooth(oscillator), method, &start, SPAN, &settings(1e-7), &mut ());
    finish.expect("a smooth system").state::<2>().map(f64::to_bits)
}

/// The same of four states.
fn large(method: &mut AnyMethod) -> SVector<u64, 4> {
    let finish = integrate(&kepler(), method, &kepler_start(), SPAN, &settings(1e-7), &mut ());
    finish.expect("a smooth system").state::<4>().map(f64::to_bits)
}

#[test]
fn runs_of_other_numbers_of_states_are_those_of_a_new_method() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.needs_series()) {
        let new = || integrator.method(STEP);
        let (expected_small, expected_large) = (small(&mut new()), large(&mut new()));
        let mut method = new();
        assert_eq!(small(&mut method), expected_small, "{integrator}");
        assert_eq!(large(&mut method), expected_large, "{integrator}");
        assert_eq!(small(&mut method), expected_small, "{integrator}, with fewer states again");
    }
}
