//! What pictures show of a model beside its outputs: the solids of its bodies and how they move, the forces of its
//! joints, effort and flow of every bond.
//!
//! In: the tables that the compiler left in a model's description. Out: where each quantity stands among the values
//! that [`Model::shown`](crate::system::Model::shown) gives at a time and a state. A scene that leaves out a state does
//! not know what depends on it: such a quantity has no place.

mod tape;

pub use tape::{Moment, Tape};

/// The place of a quantity's first component among the values; a matrix has nine, by rows. None where it is not known.
pub type Place = Option<usize>;

/// A model's look.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Bodies in the order of declaration.
    pub bodies: &'static [Body],
    /// Named points of the ground, inertial axes, m.
    pub ground: &'static [Point],
    /// The acceleration of gravity, inertial axes, m/s^2; none where there is no gravity.
    pub gravity: Option<Place>,
    /// Joints, springs and contacts in the order of declaration.
    pub joints: &'static [Joint],
    /// Effort and flow of each bond of the description's table.
    pub bonds: &'static [[Place; 2]],
    /// What gives the values.
    pub tape: Tape,
}

/// A rigid body. Its own axes begin at the centre of mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: &'static str,
    /// The centre of mass, inertial axes, m.
    pub position: Place,
    /// The rotation matrix from the body's axes to inertial ones.
    pub orientation: Place,
    /// The states that its pose depends on, by their numbers in the state vector.
    pub states: &'static [usize],
    /// What it is made of; none where mass and inertia are given.
    pub solids: &'static [Solid],
    /// Named points in the body's axes, m.
    pub points: &'static [Point],
}

/// A solid of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its form.
    pub shape: Shape,
    /// Its centre in the body's axes, m.
    pub center: Place,
    /// The rotation matrix from its own axes to the body's; none where they are the same.
    pub turned: Option<Place>,
}

/// A solid's form.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Its three edges along the solid's axes, m.
    Cuboid(Place),
    /// A circular cylinder.
    Cylinder {
        /// Radius, m.
        radius: Place,
        /// Length along the axis, m.
        length: Place,
        /// The axis: 0, 1 or 2.
        axis: usize,
    },
    /// Its radius, m.
    Sphere(Place),
}

/// A named point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its name.
    pub name: &'static str,
    /// Where it is, m.
    pub place: Place,
}

/// What acts between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: &'static str,
    /// Its word, such as `revolute z`, `spring` or `contact`.
    pub word: &'static str,
    /// Its ends as written, such as `ground.O2` and `crank.O`.
    pub ends: [&'static str; 2],
    /// Where these are, inertial axes, m.
    pub places: [Place; 2],
    /// The force on the second body, inertial axes, N. It acts at the second end, of a contact at the first.
    pub force: Place,
    /// The moment on the second body, inertial axes, N*m; none where there cannot be any.
    pub moment: Option<Place>,
}
