//! Conservative scenes, from an oscillator to the hacksaw.
//!
//! In: nothing. Out: [`scenes`]: problems whose rows are invariants, each over its size, and last the orthogonality of
//! the orientations, max |R R^T - 1|, where there are any.

use bg_model::bond_graph;
use bg_model::nalgebra::SVector;
use bg_model::system::Model;

use crate::hard_hacksaw::machine::{changed, orthogonality};
use crate::hard_hacksaw::reversal::{Coasting, CoastingInputs, CoastingParameters};
use crate::hardcases::pendulums::{SpringPendulum, SpringPendulumParameters};
use crate::hardcases::problem::{Followable, followable};

bond_graph! {
    /// A mass of 1 kg on a spring of 1 N/m, stretched by 1 m.
    pub graph Oscillator {
        param stiffness: N/m = 1, above 0;
        1 motion: translation;
        I mass = 1;
        C spring = stiffness start 1;
        motion -> mass;
        motion -> spring;
        observe { stored: J = stored_energy; }
    }

    /// A body that nothing acts on, turning about an axis near its middle principal one.
    pub graph TumblingBody {
        1 rotation[3]: rotation;
        orientation attitude of rotation;
        I tensor = diagonal([1, 2, 2.5]) in attitude start [0.3, 2, 0.1];
        rotation -> tensor;
        observe { R = attitude; h: kg*m^2/s = tensor.p; stored: J = stored_energy; }
    }

    /// A symmetric top of 0.5 kg whose tip stands on a joint of 1e5 N/m.
    pub graph TopOnTip {
        gravity [0, 0, -9.81];
        ground { point O = [0, 0, 0]; }
        body top {
            mass 0.5; inertia [4e-4, 4e-4, 6e-4];
            point tip = [0, 0, -0.06];
            start tip at [0, 0, 0];
            start turned rotation_y(0.5);
            start velocity [0, 0.18 * sin(0.5), 0];
            start spin [150 * sin(0.5), 0, 3 + 150 * cos(0.5)];
        }
        joint tip: spherical (ground.O -> top.tip) { stiffness 1e5; }
        observe {
            R = top.orientation;
            about_vertical: kg*m^2/s = dot([0, 0, 1], cross(top.position, top.momentum) + top.angular_momentum);
            about_axis: kg*m^2/s = dot(top.z_axis, top.angular_momentum);
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
        }
    }

    /// Two rods in space without weight, on spherical joints of 1e4 N/m: the double pendulum that keeps its moment
    /// about O.
    pub graph RodsInSpace {
        ground { point O = [0, 0, 0]; }
        body upper {
            mass 1.2; inertia [0.025, 0.01, 0.025];
            point top = [0, 0.25, 0];
            point bottom = [0, -0.25, 0];
            start top at [0, 0, 0];
            start spin [0, 0, 2];
            start velocity [0.5, 0, 0];
        }
        body lower {
            mass 0.8; inertia [0.033, 0.01, 0.033];
            point top = [0, 0.35, 0];
            start top at [0, -0.5, 0];
            start spin [1, 1, 0];
            start velocity [1, 0, 0.35];
        }
        joint shoulder: spherical (ground.O -> upper.top) { stiffness 1e4; }
        joint elbow: spherical (upper.bottom -> lower.top) { stiffness 1e4; }
        observe {
            R1 = upper.orientation;
            R2 = lower.orientation;
            moment: kg*m^2/s = cross(upper.position, upper.momentum) + upper.angular_momentum
                + cross(lower.position, lower.momentum) + lower.angular_momentum;
            stored: J = stored_energy;
        }
    }
}

/// A scene whose energy, and perhaps its angular momentum, stays what it is.
pub struct Scene {
    /// The name, one word.
    pub name: &'static str,
    /// What is conserved, in the order of the rows; the last is max |R R^T - 1|, 0 where there is no orientation.
    pub invariants: &'static [&'static str],
    /// The period of the fastest motion, s.
    pub period: f64,
    /// What is run.
    pub problem: Box<dyn Followable>,
}

/// A problem from the model's own start.
macro_rules! problem {
    ($model:expr, $observe:expr) => {{
        let model = $model;
        let start: SVector<f64, _> = model.start().expect("the mechanism closes");
        followable(model, start, $observe)
    }};
}

/// All scenes, from the smallest on.
///
/// # Panics
/// Never: all parameters are in range and all mechanisms close.
#[must_use]
pub fn scenes() -> Vec<Scene> {
    vec![oscillator(), spring_pendulum(), tumbling_body(), top(), rods(), hacksaw()]
}

