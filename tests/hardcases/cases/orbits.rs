//! Orbits: Kepler's with eccentricity 0.9 and Arenstorf's. Not stiff, but with steps of very different size.
//!
//! In: nothing. Out: cases. Jacobians are taken by differences.

use bg_model::nalgebra::SVector;
use bg_model::system::System;

use super::case::{Case, Measure};
use super::{EXPLICIT, problem};

/// Two bodies, q'' = -q / |q|^3.
struct Kepler;

impl System<f64, 4, 0> for Kepler {
    fn rate(&self, _: f64, y: &SVector<f64, 4>, _: &[bool; 0], dy: &mut SVector<f64, 4>) {
        let square = y[0] * y[0] + y[1] * y[1];
        let cube = square * libm::sqrt(square);
        *dy = SVector::from([y[2], y[3], -y[0] / cube, -y[1] / cube]);
    }
}

/// Kepler's problem with eccentricity 0.9 over three periods, to t = 20.
#[must_use]
pub fn kepler() -> Case {
    Case {
        name: "kepler",
        source: "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, section I.2",
        held_against: "quad precision, and Kepler's equation to 21 digits",
        measure: Measure::Scaled,
        absolute: 1.0,
        amplification: 10.0,
        floor: 1e-10,
        instants: vec![10.0, 20.0],
        reference: vec![
            vec![-1.8538537094055791, -0.13088540483992556, 0.16156945255843133, -0.2237192767918971],
            vec![-1.2952662509875743, 0.4003938963792322, -0.6775390924707566, -0.12708381542786862],
        ],
        moderate: 1e-6,
        fitting: EXPLICIT,
        problem: problem::states(Kepler, [0.1, 0.0, 0.0, libm::sqrt(19.0)]),
    }
}

/// Three bodies, one of them without mass, in the turning frame of the other two.
struct Arenstorf;

impl System<f64, 4, 0> for Arenstorf {
    fn rate(&self, _: f64, y: &SVector<f64, 4>, _: &[bool; 0], dy: &mut SVector<f64, 4>) {
        const MU: f64 = 0.012277471;
        const REST: f64 = 1.0 - MU;
        let cube = |x: f64| {
            let square = x * x + y[1] * y[1];
            square * libm::sqrt(square)
        };
        let (d1, d2) = (cube(y[0] + MU), cube(y[0] - REST));
        let x = y[0] + 2.0 * y[3] - REST * (y[0] + MU) / d1 - MU * (y[0] - REST) / d2;
        *dy = SVector::from([y[2], y[3], x, y[1] - 2.0 * y[2] - REST * y[1] / d1 - MU * y[1] / d2]);
    }
}

/// Arenstorf's orbit over one period, back to its start, which `f64` itself can only meet to 8 digits.
#[must_use]
pub fn arenstorf() -> Case {
    let start = [0.994, 0.0, 0.0, -2.001_585_106_379_082_4];
    Case {
        name: "arenstorf",
        source: "E. Hairer, S. Norsett, G. Wanner, Solving ODEs I, section II.0; SciML ODEProblemLibrary threebody",
        held_against: "the start: the orbit is periodic, in quad precision to 2e-25",
        measure: Measure::Absolute,
        absolute: 1.0,
        amplification: 1e3,
        floor: 1e-7,
        instants: vec![17.065_216_560_157_964],
        reference: vec![start.to_vec()],
        moderate: 1e-8,
        fitting: EXPLICIT,
        problem: problem::states(Arenstorf, start),
    }
}
