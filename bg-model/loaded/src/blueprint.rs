//! What a model is made of, once for all its parameters: its tables and its programs.
//!
//! In: a [`Compiled`]. Out: a [`Blueprint`], of which [`Interpreted`](crate::Interpreted) makes models. Derivatives,
//! what is for states of second order and the elimination are made when they are first asked for: many runs do without.

use std::ops::Range;
use std::sync::Arc;

use bg_compiler::expr::Symbol;
use bg_compiler::pipeline::Compiled;
use bg_compiler::program::{
    Deferred, Derivatives, Operand, Operation, Program, Programs, Reverse, Reversed, Routine, Running,
    SecondOrderPrograms, Starting, deferred, reversed,
};
use bg_compiler::tables::{self, Counted, EliminationTable, Loop};
use bg_model::delay::States;
use bg_model::linear::Sparsity;
use bg_model::linear::table::Slot;

use crate::code::Code;
use crate::series::SeriesCode;
use crate::statics::{Statics, places, statics};

/// A model, whatever its parameters, inputs and numbers.
#[derive(Debug)]
pub struct Blueprint {
    pub(crate) statics: Statics,
    pub(crate) programs: Codes,
    pub(crate) closing_rows: usize,
    pub(crate) projected: Vec<usize>,
    pub(crate) settled: Vec<usize>,
    pub(crate) second: Range<usize>,
    pub(crate) first_branches: Vec<bool>,
    pub(crate) memories: Vec<usize>,
    pub(crate) clocks: Vec<usize>,
    pub(crate) delays: &'static [States],
    pub(crate) loops: Vec<Loop>,
    pub(crate) elimination: Deferred<Elimination>,
}

/// How I - c J is factored and solved.
#[derive(Debug)]
pub struct Elimination {
    pub slots: Vec<Slot>,
    pub products: Vec<(u32, u32)>,
    pub steps: Vec<(u32, u32, u32)>,
    /// States, then unknowns.
    pub rows: usize,
}

/// A program with constants of its own.
#[derive(Debug)]
pub struct Alone {
    pub constants: Code,
    pub code: Code,
}

/// All programs.
#[derive(Debug)]
pub struct Codes {
    /// Those of the running model have the same constants.
    pub constants: Code,
    pub rate: Code,
    pub guards: Code,
    pub loops: Code,
    pub reactions: Code,
    pub outputs: Code,
    pub project: Code,
    pub settle: Code,
    pub stored_energy: Code,
    pub powers: Code,
    pub derivatives: Deferred<DerivativeCodes>,
    pub second: Option<Deferred<Second>>,
    pub holding: Option<Alone>,
    pub impacts: Option<Alone>,
    pub sizes: Alone,
    pub guesses: Alone,
    pub gaps: Alone,
    pub gap_sizes: Alone,
    pub start_state: Alone,
    pub sides: Option<Alone>,
    pub clocks: Option<Alone>,
    pub required: Option<Alone>,
    pub required_at_start: Option<Alone>,
    pub not_finite: Alone,
    pub pivots: Option<Alone>,
    pub series: Deferred<SeriesCode>,
    pub sweeps: Deferred<Sweeps>,
}

/// The reverse sweeps of the programs that a run is made of, which have the same constants.
#[derive(Debug)]
pub struct Sweeps {
    pub rate: Sweep,
    /// None where outputs read reactions.
    pub outputs: Option<Sweep>,
    pub project: Sweep,
    pub settle: Sweep,
}

/// How a weighted sum of a program's results depends on states and constants.
#[derive(Debug)]
pub struct Sweep {
    pub code: Code,
    /// By what each of its results is the derivative: states and constants.
    pub leaves: Vec<Operand>,
}

/// The derivatives of the rates.
#[derive(Debug)]
pub struct DerivativeCodes {
    pub jacobian: Alone,
    /// Those among states that are not of second order, with their places, where they have a program.
    pub damping: Option<(Sparsity, Alone)>,
}

/// The programs for states of second order.
#[derive(Debug)]
pub struct Second {
    pub constants: Code,
    pub derivatives: Code,
    /// Rates with second derivatives in their places, where they are one program.
    pub forces: Option<Code>,
    /// The operations of a rate and of one with second derivatives.
    pub operations: [u32; 2],
}

impl Blueprint {
    /// The blueprint of a compiled model.
    #[must_use]
    pub fn of(model: Compiled, counted: Counted) -> Self {
        let tables = tables::tables(&model, counted);
        let statics = statics(&tables);
        let damped = tables::damping(&model);
        let Compiled { equations, programs, elimination, .. } = model;
        let (rows, states) = (Rows(equations.solution.multipliers.as_slice().into()), equations.states.len());
        Self {
            statics,
            programs: codes(programs, &rows, states, damped, !tables.loops.is_empty()),
            elimination: deferred(move || self::elimination(&tables::elimination(&elimination))),
            closing_rows: tables.closing_rows,
            projected: tables.projected,
            settled: tables.settled,
            second: tables.second,
            first_branches: tables.first_branches,
            memories: tables.memories,
            delays: crate::statics::delays(&tables.delays),
            clocks: tables.clocks,
            loops: tables.loops,
        }
    }

    /// The tables of its parameters, inputs, states and outputs.
    #[must_use]
    pub fn description(&self) -> &'static bg_model::description::Description {
        self.statics.description
    }

    /// Translates all programs of a running model to machine code, which else is done when it pays; gives how many
    /// there are now.
    pub fn translate(&self) -> usize {
        self.programs.running().into_iter().filter(|code| code.translate()).count()
    }

    /// How many unknowns of algebraic loops there are.
    pub(crate) fn found(&self) -> usize {
        self.loops.iter().map(|of| of.unknowns).sum()
    }
}

