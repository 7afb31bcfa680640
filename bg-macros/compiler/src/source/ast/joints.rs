//! What is between bodies: joints, springs, drives, contacts, friction, stops, orifices; and the laws of their axes.

use proc_macro2::Span;

use crate::source::ast::{Axis, ElementKind, Expression, LawVariable, Name};

/// A joint's freedoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about one axis.
    Revolute(Axis),
    /// Slides along one axis.
    Prismatic(Axis),
    /// Turns about a point.
    Spherical,
    /// Turns about and slides along one axis.
    Cylindrical(Axis),
    /// Turns about an axis of the first body and a perpendicular one of the second.
    Universal(Axis, Axis),
    /// No freedom.
    Fixed,
}

/// The two ends of a joint, spring or contact: `(a.P -> b.Q)`; names with one dot, or a body's name for its origin.
#[derive(Clone, Debug)]
pub struct Ends {
    /// The first end.
    pub from: Name,
    /// The second end: forces and relative motions are those of this end.
    pub to: Name,
}

/// A compliant joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: Name,
    /// Its freedoms.
    pub kind: JointKind,
    /// What it joins.
    pub ends: Ends,
    /// `stiffness E;` of the held translations, N/m: one number, or one per axis.
    pub stiffness: Option<Expression>,
    /// `damping E;`, N*s/m.
    pub damping: Option<Expression>,
    /// `tilt stiffness E;` of the held rotations, N*m/rad.
    pub tilt_stiffness: Option<Expression>,
    /// `tilt damping E;`, N*m*s/rad.
    pub tilt_damping: Option<Expression>,
    /// `clearance E;` how far a pin can move from the middle of its hole, or a slider across its guide, m.
    pub clearance: Option<Expression>,
    /// `length E;` of a slider with a clearance: how far apart the places are at which it touches, m.
    pub length: Option<Expression>,
    /// `exponent E;` and its like: how a joint with a clearance pushes, but for its stiffness and its damping.
    pub play: PressLaw,
    /// `frame inertial;`: held rotations are the integrals of the relative angular velocity in inertial axes.
    pub inertial: bool,
    /// `rigid;`: an ideal joint, without stiffness and damping; its reactions keep the held motions zero.
    pub rigid: bool,
}

impl Joint {
    /// How it pushes where its clearance is used up.
    #[must_use]
    pub fn press_law(&self) -> PressLaw {
        PressLaw { stiffness: self.stiffness.clone(), damping: self.damping.clone(), ..self.play.clone() }
    }
}

/// A spring and damper along the line between two points.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Its name.
    pub name: Name,
    /// What it joins.
    pub ends: Ends,
    /// `stiffness E;`, N/m.
    pub stiffness: Option<Expression>,
    /// `damping E;`, N*s/m.
    pub damping: Option<Expression>,
    /// `length E;` unloaded, m.
    pub length: Option<Expression>,
}

/// What a drive prescribes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// `torque = E`, N*m.
    Torque,
    /// `force = E`, N.
    Force,
    /// `speed = E { stiffness E; damping E; }`, rad/s or m/s.
    Speed,
}

/// A source on a joint's free axis, on a body or on a body's point.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Its name.
    pub name: Name,
    /// A joint, a body, or a point of a body.
    pub target: Name,
    /// What it prescribes.
    pub kind: DriveKind,
    /// Its value.
    pub value: Expression,
    /// `stiffness E;` of a speed drive's coupling.
    pub stiffness: Option<Expression>,
    /// `damping E;` of a speed drive's coupling.
    pub damping: Option<Expression>,
}

/// A sliding contact: a point of the first body slides along a line of the second.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// What touches.
    pub ends: Ends,
    /// The direction of the line in the second body's axes.
    pub along: Axis,
    /// The laws per axis of the second body.
    pub laws: Vec<AxisLaw>,
}

/// A contact of two shapes, which push each other and never pull.
#[derive(Clone, Debug)]
pub struct ShapeContact {
    /// Its name.
    pub name: Name,
    /// Where the shapes are.
    pub ends: Ends,
    /// What they are.
    pub shapes: [Touching; 2],
    /// How they push.
    pub law: PressLaw,
    /// `rigid;`: they do not give way, and part at once with the `restitution`.
    pub rigid: bool,
}

