//! The hacksaw's hard cases: what is changed, and what it is held against.
//!
//! In: nothing. Out: [`cases`], run and judged like the published ones. The error is the largest of the poses' (m, and
//! entries of orientations), of the energy balance over the case's scale, and of the orthogonality.

use hacksaw::precision::reference::Reference;

use super::machine::{self, Changes, Scale, planar_names, spatial_names};
use super::references::{self, Table};
use crate::hardcases::case::{Case, Measure};
use crate::hardcases::problem::{Followable, Problem};

/// Joints without damping.
const UNDAMPED: [(&str, f64); 6] =
    [("r_2", 0.0), ("r_23", 0.0), ("r_34", 0.0), ("r_15", 0.0), ("r_45", 0.0), ("r_45r", 0.0)];
/// Joints of 1e9 N/m.
const STIFF: [(&str, f64); 5] = [("k_2", 1e9), ("k_23", 1e9), ("k_34", 1e9), ("k_15", 1e9), ("k_45", 1e9)];

/// The time at which the torque turns round, s.
pub const REVERSAL: f64 = 0.5;
/// The disturbance of the start, in the SI unit of each state.
pub const DISTURBANCE: f64 = 1e-12;

/// A case in the plane whose reference was computed in double-double arithmetic.
pub struct Planar {
    /// The name.
    pub name: &'static str,
    /// What is hard about it.
    about: &'static str,
    /// What is changed of the paper's case.
    pub changes: Vec<(&'static str, f64)>,
    /// The energy that the balance is measured by, J: of the order of what is moved during the run.
    pub scale: f64,
    /// The instants of the reference, s.
    pub instants: &'static [f64],
}

/// The cases in the plane that differ from the paper's by parameters.
#[must_use]
pub fn planar_cases() -> Vec<Planar> {
    let stiff = [&STIFF[..], &UNDAMPED].concat();
    let case = |name, about, changes: Changes<'static>, scale, instants| Planar {
        name,
        about,
        changes: changes.to_vec(),
        scale,
        instants,
    };
    let coasting: Changes = &[("torque", 0.0)];
    let folded: Changes = &[("torque", 0.0), ("crank_angle", std::f64::consts::PI)];
    vec![
        Planar {
            changes: stiff,
            ..case("hacksaw-stiff-undamped", "joints of 1e9 N/m without damping", &[], 10.0, &[0.02, 0.1, 0.2])
        },
        case("hacksaw-undamped", "joints without damping", &UNDAMPED, 10.0, &[0.1, 0.25, 0.5]),
        case(
            "hacksaw-outer-dead-centre",
            "falls out of the outer dead centre, no torque",
            coasting,
            1.0,
            &[0.1, 0.5, 1.0],
        ),
        case(
            "hacksaw-inner-dead-centre",
            "falls out of the inner dead centre, no torque",
            folded,
            1.0,
            &[0.1, 0.5, 1.0],
        ),
        case("hacksaw-blunt", "a cutting resistance of 1e5 N s/m", &[("r_cut", 1e5)], 1.0, &[0.1, 0.25, 0.5]),
    ]
}

/// All cases.
#[must_use]
pub fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = planar_cases().into_iter().map(planar).collect();
    cases.extend([reversed("hacksaw-reversed", false), reversed("hacksaw-reversed-by-input", true)]);
    cases.extend([at_rest("hacksaw-rest-outer", 0.0), at_rest("hacksaw-rest-inner", std::f64::consts::PI)]);
    cases.extend([offset(), disturbed()]);
    cases
}

fn hacksaw(name: &'static str, about: &'static str, problem: Box<dyn Problem>, table: Table) -> Case {
    Case {
        name,
        source: about,
        held_against: table.source,
        measure: Measure::Absolute,
        absolute: 1e-4,
        amplification: 1.0,
        floor: 1e-11,
        instants: table.instants,
        reference: table.rows,
        moderate: 1e-6,
        fitting: &["auto", "dop853", "cfmr7"],
        problem,
    }
}

/// The table's poses with what the residuals should be.
fn with_residuals(mut table: Table) -> Table {
    table.rows.iter_mut().for_each(|row| row.extend([0.0, 0.0]));
    table
}

fn planar(of: Planar) -> Case {
    let problem = machine::planar(&of.changes, Scale::Fixed(of.scale));
    hacksaw(of.name, of.about, problem, with_residuals(references::stored(of.name)))
}

fn reversed(name: &'static str, by_input: bool) -> Case {
    let about = if by_input {
        "the torque turns round at 0.5 s, an input that jumps without a guard"
    } else {
        "the torque turns round at 0.5 s, a switch of its law"
    };
    let table = with_residuals(references::stored("hacksaw-reversed"));
    hacksaw(name, about, machine::reversed(REVERSAL, by_input, Scale::Fixed(100.0)), table)
}

/// At a dead centre, without weight and torque: nothing moves, and the blade's guard stays at zero.
fn at_rest(name: &'static str, crank_angle: f64) -> Case {
    let changes = [("torque", 0.0), ("gravity", 0.0), ("crank_angle", crank_angle)];
    let start = start_of(&*machine::planar(&changes, Scale::Fixed(1.0)));
    let instants = vec![0.01, 0.1, 1.0];
    let rows = instants.iter().map(|_| start.clone()).collect();
    let table = Table { source: "rest at the start pose", instants, rows };
    hacksaw(name, "at a dead centre without weight and torque", machine::planar(&changes, Scale::Fixed(1.0)), table)
}

/// What is observed at the start.
fn start_of(problem: &dyn Followable) -> Vec<f64> {
    let request = super::request(1e-6, &[0.0], 1);
    problem.run(crate::hardcases::integrator("dop853"), &request).rows.remove(0)
}

/// The rod 25 mm out of the plane.
fn offset() -> Case {
    let table = with_residuals(references::of_hacksaw(Reference::FullOffset, &spatial_names()));
    let problem = machine::spatial(&[("rod_offset", 0.025)], 0.0, Scale::Fixed(100.0));
    Case {
        fitting: &["auto", "radau9", "rodas5p"],
        ..hacksaw(
            "hacksaw-offset",
            "the rod 25 mm out of the plane: eigenvalues of -2.5e6 and -400 +- 1.1e4 i",
            problem,
            table,
        )
    }
}

/// The symmetric mechanism in space, its start disturbed.
#[must_use]
pub fn disturbed() -> Case {
    let plane = references::of_hacksaw(Reference::Paper, &planar_names());
    let problem = machine::spatial(&[], DISTURBANCE, Scale::Fixed(100.0));
    let table = with_residuals(references::in_space(plane));
    Case {
        fitting: &["auto", "radau9", "rodas5p"],
        ..hacksaw(
            "hacksaw-disturbed",
            "the symmetric mechanism in space, disturbed by 1e-12 out of its plane",
            problem,
            table,
        )
    }
}
