//! What a gradient of the hacksaw costs: prints a table.
//!
//! `cargo run --release -p hacksaw --example gradients [-- RUNS]`: the derivatives of the last place of the frame over
//! 5 s of the scene `motion` by 1, 8 and all parameters, by slopes that follow the run and by the run followed
//! backwards, over the run alone: minima of RUNS (7 unless given), and how far both are apart. With a name after it,
//! only that is made, once, for a profiler: `run`, `forward` or `adjoint`.

use std::hint::black_box;
use std::time::{Duration, Instant};

use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{Request, Simulation};
use bg_model::sensitivity::{Direction, Objective, gradient, sensitivities};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters};

const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let runs = arguments.next().map_or(Ok(RUNS), |argument| argument.parse())?;
    let model = Motion::new(MotionParameters::default())?;
    let samples = Samples::At(vec![5.0]);
    let request = Request { method: Integrator::Dop853, t_end: 5.0, rtol: 1e-8, samples, ..Request::default() };
    let output = Motion::describe().outputs.iter().position(|output| output.name == "frame.x").unwrap_or_default();
    let objective = Objective::last(output);
    let all = Direction::parameters::<Motion>();
    let run = || Simulation::of(&model, request.clone()).run();
    if let Some(what) = arguments.next() {
        match what.as_str() {
            "run" => drop(black_box(run()?)),
            "forward" => drop(black_box(sensitivities(&model, &request, &all)?)),
            _ => drop(black_box(gradient(&model, &request, &objective, &all)?)),
        }
        return Ok(());
    }
    let plain = least(runs, || run().map(drop))?;
    println!("run {:.2} ms, {} events", plain.as_secs_f64() * 1e3, run()?.statistics.events);
    println!(
        "{:>10} {:>12} {:>6} {:>12} {:>6} {:>10}",
        "parameters", "forward, ms", "ratio", "adjoint, ms", "ratio", "apart"
    );
    for count in [1, 8, all.len()] {
        let by = &all[..count];
        let forward = least(runs, || sensitivities(&model, &request, by).map(drop))?;
        let adjoint = least(runs, || gradient(&model, &request, &objective, by).map(drop))?;
        let (slopes, found) = (sensitivities(&model, &request, by)?, gradient(&model, &request, &objective, by)?);
        let expected = (0..count).map(|k| slopes.of(k, output)[0]);
        let size = expected.clone().fold(0.0_f64, |size, slope| size.max(slope.abs()));
        let apart =
            found.by.iter().zip(expected).fold(0.0_f64, |most, (by, slope)| most.max((by - slope).abs())) / size;
        let [plain, forward, adjoint] = [plain, forward, adjoint].map(|time| time.as_secs_f64() * 1e3);
        println!(
            "{count:>10} {forward:>12.2} {:>6.2} {adjoint:>12.2} {:>6.2} {apart:>10.1e}",
            forward / plain,
            adjoint / plain
        );
    }
    Ok(())
}

/// The least time of several runs.
fn least<E>(runs: usize, mut run: impl FnMut() -> Result<(), E>) -> Result<Duration, E> {
    let mut least = Duration::MAX;
    for _ in 0..runs {
        let begin = Instant::now();
        run()?;
        least = least.min(begin.elapsed());
    }
    Ok(least)
}
