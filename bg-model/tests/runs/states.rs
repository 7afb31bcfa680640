//! States from which a run starts: refused where the mechanism cannot stand in them, closed where rounding has left
//! something.

use bg_model::bond_graph;
use bg_model::dynamics::{Machine, branches};
use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{RunError, Simulation, State, StateError, Trajectory};
use bg_model::standing::{Misplaced, Standing};

bond_graph! {
    /// A rod on a rigid hinge.
    graph Hinged {
        param size: m = 1, above 0;
        gravity [0, -9.81 * size, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass 2; inertia [0.1 * size * size, 0.1 * size * size, 0.1 * size * size];
            point end = [-0.5 * size, 0, 0]; start end at [0, 0, 0];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        observe { angle: rad = pin.angle; force: N = norm(pin.force) }
        scene Plane { expect planar; }
    }
    /// The same, its joint drawn together.
    graph Drawn {
        gravity [0, -9.81, 0];
        baumgarte 20;
        ground { point pivot = [0, 0, 0]; }
        body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 0, 0]; }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        observe { angle: rad = pin.angle }
    }
    /// A free body.
    graph Tumbling {
        body rod { mass 2; inertia [0.1, 0.2, 0.3]; start spin [1, 0.1, 2]; }
        observe { w: rad/s = rod.angular_velocity.z }
    }
}

fn hinged(size: f64) -> Hinged {
    Hinged::make(HingedParameters { size }, &[]).unwrap()
}

/// The start of `model` after a while, changed.
fn changed<Me: Mechanism>(model: &Me, change: impl Fn(&str, f64) -> f64) -> State {
    let mut state = Simulation::new(model).every(0.1).until(0.3).run().unwrap().last;
    let all = state.states.clone();
    for (name, value) in all {
        let new = change(&name, value);
        if new.to_bits() != value.to_bits() {
            assert!(state.set(&name, new));
        }
    }
    state
}

fn fault<Me: Mechanism>(model: &Me, state: &State) -> Misplaced {
    let fault = Simulation::new(model).from(state).until(1.0).run().unwrap_err();
    assert!(fault.to_string().starts_with("a run cannot start from this state: "), "{fault}");
    let RunError::State(StateError::Misplaced(fault)) = fault else { panic!("{fault}") };
    fault
}

fn is_orientation(name: &str) -> bool {
    name.contains("orientation_")
}

#[test]
fn an_orientation_that_is_none_is_refused() {
    let (whole, plane, free) = (
        hinged(1.0),
        Plane::make(PlaneParameters { size: 1.0 }, &[]).unwrap(),
        Tumbling::make(TumblingParameters::default(), &[]).unwrap(),
    );
    // Zeros, clearly too long, a little too long.
    for factor in [0.0, 1.025, 1.0 + 1e-8] {
        let change = |name: &str, value: f64| if is_orientation(name) { factor * value } else { value };
        let faults = [
            fault(&whole, &changed(&whole, change)),
            fault(&plane, &changed(&plane, change)),
            fault(&free, &changed(&free, change)),
        ];
        for fault in faults {
            let is_named = matches!(&fault, Misplaced::NoRotation { name, .. } if name == "rod.orientation");
            assert!(is_named, "{factor}: {fault}");
        }
    }
    let mirrored = |name: &str, value: f64| if is_orientation(name) && name.ends_with('3') { -value } else { value };
    assert!(matches!(fault(&free, &changed(&free, mirrored)), Misplaced::NoRotation { .. }));
}

/// At the start the rod is level: there the square of a cosine has the rate 0, and is no product that is kept for that.
#[test]
fn a_run_goes_on_from_an_orientation_of_which_not_all_components_are_states() {
    let plane = Plane::make(PlaneParameters { size: 1.0 }, &[]).unwrap();
    let until = |t_end: f64| Simulation::new(&plane).rtol(1e-10).every(t_end).until(t_end);
    let turned = until(0.7).run().unwrap().last;
    assert!(turned.states.iter().filter(|(name, _)| is_orientation(name)).count() < 4, "{turned:?}");
    let last = |run: Trajectory| *run.column("angle").unwrap().last().unwrap();
    let [once, twice] = [until(1.5), until(1.5).from(&turned)].map(|run| last(run.run().unwrap()));
    assert!((once - twice).abs() < 1e-8, "{once} {twice}");
}

#[test]
fn an_orientation_that_rounding_has_left_is_made_one() {
    let model = hinged(1.0);
    let longer = |name: &str, value: f64| if is_orientation(name) { (1.0 + 1e-11) * value } else { value };
    let start = Simulation::new(&model).from(&changed(&model, longer)).start().unwrap();
    let columns = (1..=3).map(|column| {
        (1..=3).map(|row| start.get(&format!("rod.orientation_{row}{column}")).unwrap().powi(2)).sum::<f64>()
    });
    columns.for_each(|length| assert!((length - 1.0).abs() < 1e-15, "{length}"));
}

