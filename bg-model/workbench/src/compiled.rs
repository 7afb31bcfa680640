//! The models of a mechanism that `bond_graph!` made.
//!
//! In: the mechanism's type, and what its program can do without. Out: a [`Maker`]. Here all that is compiled for each
//! model is compiled; what is switched off is not, and in WebAssembly, for a page, only what runs a model.

use std::marker::PhantomData;
use std::rc::Rc;

use bg_analysis::identify::{Data, Identified, IdentifyError, Variable, identify};
use bg_analysis::linear::{Equilibrium, LinearError, StateSpace, equilibrium, linearise_at};
use bg_model::description::Description;
use bg_model::dynamics;
use bg_model::extended::Accuracy;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::run::{LaneError, Request, State, Trajectory, in_lanes};
use bg_model::sensitivity::{
    Gradients, Objective, Sensitivities, SensitivityError, directions, gradient, sensitivities,
};

use crate::machine::Machine;
use crate::maker::Maker;
use crate::precision::reference::{ReferenceError, Solution, solve};

/// The models of the mechanism `Me`: with runs side by side if `Lanes` is [`On`], with gradients and with reference
/// solutions in the same way.
pub struct Compiled<Me, Lanes = Off, Gradients = Off, Solutions = On>(Types<(Me, Lanes, Gradients, Solutions)>);

/// Types of which there are no values here, so that any thread can have it.
type Types<T> = PhantomData<fn() -> T>;

/// Something that is compiled for each model.
#[derive(Clone, Copy, Debug)]
pub struct On;

/// Something that is not compiled.
#[derive(Clone, Copy, Debug)]
pub struct Off;

/// [`On`] or [`Off`].
pub trait Switch: 'static {
    /// Whether it is on.
    const IS_ON: bool;

    /// What `make` gives, where it is on; else `make` is not compiled.
    fn when<T>(make: impl FnOnce() -> T) -> Option<T>;
}

impl Switch for On {
    const IS_ON: bool = cfg!(not(target_arch = "wasm32"));

    /// A page has no use for it.
    fn when<T>(make: impl FnOnce() -> T) -> Option<T> {
        cfg_select! {
            target_arch = "wasm32" => {
                drop(make);
                None
            }
            _ => Some(make()),
        }
    }
}

impl Switch for Off {
    const IS_ON: bool = false;

    fn when<T>(_: impl FnOnce() -> T) -> Option<T> {
        None
    }
}

impl<Me: Scenes> Compiled<Me> {
    /// What any program has: no lanes, no gradients.
    #[must_use]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<Me: Scenes> Default for Compiled<Me> {
    fn default() -> Self {
        Self::new()
    }
}

impl<Me, La, Gr, So> Compiled<Me, La, Gr, So> {
    /// Lets `sweep` make runs by the methods `nystrom`, `cfmr7` and `dop853` side by side, eight at a time on a machine
    /// with AVX-512, four with AVX2; what they give is the same to the bit. It is compiled for each model twice, so a
    /// program has it only if it asks for it.
    #[must_use]
    pub fn lanes(self) -> Compiled<Me, On, Gr, So> {
        Compiled(PhantomData)
    }

    /// Gives the program the command `gradient`: one number of a run differentiated by all parameters, by the run
    /// followed backwards. It is compiled for each model, so a program has it only if it asks for it. A page has no use
    /// for it.
    #[must_use]
    pub fn gradients(self) -> Compiled<Me, La, On, So> {
        Compiled(PhantomData)
    }

    /// Leaves out what computes reference solutions: for a program whose cases of `precision` have stored ones.
    #[must_use]
    pub fn without_solutions(self) -> Compiled<Me, La, Gr, Off> {
        Compiled(PhantomData)
    }
}

/// The model that a page has inside, by its number: `BG_LIVE_MODEL` says it at the build.
#[cfg(target_arch = "wasm32")]
pub(crate) const MODEL: usize = match option_env!("BG_LIVE_MODEL") {
    Some(text) => match usize::from_str_radix(text, 10) {
        Ok(index) => index,
        Err(_) => panic!("BG_LIVE_MODEL is the number of a scene"),
    },
    None => 0,
};

