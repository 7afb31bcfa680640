//! `terminalsAndIcons.xml`: which variables of a unit belong together.
//!
//! In: a model. Out: the bonds whose effort and flow are both variables, the bodies whose pose is, joints by their ends
//! (`joints`), and the text that tells hosts so.
//! A bond that an input drives is a port: the host stands where the source does. All others are closed inside the unit,
//! to be read only. Source: FMI 3.0.1, section 2.4.9 and its schema; the file stands in the same place in a unit of FMI
//! 2.0.

use std::io;

use bg_model::description::{BondInfo, Description, ElementInfo};

use super::{Attributes, Xml, document, empty, nested};
use crate::exported::Described;
use crate::variables::{Counts, VariableKind, names};

/// The version that defines the file, whichever the unit's is.
const DEFINED_BY: &str = "3.0";
/// Values that are the same at both ends of a connection.
const SIGNAL: &str = "signal";
/// What a member of a bond is called, after the quantity.
const QUANTITIES: [&str; 2] = ["effort", "flow"];

/// A group of variables.
pub(super) struct Terminal {
    pub name: String,
    /// `plug`: hosts connect all members or none; `bus`: those that match.
    pub rule: &'static str,
    /// Terminals of one kind fit together.
    pub kind: String,
    pub description: String,
    pub members: Vec<Member>,
    /// Terminals that this one consists of.
    pub inside: Vec<Self>,
}

pub(super) struct Member {
    name: String,
    variable: String,
    /// `signal`, or of what sums to zero in a connection `inflow`, `outflow`.
    kind: &'static str,
}

/// The text of `terminalsAndIcons.xml`; none of a model whose variables make no terminal.
#[must_use]
pub fn terminals_and_icons(model: &dyn Described) -> Option<String> {
    let terminals = Variables::of(model.description()).terminals();
    (!terminals.is_empty()).then(|| document(|xml| write(xml, &terminals)))
}

/// A model's variables by what they are of it.
pub(super) struct Variables {
    pub description: &'static Description,
    names: Vec<String>,
}

impl Variables {
    fn of(description: &'static Description) -> Self {
        Self { description, names: names(description) }
    }

    fn terminals(&self) -> Vec<Terminal> {
        let bonds = self.description.bonds.iter().filter_map(|bond| self.bond(bond));
        let bodies = self.description.parts.iter().filter(|part| part.word == "body");
        let joints = self.description.parts.iter().filter_map(|part| self.joint(part));
        let mut terminals: Vec<Terminal> =
            bonds.chain(bodies.filter_map(|body| self.frame(body.name))).chain(joints).collect();
        let mut taken = Vec::new();
        // Bonds beside each other between the same junctions have the same effort and flow.
        terminals.retain(|terminal| {
            let is_new = !taken.contains(&terminal.name);
            taken.push(terminal.name.clone());
            is_new
        });
        terminals
    }

    /// A bond whose effort and flow are variables.
    fn bond(&self, bond: &BondInfo) -> Option<Terminal> {
        let BondInfo { from, to, effort, flow, .. } = *bond;
        let ends = [from, to].map(|name| self.node(name));
        let driven = ends.iter().flatten().find_map(|end| Some((*end, self.drives(end)?)));
        let [efforts, flows] = [0, 1].map(|quantity| match driven {
            Some((source, input)) if given_by(source) == Some(quantity) => {
                vec![self.member(QUANTITIES[quantity].to_owned(), VariableKind::Input(input))]
            }
            _ => {
                let what = QUANTITIES[quantity];
                let written = ends.iter().flatten().flat_map(|end| written(end, quantity));
                distinct(written.flat_map(|written| self.observed(&written, what)).collect())
            }
        });
        if efforts.is_empty() || flows.is_empty() {
            return None;
        }
        let mut members = [efforts, flows];
        let (rule, description) = if let Some((source, _)) = driven {
            let is_inward = source.name == from;
            // Velocities are the same where mechanisms meet and their forces balance; in all other domains efforts are
            // the same and flows balance, as in the connectors of Modelica.
            let balanced = usize::from(!matches!(flow, "m/s" | "rad/s"));
            members[balanced].iter_mut().for_each(|member| member.kind = if is_inward { "inflow" } else { "outflow" });
            let direction = if is_inward { "into" } else { "out of" };
            ("plug", format!("Effort and flow of a port: their product is the power {direction} the model"))
        } else {
            ("bus", format!("Effort and flow inside the model: their product is the power from {from} to {to}"))
        };
        let own = ends.into_iter().flatten().find(|end| shares(end) == [true; 2]);
        Some(Terminal {
            name: own.map_or_else(|| format!("{from} -> {to}"), |end| end.name.to_owned()),
            rule,
            kind: format!("_bg-fmi_bond_{effort}_{flow}"),
            description,
            members: members.into_iter().flatten().collect(),
            inside: Vec::new(),
        })
    }

