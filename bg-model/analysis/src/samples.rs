//! The samples that a page has of a run: all rows of its CSV file and as many between them as a page may hold.
//!
//! In: the instants of a run and of the rows, series. Out: which instants, and how the numbers of series are written.

use std::collections::BTreeMap;

use serde::Serialize;

/// However many curves there are, so many samples stay.
const FEWEST: usize = 200;
/// However few there are, more samples than these are not seen.
const MOST: usize = 3000;
/// The digits of a number that stands in no CSV file.
pub const DIGITS: usize = 6;

/// A sample of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instant {
    /// Its index in the run.
    pub index: usize,
    /// Whether it is a row of the CSV file, whose numbers are written with all digits.
    pub is_row: bool,
}

/// The samples of a page with `curves` curves that move and may have `numbers` numbers together: the rows, every n-th
/// of them where they are too many, and between them other samples of the run as far as there is room. Both lists
/// ascend; rows are instants of the run.
#[must_use]
pub fn instants(times: &[f64], rows: &[f64], curves: usize, numbers: usize) -> Vec<Instant> {
    let most = (numbers / curves.max(1)).clamp(FEWEST, MOST);
    let mut wanted = rows.iter().peekable();
    let mut is_row = |t: f64| {
        while wanted.next_if(|&&row| row < t).is_some() {}
        wanted.peek() == Some(&&t)
    };
    let all: Vec<Instant> = times.iter().enumerate().map(|(index, &t)| Instant { index, is_row: is_row(t) }).collect();
    if all.len() <= most {
        return all;
    }
    let mut kept = vec![false; all.len()];
    let of_rows: Vec<usize> = all.iter().filter(|instant| instant.is_row).map(|instant| instant.index).collect();
    keep(&mut kept, &of_rows, most);
    let room = most.saturating_sub(of_rows.len().min(most));
    if room > 0 {
        keep(&mut kept, &(0..all.len()).collect::<Vec<_>>(), room);
    }
    all.into_iter().filter(|instant| kept[instant.index]).collect()
}

/// Keeps every n-th of `indices` and the last one, about `most` of them.
fn keep(kept: &mut [bool], indices: &[usize], most: usize) {
    let stride = indices.len().div_ceil(most).max(1);
    for &index in indices.iter().step_by(stride).chain(indices.last()) {
        kept[index] = true;
    }
}

/// A quantity over the samples; one that never changes is a single number.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Series {
    /// It stays as it is.
    Still(f64),
    /// One value a sample; one that is no number is `null`.
    Moving(Vec<f64>),
}

impl Series {
    /// The series of these values.
    #[must_use]
    pub fn new(values: Vec<f64>) -> Self {
        match values.split_first() {
            Some((first, rest)) if rest.iter().all(|value| value.to_bits() == first.to_bits()) => Self::Still(*first),
            _ => Self::Moving(values),
        }
    }

    /// The series of these values, each to `digits` digits.
    pub fn rounded(values: impl IntoIterator<Item = f64>, digits: usize) -> Self {
        Self::new(values.into_iter().map(|value| rounded(value, digits)).collect())
    }
}

/// Series of numbers to few digits. Those that are the same stand here once.
#[derive(Clone, Debug, Default)]
pub struct Shared {
    series: Vec<Vec<f64>>,
    /// Places by the bits of numbers, as they were given and to few digits.
    given: BTreeMap<Vec<u64>, usize>,
    near: BTreeMap<Vec<u64>, usize>,
}

impl Shared {
    /// The place of the series of these values, each to `digits` digits; of all series to as many.
    pub fn place(&mut self, values: &[f64], digits: usize) -> usize {
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
        let Self { series, given, near } = self;
        *given.entry(bits(values)).or_insert_with(|| {
            let rounded: Vec<f64> = values.iter().map(|&value| rounded(value, digits)).collect();
            *near.entry(bits(&rounded)).or_insert_with(|| {
                series.push(rounded);
                series.len() - 1
            })
        })
    }

    /// The series by their places.
    #[must_use]
    pub fn series(&self) -> &[Vec<f64>] {
        &self.series
    }
}

/// `value` to `digits` digits, 1 at least; without the sign of a zero.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    if value.is_nan() {
        // One of them: native and in a browser they have other bits.
        return f64::NAN;
    }
    let digits = digits.max(1);
    let by_text = || format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    by_arithmetic(value, digits).unwrap_or_else(by_text) + 0.0
}

