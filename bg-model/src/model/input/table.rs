//! Tables: functions of time given by rows of a time and a value, with straight lines or a cubic spline in between.
//!
//! In: times and values. Out: the value and the exact rate at any time, in any scalar, and the instants at which the
//! law changes; or why the rows are no table. Of both kinds a value is continuous; the rate of a line, and of every
//! table at its two ends, jumps.

use alloc::vec::Vec;

use thiserror::Error;

use super::spline;
use crate::model::scalar::Scalar;

/// A function of time by rows of a time and a value. Before the first row and after the last one the value there holds.
///
/// A row is an instant at which the law changes. An integrator ends a step at every row, so no step runs over a kink;
/// its steps are not longer than the rows are apart. The rate at such an instant is that of the time after it: the
/// steps that begin there ask for it. A value that jumps is no table: give two rows a short time apart, or a switch in
/// the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    /// The rates at the rows of a spline; none of straight lines.
    slopes: Option<Vec<f64>>,
}

/// Why rows are no table.
#[derive(Clone, PartialEq, Error)]
pub enum TableError {
    /// There are fewer than two rows.
    #[error("the table has {} row{}; give at least two", *.rows, if *.rows == 1 { "" } else { "s" })]
    TooFewRows {
        /// How many there are.
        rows: usize,
    },
    /// There are not as many values as times.
    #[error("the table has {times} times but {values} values; give a value for each time")]
    Lengths {
        /// The number of times.
        times: usize,
        /// The number of values.
        values: usize,
    },
    /// A number is not finite.
    #[error("the {what} in row {row} of the table is {value:?}; it must be a finite number")]
    NotFinite {
        /// `time` or `value`.
        what: &'static str,
        /// The row, counted from 1.
        row: usize,
        /// The refused number.
        value: f64,
    },
    /// A time is not after that of the row before.
    #[error(
        "the times of the table do not ascend: row {row} has t = {time:?} s after t = {before:?} s; sort the rows, and \
         keep one of those with the same time"
    )]
    NotAscending {
        /// The row, counted from 1.
        row: usize,
        /// Its time, s.
        time: f64,
        /// The time of the row before, s.
        before: f64,
    },
    /// From one row to the next the value changes so fast that its rate is no number.
    #[error("the table is too steep at row {row} for a number; move its time away from that of the rows beside it")]
    TooSteep {
        /// The row, counted from 1.
        row: usize,
    },
}

debug_is_display!(TableError);

impl Table {
    /// Straight lines between the rows: at each of `times` (s, ascending) the value of the same place in `values`, in
    /// the input's unit.
    ///
    /// # Errors
    /// [`TableError`] says which row cannot be.
    pub fn linear(times: &[f64], values: &[f64]) -> Result<Self, TableError> {
        check(times, values)?;
        Ok(Self { times: times.to_vec(), values: values.to_vec(), slopes: None })
    }

    /// The cubic spline through the rows whose second derivative is continuous, with the ends called "not a knot": the
    /// third derivative is continuous at the second row and at the last but one too. It is the default of SciPy's
    /// `CubicSpline` and of MATLAB's `spline`; values of a cubic polynomial give that polynomial. Of three rows it is
    /// their parabola, of two their line. Beside a value that jumps it overshoots: take [`Table::linear`] there.
    ///
    /// # Errors
    /// [`TableError`] says which row cannot be.
    pub fn cubic(times: &[f64], values: &[f64]) -> Result<Self, TableError> {
        check(times, values)?;
        let slopes = spline::slopes(times, values);
        match slopes.iter().position(|slope| !slope.is_finite()) {
            Some(index) => Err(TableError::TooSteep { row: index + 1 }),
            None => Ok(Self { times: times.to_vec(), values: values.to_vec(), slopes: Some(slopes) }),
        }
    }

    /// The times of the rows, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The values of the rows, in the input's unit.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value at time `t` (s).
    pub fn value<S: Scalar>(&self, t: S) -> S {
        match self.row_before(t) {
            Stretch::Before => S::from_f64(self.values[0]),
            Stretch::After => S::from_f64(self.values[self.values.len() - 1]),
            Stretch::Between(row) => self.part(row).value(t),
        }
    }

    /// The derivative with respect to time at time `t` (s), in the input's unit per s: that of the time after `t` where
    /// it jumps, 0 from the last row on.
    pub fn rate<S: Scalar>(&self, t: S) -> S {
        match self.row_before(t) {
            Stretch::Before | Stretch::After => S::from_f64(0.0),
            Stretch::Between(row) => self.part(row).rate(t),
        }
    }

