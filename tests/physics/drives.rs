use std::f64::consts::PI;

use bond_graph_tests::models::drives::{Drives, DrivesParameters, PushedPlate, PushedPlateParameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, within};

#[test]
fn torque_force_and_speed_move_what_they_drive() {
    let p = DrivesParameters::default();
    let run = record(&Drives::new(p.clone()).unwrap(), &instants(2.0, 100), 1e-11);
    let mass = PI * 2700.0 * 0.2 * 0.2 * 0.05;
    let moment = 0.5 * mass * 0.2 * 0.2;
    within("moment of inertia", (run.series("turning")[1] / run.series("wheel_speed")[1] / moment - 1.0).abs(), 1e-12);
    within("torque", run.deviation("wheel_speed", |t| p.torque / moment * t), 1e-9);
    within("force", run.deviation("block_speed", |t| p.force / 2.0 * t), 1e-9);
    within("travel", run.deviation("travel", |t| p.force / 4.0 * t * t), 1e-9);
    // The wheel lags by y: J y'' + r y' + k y = 0 from y = 0 at the full speed.
    let lag_rate = |t| oscillator(moment, p.coupling_damping, p.coupling, (0.0, p.speed), t).1;
    within("speed", run.deviation("geared_speed", |t| p.speed - lag_rate(t)), 1e-8);
    within("energy", run.imbalance(), 1e-8);
}

#[test]
fn a_force_off_the_centre_turns_the_plate_as_well() {
    let p = PushedPlateParameters::default();
    let run = record(&PushedPlate::new(p.clone()).unwrap(), &instants(1.5, 50), 1e-11);
    let (mass, moment, arm) = (1.5, 0.4, 0.5);
    within("velocity", run.deviation("velocity_y", |t| p.force / mass * t), 1e-10);
    // h_z^2 / 2 J = F arm sin(angle): the work of the force about the centre.
    let work: Vec<f64> = run.series("axis_y").iter().map(|sine| p.force * arm * sine).collect();
    let residual = run.series("h_z").into_iter().zip(work).map(|(h, work)| (0.5 * h * h / moment - work).abs());
    within("turning", residual.fold(0.0, f64::max), 1e-9);
    let rise =
        run.series("corner_y").into_iter().zip(run.series("supplied")).map(|(y, w)| (p.force * (y - 2.0) - w).abs());
    within("work", rise.fold(0.0, f64::max), 1e-9);
    within("energy", run.imbalance(), 1e-9);
    assert!(run.largest("h_z") > 0.5);
}
