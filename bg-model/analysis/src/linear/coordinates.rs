//! Coordinates of the states: every state that changes another's rate, and three rotations for the nine entries of an
//! orientation.
//!
//! In: the states' table, a state, the derivatives of the rates there at rest. Out: the coordinates by name, with the
//! matrices from and to small changes of the states.
//! Method: R R^T = 1 leaves dR = [w x] R with the rotation vector w in inertial axes, of which a coordinate each is
//! w_x, w_y, w_z. Where a scene keeps a part of R only, as many axes are taken as this part shows; where it does not
//! show the axis, the entries stay coordinates themselves. Away from rest these are the coordinates w of R = exp([w x])
//! R_0, where R_0 is the orientation of the motion itself, which goes on: so what changes R turns with it.

use bg_model::description::{Description, StateKind};
use bg_model::nalgebra::{DMatrix, DVector};

/// What a coordinate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    /// Rotation of an orientation, angle of a body.
    Turn,
    /// Position.
    Place,
    /// Displacement, or integral that rates depend on.
    Store,
    /// Momentum.
    Momentum,
}

/// A coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coordinate {
    pub name: String,
    pub unit: &'static str,
    pub role: Role,
}

/// The coordinates of a model's states.
pub(super) struct Coordinates {
    pub list: Vec<Coordinate>,
    /// Column: how a unit of a coordinate changes the states.
    pub to_states: DMatrix<f64>,
    /// How fast these columns change as the state moves: those of rotations turn with what they are of.
    pub turning: DMatrix<f64>,
    /// Row: how a coordinate changes with the states.
    pub from_states: DMatrix<f64>,
    /// Integrals that outputs ask for, on which no rate depends.
    pub integrals: Vec<&'static str>,
    /// Orientations with the number of their entries and of their rotations.
    pub orientations: Vec<(String, usize, usize)>,
}

/// A coordinate with its change of the states.
struct Column {
    coordinate: Coordinate,
    change: DVector<f64>,
    /// How fast that changes as the state moves.
    turning: DVector<f64>,
}

impl Coordinates {
    /// The coordinates at state `x`, which moves by `rates`; `by_state` are the derivatives of the rates there at rest.
    pub fn at(description: &Description, x: &DVector<f64>, rates: &DVector<f64>, by_state: &DMatrix<f64>) -> Self {
        let states = description.states;
        let (mut columns, mut integrals, mut orientations) = (Vec::new(), Vec::new(), Vec::new());
        let mut done = vec![false; states.len()];
        for (index, state) in states.iter().enumerate() {
            if done[index] {
                continue;
            }
            if is_idle_integral(description, index, by_state) {
                integrals.push(state.name);
                continue;
            }
            if let StateKind::Orientation(..) = state.kind {
                let matrix = Entries::around(description, index);
                matrix.places.iter().for_each(|&(_, place)| done[place] = true);
                if let Some(rotations) = matrix.rotations(x, rates, by_state) {
                    orientations.push((matrix.name.clone(), matrix.places.len(), rotations.len()));
                    columns.extend(rotations);
                } else {
                    columns.extend(matrix.places.iter().map(|&(_, place)| itself(description, place)));
                }
                continue;
            }
            columns.push(itself(description, index));
        }
        let matrix = |of: fn(&Column) -> &DVector<f64>| {
            DMatrix::from_fn(states.len(), columns.len(), |row, column| of(&columns[column])[row])
        };
        let (to_states, turning) = (matrix(|column| &column.change), matrix(|column| &column.turning));
        // Columns of different coordinates share no state but those of one orientation, which are orthogonal there.
        let mut from_states = to_states.transpose();
        for mut row in from_states.row_iter_mut() {
            let square = row.norm_squared();
            row /= square;
        }
        let list = columns.into_iter().map(|column| column.coordinate).collect();
        Self { list, to_states, turning, from_states, integrals, orientations }
    }
}

/// Which integrals are left out: those that change no rate, as outputs ask for them.
pub(super) fn is_idle_integral(description: &Description, index: usize, by_state: &DMatrix<f64>) -> bool {
    description.states[index].kind == StateKind::Integral && by_state.column(index).iter().all(|&entry| entry == 0.0)
}

