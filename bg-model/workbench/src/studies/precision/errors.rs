//! How far a trajectory is from a reference, by kind of quantity.
//!
//! In: a trajectory and a reference with units. Out: the largest and the root mean square error of poses, momenta and
//! forces, over the reference's instants and the columns that both have. An orientation, nine columns, counts as one:
//! the angle of the rotation between the two.

use std::f64::consts::SQRT_2;

use bg_units::Unit;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use bg_model::description::OutputInfo;
use bg_model::simulation::{MissingColumn, Recording};

use crate::ask::quantity::turn;

/// A trajectory that cannot be compared with a reference.
#[derive(Debug, Error)]
pub enum Incomparable {
    /// It lacks one of the reference's instants.
    #[error("the trajectory has no sample at t = {0} s")]
    MissingInstant(f64),
    /// A column cannot be read.
    #[error(transparent)]
    Column(#[from] MissingColumn),
}

/// Errors of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// The largest.
    pub largest: f64,
    /// The root of the mean square over instants and columns.
    pub l2: f64,
}

/// The errors of a trajectory; nothing of a kind that the two do not have in common.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Positions (m), angles and orientations (rad).
    pub poses: Option<Measure>,
    /// Momenta (kg m/s) and angular momenta (kg m^2/s).
    pub momenta: Option<Measure>,
    /// Forces (N).
    pub forces: Option<Measure>,
}

#[derive(Clone, Copy, PartialEq)]
enum QuantityKind {
    Pose,
    Momentum,
    Force,
}

/// The kind of a quantity of this unit, if its errors count.
fn kind(unit: Unit) -> Option<QuantityKind> {
    let kinds = [
        ("m", QuantityKind::Pose),
        ("rad", QuantityKind::Pose),
        ("kg*m/s", QuantityKind::Momentum),
        ("kg*m^2/s", QuantityKind::Momentum),
        ("N", QuantityKind::Force),
    ];
    let is_like = |known: &str| {
        let known: Unit = known.parse().expect("a unit");
        (known.dimension, known.angle) == (unit.dimension, unit.angle)
    };
    kinds.into_iter().find(|(known, _)| is_like(known)).map(|(_, kind)| kind)
}

impl Errors {
    /// The errors of `run` at all instants of `reference`, whose columns have units, in what both have; `outputs` says
    /// which of them are components of one.
    ///
    /// # Errors
    /// [`Incomparable::MissingInstant`].
    pub fn between(run: &Recording, reference: &Recording, outputs: &[OutputInfo]) -> Result<Self, Incomparable> {
        let ours = run.at(&reference.times);
        if let Some(missing) = reference.times.iter().find(|t| !ours.times.contains(t)) {
            return Err(Incomparable::MissingInstant(*missing));
        }
        let mut differences: [Vec<f64>; 3] = Default::default();
        for column in reference.columns.iter().filter(|column| ours.has(&column.name)) {
            let Ok(unit) = column.unit.parse::<Unit>() else { continue };
            let Some(kind) = kind(unit) else { continue };
            let turn = turn(&column.unit);
            let (ours, theirs) = (ours.values(&column.name)?, &column.values);
            let difference = |(a, b): (&f64, &f64)| unit.in_si(modulo(a - b, turn).abs());
            differences[kind as usize].extend(ours.iter().zip(theirs).map(difference));
        }
        for matrix in outputs.chunk_by(|a, b| a.of == b.of).filter(|components| is_orientation(components)) {
            if matrix.iter().all(|component| reference.has(component.name)) {
                differences[QuantityKind::Pose as usize].extend(rotations(&ours, reference, matrix)?);
            }
        }
        let [poses, momenta, forces] = differences.map(|errors| measure(&errors));
        Ok(Self { poses, momenta, forces })
    }
}

/// `difference` less whole turns.
fn modulo(difference: f64, turn: f64) -> f64 {
    if turn.is_finite() { difference - turn * (difference / turn).round() } else { difference }
}

/// A matrix of pure numbers.
fn is_orientation(components: &[OutputInfo]) -> bool {
    components.len() == 9 && matches!(components[0].unit, "" | "1")
}

