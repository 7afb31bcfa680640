//! Two resistors that need each other, one of them not linear, with a conductance that a reaction sets.

use bg_model::bond_graph;
use bg_model::integrator::Dop853;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::{Model, System};

bond_graph! {
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        Se supply = 12;
        1 armature: electrical;
        R Ra = winding;
        0 node;
        1 shaft: rotation;
        I rotor = 0.01;
        rSe brake = 0;
        shaft -> rotor;
        shaft -> brake;
        param conductance: A/V^3/N/m = 0.1;
        R Rb(effort u) = conductance * brake.effort * u * u * u;
        supply -> armature -> Ra;
        armature -> node -> Rb;
    }
}

fn main() {
    let mut parameters = MotorParameters::default();
    parameters.winding = 2.0;
    let motor = Motor::new(parameters).expect("in range");
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