/// How what touches pushes.
#[derive(Clone, Debug, Default)]
pub struct PressLaw {
    /// `stiffness E;` N/m, with an exponent n N/m^n.
    pub stiffness: Option<Expression>,
    /// `exponent E;` of the depth; 1 when left out.
    pub exponent: Option<Expression>,
    /// `damping E;` N*s/m.
    pub damping: Option<Expression>,
    /// `dissipation E;` by how much a speed raises the force, s/m.
    pub dissipation: Option<Expression>,
    /// `restitution E;` the part of the speed with which what hits parts.
    pub restitution: Option<Expression>,
    /// `rest below E;` the speed of approach below which what hits counts as that fast, m/s.
    pub rest: Option<Expression>,
}

impl PressLaw {
    /// Those of its clauses that a joint has with a clearance only.
    pub fn play_mut(&mut self) -> [(&'static str, &mut Option<Expression>); 4] {
        let Self { exponent, dissipation, restitution, rest, .. } = self;
        [("exponent", exponent), ("dissipation", dissipation), ("restitution", restitution), ("rest below", rest)]
    }

    /// Its clauses in the order in which they are printed.
    pub fn clauses_mut(&mut self) -> [(&'static str, &mut Option<Expression>); 6] {
        let Self { stiffness, exponent, damping, dissipation, restitution, rest } = self;
        [
            ("stiffness", stiffness),
            ("exponent", exponent),
            ("damping", damping),
            ("dissipation", dissipation),
            ("restitution", restitution),
            ("rest below", rest),
        ]
    }
}

/// A shape that touches another one.
#[derive(Clone, Debug)]
pub enum Touching {
    /// The end itself.
    Point,
    /// `circle E`: in the plane across the end's z axis, radius in m.
    Circle(Expression),
    /// `hole E`: the inside of a circle, or around a sphere of one, radius in m.
    Hole(Expression),
    /// `sphere E`: radius in m.
    Sphere(Expression),
    /// `line x`: along an axis of the end; what is free is to its left, seen from where z points to.
    Line(Axis),
    /// `plane z`: through the end, with this outward normal.
    Plane(Axis),
    /// `segment x E`: a thin wall from the end along an axis of it, with this length in m; both sides and ends are
    /// free.
    Segment(Axis, Expression),
    /// `slot x E width E`: the inside of what a circle of this width covers on its way along a segment.
    Slot(Axis, [Expression; 2]),
    /// `arc E from E to E`: a thin wall on a circle around the end, between two angles about its z axis from its x
    /// axis.
    Arc([Expression; 3]),
    /// `profile TABLE`: the distance of the outline by the angle about the end's z axis, or its height over the x axis.
    Profile(Name),
}

impl Touching {
    /// Its word.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Circle(_) => "circle",
            Self::Hole(_) => "hole",
            Self::Sphere(_) => "sphere",
            Self::Line(_) => "line",
            Self::Plane(_) => "plane",
            Self::Segment(..) => "segment",
            Self::Slot(..) => "slot",
            Self::Arc(_) => "arc",
            Self::Profile(_) => "profile",
        }
    }

    /// Its sizes, each with the word that stands before it, or what it is where there is none.
    #[must_use]
    pub fn sizes(&self) -> Vec<(&'static str, &Expression)> {
        match self {
            Self::Circle(radius) | Self::Hole(radius) | Self::Sphere(radius) => vec![("radius", radius)],
            Self::Segment(_, length) => vec![("length", length)],
            Self::Slot(_, [length, width]) => vec![("length", length), ("width", width)],
            Self::Arc([radius, from, to]) => vec![("radius", radius), ("from", from), ("to", to)],
            Self::Point | Self::Line(_) | Self::Plane(_) | Self::Profile(_) => Vec::new(),
        }
    }

    /// The same to be changed.
    pub fn sizes_mut(&mut self) -> &mut [Expression] {
        match self {
            Self::Circle(size) | Self::Hole(size) | Self::Sphere(size) | Self::Segment(_, size) => {
                std::slice::from_mut(size)
            }
            Self::Slot(_, sizes) => sizes,
            Self::Arc(sizes) => sizes,
            Self::Point | Self::Line(_) | Self::Plane(_) | Self::Profile(_) => &mut [],
        }
    }

