//! A unit that is none.

use bg_model::bond_graph;
use bg_model::input::Input;
use bg_model::integrator::Dop853;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::{Model, System};

bond_graph! {
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        input voltage: Vlt;
        Se supply = voltage;
        1 armature;
        I L = 2e-3;
        R Ra = winding;
        GY motor = 0.05;
        1 shaft: rotation;
        I J = 1e-3;
        R bearing(w) = 1e-3 * w + 0.02 * tanh(w / 0.1);
        supply -> armature -> L;
        armature -> Ra;
        armature -> motor -> shaft -> J;
        shaft -> bearing;
    }
}

fn main() {
    let mut parameters = MotorParameters::default();
    parameters.winding = 2.0;
    let motor = Motor::new(parameters, MotorInputs { voltage: Input::constant(12.0) }).expect("in range");
    let start = motor.start().expect("closed");
    let span = Span { t0: 0.0, t_end: 1e-3 };
    let finish = integrate(&motor, &mut Dop853::new(), &start, span, &Settings::default(), &mut ()).expect("runs");
    let (x, negative) = (finish.state(), finish.branches());
    let mut rate = *x;
    motor.rate(finish.t, x, negative, &mut rate);
    let power = motor.powers(finish.t, x, negative);
    println!(
        "{} {} {} {} {} {}",
        motor.description().name,
        motor.parameters().winding,
        Motor::STATES,
        Motor::OUTPUTS,
        motor.stored_energy(finish.t, x, negative),
        power.supplied - power.dissipated,
    );
}
