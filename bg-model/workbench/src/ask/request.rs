//! How a run is integrated: what a user may ask for, checked.
//!
//! In: an end, an interval of samples, an integrator and its tolerances. Out: a [`Request`] that the run time takes, or
//! what cannot be.

use bg_model::integrator::{Integrator, Tolerances};
use bg_model::run::{Request, sample_times};
use bg_model::simulation::Samples;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use crate::ask::parameters::number;

/// The most rows of a CSV file: some hundred MB.
const MOST_ROWS: f64 = 500_000.0;
/// The most samples that figures and summary are made from: a long run has them farther apart.
const MOST_FINE: f64 = 20_000.0;
/// The most steps tried for each second of simulated time, and in all for a shorter run. The paper's hacksaw takes 5000
/// each second; parameters that need a thousand times as many are too stiff for an explicit method.
const STEPS_PER_SECOND: f64 = 5e6;

/// The end of a run that is not told another, s.
pub const T_END: f64 = 5.0;

/// How a run is integrated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Integration {
    /// The end of the run, s.
    pub t_end: f64,
    /// The interval of the rows of the CSV file, s.
    pub step: f64,
    /// The integrator.
    #[serde(deserialize_with = "from_name", serialize_with = "as_name")]
    pub method: Integrator,
    /// What `auto` begins with.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "from_hint",
        serialize_with = "as_hint"
    )]
    pub hint: Option<Integrator>,
    /// Relative tolerance of each step.
    pub rtol: f64,
    /// Absolute tolerance of each step, SI units; without one, a tenth of the relative one.
    pub atol: Option<f64>,
    /// The step of an integrator with a fixed step, s.
    pub fixed_step: f64,
}

impl Default for Integration {
    /// As a run is made without options.
    fn default() -> Self {
        let Request { method, fixed_step, rtol, .. } = Request::default();
        Self { t_end: T_END, step: 0.01, method, hint: None, rtol, atol: None, fixed_step }
    }
}

fn from_name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Integrator, D::Error> {
    String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
}

fn as_name<S: Serializer>(method: &Integrator, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(method.name())
}

fn from_hint<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Integrator>, D::Error> {
    from_name(deserializer).map(Some)
}

#[expect(clippy::ref_option, reason = "serde asks for it")]
fn as_hint<S: Serializer>(hint: &Option<Integrator>, serializer: S) -> Result<S::Ok, S::Error> {
    hint.map(Integrator::name).serialize(serializer)
}

/// A number of an [`Integration`] that cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{} {}: {fault}", field, number(*value))]
pub struct RequestError {
    /// The field of [`Integration`].
    pub field: &'static str,
    /// Its value.
    pub value: f64,
    /// What is wrong.
    pub fault: RequestFault,
}

/// Why a number cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RequestFault {
    /// It is outside its range.
    #[error("must be {0}")]
    Range(String),
    /// The samples would be too many.
    #[error("gives more than {most} rows until {t_end} s; choose a longer one")]
    Rows {
        /// The most rows.
        most: f64,
        /// The end of the run, s.
        t_end: f64,
    },
}

impl Integration {
    /// By this method to this relative tolerance, told nothing else.
    pub fn by(method: Integrator, rtol: f64) -> Self {
        Self { method, rtol, ..Self::default() }
    }

    /// What is asked of a run from 0 on of which only its end counts, at `t` (s).
    ///
    /// # Errors
    /// As [`Integration::request`].
    pub fn request_to(&self, t: f64) -> Result<Request, RequestError> {
        Self { t_end: t, step: t, ..self.clone() }.request(0.0, None)
    }

    /// What is asked of a run from `t0` (s) on: samples at the rows of the CSV file; where `finest` (s) is given, also
    /// at that interval, and the peaks of the outputs.
    ///
    /// # Errors
    /// The first number that cannot be.
    pub fn request(&self, t0: f64, finest: Option<f64>) -> Result<Request, RequestError> {
        let above_zero = |field, value: f64| {
            let range = || RequestFault::Range("a finite number above 0".to_owned());
            if value.is_finite() && value > 0.0 {
                Ok(value)
            } else {
                Err(RequestError { field, value, fault: range() })
            }
        };
        let t_end = above_zero("t_end", self.t_end)?;
        if t_end <= t0 {
            let fault = RequestFault::Range(format!("after {} s, where the state of --from is", number(t0)));
            return Err(RequestError { field: "t_end", value: t_end, fault });
        }
        let step = above_zero("step", self.step)?;
        let rtol = above_zero("rtol", self.rtol)?;
        let smallest = Tolerances::SMALLEST_RELATIVE;
        if !(smallest..1.0).contains(&rtol) {
            let fault = RequestFault::Range(format!("at least {smallest:.1e}, which rounding allows, and below 1"));
            return Err(RequestError { field: "rtol", value: rtol, fault });
        }
        let atol = self.atol.map(|atol| above_zero("atol", atol)).transpose()?;
        if (t_end - t0) / step > MOST_ROWS {
            let fault = RequestFault::Rows { most: MOST_ROWS, t_end };
            return Err(RequestError { field: "step", value: step, fault });
        }
        let fixed_step = above_zero("fixed_step", self.fixed_step)?;
        let mut times = sample_times(t0, step, t_end);
        let peaks = finest.is_some();
        let finest = finest.map(|finest| finest.max((t_end - t0) / MOST_FINE));
        times.extend(finest.into_iter().flat_map(|finest| sample_times(t0, finest, t_end)));
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        let step_limit = (STEPS_PER_SECOND * t_end.max(1.0)) as u64;
        let samples = Samples::At(times);
        let (method, hint) = (self.method, self.hint);
        Ok(Request { method, hint, fixed_step, t_end, rtol, atol, samples, peaks, step_limit, ..Request::default() })
    }
}
