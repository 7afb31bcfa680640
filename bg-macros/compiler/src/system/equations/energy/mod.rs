//! Whether the energy that a user gives is that of the law.
//!
//! In: law and energy of a C or I over symbols in the place of its state. Out: a fault, or none. The derivative of the
//! energy must be the law in every branch, and the energy must not jump where a branch ends. Method: both are proved as
//! polynomial identities, the second at the zero of a guard that is linear in the state. Where that shows nothing,
//! because the functions are others or the branches exclude each other, values are compared: the derivative at
//! [`POINTS`] points and between all switches found along [`LINES`] lines, the energy on both sides of each. Parameters
//! take their defaults and values near these.

use super::EquationFault;
use super::signals::Signals;
use crate::expr::{
    Branch, Environment, Id, Pool, Symbol, evaluate, partial, same_polynomial, substitute, substitute_switched,
};
use crate::fault::Fault;
use crate::graph::{BondGraph, Element, NodeId, Parameter, Term};
use crate::random::Random;

/// Points at which the derivative of the energy is compared with the law.
const POINTS: usize = 64;

/// Lines through the states along which the switches are looked for.
const LINES: usize = 12;

/// At least this many of the points must give finite values.
const FEWEST: usize = POINTS / 8;

/// Most switches whose branches are all taken up in a proof.
const MOST_SWITCHES: usize = 6;

/// Rounding of sums of a few terms; a wrong energy differs in the first digits.
const ROUNDING: f64 = 1e-9;

/// How far from a switch the energy is looked at for its size, as a part of the state's size.
const BESIDE: f64 = 0.03;

/// What is wrong with an energy.
enum Wrong {
    /// Its derivative is not the law.
    Derivative,
    /// It jumps by so much where the law switches, at this state.
    Jump { by: f64, at: Vec<f64> },
    /// Neither is finite where they were compared.
    Unknown,
}

impl Signals<'_> {
    /// Compares the user's energy with the law.
    pub(super) fn check_energy(&mut self, node: NodeId, element: &Element, term: &Term) {
        let switches = self.switches.len();
        let components = self.graph.bond(self.graph.node(node).bonds[0]).cardinality;
        let (own, variable) = self.own_symbols(components);
        let law = self.storage_law(node, element, &variable);
        let energy = self.evaluate(term, Some(&variable)).0[0];
        let mut pairs = Vec::new();
        for (&component, &expected) in own.iter().zip(&law.0) {
            let slope = partial(&mut self.pool, &[energy], component)[0];
            pairs.extend([slope, expected]);
        }
        let guards: Vec<Id> = self.switches.iter().map(|switch| switch.guard).collect();
        let (guards, pairs) = (self.with_values(&guards), self.with_values(&pairs));
        let energy = self.with_values(&[energy])[0];
        self.switches.truncate(switches);
        let mut check = Check { pool: self.pool.clone(), graph: self.graph, state: own, guards, pairs, energy };
        let Some(wrong) = check.wrong() else { return };
        let definition = self.graph.node(node);
        let (symbol, name) = (definition.kind.symbol(), definition.name.text.clone());
        let fault = match wrong {
            Wrong::Derivative => EquationFault::EnergyOfOtherLaw { symbol, name },
            Wrong::Jump { by, at } => EquationFault::EnergyJumps { symbol, name, by, at },
            Wrong::Unknown => EquationFault::EnergyNotCompared { symbol, name, points: POINTS },
        };
        self.fault_once(Fault::new(term.span, &fault));
    }

    /// The expressions with a number in the place of every reaction and of every variable of a faulty loop or law.
    fn with_values(&mut self, of: &[Id]) -> Vec<Id> {
        let number = self.pool.number(0.83);
        let has_none = |symbol| matches!(symbol, Symbol::Multiplier(_) | Symbol::Unsolved(_) | Symbol::Law(_));
        substitute(&mut self.pool, of, &|symbol| has_none(symbol).then_some(number))
    }
}

/// A comparison under way, on a pool of its own.
struct Check<'g> {
    pool: Pool,
    graph: &'g BondGraph,
    /// The storage's own state.
    state: Vec<Symbol>,
    guards: Vec<Id>,
    /// Derivative of the energy and law, component by component.
    pairs: Vec<Id>,
    energy: Id,
}

