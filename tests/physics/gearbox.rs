use bg_model::input::Input;
use bond_graph_tests::models::dc_motor::{DcMotor, DcMotorInputs, DcMotorParameters};
use bond_graph_tests::models::gearbox::{Gearbox, GearboxInputs, GearboxParameters as Parameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

const VOLTAGE: f64 = 24.0;

/// The motor whose flywheel includes the rotor's inertia; `dc_motor` holds it against the matrix exponential.
fn equivalent(p: &Parameters) -> DcMotor {
    let flywheel = p.flywheel + p.ratio * p.ratio * p.rotor;
    let (winding, coil, constant, ratio, bearing) = (p.winding, p.coil, p.constant, p.ratio, p.bearing);
    let parameters = DcMotorParameters { winding, coil, constant, ratio, flywheel, bearing, motor_bearing: 0.0 };
    DcMotor::new(parameters, DcMotorInputs { voltage: Input::constant(VOLTAGE) }).unwrap()
}

#[test]
fn a_rigid_gearbox_makes_one_flywheel_of_two() {
    for p in [Parameters::default(), Parameters { rotor: 5e-3, ratio: 0.5, ..Parameters::default() }] {
        let times = instants(2.0, 200);
        let model = Gearbox::new(p.clone(), GearboxInputs { voltage: Input::constant(VOLTAGE) }).unwrap();
        let (run, other) = (record(&model, &times, 1e-11), record(&equivalent(&p), &times, 1e-11));
        for name in ["current", "motor_speed", "speed"] {
            let truth = other.series(name);
            let size = truth.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let apart = run.series(name).iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            within(name, apart / size, 1e-8);
        }
        let momenta = run.series("momentum");
        let apart =
            momenta.iter().zip(run.series("speed")).map(|(h, w)| (h - p.flywheel * w).abs()).fold(0.0, f64::max);
        within("momentum", apart, 1e-12);
        within("energy", run.imbalance() / run.last("supplied"), 1e-9);
    }
}

/// The torque that accelerates the flywheel is its inertia times its acceleration, at the start that of the blocked
/// current.
#[test]
fn the_tooth_hands_on_what_the_flywheel_takes() {
    let p = Parameters::default();
    let model = Gearbox::new(p.clone(), GearboxInputs { voltage: Input::constant(VOLTAGE) }).unwrap();
    let run = record(&model, &instants(1.0, 100), 1e-11);
    let whole = p.flywheel + p.ratio * p.ratio * p.rotor;
    let columns = ["tooth", "current", "speed"].map(|name| run.series(name));
    for ((tooth, current), speed) in columns[0].iter().zip(&columns[1]).zip(&columns[2]) {
        let torque = p.ratio * p.constant * current - p.bearing * speed;
        within("tooth", (tooth - p.flywheel / whole * torque).abs(), 1e-11);
    }
}
