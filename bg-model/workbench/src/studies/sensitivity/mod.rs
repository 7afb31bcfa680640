//! Which parameter moves which output: measures of each output and their derivatives by each parameter.
//!
//! In: a run with its derivatives. Out: a number for each output, measure and parameter, as a table and as CSV.
//! The derivative of the largest value is that of the output where it is largest, since there the instant does not
//! count.

pub mod figure;

use bg_model::description::{OutputInfo, ParameterInfo};
use bg_model::sensitivity::Sensitivities;

use crate::ask::parameters::number;
use crate::files::table::table;

/// What is asked of an output over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Its value at a time, s.
    At(f64),
    /// Its last value.
    Final,
    /// Its value of largest magnitude at a sample: the run has one at each peak.
    Largest,
    /// Its mean over time.
    Mean,
    /// The root of its mean square.
    Rms,
    /// The root of the mean square over time; its derivative is that of the difference of two courses, and no sign is
    /// known.
    Course,
}

impl Measure {
    /// What is always asked.
    pub const ALL: [Self; 5] = [Self::Final, Self::Largest, Self::Mean, Self::Rms, Self::Course];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::At(t) => format!("at {t} s"),
            Self::Final => "final".to_owned(),
            Self::Largest => "max".to_owned(),
            Self::Mean => "mean".to_owned(),
            Self::Rms => "rms".to_owned(),
            Self::Course => "course".to_owned(),
        }
    }

    /// The measure of an output with `values` at `times` (s), and its derivative, that of the output being `slopes`.
    fn of(self, times: &[f64], values: &[f64], slopes: &[f64]) -> [f64; 2] {
        let at = |k: usize| [values[k], slopes[k]];
        let rms = |of: &[f64]| mean(times, of.iter().map(|value| value * value)).sqrt();
        match self {
            Self::At(t) => at(nearest(times, t)),
            Self::Final => at(values.len() - 1),
            Self::Largest => {
                let k =
                    (0..values.len()).fold(0, |best, k| if values[k].abs() > values[best].abs() { k } else { best });
                at(k)
            }
            Self::Mean => [values, slopes].map(|of| mean(times, of.iter().copied())),
            Self::Rms => {
                let size = rms(values);
                let product = mean(times, values.iter().zip(slopes).map(|(value, slope)| value * slope));
                [size, if size == 0.0 { 0.0 } else { product / size }]
            }
            Self::Course => [rms(values), rms(slopes)],
        }
    }
}

/// The mean over time of what has these values at `times`, by trapezoids; of one value that value.
fn mean(times: &[f64], values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let length = times[times.len() - 1] - times[0];
    if length <= 0.0 {
        return values[values.len() - 1];
    }
    let area = (1..times.len()).map(|k| 0.5 * (values[k] + values[k - 1]) * (times[k] - times[k - 1]));
    area.fold(0.0, |sum, part| sum + part) / length
}

/// The index of the time nearest to `t`.
fn nearest(times: &[f64], t: f64) -> usize {
    (0..times.len()).fold(0, |best, k| if (times[k] - t).abs() < (times[best] - t).abs() { k } else { best })
}

/// How much one measure of an output changes with a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Which output: its place in the model's description.
    pub output: usize,
    /// The output's name.
    pub name: &'static str,
    /// The output's unit.
    pub unit: &'static str,
    /// What of it.
    pub measure: Measure,
    /// Its value, in the output's unit.
    pub value: f64,
    /// The parameter's name.
    pub parameter: &'static str,
    /// The parameter's unit.
    pub per: &'static str,
    /// The parameter's value, in its unit.
    pub at: f64,
    /// The derivative, in the output's unit per the parameter's.
    pub derivative: f64,
}

impl Influence {
    /// By how many per cent the measure changes for one per cent of the parameter; none where the measure is zero.
    #[must_use]
    pub fn relative(&self) -> Option<f64> {
        let relative = self.derivative * self.at / self.value;
        relative.is_finite().then_some(relative)
    }

    /// The derivative's unit.
    #[must_use]
    pub fn derivative_unit(&self) -> String {
        quotient(self.unit, self.per)
    }
}

