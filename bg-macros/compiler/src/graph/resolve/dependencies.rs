//! What a resolved graph's expressions may depend on, and the shapes and units of its outputs.
//!
//! In: terms with references. Out: faults of circles, modulation and start values; shapes and units of outputs.

use std::collections::BTreeSet;

use bg_units::Unit;
use proc_macro2::Span;

use super::Resolver;
use crate::fault::Fault;
use crate::graph::term::{Reference, Term, TermKind};
use crate::graph::typing::{Quantity, Shape, Types};
use crate::graph::units::Dimension;
use crate::graph::{Bond, GraphFault, Integral, Law, Let, NodeId, NodeKind};
use crate::source::ast::ElementKind;
use crate::source::clause::{Clause, Given};

impl Resolver {
    /// The unit of a value as its definition writes it: J and N*m are one dimension but read differently.
    fn written_unit(&self, value: &Term) -> Option<String> {
        match value.kind {
            TermKind::Reference(Reference::Let(index)) => {
                let Let { unit, declared, .. } = &self.graph.lets[index];
                unit.clone().filter(|_| declared.is_some_and(Unit::is_coherent))
            }
            TermKind::Reference(Reference::Energy(_) | Reference::StoredEnergy) => Some("J".to_owned()),
            TermKind::Reference(Reference::Flow(node)) => self.bond_of(node).map(Bond::flow_unit),
            TermKind::Reference(Reference::Displacement(node)) => self.bond_of(node).map(Bond::displacement_unit),
            TermKind::Reference(Reference::Momentum(node)) => self.bond_of(node).map(Bond::momentum_unit),
            _ => None,
        }
    }

    fn bond_of(&self, node: NodeId) -> Option<&Bond> {
        self.graph.node(node).bonds.first().map(|&bond| self.graph.bond(bond))
    }

    /// Lets that are defined by themselves.
    pub(super) fn let_circles(&mut self) {
        // A circle of what `let`s are at an instant has a sample in it.
        for (index, definition) in self.graph.lets.iter().enumerate().take(self.written.len()) {
            if self.deep_references(&definition.value, &|_| true).contains(&Reference::Let(index)) {
                let name = definition.name.text.clone();
                let is_sample = matches!(definition.value.kind, TermKind::AtInstant(..));
                let fault = if is_sample { GraphFault::SampleCycle { name } } else { GraphFault::LetCycle { name } };
                self.faults.push(Fault::new(definition.name.span, &fault));
            }
        }
    }

    /// What a law may depend on: only the modulated kinds on states, storages never on inputs, starts on parameters.
    pub(super) fn dependencies(&mut self) {
        use ElementKind as K;
        let mut faults = Vec::new();
        for node in &self.graph.nodes {
            let NodeKind::Element(element) = &node.kind else { continue };
            let is_clause = self.graph.is_clause(element.law.term());
            let depends = if is_clause { Vec::new() } else { self.depends(element.law.term()) };
            let linear = !matches!(element.law, Law::Of { .. });
            let allowed = |reference: &Reference| match element.kind {
                K::Se | K::Sf => is_given(*reference),
                K::Tf | K::Gy => is_constant(*reference),
                K::R if linear => is_constant(*reference),
                K::I | K::C | K::RSe => !matches!(reference, Reference::Input(_) | Reference::Own(_)),
                K::Mtf => !matches!(reference, Reference::Own(_)),
                _ => true,
            };
            if let Some(reference) = depends.iter().find(|reference| !allowed(reference)) {
                let (symbol, name, by) = (element.kind.symbol(), node.name.text.clone(), self.describe(*reference));
                let fault = if matches!(element.kind, K::I | K::C | K::RSe | K::Mtf) {
                    GraphFault::NotConstant { what: format!("the law of {symbol} `{name}`"), by }
                } else {
                    GraphFault::Modulated { symbol, name, by }
                };
                faults.push(Fault::new(element.law.term().span, &fault));
            }
            if let Some(start) = &element.start {
                faults.extend(self.start_depends(start, &node.name.text, &is_of_start));
            }
            for (clause, term) in [("restitution", &element.restitution), ("rest below", &element.rest)] {
                let by = term.as_ref().and_then(|term| Some((term, self.first_of_run(term)?)));
                faults.extend(by.map(|(term, by)| {
                    let what = format!("the `{clause}` of `{}`", node.name.text);
                    Fault::new(term.span, &GraphFault::NotConstant { what, by: self.describe(by) })
                }));
            }
        }
        for integral in &self.graph.integrals {
            if let Some(start) = &integral.start {
                faults.extend(self.start_depends(start, &integral.name, &is_constant));
            }
        }
        for track in &self.graph.tracks {
            if let Some(start) = &track.start {
                faults.extend(self.start_depends(start, &track.name.text, &is_constant));
            }
        }
        self.faults.extend(faults);
    }

