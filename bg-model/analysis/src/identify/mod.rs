//! Identification: the parameters with which a model comes nearest to what was measured.
//!
//! In: a model, measured columns, which parameters may change. Out: their values with confidence intervals and
//! correlations, what the data do not say, residuals. Method: least squares ([`fit()`]) on exact derivatives
//! ([`bg_model::sensitivity`]). A residual counts in parts of its column's noise, which is what the column's residuals
//! come to: the fit is repeated until that settles. A parameter that is positive is fitted by its logarithm. Where a
//! fit leaves no noise, others are made from other starts, on growing parts of the data.

mod data;
pub mod fit;
mod noise;
pub(crate) mod search;

use bg_model::description::ParameterInfo;
use bg_model::mechanism::Followed;
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::parameters::ParameterError;
use bg_model::run::{Request, Simulation, Trajectory};
use bg_model::sensitivity::{Direction, Sensitivities, SensitivityError, directions, sensitivities_of};
use bg_model::simulation::Samples;
use thiserror::Error;

pub use data::{Data, Measured};
use fit::{Fitted, Problem, fit};
pub use noise::{Left, NoNoise};
pub use search::identify;

/// A parameter that may change.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// The parameter.
    pub info: &'static ParameterInfo,
    /// Where it starts, in its unit.
    pub start: f64,
    /// Its bounds, in its unit.
    pub lower: f64,
    /// As above.
    pub upper: f64,
}

impl Variable {
    /// Whether it is fitted by its logarithm: it starts above zero, and cannot come below.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        self.lower >= 0.0 && self.start > 0.0
    }

    /// What is fitted, for a value of the parameter.
    pub(crate) fn inner(&self, value: f64) -> f64 {
        if self.is_logarithmic() { value.ln() } else { value }
    }

    pub(crate) fn outer(&self, inner: f64) -> f64 {
        if self.is_logarithmic() { inner.exp() } else { inner }
    }

    /// The derivative of the parameter by what is fitted.
    pub(crate) fn slope(&self, value: f64) -> f64 {
        if self.is_logarithmic() { value } else { 1.0 }
    }

    /// What steps of it are measured with.
    pub(crate) fn size(&self) -> f64 {
        if self.is_logarithmic() || self.start == 0.0 { 1.0 } else { self.start.abs() }
    }
}

/// An identification that did not come about.
#[derive(Debug, Error)]
pub enum IdentifyError {
    /// The run with the start values has failed.
    #[error("with the start values: {0}")]
    Start(SensitivityError),
    /// A parameter cannot have a value.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// There are fewer values than parameters.
    #[error("{values} measured values do not determine {parameters} parameters; fit fewer with --fit")]
    TooFew {
        /// How many values were measured.
        values: usize,
        /// How many parameters may change.
        parameters: usize,
    },
}

/// What was found of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Which.
    pub variable: Variable,
    /// The value found, in its unit.
    pub value: f64,
    /// The ends of the interval that has the true value with 95 % confidence, where the model and normal noise hold;
    /// none where the data do not determine it, or what is left of a column is no noise.
    pub interval: Option<[f64; 2]>,
    /// Whether it is at a bound.
    pub is_held: bool,
}

/// A measured column beside the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The place of its output in the model's description.
    pub output: usize,
    /// The model's values at all instants, in the output's unit.
    pub model: Vec<f64>,
    /// What is left of it.
    pub left: Left,
}

/// What an identification found.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// The parameters.
    pub estimates: Vec<Estimate>,
    /// The correlation of the errors of each two of them; not a number where the data do not determine them.
    pub correlations: DMatrix<f64>,
    /// Combinations of parameters that the data do not determine: each with the parts of their sizes by which they
    /// change together, the largest first.
    pub undetermined: Vec<Vec<(&'static str, f64)>>,
    /// The columns of the data with the model's values.
    pub columns: Vec<Column>,
    /// Values of the parameters that were tried.
    pub evaluations: usize,
    /// How many of them have helped, so that derivatives were taken there.
    pub derivatives: usize,
    /// From how many starts fits were made.
    pub starts: usize,
    /// Whether the fit has converged.
    pub has_converged: bool,
}

impl Identified {
    /// Whether what is left of all columns is noise; else nothing is known of how far the parameters are off.
    #[must_use]
    pub fn leaves_noise(&self) -> bool {
        self.columns.iter().all(|column| column.left.fault.is_none())
    }

