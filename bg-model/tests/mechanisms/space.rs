//! Mechanisms in space by the coordinates of their joints, beside the same with all reactions: stops, dry friction,
//! loops, a base that floats.

use std::rc::Rc;

use bg_loaded::{Graph, Interpreted};
use bg_model::dynamics::Machine;
use bg_model::simulation::Finish;

use super::hand::run;
use super::text::{graphs, model, outputs};

/// Panics unless `scene All { all reactions; }` and `scene Few {}`, which is to have so many states, end alike; gives
/// the outputs, and how the second run ended.
fn end_alike(text: &str, states: usize, t_end: f64, bound: f64) -> (Vec<f64>, Finish) {
    let graphs: Vec<Graph> = graphs(text);
    let of = |name: &str| -> (Rc<Interpreted>, Finish, Vec<f64>) {
        let model = model(&graphs, name, &[]);
        let finish = run(&*model, &model.start().unwrap(), t_end);
        let y = outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative);
        (model, finish, y)
    };
    let ((_, _, all), (few, finish, y)) = (of("All"), of("Few"));
    assert_eq!(few.description().states.len(), states);
    for (all, few) in all.iter().zip(&y) {
        assert!((all - few).abs() < bound, "{all} {few}");
    }
    (y, finish)
}

/// An arm that falls onto its stop again and again, with dry friction in its second hinge.
#[test]
fn an_arm_hits_its_stop_and_sticks() {
    let text = "graph Arm {
        gravity [0, 0, -9.81];
        ground { point O = [0, 0, 0]; }
        body a { mass 2; inertia [0.02, 0.03, 0.01]; point top = [0, 0, 0.2]; point low = [0, 0.05, -0.2];
            start top at [0, 0, 0]; start turned rotation_y(0.5); }
        joint i: revolute y (ground.O -> a.top) { rigid; }
        body b { mass 1; inertia [0.01, 0.015, 0.005]; point top = [0.02, 0, 0.2]; \
        start turned rotation_y(0.5) * rotation_x(0.4);
            start top at [-0.4 * sin(0.5), 0.05, -0.4 * cos(0.5)]; }
        joint j: revolute x (a.low -> b.top) { rigid; }
        stop end on i { at least -0.3; at most 0.6; restitution 0.6; }
        friction rub on j { coulomb 0.2; }
        observe { p: rad = i.angle; q: rad = j.angle; w: rad/s = j.speed; b.position; stored_energy }
        scenes only; scene All { all reactions; } scene Few {}
    }";
    let (y, finish) = end_alike(text, 4, 3.0, 1e-9);
    assert!(finish.statistics.events > 5, "{}", finish.statistics.events);
    assert!(y[2].abs() < 1e-9, "it sticks: {} rad/s", y[2]);
}

/// A crank about z moves a rocker about x by a rod on two balls (RSSR).
#[test]
fn a_crank_moves_a_rocker_across_by_a_rod_on_balls() {
    let text = "graph Rssr {
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; point P = [1, 0, 0.5]; }
        body crank { mass 1; inertia [0.01, 0.02, 0.02]; point left = [-0.15, 0, 0]; point right = [0.15, 0, 0];
            start left at [0, 0, 0]; }
        joint pin: revolute z (ground.O -> crank.left) { rigid; }
        body rocker { mass 1.5; inertia [0.03, 0.02, 0.03]; point low = [0, -0.3, 0]; point high = [0, 0.3, 0];
            start low at [1, 0, 0.5]; }
        joint hinge: revolute x (ground.P -> rocker.low) { rigid; }
        body rod { mass 0.5; inertia [0.04, 0.002, 0.04]; point near = [0, -0.5, 0]; point far = [0.7, 0.1, 0.5];
            start near at [0.3, 0, 0]; }
        joint first: spherical (crank.right -> rod.near) { rigid; }
        joint second: spherical (rod.far -> rocker.high) { rigid; }
        observe { crank.position; rocker.position; gap: m = norm(second.gap); stored_energy }
        scenes only; scene All { all reactions; } scene Few {}
    }";
    let (y, _) = end_alike(text, 16, 1.0, 1e-7);
    assert!(y[6] < 1e-10, "{}", y[6]);
}

