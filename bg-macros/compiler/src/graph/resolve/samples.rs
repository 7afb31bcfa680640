//! Samples: values that a clock computes and that are held in between.
//!
//! In: the block `every`. Out: a state for each sample, which keeps what is held, and the `let` that this becomes at an
//! instant. There the names of samples are those of the instant, in all blocks; elsewhere they are what is held.

use std::collections::BTreeSet;

use super::{Context, Entity, Resolver, Sampled};
use crate::graph::term::{Reference, Term, TermKind};
use crate::graph::units::Dimension;
use crate::graph::{Clock, GraphFault, Let};
use crate::source::ast::{self, Expression, ExpressionKind, Name};
use crate::source::clause::Allowed;
use crate::source::walk::each_name;

/// The function that gives what a signal was some instants ago.
pub(super) const DELAY: &str = "delay";

/// The most instants of a delay: each is a state.
const MOST_INSTANTS: f64 = 1000.0;

/// By how much a delay may differ from a multiple of the time between two instants, as a part of that: rounding.
const OFF: f64 = 1e-9;

impl Resolver {
    /// A sample, without its terms; `new` is the index of its `let`.
    pub(super) fn declare_sample(&mut self, sample: &ast::Sample, new: usize) {
        let (own, index) = (self.graph.integrals.len(), self.samples.len());
        self.samples.push(Sampled { own, new });
        self.name(&sample.name, Entity::Sample(index));
        self.name(&ast::Sample::last(&sample.name), Entity::Last(index));
        self.own(&sample.name, &sample.unit);
    }

    /// A clock with its samples, whose states are those from `first` on.
    pub(super) fn every(&mut self, every: &ast::Every, first: usize) {
        let ast::Every { period, offset, samples } = every;
        if samples.is_empty() {
            self.fault(period.span, &GraphFault::EveryEmpty);
        }
        let clock = self.graph.clocks.len();
        let text = every.times();
        let none = Expression { kind: ExpressionKind::Number(0.0), span: period.span };
        let period = self.time(period, "every", Allowed::Positive);
        let offset = self.time(offset.as_ref().unwrap_or(&none), "offset", Allowed::NotNegative);
        self.graph.clocks.push(Clock { text, period, first: offset, delay: None });
        for (own, sample) in (first..).zip(samples) {
            self.sample(sample, own, clock);
        }
    }

    /// The `let` of a time of a clock, s.
    fn time(&mut self, value: &Expression, word: &'static str, allowed: Allowed) -> usize {
        let time = self.time_of(value, word, format!("the time after `{word}`"), allowed);
        self.graph.lets.push(time);
        self.graph.lets.len() - 1
    }

    fn sample(&mut self, sample: &ast::Sample, own: usize, clock: usize) {
        let ast::Sample { name, unit, value, start } = sample;
        let value = self.term(value, Context::Instant(clock));
        let held = Term { kind: TermKind::Reference(Reference::Own(own)), span: name.span };
        let value = Term { kind: TermKind::AtInstant(clock, Box::new([value, held])), span: name.span };
        let start = start.as_ref().map(|start| self.term(start, Context::Start));
        let (declared, unit) = (Some(self.unit(unit)), Some(unit.to_string()));
        let known = &mut self.graph.integrals[own];
        (known.start, known.follows) = (start, Some(self.graph.lets.len()));
        self.graph.lets.push(Let { name: name.clone(), value, declared, unit, clause: None });
    }

