//! A joint at a point that its body does not have.

use bg_model::bond_graph;
use bg_model::integrator::Dop853;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::{Model, System};

bond_graph! {
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        body rod { sphere radius 0.1; density 7850; point end = [0, 0.1, 0]; }
        joint pin: spherical (ground -> rod.nd) { stiffness 1e5; }
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
