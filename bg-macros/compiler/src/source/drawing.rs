//! What a mechanism looks like: its bodies with their solids and points, its joints with their forces.
//!
//! In: nothing. Out: a [`Drawing`] of whatever stands for a quantity in a stage: an expression of the tree, a term, the
//! scalars of the equations, a place in a table. The mechanism words fill it; a graph in bond-graph words has an empty
//! one.

use super::ast::Axis;

/// A mechanism's look. `T` is a quantity, of a shape that its place fixes.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing<T> {
    /// Bodies in the order of declaration.
    pub bodies: Vec<Body<T>>,
    /// Named points of the ground, inertial axes, m.
    pub ground: Vec<Point<T>>,
    /// The acceleration of gravity, inertial axes, m/s^2; none where there is no gravity.
    pub gravity: Option<T>,
    /// Joints, springs and contacts in the order of declaration.
    pub joints: Vec<Joint<T>>,
}

/// A body. Its own axes begin at the centre of mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Body<T> {
    /// Its name.
    pub name: String,
    /// The centre of mass, inertial axes, m.
    pub position: T,
    /// The rotation matrix from the body's axes to inertial ones, by rows.
    pub orientation: T,
    /// What it is made of; none where mass and inertia are given.
    pub solids: Vec<Solid<T>>,
    /// Named points in the body's axes, m.
    pub points: Vec<Point<T>>,
}

/// A solid of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid<T> {
    /// Its form.
    pub shape: Shape<T>,
    /// Its centre in the body's axes, m.
    pub center: T,
    /// The rotation matrix from its own axes to the body's, by rows; none where they are the same.
    pub turned: Option<T>,
}

/// A solid's form.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<T> {
    /// Its edges along the solid's axes, m.
    Cuboid(T),
    /// A circular cylinder.
    Cylinder {
        /// Radius, m.
        radius: T,
        /// Length along the axis, m.
        length: T,
        /// The axis.
        axis: Axis,
    },
    /// Its radius, m.
    Sphere(T),
}

/// A named point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point<T> {
    /// Its name.
    pub name: String,
    /// Where it is, m.
    pub place: T,
}

/// What acts between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint<T> {
    /// Its name.
    pub name: String,
    /// Its word, such as `revolute z`, `spring` or `contact`.
    pub word: String,
    /// Its ends as written, such as `ground.O2` and `crank.O`.
    pub ends: [String; 2],
    /// Where these are, inertial axes, m.
    pub places: [T; 2],
    /// The force on the second body at the second end (of a contact at the first), inertial axes, N.
    pub force: T,
    /// The moment on the second body, inertial axes, N*m; none where there cannot be any.
    pub moment: Option<T>,
}

impl<T> Default for Drawing<T> {
    fn default() -> Self {
        Self { bodies: Vec::new(), ground: Vec::new(), gravity: None, joints: Vec::new() }
    }
}

impl<T> Drawing<T> {
    /// The same with other quantities, made in a fixed order.
    pub fn map<'d, U>(&'d self, make: &mut impl FnMut(&'d T) -> U) -> Drawing<U> {
        Drawing {
            bodies: self.bodies.iter().map(|body| body.map(make)).collect(),
            ground: points(&self.ground, make),
            gravity: self.gravity.as_ref().map(&mut *make),
            joints: self.joints.iter().map(|joint| joint.map(make)).collect(),
        }
    }
}

impl<T> Body<T> {
    fn map<'d, U>(&'d self, make: &mut impl FnMut(&'d T) -> U) -> Body<U> {
        Body {
            name: self.name.clone(),
            position: make(&self.position),
            orientation: make(&self.orientation),
            solids: self.solids.iter().map(|solid| solid.map(make)).collect(),
            points: points(&self.points, make),
        }
    }
}

impl<T> Solid<T> {
    fn map<'d, U>(&'d self, make: &mut impl FnMut(&'d T) -> U) -> Solid<U> {
        Solid { shape: self.shape.map(make), center: make(&self.center), turned: self.turned.as_ref().map(make) }
    }
}

impl<T> Shape<T> {
    /// The same with other quantities.
    pub fn map<'d, U>(&'d self, make: &mut impl FnMut(&'d T) -> U) -> Shape<U> {
        match self {
            Self::Cuboid(edges) => Shape::Cuboid(make(edges)),
            Self::Cylinder { radius, length, axis } => {
                Shape::Cylinder { radius: make(radius), length: make(length), axis: *axis }
            }
            Self::Sphere(radius) => Shape::Sphere(make(radius)),
        }
    }
}

impl<T> Joint<T> {
    fn map<'d, U>(&'d self, make: &mut impl FnMut(&'d T) -> U) -> Joint<U> {
        let [first, second] = &self.places;
        Joint {
            name: self.name.clone(),
            word: self.word.clone(),
            ends: self.ends.clone(),
            places: [make(first), make(second)],
            force: make(&self.force),
            moment: self.moment.as_ref().map(make),
        }
    }
}

fn points<'d, T, U>(of: &'d [Point<T>], make: &mut impl FnMut(&'d T) -> U) -> Vec<Point<U>> {
    of.iter().map(|point| Point { name: point.name.clone(), place: make(&point.place) }).collect()
}
