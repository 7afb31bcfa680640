//! Which rows of rigid joints are solved for which momenta.
//!
//! In: reactions, rates, energies. Out: [`Choice`]: the solved rows, an expression of the states that stay for each
//! that goes. Method: the rows are gone through in their order.
//! A translation is solved for the momentum of a body in its direction where the coefficient of this body's velocity is
//! a number; the gap gives the body's position then. A rotation of two bodies is solved where their angular velocities
//! are equal by it and their orientations start alike: these stay equal, and the gap is zero identically.

use std::collections::{BTreeMap, BTreeSet};

use super::dyad::{Root, Turned};
use super::report::Fate;
use super::speeds::of_kind;
use super::zero::{ROUNDING, value, vanishes};
use super::{angle, friction, reaction};
use crate::expr::{Circles, Id, Pool, Symbol, derivative, partial, same_polynomial, substitute};
use crate::system::equations::{Balance, Kind, Origin, StateEquations};

/// Solved rows and what they determine.
pub(super) struct Choice {
    /// How many rows are those of rigid joints; they come first.
    pub rigid: usize,
    /// The solved rows, each with its momentum.
    pub rows: Vec<(usize, usize)>,
    /// Each state that goes, as an expression of those that stay.
    pub images: BTreeMap<usize, Id>,
    /// What the report says of these.
    pub fates: BTreeMap<usize, Fate>,
    /// For each row how its reaction changes each momentum; none where it acts on something else or not linearly.
    pub loads: Vec<Option<BTreeMap<usize, Id>>>,
    /// The velocity of each momentum: the derivative of the energy.
    pub velocities: BTreeMap<usize, Id>,
    /// The cosines and sines of the angles that stay, and of those that loops give.
    pub circles: Circles,
    /// The orientations that loops give, over the states that stay: put in last.
    pub given: Images,
    /// The roots by which loops are closed.
    pub roots: Vec<Root>,
    /// The pins among the joints that close them.
    pub turned: Vec<Turned>,
}

/// States with their images.
pub(super) type Images = BTreeMap<usize, Id>;

impl Choice {
    /// What can be solved; none where nothing can. With `links` loops are closed in closed form, for the links of these
    /// orientations without a proof that it holds in all poses.
    pub fn of(equations: &mut StateEquations, links: Option<&[String]>) -> Option<Self> {
        let rigid = friction::rigid(&equations.reactions);
        let momenta: Vec<usize> = of_kind(equations, Kind::Momentum).collect();
        let velocities = velocities(equations, &momenta)?;
        let loads = (0..rigid).map(|row| loads(equations, row, &momenta)).collect();
        let mut choice = Self {
            rigid,
            rows: Vec::new(),
            images: BTreeMap::new(),
            fates: BTreeMap::new(),
            loads,
            velocities,
            circles: Circles::default(),
            given: Images::new(),
            roots: Vec::new(),
            turned: Vec::new(),
        };
        for row in 0..rigid {
            let solved = choice.translation(equations, row).or_else(|| choice.rotation(equations, row));
            if let Some((momentum, images)) = solved {
                choice.rows.push((row, momentum));
                choice.add(equations, row, images);
            }
        }
        choice.circles = choice.circles(equations);
        if let Some(links) = links {
            choice.close_loops(equations, links);
        }
        let (states, before): (Vec<usize>, Vec<Id>) = choice.images.iter().map(|(&state, &id)| (state, id)).unzip();
        let after = choice.circles.shortened(&mut equations.pool, &before);
        choice.images = states.into_iter().zip(after).collect();
        (!choice.rows.is_empty()).then_some(choice)
    }

    /// The cosines and sines among the states that stay.
    fn circles(&self, equations: &mut StateEquations) -> Circles {
        let turns = angle::turns(equations);
        let stays = |state: &usize| !self.images.contains_key(state);
        let turns = turns.into_iter().filter(|turn| stays(&turn.cosine) && stays(&turn.sine));
        let mut symbol = |state: usize| equations.pool.symbol(Symbol::state(state));
        Circles::new(turns.map(|turn| (symbol(turn.cosine), symbol(turn.sine))).collect())
    }

    /// For each state whether it stays.
    pub fn kept(&self, equations: &StateEquations) -> Vec<bool> {
        (0..equations.states.len())
            .map(|state| !self.images.contains_key(&state) && !self.given.contains_key(&state))
            .collect()
    }

