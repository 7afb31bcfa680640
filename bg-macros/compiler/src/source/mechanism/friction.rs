//! Dry friction as a mechanism word.
//!
//! In: `ast::Friction`. Out: an R at the junction of the axis that it acts on. Sliding, its effort is
//! s + (h - s) exp(-(v / w)^2) + r v against the flow v: s by `coulomb`, h by `static`, w by `stribeck`, r by
//! `viscous`; at rest it holds h. With `creep c` it does not stick: the dry part is multiplied by v / sqrt(v^2 + c^2).
//! Where shapes touch in space, v is a vector in the plane of contact; with `stiffness k` it sticks there by a spring:
//! a C and an R with the same effort e share v, the spring's part z' = v - e |v| / f, where f is what the friction
//! gives while it slides. At rest the spring holds, without creep; sliding, e is f along v. That is Dahl's law with its
//! energy in a C (P. R. Dahl, Solid friction damping of mechanical vibrations, AIAA Journal 14 (1976) 1675-1682).
//! Source of the law: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and
//! compensation methods for the control of machines with friction, Automatica 30 (1994) 1083, equation 6.

use super::axis::FreeAxis;
use super::{Expansion, MechanismFault};
use crate::source::ast::{Expression, Friction};
use crate::source::clause::{Allowed, Clause, Given};

/// The speed below which nothing slides, m/s: what sticks by a spring holds exactly at rest, where |v| has no slope.
const STILL: &str = "1e-9 m/s";

/// By how much of its spring's way what slides may give less than is said, m: it stays finite where what presses ends.
const SMALL: &str = "1e-10 m";

/// What presses less does not rub, N.
const LIGHT: &str = "1e-6 N";

/// How long the spring takes to relax in the air, s.
const RELAXES: &str = "1 ms";

