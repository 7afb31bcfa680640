//! The commands `golden record` and `golden check`.

use std::process::ExitCode;

use serde_json::{Value, json};

use super::arguments::{CheckArguments, RecordArguments};
use super::run::{chosen, claimed_and_run, machine};
use super::{InputError, ended};
use crate::files::console;
use crate::program::Program;
use crate::run::running::{Begin, Outcome};
use crate::studies::golden::{Destination, Recorded, check_one, prepare};

/// A run that stops before its end is not recorded.
pub fn record(program: &Program, arguments: &RecordArguments) -> Result<ExitCode, InputError> {
    let RecordArguments { model, integration, out, name, json } = arguments;
    let (chosen, named) = chosen(program, model)?;
    let integration = integration.integration();
    let request = integration.request(0.0, None)?;
    let scene = program.scene_called(&model.scene);
    let name = name.as_deref().unwrap_or(&scene.name);
    let claim = || Ok(Destination::claim(out, name, program.models.graph().description.name)?);
    let machine = machine(program, scene, &chosen)?;
    let (Outcome { run, failure }, _, place) = claimed_and_run(&*machine, request, &Begin::Model, None, claim)?;
    if let Some(failure) = failure {
        return Ok(ended([format!("the run failed, nothing is recorded: {failure}")]));
    }
    let written = place.write(
        (&scene.name, program.texts.commit.as_deref()),
        (&model.input, &named),
        integration,
        &chosen.values,
        &run,
    );
    let told = |recorded: Recorded| console::tell_as(*json, &format!("{recorded}\n"), || recorded.json());
    Ok(ended(written.and_then(told).err()))
}

pub fn check(program: &Program, arguments: &CheckArguments) -> Result<ExitCode, InputError> {
    let mut faults = Vec::new();
    if arguments.json {
        let one = |prepared| match check_one(program, &prepared) {
            Ok(agreement) => json!({ "name": agreement.name(), "is_as_recorded": true, "differences": [] }),
            Err(deviating) => {
                let differences: Vec<String> = deviating.differences.iter().map(ToString::to_string).collect();
                json!({ "name": deviating.name, "is_as_recorded": false, "differences": differences })
            }
        };
        let all: Vec<Value> = prepare(program, &arguments.out, &arguments.names)?.into_iter().map(one).collect();
        let is_all = all.iter().all(|one| one["is_as_recorded"] == true);
        console::print(&format!("{:#}\n", Value::from(all)))?;
        return Ok(if is_all { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }
    for prepared in prepare(program, &arguments.out, &arguments.names)? {
        match check_one(program, &prepared) {
            Ok(agreement) => {
                faults.extend(console::tell(&format!("{agreement}\n")).err().map(|fault| fault.to_string()))
            }
            Err(deviating) => faults.extend(deviating.lines()),
        }
    }
    Ok(ended(faults))
}
