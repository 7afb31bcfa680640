//! Friction and stops as words: a bearing, a contact, a guide with ends.

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::run::Simulation;

bond_graph! {
    /// A pendulum that comes to rest in the friction of its bearing.
    graph Pendulum {
        param angle: rad = -0.4;
        param torque: N*m = 1.5;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 0, 0]; start turned rotation_z(angle); }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        friction seat on pin { coulomb torque; }
        observe { angle: rad = pin.angle; speed: rad/s = pin.speed; torque: N*m = seat.effort; lost: J = integral(seat.power); total: J = stored_energy }
    }
    /// The same on a compliant pin, whose force presses.
    graph Journal {
        param angle: rad = -0.4;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 0, 0]; start turned rotation_z(angle); }
        joint pin: revolute z (ground.pivot -> rod.end) { stiffness 1e5; damping 100; tilt stiffness 1e3; tilt damping 1; }
        friction seat on pin { coulomb 0.2; static 0.3; stribeck 0.1; radius 0.1; }
        observe { angle: rad = pin.angle; speed: rad/s = pin.speed; torque: N*m = seat.effort; force: N = norm(pin.force) }
    }
    /// A block on an incline, pressed to it by springs.
    graph Incline {
        param slope: rad = 0.5;
        param grip: 1 = 0.4;
        gravity [9.81 * sin(slope), -9.81 * cos(slope), 0];
        ground { point plane = [0, 0, 0]; }
        body block { mass 3; inertia [0.1, 0.1, 0.1]; }
        joint guide: prismatic x (ground.plane -> block) { stiffness [0, 1e5, 1e5]; damping 300; tilt stiffness 1e4; tilt damping 10; }
        friction rub on guide { coulomb grip; normal guide.force.y; }
        observe { x: m = guide.travel; v: m/s = block.velocity.x; rub.effort; normal: N = guide.force.y; u: m/s = block.velocity.y }
    }
    /// A carriage that runs against the ends of its guide.
    graph Carriage {
        param speed: m/s = 2;
        ground { point middle = [0, 0, 0]; }
        body carriage { mass 3; inertia [0.1, 0.1, 0.1]; start velocity [speed, 0, 0]; }
        joint guide: prismatic x (ground.middle -> carriage) { rigid; }
        friction rub on guide { coulomb 1; }
        stop end on guide { at most 0.2; at least -0.1; stiffness 1e4; damping 20; }
        observe { x: m = guide.travel; v: m/s = carriage.velocity.x; end.effort; energy: J = stored_energy;
            lost: J = integral(dissipated_power) }
    }
}

#[test]
fn a_pendulum_comes_to_rest_in_its_bearing() {
    let model = Pendulum::new(PendulumParameters::default()).expect("in range");
    let run = Simulation::new(&model).method(Integrator::Dop853).every(0.5).until(20.0).run().expect("a run");
    for k in 0..run.times.len() {
        println!(
            "{} {} {} {} {}",
            run.times[k],
            run["angle"][k],
            run["speed"][k],
            run["torque"][k],
            run["lost"][k] + run["total"][k]
        );
    }
}

#[test]
fn a_journal() {
    let model = Journal::new(JournalParameters::default()).expect("in range");
    for method in Integrator::ALL {
        match Simulation::new(&model).method(method).every(1.0).until(8.0).run() {
            Ok(run) => println!(
                "{} {:?} {:?} {:?} {:?}",
                method.name(),
                &run["angle"],
                &run["speed"][8],
                &run["torque"],
                run.statistics.steps
            ),
            Err(fault) => println!("{} {fault}", method.name()),
        }
    }
}

#[test]
fn a_block_on_an_incline() {
    for slope in [0.3, 0.5] {
        let model = Incline::new(InclineParameters { slope, ..Default::default() }).expect("in range");
        let run = Simulation::new(&model).every(0.25).until(2.0).run().expect("a run");
        println!(
            "{:?} {:?} {:?}",
            &run["v"],
            &run["normal"],
            9.81 * (slope.sin() - 0.4 * slope.cos()) * 2.0 - 0.4 * run["u"][8]
        );
    }
}

#[test]
fn a_carriage_stops() {
    let model = Carriage::new(CarriageParameters::default()).expect("in range");
    let run = Simulation::new(&model).every(0.1).until(6.0).run().expect("a run");
    for k in 0..run.times.len() {
        println!(
            "{} {} {} {} {}",
            run.times[k],
            run["x"][k],
            run["v"][k],
            run["end.effort"][k],
            run["lost"][k] + run["energy"][k]
        );
    }
}
