//! Dry friction and stops of joints: a joint that sticks or rests on a stop has an acceleration that is known.
//!
//! In: what moves the links, reactions that are left. Out: the same without those of dry friction and of stops on the
//! coordinates of joints, where all that are switched are such; what each would have to be to hold its joint. Method: a
//! link is seen through a joint that is held as one that is fast, through one that moves as one that is free (hybrid
//! dynamics: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 9.2). So they take as many operations as there
//! are of them, where the matrix of their reactions is full. Where several hold one joint, the first takes all.

use std::collections::{BTreeMap, BTreeSet};

use super::numbers;
use crate::expr::{Id, Node, Pool, Symbol, partial, substitute};
use crate::system::equations::{Reaction, StateEquations, Switched};
use crate::system::link::{Locked, Moved};
use crate::system::reduce::friction;
use crate::system::reduce::reaction::{decay, with};

/// A friction or a stop on a link's own freedom.
pub(super) struct Hold {
    link: usize,
    /// What its effort adds to the link's, 1 or -1 of it.
    sign: f64,
    /// What it holds.
    pub reaction: Reaction,
    /// What it gives.
    switched: Switched,
    /// The rate of the link's speed where it holds that.
    rate: Id,
}

impl Hold {
    /// What it gives where its multiplier is this.
    fn giving(&self, pool: &mut Pool, multiplier: Id) -> Id {
        with(pool, self.switched.effort, self.reaction.multiplier, multiplier)
    }
}

/// Takes the reactions of dry friction and of stops out, where all of them are on joints' own speeds; `images` has the
/// velocities of bodies by the speeds of joints. What joints that close loops hold stays, where that has a solution
/// whichever joints are held.
pub(super) fn lock(equations: &mut StateEquations, moved: &mut [Moved], images: &BTreeMap<Symbol, Id>) -> Vec<Hold> {
    let StateEquations { pool, reactions, .. } = equations;
    let (rigid, switched) = reactions.split_at(friction::rigid(reactions));
    let all: Option<Vec<Hold>> = switched.iter().map(|reaction| hold(pool, reaction, moved, images)).collect();
    let Some(all) = all.filter(|all| are_apart(all)) else { return Vec::new() };
    let held: BTreeSet<usize> = all.iter().map(|hold| hold.link).collect();
    if !held.is_empty() && !are_regular(pool, rigid, (moved, &held), images) {
        return Vec::new();
    }
    for hold in all.iter().rev() {
        let own = &mut moved[hold.link];
        let zero = pool.zero();
        let apart = hold.giving(pool, zero);
        own.effort = with(pool, own.effort, hold.reaction.multiplier, apart);
        own.locked = Some(match (own.locked, hold.reaction.rebound) {
            (Some(Locked { acts, rate }), Some(stop)) => {
                let one = pool.one();
                Locked { acts: pool.select(stop.switch, acts, one), rate: pool.select(stop.switch, rate, hold.rate) }
            }
            _ => Locked { acts: hold.switched.acts, rate: hold.rate },
        });
    }
    reactions.truncate(friction::rigid(reactions));
    all
}

/// The effort of each, by its multiplier: that of its law, or where it holds its joint what the link's effort has to
/// be, `needed`, less what else it is, unless a stop before it holds the joint.
pub(super) fn images(pool: &mut Pool, all: &[Hold], moved: &[Moved], needed: &[Option<Id>]) -> BTreeMap<Symbol, Id> {
    let mut images = BTreeMap::new();
    for (place, hold) in all.iter().enumerate() {
        let needed = needed[hold.link].expect("a link that is locked");
        let held = pool.linear(0.0, &[(needed, hold.sign), (moved[hold.link].effort, -hold.sign)]);
        let zero = pool.zero();
        let (mut effort, apart) = (hold.giving(pool, held), hold.giving(pool, zero));
        let before = all[..place].iter().filter(|other| other.link == hold.link);
        for stop in before.filter_map(|other| other.reaction.rebound) {
            effort = pool.select(stop.switch, effort, apart);
        }
        images.insert(hold.reaction.multiplier, effort);
    }
    images
}

/// On which link a friction or a stop is; none where it is on no coordinate of one, or acts elsewhere.
fn hold(pool: &mut Pool, reaction: &Reaction, moved: &[Moved], images: &BTreeMap<Symbol, Id>) -> Option<Hold> {
    let switched = reaction.switched.clone()?;
    let flow = substitute(pool, &[reaction.slip.flow], &|symbol| images.get(&symbol).copied())[0];
    let of_link = |(link, own): (usize, &Moved)| {
        own.own.is_none().then(|| along(pool, flow, own.moves.speed)).flatten().map(|along| (link, along))
    };
    let (link, along) = moved.iter().enumerate().find_map(of_link)?;
    let sign = partial(pool, &[moved[link].effort], reaction.multiplier)[0];
    let sign = pool.as_number(sign).filter(|sign| numbers::are_near(&[sign.abs()], &[1.0]))?.signum();
    let reads = |ids: &[Id]| pool.symbols(ids).contains(&reaction.multiplier);
    let acts_elsewhere = moved
        .iter()
        .enumerate()
        .any(|(other, own)| (other != link && reads(&[own.effort])) || own.load.iter().any(|part| reads(&part.0)));
    if acts_elsewhere {
        return None;
    }
    let [by_speed, by_gap] = decay(reaction, 0.0).map(|rate| -along * rate);
    let gap = reaction.slip.gap.unwrap_or(pool.zero());
    let rate = pool.linear(0.0, &[(moved[link].moves.speed, along * by_speed), (gap, by_gap)]);
    Some(Hold { link, sign, reaction: reaction.clone(), switched, rate })
}

/// 1 where a flow is this speed, -1 where it is its negative, but for rounding; else none.
fn along(pool: &mut Pool, flow: Id, speed: Id) -> Option<f64> {
    let Node::Symbol(symbol) = *pool.node(speed) else { return None };
    let slope = partial(pool, &[flow], symbol)[0];
    let by = pool.as_number(slope).unwrap_or(0.0);
    let zero = pool.zero();
    (numbers::are_near(&[by.abs()], &[1.0]) && with(pool, flow, symbol, zero) == zero).then_some(by.signum())
}

/// Whether no two frictions are on one joint.
fn are_apart(all: &[Hold]) -> bool {
    let frictions: Vec<usize> =
        all.iter().filter(|hold| hold.reaction.rebound.is_none()).map(|hold| hold.link).collect();
    frictions.iter().collect::<BTreeSet<_>>().len() == frictions.len()
}

/// Whether each of these rows moves a joint alone that nothing can hold, so that their matrix is regular whichever
/// joints are held.
fn are_regular(
    pool: &mut Pool,
    rows: &[Reaction],
    (moved, held): (&[Moved], &BTreeSet<usize>),
    images: &BTreeMap<Symbol, Id>,
) -> bool {
    let flows: Vec<Id> = rows.iter().map(|row| row.slip.flow).collect();
    let flows = substitute(pool, &flows, &|symbol| images.get(&symbol).copied());
    let mut alone = BTreeSet::new();
    for (_, own) in moved.iter().enumerate().filter(|(link, own)| own.own.is_none() && !held.contains(link)) {
        let Node::Symbol(speed) = *pool.node(own.moves.speed) else { continue };
        let by = partial(pool, &flows, speed);
        let mut read = (0..rows.len()).filter(|&row| !pool.is_zero(by[row]));
        if let (Some(row), None) = (read.next(), read.next())
            && pool.as_number(by[row]).is_some()
        {
            alone.insert(row);
        }
    }
    alone.len() == rows.len()
}
