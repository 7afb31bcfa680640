//! Stops as a mechanism word.
//!
//! In: `ast::Stop`. Out: at the junction of the axis that it acts on a C, slack between the ends, and an R that damps
//! beyond them as long as the two together do not pull; with a restitution a residual sink for each end, which acts one
//! way only. The displacement of a sliding axis is the joint's travel; another one is a state, the integral of the
//! flow, from the joint's angle at the start on.

use super::axis::FreeAxis;
use super::{Expansion, MechanismFault};
use crate::source::ast::{Expression, Stop};
use crate::source::clause::{Allowed, Clause, Given};

impl Expansion<'_> {
    /// Expands a stop.
    pub(super) fn stop(&mut self, stop: &Stop) {
        let Some(axis) = self.free_axis("stop", &stop.name, &stop.target) else { return };
        self.stop_fits(stop, &axis);
        let ends = [("most", &stop.most), ("least", &stop.least)];
        for (end, value) in ends {
            self.stop_clause(stop, end, axis.units.displacement, value.as_ref(), Allowed::Any);
        }
        if stop.most.is_none() && stop.least.is_none() {
            return;
        }
        if let Some(restitution) = &stop.restitution {
            self.rebound(stop, &axis, restitution);
        } else if let Some(stiffness) = &stop.stiffness {
            self.compliant_stop(stop, &axis, stiffness);
        }
    }

    /// A stop that gives way.
    fn compliant_stop(&mut self, stop: &Stop, axis: &FreeAxis, stiffness: &Expression) {
        let (name, span) = (&stop.name.text, stop.name.span);
        self.stop_clause(stop, "stiffness", axis.units.stiffness, Some(stiffness), Allowed::NotNegative);
        self.stop_clause(stop, "start", axis.units.displacement, stop.start.as_ref(), Allowed::Any);
        let law = beyond(stop, "q", &|end| format!("{name}.stiffness * (q - {name}.{end})"));
        let energy =
            beyond(stop, "q", &|end| format!("0.5 * {name}.stiffness * (q - {name}.{end}) * (q - {name}.{end})"));
        let at = match axis.travel() {
            Some(travel) => format!("at {travel}"),
            None => start_of(stop, axis),
        };
        self.text(span, &format!("C {name}.spring(q) = {law} {at} energy {energy};"));
        self.text(stop.target.span, &format!("{} -> {name}.spring;", axis.junction));
        self.damper(stop, axis);
    }

    /// A rigid stop that gives back a part of the speed.
    fn rebound(&mut self, stop: &Stop, axis: &FreeAxis, restitution: &Expression) {
        let (name, span) = (&stop.name.text, stop.name.span);
        self.stop_clause(stop, "restitution", "1", Some(restitution), Allowed::Fraction);
        self.stop_clause(stop, "rest", axis.units.flow, stop.rest.as_ref(), Allowed::NotNegative);
        self.stop_clause(stop, "start", axis.units.displacement, stop.start.as_ref(), Allowed::Any);
        let place = axis.travel().unwrap_or_else(|| {
            let start = start_of(stop, axis);
            self.text(span, &format!("C {name}.way(q) = 0 * q {start} energy 0 * q * q;"));
            self.text(stop.target.span, &format!("{} -> {name}.way;", axis.junction));
            format!("{name}.way.q")
        });
        let unit = axis.units.displacement;
        let colon = if unit.is_empty() { "" } else { ": " };
        self.text(span, &format!("let {name}.place{colon}{unit} = {place};"));
        let rest = if stop.rest.is_some() { format!("rest below {name}.rest") } else { String::new() };
        let (mut efforts, mut powers) = (Vec::new(), Vec::new());
        if stop.most.is_some() {
            let clauses = format!("at {name}.place - {name}.most restitution {name}.restitution {rest}");
            self.text(span, &format!("rSe {name}.upper = 0 {clauses};"));
            self.text(stop.target.span, &format!("{} -> {name}.upper;", axis.junction));
            efforts.push(format!("{name}.upper.effort"));
            powers.push(format!("{name}.upper.power"));
        }
        if stop.least.is_some() {
            let clauses = format!("at {name}.least - {name}.place restitution {name}.restitution {rest}");
            self.text(span, &format!("rSe {name}.lower = 0 {clauses};"));
            self.text(stop.target.span, &format!("{name}.lower -> {};", axis.junction));
            efforts.push(format!("-{name}.lower.effort"));
            powers.push(format!("{name}.lower.power"));
        }
        let (effort, power) = (efforts.join(" + ").replace("+ -", "- "), powers.join(" + "));
        self.text(span, &format!("let {name}.effort = {effort}; let {name}.power: W = {power};"));
    }

    /// The R beyond the ends; what acts on the axis in all.
    fn damper(&mut self, stop: &Stop, axis: &FreeAxis) {
        let (name, span) = (&stop.name.text, stop.name.span);
        let Some(damping) = &stop.damping else {
            return self.text(span, &format!("let {name}.effort = {name}.spring.effort;"));
        };
        self.stop_clause(stop, "damping", axis.units.resistance, Some(damping), Allowed::NotNegative);
        let law = beyond(stop, &format!("{name}.spring.q"), &|end| {
            let pulls = if end == "most" { "<" } else { ">" };
            format!(
                "if {name}.spring.effort + {name}.damping * v {pulls} 0 {{ -{name}.spring.effort }} \
                 else {{ {name}.damping * v }}"
            )
        });
        self.text(
            span,
            &format!("MR {name}.damper(v) = {law}; let {name}.effort = {name}.spring.effort + {name}.damper.effort;"),
        );
        self.text(stop.target.span, &format!("{} -> {name}.damper;", axis.junction));
    }

    /// Reports clauses that are missing or cannot be there.
    fn stop_fits(&mut self, stop: &Stop, axis: &FreeAxis) {
        let name = &stop.name.text;
        let mut missing = |clause, why| {
            let fault = MechanismFault::MissingClause { word: "stop", name: name.clone(), clause, why };
            self.fault(stop.name.span, &fault);
        };
        if stop.stiffness.is_none() && stop.restitution.is_none() {
            missing("stiffness", "it needs one beyond its end, or a `restitution`");
        }
        if stop.least.is_none() && stop.most.is_none() {
            missing("at most", "it needs an end");
        }
        let both = [("stiffness", &stop.stiffness), ("damping", &stop.damping)];
        let both = both.into_iter().filter_map(|(clause, value)| Some((clause, value.as_ref()?)));
        for (clause, value) in both.filter(|_| stop.restitution.is_some()) {
            self.fault(value.span, &MechanismFault::RestitutionAnd { name: name.clone(), clause });
        }
        if let (Some(rest), None) = (&stop.rest, &stop.restitution) {
            let (clause, why) = ("rest below", "it has no `restitution`");
            self.fault(rest.span, &MechanismFault::SuperfluousClause { word: "stop", name: name.clone(), clause, why });
        }
        if let (Some(start), Some(_)) = (&stop.start, axis.travel()) {
            let (clause, why) = ("start", "the travel of the joint is known");
            self.fault(
                start.span,
                &MechanismFault::SuperfluousClause { word: "stop", name: name.clone(), clause, why },
            );
        }
    }

    fn stop_clause(&mut self, stop: &Stop, word: &str, unit: &str, value: Option<&Expression>, allowed: Allowed) {
        let (Some(value), name) = (value, &stop.name.text) else { return };
        let clause = Clause::new(format!("the `{word}` of stop `{name}`"), 1).given(Given::Constant).allowed(allowed);
        self.bind(&format!("{name}.{word}"), unit, value, clause);
    }
}

impl FreeAxis {
    /// The displacement that the poses of a joint determine; an angle starts again after a turn.
    fn travel(&self) -> Option<String> {
        self.joint.as_ref().filter(|_| self.slides()).map(|joint| format!("{joint}.travel"))
    }
}

/// Where the displacement of an axis begins that does not slide: at the angle of its joint, unless the stop gives it.
fn start_of(stop: &Stop, axis: &FreeAxis) -> String {
    match (&stop.start, &axis.joint) {
        (Some(_), _) => format!("start {}.start", stop.name.text),
        (None, Some(joint)) => format!("start {joint}.direction"),
        (None, None) => String::new(),
    }
}

/// A value beyond each end that there is, 0 between them.
fn beyond(stop: &Stop, place: &str, value: &dyn Fn(&str) -> String) -> String {
    let name = &stop.name.text;
    let ends = [("most", ">", &stop.most), ("least", "<", &stop.least)];
    let given = ends.into_iter().filter(|(.., end)| end.is_some());
    let branches = given.map(|(end, sign, _)| format!("if {place} {sign} {name}.{end} {{ {} }} else ", value(end)));
    branches.collect::<String>() + "{ 0 }"
}
