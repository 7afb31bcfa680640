//! Which states are those of rigid bodies.
//!
//! In: equations. Out: [`Body`] for each position and orientation that move as those of a body do: x' = p / m, and R' =
//! w x R with w = R J R^T h, J constant. Method: the rates say which momenta these are and what the angular velocity w
//! is; J is w where R is the unit matrix; the polynomial identity decides whether all this is so. That a position and
//! an orientation belong together is a guess: joints prove it, or take no part.

use std::collections::BTreeMap;

use crate::expr::{Id, Node, Pool, Symbol, partial, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::{Kind, Origin, State, StateEquations};
use crate::system::reduce::is_constant;

/// A rigid body.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Its centre's place.
    pub place: [usize; 3],
    /// Its axes, by rows.
    pub axes: [usize; 9],
    /// Its momentum.
    pub linear: [usize; 3],
    /// Its angular momentum about the centre, in inertial axes.
    pub angular: [usize; 3],
    pub mass: Id,
    /// The inverse of its tensor, in its own axes.
    pub mobility: Value,
    /// Its angular velocity, in inertial axes.
    pub spin: [Id; 3],
}

impl Body {
    /// All its states.
    pub fn states(&self) -> impl Iterator<Item = usize> + use<> {
        let Self { place, axes, linear, angular, .. } = *self;
        place.into_iter().chain(axes).chain(linear).chain(angular)
    }
}

/// The symbol of a component of a body's velocity, of its angular velocity from the fourth component on.
pub(super) fn velocity(body: usize, component: usize) -> Symbol {
    Symbol::numbered(Symbol::Weight, 6 * body + component)
}

/// A vector or matrix of states.
pub(super) fn symbols(pool: &mut Pool, states: &[usize]) -> Value {
    Value(states.iter().map(|&state| pool.symbol(Symbol::state(state))).collect())
}

/// The bodies, in the order of their positions.
pub(super) fn of(equations: &mut StateEquations) -> Vec<Body> {
    let mut places: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut axes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, state) in equations.states.iter().enumerate() {
        match state.origin {
            Origin::Position(track, _) => places.entry(track).or_default().push(index),
            Origin::Orientation(track, ..) => axes.entry(track).or_default().push(index),
            _ => {}
        }
    }
    let mut bodies = Vec::new();
    for (track, place) in places {
        let (Ok(place), Some(axes)) = (<[usize; 3]>::try_from(place), axes.get(&(track + 1))) else { continue };
        let Ok(axes) = <[usize; 9]>::try_from(axes.clone()) else { continue };
        let Some((linear, mass)) = linear(equations, place) else { continue };
        let Some((angular, mobility, spin)) = angular(equations, axes) else { continue };
        bodies.push(Body { place, axes, linear, angular, mass, mobility, spin });
    }
    bodies
}

/// The momentum and the mass of x' = p / m.
fn linear(equations: &mut StateEquations, place: [usize; 3]) -> Option<([usize; 3], Id)> {
    let StateEquations { pool, states, .. } = equations;
    let mut momenta = [0; 3];
    let mut slopes = [pool.zero(); 3];
    for k in 0..3 {
        let rate = states[place[k]].rate;
        momenta[k] = self::momenta::<1>(pool, states, rate)?[0];
        slopes[k] = partial(pool, &[rate], Symbol::state(momenta[k]))[0];
        let symbol = pool.symbol(Symbol::state(momenta[k]));
        if !is_constant(pool, slopes[k]) || pool.mul(slopes[k], symbol) != rate || slopes[k] != slopes[0] {
            return None;
        }
    }
    Some((momenta, pool.powi(slopes[0], -1)))
}

/// The momenta that an expression reads, if they are as many as are asked for.
fn momenta<const N: usize>(pool: &Pool, states: &[State], of: Id) -> Option<[usize; N]> {
    let read = pool.symbols(&[of]).into_iter().filter_map(Symbol::as_state);
    let momenta: Vec<usize> = read.filter(|&state| states[state].origin.kind() == Kind::Momentum).collect();
    momenta.try_into().ok()
}

/// The angular momentum, J and w of R' = w x R with w = R J R^T h.
fn angular(equations: &mut StateEquations, axes: [usize; 9]) -> Option<([usize; 3], Value, [Id; 3])> {
    let StateEquations { pool, states, .. } = equations;
    let rates: Vec<Id> = axes.iter().map(|&state| states[state].rate).collect();
    // R_11' = w_y R_31 - w_z R_21, R_21' = w_z R_11 - w_x R_31.
    let factor = |pool: &mut Pool, row: usize, by: usize| {
        let symbol = pool.symbol(Symbol::state(axes[3 * by]));
        factor_of(pool, rates[3 * row], symbol)
    };
    let spin = [factor(pool, 1, 2).map(|minus| pool.neg(minus))?, factor(pool, 0, 2)?, factor(pool, 1, 0)?];
    let momenta = self::momenta::<3>(pool, states, spin[0])?;
    let turned = symbols(pool, &axes);
    let skew = Value(spin.to_vec()).skew(pool);
    let expected = skew.multiply(pool, &turned);
    if !rates.iter().zip(&expected.0).all(|(&rate, &expected)| rate == expected) {
        return None;
    }
    let unit = Value::identity(pool);
    let upright = substitute(pool, &spin, &|symbol| {
        let place = axes.iter().position(|&state| symbol == Symbol::state(state))?;
        Some(unit.0[place])
    });
    let columns: Vec<Vec<Id>> = momenta.iter().map(|&state| partial(pool, &upright, Symbol::state(state))).collect();
    let mobility = Value((0..9).map(|k| columns[k % 3][k / 3]).collect());
    if !mobility.0.iter().all(|&entry| is_constant(pool, entry)) {
        return None;
    }
    let momentum = symbols(pool, &momenta);
    let inside = turned.transpose().multiply(pool, &momentum);
    let inside = mobility.multiply(pool, &inside);
    let expected = turned.multiply(pool, &inside);
    let is_so = spin.iter().zip(&expected.0).all(|(&a, &b)| same_polynomial(pool, a, b));
    is_so.then_some((momenta, mobility, spin))
}

/// What a symbol is multiplied by in the term of a sum that has it as a factor.
fn factor_of(pool: &mut Pool, sum: Id, symbol: Id) -> Option<Id> {
    let Node::Sum { terms, .. } = pool.node(sum).clone() else { return None };
    if let [(inner, by)] = *terms {
        let factor = factor_of(pool, inner, symbol)?;
        return Some(pool.scale(by.value(), factor));
    }
    let has = |id: Id| matches!(pool.node(id), Node::Product(factors) if factors.contains(&(symbol, 1)));
    let (term, coefficient) = terms.iter().find(|(term, _)| has(*term)).copied()?;
    let factor = pool.div(term, symbol);
    Some(pool.scale(coefficient.value(), factor))
}
