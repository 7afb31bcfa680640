//! The look of a mechanism, from its words.
//!
//! In: bodies, the ground, joints, springs and contacts. Out: a [`Drawing`] over the names that their fragments define.

use super::{End, Expansion, expression};
use crate::source::ast::{self, Body, Ends, Expression, Gravity, Ground, Name, Solid};
use crate::source::drawing::{self, Drawing};

impl Expansion<'_> {
    /// A body with its solids and points, as measured from its centre of mass.
    pub(super) fn draw_body(&mut self, body: &Body) {
        let (name, span) = (&body.name.text, body.name.span);
        let named = |text: String| expression(span, &text);
        let points = body.points.iter().map(|point| {
            let place = named(format!("{name}.{}.place - {name}.center", point.name.text));
            drawing::Point { name: point.name.text.clone(), place }
        });
        self.drawing.bodies.push(drawing::Body {
            name: name.clone(),
            position: named(format!("{name}.position")),
            orientation: named(format!("{name}.orientation")),
            solids: body.solids.iter().zip(1..).map(|(part, k)| solid(part, &format!("{name}.part{k}"))).collect(),
            points: points.collect(),
        });
    }

    /// The named points of the ground.
    pub(super) fn draw_ground(&mut self, ground: &Ground) {
        for point in &ground.points {
            let name = point.name.text.clone();
            let place = expression(ground.span, &format!("ground.{name}.position"));
            self.drawing.ground.push(drawing::Point { name, place });
        }
    }

    /// Which way things fall.
    pub(super) fn draw_gravity(&mut self, gravity: &Gravity) {
        self.drawing.gravity = Some(expression(gravity.span, "gravity_field"));
    }

    /// A word between two ends: their places, the force on the second body and, where there is one, the moment.
    pub(super) fn draw_joint(
        &mut self,
        (name, word): (&Name, String),
        ends: &Ends,
        (a, b): (&End, &End),
        has_moment: bool,
    ) {
        let named = |text: &str| expression(name.span, text);
        let of = |what: &str| named(&format!("{}.{what}", name.text));
        self.drawing.joints.push(drawing::Joint {
            name: name.text.clone(),
            word,
            ends: [ends.from.text.clone(), ends.to.text.clone()],
            places: [named(&a.position), named(&b.position)],
            force: of("force"),
            moment: has_moment.then(|| of("moment")),
        });
    }
}

/// A solid, whose quantities are named after `label`.
fn solid(part: &Solid, label: &str) -> drawing::Solid<Expression> {
    let of = |what: &str| expression(part.span, &format!("{label}.{what}"));
    let shape = match &part.shape {
        ast::Shape::Cuboid(_) => drawing::Shape::Cuboid(of("size")),
        ast::Shape::Cylinder { axis, .. } => {
            drawing::Shape::Cylinder { radius: of("radius"), length: of("length"), axis: *axis }
        }
        ast::Shape::Sphere(_) => drawing::Shape::Sphere(of("radius")),
    };
    drawing::Solid { shape, center: of("offset"), turned: part.turned.is_some().then(|| of("turned")) }
}

impl Expansion<'_> {
    /// What has been drawn.
    pub(super) fn drawn(&mut self) -> Drawing<Expression> {
        std::mem::take(&mut self.drawing)
    }
}
