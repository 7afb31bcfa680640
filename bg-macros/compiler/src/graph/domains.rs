//! The units of effort and flow of every bond, and the check of every law against them.
//!
//! In: a connected graph with resolved terms. Out: `Bond::effort`, laws of C classified as stiffness or compliance.
//! Method: bonds at one junction form a class; a class gets its effort unit from a junction's domain, a source, a law's
//! parameter or, through a two-port, from its neighbour class, until nothing changes.

use std::collections::BTreeSet;

use super::typing::{Quantity, Shape, Typed, Types, is_junction};
use super::{BondGraph, BondId, Element, GraphFault, Law, Node, NodeId};
use crate::fault::Fault;
use crate::graph::units::{DOMAINS, Dimension, Domain};
use crate::source::ast::{ElementKind, Role, TrackKind};

/// Gives every bond its units and checks every law. `declared` are the junctions that name their domain.
pub fn assign(graph: &mut BondGraph, declared: &[(NodeId, Domain)], faults: &mut Vec<Fault>) {
    let classes = classes(graph);
    // Classes of two units: their laws are compared with neither.
    let mut torn = BTreeSet::new();
    let mut efforts: Vec<Option<Dimension>> = vec![None; graph.bonds.len()];
    let mut named: Vec<Option<NodeId>> = vec![None; graph.bonds.len()];
    for &(node, domain) in declared {
        let Some(bond) = graph.node(node).bonds.first() else { continue };
        let (class, effort) = (classes[bond.0], domain.effort_dimension());
        match (efforts[class], named[class]) {
            (Some(known), Some(first)) if known != effort => {
                let [name, first] = [node, first].map(|node| &graph.node(node).name);
                torn.insert(class);
                let (from, to) = (first.text.clone(), name.text.clone());
                let left = Domain::of_effort(known).unwrap_or(domain);
                faults.push(Fault::new(name.span, &GraphFault::Domains { from, to, left, right: domain }));
            }
            _ => (efforts[class], named[class]) = (Some(effort), Some(node)),
        }
    }
    let efforts = anchored(graph, &classes, efforts);
    report_unknown(graph, &classes, efforts.clone(), faults);
    let is_torn = |node: &Node| node.bonds.iter().any(|bond| torn.contains(&classes[bond.0]));
    check(graph, &efforts, &is_torn, faults);
    for (bond, effort) in graph.bonds.iter_mut().zip(&efforts) {
        bond.effort = effort.unwrap_or(Dimension::NONE);
    }
}

/// The class of every bond: the lowest index among the bonds that share junctions.
fn classes(graph: &BondGraph) -> Vec<usize> {
    let mut class: Vec<usize> = (0..graph.bonds.len()).collect();
    loop {
        let before = class.clone();
        for node in graph.nodes.iter().filter(|node| is_junction(&node.kind)) {
            if let Some(lowest) = node.bonds.iter().map(|bond| class[bond.0]).min() {
                node.bonds.iter().for_each(|bond| class[bond.0] = lowest);
            }
        }
        if class == before {
            return class;
        }
    }
}

/// The efforts of all classes whose unit is fixed, spread over their bonds.
fn anchored(graph: &BondGraph, classes: &[usize], mut efforts: Vec<Option<Dimension>>) -> Vec<Option<Dimension>> {
    loop {
        let spread = spread(&efforts, classes);
        let Some((bond, effort)) = next_anchor(graph, &spread) else { return spread };
        efforts[classes[bond.0]] = Some(effort);
    }
}

/// A fault for each domain that is missing; what would follow from one that is named has none of its own.
fn report_unknown(graph: &BondGraph, classes: &[usize], mut efforts: Vec<Option<Dimension>>, faults: &mut Vec<Fault>) {
    while let Some(unknown) = efforts.iter().position(Option::is_none) {
        let bond = &graph.bonds[unknown];
        let name = |id: NodeId| graph.node(id).name.text.clone();
        let junction = (unknown..classes.len())
            .filter(|&other| classes[other] == classes[unknown])
            .flat_map(|other| [graph.bonds[other].from, graph.bonds[other].to])
            .find(|&node| is_junction(&graph.node(node).kind));
        let cardinality = if bond.cardinality == 1 { "" } else { "[3]" };
        let declaration = junction.map(|id| format!("{} {}{cardinality}", graph.node(id).kind.symbol(), name(id)));
        let fault = GraphFault::UnknownUnits { from: name(bond.from), to: name(bond.to), declaration };
        faults.push(Fault::new(bond.span, &fault));
        efforts[classes[unknown]] = Some(DOMAINS[0].effort_dimension());
        efforts = anchored(graph, classes, efforts);
    }
}

