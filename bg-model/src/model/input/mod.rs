//! Inputs: functions of time given at run time.
//!
//! In: a number, a closure or a table. Out: the input's value, and its rate where it is known, at any time; and the
//! instants at which a step must end.

mod spline;
mod table;

use alloc::sync::Arc;
use core::fmt;

use crate::model::scalar::Scalar;
use crate::model::scalar::double::root;
pub use table::{Table, TableError};

/// A real function of time (s).
type OfTime = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// A function of time that a model reads: a constant, a closure with or without its rate, or a table. The default is
/// the constant 0.
///
/// The unit is that of the model's input. A closure must be smooth between switchings, or the integrator has to shorten
/// its steps at each kink; it is evaluated several times a step and not in order of time. At the kinks of a table steps
/// end.
#[derive(Clone)]
pub struct Input {
    law: Law,
}

#[derive(Clone)]
enum Law {
    Constant(f64),
    Function(OfTime),
    FunctionAndRate(OfTime, OfTime),
    FunctionAndTangent(OfTime, OfTime),
    Table(Arc<Table>),
}

impl Input {
    /// The same `value` at all times.
    #[must_use]
    pub const fn constant(value: f64) -> Self {
        Self { law: Law::Constant(value) }
    }

    /// `value` at time t (s).
    pub fn function(value: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self { law: Law::Function(Arc::new(value)) }
    }

    /// `value` at time t (s) and its derivative with respect to time, `rate`, in the input's unit per s.
    pub fn with_rate(
        value: impl Fn(f64) -> f64 + Send + Sync + 'static,
        rate: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { law: Law::FunctionAndRate(Arc::new(value), Arc::new(rate)) }
    }

    /// `value` at time t (s), at rest; what `t` has beyond the `f64` nearest to it enters times `along`, in the input's
    /// unit per s. In dual numbers whose time has the slope 1 so are derivatives by the input, without a rate that the
    /// model could read.
    pub fn with_tangent(
        value: impl Fn(f64) -> f64 + Send + Sync + 'static,
        along: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { law: Law::FunctionAndTangent(Arc::new(value), Arc::new(along)) }
    }

    /// The rows of `table` and what is in between; outside, the value of the nearest row.
    ///
    /// ```
    /// use bg_model::input::{Input, Table};
    ///
    /// let ramp = Input::table(Table::linear(&[0.0, 0.1, 2.0], &[0.0, 50.0, 50.0])?);
    /// assert_eq!((ramp.value(0.05), ramp.value(3.0)), (25.0, 50.0));
    /// assert_eq!(ramp.next_break(0.0), 0.1);
    /// # Ok::<(), bg_model::input::TableError>(())
    /// ```
    #[must_use]
    pub fn table(table: Table) -> Self {
        Self { law: Law::Table(Arc::new(table)) }
    }

    /// Whether the value is the same at all times: not of a closure, nor of a table.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        matches!(self.law, Law::Constant(_))
    }

    /// The value at time `t` (s).
    ///
    /// A closure is evaluated at the `f64` nearest to `t`. With a rate, what `t` has beyond that `f64` (the low part of
    /// a double-double number, the infinitesimal part of a dual one) enters to first order. A table is evaluated in
    /// `S`.
    pub fn value<S: Scalar>(&self, t: S) -> S {
        match &self.law {
            Law::Constant(value) => S::from_f64(*value),
            Law::Function(value) => S::from_f64(value(t.to_f64())),
            Law::FunctionAndRate(value, rate) | Law::FunctionAndTangent(value, rate) => {
                let nearest = t.to_f64();
                S::from_f64(value(nearest)) + S::from_f64(rate(nearest)) * (t - S::from_f64(nearest))
            }
            Law::Table(table) => table.value(t),
        }
    }

    /// The derivative with respect to time at time `t` (s), where it is known: of a constant, of a closure given with
    /// its rate, and of a table, where it jumps that of the time after `t`.
    pub fn rate<S: Scalar>(&self, t: S) -> Option<S> {
        match &self.law {
            Law::Constant(_) | Law::FunctionAndTangent(..) => Some(S::from_f64(0.0)),
            Law::Function(_) => None,
            Law::FunctionAndRate(_, rate) => Some(S::from_f64(rate(t.to_f64()))),
            Law::Table(table) => Some(table.rate(t)),
        }
    }

    /// The first instant after `t` (s) at which a step must end, because another law begins there: of a table the next
    /// row. Infinity where there is none, as always of a constant or a closure.
    #[must_use]
    pub fn next_break(&self, t: f64) -> f64 {
        match &self.law {
            Law::Table(table) => table.next_break(t),
            Law::Constant(_) | Law::Function(_) | Law::FunctionAndRate(..) | Law::FunctionAndTangent(..) => {
                f64::INFINITY
            }
        }
    }
}

impl Input {
    /// The derivative with respect to time at time `t` (s), in the input's unit per s: [`Input::rate`] where that is
    /// known, else the slope at `t` of the parabola through three values of the closure, at `t` and up to
    /// 3e-8 max(1, |t|) s after it. It never asks for the time before `t`. A closure that changes within so short a
    /// time, or jumps, should be given with its rate.
    pub fn slope<S: Scalar>(&self, t: S) -> S {
        match &self.law {
            Law::Function(value) => S::from_f64(parabola_slope(value.as_ref(), t.to_f64())),
            _ => self.rate(t).unwrap_or(S::from_f64(0.0)),
        }
    }
}

