//! Singular perturbations and prescribed solutions: van der Pol, Prothero-Robinson, Kaps, Kvaerno-Prothero-Robinson,
//! and the stiff joint with known solution.
//!
//! In: nothing. Out: cases. But for van der Pol's the solutions are closed forms, so that errors are exact.

use bg_model::capability::{Linearised, Named};
use bg_model::nalgebra::SVector;
use bg_model::system::System;

use super::case::{Case, Measure};
use super::{CLOSED, QUAD, STIFF, dense, problem};

/// Van der Pol's oscillator, eps y2' = (1 - y1^2) y2 - y1.
struct VanDerPol {
    eps: f64,
}

impl System<f64, 2, 0> for VanDerPol {
    fn rate(&self, _: f64, y: &SVector<f64, 2>, _: &[bool; 0], dy: &mut SVector<f64, 2>) {
        *dy = SVector::from([y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) / self.eps]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 2, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 2, 0> for VanDerPol {
    fn jacobian(&self, _: f64, y: &SVector<f64, 2>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 2>) {
        let second = [(-2.0 * y[0] * y[1] - 1.0) / self.eps, (1.0 - y[0] * y[0]) / self.eps];
        dense([[0.0, 1.0], second], entries, slope);
    }
}

/// Van der Pol with eps = 1e-6 over two jumps, to t = 2.
#[must_use]
pub fn van_der_pol() -> Case {
    Case {
        name: "van-der-pol",
        source: "E. Hairer, G. Wanner, Solving ODEs II, VDPOL; Bari Test Set (github cran/deTestSet, R/ex_vdpol.R)",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1.0,
        amplification: 1.0,
        floor: 1e-12,
        instants: vec![1.0, 2.0],
        reference: vec![vec![-1.8636462548081338, 0.7535430865435434], vec![1.706167732170465, -0.8928097010248165]],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(VanDerPol { eps: 1e-6 }, [2.0, 0.0]),
    }
}

/// y' = lambda (y - cos t) - sin t, whose solution is cos t for every lambda.
struct ProtheroRobinson {
    lambda: f64,
}

impl System<f64, 1, 0> for ProtheroRobinson {
    fn rate(&self, t: f64, y: &SVector<f64, 1>, _: &[bool; 0], dy: &mut SVector<f64, 1>) {
        dy[0] = self.lambda * (y[0] - libm::cos(t)) - libm::sin(t);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 1, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 1, 0> for ProtheroRobinson {
    fn jacobian(&self, t: f64, _: &SVector<f64, 1>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 1>) {
        entries[0] = self.lambda;
        slope[0] = self.lambda * libm::sin(t) - libm::cos(t);
    }
}

/// Prothero and Robinson's problem with lambda = -1e6, to t = 10.
#[must_use]
pub fn prothero_robinson() -> Case {
    let instants = vec![1.0, 3.0, 10.0];
    Case {
        name: "prothero-robinson",
        source: "A. Prothero, A. Robinson 1974; J. Rang, Informatikbericht 2014-05, TU Braunschweig",
        held_against: CLOSED,
        measure: Measure::Absolute,
        absolute: 1.0,
        amplification: 1.0,
        floor: 1e-14,
        reference: instants.iter().map(|t| vec![libm::cos(*t)]).collect(),
        instants,
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(ProtheroRobinson { lambda: -1e6 }, [1.0]),
    }
}

/// Kaps' problem, y1' = -(1/eps + 2) y1 + y2^2 / eps, y2' = y1 - y2 - y2^2.
struct Kaps {
    eps: f64,
}

impl System<f64, 2, 0> for Kaps {
    fn rate(&self, _: f64, y: &SVector<f64, 2>, _: &[bool; 0], dy: &mut SVector<f64, 2>) {
        let fast = -(1.0 / self.eps + 2.0) * y[0] + y[1] * y[1] / self.eps;
        *dy = SVector::from([fast, y[0] - y[1] - y[1] * y[1]]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 2, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 2, 0> for Kaps {
    fn jacobian(&self, _: f64, y: &SVector<f64, 2>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 2>) {
        let rows = [[-(1.0 / self.eps + 2.0), 2.0 * y[1] / self.eps], [1.0, -1.0 - 2.0 * y[1]]];
        dense(rows, entries, slope);
    }
}

/// Kaps' problem with eps = 1e-6, to t = 1.
#[must_use]
pub fn kaps() -> Case {
    let instants = vec![0.25, 0.5, 1.0];
    Case {
        name: "kaps",
        source: "K. Dekker, J. Verwer, Stability of Runge-Kutta methods, section 7.5.2; \
            C. Kennedy, M. Carpenter 2016, section 10",
        held_against: CLOSED,
        measure: Measure::Relative,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-14,
        reference: instants.iter().map(|t| vec![libm::exp(-2.0 * t), libm::exp(-t)]).collect(),
        instants,
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(Kaps { eps: 1e-6 }, [1.0, 1.0]),
    }
}

/// Kvaerno, Prothero and Robinson's problem: a slow component driven at one frequency, a fast one at another.
struct Kpr {
    g: f64,
    coupling: f64,
    frequency: f64,
}

impl System<f64, 2, 0> for Kpr {
    fn rate(&self, t: f64, y: &SVector<f64, 2>, _: &[bool; 0], dy: &mut SVector<f64, 2>) {
        let w = self.frequency;
        let (r, r_rate) = (0.5 * libm::cos(t), -0.5 * libm::sin(t));
        let (s, s_rate) = (libm::cos(w * t), -w * libm::sin(w * t));
        let (a, b) = ((y[0] * y[0] - 1.0 - r) / (2.0 * y[0]), (y[1] * y[1] - 2.0 - s) / (2.0 * y[1]));
        dy[0] = self.g * a + self.coupling * b + r_rate / (2.0 * y[0]);
        dy[1] = self.coupling * a - b + s_rate / (2.0 * libm::sqrt(2.0 + s));
    }
}

/// The problem of Kvaerno, Prothero and Robinson with SUNDIALS' numbers, to t = 5; its Jacobian by differences.
#[must_use]
pub fn kpr() -> Case {
    let instants = vec![1.0, 2.5, 5.0];
    let (g, coupling, frequency) = (-100.0, 0.5, 100.0);
    let exact = |t: &f64| vec![libm::sqrt(1.0 + 0.5 * libm::cos(*t)), libm::sqrt(2.0 + libm::cos(frequency * t))];
    Case {
        name: "kpr",
        source: "github LLNL/sundials, examples/arkode/C_serial/ark_kpr_mri.c",
        held_against: CLOSED,
        measure: Measure::Relative,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-13,
        reference: instants.iter().map(exact).collect(),
        instants,
        moderate: 1e-6,
        fitting: &["auto", "dop853", "rodas5p", "radau5"],
        problem: problem::states(Kpr { g, coupling, frequency }, exact(&0.0).try_into().expect("two states")),
    }
}

/// A mass on a stiff, lightly damped joint and a fast damper, driven so that their motion is known: a joint's C and R.
#[derive(Clone, Copy, Debug)]
pub struct StiffJoint {
    /// Stiffness over mass, 1/s^2.
    pub stiffness: f64,
    /// Damping over mass, 1/s.
    pub damping: f64,
    /// The fast damper's rate, 1/s.
    pub damper: f64,
}

impl StiffJoint {
    /// The joint of the order table: 1e4 rad/s, a damping ratio of 5e-4, a damper of 1e6 1/s.
    pub const STIFF: Self = Self { stiffness: 1e8, damping: 10.0, damper: 1e6 };
    /// The same equations without stiffness: what a method's classical order shows itself on.
    pub const SOFT: Self = Self { stiffness: 4.0, damping: 0.1, damper: 3.0 };

    /// Position, velocity and the damper's state at time `t`.
    #[must_use]
    pub fn exact(t: f64) -> Vec<f64> {
        let [p, v, _, _] = Self::path(t);
        vec![p, v, libm::cos(2.0 * t)]
    }

    /// The prescribed position and its first three derivatives.
    fn path(t: f64) -> [f64; 4] {
        let (s, c, s3, c3) = (libm::sin(t), libm::cos(t), libm::sin(3.0 * t), libm::cos(3.0 * t));
        [s + 0.5 * s3, c + 1.5 * c3, -s - 4.5 * s3, -c - 13.5 * c3]
    }
}

impl System<f64, 3, 0> for StiffJoint {
    fn rate(&self, t: f64, y: &SVector<f64, 3>, _: &[bool; 0], dy: &mut SVector<f64, 3>) {
        let [p, v, a, _] = Self::path(t);
        let force = -self.stiffness * (y[0] - p) - self.damping * (y[1] - v) + a;
        *dy = SVector::from([y[1], force, -self.damper * (y[2] - libm::cos(2.0 * t)) - 2.0 * libm::sin(2.0 * t)]);
    }

    fn named(&self) -> Option<&impl Named<f64, 3, 0>> {
        Some(self)
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 3, 0>> {
        Some(self)
    }
}

impl Named<f64, 3, 0> for StiffJoint {
    fn state_name(&self, index: usize) -> &'static str {
        ["x", "v", "w"][index]
    }
}

impl Linearised<f64, 3, 0> for StiffJoint {
    fn jacobian(&self, t: f64, _: &SVector<f64, 3>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 3>) {
        let [_, v, a, b] = Self::path(t);
        let rows = [[0.0, 1.0, 0.0], [-self.stiffness, -self.damping, 0.0], [0.0, 0.0, -self.damper]];
        dense(rows, entries, slope);
        let driven = -self.damper * 2.0 * libm::sin(2.0 * t) - 4.0 * libm::cos(2.0 * t);
        *slope = SVector::from([0.0, self.stiffness * v + self.damping * a + b, driven]);
    }
}

/// The stiff joint, to t = 1. The absolute tolerance allows for the small size of what the joint's compliance leaves.
#[must_use]
pub fn stiff_joint() -> Case {
    let instants = vec![0.3, 0.6, 1.0];
    Case {
        name: "stiff-joint",
        source: "manufactured from a joint's numbers after the idea of A. Prothero and A. Robinson 1974",
        held_against: CLOSED,
        measure: Measure::Scaled,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-12,
        reference: instants.iter().map(|t| StiffJoint::exact(*t)).collect(),
        instants,
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(StiffJoint::STIFF, [0.0, 2.5, 1.0]),
    }
}
