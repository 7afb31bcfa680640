//! Loops closed in closed form beside the same with all reactions: motion, reactions, derivatives, runs side by side,
//! what pictures show, and what is said where a loop cannot be closed so.

use bg_model::bond_graph;
use bg_model::failure::Cause;
use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::parameters::Parameters;
use bg_model::run::{Request, RunError, Simulation, Trajectory, in_lanes};
use bg_model::sensitivity::{Direction, sensitivities};
use bg_model::simulation::{Part, Samples};

/// A crank and a rocker; `side` says whether the coupler is above the line of the pins or below it.
mod four_bar {
    use super::bond_graph;

    bond_graph! {
        pub graph FourBar {
            param torque: N*m = 3; param side: 1 = 1; param weight: kg = 2, above 0; param reach: m = 0.5, above 0;
            gravity [0, -9.81, 0];
            ground { point O = [0, 0, 0]; point Q = [1, 0.1, 0]; }
            body crank { mass 1; inertia [0.02, 0.02, 0.02]; point O = [-0.1, 0, 0]; point A = [0.2, 0, 0];
                start O at [0, 0, 0]; }
            body coupler {
                mass weight; inertia [0.1, 0.1, 0.1]; point A = [-0.5, 0.1, 0]; point B = [0.5, 0.1, 0];
                start A at [0.3, 0, 0];
                start turned rotation_z(guess(0.9 * side));
            }
            body rocker {
                mass 1.5; inertia [0.1, 0.1, 0.2]; point Q = [-0.3, 0, 0]; point B = [reach, 0, 0];
                start Q at [1, 0.1, 0];
                start turned rotation_z(guess(1.7 * side));
            }
            joint o: revolute z (ground.O -> crank.O) { rigid; }
            joint a: revolute z (crank.A -> coupler.A) { rigid; }
            joint q: revolute z (ground.Q -> rocker.Q) { rigid; }
            joint b: revolute z (coupler.B -> rocker.B) { rigid; }
            drive motor on o torque = torque - 0.02 * o.speed;
            observe {
                crank.direction; coupler.direction; rocker.direction; rocker.position; o.force; a.force; b.force;
                q.force;
                energy: J = stored_energy - integral(supplied_power - dissipated_power);
            }
            scenes only;
            scene Said { dependent { coupler, rocker } expect planar; expect states = 3; }
            scene Closed { tune { torque, side, weight } expect planar; expect states = 3; }
            scene WithAll { all reactions; expect planar; expect states = 21; }
        }
    }
}

/// A slider-crank whose rod may be too short for its crank, and a slotted arm.
mod slides {
    use super::bond_graph;

    bond_graph! {
        pub graph Short {
            param rod: m = 0.3, above 0; param torque: N*m = 1;
            ground { point O = [0, 0, 0]; }
            body crank { mass 2; inertia [0.02, 0.02, 0.02]; point pin = [0.1, 0, 0]; start at [0, 0, 0]; }
            body link { mass 1; inertia [0.01, 0.01, 0.01]; point low = [-rod / 2, 0, 0]; point high = [rod / 2, 0, 0];
                start low at [0.1, 0, 0]; }
            body piston { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.1 + rod, 0, 0]; }
            joint main: revolute z (ground.O -> crank) { rigid; }
            joint big_end: revolute z (crank.pin -> link.low) { rigid; }
            joint small_end: revolute z (link.high -> piston) { rigid; }
            joint bore: prismatic x (ground.O -> piston) { rigid; }
            drive starter on main torque = torque;
            observe { crank.direction; link.direction; piston.position.x }
            scenes only;
            scene Short { dependent link; expect states = 3; }
        }
        pub graph Shaper {
            gravity [0, -9.81, 0];
            ground { point O = [0, 0, 0]; point Q = [0, -1, 0]; }
            body crank { mass 1; inertia [0.02, 0.02, 0.02]; point A = [0.3, 0, 0]; start at [0, 0, 0]; }
            body arm { mass 2; inertia [0.3, 0.3, 0.3]; point Q = [-0.5, 0, 0]; start Q at [0, -1, 0];
                start turned rotation_z(atan2(1, 0.3)); }
            body block { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.3, 0, 0];
                start turned rotation_z(atan2(1, 0.3)); }
            joint o: revolute z (ground.O -> crank) { rigid; }
            joint q: revolute z (ground.Q -> arm.Q) { rigid; }
            joint a: revolute z (crank.A -> block) { rigid; }
            joint slot: prismatic x (arm -> block) { rigid; }
            drive motor on o torque = 5;
            observe { crank.direction; arm.direction; block.position; o.force; q.force; a.force; slot.force;
                slot.moment }
            scenes only;
            scene Slotted { dependent arm; expect planar; expect states = 3; }
            scene SlottedWithAll { all reactions; expect planar; }
        }
    }
}

/// A slider-crank whose block rubs and bounces off an end, and is pulled by a spring.
mod bumper {
    use super::bond_graph;

