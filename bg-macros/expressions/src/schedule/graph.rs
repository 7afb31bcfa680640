//! The expressions of one routine, each split into a static coefficient and a dynamic core.
//!
//! In: values in any form. Out: cores in normal form: sums have no common coefficient and begin with a plus, products
//! have no coefficient and no products within; equal cores are stored once.
//! Method: hash-consing (`table`); a common coefficient is divided out only where that divides by numbers alone.

use super::statics::Statics;
use super::table::Store;
use crate::expr::{Function, Id, MOST_EXPONENT, Symbol};

/// coefficient * core.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Value {
    /// A static value.
    pub(super) coefficient: Id,
    /// The index of a core.
    pub(super) core: u32,
}

/// What changes while the routine's arguments change.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Core {
    /// The number 1, the core of all static values.
    One,
    /// A symbol.
    Symbol(Symbol),
    /// A function of values.
    Call(Function, Vec<Value>),
    /// One of two values.
    Select {
        /// The switch's index.
        switch: u32,
        /// The value where the guard is negative.
        negative: Value,
        /// The value elsewhere.
        positive: Value,
    },
    /// The sum of values, sorted by core.
    Sum(Vec<Value>),
    /// The product of core^exponent, sorted by core.
    Product(Vec<(u32, i32)>),
}

/// The core of static values.
pub(super) const ONE: u32 = 0;

/// The cores of one routine.
#[derive(Debug)]
pub(super) struct Graph {
    /// The cores by index.
    pub(super) cores: Store<Core>,
}

impl Core {
    /// Calls `visit` with each core that this one is made of, in order.
    pub(super) fn children(&self, mut visit: impl FnMut(u32)) {
        match self {
            Self::One | Self::Symbol(_) => {}
            Self::Call(_, values) | Self::Sum(values) => values.iter().for_each(|value| visit(value.core)),
            Self::Select { negative, positive, .. } => {
                visit(negative.core);
                visit(positive.core);
            }
            Self::Product(factors) => factors.iter().for_each(|factor| visit(factor.0)),
        }
    }
}

impl Graph {
    /// A graph with the core of static values.
    pub(super) fn new() -> Self {
        let mut cores = Store::default();
        cores.intern(Core::One);
        Self { cores }
    }

    /// The factors of a core.
    pub(super) fn factors(&self, core: u32) -> &[(u32, i32)] {
        match &self.cores[core] {
            Core::Product(factors) => factors,
            _ => &[],
        }
    }

    /// The factors of a core as a list: none of the number 1, the core itself if it is no product.
    pub(super) fn factor_list(&self, core: u32) -> Vec<(u32, i32)> {
        match &self.cores[core] {
            Core::One => Vec::new(),
            Core::Product(factors) => factors.clone(),
            _ => vec![(core, 1)],
        }
    }

    /// The core of this product of powers, none a product.
    pub(super) fn power_product(&mut self, mut factors: Vec<(u32, i32)>) -> u32 {
        factors.sort_unstable();
        let mut merged: Vec<(u32, i32)> = Vec::with_capacity(factors.len());
        for (core, exponent) in factors {
            match merged.last_mut() {
                Some(last) if last.0 == core => last.1 += exponent,
                _ => merged.push((core, exponent)),
            }
        }
        merged.retain(|factor| factor.1 != 0);
        match merged[..] {
            [] => ONE,
            [(core, 1)] => core,
            _ => self.cores.intern(Core::Product(merged)),
        }
    }

    /// The product of powers of values.
    pub(super) fn product(&mut self, statics: &mut Statics, powers: &[(Value, i32)]) -> Value {
        let mut coefficient = statics.one;
        let mut factors = Vec::with_capacity(powers.len());
        for &(value, exponent) in powers {
            if value.coefficient != statics.one {
                let power = statics.pool.powi(value.coefficient, exponent);
                coefficient = statics.times(coefficient, power);
            }
            match &self.cores[value.core] {
                Core::One => {}
                Core::Product(inner) if has_small_powers(inner, exponent) => {
                    factors.extend(inner.iter().map(|&(core, inner)| (core, inner * exponent)));
                }
                Core::Product(_) => factors.push((self.large_power(statics, value.core, exponent), 1)),
                _ => factors.push((value.core, exponent)),
            }
        }
        Value { coefficient, core: self.power_product(factors) }
    }

    /// A product to a power as a call of `pow`.
    fn large_power(&mut self, statics: &mut Statics, core: u32, exponent: i32) -> u32 {
        let base = Value { coefficient: statics.one, core };
        let exponent = Value { coefficient: statics.pool.number(f64::from(exponent)), core: ONE };
        self.call(statics, Function::Pow, vec![base, exponent]).core
    }