    /// Whether a row is solved.
    pub fn is_solved(&self, row: usize) -> bool {
        self.rows.iter().any(|&(solved, _)| solved == row)
    }

    /// The momenta that stay and that rigid joints move or others are expressed by.
    pub fn survivors(&self, equations: &StateEquations) -> impl Iterator<Item = usize> + use<> {
        let images: Vec<Id> = self.images.values().copied().collect();
        let is_momentum = |state: &usize| equations.states[*state].origin.kind() == Kind::Momentum;
        let named = equations.pool.symbols(&images).into_iter().filter_map(Symbol::as_state).filter(is_momentum);
        let loaded = self.loads.iter().flatten().flat_map(BTreeMap::keys).copied();
        let all: BTreeSet<usize> = named.chain(loaded).filter(|state| !self.images.contains_key(state)).collect();
        all.into_iter()
    }

    /// Expressions over the states that stay.
    pub fn applied(&self, pool: &mut Pool, ids: &[Id]) -> Vec<Id> {
        applied(pool, ids, &self.images)
    }

    /// The same, written shorter.
    pub fn shortened(&self, pool: &mut Pool, ids: &[Id]) -> Vec<Id> {
        let applied = self.applied(pool, ids);
        self.circles.shortened(pool, &applied)
    }

    pub(super) fn add(&mut self, equations: &mut StateEquations, row: usize, images: Images) {
        let (states, before): (Vec<usize>, Vec<Id>) = self.images.iter().map(|(&state, &id)| (state, id)).unzip();
        let after = applied(&mut equations.pool, &before, &images);
        self.images = states.into_iter().zip(after).collect();
        for &state in images.keys() {
            self.fates.insert(state, Fate::Joined(equations.reactions[row].slip.joint.clone()));
        }
        self.images.extend(images);
    }

    /// The flow and the gap of a row, with the coefficient of every momentum; none where the flow is not linear in
    /// these alone.
    pub(super) fn row(&self, equations: &mut StateEquations, row: usize) -> Option<Row> {
        self.loads[row].as_ref()?;
        let slip = &equations.reactions[row].slip;
        let before = [slip.flow, slip.gap?];
        let pool = &mut equations.pool;
        let [flow, gap] = self.applied(pool, &before)[..] else { return None };
        let symbols = pool.symbols(&[flow, gap]);
        if !symbols.iter().all(|symbol| matches!(symbol, Symbol::State(_) | Symbol::Parameter(_) | Symbol::Unsolved(_)))
        {
            return None;
        }
        let is_momentum = |symbol: Symbol| symbol.as_state().filter(|state| self.velocities.contains_key(state));
        let momenta: Vec<usize> = pool.symbols(&[flow]).into_iter().filter_map(is_momentum).collect();
        let slopes = momenta.iter().map(|&state| (state, partial(pool, &[flow], Symbol::state(state))[0]));
        let slopes: BTreeMap<usize, Id> = slopes.collect();
        let of_slopes: Vec<Id> = slopes.values().copied().collect();
        let is_linear = !pool.symbols(&of_slopes).into_iter().any(|symbol| is_momentum(symbol).is_some());
        let zero = pool.zero();
        let at_rest = substitute(pool, &[flow], &|symbol| is_momentum(symbol).map(|_| zero))[0];
        (is_linear && same_polynomial(pool, at_rest, zero)).then_some(Row { flow, gap, slopes })
    }

    /// Whether the gap of a row is zero at the start, or is closed by guesses. An open one is for the run time to
    /// refuse.
    pub(super) fn is_closed(equations: &mut StateEquations, row: usize) -> bool {
        let StateEquations { pool, states, reactions, .. } = equations;
        let gap = reactions[row].slip.gap.unwrap_or(pool.zero());
        let at_start = substitute(pool, &[gap], &|symbol| symbol.as_state().map(|state| states[state].start))[0];
        let is_guessed = pool.symbols(&[at_start]).into_iter().any(|symbol| matches!(symbol, Symbol::Unknown(_)));
        is_guessed || vanishes(pool, at_start)
    }

