//! Values of expressions.
//!
//! In: nodes and the values of their symbols and switches. Out: the nodes' values.

use super::{Function, Id, Node, Pool, Symbol};

/// The values of symbols and switches, by their indices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Environment<'a> {
    /// Time.
    pub time: f64,
    /// States.
    pub states: &'a [f64],
    /// Parameters.
    pub parameters: &'a [f64],
    /// Inputs.
    pub inputs: &'a [f64],
    /// Start values that the assembly solves for.
    pub unknowns: &'a [f64],
    /// A storage's own state, by its components.
    pub storage: &'a [f64],
    /// Derivatives of the inputs with respect to time.
    pub slopes: &'a [f64],
    /// Rates of the states.
    pub rates: &'a [f64],
    /// What iterations have found.
    pub found: &'a [f64],
    /// Weights of results.
    pub weights: &'a [f64],
    /// On which side of zero each root is by which a loop is closed; 1 for those that are not here.
    pub sides: &'a [f64],
    /// Whether each switch's guard is below zero.
    pub negative: &'a [bool],
}

impl Environment<'_> {
    fn value(&self, symbol: Symbol) -> f64 {
        match symbol {
            Symbol::Time => self.time,
            Symbol::State(index) => self.states[index as usize],
            Symbol::Parameter(index) => self.parameters[index as usize],
            Symbol::Input(index) => self.inputs[index as usize],
            Symbol::Unknown(index) => self.unknowns[index as usize],
            Symbol::Storage(index) => self.storage[index as usize],
            Symbol::Slope(index) => self.slopes[index as usize],
            Symbol::Rate(index) => self.rates[index as usize],
            Symbol::Found(index) => self.found[index as usize],
            Symbol::Weight(index) => self.weights[index as usize],
            Symbol::Kept(_) | Symbol::Turned(_) => 1.0,
            Symbol::Side(index) => self.sides.get(index as usize).copied().unwrap_or(1.0),
            Symbol::Law(_) | Symbol::Flow(_) | Symbol::Multiplier(_) | Symbol::Unsolved(_) => {
                panic!("no value of {symbol:?}")
            }
        }
    }
}

/// The values of the roots. Panics where the environment lacks a symbol or switch that they contain.
#[must_use]
pub fn evaluate(pool: &Pool, roots: &[Id], environment: &Environment) -> Vec<f64> {
    let nodes = pool.reachable(roots);
    let mut values = vec![f64::NAN; nodes.last().map_or(0, |last| last.0 as usize + 1)];
    for id in nodes {
        values[id.0 as usize] = value(pool.node(id), environment, &|child| values[child.0 as usize]);
    }
    roots.iter().map(|root| values[root.0 as usize]).collect()
}

/// The function's value for these arguments. Panics where their number is not [`Function::arity`].
#[must_use]
pub fn apply(function: Function, arguments: &[f64]) -> f64 {
    assert_eq!(arguments.len(), function.arity(), "{} arguments", function.name());
    let x = arguments[0];
    match function {
        Function::Sqrt => x.sqrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan2 => x.atan2(arguments[1]),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Tanh => x.tanh(),
        Function::Abs => x.abs(),
        Function::Pow => x.powf(arguments[1]),
    }
}

fn value(node: &Node, environment: &Environment, of: &dyn Fn(Id) -> f64) -> f64 {
    match node {
        Node::Number(number) => number.value(),
        Node::Symbol(symbol) => environment.value(*symbol),
        Node::Sum { constant, terms } => {
            terms.iter().fold(constant.value(), |sum, (id, coefficient)| sum + coefficient.value() * of(*id))
        }
        Node::Product(factors) => {
            let power = |product, (id, exponent): &(Id, i32)| product * of(*id).powi(exponent.saturating_abs());
            let numerator = factors.iter().filter(|(_, exponent)| *exponent > 0).fold(1.0, power);
            numerator / factors.iter().filter(|(_, exponent)| *exponent < 0).fold(1.0, power)
        }
        Node::Call(function, arguments) => {
            let arguments: Vec<_> = arguments.iter().map(|id| of(*id)).collect();
            apply(*function, &arguments)
        }
        Node::Select { switch, negative, positive } => {
            of(if environment.negative[*switch as usize] { *negative } else { *positive })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_node() {
        let mut pool = Pool::new();
        let symbols = [
            Symbol::Time,
            Symbol::State(0),
            Symbol::Parameter(0),
            Symbol::Input(0),
            Symbol::Unknown(0),
            Symbol::Storage(0),
            Symbol::Slope(0),
        ];
        let [t, x, p, u, k, a, s] = symbols.map(|symbol| pool.symbol(symbol));
        let sum = pool.linear(1.0, &[(t, 2.0), (x, -3.0)]);
        let powers = pool.powi(u, -2);
        let product = pool.mul(p, powers);
        let angle = pool.call(Function::Atan2, &[k, a]);
        let select = pool.select(1, sum, product);
        let environment = Environment {
            time: 5.0,
            states: &[2.0],
            parameters: &[8.0],
            inputs: &[4.0],
            unknowns: &[1.0],
            storage: &[1.0],
            slopes: &[-7.0],
            rates: &[11.0],
            negative: &[false, true],
            ..Environment::default()
        };
        assert_eq!(
            evaluate(&pool, &[sum, product, angle, select, s], &environment),
            [5.0, 0.5, std::f64::consts::FRAC_PI_4, 5.0, -7.0]
        );
        let positive = Environment { negative: &[true, false], ..environment };
        assert_eq!(evaluate(&pool, &[select], &positive), [0.5]);
        assert!(evaluate(&pool, &[], &environment).is_empty());
    }

    #[test]
    fn functions_are_those_of_the_standard_library() {
        assert_eq!(apply(Function::Pow, &[2.0, 0.5]), 2.0_f64.powf(0.5));
        assert_eq!(apply(Function::Atan2, &[-1.0, -2.0]), (-1.0_f64).atan2(-2.0));
        assert_eq!(apply(Function::Ln, &[3.0]), 3.0_f64.ln());
    }
}
