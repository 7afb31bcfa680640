//! Radau's methods on stiff test problems against reference solutions of many digits.
//!
//! References: shared collection of hard cases, A01 and A02, Radau IIA of orders 13 and 17 in quad precision, 18 and
//! more digits. Problems: Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition, section IV.10.

use crate::problems::*;
use bg_model::integrator::{Absolute, Method, Radau5, Radau9, Tolerances};
use bg_model::simulation::{Samples, Settings};
use bg_model::statistics::Statistics;

/// Van der Pol's oscillator with eps = 1e-6 from (2, 0): instants and states.
const VAN_DER_POL: [(f64, [f64; 2]); 4] = [
    (1.0, [-1.863_646_254_808_133_9, 0.753_543_086_543_543_4]),
    (2.0, [1.706_167_732_170_465, -0.892_809_701_024_816_5]),
    (4.0, [1.194_414_677_695_959, -2.799_585_996_539_364]),
    (11.0, [-1.590_150_544_829_126_8, 1.040_279_389_212_387]),
];

/// Robertson's reaction from (1, 0, 0): instants and states.
const ROBERTSON: [(f64, [f64; 3]); 3] = [
    (40.0, [0.715_827_068_719_405, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_35]),
    (4e5, [0.004_938_274_520_979_816, 1.984_994_087_954_375_5e-8, 0.995_061_705_629_073_1]),
    (1e11, [2.083_340_149_701_294e-8, 8.333_360_770_347_834e-14, 0.999_999_979_166_515_2]),
];

/// The largest relative error at the instants of `reference`, and the counts.
fn errors<M: Method, const N: usize>(
    system: &Flow<Rate<N, 0>, 0>,
    method: M,
    start: [f64; N],
    reference: &[(f64, [f64; N])],
    tolerances: Tolerances,
) -> (f64, Statistics) {
    let samples = Samples::At(reference.iter().map(|(t, _)| *t).collect());
    let t_end = reference[reference.len() - 1].0;
    let (finish, record) = run(system, method, start, t_end, &Settings { tolerances, samples, ..Settings::default() });
    let pairs = record.samples.iter().zip(reference);
    let relative = pairs.flat_map(|(sample, exact)| (0..N).map(move |i| (sample.1[i] / exact.1[i] - 1.0).abs()));
    (relative.fold(0.0, f64::max), finish.statistics)
}

fn van_der_pols_errors<M: Method>(method: M, tolerance: f64) -> (f64, Statistics) {
    let tolerances = Tolerances::new(tolerance, tolerance);
    errors(&van_der_pol(), method, VAN_DER_POL_START, &VAN_DER_POL, tolerances)
}

fn robertson<M: Method>(method: M, tolerance: f64) -> (f64, Statistics) {
    let rate: Rate<3, 0> = |_, x, _| {
        let [first, second, third] = [0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]];
        [second - first, first - second - third, third]
    };
    let absolute = Absolute::PerState([1e-10, 1e-16, 1e-8].map(|of| of * tolerance.min(1e-3)).to_vec());
    errors(&smooth(rate), method, [1.0, 0.0, 0.0], &ROBERTSON, Tolerances { relative: tolerance, absolute })
}

/// That errors over tolerances stay in `expected`.
fn assert_follows(run: impl Fn(f64) -> (f64, Statistics), tolerances: &[f64], expected: std::ops::Range<f64>) {
    let ratios: Vec<f64> = tolerances.iter().map(|tolerance| run(*tolerance).0 / tolerance).collect();
    assert!(ratios.iter().all(|ratio| expected.contains(ratio)), "{ratios:?}");
}

#[test]
fn van_der_pols_error_follows_the_tolerance() {
    let tolerances = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11];
    assert_follows(|tolerance| van_der_pols_errors(Radau5::new(), tolerance), &tolerances, 0.1..2.0);
    assert_follows(|tolerance| van_der_pols_errors(Radau9::new(), tolerance), &tolerances, 0.01..3.0);
}

#[test]
fn robertsons_error_follows_the_tolerance_over_eleven_decades_of_time() {
    let tolerances = [1e-3, 1e-5, 1e-7, 1e-9];
    assert_follows(|tolerance| robertson(Radau5::new(), tolerance), &tolerances, 0.03..2.0);
    assert_follows(|tolerance| robertson(Radau9::new(), tolerance), &tolerances, 0.005..1.0);
}

#[test]
fn counts_of_stiff_problems() {
    let counts = |of: Statistics| [of.steps, of.rejected, of.jacobian_evaluations, of.factorisations];
    // Pinned; to be renewed only with a reason.
    assert_eq!(counts(van_der_pols_errors(Radau5::new(), 1e-6).1), [5550, 63, 2628, 8420]);
    assert_eq!(counts(robertson(Radau5::new(), 1e-6).1), [737, 255, 627, 1850]);
    assert_eq!(counts(van_der_pols_errors(Radau9::new(), 1e-9).1), [4175, 85, 2159, 9666]);
}
