//! A part in its place: what its parameters are, where its bodies start.
//!
//! In: a part under the name of its use, the use's clauses with names that mean what they mean here. Out: a `let` for
//! each parameter that is given, with what its range asks of the value, and bodies with other starts.

use std::collections::BTreeSet;

use super::PartFault;
use super::flat::Flat;
use crate::fault::{Fault, Faults, near_miss};
use crate::source::ast::{
    BinaryOperator, Body, Bound, Expression, ExpressionKind, Item, Let, Name, Operation, Parameter, Start, StartKind,
    Unit, Use,
};
use crate::source::clause::{Allowed, Clause, Given};
use crate::source::words::{STARTS, word_of};

/// Gives the parameters of `flat`, whose names begin with `prefix`, what the use says.
pub(super) fn give(flat: &mut Flat, used: &Use, prefix: &str, faults: &mut Faults) {
    for argument in &used.arguments {
        let path = format!("{prefix}{}", argument.name.text);
        let what = format!("`{}` of part `{}`", argument.name.text, shown(used));
        let Some(index) = flat.items.iter().position(|item| open(item).is_some_and(|name| name.text == path)) else {
            faults.push(Fault::new(argument.name.span, &unknown(flat, used, prefix, &argument.name.text)));
            continue;
        };
        let given = match &flat.items[index] {
            Item::Parameter(parameter) => parameter_given(parameter, &what, &argument.value, faults),
            other => vec![input_given(other, &what, &argument.value)],
        };
        flat.items.splice(index..=index, given.into_iter().map(Item::Let));
    }
}

/// The fault of a parameter that is not open.
fn unknown(flat: &Flat, used: &Use, prefix: &str, name: &str) -> PartFault {
    let (part, name) = (used.part.name.text.clone(), name.to_owned());
    let is_given = |item: &Item| matches!(item, Item::Let(given) if given.name.text == format!("{prefix}{name}"));
    if flat.items.iter().any(is_given) {
        return PartFault::GivenInside { part, name };
    }
    let known: Vec<&str> =
        flat.items.iter().filter_map(open).filter_map(|known| known.text.strip_prefix(prefix)).collect();
    let near = near_miss(&name, known.iter().copied()).map(str::to_owned);
    let known = known.into_iter().map(str::to_owned).collect();
    PartFault::UnknownParameter { part, name, near, known }
}

/// `front: Leg`
pub(super) fn shown(used: &Use) -> String {
    let part = &used.part.name.text;
    used.name.as_ref().map_or_else(|| part.clone(), |name| format!("{}: {part}", name.text))
}

/// The name of a parameter or input.
fn open(item: &Item) -> Option<&Name> {
    item.adjustable().map(|(_, name)| name)
}

/// An input may be anything, also what changes.
fn input_given(item: &Item, what: &str, value: &Expression) -> Let {
    let (Item::Input(input), clause) = (item, Clause::argument(format!("the input {what}"), Given::Free)) else {
        unreachable!("what is open is a parameter or an input")
    };
    let_of(&input.name, &input.unit, &value.clone().in_unit(&input.unit), clause)
}

fn let_of(name: &Name, unit: &Unit, value: &Expression, clause: Clause) -> Let {
    Let { name: name.clone(), unit: Some(unit.clone()), value: value.clone(), clause: Some(clause) }
}

/// The `let` of a parameter, and one for each end of its range that is not decided here and is not 0.
fn parameter_given(parameter: &Parameter, what: &str, value: &Expression, faults: &mut Faults) -> Vec<Let> {
    let value = &value.clone().in_unit(&parameter.unit);
    let of = |what: String| Clause::argument(what, Given::Constant);
    let is_number = value.number().is_some();
    if let Some(number) = value.number() {
        outside(parameter, number).into_iter().for_each(|wanted| {
            let fault = PartFault::OutsideRange { parameter: format!("the parameter {what}"), wanted };
            faults.push(Fault::new(value.span, &fault));
        });
    }
    let mut allowed = Allowed::Any;
    let mut lets = Vec::new();
    for (bound, is_lower) in [(&parameter.lower, true), (&parameter.upper, false)] {
        let Some(bound) = bound.as_ref().filter(|_| !is_number) else { continue };
        let sign = if bound.included { Allowed::NotNegative } else { Allowed::Positive };
        if is_lower && bound.value.number() == Some(0.0) {
            allowed = sign;
        } else {
            lets.push(distance(parameter, bound, is_lower, of(distance_words(what, bound, is_lower)).allowed(sign)));
        }
    }
    lets.insert(
        0,
        let_of(&parameter.name, &parameter.unit, value, of(format!("the parameter {what}")).allowed(allowed)),
    );
    lets
}

