//! What it gains to make runs of the hacksaw side by side: prints a table.
//!
//! `cargo run --release -p hacksaw --example lanes [-- RUNS]`: RUNS (1000 unless given) runs of the scene `motion` over 5 s by
//! `nystrom`, in which torque, cutting resistance and two stiffnesses differ, in lanes and each by itself; CPU time of a run, the
//! least of several pieces, and the largest error of a pose at the end against DOP853 at 1e-12. Then two threads over one.

use std::time::Instant;

use bg_model::integrator::Integrator;
use bg_model::parameters::Parameters;
use bg_model::run::{LaneError, Request, Simulation, Trajectory, in_lanes};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters};

const T_END: f64 = 5.0;
/// Runs that are handed over at once.
const PIECE: usize = 200;
/// Runs by themselves, and those that are compared with exact ones.
const ALONE: usize = 24;
const EXACT: usize = 8;
/// The parameters that differ, with their ends.
const SWEPT: [(&str, [f64; 2]); 4] =
    [("torque", [8.0, 14.0]), ("r_cut", [60.0, 140.0]), ("k_34", [5e7, 1.5e8]), ("k_23", [5e6, 1.5e7])];

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let runs: usize = std::env::args().nth(1).map_or(Ok(1000), |argument| argument.parse())?;
    let model = Motion::new(MotionParameters::default())?;
    let values: Vec<Vec<f64>> = (0..runs).map(values).collect();
    let exact: Vec<Trajectory> = values
        .iter()
        .take(EXACT)
        .map(|values| alone(&Request { method: Integrator::Dop853, ..request(1e-12) }, values))
        .collect::<Outcome<_>>()?;
    println!("{:>6} {:>14} {:>14} {:>6} {:>10}", "rtol", "in lanes, ms", "singly, ms", "ratio", "error");
    for rtol in [1e-3, 3e-4, 1e-4, 1e-5] {
        let request = request(rtol);
        let (mut together, mut error) = (f64::INFINITY, 0.0_f64);
        for (piece, values) in values.chunks(PIECE).enumerate() {
            let (made, time) = timed(|| in_lanes(&model, &request, values));
            let made = made.into_iter().collect::<Result<Vec<Trajectory>, LaneError>>()?;
            if values.len() == PIECE || runs < PIECE {
                together = together.min(time / values.len() as f64);
            }
            let compared = made.iter().zip(if piece == 0 { &exact[..] } else { &[] });
            error = compared.map(|(run, exact)| distance(run, exact)).fold(error, f64::max);
        }
        let mut singly = f64::INFINITY;
        for values in values.chunks(ALONE / 3).take(3) {
            let (made, time) =
                timed(|| values.iter().map(|values| alone(&request, values)).collect::<Outcome<Vec<_>>>());
            singly = singly.min(time / made?.len() as f64);
        }
        let ratio = singly / together;
        println!("{rtol:>6e} {:>14.3} {:>14.3} {ratio:>6.2} {error:>10.1e}", together * 1e3, singly * 1e3);
    }
    let (request, half) = (request(1e-3), values.len() / 2);
    let wall = |parts: &[&[Vec<f64>]]| {
        let begin = Instant::now();
        std::thread::scope(|scope| {
            for part in parts {
                scope
                    .spawn(|| part.chunks(PIECE).map(|values| in_lanes(&model, &request, values).len()).sum::<usize>());
            }
        });
        begin.elapsed().as_secs_f64()
    };
    let ratio = wall(&[&values]) / wall(&[&values[..half], &values[half..]]);
    println!("two threads over one, by the wall clock: {ratio:.2}");
    Ok(())
}

fn request(rtol: f64) -> Request {
    let samples = Samples::Every(T_END);
    Request { method: Integrator::Nystrom, t_end: T_END, rtol, samples, ..Request::default() }
}

/// The parameters of a run: points that lie evenly, by multiples of the golden ratio's kin for four dimensions.
fn values(run: usize) -> Vec<f64> {
    const STEPS: [f64; 4] =
        [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_052_797_6, 0.538_597_258_372_573_7];
    let own = MotionParameters::default();
    let table = MotionParameters::table();
    let value = |(index, info): (usize, &bg_model::description::ParameterInfo)| {
        let place = SWEPT.iter().position(|(name, _)| *name == info.name);
        place.map_or(own.value(index), |place| {
            let (part, [from, to]) = ((STEPS[place] * (run + 1) as f64).fract(), SWEPT[place].1);
            from + part * (to - from)
        })
    };
    table.iter().enumerate().map(value).collect()
}

fn alone(request: &Request, values: &[f64]) -> Outcome<Trajectory> {
    let mut parameters = MotionParameters::default();
    values.iter().enumerate().for_each(|(index, &value)| parameters.set_value(index, value));
    Ok(Simulation::of(&Motion::new(parameters)?, request.clone()).run()?)
}

/// The largest difference of an output at the end.
fn distance(a: &Trajectory, b: &Trajectory) -> f64 {
    let last = |run: &Trajectory| run.columns.iter().map(|column| column.values.last().copied()).collect::<Vec<_>>();
    let differences =
        last(a).into_iter().zip(last(b)).map(|(a, b)| (a.unwrap_or(f64::NAN) - b.unwrap_or(f64::NAN)).abs());
    differences.fold(0.0, |most, difference| if difference <= most { most } else { difference })
}

/// What `of` gives, with the CPU time of this thread that it takes, s; by the wall clock where the system does not say.
fn timed<T>(of: impl FnOnce() -> T) -> (T, f64) {
    let (begin, wall) = (cpu(), Instant::now());
    let made = of();
    let time = cpu().zip(begin).map_or_else(|| wall.elapsed().as_secs_f64(), |(end, begin)| end - begin);
    (made, time)
}

/// The CPU time of this thread, s, as Linux says it.
fn cpu() -> Option<f64> {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(said.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}