/// The angle between the two orientations that the outputs `matrix` are, rad, at each instant.
fn rotations(a: &Recording, b: &Recording, matrix: &[OutputInfo]) -> Result<Vec<f64>, MissingColumn> {
    let mut squares = vec![0.0; a.times.len()];
    for OutputInfo { name, .. } in matrix {
        for (square, (a, b)) in squares.iter_mut().zip(a.values(name)?.iter().zip(b.values(name)?)) {
            *square += (a - b) * (a - b);
        }
    }
    // Frobenius norm of A - B: 2 sqrt 2 sin(angle / 2).
    // `clamp` keeps what is no number, `min` does not.
    Ok(squares.iter().map(|square| 2.0 * (square.sqrt() / (2.0 * SQRT_2)).clamp(0.0, 1.0).asin()).collect())
}

fn measure(errors: &[f64]) -> Option<Measure> {
    // A NaN is the largest of all.
    let largest = errors.iter().fold(0.0, |most, &error| if error > most || error.is_nan() { error } else { most });
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    (!errors.is_empty()).then(|| Measure { largest, l2: square.sqrt() })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use bg_model::simulation::Column;

    fn trajectory(columns: &[(&str, &str)], rows: &[(f64, Vec<f64>)]) -> Recording {
        let column = |(name, unit): &(&str, &str)| Column::new(*name, *unit);
        let mut trajectory = Recording::new(columns.iter().map(column).collect());
        rows.iter().for_each(|(t, row)| trajectory.push(*t, row.clone()));
        trajectory
    }

    #[test]
    fn errors_are_sorted_by_kind() {
        let columns = [("C2_x", "m"), ("a", "rad"), ("n", ""), ("p2_x", "kg*m/s"), ("E", "J"), ("F", "N")];
        let reference = trajectory(&columns, &[(0.0, vec![0.0; 6]), (1.0, vec![1.0, 3.125, 9.0, 2.0, 5.0, -4.0])]);
        let ours = [(0.0, vec![0.0; 6]), (0.5, vec![7.0; 6]), (1.0, vec![1.5, 3.125 - TAU, 0.0, 2.0, 0.0, -1.0])];
        let errors = Errors::between(&trajectory(&columns, &ours), &reference, &[]).unwrap();
        // Poses: 0, 0, 1/2, 0 (a whole turn); momenta: none; forces: 0, 3.
        let poses = errors.poses.unwrap();
        assert!((poses.largest - 0.5).abs() < 1e-15 && (poses.l2 - 0.25).abs() < 1e-15, "{poses:?}");
        assert_eq!(errors.momenta, Some(Measure { largest: 0.0, l2: 0.0 }));
        assert_eq!(errors.forces, Some(Measure { largest: 3.0, l2: 4.5_f64.sqrt() }));
    }

    #[test]
    fn orientations_differ_by_an_angle() {
        let names = ["R_11", "R_12", "R_13", "R_21", "R_22", "R_23", "R_31", "R_32", "R_33"];
        let outputs = names.map(|name| OutputInfo { name, of: "R", observes: "body.orientation", unit: "1" });
        let columns = names.map(|name| (name, ""));
        let turned = |angle: f64| {
            let (s, c) = angle.sin_cos();
            trajectory(&columns, &[(0.0, vec![c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0])])
        };
        for angle in [1e-9, 0.1, 3.0] {
            let errors = Errors::between(&turned(0.3 + angle), &turned(0.3), &outputs).unwrap();
            let poses = errors.poses.unwrap();
            assert!((poses.largest - angle).abs() < 1e-15 + 1e-8 * angle, "{poses:?}");
            assert_eq!((errors.momenta, errors.forces), (None, None));
        }
        let poses = Errors::between(&turned(f64::NAN), &turned(0.3), &outputs).unwrap().poses.unwrap();
        assert!(poses.largest.is_nan() && poses.l2.is_nan(), "{poses:?}");
    }

    #[test]
    fn a_missing_instant_and_a_nan_do_not_pass() {
        let columns = [("C2_x", "m")];
        let reference = trajectory(&columns, &[(0.0, vec![0.0]), (1.0, vec![1.0])]);
        let short = trajectory(&columns, &[(0.0, vec![0.0])]);
        assert!(matches!(Errors::between(&short, &reference, &[]), Err(Incomparable::MissingInstant(1.0))));
        let broken = trajectory(&columns, &[(0.0, vec![f64::NAN]), (1.0, vec![1.0])]);
        let poses = Errors::between(&broken, &reference, &[]).unwrap().poses.unwrap();
        assert!(poses.largest.is_nan() && poses.l2.is_nan());
    }
}
