//! What the tests of the reductions share: a scene's equations beside the literal ones, both integrated by the
//! interpreter; and networks drawn at random.

use std::fmt::Write;

use super::{Fate, Report, for_scene, reaction};
use crate::expr::{Environment, Id, Symbol, evaluate};
use crate::fault::Faults;
use crate::random::Random;
use crate::source::scene::{Variant, variants};
use crate::source::syntax;
use crate::system::equations::StateEquations;
use crate::system::equations::stage::Solved;
use crate::system::reduce::expectation::wanted;
use crate::{pipeline, program};

mod dependent;
mod dyads;
mod networks;
mod speeds;

/// A scene's equations after the reductions beside those of its own literal graph.
pub(super) struct Scene {
    /// Without reductions; rigid joints solved.
    pub literal: StateEquations,
    /// Which of its parameters the scene tunes.
    pub tuned: Vec<bool>,
    /// With reductions.
    pub reduced: StateEquations,
    /// What went and why.
    pub report: Report,
}

/// The reduction of the only scene of the only graph: `statements` with `scene Reduced { clauses }`.
pub(super) fn scene(statements: &str, clauses: &str) -> Scene {
    attempt(statements, clauses)
        .unwrap_or_else(|faults| panic!("{}\n{statements}", faults.iter().map(ToString::to_string).collect::<String>()))
}

/// The same, with its faults.
pub(super) fn attempt(statements: &str, clauses: &str) -> Result<Scene, Faults> {
    let text = format!("graph G {{\n{statements}\nscene Reduced {{ {clauses} }}\n}}");
    let source = syntax::parse(text.parse().unwrap_or_else(|error| panic!("{error}\n{text}")))?;
    let variant = variants(&source.graphs[0])?.remove(1);
    let Variant { scene: Some(scene), .. } = &variant else { panic!("the second variant is the scene") };
    let derived = pipeline::derive(&variant.graph)?.equations;
    let wanted = wanted(scene, &derived)?;
    let mut literal = derived.clone();
    reaction::solve(&mut literal);
    literal.close();
    let (Solved(mut reduced), report) = for_scene(derived, &wanted, true, &mut program::rate_operations);
    reduced.close();
    Ok(Scene { literal, tuned: wanted.tuned, reduced, report })
}

impl Scene {
    /// What became of the state of this name.
    pub fn fate(&self, name: &str) -> &Fate {
        let found = self.report.fates.iter().find(|(state, _)| state.name == name);
        &found.unwrap_or_else(|| panic!("no state {name}: {}", self.report)).1
    }

    /// What states of these names are, in the words of [`word`].
    pub fn words(&self, names: &[&str]) -> Vec<String> {
        names.iter().map(|name| word(self.fate(name))).collect()
    }

    /// The names of the states that are left.
    pub fn left(&self) -> Vec<&str> {
        self.reduced.states.iter().map(|state| state.name.as_str()).collect()
    }

    /// Integrates both models with values of the tuned parameters drawn from `draw`; gives the largest difference of an
    /// output, relative to the largest magnitude that the output has had (1e-3 if less), and the largest such
    /// magnitude.
    ///
    /// Classical Runge-Kutta steps over the interpreter, 400 of 5 ms; switches have their branch for a whole step.
    pub fn difference(&self, draw: &mut Draw) -> (f64, f64) {
        let values: Vec<f64> = self
            .literal
            .parameters
            .iter()
            .zip(&self.tuned)
            .map(
                |(p, &tuned)| {
                    if tuned { p.default * (1.0 + 0.4 * draw.number()) + 0.01 * draw.number() } else { p.default }
                },
            )
            .collect();
        let own: Vec<f64> = values.iter().zip(&self.tuned).filter(|(_, tuned)| **tuned).map(|(v, _)| *v).collect();
        let unknowns: Vec<f64> = (0..self.literal.assembly.guesses.len()).map(|_| draw.number()).collect();
        let full = outputs(&self.literal, &values, &unknowns);
        let reduced = outputs(&self.reduced, &own, &unknowns);
        let names = |of: &StateEquations| of.outputs.iter().map(|output| output.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&self.literal), names(&self.reduced), "a scene keeps its outputs");
        (0..self.literal.outputs.len()).fold((0.0, 0.0), |(worst, most), column| {
            let size = full.iter().fold(1e-3_f64, |size, row| size.max(row[column].abs()));
            let apart = full.iter().zip(&reduced).map(|(a, b)| (a[column] - b[column]).abs()).fold(0.0, larger);
            (larger(worst, apart / size), larger(most, size))
        })
    }

    /// The outputs of both models at the start.
    pub fn starts(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut full, mut reduced) = self.columns();
        (full.swap_remove(0), reduced.swap_remove(0))
    }

    /// The outputs of both models over time, with the defaults.
    pub fn columns(&self) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let defaults = |of: &StateEquations| of.parameters.iter().map(|p| p.default).collect::<Vec<_>>();
        let guesses = vec![0.0; self.literal.assembly.guesses.len()];
        (
            outputs(&self.literal, &defaults(&self.literal), &guesses),
            outputs(&self.reduced, &defaults(&self.reduced), &guesses),
        )
    }

    /// Panics unless the reduced model's outputs are those of the literal one, for three draws of the tuned parameters.
    pub fn agrees(&self) {
        self.agrees_to(1e-11);
    }

    /// The same to a part `bound` of an output's size.
    pub fn agrees_to(&self, bound: f64) {
        let mut draw = Draw(Random::new(self.report.fates.len() as u64));
        for _ in 0..3 {
            let (difference, _) = self.difference(&mut draw);
            assert!(difference < bound, "{difference:e}\n{}", self.report);
        }
    }
}

