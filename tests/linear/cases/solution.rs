//! The efforts and flows of all bonds as the solution of one dense system: the equations of all nodes, as they are written.
//!
//! In: a [`Network`] and the states of its storages. Out: efforts and flows. No strokes, no order, no substitution.
//! Method: a row for every component of every port, elimination with the largest entry of a column as pivot.

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

/// The system: coefficients and right side of the rows so far.
struct System<'a> {
    network: &'a Network,
    /// Where the unknowns of each bond start: efforts, then flows.
    starts: &'a [usize],
    coefficients: Vec<Vec<f64>>,
    right: Vec<f64>,
    row: usize,
}

/// Solves a graph; `states` are the momentum or displacement of every node that stores. None where there is no unique solution.
#[must_use]
pub fn solve(network: &Network, states: &[DVector<f64>]) -> Option<Solution> {
    let mut starts = Vec::new();
    let mut size = 0;
    for &(_, _, components) in &network.bonds {
        starts.push(size);
        size += 2 * components;
    }
    let mut system =
        System { network, starts: &starts, coefficients: vec![vec![0.0; size]; size], right: vec![0.0; size], row: 0 };
    for (node, state) in states.iter().enumerate() {
        system.node(node, state);
    }
    assert_eq!(system.row, size, "as many equations as unknowns");
    let unknowns = eliminate(system.coefficients, system.right)?;
    let part = |bond: usize, offset: usize| {
        let components = network.bonds[bond].2;
        DVector::from_column_slice(&unknowns[starts[bond] + offset * components..][..components])
    };
    let bonds = 0..network.bonds.len();
    let (efforts, flows) = bonds.map(|bond| (part(bond, 0), part(bond, 1))).unzip();
    Some(Solution { efforts, flows })
}

/// Gaussian elimination with row exchanges; rows without an entry in the pivot's column, which are most, stay as they are.
fn eliminate(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let size = right.len();
    for k in 0..size {
        let pivot = (k..size).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        // The coefficients are of order one; what cancels leaves some roundings.
        if rows[pivot][k].abs() < 1e-11 {
            return None;
        }
        rows.swap(k, pivot);
        right.swap(k, pivot);
        let (above, below) = rows.split_at_mut(k + 1);
        let (top, value) = (&above[k], right[k]);
        for (row, right) in below.iter_mut().zip(&mut right[k + 1..]) {
            let factor = row[k] / top[k];
            if factor != 0.0 {
                row[k..].iter_mut().zip(&top[k..]).for_each(|(entry, top)| *entry -= factor * top);
                *right -= factor * value;
            }
        }
    }
    for k in (0..size).rev() {
        let known: f64 = (k + 1..size).map(|j| rows[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / rows[k][k];
    }
    Some(right)
}

impl System<'_> {
    /// The column of a component of a bond's effort or flow.
    fn column(&self, bond: usize, role: Role, component: usize) -> usize {
        let components = self.network.bonds[bond].2;
        self.starts[bond] + component + if role == Role::Effort { 0 } else { components }
    }

    /// One equation: the sum of factors times unknowns is `right`.
    fn equation(&mut self, terms: &[(usize, f64)], right: f64) {
        for &(column, factor) in terms {
            self.coefficients[self.row][column] += factor;
        }
        self.right[self.row] = right;
        self.row += 1;
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

    /// A variable of a bond has this value.
    fn is(&mut self, bond: usize, role: Role, sign: f64, value: &DVector<f64>) {
        for (k, &value) in value.iter().enumerate() {
            self.equation(&[(self.column(bond, role, k), sign)], value);
        }
    }

    fn node(&mut self, node: usize, state: &DVector<f64>) {
        let network = self.network;
        let bonds: Vec<(usize, f64)> =
            network.bonds_of(node).map(|(bond, into)| (bond, if into { 1.0 } else { -1.0 })).collect();
        let (bond, sign) = bonds[0];
        match &network.nodes[node].law {
            Law::Zero => self.junction(&bonds, Role::Effort, Role::Flow),
            Law::One => self.junction(&bonds, Role::Flow, Role::Effort),
            Law::Effort(value) => self.is(bond, Role::Effort, 1.0, value),
            Law::Flow(value) => self.is(bond, Role::Flow, 1.0, value),
            Law::Inertia(matrix) => self.is(bond, Role::Flow, sign, &(matrix * state)),
            Law::Stiffness(matrix) => self.is(bond, Role::Effort, 1.0, &(matrix * state)),
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
