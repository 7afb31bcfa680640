//! How the values of a parameter are spread, and points drawn from several of them.
//!
//! In: a distribution for each parameter, correlations, a seed, the number of a sample. Out: values, the same on every
//! machine. Method: numbers from 0 to 1 by PCG (O'Neill 2014), seeded by the sample, through the inverse of the
//! distribution; correlated ones through a normal distribution of several numbers (a Gaussian copula), whose matrix has
//! the given correlations. For Sobol indices each sample has two points A and B, and A with each parameter taken from B
//! (A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259).

use bg_model::nalgebra::{Cholesky, DMatrix, Dyn};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::Deserialize;

/// How the values of a parameter are spread, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Mean, standard deviation.
    Normal(f64, f64),
    /// The same, cut at two ends: mean and standard deviation before that, the ends.
    Truncated(f64, f64, f64, f64),
    /// Evenly between two ends.
    Uniform(f64, f64),
    /// Between two ends, most often at a value: lower end, value, upper end.
    Triangular(f64, f64, f64),
    /// Median, standard deviation of the natural logarithm.
    LogNormal(f64, f64),
}

impl Distribution {
    /// A sentence on what is wrong with it.
    ///
    /// # Errors
    /// That sentence.
    pub fn check(&self) -> Result<(), String> {
        let (numbers, is_right, form) = match *self {
            Self::Normal(mean, deviation) => {
                (vec![mean, deviation], deviation > 0.0, "normal = [mean, deviation], the deviation above 0")
            }
            Self::Truncated(mean, deviation, lower, upper) => (
                vec![mean, deviation, lower, upper],
                deviation > 0.0 && lower < upper && self.part() > 0.0,
                "truncated = [mean, deviation, lower, upper], the deviation above 0 and the ends apart and not far \
                from the mean",
            ),
            Self::Uniform(lower, upper) => (vec![lower, upper], lower < upper, "uniform = [lower, upper]"),
            Self::Triangular(lower, mode, upper) => (
                vec![lower, mode, upper],
                lower <= mode && mode <= upper && lower < upper,
                "triangular = [lower, most often, upper]",
            ),
            Self::LogNormal(median, deviation) => (
                vec![median, deviation],
                median > 0.0 && deviation > 0.0,
                "log_normal = [median, deviation of the logarithm], both above 0",
            ),
        };
        if is_right && numbers.iter().all(|number| number.is_finite()) { Ok(()) } else { Err(format!("give {form}")) }
    }

    /// The part of a normal distribution that is left between the ends.
    fn part(&self) -> f64 {
        match *self {
            Self::Truncated(mean, deviation, lower, upper) => {
                below((upper - mean) / deviation) - below((lower - mean) / deviation)
            }
            _ => 1.0,
        }
    }

    /// The value below which this part of all values is, above 0 and below 1.
    #[must_use]
    pub fn quantile(&self, part: f64) -> f64 {
        match *self {
            Self::Normal(mean, deviation) => mean + deviation * normal(part),
            Self::Truncated(mean, deviation, lower, upper) => {
                let from = below((lower - mean) / deviation);
                (mean + deviation * normal(from + part * self.part())).clamp(lower, upper)
            }
            Self::Uniform(lower, upper) => lower + part * (upper - lower),
            Self::Triangular(lower, mode, upper) => {
                let width = upper - lower;
                if part * width < mode - lower {
                    lower + (part * width * (mode - lower)).sqrt()
                } else {
                    upper - ((1.0 - part) * width * (upper - mode)).sqrt()
                }
            }
            Self::LogNormal(median, deviation) => median * libm::exp(deviation * normal(part)),
        }
    }

