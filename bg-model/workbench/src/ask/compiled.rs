//! The models of a mechanism that `bond_graph!` made.
//!
//! In: the mechanism's type. Out: a [`Maker`]. Here all that is compiled for each model is compiled: in WebAssembly,
//! for a page, only what runs a model.

use std::marker::PhantomData;

use bg_model::description::Description;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::{ParameterError, Parameters};

use crate::ask::machine::{Machine, Studied};
use crate::ask::maker::Maker;

/// The models of the mechanism `Me`.
pub struct Compiled<Me>(PhantomData<fn() -> Me>);

impl<Me: Scenes> Compiled<Me> {
    /// All that `bond_graph!` made of it.
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

/// The model that a page has inside, by its number: `BG_LIVE_MODEL` says it at the build.
#[cfg(target_arch = "wasm32")]
const MODEL: usize = match option_env!("BG_LIVE_MODEL") {
    Some(text) => match usize::from_str_radix(text, 10) {
        Ok(index) => index,
        Err(_) => panic!("BG_LIVE_MODEL is the number of a scene"),
    },
    None => 0,
};

impl<Me: Scenes> Maker for Compiled<Me> {
    fn models(&self) -> Vec<&'static Description> {
        (0..Me::MODELS).map(|model| Me::model(model, Describe)).collect()
    }

    fn is_literal(&self) -> bool {
        Me::LITERAL
    }

    #[cfg(target_arch = "wasm32")]
    fn has(&self, model: usize) -> bool {
        model == MODEL
    }

    fn make(&self, model: usize, own: &[f64], inputs: &[Input]) -> Result<Box<dyn Machine>, ParameterError> {
        let making = Making { own, inputs };
        cfg_select! {
            target_arch = "wasm32" => {
                assert_eq!(model, MODEL, "a page has one model inside");
                Me::only::<MODEL, _>(making)
            }
            _ => Me::model(model, making),
        }
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
struct Making<'a> {
    own: &'a [f64],
    inputs: &'a [Input],
}

impl MechanismVisitor for Making<'_> {
    type Output = Result<Box<dyn Machine>, ParameterError>;

    fn visit<Sc: Mechanism + 'static>(self) -> Self::Output {
        let Self { own, inputs } = self;
        assert_eq!(own.len(), Sc::Parameters::table().len(), "a value for each parameter");
        let model = Sc::make(Sc::Parameters::of_values(own), inputs)?;
        Ok(Box::new(cfg_select! {
            target_arch = "wasm32" => Studied::new(model),
            _ => Studied::complete(model),
        }))
    }
}
