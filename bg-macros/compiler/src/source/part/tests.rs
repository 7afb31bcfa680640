//! What parts become, and what can be wrong with them.

use super::{flatten, flatten_leniently};
use crate::fault::Faults;
use crate::pipeline;
use crate::source::ast::{Item, Source};
use crate::source::syntax;

const LEG: &str = "part Leg {
    param stiffness: N/m = 2e4, above 0; param damping: N*s/m = 800, at least 0, at most 1e5;
    port hub: translation; port foot: translation;
    1 squeeze: translation; C spring = stiffness; R damper = damping; 0 leg: translation;
    foot -> leg -> hub; leg -> squeeze -> spring; squeeze -> damper;
    observe { length: m = spring.q; 2 * leg.effort }
}";

/// One leg under a mass.
const BONDS: &str = "Sf road = 1; road -> a.foot; a.hub -> top; 1 top: translation; I load = 3; top -> load;";

const BAR: &str = "part Bar {
    param length: m = 1;
    ground { point anchor = [length, 0, 0]; }
    body bar { mass 1; inertia [1, 1, 1]; point end = [length, 0, 0]; start at [9, 9, 9]; }
    joint pin: revolute z (ground.anchor -> bar.end) { rigid; }
    port tip = bar.end; port turn = pin.spin;
    observe { angle: rad = pin.angle; place: m = bar.position }
}";

fn parsed(text: &str) -> Source {
    syntax::parse(text.parse().expect("tokens")).unwrap_or_else(|faults| panic!("{}\n{text}", shown(&faults)))
}

