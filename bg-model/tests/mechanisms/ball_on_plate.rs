//! A ball on a plate, the example `ball_on_plate.bond`, beside hand-written equations of its motion in a plane.

use bg_model::dynamics::{Dynamics, Machine};

use super::hand::run;
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/ball_on_plate.bond");

/// Density, radius, thickness and edge of ball and plate, as there.
const RADIUS: f64 = 0.02;
const HALF: f64 = 0.004;
const EDGE: f64 = 0.3;

fn mass() -> f64 {
    7850.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3)
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// In the plane of x and y: the plate's angle and its rate, the ball's place, velocity and spin.
struct Plane;

impl Plane {
    /// How deep the ball is in the plate, the normal.
    fn depth(x: &[f64]) -> (f64, [f64; 2]) {
        let n = [-x[0].sin(), x[0].cos()];
        (RADIUS + HALF - dot(n, [x[2], x[3]]), n)
    }
}

impl Dynamics for Plane {
    fn states(&self) -> usize {
        7
    }

    fn switches(&self) -> usize {
        1
    }

    fn guards(&self, _: f64, x: &[f64], _: &[bool], guards: &mut [f64]) {
        guards[0] = -Self::depth(x).0;
    }

    fn rate(&self, _: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let (place, velocity) = ([x[2], x[3]], [x[4], x[5]]);
        let (depth, n) = Self::depth(x);
        let along = [n[1], -n[0]];
        let of_plate = |at: [f64; 2]| [-x[1] * at[1], x[1] * at[0]];
        let relative =
            |at: [f64; 2], velocity: [f64; 2]| [velocity[0] - of_plate(at)[0], velocity[1] - of_plate(at)[1]];
        let pressed = if negative[0] { (1e5 * depth - 30.0 * dot(n, relative(place, velocity))).max(0.0) } else { 0.0 };
        let touch = [place[0] - RADIUS * n[0], place[1] - RADIUS * n[1]];
        // The ball's surface there: w x (-R n).
        let surface = [velocity[0] + x[6] * RADIUS * n[1], velocity[1] - x[6] * RADIUS * n[0]];
        let slip = dot(along, relative(touch, surface));
        let rub = -0.3 * pressed * slip / slip.hypot(1e-3);
        let force = [0, 1].map(|k| pressed * n[k] + rub * along[k]);
        let inertia = 2700.0 * EDGE * EDGE * 2.0 * HALF * (EDGE * EDGE + 4.0 * HALF * HALF) / 12.0;
        let torque = 20.0 * (1.2 * place[0] + 0.7 * velocity[0] - x[0].sin()) - 0.8 * x[1];
        let on_plate = torque - pressed * cross(place, n) - rub * cross(touch, along);
        let on_ball = -RADIUS * rub * cross(n, along);
        dx.copy_from_slice(&[
            x[1],
            on_plate / inertia,
            velocity[0],
            velocity[1],
            force[0] / mass(),
            force[1] / mass() - 9.81,
            on_ball / (0.4 * mass() * RADIUS * RADIUS),
        ]);
    }
}

/// The outputs of the example after a time, with these parameters.
fn found(values: &[(&str, f64)], t: f64) -> Vec<f64> {
    let graphs = graphs(TEXT);
    let model = model(&graphs, "BallOnPlate", values);
    let start = model.start().unwrap_or_else(|error| panic!("{error}"));
    let finish = run(&*model, &start, t);
    outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative)
}

#[test]
fn a_ball_on_a_plate_rolls_as_by_hand() {
    let height = HALF + RADIUS - mass() * 9.81 / 1e5;
    for t in [0.3, 1.0] {
        let x = run(&Plane, &[0.0, 0.0, 0.08, height, 0.0, 0.0, 0.0], t).x;
        let still = [("start_z", 0.0), ("start_speed", 0.0)];
        let of_x = found(&still, t);
        // The other way it is the same.
        let of_z = found(&[("start_x", 0.0), ("start_z", 80.0), ("start_speed", 0.0)], t);
        // In mm and degrees.
        let (place, tilt) = (1e3 * x[2], x[0].sin().to_degrees());
        for (found, expected) in [(of_x[0], place), (of_x[3], tilt), (of_z[1], place), (of_z[2], -tilt)] {
            assert!((found - expected).abs() < 1e-6, "{t} s: {found} {expected}");
        }
        assert!(of_x[1].abs() < 1e-12 && of_z[0].abs() < 1e-12);
    }
}

#[test]
fn a_ball_on_a_plate_comes_to_its_middle() {
    let found = found(&[], 8.0);
    assert!(found[0].abs() < 0.1 && found[1].abs() < 0.1, "{found:?}");
    assert!((found[4] - mass() * 9.81).abs() < 1e-3 && found[5] < 1e-5, "{found:?}");
}
