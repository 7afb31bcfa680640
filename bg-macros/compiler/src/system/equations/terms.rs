//! Terms of the graph to component expressions.
//!
//! In: [`Term`]. Out: [`Value`]. A comparison becomes a switch with a real-valued guard.

use super::signals::Signals;
use super::{Clock, Switch};
use crate::expr::{Function, Id, Symbol};
use crate::graph::{
    self, Allowed, BinaryOperator, Builtin, Comparison, ElementKind, NodeId, NodeKind, Reference, Storage, Term,
    TermKind,
};
use crate::system::Value;

impl Signals<'_> {
    /// The value of a term; `variable` is that of the law it stands in.
    pub(super) fn evaluate(&mut self, term: &Term, variable: Option<&Value>) -> Value {
        match &term.kind {
            TermKind::Number(value) | TermKind::Quantity(value, _) => Value::scalar(self.pool.number(*value)),
            TermKind::Reference(reference) => self.reference(*reference, variable),
            TermKind::Component(inner, index) => {
                let inner = self.evaluate(inner, variable);
                Value::scalar(inner.0[*index])
            }
            TermKind::Lookup(lookup, arguments) => {
                let arguments: Vec<Id> = arguments.iter().map(|part| self.evaluate(part, variable).0[0]).collect();
                Value::scalar(self.lookup(*lookup, &arguments, variable.is_some()))
            }
            TermKind::Negate(inner) => {
                let inner = self.evaluate(inner, variable);
                inner.negate(&mut self.pool)
            }
            TermKind::Chain(first, rest) => {
                let first = self.evaluate(first, variable);
                rest.iter().fold(first, |left, operation| {
                    let right = self.evaluate(&operation.operand, variable);
                    let pool = &mut self.pool;
                    match operation.operator {
                        BinaryOperator::Add => left.add(pool, &right),
                        BinaryOperator::Subtract => {
                            let right = right.negate(pool);
                            left.add(pool, &right)
                        }
                        BinaryOperator::Multiply => left.multiply(pool, &right),
                        BinaryOperator::Divide => left.divide(pool, right.0[0]),
                    }
                })
            }
            TermKind::Call(builtin, arguments) => {
                let arguments: Vec<Value> = arguments.iter().map(|part| self.evaluate(part, variable)).collect();
                self.call(*builtin, &arguments)
            }
            TermKind::Vector(parts) => Value(parts.iter().flat_map(|part| self.evaluate(part, variable).0).collect()),
            TermKind::If(comparison, condition, parts) => {
                let [left, right, then, otherwise] = &**parts;
                let [left, right] = [left, right].map(|part| self.evaluate(part, variable).0[0]);
                let then = self.evaluate(then, variable);
                let otherwise = self.evaluate(otherwise, variable);
                self.choose((*comparison, condition), (left, right), &then, &otherwise)
            }
            TermKind::AtInstant(clock, parts) => {
                let switch = self.clock(*clock);
                let [now, held] = [&parts[0], &parts[1]].map(|part| self.evaluate(part, variable).0[0]);
                Value::scalar(self.pool.select(switch, now, held))
            }
            TermKind::Guess(index) => Value::scalar(self.numbered(*index, Symbol::Unknown)),
            TermKind::Integral(index) => Value::scalar(self.state_symbol(self.first_integral + index)),
        }
    }

    fn numbered(&mut self, index: usize, symbol: fn(u32) -> Symbol) -> Id {
        self.pool.symbol(Symbol::numbered(symbol, index))
    }

    fn reference(&mut self, reference: Reference, variable: Option<&Value>) -> Value {
        match reference {
            Reference::Time => Value::scalar(self.pool.symbol(Symbol::Time)),
            Reference::Variable => variable.cloned().expect("a law's variable has a value"),
            Reference::Parameter(index) => Value::scalar(self.numbered(index, Symbol::Parameter)),
            Reference::Input(index) => Value::scalar(self.numbered(index, Symbol::Input)),
            Reference::Let(index) => self.named_expression(index),
            Reference::Own(index) => Value::scalar(self.state_symbol(self.first_integral + index)),
            Reference::Track(index) => self.state(Storage::Track(index)).expect("every track has states"),
            Reference::Flow(node) => self.node_flow(node),
            Reference::Effort(node) => {
                let bond = self.graph.node(node).bonds[0];
                match self.graph.node(node).kind {
                    NodeKind::Zero => {
                        let strong = self.causal.strong_bond(node).unwrap_or(bond);
                        self.effort(strong)
                    }
                    _ => self.effort(bond),
                }
            }
            Reference::Power(node) => Value::scalar(self.power_into(node)),
            Reference::Energy(node) => Value::scalar(self.energy_of(node)),
            Reference::Displacement(node) if matches!(self.graph.node(node).kind, NodeKind::One) => {
                Value::scalar(self.way(node))
            }
            Reference::Turn(index) => Value::scalar(self.turn(index)),
            Reference::Displacement(node) | Reference::Momentum(node) => self.element_state(node),
            Reference::StoredEnergy => Value::scalar(self.stored_energy()),
            Reference::SuppliedPower => Value::scalar(self.supplied_power()),
            Reference::DissipatedPower => Value::scalar(self.dissipated_power()),
        }
    }

    pub(super) fn named_expression(&mut self, index: usize) -> Value {
        if let Some(value) = &self.memo.lets[index] {
            return value.clone();
        }
        let graph = self.graph;
        let definition = &graph.lets[index];
        let owner = std::mem::replace(&mut self.owner, definition.name.text.clone());
        let is_rotation = definition.clause.as_ref().is_some_and(|clause| clause.allowed == Allowed::Rotation);
        let value = &definition.value;
        let value = if is_rotation { self.orientation_of(value) } else { self.evaluate(value, None) };
        self.owner = owner;
        self.memo.lets[index] = Some(value.clone());
        value
    }

    /// The flow of a 1-junction, or of an element's first bond.
    fn node_flow(&mut self, node: NodeId) -> Value {
        match self.graph.node(node).kind {
            NodeKind::One => self.junction_flow(node),
            _ => {
                let bond = self.graph.node(node).bonds[0];
                self.flow(bond)
            }
        }
    }

    /// The power into a one-port.
    pub(super) fn power_into(&mut self, node: NodeId) -> Id {
        let bond = self.graph.node(node).bonds[0];
        let (effort, flow) = (self.effort(bond), self.flow(bond));
        let power = effort.dot(&mut self.pool, &flow);
        self.pool.scale(self.graph.sign(bond, node), power)
    }

    /// The power of all sources into the model.
    pub(super) fn supplied_power(&mut self) -> Id {
        use ElementKind as K;
        let powers: Vec<Id> = self
            .elements(|kind| matches!(kind, K::Se | K::MSe | K::Sf | K::MSf))
            .into_iter()
            .map(|node| {
                let power = self.power_into(node);
                self.pool.neg(power)
            })
            .collect();
        let prescribed = self.prescribed_power();
        let modulation = self.modulation_power();
        let sources = self.pool.sum(&powers);
        self.pool.sum(&[sources, prescribed, modulation])
    }

    /// The power of residual sinks that prescribe a flow; those that keep it at zero have none.
    fn prescribed_power(&mut self) -> Id {
        let graph = self.graph;
        let mut powers = Vec::new();
        for node in self.elements(|kind| kind == ElementKind::RSe) {
            let Some(element) = graph.element(node) else { continue };
            let flow = self.evaluate(element.law.term(), None);
            if !flow.0.iter().all(|&id| self.pool.is_zero(id)) {
                let power = self.power_into(node);
                powers.push(self.pool.neg(power));
            }
        }
        self.pool.sum(&powers)
    }

    /// The power of all resistors out of the model, and of stops, which take some in the instants of impacts.
    pub(super) fn dissipated_power(&mut self) -> Id {
        let resistors = self.elements(|kind| matches!(kind, ElementKind::R | ElementKind::Mr));
        let taking = resistors.into_iter().chain(self.stops());
        let powers: Vec<Id> = taking.map(|node| self.power_into(node)).collect();
        self.pool.sum(&powers)
    }

    /// The elements of some kinds in the order of declaration.
    pub(super) fn elements(&self, wanted: impl Fn(ElementKind) -> bool) -> Vec<NodeId> {
        (0..self.graph.nodes.len())
            .map(NodeId)
            .filter(|&node| self.graph.element(node).is_some_and(|element| wanted(element.kind)))
            .collect()
    }

    /// One of two values by a comparison; equal guards share one switch, up to their sign.
    pub(super) fn choose(
        &mut self,
        (comparison, condition): (Comparison, &str),
        (left, right): (Id, Id),
        then: &Value,
        otherwise: &Value,
    ) -> Value {
        let guard = match comparison {
            Comparison::Less | Comparison::LessOrEqual => self.pool.sub(left, right),
            Comparison::Greater | Comparison::GreaterOrEqual => self.pool.sub(right, left),
        };
        if let Some(value) = self.pool.as_number(guard) {
            return if value < 0.0 { then.clone() } else { otherwise.clone() };
        }
        let opposite = self.pool.neg(guard);
        let (switch, swapped) = if let Some(known) = self.switches.iter().position(|switch| switch.guard == guard) {
            (known, false)
        } else if let Some(known) = self.switches.iter().position(|switch| switch.guard == opposite) {
            (known, true)
        } else {
            let (element, condition) = (self.owner.clone(), condition.to_owned());
            self.switches.push(Switch { element, condition, guard, remembers: false, clock: None });
            (self.switches.len() - 1, false)
        };
        let (negative, positive) = if swapped { (otherwise, then) } else { (then, otherwise) };
        let switch = u32::try_from(switch).expect("fewer than 2^32 switches");
        let pairs = negative.0.iter().zip(&positive.0);
        Value(pairs.map(|(&negative, &positive)| self.pool.select(switch, negative, positive)).collect())
    }

    /// The switch of a clock; clocks with the same instants share one.
    fn clock(&mut self, clock: usize) -> u32 {
        let &graph::Clock { ref text, ref period, ref first, delay } = &self.graph.clocks[clock];
        let [period, first] = [period, first].map(|index| self.named_expression(*index).0[0]);
        let clock = Some(Clock { period, first, delay });
        let known = self.switches.iter().position(|switch| switch.clock == clock);
        let switch = known.unwrap_or_else(|| {
            let (element, condition, guard) = (self.owner.clone(), text.clone(), self.pool.number(1.0));
            self.switches.push(Switch { element, condition, guard, remembers: false, clock });
            self.switches.len() - 1
        });
        u32::try_from(switch).expect("fewer than 2^32 switches")
    }

    fn call(&mut self, builtin: Builtin, arguments: &[Value]) -> Value {
        use Builtin as B;
        let pool = &mut self.pool;
        let function = match builtin {
            B::Dot => return Value::scalar(arguments[0].dot(pool, &arguments[1])),
            B::Cross => return arguments[0].cross(pool, &arguments[1]),
            B::Norm => return Value::scalar(arguments[0].norm(pool)),
            B::Skew => return arguments[0].skew(pool),
            B::Transpose => return arguments[0].transpose(),
            B::Inverse => return arguments[0].inverse(pool),
            B::Outer => return arguments[0].outer(pool, &arguments[1]),
            B::Identity => return Value::identity(pool),
            B::Diagonal => return Value::diagonal(pool, &arguments[0].0),
            B::RotationX => return Value::rotation(pool, 0, arguments[0].0[0]),
            B::RotationY => return Value::rotation(pool, 1, arguments[0].0[0]),
            B::RotationZ => return Value::rotation(pool, 2, arguments[0].0[0]),
            B::Root => return Value::scalar(pool.laminar_root(arguments[0].0[0], arguments[1].0[0])),
            B::Sqrt => Function::Sqrt,
            B::Sin => Function::Sin,
            B::Cos => Function::Cos,
            B::Tan => Function::Tan,
            B::Asin => Function::Asin,
            B::Acos => Function::Acos,
            B::Atan2 => Function::Atan2,
            B::Exp => Function::Exp,
            B::Ln => Function::Ln,
            B::Tanh => Function::Tanh,
            B::Abs => Function::Abs,
            B::Pow => Function::Pow,
        };
        let scalars: Vec<Id> = arguments.iter().map(|argument| argument.0[0]).collect();
        Value::scalar(pool.call(function, &scalars))
    }
}
