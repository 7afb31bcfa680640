//! Bodies in joint coordinates.
//!
//! In: equations with bodies of eighteen states each and rigid joints, among them such as form trees on the ground
//! (`joints` has their kinds). Out: the same with an angle or a travel and its speed for each freedom of these; poses
//! and momenta of bodies are expressions of these. Method: with the motion of a joint in place of that of a body its
//! gaps and flows are zero identically (`recognition`), so no motion is lost; its reactions work on none of these
//! motions, so they occur in none of the rates. These are found from tip to ground and back (`recursion`). What else is
//! held, by joints that close loops, stops and dry friction, keeps its reactions, which are loads to the tree.

mod balls;
mod bodies;
mod close;
mod closed;
mod coordinates;
mod guessed;
mod independent;
mod joints;
mod links;
mod loads;
mod locking;
mod loops;
mod motion;
mod numbers;
mod reach;
mod reactions;
mod recognition;
mod recursion;
mod relative;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::report::{Fate, Report, show};
use super::speeds::of_kind;
use super::{Operations, closing, friction, is_constant, turned};
use crate::expr::{Environment, Id, Node, Pool, Symbol, evaluate, exchange, partial, substitute};
use crate::system::Value;
use crate::system::equations::impact::Unlocked;
use crate::system::equations::{Kind, Origin, Reaction, State, StateEquations};
use crate::system::inverse::InverseDynamics;
use crate::system::link::{Freedom, Link, Moved, Moves};
use bodies::{Body, velocity};
use closed::{Closed, Dependent};
use coordinates::Coordinates;
use guessed::Guessed;
use joints::Joint;
use loads::{Loads, Tree};
use locking::Hold;
use motion::Motion;
use reactions::Wanted;
use recursion::{Accelerations, Ground};
use relative::Coordinated;

/// Whether there is anything to look at: rows of rigid joints.
pub(super) fn may_apply(equations: &StateEquations) -> bool {
    equations.baumgarte.is_none() && friction::rigid(&equations.reactions) > 0
}

/// How many speeds of joints are states.
pub(super) fn speeds(equations: &StateEquations) -> usize {
    equations.states.iter().filter(|state| matches!(state.origin, Origin::Speed(..))).count()
}

/// Whether it has been done.
pub(super) fn is_put(equations: &StateEquations) -> bool {
    speeds(equations) > 0
}

/// Which trees are taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Which {
    /// Those that do not lie flat in the x-y plane, where bodies' own momenta take fewer operations.
    NotFlat,
    /// All.
    All,
}

/// What becomes of loops.
#[derive(Clone, Copy, Debug)]
pub(super) enum Loops<'a> {
    /// Joints that close them keep their rows.
    Held,
    /// They are closed in closed form where that is proved, or where these orientations are said to be given by them.
    Closed(&'a [String]),
}

