//! A linear bond graph as data, and as text of the language.
//!
//! In: nodes and half arrows. Out: the text of a graph. The data are what the independent solutions read; nothing of
//! the compiler is between the two.

use std::fmt::Write;

use bg_model::nalgebra::{DMatrix, DVector};

/// Whether the variable of a law is an effort or a flow.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Effort.
    Effort,
    /// Flow.
    Flow,
}

/// The time at which everything is compared, s.
pub const TIME: f64 = 0.25;

/// What a node does to the effort `e` and the flow `f` of its bonds, flows counted into the node.
#[derive(Clone, Debug)]
pub enum Law {
    /// Common effort, flows balance.
    Zero,
    /// Common flow, efforts balance.
    One,
    /// e at [`TIME`] along the half arrow, and its rate.
    Effort([DVector<f64>; 2]),
    /// f at [`TIME`] along the half arrow, and its rate.
    Flow([DVector<f64>; 2]),
    /// f = A p.
    Inertia(DMatrix<f64>),
    /// e = A q.
    Stiffness(DMatrix<f64>),
    /// e = A f where the variable is the flow, f = A e where it is the effort; in a free one either may determine the
    /// other, and it is e = A f.
    Resistance {
        /// A.
        matrix: DMatrix<f64>,
        /// The variable, unless the law works both ways.
        of: Option<Role>,
    },
    /// f out = A f in and e in = A^T e out where the variable is the flow, or there is none; e out = A e in and f in =
    /// A^T f out where it is the effort.
    Transformer {
        /// A.
        matrix: DMatrix<f64>,
        /// The variable, unless the law works both ways.
        of: Option<Role>,
    },
    /// e in = r f out and e out = r f in.
    Gyrator(f64),
}

/// A junction or an element.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its name.
    pub name: String,
    /// Its declaration.
    pub text: String,
    /// What it does.
    pub law: Law,
}

/// A graph.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Junctions and elements.
    pub nodes: Vec<Node>,
    /// Half arrows: from a node to another, and the number of components.
    pub bonds: Vec<(usize, usize, usize)>,
}

impl Node {
    /// Whether it is a two-port.
    #[must_use]
    pub fn is_two_port(&self) -> bool {
        matches!(self.law, Law::Transformer { .. } | Law::Gyrator(_))
    }
}

impl Network {
    /// A new node.
    pub fn node(&mut self, name: String, text: String, law: Law) -> usize {
        self.nodes.push(Node { name, text, law });
        self.nodes.len() - 1
    }

    /// The bonds of a node, each with whether its half arrow points into the node.
    pub fn bonds_of(&self, node: usize) -> impl Iterator<Item = (usize, bool)> {
        let bonds = self.bonds.iter().enumerate();
        bonds
            .filter(move |(_, (from, to, _))| *from == node || *to == node)
            .map(move |(k, &(_, to, _))| (k, to == node))
    }

    /// The bond into a two-port and the one out of it.
    #[must_use]
    pub fn in_and_out(&self, node: usize) -> (usize, usize) {
        let at = |inward| self.bonds_of(node).find(|&(_, into)| into == inward).map_or(usize::MAX, |(bond, _)| bond);
        (at(true), at(false))
    }

    /// Only these nodes, with the bonds between them.
    #[must_use]
    pub fn only(&self, kept: &[usize]) -> Self {
        let place = |node: usize| kept.iter().position(|&known| known == node);
        Self {
            nodes: kept.iter().map(|&node| self.nodes[node].clone()).collect(),
            bonds: self.bonds.iter().filter_map(|&(from, to, size)| Some((place(from)?, place(to)?, size))).collect(),
        }
    }

    /// The graph in the language.
    #[must_use]
    pub fn text(&self) -> String {
        self.text_with("")
    }

    /// The graph in the language with another statement.
    #[must_use]
    pub fn text_with(&self, statement: &str) -> String {
        let mut text = format!("graph G {{\n    param k: N/m = 1; param n: m/N = 1; {statement}\n");
        for node in &self.nodes {
            let _ = writeln!(text, "    {}", node.text);
        }
        // One chain for every two-port, one bond for every other.
        for &(from, to, _) in &self.bonds {
            let _ = writeln!(text, "    {} -> {};", self.nodes[from].name, self.nodes[to].name);
        }
        text + "}\n"
    }
}
