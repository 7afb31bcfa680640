//! The law of what pushes and never pulls: of contacts of shapes and of joints with a clearance.
//!
//! In: the clauses of a [`PressLaw`]. Out: on a junction whose flow is the rate of a distance a C and, with damping, an
//! R, which act where the distance is below zero. With the depth d and its rate v the force is
//! - k d + c v with a `damping` c;
//! - k d^n (1 + 3/2 a v) with a `dissipation` a (K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted
//!   as damping in vibroimpact, ASME J. Applied Mechanics 42 (1975) 440-445);
//! - k d^n (1 + x v / u) with a `restitution` e, where u is the speed of approach at the instant of touching (H. M.
//!   Lankarani, P. E. Nikravesh, A contact force model with hysteresis damping for impact analysis of multibody
//!   systems, ASME J. Mechanical Design 112 (1990) 369-376). They take x = 3 (1 - e^2) / 4, which gives back e near 1
//!   only. Here x is the root above 0 of ln((1 + x) / (1 - e x)) = x (1 + e), with which two bodies alone part with e
//!   times u whatever their masses are: the integral of v / (1 + x v / u) dv from u to -e u, which the depth gives,
//!   vanishes.
//!
//! What is rigid has a residual sink that acts one way only, as a stop with a restitution.

use super::{Expansion, MechanismFault};
use crate::source::ast::{Expression, Name, PressLaw};
use crate::source::clause::{Allowed, Clause, Given};

/// The depth below which a law with an exponent is smooth, m.
const NEAR: &str = "1e-10";

/// The speed of approach below which what hits counts as that fast, unless it is given, m/s.
const SLOW: &str = "0.01 m/s";

/// Newton steps from x = (1 - e^2) / e on, after which rounding is left for e from 0.01 to 0.999.
const STEPS: usize = 6;

