//! Stops with a restitution: residual sinks that act one way only.
//!
//! In: residual sinks with the clause `restitution`. Out: their efforts, multipliers until the reactions are solved
//! for, each with the switch that says whether something is clear of the stop or rests on it, and what an impact is
//! calculated from. Method: at rest the effort is the one that keeps the flow at zero, as that of a residual sink;
//! clear of the stop it is 0. The switch is negative while it is clear. Its guard depends on its own branch: clear of
//! the stop, how far its end is passed; at rest, the effort, which presses as long as it is not negative. What happens
//! where the end is reached is not in the equations: momenta jump there, as the run time calculates from
//! [`super::impact::Impacts`]. Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (1996),
//! chapters 5 and 8.

use super::signals::Signals;
use super::{CLEAR, EquationFault, Reaction, Rebound, Slip, Switch, Switched};
use crate::expr::{Symbol, derivative, partial};
use crate::fault::Fault;
use crate::graph::{Allowed, ElementKind, NodeId};
use crate::system::Value;
use crate::system::requirements::Subject;

/// The rate with which truncation of what rests decays, 1/s: slow, so that no explicit step is the shorter for it, and
/// critically damped, since a stop knows its place.
pub const RETURN: f64 = 1.0;

impl Signals<'_> {
    /// Whether a residual sink acts one way only.
    pub(super) fn is_stop(&self, node: NodeId) -> bool {
        self.graph.element(node).is_some_and(|element| element.restitution.is_some())
    }

    /// The residual sinks that act one way only.
    pub(super) fn stops(&self) -> Vec<NodeId> {
        let sinks = self.elements(|kind| kind == ElementKind::RSe);
        sinks.into_iter().filter(|&node| self.is_stop(node)).collect()
    }

    /// Every stop as the reaction that it is while something rests on it.
    pub(super) fn resting_reactions(&mut self) -> Vec<Reaction> {
        self.stops().into_iter().filter_map(|node| self.resting_reaction(node)).collect()
    }

    fn resting_reaction(&mut self, node: NodeId) -> Option<Reaction> {
        let graph = self.graph;
        let element = graph.element(node)?;
        let name = graph.node(node).name.text.clone();
        self.owner.clone_from(&name);
        let bond = graph.node(node).bonds[0];
        let flow = self.flow(bond).scale(&mut self.pool, graph.sign(bond, node));
        let beyond = self.evaluate(element.displacement.as_ref()?, None).0[0];
        let restitution = self.evaluate(element.restitution.as_ref()?, None).0[0];
        let rest = element.rest.as_ref().map(|rest| self.evaluate(rest, None).0[0]);
        let multiplier = Symbol::Multiplier(self.reactions[&node]);
        self.check_stop(node, &flow, multiplier);
        let number = u32::try_from(self.switches.len()).expect("fewer than 2^32 switches");
        let pool = &mut self.pool;
        let (zero, one, effort) = (pool.zero(), pool.one(), pool.symbol(multiplier));
        let guard = pool.select(number, beyond, effort);
        let switched = Switched { effort: pool.select(number, zero, effort), acts: pool.select(number, zero, one) };
        self.switches.push(Switch {
            element: name.clone(),
            condition: CLEAR.to_owned(),
            guard,
            remembers: true,
            clock: None,
        });
        let unit = graph.bond(bond).flow_unit();
        let (flow, gap) = (flow.0[0], Some(beyond));
        let slip = Slip { joint: name, direction: String::new(), unit, flow, kept: None, gap, mobility: None };
        let rebound = Some(Rebound { switch: number, restitution, rest });
        Some(Reaction { slip, multiplier, switched: Some(switched), rebound })
    }

    /// What a stop holds needs a flow that its effort changes in time: one that momenta determine, and no input.
    fn check_stop(&mut self, node: NodeId, flow: &Value, multiplier: Symbol) {
        let seeds = self.rate_seeds(&[]);
        let rates = derivative(&mut self.pool, &flow.0, &seeds);
        let by = partial(&mut self.pool, &rates, multiplier);
        let is_given = |symbol: Symbol| matches!(symbol, Symbol::Input(_) | Symbol::Multiplier(_));
        let stops = !self.pool.is_zero(by[0]) && !self.pool.symbols(&flow.0).into_iter().any(is_given);
        if !stops {
            let definition = &self.graph.node(node).name;
            let fault = EquationFault::CannotStop { name: definition.text.clone() };
            self.fault_once(Fault::new(definition.span, &fault));
        }
    }

    /// What is asked of stops: that they begin within their ends.
    pub(super) fn clearances(&mut self) -> Vec<(Subject, Value)> {
        let graph = self.graph;
        let mut asked = Vec::new();
        for node in self.stops() {
            let Some(term) = graph.element(node).and_then(|element| element.displacement.as_ref()) else { continue };
            let beyond = self.evaluate(term, None);
            let at_start = self.at_start(&beyond.0);
            let (span, name) = (graph.node(node).name.span, &graph.node(node).name.text);
            let what = format!("the start of stop `{name}`");
            let subject = Subject { what, unit: String::new(), span, allowed: Allowed::Clearance };
            asked.push((subject, Value(at_start).negate(&mut self.pool)));
        }
        asked
    }
}
