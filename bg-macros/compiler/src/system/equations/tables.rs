//! Tables in expressions: the piece in which the argument lies, by a switch at each knot, and its polynomial.
//!
//! In: a table and its argument. Out: its value, or its integral from its first point. A step keeps to the polynomials in
//! which it begins; where the argument passes a knot, there is an event, as for every comparison.

use super::FallibleLaw;
use super::signals::Signals;
use crate::expr::{Function, Id, Pool, Symbol, partial, substitute};
use crate::graph::{Comparison, Cubic, Piece};
use crate::system::Value;

impl Signals<'_> {
    /// The value of a table; while the energy of a law is found, a symbol in its place where the law's variable is in
    /// reach.
    pub(super) fn lookup(&mut self, table: usize, argument: Id, in_law: bool) -> Id {
        if let Some(asked) = self.asked.as_mut().filter(|_| in_law) {
            asked.push((table, argument));
            return self.pool.symbol(asked_symbol(asked.len() - 1));
        }
        let value = self.in_pieces(table, argument, &|piece| piece.cubic.map(|[a, b, c, d]| [a, b, c, d, 0.0]));
        self.note_undefined(table, argument, value);
        value
    }

    /// Notes what a table gives that is not defined beyond its points, unless that is asked in a calculation about a law.
    fn note_undefined(&mut self, table: usize, argument: Id, value: Id) {
        let table = &self.graph.tables[table];
        let is_of_law = |symbol: &Symbol| matches!(symbol, Symbol::Law(_) | Symbol::Storage(_));
        let is_known = self.fallible.iter().any(|law| law.value == value);
        if !table.is_everywhere() && !is_known && !self.pool.symbols(&[argument]).iter().any(is_of_law) {
            self.fallible.push(FallibleLaw::new("table", table.name.clone(), value));
        }
    }

    /// The integral of a table over its argument, from its first point; where the table is not defined, that at its end.
    fn integral(&mut self, table: usize, argument: Id) -> Id {
        self.in_pieces(table, argument, &|piece| {
            let [a, b, c, d] = piece.cubic.unwrap_or(Cubic::default());
            Some([piece.integral, a, b / 2.0, c / 3.0, d / 4.0])
        })
    }

    /// The polynomial, with coefficients of 1, h, h^2, .. by piece, of the piece in which the argument lies.
    fn in_pieces(&mut self, table: usize, argument: Id, of: &dyn Fn(&Piece) -> Option<[f64; 5]>) -> Id {
        let table = &self.graph.tables[table];
        let pool = &mut self.pool;
        let parts: Vec<Value> = table.pieces.iter().map(|piece| coefficients(pool, piece, of(piece))).collect();
        let chosen = self.chosen(&table.name, argument, &table.knots, &parts).0;
        let pool = &mut self.pool;
        let along = pool.sub(argument, chosen[0]);
        chosen[1..].iter().rev().fold(pool.zero(), |sum, &coefficient| {
            let product = pool.mul(along, sum);
            pool.add(coefficient, product)
        })
    }

    /// The part between whose knots the argument is.
    fn chosen(&mut self, name: &str, argument: Id, knots: &[f64], parts: &[Value]) -> Value {
        if knots.is_empty() {
            return parts[0].clone();
        }
        let middle = knots.len() / 2;
        let knot = knots[middle];
        let below = self.chosen(name, argument, &knots[..middle], &parts[..=middle]);
        let above = self.chosen(name, argument, &knots[middle + 1..], &parts[middle + 1..]);
        let end = self.pool.number(knot);
        let condition = format!("argument of {name} < {knot}");
        self.choose((Comparison::Less, &condition), (argument, end), &below, &above)
    }

    /// Evaluates a law with symbols in the places of the tables that it asks. What was asked, and the law.
    pub(super) fn asking<T>(&mut self, law: impl FnOnce(&mut Self) -> T) -> (Vec<(usize, Id)>, T) {
        self.asked = Some(Vec::new());
        let law = law(self);
        (self.asked.take().unwrap_or_default(), law)
    }

    /// The integral over `own`, from 0 to `state`, of what tables add to a law that was evaluated by [`Self::asking`]; none
    /// where the law is not linear in their values or these are not of an argument that is linear in `own`.
    pub(super) fn integral_of_tables(&mut self, asked: &[(usize, Id)], law: Id, own: Symbol, state: Id) -> Option<Id> {
        let mut sum = self.pool.zero();
        for (k, &(table, argument)) in asked.iter().enumerate() {
            let factor = partial(&mut self.pool, &[law], asked_symbol(k))[0];
            let slope = partial(&mut self.pool, &[argument], own)[0];
            let is_free = |pool: &Pool, of: Id| {
                let symbols = pool.symbols(&[of]);
                !symbols.contains(&own) && !(0..asked.len()).any(|k| symbols.contains(&asked_symbol(k)))
            };
            if !is_free(&self.pool, factor) || !is_free(&self.pool, slope) {
                return None;
            }
            let integral = if self.pool.is_zero(slope) {
                let value = self.lookup(table, argument, false);
                self.pool.mul(value, state)
            } else {
                let zero = self.pool.zero();
                let [end, start] = [state, zero].map(|at| {
                    let argument = substitute(&mut self.pool, &[argument], &|symbol| (symbol == own).then_some(at))[0];
                    self.integral(table, argument)
                });
                let difference = self.pool.sub(end, start);
                self.pool.div(difference, slope)
            };
            let part = self.pool.mul(factor, integral);
            sum = self.pool.add(sum, part);
        }
        Some(sum)
    }

    /// What is left of a law that was evaluated by [`Self::asking`] without its tables.
    pub(super) fn without_tables(&mut self, asked: &[(usize, Id)], law: Id) -> Id {
        let zero = self.pool.zero();
        let is_asked = |symbol: Symbol| (0..asked.len()).any(|k| symbol == asked_symbol(k));
        substitute(&mut self.pool, &[law], &|symbol| is_asked(symbol).then_some(zero))[0]
    }
}

/// The symbol in the place of the value of a table. No law has more than three variables.
fn asked_symbol(index: usize) -> Symbol {
    Symbol::numbered(Symbol::Law, index + 3)
}

/// Origin and coefficients; where there are none, what is not a number.
fn coefficients(pool: &mut Pool, piece: &Piece, of: Option<[f64; 5]>) -> Value {
    let origin = pool.number(piece.origin);
    let numbers = match of {
        Some(numbers) => numbers.map(|number| pool.number(number)),
        None => {
            let minus = pool.number(-1.0);
            let undefined = pool.call(Function::Sqrt, &[minus]);
            let zero = pool.zero();
            [undefined, zero, zero, zero, zero]
        }
    };
    Value(std::iter::once(origin).chain(numbers).collect())
}
