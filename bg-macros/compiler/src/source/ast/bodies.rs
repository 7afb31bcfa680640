//! The ground and rigid bodies with their points, loads and looks.

use proc_macro2::Span;

use crate::source::ast::{Expression, Name};

/// The inertial frame's named points.
#[derive(Clone, Debug)]
pub struct Ground {
    /// The word's span.
    pub span: Span,
    /// Points in inertial axes, m.
    pub points: Vec<Point>,
}

/// A named point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name (no dots).
    pub name: Name,
    /// Its place in the body's axes from the body's origin, m.
    pub place: Expression,
    /// `turned E`: the rotation matrix from the point's axes to the body's, whose axes joints at the point have then.
    pub turned: Option<Expression>,
}

/// The gravity field.
#[derive(Clone, Debug)]
pub struct Gravity {
    /// The word's span.
    pub span: Span,
    /// The acceleration, inertial axes, m/s^2.
    pub acceleration: Expression,
}

/// How rigid joints are kept: by Baumgarte's terms in place of projection.
#[derive(Clone, Debug)]
pub struct Baumgarte {
    /// The word's span.
    pub span: Span,
    /// The rate at which gaps decay, 1/s.
    pub rate: Expression,
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: Name,
    /// What it is made of; empty when the mass properties are given.
    pub solids: Vec<Solid>,
    /// `density E;` of all solids without one of their own, kg/m^3.
    pub density: Option<Expression>,
    /// `mass E;`, kg.
    pub mass: Option<Expression>,
    /// `center E;` the centre of mass in the body's axes, m.
    pub center: Option<Expression>,
    /// `inertia E;` about the centre of mass in the body's axes, kg*m^2: three principal moments or a matrix.
    pub inertia: Option<Expression>,
    /// Named points.
    pub points: Vec<Point>,
    /// `start at E;` or `start POINT at E;`: the place of the body's origin, or of a point, at t = 0, m.
    pub start_position: Option<(Option<Name>, Expression)>,
    /// `start turned E;` the rotation matrix body to inertial at t = 0.
    pub start_orientation: Option<Expression>,
    /// `start velocity E;` of the centre of mass, inertial axes, m/s.
    pub start_velocity: Option<Expression>,
    /// `start spin E;` the angular velocity, inertial axes, rad/s.
    pub start_spin: Option<Expression>,
}

/// A solid of a body.
#[derive(Clone, Debug)]
pub struct Solid {
    /// What it is.
    pub shape: Shape,
    /// `at E`: its centre in the body's axes, m; the origin when left out.
    pub at: Option<Expression>,
    /// `turned E`: its orientation in the body's axes; the identity when left out.
    pub turned: Option<Expression>,
    /// `density E`, kg/m^3.
    pub density: Option<Expression>,
    /// The word's span.
    pub span: Span,
}

/// A solid's form.
#[derive(Clone, Debug)]
pub enum Shape {
    /// `cuboid [x, y, z]`: edges along the solid's own axes, m.
    Cuboid(Expression),
    /// `cylinder radius E length E along z`, m.
    Cylinder {
        /// Radius, m.
        radius: Expression,
        /// Length along the axis, m.
        length: Expression,
        /// The axis.
        axis: Axis,
    },
    /// `sphere radius E`, m.
    Sphere(Expression),
}

/// An axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own letters")]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The next axis in cyclic order.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::Z,
            Self::Z => Self::X,
        }
    }
}