/// A state that is a coordinate.
fn itself(description: &Description, index: usize) -> Column {
    let state = &description.states[index];
    let role = match state.kind {
        StateKind::Momentum(_) => Role::Momentum,
        StateKind::Displacement(_) | StateKind::Way | StateKind::Integral => Role::Store,
        StateKind::Position(_) => Role::Place,
        StateKind::Orientation(..) | StateKind::Angle => Role::Turn,
    };
    let mut change = DVector::zeros(description.states.len());
    change[index] = 1.0;
    let turning = DVector::zeros(change.len());
    Column { coordinate: Coordinate { name: state.name.to_owned(), unit: state.unit, role }, change, turning }
}

/// The entries of an orientation that are states.
struct Entries {
    /// `rod.orientation`.
    name: String,
    /// Row and column, with the state's index.
    places: Vec<((usize, usize), usize)>,
}

impl Entries {
    /// The orientation that state `index` is an entry of.
    fn around(description: &Description, index: usize) -> Self {
        let stem = |name: &'static str| name.rsplit_once('_').map_or(name, |(stem, _)| stem);
        let name = stem(description.states[index].name);
        let entry = |(place, state): (usize, &bg_model::description::StateInfo)| match state.kind {
            StateKind::Orientation(row, column) if stem(state.name) == name => Some(((row, column), place)),
            _ => None,
        };
        Self { name: name.to_owned(), places: description.states.iter().enumerate().filter_map(entry).collect() }
    }

    /// The rotations that these entries show, if those are all that the mechanism can do.
    fn rotations(&self, x: &DVector<f64>, rates: &DVector<f64>, by_state: &DMatrix<f64>) -> Option<Vec<Column>> {
        let columns: Vec<Column> = (0..3).filter_map(|axis| self.rotation(axis, x, rates)).collect();
        let rows: Vec<usize> = self.places.iter().map(|&(_, place)| place).collect();
        // The rates of the entries with the momenta of a body are [w x] R.
        for state in (0..x.len()).filter(|state| !rows.contains(state)) {
            let rate =
                DVector::from_fn(x.len(), |row, _| if rows.contains(&row) { by_state[(row, state)] } else { 0.0 });
            let rest = columns.iter().fold(rate.clone(), |rest, column| {
                let along = column.change.dot(&rate) / column.change.norm_squared();
                rest - &column.change * along
            });
            if rest.norm() > 1e-6 * rate.norm() {
                return None;
            }
        }
        Some(columns)
    }

    /// The change of the entries by a small rotation about an inertial axis; none if it changes none of them, or if
    /// they do not show how.
    fn rotation(&self, axis: usize, x: &DVector<f64>, rates: &DVector<f64>) -> Option<Column> {
        let change = self.turned(axis, x)?;
        // It is linear in R, so that it changes as R does.
        let turning = self.turned(axis, rates)?;
        let owner = self.name.strip_suffix(".orientation").unwrap_or(&self.name);
        let name = format!("{owner}.rotation_{}", ["x", "y", "z"][axis]);
        let coordinate = Coordinate { name, unit: "rad", role: Role::Turn };
        (change.norm() > 1e-3).then_some(Column { coordinate, change, turning })
    }

    /// [e x] R for an axis e, where the entries of R stand in `x`.
    fn turned(&self, axis: usize, x: &DVector<f64>) -> Option<DVector<f64>> {
        // Row `next` becomes minus row `last`, row `last` becomes row `next`.
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut change = DVector::zeros(x.len());
        for &((row, column), place) in &self.places {
            change[place] = match row {
                _ if row == next => -self.entry(last, column, axis, x)?,
                _ if row == last => self.entry(next, column, axis, x)?,
                _ => 0.0,
            };
        }
        Some(change)
    }

    /// An entry of R. One that is no state follows where all that are stand in the plane across `axis`: there
    /// R = [c, -s; s, c].
    fn entry(&self, row: usize, column: usize, axis: usize, x: &DVector<f64>) -> Option<f64> {
        let at = |row: usize, column: usize| {
            let found = self.places.iter().find(|&&(entry, _)| entry == (row, column));
            found.map(|&(_, place)| x[place])
        };
        let is_plane = self.places.iter().all(|&((row, column), _)| row != axis && column != axis);
        at(row, column).or_else(|| match (is_plane, row == column) {
            (false, _) => None,
            (true, true) => at(3 - axis - row, 3 - axis - column),
            (true, false) => at(column, row).map(|other| -other),
        })
    }
}
