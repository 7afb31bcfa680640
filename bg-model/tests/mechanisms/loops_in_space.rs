//! Loops in space that are closed in closed form, beside hand-written equations in independent coordinates.

use bg_model::dynamics::Machine;

use super::hand::{Body, Hand, Jet, Place, Turn, about, about_by, columns, cross, minus, place, plus, product, run};
use super::hand::{times, turned, unit};
use super::text::{graphs, model, outputs};

fn number(value: f64) -> Jet {
    Jet::from(value)
}

/// A crank about z moves a rocker about x by a rod on two balls (RSSR); the rod turns about its own axis as it likes.
const RSSR: &str = "graph Rssr {
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; point P = [1, 0, 0.5]; }
    body crank { mass 1; inertia [0.01, 0.02, 0.02]; point left = [-0.05, 0, 0]; point right = [0.05, 0, 0];
        start left at [0, 0, 0]; }
    joint pin: revolute z (ground.O -> crank.left) { rigid; }
    body rocker { mass 1.5; inertia [0.03, 0.02, 0.03]; point low = [0, -0.3, 0]; point high = [0, 0.3, 0];
        start low at [1, 0, 0.5]; }
    joint hinge: revolute x (ground.P -> rocker.low) { rigid; }
    body rod { mass 0.5; inertia [2e-3, 0.04, 0.04]; point near = [-0.5 * sqrt(1.42), 0, 0];
        point far = [0.5 * sqrt(1.42), 0, 0]; start near at [0.1, 0, 0];
        start turned rotation_z(atan2(0.6, 0.9)) * rotation_y(-asin(0.5 / sqrt(1.42))); }
    joint first: spherical (crank.right -> rod.near) { rigid; }
    joint second: spherical (rod.far -> rocker.high) { rigid; }
    drive motor on pin torque = 0.5;
    observe { turned: rad = pin.angle; rocker.position; rod.position; gap: m = norm(second.gap) }
    scenes only; scene Rssr {}
}";

/// By the crank's angle and the turn of the rod about its axis: crank, rocker, rod.
fn rssr(q: &[Jet]) -> Vec<(Place, Turn)> {
    let crank = about(2, q[0]);
    let pin = turned(&crank, place([0.1, 0.0, 0.0]));
    let foot = place([1.0, 0.0, 0.5]);
    let apart = minus(foot, pin);
    let (a, b) = (number(1.2) * apart[1], number(0.6));
    let c = number(1.42 - 0.36) - apart[0] * apart[0] - apart[1] * apart[1] - apart[2] * apart[2];
    let size = a * a + b * b;
    let root = (size - c * c).sqrt();
    let swing = [(a * c + b * root) * size.inverse(), (b * c - a * root) * size.inverse()];
    let rocker = about_by(0, swing);
    let end = plus(foot, turned(&rocker, place([0.0, 0.6, 0.0])));
    let along = unit(minus(end, pin));
    let third = unit(cross(along, place([0.0, 1.0, 0.0])));
    let rod = product(&columns(along, cross(third, along), third), &about(0, q[1]));
    let half = 0.5 * 1.42_f64.sqrt();
    vec![
        (turned(&crank, place([0.05, 0.0, 0.0])), crank),
        (plus(foot, turned(&rocker, place([0.0, 0.3, 0.0]))), rocker),
        (plus(pin, times(along, number(half))), rod),
    ]
}

#[test]
fn a_rod_on_two_balls_moves_as_by_hand() {
    let body = |mass: f64, inertia: [f64; 3]| Body { mass, inertia };
    let hand = Hand {
        bodies: vec![body(1.0, [0.01, 0.02, 0.02]), body(1.5, [0.03, 0.02, 0.03]), body(0.5, [2e-3, 0.04, 0.04])],
        coordinates: 2,
        poses: rssr,
        gravity: [0.0, -9.81, 0.0],
        forces: |_, _| vec![0.5, 0.0],
    };
    let graphs = graphs(RSSR);
    let closed = model(&graphs, "Rssr", &[]);
    assert_eq!(closed.description().states.len(), 4, "both angles of two freedoms with their speeds");
    let start = closed.start().unwrap();
    for t_end in [0.4, 2.0] {
        let finish = run(&*closed, &start, t_end);
        let y = outputs(&*closed, finish.t, finish.x.as_slice(), &finish.negative);
        let by_hand = run(&hand, &[0.0; 4], t_end).x;
        let poses = rssr(&[by_hand[0], by_hand[1]].map(Jet::from));
        let expected: Vec<f64> =
            [by_hand[0]].into_iter().chain(poses[1..].iter().flat_map(|of| of.0.map(Jet::value))).collect();
        for (y, expected) in y.iter().zip(&expected) {
            assert!((y - expected).abs() < 1e-9, "after {t_end} s: {y}, hand-written {expected}");
        }
        assert!(y[0].abs() > 1e-2 && y[7] < 1e-14, "{y:?}");
    }
}