    /// A row solved for the momentum of a body, with its position.
    fn translation(&self, equations: &mut StateEquations, number: usize) -> Option<(usize, Images)> {
        let row = self.row(equations, number).filter(|_| Self::is_closed(equations, number))?;
        let positions: Vec<usize> = of_kind(equations, Kind::Position).collect();
        for (&momentum, &slope) in &row.slopes {
            let StateEquations { pool, states, .. } = &mut *equations;
            let mass = partial(pool, &[self.velocities[&momentum]], Symbol::state(momentum))[0];
            let ratio = pool.div(slope, mass);
            if pool.as_number(ratio).is_none_or(|ratio| ratio == 0.0) {
                continue;
            }
            let moves = |&&state: &&usize| {
                let of: Vec<usize> =
                    pool.symbols(&[states[state].rate]).into_iter().filter_map(Symbol::as_state).collect();
                of == [momentum] && !self.images.contains_key(&state)
            };
            let Some(&position) = positions.iter().find(moves) else { continue };
            let by = partial(pool, &[row.gap], Symbol::state(position))[0];
            if pool.as_number(by).is_some_and(|by| by != 0.0) {
                let momentum_image = solved(pool, row.flow, momentum, slope);
                let position_image = solved(pool, row.gap, position, by);
                return Some((momentum, Images::from([(momentum, momentum_image), (position, position_image)])));
            }
        }
        None
    }

    /// A row by which two bodies turn alike, solved for the angular momentum of one of them, with its orientation.
    fn rotation(&self, equations: &mut StateEquations, number: usize) -> Option<(usize, Images)> {
        let row = self.row(equations, number)?;
        let [(first, by_first), (second, by_second)] = row.slopes.into_iter().collect::<Vec<_>>()[..] else {
            return None;
        };
        let pool = &mut equations.pool;
        let ratio = pool.div(by_first, by_second);
        let ratio = pool.as_number(ratio).filter(|&ratio| ratio != 0.0)?;
        let leading = pool.symbol(Symbol::state(first));
        let image = pool.scale(-ratio, leading);
        let mut images = Images::from([(second, image)]);
        self.turned_alike(equations, second, &mut images);
        let (load, zero) = (*self.loads[number].as_ref()?.get(&second)?, equations.pool.zero());
        let load = self.applied(&mut equations.pool, &[load]);
        let after = applied(&mut equations.pool, &[row.flow, row.gap, load[0]], &images);
        let closes = after[..2].iter().all(|&id| same_polynomial(&mut equations.pool, id, zero));
        (closes && self.is_constant(equations, &images, after[2])).then_some((second, images))
    }

    /// The orientations that turn with a momentum and are, with these images, those of another track.
    fn turned_alike(&self, equations: &mut StateEquations, momentum: usize, images: &mut Images) {
        let turned: BTreeMap<usize, Vec<usize>> = tracks(equations, &self.images);
        let turns = |states: &[usize]| {
            let rates: Vec<Id> = states.iter().map(|&state| equations.states[state].rate).collect();
            equations.pool.symbols(&rates).contains(&Symbol::state(momentum))
        };
        let turning: Vec<Vec<usize>> = turned.values().filter(|states| turns(states)).cloned().collect();
        for own in turning {
            for other in turned.values().filter(|&other| *other != own) {
                if let Some(alike) = self.alike(equations, images, &own, other) {
                    *images = alike;
                    break;
                }
            }
        }
    }

    /// The images with the states of one track as those of another, where they start as these and have their rates
    /// then.
    fn alike(&self, equations: &mut StateEquations, images: &Images, own: &[usize], other: &[usize]) -> Option<Images> {
        let StateEquations { pool, states, .. } = equations;
        let place = |state: usize| match states[state].origin {
            Origin::Orientation(_, row, column) => (row, column),
            _ => (0, 0),
        };
        let start_alike = |(&a, &b): (&usize, &usize)| place(a) == place(b) && states[a].start == states[b].start;
        if own.len() != other.len() || !own.iter().zip(other).all(start_alike) {
            return None;
        }
        let mut alike = images.clone();
        for (&a, &b) in own.iter().zip(other) {
            alike.insert(a, pool.symbol(Symbol::state(b)));
        }
        let rates: Vec<Id> = own.iter().chain(other).map(|&state| states[state].rate).collect();
        let rates = self.applied(pool, &rates);
        let rates = applied(pool, &rates, &alike);
        let (a, b) = rates.split_at(own.len());
        a.iter().zip(b).all(|(&a, &b)| same_polynomial(pool, a, b)).then_some(alike)
    }