    /// What the clauses of mechanism words may depend on, each at the token that is wrong.
    pub(super) fn clauses(&mut self) {
        let mut faults = Vec::new();
        for definition in &self.graph.lets {
            let Some(clause) = &definition.clause else { continue };
            definition.value.visit(&mut |part| {
                if matches!(part.kind, TermKind::Guess(_)) && !matches!(clause.given, Given::Start | Given::Free) {
                    faults.push(Fault::new(part.span, &GraphFault::GuessOutsideStart));
                }
            });
            let allowed = |reference: &Reference| match clause.given {
                Given::Constant | Given::Start => is_constant(*reference),
                Given::Source => is_given(*reference),
                Given::State => !matches!(reference, Reference::Input(_)),
                Given::Free => true,
            };
            let found = self.depends(&definition.value).into_iter().find(|reference| !allowed(reference));
            if let Some(reference) = found {
                let span = place_of(&definition.value, reference).unwrap_or(definition.value.span);
                let (what, by) = (clause.what.clone(), self.describe(reference));
                faults.push(Fault::new(span, &GraphFault::NotConstant { what, by }));
            }
        }
        self.faults.extend(faults);
    }

    fn start_depends(&self, start: &Term, name: &str, is_known: &dyn Fn(Reference) -> bool) -> Option<Fault> {
        let by = self.depends(start).into_iter().find(|reference| !is_known(*reference))?;
        let what = format!("the start value of `{name}`");
        Some(Fault::new(start.span, &GraphFault::NotConstant { what, by: self.describe(by) }))
    }

    /// The first thing that a term depends on and that is no parameter.
    fn first_of_run(&self, term: &Term) -> Option<Reference> {
        self.depends(term).into_iter().find(|reference| !is_constant(*reference))
    }

    /// What a term depends on; of the clauses of mechanism words that may depend on little, which are looked at
    /// themselves, only the names.
    fn depends(&self, term: &Term) -> Vec<Reference> {
        let is_open = |clause: &Clause| matches!(clause.given, Given::State | Given::Free);
        self.deep_references(term, &|definition| definition.clause.as_ref().is_none_or(is_open))
    }

    /// All references of a term, with those in the lets that `opens` wants to look into.
    fn deep_references(&self, term: &Term, opens: &dyn Fn(&Let) -> bool) -> Vec<Reference> {
        let mut found = Vec::new();
        term.references(&mut found);
        let mut seen = vec![false; self.graph.lets.len()];
        let mut turned = vec![false; self.graph.turns.len()];
        let mut next = 0;
        while next < found.len() {
            if let Reference::Let(index) = found[next]
                && !std::mem::replace(&mut seen[index], true)
                && opens(&self.graph.lets[index])
            {
                self.graph.lets[index].value.references(&mut found);
            }
            if let Reference::Turn(index) = found[next]
                && !std::mem::replace(&mut turned[index], true)
            {
                self.graph.turns[index].terms().into_iter().for_each(|term| term.references(&mut found));
            }
            next += 1;
        }
        found
    }

    /// Marks the angles and the junctions whose turns and displacements something reads: only these become states.
    pub(super) fn mark_what_is_read(&mut self) {
        let mut found = Vec::new();
        self.graph.each_root(&mut |term| found.extend(self.deep_references(term, &|_| true)));
        let mut ways = BTreeSet::new();
        for reference in found {
            match reference {
                Reference::Turn(index) => self.graph.turns[index].is_read = true,
                Reference::Displacement(node) if matches!(self.graph.node(node).kind, NodeKind::One) => {
                    ways.insert(node);
                }
                _ => {}
            }
        }
        self.graph.ways = ways.into_iter().collect();
    }

    fn describe(&self, reference: Reference) -> String {
        let node = |id: NodeId| &self.graph.node(id).name.text;
        match reference {
            Reference::Time => "the time".to_owned(),
            Reference::Variable => "its own variable".to_owned(),
            Reference::Parameter(index) => format!("parameter `{}`", self.graph.parameters[index].name.text),
            Reference::Input(index) => format!("input `{}`", self.graph.inputs[index].name.text),
            Reference::Let(index) => format!("`{}`", self.graph.lets[index].name.text),
            Reference::Track(index) => format!("`{}`", self.graph.tracks[index].name.text),
            Reference::Flow(id) => format!("the flow of `{}`", node(id)),
            Reference::Effort(id) => format!("the effort of `{}`", node(id)),
            Reference::Power(id) => format!("the power of `{}`", node(id)),
            Reference::Energy(id) => format!("the energy of `{}`", node(id)),
            Reference::Displacement(id) => format!("the displacement of `{}`", node(id)),
            Reference::Turn(index) => format!("the angle `{}`", self.graph.turns[index].name),
            Reference::Momentum(id) => format!("the momentum of `{}`", node(id)),
            Reference::Own(index) => format!("the state `{}`", self.graph.integrals[index].name),
            Reference::StoredEnergy => "the stored energy".to_owned(),
            Reference::SuppliedPower => "the supplied power".to_owned(),
            Reference::DissipatedPower => "the dissipated power".to_owned(),
        }
    }

