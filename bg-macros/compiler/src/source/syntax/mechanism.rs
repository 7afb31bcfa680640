//! The mechanism words: ground, gravity, body, joint, spring, drive, contact. Those of one junction are read in
//! `friction`.
//!
//! In: statements of a graph. Out: their [`Item`]s, which `mechanism::expand` turns into bond-graph words.

use proc_macro2::{Delimiter, Span};

use super::{
    SyntaxFault,
    cursor::{Block, Cursor, Parsed},
    statement::OPERATOR,
};
use crate::source::ast::{
    Axis, AxisLaw, Baumgarte, Contact, Drive, DriveKind, ElementKind, Ends, Expression, Gravity, Ground, Item, Joint,
    JointKind, Name, Point, PressLaw, ShapeContact, Spring, Touching,
};
use crate::source::words::{AXES, DRIVES, value_of, word_of};

/// The block of the ground.
pub(super) const GROUND: Block = Block { name: "`ground`", words: &["point"], list: false };

/// The block of a joint.
pub(super) const JOINT: Block = Block {
    name: "a joint",
    words: &[
        "stiffness",
        "damping",
        "tilt stiffness",
        "tilt damping",
        "frame inertial",
        "rigid",
        "clearance",
        "length",
        "exponent",
        "dissipation",
        "restitution",
        "rest below",
    ],
    list: false,
};

/// The block of a spring.
pub(super) const SPRING: Block = Block { name: "a spring", words: &["stiffness", "damping", "length"], list: false };

/// The block of a speed drive.
pub(super) const DRIVE: Block = Block { name: "a speed drive", words: &["stiffness", "damping"], list: false };

/// The block of a contact.
pub(super) const CONTACT: Block = Block { name: "a contact", words: &["x", "y", "z"], list: false };

/// The block of a contact of shapes.
pub(super) const SHAPE_CONTACT: Block = Block {
    name: "a contact of shapes",
    words: &["stiffness", "exponent", "damping", "dissipation", "restitution", "rest below", "rigid"],
    list: false,
};

/// The shapes that touch.
const SHAPES: &[&str] = &["circle", "hole", "sphere", "line", "plane", "segment", "slot", "arc", "profile"];

/// Inside of `(a.P -> b.Q)`.
const ENDS: Block = Block { name: "the parentheses", words: &[], list: false };

/// The kinds of joints.
const JOINTS: &[&str] = &["revolute", "prismatic", "spherical", "cylindrical", "universal", "fixed"];

/// The kinds of drives.
const DRIVE_WORDS: &[&str] = &["torque", "force", "speed"];

/// The laws of a contact.
const CONTACT_LAWS: &[&str] = &["C", "R"];

/// A clause's words and the slot of its value.
type Slot<'s> = (&'static str, &'s mut Option<Expression>);