impl Check<'_> {
    fn wrong(&mut self) -> Option<Wrong> {
        let own = self.own_switches();
        if self.derivative_is_proved(&own) && own.iter().all(|&switch| self.continuity_is_proved(switch, &own)) {
            return None;
        }
        self.compared(&own)
    }

    /// The switches of the state: those whose guards depend on it.
    fn own_switches(&self) -> Vec<usize> {
        let is_own = |guard: Id| self.pool.symbols(&[guard]).iter().any(|symbol| self.state.contains(symbol));
        (0..self.guards.len()).filter(|&switch| is_own(self.guards[switch])).collect()
    }

    /// The expressions in every combination of branches of some switches.
    fn branches(&mut self, of: &[Id], switches: &[usize]) -> Option<Vec<Vec<Id>>> {
        if switches.len() > MOST_SWITCHES {
            return None;
        }
        let mut all = Vec::new();
        for combination in 0..1_usize << switches.len() {
            let branch = |switch: u32| match switches.iter().position(|&own| own == switch as usize) {
                Some(place) if combination >> place & 1 == 1 => Branch::Negative,
                Some(_) => Branch::Positive,
                None => Branch::Kept(switch),
            };
            all.push(substitute_switched(&mut self.pool, of, &|_| None, &branch));
        }
        Some(all)
    }

    fn derivative_is_proved(&mut self, own: &[usize]) -> bool {
        let pairs = self.pairs.clone();
        let Some(all) = self.branches(&pairs, own) else { return false };
        all.iter().flat_map(|pairs| pairs.chunks_exact(2)).all(|pair| same_polynomial(&mut self.pool, pair[0], pair[1]))
    }

    /// Whether the energy has the same value on both sides of a guard that is linear in a scalar state.
    fn continuity_is_proved(&mut self, switch: usize, own: &[usize]) -> bool {
        let Some(zero) = self.zero_of_guard(switch) else { return false };
        let others: Vec<usize> = own.iter().copied().filter(|&other| other != switch).collect();
        let both = [Branch::Negative, Branch::Positive].map(|side| {
            let branch = |other: u32| if other as usize == switch { side } else { Branch::Kept(other) };
            substitute_switched(&mut self.pool, &[self.energy], &|_| None, &branch)[0]
        });
        let Some(all) = self.branches(&both, &others) else { return false };
        let state = self.state[0];
        all.iter().all(|sides| {
            let at = substitute(&mut self.pool, sides, &|symbol| (symbol == state).then_some(zero));
            same_polynomial(&mut self.pool, at[0], at[1])
        })
    }

    /// The state at which the guard is zero.
    fn zero_of_guard(&mut self, switch: usize) -> Option<Id> {
        let &[state] = &self.state[..] else { return None };
        let guard = self.guards[switch];
        let slope = partial(&mut self.pool, &[guard], state)[0];
        if self.pool.symbols(&[slope]).contains(&state) || self.pool.has_select(&[guard]) {
            return None;
        }
        let zero = self.pool.zero();
        let offset = substitute(&mut self.pool, &[guard], &|symbol| (symbol == state).then_some(zero))[0];
        let quotient = self.pool.div(offset, slope);
        Some(self.pool.neg(quotient))
    }

    /// What values show.
    fn compared(&self, own: &[usize]) -> Option<Wrong> {
        let mut random = Random::new(7);
        let mut finite = 0;
        for point in 0..POINTS {
            let sample = Sample::new(self.graph, &mut random, point >= POINTS / 4);
            let state: Vec<f64> = self.state.iter().map(|_| sized(&mut random, -6.0, 3.0)).collect();
            match self.agree(&sample, &state) {
                Some(true) => finite += 1,
                Some(false) => return Some(Wrong::Derivative),
                None => {}
            }
        }
        if finite < FEWEST {
            return Some(Wrong::Unknown);
        }
        if own.is_empty() {
            return None;
        }
        (0..LINES).find_map(|line| {
            let sample = Sample::new(self.graph, &mut random, line >= LINES / 4);
            let direction: Vec<f64> = match self.state[..] {
                [_] => vec![1.0],
                _ => self.state.iter().map(|_| 2.0 * random.unit() - 1.0).collect(),
            };
            self.along(&sample, &direction, own)
        })
    }

    /// Whether derivative and law agree; none where one is not finite.
    fn agree(&self, sample: &Sample, state: &[f64]) -> Option<bool> {
        let values = self.values(sample, state, &self.pairs, None);
        let near = |pair: &[f64]| (pair[0] - pair[1]).abs() <= ROUNDING * (pair[0].abs() + pair[1].abs() + 1e-300);
        values.iter().all(|value| value.is_finite()).then(|| values.chunks_exact(2).all(near))
    }

    /// Looks for all switches along a line through the zero of the states: at each the energy may not jump, between
    /// them the derivative must be the law.
    fn along(&self, sample: &Sample, direction: &[f64], own: &[usize]) -> Option<Wrong> {
        let at = |place: f64| -> Vec<f64> { direction.iter().map(|part| place * part).collect() };
        let mut places = Vec::new();
        for &switch in own {
            let guard = |place: f64| self.values(sample, &at(place), &self.guards[switch..=switch], None)[0];
            for zero in zeros(&guard) {
                let side = |is_negative| self.values(sample, &at(zero), &[self.energy], Some((switch, is_negative)))[0];
                let width = BESIDE * zero.abs().max(1e-6);
                let size: f64 = [zero - width, zero + width]
                    .map(|place| self.values(sample, &at(place), &[self.energy], None)[0].abs())
                    .iter()
                    .sum();
                let by = side(false) - side(true);
                // A guard that jumps across zero itself has no place where both branches meet.
                let is_zero = guard(zero).abs() <= ROUNDING * (guard(zero - width).abs() + guard(zero + width).abs());
                if is_zero && size.is_finite() && by.abs() > ROUNDING * size {
                    return Some(Wrong::Jump { by, at: at(zero) });
                }
                places.push(zero);
            }
        }
        places.sort_by(f64::total_cmp);
        let between = places.windows(2).map(|pair| 0.47 * pair[0] + 0.53 * pair[1]);
        between.map(at).any(|state| self.agree(sample, &state) == Some(false)).then_some(Wrong::Derivative)
    }

    /// Values at a state, with the branches that the guards say, but that of one switch as given.
    fn values(&self, sample: &Sample, state: &[f64], of: &[Id], forced: Option<(usize, bool)>) -> Vec<f64> {
        let mut negative = vec![false; self.guards.len()];
        let values = |negative: &[bool], roots: &[Id]| {
            let environment = Environment {
                time: sample.time,
                states: &sample.states,
                parameters: &sample.parameters,
                inputs: &sample.inputs,
                unknowns: &sample.unknowns,
                storage: state,
                negative,
                ..Environment::default()
            };
            evaluate(&self.pool, roots, &environment)
        };
        // A guard may contain other switches.
        for _ in 0..2 {
            negative = values(&negative, &self.guards).iter().map(|&guard| guard < 0.0).collect();
        }
        if let Some((switch, is_negative)) = forced {
            negative[switch] = is_negative;
        }
        values(&negative, of)
    }
}

