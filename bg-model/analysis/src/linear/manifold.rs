//! The directions in which a model can move from a state: what its linear model is about.
//!
//! In: a plant and a state. Out: independent coordinates by name, with the matrices from and to small changes of the
//! states.
//! Method: seen from rest at the same place, the momenta that rigid joints allow are free, and everything else changes
//! as these momenta, the other states and the inputs make it change: the image of the rates' Jacobian. Of these
//! directions independent coordinates are chosen (see `independent`), rotations before positions before displacements;
//! the others follow from them. What the image does not contain cannot change near the state: the difference of two
//! displacements that are integrals of one velocity, the gap of a rigid joint, a pose that only time changes.

use bg_model::description::StateKind;
use bg_model::nalgebra::{DMatrix, DVector};

use super::carry::Carry;
use super::coordinates::{Coordinate, Coordinates, Role, is_idle_integral};
use super::independent::{independent, longest};
use super::plant::{ByInputs, Derivatives, Plant, at_rest, momenta};

/// States that a linear model does not have, and why.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct LeftOut {
    /// What memories keep and samples hold, which stays as it is.
    pub held: Vec<String>,
    /// Integrals that only outputs ask for.
    pub integrals: Vec<String>,
    /// Orientations with the number of their entries that are states and the number of rotations in place of them.
    pub orientations: Vec<(String, usize, usize)>,
    /// Coordinates that follow from those that stay: displacements that the poses determine, what rigid joints hold.
    pub dependent: Vec<String>,
    /// Coordinates that nothing changes, or time alone.
    pub still: Vec<String>,
}

impl LeftOut {
    /// The same where the states of these names are held, why ever else they are left out.
    pub(super) fn holding(mut self, held: Vec<String>) -> Self {
        for others in [&mut self.integrals, &mut self.dependent, &mut self.still] {
            others.retain(|name| !held.contains(name));
        }
        Self { held, ..self }
    }
}

/// A coordinate that changes by itself: nothing in the model changes its rate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drift {
    /// Which.
    pub coordinate: Coordinate,
    /// How fast, per s.
    pub rate: f64,
    /// Whether rates depend on it.
    pub matters: bool,
}

/// The directions at a state.
pub(super) struct Manifold {
    /// The independent coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Column: how a unit of a coordinate changes the states.
    pub tangent: DMatrix<f64>,
    /// How fast the columns of `tangent` change because orientations turn.
    pub turning: DMatrix<f64>,
    /// Row: how a coordinate changes with the states.
    pub chart: DMatrix<f64>,
    /// What is not among the coordinates.
    pub left_out: LeftOut,
    /// What of it changes nevertheless.
    pub drifts: Vec<Drift>,
    /// Column: how a unit of a momentum, a coordinate, changes the momenta among the states.
    pushes: DMatrix<f64>,
    /// Row: coordinate that is no momentum, column: how fast a unit of a momentum changes it.
    kinematics: DMatrix<f64>,
    /// States that the kinematics leaves alone.
    stays: Vec<bool>,
    momenta: Vec<bool>,
    kinds: Vec<StateKind>,
}

