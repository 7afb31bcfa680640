//! A double wishbone, the example `double_wishbone.bond`, beside hand-written equations in the angle of the lower arm.

use bg_model::dynamics::Machine;

use super::hand::{
    Body, Hand, Jet, Place, Turn, about, columns, cross, dot, minus, place, plus, product, run, times, transposed,
    turned, unit,
};
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/double_wishbone.bond");

const LOWER: [f64; 3] = [0.0, 0.35, 0.2];
const UPPER: [f64; 3] = [0.0, 0.42, 0.5];
const RACK: [f64; 3] = [0.12, 0.36, 0.25];
const TOWER: [f64; 3] = [0.0, 0.45, 0.65];
const WHEEL: [f64; 3] = [0.0, 0.75, 0.33];
const LOW: [f64; 3] = [0.0, -0.05, -0.15];
const HIGH: [f64; 3] = [-0.01, -0.09, 0.15];
const STEER: [f64; 3] = [0.13, -0.07, -0.07];

fn number(value: f64) -> Jet {
    Jet::from(value)
}

/// The point at these distances' squares from three points, on the side of their right-handed normal.
fn trilaterated([a, b, c]: [Place; 3], [to_a, to_b, to_c]: [f64; 3]) -> Place {
    let x = unit(minus(b, a));
    let far = dot(minus(c, a), x);
    let y = unit(minus(minus(c, a), times(x, far)));
    let (width, high) = (dot(minus(b, a), x), dot(minus(c, a), y));
    let along = (number(to_a - to_b) + width * width) * (number(2.0) * width).inverse();
    let up =
        (number(to_a - to_c) + far * far + high * high - number(2.0) * far * along) * (number(2.0) * high).inverse();
    let out = (number(to_a) - along * along - up * up).sqrt();
    plus(a, plus(plus(times(x, along), times(y, up)), times(cross(x, y), out)))
}

/// Axes along two points and across a third one.
fn axes(a: Place, b: Place, c: Place) -> Turn {
    let x = unit(minus(b, a));
    let z = unit(cross(x, minus(c, a)));
    columns(x, cross(z, x), z)
}

fn square(of: [f64; 3]) -> f64 {
    of.iter().map(|part| part * part).sum()
}

fn apart(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| b[k] - a[k])
}

fn lower(q: &[Jet]) -> (Place, Turn) {
    let turn = about(0, q[0]);
    (plus(place(LOWER), turned(&turn, place([0.0, 0.175, -0.01]))), turn)
}

/// By the angle of the lower arm: both arms, the upright, the rod.
fn poses(q: &[Jet]) -> Vec<(Place, Turn)> {
    let lower = lower(q);
    let low = plus(lower.0, turned(&lower.1, place([0.0, 0.175, -0.01])));
    // The upper ball moves on a circle about x: reach (cos b, sin b) at a distance from the lower ball.
    let (reach, away) = ([0.24, -0.02], square(apart(LOW, HIGH)));
    let [y, z] = [1, 2].map(|k| low[k] - number(UPPER[k]));
    let radius = reach[0] * reach[0] + reach[1] * reach[1];
    let across = low[0] - number(-0.01);
    let needed = (number(radius - away) + y * y + z * z + across * across) * number(0.5);
    let size = y * y + z * z;
    let beside = (number(radius) * size - needed * needed).sqrt();
    let ball = [number(-0.01), (y * needed - z * beside) * size.inverse(), (z * needed + y * beside) * size.inverse()];
    let high = [ball[0], ball[1] + number(UPPER[1]), ball[2] + number(UPPER[2])];
    let scale = number(1.0 / radius);
    let (cos, sin) = (
        (ball[1] * number(reach[0]) + ball[2] * number(reach[1])) * scale,
        (ball[2] * number(reach[0]) - ball[1] * number(reach[1])) * scale,
    );
    let swing = super::hand::about_by(0, [cos, sin]);
    let upper = (plus(place(UPPER), turned(&swing, place([-0.005, 0.12, -0.01]))), swing);
    let steer = trilaterated([low, high, place(RACK)], [square(apart(LOW, STEER)), square(apart(HIGH, STEER)), 0.1026]);
    let turn = product(&axes(low, high, steer), &transposed(&axes(place(LOW), place(HIGH), place(STEER))));
    let wheel = (minus(low, turned(&turn, place(LOW))), turn);
    let along = unit(minus(steer, place(RACK)));
    let level = unit(cross(place([0.0, 0.0, 1.0]), along));
    let rod = (plus(place(RACK), times(along, number(0.16))), columns(along, level, cross(along, level)));
    vec![lower, upper, wheel, rod]
}

/// Of strut and tyre, along the angle.
fn springs(q: &[f64], _: &[f64]) -> Vec<f64> {
    let all = poses(&[Jet::along(q[0], 1.0)]);
    let (centre, turn) = &all[0];
    let strut = minus(plus(*centre, turned(turn, place([0.0, 0.05, 0.02]))), place(TOWER));
    let tyre = minus(all[2].0, place([0.0, 0.75, 0.0]));
    let force = |along: Place, stiffness: f64, free: f64| {
        let length = dot(along, along).sqrt();
        -stiffness * (length.value() - free) * length.slope()
    };
    vec![force(strut, 25000.0, 0.5) + force(tyre, 150_000.0, 0.34)]
}

fn hand() -> Hand {
    let body = |mass: f64, inertia: [f64; 3]| Body { mass, inertia };
    Hand {
        bodies: vec![
            body(3.0, [0.03, 0.01, 0.03]),
            body(2.0, [0.015, 0.005, 0.015]),
            body(22.0, [0.5, 0.8, 0.5]),
            body(0.6, [1e-4, 0.006, 0.006]),
        ],
        coordinates: 1,
        poses,
        gravity: [0.0, 0.0, -9.81],
        forces: springs,
    }
}

fn moves_as_by_hand(text: &str, states: usize) {
    let at_start = poses(&[number(0.0)])[2].0.map(Jet::value);
    assert!(square(apart(at_start, WHEEL)) < 1e-6, "{at_start:?}");
    let graphs = graphs(text);
    let ideal = model(&graphs, "DoubleWishbone", &[]);
    assert_eq!(ideal.description().states.len(), states);
    let start = ideal.start().unwrap();
    for t_end in [0.15, 1.0] {
        let finish = run(&*ideal, &start, t_end);
        let y = outputs(&*ideal, finish.t, finish.x.as_slice(), &finish.negative);
        let by_hand = run(&hand(), &[0.0, 0.0], t_end).x;
        let (wheel, turn) = poses(&[number(by_hand[0])])[2];
        for k in 0..3 {
            assert!((y[k] - wheel[k].value()).abs() < 1e-8, "{} m, hand-written {} m", y[k], wheel[k].value());
        }
        let steered = (-turn[0][1].value()).atan2(turn[1][1].value());
        assert!((y[3] - steered).abs() < 1e-8, "{} rad, hand-written {steered} rad", y[3]);
    }
}

/// The upper arm may turn all the way round: bounds show that the lower one follows. The rod keeps its rows.
#[test]
fn the_wheel_moves_as_by_hand() {
    moves_as_by_hand(TEXT, 8);
}

#[test]
fn the_wheel_moves_as_by_hand_where_the_scene_says_what_follows() {
    let dependent = "scene DoubleWishbone { dependent { upper, upright, rod } }";
    moves_as_by_hand(&TEXT.replace("scene DoubleWishbone {}", dependent), 2);
}
