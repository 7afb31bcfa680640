//! What the forms mean, and that printing and parsing are inverse.

use super::{EXAMPLE, bare, expression, grouped, items, parsed, shown};
use crate::fault::Fault;
use crate::source::ast::{Axis, ExpressionKind, Item, JunctionKind, Role, Shape};
use crate::source::syntax::{parse, parse_leniently};

/// What a text prints as.
fn printed(text: &str) -> String {
    parsed(text).to_string()
}

/// A statement as it is printed.
fn statement(text: &str) -> String {
    items(text).iter().map(Item::to_string).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_example_prints_as_text_that_prints_the_same() {
    let once = printed(EXAMPLE);
    assert_eq!(printed(&once), once);
    assert_eq!(bare(&parsed(&once)), bare(&parsed(EXAMPLE)));
}

#[test]
fn the_example_keeps_every_statement() {
    let source = parsed(EXAMPLE);
    let counts: Vec<usize> = source.graphs.iter().map(|graph| graph.items.len()).collect();
    assert_eq!(counts, [34, 27, 0]);
    assert_eq!(source.graphs[0].docs, "A direct-current motor.\n\n    with an indented line");
}

#[test]
fn canonical_statements_print_as_they_are_written() {
    for text in [
        "param decay: 1/m/s^2 = 1.5e-12, above -1, at most 2 * 3;",
        "param none: 1 = 0;",
        "input voltage: kg*m^2/s^3/A;",
        "let a.b: rad = -x * (y - z) / 2;",
        "1 a;",
        "0 pin.slip[3]: translation;",
        "R bearing(w) = 0.001 * w;",
        "R diode(effort u) = if u < 0 { 0 } else if u <= 1 { u } else { 1 } in R at x start 1 energy w;",
        "rSe pin.hold = 0 at q of pin along x;",
        "rSe hold = [0, 0, 0] of a.b;",
        "a -> b.c -> d;",
        "position x of pin.slip start [0, 1, 2];",
        "orientation turn of star;",
        "close pin = a - b;",
        "observe { a.h; b: m/s = c; d = 1 }",
        "gravity [0, -9.81, 0];",
        "start impulse;",
        "scenes only;",
        "expect integral causality;",
        "joint cross: universal x y (ground.O -> rod.B);",
        "drive push on frame.B force = [1, 0, 0];",
        "part front: Leg;",
        "part link[20]: other_crate::links::Link;",
        "part ::a::Leg;",
        "start front.bar.head at [0, 1, 2];",
        "start link[2].bar turned rotation_z(a);",
        "start rod spin [guess(0), guess(0), guess(0)];",
        "link[0].hub -> link[1].hub;",
        "1 node[2][1];",
        "1 node[2][3]: translation;",
        "let a = link[3].length * b[0].x;",
    ] {
        assert_eq!(statement(text), text);
    }
}

#[test]
fn a_bare_guess_of_a_motion_is_one_for_each_component() {
    let body = |motion: &str| statement(&format!("body b {{ mass 1; start velocity {motion}; start spin {motion}; }}"));
    assert_eq!(body("guess"), body("[guess(0), guess(0), guess(0)]"));
    assert_eq!(body("guess * 2").matches("[").count(), 0);
}

#[test]
fn blocks_print_one_statement_per_line() {
    let text = "graph G {
    contact cut (g.w -> f.b along x) {
        x: R(v) = v;
        y: C = k, R = r;
    }

    /// Seen.
    scene Paper {
        observe { a; b }
        tune { c, d }
        without { e }
        rigid joints;
        dependent { f, g }
        all reactions;
        expect planar;
        expect independent speeds;
        expect states = 29;
    }
}
";
    assert_eq!(printed(text), text);
}

#[test]
fn parts_print_as_they_are_written() {
    let text = "/// A leg.
pub part Leg {
    param stiffness: N/m = 2, above 0;

    port 1 hub: translation;

    port 0 node[3]: electrical;

    port tip = bar.tail;

    part inner: Foot {
        size = stiffness / 2;
        start bar at [0, 0, 0];
    }
}

graph G {
    for i in 1..2 * n - 1 {
        part link[i]: Leg;

        link[i - 1].hub -> link[i].hub;

        joint pin[i]: fixed (link[i - 1].tip -> link[i].tip) {
            rigid;
        }
    }

    observe { all of link; link[0].length }

    scene S {
        observe { all of link }
        tune all but { a, link[0].stiffness }
    }
}
";
    assert_eq!(printed(text), text);
}

