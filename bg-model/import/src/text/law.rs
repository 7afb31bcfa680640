//! Laws, polynomials and ranges as expressions of the language.

use crate::number::number;
use crate::robot::Law;

/// An odd law of a variable.
pub fn odd(law: &Law, variable: &str) -> String {
    let powers = [variable.to_owned(), format!("{variable} * abs({variable})"), format!("pow({variable}, 3)")];
    format!("({variable}) = {}", sum(&law.0.into_iter().zip(powers).collect::<Vec<_>>()))
}

/// The energy of a spring with such a law; none where the compiler finds it.
pub fn energy(law: &Law, variable: &str) -> String {
    if law.is_linear() {
        return String::new();
    }
    let powers =
        [format!("pow({variable}, 2) / 2"), format!("abs(pow({variable}, 3)) / 3"), format!("pow({variable}, 4) / 4")];
    format!(" energy {}", sum(&law.0.into_iter().zip(powers).collect::<Vec<_>>()))
}

/// A linear law and its energy that are 0 from 0 to `slack`.
pub fn loose(law: &Law, variable: &str, slack: f64) -> (String, String) {
    let (each, slack) = (number(law.0[0]), number(slack));
    let above = format!("{variable} - {slack}");
    let cases = |above: String, below: String| {
        format!("if {variable} > {slack} {{ {above} }} else if {variable} < 0 {{ {below} }} else {{ 0 }}")
    };
    let energy = |arm: &str| format!("{each} * pow({arm}, 2) / 2");
    (
        format!("({variable}) = {}", cases(format!("{each} * ({above})"), format!("{each} * {variable}"))),
        format!(" energy {}", cases(energy(&above), energy(variable))),
    )
}

/// A polynomial, constant first.
pub fn polynomial(coefficients: &[f64], variable: &str) -> String {
    let power = |k: usize| match k {
        0 => String::new(),
        1 => variable.to_owned(),
        _ => format!("pow({variable}, {k})"),
    };
    sum(&coefficients.iter().copied().zip((0..).map(power)).collect::<Vec<_>>())
}

/// A sum of products; those of 0 are left out, those of 1 are not, since a number takes whatever unit is asked for.
pub fn sum(terms: &[(f64, String)]) -> String {
    let term = |(factor, power): &(f64, String)| match power.as_str() {
        "" => number(*factor),
        _ => format!("{} * {power}", number(*factor)),
    };
    let terms: Vec<String> = terms.iter().filter(|(factor, _)| *factor != 0.0).map(term).collect();
    if terms.is_empty() { "0".to_owned() } else { terms.join(" + ").replace("+ -", "- ") }
}

/// A name's value within a range.
pub fn within(name: &str, (least, most): (f64, f64)) -> String {
    let (least, most) = (number(least), number(most));
    format!("if {name} > {most} {{ {most} }} else if {name} < {least} {{ {least} }} else {{ {name} }}")
}
