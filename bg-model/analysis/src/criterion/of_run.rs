//! Criteria of a run, with exact derivatives by parameters.
//!
//! In: criteria, a model, what is asked of a run. Out: what is known of a run for all of them; the same with slopes.
//! Method: largest and least values are those of the solution ([`PeakMonitor`]); the derivative of one is that of the
//! signal at its instant, since the instant does not count there, or where it lies at an event, that of the signal as
//! the event moves. What is over time is of straight lines between samples, and so is its derivative.

use std::cell::RefCell;

use bg_model::dynamics::Machine;
use bg_model::mechanism::Followed;
use bg_model::run::{Request, RunError, Trajectory, observed, sample_times};
use bg_model::scalar::{Gradient, Scalar};
use bg_model::sensitivity::{Direction, Sensitivities, SensitivityError, sensitivities_of};
use bg_model::simulation::{Part, PeakMonitor, Peaks, Samples, Watched};
use bg_units::Unit;

use super::tree::{Leaves, Node};
use super::{Criteria, CriterionKind, Known, in_si, size};

/// In how many parts of a window largest and least values are known each.
pub const PARTS: usize = 12;

/// What is looked at of a run for some criteria.
#[derive(Clone, Debug)]
pub struct Look {
    criteria: Criteria,
    /// The instants of the samples, s.
    rows: Vec<f64>,
    /// The window of each measure, s.
    windows: Vec<[f64; 2]>,
    /// Those in which peaks are looked for, each once.
    of_peaks: Vec<[f64; 2]>,
    /// The units of all outputs, and the size of all parameters' units in SI.
    units: Vec<Unit>,
    sizes: Vec<f64>,
    t_end: f64,
}

/// A time that a run does not have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a criterion asks for t = {t} s, and the run ends at {t_end} s")]
pub struct Outside {
    /// The time, s.
    pub t: f64,
    /// The end of the run, s.
    pub t_end: f64,
}

/// Where the signal of a measure is largest and least, over its window and in each part of it.
#[derive(Clone, Debug)]
struct Extremes {
    whole: Peaks,
    parts: Vec<Option<Peaks>>,
}

/// What is known of a run.
#[derive(Debug)]
pub struct Found {
    /// All measures.
    pub known: Known<f64>,
    /// The run.
    pub run: Trajectory,
    /// Of measures that are of peaks.
    extremes: Vec<Option<Extremes>>,
}

/// The slopes of all measures, a few directions each.
#[derive(Debug)]
pub struct Slopes {
    known: Vec<Known<Gradient>>,
    directions: usize,
}

impl Slopes {
    /// The derivatives of a criterion, in coherent SI per the unit of each direction.
    #[must_use]
    pub fn of(&self, criteria: &Criteria, criterion: &super::Criterion) -> Vec<f64> {
        let of = |known: &Known<Gradient>| criteria.value(criterion, known).slopes();
        self.known.iter().flat_map(of).take(self.directions).collect()
    }
}

impl Look {
    /// That of a run until `t_end` (s), with samples `step` (s) apart.
    ///
    /// # Errors
    /// A criterion asks for a time after that.
    pub fn new(criteria: Criteria, step: f64, t_end: f64) -> Result<Self, Outside> {
        let is_over_time = criteria.measures.iter().any(|measure| measure.kind.is_over_time());
        let mut rows = if is_over_time { sample_times(0.0, step, t_end) } else { vec![0.0, t_end] };
        let (mut windows, mut of_peaks) = (Vec::new(), Vec::new());
        for measure in &criteria.measures {
            let [from, to] = measure.window.unwrap_or([0.0, t_end]);
            let to = if to.is_finite() { to } else { t_end };
            let at = if let CriterionKind::At(t) = measure.kind { t } else { from };
            if let Some(&t) = [from, to, at].iter().find(|t| !(0.0..=t_end).contains(*t)) {
                return Err(Outside { t, t_end });
            }
            windows.push([from, to]);
            if measure.kind.is_of_peaks() && !of_peaks.contains(&[from, to]) {
                of_peaks.push([from, to]);
            }
            rows.extend([from, to, at]);
        }
        rows.sort_unstable_by(f64::total_cmp);
        rows.dedup();
        let units = in_si(criteria.model.outputs.iter().map(|output| output.unit));
        let sizes = criteria.model.parameters.iter().map(size).collect();
        Ok(Self { criteria, rows, windows, of_peaks, units, sizes, t_end })
    }

