//! States that a host sets, saves and restores: checked, with the branches of their switches.

use crate::machines::{Ball, Pendulum};
use bg_fmi::{Exported, Fault, Instance, Interface, Of};
use bg_model::bond_graph;

bond_graph! {
    /// A block that comes to rest on a rough floor, against a pull; beside it a root that has no value at first.
    graph Rubbed {
        input pull: N;
        param least: N = -1;
        1 slide: translation; I block = 2 start 4; Se rope = pull; R rub(v) = 4.5 holds 5;
        rope -> slide -> block; slide -> rub;
        observe { rub.effort; root: 1 = sqrt((pull - least) / least) }
    }

    /// A rod of any size that swings about a pin.
    graph Rod {
        param length: m = 1, above 0;
        gravity [0, -9.81 * length, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass 1; inertia [length * length / 100, length * length / 12, length * length / 12];
            point end = [-length / 2, 0, 0]; start end at [0, 0, 0];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        observe { angle: rad = pin.angle }
    }
}

static PENDULUM: Of<Pendulum> = Of::NEW;
static BALL: Of<Ball> = Of::NEW;
static RUBBED: Of<Rubbed> = Of::NEW;
static ROD: Of<Rod> = Of::NEW;

fn begun(model: &'static dyn Exported, interface: Interface) -> Instance {
    let mut instance = Instance::new(model, interface);
    instance.enter_initialization(0.0, Some(1e-8)).unwrap();
    instance.exit_initialization().unwrap();
    instance
}

fn exchanging(model: &'static dyn Exported) -> (Instance, Vec<f64>) {
    let mut instance = begun(model, Interface::ModelExchange);
    instance.update().unwrap();
    instance.enter_continuous().unwrap();
    let mut x = vec![0.0; instance.state_count()];
    instance.states(&mut x).unwrap();
    (instance, x)
}

fn index(instance: &Instance, name: &str) -> usize {
    instance.description().states.iter().position(|state| state.name == name).unwrap()
}

#[test]
fn states_that_are_no_numbers_or_no_place_are_refused() {
    let (mut instance, x) = exchanging(&PENDULUM);
    let of = |instance: &Instance, name: &str, value: f64| {
        let mut x = x.clone();
        x[index(instance, name)] = value;
        x
    };
    let name = "rod.position_x";
    let fault = instance.set_states(&of(&instance, name, f64::NAN)).unwrap_err();
    assert!(matches!(&fault, Fault::NotFinite { name: own, .. } if own == name), "{fault}");
    // Nothing of it has been taken over.
    let mut now = x.clone();
    instance.states(&mut now).unwrap();
    assert_eq!(now, x);
    let mut zeros = x.clone();
    for (k, state) in instance.description().states.iter().enumerate() {
        if state.name.contains("orientation_") {
            zeros[k] = 0.0;
        }
    }
    instance.set_states(&zeros).unwrap();
    let fault = instance.completed_step().unwrap_err().to_string();
    assert!(fault.contains("the orientation `rod.orientation` is no rotation"), "{fault}");
    let far = of(&instance, name, x[index(&instance, name)] + 0.1);
    instance.set_states(&far).unwrap();
    let fault = instance.completed_step().unwrap_err().to_string();
    assert!(fault.contains("joint `pin` is open by"), "{fault}");
    instance.enter_event().unwrap();
    assert!(instance.update().unwrap_err().to_string().contains("joint `pin` is open by"));
    // What the steps of a host leave is moved back, as before.
    instance.enter_continuous().unwrap();
    let near = of(&instance, name, x[index(&instance, name)] + 1e-6);
    instance.set_states(&near).unwrap();
    assert!(instance.completed_step().unwrap());
    instance.enter_event().unwrap();
    assert!(instance.update().unwrap().states_changed);
}

#[test]
fn a_drift_is_a_part_of_the_machine() {
    for size in [1e-9, 1.0, 1e9] {
        let mut instance = Instance::new(&ROD, Interface::ModelExchange);
        // Its one parameter is the first variable after the time.
        instance.set(&[1], &[size]).unwrap();
        instance.enter_initialization(0.0, Some(1e-8)).unwrap();
        instance.exit_initialization().unwrap();
        instance.update().unwrap();
        instance.enter_continuous().unwrap();
        let mut x = vec![0.0; instance.state_count()];
        instance.states(&mut x).unwrap();
        assert!(!instance.completed_step().unwrap(), "{size}");
        x[index(&instance, "rod.position_x")] += 1e-6 * size;
        instance.set_states(&x).unwrap();
        assert!(instance.completed_step().unwrap(), "{size}");
    }
}

#[test]
fn an_event_that_a_host_has_located_beyond_a_stop_loses_no_energy() {
    let (mut instance, x) = exchanging(&BALL);
    let (place, momentum) = (index(&instance, "floor.way.q"), index(&instance, "ball.p"));
    let mut beyond = x.clone();
    (beyond[place], beyond[momentum]) = (-1e-5, -4.0);
    instance.set_states(&beyond).unwrap();
    instance.enter_event().unwrap();
    assert!(instance.update().unwrap().states_changed);
    let mut after = x.clone();
    instance.states(&mut after).unwrap();
    assert!((-1e-14..=0.0).contains(&after[place]) && (after[momentum] - 2.0).abs() < 1e-12, "{after:?}");
    // The next event finds it leaving.
    instance.update().unwrap();
    instance.states(&mut after).unwrap();
    assert!((after[momentum] - 2.0).abs() < 1e-12, "{after:?}");
    instance.enter_continuous().unwrap();
    beyond[place] = -0.5;
    instance.set_states(&beyond).unwrap();
    instance.enter_event().unwrap();
    let fault = instance.update().unwrap_err().to_string();
    assert!(fault.contains("is passed by 5.00e-1 m"), "{fault}");
}

#[test]
fn what_sticks_does_so_in_a_restored_state() {
    let effort = |instance: &mut Instance| {
        let description = instance.description();
        let first = 1 + description.parameters.len() + description.inputs.len();
        let mut value = [0.0];
        instance.get(&[u32::try_from(first).unwrap()], &mut value).unwrap();
        value[0]
    };
    let pull = u32::try_from(1 + RUBBED_PARAMETERS).unwrap();
    let mut instance = begun(&RUBBED, Interface::CoSimulation);
    instance.set(&[pull], &[-3.0]).unwrap();
    instance.step(0.0, 4.0).unwrap();
    assert!((effort(&mut instance) + 3.0).abs() < 1e-12);
    let saved = instance.save();
    let bytes = instance.serialize(&saved).unwrap();
    let mut other = begun(&RUBBED, Interface::CoSimulation);
    other.restore(&other.deserialize(&bytes).unwrap()).unwrap();
    assert!((effort(&mut other) + 3.0).abs() < 1e-12, "{}", effort(&mut other));
    other.step(4.0, 1.0).unwrap();
    assert!((effort(&mut other) + 3.0).abs() < 1e-12);
    assert_eq!(other.statistics().events, 0);
    // Another pull that is held as well: what sticks does not slide for that.
    instance.set(&[pull], &[4.9]).unwrap();
    instance.step(4.0, 1.0).unwrap();
    assert!((effort(&mut instance) - 4.9).abs() < 1e-12, "{}", effort(&mut instance));
    instance.set(&[pull], &[5.1]).unwrap();
    instance.step(5.0, 1.0).unwrap();
    assert!((effort(&mut instance) - 4.5).abs() < 1e-12, "{}", effort(&mut instance));
}

/// How many parameters `Rubbed` has.
const RUBBED_PARAMETERS: usize = 1;

#[test]
fn an_output_that_cannot_be_calculated_is_an_error_with_its_name() {
    let mut instance = begun(&RUBBED, Interface::CoSimulation);
    let fault = instance.get(&[4], &mut [0.0]).unwrap_err().to_string();
    assert!(fault.starts_with("`root` = `sqrt(") && fault.contains("` is NaN at t = 0.0 s"), "{fault}");
    instance.get(&[3], &mut [0.0]).unwrap();
    instance.set(&[2], &[-2.0]).unwrap();
    instance.get(&[4], &mut [0.0]).unwrap();
}

#[test]
fn a_saved_state_of_another_model_is_refused() {
    let (pendulum, mut ball) = (begun(&PENDULUM, Interface::CoSimulation), begun(&BALL, Interface::CoSimulation));
    let told = "this is no saved state of this model: it is one of another model";
    assert_eq!(ball.restore(&pendulum.save()).unwrap_err().to_string(), told);
    assert_eq!(ball.serialize(&pendulum.save()).unwrap_err().to_string(), told);
    let exchanged = begun(&BALL, Interface::ModelExchange).save();
    assert!(ball.restore(&exchanged).unwrap_err().to_string().ends_with("it is one of the other interface"));
    ball.step(0.0, 0.1).unwrap();
}

#[test]
fn bytes_of_a_state_in_which_the_model_cannot_stand_are_refused() {
    let ball = begun(&BALL, Interface::CoSimulation);
    let text = String::from_utf8(ball.serialize(&ball.save()).unwrap()).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let place = index(&ball, "floor.way.q");
    value["place"]["x"][place] = serde_json::json!(-1.0);
    let Err(fault) = ball.deserialize(value.to_string().as_bytes()) else { panic!("it was taken") };
    assert!(fault.to_string().contains("is passed by 1.00e0 m"), "{fault}");
}

#[test]
fn a_tiny_first_step_does_not_block_the_next() {
    for (first, is_pushed) in [(1e-17, false), (1e-17, true), (1e-300, false), (1e-300, true)] {
        let mut instance = begun(&BALL, Interface::CoSimulation);
        instance.step(0.0, first).unwrap();
        if is_pushed {
            instance.set(&[3], &[0.1]).unwrap();
        }
        instance.step(first, 0.1).unwrap();
        instance.step(0.1, 0.4).unwrap();
        assert!((instance.time().unwrap() - 0.5).abs() < 1e-12);
    }
}

#[test]
fn a_derivative_that_cannot_be_calculated_is_one_neither() {
    let (mut instance, mut x) = exchanging(&PENDULUM);
    let mut rates = x.clone();
    instance.derivatives(&mut rates).unwrap();
    x[index(&instance, "rod.angular.p_z")] = 1e200;
    instance.set_states(&x).unwrap();
    let fault = instance.derivatives(&mut rates).unwrap_err();
    assert!(matches!(&fault, Fault::NoNumber(fault) if fault.name.starts_with("der(")), "{fault}");
}
