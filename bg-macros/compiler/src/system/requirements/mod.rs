//! What physics asks of the values that parameters and numbers give: a mass above 0, an inertia that a body can have,
//! an orientation that is a rotation.
//!
//! In: values over parameters and unknowns with what is allowed ([`Allowed`]). Out: [`Requirements`], a table of scalar
//! expressions that must be above 0, or at least 0. What is made of numbers is decided here, what the ranges of the
//! parameters prove goes; the rest is for the model's `new`, or for its `start` where unknowns of the assembly decide.

mod conditions;
mod fault;

use proc_macro2::Span;

use crate::expr::{Environment, Id, Pool, Signs, Symbol, evaluate, signs, substitute};
use crate::fault::{Fault, Staged};
use crate::graph::{Allowed, Parameter};
use crate::system::Value;

pub use fault::RequirementFault;

/// A value of which something is asked.
#[derive(Clone, Debug)]
pub struct Subject {
    /// In the user's words, such as "the mass of body `rod`".
    pub what: String,
    /// Its unit.
    pub unit: String,
    /// Where it stands.
    pub span: Span,
    /// What it may be.
    pub allowed: Allowed,
}

/// A scalar that must be above 0, or at least 0.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// The value in the user's words.
    pub subject: String,
    /// What is asked of it, such as "must be above 0".
    pub wanted: &'static str,
    /// The unit where the scalar is the value itself, so that it can be shown.
    pub unit: Option<String>,
    /// The scalar, over parameters and unknowns.
    pub value: Id,
    /// Whether 0 is too little.
    pub is_strict: bool,
    help: &'static str,
    fault: fault::Demand,
    span: Span,
    /// Requirements of one subject have the same number: the first that fails is the one to speak of.
    group: usize,
    /// Whether it is a sum that fails where its parts do, which then are the ones to speak of.
    is_total: bool,
}

/// All that is asked of a model's values, over a pool of its own, so that nothing here changes the model's expressions.
#[derive(Clone, Debug, Default)]
pub struct Requirements {
    /// The expressions.
    pub pool: Pool,
    /// What is asked, in the order in which it is checked.
    pub list: Vec<Requirement>,
    /// For each gap of the assembly how large the machine is, in the gap's unit: what is to be closed is to be small
    /// beside that.
    pub extents: Vec<Id>,
}

impl Requirements {
    /// No requirement yet, over these expressions.
    #[must_use]
    pub fn over(pool: Pool) -> Self {
        Self { pool, list: Vec::new(), extents: Vec::new() }
    }

    /// Asks of a value what is allowed for it. What depends on more than parameters and unknowns, or on comparisons, is
    /// not asked.
    pub fn ask(&mut self, subject: &Subject, value: &Value) {
        let is_given = |symbol: Symbol| matches!(symbol, Symbol::Parameter(_) | Symbol::Unknown(_));
        if !self.pool.symbols(&value.0).into_iter().all(is_given) || self.pool.has_select(&value.0) {
            return;
        }
        let group = self.list.len();
        for condition in conditions::of(&mut self.pool, value, subject.allowed) {
            let subject_words = match condition.component {
                Some(letter) => format!("the {letter} component of {}", subject.what),
                None => subject.what.clone(),
            };
            self.list.push(Requirement {
                subject: subject_words,
                wanted: condition.wanted,
                unit: condition.is_shown.then(|| subject.unit.clone()),
                value: condition.value,
                is_strict: condition.is_strict,
                help: condition.help,
                fault: condition.fault,
                span: subject.span,
                group,
                is_total: subject.allowed == Allowed::Total,
            });
        }
    }

    /// Decides what is made of numbers and drops what the ranges of the parameters prove.
    ///
    /// # Errors
    /// Values that cannot be.
    pub fn decide(&mut self, parameters: &[Parameter]) -> Staged<()> {
        let range = |symbol: Symbol| match symbol {
            Symbol::Parameter(index) => {
                let Parameter { lower, upper, .. } = &parameters[index as usize];
                Signs::between(*lower, *upper)
            }
            _ => Signs::ANY,
        };
        let mut faults = Vec::new();
        let mut failed = None;
        let pool = &self.pool;
        self.list.retain(|requirement| {
            if !pool.symbols(&[requirement.value]).is_empty() {
                let signs = signs(pool, requirement.value, &range);
                return signs.below || requirement.is_strict && signs.zero;
            }
            let value = evaluate(pool, &[requirement.value], &Environment::default())[0];
            let follows = requirement.is_total && !faults.is_empty() || failed == Some(requirement.group);
            if !requirement.holds(value) && !follows {
                failed = Some(requirement.group);
                faults.push(Fault::new(requirement.span, &RequirementFault { requirement, value }));
            }
            false
        });
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }

    /// Parameters that no one tunes become their defaults; the others keep their order.
    pub fn fold(&mut self, parameters: &[Parameter], tuned: &[bool]) {
        let mut kept = 0;
        let mut images = Vec::new();
        for (parameter, &is_tuned) in parameters.iter().zip(tuned) {
            images.push(if is_tuned {
                kept += 1;
                self.pool.symbol(Symbol::Parameter(kept - 1))
            } else {
                self.pool.number(parameter.default)
            });
        }
        let values = self.list.iter().map(|requirement| requirement.value);
        let values: Vec<Id> = values.chain(self.extents.iter().copied()).collect();
        let folded = substitute(&mut self.pool, &values, &|symbol| match symbol {
            Symbol::Parameter(index) => images.get(index as usize).copied(),
            _ => None,
        });
        let places = self.list.iter_mut().map(|requirement| &mut requirement.value).chain(&mut self.extents);
        places.zip(folded).for_each(|(place, value)| *place = value);
    }

    /// The requirements for the start, where the unknowns of the assembly are known, or those that parameters decide.
    pub fn of(&self, is_of_start: bool) -> impl Iterator<Item = &Requirement> {
        let has_unknown = |requirement: &Requirement| {
            self.pool.symbols(&[requirement.value]).iter().any(|symbol| matches!(symbol, Symbol::Unknown(_)))
        };
        self.list.iter().filter(move |requirement| has_unknown(requirement) == is_of_start)
    }
}

impl Requirement {
    /// Whether a value of the scalar is allowed; what is no number is not, nor is one so near 0 that it has no
    /// reciprocal.
    fn holds(&self, value: f64) -> bool {
        if self.is_strict && self.unit.is_some() {
            value >= f64::MIN_POSITIVE
        } else {
            value > 0.0 || value == 0.0 && !self.is_strict
        }
    }
}

#[cfg(test)]
mod tests;