    /// The squares of what is left of the columns, in parts of their spreads.
    fn left(&self) -> f64 {
        self.columns.iter().map(|column| (column.left.size / column.left.spread).powi(2)).sum()
    }
}

/// Most values that one fit tries, and fits for the noise to settle.
const EVALUATIONS: usize = 60;
const FITS: usize = 4;
/// A change of a column's noise by less than this part is none.
const SETTLED: f64 = 0.02;
/// Noise below this part of a column's size is rounding and the run's own error.
const EXACT: f64 = 1e-9;
/// The run's own error in parts of a column's size: so many relative tolerances of a step, since errors of steps add
/// up, and at most this.
const OWN_ERROR: f64 = 1e3;
const MOST_OWN: f64 = 1e-3;
/// Singular values of the derivatives, each column of length one, below this part of the largest: the data do not
/// determine what is along them.
const SAME: f64 = 1e-7;
/// The part of a parameter in a combination above which it is named.
const NAMED: f64 = 0.1;

/// The fit that the variables' starts lead to.
fn fitted(
    model: &dyn Followed,
    request: &Request,
    data: &Data,
    variables: &[Variable],
    told: &mut dyn FnMut(&[f64], f64),
) -> Result<Identified, IdentifyError> {
    let names: Vec<&str> = variables.iter().map(|of| of.info.name).collect();
    let directions = directions(model.description(), &names)?;
    let outputs: Vec<usize> = data.columns.iter().map(|column| column.output).collect();
    let count = data.count();
    if count <= variables.len() {
        return Err(IdentifyError::TooFew { values: count, parameters: variables.len() });
    }
    let t_end = *data.times.last().expect("there are values");
    let rtol = request.rtol;
    let request = Request { samples: Samples::At(data.times.clone()), t_end, ..request.clone() };
    let inner = |value: fn(&Variable) -> f64| {
        DVector::from_iterator(variables.len(), variables.iter().map(|of| of.inner(value(of))))
    };
    let bounds = [inner(|of| of.lower), inner(|of| of.upper)];
    let sizes = DVector::from_iterator(variables.len(), variables.iter().map(Variable::size));
    let sizes_of_columns: Vec<f64> = data.columns.iter().map(|column| spread(&column.values)).collect();
    let noise = sizes_of_columns.clone();
    let runs = Runs { model, request, own: model.values(), directions, outputs };
    let mut misfit = Misfit { runs, data, variables, noise, told, latest: None, derivatives: 0 };
    let (mut start, mut evaluations) = (inner(|of| of.start), 0);
    for round in 0.. {
        let found = fit(&start, [&bounds[0], &bounds[1]], &sizes, EVALUATIONS, &mut misfit);
        let fitted = found.map_err(IdentifyError::Start)?;
        // Of a later fit the start is what the one before has come to.
        evaluations += fitted.evaluations - usize::from(round > 0);
        start.copy_from(&fitted.x);
        let (_, found) = misfit.latest.as_ref().expect("derivatives are taken at the start");
        let models = &found.trajectory.columns;
        let found = noise_of(data, models, &sizes_of_columns);
        let is_settled = found.iter().zip(&misfit.noise).all(|(found, noise)| (found - noise).abs() <= SETTLED * noise);
        if is_settled || round + 1 == FITS {
            let columns = data.columns.iter().map(|measured| column(measured, &models[measured.output].values, rtol));
            let runs = (evaluations, misfit.derivatives);
            let freedom = freedom(data, &found, &sizes_of_columns, variables.len());
            return Ok(identified(variables, &fitted, freedom, columns.collect(), runs));
        }
        misfit.noise = found;
    }
    unreachable!("the last of several fits is given")
}

/// What makes runs of the variables' values.
struct Runs<'a> {
    model: &'a dyn Followed,
    request: Request,
    /// The values of all of the model's parameters.
    own: Vec<f64>,
    /// What is differentiated by: the variables, in their order.
    directions: Vec<Direction>,
    /// The outputs that are measured.
    outputs: Vec<usize>,
}