impl<Me: Scenes, La: Switch, Gr: Switch, So: Switch> Maker for Compiled<Me, La, Gr, So> {
    fn models(&self) -> Vec<&'static Description> {
        (0..Me::MODELS).map(|model| Me::model(model, Describe)).collect()
    }

    fn is_literal(&self) -> bool {
        Me::LITERAL
    }

    fn make(&self, model: usize, own: &[f64], inputs: &[Input]) -> Result<Box<dyn Machine>, ParameterError> {
        let making = Making::<La, Gr, So> { own, inputs, switches: PhantomData };
        cfg_select! {
            target_arch = "wasm32" => {
                assert_eq!(model, MODEL, "a page has one model inside");
                Me::only::<MODEL, _>(making)
            }
            _ => Me::model(model, making),
        }
    }

    fn has_lanes(&self) -> bool {
        La::IS_ON
    }

    fn has_gradients(&self) -> bool {
        Gr::IS_ON
    }
}

struct Describe;

impl MechanismVisitor for Describe {
    type Output = &'static Description;

    fn visit<Me: Mechanism>(self) -> &'static Description {
        Me::describe()
    }
}

/// Makes a model.
struct Making<'a, La, Gr, So> {
    own: &'a [f64],
    inputs: &'a [Input],
    switches: PhantomData<(La, Gr, So)>,
}

impl<La: Switch, Gr: Switch, So: Switch> MechanismVisitor for Making<'_, La, Gr, So> {
    type Output = Result<Box<dyn Machine>, ParameterError>;

    fn visit<Sc: Mechanism + 'static>(self) -> Self::Output {
        let Self { own, inputs, .. } = self;
        assert_eq!(own.len(), Sc::Parameters::table().len(), "a value for each parameter");
        let model = Sc::make(Sc::Parameters::of_values(own), inputs)?;
        let over_slices = model.machine();
        Ok(Box::new(Made::<Sc, La, Gr, So> { model, over_slices, switches: PhantomData }))
    }
}

/// A model, and what is compiled of it.
struct Made<Me, La, Gr, So> {
    model: Me,
    over_slices: Rc<dyn dynamics::Machine>,
    switches: PhantomData<(La, Gr, So)>,
}

impl<Me: Mechanism, La: Switch, Gr: Switch, So: Switch> Machine for Made<Me, La, Gr, So> {
    fn model(&self) -> Rc<dyn dynamics::Machine> {
        Rc::clone(&self.over_slices)
    }

    fn equilibrium(&self, t: f64, guess: &[f64]) -> Option<Result<Equilibrium, LinearError>> {
        Some(equilibrium(&self.model, t, guess))
    }

    fn linearised(&self, state: &State) -> Option<Result<StateSpace, LinearError>> {
        On::when(|| linearise_at(&self.model, state))
    }

    fn sensitivities(&self, request: &Request, by: &[&str]) -> Option<Result<Sensitivities, SensitivityError>> {
        On::when(|| sensitivities(&self.model, request, &directions(Me::describe(), by)?))
    }

    fn gradient(
        &self,
        request: &Request,
        objective: &Objective<'_>,
        by: &[&str],
    ) -> Option<Result<Gradients, SensitivityError>> {
        Gr::when(|| gradient(&self.model, request, objective, &directions(Me::describe(), by)?))
    }

    fn identified(
        &self,
        request: &Request,
        data: &Data,
        variables: &[Variable],
        told: &mut dyn FnMut(&[f64], f64),
    ) -> Option<Result<Identified, IdentifyError>> {
        On::when(|| identify(&self.model, request, data, variables, told))
    }

    fn solution(&self, accuracy: Accuracy, instants: &[f64]) -> Option<Result<Solution, ReferenceError>> {
        So::when(|| solve(&self.model, accuracy, instants, &|_| true))
    }

    fn in_lanes(&self, request: &Request, own: &[Vec<f64>]) -> Option<Vec<Result<Trajectory, LaneError>>> {
        La::when(|| in_lanes(&self.model, request, own))
    }
}