    /// The criteria.
    #[must_use]
    pub const fn criteria(&self) -> &Criteria {
        &self.criteria
    }

    /// The measures that are of peaks, by their places.
    fn peaked(&self) -> Vec<usize> {
        let measures = self.criteria.measures.iter().enumerate();
        measures.filter(|(_, measure)| measure.kind.is_of_peaks()).map(|(place, _)| place).collect()
    }

    /// The parts of the windows in which peaks are looked for.
    fn parts(&self) -> Vec<[f64; 2]> {
        let split = |&[from, to]: &[f64; 2]| {
            let end = move |k: usize| if k == PARTS { to } else { from + (to - from) * k as f64 / PARTS as f64 };
            (0..PARTS).map(move |k| [end(k), end(k + 1)])
        };
        self.of_peaks.iter().flat_map(split).collect()
    }

    /// The first part of the window of a measure.
    fn first_part(&self, measure: usize) -> usize {
        PARTS * self.of_peaks.iter().position(|window| *window == self.windows[measure]).unwrap_or_default()
    }

    fn request(&self, request: &Request, rows: Vec<f64>) -> Request {
        Request {
            samples: Samples::At(rows),
            parts: vec![Part::Outputs],
            peaks: false,
            settled: None,
            t_end: self.t_end,
            ..request.clone()
        }
    }

    /// What is known of a run of `machine`, the model with these values of its parameters.
    ///
    /// # Errors
    /// It cannot start, or stops before its end.
    pub fn run(&self, machine: &dyn Machine, values: &[f64], request: &Request) -> Result<Found, RunError> {
        let (peaked, parts) = (self.peaked(), self.parts());
        let parameters: Vec<f64> = values.iter().zip(&self.sizes).map(|(value, size)| value * size).collect();
        let signals = Signals {
            machine,
            look: self,
            parameters: &parameters,
            nodes: peaked.iter().map(|&place| &self.criteria.measures[place].signal).collect(),
            outputs: RefCell::new(vec![0.0; self.units.len()]),
        };
        let mut monitor = PeakMonitor::within(&signals, &parts);
        let request = self.request(request, self.rows.clone());
        let run = if peaked.is_empty() {
            observed(machine, &request, &mut ())?
        } else {
            observed(machine, &request, &mut monitor)?
        };
        let mut extremes: Vec<Option<Extremes>> = vec![None; self.criteria.measures.len()];
        for (signal, &place) in peaked.iter().enumerate() {
            let first = self.first_part(place);
            let found: Vec<Option<Peaks>> = (first..first + PARTS).map(|part| monitor.peaks_in(part, signal)).collect();
            let whole = found.iter().flatten().copied().reduce(merged);
            extremes[place] = whole.map(|whole| Extremes { whole, parts: found });
        }
        let rows = Rows { t: run.recording.times.clone(), outputs: self.outputs_in_si(&run) };
        let measures = self.criteria.measures.iter().zip(&extremes).zip(&self.windows);
        let measures = measures.map(|((measure, extremes), window)| {
            let whole = extremes.as_ref().map(|of| of.whole);
            match measure.kind {
                CriterionKind::Max => whole.map_or(f64::NAN, |of| of.largest.value),
                CriterionKind::Min => whole.map_or(f64::NAN, |of| of.least.value),
                CriterionKind::Range => whole.map_or(f64::NAN, |of| of.largest.value - of.least.value),
                CriterionKind::TimeOfMax => whole.map_or(f64::NAN, |of| of.largest.t),
                CriterionKind::TimeOfMin => whole.map_or(f64::NAN, |of| of.least.t),
                kind => kind.of_rows(&rows, &measure.signal, &parameters, *window),
            }
        });
        let measures = measures.collect();
        let pieces = self.criteria.measures.iter().zip(&extremes).map(|(measure, extremes)| {
            let Some(Extremes { whole, parts }) = extremes else { return Vec::new() };
            let of = |part: &Option<Peaks>| part.unwrap_or(*whole);
            match measure.kind {
                CriterionKind::Max => parts.iter().map(|part| of(part).largest.value).collect(),
                CriterionKind::Min => parts.iter().map(|part| of(part).least.value).collect(),
                _ => Vec::new(),
            }
        });
        let pieces = pieces.collect();
        Ok(Found { known: Known { parameters, measures, pieces }, run, extremes })
    }