impl Cursor<'_> {
    /// The statement that begins with `word`.
    pub fn mechanism_item(&mut self, word: &str) -> Parsed<Item> {
        match word {
            "ground" => self.ground().map(Item::Ground),
            "gravity" => self.gravity().map(Item::Gravity),
            "start" => self.start_statement(),
            "baumgarte" => self.baumgarte().map(Item::Baumgarte),
            "expect" => self.expected_causality().map(|()| Item::IntegralCausality),
            "body" => self.body().map(Item::Body),
            "joint" => self.joint().map(Item::Joint),
            "spring" => self.spring().map(Item::Spring),
            "drive" => self.drive().map(Item::Drive),
            "contact" => self.contact(),
            "friction" => self.friction().map(Item::Friction),
            "stop" => self.stop().map(Item::Stop),
            "orifice" => self.orifice().map(Item::Orifice),
            _ => Err(self.unknown_statement()),
        }
    }

    /// `ground { point P = E; }`
    fn ground(&mut self) -> Parsed<Ground> {
        let span = self.advance();
        let mut block = self.group(Delimiter::Brace, "`{ ... }`", &GROUND)?;
        let mut points = Vec::new();
        block.statements(|entry| {
            if entry.word() != Some("point") {
                return Err(entry.unknown_statement());
            }
            entry.advance();
            let name = entry.declared("the point")?;
            points.push(entry.place_of(name)?);
            Ok(())
        });
        Ok(Ground { span, points })
    }

    /// `point B = E;`
    pub fn point(&mut self) -> Parsed<Point> {
        self.advance();
        let name = self.plain_name("the point")?;
        self.place_of(name)
    }

    /// `= E;`, `= E turned E;`
    fn place_of(&mut self, name: Name) -> Parsed<Point> {
        self.expect("=")?;
        let place = self.expression()?;
        let turned = if self.eat_word("turned").is_some() { Some(self.expression()?) } else { None };
        self.end_statement(OPERATOR);
        Ok(Point { name, place, turned })
    }

    /// `gravity E;`
    fn gravity(&mut self) -> Parsed<Gravity> {
        let span = self.advance();
        let acceleration = self.expression()?;
        self.end_statement(OPERATOR);
        Ok(Gravity { span, acceleration })
    }

    /// `start impulse;`, `start BODY at E;`
    fn start_statement(&mut self) -> Parsed<Item> {
        if self.word_ahead(1) != Some("impulse") || !(self.symbol_ahead(2, ";") || self.ahead(2).is_none()) {
            return self.start_outside().map(Item::Start);
        }
        self.advance();
        let span = self.advance();
        self.end_statement("");
        Ok(Item::Impulse(span))
    }

    /// `baumgarte RATE;`
    fn baumgarte(&mut self) -> Parsed<Baumgarte> {
        let span = self.advance();
        let rate = self.expression()?;
        self.end_statement(OPERATOR);
        Ok(Baumgarte { span, rate })
    }

    /// `expect integral causality;`
    fn expected_causality(&mut self) -> Parsed<()> {
        self.advance();
        self.expect_word("integral")?;
        self.integral_causality()
    }

    /// What comes after `expect integral`.
    pub fn integral_causality(&mut self) -> Parsed<()> {
        self.expect_word("causality")?;
        self.end_statement("");
        Ok(())
    }

    /// `joint NAME: KIND AXES (a.P -> b.Q) { ... }`
    fn joint(&mut self) -> Parsed<Joint> {
        self.advance();
        let name = self.declared("the joint")?;
        self.expect(":")?;
        let kind = self.joint_kind()?;
        let ends = self.ends()?;
        let mut joint = Joint {
            name,
            kind,
            ends,
            stiffness: None,
            damping: None,
            tilt_stiffness: None,
            tilt_damping: None,
            clearance: None,
            length: None,
            play: PressLaw::default(),
            inertial: false,
            rigid: false,
        };
        let (mut inertial, mut rigid) = (None, None);
        self.block_or_semicolon(&JOINT, |entry| {
            if entry.word() == Some("frame") {
                return entry.inertial_frame(&mut inertial);
            }
            if entry.word() == Some("rigid") {
                return entry.rigid_clause(&mut rigid);
            }
            let mut slots = vec![
                ("stiffness", &mut joint.stiffness),
                ("damping", &mut joint.damping),
                ("tilt stiffness", &mut joint.tilt_stiffness),
                ("tilt damping", &mut joint.tilt_damping),
                ("clearance", &mut joint.clearance),
                ("length", &mut joint.length),
            ];
            slots.extend(joint.play.play_mut());
            entry.setting(&mut slots)
        });
        joint.inertial = inertial.is_some();
        joint.rigid = rigid.is_some();
        Ok(joint)
    }

    /// `rigid;`
    fn rigid_clause(&mut self, slot: &mut Option<()>) -> Parsed<()> {
        let span = self.advance();
        self.fill(slot, (), "rigid", span);
        self.end_statement("");
        Ok(())
    }

    /// `frame inertial;`
    fn inertial_frame(&mut self, slot: &mut Option<()>) -> Parsed<()> {
        let span = self.advance();
        self.expect_word("inertial")?;
        self.fill(slot, (), "frame", span);
        self.end_statement("");
        Ok(())
    }

    /// `revolute z`, `universal x y`, `spherical`
    fn joint_kind(&mut self) -> Parsed<JointKind> {
        let Some(word) = self.word().map(str::to_owned) else { return Err(self.unexpected("a joint kind")) };
        if !JOINTS.contains(&word.as_str()) {
            let fault = SyntaxFault::UnknownKind { what: "a joint kind", word, known: JOINTS };
            return Err(self.note(self.span(), &fault));
        }
        let span = self.advance_word();
        Ok(match word.as_str() {
            "revolute" => JointKind::Revolute(self.axis(&word, span)?),
            "prismatic" => JointKind::Prismatic(self.axis(&word, span)?),
            "cylindrical" => JointKind::Cylindrical(self.axis(&word, span)?),
            "universal" => {
                let first = self.axis(&word, span)?;
                JointKind::Universal(first, self.axis(&format!("{word} {}", word_of(&AXES, &first)), span)?)
            }
            "spherical" => JointKind::Spherical,
            _ => JointKind::Fixed,
        })
    }

    /// The axis after the word `of`, which stands at `span`.
    pub fn axis(&mut self, of: &str, span: Span) -> Parsed<Axis> {
        let axis = self.word().and_then(|word| value_of(&AXES, word));
        let Some(axis) = axis else {
            let at = if self.word().is_some() { self.span() } else { span };
            return Err(self.note(at, &SyntaxFault::MissingAxis { of: of.into(), found: self.found() }));
        };
        self.advance();
        Ok(axis)
    }

    /// `(a.P -> b.Q)`
    fn ends(&mut self) -> Parsed<Ends> {
        let mut inner = self.group(Delimiter::Parenthesis, "`(a.P -> b.Q)`", &ENDS)?;
        let ends = inner.both_ends()?;
        inner.finish("`)`")?;
        Ok(ends)
    }

    /// `a.P -> b.Q`
    fn both_ends(&mut self) -> Parsed<Ends> {
        let from = self.name("the first end")?;
        self.expect("->")?;
        Ok(Ends { from, to: self.name("the second end")? })
    }

    /// `{ ... }`, or `;` when there is nothing to say.
    pub fn block_or_semicolon(&mut self, place: &'static Block, statement: impl FnMut(&mut Self) -> Parsed<()>) {
        match self.enter(Delimiter::Brace, place) {
            Some(mut block) => block.statements(statement),
            None => self.end_statement("`{ ... }`"),
        }
    }

    /// `WORD E;` for one of the slots, whose clauses may have several words.
    pub fn setting(&mut self, slots: &mut [Slot]) -> Parsed<()> {
        let ahead = |clause: &str| clause.split(' ').enumerate().all(|(i, word)| self.word_ahead(i) == Some(word));
        let Some((clause, slot)) = slots.iter_mut().find(|(clause, _)| ahead(clause)) else {
            return Err(self.unknown_statement());
        };
        let span = self.span();
        for _ in clause.split(' ') {
            self.advance();
        }
        let value = self.expression()?;
        self.fill(slot, value, clause, span);
        self.end_statement(OPERATOR);
        Ok(())
    }

    /// `spring NAME (a.P -> b.Q) { ... }`
    fn spring(&mut self) -> Parsed<Spring> {
        self.advance();
        let name = self.declared("the spring")?;
        let ends = self.ends()?;
        let mut spring = Spring { name, ends, stiffness: None, damping: None, length: None };
        self.block_or_semicolon(&SPRING, |entry| {
            entry.setting(&mut [
                ("stiffness", &mut spring.stiffness),
                ("damping", &mut spring.damping),
                ("length", &mut spring.length),
            ])
        });
        Ok(spring)
    }

    /// `drive NAME on TARGET torque = E;`
    fn drive(&mut self) -> Parsed<Drive> {
        self.advance();
        let name = self.declared("the drive")?;
        self.expect_word("on")?;
        let target = self.name("the drive's target")?;
        let kind = self.drive_kind()?;
        self.expect("=")?;
        let value = self.expression()?;
        let mut drive = Drive { name, target, kind, value, stiffness: None, damping: None };
        if kind == DriveKind::Speed {
            self.coupling(&mut drive);
        } else if self.delimiter() == Some(Delimiter::Brace) {
            return Err(self.unexpected("`;`, since only a speed drive has a coupling"));
        } else {
            self.end_statement(OPERATOR);
        }
        Ok(drive)
    }

    /// `torque`, `force` or `speed`
    fn drive_kind(&mut self) -> Parsed<DriveKind> {
        let Some(word) = self.word().map(str::to_owned) else {
            return Err(self.unexpected("`torque`, `force` or `speed`"));
        };
        let Some(kind) = value_of(&DRIVES, &word) else {
            let fault = SyntaxFault::UnknownKind { what: "what a drive prescribes", word, known: DRIVE_WORDS };
            return Err(self.note(self.span(), &fault));
        };
        self.advance();
        Ok(kind)
    }

    /// `{ stiffness E; damping E; }`, or `;`
    fn coupling(&mut self, drive: &mut Drive) {
        self.block_or_semicolon(&DRIVE, |entry| {
            entry.setting(&mut [("stiffness", &mut drive.stiffness), ("damping", &mut drive.damping)])
        });
    }

    /// `contact NAME (a.P -> b.Q along x) { ... }`, `contact NAME (a.P circle E -> b.Q line x) { ... }`
    fn contact(&mut self) -> Parsed<Item> {
        self.advance();
        let name = self.declared("the contact")?;
        let mut inner =
            self.group(Delimiter::Parenthesis, "`(a.P -> b.Q along x)` or `(a.P circle 0.1 -> b.Q line x)`", &ENDS)?;
        let from = inner.name("the first end")?;
        let first = inner.touching()?;
        inner.expect("->")?;
        let ends = Ends { from, to: inner.name("the second end")? };
        let second = inner.touching()?;
        if first.is_some() || second.is_some() {
            inner.finish("`)`")?;
            let shapes = [first, second].map(|shape| shape.unwrap_or(Touching::Point));
            return Ok(Item::ShapeContact(self.shape_contact(name, ends, shapes)));
        }
        if inner.ended() {
            return Err(inner.unexpected("`along x` or a shape such as `circle 0.1`"));
        }
        let word = inner.expect_word("along")?;
        let along = inner.axis("along", word)?;
        inner.finish("`)`")?;
        let mut laws = Vec::new();
        let mut block = self.group(Delimiter::Brace, "`{ ... }`", &CONTACT)?;
        block.statements(|entry| entry.axis_laws(&mut laws));
        Ok(Item::Contact(Contact { name, ends, along, laws }))
    }

    /// `circle E`, `line x`, `profile TABLE`; none where there is no shape.
    fn touching(&mut self) -> Parsed<Option<Touching>> {
        let Some(word) = self.word().map(str::to_owned).filter(|word| word != "along") else { return Ok(None) };
        if !SHAPES.contains(&word.as_str()) {
            let fault = SyntaxFault::UnknownKind { what: "a shape", word, known: SHAPES };
            return Err(self.note(self.span(), &fault));
        }
        let span = self.advance_word();
        Ok(Some(match word.as_str() {
            "circle" => Touching::Circle(self.expression()?),
            "hole" => Touching::Hole(self.expression()?),
            "sphere" => Touching::Sphere(self.expression()?),
            "line" => Touching::Line(self.axis(&word, span)?),
            "plane" => Touching::Plane(self.axis(&word, span)?),
            "segment" => Touching::Segment(self.axis(&word, span)?, self.expression()?),
            "slot" => {
                let (axis, length) = (self.axis(&word, span)?, self.expression()?);
                self.expect_word("width")?;
                Touching::Slot(axis, [length, self.expression()?])
            }
            "arc" => {
                let radius = self.expression()?;
                self.expect_word("from")?;
                let from = self.expression()?;
                self.expect_word("to")?;
                Touching::Arc([radius, from, self.expression()?])
            }
            _ => Touching::Profile(self.name("the table of the profile")?),
        }))
    }

    /// `{ stiffness E; ... }` of a contact of shapes.
    fn shape_contact(&mut self, name: Name, ends: Ends, shapes: [Touching; 2]) -> ShapeContact {
        let mut contact = ShapeContact { name, ends, shapes, law: PressLaw::default(), rigid: false };
        let mut rigid = None;
        self.block_or_semicolon(&SHAPE_CONTACT, |entry| match entry.word() {
            Some("rigid") => entry.rigid_clause(&mut rigid),
            _ => entry.setting(&mut contact.law.clauses_mut()),
        });
        contact.rigid = rigid.is_some();
        contact
    }

    /// `y: C = E, R(v) = E;`
    fn axis_laws(&mut self, laws: &mut Vec<AxisLaw>) -> Parsed<()> {
        let Some(axis) = self.word().and_then(|word| value_of(&AXES, word)) else {
            return Err(self.unknown_statement());
        };
        self.advance();
        self.expect(":")?;
        loop {
            laws.push(self.axis_law(axis)?);
            if self.eat(",").is_none() {
                break;
            }
        }
        self.end_statement("an operator, `,`");
        Ok(())
    }

    /// `R(v) = E`
    fn axis_law(&mut self, axis: Axis) -> Parsed<AxisLaw> {
        let kind = match self.word() {
            Some("C") => ElementKind::C,
            Some("R") => ElementKind::R,
            Some(word) => {
                let fault =
                    SyntaxFault::UnknownKind { what: "a contact's law", word: word.into(), known: CONTACT_LAWS };
                return Err(self.note(self.span(), &fault));
            }
            None => return Err(self.unexpected("`C` or `R`")),
        };
        let span = self.advance();
        let variable = self.law_variable()?;
        self.expect("=")?;
        let law = self.expression()?;
        Ok(AxisLaw { axis, kind, variable, law, span })
    }
}
