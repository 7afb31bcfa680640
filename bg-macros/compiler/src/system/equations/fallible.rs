//! Where numbers that are not finite come from.
//!
//! In: laws. Out: what those elements give whose law can make a number that is not finite of finite ones, in the order
//! of evaluation: the first of these values that is not finite is where it began.
//! Method: a law can do so if it divides by, or takes a root, logarithm, exponential, non-integer power or the like of
//! something that changes in a run. What depends on parameters only is the same in all of it.

use super::StateEquations;
use super::signals::Signals;
use crate::expr::Id;
use crate::graph::{BinaryOperator, Builtin, Element, ElementKind, Law, NodeId, Reference, Term, TermKind};
use crate::system::Value;

/// What an element gives, one component.
#[derive(Clone, Debug)]
pub struct FallibleLaw {
    /// The element's kind.
    pub kind: &'static str,
    /// The element.
    pub element: String,
    /// The effort or flow.
    pub value: Id,
    /// Whether it is the pivot of a loop that nothing shows to keep away from zero.
    pub may_vanish: bool,
}

impl FallibleLaw {
    /// What an element gives.
    pub(super) fn new(kind: &'static str, element: String, value: Id) -> Self {
        Self { kind, element, value, may_vanish: false }
    }
}

impl StateEquations {
    /// The pivots of loops that nothing shows to keep away from zero.
    pub fn turning(&self) -> impl Iterator<Item = &FallibleLaw> {
        self.fallible.iter().filter(|law| law.may_vanish)
    }
}

/// What is known of an expression without its value.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Nature {
    /// Whether it changes in a run.
    changes: bool,
    /// Whether it may not be finite where all that it refers to is.
    is_partial: bool,
}

impl Nature {
    fn and(self, other: Self) -> Self {
        Self { changes: self.changes || other.changes, is_partial: self.is_partial || other.is_partial }
    }

    /// Of what is not finite for some values of this.
    fn partial(self) -> Self {
        Self { is_partial: self.is_partial || self.changes, ..self }
    }
}

impl Signals<'_> {
    /// Notes what an element gives if its law can make a number that is not finite.
    pub(super) fn note_fallible(&mut self, node: NodeId, element: &Element, value: &Value) {
        if self.is_partial(element) {
            let (kind, name) = (element.kind.symbol(), &self.graph.node(node).name.text);
            let laws = value.0.iter().map(|&value| FallibleLaw::new(kind, name.clone(), value));
            self.fallible.extend(laws);
        }
    }

    fn is_partial(&mut self, element: &Element) -> bool {
        use ElementKind as K;
        let law = self.nature(element.law.term());
        let displacement = element.displacement.as_ref().map(|term| self.nature(term)).unwrap_or_default();
        // A linear law of these may be used the other way round.
        let is_divisor = match (&element.law, element.kind) {
            (Law::Of { .. } | Law::Stiffness(_), _) => false,
            (_, kind) => matches!(kind, K::I | K::C | K::R | K::Mr | K::Tf | K::Mtf | K::Gy | K::Mgy),
        };
        let law = if is_divisor { law.partial() } else { law };
        law.and(displacement).is_partial
    }

    fn nature(&mut self, term: &Term) -> Nature {
        match &term.kind {
            TermKind::Number(_)
            | TermKind::Quantity(..)
            | TermKind::Guess(_)
            | TermKind::Reference(Reference::Parameter(_)) => Nature::default(),
            TermKind::Reference(Reference::Let(index)) => self.nature_of_let(*index),
            TermKind::Reference(_) | TermKind::Integral(_) => Nature { changes: true, is_partial: false },
            TermKind::Component(inner, _) | TermKind::Negate(inner) => self.nature(inner),
            TermKind::Lookup(lookup, arguments) => {
                let all = self.nature_of_all(arguments);
                if self.graph.tables[lookup.table].is_everywhere() { all } else { all.partial() }
            }
            TermKind::Chain(first, rest) => rest.iter().fold(self.nature(first), |left, operation| {
                let right = self.nature(&operation.operand);
                left.and(if operation.operator == BinaryOperator::Divide { right.partial() } else { right })
            }),
            TermKind::Call(builtin, arguments) => {
                let all = self.nature_of_all(arguments);
                if can_fail(*builtin, arguments) { all.partial() } else { all }
            }
            TermKind::Vector(parts) => self.nature_of_all(parts),
            TermKind::If(_, _, parts) => self.nature_of_all(&**parts),
            TermKind::AtInstant(_, parts) => self.nature_of_all(&**parts),
        }
    }

    fn nature_of_all(&mut self, terms: &[Term]) -> Nature {
        terms.iter().fold(Nature::default(), |nature, term| nature.and(self.nature(term)))
    }

    fn nature_of_let(&mut self, index: usize) -> Nature {
        if let Some(nature) = self.natures[index] {
            return nature;
        }
        let graph = self.graph;
        let nature = self.nature(&graph.lets[index].value);
        self.natures[index] = Some(nature);
        nature
    }
}

