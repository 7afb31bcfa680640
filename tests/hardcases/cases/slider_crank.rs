//! SUNDIALS' slider-crank: a crank and a rod between whose middles a spring and a damper act, pushed by a constant
//! force.
//!
//! In: nothing. Out: the mechanism with ideal joints, and with compliant ones through the 1/k law. The published
//! equations put the rod's mass at the slider; here a rod and a slider share it at one point, which is the same.

use bg_model::bond_graph;

use super::case::{Case, Measure};
use super::compliance::Extrapolated;
use super::problem::{self, Problem};
use super::{QUAD, STIFF};

bond_graph! {
    /// The crank turns about the ground's point O, the slider moves along x, the push acts on the rod's far end.
    pub graph CompliantSliderCrank {
        /// Stiffness of pins and slide.
        param stiffness: N/m = 1e4, above 0;
        /// Damping of pins and slide.
        param damping: N*s/m = 200, at least 0;
        /// The rod's and the slider's mass: their sum counts.
        param rod_mass: kg = 0.5, above 0;
        param slider_mass: kg = 0.5, above 0;
        /// The rod's moment of inertia.
        param rod_inertia: kg*m^2 = 2, above 0;

        ground { point O = [0, 0, 0]; }
        body crank {
            mass 1; inertia [1, 1, 1];
            point A = [0.5, 0, 0];
            point middle = [0.25, 0, 0];
            start at [0, 0, 0];
            start turned rotation_z(1.5707963267948966);
        }
        body rod {
            mass rod_mass; inertia [2, 2, rod_inertia];
            point A = [-1, 0, 0];
            point middle = [-0.5, 0, 0];
            point tip = [1, 0, 0];
            start at [0.8660254037844386, 0, 0];
            start turned rotation_z(-0.5235987755982989);
        }
        body slider {
            mass slider_mass; inertia [1, 1, 1];
            start at [0.8660254037844386, 0, 0];
        }
        joint pin_o: revolute z (ground.O -> crank) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1e2;
        }
        joint pin_a: revolute z (crank.A -> rod.A) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1e2;
        }
        joint pin_b: revolute z (rod -> slider) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1e2;
        }
        joint slide: prismatic x (ground.O -> slider) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1e2;
        }
        spring coupling (crank.middle -> rod.middle) { stiffness 1; damping 1; length 1; }
        drive push on rod.tip force = [1, 0, 0];

        observe {
            cosine = crank.x_axis.x; sine = crank.x_axis.y; x: m = slider.position.x; rod_sine = rod.x_axis.y;
            crank_speed: rad/s = crank.angular_velocity.z; slider_speed: m/s = slider.velocity.x;
            rod_speed: rad/s = rod.angular_velocity.z;
        }

        /// On compliant joints, in the plane.
        scene PlanarSliderCrank { tune { stiffness, damping } expect planar; }
        /// On ideal joints.
        scene RigidSliderCrank { rigid joints; tune { rod_mass, slider_mass, rod_inertia } expect planar; }
    }
}

fn case(name: &'static str, problem: Box<dyn Problem>) -> Case {
    // Crank angle, slider position, rod angle, and their rates.
    let published = [
        [
            1.3154205708816982,
            1.0014918072308003,
            -0.5049734706420015,
            -0.5087929769098691,
            0.28166909468698725,
            0.07342752901418531,
        ],
        [
            0.5790388120488067,
            1.3803352719611894,
            -0.27714409573898113,
            -0.9421870727850838,
            0.3699561617887682,
            0.40994323719509235,
        ],
        [
            -1.4299969676472273,
            0.9390306135782662,
            0.5178947564898863,
            0.05499161053776448,
            0.0294222316477811,
            -0.004440989758956747,
        ],
        [
            1.2756758486502393,
            1.0235785589798394,
            -0.49881304918249875,
            -0.23991499719600068,
            0.13377828321577764,
            0.03973149599132174,
        ],
    ];
    let observed = |[q, x, p, q_rate, x_rate, p_rate]: [f64; 6]| {
        vec![libm::cos(q), libm::sin(q), x, libm::sin(p), q_rate, x_rate, p_rate]
    };
    Case {
        name,
        source: "github LLNL/sundials, examples/ida/serial/idaSlCrank_dns.c",
        held_against: QUAD,
        measure: Measure::Absolute,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-12,
        instants: vec![1.0, 2.0, 5.0, 10.0],
        reference: published.map(observed).to_vec(),
        moderate: 1e-6,
        fitting: &["auto", "dop853", "rodas5p", "radau5"],
        problem,
    }
}

/// The slider-crank on ideal joints, to t = 10.
///
/// # Panics
/// Never: the parameters are in range and the start closes.
#[must_use]
pub fn slider_crank() -> Case {
    let model = RigidSliderCrank::new(RigidSliderCrankParameters::default()).expect("the defaults are in range");
    case("slider-crank", problem::outputs(model, |y| y.to_vec()))
}

/// The slider-crank with joints of 1e4, 2e4 and 4e4 N/m.
///
/// # Panics
/// Never: the parameters are in range and the start closes.
#[must_use]
pub fn soft_slider_cranks() -> Extrapolated {
    Extrapolated([1.0, 2.0, 4.0].map(|factor| {
        let p = PlanarSliderCrankParameters::default();
        let p = PlanarSliderCrankParameters { stiffness: factor * p.stiffness, ..p };
        problem::outputs(PlanarSliderCrank::new(p).expect("in range"), |y| y.to_vec())
    }))
}

/// The slider-crank on compliant joints, extrapolated to ideal ones.
#[must_use]
pub fn compliant_slider_crank() -> Case {
    let case = case("slider-crank-compliant", Box::new(soft_slider_cranks()));
    Case { floor: 1e-5, fitting: STIFF, ..case }
}
