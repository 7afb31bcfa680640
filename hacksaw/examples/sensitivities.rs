//! What derivatives of the hacksaw cost, and how exact they are: prints two tables.
//!
//! `cargo run --release -p hacksaw --example sensitivities [-- SECONDS]`: a run of the scene `motion` with derivatives by eight
//! parameters over the run alone, minima of several; then the derivatives at the end by three parameters against five-point
//! differences of runs in double-double arithmetic over the SECONDS (0.3 unless given; 5 takes an hour).

use std::time::{Duration, Instant};

use bg_model::extended::{self, Accuracy};
use bg_model::integrator::Integrator;
use bg_model::mechanism::{LiftedVisitor, Mechanism};
use bg_model::nalgebra::SVector;
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::run::{Request, Simulation};
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::sensitivity::{Direction, sensitivities};
use bg_model::simulation::{Samples, Span};
use bg_model::system::Model;
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
        let values = (0..MotionParameters::table().len()).map(|index| model.parameters().value(index)).collect();
        let expected = model.visit_lifted(Differences { values, parameter, t: end });
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

/// Five-point differences by one parameter at `t` (s), in double-double numbers.
struct Differences {
    values: Vec<f64>,
    parameter: usize,
    t: f64,
}

impl LiftedVisitor<DoubleDouble> for Differences {
    type Output = Vec<f64>;

    fn visit<Mo, Li, const N: usize, const G: usize, const M: usize>(
        self,
        _: &Mo,
        lifted: impl Fn(&[DoubleDouble]) -> Result<Li, ParameterError>,
    ) -> Vec<f64>
    where
        Mo: Model<f64, N, G, M>,
        Li: Model<DoubleDouble, N, G, M>,
    {
        let number = DoubleDouble::from_f64;
        let h = 1e-5 * self.values[self.parameter].abs().max(1e-2);
        let at = |by: f64| {
            let mut values: Vec<DoubleDouble> = self.values.iter().map(|&value| number(value)).collect();
            values[self.parameter] = values[self.parameter] + number(by) * number(h);
            let model = lifted(&values).expect("in range");
            let accuracy = Accuracy { columns: 10, tolerance: 1e-20 };
            let span = Span { t0: 0.0, t_end: self.t };
            let start = model.start().expect("it closes");
            let finish = extended::integrate(&model, &start, span, accuracy, &[], |_, _, _| {}).expect("a run");
            let mut outputs = SVector::repeat(number(0.0));
            model.outputs(number(self.t), &finish.x, &finish.negative, &mut outputs);
            outputs
        };
        let [far_back, back, ahead, far] = [-2.0, -1.0, 1.0, 2.0].map(at);
        let slope = |i: usize| ((ahead[i] - back[i]) * number(8.0) - (far[i] - far_back[i])) / number(12.0 * h);
        (0..M).map(|i| slope(i).to_f64()).collect()
    }
}
