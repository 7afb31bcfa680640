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
mod motion;
mod numbers;
mod recursion;

use std::collections::BTreeSet;

use super::report::{Fate, Report};
use super::{friction, is_constant};
use crate::expr::{Environment, Function, Id, Pool, Symbol, evaluate, exchange, substitute};
use crate::system::Value;
use crate::system::equations::{Origin, State, StateEquations};
use bodies::{Body, velocity};
use joints::Hinge;
use links::Link;
use recursion::Moved;

/// Whether there is anything to look at.
pub(super) fn may_apply(equations: &StateEquations) -> bool {
    equations.baumgarte.is_none() && friction::rigid(&equations.reactions) > 0
}

/// Takes the bodies of a tree of hinges out of the equations; none where there are none, or something does not fit.
pub(super) fn put(equations: &mut StateEquations, report: &mut Report) -> Option<()> {
    let bodies = bodies::of(equations);
    let spins: std::collections::BTreeMap<Id, Id> = places_of_spins(&mut equations.pool, &bodies);
    equations.rewrite(&|pool, ids| exchange(pool, ids, &spins));
    let starts = starts(equations);
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let environment = Environment { states: &starts, parameters: &parameters, ..Environment::default() };
    let hinges = joints::of(equations, &bodies, &environment);
    let hinges = spanning(hinges);
    if hinges.is_empty() || is_planar(&hinges) {
        return None;
    }
    let rows: BTreeSet<usize> = hinges.iter().flat_map(|hinge| hinge.rows.iter().copied()).collect();
    // Rows that close loops, stops and dry friction are not told their mobilities yet.
    if rows.len() != equations.reactions.len() {
        return None;
    }
    let gone: BTreeSet<Symbol> = rows.iter().map(|&row| equations.reactions[row].multiplier).collect();
    let of_bodies: BTreeSet<usize> = hinges.iter().flat_map(|hinge| states_of(&bodies[hinge.child])).collect();
    if is_read(equations, &gone, &of_bodies) {
        return None;
    }
    let zero = equations.pool.zero();
    let unknown = equations.pool.number(f64::NAN);
    // The momenta's rates without the tree's reactions, which work on no motion of it.
    let momenta: Vec<usize> = of_bodies.iter().copied().collect();
    let rates: Vec<Id> = momenta.iter().map(|&state| equations.states[state].rate).collect();
    let rates = substitute(&mut equations.pool, &rates, &|symbol| gone.contains(&symbol).then_some(zero));
    for (&state, rate) in momenta.iter().zip(rates) {
        equations.states[state].rate = rate;
    }
    equations.reactions.clear();
    // Pictures show no reaction of the tree.
    equations.shown.replace(
        &mut equations.pool,
        &|symbol| gone.contains(&symbol).then_some(unknown),
        &crate::expr::Branch::Kept,
    );
    let coordinates = motion::coordinates(&mut equations.pool, 6 * bodies.len() + 16, hinges.len());
    motion::recognise(equations, &bodies, &hinges, &coordinates);
    let links = links::of(&mut equations.pool, &bodies, &hinges);
    let (moved, ground) = loads(equations, &bodies, &links, &coordinates);
    let rates = recursion::rates(&mut equations.pool, &links, &moved, &ground);
    let starts = motion::starts(equations, &bodies, &hinges);
    motion::energies(equations, &bodies, &links, &moved);
    let images = motion::images(&mut equations.pool, &bodies, &links, &moved);
    let mut kept = vec![true; equations.states.len()];
    let mut names = Vec::new();
    for (k, hinge) in hinges.iter().enumerate() {
        let body = &bodies[hinge.child];
        for state in states_of(body) {
            kept[state] = false;
            report.say(state, Fate::Joined(hinge.name.clone()));
        }
        let Origin::Orientation(track, ..) = equations.states[body.axes[0]].origin else { return None };
        let angle = State {
            name: format!("{}.q", hinge.name),
            unit: "rad".to_owned(),
            origin: Origin::Hinge(track),
            start: starts[k][0],
            rate: coordinates[k].speed,
        };
        let speed = State {
            name: format!("{}.u", hinge.name),
            unit: "rad/s".to_owned(),
            origin: Origin::Speed(track),
            start: starts[k][1],
            rate: rates[k],
        };
        for (state, new) in [(body.axes[0], angle), (body.angular[0], speed)] {
            kept[state] = true;
            report.rename(state, new.clone());
            report.say(state, Fate::Integrated);
            equations.states[state] = new;
            names.push(state);
        }
    }
    equations.projections.retain(|(state, _)| !of_bodies.contains(state));
    equations.replace(&|symbol| images.get(&symbol).copied());
    let places: std::collections::BTreeMap<Symbol, Id> = coordinates
        .iter()
        .flat_map(|own| [own.angle, own.speed])
        .zip(names)
        .map(|(id, state)| {
            let symbol = *equations.pool.symbols(&[id]).first().expect("a coordinate is a symbol");
            (symbol, equations.pool.symbol(Symbol::state(state)))
        })
        .collect();
    equations.replace(&|symbol| places.get(&symbol).copied());
    super::live::keep_states(equations, report, &kept);
    Some(())
}