/// Takes the bodies of trees of joints out of the equations; none where there are none, no loop is closed that is to
/// be, or something does not fit.
pub(super) fn put(
    equations: &mut StateEquations,
    report: &mut Report,
    (which, loops): (Which, Loops<'_>),
    operations: &mut Operations<'_>,
) -> Option<()> {
    equations.rewrite(&|pool, ids| numbers::folded(pool, ids));
    let bodies = bodies::of(equations);
    if matches!(loops, Loops::Closed(_)) && !has_loops(equations, &bodies) {
        return None;
    }
    let parameters: Vec<f64> = equations.parameters.iter().map(|parameter| parameter.default).collect();
    let guessed = Guessed::of(equations, &bodies, &parameters);
    let mut literal = Literal::of(equations);
    let spins = places_of_spins(&mut equations.pool, &bodies);
    equations.rewrite(&|pool, ids| exchange(pool, ids, &spins));
    let joints = joints(equations, &bodies, (&parameters, &guessed), which)?;
    let start = Environment { states: &guessed.start, parameters: &parameters, ..Environment::default() };
    let joints = match loops {
        Loops::Held => joints,
        Loops::Closed(_) => balls::by_angles(equations, &bodies, joints, (&start, &guessed)),
    };
    let of_bodies: BTreeSet<usize> = joints.iter().flat_map(|joint| bodies[joint.child].states()).collect();
    let given: BTreeSet<usize> = joints.iter().flat_map(|joint| joint.given(&bodies)).collect();
    let wanted = release(equations, (&bodies, &joints), &of_bodies, &start)?;
    let first = 6 * bodies.len() + joints::PROBES;
    let mut coordinates = motion::coordinates(&mut equations.pool, first, &joints);
    let next = first + 2 * coordinates.iter().map(Vec::len).sum::<usize>();
    let apart = match loops {
        Loops::Held => None,
        Loops::Closed(asked) => {
            let is_any = friction::rigid(&equations.reactions) > 0 && wanted.is_empty();
            Some((Coordinates::apart(&mut equations.pool, next, &joints, &mut coordinates).filter(|_| is_any)?, asked))
        }
    };
    let coordinated = Coordinated { bodies: &bodies, joints: &joints, coordinates: &coordinates };
    let working = match loops {
        Loops::Held => BTreeSet::new(),
        Loops::Closed(_) => recognition::working(equations, &bodies, (&start, &guessed)),
    };
    loops::turn(equations, &mut literal, coordinated);
    literal.keep_mobilities(equations);
    relative::recognise(equations, coordinated);
    let (links, seats) = links::of(&mut equations.pool, &bodies, &joints);
    let tree = Tree { bodies: &bodies, joints: &joints, links: &links, seats: &seats };
    let Loads { mut moved, axes, ground } = Loads::of(equations, &tree, &coordinates);
    let motion = Motion::of(&mut equations.pool, &links, &seats, &moved, axes);
    let mut images = motion.images(&mut equations.pool, &bodies, &seats, &given);
    let mut starts: Vec<Vec<[Id; 2]>> = joints.iter().map(|joint| motion::starts(equations, &bodies, joint)).collect();
    let closed = match &apart {
        Some((coordinates, asked)) => {
            let moving = close::Moving { tree: &tree, coordinates, working: &working, images: &images };
            let (closed, gone) = close::loops(equations, moving, &starts.concat(), asked)?;
            let states = joints.iter().flat_map(|joint| joint.given(&bodies)).collect();
            forget(equations, &mut moved, &gone.into_iter().collect(), &states)?;
            Some((closed, coordinates))
        }
        None => None,
    };
    let before = moved.clone();
    let holds = locking::lock(equations, &mut moved, &images);
    let (found, released) = match &closed {
        Some((closed, coordinates)) => {
            let of = (&moved[..], &motion.spins[..]);
            let rates = independent::rates(&mut equations.pool, &links, of, &ground, (closed, coordinates));
            let multipliers = multipliers(&equations.reactions);
            let found = Accelerations { rates, links: Vec::new(), needed: Vec::new() };
            (linear(&mut equations.pool, &links, found, &multipliers), None)
        }
        None => {
            let when = when(equations, &links, (&moved, &motion.spins), &ground, operations);
            let found = recursion::accelerations(&mut equations.pool, &links, (&moved, &motion.spins), (&ground, when));
            let multipliers = multipliers(&equations.reactions);
            let found = linear(&mut equations.pool, &links, found, &multipliers);
            (found, released(equations, &tree, (&before, &motion), (&ground, when), &holds))
        }
    };
    for (_, of_one) in joints.iter().zip(&mut starts).filter(|(joint, _)| joint.is_sought) {
        of_one.iter_mut().for_each(|[_, speed]| *speed = guessed::sought(equations, *speed));
    }
    motion.energies(equations, &bodies, &seats);
    for (state, rate) in motion.rates(&mut equations.pool, &tree, (&motion.spins, &found), &ground) {
        equations.states[state].rate = rate;
    }
    let mut reactions = wanted.images(&mut equations.pool, &tree, (&moved, &motion, &found), &coordinates)?;
    reactions.extend(locking::images(&mut equations.pool, &holds, &moved, &found.needed));
    for (index, body) in bodies.iter().enumerate() {
        for (k, &spin) in body.spin.iter().enumerate() {
            // Of a body on no such joint, which keeps its states.
            images.entry(velocity(index, 3 + k)).or_insert(spin);
        }
    }
    let mut kept = vec![true; equations.states.len()];
    for joint in &joints {
        for state in joint.given(&bodies) {
            kept[state] = false;
            let image = images.get(&Symbol::state(state)).copied().filter(|&id| is_constant(&equations.pool, id));
            let constant = image.map(|id| Fate::Constant(show(equations, id)));
            report.say(state, constant.unwrap_or_else(|| Fate::Joined(joint.name.clone())));
        }
    }
    for (state, turn, (name, place)) in counted(equations, &joints, &coordinates) {
        kept[state] = false;
        report.say(state, Fate::Equal(name));
        images.extend([(Symbol::state(state), place), (turn, equations.pool.zero())]);
    }
    equations.inverse = match &closed {
        Some(_) => None,
        None => inverse(equations, &tree, (&moved, &motion, &found), (&ground, next)),
    };
    let mut integrated = become_states(equations, &tree, (&moved, &found.rates), &starts, report)?;
    if let Some((closed, coordinates)) = &closed {
        let read = read(equations, (&reactions, &images), &integrated);
        drop_dependent((closed, coordinates), &read, &mut integrated, report);
    }
    let mut places: BTreeMap<Symbol, Id> = BTreeMap::new();
    for (&coordinate, &state) in &integrated {
        kept[state] = true;
        places.insert(coordinate, equations.pool.symbol(Symbol::state(state)));
    }
    if let Some((closed, coordinates)) = &closed {
        closed.put_roots(equations);
        let links = tree.links.iter().enumerate().filter(|(link, _)| closed.gives(*link));
        let tracks = links.map(|(_, link)| equations.states[bodies[joints[link.step.0].child].axes[0]].origin);
        let names = tracks.filter_map(|origin| match origin {
            Origin::Orientation(track, ..) => Some(equations.tracks[track].clone()),
            _ => None,
        });
        report.closed = names.collect();
        places = closed.settled(&mut equations.pool, coordinates, &places);
    }
    equations.projections.retain(|(state, _)| kept[*state] && !given.contains(state));
    let unlocked = released.map(|rates| rates.of_states(equations, &moved, &integrated, &holds));
    equations.replace(&|symbol| reactions.get(&symbol).copied());
    equations.unlocked = unlocked;
    equations.replace(&|symbol| images.get(&symbol).copied());
    equations.replace(&|symbol| places.get(&symbol).copied());
    super::live::keep_states(equations, report, &kept);
    Some(())
}

/// Whether rigid joints are more than the bodies that they hold.
fn has_loops(equations: &StateEquations, bodies: &[Body]) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    let joints = closing::of_joints(reactions, 0..friction::rigid(reactions)).len();
    let is_held = |body: &&Body| {
        let rates: Vec<Id> = body.states().map(|state| states[state].rate).collect();
        pool.symbols(&rates).iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)))
    };
    joints > bodies.iter().filter(is_held).count()
}

