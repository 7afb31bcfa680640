//! Bodies: their solids, mass properties, points and start.
//!
//! In: `body NAME { ... }`. Out: a [`Body`].

use proc_macro2::Delimiter;

use super::{
    cursor::{Block, Cursor, Parsed},
    statement::OPERATOR,
};
use crate::source::ast::{Axis, Body, Expression, ExpressionKind, Name, Shape, Solid};

/// The block of a body.
pub(super) const BODY: Block = Block {
    name: "a body",
    words: &["cuboid", "cylinder", "sphere", "density", "mass", "center", "inertia", "point", "start"],
    list: false,
};

/// The clauses of a solid.
#[derive(Default)]
struct Clauses {
    radius: Option<Expression>,
    length: Option<Expression>,
    axis: Option<Axis>,
    at: Option<Expression>,
    turned: Option<Expression>,
    density: Option<Expression>,
}

impl Cursor<'_> {
    /// `body NAME { ... }`
    pub fn body(&mut self) -> Parsed<Body> {
        self.advance();
        let name = self.declared("the body")?;
        let mut block = self.group(Delimiter::Brace, "`{ ... }`", &BODY)?;
        let mut body = Body {
            name,
            solids: Vec::new(),
            density: None,
            mass: None,
            center: None,
            inertia: None,
            points: Vec::new(),
            start_position: None,
            start_orientation: None,
            start_velocity: None,
            start_spin: None,
        };
        block.statements(|entry| entry.body_entry(&mut body));
        Ok(body)
    }

    /// One statement of a body.
    fn body_entry(&mut self, body: &mut Body) -> Parsed<()> {
        match self.word() {
            Some("cuboid" | "cylinder" | "sphere") => {
                let solid = self.solid()?;
                body.solids.push(solid);
            }
            Some("point") => {
                let point = self.point()?;
                body.points.push(point);
            }
            Some("start") => self.start(body)?,
            _ => self.setting(&mut [
                ("density", &mut body.density),
                ("mass", &mut body.mass),
                ("center", &mut body.center),
                ("inertia", &mut body.inertia),
            ])?,
        }
        Ok(())
    }

    /// `start at E;`, `start POINT at E;`, `start turned E;`, `start velocity E;`, `start spin E;`, of the last two
    /// `guess;`
    fn start(&mut self, body: &mut Body) -> Parsed<()> {
        let span = self.advance();
        if self.word().is_some() && self.word() != Some("at") && self.word_ahead(1) == Some("at") {
            let point = self.plain_name("the point")?;
            self.advance();
            let place = self.expression()?;
            self.fill(&mut body.start_position, (Some(point), place), "start at", span);
        } else if self.eat_word("at").is_some() {
            let place = self.expression()?;
            self.fill(&mut body.start_position, (None, place), "start at", span);
        } else {
            let (words, slot) = match self.word() {
                Some("turned") => ("start turned", &mut body.start_orientation),
                Some("velocity") => ("start velocity", &mut body.start_velocity),
                Some("spin") => ("start spin", &mut body.start_spin),
                _ => return Err(self.unexpected("`at`, `POINT at`, `turned`, `velocity` or `spin`")),
            };
            let is_motion = words != "start turned";
            self.advance();
            let value = if is_motion { self.motion()? } else { self.expression()? };
            self.fill(slot, value, words, span);
        }
        self.end_statement(OPERATOR);
        Ok(())
    }

    /// A velocity or spin; `guess` alone stands for `[guess(0), guess(0), guess(0)]`.
    pub fn motion(&mut self) -> Parsed<Expression> {
        if self.word() != Some("guess") || !self.symbol_ahead(1, ";") {
            return self.expression();
        }
        let span = self.advance();
        let zero = Expression { kind: ExpressionKind::Number(0.0), span };
        let guess = ExpressionKind::Call(Name::new("guess", span), vec![zero]);
        let component = Expression { kind: guess, span };
        Ok(Expression { kind: ExpressionKind::Vector(vec![component; 3]), span })
    }

    /// `cuboid [..] at [..] turned E density E;`
    fn solid(&mut self) -> Parsed<Solid> {
        let word = self.word().unwrap_or_default().to_owned();
        let span = self.advance();
        let edges = if word == "cuboid" { Some(self.expression()?) } else { None };
        let mut clauses = Clauses::default();
        while self.solid_clause(&word, &mut clauses)? {}
        let shape = match (edges, word.as_str()) {
            (Some(edges), _) => Shape::Cuboid(edges),
            (None, "cylinder") => self.cylinder(&mut clauses)?,
            _ => Shape::Sphere(clauses.radius.take().ok_or_else(|| self.unexpected("`radius`"))?),
        };
        self.end_statement("an operator, `at`, `turned`, `density`");
        Ok(Solid { shape, at: clauses.at, turned: clauses.turned, density: clauses.density, span })
    }

    /// The cylinder of these clauses.
    fn cylinder(&mut self, clauses: &mut Clauses) -> Parsed<Shape> {
        let radius = clauses.radius.take().ok_or_else(|| self.unexpected("`radius`"))?;
        let length = clauses.length.take().ok_or_else(|| self.unexpected("`length`"))?;
        let axis = clauses.axis.ok_or_else(|| self.unexpected("`along` and an axis"))?;
        Ok(Shape::Cylinder { radius, length, axis })
    }

    /// One clause of a solid of this shape; false when none is ahead.
    fn solid_clause(&mut self, shape: &str, clauses: &mut Clauses) -> Parsed<bool> {
        let is_cylinder = shape == "cylinder";
        let (word, slot) = match self.word() {
            Some("along") if is_cylinder => return self.along(clauses),
            Some("radius") if shape != "cuboid" => ("radius", &mut clauses.radius),
            Some("length") if is_cylinder => ("length", &mut clauses.length),
            Some("at") => ("at", &mut clauses.at),
            Some("turned") => ("turned", &mut clauses.turned),
            Some("density") => ("density", &mut clauses.density),
            _ => return Ok(false),
        };
        let span = self.advance();
        let value = self.expression()?;
        self.fill(slot, value, word, span);
        Ok(true)
    }

    /// `along z`
    fn along(&mut self, clauses: &mut Clauses) -> Parsed<bool> {
        let span = self.advance();
        let axis = self.axis("along", span)?;
        self.fill(&mut clauses.axis, axis, "along", span);
        Ok(true)
    }
}
