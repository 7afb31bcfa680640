//! The variables of a unit: names, value references, what each is.
//!
//! In: a model's description. Out: its variables in the order of their value references, which count from 0 without a
//! gap: time, parameters, inputs, outputs, states, their derivatives, event indicators.

use std::collections::BTreeSet;

use bg_model::description::Description;

use crate::units;

/// What a variable is, and which of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// The time, s.
    Time,
    /// A parameter: fixed from the start on.
    Parameter(usize),
    /// An input.
    Input(usize),
    /// An output.
    Output(usize),
    /// A state.
    State(usize),
    /// The derivative of a state with respect to time.
    Derivative(usize),
    /// The guard of a switch: an event indicator.
    Guard(usize),
}

/// How many of each kind a model has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub parameters: usize,
    pub inputs: usize,
    pub outputs: usize,
    pub states: usize,
    pub guards: usize,
}

/// A kind of variable, and how many of it there are.
type Row = (fn(usize) -> VariableKind, usize);

impl Counts {
    pub const fn of(description: &Description) -> Self {
        Self {
            parameters: description.parameters.len(),
            inputs: description.inputs.len(),
            outputs: description.outputs.len(),
            states: description.states.len(),
            guards: description.switches.len(),
        }
    }

    /// The kinds with their numbers, in the order of the value references.
    const fn rows(&self) -> [Row; 7] {
        [
            (|_| VariableKind::Time, 1),
            (VariableKind::Parameter, self.parameters),
            (VariableKind::Input, self.inputs),
            (VariableKind::Output, self.outputs),
            (VariableKind::State, self.states),
            (VariableKind::Derivative, self.states),
            (VariableKind::Guard, self.guards),
        ]
    }

    /// What has this value reference.
    pub fn kind(&self, reference: u32) -> Option<VariableKind> {
        let mut rest = usize::try_from(reference).ok()?;
        for (kind, count) in self.rows() {
            if rest < count {
                return Some(kind(rest));
            }
            rest -= count;
        }
        None
    }

    /// All variables.
    pub fn all(&self) -> impl Iterator<Item = VariableKind> + use<> {
        self.rows().into_iter().flat_map(|(kind, count)| (0..count).map(kind))
    }

    /// The value reference of a clock: they come after all other variables, in FMI 3.0 alone.
    pub fn clock(&self, index: usize) -> usize {
        self.rows().iter().map(|(_, count)| count).sum::<usize>() + index
    }

    /// The value reference of a variable.
    pub fn reference(&self, kind: VariableKind) -> usize {
        let first = |row: usize| self.rows()[..row].iter().map(|(_, count)| count).sum::<usize>();
        match kind {
            VariableKind::Time => 0,
            VariableKind::Parameter(index) => first(1) + index,
            VariableKind::Input(index) => first(2) + index,
            VariableKind::Output(index) => first(3) + index,
            VariableKind::State(index) => first(4) + index,
            VariableKind::Derivative(index) => first(5) + index,
            VariableKind::Guard(index) => first(6) + index,
        }
    }
}

/// The names of all variables, in the order of their value references. Inputs and outputs keep theirs, then states; a
/// parameter or state of a name that is taken gets its kind after it, as `angle_parameter`.
pub(crate) fn names(description: &Description) -> Vec<String> {
    let counts = Counts::of(description);
    let mut taken = BTreeSet::from(["time".to_owned()]);
    let mut own = |name: &str, kind: &str| {
        let mut name = name.to_owned();
        while !taken.insert(name.clone()) {
            name = format!("{name}_{kind}");
        }
        name
    };
    let inputs: Vec<String> = description.inputs.iter().map(|info| own(info.name, "input")).collect();
    let outputs: Vec<String> = description.outputs.iter().map(|info| own(info.name, "output")).collect();
    let parameters: Vec<String> = description.parameters.iter().map(|info| own(info.name, "parameter")).collect();
    let states: Vec<String> = description.states.iter().map(|info| own(info.name, "state")).collect();
    let derivatives: Vec<String> = states.iter().map(|name| own(&format!("der({name})"), "derivative")).collect();
    let guards: Vec<String> = (0..counts.guards).map(|index| own(&format!("guard[{}]", index + 1), "guard")).collect();
    let name = |kind| match kind {
        VariableKind::Time => "time".to_owned(),
        VariableKind::Parameter(index) => parameters[index].clone(),
        VariableKind::Input(index) => inputs[index].clone(),
        VariableKind::Output(index) => outputs[index].clone(),
        VariableKind::State(index) => states[index].clone(),
        VariableKind::Derivative(index) => derivatives[index].clone(),
        VariableKind::Guard(index) => guards[index].clone(),
    };
    counts.all().map(name).collect()
}

/// The names of so many clocks beside all these.
pub(crate) fn clock_names(names: &[String], clocks: usize) -> Vec<String> {
    let name = |index: usize| {
        let mut name = format!("clock[{}]", index + 1);
        while names.contains(&name) {
            name.push_str("_clock");
        }
        name
    };
    (0..clocks).map(name).collect()
}

/// The unit of a variable; none of a guard, whose law does not say.
pub(crate) fn unit(description: &Description, kind: VariableKind) -> Option<String> {
    let written = |unit: &str| if unit.is_empty() { "1".to_owned() } else { unit.to_owned() };
    match kind {
        VariableKind::Time => Some("s".to_owned()),
        VariableKind::Parameter(index) => Some(written(description.parameters[index].unit)),
        VariableKind::Input(index) => Some(written(description.inputs[index].unit)),
        VariableKind::Output(index) => Some(written(description.outputs[index].unit)),
        VariableKind::State(index) => Some(written(description.states[index].unit)),
        VariableKind::Derivative(index) => Some(units::per_second(description.states[index].unit)),
        VariableKind::Guard(_) => None,
    }
}
