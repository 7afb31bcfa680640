//! `modelDescription.xml`: a model as hosts read it.
//!
//! In: a model and how it is packed. Out: the text. Source: FMI 3.0.1, section 2.4 and its schemas.

use std::collections::BTreeMap;
use std::io;

use bg_model::description::{Description, Range};
use bg_model::run::Request;
use quick_xml::Writer;

use crate::exported::Described;
use crate::units::{BASES, exponents};
use crate::variables::{Counts, Kind, names, unit};

/// How a model is packed.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// The name of the library without its extension: letters, digits, underscores.
    pub identifier: String,
    /// The end that a host proposes, s.
    pub stop_time: f64,
}

impl Default for Packing {
    /// As `model`, over the time of a run that is not told another.
    fn default() -> Self {
        Self { identifier: "model".to_owned(), stop_time: Request::default().t_end }
    }
}

type Attributes<'a> = Vec<(&'a str, String)>;
type Xml = Writer<Vec<u8>>;

/// The text of `modelDescription.xml`.
#[must_use]
pub fn model_description(model: &dyn Described, packing: &Packing) -> String {
    text(model, packing, &token(model))
}

/// What tells this model, its variables and their order from all others: a hash of its description, packed in the usual way.
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
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    write(&mut xml, model, packing, token).expect("a vector takes all that is written");
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

fn write(xml: &mut Xml, model: &dyn Described, packing: &Packing, token: &str) -> io::Result<()> {
    let description = model.description();
    let version = env!("CARGO_PKG_VERSION");
    let mut head = vec![
        ("fmiVersion", "3.0".to_owned()),
        ("modelName", description.name.to_owned()),
        ("instantiationToken", token.to_owned()),
        ("generationTool", format!("bg-fmi {version}")),
        ("variableNamingConvention", "flat".to_owned()),
    ];
    if !description.doc.is_empty() {
        head.push(("description", line(description.doc)));
    }
    nested(xml, "fmiModelDescription", &head, |xml| {
        let yes = |name: &'static str| (name, "true".to_owned());
        let common = [
            ("modelIdentifier", packing.identifier.clone()),
            yes("canGetAndSetFMUState"),
            yes("canSerializeFMUState"),
            yes("providesDirectionalDerivatives"),
            yes("providesAdjointDerivatives"),
        ];
        empty(xml, "ModelExchange", &[&common[..], &[yes("needsCompletedIntegratorStep")]].concat())?;
        empty(xml, "CoSimulation", &[&common[..], &[yes("canHandleVariableCommunicationStepSize")]].concat())?;
        units(xml, description)?;
        nested(xml, "LogCategories", &[], |xml| {
            let category = |name: &str, description: &str| {
                vec![("name", name.to_owned()), ("description", description.to_owned())]
            };
            empty(xml, "Category", &category(crate::LOG_ERROR, "What could not be done, and why"))
        })?;
        let experiment = [
            ("startTime", "0".to_owned()),
            ("stopTime", packing.stop_time.to_string()),
            ("tolerance", format!("{:e}", Request::default().rtol)),
        ];
        empty(xml, "DefaultExperiment", &experiment)?;
        variables(xml, description)?;
        structure(xml, model)
    })
}

/// Every unit that a variable has, with its exponents.
fn units(xml: &mut Xml, description: &'static Description) -> io::Result<()> {
    let all = Counts::of(description).all().filter_map(|kind| unit(description, kind));
    let units: BTreeMap<String, Option<[i32; 8]>> = all.map(|unit| (unit.clone(), exponents(&unit))).collect();
    nested(xml, "UnitDefinitions", &[], |xml| {
        units.iter().try_for_each(|(name, exponents)| {
            nested(xml, "Unit", &[("name", name.clone())], |xml| {
                let Some(exponents) = exponents else { return Ok(()) };
                let powers = BASES.into_iter().zip(exponents).filter(|(_, power)| **power != 0);
                let powers: Attributes<'_> = powers.map(|(base, power)| (base, power.to_string())).collect();
                empty(xml, "BaseUnit", &powers)
            })
        })
    })
}