/// Takes reactions of loops that are closed out of the equations; none where something else than the momenta of these
/// bodies reads one.
fn forget(
    equations: &mut StateEquations,
    moved: &mut [Moved],
    gone: &BTreeSet<Symbol>,
    bodies: &BTreeSet<usize>,
) -> Option<()> {
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    if has_any(&equations.pool, &outputs, gone) || is_read(equations, gone, bodies) {
        return None;
    }
    let StateEquations { pool, shown, reactions, .. } = equations;
    shown.forget(pool, gone);
    reactions.retain(|reaction| !gone.contains(&reaction.multiplier));
    let zero = pool.zero();
    let mut without = |ids: &[Id]| substitute(pool, ids, &|symbol| gone.contains(&symbol).then_some(zero));
    for own in moved {
        own.effort = without(&[own.effort])[0];
        for part in &mut own.load {
            *part = Value(without(&part.0));
        }
    }
    Some(())
}

/// The symbols that anything reads, but the rates of places.
fn read(
    equations: &mut StateEquations,
    (reactions, images): (&BTreeMap<Symbol, Id>, &BTreeMap<Symbol, Id>),
    integrated: &BTreeMap<Symbol, usize>,
) -> BTreeSet<Symbol> {
    let all = RefCell::new(BTreeSet::new());
    let mut changed = equations.clone();
    changed.replace(&|symbol| reactions.get(&symbol).copied());
    changed.replace(&|symbol| images.get(&symbol).copied());
    let of_states: BTreeSet<usize> = integrated.values().copied().collect();
    for (index, state) in changed.states.iter_mut().enumerate() {
        let is_place = matches!(state.origin, Origin::Hinge(..)) && of_states.contains(&index);
        if is_place {
            state.rate = changed.pool.zero();
        }
    }
    changed.rewrite(&|pool, ids| {
        all.borrow_mut().extend(pool.symbols(ids));
        ids.to_vec()
    });
    all.into_inner()
}

