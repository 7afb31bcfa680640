//! Pendulums: on a stiff spring, on a pin, and double.
//!
//! In: nothing. Out: cases, rigid ones and compliant ones. The double pendulum hangs its bobs on bars without mass: a
//! bar is a stiff spring, or a residual sink along the line between its ends.

use bg_model::bond_graph;

use super::case::{Case, Measure};
use super::compliance::Extrapolated;
use super::problem::{self, Problem};
use super::{EXPLICIT, QUAD, STIFF};

bond_graph! {
    /// A bob of 1 kg on a spring of 1 m, in a field of 1 m/s^2.
    pub graph BobOnSpring {
        param stiffness: N/m = 1e4, above 0;
        param x: m = 1;
        param y: m = 0;
        gravity [0, -1, 0];
        ground { point O = [0, 0, 0]; }
        body bob { mass 1; inertia [1, 1, 1]; start at [x, y, 0]; }
        spring bar (ground.O -> bob) { stiffness stiffness; length 1; }
        observe { x: m = bob.position.x; y: m = bob.position.y; u: m/s = bob.velocity.x; v: m/s = bob.velocity.y; }

        scenes only;
        /// In the plane.
        scene SpringPendulum { expect planar; expect states = 4; }
    }

    /// A pendulum of reduced length 1 m on a pin: half a metre to the centre of mass, 1/4 kg m^2 about it. Its point at
    /// 1 m moves as a point mass on a bar without mass does.
    pub graph BarOnPin {
        param stiffness: N/m = 4e5, above 0;
        param damping: N*s/m = 1e3, at least 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body bar {
            mass 1; inertia [0.25, 0.25, 0.25];
            point pivot = [0.5, 0, 0];
            point end = [-0.5, 0, 0];
            start pivot at [0, 0, 0];
        }
        joint pin: revolute z (ground.O -> bar.pivot) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1e2;
        }
        observe {
            x: m = bar.end.position.x; y: m = bar.end.position.y; u: m/s = bar.end.velocity.x;
            v: m/s = bar.end.velocity.y;
        }
        scenes only;
        /// On a compliant pin.
        scene CompliantPendulum { expect planar; }
        /// On an ideal one.
        scene RigidPendulum { rigid joints; tune {} expect planar; }
    }

    /// Two bobs of 1 kg on springs of 1 m, well damped.
    pub graph BobsOnSprings {
        param stiffness: N/m = 1e5, above 0;
        param damping: N*s/m = 500, at least 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body upper { mass 1; inertia [1, 1, 1]; start at [1, 0, 0]; }
        body lower { mass 1; inertia [1, 1, 1]; start at [2, 0, 0]; }
        spring upper_bar (ground.O -> upper) { stiffness stiffness; damping damping; length 1; }
        spring lower_bar (upper -> lower) { stiffness stiffness; damping damping; length 1; }
        observe { p1: m = upper.position; p2: m = lower.position; v1: m/s = upper.velocity; v2: m/s = lower.velocity; }
        scenes only;
        /// In the plane.
        scene CompliantDoublePendulum {
            observe {
                x1: m = upper.position.x; y1: m = upper.position.y; x2: m = lower.position.x; y2: m = lower.position.y;
                u1: m/s = upper.velocity.x; v1: m/s = upper.velocity.y; u2: m/s = lower.velocity.x;
                v2: m/s = lower.velocity.y;
            }
            expect planar; expect states = 8;
        }
    }

    /// Two bobs of 1 kg on rigid bars of 1 m.
    pub graph BobsOnBars {
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body upper { mass 1; inertia [1, 1, 1]; start at [1, 0, 0]; }
        body lower { mass 1; inertia [1, 1, 1]; start at [2, 0, 0]; }

        let upper_bar.line: m = upper.position;
        let upper_bar.length = norm(upper_bar.line);
        MTF upper_bar.direction(v) = dot(upper_bar.line, v) / upper_bar.length;
        1 upper_bar.stretch: translation;
        rSe upper_bar.rod = 0 at upper_bar.length - 1;
        upper.translation -> upper_bar.direction -> upper_bar.stretch -> upper_bar.rod;

        let lower_bar.line: m = lower.position - upper.position;
        let lower_bar.length = norm(lower_bar.line);
        0 lower_bar.ends[3]: translation;
        1 lower_bar.slip[3]: translation;
        MTF lower_bar.direction(v) = dot(lower_bar.line, v) / lower_bar.length;
        1 lower_bar.stretch: translation;
        rSe lower_bar.rod = 0 at lower_bar.length - 1;
        lower.translation -> lower_bar.ends -> upper.translation;
        lower_bar.ends -> lower_bar.slip -> lower_bar.direction -> lower_bar.stretch -> lower_bar.rod;

        observe { p1: m = upper.position; }
        scenes only;
        /// In the plane.
        scene RigidDoublePendulum {
            observe {
                x1: m = upper.position.x; y1: m = upper.position.y; x2: m = lower.position.x; y2: m = lower.position.y;
                u1: m/s = upper.velocity.x; v1: m/s = upper.velocity.y; u2: m/s = lower.velocity.x;
                v2: m/s = lower.velocity.y;
            }
            expect planar; expect states = 8;
        }
    }
}