fn shown(faults: &Faults) -> String {
    let line = |fault: &crate::fault::Fault| {
        let start = fault.span.start();
        format!("{}:{} {} {} | {}", start.line, start.column + 1, fault.code, fault.message, fault.help)
    };
    faults.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The statements of the only graph without parts.
fn flat(text: &str) -> Vec<String> {
    let flattened = flatten(&parsed(text)).unwrap_or_else(|faults| panic!("{}\n{text}", shown(&faults)));
    flattened.source.graphs[0].items.iter().map(Item::to_string).collect()
}

/// Where the faults of all stages stand, from line 1 of the text, and what they say.
fn faults(text: &str) -> String {
    pipeline::models(&parsed(text)).map_or_else(|faults| shown(&faults), |_| String::new())
}

/// The faults of a graph that uses the legs or the bars; its statements begin in line 1.
fn in_graph(statements: &str) -> String {
    faults(&format!("graph G {{ {statements} }}\n{LEG}\n{BAR}"))
}

#[test]
fn names_of_a_part_become_paths_and_others_stay() {
    let text =
        "part P { param k: 1 = 2; R r(v) = k * v * t * v.x + stored_energy + other.y; close gap = ground.A + k; }
        graph G { part p: P; }";
    assert_eq!(
        flat(text),
        [
            "param p.k: 1 = 2;",
            "R p.r(v) = p.k * v * t * v.x + stored_energy + p.other.y;",
            "close p.gap = ground.A + p.k;"
        ]
    );
}

#[test]
fn a_parameter_that_is_given_is_a_name_for_the_value_and_an_open_one_a_parameter() {
    let text = format!("{LEG} graph G {{ param k: N/m = 1; part a: Leg {{ stiffness = 2 * k; }} {BONDS} }}");
    let items = flat(&text);
    assert!(items.contains(&"let a.stiffness: N/m = 2 * k;".to_owned()), "{items:#?}");
    assert!(items.contains(&"param a.damping: N*s/m = 800, at least 0, at most 100000;".to_owned()), "{items:#?}");
}

#[test]
fn the_ends_of_a_range_are_asked_of_the_value() {
    let text = format!("{LEG} graph G {{ param r: N*s/m = 1; part a: Leg {{ damping = r; }} {BONDS} }}");
    let items = flat(&text);
    assert!(items.contains(&"let a.damping.below_upper: N*s/m = 100000 - a.damping;".to_owned()), "{items:#?}");
    let models = pipeline::models(&parsed(&text)).expect("no faults");
    let asked: Vec<_> = models[0].equations.requirements.list.iter().map(|asked| asked.subject.as_str()).collect();
    let of = |what: &str| format!("{what}the parameter `damping` of part `a: Leg`");
    let distance = of("the distance of ") + " from the upper end of its range, 100000,";
    assert!(asked.contains(&of("").as_str()) && asked.contains(&distance.as_str()), "{asked:?}");
}

#[test]
fn parts_stand_in_parts_without_and_with_names() {
    let text =
        "part A { param k: 1 = 1; let a = k; } part B { param m: 1 = 2; part inner: A { k = m; } part A; let b = k; }
        graph G { part x: B { m = 3; } }";
    assert_eq!(
        flat(text),
        [
            "let x.m: 1 = 3;",
            "let x.inner.k: 1 = x.m;",
            "let x.inner.a = x.inner.k;",
            "param x.k: 1 = 1;",
            "let x.a = x.k;",
            "let x.b = x.k;"
        ]
    );
    let open = "part A { param k: 1 = 1; let a = k; } part B { part inner: A; } graph G { part x: B { inner.k = 4; } }";
    assert_eq!(flat(open), ["let x.inner.k: 1 = 4;", "let x.inner.a = x.inner.k;"]);
}

#[test]
fn arrays_and_repetitions_have_numbers_in_brackets() {
    let text = "part A { param k: 1 = 1; let a = k; }
        graph G { part p[2]: A { k = 5 } let x[i in 0..2] = p[1 - i].a + i;
        for i in 0..2 { for j in i..2 { let y[2 * i + j] = x[j]; } } }";
    assert_eq!(
        flat(text),
        [
            "let p[0].k: 1 = 5;",
            "let p[0].a = p[0].k;",
            "let p[1].k: 1 = 5;",
            "let p[1].a = p[1].k;",
            "let x[0] = p[1].a + 0;",
            "let x[1] = p[0].a + 1;",
            "let y[0] = x[0];",
            "let y[1] = x[1];",
            "let y[3] = x[1];"
        ]
    );
}

#[test]
fn what_a_use_gives_to_parts_inside_may_have_indices() {
    let text = "part A { param k: 1 = 1; let a = k; } part B { part a[2]: A; }
        graph G { part b[i in 0..2]: B { a[1 - i].k = i; } }";
    assert_eq!(
        flat(text),
        [
            "param b[0].a[0].k: 1 = 1;",
            "let b[0].a[0].a = b[0].a[0].k;",
            "let b[0].a[1].k: 1 = 0;",
            "let b[0].a[1].a = b[0].a[1].k;",
            "let b[1].a[0].k: 1 = 1;",
            "let b[1].a[0].a = b[1].a[0].k;",
            "param b[1].a[1].k: 1 = 1;",
            "let b[1].a[1].a = b[1].a[1].k;"
        ]
    );
}

#[test]
fn bodies_start_where_the_user_puts_them_and_grounds_are_one() {
    let text = format!(
        "{BAR} graph G {{ ground {{ point O = [0, 0, 0]; }} part a: Bar {{ start bar.end at [1, 2, 3]; }} part b: Bar;
         start b.bar turned identity(); start b.tip at [4, 5, 6]; start a.bar spin [0, 0, 1]; }}"
    );
    let items = flat(&text).join("\n");
    for found in [
        "point O = [0, 0, 0];\n    point a.anchor = [a.length, 0, 0];\n    point b.anchor = [b.length, 0, 0];",
        "start end at [1, 2, 3];\n    start spin [0, 0, 1];",
        "start end at [4, 5, 6];\n    start turned identity();",
        "joint b.pin: revolute z (ground.b.anchor -> b.bar.end)",
    ] {
        assert!(items.contains(found), "{found}\n{items}");
    }
    assert_eq!(items.matches("ground {").count(), 1);
}

#[test]
fn a_port_is_a_junction_or_another_name() {
    let text = format!(
        "{BAR} part Arm {{ part inner: Bar; port end = inner.tip; }}
        graph G {{ part arm[2]: Arm; joint j: fixed (arm[0].end -> arm[1].end) {{ rigid; \
        }} let x = arm[1].inner.turn.flow; }}"
    );
    let items = flat(&text).join("\n");
    assert!(items.contains("(arm[0].inner.bar.end -> arm[1].inner.bar.end)"), "{items}");
    assert!(items.contains("let x = arm[1].inner.pin.spin.flow;"), "{items}");
}

#[test]
fn what_a_part_observes_is_there_under_its_path() {
    let text = format!(
        "{BAR} graph G {{ part a[2]: Bar; observe {{ a[0].angle; turn = 2 * a[1].angle; up = a[1].place.y; \
        all of a[1] }}
         scene S {{ observe {{ all of a; }} }} }}"
    );
    let items = flat(&text);
    let observed = items.iter().find(|item| item.starts_with("observe")).expect("observed");
    assert_eq!(
        observed.replace("\n    ", " "),
        "observe { a[0].angle: rad = a[0].pin.angle; turn = 2 * a[1].pin.angle; up = a[1].bar.position.y; \
         a[1].angle: rad = a[1].pin.angle; a[1].place: m = a[1].bar.position;\n}"
    );
    assert!(items.last().is_some_and(|scene| scene.matches(".angle: rad").count() == 2), "{items:#?}");
}

