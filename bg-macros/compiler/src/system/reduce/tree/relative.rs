//! What depends on the relative motion of neighbours alone, by the joints between them.
//!
//! In: equations over poses and velocities of bodies, joints with their coordinates. Out: the same with sums that read
//! a body and some that it carries, by their relative motion alone, written by the coordinates of the joints between
//! them. Method: such a sum is the same whatever the pose and the motion of the body that carries the others are; it is
//! proved for a rotation of four symbols, by values at places drawn at random, where it is no analytic function by the
//! polynomial identity. Terms that have no body in common are looked at apart.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, velocity};
use super::joints::{Joint, Probe};
use crate::expr::{Id, Node, Pool, Symbol, children, exchange, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::link::Moves;
use crate::system::reduce::zero::vanishes_at_places;

/// More bodies are not looked at together: those that a sum reads, and those between them.
const MOST: usize = 8;
/// Nor sums that read more.
const READ: usize = 6;

/// A tree of joints with the coordinates of each.
#[derive(Clone, Copy)]
pub(super) struct Coordinated<'a> {
    pub bodies: &'a [Body],
    pub joints: &'a [Joint],
    pub coordinates: &'a [Vec<Moves>],
}

/// The bodies that a node reads; none where it reads something else or many.
type Reads = Option<BTreeSet<usize>>;

/// Terms with their factors.
type Terms = Vec<(Id, f64)>;

/// States and velocities of bodies by those of one that carries them.
type Images = BTreeMap<Symbol, Id>;

/// Writes what depends on relative motions alone by coordinates.
pub(super) fn recognise(equations: &mut StateEquations, tree: Coordinated<'_>) {
    let owner = owners(tree.bodies);
    equations.rewrite(&|pool, ids| {
        let nodes = pool.reachable(ids);
        let reads = reads(pool, &nodes, &owner);
        let mut known: BTreeMap<BTreeSet<usize>, Option<[Images; 2]>> = BTreeMap::new();
        let mut places = BTreeMap::new();
        for id in nodes {
            let Node::Sum { constant, terms } = pool.node(id).clone() else { continue };
            if reads[&id].as_ref().is_none_or(|own| own.len() < 2) {
                continue;
            }
            let terms: Terms = terms.iter().map(|(term, by)| (*term, by.value())).collect();
            let mut all: Terms = Vec::new();
            for (own, part) in apart(&terms, &reads) {
                let sum = pool.linear(0.0, &part);
                let images = known.entry(own.clone()).or_insert_with(|| images(pool, tree, &own));
                let shorter = images.as_ref().and_then(|images| shorter(pool, sum, images));
                all.push((shorter.unwrap_or(sum), 1.0));
            }
            let image = pool.linear(constant.value(), &all);
            if image != id {
                places.insert(id, image);
            }
        }
        exchange(pool, ids, &places)
    });
}

/// Whose velocities and states symbols are.
pub(super) fn owners(bodies: &[Body]) -> BTreeMap<Symbol, usize> {
    let mut owner: BTreeMap<Symbol, usize> = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        owner.extend((0..6).map(|k| (velocity(index, k), index)));
        let states = body.place.iter().chain(&body.axes).chain(&body.linear);
        owner.extend(states.map(|&state| (Symbol::state(state), index)));
    }
    owner
}

fn reads(pool: &Pool, nodes: &[Id], owner: &BTreeMap<Symbol, usize>) -> BTreeMap<Id, Reads> {
    let mut reads: BTreeMap<Id, Reads> = BTreeMap::new();
    for &id in nodes {
        let own = match pool.node(id) {
            Node::Number(_) | Node::Symbol(Symbol::Parameter(_)) => Some(BTreeSet::new()),
            Node::Symbol(symbol) => owner.get(symbol).map(|&body| BTreeSet::from([body])),
            Node::Select { .. } => None,
            node => children(node).try_fold(BTreeSet::new(), |mut all, child| {
                all.extend(reads[&child].as_ref()?.iter().copied());
                (all.len() <= READ).then_some(all)
            }),
        };
        reads.insert(id, own);
    }
    reads
}

