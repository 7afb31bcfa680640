//! Many runs: ours in lanes and heyoka's in batches, in turns.
//!
//! In: how many runs of 5 s, which differ in torque, cutting resistance and two stiffnesses. Out: a table of time a run
//! by the wall clock, the least of the rounds, with the largest error of a pose at the end, m or rad, and the ratio at
//! an error of at most 1e-6.

use std::path::Path;
use std::time::Instant;

use bg_model::integrator::Integrator;
use bg_model::parameters::Parameters;
use bg_model::run::{Request, Simulation, Trajectory, in_lanes};
use bg_model::simulation::Samples;
use hacksaw::columns::LINKS;
use hacksaw::mechanism::{Motion, MotionParameters};

use crate::poses::{Pose, Poses, largest_difference};
use crate::problem::{Problem, T_END};
use crate::solvers::python::Batches;

/// The parameters that differ, in the order that the Python script has, with their ends.
const VARIED: [(&str, [f64; 2]); 4] =
    [("torque", [8.0, 14.0]), ("r_cut", [60.0, 140.0]), ("k_34", [5e7, 1.5e8]), ("k_23", [5e6, 1.5e7])];
/// Powers of the inverse of the root of x^5 = x + 1: their multiples fill four dimensions evenly (M. Roberts, 2018).
const STEPS: [f64; 4] =
    [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_052_797_6, 0.538_597_258_372_573_7];
/// Runs that are compared with exact ones.
const EXACT: usize = 16;
/// heyoka's batches are full with this many runs, whatever the machine.
const FULL: usize = 8;
/// The error at which the two are compared, m or rad.
const ERROR: f64 = 1e-6;

/// Which of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Solver {
    /// Ours, by this method.
    Lanes(Integrator),
    Heyoka,
}

/// What was measured of one of the two at one tolerance.
struct Row {
    solver: Solver,
    tolerance: f64,
    milliseconds: f64,
    error: f64,
}

/// The table.
///
/// # Errors
/// There is no heyoka, or a run fails.
pub fn compared(python: &Path, problem: &Problem, runs: usize, rounds: usize) -> Result<String, String> {
    let mut heyoka = Batches::new(python, problem)?;
    let model = Motion::new(MotionParameters::default()).map_err(|fault| fault.to_string())?;
    let values: Vec<[f64; 4]> = (0..runs.next_multiple_of(FULL)).map(values).collect();
    let exact: Poses = values.iter().take(EXACT).map(exactly).collect::<Result<_, _>>()?;
    let row = |solver| move |tolerance| Row { solver, tolerance, milliseconds: f64::INFINITY, error: f64::NAN };
    let mut rows: Vec<Row> = [1e-3, 1e-4, 2e-5, 1e-5].map(row(Solver::Lanes(Integrator::Nystrom))).into();
    rows.extend([1e-4, 1e-5, 5e-6, 1e-6].map(row(Solver::Lanes(Integrator::Cfmr7))));
    rows.extend([1e-4, 1e-5, 1e-6, 1e-7, 1e-8].map(row(Solver::Heyoka)));
    for round in 1..=rounds {
        eprintln!("round {round} of {rounds}");
        for row in &mut rows {
            let (seconds, poses) = match row.solver {
                Solver::Lanes(method) => in_our_lanes(&model, &request(method, row.tolerance), &values)?,
                Solver::Heyoka => heyoka.run(row.tolerance, &values)?,
            };
            row.milliseconds = row.milliseconds.min(seconds * 1e3 / values.len() as f64);
            row.error = largest_difference(&poses[..exact.len()], &exact);
        }
    }
    let version = heyoka.versions.get("heyoka").map_or("", String::as_str);
    Ok(text(&rows, values.len(), version))
}

/// The parameters of a run, in the order of [`VARIED`].
fn values(run: usize) -> [f64; 4] {
    std::array::from_fn(|place| {
        let (part, [from, to]) = ((STEPS[place] * (run + 1) as f64).fract(), VARIED[place].1);
        from + part * (to - from)
    })
}

