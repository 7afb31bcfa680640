//! The accelerations of a tree of links.
//!
//! In: links with their moves, loads on each. Out: the rate of each speed. Method: articulated bodies
//! (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 7), in the axes of each link. Accelerations are those
//! of the links' origins, so that no velocity of a point is needed; what turning does is linear in the six products of
//! an angular velocity's components. Gravity is an acceleration of the ground. What links do while all speeds stay as
//! they are is found first, from ground to tip; the wrenches that this takes are all that velocities do, so that the
//! way from tip to ground and back is one of links at rest. Which of the two ways has gravity is chosen by operations.

use crate::expr::{Id, Pool};
use crate::system::Value;
use crate::system::equations::definite::Factors;
use crate::system::link::{Freedom, Link, Locked, Moved, down, matrix_up, up};
use crate::system::rigid::{Accelerated, Given, LinkMotion, brought};

/// A moment is J a + H b + n, a force H^T a + M b + f, by the angular acceleration a and the acceleration b.
#[derive(Clone, Debug)]
struct Articulated {
    /// J, H, M.
    inertia: [Value; 3],
    /// n, f.
    bias: [Value; 2],
}

/// What is known of a link on the way back.
#[derive(Clone, Debug)]
enum Known {
    /// Of a freedom with a coordinate.
    Step {
        /// By how much the speed's rate falls with the parent's accelerations.
        by: [Value; 2],
        rate: Id,
    },
    /// The angular acceleration is this vector less this matrix by the acceleration of the origin.
    Ball(Value, Value),
    /// The accelerations.
    Free([Value; 2]),
}

/// How links are accelerated.
pub(super) struct Accelerations {
    /// The rates of the speeds; zero of a link that has none of its own.
    pub rates: Vec<Id>,
    /// The angular acceleration, and that of the origin beside the ground's, in the link's axes.
    pub links: Vec<[Value; 2]>,
    /// Of a link that may be locked the effort along its freedom that holds it.
    pub needed: Vec<Option<Id>>,
}

/// When the acceleration of the ground is counted that stands for weights.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Ground {
    /// From ground to tip, with what links do while speeds stay as they are: fewer operations in arms.
    First,
    /// On the way back: fewer where few links carry each other.
    Last,
}

/// How links are accelerated that have these angular velocities, where the ground has this acceleration.
pub(super) fn accelerations(
    pool: &mut Pool,
    links: &[Link],
    (moved, spins): (&[Moved], &[Value]),
    (ground, when): (&Value, Ground),
) -> Accelerations {
    let zero = pool.zero();
    let still = Value(vec![zero; 3]);
    let [first, last] = if when == Ground::First { [ground, &still] } else { [&still, ground] };
    let own = |k: usize| match links[k].freedom {
        Freedom::Turn | Freedom::Slide => Given::Rate(zero),
        Freedom::Ball => Given::Accelerations(still.clone(), None),
        Freedom::Free => Given::Accelerations(still.clone(), Some(still.clone())),
    };
    let steady = Accelerated::of(pool, links, (moved, spins), first, own);
    let mut bodies: Vec<Articulated> = Vec::new();
    for (k, link) in links.iter().enumerate() {
        bodies.push(rigid(pool, link, &moved[k], steady.motion(k)));
    }
    let mut all: Vec<Option<Known>> = vec![None; links.len()];
    for k in (0..links.len()).rev() {
        let (link, own) = (&links[k], &moved[k]);
        let (known, left) = match link.freedom {
            Freedom::Turn | Freedom::Slide => release(pool, link.freedom, &bodies[k], own),
            Freedom::Ball => release_ball(pool, &bodies[k]),
            Freedom::Free => {
                all[k] = Some(Known::Free(bodies[k].alone(pool)));
                continue;
            }
        };
        all[k] = Some(known);
        if let Some(parent) = link.parent {
            let carried = carried(pool, link, own, left);
            let both = bodies[parent].clone();
            bodies[parent] = both.add(pool, &carried);
        }
    }
    // Beside what is there while all speeds stay as they are.
    let mut beside: Vec<[Value; 2]> = Vec::new();
    let (mut rates, mut needed) = (Vec::new(), Vec::new());
    for (k, link) in links.iter().enumerate() {
        let [turning, mut there] = match link.parent {
            Some(parent) => brought(pool, link, &moved[k], &beside[parent]),
            None => [still.clone(), down(pool, link, &moved[k], last)],
        };
        needed.push(None);
        let (rate, turning) = match all[k].clone().expect("every link is gone through") {
            Known::Step { by, rate } => {
                let mut turning = turning;
                let locked = moved[k].locked;
                needed[k] = locked.map(|locked| bodies[k].effort(pool, link.freedom, [&turning, &there], locked.rate));
                let parts = [by[0].dot(pool, &turning), by[1].dot(pool, &there)];
                let rate = pool.linear(0.0, &[(rate, 1.0), (parts[0], -1.0), (parts[1], -1.0)]);
                let along = if link.freedom == Freedom::Turn { &mut turning } else { &mut there };
                along.0[2] = pool.add(along.0[2], rate);
                (rate, turning)
            }
            Known::Ball(still, by) => {
                let by = by.multiply(pool, &there).negate(pool);
                (pool.zero(), still.add(pool, &by))
            }
            Known::Free([turning, own]) => {
                there = own;
                (pool.zero(), turning)
            }
        };
        rates.push(rate);
        beside.push([turning, there]);
    }
    let both = |(steady, beside): (&[Value; 2], &[Value; 2])| [0, 1].map(|k| steady[k].add(pool, &beside[k]));
    let links = steady.links.iter().zip(&beside).map(both).collect();
    Accelerations { rates, links, needed }
}

