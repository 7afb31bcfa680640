//! An instance of a model: what FMI 3.0 asks of one, in safe Rust.
//!
//! In: values by reference, calls in the order of the standard's state machine. Out: values, derivatives, events,
//! steps. Source: Functional Mock-up Interface Specification 3.0.1, sections 2.2 (common), 3 (Model Exchange), 4
//! (Co-Simulation).

mod derivatives;
mod fault;
mod machine;
mod saved;
mod signals;
mod slopes;

use bg_model::description::Description;
use bg_model::run::Request;
use bg_model::simulation::NoNumber;
use bg_model::statistics::Statistics;

use crate::exported::{Exported, Made};
use crate::variables::{Counts, VariableKind, names};
pub use fault::Fault;
pub(crate) use machine::{Stood, nominals_at_start};
pub use saved::Snapshot;
pub(crate) use signals::Signals;
pub(crate) use slopes::{InDuals, Slopes};

/// Which of the two interfaces an instance has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The host integrates.
    ModelExchange,
    /// The instance integrates.
    CoSimulation,
}

/// A state of the standard's state machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Instantiated,
    Initialization,
    Event,
    Continuous,
    Step,
    Terminated,
}

impl Mode {
    const ALL: [Self; 6] =
        [Self::Instantiated, Self::Initialization, Self::Event, Self::Continuous, Self::Step, Self::Terminated];

    /// As the standard calls it.
    const fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "the state Instantiated",
            Self::Initialization => "Initialization Mode",
            Self::Event => "Event Mode",
            Self::Continuous => "Continuous-Time Mode",
            Self::Step => "Step Mode",
            Self::Terminated => "the state Terminated",
        }
    }
}

/// What an event has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// Whether continuous states have jumped.
    pub states_changed: bool,
    /// The next instant at which an event is due, s.
    pub next_event: Option<f64>,
}

/// An instance of a model.
pub struct Instance {
    model: &'static dyn Exported,
    interface: Interface,
    counts: Counts,
    mode: Mode,
    parameters: Vec<f64>,
    signals: Signals,
    /// Time of the start, s.
    start: f64,
    /// Relative tolerance, of steps and of what counts as a drift.
    rtol: f64,
    /// The model, once something has been asked of it with the present parameters.
    made: Option<Made>,
}

impl Instance {
    /// A new instance, in the state Instantiated.
    #[must_use]
    pub fn new(model: &'static dyn Exported, interface: Interface) -> Self {
        let description = model.description();
        Self {
            model,
            interface,
            counts: Counts::of(description),
            mode: Mode::Instantiated,
            parameters: description.parameters.iter().map(|info| info.default).collect(),
            signals: Signals::new(description.inputs.len()),
            start: 0.0,
            rtol: Request::default().rtol,
            made: None,
        }
    }

