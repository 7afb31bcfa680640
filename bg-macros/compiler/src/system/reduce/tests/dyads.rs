//! Loops closed in closed form beside the same with all reactions.

use super::{Scene, outputs, scene};

/// A slider-crank whose slide is above the crank's pin.
const SLIDER_CRANK: &str = "param rod: m = 0.5, above 0; gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; \
    point Q = [0, 0.1, 0]; }
    body crank { mass 1; inertia [0.02, 0.02, 0.02]; point O = [-0.1, 0, 0]; point A = [0.1, 0, 0]; \
    start O at [0, 0, 0]; }
    body link { mass 2; inertia [0.1, 0.1, 0.1]; point A = [-rod / 2, 0, 0]; point B = [rod / 2, 0, 0];
        start A at [0.2, 0, 0]; start turned rotation_z(TURN); }
    body block { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.2 + rod * cos(TURN), 0.1, 0]; }
    joint o: revolute z (ground.O -> crank.O) { rigid; }
    joint a: revolute z (crank.A -> link.A) { rigid; }
    joint b: revolute z (link.B -> block) { rigid; }
    joint slide: prismatic x (ground.Q -> block) { rigid; }
    drive motor on o torque = 2 - 0.1 * o.speed;
    observe { x: m = block.position; link: rad = link.direction; e: J = stored_energy; }";

/// The slide's block in front of the crank, or behind it.
fn slider_crank(is_in_front: bool) -> String {
    SLIDER_CRANK.replace("TURN", if is_in_front { "asin(0.1 / rod)" } else { "3.141592653589793 - asin(0.1 / rod)" })
}

/// A crank and a rocker, whose coupler may be above the line of their pins or below it; its pins are off the links'
/// axes, and the ground's are `tilt` off the x axis. `GUESS` stands before what may be guessed.
fn four_bar(crank: f64, is_above: bool, tilt: f64) -> String {
    // The distance of the coupler's pins is 1, the rocker's are 0.8 apart, the ground's 1; the crank starts along
    // these.
    let distance = 1.0 - crank;
    let cosine = 0.5 * (distance + 0.36 / distance);
    let sine = if is_above { 1.0 } else { -1.0 } * f64::sqrt(1.0 - cosine * cosine);
    let [link, rocker] = [f64::atan2(sine, cosine), f64::atan2(sine, crank + cosine - 1.0)].map(|angle| angle + tilt);
    let [x, y] = [tilt.cos(), tilt.sin()];
    let [a, b] = [crank * x, crank * y];
    format!(
        "param torque: N*m = 3; gravity [0, -9.81, 0]; ground {{ point O = [0, 0, 0]; point Q = [{x:?}, {y:?}, 0]; }}
        body crank {{ mass 1; inertia [0.02, 0.02, 0.02]; point O = [-0.1, 0, 0]; point A = [{crank} - 0.1, 0, 0]; \
        start O at [0, 0, 0];
            start turned rotation_z({tilt:?}); }}
        body link {{ mass 2; inertia [0.1, 0.1, 0.1]; point A = [-0.5, 0.1, 0]; point B = [0.5, 0.1, 0];
            start A at [{a:?}, {b:?}, 0]; start turned rotation_z(GUESS({link:?})); }}
        body rocker {{ mass 1.5; inertia [0.1, 0.1, 0.2]; point Q = [-0.3, 0, 0]; point B = [0.5, 0, 0];
            start Q at [{x:?}, {y:?}, 0]; start turned rotation_z(GUESS({rocker:?})); }}
        joint o: revolute z (ground.O -> crank.O) {{ rigid; }}
        joint a: revolute z (crank.A -> link.A) {{ rigid; }}
        joint q: revolute z (ground.Q -> rocker.Q) {{ rigid; }}
        joint b: revolute z (link.B -> rocker.B) {{ rigid; }}
        drive motor on o torque = torque - 0.5 * o.speed;
        observe {{ link: rad = link.direction; rocker: rad = rocker.direction; x: m = link.position; \
        e: J = stored_energy; }}"
    )
}

/// The largest difference of an output to the same with all reactions, over two seconds, in parts of its size.
fn apart(graph: &str, closed: &Scene) -> f64 {
    let all = scene(graph, "all reactions; tune {}").reduced;
    let [all, own] = [&all, &closed.reduced].map(|of| {
        let parameters: Vec<f64> = of.parameters.iter().map(|parameter| parameter.default).collect();
        outputs(of, &parameters, &[])
    });
    (0..all[0].len()).fold(0.0, |most: f64, column| {
        let size = all.iter().fold(1.0_f64, |size, row| size.max(row[column].abs()));
        let apart = all.iter().zip(&own).map(|(a, b)| (a[column] - b[column]).abs()).fold(0.0, super::larger);
        super::larger(most, apart / size)
    })
}