impl Articulated {
    fn add(&self, pool: &mut Pool, other: &Self) -> Self {
        let inertia = std::array::from_fn(|k| self.inertia[k].add(pool, &other.inertia[k]));
        let bias = std::array::from_fn(|k| self.bias[k].add(pool, &other.bias[k]));
        Self { inertia, bias }
    }

    /// The effort along a freedom that gives its speed this rate, where the link has these accelerations beside.
    fn effort(&self, pool: &mut Pool, freedom: Freedom, [turning, there]: [&Value; 2], rate: Id) -> Id {
        let (block, by) = (block_of(freedom), self.by_speed(freedom));
        let along = by[block].0[2];
        let parts = [by[0].dot(pool, turning), by[1].dot(pool, there), pool.mul(along, rate), self.bias[block].0[2]];
        pool.sum(&parts)
    }

    /// Moment and force by the rate of the speed of a freedom.
    fn by_speed(&self, freedom: Freedom) -> [Value; 2] {
        let [turning, coupling, pushing] = &self.inertia;
        let third = |of: &Value| Value(vec![of.0[2], of.0[5], of.0[8]]);
        match freedom {
            Freedom::Turn => [third(turning), Value(coupling.0[6..].to_vec())],
            _ => [third(coupling), third(pushing)],
        }
    }

    /// The accelerations of a link that nothing carries.
    fn alone(&self, pool: &mut Pool) -> [Value; 2] {
        let [turning, coupling, pushing] = &self.inertia;
        // Forces before moments: the matrix of masses has most zeros.
        let row = |of: &Value, k: usize, most: usize| of.0[3 * k..3 * k + most].to_vec();
        let mut lower: Vec<Vec<Id>> = (0..3).map(|k| row(pushing, k, k + 1)).collect();
        lower.extend((0..3).map(|k| [row(coupling, k, 3), row(turning, k, k + 1)].concat()));
        let factors = Factors::of(pool, &lower, |pool, _, pivot, _| pool.powi(pivot, -1));
        let [moment, force] = [0, 1].map(|k| self.bias[k].negate(pool));
        let mut there = factors.solve(pool, &[force.0, moment.0].concat());
        let turning = there.split_off(3);
        [Value(turning), Value(there)]
    }
}

/// A link that carries nothing and moves so.
fn rigid(pool: &mut Pool, link: &Link, own: &Moved, motion: LinkMotion<'_>) -> Articulated {
    let about = link.counted.tensor(pool);
    let across = link.counted.first.skew(pool);
    let heavy = Value::diagonal(pool, &[link.counted.mass; 3]);
    let [moment, force] = link.counted.wrench(pool, motion);
    let loads = own.load.clone().map(|load| load.negate(pool));
    let bias = [moment.add(pool, &loads[0]), force.add(pool, &loads[1])];
    Articulated { inertia: [about, across, heavy], bias }
}

/// Whether a freedom's effort is a moment or a force.
fn block_of(freedom: Freedom) -> usize {
    usize::from(freedom == Freedom::Slide)
}

