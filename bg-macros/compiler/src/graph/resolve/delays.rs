//! Delays: what a signal was some time ago, at any time.
//!
//! In: `delay(SIGNAL, TIME)` outside of blocks. Out: states that a run writes, and the polynomial of them that the
//! delayed signal is. Over a window of time, which is not longer than the delay, the signal of a while ago is known; a
//! run puts its polynomial there. To the equations the coefficients are states of rate 0, the first of which follows
//! the signal at an instant and each other one the one before: what holds of all of them for any signal holds of the
//! coefficients, too, which depend on it linearly.

use proc_macro2::Span;

use super::{Context, Resolver};
use crate::graph::term::{Operation, Reference, Term, TermKind};
use crate::graph::units::Dimension;
use crate::graph::{Clock, Delay, DelayedSignal, GraphFault, Integral, Let};
use crate::source::ast::{BinaryOperator, Expression, ExpressionKind, Name, Unit};
use crate::source::clause::Allowed;

/// The degree of the polynomials, which the run time takes from the numbers of their coefficients.
const DEGREE: usize = 12;

impl Resolver {
    /// `delay(SIGNAL, TIME)`, `delay(SIGNAL, TIME, START)`: what the signal was at the time TIME before, and START
    /// where that is before the run, else what it is at the start.
    pub(super) fn delayed_at_any_time(
        &mut self,
        function: &Name,
        arguments: &[Expression],
        place: Context<'_>,
    ) -> Term {
        let span = function.span;
        let zero = Term { kind: TermKind::Number(0.0), span };
        let (signal, time, start) = match arguments {
            [signal, time] => (signal, time, None),
            [signal, time, start] => (signal, time, Some(start)),
            _ => {
                let (function, found) = (function.text.clone(), arguments.len());
                self.fault(span, &GraphFault::ArgumentCount { function, expected: 2, found });
                return zero;
            }
        };
        if place == Context::Start {
            self.fault(span, &GraphFault::DelayAtStart);
            return zero;
        }
        let signal = self.term(signal, Context::Plain);
        let start = start.map(|start| self.term(start, Context::Start));
        let (delay, at) = self.delay_by(time);
        let (is_given, first, clock) = (start.is_some(), self.graph.integrals.len(), self.graph.delays[delay].clock);
        let mut before = signal;
        for k in 0..=DEGREE {
            let start = if k == 0 { start.clone() } else { Some(zero.clone()) };
            before = self.handed_on(format!("delay_{first}.c{k}"), before, start, clock);
        }
        let coefficients: Vec<usize> = (first..=first + DEGREE).collect();
        self.graph.delays[delay].signals.push(DelayedSignal { coefficients: coefficients.clone(), is_given });
        let own = |index| reference(Reference::Own(index), span);
        let polynomial = coefficients.into_iter().rev().map(own).reduce(|sum, coefficient| {
            let product = binary(sum, BinaryOperator::Multiply, at.clone());
            binary(coefficient, BinaryOperator::Add, product)
        });
        polynomial.unwrap_or(zero)
    }

    /// The delay by this time, and the place in its window: -1 at its start, 1 at its end.
    fn delay_by(&mut self, time: &Expression) -> (usize, Term) {
        let (text, span) = (format!("delay {time}"), time.span);
        let place = |at: usize| reference(Reference::Let(at), span);
        if let Some(known) = self.graph.delays.iter().position(|delay| self.graph.clocks[delay.clock].text == text) {
            return (known, place(self.graph.delays[known].place));
        }
        let duration = self.time_of(time, "the time of a delay", "the time of a `delay`".to_owned(), Allowed::Positive);
        let duration = self.another_let(duration);
        let none = Expression { kind: ExpressionKind::Number(0.0), span };
        let first = self.time_of(&none, "delay", String::new(), Allowed::NotNegative);
        let first = self.another_let(first);
        let (clock, index) = (self.graph.clocks.len(), self.graph.delays.len());
        self.graph.clocks.push(Clock { text, period: duration, first, delay: Some(index) });
        let now = || reference(Reference::Time, span);
        let duration = reference(Reference::Let(duration), span);
        let ends = [now(), binary(now(), BinaryOperator::Add, duration.clone())];
        let starts = [Term { kind: TermKind::Number(0.0), span }, duration];
        let [from, until] = [0, 1].map(|end| {
            let name = format!("delay_window_{index}.{}", ["from", "until"][end]);
            let own = self.graph.integrals.len();
            self.handed_on(name, ends[end].clone(), Some(starts[end].clone()), clock);
            self.graph.integrals[own].declared = Some(Dimension::SECOND);
            own
        });
        let [start, end] = [from, until].map(|own| reference(Reference::Own(own), span));
        let twice = binary(now(), BinaryOperator::Add, now());
        let middle = binary(start.clone(), BinaryOperator::Add, end.clone());
        let value = binary(
            binary(twice, BinaryOperator::Subtract, middle),
            BinaryOperator::Divide,
            binary(end, BinaryOperator::Subtract, start),
        );
        let name = Name::new(format!("delay_window_{index}.place"), span);
        let at = self.another_let(Let { name, value, declared: None, unit: None, clause: None });
        self.graph.delays.push(Delay { clock, window: [from, until], place: at, signals: Vec::new() });
        (index, place(at))
    }

    /// A state of rate 0 that becomes `from` at an instant of a clock; gives what it is.
    pub(super) fn handed_on(&mut self, name: String, from: Term, start: Option<Term>, clock: usize) -> Term {
        let (own, span) = (self.graph.integrals.len(), from.span);
        let held = reference(Reference::Own(own), span);
        let value = Term { kind: TermKind::AtInstant(clock, Box::new([from, held.clone()])), span };
        let follows = self.another_let(Let {
            name: Name::new(name.clone(), span),
            value,
            declared: None,
            unit: None,
            clause: None,
        });
        let rate = Term { kind: TermKind::Number(0.0), span };
        self.graph.integrals.push(Integral {
            name,
            value: rate,
            dimension: Dimension::NONE,
            declared: None,
            start,
            follows: Some(follows),
        });
        held
    }

    /// A `let` after those that have names; gives its index.
    fn another_let(&mut self, of: Let) -> usize {
        self.more.push(of);
        self.written.len() + self.more.len() - 1
    }

    /// The `let` of a time, s.
    pub(super) fn time_of(&mut self, value: &Expression, word: &str, named: String, allowed: Allowed) -> Let {
        let second = Unit::second(value.span);
        let (declared, unit) = (Some(self.unit(&second)), Some(second.to_string()));
        let clause = Some(crate::source::clause::Clause { allowed, ..crate::source::clause::Clause::new(named, 1) });
        let value = self.term(value, Context::Plain);
        Let { name: Name::new(word, value.span), value, declared, unit, clause }
    }
}

fn reference(of: Reference, span: Span) -> Term {
    Term { kind: TermKind::Reference(of), span }
}

fn binary(left: Term, operator: BinaryOperator, right: Term) -> Term {
    let span = left.span;
    let operation = Operation { operator, span, operand: right };
    Term { kind: TermKind::Chain(Box::new(left), vec![operation]), span }
}
