//! What a robot is, whatever described it: links with masses, joints with frames. SI units.

use nalgebra::{Matrix3, Rotation3, Vector3};

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
    /// kg, not negative.
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

    /// The edges of the box that has this mass and these moments, along principal axes, m.
    #[must_use]
    pub fn box_edges(&self, axes: &Matrix3<f64>) -> Vector3<f64> {
        let moments = (axes.transpose() * self.tensor * axes).diagonal();
        let sum = moments.sum();
        moments.map(|moment| (6.0 * (sum - 2.0 * moment).max(0.0) / self.mass).sqrt())
    }

    /// Two in one (Steiner).
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let weighted = self.mass * self.center + other.mass * other.center;
        let center = if mass > 0.0 { weighted / mass } else { self.center };
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
    /// None where it has neither mass nor moments.
    pub inertia: Option<Inertia>,
    /// The links that were made one with it.
    pub merged: Vec<String>,
    /// Masses whose weight does not act, kg, and where they are in the link's frame: gravity compensation.
    pub lifts: Vec<(f64, Vector3<f64>)>,
    /// What a fluid does to it.
    pub drags: Vec<Drag>,
}

impl Link {
    /// A link of this name and no mass.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), inertia: None, merged: Vec::new(), lifts: Vec::new(), drags: Vec::new() }
    }
}

/// What a fluid does to a body, along three axes: a force -(f0 + f1 a |v|) v at a place, a torque -(t0 + t1 b |w|) w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// In the link's frame, m.
    pub place: Vector3<f64>,
    /// The three axes, in the link's frame.
    pub axes: Matrix3<f64>,
    /// f0 and f1: N s/m, kg/m^3.
    pub force: [f64; 2],
    /// a, m^2.
    pub areas: Vector3<f64>,
    /// t0 and t1: N m s, kg/m^3.
    pub torque: [f64; 2],
    /// b, m^5.
    pub turns: Vector3<f64>,
}

/// An odd law of a displacement or speed: c0 x + c1 x |x| + c2 x^3. SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Law(pub [f64; 3]);

impl Law {
    /// Whether it gives anything.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.0 == [0.0; 3]
    }

    /// Whether it is a number times its variable.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.0[1..] == [0.0; 2]
    }
}

/// A spring on a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Effort from how far it is from its rest.
    pub law: Law,
    /// The angle or travel at which it is loose, rad or m.
    pub rest: f64,
}

/// Which motion a joint leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
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
    pub kind: JointKind,
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
    /// Effort from the speed. Of a free joint it acts on the velocity of the link's origin, and on its angular
    /// velocity; of a spherical one on the relative angular velocity.
    pub damping: Law,
    /// Dry friction, N m or N, not negative.
    pub friction: f64,
    /// Inertia of what turns with the joint, such as a rotor, kg m^2 or kg, not negative.
    pub armature: f64,
    /// A spring.
    pub spring: Option<Spring>,
    /// The least and the most angle or travel, rad or m; one of the two may be infinite.
    pub limits: Option<(f64, f64)>,
    /// The most effort that what drives it gives, N m or N.
    pub effort: Option<f64>,
    /// Angle or travel at the start, rad or m.
    pub start: f64,
}

impl Joint {
    /// A joint with nothing on it.
    #[must_use]
    pub fn new(name: &str, kind: JointKind, (parent, child): (usize, usize), in_parent: Pose) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            parent,
            child,
            in_parent,
            in_child: Pose::identity(),
            axis: Vector3::z(),
            damping: Law::default(),
            friction: 0.0,
            armature: 0.0,
            spring: None,
            limits: None,
            effort: None,
            start: 0.0,
        }
    }

    /// Whether nothing but the motion itself is known of it.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        let is_free = self.damping.is_zero() && self.friction == 0.0 && self.armature == 0.0;
        is_free && self.spring.is_none() && self.limits.is_none() && self.effort.is_none()
    }

    /// Whether it has an angle or a travel of its own.
    #[must_use]
    pub fn is_scalar(&self) -> bool {
        matches!(self.kind, JointKind::Revolute | JointKind::Prismatic)
    }
}

