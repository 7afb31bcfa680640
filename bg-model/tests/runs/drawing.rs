//! What pictures show of a model: the same values as its outputs, in the literal model and in scenes.

use bg_model::bond_graph;
use bg_model::drawing::{Place, Shape};
use bg_model::mechanism::Mechanism;
use bg_model::run::Simulation;
use bg_model::simulation::{Part, Recording};

bond_graph! {
    graph Arm {
        param length: m = 0.8, above 0;
        param torque: N*m = 3;
        gravity [0, -9.81, 0];
        ground { point O = [0.1, 0.2, 0]; point wall = [1, 1, 0]; }
        body arm {
            cuboid [length, 0.05, 0.02] at [length / 2, 0, 0] density 7800;
            cylinder radius 0.03 length 0.1 along y at [length, 0, 0] turned rotation_z(0.3) density 2700;
            sphere radius 0.04 density 1000;
            point tip = [length, 0, 0];
            start at [0.1, 0.2, 0];
            start turned rotation_z(0.4);
        }
        joint pin: revolute z (ground.O -> arm) { stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 10; }
        spring rope (ground.wall -> arm.tip) { stiffness 40; length if length < 1 { 0.2 } else { 0.3 }; }
        drive motor on pin torque = torque;
        observe {
            C: m = arm.position; R = arm.orientation; tip: m = arm.tip.position;
            pull: N = rope.force; hold: N = pin.force; twist: N*m = pin.moment;
            motor: W = motor.power;
        }
        scene Plane {
            observe { angle: rad = arm.angle; C: m = arm.position; R = arm.orientation; hold: N = pin.force; }
            tune { length }
            expect planar;
        }
        scene Fast {
            observe { angle: rad = arm.angle; }
            tune { torque }
            angles;
        }
    }
}

/// A run with outputs first and what pictures show after them.
fn run<Me: Mechanism>() -> (Recording, usize) {
    let parameters = Me::Parameters::default();
    let model = Me::make(parameters, &[]).expect("a model");
    let parts = [Part::Outputs, Part::Shown];
    let run = Simulation::new(&model).every(0.05).until(0.5).recording(&parts).run().expect("a run");
    (run.recording, Me::describe().outputs.len())
}

/// The components of a quantity at a sample.
fn at((recording, first): &(Recording, usize), sample: usize, place: Place, components: usize) -> Vec<f64> {
    let place = place.expect("known");
    (0..components).map(|k| recording.columns[first + place + k].values[sample]).collect()
}

/// The components of an output at a sample.
fn output(
    recording: &Recording,
    description: &[bg_model::description::OutputInfo],
    of: &str,
    sample: usize,
) -> Vec<f64> {
    let of: Vec<usize> = (0..description.len()).filter(|&k| description[k].of == of).collect();
    of.into_iter().map(|k| recording.columns[k].values[sample]).collect()
}

fn near(a: &[f64], b: &[f64]) {
    near_by(a, b, 1.0);
}

/// The same, where rounding is that of quantities of this size.
fn near_by(a: &[f64], b: &[f64], size: f64) {
    assert_eq!(a.len(), b.len());
    let size = b.iter().fold(size, |size: f64, b| size.max(b.abs()));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-12 * size, "{a} {b}");
    }
}

/// The pose and the force of the first joint are those of the outputs.
fn agrees<Me: Mechanism>() {
    let run = run::<Me>();
    let description = Me::describe();
    let (body, pin) = (&description.drawing.bodies[0], &description.drawing.joints[0]);
    for sample in 0..run.0.times.len() {
        let output = |of: &str| output(&run.0, description.outputs, of, sample);
        near(&at(&run, sample, body.position, 3), &output("C"));
        near(&at(&run, sample, body.orientation, 9), &output("R"));
        // Stiffness times a gap, which is a difference of places of some 0.1 m.
        near_by(&at(&run, sample, pin.force, 3), &output("hold"), 1e5);
    }
}

#[test]
fn poses_and_forces_are_those_of_the_outputs() {
    agrees::<Arm>();
    agrees::<Plane>();
}

