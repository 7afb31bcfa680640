//! Reactions of rigid joints: efforts that are not given but keep a flow at zero.
//!
//! In: residual sinks, storages whose states are kept in step. Out: [`Reaction`]s over multipliers, to be solved for
//! where the rates are known. Source: the residual sink of Borutzky, Bond Graph Methodology (2010), section 4.

use super::signals::Signals;
use super::{Reaction, Slip};
use crate::expr::{Id, Symbol};
use crate::graph::{ElementKind, NodeId};
use crate::system::Value;

impl Signals<'_> {
    /// The unknown effort of a residual sink, of a stop or of dry friction.
    pub(super) fn reaction(&mut self, node: NodeId) -> Value {
        let components = self.graph.bond(self.graph.node(node).bonds[0]).cardinality;
        let symbols: Vec<Symbol> = self.multipliers(node, components).collect();
        Value(symbols.into_iter().map(|symbol| self.pool.symbol(symbol)).collect())
    }

    fn multipliers(&self, node: NodeId, components: usize) -> impl Iterator<Item = Symbol> + use<> {
        (self.reactions[&node]..).take(components).map(Symbol::Multiplier)
    }

    /// Every residual sink's multipliers with the flows they keep at zero, then those of stops and of dry friction.
    pub(super) fn reactions(&mut self) -> Vec<Reaction> {
        let graph = self.graph;
        let is_held = |node: &NodeId| self.reactions.contains_key(node);
        let held: Vec<NodeId> = self.dependent.keys().copied().filter(is_held).collect();
        let sinks = self.elements(|kind| kind == ElementKind::RSe).into_iter().filter(|&node| !self.is_stop(node));
        let nodes: Vec<NodeId> = sinks.chain(held).collect();
        let mut reactions = Vec::new();
        for node in nodes {
            let Some(element) = graph.element(node) else { continue };
            if self.dependent.contains_key(&node) {
                let slips = self.dependent_slips(node);
                let multipliers = self.multipliers(node, slips.len());
                let pairs = multipliers.zip(slips);
                reactions.extend(pairs.map(|(multiplier, slip)| Reaction {
                    slip,
                    multiplier,
                    switched: None,
                    rebound: None,
                }));
                continue;
            }
            let bond = graph.node(node).bonds[0];
            // The law is the flow along the half arrow; the reaction acts against the flow into the sink.
            let sign = graph.sign(bond, node);
            let flow = self.flow(bond).scale(&mut self.pool, sign);
            let wanted = self.evaluate(element.law.term(), None).negate(&mut self.pool).scale(&mut self.pool, sign);
            let excess = flow.add(&mut self.pool, &wanted);
            let gap: Option<Vec<Id>> = element.displacement.as_ref().map(|gap| self.evaluate(gap, None).0);
            let multipliers = self.multipliers(node, excess.0.len());
            for (k, (multiplier, &flow)) in multipliers.zip(&excess.0).enumerate() {
                let joint = self.holder(node).to_owned();
                let (direction, unit) = (self.direction_of(node, k), graph.bond(bond).flow_unit());
                let gap = gap.as_ref().map(|gap| gap[k]);
                let slip = Slip { joint, direction, unit, flow, kept: None, gap, mobility: None };
                reactions.push(Reaction { slip, multiplier, switched: None, rebound: None });
            }
        }
        reactions.extend(self.resting_reactions());
        reactions.extend(self.sticking_reactions());
        reactions
    }
}
