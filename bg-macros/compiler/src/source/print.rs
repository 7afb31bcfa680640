//! The tree as text in one canonical layout, so that parsing the text gives an equal tree.
//!
//! In: any tree of [`crate::source::ast`]. Out: its text: four blanks per level, one statement per line, no parenthesis
//! and no digit more than needed. No text ends with a line feed but that of a whole source.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{
    Axis, AxisLaw, Baumgarte, Between, Beyond, Body, Bound, Choice, Close, Contact, Direction, Drive, Element,
    ElementKind, Ends, Every, Expectation, Expression, ExpressionKind, Friction, Graph, Gravity, Ground, Held, Input,
    Item, Joint, JointKind, Junction, JunctionKind, LawVariable, Let, Memory, Name, Observation, Operation, Orifice,
    Parameter, Part, Point, Rigid, Role, Sample, Scene, Shape, ShapeContact, Solid, Source, Spring, State, Stop, Table,
    Touching, Track, Tune, Unit, Watch,
};
use crate::source::words::{
    AXES, BETWEEN, BEYOND, COMPARISONS, DRIVES, ELEMENTS, OPERATORS, ROLES, TRACKS, strength, word_of,
};

/// The longest list that stays on one line, in columns; three levels of indentation keep it within 120.
const LINE: usize = 108;

/// How strongly a minus binds: more than any binary operator.
const MINUS: u8 = 3;

impl Display for Source {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let texts = self.parts.iter().map(Part::to_string).chain(self.graphs.iter().map(Graph::to_string));
        for (i, text) in texts.enumerate() {
            let gap = if i > 0 { "\n" } else { "" };
            writeln!(f, "{gap}{text}")?;
        }
        Ok(())
    }
}

impl Display for Graph {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "{}graph {} ", self.visibility.text(), self.name)?;
        statements(f, &self.items)
    }
}

/// A block of statements with blank lines between its sections.
pub(super) fn statements(f: &mut Formatter<'_>, items: &[Item]) -> Result {
    f.write_str("{")?;
    for (i, item) in items.iter().enumerate() {
        let before = i.checked_sub(1).and_then(|before| items.get(before));
        let gap = before.is_some_and(|before| section(item).is_none() || section(item) != section(before));
        write!(f, "{}", if gap { "\n\n" } else { "\n" })?;
        indented(f, &item.to_string())?;
    }
    f.write_str(if items.is_empty() { "}" } else { "\n}" })
}

/// Which items stand together without a blank line; none beside one with a block.
const fn section(item: &Item) -> Option<u8> {
    match item {
        Item::Parameter(_) | Item::Input(_) => Some(0),
        Item::Let(_) | Item::Table(_) | Item::State(_) | Item::Memory(_) => Some(1),
        Item::Junction(_) | Item::Element(_) => Some(2),
        Item::Chain(_) => Some(3),
        Item::Track(_) => Some(4),
        Item::Close(_) => Some(5),
        _ => None,
    }
}

/// Documentation as lines of `///`.
pub(super) fn documentation(f: &mut Formatter<'_>, docs: &str) -> Result {
    for line in docs.lines() {
        writeln!(f, "///{}{line}", if line.is_empty() { "" } else { " " })?;
    }
    Ok(())
}

/// Every line of `text` one level deeper, without a line feed at the end.
fn indented(f: &mut Formatter<'_>, text: &str) -> Result {
    for (i, line) in text.lines().enumerate() {
        let feed = if i > 0 { "\n" } else { "" };
        let indent = if line.is_empty() { "" } else { "    " };
        write!(f, "{feed}{indent}{line}")?;
    }
    Ok(())
}

/// A block of statements, one per line.
pub(super) fn block(f: &mut Formatter<'_>, entries: &[String]) -> Result {
    if entries.is_empty() {
        return f.write_str("{}");
    }
    f.write_str("{\n")?;
    indented(f, &entries.join("\n"))?;
    f.write_str("\n}")
}

/// A braced list on one line.
fn list<T: Display>(entries: &[T], separator: &str) -> String {
    let entries: Vec<String> = entries.iter().map(T::to_string).collect();
    if entries.is_empty() { "{}".into() } else { format!("{{ {} }}", entries.join(separator)) }
}

/// A clause in front of a value that may be left out.
fn clause<T: Display>(word: &str, value: Option<&T>) -> String {
    value.map_or_else(String::new, |value| format!(" {word} {value}"))
}

