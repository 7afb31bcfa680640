//! What joints hold: the motions that are zero in a state that fits, and what the reactions of rigid joints change.
//!
//! In: residual sinks, gaps to be closed, start values. Out: [`Slip`]s, the unknowns that are velocities.

use std::collections::BTreeSet;

use super::Kind;
use super::signals::{Open, Signals};
use crate::expr::{Branch, Id, Pool, Symbol, derivative, substitute_switched};
use crate::graph::units::Dimension;
use crate::graph::{Axis, Direction, ElementKind, Held, JointId, NodeId};
use crate::system::equations::definite::filter;
use crate::system::equations::solution::Known;

/// A motion that a joint holds.
#[derive(Clone, Debug)]
pub struct Slip {
    /// The joint, or a residual sink that belongs to none.
    pub joint: String,
    /// `in x`, `about x` and so on; empty where there is one direction only or none is known.
    pub direction: String,
    /// The unit of the flow.
    pub unit: String,
    /// The relative flow: zero in a state that fits.
    pub flow: Id,
    /// The number of its [`Symbol::Kept`], where its joint closes a loop and may hold what others hold already.
    pub kept: Option<u32>,
    /// Its integral as the poses have it, where they do.
    pub gap: Option<Id>,
    /// How much one unit of its reaction changes the rate of its flow while no other joint holds anything, where the
    /// matrix does not say so because rows of other joints are solved. Beside it a pivot tells how near the pose is to
    /// a singular one.
    pub mobility: Option<Id>,
}

impl Slip {
    /// Every expression.
    pub fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        [&mut self.flow].into_iter().chain(&mut self.gap).chain(&mut self.mobility)
    }

    /// The same, of a slip that stays as it is.
    pub fn ids(&self) -> impl Iterator<Item = Id> + use<> {
        [self.flow].into_iter().chain(self.gap).chain(self.mobility)
    }
}

/// The mobilities of rigid motions: those of the matrix, where rows before them are not solved.
pub(super) fn mobilities<'a>(rigid: &'a [Slip], matrix: &'a [Vec<Id>]) -> impl Iterator<Item = Id> + 'a {
    rigid.iter().zip(matrix).enumerate().map(|(row, (slip, entries))| slip.mobility.unwrap_or(entries[row]))
}

/// What joints hold at any state. The parts of rigid joints are known once the reactions are solved for.
#[derive(Clone, Debug, Default)]
pub struct Holding {
    /// The motions that rigid joints hold, each with a reaction.
    pub rigid: Vec<Slip>,
    /// Those that compliant joints hold, of the joints whose motion at the start depends on a guessed velocity.
    pub compliant: Vec<Slip>,
    /// How much each reaction changes the rate of each rigid flow: symmetric, the lower triangle by rows.
    pub matrix: Vec<Vec<Id>>,
    /// The momenta that reactions change: the state, and its rate by one unit of each reaction.
    pub moves: Vec<(usize, Vec<Id>)>,
}

impl Holding {
    /// Every expression: the rigid flows, the compliant ones, the rigid gaps, the mobilities, the matrix, then for each
    /// reaction what it moves.
    #[must_use]
    pub fn entries(&self, pool: &Pool) -> Vec<Id> {
        let flows = self.rigid.iter().chain(&self.compliant).map(|slip| slip.flow);
        let gaps = self.rigid.iter().map(|slip| slip.gap.unwrap_or(pool.zero()));
        let moves = (0..self.rigid.len()).flat_map(|k| self.moves.iter().map(move |(_, moves)| moves[k]));
        let matrix = self.matrix.iter().flatten().copied();
        flows.chain(gaps).chain(mobilities(&self.rigid, &self.matrix)).chain(matrix).chain(moves).collect()
    }

    /// Replaces symbols and decides switches everywhere.
    pub fn replace(&mut self, pool: &mut Pool, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let flows = self.rigid.iter_mut().chain(&mut self.compliant);
        let flows = flows.flat_map(Slip::roots);
        let moves = self.moves.iter_mut().flat_map(|(_, moves)| moves);
        let roots: Vec<&mut Id> = flows.chain(self.matrix.iter_mut().flatten()).chain(moves).collect();
        let before: Vec<Id> = roots.iter().map(|id| **id).collect();
        let after = substitute_switched(pool, &before, replace, branch);
        roots.into_iter().zip(after).for_each(|(root, id)| *root = id);
    }

    /// What the rigid motions that act on a momentum are: their flows, gaps and mobilities.
    pub fn of_momentum(&self, pool: &Pool, state: usize) -> Vec<Id> {
        let Some((_, moves)) = self.moves.iter().find(|(moved, _)| *moved == state) else { return Vec::new() };
        let acting = self.rigid.iter().zip(moves).filter(|&(_, &by)| !pool.is_zero(by));
        acting.flat_map(|(slip, _)| slip.ids()).collect()
    }

    /// Whether joints close loops, so that reactions may not be unique.
    #[must_use]
    pub fn is_shared(&self) -> bool {
        self.rigid.iter().any(|slip| slip.kept.is_some())
    }