impl Codes {
    /// Those that are evaluated while a model runs.
    fn running(&self) -> Vec<&Code> {
        let derivatives = [&self.derivatives.jacobian]
            .into_iter()
            .chain(self.derivatives.damping.as_ref().map(|(_, of)| of))
            .chain(&self.holding)
            .chain(&self.impacts)
            .chain(&self.pivots)
            .chain([&self.sizes, &self.not_finite])
            .map(|of| &of.code);
        let second = self.second.as_deref();
        let second = second.into_iter().flat_map(|of| [&of.derivatives].into_iter().chain(&of.forces));
        let Self { rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers, .. } = self;
        [rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers]
            .into_iter()
            .chain(derivatives)
            .chain(second)
            .chain(self.series.codes())
            .collect()
    }
}

/// The reactions in the order of their rows.
#[derive(Clone)]
struct Rows(Arc<[Symbol]>);

impl Rows {
    /// The program of a routine, in which reactions have the numbers of their rows.
    fn code(&self, routine: &Routine) -> Code {
        Code::of(&self.numbered(routine))
    }

    fn alone(&self, of: &Program<1>) -> Alone {
        Alone { constants: self.code(&of.constants), code: self.code(&of.routines[0]) }
    }

    fn numbered(&self, routine: &Routine) -> Routine {
        let operand = |operand: Operand| match operand {
            Operand::Symbol(symbol @ Symbol::Multiplier(_)) => {
                let row = self.0.iter().position(|&other| other == symbol);
                Operand::Symbol(Symbol::numbered(Symbol::Multiplier, row.expect("a reaction that is solved for")))
            }
            other => other,
        };
        let mut routine = routine.clone();
        for of in &mut routine.assignments {
            of.operation = Operation::map(&of.operation, operand);
        }
        routine.results.iter_mut().for_each(|result| *result = operand(*result));
        routine
    }
}

fn codes(programs: Programs, rows: &Rows, states: usize, damped: Vec<(usize, usize)>, finds: bool) -> Codes {
    let (code, alone) = (|routine: &Routine| rows.code(routine), |of: &Program<1>| rows.alone(of));
    let some = |of: &Option<Program<1>>| of.as_ref().map(alone);
    let Programs {
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
        ..
    } = programs;
    let running = Arc::new(running);
    let Running { constants, rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers } =
        &*running;
    let Starting { guesses, gaps, gap_sizes, start_state, sides, clocks } = &starting;
    // The unknowns of iterations come after the rates: only series have a use for them.
    let rates = Routine { results: rate.results[..states].to_vec(), ..rate.clone() };
    Codes {
        constants: code(constants),
        rate: code(&rates).in_pairs(),
        guards: code(guards),
        loops: code(loops),
        reactions: code(reactions),
        outputs: code(outputs),
        project: code(project),
        settle: code(settle),
        stored_energy: code(stored_energy),
        powers: code(powers),
        derivatives: derivative_codes(derivatives, rows.clone(), damped),
        second: second_order.map(|of| second(of, rows.clone(), rate.counts.total())),
        holding: some(&holding),
        impacts: some(&impacts),
        sizes: alone(&sizes),
        guesses: alone(guesses),
        gaps: alone(gaps),
        gap_sizes: alone(gap_sizes),
        start_state: alone(start_state),
        sides: some(sides),
        clocks: some(clocks),
        required: some(&required[0]),
        required_at_start: some(&required[1]),
        not_finite: alone(&not_finite),
        pivots: some(&pivots),
        series: {
            let running = Arc::clone(&running);
            deferred(move || SeriesCode::of(&running.rate, finds))
        },
        sweeps: sweeps(running, rows.clone(), states),
    }
}

fn sweeps(running: Arc<Running>, rows: Rows, states: usize) -> Deferred<Sweeps> {
    deferred(move || {
        let of = |Reverse { routine, leaves }: &Reverse| Sweep { code: rows.code(routine), leaves: leaves.clone() };
        let Reversed { rate, outputs, project, settle } = &reversed(&running, states);
        Sweeps { rate: of(rate), outputs: outputs.as_ref().map(of), project: of(project), settle: of(settle) }
    })
}

fn derivative_codes(of: Deferred<Derivatives>, rows: Rows, damped: Vec<(usize, usize)>) -> Deferred<DerivativeCodes> {
    deferred(move || {
        let Derivatives { jacobian, damping } = &*of;
        let damping = damping.as_ref().map(|of| (Sparsity::Places(places(&damped)), rows.alone(of)));
        DerivativeCodes { jacobian: rows.alone(jacobian), damping }
    })
}

fn second(of: Deferred<SecondOrderPrograms>, rows: Rows, rate: usize) -> Deferred<Second> {
    let small = |count: usize| u32::try_from(count).expect("fewer than 2^32 operations");
    deferred(move || Second {
        constants: rows.code(&of.constants),
        derivatives: rows.code(&of.second_derivatives),
        forces: of.forces.as_ref().map(|forces| rows.code(forces).in_pairs()),
        operations: of.operations(rate).map(small),
    })
}

fn elimination(of: &EliminationTable) -> Elimination {
    let small = |index: usize| u32::try_from(index).expect("fewer than 2^32 factors");
    let slot = |of: &tables::Slot| Slot {
        entry: of.entry.map(small),
        end: small(of.end),
        is_pivot: of.is_pivot,
        of_unknown: of.of_unknown,
        scale: of.scale.map(small),
    };
    Elimination {
        slots: of.slots.iter().map(slot).collect(),
        products: of.products.iter().map(|&(left, right)| (small(left), small(right))).collect(),
        steps: of.steps.iter().map(|&(row, factor, column)| (small(row), small(factor), small(column))).collect(),
        rows: of.rows,
    }
}
