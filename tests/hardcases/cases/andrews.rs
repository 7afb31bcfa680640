//! Andrews' squeezing mechanism: seven bodies in the plane on ten pins, a motor, a spring.
//!
//! In: nothing. Out: the mechanism on ideal pins, on bushings of given stiffness, and on bushings through the 1/k law.
//! A bushing is the same in all directions of the plane. The start is the ideal mechanism's, at rest, so bushings ring.
//! Moments of inertia about x and y do not matter in the plane; they are such that a body can have them.

use bg_model::bond_graph;

use super::case::{Case, Measure};
use super::compliance::Extrapolated;
use super::problem::{self, Problem};
use super::{EXPLICIT, QUAD, STIFF};

/// The angles and their rates.
const OBSERVED: usize = PlanarSqueezer::<f64>::OUTPUTS;

bond_graph! {
    /// The motor turns the crank (K1) about O, the spring pulls the triangle (K3). Coupler (K2), triangle and two rods
    /// (K4, K6) meet in E; the rods' other ends are on arms (K5, K7) that turn about A. Each body's origin is at a pin,
    /// its axes are those in which the published angles are given.
    pub graph Squeezer {
        /// Stiffness of the bushings.
        param stiffness: N/m = 1e6, above 0;
        /// Damping of the bushings.
        param damping: N*s/m = 10, at least 0;

        // The published angles at the start, omega is -phi: of a rod (K4, K6) from its arm (K5, K7).
        let beta0: rad = -0.061713890014276450;
        let gamma0: rad = 0.45527981916307038;
        let phi0: rad = 0.22266839016588588;
        let delta0: rad = 0.48736497954384255;
        let epsilon0: rad = 1.2305474445498212;

        ground {
            point O = [0, 0, 0]; point A = [-0.06934, -0.00227, 0]; point B = [-0.03635, 0.03273, 0];
            point C = [0.014, 0.072, 0];
        }
        body crank {
            mass 0.04325; inertia [1.6e-5, 1.6e-5, 2.194e-6]; center [0.00092, 0, 0];
            point F = [0.007, 0, 0];
            start at [0, 0, 0]; start turned rotation_z(beta0);
        }
        body coupler {
            mass 0.00365; inertia [1.6e-5, 1.6e-5, 4.410e-7]; center [-0.0115, 0, 0];
            point E = [-0.028, 0, 0];
            start at rotation_z(beta0) * [0.007, 0, 0]; start turned rotation_z(beta0);
        }
        body triangle {
            mass 0.02373; inertia [1.6e-5, 1.6e-5, 5.255e-6]; center [0.01043, -0.01874, 0];
            point E = [0, -0.035, 0]; point D = [0.02, -0.018, 0];
            start at [-0.03635, 0.03273, 0]; start turned rotation_z(gamma0);
        }
        body left_rod {
            mass 0.00706; inertia [1.6e-5, 1.6e-5, 5.667e-7]; center [0, -0.00579, 0];
            point E = [0, -0.02, 0];
            start at [-0.06934, -0.00227, 0] + rotation_z(delta0) * [0.04, 0, 0];
            start turned rotation_z(delta0 + phi0);
        }
        body left_arm {
            mass 0.07050; inertia [1.6e-5, 1.6e-5, 1.169e-5]; center [0.02308, 0.00916, 0];
            point G = [0.04, 0, 0];
            start at [-0.06934, -0.00227, 0]; start turned rotation_z(delta0);
        }
        body right_rod {
            mass 0.00706; inertia [1.6e-5, 1.6e-5, 5.667e-7]; center [0.00579, 0, 0];
            point E = [0.02, 0, 0];
            start at [-0.06934, -0.00227, 0] + rotation_z(epsilon0) * [0, -0.04, 0];
            start turned rotation_z(epsilon0 - phi0);
        }
        body right_arm {
            mass 0.05498; inertia [1.6e-5, 1.6e-5, 1.912e-5]; center [-0.00449, -0.01228, 0];
            point H = [0, -0.04, 0];
            start at [-0.06934, -0.00227, 0]; start turned rotation_z(epsilon0);
        }
        joint pin_o: revolute z (ground.O -> crank) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_f: revolute z (crank.F -> coupler) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_b: revolute z (ground.B -> triangle) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_g: revolute z (left_arm.G -> left_rod) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_h: revolute z (right_arm.H -> right_rod) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_a5: revolute z (ground.A -> left_arm) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_a7: revolute z (ground.A -> right_arm) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_e3: revolute z (coupler.E -> triangle.E) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_e4: revolute z (coupler.E -> left_rod.E) { stiffness stiffness; damping damping; tilt stiffness 1; }
        joint pin_e6: revolute z (coupler.E -> right_rod.E) { stiffness stiffness; damping damping; tilt stiffness 1; }
        spring pull (ground.C -> triangle.D) { stiffness 4530; length 0.07785; }
        drive motor on pin_o torque = 0.033;

        // The published angles, turns counted, and their rates.
        observe {
            beta: rad = beta0 + integral(crank.angular_velocity.z); theta: rad = integral(pin_f.speed);
            gamma: rad = gamma0 + integral(triangle.angular_velocity.z); phi: rad = phi0 + integral(pin_g.speed);
            delta: rad = delta0 + integral(left_arm.angular_velocity.z); omega: rad = integral(pin_h.speed) - phi0;
            epsilon: rad = epsilon0 + integral(right_arm.angular_velocity.z);
            beta_rate: rad/s = pin_o.speed; theta_rate: rad/s = pin_f.speed; gamma_rate: rad/s = pin_b.speed;
            phi_rate: rad/s = pin_g.speed; delta_rate: rad/s = pin_a5.speed; omega_rate: rad/s = pin_h.speed;
            epsilon_rate: rad/s = pin_a7.speed;
        }

        scenes only;
        /// On bushings: the 42 states of seven bodies in the plane.
        scene PlanarSqueezer { angles; expect planar; expect states = 42; }
        /// On ideal pins.
        scene RigidSqueezer { rigid joints; angles; tune {} expect planar; expect states = 14; }
    }
}

