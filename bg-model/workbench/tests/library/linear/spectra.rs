//! Eigenvalues of matrices with known spectra.

use bg_model::nalgebra::{Complex, DMatrix, DVector};
use bg_workbench::linear::eigen_pairs;

/// 14 pairs and one real eigenvalue, from 1e-3 to 3e3 in size, behind three reflections and a similarity by powers of
/// ten.
fn badly_scaled() -> (DMatrix<f64>, Vec<Complex<f64>>) {
    const SIZE: usize = 29;
    let mut matrix = DMatrix::zeros(SIZE, SIZE);
    let mut values = vec![Complex::new(-0.5, 0.0)];
    for k in 0..14 {
        let (real, imaginary) = (-10.0_f64.powf(k as f64 / 3.0 - 2.0), 10.0_f64.powf(k as f64 / 2.0 - 3.0));
        matrix.view_mut((2 * k, 2 * k), (2, 2)).copy_from_slice(&[real, -imaginary, imaginary, real]);
        values.push(Complex::new(real, imaginary));
    }
    matrix[(28, 28)] = -0.5;
    for turn in 0..3 {
        let v = DVector::from_fn(SIZE, |k, _| ((7 * k * k + 3 * k + 5 * turn) % 13) as f64 - 5.5);
        let reflection = DMatrix::identity(SIZE, SIZE) - &v * v.transpose() * (2.0 / v.norm_squared());
        matrix = &reflection * matrix * reflection;
    }
    let scale = |k: usize| 10.0_f64.powi(((5 * k) % 19) as i32 - 9);
    (DMatrix::from_fn(SIZE, SIZE, |i, j| matrix[(i, j)] * scale(i) / scale(j)), values)
}

/// The largest relative distance of an expected eigenvalue to the nearest one found.
fn distance(found: &[Complex<f64>], expected: &[Complex<f64>]) -> f64 {
    let nearest = |value: &Complex<f64>| found.iter().map(|other| (other - value).norm()).fold(f64::INFINITY, f64::min);
    expected.iter().map(|value| nearest(value) / value.norm()).fold(0.0, f64::max)
}

#[test]
fn a_badly_scaled_matrix_keeps_its_eigenvalues() {
    let (matrix, expected) = badly_scaled();
    let pairs = eigen_pairs(&matrix).unwrap();
    let found: Vec<Complex<f64>> = pairs.iter().map(|pair| pair.value).collect();
    assert_eq!(found.len(), 15);
    let balanced = distance(&found, &expected);
    // Without balancing the digits are lost: this is what the balancing is for.
    let plain = distance(matrix.complex_eigenvalues().as_slice(), &expected);
    println!("balanced {balanced:e}, plain {plain:e}");
    assert!(balanced < 1e-10 && plain > 1e-2, "{balanced:e} {plain:e}");
    for pair in &pairs {
        let matrix = matrix.map(Complex::from);
        let left = &matrix * &pair.right - &pair.right * pair.value;
        // Row by row, as rows differ by powers of ten.
        for (row, left) in left.iter().enumerate() {
            let size: f64 = (0..29).map(|column| (matrix[(row, column)] * pair.right[column]).norm()).sum();
            assert!(left.norm() <= 1e-11 * size, "{} of {size:e}", left.norm());
        }
        assert!((pair.shares.sum() - 1.0).abs() < 1e-12 && pair.shares.min() >= 0.0);
    }
}

#[test]
fn eigenvalues_are_those_of_lapack() {
    // A[i][i - 1] = -1 and A[i][i] to A[i][i + 3] = 1, far from normal: `numpy.linalg.eigvals(A)` of numpy 2.4.6, the
    // members with positive imaginary parts.
    let lapack = [
        (1.5396177308496142, 0.34760400911303485),
        (0.865000338703727, 1.4976082948477),
        (1.4081391688008644, 1.1320104439264),
        (1.58782166423218, 0.9618789933171545),
        (0.4355709013602744, 1.8912512247741764),
        (0.16385019605333684, 2.16612594416337),
    ];
    let grcar = DMatrix::from_fn(12, 12, |i, j| match j as i32 - i as i32 {
        -1 => -1.0,
        0..=3 => 1.0,
        _ => 0.0,
    });
    let pairs = eigen_pairs(&grcar).unwrap();
    assert_eq!(pairs.len(), 6);
    for (pair, (real, imaginary)) in pairs.iter().zip(lapack) {
        assert!((pair.value - Complex::new(real, imaginary)).norm() < 1e-13, "{}", pair.value);
    }
}

#[test]
fn free_motions_are_exactly_zero_beside_fast_ones() {
    // x'' = 0 twice, beside a fast oscillator that both move.
    let mut matrix = DMatrix::zeros(6, 6);
    for (row, column, value) in
        [(0, 1, 1.0), (2, 3, 0.5), (4, 5, 1.0), (5, 4, -1e10), (1, 4, 3.0), (3, 4, -7.0), (5, 5, -20.0)]
    {
        matrix[(row, column)] = value;
    }
    let pairs = eigen_pairs(&matrix).unwrap();
    let sizes: Vec<f64> = pairs.iter().map(|pair| pair.value.norm()).collect();
    assert_eq!(sizes[..4], [0.0; 4]);
    assert!((sizes[4] - 1e5).abs() < 1e-9);
    // Rounding alone would spread a Jordan block of size 2 to the square root of rounding.
    for pair in &pairs[..4] {
        assert!((matrix.map(Complex::from) * &pair.right).norm() < 1e-10, "{}", pair.right);
    }
}

#[test]
fn small_matrices() {
    assert!(eigen_pairs(&DMatrix::zeros(0, 0)).unwrap().is_empty());
    let one = eigen_pairs(&DMatrix::from_element(1, 1, -3.0)).unwrap();
    assert_eq!((one[0].value, one[0].shares[0]), (Complex::new(-3.0, 0.0), 1.0));
    let zero = eigen_pairs(&DMatrix::zeros(2, 2)).unwrap();
    assert!(zero.iter().all(|pair| pair.value == Complex::new(0.0, 0.0)) && zero.len() == 2);
}
