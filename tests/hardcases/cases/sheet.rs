//! A table of measurements that are no verdicts on a case: as text, JSON and part of a page.
//!
//! In: a head and rows of values. Out: text. Numbers with a fraction are written with two digits.

use std::fmt::Write;

use serde_json::{Value, json};

/// A table with a name.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The name, one word.
    pub name: &'static str,
    /// What is measured, a sentence or two.
    pub about: &'static str,
    /// The names of the columns.
    pub head: &'static [&'static str],
    /// The rows, as many values as columns.
    pub rows: Vec<Vec<Value>>,
}

impl Sheet {
    /// Name, sentence and table as text.
    #[must_use]
    pub fn text(&self) -> String {
        let head = self.head.iter().map(|name| (*name).to_owned()).collect();
        let lines: Vec<Vec<String>> =
            std::iter::once(head).chain(self.rows.iter().map(|row| row.iter().map(shown).collect())).collect();
        let texts = self.rows.first().map_or(0, |row| row.iter().take_while(|value| value.is_string()).count());
        format!("\n{}: {}\n{}", self.name, self.about, aligned(&lines, texts))
    }

    /// The table as an object; not-a-number is null.
    #[must_use]
    pub fn json(&self) -> Value {
        let object = |row: &Vec<Value>| {
            let entries = self.head.iter().zip(row).map(|(name, value)| ((*name).to_owned(), value.clone()));
            Value::Object(entries.collect())
        };
        let rows: Vec<Value> = self.rows.iter().map(object).collect();
        json!({ "name": self.name, "about": self.about, "rows": rows })
    }

    /// The table as part of a page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut page = format!("<h2>{}</h2>\n<p>{}</p>\n<table>\n<tr>", self.name, escaped(self.about));
        let mut put = |text: std::fmt::Arguments| page.write_fmt(text).expect("a string");
        self.head.iter().for_each(|name| put(format_args!("<th>{}</th>", escaped(name))));
        put(format_args!("</tr>\n"));
        for row in &self.rows {
            put(format_args!("<tr>"));
            row.iter().for_each(|value| put(format_args!("<td>{}</td>", escaped(&shown(value)))));
            put(format_args!("</tr>\n"));
        }
        page + "</table>\n"
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => format!("{:.1e}", number.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

/// Lines of cells as columns two spaces apart; the first `texts` of them to the left, the others to the right.
#[must_use]
pub fn aligned(lines: &[Vec<String>], texts: usize) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |i: usize| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let padded =
            line.iter().zip(&widths).enumerate().map(|(i, (cell, width))| {
                if i < texts { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
        text += padded.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    text
}

/// Text for a page.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