/// Takes what loops give out of the coordinates that are integrated: but angles that something reads, whose turns have
/// to be counted.
fn drop_dependent(
    (closed, coordinates): (&Closed, &Coordinates),
    read: &BTreeSet<Symbol>,
    integrated: &mut BTreeMap<Symbol, usize>,
    report: &mut Report,
) {
    for Dependent { link, joint, .. } in &closed.dependents {
        let own = coordinates.of(*link);
        let is_counted = own.angle.is_some() && read.contains(&own.place);
        for symbol in [own.speed].into_iter().chain((!is_counted).then_some(own.place)) {
            if let Some(state) = integrated.remove(&symbol) {
                report.say(state, Fate::Closed(joint.clone()));
            }
        }
    }
}

/// So many links are few enough to find by operations when weights are counted.
const FEW: usize = 24;

/// When the ground's acceleration is counted, so that the rates of the speeds take fewer operations.
fn when(
    equations: &StateEquations,
    links: &[Link],
    motion: (&[Moved], &[Value]),
    ground: &Value,
    operations: &mut Operations<'_>,
) -> Ground {
    let falls = ground.0.iter().any(|&part| !equations.pool.is_zero(part));
    let is_open = links.iter().any(|link| link.parent.is_none() && link.freedom != Freedom::Free);
    if !falls || !is_open || links.len() > FEW {
        return Ground::First;
    }
    let mut cost = |when: Ground| {
        let mut alone = equations.clone();
        let zero = alone.pool.zero();
        let found = recursion::accelerations(&mut alone.pool, links, motion, (ground, when));
        let multipliers = multipliers(&alone.reactions);
        let found = linear(&mut alone.pool, links, found, &multipliers);
        let rates = found.rates.into_iter().chain(std::iter::repeat(zero));
        alone.states.iter_mut().zip(rates).for_each(|(state, rate)| state.rate = rate);
        operations(&mut alone)
    };
    if cost(Ground::Last) < cost(Ground::First) { Ground::Last } else { Ground::First }
}

/// The rates with no joint locked.
struct Released {
    /// Those of the speeds of the links.
    speeds: Vec<Id>,
    /// Those of the momenta that bodies keep, each with its state.
    momenta: Vec<(usize, Id)>,
}

/// The rates with no joint locked, as impacts find it, with the reactions that hold joints as symbols; none where no
/// stop does.
fn released(
    equations: &mut StateEquations,
    tree: &Tree<'_>,
    (moved, motion): (&[Moved], &Motion),
    (ground, when): (&Value, Ground),
    holds: &[Hold],
) -> Option<Released> {
    let multipliers = multipliers(equations.reactions.iter().chain(stops(holds)));
    if multipliers.len() == equations.reactions.len() {
        return None;
    }
    let pool = &mut equations.pool;
    let found = recursion::accelerations(pool, tree.links, (moved, &motion.spins), (ground, when));
    let found = linear(pool, tree.links, found, &multipliers);
    let momenta = motion.rates(pool, tree, (&motion.spins, &found), ground);
    Some(Released { speeds: found.rates, momenta })
}

