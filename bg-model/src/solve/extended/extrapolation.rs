//! One step of the extrapolated midpoint rule, its coefficients rational and so exact in any scalar.
//!
//! Gragg: On extrapolation algorithms for ordinary initial value problems. SIAM Journal on Numerical Analysis 2, 1965;
//! Bulirsch, Stoer: Numerical treatment of ordinary differential equations by extrapolation methods. Numerische
//! Mathematik 8, 1966; Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, section II.9. Column j takes
//! 2j substeps (Deuflhard's harmonic sequence); no smoothing, which costs a rate in each column and stability per rate.

use nalgebra::SVector;

use crate::model::scalar::Scalar;

/// The method with its memory.
#[derive(Debug)]
pub struct Extrapolation<S, const N: usize> {
    columns: usize,
    /// The last row of the extrapolation table; its last two entries are of the highest orders.
    row: Vec<SVector<S, N>>,
    /// Where the last attempt led.
    pub end: SVector<S, N>,
}

impl<S: Scalar, const N: usize> Extrapolation<S, N> {
    pub fn new(columns: usize) -> Self {
        let zero = SVector::from_element(S::from_f64(0.0));
        Self { columns, row: vec![zero; columns], end: zero }
    }

    /// Makes a step of size `h` (s) from `x` at `t` (s). `pass` is shown the substeps of the finest column, which are
    /// of second order only.
    pub fn attempt(
        &mut self,
        t: S,
        x: &SVector<S, N>,
        h: S,
        mut rate: impl FnMut(S, &SVector<S, N>, &mut SVector<S, N>),
        mut pass: impl FnMut(S, &SVector<S, N>),
    ) {
        let mut first = SVector::from_element(S::from_f64(0.0));
        rate(t, x, &mut first);
        for j in 0..self.columns {
            let is_finest = j + 1 == self.columns;
            let mut value = midpoints(t, x, &first, h, 2 * (j + 1), &mut rate, |t, x| {
                if is_finest {
                    pass(t, x);
                }
            });
            // Aitken and Neville: 1 / ((n_j / n_(j-c))^2 - 1) with n_j = 2 (j + 1).
            for c in 0..j {
                let (fine, coarse) = (((j + 1) * (j + 1)) as f64, ((j - c) * (j - c)) as f64);
                let weight = S::from_f64(coarse) / S::from_f64(fine - coarse);
                let row = self.row[c];
                let next = SVector::from_fn(|i, _| value[i] + (value[i] - row[i]) * weight);
                self.row[c] = value;
                value = next;
            }
            self.row[j] = value;
        }
        self.end = self.row[self.columns - 1];
    }

    /// The largest difference between the two highest orders, over `tolerance` times the size of each state, or the end
    /// of the step where that is more; not a number where the end is none.
    pub fn error(&self, sizes: &SVector<f64, N>, tolerance: f64) -> f64 {
        let [.., lower, higher] = &self.row[..] else { return f64::NAN };
        let error = |i: usize| {
            let difference = (higher[i] - lower[i]).to_f64().abs();
            // What stays zero has no size.
            if difference == 0.0 { 0.0 } else { difference / (tolerance * sizes[i].max(higher[i].to_f64().abs())) }
        };
        // A NaN stays.
        (0..N).map(error).fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
    }
}

/// The midpoint rule over `h` in an even number of substeps, without the last one's smoothing.
fn midpoints<S: Scalar, const N: usize>(
    t: S,
    x: &SVector<S, N>,
    first: &SVector<S, N>,
    h: S,
    substeps: usize,
    mut rate: impl FnMut(S, &SVector<S, N>, &mut SVector<S, N>),
    mut pass: impl FnMut(S, &SVector<S, N>),
) -> SVector<S, N> {
    let part = h / S::from_f64(substeps as f64);
    let double = part + part;
    let (mut before, mut here) = (*x, SVector::from_fn(|i, _| x[i] + part * first[i]));
    let mut dx = *first;
    for m in 1..substeps {
        let now = t + S::from_f64(m as f64) * part;
        pass(now, &here);
        rate(now, &here, &mut dx);
        let next = SVector::from_fn(|i, _| before[i] + double * dx[i]);
        (before, here) = (here, next);
    }
    here
}