/// A statement of a block that may be left out.
fn setting(entries: &mut Vec<String>, word: &str, value: Option<&Expression>) {
    entries.extend(value.map(|value| format!("{word} {value};")));
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(&self.text)
    }
}

impl Display for Item {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Parameter(parameter) => parameter.fmt(f),
            Self::Table(table) => table.fmt(f),
            Self::State(state) => state.fmt(f),
            Self::Memory(memory) => memory.fmt(f),
            Self::Every(every) => every.fmt(f),
            Self::Input(input) => input.fmt(f),
            Self::Let(binding) => binding.fmt(f),
            Self::Junction(junction) => junction.fmt(f),
            Self::Element(element) => element.fmt(f),
            Self::Chain(names) => {
                let names: Vec<&str> = names.iter().map(|name| name.text.as_str()).collect();
                write!(f, "{};", names.join(" -> "))
            }
            Self::Track(track) => track.fmt(f),
            Self::Close(close) => close.fmt(f),
            Self::Observe(watched) => observe(f, watched),
            Self::Scene(scene) => scene.fmt(f),
            Self::ScenesOnly(_) => f.write_str("scenes only;"),
            Self::Ground(ground) => ground.fmt(f),
            Self::Gravity(Gravity { acceleration, .. }) => write!(f, "gravity {acceleration};"),
            Self::Impulse(_) => f.write_str("start impulse;"),
            Self::Baumgarte(Baumgarte { rate, .. }) => write!(f, "baumgarte {rate};"),
            Self::IntegralCausality => Expectation::IntegralCausality.fmt(f),
            Self::Body(body) => body.fmt(f),
            Self::Joint(joint) => joint.fmt(f),
            Self::Spring(spring) => spring.fmt(f),
            Self::Drive(drive) => drive.fmt(f),
            Self::Contact(contact) => contact.fmt(f),
            Self::ShapeContact(contact) => contact.fmt(f),
            Self::Friction(friction) => friction.fmt(f),
            Self::Stop(stop) => stop.fmt(f),
            Self::Orifice(orifice) => orifice.fmt(f),
            Self::Use(used) => used.fmt(f),
            Self::Port(port) => port.fmt(f),
            Self::Start(start) => start.fmt(f),
            Self::For(repeated) => repeated.fmt(f),
        }
    }
}

impl Display for Parameter {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "param {}: {} = {}", self.name, self.unit, self.default)?;
        for (bound, inside, open) in [(&self.lower, "at least", "above"), (&self.upper, "at most", "below")] {
            if let Some(Bound { value, included }) = bound {
                write!(f, ", {} {value}", if *included { inside } else { open })?;
            }
        }
        f.write_str(";")
    }
}

impl Display for Input {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "input {}: {};", self.name, self.unit)
    }
}

impl Display for Let {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let unit = self.unit.as_ref().map_or_else(String::new, |unit| format!(": {unit}"));
        write!(f, "let {}{unit} = {};", self.name, self.value)
    }
}

impl Display for Unit {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.factors.first().is_none_or(|&(_, exponent)| exponent < 0) {
            f.write_str("1")?;
        }
        for (i, (symbol, exponent)) in self.factors.iter().enumerate() {
            match (i, *exponent < 0) {
                (_, true) => write!(f, "/{symbol}")?,
                (0, false) => write!(f, "{symbol}")?,
                (_, false) => write!(f, "*{symbol}")?,
            }
            if exponent.abs() != 1 {
                write!(f, "^{}", exponent.abs())?;
            }
        }
        Ok(())
    }
}

impl Display for Junction {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let kind = u8::from(self.kind == JunctionKind::One);
        // A number at the end of a name would be read as the cardinality.
        let is_plain = self.cardinality == 1 && !self.name.text.ends_with(']');
        let cardinality = if is_plain { String::new() } else { format!("[{}]", self.cardinality) };
        let domain = self.domain.as_ref().map_or_else(String::new, |domain| format!(": {domain}"));
        write!(f, "{kind} {}{cardinality}{domain};", self.name)
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let variable = self.variable.as_ref().map_or_else(String::new, LawVariable::to_string);
        write!(f, "{} {}{variable} = {}", word_of(&ELEMENTS, &self.kind), self.name, self.law)?;
        let clauses = [
            clause("in", self.frame.as_ref()),
            clause("at", self.displacement.as_ref()),
            clause("start", self.start.as_ref()),
            clause("energy", self.energy.as_ref()),
            clause("holds", self.sticking.as_ref()),
            clause("restitution", self.restitution.as_ref()),
            clause("rest below", self.rest.as_ref()),
        ];
        let held = self.held.as_ref().map_or_else(String::new, |held| format!(" of {held}"));
        write!(f, "{}{held};", clauses.concat())
    }
}

