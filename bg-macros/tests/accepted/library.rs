//! The library of parts in calls: of a graph, of a part that others use, beside parts of the same names elsewhere.

#![deny(warnings)]

use bg_model::bond_graph;
use bg_model::run::Simulation;

/// A part of a crate that is made of parts of the library.
pub mod drives {
    bg_model::bond_graph! {
        use gears;
        /// A pinion in front of a wheel.
        pub part Stage {
            param ratio: 1 = 2, above 0;
            port shaft: rotation;
            part pair: GearPair { ratio = ratio; }
            1 wheel: rotation; I inertia = 0.5;
            shaft -> pair.first; pair.second -> wheel -> inertia;
            observe { speed: rad/s = wheel.flow }
        }
    }
}

bond_graph! {
    use motors;
    use screws;
    /// A motor with a screw, and one with a part that has gears of the library.
    pub graph Feed {
        part motor: InductionMotor;
        part screw: LossyScrew;
        part stage: crate::library::drives::Stage { ratio = 4; }
        1 spindle: rotation; 1 table: translation; I load = 100; Se torque = 2; 1 shaft: rotation; I rotor = 0.01;
        motor.shaft -> spindle -> screw.shaft; screw.nut -> table -> load;
        torque -> shaft -> rotor; shaft -> stage.shaft;
        observe { speed: rpm = spindle.flow; feed: mm/s = table.flow; all of stage }
    }
}

#[test]
fn a_call_has_parts_of_the_library() {
    let model = Feed::new(FeedParameters { screw_efficiency: 0.8, ..Default::default() }).expect("a feed");
    let run = Simulation::new(&model).every(1.0).until(2.0).run().expect("a run");
    // 5 mm a turn.
    assert!((run["feed"][2] - run["speed"][2] / 60.0 * 5.0).abs() < 1e-9 && run["speed"][2] > 1400.0);
    // 2 N*m turn 0.01 and 0.5 / 16 kg*m^2.
    let speed = -2.0 / 4.0 / (0.01 + 0.5 / 16.0);
    assert!((run["stage.speed"][1] - speed).abs() < 1e-9);
}