fn spread(efforts: &[Option<Dimension>], classes: &[usize]) -> Vec<Option<Dimension>> {
    classes.iter().map(|&class| efforts[class]).collect()
}

/// The next bond whose unit follows from a law or a track.
fn next_anchor(graph: &BondGraph, efforts: &[Option<Dimension>]) -> Option<(BondId, Dimension)> {
    let types = Types::new(graph, efforts);
    let tracked = graph.tracks.iter().find_map(|track| {
        let bond = *graph.node(track.junction).bonds.first()?;
        let flow = match track.kind {
            TrackKind::Position => Dimension::METRE.per(Dimension::SECOND),
            TrackKind::Orientation => Dimension::NONE.per(Dimension::SECOND),
        };
        efforts[bond.0].is_none().then(|| (bond, Dimension::WATT.per(flow)))
    });
    tracked.or_else(|| {
        (0..graph.nodes.len()).find_map(|index| {
            let element = graph.element(NodeId(index))?;
            let bonds = &graph.nodes[index].bonds;
            match bonds[..] {
                [bond] if efforts[bond.0].is_none() => Some((bond, one_port(&types, element)?)),
                [bond_in, bond_out] => two_port(&types, element, (bond_in, bond_out), efforts),
                _ => None,
            }
        })
    })
}

/// The effort unit that a one-port's law implies.
fn one_port(types: &Types<'_>, element: &Element) -> Option<Dimension> {
    let Law::Parameter(term) = &element.law else { return None };
    let (_, Quantity::Known(unit)) = types.silently(term, None) else { return None };
    match element.kind {
        ElementKind::Se | ElementKind::MSe => Some(unit),
        ElementKind::Sf | ElementKind::MSf | ElementKind::RSe => Some(Dimension::WATT.per(unit)),
        ElementKind::R | ElementKind::Mr => unit.times(Dimension::WATT).root(),
        ElementKind::I => unit.times(Dimension::WATT).per(Dimension::SECOND).root(),
        ElementKind::C => {
            let stiffness = unit.times(Dimension::JOULE).root();
            let compliance = Dimension::JOULE.per(unit).root();
            [stiffness, compliance].into_iter().flatten().find(|&effort| Domain::of_effort(effort).is_some())
        }
        _ => None,
    }
}

/// The effort unit of one side of a two-port from that of its other side.
fn two_port(
    types: &Types<'_>,
    element: &Element,
    (bond_in, bond_out): (BondId, BondId),
    efforts: &[Option<Dimension>],
) -> Option<(BondId, Dimension)> {
    let Quantity::Known(modulus) = modulus_unit(types, element) else { return None };
    let power = Dimension::WATT;
    match (element.kind, efforts[bond_in.0], efforts[bond_out.0]) {
        (ElementKind::Gy | ElementKind::Mgy, Some(effort), None) => Some((bond_out, power.per(effort.per(modulus)))),
        (ElementKind::Gy | ElementKind::Mgy, None, Some(effort)) => Some((bond_in, power.per(effort).times(modulus))),
        (_, Some(effort), None) => Some((bond_out, effort.per(modulus))),
        (_, None, Some(effort)) => Some((bond_in, effort.times(modulus))),
        _ => None,
    }
}

/// The unit of a two-port's modulus: flow out per flow in of a TF, effort in per flow out of a GY.
fn modulus_unit(types: &Types<'_>, element: &Element) -> Quantity {
    match &element.law {
        Law::Of { role, value } => {
            let pure = Quantity::Known(Dimension::NONE);
            let of = |shape| types.silently(value, Some((shape, pure))).1;
            let unit = match of(Shape::Vector) {
                Quantity::Known(unit) => Quantity::Known(unit),
                _ => of(Shape::Scalar),
            };
            match (role, unit) {
                (Role::Effort, Quantity::Known(unit)) => Quantity::Known(Dimension::NONE.per(unit)),
                (_, unit) => unit,
            }
        }
        law => types.silently(law.term(), None).1,
    }
}

