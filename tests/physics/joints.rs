//! Every kind of joint, pushed and turned in every direction: along a freedom it moves as if it were not there, along a
//! held direction it comes to rest at load / stiffness, and nothing else moves.

use bond_graph_tests::models::joints as plates;
use bond_graph_tests::support::record::{Record, instants, record};

use super::truth::within;

const MASS: f64 = 2.0;
const MOMENTS: [f64; 3] = [0.1, 0.2, 0.3];
const STIFFNESS: f64 = 1e3;
const TILT_STIFFNESS: f64 = 50.0;
const FORCE: f64 = 0.5;
const TORQUE: f64 = 0.01;
/// Long enough for the slowest vibration to fall to 1e-8 (decay 2 / (2 * 0.3) per s).
const END: f64 = 7.0;

/// Translation and rotation of the plate, x, y, z each: the rotation as the skew part of the matrix.
fn moved(run: &Record, k: usize) -> [f64; 6] {
    let entry = |name: &str| run.series(name)[k];
    let skew = |a: &str, b: &str| 0.5 * (entry(a) - entry(b));
    [entry("gap_x"), entry("gap_y"), entry("gap_z"), skew("R_32", "R_23"), skew("R_13", "R_31"), skew("R_21", "R_12")]
}

/// Pushes and turns one plate; `free` are its freedoms, x, y, z of translation, then of rotation.
macro_rules! holds {
    ($test:ident, $model:ident, $parameters:ident, $free:expr) => {
        #[test]
        fn $test() {
            let free: [bool; 6] = $free.map(|free: u8| free == 1);
            for direction in 0..6 {
                let mut p = plates::$parameters::default();
                *[&mut p.force_x, &mut p.force_y, &mut p.force_z, &mut p.torque_x, &mut p.torque_y, &mut p.torque_z]
                    [direction] = if direction < 3 { FORCE } else { TORQUE };
                let times = instants(END, 14);
                let run = record(&plates::$model::new(p).unwrap(), &times, 1e-11);
                judge(&run, direction, free[direction]);
            }
        }
    };
}

fn judge(run: &Record, direction: usize, free: bool) {
    let (load, inertia, stiffness) = match direction {
        0..3 => (FORCE, MASS, STIFFNESS),
        _ => (TORQUE, MOMENTS[direction - 3], TILT_STIFFNESS),
    };
    for (k, t) in run.times.iter().enumerate() {
        let moved = moved(run, k);
        for (other, value) in moved.iter().enumerate().filter(|&(other, _)| other != direction) {
            assert!(value.abs() < 1e-9, "direction {direction} moves {other} by {value:e} at {t} s");
        }
        if free {
            let way = 0.5 * load / inertia * t * t;
            let expected = if direction < 3 { way } else { way.sin() };
            assert!(
                (moved[direction] - expected).abs() < 1e-8,
                "{direction} at {t} s: {} {expected}",
                moved[direction]
            );
        }
    }
    if !free {
        // A held rotation is a direction cosine: it differs from its angle by the cube of the angle, 1e-8 of it.
        within("held", (moved(run, run.times.len() - 1)[direction] / (load / stiffness) - 1.0).abs(), 2e-7);
    }
}

holds!(revolute, PlateOnRevolute, PlateOnRevoluteParameters, [0, 0, 0, 0, 0, 1]);
holds!(revolute_inertial, PlateOnRevoluteInertial, PlateOnRevoluteInertialParameters, [0, 0, 0, 0, 0, 1]);
holds!(revolute_per_axis, PlateOnRevolutePerAxis, PlateOnRevolutePerAxisParameters, [0, 0, 0, 0, 1, 0]);
holds!(prismatic, PlateOnPrismatic, PlateOnPrismaticParameters, [1, 0, 0, 0, 0, 0]);
holds!(prismatic_inertial, PlateOnPrismaticInertial, PlateOnPrismaticInertialParameters, [0, 1, 0, 0, 0, 0]);
holds!(spherical, PlateOnSpherical, PlateOnSphericalParameters, [0, 0, 0, 1, 1, 1]);
holds!(cylindrical, PlateOnCylindrical, PlateOnCylindricalParameters, [1, 0, 0, 1, 0, 0]);
holds!(universal, PlateOnUniversal, PlateOnUniversalParameters, [0, 0, 0, 1, 1, 0]);
holds!(universal_zx, PlateOnUniversalZx, PlateOnUniversalZxParameters, [0, 0, 0, 1, 0, 1]);
holds!(fixed, PlateOnFixed, PlateOnFixedParameters, [0, 0, 0, 0, 0, 0]);
holds!(fixed_inertial, PlateOnFixedInertial, PlateOnFixedInertialParameters, [0, 0, 0, 0, 0, 0]);