/// What closes a loop: two links that are held together beside the tree.
#[derive(Clone, Debug)]
pub struct Loop {
    /// As in the file, or made of the links' names.
    pub name: String,
    /// Which motion it leaves; of a revolute or prismatic one about or along z of both frames.
    pub kind: JointKind,
    /// The links, and the frame in each.
    pub ends: [(usize, Pose); 2],
}

/// A joint whose angle or travel another one determines.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// The index of the joint that follows.
    pub follower: usize,
    /// The index of the joint that leads.
    pub leader: usize,
    /// The follower's angle or travel is c0 + c1 q + c2 q^2 + .. of the leader's; rad and m.
    pub polynomial: [f64; 5],
}

impl Coupling {
    /// The follower's angle or travel where the leader's is q.
    #[must_use]
    pub fn at(&self, q: f64) -> f64 {
        self.polynomial.iter().rev().fold(0.0, |sum, coefficient| sum * q + coefficient)
    }

    /// The change of the follower with the leader's q, in the same form.
    #[must_use]
    pub fn slope(&self) -> [f64; 4] {
        let [_, first, second, third, fourth] = self.polynomial;
        [first, 2.0 * second, 3.0 * third, 4.0 * fourth]
    }

    /// Whether a fixed ratio joins the two.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.polynomial[2..] == [0.0; 3]
    }
}

/// A sum of joints' angles and travels, each times a factor: of one joint, or of a tendon.
#[derive(Clone, Debug, Default)]
pub struct Length {
    /// Joints by their index, and the length for each rad or m of it.
    pub parts: Vec<(usize, f64)>,
    /// The length where all joints are at 0, in the file's count.
    pub constant: f64,
}

impl Length {
    /// How much longer it is where joints are at these values.
    #[must_use]
    pub fn at(&self, joints: &[Joint]) -> f64 {
        self.parts.iter().map(|&(joint, each)| each * joints[joint].start).sum()
    }

    /// The same times a factor.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let parts = self.parts.iter().map(|&(joint, each)| (joint, factor * each)).collect();
        Self { parts, constant: factor * self.constant }
    }

    /// The same with the joints at other places; none where one of them is not there any more.
    fn moved(&self, places: &[Option<usize>]) -> Option<Self> {
        let parts = self.parts.iter().map(|&(joint, each)| Some((places[joint]?, each))).collect::<Option<_>>()?;
        Some(Self { parts, constant: self.constant })
    }
}

/// A fixed tendon: what acts along a sum of joints' angles and travels. Lengths count from the file's pose.
#[derive(Clone, Debug)]
pub struct Tendon {
    /// As in the file, or made of a number.
    pub name: String,
    /// Which joints it pulls.
    pub length: Length,
    /// Force from how far it is from the least length at which it is loose.
    pub spring: Option<Spring>,
    /// How much longer it is loose.
    pub slack: f64,
    /// Force from the speed of its length.
    pub damping: Law,
    /// Dry friction, not negative.
    pub friction: f64,
    /// The least and the most length.
    pub limits: Option<(f64, f64)>,
}

impl Tendon {
    /// Whether anything acts along it.
    #[must_use]
    pub fn acts(&self) -> bool {
        let has_any = self.spring.is_some() || !self.damping.is_zero() || self.friction > 0.0 || self.limits.is_some();
        has_any && !self.length.parts.is_empty()
    }
}

