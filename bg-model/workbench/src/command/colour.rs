//! Whether help and faults are coloured: `--color auto|always|never`.
//!
//! In: the words of a command line, before they are parsed: help and what is wrong with them are coloured or not, too.
//! Out: the choice, which everything that is said follows from then on. Words that are no choice are the parser's to
//! refuse.

use std::ffi::OsString;

use clap::{ColorChoice, ValueEnum};

use crate::files::console;

/// The option.
const OPTION: &str = "--color";

/// What the words choose, the last of several. Where none does: on a terminal, unless the environment has `NO_COLOR`.
pub fn set(words: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let chosen = choice(words);
    console::set_colour(chosen);
    chosen
}

fn choice(words: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let mut chosen = ColorChoice::Auto;
    let mut is_next = false;
    for word in words {
        let word = word.to_string_lossy();
        let value =
            if is_next { Some(&*word) } else { word.strip_prefix(OPTION).and_then(|rest| rest.strip_prefix('=')) };
        if let Some(value) = value {
            chosen = ColorChoice::from_str(value, true).unwrap_or(chosen);
        }
        is_next = word == OPTION;
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_choice_counts() {
        let of = |line: &str| choice(line.split(' ').map(Into::into));
        assert_eq!(of("saw run --t-end 2"), ColorChoice::Auto);
        assert_eq!(of("saw --color always run --color=never"), ColorChoice::Never);
        assert_eq!(of("saw run --color=never --color always"), ColorChoice::Always);
        assert_eq!(of("saw --color blue --color"), ColorChoice::Auto);
    }
}
