//! Whether what a fit leaves of a measured column is noise.
//!
//! In: residuals in the order of time, the column's own spread, how exact the run is. Out: their size, how they are
//! correlated from sample to sample, and why they are no noise, where they are none.
//! Method: of noise that is independent from sample to sample, each sample autocorrelation of n values is normal with a
//! standard deviation of n^(-1/2) (M. S. Bartlett, On the theoretical specification and sampling properties of
//! autocorrelated time-series, Supplement to the Journal of the Royal Statistical Society 8 (1946) 27-41). The first
//! lags are looked at, since an oscillation may be sampled at quarters of its period. It is taken about zero, not about
//! the mean: noise has none.

/// What a fit leaves of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// The root of the mean square of the residuals, in the output's unit: the noise, where they are noise.
    pub size: f64,
    /// The root of the mean square of what the column is off its own mean, in the output's unit.
    pub spread: f64,
    /// The autocorrelation of largest magnitude among the first lags; 0 of too few values for one.
    pub correlation: f64,
    /// Its lag: from each value to the one so many later.
    pub lag: usize,
    /// Why it is no noise, if so.
    pub fault: Option<NoNoise>,
}

/// Why residuals are no noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoNoise {
    /// They go on from sample to sample.
    Correlated,
    /// They are larger than those of a constant would be.
    Large,
}

/// The most lags that are looked at, and the part of the values that the largest one may be.
const LAGS: usize = 10;
const PART: usize = 4;
/// So many standard deviations are no chance: of ten lags of independent noise one is beyond them once in 1500 columns.
const CHANCE: f64 = 4.0;
/// Correlations up to this one make an interval too narrow by less than a fourth: by sqrt((1 + r) / (1 - r)) where they
/// fall off as powers.
const SLIGHT: f64 = 0.2;

/// What the `residuals` of a column are; below `error` they are the run's own, which no noise is asked of.
pub(super) fn left(residuals: &[f64], spread: f64, error: f64) -> Left {
    let count = residuals.len().max(1) as f64;
    let square = residuals.iter().fold(0.0, |sum, residual| sum + residual * residual) / count;
    let (lag, correlation) = largest(residuals, square * count);
    let deviations = correlation.abs() * count.sqrt();
    let fault = if square <= error * error {
        None
    } else if correlation.abs() > SLIGHT && deviations > CHANCE {
        Some(NoNoise::Correlated)
    } else if square > spread * spread * (1.0 + CHANCE * CHANCE / count) {
        // Of noise about the right values the two differ by the square of its mean, which is normal with variance / n.
        Some(NoNoise::Large)
    } else {
        None
    };
    Left { size: square.sqrt(), spread, correlation, lag, fault }
}

/// The lag whose autocorrelation has the largest magnitude, and that.
fn largest(residuals: &[f64], squares: f64) -> (usize, f64) {
    let correlation = |lag: usize| {
        let pairs = residuals.iter().zip(&residuals[lag..]);
        pairs.fold(0.0, |sum, (here, later)| sum + here * later) / squares
    };
    let lags = (1..=LAGS.min(residuals.len() / PART)).map(|lag| (lag, correlation(lag)));
    lags.filter(|(_, value)| value.is_finite())
        .fold((1, 0.0), |best: (usize, f64), here| if here.1.abs() > best.1.abs() { here } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even noise of the generator MMIX of Knuth, The Art of Computer Programming, vol. 2, 3.3.4.
    fn noise(seed: u64, count: usize) -> Vec<f64> {
        let mut state = seed;
        let mut even = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..count).map(|_| even()).collect()
    }

    #[test]
    fn independent_noise_is_noise_whatever_its_size_beside_the_column() {
        for seed in 1..200 {
            for count in [3, 20, 200, 2000] {
                let residuals = noise(seed, count);
                let rms = (residuals.iter().map(|value| value * value).sum::<f64>() / count as f64).sqrt();
                for spread in [rms, 100.0 * rms] {
                    let left = left(&residuals, spread, 0.0);
                    assert!(left.fault.is_none() && (left.size / rms - 1.0).abs() < 1e-12, "{seed} {count} {left:?}");
                }
            }
        }
    }

    #[test]
    fn oscillations_and_offsets_are_no_noise_at_whatever_rate_they_are_sampled() {
        // Per sample: slow, a quarter of a turn, half a turn; a rest of 0 turns is an offset.
        for turns in [0.0, 0.01, 0.1, 0.25, 0.3, 0.5] {
            let wave = |k: usize, noise: f64| (std::f64::consts::TAU * turns * k as f64 + 0.4).cos() + noise;
            let residuals: Vec<f64> = noise(7, 100).into_iter().enumerate().map(|(k, noise)| wave(k, noise)).collect();
            let left = left(&residuals, 50.0, 0.0);
            assert!(left.fault == Some(NoNoise::Correlated) && left.correlation.abs() > 0.5, "{turns} {left:?}");
        }
    }

    #[test]
    fn what_is_larger_than_the_column_s_spread_is_no_noise() {
        let residuals = noise(3, 100);
        let rms = left(&residuals, 1.0, 0.0).size;
        assert_eq!(left(&residuals, 0.8 * rms, 0.0).fault, Some(NoNoise::Large));
    }

    #[test]
    fn of_the_run_s_own_error_no_noise_is_asked() {
        let slow: Vec<f64> = (0..100).map(|k| 1e-7 * (0.05 * f64::from(k)).sin()).collect();
        assert_eq!(left(&slow, 1.0, 1e-6).fault, None);
        assert_eq!(left(&slow, 1.0, 1e-9).fault, Some(NoNoise::Correlated));
        assert_eq!(left(&[0.0; 50], 1.0, 0.0), Left { size: 0.0, spread: 1.0, correlation: 0.0, lag: 1, fault: None });
    }
}