    fn outputs_in_si(&self, run: &Trajectory) -> Vec<Vec<f64>> {
        let columns = run.recording.columns.iter().zip(&self.units);
        columns.map(|(column, unit)| column.values.iter().map(|&value| unit.in_si(value)).collect()).collect()
    }

    /// The slopes of all measures of a run that was made of `model` with these values of its parameters, along
    /// directions that are parameters.
    ///
    /// # Errors
    /// The run has no derivatives.
    pub fn slopes(
        &self,
        model: &dyn Followed,
        values: &[f64],
        request: &Request,
        directions: &[Direction],
        found: &Found,
    ) -> Result<Slopes, SensitivityError> {
        let mut rows = self.rows.clone();
        for Extremes { whole, parts } in found.extremes.iter().flatten() {
            let peaks = parts.iter().flatten().chain([whole]);
            rows.extend(peaks.flat_map(|Peaks { least, largest }| [least.t, largest.t]));
        }
        rows.sort_unstable_by(f64::total_cmp);
        rows.dedup();
        let outputs = self.criteria.outputs();
        let request = self.request(request, rows);
        let run = sensitivities_of(model, values, &request, directions, &outputs)?;
        let sloped = Sloped { look: self, run: &run, outputs: &outputs, values, directions };
        let chunks = (0..directions.len()).step_by(Gradient::WIDTH);
        let known = chunks.map(|first| sloped.known(first, found)).collect();
        Ok(Slopes { known, directions: directions.len() })
    }
}

/// The least and the largest of both.
fn merged(a: Peaks, b: Peaks) -> Peaks {
    Peaks {
        least: if b.least.value < a.least.value { b.least } else { a.least },
        largest: if b.largest.value > a.largest.value { b.largest } else { a.largest },
    }
}

/// The signals of measures, as functions of time and state.
struct Signals<'a> {
    machine: &'a dyn Machine,
    look: &'a Look,
    parameters: &'a [f64],
    nodes: Vec<&'a Node>,
    outputs: RefCell<Vec<f64>>,
}

impl Watched for Signals<'_> {
    fn count(&self) -> usize {
        self.nodes.len()
    }

    fn states(&self) -> usize {
        self.machine.states()
    }

    fn values(&self, t: f64, x: &[f64], negative: &[bool], values: &mut [f64]) {
        let mut outputs = self.outputs.borrow_mut();
        self.machine.outputs(t, x, negative, &mut outputs);
        outputs.iter_mut().zip(&self.look.units).for_each(|(value, unit)| *value = unit.in_si(*value));
        let leaves = Leaves { t, outputs: &outputs, parameters: self.parameters, measures: &[], pieces: &[] };
        values.iter_mut().zip(&self.nodes).for_each(|(value, node)| *value = node.value(&leaves));
    }
}

/// The outputs at the samples, a column each, in coherent SI.
struct Rows<S> {
    t: Vec<f64>,
    outputs: Vec<Vec<S>>,
}

