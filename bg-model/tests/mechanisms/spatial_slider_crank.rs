//! A slider-crank in space, the example `spatial_slider_crank.bond`, beside hand-written equations in the crank's
//! angle.

use bg_model::dynamics::Machine;

use super::hand::{Body, Hand, Jet, Place, Turn, about, columns, cross, minus, place, plus, run, times, turned, unit};
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/spatial_slider_crank.bond");

/// By the crank's angle: crank, slider, rod.
fn poses(q: &[Jet]) -> Vec<(Place, Turn)> {
    let turn = about(0, q[0]);
    let bearing = place([0.0, 0.1, 0.12]);
    let middle = plus(bearing, turned(&turn, place([0.0, 0.0, 0.04])));
    let pin = plus(bearing, turned(&turn, place([0.0, 0.0, 0.08])));
    let reach = (Jet::from(0.09) - pin[1] * pin[1] - pin[2] * pin[2]).sqrt();
    let slider = [reach, Jet::from(0.0), Jet::from(0.0)];
    let along = unit(minus(pin, slider));
    let third = unit(cross(along, place([0.0, 1.0, 0.0])));
    let rod = columns(along, cross(third, along), third);
    let upright = about(0, Jet::from(0.0));
    vec![(middle, turn), (slider, upright), (plus(slider, times(along, Jet::from(0.15))), rod)]
}

fn hand() -> Hand {
    let body = |mass: f64, inertia: [f64; 3]| Body { mass, inertia };
    Hand {
        bodies: vec![body(0.12, [1e-4, 1e-4, 1e-5]), body(2.0, [1e-4; 3]), body(0.5, [4e-4, 4e-3, 4e-3])],
        coordinates: 1,
        poses,
        gravity: [0.0, 0.0, -9.81],
        forces: |_, _| vec![0.0],
    }
}

#[test]
fn the_slider_moves_as_by_hand() {
    let graphs = graphs(TEXT);
    let ideal = model(&graphs, "SpatialSliderCrank", &[]);
    assert_eq!(ideal.description().states.len(), 2, "the crank's angle and its speed");
    let start = ideal.start().unwrap();
    let at_start = outputs(&*ideal, 0.0, &start, &[]);
    assert!((at_start[2] - 6.0).abs() < 1e-12);
    for t_end in [0.4, 3.0] {
        let finish = run(&*ideal, &start, t_end);
        let y = outputs(&*ideal, finish.t, finish.x.as_slice(), &finish.negative);
        let by_hand = run(&hand(), &[0.0, 6.0], t_end).x;
        let x = poses(&[Jet::from(by_hand[0])])[1].0[0].value();
        assert!((y[0] - x).abs() < 1e-9, "{} m, hand-written {x} m", y[0]);
        assert!((y[2] - by_hand[1]).abs() < 1e-7, "{} rad/s, hand-written {} rad/s", y[2], by_hand[1]);
    }
}
