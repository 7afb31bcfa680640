//! Eigenvalues and eigenvectors of a real matrix whose entries differ by many orders of magnitude.
//!
//! In: a square matrix. Out: eigenvalues, with right and left eigenvectors.
//! Method: balancing by a diagonal similarity (Parlett and Reinsch, Numerische Mathematik 13, 1969), without which
//! eigenvalues of a badly scaled matrix are wrong in all digits; then eigenvalues zero are split off by null spaces
//! until the rest is regular, since they are Jordan blocks of free motions, which rounding would spread to its square
//! root (staircase algorithm: Golub and Wilkinson, SIAM Review 18, 1976); then the QR algorithm. Vectors by inverse
//! iteration on the balanced matrix (Wilkinson, The Algebraic Eigenvalue Problem, chapter 9), scaled back.

use bg_model::nalgebra::linalg::balancing::balance_parlett_reinsch;
use bg_model::nalgebra::{Complex, DMatrix, DVector, Schur};

/// Singular values below this part of the largest one count as zero.
const SINGULAR: f64 = 1e-13;
/// Eigenvalues nearer than this part of the largest one count as one.
const EQUAL: f64 = 1e-9;

/// An eigenvalue with its vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct EigenPair {
    /// The eigenvalue, 1/s.
    pub value: Complex<f64>,
    /// A v = value v. Its largest component in balanced coordinates is 1.
    pub right: DVector<Complex<f64>>,
    /// How much each coordinate takes part, not negative, 1 together: |w_k v_k| with w^T A = value w^T, which does not
    /// depend on units (participation factors: Perez-Arriaga, Verghese and Schweppe, IEEE Transactions on Power
    /// Apparatus and Systems 101, 1982). Of an eigenvalue that is not alone |v_k|^2 in balanced coordinates.
    pub shares: DVector<f64>,
}

/// A matrix with its balanced form.
pub(super) struct Balanced {
    /// D^-1 A D.
    pub matrix: DMatrix<f64>,
    /// The diagonal of D: powers of two.
    pub scales: DVector<f64>,
}

impl Balanced {
    /// `matrix` must be square and finite.
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let mut balanced = matrix.clone();
        let scales = balance_parlett_reinsch(&mut balanced);
        Self { matrix: balanced, scales }
    }

    /// The eigenvalues, the smallest first, of a pair that with the positive imaginary part first; none where the QR
    /// algorithm does not converge.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        let size = self.matrix.nrows();
        let regular = without_zeros(self.matrix.clone());
        let mut values = vec![Complex::new(0.0, 0.0); size - regular.nrows()];
        if !regular.is_empty() {
            let schur = Schur::try_new(regular, f64::EPSILON, 1000 * size)?;
            values.extend(schur.complex_eigenvalues().iter());
        }
        values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        // The sizes of a pair can differ by rounding: its members stand together.
        for k in 1..values.len() {
            let after = values[k..].iter().position(|other| *other == values[k - 1].conj());
            if let Some(after) = after.filter(|_| values[k - 1].im != 0.0 && !is_paired(&values[..k])) {
                values[k..=k + after].rotate_right(1);
            }
        }
        for k in 1..values.len() {
            if values[k - 1].im < 0.0 && values[k] == values[k - 1].conj() && !is_paired(&values[..k]) {
                values.swap(k - 1, k);
            }
        }
        Some(values)
    }
}

/// Whether the last of these values has its conjugate before it.
fn is_paired(values: &[Complex<f64>]) -> bool {
    let Some((last, before)) = values.split_last() else { return false };
    let conjugates = before.iter().filter(|other| **other == last.conj()).count();
    let equals = before.iter().filter(|other| *other == last).count();
    conjugates > equals
}

/// What is left of a matrix when its eigenvalues zero are split off.
fn without_zeros(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    let scale = matrix.amax();
    loop {
        let size = matrix.nrows();
        if size == 0 || matrix.amax() == 0.0 {
            return DMatrix::zeros(0, 0);
        }
        // With an orthogonal Q whose last columns span the null space, the last columns of Q^T A Q are zero.
        let svd = matrix.clone().svd(false, true);
        let largest = svd.singular_values.max().max(scale);
        let Some(rows) = svd.v_t else { return matrix };
        let regular: Vec<usize> = (0..size).filter(|&k| svd.singular_values[k] > SINGULAR * largest).collect();
        if regular.len() == size {
            return matrix;
        }
        let kept = rows.select_rows(&regular);
        matrix = &kept * matrix * kept.transpose();
    }
}

