//! A mechanism: a generated model seen by name, without the numbers of its states, switches and outputs.
//!
//! In: parameters and inputs by name. Out: the model, handed with its numbers to a visitor. What is generic over a
//! [`Mechanism`] needs no const generics, and only what a visitor calls is compiled.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec::Vec;

use crate::model::description::Description;
#[cfg(feature = "std")]
use crate::model::dynamics::{Abreast, EachAlone, InLanes, Swept, Typed};
use crate::model::dynamics::{InVectors, Machine, Over, Rates, shared};
use crate::model::input::Input;
use crate::model::parameters::{ParameterError, Parameters};
#[cfg(all(feature = "std", target_arch = "x86_64"))]
use crate::model::scalar::lanes::{Avx2, Avx512};
#[cfg(feature = "std")]
use crate::model::scalar::lanes::{Lanes, Vector, at};
#[cfg(all(feature = "std", not(target_arch = "x86_64")))]
use crate::model::scalar::slopes::Eight;
use crate::model::scalar::slopes::Slopes;
use crate::model::scalar::{Gradient, GradientIn, Scalar};
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

    /// [`Laned::in_lanes`]; none by default.
    #[cfg(feature = "std")]
    #[doc(hidden)]
    fn lanes<V: Vector>(&self, _values: &[Lanes<V>]) -> Option<Result<Box<dyn Abreast<V>>, ParameterError>> {
        None
    }

    /// [`Joinable::side_by_side`]; none by default.
    #[doc(hidden)]
    fn slopes<V: Slopes>(&self, _values: &[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>> {
        None
    }
}

/// A model that calculates in the vectors of a machine in each build: for tests of them.
#[cfg(feature = "std")]
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct InEachBuild<Me>(pub Me);

/// A model as studies of it ask for it: in doubles, of other values, and made anew in numbers with slopes.
pub trait Differentiable {
    /// What it consists of.
    fn description(&self) -> &'static Description;

    /// The values of its parameters, in the order of its description.
    fn values(&self) -> Vec<f64>;

    /// Its inputs, likewise.
    fn inputs(&self) -> Vec<Input>;

    /// It in doubles.
    fn machine(&self) -> Rc<dyn Machine>;

    /// The same with these values of its parameters.
    ///
    /// # Errors
    /// A value outside its range, or one that cannot be.
    ///
    /// # Panics
    /// There is no value for a parameter.
    fn tuned(&self, values: &[f64]) -> Result<Rc<dyn Machine>, ParameterError>;

    /// The same with these inputs, in numbers with slopes.
    ///
    /// # Errors
    /// There is none with its parameters.
    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError>;
}

/// A model that can be made in numbers `S`.
pub trait Liftable<S: Scalar>: Differentiable {
    /// It in these numbers, with these values of its parameters.
    ///
    /// # Errors
    /// As [`Differentiable::tuned`].
    ///
    /// # Panics
    /// As [`Differentiable::tuned`].
    fn lifted(&self, values: &[S]) -> Result<Rc<dyn Machine<S>>, ParameterError>;
}

impl<Me: Mechanism> Differentiable for Me {
    fn description(&self) -> &'static Description {
        Me::describe()
    }

    fn values(&self) -> Vec<f64> {
        self.parameters().values()
    }

    fn inputs(&self) -> Vec<Input> {
        Mechanism::inputs(self)
    }

    fn machine(&self) -> Rc<dyn Machine> {
        Mechanism::machine(self)
    }

    fn tuned(&self, values: &[f64]) -> Result<Rc<dyn Machine>, ParameterError> {
        Ok(Mechanism::machine(&Me::make(Me::Parameters::of_values(values), &Mechanism::inputs(self))?))
    }

    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError> {
        Ok(Me::make(self.parameters().clone(), inputs)?.visit(Lifted))
    }
}

impl<S: Scalar, Me: Mechanism> Liftable<S> for Me {
    fn lifted(&self, values: &[S]) -> Result<Rc<dyn Machine<S>>, ParameterError> {
        self.visit_lifted::<S, S, _>(Lift(values))
    }
}

/// Makes a model of values of its parameters.
struct Lift<'a, S>(&'a [S]);

impl<S: Scalar> LiftedVisitor<S, S> for Lift<'_, S> {
    type Output = Result<Rc<dyn Machine<S>>, ParameterError>;

    fn visit<Mo, Li, Ot, const N: usize, const G: usize, const M: usize>(
        self,
        _: &Mo,
        _: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[S]) -> Result<Li, ParameterError>,
        _: impl Fn(&[&Li], fn(&[S]) -> S) -> Ot,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<S, N, G, M> + 'static,
        Ot: Model<S, N, G, M> + 'static,
    {
        Ok(Rc::new(Over::<Rc<Li>, N, G, M>(Rc::new(lifted(self.0)?))))
    }
}

