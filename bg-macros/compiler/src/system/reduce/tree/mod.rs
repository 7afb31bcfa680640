//! Bodies on hinges in joint coordinates.
//!
//! In: equations with bodies of eighteen states each and rigid joints, among them hinges of trees that stand on the
//! ground. Out: the same with an angle and a speed for each hinge; poses and momenta of bodies are expressions of
//! these. Method: with the motion of a hinge in place of that of a body the gaps and flows of its joint are zero
//! identically (`joints`), so no motion is lost; its reactions work on none of these motions, so they occur in none of
//! the rates. These are found from tip to ground and back (`recursion`). What else is held, by joints that close loops,
//! stops and dry friction, keeps its reactions, which are loads to the tree.

mod bodies;
mod joints;
mod links;
mod loads;
mod motion;
mod numbers;
mod recursion;

use std::collections::{BTreeMap, BTreeSet};

use super::report::{Fate, Report};
use super::speeds::of_kind;
use super::{closing, friction};
use crate::expr::{Environment, Id, Node, Pool, Symbol, evaluate, exchange, partial, substitute};
use crate::system::equations::{Kind, Origin, State, StateEquations};
use bodies::{Body, velocity};
use joints::Hinge;
use motion::Velocities;

/// Whether there is anything to look at: rows of rigid joints.
pub(super) fn may_apply(equations: &StateEquations) -> bool {
    equations.baumgarte.is_none() && friction::rigid(&equations.reactions) > 0
}

/// Whether it has been done.
pub(super) fn is_put(equations: &StateEquations) -> bool {
    equations.states.iter().any(|state| matches!(state.origin, Origin::Speed(_)))
}

/// Takes the bodies of a tree of hinges out of the equations; none where there are none, or something does not fit.
pub(super) fn put(equations: &mut StateEquations, report: &mut Report) -> Option<()> {
    let bodies = bodies::of(equations);
    let literal = Literal::of(equations);
    let spins = places_of_spins(&mut equations.pool, &bodies);
    equations.rewrite(&|pool, ids| exchange(pool, ids, &spins));
    let hinges = hinges(equations, &bodies)?;
    let of_bodies: BTreeSet<usize> = hinges.iter().flat_map(|hinge| bodies[hinge.child].states()).collect();
    release(equations, &hinges, &of_bodies)?;
    literal.keep_mobilities(equations);
    let first = 6 * bodies.len() + joints::PROBES;
    let coordinates = motion::coordinates(&mut equations.pool, first, hinges.len());
    motion::recognise(equations, &bodies, &hinges, &coordinates);
    let links = links::of(&mut equations.pool, &bodies, &hinges);
    let (moved, ground) = loads::of(equations, &bodies, &links, &coordinates);
    let velocities = Velocities::of(&mut equations.pool, &links, &moved);
    let rates = recursion::rates(&mut equations.pool, &links, &moved, &velocities.spins, &ground);
    let starts = motion::starts(equations, &bodies, &hinges);
    motion::energies(equations, &bodies, &links, &velocities);
    let mut images = motion::images(&mut equations.pool, &bodies, &links, &moved, &velocities);
    for (index, body) in bodies.iter().enumerate() {
        for (k, &spin) in body.spin.iter().enumerate() {
            // Of a body on no hinge, which keeps its states.
            images.entry(velocity(index, 3 + k)).or_insert(spin);
        }
    }
    let mut kept = vec![true; equations.states.len()];
    let mut places: BTreeMap<Symbol, Id> = BTreeMap::new();
    for (k, hinge) in hinges.iter().enumerate() {
        let body = &bodies[hinge.child];
        for state in body.states() {
            kept[state] = false;
            report.say(state, Fate::Joined(hinge.name.clone()));
        }
        let Origin::Orientation(track, ..) = equations.states[body.axes[0]].origin else { return None };
        let [angle, speed] = [Origin::Hinge(track), Origin::Speed(track)];
        let new = |letter: char, unit: &str, origin, start, rate| State {
            name: format!("{}.{letter}", hinge.name),
            unit: unit.to_owned(),
            origin,
            start,
            rate,
        };
        let angle = new('q', "rad", angle, starts[k][0], coordinates[k].speed);
        let speed = new('u', "rad/s", speed, starts[k][1], rates[k]);
        for (side, (state, new)) in [(body.axes[0], angle), (body.angular[0], speed)].into_iter().enumerate() {
            kept[state] = true;
            report.rename(state, new.clone());
            report.say(state, Fate::Integrated);
            equations.states[state] = new;
            let symbol = Symbol::numbered(Symbol::Weight, first + 2 * k + side);
            places.insert(symbol, equations.pool.symbol(Symbol::state(state)));
        }
    }
    equations.projections.retain(|(state, _)| !of_bodies.contains(state));
    equations.replace(&|symbol| images.get(&symbol).copied());
    equations.replace(&|symbol| places.get(&symbol).copied());
    super::live::keep_states(equations, report, &kept);
    Some(())
}

/// The hinges of trees on the ground, parents first, where they do not all turn in the plane.
fn hinges(equations: &mut StateEquations, bodies: &[Body]) -> Option<Vec<Hinge>> {
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let states = values_at_start(equations, &parameters);
    let starts = Environment { states: &states, parameters: &parameters, ..Environment::default() };
    let hinges = spanning(joints::of(equations, bodies, &starts));
    (!is_planar(&hinges)).then_some(hinges)
}

