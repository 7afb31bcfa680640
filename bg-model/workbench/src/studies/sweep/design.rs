//! Which values the swept parameters have in each run.
//!
//! In: ranges and lists of values by name, a table, or how many samples. Out: the runs, counted from 0, each with a
//! value for each swept parameter. In a grid the last parameter changes from run to run. A Latin hypercube (McKay,
//! Beckman, Conover, Technometrics 21, 1979) has one run in each of its `count` intervals of every parameter, at a
//! random place in it. A Sobol sequence is that of Burley (Journal of Computer Graphics Techniques 9, 2020): scrambled
//! as Owen does, single precision. Random numbers are those of PCG (O'Neill 2014), so a seed gives the same runs on
//! every machine.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::Deserialize;
use thiserror::Error;

use super::distribution::Drawn;

/// The most runs of a sweep.
pub const MOST: usize = 100_000_000;
/// The most points of the Sobol sequence, and its most parameters.
const MOST_SOBOL: [usize; 2] = [1 << 16, 256];

/// Values of one parameter in a grid.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "give a list of numbers, or { from = NUMBER, to = NUMBER, count = COUNT }")]
pub enum Axis {
    /// These.
    List(Vec<f64>),
    /// So many, the ends among them.
    Steps(Steps),
}

/// Values from one end to the other.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    from: f64,
    to: f64,
    count: usize,
    #[serde(default)]
    scale: Scale,
}

/// An interval that is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    from: f64,
    to: f64,
    #[serde(default)]
    scale: Scale,
}

/// How values are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in their logarithms.
    Log,
}

/// What is no design.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DesignError {
    /// No value.
    #[error("`{0}` has no value; give at least one")]
    Empty(String),
    /// One value from one end to another.
    #[error("`{0}` has a count of 1 and two ends; give a list of one value")]
    One(String),
    /// A range without logarithms.
    #[error("`{0}` has the scale log and an end that is not above 0; choose ends above 0")]
    Log(String),
    /// An end that is no number.
    #[error("`{0}` has an end that is not finite")]
    NotFinite(String),
    /// No parameter at all.
    #[error("no parameter is swept; give at least one")]
    Nothing,
    /// No sample.
    #[error("count is 0; give at least 1")]
    NoSample,
    /// More runs than can be counted.
    #[error("gives more than {MOST} runs; give fewer values")]
    Many,
    /// A Sobol sequence that ends before.
    #[error(
        "a Sobol sequence has at most {} points in {} parameters; give fewer, or a \
        [latin_hypercube]", MOST_SOBOL[0], MOST_SOBOL[1]
    )]
    Sobol,
}

/// The runs of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The swept parameters.
    pub names: Vec<String>,
    /// How many runs.
    pub runs: usize,
    points: Points,
}

#[derive(Clone, Debug, PartialEq)]
enum Points {
    /// The values of each parameter.
    Grid(Vec<Vec<f64>>),
    /// The values of each run, one after the other.
    List(Vec<f64>),
    /// The places of each run in the intervals, from 0 to 1, one after the other.
    Placed(Vec<Interval>, Vec<f64>),
    Sobol(Vec<Interval>, u32),
    Drawn(Drawn),
}

