//! Each fault once with its place and code, and what a faulty statement leaves of its neighbours.

use super::{faults, shown, tokens};
use crate::fault::{Explain, Fault};
use crate::source::syntax::{SyntaxFault, parse, parse_leniently};

/// The faults of statements that begin at line 2, column 1.
fn in_graph(text: &str) -> String {
    shown(&faults(&format!("graph G {{\n{text}\n}}")))
}

/// Sees to it that each statement has the one fault stated, as `line:column code message | help`.
fn check(cases: &[(&str, &str)]) {
    for (text, fault) in cases {
        assert_eq!(in_graph(text).trim_end(), *fault, "{text}");
    }
}

#[test]
fn unknown_words_have_a_near_miss_or_a_list() {
    check(&[
        ("bdy frame { }", "2:1 BG0101 `bdy` begins no statement of a graph | write `body`"),
        (
            "wheel x;",
            "2:1 BG0101 `wheel` begins no statement of a graph | write a word that begins one, such as `param`, `1`, \
            `R`, \
             `body`, `scene`",
        ),
        ("port p: rotation;", "2:1 BG0101 `port` begins no statement of a graph | write `part`"),
        ("scene S { obsrve { a } }", "2:11 BG0101 `obsrve` begins no statement of a scene | write `observe`"),
        ("body b { cubiod [1, 2, 3]; }", "2:10 BG0101 `cubiod` begins no statement of a body | write `cuboid`"),
        (
            "joint j: fixed (a -> b) { tilt stifness 1; }",
            "2:27 BG0101 `tilt stifness` begins no statement of a joint | write `tilt stiffness`",
        ),
        (
            "joint j: revolut z (a -> b);",
            "2:10 BG0111 found `revolut`, expected a joint kind: `revolute`, `prismatic`, `spherical`, `cylindrical`, \
             `universal`, `fixed` | write `revolute`",
        ),
        (
            "drive m on pin torqe = 1;",
            "2:16 BG0111 found `torqe`, expected what a drive prescribes: `torque`, `force`, `speed` | write `torque`",
        ),
        (
            "contact c (a -> b along x) { x: I = 1; }",
            "2:33 BG0111 found `I`, expected a contact's law: `C`, `R` | write one of `C`, `R`",
        ),
        (
            "scene S { expect planr; }",
            "2:18 BG0111 found `planr`, expected an expectation: `planar`, `states`, `independent`, `integral` | write \
            `planar`",
        ),
    ]);
}

#[test]
fn what_is_nearly_a_unit_is_told_in_arguments_vectors_and_parentheses() {
    let help = "found `degrees` after `90`, which is not a unit | write `90 deg`";
    for (text, column) in [
        ("let R = rotation_z(90 degrees);", 23),
        ("let v = [1, 90 degrees, 2];", 16),
        ("let a = 2 * (90 degrees);", 17),
    ] {
        assert_eq!(in_graph(text).trim_end(), format!("2:{column} BG0102 {help}"), "{text}");
    }
}

#[test]
fn two_comparisons_are_one_of_the_least_or_the_largest() {
    let both =
        "write `min(b - a, d - c) > 0`, which holds where both `a < b` and `c < d` do; of two units nest a second `if`";
    let one =
        "write `max(b - a, d - c) > 0`, which holds where `a < b` or `c < d` does; of two units chain a second `if`";
    for (text, column, found, help) in [
        ("let a = if t > 1 and t < 2 { 1 } else { 0 };", 18, "and", both),
        ("let a = if a < b < c { 1 } else { 2 };", 18, "<", both),
        ("let a = if a < b && b < c { 1 } else { 2 };", 18, "&&", both),
        ("let a = if a < b || c < d { 1 } else { 2 };", 18, "||", one),
        ("memory m: 1 = 2 while t < 1 or t > 2;", 29, "or", one),
        ("memory m: 1 = 2 while t < 1 & t > 2;", 29, "&", both),
    ] {
        let fault =
            format!("2:{column} BG0108 found `{found}` after a comparison: a condition is one comparison | {help}");
        assert_eq!(in_graph(text).trim_end(), fault, "{text}");
    }
}

#[test]
fn the_displacement_of_a_junction_has_no_start() {
    let fault = "BG0102 `slide.displacement` has no start: it counts from t = 0, where it is 0 | leave this out, and \
                 write `slide.displacement + E` with the start E where you use it";
    for text in ["start slide.displacement = 0.1;", "start slide.displacement at 0.1;"] {
        assert_eq!(in_graph(text).trim_end(), format!("2:7 {fault}"), "{text}");
    }
}

