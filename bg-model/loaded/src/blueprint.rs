//! What a model is made of, once for all its parameters: its tables and its programs.
//!
//! In: a [`Compiled`]. Out: a [`Blueprint`], of which [`Interpreted`](crate::Interpreted) makes models.

use std::ops::Range;

use bg_compiler::expr::Symbol;
use bg_compiler::pipeline::Compiled;
use bg_compiler::program::{self, Operand, Operation, Programs, Routine, Running, SecondOrderPrograms, Starting};
use bg_compiler::tables::{EliminationTable, Loop, tables};
use bg_model::linear::table::Slot;

use crate::code::Code;
use crate::series::SeriesCode;
use crate::statics::{Statics, statics};

/// A model, whatever its parameters, inputs and numbers.
#[derive(Clone, Debug)]
pub struct Blueprint {
    pub(crate) statics: Statics,
    pub(crate) programs: Codes,
    pub(crate) closing_rows: usize,
    pub(crate) projected: Vec<usize>,
    pub(crate) settled: Vec<usize>,
    pub(crate) second: Range<usize>,
    pub(crate) operations_of_forces: Option<[u32; 2]>,
    pub(crate) first_branches: Vec<bool>,
    pub(crate) loops: Vec<Loop>,
    pub(crate) elimination: Elimination,
}

/// How I - c J is factored and solved.
#[derive(Clone, Debug)]
pub struct Elimination {
    pub slots: Vec<Slot>,
    pub products: Vec<(u32, u32)>,
    pub steps: Vec<(u32, u32, u32)>,
    /// States, then unknowns.
    pub rows: usize,
}

/// A program with constants of its own.
#[derive(Clone, Debug)]
pub struct Alone {
    pub constants: Code,
    pub code: Code,
}

/// All programs.
#[derive(Clone, Debug)]
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
    pub jacobian: Alone,
    pub damping: Option<Alone>,
    pub second: Option<Second>,
    pub holding: Option<Alone>,
    pub impacts: Option<Alone>,
    pub sizes: Alone,
    pub guesses: Alone,
    pub gaps: Alone,
    pub gap_sizes: Alone,
    pub start_state: Alone,
    pub sides: Option<Alone>,
    pub required: Option<Alone>,
    pub required_at_start: Option<Alone>,
    pub not_finite: Alone,
    pub series: SeriesCode,
}

/// The programs for states of second order.
#[derive(Clone, Debug)]
pub struct Second {
    pub constants: Code,
    pub derivatives: Code,
    /// Rates with second derivatives in their places, where they are one program.
    pub forces: Option<Code>,
}

impl Blueprint {
    /// The blueprint of a compiled model.
    #[must_use]
    pub fn of(model: &Compiled) -> Self {
        let tables = tables(model);
        let Programs { running, second_order, .. } = &model.programs;
        let small = |count: usize| u32::try_from(count).expect("fewer than 2^32 operations");
        Self {
            statics: statics(&tables),
            programs: codes(model),
            operations_of_forces: second_order.as_ref().map(|second| second.operations(running).map(small)),
            elimination: elimination(&tables.elimination),
            closing_rows: tables.closing_rows,
            projected: tables.projected,
            settled: tables.settled,
            second: tables.second,
            first_branches: tables.first_branches,
            loops: tables.loops,
        }
    }

    /// The tables of its parameters, inputs, states and outputs.
    #[must_use]
    pub fn description(&self) -> &'static bg_model::description::Description {
        self.statics.description
    }

    /// How many unknowns of algebraic loops there are.
    pub(crate) fn found(&self) -> usize {
        self.loops.iter().map(|of| of.unknowns).sum()
    }
}

fn codes(model: &Compiled) -> Codes {
    // The reactions have the numbers of their rows, as the table of what is calculated for them.
    let code = |routine: &Routine| Code::of(&in_rows(model, routine));
    let alone = |of: &program::Program<1>| Alone { constants: code(&of.constants), code: code(&of.routines[0]) };
    let some = |of: &Option<program::Program<1>>| of.as_ref().map(alone);
    let Programs { running, jacobian, damping, second_order, holding, impacts, sizes, starting, required, .. } =
        &model.programs;
    let Running { constants, rate, guards, loops, reactions, outputs, project, settle, stored_energy, powers, .. } =
        running;
    let Starting { guesses, gaps, gap_sizes, start_state, sides } = starting;
    let second = |of: &SecondOrderPrograms| Second {
        constants: code(&of.constants),
        derivatives: code(&of.second_derivatives),
        forces: of.forces.as_ref().map(code),
    };
    Codes {
        constants: code(constants),
        rate: code(rate),
        guards: code(guards),
        loops: code(loops),
        reactions: code(reactions),
        outputs: code(outputs),
        project: code(project),
        settle: code(settle),
        stored_energy: code(stored_energy),
        powers: code(powers),
        jacobian: alone(jacobian),
        damping: some(damping),
        second: second_order.as_ref().map(second),
        holding: some(holding),
        impacts: some(impacts),
        sizes: alone(sizes),
        guesses: alone(guesses),
        gaps: alone(gaps),
        gap_sizes: alone(gap_sizes),
        start_state: alone(start_state),
        sides: some(sides),
        required: some(&required[0]),
        required_at_start: some(&required[1]),
        not_finite: alone(&model.programs.not_finite),
        series: SeriesCode::of(rate, model.equations.found() > 0),
    }
}

/// The routine with the row of each reaction in place of its number.
fn in_rows(model: &Compiled, routine: &Routine) -> Routine {
    let operand = |operand: Operand| match operand {
        Operand::Symbol(symbol @ Symbol::Multiplier(_)) => {
            let row = model.equations.solution.row(symbol).expect("a reaction that is solved for");
            Operand::Symbol(Symbol::numbered(Symbol::Multiplier, row))
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

fn elimination(of: &EliminationTable) -> Elimination {
    let small = |index: usize| u32::try_from(index).expect("fewer than 2^32 factors");
    let slot = |of: &bg_compiler::tables::Slot| Slot {
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
