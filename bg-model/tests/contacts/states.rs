//! What sticks or rests, in states from which a run goes on: it stays so; a state beyond a stop is refused.

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{RunError, Simulation, State, StateError};
use bg_model::standing::Misplaced;

bond_graph! {
    /// A block that comes to rest on a rough floor, against a pull.
    graph Rubbed {
        param pull: N = 3.355;
        1 slide: translation; I block = 2 start 4; MSe rope = pull; R rub(v) = 4.5 holds 5;
        rope -> slide -> block; slide -> rub;
        observe { v: m/s = slide.flow; rub.effort }
    }
    /// A ball and a floor.
    graph Ball {
        param mass: kg = 1, above 0;
        param level: m = 0;
        param speed: m/s = 0;
        param height: m = 1;
        param give: 1 = 0.9;
        param scale: 1 = 1, above 0;
        1 fall: translation; I ball = mass start mass * speed; MSe weight = -9.81 * scale; weight -> fall -> ball;
        stop floor on fall { at least level; start height; restitution give; }
        observe { y: m = floor.place; v: m/s = fall.flow; floor.effort; energy: J = stored_energy }
    }
    /// A ball that falls on one that lies on the floor.
    graph Pair {
        param height: m = 0.4;
        1 low, high: translation; I lower = 1; I upper = 1; Se pull_low = -9.81; Se pull_high = -9.81;
        0 between: translation; 1 apart: translation;
        pull_low -> low -> lower; pull_high -> high -> upper; high -> between -> low; between -> apart;
        stop floor on low { at least 0; start 0; restitution 0.5; }
        stop gap on apart { at least 0; start height; restitution 1; }
        observe { v: m/s = low.flow; u: m/s = high.flow; load: N = floor.effort }
    }
    /// A block on a rigid guide that rests against an end, pressed by a spring.
    graph Guided {
        ground { point O = [0, 0, 0]; }
        body block { mass 2; inertia [0.1, 0.1, 0.1]; start at [0.2, 0, 0]; start velocity [1, 0, 0]; }
        joint guide: prismatic x (ground.O -> block) { rigid; }
        drive press on guide force = 7;
        stop end on guide { at most 0.5; restitution 0.3; }
        observe { x: m = guide.travel; v: m/s = block.velocity.x; end.effort }
    }
}

fn rubbed(pull: f64) -> Rubbed {
    Rubbed::make(RubbedParameters { pull }, &[]).unwrap()
}

fn ball(parameters: BallParameters) -> Ball {
    Ball::make(parameters, &[]).unwrap()
}

fn refused(fault: RunError) -> Misplaced {
    let RunError::State(StateError::Misplaced(fault)) = fault else { panic!("{fault}") };
    fault
}

#[test]
fn what_sticks_goes_on_with_the_force_that_holds_it() {
    let model = rubbed(3.355);
    for method in [Integrator::default(), Integrator::Dop853, Integrator::Radau5] {
        let mut run = Simulation::new(&model).method(method).every(1.0).until(6.0).run().unwrap();
        assert!((run["rub.effort"].last().unwrap() - 3.355).abs() < 1e-12, "{method:?}");
        let branches = run.last.branches.as_deref().unwrap();
        assert_eq!(branches.iter().map(|(_, negative)| *negative).collect::<Vec<_>>(), [false, false], "{branches:?}");
        let saved = State::from_json(&run.last.to_json().unwrap()).unwrap();
        assert_eq!(saved, run.last);
        let on = Simulation::new(&model).method(method).from(&saved).every(0.1).until(7.0).run().unwrap();
        assert!(
            on["rub.effort"].iter().all(|effort| (effort - 3.355).abs() < 1e-12),
            "{method:?}: {:?}",
            &on["rub.effort"]
        );
        assert_eq!(on.statistics.events, 0, "{method:?}");
        run.continue_until(&model, 7.0).unwrap();
        assert!((run["rub.effort"].last().unwrap() - 3.355).abs() < 1e-12, "{method:?}");
    }
}