/// The eigenvalues with their vectors, one of each conjugate pair: that with the positive imaginary part. None where
/// the QR algorithm does not converge.
#[must_use]
pub fn eigen_pairs(matrix: &DMatrix<f64>) -> Option<Vec<EigenPair>> {
    let balanced = Balanced::of(matrix);
    let values = balanced.eigenvalues()?;
    let size = values.last().map_or(0.0, |value| value.norm());
    let shown: Vec<Complex<f64>> = values.into_iter().filter(|value| value.im >= 0.0).collect();
    let transposed = balanced.matrix.transpose();
    let mut pairs: Vec<EigenPair> = Vec::new();
    while pairs.len() < shown.len() {
        let value = shown[pairs.len()];
        let equal =
            shown[pairs.len()..].iter().take_while(|other| (*other - value).norm() <= EQUAL * size).count().max(1);
        for right in vectors(&balanced.matrix, value, equal) {
            let left = (equal == 1).then(|| vector(&transposed, value, &[]));
            let shares = left.map_or_else(
                || right.map(|component| component.norm_sqr()),
                |left| right.zip_map(&left, |right, left| (right * left).norm()),
            );
            let shares = &shares / shares.sum();
            let right = right.zip_map(&balanced.scales, |component, scale| component * scale);
            pairs.push(EigenPair { value: shown[pairs.len()], right, shares });
        }
    }
    Some(pairs)
}

/// The vectors of `count` equal eigenvalues: each with a component that the others do not have, so that motions that
/// have nothing to do with each other stay apart.
fn vectors(matrix: &DMatrix<f64>, value: Complex<f64>, count: usize) -> Vec<DVector<Complex<f64>>> {
    let mut found: Vec<DVector<Complex<f64>>> = Vec::new();
    for _ in 0..count {
        let next = vector(matrix, value, &found);
        found.push(next);
    }
    for k in 0..count {
        let pivot = found[k].icamax();
        for other in (0..count).filter(|&other| other != k) {
            let without = &found[other] - &found[k] * (found[other][pivot] / found[k][pivot]);
            // A Jordan block has one vector only, which stands for all.
            if without.norm() > 1e-6 * found[other].norm() {
                found[other] = with_largest_one(&without);
            }
        }
    }
    found
}

/// The vector whose largest component is 1.
fn with_largest_one(vector: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let larger = |a: Complex<f64>, b: Complex<f64>| if b.norm() > a.norm() * (1.0 + 1e-9) { b } else { a };
    let largest = vector.iter().copied().reduce(larger);
    largest.filter(|largest| largest.norm() > 0.0).map_or(vector.clone(), |largest| vector / largest)
}

/// An eigenvector by inverse iteration, where there is one orthogonal to those `known` of nearly the same value.
fn vector(matrix: &DMatrix<f64>, value: Complex<f64>, known: &[DVector<Complex<f64>>]) -> DVector<Complex<f64>> {
    let size = matrix.nrows();
    // A shift by rounding keeps the factors regular.
    let scale = matrix.norm().max(f64::MIN_POSITIVE);
    let shifted = value + Complex::new(2.0 * f64::EPSILON * scale, 0.0);
    let complex = matrix.map(|entry| Complex::new(entry, 0.0));
    let factors = (&complex - DMatrix::from_diagonal_element(size, size, shifted)).lu();
    // A start that no symmetry makes orthogonal to the vector.
    let start = DVector::from_fn(size, |k, _| Complex::new(1.0 + 0.37 * ((k * k + 3 * k) % 11) as f64, 0.0));
    let iterate = |known: &[DVector<Complex<f64>>]| {
        let mut vector = start.clone();
        for _ in 0..4 {
            known.iter().for_each(|other| vector -= other * (other.dotc(&vector) / other.norm_squared()));
            let Some(next) = factors.solve(&vector) else { break };
            if !next.iter().all(|component| component.re.is_finite() && component.im.is_finite()) {
                break;
            }
            vector = next.unscale(next.norm());
        }
        with_largest_one(&vector)
    };
    let apart = iterate(known);
    let is_vector = (&complex * &apart - &apart * value).norm() <= 1e-7 * scale * apart.norm();
    // A Jordan block has one vector only.
    if known.is_empty() || is_vector { apart } else { iterate(&[]) }
}
