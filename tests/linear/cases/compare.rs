//! What the compiler makes of a graph, beside what it must be.
//!
//! In: a [`Network`]. Out: how far the two are apart, or what is wrong.

use bg_compiler::expr::{Environment, Id, Symbol, derivative, evaluate};
use bg_compiler::fault::Fault;
use bg_compiler::graph;
use bg_compiler::graph::causality::{self, End};
use bg_compiler::source::{mechanism, syntax};
use bg_compiler::system::equations::{self, StateEquations};
use fastrand::Rng;

use super::network::{Law, Network, Node, TIME};
use super::solution::{self, Solution, State};
use super::strokes;

/// What elimination among a hundred unknowns with factors of order one may be wrong by, relative to the largest value.
pub const ROUNDING: f64 = 1e-12;

/// The same where two-ports in a row multiply to factors of hundreds: a resistor behind them leaves a small difference
/// of large numbers. Few graphs are such.
const AMPLIFIED: f64 = 1e-10;

/// What came of a graph.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The largest difference of any value, relative to the largest value of the graph.
    Agrees(f64),
    /// The compiler refuses it, with this code.
    Refused(String),
    /// The two disagree, or the compiler refuses what it should not: in these words.
    Wrong(String),
}

fn stages(text: &str) -> Result<causality::CausalGraph, Vec<Fault>> {
    // No span of an earlier graph is used any more; otherwise the table of sources grows with every one.
    proc_macro2::extra::invalidate_current_thread_spans();
    let source = syntax::parse(text.parse().map_err(|_| Vec::new())?)?;
    causality::assign(graph::resolve(&mechanism::expand(&source.graphs[0])?)?)
}

fn refused(faults: &[Fault]) -> Verdict {
    match faults.first() {
        Some(fault) if fault.code.starts_with("BG04") || fault.code == "BG0508" => {
            Verdict::Refused(fault.code.to_owned())
        }
        Some(fault) => Verdict::Wrong(fault.to_string()),
        None => Verdict::Wrong("no tokens".to_owned()),
    }
}

/// The strokes against all assignments: accepted where one is valid, and then with the first.
#[must_use]
pub fn strokes(network: &Network) -> Verdict {
    agree(network, &network.text_with("expect integral causality;"), strokes::first(network))
}

/// The same where storages may be in derivative causality.
#[must_use]
pub fn preferred_strokes(network: &Network) -> Verdict {
    agree(network, &network.text(), strokes::preferred(network))
}

fn agree(network: &Network, text: &str, expected: Option<strokes::Strokes>) -> Verdict {
    match (stages(text), expected) {
        (Ok(causal), Some(expected)) => {
            let found: Vec<bool> = causal.strokes.iter().map(|&end| end == End::To).collect();
            if found == expected {
                Verdict::Agrees(0.0)
            } else if strokes::is_valid(network, &found) {
                Verdict::Wrong(format!("{found:?} is valid, but the first is {expected:?}"))
            } else {
                Verdict::Wrong(format!("{found:?} is not valid, {expected:?} is"))
            }
        }
        (Ok(_), None) => Verdict::Wrong("accepted, but no assignment is valid".to_owned()),
        (Err(faults), Some(expected)) => Verdict::Wrong(format!(
            "{expected:?} is valid, but: {}",
            faults.first().map_or(String::new(), ToString::to_string)
        )),
        (Err(faults), None) => refused(&faults),
    }
}

/// All efforts, flows, rates, energies and powers against the dense solution, at states drawn from `seed`. What is
/// refused because its equations have no solution must have none.
#[must_use]
pub fn signals(network: &Network, seed: u64) -> Verdict {
    let causal = match stages(&network.text()) {
        Ok(causal) => causal,
        Err(faults) => return refused(&faults),
    };
    let equations = match equations::derive(&causal) {
        Ok(equations) => equations,
        Err(faults) if solution::is_regular(network) => {
            return Verdict::Wrong(format!("refused, but there is a solution: {}", faults[0]));
        }
        Err(faults) => return refused(&faults),
    };
    if let Some(what) = impossible(&equations) {
        return if solution::is_regular(network) {
            Verdict::Wrong(format!("{what}, but it has"))
        } else {
            Verdict::Refused("by new".to_owned())
        };
    }
    let states = states(network, &equations, seed);
    let Some(solution) = solution::solve(network, &states) else {
        return Verdict::Wrong("the system has no unique solution".to_owned());
    };
    compare(&expected(network, &states, &solution), &found(equations, &states))
}

/// Values of the states that the equations have, drawn from `seed`.
fn states(network: &Network, equations: &StateEquations, seed: u64) -> Vec<State> {
    let mut rng = Rng::with_seed(seed);
    let has = |name: &str| equations.states.iter().any(|state| state.name == name);
    let mut of = |node: usize| {
        let Node { name, law, .. } = &network.nodes[node];
        let letter = match law {
            Law::Inertia(_) => 'p',
            Law::Stiffness(_) => 'q',
            _ => return Vec::new(),
        };
        let components = network.bonds_of(node).next().map_or(0, |(bond, _)| network.bonds[bond].2);
        let suffixes = if components == 1 { &[""][..] } else { &["_x", "_y", "_z"] };
        let mut value = |suffix: &&str| {
            let value = 2.0 * rng.f64() - 1.0;
            has(&format!("{name}.{letter}{suffix}")).then_some(value)
        };
        suffixes.iter().map(&mut value).collect()
    };
    (0..network.nodes.len()).map(&mut of).collect()
}