#[test]
fn what_sticks_is_torn_loose_by_more_than_holds_it() {
    let run = Simulation::new(&rubbed(3.355)).every(1.0).until(6.0).run().unwrap();
    let on = Simulation::new(&rubbed(5.5)).from(&run.last).every(0.5).until(7.0).run().unwrap();
    // (5.5 - 4.5) / 2 m/s^2.
    assert!(on["rub.effort"].iter().all(|effort| (effort - 4.5).abs() < 1e-12), "{:?}", &on["rub.effort"]);
    assert!((on["v"].last().unwrap() - 0.5).abs() < 1e-9);
}

#[test]
fn what_slides_in_a_state_that_was_changed_is_found() {
    let model = rubbed(3.355);
    let run = Simulation::new(&model).every(1.0).until(6.0).run().unwrap();
    // By `set` the branches are not known any more; where a program writes them anyway they cannot be.
    for keeps_branches in [false, true] {
        for (momentum, effort) in [(2.0, 4.5), (-2.0, -4.5)] {
            let mut state = run.last.clone();
            assert!(state.set("block.p", momentum) && state.branches.is_none());
            if keeps_branches {
                state.branches.clone_from(&run.last.branches);
            }
            let on = Simulation::new(&model).from(&state).every(0.1).until(6.1).run().unwrap();
            assert!((on["rub.effort"][0] - effort).abs() < 1e-12, "{:?}", &on["rub.effort"]);
        }
    }
}

#[test]
fn what_rests_on_a_stop_goes_on_with_its_load() {
    let fallen = BallParameters { give: 0.0, ..BallParameters::default() };
    // Thrown up from the floor: in the end neither its place nor its speed are of any size.
    let thrown = |speed| BallParameters { speed, height: 0.0, ..fallen.clone() };
    for parameters in [0.7, 1.1, 1.3, 1.7, 1.9, 2.3, 2.9, 3.1].map(thrown).into_iter().chain([fallen.clone()]) {
        let model = ball(parameters);
        let run = Simulation::new(&model).every(0.1).until(2.0).run().unwrap();
        assert!((run["floor.effort"].last().unwrap().abs() - 9.81).abs() < 1e-12);
        let on = Simulation::new(&model).from(&run.last).every(0.1).until(3.0).run().unwrap();
        assert!(on["floor.effort"].iter().all(|load| (load.abs() - 9.81).abs() < 1e-12), "{:?}", &on["floor.effort"]);
        assert_eq!(on.statistics.events, 0);
    }
    let model = Guided::make(GuidedParameters::default(), &[]).unwrap();
    let run = Simulation::new(&model).every(0.5).until(4.0).run().unwrap();
    let on = Simulation::new(&model).from(&run.last).every(0.1).until(5.0).run().unwrap();
    assert!(on["end.effort"].iter().all(|load| (load.abs() - 7.0).abs() < 1e-9), "{:?}", &on["end.effort"]);
    assert!((on["x"].last().unwrap() - 0.5).abs() < 1e-12);
}

#[test]
fn what_rests_takes_part_in_an_impact_at_the_start() {
    let model = Pair::make(PairParameters::default(), &[]).unwrap();
    let resting = Simulation::new(&model).every(0.1).until(0.2).run().unwrap().last;
    for place in [0.0, -1e-12, 1e-12] {
        let mut state = resting.clone();
        assert!(state.set("floor.way.q", place) && state.set("gap.way.q", 0.0) && state.set("upper.p", -3.0));
        state.branches.clone_from(&resting.branches);
        let run = Simulation::new(&model).from(&state).every(0.01).until(0.3).run().unwrap();
        // The floor bears the lower one, which does not move, and the upper one bounces off as from a wall.
        let (v, u) = (run["v"][0], run["u"][0]);
        assert!(v.abs() < 1e-12 && (u - 3.0).abs() < 1e-12, "{place}: {v} {u}");
    }
}