impl Manifold {
    /// The directions at state `x`, where the derivatives are `here` and `inputs`.
    pub fn at(plant: &Plant, x: &DVector<f64>, here: &Derivatives, inputs: &ByInputs) -> Self {
        let description = plant.description;
        let at_rest = at_rest(description, x);
        let rest = if at_rest == *x { here.clone() } else { plant.derivatives(&at_rest) };
        let all = Coordinates::at(description, x, &here.rates, &rest.rates_by_state);
        let is_momentum = |k: &usize| all.list[*k].role == Role::Momentum;
        let (p, q): (Vec<usize>, Vec<usize>) = (0..all.list.len()).partition(is_momentum);

        // Momenta that rigid joints allow.
        let held = (&rest.flows_by_state * &all.to_states).select_columns(&p);
        let by_coordinate = &all.from_states * &rest.rates_by_state * &all.to_states;
        let allowed = Allowed::by(&held, &by_coordinate.select_rows(&q).select_columns(&p));
        // How all else can change.
        let by_momenta = by_coordinate.select_rows(&q).select_columns(&p) * &allowed.momenta;
        let by_inputs = (&all.from_states * &inputs.rates).select_rows(&q);
        let by_others =
            without_own_turning(&by_coordinate.select_rows(&q).select_columns(&q), &by_momenta, &by_inputs, &|k| {
                let coordinate = &all.list[q[k]];
                (coordinate.role == Role::Turn).then(|| coordinate.name.rsplit_once('_').map_or("", |(owner, _)| owner))
            });
        let image = joined(&[&by_momenta, &by_others, &by_inputs]);
        let roles: Vec<Role> = q.iter().map(|&k| all.list[k].role).collect();
        let ways = independent(&image, &roles);

        // Momenta change with the place where joints are rigid and the model moves.
        let held_states = &here.flows_by_state * &all.to_states;
        let held_here = held_states.select_columns(&p);
        let place = placed(all.list.len(), &q, &ways.factors);
        let place = &place + placed(all.list.len(), &p, &allowed.correction(&held_here, &(&held_states * &place)));
        let momentum = placed(all.list.len(), &p, &Allowed::by_rows(&held_here, &allowed.free).momenta);

        let places = ways.rows.iter().enumerate().map(|(column, &row)| (q[row], place.column(column)));
        let free = allowed.free.iter().enumerate().map(|(column, &k)| (p[k], momentum.column(column)));
        let mut columns: Vec<(usize, _)> = places.chain(free).collect();
        columns.sort_by_key(|(coordinate, _)| *coordinate);
        let kept: Vec<usize> = columns.iter().map(|(coordinate, _)| *coordinate).collect();
        let expanded = DMatrix::from_fn(all.list.len(), kept.len(), |row, column| columns[column].1[row]);

        let name = |k: &usize| all.list[*k].name.clone();
        let is_still = |k: &usize| q.iter().position(|other| other == k).is_some_and(|row| is_zero(&ways.factors, row));
        let (still, dependent): (Vec<usize>, Vec<usize>) =
            (0..all.list.len()).filter(|k| !kept.contains(k)).partition(is_still);
        // Seen from rest, where what only momenta change has the rate 0.
        let rates = &all.from_states * &rest.rates;
        let drift = |&k: &usize| {
            // An orientation that time turns changes its own rate only.
            let mut others = (0..all.list.len())
                .filter(|&row| turned(&all.list[k]).is_none_or(|of| turned(&all.list[row]) != Some(of)));
            let matters = others.any(|row| by_coordinate[(row, k)] != 0.0);
            Drift { coordinate: all.list[k].clone(), rate: rates[k], matters }
        };
        let drifts = still.iter().filter(|&&k| rates[k] != 0.0).map(drift).collect();
        Self {
            drifts,
            coordinates: kept.iter().map(|&k| all.list[k].clone()).collect(),
            tangent: &all.to_states * &expanded,
            turning: &all.turning * expanded,
            chart: all.from_states.select_rows(&kept),
            left_out: LeftOut {
                held: Vec::new(),
                integrals: all.integrals.iter().map(|&name| name.to_owned()).collect(),
                orientations: all.orientations,
                dependent: dependent.iter().map(name).collect(),
                still: still.iter().map(name).collect(),
            },
            kinematics: by_momenta.select_rows(&ways.rows),
            pushes: &all.to_states * momentum,
            stays: (0..x.len())
                .map(|k| momenta(description)[k] || is_idle_integral(description, k, &rest.rates_by_state))
                .collect(),
            momenta: momenta(description),
            kinds: description.states.iter().map(|state| state.kind).collect(),
        }
    }

    /// How far a change of the coordinates moves poses: rad, or part of `extent` (m).
    pub fn length(&self, step: &DVector<f64>, extent: f64) -> f64 {
        let by = |of: StateKind| match of {
            StateKind::Position(_) => 1.0 / extent,
            StateKind::Orientation(..) | StateKind::Angle => 1.0,
            _ => 0.0,
        };
        let change = &self.tangent * step;
        self.kinds.iter().zip(&change).fold(0.0, |longest, (&kind, change)| longest.max(change.abs() * by(kind)))
    }