impl Expansion<'_> {
    /// Binds the clauses of a law; false where one is missing.
    pub(super) fn press_clauses(&mut self, word: &'static str, name: &Name, law: &PressLaw) -> bool {
        if law.stiffness.is_none() {
            let (clause, why) = ("stiffness", "the shapes give way where they touch");
            self.fault(name.span, &MechanismFault::MissingClause { word, name: name.text.clone(), clause, why });
        }
        self.press_clause((word, name), ("stiffness", "N/m"), law.stiffness.as_ref(), Allowed::NotNegative);
        self.press_clause((word, name), ("damping", "N*s/m"), law.damping.as_ref(), Allowed::NotNegative);
        self.press_options(word, name, law);
        law.stiffness.is_some()
    }

    /// Binds the clauses of what does not give way; false where one is missing or cannot be there.
    pub(super) fn rigid_clauses(&mut self, word: &'static str, name: &Name, law: &PressLaw) -> bool {
        let text = &name.text;
        let faults = self.faults.len();
        for (clause, value) in [
            ("stiffness", &law.stiffness),
            ("exponent", &law.exponent),
            ("damping", &law.damping),
            ("dissipation", &law.dissipation),
        ] {
            let Some(value) = value else { continue };
            let why = "what is `rigid` does not give way";
            self.fault(value.span, &MechanismFault::SuperfluousClause { word, name: text.clone(), clause, why });
        }
        if law.restitution.is_none() {
            let (clause, why) = ("restitution", "what is rigid parts with some of its speed, or with 0 of it");
            self.fault(name.span, &MechanismFault::MissingClause { word, name: text.clone(), clause, why });
        }
        self.press_clause((word, name), ("restitution", "1"), law.restitution.as_ref(), Allowed::Fraction);
        self.press_clause((word, name), ("rest", "m/s"), law.rest.as_ref(), Allowed::NotNegative);
        self.faults.len() == faults
    }

    /// The residual sink of what does not give way, on the junction `NAME.approach`, whose flow is the rate of `gap`.
    pub(super) fn rigid_press(&mut self, name: &Name, law: &PressLaw, gap: &str) {
        let (span, name) = (name.span, &name.text);
        let rest = if law.rest.is_some() { format!("rest below {name}.rest") } else { String::new() };
        self.text(
            span,
            &format!(
                "rSe {name}.stop = 0 at -{gap} restitution {name}.restitution {rest};
                 {name}.stop -> {name}.approach; let {name}.pressed: N = {name}.stop.effort;"
            ),
        );
    }

    /// Binds the clauses of a law but for its stiffness and its damping.
    pub(super) fn press_options(&mut self, word: &'static str, name: &Name, law: &PressLaw) {
        let text = &name.text;
        let lossy = [("damping", &law.damping), ("dissipation", &law.dissipation), ("restitution", &law.restitution)];
        let mut given = lossy.into_iter().filter_map(|(clause, value)| Some((clause, value.as_ref()?)));
        given.next();
        for (clause, value) in given {
            let why = "it has another of `damping`, `dissipation` and `restitution`, and only one can be there";
            self.fault(value.span, &MechanismFault::SuperfluousClause { word, name: text.clone(), clause, why });
        }
        if let (Some(rest), None) = (&law.rest, &law.restitution) {
            let (clause, why) = ("rest below", "it has no `restitution`");
            self.fault(rest.span, &MechanismFault::SuperfluousClause { word, name: text.clone(), clause, why });
        }
        let clauses = [
            ("exponent", "1", &law.exponent, Allowed::Positive),
            ("dissipation", "s/m", &law.dissipation, Allowed::NotNegative),
            ("restitution", "1", &law.restitution, Allowed::Part),
            ("rest", "m/s", &law.rest, Allowed::Positive),
        ];
        for (clause, unit, value, allowed) in clauses {
            self.press_clause((word, name), (clause, unit), value.as_ref(), allowed);
        }
    }

    fn press_clause(
        &mut self,
        (word, name): (&str, &Name),
        (clause, unit): (&str, &str),
        value: Option<&Expression>,
        allowed: Allowed,
    ) {
        let Some(value) = value else { return };
        let words = Clause::new(format!("the `{clause}` of {word} `{}`", name.text), 1);
        self.bind(&format!("{}.{clause}", name.text), unit, value, words.given(Given::Constant).allowed(allowed));
    }

    /// The C and the R of a law whose clauses are bound: on the junction `PLACE.approach`, whose flow is the rate of
    /// `gap`. The place is the name itself where it touches at one only.
    pub(super) fn press(&mut self, name: &Name, law: &PressLaw, (place, gap): (&str, &str)) {
        let (span, name) = (name.span, &name.text);
        // k q (q^2 + s^2)^((n - 1) / 2): smooth where they touch, with its integral.
        let power = |by: &str| format!("pow(q * q / (1 m * 1 m) + {NEAR} * {NEAR}, ({name}.exponent {by}) / 2)");
        let (force, energy) = match &law.exponent {
            None => (format!("{name}.stiffness * q"), format!("0.5 * {name}.stiffness * q * q")),
            Some(_) => (
                format!("{name}.stiffness * q * {}", power("- 1")),
                format!(
                    "{name}.stiffness * (1 m * 1 m) * ({} - pow({NEAR}, {name}.exponent + 1)) / ({name}.exponent + 1)",
                    power("+ 1")
                ),
            ),
        };
        self.text(
            span,
            &format!(
                "C {place}.spring(q) = if q < 0 {{ {force} }} else {{ 0 }} at {gap}
                     energy if q < 0 {{ {energy} }} else {{ 0 }};
                 {place}.approach -> {place}.spring;"
            ),
        );
        let Some(damping) = self.damping_of((name, place), law, span) else {
            return self.text(span, &format!("let {place}.pressed: N = -{place}.spring.effort;"));
        };
        self.text(
            span,
            &format!(
                "MR {place}.damper(v) = if {place}.spring.q < 0 {{
                     if {place}.spring.effort + {damping} * v > 0 {{ -{place}.spring.effort }} else {{ {damping} * v }}
                 }} else {{ 0 }};
                 {place}.approach -> {place}.damper;
                 let {place}.pressed: N = -({place}.spring.effort + {place}.damper.effort);"
            ),
        );
    }

    /// The force over the speed of a law with damping, beside the depth's.
    fn damping_of(&mut self, (name, place): (&str, &str), law: &PressLaw, span: proc_macro2::Span) -> Option<String> {
        if law.damping.is_some() {
            return Some(format!("{name}.damping"));
        }
        if law.dissipation.is_some() {
            return Some(format!("(-1.5 * {name}.dissipation * {place}.spring.effort)"));
        }
        law.restitution.as_ref()?;
        // Newton's method for y = ln(1 - e x).
        let mut steps = format!("let {place}.loss_0 = 2 * ln({name}.restitution);");
        for step in 0..STEPS {
            let (before, after) = (format!("{place}.loss_{step}"), format!("{place}.loss_{}", step + 1));
            steps += &format!(
                "let {before}.rest = exp({before}); let {before}.root = (1 - {before}.rest) / {name}.restitution;
                 let {after} = {before} - ({before} - ln(1 + {before}.root) + {before}.root * (1 + {name}.restitution))
                     / (1 - {before}.rest / {name}.restitution * ((1 + {name}.restitution) - 1 / (1 + {before}.root)));"
            );
        }
        let slow = if law.rest.is_some() { format!("{name}.rest") } else { format!("({SLOW})") };
        self.text(
            span,
            &format!(
                "{steps}
                 let {place}.loss: 1 = (1 - exp({place}.loss_{STEPS})) / {name}.restitution;
                 memory {place}.meeting: 1 = -{place}.approach.flow / {slow} while {place}.spring.q > 0;
                 let {place}.impact: m/s = {slow} * {place}.meeting;
                 let {place}.hit: m/s = {slow} * sqrt(sqrt(sqrt(1 + pow({place}.meeting.kept, 8))));"
            ),
        );
        Some(format!("(-{place}.loss * {place}.spring.effort / {place}.hit)"))
    }
}
