//! Units of criteria: what a value is in coherent SI, and in which unit it is shown.

use bg_units::Unit;

/// A unit with the text in which it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The unit.
    pub unit: Unit,
    /// Its text.
    pub text: String,
}

impl Shown {
    /// A number without a unit.
    pub fn number() -> Self {
        Self { unit: Unit::ONE, text: String::new() }
    }

    /// The unit of this text; none of a text that is none.
    pub fn of(text: &str) -> Option<Self> {
        Some(Self { unit: text.parse().ok()?, text: text.to_owned() })
    }

    /// Whether it is that of a plain number or an angle.
    pub fn is_number(&self) -> bool {
        self.unit.dimension == Unit::ONE.dimension
    }

    /// The coherent unit of a product.
    pub fn times(&self, other: &Self) -> Self {
        Self::joined(self.unit.times(other.unit), &self.text, '*', &other.text)
    }

    /// That of a quotient.
    pub fn over(&self, other: &Self) -> Self {
        Self::joined(self.unit.times(other.unit.power(-1)), &self.text, '/', &other.text)
    }

    /// That of a whole power.
    pub fn power(&self, exponent: i32) -> Self {
        Self::coherent(self.unit.power(exponent))
    }

    /// That of the square root; none where there is none.
    pub fn root(&self) -> Option<Self> {
        let root = self.unit.dimension.root()?;
        Some(Self::coherent(Unit::coherent(root)))
    }

    /// The coherent SI unit of the same dimension.
    fn coherent(unit: Unit) -> Self {
        let text = unit.dimension.to_string();
        Self { unit: Unit::coherent(unit.dimension), text: if text == "1" { String::new() } else { text } }
    }

    /// A product or a quotient of texts, where one of them is simple; else the coherent unit.
    fn joined(unit: Unit, a: &str, sign: char, b: &str) -> Self {
        let text = match (a, b) {
            (a, "") => a.to_owned(),
            ("", b) if sign == '*' => b.to_owned(),
            (a, b) if a == b && sign == '/' => String::new(),
            (a, b) if !b.contains(['*', '/']) => format!("{}{sign}{b}", if a.is_empty() { "1" } else { a }),
            _ => return Self::coherent(unit),
        };
        if text.parse() == Ok(unit) { Self { unit, text } } else { Self::coherent(unit) }
    }
}
