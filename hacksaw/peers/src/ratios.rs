//! The figures to reach: how many times as long the best peer of a kind takes as the best of ours, for an error.

use crate::measure::Series;
use crate::solvers::Source;
use crate::table::fastest;

/// A comparison: with whom, at which error (m or rad), and how many times as long they are to take at least.
struct Goal {
    name: &'static str,
    sources: &'static [Source],
    error: f64,
    factor: f64,
}

const RUST: &[Source] = &[Source::Diffsol, Source::OdeSolvers, Source::DifferentialEquations];

const HEYOKA: &[Source] = &[Source::Heyoka];
const BY_HAND: &[Source] = &[Source::ByHand];

const GOALS: [Goal; 13] = [
    Goal { name: "heyoka", sources: HEYOKA, error: 1e-6, factor: 4.0 },
    Goal { name: "heyoka", sources: HEYOKA, error: 3e-7, factor: 4.0 },
    Goal { name: "heyoka", sources: HEYOKA, error: 1e-8, factor: 3.0 },
    Goal { name: "heyoka", sources: HEYOKA, error: 1e-10, factor: 2.5 },
    Goal { name: "heyoka", sources: HEYOKA, error: 1e-12, factor: 2.5 },
    Goal { name: "by hand", sources: BY_HAND, error: 1e-3, factor: 2.0 },
    Goal { name: "by hand", sources: BY_HAND, error: 1e-6, factor: 2.0 },
    Goal { name: "by hand", sources: BY_HAND, error: 3e-7, factor: 2.0 },
    Goal { name: "by hand", sources: BY_HAND, error: 1e-8, factor: 2.0 },
    Goal { name: "by hand", sources: BY_HAND, error: 1e-10, factor: 2.0 },
    Goal { name: "by hand", sources: BY_HAND, error: 1e-12, factor: 2.0 },
    Goal { name: "the best Rust crate", sources: RUST, error: 1e-6, factor: 4.0 },
    Goal { name: "CVODE", sources: &[Source::Cvode, Source::Casadi], error: 1e-6, factor: 6.0 },
];

/// Ours: with energies and without.
const SCENES: [Source; 2] = [Source::Ours, Source::Motion];

/// The goals as a Markdown table; a solver counts with its fastest point of at most that error.
pub fn table(series: &[Series]) -> String {
    let mut text = "Times of others over the best of ours on the generated scenes, at an error of at most ..:\n\n\
                    | error | ours | ms | other | ms | ratio | to reach |\n|---|---|---|---|---|---|---|\n"
        .to_owned();
    for (goal, scene) in GOALS.iter().flat_map(|goal| SCENES.map(|scene| (goal, scene))) {
        let (ours, theirs) = (best(series, &[scene], goal.error), best(series, goal.sources, goal.error));
        let cells = |best: &Option<(&Series, f64)>, otherwise: &str| match best {
            Some((series, time)) => format!("{} | {time:.1}", series.line.name),
            None => format!("{otherwise} | –"),
        };
        let ratio = match (&ours, &theirs) {
            (Some((_, ours)), Some((_, theirs))) => format!("{:.2}", theirs / ours),
            _ => "–".to_owned(),
        };
        text += &format!(
            "| {:.0e} | {} | {} | {ratio} | {} |\n",
            goal.error,
            cells(&ours, "none"),
            cells(&theirs, goal.name),
            goal.factor
        );
    }
    text
}

/// The fastest of the series of `sources` at an error of at most `error`, and its time, ms.
fn best<'a>(series: &'a [Series], sources: &[Source], error: f64) -> Option<(&'a Series, f64)> {
    let candidates = series.iter().filter(|series| sources.contains(&series.line.source));
    let timed = candidates.filter_map(|series| Some((series, fastest(series, error)?.least())));
    timed.min_by(|a, b| a.1.total_cmp(&b.1))
}
