//! The models of one graph, whatever made them: a mechanism that `bond_graph!` compiled, or one that is known at run
//! time only.
//!
//! In: the number of a model, values of its own parameters, inputs. Out: the model as a trait object. All that a
//! program does is compiled against this, once, and not for each mechanism.

use bg_model::description::Description;
use bg_model::input::Input;
use bg_model::parameters::ParameterError;

use crate::ask::machine::Machine;

/// What makes the models of a graph: a [`Compiled`](crate::ask::compiled::Compiled), or your own.
pub trait Maker: Send + Sync {
    /// The tables of all models. The first is of the one that stands for the graph: its parameters and inputs are those
    /// that a program knows, and has values for. The scenes follow in the order of the text.
    fn models(&self) -> Vec<&'static Description>;

    /// The name of the graph, as the text has it.
    fn name(&self) -> &str {
        self.models()[0].name
    }

    /// Whether the first model is the graph as it stands, not a scene of it.
    fn is_literal(&self) -> bool;

    /// Whether the model of this number can be made; one that was not compiled cannot.
    fn has(&self, _model: usize) -> bool {
        true
    }

    /// The model of this number in [`Maker::models`], with these values of its own parameters and inputs, each in the
    /// order of its description; inputs that are missing are 0.
    ///
    /// # Errors
    /// A parameter outside its range, a value that parameters give and that cannot be.
    ///
    /// # Panics
    /// There is no such model, or another number of values.
    fn make(&self, model: usize, own: &[f64], inputs: &[Input]) -> Result<Box<dyn Machine>, ParameterError>;

    /// What makes the model of this number in a functional mock-up unit without a library of its own; none by default.
    fn prebuilt(&self, _model: usize) -> Option<Prebuilt> {
        None
    }
}

/// A library that is there already, and what it makes a model of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prebuilt {
    /// What the unit is to be called.
    pub name: String,
    /// The package whose library it is.
    pub package: &'static str,
    /// The resources of the unit: names and contents of files.
    pub resources: Vec<(&'static str, Vec<u8>)>,
}
