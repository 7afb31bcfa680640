//! The states of second order and their second derivatives.
//!
//! In: [`Projected`] equations. Out: the same with their states [`Ordered`]; of these [`Closed`] the displacements and
//! orientations that follow the momenta, each with d2x/dt2 as a function of the states and their rates, in a
//! [`SecondOrder`] with a pool of its own. In a bond graph these are the kinematics: where things are follows from how
//! they move. What a resistor moves, as a spring in series with a damper, is of first order.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::expr::{Id, Node, Pool, Symbol, derivative};
use crate::system::equations::stage::{Closed, Ordered, Projected};
use crate::system::equations::{Kind, State, StateEquations};

/// Second derivatives as expressions.
#[derive(Clone, Debug)]
pub struct SecondOrder {
    /// The expressions.
    pub pool: Pool,
    /// The states of second order.
    pub states: Range<usize>,
    /// d2x/dt2 of each, of states and [`Symbol::Rate`]s.
    pub derivatives: Vec<Id>,
    /// The rates of all states, with d2x/dt2 in the places of these, of states alone.
    pub forces: Vec<Id>,
}

/// Puts states of second order side by side, and of these and the others together what is of one kind and unit. Sums
/// over states then have one weight for many; what comes in twos, as x and y, stays at even places, for pairs, if odd
/// numbers come after. Integrals that only watch come last.
#[must_use]
pub fn order(Projected(mut equations): Projected) -> Ordered {
    sort(&mut equations);
    Ordered(equations)
}

fn sort(equations: &mut StateEquations) {
    let states = &equations.states;
    let is_second: Vec<bool> = (0..states.len()).map(|index| is_of_second_order(equations, index)).collect();
    let kind = |index: usize| (is_second[index], states[index].origin.kind(), &states[index].unit);
    let of_kind = |index: usize| (0..states.len()).filter(move |&other| kind(other) == kind(index));
    let place = |index: usize| match (is_second[index], of_kind(index).count() % 2) {
        _ if states[index].origin.kind() == Kind::Integral => 4,
        (false, 0) => 0,
        (true, 0) => 1,
        (true, _) => 2,
        (false, _) => 3,
    };
    let mut order: Vec<usize> = (0..states.len()).collect();
    order.sort_by_key(|&index| (place(index), of_kind(index).next()));
    let mut to = vec![0; order.len()];
    for (place, &index) in (0..).zip(&order) {
        to[index] = place;
    }
    equations.states = order.iter().map(|&index| equations.states[index].clone()).collect();
    for (state, _) in equations.projections.iter_mut().chain(&mut equations.settled) {
        *state = to[*state] as usize;
    }
    equations.holding.renumber(&|state| Some(to[state] as usize));
    equations.impacts.renumber(&|state| Some(to[state] as usize));
    equations.pool.renumber_states(&to);
}

/// Finds the states of second order, which [`order`] has put side by side, and differentiates their rates along the
/// flow.
#[must_use]
pub fn differentiate(equations: &Closed) -> SecondOrder {
    let mut pool = equations.pool.clone();
    let is_second = |index: &usize| is_of_second_order(equations, *index);
    let first = (0..equations.states.len()).find(is_second).unwrap_or(0);
    let states = first..first + (first..equations.states.len()).take_while(is_second).count();
    let rates: Vec<Id> = equations.states[states.clone()].iter().map(|state| state.rate).collect();
    let (mut given, mut known) = (BTreeMap::new(), BTreeMap::new());
    for symbol in pool.symbols(&rates) {
        if let Symbol::State(index) = symbol {
            given.insert(symbol, pool.symbol(Symbol::Rate(index)));
            known.insert(symbol, equations.states[index as usize].rate);
        }
    }
    let derivatives = derivative(&mut pool, &rates, &given);
    let mut forces: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    forces.splice(states.clone(), derivative(&mut pool, &rates, &known));
    SecondOrder { pool, states, derivatives, forces }
}

