//! Tables: functions that a graph gives by points, and what calls them.
//!
//! In: the statement, calls by its name. Out: a [`Table`] in SI, a lookup in it.

use bg_units::Unit;

use super::{Entity, Resolver};
use crate::fault::near_miss;
use crate::graph::table::{pieces, surface};
use crate::graph::term::{Lookup, Term, TermKind};
use crate::graph::{GraphFault, Table};
use crate::source::ast::{self, Between, Beyond, Expression, ExpressionKind, Name};
use crate::source::functions::{self, FUNCTIONS};
use crate::source::words::DERIVATIVES;

/// What the last value of a periodic table may differ from its first one, beside the largest: rounding.
const SEAM: f64 = 1e-12;

/// The most points of a table: each is a place where an event may be.
const MOST_POINTS: usize = 1000;

impl Resolver {
    /// Declares a table.
    pub(super) fn table(&mut self, table: &ast::Table) {
        let name = table.name.text.clone();
        self.name(&table.name, Entity::Table(self.graph.tables.len()));
        let made = if table.second.is_some() { self.surface(table) } else { self.curve(table) };
        self.graph.tables.push(Table { name, ..made });
    }

    /// A table of one argument.
    fn curve(&mut self, table: &ast::Table) -> Table {
        let ast::Table { name, argument, value, points, between, beyond, .. } = table;
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
        if !self.table_fits(name, [rows.len(), 2]) {
            rows = vec![(0.0, 0.0), (1.0, 0.0)];
        }
        if *beyond == Beyond::Periodic {
            let [first, last] = [rows[0].1, rows[rows.len() - 1].1];
            let is_seam = (first - last).abs() <= SEAM * rows.iter().fold(0.0, |most: f64, row| most.max(row.1.abs()));
            if rows.len() < 3 || !is_seam {
                self.fault(name.span, &GraphFault::TablePeriod { name: name.text.clone() });
                rows = vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)];
            }
        }
        let (knots, pieces, period) = pieces(&rows, *between, *beyond);
        let (arguments, value) = (vec![units[0].dimension], units[1].dimension);
        Table { name: String::new(), arguments, value, knots, pieces, period, surface: None }
    }

    /// A table of two arguments: a row of the second ones, then rows of a first one with its values.
    fn surface(&mut self, table: &ast::Table) -> Table {
        let ast::Table { name, argument, second, value, points, between, beyond } = table;
        let known = self.faults.len();
        let second = second.as_ref().unwrap_or(argument);
        let units = [argument, second, value].map(|unit| self.unit(unit));
        let mut all = rows_of(points).iter();
        let head = all.next().map(rows_of).unwrap_or_default();
        let mut across = self.ascending(name, head, (second, units[1]));
        let (mut along, mut values): (Vec<f64>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        for row in all {
            let numbers = rows_of(row);
            let (Some(first), true) = (numbers.first(), numbers.len() == head.len() + 1) else {
                self.fault(
                    row.span,
                    &GraphFault::TableRow { name: name.text.clone(), found: numbers.len(), expected: head.len() + 1 },
                );
                continue;
            };
            let x = units[0].in_si(self.number(first, argument, units[0]));
            if along.last().is_some_and(|last| x <= *last) {
                self.fault(first.span, &GraphFault::TableOrder { name: name.text.clone() });
                continue;
            }
            along.push(x);
            values.push(numbers[1..].iter().map(|y| units[2].in_si(self.number(y, value, units[2]))).collect());
        }
        let words = [(*between == Between::Monotone, "monotone"), (*beyond == Beyond::Periodic, "periodic")];
        for (_, word) in words.into_iter().filter(|(stands, _)| *stands) {
            self.fault(name.span, &GraphFault::TableOfTwo { name: name.text.clone(), word });
        }
        let is_whole = self.faults.len() == known && self.table_fits(name, [across.len(), along.len()]);
        if !is_whole {
            (along, across, values) = (vec![0.0, 1.0], vec![0.0, 1.0], vec![vec![0.0; 2]; 2]);
        }
        let between = if *between == Between::Monotone { Between::Straight } else { *between };
        let surface = Some(surface([&along, &across], &values, between, *beyond));
        let (arguments, value) = (vec![units[0].dimension, units[1].dimension], units[2].dimension);
        Table { name: String::new(), arguments, value, knots: Vec::new(), pieces: Vec::new(), period: None, surface }
    }

    /// Numbers in SI as far as they ascend.
    fn ascending(&mut self, name: &Name, numbers: &[Expression], (unit, measured): (&ast::Unit, Unit)) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::new();
        for number in numbers {
            let value = measured.in_si(self.number(number, unit, measured));
            if all.last().is_some_and(|last| value <= *last) {
                self.fault(number.span, &GraphFault::TableOrder { name: name.text.clone() });
            } else {
                all.push(value);
            }
        }
        all
    }

    /// Whether a table of so many arguments has enough points and not too many; else a fault.
    fn table_fits(&mut self, name: &Name, [first, second]: [usize; 2]) -> bool {
        let found = if second == 2 { first } else { first * second };
        let fits = first >= 2 && second >= 2 && found <= MOST_POINTS;
        if !fits {
            self.fault(name.span, &GraphFault::TableSize { name: name.text.clone(), found, most: MOST_POINTS });
        }
        fits
    }

    /// A call of a table.
    pub(super) fn lookup(&mut self, lookup: Lookup, function: &Name, arguments: Vec<Term>) -> Term {
        let (span, table) = (function.span, &self.graph.tables[lookup.table]);
        let (expected, found) = (table.arguments.len(), arguments.len());
        if lookup.order > 0 && expected > 1 {
            let name = table.name.clone();
            self.fault(span, &GraphFault::TableOfTwo { name, word: "derivative" });
        } else if found != expected {
            let function = function.text.clone();
            self.fault(span, &GraphFault::ArgumentCount { function, expected, found });
        } else {
            return Term { kind: TermKind::Lookup(lookup, arguments), span };
        }
        Term { kind: TermKind::Number(0.0), span }
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
    if let Some((value, function)) = function.rsplit_once('.') {
        if functions::named(function).is_some() {
            return Some(format!("{function}({value})"));
        }
        if tables.iter().any(|table| table.name == value) {
            let word = near_miss(function, DERIVATIVES.map(|(word, _)| word)).unwrap_or(DERIVATIVES[0].0);
            return Some(format!("{value}.{word}"));
        }
    }
    if let Some(written) = functions::of_elsewhere(function) {
        return Some(written.to_owned());
    }
    let of_tables = near_miss(function, tables.iter().map(|table| table.name.as_str()));
    of_tables.or_else(|| near_miss(function, FUNCTIONS.iter().map(|known| known.name))).map(str::to_owned)
}
