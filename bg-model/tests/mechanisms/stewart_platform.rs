//! A Stewart platform, the example `stewart_platform.bond`, beside hand-written equations in place and angles of its
//! plate.

use std::f64::consts::FRAC_PI_3;

use bg_model::dynamics::Machine;

use super::hand::{
    Body, Hand, Jet, Place, Turn, about, columns, cross, dot, minus, place, plus, product, run, times, turned, unit,
};
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/stewart_platform.bond");

/// Where a leg stands, and where it holds the plate, in the plate's axes.
fn ends(leg: usize) -> [[f64; 3]; 2] {
    let (middle, side) = (FRAC_PI_3 * leg as f64, if leg.is_multiple_of(2) { 1.0 } else { -1.0 });
    [(0.6, middle - 0.3 * side), (0.35, middle + 0.2 * side)]
        .map(|(radius, angle)| [radius * angle.cos(), radius * angle.sin(), 0.0])
}

fn plate(q: &[Jet]) -> (Place, Turn) {
    let turn = product(&about(2, q[5]), &product(&about(1, q[4]), &about(0, q[3])));
    ([q[0], q[1], q[2]], turn)
}

/// From a leg's foot to its head.
fn reach(leg: usize, (at, turn): &(Place, Turn)) -> Place {
    let [foot, head] = ends(leg);
    minus(plus(*at, turned(turn, place(head))), place(foot))
}

/// By place and angles of the plate: the plate, then cylinder and rod of each leg.
fn poses(q: &[Jet]) -> Vec<(Place, Turn)> {
    let plate = plate(q);
    let legs = (0..6).flat_map(|leg| {
        let (foot, reach) = (place(ends(leg)[0]), reach(leg, &plate));
        let along = unit(reach);
        let second = unit(cross(along, place([1.0, 0.0, 0.0])));
        let turn = columns(cross(second, along), second, along);
        let cylinder = plus(foot, times(along, Jet::from(0.2)));
        let rod = plus(plus(foot, reach), times(along, Jet::from(-0.2)));
        [(cylinder, turn), (rod, turn)]
    });
    [plate].into_iter().chain(legs).collect()
}

/// Of the springs in the legs.
fn springs(q: &[f64], _: &[f64]) -> Vec<f64> {
    let along = |i: usize| {
        let q: Vec<Jet> = (0..6).map(|k| Jet::along(q[k], f64::from(u8::from(k == i)))).collect();
        let plate = plate(&q);
        let force = |leg: usize| {
            let reach = reach(leg, &plate);
            let length = dot(reach, reach).sqrt();
            -3000.0 * (length.value() - 0.8) * length.slope()
        };
        (0..6).map(force).sum()
    };
    (0..6).map(along).collect()
}

fn hand() -> Hand {
    let plate = Body { mass: 12.0, inertia: [0.4, 0.4, 0.8] };
    let cylinder = Body { mass: 1.5, inertia: [0.03, 0.03, 0.003] };
    let rod = Body { mass: 0.8, inertia: [0.015, 0.015, 0.001] };
    let legs = [cylinder, rod].repeat(6);
    Hand { bodies: [vec![plate], legs].concat(), coordinates: 6, poses, gravity: [0.0, 0.0, -9.81], forces: springs }
}

#[test]
fn the_plate_moves_as_by_hand() {
    let graphs = graphs(TEXT);
    let ideal = model(&graphs, "StewartPlatform", &[]);
    let start = ideal.start().unwrap();
    let finish = run(&*ideal, &start, 0.5);
    let y = outputs(&*ideal, finish.t, finish.x.as_slice(), &finish.negative);
    let by_hand = run(&hand(), &[0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 0.05, 0.0, 0.2, 0.1, 0.0, 0.5], 0.5).x;
    let all: Vec<Jet> =
        by_hand.as_slice()[..6].iter().zip(&by_hand.as_slice()[6..]).map(|(&q, &u)| Jet::along(q, u)).collect();
    let (at, turn) = plate(&all);
    let spin = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 2) % 3, (k + 1) % 3);
        let rate =
            |row: usize, column: usize| (0..3).map(|c| turn[row][c].slope() * turn[column][c].value()).sum::<f64>();
        0.5 * (rate(i, j) - rate(j, i))
    });
    for (found, expected) in y.iter().zip(at.map(Jet::value).iter().chain(&spin)) {
        assert!((found - expected).abs() < 1e-8, "{found}, hand-written {expected}");
    }
}
