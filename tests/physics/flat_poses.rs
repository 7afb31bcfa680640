//! The double four-bar through its ten flat poses, by methods, tolerances and largest steps: does every run end well?
//!
//! In each flat pose two loops could go another way, the reactions of the joints grow without bound, and where a step
//! ends beside it is a matter of tolerances. So one run says little: these are 96 of each form.

use bg_model::dynamics::Typed;
use bg_model::integrator::{Bs5, Cfmr7, Dop853, Method, Tolerances};
use bg_model::simulation::{Part, Recorder, Samples, Settings, Span, integrate};
use bg_model::system::Model;
use bond_graph_tests::models::mechanisms::{
    DoubleFourBar, DoubleFourBarParameters, FourBarsBySpeeds, FourBarsBySpeedsParameters,
};

/// How far the energy may depart, in parts of it: a run that leaves its branch departs by more than 1. At 1e-4 runs err
/// by 0.04.
const DEPARTURE: f64 = 0.1;

/// A run of 10 s; gives the largest relative departure of the energy.
fn departure<Mo, M, const N: usize, const G: usize, const P: usize>(
    model: &Mo,
    mut method: M,
    tolerances: Tolerances,
    largest_step: f64,
) -> Result<f64, String>
where
    Mo: Model<f64, N, G, P>,
    M: Method,
{
    let start = model.start().expect("the mechanism closes");
    let machine = Typed::model(model);
    let mut recorder = Recorder::new(&machine, &[Part::Outputs]);
    let settings = Settings { tolerances, largest_step, samples: Samples::Every(0.05), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 10.0 };
    integrate(model, &mut method, &start, span, &settings, &mut recorder).map_err(|failure| failure.to_string())?;
    let recording = &recorder.recording;
    let parts = super::mechanisms::PARTS.map(|part| recording.column(&format!("{part}.energy")).expect("an energy"));
    let energy = |k: usize| parts.iter().map(|part| part[k]).sum::<f64>();
    let departures = (0..recording.times.len()).map(|k| (energy(k) / energy(0) - 1.0).abs());
    Ok(departures.fold(0.0, f64::max))
}

/// How many of the runs do not end well, each told; and how many there are.
fn trials<Mo, const N: usize, const G: usize, const P: usize>(name: &str, model: &Mo) -> (usize, usize)
where
    Mo: Model<f64, N, G, P>,
{
    // A debug build makes every third.
    let pace = if cfg!(debug_assertions) { 3 } else { 1 };
    let (mut bad, mut count) = (0, 0);
    for (exponent, part) in (4..=11).flat_map(|exponent| [(exponent, 0.1), (exponent, 1e-3)]).step_by(pace) {
        let relative = 10.0_f64.powi(-exponent);
        for largest in [f64::INFINITY, 0.025] {
            let tolerances = || Tolerances::new(relative, part * relative);
            let runs = [
                ("DOP853", departure(model, Dop853::new(), tolerances(), largest)),
                ("BS5", departure(model, Bs5::new(), tolerances(), largest)),
                ("CFMR7osc", departure(model, Cfmr7::new(), tolerances(), largest)),
            ];
            for (method, run) in runs {
                count += 1;
                if !matches!(run, Ok(departure) if departure < DEPARTURE) {
                    bad += 1;
                    println!(
                        "{name} by {method}, rtol {relative:e}, atol {part:e} of it, steps to {largest} s: {run:?}"
                    );
                }
            }
        }
    }
    println!("{name}: {} of {count} runs end well", count - bad);
    (bad, count)
}

#[test]
fn every_run_passes_the_flat_poses() {
    let all = DoubleFourBar::new(DoubleFourBarParameters::default()).unwrap();
    let closing = FourBarsBySpeeds::new(FourBarsBySpeedsParameters::default()).unwrap();
    let runs = [trials("all reactions", &all), trials("independent speeds", &closing)];
    let expected = if cfg!(debug_assertions) { 36 } else { 96 };
    assert_eq!(runs, [(0, expected); 2]);
}
