//! What went and why.
//!
//! In: what each reduction did. Out: a line a state, and the size of the model after each reduction.

use std::collections::BTreeSet;

use crate::expr::Id;
use crate::system::equations::{State, StateEquations};

/// What became of a state.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Fate {
    /// It is integrated.
    Integrated,
    /// It only adds up an output; nothing depends on it.
    Quadrature,
    /// Its rate vanishes, so it keeps its start value.
    Constant(String),
    /// It stays equal to another one, or to its negative.
    Equal(String),
    /// It stays an affine combination of others.
    Recovered(String),
    /// This joint determines it from others.
    Joined(String),
    /// This joint closes a loop and gives it from others, by a root.
    Closed(String),
    /// It reaches no output.
    Unwatched,
}

impl std::fmt::Display for Fate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integrated => f.write_str("integrated"),
            Self::Quadrature => f.write_str("integrated, for an output only"),
            Self::Constant(value) => {
                write!(f, "constant: its rate is zero while the constants hold, so it stays {value}")
            }
            Self::Equal(other) => write!(f, "equal: it starts as {other} and has its rate"),
            Self::Recovered(value) => write!(f, "recovered: its rate is that of {value}"),
            Self::Joined(joint) => write!(f, "joined: the rigid joint `{joint}` gives it from others"),
            Self::Closed(joint) => {
                write!(f, "closed: the rigid joint `{joint}` closes a loop and gives it from others")
            }
            Self::Unwatched => f.write_str("unwatched: no output and no other state depends on it"),
        }
    }
}

/// The size of the model after a reduction.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Count {
    /// The reduction.
    pub stage: &'static str,
    /// States left.
    pub states: usize,
    /// Operations of the rate function, where they are counted.
    pub operations: Option<usize>,
}

/// Why the rows of rigid joints are not solved for momenta and positions of bodies.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Kept {
    /// The scene says so.
    Asked,
    /// No joint is rigid.
    NothingRigid,
    /// Baumgarte's terms keep the joints closed.
    Baumgarte,
    /// No row gives the momentum of a body by those of others with a pivot that cannot vanish.
    NoPivot,
    /// Joints that close loops may hold all that is left, or what other joints hold.
    Immobile,
    /// Joints that close loops share their reactions with others, of which an output shows one.
    Shared,
    /// The start velocities of this joint may not fit.
    Start(String),
    /// A reaction changes what is no momentum.
    Load,
    /// A rate would take so many operations; it takes the second number.
    Costs(usize, usize),
}

impl std::fmt::Display for Kept {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Asked => f.write_str("the scene says `all reactions;`"),
            Self::NothingRigid => f.write_str("no joint is rigid"),
            Self::Baumgarte => f.write_str("`baumgarte` keeps the joints closed"),
            Self::NoPivot => {
                f.write_str("no rigid joint gives the momentum of a body by those of others in every pose")
            }
            Self::Immobile => f.write_str("joints that close loops may hold all motions that are left"),
            Self::Shared => {
                f.write_str("several directions close loops, and an output shows a reaction that they may share")
            }
            Self::Start(joint) => write!(f, "start velocities may tear joint `{joint}`"),
            Self::Load => f.write_str("a reaction of a rigid joint acts on something else than momenta"),
            Self::Costs(by_speeds, before) => {
                write!(f, "a rate would take some {by_speeds} operations in place of {before}")
            }
        }
    }
}

/// What became of every state of the literal model.
#[derive(Clone, Debug)]
pub struct Report {
    /// Every state in the literal order with what became of it.
    pub fates: Vec<(State, Fate)>,
    /// The model's size after each reduction.
    pub counts: Vec<Count>,
    /// The rates of which the last count is, in the equations' pool.
    pub(super) counted: Vec<Id>,
    /// Why all joints have kept their reactions, where they have.
    pub kept: Option<Kept>,
    /// The orientations that loops give.
    pub closed: BTreeSet<String>,
    /// For each state still there its index in `fates`.
    left: Vec<usize>,
}

impl Report {
    pub(super) fn new(equations: &StateEquations) -> Self {
        let fates: Vec<(State, Fate)> =
            equations.states.iter().map(|state| (state.clone(), Fate::Integrated)).collect();
        let left = (0..fates.len()).collect();
        Self { fates, counts: Vec::new(), counted: Vec::new(), kept: None, closed: BTreeSet::new(), left }
    }

    /// Notes the size of the model.
    pub(super) fn count(&mut self, stage: &'static str, states: usize, operations: Option<usize>) {
        self.counts.push(Count { stage, states, operations });
    }

    /// Says what became of a state that is still there.
    pub(super) fn say(&mut self, state: usize, fate: Fate) {
        self.fates[self.left[state]].1 = fate;
    }

    /// A state that is still there has become another one.
    pub(super) fn rename(&mut self, state: usize, as_state: State) {
        self.fates[self.left[state]].0 = as_state;
    }

    /// States went: only those with `kept` are still there.
    pub(super) fn keep(&mut self, kept: &[bool]) {
        let left = std::mem::take(&mut self.left);
        self.left = left.into_iter().zip(kept).filter(|(_, kept)| **kept).map(|(state, _)| state).collect();
    }

    /// The number of states that are integrated, those that only add up an output apart.
    #[must_use]
    pub fn integrated(&self) -> usize {
        self.fates.iter().filter(|(_, fate)| *fate == Fate::Integrated).count()
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let of = |wanted: fn(&Fate) -> bool| self.fates.iter().filter(|(_, fate)| wanted(fate)).count();
        let where_any = |count: usize, word: &str| if count == 0 { String::new() } else { format!(" {count} {word};") };
        let joined = where_any(of(|fate| matches!(fate, Fate::Joined(_))), "joined");
        let closed = where_any(of(|fate| matches!(fate, Fate::Closed(_))), "closed");
        writeln!(
            f,
            "{} states: {} constant; {} equal up to sign; {} recovered;{joined}{closed} {} unwatched; {} integrated; \
            {} for outputs only",
            self.fates.len(),
            of(|fate| matches!(fate, Fate::Constant(_))),
            of(|fate| matches!(fate, Fate::Equal(_))),
            of(|fate| matches!(fate, Fate::Recovered(_))),
            of(|fate| *fate == Fate::Unwatched),
            self.integrated(),
            of(|fate| *fate == Fate::Quadrature),
        )?;
        for Count { stage, states, operations } in &self.counts {
            let counted = operations.map_or_else(String::new, |count| format!(", {count} operations a rate"));
            writeln!(f, "  {stage}: {states} states{counted}")?;
        }
        if let Some(kept) = self.kept.as_ref().filter(|kept| **kept != Kept::NothingRigid) {
            writeln!(f, "  the reactions of all rigid joints are kept: {kept}")?;
        }
        self.fates.iter().try_for_each(|(state, fate)| writeln!(f, "  {}: {fate}", state.name))
    }
}

/// An expression of the equations as text.
pub(super) fn show(equations: &StateEquations, id: Id) -> String {
    equations.shown(&equations.pool, id)
}