/// How the runs of a sweep lie.
#[derive(Clone, Copy, Debug)]
pub enum Layout<'a> {
    /// Each value of a parameter with each of the others.
    Grid(&'a [Vec<f64>]),
    /// Anywhere.
    Scattered,
    /// Drawn from distributions.
    Drawn(&'a Drawn),
}

impl Scale {
    /// What stands at `place`, from 0 to 1, between the ends.
    fn at(self, from: f64, to: f64, place: f64) -> f64 {
        match self {
            Self::Linear => from + (to - from) * place,
            Self::Log => from * libm::pow(to / from, place),
        }
    }

    fn check(self, name: &str, from: f64, to: f64) -> Result<(), DesignError> {
        if !(from.is_finite() && to.is_finite()) {
            return Err(DesignError::NotFinite(name.to_owned()));
        }
        match self {
            Self::Log if from <= 0.0 || to <= 0.0 => Err(DesignError::Log(name.to_owned())),
            _ => Ok(()),
        }
    }
}

impl Axis {
    fn values(&self, name: &str) -> Result<Vec<f64>, DesignError> {
        let values = match *self {
            Self::List(ref values) => values.clone(),
            Self::Steps(Steps { count: 1, .. }) => return Err(DesignError::One(name.to_owned())),
            Self::Steps(Steps { count, .. }) if count > MOST => return Err(DesignError::Many),
            Self::Steps(Steps { from, to, count, scale }) => {
                scale.check(name, from, to)?;
                let place = |k: usize| k as f64 / (count - 1) as f64;
                // The last one is the end itself, not what rounding makes of it.
                (0..count).map(|k| if k + 1 == count { to } else { scale.at(from, to, place(k)) }).collect()
            }
        };
        if values.is_empty() { Err(DesignError::Empty(name.to_owned())) } else { Ok(values) }
    }
}

impl Design {
    /// Each value of a parameter with each of the others.
    ///
    /// # Errors
    /// A parameter without values, too many runs.
    pub fn grid(axes: &[(String, Axis)]) -> Result<Self, DesignError> {
        let values = axes.iter().map(|(name, axis)| axis.values(name)).collect::<Result<Vec<_>, _>>()?;
        let runs = values.iter().try_fold(1usize, |runs, values| runs.checked_mul(values.len()));
        Self::new(names(axes), runs.unwrap_or(usize::MAX), Points::Grid(values))
    }

    /// The rows of a table.
    ///
    /// # Errors
    /// No row.
    pub fn list(names: Vec<String>, rows: Vec<f64>) -> Result<Self, DesignError> {
        let runs = rows.len().checked_div(names.len()).ok_or(DesignError::Nothing)?;
        Self::new(names, runs, Points::List(rows))
    }

    /// `count` runs, one in each of as many intervals of every parameter.
    ///
    /// # Errors
    /// An unusable interval, no or too many runs.
    pub fn latin_hypercube(intervals: &[(String, Interval)], count: usize, seed: u64) -> Result<Self, DesignError> {
        check(intervals)?;
        let mut places = vec![0.0; if count > MOST { 0 } else { count * intervals.len() }];
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        for parameter in 0..intervals.len() {
            for (run, interval) in shuffled(count.min(MOST), &mut random).into_iter().enumerate() {
                places[run * intervals.len() + parameter] = (interval as f64 + fraction(&mut random)) / count as f64;
            }
        }
        Self::new(names(intervals), count, Points::Placed(values(intervals), places))
    }

    /// The first `count` points of a Sobol sequence.
    ///
    /// # Errors
    /// An unusable interval, no or too many runs or parameters.
    pub fn sobol(intervals: &[(String, Interval)], count: usize, seed: u32) -> Result<Self, DesignError> {
        check(intervals)?;
        if count > MOST_SOBOL[0] || intervals.len() > MOST_SOBOL[1] {
            return Err(DesignError::Sobol);
        }
        Self::new(names(intervals), count, Points::Sobol(values(intervals), seed))
    }

    /// `count` samples drawn from distributions.
    ///
    /// # Errors
    /// No or too many runs.
    pub fn drawn(names: Vec<String>, drawn: Drawn, count: usize) -> Result<Self, DesignError> {
        let runs = count.saturating_mul(drawn.width());
        Self::new(names, runs, Points::Drawn(drawn))
    }

    /// How its runs lie.
    #[must_use]
    pub fn layout(&self) -> Layout<'_> {
        match &self.points {
            Points::Grid(axes) => Layout::Grid(axes),
            Points::Drawn(drawn) => Layout::Drawn(drawn),
            _ => Layout::Scattered,
        }
    }

    fn new(names: Vec<String>, runs: usize, points: Points) -> Result<Self, DesignError> {
        match runs {
            _ if names.is_empty() => Err(DesignError::Nothing),
            0 => Err(DesignError::NoSample),
            runs if runs > MOST => Err(DesignError::Many),
            _ => Ok(Self { names, runs, points }),
        }
    }

    /// The values in a run, in the order of `names`.
    ///
    /// # Panics
    /// There is no such run.
    #[must_use]
    pub fn values(&self, run: usize) -> Vec<f64> {
        assert!(run < self.runs, "run {run} of {}", self.runs);
        let width = self.names.len();
        match &self.points {
            Points::Grid(axes) => {
                let mut rest = run;
                let mut values: Vec<f64> = axes
                    .iter()
                    .rev()
                    .map(|axis| {
                        let value = axis[rest % axis.len()];
                        rest /= axis.len();
                        value
                    })
                    .collect();
                values.reverse();
                values
            }
            Points::List(rows) => rows[run * width..][..width].to_vec(),
            Points::Placed(intervals, places) => {
                intervals.iter().zip(&places[run * width..]).map(|(interval, &place)| interval.at(place)).collect()
            }
            Points::Drawn(drawn) => drawn.values(run),
            Points::Sobol(intervals, seed) => {
                let place = |parameter| f64::from(sobol_burley::sample(run as u32, parameter, *seed));
                intervals.iter().zip(0..).map(|(interval, parameter)| interval.at(place(parameter))).collect()
            }
        }
    }

    /// Values of parameter `parameter` of `names` between which all others are: those that have to be allowed.
    #[must_use]
    pub fn extremes(&self, parameter: usize) -> Vec<f64> {
        match &self.points {
            Points::Grid(axes) => axes[parameter].clone(),
            Points::List(rows) => rows.iter().skip(parameter).step_by(self.names.len()).copied().collect(),
            Points::Placed(intervals, _) | Points::Sobol(intervals, _) => {
                vec![intervals[parameter].from, intervals[parameter].to]
            }
            // What is outside of a range more seldom is a run that is refused.
            Points::Drawn(drawn) => {
                [1e-6, 1.0 - 1e-6].map(|part| drawn.distributions()[parameter].quantile(part)).to_vec()
            }
        }
    }
}

