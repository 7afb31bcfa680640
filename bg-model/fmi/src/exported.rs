//! A model as an instance needs it: its tables, and how it is made of numbers.
//!
//! In: a mechanism's type. Out: a value that stands for it, so that a library can list its models.

use std::marker::PhantomData;
use std::rc::Rc;

use bg_model::description::Description;
use bg_model::dynamics::Machine;
use bg_model::input::Input;
use bg_model::linear::Sparsity;
use bg_model::mechanism::{Liftable, Mechanism};
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::scalar::Dual;

use crate::instance::{Fault, InDuals, Signals, Slopes, Stood, nominals_at_start};

/// A model with what it knows of its derivatives.
pub struct Made {
    pub(crate) machine: Stood,
    pub(crate) slopes: Box<dyn Slopes>,
}

impl Made {
    pub(crate) fn twin(&self) -> Self {
        Self { machine: self.machine.clone(), slopes: self.slopes.twin() }
    }
}

/// A model as its `modelDescription.xml` has it. What only this is asked of is compiled without what makes it run.
pub trait Described {
    /// Its tables.
    fn description(&self) -> &'static Description;

    /// For each state the states on which its derivative may depend; none where that is not known.
    fn dependencies(&self) -> Option<Vec<Vec<usize>>>;

    /// How large each state is to be taken for, in its unit, above zero; none where the default start cannot be
    /// assembled.
    fn nominals(&self) -> Option<Vec<f64>>;

    /// Whether it delays signals, whose past its own steps keep: a host's steps cannot move it on.
    fn delays(&self) -> bool;

    /// The switches of the clocks that compute samples, by their places in the description.
    fn clocks(&self) -> Vec<usize>;
}

/// Keeps [`Exported`] to the types of this crate.
pub(crate) mod sealed {
    use super::{Fault, Made, ParameterError, Signals};

    pub trait Make {
        /// The model with these parameters, at its start at time `t` (s).
        fn make(&self, parameters: &[f64], signals: &Signals, t: f64) -> Result<Made, Fault>;

        /// Whether parameter `index` can have this value.
        fn check(&self, index: usize, value: f64) -> Result<(), ParameterError>;
    }
}

/// A model that a library exports.
pub trait Exported: Described + sealed::Make {
    /// It as its description has it.
    fn described(&self) -> &dyn Described;
}

/// The mechanism `Me` as an exported model.
pub struct Of<Me>(PhantomData<fn() -> Me>);

impl<Me> Of<Me> {
    /// It.
    pub const NEW: Self = Self(PhantomData);
}

impl<Me: Mechanism + 'static> sealed::Make for Of<Me> {
    fn make(&self, values: &[f64], signals: &Signals, t: f64) -> Result<Made, Fault> {
        let parameters = Me::Parameters::of_values(values);
        parameters.validate()?;
        let mechanism = Me::make(parameters, &signals.inputs())?;
        Ok(Made { machine: Stood::at_start(mechanism.machine(), t)?, slopes: mechanism.visit(InDuals) })
    }

    fn check(&self, index: usize, value: f64) -> Result<(), ParameterError> {
        Me::describe().parameters[index].check(value)
    }
}

impl<Me: Mechanism + 'static> Exported for Of<Me> {
    fn described(&self) -> &dyn Described {
        self
    }
}

impl<Me: Mechanism> Described for Of<Me> {
    fn description(&self) -> &'static Description {
        Me::describe()
    }

    fn dependencies(&self) -> Option<Vec<Vec<usize>>> {
        AtDefaults::of::<Me>().dependencies()
    }

    fn nominals(&self) -> Option<Vec<f64>> {
        AtDefaults::of::<Me>().nominals()
    }

    fn delays(&self) -> bool {
        AtDefaults::of::<Me>().delays()
    }

    fn clocks(&self) -> Vec<usize> {
        AtDefaults::of::<Me>().clocks()
    }
}

