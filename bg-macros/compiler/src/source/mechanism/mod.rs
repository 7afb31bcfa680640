//! Mechanism words to bond-graph words.
//!
//! In: one `ast::Graph`. Out: one `ast::Graph` in which bodies, joints, springs, drives, contacts, frictions, stops,
//! ground and gravity no longer occur; contacts are those along a line and those of shapes. Every word stands for a
//! fragment of the language itself, written below as its template; the user's expressions enter it as named `let`s, so
//! that a fault in one of them is reported where the user wrote it.

mod attachment;
mod axis;
mod body;
mod drawing;
mod fault;
mod friction;
mod joint;
mod orifice;
mod part;
mod press;
mod shapes;
mod stop;

use std::collections::BTreeMap;

use proc_macro2::{Group, Span, TokenStream, TokenTree};

use crate::fault::{DeclaredTwice, Explain, Fault, Staged, near_miss};
use crate::source::ast::{Axis, Body, Ends, Expression, Graph, Ground, Item, Joint, Let, Name, Point};
use crate::source::clause::{Allowed, Clause, Given};
use crate::source::drawing::Drawing;
use crate::source::syntax;
use crate::source::words::GROUND;

pub use fault::MechanismFault;
pub use part::{Part, part_of, parts};

/// Replaces every mechanism word by its fragment of multibond graph.
///
/// # Errors
/// Unknown bodies and points, missing laws and masses: all of them at once.
pub fn expand(source: &Graph) -> Staged<Graph> {
    let mut expansion = Expansion::new(source);
    expansion.run();
    if expansion.faults.is_empty() {
        Ok(Graph { drawing: expansion.drawn(), items: expansion.items, ..source.clone() })
    } else {
        Err(expansion.faults)
    }
}

/// One end of a joint: expressions as text.
struct End {
    body: String,
    /// What has the axes of a joint here: the body, or the point where that is turned.
    axes: String,
    /// The end's position, inertial axes.
    position: String,
    /// From the body's centre of mass to the end, inertial axes; none on the ground.
    arm: Option<String>,
}

impl End {
    /// The arm from this end's body to another place; none on the ground.
    fn arm_to(&self, place: &str) -> Option<String> {
        self.arm.as_ref().map(|_| format!("({place} - {}.position)", self.body))
    }
}

/// The name of a body's origin, and the ground's, beside those of its points.
const ORIGIN: &str = "origin";

struct Expansion<'a> {
    source: &'a Graph,
    items: Vec<Item>,
    drawing: Drawing<Expression>,
    /// What is seen of shapes that touch, with the body or the ground that has it.
    seen: Vec<(String, crate::source::drawing::Solid<Expression>)>,
    bodies: BTreeMap<&'a str, &'a Body>,
    joints: BTreeMap<&'a str, &'a Joint>,
    /// The first ground; the points of all.
    ground: Option<&'a Ground>,
    ground_points: Vec<Point>,
    has_gravity: bool,
    faults: Vec<Fault>,
}

impl<'a> Expansion<'a> {
    fn new(source: &'a Graph) -> Self {
        let mut expansion = Self {
            source,
            items: Vec::new(),
            drawing: Drawing::default(),
            seen: Vec::new(),
            bodies: BTreeMap::new(),
            joints: BTreeMap::new(),
            ground: None,
            ground_points: Vec::new(),
            has_gravity: false,
            faults: Vec::new(),
        };
        let mut names: BTreeMap<&str, Span> = BTreeMap::new();
        let [mut has_impulse, mut has_baumgarte] = [false; 2];
        for item in &source.items {
            if let Some(name) = part_name(item) {
                match names.get(name.text.as_str()) {
                    Some(&first) => expansion.fault(name.span, &DeclaredTwice::new(&name.text, name.span, first)),
                    None => _ = names.insert(&name.text, name.span),
                }
            }
            match item {
                Item::Body(body) => {
                    expansion.bodies.insert(&body.name.text, body);
                }
                Item::Joint(joint) => {
                    expansion.joints.insert(&joint.name.text, joint);
                }
                Item::Ground(ground) => {
                    let twice = expansion.ground.is_some();
                    expansion.ground.get_or_insert(ground);
                    expansion.ground_points.extend(ground.points.iter().cloned());
                    expansion.only_once(twice, ground.span, GROUND);
                }
                Item::Gravity(gravity) => {
                    let twice = std::mem::replace(&mut expansion.has_gravity, true);
                    expansion.only_once(twice, gravity.span, "gravity");
                }
                Item::Impulse(span) => {
                    let twice = std::mem::replace(&mut has_impulse, true);
                    expansion.only_once(twice, *span, "start impulse");
                }
                Item::Baumgarte(baumgarte) => {
                    let twice = std::mem::replace(&mut has_baumgarte, true);
                    expansion.only_once(twice, baumgarte.span, "baumgarte");
                }
                _ => {}
            }
        }
        expansion
    }

