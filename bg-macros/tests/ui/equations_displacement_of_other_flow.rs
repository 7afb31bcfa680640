//! A spring whose displacement is not the integral of its flow.

use bg_model::bond_graph;
use bg_model::integrator::Dop853;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::{Model, System};

bond_graph! {
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        param stiffness: N/m = 1;
        1 slide[3]: translation;
        position place of slide;
        I mass = 2;
        1 stretch: translation;
        MTF along(v) = v.x;
        C spring = stiffness at place.y;
        slide -> mass;
        slide -> along -> stretch -> spring;
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
