//! Two runs beside each other: how far each output of one is from that of the other.
//!
//! In: two recordings. Out: for each column that both have the largest difference, and when. Angles are compared
//! without whole turns. Where one has samples that the other lacks, the instants of both count.

use bg_model::simulation::{Column, Recording};

use crate::ask::quantity::turn;
use crate::files::table::table;

/// The largest difference in one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The column's name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The largest |a - b|, in the unit.
    pub largest: f64,
    /// When, s.
    pub time: f64,
    /// The largest |b|, in the unit.
    pub magnitude: f64,
}

/// The deviations of `a` from `b` in the columns that both have, in the order of `a`, at the instants that both have.
#[must_use]
pub fn deviations(a: &Recording, b: &Recording) -> Vec<Deviation> {
    let (a, b) = (a.at(&b.times), b.at(&a.times));
    let shared = a.columns.iter().filter_map(|column| Some((column, b.column(&column.name)?)));
    shared.map(|(column, theirs)| deviation(&a.times, column, theirs)).collect()
}

fn deviation(times: &[f64], column: &Column, theirs: &[f64]) -> Deviation {
    let turn = turn(&column.unit);
    let differences = column.values.iter().zip(theirs).map(|(ours, theirs)| difference(*ours, *theirs, turn));
    let (largest, time) = differences.zip(times).fold((0.0, 0.0), |most, (difference, time)| {
        // A NaN is the largest of all.
        if difference > most.0 || difference.is_nan() { (difference, *time) } else { most }
    });
    let magnitude = theirs.iter().map(|value| value.abs()).fold(0.0, f64::max);
    Deviation { name: column.name.clone(), unit: column.unit.clone(), largest, time, magnitude }
}

/// How far `a` and `b` are apart. Infinities of one sign are not, nor are two values that are both no number.
fn difference(a: f64, b: f64, turn: f64) -> f64 {
    let is_same = a == b || a.is_nan() && b.is_nan();
    if is_same { 0.0 } else { without_turns(a - b, turn).abs() }
}

/// `difference` less whole turns.
#[must_use]
pub fn without_turns(difference: f64, turn: f64) -> f64 {
    if turn.is_finite() { difference - turn * (difference / turn).round() } else { difference }
}

/// The deviations for programs; a difference that is no number is null.
#[must_use]
pub fn json(a: &Recording, b: &Recording) -> serde_json::Value {
    let one = |Deviation { name, unit, largest, time, magnitude }: &Deviation| {
        serde_json::json!({
            "output": name, "unit": unit, "largest_difference": largest, "t": time, "largest_value": magnitude
        })
    };
    deviations(a, b).iter().map(one).collect()
}

/// The comparison of two runs called `names` as text.
#[must_use]
pub fn text(names: [&str; 2], a: &Recording, b: &Recording) -> String {
    let deviations = deviations(a, b);
    let shared = a.at(&b.times).times.len();
    let mut text = format!(
        "{} and {}: {} outputs in common, {shared} instants in common ({} and {})\n",
        names[0],
        names[1],
        deviations.len(),
        a.times.len(),
        b.times.len()
    );
    if deviations.is_empty() || shared == 0 {
        return text;
    }
    let head = ["output", "largest difference", "unit", "at t in s", "largest value"].map(str::to_owned);
    let rows = deviations.iter().map(|Deviation { name, unit, largest, time, magnitude }| {
        [name.clone(), format!("{largest:.3e}"), unit.clone(), time.to_string(), format!("{magnitude:.3e}")]
    });
    text += &table(&std::iter::once(head).chain(rows).collect::<Vec<_>>());
    let only = |of: &Recording, than: &Recording| -> Vec<String> {
        of.columns.iter().filter(|column| !than.has(&column.name)).map(|column| column.name.clone()).collect()
    };
    for (name, missing) in [(names[0], only(a, b)), (names[1], only(b, a))] {
        if !missing.is_empty() {
            text += &format!("only in {name}: {}\n", missing.join(", "));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn run(columns: &[(&str, &str)], rows: &[(f64, &[f64])]) -> Recording {
        let mut run = Recording::new(columns.iter().map(|(name, unit)| Column::new(*name, *unit)).collect());
        rows.iter().for_each(|(t, row)| run.push(*t, row.iter().copied()));
        run
    }

    #[test]
    fn the_largest_difference_of_each_output_is_found_and_turns_do_not_count() {
        let a = run(
            &[("x", "m"), ("angle", "rad"), ("own", "m")],
            &[(0.0, &[1.0, 3.0, 0.0]), (0.5, &[9.0; 3]), (1.0, &[2.0, -3.125, 0.0])],
        );
        let b = run(&[("angle", "rad"), ("x", "m")], &[(0.0, &[3.0, 1.0]), (1.0, &[TAU - 3.0, 2.5])]);
        let found = deviations(&a, &b);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].largest, found[0].time, found[0].magnitude), (0.5, 1.0, 2.5));
        assert!((found[1].largest - 0.125).abs() < 1e-15, "{}", found[1].largest);
        let text = text(["a", "b"], &a, &b);
        assert!(text.starts_with("a and b: 2 outputs in common, 2 instants in common (3 and 2)\n"), "{text}");
        assert!(text.ends_with("only in a: own\n"), "{text}");
    }

    #[test]
    fn a_number_that_is_none_is_the_largest() {
        let [a, b] = [f64::NAN, 1.0].map(|value| run(&[("x", "m")], &[(0.0, &[2.0]), (1.0, &[value])]));
        assert!(deviations(&a, &b)[0].largest.is_nan());
        let infinite = run(&[("x", "m")], &[(0.0, &[f64::INFINITY]), (1.0, &[f64::NAN])]);
        assert_eq!(deviations(&infinite, &infinite)[0].largest, 0.0);
    }
}
