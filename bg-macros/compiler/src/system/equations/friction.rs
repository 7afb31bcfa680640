//! Dry friction: an R that slides forwards, slides backwards or sticks.
//!
//! In: the R with the clause `holds`. Out: its effort, a multiplier until the reactions are solved for, with the two switches
//! that say how it moves.
//! Method: stuck, the effort is the one that keeps the flow at zero, as that of a residual sink; sliding, it is the law's, against
//! the flow. One switch is negative while it slides forwards, the other while it slides backwards. Their guards depend on
//! their own branches: while it slides, the flow, which has to come to zero; while it sticks, what the effort leaves of the limit.

use super::signals::Signals;
use super::{EquationFault, Friction, Reaction, Slip, Switch};
use crate::expr::{Id, Symbol, derivative, partial};
use crate::fault::Fault;
use crate::graph::{Element, ElementKind, NodeId};
use crate::system::Value;

/// Time, s, in which the friction brakes a flow that counts as rest: what rounding leaves of it where others hold it as well.
const REST: f64 = 1e-13;

impl Signals<'_> {
    /// The elements whose efforts are multipliers: residual sinks, then dry friction.
    pub(super) fn unknown_efforts(&self) -> Vec<NodeId> {
        let sinks = self.elements(|kind| kind == ElementKind::RSe);
        sinks.into_iter().chain(self.frictions()).collect()
    }

    /// The elements of dry friction.
    fn frictions(&self) -> impl Iterator<Item = NodeId> + use<'_> {
        let resistors = self.elements(|kind| matches!(kind, ElementKind::R | ElementKind::Mr));
        resistors.into_iter().filter(|&node| self.graph.element(node).is_some_and(|element| element.sticking.is_some()))
    }

    /// Every dry friction as the reaction that it is while it sticks.
    pub(super) fn sticking_reactions(&mut self) -> Vec<Reaction> {
        let graph = self.graph;
        let nodes: Vec<NodeId> = self.frictions().collect();
        nodes.into_iter().filter_map(|node| Some(self.sticking_reaction(node, graph.element(node)?))).collect()
    }

    fn sticking_reaction(&mut self, node: NodeId, element: &Element) -> Reaction {
        let name = &self.graph.node(node).name.text;
        self.owner.clone_from(name);
        let bond = self.graph.node(node).bonds[0];
        let flow = self.flow(bond).scale(&mut self.pool, self.graph.sign(bond, node));
        let multiplier = Symbol::Multiplier(self.reactions[&node]);
        let braking = self.braking(&flow, multiplier);
        self.check_flow(node, &flow, braking);
        let (forwards, backwards) = (self.remember("forwards"), self.remember("backwards"));
        let effort = self.pool.symbol(multiplier);
        self.guard(element, (flow.0[0], effort), braking, [forwards, backwards]);
        let against = self.sliding(node, element, &flow);
        let unit = self.graph.bond(bond).flow_unit();
        let slip = Slip { joint: name.clone(), direction: String::new(), unit, flow: flow.0[0] };
        let effort = self.moving([forwards, backwards], against, effort);
        let (zero, one) = (self.pool.zero(), self.pool.one());
        let sticks = self.moving([forwards, backwards], [zero; 2], one);
        Reaction { slip, multiplier, gap: None, friction: Some(Friction { effort, sticks }) }
    }

    /// One of three values: sliding forwards, sliding backwards, sticking.
    fn moving(&mut self, [forwards, backwards]: [u32; 2], sliding: [Id; 2], sticking: Id) -> Id {
        let otherwise = self.pool.select(backwards, sliding[1], sticking);
        self.pool.select(forwards, sliding[0], otherwise)
    }

    /// A switch of the owner whose guard is not known yet.
    fn remember(&mut self, way: &str) -> u32 {
        let (element, guard) = (self.owner.clone(), self.pool.zero());
        self.switches.push(Switch { element, condition: way.to_owned(), guard, remembers: true });
        u32::try_from(self.switches.len() - 1).expect("fewer than 2^32 switches")
    }

    /// The change of the flow with time by one unit of the effort.
    fn braking(&mut self, flow: &Value, effort: Symbol) -> Id {
        let seeds = self.rate_seeds(&[]);
        let rates = derivative(&mut self.pool, &flow.0, &seeds);
        partial(&mut self.pool, &rates, effort)[0]
    }

    /// Writes the guards of both switches: below zero it slides that way. Both are negative only where the search for the
    /// branches at the start begins; the sign of the flow decides there.
    fn guard(&mut self, element: &Element, (flow, effort): (Id, Id), braking: Id, ways: [u32; 2]) {
        let limit = element.sticking.as_ref().map(|limit| self.evaluate(limit, None));
        let limit = limit.map_or(self.pool.zero(), |limit| limit.0[0]);
        let rest = self.pool.mul(braking, limit);
        for (k, sign) in [(0, 1.0), (1, -1.0)] {
            let (own, other) = (ways[k], ways[1 - k]);
            let pool = &mut self.pool;
            let left = pool.linear(0.0, &[(limit, 1.0), (effort, -sign)]);
            let still = pool.select(other, pool.one(), left);
            let first = pool.scale(-sign, flow);
            let sliding = pool.linear(0.0, &[(first, 1.0), (rest, REST)]);
            let sliding = pool.select(other, first, sliding);
            self.switches[own as usize].guard = pool.select(own, sliding, still);
        }
    }

    /// The efforts of the law, sliding forwards and backwards: odd in the flow.
    fn sliding(&mut self, node: NodeId, element: &Element, flow: &Value) -> [Id; 2] {
        let law = element.law.term();
        let ahead = self.evaluate(law, Some(flow));
        let speed = flow.clone().negate(&mut self.pool);
        let back = self.evaluate(law, Some(&speed)).negate(&mut self.pool);
        let efforts = [ahead.0[0], back.0[0]];
        let unknown = self.pool.symbols(&efforts).into_iter().find_map(|symbol| self.unknown_effort(symbol));
        if let Some(by) = unknown {
            let name = self.graph.node(node).name.text.clone();
            self.fault_once(Fault::new(law.span, &EquationFault::FrictionOfReaction { name, by }));
        }
        efforts
    }

    /// Whose effort a multiplier is.
    fn unknown_effort(&self, symbol: Symbol) -> Option<String> {
        let Symbol::Multiplier(number) = symbol else { return None };
        let owner = self.reactions.iter().filter(|(_, first)| **first <= number).max_by_key(|(_, first)| **first);
        owner.map(|(&node, _)| self.holder(node).to_owned())
    }

    /// What sticks needs a flow that the friction's effort changes in time: one that momenta determine, and no input.
    fn check_flow(&mut self, node: NodeId, flow: &Value, braking: Id) {
        let symbols = self.pool.symbols(&flow.0);
        let input =
            symbols.iter().find_map(|symbol| if let Symbol::Input(k) = symbol { Some(*k as usize) } else { None });
        let has_multiplier = symbols.iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)));
        let sticks = !self.pool.is_zero(braking) && input.is_none() && !has_multiplier;
        if !sticks && !self.is_in_a_loop(flow) {
            let definition = &self.graph.node(node).name;
            let input = input.map(|input| self.graph.inputs[input].name.text.clone());
            let fault = EquationFault::CannotStick { name: definition.text.clone(), input };
            self.fault_once(Fault::new(definition.span, &fault));
        }
    }
}
