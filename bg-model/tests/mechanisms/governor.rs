//! A Watt governor, the example `governor.bond`, beside hand-written equations in two coordinates.

use bg_model::dynamics::Machine;
use bg_model::simulation::Finish;

use super::hand::{Body, Hand, Jet, Place, Turn, about, about_by, place, plus, product, run, turned};
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/governor.bond");

const OFFSET: f64 = 0.03;
const KNEE: f64 = 0.2;
const ARM: f64 = 0.3;
const LINK: f64 = 0.22;

/// The turning of the spindle and the angle of the arms: spindle, sleeve, both arms, both links.
fn poses(q: &[Jet]) -> Vec<(Place, Turn)> {
    let (spindle, number) = (about(2, q[0]), |value: f64| Jet::from(value));
    let side = |side: f64| -> [(Place, Turn); 2] {
        let swing = about(0, number(side) * q[1]);
        let hip = place([0.0, side * OFFSET, 0.0]);
        let arm = plus(hip, turned(&swing, place([0.0, 0.0, -0.8 * ARM])));
        let knee = plus(hip, turned(&swing, place([0.0, 0.0, -KNEE])));
        let sine = number(-side * KNEE / LINK) * q[1].sin();
        let lean = about_by(0, [(number(1.0) - sine * sine).sqrt(), sine]);
        let link = plus(knee, turned(&lean, place([0.0, 0.0, -0.5 * LINK])));
        [(arm, swing), (link, lean)].map(|(at, turn)| (turned(&spindle, at), product(&spindle, &turn)))
    };
    let ([right_arm, right_link], [left_arm, left_link]) = (side(1.0), side(-1.0));
    let sleeve = (place([0.0; 3]), spindle);
    let low = height(q);
    let [x, y, _] = sleeve.0;
    vec![(place([0.0; 3]), spindle), ([x, y, low], spindle), right_arm, left_arm, right_link, left_link]
}

/// Of the sleeve.
fn height(q: &[Jet]) -> Jet {
    let sine = Jet::from(KNEE / LINK) * q[1].sin();
    -Jet::from(KNEE) * q[1].cos() - Jet::from(LINK) * (Jet::from(1.0) - sine * sine).sqrt()
}

fn hand() -> Hand {
    let arm = Body { mass: 1.2, inertia: [0.012, 0.011, 0.002] };
    let link = Body { mass: 0.2, inertia: [8e-4, 8e-4, 1e-5] };
    let spindle = Body { mass: 3.0, inertia: [0.05, 0.05, 0.02] };
    let sleeve = Body { mass: 1.5, inertia: [0.002, 0.002, 0.003] };
    Hand {
        bodies: vec![spindle, sleeve, arm, arm, link, link],
        coordinates: 2,
        poses,
        gravity: [0.0, 0.0, -9.81],
        forces: |_, _| vec![0.0; 2],
    }
}

fn moves_as_by_hand(text: &str, states: usize) {
    let graphs = graphs(text);
    let governor = model(&graphs, "Governor", &[]);
    assert_eq!(governor.description().states.len(), states);
    let start = governor.start().unwrap();
    let at_start = outputs(&*governor, 0.0, &start, &[]);
    for t_end in [0.3, 2.0] {
        let Finish { t, x, negative, .. } = run(&*governor, &start, t_end);
        let y = outputs(&*governor, t, x.as_slice(), &negative);
        let by_hand = run(&hand(), &[0.0, 0.6, 12.0, 0.0], t_end).x;
        let lift = height(&[Jet::from(by_hand[0]), Jet::from(by_hand[1])]).value();
        assert!((y[0] - lift).abs() < 1e-9, "{} m, hand-written {lift} m", y[0]);
        assert!((y[1] - by_hand[2]).abs() < 1e-8, "{} rad/s, hand-written {} rad/s", y[1], by_hand[2]);
        assert!((y[0] - at_start[0]).abs() > 1e-3, "it moves");
    }
}

#[test]
fn the_sleeve_moves_as_by_hand() {
    moves_as_by_hand(TEXT, 12);
}

/// Where the arms hang down they could swing to either side: no bounds show that they do not.
#[test]
fn the_sleeve_moves_as_by_hand_where_the_scene_says_what_follows() {
    let dependent = "scene Governor { dependent { right_link, left_arm, left_link } }";
    moves_as_by_hand(&TEXT.replace("scene Governor {}", dependent), 4);
}

/// The lengths are numbers where nothing is tuned: bounds show that one loop is closed by a root, the other one keeps
/// its rows.
#[test]
fn the_sleeve_moves_as_by_hand_where_one_loop_is_proved() {
    moves_as_by_hand(&TEXT.replace("scene Governor {}", "scene Governor { tune {} }"), 8);
}