    /// The number of a reaction's [`Symbol::Kept`], where it has one.
    #[must_use]
    pub fn kept(&self, row: usize) -> Option<u32> {
        // Rows of reactions and of held motions are the same where any of them is kept or not.
        self.rigid.get(row).filter(|_| self.is_shared())?.kept
    }

    /// What must stay where the reaction of this row is wanted and may have to be shared among joints.
    pub fn shared(&self, row: usize) -> Vec<Id> {
        let slip = self.rigid.get(row).filter(|_| self.is_shared());
        slip.into_iter().flat_map(Slip::ids).collect()
    }

    /// Whether there is nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rigid.is_empty() && self.compliant.is_empty()
    }

    /// For each rigid motion whether it is known: where a reaction acts on something that stays, all that it is solved
    /// from stays as well.
    #[must_use]
    pub fn known(&self, pool: &Pool, known: &Known) -> Vec<bool> {
        let stays = |id: Id| known.has(pool, id);
        let entry = |i: usize, j: usize| self.matrix[i.max(j)][i.min(j)];
        let acts = |(state, moves): &(usize, Vec<Id>), i: usize| {
            pool.is_zero(moves[i]) || known.has_state(*state) && stays(moves[i])
        };
        let rows = 0..self.rigid.len();
        let is_known = |i: usize| {
            stays(self.rigid[i].flow)
                && self.rigid[i].mobility.is_none_or(stays)
                && rows.clone().all(|j| stays(entry(i, j)))
                && self.moves.iter().all(|moved| acts(moved, i))
        };
        rows.clone().map(is_known).collect()
    }

    /// Forgets the rigid motions that are not kept, and the compliant ones that are not known.
    pub fn retain(&mut self, pool: &Pool, known: &Known, kept: &[bool]) {
        let keep = |items: &mut Vec<Id>| filter(items, kept);
        filter(&mut self.matrix, kept);
        self.matrix.iter_mut().for_each(keep);
        self.moves.iter_mut().for_each(|(_, moves)| keep(moves));
        self.moves.retain(|(_, moves)| moves.iter().any(|&id| !pool.is_zero(id)));
        filter(&mut self.rigid, kept);
        self.rigid.iter_mut().for_each(|slip| slip.gap = slip.gap.filter(|&gap| known.has(pool, gap)));
        self.compliant.retain(|slip| known.has(pool, slip.flow));
    }

    /// Gives the states that reactions change their new numbers; those without one are gone.
    pub fn renumber(&mut self, to: &dyn Fn(usize) -> Option<usize>) {
        let moves = std::mem::take(&mut self.moves);
        self.moves = moves.into_iter().filter_map(|(state, moves)| Some((to(state)?, moves))).collect();
    }
}

impl Signals<'_> {
    /// What a residual sink is part of.
    fn held(&self, sink: NodeId) -> Option<Held> {
        self.graph.element(sink).and_then(|element| element.held)
    }

    /// The name of a residual sink's joint; of one that belongs to none, its own.
    pub(super) fn holder(&self, sink: NodeId) -> &str {
        let own = &self.graph.node(sink).name.text;
        self.held(sink).map_or(own, |held| self.graph.joint(held.joint))
    }

    /// Whether a joint has residual sinks.
    fn is_rigid(&self, joint: JointId) -> bool {
        self.reactions.keys().any(|&sink| self.held(sink).is_some_and(|held| held.joint == joint))
    }

    /// The direction of a component of a residual sink's bond, in words.
    pub(super) fn direction_of(&self, sink: NodeId, component: usize) -> String {
        let bond = self.graph.bond(self.graph.node(sink).bonds[0]);
        if bond.cardinality == 3 {
            let turns = bond.flow() == Dimension::NONE.per(Dimension::SECOND);
            return in_words(Some(direction(component, turns)));
        }
        in_words(self.held(sink).and_then(|held| held.direction))
    }

    /// The motions of the compliant joints that a guessed velocity changes at the start.
    pub(super) fn compliant_slips(&mut self, speeds: &[usize]) -> Vec<Slip> {
        let graph = self.graph;
        let speeds: BTreeSet<usize> = speeds.iter().copied().collect();
        if speeds.is_empty() {
            return Vec::new();
        }
        let seeds = self.rate_seeds(&[]);
        let mut slips = Vec::new();
        for close in &graph.closes {
            if self.is_rigid(close.joint) {
                continue;
            }
            let gap = self.evaluate(&close.gap, None);
            let flows = derivative(&mut self.pool, &gap.0, &seeds);
            let turns = close.dimension == Dimension::NONE;
            let unit = if turns { "rad/s" } else { "m/s" };
            for (component, &flow) in flows.iter().enumerate() {
                let direction = in_words((flows.len() > 1).then(|| direction(component, turns)));
                let (joint, unit) = (graph.joint(close.joint).to_owned(), unit.to_owned());
                slips.push((close.joint, Slip { joint, direction, unit, flow, kept: None, gap: None, mobility: None }));
            }
        }
        let flows: Vec<Id> = slips.iter().map(|(_, slip)| slip.flow).collect();
        let at_start = self.at_start(&flows);
        let is_guessed = |id: Id| {
            let symbols = self.pool.symbols(&[id]);
            symbols.into_iter().any(|symbol| matches!(symbol, Symbol::Unknown(k) if speeds.contains(&(k as usize))))
        };
        let guessed = slips.iter().zip(at_start).filter(|(_, id)| is_guessed(*id));
        let moved: BTreeSet<JointId> = guessed.map(|((joint, _), _)| *joint).collect();
        slips.into_iter().filter(|(joint, _)| moved.contains(joint)).map(|(_, slip)| slip).collect()
    }

    /// The unknowns of the start that are velocities: momenta depend on them, displacements and poses do not.
    pub(super) fn speeds(&self) -> Vec<usize> {
        let unknowns = |is_momentum: bool| -> BTreeSet<usize> {
            let starts = self.states.iter().filter(|state| (state.origin.kind() == Kind::Momentum) == is_momentum);
            let starts: Vec<Id> = starts.map(|state| state.start).collect();
            let symbols = self.pool.symbols(&starts).into_iter();
            symbols.filter_map(|symbol| if let Symbol::Unknown(k) = symbol { Some(k as usize) } else { None }).collect()
        };
        unknowns(true).difference(&unknowns(false)).copied().collect()
    }

    /// The gaps of residual sinks that belong to no joint to be closed.
    pub(super) fn gaps_of_sinks(&mut self) -> Vec<Open> {
        let graph = self.graph;
        let mut gaps = Vec::new();
        for sink in self.elements(|kind| kind == ElementKind::RSe) {
            if self.is_stop(sink) {
                continue;
            }
            let (joint, held) = (self.holder(sink).to_owned(), self.held(sink));
            let Some(gap) = graph.element(sink).and_then(|element| element.displacement.as_ref()) else { continue };
            if graph.closes.iter().all(|close| held.is_none_or(|held| held.joint != close.joint)) {
                let unit = graph.bond(graph.node(sink).bonds[0]).displacement_unit();
                gaps.push((joint, unit, self.evaluate(gap, None).0));
            }
        }
        gaps
    }
}