/// The unit `unit` per `per`.
pub(crate) fn quotient(unit: &str, per: &str) -> String {
    let plain = |unit: &str| if unit.is_empty() { "1".to_owned() } else { unit.to_owned() };
    match (plain(unit), plain(per)) {
        (unit, per) if per == "1" => unit,
        (unit, per) if unit == per => "1".to_owned(),
        (unit, per) if per.contains(['*', '/']) => format!("{unit}/({per})"),
        (unit, per) => format!("{unit}/{per}"),
    }
}

/// What is asked about: outputs by their places in the model's description, parameters with their values, in the order
/// of the directions of `found`.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The outputs, each with its place.
    pub outputs: &'a [(usize, &'static OutputInfo)],
    /// The parameters with their values.
    pub parameters: &'a [(&'static ParameterInfo, f64)],
    /// What of each output.
    pub measures: &'a [Measure],
    /// The instants of the samples that all measures are made from, s, ascending. Other samples of the run are at its
    /// peaks, and count for the largest value only.
    pub rows: &'a [f64],
}

impl Question<'_> {
    fn is_row(&self, t: f64) -> bool {
        self.rows.binary_search_by(|row| row.total_cmp(&t)).is_ok()
    }
}

/// Every measure of every output by every parameter, in this order.
#[must_use]
pub fn influences(found: &Sensitivities, question: &Question) -> Vec<Influence> {
    let run = &found.trajectory.recording;
    let are_rows: Vec<bool> = run.times.iter().map(|&t| question.is_row(t)).collect();
    let at_rows = |of: &[f64]| of.iter().zip(&are_rows).filter(|(_, is)| **is).map(|(value, _)| *value).collect();
    let times: Vec<f64> = at_rows(&run.times);
    let mut all = Vec::new();
    for &(output, info) in question.outputs {
        for &measure in question.measures {
            for (direction, &(parameter, at)) in question.parameters.iter().enumerate() {
                let (values, slopes) = (&run.columns[output].values, found.of(direction, output));
                let [value, derivative] = match measure {
                    Measure::Largest => measure.of(&run.times, values, slopes),
                    _ => {
                        let [values, slopes]: [Vec<f64>; 2] = [at_rows(values), at_rows(slopes)];
                        measure.of(&times, &values, &slopes)
                    }
                };
                let (name, unit, per) = (info.name, info.unit, parameter.unit);
                all.push(Influence {
                    output,
                    name,
                    unit,
                    measure,
                    value,
                    parameter: parameter.name,
                    per,
                    at,
                    derivative,
                });
            }
        }
    }
    all
}

/// For each output and measure its value, and what moves it: parameters with an influence, the largest relative one
/// first.
#[must_use]
pub fn text(influences: &[Influence], most: usize) -> String {
    let mut rows =
        vec![["output", "measure", "value", "unit", "parameter", "derivative", "unit", "% for 1 %"].map(str::to_owned)];
    for of_measure in influences.chunk_by(|a, b| (a.output, a.measure) == (b.output, b.measure)) {
        let mut sorted: Vec<&Influence> = of_measure.iter().filter(|influence| influence.derivative != 0.0).collect();
        let size = |influence: &Influence| (influence.derivative * influence.at).abs();
        sorted.sort_by(|a, b| size(b).total_cmp(&size(a)));
        for influence in sorted.into_iter().take(most) {
            let relative = influence.relative().map_or_else(|| "-".to_owned(), |relative| format!("{relative:.4}"));
            rows.push([
                influence.name.to_owned(),
                influence.measure.name(),
                format!("{:.6e}", influence.value),
                influence.unit.to_owned(),
                influence.parameter.to_owned(),
                format!("{:.6e}", influence.derivative),
                influence.derivative_unit(),
                relative,
            ]);
        }
    }
    table(&rows)
}

