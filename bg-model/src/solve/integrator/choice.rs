//! The integrators by name.
//!
//! In: a name and, for methods with a fixed step, the step. Out: the method. A program that reads names from a command
//! line or a file needs nothing else.

use alloc::borrow::ToOwned;
use alloc::string::String;
use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::{AnyMethod, Ark5, Auto, Bs5, Cfmr7, Dop853, Gauss6, Nystrom, Radau5, Radau9, Rk4, Rodas5p, Ros2, Taylor};

/// An integrator of this crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "`description` says what each is")]
pub enum Integrator {
    #[default]
    Auto,
    Bs5,
    Cfmr7,
    Nystrom,
    Dop853,
    Taylor,
    Ark5,
    Rodas5p,
    Radau5,
    Radau9,
    Rk4,
    Ros2,
    Gauss6,
}

/// A name that no integrator has.
#[derive(Clone, PartialEq, Eq, Error)]
#[error("there is no integrator `{name}`; there are {}", Integrator::ALL.map(Integrator::name).join(", "))]
pub struct UnknownIntegrator {
    /// The name.
    pub name: String,
}

debug_is_display!(UnknownIntegrator);

impl Integrator {
    /// All of them: those that choose their steps, then those with fixed steps.
    pub const ALL: [Self; 13] = [
        Self::Auto,
        Self::Bs5,
        Self::Cfmr7,
        Self::Nystrom,
        Self::Dop853,
        Self::Taylor,
        Self::Ark5,
        Self::Rodas5p,
        Self::Radau5,
        Self::Radau9,
        Self::Rk4,
        Self::Ros2,
        Self::Gauss6,
    ];

    /// Those that `auto` chooses among.
    pub const OF_AUTO: [Self; 6] = [Self::Dop853, Self::Cfmr7, Self::Nystrom, Self::Taylor, Self::Ark5, Self::Radau9];

    /// Its name, in small letters.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.texts().0
    }

    /// What it is, in one line.
    #[must_use]
    pub const fn description(self) -> &'static str {
        self.texts().1
    }

    const fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Auto => ("auto", "An explicit, partly implicit or implicit method, whichever the run calls for"),
            Self::Bs5 => ("bs5", "Explicit, order 5(4)"),
            Self::Cfmr7 => ("cfmr7", "Explicit, order 7(5), for oscillations"),
            Self::Nystrom => ("nystrom", "Explicit, for mechanisms with stiff, lightly damped joints"),
            Self::Dop853 => ("dop853", "Explicit, order 8(5,3)"),
            Self::Taylor => ("taylor", "Explicit, Taylor series, order by the tolerance, for high precision"),
            Self::Ark5 => ("ark5", "Implicit where states are damped stiffly, else explicit, order 5(4)"),
            Self::Rodas5p => ("rodas5p", "Rosenbrock, order 5(4), for stiff systems"),
            Self::Radau5 => ("radau5", "Implicit, order 5, for stiff systems"),
            Self::Radau9 => ("radau9", "Implicit, order 9, for stiff systems"),
            Self::Rk4 => ("rk4", "Explicit, order 4, fixed step"),
            Self::Ros2 => ("ros2", "Semi-implicit, order 2, fixed step"),
            Self::Gauss6 => ("gauss6", "Implicit, order 6, fixed step, keeps energy"),
        }
    }

    /// The method; `step` (s) is that of a fixed-step method, without effect on others.
    #[must_use]
    pub fn method(self, step: f64) -> AnyMethod {
        match self {
            Self::Auto => Auto::new().into(),
            Self::Bs5 => Bs5::new().into(),
            Self::Cfmr7 => Cfmr7::new().into(),
            Self::Nystrom => Nystrom::new().into(),
            Self::Dop853 => Dop853::new().into(),
            Self::Taylor => Taylor::new().into(),
            Self::Ark5 => Ark5::new().into(),
            Self::Rodas5p => Rodas5p::new().into(),
            Self::Radau5 => Radau5::new().into(),
            Self::Radau9 => Radau9::new().into(),
            Self::Rk4 => Rk4::new(step).into(),
            Self::Ros2 => Ros2::new(step).into(),
            Self::Gauss6 => Gauss6::new(step).into(),
        }
    }

    /// The one of those that `auto` chooses among whose method has this name, as in [`Change::method`](super::Change);
    /// none where it is another one's.
    #[cfg(feature = "std")]
    #[must_use]
    pub(crate) fn of_auto(name: &str) -> Option<Self> {
        Self::OF_AUTO.into_iter().find(|one| super::Method::name(&one.method(1.0)) == name)
    }

    /// Whether its steps have a fixed size, which then takes the place of tolerances.
    #[must_use]
    pub const fn has_fixed_step(self) -> bool {
        matches!(self, Self::Rk4 | Self::Ros2 | Self::Gauss6)
    }

    /// Whether it needs the Taylor series of the system.
    #[must_use]
    pub const fn needs_series(self) -> bool {
        matches!(self, Self::Taylor)
    }

    /// Whether runs by it can be made side by side in the vectors of the machine.
    #[must_use]
    pub const fn is_for_lanes(self) -> bool {
        matches!(self, Self::Cfmr7 | Self::Dop853 | Self::Nystrom)
    }
}

impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Integrator {
    type Err = UnknownIntegrator;

    fn from_str(name: &str) -> Result<Self, UnknownIntegrator> {
        let found = Self::ALL.into_iter().find(|integrator| integrator.name() == name);
        found.ok_or_else(|| UnknownIntegrator { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::integrator::{Method, StepControl};

    #[test]
    fn a_name_gives_the_integrator_that_has_it() {
        for integrator in Integrator::ALL {
            assert_eq!(integrator.to_string().parse(), Ok(integrator));
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_there_are() {
        let text = "DOP853".parse::<Integrator>().unwrap_err().to_string();
        assert!(
            text.starts_with("there is no integrator `DOP853`; there are auto, bs5, cfmr7, nystrom, dop853,"),
            "{text}"
        );
    }

    #[test]
    fn what_is_said_of_an_integrator_is_what_its_method_says() {
        for integrator in Integrator::ALL {
            let method = integrator.method(0.5);
            let is_fixed = method.control() == StepControl::Fixed { step: 0.5 };
            assert_eq!((is_fixed, method.needs_series()), (integrator.has_fixed_step(), integrator.needs_series()));
        }
    }
}