    /// Whether an expression keeps its value at the start, which is a number that is not zero.
    fn is_constant(&self, equations: &mut StateEquations, images: &Images, id: Id) -> bool {
        let StateEquations { pool, states, .. } = equations;
        let of: Vec<usize> = pool.symbols(&[id]).into_iter().filter_map(Symbol::as_state).collect();
        let rates: Vec<Id> = of.iter().map(|&state| states[state].rate).collect();
        let rates = self.applied(pool, &rates);
        let rates = applied(pool, &rates, images);
        let seeds: BTreeMap<Symbol, Id> = of.iter().map(|&state| Symbol::state(state)).zip(rates).collect();
        let (change, zero) = (derivative(pool, &[id], &seeds)[0], pool.zero());
        let start = substitute(pool, &[id], &|symbol| symbol.as_state().map(|state| states[state].start))[0];
        same_polynomial(pool, change, zero) && value(pool, start).is_some_and(|start| start.abs() > ROUNDING)
    }
}

/// A row over the states that stay.
pub(super) struct Row {
    pub flow: Id,
    pub gap: Id,
    pub slopes: BTreeMap<usize, Id>,
}

/// The state in which an expression that is linear in it, with this slope, is zero.
fn solved(pool: &mut Pool, of: Id, state: usize, slope: Id) -> Id {
    let zero = pool.zero();
    let rest = reaction::with(pool, of, Symbol::state(state), zero);
    let rest = pool.neg(rest);
    pool.div(rest, slope)
}

pub(super) fn applied(pool: &mut Pool, ids: &[Id], images: &Images) -> Vec<Id> {
    substitute(pool, ids, &|symbol| symbol.as_state().and_then(|state| images.get(&state).copied()))
}

/// The states of each orientation that is still there.
fn tracks(equations: &StateEquations, gone: &Images) -> BTreeMap<usize, Vec<usize>> {
    let mut tracks: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (state, definition) in equations.states.iter().enumerate() {
        if let Origin::Orientation(track, ..) = definition.origin
            && !gone.contains_key(&state)
        {
            tracks.entry(track).or_default().push(state);
        }
    }
    tracks
}

/// The derivatives of the energy by the momenta; none where they are not linear in these.
fn velocities(equations: &mut StateEquations, momenta: &[usize]) -> Option<BTreeMap<usize, Id>> {
    let StateEquations { pool, balance: Balance { stored, .. }, .. } = equations;
    let symbols: Vec<Symbol> = momenta.iter().map(|&state| Symbol::state(state)).collect();
    let mut velocities = BTreeMap::new();
    for (&state, &symbol) in momenta.iter().zip(&symbols) {
        velocities.insert(state, partial(pool, &[*stored], symbol)[0]);
    }
    let all: Vec<Id> = velocities.values().copied().collect();
    for &symbol in &symbols {
        let slopes = partial(pool, &all, symbol);
        if pool.symbols(&slopes).into_iter().any(|symbol| symbols.contains(&symbol)) {
            return None;
        }
    }
    Some(velocities)
}

/// How the reaction of a row changes the momenta; none where it acts on other states or other reactions, or not
/// linearly.
fn loads(equations: &mut StateEquations, row: usize, momenta: &[usize]) -> Option<BTreeMap<usize, Id>> {
    let multiplier = equations.reactions[row].multiplier;
    let is_other = |kind: Kind| !matches!(kind, Kind::Momentum | Kind::Integral);
    let others = equations.states.iter().filter(|state| is_other(state.origin.kind())).map(|state| state.rate);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let switched = equations.reactions.iter().filter_map(|reaction| reaction.switched.as_ref());
    let efforts = switched.flat_map(|switched| [switched.effort, switched.acts]);
    let slips = equations.reactions.iter().map(|reaction| &reaction.slip);
    let slips = slips.flat_map(|slip| [slip.flow].into_iter().chain(slip.gap));
    let iterations = equations.iterations.iter().flat_map(|iteration| iteration.residuals.iter().copied());
    let all: Vec<Id> = others.chain(guards).chain(efforts).chain(slips).chain(iterations).collect();
    if equations.pool.symbols(&all).contains(&multiplier) {
        return None;
    }
    let rates: Vec<Id> = momenta.iter().map(|&state| equations.states[state].rate).collect();
    let pool = &mut equations.pool;
    let by = partial(pool, &rates, multiplier);
    let is_reaction = |symbol: &Symbol| matches!(symbol, Symbol::Multiplier(_));
    let is_linear = !pool.symbols(&by).iter().any(is_reaction);
    let loads = momenta.iter().copied().zip(by).filter(|&(_, by)| !pool.is_zero(by));
    is_linear.then(|| loads.collect())
}