/// What is left of the joints' gaps of a model whose orientations are off by a part, where as much is allowed.
fn gaps_left(model: &dyn Machine, stretched: impl Fn(&str) -> f64) -> f64 {
    let mut x = model.start().unwrap();
    for (value, state) in x.iter_mut().zip(model.description().states) {
        *value *= stretched(state.name);
    }
    let closed = Standing::new(model, 0.0, &x, 1e-3).closed(&x, None).unwrap();
    let again = Standing::new(model, 0.0, &x, 1e-3).closed(&closed, None).unwrap();
    // The start is closed: so far have poses gone that nothing holds.
    let mut projected = closed.clone();
    model.project(0.0, &branches(model, 0.0, &closed), &mut projected);
    let off = |of: &[f64]| of.iter().zip(&closed).fold(0.0_f64, |off, (of, closed)| off.max((of - closed).abs()));
    off(&projected).max(off(&again))
}

/// An orientation by 1e-6: a projection alone leaves as much of the gap, and the next one the square.
#[test]
fn an_orientation_that_is_off_leaves_no_gaps() {
    let off = |name: &str| {
        let is_one = ["11", "12", "21"].iter().any(|place| name.ends_with(&format!("orientation_{place}")));
        if is_one { 1.0 + 1e-6 } else { 1.0 }
    };
    let model = hinged(1.0);
    let plane = Plane::make(PlaneParameters { size: 1.0 }, &[]).unwrap();
    assert!(gaps_left(&*model.machine(), off) < 1e-15, "{}", gaps_left(&*model.machine(), off));
    assert!(gaps_left(&*plane.machine(), off) < 1e-15, "{}", gaps_left(&*plane.machine(), off));
}

#[test]
fn a_rigid_joint_that_is_open_or_torn_is_refused_with_its_name() {
    for size in [1e-6, 1.0, 1e6] {
        let model = hinged(size);
        let moved = |by: f64| {
            changed(&model, move |name, value| if name == "rod.position_x" { value + by * size } else { value })
        };
        let error = fault(&model, &moved(1e-6));
        let Misplaced::Open { slip, size: gap, unit, .. } = &error else { panic!("{error}") };
        assert!(slip.joint == "pin" && (gap.abs() - 1e-6 * size).abs() < 1e-9 * size && unit == "m", "{error}");
        assert!(error.to_string().starts_with("joint `pin` is open by "), "{error}");
        let start = Simulation::new(&model).from(&moved(1e-11)).start().unwrap();
        let at = |name: &str| start.get(name).unwrap();
        let gap = at("rod.position_x") - 0.5 * size * at("rod.orientation_11");
        assert!(gap.abs() < 1e-15 * size, "{gap:e}");
    }
    let model = hinged(1.0);
    let pushed = changed(&model, |name, value| if name == "rod.linear.p_x" { value + 1e-3 } else { value });
    let error = fault(&model, &pushed);
    assert!(matches!(&error, Misplaced::Torn { slipping, .. } if slipping.slip.joint == "pin"), "{error}");
}

#[test]
fn a_run_at_any_tolerance_and_of_any_steps_can_go_on() {
    let (whole, drawn) = (hinged(1.0), Drawn::make(DrawnParameters::default(), &[]).unwrap());
    for rtol in [1e-2, 1e-4, 1e-8] {
        let mut run = Simulation::new(&whole).rtol(rtol).every(0.5).until(1.5).run().unwrap();
        run.continue_until(&whole, 2.0).unwrap();
        let mut run = Simulation::new(&drawn).rtol(rtol).every(0.5).until(1.5).run().unwrap();
        run.continue_until(&drawn, 2.0).unwrap();
    }
    for step in [0.05, 0.01] {
        let request =
            bg_model::run::Request { method: Integrator::Rk4, fixed_step: step, t_end: 1.0, ..Default::default() };
        let mut run = Simulation::of(&whole, request).run().unwrap();
        run.continue_until(&whole, 2.0).unwrap();
    }
    let far = changed(&drawn, |name, value| if name == "rod.position_x" { value + 0.1 } else { value });
    assert!(matches!(fault(&drawn, &far), Misplaced::Open { .. }));
}

#[test]
fn a_file_of_another_format_is_refused_with_a_word() {
    let text = Simulation::new(&hinged(1.0)).start().unwrap().to_json().unwrap();
    let mut old: serde_json::Value = serde_json::from_str(&text).unwrap();
    let fields = old.as_object_mut().unwrap();
    for new in ["format", "branches", "largest"] {
        assert!(fields.remove(new).is_some());
    }
    let fault = State::from_json(&old.to_string()).unwrap_err().to_string();
    assert!(fault.starts_with("this state was saved in format 1, which does not say what sticks or rests"), "{fault}");
    let newer = text.replace("\"format\": 2", "\"format\": 3");
    assert!(matches!(State::from_json(&newer), Err(StateError::OtherFormat { found: 3 })));
}