fn spring_pendulum(
    name: &'static str,
    stiffness: f64,
    [x, y]: [f64; 2],
    amplification: f64,
    reference: Vec<Vec<f64>>,
) -> Case {
    let model = SpringPendulum::new(SpringPendulumParameters { stiffness, x, y }).expect("in range");
    Case {
        name,
        source: "E. Hairer, C. Lubich, M. Roche 1988; github jkroon81/flow, demo/stiff-pendulum.vala",
        held_against: QUAD,
        measure: Measure::Scaled,
        absolute: 1e-2,
        amplification,
        floor: 1e-9,
        instants: vec![1.0, 2.0, 5.0, 10.0],
        reference,
        moderate: 1e-6,
        fitting: &["auto", "dop853", "radau5"],
        problem: problem::outputs(model, |y| y.to_vec()),
    }
}

/// The spring pendulum with C = 1e4, released with its spring unloaded, to t = 10.
#[must_use]
pub fn spring_pendulum_1e4() -> Case {
    let reference = vec![
        vec![0.8797020546685244, -0.4758253479651814, -0.4638363151301251, -0.8580809225248488],
        vec![-0.2037436331001786, -0.9793242624577669, -1.3698601497853218, 0.28507739153317607],
        vec![-0.68616404020084, -0.7277467960647956, 0.877475157718856, -0.8276803347195292],
        vec![-0.8105773056273363, -0.5859316734396357, -0.633876034208969, 0.8773572269789338],
    ];
    spring_pendulum("spring-pendulum-1e4", 1e4, [1.0, 0.0], 1.0, reference)
}

/// The same with C = 1e6: the ring is faster and smaller.
#[must_use]
pub fn spring_pendulum_1e6() -> Case {
    let reference = vec![
        vec![0.8795496719125615, -0.47581007712563467, -0.4641541632064506, -0.8580087583946284],
        vec![-0.20418871841714525, -0.9789345437063603, -1.369755934743543, 0.28570814112796655],
        vec![-0.6853530701264202, -0.7282139373440375, 0.8788221129329343, -0.8271002332729542],
        vec![-0.8115763726510993, -0.5842493447457128, -0.6315526305907472, 0.8772895144653858],
    ];
    spring_pendulum("spring-pendulum-1e6", 1e6, [1.0, 0.0], 1.0, reference)
}

/// The same with C = 1000 and a stretched spring, which rings with a tenth of its length.
#[must_use]
pub fn excited_spring_pendulum() -> Case {
    let reference = vec![
        vec![0.839674752764293, -0.34928192506661626, 0.19528256772933628, -1.2567193533623018],
        vec![-0.1480343747594839, -0.9092529434193833, -1.818344082371833, -1.1956451916585846],
        vec![-0.7856113161391074, -0.5717081390873395, -1.5805882682489931, -2.638637960713749],
        vec![-0.7412747352493452, -0.7877790823089013, -1.97407027465712, -0.35495107422850275],
    ];
    spring_pendulum("spring-pendulum-excited", 1e3, [0.9, 0.1], 10.0, reference)
}