impl Display for Held {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}", self.joint)?;
        match self.direction {
            Some(Direction::Along(axis)) => write!(f, " along {}", axis.letter()),
            Some(Direction::About(axis)) => write!(f, " about {}", axis.letter()),
            None => Ok(()),
        }
    }
}

impl ElementKind {
    /// The field's symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        word_of(&ELEMENTS, &self)
    }
}

impl Axis {
    /// The axis' letter.
    #[must_use]
    pub fn letter(self) -> &'static str {
        word_of(&AXES, &self)
    }
}

impl Display for Role {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(word_of(&ROLES, self))
    }
}

impl Display for LawVariable {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.role {
            Some(role) => write!(f, "({} {})", role, self.name),
            None => write!(f, "({})", self.name),
        }
    }
}

impl Display for Track {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let start = clause("start", self.start.as_ref());
        write!(f, "{} {} of {}{start};", word_of(&TRACKS, &self.kind), self.name, self.junction)
    }
}

impl Display for Close {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "close {} = {};", self.joint, self.gap)
    }
}

/// `observe { a; b = E }`, on several lines when it is long.
fn observe(f: &mut Formatter<'_>, watched: &[Watch]) -> Result {
    let line = list(watched, "; ");
    f.write_str("observe ")?;
    if line.chars().count() <= LINE {
        return f.write_str(&line);
    }
    let entries: Vec<String> = watched.iter().map(|watch| format!("{watch};")).collect();
    block(f, &entries)
}

impl Display for Watch {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Value(observation) => observation.fmt(f),
            Self::All(name) => write!(f, "all of {name}"),
        }
    }
}

impl Display for Observation {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match (&self.name, &self.unit) {
            (Some(name), Some(unit)) => write!(f, "{name}: {unit} = {}", self.value),
            (Some(name), None) => write!(f, "{name} = {}", self.value),
            (None, _) => self.value.fmt(f),
        }
    }
}

impl Display for Scene {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        let mut entries = Vec::new();
        if !self.observe.is_empty() {
            entries.push(Item::Observe(self.observe.clone()).to_string());
        }
        match &self.tune {
            Tune::All => {}
            Tune::Only(names) => entries.push(format!("tune {}", list(names, ", "))),
            Tune::AllBut(names) => entries.push(format!("tune all but {}", list(names, ", "))),
        }
        if !self.without.is_empty() {
            entries.push(format!("without {}", list(&self.without, ", ")));
        }
        match &self.rigid {
            Rigid::None => {}
            Rigid::All(_) => entries.push("rigid joints;".into()),
            Rigid::Some(names) => entries.push(format!("rigid {}", list(names, ", "))),
        }
        if !self.dependent.is_empty() {
            entries.push(format!("dependent {}", list(&self.dependent, ", ")));
        }
        entries.extend(self.all_reactions.then(|| "all reactions;".into()));
        entries.extend(self.angles.then(|| "angles;".into()));
        entries.extend(self.expect.iter().map(Expectation::to_string));
        write!(f, "scene {} ", self.name)?;
        block(f, &entries)
    }
}

impl Display for Expectation {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::IntegralCausality => f.write_str("expect integral causality;"),
            Self::Planar(_) => f.write_str("expect planar;"),
            Self::States(states, _) => write!(f, "expect states = {states};"),
            Self::IndependentSpeeds(_) => f.write_str("expect independent speeds;"),
        }
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

/// A block of settings, or `;` without any.
fn settings(f: &mut Formatter<'_>, entries: &[String]) -> Result {
    if entries.is_empty() {
        return f.write_str(";");
    }
    f.write_str(" ")?;
    block(f, entries)
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

impl Display for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "state {}: {} = {}{};", self.name, self.unit, self.rate, clause("start", self.start.as_ref()))
    }
}

impl Display for Memory {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self { name, unit, following: Choice { comparison, left, right, then, .. }, start } = self;
        let sign = word_of(&COMPARISONS, comparison);
        write!(f, "memory {name}: {unit} = {then} while {left} {sign} {right}{};", clause("start", start.as_ref()))
    }
}

