//! What a mechanism is, and what its generated code calls. Nothing here knows how it is integrated.

pub mod assembly;
pub mod capability;
pub mod clock;
pub mod delay;
pub(crate) mod delayed;
pub mod description;
pub mod drawing;
pub mod dynamics;
pub mod holding;
pub mod input;
pub mod iteration;
pub(crate) mod joined;
pub mod linear;
pub mod mechanism;
pub(crate) mod nearest;
pub(crate) mod origin;
pub mod parameters;
pub(crate) mod reactions;
pub mod requirement;
pub mod sampled;
pub mod scalar;
pub mod series;
pub mod standing;
pub mod start;
pub mod system;
pub(crate) mod vectorised;
