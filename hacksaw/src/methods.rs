//! The integrators by name.
//!
//! In: a name and, for methods with a fixed step, the step. Out: the method.

use bg_model::integrator::{
    AnyMethod, Auto, Bs5, Cfmr7, Dop853, Gauss6, Nystrom, Radau5, Radau9, Rk4, Rodas5p, Ros2, Taylor,
};
use clap::ValueEnum;

/// An integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// DOP853 or Radau IIA 9, whichever the measured stiffness calls for
    #[default]
    Auto,
    /// Explicit, order 5(4)
    Bs5,
    /// Explicit, order 7(5), for oscillations
    Cfmr7,
    /// Explicit, for mechanisms with stiff, lightly damped joints
    Nystrom,
    /// Explicit, order 8(5,3)
    Dop853,
    /// Explicit, Taylor series, order by the tolerance, for high precision
    Taylor,
    /// Rosenbrock, order 5(4), for stiff systems
    Rodas5p,
    /// Implicit, order 5, for stiff systems
    Radau5,
    /// Implicit, order 9, for stiff systems
    Radau9,
    /// Explicit, order 4, fixed step
    Rk4,
    /// Semi-implicit, order 2, fixed step
    Ros2,
    /// Implicit, order 6, fixed step, keeps energy
    Gauss6,
}

impl Integrator {
    /// The method; `step` (s) is that of a fixed-step method.
    #[must_use]
    pub fn method<const N: usize>(self, step: f64) -> AnyMethod<N> {
        match self {
            Self::Auto => Auto::new().into(),
            Self::Bs5 => Bs5::new().into(),
            Self::Cfmr7 => Cfmr7::new().into(),
            Self::Nystrom => Nystrom::new().into(),
            Self::Dop853 => Dop853::new().into(),
            Self::Taylor => Taylor::new().into(),
            Self::Rodas5p => Rodas5p::new().into(),
            Self::Radau5 => Radau5::new().into(),
            Self::Radau9 => Radau9::new().into(),
            Self::Rk4 => Rk4::new(step).into(),
            Self::Ros2 => Ros2::new(step).into(),
            Self::Gauss6 => Gauss6::new(step).into(),
        }
    }

    /// Whether its steps have a fixed size, which then takes the place of tolerances.
    #[must_use]
    pub fn has_fixed_step(self) -> bool {
        matches!(self, Self::Rk4 | Self::Ros2 | Self::Gauss6)
    }

    /// Whether it needs the Taylor series of the system.
    #[must_use]
    pub fn needs_series(self) -> bool {
        self == Self::Taylor
    }

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().expect("no integrator is skipped").get_name().to_owned()
    }
}
