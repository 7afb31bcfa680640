//! The programs of a model's functions.
//!
//! In: equations, the derivatives of the rates and the second derivatives. Out: what every generated function
//! evaluates, in order, with its table of constants.

use std::cell::OnceCell;
use std::ops::Range;

use super::pairs::{Paired, Search, pair};
use super::reversed::{Reversed, reversed};
use super::tape::{Tape, tape};
use super::{Counts, Deferred, Program, Request, Routine, deferred, schedule};
use crate::expr::{Id, Pool};
use crate::system::equations::Iteration;
use crate::system::equations::stage::Closed;
use crate::system::{Jacobian, SecondOrder, Sizes, StateEquations};

/// Longer rates are not inlined where they are compiled for the machine's vectors: they would only fill the cache.
const INLINED: usize = 400;

/// The programs of all generated functions.
#[derive(Debug)]
pub struct Programs {
    /// Functions of the running model; they share one constant table.
    pub running: Running,
    /// The derivatives of the rates; most of the time that programs take is for these.
    pub derivatives: Deferred<Derivatives>,
    /// What there is for states of second order, with a constant table of its own.
    pub second_order: Option<Deferred<SecondOrderPrograms>>,
    /// What joints hold, with a constant table of its own.
    pub holding: Option<Program<1>>,
    /// What impacts are calculated from, with a constant table of its own.
    pub impacts: Option<Program<1>>,
    /// The stored energy and its second derivatives, with a constant table of its own.
    pub sizes: Program<1>,
    /// Functions of parameters and unknowns, from which the start is made.
    pub starting: Starting,
    /// The scalars of what is asked of values, in the order of the requirements: in `new`, in `start`. None where
    /// nothing is asked.
    pub required: [Option<Program<1>>; 2],
    /// What the laws give that can make numbers which are not finite, with its own constants.
    pub not_finite: Program<1>,
    /// The pivots of loops that nothing shows to keep away from zero, with its own constants; none where there are
    /// none.
    pub pivots: Option<Program<1>>,
    /// What pictures show.
    pub shown: Tape,
    /// How many states there are.
    states: usize,
    pairs: OnceCell<Pairs>,
    reversed: OnceCell<Option<Reversed>>,
}

/// The derivatives of the rates.
#[derive(Debug)]
pub struct Derivatives {
    /// All of them, with a constant table of their own.
    pub jacobian: Program<1>,
    /// Those among states that are not of second order, with a constant table of their own, where all of them are many:
    /// what dampers do.
    pub damping: Option<Program<1>>,
}

/// Programs in pairs of operations, where that pays.
#[derive(Debug)]
pub struct Pairs {
    /// The rates.
    pub rate: Option<Paired>,
    /// The forces.
    pub forces: Option<Paired>,
}

/// The functions of the running model.
#[derive(Debug)]
pub struct Running {
    /// The table of constants that all of them read.
    pub constants: Routine,
    /// The rates of all states.
    pub rate: Routine,
    /// The guards of all switches.
    pub guards: Routine,
    /// The equations of all iterations.
    pub loops: Routine,
    /// The reactions, where joints close loops and they may not be unique; outputs then read them.
    pub reactions: Routine,
    /// The scalar outputs.
    pub outputs: Routine,
    /// The states of the pose that a projection moves.
    pub project: Routine,
    /// The momenta that it moves after that.
    pub settle: Routine,
    /// The stored energy.
    pub stored_energy: Routine,
    /// The supplied and the dissipated power.
    pub powers: Routine,
}

/// The functions for states of second order.
#[derive(Debug)]
pub struct SecondOrderPrograms {
    /// The table of constants that both read.
    pub constants: Routine,
    /// The second derivatives, from states and rates.
    pub second_derivatives: Routine,
    /// The rates with second derivatives in their places, where rates are inlined: otherwise rates and second
    /// derivatives, one after the other, take as long.
    pub forces: Option<Routine>,
}

/// First guesses, gaps and start state, each with its own constants.
#[derive(Debug)]
pub struct Starting {
    /// The first guess of each unknown.
    pub guesses: Program<1>,
    /// The gaps of the assembly.
    pub gaps: Program<1>,
    /// How large the machine is, in the unit of each.
    pub gap_sizes: Program<1>,
    /// The start state.
    pub start_state: Program<1>,
    /// What the sides of roots have the signs of, where there are any.
    pub sides: Option<Program<1>>,
    /// Of each clock the time between two instants and the first one, s, where there are any.
    pub clocks: Option<Program<1>>,
}