/// The limits of a range; an end that is not allowed itself is given all the same, the model refuses it.
fn limits(range: &Range) -> Attributes<'static> {
    let end = |name, value: f64| value.is_finite().then(|| (name, format!("{value:?}")));
    [end("min", range.lower), end("max", range.upper)].into_iter().flatten().collect()
}

fn variables(xml: &mut Xml, description: &'static Description) -> io::Result<()> {
    let counts = Counts::of(description);
    let names = names(description);
    nested(xml, "ModelVariables", &[], |xml| {
        counts.all().enumerate().try_for_each(|(reference, kind)| {
            let (causality, variability, initial, doc) = match kind {
                Kind::Time => ("independent", "continuous", None, String::new()),
                Kind::Parameter(index) => {
                    ("parameter", "fixed", Some("exact"), line(description.parameters[index].doc))
                }
                Kind::Input(index) => ("input", "continuous", None, line(description.inputs[index].doc)),
                Kind::Output(_) => ("output", "continuous", Some("calculated"), String::new()),
                Kind::State(_) | Kind::Derivative(_) => ("local", "continuous", Some("calculated"), String::new()),
                Kind::Guard(index) => {
                    ("local", "continuous", Some("calculated"), line(description.switches[index].name))
                }
            };
            let mut attributes = vec![("name", names[reference].clone()), ("valueReference", reference.to_string())];
            if !doc.is_empty() {
                attributes.push(("description", doc));
            }
            attributes.push(("causality", causality.to_owned()));
            attributes.push(("variability", variability.to_owned()));
            attributes.extend(initial.map(|initial| ("initial", initial.to_owned())));
            attributes.extend(unit(description, kind).map(|unit| ("unit", unit)));
            match kind {
                Kind::Parameter(index) => {
                    let info = &description.parameters[index];
                    attributes.extend(limits(&info.range));
                    attributes.push(("start", format!("{:?}", info.default)));
                }
                Kind::Input(_) => attributes.push(("start", "0.0".to_owned())),
                // An event may move it: an impact, the projection.
                Kind::State(_) => attributes.push(("reinit", "true".to_owned())),
                Kind::Derivative(index) => {
                    attributes.push(("derivative", counts.reference(Kind::State(index)).to_string()));
                }
                Kind::Time | Kind::Output(_) | Kind::Guard(_) => {}
            }
            empty(xml, "Float64", &attributes)
        })
    })
}

fn structure(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    let counts = Counts::of(model.description());
    let pattern = model.dependencies();
    let reference = |kind| vec![("valueReference", counts.reference(kind).to_string())];
    nested(xml, "ModelStructure", &[], |xml| {
        (0..counts.outputs).try_for_each(|index| empty(xml, "Output", &reference(Kind::Output(index))))?;
        for index in 0..counts.states {
            let mut attributes = reference(Kind::Derivative(index));
            if let Some(pattern) = &pattern {
                // Which inputs a rate reads the pattern does not say: all.
                let inputs = (0..counts.inputs).map(Kind::Input);
                let states = pattern[index].iter().map(|&state| Kind::State(state));
                let all: Vec<String> = inputs.chain(states).map(|kind| counts.reference(kind).to_string()).collect();
                attributes.push(("dependencies", all.join(" ")));
            }
            empty(xml, "ContinuousStateDerivative", &attributes)?;
        }
        let outputs = (0..counts.outputs).map(Kind::Output);
        let states = (0..counts.states).map(Kind::State);
        let derivatives = (0..counts.states).map(Kind::Derivative);
        let mut initial = outputs.chain(states).chain(derivatives);
        initial.try_for_each(|kind| empty(xml, "InitialUnknown", &reference(kind)))?;
        (0..counts.guards).try_for_each(|index| empty(xml, "EventIndicator", &reference(Kind::Guard(index))))
    })
}
