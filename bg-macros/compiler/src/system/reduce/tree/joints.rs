//! Which rows are those of hinges.
//!
//! In: equations over velocities, bodies, start values. Out: [`Hinge`]s. Method: the start says what the axis may be,
//! the gap which points meet; both are a guess only. Proof: with the relative motion of a hinge about this axis through
//! these points every gap and every flow of the joint is zero identically, the rows hold five directions at any angle,
//! the bodies start so, and the reactions do work on nothing but the flows of their rows.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, symbols, velocity};
use super::numbers::{self, Matrix, Vector};
use crate::expr::{Environment, Id, Pool, Symbol, evaluate, partial, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::{Slip, StateEquations};
use crate::system::reduce::joined::{Choice, vanishes};
use crate::system::reduce::{closing, friction, is_constant};

/// A hinge from the parent, the ground where it is none, to the child.
#[derive(Clone, Debug)]
pub(super) struct Hinge {
    pub name: String,
    pub rows: Vec<usize>,
    pub parent: Option<usize>,
    pub child: usize,
    /// Constant rotations of both from axes whose third is the hinge's to their own.
    pub frames: [Matrix; 2],
    /// Where the hinge is, in the axes of both, from their centres.
    pub at: [Value; 2],
}

/// How many symbols a probe has.
pub(super) const PROBES: usize = 7;

/// Symbols for proofs: a unit-free rotation of the parent, the sine, the cosine and the rate of the hinge.
pub(super) struct Probe {
    pub rotation: Value,
    pub cosine: Symbol,
    pub sine: Symbol,
    pub rate: Symbol,
}

impl Probe {
    /// A rotation by four numbers that are not all zero, whatever they are (Euler, Rodrigues).
    pub fn new(pool: &mut Pool, first: usize) -> Self {
        let symbol = |k: usize| Symbol::numbered(Symbol::Weight, first + k);
        let [w, x, y, z] = [0, 1, 2, 3].map(|k| pool.symbol(symbol(k)));
        let parts = [w, x, y, z];
        let squares: Vec<Id> = parts.iter().map(|&part| pool.powi(part, 2)).collect();
        let norm = pool.sum(&squares);
        let vector = [x, y, z];
        let mut entries = Vec::new();
        for row in 0..3 {
            for column in 0..3 {
                let product = pool.mul(vector[row], vector[column]);
                let entry = if row == column {
                    let all: Vec<(Id, f64)> = (1..4)
                        .map(|k| (squares[k], if k == row + 1 { 1.0 } else { -1.0 }))
                        .chain([(squares[0], 1.0)])
                        .collect();
                    pool.linear(0.0, &all)
                } else {
                    let third = 3 - row - column;
                    let sign = if (row + 1) % 3 == column { -2.0 } else { 2.0 };
                    let side = pool.mul(w, vector[third]);
                    pool.linear(0.0, &[(product, 2.0), (side, sign)])
                };
                entries.push(pool.div(entry, norm));
            }
        }
        Self { rotation: Value(entries), cosine: symbol(4), sine: symbol(5), rate: symbol(6) }
    }
}

impl Hinge {
    /// The same from the child to the parent.
    pub fn reversed(self) -> Self {
        let Self { name, rows, parent, child, frames: [a, b], at: [c, d] } = self;
        Self { name, rows, parent: Some(child), child: parent.unwrap_or(child), frames: [b, a], at: [d, c] }
    }

    /// Each state and velocity of the child by those of the parent and the hinge; with `turned` the parent's axes are
    /// these.
    pub fn motion(
        &self,
        pool: &mut Pool,
        bodies: &[Body],
        probe: &Probe,
        turned: Option<&Value>,
    ) -> BTreeMap<Symbol, Id> {
        let mut images = BTreeMap::new();
        let [c, s, u] = [probe.cosine, probe.sine, probe.rate].map(|symbol| pool.symbol(symbol));
        let own = |pool: &mut Pool, body: usize, first: usize| {
            Value((first..first + 3).map(|k| pool.symbol(velocity(body, k))).collect())
        };
        let (axes, place, fast, spin) = match self.parent {
            None => (Value::identity(pool), Value::zero(pool, 3), Value::zero(pool, 3), Value::zero(pool, 3)),
            Some(parent) => {
                let states = symbols(pool, &bodies[parent].axes);
                let axes = turned.cloned().unwrap_or(states);
                for (&state, &image) in bodies[parent].axes.iter().zip(&axes.0) {
                    images.insert(Symbol::state(state), image);
                }
                (axes, symbols(pool, &bodies[parent].place), own(pool, parent, 0), own(pool, parent, 3))
            }
        };
        let relative = self.relative(pool, c, s);
        let child = axes.multiply(pool, &relative);
        let arms = [axes.multiply(pool, &self.at[0]), child.multiply(pool, &self.at[1])];
        let axis = numbers::constant(pool, &numbers::column(&self.frames[0], 2));
        let axis = axes.multiply(pool, &axis).multiply(pool, &Value::scalar(u));
        let spun = spin.add(pool, &axis);
        let back = arms[1].negate(pool);
        let there = place.add(pool, &arms[0]).add(pool, &back);
        let (first, second) = (spin.cross(pool, &arms[0]), spun.cross(pool, &back));
        let moved = fast.add(pool, &first).add(pool, &second);
        let body = &bodies[self.child];
        let states = body.axes.iter().chain(&body.place).map(|&state| Symbol::state(state));
        images.extend(states.zip(child.0.into_iter().chain(there.0)));
        images.extend((0..6).map(|k| velocity(self.child, k)).zip(moved.0.into_iter().chain(spun.0)));
        images
    }

    /// The child's axes in the parent's.
    pub fn relative(&self, pool: &mut Pool, cosine: Id, sine: Id) -> Value {
        // By numbers as far as these go, so that no rounding stays beside symbols.
        let back = numbers::transposed(&self.frames[1]);
        let parts = [[1, 0, 0, 0, 1, 0, 0, 0, 0], [0, -1, 0, 1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 0, 1]];
        let parts = parts.map(|part| {
            let turn = numbers::product(&self.frames[0], &part.map(f64::from));
            numbers::product(&turn, &back)
        });
        Value((0..9).map(|k| pool.linear(parts[2][k], &[(cosine, parts[0][k]), (sine, parts[1][k])])).collect())
    }
}

/// The hinges among the rigid joints; `starts` has the values of the states at the start, for guesses.
pub(super) fn of(equations: &mut StateEquations, bodies: &[Body], starts: &Environment<'_>) -> Vec<Hinge> {
    let rigid = friction::rigid(&equations.reactions);
    let given = Given::new(equations, bodies, starts);
    let joints = closing::of_joints(&equations.reactions, 0..rigid);
    joints.into_iter().filter_map(|rows| hinge(equations, bodies, &given, rows)).collect()
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
    starts: &'a Environment<'a>,
}

impl<'a> Given<'a> {
    fn new(equations: &mut StateEquations, bodies: &[Body], starts: &'a Environment<'a>) -> Self {
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
        Self { owner, speeds, by_velocities, by_momenta, loaded, starts }
    }
}

fn hinge(equations: &mut StateEquations, bodies: &[Body], given: &Given<'_>, rows: Vec<usize>) -> Option<Hinge> {
    if rows.len() != 5 {
        return None;
    }
    let slips: Vec<&Slip> = rows.iter().map(|&row| &equations.reactions[row].slip).collect();
    let flows: Vec<Id> = slips.iter().map(|slip| slip.flow).collect();
    let gaps: Vec<Id> = slips.iter().map(|slip| slip.gap).collect::<Option<_>>()?;
    let name = slips[0].joint.clone();
    let pool = &mut equations.pool;
    let flows = substitute(pool, &flows, &|symbol| given.by_velocities.get(&symbol).copied());
    let [flows, gaps] = [flows, gaps].map(|ids| numbers::folded(pool, &ids));
    let mut ends = BTreeSet::new();
    for symbol in pool.symbols(&[&flows[..], &gaps].concat()) {
        if !matches!(symbol, Symbol::Parameter(_)) {
            ends.insert(*given.owner.get(&symbol)?);
        }
    }
    let ends: Vec<usize> = ends.into_iter().collect();
    let (parent, child) = match ends[..] {
        [child] => (None, child),
        [parent, child] => (Some(parent), child),
        _ => return None,
    };
    let [of_velocity, of_spin] = [0, 3].map(|first| -> Vec<Vec<Id>> {
        (first..first + 3).map(|k| partial(pool, &flows, velocity(child, k))).collect()
    });
    let is_moved = |row: &usize| of_velocity.iter().any(|column| !pool.is_zero(column[*row]));
    let (translations, rotations): (Vec<usize>, Vec<usize>) = (0..5).partition(is_moved);
    let (&[x, y, z], &[first, second]) = (&translations[..], &rotations[..]) else { return None };
    let directions = [first, second].map(|row| of_spin.iter().map(|column| column[row]).collect());
    let frames = frames(pool, [parent, Some(child)].map(|body| body.map(|body| &bodies[body])), &directions, given)?;
    let at = points(pool, bodies, (parent, child), [x, y, z].map(|row| gaps[row]))?;
    let hinge = Hinge { name, rows, parent, child, frames, at };
    let is_proved = holds(equations, bodies, &hinge, (&flows, &gaps))
        && starts_so(equations, bodies, &hinge, given)
        && works_not(equations, &hinge, (&flows, given));
    is_proved.then_some(hinge)
}

/// Axes on both ends whose third is the hinge's: where the bodies start it is across both held directions.
fn frames(
    pool: &Pool,
    ends: [Option<&Body>; 2],
    directions: &[Vec<Id>; 2],
    Given { starts, .. }: &Given<'_>,
) -> Option<[Matrix; 2]> {
    let at_start = |ids: &Vec<Id>| -> Vector { evaluate(pool, ids, starts).try_into().expect("three components") };
    let axis = numbers::unit(&numbers::cross(&at_start(&directions[0]), &at_start(&directions[1])))?;
    let [on_parent, on_child] = ends.map(|body| {
        let own = body.map(|body| numbers::transposed(&body.axes.map(|state| starts.states[state])));
        numbers::cleaned(&own.map_or(axis, |axes| numbers::applied(&axes, &axis)))
    });
    let upright = numbers::upright(&on_child);
    let is_one = numbers::are_near(&on_parent, &on_child);
    Some([if is_one { upright } else { numbers::upright(&on_parent) }, upright])
}

/// Where the hinge is on both ends, by its gap x_b + R_b s_b - x_a - R_a s_a; none where that changes.
fn points(
    pool: &mut Pool,
    bodies: &[Body],
    (parent, child): (Option<usize>, usize),
    gap: [Id; 3],
) -> Option<[Value; 2]> {
    let arm = |pool: &mut Pool, body: &Body| -> Option<Value> {
        let by = partial(pool, &gap[..1], Symbol::state(body.place[0]))[0];
        pool.as_number(by).filter(|&by| by != 0.0)?;
        let slopes = body.axes[..3].iter().map(|&state| {
            let slope = partial(pool, &gap[..1], Symbol::state(state))[0];
            pool.div(slope, by)
        });
        Some(Value(slopes.collect()))
    };
    let on_child = arm(pool, &bodies[child])?;
    let on_parent = match parent {
        Some(parent) => arm(pool, &bodies[parent])?,
        None => {
            let (body, zero) = (&bodies[child], pool.zero());
            let states: BTreeSet<Symbol> = body.place.iter().chain(&body.axes).map(|&s| Symbol::state(s)).collect();
            let rest = substitute(pool, &gap, &|symbol| states.contains(&symbol).then_some(zero));
            let parts = (0..3).map(|k| {
                let by = partial(pool, &gap[k..=k], Symbol::state(body.place[k]))[0];
                let part = pool.div(rest[k], by);
                pool.neg(part)
            });
            Value(parts.collect())
        }
    };
    let is_fixed = on_parent.0.iter().chain(&on_child.0).all(|&id| is_constant(pool, id));
    is_fixed.then_some([on_parent, on_child])
}

/// Whether the rows hold a hinge's five directions, no less and no more, at any angle and in any pose.
fn holds(equations: &mut StateEquations, bodies: &[Body], hinge: &Hinge, (flows, gaps): (&[Id], &[Id])) -> bool {
    let pool = &mut equations.pool;
    let probe = Probe::new(pool, 6 * bodies.len());
    let rotation = probe.rotation.clone();
    let images = hinge.motion(pool, bodies, &probe, Some(&rotation));
    let all: Vec<Id> = flows.iter().chain(gaps).copied().collect();
    let found = substitute(pool, &all, &|symbol| images.get(&symbol).copied());
    let zero = pool.zero();
    if !found.into_iter().all(|id| same_polynomial(pool, id, zero)) {
        return false;
    }
    // What the child's velocities have to be: by the velocity the three translations, by the spin the two rotations.
    let unit = Value::identity(pool);
    let images = hinge.motion(pool, bodies, &probe, Some(&unit));
    let mut matrix = Vec::new();
    for k in 0..6 {
        let slopes = partial(pool, flows, velocity(hinge.child, k));
        let slopes = substitute(pool, &slopes, &|symbol| images.get(&symbol).copied());
        matrix.push(slopes);
    }
    let number = |id: Id| pool.as_number(id);
    let moved = |row: &usize| (0..3).any(|k| number(matrix[k][*row]) != Some(0.0));
    let (translations, rotations): (Vec<usize>, Vec<usize>) = (0..5).partition(moved);
    let block = |rows: &[usize], first: usize| -> Option<Vec<Vector>> {
        rows.iter()
            .map(|&row| {
                Some([number(matrix[first][row])?, number(matrix[first + 1][row])?, number(matrix[first + 2][row])?])
            })
            .collect()
    };
    let (Some(along), Some(about)) = (block(&translations, 0), block(&rotations, 3)) else { return false };
    let ([a, b, c], [d, e]) = (&along[..], &about[..]) else { return false };
    const LEAST: f64 = 1e-3;
    numbers::dot(&numbers::cross(a, b), c).abs() > LEAST && numbers::norm(&numbers::cross(d, e)) > LEAST
}

/// Whether the bodies start with their axes and points together, and at a speed that the rows allow.
fn starts_so(equations: &mut StateEquations, bodies: &[Body], hinge: &Hinge, given: &Given<'_>) -> bool {
    if !hinge.rows.iter().all(|&row| Choice::is_closed(equations, row)) {
        return false;
    }
    let StateEquations { pool, states, reactions, .. } = equations;
    let axes = [hinge.parent, Some(hinge.child)].map(|body| match body {
        Some(body) => Value(bodies[body].axes.iter().map(|&state| states[state].start).collect()),
        None => Value::identity(pool),
    });
    let [a, b] = [0, 1].map(|end| {
        let axis = numbers::constant(pool, &numbers::column(&hinge.frames[end], 2));
        axes[end].multiply(pool, &axis)
    });
    let back = b.negate(pool);
    let apart = a.add(pool, &back).0;
    let flows: Vec<Id> = hinge.rows.iter().map(|&row| reactions[row].slip.flow).collect();
    let flows = substitute(pool, &flows, &|symbol| given.by_momenta.get(&symbol).copied());
    let flows = substitute(pool, &flows, &|symbol| symbol.as_state().map(|state| states[state].start));
    let all = numbers::folded(pool, &[apart, flows].concat());
    all.into_iter().all(|id| vanishes(pool, id))
}

/// Whether each reaction acts linearly on bodies' momenta alone and works on nothing but the flow of its row.
fn works_not(equations: &mut StateEquations, hinge: &Hinge, (flows, given): (&[Id], &Given<'_>)) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    hinge.rows.iter().zip(flows).all(|(&row, &flow)| {
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