impl<S: Scalar> Rows<S> {
    /// A signal at the sample of this number.
    fn signal(&self, node: &Node, parameters: &[S], row: usize) -> S {
        let nothing = || S::from_f64(0.0);
        let outputs: Vec<S> =
            self.outputs.iter().map(|column| column.get(row).copied().unwrap_or_else(nothing)).collect();
        node.value(&Leaves { t: S::from_f64(self.t[row]), outputs: &outputs, parameters, measures: &[], pieces: &[] })
    }
}

impl CriterionKind {
    /// This number of a signal that is known at samples, over a window.
    fn of_rows<S: Scalar>(self, rows: &Rows<S>, node: &Node, parameters: &[S], [from, to]: [f64; 2]) -> S {
        let inside: Vec<usize> = (0..rows.t.len()).filter(|&row| (from..=to).contains(&rows.t[row])).collect();
        let number = |value: f64| S::from_f64(value);
        let signal = |row: usize| rows.signal(node, parameters, row);
        let mean_of = |values: &[S]| {
            let mut area = number(0.0);
            for k in 1..values.len() {
                let h = rows.t[inside[k]] - rows.t[inside[k - 1]];
                area = area + (values[k] + values[k - 1]).times(0.5 * h);
            }
            area
        };
        let length = to - from;
        let values = || inside.iter().map(|&row| signal(row)).collect::<Vec<S>>();
        let mean = |values: &[S]| mean_of(values).times(1.0 / length);
        let root = |square: S| if square.to_f64() > 0.0 { square.sqrt() } else { number(0.0) };
        match self {
            Self::Mean => mean(&values()),
            Self::Integral => mean_of(&values()),
            Self::Rms => root(mean(&values().into_iter().map(|value| value * value).collect::<Vec<_>>())),
            Self::Deviation => {
                let values = values();
                let middle = mean(&values);
                let off = values.into_iter().map(|value| (value - middle) * (value - middle)).collect::<Vec<_>>();
                root(mean(&off))
            }
            Self::Final => inside.last().map_or_else(|| number(f64::NAN), |&row| signal(row)),
            Self::At(t) => {
                let row = rows.t.iter().position(|&row| row >= t).unwrap_or(rows.t.len() - 1);
                signal(row)
            }
            Self::Crossings(level) => {
                // A value at the level is on neither side.
                let sides = values().into_iter().map(Scalar::to_f64).filter(|value| *value != level);
                let above: Vec<bool> = sides.map(|value| value > level).collect();
                number(above.windows(2).filter(|pair| pair[0] != pair[1]).count() as f64)
            }
            Self::Max | Self::Min | Self::Range | Self::TimeOfMax | Self::TimeOfMin => number(f64::NAN),
        }
    }
}

/// A run with its derivatives.
struct Sloped<'a> {
    look: &'a Look,
    run: &'a Sensitivities,
    /// The outputs that are known with slopes.
    outputs: &'a [usize],
    values: &'a [f64],
    directions: &'a [Direction],
}

