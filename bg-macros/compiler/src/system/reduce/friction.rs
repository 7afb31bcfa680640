//! Dry friction and stops among the reactions: what sticks or rests is a constraint, what slides is a known effort,
//! what is clear of a stop is not there.
//!
//! In: reactions with dry friction and stops, the equations A l + b = 0 of all of them. Out: equations that hold in
//! every branch. Method: the row and the column of what slides are multiplied by 0 but for the diagonal, so that it
//! takes no part; what it gives is in b. Its own l is not used then.

use crate::expr::{Id, Pool, Symbol, substitute};
use crate::system::equations::Reaction;

/// Rate at which a flow that truncation leaves decays while it sticks, 1/s: slow, so that no explicit step is the
/// shorter for it.
pub(super) const DECAY: f64 = 1.0;
/// The part of its diagonal entry below which a pivot of dry friction counts as zero: others hold that motion already.
const PART: f64 = 1e-10;

/// The left sides of the equations: of a residual sink with every effort as it is applied, of dry friction with its own
/// as if it stuck.
pub(super) fn residuals(pool: &mut Pool, multipliers: &[Symbol], efforts: &[Id], expressions: &[Id]) -> Vec<Id> {
    let place = |symbol: Symbol| multipliers.iter().position(|&multiplier| multiplier == symbol);
    let residual = |(row, &expression): (usize, &Id)| {
        let effort = |symbol: Symbol| place(symbol).filter(|&other| other != row).map(|other| efforts[other]);
        substitute(pool, &[expression], &effort)[0]
    };
    expressions.iter().enumerate().map(residual).collect()
}

/// What each reaction applies, by its multiplier.
pub(super) fn efforts(pool: &mut Pool, reactions: &[Reaction]) -> Vec<Id> {
    let effort = |reaction: &Reaction| {
        let own = pool.symbol(reaction.multiplier);
        reaction.switched.as_ref().map_or(own, |switched| switched.effort)
    };
    reactions.iter().map(effort).collect()
}

/// How many of the reactions are those of residual sinks, which come first.
pub(super) fn rigid(reactions: &[Reaction]) -> usize {
    reactions.iter().take_while(|reaction| reaction.switched.is_none()).count()
}

/// The lower triangle of A without the couplings of what slides.
pub(super) fn decoupled(pool: &mut Pool, reactions: &[Reaction], matrix: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let acts = |k: usize| reactions[k].switched.as_ref().map(|switched| switched.acts);
    let mut entry = |i: usize, j: usize| {
        let couplings = [acts(i), acts(j)].into_iter().flatten().filter(|_| i != j);
        let factors: Vec<Id> = couplings.chain([matrix[i][j]]).collect();
        pool.product(&factors)
    };
    (0..matrix.len()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}

/// The reciprocal of a pivot of dry friction, 0 where it vanishes beside the entry that it came from: p / (p^2 + d^2).
pub(super) fn reciprocal(pool: &mut Pool, pivot: Id, entry: Id) -> Id {
    if pivot == entry {
        let one = pool.one();
        return pool.div(one, pivot);
    }
    let least = pool.scale(PART, entry);
    let squares = [pool.powi(pivot, 2), pool.powi(least, 2)];
    let squares = pool.sum(&squares);
    pool.div(pivot, squares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, evaluate};
    use crate::system::equations::{Slip, Switched};

    /// A reaction of dry friction, whose switches are numbers, or of a joint.
    fn reaction(pool: &mut Pool, number: u32, acts: Option<f64>) -> Reaction {
        let flow = pool.zero();
        let slip = Slip {
            joint: String::new(),
            direction: String::new(),
            unit: String::new(),
            flow,
            kept: None,
            gap: None,
            mobility: None,
        };
        // What slides gives 5 N, what sticks its multiplier.
        let multiplier = Symbol::Multiplier(number);
        let switched = acts.map(|acts| Switched {
            effort: if acts == 0.0 { pool.number(5.0) } else { pool.symbol(multiplier) },
            acts: pool.number(acts),
        });
        Reaction { slip, multiplier, switched, rebound: None }
    }

    fn reactions(pool: &mut Pool) -> Vec<Reaction> {
        [None, Some(1.0), Some(0.0)].into_iter().zip(0..).map(|(acts, k)| reaction(pool, k, acts)).collect()
    }

    #[test]
    fn what_slides_is_coupled_with_nothing() {
        let pool = &mut Pool::new();
        let reactions = reactions(pool);
        assert_eq!(rigid(&reactions), 1);
        let full: Vec<Vec<Id>> = [&[4.0][..], &[1.0, 5.0], &[2.0, 3.0, 6.0]]
            .map(|row| row.iter().map(|&value| pool.number(value)).collect())
            .into();
        let found = decoupled(pool, &reactions, &full);
        let numbers: Vec<f64> = found.iter().flatten().map(|&id| pool.as_number(id).expect("a number")).collect();
        assert_eq!(numbers, [4.0, 1.0, 5.0, 0.0, 0.0, 6.0]);
    }

    /// r = l_0 + 10 l_1 + 100 l_2 in every row.
    #[test]
    fn what_slides_gives_its_effort_to_all_rows_but_its_own() {
        let pool = &mut Pool::new();
        let reactions = reactions(pool);
        let multipliers: Vec<Symbol> = reactions.iter().map(|reaction| reaction.multiplier).collect();
        let terms: Vec<(Id, f64)> = multipliers.iter().map(|&of| pool.symbol(of)).zip([1.0, 10.0, 100.0]).collect();
        let (all, efforts) = (pool.linear(0.0, &terms), efforts(pool, &reactions));
        let found = residuals(pool, &multipliers, &efforts, &[all; 3]);
        let sliding = pool.linear(500.0, &terms[..2]);
        assert_eq!(found, [sliding, sliding, all]);
    }

    #[test]
    fn a_pivot_that_vanishes_beside_its_entry_has_no_reciprocal() {
        let pool = &mut Pool::new();
        let [pivot, entry] = [0, 1].map(|state| pool.symbol(Symbol::state(state)));
        let (damped, own) = (reciprocal(pool, pivot, entry), reciprocal(pool, entry, entry));
        for (pivot, expected) in [(3.0, 1.0 / 3.0), (4e-10, 0.5 / 4e-10), (0.0, 0.0)] {
            let states = [pivot, 4.0];
            let found = evaluate(pool, &[damped, own], &Environment { states: &states, ..Environment::default() });
            assert!((found[0] - expected).abs() <= 1e-15 * expected && found[1] == 0.25, "{pivot}: {found:?}");
        }
    }
}
