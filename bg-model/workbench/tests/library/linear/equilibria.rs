//! Where mechanisms are in equilibrium, and where there is none.

use bg_workbench::linear::{LinearError, equilibrium, linearise};

use super::models::*;
use super::{at_rest, model, naturals, near, start};

#[test]
fn a_rod_is_found_hanging_wherever_it_starts() {
    for angle in [-1.5, -0.3, 0.0, 0.5, 1.5, 3.0] {
        for stiffness in [1e4, 1e6, 1e8] {
            let rod = model::<SwingAngle>(&[("angle", angle), ("stiffness", stiffness)], &[]);
            let (rest, linear) = at_rest(&rod);
            let y = linear.point.iter().find(|state| state.name == "rod.position_y").unwrap();
            near(y.value, 1.0 - 0.3 - 2.0 * 9.81 / stiffness, 1e-14);
            assert!(rest.steps < 300 && rest.turning.is_empty(), "{angle} {stiffness}: {} steps", rest.steps);
            // Pins give a little: the swing is slower by less than their part of the stiffness.
            near(naturals(&linear)[0], (3.0 * 9.81 / 1.2_f64).sqrt(), 200.0 / stiffness + 1e-7);
        }
    }
}

#[test]
fn a_rod_that_stands_stays_and_would_fall() {
    let (rest, linear) = at_rest::<Ideal>(&model(&[("angle", std::f64::consts::FRAC_PI_2)], &[]));
    assert_eq!(rest.steps, 0);
    assert_eq!(linear.modes.len(), 2);
    near(linear.modes[0].real.abs(), (3.0 * 9.81 / 1.2_f64).sqrt(), 1e-12);
    near(linear.modes[0].real + linear.modes[1].real + 1.0, 1.0, 1e-12);
    near(linear.modes.iter().map(|mode| mode.damping.unwrap()).fold(1.0, f64::min), -1.0, 1e-15);
}

#[test]
fn a_rod_that_nearly_stands_falls() {
    for off in [1e-3, -0.01] {
        let rod = model::<Ideal>(&[("angle", std::f64::consts::FRAC_PI_2 + off)], &[]);
        near(at_rest(&rod).1.modes[0].imaginary, (3.0 * 9.81 / 1.2_f64).sqrt(), 1e-12);
    }
}

#[test]
fn a_slider_crank_comes_to_rest_with_its_crank_down() {
    let (_, with_all) = at_rest::<CrankWithAll>(&model(&[], &[]));
    let value = |name: &str| with_all.point.iter().find(|state| state.name == name).unwrap().value;
    near(value("slider.position_x"), (0.09_f64 - 0.01).sqrt(), 1e-12);
    let (_, linear) = at_rest::<CrankIdeal>(&model(&[], &[]));
    near(with_all.modes[0].imaginary, linear.modes[0].imaginary, 1e-10);
    // Crank, rod and slider move as one: half the rod's weight lifts, all masses move along x.
    let (stiffness, inertia) = (0.5 * 0.5 * 9.81 * 0.1, 2e-3 + (0.5 + 0.8) * 0.01);
    near(linear.modes[0].imaginary, f64::sqrt(stiffness / inertia), 1e-10);
    assert_eq!(linear.modes.len(), 1);
    // Under a load on the slider the crank leans until the moments balance.
    let (_, loaded) = at_rest::<CrankIdeal>(&model(&[("load", 4.0)], &[]));
    let value = |name: &str| loaded.point.iter().find(|state| state.name == name).unwrap().value;
    let (cos, sin) = (value("crank.orientation_11"), -value("crank.orientation_12"));
    let slope = -0.1 * sin - 0.01 * sin * cos / (0.09_f64 - 0.01 * sin * sin).sqrt();
    let moment = 4.0 * slope - 0.5 * 9.81 * 0.05 * cos;
    assert!(moment.abs() < 1e-9 && cos.abs() > 0.5, "{moment} {cos}");
}

#[test]
fn springs_that_are_states_fit_the_poses_in_space() {
    let (_, linear) = at_rest::<Tilted>(&model(&[], &[]));
    assert_eq!(linear.left_out.dependent.len(), 2);
    assert_eq!(linear.modes.len(), 6);
    assert!(linear.modes.iter().all(|mode| mode.real < 0.0 && mode.imaginary > 0.0));
    let value = |name: &str| linear.point.iter().find(|state| state.name == name).unwrap().value;
    let mut square = 0.0;
    for row in 1..=3 {
        for column in 1..=3 {
            square += value(&format!("rod.orientation_{row}{column}")).powi(2);
        }
    }
    near(square, 3.0, 1e-14);
    assert!(linear.point.iter().all(|state| state.rate.abs() < 1e-8), "{:?}", linear.point);
}

