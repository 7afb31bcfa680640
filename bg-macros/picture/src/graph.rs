//! What is drawn: a multibond graph as tables of texts, without its equations.
//!
//! In: nothing. Out: [`Graph`]. Whoever has a graph fills these tables; indices are those of the tables themselves.

/// A multibond graph with its causal strokes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// The graph's name.
    pub name: String,
    /// Bodies, joints and the other mechanism words that nodes belong to, in the order of the source.
    pub parts: Vec<Part>,
    /// Junctions and elements.
    pub nodes: Vec<Node>,
    /// Bonds.
    pub bonds: Vec<Bond>,
}

/// A mechanism word of the source: what a group of nodes stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// What it is: `ground`, `body`, `revolute z`, `contact`, `spring`, `drive`.
    pub word: String,
    /// Its name.
    pub name: String,
}

/// A junction or an element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Node {
    /// Its symbol: `0`, `1`, `Se`, `Sf`, `I`, `C`, `R`, `TF`, `GY` or a modulated one.
    pub kind: String,
    /// Its whole name, such as `rod.linear`.
    pub name: String,
    /// Its constitutive law as text; empty for a junction.
    pub law: String,
    /// Its states with their units, such as `rod.linear.p_x kg*m/s`.
    pub states: Vec<String>,
    /// The part that it belongs to, an index into [`Graph::parts`].
    pub part: Option<usize>,
}

/// A bond.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bond {
    /// The node where the half arrow starts, an index into [`Graph::nodes`].
    pub from: usize,
    /// The node that the half arrow points to.
    pub to: usize,
    /// 1 for a scalar bond, 3 for a multibond of three.
    pub cardinality: usize,
    /// The end with the causal stroke: the one that receives the effort and gives the flow.
    pub stroke: End,
    /// Unit of the effort.
    pub effort: String,
    /// Unit of the flow.
    pub flow: String,
}

/// One of a bond's two ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The end where the half arrow starts.
    From,
    /// The end that the half arrow points to.
    To,
}

/// How much of a graph is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One box for each part; nodes that belong to none stay as they are.
    Words,
    /// Every junction and every element.
    Full,
}

/// A state with its unit, as [`Node::states`] has it: `rod.linear.p_x kg*m/s`; without the unit 1.
#[must_use]
pub fn quantity(name: &str, unit: &str) -> String {
    if unit == "1" { name.to_owned() } else { format!("{name} {unit}") }
}

impl Part {
    /// Its name and what it is: `pin_a revolute z`; only `ground` of the ground.
    #[must_use]
    pub fn title(&self) -> String {
        if self.word == self.name { self.name.clone() } else { format!("{} {}", self.name, self.word) }
    }
}

impl Bond {
    /// The node at the other end than `node`.
    #[must_use]
    pub fn other(&self, node: usize) -> usize {
        if self.from == node { self.to } else { self.from }
    }

    /// Whether the stroke is at `node`.
    #[must_use]
    pub fn has_stroke_at(&self, node: usize) -> bool {
        match self.stroke {
            End::From => self.from == node,
            End::To => self.to == node,
        }
    }
}

impl Node {
    /// Its name inside its part: what follows the part's name and a dot.
    #[must_use]
    pub fn short_name<'a>(&'a self, parts: &[Part]) -> &'a str {
        let part = self.part.and_then(|part| parts.get(part));
        part.and_then(|part| self.name.strip_prefix(part.name.as_str())?.strip_prefix('.')).unwrap_or(&self.name)
    }
}

impl End {
    /// The other end.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::From => Self::To,
            Self::To => Self::From,
        }
    }
}