#[test]
fn a_state_beyond_a_stop_is_refused_with_its_name_and_by_how_much() {
    let model = ball(BallParameters::default());
    let state = |y: f64, v: f64| {
        let mut state = Simulation::new(&model).start().unwrap();
        assert!(state.set("floor.way.q", y) && state.set("ball.p", v));
        state
    };
    for beyond in [1.0, 2e-7, 2e-9] {
        let fault = Simulation::new(&model).from(&state(-beyond, 0.0)).until(1.0).run().unwrap_err();
        let text = fault.to_string();
        let Misplaced::Beyond { stop, by, .. } = refused(fault) else { panic!("{text}") };
        assert!(stop.starts_with("floor") && (by - beyond).abs() < 1e-15, "{text}");
        assert!(text.contains("is passed by") && text.contains(" m "), "{text}");
    }
    // What rounding may leave is closed: it flies up and comes back with all of its energy, and leaves with 0.81 of it.
    let run = Simulation::new(&model).from(&state(-4e-10, 1.3)).rtol(1e-10).every(0.01).until(0.4).run().unwrap();
    assert!((-1e-14..=0.0).contains(&run["y"][0]), "{:?}", run["y"][0]);
    let top = run["y"].iter().fold(0.0_f64, |top, y| top.max(*y));
    assert!((top - 0.5 * 1.3 * 1.3 / 9.81).abs() < 1e-3, "{top}");
    assert!((run["v"].last().unwrap() - (0.9 * 1.3 - 9.81 * (0.4 - 2.6 / 9.81))).abs() < 1e-8);
    // One metre up and further down than that.
    let fallen = Simulation::new(&model).every(0.1).until(0.2).run().unwrap();
    let raised = ball(BallParameters { level: 0.9, ..BallParameters::default() });
    let fault = Simulation::new(&raised).from(&fallen.last).until(1.0).run().unwrap_err();
    assert!(matches!(refused(fault), Misplaced::Beyond { by,
            .. } if (by - (0.9 - fallen["y"].last().unwrap())).abs() < 1e-12));
    let mut fallen = fallen;
    assert!(matches!(refused(fallen.continue_until(&raised, 1.0).unwrap_err()), Misplaced::Beyond { .. }));
}

#[test]
fn what_counts_as_beyond_a_stop_is_a_part_of_the_machine() {
    for size in [1e-6, 1.0, 1e6] {
        let model = ball(BallParameters { height: size, scale: size, ..BallParameters::default() });
        let state = |y: f64| {
            let mut state = Simulation::new(&model).start().unwrap();
            assert!(state.set("floor.way.q", y * size));
            state
        };
        assert!(Simulation::new(&model).from(&state(-1e-8)).until(1.0).run().is_err(), "{size}");
        assert!(Simulation::new(&model).from(&state(-5e-10)).until(1.0).run().is_ok(), "{size}");
    }
}

#[test]
fn a_place_beyond_the_end_of_a_guide_is_closed_with_the_joint() {
    let model = Guided::make(GuidedParameters::default(), &[]).unwrap();
    let state = |x: f64| {
        let mut state = Simulation::new(&model).start().unwrap();
        let name = state.states.iter().map(|(name, _)| name.clone()).find(|name| name.ends_with("position_x")).unwrap();
        assert!(state.set(&name, x));
        state
    };
    let fault = refused(Simulation::new(&model).from(&state(0.5001)).until(1.0).run().unwrap_err());
    assert!(matches!(fault, Misplaced::Beyond { by, .. } if (by - 1e-4).abs() < 1e-12), "{fault}");
    let run = Simulation::new(&model).from(&state(0.5 + 1e-10)).every(0.1).until(1.0).run().unwrap();
    assert!((0.5..0.5 + 1e-14).contains(&run["x"][0]), "{:?}", run["x"][0]);
}