impl Released {
    /// With what else these stops change, once speeds are states.
    fn of_states(
        self,
        equations: &StateEquations,
        moved: &[Moved],
        integrated: &BTreeMap<Symbol, usize>,
        holds: &[Hold],
    ) -> Unlocked {
        let StateEquations { pool, states, .. } = equations;
        let stops: Vec<Reaction> = stops(holds).cloned().collect();
        let read: BTreeSet<Symbol> = multipliers(&stops).into_iter().collect();
        let rates = states.iter().map(|state| state.rate).enumerate();
        let mut rates: BTreeMap<usize, Id> = rates.filter(|&(_, rate)| has_any(pool, &[rate], &read)).collect();
        rates.extend(self.momenta);
        for (own, rate) in moved.iter().zip(self.speeds) {
            if let Node::Symbol(speed) = *pool.node(own.moves.speed)
                && let Some(&state) = integrated.get(&speed)
            {
                rates.insert(state, rate);
            }
        }
        Unlocked { stops, rates: rates.into_iter().collect() }
    }
}

/// The stops among what holds joints.
fn stops(holds: &[Hold]) -> impl Iterator<Item = &Reaction> {
    holds.iter().map(|hold| &hold.reaction).filter(|reaction| reaction.rebound.is_some())
}

/// The symbols of these reactions.
fn multipliers<'a>(of: impl IntoIterator<Item = &'a Reaction>) -> Vec<Symbol> {
    of.into_iter().map(|reaction| reaction.multiplier).collect()
}

/// What the accelerations of the links take, where that is known here; from this number on symbols are free.
fn inverse(
    equations: &mut StateEquations,
    tree: &Tree<'_>,
    (moved, motion, found): (&[Moved], &Motion, &Accelerations),
    (ground, next): (&Value, usize),
) -> Option<InverseDynamics> {
    if !InverseDynamics::covers(tree.links) {
        return None;
    }
    // With reactions the rates are sums over these, and so are accelerations by the rates.
    let are_alone = equations.reactions.is_empty();
    let mut inverse = InverseDynamics {
        links: tree.links.to_vec(),
        moved: moved.to_vec(),
        spins: motion.spins.clone(),
        ground: ground.clone(),
        rates: found.rates.clone(),
        accelerations: tree
            .links
            .iter()
            .zip(&found.links)
            .map(|(link, own)| (are_alone || !link.freedom.has_coordinate()).then(|| own.clone()))
            .collect(),
        unknowns: InverseDynamics::numbered(tree.links, next),
        written: Vec::new(),
    };
    let (mut spins, mut by_unknowns) =
        (motion.spins.clone(), Accelerations { rates: Vec::new(), links: found.links.clone(), needed: Vec::new() });
    for link in (0..tree.links.len()).filter(|&link| !tree.links[link].freedom.has_coordinate()) {
        let mut vector = |first: usize| {
            Value((first..first + 3).map(|k| equations.pool.symbol(inverse.symbol((link, k)))).collect())
        };
        spins[link] = vector(0);
        by_unknowns.links[link] = [vector(3), vector(6)];
    }
    let rates = motion.rates(&mut equations.pool, tree, (&spins, &by_unknowns), ground);
    inverse.written = rates.into_iter().map(|(state, written)| [equations.states[state].rate, written]).collect();
    Some(inverse)
}

