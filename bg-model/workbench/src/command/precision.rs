//! The command `precision`: every case with every integrator.

use std::process::ExitCode;

use bg_model::integrator::Integrator;

use super::arguments::PrecisionArguments;
use super::progress::bar;
use super::{InputError, ended};
use crate::files::{RunFolder, console};
use crate::program::Program;
use crate::program::case::Case;
use crate::show::output::OutputError;
use crate::studies::precision::measure::{Entry, Setting, measure};
use crate::studies::precision::report;

pub fn measure_all(program: &Program, arguments: &PrecisionArguments) -> Result<ExitCode, InputError> {
    check(arguments)?;
    let wanted = |name: &String| program.cases.iter().find(|case| case.name == *name);
    let cases: Vec<&Case> = arguments.cases.iter().filter_map(wanted).collect();
    let methods = if arguments.methods.is_empty() { &Integrator::ALL[..] } else { &arguments.methods };
    let folder = RunFolder::claim(&arguments.out, &report::names(cases.iter().map(|case| case.name.as_str())))?;
    let points: usize = methods.iter().map(|method| settings(arguments, *method).len()).sum();
    let bar = bar((points * cases.len()) as u64, "measuring {bar:40} {pos} of {len} {msg}");
    let mut entries: Vec<Entry> = Vec::new();
    for case in cases {
        bar.set_message(format!("{}: reference", case.name));
        let reference = case.solve(&program.models)?;
        for method in methods {
            bar.set_message(format!("{} by {}", case.name, method.name()));
            for setting in settings(arguments, *method) {
                entries.push(measure(case, &program.models, *method, setting, arguments.repeats, &reference)?);
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    let (written, fault) = match report::write(folder, &entries) {
        Ok(count) => (format!("{count} files in {}", arguments.out.display()), None),
        Err(fault) => ("nothing".to_owned(), Some(fault)),
    };
    let told = format!("{}\nwritten: {written}\n", report::table(&entries));
    let printed = console::tell_as(arguments.json, &told, || serde_json::to_value(&entries).expect(report::IS_JSON));
    Ok(ended(fault.into_iter().chain(printed.err().map(OutputError::from))))
}

fn check(arguments: &PrecisionArguments) -> Result<(), InputError> {
    let ratios: Vec<f64> = arguments.atol_ratio.into_iter().collect();
    let numbers = [("--rtol", &arguments.rtol), ("--atol-ratio", &ratios), ("--fixed-step", &arguments.fixed_step)];
    for (name, values) in numbers {
        if let Some(&value) = values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
            return Err(InputError::Range { name, value, range: "a finite number above 0".to_owned() });
        }
    }
    Ok(())
}

/// How exactly a method is run: its steps or tolerances.
fn settings(arguments: &PrecisionArguments, method: Integrator) -> Vec<Setting> {
    if method.has_fixed_step() {
        return arguments.fixed_step.iter().copied().map(Setting::Step).collect();
    }
    let tolerance = |rtol| Setting::Tolerance { rtol, atol: arguments.atol_ratio.map(|ratio| rtol * ratio) };
    arguments.rtol.iter().copied().map(tolerance).collect()
}
