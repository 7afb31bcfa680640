//! What a text in Markdown has: links, headings as anchors, code, tables. Blocks of code are no part of it.

use std::collections::{BTreeMap, BTreeSet};

/// The lines outside of blocks of code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The targets of the links, in their places and of labels.
pub fn links(text: &str) -> Vec<String> {
    let text = prose(text).collect::<Vec<_>>().join("\n");
    let inline = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let inline = inline.filter(|target| !target.contains(char::is_whitespace)).map(str::to_owned);
    inline.chain(labels(&text).into_values()).collect()
}

/// The labels of links with their targets: lines such as `[label]: target`.
pub fn labels(text: &str) -> BTreeMap<String, String> {
    let pairs = prose(text).filter_map(|line| line.strip_prefix('[')?.split_once("]: "));
    pairs.map(|(label, target)| (label.to_owned(), target.to_owned())).collect()
}

/// The anchors of the headings, as file hosts make them: in lower case, without punctuation, spaces as hyphens.
pub fn anchors(text: &str) -> BTreeSet<String> {
    let headings =
        prose(text).filter_map(|line| line.strip_prefix('#')).map(|line| line.trim_start_matches('#').trim());
    let kept = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || matches!(c, '_' | '-') => Some(c.to_ascii_lowercase()),
        _ => None,
    };
    headings.map(|heading| heading.chars().filter_map(kept).collect()).collect()
}

/// What stands between backticks in a line.
pub fn codes(text: &str) -> Vec<String> {
    prose(text).flat_map(|line| line.split('`').skip(1).step_by(2)).map(str::to_owned).collect()
}

/// The first cell of each row of the table whose first line begins with `head`.
pub fn first_cells<'a>(text: &'a str, head: &str) -> Vec<&'a str> {
    let rows = text.lines().skip_while(|line| !line.starts_with(head)).skip(2).take_while(|line| line.starts_with('|'));
    rows.filter_map(|row| row.split('|').nth(1)).collect()
}
