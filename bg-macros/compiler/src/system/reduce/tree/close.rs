//! Which loops of a tree are closed in closed form.
//!
//! In: a tree in coordinates, the rows of joints that close loops. Out: [`Closed`] loops, and the reactions that go
//! with them. Method: a joint's rows go together. Of each row it is proved that its flow is the rate of its gap; its
//! reaction works on nothing but this flow (`recognition`).

use std::collections::{BTreeMap, BTreeSet};

use super::closed::{Closed, Closer, Closing};
use super::coordinates::Coordinates;
use super::joints::Kind;
use super::loads::Tree;
use crate::expr::{Id, Pool, Symbol, derivative, substitute};
use crate::system::equations::{Origin, StateEquations};
use crate::system::link::{Freedom, Link};
use crate::system::reduce::{closing, friction};

/// A tree that moves.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    pub tree: &'a Tree<'a>,
    pub coordinates: &'a Coordinates,
    /// The multipliers of joints that start closed and work on nothing but the flows of their rows.
    pub working: &'a BTreeSet<Symbol>,
    /// States and velocities of bodies by coordinates.
    pub images: &'a BTreeMap<Symbol, Id>,
}

/// A row with its gap over coordinates.
struct Row {
    multiplier: Symbol,
    gap: Id,
}

/// The loops that can be closed, with the multipliers of their joints; none where there are none. `starts` has place
/// and speed of each link at the start, `asked` the orientations that loops give, as the scene says.
pub(super) fn loops(
    equations: &mut StateEquations,
    of: Moving<'_>,
    starts: &[[Id; 2]],
    asked: &[String],
) -> Option<(Closed, Vec<Symbol>)> {
    let rigid = friction::rigid(&equations.reactions);
    if rigid < equations.reactions.len() {
        return None;
    }
    let at_start = at_start(&mut equations.pool, of.coordinates, starts);
    let is_asked: Vec<bool> = of
        .tree
        .links
        .iter()
        .map(|link| {
            let body = &of.tree.bodies[of.tree.joints[link.step.0].child];
            let Origin::Orientation(track, ..) = equations.states[body.axes[0]].origin else { return false };
            asked.contains(&equations.tracks[track])
        })
        .collect();
    let rank = rank(equations, of, &is_asked);
    let closer = Closer {
        links: of.tree.links,
        coordinates: of.coordinates,
        rank: &rank,
        is_asked: &is_asked,
        first_side: equations.assembly.sides.len(),
        starts: &at_start,
    };
    let (mut closed, mut gone) = (Closed::default(), Vec::new());
    for numbers in closing::of_joints(&equations.reactions, 0..rigid) {
        let rows: Option<Vec<Row>> = numbers.iter().map(|&number| row(equations, of, number)).collect();
        let Some(rows) = rows else { continue };
        let joint = equations.reactions[numbers[0]].slip.joint.clone();
        let mut gaps = Vec::new();
        for row in &rows {
            if !of.coordinates.vanishes(&mut equations.pool, row.gap) {
                gaps.push(row.gap);
            }
        }
        if closer.close(equations, &mut closed, &Closing { joint: &joint, gaps }) {
            gone.extend(rows.iter().map(|row| row.multiplier));
        }
    }
    // The start finds the speeds that are looked for from all rows.
    let is_free = |link: &usize| !closed.gives(*link);
    let is_sought = |link: usize| of.tree.joints[of.tree.links[link].step.0].is_sought;
    let is_found = !(0..of.tree.links.len()).filter(is_free).any(is_sought);
    // A ball's angles are no coordinates where the first and the third turn about one line.
    let is_of_ball = |link: &Link| link.step.1 == 0 && of.tree.joints[link.step.0].kind == Kind::Angles;
    let turns_freely = of.tree.links.iter().enumerate().any(|(link, own)| is_of_ball(own) && !closed.gives(link));
    (!closed.dependents.is_empty() && is_found && !turns_freely).then_some((closed, gone))
}

/// How well the coordinate of each link is one that others give: best one whose speed the start looks for or that the
/// scene asks for, then one whose angle no output reads.
fn rank(equations: &mut StateEquations, of: Moving<'_>, is_asked: &[bool]) -> Vec<usize> {
    let StateEquations { pool, outputs, .. } = equations;
    let values: Vec<Id> = outputs.iter().map(|output| output.value).collect();
    let values = substitute(pool, &values, &|symbol| of.images.get(&symbol).copied());
    let read = pool.symbols(&values);
    let rank = |(k, link): (usize, &Link)| {
        let joint = &of.tree.joints[link.step.0];
        let counts = joint.angle.is_some_and(|state| read.contains(&Symbol::state(state)));
        let is_read = link.freedom == Freedom::Turn && (counts || read.contains(&of.coordinates.of(k).place));
        if joint.is_sought || is_asked[k] { 0 } else { 1 + usize::from(is_read) }
    };
    of.tree.links.iter().enumerate().map(rank).collect()
}

/// All symbols of coordinates at the start.
fn at_start(pool: &mut Pool, coordinates: &Coordinates, starts: &[[Id; 2]]) -> BTreeMap<Symbol, Id> {
    let mut all = BTreeMap::new();
    for (own, &[place, speed]) in coordinates.all().iter().zip(starts) {
        all.extend([(own.place, place), (own.speed, speed)]);
    }
    let (symbols, calls): (Vec<Symbol>, Vec<Id>) = coordinates.calls.iter().unzip();
    let calls = substitute(pool, &calls, &|symbol| all.get(&symbol).copied());
    all.extend(symbols.into_iter().zip(calls));
    all
}

/// A row over coordinates and parameters alone whose flow is the rate of its gap.
fn row(equations: &mut StateEquations, of: Moving<'_>, number: usize) -> Option<Row> {
    if !of.working.contains(&equations.reactions[number].multiplier) {
        return None;
    }
    let StateEquations { pool, reactions, .. } = equations;
    let (slip, multiplier) = (&reactions[number].slip, reactions[number].multiplier);
    let found = substitute(pool, &[slip.flow, slip.gap?], &|symbol| of.images.get(&symbol).copied());
    let is_known = |symbol: &Symbol| matches!(symbol, Symbol::Parameter(_) | Symbol::Weight(_));
    if !pool.symbols(&found).iter().all(is_known) {
        return None;
    }
    let [flow, gap] = of.coordinates.shortened(pool, [found[0], found[1]]);
    let changed = derivative(pool, &[gap], &of.coordinates.speeds)[0];
    let apart = pool.sub(changed, flow);
    if !of.coordinates.vanishes(pool, apart) {
        return None;
    }
    Some(Row { multiplier, gap })
}