    /// Mean and standard deviation.
    #[must_use]
    pub fn moments(&self) -> [f64; 2] {
        match *self {
            Self::Normal(mean, deviation) => [mean, deviation],
            Self::Truncated(mean, deviation, lower, upper) => {
                // N. L. Johnson, S. Kotz, N. Balakrishnan, Continuous Univariate Distributions 1 (1994), 13.10.
                let density = |x: f64| libm::exp(-0.5 * x * x) / (2.0 * std::f64::consts::PI).sqrt();
                let [a, b] = [lower, upper].map(|end| (end - mean) / deviation);
                let moved = (density(a) - density(b)) / self.part();
                let square = 1.0 + (a * density(a) - b * density(b)) / self.part() - moved * moved;
                [mean + deviation * moved, deviation * square.sqrt()]
            }
            Self::Uniform(lower, upper) => [0.5 * (lower + upper), (upper - lower) / 12.0_f64.sqrt()],
            Self::Triangular(a, c, b) => {
                [(a + b + c) / 3.0, ((a * a + b * b + c * c - a * b - a * c - b * c) / 18.0).sqrt()]
            }
            Self::LogNormal(median, deviation) => {
                let square = libm::exp(deviation * deviation);
                [median * square.sqrt(), median * (square * (square - 1.0)).sqrt()]
            }
        }
    }
}

/// The part of a normal distribution below `x` standard deviations.
fn below(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// The number of standard deviations below which this part of a normal distribution is: M. J. Wichura, Algorithm AS
/// 241, Applied Statistics 37 (1988) 477.
fn normal(part: f64) -> f64 {
    const MIDDLE: [[f64; 8]; 2] = [
        [
            3.387_132_872_796_366_5,
            133.141_667_891_784_38,
            1_971.590_950_306_551_3,
            13_731.693_765_509_46,
            45_921.953_931_549_87,
            67_265.770_927_008_7,
            33_430.575_583_588_13,
            2_509.080_928_730_122_7,
        ],
        [
            1.0,
            42.313_330_701_600_91,
            687.187_007_492_057_9,
            5_394.196_021_424_751,
            21_213.794_301_586_597,
            39_307.895_800_092_71,
            28_729.085_735_721_943,
            5_226.495_278_852_854,
        ],
    ];
    const NEAR: [[f64; 8]; 2] = [
        [
            1.423_437_110_749_683_5,
            4.630_337_846_156_546,
            5.769_497_221_460_691,
            3.647_848_324_763_204_5,
            1.270_458_252_452_368_4,
            0.241_780_725_177_450_6,
            0.022_723_844_989_269_184,
            7.745_450_142_783_414e-4,
        ],
        [
            1.0,
            2.053_191_626_637_759,
            1.676_384_830_183_803_8,
            0.689_767_334_985_1,
            0.148_103_976_427_480_08,
            0.015_198_666_563_616_457,
            5.475_938_084_995_345e-4,
            1.050_750_071_644_416_9e-9,
        ],
    ];
    const FAR: [[f64; 8]; 2] = [
        [
            6.657_904_643_501_103,
            5.463_784_911_164_114,
            1.784_826_539_917_291_3,
            0.296_560_571_828_504_87,
            0.026_532_189_526_576_124,
            1.242_660_947_388_078_4e-3,
            2.711_555_568_743_487_6e-5,
            2.010_334_399_292_288e-7,
        ],
        [
            1.0,
            0.599_832_206_555_888,
            0.136_929_880_922_735_8,
            0.014_875_361_290_850_615,
            7.868_691_311_456_133e-4,
            1.846_318_317_510_054_8e-5,
            1.421_511_758_316_446e-7,
            2.044_263_103_389_939_8e-15,
        ],
    ];
    let quotient = |[above, below]: &[[f64; 8]; 2], r: f64| {
        let sum = |of: &[f64; 8]| of.iter().rev().fold(0.0, |sum, factor| sum * r + factor);
        sum(above) / sum(below)
    };
    let off = part - 0.5;
    if off.abs() <= 0.425 {
        return off * quotient(&MIDDLE, 0.180_625 - off * off);
    }
    let r = (-libm::log(part.min(1.0 - part))).sqrt();
    let size = if r <= 5.0 { quotient(&NEAR, r - 1.6) } else { quotient(&FAR, r - 5.0) };
    size.copysign(off)
}

/// Points drawn from several distributions.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    distributions: Vec<Distribution>,
    seed: u64,
    /// The lower factor of the matrix of correlations; without one they are independent.
    factor: Option<DMatrix<f64>>,
    /// Whether each sample has the points for Sobol indices.
    has_indices: bool,
}