/// Schedules all functions of a model. The pools gain nodes of parameters and numbers.
pub fn programs(
    equations: &mut Closed,
    jacobian: &Jacobian,
    second_order: &SecondOrder,
    sizes: &mut Sizes,
) -> Programs {
    let running = running(equations);
    let derivatives = {
        let (mut jacobian, states) = (jacobian.clone(), second_order.states.clone());
        deferred(move || derivatives(&mut jacobian, &states))
    };
    let second_order = (!second_order.states.is_empty()).then(|| {
        let (mut second_order, with_forces) = (second_order.clone(), running.is_inlined());
        deferred(move || of_second_order(&mut second_order, with_forces))
    });
    let (holding, impacts) = (holding(equations), impacts(equations));
    let measured: Vec<Id> = [sizes.energy].iter().chain(&sizes.curvatures).copied().collect();
    let sizes = alone(&mut sizes.pool, "sizes", &measured);
    let starting = starting(equations);
    let fallible = roots(&equations.fallible, |law| law.value);
    let not_finite = alone(&mut equations.pool, "not_finite", &fallible);
    let pivots: Vec<Id> = equations.turning().map(|law| law.value).collect();
    let pivots = (!pivots.is_empty()).then(|| alone(&mut equations.pool, "pivots", &pivots));
    let required = [("required", false), ("required_at_start", true)]
        .map(|(name, is_of_start)| required(equations, name, is_of_start));
    let shown = tape(&equations.pool, &equations.solution, &equations.shown.quantities());
    Programs {
        running,
        derivatives,
        second_order,
        holding,
        impacts,
        sizes,
        starting,
        required,
        not_finite,
        pivots,
        shown,
        states: equations.states.len(),
        pairs: OnceCell::new(),
        reversed: OnceCell::new(),
    }
}

/// The derivatives of the rates and, where these are many, those among states that are not of second order.
fn derivatives(jacobian: &mut Jacobian, second_order: &Range<usize>) -> Derivatives {
    let (all, is_bordered) = (jacobian.roots(), !jacobian.unknowns.is_empty());
    let damping: Vec<Id> = jacobian.among_first_order(second_order).map(|entry| entry.value).collect();
    let pool = &mut jacobian.pool;
    let jacobian = alone(pool, "jacobian", &all);
    let has_damping = jacobian.routines[0].is_long() && !is_bordered && damping.len() < all.len();
    let damping = has_damping.then(|| alone(pool, "damping", &damping));
    Derivatives { jacobian, damping }
}

/// The operations of the rate function as it would be generated from the equations.
pub fn rate_operations(equations: &mut StateEquations) -> usize {
    let rates = roots(&equations.states, |state| state.rate);
    let rates = equations.solution.closed(&mut equations.pool, &rates);
    alone(&mut equations.pool, "rate", &rates).routines[0].counts.total()
}

fn roots<T>(of: &[T], root: impl Fn(&T) -> Id) -> Vec<Id> {
    of.iter().map(root).collect()
}

/// The program of one routine with constants of its own.
fn alone(pool: &mut Pool, name: &str, roots: &[Id]) -> Program<1> {
    schedule(pool, [Request { name, roots }])
}

fn running(equations: &mut StateEquations) -> Running {
    // With the unknowns of iterations after the rates: a series has to know how they change.
    let mut rates = roots(&equations.states, |state| state.rate);
    rates.extend(equations.iterations.iter().flat_map(|iteration| &iteration.values));
    let loops: Vec<Id> = equations.iterations.iter().flat_map(Iteration::equations).collect();
    let guards = roots(&equations.switches, |switch| switch.guard);
    let reactions = if equations.holding.is_shared() { equations.solution.values.clone() } else { Vec::new() };
    let outputs = roots(&equations.outputs, |output| output.value);
    let projections = roots(&equations.projections, |&(_, id)| id);
    let settled = roots(&equations.settled, |&(_, id)| id);
    let stored = [equations.balance.stored];
    let powers = [equations.balance.supplied, equations.balance.dissipated];
    let requests = [
        Request { name: "rate", roots: &rates },
        Request { name: "guards", roots: &guards },
        Request { name: "loops", roots: &loops },
        Request { name: "reactions", roots: &reactions },
        Request { name: "outputs", roots: &outputs },
        Request { name: "project", roots: &projections },
        Request { name: "settle", roots: &settled },
        Request { name: "stored_energy", roots: &stored },
        Request { name: "powers", roots: &powers },
    ];
    let Program { constants, routines } = schedule(&mut equations.pool, requests);
    let [rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers] = routines;
    Running { constants, rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers }
}

fn of_second_order(second_order: &mut SecondOrder, with_forces: bool) -> SecondOrderPrograms {
    let SecondOrder { pool, derivatives, forces, .. } = second_order;
    let second_derivatives = Request { name: "second_derivatives", roots: derivatives };
    if !with_forces {
        let Program { constants, routines: [second_derivatives] } = schedule(pool, [second_derivatives]);
        return SecondOrderPrograms { constants, second_derivatives, forces: None };
    }
    let forces = Request { name: "forces", roots: forces };
    let Program { constants, routines: [second_derivatives, forces] } = schedule(pool, [second_derivatives, forces]);
    SecondOrderPrograms { constants, second_derivatives, forces: Some(forces) }
}

/// In a pool of its own, so that it has no influence on the order of the other functions' operations.
fn holding(equations: &StateEquations) -> Option<Program<1>> {
    let entries = equations.holding.entries(&equations.pool);
    (!equations.holding.is_empty()).then(|| alone(&mut equations.pool.clone(), "hold", &entries))
}