/// The states of a body.
fn states_of(body: &Body) -> impl Iterator<Item = usize> + use<> {
    let body = body.clone();
    body.place.into_iter().chain(body.axes).chain(body.linear).chain(body.angular)
}

/// A symbol in the place of each angular velocity.
fn places_of_spins(pool: &mut Pool, bodies: &[Body]) -> std::collections::BTreeMap<Id, Id> {
    let mut places = std::collections::BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        for (k, &spin) in body.spin.iter().enumerate() {
            let symbol = pool.symbol(velocity(index, 3 + k));
            // A scaled node is in other nodes as the node.
            let (node, factor) = match pool.node(spin) {
                crate::expr::Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => {
                    (terms[0].0, terms[0].1.value())
                }
                _ => (spin, 1.0),
            };
            places.insert(node, pool.scale(1.0 / factor, symbol));
        }
    }
    places
}

/// The values of the states at the start, with the defaults of parameters and the first guesses.
fn starts(equations: &StateEquations) -> Vec<f64> {
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let given = Environment { parameters: &parameters, ..Environment::default() };
    let unknowns = evaluate(&equations.pool, &equations.guesses, &given);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    evaluate(&equations.pool, &starts, &Environment { unknowns: &unknowns, ..given })
}

/// Hinges by which bodies hang on the ground, parents first.
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
    let switched = equations.reactions.iter().filter_map(|reaction| reaction.switched.as_ref());
    let efforts = switched.flat_map(|switched| [switched.effort, switched.acts]);
    let slips = equations.reactions.iter().map(|reaction| &reaction.slip);
    let slips = slips.flat_map(|slip| [slip.flow].into_iter().chain(slip.gap));
    let loops = equations.iterations.iter().flat_map(|iteration| iteration.residuals.iter().copied());
    let laws = equations.fallible.iter().map(|law| law.value);
    let all = rates.chain(outputs).chain(guards).chain(powers).chain(efforts).chain(slips).chain(loops).chain(laws);
    equations.pool.symbols(&all.collect::<Vec<_>>()).iter().any(|symbol| gone.contains(symbol))
}

