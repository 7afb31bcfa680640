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
use crate::system::equations::StateEquations;
use crate::system::reduce::joined::Choice;
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
    let mut owner: BTreeMap<Symbol, usize> = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        owner.extend((0..6).map(|k| (velocity(index, k), index)));
        let states = body.place.iter().chain(&body.axes).chain(&body.linear).chain(&body.angular);
        owner.extend(states.map(|&state| (Symbol::state(state), index)));
    }
    let mut loaded = Loaded::new();
    for (index, state) in equations.states.iter().enumerate() {
        for symbol in equations.pool.symbols(&[state.rate]) {
            if matches!(symbol, Symbol::Multiplier(_)) {
                loaded.entry(symbol).or_default().push(index);
            }
        }
    }
    let given = Given { owner, loaded, starts };
    let joints = closing::of_joints(&equations.reactions, 0..rigid);
    joints.into_iter().filter_map(|rows| hinge(equations, bodies, &given, rows)).collect()
}

/// The states in whose rates each multiplier is.
type Loaded = BTreeMap<Symbol, Vec<usize>>;

/// What is known of all bodies.
struct Given<'a> {
    /// Whose states and velocities symbols are.
    owner: BTreeMap<Symbol, usize>,
    loaded: Loaded,
    starts: &'a Environment<'a>,
}

fn hinge(equations: &mut StateEquations, bodies: &[Body], given: &Given<'_>, rows: Vec<usize>) -> Option<Hinge> {
    let Given { owner, loaded, starts } = given;
    if rows.len() != 5 {
        return None;
    }
    let flows: Vec<Id> = rows.iter().map(|&row| equations.reactions[row].slip.flow).collect();
    let flows = by_velocities(&mut equations.pool, bodies, &flows);
    let flows = numbers::folded(&mut equations.pool, &flows);
    let gaps: Vec<Id> = rows.iter().filter_map(|&row| equations.reactions[row].slip.gap).collect();
    let gaps = numbers::folded(&mut equations.pool, &gaps);
    let both: Vec<Id> = flows.iter().chain(&gaps).copied().collect();
    let mut ends = BTreeSet::new();
    for symbol in equations.pool.symbols(&both) {
        match symbol {
            Symbol::Parameter(_) => {}
            _ => _ = ends.insert(*owner.get(&symbol)?),
        }
    }
    let ends: Vec<usize> = ends.into_iter().collect();
    let (parent, child) = match ends[..] {
        [child] => (None, child),
        [parent, child] => (Some(parent), child),
        _ => return None,
    };
    let pool = &mut equations.pool;
    let by = |pool: &mut Pool, first: usize| -> Vec<Vec<Id>> {
        (first..first + 3).map(|k| partial(pool, &flows, velocity(child, k))).collect()
    };
    let (of_velocity, of_spin) = (by(pool, 0), by(pool, 3));
    let is_moved = |row: &usize| of_velocity.iter().any(|column| !pool.is_zero(column[*row]));
    let (translations, rotations): (Vec<usize>, Vec<usize>) = (0..5).partition(is_moved);
    let (&[x, y, z], &[first, second]) = (&translations[..], &rotations[..]) else { return None };
    // The axis, where the bodies start.
    let at_start = |pool: &Pool, row: usize| -> Vector {
        let ids: Vec<Id> = of_spin.iter().map(|column| column[row]).collect();
        evaluate(pool, &ids, starts).try_into().expect("three components")
    };
    let axis = numbers::unit(&numbers::cross(&at_start(pool, first), &at_start(pool, second)))?;
    let turned = |body: usize| bodies[body].axes.map(|state| starts.states[state]);
    let own = |body: Option<usize>| match body {
        Some(body) => numbers::applied(&numbers::transposed(&turned(body)), &axis),
        None => axis,
    };
    let [on_parent, on_child] = [own(parent), own(Some(child))].map(|axis| numbers::cleaned(&axis));
    let upright = numbers::upright(&on_child);
    let frames =
        if numbers::are_near(&on_parent, &on_child) { [upright; 2] } else { [numbers::upright(&on_parent), upright] };
    // The points, where the gap says x_b + R_b s_b - x_a - R_a s_a.
    let mut at: Vec<Value> = Vec::new();
    for body in [parent, Some(child)] {
        let Some(body) = body else {
            let zero = pool.zero();
            let states: Vec<Symbol> =
                bodies[child].place.iter().chain(&bodies[child].axes).map(|&s| Symbol::state(s)).collect();
            let mut place = Vec::new();
            for (k, row) in [x, y, z].into_iter().enumerate() {
                let by = partial(pool, &[gaps[row]], states[k])[0];
                let rest = substitute(pool, &[gaps[row]], &|symbol| states.contains(&symbol).then_some(zero))[0];
                let rest = pool.div(rest, by);
                place.push(pool.neg(rest));
            }
            at.push(Value(place));
            continue;
        };
        let by = partial(pool, &[gaps[x]], Symbol::state(bodies[body].place[0]))[0];
        pool.as_number(by).filter(|&by| by != 0.0)?;
        let arms = (0..3).map(|k| {
            let slope = partial(pool, &[gaps[x]], Symbol::state(bodies[body].axes[k]))[0];
            pool.div(slope, by)
        });
        at.push(Value(arms.collect()));
    }
    if !at.iter().flat_map(|at| &at.0).all(|&id| is_constant(pool, id)) {
        return None;
    }
    let name = equations.reactions[rows[0]].slip.joint.clone();
    let at: [Value; 2] = at.try_into().ok()?;
    let hinge = Hinge { name, rows, parent, child, frames, at };
    let is_proved = holds(equations, bodies, &hinge, (&flows, &gaps))
        && starts_so(equations, bodies, &hinge)
        && works_not(equations, bodies, &hinge, (&flows, loaded));
    is_proved.then_some(hinge)
}

