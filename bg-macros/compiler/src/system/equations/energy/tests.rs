//! Energies that are those of their laws, and energies that are not.

use crate::pipeline;
use crate::source::syntax;

/// The codes of the faults of a mass on a spring of this law.
fn codes(statements: &str) -> Vec<&'static str> {
    let text = format!(
        "graph G {{ param k: N/m = 50; param s: m = 0.3; {statements} 1 j: translation; I m = 2; j -> m; j -> c; }}"
    );
    let source = syntax::parse(text.parse().expect("tokens")).unwrap();
    pipeline::derive(&source.graphs[0]).err().unwrap_or_default().iter().map(|fault| fault.code).collect()
}

#[test]
fn an_energy_may_not_jump_where_its_law_switches() {
    let none: [&str; 0] = [];
    let stop = |energy: &str| {
        format!("C c(q) = if q < s {{ 0 }} else {{ k * q }} energy if q < s {{ 0 }} else {{ {energy} }};")
    };
    assert_eq!(codes(&stop("k * q * q / 2")), ["BG0506"]);
    assert_eq!(codes(&stop("k * (q * q - s * s) / 2")), none);
    // As written in the issue, and with a step of a thousandth.
    let literal = |energy: &str| {
        format!("C c(q) = if q < 1 {{ 0 }} else {{ k * q }} energy if q < 1 {{ 0 }} else {{ {energy} }};")
    };
    assert_eq!(codes(&literal("k * q * q / 2")), ["BG0506"]);
    assert_eq!(codes(&literal("k * (q * q - 0.999) / 2")), ["BG0506"]);
    assert_eq!(codes(&literal("k * (q * q - 1) / 2")), none);
}

#[test]
fn branches_that_exclude_each_other_are_compared() {
    let none: [&str; 0] = [];
    let stops = |left: &str, right: &str| {
        format!(
            "C c(q) = if q < -s {{ k * (q + s) }} else if q < s {{ 0 }} else {{ k * (q - s) }}
             energy if q < -s {{ k * (q + s) * (q + s) / 2 + {left} * s * s }} else if q < s {{ 0 }}
                 else {{ k * (q - s) * (q - s) / 2 + {right} * s * s }};"
        )
    };
    assert_eq!(codes(&stops("0 * k", "0 * k")), none);
    assert_eq!(codes(&stops("k", "0 * k")), ["BG0506"]);
    assert_eq!(codes(&stops("0 * k", "0.001 * k")), ["BG0506"]);
    // A narrow branch in the middle with an energy of its own.
    let narrow = |factor: &str| {
        format!(
            "let n: m = 1e-4; C c(q) = if q < s {{ 0 }} else if q < s + n {{ k * (q - s) }} else {{ k * n }}
             energy if q < s {{ 0 }} else if q < s + n {{ {factor} * k * (q - s) * (q - s) }} else {{ k * n * (q - s) \
             - k * n * n / 2 }};"
        )
    };
    assert_eq!(codes(&narrow("0.5")), none);
    assert!(!codes(&narrow("0.6")).is_empty());
}

#[test]
fn functions_are_compared_where_they_are_finite() {
    let none: [&str; 0] = [];
    assert_eq!(
        codes(
            "let a: N = 3; let b: m = 0.1; C c(q) = a * tanh(q / b) energy a * b * ln((exp(q / b) + exp(-q / b)) / 2);"
        ),
        none
    );
    assert_eq!(
        codes("let a: N = 3; let b: m = 0.1; C c(q) = a * tanh(q / b) energy a * b * (q / b) * (q / b);"),
        ["BG0504"]
    );
    // Finite for one sign of the state only; nowhere.
    assert_eq!(
        codes("let a: N = 3; let b: m = 1; C c(q) = a * sqrt(q / b) energy a * b * 2 / 3 * pow(q / b, 1.5);"),
        none
    );
    assert_eq!(
        codes("let a: N = 3; let b: m = 1; C c(q) = a * sqrt(q / b) energy a * b * pow(q / b, 1.5);"),
        ["BG0504"]
    );
    assert_eq!(codes("let a: N = 3; let b: m = 1; C c(q) = a * sqrt(-1 - abs(q / b)) energy a * q;"), ["BG0507"]);
}

#[test]
fn a_parameter_that_is_zero_by_default_still_counts() {
    assert_eq!(codes("param f: N = 0; C c(q) = k * q + f energy k * q * q / 2;"), ["BG0504"]);
    assert_eq!(codes("param f: N = 0; C c(q) = f * sin(q / s) energy 0 * f * s;"), ["BG0504"]);
}

#[test]
fn a_multibond_may_not_jump_either() {
    let at = |offset: &str| {
        format!(
            "graph G {{ param k: N/m = 50; 1 j[3]: translation; I m = 2; j -> m; j -> c;
             C c(q) = if q.x < 0.2 {{ [0, 0, 0] }} else {{ [k * (q.x - {offset}), 0, 0] }}
             energy if q.x < 0.2 {{ 0 }} else {{ k * (q.x - {offset}) * (q.x - {offset}) / 2 }}; }}"
        )
    };
    let codes = |text: &str| -> Vec<&str> {
        let source = syntax::parse(text.parse().expect("tokens")).unwrap();
        pipeline::derive(&source.graphs[0]).err().unwrap_or_default().iter().map(|fault| fault.code).collect()
    };
    assert_eq!(codes(&at("0.1")), ["BG0506"]);
    assert_eq!(codes(&at("0.2")), [""; 0]);
}
