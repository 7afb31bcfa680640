//! Expressions to terms: what names and calls stand for.
//!
//! In: an `ast::Expression` and where it stands. Out: a [`Term`]. No longer occurs: a name as text.

use proc_macro2::Span;

use super::quantity::scaled;
use super::samples::DELAY;
use super::tables::nearest_call;
use super::{Context, Entity, Resolver};
use crate::fault::near_miss;
use crate::graph::term::{Builtin, Lookup, Operation, Reference, Term, TermKind};
use crate::graph::units::Dimension;
use crate::graph::{GraphFault, Integral, NodeId, Turn};
use crate::source::ast::{self, BinaryOperator, Comparison, Expression, ExpressionKind, Name};
use crate::source::functions::{self, Function};
use crate::source::words::table_called;

impl Resolver {
    pub(super) fn term(&mut self, expression: &Expression, place: Context<'_>) -> Term {
        let span = expression.span;
        let kind = match &expression.kind {
            ExpressionKind::Number(value) => TermKind::Number(*value),
            ExpressionKind::Quantity(value, unit) => self.quantity_in(*value, unit, place),
            ExpressionKind::Name(name) => return self.named(&name.text, span, place),
            ExpressionKind::Negate(inner) => TermKind::Negate(Box::new(self.term(inner, place))),
            ExpressionKind::Chain(first, rest) => {
                let first = Box::new(self.term(first, place));
                let operations = rest.iter().map(|operation| self.operation(operation, place)).collect();
                TermKind::Chain(first, operations)
            }
            ExpressionKind::Vector(parts) => {
                TermKind::Vector(parts.iter().map(|part| self.term(part, place)).collect())
            }
            ExpressionKind::If(choice) => {
                let parts = [&choice.left, &choice.right, &choice.then, &choice.otherwise];
                let parts = Box::new(parts.map(|part| self.term(part, place)));
                TermKind::If(choice.comparison, choice.condition(), parts)
            }
            ExpressionKind::Call(function, arguments) => return self.call(function, arguments, place),
        };
        Term { kind, span }
    }

    fn operation(&mut self, operation: &ast::Operation, place: Context<'_>) -> Operation {
        let &ast::Operation { operator, span, .. } = operation;
        Operation { operator, span, operand: self.term(&operation.operand, place) }
    }

    fn call(&mut self, function: &Name, arguments: &[Expression], place: Context<'_>) -> Term {
        let span = function.span;
        if function.text == DELAY {
            return match place {
                Context::Instant(clock) if !self.is_outside_of_blocks => {
                    let terms = arguments.iter().map(|argument| self.term(argument, place)).collect();
                    self.delayed_by_instants(function, terms, clock)
                }
                _ => self.delayed_at_any_time(function, arguments, place),
            };
        }
        let mut terms: Vec<Term> = arguments.iter().map(|argument| self.term(argument, place)).collect();
        let (table, order) = table_called(&function.text);
        if let Some(&Entity::Table(table)) = self.names.get(table) {
            return self.lookup(Lookup { table, order }, function, terms);
        }
        let builtin = Builtin::named(&function.text);
        let expected = functions::named(&function.text).map(Function::least);
        match expected {
            None => {
                let near = nearest_call(&function.text, &self.graph.tables);
                self.fault(span, &GraphFault::UnknownFunction { name: function.text.clone(), near });
            }
            Some(expected) if expected != terms.len() => {
                let (function, found) = (function.text.clone(), terms.len());
                self.fault(span, &GraphFault::ArgumentCount { function, expected, found });
            }
            Some(_) => {}
        }
        if expected != Some(terms.len()) {
            return Term { kind: TermKind::Number(0.0), span };
        }
        let kind = match (function.text.as_str(), builtin) {
            ("guess", _) => {
                if !matches!(place, Context::Start | Context::Plain | Context::Let) {
                    self.fault(span, &GraphFault::GuessOutsideStart);
                }
                self.guess(terms.remove(0)).kind
            }
            ("integral", _) => {
                if place != Context::Observed {
                    self.fault(span, &GraphFault::IntegralOutsideObserve);
                }
                let (value, name) = (terms.remove(0), String::new());
                let dimension = Dimension::NONE;
                self.graph.integrals.push(Integral {
                    name,
                    value,
                    dimension,
                    declared: None,
                    start: None,
                    follows: None,
                });
                TermKind::Integral(self.graph.integrals.len() - 1)
            }
            ("unwrapped", _) => {
                if !matches!(place, Context::Let | Context::Observed) {
                    self.fault(span, &GraphFault::UnwrappedElsewhere);
                }
                let speed = terms.remove(2);
                let direction = Term { kind: TermKind::Call(Builtin::Atan2, terms), span };
                self.graph.turns.push(Turn { name: String::new(), direction, speed, is_read: false });
                TermKind::Reference(Reference::Turn(self.graph.turns.len() - 1))
            }
            ("min" | "max", _) => {
                let condition = format!("{} < {}", arguments[0], arguments[1]);
                let (second, first) = (terms.remove(1), terms.remove(0));
                let [smaller, larger] = [first.clone(), second.clone()];
                let chosen = if function.text == "min" { [smaller, larger] } else { [larger, smaller] };
                let [then, otherwise] = chosen;
                TermKind::If(Comparison::Less, condition, Box::new([first, second, then, otherwise]))
            }
            (_, Some(builtin)) => TermKind::Call(builtin, terms),
            (_, None) => TermKind::Number(0.0),
        };
        Term { kind, span }
    }

