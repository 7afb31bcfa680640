//! From the pool to the graph of one routine.
//!
//! In: roots in a pool. Out: a [`Graph`] and the roots as values in it.
//! Method: one sweep over the nodes, children first; static parts are gathered into coefficients on the way.

use rustc_hash::FxHashMap;

use super::graph::{Core, Graph, ONE, Value};
use super::statics::Statics;
use crate::expr::{Id, Node, Symbol};

/// When a parameter is known.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Parameters {
    /// Before the routine runs.
    Static,
    /// When the routine runs.
    Dynamic,
}

/// The graph of these roots.
pub(super) fn build(statics: &mut Statics, roots: &[Id], parameters: Parameters) -> (Graph, Vec<Value>) {
    let mut sweep = Sweep { statics, graph: Graph::new(), values: FxHashMap::default(), parameters };
    for id in sweep.statics.pool.reachable(roots) {
        let node = sweep.statics.pool.node(id).clone();
        let value = sweep.value(id, &node);
        sweep.values.insert(id, value);
    }
    let values = roots.iter().map(|root| sweep.values[root]).collect();
    (sweep.graph, values)
}

struct Sweep<'s, 'p> {
    statics: &'s mut Statics<'p>,
    graph: Graph,
    values: FxHashMap<Id, Value>,
    parameters: Parameters,
}

impl Sweep<'_, '_> {
    fn value(&mut self, id: Id, node: &Node) -> Value {
        let fixed = Value { coefficient: id, core: ONE };
        match node {
            Node::Number(_) => fixed,
            Node::Symbol(Symbol::Parameter(_) | Symbol::Kept(_) | Symbol::Side(_))
                if self.parameters == Parameters::Static =>
            {
                fixed
            }
            Node::Symbol(symbol) => {
                Value { coefficient: self.statics.one, core: self.graph.cores.intern(Core::Symbol(*symbol)) }
            }
            Node::Sum { terms, .. } if terms.iter().all(|term| self.is_static(term.0)) => fixed,
            Node::Product(factors) if factors.iter().all(|factor| self.is_static(factor.0)) => fixed,
            // A function of numbers is an operation of the routine that evaluates the constants.
            Node::Call(_, arguments)
                if self.parameters == Parameters::Static
                    && arguments.iter().all(|&argument| self.is_static(argument)) =>
            {
                fixed
            }

            Node::Sum { constant, terms } => self.sum(constant.value(), terms.iter().map(|&(t, c)| (t, c.value()))),
            Node::Product(factors) => {
                let powers: Vec<_> =
                    factors.iter().map(|&(factor, exponent)| (self.values[&factor], exponent)).collect();
                self.graph.product(self.statics, &powers)
            }
            Node::Call(function, arguments) => {
                let arguments = arguments.iter().map(|argument| self.values[argument]).collect();
                self.graph.call(self.statics, *function, arguments)
            }
            Node::Select { switch, negative, positive } => {
                let (negative, positive) = (self.values[negative], self.values[positive]);
                self.graph.select(self.statics, *switch, negative, positive)
            }
        }
    }

    /// Whether the node itself is static; not where states only cancel in the graph's normal form.
    fn is_static(&self, id: Id) -> bool {
        self.values[&id] == Value { coefficient: id, core: ONE }
    }

    fn sum(&mut self, constant: f64, terms: impl Iterator<Item = (Id, f64)>) -> Value {
        let mut fixed = Vec::new();
        let mut values = Vec::new();
        for (term, factor) in terms {
            let value = self.values[&term];
            if value.core == ONE {
                fixed.push((value.coefficient, factor));
            } else {
                values
                    .push(Value { coefficient: self.statics.pool.scale(factor, value.coefficient), core: value.core });
            }
        }
        if constant != 0.0 || !fixed.is_empty() {
            values.push(Value { coefficient: self.statics.pool.linear(constant, &fixed), core: ONE });
        }
        self.graph.sum(self.statics, values)
    }
}
