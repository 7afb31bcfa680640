//! The programs of a model's functions.
//!
//! In: equations, the derivatives of the rates and the second derivatives. Out: what every generated function evaluates, in order, with its table of
//! constants.

use crate::equations::StateEquations;
use crate::expr::Id;
use crate::jacobian::Jacobian;
use crate::pairs::{Paired, pair};
use crate::program::{Program, Request, schedule};
use crate::second::Second;

/// The programs of all generated functions.
pub(super) struct Programs {
    /// Functions of the running model; they share one constant table.
    pub dynamic: Program,
    /// The rates with operations done two at a time, where that pays.
    pub paired: Option<Paired>,
    /// The derivatives of the rates, with a constant table of its own.
    pub jacobian: Program,
    /// The second derivatives of the states of second order, with a constant table of its own.
    pub second: Program,
    /// The forces with operations done two at a time, where that pays.
    pub paired_forces: Option<Paired>,
    /// First guesses, gaps and start state: functions of parameters and unknowns, each with its own constants.
    pub starting: [Program; 3],
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
        let (derivatives, forces) = (second.derivatives.clone(), second.forces.clone());
        let requests = [
            Request { name: "forces", roots: if second.states.is_empty() { &[] } else { &forces } },
            Request { name: "second_derivatives", roots: &derivatives },
        ];
        let second = schedule(&mut second.pool, &requests);
        let paired_forces = pair(&second.routines[0]);
        let mut alone = |name, roots: &[Id]| schedule(&mut equations.pool, &[Request { name, roots }]);
        let starting = [alone("guesses", &guesses), alone("gaps", &gaps), alone("start_state", &starts)];
        Self { dynamic, paired, jacobian, second, paired_forces, starting }
    }
}
