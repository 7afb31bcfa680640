//! A bond graph as a picture: SVG with causal strokes, multibonds and groups, or DOT for Graphviz.
//!
//! In: a [`Graph`], tables of texts without equations. Out: text. Nothing here reads a file or a clock, and all
//! arithmetic is that of whole numbers: the same graph gives the same bytes everywhere.
//!
//! ```
//! use bg_picture::{Bond, End, Graph, Level, Node};
//!
//! let node = |kind: &str, name: &str| Node { kind: kind.into(), name: name.into(), ..Node::default() };
//! let bond = |from, to, stroke| Bond { from, to, cardinality: 1, stroke, effort: "V".into(), flow: "A".into() };
//! let graph = Graph {
//!     name: "Circuit".into(),
//!     nodes: vec![node("Se", "source"), node("1", "circuit"), node("I", "coil")],
//!     bonds: vec![bond(0, 1, End::To), bond(1, 2, End::To)],
//!     ..Graph::default()
//! };
//! assert!(bg_picture::svg(&graph, Level::Full).starts_with("<svg "));
//! assert!(bg_picture::dot(&graph, Level::Full).starts_with("digraph "));
//! ```
//!
//! | module | question |
//! |---|---|
//! | `graph` | what is drawn |
//! | `exchange` | how a graph is one text and back |
//! | `marks` | which storages are not free |
//! | `sheet` | what stands on the sheet at a level of detail |
//! | `place`, `shelves` | where blocks stand in a group, groups on the sheet |
//! | `route`, `search` | which way the links go |
//! | `layout` | all of it together |
//! | `svg`, `style`, `dot` | how it is written |

mod dot;
mod exchange;
mod graph;
mod layout;
mod marks;
mod place;
mod random;
mod route;
mod search;
mod sheet;
mod shelves;
mod style;
mod svg;
mod text;

pub use dot::dot;
pub use exchange::Unreadable;
pub use graph::{Bond, End, Graph, Level, Node, Part, quantity};
pub use marks::{Mark, marks};
pub use svg::svg;
