//! What editors find: every name of a description, where it is declared and where it is used, stands at its place in
//! the generated code, and so do words and functions of the language, but nothing else.
//!
//! Names of the texts begin with `n_`. `tests/editor` asks rust-analyzer what it makes of this.

use std::collections::BTreeSet;

use bg_compiler::source::{functions, vocabulary};
use proc_macro2::{Ident, TokenStream, TokenTree};

/// Each kind of declaration, each way to name something.
const TEXT: &str = "
    part n_leg {
        param n_rate: N/m = 3;
        input n_push: N;
        body n_foot { mass 1; inertia [1, 1, 1]; point n_tip = [1, 0, 0]; }
        ground { point n_floor = [0, 0, 0]; }
        spring n_coil (ground.n_floor -> n_foot.n_tip) { stiffness n_rate; damping 1; length 0.1; }
        drive n_kick on n_foot.n_tip force = [n_push, 0, 0];
        port n_hip = n_foot.n_tip;
        observe { n_way: m = n_foot.position.x }
    }
    pub graph n_machine {
        /// Documented.
        param n_length: m = 0.6, above 0;
        param n_stiff: N/m = 2;
        input n_torque: N*m;
        let n_half = n_length / 2;
        ground { point n_pivot = [0, 1, 0]; }
        part n_left: n_leg { n_rate = n_stiff; start n_foot at [n_length, 0, 0]; }
        part n_row[2]: n_leg;
        body n_rod { cuboid [n_length, 0.03, 0.03] density 7850; point n_end = [-n_half, 0, 0]; \
        start n_end at [0, 1, 0]; }
        joint n_pin: revolute z (ground.n_pivot -> n_rod.n_end) {
            stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1;
        }
        joint n_ball[i in 0..2]: spherical (n_rod.n_end -> n_row[i].n_hip) { stiffness 1e3; damping 1; }
        drive n_motor on n_pin torque = n_torque;
        friction n_rub on n_pin { coulomb 0.1; }
        1 n_shaft: rotation; I n_wheel = 1; R n_loss(length) = 2 * length; Se n_source = 1;
        n_source -> n_shaft -> n_wheel; n_shaft -> n_loss;
        observe { n_angle: rad = n_rod.angle; n_row[1].n_way; n_left.n_way; all of n_left; n_shaft.flow; n_pin.force.x }
        scene n_still {
            observe { n_force: N = norm(n_pin.force) }
            tune { n_length, n_stiff }
            without { n_motor, n_rub }
            rigid { n_pin }
        }
    }";

/// Words with their places: line from 1, column from 0.
type Words = BTreeSet<(usize, usize, String)>;

/// The words of the text that begin with `n_`, and those that do not.
fn words(text: &str) -> (Words, Words) {
    let mut words = Words::new();
    for (line, text) in text.lines().enumerate() {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let starts = text.char_indices().filter(|&(at, c)| is_part(c) && !text[..at].ends_with(is_part));
        for (at, _) in starts {
            let end = text[at..].find(|c| !is_part(c)).map_or(text.len(), |end| at + end);
            words.insert((line + 1, at, text[at..end].to_owned()));
        }
    }
    words.into_iter().partition(|(.., word)| word.starts_with("n_"))
}

fn idents(tokens: TokenStream, found: &mut Vec<Ident>) {
    for tree in tokens {
        match tree {
            TokenTree::Ident(ident) => found.push(ident),
            TokenTree::Group(group) => idents(group.stream(), found),
            _ => {}
        }
    }
}

/// The words of the code for a text that stand at a place in that text.
fn placed(text: &str) -> Words {
    let mut found = Vec::new();
    idents(bg_compiler::compile(text.parse().expect("tokens")), &mut found);
    let at = |ident: &Ident| (ident.span().start(), ident.to_string());
    found.iter().map(at).filter(|(at, _)| at.line > 0).map(|(at, text)| (at.line, at.column, text)).collect()
}

#[test]
fn every_name_stands_at_its_place() {
    let (names, others) = words(TEXT);
    let placed = placed(TEXT);
    let missing: Vec<_> = names.difference(&placed).collect();
    assert!(names.len() > 75 && missing.is_empty(), "{missing:?}");
    let wrong: Vec<_> = placed.intersection(&others).map(|(.., word)| word.as_str()).collect();
    let members: BTreeSet<&str> = BTreeSet::from(["pub", "angle", "flow", "force", "position", "x"]);
    let is_known = |word: &str| {
        members.contains(word) || functions::named(word).is_some() || vocabulary::meaning("", word).is_some()
    };
    assert!(wrong.iter().all(|word| is_known(word)), "no words of the language: {wrong:?}");
    for word in ["norm", "stiffness", "revolute", "tune"] {
        assert!(wrong.contains(&word), "`{word}` has no place");
    }
}

#[test]
fn names_have_their_places_with_faults_too() {
    for (open, word) in [("n_pin.fo", "fo"), ("n_unknown", "n_unknown"), ("n_rod.", "n_rod")] {
        let text = TEXT.replace("n_pin.force.x", open);
        let (placed, at) = (placed(&text), text.find(open).expect("the open name") + open.find(word).unwrap_or(0));
        let missing: Vec<_> = words(&text).0.difference(&placed).map(|(.., word)| word.clone()).collect();
        assert!(missing.is_empty(), "{open}: {missing:?}");
        let line = text[..at].matches('\n').count() + 1;
        let column = at - text[..at].rfind('\n').map_or(0, |end| end + 1);
        assert!(placed.contains(&(line, column, word.to_owned())), "{open}: what may be at the caret is not read");
        let code = bg_compiler::compile(text.parse().expect("tokens")).to_string();
        let caret = code.find("at_caret").expect("a function for each part and graph");
        assert!(
            code.find("compile_error").is_some_and(|fault| caret < fault),
            "what is before the caret changes with it"
        );
    }
}

#[test]
fn rustc_is_told_nothing() {
    let code = bg_compiler::compile(TEXT.parse().expect("tokens")).to_string();
    let (_, anchors) = code.split_once("mod __bond_graph_names_of_n_machine {").expect("the module of the names");
    assert!(anchors.trim_start().starts_with("# [cfg (rust_analyzer)]"), "{}", &anchors[..80]);
    assert_eq!(anchors.matches("mod names").count(), 1);
}
