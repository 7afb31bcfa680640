//! The columns of a run of the hacksaw: those of the reference trajectory, joint forces, and the links' angles.

use std::f64::consts::{PI, TAU};

use bg_model::scalar::Scalar;
use bg_model::simulation::{Column, MissingColumn, Recording};

/// The links that move: crank, rod, frame and guide.
pub const LINKS: [u8; 4] = [2, 3, 4, 5];

/// The suffixes of a vector's components.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// The columns of the reference trajectory after `t`: for each link L the position `CL` of its centre of mass, its
/// orientation `RL` (body to inertial, row by row), its momentum `pL` and its angular momentum `hL` about the centre of
/// mass.
#[must_use]
pub fn reference_columns() -> Vec<String> {
    let vector = |symbol: char, link: u8| AXES.map(|axis| format!("{symbol}{link}_{axis}"));
    let matrix = |link: u8| (1..=3).flat_map(move |row| (1..=3).map(move |column| format!("R{link}_{row}{column}")));
    LINKS
        .iter()
        .flat_map(|&link| {
            vector('C', link).into_iter().chain(matrix(link)).chain(vector('p', link)).chain(vector('h', link))
        })
        .collect()
}

/// The forces in joints, of the slot and of the cut, each with its components: what a trajectory has after the columns
/// of the reference, as far as a scene observes it.
#[must_use]
pub fn forces() -> Vec<String> {
    let of = |force: &str| AXES.map(|axis| format!("{force}_{axis}"));
    ["F12", "F23", "F34", "F15", "F45", "Fcut"].into_iter().flat_map(of).collect()
}

/// Whether all columns of the reference trajectory are among `names`.
#[must_use]
pub fn has_reference_columns<'n>(names: impl Iterator<Item = &'n str> + Clone) -> bool {
    reference_columns().iter().all(|column| names.clone().any(|name| name == column))
}

/// The angles without their jumps by a whole turn: from sample to sample less than half a turn.
#[must_use]
pub fn continued(angles: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    angles
        .into_iter()
        .map(|angle| {
            let jump = before.map_or(0.0, |before| angle - before);
            if jump > PI {
                turns -= 1.0;
            } else if jump < -PI {
                turns += 1.0;
            }
            before = Some(angle);
            angle + turns * TAU
        })
        .collect()
}

/// Appends the links' angles about z, rad, which the orientations of a plane motion determine.
///
/// # Errors
/// A missing orientation.
pub fn add_angles(run: &mut Recording) -> Result<(), MissingColumn> {
    for (link, name) in LINKS.iter().zip(["crank_angle", "rod_angle", "frame_angle", "guide_angle"]) {
        let (sine, cosine) = (run.values(&format!("R{link}_21"))?, run.values(&format!("R{link}_11"))?);
        let values = sine.iter().zip(cosine).map(|(sine, cosine)| Scalar::atan2(*sine, *cosine)).collect();
        run.columns.push(Column { values, ..Column::new(name, "rad") });
    }
    Ok(())
}
