//! What the runs of a sweep by tolerances say of a number: how it is spread, and which parameter spreads it.
//!
//! In: the values of a number in all runs, in the order of the runs. Out: mean, deviation, quantiles, each with what it
//! may be off; Sobol indices. Methods: a quantile's interval is that of order statistics (H. A. David, H. N. Nagaraja,
//! Order Statistics (2003), 7.1), by the normal approximation of the binomial distribution; first indices by A.
//! Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, table 2 (b), total ones by M. J. W. Jansen, Comput. Phys.
//! Commun. 117 (1999) 35; their intervals by drawing the samples anew (B. Efron, Ann. Statist. 7 (1979) 1).

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// A value with the ends of the interval that has it with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The ends.
    pub interval: [f64; 2],
}

/// How a number is spread.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// How many values there are.
    pub count: usize,
    /// Their mean.
    pub mean: Estimate,
    /// Their standard deviation.
    pub deviation: Estimate,
    /// The least and the largest one.
    pub range: [f64; 2],
    /// The values below which these parts of all are.
    pub quantiles: Vec<(f64, Estimate)>,
}

/// The parts below which quantiles are.
pub const PARTS: [f64; 5] = [0.01, 0.05, 0.5, 0.95, 0.99];
/// Standard deviations of a normal distribution within which 95 % are.
const WITHIN: f64 = 1.959_963_984_540_054;

/// How these values are spread; none of fewer than two.
#[must_use]
pub fn spread(values: &[f64]) -> Option<Spread> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (first, last) = (*sorted.first()?, *sorted.last()?);
    let count = sorted.len() as f64;
    if sorted.len() < 2 {
        return None;
    }
    let mean = sum(sorted.iter().copied()) / count;
    let moment = |power: i32| sum(sorted.iter().map(|value| (value - mean).powi(power))) / count;
    let (square, fourth) = (moment(2), moment(4));
    let deviation = (square * count / (count - 1.0)).sqrt();
    let about = |value: f64, error: f64| Estimate { value, interval: [value - WITHIN * error, value + WITHIN * error] };
    // The error of a deviation, whatever the distribution: D(s) = sqrt((m4 - m2^2) / n) / (2 s).
    let of_deviation = ((fourth - square * square).max(0.0) / count).sqrt() / (2.0 * deviation).max(f64::MIN_POSITIVE);
    let quantile = |part: f64| {
        let middle = part * count;
        let off = WITHIN * (count * part * (1.0 - part)).sqrt();
        let at = |place: f64| sorted[(place.max(0.0) as usize).min(sorted.len() - 1)];
        let estimate = Estimate {
            value: between(&sorted, part),
            interval: [at((middle - off).floor()), at((middle + off).ceil())],
        };
        (part, estimate)
    };
    Some(Spread {
        count: sorted.len(),
        mean: about(mean, deviation / count.sqrt()),
        deviation: about(deviation, of_deviation),
        range: [first, last],
        quantiles: PARTS.map(quantile).to_vec(),
    })
}

/// A quantile of sorted values, by straight lines between them.
fn between(sorted: &[f64], part: f64) -> f64 {
    let place = part * (sorted.len() - 1) as f64;
    let low = place as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (place - low as f64) * (sorted[high] - sorted[low])
}

fn sum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |sum, value| sum + value)
}

/// How much of a number's variance is one parameter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// By itself.
    pub first: Estimate,
    /// With all that it does together with others.
    pub total: Estimate,
}

/// The Sobol indices of `parameters` parameters; `values` are those of all runs, of each sample A, B and A with each
/// parameter from B. Samples in which a run has failed are left out; none of fewer than eight.
#[must_use]
pub fn indices(values: &[f64], parameters: usize) -> Option<Vec<Index>> {
    const DRAWS: usize = 200;
    const FEWEST: usize = 8;
    let samples: Vec<&[f64]> =
        values.chunks_exact(parameters + 2).filter(|sample| sample.iter().all(|value| value.is_finite())).collect();
    if samples.len() < FEWEST {
        return None;
    }
    let all: Vec<usize> = (0..samples.len()).collect();
    let found = of_samples(&samples, &all, parameters);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut drawn: Vec<Vec<[f64; 2]>> = Vec::with_capacity(DRAWS);
    for _ in 0..DRAWS {
        let place = |_| ((u128::from(random.next_u64()) * samples.len() as u128) >> 64) as usize;
        let chosen: Vec<usize> = (0..samples.len()).map(place).collect();
        drawn.push(of_samples(&samples, &chosen, parameters));
    }
    let estimate = |parameter: usize, which: usize| {
        let mut values: Vec<f64> = drawn.iter().map(|of| of[parameter][which]).collect();
        values.sort_unstable_by(f64::total_cmp);
        let interval = [between(&values, 0.025), between(&values, 0.975)];
        Estimate { value: found[parameter][which], interval }
    };
    Some((0..parameters).map(|of| Index { first: estimate(of, 0), total: estimate(of, 1) }).collect())
}

