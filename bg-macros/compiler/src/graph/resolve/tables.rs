//! Tables: functions that a graph gives by points, and what calls them.
//!
//! In: the statement, calls by its name. Out: a [`Table`] in SI, a lookup in it.

use super::{Entity, Resolver};
use crate::fault::near_miss;
use crate::graph::table::pieces;
use crate::graph::term::{Builtin, Term, TermKind};
use crate::graph::{GraphFault, Table};
use crate::source::ast::{self, Expression, ExpressionKind, Name};

/// The most points of a table: each is a place where an event may be.
const MOST_POINTS: usize = 1000;

impl Resolver {
    /// Declares a table.
    pub(super) fn table(&mut self, table: &ast::Table) {
        let ast::Table { name, argument, value, points, between, beyond } = table;
        self.name(name, Entity::Table(self.graph.tables.len()));
        let units = [self.unit(argument), self.unit(value)];
        let mut rows: Vec<(f64, f64)> = Vec::new();
        for row in rows_of(points) {
            let Some([x, y]) = pair_of(row) else {
                self.fault(row.span, &GraphFault::TablePoint { name: name.text.clone() });
                continue;
            };
            let point =
                (units[0].in_si(self.number(x, argument, units[0])), units[1].in_si(self.number(y, value, units[1])));
            if rows.last().is_some_and(|last| point.0 <= last.0) {
                self.fault(x.span, &GraphFault::TableOrder { name: name.text.clone() });
                continue;
            }
            rows.push(point);
        }
        if !(2..=MOST_POINTS).contains(&rows.len()) {
            self.fault(
                name.span,
                &GraphFault::TableSize { name: name.text.clone(), found: rows.len(), most: MOST_POINTS },
            );
            rows = vec![(0.0, 0.0), (1.0, 0.0)];
        }
        let (knots, pieces) = pieces(&rows, *between, *beyond);
        let (argument, value) = (units[0].dimension, units[1].dimension);
        self.graph.tables.push(Table { name: name.text.clone(), argument, value, knots, pieces });
    }

    /// A call of a table.
    pub(super) fn lookup(&mut self, table: usize, function: &Name, mut arguments: Vec<Term>) -> Term {
        let span = function.span;
        if arguments.len() != 1 {
            let (function, found) = (function.text.clone(), arguments.len());
            self.fault(span, &GraphFault::ArgumentCount { function, expected: 1, found });
            return Term { kind: TermKind::Number(0.0), span };
        }
        Term { kind: TermKind::Lookup(table, Box::new(arguments.remove(0))), span }
    }
}

/// The rows as they are written.
fn rows_of(points: &Expression) -> &[Expression] {
    if let ExpressionKind::Vector(rows) = &points.kind { rows } else { std::slice::from_ref(points) }
}

/// Argument and value of a row.
fn pair_of(row: &Expression) -> Option<&[Expression; 2]> {
    if let ExpressionKind::Vector(pair) = &row.kind { pair.as_slice().try_into().ok() } else { None }
}

/// What may be meant by the call of an unknown function.
pub(super) fn nearest_call(function: &str, tables: &[Table]) -> Option<String> {
    if let Some((value, function)) = function.rsplit_once('.')
        && Builtin::named(function).is_some()
    {
        return Some(format!("{function}({value})"));
    }
    let of_tables = near_miss(function, tables.iter().map(|table| table.name.as_str()));
    of_tables.or_else(|| near_miss(function, Builtin::names())).map(str::to_owned)
}
