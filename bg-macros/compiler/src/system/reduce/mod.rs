//! Reductions: only what a scene needs, with a proof for everything left out.
//!
//! In: [`StateEquations`] of the literal graph. Out: [`StateEquations`] without the states and parameters that the
//! scene does not need, and a [`Report`] that says why. Every reduction holds for all values of the tunable parameters;
//! it is proved on the equations by induction from the start values, never read off numbers.

mod affine;
mod angle;
mod closing;
mod dyad;
mod equal;
pub mod expectation;
mod friction;
mod invariant;
mod inverse;
mod joined;
mod live;
mod projected;
mod reaction;
mod report;
mod speeds;
mod tree;
mod turned;
mod zero;

use crate::expr::{Branch, Id, Node, Pool, Symbol};
use crate::system::equations::StateEquations;
use crate::system::equations::stage::Solved;

pub use report::{Count, Fate, Kept, Report};

/// What the scene is to keep.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// For each parameter whether it stays adjustable at run time.
    pub tuned: Vec<bool>,
    /// Whether orientations that turn about one axis are to be integrated as angles.
    pub angles: bool,
    /// Whether what rigid joints determine of bodies is to be expressed by the other states.
    pub speeds: bool,
    /// The orientations of the links that loops give, as the scene says, without a proof that they do in every pose.
    pub links: Vec<String>,
}

/// One reduction.
struct Pass {
    /// What has been done after it, in the report.
    name: &'static str,
    /// Whether there is anything to do.
    applies: fn(&StateEquations, &Wanted) -> bool,
    run: fn(&mut StateEquations, &Wanted, &mut Report, &mut Operations<'_>),
}

/// What tells how many operations the rate function of equations takes. Their pool may gain nodes, on whose order the
/// order of operations in programs depends: of equations that become programs all counts are taken or none is.
type Operations<'a> = dyn FnMut(&mut StateEquations) -> usize + 'a;

/// The operations of equations on their way through the reductions.
struct Counter<'a, 'o> {
    operations: &'a mut Operations<'o>,
    /// Whether the report has those after each reduction.
    is_told: bool,
}

impl Counter<'_, '_> {
    /// Enters the size of the equations after a reduction into the report.
    fn note(&mut self, stage: &'static str, equations: &mut StateEquations, report: &mut Report) {
        let operations = self.is_told.then(|| self.count(equations, report));
        report.count(stage, equations.states.len(), operations);
    }

    /// The operations of a rate: those of the last count, where the rates are as they were then.
    fn count(&mut self, equations: &mut StateEquations, report: &mut Report) -> usize {
        let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
        let rates = equations.solution.closed(&mut equations.pool, &rates);
        let known = report.counts.last().and_then(|count| count.operations).filter(|_| report.counted == rates);
        report.counted = rates;
        known.unwrap_or_else(|| (self.operations)(equations))
    }