/// The larger of two, not-a-number before all others.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// A fate as one word, with the state it equals.
pub(super) fn word(fate: &Fate) -> String {
    match fate {
        Fate::Integrated => "integrated".to_owned(),
        Fate::Quadrature => "quadrature".to_owned(),
        Fate::Constant(value) => format!("constant {value}"),
        Fate::Equal(other) => format!("equal {other}"),
        Fate::Recovered(value) => format!("recovered {value}"),
        Fate::Joined(joint) => format!("joined {joint}"),
        Fate::Closed(joint) => format!("closed {joint}"),
        Fate::Unwatched => "unwatched".to_owned(),
    }
}

const STEPS: u32 = 400;
const STEP: f64 = 5e-3;

/// All outputs at the start and after every tenth step.
fn outputs(of: &StateEquations, parameters: &[f64], unknowns: &[f64]) -> Vec<Vec<f64>> {
    let starts: Vec<Id> = of.states.iter().map(|state| state.start).collect();
    let rates: Vec<Id> = of.states.iter().map(|state| state.rate).collect();
    let guards: Vec<Id> = of.switches.iter().map(|switch| switch.guard).collect();
    let values: Vec<Id> = of.outputs.iter().map(|output| output.value).collect();
    let projected: Vec<Id> = of.projections.iter().map(|&(_, id)| id).collect();
    let given = Environment { parameters, unknowns, ..Environment::default() };
    let sides: Vec<f64> = evaluate(&of.pool, &of.assembly.sides, &given).into_iter().map(f64::signum).collect();
    let at = |roots: &[Id], time: f64, states: &[f64], negative: &[bool]| {
        let inputs: Vec<f64> = (0..of.inputs.len()).map(|k| (2.0 * time + k as f64).sin()).collect();
        evaluate(&of.pool, roots, &Environment { time, states, inputs: &inputs, sides: &sides, negative, ..given })
    };
    let mut x = at(&starts, 0.0, &[], &[]);
    let mut negative = vec![false; guards.len()];
    let mut rows = Vec::new();
    for step in 0..=STEPS {
        let t = f64::from(step) * STEP;
        // A guard may depend on a switch before it.
        for _ in 0..=guards.len() {
            negative = at(&guards, t, &x, &negative).iter().map(|guard| *guard < 0.0).collect();
        }
        if step % 10 == 0 {
            rows.push(at(&values, t, &x, &negative));
        }
        let plus = |k: &[f64], h: f64| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + h * k).collect() };
        let k1 = at(&rates, t, &x, &negative);
        let k2 = at(&rates, t + 0.5 * STEP, &plus(&k1, 0.5 * STEP), &negative);
        let k3 = at(&rates, t + 0.5 * STEP, &plus(&k2, 0.5 * STEP), &negative);
        let k4 = at(&rates, t + STEP, &plus(&k3, STEP), &negative);
        x = (0..x.len()).map(|i| x[i] + STEP / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])).collect();
        let moved = at(&projected, t, &x, &negative);
        for (&(state, _), value) in of.projections.iter().zip(moved) {
            x[state] = value;
        }
    }
    rows
}

/// What a network is drawn from.
pub(super) struct Draw(pub Random);

impl Draw {
    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.0.below(end)
    }

    /// A number between -1 and 1.
    pub fn number(&mut self) -> f64 {
        self.below(200_001) as f64 / 100_000.0 - 1.0
    }

    /// True in `part` of `whole` cases.
    pub fn chance(&mut self, part: usize, whole: usize) -> bool {
        self.below(whole) < part
    }

    /// One of these.
    pub fn pick<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

/// Names of nodes and of states of an oscillator: a mass on a spring and a damper.
///
/// `1 NAME`, `I NAMEm`, `C NAMEk`, `R NAMEr`; parameters `NAME_mass` and so on must be declared or are numbers.
pub(super) fn oscillator(name: &str, [mass, stiffness, damping]: [&str; 3], [momentum, stretch]: [&str; 2]) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "1 {name}: translation; I {name}m = {mass} start {momentum}; {name} -> {name}m;");
    if !stiffness.is_empty() {
        let _ = writeln!(text, "C {name}k = {stiffness} start {stretch}; {name} -> {name}k;");
    }
    if !damping.is_empty() {
        let _ = writeln!(text, "R {name}r = {damping}; {name} -> {name}r;");
    }
    text
}

