//! Which method makes the steps, from when on and why.

use core::fmt;

/// A change of method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// When, s.
    pub t: f64,
    /// The method that makes the steps from there on.
    pub method: &'static str,
    /// Why it does.
    pub reason: Reason,
}

/// Why a method makes the steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The run begins with it.
    First,
    /// It took turns with the method before, and came further with the same number of rates, by this factor.
    Further(f64),
    /// A step of it met the tolerances that was so many times as long as the one in sight, and ended where the method
    /// before came to.
    Longer(f64),
    /// Its steps cost less than those of the method before and meet the tolerances too.
    Cheaper,
    /// The method before could not go on, or only by steps of almost no length.
    GoesOn,
    /// A switch followed errors of the method before that are below the tolerances.
    Switches,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::First => f.write_str("begins"),
            Self::Further(factor) => write!(f, "{:.0} % further with the same work", 100.0 * (factor - 1.0)),
            Self::Longer(factor) => write!(f, "steps {factor:.0} times as long"),
            Self::Cheaper => f.write_str("cheaper steps suffice"),
            Self::GoesOn => f.write_str("the other could not go on"),
            Self::Switches => f.write_str("a switch followed small errors of the other"),
        }
    }
}
