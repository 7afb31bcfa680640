//! Points of tables that stand in files of their own: `table curve: rpm -> N*m = "motor.csv";`.
//!
//! In: the tokens of a file, what reads another one. Out: the same tokens with the points in place of the file's name,
//! each with the unit that the head of its column gives in brackets. Two columns, separated by commas; a head may be
//! there. Of a table of two arguments the head is a word, with the unit of the first column in brackets, and the second
//! arguments.

use std::ops::Range;

use proc_macro2::{Delimiter, Group, Literal, Punct, Spacing, Span, TokenStream, TokenTree};

/// Puts points in the places of the names of files after `table .. =`. What `read` says of a file without points stands
/// at its name.
pub(super) fn replaced(tokens: TokenStream, read: &mut dyn FnMut(&str, Span) -> Option<TokenStream>) -> TokenStream {
    let (mut is_table, mut is_value) = (false, false);
    let token = |token: TokenTree| {
        match &token {
            TokenTree::Ident(word) if word == "table" => (is_table, is_value) = (true, false),
            TokenTree::Punct(mark) if mark.as_char() == ';' => is_table = false,
            TokenTree::Punct(mark) if mark.as_char() == '=' => is_value = is_table,
            TokenTree::Literal(literal) if is_value => {
                if let syn::Lit::Str(name) = syn::Lit::new(literal.clone())
                    && let Some(points) = read(&name.value(), literal.span())
                {
                    return bracketed(points, literal.span());
                }
            }
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                let mut inside = Group::new(Delimiter::Brace, replaced(group.stream(), read));
                inside.set_span(group.span());
                return inside.into();
            }
            _ => {}
        }
        token
    };
    tokens.into_iter().map(token).collect()
}

/// A text in which a table of this name has other points, as they would be written there: `"motor.csv"`, or
/// `[[0, 12]]`. Lines stay where they are. Of tables in files that the text uses nothing is known.
///
/// # Errors
/// There is no such table; the names of those that there are.
pub fn with_points(text: &str, name: &str, points: &str) -> Result<String, Vec<String>> {
    let Ok(tokens) = text.parse::<TokenStream>() else { return Ok(text.to_owned()) };
    let mut found: Vec<(String, Range<usize>)> = Vec::new();
    values(tokens, &mut found);
    if found.iter().all(|(known, _)| known != name) {
        let mut known: Vec<String> = found.into_iter().map(|(known, _)| known).collect();
        known.dedup();
        return Err(known);
    }
    let mut text = text.to_owned();
    for (_, place) in found.into_iter().rev().filter(|(known, _)| known == name) {
        let lines = "\n".repeat(text[place.clone()].matches('\n').count());
        text.replace_range(place, &format!("{points}{lines}"));
    }
    Ok(text)
}

/// The name of each table with the place of its points, in bytes.
fn values(tokens: TokenStream, found: &mut Vec<(String, Range<usize>)>) {
    let (mut name, mut is_table, mut is_value) = (None, false, false);
    for token in tokens {
        match &token {
            TokenTree::Ident(word) if is_table && name.is_none() => name = Some(word.to_string()),
            TokenTree::Ident(word) if word == "table" => (is_table, is_value, name) = (true, false, None),
            TokenTree::Punct(mark) if mark.as_char() == ';' => is_table = false,
            TokenTree::Punct(mark) if mark.as_char() == '=' && is_table => is_value = true,
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                is_table = false;
                values(group.stream(), found);
            }
            TokenTree::Group(_) | TokenTree::Literal(_) if is_table && is_value => {
                found.extend(name.take().map(|name| (name, token.span().byte_range())));
                is_table = false;
            }
            _ => {}
        }
    }
}

/// The points of a file as tokens, `[0 rpm, 12 N*m], ..`, all at one place.
///
/// # Errors
/// What is wrong with its text, and in which line.
pub(super) fn points(text: &str, span: Span) -> Result<TokenStream, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let (mut units, mut rows) = ([TokenStream::new(), TokenStream::new()], TokenStream::new());
    let mut is_wide = false;
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(index as u64 + 1, csv::Position::line);
        let cells: Vec<&str> = record.iter().collect();
        if index == 0 && cells.len() > 2 && cells[0].parse::<f64>().is_err() {
            (is_wide, units[0]) = (true, unit(cells[0], span)?);
            rows.extend([wide_row(&cells[1..], &TokenStream::new(), span).ok_or_else(|| wrong(line))?, comma(span)]);
            continue;
        }
        if is_wide {
            rows.extend([wide_row(&cells, &units[0], span).ok_or_else(|| wrong(line))?, comma(span)]);
            continue;
        }
        let [x, y] = cells[..] else {
            return Err(format!("line {line} has {} columns, not two", record.len()));
        };
        match [x, y].map(str::parse::<f64>) {
            [Ok(x), Ok(y)] if x.is_finite() && y.is_finite() => {
                let pair = number(x, &units[0], span).chain([comma(span)]).chain(number(y, &units[1], span)).collect();
                rows.extend([bracketed(pair, span), comma(span)]);
            }
            [Err(_), Err(_)] if index == 0 => units = [unit(x, span)?, unit(y, span)?],
            _ => return Err(format!("line {line} is no pair of numbers: `{x}, {y}`")),
        }
    }
    if rows.is_empty() { Err("it has no points".to_owned()) } else { Ok(rows) }
}

