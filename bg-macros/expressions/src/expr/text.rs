//! Expressions as text.
//!
//! In: a node, and the texts of symbols and guards. Out: readable infix text with as few parentheses as possible.

use super::{Id, Node, Number, Pool, Symbol};

/// The text ends soon after this many characters.
const LONGEST: usize = 2000;

/// How tightly an expression holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Any,
    Sum,
    Product,
    Power,
}

/// A part of the text that is still to be written.
enum Piece {
    Text(String),
    /// A node, in parentheses if it is looser than this.
    Node(Id, Level),
}

/// One addend of a sum: a coefficient, and a node unless the addend is a number.
type Addend = (f64, Option<Id>);

/// The text of an expression. Above about 2000 characters it ends with ` ...`.
#[must_use]
pub fn text(pool: &Pool, root: Id, symbol: &dyn Fn(Symbol) -> String, switch: &dyn Fn(u32) -> String) -> String {
    let writer = Writer { pool, symbol, switch };
    let mut text = String::new();
    let mut pending = vec![Piece::Node(root, Level::Any)];
    while let Some(piece) = pending.pop() {
        match piece {
            Piece::Text(part) => text.push_str(&part),
            Piece::Node(id, level) => pending.extend(writer.pieces(id, level).into_iter().rev()),
        }
        if text.len() > LONGEST && !pending.is_empty() {
            return text + " ...";
        }
    }
    text
}

struct Writer<'a> {
    pool: &'a Pool,
    symbol: &'a dyn Fn(Symbol) -> String,
    switch: &'a dyn Fn(u32) -> String,
}

impl Writer<'_> {
    fn pieces(&self, id: Id, level: Level) -> Vec<Piece> {
        let (own, mut pieces) = match self.pool.node(id) {
            Node::Number(number) => self.sum(&[(number.value(), None)]),
            Node::Symbol(symbol) => (Level::Power, vec![Piece::Text((self.symbol)(*symbol))]),
            Node::Sum { constant, terms } => self.sum(&self.addends(constant.value(), terms)),
            Node::Product(_) => self.sum(&[(1.0, Some(id))]),
            Node::Call(function, arguments) => (Level::Power, call(function.name(), arguments)),
            Node::Select { switch, negative, positive } => (Level::Any, self.select(*switch, *negative, *positive)),
        };
        if own < level {
            pieces.insert(0, Piece::Text("(".into()));
            pieces.push(Piece::Text(")".into()));
        }
        pieces
    }

    /// The addends in the order of the text, which starts with a positive one if there is one.
    fn addends(&self, constant: f64, terms: &[(Id, Number)]) -> Vec<Addend> {
        if let ([(inner, sign)], true) = (terms, constant == 0.0) {
            return self.opposite(*inner, sign.value()).unwrap_or_else(|| vec![(sign.value(), Some(*inner))]);
        }
        let mut addends: Vec<Addend> = terms.iter().map(|(id, coefficient)| (coefficient.value(), Some(*id))).collect();
        if constant != 0.0 {
            addends.push((constant, None));
        }
        let first = addends.iter().position(|(coefficient, _)| *coefficient > 0.0).unwrap_or(0);
        addends[..=first].rotate_right(1);
        addends
    }

    /// The addends of a difference times -1, which is a difference too.
    fn opposite(&self, id: Id, sign: f64) -> Option<Vec<Addend>> {
        let Node::Sum { constant, terms } = self.pool.node(id) else { return None };
        let coefficients = || terms.iter().map(|(_, coefficient)| coefficient.value()).chain([constant.value()]);
        if sign != -1.0 || coefficients().all(|coefficient| coefficient >= 0.0) {
            return None;
        }
        let terms: Vec<_> = terms.iter().map(|(id, coefficient)| (*id, Number::new(-coefficient.value()))).collect();
        Some(self.addends(-constant.value(), &terms))
    }

    fn sum(&self, addends: &[Addend]) -> (Level, Vec<Piece>) {
        let mut pieces = Vec::new();
        let mut level = if addends.len() > 1 { Level::Sum } else { Level::Power };
        for (index, &(coefficient, id)) in addends.iter().enumerate() {
            let is_negative = coefficient < 0.0;
            let sign = match (index, is_negative) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            pieces.push(Piece::Text(sign.into()));
            let (own, addend) = self.addend(coefficient.abs(), id, is_negative);
            level = level.min(if is_negative { Level::Sum } else { own });
            pieces.extend(addend);
        }
        (level, pieces)
    }

    fn addend(&self, coefficient: f64, id: Option<Id>, is_negative: bool) -> (Level, Vec<Piece>) {
        let Some(id) = id else { return (Level::Power, vec![Piece::Text(number(coefficient))]) };
        match self.pool.node(id) {
            Node::Product(factors) => product(coefficient, factors),
            _ if coefficient != 1.0 => product(coefficient, &[(id, 1)]),
            _ => {
                let level = if is_negative { Level::Product } else { Level::Sum };
                (level, vec![Piece::Node(id, level)])
            }
        }
    }

    fn select(&self, switch: u32, negative: Id, positive: Id) -> Vec<Piece> {
        vec![
            Piece::Text(format!("if {} < 0 {{ ", (self.switch)(switch))),
            Piece::Node(negative, Level::Any),
            Piece::Text(" } else { ".into()),
            Piece::Node(positive, Level::Any),
            Piece::Text(" }".into()),
        ]
    }
}

fn call(name: &str, arguments: &[Id]) -> Vec<Piece> {
    let mut pieces = vec![Piece::Text(format!("{name}("))];
    for (index, argument) in arguments.iter().enumerate() {
        if index > 0 {
            pieces.push(Piece::Text(", ".into()));
        }
        pieces.push(Piece::Node(*argument, Level::Any));
    }
    pieces.push(Piece::Text(")".into()));
    pieces
}

