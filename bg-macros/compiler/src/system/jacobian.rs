//! The exact derivatives of the rates.
//!
//! In: [`Ordered`] equations. Out: the places where df/dx can differ from zero, each with its expression, and df/dt, in
//! a [`Jacobian`] with a pool of its own, so that no other function's order of operations depends on it. An entry that
//! is identically zero has no place. Method: forward accumulation, one sweep for each column (Griewank & Walther 2008,
//! Evaluating Derivatives, ch. 3). What the rates share, such as the force in a joint, is differentiated once for all
//! rows, as equal expressions are one node. The reactions of rigid joints couple every state with every other, while
//! the equations that give them are sparse. So these stand beside the rates, and the reactions beside the states: df/dx
//! is f_x - f_l (r_l)^-1 r_x of the rates f(x, l) with r(x, l) = 0, and nobody has to multiply it out. Dry friction
//! among them keeps df/dx itself, by the implicit function theorem from the factors that solve for the reactions: where
//! others hold already what sticks, r_l has no inverse. Of trees of joints the accelerations are unknowns as well
//! (`accelerated`).

use std::collections::BTreeMap;
use std::ops::Range;

use super::accelerated;
use crate::expr::{Id, Pool, Symbol, derivative};
use crate::system::equations::StateEquations;
use crate::system::equations::solution::Solution;
use crate::system::equations::stage::Ordered;

/// df/dx and df/dt as expressions.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// The expressions.
    pub pool: Pool,
    /// The accelerations and reactions that stand beside the states, each with the equation that gives it: rows and
    /// columns after those of the states.
    pub unknowns: Vec<Symbol>,
    /// How many of these, the last ones, may have nothing on the diagonal of their equation until others are
    /// eliminated.
    pub late: usize,
    /// The entries, row by row, in each row by column.
    pub entries: Vec<Entry>,
    /// df/dt of every rate, the reactions' change with time in it; an input contributes through its own derivative,
    /// [`Symbol::Slope`].
    pub slopes: Vec<Id>,
}

/// An entry that is not identically zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Entry {
    /// The rate's state, or, after the states, the unknown whose equation it is.
    pub row: usize,
    /// The state or the unknown that it is differentiated by.
    pub column: usize,
    /// The derivative.
    pub value: Id,
}

impl Jacobian {
    /// Row and column of every entry.
    #[must_use]
    pub fn places(&self) -> Vec<(usize, usize)> {
        self.entries.iter().map(|entry| (entry.row, entry.column)).collect()
    }

    /// The entries whose rates and states are none of `second_order`.
    pub fn among_first_order(&self, second_order: &Range<usize>) -> impl Iterator<Item = &Entry> {
        let is_among = |entry: &&Entry| !second_order.contains(&entry.row) && !second_order.contains(&entry.column);
        self.entries.iter().filter(is_among)
    }

    /// All derivatives: the entries, then the slopes.
    #[must_use]
    pub fn roots(&self) -> Vec<Id> {
        self.entries.iter().map(|entry| entry.value).chain(self.slopes.iter().copied()).collect()
    }
}

/// Differentiates the rates. Switched laws are differentiated branch by branch: a switch is frozen.
#[must_use]
pub fn differentiate(equations: &Ordered) -> Jacobian {
    accelerated::differentiate(equations).unwrap_or_else(|| by_entries(equations))
}

/// The derivatives of the rates as they are written, whatever they are.
pub(crate) fn by_entries(equations: &StateEquations) -> Jacobian {
    let mut pool = equations.pool.clone();
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let unknowns = equations.solution.smooth(&pool).to_vec();
    let rows: Vec<Id> = rates
        .iter()
        .copied()
        .chain(equations_of(&mut pool, equations, &unknowns, &equations.solution.residuals))
        .collect();
    let columns = (0..rates.len()).map(Symbol::state).chain(unknowns.iter().copied());
    let mut entries = Vec::new();
    for (column, symbol) in columns.enumerate() {
        let mut seeds = BTreeMap::from([(symbol, pool.one())]);
        if unknowns.is_empty() {
            seeds = equations.solution.with_rates(&mut pool, &seeds);
        }
        let values = derivative(&mut pool, &rows, &seeds);
        let entry = |(row, value)| Entry { row, column, value };
        entries.extend(values.into_iter().enumerate().map(entry).filter(|entry| !pool.is_zero(entry.value)));
    }
    entries.sort_by_key(|entry| (entry.row, entry.column));
    Jacobian::closed(pool, equations, (unknowns, 0), entries)
}

