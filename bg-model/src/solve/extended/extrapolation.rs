//! One step of the extrapolated midpoint rule, its coefficients rational and so exact in any scalar.
//!
//! Gragg: On extrapolation algorithms for ordinary initial value problems. SIAM Journal on Numerical Analysis 2, 1965;
//! Bulirsch, Stoer: Numerical treatment of ordinary differential equations by extrapolation methods. Numerische
//! Mathematik 8, 1966; Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, section II.9. Column j takes
//! 2j substeps (Deuflhard's harmonic sequence); no smoothing, which costs a rate in each column and stability per rate.

use crate::model::scalar::Scalar;

/// Writes a rate.
pub type Rate<'a, S> = dyn FnMut(S, &[S], &mut [S]) + 'a;
/// Is shown a time (s) and a state.
pub type Pass<'a, S> = dyn FnMut(S, &[S]) + 'a;

/// The method with its memory.
#[derive(Debug)]
pub struct Extrapolation<S> {
    /// The last row of the extrapolation table, a state for each column; its last two entries are of the highest
    /// orders.
    row: Vec<Vec<S>>,
    /// Where the last attempt led.
    pub end: Vec<S>,
}

impl<S: Scalar> Extrapolation<S> {
    /// The method of so many columns for so many states.
    pub fn new(columns: usize, states: usize) -> Self {
        let zero = vec![S::from_f64(0.0); states];
        Self { row: vec![zero.clone(); columns], end: zero }
    }

    /// Makes a step of size `h` (s) from `x` at `t` (s). `pass` is shown the substeps of the finest column, which are
    /// of second order only.
    pub fn attempt(&mut self, t: S, x: &[S], h: S, rate: &mut Rate<'_, S>, pass: &mut Pass<'_, S>) {
        let mut first = vec![S::from_f64(0.0); x.len()];
        rate(t, x, &mut first);
        let columns = self.row.len();
        for j in 0..columns {
            let is_finest = j + 1 == columns;
            let mut value = midpoints(t, x, &first, h, 2 * (j + 1), rate, &mut |t, x| {
                if is_finest {
                    pass(t, x);
                }
            });
            // Aitken and Neville: 1 / ((n_j / n_(j-c))^2 - 1) with n_j = 2 (j + 1).
            for c in 0..j {
                let (fine, coarse) = (((j + 1) * (j + 1)) as f64, ((j - c) * (j - c)) as f64);
                let weight = S::from_f64(coarse) / S::from_f64(fine - coarse);
                for (value, row) in value.iter_mut().zip(&mut self.row[c]) {
                    let next = *value + (*value - *row) * weight;
                    *row = core::mem::replace(value, next);
                }
            }
            self.row[j] = value;
        }
        self.end.copy_from_slice(&self.row[columns - 1]);
    }

    /// The largest difference between the two highest orders, over `tolerance` times the size of each state, or the end
    /// of the step where that is more; not a number where the end is none.
    pub fn error(&self, sizes: &[f64], tolerance: f64) -> f64 {
        let [.., lower, higher] = &self.row[..] else { return f64::NAN };
        let error = |i: usize| {
            let difference = (higher[i] - lower[i]).to_f64().abs();
            // What stays zero has no size.
            if difference == 0.0 { 0.0 } else { difference / (tolerance * sizes[i].max(higher[i].to_f64().abs())) }
        };
        // A NaN stays.
        (0..sizes.len()).map(error).fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
    }
}

/// The midpoint rule over `h` in an even number of substeps, without the last one's smoothing.
fn midpoints<S: Scalar>(
    t: S,
    x: &[S],
    first: &[S],
    h: S,
    substeps: usize,
    rate: &mut Rate<'_, S>,
    pass: &mut Pass<'_, S>,
) -> Vec<S> {
    let part = h / S::from_f64(substeps as f64);
    let double = part + part;
    let mut before = x.to_vec();
    let mut here: Vec<S> = x.iter().zip(first).map(|(x, first)| *x + part * *first).collect();
    let mut dx = first.to_vec();
    for m in 1..substeps {
        let now = t + S::from_f64(m as f64) * part;
        pass(now, &here);
        rate(now, &here, &mut dx);
        // The state after the next half of the way takes the place of the one before.
        before.iter_mut().zip(&dx).for_each(|(before, dx)| *before = *before + double * *dx);
        core::mem::swap(&mut before, &mut here);
    }
    here
}
