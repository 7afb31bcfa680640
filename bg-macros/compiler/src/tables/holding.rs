//! What joints hold, and the stops that can be hit.
//!
//! In: a [`Compiled`]. Out: [`Held`] and [`Stops`], in the order of the programs of both.

use crate::expr::{Symbol, substitute};
use crate::pipeline::Compiled;
use crate::system::equations::{self, Kind};

/// What joints hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Held {
    /// The motions that rigid joints hold.
    pub rigid: Vec<Slip>,
    /// Those that compliant joints hold, of the joints whose motion at the start depends on a guessed velocity.
    pub compliant: Vec<Slip>,
    /// The momenta that reactions change.
    pub moved: Vec<usize>,
    /// The states of the pose.
    pub pose: Vec<usize>,
    /// Those of them that turn.
    pub turning: Vec<usize>,
    /// The rows that may follow from others, each with its number.
    pub closing: Vec<(usize, usize)>,
    /// Whether sources give flows.
    pub is_driven: bool,
}

/// A motion that a joint holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slip {
    /// The joint.
    pub joint: String,
    /// In which direction.
    pub direction: String,
    /// The unit of the flow.
    pub unit: String,
}

/// The stops that can be hit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stops {
    /// How many motions of rigid joints come before them.
    pub rigid: usize,
    /// As of [`Held::closing`].
    pub closing: Vec<(usize, usize)>,
    /// The stops.
    pub stops: Vec<Stop>,
    /// The momenta that impulses change.
    pub moved: Vec<usize>,
    /// The integrals that go along.
    pub integrals: Vec<usize>,
}

/// A stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stop {
    /// Its name.
    pub name: String,
    /// The unit of its flow.
    pub unit: String,
    /// Its switch.
    pub switch: usize,
}

/// What joints hold; none where they hold nothing.
#[must_use]
pub fn held(model: &Compiled) -> Option<Held> {
    let holding = &model.equations.holding;
    model.programs.holding.as_ref().map(|_| Held {
        rigid: holding.rigid.iter().map(slip).collect(),
        compliant: holding.compliant.iter().map(slip).collect(),
        moved: holding.moves.iter().map(|(state, _)| *state).collect(),
        pose: states_of(model, &[Kind::Position, Kind::Orientation, Kind::Angle, Kind::Displacement, Kind::Way]),
        turning: states_of(model, &[Kind::Orientation, Kind::Angle]),
        closing: closing(&holding.rigid),
        is_driven: is_driven(model),
    })
}

/// The stops that can be hit; none where there are none.
#[must_use]
pub fn stops(model: &Compiled) -> Option<Stops> {
    let impacts = &model.equations.impacts;
    let stop = |stop: &equations::Struck| Stop {
        name: stop.slip.joint.clone(),
        unit: stop.slip.unit.clone(),
        switch: stop.rebound.switch as usize,
    };
    model.programs.impacts.as_ref().map(|_| Stops {
        rigid: impacts.rigid.len(),
        closing: closing(&impacts.rigid),
        stops: impacts.stops.iter().map(stop).collect(),
        moved: impacts.moves.iter().map(|(state, _)| *state).collect(),
        integrals: impacts.integrals.iter().map(|(state, _)| *state).collect(),
    })
}

/// How many rows of joints that close loops may follow from others.
pub(super) fn closing_rows(model: &Compiled) -> usize {
    let numbers = model.equations.holding.rigid.iter().filter_map(|slip| slip.kept);
    numbers.max().map_or(0, |last| last as usize + 1)
}

fn slip(of: &equations::Slip) -> Slip {
    Slip { joint: of.joint.clone(), direction: of.direction.clone(), unit: of.unit.clone() }
}

/// The rows that may follow from others, each with its number.
fn closing(rigid: &[equations::Slip]) -> Vec<(usize, usize)> {
    let rows = rigid.iter().enumerate();
    rows.filter_map(|(row, slip)| Some((row, slip.kept? as usize))).collect()
}

/// The indices of the states of these kinds.
fn states_of(model: &Compiled, kinds: &[Kind]) -> Vec<usize> {
    let states = model.equations.states.iter().enumerate();
    states.filter(|(_, state)| kinds.contains(&state.origin.kind())).map(|(index, _)| index).collect()
}

/// Whether sources give flows: whether something moves, or is to move, where the momenta that joints change are zero.
fn is_driven(model: &Compiled) -> bool {
    let equations = &model.equations;
    let is_of_pose = |kind| matches!(kind, Kind::Position | Kind::Orientation | Kind::Angle);
    let pose = equations.states.iter().filter(|state| is_of_pose(state.origin.kind())).map(|state| state.rate);
    let flows = equations.holding.rigid.iter().map(|slip| slip.flow);
    let mut pool = equations.pool.clone();
    let zero = pool.zero();
    let is_moved = |state: usize| equations.holding.moves.iter().any(|(moved, _)| *moved == state);
    let at_rest = |symbol: Symbol| symbol.as_state().filter(|&state| is_moved(state)).map(|_| zero);
    let given = substitute(&mut pool, &pose.chain(flows).collect::<Vec<_>>(), &at_rest);
    given.into_iter().any(|flow| !pool.is_zero(flow))
}
