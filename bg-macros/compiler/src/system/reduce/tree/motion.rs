//! Poses, velocities and energies of bodies by the coordinates of joints.
//!
//! In: bodies, links with their moves. Out: an expression for each state and velocity of a body, the rates of momenta
//! that bodies keep, kinetic energies, starts.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, symbols, velocity};
use super::joints::{Joint, Kind};
use super::links::Seat;
use super::loads::Tree;
use super::numbers;
use super::recursion::Accelerations;
use crate::expr::{Function, Id, Pool, Symbol, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::link::{Freedom, Link, Moved, Moves, down};
use crate::system::rigid::{rate_of_angular, spins};

/// The coordinates of the steps of all joints, from this symbol on: two for each step.
pub(super) fn coordinates(pool: &mut Pool, first: usize, joints: &[Joint]) -> Vec<Vec<Moves>> {
    let mut number = first;
    let mut symbol = |pool: &mut Pool| {
        number += 1;
        pool.symbol(Symbol::numbered(Symbol::Weight, number - 1))
    };
    let mut moves = |pool: &mut Pool, freedom: Freedom| {
        let [place, speed] = [symbol(pool), symbol(pool)];
        let [cosine, sine] = match freedom {
            Freedom::Turn => [Function::Cos, Function::Sin].map(|of| pool.call(of, &[place])),
            _ => [pool.one(), pool.zero()],
        };
        Moves { place, cosine, sine, speed }
    };
    joints.iter().map(|joint| joint.steps().iter().map(|step| moves(pool, step.freedom)).collect()).collect()
}

/// The axes of a link in inertial axes, from those of the links before it.
pub(super) fn axes(pool: &mut Pool, links: &[Link], before: &[Value], index: usize, own: &Moves) -> Value {
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

/// Where links and bodies are and how they move.
pub(super) struct Motion {
    /// The axes of the links in inertial axes.
    pub axes: Vec<Value>,
    /// The origins of the links.
    origins: Vec<Value>,
    /// The angular velocities of the links, in their axes.
    pub spins: Vec<Value>,
    /// The velocities of the bodies' centres of mass, in the axes of their links; in the order of the seats.
    centres: Vec<Value>,
}

impl Motion {
    pub fn of(pool: &mut Pool, links: &[Link], seats: &[Seat], moved: &[Moved], axes: Vec<Value>) -> Self {
        let spins = spins(pool, links, moved);
        let (mut origins, mut velocities): (Vec<Value>, Vec<Value>) = (Vec::new(), Vec::new());
        for (k, link) in links.iter().enumerate() {
            let offset = &moved[k].offset;
            let (origin, there) = match link.parent {
                Some(parent) => {
                    let by = axes[parent].multiply(pool, offset);
                    let beside = spins[parent].cross(pool, offset);
                    let there = velocities[parent].add(pool, &beside);
                    (origins[parent].add(pool, &by), down(pool, link, &moved[k], &there))
                }
                None => (offset.clone(), Value::zero(pool, 3)),
            };
            let mut there = moved[k].own.as_ref().and_then(|own| own.fast.clone()).unwrap_or(there);
            if link.freedom == Freedom::Slide {
                there.0[2] = pool.add(there.0[2], moved[k].moves.speed);
            }
            origins.push(origin);
            velocities.push(there);
        }
        let centre = |pool: &mut Pool, seat: &Seat| match seat.link {
            Some(link) => {
                let beside = spins[link].cross(pool, &seat.centre);
                velocities[link].add(pool, &beside)
            }
            None => Value::zero(pool, 3),
        };
        let centres = seats.iter().map(|seat| centre(pool, seat)).collect();
        Self { axes, origins, spins, centres }
    }

    /// Each of the states that joints give, and the velocities of the bodies.
    pub fn images(
        &self,
        pool: &mut Pool,
        bodies: &[Body],
        seats: &[Seat],
        given: &BTreeSet<usize>,
    ) -> BTreeMap<Symbol, Id> {
        let mut images = BTreeMap::new();
        for (seat, centre) in seats.iter().zip(&self.centres) {
            let (own, origin, spin) = match seat.link {
                Some(link) => (self.axes[link].clone(), self.origins[link].clone(), self.spins[link].clone()),
                None => (Value::identity(pool), Value::zero(pool, 3), Value::zero(pool, 3)),
            };
            let body = &bodies[seat.body];
            let there = own.multiply(pool, &seat.centre);
            let place = origin.add(pool, &there);
            let turned = own.multiply(pool, &seat.axes.transpose());
            let fast = own.multiply(pool, centre);
            let momentum = fast.multiply(pool, &Value::scalar(body.mass));
            let inside = seat.central.multiply(pool, &spin);
            let angular = own.multiply(pool, &inside);
            let spin = own.multiply(pool, &spin);
            for (states, values) in [
                (&body.place[..], &place),
                (&body.axes[..], &turned),
                (&body.linear[..], &momentum),
                (&body.angular[..], &angular),
            ] {
                let states = states.iter().zip(&values.0).filter(|(state, _)| given.contains(state));
                images.extend(states.map(|(&state, &id)| (Symbol::state(state), id)));
            }
            let motion = fast.0.iter().chain(&spin.0).copied();
            images.extend((0..6).map(|k| velocity(seat.body, k)).zip(motion));
        }
        images
    }

    /// The rates of the momenta that bodies keep, with these angular velocities and accelerations of the links.
    pub fn rates(
        &self,
        pool: &mut Pool,
        tree: &Tree<'_>,
        (spins, accelerations): (&[Value], &Accelerations),
        ground: &Value,
    ) -> Vec<(usize, Id)> {
        let mut rates: Vec<(usize, Id)> = Vec::new();
        for seat in tree.seats {
            let Some(link) = seat.link.filter(|&link| !tree.links[link].freedom.has_coordinate()) else { continue };
            if tree.joints[tree.links[link].step.0].child != seat.body {
                continue;
            }
            let body = &tree.bodies[seat.body];
            let [turning, there] = &accelerations.links[link];
            let angular = rate_of_angular(pool, &seat.central, &spins[link], turning);
            let angular = self.axes[link].multiply(pool, &angular);
            rates.extend(body.angular.into_iter().zip(angular.0));
            if tree.links[link].freedom == Freedom::Free {
                let falls = ground.negate(pool);
                let linear = self.axes[link].multiply(pool, there).add(pool, &falls);
                let linear = linear.multiply(pool, &Value::scalar(body.mass));
                rates.extend(body.linear.into_iter().zip(linear.0));
            }
        }
        rates
    }

    /// Writes the kinetic energies in the links' axes.
    pub fn energies(&self, equations: &mut StateEquations, bodies: &[Body], seats: &[Seat]) {
        let pool = &mut equations.pool;
        for (seat, centre) in seats.iter().zip(&self.centres) {
            let Some(link) = seat.link else { continue };
            let body = &bodies[seat.body];
            let spin = &self.spins[link];
            let fast = centre.dot(pool, centre);
            let fast = pool.mul(fast, body.mass);
            let inside = seat.central.multiply(pool, spin);
            let turning = spin.dot(pool, &inside);
            let momentum = symbols(pool, &body.linear);
            let square = momentum.dot(pool, &momentum);
            let by_momentum = pool.div(square, body.mass);
            let (axes, angular) = (symbols(pool, &body.axes), symbols(pool, &body.angular));
            let own = axes.transpose().multiply(pool, &angular);
            let mobile = body.mobility.multiply(pool, &own);
            let by_angular = own.dot(pool, &mobile);
            for (states, old, new) in [(&body.linear[..], by_momentum, fast), (&body.angular[..], by_angular, turning)]
            {
                let [old, new] = [old, new].map(|id| pool.scale(0.5, id));
                for energy in &mut equations.balance.energies {
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
}

/// The place and the speed of each step of a joint at the start.
pub(super) fn starts(equations: &mut StateEquations, bodies: &[Body], joint: &Joint) -> Vec<[Id; 2]> {
    let StateEquations { pool, states, .. } = equations;
    let at_start = |pool: &mut Pool, ids: &[Id]| {
        Value(substitute(pool, ids, &|symbol| symbol.as_state().map(|state| states[state].start)))
    };
    let of = |of: &[usize]| Value(of.iter().map(|&state| states[state].start).collect());
    let end = |pool: &mut Pool, body: Option<usize>| match body {
        Some(body) => {
            let body = &bodies[body];
            let speed = of(&body.linear).divide(pool, body.mass);
            [of(&body.axes), at_start(pool, &body.spin), of(&body.place), speed]
        }
        None => [Value::identity(pool), Value::zero(pool, 3), Value::zero(pool, 3), Value::zero(pool, 3)],
    };
    let ([parent, before, from, carried], [child, spin, to, moved]) =
        (end(pool, joint.parent), end(pool, Some(joint.child)));
    let [own_parent, own_child] = joint.frames.map(|frame| numbers::matrix(pool, &frame));
    let [first, second] = [parent.multiply(pool, &own_parent), child.multiply(pool, &own_child)];
    let apart = |pool: &mut Pool, a: &Value, b: &Value| {
        let back = b.negate(pool);
        a.add(pool, &back)
    };
    let turned = first.transpose().multiply(pool, &second).0;
    let turning = apart(pool, &spin, &before);
    let third = |of: &Value| Value(numbers::column(&of.0.clone().try_into().expect("nine entries"), 2).to_vec());
    let (axis, last) = (third(&first), third(&second));
    let turn = |pool: &mut Pool, sine: usize, cosine: usize, axis: &Value| {
        let angle = match joint.angle {
            Some(state) => states[state].start,
            None => pool.call(Function::Atan2, &[turned[sine], turned[cosine]]),
        };
        [angle, axis.dot(pool, &turning)]
    };
    let slide = |pool: &mut Pool| {
        let [arm, there] = [parent.multiply(pool, &joint.at[0]), child.multiply(pool, &joint.at[1])];
        let to = to.add(pool, &there);
        let reach = apart(pool, &to, &from);
        let gap = apart(pool, &reach, &arm);
        let [spun, carrying] = [spin.cross(pool, &there), before.cross(pool, &reach)];
        let [fast, still] = [moved.add(pool, &spun), carried.add(pool, &carrying)];
        let relative = apart(pool, &fast, &still);
        [axis.dot(pool, &gap), axis.dot(pool, &relative)]
    };
    match joint.kind {
        Kind::Revolute => vec![turn(pool, 3, 0, &axis)],
        Kind::Prismatic => vec![slide(pool)],
        Kind::Cylindrical => vec![slide(pool), turn(pool, 3, 0, &axis)],
        Kind::Universal => vec![turn(pool, 5, 2, &axis), turn(pool, 6, 7, &last)],
        Kind::Angles => {
            let [x, y, z] = [2, 5, 8].map(|k| turned[k]);
            let spin = first.transpose().multiply(pool, &turning).0;
            let squares = [pool.powi(x, 2), pool.powi(y, 2)];
            let square = pool.sum(&squares);
            let across = pool.call(Function::Sqrt, &[square]);
            let (back, over) = (pool.neg(x), pool.neg(turned[7]));
            let angles = [[back, y], [z, across], [over, turned[6]]].map(|of| pool.call(Function::Atan2, &of));
            let parts = [pool.mul(spin[0], x), pool.mul(spin[1], y), pool.mul(spin[0], y), pool.mul(spin[1], x)];
            let (along, beside) = (pool.add(parts[0], parts[1]), pool.sub(parts[2], parts[3]));
            let (third, second) = (pool.div(along, square), pool.div(beside, across));
            let carried = pool.mul(z, third);
            let speeds = [pool.sub(spin[2], carried), second, third];
            angles.into_iter().zip(speeds).map(|(angle, speed)| [angle, speed]).collect()
        }
        Kind::Spherical | Kind::Fixed | Kind::Floating => Vec::new(),
    }
}
