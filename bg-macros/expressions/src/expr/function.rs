//! Calls of functions, and switched values, in canonical form.
//!
//! In: a function and its arguments, or a switch and its branches. Out: a number, a node, a [`Node::Call`] or a
//! [`Node::Select`], or one of these times -1.
//! A function of numbers becomes a number only where that number is exact. Odd and even functions lose the sign of
//! their argument.

use super::{Function, Id, Node, Pool};

/// The largest whole exponent that makes `pow` a product.
const LARGEST_WHOLE_EXPONENT: f64 = 16.0;

impl Pool {
    /// A function of its arguments; their number is [`Function::arity`].
    pub fn call(&mut self, function: Function, arguments: &[Id]) -> Id {
        assert_eq!(arguments.len(), function.arity(), "{} arguments", function.name());
        if let Some(value) = self.exact(function, arguments) {
            return self.number(value);
        }
        if let Some(exponent) = self.whole_exponent(function, arguments) {
            return self.powi(arguments[0], exponent);
        }
        match parity(function) {
            Some(sign) if self.is_negative(arguments[0]) => {
                let argument = self.neg(arguments[0]);
                let value = self.intern(Node::Call(function, [argument].into()));
                self.scale(sign, value)
            }
            _ => self.intern(Node::Call(function, arguments.into())),
        }
    }

    /// `negative` where the switch's guard is below zero, `positive` elsewhere.
    pub fn select(&mut self, switch: u32, negative: Id, positive: Id) -> Id {
        if negative == positive { negative } else { self.intern(Node::Select { switch, negative, positive }) }
    }

    /// The square root of `x` with the sign of `x`, linear for `x` small beside `laminar`: x / (x^2 + laminar^2)^(1/4).
    /// Odd, monotone and differentiable any number of times for `laminar` above 0.
    /// Source: Modelica Standard Library, `Modelica.Fluid.Utilities.regRoot`.
    pub fn laminar_root(&mut self, x: Id, laminar: Id) -> Id {
        let squares = [self.powi(x, 2), self.powi(laminar, 2)];
        let radius = self.sum(&squares);
        let radius = self.call(Function::Sqrt, &[radius]);
        let root = self.call(Function::Sqrt, &[radius]);
        self.div(x, root)
    }

    /// The exact value, where it is the same at run time on every machine.
    fn exact(&self, function: Function, arguments: &[Id]) -> Option<f64> {
        let first = self.as_number(arguments[0])?;
        match function {
            Function::Sqrt if first >= 0.0 => Some(first.sqrt()),
            Function::Abs => Some(first.abs()),
            Function::Sin | Function::Tan | Function::Asin | Function::Tanh if first == 0.0 => Some(0.0),
            Function::Cos | Function::Exp if first == 0.0 => Some(1.0),
            Function::Ln | Function::Acos if first == 1.0 => Some(0.0),
            Function::Atan2 if first == 0.0 && self.as_number(arguments[1])? > 0.0 => Some(0.0),
            _ => None,
        }
    }

    /// The exponent of a power that is a product.
    fn whole_exponent(&self, function: Function, arguments: &[Id]) -> Option<i32> {
        let exponent = if function == Function::Pow { self.as_number(arguments[1])? } else { return None };
        let whole = exponent.fract() == 0.0 && exponent.abs() <= LARGEST_WHOLE_EXPONENT;
        #[expect(clippy::cast_possible_truncation, reason = "whole and small")]
        whole.then_some(exponent as i32)
    }

    /// Whether this is a negative number or a node times a negative number.
    fn is_negative(&self, id: Id) -> bool {
        self.as_number(id).or_else(|| self.as_scaled(id).map(|(_, scale)| scale)).is_some_and(|value| value < 0.0)
    }
}

