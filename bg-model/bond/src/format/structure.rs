//! What begins, contains and ends what.
//!
//! In: tokens. Out: for each its block, and whether it begins an entry of it: a statement, a clause, a name of a list.

use bg_compiler::source::syntax::BLOCKS;
use proc_macro2::Delimiter;

use super::tokens::{Token, TokenClass};

/// The blocks whose entries `,` separates.
const LISTS: [&str; 4] = ["observe", "tune", "without", "rigid"];

/// What is known of the tokens' places.
#[derive(Debug, Default)]
pub struct Structure {
    /// The other end of each bracket; of any other token itself.
    pub partner: Vec<usize>,
    /// The bracket around each token, which for a bracket is one further out.
    pub around: Vec<Option<usize>>,
    /// Whether a token, or a comment, begins an entry.
    pub begins: Vec<bool>,
    /// Whether a token is part of a unit.
    pub is_unit: Vec<bool>,
}

/// A block while it is read.
#[derive(Debug, Default)]
struct Block<'t> {
    open: Option<usize>,
    is_list: bool,
    /// The first word of the present entry.
    head: Option<&'t str>,
    /// Whether something of the present entry has been read.
    is_within: bool,
    is_unit: bool,
}

impl Block<'_> {
    fn end_entry(&mut self) {
        *self = Self { open: self.open, is_list: self.is_list, ..Self::default() };
    }

    /// Whether entries begin in it: it is the text, or has braces.
    fn has_entries(&self, tokens: &[Token]) -> bool {
        self.open.is_none_or(|open| tokens[open].kind == TokenClass::Open(Delimiter::Brace))
    }
}

impl Structure {
    pub fn of(tokens: &[Token]) -> Self {
        let mut structure = Self { partner: (0..tokens.len()).collect(), ..Self::default() };
        let mut blocks = vec![Block::default()];
        for (place, token) in tokens.iter().enumerate() {
            if let TokenClass::Close(_) = token.kind {
                let open = blocks.pop().and_then(|block| block.open).expect("brackets are in pairs");
                structure.partner[open] = place;
                structure.partner[place] = open;
            }
            let block = blocks.last_mut().expect("the text is around all blocks");
            structure.around.push(block.open);
            structure.begins.push(block.has_entries(tokens) && !block.is_within);
            structure.is_unit.push(block.is_unit);
            if token.is_comment() || token.kind == TokenClass::Documentation {
                continue;
            }
            block.is_within = true;
            match token.kind {
                TokenClass::Word if block.head.is_none() && !token.is("pub") => block.head = Some(token.text),
                TokenClass::Mark => match token.text {
                    ";" => block.end_entry(),
                    "," if block.is_list => block.end_entry(),
                    ":" => block.is_unit = true,
                    "," | "=" => block.is_unit = false,
                    _ => {}
                },
                TokenClass::Open(_) => {
                    block.is_unit = false;
                    let is_list = block.head.is_some_and(|head| LISTS.contains(&head));
                    blocks.push(Block { open: Some(place), is_list, ..Block::default() });
                }
                TokenClass::Close(Delimiter::Brace) => {
                    let ends = block.head.is_none_or(|head| BLOCKS.contains(&head));
                    let next = tokens[place + 1..].iter().find(|token| !token.is_comment());
                    if ends && next.is_none_or(|next| !goes_on(next)) {
                        block.end_entry();
                    }
                }
                _ => {}
            }
        }
        structure
    }

    /// Whether the block that opens here has the statements of a graph or part.
    pub fn is_declaration(&self, open: usize) -> bool {
        self.around[open].is_none()
    }
}

/// Whether an entry goes on with this token after a block.
fn goes_on(next: &Token) -> bool {
    match next.kind {
        TokenClass::Mark => true,
        TokenClass::Word => next.is("else"),
        _ => false,
    }
}
