//! The measure of error: the largest difference of any body's pose from the reference at the samples.
//!
//! In: positions and angles of crank, rod, frame and guide at every sample. Out: one number, m or rad.

use std::path::Path;

use bg_model::integrator::{Dop853, Tolerances};
use bg_model::simulation::Recording;
use bg_workbench::samples;
use hacksaw::columns::LINKS;

use crate::problem::{SAMPLES, instants};
use crate::solvers::ours;
use hacksaw_planar::State;

/// `[x, y, angle]` of crank, rod, frame and guide, m and rad.
pub type Pose = [f64; 12];

/// The poses at all samples.
pub type Poses = Vec<Pose>;

/// The poses of a state.
pub fn of(s: &State) -> Pose {
    std::array::from_fn(|i| s[i])
}

/// What all errors are taken from.
pub struct Reference {
    /// The poses.
    pub poses: Poses,
    /// Where they come from, in words.
    pub origin: String,
}

/// The reference: the stored extended-precision solution, or a run of our own as long as there is none.
pub fn reference() -> Result<Reference, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference/paper.csv");
    if !path.exists() {
        let poses = ours::scene_poses(&mut Dop853::new(), Tolerances::new(1e-12, 1e-14))?;
        let origin = "our DOP853 at rtol 1e-12, atol 1e-14: no stored reference yet".to_owned();
        return Ok(Reference { poses, origin });
    }
    let stored = samples::read_file(&path).map_err(|fault| fault.to_string())?;
    let poses = from_run(&stored.at(&instants()))?;
    Ok(Reference { poses, origin: "hacksaw/reference/paper.csv, in extended precision".to_owned() })
}

/// The poses of a run with the columns of the reference, which has to have every sample.
pub fn from_run(run: &Recording) -> Result<Poses, String> {
    if run.times.len() != SAMPLES {
        return Err(format!("{} of {SAMPLES} samples are there", run.times.len()));
    }
    let mut columns = Vec::new();
    for link in LINKS {
        let names = [format!("C{link}_x"), format!("C{link}_y"), format!("R{link}_11"), format!("R{link}_21")];
        for name in names {
            columns.push(run.values(&name).map_err(|fault| fault.to_string())?);
        }
    }
    let pose = |sample: usize| {
        std::array::from_fn(|i| {
            let [x, y, cosine, sine] = std::array::from_fn(|k| columns[4 * (i / 3) + k][sample]);
            [x, y, sine.atan2(cosine)][i % 3]
        })
    };
    Ok((0..SAMPLES).map(pose).collect())
}

/// The largest difference of two motions in any coordinate at any sample, m or rad; angles to the nearest turn. Not a
/// number where a pose is not, and infinite where samples are missing.
pub fn largest_difference(a: &[Pose], b: &[Pose]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let differences = a.iter().zip(b).flat_map(|(a, b)| (0..12).map(move |i| difference(i, a[i], b[i])));
    differences.fold(0.0, |largest, this| if this > largest || this.is_nan() { this } else { largest })
}

fn difference(index: usize, a: f64, b: f64) -> f64 {
    let plain = a - b;
    let turns = if index % 3 == 2 { (plain / std::f64::consts::TAU).round() } else { 0.0 };
    (plain - turns * std::f64::consts::TAU).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_turns_of_an_angle_are_no_error_and_those_of_a_place_are() {
        let a = [[0.0; 12]];
        let mut b = a;
        b[0][5] = 3.0 * std::f64::consts::TAU + 1e-6;
        assert!((largest_difference(&a, &b) - 1e-6).abs() < 1e-12);
        b[0][4] = -7.0;
        assert_eq!(largest_difference(&a, &b), 7.0);
    }

    #[test]
    fn a_fault_shows() {
        assert!(largest_difference(&[[0.0; 12]], &[[f64::NAN; 12]]).is_nan());
        assert_eq!(largest_difference(&[[0.0; 12]], &[]), f64::INFINITY);
    }
}
