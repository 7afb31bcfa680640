//! The trees of the order conditions of Runge-Kutta-Nystrom methods for q'' = f(q, q').
//!
//! In: an order; the coefficients of a method. Out: all trees up to the order; their elementary weights at the stages.
//! A tree is a force f with branches: rates q' at the start, forces that act by the positions they lead to, two orders
//! on, and forces that act by the momenta, one order on. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential
//! Equations I, 2nd edition, section II.14. The program `examples/nystrom_coefficients` reads this file too.

use super::Scalar;

/// A force with branches.
pub(super) struct Tree {
    /// The power of the step with which it acts on the momenta.
    pub order: usize,
    /// How often a force acts by the momenta.
    pub by_momenta: usize,
    /// The coefficient of the (order - 1)th power of time in the exact solution.
    pub exact: f64,
    /// The branches that are rates at the start.
    rates: usize,
    /// The other branches: trees by their index.
    branches: Vec<(usize, By)>,
}

/// How a branch is attached to its root.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum By {
    Positions,
    Momenta,
}

/// The sum of products, as far as the shorter one goes.
pub(super) fn dot<S: Scalar>(row: &[S], weight: &[S]) -> S {
    row.iter().zip(weight).fold(S::from_f64(0.0), |sum, (a, b)| sum + *a * *b)
}

/// All trees up to this order.
pub(super) fn trees(largest: usize) -> Vec<Tree> {
    let mut trees: Vec<Tree> = Vec::new();
    for order in 1..=largest {
        let mut found = Vec::new();
        collect(&trees, order - 1, (0, By::Positions), &mut Vec::new(), &mut found);
        trees.extend(found);
    }
    trees
}

/// All trees whose branches, from this one on and beside the chosen ones, have `left` orders; what the branches leave
/// are rates.
fn collect(trees: &[Tree], left: usize, from: (usize, By), chosen: &mut Vec<(usize, By)>, found: &mut Vec<Tree>) {
    found.push(tree(trees, left, chosen));
    for index in from.0..trees.len() {
        for by in [By::Positions, By::Momenta] {
            let orders = trees[index].order + usize::from(by == By::Positions);
            if (index, by) >= from && orders <= left {
                chosen.push((index, by));
                collect(trees, left - orders, (index, by), chosen, found);
                chosen.pop();
            }
        }
    }
}

fn tree(trees: &[Tree], rates: usize, branches: &[(usize, By)]) -> Tree {
    let mut made = Tree { order: 1 + rates, by_momenta: 0, exact: 1.0, rates, branches: branches.to_vec() };
    for &(index, by) in branches {
        let branch = &trees[index];
        let order = branch.order as f64;
        let (integral, orders) = match by {
            By::Positions => (order * (order + 1.0), branch.order + 1),
            By::Momenta => (order, branch.order),
        };
        made.order += orders;
        made.by_momenta += branch.by_momenta + usize::from(by == By::Momenta);
        made.exact *= branch.exact / integral;
    }
    made
}

/// The elementary weights of the trees at the stages with these instants, from the weights of their rates and second
/// derivatives.
pub(super) fn weights<S: Scalar>(
    trees: &[Tree],
    instants: &[S],
    first: &[impl AsRef<[S]>],
    second: &[impl AsRef<[S]>],
) -> Vec<Vec<S>> {
    let mut weights: Vec<Vec<S>> = Vec::new();
    for tree in trees {
        let at_stage = |(stage, c): (usize, &S)| {
            let rates = (0..tree.rates).fold(S::from_f64(1.0), |power, _| power * *c);
            tree.branches.iter().fold(rates, |product, &(index, by)| {
                let row = match by {
                    By::Positions => second[stage].as_ref(),
                    By::Momenta => first[stage].as_ref(),
                };
                product * dot(row, &weights[index])
            })
        };
        let of_tree = instants.iter().enumerate().map(at_stage).collect();
        weights.push(of_tree);
    }
    weights
}
