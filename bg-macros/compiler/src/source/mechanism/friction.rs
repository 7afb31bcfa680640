//! Dry friction as a mechanism word.
//!
//! In: `ast::Friction`. Out: an R at the junction of the axis that it acts on. Sliding, its effort is
//! s + (h - s) exp(-(v / w)^2) + r v against the flow v: s by `coulomb`, h by `static`, w by `stribeck`, r by
//! `viscous`; at rest it holds h. With `creep c` it does not stick: the dry part is multiplied by v / sqrt(v^2 + c^2).
//! Where shapes touch in space, v is a vector in the plane of contact.
//! Source of the law: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and
//! compensation methods for the control of machines with friction, Automatica 30 (1994) 1083, equation 6.

use super::axis::FreeAxis;
use super::{Expansion, MechanismFault};
use crate::source::ast::{Expression, Friction};
use crate::source::clause::{Allowed, Clause, Given};

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
        let mut law = dry;
        if let Some(creep) = &friction.creep {
            self.friction_clause(friction, ("creep", "creep"), axis.units.flow, creep);
            law = format!("({law}) * v / sqrt({square} + {name}.creep * {name}.creep)");
        }
        if let Some(viscous) = &friction.viscous {
            self.friction_clause(friction, ("viscous", "viscous"), axis.units.resistance, viscous);
            law = format!("{law} + {name}.viscous * v");
        }
        let holds = if friction.creep.is_some() { String::new() } else { format!(" holds {holds}") };
        self.text(span, &format!("R {name}(v) = {law}{holds};"));
        self.text(friction.target.span, &format!("{} -> {name};", axis.junction));
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
        if axis.is_plane && friction.creep.is_none() {
            self.fault(
                friction.name.span,
                &missing("creep", "what touches in space slides in two directions, and does not stick"),
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

    /// Binds a clause that is not negative; speeds are above 0.
    fn friction_clause(&mut self, friction: &Friction, (word, name): (&str, &str), unit: &str, value: &Expression) {
        let is_speed = matches!(word, "stribeck" | "creep");
        let (given, allowed) =
            if is_speed { (Given::Constant, Allowed::Positive) } else { (Given::Free, Allowed::NotNegative) };
        let clause = friction_clause(friction, word).given(given).allowed(allowed);
        self.bind(&format!("{}.{name}", friction.name.text), unit, value, clause);
    }
}

fn friction_clause(friction: &Friction, word: &str) -> Clause {
    Clause::new(format!("the `{word}` of friction `{}`", friction.name.text), 1)
}