/// The same some thirty times faster, where all powers of ten in it are exact: a whole number over or times such a
/// power is the number nearest to its decimals.
fn by_arithmetic(value: f64, digits: usize) -> Option<f64> {
    if value == 0.0 {
        return Some(value);
    }
    let binary = i32::try_from((value.abs().to_bits() >> 52).checked_sub(1)?).ok()? - 1022;
    // The decimal exponent, or one less.
    let decimal = (f64::from(binary) * std::f64::consts::LOG10_2).floor() as i32;
    let scaled = |places: i32| {
        let power = POWERS.get(places.unsigned_abs() as usize)?;
        Some(if places < 0 { value / power } else { value * power })
    };
    let mut places = i32::try_from(digits).ok()? - 1 - decimal;
    if scaled(places)?.abs() >= *POWERS.get(digits)? {
        places -= 1;
    }
    let whole = scaled(places)?.round();
    let power = POWERS.get(places.unsigned_abs() as usize)?;
    Some(if places < 0 { whole * power } else { whole / power })
}

/// The powers of ten that a double is exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(count: usize, step: f64) -> Vec<f64> {
        (0..=count).map(|k| k as f64 * step).collect()
    }

    #[test]
    fn all_rows_stay_and_samples_fill_the_room() {
        let (times, rows) = (grid(2500, 0.002), grid(500, 0.01));
        let times: Vec<f64> = {
            // As a run has them: the rows are instants of the run bit for bit.
            let mut all: Vec<f64> =
                times.iter().copied().filter(|t| (t / 0.01 - (t / 0.01).round()).abs() > 0.1).collect();
            all.extend(&rows);
            all.sort_unstable_by(f64::total_cmp);
            all
        };
        let few = instants(&times, &rows, 5, 48_000);
        assert_eq!((few.len(), few.iter().filter(|instant| instant.is_row).count()), (2501, 501));
        let many = instants(&times, &rows, 40, 48_000);
        assert_eq!(many.iter().filter(|instant| instant.is_row).count(), 501);
        assert!((600..=1300).contains(&many.len()), "{}", many.len());
        assert!(many.is_sorted_by(|a, b| a.index < b.index));
        let thin = instants(&times, &rows, 400, 48_000);
        assert!((FEWEST / 2..=FEWEST + 2).contains(&thin.len()), "{}", thin.len());
        assert!(thin.iter().all(|instant| instant.is_row), "rows come first");
        assert_eq!((thin[0].index, thin.last().unwrap().index), (0, 2500));
        assert!(instants(&[], &[], 3, 48_000).is_empty());
    }

    #[test]
    fn series_that_are_the_same_to_few_digits_stand_once() {
        let mut shared = Shared::default();
        let places = [[1.0, 2.0], [1.0, 3.0], [1.000_000_1, 2.0], [1.0, 2.0], [0.0, -0.0], [-0.0, 0.0]];
        let places = places.map(|values| shared.place(&values, 5));
        assert_eq!((places, shared.series().len()), ([0, 1, 0, 0, 2, 2], 3));
        assert_eq!(shared.series()[0], [1.0, 2.0]);
    }

    #[test]
    fn a_number_has_its_digits() {
        assert_eq!(rounded(2.0 / 3.0, 3), 0.667);
        assert_eq!(rounded(-1.234_567_89e-12, 6), -1.234_57e-12);
        assert!(rounded(-0.0, 6).is_sign_positive() && rounded(f64::NAN, 6).is_nan());
        // Over forty decades, as the text has it.
        for k in 0..4000 {
            let value = (1.0 + 0.8 * f64::from(k)) * 10f64.powi(k % 40 - 20) * if k % 3 == 0 { -1.0 } else { 1.0 };
            let text: f64 = format!("{value:.4e}").parse().unwrap();
            let (fast, spacing) = (rounded(value, 5), 1e-4 * value.abs());
            assert!(fast == text || (fast - text).abs() < 1.001 * spacing, "{value:e}: {fast:e} {text:e}");
            assert!(format!("{fast:e}").len() <= 11, "{fast:e}");
        }
        assert_eq!([9.999_996, 1e300, 5e-324, 99_999_999.0].map(|v| rounded(v, 6)), [10.0, 1e300, 5e-324, 1e8]);
        assert_eq!(Series::rounded([1.000_000_1, 1.000_000_2], 6), Series::Still(1.0));
        assert_eq!(Series::new(vec![1.0, 2.0]), Series::Moving(vec![1.0, 2.0]));
        let none = Series::rounded([f64::NAN, -f64::NAN], 6);
        assert!(matches!(none, Series::Still(value) if value.to_bits() == f64::NAN.to_bits()), "{none:?}");
    }
}