/// All influences as CSV, and whole numbers of digits.
#[must_use]
pub fn csv(influences: &[Influence]) -> String {
    let mut text =
        "output,unit,measure,value,parameter,parameter_unit,parameter_value,derivative,relative\n".to_owned();
    for influence in influences {
        let Influence { name, unit, value, parameter, per, at, derivative, .. } = influence;
        let relative = influence.relative().map_or_else(String::new, |relative| format!("{relative:?}"));
        let measure = influence.measure.name();
        text += &format!("{name},{unit},{measure},{value:?},{parameter},{per},{at:?},{derivative:?},{relative}\n");
    }
    text
}

/// The derivative of one output by one parameter over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// `d(output)/d(parameter)`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its values at the run's samples.
    pub values: Vec<f64>,
}

/// The derivative of each output by each parameter, in this order.
#[must_use]
pub fn courses(found: &Sensitivities, question: &Question) -> Vec<Course> {
    let course = |&(output, info): &(usize, &'static OutputInfo), direction: usize| {
        let (parameter, _) = question.parameters[direction];
        Course {
            name: format!("d({})/d({})", info.name, parameter.name),
            unit: quotient(info.unit, parameter.unit),
            values: found.of(direction, output).to_vec(),
        }
    };
    let directions = 0..question.parameters.len();
    question.outputs.iter().flat_map(|output| directions.clone().map(move |of| course(output, of))).collect()
}

/// Courses at `times` (s) as CSV, with those of the times that are rows of the question.
#[must_use]
pub fn courses_csv(times: &[f64], courses: &[Course], question: &Question) -> String {
    let names: Vec<&str> = courses.iter().map(|course| course.name.as_str()).collect();
    let mut text = format!("t,{}\n", names.join(","));
    for (k, t) in times.iter().enumerate().filter(|(_, t)| question.is_row(**t)) {
        text += &format!("{t:?}");
        for course in courses {
            text += &format!(",{:?}", course.values[k]);
        }
        text.push('\n');
    }
    text
}

/// The parameters of a table that have no influence on any output, by their names with their values.
#[must_use]
pub fn without_influence(influences: &[Influence], question: &Question) -> Vec<String> {
    let moves = |name: &str| influences.iter().any(|of| of.parameter == name && of.derivative != 0.0);
    let still = question.parameters.iter().filter(|(info, _)| !moves(info.name));
    still
        .map(|(info, value)| format!("{} = {} {}", info.name, number(*value), info.unit).trim_end().to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f64; 3] = [0.0, 1.0, 3.0];

    #[test]
    fn measures_and_their_derivatives() {
        let (values, slopes) = ([1.0, -4.0, 2.0], [0.5, 1.0, -3.0]);
        let of = |measure: Measure| measure.of(&TIMES, &values, &slopes);
        assert_eq!(of(Measure::Final), [2.0, -3.0]);
        assert_eq!(of(Measure::At(1.2)), [-4.0, 1.0]);
        assert_eq!(of(Measure::Largest), [-4.0, 1.0]);
        assert_eq!(of(Measure::Mean), [(-1.5 - 2.0) / 3.0, (0.75 - 2.0) / 3.0]);
        let moved = |by: f64| {
            let values: Vec<f64> = values.iter().zip(slopes).map(|(value, slope)| value + by * slope).collect();
            Measure::Rms.of(&TIMES, &values, &slopes)[0]
        };
        assert!((of(Measure::Rms)[1] - (moved(1e-6) - moved(-1e-6)) / 2e-6).abs() < 1e-9);
        assert!(of(Measure::Course)[1] > 0.0);
    }

    #[test]
    fn units_of_derivatives() {
        let unit = |unit: &'static str, per: &'static str| {
            let of = Influence {
                output: 0,
                name: "",
                unit,
                measure: Measure::Final,
                value: 0.0,
                parameter: "",
                per,
                at: 1.0,
                derivative: 2.0,
            };
            assert_eq!(of.relative(), None);
            of.derivative_unit()
        };
        assert_eq!(unit("N", "m"), "N/m");
        assert_eq!(unit("N", "N*s/m"), "N/(N*s/m)");
        assert_eq!((unit("rad", "1"), unit("rad", "rad")), ("rad".to_owned(), "1".to_owned()));
    }
}
