//! The efforts and flows of all bonds as the solution of one dense system: the equations of all nodes, as they are
//! written, and their derivatives with respect to time.
//!
//! In: a [`Network`], the states of its storages, those whose states are not given. Out: efforts and flows. No strokes,
//! no order, no substitution.
//! Whether the equations are regular at all: where their Laplace transform has a determinant.
//! Method: a row for every component of every port, and one for its rate; a storage links the rate of one variable to
//! the other one. The rates are eliminated first, with the largest entry of a column as pivot; then efforts and flows
//! must each have a pivot.
use bg_model::nalgebra::{DMatrix, DVector};

use super::network::{Law, Network, Role};

/// The efforts and flows of every bond, along the half arrows.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Efforts.
    pub efforts: Vec<DVector<f64>>,
    /// Flows.
    pub flows: Vec<DVector<f64>>,
}

impl Solution {
    /// The power along a bond's half arrow.
    #[must_use]
    pub fn power(&self, bond: usize) -> f64 {
        self.efforts[bond].dot(&self.flows[bond])
    }
}

/// What the rows of a system are.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Form {
    /// The equations themselves.
    Values,
    /// Their rates.
    Rates,
    /// Their Laplace transform at this frequency, 1/s: a rate is the frequency times the value.
    Transformed(f64),
}

/// The system so far: rows of coefficients, the right side last.
struct System<'a> {
    network: &'a Network,
    /// Where the unknowns of each bond start: efforts, then flows.
    starts: &'a [usize],
    /// How many efforts and flows there are; their rates come before them.
    size: usize,
    /// What the rows are.
    form: Form,
    rows: Vec<Vec<f64>>,
}

/// The components of the momentum or displacement of a node that stores; none of those that others determine.
pub type State = Vec<Option<f64>>;

/// Solves a graph whose nodes have these states. None where there is no unique solution.
#[must_use]
pub fn solve(network: &Network, states: &[State]) -> Option<Solution> {
    let (starts, size) = places(network);
    let mut system = System { network, starts: &starts, size, form: Form::Values, rows: Vec::new() };
    for form in [Form::Values, Form::Rates] {
        system.form = form;
        for (node, state) in states.iter().enumerate() {
            system.node(node, state);
        }
    }
    let unknowns = eliminate(system.rows, size)?;
    let part = |bond: usize, offset: usize| {
        let components = network.bonds[bond].2;
        DVector::from_column_slice(&unknowns[starts[bond] + offset * components..][..components])
    };
    let bonds = 0..network.bonds.len();
    let (efforts, flows) = bonds.map(|bond| (part(bond, 0), part(bond, 1))).unzip();
    Some(Solution { efforts, flows })
}

/// Whether the differential and algebraic equations have one solution for each start that fits: whether the matrix of
/// their Laplace transform is regular, at an arbitrary frequency.
#[must_use]
pub fn is_regular(network: &Network) -> bool {
    let (starts, size) = places(network);
    let mut system = System { network, starts: &starts, size, form: Form::Transformed(FREQUENCY), rows: Vec::new() };
    (0..network.nodes.len()).for_each(|node| system.node(node, &[]));
    eliminate(system.rows, size).is_some()
}

/// 1/s; no root of a graph's characteristic polynomial, whose coefficients are numbers of two digits.
const FREQUENCY: f64 = 0.737_137;

/// Where the unknowns of each bond start, and how many there are.
fn places(network: &Network) -> (Vec<usize>, usize) {
    let mut starts = Vec::new();
    let mut size = 0;
    for &(_, _, components) in &network.bonds {
        starts.push(size);
        size += 2 * components;
    }
    (starts, size)
}

/// The coefficients are of order one; what cancels leaves some roundings.
const NOTHING: f64 = 1e-10;