#[test]
fn all_of_a_word_is_what_its_table_lists_first() {
    let text = "graph G { ground { point O = [0, 0, 0]; } body b { mass 1; inertia [1, 1, 1]; }
        joint pin: cylindrical z (ground.O -> b) { rigid; } joint ball: spherical (ground.O -> b) { rigid; }
        1 j: translation; C c = k; observe all of b; observe { all of pin; all of ball; all of j; all of c } }";
    let items = flat(text);
    let observed: Vec<_> = items.iter().filter(|item| item.starts_with("observe")).collect();
    assert_eq!(*observed[0], "observe { b.position; b.orientation; b.momentum; b.angular_momentum }");
    assert_eq!(
        observed[1].replace("\n    ", " "),
        "observe { pin.force; pin.moment; pin.gap; pin.angle; pin.speed; pin.travel; ball.force; ball.gap; j.flow; \
        c.q; c.effort;\n}"
    );
}

#[test]
fn each_fault_is_at_its_token() {
    let known = "declare `part Log { ... }`, or write the path of a part of elsewhere, `self::Log`";
    for (statements, found) in [
        ("part a: Lag;", "1:19 BG0801 there is no part `Lag` | did you mean `Leg`?"),
        ("part a: Flywheel::Log;", "1:19 BG0801 there is no part `Flywheel::Log` | write the path of a `pub part`"),
        ("part a: Xylog;", &format!("1:19 BG0801 there is no part `Xylog` | {}", known.replace("Log", "Xylog"))),
        (
            "part b: Bar { lenght = 2 }",
            "1:25 BG0802 part `Bar` has no parameter or input `lenght` | did you mean `length`?",
        ),
        (
            "part a: Leg; a.hub -> a.foot; part b: Leg; b.hub -> a.hub;",
            "1:46 BG0804 nothing is bonded to the port `foot` of `b` | bond it, `b.foot -> ...;`",
        ),
        ("part a: Leg;", "1:16 BG0804 nothing is bonded to the ports `hub`, `foot` of `a` | bond it, `a.hub -> ...;`"),
        (
            "part b[3]: Bar; let x = b[3].pin.angle;",
            "1:35 BG0805 `b` has no [3]: its length is 3, from 0 to 2 | change the number, or the range of the index",
        ),
        (
            "part b[3]: Bar; let x[i in 0..3] = b[i - 1].pin.angle;",
            "1:46 BG0805 `b` has no [-1]: its length is 3, from 0 to 2 | change the number, or the range of the index",
        ),
        (
            "part b: Bar; let x = b[0].length;",
            "1:32 BG0806 `b` is no array | remove the brackets; a component of a vector is `b.x`",
        ),
        ("part b[3]: Bar; let x = b.length;", "1:35 BG0806 `b` is an array of 3 | say which one, such as `b[0]`"),
        (
            "part b[3]: Bar; let x = b[i].length;",
            "1:35 BG0807 `i` is no index of a repetition around it | write a whole number, or put the statement into \
             `for i in 0..20 { ... }`",
        ),
        (
            "for i in 0..2 { for i in 0..2 { let a[i] = 1; } }",
            "1:31 BG0807 `i` is the index of two repetitions, one inside of the other | give one of them another name",
        ),
        (
            "for i in 2..2 { let a[i] = 1; }",
            "1:23 BG0808 there is no number from 2 up to 2, not included | write the smaller number first: `0..20` are \
             the numbers from 0 to 19",
        ),
        ("for i in 0..20000 { let a[i] = 1; }", "1:23 BG0808 more than 10000 repetitions | make the range smaller"),
        (
            "part a: Leg { stiffness = -2; damping = 1e5 } Sf r = 1; r -> a.foot; a.hub -> a.foot;",
            "1:38 BG0810 the parameter `stiffness` of part `a: Leg` must be above 0 | change the value",
        ),
        (
            "part b: Bar; start b.bat at [0, 0, 0];",
            "1:30 BG0812 there is no body `b.bat` to start, and no point of this name | did you mean `b.bar`?",
        ),
        (
            "part b: Bar { start bar at [0, 0, 0]; } start b.bar.end at [0, 0, 0];",
            "1:57 BG0813 `start at` of `b.bar` is given twice | remove one of the two",
        ),
        ("part b: Bar; observe all of c;", "1:39 BG0814 nothing is called `c` | did you mean `b`?"),
        (
            "param a.b: 1 = 1; param a_b: 1 = 1;",
            "1:35 BG0809 `a_b` and `a.b` would both be the field `a_b` | give one of them another name",
        ),
    ] {
        let all = in_graph(statements);
        assert_eq!(all.lines().next().unwrap_or_default(), found, "{statements}\n{all}");
    }
}