impl Runs<'_> {
    /// The values of all parameters.
    fn all(&self, values: &[f64]) -> Vec<f64> {
        let mut all = self.own.clone();
        for (direction, &value) in self.directions.iter().zip(values) {
            let Direction::Parameter(place) = *direction else { unreachable!("a variable is a parameter") };
            all[place] = value;
        }
        all
    }

    fn plain(&self, values: &[f64]) -> Result<Trajectory, SensitivityError> {
        Ok(Simulation::over(self.model.tuned(&self.all(values))?, self.request.clone()).run()?)
    }

    /// With derivatives by the variables.
    fn with(&self, values: &[f64]) -> Result<Sensitivities, SensitivityError> {
        sensitivities_of(self.model, &self.all(values), &self.request, &self.directions, &self.outputs)
    }
}

/// The residuals of a model in parts of the noise of their columns.
struct Misfit<'a> {
    runs: Runs<'a>,
    data: &'a Data,
    variables: &'a [Variable],
    noise: Vec<f64>,
    told: &'a mut dyn FnMut(&[f64], f64),
    /// The last run with derivatives, of these variables, and how many there were.
    latest: Option<(DVector<f64>, Sensitivities)>,
    derivatives: usize,
}

impl Misfit<'_> {
    fn values(&self, x: &DVector<f64>) -> Vec<f64> {
        self.variables.iter().zip(x).map(|(of, &x)| of.outer(x)).collect()
    }

    /// What is left of each measured value by these columns of the model.
    fn left(&self, models: &[bg_model::simulation::Column]) -> DVector<f64> {
        let mut residuals = Vec::with_capacity(self.data.count());
        for (column, noise) in self.data.columns.iter().zip(&self.noise) {
            let both = column.values.iter().zip(&models[column.output].values);
            residuals.extend(both.filter_map(|(measured, model)| Some((model - (*measured)?) / noise)));
        }
        DVector::from_vec(residuals)
    }

    /// Their derivatives by the variables, all finite: of a variable with one that is not, no step would be known.
    fn slopes(&self, values: &[f64], found: &Sensitivities) -> Result<DMatrix<f64>, SensitivityError> {
        let mut slopes = Vec::with_capacity(self.data.count() * values.len());
        for (column, noise) in self.data.columns.iter().zip(&self.noise) {
            for k in (0..column.values.len()).filter(|&k| column.values[k].is_some()) {
                for (l, (variable, &value)) in self.variables.iter().zip(values).enumerate() {
                    let slope = found.of(l, column.output)[k];
                    if !slope.is_finite() {
                        let output = self.runs.model.description().outputs[column.output].name;
                        let (by, t) = (variable.info.name, self.data.times[k]);
                        return Err(SensitivityError::NoDerivative { output, by, t });
                    }
                    slopes.push(slope * variable.slope(value) / noise);
                }
            }
        }
        Ok(DMatrix::from_row_slice(self.data.count(), values.len(), &slopes))
    }

    fn tell(&mut self, values: &[f64], residuals: &DVector<f64>) {
        (self.told)(values, residuals.norm() / (residuals.len() as f64).sqrt());
    }
}

impl Problem for Misfit<'_> {
    type Error = SensitivityError;

    fn residuals(&mut self, x: &DVector<f64>) -> Result<DVector<f64>, SensitivityError> {
        let values = self.values(x);
        let residuals = self.left(&self.runs.plain(&values)?.columns);
        self.tell(&values, &residuals);
        Ok(residuals)
    }

    fn linear(&mut self, x: &DVector<f64>) -> Result<fit::Linear, SensitivityError> {
        let values = self.values(x);
        let is_start = self.latest.is_none();
        if self.latest.as_ref().is_none_or(|(there, _)| there != x) {
            self.latest = Some((x.clone(), self.runs.with(&values)?));
            self.derivatives += 1;
        }
        let (_, found) = self.latest.as_ref().expect("it was just made");
        let (residuals, slopes) = (self.left(&found.trajectory.columns), self.slopes(&values, found)?);
        if is_start {
            self.tell(&values, &residuals);
        }
        Ok((residuals, slopes))
    }
}

/// A measured column beside the values of a run with the relative tolerance `rtol`.
fn column(measured: &Measured, model: &[f64], rtol: f64) -> Column {
    let residuals = measured.values.iter().zip(model).filter_map(|(value, model)| Some(model - (*value)?));
    let size = measured.values.iter().flatten().fold(0.0_f64, |size, value| size.max(value.abs()));
    let error = size * (OWN_ERROR * rtol).clamp(EXACT, MOST_OWN);
    let left = noise::left(&residuals.collect::<Vec<_>>(), spread(&measured.values), error);
    Column { output: measured.output, model: model.to_vec(), left }
}