#[test]
fn unexpected_tokens_name_what_could_stand_there() {
    check(&[
        ("supply => a;", "2:8 BG0102 found `=>`, expected `->` | write `->`"),
        ("supply;", "2:7 BG0102 found `;`, expected `->` | write `->` here"),
        ("I L coil;", "2:5 BG0102 found `coil`, expected `=` | write `=` here"),
        ("I = 3;", "2:3 BG0102 found `=`, expected a name for the element | write a name for the element here"),
        ("I L = ;", "2:7 BG0102 found `;`, expected an expression | write an expression here"),
        ("let a = 2 w;", "2:11 BG0102 found `w`, expected an operator or `;` | write an operator, or `;` before `w`"),
        (
            "let a = b[];",
            "2:11 BG0102 found the end of the brackets, expected a whole number | write a whole number here",
        ),
        ("let a = b[1 / 2];", "2:13 BG0102 found `/`, expected `+`, `-` or `*` | write `+` here"),
        ("let a = b[1.5];", "2:11 BG0102 found `1.5`, expected a whole number | write a whole number here"),
        ("part a[n];", "2:7 BG0102 found `[ ... ]`, expected `{ ... }` or `;` | write `{ ... }`"),
        ("for i in 0..3; a -> b;", "2:14 BG0102 found `;`, expected `+`, `-` or `*` | write `+` here"),
        ("start rod up 3;", "2:11 BG0102 found `up`, expected `at`, `turned`, `velocity` or `spin` | write `at` here"),
        (
            "let a = b.0;",
            "2:11 BG0102 found `0`, expected a component such as `x` | write a component such as `x` here",
        ),
        ("let a = 1.0.x;", "2:12 BG0102 found `.`, expected an operator | write an operator here"),
        (
            "R r = 2 strat 1;",
            "2:9 BG0102 found `strat`, expected an operator, `in`, `at`, `start`, `energy`, `holds` or `;` | write \
            `start`",
        ),
        (
            "drive m on pin torque = 1 { damping 1; }",
            "2:27 BG0102 found `{ ... }`, expected `;`, since only a speed drive has a coupling | write `;` here",
        ),
        (
            "scene S { rigid jonts; }",
            "2:17 BG0102 found `jonts`, expected `joints` or `{ NAME, NAME }` | write `joints`",
        ),
        (
            "contact c (a -> b) { }",
            "2:18 BG0102 found the end of the parentheses, expected `along x` or a shape such as `circle 0.1` | write \
            `along x` here",
        ),
        ("body b { sphere; }", "2:16 BG0102 found `;`, expected `radius` | write `radius` here"),
        (
            "let a = if b { 1 } else { 2 };",
            "2:14 BG0102 found `{ ... }`, expected `<`, `<=`, `>` or `>=` | write `<` here",
        ),
    ]);
}

#[test]
fn a_missing_semicolon_is_at_the_last_token_and_costs_no_statement() {
    let fault = "2:7 BG0103 the statement that ends with `coil` has no `;` | write `;` after `coil`";
    check(&[("I L = coil", fault), ("I L = coil\nR Ra = 2;", fault), ("I L = coil\na -> b;", fault)]);
    let (source, _) = parse_leniently(tokens("graph G { I L = coil R Ra = 2; a -> b 1 c; input v: V param p: m = 1 }"));
    assert_eq!(source.graphs[0].items.len(), 6);
}

#[test]
fn expressions_have_neither_powers_nor_comparisons() {
    check(&[
        ("let a = w^2;", "2:10 BG0104 found `^`, which is no operator of an expression | write `pow(w, 2)`"),
        ("let a = -2 ** n;", "2:12 BG0104 found `**`, which is no operator of an expression | write `pow(2, n)`"),
        (
            "let a = if b < c { 1 };",
            "2:9 BG0106 this `if` has no `else`, so that it has no value where its condition fails | write `else { \
            ... }` \
             after its block",
        ),
        ("let a = if b < c { 1 } els { 2 };", "2:24 BG0102 found `els`, expected `else` | write `else`"),
        (
            "let a = b < c;",
            "2:11 BG0107 found `<` in a value, expected it only between `if` and `{` | write `if a < b { 1 } else { 0 \
            }`",
        ),
        (
            "let a = if a == b { 1 } else { 2 };",
            "2:14 BG0109 found `==`, expected `<`, `<=`, `>` or `>=` | compare with `<`, `<=`, `>` or `>=`",
        ),
    ]);
}

#[test]
fn units_are_products_of_powers() {
    for (unit, column, found) in [
        ("N.m", 11, "`.`"),
        ("N m", 12, "`m`"),
        ("m^x", 12, "`x`"),
        ("2", 10, "`2`"),
        ("m/", 13, "`=`"),
        ("(m)", 10, "`( ... )`"),
    ] {
        let fault = format!(
            "2:{column} BG0105 found {found} in a unit, expected symbols such as in `kg*m^2/s` | write unit symbols \
            joined by \
             `*` and `/`, with whole powers, or `1`"
        );
        check(&[(&format!("param a: {unit} = 1;"), &fault)]);
    }
}

#[test]
fn a_clause_stands_once() {
    check(&[
        ("R r = 1 start 2 start 3;", "2:17 BG0110 found a second `start`, expected one | remove one `start`"),
        (
            "param a: 1 = 1, above 0, at least 2;",
            "2:26 BG0110 found a second lower bound, expected one | remove one lower bound",
        ),
        (
            "body b { start at a; start B at c; }",
            "2:22 BG0110 found a second `start at`, expected one | remove one `start at`",
        ),
        ("scene S { rigid joints; rigid {} }", "2:25 BG0110 found a second `rigid`, expected one | remove one `rigid`"),
    ]);
}

