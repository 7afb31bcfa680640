//! With which sign each value is held.
//!
//! In: the operations and the choice of pairs. Out: for each operation whether its negative is held.
//! Method: that both halves of a pair add or subtract alike, that a product has the sign of its factors, that a result
//! is held as it is: each is a linear equation over two elements. A negation remains where they contradict each other.

use super::Zeros;
use super::choose::Choice;
use super::nodes::{Kind, Nodes, Signed};
use super::parity::Parity;
use crate::schedule::Operand;

/// The unknowns in the sign of a term as it is held: that of the sum, that of the operand; and its own sign.
fn term(node: usize, operand: Signed) -> (Vec<usize>, bool) {
    (std::iter::once(node).chain(operand.node()).collect(), operand.negative)
}

/// Whether the negative of each operation's value is held. A sum that is zero has another sign than the negated sum of
/// the negatives has: no sum's negative is held where zeros keep their signs.
pub(super) fn signs(nodes: &Nodes, choice: &Choice, zeros: Zeros) -> Vec<bool> {
    let mut parity = Parity::new(nodes.all.len());
    let of_kind = |kinds: &'static [Kind]| nodes.all.iter().enumerate().filter(|(_, node)| kinds.contains(&node.kind));
    // First, so that nothing contradicts it.
    of_kind(&[Kind::Other]).for_each(|(index, _)| parity.ask(&[index], false));
    if zeros == Zeros::OfTheirSign {
        of_kind(&[Kind::Sum]).for_each(|(index, _)| parity.ask(&[index], false));
    }
    for pair in choice.pairs(nodes).filter(|pair| nodes.all[pair.nodes[0]].kind == Kind::Sum) {
        for [left, right] in pair.operands {
            if !left.is_constant() && !right.is_constant() {
                let (mut sum, is_odd) = term(pair.nodes[0], left);
                let (other, is_other_odd) = term(pair.nodes[1], right);
                sum.extend(other);
                parity.ask(&sum, is_odd ^ is_other_odd);
            }
        }
    }
    for (index, node) in of_kind(&[Kind::Product, Kind::Quotient]) {
        let is_free = |operand: &Signed| match operand.operand {
            Operand::Number(_) => true,
            Operand::Constant(_) => choice.partner(index).is_some(),
            _ => false,
        };
        if !node.operands.iter().any(is_free) {
            let factors = node.operands.iter().filter_map(|operand| operand.node());
            parity.ask(&std::iter::once(index).chain(factors).collect::<Vec<_>>(), false);
        }
    }
    let arguments = of_kind(&[Kind::Other]).flat_map(|(_, node)| &node.operands);
    for wanted in arguments.chain(&nodes.results) {
        if let Some(node) = wanted.node() {
            parity.ask(&[node], wanted.negative);
        }
    }
    // A sum of two negatives would be one operation more: one term stands as it is.
    for (index, node) in of_kind(&[Kind::Sum]) {
        if let Some(&operand) = node.operands.iter().find(|operand| !operand.is_constant()) {
            let (sum, is_odd) = term(index, operand);
            parity.ask(&sum, is_odd);
        }
    }
    parity.solve()
}