impl Sloped<'_> {
    /// All measures with their slopes along as many directions as a number has, from the direction `first` on.
    fn known(&self, first: usize, found: &Found) -> Known<Gradient> {
        let Look { criteria, windows, rows, sizes, .. } = self.look;
        let parameters: Vec<Gradient> = (self.values.iter().zip(sizes).enumerate())
            .map(|(place, (value, size))| Gradient::new(value * size, self.slopes(first, |l| self.by(l, place) * size)))
            .collect();
        let times = &self.run.trajectory.recording.times;
        let is_row = |t: &f64| rows.binary_search_by(|row| row.total_cmp(t)).is_ok();
        let at_rows: Vec<usize> = (0..times.len()).filter(|&row| is_row(&times[row])).collect();
        let columns = (0..self.look.units.len()).map(|output| {
            if self.outputs.binary_search(&output).is_ok() {
                at_rows.iter().map(|&row| self.output(first, output, row)).collect()
            } else {
                Vec::new()
            }
        });
        let rows = Rows { t: at_rows.iter().map(|&row| times[row]).collect(), outputs: columns.collect() };
        let peak = |place: usize, peaks: &Peaks, is_largest: bool| {
            let peak = if is_largest { peaks.largest } else { peaks.least };
            self.at(first, &criteria.measures[place].signal, &parameters, peak.t, peak.value)
        };
        let mut measures = Vec::with_capacity(criteria.measures.len());
        let mut pieces = Vec::with_capacity(criteria.measures.len());
        for (place, measure) in criteria.measures.iter().enumerate() {
            let extremes = found.extremes[place].as_ref();
            let of_whole = |is_largest: bool| extremes.map(|of| peak(place, &of.whole, is_largest));
            let none = Gradient::from_f64(f64::NAN);
            measures.push(match measure.kind {
                CriterionKind::Max => of_whole(true).unwrap_or(none),
                CriterionKind::Min => of_whole(false).unwrap_or(none),
                CriterionKind::Range => of_whole(true).zip(of_whole(false)).map_or(none, |(high, low)| high - low),
                CriterionKind::TimeOfMax | CriterionKind::TimeOfMin | CriterionKind::Crossings(_) => none,
                kind => kind.of_rows(&rows, &measure.signal, &parameters, windows[place]),
            });
            let is_largest = measure.kind == CriterionKind::Max;
            let parts = extremes.filter(|_| is_largest || measure.kind == CriterionKind::Min);
            pieces.push(parts.map_or_else(Vec::new, |of| {
                of.parts.iter().map(|part| peak(place, part.as_ref().unwrap_or(&of.whole), is_largest)).collect()
            }));
        }
        Known { parameters, measures, pieces }
    }

    fn slopes(&self, first: usize, of: impl Fn(usize) -> f64) -> [f64; Gradient::WIDTH] {
        std::array::from_fn(|l| if first + l < self.directions.len() { of(first + l) } else { 0.0 })
    }

    /// The derivative of a parameter along a direction.
    fn by(&self, direction: usize, parameter: usize) -> f64 {
        f64::from(u8::from(self.directions[direction] == Direction::Parameter(parameter)))
    }

    fn output(&self, first: usize, output: usize, row: usize) -> Gradient {
        let unit = self.look.units[output];
        let value = self.run.trajectory.recording.columns[output].values[row];
        Gradient::new(unit.in_si(value), self.slopes(first, |l| unit.in_si(self.run.of(l, output)[row])))
    }

    /// A signal at `t` (s), where it is `value`: at an event the side that has it.
    fn at(&self, first: usize, node: &Node, parameters: &[Gradient], t: f64, value: f64) -> Gradient {
        let times = &self.run.trajectory.recording.times;
        let outputs = |of: &dyn Fn(usize) -> Gradient| -> Vec<Gradient> {
            let mut all = vec![Gradient::from_f64(0.0); self.look.units.len()];
            self.outputs.iter().for_each(|&output| all[output] = of(output));
            all
        };
        let of = |t: Gradient, outputs: &[Gradient]| {
            node.value(&Leaves { t, outputs, parameters, measures: &[], pieces: &[] })
        };
        let off = |found: &Gradient| (found.value - value).abs();
        let events = self.run.events.iter().filter(|event| event.t == t);
        let sides = events.flat_map(|event| [0, 1].map(|side| (event, side))).map(|(event, side)| {
            let moved = Gradient::new(t, self.slopes(first, |l| event.slopes[l].instant));
            let outputs = outputs(&|output| {
                let unit = self.look.units[output];
                let slopes = self.slopes(first, |l| unit.in_si(event.slopes[l].outputs[side][output]));
                Gradient::new(unit.in_si(event.values[side][output]), slopes)
            });
            of(moved, &outputs)
        });
        let nearest = sides.reduce(|best, other| if off(&other) < off(&best) { other } else { best });
        nearest.unwrap_or_else(|| {
            let row = times.partition_point(|&row| row < t).min(times.len() - 1);
            of(Gradient::from_f64(times[row]), &outputs(&|output| self.output(first, output, row)))
        })
    }
}