#[test]
fn a_slider_crank_is_left_with_its_crank_on_either_side() {
    for is_in_front in [true, false] {
        let graph = slider_crank(is_in_front);
        let scene = scene(&graph, "tune {}");
        assert_eq!(
            scene.left(),
            ["crank.orientation_11", "crank.orientation_12", "crank.angular.p_z"],
            "{}",
            scene.report
        );
        assert_eq!(scene.words(&["link.orientation_12", "link.angular.p_z"]), ["closed slide", "closed slide"]);
        assert!(scene.reduced.holding.rigid.is_empty() && scene.reduced.assembly.sides.len() == 1);
        assert!(apart(&graph, &scene) < 1e-6, "{:e}", apart(&graph, &scene));
    }
}

#[test]
fn a_crank_and_rocker_are_left_with_the_crank_above_and_below() {
    for (crank, is_above, tilt) in [(0.3, true, 0.0), (0.3, false, 0.0), (0.75, true, 0.8), (0.75, false, -0.5)] {
        let graph = four_bar(crank, is_above, tilt).replace("GUESS", "");
        let scene = scene(&graph, "tune { torque }");
        let left = ["crank.orientation_11", "crank.orientation_12", "crank.angular.p_z"];
        assert_eq!(scene.left(), left, "{}", scene.report);
        assert_eq!(scene.words(&["link.orientation_12", "rocker.angular.p_z"]), ["closed b", "closed b"]);
        // The long crank throws its links about: truncation.
        let bound = if crank < 0.5 { 1e-6 } else { 1e-3 };
        assert!(apart(&graph, &scene) < bound, "{:e}", apart(&graph, &scene));
    }
    let turning = four_bar(0.799, true, 0.0).replace("GUESS", "");
    assert_eq!(scene(&turning, "tune {}").left().len(), 9, "with this crank coupler and rocker are nearly stretched");
}

/// A rod that may be as short as the crank may be perpendicular to the slide: there the block may go either way.
#[test]
fn without_a_proof_loops_are_closed_where_the_scene_says_so() {
    let graph = slider_crank(true).replace("asin(0.1 / rod)", "0").replace("0.1, 0]; }", "0, 0]; }");
    let [left, closed] = ["", "dependent link;"].map(|clause| scene(&graph, &format!("{clause} tune {{ rod }}")));
    assert_eq!([left.left().len(), closed.left().len()], [6, 3]);
    assert!(apart(&graph, &closed) < 1e-6);
    for (rod, states) in [("0.2", 6), ("0.201", 3)] {
        let graph = graph.replace("rod: m = 0.5", &format!("rod: m = {rod}"));
        assert_eq!(scene(&graph, "tune {}").left().len(), states, "a crank of 0.2 m and a rod of {rod} m");
    }
}

/// Ranges of lengths prove what numbers do.
#[test]
fn ranges_of_lengths_prove_that_a_loop_may_be_closed() {
    let slide = SLIDER_CRANK
        .replace("TURN", "guess(0.2)")
        .replace("start at [0.2 + rod * cos(guess(0.2)), ", "start at [guess(0.7), ");
    let rocker = four_bar(0.3, true, 0.0)
        .replace("GUESS", "guess")
        .replace("torque: N*m = 3;", "torque: N*m = 3; param arm: m = 0.8, RANGE;")
        .replace("point B = [0.5, 0, 0];", "point B = [arm - 0.3, 0, 0];");
    for (graph, wide, narrow) in [
        (
            slide,
            ("rod: m = 0.5, above 0", "rod: m = 0.5, above 0"),
            ("rod: m = 0.5, above 0", "rod: m = 0.5, at least 0.35"),
        ),
        (rocker, ("RANGE", "above 0"), ("RANGE", "at least 0.7, at most 0.9")),
    ] {
        let states = [wide, narrow].map(|(from, to)| scene(&graph.replace(from, to), "").left().len());
        assert!(states[0] > states[1] && states[1] == 3, "{states:?}");
    }
}

/// The rod ends 5 mm above its slide, and nothing is guessed: the start is for the run time to refuse, which sees what
/// has a reaction.
#[test]
fn a_loop_that_is_open_at_the_start_keeps_its_reactions() {
    let open = |by: f64| {
        let turn = format!("(asin(0.1 / rod) + {by})");
        let graph = SLIDER_CRANK.replace("0.1, 0]; }\n    joint o", &format!("rod * sin({turn}), 0]; }}\n    joint o"));
        assert_ne!(graph, SLIDER_CRANK);
        scene(&graph.replace("rod: m = 0.5, above 0", "rod: m = 0.5").replace("TURN", &turn), "tune {}")
    };
    let [closed, open] = [0.0, 0.01].map(open);
    assert_eq!(closed.left().len(), 3, "{}", closed.report);
    assert_eq!((open.left().len(), open.reduced.holding.rigid.len()), (6, 1), "{}", open.report);
}