/// Puts the place and the speed of each step into states of its body; the symbol of each of these coordinates, with its
/// state.
fn become_states(
    equations: &mut StateEquations,
    tree: &Tree<'_>,
    (moved, rates): (&[Moved], &[Id]),
    starts: &[Vec<[Id; 2]>],
    report: &mut Report,
) -> Option<BTreeMap<Symbol, usize>> {
    let mut places = BTreeMap::new();
    for (link, (own, &rate)) in tree.links.iter().zip(moved.iter().zip(rates)) {
        let (number, step) = link.step;
        let joint = &tree.joints[number];
        let body = &tree.bodies[joint.child];
        let units = match link.freedom {
            Freedom::Turn => ["rad", "rad/s"],
            Freedom::Slide => ["m", "m/s"],
            Freedom::Ball | Freedom::Free => continue,
        };
        let Origin::Orientation(track, ..) = equations.states[body.axes[0]].origin else { return None };
        let origins = [Origin::Hinge(track, step), Origin::Speed(track, step)];
        let slots = [body.place[step], body.linear[step]];
        let coordinates = [own.moves.place, own.moves.speed];
        let rates = [own.moves.speed, rate];
        for (side, name) in names(joint, step).into_iter().enumerate() {
            let (unit, start) = (units[side].to_owned(), starts[number][step][side]);
            let new = State { name, unit, origin: origins[side], start, rate: rates[side] };
            report.rename(slots[side], new.clone());
            report.say(slots[side], Fate::Integrated);
            equations.states[slots[side]] = new;
            let Node::Symbol(symbol) = *equations.pool.node(coordinates[side]) else { return None };
            places.insert(symbol, slots[side]);
        }
    }
    Some(places)
}

/// The accelerations, and what holds locked links, as sums over the reactions that are left, so that the matrix of
/// these has parts of the rates; those of links with a coordinate, whose accelerations nothing reads, as they are.
fn linear(pool: &mut Pool, links: &[Link], of: Accelerations, multipliers: &[Symbol]) -> Accelerations {
    let zero = pool.zero();
    let mut written = |ids: &[Id]| -> Vec<Id> {
        let alone = substitute(pool, ids, &|symbol| multipliers.contains(&symbol).then_some(zero));
        let mut sums: Vec<Vec<Id>> = alone.into_iter().map(|id| vec![id]).collect();
        for &multiplier in multipliers {
            let by = partial(pool, ids, multiplier);
            let symbol = pool.symbol(multiplier);
            for (sum, by) in sums.iter_mut().zip(by) {
                sum.push(pool.mul(by, symbol));
            }
        }
        sums.iter().map(|sum| pool.sum(sum)).collect()
    };
    let rates = written(&of.rates);
    let needed = of.needed.into_iter().map(|needed| needed.map(|needed| written(&[needed])[0])).collect();
    let accelerated = links
        .iter()
        .zip(of.links)
        .map(|(link, own)| if link.freedom.has_coordinate() { own } else { own.map(|part| Value(written(&part.0))) });
    let links = accelerated.collect();
    Accelerations { rates, links, needed }
}

/// The states that count the turns of a joint's angle and are its coordinate, which starts as they do and has their
/// rate: each with the symbol of the small angle that is left of it, zero then, and the coordinate.
fn counted(
    equations: &StateEquations,
    joints: &[Joint],
    coordinates: &[Vec<Moves>],
) -> Vec<(usize, Symbol, (String, Id))> {
    let turns: BTreeMap<usize, usize> = turned::turns(equations).into_iter().collect();
    let of_joint = |(joint, moves): (&Joint, &Vec<Moves>)| {
        let (state, moves) = (joint.angle?, moves.last()?);
        let is_it = equations.states[state].rate == moves.speed;
        let [name, _] = names(joint, joint.steps().len() - 1);
        is_it.then(|| (state, Symbol::numbered(Symbol::Turned, turns[&state]), (name, moves.place)))
    };
    joints.iter().zip(coordinates).filter_map(of_joint).collect()
}

/// The names of a step's place and speed: with a number where a joint has several.
fn names(joint: &Joint, step: usize) -> [String; 2] {
    let number = if joint.steps().len() > 1 { (step + 1).to_string() } else { String::new() };
    ["q", "u"].map(|letter| format!("{}.{letter}{number}", joint.name))
}

