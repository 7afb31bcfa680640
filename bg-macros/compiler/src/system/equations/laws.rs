//! What an element gives on its bonds.
//!
//! In: constitutive laws. Out: the effort or flow of a bond as the law has it.

use super::EquationFault;
use super::signals::Signals;
use crate::expr::{Id, Symbol, partial, substitute};
use crate::fault::Fault;
use crate::graph::{BondId, Element, ElementKind, Law, NodeId, Role, Storage, Term};
use crate::system::Value;

impl Signals<'_> {
    /// The effort that an element gives on a bond.
    pub(super) fn element_effort(&mut self, node: NodeId, element: &Element, bond: BondId) -> Value {
        use ElementKind as K;
        self.own(node);
        match element.kind {
            K::Se | K::MSe => self.evaluate(element.law.term(), None),
            K::I if self.dependent.contains_key(&node) => self.dependent_given(node).expect("a storage"),
            K::RSe => self.reaction(node),
            K::R | K::Mr if element.sticking.is_some() => self.reaction(node),
            K::C => {
                let displacement = self.element_state(node);
                self.storage_law(node, element, &displacement)
            }
            K::R | K::Mr => {
                let flow = self.flow(bond);
                let flow = flow.scale(&mut self.pool, self.graph.sign(bond, node));
                self.own(node);
                match &element.law {
                    Law::Of { value, .. } => self.evaluate(value, Some(&flow)),
                    law => {
                        let resistance = self.evaluate(law.term(), None);
                        resistance.act(&mut self.pool, &flow)
                    }
                }
            }
            K::Tf | K::Mtf => self.through_transformer(node, element, bond, Role::Effort),
            K::Gy | K::Mgy => self.through_gyrator(node, element, bond, Role::Effort),
            K::Sf | K::MSf | K::I => Value::zero(&mut self.pool, self.graph.bond(bond).cardinality),
        }
    }

    /// The flow that an element gives on a bond.
    pub(super) fn element_flow(&mut self, node: NodeId, element: &Element, bond: BondId) -> Value {
        use ElementKind as K;
        self.own(node);
        match element.kind {
            K::Sf | K::MSf => self.evaluate(element.law.term(), None),
            K::C if self.dependent.contains_key(&node) => self.dependent_given(node).expect("a storage"),
            K::I => {
                let momentum = self.element_state(node);
                let flow = self.storage_law(node, element, &momentum);
                flow.scale(&mut self.pool, self.graph.sign(bond, node))
            }
            K::R | K::Mr => {
                let effort = self.effort(bond);
                self.own(node);
                let flow = match &element.law {
                    Law::Of { value, .. } => self.evaluate(value, Some(&effort)),
                    law => {
                        let resistance = self.evaluate(law.term(), None);
                        let conductance = resistance.reciprocal(&mut self.pool);
                        conductance.act(&mut self.pool, &effort)
                    }
                };
                flow.scale(&mut self.pool, self.graph.sign(bond, node))
            }
            K::Tf | K::Mtf => self.through_transformer(node, element, bond, Role::Flow),
            K::Gy | K::Mgy => self.through_gyrator(node, element, bond, Role::Flow),
            K::Se | K::MSe | K::RSe | K::C => Value::zero(&mut self.pool, self.graph.bond(bond).cardinality),
        }
    }

    fn own(&mut self, node: NodeId) {
        self.owner.clone_from(&self.graph.node(node).name.text);
    }

    /// The state of a C or I; of a C whose displacement the poses determine, that.
    pub(super) fn element_state(&mut self, node: NodeId) -> Value {
        let graph = self.graph;
        if let Some(displacement) = graph.element(node).and_then(|element| element.displacement.as_ref()) {
            return self.evaluate(displacement, None);
        }
        let states = self.state(Storage::Element(node));
        let Some(dependent) = self.dependent.get(&node) else {
            let components = graph.bond(graph.node(node).bonds[0]).cardinality;
            return states.unwrap_or_else(|| Value::zero(&mut self.pool, components));
        };
        // Those that others determine, and the states that are left, in their order.
        let mut states = states.into_iter().flat_map(|value| value.0);
        Value(dependent.replaced.iter().filter_map(|replaced| replaced.or_else(|| states.next())).collect())
    }

    /// Effort of a C from its displacement, or flow of an I from its momentum.
    pub(super) fn storage_law(&mut self, node: NodeId, element: &Element, state: &Value) -> Value {
        self.own(node);
        let law = match &element.law {
            Law::Of { value, .. } => return self.evaluate(value, Some(state)),
            law => self.evaluate(law.term(), None),
        };
        if matches!(element.law, Law::Stiffness(_)) {
            return law.act(&mut self.pool, state);
        }
        let Some(frame) = &element.frame else {
            let inverse = law.reciprocal(&mut self.pool);
            return inverse.act(&mut self.pool, state);
        };
        // The tensor is constant in the frame's own axes: turn there, apply, turn back.
        let frame = self.evaluate(frame, None);
        let pool = &mut self.pool;
        let inverse = law.reciprocal(pool);
        let turned = frame.transpose().multiply(pool, state);
        let inside = inverse.act(pool, &turned);
        frame.multiply(pool, &inside)
    }

    /// The state at which a linear law of a C gives this effort, of an I this flow.
    pub(super) fn storage_inverse(&mut self, node: NodeId, element: &Element, given: &Value) -> Value {
        self.own(node);
        let law = match &element.law {
            Law::Of { value, .. } => {
                let components = given.0.len();
                let columns = self.matrix_of(node, element, value, components);
                let entries = (0..components * components).map(|k| columns[k % components].0[k / components]);
                let inverse = Value(entries.collect()).reciprocal(&mut self.pool);
                return inverse.act(&mut self.pool, given);
            }
            law => self.evaluate(law.term(), None),
        };
        if matches!(element.law, Law::Stiffness(_)) {
            let inverse = law.reciprocal(&mut self.pool);
            return inverse.act(&mut self.pool, given);
        }
        let Some(frame) = &element.frame else { return law.act(&mut self.pool, given) };
        let frame = self.evaluate(frame, None);
        let turned = frame.transpose().multiply(&mut self.pool, given);
        let inside = law.act(&mut self.pool, &turned);
        frame.multiply(&mut self.pool, &inside)
    }

    /// The other bond of a two-port.
    fn across(&self, node: NodeId, bond: BondId) -> (BondId, bool) {
        let bonds = &self.graph.node(node).bonds;
        if bonds[0] == bond { (bonds[1], true) } else { (bonds[0], false) }
    }

    /// f_out = M f_in and e_in = M^T e_out.
    fn through_transformer(&mut self, node: NodeId, element: &Element, bond: BondId, given: Role) -> Value {
        let (other, is_in) = self.across(node, bond);
        let source = if given == Role::Effort { self.effort(other) } else { self.flow(other) };
        self.own(node);
        let term = match &element.law {
            Law::Of { value, .. } => value,
            law => {
                let modulus = self.evaluate(law.term(), None);
                let direct = is_in == (given == Role::Effort);
                let factor = if direct { modulus } else { modulus.reciprocal(&mut self.pool) };
                return factor.act(&mut self.pool, &source);
            }
        };
        if !is_in {
            // The law itself: the variable of the bond in to that of the bond out.
            return self.evaluate(term, Some(&source));
        }
        // Power is conserved: the other variable comes back through the transposed matrix.
        let components = self.graph.bond(bond).cardinality;
        let columns = self.matrix_of(node, element, term, components);
        Value(columns.iter().map(|column| column.dot(&mut self.pool, &source)).collect())
    }

    /// e_in = r f_out and e_out = r f_in.
    fn through_gyrator(&mut self, node: NodeId, element: &Element, bond: BondId, given: Role) -> Value {
        let (other, _) = self.across(node, bond);
        let source = if given == Role::Effort { self.flow(other) } else { self.effort(other) };
        self.own(node);
        let modulus = self.evaluate(element.law.term(), None);
        let factor = if given == Role::Effort { modulus } else { modulus.reciprocal(&mut self.pool) };
        factor.act(&mut self.pool, &source)
    }

    /// The columns of the matrix of a law that is linear in its variable of `components` components.
    fn matrix_of(&mut self, node: NodeId, element: &Element, term: &Term, components: usize) -> Vec<Value> {
        let symbols: Vec<Symbol> = (0..).take(components).map(Symbol::Law).collect();
        let variable = Value(symbols.iter().map(|&symbol| self.pool.symbol(symbol)).collect());
        let value = self.evaluate(term, Some(&variable));
        let zero = self.pool.zero();
        let columns: Vec<Value> =
            symbols.iter().map(|&symbol| Value(partial(&mut self.pool, &value.0, symbol))).collect();
        let is_variable = |symbol: &Symbol| symbols.contains(symbol);
        let all: Vec<Id> = columns.iter().flat_map(|column| column.0.clone()).collect();
        let constant = !self.pool.symbols(&all).iter().any(is_variable);
        let at_zero = substitute(&mut self.pool, &value.0, &|symbol| is_variable(&symbol).then_some(zero));
        if !(constant && at_zero.iter().all(|&id| self.pool.is_zero(id))) {
            let definition = self.graph.node(node);
            let (symbol, name) = (element.kind.symbol(), definition.name.text.clone());
            self.fault_once(Fault::new(term.span, &EquationFault::NotLinear { symbol, name }));
        }
        columns
    }
}
