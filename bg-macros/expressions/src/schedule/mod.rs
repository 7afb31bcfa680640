//! The order of evaluation: expressions become routines of single assignments.
//!
//! In: the roots of each routine in a [`Pool`]. Out: a [`Program`]; no parameter, no dead and no repeated operation
//! occurs in its routines, and everything that only depends on parameters is in its constant table.
//! Method: each routine becomes a graph of dynamic cores with static coefficients (`build`), common factors come out of
//! sums (`rebuild`, `factor`), common pairs of terms and of factors become values of their own (`addends`, `factors`;
//! Hosangadi, Fallah, Kastner 2006), signs go where they are free (`signs`), and the rest is put in order (`flat`). As
//! the greedy choices depend on each other, each way of grouping is tried and the cheapest result taken.

mod addends;
pub mod batches;
mod build;
mod factor;
mod factors;
mod flat;
mod graph;
mod greedy;
pub mod pairs;
mod plan;
mod rebuild;
pub mod repetition;
mod reverse;
mod signs;
mod statics;
mod table;
#[cfg(test)]
mod tests;

use build::Parameters;
use factor::Grouping;
use flat::Constants;
use graph::{Graph, Value};
use plan::Plan;
pub use reverse::{Reverse, reverse};
use statics::Statics;

use crate::expr::{Function, Id, Pool, Symbol};

/// One routine to schedule.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The routine's name.
    pub name: &'a str,
    /// What it evaluates, in the order of its results.
    pub roots: &'a [Id],
}

/// Routines that share a table of constants.
#[derive(Clone, PartialEq, Debug)]
pub struct Program<const R: usize> {
    /// What is evaluated once: its results are the constant table. It depends on parameters and numbers only.
    pub constants: Routine,
    /// The routines in the order of their requests. They contain no parameters.
    pub routines: [Routine; R],
}

/// Straight-line code.
#[derive(Clone, PartialEq, Debug)]
pub struct Routine {
    /// The routine's name.
    pub name: String,
    /// Its operations; each operand stands before its use.
    pub assignments: Vec<Assignment>,
    /// Its results, one for each root.
    pub results: Vec<Operand>,
    /// What it costs.
    pub counts: Counts,
}

/// Routines with more assignments are long.
const LONG: usize = 2000;

impl Routine {
    /// Whether generated code has it in blocks, as it has so many assignments.
    #[must_use]
    pub fn is_long(&self) -> bool {
        self.assignments.len() > LONG
    }
}

/// One operation with the temporary that it defines.
#[derive(Clone, PartialEq, Debug)]
pub struct Assignment {
    /// The temporary; numbered from 0 in the order of the assignments.
    pub target: u32,
    /// Its value.
    pub operation: Operation,
}

/// A value that an operation takes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Operand {
    /// A number.
    Number(f64),
    /// A symbol; a parameter only in the routine of the constants.
    Symbol(Symbol),
    /// An entry of the constant table.
    Constant(u32),
    /// An earlier assignment's target.
    Temporary(u32),
}

/// What an assignment evaluates.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Operation<T = Operand> {
    /// The sum of both.
    Add(T, T),
    /// The first minus the second.
    Subtract(T, T),
    /// The product of both.
    Multiply(T, T),
    /// The first over the second.
    Divide(T, T),
    /// The operand with the other sign.
    Negate(T),
    /// A function of the operands.
    Call(Function, Vec<T>),
    /// One of two operands, both evaluated.
    Select {
        /// The switch's index.
        switch: u32,
        /// The value where the switch's guard is negative.
        negative: T,
        /// The value elsewhere.
        positive: T,
    },
}

/// Numbers of operations.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Counts {
    /// Additions, subtractions and negations.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Calls of functions.
    pub functions: usize,
    /// Choices between two values.
    pub choices: usize,
}

impl Counts {
    /// The counts of these assignments.
    #[must_use]
    pub fn of(assignments: &[Assignment]) -> Self {
        let mut counts = Self::default();
        for assignment in assignments {
            *match assignment.operation {
                Operation::Add(..) | Operation::Subtract(..) | Operation::Negate(_) => &mut counts.additions,
                Operation::Multiply(..) => &mut counts.multiplications,
                Operation::Divide(..) => &mut counts.divisions,
                Operation::Call(..) => &mut counts.functions,
                Operation::Select { .. } => &mut counts.choices,
            } += 1;
        }
        counts
    }

