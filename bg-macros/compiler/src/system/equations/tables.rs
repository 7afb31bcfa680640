//! Tables in expressions: the piece in which the argument lies, by a switch at each knot, and its polynomial.
//!
//! In: a table and its argument. Out: its value, or its integral from its first point. A step keeps to the polynomials
//! in which it begins; where the argument passes a knot, there is an event, as for every comparison.

use super::FallibleLaw;
use super::signals::Signals;
use crate::expr::{Function, Id, Pool, Symbol, partial, substitute};
use crate::graph::{Comparison, Cubic, Lookup, Period, Piece, Surface, Table};
use crate::system::Value;

impl Signals<'_> {
    /// The value of a table or a derivative; while the energy of a law is found, a symbol in its place where the law's
    /// variable is in reach.
    pub(super) fn lookup(&mut self, lookup: Lookup, arguments: &[Id], in_law: bool) -> Id {
        if let Some(asked) = self.asked.as_mut().filter(|_| in_law) {
            asked.push((lookup, arguments.to_vec()));
            return self.pool.symbol(asked_symbol(asked.len() - 1));
        }
        let value = match arguments {
            &[first, second] => self.in_patches(lookup.table, [first, second]),
            _ => {
                let of_piece = |piece: &Piece| piece.cubic.map(|[a, b, c, d]| [a, b, c, d, 0.0]);
                let (coefficients, along) = self.in_pieces(lookup.table, arguments[0], &of_piece);
                self.polynomial(&coefficients, lookup.order, along)
            }
        };
        self.note_undefined(lookup.table, arguments, value);
        value
    }

    /// The value of a table of two arguments: the column of patches in which the first one lies, the patch in it.
    fn in_patches(&mut self, table: usize, arguments: [Id; 2]) -> Id {
        let graph = self.graph;
        let table = &graph.tables[table];
        let Some(Surface { knots, origins, patches }) = &table.surface else { return self.pool.zero() };
        let pool = &mut self.pool;
        let undefined = undefined(pool);
        let columns = origins[0].iter().zip(patches).map(|(&origin, column)| {
            let patches = column.iter().flat_map(|patch| match patch {
                Some(patch) => patch.as_flattened().iter().map(|&number| pool.number(number)).collect(),
                None => vec![undefined; 16],
            });
            let patches: Vec<Id> = patches.collect();
            Value(std::iter::once(pool.number(origin)).chain(patches).collect())
        });
        let columns: Vec<Value> = columns.collect();
        let column = self.chosen(&table.name, Stretch::Line(arguments[0]), &knots[0], &columns).0;
        let cells = origins[1].iter().zip(column[1..].chunks_exact(16));
        let cells: Vec<Value> = cells
            .map(|(&origin, patch)| {
                Value(std::iter::once(self.pool.number(origin)).chain(patch.iter().copied()).collect())
            })
            .collect();
        let cell = self.chosen(&table.name, Stretch::Line(arguments[1]), &knots[1], &cells).0;
        let along = [(arguments[0], column[0]), (arguments[1], cell[0])].map(|(of, origin)| self.pool.sub(of, origin));
        let powers: Vec<Id> = cell[1..].chunks_exact(4).map(|row| self.polynomial(row, 0, along[1])).collect();
        self.polynomial(&powers, 0, along[0])
    }

    /// Notes what a table gives that is not defined beyond its points, unless that is asked in a calculation about a
    /// law.
    fn note_undefined(&mut self, table: usize, arguments: &[Id], value: Id) {
        let table = &self.graph.tables[table];
        let is_of_law = |symbol: &Symbol| matches!(symbol, Symbol::Law(_) | Symbol::Storage(_));
        let is_known = self.fallible.iter().any(|law| law.value == value);
        if !table.is_everywhere() && !is_known && !self.pool.symbols(arguments).iter().any(is_of_law) {
            self.fallible.push(FallibleLaw::new("table", table.name.clone(), value));
        }
    }

    /// The integral of what is asked of a table over its argument, from its first point; where the table is not
    /// defined, that at its end.
    fn integral(&mut self, Lookup { table, order }: Lookup, argument: Id) -> Id {
        if order > 0 {
            return self.lookup(Lookup { table, order: order - 1 }, &[argument], false);
        }
        let period = self.graph.tables[table].period;
        let (coefficients, along) = self.in_pieces(table, argument, &|piece| {
            let [a, b, c, d] = piece.cubic.unwrap_or(Cubic::default());
            Some([piece.integral, a, b / 2.0, c / 3.0, d / 4.0])
        });
        let sum = self.polynomial(&coefficients, 0, along);
        let Some(Period { mean, .. }) = period else { return sum };
        // The mean over what the argument is beyond the piece's origin, which may be whole periods.
        let pool = &mut self.pool;
        pool.linear(0.0, &[(sum, 1.0), (argument, mean), (along, -mean)])
    }

    /// A derivative, of this order, of a polynomial of h with coefficients of 1, h, h^2, ..
    fn polynomial(&mut self, coefficients: &[Id], order: usize, h: Id) -> Id {
        let pool = &mut self.pool;
        let terms = coefficients.iter().enumerate().skip(order).rev();
        terms.fold(pool.zero(), |sum, (power, &coefficient)| {
            // What differentiation makes of a power: its exponent, times the next lower one, ..
            let factor: f64 = (0..order).map(|k| (power - k) as f64).product();
            let (product, own) = (pool.mul(h, sum), pool.scale(factor, coefficient));
            pool.add(own, product)
        })
    }

    /// The coefficients of 1, h, h^2, .. of the piece in which the argument lies, and h.
    fn in_pieces(&mut self, table: usize, argument: Id, of: &dyn Fn(&Piece) -> Option<[f64; 5]>) -> (Vec<Id>, Id) {
        let table = &self.graph.tables[table];
        let pool = &mut self.pool;
        let parts: Vec<Value> = table.pieces.iter().map(|piece| coefficients(pool, piece, of(piece))).collect();
        let (chosen, along) = match table.period {
            None => {
                let chosen = self.chosen(&table.name, Stretch::Line(argument), &table.knots, &parts).0;
                let along = self.pool.sub(argument, chosen[0]);
                (chosen, along)
            }
            Some(period) => self.in_period(table, period, argument, &parts),
        };
        (chosen[1..].to_vec(), along)
    }

    /// The part of a table that repeats itself in which the argument lies, with how far it lies from the part's origin.
    /// By sines of the argument's distances from knots and origin, which tell nothing of the number of turns; an arc
    /// tangent is that distance to half a period, beyond which no part goes.
    fn in_period(&mut self, table: &Table, period: Period, argument: Id, parts: &[Value]) -> (Vec<Id>, Id) {
        let turn = std::f64::consts::TAU / period.length;
        let angle = self.pool.scale(turn, argument);
        let place = Stretch::Turn([Function::Sin, Function::Cos].map(|of| self.pool.call(of, &[angle])), turn);
        let (first, second) = table.knots.split_at(period.half);
        let (early, late) = parts.split_at(period.half);
        let early = self.chosen(&table.name, place, &first[1..], early);
        let late = self.chosen(&table.name, place, &second[1..], late);
        let chosen = self.before(&table.name, place, second[0], &early, &late).0;
        let distance = self.pool.sub(argument, chosen[0]);
        let distance = self.pool.scale(turn, distance);
        let [sine, cosine] = [Function::Sin, Function::Cos].map(|of| self.pool.call(of, &[distance]));
        let along = self.pool.call(Function::Atan2, &[sine, cosine]);
        (chosen, self.pool.scale(1.0 / turn, along))
    }

    /// One of two parts, by whether the argument is before a knot; in a turn, less than half a turn before it.
    fn before(&mut self, name: &str, place: Stretch, knot: f64, below: &Value, above: &Value) -> Value {
        let condition = format!("argument of {name} < {knot}");
        let sides = match place {
            Stretch::Line(argument) => (argument, self.pool.number(knot)),
            Stretch::Turn([sine, cosine], turn) => {
                let (by_sine, by_cosine) = (turn * knot).sin_cos();
                let distance = self.pool.linear(0.0, &[(sine, by_cosine), (cosine, -by_sine)]);
                (distance, self.pool.zero())
            }
        };
        self.choose((Comparison::Less, &condition), sides, below, above)
    }

    /// The part between whose knots the argument is.
    fn chosen(&mut self, name: &str, place: Stretch, knots: &[f64], parts: &[Value]) -> Value {
        if knots.is_empty() {
            return parts[0].clone();
        }
        let middle = knots.len() / 2;
        let below = self.chosen(name, place, &knots[..middle], &parts[..=middle]);
        let above = self.chosen(name, place, &knots[middle + 1..], &parts[middle + 1..]);
        self.before(name, place, knots[middle], &below, &above)
    }

    /// Evaluates a law with symbols in the places of the tables that it asks. What was asked, and the law.
    pub(super) fn asking<T>(&mut self, law: impl FnOnce(&mut Self) -> T) -> (Vec<(Lookup, Vec<Id>)>, T) {
        self.asked = Some(Vec::new());
        let law = law(self);
        (self.asked.take().unwrap_or_default(), law)
    }

    /// The integral over `own`, from 0 to `state`, of what tables add to a law that was evaluated by [`Self::asking`];
    /// none where the law is not linear in their values or these are not of an argument that is linear in `own`.
    pub(super) fn integral_of_tables(
        &mut self,
        asked: &[(Lookup, Vec<Id>)],
        law: Id,
        own: Symbol,
        state: Id,
    ) -> Option<Id> {
        let mut sum = self.pool.zero();
        for (k, (lookup, arguments)) in asked.iter().enumerate() {
            let lookup = *lookup;
            let factor = partial(&mut self.pool, &[law], asked_symbol(k))[0];
            let slopes = partial(&mut self.pool, arguments, own);
            let is_constant = slopes.iter().all(|&slope| self.pool.is_zero(slope));
            let slope = slopes[0];
            let is_free = |pool: &Pool, of: Id| {
                let symbols = pool.symbols(&[of]);
                !symbols.contains(&own) && !(0..asked.len()).any(|k| symbols.contains(&asked_symbol(k)))
            };
            if !is_free(&self.pool, factor) || !is_free(&self.pool, slope) {
                return None;
            }
            let integral = if is_constant {
                let value = self.lookup(lookup, arguments, false);
                self.pool.mul(value, state)
            } else if arguments.len() > 1 {
                return None;
            } else {
                let zero = self.pool.zero();
                let [end, start] = [state, zero].map(|at| {
                    let argument = substitute(&mut self.pool, arguments, &|symbol| (symbol == own).then_some(at))[0];
                    self.integral(lookup, argument)
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
    pub(super) fn without_tables(&mut self, asked: &[(Lookup, Vec<Id>)], law: Id) -> Id {
        let zero = self.pool.zero();
        let is_asked = |symbol: Symbol| (0..asked.len()).any(|k| symbol == asked_symbol(k));
        substitute(&mut self.pool, &[law], &|symbol| is_asked(symbol).then_some(zero))[0]
    }
}

/// Where the argument of a table is.
#[derive(Clone, Copy)]
enum Stretch {
    /// On a line.
    Line(Id),
    /// In a turn: sine and cosine of an angle, and that angle over the argument.
    Turn([Id; 2], f64),
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
            let zero = pool.zero();
            [undefined(pool), zero, zero, zero, zero]
        }
    };
    Value(std::iter::once(origin).chain(numbers).collect())
}

/// What is not a number.
fn undefined(pool: &mut Pool) -> Id {
    let minus = pool.number(-1.0);
    pool.call(Function::Sqrt, &[minus])
}
