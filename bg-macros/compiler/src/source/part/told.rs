//! Faults of parts: each told once, with the use that it is in.
//!
//! In: the faults of all stages, the uses of all parts. Out: the same without those that another use has, too; a fault
//! inside of a part says in which use. Method: places in the source; of several uses, the one whose path the message
//! names.

use proc_macro2::{LineColumn, Span};

use super::flat::Placed;
use crate::fault::{Fault, Faults};

/// The faults, each once, with the use of the part that each is in.
pub(super) fn told(faults: Faults, uses: &[Placed]) -> Faults {
    let mut told: Vec<(String, LineColumn, String)> = Vec::new();
    let mut left = Faults::new();
    for fault in faults {
        let about = (fault.span.file(), fault.span.start(), format!("{} {}", fault.code, plain(&fault.message, uses)));
        if !told.contains(&about) {
            told.push(about);
            left.push(in_use(fault, uses));
        }
    }
    left
}

/// The fault with the use that it is in.
fn in_use(mut fault: Fault, uses: &[Placed]) -> Fault {
    let around: Vec<&Placed> = uses.iter().filter(|used| is_within(fault.span, used.within)).collect();
    let named = around.iter().find(|used| names(&fault.message, &used.path)).or_else(|| around.first());
    if let Some(used) = named {
        fault.message += &format!(", in part `{}`", used.shown());
    }
    fault
}

/// Whether a message names something in the part of this path.
fn names(message: &str, path: &str) -> bool {
    !path.is_empty() && message.contains(&format!("`{path}."))
}

/// The message without the paths of uses and without the numbers of arrays: what it says of every use.
fn plain(message: &str, uses: &[Placed]) -> String {
    let paths = uses.iter().filter(|used| !used.path.is_empty());
    let message = paths.fold(message.to_owned(), |text, used| text.replace(&format!("`{}.", used.path), "`"));
    let mut parts = message.split('[');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + "[" + part.trim_start_matches(|c: char| c.is_ascii_digit()))
}

/// Where the compiler of the macro call knows no places, as in an editor, nothing is within anything.
fn is_within(span: Span, within: Span) -> bool {
    within.start() != within.end()
        && span.file() == within.file()
        && span.start() >= within.start()
        && span.end() <= within.end()
}