/// What moves each link, and the acceleration of the ground that stands for the weights of all.
fn loads(
    equations: &mut StateEquations,
    bodies: &[Body],
    links: &[Link],
    coordinates: &[motion::Coordinate],
) -> (Vec<Moved>, Value) {
    let StateEquations { pool, states, .. } = equations;
    let zero = pool.zero();
    let mut forces: Vec<[Value; 2]> = links
        .iter()
        .map(|link| {
            let body = &bodies[link.hinge.child];
            [&body.angular, &body.linear].map(|of| Value(of.iter().map(|&state| states[state].rate).collect()))
        })
        .collect();
    let falls: Vec<Value> = links
        .iter()
        .zip(&forces)
        .map(|(link, [_, force])| {
            let constant: Vec<Id> = force.0.iter().map(|&id| constant_part(pool, id)).collect();
            Value(constant).divide(pool, link.mass)
        })
        .collect();
    let is_one = falls.iter().all(|fall| *fall == falls[0]);
    let fall = if is_one { falls[0].clone() } else { Value(vec![zero; 3]) };
    for (link, force) in links.iter().zip(&mut forces) {
        let weight = fall.scaled(pool, link.mass).negate(pool);
        force[1] = force[1].add(pool, &weight);
    }
    let mut torques = vec![zero; links.len()];
    for k in (0..links.len()).rev() {
        torques[k] = torque(pool, bodies, links, &mut forces, k);
    }
    let mut moved: Vec<Moved> = Vec::new();
    let mut axes: Vec<Value> = Vec::new();
    for (k, link) in links.iter().enumerate() {
        let [cosine, sine] = [Function::Cos, Function::Sin].map(|of| pool.call(of, &[coordinates[k].angle]));
        let still = [Value(vec![zero; 3]), Value(vec![zero; 3])];
        let mut own = Moved { cosine, sine, speed: coordinates[k].speed, torque: torques[k], load: still };
        axes.push(motion::axes(pool, links, &axes, k, &own));
        let back = axes[k].transpose();
        let [moment, force] = &forces[k];
        let force = back.multiply(pool, force);
        let arm = link.centre.cross(pool, &force);
        let moment = back.multiply(pool, moment).add(pool, &arm);
        own.load = [moment, force];
        moved.push(own);
    }
    (moved, fall.negate(pool))
}

/// What of a sum depends on parameters alone.
fn constant_part(pool: &mut Pool, of: Id) -> Id {
    if is_constant(pool, of) {
        return of;
    }
    let crate::expr::Node::Sum { constant, terms } = pool.node(of).clone() else { return pool.zero() };
    let parts: Vec<(Id, f64)> =
        terms.iter().filter(|(term, _)| is_constant(pool, *term)).map(|(term, by)| (*term, by.value())).collect();
    pool.linear(constant.value(), &parts)
}

/// The torque about a hinge: what the moments of both bodies have opposite to each other, along its axis. It is taken
/// out of these.
fn torque(pool: &mut Pool, bodies: &[Body], links: &[Link], forces: &mut [[Value; 2]], of: usize) -> Id {
    let link = &links[of];
    let axis = numbers::constant(pool, &numbers::column(&link.hinge.frames[0], 2));
    let axis = match link.hinge.parent {
        Some(parent) => bodies::symbols(pool, &bodies[parent].axes).multiply(pool, &axis),
        None => axis,
    };
    let lead = (0..3).find(|&k| !pool.is_zero(axis.0[k])).unwrap_or(0);
    let terms = |pool: &Pool, id: Id| -> Vec<(Id, f64)> {
        match pool.node(id) {
            crate::expr::Node::Sum { terms, .. } => terms.iter().map(|(term, by)| (*term, by.value())).collect(),
            crate::expr::Node::Number(_) => Vec::new(),
            _ => vec![(id, 1.0)],
        }
    };
    let mut torques = Vec::new();
    for (term, by) in terms(pool, forces[of][0].0[lead]) {
        let effort = pool.div(term, axis.0[lead]);
        let effort = pool.scale(by, effort);
        let all: Vec<Id> = axis.0.iter().map(|&part| pool.mul(effort, part)).collect();
        let has = |pool: &mut Pool, moment: &Value, sign: f64| {
            all.iter().zip(&moment.0).all(|(&part, &sum)| {
                let wanted = pool.scale(sign, part);
                let wanted = terms(pool, wanted);
                wanted.iter().all(|one| terms(pool, sum).contains(one))
            })
        };
        let on_parent = link.parent.map(|parent| forces[parent][0].clone());
        if !has(pool, &forces[of][0].clone(), 1.0) || on_parent.is_some_and(|moment| !has(pool, &moment, -1.0)) {
            continue;
        }
        torques.push(effort);
        let all = Value(all);
        let back = all.negate(pool);
        forces[of][0] = forces[of][0].add(pool, &back);
        if let Some(parent) = link.parent {
            forces[parent][0] = forces[parent][0].add(pool, &all);
        }
    }
    pool.sum(&torques)
}

#[cfg(test)]
mod tests;
