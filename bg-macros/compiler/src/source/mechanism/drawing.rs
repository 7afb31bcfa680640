//! The look of a mechanism, from its words.
//!
//! In: bodies, the ground, joints, springs and contacts. Out: a [`Drawing`] over the names that their fragments define.
//! Shapes that touch are drawn where the body has no solids of its own, and on the ground: what is thin as bars.

use std::f64::consts::TAU;

use super::{End, Expansion, expression};
use crate::source::ast::{self, Axis, Body, Ends, Expression, Gravity, Ground, Name, Solid, Touching};
use crate::source::drawing::{self, Drawing};
use crate::source::words::GROUND;

/// Bars of a curve that is a whole turn.
const BARS: u32 = 48;

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
        places: [&str; 2],
        has_moment: bool,
    ) {
        let named = |text: &str| expression(name.span, text);
        let of = |what: &str| named(&format!("{}.{what}", name.text));
        self.drawing.joints.push(drawing::Joint {
            name: name.text.clone(),
            word,
            ends: [ends.from.text.clone(), ends.to.text.clone()],
            places: places.map(named),
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

/// A piece of a shape, in the axes of its end: what it is, its centre and by what angle it is turned about z.
struct Piece {
    shape: drawing::Shape<String>,
    center: String,
    angle: String,
}

impl Piece {
    /// A thin bar along x.
    fn bar(length: &str, width: &str, center: String, angle: String) -> Self {
        Self { shape: drawing::Shape::Cuboid(format!("[{length}, {width} / 8, {width}]")), center, angle }
    }

    /// Bars along a part of a circle; `sweep` is a text, of which each bar takes its part.
    fn bars(radius: &str, center: &str, from: &str, (sweep, count): (&str, u32)) -> Vec<Self> {
        let bar = |k: u32| {
            let angle = format!("({from} + {sweep} * {:?})", (f64::from(k) + 0.5) / f64::from(count));
            let at = format!("{center} + {radius} * [cos({angle}), sin({angle}), 0]");
            let length = format!("1.05 * {radius} * {sweep} / {count}");
            Self::bar(&length, &format!("{radius} / 5"), at, format!("{angle} + {:?}", TAU / 4.0))
        };
        (0..count).map(bar).collect()
    }

    /// Bars from each of these places to the next one, m.
    fn chain(places: &[[f64; 2]]) -> Vec<Self> {
        let size = places.iter().flatten().fold(0.0, |most: f64, part| most.max(part.abs()));
        let bar = |ends: &[[f64; 2]]| {
            let ([x, y], [u, v]) = (ends[0], ends[1]);
            let length = format!("{:?} m", 1.05 * (u - x).hypot(v - y));
            let center = format!("[{:?} m, {:?} m, 0 m]", (x + u) / 2.0, (y + v) / 2.0);
            Self::bar(&length, &format!("({:?} m)", size / 5.0), center, format!("{:?}", (v - y).atan2(u - x)))
        };
        places.windows(2).map(bar).collect()
    }
}

impl Expansion<'_> {
    /// What is seen of a shape of a contact at an end; `other` is the radius of what touches it, where it has one: of
    /// what has no end of its own a piece is drawn that is large beside that.
    pub(super) fn draw_shape(
        &mut self,
        shape: &Touching,
        (name, end): (&Name, &End),
        sizes: &str,
        other: Option<&str>,
    ) {
        let (body, point) = self.on_body(&name.text);
        if self.bodies.get(body).is_some_and(|body| !body.solids.is_empty()) {
            return;
        }
        let base = match (point, body == GROUND) {
            (Some(point), false) => format!("{body}.{point}.place - {body}.center"),
            (None, false) => format!("-{body}.center"),
            (..) => end.position.clone(),
        };
        let turned = (end.axes != end.body).then(|| format!("{}.turned", end.axes));
        let axes = turned.as_ref().map_or(String::new(), |turned| format!("{turned} * "));
        let body = body.to_owned();
        let named = |text: &str| expression(name.span, text);
        for Piece { shape, center, angle } in self.pieces(shape, sizes, other) {
            let solid = drawing::Solid {
                shape: shape.map(&mut |text| named(text)),
                center: named(&format!("{base} + {axes}({center})")),
                turned: Some(named(&format!("{axes}rotation_z({angle})"))),
            };
            self.seen.push((body.clone(), solid));
        }
    }

    /// The pieces of a shape, in the axes of its end.
    fn pieces(&self, shape: &Touching, sizes: &str, other: Option<&str>) -> Vec<Piece> {
        let size = |word: &str| format!("{sizes}{word}");
        let [radius, length, width] = ["radius", "length", "width"].map(size);
        let still = || ("[0 m, 0, 0]".to_owned(), "0".to_owned());
        let along = |axis: &Axis| if *axis == Axis::Y { ("[0, 1, 0]", TAU / 4.0) } else { ("[1, 0, 0]", 0.0) };
        let whole = |shape: drawing::Shape<String>| {
            let (center, angle) = still();
            vec![Piece { shape, center, angle }]
        };
        match shape {
            Touching::Point => Vec::new(),
            Touching::Circle(_) => {
                whole(drawing::Shape::Cylinder { length: format!("0.2 * {radius}"), radius, axis: Axis::Z })
            }
            Touching::Sphere(_) => whole(drawing::Shape::Sphere(radius)),
            Touching::Hole(_) => Piece::bars(&radius, "[0 m, 0, 0]", "0", (&format!("{TAU:?}"), BARS)),
            Touching::Line(axis) => other.map_or(Vec::new(), |other| {
                let angle = format!("{:?}", along(axis).1);
                vec![Piece::bar(&format!("20 * {other}"), other, still().0, angle)]
            }),
            Touching::Plane(axis) => other.map_or(Vec::new(), |other| {
                let edge = |of: Axis| if of == *axis { format!("0.02 * {other}") } else { format!("20 * {other}") };
                whole(drawing::Shape::Cuboid(format!("[{}, {}, {}]", edge(Axis::X), edge(Axis::Y), edge(Axis::Z))))
            }),
            Touching::Segment(axis, _) => {
                let (way, angle) = along(axis);
                let center = format!("0.5 * {length} * {way}");
                vec![Piece::bar(&length, &format!("{length} / 8"), center, format!("{angle:?}"))]
            }
            Touching::Slot(axis, _) => {
                let ((way, angle), radius) = (along(axis), format!("(0.5 * {width})"));
                let side = if *axis == Axis::Y { "[-1, 0, 0]" } else { "[0, 1, 0]" };
                let wall = |sign: &str| {
                    let center = format!("0.5 * {length} * {way} {sign} {radius} * {side}");
                    Piece::bar(&length, &format!("{radius} / 5"), center, format!("{angle:?}"))
                };
                let end = |center: &str, from: f64| {
                    Piece::bars(&radius, center, &format!("{from:?}"), (&format!("{:?}", TAU / 2.0), BARS / 4))
                };
                let ends =
                    [end("[0 m, 0, 0]", angle + TAU / 4.0), end(&format!("{length} * {way}"), angle - TAU / 4.0)];
                ["+", "-"].map(wall).into_iter().chain(ends.into_iter().flatten()).collect()
            }
            Touching::Arc(_) => {
                let [from, opening] = ["from", "opening"].map(size);
                Piece::bars(&radius, "[0 m, 0, 0]", &from, (&opening, BARS))
            }
            Touching::Profile(table) => Piece::chain(&self.outline(table)),
        }
    }

    /// What has been drawn.
    pub(super) fn drawn(&mut self) -> Drawing<Expression> {
        let mut drawing = std::mem::take(&mut self.drawing);
        let seen = std::mem::take(&mut self.seen);
        if let Some((_, first)) = seen.iter().find(|(body, _)| body == GROUND) {
            let span = first.center.span;
            drawing.bodies.push(drawing::Body {
                name: GROUND.to_owned(),
                position: expression(span, "ground.position"),
                orientation: expression(span, IDENTITY),
                solids: Vec::new(),
                points: Vec::new(),
            });
        }
        for (body, solid) in seen {
            let of_body = drawing.bodies.iter_mut().find(|drawn| drawn.name == body);
            of_body.into_iter().for_each(|drawn| drawn.solids.push(solid.clone()));
        }
        drawing
    }
}

/// The axes of the ground.
const IDENTITY: &str = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]";

/// Points of a curve through these, each with its argument first: as many as a picture needs, on cubics whose slopes at
/// a point are those of the line through its neighbours.
pub(super) fn rounded(knots: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let slope = |k: usize| {
        let ([x, y], [u, v]) = (knots[k.saturating_sub(1)], knots[(k + 1).min(knots.len() - 1)]);
        (v - y) / (u - x)
    };
    let pieces = (BARS as usize).div_ceil(knots.len().max(2) - 1);
    let between = |k: usize| {
        let ([x, y], [u, v], step) = (knots[k], knots[k + 1], knots[k + 1][0] - knots[k][0]);
        let [before, behind] = [k, k + 1].map(|k| slope(k) * step - (v - y));
        (0..pieces).map(move |piece| {
            let part = piece as f64 / pieces as f64;
            let bend = part * (1.0 - part) * (before * (1.0 - part) - behind * part);
            [x + part * (u - x), y + part * (v - y) + bend]
        })
    };
    (1..knots.len()).flat_map(|k| between(k - 1)).chain(knots.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_and_is_round_between_them() {
        let knots: Vec<[f64; 2]> = (0..=12).map(|k| f64::from(k) * TAU / 12.0).map(|x| [x, x.sin()]).collect();
        let curve = rounded(&knots);
        assert_eq!(curve.len(), 12 * 4 + 1);
        assert!(knots.iter().enumerate().all(|(k, knot)| curve[4 * k] == *knot));
        // The lines between the points are 0.034 off.
        assert!(curve.iter().all(|[x, y]| (y - x.sin()).abs() < 0.01), "{curve:?}");
        assert_eq!((rounded(&[]), rounded(&knots[..1])), (Vec::new(), vec![knots[0]]));
    }
}
