//! Slopes that follow a run: from step to step, over events, into the outputs at the samples.
//!
//! In: what an observer of the run is told. Out: the derivatives of the outputs at each sample, and those of the states
//! at the end.

use std::rc::Rc;

use super::jump::{Jump, jumped};
use super::step::{Steps, set_values};
use super::{AtEvent, Direction, SensitivityError};
use crate::model::assembly::AssemblyError;
use crate::model::dynamics::Machine;
use crate::model::scalar::slopes::WIDTH;
use crate::model::scalar::{Gradient, Scalar};
use crate::solve::integrator::{Point, Scale};
use crate::solve::simulation::{Observer, Switching};

/// As many directions as the steps have slopes.
pub(super) struct Follower {
    parts: Vec<DirectionGroup>,
    /// The system with slopes of nothing.
    plain: Rc<dyn Machine<Gradient>>,
    /// The slopes where the run has come to.
    steps: Box<dyn Steps>,
    /// The last step: its start, its branches.
    start: f64,
    negative: Vec<bool>,
    /// Where the run has come to.
    t: f64,
    has_begun: bool,
    error: Option<SensitivityError>,
    /// The outputs that are asked for.
    outputs: Vec<usize>,
}

/// A few of the directions.
struct DirectionGroup {
    /// The system in numbers that have slopes along them.
    system: Rc<dyn Machine<Gradient>>,
    /// The state at the start.
    begin: Vec<Gradient>,
    /// For each direction and output the derivatives at the samples.
    slopes: Vec<Vec<Vec<f64>>>,
    /// What the outputs are at each event, along these directions.
    events: Vec<AtEvent>,
}

impl DirectionGroup {
    /// Keeps the outputs on both sides of an event.
    fn keep(&mut self, jump: &Jump, event: &Switching) {
        let mut at_event = AtEvent { t: event.before.t, values: [const { Vec::new() }; 2], slopes: Vec::new() };
        let directions = self.slopes.len();
        let sides = jump.at_event.iter().zip([&event.negative_before, &event.negative_after]);
        let mut slopes = vec![[const { Vec::new() }; 2]; directions];
        for (side, (x, negative)) in sides.enumerate() {
            let mut outputs = vec![Gradient::from_f64(0.0); self.system.description().outputs.len()];
            self.system.outputs(jump.t, x, negative, &mut outputs);
            at_event.values[side] = outputs.iter().map(|output| output.value).collect();
            for (l, of) in slopes.iter_mut().enumerate() {
                of[side] = outputs.iter().map(|output| output.slopes()[l]).collect();
            }
        }
        let of = |(l, outputs)| super::AlongEvent { instant: jump.t.slopes()[l], outputs };
        at_event.slopes = slopes.into_iter().enumerate().map(of).collect();
        self.events.push(at_event);
    }
}

impl Follower {
    /// From the start of a run at `t0` (s) along `directions`; `systems` have the slopes along a few of them each,
    /// `plain` along nothing, and `steps` are those of the same system along all of them.
    ///
    /// # Errors
    /// The start cannot be assembled.
    pub fn new(
        systems: Vec<Rc<dyn Machine<Gradient>>>,
        plain: Rc<dyn Machine<Gradient>>,
        steps: Box<dyn Steps>,
        (directions, outputs): (&[Direction], &[usize]),
        t0: f64,
    ) -> Result<Self, AssemblyError> {
        let outputs_of_all = plain.description().outputs.len();
        let part =
            |(system, directions): (Rc<dyn Machine<Gradient>>, &[Direction])| -> Result<DirectionGroup, AssemblyError> {
                let mut begin = system.start()?;
                for (l, direction) in directions.iter().enumerate() {
                    if let Direction::Start(state) = direction {
                        let mut slopes = begin[*state].slopes();
                        slopes[l] += 1.0;
                        begin[*state] = Gradient::new(begin[*state].value, slopes);
                    }
                }
                Ok(DirectionGroup {
                    system,
                    begin,
                    slopes: vec![vec![Vec::new(); outputs_of_all]; directions.len()],
                    events: Vec::new(),
                })
            };
        let parts = systems.into_iter().zip(directions.chunks(WIDTH)).map(part).collect::<Result<_, _>>()?;
        Ok(Self {
            negative: vec![false; plain.switches()],
            parts,
            plain,
            steps,
            start: t0,
            t: t0,
            has_begun: false,
            error: None,
            outputs: outputs.to_vec(),
        })
    }