    /// How far a change of the coordinates moves positions, m.
    pub fn way(&self, step: &DVector<f64>) -> f64 {
        self.largest_position(&(&self.tangent * step))
    }

    /// The largest of these states, or changes of states, that are positions, m.
    pub fn largest_position(&self, of: &DVector<f64>) -> f64 {
        let positions = self.kinds.iter().zip(of).filter(|(kind, _)| matches!(kind, StateKind::Position(_)));
        positions.fold(0.0, |largest, (_, at)| largest.max(at.abs()))
    }

    /// How large the states are, so that smaller changes are rounding: an orientation has the size 1, a position that
    /// of the largest one.
    pub fn sizes(&self, x: &DVector<f64>) -> DVector<f64> {
        let largest = self.largest_position(x);
        let size = |(kind, at): (&StateKind, &f64)| match kind {
            StateKind::Position(_) => largest,
            StateKind::Orientation(..) => 1.0,
            StateKind::Angle => at.abs().max(1.0),
            _ => at.abs(),
        };
        DVector::from_iterator(x.len(), self.kinds.iter().zip(x).map(size))
    }

    /// The finite move that changes the coordinates by `step` to first order, in a machine of this `extent` (m).
    pub fn carry(&self, step: &DVector<f64>, extent: f64) -> Carry {
        let is_momentum = |k: &usize| self.coordinates[*k].role == Role::Momentum;
        let (p, q): (Vec<usize>, Vec<usize>) = (0..step.len()).partition(is_momentum);
        let wanted = step.select_rows(&q);
        let by_momenta = least(&self.kinematics, &wanted);
        let mut rest = &wanted - &self.kinematics * &by_momenta;
        rest.iter_mut()
            .zip(&wanted)
            .filter(|(rest, way)| rest.abs() < 1e-11 * way.abs())
            .for_each(|(rest, _)| *rest = 0.0);
        let unit = |k: usize| self.coordinates[q[k]].unit;
        let largest = |of: &str| (0..q.len()).filter(|&k| unit(k) == of).fold(0.0, |most, k| wanted[k].abs().max(most));
        for (k, rest) in rest.iter_mut().enumerate() {
            *rest = if rest.abs() < 1e-12 * largest(unit(k)) { 0.0 } else { *rest };
        }
        let add = self.tangent.select_columns(&q) * rest + self.tangent.select_columns(&p) * step.select_rows(&p);
        // A step of the Runge-Kutta method over 0.005 rad is exact to 1e-14.
        let steps = (self.length(step, extent) / 0.005).ceil().clamp(1.0, 200.0) as usize;
        Carry { push: &self.pushes * by_momenta, add, stays: self.stays.clone(), momenta: self.momenta.clone(), steps }
    }
}

/// The momenta that rigid joints allow.
struct Allowed {
    /// Those that can be chosen freely, by index.
    free: Vec<usize>,
    /// Those that follow from them.
    bound: Vec<usize>,
    /// Column: a free momentum with those that follow.
    momenta: DMatrix<f64>,
}

impl Allowed {
    /// `held` are the derivatives of the held flows (rows) by the momenta (columns), `moved` those of the rates of the
    /// pose. Those are bound that the flows depend on most in the metric of kinetic energy: a link that does not turn
    /// in this pose tells nothing of the others.
    fn by(held: &DMatrix<f64>, moved: &DMatrix<f64>) -> Self {
        let momenta = held.ncols();
        let mut weighed = held.transpose();
        for (mut row, velocities) in weighed.row_iter_mut().zip(moved.column_iter()) {
            // A momentum p of inertia m moves its pose by p / m, and has the energy p^2 / 2 m.
            let reciprocal = velocities.amax();
            if reciprocal > 0.0 {
                row.unscale_mut(reciprocal.sqrt());
            }
        }
        let bound = longest(&weighed);
        let free: Vec<usize> = (0..momenta).filter(|k| !bound.contains(k)).collect();
        Self::by_rows(held, &free)
    }