/// A link seen through a turn or a slide.
fn release(pool: &mut Pool, freedom: Freedom, body: &Articulated, own: &Moved) -> (Known, Articulated) {
    let [turning, coupling, pushing] = &body.inertia;
    let zero = pool.zero();
    let known = block_of(freedom);
    let [column, row] = body.by_speed(freedom);
    let pivot = [&column, &row][known].0[2];
    let inverse = pool.powi(pivot, -1);
    let inverse = match &own.locked {
        Some(locked) => {
            let slides = locked.slides(pool);
            pool.mul(slides, inverse)
        }
        None => inverse,
    };
    let by = [column.multiply(pool, &Value::scalar(inverse)), row.multiply(pool, &Value::scalar(inverse))];
    let drive = pool.sub(own.effort, body.bias[known].0[2]);
    let mut rate = pool.mul(drive, inverse);
    if let Some(Locked { acts, rate: held }) = own.locked {
        let held = pool.mul(acts, held);
        rate = pool.add(rate, held);
    }
    let less = |pool: &mut Pool, of: &Value, a: &Value, b: &Value| {
        let product = a.outer(pool, b).negate(pool);
        of.add(pool, &product)
    };
    let mut left = [
        less(pool, turning, &column, &by[0]),
        less(pool, coupling, &column, &by[1]),
        less(pool, pushing, &row, &by[1]),
    ];
    left[0] = left[0].symmetric();
    left[2] = left[2].symmetric();
    let (own_block, of_coupling) = match freedom {
        Freedom::Turn => (0, [6, 7, 8]),
        _ => (2, [2, 5, 8]),
    };
    // What a freedom takes along where it is locked, and nothing where it is not.
    let mut along = |of: Id| own.locked.map_or(zero, |locked| pool.mul(locked.acts, of));
    for k in [2, 5, 6, 7, 8] {
        left[own_block].0[k] = along(body.inertia[own_block].0[k]);
    }
    for k in of_coupling {
        left[1].0[k] = along(body.inertia[1].0[k]);
    }
    let mut bias = [column, row].map(|of| of.multiply(pool, &Value::scalar(rate)));
    for (bias, own) in bias.iter_mut().zip(&body.bias) {
        *bias = bias.add(pool, own);
    }
    if own.locked.is_none() {
        bias[known].0[2] = own.effort;
    }
    (Known::Step { by, rate }, Articulated { inertia: left, bias })
}

/// A link seen through a ball: no moment is left.
fn release_ball(pool: &mut Pool, body: &Articulated) -> (Known, Articulated) {
    let [turning, coupling, pushing] = &body.inertia;
    let inverse = turning.inverse(pool);
    let by = inverse.multiply(pool, coupling);
    let still = inverse.multiply(pool, &body.bias[0]).negate(pool);
    let back = coupling.transpose();
    let less = back.multiply(pool, &by).negate(pool);
    let pushing = pushing.add(pool, &less).symmetric();
    let force = back.multiply(pool, &still).add(pool, &body.bias[1]);
    let (none, nothing) = (Value::zero(pool, 9), Value::zero(pool, 3));
    (Known::Ball(still, by), Articulated { inertia: [none.clone(), none, pushing], bias: [nothing, force] })
}

/// A link without its hinge, in the axes of its parent and about the parent's origin.
fn carried(pool: &mut Pool, link: &Link, own: &Moved, of: Articulated) -> Articulated {
    let [turning, coupling, pushing] = of.inertia;
    let (turning, coupling, pushing) = (
        matrix_up(pool, link, own, &turning),
        matrix_up(pool, link, own, &coupling),
        matrix_up(pool, link, own, &pushing),
    );
    let [moment, force] = of.bias.map(|bias| up(pool, link, own, &bias));
    let arm = own.offset.cross(pool, &force);
    let moment = moment.add(pool, &arm);
    let skew = own.offset.skew(pool);
    let lever = skew.multiply(pool, &pushing);
    let shifted = coupling.add(pool, &lever);
    let (one, other) = (skew.multiply(pool, &coupling.transpose()), shifted.multiply(pool, &skew).negate(pool));
    let turning = turning.add(pool, &one).add(pool, &other).symmetric();
    Articulated { inertia: [turning, shifted, pushing], bias: [moment, force] }
}
