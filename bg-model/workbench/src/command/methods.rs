//! The integrators on the command line.
//!
//! In: a name of [`Integrator`]. Out: the integrator; of another name clap's error, which lists them.

use bg_model::integrator::Integrator;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// Reads the name of an integrator; the help lists all with their descriptions.
pub fn integrator() -> impl TypedValueParser<Value = Integrator> {
    let value = |integrator: Integrator| PossibleValue::new(integrator.name()).help(integrator.description());
    PossibleValuesParser::new(Integrator::ALL.map(value)).try_map(|name| name.parse::<Integrator>())
}