impl Interval {
    fn at(&self, place: f64) -> f64 {
        self.scale.at(self.from, self.to, place)
    }
}

fn names<T>(named: &[(String, T)]) -> Vec<String> {
    named.iter().map(|(name, _)| name.clone()).collect()
}

fn values<T: Copy>(named: &[(String, T)]) -> Vec<T> {
    named.iter().map(|(_, value)| *value).collect()
}

fn check(intervals: &[(String, Interval)]) -> Result<(), DesignError> {
    intervals.iter().try_for_each(|(name, interval)| interval.scale.check(name, interval.from, interval.to))
}

/// A random number from 0 to below 1.
fn fraction(random: &mut impl Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// The numbers below `count` in random order (Fisher and Yates).
fn shuffled(count: usize, random: &mut impl Rng) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    for last in (1..count).rev() {
        // The upper half of the product: each place but for 1 in 2^37 equally often.
        let place = (u128::from(random.next_u64()) * (last as u128 + 1)) >> 64;
        order.swap(last, place as usize);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(from: f64, to: f64, scale: Scale) -> Interval {
        Interval { from, to, scale }
    }

    fn two() -> [(String, Interval); 2] {
        [("a".to_owned(), interval(0.0, 1.0, Scale::Linear)), ("b".to_owned(), interval(1.0, 1e4, Scale::Log))]
    }

    fn all(design: &Design) -> Vec<Vec<f64>> {
        (0..design.runs).map(|run| design.values(run)).collect()
    }

    #[test]
    fn in_a_grid_the_last_parameter_changes_from_run_to_run() {
        let steps = |count, scale| Axis::Steps(Steps { from: 1.0, to: 100.0, count, scale });
        let axes = [("b".to_owned(), Axis::List(vec![5.0, 6.0])), ("a".to_owned(), steps(3, Scale::Log))];
        let grid = Design::grid(&axes).unwrap();
        let expected = [[5.0, 1.0], [5.0, 10.0], [5.0, 100.0], [6.0, 1.0], [6.0, 10.0], [6.0, 100.0]];
        assert_eq!(all(&grid), expected);
        assert_eq!(grid.extremes(1), [1.0, 10.0, 100.0]);
        let linear = Design::grid(&[("a".to_owned(), steps(4, Scale::Linear))]).unwrap();
        assert_eq!(all(&linear), [[1.0], [34.0], [67.0], [100.0]]);
        // -0.3 + (0.1 + 0.3) is not 0.1.
        let ends = Axis::Steps(Steps { from: -0.3, to: 0.1, count: 7, scale: Scale::Linear });
        let ends = Design::grid(&[("a".to_owned(), ends)]).unwrap();
        assert_eq!((ends.values(0), ends.values(6)), (vec![-0.3], vec![0.1]));
    }

    #[test]
    fn a_list_has_its_rows_as_runs_and_its_columns_as_extremes() {
        let list = Design::list(["a", "b"].map(str::to_owned).to_vec(), vec![1.0, 10.0, 2.0, 20.0, 3.0, 30.0]).unwrap();
        assert_eq!(all(&list), [[1.0, 10.0], [2.0, 20.0], [3.0, 30.0]]);
        assert_eq!([0, 1].map(|parameter| list.extremes(parameter)), [vec![1.0, 2.0, 3.0], vec![10.0, 20.0, 30.0]]);
    }

    #[test]
    fn a_latin_hypercube_has_one_run_in_each_interval_of_every_parameter() {
        let cube = Design::latin_hypercube(&two(), 50, 3).unwrap();
        let places = |at: fn(&[f64]) -> f64| {
            let mut intervals: Vec<usize> = all(&cube).iter().map(|values| (50.0 * at(values)) as usize).collect();
            intervals.sort_unstable();
            intervals
        };
        let each: Vec<usize> = (0..50).collect();
        assert_eq!(places(|values| values[0]), each);
        assert_eq!(places(|values| values[1].log10() / 4.0), each);
        let other = Design::latin_hypercube(&two(), 50, 4).unwrap();
        assert_ne!(all(&cube), all(&other));
        assert_ne!(all(&cube)[0][0] * 4.0, all(&cube)[0][1].log10());
    }

    #[test]
    fn a_sobol_sequence_has_one_point_in_each_interval_of_a_power_of_two() {
        let sobol = Design::sobol(&two(), 64, 1).unwrap();
        let mut intervals: Vec<usize> = all(&sobol).iter().map(|values| (64.0 * values[0]) as usize).collect();
        intervals.sort_unstable();
        assert_eq!(intervals, (0..64).collect::<Vec<_>>());
    }

    #[test]
    fn a_seed_gives_the_same_runs_for_ever() {
        let cube = Design::latin_hypercube(&two(), 3, 1).unwrap();
        let sobol = Design::sobol(&two(), 3, 1).unwrap();
        let expected = [
            [0.4901538421159863, 4492.5054253224625],
            [0.24208324032062056, 1.6172066550238817],
            [0.7899479118412381, 75.89325098271331],
        ];
        assert_eq!(all(&cube), expected);
        let expected = [
            [0.4298055171966553, 993.8953967673222],
            [0.9787707328796387, 2.0988939222191574],
            [0.17449867725372314, 28.46488696156698],
        ];
        assert_eq!(all(&sobol), expected);
    }

    #[test]
    fn what_is_no_design_is_said() {
        let fault = |design: Result<Design, DesignError>| design.unwrap_err().to_string();
        let of = |axis| Design::grid(&[("a".to_owned(), axis)]);
        assert_eq!(fault(Design::grid(&[])), "no parameter is swept; give at least one");
        assert_eq!(fault(of(Axis::List(vec![]))), "`a` has no value; give at least one");
        let steps = |from, count, scale| Axis::Steps(Steps { from, to: 2.0, count, scale });
        assert_eq!(
            fault(of(steps(1.0, 1, Scale::Linear))),
            "`a` has a count of 1 and two ends; give a list of one value"
        );
        assert!(fault(of(steps(0.0, 2, Scale::Log))).starts_with("`a` has the scale log"));
        assert!(fault(of(steps(0.0, usize::MAX, Scale::Linear))).starts_with("gives more than 100000000 runs"));
        let many = [1, 2, 3].map(|name| (name.to_string(), steps(1.0, 1000, Scale::Linear)));
        assert!(fault(Design::grid(&many)).starts_with("gives more than"));
        assert!(fault(Design::sobol(&two(), 1 << 17, 0)).starts_with("a Sobol sequence has at most 65536 points"));
        assert_eq!(fault(Design::latin_hypercube(&two(), 0, 0)), "count is 0; give at least 1");
    }
}
