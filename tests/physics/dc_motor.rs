use bg_model::input::Input;
use bond_graph_tests::models::dc_motor::{DcMotor, DcMotorInputs as Inputs, DcMotorParameters as Parameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

const VOLTAGE: f64 = 24.0;

fn model(parameters: &Parameters) -> DcMotor {
    DcMotor::new(parameters.clone(), Inputs { voltage: Input::constant(VOLTAGE) }).unwrap()
}

/// Current and speed of the steady state.
fn steady(p: &Parameters) -> (f64, f64) {
    let (torque, bearing) = (p.ratio * p.constant, p.bearing + p.ratio * p.ratio * p.motor_bearing);
    let below = p.winding * bearing + torque * torque;
    (VOLTAGE * bearing / below, VOLTAGE * torque / below)
}

/// Current and speed at time `t` from rest: the exponential of the 2 x 2 matrix in closed form.
fn exact(p: &Parameters, t: f64) -> (f64, f64) {
    let (torque, bearing) = (p.ratio * p.constant, p.bearing + p.ratio * p.ratio * p.motor_bearing);
    let a = [[-p.winding / p.coil, -torque / p.coil], [torque / p.flywheel, -bearing / p.flywheel]];
    let mean = 0.5 * (a[0][0] + a[1][1]);
    let square = mean * mean - (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let (cosine, sine) = if square > 0.0 {
        let s = square.sqrt();
        // Both eigenvalues are negative: no cosh of a large argument.
        let (slow, fast) = (((mean + s) * t).exp(), ((mean - s) * t).exp());
        (0.5 * (slow + fast), 0.5 * (slow - fast) / s)
    } else {
        let s = (-square).sqrt();
        ((mean * t).exp() * (s * t).cos(), (mean * t).exp() * (s * t).sin() / s)
    };
    let (current, speed) = steady(p);
    let along = |row: usize, own: f64| {
        let change = a[row][0] * -current + a[row][1] * -speed + mean * own;
        -own * cosine + change * sine
    };
    (current + along(0, current), speed + along(1, speed))
}

#[test]
fn current_and_speed_follow_the_matrix_exponential() {
    // Real eigenvalues, and with a light flywheel and a large coil complex ones.
    let ringing = Parameters { coil: 0.05, flywheel: 1e-3, ..Parameters::default() };
    for p in [Parameters::default(), ringing] {
        let run = record(&model(&p), &instants(2.0, 400), 1e-11);
        within("current", run.deviation("current", |t| exact(&p, t).0), 1e-8);
        within("speed", run.deviation("speed", |t| exact(&p, t).1), 1e-8);
        within("gear", run.deviation("motor_speed", |t| p.ratio * exact(&p, t).1), 1e-7);
        within("energy", run.imbalance() / run.last("supplied"), 1e-9);
    }
}

#[test]
fn it_comes_to_the_steady_state() {
    let p = Parameters::default();
    let run = record(&model(&p), &[0.0, 20.0], 1e-11);
    let (current, speed) = steady(&p);
    within("current", (run.last("current") / current - 1.0).abs(), 1e-9);
    within("speed", (run.last("speed") / speed - 1.0).abs(), 1e-9);
}

#[test]
fn the_starting_current_is_that_of_the_blocked_motor() {
    // Blocked by a flywheel of 1e9 kg m^2: only the coil delays the current on its way to U / R.
    let p = Parameters { flywheel: 1e9, ..Parameters::default() };
    let run = record(&model(&p), &instants(0.05, 100), 1e-11);
    let truth = |t: f64| VOLTAGE / p.winding * (1.0 - (-p.winding / p.coil * t).exp());
    within("blocked", run.deviation("current", truth), 1e-8);
    // With the wheel free the peak lies a little below.
    let free = record(&model(&Parameters::default()), &instants(0.05, 500), 1e-11).largest("current");
    assert!((0.9..1.0).contains(&(free / (VOLTAGE / p.winding))), "{free}");
}
