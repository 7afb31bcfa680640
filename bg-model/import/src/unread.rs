//! What of a file was not used: a note each, but for what changes no motion.
//!
//! In: what nobody has asked for ([`crate::xml::unread`]) and a format's [`Rule`]s. Out: sentences with the lines. An
//! element or attribute without a rule is a note, so that nothing is left out in silence.

use crate::xml::{FilePlace, Unread};

/// What is known of an element or attribute that is not used.
pub struct Rule {
    /// The element, or `*` for any.
    element: &'static str,
    /// The attribute, `*` for any; empty for the element itself.
    attribute: &'static str,
    verdict: Verdict,
}

#[derive(Clone, Copy)]
enum Verdict {
    /// It changes no motion.
    Harmless,
    /// It changes none where its numbers are all this one; else what is lost.
    Unless(f64, &'static str),
    /// What is lost.
    Told(&'static str),
}

/// Elements and attributes that change no motion; the reason is for the reader of the rules.
pub const fn harmless(element: &'static str, attribute: &'static str, _reason: &'static str) -> Rule {
    Rule { element, attribute, verdict: Verdict::Harmless }
}

/// One that changes no motion where its numbers are all `value`; else what is lost.
pub const fn unless(element: &'static str, attribute: &'static str, value: f64, lost: &'static str) -> Rule {
    Rule { element, attribute, verdict: Verdict::Unless(value, lost) }
}

/// One of which is known what is lost.
pub const fn told(element: &'static str, attribute: &'static str, lost: &'static str) -> Rule {
    Rule { element, attribute, verdict: Verdict::Told(lost) }
}

/// Lines that are written out; of more, only the number is given.
const LINES: usize = 4;

/// A sentence for each kind of thing that was not used.
pub fn notes(unread: &[Unread], rules: &[Rule]) -> Vec<String> {
    let mut kinds: Vec<(String, Vec<&FilePlace>)> = Vec::new();
    for thing in unread {
        let Some(lost) = lost(thing, rules) else { continue };
        let what = match &thing.attribute {
            Some((name, _)) => format!("`{name}` of <{}> is not used", thing.element),
            None => format!("<{}> in <{}> is not used", thing.element, thing.around),
        };
        let sentence = if lost.is_empty() { format!("{what}.") } else { format!("{what}: {lost}.") };
        match kinds.iter_mut().find(|(known, _)| *known == sentence) {
            Some((_, places)) if places.contains(&&thing.place) => {}
            Some((_, places)) => places.push(&thing.place),
            None => kinds.push((sentence, vec![&thing.place])),
        }
    }
    kinds.into_iter().map(|(sentence, places)| format!("{}: {sentence}", listed(&places))).collect()
}

/// What is lost with a thing; none where that is nothing.
fn lost(thing: &Unread, rules: &[Rule]) -> Option<&'static str> {
    let (name, value) = thing.attribute.as_ref().map_or(("", ""), |(name, value)| (name, value));
    let fits = |rule: &&Rule| {
        let is_element = rule.element == "*" || rule.element == thing.element;
        is_element && (rule.attribute == name || rule.attribute == "*" && !name.is_empty())
    };
    match rules.iter().find(fits).map(|rule| rule.verdict) {
        Some(Verdict::Harmless) => None,
        Some(Verdict::Unless(neutral, lost)) => {
            let is_neutral = value.split_whitespace().all(|word| word.parse() == Ok(neutral));
            (!is_neutral).then_some(lost)
        }
        Some(Verdict::Told(lost)) => Some(lost),
        None => Some(""),
    }
}

/// Places in one: "lines 3, 5 and 7".
fn listed(places: &[&FilePlace]) -> String {
    if let [place] = places {
        return place.to_string();
    }
    if places.iter().all(|place| place.file.is_none()) {
        let lines: Vec<String> = places.iter().take(LINES).map(|place| place.line.to_string()).collect();
        let more = places.len() - lines.len();
        return match (lines.split_last(), more) {
            (Some((last, first)), 0) => format!("lines {} and {last}", first.join(", ")),
            _ => format!("lines {} and {more} more", lines.join(", ")),
        };
    }
    format!("{} and {} more", places[0], places.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_rule_is_told_and_what_is_neutral_is_not() {
        let thing = |line, element: &str, attribute: Option<(&str, &str)>| Unread {
            element: element.to_owned(),
            around: "world".to_owned(),
            attribute: attribute.map(|(name, value)| (name.to_owned(), value.to_owned())),
            place: FilePlace { file: None, line },
        };
        let rules = [
            harmless("light", "", "seen only"),
            harmless("*", "user", "a user's own numbers"),
            unless("joint", "damping", 0.0, "it is lost"),
            told("plugin", "", "nobody knows it"),
        ];
        let unread = [
            thing(1, "light", None),
            thing(2, "joint", Some(("user", "1"))),
            thing(3, "joint", Some(("damping", "0 0"))),
            thing(4, "joint", Some(("damping", "0 2"))),
            thing(5, "flex", None),
            thing(6, "plugin", None),
            thing(7, "joint", Some(("new", "2"))),
            thing(9, "joint", Some(("new", "2"))),
        ];
        assert_eq!(
            notes(&unread, &rules),
            [
                "line 4: `damping` of <joint> is not used: it is lost.",
                "line 5: <flex> in <world> is not used.",
                "line 6: <plugin> in <world> is not used: nobody knows it.",
                "lines 7 and 9: `new` of <joint> is not used.",
            ]
        );
    }
}