/// The oscillator, period 2 pi s.
///
/// # Panics
/// Never.
#[must_use]
pub fn oscillator() -> Scene {
    let model = Oscillator::new(OscillatorParameters::default()).expect("in range");
    Scene {
        name: "oscillator",
        invariants: &["energy", "orthogonality"],
        period: std::f64::consts::TAU,
        problem: problem!(model, |y: &[f64; 1]| vec![y[0] / 0.5, 0.0]),
    }
}

/// The pendulum on a spring of 1000 N/m, stretched by a tenth, which rings with 1000^(1/2) rad/s.
///
/// # Panics
/// Never.
#[must_use]
pub fn spring_pendulum() -> Scene {
    let stiffness = 1e3;
    let parameters = SpringPendulumParameters { stiffness, x: 0.9, y: 0.1 };
    let model = SpringPendulum::new(parameters).expect("in range");
    let energy = move |y: &[f64; 4]| {
        let stretch = (y[0] * y[0] + y[1] * y[1]).sqrt() - 1.0;
        0.5 * (y[2] * y[2] + y[3] * y[3]) + y[1] + 0.5 * stiffness * stretch * stretch
    };
    Scene {
        name: "spring-pendulum",
        invariants: &["energy", "orthogonality"],
        period: std::f64::consts::TAU / stiffness.sqrt(),
        // At the start 0.1 J of weight and 4.5 J in the spring.
        problem: problem!(model, move |y: &[f64; 4]| vec![energy(y) / 4.6, 0.0]),
    }
}

/// The tumbling body, which turns over and then spins with about 2 rad/s.
///
/// # Panics
/// Never.
#[must_use]
pub fn tumbling_body() -> Scene {
    let model = TumblingBody::new(TumblingBodyParameters::default()).expect("no parameters");
    Scene {
        name: "tumbling-body",
        invariants: &["energy", "momentum x", "momentum y", "momentum z", "orthogonality"],
        period: std::f64::consts::PI,
        problem: problem!(model, |y: &[f64; 13]| {
            vec![y[12], y[9] / 2.0, y[10] / 2.0, y[11] / 2.0, orthogonality(first_nine(y))]
        }),
    }
}

/// The top, whose tip rings with about 1050 rad/s.
///
/// # Panics
/// Never.
#[must_use]
pub fn top() -> Scene {
    let model = TopOnTip::new(TopOnTipParameters::default()).expect("no parameters");
    Scene {
        name: "top",
        invariants: &["energy", "momentum about the vertical", "momentum about the axis", "orthogonality"],
        period: std::f64::consts::TAU / 1050.0,
        problem: problem!(model, |y: &[f64; 13]| {
            vec![(y[11] - y[12]) / 7.0, y[9] / 0.09, y[10] / 0.09, orthogonality(first_nine(y))]
        }),
    }
}

/// The rods in space, whose joints ring with about 400 rad/s.
///
/// # Panics
/// Never.
#[must_use]
pub fn rods() -> Scene {
    let model = RodsInSpace::new(RodsInSpaceParameters::default()).expect("no parameters");
    Scene {
        name: "rods-in-space",
        invariants: &["energy", "momentum x", "momentum y", "momentum z", "orthogonality"],
        period: std::f64::consts::TAU / 400.0,
        problem: problem!(model, |y: &[f64; 22]| {
            let second = std::array::from_fn(|k| y[9 + k]);
            vec![y[21], y[18], y[19], y[20], orthogonality(first_nine(y)).max(orthogonality(second))]
        }),
    }
}

/// The hacksaw without drive, work and dampers, falling from a crank angle of 1.2 rad; its pins ring with 1.1e4 rad/s.
///
/// # Panics
/// Never.
#[must_use]
pub fn hacksaw() -> Scene {
    let dampings = ["r_2", "r_2r", "r_23", "r_23r", "r_34", "r_34r", "r_15", "r_15r", "r_45", "r_45r"];
    let mut changes: Vec<(&'static str, f64)> = dampings.map(|name| (name, 0.0)).to_vec();
    changes.push(("crank_angle", 1.2));
    let model = Coasting::new(changed::<CoastingParameters>(&changes), CoastingInputs::default()).expect("in range");
    const M: usize = Coasting::OUTPUTS;
    // Four positions and orientations in turn, then the energies.
    let orientation = |y: &[f64; M], link: usize| std::array::from_fn(|k| y[12 * link + 3 + k]);
    Scene {
        name: "hacksaw",
        invariants: &["energy", "orthogonality"],
        period: std::f64::consts::TAU / 1.1e4,
        problem: problem!(model, move |y: &[f64; M]| {
            let worst = (0..4).map(|link| orthogonality(orientation(y, link))).fold(0.0, f64::max);
            vec![y[48] - y[49], worst]
        }),
    }
}

fn first_nine(y: &[f64]) -> [f64; 9] {
    std::array::from_fn(|k| y[k])
}