    /// An unknown of the assembly for a first guess; of a vector one for each component.
    fn guess(&mut self, first: Term) -> Term {
        let span = first.span;
        let kind = match first.kind {
            TermKind::Vector(parts) => TermKind::Vector(parts.into_iter().map(|part| self.guess(part)).collect()),
            kind => {
                self.graph.guesses.push(Term { kind, span });
                TermKind::Guess(self.graph.guesses.len() - 1)
            }
        };
        Term { kind, span }
    }

    /// A name: a quantity, a property of one (`pin.flow`), or a component of either (`pin.flow.x`).
    fn named(&mut self, name: &str, span: Span, place: Context<'_>) -> Term {
        if let Some(reference) = self.quantity(name, place) {
            let reference = self.at_instant(reference, place);
            let term = Term { kind: TermKind::Reference(reference), span };
            return match reference {
                Reference::Parameter(index) => scaled(term, BinaryOperator::Multiply, self.parameters[index]),
                Reference::Input(index) => scaled(term, BinaryOperator::Multiply, self.inputs[index]),
                _ => term,
            };
        }
        if let Some((whole, last)) = name.rsplit_once('.')
            && let Some(component) = ["x", "y", "z"].iter().position(|letter| *letter == last)
            && let Some(reference) = self.quantity(whole, place)
        {
            let reference = self.at_instant(reference, place);
            let whole = Term { kind: TermKind::Reference(reference), span };
            return Term { kind: TermKind::Component(Box::new(whole), component), span };
        }
        let owner = name.rsplit_once('.').map_or(name, |(owner, _)| owner);
        if let Some(Entity::Table(_)) = self.names.get(name) {
            self.fault(span, &GraphFault::TableWithoutArgument { name: name.to_owned() });
        } else if let Some(Entity::Last(_)) = self.names.get(name) {
            self.fault(span, &GraphFault::LastOutside { sample: owner.to_owned() });
        } else if let Some(Entity::Node(_)) = self.names.get(name) {
            self.fault(span, &GraphFault::NotAValue { name: name.to_owned() });
        } else if ![name, owner].iter().any(|name| self.names.get(*name) == Some(&Entity::Several)) {
            let near = near_miss(name, self.names.keys().map(String::as_str)).map(str::to_owned);
            self.fault(span, &GraphFault::UnknownName { name: name.to_owned(), near });
        }
        Term { kind: TermKind::Number(0.0), span }
    }

    pub(super) fn quantity(&self, name: &str, place: Context<'_>) -> Option<Reference> {
        if let Context::Law(Some(variable)) = place
            && variable == name
        {
            return Some(Reference::Variable);
        }
        match name {
            "t" => return Some(Reference::Time),
            "stored_energy" => return Some(Reference::StoredEnergy),
            "supplied_power" => return Some(Reference::SuppliedPower),
            "dissipated_power" => return Some(Reference::DissipatedPower),
            _ => {}
        }
        match self.names.get(name) {
            Some(Entity::Parameter(index)) => return Some(Reference::Parameter(*index)),
            Some(Entity::Input(index)) => return Some(Reference::Input(*index)),
            Some(Entity::Let(index)) => return Some(Reference::Let(*index)),
            Some(Entity::Track(index)) => return Some(Reference::Track(*index)),
            Some(Entity::Own(index)) => return Some(Reference::Own(*index)),
            Some(&entity @ (Entity::Sample(_) | Entity::Last(_))) => return self.sampled(entity, place),
            Some(Entity::Table(_) | Entity::Node(_) | Entity::Several) | None => {}
        }
        let (whole, property) = name.rsplit_once('.')?;
        let Some(Entity::Node(node)) = self.names.get(whole) else { return None };
        self.property(*node, property)
    }

    fn property(&self, node: NodeId, property: &str) -> Option<Reference> {
        if let Some(cardinality) = self.junctions.get(&node) {
            debug_assert!(*cardinality > 0, "the parser gives 1 or 3");
            return match property {
                "displacement" if *cardinality == 1 && self.ones.contains(&node) => Some(Reference::Displacement(node)),
                "flow" => Some(Reference::Flow(node)),
                "effort" => Some(Reference::Effort(node)),
                _ => None,
            };
        }
        match property {
            "flow" => Some(Reference::Flow(node)),
            "effort" => Some(Reference::Effort(node)),
            "power" => Some(Reference::Power(node)),
            "energy" => Some(Reference::Energy(node)),
            "q" => Some(Reference::Displacement(node)),
            "p" => Some(Reference::Momentum(node)),
            _ => None,
        }
    }
}