    bond_graph! {
        pub graph Bumper {
            param half: m = 0.15, above 0;
            gravity [0, -9.81, 0];
            ground { point O = [0, 0, 0]; point wall = [0.2, 0.3, 0]; }
            body crank { mass 2; inertia [0.02, 0.02, 0.02]; point pin = [0.1, 0, 0]; start at [0, 0, 0]; }
            body link { mass 1; inertia [0.01, 0.01, 0.01]; point low = [-half, 0, 0]; point high = [half, 0, 0];
                start low at [0.1, 0, 0]; }
            body block { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.1 + 2 * half, 0, 0]; }
            joint main: revolute z (ground.O -> crank) { rigid; }
            joint big_end: revolute z (crank.pin -> link.low) { rigid; }
            joint small_end: revolute z (link.high -> block) { rigid; }
            joint bore: prismatic x (ground.O -> block) { rigid; }
            spring band (ground.wall -> block) { stiffness 40; length 0.1; }
            drive starter on main torque = 2 * sin(3 * t);
            friction rub on bore { coulomb 0.5; static 0.8; }
            stop end on bore { at least 0.25; restitution 0.6; }
            observe {
                crank.direction; link.direction; block.position.x; main.force; small_end.force; bore.force; end.effort;
                energy: J = stored_energy; lost: J = integral(dissipated_power);
            }
            scenes only;
            scene BumperWithAll { all reactions; expect planar; }
            scene Left { expect planar; expect states = 6; }
            scene Bumper { tune {} expect planar; expect states = 3; }
        }
    }
}

use bumper::{Bumper, BumperParameters, BumperWithAll, BumperWithAllParameters, Left, LeftParameters};
use four_bar::{Closed, ClosedParameters, Said, SaidParameters, WithAll, WithAllParameters};
use slides::{Short, ShortParameters, Slotted, SlottedParameters, SlottedWithAll, SlottedWithAllParameters};

fn run<Me: Mechanism>(model: &Me, method: Integrator, rtol: f64) -> Trajectory {
    Simulation::new(model).method(method).rtol(rtol).atol(1e-3 * rtol).every(0.05).until(2.0).run().expect("a run")
}

/// The columns differ by a part of the largest number of their kind at most; that of reactions is what occurs in any of
/// them.
fn are_same(a: &Trajectory, b: &Trajectory, part: f64) {
    let is_reaction = |name: &str| name.contains("force") || name.contains("moment");
    let size = |of_reactions: bool| {
        let columns = b.columns.iter().filter(|column| is_reaction(&column.name) == of_reactions);
        columns.flat_map(|column| &column.values).fold(1.0_f64, |most, value| most.max(value.abs()))
    };
    for column in &b.columns {
        let own = &a[column.name.as_str()];
        assert_eq!(own.len(), column.values.len());
        let apart = own.iter().zip(&column.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < part * size(is_reaction(&column.name)), "{}: {apart:e}", column.name);
    }
}

#[test]
fn a_four_bar_moves_and_reacts_as_with_all_reactions_above_and_below() {
    for side in [1.0, -1.0] {
        let closed = Closed::new(ClosedParameters { side, ..ClosedParameters::default() }).expect("a model");
        let all = WithAll::new(WithAllParameters { side, ..WithAllParameters::default() }).expect("a model");
        let closed = run(&closed, Integrator::Dop853, 1e-12);
        are_same(&closed, &run(&all, Integrator::Dop853, 1e-12), 1e-8);
        assert!(closed["coupler.direction"].iter().all(|angle| angle * side > -0.5), "it stays on its side");
        let energy = &closed["energy"];
        assert!(energy.iter().all(|value| (value - energy[0]).abs() < 1e-8));
    }
}

#[test]
fn a_slotted_arm_moves_and_reacts_as_with_all_reactions() {
    let closed = run(&Slotted::new(SlottedParameters::default()).expect("a model"), Integrator::Dop853, 1e-12);
    let all =
        run(&SlottedWithAll::new(SlottedWithAllParameters::default()).expect("a model"), Integrator::Dop853, 1e-12);
    are_same(&closed, &all, 1e-8);
}

#[test]
fn a_block_rubs_and_bounces_as_with_all_reactions() {
    let all = BumperWithAll::new(BumperWithAllParameters::default()).expect("a model");
    let left = Left::new(LeftParameters::default()).expect("a model");
    let closed = Bumper::new(BumperParameters::default()).expect("a model");
    let all = run(&all, Integrator::Dop853, 1e-12);
    for other in [run(&left, Integrator::Dop853, 1e-12), run(&closed, Integrator::Dop853, 1e-12)] {
        assert!(
            all.statistics.events > 4 && other.statistics.events == all.statistics.events,
            "{:?}",
            other.statistics
        );
        are_same(&other, &all, 1e-7);
    }
}