/// What makes a model at run time, with these values of its parameters, and these inputs.
pub type Make = dyn Fn(&[f64], &[Input]) -> Result<Rc<dyn Liftable<Dual>>, ParameterError> + Send + Sync;

/// A model that is made at run time.
pub struct MadeBy {
    /// Its tables.
    pub description: &'static Description,
    /// What makes it.
    pub make: Box<Make>,
}

impl sealed::Make for MadeBy {
    fn make(&self, values: &[f64], signals: &Signals, t: f64) -> Result<Made, Fault> {
        let model = (self.make)(values, &signals.inputs())?;
        let values: Vec<Dual> = values.iter().map(|&value| Dual::new(value, 0.0)).collect();
        Ok(Made { machine: Stood::at_start(model.machine(), t)?, slopes: Box::new(model.lifted(&values)?) })
    }

    fn check(&self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.description.parameters[index].check(value)
    }
}

impl Exported for MadeBy {
    fn described(&self) -> &dyn Described {
        self
    }
}

impl MadeBy {
    fn at_defaults(&self) -> AtDefaults {
        let description = self.description;
        let defaults: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
        AtDefaults { description, model: (self.make)(&defaults, &[]).ok().map(|model| model.machine()) }
    }
}

impl Described for MadeBy {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn dependencies(&self) -> Option<Vec<Vec<usize>>> {
        self.at_defaults().dependencies()
    }

    fn nominals(&self) -> Option<Vec<f64>> {
        self.at_defaults().nominals()
    }

    fn delays(&self) -> bool {
        self.at_defaults().delays()
    }

    fn clocks(&self) -> Vec<usize> {
        self.at_defaults().clocks()
    }
}

/// A model with its parameters at their defaults, whatever its type.
pub struct AtDefaults {
    /// Its tables.
    pub description: &'static Description,
    /// The model; none where its defaults are of no model.
    pub model: Option<Rc<dyn Machine>>,
}

impl AtDefaults {
    fn of<Me: Mechanism>() -> Self {
        let model = Me::make(Me::Parameters::default(), &[]).ok().map(|model| model.machine());
        Self { description: Me::describe(), model }
    }
}

impl Described for AtDefaults {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn dependencies(&self) -> Option<Vec<Vec<usize>>> {
        let machine = self.model.as_deref()?;
        let (places, unknowns) = match machine.sparsity() {
            Sparsity::Full => return None,
            Sparsity::Places(places) => (places, 0),
            Sparsity::Bordered { places, unknowns } => (places, unknowns),
        };
        let count = machine.states();
        let mut depends = vec![vec![false; count]; count];
        // The unknowns are solved for together: what one of them needs, all of them may need.
        let mut of_unknowns = vec![false; count];
        let mut reads_unknowns = vec![false; count];
        for (row, column) in places.iter().map(|&(row, column)| (usize::from(row), usize::from(column))) {
            match (row < count, column < count) {
                (true, true) => depends[row][column] = true,
                (true, false) => reads_unknowns[row] = true,
                (false, true) => of_unknowns[column] = true,
                (false, false) => {}
            }
        }
        for (own, reads) in depends.iter_mut().zip(&reads_unknowns) {
            if *reads && unknowns > 0 {
                own.iter_mut().zip(&of_unknowns).for_each(|(own, more)| *own |= more);
            }
        }
        let places = |own: Vec<bool>| own.iter().enumerate().filter_map(|(k, on)| on.then_some(k)).collect();
        Some(depends.into_iter().map(places).collect())
    }

    fn nominals(&self) -> Option<Vec<f64>> {
        nominals_at_start(self.model.as_deref()?)
    }

    fn delays(&self) -> bool {
        self.model.as_deref().is_some_and(|model| !model.delays().is_empty())
    }

    fn clocks(&self) -> Vec<usize> {
        let clocks = self.model.as_deref().map(|model| model.clocks()).unwrap_or_default();
        clocks.into_iter().map(|clock| clock.switch).collect()
    }
}
