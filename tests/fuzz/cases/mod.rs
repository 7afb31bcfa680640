//! Random inputs for the macro's compiler and for the hacksaw's parameter reading, and what becomes of each.
//!
//! In: a [`Kind`], a seed and a number. Out: an [`Input`], the same on every machine, and its [`Outcome`]: accepted, or
//! refused with codes. A [`Violation`] is what must never be: a panic, a fault without a code or without a place in the
//! input, generated tokens that are no Rust, an expanded graph that is not accepted in its turn. The method is that of
//! Miller, Fredriksen, So 1990 (An empirical study of the reliability of UNIX utilities), with inputs that know the
//! grammar.

mod draw;
mod expression;
mod lexemes;
mod mechanism;
mod mutate;
mod network;
mod outcome;
mod settings;
mod shrink;
mod tally;
mod texts;
mod vocabulary;

use fastrand::Rng;

pub use lexemes::{joined, lexemes};
pub use outcome::{Outcome, Violation, examine};
pub use shrink::{fewest, shrink};
pub use tally::{Count, Tally};
pub use texts::{corpus, seeds};

/// What is made up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The language's words, numbers and marks in no order.
    Tokens,
    /// A valid text with a few of its tokens deleted, doubled, exchanged or replaced.
    Mutant,
    /// Junctions and elements that mostly make a valid graph.
    Network,
    /// Bodies, joints and scenes that mostly make a valid graph.
    Mechanism,
    /// A parameter file and `--set` texts.
    Settings,
}

/// Every kind, in the order of the tables.
pub const KINDS: [Kind; 5] = [Kind::Tokens, Kind::Mutant, Kind::Network, Kind::Mechanism, Kind::Settings];

/// How many of 400 inputs in a row are of each kind: what is dear is rare.
const SHARES: [u64; 5] = [180, 20, 32, 1, 167];

/// What is handed in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// The text of a macro call.
    Call(String),
    /// A parameter file's bytes and the texts after `--set`.
    Settings {
        /// The file.
        file: Vec<u8>,
        /// The texts.
        set: Vec<String>,
    },
}

impl Kind {
    /// The kind's name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tokens => "tokens",
            Self::Mutant => "mutant",
            Self::Network => "network",
            Self::Mechanism => "mechanism",
            Self::Settings => "settings",
        }
    }

    /// The kind of input `number` of a mixed run: in 400 in a row 180, 20, 32, 1 and 167 of the kinds in their order.
    #[must_use]
    pub fn of(number: u64) -> Self {
        // 37 and 400 have no common factor, so the kinds are spread and none is left out.
        let mut place = number % 400 * 37 % 400;
        for (kind, share) in KINDS.into_iter().zip(SHARES) {
            if place < share {
                return kind;
            }
            place -= share;
        }
        Self::Settings
    }

    /// Input `number` of this kind; `seeds` are what mutants are made of, not empty.
    #[must_use]
    pub fn input(self, seeds: &[String], seed: u64, number: u64) -> Input {
        // Knuth's multiplier (MMIX) keeps the streams of neighbouring numbers apart.
        let stream = (seed << 3 | self as u64).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(number);
        let mut rng = Rng::with_seed(stream.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        match self {
            Self::Tokens => Input::Call(vocabulary::disorder(&mut rng)),
            Self::Mutant => Input::Call(mutate::mutant(&mut rng, seeds)),
            Self::Network => Input::Call(network::network(&mut rng)),
            Self::Mechanism => Input::Call(mechanism::mechanism(&mut rng)),
            Self::Settings => settings::settings(&mut rng),
        }
    }
}

impl Input {
    /// The input as text, for messages and files.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Call(text) => text.clone(),
            Self::Settings { file, set } => {
                let set: String = set.iter().map(|text| format!("--set {text:?}\n")).collect();
                format!("{}\n{set}", String::from_utf8_lossy(file))
            }
        }
    }
}
