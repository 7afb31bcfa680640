//! The values of unknowns: algebraic loops, and what storages in derivative causality are and give.
//!
//! In: expressions that are to be zero. Out: the value of each unknown as an expression of states, parameters, inputs
//! and time, put in its place everywhere; or faults.
//! Method: unknowns that need each other are a group; a group is linear where its partial derivatives contain none of
//! its own unknowns, and is then solved by elimination in symbols (`expr::gauss`); an algebraic loop that is not linear
//! is left to an iteration at run time (`iteration`). Switches stay as they are: a solution holds for the branches that
//! its coefficients have.

use std::collections::{BTreeMap, BTreeSet};

use super::iteration::Loop;
use super::loops::groups;
use super::memo::Entry;
use super::signals::Signals;
use super::unknowns::{Unknown, number};
use super::{EquationFault, FallibleLaw};
use crate::expr::{Id, Linear, Pool, Signs, Symbol, partial, signs, solve_linear, substitute};
use crate::fault::Fault;
use crate::graph::{NodeId, Parameter};

/// How many members a message lists.
const LISTED: usize = 6;

/// A divisor of a solution that parameters may make zero.
#[derive(Clone, Debug)]
pub(super) struct Pivot {
    /// What has no solution then.
    pub what: String,
    /// Where that begins.
    pub node: NodeId,
    /// The divisor.
    pub value: Id,
}

/// How a group of equations is solved.
enum Form {
    /// A x = b.
    Linear(Linear),
    /// Not in symbols.
    Nonlinear,
}

/// Why a group has no solution.
enum Trouble {
    Nonlinear,
    /// The equations that say nothing of the unknowns that are left; each is that of the unknown at its place.
    Singular(Vec<usize>),
}

