//! `modelDescription.xml` of FMI 3.0.
//!
//! Source: FMI 3.0.1, section 2.4 and its schemas; of clocks section 2.2.8.

use std::io;

use super::{
    Packing, Variable, Xml, categories, dependencies, empty, experiment, head, initial, nested, serialized, units,
};
use crate::exported::Described;
use crate::variables::{Counts, VariableKind, clock_names, names};

pub(super) fn write(xml: &mut Xml, model: &dyn Described, packing: &Packing, token: &str) -> io::Result<()> {
    let description = model.description();
    let head = head(description, "3.0", ("instantiationToken", token.to_owned()));
    nested(xml, "fmiModelDescription", &head, |xml| {
        let yes = |name: &'static str| (name, "true".to_owned());
        let mut common = vec![("modelIdentifier", packing.identifier.clone()), yes("canGetAndSetFMUState")];
        common.extend(serialized(model, "canSerializeFMUState"));
        common.extend([yes("providesDirectionalDerivatives"), yes("providesAdjointDerivatives")]);
        if !model.delays() {
            empty(xml, "ModelExchange", &[&common[..], &[yes("needsCompletedIntegratorStep")]].concat())?;
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
        let all = super::variables(model, |reference| reference);
        all.into_iter().try_for_each(|Variable { about, value }| empty(xml, "Float64", &[about, value].concat()))?;
        clocks(xml, model)
    })
}

/// The clocks of samples tell a host when these are computed. They are activated by the unit, so that a host which
/// knows nothing of clocks runs it as it is; and no variable has the attribute `clocks`, since what is held can be read
/// at any time.
fn clocks(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    let (description, switches) = (model.description(), model.clocks());
    let counts = Counts::of(description);
    let names = clock_names(&names(description), switches.len());
    switches.into_iter().zip(names).enumerate().try_for_each(|(index, (switch, name))| {
        let attributes = [
            ("name", name),
            ("valueReference", counts.clock(index).to_string()),
            ("description", description.switches[switch].name.to_owned()),
            ("causality", "output".to_owned()),
            ("intervalVariability", "triggered".to_owned()),
        ];
        empty(xml, "Clock", &attributes)
    })
}

fn structure(xml: &mut Xml, model: &dyn Described) -> io::Result<()> {
    let counts = Counts::of(model.description());
    let pattern = model.dependencies();
    let reference = |kind| vec![("valueReference", counts.reference(kind).to_string())];
    nested(xml, "ModelStructure", &[], |xml| {
        (0..counts.outputs).try_for_each(|index| empty(xml, "Output", &reference(VariableKind::Output(index))))?;
        let clocks = model.clocks().len();
        let clock = |index| vec![("valueReference", counts.clock(index).to_string())];
        (0..clocks).try_for_each(|index| empty(xml, "Output", &clock(index)))?;
        for index in 0..counts.states {
            let mut attributes = reference(VariableKind::Derivative(index));
            attributes.extend(dependencies(pattern.as_deref(), counts, index, |reference| reference));
            empty(xml, "ContinuousStateDerivative", &attributes)?;
        }
        initial(counts).try_for_each(|kind| empty(xml, "InitialUnknown", &reference(kind)))?;
        (0..clocks).try_for_each(|index| empty(xml, "InitialUnknown", &clock(index)))?;
        (0..counts.guards).try_for_each(|index| empty(xml, "EventIndicator", &reference(VariableKind::Guard(index))))
    })
}