#[test]
fn shorthands_of_parts_are_their_long_forms() {
    assert_eq!(
        statement("joint pin[i in 1..n]: fixed (a[i - 1] -> a[i]);"),
        "for i in 1..n {\n    joint pin[i]: fixed (a[i - 1] -> a[i]);\n}"
    );
    assert_eq!(statement("1 a[k in 0..2]: rotation;"), "for k in 0..2 {\n    1 a[k][1]: rotation;\n}");
    assert_eq!(statement("observe all of crank;"), "observe { all of crank }");
    assert_eq!(statement("scene S { tune all but a; }"), "scene S {\n    tune all but { a }\n}");
    assert_eq!(statement("part front: Leg { k = 2 }"), "part front: Leg {\n    k = 2;\n}");
    let port = |text: &str| {
        let source = parsed(&format!("part P {{ {text} }}"));
        source.parts[0].items[0].to_string()
    };
    assert_eq!(port("port hub: rotation;"), "port 1 hub: rotation;");
    assert_eq!(port("port wire: electrical;"), "port 0 wire: electrical;");
    assert_eq!(port("port 1 loop_[3]: electrical;"), "port 1 loop_[3]: electrical;");
}

#[test]
fn precedence_is_the_usual_one() {
    for (text, meaning) in [
        ("a + b * c", "(a+(b*c))"),
        ("a - b - c", "((a-b)-c)"),
        ("a - (b - c)", "(a-(b-c))"),
        ("a / b * c", "((a/b)*c)"),
        ("a / (b * c)", "(a/(b*c))"),
        ("-a * b", "((-a)*b)"),
        ("-(a * b)", "(-(a*b))"),
        ("a - -b", "(a-(-b))"),
        ("a * -2", "(a*-2)"),
        ("--a", "(-(-a))"),
        ("(a + b) * (c + d)", "((a+b)*(c+d))"),
    ] {
        let value = expression(text);
        assert_eq!(grouped(&value), meaning);
        assert_eq!(value.to_string(), text);
    }
}

#[test]
fn a_sign_is_part_of_its_number_and_prints_back_as_such() {
    assert!(matches!(expression("-2").kind, ExpressionKind::Number(value) if value == -2.0));
    let negated = expression("-(2)");
    assert!(matches!(negated.kind, ExpressionKind::Negate(_)));
    assert_eq!(negated.to_string(), "-(2)");
    assert_eq!(expression("-(-2)").to_string(), "--2");
    assert!(matches!(expression("--2").kind, ExpressionKind::Negate(_)));
}

#[test]
fn numbers_print_in_their_shortest_form_and_read_back_exactly() {
    for (text, shortest) in [
        ("2e-3", "0.002"),
        ("0.10", "0.1"),
        ("1_000", "1000"),
        ("1.", "1"),
        ("2.1e11", "2.1e11"),
        ("1e-7", "1e-7"),
        ("9007199254740993", "9007199254740992"),
        ("5e-324", "5e-324"),
        ("1.7976931348623157e308", "1.7976931348623157e308"),
        ("0", "0"),
        ("-0.0", "-0"),
    ] {
        assert_eq!(expression(text).to_string(), shortest);
    }
}

#[test]
fn an_if_is_an_operand_and_chains() {
    let text = "(if a < b { 1 } else { 2 }) + (if a >= b { 1 } else if c > 0 { 3 } else { 2 }) * 3";
    assert_eq!(expression(text).to_string(), text);
    assert_eq!(expression("if a < b { 1 } else { 2 } + 3").to_string(), "(if a < b { 1 } else { 2 }) + 3");
    assert_eq!(
        expression("if a < b { 1 } else { if c < d { 2 } else { 3 } }").to_string(),
        "if a < b { 1 } else if c < d { 2 } else { 3 }"
    );
}

#[test]
fn a_span_is_at_the_operator_the_function_or_the_name() {
    let at = |text: &str| {
        let span = expression(text).span;
        // `graph G { let value = ` has 22 characters.
        (span.start().column - 22, span.end().column - 22)
    };
    assert_eq!(at("aa + bb"), (3, 4));
    assert_eq!(at("pow(a, 2)"), (0, 3));
    assert_eq!(at("frame.R.x"), (0, 9));
    assert_eq!(at("[1, 2]"), (0, 6));
    assert_eq!(at("if a < b { 1 } else { 2 }"), (0, 2));
    assert_eq!(at("-a"), (0, 1));
}

#[test]
fn one_junction_statement_gives_an_item_per_name() {
    let kinds: Vec<(JunctionKind, String, usize, Option<String>)> = items("1 a, b[3]: rotation; 0 c[1];")
        .into_iter()
        .map(|item| match item {
            Item::Junction(j) => (j.kind, j.name.text, j.cardinality, j.domain.map(|domain| domain.text)),
            other => panic!("not a junction: {other}"),
        })
        .collect();
    assert_eq!(
        kinds,
        [
            (JunctionKind::One, "a".into(), 1, None),
            (JunctionKind::One, "b".into(), 3, Some("rotation".into())),
            (JunctionKind::Zero, "c".into(), 1, None),
        ]
    );
}

