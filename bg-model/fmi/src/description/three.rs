//! `modelDescription.xml` of FMI 3.0.
//!
//! Source: FMI 3.0.1, section 2.4 and its schemas.

use std::io;

use super::{Packing, Variable, Xml, categories, dependencies, empty, experiment, head, initial, nested, units};
use crate::exported::Described;
use crate::variables::{Counts, Kind};

pub(super) fn write(xml: &mut Xml, model: &dyn Described, packing: &Packing, token: &str) -> io::Result<()> {
    let description = model.description();
    let head = head(description, "3.0", ("instantiationToken", token.to_owned()));
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
        categories(xml)?;
        experiment(xml, packing)?;
        variables(xml, model)?;
        structure(xml, model)
    })
}

fn variables(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    nested(xml, "ModelVariables", &[], |xml| {
        let all = super::variables(model, |reference| reference);
        all.into_iter().try_for_each(|Variable { about, value }| empty(xml, "Float64", &[about, value].concat()))
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
            attributes.extend(dependencies(pattern.as_deref(), counts, index, |reference| reference));
            empty(xml, "ContinuousStateDerivative", &attributes)?;
        }
        initial(counts).try_for_each(|kind| empty(xml, "InitialUnknown", &reference(kind)))?;
        (0..counts.guards).try_for_each(|index| empty(xml, "EventIndicator", &reference(Kind::Guard(index))))
    })
}