/// The direction of a vector's component.
fn direction(component: usize, turns: bool) -> Direction {
    let axis = Axis::ALL[component];
    if turns { Direction::About(axis) } else { Direction::Along(axis) }
}

fn in_words(direction: Option<Direction>) -> String {
    match direction {
        Some(Direction::Along(axis)) => format!("in {}", axis.letter()),
        Some(Direction::About(axis)) => format!("about {}", axis.letter()),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use crate::pipeline;
    use crate::source::syntax;
    use crate::system::equations::StateEquations;

    /// The equations of a graph, and of its bond-graph words as text.
    fn equations(items: &str) -> [StateEquations; 2] {
        let derived = |text: &str| {
            let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
            pipeline::derive(&source.graphs[0]).expect("equations")
        };
        let first = derived(&format!("graph G {{ {items} }}"));
        let second = derived(&first.expanded.to_string());
        [first, second].map(|derived| derived.equations)
    }

    fn held(equations: &StateEquations) -> Vec<(&str, &str)> {
        let slips = equations.reactions.iter().map(|reaction| &reaction.slip);
        slips.map(|slip| (slip.joint.as_str(), slip.direction.as_str())).collect()
    }

    #[test]
    fn a_rigid_joint_is_known_as_one_in_its_bond_graph_words() {
        let both = equations(
            "ground { point O = [0, 0, 0]; } body bob { mass 2; inertia [1, 2, 3]; point top = [0, 1, 0]; }
             joint pin: cylindrical z (ground.O -> bob.top) { rigid; }",
        );
        for equations in both {
            let expected = [("pin", "in x"), ("pin", "in y"), ("pin", "about x"), ("pin", "about y")];
            assert_eq!(held(&equations), expected);
            assert_eq!(equations.assembly.gaps.len(), 4);
        }
    }

    #[test]
    fn only_a_residual_sink_is_part_of_a_joint() {
        let text = "graph G { 1 v: translation; I m = 2; C k = 3 of pin; v -> m; v -> k; }";
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let faults = pipeline::derive(&source.graphs[0]).expect_err("a C is no residual sink");
        assert_eq!((faults[0].code, faults.len()), ("BG0326", 1));
    }

    #[test]
    fn a_sink_is_of_the_joint_that_it_says_whatever_its_name() {
        let link = "1 v[3]: translation; position x of v start [0, 0.1, 0]; I m = 2; v -> m; v -> pin.hold;
            close pin = x; rSe pin.hold = [0, 0, 0] at x";
        for equations in equations(&format!("{link};")) {
            assert_eq!(held(&equations)[1], ("pin.hold", "in y"));
            assert_eq!(equations.assembly.gaps.len(), 6, "the sink closes its own gap");
        }
        for equations in equations(&format!("{link} of pin;")) {
            assert_eq!(held(&equations)[1], ("pin", "in y"));
            assert_eq!(equations.assembly.gaps.len(), 3);
        }
    }
}