/// Models with slopes along a few directions each, and all of them as one for steps with slopes in vectors.
#[doc(hidden)]
pub struct SideBySide<V> {
    /// Each model.
    pub each: Vec<Rc<dyn Machine<Gradient>>>,
    /// The model whose numbers have the slopes of all of them, one after the other.
    pub all: Box<dyn Rates<V>>,
}

impl<V> SideBySide<V> {
    /// The models with these values of the parameters, each asked by itself.
    ///
    /// # Errors
    /// As [`Differentiable::tuned`].
    #[cfg(feature = "std")]
    pub(crate) fn apart<Mo: Liftable<Gradient> + ?Sized>(
        model: &Mo,
        values: &[Vec<Gradient>],
    ) -> Result<Self, ParameterError>
    where
        V: Slopes,
    {
        let each = values.iter().map(|values| model.lifted(values)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { all: Box::new(EachAlone(each.clone())), each })
    }
}

/// A model whose slopes along many directions are calculated side by side, in the vectors `V`.
#[doc(hidden)]
pub trait Joinable<V>: Liftable<Gradient> {
    /// The models with these values of the parameters, as many as have slopes in the vectors at most. None where it is
    /// not compiled for these vectors: then each model is asked by itself.
    ///
    /// # Errors
    /// As [`Differentiable::tuned`].
    fn side_by_side(&self, values: &[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>>;
}

impl<V: Slopes, Me: Mechanism> Joinable<V> for Me {
    fn side_by_side(&self, values: &[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>> {
        self.slopes(values)
    }
}

/// The models of a mechanism with these values of its parameters, joined.
#[doc(hidden)]
pub fn join<V: Slopes, Me: Mechanism>(model: &Me, values: &[Vec<Gradient>]) -> Result<SideBySide<V>, ParameterError> {
    model.visit_lifted::<Gradient, GradientIn<V>, _>(Join(values))
}

/// Makes models of values with slopes, and joins them.
struct Join<'a>(&'a [Vec<Gradient>]);

impl<V: Slopes> LiftedVisitor<Gradient, GradientIn<V>> for Join<'_> {
    type Output = Result<SideBySide<V>, ParameterError>;

    fn visit<Mo, Li, Ot, const N: usize, const G: usize, const M: usize>(
        self,
        _: &Mo,
        _: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[Gradient]) -> Result<Li, ParameterError>,
        joined: impl Fn(&[&Li], fn(&[Gradient]) -> GradientIn<V>) -> Ot,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<Gradient, N, G, M> + 'static,
        Ot: Model<GradientIn<V>, N, G, M> + 'static,
    {
        let (mut models, mut each) = (Vec::new(), Vec::<Rc<dyn Machine<Gradient>>>::new());
        for values in self.0 {
            let model = Rc::new(lifted(values)?);
            each.push(Rc::new(Over::<Rc<Li>, N, G, M>(Rc::clone(&model))));
            models.push(model);
        }
        let all = joined(&models.iter().map(|model| &**model).collect::<Vec<_>>(), GradientIn::joined);
        Ok(SideBySide { each, all: Box::new(InVectors::<Ot, N, G>(all)) })
    }
}

/// A model whose runs its slopes can follow, in the vectors of whatever machine is at hand.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub trait Followed: Joinable<Avx2> + Joinable<Avx512> {}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl<Mo: Joinable<Avx2> + Joinable<Avx512>> Followed for Mo {}

/// A model whose runs its slopes can follow, in the vectors of whatever machine is at hand.
#[cfg(all(feature = "std", not(target_arch = "x86_64")))]
pub trait Followed: Joinable<Eight> {}

#[cfg(all(feature = "std", not(target_arch = "x86_64")))]
impl<Mo: Joinable<Eight>> Followed for Mo {}

/// A model whose runs can be followed backwards.
#[cfg(feature = "std")]
pub trait Reversible: Liftable<Gradient> {
    /// Its reverse sweeps; none of a model that is too large for them.
    fn swept(&self) -> Option<Rc<dyn Swept>>;
}

#[cfg(feature = "std")]
impl<Me: Mechanism> Reversible for Me {
    fn swept(&self) -> Option<Rc<dyn Swept>> {
        self.visit(Sweeps)
    }
}

/// Shares the reverse sweeps of a copy of a model.
#[cfg(feature = "std")]
struct Sweeps;

#[cfg(feature = "std")]
impl ModelVisitor<f64> for Sweeps {
    type Output = Option<Rc<dyn Swept>>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        model.reversed()?;
        Some(Rc::new(Typed::<Rc<Mo>, N, G, M>::model(Rc::new(model.clone()))))
    }
}

/// A model that calculates runs side by side, in the vectors `V`.
#[cfg(feature = "std")]
#[doc(hidden)]
pub trait Laned<V: Vector>: Differentiable {
    /// It with these values of its parameters, those of each run in a place. None where it is not compiled for these
    /// vectors: then the model of each run is asked by itself.
    ///
    /// # Errors
    /// As [`Differentiable::tuned`].
    fn in_lanes(&self, values: &[Lanes<V>]) -> Option<Result<Box<dyn Abreast<V>>, ParameterError>>;
}

#[cfg(feature = "std")]
impl<V: Vector, Me: Mechanism> Laned<V> for Me {
    fn in_lanes(&self, values: &[Lanes<V>]) -> Option<Result<Box<dyn Abreast<V>>, ParameterError>> {
        self.lanes(values)
    }
}

/// A mechanism with these values of its parameters, in numbers side by side.
#[cfg(feature = "std")]
#[doc(hidden)]
pub fn into_lanes<V: Vector, Me: Mechanism>(
    model: &Me,
    values: &[Lanes<V>],
) -> Result<Box<dyn Abreast<V>>, ParameterError> {
    model.visit_lifted::<f64, Lanes<V>, _>(IntoLanes(values))
}

#[cfg(feature = "std")]
impl<Me: Mechanism> Differentiable for InEachBuild<Me> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn values(&self) -> Vec<f64> {
        self.0.values()
    }