/// `2*a*b^2/(c*d)`
fn product(coefficient: f64, factors: &[(Id, i32)]) -> (Level, Vec<Piece>) {
    let (above, below): (Vec<_>, Vec<_>) = factors.iter().partition(|(_, exponent)| *exponent > 0);
    let mut pieces = Vec::new();
    if coefficient != 1.0 || above.is_empty() {
        pieces.push(Piece::Text(number(coefficient)));
    }
    for factor in &above {
        separate(&mut pieces);
        power(&mut pieces, *factor);
    }
    let level =
        if coefficient == 1.0 && factors.len() == 1 && below.is_empty() { Level::Power } else { Level::Product };
    match *below {
        [] => {}
        [factor] => {
            pieces.push(Piece::Text("/".into()));
            power(&mut pieces, factor);
        }
        _ => {
            let mut denominator = Vec::new();
            for factor in &below {
                separate(&mut denominator);
                power(&mut denominator, *factor);
            }
            pieces.push(Piece::Text("/(".into()));
            pieces.extend(denominator);
            pieces.push(Piece::Text(")".into()));
        }
    }
    (level, pieces)
}

/// Writes `*` after what is there.
fn separate(pieces: &mut Vec<Piece>) {
    if !pieces.is_empty() {
        pieces.push(Piece::Text("*".into()));
    }
}

/// `a`, `a^2`; a denominator's exponent is written without its sign.
fn power(pieces: &mut Vec<Piece>, (base, exponent): (Id, i32)) {
    pieces.push(Piece::Node(base, Level::Power));
    if exponent.unsigned_abs() > 1 {
        pieces.push(Piece::Text(format!("^{}", exponent.unsigned_abs())));
    }
}

/// The shortest text that reads back as the same number; with an exponent where it is very large or small.
fn number(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-4..1e7).contains(&value.abs()) || !value.is_finite();
    if is_plain { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Function;

    fn written(pool: &Pool, id: Id) -> String {
        let symbol = |symbol| match symbol {
            Symbol::State(index) => ["a", "b", "c", "d"][index as usize].to_owned(),
            other => format!("{other:?}"),
        };
        text(pool, id, &symbol, &|switch| format!("g{switch}"))
    }

    fn letters(pool: &mut Pool) -> [Id; 4] {
        [0, 1, 2, 3].map(|index| pool.symbol(Symbol::State(index)))
    }

    #[test]
    fn sums_and_products() {
        let mut pool = Pool::new();
        let [a, b, c, d] = letters(&mut pool);
        let difference = pool.sub(a, b);
        let opposite = pool.sub(b, a);
        let one_less = pool.linear(1.0, &[(a, -1.0)]);
        let sum = pool.add(a, b);
        let products = [pool.mul(sum, c), pool.scale(-2.0, sum), pool.neg(sum), pool.sub(c, difference)];
        let ratio = pool.powers(&[(a, 1), (b, 2), (c, -1), (d, -2)]);
        let ratios = [ratio, pool.powi(sum, -1), pool.div(a, sum), pool.scale(2.5, ratio), pool.powi(a, -3)];
        let nested = pool.add(sum, c);
        let texts: Vec<_> = [difference, opposite, one_less].map(|id| written(&pool, id)).into();
        assert_eq!(texts, ["a - b", "b - a", "1 - a"]);
        assert_eq!(products.map(|id| written(&pool, id)), ["c*(a + b)", "-2*(a + b)", "-(a + b)", "c - (a - b)"]);
        assert_eq!(
            ratios.map(|id| written(&pool, id)),
            ["a*b^2/(c*d^2)", "1/(a + b)", "a/(a + b)", "2.5*a*b^2/(c*d^2)", "1/a^3"]
        );
        assert_eq!(written(&pool, nested), "c + a + b");
    }

    #[test]
    fn calls_and_selects() {
        let mut pool = Pool::new();
        let [a, b, c, _] = letters(&mut pool);
        let angle = pool.call(Function::Atan2, &[a, b]);
        let square = pool.powi(angle, 2);
        let select = pool.select(3, square, c);
        let product = pool.mul(select, a);
        let outer = pool.sub(b, select);
        assert_eq!(written(&pool, select), "if g3 < 0 { atan2(a, b)^2 } else { c }");
        assert_eq!(written(&pool, product), "a*(if g3 < 0 { atan2(a, b)^2 } else { c })");
        assert_eq!(written(&pool, outer), "b - (if g3 < 0 { atan2(a, b)^2 } else { c })");
    }

    #[test]
    fn numbers_read_back() {
        let values = [0.1, -2.5, 1e-9, 12345.678, 1e300, 0.30000000000000004, 3.0, 1e6];
        let texts = ["0.1", "-2.5", "1e-9", "12345.678", "1e300", "0.30000000000000004", "3", "1000000"];
        for (value, expected) in values.into_iter().zip(texts) {
            let mut pool = Pool::new();
            let id = pool.number(value);
            assert_eq!(written(&pool, id), expected);
            assert_eq!(expected.parse::<f64>(), Ok(value));
        }
    }

    #[test]
    fn long_texts_end() {
        let mut pool = Pool::new();
        let [a, ..] = letters(&mut pool);
        let deep = (0..50_000).fold(a, |link, index| {
            let next = pool.symbol(Symbol::Parameter(index));
            pool.add(link, next)
        });
        let long = written(&pool, deep);
        assert!(long.ends_with(" ...") && long.len() < LONGEST + 100);
    }
}