impl Drawn {
    /// From these distributions, with correlations of some of them by their places.
    ///
    /// # Errors
    /// A sentence: there are no numbers with such correlations, or indices of correlated ones.
    pub fn new(
        distributions: Vec<Distribution>,
        correlations: &[(usize, usize, f64)],
        seed: u64,
        has_indices: bool,
    ) -> Result<Self, String> {
        if has_indices && !correlations.is_empty() {
            return Err("Sobol indices are of independent parameters; leave out indices or correlations".to_owned());
        }
        let count = distributions.len();
        let mut matrix = DMatrix::identity(count, count);
        for &(a, b, value) in correlations {
            if a == b || !(-1.0..=1.0).contains(&value) {
                return Err("a correlation is of two parameters, from -1 to 1".to_owned());
            }
            (matrix[(a, b)], matrix[(b, a)]) = (value, value);
        }
        let none = "no numbers have these correlations: they contradict each other; make them smaller";
        let factor = if correlations.is_empty() {
            None
        } else {
            let found: Cholesky<f64, Dyn> = Cholesky::new(matrix).ok_or(none)?;
            Some(found.l())
        };
        Ok(Self { distributions, seed, factor, has_indices })
    }

    /// How many runs a sample has.
    #[must_use]
    pub fn width(&self) -> usize {
        if self.has_indices { self.distributions.len() + 2 } else { 1 }
    }

    /// The distributions.
    #[must_use]
    pub fn distributions(&self) -> &[Distribution] {
        &self.distributions
    }

    /// Whether each sample has the points for Sobol indices.
    #[must_use]
    pub const fn has_indices(&self) -> bool {
        self.has_indices
    }

    /// The covariance of two of the parameters, of correlated ones to first order.
    #[must_use]
    pub fn covariance(&self, a: usize, b: usize) -> f64 {
        let correlation = match &self.factor {
            Some(factor) => (factor.row(a) * factor.row(b).transpose())[0],
            None => f64::from(u8::from(a == b)),
        };
        correlation * self.distributions[a].moments()[1] * self.distributions[b].moments()[1]
    }

    /// The values of a run: of sample `run / width` the point A, the point B, or A with one parameter from B.
    #[must_use]
    pub fn values(&self, run: usize) -> Vec<f64> {
        let (sample, place) = (run / self.width(), run % self.width());
        let mut random = Pcg64Mcg::seed_from_u64(mixed(self.seed, sample as u64));
        let mut point = || -> Vec<f64> { self.distributions.iter().map(|_| inside(&mut random)).collect() };
        let a = point();
        let parts = match place {
            0 => a,
            1 => point(),
            other => {
                let b = point();
                a.into_iter().zip(b).enumerate().map(|(k, (a, b))| if k + 2 == other { b } else { a }).collect()
            }
        };
        let parts = match &self.factor {
            None => parts,
            Some(factor) => {
                let independent: Vec<f64> = parts.into_iter().map(normal).collect();
                let sum =
                    |row: usize| (0..=row).fold(0.0, |sum, column| sum + factor[(row, column)] * independent[column]);
                (0..independent.len()).map(|row| below(sum(row)).clamp(SMALLEST, 1.0 - SMALLEST)).collect()
            }
        };
        self.distributions.iter().zip(parts).map(|(of, part)| of.quantile(part)).collect()
    }
}

/// The least part that is drawn.
const SMALLEST: f64 = f64::EPSILON / 4.0;