    /// The operations of a rate of reduced equations, a sine or cosine as many as it takes.
    fn cost(&mut self, equations: &mut StateEquations, report: &Report) -> usize {
        const CALL: usize = 15;
        let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
        let is_call = |id: &Id| matches!(equations.pool.node(*id), Node::Call(..));
        let calls = equations.pool.reachable(&rates).iter().filter(|id| is_call(id)).count();
        let counted = report.counts.last().and_then(|count| count.operations);
        counted.unwrap_or_else(|| (self.operations)(equations)) + CALL * calls
    }
}

/// The reductions, in three parts, in the order in which they find most. First, what everything else is shorter by.
const PARAMETERS: [Pass; 1] = [Pass {
    name: "parameters folded",
    applies: always,
    run: |equations, wanted, _, _| fold_parameters(equations, wanted),
}];

/// States that are constant, equal or angles of others.
const STATES: [Pass; 3] = [
    Pass {
        name: "constant states folded",
        applies: always,
        run: |equations, _, report, _| invariant::fold(equations, report),
    },
    Pass {
        name: "turns counted",
        applies: |equations, _| turned::are_open(equations),
        run: |equations, _, _, _| turned::settle(equations, true),
    },
    Pass {
        name: "equal states merged",
        applies: always,
        run: |equations, _, report, _| equal::merge(equations, report),
    },
];

/// What joints determine, and what is left.
const JOINTS: [Pass; 5] = [
    Pass {
        name: "states of joints expressed",
        applies: |equations, _| !equations.reactions.is_empty() && !tree::is_put(equations),
        run: |equations, wanted, report, operations| {
            report.kept = speeds::choose(equations, wanted, report, operations).err();
        },
    },
    Pass {
        name: "reactions solved",
        applies: |equations, _| !equations.reactions.is_empty() || equations.unlocked.is_some(),
        run: |equations, _, _, _| reaction::solve(equations),
    },
    Pass {
        name: "orientations turned into angles",
        applies: |_, wanted| wanted.angles,
        run: |equations, _, report, _| angle::integrate(equations, report),
    },
    Pass {
        name: "affine states recovered",
        applies: always,
        run: |equations, _, report, _| affine::recover(equations, report),
    },
    Pass {
        name: "unwatched states dropped",
        applies: always,
        run: |equations, _, report, _| live::drop_unwatched(equations, report),
    },
];

fn always(_: &StateEquations, _: &Wanted) -> bool {
    true
}

/// Reduces the equations to what a scene needs. `operations` says what the rate function of equations costs; where
/// `is_counted` the report has that after each reduction.
#[must_use]
pub fn for_scene(
    mut equations: StateEquations,
    wanted: &Wanted,
    is_counted: bool,
    operations: &mut Operations<'_>,
) -> (Solved, Report) {
    let mut report = Report::new(&equations);
    let counter = &mut Counter { operations, is_told: is_counted };
    counter.note("literal", &mut equations, &mut report);
    run(&PARAMETERS, &mut equations, wanted, &mut report, counter);
    let may_be_jointed = wanted.speeds && tree::may_apply(&equations);
    let before = may_be_jointed.then(|| (equations.clone(), report.clone()));
    let closed = Form { which: tree::Which::NotFlat, loops: tree::Loops::Closed(&wanted.links) };
    let closed = in_joint_coordinates(before.clone(), wanted, closed, counter);
    let before = before.filter(|_| wanted.links.is_empty());
    let closed = match closed {
        Some(closed) if wanted.links.is_empty() => Some(closed),
        Some(closed) if wanted.links.iter().all(|link| closed.report.closed.contains(link)) => {
            return (Solved(closed.equations), closed.report);
        }
        _ => None,
    };
    let held = |which| Form { which, loops: tree::Loops::Held };
    let by_tree = in_joint_coordinates(before.clone(), wanted, held(tree::Which::NotFlat), counter);
    let by_tree = match (closed, by_tree) {
        (Some(closed), Some(held)) => Some(closed.or_shorter(held, counter)),
        (closed, by_tree) => closed.or(by_tree),
    };
    let by_tree = match by_tree {
        Some(Jointed { equations, report, is_long: true }) => return (Solved(equations), report),
        by_tree => by_tree,
    };
    run(&STATES, &mut equations, wanted, &mut report, counter);
    run(&JOINTS, &mut equations, wanted, &mut report, counter);
    // What lies flat is moved out of its plane as soon as a force may be across it, as far as this can prove.
    let by_tree = match by_tree {
        None if !expectation::out_of_plane(&report).is_empty() => {
            in_joint_coordinates(before, wanted, held(tree::Which::All), counter)
        }
        by_tree => by_tree,
    };
    if let Some(mut by_tree) = by_tree
        && counter.cost(&mut by_tree.equations, &by_tree.report) < counter.cost(&mut equations, &report)
    {
        (equations, report) = (by_tree.equations, by_tree.report);
    }
    (Solved(equations), report)
}

/// What is reduced with trees of joints by their coordinates.
struct Jointed {
    equations: StateEquations,
    report: Report,
    /// Whether more than a few joints move in space, as none of their coordinates is constant: the matrix of all
    /// reactions of bodies that keep their states would take seconds and more to factor.
    is_long: bool,
}

impl Jointed {
    /// The one of two forms whose rate takes fewer operations.
    fn or_shorter(mut self, mut other: Self, counter: &mut Counter<'_, '_>) -> Self {
        let is_long = self.is_long || other.is_long;
        let [own, others] = [&mut self, &mut other].map(|of| counter.cost(&mut of.equations, &of.report));
        let shorter = if others < own { other } else { self };
        Self { is_long, ..shorter }
    }
}

/// So many coordinates are compared with the matrix of all reactions.
const SHORT: usize = 4;

/// Runs these reductions, where they apply.
fn run(
    passes: &[Pass],
    equations: &mut StateEquations,
    wanted: &Wanted,
    report: &mut Report,
    counter: &mut Counter<'_, '_>,
) {
    for pass in passes {
        if (pass.applies)(equations, wanted) {
            (pass.run)(equations, wanted, report, counter.operations);
            counter.note(pass.name, equations, report);
        }
    }
}

/// Which trees have the coordinates of their joints, and what becomes of loops.
struct Form<'a> {
    which: tree::Which,
    loops: tree::Loops<'a>,
}

