//! A model as suites ask for it: over slices, so that what they do with it is compiled once, whatever its type.
//!
//! In: a mechanism. Out: [`Example`], and a function that makes it for each example and each scene of the hacksaw,
//! compiled here for all suites.

use std::rc::Rc;

use bg_model::capability::Inlined;
use bg_model::dynamics::Machine;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::SVector;
use bg_model::scalar::Dual;
use bg_model::system::{Model, switches, values};

/// A model with its parameters, and the same in numbers with a slope.
pub struct Example {
    /// The model as runs ask for it.
    pub machine: Rc<dyn Machine>,
    /// Its rate as it is called elsewhere.
    pub rates: Box<dyn Rates>,
    /// The model in numbers with a slope.
    pub twin: Box<dyn Twin>,
}

impl Example {
    /// This model.
    pub fn of<Me: Mechanism>(model: &Me) -> Self {
        Self { machine: model.machine(), rates: model.visit::<f64, _>(Boxed), twin: model.visit::<Dual, _>(Boxed) }
    }

    /// The model with the defaults of its parameters, each of its inputs this one.
    fn with_defaults<Me: Mechanism>(input: &Input) -> Self {
        let inputs = vec![input.clone(); Me::describe().inputs.len()];
        Self::of(&Me::make(Me::Parameters::default(), &inputs).expect("defaults are possible"))
    }
}

/// The rate of a model in all its forms.
pub trait Rates {
    /// As a function, with all of it in place, and that in pairs of operations where it pays.
    fn rates(&self, t: f64, x: &[f64], negative: &[bool]) -> [Vec<f64>; 3];
}

/// A model in numbers with a slope.
pub trait Twin {
    /// [`System::rate`](bg_model::system::System::rate).
    fn rate(&self, t: Dual, x: &[Dual], negative: &[bool], dx: &mut [Dual]);

    /// [`Model::stored_energy`].
    fn stored_energy(&self, t: Dual, x: &[Dual], negative: &[bool]) -> Dual;
}

/// Boxes a copy of a model.
struct Boxed;

/// A model whose numbers are in its type.
struct Typed<Mo, const N: usize, const G: usize, const M: usize>(Mo);

impl ModelVisitor<f64> for Boxed {
    type Output = Box<dyn Rates>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        Box::new(Typed::<Mo, N, G, M>(model.clone()))
    }
}

impl ModelVisitor<Dual> for Boxed {
    type Output = Box<dyn Twin>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<Dual, N, G, M> + Clone + 'static,
    {
        Box::new(Typed::<Mo, N, G, M>(model.clone()))
    }
}

impl<Mo, const N: usize, const G: usize, const M: usize> Rates for Typed<Mo, N, G, M>
where
    Mo: Model<f64, N, G, M>,
{
    fn rates(&self, t: f64, x: &[f64], negative: &[bool]) -> [Vec<f64>; 3] {
        let (model, x, negative) = (&self.0, values::<N>(x), switches::<G>(negative));
        let mut rates = [SVector::repeat(f64::NAN); 3];
        model.rate(t, x, negative, &mut rates[0]);
        let inlined = model.inlined().expect("generated models have inlined rates");
        inlined.rate(t, x, negative, &mut rates[1]);
        inlined.paired_rate(t, x, negative, &mut rates[2]);
        rates.map(|rate| rate.as_slice().to_vec())
    }
}

impl<Mo, const N: usize, const G: usize, const M: usize> Twin for Typed<Mo, N, G, M>
where
    Mo: Model<Dual, N, G, M>,
{
    fn rate(&self, t: Dual, x: &[Dual], negative: &[bool], dx: &mut [Dual]) {
        let mut rate = SVector::from_column_slice(dx);
        self.0.rate(t, &SVector::from_column_slice(x), switches(negative), &mut rate);
        dx.copy_from_slice(rate.as_slice());
    }

    fn stored_energy(&self, t: Dual, x: &[Dual], negative: &[bool]) -> Dual {
        self.0.stored_energy(t, &SVector::from_column_slice(x), switches(negative))
    }
}

/// The rope, whose functions have loops, with the defaults of its parameters.
#[must_use]
pub fn rope() -> Example {
    Example::with_defaults::<crate::models::long::Rope>(&Input::default())
}

/// The whip, whose functions are in parts, with the defaults of its parameters.
#[must_use]
pub fn whip() -> Example {
    Example::with_defaults::<crate::models::long::Whip>(&Input::default())
}

/// Each example model.
pub mod examples {
    use super::{Example, Input};

    macro_rules! made {
        ($($name:ident: $module:ident $model:ident ($($rest:tt)*);)*) => {$(
            #[doc = concat!("`", stringify!($model), "` with the defaults of its parameters, each of its inputs this \
                one.")]
            #[must_use]
            pub fn $name(input: &Input) -> Example {
                Example::with_defaults::<crate::models::$module::$model>(input)
            }
        )*};
    }

    crate::each_example!(made);
}

/// The hacksaw and each of its scenes.
pub mod scenes {
    use super::{Example, Input};

    macro_rules! made {
        ($($name:ident: $model:ident ($($rest:tt)*);)*) => {$(
            #[doc = concat!("`", stringify!($model), "` with the defaults of its parameters.")]
            #[must_use]
            pub fn $name() -> Example {
                Example::with_defaults::<hacksaw::mechanism::$model>(&Input::default())
            }
        )*};
    }

    crate::each_scene!(made);
}
