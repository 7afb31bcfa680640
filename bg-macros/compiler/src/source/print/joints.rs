//! What is between bodies as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{
    AxisLaw, Contact, Drive, Ends, Friction, Joint, JointKind, LawVariable, Orifice, ShapeContact, Spring, Stop,
    Touching,
};
use crate::source::print::{block, setting};
use crate::source::words::{AXES, DRIVES, ELEMENTS, word_of};

impl Display for JointKind {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Revolute(axis) => write!(f, "revolute {}", word_of(&AXES, axis)),
            Self::Prismatic(axis) => write!(f, "prismatic {}", word_of(&AXES, axis)),
            Self::Spherical => f.write_str("spherical"),
            Self::Cylindrical(axis) => write!(f, "cylindrical {}", word_of(&AXES, axis)),
            Self::Universal(first, second) => {
                write!(f, "universal {} {}", word_of(&AXES, first), word_of(&AXES, second))
            }
            Self::Fixed => f.write_str("fixed"),
        }
    }
}

impl Display for Ends {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{} -> {}", self.from, self.to)
    }
}

impl Display for Joint {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "stiffness", self.stiffness.as_ref());
        setting(&mut entries, "damping", self.damping.as_ref());
        setting(&mut entries, "tilt stiffness", self.tilt_stiffness.as_ref());
        setting(&mut entries, "tilt damping", self.tilt_damping.as_ref());
        setting(&mut entries, "clearance", self.clearance.as_ref());
        setting(&mut entries, "length", self.length.as_ref());
        for (clause, value) in self.play.clone().play_mut() {
            setting(&mut entries, clause, value.as_ref());
        }
        entries.extend(self.inertial.then(|| "frame inertial;".into()));
        entries.extend(self.rigid.then(|| "rigid;".into()));
        write!(f, "joint {}: {} ({})", self.name, self.kind, self.ends)?;
        settings(f, &entries)
    }
}

impl Display for Spring {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "stiffness", self.stiffness.as_ref());
        setting(&mut entries, "damping", self.damping.as_ref());
        setting(&mut entries, "length", self.length.as_ref());
        write!(f, "spring {} ({})", self.name, self.ends)?;
        settings(f, &entries)
    }
}

impl Display for Drive {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "stiffness", self.stiffness.as_ref());
        setting(&mut entries, "damping", self.damping.as_ref());
        let kind = word_of(&DRIVES, &self.kind);
        write!(f, "drive {} on {} {kind} = {}", self.name, self.target, self.value)?;
        settings(f, &entries)
    }
}

impl Display for Contact {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let laws = self.laws.chunk_by(|a, b| a.axis == b.axis).map(|laws| {
            let axis = laws.first().map_or("?", |law| word_of(&AXES, &law.axis));
            let laws: Vec<String> = laws.iter().map(AxisLaw::to_string).collect();
            format!("{axis}: {};", laws.join(", "))
        });
        write!(f, "contact {} ({} along {}) ", self.name, self.ends, word_of(&AXES, &self.along))?;
        block(f, &laws.collect::<Vec<_>>())
    }
}

impl Display for ShapeContact {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        for (clause, value) in self.law.clone().clauses_mut() {
            setting(&mut entries, clause, value.as_ref());
        }
        entries.extend(self.rigid.then(|| "rigid;".into()));
        let Self { name, ends: Ends { from, to }, shapes: [first, second], .. } = self;
        write!(f, "contact {name} ({from}{first} -> {to}{second})")?;
        settings(f, &entries)
    }
}

/// With a blank in front, since it stands after an end; a point is nothing.
impl Display for Touching {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Point => Ok(()),
            Self::Circle(radius) | Self::Hole(radius) | Self::Sphere(radius) => write!(f, " {} {radius}", self.word()),
            Self::Line(axis) | Self::Plane(axis) => write!(f, " {} {}", self.word(), word_of(&AXES, axis)),
            Self::Segment(axis, length) => write!(f, " segment {} {length}", word_of(&AXES, axis)),
            Self::Slot(axis, [length, width]) => write!(f, " slot {} {length} width {width}", word_of(&AXES, axis)),
            Self::Arc([radius, from, to]) => write!(f, " arc {radius} from {from} to {to}"),
            Self::Profile(table) => write!(f, " profile {table}"),
        }
    }
}

impl Display for Friction {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "coulomb", self.coulomb.as_ref());
        setting(&mut entries, "static", self.at_rest.as_ref());
        setting(&mut entries, "stribeck", self.stribeck.as_ref());
        setting(&mut entries, "viscous", self.viscous.as_ref());
        setting(&mut entries, "normal", self.normal.as_ref());
        setting(&mut entries, "radius", self.radius.as_ref());
        setting(&mut entries, "creep", self.creep.as_ref());
        setting(&mut entries, "stiffness", self.stiffness.as_ref());
        write!(f, "friction {} on {}", self.name, self.target)?;
        settings(f, &entries)
    }
}

impl Display for Stop {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "at least", self.least.as_ref());
        setting(&mut entries, "at most", self.most.as_ref());
        setting(&mut entries, "stiffness", self.stiffness.as_ref());
        setting(&mut entries, "damping", self.damping.as_ref());
        setting(&mut entries, "restitution", self.restitution.as_ref());
        setting(&mut entries, "rest below", self.rest.as_ref());
        setting(&mut entries, "start", self.start.as_ref());
        write!(f, "stop {} on {}", self.name, self.target)?;
        settings(f, &entries)
    }
}

impl Display for Orifice {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries = Vec::new();
        setting(&mut entries, "area", self.area.as_ref());
        setting(&mut entries, "coefficient", self.coefficient.as_ref());
        setting(&mut entries, "density", self.density.as_ref());
        setting(&mut entries, "laminar", self.laminar.as_ref());
        write!(f, "orifice {} on {}", self.name, self.target)?;
        settings(f, &entries)
    }
}

/// Without its axis.
impl Display for AxisLaw {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let variable = self.variable.as_ref().map_or_else(String::new, LawVariable::to_string);
        write!(f, "{}{variable} = {}", word_of(&ELEMENTS, &self.kind), self.law)
    }
}

/// A block of settings, or `;` without any.
fn settings(f: &mut Formatter<'_>, entries: &[String]) -> Result {
    if entries.is_empty() {
        return f.write_str(";");
    }
    f.write_str(" ")?;
    block(f, entries)
}