/// In a pool of its own, too.
fn impacts(equations: &StateEquations) -> Option<Program<1>> {
    let mut pool = equations.pool.clone();
    let entries = equations.impacts.entries(&mut pool);
    (!equations.impacts.is_empty()).then(|| alone(&mut pool, "impact", &entries))
}

fn starting(equations: &mut StateEquations) -> Starting {
    let gaps = roots(&equations.assembly.gaps, |gap| gap.value);
    let starts = roots(&equations.states, |state| state.start);
    let clocks = equations.switches.iter().filter_map(|switch| switch.clock);
    let clocks: Vec<Id> = clocks.flat_map(|clock| [clock.period, clock.first]).collect();
    let (pool, requirements) = (&mut equations.pool, &mut equations.requirements);
    Starting {
        guesses: alone(pool, "guesses", &equations.assembly.guesses),
        gaps: alone(pool, "gaps", &gaps),
        gap_sizes: alone(&mut requirements.pool, "gap_sizes", &requirements.extents),
        start_state: alone(pool, "start_state", &starts),
        sides: (!equations.assembly.sides.is_empty()).then(|| alone(pool, "sides", &equations.assembly.sides)),
        clocks: (!clocks.is_empty()).then(|| alone(pool, "clocks", &clocks)),
    }
}

/// In the pool of the requirements.
fn required(equations: &mut StateEquations, name: &str, is_of_start: bool) -> Option<Program<1>> {
    let requirements = &mut equations.requirements;
    let values: Vec<Id> = requirements.of(is_of_start).map(|requirement| requirement.value).collect();
    (!values.is_empty()).then(|| alone(&mut requirements.pool, name, &values))
}

impl Running {
    /// Whether rates are inlined where they are compiled for the machine's vectors, and so take these.
    #[must_use]
    pub fn is_inlined(&self) -> bool {
        self.rate.counts.total() <= INLINED
    }

    /// All of them; those of iterations and of rigid joints where there are any.
    #[must_use]
    pub fn routines(&self) -> Vec<&Routine> {
        let where_any = |routine| Some(routine).filter(|routine: &&Routine| !routine.results.is_empty());
        let Self { rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers, .. } = self;
        [rate, guards]
            .into_iter()
            .chain(where_any(loops))
            .chain(where_any(reactions))
            .chain([outputs, project])
            .chain(where_any(settle))
            .chain([stored_energy, powers])
            .collect()
    }
}

impl Running {
    /// All of them with their operations.
    pub fn costs(&self) -> impl Iterator<Item = (&str, Counts)> {
        self.routines().into_iter().map(|routine| (routine.name.as_str(), routine.counts))
    }
}

impl SecondOrderPrograms {
    /// The operations of a rate, which has so many, and of one with second derivatives.
    #[must_use]
    pub fn operations(&self, rate: usize) -> [usize; 2] {
        let one_after_the_other = rate + self.second_derivatives.counts.total();
        [rate, self.forces.as_ref().map_or(one_after_the_other, |forces| forces.counts.total())]
    }

    /// Both, or the one that there is.
    pub fn routines(&self) -> impl Iterator<Item = &Routine> {
        [&self.second_derivatives].into_iter().chain(&self.forces)
    }
}

impl Starting {
    /// All of them.
    pub fn programs(&self) -> impl Iterator<Item = &Program<1>> {
        [&self.guesses, &self.gaps, &self.gap_sizes, &self.start_state]
            .into_iter()
            .chain(&self.sides)
            .chain(&self.clocks)
    }
}

impl Programs {
    /// Rates and forces in pairs. They are sought when they are first asked for: that takes as long as all the rest,
    /// and who interprets programs has no use for them.
    pub fn pairs(&self) -> &Pairs {
        self.pairs.get_or_init(|| Pairs {
            rate: pair(&self.running.rate, Search::Thorough),
            forces: self.second_order.as_ref().and_then(|second| pair(second.forces.as_ref()?, Search::Thorough)),
        })
    }

    /// How what the functions of the running model give depends on states and constants; made when it is first asked
    /// for. None where rates are not inlined: of longer ones the sweeps, three times as long, are too much to check in
    /// each build.
    pub fn reversed(&self) -> Option<&Reversed> {
        let made = || self.running.is_inlined().then(|| reversed(&self.running, self.states));
        self.reversed.get_or_init(made).as_ref()
    }

    /// The functions that are called while the model runs, with their operations.
    pub fn costs(&self) -> impl Iterator<Item = (&str, Counts)> {
        let running = self.running.routines().into_iter();
        let second_order = self.second_order.iter().flat_map(|second| second.routines());
        let holding = self.holding.iter().chain(&self.impacts).flat_map(|program| &program.routines);
        let Derivatives { jacobian, damping } = &*self.derivatives;
        let jacobian = [jacobian].into_iter().chain(damping).flat_map(|program| &program.routines);
        let routines = running.chain(jacobian).chain(second_order).chain(holding);
        routines.map(|routine| (routine.name.as_str(), routine.counts))
    }
}