    /// The sum of values.
    pub(super) fn sum(&mut self, statics: &mut Statics, terms: Vec<Value>) -> Value {
        let mut terms = merge(statics, terms);
        match terms[..] {
            [] => return Value { coefficient: statics.pool.zero(), core: ONE },
            [only] => return only,
            _ => {}
        }
        let content = content(statics, &terms);
        if content != statics.one {
            let divided =
                |term: &Value| Some(Value { coefficient: statics.exact(term.coefficient, content)?, ..*term });
            let divided: Option<Vec<Value>> = terms.iter().map(divided).collect();
            let Some(divided) = divided else {
                return Value { coefficient: statics.one, core: self.cores.intern(Core::Sum(terms)) };
            };
            terms = divided;
        }
        Value { coefficient: content, core: self.cores.intern(Core::Sum(terms)) }
    }

    /// A function's value; odd and even functions lose their argument's minus.
    pub(super) fn call(&mut self, statics: &mut Statics, function: Function, mut arguments: Vec<Value>) -> Value {
        let mut coefficient = statics.one;
        let odd = matches!(function, Function::Sin | Function::Tan | Function::Asin | Function::Tanh);
        if odd || matches!(function, Function::Cos | Function::Abs) {
            let (negative, magnitude) = statics.magnitude(arguments[0].coefficient);
            arguments[0].coefficient = magnitude;
            coefficient = statics.signed(negative && odd, coefficient);
        }
        Value { coefficient, core: self.cores.intern(Core::Call(function, arguments)) }
    }

    /// One of two values; what they have in common as coefficient goes outside.
    pub(super) fn select(&mut self, statics: &mut Statics, switch: u32, negative: Value, positive: Value) -> Value {
        let equal = negative.coefficient == positive.coefficient && negative.core != ONE && positive.core != ONE;
        let mut branches = [negative, positive];
        let mut coefficient = statics.one;
        if equal {
            coefficient = negative.coefficient;
            branches = branches.map(|branch| Value { coefficient: statics.one, ..branch });
        } else if statics.is_negative(negative.coefficient) {
            coefficient = statics.signed(true, coefficient);
            branches = branches
                .map(|branch| Value { coefficient: statics.signed(true, branch.coefficient), core: branch.core });
        }
        let [negative, positive] = branches;
        Value { coefficient, core: self.cores.intern(Core::Select { switch, negative, positive }) }
    }

    /// All cores under these values, children first, in depth-first order from the values in order.
    pub(super) fn post_order(&self, roots: &[Value]) -> Vec<u32> {
        self.cores.post_order(roots.iter().map(|root| root.core), |core, visit| core.children(visit))
    }

    /// How often each core is used by the cores under these values and by the values themselves.
    pub(super) fn uses(&self, order: &[u32], roots: &[Value]) -> Vec<u32> {
        let mut uses = vec![0; self.cores.len()];
        for root in roots {
            uses[root.core as usize] += 1;
        }
        for &core in order {
            self.cores[core].children(|child| uses[child as usize] += 1);
        }
        uses
    }
}

/// Whether this power makes no exponent of the factors large.
fn has_small_powers(factors: &[(u32, i32)], exponent: i32) -> bool {
    exponent == 1
        || factors.iter().all(|&(_, inner)| inner.checked_mul(exponent).is_some_and(|e| e.abs() <= MOST_EXPONENT))
}

/// Terms sorted by core, those of one core added up, zeros left out.
fn merge(statics: &mut Statics, mut terms: Vec<Value>) -> Vec<Value> {
    terms.sort_by_key(|term| term.core);
    let mut merged: Vec<Value> = Vec::with_capacity(terms.len());
    for term in terms {
        match merged.last_mut() {
            Some(last) if last.core == term.core => {
                last.coefficient = statics.pool.add(last.coefficient, term.coefficient);
            }
            _ => merged.push(term),
        }
    }
    merged.retain(|term| !statics.pool.is_zero(term.coefficient));
    merged
}

/// What is divided out of a sum: a coefficient that is a factor of all others, with the sign of the first dynamic term.
fn content(statics: &mut Statics, terms: &[Value]) -> Id {
    let dynamic = || terms.iter().filter(|term| term.core != ONE);
    let Some(first) = dynamic().next() else { return statics.one };
    let negative = statics.is_negative(first.coefficient);
    let sign = statics.signed(negative, statics.one);
    if dynamic().any(|term| statics.is_unit(term.coefficient)) {
        return sign;
    }
    let mut factor = first.coefficient;
    for term in terms {
        factor = statics.common(factor, term.coefficient).factor;
    }
    for term in dynamic() {
        let Some(rest) = statics.exact(term.coefficient, factor) else { continue };
        if statics.pool.as_number(rest).is_some() {
            let (_, magnitude) = statics.magnitude(term.coefficient);
            return statics.signed(negative, magnitude);
        }
    }
    sign
}