/// The terms by what bodies they read, those that have one in common together.
fn apart(terms: &Terms, reads: &BTreeMap<Id, Reads>) -> Vec<(BTreeSet<usize>, Terms)> {
    let mut groups: Vec<(BTreeSet<usize>, Terms)> = Vec::new();
    for &(term, by) in terms {
        let mut own = (reads[&term].clone().unwrap_or_default(), vec![(term, by)]);
        let (joined, others): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|(bodies, _)| !bodies.is_disjoint(&own.0));
        for (bodies, terms) in joined {
            own.0.extend(bodies);
            own.1.extend(terms);
        }
        groups = others;
        groups.push(own);
    }
    groups
}

/// A sum by coordinates, where it takes fewer operations so and is the same however the body moves that carries the
/// others.
fn shorter(pool: &mut Pool, sum: Id, [still, anyhow]: &[Images; 2]) -> Option<Id> {
    let [simple, any] =
        [still, anyhow].map(|images| substitute(pool, &[sum], &|symbol| images.get(&symbol).copied())[0]);
    if pool.cost(&[simple]) >= pool.cost(&[sum]) {
        return None;
    }
    let apart = pool.sub(simple, any);
    let is_proved = vanishes_at_places(pool, apart).unwrap_or_else(|| same_polynomial(pool, simple, any));
    is_proved.then_some(simple)
}

/// The body that carries all of these, and with it these and those between; none where none does.
pub(super) fn between(tree: Coordinated<'_>, of: &BTreeSet<usize>) -> Option<(usize, BTreeSet<usize>)> {
    let parent = |body: usize| tree.joints.iter().find(|joint| joint.child == body).and_then(|joint| joint.parent);
    let path = |&body: &usize| std::iter::successors(Some(body), |&body| parent(body)).collect::<Vec<usize>>();
    let paths: Vec<Vec<usize>> = of.iter().map(path).collect();
    let base = *paths.first()?.iter().find(|body| paths.iter().all(|path| path.contains(body)))?;
    let below = |path: Vec<usize>| path.into_iter().take_while(move |&body| body != base);
    Some((base, paths.into_iter().flat_map(below).chain([base]).collect()))
}

/// The motion of these bodies by that of the one that carries them: that one at rest, upright, at the origin,
/// and in any pose and motion. None where none does.
fn images(pool: &mut Pool, tree: Coordinated<'_>, of: &BTreeSet<usize>) -> Option<[Images; 2]> {
    let (base, of) = between(tree, of)?;
    if !(2..=MOST).contains(&of.len()) {
        return None;
    }
    let rotation = Probe::new(pool, 6 * tree.bodies.len()).rotation;
    let (unit, zero) = (Value::identity(pool), pool.zero());
    let body = &tree.bodies[base];
    let axes = |turned: &Value| -> Images {
        body.axes.iter().map(|&state| Symbol::state(state)).zip(turned.0.iter().copied()).collect()
    };
    let (mut still, mut anyhow) = (axes(&unit), axes(&rotation));
    still.extend(body.place.iter().map(|&state| (Symbol::state(state), zero)));
    still.extend((0..6).map(|k| (velocity(base, k), zero)));
    still.extend(body.linear.iter().map(|&state| (Symbol::state(state), zero)));
    let moving = (0..3).map(|k| pool.symbol(velocity(base, k))).collect();
    anyhow.extend(momenta(pool, body, &Value(moving)));
    // Joints are in the order of the tree.
    for (joint, moves) in tree.joints.iter().zip(tree.coordinates) {
        if joint.child == base || !of.contains(&joint.child) {
            continue;
        }
        let motion = joint.motion(pool, tree.bodies, moves, None);
        for images in [&mut still, &mut anyhow] {
            let (symbols, ids): (Vec<Symbol>, Vec<Id>) = motion.clone().into_iter().unzip();
            let placed = substitute(pool, &ids, &|symbol| images.get(&symbol).copied());
            images.extend(symbols.into_iter().zip(placed));
            let moving = Value((0..3).map(|k| images[&velocity(joint.child, k)]).collect());
            images.extend(momenta(pool, &tree.bodies[joint.child], &moving));
        }
    }
    Some([still, anyhow])
}

/// The momentum of a body with this velocity.
fn momenta(pool: &mut Pool, body: &Body, velocity: &Value) -> Vec<(Symbol, Id)> {
    let momentum = velocity.multiply(pool, &Value::scalar(body.mass));
    body.linear.iter().map(|&state| Symbol::state(state)).zip(momentum.0).collect()
}
