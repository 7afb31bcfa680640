//! What derivatives of the hacksaw cost, and how exact they are: prints two tables.
//!
//! `cargo run --release -p hacksaw --example sensitivities [-- SECONDS]`: a run of the scene `motion` with derivatives
//! by eight parameters over the run alone, minima of several; then the derivatives at the end by three parameters
//! against five-point differences of runs in double-double arithmetic over the SECONDS (0.3 unless given; 5 takes two
//! minutes of one core).

use std::time::{Duration, Instant};

use bg_model::extended::Accuracy;
use bg_model::integrator::Integrator;
use bg_model::parameters::ParameterError;
use bg_model::run::{Request, Simulation};
use bg_model::sensitivity::{Direction, differences, sensitivities};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters};

const RUNS: usize = 5;
const EIGHT: [&str; 8] = ["k_34", "r_34", "r_cut", "torque", "k_2", "r_2", "density", "crank_angle"];
const THREE: [&str; 3] = ["k_34", "r_cut", "torque"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let end: f64 = std::env::args().nth(1).map_or(Ok(0.3), |argument| argument.parse())?;
    let model = Motion::new(MotionParameters::default())?;
    println!("{:8} {:>6} {:>10} {:>10} {:>6}", "method", "rtol", "run, ms", "with, ms", "ratio");
    for (method, rtol) in [(Integrator::Dop853, 1e-6), (Integrator::Dop853, 1e-8), (Integrator::Auto, 1e-8)] {
        let request = Request { method, t_end: 5.0, rtol, samples: Samples::Every(5.0), ..Request::default() };
        let plain = least(|| Simulation::of(&model, request.clone()).run().map(drop))?;
        for count in [1, 3, 4, 8] {
            let directions = directions(&EIGHT[..count])?;
            let with = least(|| sensitivities(&model, &request, &directions).map(drop))?;
            let ratio = with.as_secs_f64() / plain.as_secs_f64();
            let [plain, with] = [plain, with].map(|time| time.as_secs_f64() * 1e3);
            println!("{:8} {rtol:>6e} {plain:>10.2} {with:>10.2} {ratio:>6.2} {count} parameters", method.name());
        }
    }
    let request = Request {
        method: Integrator::Dop853,
        t_end: end,
        rtol: 1e-13,
        atol: Some(1e-14),
        samples: Samples::At(vec![end]),
        ..Request::default()
    };
    let directions = directions(&THREE)?;
    let found = sensitivities(&model, &request, &directions)?;
    println!(
        "\n{} events in {end} s; derivatives of the poses at its end, largest relative to their size",
        found.trajectory.statistics.events
    );
    for (k, name) in THREE.iter().enumerate() {
        let Direction::Parameter(parameter) = directions[k] else { unreachable!("parameters were asked for") };
        let expected = differences(&model, parameter, end, 1e-5, Accuracy { columns: 10, tolerance: 1e-20 })?;
        let size = expected.iter().fold(0.0_f64, |size, slope| size.max(slope.abs()));
        let error = |(output, slope): (usize, &f64)| (found.of(k, output)[0] - slope).abs() / size;
        println!("{name:10} size {size:.3e} error {:.1e}", expected.iter().enumerate().map(error).fold(0.0, f64::max));
    }
    Ok(())
}

fn directions(names: &[&str]) -> Result<Vec<Direction>, ParameterError> {
    names.iter().map(|name| Direction::parameter::<Motion>(name)).collect()
}

/// The least time of several runs.
fn least<E>(mut run: impl FnMut() -> Result<(), E>) -> Result<Duration, E> {
    let mut least = Duration::MAX;
    for _ in 0..RUNS {
        let begin = Instant::now();
        run()?;
        least = least.min(begin.elapsed());
    }
    Ok(least)
}