/// Every law against its bonds' units and shapes, but of what is torn; laws of C get their form.
fn check(
    graph: &mut BondGraph,
    efforts: &[Option<Dimension>],
    is_torn: &dyn Fn(&Node) -> bool,
    faults: &mut Vec<Fault>,
) {
    let mut forms = Vec::new();
    {
        let graph: &BondGraph = graph;
        let types = Types::new(graph, efforts);
        for definition in &graph.lets {
            let (shape, found) = types.declared(&definition.value, definition.declared, faults);
            if let Some(clause) = &definition.clause
                && shape != Shape::of_components(clause.components)
            {
                let (what, expected) = (clause.what.clone(), Shape::of_components(clause.components));
                faults.push(Fault::new(definition.value.span, &GraphFault::ShapeOf { what, expected, found: shape }));
            }
            let declared = definition.declared.map(|unit| unit.dimension);
            if let (Some(declared), Quantity::Known(found)) = (declared, found)
                && declared != found
            {
                let of_name = || format!("the value of `{}`", definition.name.text);
                let what = definition.clause.as_ref().map_or_else(of_name, |clause| clause.what.clone());
                faults.push(Fault::new(definition.value.span, &GraphFault::UnitOf { what, expected: declared, found }));
            }
        }
        for (index, node) in graph.nodes.iter().enumerate().filter(|(_, node)| !is_torn(node)) {
            if let Some(element) = graph.element(NodeId(index)) {
                let mut checker = LawCheck { graph, types: &types, node, element, faults };
                if let Some(form) = checker.check() {
                    forms.push((index, form));
                }
            }
        }
    }
    for (index, form) in forms {
        if let super::NodeKind::Element(element) = &mut graph.nodes[index].kind {
            element.law = form;
        }
    }
}

struct LawCheck<'a, 'g> {
    graph: &'g BondGraph,
    types: &'a Types<'g>,
    node: &'g Node,
    element: &'g Element,
    faults: &'a mut Vec<Fault>,
}

impl LawCheck<'_, '_> {
    /// Checks the law and its clauses; for a linear C the law in its form.
    fn check(&mut self) -> Option<Law> {
        let bond = *self.node.bonds.first()?;
        let (effort, flow) = self.types.bond_units(bond);
        let shape = self.shape(bond);
        if self.element.kind.is_two_port() {
            self.two_port();
            return None;
        }
        self.clauses(shape, effort, flow);
        match &self.element.law {
            Law::Of { role, value } => {
                let (variable, result) = self.variable_and_result(*role, effort, flow);
                let typed = self.types.of(value, Some((shape, variable)), self.faults);
                self.expect("the law", value, typed, shape, &[result]);
                None
            }
            Law::Parameter(term) => {
                let typed = self.types.of(term, None, self.faults);
                self.linear(term, typed, shape, effort, flow)
            }
            Law::Stiffness(_) | Law::Compliance(_) => None,
        }
    }

    fn shape(&self, bond: BondId) -> Shape {
        Shape::of_cardinality(self.graph.bond(bond).cardinality)
    }

    fn variable_and_result(&self, role: Role, effort: Quantity, flow: Quantity) -> (Quantity, Quantity) {
        let second = Quantity::Known(Dimension::SECOND);
        match (self.element.kind, role) {
            (ElementKind::C, _) => (times(flow, second), effort),
            (ElementKind::I, _) => (times(effort, second), flow),
            (_, Role::Flow) => (flow, effort),
            (_, Role::Effort) => (effort, flow),
        }
    }

    fn linear(
        &mut self,
        term: &super::Term,
        (found_shape, found): Typed,
        shape: Shape,
        effort: Quantity,
        flow: Quantity,
    ) -> Option<Law> {
        let second = Quantity::Known(Dimension::SECOND);
        let source = matches!(
            self.element.kind,
            ElementKind::Se | ElementKind::MSe | ElementKind::Sf | ElementKind::MSf | ElementKind::RSe
        );
        // A linear law acts on a multibond by a number, by one number an axis, or by a tensor.
        let allowed = if source {
            shape
        } else if shape == Shape::Vector {
            found_shape
        } else {
            Shape::Scalar
        };
        match self.element.kind {
            ElementKind::Se | ElementKind::MSe => {
                self.expect("the effort", term, (found_shape, found), allowed, &[effort])
            }
            ElementKind::Sf | ElementKind::MSf | ElementKind::RSe => {
                self.expect("the flow", term, (found_shape, found), allowed, &[flow]);
            }
            ElementKind::I => {
                let inertia = per(times(effort, second), flow);
                self.expect("the inertia", term, (found_shape, found), allowed, &[inertia]);
            }
            ElementKind::C => {
                let stiffness = per(effort, times(flow, second));
                let compliance = per(times(flow, second), effort);
                let faults = self.faults.len();
                self.expect("the law", term, (found_shape, found), allowed, &[stiffness, compliance]);
                // `2 * k` is of the unit of k where that makes sense.
                let found =
                    if found == Quantity::Any { self.types.with_pure_numbers(term, &mut Vec::new()).1 } else { found };
                if found != stiffness && found != compliance && self.faults.len() == faults {
                    let name = self.node.name.text.clone();
                    self.faults.push(Fault::new(term.span, &GraphFault::NumberForC { name }));
                }
                let form = if found == compliance { Law::Compliance } else { Law::Stiffness };
                return Some(form(term.clone()));
            }
            _ => self.expect("the resistance", term, (found_shape, found), allowed, &[per(effort, flow)]),
        }
        None
    }