/// These equations reduced, with bodies on trees of joints by the joints' coordinates, where there are such.
fn in_joint_coordinates(
    of: Option<(StateEquations, Report)>,
    wanted: &Wanted,
    Form { which, loops }: Form<'_>,
    counter: &mut Counter<'_, '_>,
) -> Option<Jointed> {
    let (mut equations, mut report) = of?;
    tree::put(&mut equations, &mut report, (which, loops), counter.operations)?;
    counter.note("joints by their coordinates", &mut equations, &mut report);
    let all = tree::speeds(&equations);
    run(&STATES, &mut equations, wanted, &mut report, counter);
    let is_long = all > SHORT && tree::speeds(&equations) == all;
    run(&JOINTS, &mut equations, wanted, &mut report, counter);
    Some(Jointed { equations, report, is_long })
}

/// The equations of a literal model, which has no proofs: the turns of its angles counted, its reactions solved for.
#[must_use]
pub fn literal(mut equations: StateEquations) -> Solved {
    if turned::are_open(&equations) {
        turned::settle(&mut equations, false);
    }
    reaction::solve(&mut equations);
    Solved(equations)
}

/// Replaces parameters that no one tunes by their defaults; the others keep their order.
fn fold_parameters(equations: &mut StateEquations, wanted: &Wanted) {
    let mut images = Vec::new();
    let mut kept = Vec::new();
    for (parameter, &is_tuned) in equations.parameters.iter().zip(&wanted.tuned) {
        images.push(if is_tuned {
            kept.push(parameter.clone());
            equations.pool.symbol(Symbol::numbered(Symbol::Parameter, kept.len() - 1))
        } else {
            equations.pool.number(parameter.default)
        });
    }
    equations.requirements.fold(&equations.parameters, &wanted.tuned);
    equations.parameters = kept;
    equations.replace(&|symbol| match symbol {
        Symbol::Parameter(parameter) => images.get(parameter as usize).copied(),
        _ => None,
    });
    settle_switches(equations);
}

/// Switches whose guard has become a number are decided; their values become those of the branch.
fn settle_switches(equations: &mut StateEquations) {
    let mut kept = 0;
    let branches: Vec<Branch> = equations
        .switches
        .iter()
        .map(|switch| match equations.pool.as_number(switch.guard) {
            Some(value) if value < 0.0 => Branch::Negative,
            Some(_) if switch.clock.is_none() => Branch::Positive,
            _ => {
                kept += 1;
                Branch::Kept(kept - 1)
            }
        })
        .collect();
    keep_switches(equations, &branches);
}

/// Decides or renumbers every switch.
fn keep_switches(equations: &mut StateEquations, branches: &[Branch]) {
    let branch = |switch: u32| branches[switch as usize];
    equations.replace_switched(&|_| None, &branch);
    let kept = |switch: usize| matches!(branches[switch], Branch::Kept(_));
    let switches = std::mem::take(&mut equations.switches);
    equations.switches = switches.into_iter().enumerate().filter(|(k, _)| kept(*k)).map(|(_, s)| s).collect();
}

/// Whether an expression depends on parameters and numbers only.
fn is_constant(pool: &Pool, id: Id) -> bool {
    pool.symbols(&[id]).into_iter().all(|symbol| matches!(symbol, Symbol::Parameter(_)))
}

#[cfg(test)]
mod tests;