#[test]
fn parts_that_contain_themselves_name_the_circle() {
    let found = faults("part A { part b: B; } part B { part c: C; } part C { part a: A; } graph G { part b: B; }");
    assert_eq!(
        found,
        "1:18 BG0803 part `B` contains itself: B -> C -> A -> B, in part `b.c.a: A` | take one of the uses out"
    );
}

#[test]
fn what_nothing_in_a_part_uses_is_a_fault_whether_the_part_is_used_or_not() {
    let part = "part A { param k: 1 = 1; input u: N; let a = 1; }";
    let found = "1:16 BG0811 nothing in part `A` uses its parameter `k`, in part `A` | remove it, or use it\n\
                 1:32 BG0811 nothing in part `A` uses its input `u`, in part `A` | remove it, or use it";
    assert_eq!(faults(part), found);
    assert_eq!(
        faults(&format!("{part} graph G {{ part x[3]: A; }}")),
        found.replace("in part `A` |", "in part `x[0]: A` |")
    );
}

#[test]
fn a_fault_in_a_part_is_told_once_and_names_a_use() {
    let text = "graph G { part x[20]: A; Se e = 1; for i in 0..20 { x[i].p -> x[(i)].p; } }";
    assert!(syntax::parse(text.parse().expect("tokens")).is_err(), "no parentheses in brackets");
    let part = "part A { param k: N = 1; port p: translation; I m = k; p -> m; }";
    let text =
        format!("{part}\ngraph G {{ part x[20]: A; Se e[i in 0..20] = 1; for i in 0..20 {{ e[i] -> x[i].p; }} }}");
    let found = faults(&text);
    assert_eq!(found.lines().count(), 1, "{found}");
    assert!(found.starts_with("1:53 BG0320 the law of I `x[0].m` has unit"), "{found}");
    assert!(found.contains(", in part `x[0]: A` | "), "{found}");
}

#[test]
fn a_fault_of_one_use_names_that_use() {
    // The mass of `b` follows from that of `a`: only there is the causality derivative.
    let part = "part A { param k: kg = 1; port p: translation; I m = k; p -> m; }";
    let text = format!(
        "{part}\ngraph G {{ expect integral causality; part a: A; part b: A; Se e = 1; e -> a.p; Sf f = 1; f -> b.p; }}"
    );
    let found = faults(&text);
    assert!(found.starts_with("1:50 BG0403 I `b.m`") && found.contains(", in part `b: A` | "), "{found}");
}

#[test]
fn a_wrong_unit_of_an_argument_is_at_the_argument() {
    let found = in_graph("param k: kg = 1; part b: Bar { length = k; }");
    assert!(found.starts_with("1:51 BG0316") && !found.contains("in part"), "{found}");
    let found = in_graph("part b: Bar { length = 2 * sin(t); }");
    assert!(found.contains("BG0323 the parameter `length` of part `b: Bar` depends on the time"), "{found}");
}

#[test]
fn a_part_that_no_graph_uses_is_looked_at_by_itself() {
    assert_eq!(faults(LEG), "");
    assert_eq!(faults(BAR), "");
    let found = faults("part A { port p: rotation; 1 open: rotation; R r = 2 * missing; p -> open -> r; }");
    assert_eq!(found, "1:56 BG0303 nothing is called `missing`, in part `A` | declare `missing`");
}

#[test]
fn an_output_of_a_part_may_have_the_name_of_something_in_it() {
    let text = "part A { param k: 1 = 1; let a = k; observe { k = 2 * a } }
        graph G { part x: A; let y = x.k; 1 j: translation; I m = 2; j -> m; observe { x.k; \
        z = y } scene S { observe { all of x } } }";
    assert_eq!(faults(text), "");
    let items = flat(text);
    assert!(items.contains(&"let y = x.k;".to_owned()), "an expression means the thing: {items:#?}");
    let observed = items.iter().filter(|item| item.contains("x.k = 2 * x.a")).count();
    assert_eq!(observed, 2, "`observe` means the output: {items:#?}");
}

#[test]
fn a_faulty_call_keeps_the_parameters_that_could_be_read() {
    let source = parsed("part A { param k: 1 = 1; let a = k; } graph G { part x: A; part y: B; part z: A { k = 1; } }");
    let (flattened, faults) = flatten_leniently(&source);
    assert_eq!(faults.len(), 1);
    let items: Vec<_> = flattened.source.graphs[0].items.iter().map(Item::to_string).collect();
    assert!(items.contains(&"param x.k: 1 = 1;".to_owned()), "{items:#?}");
}

