//! Parameters and inputs that nothing uses.
//!
//! In: a graph without parts. Out: a fault for each: a value given to it would change nothing. What a scene tunes is no use of it.

use std::collections::BTreeSet;

use crate::fault::{Explain, Fault, Faults};
use crate::source::ast::{ExpressionKind, Graph, Item, Name};
use crate::source::walk::{Met, each_name, walk};

/// The fault of a parameter or input that nothing uses.
#[derive(Clone, Debug)]
pub struct Unused {
    /// Where it is declared, such as "part `Leg`".
    pub of: String,
    /// "parameter" or "input".
    pub word: &'static str,
    /// Its name.
    pub name: String,
}

impl Explain for Unused {
    fn code(&self) -> &'static str {
        "BG0811"
    }

    fn message(&self) -> String {
        format!("nothing in {} uses its {} `{}`", self.of, self.word, self.name)
    }

    fn help(&self) -> String {
        "remove it, or use it".to_owned()
    }
}

/// What a statement declares that may be given a value.
pub(super) fn adjustable(item: &Item) -> Option<(&'static str, &Name)> {
    match item {
        Item::Parameter(parameter) => Some(("parameter", &parameter.name)),
        Item::Input(input) => Some(("input", &input.name)),
        _ => None,
    }
}

/// Every parameter and input of a graph is used in it or in a scene of it.
#[must_use]
pub fn check(graph: &Graph) -> Faults {
    let used = used(graph);
    let unused = graph.items.iter().filter_map(adjustable).filter(|(_, name)| !used.contains(&name.text));
    let of = format!("graph `{}`", graph.name.text);
    unused
        .map(|(word, name)| Fault::new(name.span, &Unused { of: of.clone(), word, name: name.text.clone() }))
        .collect()
}

/// The names in all expressions of a graph. One that is a law's variable is that variable.
fn used(graph: &Graph) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for mut item in graph.items.iter().cloned() {
        walk(&mut item, &mut |met| {
            let Met::Value(value, variable) = met else { return };
            each_name(value, &mut |value| {
                if let ExpressionKind::Name(name) = &value.kind
                    && variable != Some(name.text.as_str())
                {
                    used.insert(name.text.clone());
                }
            });
        });
    }
    used
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax::parse_leniently;

    fn said(text: &str) -> Vec<(usize, String)> {
        let (source, faults) = parse_leniently(text.parse().expect("tokens"));
        assert!(faults.is_empty(), "{faults:?}");
        check(&source.graphs[0]).into_iter().map(|fault| (fault.span.start().column, fault.message)).collect()
    }

    #[test]
    fn what_nothing_uses_is_told() {
        let found = said("graph A { param k: N = 1; input u: N; 1 a: translation; Se s = 1; s -> a; }");
        let expected = [
            (16, "nothing in graph `A` uses its parameter `k`".to_owned()),
            (32, "nothing in graph `A` uses its input `u`".to_owned()),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn any_expression_uses_what_it_names() {
        assert_eq!(said("graph A { param k: N = 1; Se s = 2 * k; }"), []);
        assert_eq!(said("graph A { param k: N = 1; scene B { observe { o = k } } }"), []);
        assert_eq!(said("graph A { param k: N = 1; R s(v) = if v < 0 { k } else { 0 }; }"), []);
    }

    #[test]
    fn neither_a_scene_that_tunes_it_nor_a_variable_of_its_name_uses_it() {
        assert_eq!(said("graph A { param k: N = 1; scene B { tune { k } } }").len(), 1);
        assert_eq!(said("graph A { param v: N = 1; R s(v) = 2 * v; }").len(), 1);
    }
}
