//! The examples of the language's reference, which is the documentation of [`bond_graph!`](crate::bond_graph): they are
//! tested here, where the macro has what its code needs.

#[doc = include_str!("../../bg-macros/docs/language/README.md")]
#[doc = include_str!("../../bg-macros/docs/language/statements.md")]
#[doc = include_str!("../../bg-macros/docs/language/expressions.md")]
#[doc = include_str!("../../bg-macros/docs/language/units.md")]
#[doc = include_str!("../../bg-macros/docs/language/mechanisms.md")]
#[doc = include_str!("../../bg-macros/docs/language/parts.md")]
#[doc = include_str!("../../bg-macros/docs/language/library.md")]
#[doc = include_str!("../../bg-macros/docs/language/scenes.md")]
#[doc = include_str!("../../bg-macros/docs/language/start.md")]
#[doc = include_str!("../../bg-macros/docs/language/values.md")]
#[doc = include_str!("../../bg-macros/docs/language/causality.md")]
#[doc = include_str!("../../bg-macros/docs/language/events.md")]
#[doc = include_str!("../../bg-macros/docs/language/outputs.md")]
#[doc = include_str!("../../bg-macros/docs/language/generated-items.md")]
#[doc = include_str!("../../bg-macros/docs/language/faults.md")]
struct Chapters;
