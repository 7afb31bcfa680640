//! The static description of a model: what it consists of, as tables that a program and a reader can use.

use crate::model::drawing::Drawing;

/// A model's tables. All texts are those of its source; units are SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The graph's name.
    pub name: &'static str,
    /// Its documentation comment.
    pub doc: &'static str,
    /// The graph in bond-graph words: what the mechanism words stand for.
    pub graph: &'static str,
    /// What a scene left out, state by state, with the reason; empty for the literal model of a graph.
    pub reduction: &'static str,
    /// Parameters in the order of declaration.
    pub parameters: &'static [ParameterInfo],
    /// Inputs in the order of declaration.
    pub inputs: &'static [InputInfo],
    /// States in the order of the state vector.
    pub states: &'static [StateInfo],
    /// Scalar outputs in the order of the output vector.
    pub outputs: &'static [OutputInfo],
    /// Switches in the order of the guards.
    pub switches: &'static [SwitchInfo],
    /// The mechanism words that elements and junctions stand for, the ground first.
    pub parts: &'static [PartInfo],
    /// Elements and junctions.
    pub elements: &'static [ElementInfo],
    /// Bonds with their causal strokes.
    pub bonds: &'static [BondInfo],
    /// The equations in the order of evaluation, one line each.
    pub equations: &'static [&'static str],
    /// The number of operations of each generated function.
    pub operations: &'static [(&'static str, OperationCount)],
    /// What pictures show beside the outputs.
    pub drawing: Drawing,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Its name.
    pub name: &'static str,
    /// Its unit, as written.
    pub unit: &'static str,
    /// Its default value.
    pub default: f64,
    /// Its documentation comment.
    pub doc: &'static str,
    /// The range that is allowed.
    pub range: Range,
}

/// An interval of allowed values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The lower end; minus infinity when there is none.
    pub lower: f64,
    /// Whether the lower end itself is allowed.
    pub lower_included: bool,
    /// The upper end; infinity when there is none.
    pub upper: f64,
    /// Whether the upper end itself is allowed.
    pub upper_included: bool,
}

/// An input: a function of time given at run time.
#[derive(Clone, Debug, PartialEq)]
pub struct InputInfo {
    /// Its name.
    pub name: &'static str,
    /// Its unit, as written.
    pub unit: &'static str,
    /// Its documentation comment.
    pub doc: &'static str,
}

/// A state variable. A storage in derivative causality has none.
#[derive(Clone, Debug, PartialEq)]
pub struct StateInfo {
    /// Its name, such as `rod.mass.p_x`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub kind: StateKind,
    /// The element that stores it, or the junction that it follows; empty for an integral and for an angle that counts
    /// turns.
    pub element: &'static str,
}

/// What a state is; of a vector or a matrix, which component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// The momentum of an I: component 0, 1 or 2; 0 of a scalar one.
    Momentum(usize),
    /// The displacement of a C: component 0, 1 or 2; 0 of a scalar one.
    Displacement(usize),
    /// A coordinate of a position, m: axis 0, 1 or 2.
    Position(usize),
    /// A component of an orientation matrix: row and column, each 0, 1 or 2.
    Orientation(usize, usize),
    /// The angle of a body that turns about one axis, rad.
    Angle,
    /// The displacement of a scalar 1-junction, or the angle of a joint or body, rad, with its turns: where a law or an
    /// output reads it.
    Way,
    /// The integral that an output asks for, or a state of the graph's own.
    Integral,
}

impl StateKind {
    /// What stores it, as tables show it: `I`, `C`, `position`, `orientation`, `angle`, `way` or `integral`.
    #[must_use]
    pub const fn storage(self) -> &'static str {
        match self {
            Self::Momentum(_) => "I",
            Self::Displacement(_) => "C",
            Self::Position(_) => "position",
            Self::Orientation(..) => "orientation",
            Self::Angle => "angle",
            Self::Way => "way",
            Self::Integral => "integral",
        }
    }
}

/// A scalar output.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputInfo {
    /// Its name, such as `C2_x` or `R2_11`.
    pub name: &'static str,
    /// What it is a component of, such as `C2` or `R2`; of a scalar the same as its name.
    pub of: &'static str,
    /// What this observes, as written, with the names of parts in full: `rod.position`, `valve.effort`.
    pub observes: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

/// A switch of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct SwitchInfo {
    /// The comparison as written and where, such as ``if v < 0` of `valve``.
    pub name: &'static str,
    /// The element whose law switches, or the `let` or output that does.
    pub element: &'static str,
    /// The guard as text; below zero the law's first branch holds.
    pub guard: &'static str,
}

/// A mechanism word: what a group of elements and junctions stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartInfo {
    /// What it is: `ground`, `body`, `contact`, `spring`, `drive`, or a joint's kind with its axes, such as `revolute
    /// z`.
    pub word: &'static str,
    /// Its name.
    pub name: &'static str,
}

/// An element or a junction.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementInfo {
    /// `0`, `1`, `Se`, `Sf`, `I`, `C`, `R`, `TF`, `GY` or a modulated one.
    pub kind: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its constitutive law as text; empty for a junction.
    pub law: &'static str,
    /// The name of the mechanism word that it is a part of; empty for one written in bond-graph words.
    pub part: &'static str,
}

/// A bond.
#[derive(Clone, Debug, PartialEq)]
pub struct BondInfo {
    /// Where the half arrow starts.
    pub from: &'static str,
    /// Where the half arrow points; power is positive in this direction.
    pub to: &'static str,
    /// 1 for a scalar bond, 3 for a multibond of three.
    pub cardinality: usize,
    /// The end with the causal stroke: the one that receives the effort and gives the flow.
    pub stroke: BondEnd,
    /// Unit of the effort.
    pub effort: &'static str,
    /// Unit of the flow.
    pub flow: &'static str,
}

/// One of a bond's two ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BondEnd {
    /// The end where the half arrow starts.
    From,
    /// The end the half arrow points to.
    To,
}

/// The operations of one generated function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct OperationCount {
    /// Additions, subtractions and negations.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Elementary functions.
    pub functions: usize,
    /// Choices between two branches.
    pub choices: usize,
}

impl OperationCount {
    /// No operation.
    pub const NONE: Self = Self { additions: 0, multiplications: 0, divisions: 0, functions: 0, choices: 0 };

    /// These and others.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self {
            additions: self.additions + other.additions,
            multiplications: self.multiplications + other.multiplications,
            divisions: self.divisions + other.divisions,
            functions: self.functions + other.functions,
            choices: self.choices + other.choices,
        }
    }

    /// So many times these.
    #[must_use]
    pub const fn times(self, factor: usize) -> Self {
        Self {
            additions: self.additions * factor,
            multiplications: self.multiplications * factor,
            divisions: self.divisions * factor,
            functions: self.functions * factor,
            choices: self.choices * factor,
        }
    }

    /// All operations.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.additions + self.multiplications + self.divisions + self.functions + self.choices
    }
}