/// Takes the reactions of hinges out of the equations; they do not work on the motions of these bodies. None where
/// something beside their momenta reads one, or one of a loop, which the hinges may share.
fn release(equations: &mut StateEquations, hinges: &[Hinge], bodies: &BTreeSet<usize>) -> Option<()> {
    let rows: BTreeSet<usize> = hinges.iter().flat_map(|hinge| hinge.rows.iter().copied()).collect();
    let rigid = friction::rigid(&equations.reactions);
    let multiplier = |row: usize| equations.reactions[row].multiplier;
    let gone: BTreeSet<Symbol> = rows.iter().map(|&row| multiplier(row)).collect();
    let closing: BTreeSet<Symbol> = (0..rigid).filter(|row| !rows.contains(row)).map(multiplier).collect();
    let unknown: BTreeSet<Symbol> =
        if closing.len() > 1 { gone.union(&closing).copied().collect() } else { gone.clone() };
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    if is_read(equations, &gone, bodies) || has_any(&equations.pool, &outputs, &unknown) {
        return None;
    }
    let StateEquations { pool, states, shown, .. } = equations;
    let zero = pool.zero();
    let rates: Vec<Id> = bodies.iter().map(|&state| states[state].rate).collect();
    let rates = substitute(pool, &rates, &|symbol| gone.contains(&symbol).then_some(zero));
    for (&state, rate) in bodies.iter().zip(rates) {
        states[state].rate = rate;
    }
    shown.forget(pool, &unknown);
    equations.reactions.retain(|reaction| !gone.contains(&reaction.multiplier));
    Some(())
}

/// The flows of all rows and the rates of all momenta as momenta determine them.
struct Literal {
    flows: BTreeMap<Symbol, Id>,
    rates: Vec<(usize, Id)>,
}

impl Literal {
    fn of(equations: &StateEquations) -> Self {
        let flows = equations.reactions.iter().map(|reaction| (reaction.multiplier, reaction.slip.flow)).collect();
        let rates = of_kind(equations, Kind::Momentum).map(|state| (state, equations.states[state].rate)).collect();
        Self { flows, rates }
    }

    /// Gives the rows that are left their mobilities by all momenta, where joints close loops.
    fn keep_mobilities(&self, equations: &mut StateEquations) {
        if friction::rigid(&equations.reactions) == 0 {
            return;
        }
        let StateEquations { pool, reactions, .. } = equations;
        for reaction in reactions {
            let flow = self.flows[&reaction.multiplier];
            let load = |&(state, rate): &(usize, Id)| (state, partial(pool, &[rate], reaction.multiplier)[0]);
            let loads: Vec<(usize, Id)> = self.rates.iter().map(load).collect();
            reaction.slip.mobility = Some(closing::mobility(pool, flow, &loads));
        }
    }
}

/// A symbol in the place of each angular velocity.
fn places_of_spins(pool: &mut Pool, bodies: &[Body]) -> BTreeMap<Id, Id> {
    let mut places = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        for (k, &spin) in body.spin.iter().enumerate() {
            let symbol = pool.symbol(velocity(index, 3 + k));
            // A scaled node is in other nodes as the node.
            let (node, factor) = match pool.node(spin) {
                Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => {
                    (terms[0].0, terms[0].1.value())
                }
                _ => (spin, 1.0),
            };
            places.insert(node, pool.scale(1.0 / factor, symbol));
        }
    }
    places
}

/// The values of the states at the start, with these of the parameters and the first guesses.
fn values_at_start(equations: &StateEquations, parameters: &[f64]) -> Vec<f64> {
    let given = Environment { parameters, ..Environment::default() };
    let unknowns = evaluate(&equations.pool, &equations.guesses, &given);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    evaluate(&equations.pool, &starts, &Environment { unknowns: &unknowns, ..given })
}

/// Hinges that carry bodies from the ground on, parents first.
fn spanning(hinges: Vec<Hinge>) -> Vec<Hinge> {
    let mut tree: Vec<Hinge> = Vec::new();
    let mut left = hinges;
    loop {
        let has = |body: usize| tree.iter().any(|hinge| hinge.child == body);
        let is_next = |hinge: &Hinge| match hinge.parent {
            None => !has(hinge.child),
            Some(parent) => has(parent) != has(hinge.child),
        };
        let Some(place) = left.iter().position(is_next) else { return tree };
        let hinge = left.remove(place);
        let is_backwards = hinge.parent.is_some_and(|parent| !has(parent));
        tree.push(if is_backwards { hinge.reversed() } else { hinge });
    }
}

/// Whether all hinges turn in the x-y plane, in which bodies' own momenta take fewer operations.
fn is_planar(hinges: &[Hinge]) -> bool {
    hinges.iter().all(|hinge| hinge.frames.iter().all(|frame| numbers::column(frame, 2)[2].abs() == 1.0))
}

/// Whether something beside the momenta of these bodies reads a reaction that goes.
fn is_read(equations: &StateEquations, gone: &BTreeSet<Symbol>, bodies: &BTreeSet<usize>) -> bool {
    let others = equations.states.iter().enumerate().filter(|(state, _)| !bodies.contains(state));
    let rates = others.map(|(_, state)| state.rate);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let powers = [equations.supplied, equations.dissipated, equations.stored];
    let loops = equations.iterations.iter().flat_map(|iteration| iteration.residuals.iter().copied());
    let laws = equations.fallible.iter().map(|law| law.value);
    let all = rates.chain(guards).chain(powers).chain(loops).chain(laws);
    has_any(&equations.pool, &all.collect::<Vec<_>>(), gone)
}

/// Whether one of these symbols is read.
fn has_any(pool: &Pool, ids: &[Id], symbols: &BTreeSet<Symbol>) -> bool {
    !pool.symbols(ids).is_disjoint(symbols)
}

#[cfg(test)]
mod tests;