#[test]
fn what_else_is_shown_of_the_literal_model() {
    let run = run::<Arm>();
    let description = Arm::describe();
    let drawing = &description.drawing;
    let [pin, rope] = drawing.joints else { panic!("two joints") };
    assert_eq!((pin.word, pin.ends), ("revolute z", ["ground.O", "arm"]));
    assert_eq!((rope.word, rope.moment, rope.ends[1]), ("spring", None, "arm.tip"));
    let points: Vec<&str> = drawing.ground.iter().map(|point| point.name).collect();
    assert_eq!(points, ["O", "wall"]);
    for sample in [0, 4, 10] {
        let output = |of: &str| output(&run.0, description.outputs, of, sample);
        near(&at(&run, sample, rope.places[1], 3), &output("tip"));
        near(&at(&run, sample, rope.force, 3), &output("pull"));
        near(&at(&run, sample, pin.moment.expect("held rotations"), 3), &output("twist"));
        near(&at(&run, sample, drawing.ground[1].place, 3), &[1.0, 1.0, 0.0]);
        near(&at(&run, sample, drawing.gravity.expect("gravity acts"), 3), &[0.0, -9.81, 0.0]);
    }
}

#[test]
fn solids_have_their_sizes_and_their_places_from_the_centre_of_mass() {
    let run = run::<Arm>();
    let body = &Arm::describe().drawing.bodies[0];
    let [bar, weight, ball] = body.solids else { panic!("three solids") };
    let Shape::Cuboid(edges) = bar.shape else { panic!("a cuboid") };
    near(&at(&run, 0, edges, 3), &[0.8, 0.05, 0.02]);
    let Shape::Cylinder { radius, length, axis } = weight.shape else { panic!("a cylinder") };
    near(&[at(&run, 0, radius, 1), at(&run, 0, length, 1)].concat(), &[0.03, 0.1]);
    assert_eq!(axis, 1);
    let turned = at(&run, 0, weight.turned.expect("turned"), 9);
    near(&turned[..2], &[0.3_f64.cos(), -(0.3_f64.sin())]);
    assert!(matches!(ball.shape, Shape::Sphere(_)) && ball.turned.is_none());
    // By masses: 6.24 kg at 0.4 m, 0.76 kg at 0.8 m, 0.27 kg at the origin.
    let masses = [
        7800.0 * 0.8 * 0.05 * 0.02,
        2700.0 * 0.1 * 0.0009 * std::f64::consts::PI,
        1000.0 / 0.75 * std::f64::consts::PI * 0.04_f64.powi(3),
    ];
    let center = (0.4 * masses[0] + 0.8 * masses[1]) / masses.iter().sum::<f64>();
    near(&at(&run, 0, ball.center, 3), &[-center, 0.0, 0.0]);
    near(&at(&run, 0, body.points[0].place, 3), &[0.8 - center, 0.0, 0.0]);
}

#[test]
fn the_bonds_of_a_junction_balance() {
    let run = run::<Arm>();
    let description = Arm::describe();
    let power = |bond: usize, sample: usize| -> f64 {
        let [effort, flow] =
            description.drawing.bonds[bond].map(|place| at(&run, sample, place, description.bonds[bond].cardinality));
        effort.iter().zip(&flow).map(|(e, f)| e * f).sum()
    };
    let mut junctions = 0;
    for junction in description.elements.iter().filter(|element| ["0", "1"].contains(&element.kind)) {
        for sample in [3, 9] {
            let (mut sum, mut size) = (0.0, 1.0_f64);
            for (index, bond) in description.bonds.iter().enumerate() {
                let sign = f64::from(bond.to == junction.name) - f64::from(bond.from == junction.name);
                if sign != 0.0 {
                    let power = power(index, sample);
                    sum += sign * power;
                    size = size.max(power.abs());
                }
            }
            assert!(sum.abs() < 1e-10 * size, "{}: {sum}", junction.name);
        }
        junctions += 1;
    }
    assert!(junctions > 5);
    let motor = description.bonds.iter().position(|bond| bond.from == "motor").expect("a bond");
    // An element's own power counts what goes into it.
    near(&[-power(motor, 7)], &output(&run.0, description.outputs, "motor", 7));
}

#[test]
fn a_scene_shows_what_it_knows() {
    let drawing = &Fast::describe().drawing;
    assert!(drawing.bodies[0].orientation.is_some());
    assert!(drawing.bodies[0].states.iter().all(|&state| state < Fast::STATES));
    // The moment about the axis is free; the held ones act on directions that the plane does not have.
    assert_eq!(drawing.bonds.len(), Arm::describe().drawing.bonds.len());
    let run = run::<Fast>();
    assert!(run.0.columns.iter().flat_map(|column| &column.values).all(|value| value.is_finite()));
}
