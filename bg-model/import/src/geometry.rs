//! Mass and moments of MJCF's shapes.
//!
//! In: a type, its sizes and a density or a mass. Out: the inertia about its own centre and axes. Source: MuJoCo's XML
//! reference, `geom`; a capsule is a cylinder with two half balls.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use crate::robot::Inertia;

/// A shape, sizes in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Half-axes.
    Ellipsoid(Vector3<f64>),
    /// Half edges.
    Cuboid(Vector3<f64>),
    /// Radius, half length along z.
    Cylinder(f64, f64),
    /// Radius, half length of its straight part along z.
    Capsule(f64, f64),
}

impl Shape {
    /// m^3.
    fn volume(&self) -> f64 {
        match *self {
            Self::Ellipsoid(half) => 4.0 / 3.0 * PI * half.product(),
            Self::Cuboid(half) => 8.0 * half.product(),
            Self::Cylinder(radius, half) => 2.0 * PI * radius * radius * half,
            Self::Capsule(radius, half) => PI * radius * radius * (2.0 * half + 4.0 / 3.0 * radius),
        }
    }

    /// Moments for a mass of 1 kg, m^2.
    fn moments(&self) -> Vector3<f64> {
        match *self {
            Self::Ellipsoid(half) => across(half, 5.0),
            Self::Cuboid(half) => across(half, 3.0),
            Self::Cylinder(radius, half) => {
                round((3.0 * radius * radius + 4.0 * half * half) / 12.0, radius * radius / 2.0)
            }
            Self::Capsule(radius, half) => {
                let length = 2.0 * half;
                let straight = length / (length + 4.0 / 3.0 * radius);
                let ends = 1.0 - straight;
                let square = radius * radius;
                round(
                    straight * (3.0 * square + length * length) / 12.0
                        + ends * (0.4 * square + length * length / 4.0 + 3.0 / 8.0 * length * radius),
                    straight * square / 2.0 + ends * 0.4 * square,
                )
            }
        }
    }

    /// Of a mass, or of a density; none where that is 0.
    pub fn inertia(&self, mass: Option<f64>, density: f64) -> Option<Inertia> {
        of(mass.unwrap_or(density * self.volume()), &self.moments())
    }

    /// The same of a thin shell, whose density is for each m^2; none outside where that is not known, inside where it
    /// is 0.
    pub fn shell(&self, mass: Option<f64>, density: f64) -> Option<Option<Inertia>> {
        let (area, moments) = self.surface()?;
        Some(of(mass.unwrap_or(density * area), &moments))
    }

    /// Area, m^2, and moments of a shell of 1 kg, m^2; none of an ellipsoid, which has no closed form.
    fn surface(&self) -> Option<(f64, Vector3<f64>)> {
        Some(match *self {
            Self::Ellipsoid(half) if half.x == half.y && half.y == half.z => {
                (4.0 * PI * half.x * half.x, Vector3::repeat(2.0 / 3.0 * half.x * half.x))
            }
            Self::Ellipsoid(_) => return None,
            Self::Cuboid(half) => {
                // Two faces across each axis: thin plates at their distance from the centre.
                let area = |k: usize| 8.0 * half[(k + 1) % 3] * half[(k + 2) % 3];
                let total: f64 = (0..3).map(area).sum();
                let squares = half.component_mul(&half);
                // The mean square of a coordinate over the whole surface.
                let mean = |axis: usize| -> f64 {
                    (0..3).map(|k| area(k) * squares[axis] * if k == axis { 1.0 } else { 1.0 / 3.0 }).sum::<f64>()
                        / total
                };
                let means = Vector3::new(mean(0), mean(1), mean(2));
                (total, Vector3::new(means.y + means.z, means.x + means.z, means.x + means.y))
            }
            Self::Cylinder(radius, half) => {
                let (wall, lids) = (4.0 * PI * radius * half, 2.0 * PI * radius * radius);
                let total = wall + lids;
                let square = radius * radius;
                let across = wall * (square / 2.0 + half * half / 3.0) + lids * (square / 4.0 + half * half);
                (total, round(across / total, (wall * square + lids * square / 2.0) / total))
            }
            Self::Capsule(radius, half) => {
                let (wall, ball) = (4.0 * PI * radius * half, 4.0 * PI * radius * radius);
                let total = wall + ball;
                let square = radius * radius;
                // A half sphere has its centre of mass at half its radius.
                let ends = 2.0 / 3.0 * square + half * half + half * radius;
                let across = wall * (square / 2.0 + half * half / 3.0) + ball * ends;
                (total, round(across / total, (wall * square + ball * 2.0 / 3.0 * square) / total))
            }
        })
    }
}

/// Of a mass and the moments of 1 kg.
fn of(mass: f64, moments: &Vector3<f64>) -> Option<Inertia> {
    let tensor = mass * Matrix3::from_diagonal(moments);
    (mass > 0.0).then_some(Inertia { mass, center: Vector3::zeros(), tensor })
}

/// Sums of two squares each, divided.
fn across(half: Vector3<f64>, by: f64) -> Vector3<f64> {
    let square = half.component_mul(&half);
    Vector3::new(square.y + square.z, square.x + square.z, square.x + square.y) / by
}

fn round(across: f64, along: f64) -> Vector3<f64> {
    Vector3::new(across, across, along)
}