/// Stiffness (N/m) and damping (N s/m) of the bushings, and beta at t = 0.03 (rad), by another program: DOP853 at 1e-9,
/// absolute coordinates. On ideal pins beta is 15.8107711952.
pub const ON_BUSHINGS: [(f64, f64, f64); 14] = [
    (1e6, 10.0, 13.9553010377),
    (1e7, 10.0, 15.6881678683),
    (1e8, 10.0, 15.7989330020),
    (1e9, 10.0, 15.8095874619),
    (1e10, 10.0, 15.8106528397),
    (1e6, 100.0, 13.9139581426),
    (1e7, 100.0, 15.6929061568),
    (1e8, 100.0, 15.7996194698),
    (1e9, 100.0, 15.8096610416),
    (1e10, 100.0, 15.8106602296),
    (1e6, 0.0, 13.9896088229),
    (1e7, 0.0, 15.6863830731),
    (1e8, 0.0, 15.7987720663),
    (1e9, 0.0, 15.8095702615),
];

/// A squeezer on bushings, of whose angles and rates `observe` makes something.
fn on_bushings(stiffness: f64, damping: f64, observe: fn(&[f64; OBSERVED]) -> Vec<f64>) -> Box<dyn Problem> {
    let parameters = PlanarSqueezerParameters { stiffness, damping };
    problem::outputs(PlanarSqueezer::new(parameters).expect("in range"), observe)
}

/// The squeezer on bushings of one line of [`ON_BUSHINGS`], to t = 0.03.
///
/// # Panics
/// A stiffness or damping is out of range.
#[must_use]
pub fn bushings(name: &'static str, (stiffness, damping, beta): (f64, f64, f64)) -> Case {
    Case {
        name,
        source: "Test Set for IVP Solvers, Andrews' squeezing mechanism, here on bushings, which no one has published",
        held_against: "DOP853 at 1e-9 by another program",
        measure: Measure::Relative,
        absolute: 1e-4,
        amplification: 1.0,
        floor: 1e-10,
        instants: vec![0.03],
        reference: vec![vec![beta]],
        moderate: 1e-6,
        fitting: STIFF,
        problem: on_bushings(stiffness, damping, |y| vec![y[0]]),
    }
}

