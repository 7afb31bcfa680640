//! All assignments of causal strokes, tried one by one.
//!
//! In: a [`Network`]. Out: the first valid assignment. The rules are those of Karnopp, Margolis and Rosenberg, System
//! Dynamics (2012), section 5.4: one stroke decides at a junction, storages are in integral causality.

use super::network::{Law, Network, Role};

/// For every bond whether its stroke is where the half arrow points.
pub type Strokes = Vec<bool>;

/// The most bonds of a graph whose assignments are tried.
pub const MOST: usize = 13;

/// The first valid assignment in the order in which a stroke at a half arrow's start comes before one at its end,
/// earlier bonds counting more. None where no assignment is valid.
///
/// # Panics
/// Where the graph has more bonds than [`MOST`].
#[must_use]
pub fn first(network: &Network) -> Option<Strokes> {
    first_where(network, &|_| true)
}

/// The first valid assignment where only the storages that `is_integral` names need integral causality.
fn first_where(network: &Network, is_integral: &dyn Fn(usize) -> bool) -> Option<Strokes> {
    let count = network.bonds.len();
    assert!(count <= MOST, "{count} bonds");
    let rules = rules(network, is_integral);
    let found = (0..1 << count).find(|&strokes| rules.iter().all(|rule| rule.holds(strokes)))?;
    Some((0..count).map(|bond| found & bit(count, bond) != 0).collect())
}

/// The first valid assignment in which each storage in turn has integral causality where those before it leave that
/// open: first those with laws of a variable, then the others, in their order.
#[must_use]
pub fn preferred(network: &Network) -> Option<Strokes> {
    let mut storages: Vec<usize> = (0..network.nodes.len())
        .filter(|&node| matches!(network.nodes[node].law, Law::Inertia(_) | Law::Stiffness(_)))
        .collect();
    storages.sort_by_key(|&node| !["(p)", "(q)"].iter().any(|law| network.nodes[node].text.contains(law)));
    let mut integral = Vec::new();
    for storage in storages {
        if first_where(network, &|node| node == storage || integral.contains(&node)).is_some() {
            integral.push(storage);
        }
    }
    first_where(network, &|node| integral.contains(&node))
}

/// Whether every node has the causality that it needs.
#[must_use]
pub fn is_valid(network: &Network, strokes: &[bool]) -> bool {
    let count = strokes.len();
    let set = (0..count).filter(|&bond| strokes[bond]).map(|bond| bit(count, bond)).sum();
    rules(network, &|_| true).iter().all(|rule| rule.holds(set))
}

/// A bond's place in an assignment as a number; the first bond's counts most.
fn bit(count: usize, bond: usize) -> u32 {
    1 << (count - 1 - bond)
}

/// At how many of its bonds a node may receive the effort.
struct Rule {
    /// Its bonds.
    bonds: u32,
    /// Those whose half arrows point out of it: there a stroke at the end is one at the other node.
    outward: u32,
    allowed: Allowed,
}

/// What a node allows.
enum Allowed {
    /// As many bonds as this.
    Count(u32),
    /// None or all.
    Alike,
    /// Exactly these.
    Only(u32),
}

impl Rule {
    fn holds(&self, strokes: u32) -> bool {
        let received = (strokes ^ self.outward) & self.bonds;
        match self.allowed {
            Allowed::Count(count) => received.count_ones() == count,
            Allowed::Alike => received == 0 || received == self.bonds,
            Allowed::Only(these) => received == these,
        }
    }
}

/// The rules of all nodes but those that take either causality; of storages only those that `is_integral` names have
/// one.
fn rules(network: &Network, is_integral: &dyn Fn(usize) -> bool) -> Vec<Rule> {
    let count = network.bonds.len();
    let of = |node: usize| -> Option<Rule> {
        let place = |pointing: Option<bool>| -> u32 {
            let bonds = network.bonds_of(node).filter(|(_, into)| pointing.is_none_or(|wanted| wanted == *into));
            bonds.map(|(bond, _)| bit(count, bond)).sum()
        };
        let (bonds, inward, outward) = (place(None), place(Some(true)), place(Some(false)));
        let allowed = match &network.nodes[node].law {
            Law::Inertia(_) | Law::Stiffness(_) if !is_integral(node) => return None,
            Law::Zero => Allowed::Count(1),
            Law::One => Allowed::Count(bonds.count_ones() - 1),
            Law::Effort(_) | Law::Stiffness(_) | Law::Resistance { of: Some(Role::Flow), .. } => Allowed::Only(0),
            Law::Flow(_) | Law::Inertia(_) | Law::Resistance { of: Some(Role::Effort), .. } => Allowed::Only(bonds),
            Law::Resistance { of: None, .. } => return None,
            Law::Transformer { of: None, .. } => Allowed::Count(1),
            Law::Transformer { of: Some(Role::Flow), .. } => Allowed::Only(outward),
            Law::Transformer { of: Some(Role::Effort), .. } => Allowed::Only(inward),
            Law::Gyrator(_) => Allowed::Alike,
        };
        Some(Rule { bonds, outward, allowed })
    };
    (0..network.nodes.len()).filter_map(of).collect()
}