    fn run(&mut self) {
        if !self.bodies.is_empty() {
            self.ground_words();
        }
        for item in &self.source.items {
            match item {
                Item::Ground(ground) => self.draw_ground(ground),
                Item::Gravity(gravity) => {
                    let clause = Clause::new("the gravity", 3).given(Given::Source);
                    self.bind("gravity_field", "m/s^2", &gravity.acceleration, clause);
                    self.draw_gravity(gravity);
                }
                Item::Body(body) => {
                    self.body(body);
                    self.draw_body(body);
                }
                Item::Joint(joint) => self.joint(joint),
                Item::Spring(spring) => self.spring(spring),
                Item::Drive(drive) => self.drive(drive),
                Item::Contact(contact) => self.contact(contact),
                Item::ShapeContact(contact) => self.shape_contact(contact),
                Item::Friction(friction) => self.friction(friction),
                Item::Stop(stop) => self.stop(stop),
                Item::Orifice(orifice) => self.orifice(orifice),
                other => self.items.push(other.clone()),
            }
        }
    }

    fn only_once(&mut self, twice: bool, span: Span, word: &'static str) {
        if twice {
            self.fault(span, &MechanismFault::Twice { word });
        }
    }

    fn fault(&mut self, span: Span, fault: &impl Explain) {
        self.faults.push(Fault::new(span, fault));
    }

    /// The ground: a body whose flows are held at zero.
    fn ground_words(&mut self) {
        let span = self.ground.map_or_else(Span::call_site, |ground| ground.span);
        self.text(
            span,
            "1 ground.translation[3]: translation; 1 ground.rotation[3]: rotation;
             Sf ground.place = [0, 0, 0]; Sf ground.attitude = [0, 0, 0];
             ground.place -> ground.translation; ground.attitude -> ground.rotation;
             let ground.position: m = [0, 0, 0];
             let ground.angular_velocity: rad/s = [0, 0, 0];
             let ground.x_axis: 1 = [1, 0, 0]; let ground.y_axis: 1 = [0, 1, 0]; let ground.z_axis: 1 = [0, 0, 1];",
        );
        for point in &self.ground_points.clone() {
            let name = &point.name.text;
            let clause = Clause::new(format!("point `{name}` of the ground"), 3);
            self.bind(&format!("ground.{name}.position"), "m", &point.place, clause);
            self.point_axes(point, GROUND, "");
        }
    }

    /// Adds the items of a template, every token at `span`.
    fn text(&mut self, span: Span, template: &str) {
        self.items.extend(fragment(span, template));
    }

    /// `let NAME: UNIT = VALUE;` with the user's expression as the value, and what it must be; an empty unit is left
    /// out.
    fn bind(&mut self, name: &str, unit: &str, value: &Expression, clause: Clause) {
        let colon = if unit.is_empty() { "" } else { ": " };
        for item in fragment(value.span, &format!("let {name}{colon}{unit} = 0;")) {
            if let Item::Let(definition) = item {
                let (value, clause) = (value.clone(), Some(clause.clone()));
                self.items.push(Item::Let(Let { value, clause, ..definition }));
            }
        }
    }

    /// Adds the `let` of a template, with what it must be.
    fn text_as(&mut self, span: Span, template: &str, clause: &Clause) {
        for item in fragment(span, template) {
            self.items.push(match item {
                Item::Let(definition) => Item::Let(Let { clause: Some(clause.clone()), ..definition }),
                other => other,
            });
        }
    }

    /// The two ends of a joint, or nothing where one is unknown.
    fn ends(&mut self, name: &Name, ends: &Ends) -> Option<(End, End)> {
        let (from, to) = (self.end(&ends.from), self.end(&ends.to));
        let (from, to) = (from?, to?);
        if from.body == to.body {
            self.fault(ends.to.span, &MechanismFault::SameBody { name: name.text.clone(), body: to.body });
            return None;
        }
        Some((from, to))
    }