    /// Shapes and units of outputs, gaps and integrals.
    pub(super) fn finish_outputs(&mut self) {
        let efforts: Vec<Option<Dimension>> = self.graph.bonds.iter().map(|bond| Some(bond.effort)).collect();
        let types = Types::new(&self.graph, &efforts);
        let mut faults = Vec::new();
        let mut observed = Vec::new();
        for (observation, &declared) in self.graph.observations.iter().zip(&self.observed) {
            let (shape, quantity) = types.declared(&observation.value, declared, &mut faults);
            let unit = match (declared, quantity) {
                (Some(declared), Quantity::Known(found)) if declared.dimension != found => {
                    let what = format!("the value of `{}`", observation.name);
                    let fault = GraphFault::UnitOf { what, expected: declared.dimension, found };
                    faults.push(Fault::new(observation.value.span, &fault));
                    String::new()
                }
                (Some(_), _) => observation.unit.clone(),
                (None, Quantity::Known(found)) => self.written_unit(&observation.value).unwrap_or(found.to_string()),
                (None, _) => "1".to_owned(),
            };
            observed.push((shape, unit));
        }
        for turn in &self.graph.turns {
            types.of(&turn.direction, None, &mut faults);
            let per_second = Dimension::NONE.per(Dimension::SECOND);
            expect_scalar(&types, &turn.speed, "the speed of an angle", per_second, &mut faults);
        }
        let known = |quantity| if let Quantity::Known(dimension) = quantity { dimension } else { Dimension::NONE };
        let closed: Vec<_> = self.graph.closes.iter().map(|close| types.of(&close.gap, None, &mut faults)).collect();
        let mut integrands = Vec::new();
        for (index, Integral { name, value, declared, start, follows, .. }) in self.graph.integrals.iter().enumerate() {
            let of_signal = || follows.map(|_| types.of_own(index));
            let of_signal = declared.is_none().then(of_signal).flatten();
            if let Some((shape, _)) = of_signal {
                expect_shape(value, "the signal of a delay", shape, &mut faults);
            }
            let Some(declared) = declared.or(of_signal.map(|(_, quantity)| known(quantity))) else {
                let (shape, quantity) = types.of(value, None, &mut faults);
                expect_shape(value, "an integrand", shape, &mut faults);
                integrands.push(known(quantity));
                continue;
            };
            let rate = declared.per(Dimension::SECOND);
            expect_scalar(&types, value, &format!("the rate of `{name}`"), rate, &mut faults);
            if let Some(start) = start {
                let of_delay = of_signal.map(|_| "the start of the delay".to_owned());
                let what = of_delay.unwrap_or_else(|| format!("the start of `{name}`"));
                expect_scalar(&types, start, &what, declared, &mut faults);
            }
            integrands.push(rate);
        }
        for (observation, (shape, unit)) in self.graph.observations.iter_mut().zip(observed) {
            (observation.shape, observation.unit) = (shape, unit);
        }
        for (close, (shape, quantity)) in self.graph.closes.iter_mut().zip(closed) {
            (close.shape, close.dimension) = (shape, known(quantity));
        }
        for (integral, dimension) in self.graph.integrals.iter_mut().zip(integrands) {
            integral.dimension = dimension;
        }
        self.faults.extend(faults);
    }
}

/// A fault where `what`, this term, is no scalar. Gives whether it is one.
fn expect_shape(term: &Term, what: &str, found: Shape, faults: &mut Vec<Fault>) -> bool {
    if found != Shape::Scalar {
        let fault = GraphFault::ShapeOf { what: what.to_owned(), expected: Shape::Scalar, found };
        faults.push(Fault::new(term.span, &fault));
    }
    found == Shape::Scalar
}

/// A fault where `what`, this term, is no scalar of this dimension.
fn expect_scalar(types: &Types<'_>, term: &Term, what: &str, expected: Dimension, faults: &mut Vec<Fault>) {
    let (shape, quantity) = types.of(term, None, faults);
    if expect_shape(term, what, shape, faults)
        && let Quantity::Known(found) = quantity
        && found != expected
    {
        let fault = GraphFault::UnitOf { what: what.to_owned(), expected, found };
        faults.push(Fault::new(term.span, &fault));
    }
}

/// Where a term names the quantity itself.
fn place_of(term: &Term, reference: Reference) -> Option<Span> {
    let mut place = None;
    term.visit(&mut |part| {
        if matches!(part.kind, TermKind::Reference(found) if found == reference) {
            place.get_or_insert(part.span);
        }
    });
    place
}

/// Parameters and numbers.
fn is_constant(reference: Reference) -> bool {
    matches!(reference, Reference::Parameter(_) | Reference::Let(_) | Reference::Variable)
}

/// What the start of a storage may depend on: parameters, and the start pose.
fn is_of_start(reference: Reference) -> bool {
    is_constant(reference) || matches!(reference, Reference::Track(_))
}

/// What a source may follow: parameters, inputs, time.
fn is_given(reference: Reference) -> bool {
    is_constant(reference) || matches!(reference, Reference::Input(_) | Reference::Time)
}