/// Expressions with the bodies' velocities in place of their momenta.
fn by_velocities(pool: &mut Pool, bodies: &[Body], ids: &[Id]) -> Vec<Id> {
    let mut images = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        for k in 0..3 {
            let own = pool.symbol(velocity(index, k));
            images.insert(Symbol::state(body.linear[k]), pool.mul(body.mass, own));
        }
    }
    substitute(pool, ids, &|symbol| images.get(&symbol).copied())
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
    if gaps.len() != 5 || !found.into_iter().all(|id| same_polynomial(pool, id, zero)) {
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
fn starts_so(equations: &mut StateEquations, bodies: &[Body], hinge: &Hinge) -> bool {
    if !hinge.rows.iter().all(|&row| Choice::is_closed(equations, row)) {
        return false;
    }
    let StateEquations { pool, states, .. } = &mut *equations;
    let [parent, child] = [hinge.parent, Some(hinge.child)].map(|body| match body {
        Some(body) => Value(bodies[body].axes.iter().map(|&state| states[state].start).collect()),
        None => Value::identity(pool),
    });
    let axes = [0, 1].map(|end| numbers::constant(pool, &numbers::column(&hinge.frames[end], 2)));
    let (a, b) = (parent.multiply(pool, &axes[0]), child.multiply(pool, &axes[1]));
    let [a, b] = [a, b].map(|of| Value(numbers::folded(pool, &of.0)));
    let is_near = a.0.iter().zip(&b.0).all(|(&a, &b)| {
        let apart = pool.sub(a, b);
        pool.as_number(apart).map_or_else(|| same_polynomial(pool, a, b), |apart| apart.abs() < 1e-12)
    });
    is_near && hinge.rows.iter().all(|&row| fits_at_start(equations, bodies, row))
}

/// Whether the flow of a row is zero at the start.
fn fits_at_start(equations: &mut StateEquations, bodies: &[Body], row: usize) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    let mut images = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        for k in 0..3 {
            let momentum = pool.symbol(Symbol::state(body.linear[k]));
            images.insert(velocity(index, k), pool.div(momentum, body.mass));
            images.insert(velocity(index, k + 3), body.spin[k]);
        }
    }
    let flow = substitute(pool, &[reactions[row].slip.flow], &|symbol| images.get(&symbol).copied());
    let start = substitute(pool, &flow, &|symbol| symbol.as_state().map(|state| states[state].start));
    let start = numbers::folded(pool, &start)[0];
    let zero = pool.zero();
    pool.as_number(start).map_or_else(|| same_polynomial(pool, start, zero), |start| start.abs() < 1e-12)
}

/// Whether each reaction acts linearly on bodies' momenta alone and works on nothing but the flow of its row.
fn works_not(
    equations: &mut StateEquations,
    bodies: &[Body],
    hinge: &Hinge,
    (flows, loaded): (&[Id], &Loaded),
) -> bool {
    let momenta: BTreeMap<usize, Symbol> = bodies
        .iter()
        .enumerate()
        .flat_map(|(index, body)| {
            let states = body.linear.iter().chain(&body.angular);
            states.enumerate().map(move |(k, &state)| (state, velocity(index, k)))
        })
        .collect();
    let StateEquations { pool, states, reactions, .. } = equations;
    for (&row, &flow) in hinge.rows.iter().zip(flows) {
        let multiplier = reactions[row].multiplier;
        let mut powers = Vec::new();
        for &state in loaded.get(&multiplier).into_iter().flatten() {
            let load = partial(pool, &[states[state].rate], multiplier)[0];
            let load = numbers::folded(pool, &[load])[0];
            let Some(&speed) = momenta.get(&state) else { return false };
            let speed = pool.symbol(speed);
            if pool.symbols(&[load]).contains(&multiplier) {
                return false;
            }
            powers.push(pool.mul(load, speed));
        }
        let power = pool.sum(&powers);
        let opposite = pool.neg(flow);
        if !same_polynomial(pool, power, flow) && !same_polynomial(pool, power, opposite) {
            return false;
        }
    }
    true
}