    /// A body whose place and direction are outputs.
    fn frame(&self, body: &str) -> Option<Terminal> {
        let [places, matrix, angle] =
            ["position", "orientation", "angle"].map(|what| distinct(self.observed(&format!("{body}.{what}"), what)));
        if places.is_empty() || matrix.is_empty() && angle.is_empty() {
            return None;
        }
        Some(Terminal {
            name: body.to_owned(),
            rule: "bus",
            kind: "_bg-fmi_frame".to_owned(),
            description: "Centre of mass, and the rotation from the body's axes, both in inertial ones".to_owned(),
            members: [places, matrix, angle].into_iter().flatten().collect(),
            inside: Vec::new(),
        })
    }

    pub(super) fn node(&self, name: &str) -> Option<&'static ElementInfo> {
        self.description.elements.iter().find(|element| element.name == name)
    }

    /// The input that a source is: its whole law.
    fn drives(&self, source: &ElementInfo) -> Option<usize> {
        given_by(source)?;
        self.description.inputs.iter().position(|input| input.name == source.law)
    }

    /// The outputs that observe `quantity` or a component of it; their names in a terminal begin with `what`.
    pub(super) fn observed(&self, quantity: &str, what: &str) -> Vec<Member> {
        let outputs = self.description.outputs.iter().enumerate();
        let member = outputs.filter_map(|(index, output)| {
            let of_vector = output.name.strip_prefix(output.of)?;
            let suffix = match output.observes.strip_prefix(quantity)? {
                "" => of_vector,
                ".x" => "_x",
                ".y" => "_y",
                ".z" => "_z",
                _ => return None,
            };
            Some(self.member(format!("{what}{suffix}"), VariableKind::Output(index)))
        });
        member.collect()
    }

    fn member(&self, name: String, kind: VariableKind) -> Member {
        let reference = Counts::of(self.description).reference(kind);
        Member { name, variable: self.names[reference].clone(), kind: SIGNAL }
    }
}

/// Whether `NAME.effort` and `NAME.flow` of an element or a junction are those of each of its bonds.
fn shares(node: &ElementInfo) -> [bool; 2] {
    match node.kind {
        "0" => [true, false],
        "1" => [false, true],
        "TF" | "MTF" | "GY" | "MGY" => [false, false],
        _ => [true, true],
    }
}

/// What outputs call the effort, 0, or the flow, 1, that each bond of a node has: of the axis of a joint also the
/// joint's speed.
fn written(node: &ElementInfo, quantity: usize) -> Vec<String> {
    if !shares(node)[quantity] {
        return Vec::new();
    }
    let own = format!("{}.{}", node.name, QUANTITIES[quantity]);
    let is_axis = quantity == 1 && node.name.strip_prefix(node.part) == Some(".spin");
    let speed = is_axis.then(|| format!("{}.speed", node.part));
    [own].into_iter().chain(speed).collect()
}

/// What a source gives: the effort, 0, or the flow, 1.
fn given_by(node: &ElementInfo) -> Option<usize> {
    match node.kind {
        "Se" | "MSe" => Some(0),
        "Sf" | "MSf" => Some(1),
        _ => None,
    }
}

/// The first of each name.
pub(super) fn distinct(mut members: Vec<Member>) -> Vec<Member> {
    members.sort_by(|a, b| a.name.cmp(&b.name));
    members.dedup_by(|b, a| a.name == b.name);
    members
}

fn write(xml: &mut Xml, terminals: &[Terminal]) -> io::Result<()> {
    nested(xml, "fmiTerminalsAndIcons", &[("fmiVersion", DEFINED_BY.to_owned())], |xml| {
        nested(xml, "Terminals", &[], |xml| terminals.iter().try_for_each(|terminal| one(xml, terminal)))
    })
}

fn one(xml: &mut Xml, terminal: &Terminal) -> io::Result<()> {
    let Terminal { name, rule, kind, description, members, inside } = terminal;
    let about: Attributes<'_> = vec![
        ("name", name.clone()),
        ("matchingRule", (*rule).to_owned()),
        ("terminalKind", kind.clone()),
        ("description", description.clone()),
    ];
    nested(xml, "Terminal", &about, |xml| {
        members.iter().try_for_each(|Member { name, variable, kind }| {
            let member = [
                ("variableName", variable.clone()),
                ("memberName", name.clone()),
                ("variableKind", (*kind).to_owned()),
            ];
            empty(xml, "TerminalMemberVariable", &member)
        })?;
        inside.iter().try_for_each(|terminal| one(xml, terminal))
    })
}