    /// `delay(SIGNAL, TIME)`, `delay(SIGNAL, TIME, START)` at an instant: what the signal was at the instant TIME
    /// before, and START where that is before the first one. A row of states hands the signal on, one at each instant.
    pub(super) fn delayed_by_instants(&mut self, function: &Name, mut terms: Vec<Term>, clock: usize) -> Term {
        let span = function.span;
        let zero = Term { kind: TermKind::Number(0.0), span };
        if !(2..=3).contains(&terms.len()) {
            let (function, found) = (function.text.clone(), terms.len());
            self.fault(span, &GraphFault::ArgumentCount { function, expected: 2, found });
            return zero;
        }
        let start = if terms.len() == 3 { terms.pop() } else { None };
        let (time, signal) = (terms.pop().unwrap_or_else(|| zero.clone()), terms.pop().unwrap_or_else(|| zero.clone()));
        let Clock { text, period, .. } = self.graph.clocks[clock].clone();
        let instants = match [seconds(&time), seconds(&self.graph.lets[period].value)] {
            [Some(time), Some(period)] => time / period,
            _ => f64::NAN,
        };
        let number = instants.round();
        if !((instants - number).abs() <= OFF && (1.0..=MOST_INSTANTS).contains(&number)) {
            self.fault(time.span, &GraphFault::DelayTime { clock: text, most: MOST_INSTANTS });
            return zero;
        }
        let mut handed = signal;
        let first = self.graph.integrals.len();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and from 1 to the most")]
        for k in 1..=number as usize {
            handed = self.handed_on(format!("delay_{first}.ago_{k}"), handed, start.clone(), clock);
        }
        handed
    }

    /// What stands for a quantity at an instant: for a `let` that depends on samples another one, with their values of
    /// the instant.
    pub(super) fn at_instant(&mut self, reference: Reference, place: Context<'_>) -> Reference {
        let (Reference::Let(index), Context::Instant(_)) = (reference, place) else { return reference };
        if let Some(&known) = self.at_instants.get(&index) {
            return Reference::Let(known);
        }
        let Some(written) = self.written.get(index).cloned().flatten() else { return reference };
        if !self.depends_on_samples(&written, &mut BTreeSet::new()) {
            return reference;
        }
        let at = self.written.len() + self.more.len();
        self.at_instants.insert(index, at);
        let ast::Let { name, unit, value, .. } = written;
        let (declared, text) = (unit.as_ref().map(|unit| self.unit(unit)), unit.as_ref().map(ToString::to_string));
        let nothing = Term { kind: TermKind::Number(0.0), span: name.span };
        self.more.push(Let { name, value: nothing, declared, unit: text, clause: None });
        // What is wrong with it is said where it stands.
        let faults = self.faults.len();
        let outside = std::mem::replace(&mut self.is_outside_of_blocks, true);
        let value = self.term(&value, place);
        self.is_outside_of_blocks = outside;
        self.faults.truncate(faults);
        self.more[at - self.written.len()].value = value;
        Reference::Let(at)
    }

    /// Whether a `let` depends on a sample.
    fn depends_on_samples(&self, of: &ast::Let, seen: &mut BTreeSet<usize>) -> bool {
        let mut depends = false;
        each_name(&mut of.value.clone(), &mut |value| {
            let ExpressionKind::Name(name) = &value.kind else { return };
            depends |= match self.names.get(&name.text) {
                Some(Entity::Sample(_)) => true,
                Some(&Entity::Let(index)) if seen.insert(index) => {
                    let written = self.written.get(index).and_then(Option::as_ref);
                    written.is_some_and(|written| self.depends_on_samples(written, seen))
                }
                _ => false,
            };
        });
        depends
    }

    /// What the name of a sample stands for.
    pub(super) fn sampled(&self, entity: Entity, place: Context<'_>) -> Option<Reference> {
        let is_instant = matches!(place, Context::Instant(_));
        match entity {
            Entity::Sample(index) if is_instant => Some(Reference::Let(self.samples[index].new)),
            Entity::Sample(index) => Some(Reference::Own(self.samples[index].own)),
            Entity::Last(index) if is_instant => Some(Reference::Own(self.samples[index].own)),
            _ => None,
        }
    }
}

/// The number of seconds, where it is written as one.
fn seconds(of: &Term) -> Option<f64> {
    match of.kind {
        TermKind::Number(value) => Some(value),
        TermKind::Quantity(value, dimension) if dimension == Dimension::SECOND => Some(value),
        _ => None,
    }
}
