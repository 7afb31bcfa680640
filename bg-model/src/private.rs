//! What only generated code calls, under one name. It may change with every version: the macro and this crate are of
//! one.
//!
//! Generated code calls besides: the public traits, tables and errors of this crate, the arithmetic of series, nalgebra
//! and serde.

pub use alloc::boxed::Box;
pub use alloc::vec;
pub use alloc::vec::Vec;

#[cfg(feature = "macros")]
pub use bg_macros::picture;

#[cfg(feature = "std")]
pub use crate::model::dynamics::Abreast;
pub use crate::model::dynamics::Over;
pub use crate::model::iteration::{Equations, lift, newton};
pub use crate::model::joined::{joined, taken};
pub use crate::model::linear::pivot::Pivot;
#[cfg(feature = "std")]
pub use crate::model::mechanism::into_lanes;
pub use crate::model::mechanism::join;
pub use crate::model::parameters::serialized::{deserialize, serialize};
pub use crate::model::requirement::{Requirement, require};
#[cfg(feature = "std")]
pub use crate::model::scalar::lanes::{Lanes, Vector};
pub use crate::model::scalar::slopes::Slopes;
pub use crate::model::series::{store, window};
pub use crate::model::start::{StartRoutine, StartTable, Starting, decided, kept, redundant, share, sides, start};
pub use crate::model::tabled::{Table, are_doubles, evaluate, is_tabled};
pub use crate::model::vectorised::vectorised_rate;

/// Eliminations as tables, where they are too long to be unrolled.
pub mod table {
    pub use crate::model::linear::table::{Slot, eliminate, substitute};
}

/// What generated code says first: the version of the macro that wrote it, which must be this crate's.
///
/// `tests/version.rs` compares the version here with the crate's.
#[doc(hidden)]
#[macro_export]
macro_rules! __bond_graph_of_one_version {
    ("0.1.0") => {};
    ($version:literal) => {
        ::core::compile_error!(::core::concat!(
            "bg-macros ",
            $version,
            " wrote this code, and bg-model 0.1.0 is to run it\nhelp: let Cargo.toml give both the same version"
        ));
    };
}
pub use crate::__bond_graph_of_one_version as of_one_version;

/// What a generated model says in `Mechanism` where it has functions in the vectors of a machine: for slopes, and with
/// `lanes` for runs side by side, too. Nothing in test builds, half of which these functions would be: there
/// [`RunByRun`](crate::model::dynamics::RunByRun) and [`EachAlone`](crate::model::dynamics::EachAlone) give the same.
#[cfg(all(feature = "std", not(debug_assertions)))]
#[doc(hidden)]
#[macro_export]
macro_rules! __bond_graph_in_vectors {
    () => {
        fn slopes<V: $crate::__private::Slopes>(
            &self,
            values: &[$crate::__private::Vec<$crate::scalar::Gradient>],
        ) -> ::core::option::Option<
            ::core::result::Result<$crate::mechanism::SideBySide<V>, $crate::parameters::ParameterError>,
        > {
            ::core::option::Option::Some($crate::__private::join(self, values))
        }
    };
    (lanes) => {
        $crate::__bond_graph_in_vectors!();

        fn lanes<V: $crate::__private::Vector>(
            &self,
            values: &[$crate::__private::Lanes<V>],
        ) -> ::core::option::Option<
            ::core::result::Result<
                $crate::__private::Box<dyn $crate::__private::Abreast<V>>,
                $crate::parameters::ParameterError,
            >,
        > {
            ::core::option::Option::Some($crate::__private::into_lanes(self, values))
        }
    };
}

/// What a generated model says in `Mechanism` where it has functions in the vectors of a machine: nothing in such a
/// build.
#[cfg(not(all(feature = "std", not(debug_assertions))))]
#[doc(hidden)]
#[macro_export]
macro_rules! __bond_graph_in_vectors {
    ($(lanes)?) => {};
}
pub use crate::__bond_graph_in_vectors as in_vectors;
