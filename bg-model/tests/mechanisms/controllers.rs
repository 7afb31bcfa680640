//! States of a graph's own: controllers beside closed forms, and states that read reactions beside the literal graph.

use bg_model::dynamics::Machine;

use super::hand::run;
use super::text::{graphs, model, outputs};

/// The outputs of the model of this name after `t_end`.
fn after(text: &str, name: &str, t_end: f64) -> Vec<f64> {
    let model = model(&graphs(text), name, &[]);
    let start = model.start().expect("a start");
    let finish = run(&*model, &start, t_end);
    outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative)
}

/// A flywheel of 0.5 kg*m^2 whose speed is to be 10 rad/s, by kp = 3 and ki = 4, with a torque of at most `most`.
fn speed_control(most: f64) -> String {
    format!(
        "graph Controlled {{
            param wanted: rad/s = 10;
            let wish: N*m = 3 N*m*s/rad * (wanted - shaft.flow) + 4 N*m/rad * missing;
            let torque: N*m = if wish > {most} {{ {most} }} else if wish < -{most} {{ -{most} }} else {{ wish }};
            state missing: rad = if abs(wish) < {most} {{ wanted - shaft.flow }} else {{ 0 }};
            1 shaft: rotation; I wheel = 0.5; MSe motor = torque; motor -> shaft -> wheel;
            observe {{ speed: rad/s = shaft.flow; missing: rad = missing }}
        }}"
    )
}

/// w and the integral of 10 - w, of w' = 2 (3 (10 - w) + 4 e), e' = 10 - w: the roots are -2 and -4.
fn linear(w: f64, e: f64, t: f64) -> [f64; 2] {
    // Of the error d = 10 - w: d' = -6 d - 8 e, e' = d; e = a exp(-2 t) + b exp(-4 t).
    let d = 10.0 - w;
    let (a, b) = ((d + 4.0 * e) / 2.0, -(d + 2.0 * e) / 2.0);
    let (slow, fast) = ((-2.0 * t).exp(), (-4.0 * t).exp());
    [10.0 + 2.0 * a * slow + 4.0 * b * fast, a * slow + b * fast]
}

#[test]
fn a_pi_controller_moves_as_its_closed_form() {
    for t in [0.3, 1.7] {
        let [w, e] = linear(0.0, 0.0, t);
        let found = after(&speed_control(1e6), "Controlled", t);
        assert!((found[0] - w).abs() < 1e-9 && (found[1] - e).abs() < 1e-9, "{found:?} {w} {e}");
    }
}

#[test]
fn a_saturated_one_does_not_wind_up() {
    // 12 N*m accelerate by 24 rad/s^2 until 3 (10 - w) are 12 N*m, at w = 6 rad/s.
    let [w, e] = linear(6.0, 0.0, 2.0 - 0.25);
    let found = after(&speed_control(12.0), "Controlled", 2.0);
    assert!((found[0] - w).abs() < 1e-9 && (found[1] - e).abs() < 1e-9, "{found:?} {w} {e}");
    assert!((after(&speed_control(12.0), "Controlled", 0.2)[0] - 4.8).abs() < 1e-9);
}

#[test]
fn a_start_has_the_states_unit() {
    let text = "graph Clock { param first: deg = 30; 1 shaft: rotation; I wheel = 1 start 2; C spring = 1 N*m/rad; \
        shaft -> wheel; shaft -> spring;
        state angle: deg = shaft.flow start 90; state other: rad = shaft.flow start first;
        observe { angle: deg = angle; other: deg = other; turned: deg = spring.q } }";
    let found = after(text, "Clock", 1.0);
    assert!((found[0] - found[2] - 90.0).abs() < 1e-9 && (found[1] - found[2] - 30.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_state_that_reads_a_reaction_is_the_same_in_every_form() {
    let text = "graph Arm {
        ground { point O = [0, 0, 0]; }
        gravity [0, -9.81, 0];
        body upper { mass 2; inertia [0.01, 0.08, 0.08]; point a = [-0.3, 0, 0]; point b = [0.3, 0, 0]; \
        start a at [0, 0, 0]; }
        body lower { mass 1; inertia [0.01, 0.04, 0.04]; point a = [-0.25, 0, 0]; start a at [0.6, 0, 0]; \
        start spin [0, 0, 3]; start velocity [0, 0.75, 0]; }
        joint shoulder: revolute z (ground.O -> upper.a) { rigid; }
        joint elbow: revolute z (upper.b -> lower.a) { rigid; }
        state felt: N*s = elbow.force.x - 2 / (1 s) * felt;
        drive motor on shoulder torque = 0.3 m/s * felt - 0.1 N*m*s/rad * shoulder.speed;
        observe { x: m = lower.position.x; felt: N*s = felt }
        scene Joints { observe { x: m = lower.position.x; felt: N*s = felt } expect planar; }
        scene Literal { observe { x: m = lower.position.x; felt: N*s = felt } all reactions; }
    }";
    let [joints, literal] = ["Joints", "Literal"].map(|scene| after(text, scene, 0.8));
    assert!(joints[1].abs() > 0.1, "it matters: {joints:?}");
    for (of, to) in joints.iter().zip(&literal) {
        assert!((of - to).abs() < 1e-8, "{joints:?} {literal:?}");
    }
}

/// A mass of 1 kg under the smaller of a ramp and 3 N, and under the larger of another ramp and nothing.
#[test]
fn the_smaller_and_the_larger_of_two_are_branches() {
    let text = "graph Pushed {
        1 one: translation; I m = 1; MSe f = min(2 N/s * t, 3 N); f -> one -> m;
        1 two: translation; I n = 1; MSe g = max(2 N/s * (t - 1 s), 0); g -> two -> n;
        observe { one: m/s = one.flow; two: m/s = two.flow; least: 1 = min(min(3, t / 1 s), 2.5); \
        most: 1 = max(t / 1 s, 2.5) }
    }";
    for (t, least, most) in [(0.9_f64, 0.9, 2.5), (1.4, 1.4, 2.5), (2.0, 2.0, 2.5), (2.7, 2.5, 2.7)] {
        let found = after(text, "Pushed", t);
        let (one, two) = (if t < 1.5 { t * t } else { 2.25 + 3.0 * (t - 1.5) }, (t - 1.0).max(0.0).powi(2));
        let expected = [one, two, least, most];
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-10), "{t}: {found:?}");
    }
}
