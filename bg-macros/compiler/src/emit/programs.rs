//! The programs of a model's functions.
//!
//! In: equations, the derivatives of the rates and the second derivatives. Out: what every generated function evaluates, in order, with its table of
//! constants.

use crate::equations::StateEquations;
use crate::expr::Id;
use crate::jacobian::Jacobian;
use crate::pairs::{Paired, pair};
use crate::program::{Program, Request, Routine, schedule};
use crate::second::Second;

/// Longer rates are not inlined into an integrator's step: they would only fill the cache.
const INLINED: usize = 400;

/// The programs of all generated functions.
pub(super) struct Programs {
    /// Functions of the running model; they share one constant table.
    pub dynamic: Program,
    /// The rates with operations done two at a time, where that pays.
    pub paired: Option<Paired>,
    /// The derivatives of the rates, with a constant table of its own.
    pub jacobian: Program,
    /// What there is for states of second order, with a constant table of its own.
    pub second: Option<SecondOrder>,
    /// What joints hold, with a constant table of its own.
    pub holding: Option<Program>,
    /// First guesses, gaps and start state: functions of parameters and unknowns, each with its own constants.
    pub starting: [Program; 3],
}

/// The programs of the functions for states of second order.
pub(super) struct SecondOrder {
    /// The second derivatives, and behind them the forces where rates are inlined: otherwise rates and second derivatives, one after
    /// the other, take as long.
    pub program: Program,
    /// The forces with operations done two at a time, where that pays.
    pub paired: Option<Paired>,
}

/// A table of what depends on parameters only.
pub(super) struct Table<'a> {
    /// What the names of the table, of its pairs and of their functions begin with.
    pub prefix: &'static str,
    pub doc: &'static str,
    pub program: &'a Program,
    /// The routine that reads pairs of the table.
    pub paired: Option<&'a Paired>,
}

impl Programs {
    pub fn new(equations: &mut StateEquations, jacobian: &mut Jacobian, second: &mut Second) -> Self {
        let of = |ids: &mut dyn Iterator<Item = Id>| ids.collect::<Vec<Id>>();
        let rates = of(&mut equations.states.iter().map(|state| state.rate));
        let guards = of(&mut equations.switches.iter().map(|switch| switch.guard));
        let outputs = of(&mut equations.outputs.iter().map(|output| output.value));
        let projections = of(&mut equations.projections.iter().map(|&(_, id)| id));
        let starts = of(&mut equations.states.iter().map(|state| state.start));
        let gaps = of(&mut equations.gaps.iter().map(|gap| gap.value));
        let guesses = equations.guesses.clone();
        let stored = [equations.stored];
        let powers = [equations.supplied, equations.dissipated];
        let derivatives = jacobian.roots();
        let requests = [
            Request { name: "rate", roots: &rates },
            Request { name: "guards", roots: &guards },
            Request { name: "outputs", roots: &outputs },
            Request { name: "project", roots: &projections },
            Request { name: "stored_energy", roots: &stored },
            Request { name: "powers", roots: &powers },
        ];
        let dynamic = schedule(&mut equations.pool, &requests);
        let paired = pair(&dynamic.routines[0]);
        let jacobian = schedule(&mut jacobian.pool, &[Request { name: "jacobian", roots: &derivatives }]);
        let second = (!second.states.is_empty()).then(|| {
            let Second { pool, derivatives, forces, .. } = second;
            let requests =
                [Request { name: "second_derivatives", roots: derivatives }, Request { name: "forces", roots: forces }];
            let program = schedule(pool, if is_inlined(&dynamic) { &requests } else { &requests[..1] });
            let paired = program.routines.get(1).and_then(pair);
            SecondOrder { program, paired }
        });
        let entries = equations.holding.entries();
        let holding = (!equations.holding.is_empty())
            .then(|| schedule(&mut equations.pool.clone(), &[Request { name: "hold", roots: &entries }]));
        let mut alone = |name, roots: &[Id]| schedule(&mut equations.pool, &[Request { name, roots }]);
        let starting = [alone("guesses", &guesses), alone("gaps", &gaps), alone("start_state", &starts)];
        Self { dynamic, paired, jacobian, second, holding, starting }
    }

    /// Whether rates are inlined into an integrator's step, and so take the vectors that it takes.
    pub fn is_inlined(&self) -> bool {
        is_inlined(&self.dynamic)
    }

    /// The tables of the running model.
    pub fn tables(&self) -> Vec<Table<'_>> {
        let table = |prefix, doc, program, paired| Table { prefix, doc, program, paired };
        let mut tables = vec![
            table("constant", " What depends on parameters only.", &self.dynamic, self.paired.as_ref()),
            table("slope_constant", " What depends on parameters only, of the Jacobian.", &self.jacobian, None),
        ];
        tables.extend(self.second.as_ref().map(|SecondOrder { program, paired }| {
            table("second_constant", " What depends on parameters only, of forces.", program, paired.as_ref())
        }));
        let held =
            |program| table("holding_constant", " What depends on parameters only, of held motions.", program, None);
        tables.extend(self.holding.as_ref().map(held));
        tables
    }

    /// The functions of the running model.
    pub fn routines(&self) -> impl Iterator<Item = &Routine> {
        self.tables().into_iter().flat_map(|table| &table.program.routines)
    }
}

fn is_inlined(dynamic: &Program) -> bool {
    dynamic.routines[0].counts.total() <= INLINED
}