#[test]
fn every_method_follows_a_closed_loop() {
    let model = Closed::new(ClosedParameters::default()).expect("a model");
    let expected = run(&model, Integrator::Dop853, 1e-12);
    for (method, rtol, part) in [
        (Integrator::Taylor, 1e-11, 1e-8),
        (Integrator::Radau9, 1e-9, 1e-5),
        (Integrator::Cfmr7, 1e-10, 1e-6),
        (Integrator::Auto, 1e-10, 1e-6),
    ] {
        are_same(&run(&model, method, rtol), &expected, part);
    }
}

/// Eight runs, some above and some below.
#[test]
fn runs_side_by_side_may_be_closed_on_different_sides() {
    let model = Closed::new(ClosedParameters::default()).expect("a model");
    let request = Request {
        method: Integrator::Dop853,
        t_end: 1.0,
        rtol: 1e-6,
        samples: Samples::Every(0.5),
        ..Request::default()
    };
    let values = |k: usize| vec![3.0 + 0.2 * k as f64, if k % 3 == 1 { -1.0 } else { 1.0 }, 2.0];
    let values: Vec<Vec<f64>> = (0..8).map(values).collect();
    let together = in_lanes(&model, &request, &values);
    for (values, together) in values.iter().zip(together) {
        let mut parameters = ClosedParameters::default();
        values.iter().enumerate().for_each(|(k, &value)| parameters.set_value(k, value));
        let alone = Closed::new(parameters).expect("a model");
        let alone = Simulation::of(&alone, request.clone()).run().expect("a run");
        let together = together.expect("a run");
        for column in &alone.columns {
            let bits = |of: &[f64]| of.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&together[column.name.as_str()]), bits(&column.values), "{values:?} {}", column.name);
        }
    }
}

#[test]
fn derivatives_are_those_with_all_reactions() {
    let request = Request {
        method: Integrator::Dop853,
        t_end: 0.5,
        rtol: 1e-12,
        samples: Samples::At(vec![0.5]),
        ..Request::default()
    };
    let said = Said::new(SaidParameters::default()).expect("a model");
    let all = WithAll::new(WithAllParameters::default()).expect("a model");
    for name in ["torque", "weight", "reach"] {
        let closed = Direction::parameter::<Said>(name).expect("a parameter");
        let with_all = Direction::parameter::<WithAll>(name).expect("a parameter");
        let closed = sensitivities(&said, &request, &[closed]).expect("derivatives");
        let with_all = sensitivities(&all, &request, &[with_all]).expect("derivatives");
        let outputs = Said::describe().outputs.iter().enumerate();
        for (output, _) in outputs.filter(|(_, output)| output.name.contains("angle")) {
            let [own, expected] = [closed.of(0, output)[0], with_all.of(0, output)[0]];
            assert!((own - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{name} {output}: {own} {expected}");
        }
    }
}

#[test]
fn pictures_show_links_where_they_are_on_either_side() {
    for side in [1.0, -1.0] {
        let model = Closed::new(ClosedParameters { side, ..ClosedParameters::default() }).expect("a model");
        let parts = [Part::Outputs, Part::Shown];
        let run = Simulation::new(&model).every(0.1).until(0.5).recording(&parts).run().expect("a run");
        let outputs = Closed::describe().outputs;
        let rocker = Closed::describe().drawing.bodies.iter().find(|body| body.name == "rocker").expect("a body");
        let place = outputs.len() + rocker.position.expect("a known place");
        let first = outputs.iter().position(|output| output.of == "rocker.position").expect("an output");
        for axis in 0..2 {
            let [shown, output] = [place + axis, first + axis].map(|column| &run.recording.columns[column].values);
            assert!(shown.iter().zip(output).all(|(a, b)| (a - b).abs() < 1e-12), "{shown:?} {output:?}");
        }
    }
}

#[test]
fn a_loop_that_comes_to_its_end_is_named() {
    use Integrator::{Ark5, Auto, Bs5, Cfmr7, Dop853, Nystrom, Radau9, Rk4, Rodas5p, Taylor};
    // Most methods turned back there, or rested, and said nothing.
    let model = Short::new(ShortParameters { rod: 0.08, ..ShortParameters::default() }).expect("a model");
    for method in [Auto, Dop853, Bs5, Cfmr7, Taylor, Nystrom, Radau9, Ark5, Rodas5p, Rk4] {
        for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
            let request = Request { method, rtol, t_end: 10.0, ..Request::default() };
            let RunError::Stopped(failed) = Simulation::of(&model, request).run().expect_err("the rod is too short")
            else {
                panic!("{method:?} at {rtol:e}: no run")
            };
            let words = failed.to_string();
            let Cause::LoopEnds { joint: "bore", t } = failed.cause else { panic!("{method:?} at {rtol:e}: {words}") };
            assert!((t - 0.3218).abs() < 2e-3, "{method:?} at {rtol:e}: {t} s");
            assert!(words.contains("`dependent`"), "{words}");
        }
    }
}
