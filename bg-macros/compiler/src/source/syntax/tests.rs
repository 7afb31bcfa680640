//! Tests of the parser and the printer together.

use proc_macro2::TokenStream;

use super::{parse, parse_leniently};
use crate::fault::Fault;
use crate::source::ast::{Expression, ExpressionKind, Item, Source};

mod faults;
mod forms;
mod fuzz;

/// Every form of the language, with the sketch of its design: the motor and the saw's frame.
const EXAMPLE: &str = include_str!("tests/example.bond");

/// The tokens of `text`.
fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|error| panic!("the test's own text has no tokens: {error}: {text}"))
}

/// The tree of a text without faults.
fn parsed(text: &str) -> Source {
    parse(tokens(text)).unwrap_or_else(|faults| panic!("{}", shown(&faults)))
}

/// The items of one graph.
fn items(text: &str) -> Vec<Item> {
    let mut source = parsed(&format!("graph G {{ {text} }}"));
    source.graphs.remove(0).items
}

/// The faults of a text.
fn faults(text: &str) -> Vec<Fault> {
    parse_leniently(tokens(text)).1
}

/// The faults as lines, each with line and column (from 1).
fn shown(faults: &[Fault]) -> String {
    faults
        .iter()
        .map(|fault| {
            let start = fault.span.start();
            format!("{}:{} {} {} | {}\n", start.line, start.column + 1, fault.code, fault.message, fault.help)
        })
        .collect()
}

/// An expression, read as a value.
fn expression(text: &str) -> Expression {
    match items(&format!("let value = {text};")).remove(0) {
        Item::Let(binding) => binding.value,
        other => panic!("not a let: {other}"),
    }
}

/// The expression with every operation in parentheses.
fn grouped(expression: &Expression) -> String {
    match &expression.kind {
        ExpressionKind::Negate(operand) => format!("(-{})", grouped(operand)),
        ExpressionKind::Chain(first, rest) => rest.iter().fold(grouped(first), |left, operation| {
            let symbol = crate::source::words::word_of(&crate::source::words::OPERATORS, &operation.operator);
            format!("({left}{symbol}{})", grouped(&operation.operand))
        }),
        _ => expression.to_string(),
    }
}

/// The tree as text with all its fields but the spans, to compare two trees.
fn bare(source: &Source) -> String {
    let text = format!("{source:?}");
    let mut parts = text.split("bytes(");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |bare, part| bare + part.split_once(')').map_or(part, |(_, rest)| rest))
}