/// The joints of trees on the ground, parents first.
fn joints(
    equations: &mut StateEquations,
    bodies: &[Body],
    (parameters, guessed): (&[f64], &Guessed),
    which: Which,
) -> Option<Vec<Joint>> {
    let starts = Environment { states: &guessed.start, parameters, ..Environment::default() };
    let joints = recognition::of(equations, bodies, &starts, guessed);
    (which == Which::All || !is_flat(&equations.pool, bodies, &joints)).then_some(joints)
}

/// Takes the reactions of joints out of the equations; they do not work on the motions of these bodies. Gives those
/// that outputs read. None where something else beside momenta reads one, or an output reads one of a loop that joints
/// share.
fn release(
    equations: &mut StateEquations,
    (of_tree, joints): (&[Body], &[Joint]),
    bodies: &BTreeSet<usize>,
    start: &Environment<'_>,
) -> Option<Wanted> {
    let rows: BTreeSet<usize> = joints.iter().flat_map(|joint| joint.rows.iter().copied()).collect();
    let rigid = friction::rigid(&equations.reactions);
    let multiplier = |row: usize| equations.reactions[row].multiplier;
    let gone: BTreeSet<Symbol> = rows.iter().map(|&row| multiplier(row)).collect();
    let closing: BTreeSet<Symbol> = (0..rigid).filter(|row| !rows.contains(row)).map(multiplier).collect();
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    let read: BTreeSet<Symbol> = equations.pool.symbols(&outputs).intersection(&gone).copied().collect();
    let is_asked = !read.is_empty() || has_any(&equations.pool, &outputs, &closing);
    let are_unique = closing.is_empty() || closing.len() == 1 && read.is_empty();
    let are_unique = are_unique || is_asked && are_independent(equations, of_tree, start);
    if is_asked && !are_unique || is_read(equations, &gone, bodies) {
        return None;
    }
    let shared = if are_unique { BTreeSet::new() } else { closing };
    let wanted = Wanted::of(equations, (of_tree, joints), &read);
    let unknown: BTreeSet<Symbol> = gone.union(&shared).filter(|symbol| !wanted.has(symbol)).copied().collect();
    let StateEquations { pool, states, shown, .. } = equations;
    let zero = pool.zero();
    let rates: Vec<Id> = bodies.iter().map(|&state| states[state].rate).collect();
    let rates = substitute(pool, &rates, &|symbol| gone.contains(&symbol).then_some(zero));
    for (&state, rate) in bodies.iter().zip(rates) {
        states[state].rate = rate;
    }
    shown.forget(pool, &unknown);
    equations.reactions.retain(|reaction| !gone.contains(&reaction.multiplier));
    Some(wanted)
}

/// Whether all rows of rigid joints are independent at the start, so that each reaction is one number there and, but
/// for places of measure zero, anywhere.
fn are_independent(equations: &mut StateEquations, bodies: &[Body], start: &Environment<'_>) -> bool {
    let StateEquations { pool, reactions, .. } = equations;
    let flows: Vec<Id> = reactions[..friction::rigid(reactions)].iter().map(|reaction| reaction.slip.flow).collect();
    if pool.has_select(&flows) {
        return false;
    }
    let weights = vec![0.0; 6 * bodies.len()];
    let columns = bodies.iter().enumerate().flat_map(|(index, body)| {
        let linear = body.linear.into_iter().map(Symbol::state);
        linear.chain((3..6).map(move |k| velocity(index, k)))
    });
    let columns: Vec<Vec<f64>> = columns
        .map(|symbol| {
            let slopes = partial(pool, &flows, symbol);
            evaluate(pool, &slopes, &Environment { weights: &weights, ..*start })
        })
        .collect();
    let rows = (0..flows.len()).map(|row| columns.iter().map(|column| column[row]).collect());
    numbers::rank(rows.collect()) == flows.len()
}