fn distance_words(what: &str, bound: &Bound, is_lower: bool) -> String {
    let end = if is_lower { "lower" } else { "upper" };
    format!("the distance of the parameter {what} from the {end} end of its range, {},", bound.value)
}

/// How far a parameter is inside of one end of its range.
fn distance(parameter: &Parameter, bound: &Bound, is_lower: bool, clause: Clause) -> Let {
    let (name, span) = (&parameter.name, parameter.name.span);
    let own = Expression { kind: ExpressionKind::Name(name.clone()), span };
    let (first, second) = if is_lower { (own, bound.value.clone()) } else { (bound.value.clone(), own) };
    let operation = Operation { operator: BinaryOperator::Subtract, span, operand: second };
    let value = Expression { kind: ExpressionKind::Chain(Box::new(first), vec![operation]), span };
    let end = if is_lower { "above_lower" } else { "below_upper" };
    let_of(&Name::new(format!("{}.{end}", name.text), span), &parameter.unit, &value, clause)
}

/// What the range of a parameter wants of a number that is outside of it.
fn outside(parameter: &Parameter, number: f64) -> Option<String> {
    let lower = parameter.lower.as_ref().and_then(|bound| {
        let end = bound.value.number()?;
        let fits = number > end || bound.included && number == end;
        (!fits).then(|| format!("{} {}", if bound.included { "at least" } else { "above" }, bound.value))
    });
    let upper = parameter.upper.as_ref().and_then(|bound| {
        let end = bound.value.number()?;
        let fits = number < end || bound.included && number == end;
        (!fits).then(|| format!("{} {}", if bound.included { "at most" } else { "below" }, bound.value))
    });
    lower.or(upper)
}

/// Starts bodies where the statements of one level put them.
pub(super) fn start(items: &mut [Item], starts: Vec<Start>, faults: &mut Faults) {
    let mut given = BTreeSet::new();
    for start in starts {
        let (span, of) = (start.of.span, start.of.text.clone());
        let Some((body, point)) = body_of(items, &of) else {
            let bodies = items.iter().filter_map(|item| if let Item::Body(body) = item { Some(body) } else { None });
            let near = near_miss(&of, bodies.map(|body| body.name.text.as_str())).map(str::to_owned);
            faults.push(Fault::new(span, &PartFault::NothingToStart { name: of, near }));
            continue;
        };
        if !given.insert((body.name.text.clone(), start.kind)) {
            let (body, clause) = (body.name.text.clone(), word_of(&STARTS, &start.kind));
            faults.push(Fault::new(span, &PartFault::StartTwice { body, clause }));
            continue;
        }
        let point = point.map(|text| Name::new(text, span));
        set(body, start, point);
    }
}

/// The body of this path, or the one with a point of this path.
fn body_of<'i>(items: &'i mut [Item], path: &str) -> Option<(&'i mut Body, Option<String>)> {
    items.iter_mut().find_map(|item| {
        let Item::Body(body) = item else { return None };
        let rest = path.strip_prefix(body.name.text.as_str())?;
        match rest.strip_prefix('.') {
            None if rest.is_empty() => Some((body, None)),
            Some(point) if !point.contains('.') => Some((body, Some(point.to_owned()))),
            _ => None,
        }
    })
}

fn set(body: &mut Body, start: Start, point: Option<Name>) {
    match start.kind {
        StartKind::Place => body.start_position = Some((point, start.value)),
        StartKind::Orientation => body.start_orientation = Some(start.value),
        StartKind::Velocity => body.start_velocity = Some(start.value),
        StartKind::Spin => body.start_spin = Some(start.value),
    }
}
