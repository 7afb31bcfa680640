//! Calculations in the vectors of the machine at hand.
//!
//! In: a calculation. Out: what it gives, compiled twice: for the vectors of every machine of its kind, and for AVX2.
//! The results are the same to the bit, as nothing is fused.

use pulp::NullaryFnOnce;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
use pulp::x86::V3;

/// The vectors that steps are compiled for. Not [`pulp::Arch`], which has those of AVX-512 besides: one run gains
/// nothing by them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Arch {
    /// Those of every machine of its kind.
    Scalar,
    /// Those of AVX2.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    V3(V3),
}

impl Arch {
    /// The largest of the machine at hand.
    pub fn new() -> Self {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        if let Some(machine) = V3::try_new() {
            return Self::V3(machine);
        }
        Self::Scalar
    }

    /// Calls `of`, compiled for these vectors where it is inlined.
    #[inline(always)]
    pub fn dispatch<F: NullaryFnOnce>(self, of: F) -> F::Output {
        match self {
            Self::Scalar => of.call(),
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Self::V3(machine) => machine.vectorize(of),
        }
    }

    /// The same for what is long, on machines of a kind of which nearly all have vectors: `of` is compiled for these
    /// alone, and those without do `elsewhere`, which gives the same.
    #[inline(always)]
    pub fn dispatch_or<F: NullaryFnOnce>(self, of: F, elsewhere: impl FnOnce(F) -> F::Output) -> F::Output {
        match self {
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Self::Scalar => elsewhere(of),
            #[cfg(not(all(feature = "std", target_arch = "x86_64")))]
            Self::Scalar => {
                let _ = elsewhere;
                of.call()
            }
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Self::V3(machine) => machine.vectorize(of),
        }
    }
}