    fn clauses(&mut self, shape: Shape, effort: Quantity, flow: Quantity) {
        let second = Quantity::Known(Dimension::SECOND);
        let displacement = times(flow, second);
        let element = self.element;
        if let Some(frame) = &element.frame {
            let typed = self.types.of(frame, None, self.faults);
            self.expect("the frame", frame, typed, Shape::Matrix, &[Quantity::Known(Dimension::NONE)]);
        }
        if let Some(term) = &element.displacement {
            let typed = self.types.of(term, None, self.faults);
            self.expect("the displacement", term, typed, shape, &[displacement]);
        }
        if let Some(term) = &element.start {
            let typed = self.types.of(term, None, self.faults);
            let state = if element.kind == ElementKind::C { displacement } else { times(effort, second) };
            self.expect("the start value", term, typed, shape, &[state]);
        }
        if let Some(term) = &element.sticking {
            let typed = self.types.of(term, None, self.faults);
            self.expect("the effort held by", term, typed, Shape::Scalar, &[effort]);
            if shape != Shape::Scalar {
                let (name, clause) = (self.node.name.text.clone(), "holds");
                self.faults.push(Fault::new(self.node.name.span, &GraphFault::NotStorage { name, clause }));
            }
        }
        let pure = Quantity::Known(Dimension::NONE);
        let of_stop = [
            ("the restitution", "restitution", &element.restitution, pure),
            ("the speed of rest", "rest below", &element.rest, flow),
        ];
        for (what, clause, term, unit) in of_stop {
            let Some(term) = term else { continue };
            let typed = self.types.of(term, None, self.faults);
            self.expect(what, term, typed, Shape::Scalar, &[unit]);
            if shape != Shape::Scalar {
                let name = self.node.name.text.clone();
                self.faults.push(Fault::new(self.node.name.span, &GraphFault::NotStorage { name, clause }));
            }
        }
        if let Some(term) = &element.energy {
            let variable = self.variable_and_result(Role::Flow, effort, flow).0;
            let typed = self.types.of(term, Some((shape, variable)), self.faults);
            self.expect("the energy", term, typed, Shape::Scalar, &[Quantity::Known(Dimension::JOULE)]);
        }
    }

    fn two_port(&mut self) {
        let [bond_in, bond_out] = self.node.bonds[..] else { return };
        let (effort_in, flow_in) = self.types.bond_units(bond_in);
        let (effort_out, flow_out) = self.types.bond_units(bond_out);
        match &self.element.law {
            Law::Of { role, value } => {
                let (variable, result) = match role {
                    Role::Flow => (flow_in, flow_out),
                    Role::Effort => (effort_in, effort_out),
                };
                let typed = self.types.of(value, Some((self.shape(bond_in), variable)), self.faults);
                self.expect("the law", value, typed, self.shape(bond_out), &[result]);
            }
            law => {
                let term = law.term();
                let typed = self.types.of(term, None, self.faults);
                let gyrator = matches!(self.element.kind, ElementKind::Gy | ElementKind::Mgy);
                let modulus = if gyrator { per(effort_in, flow_out) } else { per(flow_out, flow_in) };
                self.expect("the modulus", term, typed, Shape::Scalar, &[modulus]);
            }
        }
    }

    fn expect(&mut self, what: &str, term: &super::Term, found: Typed, shape: Shape, units: &[Quantity]) {
        let what = format!("{what} of {} `{}`", self.element.kind.symbol(), self.node.name.text);
        if found.0 != shape {
            self.faults.push(Fault::new(term.span, &GraphFault::ShapeOf { what, expected: shape, found: found.0 }));
        }
        if let Quantity::Known(unit) = found.1 {
            let expected: Vec<Dimension> = units
                .iter()
                .filter_map(|quantity| if let Quantity::Known(dimension) = quantity { Some(*dimension) } else { None })
                .collect();
            if !expected.is_empty() && !expected.contains(&unit) {
                let fault = GraphFault::LawUnit {
                    symbol: self.element.kind.symbol(),
                    name: self.node.name.text.clone(),
                    found: unit,
                    expected,
                };
                self.faults.push(Fault::new(term.span, &fault));
            }
        }
    }
}

fn times(a: Quantity, b: Quantity) -> Quantity {
    match (a, b) {
        (Quantity::Known(a), Quantity::Known(b)) => Quantity::Known(a.times(b)),
        _ => Quantity::Unknown,
    }
}

fn per(a: Quantity, b: Quantity) -> Quantity {
    match (a, b) {
        (Quantity::Known(a), Quantity::Known(b)) => Quantity::Known(a.per(b)),
        _ => Quantity::Unknown,
    }
}