/// The equations of the reactions with these residuals: left sides that are zero. A reaction that is not kept is zero.
pub(super) fn equations_of(
    pool: &mut Pool,
    equations: &StateEquations,
    unknowns: &[Symbol],
    residuals: &[Id],
) -> Vec<Id> {
    let mut equation = |(row, (&unknown, &residual)): (usize, (&Symbol, &Id))| {
        let Some(kept) = equations.holding.kept(row) else { return residual };
        let (kept, unknown) = (pool.symbol(Symbol::Kept(kept)), pool.symbol(unknown));
        let (asked, left) = (pool.mul(kept, residual), pool.mul(kept, unknown));
        pool.linear(0.0, &[(asked, 1.0), (unknown, 1.0), (left, -1.0)])
    };
    unknowns.iter().zip(residuals).enumerate().map(&mut equation).collect()
}

/// df/dt of every rate.
fn slopes(pool: &mut Pool, equations: &StateEquations, rates: &[Id]) -> Vec<Id> {
    let mut seeds = BTreeMap::from([(Symbol::Time, pool.one())]);
    for index in 0..equations.inputs.len() {
        let [input, slope] = [Symbol::Input, Symbol::Slope].map(|symbol| Symbol::numbered(symbol, index));
        seeds.insert(input, pool.symbol(slope));
    }
    let seeds = equations.solution.with_rates(pool, &seeds);
    derivative(pool, rates, &seeds)
}

impl Jacobian {
    /// The entries with df/dt, the values of the reactions in their places.
    pub(super) fn closed(
        mut pool: Pool,
        equations: &StateEquations,
        (unknowns, late): (Vec<Symbol>, usize),
        entries: Vec<Entry>,
    ) -> Self {
        let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
        let slopes = slopes(&mut pool, equations, &rates);
        let mut jacobian = Self { pool, unknowns, late, entries, slopes };
        jacobian.close(&equations.solution);
        jacobian
    }

    /// Puts the reactions' values in their places.
    fn close(&mut self, solution: &Solution) {
        let roots = self.roots();
        let closed = solution.closed(&mut self.pool, &roots);
        let (entries, slopes) = closed.split_at(self.entries.len());
        self.entries.iter_mut().zip(entries).for_each(|(entry, &value)| entry.value = value);
        self.slopes = slopes.to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, evaluate, partial, substitute};
    use crate::pipeline;
    use crate::source::syntax;
    use crate::system::equations::stage::Solved;
    use crate::system::reduce;

    /// The literal equations with their reactions as symbols, and the derivatives.
    fn differentiated(statements: &str) -> (StateEquations, Jacobian) {
        let text = format!("graph G {{ {statements} }}");
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let Solved(equations) = reduce::literal(pipeline::derive(&source.graphs[0]).expect("equations").equations);
        let equations = Ordered(equations);
        let jacobian = differentiate(&equations);
        (equations.0, jacobian)
    }

    /// A pendulum, whose pin is rigid.
    const PENDULUM: &str = "gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; point P = [0, 0, 1]; }
        body bob { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; point side = [0, 0.5, 1];
            start top at [0, 0, 0]; start turned rotation_z(0.7); start spin [0, 0, 2]; }
        joint pin: revolute z (ground.O -> bob.top) { rigid; }";

    /// States that are none of a run: what holds of derivatives holds anywhere.
    fn anywhere(equations: &StateEquations) -> Vec<f64> {
        (0..equations.states.len() as u32).map(|k| 0.8 + 0.3 * f64::from(k).sin()).collect()
    }

    /// The rates with the reactions' values in their places, in the Jacobian's pool.
    fn closed_rates(equations: &StateEquations, jacobian: &mut Jacobian) -> Vec<Id> {
        let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
        equations.solution.closed(&mut jacobian.pool, &rates)
    }

    #[test]
    fn only_what_depends_has_a_place_row_by_row() {
        let (equations, jacobian) = differentiated(
            "param k: N/m = 3; 1 j: translation; C s = k; I m = 2; R r = 5; j -> s; j -> m; j -> r; \
            observe { w: J = integral(r.power) }",
        );
        let name = |index: usize| equations.states[index].name.as_str();
        let places: Vec<_> = jacobian.places().into_iter().map(|(row, column)| (name(row), name(column))).collect();
        assert_eq!(places, [("s.q", "m.p"), ("m.p", "s.q"), ("m.p", "m.p"), ("w", "m.p")]);
        // w' = 5 (p / 2)^2.
        let ids: Vec<Id> = jacobian.entries.iter().map(|entry| entry.value).collect();
        let states = [7.0, 4.0, 0.0];
        let found = evaluate(
            &jacobian.pool,
            &ids,
            &Environment { states: &states, parameters: &[3.0], ..Environment::default() },
        );
        let momentum = states[equations.states.iter().position(|state| state.name == "m.p").expect("a state")];
        assert_eq!(found, [0.5, -3.0, -2.5, 2.5 * momentum]);
    }

    #[test]
    fn a_rate_changes_with_time_by_its_inputs_as_well() {
        let (_, jacobian) =
            differentiated("input f: N; 1 j: translation; I m = 2; MSe push = f * sin(3 * t); push -> j -> m;");
        let environment = Environment { time: 0.2, inputs: &[5.0], slopes: &[7.0], ..Environment::default() };
        let found = evaluate(&jacobian.pool, &jacobian.slopes, &environment)[0];
        assert!((found - (7.0 * 0.6_f64.sin() + 15.0 * 0.6_f64.cos())).abs() < 1e-14, "{found}");
    }

