//! The figures to reach: how many times as long the best peer of a kind takes as the best of ours, for an error.

use crate::measure::Series;
use crate::solvers::Source;
use crate::table::fastest;

/// Comparisons with one kind of peers.
struct Goals {
    name: &'static str,
    sources: &'static [Source],
    /// Errors, m or rad, and how many times as long they are to take at least.
    factors: &'static [(f64, f64)],
}

const RUST: &[Source] = &[Source::Diffsol, Source::OdeSolvers, Source::DifferentialEquations];

const GOALS: [Goals; 4] = [
    Goals {
        name: "heyoka",
        sources: &[Source::Heyoka],
        factors: &[(1e-6, 4.0), (3e-7, 4.0), (1e-8, 3.0), (1e-10, 2.5), (1e-12, 2.5)],
    },
    Goals {
        name: "by hand",
        sources: &[Source::ByHand],
        factors: &[(1e-3, 2.0), (1e-6, 2.0), (3e-7, 2.0), (1e-8, 2.0), (1e-10, 2.0), (1e-12, 2.0)],
    },
    Goals { name: "the best Rust crate", sources: RUST, factors: &[(1e-6, 4.0)] },
    Goals { name: "CVODE", sources: &[Source::Cvode, Source::Casadi], factors: &[(1e-6, 6.0)] },
];

/// Ours: with energies and without.
const SCENES: [Source; 2] = [Source::Ours, Source::Motion];

/// The goals as a Markdown table; a solver counts with its fastest point of at most that error.
pub fn table(series: &[Series]) -> String {
    let mut text = "Times of others over the best of ours on the generated scenes, at an error of at most ..:\n\n\
                    | error | ours | ms | other | ms | ratio | to reach |\n|---|---|---|---|---|---|---|\n"
        .to_owned();
    let all = GOALS.iter().flat_map(|goals| goals.factors.iter().map(move |&(error, factor)| (goals, error, factor)));
    for ((Goals { name, sources, .. }, error, factor), scene) in all.flat_map(|goal| SCENES.map(|scene| (goal, scene)))
    {
        let (ours, theirs) = (best(series, &[scene], error), best(series, sources, error));
        let cells = |best: &Option<(&Series, f64)>, otherwise: &str| match best {
            Some((series, time)) => format!("{} | {time:.1}", series.line.name),
            None => format!("{otherwise} | –"),
        };
        let ratio = match (&ours, &theirs) {
            (Some((_, ours)), Some((_, theirs))) => format!("{:.2}", theirs / ours),
            _ => "–".to_owned(),
        };
        text +=
            &format!("| {error:.0e} | {} | {} | {ratio} | {factor} |\n", cells(&ours, "none"), cells(&theirs, name),);
    }
    text
}

/// The fastest of the series of `sources` at an error of at most `error`, and its time, ms.
fn best<'a>(series: &'a [Series], sources: &[Source], error: f64) -> Option<(&'a Series, f64)> {
    let candidates = series.iter().filter(|series| sources.contains(&series.line.source));
    let timed = candidates.filter_map(|series| Some((series, fastest(series, error)?.least())));
    timed.min_by(|a, b| a.1.total_cmp(&b.1))
}
