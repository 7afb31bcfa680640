//! Suites of bg-model, in a package of their own: models of tests are compiled without the optimisation that bg-model
//! has where tests are built.
//!
//! Cargo asks for a library; what the suites share is [`problems`](../problems) and [`random`](../random), which each
//! takes as a module.