/// The root of the mean square of what a column is off its mean; of a constant one its size, or 1.
fn spread(values: &[Option<f64>]) -> f64 {
    let values: Vec<f64> = values.iter().flatten().copied().collect();
    let count = values.len().max(1) as f64;
    let mean = values.iter().fold(0.0, |sum, value| sum + value) / count;
    let square = values.iter().fold(0.0, |sum, value| sum + (value - mean) * (value - mean)) / count;
    let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    match (square.sqrt(), size) {
        (spread, size) if spread > EXACT * size => spread,
        (_, size) if size > 0.0 => size,
        _ => 1.0,
    }
}

/// The noise of each column: what its residuals come to.
fn noise_of(data: &Data, models: &[bg_model::simulation::Column], sizes: &[f64]) -> Vec<f64> {
    let of = |(column, size): (&Measured, &f64)| {
        let of_model = &models[column.output].values;
        let residuals = column.values.iter().zip(of_model).filter_map(|(value, model)| Some(model - (*value)?));
        let (sum, count) = residuals.fold((0.0, 0), |(sum, count), residual| (sum + residual * residual, count + 1));
        (sum / f64::from(count.max(1))).sqrt().max(EXACT * size)
    };
    data.columns.iter().zip(sizes).map(of).collect()
}

/// How many values speak of the noise, beyond those that the parameters take: of columns that the model meets to
/// rounding, such as a place that never moves, none does, unless there are no others.
fn freedom(data: &Data, noise: &[f64], sizes: &[f64], parameters: usize) -> f64 {
    let count = |column: &Measured| column.values.iter().flatten().count();
    let columns = data.columns.iter().zip(noise).zip(sizes);
    let noisy: usize =
        columns.filter(|((_, noise), size)| **noise > EXACT * **size).map(|((column, _), _)| count(column)).sum();
    let values = if noisy > parameters { noisy } else { data.count() };
    (values - parameters) as f64
}

/// What a fit says of the parameters.
fn identified(
    variables: &[Variable],
    fitted: &Fitted,
    freedom: f64,
    columns: Vec<Column>,
    (evaluations, derivatives): (usize, usize),
) -> Identified {
    let (rows, parameters) = fitted.jacobian.shape();
    let names = |part: &(usize, f64)| (variables[part.0].info.name, part.1);
    let norms: Vec<f64> = fitted.jacobian.column_iter().map(|column| column.norm()).collect();
    let scaled =
        DMatrix::from_fn(
            rows,
            parameters,
            |row, k| if norms[k] > 0.0 { fitted.jacobian[(row, k)] / norms[k] } else { 0.0 },
        );
    let svd = scaled.svd(false, true);
    let largest = svd.singular_values.max();
    let right = svd.v_t.as_ref().expect("it was asked for");
    let is_weak = |k: &usize| svd.singular_values[*k] <= SAME * largest;
    // In parts of the variables' sizes, the largest 1; nothing of those that move no residual at all, which come by
    // themselves.
    let parts = |row: usize| {
        let part = |k: usize| if norms[k] > 0.0 { right[(row, k)] / (norms[k] * variables[k].size()) } else { 0.0 };
        let mut parts: Vec<(usize, f64)> = (0..parameters).map(|k| (k, part(k))).collect();
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let largest = parts[0].1;
        parts.iter_mut().for_each(|(_, part)| *part /= largest);
        parts.retain(|(_, part)| part.abs() >= NAMED);
        parts
    };
    let is_of_others = |row: &usize| (0..parameters).any(|k| norms[k] > 0.0 && right[(*row, k)].abs() > SAME);
    let without_influence = (0..parameters).filter(|&k| norms[k] == 0.0).map(|k| vec![(k, 1.0)]);
    let combined = (0..svd.singular_values.len()).filter(is_weak).filter(is_of_others).map(parts);
    let undetermined: Vec<Vec<(usize, f64)>> = without_influence.chain(combined).collect();
    let is_undetermined = |k: usize| undetermined.iter().flatten().any(|(named, _)| *named == k);
    let variance = fitted.residuals.norm_squared() / freedom;
    let covariance = DMatrix::from_fn(parameters, parameters, |i, j| {
        let strong = (0..svd.singular_values.len()).filter(|k| !is_weak(k));
        let sum = strong.fold(0.0, |sum, k| {
            sum + right[(k, i)] * right[(k, j)] / (svd.singular_values[k] * svd.singular_values[k])
        });
        variance * sum / (norms[i] * norms[j])
    });
    let quantile = student(freedom);
    let is_noise = columns.iter().all(|column| column.left.fault.is_none());
    let estimates = variables.iter().enumerate().map(|(k, variable)| {
        let off = quantile * covariance[(k, k)].sqrt();
        let ends = [fitted.x[k] - off, fitted.x[k] + off].map(|end| variable.outer(end));
        let interval = (is_noise && !is_undetermined(k) && !fitted.held[k] && ends.iter().all(|end| end.is_finite()))
            .then_some(ends);
        Estimate { variable: variable.clone(), value: variable.outer(fitted.x[k]), interval, is_held: fitted.held[k] }
    });
    let correlation = |i: usize, j: usize| {
        if is_undetermined(i) || is_undetermined(j) {
            f64::NAN
        } else {
            covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
        }
    };
    Identified {
        estimates: estimates.collect(),
        correlations: DMatrix::from_fn(parameters, parameters, correlation),
        undetermined: undetermined.iter().map(|parts| parts.iter().map(names).collect()).collect(),
        columns,
        evaluations,
        derivatives,
        starts: 1,
        has_converged: fitted.has_converged,
    }
}