/// The flows of all rows and the rates of all momenta as momenta determine them.
struct Literal {
    flows: BTreeMap<Symbol, Id>,
    rates: Vec<(usize, Id)>,
}

impl Literal {
    fn of(equations: &StateEquations) -> Self {
        let flows = equations.reactions.iter().map(|reaction| (reaction.multiplier, reaction.slip.flow)).collect();
        let rates = of_kind(equations, Kind::Momentum).map(|state| (state, equations.states[state].rate)).collect();
        Self { flows, rates }
    }

    /// Gives the rows that are left their mobilities by all momenta, where joints close loops.
    fn keep_mobilities(&self, equations: &mut StateEquations) {
        if friction::rigid(&equations.reactions) == 0 {
            return;
        }
        let StateEquations { pool, reactions, .. } = equations;
        for reaction in reactions {
            let flow = self.flows[&reaction.multiplier];
            let load = |&(state, rate): &(usize, Id)| (state, partial(pool, &[rate], reaction.multiplier)[0]);
            let loads: Vec<(usize, Id)> = self.rates.iter().map(load).collect();
            reaction.slip.mobility = Some(closing::mobility(pool, flow, &loads));
        }
    }
}

/// A symbol in the place of each angular velocity.
fn places_of_spins(pool: &mut Pool, bodies: &[Body]) -> BTreeMap<Id, Id> {
    let mut places = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        for (k, &spin) in body.spin.iter().enumerate() {
            let symbol = pool.symbol(velocity(index, 3 + k));
            // A scaled node is in other nodes as the node.
            let (node, factor) = match pool.node(spin) {
                Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => {
                    (terms[0].0, terms[0].1.value())
                }
                _ => (spin, 1.0),
            };
            places.insert(node, pool.scale(1.0 / factor, symbol));
        }
    }
    places
}

/// Whether all joints move in the x-y plane, with their points at the height of the bodies' centres and these bodies'
/// third axes principal ones.
fn is_flat(pool: &Pool, bodies: &[Body], joints: &[Joint]) -> bool {
    let zero = |id: Id| pool.as_number(id) == Some(0.0);
    joints.iter().all(|joint| {
        let third = |frame: &numbers::Matrix| numbers::column(frame, 2)[2].abs();
        let is_along = |freedom| match freedom {
            Freedom::Turn => joint.frames.iter().all(|frame| third(frame) == 1.0),
            Freedom::Slide => joint.frames.iter().all(|frame| third(frame) == 0.0),
            Freedom::Ball => false,
            Freedom::Free => true,
        };
        let [on_parent, on_child] = &joint.at;
        let is_level = zero(on_child.0[2]) && (joint.parent.is_none() || zero(on_parent.0[2]));
        let mobility = &bodies[joint.child].mobility;
        let is_principal = [2, 5, 6, 7].into_iter().all(|entry| zero(mobility.0[entry]));
        is_level && is_principal && joint.steps().iter().all(|step| is_along(step.freedom))
    })
}

/// Whether something beside the momenta of these bodies reads a reaction that goes.
fn is_read(equations: &StateEquations, gone: &BTreeSet<Symbol>, bodies: &BTreeSet<usize>) -> bool {
    let others = equations.states.iter().enumerate().filter(|(state, _)| !bodies.contains(state));
    let rates = others.map(|(_, state)| state.rate);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let powers = [equations.balance.supplied, equations.balance.dissipated, equations.balance.stored];
    let loops = equations.iterations.iter().flat_map(|iteration| iteration.residuals.iter().copied());
    let laws = equations.fallible.iter().map(|law| law.value);
    let all = rates.chain(guards).chain(powers).chain(loops).chain(laws);
    has_any(&equations.pool, &all.collect::<Vec<_>>(), gone)
}

/// Whether one of these symbols is read.
fn has_any(pool: &Pool, ids: &[Id], symbols: &BTreeSet<Symbol>) -> bool {
    !pool.symbols(ids).is_disjoint(symbols)
}

#[cfg(test)]
mod tests;
