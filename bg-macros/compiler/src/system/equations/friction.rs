//! Dry friction: an R that slides forwards, slides backwards or sticks.
//!
//! In: the R with the clause `holds`. Out: its effort, a multiplier until the reactions are solved for, with the two
//! switches that say how it moves.
//! Method: stuck, the effort is the one that keeps the flow at zero, as that of a residual sink; sliding, it is the
//! law's, against the flow. One switch is negative while it slides forwards, the other while it slides backwards. Their
//! guards depend on their own branches: while it slides, the flow, which has to come to zero; while it sticks, what the
//! effort leaves of the limit.

use super::signals::Signals;
use super::{EquationFault, Reaction, Slip, Switch, Switched};
use crate::expr::{Function, Id, Pool, Symbol, derivative, partial};
use crate::fault::Fault;
use crate::graph::{Element, ElementKind, NodeId};
use crate::system::Value;

/// Time, s, in which the frictions brake a flow that counts as rest: what rounding leaves of it where others hold it as
/// well.
const REST: f64 = 1e-13;

/// A dry friction: what its switches and its effort are made of.
struct Sticking {
    node: NodeId,
    /// Along the half arrow, scalar.
    flow: Value,
    /// The effort up to which it sticks.
    limit: Id,
    /// Its effort while it sticks.
    multiplier: Symbol,
}