impl Expansion<'_> {
    /// Expands a friction.
    pub(super) fn friction(&mut self, friction: &Friction) {
        let Some(axis) = self.free_axis("friction", &friction.name, &friction.target) else { return };
        let (name, span) = (&friction.name.text, friction.name.span);
        self.friction_fits(friction, &axis);
        let Some(coulomb) = &friction.coulomb else { return };
        let force = self.pressing(friction, &axis);
        let unit = if force.is_empty() { axis.units.effort } else { "1" };
        self.friction_clause(friction, ("coulomb", "coulomb"), unit, coulomb);
        let (square, part) = if axis.is_plane {
            ("dot(v, v)", format!("dot(v, v) / ({name}.stribeck * {name}.stribeck)"))
        } else {
            ("v * v", format!("pow(v / {name}.stribeck, 2)"))
        };
        let mut dry = format!("{name}.coulomb{force}");
        let mut holds = dry.clone();
        if let Some(at_rest) = &friction.at_rest {
            self.friction_clause(friction, ("static", "at_rest"), unit, at_rest);
            holds = format!("{name}.at_rest{force}");
        }
        if let Some(stribeck) = &friction.stribeck {
            self.friction_clause(friction, ("stribeck", "stribeck"), axis.units.flow, stribeck);
            dry = format!("{dry} + ({holds} - {dry}) * exp(-{part})");
        }
        if axis.is_plane && friction.stiffness.is_some() {
            return self.sticks_by_a_spring(friction, &axis, &dry);
        }
        let mut law = dry;
        if let Some(creep) = &friction.creep {
            self.friction_clause(friction, ("creep", "creep"), axis.units.flow, creep);
            law = format!("({law}) * v / sqrt({square} + {name}.creep * {name}.creep)");
        }
        if let Some(oil) = self.oil(friction, &axis) {
            law = format!("{law} + {oil} * v");
        }
        let holds = if friction.creep.is_some() { String::new() } else { format!(" holds {holds}") };
        self.text(span, &format!("R {name}(v) = {law}{holds};"));
        self.text(friction.target.span, &format!("{} -> {name};", axis.junction));
    }

    /// The friction that sticks by a spring, where `dry` is what it gives while it slides with v.
    fn sticks_by_a_spring(&mut self, friction: &Friction, axis: &FreeAxis, dry: &str) {
        let Some(stiffness) = &friction.stiffness else { return };
        let (name, span, slides) = (&friction.name.text, friction.name.span, &axis.junction);
        self.friction_clause(friction, ("stiffness", "stiffness"), axis.units.stiffness, stiffness);
        let dry = dry.replace("(v, v)", &format!("({slides}.flow, {slides}.flow)"));
        self.text(
            span,
            &format!(
                "0 {name}[3]: translation; C {name}.spring = {name}.stiffness;
                 let {name}.square = dot({slides}.flow, {slides}.flow);
                 let {name}.moves: m/s = {name}.square / sqrt({name}.square + {STILL} * {STILL});
                 let {name}.slides: N = {dry};
                 let {name}.most: N = sqrt({name}.slides * {name}.slides
                     + {name}.stiffness * {name}.stiffness * {SMALL} * {SMALL});
                 R {name}.slip(effort e) = if {name}.pressed > {LIGHT} {{ e * {name}.moves / {name}.most }}
                     else {{ e / ({name}.stiffness * {RELAXES}) + {slides}.flow }};
                 {slides} -> {name} -> {name}.spring; {name} -> {name}.slip;"
            ),
        );
        if let Some(oil) = self.oil(friction, axis) {
            self.text(span, &format!("R {name}.oil(v) = {oil} * v; {slides} -> {name}.oil;"));
        }
    }

    /// The coefficient of `viscous`, where it is given: of what touches nothing where it does not.
    fn oil(&mut self, friction: &Friction, axis: &FreeAxis) -> Option<String> {
        let (name, viscous) = (&friction.name.text, friction.viscous.as_ref()?);
        self.friction_clause(friction, ("viscous", "viscous"), axis.units.resistance, viscous);
        if axis.pressed.is_none() {
            return Some(format!("{name}.viscous"));
        }
        let text = format!("let {name}.wet: N*s/m = if {name}.pressed > {LIGHT} {{ {name}.viscous }} else {{ 0 }};");
        self.text(friction.name.span, &text);
        Some(format!("{name}.wet"))
    }

    /// Reports clauses that are missing or cannot be there.
    fn friction_fits(&mut self, friction: &Friction, axis: &FreeAxis) {
        let name = &friction.name.text;
        let missing = |clause, why| MechanismFault::MissingClause { word: "friction", name: name.clone(), clause, why };
        let superfluous =
            |clause, why| MechanismFault::SuperfluousClause { word: "friction", name: name.clone(), clause, why };
        if friction.coulomb.is_none() {
            self.fault(friction.name.span, &missing("coulomb", "it needs what it gives while it slides"));
        }
        if axis.is_plane && friction.creep.is_none() && friction.stiffness.is_none() {
            let why = "what touches in space slides in two directions: it sticks by a spring of a `stiffness`, such as \
                       `stiffness 1e6 N/m`, or creeps";
            self.fault(friction.name.span, &missing("stiffness", why));
        }
        if axis.is_rigid && friction.normal.is_none() {
            let why = "the force of a rigid contact and its friction depend on each other, and may have no solution or \
                       two (Painleve's paradox): write a `stiffness` in the place of `rigid`, or a force that is known";
            self.fault(friction.name.span, &missing("normal", why));
        }
        if let Some(stiffness) = &friction.stiffness {
            let why = match (axis.is_plane, &friction.creep) {
                (false, _) => "only what touches in space sticks by a spring, all else sticks without one",
                (true, Some(_)) => "it has a `creep`, with which it does not stick",
                (true, None) => "",
            };
            if !why.is_empty() {
                self.fault(stiffness.span, &superfluous("stiffness", why));
            }
        }
        if let (true, Some(at_rest), None) = (friction.stiffness.is_some(), &friction.at_rest, &friction.stribeck) {
            self.fault(
                at_rest.span,
                &superfluous("static", "what sticks by a spring needs a `stribeck` to fall from it"),
            );
        }
        if let Some(radius) = &friction.radius {
            if axis.slides() {
                self.fault(radius.span, &superfluous("radius", "what it acts on slides"));
            } else if friction.normal.is_none() && axis.joint.is_none() {
                self.fault(radius.span, &missing("normal", "the force at the radius is not known"));
            }
        }
        if let (Some(stribeck), None) = (&friction.stribeck, &friction.at_rest) {
            self.fault(stribeck.span, &superfluous("stribeck", "it has no `static` to fall from"));
        }
        if let (Some(at_rest), None, Some(_)) = (&friction.at_rest, &friction.stribeck, &friction.creep) {
            self.fault(at_rest.span, &superfluous("static", "with `creep` it does not stick"));
        }
    }

    /// What multiplies the coefficients: the normal force, that of the joint where it is not given, times the radius.
    fn pressing(&mut self, friction: &Friction, axis: &FreeAxis) -> String {
        let (name, span) = (&friction.name.text, friction.name.span);
        let mut force = String::new();
        if let Some(normal) = &friction.normal {
            self.bind(&format!("{name}.normal"), "N", normal, friction_clause(friction, "normal").given(Given::Free));
            // What lifts off does not rub.
            let pressed = format!("if {name}.normal < 0 {{ 0 }} else {{ {name}.normal }}");
            let pressed = if normal.number().is_some() { format!("{name}.normal") } else { pressed };
            self.text(span, &format!("let {name}.pressed: N = {pressed};"));
            force = format!(" * {name}.pressed");
        } else if let Some(pressed) = &axis.pressed {
            self.text(span, &format!("let {name}.pressed: N = {pressed};"));
            force = format!(" * {name}.pressed");
        } else if let (Some(_), Some(joint)) = (&friction.radius, &axis.joint) {
            self.text(span, &format!("let {name}.pressed: N = norm({joint}.force);"));
            force = format!(" * {name}.pressed");
        }
        if let Some(radius) = &friction.radius {
            self.friction_clause(friction, ("radius", "radius"), "m", radius);
            force = format!("{force} * {name}.radius");
        }
        force
    }

    /// Binds a clause that is not negative; speeds and a stiffness are above 0.
    fn friction_clause(&mut self, friction: &Friction, (word, name): (&str, &str), unit: &str, value: &Expression) {
        let is_speed = matches!(word, "stribeck" | "creep" | "stiffness");
        let (given, allowed) =
            if is_speed { (Given::Constant, Allowed::Positive) } else { (Given::Free, Allowed::NotNegative) };
        let clause = friction_clause(friction, word).given(given).allowed(allowed);
        self.bind(&format!("{}.{name}", friction.name.text), unit, value, clause);
    }
}

fn friction_clause(friction: &Friction, word: &str) -> Clause {
    Clause::new(format!("the `{word}` of friction `{}`", friction.name.text), 1)
}
