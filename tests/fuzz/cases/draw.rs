//! Drawing: one of several, now and then, a number with an edge.

use fastrand::Rng;

/// Numbers at the edges of what is read, kept or calculated with.
pub(super) const EXTREMES: [&str; 26] = [
    "0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "1e-3",
    "1e308",
    "1e-308",
    "4.9e-324",
    "1e309",
    "1e-400",
    "1e99999999999",
    "255",
    "256",
    "1024",
    "65536",
    "2147483647",
    "2147483648",
    "4294967296",
    "9223372036854775808",
    "18446744073709551616",
    "1_000_000_000",
    "0.1",
    "123456789012345678901234567890",
    "16",
];

/// One of these.
pub(super) fn one<'a>(rng: &mut Rng, of: &[&'a str]) -> &'a str {
    of[rng.usize(..of.len())]
}

/// Once in so many times.
pub(super) fn rarely(rng: &mut Rng, once_in: u32) -> bool {
    rng.u32(..once_in) == 0
}

/// A number of the usual kind, rarely an edge.
pub(super) fn number(rng: &mut Rng) -> String {
    if rarely(rng, 40) {
        return one(rng, &EXTREMES).to_owned();
    }
    let digits = f64::from(rng.u32(1..1000));
    format!("{}", digits * 10_f64.powi(-rng.i32(0..4)))
}