impl Signals<'_> {
    /// The elements of dry friction.
    pub(super) fn frictions(&self) -> impl Iterator<Item = NodeId> + use<'_> {
        let resistors = self.elements(|kind| matches!(kind, ElementKind::R | ElementKind::Mr));
        resistors.into_iter().filter(|&node| self.graph.element(node).is_some_and(|element| element.sticking.is_some()))
    }

    /// Every dry friction as the reaction that it is while it sticks.
    pub(super) fn sticking_reactions(&mut self) -> Vec<Reaction> {
        let nodes: Vec<NodeId> = self.frictions().collect();
        let frictions: Vec<Sticking> = nodes.into_iter().map(|node| self.sticking(node)).collect();
        let brakings = self.brakings(&frictions);
        let brakings = brakings.iter().enumerate();
        brakings.map(|(k, braking)| self.sticking_reaction(&frictions, k, braking)).collect()
    }

    fn sticking(&mut self, node: NodeId) -> Sticking {
        let graph = self.graph;
        self.owner.clone_from(&graph.node(node).name.text);
        let bond = graph.node(node).bonds[0];
        let flow = self.flow(bond).scale(&mut self.pool, graph.sign(bond, node));
        let limit = graph.element(node).map_or(self.pool.zero(), |element| self.limit(element));
        Sticking { node, flow, limit, multiplier: Symbol::Multiplier(self.reactions[&node]) }
    }

    /// The effort up to which it sticks: not less than the law's at zero, where neither sliding nor sticking would be
    /// right.
    fn limit(&mut self, element: &Element) -> Id {
        let held = element.sticking.as_ref().map(|limit| self.evaluate(limit, None));
        let held = held.map_or(self.pool.zero(), |held| held.0[0]);
        let rest = Value::zero(&mut self.pool, 1);
        let slides = self.evaluate(element.law.term(), Some(&rest)).0[0];
        let pool = &mut self.pool;
        let more = pool.sub(held, slides);
        if pool.as_number(more).is_some_and(|more| more >= 0.0) {
            return held;
        }
        let apart = pool.call(Function::Abs, &[more]);
        pool.linear(0.0, &[(held, 0.5), (slides, 0.5), (apart, 0.5)])
    }

    /// The change of each flow with time by one unit of each effort.
    fn brakings(&mut self, frictions: &[Sticking]) -> Vec<Vec<Id>> {
        let seeds = self.rate_seeds(&[]);
        let flows: Vec<Id> = frictions.iter().map(|friction| friction.flow.0[0]).collect();
        let rates = derivative(&mut self.pool, &flows, &seeds);
        let by = |pool: &mut Pool, friction: &Sticking| partial(pool, &rates, friction.multiplier);
        let columns: Vec<Vec<Id>> = frictions.iter().map(|friction| by(&mut self.pool, friction)).collect();
        (0..frictions.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
    }

    /// The flow that counts as rest, whoever brakes it.
    fn rest(&mut self, frictions: &[Sticking], braking: &[Id]) -> Id {
        let pool = &mut self.pool;
        let part = |(&by, friction): (&Id, &Sticking)| {
            let product = pool.mul(by, friction.limit);
            pool.call(Function::Abs, &[product])
        };
        let parts: Vec<Id> = braking.iter().zip(frictions).map(part).collect();
        let all = pool.sum(&parts);
        pool.scale(REST, all)
    }

    fn sticking_reaction(&mut self, frictions: &[Sticking], own: usize, braking: &[Id]) -> Reaction {
        let friction = &frictions[own];
        self.check_flow(friction, braking[own]);
        let rest = self.rest(frictions, braking);
        let joint = self.graph.node(friction.node).name.text.clone();
        self.owner.clone_from(&joint);
        let ways = [self.remember("forwards"), self.remember("backwards")];
        self.guard(friction, rest, ways);
        let against = self.sliding(friction);
        let unit = self.graph.bond(self.graph.node(friction.node).bonds[0]).flow_unit();
        let slip = Slip {
            joint,
            direction: String::new(),
            unit,
            flow: friction.flow.0[0],
            kept: None,
            gap: None,
            mobility: None,
        };
        let multiplier = self.pool.symbol(friction.multiplier);
        let effort = self.moving(ways, against, multiplier);
        let (zero, one) = (self.pool.zero(), self.pool.one());
        let acts = self.moving(ways, [zero; 2], one);
        let switched = Some(Switched { effort, acts });
        Reaction { slip, multiplier: frictions[own].multiplier, switched, rebound: None }
    }

    /// One of three values: sliding forwards, sliding backwards, sticking.
    fn moving(&mut self, [forwards, backwards]: [u32; 2], sliding: [Id; 2], sticking: Id) -> Id {
        let otherwise = self.pool.select(backwards, sliding[1], sticking);
        self.pool.select(forwards, sliding[0], otherwise)
    }

    /// A switch of the owner whose guard is not known yet.
    fn remember(&mut self, way: &str) -> u32 {
        let (element, guard) = (self.owner.clone(), self.pool.zero());
        self.switches.push(Switch { element, condition: way.to_owned(), guard, remembers: true, clock: None });
        u32::try_from(self.switches.len() - 1).expect("fewer than 2^32 switches")
    }

    /// Writes the guards of both switches: below zero it slides that way. Both are negative only where the search for
    /// the branches at the start begins; the sign of the flow decides there.
    fn guard(&mut self, friction: &Sticking, rest: Id, ways: [u32; 2]) {
        let (flow, limit) = (friction.flow.0[0], friction.limit);
        let effort = self.pool.symbol(friction.multiplier);
        for (k, sign) in [(0, 1.0), (1, -1.0)] {
            let (own, other) = (ways[k], ways[1 - k]);
            let pool = &mut self.pool;
            let left = pool.linear(0.0, &[(limit, 1.0), (effort, -sign)]);
            let still = pool.select(other, pool.one(), left);
            let first = pool.scale(-sign, flow);
            let sliding = pool.linear(0.0, &[(first, 1.0), (rest, -1.0)]);
            let sliding = pool.select(other, first, sliding);
            self.switches[own as usize].guard = pool.select(own, sliding, still);
        }
    }

    /// The efforts of the law, sliding forwards and backwards: odd in the flow.
    fn sliding(&mut self, friction: &Sticking) -> [Id; 2] {
        let graph = self.graph;
        let Some(element) = graph.element(friction.node) else { return [self.pool.zero(); 2] };
        let law = element.law.term();
        let ahead = self.evaluate(law, Some(&friction.flow));
        let speed = friction.flow.clone().negate(&mut self.pool);
        let back = self.evaluate(law, Some(&speed)).negate(&mut self.pool);
        let efforts = [ahead.0[0], back.0[0]];
        let unknown = self.pool.symbols(&efforts).into_iter().find_map(|symbol| self.unknown_effort(symbol));
        if let Some(by) = unknown {
            let name = graph.node(friction.node).name.text.clone();
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
    fn check_flow(&mut self, friction: &Sticking, braking: Id) {
        let symbols = self.pool.symbols(&friction.flow.0);
        let input =
            symbols.iter().find_map(|symbol| if let Symbol::Input(k) = symbol { Some(*k as usize) } else { None });
        let has_multiplier = symbols.iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)));
        let sticks = !self.pool.is_zero(braking) && input.is_none() && !has_multiplier;
        if !sticks {
            let definition = &self.graph.node(friction.node).name;
            let input = input.map(|input| self.graph.inputs[input].name.text.clone());
            let fault = EquationFault::CannotStick { name: definition.text.clone(), input };
            self.fault_once(Fault::new(definition.span, &fault));
        }
    }
}
