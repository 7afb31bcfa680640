//! What the compiler makes of a graph, beside what it must be.
//!
//! In: a [`Network`]. Out: how far the two are apart, or what is wrong.

use bg_compiler::expr::{Environment, Id, Symbol, derivative, evaluate};
use bg_compiler::fault::Fault;
use bg_compiler::graph;
use bg_compiler::graph::causality::{self, End};
use bg_compiler::source::{mechanism, syntax};
use bg_compiler::system::equations::{self, StateEquations};
use bg_model::nalgebra::DVector;
use fastrand::Rng;

use super::network::{Law, Network, TIME};
use super::solution::{self, Solution};
use super::strokes;

/// What elimination among a hundred unknowns with factors of order one may be wrong by, relative to the largest value.
const ROUNDING: f64 = 1e-12;

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
        Some(fault) if fault.code.starts_with("BG04") || ["BG0508", "BG0512"].contains(&fault.code) => {
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
    let mut rng = Rng::with_seed(seed);
    let states: Vec<DVector<f64>> = (0..network.nodes.len())
        .map(|node| {
            let components = network.bonds_of(node).next().map_or(0, |(bond, _)| network.bonds[bond].2);
            DVector::from_fn(components, |_, _| 2.0 * rng.f64() - 1.0)
        })
        .collect();
    let causal = match stages(&network.text()) {
        Ok(causal) => causal,
        Err(faults) => return refused(&faults),
    };
    let given = |is_given: &dyn Fn(usize) -> bool| -> Vec<Option<DVector<f64>>> {
        states.iter().enumerate().map(|(node, state)| is_given(node).then(|| state.clone())).collect()
    };
    let equations = match equations::derive(&causal) {
        Ok(equations) => equations,
        Err(faults) => {
            let states = given(&|node| causal.derivative.iter().all(|dependent| dependent.0 != node));
            return match solution::solve(network, &states) {
                Some(_) => Verdict::Wrong(format!("refused, but there is a solution: {}", faults[0])),
                None => refused(&faults),
            };
        }
    };
    if let Some(what) = impossible(&equations) {
        let has_none =
            solution::solve(network, &given(&|node| causal.derivative.iter().all(|known| known.0 != node))).is_none();
        return if has_none {
            Verdict::Refused("by new".to_owned())
        } else {
            Verdict::Wrong(format!("{what}, but it has"))
        };
    }
    let has_state = |node: usize| {
        let name = &network.nodes[node].name;
        equations.states.iter().any(|state| state.name.strip_prefix(name).is_some_and(|rest| rest.starts_with('.')))
    };
    let states = given(&has_state);
    let Some(solution) = solution::solve(network, &states) else {
        return Verdict::Wrong("the system has no unique solution".to_owned());
    };
    compare(&expected(network, &states, &solution), &found(network, equations, &states))
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
        if apart.is_nan() || apart > ROUNDING {
            return Verdict::Wrong(format!("{what}: {found:e}, by the dense system {expected:e}"));
        }
        worst = worst.max(apart);
    }
    Verdict::Agrees(worst)
}

const ROLES: [&str; 2] = ["effort", "flow"];

/// Every value by its name, from the dense solution.
fn expected(network: &Network, states: &[Option<DVector<f64>>], solution: &Solution) -> Vec<(String, f64)> {
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
        let rate = match &definition.law {
            Law::Inertia(matrix) | Law::Stiffness(matrix) => {
                let is_inertia = matches!(definition.law, Law::Inertia(_));
                let (effort, flow) = (&solution.efforts[bond], sign * &solution.flows[bond]);
                let (of, rate) = if is_inertia { (&flow, effort) } else { (effort, &flow) };
                let inverse = matrix.clone().try_inverse().expect("a law with an inverse");
                stored += 0.5 * of.dot(&(inverse * of));
                change += power;
                if state.is_none() {
                    continue;
                }
                rate.clone()
            }
            Law::Effort(_) | Law::Flow(_) => {
                supplied -= power;
                continue;
            }
            Law::Resistance { .. } => {
                dissipated += power;
                continue;
            }
            _ => continue,
        };
        values.extend(rate.iter().map(|&value| (format!("rate of {}", definition.name), value)));
    }
    let energies = [("stored energy", stored), ("supplied power", supplied), ("dissipated power", dissipated)];
    values.extend(energies.map(|(what, value)| (what.to_owned(), value)));
    values.push(("power balance".to_owned(), supplied - dissipated - change));
    values
}

/// The same values from the compiler's equations, by its interpreter. It has bonds and storages in the order of the
/// text.
fn found(network: &Network, mut equations: StateEquations, states: &[Option<DVector<f64>>]) -> Vec<f64> {
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let rates_of_states = (0..).map(Symbol::State).zip(rates.iter().copied());
    let seeds = rates_of_states.chain([(Symbol::Time, equations.pool.one())]).collect();
    let (stored, supplied, dissipated) = (equations.stored, equations.supplied, equations.dissipated);
    let change = derivative(&mut equations.pool, &[stored], &seeds)[0];
    let balance = equations.pool.linear(0.0, &[(supplied, 1.0), (dissipated, -1.0), (change, -1.0)]);
    let bonds = equations.shown.bonds.into_iter().flatten().flatten().flatten();
    let roots: Vec<Id> = bonds.chain(rates).chain([stored, supplied, dissipated, balance]).collect();
    let storages = network.nodes.iter().zip(states);
    let values: Vec<f64> = storages
        .filter(|(node, _)| matches!(node.law, Law::Inertia(_) | Law::Stiffness(_)))
        .flat_map(|(_, state)| state.iter().flatten().copied())
        .collect();
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    evaluate(
        &equations.pool,
        &roots,
        &Environment { time: TIME, states: &values, parameters: &parameters, ..Environment::default() },
    )
}
