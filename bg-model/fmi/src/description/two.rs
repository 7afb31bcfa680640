//! `modelDescription.xml` of FMI 2.0.
//!
//! Variables are told apart by their places in the list there, counted from 1. Source: FMI 2.0.4, section 2.2 and its
//! schemas.

use std::io;

use super::{
    Packing, Variable, Xml, categories, dependencies, empty, experiment, head, initial, nested, serialized, units,
};
use crate::exported::Described;
use crate::variables::{Counts, VariableKind};

/// The place of the variable of a value reference: these count from 0 without a gap.
fn place(reference: usize) -> usize {
    reference + 1
}

pub(super) fn write(xml: &mut Xml, model: &dyn Described, packing: &Packing, token: &str) -> io::Result<()> {
    let description = model.description();
    let mut head = head(description, "2.0", ("guid", token.to_owned()));
    head.push(("numberOfEventIndicators", Counts::of(description).guards.to_string()));
    nested(xml, "fmiModelDescription", &head, |xml| {
        let yes = |name: &'static str| (name, "true".to_owned());
        let mut common = vec![("modelIdentifier", packing.identifier.clone()), yes("canGetAndSetFMUstate")];
        common.extend(serialized(model, "canSerializeFMUstate"));
        common.push(yes("providesDirectionalDerivative"));
        if !model.delays() {
            empty(xml, "ModelExchange", &common)?;
        }
        empty(xml, "CoSimulation", &[&common[..], &[yes("canHandleVariableCommunicationStepSize")]].concat())?;
        units(xml, description)?;
        categories(xml)?;
        experiment(xml, packing)?;
        variables(xml, model)?;
        structure(xml, model)
    })
}

fn variables(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    nested(xml, "ModelVariables", &[], |xml| {
        super::variables(model, place).into_iter().try_for_each(|Variable { about, value }| {
            nested(xml, "ScalarVariable", &about, |xml| empty(xml, "Real", &value))
        })
    })
}

fn structure(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    let counts = Counts::of(model.description());
    let pattern = model.dependencies();
    let index = |kind| vec![("index", place(counts.reference(kind)).to_string())];
    /// A list that is left out where it is empty, as the schema wants it.
    fn list(xml: &mut Xml, name: &str, entries: &[Vec<(&'static str, String)>]) -> io::Result<()> {
        if entries.is_empty() {
            return Ok(());
        }
        nested(xml, name, &[], |xml| entries.iter().try_for_each(|entry| empty(xml, "Unknown", entry)))
    }
    let outputs: Vec<_> = (0..counts.outputs).map(|output| index(VariableKind::Output(output))).collect();
    let derivatives = (0..counts.states).map(|state| {
        let mut attributes = index(VariableKind::Derivative(state));
        attributes.extend(dependencies(pattern.as_deref(), counts, state, place));
        attributes
    });
    let derivatives: Vec<_> = derivatives.collect();
    let initial: Vec<_> = initial(counts).map(index).collect();
    nested(xml, "ModelStructure", &[], |xml| {
        list(xml, "Outputs", &outputs)?;
        list(xml, "Derivatives", &derivatives)?;
        list(xml, "InitialUnknowns", &initial)
    })
}