/// What drives joints by a control u: a force f = (g0 + g1 l + g2 l') u + b0 + b1 l + b2 l' within a range, along a
/// length l.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// As in the file, or made of the joint's name.
    pub name: String,
    /// What it pulls along.
    pub length: Length,
    /// Force for each unit of the control: constant, for each unit of length, for each unit of its speed.
    pub gain: [f64; 3],
    /// Force without a control, in the same order.
    pub bias: [f64; 3],
    /// The least and the most control.
    pub control: Option<(f64, f64)>,
    /// The least and the most force.
    pub force: Option<(f64, f64)>,
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
    /// How fast the fluid moves, m/s.
    pub wind: Vector3<f64>,
    /// The ground and all that moves.
    pub links: Vec<Link>,
    /// A joint for each link but the ground; parents first.
    pub joints: Vec<Joint>,
    /// What closes loops.
    pub loops: Vec<Loop>,
    /// Joints that follow others.
    pub couplings: Vec<Coupling>,
    /// What acts along several joints.
    pub tendons: Vec<Tendon>,
    /// What drives joints; without any each joint has an input of its own.
    pub actuators: Vec<Actuator>,
    /// What is other than in the file, a sentence each.
    pub notes: Vec<String>,
    /// In which way the file's robot is described, where that is not plain; nothing is lost by it.
    pub remarks: Vec<String>,
}

impl Robot {
    /// A robot of the ground alone.
    #[must_use]
    pub fn new(name: &str, format: &'static str) -> Self {
        Self {
            name: name.to_owned(),
            format,
            gravity: Vector3::new(0.0, 0.0, -9.81),
            wind: Vector3::zeros(),
            links: vec![Link::new("ground")],
            joints: Vec::new(),
            loops: Vec::new(),
            couplings: Vec::new(),
            tendons: Vec::new(),
            actuators: Vec::new(),
            notes: Vec::new(),
            remarks: Vec::new(),
        }
    }

    /// All lengths along which something acts.
    pub fn lengths(&self) -> impl Iterator<Item = &Length> {
        let tendons = self.tendons.iter().map(|tendon| &tendon.length);
        tendons.chain(self.actuators.iter().map(|actuator| &actuator.length))
    }

    /// The joints that each link carries.
    #[must_use]
    pub fn carried(&self) -> Vec<Vec<usize>> {
        let mut carried = vec![Vec::new(); self.links.len()];
        for (index, joint) in self.joints.iter().enumerate() {
            carried[joint.parent].push(index);
        }
        carried
    }

    /// Keeps some of the joints, the couplings between them and what drives them.
    pub fn keep_joints(&mut self, keeps: &[bool]) {
        let mut left = 0;
        let places: Vec<Option<usize>> = keeps
            .iter()
            .map(|&keeps| {
                left += usize::from(keeps);
                keeps.then(|| left - 1)
            })
            .collect();
        let mut keep = keeps.iter();
        self.joints.retain(|_| keep.next() == Some(&true));
        let moved = |coupling: &Coupling| {
            let (follower, leader) = (places[coupling.follower]?, places[coupling.leader]?);
            Some(Coupling { follower, leader, polynomial: coupling.polynomial })
        };
        self.couplings = self.couplings.iter().filter_map(moved).collect();
        let moved =
            |actuator: &Actuator| Some(Actuator { length: actuator.length.moved(&places)?, ..actuator.clone() });
        self.actuators = self.actuators.iter().filter_map(moved).collect();
        let (kept, lost): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.tendons).into_iter().partition(|tendon| tendon.length.moved(&places).is_some());
        let moved = |tendon: Tendon| Tendon { length: tendon.length.moved(&places).unwrap_or_default(), ..tendon };
        self.tendons = kept.into_iter().map(moved).collect();
        let note = |tendon: &Tendon| format!("Tendon `{}` is left out with a joint that it pulls.", tendon.name);
        self.notes.extend(lost.iter().map(note));
    }
}

/// The shortest rotation that takes z to a direction.
#[must_use]
pub fn with_z(direction: &Vector3<f64>) -> Matrix3<f64> {
    let half_turn = || Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    Rotation3::rotation_between(&Vector3::z(), direction).unwrap_or_else(half_turn).into_inner()
}