    /// The same with given free momenta.
    fn by_rows(held: &DMatrix<f64>, free: &[usize]) -> Self {
        let count = held.ncols();
        let bound: Vec<usize> = (0..count).filter(|k| !free.contains(k)).collect();
        let mut momenta = DMatrix::zeros(count, free.len());
        free.iter().enumerate().for_each(|(column, &k)| momenta[(k, column)] = 1.0);
        if !bound.is_empty() {
            let follow = least_columns(&held.select_columns(&bound), &-held.select_columns(free));
            for (row, &k) in bound.iter().enumerate() {
                momenta.row_mut(k).copy_from(&follow.row(row));
            }
        }
        Self { free: free.to_vec(), bound, momenta }
    }

    /// What the bound momenta change by so that the flows `torn` (columns) vanish.
    fn correction(&self, held: &DMatrix<f64>, torn: &DMatrix<f64>) -> DMatrix<f64> {
        let mut correction = DMatrix::zeros(held.ncols(), torn.ncols());
        if !self.bound.is_empty() {
            let follow = least_columns(&held.select_columns(&self.bound), &-torn);
            for (row, &k) in self.bound.iter().enumerate() {
                correction.row_mut(k).copy_from(&follow.row(row));
            }
        }
        correction
    }
}

/// The derivatives by other states, without those of an orientation by itself where nothing else turns it: what turns
/// by time alone is no motion of the model.
fn without_own_turning<'a>(
    by_others: &DMatrix<f64>,
    by_momenta: &DMatrix<f64>,
    by_inputs: &DMatrix<f64>,
    turned: &dyn Fn(usize) -> Option<&'a str>,
) -> DMatrix<f64> {
    let mut without = by_others.clone();
    let count = by_others.nrows();
    for row in (0..count).filter(|&row| turned(row).is_some()) {
        let group: Vec<usize> = (0..count).filter(|&other| turned(other) == turned(row)).collect();
        let is_turned = group.iter().any(|&member| {
            let others = (0..count).any(|column| !group.contains(&column) && by_others[(member, column)] != 0.0);
            others || !is_zero(by_momenta, member) || !is_zero(by_inputs, member)
        });
        if !is_turned {
            group.iter().for_each(|&column| without[(row, column)] = 0.0);
        }
    }
    without
}

/// What turns with a coordinate: `rod.rotation` of `rod.rotation_z`.
fn turned(coordinate: &Coordinate) -> Option<&str> {
    (coordinate.role == Role::Turn).then(|| coordinate.name.rsplit_once('_').map_or("", |(turned, _)| turned))
}

fn is_zero(matrix: &DMatrix<f64>, row: usize) -> bool {
    matrix.row(row).iter().all(|&entry| entry == 0.0)
}

/// The rows of `matrix` at these places of a matrix with `count` rows.
fn placed(count: usize, places: &[usize], matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut placed = DMatrix::zeros(count, matrix.ncols());
    places.iter().zip(matrix.row_iter()).for_each(|(&place, row)| placed.row_mut(place).copy_from(&row));
    placed
}

/// Matrices side by side.
fn joined(matrices: &[&DMatrix<f64>]) -> DMatrix<f64> {
    let columns: Vec<_> = matrices.iter().flat_map(|matrix| matrix.column_iter()).collect();
    DMatrix::from_fn(matrices[0].nrows(), columns.len(), |row, column| columns[column][row])
}

/// The least y with the least |a y - b|, where the columns of a are measured by their lengths.
fn least(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let columns = DMatrix::from_column_slice(b.len(), 1, b.as_slice());
    least_columns(a, &columns).column(0).into_owned()
}

fn least_columns(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    if a.is_empty() || b.is_empty() {
        return DMatrix::zeros(a.ncols(), b.ncols());
    }
    let lengths: Vec<f64> =
        a.column_iter().map(|column| column.norm()).map(|norm| if norm > 0.0 { norm } else { 1.0 }).collect();
    let scaled = DMatrix::from_fn(a.nrows(), a.ncols(), |row, column| a[(row, column)] / lengths[column]);
    let svd = scaled.svd(true, true);
    let smallest = 1e-11 * svd.singular_values.max();
    let Ok(mut y) = svd.solve(b, smallest) else { return DMatrix::zeros(a.ncols(), b.ncols()) };
    for (mut row, length) in y.row_iter_mut().zip(&lengths) {
        row /= *length;
    }
    y
}