    /// Whether it touches in space, and not in a plane.
    #[must_use]
    pub fn is_in_space(&self) -> bool {
        matches!(self, Self::Sphere(_) | Self::Plane(_))
    }

    /// Of two shapes the one with the lower rank has the axes in which they meet.
    #[must_use]
    pub fn rank(&self) -> usize {
        match self {
            Self::Profile(_) => 0,
            Self::Line(_) | Self::Plane(_) | Self::Segment(..) | Self::Slot(..) | Self::Arc(_) => 1,
            Self::Hole(_) => 2,
            Self::Circle(_) | Self::Sphere(_) => 3,
            Self::Point => 4,
        }
    }
}

/// Dry friction on a free axis, along a contact's line or at a junction.
#[derive(Clone, Debug)]
pub struct Friction {
    /// Its name (no dots).
    pub name: Name,
    /// A joint, a contact, or a junction.
    pub target: Name,
    /// `coulomb E;` while it slides: an effort, or a coefficient where the normal force is known.
    pub coulomb: Option<Expression>,
    /// `static E;` up to which it sticks, alike; that of sliding when left out.
    pub at_rest: Option<Expression>,
    /// `stribeck E;` the speed over which the one falls to the other.
    pub stribeck: Option<Expression>,
    /// `viscous E;` effort per flow.
    pub viscous: Option<Expression>,
    /// `normal E;` the normal force, N.
    pub normal: Option<Expression>,
    /// `radius E;` at which it acts on a turning axis, m.
    pub radius: Option<Expression>,
    /// `creep E;` the speed that regularises the law: it does not stick.
    pub creep: Option<Expression>,
    /// `stiffness E;` of the spring by which it sticks where shapes touch in space, N/m.
    pub stiffness: Option<Expression>,
}

impl Friction {
    /// A friction without clauses.
    #[must_use]
    pub fn new(name: Name, target: Name) -> Self {
        Self {
            name,
            target,
            coulomb: None,
            at_rest: None,
            stribeck: None,
            viscous: None,
            normal: None,
            radius: None,
            creep: None,
            stiffness: None,
        }
    }
}

/// The ends of a free axis or of a junction's displacement: one-sided springs with dampers, or rigid with a coefficient
/// of restitution.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Its name (no dots).
    pub name: Name,
    /// A joint or a junction.
    pub target: Name,
    /// `at least E;` the lower end.
    pub least: Option<Expression>,
    /// `at most E;` the upper end.
    pub most: Option<Expression>,
    /// `stiffness E;`
    pub stiffness: Option<Expression>,
    /// `damping E;`
    pub damping: Option<Expression>,
    /// `restitution E;` in the place of stiffness and damping: the part of its speed with which something leaves that
    /// hits it.
    pub restitution: Option<Expression>,
    /// `rest below E;` the speed of a rebound below which it rests.
    pub rest: Option<Expression>,
    /// `start E;` the displacement at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

impl Stop {
    /// A stop without clauses.
    #[must_use]
    pub fn new(name: Name, target: Name) -> Self {
        Self {
            name,
            target,
            least: None,
            most: None,
            stiffness: None,
            damping: None,
            restitution: None,
            rest: None,
            start: None,
        }
    }
}

/// A sharp edge that a fluid flows through: the flow goes with the square root of the pressure.
#[derive(Clone, Debug)]
pub struct Orifice {
    /// Its name (no dots).
    pub name: Name,
    /// A hydraulic 1-junction.
    pub target: Name,
    /// `area E;`, m^2.
    pub area: Option<Expression>,
    /// `coefficient E;` of discharge.
    pub coefficient: Option<Expression>,
    /// `density E;` of the fluid, kg/m^3.
    pub density: Option<Expression>,
    /// `laminar E;` the pressure below which the flow is laminar, Pa.
    pub laminar: Option<Expression>,
}

/// One law of a contact's axis.
#[derive(Clone, Debug)]
pub struct AxisLaw {
    /// The axis.
    pub axis: Axis,
    /// C or R.
    pub kind: ElementKind,
    /// The law's variable, for a nonlinear law.
    pub variable: Option<LawVariable>,
    /// The law, or the parameter of a linear one.
    pub law: Expression,
    /// Where the law starts.
    pub span: Span,
}