    /// The time of the first row after `t` (s); infinity where there is none.
    #[must_use]
    pub fn next_break(&self, t: f64) -> f64 {
        let after = self.times.partition_point(|time| *time <= t);
        self.times.get(after).copied().unwrap_or(f64::INFINITY)
    }

    /// Between which rows the time `t` (s) is. Compared in `S`, which may tell it from a row where `f64` cannot.
    fn row_before<S: Scalar>(&self, t: S) -> Stretch {
        match self.times.partition_point(|time| S::from_f64(*time) <= t) {
            0 => Stretch::Before,
            rows if rows == self.times.len() => Stretch::After,
            rows => Stretch::Between(rows - 1),
        }
    }

    /// The law from row `row` to the next one.
    fn part<S: Scalar>(&self, row: usize) -> HermiteCubic<S> {
        let of = |column: &[f64]| [column[row], column[row + 1]].map(S::from_f64);
        let ([start, end], [from, to]) = (of(&self.times), of(&self.values));
        let length = end - start;
        let chord = (to - from) / length;
        let [slope, bend, twist] = match &self.slopes {
            None => [chord, S::from_f64(0.0), S::from_f64(0.0)],
            Some(slopes) => {
                let [leaving, arriving] = of(slopes);
                let bend = (chord - leaving) / length;
                [leaving, bend, ((arriving - chord) / length - bend) / length]
            }
        };
        HermiteCubic { start, end, from, slope, bend, twist }
    }
}

/// Where a time is in a table.
enum Stretch {
    /// Before the first row.
    Before,
    /// At or after this row and before the next one.
    Between(usize),
    /// At or after the last row.
    After,
}

/// The law between two rows: Newton's form of Hermite's cubic, whose nodes are both rows twice. The value at a row is
/// that of the row in every scalar, so the parts meet.
struct HermiteCubic<S> {
    start: S,
    end: S,
    from: S,
    slope: S,
    bend: S,
    twist: S,
}

impl<S: Scalar> HermiteCubic<S> {
    fn value(&self, t: S) -> S {
        let (since, until) = (t - self.start, t - self.end);
        self.from + since * (self.slope + since * (self.bend + until * self.twist))
    }

    fn rate(&self, t: S) -> S {
        let two = S::from_f64(2.0);
        let (since, until) = (t - self.start, t - self.end);
        self.slope + since * (two * self.bend + (since + two * until) * self.twist)
    }
}