/// The number that a variable of Student's distribution with so many degrees of freedom stays below in magnitude with
/// 95 %: expansion 26.7.5 of Abramowitz and Stegun, Handbook of Mathematical Functions (1964); within 1e-3 from 5
/// degrees on.
fn student(freedom: f64) -> f64 {
    const NORMAL: f64 = 1.959_963_984_540_054;
    let x = NORMAL;
    let odd = |power: i32| x.powi(power);
    let first = (odd(3) + x) / 4.0;
    let second = (5.0 * odd(5) + 16.0 * odd(3) + 3.0 * x) / 96.0;
    let third = (3.0 * odd(7) + 19.0 * odd(5) + 17.0 * odd(3) - 15.0 * x) / 384.0;
    let fourth = (79.0 * odd(9) + 776.0 * odd(7) + 1482.0 * odd(5) - 1920.0 * odd(3) - 945.0 * x) / 92160.0;
    x + (first + (second + (third + fourth / freedom) / freedom) / freedom) / freedom
}

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::bond_graph;
    use bg_model::mechanism::Mechanism;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, quantile) in [(5.0, 2.5706), (10.0, 2.2281), (30.0, 2.0423), (1e9, 1.95996)] {
            assert!((student(freedom) - quantile).abs() < 1e-3, "{freedom}: {}", student(freedom));
        }
    }

    bond_graph! {
        /// A tank that fills, and the root of what is in it.
        graph Tank {
            param rate: m^3/s = 2e-3; param whole: m^3 = 1; param stiffness: Pa/m^3 = 1e4;
            0 tank: hydraulic; Sf pump = rate; C water = stiffness start 0;
            pump -> tank; tank -> water;
            observe { root: 1 = sqrt(water.q / whole) }
        }
    }

    /// The rate that is found from roots at these times, of a true one of 3e-3 m^3/s.
    fn found(times: &[f64]) -> Result<f64, IdentifyError> {
        let model = Tank::new(TankParameters::default()).expect("in range");
        let values = times.iter().map(|t| Some((3e-3 * t).sqrt())).collect();
        let column = Measured { name: "root".to_owned(), output: 0, values };
        let data = Data { times: times.to_vec(), columns: vec![column], ignored: Vec::new() };
        let info = &Tank::describe().parameters[0];
        let rate = Variable { info, start: 2e-3, lower: 0.0, upper: f64::INFINITY };
        let found = identify(&model, &Request::default(), &data, &[rate], &mut |_, _| {})?;
        Ok(found.estimates[0].value)
    }

    #[test]
    fn a_value_without_a_derivative_is_refused_and_no_start_is_found() {
        let times = [0.25, 0.5, 0.75, 1.0];
        let rate = found(&times).expect("derivatives");
        assert!((rate - 3e-3).abs() < 1e-9, "{rate}");
        let fault = found(&[&[0.0], &times[..]].concat()).expect_err("a root at zero").to_string();
        assert!(fault.contains("`root` has no derivative by `rate` at t = 0.0 s"), "{fault}");
    }
}