/// What the model's `new` would refuse.
fn impossible(equations: &StateEquations) -> Option<String> {
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let environment = Environment { parameters: &parameters, ..Environment::default() };
    let requirements = &equations.requirements;
    let holds = |value: Id, is_strict: bool| {
        let value = evaluate(&requirements.pool, &[value], &environment)[0];
        value > 0.0 || value == 0.0 && !is_strict
    };
    let failed = requirements.list.iter().find(|requirement| !holds(requirement.value, requirement.is_strict))?;
    Some(format!("{} {}", failed.subject, failed.wanted))
}

fn compare(expected: &[(String, f64)], found: &[f64]) -> Verdict {
    if found.len() != expected.len() {
        return Verdict::Wrong(format!("{} values for {}", found.len(), expected.len()));
    }
    let scale = expected.iter().map(|(_, value)| value.abs()).fold(1.0, f64::max);
    let mut worst = 0.0_f64;
    for ((what, expected), found) in expected.iter().zip(found) {
        let apart = (found - expected).abs() / scale;
        if apart.is_nan() || apart > AMPLIFIED {
            return Verdict::Wrong(format!("{what}: {found:e}, by the dense system {expected:e}"));
        }
        worst = worst.max(apart);
    }
    Verdict::Agrees(worst)
}

const ROLES: [&str; 2] = ["effort", "flow"];

/// Every value by its name, from the dense solution.
fn expected(network: &Network, states: &[State], solution: &Solution) -> Vec<(String, f64)> {
    let mut values = Vec::new();
    for (bond, &(from, to, _)) in network.bonds.iter().enumerate() {
        for (role, variable) in ROLES.iter().zip([&solution.efforts[bond], &solution.flows[bond]]) {
            let (from, to) = (&network.nodes[from].name, &network.nodes[to].name);
            values.extend(variable.iter().map(|&value| (format!("{role} of {from} -> {to}"), value)));
        }
    }
    let (mut stored, mut supplied, mut dissipated, mut change) = (0.0, 0.0, 0.0, 0.0);
    for (node, (definition, state)) in network.nodes.iter().zip(states).enumerate() {
        let Some((bond, into)) = network.bonds_of(node).next() else { continue };
        let sign = if into { 1.0 } else { -1.0 };
        let power = sign * solution.power(bond);
        match &definition.law {
            Law::Inertia(matrix) | Law::Stiffness(matrix) => {
                let is_inertia = matches!(definition.law, Law::Inertia(_));
                let (effort, flow) = (&solution.efforts[bond], sign * &solution.flows[bond]);
                let (of, rate) = if is_inertia { (&flow, effort) } else { (effort, &flow) };
                let inverse = matrix.clone().try_inverse().expect("a law with an inverse");
                stored += 0.5 * of.dot(&(inverse * of));
                change += power;
                let known = rate.iter().zip(state).filter(|(_, state)| state.is_some());
                values.extend(known.map(|(&rate, _)| (format!("rate of {}", definition.name), rate)));
            }
            Law::Effort(_) | Law::Flow(_) => supplied -= power,
            Law::Resistance { .. } => dissipated += power,
            _ => {}
        }
    }
    let energies = [("stored energy", stored), ("supplied power", supplied), ("dissipated power", dissipated)];
    values.extend(energies.map(|(what, value)| (what.to_owned(), value)));
    values.push(("power balance".to_owned(), supplied - dissipated - change));
    values
}

/// The same values from the compiler's equations, by its interpreter. It has bonds and storages in the order of the
/// text.
fn found(mut equations: StateEquations, states: &[State]) -> Vec<f64> {
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let rates_of_states = (0..).map(Symbol::State).zip(rates.iter().copied());
    let seeds = rates_of_states.chain([(Symbol::Time, equations.pool.one())]).collect();
    let (stored, supplied, dissipated) =
        (equations.balance.stored, equations.balance.supplied, equations.balance.dissipated);
    let change = derivative(&mut equations.pool, &[stored], &seeds)[0];
    let balance = equations.pool.linear(0.0, &[(supplied, 1.0), (dissipated, -1.0), (change, -1.0)]);
    let bonds = equations.shown.bonds.into_iter().flatten().flatten().flatten();
    let roots: Vec<Id> = bonds.chain(rates).chain([stored, supplied, dissipated, balance]).collect();
    let values: Vec<f64> = states.iter().flatten().copied().flatten().collect();
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    evaluate(
        &equations.pool,
        &roots,
        &Environment { time: TIME, states: &values, parameters: &parameters, ..Environment::default() },
    )
}
