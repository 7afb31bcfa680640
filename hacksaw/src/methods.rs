//! The integrators by name.
//!
//! In: a name and, for methods with a fixed step, the step. Out: the method, handed to a [`MethodVisitor`].
//! [`Integrator::visit`] is the only place that knows the types behind the names.

use bg_model::integrator::{Auto, Dop853, Method, Rk4, Rodas5p, Ros2};
use clap::ValueEnum;

/// An integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// DOP853 or RODAS5P, whichever the measured stiffness calls for
    #[default]
    Auto,
    /// Explicit, order 8(5,3)
    Dop853,
    /// Rosenbrock, order 5(4), for stiff systems
    Rodas5p,
    /// Explicit, order 4, fixed step
    Rk4,
    /// Semi-implicit, order 2, fixed step
    Ros2,
}

/// Something to do with a method, whatever its type.
pub trait MethodVisitor<const N: usize> {
    /// What comes of it.
    type Output;

    /// Is given the method, ready to run.
    fn visit(self, method: impl Method<N>) -> Self::Output;
}

impl Integrator {
    /// Hands the method to `visitor`; `step` (s) is that of a fixed-step method.
    pub fn visit<V: MethodVisitor<N>, const N: usize>(self, step: f64, visitor: V) -> V::Output {
        match self {
            Self::Auto => visitor.visit(Auto::<N>::new()),
            Self::Dop853 => visitor.visit(Dop853::new()),
            Self::Rodas5p => visitor.visit(Rodas5p::new()),
            Self::Rk4 => visitor.visit(Rk4::new(step)),
            Self::Ros2 => visitor.visit(Ros2::new(step)),
        }
    }

    /// Whether its steps have a fixed size, which then takes the place of tolerances.
    #[must_use]
    pub fn has_fixed_step(self) -> bool {
        matches!(self, Self::Rk4 | Self::Ros2)
    }

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().expect("no integrator is skipped").get_name().to_owned()
    }
}
