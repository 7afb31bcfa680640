//! The ground and bodies as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Axis, Body, Ground, Point, Shape, Solid};
use crate::source::print::{block, clause, setting};
use crate::source::words::{AXES, word_of};

impl Axis {
    /// The axis' letter.
    #[must_use]
    pub fn letter(self) -> &'static str {
        word_of(&AXES, &self)
    }
}

impl Display for Ground {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let points: Vec<String> = self.points.iter().map(Point::to_string).collect();
        f.write_str("ground ")?;
        block(f, &points)
    }
}

impl Display for Point {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "point {} = {}", self.name, self.place)?;
        if let Some(turned) = &self.turned {
            write!(f, " turned {turned}")?;
        }
        write!(f, ";")
    }
}

impl Display for Body {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let mut entries: Vec<String> = self.solids.iter().map(Solid::to_string).collect();
        setting(&mut entries, "density", self.density.as_ref());
        setting(&mut entries, "mass", self.mass.as_ref());
        setting(&mut entries, "center", self.center.as_ref());
        setting(&mut entries, "inertia", self.inertia.as_ref());
        entries.extend(self.points.iter().map(Point::to_string));
        if let Some((point, place)) = &self.start_position {
            let point = point.as_ref().map_or_else(String::new, |point| format!(" {point}"));
            entries.push(format!("start{point} at {place};"));
        }
        setting(&mut entries, "start turned", self.start_orientation.as_ref());
        setting(&mut entries, "start velocity", self.start_velocity.as_ref());
        setting(&mut entries, "start spin", self.start_spin.as_ref());
        write!(f, "body {} ", self.name)?;
        block(f, &entries)
    }
}

impl Display for Solid {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.shape {
            Shape::Cuboid(edges) => write!(f, "cuboid {edges}")?,
            Shape::Cylinder { radius, length, axis } => {
                write!(f, "cylinder radius {radius} length {length} along {}", word_of(&AXES, axis))?;
            }
            Shape::Sphere(radius) => write!(f, "sphere radius {radius}")?,
        }
        let clauses = [
            clause("at", self.at.as_ref()),
            clause("turned", self.turned.as_ref()),
            clause("density", self.density.as_ref()),
        ];
        write!(f, "{};", clauses.concat())
    }
}
