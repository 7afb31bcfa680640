//! Poses, velocities and energies of bodies by the coordinates of hinges.
//!
//! In: bodies, links. Out: an expression for each state and velocity of a body; what reads two bodies by their relative
//! motion alone written by the hinge between them. Method of the latter: such a node is the same whatever the pose and
//! the motion of the parent are; it is proved for a rotation of four symbols, by the polynomial identity.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, symbols, velocity};
use super::joints::{Hinge, Probe};
use super::links::Link;
use super::numbers;
use super::recursion::{Moved, down, spins};
use crate::expr::{Function, Id, Node, Pool, Symbol, children, exchange, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::StateEquations;

/// The angle of a hinge and its speed, as symbols of no state yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub angle: Id,
    pub speed: Id,
}

/// Symbols for as many hinges, from this number on.
pub(super) fn coordinates(pool: &mut Pool, first: usize, count: usize) -> Vec<Coordinate> {
    let mut symbol = |k: usize| pool.symbol(Symbol::numbered(Symbol::Weight, first + k));
    (0..count).map(|k| Coordinate { angle: symbol(2 * k), speed: symbol(2 * k + 1) }).collect()
}

/// The bodies that a node reads; none where it reads something else or many.
type Reads = Option<BTreeSet<usize>>;

/// Writes what reads two bodies by their relative motion alone by the hinge between them.
pub(super) fn recognise(equations: &mut StateEquations, bodies: &[Body], hinges: &[Hinge], coordinates: &[Coordinate]) {
    let mut owner: BTreeMap<Symbol, usize> = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        owner.extend((0..6).map(|k| (velocity(index, k), index)));
        let states = body.place.iter().chain(&body.axes);
        owner.extend(states.map(|&state| (Symbol::state(state), index)));
    }
    equations.rewrite(&|pool, ids| {
        let mut reads: BTreeMap<Id, Reads> = BTreeMap::new();
        let mut found: BTreeMap<BTreeSet<usize>, Vec<Id>> = BTreeMap::new();
        for id in pool.reachable(ids) {
            let own = match pool.node(id) {
                Node::Number(_) => Some(BTreeSet::new()),
                Node::Symbol(symbol) => owner.get(symbol).map(|&body| BTreeSet::from([body])),
                Node::Select { .. } => None,
                node => children(node).try_fold(BTreeSet::new(), |mut all, child| {
                    all.extend(reads[&child].as_ref()?.iter().copied());
                    (all.len() <= 2).then_some(all)
                }),
            };
            if let Some(own) = own.as_ref().filter(|own| own.len() == 2)
                && matches!(pool.node(id), Node::Sum { .. })
            {
                found.entry(own.clone()).or_default().push(id);
            }
            reads.insert(id, own);
        }
        let mut places = BTreeMap::new();
        for (hinge, own) in hinges.iter().zip(coordinates) {
            let Some(parent) = hinge.parent else { continue };
            let Some(nodes) = found.get(&BTreeSet::from([parent, hinge.child])) else { continue };
            let probe = Probe::new(pool, 6 * bodies.len());
            let rotation = probe.rotation.clone();
            let unit = Value::identity(pool);
            let anyhow = hinge.motion(pool, bodies, &probe, Some(&rotation));
            let mut still = hinge.motion(pool, bodies, &probe, Some(&unit));
            let zero = pool.zero();
            let at_rest = bodies[parent].place.iter().map(|&state| Symbol::state(state));
            let at_rest: Vec<Symbol> = at_rest.chain((0..6).map(|k| velocity(parent, k))).collect();
            for image in still.values_mut() {
                *image = substitute(pool, &[*image], &|symbol| at_rest.contains(&symbol).then_some(zero))[0];
            }
            still.extend(at_rest.iter().map(|&symbol| (symbol, zero)));
            let [cosine, sine] = [Function::Cos, Function::Sin].map(|of| pool.call(of, &[own.angle]));
            let by = |symbol: Symbol| match symbol {
                _ if symbol == probe.cosine => Some(cosine),
                _ if symbol == probe.sine => Some(sine),
                _ if symbol == probe.rate => Some(own.speed),
                _ => None,
            };
            for &node in nodes {
                let simple = substitute(pool, &[node], &|symbol| still.get(&symbol).copied())[0];
                let any = substitute(pool, &[node], &|symbol| anyhow.get(&symbol).copied())[0];
                if pool.cost(&[simple]) < pool.cost(&[node]) && same_polynomial(pool, simple, any) {
                    places.insert(node, substitute(pool, &[simple], &by)[0]);
                }
            }
        }
        exchange(pool, ids, &places)
    });
}

/// The axes of a link in inertial axes, from those of the links before it.
pub(super) fn axes(pool: &mut Pool, links: &[Link], before: &[Value], index: usize, own: &Moved) -> Value {
    let link = &links[index];
    let minus = pool.neg(own.sine);
    let (zero, one) = (pool.zero(), pool.one());
    let turn = Value(vec![own.cosine, minus, zero, own.sine, own.cosine, zero, zero, zero, one]);
    let fixed = match link.parent {
        Some(parent) => before[parent].multiply(pool, &link.fixed),
        None => link.fixed.clone(),
    };
    fixed.multiply(pool, &turn)
}

