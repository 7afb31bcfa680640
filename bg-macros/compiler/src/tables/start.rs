//! What the start of a model is checked against.
//!
//! In: a [`Compiled`]. Out: its gaps, its unknown velocities, what is asked of values.

use crate::expr::Symbol;
use crate::pipeline::Compiled;
use crate::system::requirements;

/// What a start is checked against, and what may move.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// How many unknowns there are.
    pub unknowns: usize,
    /// The gaps to be closed.
    pub gaps: Vec<Gap>,
    /// The unknowns that are velocities.
    pub speeds: Vec<usize>,
    /// What is asked of the closed pose.
    pub required: Vec<Requirement>,
    /// How many roots have a side.
    pub sides: usize,
    /// Whether impulses of the rigid joints make velocities fit.
    pub impulse: bool,
}

/// A component of the gap of a joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gap {
    /// The joint.
    pub joint: String,
    /// The component; empty of a scalar.
    pub component: &'static str,
    /// `m` or `rad`.
    pub unit: String,
}

/// What is asked of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// The value in words.
    pub subject: String,
    /// What is asked of it.
    pub wanted: &'static str,
    /// The unit where the scalar is the value itself.
    pub unit: Option<String>,
    /// Whether 0 is too little.
    pub is_strict: bool,
    /// The parameters that it depends on.
    pub parameters: Vec<String>,
}

/// What the start of a model is checked against.
#[must_use]
pub fn start(model: &Compiled) -> Start {
    let equations = &model.equations;
    let gaps = equations.assembly.gaps.iter();
    let gaps = gaps.map(|gap| Gap { joint: gap.joint.clone(), component: gap.component, unit: gap.unit.clone() });
    Start {
        unknowns: equations.assembly.guesses.len(),
        gaps: gaps.collect(),
        speeds: equations.assembly.speeds.clone(),
        required: requirements(model, true),
        sides: equations.assembly.sides.len(),
        impulse: equations.assembly.impulse,
    }
}

/// What is asked of values, where parameters alone decide or at the start.
#[must_use]
pub fn requirements(model: &Compiled, is_of_start: bool) -> Vec<Requirement> {
    let all = &model.equations.requirements;
    all.of(is_of_start).map(|requirement| self::requirement(model, requirement)).collect()
}

fn requirement(model: &Compiled, of: &requirements::Requirement) -> Requirement {
    let equations = &model.equations;
    let symbols = equations.requirements.pool.symbols(&[of.value]);
    let parameters = symbols.into_iter().filter_map(|symbol| match symbol {
        Symbol::Parameter(index) => Some(equations.parameters[index as usize].name.text.clone()),
        _ => None,
    });
    Requirement {
        subject: of.subject.clone(),
        wanted: of.wanted,
        unit: of.unit.clone(),
        is_strict: of.is_strict,
        parameters: parameters.collect(),
    }
}
