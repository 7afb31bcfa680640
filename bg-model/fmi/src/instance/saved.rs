//! A saved state of an instance: a copy in memory, from which it goes on with the same steps, and the same as bytes.
//!
//! In: an instance. Out: a copy; bytes, and a copy of them again. What the method of a run keeps from step to step is
//! not among the bytes: an instance that is restored from them finds its rate anew, in the same branches and with the
//! same step size.

use serde::{Deserialize, Serialize};

use super::{Fault, Instance, Interface, Mode};
use crate::description::token;
use crate::exported::Made;

/// A saved state.
pub struct Snapshot {
    /// The model's instantiation token.
    token: String,
    mode: Mode,
    parameters: Vec<f64>,
    inputs: Vec<f64>,
    start: f64,
    rtol: f64,
    made: Option<Made>,
}

/// The same as JSON, every number in the shortest form that reads back to the same bits.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    token: String,
    mode: String,
    parameters: Vec<f64>,
    inputs: Vec<f64>,
    start: f64,
    rtol: f64,
    place: Option<ModelState>,
}

/// Where a model stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModelState {
    /// Time, s.
    pub t: f64,
    /// The states.
    pub x: Vec<f64>,
    /// How large each of them has been.
    pub largest: Vec<f64>,
    /// The branches of the switches, where they have been found.
    pub negative: Option<Vec<bool>>,
    /// The size of the next step, s, where it is known.
    pub step: Option<f64>,
}

impl Instance {
    /// A copy of where it stands.
    #[must_use]
    pub fn save(&self) -> Snapshot {
        Snapshot {
            token: token(self.model.described()),
            mode: self.mode,
            parameters: self.parameters.clone(),
            inputs: self.signals.values(),
            start: self.start,
            rtol: self.rtol,
            made: self.made.as_ref().map(Made::twin),
        }
    }

    /// Stands where `snapshot` was taken.
    ///
    /// # Errors
    /// [`Fault::Saved`]: it is of another model, or of an instance with the other interface.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Fault> {
        self.check_own(&snapshot.token)?;
        self.check_mode(snapshot.mode)?;
        self.mode = snapshot.mode;
        self.parameters.clone_from(&snapshot.parameters);
        snapshot.inputs.iter().enumerate().for_each(|(index, &value)| self.signals.set(index, value));
        (self.start, self.rtol) = (snapshot.start, snapshot.rtol);
        self.made = snapshot.made.as_ref().map(Made::twin);
        Ok(())
    }

    /// Refuses a state of an instance with the other interface.
    fn check_mode(&self, mode: Mode) -> Result<(), Fault> {
        let other = match self.interface {
            Interface::ModelExchange => matches!(mode, Mode::Step),
            Interface::CoSimulation => matches!(mode, Mode::Event | Mode::Continuous),
        };
        if other { Err(Fault::Saved("it is one of the other interface".to_owned())) } else { Ok(()) }
    }

    fn check_own(&self, of: &str) -> Result<(), Fault> {
        if of == token(self.model.described()) {
            Ok(())
        } else {
            Err(Fault::Saved("it is one of another model".to_owned()))
        }
    }

    /// The bytes of a saved state.
    ///
    /// # Errors
    /// [`Fault::Saved`]: a state is not finite.
    pub fn serialize(&self, snapshot: &Snapshot) -> Result<Vec<u8>, Fault> {
        self.check_own(&snapshot.token)?;
        if snapshot.made.as_ref().is_some_and(|made| made.machine.delays()) {
            return Err(Fault::Delays(self.description().name));
        }
        let place = snapshot.made.as_ref().map(|made| ModelState {
            t: made.machine.time(),
            x: made.machine.states().to_vec(),
            largest: made.machine.largest().to_vec(),
            negative: made.machine.knows_branches().then(|| made.machine.branches().to_vec()),
            step: made.machine.next_step().filter(|step| step.is_finite()),
        });
        if place.as_ref().is_some_and(|place| !place.x.iter().all(|value| value.is_finite())) {
            return Err(Fault::Saved("a state is not a finite number".to_owned()));
        }
        let text = Text {
            token: token(self.model.described()),
            mode: snapshot.mode.name().to_owned(),
            parameters: snapshot.parameters.clone(),
            inputs: snapshot.inputs.clone(),
            start: snapshot.start,
            rtol: snapshot.rtol,
            place,
        };
        serde_json::to_vec(&text).map_err(|fault| Fault::Saved(fault.to_string()))
    }

    /// The saved state of these bytes, for this instance.
    ///
    /// # Errors
    /// [`Fault::Saved`]: they are of another model, or none.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<Snapshot, Fault> {
        let foreign = |what: &str| Fault::Saved(what.to_owned());
        let text: Text = serde_json::from_slice(bytes).map_err(|fault| Fault::Saved(fault.to_string()))?;
        self.check_own(&text.token)?;
        let mode = Mode::ALL.into_iter().find(|mode| mode.name() == text.mode).ok_or_else(|| foreign("its mode"))?;
        self.check_mode(mode)?;
        let fits = |place: &ModelState| {
            let has_all = place.x.len() == self.counts.states && place.largest.len() == self.counts.states;
            let fits = |negative: &Vec<bool>| negative.len() == self.counts.guards;
            has_all && place.negative.as_ref().is_none_or(fits) && place.t.is_finite()
        };
        let is_whole = text.parameters.len() == self.counts.parameters && text.inputs.len() == self.counts.inputs;
        if !is_whole || !text.place.as_ref().is_none_or(fits) {
            return Err(foreign("the numbers of its variables"));
        }
        let made = match text.place {
            None => None,
            Some(place) => {
                let mut made = self.model.make(&text.parameters, &self.signals, text.start)?;
                made.machine.place(&place)?;
                Some(made)
            }
        };
        let Text { token, parameters, inputs, start, rtol, .. } = text;
        Ok(Snapshot { token, mode, parameters, inputs, start, rtol, made })
    }
}
