//! The stored reference solutions beside an independent program, each other, and the model.

use bg_model::extended::Accuracy;
use bg_model::scalar::Scalar;
use bg_model::simulation::Column;
use bg_model::simulation::Recording;
use bg_workbench::precision::errors::Errors;
use bg_workbench::precision::reference::Solution;
use bg_workbench::samples;
use hacksaw::precision::reference::{Certificate, Reference};

use hacksaw::columns::LINKS;

/// The paper's case by a program of its own in quad precision, `reference/independent.c`: all 501 instants.
const INDEPENDENT: &str = include_str!("../../reference/independent.csv");

/// The project's reference solution, made by a Taylor integrator in double precision: 51 instants, 72 columns.
const SHARED: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/hacksaw_paper.csv"));

/// The largest difference from `reference` in columns whose names begin with `kind`, at all instants of `theirs`.
fn largest_difference(theirs: &Recording, reference: &Recording, kind: char) -> f64 {
    let mut largest = 0.0_f64;
    for column in theirs.columns.iter().filter(|column| column.name.starts_with(kind)) {
        let (values, ours) = (theirs.values(&column.name).unwrap(), reference.values(&column.name).unwrap());
        for (t, value) in theirs.times.iter().zip(values) {
            // Some times are multiples of 0.1 with their rounding: 9e-16 s beside ours.
            let place = (t * 100.0).round() as usize;
            assert!((reference.times[place] - t).abs() < 1e-15);
            let difference = (ours[place] - value).abs();
            assert!(difference.is_finite(), "{} at {t} s", column.name);
            largest = largest.max(difference);
        }
    }
    largest
}

#[test]
fn the_paper_s_reference_is_that_of_an_independent_program_at_every_instant() {
    let mut independent = samples::read(INDEPENDENT.as_bytes()).unwrap();
    let reference = Reference::Paper.load();
    assert_eq!((independent.times.as_slice(), independent.columns.len()), (reference.times.as_slice(), 24));
    for link in LINKS {
        let angles = independent.values(&format!("angle{link}")).unwrap().to_vec();
        for (name, function) in [("11", Scalar::cos as fn(f64) -> f64), ("21", Scalar::sin)] {
            let values = angles.iter().map(|angle| function(*angle)).collect();
            independent.columns.push(Column { values, ..Column::new(format!("R{link}_{name}"), "") });
        }
    }
    // Measured: positions 2.2e-15 m, orientations 3.3e-14, momenta 1.8e-12 kg m/s of 21, angular momenta 2.8e-13 kg
    // m^2/s of 2.6. They grow with the time: the model's lengths and the start are those of the specification
    // rounded to doubles.
    for (kind, allowed) in [('C', 5e-15), ('R', 1e-13), ('p', 5e-12), ('h', 1e-12)] {
        let largest = largest_difference(&independent, &reference, kind);
        assert!(largest > 0.0 && largest <= allowed, "{kind} is off by {largest:e}");
    }
}

#[test]
fn the_project_s_reference_in_double_precision_is_the_same_to_its_rounding() {
    let shared = samples::read(SHARED.as_bytes()).unwrap();
    assert_eq!((shared.times.len(), shared.columns.len()), (51, 72));
    // Measured: positions 9e-14 m, orientations 1.4e-12, momenta 4.9e-11 kg m/s of 21, angular momenta 8.3e-12 kg
    // m^2/s of 2.6: all grow with the time, as the rounding errors of a run in double precision do.
    for (kind, allowed) in [('C', 1e-12), ('R', 1e-11), ('p', 1e-10), ('h', 2e-11)] {
        let largest = largest_difference(&shared, &Reference::Paper.load(), kind);
        assert!(largest <= allowed, "{kind} is off by {largest:e}");
    }
}

#[test]
fn the_stored_table_is_what_the_model_gives() {
    let reference = Reference::Paper.load();
    let instants = &reference.times[..6];
    let accuracy = Accuracy { columns: 10, tolerance: 1e-20 };
    let Solution { samples, effort } = Reference::Paper.compute(accuracy, instants).unwrap();
    assert_eq!(samples.columns.len(), reference.columns.len());
    for (ours, theirs) in samples.columns.iter().zip(&reference.columns) {
        assert_eq!((&ours.name, &ours.unit, ours.values.len()), (&theirs.name, &theirs.unit, instants.len()));
        for (value, stored) in ours.values.iter().zip(&theirs.values) {
            let error = (value - stored).abs() / (1.0 + stored.abs());
            assert!(error < 1e-15, "{} is off by {error:e}", ours.name);
        }
    }
    assert_eq!(effort.events, Reference::Paper.certificate().stored.events[..2]);
}

#[test]
fn every_reference_has_passed_its_check() {
    let measured =
        [("paper", 501, 99, 60), ("full_offset", 101, 95, 58), ("rigid", 501, 9, 96), ("free_run", 101, 7, 0)];
    for (reference, (name, instants, columns, events)) in Reference::ALL.into_iter().zip(measured) {
        let table = reference.load();
        assert_eq!((reference.name(), table.times.clone()), (name, reference.instants()));
        assert_eq!((table.times.len(), table.columns.len()), (instants, columns), "{name}");
        assert!(table.columns.iter().flat_map(|column| &column.values).all(|value| value.is_finite()), "{name}");
        let Certificate { stored, check, differences } = reference.certificate();
        let settings = [&stored, &check].map(|of| Accuracy { columns: of.columns, tolerance: of.tolerance });
        assert_eq!(settings, reference.accuracies());
        assert_eq!((stored.events.len(), check.events.len()), (events, events), "{name}");
        let Errors { poses, momenta, forces } = differences;
        for (of_kind, allowed) in [(poses, 1e-15), (momenta, 1e-14), (forces, 1e-11)] {
            assert!(of_kind.is_none_or(|measure| measure.largest <= allowed), "{name}: {differences:?}");
        }
    }
}