    fn inputs(&self) -> Vec<Input> {
        Differentiable::inputs(&self.0)
    }

    fn machine(&self) -> Rc<dyn Machine> {
        Differentiable::machine(&self.0)
    }

    fn tuned(&self, values: &[f64]) -> Result<Rc<dyn Machine>, ParameterError> {
        self.0.tuned(values)
    }

    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError> {
        self.0.sloped(inputs)
    }
}

#[cfg(feature = "std")]
impl<S: Scalar, Me: Mechanism> Liftable<S> for InEachBuild<Me> {
    fn lifted(&self, values: &[S]) -> Result<Rc<dyn Machine<S>>, ParameterError> {
        self.0.lifted(values)
    }
}

#[cfg(feature = "std")]
impl<V: Slopes, Me: Mechanism> Joinable<V> for InEachBuild<Me> {
    fn side_by_side(&self, values: &[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>> {
        Some(join(&self.0, values))
    }
}

#[cfg(feature = "std")]
impl<V: Vector, Me: Mechanism> Laned<V> for InEachBuild<Me> {
    fn in_lanes(&self, values: &[Lanes<V>]) -> Option<Result<Box<dyn Abreast<V>>, ParameterError>> {
        Some(into_lanes(&self.0, values))
    }
}

/// Makes the model of each of several runs, and joins them.
#[cfg(feature = "std")]
struct IntoLanes<'a, V>(&'a [Lanes<V>]);

#[cfg(feature = "std")]
impl<V: Vector> LiftedVisitor<f64, Lanes<V>> for IntoLanes<'_, V> {
    type Output = Result<Box<dyn Abreast<V>>, ParameterError>;

    fn visit<Mo, Li, Ot, const N: usize, const G: usize, const M: usize>(
        self,
        _: &Mo,
        _: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[f64]) -> Result<Li, ParameterError>,
        joined: impl Fn(&[&Li], fn(&[f64]) -> Lanes<V>) -> Ot,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<f64, N, G, M> + 'static,
        Ot: Model<Lanes<V>, N, G, M> + 'static,
    {
        let models = (0..V::LANES).map(|place| lifted(&at(place, self.0))).collect::<Result<Vec<Li>, _>>()?;
        let models: Vec<&Li> = models.iter().collect();
        Ok(Box::new(InLanes::<Ot, N, G>(joined(&models, Lanes::side_by_side))))
    }
}

/// A model whose runs can be made side by side, in the vectors of whatever machine is at hand.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub trait Accompanied: Laned<Avx2> + Laned<Avx512> {}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl<Mo: Laned<Avx2> + Laned<Avx512>> Accompanied for Mo {}

/// A model whose runs can be made side by side, in the vectors of whatever machine is at hand: here none.
#[cfg(all(feature = "std", not(target_arch = "x86_64")))]
pub trait Accompanied: Differentiable {}

#[cfg(all(feature = "std", not(target_arch = "x86_64")))]
impl<Mo: Differentiable> Accompanied for Mo {}

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