#[test]
fn what_is_left_out_is_named() {
    let axis = "write `x`, `y` or `z` after";
    check(&[
        (
            "joint j: revolute (a -> b);",
            &format!("2:10 BG0112 found `( ... )` after `revolute`, expected an axis | {axis} `revolute`"),
        ),
        (
            "joint j: universal y w (a -> b);",
            &format!("2:22 BG0112 found `w` after `universal y`, expected an axis | {axis} `universal y`"),
        ),
        ("param a = 3;", "2:7 BG0113 the parameter `a` has no unit | write its unit after its name, such as `a: N*m`"),
        ("input v;", "2:7 BG0113 the input `v` has no unit | write its unit after its name, such as `v: N*m`"),
        ("param a: m;", "2:10 BG0114 the parameter `a` has no default | write `= NUMBER` after its unit"),
    ]);
}

#[test]
fn names_and_numbers_are_plain() {
    check(&[
        ("scene a.b {}", "2:7 BG0115 found `a.b`, expected a name without dots for the scene | write `a_b`"),
        (
            "body b { point p[1] = x; }",
            "2:16 BG0115 found `p[1]`, expected a name without dots for the point | write `p_1`",
        ),
        (
            "param type: m = 1;",
            "2:7 BG0116 found `type` as a name, which Rust reserves | write another name, such as `type_`",
        ),
        ("let a = 2.5f64;", "2:9 BG0117 found `2.5f64`, expected a decimal number without a suffix | write `2.5`"),
        (
            "let a = 1e999;",
            "2:9 BG0117 found `1e999`, which is beyond all floating-point numbers | write a number below 1.8e308",
        ),
        ("1 a[2];", "2:5 BG0119 found `2`, expected a cardinality of 1 or 3 | write `[3]` for a multibond junction"),
    ]);
    let deep = format!("let a = {}1{};", "(".repeat(100), ")".repeat(100));
    check(&[(&deep, "2:109 BG0118 the expression is nested deeper than 100 levels | name a part of it with `let`")]);
}

#[test]
fn comments_and_attributes_stand_where_they_mean_something() {
    let misplaced = "2:1 BG0120 only `graph`, `part`, `param`, `input` and `scene` have a documentation comment | \
    write `//` instead of `///`";
    check(&[
        ("/// A coil.\nI L = coil;", misplaced),
        ("/// Nothing.", misplaced),
        (
            "#[cfg(test)] I L = coil;",
            "2:1 BG0121 found an attribute, expected none: the language has no attributes | remove it",
        ),
    ]);
}

#[test]
fn a_call_has_graphs() {
    for (text, fault) in [
        ("", "1:1 BG0122 found no graph and no part, expected at least one | write `graph NAME { ... }`\n"),
        ("graf G {}", "1:1 BG0101 `graf` begins no statement of the macro call | write `graph`\n"),
        ("pub grph G {}", "1:5 BG0102 found `grph`, expected `graph` or `part` | write `graph`\n"),
        (
            "pub(all) graph G {}",
            "1:4 BG0102 found `( ... )`, expected `(crate)`, `(super)` or `(in PATH)` | write `(crate)` here\n",
        ),
        ("graph G", "1:7 BG0102 found the end of the macro call, expected `{ ... }` | write `{ ... }` here\n"),
    ] {
        assert_eq!(shown(&faults(text)), fault);
    }
}

#[test]
fn all_faults_are_reported_at_once_and_without_noise() {
    let text = "graph A {
    prm coil: H = 2e-3;
    param wire: Ohm;
    R r = w^2 + if w < 0 { 1 } else { 2 } + 3;
    body b { cuboid [1, 2, 3] 4; density; point P = 1 point Q = 2; strt at 3; }
    jont j: revolute z (a -> b) { stiffness 1; }
    scene S { observe { a b; c, = 3; d } expect planr; rigid joints }
    Q r = if w < 0 { 1 } else { 2 };
}
pub graph B { 1 a[4]; 1 b; }";
    let lines: Vec<String> =
        shown(&faults(text)).lines().map(|line| line[..line.find("BG").expect("a code") + 6].into()).collect();
    assert_eq!(
        lines,
        [
            "2:5 BG0101",
            "3:17 BG0114",
            "4:12 BG0104",
            "5:31 BG0102",
            "5:41 BG0102",
            "5:53 BG0103",
            "5:68 BG0101",
            "6:5 BG0101",
            "7:27 BG0102",
            "7:33 BG0102",
            "7:49 BG0111",
            "7:62 BG0103",
            "8:5 BG0101",
            "10:19 BG0119",
        ]
    );
}

#[test]
fn a_fault_is_the_stage_result() {
    let faults: Vec<Fault> = parse(tokens("graph G { 1 }")).expect_err("no name");
    let kind =
        SyntaxFault::Unexpected { found: "the end of a graph".into(), expected: "a name for the junction".into() };
    assert_eq!(
        (faults[0].code, faults[0].message.clone(), faults[0].help.clone()),
        (kind.code(), kind.message(), kind.help())
    );
}