/// A four-bar whose coupler lies beside its cranks, as it has to: a mechanism of the plane, as far as the motion goes.
#[test]
fn links_that_lie_beside_each_other_close_a_loop() {
    let text = "graph Beside {
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; point C = [0.4, 0, 0]; }
        body crank { mass 1; inertia [1e-3, 1e-3, 2e-3]; point foot = [0, -0.05, 0]; point head = [0, 0.05, 0.02];
            start foot at [0, 0, 0]; }
        body coupler { mass 2; inertia [1e-3, 2e-2, 2e-2]; point left = [-0.2, 0, 0]; point right = [0.2, 0, 0];
            start left at [0, 0.1, 0.02]; start turned rotation_z(guess(0.3)); }
        body rocker { mass 1; inertia [1e-2, 1e-3, 1e-2]; point foot = [0, -0.12, 0]; point head = [0, 0.12, 0.02];
            start foot at [0.4, 0, 0]; start turned rotation_z(guess(-0.1)); }
        joint o: revolute z (ground.O -> crank.foot) { rigid; }
        joint a: revolute z (crank.head -> coupler.left) { rigid; }
        joint b: revolute z (coupler.right -> rocker.head) { rigid; }
        joint c: revolute z (ground.C -> rocker.foot) { rigid; }
        drive motor on o torque = 0.5;
        observe { turned: rad = o.angle; swung: rad = c.angle; coupler.position; gap: m = norm(b.gap); stored_energy }
        scenes only; scene All { all reactions; } scene Few { expect planar; }
    }";
    let (y, _) = end_alike(text, 3, 0.7, 1e-8);
    assert!(y[0] > 2.0 && y[4] == 0.02 && y[5] < 1e-12, "{y:?}");
}

/// Nothing acts on a satellite with an arm of a hinge and a slide: its momenta and its energy are kept.
#[test]
fn a_satellite_keeps_its_momenta() {
    let text = "graph Satellite {
        body base { mass 10; inertia [2, 3, 2.5]; point hip = [0.5, 0.1, 0]; start at [0, 0, 0]; \
        start velocity [0.1, 0.2, 0]; start spin [0.3, 0.1, -0.2]; }
        body arm { mass 2; inertia [0.1, 0.4, 0.4]; point left = [-0.5, 0, 0]; start left at [0.5, 0.1, 0];
            start spin [0.3, 0.9, -0.2]; start velocity [0.1, 0.2, 0] + cross([0.3, 0.1, -0.2], [0.5, 0.1, 0]) + \
            cross([0.3, 0.9, -0.2], [0.5, 0, 0]); }
        joint elbow: revolute y (base.hip -> arm.left) { rigid; }
        body tip { mass 1; inertia [0.01, 0.02, 0.02]; start at [1, 0.1, 0]; start spin [0.3, 0.9, -0.2];
            start velocity [0.1, 0.2, 0] + cross([0.3, 0.1, -0.2], [0.5, 0.1, 0]) + cross([0.3, 0.9, -0.2], [0.5, 0, \
            0]); }
        joint slide: prismatic x (arm -> tip) { rigid; }
        observe {
            p: kg*m/s = base.p + arm.p + tip.p;
            l: kg*m^2/s = base.h + arm.h + tip.h + cross(base.position, base.p) + cross(arm.position, arm.p) + \
            cross(tip.position, tip.p);
            stored_energy; tip.position
        }
        scenes only; scene All { all reactions; } scene Few {}
    }";
    let (end, _) = end_alike(text, 22, 2.0, 1e-8);
    let graphs = graphs(text);
    let few = model(&graphs, "Few", &[]);
    let start = few.start().unwrap();
    let y = outputs(&*few, 0.0, &start, &[]);
    for (k, (start, end)) in y.iter().zip(&end).enumerate().take(7) {
        assert!((start - end).abs() < 1e-9, "{k}: {start} {end}");
    }
}
