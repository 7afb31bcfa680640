//! The double pendulum of the gallery as a page shows it: bodies, joints and poses from the run's outputs, a picture of
//! its graph without a layout.

use bg_model::mechanism::Mechanism;
use bg_model::run::{Simulation, Trajectory};
use bg_workbench::page::animation::{Animation, BodyTrack, JointTrack, NamedPoint, Shape, Solid};
use bg_workbench::page::{BondSeries, Picture};

#[path = "../../examples/double_pendulum.rs"]
#[allow(dead_code, unused_attributes)]
mod double_pendulum;

pub use double_pendulum::DoublePendulum;
use double_pendulum::DoublePendulumParameters;

/// The interval of the rows of the CSV file, and that of all samples, s.
const ROW: f64 = 0.01;
const FINE: f64 = 0.002;

/// A run with the instants of its rows.
pub fn run(t_end: f64) -> (Trajectory, Vec<f64>) {
    let model = DoublePendulum::new(DoublePendulumParameters::default()).unwrap();
    let rows = bg_model::run::sample_times(0.0, ROW, t_end);
    let mut instants = bg_model::run::sample_times(0.0, FINE, t_end);
    instants.extend(&rows);
    instants.sort_unstable_by(f64::total_cmp);
    instants.dedup();
    (Simulation::new(&model).until(t_end).at(&instants).run().unwrap(), rows)
}

/// A vector output at each sample.
fn vector(run: &Trajectory, name: &str) -> Vec<[f64; 3]> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| &run[format!("{name}_{axis}").as_str()]);
    (0..run.times.len()).map(|k| [x[k], y[k], z[k]]).collect()
}

/// The machine: the upper rod with solids, the lower one without.
pub fn animation(run: &Trajectory) -> Animation {
    let parameters = DoublePendulumParameters::default();
    let (upper, lower) = (vector(run, "upper_position"), vector(run, "lower_position"));
    let (shoulder, elbow) = (&run["upper_angle"], &run["elbow_angle"]);
    let turn = |angle: f64| [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()];
    let point = |name: &str, y: f64| NamedPoint { name: name.to_owned(), at: [0.0, y, 0.0] };
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let (half, other) = (parameters.upper_length / 2.0, parameters.lower_length / 2.0);
    let solid = |shape, at| Solid { shape, at, turned: identity };
    let force = |name: &str| -> Vec<[f64; 3]> {
        vector(run, name).into_iter().map(|gap| gap.map(|gap| -parameters.stiffness * gap)).collect()
    };
    // The top of the upper rod and the top of the lower one.
    let tip = |centre: &[[f64; 3]], angle: &dyn Fn(usize) -> f64, y: f64| -> Vec<[f64; 3]> {
        let at = |(k, c): (usize, &[f64; 3])| [c[0] - y * angle(k).sin(), c[1] + y * angle(k).cos(), c[2]];
        centre.iter().enumerate().map(at).collect()
    };
    let joint = |name: &str, place, force| JointTrack {
        name: name.to_owned(),
        kind: "revolute".to_owned(),
        place,
        force,
        torque: Vec::new(),
    };
    Animation {
        times: run.times.clone(),
        bodies: vec![
            BodyTrack {
                name: "upper".to_owned(),
                solids: vec![
                    solid(Shape::Cuboid { edges: [0.04, 2.0 * half, 0.03] }, [0.0; 3]),
                    solid(Shape::Cylinder { radius: 0.035, length: 0.05, axis: 2 }, [0.0, half, 0.0]),
                    solid(Shape::Sphere { radius: 0.03 }, [0.0, -half, 0.0]),
                ],
                points: vec![point("top", half), point("bottom", -half)],
                position: upper.clone(),
                orientation: shoulder.iter().map(|&angle| turn(angle)).collect(),
            },
            BodyTrack {
                name: "lower".to_owned(),
                solids: Vec::new(),
                points: vec![point("top", other), point("tip", -other)],
                position: lower.clone(),
                orientation: shoulder.iter().zip(elbow).map(|(a, b)| turn(a + b)).collect(),
            },
        ],
        ground: vec![NamedPoint { name: "O".to_owned(), at: [0.0; 3] }],
        gravity: [0.0, -9.81, 0.0],
        joints: vec![
            joint("shoulder", tip(&upper, &|k| shoulder[k], half), force("shoulder_gap")),
            joint("elbow", tip(&lower, &|k| shoulder[k] + elbow[k], other), force("elbow_gap")),
        ],
    }
}

/// The machine where it hangs at rest, one sample.
pub fn at_rest() -> Animation {
    let (run, _) = run(0.01);
    let mut rest = animation(&run);
    rest.times.truncate(1);
    for (body, y) in rest.bodies.iter_mut().zip([-0.25, -0.85]) {
        body.position = vec![[0.0, y, 0.0]];
        body.orientation = vec![[0.0, 0.0, 0.0, 1.0]];
    }
    rest
}

/// The modes there.
pub fn modes() -> Vec<bg_workbench::linear::Mode> {
    let parameters = DoublePendulumParameters { upper_angle: 0.1, lower_angle: 0.05, ..Default::default() };
    let model = DoublePendulum::new(parameters).unwrap();
    let start: Vec<f64> = Simulation::new(&model).start().unwrap().states.iter().map(|(_, value)| *value).collect();
    let rest = bg_workbench::linear::equilibrium(&model, 0.0, &start).unwrap();
    bg_workbench::linear::linearise(&model, 0.0, &rest.x).unwrap().modes
}

/// A picture in which every bond is a line, with efforts and flows that are known: bond `index` has the effort `index +
/// t`, the flow 2, in each component.
pub fn picture(times: &[f64]) -> Picture {
    let bonds = DoublePendulum::describe().bonds;
    let line = |index: usize| {
        let (x, y) = (30 + 90 * (index % 10), 30 + 40 * (index / 10));
        format!(
            "<g class=\"bond\" data-bond=\"{index}\"><path d=\"M{x} {y}h60l-8 -5\" stroke=\"var(--bond, var(--ink))\" \
                 stroke-width=\"2\" fill=\"none\"/><title>{}</title></g>",
            index
        )
    };
    let lines: String = (0..bonds.len()).map(line).collect();
    let series = |index: usize, cardinality: usize| BondSeries {
        effort: vec![times.iter().map(|t| index as f64 + t).collect(); cardinality],
        flow: vec![vec![2.0; times.len()]; cardinality],
    };
    Picture {
        svg: format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 940 200\">{lines}</svg>"),
        times: times.to_vec(),
        bonds: bonds.iter().enumerate().map(|(index, bond)| series(index, bond.cardinality)).collect(),
    }
}