/// Whether the state is a displacement or orientation whose rate is a function of momenta, positions and orientations
/// alone, without branches, and of one momentum at least.
fn is_of_second_order(equations: &StateEquations, index: usize) -> bool {
    let (pool, state): (&Pool, &State) = (&equations.pool, &equations.states[index]);
    let kind = |index: u32| equations.states[index as usize].origin.kind();
    let is_kinematic = |id: &Id| match *pool.node(*id) {
        Node::Symbol(Symbol::State(index)) => {
            matches!(kind(index), Kind::Momentum | Kind::Position | Kind::Orientation)
        }
        Node::Symbol(symbol) => matches!(symbol, Symbol::Parameter(_)),
        Node::Select { .. } => false,
        Node::Number(_) | Node::Sum { .. } | Node::Product(_) | Node::Call(..) => true,
    };
    let is_momentum = |symbol: Symbol| matches!(symbol, Symbol::State(index) if kind(index) == Kind::Momentum);
    matches!(state.origin.kind(), Kind::Position | Kind::Orientation | Kind::Displacement | Kind::Way)
        && pool.reachable(&[state.rate]).iter().all(is_kinematic)
        && pool.symbols(&[state.rate]).into_iter().any(is_momentum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, evaluate};
    use crate::pipeline;
    use crate::source::syntax;

    /// Two masses on springs, a spring and a damper in series between them, and a flywheel beside.
    const GRAPH: &str = "graph G {
        param k: N/m = 3; param c: N*s/m = 2; param j: kg*m^2 = 5;
        1 wheel: rotation; I flywheel = j start 2; C twist(q) = 7 * q; wheel -> flywheel; wheel -> twist;
        1 left: translation; C spring = k start 0.5; I mass = 4 start 3; left -> spring; left -> mass;
        1 right: translation; C stop = k; I block = 4 start 2; right -> stop; right -> block;
        0 between: translation; C relaxing = k start 0.25; R damper = c;
        left -> between; between -> right; between -> relaxing; between -> damper;
        observe { v: m/s = left.flow; w: J = integral(mass.power); }
    }";

    fn equations() -> StateEquations {
        let source = syntax::parse(GRAPH.parse().expect("tokens")).expect("a graph");
        pipeline::derive(&source.graphs[0]).expect("equations").equations
    }

    /// Each state's rate, where the states have the values that stand after their names.
    fn rates(equations: &StateEquations, values: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
        let states: Vec<f64> = equations.states.iter().map(|state| values[&state.name]).collect();
        let ids: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
        let environment = Environment { states: &states, parameters: &[3.0, 2.0, 5.0], ..Environment::default() };
        let rates = evaluate(&equations.pool, &ids, &environment);
        equations.states.iter().map(|state| state.name.clone()).zip(rates).collect()
    }

    #[test]
    fn states_of_second_order_come_side_by_side_and_their_rates_stay() {
        let mut equations = equations();
        let names =
            |equations: &StateEquations| equations.states.iter().map(|state| state.name.clone()).collect::<Vec<_>>();
        let values: BTreeMap<String, f64> =
            names(&equations).into_iter().zip((1..).map(|k| 0.3 * f64::from(k))).collect();
        let before = rates(&equations, &values);
        sort(&mut equations);
        let arranged = ["mass.p", "block.p", "spring.q", "stop.q", "twist.q", "flywheel.p", "relaxing.q", "w"];
        assert_eq!(names(&equations), arranged);
        assert_eq!(rates(&equations, &values), before);
        let second = differentiate(&Ordered(equations).close());
        assert_eq!(second.states, 2..5);
    }

    #[test]
    fn an_arrangement_stays_as_it_is() {
        let mut equations = equations();
        sort(&mut equations);
        let before = format!("{equations:?}");
        sort(&mut equations);
        assert!(format!("{equations:?}") == before);
    }
}