fn single(name: &'static str, problem: Box<dyn Problem>) -> Case {
    Case {
        name,
        source: "IFToMM benchmark A01, simple pendulum (github RehabEngGroup/MBSbenchmarksInOpenSim)",
        held_against: "Jacobi's elliptic functions to 34 digits",
        measure: Measure::Scaled,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-12,
        instants: vec![1.0, 5.0, 10.0],
        reference: vec![
            vec![0.9862917511318753, -0.16501085312554117, 0.2969055159163158, 1.7746436411126556],
            vec![-0.9423054350437573, -0.3347543384140006, 0.8579042568859491, -2.4149286543704886],
            vec![-0.2750874625761169, -0.961419205099125, 4.175598100951729, -1.1947490545604753],
        ],
        moderate: 1e-6,
        fitting: &["auto", "dop853", "rodas5p", "radau5"],
        problem,
    }
}

/// The pendulum on an ideal pin, to t = 10.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn pendulum() -> Case {
    let model = RigidPendulum::new(RigidPendulumParameters::default()).expect("the defaults are in range");
    single("pendulum", problem::outputs(model, |y| y.to_vec()))
}

/// The pendulum with a pin of 4e5, 8e5 and 16e5 N/m.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn soft_pendulums() -> Extrapolated {
    Extrapolated([1.0, 2.0, 4.0].map(|factor| {
        let p = CompliantPendulumParameters::default();
        let p = CompliantPendulumParameters { stiffness: factor * p.stiffness, ..p };
        problem::outputs(CompliantPendulum::new(p).expect("in range"), |y| y.to_vec())
    }))
}

/// The pendulum on a compliant pin, extrapolated to the ideal one.
#[must_use]
pub fn compliant_pendulum() -> Case {
    Case { floor: 1e-6, fitting: STIFF, ..single("pendulum-compliant", Box::new(soft_pendulums())) }
}

fn double(name: &'static str, problem: Box<dyn Problem>) -> Case {
    // Angles of the bars from the downward vertical, and their rates.
    let published = [
        [-0.6250876998063907, -1.0345850856800123, -3.9222795728879767, -1.3030992486963313],
        [-0.4829715342517544, -1.3240487123023625, 3.0652881920734014, 2.949271547571619],
        [-0.6271867050665307, -1.3013155502098117, 2.1254086738429105, 3.8818887272656073],
    ];
    let observed = |[a, b, a_rate, b_rate]: [f64; 4]| {
        let (s, c, s2, c2) = (libm::sin(a), libm::cos(a), libm::sin(b), libm::cos(b));
        let (u, v) = (c * a_rate, s * a_rate);
        vec![s, -c, s + s2, -c - c2, u, v, u + c2 * b_rate, v + s2 * b_rate]
    };
    Case {
        name,
        source: "the double pendulum of textbooks, two point masses of 1 kg on bars of 1 m, from the horizontal",
        held_against: QUAD,
        measure: Measure::Scaled,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-11,
        instants: vec![1.0, 2.0, 5.0],
        reference: published.map(observed).to_vec(),
        moderate: 1e-6,
        fitting: EXPLICIT,
        problem,
    }
}

/// The double pendulum on rigid bars, to t = 5; chaotic, a digit is lost in 2 s.
///
/// # Panics
/// Never: it has no parameters.
#[must_use]
pub fn double_pendulum() -> Case {
    let model = RigidDoublePendulum::new(RigidDoublePendulumParameters::default()).expect("no parameters");
    double("double-pendulum", problem::outputs(model, |y| y.to_vec()))
}

/// The double pendulum with bars of 1e5, 2e5 and 4e5 N/m.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn soft_double_pendulums() -> Extrapolated {
    Extrapolated([1.0, 2.0, 4.0].map(|factor| {
        let p = CompliantDoublePendulumParameters::default();
        let p = CompliantDoublePendulumParameters { stiffness: factor * p.stiffness, ..p };
        problem::outputs(CompliantDoublePendulum::new(p).expect("in range"), |y| y.to_vec())
    }))
}

/// The double pendulum on compliant bars, extrapolated to rigid ones.
#[must_use]
pub fn compliant_double_pendulum() -> Case {
    let case = double("double-pendulum-compliant", Box::new(soft_double_pendulums()));
    Case { floor: 1e-4, fitting: STIFF, ..case.until(2.0) }
}