    /// Begins at the first state of the run, which is to be that of the start. Gives whether it has begun.
    fn has_begun(&mut self, t: f64, x: &[f64], negative: &[bool]) -> bool {
        if self.has_begun {
            return true;
        }
        for (place, DirectionGroup { system, begin, .. }) in self.parts.iter().enumerate() {
            if begin.iter().zip(x).any(|(begin, x)| begin.value != *x) {
                self.error = Some(SensitivityError::ImpactAtStart);
                return false;
            }
            let mut start = begin.clone();
            system.project(Gradient::from_f64(t), negative, &mut start);
            set_values(&mut start, x);
            self.steps.set(place, &start);
        }
        self.has_begun = true;
        true
    }

    /// The derivatives of the states where the run has come to, for each direction.
    pub fn states(&self) -> Vec<Vec<f64>> {
        let of_part = |(place, part): (usize, &DirectionGroup)| {
            let now = self.steps.now(place, &vec![0.0; part.begin.len()]);
            let of = |l: usize| now.iter().map(|state| state.slopes()[l]).collect();
            (0..part.slopes.len()).map(of).collect::<Vec<_>>()
        };
        self.parts.iter().enumerate().flat_map(of_part).collect()
    }

    /// What the outputs are at each event.
    pub fn events(&self) -> Vec<AtEvent> {
        let mut parts = self.parts.iter();
        let mut all = parts.next().map_or_else(Vec::new, |part| part.events.clone());
        for part in parts {
            all.iter_mut().zip(&part.events).for_each(|(at, other)| at.slopes.extend_from_slice(&other.slopes));
        }
        all
    }

    /// For each direction and output the derivatives at the samples.
    pub fn slopes(self) -> impl Iterator<Item = Vec<Vec<f64>>> {
        self.parts.into_iter().flat_map(|part| part.slopes)
    }

    /// What the outputs at the samples and the states have come to.
    ///
    /// # Errors
    /// What has gone wrong first.
    pub fn check(&mut self) -> Result<(), SensitivityError> {
        self.error.take().map_or(Ok(()), Err)
    }
}

impl Observer for Follower {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        if self.error.is_some() {
            return;
        }
        if !self.has_begun(t, x, negative) {
            return;
        }
        let is_inside = t != self.t;
        if is_inside && !self.steps.look(&self.negative, self.start, t) {
            self.error = Some(SensitivityError::Inexact { t });
            return;
        }
        for (place, DirectionGroup { system, slopes, .. }) in self.parts.iter_mut().enumerate() {
            let reached = if is_inside { self.steps.looked_at(place, x) } else { self.steps.now(place, x) };
            let mut outputs = vec![Gradient::from_f64(0.0); system.description().outputs.len()];
            system.outputs(Gradient::from_f64(t), &reached, negative, &mut outputs);
            for &output in &self.outputs {
                let of_output = outputs[output].slopes();
                slopes.iter_mut().zip(of_output).for_each(|(columns, slope)| columns[output].push(slope));
            }
        }
    }

    fn measured(&mut self, scale: &Scale) {
        self.steps.measure(scale);
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        if self.error.is_some() {
            return;
        }
        if !self.has_begun(start.t, start.x.as_slice(), negative) {
            return;
        }
        (self.start, self.t) = (start.t, end.t);
        self.negative.copy_from_slice(negative);
        if !self.steps.pass(negative, start, end) {
            self.error = Some(SensitivityError::Inexact { t: start.t });
        }
    }

    fn switched(&mut self, switching: &Switching) {
        if self.error.is_some() {
            return;
        }
        for (place, part) in self.parts.iter_mut().enumerate() {
            let now = self.steps.now(place, switching.before.x.as_slice());
            let Some(jump) = jumped(&*part.system, &*self.plain, &now, switching) else {
                let switch = switching.reached.iter().position(|&reached| reached).unwrap_or_default();
                let name = part.system.switch_name(switch).unwrap_or("a switch");
                self.error = Some(SensitivityError::Grazes { switch: name, t: switching.before.t });
                return;
            };
            part.keep(&jump, switching);
            self.steps.set(place, &jump.after);
        }
    }

    fn is_done(&self) -> bool {
        self.error.is_some()
    }
}
