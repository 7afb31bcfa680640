//! Numbers with units: `75 mm` in an expression, defaults and ranges of parameters, what is declared in another unit.
//!
//! In: numbers and units as written. Out: numbers in SI, but of a parameter in its own unit, which is that of its
//! number wherever it is given. No longer occurs: units that are not coherent, in the terms of a graph.

use bg_units::Unit;

use super::{Context, Resolver};
use crate::fault::Fault;
use crate::graph::GraphFault;
use crate::graph::term::{Operation, Term, TermKind};
use crate::graph::typing::{Quantity, Types};
use crate::graph::units::Dimension;
use crate::source::ast::{self, BinaryOperator, Expression, ExpressionKind};
use crate::source::numbers::{Constant, constant};
use crate::source::walk::each_name;

impl Resolver {
    /// The value in its own unit of a default or an end of a range: an expression of numbers, with units or without.
    pub(super) fn number(&mut self, expression: &Expression, written: &ast::Unit, unit: Unit) -> f64 {
        let value = match &expression.kind {
            // To the last digit.
            ExpressionKind::Quantity(value, own) if own.to_string() == written.to_string() => Some(*value),
            _ => expression.number().or_else(|| self.with_units(expression, unit)),
        };
        if let Some(value) = value.filter(|value| value.is_finite()) {
            return value;
        }
        let what = "a default or an end of a range".to_owned();
        self.fault(expression.span, &GraphFault::NotANumber { what, constant: constant_in(expression) });
        0.0
    }

    /// The value in `unit` of an expression of numbers, some of them with units.
    fn with_units(&mut self, expression: &Expression, unit: Unit) -> Option<f64> {
        let value = in_si(expression)?;
        let term = self.term(expression, Context::Plain);
        let (_, found) = Types::new(&self.graph, &[]).with_pure_numbers(&term, &mut self.faults);
        if let Quantity::Known(found) = found
            && found != unit.dimension
        {
            let fault = GraphFault::UnitOf { what: "the number".to_owned(), expected: unit.dimension, found };
            self.faults.push(Fault::new(expression.span, &fault));
        }
        Some(unit.from_si(value))
    }

    /// A number in a unit. A further symbol of that may not be a name as well: `3 N/m` would have two meanings.
    pub(super) fn quantity_in(&mut self, value: f64, unit: &ast::Unit, place: Context<'_>) -> TermKind {
        for (symbol, _) in unit.factors.iter().skip(1) {
            if self.quantity(&symbol.text, place).is_some() {
                let (unit, symbol_text) = (unit.to_string(), symbol.text.clone());
                self.fault(symbol.span, &GraphFault::UnitOrName { unit, symbol: symbol_text });
            }
        }
        let unit = self.unit(unit);
        TermKind::Quantity(unit.in_si(value), unit.dimension)
    }
}

/// `value` times or over the size of a unit.
pub(super) fn scaled(value: Term, operator: BinaryOperator, unit: Unit) -> Term {
    if unit.is_coherent() {
        return value;
    }
    let span = value.span;
    let operand = Term { kind: TermKind::Quantity(unit.size(), Dimension::NONE), span };
    Term { kind: TermKind::Chain(Box::new(value), vec![Operation { operator, span, operand }]), span }
}

/// The value in SI, where it is made of numbers only.
fn in_si(expression: &Expression) -> Option<f64> {
    match &expression.kind {
        ExpressionKind::Quantity(value, unit) => Some(unit.meaning()?.in_si(*value)),
        _ => expression.folded(&in_si),
    }
}

/// The first name of a mathematical constant in an expression.
fn constant_in(expression: &Expression) -> Option<&'static Constant> {
    let mut found = None;
    each_name(&mut expression.clone(), &mut |value| {
        if let ExpressionKind::Name(name) = &value.kind {
            found = found.or_else(|| constant(&name.text));
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use crate::pipeline;
    use crate::source::syntax;
    use crate::stages::stages;

    fn compiled(text: &str) -> pipeline::Compiled {
        let source = syntax::parse(text.parse().expect("tokens")).unwrap_or_else(|faults| panic!("{faults:?}"));
        pipeline::models(&source).unwrap_or_else(|faults| panic!("{faults:?}")).remove(0)
    }

    /// The equations in scalars as they are printed.
    fn equations(text: &str) -> String {
        let all = stages(text.parse().expect("tokens")).unwrap_or_else(|faults| panic!("{faults:?}"));
        let text = all.into_iter().find(|stage| stage.name == "equations").expect("a stage").text;
        text.split_once("\n\n").expect("equations of bonds, then of states").1.to_owned()
    }

    /// A slider on a spring with these declarations and these values in its statements.
    fn slider([declared, spring, weight, start, watched]: [&str; 5]) -> String {
        format!(
            "graph G {{
                {declared}
                1 slide: translation; C coil = {spring} start {start}; I block = {weight}; Se force = push;
                force -> slide -> block; slide -> coil;
                observe {{ {watched} }}
            }}"
        )
    }

    #[test]
    fn equations_in_other_units_are_those_in_si() {
        let si = slider(["input push: N; let stiff: N/m = 3e6;", "stiff", "0.5", "0.004", "place: m = coil.q / 1"]);
        let other = slider(["input push: N;", "3 kN/mm", "500 g", "4 mm", "place: m = coil.q / 1"]);
        assert_eq!(equations(&si), equations(&other));
    }

    #[test]
    fn what_is_declared_in_a_unit_has_its_number_in_that() {
        let declared = "param stretch: mm = 4, above 1, at most 2 cm; input push: kN; let soft: kN/mm = 3;";
        let text = slider([declared, "soft", "0.5", "stretch", "place: mm = coil.q; speed: rpm = slide.flow / (1 m)"]);
        let of = compiled(&text);
        let parameter = &of.equations.parameters[0];
        assert_eq!(
            (parameter.default, parameter.lower, parameter.upper),
            (4.0, Some((1.0, false)), Some((20.0, true)))
        );
        let text = equations(&text);
        for expected in ["0.001*stretch", "1000*push", "3000000*coil.q", "place [mm] = 1000*coil.q"] {
            assert!(text.contains(expected), "{expected}:\n{text}");
        }
        let speed = text.lines().find(|line| line.contains("speed [rpm] = ")).expect("an output");
        assert!(speed.contains("19.09859317102744"), "{speed}");
    }

    #[test]
    fn a_number_that_may_be_in_either_unit_is_refused() {
        let faults = |declared: &str, watched: &str| {
            let text = slider([declared, "3 kN/mm", "0.5", "0", watched]);
            let source = syntax::parse(text.parse().expect("tokens")).expect("syntax");
            let faults = pipeline::models(&source).err().unwrap_or_default();
            faults.iter().map(|fault| format!("{} {}", fault.code, fault.message)).collect::<Vec<_>>().join("; ")
        };
        let push = "input push: N;";
        assert_eq!(faults(push, "x: mm = coil.q + 3 mm"), "");
        assert_eq!(faults(push, "x: mm = 2 * coil.q"), "");
        assert_eq!(faults(push, "x: mm = coil.q + 3"), "BG0316 cannot add these: the units m and 1 disagree");
        let default = "BG0316 the number is in s, not in m";
        assert_eq!(faults("input push: N; param a: mm = 3 s;", "x: m = a"), default);
        let twice = "input push: N; param m: kg = 3;";
        let name = "BG0338 `m` in `N/m` is a unit, and there is something of this name";
        assert_eq!(faults(twice, "x: m = coil.q * (2 N/m) / (1 N/kg) / m"), name);
    }
}
