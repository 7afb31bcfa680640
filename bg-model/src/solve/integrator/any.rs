//! A method chosen at run time.
//!
//! In: one of the methods. Out: its steps. Only the one type reaches the driver, so a program that offers many methods
//! compiles the driver once for each model and not once for each pair.

use alloc::boxed::Box;

use super::hand_on::hand_on;
#[cfg(feature = "std")]
use super::lanes::OfOne;
use super::{
    Ark5, Auto, Bs5, Cfmr7, Change, Dop853, Flow, Gauss6, Method, Nystrom, PointRef, Radau5, Radau9, Rk4, Rodas5p,
    Ros2, Scale, StepControl, Taylor,
};

macro_rules! any {
    ($($name:ident)*) => {
        /// One of the methods of this crate.
        #[derive(Clone, Debug)]
        #[allow(missing_docs, reason = "the variants have the methods' names")]
        pub enum AnyMethod {
            $($name(Box<$name>),)*
        }

        $(impl From<$name> for AnyMethod {
            fn from(method: $name) -> Self {
                Self::$name(Box::new(method))
            }
        })*
    };
}

any!(Ark5 Auto Bs5 Cfmr7 Dop853 Gauss6 Nystrom Radau5 Radau9 Rk4 Rodas5p Ros2 Taylor);

/// Hands on to the method inside.
macro_rules! inside {
    (($($_borrow:tt)+) $any:expr, $method:ident => $then:expr) => {
        match $any {
            AnyMethod::Ark5($method) => $then,
            AnyMethod::Auto($method) => $then,
            AnyMethod::Bs5($method) => $then,
            AnyMethod::Cfmr7($method) => $then,
            AnyMethod::Dop853($method) => $then,
            AnyMethod::Gauss6($method) => $then,
            AnyMethod::Nystrom($method) => $then,
            AnyMethod::Radau5($method) => $then,
            AnyMethod::Radau9($method) => $then,
            AnyMethod::Rk4($method) => $then,
            AnyMethod::Rodas5p($method) => $then,
            AnyMethod::Ros2($method) => $then,
            AnyMethod::Taylor($method) => $then,
        }
    };
}

impl AnyMethod {
    /// The method of one of several runs side by side; none of a method whose runs cannot be.
    #[cfg(feature = "std")]
    pub(crate) fn of_one(&mut self) -> Option<&mut dyn OfOne> {
        match self {
            Self::Cfmr7(method) => Some(&mut **method),
            Self::Dop853(method) => Some(&mut **method),
            Self::Nystrom(method) => Some(&mut **method),
            _ => None,
        }
    }
}

impl Method for AnyMethod {
    hand_on!(inside);

    fn chosen(&mut self) -> Option<&mut AnyMethod> {
        Some(self)
    }

    fn needs_series(&self) -> bool {
        inside!((&) self, method => method.needs_series())
    }

    fn fit(&mut self, states: usize) {
        inside!((&mut) self, method => method.fit(states));
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        inside!((&mut) self, method => method.attempt(flow, start, h, scale, end))
    }

    fn advance(&mut self) {
        inside!((&mut) self, method => method.advance());
    }

    fn restart(&mut self) {
        inside!((&mut) self, method => method.restart());
    }

    fn changes(&self) -> &[Change] {
        inside!((&) self, method => method.changes())
    }
}
