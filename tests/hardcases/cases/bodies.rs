//! Bodies in three dimensions: the heavy top, the free rigid body, and its turning over (Dzhanibekov).
//!
//! In: nothing. Out: cases. Orientations are compared as matrices; angular velocities in the body's axes, in which the
//! references are given.

use bg_model::bond_graph;

use super::case::{Case, Measure};
use super::compliance::Extrapolated;
use super::problem::{self, Problem};
use super::{EXPLICIT, QUAD, STIFF};
use crate::support::rotation::matrix;

bond_graph! {
    /// The top's centre of mass is 1 m from its tip along its y axis, which lies level at the start and about which it
    /// spins at 150 rad/s.
    pub graph CompliantHeavyTop {
        /// Stiffness of the tip's joint.
        param stiffness: N/m = 1e6, above 0;
        /// Damping of the tip's joint.
        param damping: N*s/m = 3e3, at least 0;
        gravity [0, 0, -9.81];
        ground { point O = [0, 0, 0]; }
        body top {
            mass 15; inertia [0.234375, 0.46875, 0.234375];
            point tip = [0, -1, 0];
            start tip at [0, 0, 0];
            start velocity [4.61538, 0, 0];
            start spin [0, 150, -4.61538];
        }
        joint tip: spherical (ground.O -> top.tip) { stiffness stiffness; damping damping; }
        observe { R = top.orientation; w: rad/s = transpose(top.orientation) * top.angular_velocity; }

        /// On an ideal joint.
        scene RigidHeavyTop { rigid joints; tune {} }
    }

    /// A body that nothing acts on; its principal moments and the angular momentum at the start.
    pub graph FreeRigidBody {
        param i1: kg*m^2 = 0.5, above 0;
        param i2: kg*m^2 = 2, above 0;
        param i3: kg*m^2 = 3, above 0;
        param h1: kg*m^2/s = 0.5;
        param h2: kg*m^2/s = 0;
        param h3: kg*m^2/s = 2.7;
        1 rotation[3]: rotation;
        orientation attitude of rotation;
        I tensor = diagonal([i1, i2, i3]) in attitude start [h1, h2, h3];
        rotation -> tensor;
        observe { w: rad/s = transpose(attitude) * rotation.flow; }
    }
}

fn top(name: &'static str, problem: Box<dyn Problem>) -> Case {
    // Quaternion from the body's to the inertial axes, angular velocity in the body's axes.
    let published = [
        [
            0.3318229126083008,
            0.17733805666693703,
            0.914975159138728,
            -0.14582601443088863,
            4.808941331728092,
            150.0,
            1.0283007567183298,
        ],
        [
            -0.7082791529743125,
            0.4387810881265819,
            0.5457283961454177,
            0.08939975282400502,
            -2.6915909121434085,
            150.0,
            4.917260989893994,
        ],
        [
            0.5845606240694147,
            -0.7006628954122065,
            0.3843257530228944,
            0.1401930788004352,
            -0.47105310174524884,
            150.0,
            5.901083048326457,
        ],
        [
            0.7329439806796637,
            -0.2782857193376127,
            0.5318246113341626,
            -0.3201761427362493,
            -0.8220781016827045,
            150.0,
            -5.923291348117337,
        ],
    ];
    let observed = |[a, b, c, d, wx, wy, wz]: [f64; 7]| [&matrix([a, b, c, d])[..], &[wx, wy, wz]].concat();
    Case {
        name,
        source: "github jgerstmayr/EXUDYN, main/pythonDev/TestModels/heavyTop.py, after Terze, Mueller, Zlatar 2016",
        held_against: QUAD,
        measure: Measure::Scaled,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-11,
        instants: vec![0.1, 0.2, 0.5, 1.0],
        reference: published.map(observed).to_vec(),
        moderate: 1e-6,
        fitting: EXPLICIT,
        problem,
    }
}

/// The heavy top on an ideal joint, to t = 1.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn heavy_top() -> Case {
    let model = RigidHeavyTop::new(RigidHeavyTopParameters::default()).expect("the defaults are in range");
    top("heavy-top", problem::outputs(model, |y| y.to_vec()))
}

/// The heavy top with a joint of 1e6, 2e6 and 4e6 N/m.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn soft_heavy_tops() -> Extrapolated {
    Extrapolated([1.0, 2.0, 4.0].map(|factor| {
        let p = CompliantHeavyTopParameters::default();
        let p = CompliantHeavyTopParameters { stiffness: factor * p.stiffness, ..p };
        problem::outputs(CompliantHeavyTop::new(p).expect("in range"), |y| y.to_vec())
    }))
}

/// The heavy top on a compliant joint, extrapolated to the ideal one.
#[must_use]
pub fn compliant_heavy_top() -> Case {
    Case { floor: 1e-5, fitting: STIFF, ..top("heavy-top-compliant", Box::new(soft_heavy_tops())) }
}

/// The free rigid body of Hairer, Norsett and Wanner, to t = 20.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn free_body() -> Case {
    let model = FreeRigidBody::new(FreeRigidBodyParameters::default()).expect("the defaults are in range");
    Case {
        name: "free-body",
        source: "E. Hairer, S. Norsett, G. Wanner, Solving ODEs I, p. 244; SciML ODEProblemLibrary rigidbody",
        held_against: "quad precision, and Jacobi's elliptic functions to 25 digits",
        measure: Measure::Absolute,
        absolute: 1.0,
        amplification: 10.0,
        floor: 1e-12,
        instants: vec![5.0, 10.0, 20.0],
        reference: vec![
            vec![0.971689997067755, 0.18677953179896722, 0.8922137426650542],
            vec![0.8901805722279488, 0.3601896625632821, 0.8706924616608436],
            vec![0.6062038539648122, 0.628747210450178, 0.8073851485756026],
        ],
        moderate: 1e-6,
        fitting: EXPLICIT,
        problem: problem::outputs(model, |y| y.to_vec()),
    }
}

/// A body that turns over again and again, because it spins about its middle axis, up to `t_end`.
fn turning_over(name: &'static str, t_end: f64, amplification: f64, moderate: f64) -> Case {
    let p = FreeRigidBodyParameters { i1: 1.0, i2: 2.0, i3: 3.0, h1: 1e-4, h2: 2.0, h3: 3e-4 };
    let model = FreeRigidBody::new(p).expect("in range");
    let case = Case {
        name,
        source: "inertias 1, 2, 3 and a spin of (1e-4, 1, 1e-4) rad/s: an unstable start of a free rigid body",
        held_against: "Jacobi's elliptic functions to 25 digits",
        measure: Measure::Absolute,
        absolute: 1e-4,
        amplification,
        floor: 1e-14 * amplification,
        instants: vec![10.0, 50.0],
        reference: vec![
            vec![-0.011772830612228216, 0.9999307028286389, 0.006797537314454841],
            vec![0.15658001259738652, -0.987665282195847, 0.09040154929534804],
        ],
        moderate,
        fitting: EXPLICIT,
        problem: problem::outputs(model, |y| y.to_vec()),
    };
    case.until(t_end)
}

/// The body up to t = 10, before it turns over.
#[must_use]
pub fn dzhanibekov() -> Case {
    turning_over("dzhanibekov", 10.0, 1.0, 1e-6)
}

/// The body up to t = 50, turned over three times: whoever is late by a little at one time is so by a hundred times
/// that at the next. Tolerances above 1e-9 say nothing.
#[must_use]
pub fn long_dzhanibekov() -> Case {
    turning_over("dzhanibekov-long", 50.0, 1e6, 1e-10)
}