/// The last `size` unknowns, by Gaussian elimination with row exchanges; none where they are not unique or the rows
/// disagree. Of the unknowns before them some may be open. Rows without an entry in the pivot's column, which are most,
/// stay as they are.
fn eliminate(mut rows: Vec<Vec<f64>>, size: usize) -> Option<Vec<f64>> {
    let columns = rows[0].len() - 1;
    let mut used = 0;
    let mut pivots = Vec::new();
    for column in 0..columns {
        let best = (used..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        let Some(best) = best.filter(|&row| rows[row][column].abs() > NOTHING) else {
            if column >= columns - size {
                return None;
            }
            continue;
        };
        rows.swap(used, best);
        let (above, below) = rows.split_at_mut(used + 1);
        let top = &above[used];
        for row in below {
            let factor = row[column] / top[column];
            if factor != 0.0 {
                row[column..].iter_mut().zip(&top[column..]).for_each(|(entry, top)| *entry -= factor * top);
            }
        }
        pivots.push((used, column));
        used += 1;
    }
    let scale = rows.iter().flatten().fold(1.0, |most: f64, entry| most.max(entry.abs()));
    if rows[used..].iter().any(|row| row[columns].abs() > 1e-7 * scale) {
        return None;
    }
    let mut values = vec![0.0; columns];
    for &(row, column) in pivots.iter().rev().take(size) {
        let known: f64 = (column + 1..columns).map(|j| rows[row][j] * values[j]).sum();
        values[column] = (rows[row][columns] - known) / rows[row][column];
    }
    Some(values.split_off(columns - size))
}

impl System<'_> {
    /// The column of a component of a bond's effort or flow, or of the rate of one.
    fn column_of(&self, form: Form, bond: usize, role: Role, component: usize) -> usize {
        let components = self.network.bonds[bond].2;
        let place = self.starts[bond] + component + if role == Role::Effort { 0 } else { components };
        if form == Form::Rates { place } else { self.size + place }
    }

    fn column(&self, bond: usize, role: Role, component: usize) -> usize {
        self.column_of(self.form, bond, role, component)
    }

    /// One equation: the sum of factors times unknowns is `right`.
    fn equation(&mut self, terms: &[(usize, f64)], right: f64) {
        let mut row = vec![0.0; 2 * self.size + 1];
        terms.iter().for_each(|&(column, factor)| row[column] += factor);
        row[2 * self.size] = right;
        self.rows.push(row);
    }

    /// `left` of one bond = matrix times `right` of another + constant, where flows are multiplied by these signs.
    fn map(
        &mut self,
        (left, left_role, left_sign): (usize, Role, f64),
        matrix: &DMatrix<f64>,
        (right, right_role, right_sign): (usize, Role, f64),
    ) {
        for i in 0..matrix.nrows() {
            let mut terms = vec![(self.column(left, left_role, i), left_sign)];
            terms
                .extend((0..matrix.ncols()).map(|j| (self.column(right, right_role, j), -right_sign * matrix[(i, j)])));
            self.equation(&terms, 0.0);
        }
    }

    /// What a source gives, or its rate; whether a system is regular does not depend on it.
    fn of_source<'v>(&self, [value, rate]: &'v [DVector<f64>; 2]) -> &'v DVector<f64> {
        if self.form == Form::Rates { rate } else { value }
    }

    /// A variable of a bond has this value.
    fn is(&mut self, bond: usize, role: Role, sign: f64, value: &DVector<f64>) {
        for (k, &value) in value.iter().enumerate() {
            self.equation(&[(self.column(bond, role, k), sign)], value);
        }
    }

    /// A storage: one variable is A times the state, whose rate is the other variable. A component of the state that is
    /// known is that of A^-1 times the one variable.
    fn storage(
        &mut self,
        (bond, sign): (usize, f64),
        (of, by): (Role, Role),
        matrix: &DMatrix<f64>,
        state: &[Option<f64>],
    ) {
        let [of_sign, by_sign] = [of, by].map(|role| if role == Role::Flow { sign } else { 1.0 });
        let factor = match self.form {
            Form::Values => {
                let inverse = matrix.clone().try_inverse().expect("a law with an inverse");
                for (i, value) in state.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?))) {
                    let terms: Vec<(usize, f64)> =
                        (0..matrix.ncols()).map(|j| (self.column(bond, of, j), of_sign * inverse[(i, j)])).collect();
                    self.equation(&terms, value);
                }
                return;
            }
            Form::Rates => 1.0,
            Form::Transformed(frequency) => frequency,
        };
        for i in 0..matrix.nrows() {
            let mut terms = vec![(self.column(bond, of, i), of_sign * factor)];
            let entries =
                (0..matrix.ncols()).map(|j| (self.column_of(Form::Values, bond, by, j), -by_sign * matrix[(i, j)]));
            terms.extend(entries);
            self.equation(&terms, 0.0);
        }
    }

    fn node(&mut self, node: usize, state: &[Option<f64>]) {
        let network = self.network;
        let bonds: Vec<(usize, f64)> =
            network.bonds_of(node).map(|(bond, into)| (bond, if into { 1.0 } else { -1.0 })).collect();
        let (bond, sign) = bonds[0];
        match &network.nodes[node].law {
            Law::Zero => self.junction(&bonds, Role::Effort, Role::Flow),
            Law::One => self.junction(&bonds, Role::Flow, Role::Effort),
            Law::Effort(value) => self.is(bond, Role::Effort, 1.0, self.of_source(value)),
            Law::Flow(value) => self.is(bond, Role::Flow, 1.0, self.of_source(value)),
            Law::Inertia(matrix) => self.storage((bond, sign), (Role::Flow, Role::Effort), matrix, state),
            Law::Stiffness(matrix) => self.storage((bond, sign), (Role::Effort, Role::Flow), matrix, state),
            Law::Resistance { matrix, of: Some(Role::Effort) } => {
                self.map((bond, Role::Flow, sign), matrix, (bond, Role::Effort, 1.0));
            }
            Law::Resistance { matrix, .. } => self.map((bond, Role::Effort, 1.0), matrix, (bond, Role::Flow, sign)),
            Law::Transformer { matrix, of } => {
                let (inward, outward) = network.in_and_out(node);
                let (given, back) =
                    if *of == Some(Role::Effort) { (Role::Effort, Role::Flow) } else { (Role::Flow, Role::Effort) };
                self.map((outward, given, 1.0), matrix, (inward, given, 1.0));
                self.map((inward, back, 1.0), &matrix.transpose(), (outward, back, 1.0));
            }
            Law::Gyrator(ratio) => {
                let (inward, outward) = network.in_and_out(node);
                let components = network.bonds[inward].2;
                let matrix = DMatrix::from_diagonal_element(components, components, *ratio);
                self.map((inward, Role::Effort, 1.0), &matrix, (outward, Role::Flow, 1.0));
                self.map((outward, Role::Effort, 1.0), &matrix, (inward, Role::Flow, 1.0));
            }
        }
    }

    fn junction(&mut self, bonds: &[(usize, f64)], common: Role, balanced: Role) {
        for component in 0..self.network.bonds[bonds[0].0].2 {
            for pair in bonds.windows(2) {
                let [one, other] = [pair[0].0, pair[1].0].map(|bond| self.column(bond, common, component));
                self.equation(&[(one, 1.0), (other, -1.0)], 0.0);
            }
            let sum: Vec<(usize, f64)> =
                bonds.iter().map(|&(bond, sign)| (self.column(bond, balanced, component), sign)).collect();
            self.equation(&sum, 0.0);
        }
    }
}