#[test]
fn clauses_stand_in_any_order_and_their_words_stay_names() {
    let written = statement("R at(effort flow) = start * flow energy energy start at in in_ at at;");
    assert_eq!(written, "R at(effort flow) = start * flow in in_ at at start at energy energy;");
    let Item::Element(element) = items("C effort(effort) = effort;").remove(0) else { panic!("not an element") };
    assert_eq!(element.variable.map(|variable| variable.role), Some(None));
    let Item::Element(element) = items("C c(flow q) = q;").remove(0) else { panic!("not an element") };
    assert_eq!(element.variable.map(|variable| variable.role), Some(Some(Role::Flow)));
}

#[test]
fn statement_words_can_be_junctions_of_a_chain() {
    assert_eq!(statement("R -> body -> scene.x;"), "R -> body -> scene.x;");
    assert_eq!(statement("observe -> x;"), "observe -> x;");
}

#[test]
fn a_cylinder_takes_its_clauses_in_any_order() {
    let Item::Body(body) = items("body b { cylinder along y at [0, 1, 2] length 2 radius 1; }").remove(0) else {
        panic!("not a body")
    };
    assert!(matches!(body.solids[0].shape, Shape::Cylinder { axis: Axis::Y, .. }));
    assert_eq!(body.solids[0].to_string(), "cylinder radius 1 length 2 along y at [0, 1, 2];");
}

#[test]
fn a_body_starts_at_its_origin_or_at_a_point() {
    let start = |text: &str| {
        let Item::Body(body) = items(&format!("body b {{ {text} }}")).remove(0) else { panic!("not a body") };
        body.start_position.map(|(point, place)| (point.map(|point| point.text), place.to_string()))
    };
    assert_eq!(start("start at p;"), Some((None, "p".into())));
    assert_eq!(start("start B at p;"), Some((Some("B".into()), "p".into())));
    assert_eq!(start("start spin at p;"), Some((Some("spin".into()), "p".into())));
    assert_eq!(start("start spin p;"), None);
}

#[test]
fn visibilities_print_as_written() {
    for text in ["graph G {}\n", "pub graph G {}\n", "pub(crate) graph G {}\n", "pub(in a::b) graph G {}\n"] {
        assert_eq!(printed(text), text);
    }
}

#[test]
fn a_fragment_of_another_macro_is_an_operand_of_its_own() {
    use proc_macro2::{Delimiter, Group, TokenTree};
    let sum: TokenTree = Group::new(Delimiter::None, "a + b".parse().expect("tokens")).into();
    let name: TokenTree = Group::new(Delimiter::None, "c".parse().expect("tokens")).into();
    let tokens = quote::quote! { graph G { let #name = 2 * #sum; } };
    let source = parse(tokens).unwrap_or_else(|faults| panic!("{}", shown(&faults)));
    assert_eq!(source.graphs[0].items[0].to_string(), "let c = 2 * (a + b);");
}

#[test]
fn what_could_be_read_has_all_names_that_the_stub_needs() {
    let text = "graph A { param a; param b: 1; param c: m = ^; input d; scene S } graph B { bdy x {} param e: 1 = 2; }";
    let (source, faults): (_, Vec<Fault>) = parse_leniently(super::tokens(text));
    assert_eq!(faults.len(), 6, "{}", shown(&faults));
    assert_eq!(
        source.to_string(),
        "graph A {\n    param a: 1 = 0;\n    param b: 1 = 0;\n    param c: m = 0;\n    input d: 1;\n\n    scene S \
        {}\n}\n\n\
         graph B {\n    param e: 1 = 2;\n}\n"
    );
}

#[test]
fn a_unit_after_a_number_reaches_as_far_as_symbols_do() {
    for (text, printed) in [
        ("75 mm", "75 mm"),
        ("-3 kN/mm * x", "(-3 kN/mm) * x"),
        ("2 m^2/s / t", "(2 m^2/s) / t"),
        ("1450 rpm + w", "(1450 rpm) + w"),
        ("5 N*m/rad", "5 N*m/rad"),
        ("3 N * (m)", "(3 N) * m"),
        ("2 * m", "2 * m"),
        ("[1 mm, 2 C, 3]", "[1 mm, 2 C, 3]"),
    ] {
        assert_eq!(expression(text).to_string(), printed);
        assert_eq!(expression(printed).to_string(), printed);
    }
}
