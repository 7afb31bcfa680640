//! Angles that count turns, and displacements of junctions.
//!
//! In: what laws and outputs read of them. Out: a state each, its start, its rate, its projection.
//! Method: an angle that its sine and cosine give is known but for whole turns. The state of such an angle is the
//! integral of its speed, from the angle in one turn at the start on, and tells which turn it is: the angle is the
//! state and the small angle from there to where sine and cosine point, `atan2(s cos q - c sin q, c cos q + s sin q)`.
//! So it has the accuracy of the pose, jumps nowhere, and the speed may be rough. After a step the state becomes the
//! angle. Where the state is proved to be the angle, [`Symbol::Turned`] of it becomes 0 (`reduce/turned.rs`).

use super::signals::Signals;
use super::{EquationFault, Origin, State};
use crate::expr::{Function, Id, Symbol};
use crate::fault::Fault;
use crate::graph::{NodeId, TermKind};
use crate::system::Value;

impl Signals<'_> {
    /// Gives the angles and displacements that something reads their states.
    pub(super) fn lay_out_ways(&mut self) {
        let zero = self.pool.zero();
        let mut state = |name: String, unit: String, origin: Origin| {
            self.states.push(State { name, unit, origin, start: zero, rate: zero });
            self.states.len() - 1
        };
        for (index, turn) in self.graph.turns.iter().enumerate().filter(|(_, turn)| turn.is_read) {
            self.turns.insert(index, state(turn.name.clone(), "rad".to_owned(), Origin::Turn(index)));
        }
        for &node in &self.graph.ways {
            let definition = self.graph.node(node);
            let unit = self.graph.bond(definition.bonds[0]).displacement_unit();
            let name = format!("{}.displacement", definition.name.text);
            self.ways.insert(node, state(name, unit, Origin::Way(node)));
        }
    }

    /// The displacement of a scalar 1-junction since the start.
    pub(super) fn way(&mut self, node: NodeId) -> Id {
        let state = self.ways[&node];
        self.state_symbol(state)
    }

    /// An angle with its turns.
    pub(super) fn turn(&mut self, index: usize) -> Id {
        let state = self.turns[&index];
        let counted = self.state_symbol(state);
        let [sine, cosine] = self.sine_and_cosine(index);
        let pool = &mut self.pool;
        let (s, c) = (pool.call(Function::Sin, &[counted]), pool.call(Function::Cos, &[counted]));
        let mut combined = |[a, b]: [Id; 2], [d, e]: [Id; 2], sign: f64| {
            let (first, second) = (pool.mul(a, b), pool.mul(d, e));
            pool.linear(0.0, &[(first, 1.0), (second, sign)])
        };
        let (across, along) = (combined([sine, c], [cosine, s], -1.0), combined([cosine, c], [sine, s], 1.0));
        let rest = pool.call(Function::Atan2, &[across, along]);
        let turned = pool.symbol(Symbol::numbered(Symbol::Turned, index));
        let rest = pool.mul(turned, rest);
        pool.add(counted, rest)
    }

    fn sine_and_cosine(&mut self, index: usize) -> [Id; 2] {
        let TermKind::Call(_, parts) = &self.graph.turns[index].direction.kind else {
            unreachable!("a direction is that of a sine and a cosine")
        };
        [0, 1].map(|k| self.evaluate(&parts[k], None).0[0])
    }

    /// Their states, each with its rate.
    pub(super) fn rates_of_ways(&mut self) -> Vec<(usize, Value)> {
        let (graph, turns, ways) = (self.graph, self.turns.clone(), self.ways.clone());
        let turns = turns.into_iter().map(|(index, state)| (state, self.evaluate(&graph.turns[index].speed, None)));
        let mut rates: Vec<(usize, Value)> = turns.collect();
        rates.extend(ways.into_iter().map(|(node, state)| (state, self.junction_flow(node))));
        rates
    }

    /// Gives the states these rates.
    pub(super) fn way_rates(&mut self) {
        for (state, rate) in self.rates_of_ways() {
            self.states[state].rate = rate.0[0];
        }
    }

    /// The angles in one turn at the start.
    pub(super) fn way_starts(&mut self) {
        for (index, state) in self.turns.clone() {
            let direction = &self.graph.turns[index].direction;
            let value = self.evaluate(direction, None);
            let start = self.at_start(&value.0)[0];
            let is_known = |symbol| matches!(symbol, Symbol::Parameter(_) | Symbol::Unknown(_));
            if !self.pool.symbols(&[start]).into_iter().all(is_known) {
                let name = self.graph.turns[index].name.clone();
                self.faults.push(Fault::new(direction.span, &EquationFault::UnknownTurn { name }));
            }
            self.states[state].start = start;
        }
    }

    /// The angles themselves, in place of their states.
    pub(super) fn turn_projections(&mut self) -> Vec<(usize, Id)> {
        self.turns.clone().into_iter().map(|(index, state)| (state, self.turn(index))).collect()
    }
}