/// The first instant after `t` (s) at which one of the `inputs` has a step end; infinity where there is none.
pub fn next_break<'a>(inputs: impl IntoIterator<Item = &'a Input>, t: f64) -> f64 {
    inputs
        .into_iter()
        .map(|input| input.next_break(t))
        .fold(f64::INFINITY, |first, next| if next < first { next } else { first })
}

/// How far after time `t` (s) a closure is asked for its slope, s.
pub(crate) fn reach(t: f64) -> f64 {
    2.0 * distance(t)
}

/// The distance of the times at which a slope is asked for: it balances truncation with rounding where the time scale
/// is 1 s or
/// `t`.
fn distance(t: f64) -> f64 {
    let size = t.abs();
    root(f64::EPSILON) * if size > 1.0 { size } else { 1.0 }
}

/// The derivative at `t` of the parabola through `value` at `t` and two times after it: Newton's divided differences
/// at the times as rounded.
fn parabola_slope(value: &dyn Fn(f64) -> f64, t: f64) -> f64 {
    let distance = distance(t);
    let times = [t, t + distance, t + 2.0 * distance];
    let values = times.map(value);
    let first = (values[1] - values[0]) / (times[1] - times[0]);
    let second = (values[2] - values[1]) / (times[2] - times[1]);
    first - (second - first) * ((times[1] - times[0]) / (times[2] - times[0]))
}

impl Default for Input {
    fn default() -> Self {
        Self::constant(0.0)
    }
}

impl From<f64> for Input {
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl fmt::Debug for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.law {
            Law::Constant(value) => write!(f, "Input::constant({value:?})"),
            Law::Function(_) => f.write_str("Input::function(..)"),
            Law::FunctionAndRate(..) => f.write_str("Input::with_rate(..)"),
            Law::FunctionAndTangent(..) => f.write_str("Input::with_tangent(..)"),
            Law::Table(table) => write!(f, "Input::table({} rows)", table.times().len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::Dual;

    #[test]
    fn default_is_zero_and_a_number_is_a_constant() {
        assert_eq!(Input::default().value(3.0), 0.0);
        assert_eq!(Input::from(2.5).value(-1.0), 2.5);
        assert_eq!(Input::from(2.5).rate(-1.0), Some(0.0));
    }

    #[test]
    fn closures_are_evaluated_at_the_time_and_clones_share_them() {
        let input = Input::function(|t| 2.0 * t + 1.0);
        let twin = input.clone();
        assert_eq!(input.value(3.0), 7.0);
        assert_eq!(twin.value(-3.0), -5.0);
        assert_eq!(input.rate(3.0), None);
    }

    #[test]
    fn a_rate_is_given_back_and_does_not_disturb_the_value() {
        let input = Input::with_rate(|t| t * t, |t| 2.0 * t);
        assert_eq!(input.value(0.1), 0.1 * 0.1);
        assert_eq!(input.rate(0.1), Some(0.2));
    }

    #[test]
    fn a_tangent_is_no_rate() {
        let input = Input::with_tangent(|_| 3.0, |_| 5.0);
        assert_eq!(input.value(Dual::new(0.1, 1.0)), Dual::new(3.0, 5.0));
        assert_eq!((input.rate(0.1), input.slope(0.1)), (Some(0.0), 0.0));
    }

    #[test]
    fn slopes_are_derivatives() {
        assert_eq!(Input::from(2.5).slope(-1.0), 0.0);
        assert_eq!(Input::with_rate(|t| t * t, |t| 2.0 * t).slope(0.1), 0.2);
        for t in [0.0, 0.7, 5.0, 60.0] {
            let slope = Input::function(|t| (3.0 * t).sin()).slope(t);
            let expected = 3.0 * (3.0 * t).cos();
            assert!((slope - expected).abs() < 5e-7, "{t}: {slope} {expected}");
        }
    }

    #[test]
    fn a_slope_asks_for_no_earlier_time() {
        let input = Input::function(|t| if t < 2.0 { f64::NAN } else { 4.0 * t });
        assert!((input.slope(2.0) - 4.0).abs() < 1e-6);
    }

    #[test]
    fn the_next_break_is_the_first_of_all_inputs() {
        let table = |times: &[f64; 2]| Input::table(Table::linear(times, &[0.0, 1.0]).unwrap());
        let (early, late, none) = (table(&[0.0, 1.0]), table(&[0.5, 3.0]), Input::function(|t| t));
        let at = |t| next_break([&late, &none, &early], t);
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 3.0].map(at), [0.0, 0.5, 1.0, 3.0, f64::INFINITY]);
    }

    #[test]
    fn debug_tells_the_kinds_apart() {
        assert_eq!(format!("{:?}", Input::from(1.0)), "Input::constant(1.0)");
        assert_eq!(format!("{:?}", Input::function(|t| t)), "Input::function(..)");
        assert_eq!(format!("{:?}", Input::with_rate(|t| t, |_| 1.0)), "Input::with_rate(..)");
        assert_eq!(format!("{:?}", Input::with_tangent(|t| t, |_| 1.0)), "Input::with_tangent(..)");
        let table = Table::linear(&[0.0, 1.0, 2.0], &[0.0; 3]).unwrap();
        assert_eq!(format!("{:?}", Input::table(table)), "Input::table(3 rows)");
    }
}