impl Display for Every {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let sample = |Sample { name, unit, value, start }: &Sample| {
            format!("sample {name}: {unit} = {value}{};", clause("start", start.as_ref()))
        };
        write!(f, "{} ", self.times())?;
        block(f, &self.samples.iter().map(sample).collect::<Vec<_>>())
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self { name, argument, second, value, points, between, beyond } = self;
        let second = second.as_ref().map(|second| format!(", {second}")).unwrap_or_default();
        write!(f, "table {name}: {argument}{second} -> {value} = {points}")?;
        if *between != Between::default() {
            write!(f, ", {}", word_of(&BETWEEN, between))?;
        }
        if *beyond != Beyond::default() {
            write!(f, ", {}", word_of(&BEYOND, beyond))?;
        }
        f.write_str(";")
    }
}

/// Without its axis.
impl Display for AxisLaw {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let variable = self.variable.as_ref().map_or_else(String::new, LawVariable::to_string);
        write!(f, "{}{variable} = {}", word_of(&ELEMENTS, &self.kind), self.law)
    }
}

impl Display for Expression {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.kind {
            ExpressionKind::Number(value) => f.write_str(&number(*value)),
            ExpressionKind::Quantity(value, unit) => write!(f, "{} {unit}", number(*value)),
            ExpressionKind::Name(name) => name.fmt(f),
            ExpressionKind::Negate(operand) => {
                // The sign of a number is part of the number, so that the minus in front of one needs parentheses.
                let is_number = matches!(
                    operand.kind,
                    ExpressionKind::Number(value) | ExpressionKind::Quantity(value, _) if value.is_sign_positive()
                );
                f.write_str("-")?;
                enclosed(f, operand, is_number || binding(operand) < MINUS)
            }
            ExpressionKind::Chain(first, rest) => operations(f, first, rest),
            ExpressionKind::Call(function, arguments) => write!(f, "{function}({})", separated(arguments)),
            ExpressionKind::Vector(elements) => write!(f, "[{}]", separated(elements)),
            ExpressionKind::If(choice) => choice.fmt(f),
        }
    }
}

impl Choice {
    /// The comparison as text.
    pub(crate) fn condition(&self) -> String {
        format!("{} {} {}", self.left, word_of(&COMPARISONS, &self.comparison), self.right)
    }
}

impl Display for Choice {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "if {} {{ {} }} else ", self.condition(), self.then)?;
        match &self.otherwise.kind {
            ExpressionKind::If(next) => next.fmt(f),
            _ => write!(f, "{{ {} }}", self.otherwise),
        }
    }
}

/// A sum or product of any length.
fn operations(f: &mut Formatter<'_>, first: &Expression, rest: &[Operation]) -> Result {
    let weakest = rest.first().map_or(MINUS, |operation| strength(operation.operator));
    enclosed(f, first, binding(first) < weakest)?;
    for Operation { operator, operand, .. } in rest {
        write!(f, " {} ", word_of(&OPERATORS, operator))?;
        enclosed(f, operand, binding(operand) <= strength(*operator))?;
    }
    Ok(())
}

/// An operand, in parentheses if need be.
fn enclosed(f: &mut Formatter<'_>, operand: &Expression, parentheses: bool) -> Result {
    if parentheses { write!(f, "({operand})") } else { operand.fmt(f) }
}

/// How strongly an expression holds together; an `if` stands in parentheses as an operand, for the eye.
fn binding(expression: &Expression) -> u8 {
    match &expression.kind {
        // What stands after a unit could be read as a part of it.
        ExpressionKind::If(_) | ExpressionKind::Quantity(..) => 0,
        ExpressionKind::Chain(_, rest) => rest.first().map_or(MINUS, |operation| strength(operation.operator)),
        _ => MINUS,
    }
}

/// Expressions separated by commas.
fn separated(expressions: &[Expression]) -> String {
    expressions.iter().map(Expression::to_string).collect::<Vec<_>>().join(", ")
}

/// The shortest text that reads back as `value`; with an exponent where plain digits would be mostly zeros.
fn number(value: f64) -> String {
    let plain = value.to_string();
    let exponent = format!("{value:e}");
    let is_plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if is_plain || plain.len() <= exponent.len() { plain } else { exponent }
}
