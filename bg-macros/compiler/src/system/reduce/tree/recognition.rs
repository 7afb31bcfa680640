//! Which rows are those of joints with coordinates.
//!
//! In: equations over velocities, bodies, start values. Out: [`Joint`]s of trees that stand on the ground. Method: how
//! many directions of motion and of turning a joint holds says what it may be, the start where its axes may be, the gap
//! which points meet; all of it is a guess only. Proof: with the joint's motion every gap and every flow of it is zero
//! identically, the rows hold as many directions as they are, at any angle, the bodies start so, and the reactions do
//! work on nothing but the flows of their rows.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, velocity};
use super::guessed::Guessed;
use super::joints::{Joint, Kind, Probe, STEPS};
use super::numbers::{self, Matrix, UNIT, Vector};
use crate::expr::{Environment, Id, Pool, Symbol, evaluate, partial, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::{Slip, StateEquations};
use crate::system::link::{Freedom, Moves};
use crate::system::reduce::joined::Choice;
use crate::system::reduce::zero::vanishes;
use crate::system::reduce::{closing, friction, is_constant, turned};

/// The joints of trees on the ground, parents first; `starts` has the values of the states at the start, for guesses.
pub(super) fn of(
    equations: &mut StateEquations,
    bodies: &[Body],
    starts: &Environment<'_>,
    guessed: &Guessed,
) -> Vec<Joint> {
    let rigid = friction::rigid(&equations.reactions);
    let given = Given::new(equations, bodies, starts, guessed);
    let rows = closing::of_joints(&equations.reactions, 0..rigid);
    let mut left: Vec<Rows> = rows.into_iter().filter_map(|rows| Rows::of(equations, &given, rows)).collect();
    let mut tree: Vec<Joint> = Vec::new();
    loop {
        let has = |body: usize| tree.iter().any(|joint| joint.child == body);
        let next = left.iter().enumerate().find_map(|(place, rows)| match rows.ends[..] {
            [child] if !has(child) => Some((place, None, child)),
            [a, b] if has(a) && !has(b) => Some((place, Some(a), b)),
            [a, b] if has(b) && !has(a) => Some((place, Some(b), a)),
            _ => None,
        });
        if let Some((place, parent, child)) = next {
            tree.extend(joint(equations, bodies, &given, left.remove(place), (parent, child)));
            continue;
        }
        // A body without a joint to the tree is the base of those that its joints connect to it.
        let Some(base) = left.iter().find_map(|rows| rows.ends.first().copied().filter(|&body| !has(body))) else {
            let carries = |body: usize| tree.iter().any(|joint| joint.parent == Some(body));
            let is_needed: Vec<bool> =
                tree.iter().map(|joint| joint.kind != Kind::Floating || carries(joint.child)).collect();
            return tree
                .into_iter()
                .zip(is_needed)
                .filter_map(|(joint, is_needed)| is_needed.then_some(joint))
                .collect();
        };
        tree.push(Joint::floating(&mut equations.pool, base));
    }
}

/// The rows of a joint over velocities and poses of one body or two.
struct Rows {
    rows: Vec<usize>,
    flows: Vec<Id>,
    gaps: Vec<Id>,
    ends: Vec<usize>,
}

impl Rows {
    fn of(equations: &mut StateEquations, given: &Given<'_>, rows: Vec<usize>) -> Option<Self> {
        let slips: Vec<&Slip> = rows.iter().map(|&row| &equations.reactions[row].slip).collect();
        let flows: Vec<Id> = slips.iter().map(|slip| slip.flow).collect();
        let gaps: Vec<Id> = slips.iter().map(|slip| slip.gap).collect::<Option<_>>()?;
        let pool = &mut equations.pool;
        let flows = substitute(pool, &flows, &|symbol| given.by_velocities.get(&symbol).copied());
        let [flows, gaps] = [flows, gaps].map(|ids| numbers::folded(pool, &ids));
        let mut ends = BTreeSet::new();
        for symbol in pool.symbols(&[&flows[..], &gaps].concat()) {
            if !matches!(symbol, Symbol::Parameter(_)) {
                ends.insert(*given.owner.get(&symbol)?);
            }
        }
        Some(Self { rows, flows, gaps, ends: ends.into_iter().collect() })
    }
}

/// The multipliers of the rigid joints that are closed at the start and move so, and whose reactions work on nothing
/// but the flows of their rows.
pub(super) fn working(
    equations: &mut StateEquations,
    bodies: &[Body],
    (starts, guessed): (&Environment<'_>, &Guessed),
) -> BTreeSet<Symbol> {
    let given = Given::new(equations, bodies, starts, guessed);
    let mut working = BTreeSet::new();
    for rows in closing::of_joints(&equations.reactions, 0..friction::rigid(&equations.reactions)) {
        let Some(Rows { rows, flows, .. }) = Rows::of(equations, &given, rows) else { continue };
        let is_closed = rows.iter().all(|&row| Choice::is_closed(equations, row)) && moves_so(equations, &rows, &given);
        if is_closed && works_not(equations, &rows, (&flows, &given)) {
            working.extend(rows.iter().map(|&row| equations.reactions[row].multiplier));
        }
    }
    working
}

/// Where a ball of these rows is on a body, in its axes from its centre; none where they are none of a ball on it.
pub(super) fn ball(
    equations: &mut StateEquations,
    bodies: &[Body],
    rows: &[usize],
    body: usize,
    (starts, guessed): (&Environment<'_>, &Guessed),
) -> Option<Value> {
    let given = Given::new(equations, bodies, starts, guessed);
    let Rows { flows, gaps, ends, .. } = Rows::of(equations, &given, rows.to_vec())?;
    let other = ends.iter().copied().find(|&end| end != body);
    let pool = &mut equations.pool;
    let columns: Vec<Vec<Id>> = (0..3).map(|k| partial(pool, &flows, velocity(body, k))).collect();
    let along: Vec<Vec<Id>> = (0..rows.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect();
    let is_ball =
        ends.contains(&body) && matches!(ends.len(), 1 | 2) && Kind::of(rows.len(), 0) == Some(Kind::Spherical);
    let [_, at] =
        points(pool, [other.map(|other| &bodies[other]), Some(&bodies[body])], (&gaps, &along)).filter(|_| is_ball)?;
    Some(at)
}

/// What is known of all bodies.
struct Given<'a> {
    /// Whose states and velocities symbols are.
    owner: BTreeMap<Symbol, usize>,
    /// The velocity of each momentum.
    speeds: BTreeMap<usize, Symbol>,
    /// Momenta by velocities, where these are as long.
    by_velocities: BTreeMap<Symbol, Id>,
    /// Velocities by momenta.
    by_momenta: BTreeMap<Symbol, Id>,
    /// The states in whose rates each multiplier is.
    loaded: BTreeMap<Symbol, Vec<usize>>,
    /// The states that count turns, with sine and cosine.
    angles: Vec<(usize, [Id; 2])>,
    starts: &'a Environment<'a>,
    guessed: &'a Guessed,
}

impl<'a> Given<'a> {
    fn new(equations: &mut StateEquations, bodies: &[Body], starts: &'a Environment<'a>, guessed: &'a Guessed) -> Self {
        let angles = turned::angles(equations);
        let StateEquations { pool, states, .. } = equations;
        let (mut owner, mut speeds) = (BTreeMap::new(), BTreeMap::new());
        let (mut by_velocities, mut by_momenta) = (BTreeMap::new(), BTreeMap::new());
        for (index, body) in bodies.iter().enumerate() {
            owner.extend((0..6).map(|k| (velocity(index, k), index)));
            owner.extend(body.states().map(|state| (Symbol::state(state), index)));
            let momenta = body.linear.iter().chain(&body.angular);
            speeds.extend(momenta.enumerate().map(|(k, &state)| (state, velocity(index, k))));
            for k in 0..3 {
                let [speed, momentum] = [velocity(index, k), Symbol::state(body.linear[k])];
                let [by_speed, by_momentum] = [speed, momentum].map(|symbol| pool.symbol(symbol));
                by_velocities.insert(momentum, pool.mul(body.mass, by_speed));
                by_momenta.insert(speed, pool.div(by_momentum, body.mass));
                by_momenta.insert(velocity(index, k + 3), body.spin[k]);
            }
        }
        let mut loaded: BTreeMap<Symbol, Vec<usize>> = BTreeMap::new();
        for (index, state) in states.iter().enumerate() {
            let symbols = pool.symbols(&[state.rate]).into_iter();
            for multiplier in symbols.filter(|symbol| matches!(symbol, Symbol::Multiplier(_))) {
                loaded.entry(multiplier).or_default().push(index);
            }
        }
        Self { owner, speeds, by_velocities, by_momenta, loaded, angles, starts, guessed }
    }
}

/// The joint of these rows from one body, or the ground, to another one.
fn joint(
    equations: &mut StateEquations,
    bodies: &[Body],
    given: &Given<'_>,
    Rows { rows, flows, gaps, .. }: Rows,
    (parent, child): (Option<usize>, usize),
) -> Option<Joint> {
    let name = equations.reactions[rows[0]].slip.joint.clone();
    let pool = &mut equations.pool;
    let [of_velocity, of_spin] = [0, 3].map(|first| -> Vec<Vec<Id>> {
        (first..first + 3).map(|k| partial(pool, &flows, velocity(child, k))).collect()
    });
    let is_moved = |row: &usize| of_velocity.iter().any(|column| !pool.is_zero(column[*row]));
    let (translations, rotations): (Vec<usize>, Vec<usize>) = (0..rows.len()).partition(is_moved);
    let kind = Kind::of(translations.len(), rotations.len())?;
    let directions = |of: &[usize], by: &[Vec<Id>]| -> Vec<Vec<Id>> {
        of.iter().map(|&row| by.iter().map(|column| column[row]).collect()).collect()
    };
    let (along, about) = (directions(&translations, &of_velocity), directions(&rotations, &of_spin));
    let ends = [parent, Some(child)].map(|body| body.map(|body| &bodies[body]));
    let axes = match kind {
        Kind::Universal => crossing(pool, ends, gaps[rotations[0]], given)?,
        Kind::Revolute | Kind::Cylindrical => shared(pool, ends, &about, given)?,
        Kind::Prismatic => whole(pool, ends, &along, given)?,
        Kind::Fixed => whole(pool, ends, &[], given)?,
        Kind::Spherical | Kind::Angles | Kind::Floating => [UNIT; 2],
    };
    let of_translations: Vec<Id> = translations.iter().map(|&row| gaps[row]).collect();
    let at = points(pool, ends, (&of_translations, &along))?;
    let joint = Joint {
        name,
        rows,
        parent,
        child,
        kind,
        frames: axes,
        at,
        angle: None,
        is_sought: given.guessed.is_sought(child),
    };
    let joint = by_its_angle(pool, bodies, joint, &given.angles);
    let is_proved = holds(equations, bodies, &joint, (&flows, &gaps))
        && starts_so(equations, bodies, &joint, given)
        && works_not(equations, &joint.rows, (&flows, given));
    is_proved.then_some(joint)
}

/// The joint with the angle that is counted of it as its coordinate, where that takes quarter turns of its axes.
fn by_its_angle(pool: &mut Pool, bodies: &[Body], joint: Joint, angles: &[(usize, [Id; 2])]) -> Joint {
    if !matches!(joint.kind, Kind::Revolute | Kind::Cylindrical) {
        return joint;
    }
    let probe = Probe::new(pool, 6 * bodies.len());
    let unit = Value::identity(pool);
    let images = joint.motion(pool, bodies, &probe.moves, Some(&unit));
    let step = joint.steps().len() - 1;
    let [_, cosine, sine, _] = probe.symbols[step];
    for &(state, of) in angles {
        let of = numbers::folded(pool, &of);
        let seen = substitute(pool, &of, &|symbol| images.get(&symbol).copied());
        if pool.symbols(&seen).into_iter().any(|symbol| symbol != cosine && symbol != sine) {
            continue;
        }
        let at = |pool: &mut Pool, values: [f64; 2]| -> Option<Vec<f64>> {
            let [c, s] = values.map(|value| pool.number(value));
            let put = |symbol: Symbol| [(cosine, c), (sine, s)].into_iter().find(|(own, _)| *own == symbol);
            let ids = substitute(pool, &seen, &|symbol| put(symbol).map(|(_, id)| id));
            ids.into_iter().map(|id| pool.as_number(id)).collect()
        };
        let (Some(start), Some(quarter)) = (at(pool, [1.0, 0.0]), at(pool, [0.0, 1.0])) else { continue };
        let [start, quarter] = [start, quarter].map(|of| numbers::cleaned(&[of[0], of[1]]));
        // The angle is d + q, or d - q; both ends are turned upside down then.
        let direction = start[1] * quarter[0] - start[0] * quarter[1];
        if start.iter().all(|part| part.fract() == 0.0) && direction.abs() == 1.0 {
            let over = if direction < 0.0 { [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0] } else { UNIT };
            let [s, c] = start;
            let turn = [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
            let mut aligned = joint.clone();
            aligned.frames = aligned.frames.map(|frame| numbers::product(&frame, &over));
            aligned.frames[1] = numbers::product(&aligned.frames[1], &turn);
            let images = aligned.motion(pool, bodies, &probe.moves, Some(&probe.rotation));
            let seen = substitute(pool, &of, &|symbol| images.get(&symbol).copied());
            let Moves { cosine, sine, .. } = probe.moves[step];
            if !same_polynomial(pool, seen[0], sine) || !same_polynomial(pool, seen[1], cosine) {
                continue;
            }
            aligned.angle = Some(state);
            return aligned;
        }
    }
    joint
}

/// The cosine of an angle by which the first guess of a pose may be wrong.
const NEAR: f64 = 0.5;

/// A body at both ends of a joint; the ground where there is none.
type Ends<'a> = [Option<&'a Body>; 2];

/// The values at the start of three expressions.
fn at_start(pool: &Pool, ids: &[Id], starts: &Environment<'_>) -> Vector {
    evaluate(pool, ids, starts).try_into().expect("three components")
}

/// A body's axes at the start.
fn turned(body: Option<&Body>, starts: &Environment<'_>) -> Matrix {
    body.map_or(UNIT, |body| body.axes.map(|state| starts.states[state]))
}

/// A vector in a body's axes at the start.
fn inside(body: Option<&Body>, vector: &Vector, starts: &Environment<'_>) -> Vector {
    numbers::cleaned(&numbers::applied(&numbers::transposed(&turned(body, starts)), vector))
}

/// Axes on both ends whose third turn about each other: where the bodies start it is across both held directions.
fn shared(pool: &Pool, ends: Ends<'_>, held: &[Vec<Id>], Given { starts, .. }: &Given<'_>) -> Option<[Matrix; 2]> {
    let [first, second] = [0, 1].map(|k| at_start(pool, &held[k], starts));
    let axis = numbers::unit(&numbers::cross(&first, &second))?;
    let [on_parent, on_child] = ends.map(|body| inside(body, &axis, starts));
    let upright = numbers::upright(&on_child);
    let is_one = numbers::are_near(&on_parent, &on_child);
    Some([if is_one { upright } else { numbers::upright(&on_parent) }, upright])
}

/// Axes on both ends that stay as they start, the third across the held directions of motion, where these are two.
fn whole(pool: &Pool, ends: Ends<'_>, held: &[Vec<Id>], Given { starts, .. }: &Given<'_>) -> Option<[Matrix; 2]> {
    let axis = match held {
        [first, second] => {
            let [first, second] = [first, second].map(|held| at_start(pool, held, starts));
            numbers::unit(&numbers::cross(&first, &second))?
        }
        _ => [0.0, 0.0, 1.0],
    };
    let on_parent = numbers::upright(&inside(ends[0], &axis, starts));
    let [first, second] = ends.map(|body| turned(body, starts));
    let relative = numbers::product(&numbers::transposed(&second), &first);
    Some([on_parent, numbers::product(&relative, &on_parent)])
}

/// Axes on both ends whose third are those whose cosine is kept at zero.
fn crossing(pool: &mut Pool, ends: Ends<'_>, gap: Id, Given { starts, .. }: &Given<'_>) -> Option<[Matrix; 2]> {
    // The slopes of a . R b by R are a_i b_j.
    let mut slopes = |body: &Body| -> Matrix {
        let slopes: Vec<Id> = body.axes.iter().map(|&state| partial(pool, &[gap], Symbol::state(state))[0]).collect();
        evaluate(pool, &slopes, starts).try_into().expect("nine components")
    };
    let largest = |of: &[Vector; 3]| of.iter().copied().max_by(|a, b| numbers::norm(a).total_cmp(&numbers::norm(b)));
    let axis = |of: [Vector; 3]| numbers::unit(&largest(&of)?).map(|axis| numbers::cleaned(&axis));
    let rows = |of: &Matrix| [0, 1, 2].map(|row| [of[3 * row], of[3 * row + 1], of[3 * row + 2]]);
    let of_child = slopes(ends[1]?);
    let on_child = axis(rows(&of_child))?;
    let on_parent = match ends[0] {
        Some(parent) => axis(rows(&slopes(parent)))?,
        None => axis(rows(&numbers::transposed(&of_child)))?,
    };
    Some([on_parent, on_child].map(|axis| numbers::upright(&axis)))
}

/// Where the joint is on both ends, by the gaps e . (x_b + R_b s_b - x_a - R_a s_a) of its translations, in directions
/// e that are constant or in the axes of one end; none where that changes. Where a direction is not held the place on
/// the end that has the directions is taken as zero in it.
fn points(pool: &mut Pool, [parent, child]: Ends<'_>, (gaps, along): (&[Id], &[Vec<Id>])) -> Option<[Value; 2]> {
    let child = child?;
    let reads = pool.symbols(&along.concat());
    let has = |body: &Body| body.axes.iter().any(|&state| reads.contains(&Symbol::state(state)));
    let (by_child, by_parent) = (has(child), parent.is_some_and(has));
    let (zero, unit) = (pool.zero(), Value::identity(pool));
    // Both bodies with their centres at the origin, upright or with all axes zero.
    let placed = |pool: &mut Pool, ids: &[Id], is_upright: [bool; 2]| {
        substitute(pool, ids, &|symbol| {
            let of = |body: &Body, is_upright: bool| {
                let place = body.place.iter().any(|&state| symbol == Symbol::state(state)).then_some(zero);
                let entry = body.axes.iter().position(|&state| symbol == Symbol::state(state));
                place.or(entry.map(|k| if is_upright { unit.0[k] } else { zero }))
            };
            of(child, is_upright[1]).or_else(|| parent.and_then(|parent| of(parent, is_upright[0])))
        })
    };
    let upright = placed(pool, &along.concat(), [true; 2]);
    let number = |id: &Id| pool.as_number(*id);
    let directions: Vec<f64> = upright.iter().map(number).collect::<Option<_>>()?;
    let directions: Vec<Vector> = directions.chunks(3).map(|of| [of[0], of[1], of[2]]).collect();
    let full = |pool: &mut Pool, body: &Body, sign: f64| -> Option<Value> {
        let row = (0..3).max_by(|&a, &b| directions[0][a].abs().total_cmp(&directions[0][b].abs()))?;
        let parts = (0..3).map(|k| {
            let slope = partial(pool, &gaps[..1], Symbol::state(body.axes[3 * row + k]));
            let slope = placed(pool, &slope, [true; 2])[0];
            pool.scale(sign / directions[0][row], slope)
        });
        Some(Value(parts.collect()))
    };
    let across = |pool: &mut Pool, is_upright: [bool; 2], sign: f64| -> Value {
        let sides = placed(pool, gaps, is_upright);
        let part = |pool: &mut Pool, k: usize| {
            let terms: Vec<(Id, f64)> =
                sides.iter().zip(&directions).map(|(&side, direction)| (side, sign * direction[k])).collect();
            pool.linear(0.0, &terms)
        };
        Value((0..3).map(|k| part(pool, k)).collect())
    };
    let on_child = if by_child { across(pool, [false, true], 1.0) } else { full(pool, child, 1.0)? };
    let on_parent = match parent {
        Some(parent) if !by_parent => full(pool, parent, -1.0)?,
        None if by_child => return None,
        _ => across(pool, [true, false], -1.0),
    };
    let is_fixed = on_parent.0.iter().chain(&on_child.0).all(|&id| is_constant(pool, id));
    is_fixed.then_some([on_parent, on_child])
}

/// Whether the rows hold as many directions as they are, no less and no more, at any angle and in any pose.
fn holds(equations: &mut StateEquations, bodies: &[Body], joint: &Joint, (flows, gaps): (&[Id], &[Id])) -> bool {
    let pool = &mut equations.pool;
    let probe = Probe::new(pool, 6 * bodies.len());
    let rotation = probe.rotation.clone();
    let images = joint.motion(pool, bodies, &probe.moves, Some(&rotation));
    let all: Vec<Id> = flows.iter().chain(gaps).copied().collect();
    let found = substitute(pool, &all, &|symbol| images.get(&symbol).copied());
    if !found.into_iter().all(|id| vanishes(pool, id)) {
        return false;
    }
    let unit = Value::identity(pool);
    let images = joint.motion(pool, bodies, &probe.moves, Some(&unit));
    let slopes: Vec<Vec<Id>> = (0..6)
        .map(|k| {
            let slopes = partial(pool, flows, velocity(joint.child, k));
            substitute(pool, &slopes, &|symbol| images.get(&symbol).copied())
        })
        .collect();
    let block = |row: usize, first: usize| [slopes[first][row], slopes[first + 1][row], slopes[first + 2][row]];
    let moved = |row: &usize| block(*row, 0).iter().any(|&id| !pool.is_zero(id));
    let (translations, rotations): (Vec<usize>, Vec<usize>) = (0..flows.len()).partition(moved);
    let along: Vec<[Id; 3]> = translations.iter().map(|&row| block(row, 0)).collect();
    let about: Vec<[Id; 3]> = rotations.iter().map(|&row| block(row, 3)).collect();
    [along, about].iter().all(|directions| are_independent(pool, &probe, directions))
}

/// Directions at so many angles that their products with each other, trigonometric polynomials of the second degree in
/// each angle, are constant where they are the same at all of them: five places of each. None where something else is
/// in them.
pub(super) fn at_places(pool: &Pool, probe: &Probe, directions: &[[Id; 3]]) -> Option<Vec<Vec<Vector>>> {
    const PLACES: usize = 5;
    let ids: Vec<Id> = directions.concat();
    let Symbol::Weight(last) = probe.symbols[STEPS - 1][3] else { return None };
    if pool.symbols(&ids).into_iter().any(|symbol| !matches!(symbol, Symbol::Weight(_))) {
        return None;
    }
    let at = |sample: usize| {
        let mut weights = vec![f64::NAN; last as usize + 1];
        for (symbols, place) in probe.symbols.iter().zip([sample % PLACES, sample / PLACES]) {
            let angle = std::f64::consts::TAU * place as f64 / PLACES as f64 + 0.3;
            for (symbol, value) in symbols.iter().zip([0.7, angle.cos(), angle.sin(), 0.0]) {
                if let Symbol::Weight(index) = symbol {
                    weights[*index as usize] = value;
                }
            }
        }
        let values = evaluate(pool, &ids, &Environment { weights: &weights, ..Environment::default() });
        values.chunks(3).map(|of| [of[0], of[1], of[2]]).collect()
    };
    Some((0..PLACES.pow(2)).map(at).collect())
}

/// Whether directions span as much at all angles.
fn are_independent(pool: &Pool, probe: &Probe, directions: &[[Id; 3]]) -> bool {
    const LEAST: f64 = 1e-6;
    let mut found: Option<Vec<f64>> = None;
    let Some(places) = at_places(pool, probe, directions) else { return false };
    for rows in places {
        let products: Vec<f64> = rows.iter().flat_map(|a| rows.iter().map(|b| numbers::dot(a, b))).collect();
        let size = match rows[..] {
            [] => 1.0,
            [a] => numbers::norm(&a),
            [a, b] => numbers::norm(&numbers::cross(&a, &b)),
            [a, b, c] => numbers::dot(&numbers::cross(&a, &b), &c).abs(),
            _ => return false,
        };
        let is_same = found.as_ref().is_none_or(|found| numbers::are_near(found, &products));
        if size < LEAST || !is_same || size.is_nan() {
            return false;
        }
        found = Some(products);
    }
    true
}

/// Whether the bodies start with their axes and points together, and at a speed that the rows allow.
fn starts_so(equations: &mut StateEquations, bodies: &[Body], joint: &Joint, given: &Given<'_>) -> bool {
    if !joint.rows.iter().all(|&row| Choice::is_closed(equations, row)) {
        return false;
    }
    let StateEquations { pool, states, .. } = &mut *equations;
    let axes = [joint.parent, Some(joint.child)].map(|body| match body {
        Some(body) => Value(bodies[body].axes.iter().map(|&state| states[state].start).collect()),
        None => Value::identity(pool),
    });
    // That axes which cross do so says their gap.
    let together: &[usize] = match joint.kind {
        Kind::Revolute | Kind::Cylindrical => &[2],
        Kind::Prismatic | Kind::Fixed => &[0, 1, 2],
        Kind::Universal | Kind::Spherical | Kind::Angles | Kind::Floating => &[],
    };
    let steps = joint.steps();
    let slides = steps.iter().any(|step| step.freedom == Freedom::Slide);
    if !given.guessed.fits(joint.parent, joint.child, slides) {
        return false;
    }
    let are_near = |column: usize| {
        let [a, b] = [0, 1].map(|end| {
            let body = [joint.parent, Some(joint.child)][end].map(|body| &bodies[body]);
            numbers::applied(&turned(body, given.starts), &numbers::column(&joint.frames[end], column))
        });
        numbers::dot(&a, &b) > NEAR
    };
    let mut all = Vec::new();
    for &column in together {
        let [a, b] = [0, 1].map(|end| {
            let axis = numbers::constant(pool, &numbers::column(&joint.frames[end], column));
            axes[end].multiply(pool, &axis)
        });
        let back = b.negate(pool);
        let apart = a.add(pool, &back).0;
        // The pose that is looked for brings them together, if not to opposite sides.
        let is_sought = pool.symbols(&apart).into_iter().any(|symbol| matches!(symbol, Symbol::Unknown(_)));
        if !is_sought {
            all.extend(apart);
        } else if !are_near(column) {
            return false;
        }
    }
    let all = numbers::folded(pool, &all);
    all.into_iter().all(|id| vanishes(pool, id)) && moves_so(equations, &joint.rows, given)
}

/// Whether bodies start at a speed that these rows allow, or at one that is looked for.
fn moves_so(equations: &mut StateEquations, rows: &[usize], given: &Given<'_>) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    let flows: Vec<Id> = rows.iter().map(|&row| reactions[row].slip.flow).collect();
    let flows = substitute(pool, &flows, &|symbol| given.by_momenta.get(&symbol).copied());
    let flows = substitute(pool, &flows, &|symbol| symbol.as_state().map(|state| states[state].start));
    let flows: Vec<Id> = flows.into_iter().filter(|&flow| !given.guessed.has(pool, flow)).collect();
    let flows = numbers::folded(pool, &flows);
    flows.into_iter().all(|id| vanishes(pool, id))
}

/// Whether each reaction acts linearly on bodies' momenta alone and works on nothing but the flow of its row.
fn works_not(equations: &mut StateEquations, rows: &[usize], (flows, given): (&[Id], &Given<'_>)) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    rows.iter().zip(flows).all(|(&row, &flow)| {
        let multiplier = reactions[row].multiplier;
        let mut powers = Vec::new();
        for &state in given.loaded.get(&multiplier).into_iter().flatten() {
            let load = partial(pool, &[states[state].rate], multiplier);
            let load = numbers::folded(pool, &load)[0];
            let speed = given.speeds.get(&state).filter(|_| !pool.symbols(&[load]).contains(&multiplier));
            let Some(&speed) = speed else { return false };
            let speed = pool.symbol(speed);
            powers.push(pool.mul(load, speed));
        }
        let power = pool.sum(&powers);
        let opposite = pool.neg(flow);
        same_polynomial(pool, power, flow) || same_polynomial(pool, power, opposite)
    })
}
