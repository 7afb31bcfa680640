//! Lines and their indentation.

use proc_macro2::Delimiter;

use super::spaces::spaced;
use super::structure::Structure;
use super::tokens::{Token, TokenClass};

/// Blanks of an indentation.
const INDENT: usize = 4;
/// The most characters of a line that has a block in it.
const WIDTH: usize = 120;

/// What stands between two tokens.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Between {
    Nothing,
    Blank,
    Line,
    EmptyLine,
}

/// The lines of a text.
pub struct Layout<'t> {
    tokens: &'t [Token<'t>],
    structure: Structure,
    /// For each bracket that opens a block whether its entries begin in a line after it.
    is_open: Vec<bool>,
    /// For each whether each of its entries has a line.
    is_split: Vec<bool>,
}

impl<'t> Layout<'t> {
    pub fn of(tokens: &'t [Token<'t>]) -> Self {
        let structure = Structure::of(tokens);
        let (mut is_open, mut is_split) = (vec![false; tokens.len()], vec![false; tokens.len()]);
        for (place, token) in tokens.iter().enumerate() {
            if token.kind == TokenClass::Open(Delimiter::Brace) && structure.is_declaration(place) {
                let is_empty = structure.partner[place] == place + 1;
                (is_open[place], is_split[place]) = (!is_empty, true);
            }
            // A block has lines where a line ends in it that is none of a block inside.
            let around = if let TokenClass::Close(_) = token.kind {
                Some(structure.partner[place])
            } else {
                structure.around[place]
            };
            if let Some(open) = around.filter(|open| tokens[*open].kind == TokenClass::Open(Delimiter::Brace)) {
                is_open[open] |= place > 0 && (has_line(tokens, place) || tokens[place - 1].ends_line());
            }
        }
        Self { tokens, structure, is_open, is_split }
    }

    /// The text. A block in a line that is too long is opened, each of its entries in a line of its own.
    pub fn text(mut self) -> String {
        loop {
            let (text, line_of) = self.lines();
            let mut is_done = true;
            for (line, _) in text.lines().enumerate().filter(|(_, text)| text.chars().count() > WIDTH) {
                let [start, end] = [line, line + 1].map(|line| line_of.partition_point(|of| *of < line));
                let block = (start..end).find(|&place| {
                    let is_brace = self.tokens[place].kind == TokenClass::Open(Delimiter::Brace);
                    let close = self.structure.partner[place];
                    is_brace && close > place + 1 && close < end && !self.is_open[place]
                });
                if let Some(block) = block {
                    (self.is_open[block], self.is_split[block], is_done) = (true, true, false);
                }
            }
            if is_done {
                return text;
            }
        }
    }

    /// The text, and the line of each token.
    fn lines(&self) -> (String, Vec<usize>) {
        let (mut text, mut line_of) = (String::new(), Vec::with_capacity(self.tokens.len()));
        let (mut line, mut indent) = (0, 0);
        // The indentations of the lines in which the brackets around were opened.
        let mut around: Vec<usize> = Vec::new();
        for (place, token) in self.tokens.iter().enumerate() {
            let opened = if let TokenClass::Close(_) = token.kind { around.pop() } else { None };
            match self.between(place) {
                Between::Nothing => {}
                Between::Blank => text.push(' '),
                ends @ (Between::Line | Between::EmptyLine) => {
                    let count = if ends == Between::Line { 1 } else { 2 };
                    line += count;
                    text.extend(std::iter::repeat_n('\n', count));
                    indent = opened.unwrap_or_else(|| self.indent(place, around.last().copied()));
                    text.extend(std::iter::repeat_n(' ', indent));
                }
            }
            text.push_str(token.text);
            line_of.push(line);
            line += token.text.matches('\n').count();
            if let TokenClass::Open(_) = token.kind {
                around.push(indent);
            }
        }
        if !text.is_empty() {
            text.push('\n');
        }
        (text, line_of)
    }

    /// The indentation of a line that begins with this token, in brackets of a line with the indentation `around`.
    fn indent(&self, place: usize, around: Option<usize>) -> usize {
        let block = around.map_or(0, |indent| indent + INDENT);
        let is_in_brackets = self.structure.around[place]
            .is_some_and(|open| self.tokens[open].kind != TokenClass::Open(Delimiter::Brace));
        let goes_on = !self.structure.begins[place] && !is_in_brackets;
        // Documentation is in front of what it is about.
        let is_documented = place > 0 && self.tokens[place - 1].kind == TokenClass::Documentation;
        if goes_on && !is_documented { block + INDENT } else { block }
    }

    /// What stands before a token.
    fn between(&self, place: usize) -> Between {
        let Some(last) = place.checked_sub(1) else { return Between::Nothing };
        let (before, token) = (&self.tokens[last], &self.tokens[place]);
        let is_edge = matches!(before.kind, TokenClass::Open(_)) || matches!(token.kind, TokenClass::Close(_));
        let line = if token.lines > 1 && !is_edge { Between::EmptyLine } else { Between::Line };
        if before.ends_line() {
            return line;
        }
        if self.ends_block_line(place)
            || (self.begins_line(place) && !token.is_comment())
            || has_line(self.tokens, place)
        {
            return line;
        }
        if spaced(self.tokens, &self.structure, place) { Between::Blank } else { Between::Nothing }
    }

    /// Whether a token is the first or the last one of an open block.
    fn ends_block_line(&self, place: usize) -> bool {
        let is_first = self.is_open[place - 1] && !self.tokens[place].is_comment();
        let is_last =
            matches!(self.tokens[place].kind, TokenClass::Close(_)) && self.is_open[self.structure.partner[place]];
        is_first || is_last
    }

    /// Whether a token begins an entry of which each has a line.
    fn begins_line(&self, place: usize) -> bool {
        let is_split = self.structure.around[place].is_none_or(|open| self.is_split[open]);
        is_split && self.structure.begins[place]
    }
}

/// Whether a line ends before this token that is kept: one before `;`, `,`, `{` and `else` is not.
fn has_line(tokens: &[Token], place: usize) -> bool {
    let token = &tokens[place];
    let is_of_line_before =
        token.is(";") || token.is(",") || token.is("else") || token.kind == TokenClass::Open(Delimiter::Brace);
    token.lines > 0 && !is_of_line_before
}
