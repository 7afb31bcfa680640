//! Springs, drives and contacts.
//!
//! In: `ast::Spring`, `ast::Drive`, `ast::Contact`. Out: bond-graph words.

use super::fault::Takes;
use super::{End, Expansion, MechanismFault, expression};
use crate::fault::near_miss;
use crate::source::ast::{
    Axis, Contact, Drive, DriveKind, Element, ElementKind, Expression, ExpressionKind, Item, Let, Name, Spring,
};
use crate::source::clause::{Allowed, Clause, Given};

impl Expansion<'_> {
    /// A spring and damper along the line between two points.
    pub(super) fn spring(&mut self, spring: &Spring) {
        let (name, span) = (&spring.name.text, spring.name.span);
        let Some((a, b)) = self.ends(&spring.name, &spring.ends) else { return };
        let Some(stiffness) = &spring.stiffness else {
            let (word, name, clause) = ("spring", name.clone(), "stiffness");
            let why = "a spring needs one";
            self.fault(span, &MechanismFault::MissingClause { word, name, clause, why });
            return;
        };
        let clause = |what: &str| Clause::new(format!("the {what} of spring `{name}`"), 1);
        self.bind(&format!("{name}.stiffness"), "N/m", stiffness, stiff(clause("stiffness")));
        match &spring.length {
            Some(length) => self.bind(&format!("{name}.length"), "m", length, clause("length").given(Given::Free)),
            None => self.text(span, &format!("let {name}.length: m = 0;")),
        }
        self.force_junction(span, name, (&a, &b), (a.arm.clone(), b.arm.clone()));
        self.draw_joint((&spring.name, "spring".to_owned()), &spring.ends, [&a.position, &b.position], false);
        self.text(
            span,
            &format!(
                "let {name}.line: m = {} - {}; let {name}.distance = norm({name}.line);
                 1 {name}.stretch: translation; MTF {name}.direction(v) = dot({name}.line, v) / {name}.distance;
                 {name}.slip -> {name}.direction -> {name}.stretch;
                 C {name}.spring = {name}.stiffness at {name}.distance - {name}.length;
                 {name}.stretch -> {name}.spring;",
                b.position, a.position
            ),
        );
        if let Some(damping) = &spring.damping {
            let clause = clause("damping").allowed(Allowed::NotNegative);
            self.bind(&format!("{name}.damping"), "N*s/m", damping, clause);
            self.text(span, &format!("R {name}.damper = {name}.damping; {name}.stretch -> {name}.damper;"));
        }
    }

    /// A sliding contact: laws along the axes of the second body at the place of the first end.
    pub(super) fn contact(&mut self, contact: &Contact) {
        let (name, span) = (&contact.name.text, contact.name.span);
        let Some((a, b)) = self.ends(&contact.name, &contact.ends) else { return };
        if contact.laws.is_empty() {
            self.fault(span, &MechanismFault::NoLaw { name: name.clone() });
        }
        self.force_junction(span, name, (&a, &b), (a.arm.clone(), b.arm_to(&a.position)));
        self.draw_joint((&contact.name, "contact".to_owned()), &contact.ends, [&a.position, &b.position], false);
        self.text(span, &format!("let {name}.gap: m = {} - {};", b.position, a.position));
        self.text(
            span,
            &format!("let {name}.speed: m/s = dot({}.{}_axis, {name}.slip.flow);", b.axes, contact.along.letter()),
        );
        let mut axes = Vec::new();
        for law in &contact.laws {
            let letter = law.axis.letter();
            let label = format!("{name}.{letter}");
            let direction = format!("{}.{letter}_axis", b.axes);
            if !axes.contains(&law.axis) {
                axes.push(law.axis);
                self.contact_axis(contact, law.axis, &b);
            }
            let (element, displacement) = match law.kind {
                ElementKind::C => {
                    let at = expression(law.span, &format!("dot({direction}, {name}.gap)"));
                    (format!("{label}_spring"), Some(at))
                }
                _ => (format!("{label}_damper"), None),
            };
            self.items.push(Item::Element(Element {
                variable: law.variable.clone(),
                displacement,
                ..Element::new(law.kind, Name::new(element.clone(), law.span), law.law.clone())
            }));
            self.text(law.span, &format!("{label} -> {element};"));
        }
        if !axes.contains(&contact.along) && self.is_braked(&format!("{name}.{}", contact.along.letter())) {
            self.contact_axis(contact, contact.along, &b);
        }
    }

    /// The junction of the motion along an axis of a contact's second body.
    fn contact_axis(&mut self, contact: &Contact, axis: Axis, b: &End) {
        let (name, letter) = (&contact.name.text, axis.letter());
        let label = format!("{name}.{letter}");
        self.text(
            contact.name.span,
            &format!(
                "1 {label}: translation; MTF {label}_axis(v) = dot({}.{letter}_axis, v);
                 {name}.slip -> {label}_axis -> {label};",
                b.axes
            ),
        );
    }

    /// A source on a joint's free axis, on a body or on a body's point.
    pub(super) fn drive(&mut self, drive: &Drive) {
        if let Some(joint) = self.joints.get(drive.target.text.as_str()) {
            let kind = joint.kind;
            let spin = kind.spin().map(|_| ("spin", "rotation"));
            let turned = spin.or(kind.turns_freely().then_some(("twist", "rotation")));
            let slid = kind.slide().map(|_| ("slide", "translation"));
            let wanted = match drive.kind {
                DriveKind::Torque => turned,
                DriveKind::Force => slid,
                DriveKind::Speed => spin.or(slid),
            };
            let takes = match (turned, slid) {
                (Some(_), _) => Takes::Torque,
                (None, Some(_)) => Takes::Force,
                (None, None) => Takes::Nothing,
            };
            match wanted {
                Some((axis, domain)) => self.drive_joint(drive, axis, domain),
                None => self.wrong_drive(drive, takes),
            }
            return;
        }
        let is_body = self.bodies.contains_key(drive.target.text.as_str());
        match drive.kind {
            DriveKind::Torque if is_body => self.drive_body(drive),
            DriveKind::Force if self.is_known(&drive.target) => self.drive_point(drive),
            _ if is_body => self.wrong_drive(drive, Takes::Torque),
            _ if self.is_known(&drive.target) => self.wrong_drive(drive, Takes::Force),
            _ => {
                let known = self.joints.keys().chain(self.bodies.keys()).copied();
                let near = near_miss(&drive.target.text, known).map(str::to_owned);
                let name = drive.target.text.clone();
                self.fault(drive.target.span, &MechanismFault::UnknownTarget { name, near });
            }
        }
    }

    fn is_known(&self, target: &Name) -> bool {
        self.bodies.contains_key(self.on_body(&target.text).0)
    }

    fn wrong_drive(&mut self, drive: &Drive, takes: Takes) {
        let what = match drive.kind {
            DriveKind::Torque => "torque",
            DriveKind::Force => "force",
            DriveKind::Speed => "speed",
        };
        let target = drive.target.text.clone();
        self.fault(drive.target.span, &MechanismFault::WrongDrive { drive: what, target, takes });
    }

    /// The source's word: modulated where its value is more than parameters, inputs and time.
    fn source(&mut self, drive: &Drive, effort: bool) {
        let given = self.source.items.iter().filter_map(|item| match item {
            Item::Parameter(parameter) => Some(parameter.name.text.as_str()),
            Item::Input(input) => Some(input.name.text.as_str()),
            Item::Let(Let { name, clause: Some(clause), .. }) => clause.is_constant().then_some(name.text.as_str()),
            _ => None,
        });
        let given: Vec<&str> = given.chain(["t"]).collect();
        let modulated = !names(&drive.value).iter().all(|name| given.contains(&name.as_str()));
        let kind = match (effort, modulated) {
            (true, false) => ElementKind::Se,
            (true, true) => ElementKind::MSe,
            (false, false) => ElementKind::Sf,
            (false, true) => ElementKind::MSf,
        };
        self.items.push(Item::Element(Element::new(kind, drive.name.clone(), drive.value.clone())));
    }

    fn drive_joint(&mut self, drive: &Drive, axis: &str, domain: &str) {
        let (name, span, joint) = (&drive.name.text, drive.name.span, &drive.target.text);
        if drive.kind != DriveKind::Speed {
            self.source(drive, true);
            self.text(span, &format!("{name} -> {joint}.{axis};"));
            return;
        }
        let Some(stiffness) = &drive.stiffness else {
            let (word, name, clause) = ("drive", name.clone(), "stiffness");
            let why = "a prescribed speed acts on the mechanism's inertia through a compliant coupling";
            self.fault(span, &MechanismFault::MissingClause { word, name, clause, why });
            return;
        };
        let units = if domain == "rotation" { ("N*m/rad", "N*m*s/rad") } else { ("N/m", "N*s/m") };
        let clause = |what: &str| Clause::new(format!("the {what} of drive `{name}`"), 1);
        self.bind(&format!("{name}.stiffness"), units.0, stiffness, stiff(clause("stiffness")));
        self.source(drive, false);
        self.text(
            span,
            &format!(
                "0 {name}.coupling: {domain}; 1 {name}.lag: {domain};
                 {name} -> {name}.coupling -> {joint}.{axis}; {name}.coupling -> {name}.lag;
                 C {name}.spring = {name}.stiffness; {name}.lag -> {name}.spring;"
            ),
        );
        if let Some(damping) = &drive.damping {
            self.bind(&format!("{name}.damping"), units.1, damping, clause("damping").allowed(Allowed::NotNegative));
            self.text(span, &format!("R {name}.damper = {name}.damping; {name}.lag -> {name}.damper;"));
        }
    }

    fn drive_body(&mut self, drive: &Drive) {
        self.source(drive, true);
        self.text(drive.name.span, &format!("{} -> {}.rotation;", drive.name.text, drive.target.text));
    }

    fn drive_point(&mut self, drive: &Drive) {
        let (name, span) = (&drive.name.text, drive.name.span);
        let Some(End { body, arm: Some(arm), .. }) = self.end(&drive.target) else { return };
        self.source(drive, true);
        self.text(
            span,
            &format!(
                "0 {name}.linear[3]: translation; {name} -> {name}.linear -> {body}.translation;
                 MTF {name}.arm(effort f) = cross({arm}, f); {name}.linear -> {name}.arm -> {body}.rotation;"
            ),
        );
    }
}

/// What a stiffness must be.
pub(super) fn stiff(clause: Clause) -> Clause {
    clause.given(Given::State).allowed(Allowed::NotNegative)
}

/// All names in an expression.
fn names(expression: &Expression) -> Vec<String> {
    match &expression.kind {
        ExpressionKind::Number(_) | ExpressionKind::Quantity(..) => Vec::new(),
        ExpressionKind::Name(name) => vec![name.text.clone()],
        ExpressionKind::Negate(inner) => names(inner),
        ExpressionKind::Chain(first, rest) => {
            [&**first].into_iter().chain(rest.iter().map(|operation| &operation.operand)).flat_map(names).collect()
        }
        ExpressionKind::Call(_, parts) | ExpressionKind::Vector(parts) => parts.iter().flat_map(names).collect(),
        ExpressionKind::If(choice) => {
            [&choice.left, &choice.right, &choice.then, &choice.otherwise].into_iter().flat_map(names).collect()
        }
    }
}
