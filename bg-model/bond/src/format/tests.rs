use std::path::{Path, PathBuf};

use bg_compiler::pipeline::{self, Known};
use bg_compiler::source::syntax::{self, files};
use bg_compiler::tables::{self, Counted};
use proc_macro2::{TokenStream, TokenTree};

use super::formatted;

fn shown(text: &str) -> String {
    formatted(text).unwrap_or_else(|faults| panic!("{}\n{text}", faults[0]))
}

#[track_caller]
fn becomes(text: &str, expected: &str) {
    let formatted = shown(text);
    assert_eq!(formatted, expected, "\n{formatted}");
    assert_eq!(shown(&formatted), formatted);
}

#[test]
fn statements_have_lines_and_operators_blanks() {
    becomes(
        "use   \"a.bond\" ; pub(crate)   graph A{ /// Mass.\n param m:kg * m ^ 2/s^ -1=-2*3 ,above 0;1 j[3] : rotation \
         ;R r( w )=1e-3*w+tanh( w/0.1 )-( -w );a->j ->m; for i in 0 .. 3{ j->a [i-1] .hub; } }",
        "use \"a.bond\";
pub(crate) graph A {
    /// Mass.
    param m: kg*m^2/s^-1 = -2 * 3, above 0;
    1 j[3]: rotation;
    R r(w) = 1e-3 * w + tanh(w / 0.1) - (-w);
    a -> j -> m;
    for i in 0..3 { j -> a[i - 1].hub; }
}
",
    );
}

#[test]
fn blocks_stay_in_their_lines_or_have_lines() {
    becomes(
        "graph A {
joint p :revolute  z(a->b.c){stiffness 1 ;damping [ 1,2 , 3 ];}
  joint q: fixed (a -> b)
  {
stiffness 1; damping 1;
        tilt stiffness -k * (2 + k);}
observe{x:m=a.q ,y : m/s=b.flow}
body rod { start at [0,-1,0]; point end=[ -l/2,0,0 ]; inertia [[1,0,0],[0,1,0],[0,0,1]]; }
scene S { tune{a,b} rigid joints ;}
R r(v) = if v<0{ a*v }else if v<1 { 0 }
else { -v };
}",
        "graph A {
    joint p: revolute z (a -> b.c) { stiffness 1; damping [1, 2, 3]; }
    joint q: fixed (a -> b) {
        stiffness 1; damping 1;
        tilt stiffness -k * (2 + k);
    }
    observe { x: m = a.q, y: m/s = b.flow }
    body rod { start at [0, -1, 0]; point end = [-l / 2, 0, 0]; inertia [[1, 0, 0], [0, 1, 0], [0, 0, 1]]; }
    scene S { tune { a, b } rigid joints; }
    R r(v) = if v < 0 { a * v } else if v < 1 { 0 } else { -v };
}
",
    );
}

#[test]
fn comments_and_empty_lines_are_kept() {
    becomes(
        "// First.


/* second */ graph A { // third
        // fourth
    1 a; // fifth
      I i = /* sixth */ 2 // seventh
      ; /* eighth */ a -> i;

    /* a block
         of lines */

    let x = 1 +
    2 * // why
      3;


}
// last",
        "// First.

/* second */
graph A { // third
    // fourth
    1 a; // fifth
    I i = /* sixth */ 2 // seventh
        ; /* eighth */
    a -> i;

    /* a block
         of lines */

    let x = 1 +
        2 * // why
        3;
}
// last
",
    );
    assert_eq!(
        shown("// Nothing but words.\r\n\r\n\r\n\r\n// And more.\r\n"),
        "// Nothing but words.\r\n\r\n// And more.\r\n"
    );
    assert_eq!(shown(""), "");
}

#[test]
fn a_block_that_does_not_fit_is_opened() {
    let names: Vec<String> = (0..20).map(|k| format!("parameter_{k}")).collect();
    let text = format!("graph A {{\n    scene S {{ tune {{ {} }} expect planar; }}\n}}\n", names.join(", "));
    let lines: String = names.iter().map(|name| format!("            {name},\n")).collect();
    let lines = lines.replace("_19,", "_19");
    becomes(
        &text,
        &format!(
            "graph A {{\n    scene S {{\n        tune {{\n{lines}        }}\n        expect planar;\n    }}\n}}\n"
        ),
    );
    // A line without a block stays as it is.
    let long = format!("graph A {{\n    let a = {};\n}}\n", names.join(" + "));
    becomes(&long, &long);
}

