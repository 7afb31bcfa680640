//! How large the states of storages are beside the energy in all of them.
//!
//! In: [`Closed`] equations. Out: the stored energy E as far as the model knows it, and d2E/dx2 by each momentum and
//! displacement, in [`Sizes`] with a pool of its own. A state x changes the energy by E where it changes by sqrt(2 E /
//! (d2E/dx2)): that size depends neither on units nor on how large the machine is, and error norms measure by it.

use crate::expr::{Id, Pool, Symbol, partial};
use crate::system::equations::Kind;
use crate::system::equations::stage::Closed;

/// The energy and its second derivatives.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// The expressions.
    pub pool: Pool,
    /// The stored energy, J, without what a scene does not know.
    pub energy: Id,
    /// d2E/dx2 of each state; zero of one that stores nothing.
    pub curvatures: Vec<Id>,
}

/// Differentiates the energy.
#[must_use]
pub fn differentiate(equations: &Closed) -> Sizes {
    let mut pool = equations.pool.clone();
    let energy = pool.sum(&equations.balance.energies);
    let is_stored = |kind: Kind| matches!(kind, Kind::Momentum | Kind::Displacement);
    let states = equations.states.iter().map(|state| state.origin.kind()).enumerate();
    let curvatures = states
        .map(
            |(index, kind)| {
                if is_stored(kind) { curvature(&mut pool, &equations.balance.energies, index) } else { pool.zero() }
            },
        )
        .collect();
    Sizes { pool, energy, curvatures }
}

/// The second derivative of the sum of `energies` by state `index`.
fn curvature(pool: &mut Pool, energies: &[Id], index: usize) -> Id {
    let symbol = Symbol::state(index);
    let slopes = partial(pool, energies, symbol);
    let curvatures = partial(pool, &slopes, symbol);
    pool.sum(&curvatures)
}
