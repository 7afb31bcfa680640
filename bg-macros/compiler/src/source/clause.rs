//! What a value in a user's clause must be, such as the mass of a body: its words, its shape, what it may depend on,
//! and what physics allows.
//!
//! In: the clause that an expansion binds to a name. Out: faults at the user's own token where shape or dependence are
//! wrong (`graph`), and requirements of the value (`requirements`).

/// A user's clause.
#[derive(Clone, Debug)]
pub struct Clause {
    /// In the user's words, such as "the mass of body `rod`".
    pub what: String,
    /// 1, 3 or 9 components: a number, a vector, a matrix.
    pub components: usize,
    /// What it may depend on.
    pub given: Given,
    /// What physics allows.
    pub allowed: Allowed,
    /// Whether it is what a part was given for a parameter, and not the clause of a mechanism word.
    pub is_argument: bool,
}

/// What a clause may depend on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Given {
    /// Parameters and numbers.
    Constant,
    /// These and guesses.
    Start,
    /// Parameters, inputs, time.
    Source,
    /// Everything but inputs.
    State,
    /// Everything.
    Free,
}

/// What physics allows for a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Allowed {
    /// Any, or the requirements of what it is made from are enough.
    Any,
    /// Numbers above 0, or a symmetric positive definite matrix.
    Positive,
    /// A number above 0 that is the sum of what is looked at itself, and so not faulty of itself.
    Total,
    /// Numbers that are not negative, or a symmetric matrix that is not.
    NotNegative,
    /// As [`Allowed::NotNegative`], but a matrix need not be symmetric: what a resistance takes is never negative.
    Dissipative,
    /// A resistance whose flow follows from its effort, so that it has a reciprocal.
    Invertible,
    /// Numbers from 0 to 1.
    Fraction,
    /// Numbers between 0 and 1, neither of them.
    Part,
    /// The way to the end of a stop, which is not negative but for what closing the joints leaves of it.
    Clearance,
    /// The inertia of a rigid body: principal moments or a symmetric matrix, positive, none of the moments larger than
    /// the other two together.
    Inertia,
    /// A rotation matrix.
    Rotation,
    /// A divisor of a system of equations, which must not vanish.
    Determined,
}

impl Clause {
    /// A clause of numbers and parameters of which physics asks nothing.
    #[must_use]
    pub fn new(what: impl Into<String>, components: usize) -> Self {
        Self { what: what.into(), components, given: Given::Constant, allowed: Allowed::Any, is_argument: false }
    }

    /// What a part is given for a parameter, or for an input, which may be anything.
    #[must_use]
    pub fn argument(what: impl Into<String>, given: Given) -> Self {
        Self { given, is_argument: true, ..Self::new(what, 1) }
    }

    /// Whether it depends on parameters and numbers only.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.given == Given::Constant
    }

    /// The same with other dependence.
    #[must_use]
    pub fn given(self, given: Given) -> Self {
        Self { given, ..self }
    }

    /// The same with what physics allows.
    #[must_use]
    pub fn allowed(self, allowed: Allowed) -> Self {
        Self { allowed, ..self }
    }
}
