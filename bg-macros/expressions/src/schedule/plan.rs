//! The operations of a routine with any number of operands, coefficients being operands, too.
//!
//! In: a [`Graph`]. Out: cells of sums, products, functions and choices; children have smaller indices than parents,
//! until products are shared.
//! Method: one sweep; a coefficient in front of a sum that is used once and multiplies each of its terms goes into
//! them.

use super::graph::{Core, Graph, ONE, Value};
use super::rebuild::has_unit;
use super::statics::Statics;
use super::table::Store;
use crate::expr::{Function, Id, Symbol};

/// A cell, negated or not.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Signed {
    /// Whether it is negated.
    pub(super) negative: bool,
    /// The index of the cell.
    pub(super) cell: u32,
}

/// One value of a routine.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Cell {
    /// A value known before, other than a negative one.
    Static(Id),
    /// A symbol.
    Symbol(Symbol),
    /// The sum of two cells or more.
    Sum(Vec<Signed>),
    /// The product of cell^exponent; of a single cell it is that cell.
    Product(Vec<(u32, i32)>),
    /// A function.
    Call(Function, Vec<Signed>),
    /// One of two cells.
    Select {
        /// The switch's index.
        switch: u32,
        /// The value where the guard is negative.
        negative: Signed,
        /// The value elsewhere.
        positive: Signed,
    },
}

/// The cells of a routine and its results.
#[derive(Debug)]
pub(super) struct Plan {
    /// The cells by index.
    pub(super) cells: Store<Cell>,
    /// The results.
    pub(super) roots: Vec<Signed>,
}

impl Cell {
    /// Calls `visit` with each operand, in order.
    pub(super) fn operands(&self, mut visit: impl FnMut(Signed)) {
        match self {
            Self::Static(_) | Self::Symbol(_) => {}
            Self::Sum(operands) | Self::Call(_, operands) => operands.iter().for_each(|&operand| visit(operand)),
            Self::Product(factors) => factors.iter().for_each(|&(cell, _)| visit(Signed { negative: false, cell })),
            Self::Select { negative, positive, .. } => {
                visit(*negative);
                visit(*positive);
            }
        }
    }

    /// The number of operations of this cell, a division counting as `division`.
    fn cost(&self, division: usize) -> usize {
        match self {
            Self::Static(_) | Self::Symbol(_) => 0,
            Self::Call(..) | Self::Select { .. } => 1,
            Self::Sum(operands) => operands.len() - 1,
            Self::Product(factors) => {
                let length = |sign: i32| -> usize {
                    factors.iter().map(|factor| usize::try_from(factor.1 * sign).unwrap_or(0)).sum()
                };
                let (above, below) = (length(1), length(-1));
                above.saturating_sub(1) + below.saturating_sub(1) + if below > 0 { division } else { 0 }
            }
        }
    }
}

impl Plan {
    /// The plan of a graph's roots.
    pub(super) fn new(statics: &mut Statics, graph: &Graph, roots: &[Value]) -> Self {
        let order = graph.post_order(roots);
        let plan = Self { cells: Store::default(), roots: Vec::new() };
        let uses = graph.uses(&order, roots);
        let mut sweep = Sweep { graph, uses, plan, cells: vec![0; graph.cores.len()], statics };
        for core in order {
            sweep.enter(core);
        }
        let roots = roots.iter().map(|&root| sweep.operand(root)).collect();
        Self { roots, ..sweep.plan }
    }

    /// The cells under the roots, operands first, in depth-first order.
    pub(super) fn post_order(&self) -> Vec<u32> {
        let roots = self.roots.iter().map(|root| root.cell);
        self.cells.post_order(roots, |cell, visit| cell.operands(|operand| visit(operand.cell)))
    }

    /// The plan's cost, in multiplications.
    pub(super) fn cost(&self) -> usize {
        // A division occupies the unit four to five times as long as a multiplication (Agner Fog, instruction tables,
        // divsd against mulsd, Skylake to Zen 4).
        const DIVISION: usize = 4;
        self.post_order().into_iter().map(|cell| self.cells[cell].cost(DIVISION)).sum()
    }
}

struct Sweep<'g, 's, 'p> {
    graph: &'g Graph,
    statics: &'s mut Statics<'p>,
    uses: Vec<u32>,
    plan: Plan,
    cells: Vec<u32>,
}

impl Sweep<'_, '_, '_> {
    fn enter(&mut self, core: u32) {
        let graph = self.graph;
        let cell = match &graph.cores[core] {
            // These become cells where they are used, as they may merge with a coefficient there.
            Core::One | Core::Product(_) => return,
            Core::Symbol(symbol) => Cell::Symbol(*symbol),
            Core::Call(function, arguments) => {
                Cell::Call(*function, arguments.iter().map(|&argument| self.operand(argument)).collect())
            }
            Core::Select { switch, negative, positive } => {
                let (negative, positive) = (self.operand(*negative), self.operand(*positive));
                Cell::Select { switch: *switch, negative, positive }
            }
            Core::Sum(terms) => Cell::Sum(terms.iter().map(|&term| self.operand(term)).collect()),
        };
        self.cells[core as usize] = self.plan.cells.intern(cell);
    }

    fn operand(&mut self, value: Value) -> Signed {
        let (negative, magnitude) = self.statics.magnitude(value.coefficient);
        Signed { negative, cell: self.scaled(magnitude, value.core) }
    }

    /// The cell of `magnitude * core`.
    fn scaled(&mut self, magnitude: Id, core: u32) -> u32 {
        if core == ONE {
            return self.plan.cells.intern(Cell::Static(magnitude));
        }
        let mut factors = self.graph.factor_list(core);
        if magnitude == self.statics.one
            && let [(only, 1)] = factors[..]
        {
            return self.cells[only as usize];
        }
        for factor in &mut factors {
            factor.0 = self.cells[factor.0 as usize];
        }
        if magnitude != self.statics.one {
            match self.absorbed(magnitude, core) {
                Some((sum, cell)) if self.graph.factors(core).is_empty() => {
                    debug_assert_eq!(sum, core);
                    return cell;
                }
                Some((sum, cell)) => {
                    let old = self.cells[sum as usize];
                    factors.retain(|factor| factor.0 != old);
                    factors.push((cell, 1));
                }
                None => factors.push((self.plan.cells.intern(Cell::Static(magnitude)), 1)),
            }
        }
        factors.sort_unstable();
        self.plan.cells.intern(Cell::Product(factors))
    }

    /// A factor of the core that is a sum, and the cell of the magnitude times that sum, where this needs no
    /// multiplication.
    fn absorbed(&mut self, magnitude: Id, core: u32) -> Option<(u32, u32)> {
        let graph = self.graph;
        if self.uses[core as usize] != 1 {
            return None;
        }
        for (sum, exponent) in graph.factor_list(core) {
            let Core::Sum(terms) = &graph.cores[sum] else { continue };
            if exponent == 1 && self.uses[sum as usize] == 1 && !has_unit(self.statics, terms) {
                let mut operands = Vec::with_capacity(terms.len());
                for &Value { coefficient, core } in terms {
                    let coefficient = self.statics.times(magnitude, coefficient);
                    operands.push(self.operand(Value { coefficient, core }));
                }
                return Some((sum, self.plan.cells.intern(Cell::Sum(operands))));
            }
        }
        None
    }
}
