//! A mechanism: a generated model seen by name, without the numbers of its states, switches and outputs.
//!
//! In: parameters and inputs by name. Out: the model, handed with its numbers to a visitor. What is generic over a
//! [`Mechanism`] needs no const generics, and only what a visitor calls is compiled.

use alloc::rc::Rc;
use alloc::vec::Vec;

use crate::model::description::Description;
use crate::model::dynamics::{Machine, Over, shared};
use crate::model::input::Input;
use crate::model::parameters::{ParameterError, Parameters};
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::Model;

/// A model that `bond_graph!` generated: a graph or one of its scenes.
pub trait Mechanism: Clone {
    /// Its parameters.
    type Parameters: Parameters;

    /// What it consists of.
    fn describe() -> &'static Description;

    /// The model with these parameters and inputs: an input for each of `describe().inputs`, in their order; those that
    /// are missing are 0.
    ///
    /// # Errors
    /// A parameter outside its range, a value that parameters give and that cannot be.
    fn make(parameters: Self::Parameters, inputs: &[Input]) -> Result<Self, ParameterError>;

    /// The parameters that it was made with.
    fn parameters(&self) -> &Self::Parameters;

    /// The inputs that it was made with, in the order of `describe().inputs`.
    fn inputs(&self) -> Vec<Input>;

    /// Hands the model, calculating in `S`, to `visitor`.
    fn visit<S: Scalar, V: ModelVisitor<S>>(&self, visitor: V) -> V::Output;

    /// The model over slices, whatever the number of its states; a copy of it.
    fn machine(&self) -> Rc<dyn Machine> {
        self.visit(Shared)
    }

    /// Hands the model to `visitor`, and with it what makes the same model of parameters in `S`, and that one in `T`.
    fn visit_lifted<S: Scalar, T: Scalar, V: LiftedVisitor<S, T>>(&self, visitor: V) -> V::Output;
}

/// A model as studies of it ask for it: in doubles, and made anew in numbers with slopes.
pub trait Differentiable {
    /// What it consists of.
    fn description(&self) -> &'static Description;

    /// Its inputs, in the order of its description.
    fn inputs(&self) -> Vec<Input>;

    /// It in doubles.
    fn machine(&self) -> Rc<dyn Machine>;

    /// The same with these inputs, in numbers with slopes.
    ///
    /// # Errors
    /// There is none with its parameters.
    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError>;
}

impl<Me: Mechanism> Differentiable for Me {
    fn description(&self) -> &'static Description {
        Me::describe()
    }

    fn inputs(&self) -> Vec<Input> {
        Mechanism::inputs(self)
    }

    fn machine(&self) -> Rc<dyn Machine> {
        Mechanism::machine(self)
    }

    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError> {
        Ok(Me::make(self.parameters().clone(), inputs)?.visit(Lifted))
    }
}

/// Shares a copy of a model in numbers with slopes.
struct Lifted;

impl ModelVisitor<Gradient> for Lifted {
    type Output = Rc<dyn Machine<Gradient>>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<Gradient, N, G, M> + Clone + 'static,
    {
        Rc::new(Over::<Rc<Mo>, N, G, M>(Rc::new(model.clone())))
    }
}

/// Shares a copy of a model.
struct Shared;

impl ModelVisitor<f64> for Shared {
    type Output = Rc<dyn Machine>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        shared(model.clone())
    }
}

/// A mechanism with the models of its graph: of the literal model with all scenes, of a scene with itself alone. In a
/// graph with `scenes only;` the first scene has the others.
pub trait Scenes: Mechanism + 'static {
    /// How many models there are: the mechanism itself and its scenes.
    const MODELS: usize;

    /// Whether the mechanism itself is the graph as it stands, not a scene of it.
    const LITERAL: bool;

    /// Hands the type of model `index` to `visitor`: 0 is the mechanism itself; then come its scenes, in the order of
    /// the text.
    ///
    /// # Panics
    /// `index` is not below [`Scenes::MODELS`].
    fn model<V: MechanismVisitor>(index: usize, visitor: V) -> V::Output;

    /// Hands the type of model `INDEX` to `visitor`, as [`model`](Scenes::model) does. What the visitor does with the
    /// other models is not compiled.
    ///
    /// # Panics
    /// `INDEX` is not below [`Scenes::MODELS`].
    fn only<const INDEX: usize, V: MechanismVisitor>(visitor: V) -> V::Output;
}

/// Something to do with a model, whatever its numbers of states, switches and outputs.
pub trait ModelVisitor<S: Scalar> {
    /// What results.
    type Output;

    /// Is handed the model.
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<S, N, G, M> + Clone + 'static;
}

/// Something to do with a model and with the same model of other numbers, such as dual ones, of which several may be
/// joined to one in numbers of a second kind. Of each kind only what the visitor calls is compiled.
pub trait LiftedVisitor<S: Scalar, T: Scalar> {
    /// What results.
    type Output;

    /// Is handed the model, a function that makes it of other values of its parameters, one that makes it of a value in
    /// `S` for each, both in the order of their table, and one that makes each number of a model in `T` of those of
    /// several such models.
    fn visit<Mo, Li, Ot, const N: usize, const G: usize, const M: usize>(
        self,
        model: &Mo,
        other: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[S]) -> Result<Li, ParameterError>,
        joined: impl Fn(&[&Li], fn(&[S]) -> T) -> Ot,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<S, N, G, M> + 'static,
        Ot: Model<T, N, G, M> + 'static;
}

/// Something to do with a mechanism, whatever its type.
pub trait MechanismVisitor {
    /// What results.
    type Output;

    /// Is handed the type.
    fn visit<Me: Mechanism + 'static>(self) -> Self::Output;
}
