//! Generated Taylor series are those of the generated rates: the derivative of the polynomial is the rate along it.
//!
//! Held for every example and every scene of the hacksaw at random states, every switch in either branch, over a time
//! so short that what the polynomial leaves out is below rounding, and so long that its later terms are not.

use bg_model::dynamics::Machine;
use bg_model::input::Input;
use bond_graph_tests::support::example::{self, Example};
use bond_graph_tests::support::power::{Draw, state};
use bond_graph_tests::support::record::along;
use bond_graph_tests::{each_example, each_scene};

/// The order of the polynomials.
const ORDER: usize = 12;
/// The largest last term over the largest term of any state.
const LAST: f64 = 1e-14;
/// The largest difference between the derivative and the rate, relative to the sum of the derivative's terms.
const DIFFERENCE: f64 = 1e-11;

/// The states at the start, then the terms of each order, of all states.
type Polynomial = Vec<f64>;

/// The series from time `t` and state `x` in units of `h`.
fn series(model: &dyn Machine, (t, h): (f64, f64), x: &[f64], negative: &[bool]) -> Polynomial {
    let mut polynomial = vec![f64::NAN; (ORDER + 1) * x.len()];
    polynomial[..x.len()].copy_from_slice(x);
    let size = model.series().expect("constant inputs only");
    model.expand(t, h, negative, &mut vec![f64::NAN; ORDER * size.width], &mut polynomial);
    polynomial
}

/// The largest magnitude of these numbers.
fn largest(of: &[f64]) -> f64 {
    of.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// The sum of the terms at the part `theta` of the unit, each times what `factor` makes of its order.
fn sum(polynomial: &[f64], n: usize, theta: f64, factor: impl Fn(usize) -> f64) -> Vec<f64> {
    let term = |k: usize, order: usize| polynomial[order * n + k] * (factor(order) * theta.powi(order as i32));
    (0..n).map(|k| (0..=ORDER).fold(0.0, |sum, order| sum + term(k, order))).collect()
}

/// The polynomial from here with the unit of time that makes its last terms small, and that unit.
fn short(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Option<(Polynomial, f64)> {
    let (n, mut h) = (x.len(), 1.0);
    for _ in 0..60 {
        let polynomial = series(model, (t, h), x, negative);
        if polynomial.iter().any(|value| value.is_nan()) {
            return None;
        }
        if largest(&polynomial[(ORDER - 1) * n..]) <= LAST * largest(&polynomial[n..]) {
            return Some((polynomial, h));
        }
        h *= 0.7;
    }
    None
}

/// Holds the polynomials at random states; a law may have no value, or no derivative, at some of them.
fn agrees(model: &dyn Machine) {
    let mut draw = Draw::new(7);
    let points = (0..12).map(|round| {
        let x = state(model, &mut draw);
        (1.0 + draw.number(), x, vec![round % 2 == 0; model.switches()])
    });
    let points: Vec<_> = points.collect();
    agrees_at(model, &points, 1e-6);
}

/// Holds the polynomials at these times, states and branches. Rates are compared as if each had at least the part
/// `floor` of the largest.
fn agrees_at(model: &dyn Machine, points: &[(f64, Vec<f64>, Vec<bool>)], floor: f64) {
    let n = model.states();
    let (mut apart, mut rounds): (f64, usize) = (0.0, 0);
    for (t, x, negative) in points {
        let Some((polynomial, h)) = short(model, *t, x, negative) else { continue };
        rounds += 1;
        let terms = || polynomial.chunks_exact(n).enumerate();
        for theta in [0.4, 0.7, 1.0] {
            let mut rate = vec![0.0; n];
            model.rate(t + theta * h, &sum(&polynomial, n, theta, |_| 1.0), negative, &mut rate);
            let slope = sum(&polynomial, n, theta, |k| k as f64);
            let scale = terms().map(|(k, term)| largest(term) * k as f64).sum::<f64>();
            for k in 0..n {
                let own: f64 = terms().map(|(order, term)| term[k].abs() * order as f64).sum();
                let difference = (slope[k] / theta - h * rate[k]).abs() / (own + floor * scale);
                apart = apart.max(difference);
            }
        }
    }
    println!("{}: {n} states, {rounds} rounds, {apart:.1e}", model.description().name);
    assert!(rounds >= 4, "{rounds} rounds");
    assert!(apart <= DIFFERENCE, "{apart:e}");
}

/// An input that does not change.
fn steady() -> Input {
    Input::constant(0.7)
}

macro_rules! example_agrees {
    ($($test:ident: $module:ident $model:ident ($($rest:tt)*);)*) => {$(
        #[test]
        fn $test() {
            agrees(&*example::examples::$test(&steady()).machine);
        }
    )*};
}

mod examples {
    use super::*;

    each_example!(example_agrees);
}

macro_rules! scene_agrees {
    ($($test:ident: $model:ident ($($rest:tt)*);)*) => {$(
        #[test]
        fn $test() {
            agrees(&*example::scenes::$test().machine);
        }
    )*};
}

mod scenes {
    use super::*;

    each_scene!(scene_agrees);
}

/// Its series are in parts, and depend on switches.
#[test]
fn a_long_model_along_its_motion() {
    let model = example::whip().machine;
    // Joints hold momenta at rest, whose rates are rounding.
    agrees_at(&*model, &along(&*model, 0.5), 1e-3);
}

/// Its series has loops.
#[test]
fn a_model_that_repeats_itself() {
    agrees(&*example::rope().machine);
}

#[test]
fn an_input_that_changes_leaves_no_series() {
    let has_series = |voltage: Input| example::examples::dc_motor(&voltage).machine.series().is_some();
    assert!(has_series(Input::constant(12.0)));
    assert!(!has_series(Input::function(|t| t)));
    assert!(!has_series(Input::with_rate(|t| t, |_| 1.0)));
}

/// Twice the products of two factors that change, in fours, and the places of quotients and functions.
#[test]
fn widths_of_the_hacksaw() {
    let width = |scene: Example| scene.machine.series().expect("there are no inputs").width;
    assert_eq!(width(example::scenes::paper()), 120);
    assert_eq!(width(example::scenes::free_run()), 72);
    assert_eq!(width(example::scenes::literal()), 576);
}