    /// The number of all operations.
    #[must_use]
    pub fn total(self) -> usize {
        self.additions + self.multiplications + self.divisions + self.functions + self.choices
    }
}

impl<T: Copy> Operation<T> {
    /// The operands in order.
    #[must_use]
    pub fn operands(&self) -> Vec<T> {
        match self {
            Self::Add(left, right)
            | Self::Subtract(left, right)
            | Self::Multiply(left, right)
            | Self::Divide(left, right)
            | Self::Select { negative: left, positive: right, .. } => vec![*left, *right],
            Self::Negate(operand) => vec![*operand],
            Self::Call(_, operands) => operands.clone(),
        }
    }

    /// The operation on other operands, each made of one of these, in order.
    pub fn map<U>(&self, mut to: impl FnMut(T) -> U) -> Operation<U> {
        match *self {
            Self::Add(left, right) => Operation::Add(to(left), to(right)),
            Self::Subtract(left, right) => Operation::Subtract(to(left), to(right)),
            Self::Multiply(left, right) => Operation::Multiply(to(left), to(right)),
            Self::Divide(left, right) => Operation::Divide(to(left), to(right)),
            Self::Negate(only) => Operation::Negate(to(only)),
            Self::Call(function, ref all) => {
                Operation::Call(function, all.iter().map(|&operand| to(operand)).collect())
            }
            Self::Select { switch, negative, positive } => {
                Operation::Select { switch, negative: to(negative), positive: to(positive) }
            }
        }
    }
}

/// Rounds of grouping and sharing; a third one saves less than 0.02 % of the operations of the random graphs in the
/// tests.
const ROUNDS: usize = 2;

/// Routines of the requests with few operations. The pool gains nodes of parameters and numbers.
pub fn schedule<const R: usize>(pool: &mut Pool, requests: [Request; R]) -> Program<R> {
    let mut statics = Statics::new(pool);
    let mut table = Constants::default();
    let routines = requests.map(|request| {
        // In an order of their own: in which order the results are wanted changes nothing in how they are calculated.
        let mut roots = request.roots.to_vec();
        roots.sort_unstable();
        roots.dedup();
        let plan = plan(&mut statics, &roots, Parameters::Static);
        let mut routine = flat::flatten(&mut statics, &plan, request.name, &mut table);
        let place = |root| roots.binary_search(root).expect("it is among them");
        routine.results = request.roots.iter().map(|root| routine.results[place(root)]).collect();
        routine
    });
    let plan = plan(&mut statics, &table.items, Parameters::Dynamic);
    let constants = flat::flatten(&mut statics, &plan, "constants", &mut Constants::default());
    Program { constants, routines }
}

/// The cheapest plan of the roots.
fn plan(statics: &mut Statics, roots: &[Id], parameters: Parameters) -> Plan {
    let (graph, values) = build::build(statics, roots, parameters);
    let (graph, values) = rebuild::rebuild(statics, &graph, &values, Grouping::Off);
    let candidates = [Grouping::Shared, Grouping::Local, Grouping::Off];
    let plans = candidates.map(|grouping| grouped(statics, &graph, &values, grouping));
    plans.into_iter().min_by_key(Plan::cost).expect("there is a candidate")
}

/// The plan that one way of grouping gives.
fn grouped(statics: &mut Statics, graph: &Graph, roots: &[Value], grouping: Grouping) -> Plan {
    let first = round(statics, graph, roots, grouping);
    let (graph, roots) = (1..ROUNDS).fold(first, |(graph, roots), _| round(statics, &graph, &roots, grouping));
    let mut plan = Plan::new(statics, &graph, &roots);
    factors::share_factors(&mut plan);
    plan
}

/// The graph with sums grouped and terms shared.
fn round(statics: &mut Statics, graph: &Graph, roots: &[Value], grouping: Grouping) -> (Graph, Vec<Value>) {
    let (mut graph, roots) = rebuild::rebuild(statics, graph, roots, grouping);
    addends::share_addends(statics, &mut graph, &roots);
    rebuild::rebuild(statics, &graph, &roots, Grouping::Off)
}
