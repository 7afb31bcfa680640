//! A = L D L^T of a symmetric definite matrix, with the rows that follow from those before them.
//!
//! Method: Golub and Van Loan, Matrix Computations, algorithm 4.1.2, without pivots, as in the generated rates. D_i
//! over the mobility of row i is the squared sine of the angle between this row of the constraints and the plane of
//! those before it, in the metric of the inverse masses. The mobility is A_ii where the matrix has all rows; where rows
//! are solved it has those that are left beside these, and A_ii itself vanishes where one follows from them.

use alloc::vec;
use alloc::vec::Vec;

use super::{Redundancy, Slip};
use crate::model::scalar::Scalar;

/// A pivot below this part of the row's mobility follows from the rows before it. Rounding leaves some 1e-15 of
/// that, so five digits of the reactions are left here, and a row that does follow comes out far below.
pub(super) const DISTINCT: f64 = 1e-10;

/// A part of a row that is smaller beside it is rounding.
const PART: f64 = 1e-6;

/// A symmetric definite matrix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix<'a, S> {
    /// Its lower triangle by rows.
    pub lower: &'a [S],
    /// The mobilities of the first rows; those of the others are their entries on the diagonal.
    pub mobilities: &'a [S],
}

impl<S> Matrix<'_, S> {
    fn rows(&self) -> usize {
        (0..).find(|&n| row(n) == self.lower.len()).expect("the length of a triangle")
    }
}

/// The factors.
#[derive(Clone, Debug)]
pub(super) struct Factors<S> {
    /// The rows of L up to the diagonal, in whose places D is.
    rows: Vec<S>,
    /// Rows that follow from those before them; they take no part in what comes after.
    follows: Vec<bool>,
    /// The mobilities.
    mobilities: Vec<S>,
}

/// Where row `i` of a packed lower triangle begins.
const fn row(i: usize) -> usize {
    i * (i + 1) / 2
}

impl<S: Scalar> Factors<S> {
    /// Room for `n` rows.
    pub fn new(n: usize) -> Self {
        let zero = S::from_f64(0.0);
        Self { rows: vec![zero; row(n)], follows: vec![false; n], mobilities: vec![zero; n] }
    }

    /// The factors of a matrix.
    pub fn of(matrix: Matrix<'_, S>) -> Self {
        let mut factors = Self::new(matrix.rows());
        factors.factor_where(matrix, |_, pivot, mobility| pivot <= DISTINCT * mobility);
        factors
    }

    /// The factors of a matrix without the rows that are `dropped`.
    pub fn without(matrix: Matrix<'_, S>, dropped: &[bool]) -> Self {
        let mut factors = Self::new(dropped.len());
        factors.factor_where(matrix, |row, _, _| dropped[row]);
        factors
    }

    /// How many rows of a matrix do not follow from others, without those that are `left_out`.
    pub fn rank(matrix: Matrix<'_, S>, left_out: &[bool]) -> usize {
        let mut factors = Self::new(left_out.len());
        factors.factor_where(matrix, |row, pivot, mobility| left_out[row] || pivot <= DISTINCT * mobility);
        factors.follows.iter().filter(|&&follows| !follows).count()
    }

    /// Replaces the factors by those of a matrix; `follows` says of a row, its pivot and its mobility whether it takes
    /// no part. Allocates nothing.
    pub fn factor_where(&mut self, matrix: Matrix<'_, S>, follows: impl Fn(usize, f64, f64) -> bool) {
        self.rows.copy_from_slice(matrix.lower);
        for i in 0..self.follows.len() {
            let [pivot, mobility] = self.factor_row(matrix, i).map(|number| number.to_f64().abs());
            // What is not a number is for the rate to find.
            self.follows[i] = follows(i, pivot, mobility);
        }
    }