/// First and total index of each parameter, of the samples with these numbers.
fn of_samples(samples: &[&[f64]], chosen: &[usize], parameters: usize) -> Vec<[f64; 2]> {
    let count = chosen.len() as f64;
    let mean_of = |of: &dyn Fn(&[f64]) -> f64| sum(chosen.iter().map(|&k| of(samples[k]))) / count;
    let mean = mean_of(&|sample| 0.5 * (sample[0] + sample[1]));
    let variance = mean_of(&|sample| 0.5 * ((sample[0] - mean).powi(2) + (sample[1] - mean).powi(2)));
    let part = |value: f64| if variance > 0.0 { value / variance } else { 0.0 };
    (0..parameters)
        .map(|k| {
            let first = mean_of(&|sample| (sample[1] - mean) * (sample[k + 2] - sample[0]));
            let total = 0.5 * mean_of(&|sample| (sample[0] - sample[k + 2]).powi(2));
            [part(first), part(total)]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::distribution::{Distribution, Drawn};
    use super::*;

    /// T. Ishigami, T. Homma (1990): sin a + 7 sin^2 b + c^4 sin(a) / 10.
    fn ishigami(x: &[f64]) -> f64 {
        x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
    }

    #[test]
    fn the_indices_of_ishigamis_function_are_known() {
        let drawn = Drawn::new(vec![Distribution::Uniform(-PI, PI); 3], &[], 3, true).unwrap();
        let values: Vec<f64> = (0..5 * 20_000).map(|run| ishigami(&drawn.values(run))).collect();
        let found = indices(&values, 3).unwrap();
        // In closed form: V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2 with a = 7, b = 0.1.
        let variance = 49.0 / 8.0 + 0.1 * PI.powi(4) / 5.0 + 0.01 * PI.powi(8) / 18.0 + 0.5;
        let first = [0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2) / variance, 49.0 / 8.0 / variance, 0.0];
        let third = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0) / variance;
        let total = [first[0] + third, first[1], third];
        for (k, index) in found.iter().enumerate() {
            assert!((index.first.value - first[k]).abs() < 0.02, "{k}: {index:?}, not {}", first[k]);
            assert!((index.total.value - total[k]).abs() < 0.02, "{k}: {index:?}, not {}", total[k]);
            let Estimate { interval: [low, high], .. } = index.total;
            assert!(low < total[k] + 0.01 && high > total[k] - 0.01 && high - low < 0.05, "{k}: {index:?}");
        }
        assert_eq!(indices(&values[..5 * 4], 3), None);
    }

    #[test]
    fn intervals_have_the_truth_as_often_as_they_say() {
        let of = Distribution::Triangular(0.0, 1.0, 3.0);
        let [mean, deviation] = of.moments();
        let mut held = [0; 3];
        const TRIES: u64 = 400;
        for seed in 0..TRIES {
            let drawn = Drawn::new(vec![of], &[], seed, false).unwrap();
            let values: Vec<f64> = (0..300).map(|run| drawn.values(run)[0]).collect();
            let found = spread(&values).unwrap();
            let (part, quantile) = found.quantiles[3];
            let known = [(found.mean, mean), (found.deviation, deviation), (quantile, of.quantile(part))];
            for (held, (estimate, known)) in held.iter_mut().zip(known) {
                *held += i32::from(estimate.interval[0] <= known && known <= estimate.interval[1]);
            }
        }
        // 95 % of 400 are 380, give or take 9.
        assert!(held.iter().all(|held| (360..=398).contains(held)), "{held:?}");
        assert_eq!(spread(&[1.0, f64::NAN]), None);
    }
}