/// Whether a function is not finite for some finite arguments.
fn can_fail(builtin: Builtin, arguments: &[Term]) -> bool {
    use Builtin as B;
    let is_whole = |term: &Term| matches!(term.kind, TermKind::Number(power) if power >= 0.0 && power.fract() == 0.0);
    match builtin {
        B::Sqrt | B::Tan | B::Asin | B::Acos | B::Exp | B::Ln | B::Inverse => true,
        B::Pow => !arguments.get(1).is_some_and(is_whole),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::pipeline;
    use crate::source::syntax;

    /// The elements that a number can begin to be not finite at.
    fn fallible(statements: &str) -> Vec<String> {
        let text = format!("graph G {{ {statements} }}");
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let equations = pipeline::derive(&source.graphs[0]).expect("equations").equations;
        equations.fallible.into_iter().map(|law| format!("{} {}", law.kind, law.element)).collect()
    }

    /// A mass with a resistor that gives an effort.
    fn of_law(law: &str) -> Vec<String> {
        fallible(&format!("param a: m/s = 2; 1 j: translation; I m = 2; MR r(v) = 1 * {law}; j -> m; j -> r;"))
    }

    #[test]
    fn laws_that_can_fail_are_known_and_others_are_not() {
        for law in
            ["sqrt(v / 1)", "ln(v / 1)", "exp(v / 1)", "tan(v / 1)", "asin(v / 1)", "acos(v / 1)", "1 / v", "a / t"]
        {
            assert_eq!(of_law(law), ["MR r"], "{law}");
        }
        for law in ["pow(v / 1, 0.5)", "pow(v / 1, -1)", "pow(2, v / 1)", "(if v < a { 1 / v } else { v })"] {
            assert_eq!(of_law(law), ["MR r"], "{law}");
        }
        for law in
            ["sin(v / 1)", "tanh(v / 1)", "abs(v)", "atan2(v, a)", "pow(v, 2)", "v / 2", "v / a", "v / sqrt(a / 1)"]
        {
            assert!(of_law(law).is_empty(), "{law}");
        }
    }

    #[test]
    fn what_a_law_takes_from_a_let_or_a_displacement_counts() {
        let slope = |of: &str| {
            fallible(&format!("1 j: translation; let b: s/m = {of}; I m = 2; MR r(v) = b * v * 3; j -> m; j -> r;"))
        };
        assert_eq!(slope("1 / (m.p / 2)"), ["MR r"]);
        assert!(slope("1 / 2").is_empty());
        let coil = "param k: N/m = 3; 1 j[3]: translation; position x of j; I m = 1; j -> m; let d: m = norm(x);
            1 s: translation; MTF along(v) = dot(x, v) / d; C c = k at d; j -> along -> s -> c;";
        assert_eq!(fallible(coil), vec!["MTF along"; 4], "one effort for each axis and a flow; a length is finite");
    }

    #[test]
    fn a_linear_law_that_is_used_the_other_way_round_divides() {
        let valve = |word: &str, law: &str| {
            fallible(&format!(
                "param k: m^3/Pa = 1; Se p = 1; 0 j: hydraulic; C c = k; 1 v; {word} r = {law}; j -> c; j -> v -> r; \
                R o = 1; 0 q: hydraulic; p -> q; q -> o;"
            ))
        };
        assert_eq!(valve("MR", "1 - t / 1"), ["MR r"]);
        assert!(valve("R", "2").is_empty());
    }
}
