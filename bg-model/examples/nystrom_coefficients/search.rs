//! The unknowns with the least sum of squares of the order conditions' violations, of the errors on model oscillators,
//! and of the distances from the start.
//!
//! Method: Levenberg-Marquardt. The violations, their derivatives and the gradient are calculated in double-double
//! arithmetic with dual numbers, so that the minimum is found to the last digits; a triangular factor in double
//! precision gives the steps. Source: J. J. More, The Levenberg-Marquardt algorithm, Lecture Notes in Mathematics 630
//! (1978), 105-116.

use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::scalar::{DoubleDouble, Dual, Scalar};

use crate::coefficients::Coefficients;
use crate::oscillators;
use crate::trees::{Tree, dot, weights};
use crate::{STAGES, widened};

/// The weight of a violation, for a weight 1 of a distance from the start.
const WEIGHT: f64 = 3e3;
/// The same for trees in which no force acts by the momenta: the step must not make an undamped oscillation grow.
const UNDAMPED: f64 = 3e4;
/// The first damping of the steps.
const DAMPING: f64 = 1e-2;
/// The search ends where a step is shorter.
const CONVERGED: f64 = 1e-15;
/// More steps than this mean that it does not converge.
const MOST_STEPS: usize = 200;

type Extended = Dual<DoubleDouble>;

/// A point of the search.
struct Point {
    unknowns: Vec<f64>,
    /// Of the weighted violations and errors: a row for each, its derivatives in the columns.
    derivatives: DMatrix<f64>,
    gradient: DVector<f64>,
    /// The sum of squares; its derivative is twice the gradient.
    squares: f64,
}

/// The minimum next to the start.
pub fn minimum(trees: &[Tree], start: &[f64]) -> Vec<f64> {
    let mut point = Point::at(trees, start, start.to_vec());
    let mut damping = DAMPING;
    for step in 1..=MOST_STEPS {
        let change = point.step(damping);
        let unknowns = point.unknowns.iter().zip(&change).map(|(x, change)| x + change).collect();
        let next = Point::at(trees, start, unknowns);
        println!("step {step}: squares {:.9e}, change {:.1e}", next.squares, change.amax());
        if change.amax() < CONVERGED {
            return next.unknowns;
        }
        let is_better = next.squares <= point.squares * (1.0 + f64::EPSILON);
        damping *= if is_better { 0.1 } else { 10.0 };
        if is_better {
            point = next;
        }
    }
    panic!("the search does not converge");
}

impl Point {
    fn at(trees: &[Tree], start: &[f64], unknowns: Vec<f64>) -> Self {
        let wide = widened(&unknowns);
        let columns: Vec<Vec<Extended>> = (0..wide.len()).map(|along| residuals(trees, &wide, along)).collect();
        let distances: Vec<f64> = unknowns.iter().zip(start).map(|(x, start)| x - start).collect();
        let values: Vec<DoubleDouble> = columns[0].iter().map(|residual| residual.value).collect();
        let slopes = |column: &[Extended]| column.iter().map(|residual| residual.slope).collect::<Vec<_>>();
        let gradient = columns
            .iter()
            .zip(&distances)
            .map(|(column, distance)| (dot(&slopes(column), &values) + DoubleDouble::from(*distance)).to_f64());
        let gradient = DVector::from_iterator(columns.len(), gradient);
        let derivatives =
            DMatrix::from_fn(values.len(), columns.len(), |row, column| columns[column][row].slope.to_f64());
        let squares = dot(&values, &values).to_f64() + dot(&distances, &distances);
        Self { unknowns, derivatives, gradient, squares }
    }

    /// The damped step of Gauss and Newton.
    fn step(&self, damping: f64) -> DVector<f64> {
        let (rows, columns) = self.derivatives.shape();
        let mut stacked = self.derivatives.clone().resize_vertically(rows + columns, 0.0);
        stacked.rows_mut(rows, columns).fill_diagonal((1.0 + damping).sqrt());
        let factor = stacked.qr().r();
        let half = factor.tr_solve_upper_triangular(&-&self.gradient).expect("the distances make it regular");
        factor.solve_upper_triangular(&half).expect("the distances make it regular")
    }
}

/// The weighted violations and errors at the unknowns, with their derivatives along one of them.
fn residuals(trees: &[Tree], unknowns: &[DoubleDouble], along: usize) -> Vec<Extended> {
    let dual = |(index, value): (usize, &DoubleDouble)| {
        Dual::new(*value, DoubleDouble::from(if index == along { 1.0 } else { 0.0 }))
    };
    let unknowns: Vec<Extended> = unknowns.iter().enumerate().map(dual).collect();
    let weight = |tree: &Tree| Extended::from_f64(if tree.by_momenta == 0 { UNDAMPED } else { WEIGHT });
    let method = Coefficients::from_unknowns(&unknowns);
    let violations = violations(trees, &method).into_iter().map(|(tree, violation)| weight(tree) * violation);
    violations.chain(oscillators::errors(&method)).collect()
}

/// The largest violation of the trees that are asked for, in parts of their values.
pub fn largest_violation(trees: &[Tree], found: &Coefficients<DoubleDouble>, asked: impl Fn(&Tree) -> bool) -> f64 {
    let asked = violations(trees, found).into_iter().filter(|(tree, _)| asked(tree));
    asked.map(|(_, violation)| violation.abs().to_f64()).fold(0.0, f64::max)
}

/// The violations of the trees up to order 5, and of those of order 6 in which no force acts by the momenta, in parts
/// of their values: for the momenta and, whose order is one more, for the positions.
fn violations<'a, S: Scalar>(trees: &'a [Tree], found: &Coefficients<S>) -> Vec<(&'a Tree, S)> {
    let Coefficients { instants, first, second } = found;
    let of = |row: &[S], weight: &[S], exact: f64| dot(row, weight) / S::from_f64(exact) - S::from_f64(1.0);
    let mut violations = Vec::new();
    for (tree, weight) in trees.iter().zip(weights(trees, instants, first, second)) {
        let order = tree.order as f64;
        if tree.order <= 5 || tree.by_momenta == 0 {
            violations.push((tree, of(&first[STAGES], &weight, tree.exact / order)));
        }
        if tree.order <= 5 {
            violations.push((tree, of(&second[STAGES], &weight, tree.exact / (order * (order + 1.0)))));
        }
    }
    violations
}