/// A random number between 0 and 1, neither of both.
fn inside(random: &mut impl Rng) -> f64 {
    ((random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

/// A seed for a sample: the finaliser of SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
fn mixed(seed: u64, sample: u64) -> u64 {
    let mut z = seed.wrapping_add(sample.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Distribution; 5] = [
        Distribution::Normal(2.0, 0.5),
        Distribution::Truncated(2.0, 0.5, 1.8, 2.9),
        Distribution::Uniform(-1.0, 3.0),
        Distribution::Triangular(1.0, 1.5, 4.0),
        Distribution::LogNormal(2.0, 0.3),
    ];

    #[test]
    fn the_inverse_of_a_normal_distribution_is_exact() {
        for part in [1e-12, 1e-6, 0.02, 0.07, 0.3, 0.5, 0.6, 0.93, 0.999, 1.0 - 1e-9] {
            let back = below(normal(part));
            assert!((back - part).abs() < 4e-15 * part.max(1e-3), "{part}: {back}");
        }
        assert!((normal(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
    }

    #[test]
    fn moments_are_those_of_the_quantiles() {
        const COUNT: usize = 400_000;
        for of in ALL {
            of.check().unwrap();
            let values = || (0..COUNT).map(|k| of.quantile((k as f64 + 0.5) / COUNT as f64));
            let mean = values().sum::<f64>() / COUNT as f64;
            let deviation = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / COUNT as f64).sqrt();
            let [known_mean, known_deviation] = of.moments();
            assert!((mean - known_mean).abs() < 1e-5 && (deviation - known_deviation).abs() < 1e-4, "{of:?}");
        }
        assert!(Distribution::Normal(1.0, -1.0).check().is_err());
        assert!(Distribution::Triangular(1.0, 5.0, 4.0).check().unwrap_err().contains("most often"));
        assert!(Distribution::Truncated(0.0, 1.0, 60.0, 61.0).check().is_err());
    }

    #[test]
    fn correlated_numbers_have_their_correlation_and_their_own_spread() {
        let two = vec![Distribution::Normal(1.0, 2.0), Distribution::Normal(-3.0, 0.5)];
        let drawn = Drawn::new(two, &[(0, 1, -0.7)], 5, false).unwrap();
        let values: Vec<Vec<f64>> = (0..40_000).map(|run| drawn.values(run)).collect();
        let mean = |k: usize| values.iter().map(|of| of[k]).sum::<f64>() / values.len() as f64;
        let [a, b] = [mean(0), mean(1)];
        let sum = |f: &dyn Fn(&Vec<f64>) -> f64| values.iter().map(f).sum::<f64>() / values.len() as f64;
        let covariance = sum(&|of| (of[0] - a) * (of[1] - b));
        let spread = [sum(&|of| (of[0] - a).powi(2)), sum(&|of| (of[1] - b).powi(2))];
        assert!((covariance / (spread[0] * spread[1]).sqrt() + 0.7).abs() < 0.01, "{covariance}");
        assert!((spread[0] - 4.0).abs() < 0.1 && (drawn.covariance(0, 1) + 0.7).abs() < 1e-12);
        let contradiction = [(0, 1, 0.9), (1, 2, 0.9), (0, 2, -0.9)];
        assert!(Drawn::new(ALL[..3].to_vec(), &contradiction, 1, false).unwrap_err().contains("contradict"));
        assert!(Drawn::new(ALL[..2].to_vec(), &[(0, 1, 0.5)], 1, true).unwrap_err().contains("independent"));
    }

    #[test]
    fn the_points_of_a_sample_differ_in_one_parameter() {
        let drawn = Drawn::new(ALL[..3].to_vec(), &[], 1, true).unwrap();
        assert_eq!(drawn.width(), 5);
        let [a, b] = [drawn.values(10), drawn.values(11)];
        for k in 0..3 {
            let mixed = drawn.values(12 + k);
            assert!((0..3).all(|l| mixed[l] == if l == k { b[l] } else { a[l] }), "{mixed:?}");
        }
        assert_ne!(drawn.values(0), drawn.values(5));
    }
}