    /// The factors of a matrix without the rows that are `dropped`, inlined; writes the pivot and the mobility of each
    /// row.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn factor_without(&mut self, matrix: Matrix<'_, S>, dropped: &[bool], pivots: &mut [[S; 2]]) {
        for i in 0..matrix.lower.len() {
            self.rows[i] = matrix.lower[i];
        }
        for i in 0..dropped.len() {
            pivots[i] = self.factor_row(matrix, i);
            self.follows[i] = dropped[i];
        }
    }

    /// Factors row `i`, of a matrix that stands in the rows; gives its pivot and its mobility.
    #[inline(always)]
    fn factor_row(&mut self, matrix: Matrix<'_, S>, i: usize) -> [S; 2] {
        let (above, rest) = self.rows.split_at_mut(row(i));
        let own = &mut rest[..=i];
        self.mobilities[i] = matrix.mobilities.get(i).copied().unwrap_or(own[i]);
        // The entries are L_ij D_j until all of them are known.
        for j in 0..i {
            for k in 0..j {
                own[j] = own[j] - own[k] * above[row(j) + k];
            }
            if self.follows[j] {
                own[j] = own[j].alike(0.0);
            }
        }
        for j in 0..i {
            if !self.follows[j] {
                let scaled = own[j];
                own[j] = scaled / above[row(j) + j];
                own[i] = own[i] - scaled * own[j];
            }
        }
        [own[i], self.mobilities[i]]
    }

    /// L_ij, below the diagonal.
    fn lower(&self, i: usize, j: usize) -> S {
        self.rows[row(i) + j]
    }

    /// The solution of A y = b; zero in rows that follow.
    pub fn solved(&self, b: &[S]) -> Vec<S> {
        let mut y = b.to_vec();
        self.solve(&mut y);
        y
    }

    /// Replaces b by the solution y of A y = b; zero in rows that follow. Allocates nothing.
    pub fn solve(&self, y: &mut [S]) {
        let n = y.len();
        for i in 0..n {
            for j in 0..i {
                y[i] = y[i] - self.lower(i, j) * y[j];
            }
            if self.follows[i] {
                y[i] = S::from_f64(0.0);
            }
        }
        for i in (0..n).filter(|&i| !self.follows[i]) {
            y[i] = y[i] / self.lower(i, i);
        }
        for i in (0..n).rev() {
            for k in (i + 1..n).filter(|&k| !self.follows[k]) {
                y[i] = y[i] - self.lower(k, i) * y[k];
            }
            if self.follows[i] {
                y[i] = S::from_f64(0.0);
            }
        }
    }

    /// How row `i` is nearest to a combination of those before it: their factors, into the first `i` of `parts`.
    fn combination(&self, i: usize, parts: &mut [S]) {
        for j in (0..i).rev() {
            parts[j] = self.lower(i, j);
            for k in (j + 1..i).filter(|&k| !self.follows[k]) {
                parts[j] = parts[j] - self.lower(k, j) * parts[k];
            }
            if self.follows[j] {
                parts[j] = S::from_f64(0.0);
            }
        }
    }

    /// The first joint that holds what others hold already, those rows apart that are `known` to.
    pub fn redundancy(&self, slips: &[Slip], known: &[bool]) -> Option<Redundancy> {
        let is_new = |i: usize| self.follows[i] && !known[i];
        let first = (0..slips.len()).find(|&i| is_new(i))?;
        let joint = slips[first].joint;
        let rows = (first..slips.len()).filter(|&i| is_new(i) && slips[i].joint == joint);
        Some(self.shared(slips, &rows.collect::<Vec<usize>>()))
    }

    /// Whether row `i` follows from those before it.
    pub fn follows(&self, i: usize) -> bool {
        self.follows[i]
    }

    /// What row `i`, which follows, is made of: A times this is zero.
    pub fn null_vector(&self, i: usize) -> Vec<S> {
        let mut vector = vec![S::from_f64(0.0); self.follows.len()];
        self.combination(i, &mut vector);
        vector[..i].iter_mut().for_each(|part| *part = -*part);
        vector[i] = S::from_f64(1.0);
        vector
    }

    /// What these rows of one joint have in common with the joints of the rows before them.
    pub fn shared(&self, slips: &[Slip], rows: &[usize]) -> Redundancy {
        let joint = slips[rows[0]].joint;
        let mut found = Redundancy { joint, directions: Vec::new(), others: Vec::new() };
        let mut parts = vec![S::from_f64(0.0); slips.len()];
        for &i in rows {
            found.directions.extend(Some(slips[i].direction).filter(|direction| !direction.is_empty()));
            self.combination(i, &mut parts);
            let own = self.mobilities[i].to_f64().abs();
            for (j, slip) in slips[..i].iter().enumerate() {
                let part = parts[j].to_f64() * (self.mobilities[j].to_f64().abs() / own).sqrt();
                if part.abs() > PART && slip.joint != joint && !found.others.contains(&slip.joint) {
                    found.others.push(slip.joint);
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn slip(joint: &'static str, direction: &'static str) -> Slip {
        Slip { joint, direction, unit: "m/s" }
    }

    /// The lower triangle of J J^T.
    fn triangle(rows: &[[f64; 3]]) -> Vec<f64> {
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum();
        (0..rows.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| dot(&rows[i], &rows[j])).collect()
    }

    fn factors(lower: &[f64]) -> Factors<f64> {
        Factors::of(Matrix { lower, mobilities: &[] })
    }

    #[test]
    fn a_definite_matrix_of_either_sign_is_solved() {
        let rows = [[2.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.5, 0.0, 1.0]];
        let x = [1.0, -2.0, 3.0];
        for sign in [1.0, -1.0] {
            let matrix: Vec<f64> = triangle(&rows).iter().map(|entry| sign * entry).collect();
            let entry = |i: usize, j: usize| matrix[row(i.max(j)) + i.min(j)];
            let b: Vec<f64> = (0..3).map(|i| (0..3).map(|j| entry(i, j) * x[j]).sum()).collect();
            let factors = factors(&matrix);
            assert!(factors.solved(&b).iter().zip(x).all(|(y, x)| (y - x).abs() < 1e-14));
            assert_eq!(factors.redundancy(&[slip("a", ""), slip("b", ""), slip("c", "")], &[false; 3]), None);
        }
    }

    #[test]
    fn rows_that_follow_are_named_with_those_they_follow_from() {
        let slips = [slip("a", "in x"), slip("b", "in y"), slip("c", "in x"), slip("d", "in z"), slip("c", "in y")];
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 2.0]);
        let twice: [f64; 3] = core::array::from_fn(|k| 0.1 * x[k] + 0.3 * y[k]);
        let factors = factors(&triangle(&[x, y, twice, z, y]));
        let expected = Redundancy { joint: "c", directions: vec!["in x", "in y"], others: vec!["a", "b"] };
        let found = factors.redundancy(&slips, &[false; 5]).unwrap();
        assert_eq!(found, expected);
        assert_eq!(found.to_string(), "rigid joint `c` holds in x, in y what rigid joints `a`, `b` hold already");
        // The rest is solved as if these rows were not there.
        let solution = factors.solved(&[1.0, 0.0, 5.0, 8.0, 5.0]);
        assert_eq!((solution[2], solution[3], solution[4]), (0.0, 2.0, 0.0));
        assert!((solution[0] - 1.0 / 0.64).abs() < 1e-14, "{solution:?}");
    }

    #[test]
    fn an_angle_of_a_hundred_thousandth_is_the_limit() {
        let slips = [slip("a", ""), slip("b", "")];
        let at = |angle: f64| factors(&triangle(&[[1.0, 0.0, 0.0], [angle.cos(), angle.sin(), 0.0]]));
        assert!(at(2e-5).redundancy(&slips, &[false; 2]).is_none());
        assert!(at(0.5e-5).redundancy(&slips, &[false; 2]).is_some());
        let nothing = factors(&triangle(&[[0.0; 3]])).redundancy(&slips[..1], &[false]).unwrap();
        assert_eq!(nothing.to_string(), "rigid joint `a` holds what cannot move anyway");
    }
    /// A row of which others are solved may have any size: beside its mobility a pivot is what it is with all rows.
    #[test]
    fn a_pivot_is_judged_beside_the_mobility() {
        let of = |pivot: f64| Factors::of(Matrix { lower: &[pivot], mobilities: &[3.0] });
        assert!(!of(4e-10).follows(0) && of(2e-10).follows(0));
    }
}