/// Each state and velocity of the bodies.
pub(super) fn images(
    pool: &mut Pool,
    bodies: &[Body],
    links: &[Link],
    moved: &[Moved],
    Velocities { spins, centres }: &Velocities,
) -> BTreeMap<Symbol, Id> {
    let mut images = BTreeMap::new();
    let mut all: Vec<Value> = Vec::new();
    let mut origins: Vec<Value> = Vec::new();
    for (k, link) in links.iter().enumerate() {
        let own = axes(pool, links, &all, k, &moved[k]);
        let origin = match link.parent {
            Some(parent) => {
                let offset = all[parent].multiply(pool, &link.offset);
                origins[parent].add(pool, &offset)
            }
            None => link.offset.clone(),
        };
        let centre = own.multiply(pool, &link.centre);
        let place = origin.add(pool, &centre);
        let turned = own.multiply(pool, &link.axes.transpose());
        let velocity_there = own.multiply(pool, &centres[k]);
        let momentum = velocity_there.multiply(pool, &Value::scalar(link.mass));
        let spin = own.multiply(pool, &spins[k]);
        let inside = link.central.multiply(pool, &spins[k]);
        let angular = own.multiply(pool, &inside);
        let index = link.hinge.child;
        let body = &bodies[index];
        for (states, values) in [
            (&body.place[..], &place),
            (&body.axes[..], &turned),
            (&body.linear[..], &momentum),
            (&body.angular[..], &angular),
        ] {
            images.extend(states.iter().map(|&state| Symbol::state(state)).zip(values.0.iter().copied()));
        }
        let motion = velocity_there.0.iter().chain(&spin.0).copied();
        images.extend((0..6).map(|k| velocity(index, k)).zip(motion));
        all.push(own);
        origins.push(origin);
    }
    images
}

/// How links move, in their axes.
pub(super) struct Velocities {
    /// The angular velocities.
    pub spins: Vec<Value>,
    /// The velocities of the centres of mass.
    pub centres: Vec<Value>,
}

impl Velocities {
    pub fn of(pool: &mut Pool, links: &[Link], moved: &[Moved]) -> Self {
        let spins = spins(pool, links, moved);
        let mut origins: Vec<Value> = Vec::new();
        let mut centres = Vec::new();
        for (k, link) in links.iter().enumerate() {
            let origin = match link.parent {
                Some(parent) => {
                    let beside = spins[parent].cross(pool, &link.offset);
                    let there = origins[parent].add(pool, &beside);
                    down(pool, link, &moved[k], &there)
                }
                None => Value::zero(pool, 3),
            };
            let beside = spins[k].cross(pool, &link.centre);
            centres.push(origin.add(pool, &beside));
            origins.push(origin);
        }
        Self { spins, centres }
    }
}

/// Writes the kinetic energies in the links' axes.
pub(super) fn energies(
    equations: &mut StateEquations,
    bodies: &[Body],
    links: &[Link],
    Velocities { spins, centres }: &Velocities,
) {
    let pool = &mut equations.pool;
    for (k, link) in links.iter().enumerate() {
        let body = &bodies[link.hinge.child];
        let fast = centres[k].dot(pool, &centres[k]);
        let fast = pool.mul(fast, link.mass);
        let inside = link.central.multiply(pool, &spins[k]);
        let turning = spins[k].dot(pool, &inside);
        let momentum = symbols(pool, &body.linear);
        let square = momentum.dot(pool, &momentum);
        let by_momentum = pool.div(square, body.mass);
        let (axes, angular) = (symbols(pool, &body.axes), symbols(pool, &body.angular));
        let own = axes.transpose().multiply(pool, &angular);
        let mobile = body.mobility.multiply(pool, &own);
        let by_angular = own.dot(pool, &mobile);
        for (states, old, new) in [(&body.linear[..], by_momentum, fast), (&body.angular[..], by_angular, turning)] {
            let [old, new] = [old, new].map(|id| pool.scale(0.5, id));
            for energy in &mut equations.energies {
                let reads = pool.symbols(&[*energy]);
                if states.iter().any(|&state| reads.contains(&Symbol::state(state)))
                    && same_polynomial(pool, *energy, old)
                {
                    *energy = new;
                }
            }
        }
    }
}

/// The angle and the speed of each hinge at the start.
pub(super) fn starts(equations: &mut StateEquations, bodies: &[Body], hinges: &[Hinge]) -> Vec<[Id; 2]> {
    let StateEquations { pool, states, .. } = equations;
    let at_start = |pool: &mut Pool, ids: &[Id]| {
        Value(substitute(pool, ids, &|symbol| symbol.as_state().map(|state| states[state].start)))
    };
    let mut starts = Vec::new();
    for hinge in hinges {
        let of = |pool: &mut Pool, body: Option<usize>| match body {
            Some(body) => {
                let axes = Value(bodies[body].axes.iter().map(|&state| states[state].start).collect());
                (axes, at_start(pool, &bodies[body].spin))
            }
            None => (Value::identity(pool), Value::zero(pool, 3)),
        };
        let ((parent, before), (child, spin)) = (of(pool, hinge.parent), of(pool, Some(hinge.child)));
        let frames = hinge.frames.map(|frame| numbers::matrix(pool, &frame));
        let parent = parent.multiply(pool, &frames[0]);
        let relative = parent.transpose().multiply(pool, &child).multiply(pool, &frames[1]);
        let angle = pool.call(Function::Atan2, &[relative.0[3], relative.0[0]]);
        let before = before.negate(pool);
        let relative = spin.add(pool, &before);
        let axis = Value(vec![parent.0[2], parent.0[5], parent.0[8]]);
        starts.push([angle, axis.dot(pool, &relative)]);
    }
    starts
}