#[test]
fn a_twist_that_is_a_state_is_the_turn_of_its_rod() {
    let (rest, linear) = at_rest::<Twisted>(&model(&[], &[]));
    let value = |name: &str| linear.point.iter().find(|state| state.name == name).unwrap().value;
    let (twist, cos) = (value("twist.q"), value("rod.orientation_11"));
    let angle = value("rod.orientation_21").atan2(cos);
    near(twist, angle - 0.4, 1e-9);
    near(9.0 * twist, -2.0 * 9.81 * 0.3 * cos, 1e-9);
    assert_eq!(linear.left_out.dependent, ["twist.q", "rod.angle"]);
    assert!(rest.sentence().starts_with("equilibrium after "), "{}", rest.sentence());
}

#[test]
fn a_machine_of_any_size_is_found_at_rest_from_its_origin_too() {
    for size in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
        for at in [0.0, 1e-17, 0.3, 0.45] {
            let (rest, linear) = at_rest::<Plates>(&model(&[("size", size), ("at", at)], &[]));
            assert!(rest.steps < 100, "{} steps at {size} m from {at}", rest.steps);
            // Of the roots of way (1 - way)^2 = 0.12 the smallest is the stable one.
            let way = linear.point.iter().find(|state| state.name == "plate.position_x").unwrap().value / size;
            near(way * (1.0 - way).powi(2), 0.12, 1e-12);
            assert!(way < 1.0 / 3.0, "{way} at {size} m from {at}");
        }
    }
}

#[test]
fn a_shaft_and_a_wheel_held_by_a_gear_share_the_torque() {
    let (_, linear) = at_rest::<Geared>(&model(&[], &[]));
    let value = |name: &str| linear.point.iter().find(|state| state.name == name).unwrap().value;
    // The wheel turns twice as far as the shaft from where both start: 4 = 20 q + 2 * 7 * 2 (q - 0.3).
    near(value("s1.q"), 12.4 / 48.0, 1e-13);
    near(value("s2.q"), 2.0 * (12.4 / 48.0 - 0.3), 1e-12);
    assert_eq!(linear.modes.len(), 1);
    near(linear.modes[0].natural, f64::sqrt(48.0 / 2.1), 1e-13);
    near(linear.modes[0].real, -0.1 * 4.0 / (2.0 * 2.1), 1e-12);
}

#[test]
fn a_steady_motion_is_found_where_there_is_no_rest() {
    // A spring draws a mass through oil at the speed of its end: no pose is stored.
    let (rest, linear) = at_rest::<Drawn>(&model(&[], &[0.3]));
    assert_eq!(rest.turning, []);
    near(linear.point[1].value, 2.0 * 0.3, 1e-13);
    near(linear.point[0].value, 16.0 * 0.3 / 80.0, 1e-13);
    // A motor turns a disc whose angle is stored, and nothing depends on it.
    let (rest, linear) = at_rest::<Turntable>(&model(&[], &[12.0]));
    let [(name, speed)] = &rest.turning[..] else { panic!("{:?}", rest.turning) };
    assert_eq!(name, "disc.rotation_z");
    near(*speed, 0.2 * 12.0 / (2.0 * 0.01 + 0.2 * 0.2), 1e-9);
    assert!(rest.sentence().ends_with("`disc.rotation_z` goes on by 40 per s"), "{}", rest.sentence());
    near(linear.c[(1, super::place(&linear.states, "disc.angular.p_z"))], 50.0, 1e-12);
}

#[test]
fn what_falls_or_is_driven_has_no_equilibrium() {
    let falling = model::<Falling>(&[], &[]);
    let error = equilibrium(&falling, 0.0, &start(&falling)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no equilibrium near the start: `stone.linear.p_y` still changes by -1.9620e1 N where the search \
         ended; hold it by a joint, a spring or an opposite force, or start from another pose"
    );
    // What only a source changes, and nothing else feels, may go on; what others feel may not.
    let filled = model::<Filled>(&[], &[]);
    let filling = equilibrium(&filled, 0.0, &start(&filled)).unwrap();
    assert_eq!(filling.turning, [("tank.q".to_owned(), 2e-4)]);
    let overflowing = model::<Overflowing>(&[], &[]);
    let error = equilibrium(&overflowing, 0.0, &start(&overflowing)).unwrap_err();
    let LinearError::NoEquilibrium { what, rate, unit, .. } = &error else { panic!("{error}") };
    assert_eq!((what.as_str(), unit.as_str(), *rate), ("tank.q", "m^3/s", 2e-4));
}

#[test]
fn a_root_without_a_slope_is_named() {
    let sharp = model::<Sharp>(&[], &[]);
    let error = linearise(&sharp, 0.0, &start(&sharp)).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with("the rate of `tank.q` has no finite derivative by state `tank.q` at t = 0.0 s"), "{text}");
    // An output without one is no reason to stop.
    let table = model::<Turntable>(&[], &[0.0]);
    let at_start = linearise(&table, 0.0, &start(&table)).unwrap();
    let shift = super::place(&at_start.outputs, "shift");
    assert!(at_start.c.row(shift).iter().all(|entry| entry.is_nan()));
    assert!(at_start.json().contains("null"));
}
