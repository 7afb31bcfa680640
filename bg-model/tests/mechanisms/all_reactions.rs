//! A scene with `all reactions;` beside the same scene without: the motion and every reaction are the same.

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{Simulation, Trajectory};

/// Two rods on pins, the upper one driven.
mod pins {
    use super::bond_graph;

    bond_graph! {
        pub graph Pins {
            gravity [0, -9.81, 0];
            ground { point O = [0, 0, 0]; }
            body upper { cuboid [0.5, 0.03, 0.03] at [0.25, 0, 0] density 2700; point tip = [0.5, 0, 0];
                start at [0, 0, 0]; }
            body lower {
                cuboid [0.3, 0.02, 0.02] at [0.15, 0, 0] density 7850;
                start at [0.5, 0, 0];
                start turned rotation_z(1);
            }
            joint shoulder: revolute z (ground.O -> upper) { rigid; }
            joint elbow: revolute z (upper.tip -> lower) { rigid; }
            drive motor on shoulder torque = 2;
            observe { upper.direction; lower.direction; shoulder.force; elbow.force; shoulder.moment; elbow.moment }
            scenes only;
            scene BySpeeds { expect planar; expect independent speeds; expect states = 6; }
            scene WithAll { all reactions; expect planar; expect states = 14; }
        }
    }
}

/// A crank, a rod and a slider: one direction closes the loop, and the frame of the slide has forces and a moment.
mod slide {
    use super::bond_graph;

    bond_graph! {
        pub graph Slide {
            gravity [0, -9.81, 0];
            ground { point O = [0, 0, 0]; }
            body crank { cuboid [0.1, 0.03, 0.02] at [0.05, 0, 0] density 7850; point tip = [0.1, 0, 0];
                start at [0, 0, 0]; }
            body rod { cuboid [0.35, 0.02, 0.02] at [0.175, 0, 0] density 2700; point head = [0.35, 0, 0];
                start at [0.1, 0, 0]; }
            body slider { cuboid [0.06, 0.05, 0.04] density 7850; start at [0.45, 0, 0]; }
            joint main: revolute z (ground.O -> crank) { rigid; }
            joint pin: revolute z (crank.tip -> rod) { rigid; }
            joint wrist: revolute z (rod.head -> slider) { rigid; }
            joint way: prismatic x (ground.O -> slider) { rigid; }
            drive motor on main torque = 5;
            observe {
                crank.direction; rod.direction; slider.position; main.force; pin.force; wrist.force; way.force;
                way.moment; main.moment
            }
            scenes only;
            scene BySpeeds { expect planar; expect independent speeds; }
            scene WithAll { all reactions; expect planar; }
        }
    }
}

/// A second of motion, or a few turns.
fn run<Me: Mechanism>(model: &Me) -> Trajectory {
    Simulation::new(model)
        .method(Integrator::Taylor)
        .rtol(1e-13)
        .atol(1e-14)
        .every(0.02)
        .until(1.0)
        .run()
        .expect("a run")
}

/// The columns are the same to 1e-9 of the largest number of their kind; that of the reactions is what occurs in any of
/// them.
fn are_same(by_speeds: &Trajectory, with_all: &Trajectory) {
    let is_reaction = |name: &str| name.contains("force") || name.contains("moment");
    let size = |reactions: bool| {
        let columns = with_all.columns.iter().filter(|column| is_reaction(&column.name) == reactions);
        columns.flat_map(|column| &column.values).fold(0.0_f64, |most, value| most.max(value.abs()))
    };
    assert!(size(true) > 10.0, "{}", size(true));
    for column in &with_all.columns {
        let own = &by_speeds[column.name.as_str()];
        let most = column.values.iter().zip(own).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let bound = 1e-9 * size(is_reaction(&column.name));
        println!("{}: {most:.1e} of {bound:.1e}", column.name);
        assert!(most <= bound, "{}: {most:e} above {bound:e}", column.name);
    }
}

#[test]
fn rods_on_pins_have_the_same_reactions() {
    let by_speeds = pins::BySpeeds::new(pins::BySpeedsParameters::default()).unwrap();
    let with_all = pins::WithAll::new(pins::WithAllParameters::default()).unwrap();
    are_same(&run(&by_speeds), &run(&with_all));
}

#[test]
fn a_loop_with_one_closing_direction_has_the_same_reactions() {
    let by_speeds = slide::BySpeeds::new(slide::BySpeedsParameters::default()).unwrap();
    let with_all = slide::WithAll::new(slide::WithAllParameters::default()).unwrap();
    are_same(&run(&by_speeds), &run(&with_all));
}