/// On bushings of 1e6 N/m without damping: the ring stays.
#[must_use]
pub fn ringing_andrews() -> Case {
    Case { fitting: EXPLICIT, ..bushings("andrews-1e6-undamped", ON_BUSHINGS[10]) }
}

/// On bushings of 1e8 N/m and 100 N s/m: the ring dies away on the way.
#[must_use]
pub fn damped_andrews() -> Case {
    bushings("andrews-1e8-damped", ON_BUSHINGS[7])
}

/// Held against the ideal mechanism: seven angles and their rates.
fn ideal(name: &'static str, problem: Box<dyn Problem>) -> Case {
    // beta, theta, gamma, phi, delta, omega, epsilon, and their rates.
    let published = [
        [
            2.1601131315315265,
            -1.8833642311070444,
            0.1585167580012267,
            -0.3286410751746703,
            0.5251547747977294,
            0.3286410751746703,
            1.068427204632401,
            711.923152831104,
            -786.7700808599398,
            -136.4381913781197,
            -240.29302926786454,
            4.791548225371054,
            240.29302926786454,
            -41.14056696161049,
        ],
        [
            8.184905889661676,
            -7.890505363730449,
            0.20953691338469757,
            -0.23832559659585126,
            0.5225369171559964,
            0.23832559659585126,
            1.0862751085998732,
            726.5583426091277,
            -748.6324206323291,
            -145.73923758440472,
            -259.50079947677506,
            9.79050185516307,
            259.50079947677506,
            -57.75747174274601,
        ],
        [
            15.810771195153707,
            -15.756371058411839,
            0.0408222401196458,
            -0.5347301163420796,
            0.524409965879954,
            0.5347301163420796,
            1.048080741041938,
            1139.9203022591062,
            -1424.3792951775401,
            11.032911910618594,
            19.29337410503204,
            0.5735699148295025,
            -19.29337410503204,
            0.3231791492491309,
        ],
        [
            33.82586776695452,
            -33.58343151746387,
            0.11339507381259901,
            -0.40785286560188444,
            0.5260604449169958,
            0.40785286560188444,
            1.056902429434963,
            1144.5355026538475,
            -1336.0337226511924,
            -190.93706860429464,
            -334.3170608708647,
            0.8758650829430151,
            334.3170608708647,
            -39.617288978352995,
        ],
    ];
    Case {
        name,
        source: "Test Set for IVP Solvers, Andrews' squeezing mechanism (github cran/deTestSet, src/Ex_andrews.f)",
        held_against: QUAD,
        measure: Measure::Scaled,
        absolute: 1e-4,
        amplification: 1.0,
        floor: 1e-11,
        instants: vec![0.01, 0.02, 0.03, 0.05],
        reference: published.map(|row| row.to_vec()).to_vec(),
        moderate: 1e-6,
        fitting: EXPLICIT,
        problem,
    }
}

/// The squeezer on ideal pins, to t = 0.05.
///
/// # Panics
/// Never: it has no parameters, and the start closes.
#[must_use]
pub fn andrews() -> Case {
    let model = RigidSqueezer::new(RigidSqueezerParameters::default()).expect("no parameters");
    ideal("andrews", problem::outputs(model, |y| y.to_vec()))
}

/// The squeezer on bushings of 1e8, 2e8 and 4e8 N/m, damped so well that their ring is over at t = 0.01.
#[must_use]
pub fn soft_squeezers() -> Extrapolated {
    Extrapolated([1e8, 2e8, 4e8].map(|stiffness| on_bushings(stiffness, 1e3, |y| y.to_vec())))
}

/// The squeezer on bushings, extrapolated to ideal pins, to t = 0.03.
#[must_use]
pub fn compliant_andrews() -> Case {
    let case = ideal("andrews-compliant", Box::new(soft_squeezers()));
    Case { floor: 1e-4, fitting: STIFF, ..case.until(0.03) }
}