/// -1 for an odd function, 1 for an even function.
fn parity(function: Function) -> Option<f64> {
    match function {
        Function::Sin | Function::Tan | Function::Asin | Function::Tanh => Some(-1.0),
        Function::Cos | Function::Abs => Some(1.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Symbol, evaluate, gradient};

    #[test]
    fn exact_values_fold() {
        let mut pool = Pool::new();
        let cases = [
            (Function::Sqrt, 2.25, 1.5),
            (Function::Sin, 0.0, 0.0),
            (Function::Cos, 0.0, 1.0),
            (Function::Tan, 0.0, 0.0),
            (Function::Asin, 0.0, 0.0),
            (Function::Acos, 1.0, 0.0),
            (Function::Exp, 0.0, 1.0),
            (Function::Ln, 1.0, 0.0),
            (Function::Tanh, 0.0, 0.0),
            (Function::Abs, -3.5, 3.5),
        ];
        for (function, argument, value) in cases {
            let argument = pool.number(argument);
            assert_eq!(pool.call(function, &[argument]), pool.number(value), "{}", function.name());
        }
        let (zero, two, minus) = (pool.zero(), pool.number(2.0), pool.number(-2.0));
        assert_eq!(pool.call(Function::Atan2, &[zero, two]), zero);
        for (function, arguments) in [(Function::Atan2, vec![zero, minus]), (Function::Sqrt, vec![minus])] {
            let call = pool.call(function, &arguments);
            assert_eq!(*pool.node(call), Node::Call(function, arguments.into()));
        }
    }

    #[test]
    fn other_values_wait_for_run_time() {
        let mut pool = Pool::new();
        let two = pool.number(2.0);
        for function in [Function::Sin, Function::Exp, Function::Ln, Function::Tanh, Function::Acos] {
            let call = pool.call(function, &[two]);
            assert_eq!(*pool.node(call), Node::Call(function, [two].into()));
        }
    }

    #[test]
    fn parity_of_functions() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        let three = pool.number(3.0);
        let double = pool.scale(2.0, x);
        let difference = pool.sub(x, y);
        for argument in [x, double, difference, three] {
            let opposite = pool.neg(argument);
            for function in [Function::Sin, Function::Tan, Function::Asin, Function::Tanh] {
                let (plus, minus) = (pool.call(function, &[argument]), pool.call(function, &[opposite]));
                assert_eq!(minus, pool.neg(plus), "{}", function.name());
            }
            for function in [Function::Cos, Function::Abs] {
                let (plus, minus) = (pool.call(function, &[argument]), pool.call(function, &[opposite]));
                assert_eq!(minus, plus, "{}", function.name());
            }
        }
        let minus = pool.neg(x);
        let (plus, minus) = (pool.call(Function::Exp, &[x]), pool.call(Function::Exp, &[minus]));
        assert_ne!(plus, minus);
    }

    #[test]
    fn whole_powers_are_products() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        for exponent in [-16, -1, 0, 1, 2, 16] {
            let number = pool.number(f64::from(exponent));
            assert_eq!(pool.call(Function::Pow, &[x, number]), pool.powi(x, exponent));
        }
        for exponent in [0.5, 17.0, -2.5] {
            let number = pool.number(exponent);
            let power = pool.call(Function::Pow, &[x, number]);
            assert_eq!(*pool.node(power), Node::Call(Function::Pow, [x, number].into()));
        }
    }

    #[test]
    fn a_root_with_a_laminar_range_is_odd_monotone_and_smooth() {
        let mut pool = Pool::new();
        let (x, laminar) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        let root = pool.laminar_root(x, laminar);
        let opposite = pool.neg(x);
        let back = pool.laminar_root(opposite, laminar);
        assert_eq!(back, pool.neg(root));
        let slope = gradient(&mut pool, root, &[Symbol::State(0)])[0];
        let second = gradient(&mut pool, slope, &[Symbol::State(0)])[0];
        let at = |x: f64| {
            evaluate(&pool, &[root, slope, second], &Environment { states: &[x, 4.0], ..Environment::default() })
        };
        // Linear at zero, with the slope 1 / sqrt(laminar); the root far from it, to laminar^2 / (4 x^2).
        assert_eq!(at(0.0), [0.0, 0.5, 0.0]);
        let far = at(4e4)[0] / 200.0 - 1.0;
        assert!((far + 0.25e-8).abs() < 1e-12, "{far}");
        assert!((-400..=400).all(|k| at(0.1 * f64::from(k))[1] > 0.0));
    }

    #[test]
    fn equal_branches_are_one() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        assert_eq!(pool.select(0, x, x), x);
        let select = pool.select(4, x, y);
        assert_eq!(*pool.node(select), Node::Select { switch: 4, negative: x, positive: y });
    }
}