/// What is wrong with a line of a table of two arguments.
fn wrong(line: u64) -> String {
    format!("line {line} is no row of numbers")
}

/// A row of a table of two arguments; none where it is not of numbers. The first one may have a unit.
fn wide_row(cells: &[&str], first: &TokenStream, span: Span) -> Option<TokenTree> {
    let mut row = TokenStream::new();
    for (index, cell) in cells.iter().enumerate() {
        let value = cell.parse::<f64>().ok().filter(|value| value.is_finite())?;
        let none = TokenStream::new();
        row.extend(number(value, if index == 0 { first } else { &none }, span).chain([comma(span)]));
    }
    Some(bracketed(row, span))
}

/// A number with its sign and its unit.
fn number(value: f64, unit: &TokenStream, span: Span) -> impl Iterator<Item = TokenTree> {
    let minus = value.is_sign_negative().then(|| TokenTree::from(Punct::new('-', Spacing::Alone)));
    let literal = TokenTree::from(Literal::f64_unsuffixed(value.abs()));
    minus.into_iter().chain([literal]).chain(unit.clone()).map(move |token| at(token, span))
}

/// The unit in the brackets of a head, `torque [N*m]`; nothing where there is none.
fn unit(head: &str, span: Span) -> Result<TokenStream, String> {
    let Some((_, rest)) = head.split_once('[') else { return Ok(TokenStream::new()) };
    let text = rest.trim_end().strip_suffix(']').unwrap_or(rest).trim();
    text.parse::<bg_units::Unit>().map_err(|unknown| format!("the head `{head}`: {unknown}"))?;
    let tokens: TokenStream = text.parse().map_err(|_| format!("the head `{head}` has no unit"))?;
    Ok(tokens.into_iter().map(|token| at(token, span)).collect())
}

fn comma(span: Span) -> TokenTree {
    at(Punct::new(',', Spacing::Alone).into(), span)
}

fn bracketed(tokens: TokenStream, span: Span) -> TokenTree {
    at(Group::new(Delimiter::Bracket, tokens).into(), span)
}

fn at(mut token: TokenTree, span: Span) -> TokenTree {
    token.set_span(span);
    token
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<String, String> {
        points(text, Span::call_site()).map(|tokens| tokens.to_string().replace(' ', ""))
    }

    #[test]
    fn pairs_of_numbers_are_points_with_the_units_of_their_heads() {
        assert_eq!(read("0, 12\n100,-1.5e2\n"), Ok("[0.0,12.0],[100.0,-150.0],".to_owned()));
        assert_eq!(read("speed [rpm],torque [N*m]\n# measured\n0,12\n"), Ok("[0.0rpm,12.0N*m],".to_owned()));
        assert_eq!(read("speed,torque\n0,12\n"), Ok("[0.0,12.0],".to_owned()));
    }

    #[test]
    fn rows_of_a_wide_file_are_those_of_a_table_of_two_arguments() {
        let text = "speed by voltage [rpm], 12, 24\n0, 1, 2\n-500, 3, -4.5\n";
        assert_eq!(read(text), Ok("[12.0,24.0,],[0.0rpm,1.0,2.0,],[-500.0rpm,3.0,-4.5,],".to_owned()));
        assert_eq!(read("n, 12, 24\n0, 1, two\n").unwrap_err(), "line 2 is no row of numbers");
    }

    #[test]
    fn a_table_gets_other_points_and_lines_stay() {
        let text = "graph G {\n  table a: m -> N = [[0, 1],\n [1, 2]], spline;\n  table b: m, V -> N = \"b.csv\";\n}";
        let with = |name, points| with_points(text, name, points);
        assert_eq!(
            with("a", "\"new.csv\"").as_deref(),
            Ok("graph G {\n  table a: m -> N = \"new.csv\"\n, spline;\n  table b: m, V -> N = \"b.csv\";\n}")
        );
        assert_eq!(with("b", "[[0, 3]]"), Ok(text.replace("\"b.csv\"", "[[0, 3]]")));
        assert_eq!(with("c", ""), Err(vec!["a".to_owned(), "b".to_owned()]));
    }

    #[test]
    fn what_is_no_pair_is_told_with_its_line() {
        assert_eq!(
            read("0,1\n2\n").unwrap_err(),
            "CSV error: record 1 (line: 2, byte: 4): found record with 1 fields, but the previous record has 2 fields"
        );
        assert_eq!(read("0,1,2\n").unwrap_err(), "line 1 has 3 columns, not two");
        assert_eq!(read("0,1\n1,two\n").unwrap_err(), "line 2 is no pair of numbers: `1, two`");
        assert_eq!(read("0,NaN\n").unwrap_err(), "line 1 is no pair of numbers: `0, NaN`");
        assert_eq!(read("a [ells],b\n0,1\n").unwrap_err(), "the head `a [ells]`: `ells` is not a unit");
        assert_eq!(read("").unwrap_err(), "it has no points");
    }
}