#[test]
fn a_text_with_faults_is_refused() {
    for text in ["graph A {", "graph A { wheel w; }", "fn main() {}", "graph A { param m = 1; }"] {
        assert!(formatted(text).is_err(), "{text}");
    }
}

/// The texts of the language below a folder of the project: files, and calls in Rust.
fn texts(folder: &str, found: &mut Vec<(PathBuf, String)>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
    for entry in std::fs::read_dir(&folder).unwrap_or_else(|fault| panic!("{}: {fault}", folder.display())) {
        let path = entry.expect("an entry").path();
        let Some(end) = path.extension().and_then(|end| end.to_str()).map(str::to_owned) else { continue };
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        match end.as_str() {
            "bond" => found.push((path, text)),
            "rs" => {
                let tokens: TokenStream = text.parse().expect("Rust");
                calls(tokens, &text).into_iter().for_each(|text| found.push((path.clone(), text)));
            }
            _ => {}
        }
    }
}

/// What stands in the calls of the macro.
fn calls(tokens: TokenStream, text: &str) -> Vec<String> {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let call = |trees: &[TokenTree]| match trees {
        [TokenTree::Ident(name), _, TokenTree::Group(group)] if name == "bond_graph" => {
            Some(text[group.span_open().byte_range().end..group.span_close().byte_range().start].to_owned())
        }
        _ => None,
    };
    trees.windows(3).filter_map(call).collect()
}

fn examples() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for folder in
        ["tests/stages", "tests/fuzz/corpus", "bg-model/bond/src", "bg-model/workbench/examples", "hacksaw/src"]
    {
        texts(folder, &mut found);
    }
    found.retain(|(_, text)| !text.trim().is_empty() && !text.starts_with("file ") && formatted(text).is_ok());
    assert!(found.len() > 80, "only {} examples", found.len());
    found
}

/// The words and marks of a text.
fn words(text: &str) -> String {
    text.parse::<TokenStream>().expect("tokens").to_string()
}

#[test]
fn examples_keep_their_words_and_are_formatted_once() {
    for (path, text) in examples() {
        let once = shown(&text);
        assert_eq!(words(&once), words(&text), "{}", path.display());
        assert_eq!(shown(&once), once, "{}", path.display());
    }
}

#[test]
fn lines_and_blanks_in_disorder_come_to_rest_at_once() {
    // Line ends and blanks where any may stand: in place of each blank of the example.
    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bg-macros/compiler/src/source/syntax/tests/example.bond"),
    );
    let text = text.expect("the example");
    let mut state = 1_u64;
    for round in 0..200 {
        let disordered: String = text
            .lines()
            .map(|line| {
                let is_comment = line.contains("//");
                let mut replaced = |c: char| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    let choices = ["\n", "  ", " ", "\n\n\n", " /* c */ ", " // c\n"];
                    if c == ' ' && !is_comment {
                        choices[(state >> 33) as usize % choices.len()].to_owned()
                    } else {
                        c.to_string()
                    }
                };
                line.chars().map(&mut replaced).collect::<String>() + "\n"
            })
            .collect();
        let once = shown(&disordered);
        assert_eq!(words(&once), words(&text), "round {round}");
        assert_eq!(shown(&once), once, "round {round}:\n{disordered}");
        assert_eq!(once.matches("/* c */").count(), disordered.matches("/* c */").count());
        assert_eq!(once.matches("// c\n").count(), disordered.matches("// c\n").count());
    }
}

/// The tables of all models of a text; its faults where there are any.
fn compiled(text: &str) -> Vec<String> {
    let source = syntax::parse(files::alone(text).expect("tokens")).expect("no faults of syntax");
    match pipeline::models_where(&source, &|_| false) {
        Ok(known) => {
            let models =
                known.iter().filter_map(|known| if let Known::Model(model) = known { Some(model) } else { None });
            models.map(|model| format!("{:?}", tables::tables(model, Counted::All))).collect()
        }
        Err(faults) => faults.into_iter().map(|fault| format!("{} {}", fault.code, fault.message)).collect(),
    }
}

#[test]
fn examples_keep_their_meaning() {
    for (path, text) in examples() {
        // Places in messages are those of lines.
        let without_lines = |told: Vec<String>| -> Vec<String> {
            told.into_iter().map(|told| told.split(", first in line").next().unwrap_or_default().to_owned()).collect()
        };
        let (before, after) = (compiled(&text), compiled(&shown(&text)));
        assert!(without_lines(before) == without_lines(after), "{}", path.display());
    }
}