impl Signals<'_> {
    /// The value of each unknown that has an equation; of what cannot be solved there is a fault.
    pub(super) fn solved(&mut self, residuals: &BTreeMap<u32, Id>) -> BTreeMap<Symbol, Id> {
        let numbers: Vec<u32> = residuals.keys().copied().collect();
        let place: BTreeMap<u32, usize> = numbers.iter().enumerate().map(|(k, &number)| (number, k)).collect();
        let needs: Vec<Vec<usize>> = residuals
            .values()
            .map(|&residual| self.pool.symbols(&[residual]).into_iter().filter_map(number))
            .map(|needed| needed.filter_map(|number| place.get(&number).copied()).collect())
            .collect();
        let mut known = BTreeMap::new();
        for group in groups(&needs) {
            let group: Vec<u32> = group.into_iter().map(|k| numbers[k]).collect();
            let before: Vec<Id> = group.iter().map(|number| residuals[number]).collect();
            let equations = substitute(&mut self.pool, &before, &|symbol| known.get(&symbol).copied());
            match self.solve_group(&group, &equations) {
                Ok(values) => known.extend(group.into_iter().map(Symbol::Unsolved).zip(values)),
                Err(Trouble::Nonlinear) if self.is_iterated(&group, &equations) => {
                    let members = self.circles(&group);
                    self.note_iterated(&group, &members);
                    self.loops.push(Loop { members, unknowns: group, residuals: equations });
                }
                Err(trouble) => {
                    let fault = self.unsolvable(&group, &equations, &trouble);
                    // Efforts and flows of one ring are one fault, whichever equation it is that each cannot have.
                    let said = |fault: &Fault| fault.message.rsplit_once(": ").map(|(said, _)| said.to_owned());
                    let is_said = |known: &Fault| known.code == fault.code && said(known) == said(&fault);
                    if matches!(trouble, Trouble::Nonlinear) || !self.faults.iter().any(is_said) {
                        self.fault_once(fault);
                    }
                }
            }
        }
        known
    }

    /// Whether an iteration can find the unknowns: bond variables that no reaction depends on, which is solved for
    /// after them.
    fn is_iterated(&self, group: &[u32], equations: &[Id]) -> bool {
        let is_variable = |&number: &u32| matches!(self.unknowns.all[number as usize], Unknown::Variable(..));
        let symbols = self.pool.symbols(equations);
        group.iter().all(is_variable) && !symbols.into_iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)))
    }

    /// Where the iteration finds nothing, a run says which loop it was.
    fn note_iterated(&mut self, group: &[u32], members: &[String]) {
        for &number in group {
            let (kind, value) = ("algebraic loop", self.pool.symbol(Symbol::Unsolved(number)));
            self.fallible.insert(0, FallibleLaw::new(kind, members.join(", "), value));
        }
    }

    /// The names of the elements in the circles of these unknowns.
    fn circles(&self, group: &[u32]) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for node in self.members(group) {
            let name = &self.graph.node(node).name.text;
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    fn solve_group(&mut self, group: &[u32], equations: &[Id]) -> Result<Vec<Id>, Trouble> {
        let Form::Linear(system) = self.form(group, equations) else { return Err(Trouble::Nonlinear) };
        let parameters = &self.graph.parameters;
        let is_proved = |pool: &Pool, id: Id| !signs(pool, id, &|symbol| range(parameters, symbol)).zero;
        let solution = solve_linear(&mut self.pool, system, &is_proved).map_err(Trouble::Singular)?;
        for pivot in solution.doubtful {
            self.doubt(group, pivot);
        }
        Ok(solution.values)
    }

    /// The equations as a linear system in their unknowns, where they are one.
    fn form(&mut self, group: &[u32], equations: &[Id]) -> Form {
        let (zero, mut rows) = (self.pool.zero(), vec![BTreeMap::new(); group.len()]);
        let is_own = |symbol: Symbol| number(symbol).is_some_and(|number| group.contains(&number));
        for (column, &unknown) in group.iter().enumerate() {
            let slopes = partial(&mut self.pool, equations, Symbol::Unsolved(unknown));
            if self.pool.symbols(&slopes).into_iter().any(is_own) {
                return Form::Nonlinear;
            }
            let entries = rows.iter_mut().zip(slopes).filter(|(_, slope)| *slope != zero);
            entries.for_each(|(row, slope)| row.extend([(column, slope)]));
        }
        let constants = substitute(&mut self.pool, equations, &|symbol| is_own(symbol).then_some(zero));
        let right = constants.into_iter().map(|constant| self.pool.neg(constant)).collect();
        Form::Linear(Linear { rows, right })
    }

    /// What a solution divides by may be zero: the model's `new` checks what parameters decide, a run tells the rest.
    fn doubt(&mut self, group: &[u32], pivot: Id) {
        let nodes = self.members(group);
        let Some(&node) = nodes.first() else { return };
        let is_parameter = |symbol: Symbol| matches!(symbol, Symbol::Parameter(_));
        if self.pool.symbols(&[pivot]).into_iter().all(is_parameter) && !self.pool.has_select(&[pivot]) {
            let what = format!("the system of {}", self.listed(&nodes));
            self.pivots.push(Pivot { what, node, value: pivot });
        } else {
            let definition = self.graph.node(node);
            let value = self.pool.powi(pivot, -1);
            let law = FallibleLaw::new(definition.kind.symbol(), definition.name.text.clone(), value);
            self.fallible.insert(0, law);
        }
    }

    /// The elements and junctions that unknowns belong to.
    fn members(&self, group: &[u32]) -> Vec<NodeId> {
        let mut nodes = Vec::new();
        let mut seen = BTreeSet::new();
        for &number in group {
            let of = match self.unknowns.all[number as usize] {
                Unknown::Variable(_, _, circle) => self.unknowns.circles[circle].nodes.clone(),
                Unknown::State(node) | Unknown::Given(node) => vec![node],
            };
            nodes.extend(of.into_iter().filter(|node| seen.insert(*node)));
        }
        nodes
    }

    /// The first names of elements and junctions, for messages.
    fn listed(&self, nodes: &[NodeId]) -> String {
        let names = self.names(&nodes[..nodes.len().min(LISTED)]).join(", ");
        let more = nodes.len().saturating_sub(LISTED);
        if more == 0 { names } else { format!("{names} and {more} more") }
    }

    /// Names of elements and junctions, for messages.
    pub(super) fn names(&self, nodes: &[NodeId]) -> Vec<String> {
        nodes.iter().map(|&node| format!("`{}`", self.graph.node(node).name.text)).collect()
    }

    /// The fault of a group without a solution.
    fn unsolvable(&self, group: &[u32], equations: &[Id], trouble: &Trouble) -> Fault {
        let unknowns = || group.iter().map(|&number| self.unknowns.all[number as usize]);
        let given = unknowns().find_map(|of| if let Unknown::Given(node) = of { Some(node) } else { None });
        if let Some(node) = given {
            let of: BTreeSet<NodeId> =
                unknowns().filter_map(|of| if let Unknown::Given(node) = of { Some(node) } else { None }).collect();
            let members = self.names(&of.into_iter().collect::<Vec<_>>());
            let why = match trouble {
                Trouble::Nonlinear => "its equations are not linear".to_owned(),
                Trouble::Singular(rows) => self.said_twice(group, rows),
            };
            return self.fault_of(node, &EquationFault::DependentOpen { members, why });
        }
        let circle =
            unknowns().find_map(|of| if let Unknown::Variable(_, _, circle) = of { Some(circle) } else { None });
        let first = circle.map(|circle| &self.unknowns.circles[circle]);
        let members = match (first, trouble) {
            (Some(circle), Trouble::Nonlinear) => self.names(&circle.nodes),
            // Efforts and flows of one ring are one fault.
            _ => self.names(&self.members(group).into_iter().collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>()),
        };
        let fault = match trouble {
            Trouble::Nonlinear => EquationFault::AlgebraicLoop { members, reactions: self.reactions_in(equations) },
            Trouble::Singular(rows) => EquationFault::UndeterminedLoop { members, why: self.said_twice(group, rows) },
        };
        match first {
            Some(circle) => Fault::new(circle.span, &fault),
            None => self.fault_of(self.members(group)[0], &fault),
        }
    }

    /// Which equations of a group say nothing of what is open.
    fn said_twice(&self, group: &[u32], rows: &[usize]) -> String {
        let mut of: Vec<String> = Vec::new();
        for &row in rows {
            let text = match self.unknowns.all[group[row] as usize] {
                Unknown::Variable(role, bond, _) => {
                    let ends = self.graph.bond(bond);
                    let [from, to] = [ends.from, ends.to].map(|node| &self.graph.node(node).name.text);
                    format!("the {role} of `{from} -> {to}`")
                }
                Unknown::State(node) => format!("the state of `{}`", self.graph.node(node).name.text),
                Unknown::Given(node) => format!("what `{}` gives", self.graph.node(node).name.text),
            };
            if !of.contains(&text) {
                of.push(text);
            }
        }
        let more = of.len().saturating_sub(LISTED);
        of.truncate(LISTED);
        let more = if more == 0 { String::new() } else { format!(" and {more} more") };
        format!("the equation of {}{more} follows from the others or contradicts them", of.join(", "))
    }

    /// The names of what gives the reactions in these equations.
    fn reactions_in(&self, equations: &[Id]) -> Vec<String> {
        let symbols = self.pool.symbols(equations);
        let first =
            |number: u32| self.reactions.iter().filter(|(_, first)| **first <= number).max_by_key(|(_, first)| **first);
        let sinks = symbols.into_iter().filter_map(|symbol| {
            let Symbol::Multiplier(number) = symbol else { return None };
            first(number).map(|(&sink, _)| format!("`{}`", self.holder(sink)))
        });
        let names: BTreeSet<String> = sinks.collect();
        names.into_iter().collect()
    }

    /// A fault at the name of a node.
    pub(super) fn fault_of(&self, node: NodeId, fault: &EquationFault) -> Fault {
        Fault::new(self.graph.node(node).name.span, fault)
    }

    /// Puts values in the places of symbols in everything that has been calculated.
    pub(super) fn put(&mut self, values: &BTreeMap<Symbol, Id>) {
        if values.is_empty() {
            return;
        }
        let mut pool = std::mem::take(&mut self.pool);
        let before: Vec<Id> = self.calculated().into_iter().map(|id| *id).collect();
        let after = substitute(&mut pool, &before, &|symbol| values.get(&symbol).copied());
        self.calculated().into_iter().zip(after).for_each(|(place, id)| *place = id);
        self.pool = pool;
    }

    /// Everything that has been calculated.
    fn calculated(&mut self) -> Vec<&mut Id> {
        let memo = &mut self.memo;
        let variables = memo.efforts.iter_mut().chain(&mut memo.flows);
        let done = variables.filter_map(|entry| if let Entry::Done(value) = entry { Some(value) } else { None });
        let values = done.chain(memo.lets.iter_mut().flatten());
        let mut places: Vec<&mut Id> = values.flat_map(|value| &mut value.0).collect();
        places.extend(self.dependent.values_mut().flat_map(|dependent| dependent.replaced.iter_mut().flatten()));
        places.extend(self.states.iter_mut().map(|state| &mut state.rate));
        places.extend(self.switches.iter_mut().map(|switch| &mut switch.guard));
        places.extend(self.fallible.iter_mut().map(|law| &mut law.value));
        places.extend(self.pivots.iter_mut().map(|pivot| &mut pivot.value));
        places.extend(self.loops.iter_mut().flat_map(|nonlinear| &mut nonlinear.residuals));
        places
    }
}

/// The signs that a symbol can have.
fn range(parameters: &[Parameter], symbol: Symbol) -> Signs {
    match symbol {
        Symbol::Parameter(index) => {
            let Parameter { lower, upper, .. } = &parameters[index as usize];
            Signs::between(*lower, *upper)
        }
        _ => Signs::ANY,
    }
}