    /// The body and the point that a name stands for. A body in a part has a path; points have none, but those of the
    /// ground.
    fn on_body<'n>(&self, name: &'n str) -> (&'n str, Option<&'n str>) {
        let is_ground = name.split('.').next() == Some(GROUND);
        let split = if is_ground { name.split_once('.') } else { name.rsplit_once('.') };
        match split {
            Some((body, point)) if !self.bodies.contains_key(name) => (body, Some(point)),
            _ => (name, None),
        }
    }

    /// `body.POINT`, or `body` or `body.origin` for its origin.
    fn end(&mut self, name: &Name) -> Option<End> {
        let (body, point) = self.on_body(&name.text);
        let points = if body == GROUND {
            &self.ground_points[..]
        } else if let Some(definition) = self.bodies.get(body) {
            &definition.points[..]
        } else {
            let near = near_miss(body, self.bodies.keys().copied().chain([GROUND])).map(str::to_owned);
            self.fault(name.span, &MechanismFault::UnknownBody { name: body.to_owned(), near });
            return None;
        };
        let point = point.filter(|&point| point != ORIGIN || is_among(points, point));
        if let Some(point) = point
            && !is_among(points, point)
        {
            self.fault(name.span, &unknown_point(body, point, points));
            return None;
        }
        let place = match (point, body == GROUND) {
            (Some(point), _) => format!("{body}.{point}"),
            (None, true) => {
                let (body, position) = (body.to_owned(), "ground.position".to_owned());
                return Some(End { axes: body.clone(), body, position, arm: None });
            }
            (None, false) => format!("{body}.origin"),
        };
        let arm = (body != GROUND).then(|| format!("{place}.arm"));
        let is_turned = points.iter().any(|known| Some(known.name.text.as_str()) == point && known.turned.is_some());
        let axes = if is_turned { &place } else { body }.to_owned();
        Some(End { body: body.to_owned(), axes, position: format!("{place}.position"), arm })
    }

    /// The axes of a point that is turned, in inertial axes; `orientation` is that of its body, as a factor.
    fn point_axes(&mut self, point: &Point, body: &str, orientation: &str) {
        let (Some(turned), name) = (&point.turned, format!("{body}.{}", point.name.text)) else { return };
        let clause = Clause::new(format!("the axes of point `{}` of {}", point.name.text, in_words(body)), 9);
        self.bind(&format!("{name}.turned"), "1", turned, clause.allowed(Allowed::Rotation));
        for (axis, unit) in Axis::ALL.into_iter().zip(["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"]) {
            let letter = axis.letter();
            self.text(turned.span, &format!("let {name}.{letter}_axis: 1 = {orientation}({name}.turned * {unit});"));
        }
    }

    /// The force junction between two bodies with its lever arms: 1 `NAME.slip` has the relative velocity of the second
    /// end, 0 `NAME.linear` the force on it.
    fn force_junction(&mut self, span: Span, name: &str, (a, b): (&End, &End), arms: (Option<String>, Option<String>)) {
        self.text(
            span,
            &format!(
                "0 {name}.linear[3]: translation; 1 {name}.slip[3]: translation;
                 {name}.slip -> {name}.linear;
                 {}.translation -> {name}.linear -> {}.translation;
                 let {name}.force = {name}.linear.effort;",
                a.body, b.body
            ),
        );
        if let Some(arm) = arms.0 {
            self.text(
                span,
                &format!(
                    "MTF {name}.arm_a(w) = cross(w, {arm}); {}.rotation -> {name}.arm_a -> {name}.linear;",
                    a.body
                ),
            );
        }
        if let Some(arm) = arms.1 {
            self.text(
                span,
                &format!(
                    "MTF {name}.arm_b(effort f) = cross({arm}, f); {name}.linear -> {name}.arm_b -> {}.rotation;",
                    b.body
                ),
            );
        }
    }
}

/// A body, or the ground, in a message.
fn in_words(body: &str) -> String {
    if body == GROUND { "the ground".to_owned() } else { format!("body `{body}`") }
}

/// Whether a point of this name is declared.
fn is_among(points: &[Point], name: &str) -> bool {
    points.iter().any(|point| point.name.text == name)
}

/// A point that the body does not have, with those that it has.
fn unknown_point(body: &str, point: &str, points: &[Point]) -> MechanismFault {
    let known: Vec<String> = points.iter().map(|point| point.name.text.clone()).chain([ORIGIN.to_owned()]).collect();
    let near = near_miss(point, known.iter().map(String::as_str)).map(str::to_owned);
    MechanismFault::UnknownPoint { body: body.to_owned(), point: point.to_owned(), known, near }
}

/// The name of a mechanism's part.
fn part_name(item: &Item) -> Option<&Name> {
    match item {
        Item::Body(body) => Some(&body.name),
        Item::Joint(joint) => Some(&joint.name),
        Item::Spring(spring) => Some(&spring.name),
        Item::Drive(drive) => Some(&drive.name),
        Item::Contact(contact) => Some(&contact.name),
        Item::ShapeContact(contact) => Some(&contact.name),
        Item::Friction(friction) => Some(&friction.name),
        Item::Stop(stop) => Some(&stop.name),
        Item::Orifice(orifice) => Some(&orifice.name),
        _ => None,
    }
}

/// Whether an expression is written as three components.
fn is_vector(expression: &Expression) -> bool {
    matches!(expression.kind, crate::source::ast::ExpressionKind::Vector(_))
}

/// The items of a template, every token at `span`.
fn fragment(span: Span, template: &str) -> Vec<Item> {
    let tokens: TokenStream = format!("graph Template {{ {template} }}").parse().expect("a template is tokens");
    let mut source = syntax::parse(at(tokens, span)).unwrap_or_else(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        panic!("a template is valid source: {template}\n{}", faults.join("\n"))
    });
    source.graphs.pop().map(|graph| graph.items).unwrap_or_default()
}

/// An expression of a template.
fn expression(span: Span, template: &str) -> Expression {
    let items = fragment(span, &format!("let template = {template};"));
    let value = items.into_iter().find_map(|item| if let Item::Let(found) = item { Some(found.value) } else { None });
    value.expect("the template is one let")
}

fn at(tokens: TokenStream, span: Span) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Group(group) => {
                let mut group = Group::new(group.delimiter(), at(group.stream(), span));
                group.set_span(span);
                TokenTree::Group(group)
            }
            mut other => {
                other.set_span(span);
                other
            }
        })
        .collect()
}
