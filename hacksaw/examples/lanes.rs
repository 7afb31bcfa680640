//! What it gains to make runs of the hacksaw side by side: prints a table.
//!
//! `cargo run --release -p hacksaw --example lanes [-- RUNS]`: RUNS (1000 unless given) runs over 5 s of the scene
//! `motion`, in which torque, cutting resistance and two stiffnesses differ, and of `rigid`, in which torque, start and
//! both resistances do, in lanes and each by itself; CPU time of a run, the least of several pieces, and the largest
//! error of a pose at the end against DOP853 at 1e-13. Then two threads over one.

use std::time::Instant;

use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::parameters::Parameters;
use bg_model::run::{LaneError, Request, Simulation, Trajectory, in_lanes};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters, Rigid, RigidParameters};

const T_END: f64 = 5.0;
/// Runs that are handed over at once.
const PIECE: usize = 200;
/// Runs by themselves, and those that are compared with exact ones.
const ALONE: usize = 24;
const EXACT: usize = 16;
/// A parameter that differs, with its ends.
type Swept = (&'static str, [f64; 2]);
const IN_MOTION: [Swept; 4] =
    [("torque", [8.0, 14.0]), ("r_cut", [60.0, 140.0]), ("k_34", [5e7, 1.5e8]), ("k_23", [5e6, 1.5e7])];
const IN_RIGID: [Swept; 4] =
    [("torque", [8.0, 14.0]), ("r_cut", [60.0, 140.0]), ("crank_angle", [-0.5, 0.5]), ("r_return", [5.0, 15.0])];

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let runs: usize = std::env::args().nth(1).map_or(Ok(1000), |argument| argument.parse())?;
    println!("scene method rtol: in lanes, ms; singly, ms; ratio; error");
    let motion = Motion::new(MotionParameters::default())?;
    let values: Vec<Vec<f64>> = (0..runs).map(|run| values::<Motion>(run, &IN_MOTION)).collect();
    compare(&motion, &values, Integrator::Nystrom, &[1e-3, 1e-4, 2e-5, 1e-5])?;
    compare(&motion, &values, Integrator::Cfmr7, &[1e-4, 1e-5, 5e-6])?;
    let (request, half) = (request(Integrator::Nystrom, 1e-3), values.len() / 2);
    let wall = |parts: &[&[Vec<f64>]]| {
        let begin = Instant::now();
        std::thread::scope(|scope| {
            for part in parts {
                scope.spawn(|| {
                    part.chunks(PIECE).map(|values| in_lanes(&motion, &request, values).len()).sum::<usize>()
                });
            }
        });
        begin.elapsed().as_secs_f64()
    };
    let least = |parts: &[&[Vec<f64>]]| (0..3).map(|_| wall(parts)).fold(f64::INFINITY, f64::min);
    let ratio = least(&[&values]) / least(&[&values[..half], &values[half..]]);
    println!("two threads over one, by the wall clock: {ratio:.2}");
    let rigid = Rigid::new(RigidParameters::default())?;
    let values: Vec<Vec<f64>> = (0..runs).map(|run| self::values::<Rigid>(run, &IN_RIGID)).collect();
    compare(&rigid, &values, Integrator::Dop853, &[1e-5, 1e-6, 1e-7])
}

/// Prints what runs with these values take in lanes and singly.
fn compare<Me: Mechanism>(model: &Me, values: &[Vec<f64>], method: Integrator, tolerances: &[f64]) -> Outcome<()> {
    let exact = values.iter().take(EXACT).map(|values| alone(model, &request(Integrator::Dop853, 1e-13), values));
    let exact: Vec<Trajectory> = exact.collect::<Outcome<_>>()?;
    for &rtol in tolerances {
        let request = request(method, rtol);
        let (mut together, mut error) = (f64::INFINITY, 0.0_f64);
        for (piece, some) in values.chunks(PIECE).enumerate() {
            let (made, time) = timed(|| in_lanes(model, &request, some));
            let made = made.into_iter().collect::<Result<Vec<Trajectory>, LaneError>>()?;
            if some.len() == PIECE || values.len() < PIECE {
                together = together.min(time / some.len() as f64);
            }
            let compared = made.iter().zip(if piece == 0 { &exact[..] } else { &[] });
            error = compared.map(|(run, exact)| distance(run, exact)).fold(error, f64::max);
        }
        let mut singly = f64::INFINITY;
        for values in values.chunks(ALONE / 3).take(3) {
            let (made, time) =
                timed(|| values.iter().map(|values| alone(model, &request, values)).collect::<Outcome<Vec<_>>>());
            singly = singly.min(time / made?.len() as f64);
        }
        let (ratio, scene) = (singly / together, Me::describe().name);
        println!("{scene} {method} {rtol:e}: {:.3} {:.3} {ratio:.2} {error:.1e}", together * 1e3, singly * 1e3);
    }
    Ok(())
}

fn request(method: Integrator, rtol: f64) -> Request {
    Request { method, t_end: T_END, rtol, samples: Samples::Every(T_END), ..Request::default() }
}

/// The parameters of a run: points that lie evenly, by multiples of the golden ratio's kin for four dimensions.
fn values<Me: Mechanism>(run: usize, swept: &[Swept; 4]) -> Vec<f64> {
    const STEPS: [f64; 4] =
        [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_052_797_6, 0.538_597_258_372_573_7];
    let mut all = Me::Parameters::default();
    for ((name, [from, to]), step) in swept.iter().zip(STEPS) {
        let part = (step * (run + 1) as f64).fract();
        if let Some(index) = Me::Parameters::table().iter().position(|info| info.name == *name) {
            all.set_value(index, from + part * (to - from));
        }
    }
    all.values()
}

fn alone<Me: Mechanism>(model: &Me, request: &Request, values: &[f64]) -> Outcome<Trajectory> {
    let mut parameters = model.parameters().clone();
    values.iter().enumerate().for_each(|(index, &value)| parameters.set_value(index, value));
    Ok(Simulation::of(&Me::make(parameters, &[])?, request.clone()).run()?)
}

/// The largest difference at the end of an output that is no force: m, rad or a direction's cosine.
fn distance(a: &Trajectory, b: &Trajectory) -> f64 {
    let is_pose = |name: &str| name.starts_with('C') || name.starts_with('R') || name.ends_with("angle");
    let last = |run: &Trajectory| {
        let poses = run.columns.iter().filter(|column| is_pose(&column.name));
        poses.map(|column| column.values.last().copied()).collect::<Vec<_>>()
    };
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