    /// With the slopes l' of the reactions, df/dx is f_x + f_l l', and r_x + r_l l' is zero.
    #[test]
    fn reactions_beside_the_states_give_the_derivatives_of_the_rates() {
        let (equations, mut jacobian) = differentiated(PENDULUM);
        let (n, states) = (equations.states.len(), anywhere(&equations));
        assert_eq!(jacobian.unknowns, equations.solution.multipliers);
        let rates = closed_rates(&equations, &mut jacobian);
        let environment = Environment { states: &states, ..Environment::default() };
        for column in 0..n {
            let pool = &mut jacobian.pool;
            let [slopes, expected] = [&equations.solution.values, &rates].map(|ids| {
                let ids = partial(pool, ids, Symbol::state(column));
                evaluate(pool, &ids, &environment)
            });
            let (mut found, mut sizes) = (vec![0.0; n + slopes.len()], vec![1.0_f64; n + slopes.len()]);
            for entry in &jacobian.entries {
                let by = match entry.column.checked_sub(n) {
                    Some(unknown) => slopes[unknown],
                    None => f64::from(u8::from(entry.column == column)),
                };
                let part = by * evaluate(&jacobian.pool, &[entry.value], &environment)[0];
                found[entry.row] += part;
                sizes[entry.row] = sizes[entry.row].max(part.abs());
            }
            for (row, found) in found.into_iter().enumerate() {
                let expected = expected.get(row).copied().unwrap_or(0.0);
                assert!((found - expected).abs() < 1e-12 * sizes[row], "{row} {column}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_reaction_that_is_not_kept_is_zero() {
        let (equations, mut jacobian) =
            differentiated(&format!("{PENDULUM} joint second: revolute z (ground.P -> bob.side) {{ rigid; }}"));
        let (n, states) = (equations.states.len(), anywhere(&equations));
        let rows: Vec<usize> = (0..10).filter(|&row| equations.holding.kept(row).is_some()).collect();
        assert_eq!(rows, [5, 6, 7, 8, 9]);
        let (zero, ids) = (jacobian.pool.zero(), jacobian.roots());
        let dropped = substitute(&mut jacobian.pool, &ids, &|symbol| matches!(symbol, Symbol::Kept(_)).then_some(zero));
        let environment = Environment { states: &states, ..Environment::default() };
        let values = evaluate(&jacobian.pool, &dropped, &environment);
        for (entry, value) in jacobian.entries.iter().zip(values).filter(|(entry, _)| entry.row >= n + 5) {
            let expected = f64::from(u8::from(entry.row == entry.column));
            assert_eq!(value, expected, "{} {}", entry.row, entry.column);
        }
        assert!((n + 5..n + 10).all(|row| jacobian.places().contains(&(row, row))));
    }

    #[test]
    fn dry_friction_leaves_no_reaction_beside_the_states() {
        let (equations, mut jacobian) = differentiated(
            "param k: N/m = 5; param c: N*s/m = 3; 1 a, b: translation; I ma = 2; I mb = 3; C s = k; \
            MSe pull = 3 * sin(2 * t);
             R ra(v) = c * v holds 2; R rab(v) = 1 holds 2;
             pull -> a -> ma; a -> ra; a -> s; b -> mb; 0 ab: translation; 1 sab: translation; a -> ab -> b; \
             ab -> sab -> rab;",
        );
        assert!(jacobian.unknowns.is_empty());
        let (n, states) = (equations.states.len(), anywhere(&equations));
        let rates = closed_rates(&equations, &mut jacobian);
        let switches = equations.switches.len();
        for branch in 0..1_u32 << switches {
            let negative: Vec<bool> = (0..switches).map(|switch| branch >> switch & 1 == 1).collect();
            let environment = Environment {
                time: 0.3,
                states: &states,
                parameters: &[5.0, 3.0],
                negative: &negative,
                ..Environment::default()
            };
            let pool = &mut jacobian.pool;
            let mut expected = Vec::new();
            for column in (0..n).map(Symbol::state).chain([Symbol::Time]) {
                let ids = partial(pool, &rates, column);
                expected.push(evaluate(pool, &ids, &environment));
            }
            let mut found = vec![vec![0.0; n]; n];
            for entry in &jacobian.entries {
                found[entry.column][entry.row] = evaluate(&jacobian.pool, &[entry.value], &environment)[0];
            }
            found.push(evaluate(&jacobian.pool, &jacobian.slopes, &environment));
            let pairs = found.iter().flatten().zip(expected.iter().flatten());
            let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-13, "{negative:?}: {found:?} {expected:?}");
        }
    }
}
