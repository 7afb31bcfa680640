//! `modelDescription.xml` and `terminalsAndIcons.xml`: a model as hosts read it.
//!
//! In: a model and how it is packed. Out: the texts. What the versions of the standard share is here.

mod joints;
mod terminals;
mod three;
mod two;

use std::collections::BTreeMap;
use std::io;

use bg_model::description::{Description, Range};
use bg_model::run::Request;
use quick_xml::Writer;

use crate::exported::Described;
use crate::units::{BASES, in_bases};
use crate::variables::{Counts, VariableKind, names, unit};

pub use terminals::terminals_and_icons;

/// A version of the standard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    #[default]
    Three,
}

impl Version {
    /// As the standard writes it, `3.0`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }
}

/// How a model is packed.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// For which version of the standard.
    pub version: Version,
    /// The name of the library without its extension: letters, digits, underscores.
    pub identifier: String,
    /// The end that a host proposes, s.
    pub stop_time: f64,
}

impl Default for Packing {
    /// As `model` for FMI 3.0, over the time of a run that is not told another.
    fn default() -> Self {
        Self { version: Version::Three, identifier: "model".to_owned(), stop_time: Request::default().t_end }
    }
}

type Attributes<'a> = Vec<(&'a str, String)>;
type Xml = Writer<Vec<u8>>;

/// The text of `modelDescription.xml`.
#[must_use]
pub fn model_description(model: &dyn Described, packing: &Packing) -> String {
    text(model, packing, &token(model))
}

/// What tells this model, its variables and their order from all others: a hash of its description, packed in the usual
/// way. It is the same in all versions of the standard.
#[must_use]
pub fn token(model: &dyn Described) -> String {
    let text = text(model, &Packing::default(), "");
    // FNV-1a, 128 bits: http://www.isthe.com/chongo/tech/comp/fnv/.
    let hash = text.bytes().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
        (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
    });
    format!("{{{hash:032x}}}")
}

fn text(model: &dyn Described, packing: &Packing, token: &str) -> String {
    let write = match packing.version {
        Version::Two => two::write,
        Version::Three => three::write,
    };
    document(|xml| write(xml, model, packing, token))
}

/// A text of XML.
fn document(write: impl FnOnce(&mut Xml) -> io::Result<()>) -> String {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    write(&mut xml).expect("a vector takes all that is written");
    let body = String::from_utf8(xml.into_inner()).expect("names are text");
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{body}\n")
}

fn empty(xml: &mut Xml, name: &str, attributes: &[(&str, String)]) -> io::Result<()> {
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(attributes).write_empty().map(|_| ())
}

fn nested(
    xml: &mut Xml,
    name: &str,
    attributes: &[(&str, String)],
    inside: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(attributes).write_inner_content(inside).map(|_| ())
}