/// A shaft turns another one by a universal joint; the bearing of the second one swings, so that the angle between them
/// changes.
const SHAFTS: &str = "graph Shafts {
    gravity [0, 0, 9.81];
    ground { point A = [0, 0, -0.6]; point C = [0, 0, 0]; }
    body first { mass 2; inertia [0.02, 0.02, 0.03]; point end = [0, 0, 0.3]; point base = [0, 0, -0.3];
        start at [0, 0, -0.3]; start spin [0, 0, 2]; }
    body housing { mass 1.5; inertia [0.03, 0.02, 0.01]; point pivot = [0, 0, -0.5]; start pivot at [0, 0, 0];
        start turned rotation_x(-0.5); }
    body second { mass 1; inertia [0.01, 0.015, 0.02]; point near = [0, 0, -0.4]; point far = [0, 0, 0.1];
        start near at [0, 0, 0]; start turned rotation_x(-0.5); start spin guess; start velocity guess; }
    joint input: revolute z (ground.A -> first.base) { rigid; }
    joint tilt: revolute x (ground.C -> housing.pivot) { rigid; }
    joint bearing: revolute z (housing -> second.far) { rigid; }
    joint cross: universal y x (first.end -> second.near) { rigid; }
    observe { a: rad = input.angle; tilted: rad = tilt.angle; b: rad = bearing.angle; w: rad/s = bearing.speed;
        u: rad/s = input.speed }
    scenes only; scene Shafts { dependent second; }
}";

/// By the angles of the first shaft and of the housing: first shaft, housing, second shaft.
fn shafts(q: &[Jet]) -> Vec<(Place, Turn)> {
    let (first, housing) = (about(2, q[0]), about(0, q[1]));
    let along = turned(&housing, place([0.0, 0.0, 1.0]));
    let fork = unit(cross(turned(&first, place([0.0, 1.0, 0.0])), along));
    let second = columns(fork, cross(along, fork), along);
    vec![(place([0.0, 0.0, -0.3]), first), (times(along, number(0.5)), housing), (times(along, number(0.4)), second)]
}

#[test]
fn a_universal_joint_turns_a_shaft_as_by_hand() {
    let body = |mass: f64, inertia: [f64; 3]| Body { mass, inertia };
    let hand = Hand {
        bodies: vec![body(2.0, [0.02, 0.02, 0.03]), body(1.5, [0.03, 0.02, 0.01]), body(1.0, [0.01, 0.015, 0.02])],
        coordinates: 2,
        poses: shafts,
        gravity: [0.0, 0.0, 9.81],
        forces: |_, _| vec![0.0; 2],
    };
    let graphs = graphs(SHAFTS);
    let closed = model(&graphs, "Shafts", &[]);
    let names: Vec<&str> = closed.description().states.iter().map(|state| state.name).collect();
    assert_eq!(names.len(), 5, "two freedoms, and the turns of an angle that is read: {names:?}");
    let start = closed.start().unwrap();
    for t_end in [0.5, 5.0] {
        let finish = run(&*closed, &start, t_end);
        let y = outputs(&*closed, finish.t, finish.x.as_slice(), &finish.negative);
        let by_hand = run(&hand, &[0.0, -0.5, 2.0, 0.0], t_end).x;
        let poses = shafts(&[Jet::along(by_hand[0], by_hand[2]), Jet::along(by_hand[1], by_hand[3])]);
        let (housing, second) = (&poses[1].1, &poses[2].1);
        let across = |axis: usize| (0..3).fold(number(0.0), |sum, k| sum + housing[k][axis] * second[k][0]);
        let (cosine, sine) = (across(0), across(1));
        let speed = cosine.value() * sine.slope() - sine.value() * cosine.slope();
        for (y, expected) in [(y[0], by_hand[0]), (y[1], by_hand[1]), (y[3], speed), (y[4], by_hand[2])] {
            assert!((y - expected).abs() < 1e-8, "after {t_end} s: {y}, hand-written {expected}");
        }
        assert!((y[2].cos() - cosine.value()).abs() < 1e-9 && (y[2].sin() - sine.value()).abs() < 1e-9, "{}", y[2]);
        // Both shafts turn as often.
        assert!((y[2] - y[0]).abs() < 0.5 * std::f64::consts::PI, "{} {}", y[2], y[0]);
    }
}
