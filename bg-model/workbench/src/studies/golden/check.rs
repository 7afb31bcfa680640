//! Whether recorded runs are reproduced.
//!
//! In: a folder of golden outputs and the mechanism of now. Out: for each of them that it is as recorded, or what
//! differs and the command that records it anew.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use bg_model::mechanism::Scenes;

use super::difference::{Difference, Judged, differences};
use super::file::{Golden, list};
use super::run::Prepared;
use super::{GoldenError, VERSION, renewal, size};
use crate::ask::parameters::{Values, number};
use crate::program::Program;
use crate::run::recipe::{Quantity, quantities};

/// A golden output that is as recorded. Shown, it is one line.
#[derive(Clone, Debug)]
pub struct Agreement {
    name: String,
    /// How many instants and columns it has.
    size: String,
    /// The column that is farthest off in units of its tolerance.
    farthest: Option<Judged>,
}

impl Agreement {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, size, farthest } = self;
        write!(f, "{name}: as recorded, {size}, largest deviation ")?;
        match farthest.as_ref().filter(|judged| judged.ratio() > 0.0) {
            None => f.write_str("0"),
            Some(Judged { deviation, tolerance }) => {
                let gap = if deviation.unit.is_empty() { "" } else { " " };
                let unit = &deviation.unit;
                write!(f, "{:.3e}{gap}{unit} of {tolerance:.3e} in `{}`", deviation.largest, deviation.name)
            }
        }
    }
}

/// A golden output that is not as recorded. Shown, it is a line for each difference, and one with the command that
/// records it anew.
#[derive(Debug)]
pub struct Deviating {
    /// Its name.
    pub name: String,
    /// What differs.
    pub differences: Vec<Difference>,
    /// The parameters that have other values than then, or other units, as `name = value unit, recorded with value
    /// unit`.
    pub changed: Vec<String>,
    /// The version of the workbench that recorded it, where that is not this one.
    pub recorded_by: Option<String>,
    /// The command that records it anew.
    pub renewal: String,
}

impl Deviating {
    /// The lines that it is shown as.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        let Self { name, differences, changed, recorded_by, renewal } = self;
        let by = recorded_by.as_ref().map(|version| format!("recorded by version {version}, this is {VERSION}; "));
        let last = format!("{name}: {}if this change is intended, record it again: {renewal}", by.unwrap_or_default());
        let differences = differences.iter().map(move |difference| format!("{name}: {difference}"));
        differences.chain(changed.iter().map(move |change| format!("{name}: {change}"))).chain(std::iter::once(last))
    }
}

impl fmt::Display for Deviating {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines().collect::<Vec<_>>().join("\n"))
    }
}

/// The golden outputs in `folder`, all or those called `names`, each fit to be run by `program`.
pub(crate) fn prepare<'a>(
    program: &'a Program,
    folder: &Path,
    names: &[String],
) -> Result<Vec<Prepared<'a>>, GoldenError> {
    let files = list(folder, names)?;
    if files.is_empty() {
        let first = renewal::first(&program.texts.name, folder);
        return Err(GoldenError::Nothing { folder: folder.to_owned(), first });
    }
    let model = program.models.graph().description.name;
    files.into_iter().map(|files| Prepared::new(files.read(model)?, &program.models)).collect()
}

/// Runs a golden output again.
pub(crate) fn check_one(program: &Program, prepared: &Prepared<'_>) -> Result<Agreement, Box<Deviating>> {
    let Golden { files, record, samples } = &prepared.golden;
    let (judged, differences) = match prepared.run() {
        Ok(run) => differences(record, samples, &run),
        Err(fault) => (Vec::new(), vec![Difference::NoRun(fault)]),
    };
    let name = files.name.clone();
    if differences.is_empty() {
        return Ok(Agreement { name, size: size(samples), farthest: judged.into_iter().next() });
    }
    let recorded_by = (record.version != VERSION).then(|| record.version.clone());
    let renewal = renewal::command(&program.texts.name, &prepared.golden, &prepared.parameters);
    let changed = changed(&record.values, &prepared.parameters);
    Err(Box::new(Deviating { name, differences, changed, recorded_by, renewal }))
}

/// What has become of the parameters since then: a default that has changed, or one that is not there any more.
fn changed(recorded: &BTreeMap<String, Quantity>, values: &Values) -> Vec<String> {
    let now = quantities(values);
    let text = |Quantity { value, unit }: &Quantity| {
        let gap = if unit.is_empty() { "" } else { " " };
        format!("{}{gap}{unit}", number(*value))
    };
    let one = |(name, then): (&String, &Quantity)| match now.get(name) {
        Some(now) if now == then => None,
        Some(now) => Some(format!("`{name}` is {}, and was {} when it was recorded", text(now), text(then))),
        None => Some(format!("there is no parameter `{name}` any more; it was {} when it was recorded", text(then))),
    };
    recorded.iter().filter_map(one).collect()
}

/// Runs again what is recorded in `folder` of the mechanism `Me` and looks whether the same comes out: columns,
/// instants, values within their tolerances, exact counts. As a test:
///
/// ```no_run
/// # use bg_model::bond_graph;
/// # bond_graph! { pub graph Pendulum { param k: N/m = 50; 1 slide: translation; I body = 2; C spring = k start 0.1;
/// #     slide -> body; slide -> spring; observe { x: m = spring.q } } }
/// #[test]
/// fn golden() -> Result<(), bg_workbench::golden::GoldenError> {
///     bg_workbench::golden::check::<Pendulum>(concat!(env!("CARGO_MANIFEST_DIR"), "/golden"))
/// }
/// ```
///
/// # Errors
/// [`GoldenError::Deviates`] with all that differs; else what makes the folder no one of golden outputs of `Me`.
pub fn check<Me: Scenes>(folder: impl AsRef<Path>) -> Result<(), GoldenError> {
    check_of(&Program::of::<Me>(), folder)
}

/// The same of a program that there is, of which nothing is compiled once more.
///
/// # Errors
/// As [`check`].
pub fn check_of(program: &Program, folder: impl AsRef<Path>) -> Result<(), GoldenError> {
    let all = prepare(program, folder.as_ref(), &[])?;
    let deviating: Vec<_> = all.iter().filter_map(|prepared| check_one(program, prepared).err()).collect();
    if deviating.is_empty() { Ok(()) } else { Err(GoldenError::Deviates(deviating)) }
}