/// Everything that a graph with parts becomes, up to names, is what it is without parts.
#[test]
fn a_graph_of_parts_has_the_equations_of_the_graph_written_out() {
    let of_parts = format!("{LEG} graph G {{ param k: N/m = 5; part a: Leg {{ stiffness = k; }} {BONDS} }}");
    let by_hand = "graph G { param k: N/m = 5; param a_damping: N*s/m = 800, at least 0, at most 1e5;
        1 a_hub: translation; 1 a_foot: translation;
        1 a_squeeze: translation; C a_spring = k; R a_damper = a_damping; 0 a_leg: translation;
        a_foot -> a_leg -> a_hub; a_leg -> a_squeeze -> a_spring; a_squeeze -> a_damper;
        Sf road = 1; road -> a_foot; a_hub -> top; 1 top: translation; I load = 3; top -> load; }";
    let stages = |text: &str| {
        let stages = crate::stages::stages(text.parse().expect("tokens")).expect("no faults");
        let all = stages.into_iter().filter(|stage| !["source", "expanded", "resolved"].contains(&stage.name));
        all.map(|stage| format!("{}\n{}", stage.name, stage.text)).collect::<String>()
    };
    let (left, right) = (stages(&of_parts).replace("a.", "a_"), stages(by_hand));
    let stiffness = left.replace("stiffness a_stiffness of", "stiffness k of");
    assert_eq!(stiffness, right);
}

#[test]
fn what_nothing_in_a_graph_uses_is_told_where_nothing_else_is_wrong() {
    const REST: &str = "Se s = 1; 1 a: translation; I m = 2; s -> a -> m; observe { a.flow }";
    let found = faults(&format!("graph A {{ param k: N = 1; input u: N; {REST} scene B {{ tune {{ k }} }} }}"));
    assert_eq!(
        found,
        "1:17 BG0811 nothing in graph `A` uses its parameter `k` | remove it, or use it\n\
         1:33 BG0811 nothing in graph `A` uses its input `u` | remove it, or use it"
    );
    // A law's variable of its name is that variable.
    assert!(faults(&format!("graph A {{ param v: N = 1; {REST} R r(v) = 2 * v; a -> r; }}")).contains("parameter `v`"));
    // An output of a scene uses it, and so does what is given to a part.
    assert_eq!(faults(&format!("graph A {{ param k: N = 1; {REST} scene B {{ observe {{ o = k }} }} }}")), "");
    let given = "part P { param j: N = 1; let i = j; }";
    assert_eq!(faults(&format!("graph A {{ param k: N = 1; {REST} part p: P {{ j = k; }} }}\n{given}")), "");
    // The misspelt name alone.
    let found = faults(&format!("graph A {{ param force: N = 1; {REST} Se t = forec; t -> a; }}"));
    assert!(found.contains("BG0303") && !found.contains("BG0811"), "{found}");
}

/// Each part has ten of the one before: a billion statements.
#[test]
fn parts_in_parts_end() {
    let part = |k: usize| format!("part P{k} {{ part p[10]: P{}; }}", k - 1);
    let parts: String = (1..9).map(part).collect();
    let text = format!("graph G {{ part p: P8; }} part P0 {{ let a = 1; }} {parts}");
    let faults = flatten(&parsed(&text)).expect_err("too many");
    let told: Vec<&str> = faults.iter().map(|fault| fault.message.as_str()).collect();
    assert_eq!(told, ["part `P5` has more than 20000 statements, with its repetitions and parts written out"]);
    // The limit can be another one, and what reaches it is none too many.
    let text = "graph G { for i in 0..99 { let a[i] = 1; } part p: P; } part P { let b = 1; }";
    let limited = |most| flatten(&Source { most: Some(most), ..parsed(text) });
    assert!(limited(101).is_ok());
    assert_eq!(limited(100).expect_err("one too many")[0].code, "BG0815");
    assert_eq!(limited(50).expect_err("many too many").len(), 1);
    // Nothing is repeated, or a fault, without end.
    let nested = |inside: &str| format!("graph G {{ for i in 0..9999 {{ for j in 0..9999 {{ {inside} }} }} }}");
    assert!(flatten(&parsed(&nested("for k in 0..9999 { }"))).is_ok());
    assert_eq!(flatten(&parsed(&nested("for k in 3..1 { let a[k] = 1; }"))).expect_err("no range")[0].code, "BG0808");
}