/// Refuses rows that are no table.
fn check(times: &[f64], values: &[f64]) -> Result<(), TableError> {
    if times.len() != values.len() {
        return Err(TableError::Lengths { times: times.len(), values: values.len() });
    }
    if times.len() < 2 {
        return Err(TableError::TooFewRows { rows: times.len() });
    }
    for (index, (&time, &value)) in times.iter().zip(values).enumerate() {
        let row = index + 1;
        for (what, value) in [("time", time), ("value", value)] {
            if !value.is_finite() {
                return Err(TableError::NotFinite { what, row, value });
            }
        }
        let Some(before) = index.checked_sub(1) else { continue };
        if time <= times[before] {
            return Err(TableError::NotAscending { row, time, before: times[before] });
        }
        let chord = (value - values[before]) / (time - times[before]);
        if !(chord.is_finite() && (time - times[before]).is_finite()) {
            return Err(TableError::TooSteep { row });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::{DoubleDouble, Dual};

    const TIMES: [f64; 6] = [0.0, 0.5, 1.25, 2.0, 3.5, 4.0];
    const VALUES: [f64; 6] = [1.0, -2.0, 0.5, 3.0, 3.0, -1.0];

    fn cubic(t: f64) -> f64 {
        2.0 - t + 0.5 * t * t - 0.25 * t * t * t
    }

    #[test]
    fn lines_go_through_the_rows_and_the_ends_hold() {
        let table = Table::linear(&TIMES, &VALUES).unwrap();
        for (time, value) in TIMES.into_iter().zip(VALUES) {
            assert_eq!(table.value(time), value);
        }
        assert_eq!((table.value(0.25), table.value(2.9), table.value(3.75)), (-0.5, 3.0, 1.0));
        assert_eq!((table.value(-9.0), table.value(9.0)), (1.0, -1.0));
        assert_eq!((table.rate(0.25), table.rate(3.75)), (-6.0, -8.0));
        // Right of a row the law after it holds.
        assert_eq!((table.rate(-1e-9), table.rate(0.0), table.rate(2.0), table.rate(4.0)), (0.0, -6.0, 0.0, 0.0));
    }

    #[test]
    fn a_spline_gives_a_cubic_back() {
        for times in [&TIMES[..], &TIMES[..4]] {
            let values: Vec<f64> = times.iter().copied().map(cubic).collect();
            let table = Table::cubic(times, &values).unwrap();
            for k in 0..=40 {
                let t = times[times.len() - 1] * f64::from(k) / 40.0;
                assert!((table.value(t) - cubic(t)).abs() < 1e-14, "{t}");
            }
            let rate = -1.0 + 0.7 - 0.75 * 0.49;
            assert!((table.rate(0.7) - rate).abs() < 1e-14);
        }
    }

    /// Figures of SciPy 1.17.1: `CubicSpline(TIMES, VALUES)` and its derivative.
    #[test]
    fn a_spline_is_that_of_scipy() {
        let table = Table::cubic(&TIMES, &VALUES).unwrap();
        for (t, value, rate) in [
            (0.1, -0.119_248_009_506_833_01, -9.702_550_207_961_972),
            (0.7, -1.785_432_679_738_562_2, 2.422_312_537_136_067),
            (1.6, 1.830_285_601_109_130_6, 3.270_207_961_972_668),
            (2.9, 4.510_023_529_411_765, -0.248_014_260_249_553_86),
            (3.99, -0.889_730_100_059_42, -10.959_852_929_292_932),
        ] {
            assert!((table.value(t) - value).abs() < 1e-14, "{t}: {}", table.value(t));
            assert!((table.rate(t) - rate).abs() < 3e-14, "{t}: {}", table.rate(t));
        }
    }

    #[test]
    fn splines_of_few_rows_are_the_line_and_the_parabola() {
        let line = Table::cubic(&[1.0, 3.0], &[2.0, 6.0]).unwrap();
        assert_eq!((line.value(1.5), line.rate(1.5)), (3.0, 2.0));
        let parabola = Table::cubic(&[0.0, 1.0, 3.0], &[1.0, 0.0, 4.0]).unwrap();
        assert!((parabola.value(2.0) - 1.0).abs() < 1e-15 && (parabola.rate(2.0) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_next_break_is_the_next_row() {
        let table = Table::linear(&TIMES, &VALUES).unwrap();
        assert_eq!([-1.0, 0.0, 0.6, 3.5].map(|t| table.next_break(t)), [0.0, 0.5, 1.25, 4.0]);
        assert_eq!([4.0, 5.0].map(|t| table.next_break(t)), [f64::INFINITY; 2]);
    }

    #[test]
    fn rates_are_derivatives_in_every_scalar() {
        for table in [Table::linear(&TIMES, &VALUES).unwrap(), Table::cubic(&TIMES, &VALUES).unwrap()] {
            for t in [0.1, 0.5, 1.7, 3.5, 3.9] {
                let dual = table.value(Dual { value: t, slope: 1.0 });
                assert!((dual.slope - table.rate(t)).abs() < 1e-13 && dual.value == table.value(t), "{t}");
            }
        }
    }

    /// Beyond double precision the polynomial is exact: its third difference over equal steps is that of a cubic, and
    /// the parts of a spline meet with value and rate.
    #[test]
    fn splines_are_polynomials_in_double_double() {
        let table = Table::cubic(&TIMES, &VALUES).unwrap();
        let at = |t: DoubleDouble| table.value(t);
        let (start, step) = (DoubleDouble::from_f64(2.1), DoubleDouble::from_f64(0.3));
        let [a, b, c, d, e] = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k| at(start + DoubleDouble::from_f64(k) * step));
        let third = |a: DoubleDouble, b, c, d| d - c - c - c + b + b + b - a;
        let difference = (third(b, c, d, e) - third(a, b, c, d)).to_f64();
        assert!(difference.abs() < 1e-29, "{difference}");
        let beside = DoubleDouble::from_f64(1e-25);
        let row = DoubleDouble::from_f64(2.0);
        let (left, right) = (at(row - beside), at(row + beside));
        let rate = table.rate(row);
        assert!((right - left - rate * (beside + beside)).to_f64().abs() < 1e-30);
        assert!((table.rate(row - beside) - rate).to_f64().abs() < 1e-14);
    }
}