    /// The model's tables.
    #[must_use]
    pub fn description(&self) -> &'static Description {
        self.model.description()
    }

    /// How many continuous states there are.
    #[must_use]
    pub const fn state_count(&self) -> usize {
        self.counts.states
    }

    /// How many event indicators there are.
    #[must_use]
    pub const fn guard_count(&self) -> usize {
        self.counts.guards
    }

    /// Back to the state Instantiated, everything at its default.
    pub fn reset(&mut self) {
        *self = Self::new(self.model, self.interface);
    }

    /// Begins the initialization at time `start` (s), with a relative tolerance if one is given.
    ///
    /// # Errors
    /// [`Fault::Mode`].
    pub fn enter_initialization(&mut self, start: f64, tolerance: Option<f64>) -> Result<(), Fault> {
        self.only("the initialization", &[Mode::Instantiated])?;
        if !start.is_finite() {
            return Err(Fault::NotFinite { name: "time".to_owned(), value: start });
        }
        (self.start, self.rtol) = (start, tolerance.filter(|t| t.is_finite() && *t > 0.0).unwrap_or(self.rtol));
        (self.made, self.mode) = (None, Mode::Initialization);
        Ok(())
    }

    /// Ends the initialization: loops are closed, branches found.
    ///
    /// # Errors
    /// What keeps the model from its start.
    pub fn exit_initialization(&mut self) -> Result<(), Fault> {
        self.only("the end of the initialization", &[Mode::Initialization])?;
        let (rtol, name) = (self.rtol, self.description().name);
        if self.interface == Interface::ModelExchange && self.machine()?.delays() {
            return Err(Fault::Delays(name));
        }
        self.machine()?.settle(rtol)?;
        self.mode = match self.interface {
            Interface::ModelExchange => Mode::Event,
            Interface::CoSimulation => Mode::Step,
        };
        Ok(())
    }

    /// Ends the simulation; values can still be read.
    ///
    /// # Errors
    /// [`Fault::Mode`].
    pub fn terminate(&mut self) -> Result<(), Fault> {
        self.only("the termination", &[Mode::Event, Mode::Continuous, Mode::Step])?;
        self.mode = Mode::Terminated;
        Ok(())
    }

    /// Begins an event.
    ///
    /// # Errors
    /// [`Fault::Mode`].
    pub fn enter_event(&mut self) -> Result<(), Fault> {
        self.only("an event", &[Mode::Event, Mode::Continuous])?;
        self.mode = Mode::Event;
        Ok(())
    }

    /// Handles an event: branches, impacts, drift.
    ///
    /// # Errors
    /// What keeps the model from going on.
    pub fn update(&mut self) -> Result<Update, Fault> {
        self.only("the update of an event", &[Mode::Event])?;
        let rtol = self.rtol;
        let machine = self.machine()?;
        let states_changed = machine.settle(rtol)?;
        machine.ends_ticks();
        let next_event = Some(machine.next_break()).filter(|t| t.is_finite());
        Ok(Update { states_changed, next_event })
    }

    /// Reads whether clocks tick at this event: whether its update computes their samples.
    ///
    /// # Errors
    /// [`Fault::Mode`], [`Fault::Length`], [`Fault::Reference`], what keeps the model from its start.
    pub fn ticks(&mut self, references: &[u32], values: &mut [bool]) -> Result<(), Fault> {
        same_length("values", values.len(), references.len())?;
        self.only("to ask whether a clock ticks", &[Mode::Initialization, Mode::Event])?;
        let (first, is_event) = (self.counts.clock(0), self.mode == Mode::Event);
        let ticks = self.machine()?.ticks();
        for (value, &reference) in values.iter_mut().zip(references) {
            let index = usize::try_from(reference).ok().and_then(|reference| reference.checked_sub(first));
            let tick = index.and_then(|index| ticks.get(index)).ok_or(Fault::Reference(reference))?;
            *value = *tick && is_event;
        }
        Ok(())
    }

    /// Goes on after an event.
    ///
    /// # Errors
    /// [`Fault::Mode`].
    pub fn enter_continuous(&mut self) -> Result<(), Fault> {
        self.only("continuous time", &[Mode::Event])?;
        self.mode = Mode::Continuous;
        Ok(())
    }

    /// Sets the time, s.
    ///
    /// # Errors
    /// [`Fault::Mode`], [`Fault::NotFinite`].
    pub fn set_time(&mut self, t: f64) -> Result<(), Fault> {
        self.only("to set the time", &[Mode::Event, Mode::Continuous])?;
        if !t.is_finite() {
            return Err(Fault::NotFinite { name: "time".to_owned(), value: t });
        }
        self.machine()?.set_time(t);
        Ok(())
    }

    /// Sets the continuous states. Whether the model can stand in them is looked at where the host completes a step,
    /// and at events.
    ///
    /// # Errors
    /// [`Fault::Mode`], [`Fault::Length`], [`Fault::NotFinite`].
    pub fn set_states(&mut self, x: &[f64]) -> Result<(), Fault> {
        self.only("to set the states", &[Mode::Continuous])?;
        same_length("continuous states", x.len(), self.counts.states)?;
        if let Some(index) = x.iter().position(|value| !value.is_finite()) {
            let name = self.description().states[index].name.to_owned();
            return Err(Fault::NotFinite { name, value: x[index] });
        }
        self.machine()?.set_states(x);
        Ok(())
    }

    /// Reads the continuous states.
    ///
    /// # Errors
    /// [`Fault::Length`], what keeps the model from its start.
    pub fn states(&mut self, x: &mut [f64]) -> Result<(), Fault> {
        same_length("continuous states", x.len(), self.counts.states)?;
        x.copy_from_slice(self.machine()?.states());
        Ok(())
    }

    /// Reads the derivatives of the continuous states.
    ///
    /// # Errors
    /// [`Fault::Length`], [`Fault::NoNumber`], what keeps the model from its start.
    pub fn derivatives(&mut self, dx: &mut [f64]) -> Result<(), Fault> {
        same_length("derivatives", dx.len(), self.counts.states)?;
        self.machine()?.rates(dx);
        self.check_finite(dx, |model, index| (format!("der({})", model.states[index].name), None))
    }

    /// Reads the nominal values of the states, above zero: where an error norm would take them to count.
    ///
    /// # Errors
    /// [`Fault::Length`], what keeps the model from its start.
    pub fn nominals(&mut self, nominals: &mut [f64]) -> Result<(), Fault> {
        same_length("nominal values", nominals.len(), self.counts.states)?;
        nominals.copy_from_slice(&self.machine()?.nominals());
        Ok(())
    }

    /// Reads the event indicators: the guards of the switches in their present branches.
    ///
    /// # Errors
    /// [`Fault::Length`], [`Fault::NoNumber`], what keeps the model from its start.
    pub fn guards(&mut self, guards: &mut [f64]) -> Result<(), Fault> {
        same_length("event indicators", guards.len(), self.counts.guards)?;
        self.machine()?.guards(guards);
        self.check_finite(guards, |model, index| (model.switches[index].name.to_owned(), None))
    }

    /// The host has completed a step. Gives whether an event is needed: the state has drifted off its joints and
    /// orientations by more than the tolerance, and is to be moved back.
    ///
    /// # Errors
    /// [`Fault::Mode`], [`Fault::Misplaced`].
    pub fn completed_step(&mut self) -> Result<bool, Fault> {
        self.only("the end of a step", &[Mode::Continuous])?;
        let rtol = self.rtol;
        self.machine()?.drifts(rtol)
    }

    /// Makes a step of Co-Simulation, from time `t` of length `h` (s). On failure the time is that of the last good
    /// state.
    ///
    /// # Errors
    /// Why the run stopped; an unusable step.
    pub fn step(&mut self, t: f64, h: f64) -> Result<(), Fault> {
        /// A communication point is met to this part of the step, or of the time: hosts add up steps.
        const NEAR: f64 = 1e-9;
        self.only("a step", &[Mode::Step])?;
        let rtol = self.rtol;
        let machine = self.machine()?;
        let present = machine.time();
        if !(h.is_finite() && h >= 0.0) {
            return Err(Fault::Step(h));
        }
        let is_near = (t - present).abs() <= NEAR * present.abs().max(h);
        if !is_near {
            return Err(Fault::CommunicationPoint { asked: t, present });
        }
        if t + h > present { machine.advance(t + h, rtol) } else { Ok(()) }
    }

    /// What the steps of Co-Simulation have cost; nothing before the first one, or in Model Exchange.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.made.as_ref().and_then(|made| made.machine.statistics()).unwrap_or_default()
    }

    /// Time, s.
    ///
    /// # Errors
    /// What keeps the model from its start.
    pub fn time(&mut self) -> Result<f64, Fault> {
        if self.mode == Mode::Instantiated { Ok(self.start) } else { Ok(self.machine()?.time()) }
    }

    /// Reads variables.
    ///
    /// # Errors
    /// [`Fault::Length`], [`Fault::Reference`], [`Fault::NoNumber`], what keeps the model from its start.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Fault> {
        same_length("values", values.len(), references.len())?;
        let counts = self.counts;
        let kinds = references.iter().map(|&reference| counts.kind(reference).ok_or(Fault::Reference(reference)));
        let kinds: Vec<VariableKind> = kinds.collect::<Result<_, _>>()?;
        let asks = |is: fn(&VariableKind) -> bool, count: usize| if kinds.iter().any(is) { count } else { 0 };
        let mut rates = vec![0.0; asks(|kind| matches!(kind, VariableKind::Derivative(_)), counts.states)];
        let mut outputs = vec![0.0; asks(|kind| matches!(kind, VariableKind::Output(_)), counts.outputs)];
        let mut guards = vec![0.0; asks(|kind| matches!(kind, VariableKind::Guard(_)), counts.guards)];
        if !rates.is_empty() {
            self.machine()?.rates(&mut rates);
        }
        if !outputs.is_empty() {
            self.machine()?.outputs(&mut outputs);
        }
        if !guards.is_empty() {
            self.machine()?.guards(&mut guards);
        }
        for (value, &kind) in values.iter_mut().zip(&kinds) {
            *value = match kind {
                VariableKind::Time => self.time()?,
                VariableKind::Parameter(index) => self.parameters[index],
                VariableKind::Input(index) => self.signals.get(index),
                VariableKind::Output(index) => outputs[index],
                VariableKind::State(index) => self.machine()?.states()[index],
                VariableKind::Derivative(index) => rates[index],
                VariableKind::Guard(index) => guards[index],
            };
        }
        self.check_finite(values, |model, place| match kinds[place] {
            VariableKind::Output(index) => (model.outputs[index].name.to_owned(), Some(model.outputs[index].observes)),
            _ => (names(model).get(references[place] as usize).cloned().unwrap_or_default(), None),
        })
    }

    /// Refuses values of which one is not finite; `named` gives its name, and what it observes.
    fn check_finite(
        &mut self,
        values: &[f64],
        named: impl Fn(&Description, usize) -> (String, Option<&'static str>),
    ) -> Result<(), Fault> {
        let Some(place) = values.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let (name, observes) = named(self.description(), place);
        let (t, origin) = (self.time()?, self.machine()?.origin());
        Err(NoNumber { name, observes, value: values[place], t, origin }.into())
    }

    /// Sets variables: parameters before the end of the initialization, inputs at any time.
    ///
    /// # Errors
    /// [`Fault::Length`], [`Fault::Reference`], [`Fault::Calculated`], a parameter out of its range or set too late.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Fault> {
        same_length("values", values.len(), references.len())?;
        for (&reference, &value) in references.iter().zip(values) {
            match self.counts.kind(reference).ok_or(Fault::Reference(reference))? {
                VariableKind::Parameter(index) => {
                    self.only("to set a parameter", &[Mode::Instantiated, Mode::Initialization])?;
                    self.model.check(index, value)?;
                    self.parameters[index] = value;
                    self.made = None;
                }
                VariableKind::Input(index) if value.is_finite() => {
                    let is_new = self.signals.get(index).to_bits() != value.to_bits();
                    self.signals.set(index, value);
                    if let Some(made) = self.made.as_mut().filter(|_| is_new) {
                        made.machine.disturb();
                    }
                }
                VariableKind::Input(_) => return Err(Fault::NotFinite { name: self.name(reference), value }),
                _ => return Err(Fault::Calculated(self.name(reference))),
            }
        }
        Ok(())
    }

    /// The model; it is made where that has not been done with the present parameters.
    fn machine(&mut self) -> Result<&mut Stood, Fault> {
        Ok(&mut self.made()?.machine)
    }

    fn made(&mut self) -> Result<&mut Made, Fault> {
        if self.mode == Mode::Instantiated {
            return Err(Fault::Mode { what: "a calculated value", mode: self.mode.name() });
        }
        match &mut self.made {
            Some(made) => Ok(made),
            none => Ok(none.insert(self.model.make(&self.parameters, &self.signals, self.start)?)),
        }
    }

    fn only(&self, what: &'static str, modes: &[Mode]) -> Result<(), Fault> {
        if modes.contains(&self.mode) { Ok(()) } else { Err(Fault::Mode { what, mode: self.mode.name() }) }
    }

    fn name(&self, reference: u32) -> String {
        names(self.description()).get(reference as usize).cloned().unwrap_or_default()
    }
}

fn same_length(what: &'static str, found: usize, wanted: usize) -> Result<(), Fault> {
    if found == wanted { Ok(()) } else { Err(Fault::Length { what, found, wanted }) }
}