/// A documentation comment in one line.
fn line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The attributes of the whole, with what tells the model from others.
fn head(description: &Description, version: &str, token: (&'static str, String)) -> Attributes<'static> {
    let mut head = vec![
        ("fmiVersion", version.to_owned()),
        ("modelName", description.name.to_owned()),
        token,
        ("generationTool", format!("bg-fmi {}", env!("CARGO_PKG_VERSION"))),
        ("variableNamingConvention", "flat".to_owned()),
    ];
    if !description.doc.is_empty() {
        head.push(("description", line(description.doc)));
    }
    head
}

fn categories(xml: &mut Xml) -> io::Result<()> {
    nested(xml, "LogCategories", &[], |xml| {
        let category =
            |name: &str, description: &str| vec![("name", name.to_owned()), ("description", description.to_owned())];
        empty(xml, "Category", &category(crate::LOG_ERROR, "What could not be done, and why"))
    })
}

fn experiment(xml: &mut Xml, packing: &Packing) -> io::Result<()> {
    let experiment = [
        ("startTime", "0".to_owned()),
        ("stopTime", packing.stop_time.to_string()),
        ("tolerance", format!("{:e}", Request::default().rtol)),
    ];
    empty(xml, "DefaultExperiment", &experiment)
}

/// Every unit that a variable has, with its exponents and its size.
fn units(xml: &mut Xml, description: &'static Description) -> io::Result<()> {
    let all = Counts::of(description).all().filter_map(|kind| unit(description, kind));
    let units: BTreeMap<String, _> = all.map(|unit| (unit.clone(), in_bases(&unit))).collect();
    nested(xml, "UnitDefinitions", &[], |xml| {
        units.iter().try_for_each(|(name, meaning)| {
            nested(xml, "Unit", &[("name", name.clone())], |xml| {
                let Some((exponents, size)) = meaning else { return Ok(()) };
                let powers = BASES.into_iter().zip(exponents).filter(|(_, power)| **power != 0);
                let factor = (*size != 1.0).then(|| ("factor", format!("{size:?}")));
                let powers = powers.map(|(base, power)| (base, power.to_string()));
                let attributes: Attributes<'_> = powers.chain(factor.clone()).collect();
                empty(xml, "BaseUnit", &attributes)?;
                // Values are in the declared unit; that they are to be shown in it is said as well.
                factor.map_or(Ok(()), |_| empty(xml, "DisplayUnit", &[("name", name.clone())]))
            })
        })
    })
}

/// That a saved state can be written as bytes, by this attribute: the past of a delay is not among them.
fn serialized(model: &dyn Described, attribute: &'static str) -> Option<(&'static str, String)> {
    (!model.delays()).then(|| (attribute, "true".to_owned()))
}

/// The limits of a range; an end that is not allowed itself is given all the same, the model refuses it.
fn limits(range: &Range) -> Attributes<'static> {
    let end = |name, value: f64| value.is_finite().then(|| (name, format!("{value:?}")));
    [end("min", range.lower), end("max", range.upper)].into_iter().flatten().collect()
}

/// A variable: what it is, and what belongs to its type.
struct Variable {
    about: Attributes<'static>,
    value: Attributes<'static>,
}

/// All variables in the order of their value references; `number` gives what a derivative names its state by.
fn variables(model: &dyn Described, number: fn(usize) -> usize) -> Vec<Variable> {
    let (description, nominals) = (model.description(), model.nominals());
    let counts = Counts::of(description);
    let variable = |(kind, (reference, name)): (VariableKind, (usize, String))| {
        let (causality, variability, initial, doc) = match kind {
            VariableKind::Time => ("independent", "continuous", None, String::new()),
            VariableKind::Parameter(index) => {
                ("parameter", "fixed", Some("exact"), line(description.parameters[index].doc))
            }
            VariableKind::Input(index) => ("input", "continuous", None, line(description.inputs[index].doc)),
            VariableKind::Output(_) => ("output", "continuous", Some("calculated"), String::new()),
            VariableKind::State(_) | VariableKind::Derivative(_) => {
                ("local", "continuous", Some("calculated"), String::new())
            }
            VariableKind::Guard(index) => {
                ("local", "continuous", Some("calculated"), line(description.switches[index].name))
            }
        };
        let mut about = vec![("name", name), ("valueReference", reference.to_string())];
        if !doc.is_empty() {
            about.push(("description", doc));
        }
        about.push(("causality", causality.to_owned()));
        about.push(("variability", variability.to_owned()));
        about.extend(initial.map(|initial| ("initial", initial.to_owned())));
        let unit = unit(description, kind);
        let shown = unit.clone().filter(|unit| in_bases(unit).is_some_and(|(_, size)| size != 1.0));
        let mut value: Attributes<'static> = unit.map(|unit| ("unit", unit)).into_iter().collect();
        value.extend(shown.map(|unit| ("displayUnit", unit)));
        match kind {
            VariableKind::Parameter(index) => {
                let info = &description.parameters[index];
                value.extend(limits(&info.range));
                value.push(("start", format!("{:?}", info.default)));
            }
            VariableKind::Input(_) => value.push(("start", "0.0".to_owned())),
            // An event may move it: an impact, the projection.
            VariableKind::State(index) => {
                value.extend(nominals.as_ref().map(|nominals| ("nominal", format!("{:?}", nominals[index]))));
                value.push(("reinit", "true".to_owned()));
            }
            VariableKind::Derivative(index) => {
                value.push(("derivative", number(counts.reference(VariableKind::State(index))).to_string()));
            }
            VariableKind::Time | VariableKind::Output(_) | VariableKind::Guard(_) => {}
        }
        Variable { about, value }
    };
    counts.all().zip(names(description).into_iter().enumerate()).map(variable).collect()
}

/// What the derivative of a state depends on, where that is known.
fn dependencies(
    pattern: Option<&[Vec<usize>]>,
    counts: Counts,
    state: usize,
    number: fn(usize) -> usize,
) -> Option<(&'static str, String)> {
    // Which inputs a rate reads the pattern does not say: all.
    let inputs = (0..counts.inputs).map(VariableKind::Input);
    let states = pattern?[state].iter().map(|&state| VariableKind::State(state));
    let all: Vec<String> = inputs.chain(states).map(|kind| number(counts.reference(kind)).to_string()).collect();
    Some(("dependencies", all.join(" ")))
}

/// What is calculated in the initialization.
fn initial(counts: Counts) -> impl Iterator<Item = VariableKind> {
    let (outputs, states) =
        ((0..counts.outputs).map(VariableKind::Output), (0..counts.states).map(VariableKind::State));
    outputs.chain(states).chain((0..counts.states).map(VariableKind::Derivative))
}
