//! The fluid of `option`: what slows a body down in it, as MuJoCo's model of inertia boxes has it.
//!
//! A body counts as a box with its mass and moments. Along each axis of the box the density brakes with the square of
//! the speed, the viscosity in proportion to it as a ball of the mean diameter. Source: MuJoCo's documentation, *Fluid
//! forces, inertia model*; checked against MuJoCo 4.0.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use crate::ImportError;
use crate::robot::{Drag, Inertia};
use crate::xml::Node;

/// What bodies move in.
pub struct Fluid {
    density: f64,
    viscosity: f64,
    /// m/s.
    pub wind: Vector3<f64>,
}

impl Fluid {
    /// Of a file; none where there is none.
    ///
    /// # Errors
    /// Negative values.
    pub fn new(root: &Node) -> Result<Option<Self>, ImportError> {
        let mut fluid = Self { density: 0.0, viscosity: 0.0, wind: Vector3::zeros() };
        for option in root.children("option") {
            for (name, value) in [("density", &mut fluid.density), ("viscosity", &mut fluid.viscosity)] {
                if option.attribute(name).is_some() {
                    *value = option.not_negative(name)?;
                }
            }
            fluid.wind = option.vector("wind")?.unwrap_or(fluid.wind);
        }
        Ok((fluid.density > 0.0 || fluid.viscosity > 0.0).then_some(fluid))
    }

    /// What brakes a body whose box has these axes, in the body's frame.
    pub fn drag(&self, inertia: &Inertia, axes: Matrix3<f64>) -> Drag {
        let edges = inertia.box_edges(&axes);
        let diameter = edges.sum() / 3.0;
        let across = |k: usize| (edges[(k + 1) % 3], edges[(k + 2) % 3]);
        let area = |k: usize| across(k).0 * across(k).1;
        let turning = |k: usize| edges[k] * (across(k).0.powi(4) + across(k).1.powi(4)) / 64.0;
        let three = |of: &dyn Fn(usize) -> f64| Vector3::new(of(0), of(1), of(2));
        Drag {
            place: inertia.center,
            axes,
            force: [3.0 * PI * diameter * self.viscosity, 0.5 * self.density],
            areas: three(&area),
            torque: [PI * diameter.powi(3) * self.viscosity, self.density],
            turns: three(&turning),
        }
    }
}

/// Principal axes of an inertia; whether they are unique.
pub fn principal(inertia: &Inertia) -> (Matrix3<f64>, bool) {
    let found = inertia.tensor.symmetric_eigen();
    let mut axes = found.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    let is_near =
        |a: usize, b: usize| (found.eigenvalues[a] - found.eigenvalues[b]).abs() <= 1e-9 * found.eigenvalues.amax();
    (axes, !(is_near(0, 1) || is_near(1, 2) || is_near(0, 2)))
}
