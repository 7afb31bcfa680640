//! What a robot is, whatever described it: links with masses, joints with frames. SI units.

use nalgebra::{Matrix3, Vector3};

/// Where a frame is in another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// From its axes to those of the other frame.
    pub turned: Matrix3<f64>,
    /// Its origin, m.
    pub place: Vector3<f64>,
}

impl Pose {
    /// The same frame.
    #[must_use]
    pub fn identity() -> Self {
        Self { turned: Matrix3::identity(), place: Vector3::zeros() }
    }

    /// A frame with the same axes at another place.
    #[must_use]
    pub fn at(place: Vector3<f64>) -> Self {
        Self { place, ..Self::identity() }
    }

    /// A frame that is given in this one, in the frame that this one is given in.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        Self { turned: self.turned * inner.turned, place: self.place + self.turned * inner.place }
    }

    /// The other frame in this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let back = self.turned.transpose();
        Self { turned: back, place: -(back * self.place) }
    }

    /// The same origin, with axes that are given in this one.
    #[must_use]
    pub fn with_axes(&self, axes: &Matrix3<f64>) -> Self {
        Self { turned: self.turned * axes, place: self.place }
    }
}

/// How heavy a link is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// kg, above 0.
    pub mass: f64,
    /// The centre of mass in the link's frame, m.
    pub center: Vector3<f64>,
    /// About the centre of mass, in the link's axes, kg m^2.
    pub tensor: Matrix3<f64>,
}

impl Inertia {
    /// The same, as seen from a frame in which the present one is given.
    #[must_use]
    pub fn seen_from(&self, frame: &Pose) -> Self {
        let tensor = frame.turned * self.tensor * frame.turned.transpose();
        Self { mass: self.mass, center: frame.place + frame.turned * self.center, tensor }
    }

    /// Two in one (Steiner).
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let center = (self.mass * self.center + other.mass * other.center) / mass;
        let about = |part: &Self| {
            let arm = part.center - center;
            part.tensor + part.mass * (arm.norm_squared() * Matrix3::identity() - arm * arm.transpose())
        };
        Self { mass, center, tensor: about(self) + about(other) }
    }
}

/// A rigid piece.
#[derive(Clone, Debug)]
pub struct Link {
    /// As in the file.
    pub name: String,
    /// None where it has no mass.
    pub inertia: Option<Inertia>,
    /// The links that were made one with it.
    pub merged: Vec<String>,
}

/// Which motion a joint leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// None.
    Fixed,
    /// All.
    Free,
    /// Rotation about the axis.
    Revolute,
    /// Translation along the axis.
    Prismatic,
    /// Rotation about and translation along the axis.
    Cylindrical,
    /// Rotation about x of the parent's frame and y of the child's.
    Universal,
    /// All rotations.
    Spherical,
}

/// What holds a link on its parent. In the robot's start pose, with all starts 0, the two frames are one.
#[derive(Clone, Debug)]
pub struct Joint {
    /// As in the file.
    pub name: String,
    /// Which motion it leaves.
    pub kind: Kind,
    /// The index of the link that carries.
    pub parent: usize,
    /// The index of the link that is carried.
    pub child: usize,
    /// Its frame in the parent.
    pub in_parent: Pose,
    /// Its frame in the child.
    pub in_child: Pose,
    /// A unit vector in its frame: of a positive rotation or travel of the child.
    pub axis: Vector3<f64>,
    /// N m s/rad or N s/m, not negative.
    pub damping: f64,
    /// Dry friction, N m or N, not negative.
    pub friction: f64,
    /// Inertia of what turns with the joint, such as a rotor, kg m^2 or kg, not negative.
    pub armature: f64,
    /// A spring: N m/rad or N/m, and the angle or travel at which it is loose.
    pub spring: Option<(f64, f64)>,
    /// The least and the most angle or travel, rad or m.
    pub limits: Option<(f64, f64)>,
    /// Angle or travel at the start, rad or m.
    pub start: f64,
}

impl Joint {
    /// A joint with nothing on it.
    #[must_use]
    pub fn new(name: &str, kind: Kind, (parent, child): (usize, usize), in_parent: Pose) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            parent,
            child,
            in_parent,
            in_child: Pose::identity(),
            axis: Vector3::z(),
            damping: 0.0,
            friction: 0.0,
            armature: 0.0,
            spring: None,
            limits: None,
            start: 0.0,
        }
    }

    /// Whether it has an angle or a travel of its own.
    #[must_use]
    pub fn is_scalar(&self) -> bool {
        matches!(self.kind, Kind::Revolute | Kind::Prismatic)
    }
}

/// What closes a loop: two links that are held together beside the tree.
#[derive(Clone, Debug)]
pub struct Loop {
    /// As in the file, or made of the links' names.
    pub name: String,
    /// Rotations are held, too.
    pub holds_rotation: bool,
    /// The links, and the frame in each.
    pub ends: [(usize, Pose); 2],
}

/// A tree of links. The first link is the ground.
#[derive(Clone, Debug)]
pub struct Robot {
    /// As in the file.
    pub name: String,
    /// What described it.
    pub format: &'static str,
    /// m/s^2.
    pub gravity: Vector3<f64>,
    /// The ground and all that moves.
    pub links: Vec<Link>,
    /// A joint for each link but the ground; parents first.
    pub joints: Vec<Joint>,
    /// What closes loops.
    pub loops: Vec<Loop>,
    /// What is other than in the file, a sentence each.
    pub notes: Vec<String>,
}
