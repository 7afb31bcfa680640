//! What the hacksaw's hard cases are held against.
//!
//! In: names of cases. Out: poses at instants: stored ones of this folder, made by [`make`] in double-double
//! arithmetic, and those of the application, made likewise. A stored row ends with the largest difference to a second
//! computation of another order and tolerance.

use std::fmt::Write;

use bg_model::extended::{Accuracy, Fault, outputs};
use bg_model::input::Input;
use bg_model::mechanism::Liftable;
use bg_model::scalar::DoubleDouble;
use hacksaw::mechanism::{Paper, PaperParameters};
use hacksaw::precision::reference::Reference;

use super::cases::{Planar, REVERSAL, planar_cases};
use super::machine::{changed, planar_names};
use super::reversal::{Reversal, ReversalInputs, ReversalParameters};

/// Poses at instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What they are.
    pub source: &'static str,
    /// The instants, s.
    pub instants: Vec<f64>,
    /// The poses at each of them.
    pub rows: Vec<Vec<f64>>,
}

const STORED: &str = include_str!("references.csv");

/// The stored reference of the case `name`.
///
/// # Panics
/// There is none.
#[must_use]
pub fn stored(name: &str) -> Table {
    let mut table = Table { source: "double-double arithmetic, two orders", instants: Vec::new(), rows: Vec::new() };
    for line in STORED.lines().filter(|line| line.split(',').next() == Some(name)) {
        let numbers: Vec<f64> = line.split(',').skip(1).map(|field| field.parse().expect("a number")).collect();
        let poses = numbers.len() - 1;
        table.instants.push(numbers[0]);
        table.rows.push(numbers[1..poses].to_vec());
    }
    assert!(!table.rows.is_empty(), "no reference `{name}`");
    table
}

/// The columns `names` of a reference of the application, without its start.
#[must_use]
pub fn of_hacksaw(reference: Reference, names: &[String]) -> Table {
    let of = reference.load();
    let columns: Vec<&[f64]> = names.iter().map(|name| of.values(name).expect("a pose")).collect();
    let row = |k: usize| columns.iter().map(|column| column[k]).collect();
    Table {
        source: "the application's reference in double-double arithmetic",
        instants: of.times[1..].to_vec(),
        rows: (1..of.times.len()).map(row).collect(),
    }
}

/// A planar table as one in space, at its first instant and at every tenth.
#[must_use]
pub fn in_space(plane: Table) -> Table {
    let link = |pose: &[f64]| {
        let [x, y, cosine, sine] = [pose[0], pose[1], pose[2], pose[3]];
        [x, y, 0.0, cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0]
    };
    let spatial = |row: &Vec<f64>| row.chunks(4).flat_map(link).collect();
    let kept: Vec<usize> = (0..plane.instants.len()).filter(|k| *k == 0 || k % 10 == 9).collect();
    Table {
        source: plane.source,
        instants: kept.iter().map(|k| plane.instants[*k]).collect(),
        rows: kept.iter().map(|k| spatial(&plane.rows[*k])).collect(),
    }
}

/// The text of the stored references, made anew; `progress` is told each name.
///
/// # Errors
/// A computation that fails.
pub fn make(mut progress: impl FnMut(&str)) -> Result<String, Fault> {
    let mut text = format!("case,t,{},difference\n", planar_names().join(","));
    for case in planar_cases() {
        progress(case.name);
        lines(&mut text, case.name, case.instants, |accuracy| planar_poses(&case, accuracy))?;
    }
    progress("hacksaw-reversed");
    let instants = [0.25, 0.5, 0.75, 1.0];
    lines(&mut text, "hacksaw-reversed", &instants, |accuracy| reversed_poses(&instants, accuracy))?;
    Ok(text)
}

/// The poses of a case in the plane with this accuracy.
///
/// # Errors
/// The computation fails.
///
/// # Panics
/// The start does not close.
pub fn planar_poses(case: &Planar, accuracy: Accuracy) -> Result<Vec<Vec<f64>>, Fault> {
    let model = Paper::new(changed::<PaperParameters>(&case.changes)).expect("in range");
    poses(&model, case.instants, accuracy)
}

fn reversed_poses(instants: &[f64], accuracy: Accuracy) -> Result<Vec<Vec<f64>>, Fault> {
    let inputs = ReversalInputs { extra: Input::constant(0.0) };
    let model = Reversal::new(ReversalParameters { reversal: REVERSAL }, inputs).expect("in range");
    poses(&model, instants, accuracy)
}

/// Two computations, and the lines of the first with their differences.
fn lines(
    text: &mut String,
    name: &str,
    instants: &[f64],
    compute: impl Fn(Accuracy) -> Result<Vec<Vec<f64>>, Fault>,
) -> Result<(), Fault> {
    let stored = compute(Accuracy { columns: 12, tolerance: 1e-20 })?;
    let check = compute(Accuracy { columns: 10, tolerance: 1e-18 })?;
    for ((t, row), check) in instants.iter().zip(&stored).zip(&check) {
        let difference = row.iter().zip(check).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        write!(text, "{name},{t:?}").expect("a string");
        row.iter().chain([&difference]).for_each(|value| write!(text, ",{value:?}").expect("a string"));
        text.push('\n');
    }
    Ok(())
}

/// The planar poses of a model from the start that it has in `f64`.
fn poses(model: &dyn Liftable<DoubleDouble>, instants: &[f64], accuracy: Accuracy) -> Result<Vec<Vec<f64>>, Fault> {
    let start = model.machine().start().expect("the mechanism closes");
    let values: Vec<DoubleDouble> = model.values().into_iter().map(DoubleDouble::from).collect();
    let exact = model.lifted(&values).expect("in range");
    let table = model.description().outputs;
    let place = |name: &String| table.iter().position(|output| output.name == name).expect("a pose");
    let places: Vec<usize> = planar_names().iter().map(place).collect();
    let mut rows = Vec::new();
    outputs(&*exact, &start, accuracy, instants, &places, &mut |_, values| rows.push(values.to_vec()))?;
    Ok(rows)
}