/// All parameters of a run.
fn parameters(values: &[f64; 4]) -> MotionParameters {
    let mut parameters = MotionParameters::default();
    for (index, info) in MotionParameters::table().iter().enumerate() {
        if let Some(place) = VARIED.iter().position(|(name, _)| *name == info.name) {
            parameters.set_value(index, values[place]);
        }
    }
    parameters
}

fn request(method: Integrator, rtol: f64) -> Request {
    Request { method, t_end: T_END, rtol, samples: Samples::Every(T_END), ..Request::default() }
}

/// The end of a run by DOP853 at 1e-12.
fn exactly(values: &[f64; 4]) -> Result<Pose, String> {
    let model = Motion::new(parameters(values)).map_err(|fault| fault.to_string())?;
    let run = Simulation::of(&model, request(Integrator::Dop853, 1e-12)).run().map_err(|fault| fault.to_string())?;
    end(&run)
}

/// Our runs with the time that they take, s.
fn in_our_lanes(model: &Motion, request: &Request, values: &[[f64; 4]]) -> Result<(f64, Poses), String> {
    let all: Vec<Vec<f64>> = values.iter().map(|values| parameters(values).values()).collect();
    let clock = Instant::now();
    let runs = in_lanes(model, request, &all);
    let seconds = clock.elapsed().as_secs_f64();
    let poses = runs.into_iter().map(|run| end(&run.map_err(|fault| fault.to_string())?)).collect::<Result<_, _>>()?;
    Ok((seconds, poses))
}

/// The poses at the end of a run.
fn end(run: &Trajectory) -> Result<Pose, String> {
    let last = |name: String| -> Result<f64, String> {
        let values = run.recording.values(&name).map_err(|fault| fault.to_string())?;
        values.last().copied().ok_or_else(|| "a run has no samples".to_owned())
    };
    let mut pose = [0.0; 12];
    for (link, pose) in LINKS.into_iter().zip(pose.chunks_exact_mut(3)) {
        pose[0] = last(format!("C{link}_x"))?;
        pose[1] = last(format!("C{link}_y"))?;
        pose[2] = last(format!("R{link}_21"))?.atan2(last(format!("R{link}_11"))?);
    }
    Ok(pose)
}

fn text(rows: &[Row], runs: usize, version: &str) -> String {
    let mut text = format!(
        "{runs} runs of 5 s, ms a run on one core, and the largest error of a pose at their ends, m or rad:\n\n"
    );
    text += "| solver | tolerance | ms | error |\n|---|---|---|---|\n";
    for Row { solver, tolerance, milliseconds, error } in rows {
        let name = match solver {
            Solver::Lanes(method) => format!("this project, `{method}` in lanes"),
            Solver::Heyoka => format!("heyoka {version} in batches, `fast_math`"),
        };
        text += &format!("| {name} | {tolerance:.0e} | {milliseconds:.2} | {error:.1e} |\n");
    }
    let best = |is_ours: bool| {
        let good = rows.iter().filter(|row| (row.solver != Solver::Heyoka) == is_ours && row.error <= ERROR);
        good.map(|row| row.milliseconds).min_by(f64::total_cmp)
    };
    if let (Some(ours), Some(theirs)) = (best(true), best(false)) {
        text += &format!("\nAt an error of at most {ERROR:.0e}: ours over heyoka's {:.2}.\n", ours / theirs);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_parameters_differ_within_their_ends() {
        let (own, default) = (parameters(&values(3)), MotionParameters::default());
        let changed: Vec<&str> = (0..MotionParameters::table().len())
            .filter(|&index| own.value(index) != default.value(index))
            .map(|index| MotionParameters::table()[index].name)
            .collect();
        assert_eq!(changed.len(), VARIED.len(), "{changed:?}");
        assert!((0..1000).flat_map(|run| values(run).into_iter().zip(VARIED)).all(|(x, (_, [a, b]))| a <= x && x < b));
    }
}
