//! Bodies on hinges in joint coordinates.
//!
//! In: equations with bodies of eighteen states each and rigid joints, all of them hinges of trees that stand on the
//! ground. Out: the same with an angle and a speed for each hinge; poses and momenta of bodies are expressions of
//! these. Method: with the motion of a hinge in place of that of a body the gaps and flows of its joint are zero
//! identically (`joints`), so no motion is lost; its reactions work on none of these motions, so they occur in none of
//! the rates. These are found from tip to ground and back (`recursion`). Where anything else is held, as by a joint
//! that closes a loop, a stop or dry friction, the equations stay as they are.

mod bodies;
mod joints;
mod links;
mod loads;
mod motion;
mod numbers;
mod recursion;

use std::collections::{BTreeMap, BTreeSet};

use super::friction;
use super::report::{Fate, Report};
use crate::expr::{Environment, Id, Node, Pool, Symbol, evaluate, exchange, substitute};
use crate::system::equations::{Origin, State, StateEquations};
use bodies::{Body, velocity};
use joints::Hinge;
use motion::Velocities;

/// Whether there is anything to look at: rows of rigid joints, and no others. Stops and dry friction are not told
/// their mobilities yet.
pub(super) fn may_apply(equations: &StateEquations) -> bool {
    let rigid = friction::rigid(&equations.reactions);
    equations.baumgarte.is_none() && rigid > 0 && rigid == equations.reactions.len()
}

/// Takes the bodies of a tree of hinges out of the equations; none where there are none, or something does not fit.
pub(super) fn put(equations: &mut StateEquations, report: &mut Report) -> Option<()> {
    let bodies = bodies::of(equations);
    let spins = places_of_spins(&mut equations.pool, &bodies);
    equations.rewrite(&|pool, ids| exchange(pool, ids, &spins));
    let hinges = hinges(equations, &bodies)?;
    let of_bodies: BTreeSet<usize> = hinges.iter().flat_map(|hinge| bodies[hinge.child].states()).collect();
    release(equations, &of_bodies)?;
    let first = 6 * bodies.len() + joints::PROBES;
    let coordinates = motion::coordinates(&mut equations.pool, first, hinges.len());
    motion::recognise(equations, &bodies, &hinges, &coordinates);
    let links = links::of(&mut equations.pool, &bodies, &hinges);
    let (moved, ground) = loads::of(equations, &bodies, &links, &coordinates);
    let velocities = Velocities::of(&mut equations.pool, &links, &moved);
    let rates = recursion::rates(&mut equations.pool, &links, &moved, &velocities.spins, &ground);
    let starts = motion::starts(equations, &bodies, &hinges);
    motion::energies(equations, &bodies, &links, &velocities);
    let images = motion::images(&mut equations.pool, &bodies, &links, &moved, &velocities);
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

/// The hinges of trees on the ground, parents first, where all rows are of such.
fn hinges(equations: &mut StateEquations, bodies: &[Body]) -> Option<Vec<Hinge>> {
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let states = values_at_start(equations, &parameters);
    let starts = Environment { states: &states, parameters: &parameters, ..Environment::default() };
    let hinges = spanning(joints::of(equations, bodies, &starts));
    let rows: usize = hinges.iter().map(|hinge| hinge.rows.len()).sum();
    (!is_planar(&hinges) && rows == equations.reactions.len()).then_some(hinges)
}

/// Takes the reactions out of the rates of the momenta of these bodies, on whose motions they do not work; none where
/// something else reads one.
fn release(equations: &mut StateEquations, bodies: &BTreeSet<usize>) -> Option<()> {
    let gone: BTreeSet<Symbol> = equations.reactions.iter().map(|reaction| reaction.multiplier).collect();
    if is_read(equations, &gone, bodies) {
        return None;
    }
    let StateEquations { pool, states, shown, .. } = equations;
    let zero = pool.zero();
    let rates: Vec<Id> = bodies.iter().map(|&state| states[state].rate).collect();
    let rates = substitute(pool, &rates, &|symbol| gone.contains(&symbol).then_some(zero));
    for (&state, rate) in bodies.iter().zip(rates) {
        states[state].rate = rate;
    }
    shown.forget(pool, &gone);
    equations.reactions.clear();
    Some(())
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
    let outputs = equations.outputs.iter().map(|output| output.value);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let powers = [equations.supplied, equations.dissipated, equations.stored];
    let loops = equations.iterations.iter().flat_map(|iteration| iteration.residuals.iter().copied());
    let laws = equations.fallible.iter().map(|law| law.value);
    let all = rates.chain(outputs).chain(guards).chain(powers).chain(loops).chain(laws);
    equations.pool.symbols(&all.collect::<Vec<_>>()).iter().any(|symbol| gone.contains(symbol))
}

#[cfg(test)]
mod tests;
