//! Orifices as a mechanism word.
//!
//! In: `ast::Orifice`. Out: an R at its junction, q = c a sqrt(2 / rho) root(p, l), the law of a sharp edge, linear
//! where the flow is laminar. Source: Modelica Standard Library, `Modelica.Fluid.Utilities.regRoot`.

use super::{Expansion, MechanismFault};
use crate::source::ast::{Expression, Orifice};
use crate::source::clause::{Allowed, Clause, Given};

impl Expansion<'_> {
    /// Expands an orifice; every clause is needed.
    pub(super) fn orifice(&mut self, orifice: &Orifice) {
        let (name, span) = (&orifice.name.text, orifice.name.span);
        let clauses = [
            ("area", "m^2", &orifice.area, Given::Free, Allowed::NotNegative),
            ("coefficient", "1", &orifice.coefficient, Given::Free, Allowed::NotNegative),
            ("density", "kg/m^3", &orifice.density, Given::Constant, Allowed::Positive),
            ("laminar", "Pa", &orifice.laminar, Given::Constant, Allowed::Positive),
        ];
        for (clause, unit, value, given, allowed) in clauses {
            self.orifice_clause(orifice, (clause, unit), value.as_ref(), (given, allowed));
        }
        if clauses.iter().all(|(_, _, value, ..)| value.is_some()) {
            let law = format!("{name}.coefficient * {name}.area * sqrt(2 / {name}.density) * root(p, {name}.laminar)");
            self.text(span, &format!("R {name}(effort p) = {law};"));
            self.text(orifice.target.span, &format!("{} -> {name};", orifice.target.text));
        }
    }

    fn orifice_clause(
        &mut self,
        orifice: &Orifice,
        (clause, unit): (&'static str, &str),
        value: Option<&Expression>,
        (given, allowed): (Given, Allowed),
    ) {
        let name = &orifice.name.text;
        let Some(value) = value else {
            let (word, name, why) = ("orifice", name.clone(), "its law needs it");
            self.fault(orifice.name.span, &MechanismFault::MissingClause { word, name, clause, why });
            return;
        };
        let words = Clause::new(format!("the `{clause}` of orifice `{name}`"), 1).given(given).allowed(allowed);
        self.bind(&format!("{name}.{clause}"), unit, value, words);
    }
}