/// Values of all that is not the state.
struct Sample {
    time: f64,
    states: Vec<f64>,
    parameters: Vec<f64>,
    inputs: Vec<f64>,
    unknowns: Vec<f64>,
}

impl Sample {
    /// Irregular values of both signs, so that no term vanishes by symmetry; parameters at or near their defaults.
    fn new(graph: &BondGraph, random: &mut Random, is_near: bool) -> Self {
        let states: usize = 12 * graph.storages.len() + graph.integrals.len();
        let mut irregular = |count: usize| (0..count).map(|_| sized(random, -1.0, 0.5)).collect::<Vec<f64>>();
        let (states, inputs, unknowns) =
            (irregular(states), irregular(graph.inputs.len()), irregular(graph.guesses.len()));
        let time = sized(random, -1.0, 0.5).abs();
        let parameters = graph.parameters.iter().map(|parameter| value_of(parameter, random, is_near)).collect();
        Self { time, states, parameters, inputs, unknowns }
    }
}

/// A parameter's default, or a value near it in its range.
fn value_of(parameter: &Parameter, random: &mut Random, is_near: bool) -> f64 {
    let factor = 0.4 * random.unit() - 0.2;
    let size = if parameter.default == 0.0 { 1.0 } else { parameter.default };
    let value = parameter.default + factor * size;
    let inside =
        parameter.lower.is_none_or(|(end, _)| value > end) && parameter.upper.is_none_or(|(end, _)| value < end);
    if is_near && inside { value } else { parameter.default }
}

/// A number of either sign whose size is between these powers of ten.
fn sized(random: &mut Random, least: f64, most: f64) -> f64 {
    let size = 10_f64.powf(least + (most - least) * random.unit());
    if random.unit() < 0.5 { -size } else { size }
}

/// Where a function changes its sign, from -1e3 to 1e3, to rounding.
fn zeros(of: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let sizes: Vec<f64> = (-24..=12).map(|power| 10_f64.powf(0.25 * f64::from(power))).collect();
    let below = sizes.iter().rev().map(|size| -size);
    let grid: Vec<(f64, f64)> = below.chain(sizes.iter().copied()).map(|place| (place, of(place))).collect();
    let changes = grid.windows(2).filter(|ends| (ends[0].1 < 0.0) != (ends[1].1 < 0.0));
    changes.map(|ends| bisected(of, ends[0], ends[1].0)).collect()
}

fn bisected(of: &dyn Fn(f64) -> f64, (mut low, at_low): (f64, f64), mut high: f64) -> f64 {
    for _ in 0..120 {
        let middle = 0.5 * (low + high);
        if (of(middle) < 0.0) == (at_low < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests;
