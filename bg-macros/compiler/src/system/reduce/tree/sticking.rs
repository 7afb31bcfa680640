//! Dry friction of joints: a joint that sticks has an acceleration that is known.
//!
//! In: what moves the links, reactions that are left. Out: the same without those of dry friction on the coordinates of
//! joints, where there are no others; what each would have to be to stick. Method: a link is seen through a joint that
//! sticks as one that is fast, through one that slides as one that is free (hybrid dynamics: Featherstone, Rigid Body
//! Dynamics Algorithms, 2008, section 9.2). So frictions take as many operations as there are of them, where the matrix
//! of their reactions is full.

use std::collections::BTreeMap;

use super::numbers;
use crate::expr::{Id, Node, Pool, Symbol, partial, substitute};
use crate::system::equations::{Reaction, StateEquations, Switched};
use crate::system::link::{Locked, Moved};
use crate::system::reduce::friction::DECAY;

/// A friction on a link's own freedom.
pub(super) struct Sticking {
    link: usize,
    /// What its effort adds to the link's, 1 or -1 of it.
    sign: f64,
    multiplier: Symbol,
    switched: Switched,
}

/// Takes the reactions of dry friction out, where all that are left are on joints' own speeds, each on another one; `images`
/// has the velocities of bodies by the speeds of joints.
pub(super) fn lock(
    equations: &mut StateEquations,
    moved: &mut [Moved],
    images: &BTreeMap<Symbol, Id>,
) -> Vec<Sticking> {
    let StateEquations { pool, reactions, .. } = equations;
    let all: Option<Vec<Sticking>> = reactions.iter().map(|reaction| sticking(pool, reaction, moved, images)).collect();
    let Some(all) = all.filter(|all| are_apart(all)) else { return Vec::new() };
    for Sticking { link, multiplier, switched, .. } in &all {
        let own = &mut moved[*link];
        let zero = pool.zero();
        let sliding = with(pool, switched.effort, *multiplier, zero);
        own.effort = with(pool, own.effort, *multiplier, sliding);
        own.locked = Some(Locked { acts: switched.acts, rate: pool.scale(-DECAY, own.moves.speed) });
    }
    reactions.clear();
    all
}

/// An expression with this in the place of a symbol.
fn with(pool: &mut Pool, id: Id, of: Symbol, by: Id) -> Id {
    substitute(pool, &[id], &|symbol| (symbol == of).then_some(by))[0]
}

/// The effort of each friction, by its multiplier: that of its law, or where it sticks what the link's effort has to be,
/// `needed`, less what else it is.
pub(super) fn images(
    pool: &mut Pool,
    all: &[Sticking],
    moved: &[Moved],
    needed: &[Option<Id>],
) -> BTreeMap<Symbol, Id> {
    let mut image = |Sticking { link, sign, multiplier, switched }: &Sticking| {
        let needed = needed[*link].expect("a link that is locked");
        let held = pool.linear(0.0, &[(needed, *sign), (moved[*link].effort, -sign)]);
        (*multiplier, with(pool, switched.effort, *multiplier, held))
    };
    all.iter().map(&mut image).collect()
}

/// On which link a friction is; none where it is on no coordinate of one, or acts elsewhere.
fn sticking(pool: &mut Pool, reaction: &Reaction, moved: &[Moved], images: &BTreeMap<Symbol, Id>) -> Option<Sticking> {
    let switched = reaction.switched.clone().filter(|_| reaction.rebound.is_none())?;
    let flow = substitute(pool, &[reaction.slip.flow], &|symbol| images.get(&symbol).copied())[0];
    let link = moved.iter().position(|own| own.own.is_none() && is_speed(pool, flow, own.moves.speed))?;
    let sign = partial(pool, &[moved[link].effort], reaction.multiplier)[0];
    let sign = pool.as_number(sign).filter(|sign| numbers::are_near(&[sign.abs()], &[1.0]))?.signum();
    let reads = |ids: &[Id]| pool.symbols(ids).contains(&reaction.multiplier);
    let acts_elsewhere = moved
        .iter()
        .enumerate()
        .any(|(other, own)| (other != link && reads(&[own.effort])) || own.load.iter().any(|part| reads(&part.0)));
    (!acts_elsewhere).then_some(Sticking { link, sign, multiplier: reaction.multiplier, switched })
}

/// Whether a flow is this speed or its negative, but for rounding.
fn is_speed(pool: &mut Pool, flow: Id, speed: Id) -> bool {
    let Node::Symbol(symbol) = *pool.node(speed) else { return false };
    let slope = partial(pool, &[flow], symbol)[0];
    let by = pool.as_number(slope).unwrap_or(0.0);
    let zero = pool.zero();
    numbers::are_near(&[by.abs()], &[1.0]) && with(pool, flow, symbol, zero) == zero
}

fn are_apart(all: &[Sticking]) -> bool {
    all.iter().enumerate().all(|(k, one)| all[..k].iter().all(|other| other.link != one.link))
}
