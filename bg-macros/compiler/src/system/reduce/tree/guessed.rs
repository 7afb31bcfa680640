//! Start velocities that are guessed.
//!
//! In: equations whose bodies keep their states. Out: what of each body's velocity the start looks for, and whether the
//! joints determine all of it. Where they do, the speeds of joints can be looked for in its place, with the same
//! result. Method: the rank of the flows by the unknowns at the first guesses. It is at most the one elsewhere, so that
//! a rank which is full there is full but for places of measure zero.

use std::collections::BTreeSet;

use super::bodies::Body;
use super::numbers;
use crate::expr::{Environment, Id, Pool, Symbol, evaluate, substitute};
use crate::system::equations::{Assembly, StateEquations};
use crate::system::reduce::friction;

/// What of a body's velocity the start looks for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sought {
    Nothing,
    /// The velocity of its centre of mass, not its spin.
    Velocity,
    /// Velocity and spin.
    Motion,
    /// Some components, or what other states depend on as well.
    Other,
}

/// What the start looks for.
pub(super) struct Guessed {
    /// The states with the first guesses.
    pub start: Vec<f64>,
    speeds: BTreeSet<Symbol>,
    /// Of each body.
    sought: Vec<Sought>,
    is_determined: bool,
}

impl Guessed {
    pub fn of(equations: &StateEquations, bodies: &[Body], parameters: &[f64]) -> Self {
        let speeds: BTreeSet<Symbol> =
            equations.assembly.speeds.iter().map(|&place| Symbol::numbered(Symbol::Unknown, place)).collect();
        let mut trial = Trial::new(equations, parameters);
        let sought = bodies.iter().map(|body| trial.sought(body, &speeds)).collect();
        let is_determined = speeds.is_empty() || trial.is_determined();
        Self { start: trial.states.swap_remove(0), speeds, sought, is_determined }
    }

    /// Whether this depends on a velocity that is looked for.
    pub fn has(&self, pool: &Pool, id: Id) -> bool {
        !pool.symbols(&[id]).is_disjoint(&self.speeds)
    }

    /// Whether the speeds of a joint from a body, or the ground, to another one are as the start gives them, where they
    /// are those of its flows that depend on nothing that is looked for.
    pub fn fits(&self, parent: Option<usize>, child: usize, slides: bool) -> bool {
        let parent = parent.map_or(Sought::Nothing, |parent| self.sought[parent]);
        match (parent, self.sought[child]) {
            (Sought::Nothing, Sought::Nothing) => true,
            (Sought::Nothing | Sought::Velocity, Sought::Velocity) => self.is_determined && !slides,
            (Sought::Other, _) => false,
            (_, Sought::Motion) => self.is_determined,
            _ => false,
        }
    }

    /// Whether all of a body's motion is looked for.
    pub fn is_sought(&self, body: usize) -> bool {
        self.sought[body] == Sought::Motion
    }
}

/// A speed that is looked for from this guess on.
pub(super) fn sought(equations: &mut StateEquations, speed: Id) -> Id {
    let StateEquations { pool, assembly: Assembly { guesses, speeds, .. }, .. } = equations;
    let first = |symbol| if let Symbol::Unknown(place) = symbol { Some(guesses[place as usize]) } else { None };
    let guess = substitute(pool, &[speed], &first)[0];
    speeds.push(guesses.len());
    guesses.push(guess);
    pool.symbol(Symbol::numbered(Symbol::Unknown, guesses.len() - 1))
}

/// The values of the states at the start, with these of the parameters and the first guesses, `more` one with 1 more of
/// it.
fn starts(equations: &StateEquations, parameters: &[f64], more: Option<usize>) -> Vec<f64> {
    let given = Environment { parameters, ..Environment::default() };
    let mut unknowns = evaluate(&equations.pool, &equations.assembly.guesses, &given);
    more.into_iter().for_each(|unknown| unknowns[unknown] += 1.0);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    evaluate(&equations.pool, &starts, &Environment { unknowns: &unknowns, ..given })
}

/// Starts that differ in one unknown each.
struct Trial<'a> {
    equations: &'a StateEquations,
    parameters: &'a [f64],
    /// The states with the first guesses, then for each speed with one more of it.
    states: Vec<Vec<f64>>,
}

impl<'a> Trial<'a> {
    fn new(equations: &'a StateEquations, parameters: &'a [f64]) -> Self {
        let trials = [None].into_iter().chain(equations.assembly.speeds.iter().copied().map(Some));
        let states = trials.map(|more| starts(equations, parameters, more)).collect();
        Self { equations, parameters, states }
    }

    fn sought(&self, body: &Body, speeds: &BTreeSet<Symbol>) -> Sought {
        let StateEquations { pool, states, .. } = self.equations;
        let of = |of: &mut dyn Iterator<Item = usize>| -> BTreeSet<Symbol> {
            let starts: Vec<Id> = of.map(|state| states[state].start).collect();
            pool.symbols(&starts).intersection(speeds).copied().collect()
        };
        let momenta: Vec<usize> = body.linear.iter().chain(&body.angular).copied().collect();
        let (linear, angular) = (of(&mut body.linear.iter().copied()), of(&mut body.angular.iter().copied()));
        let others = of(&mut (0..states.len()).filter(|state| !momenta.contains(state)));
        let all: BTreeSet<Symbol> = linear.union(&angular).copied().collect();
        let moved = |momenta: &[usize]| {
            let row = |trial: &Vec<f64>| momenta.iter().map(|&state| trial[state] - self.states[0][state]).collect();
            numbers::rank(self.states[1..].iter().map(row).collect())
        };
        match (all.len(), angular.len()) {
            _ if !all.is_disjoint(&others) => Sought::Other,
            (0, _) => Sought::Nothing,
            (3, 0) if moved(&body.linear) == 3 => Sought::Velocity,
            (6, _) if moved(&momenta) == 6 => Sought::Motion,
            _ => Sought::Other,
        }
    }

    /// Whether what joints hold determines all speeds.
    fn is_determined(&self) -> bool {
        let StateEquations { pool, reactions, holding, .. } = self.equations;
        let rigid = reactions[..friction::rigid(reactions)].iter().map(|reaction| reaction.slip.flow);
        let flows: Vec<Id> = rigid.chain(holding.compliant.iter().map(|slip| slip.flow)).collect();
        let is_known = |symbol| matches!(symbol, Symbol::State(_) | Symbol::Parameter(_));
        if pool.has_select(&flows) || !pool.symbols(&flows).into_iter().all(is_known) {
            return false;
        }
        let at = |states: &Vec<f64>| {
            let given = Environment { states, parameters: self.parameters, ..Environment::default() };
            evaluate(pool, &flows, &given)
        };
        let first = at(&self.states[0]);
        let row = |states: &Vec<f64>| at(states).iter().zip(&first).map(|(more, first)| more - first).collect();
        numbers::rank(self.states[1..].iter().map(row).collect()) == self.states.len() - 1
    }
}