/// Two masses with a spring in between, `i` and `j` names of 1-junctions.
pub(super) fn coupling(name: &str, i: &str, j: &str, stiffness: &str) -> String {
    format!(
        "0 {name}z: translation; 1 {name}s: translation; C {name} = {stiffness}; {i} -> {name}z -> {j}; \
        {name}z -> {name}s -> {name};\n"
    )
}

#[test]
fn the_interpreter_integrates() {
    // x'' = -x from 1: the last output is cos(2), within the error of the method, 2 h^4 / 120.
    let scene = scene(
        "param k: N/m = 1; 1 a: translation; I m = 1; C s = k start 1; a -> m; a -> s; observe { x: m = s.q; }",
        "tune {}",
    );
    let rows = outputs(&scene.reduced, &[], &[]);
    assert_eq!(rows.len(), 41);
    assert!((rows[40][0] - 2.0_f64.cos()).abs() < 1e-10, "{:?}", rows[40]);
    scene.agrees();
}

#[test]
fn parameters_that_no_one_tunes_become_numbers_and_the_others_keep_their_order() {
    let graph = "param a: kg = 2; param b: N/m = 3; param c: N*s/m = 5;
        1 j: translation; I m = a start 1; C s = b; R r = c; j -> m; j -> s; j -> r; observe { v: m/s = j.flow; }";
    let names = |scene: &Scene| scene.reduced.parameters.iter().map(|p| p.name.text.clone()).collect::<Vec<_>>();
    assert_eq!(names(&scene(graph, "")), ["a", "b", "c"]);
    assert_eq!(names(&scene(graph, "tune { c, a }")), ["a", "c"]);
    assert!(names(&scene(graph, "tune {}")).is_empty());
    let some = scene(graph, "tune { c, a }");
    let rates: Vec<Id> = some.reduced.states.iter().map(|state| state.rate).collect();
    let symbols = some.reduced.pool.symbols(&rates);
    assert!(symbols.contains(&Symbol::Parameter(1)) && !symbols.contains(&Symbol::Parameter(2)));
    some.agrees();
}

#[test]
fn switches_are_decided_by_folded_parameters() {
    let graph = "param level: N = 4; param k: N/m = 3; 1 j: translation; I m = 2 start 1; C s = k;
        MSe f = if level < 5 { 1 } else { 2 }; R r(v) = if v < 0 { 2 * v } else { 3 * v }; f -> j -> m; j -> s; j -> r;
        observe { v: m/s = j.flow; f: N = f.effort; }";
    let literal = scene(graph, "");
    assert_eq!(literal.reduced.switches.len(), 2);
    let folded = scene(graph, "tune { k }");
    assert_eq!(folded.reduced.switches.iter().map(|switch| switch.element.as_str()).collect::<Vec<_>>(), ["r"]);
    let force = folded.reduced.outputs.iter().find(|output| output.name == "f").expect("observed").value;
    assert_eq!(folded.reduced.pool.as_number(force), Some(1.0));
    folded.agrees();
    literal.agrees();
    let other = scene(&graph.replace("N = 4", "N = 6"), "tune { k }");
    let force = other.reduced.outputs.iter().find(|output| output.name == "f").expect("observed").value;
    assert_eq!(other.reduced.pool.as_number(force), Some(2.0));
    other.agrees();
}

#[test]
fn the_report_counts_every_state_once_and_each_stage() {
    let graph = oscillator("a", ["2", "k", ""], ["0", "0.1"])
        + &oscillator("b", ["2", "k", ""], ["0", "-0.1"])
        + &oscillator("c", ["2", "k", ""], ["0", "0"])
        + &oscillator("d", ["3", "k", ""], ["1", "0"])
        + "param k: N/m = 50; observe { a: m/s = a.flow; b: m/s = b.flow; c: m/s = c.flow; e: J = integral(am.power); \
            }";
    let scene = scene(&graph, "tune { k }");
    let text = scene.report.to_string();
    let first = text.lines().next().expect("a summary");
    assert_eq!(
        first,
        "9 states: 2 constant; 2 equal up to sign; 0 recovered; 2 unwatched; 2 integrated; 1 for outputs only"
    );
    let stages: Vec<_> = scene.report.counts.iter().map(|count| (count.stage, count.states)).collect();
    assert_eq!(
        stages,
        [
            ("literal", 9),
            ("parameters folded", 9),
            ("constant states folded", 7),
            ("equal states merged", 5),
            ("affine states recovered", 5),
            ("unwatched states dropped", 3),
        ]
    );
    assert_eq!(scene.report.integrated(), 2);
    assert_eq!(text.lines().count(), 1 + stages.len() + 9);
    scene.agrees();
}
