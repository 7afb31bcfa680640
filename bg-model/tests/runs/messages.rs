//! What a user sees of an error: its sentence, by `Display` and by `Debug`, which is what a `main` that gives it back
//! prints.

use std::error::Error;

use crate::problems::*;
use bg_model::assembly::{Gap, close};
use bg_model::failure::Cause;
use bg_model::integrator::{Dop853, Radau5};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::{bond_graph, parameters::Parameters};

bond_graph! {
    /// A mass on a spring.
    graph Oscillator {
        /// Mass.
        param mass: kg = 1, above 0;
        /// Stiffness.
        param stiffness: N/m = 3;
        1 slide: translation;
        I body = mass;
        C spring = stiffness start 0.1;
        slide -> body;
        slide -> spring;
        observe { x: m = spring.q }
    }
}

/// What `fn main() -> Result<(), Box<dyn Error>>` prints after `Error: `.
fn printed(error: impl Error + 'static) -> String {
    let sentence = error.to_string();
    let printed = format!("{:?}", Box::<dyn Error>::from(error));
    assert_eq!(printed, sentence);
    printed
}

#[test]
fn failed_runs_print_their_sentence() {
    let nan = smooth(|t: f64, _: &SVector<f64, 1>, _: &[bool; 0]| [if t > 0.5 { f64::NAN } else { 1.0 }]);
    let pole = smooth(|_, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * x[0]]);
    let (start, span) = (SVector::from([1.0]), Span { t0: 0.0, t_end: 2.0 });
    let failure = integrate(&nan, &mut Dop853::new(), &start, span, &settings(1e-6), &mut ()).unwrap_err();
    let cause = failure.cause.clone();
    assert!(matches!(cause, Cause::NonFinite { index: 0, .. }));
    assert!(printed(failure).starts_with("the rate of `state` is NaN in a step of"));
    assert!(printed(cause).starts_with("the rate of `state` is NaN"));
    let failure = integrate(&pole, &mut Radau5::new(), &start, span, &settings(1e-6), &mut ()).unwrap_err();
    assert!(printed(failure).starts_with("the step fell to"));
    let settings = Settings { samples: Samples::Every(f64::NAN), ..settings(1e-6) };
    let failure = integrate(&pole, &mut Dop853::new(), &start, span, &settings, &mut ()).unwrap_err();
    let Cause::BadInput(bad) = failure.cause.clone() else { panic!("{failure}") };
    assert!(printed(failure).starts_with("the sample interval is NaN s"));
    assert!(printed(bad).starts_with("the sample interval is NaN s"));
}

#[test]
fn parameters_and_gaps_print_their_sentence() {
    let refused = Oscillator::<f64>::new(OscillatorParameters { mass: -1.0, ..Default::default() })
        .map(drop)
        .expect_err("the mass is refused");
    assert!(printed(refused).starts_with("parameter `mass` = -1 kg is out of range"));
    let unknown = OscillatorParameters::default().set("weight", 1.0).unwrap_err();
    assert_eq!(printed(unknown), "there is no parameter `weight`");
    static GAPS: [Gap; 2] =
        [Gap { joint: "pin", component: "x", unit: "m" }, Gap { joint: "rod", component: "", unit: "rad" }];
    let gaps = |_: &[f64], r: &mut [f64]| r.copy_from_slice(&[1.0 / 3.0, -2e-7 / 3.0]);
    let open = close(&[], &GAPS, &gaps, &|_, terms| terms.fill(1.0)).unwrap_err();
    let text = "the mechanism does not close: joint `pin` by 3.33e-1 m in x (allowed: 1e-10); \
        also open: `rod` by -6.67e-8 rad";
    assert_eq!(printed(open), text);
}
