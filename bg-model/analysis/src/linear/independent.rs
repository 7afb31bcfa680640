//! Which rows of a matrix are independent, and how the others follow from them.
//!
//! In: a matrix, a rank of preference for each row. Out: indices of independent rows, and the factors that give all
//! rows from these.
//! Method: rows and columns are scaled to length 1; Gram and Schmidt's orthogonalisation, done twice against rounding,
//! with the largest remaining row of the best rank as pivot (coordinate partitioning: Wehage and Haug, Journal of
//! Mechanical Design 104, 1982; Golub and Van Loan, Matrix Computations, section 5.4).

use bg_model::nalgebra::{DMatrix, DVector};

/// What remains of a row of length 1 counts as zero below this.
const DEPENDENT: f64 = 1e-8;
/// Entries below this part of the largest one in their column are rounding.
const ROUNDING: f64 = 1e-13;

/// Independent rows.
pub(super) struct Independent {
    /// Their indices, in rising order.
    pub rows: Vec<usize>,
    /// The factors: all rows are `factors` times the independent ones.
    pub factors: DMatrix<f64>,
}

/// The independent rows of `matrix`; of two that can stand for each other that with the lower `rank`.
pub(super) fn independent<R: Ord + Copy>(matrix: &DMatrix<f64>, rank: &[R]) -> Independent {
    let (scaled, lengths) = scaled(matrix);
    chosen(scaled, &lengths, rank)
}

/// The independent rows of `matrix`, the largest first, as they are: of two that can stand for each other the longer
/// one.
pub(super) fn longest(matrix: &DMatrix<f64>) -> Vec<usize> {
    let lengths = DVector::repeat(matrix.nrows(), 1.0);
    chosen(by_columns(matrix), &lengths, &vec![0; matrix.nrows()]).rows
}

/// The same of scaled rows, which had these lengths.
fn chosen<R: Ord + Copy>(mut rest: DMatrix<f64>, lengths: &DVector<f64>, rank: &[R]) -> Independent {
    let rows = rest.nrows();
    let mut chosen: Vec<usize> = Vec::new();
    let mut along: Vec<DVector<f64>> = Vec::new();
    let mut ranks = rank.to_vec();
    ranks.sort_unstable();
    ranks.dedup();
    for now in ranks {
        loop {
            let open = (0..rows).filter(|row| rank[*row] == now && !chosen.contains(row));
            let pivot = open.map(|row| (rest.row(row).norm(), row)).filter(|(norm, _)| *norm > DEPENDENT);
            let Some((_, pivot)) = pivot.reduce(|a, b| if b.0 > a.0 * (1.0 + 1e-9) { b } else { a }) else { break };
            let direction = rest.row(pivot).normalize();
            let mut part = DVector::zeros(rows);
            for _ in 0..2 {
                let more = &rest * direction.transpose();
                rest -= &more * &direction;
                part += more;
            }
            chosen.push(pivot);
            along.push(part);
        }
    }
    let factors = factors(&chosen, &along, lengths);
    let mut order: Vec<usize> = (0..chosen.len()).collect();
    order.sort_by_key(|&k| chosen[k]);
    Independent {
        factors: DMatrix::from_fn(rows, chosen.len(), |row, k| factors[(row, order[k])]),
        rows: order.iter().map(|&k| chosen[k]).collect(),
    }
}

/// The matrix with 1 as the largest entry of each column, rounding errors removed.
fn by_columns(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut scaled = matrix.clone();
    for mut column in scaled.column_iter_mut() {
        let largest = column.amax();
        if largest > 0.0 {
            column /= largest;
        }
        column.iter_mut().filter(|entry| entry.abs() < ROUNDING).for_each(|entry| *entry = 0.0);
    }
    scaled
}

/// The matrix with columns and then rows of length 1, rounding errors removed, and the lengths that the rows had.
fn scaled(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let mut scaled = by_columns(matrix);
    let lengths = DVector::from_fn(scaled.nrows(), |row, _| scaled.row(row).norm());
    for (mut row, &length) in scaled.row_iter_mut().zip(&lengths) {
        if length > 0.0 {
            row /= length;
        }
    }
    (scaled, lengths)
}

/// The factors from the parts of all rows along the directions of the chosen ones.
fn factors(chosen: &[usize], along: &[DVector<f64>], lengths: &DVector<f64>) -> DMatrix<f64> {
    let (rows, rank) = (lengths.len(), chosen.len());
    let mut factors = DMatrix::from_fn(rows, rank, |row, k| along[k][row]);
    let square = DMatrix::from_fn(rank, rank, |i, k| if k <= i { along[k][chosen[i]] } else { 0.0 });
    // factors square = along, from the last column on: square is lower triangular.
    for k in (0..rank).rev() {
        for after in k + 1..rank {
            let by = square[(after, k)];
            let column = factors.column(after) * by;
            factors.column_mut(k).zip_apply(&column, |entry, other| *entry -= other);
        }
        factors.column_mut(k).unscale_mut(square[(k, k)]);
    }
    for (row, &length) in lengths.iter().enumerate() {
        for k in 0..rank {
            let factor = factors[(row, k)];
            let is_rounding = factor.abs() < 1e-12;
            factors[(row, k)] = if is_rounding { 0.0 } else { factor * length / lengths[chosen[k]] };
        }
    }
    for (k, &row) in chosen.iter().enumerate() {
        factors.row_mut(row).fill(0.0);
        factors[(row, k)] = 1.0;
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of which rounding is left does not stand for one that is there.
    #[test]
    fn the_longest_rows_are_chosen() {
        let matrix = DMatrix::from_row_slice(3, 1, &[1e-7, 2.0, -3.0]);
        assert_eq!((longest(&matrix), independent(&matrix, &[0; 3]).rows), (vec![2], vec![0]));
    }

    #[test]
    fn dependent_rows_follow_from_the_preferred_ones() {
        // Row 1 is twice row 0 + 3e6 times row 3; row 2 is zero.
        let matrix = DMatrix::from_row_slice(4, 3, &[1.0, 2.0, 0.0, 2.0, 4.0, 3e3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-3]);
        for (rank, rows) in [([0, 0, 0, 1], vec![0, 1]), ([0, 1, 1, 0], vec![0, 3]), ([1, 1, 0, 0], vec![0, 3])] {
            let found = independent(&matrix, &rank);
            assert_eq!(found.rows, rows, "{rank:?}");
            let chosen = matrix.select_rows(&found.rows);
            assert!((&found.factors * chosen - &matrix).amax() < 1e-12 * matrix.amax(), "{}", found.factors);
        }
        assert_eq!(independent(&DMatrix::zeros(3, 2), &[0; 3]).rows, Vec::<usize>::new());
        assert_eq!(independent(&DMatrix::zeros(3, 0), &[0; 3]).factors.shape(), (3, 0));
    }
}
