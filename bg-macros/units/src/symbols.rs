//! The symbols: coherent SI units, units beside them that engineers use, and prefixes.

use crate::{Dimension, Unit};

/// The symbols of the SI base units, in the order of the exponents.
pub(crate) const BASES: [&str; Dimension::BASES] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// A symbol: base exponents, power of the radian, and size as two numbers.
struct Entry {
    symbol: &'static str,
    bases: [i16; Dimension::BASES],
    angle: i32,
    size: (f64, f64),
    /// Whether prefixes may stand before it.
    prefixes: bool,
}

const fn coherent(symbol: &'static str, bases: [i16; Dimension::BASES]) -> Entry {
    Entry { symbol, bases, angle: 0, size: (1.0, 1.0), prefixes: true }
}

const fn other(symbol: &'static str, bases: [i16; Dimension::BASES], numerator: f64, denominator: f64) -> Entry {
    Entry { symbol, bases, angle: 0, size: (numerator, denominator), prefixes: false }
}

const fn prefixed(entry: Entry) -> Entry {
    Entry { prefixes: true, ..entry }
}

const fn angular(entry: Entry) -> Entry {
    Entry { angle: 1, ..entry }
}

const PURE: [i16; Dimension::BASES] = [0; Dimension::BASES];
const MASS: [i16; Dimension::BASES] = [1, 0, 0, 0, 0, 0, 0];
const LENGTH: [i16; Dimension::BASES] = [0, 1, 0, 0, 0, 0, 0];
const TIME: [i16; Dimension::BASES] = [0, 0, 1, 0, 0, 0, 0];
const RATE: [i16; Dimension::BASES] = [0, 0, -1, 0, 0, 0, 0];
const FORCE: [i16; Dimension::BASES] = [1, 1, -2, 0, 0, 0, 0];
const PRESSURE: [i16; Dimension::BASES] = [1, -1, -2, 0, 0, 0, 0];
const ENERGY: [i16; Dimension::BASES] = [1, 2, -2, 0, 0, 0, 0];
const POWER: [i16; Dimension::BASES] = [1, 2, -3, 0, 0, 0, 0];
const VOLUME: [i16; Dimension::BASES] = [0, 3, 0, 0, 0, 0, 0];

/// The international foot, m, as two numbers; the pound, kg; the pound-force, N.
const FOOT: (f64, f64) = (3048.0, 10_000.0);
const POUND: f64 = 0.453_592_37;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// All symbols without a prefix; the first match is used. `kg` takes no prefix, `g` does.
const ENTRIES: [Entry; 47] = [
    other("kg", MASS, 1.0, 1.0),
    coherent("m", LENGTH),
    coherent("s", TIME),
    coherent("A", [0, 0, 0, 1, 0, 0, 0]),
    coherent("K", [0, 0, 0, 0, 1, 0, 0]),
    coherent("mol", [0, 0, 0, 0, 0, 1, 0]),
    coherent("cd", [0, 0, 0, 0, 0, 0, 1]),
    angular(coherent("rad", PURE)),
    coherent("Hz", RATE),
    coherent("N", FORCE),
    coherent("Pa", PRESSURE),
    coherent("J", ENERGY),
    coherent("W", POWER),
    coherent("C", [0, 0, 1, 1, 0, 0, 0]),
    coherent("V", [1, 2, -3, -1, 0, 0, 0]),
    coherent("F", [-1, -2, 4, 2, 0, 0, 0]),
    coherent("Ohm", [1, 2, -3, -2, 0, 0, 0]),
    coherent("S", [-1, -2, 3, 2, 0, 0, 0]),
    coherent("Wb", [1, 2, -2, -1, 0, 0, 0]),
    coherent("T", [1, 0, -2, -1, 0, 0, 0]),
    coherent("H", [1, 2, -2, -2, 0, 0, 0]),
    coherent("sr", PURE),
    coherent("lm", [0, 0, 0, 0, 0, 0, 1]),
    coherent("kat", [0, 0, -1, 0, 0, 1, 0]),
    prefixed(other("g", MASS, 1.0, 1e3)),
    other("tonne", MASS, 1e3, 1.0),
    other("min", TIME, 60.0, 1.0),
    other("h", TIME, 3600.0, 1.0),
    other("day", TIME, 86_400.0, 1.0),
    angular(other("deg", PURE, std::f64::consts::PI, 180.0)),
    angular(other("arcmin", PURE, std::f64::consts::PI, 10_800.0)),
    angular(other("rev", PURE, std::f64::consts::TAU, 1.0)),
    angular(other("rpm", RATE, std::f64::consts::PI, 30.0)),
    other("percent", PURE, 1.0, 100.0),
    prefixed(other("l", VOLUME, 1.0, 1e3)),
    prefixed(other("L", VOLUME, 1.0, 1e3)),
    prefixed(other("bar", PRESSURE, 1e5, 1.0)),
    other("atm", PRESSURE, 101_325.0, 1.0),
    prefixed(other("Wh", ENERGY, 3600.0, 1.0)),
    other("inch", LENGTH, 254.0, 10_000.0),
    other("ft", LENGTH, FOOT.0, FOOT.1),
    other("lb", MASS, POUND, 1.0),
    other("lbf", FORCE, POUND_FORCE, 1.0),
    other("kgf", FORCE, 9.806_65, 1.0),
    other("psi", PRESSURE, POUND_FORCE * 1e8, 254.0 * 254.0),
    // Of 550 ft*lbf/s; the metric one, PS, is 75 kgf*m/s.
    other("hp", POWER, 550.0 * FOOT.0 * POUND_FORCE, FOOT.1),
    other("PS", POWER, 75.0 * 9.806_65, 1.0),
];

/// Prefixes with their sizes as two numbers. Source: the SI Brochure, table 7.
const PREFIXES: [(&str, f64, f64); 13] = [
    ("da", 10.0, 1.0),
    ("T", 1e12, 1.0),
    ("G", 1e9, 1.0),
    ("M", 1e6, 1.0),
    ("k", 1e3, 1.0),
    ("h", 1e2, 1.0),
    ("d", 1.0, 10.0),
    ("c", 1.0, 1e2),
    ("m", 1.0, 1e3),
    ("u", 1.0, 1e6),
    ("µ", 1.0, 1e6),
    ("n", 1.0, 1e9),
    ("p", 1.0, 1e12),
];

/// All symbols without a prefix.
pub fn symbols() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.symbol)
}

/// The unit of a symbol with or without a prefix.
pub(crate) fn find(symbol: &str) -> Option<Unit> {
    let named = |symbol: &str| ENTRIES.iter().find(|entry| entry.symbol == symbol);
    if let Some(entry) = named(symbol) {
        return Some(entry.unit());
    }
    PREFIXES.iter().find_map(|&(prefix, numerator, denominator)| {
        let entry = symbol.strip_prefix(prefix).and_then(named).filter(|entry| entry.prefixes)?;
        let size = Unit { numerator, denominator, ..Unit::ONE };
        Some(size.times(entry.unit()))
    })
}

impl Entry {
    fn unit(&self) -> Unit {
        let (numerator, denominator) = self.size;
        Unit { dimension: Dimension::of_bases(self.bases), angle: self.angle, numerator, denominator }
    }
}
