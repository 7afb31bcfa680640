//! Pictures of graphs that are made here, read back from their SVG.

mod support;

use bg_picture::{Bond, End, Graph, Level, Mark, Node, Part, marks};
use support::{Counts, Picture, faults, faults_in_words};

/// Nodes and bonds, added by name.
#[derive(Default)]
struct Maker(Graph);

impl Maker {
    fn part(&mut self, word: &str, name: &str) {
        self.0.parts.push(Part { word: word.into(), name: name.into() });
    }

    fn node(&mut self, kind: &str, name: &str) {
        let part = self.0.parts.iter().position(|part| Some(part.name.as_str()) == name.split('.').next());
        self.0.nodes.push(Node { kind: kind.into(), name: name.into(), part, ..Node::default() });
    }

    fn index(&self, name: &str) -> usize {
        self.0.nodes.iter().position(|node| node.name == name).unwrap_or_else(|| panic!("{name}"))
    }

    /// `a ->| b` or `a |-> b`; thick with `=`.
    fn bonds(&mut self, chains: &str) {
        for chain in chains.split(';').map(str::trim).filter(|chain| !chain.is_empty()) {
            let [from, arrow, to] = chain.split_whitespace().collect::<Vec<_>>()[..] else { panic!("{chain}") };
            let (from, to) = (self.index(from), self.index(to));
            let stroke = if arrow.starts_with('|') { End::From } else { End::To };
            let cardinality = if arrow.contains('=') { 3 } else { 1 };
            self.0.bonds.push(Bond { from, to, cardinality, stroke, effort: "N".into(), flow: "m/s".into() });
        }
    }
}

/// A row of bodies on joints, each of them held on the ground by a spring, as many as asked for.
fn mechanism(count: usize) -> Graph {
    let mut maker = Maker(Graph { name: "Row".into(), ..Graph::default() });
    maker.part("ground", "ground");
    maker.node("1", "ground.translation");
    maker.node("Sf", "ground.place");
    maker.bonds("ground.place |=> ground.translation");
    for number in 0..count {
        let body = format!("body{number}");
        let before = if number == 0 { "ground".to_owned() } else { format!("body{}", number - 1) };
        maker.part("body", &body);
        for (kind, name) in
            [("1", "translation"), ("1", "rotation"), ("I", "linear"), ("I", "angular"), ("Se", "weight")]
        {
            maker.node(kind, &format!("{body}.{name}"));
        }
        maker.bonds(&format!(
            "{body}.translation =>| {body}.linear; {body}.rotation =>| {body}.angular; \
            {body}.weight =>| {body}.translation"
        ));
        let pin = format!("pin{number}");
        maker.part("revolute z", &pin);
        for (kind, name) in [("0", "linear"), ("1", "slip"), ("MTF", "arm_b"), ("C", "spring"), ("R", "damper")] {
            maker.node(kind, &format!("{pin}.{name}"));
        }
        for (kind, name) in [("1", "x"), ("MTF", "x_axis"), ("C", "x_spring_of_the_joint"), ("R", "x_damper")] {
            maker.node(kind, &format!("{pin}.{name}"));
        }
        maker.bonds(&format!(
            "{before}.translation |=> {pin}.linear; {pin}.linear =>| {body}.translation; {pin}.slip =>| {pin}.linear;
             {pin}.linear =>| {pin}.arm_b; {pin}.arm_b =>| {body}.rotation; {pin}.slip |=> {pin}.spring;
             {pin}.slip |=> {pin}.damper; {pin}.slip |=> {pin}.x_axis; {pin}.x_axis |-> {pin}.x;
             {pin}.x |-> {pin}.x_spring_of_the_joint; {pin}.x |-> {pin}.x_damper"
        ));
        let spring = format!("spring{number}");
        maker.part("spring", &spring);
        maker.node("0", &format!("{spring}.linear"));
        maker.node("C", &format!("{spring}.spring"));
        maker.bonds(&format!(
            "ground.translation |=> {spring}.linear; {spring}.linear =>| {body}.translation;
             {spring}.linear |=> {spring}.spring"
        ));
    }
    maker.0
}

/// Junctions in a ladder with an element on each, without parts: many loops.
fn network(count: usize) -> Graph {
    let mut maker = Maker(Graph { name: "Ladder".into(), ..Graph::default() });
    for number in 0..count {
        maker.node(if number % 2 == 0 { "1" } else { "0" }, &format!("j{number}"));
        maker.node(["I", "C", "R", "Se"][number % 4], &format!("element_{number}"));
        maker.bonds(&format!("j{number} ->| element_{number}"));
        if number > 0 {
            maker.bonds(&format!("j{} ->| j{number}", number - 1));
        }
        if number > 3 && number % 3 == 0 {
            maker.bonds(&format!("j{} |-> j{number}", number - 4));
        }
    }
    maker.0
}

#[test]
fn a_mechanism_of_the_hacksaws_size_is_legible_and_says_what_the_tables_say() {
    let graph = mechanism(7);
    assert!(graph.nodes.len() >= 110 && graph.bonds.len() >= 120, "{} {}", graph.nodes.len(), graph.bonds.len());
    let svg = bg_picture::svg(&graph, Level::Full);
    assert_eq!(faults(&graph, &svg), [""; 0]);
    assert_eq!(bg_picture::svg(&graph, Level::Full), svg, "the same bytes again");
    let Counts { bonds, bends, crossings } = Picture::read(&svg).counts();
    println!("{bonds} bonds, {bends} bends, {crossings} crossings, {} bytes", svg.len());
    assert_eq!(faults_in_words(&graph, &bg_picture::svg(&graph, Level::Words)), [""; 0]);
}

#[test]
fn a_network_without_parts_is_legible() {
    for count in [2, 9, 60] {
        let graph = network(count);
        let svg = bg_picture::svg(&graph, Level::Full);
        assert_eq!(faults(&graph, &svg), [""; 0], "{count}");
        assert_eq!(svg, bg_picture::svg(&graph, Level::Words), "{count}: there are no parts");
    }
}

#[test]
fn a_node_with_many_bonds_has_room_for_them() {
    let mut maker = Maker::default();
    maker.node("1", "hub");
    for number in 0..30 {
        maker.node("R", &format!("resistor_{number}"));
        maker.bonds(&format!("hub |-> resistor_{number}"));
    }
    assert_eq!(faults(&maker.0, &bg_picture::svg(&maker.0, Level::Full)), [""; 0]);
}

#[test]
fn an_empty_graph_and_one_node_are_drawn() {
    let mut maker = Maker::default();
    assert!(bg_picture::svg(&maker.0, Level::Full).ends_with("</svg>\n"));
    maker.node("C", "<only> & \"one\"");
    let svg = bg_picture::svg(&maker.0, Level::Full);
    assert_eq!(faults(&maker.0, &svg), [""; 0]);
    assert!(svg.contains("&lt;only&gt; &amp; &quot;one&quot;"));
}

#[test]
fn storages_that_are_not_free_are_marked() {
    let mut maker = Maker::default();
    for (kind, name) in
        [("1", "a"), ("I", "m"), ("0", "between"), ("1", "b"), ("I", "n"), ("rSe", "hold"), ("1", "slip")]
    {
        maker.node(kind, name);
    }
    for (kind, name) in [("C", "free"), ("C", "tied"), ("I", "other"), ("1", "apart"), ("I", "slave"), ("Sf", "flow")] {
        maker.node(kind, name);
    }
    maker.bonds(
        "a ->| m; a |-> between; between ->| b; b ->| n; slip ->| between; slip |-> hold;
         a |-> free; tied |-> b; apart ->| other; apart |-> slave; flow |-> apart",
    );
    let graph = maker.0;
    let found = marks(&graph);
    let marked = |mark: Mark| -> Vec<&str> {
        graph.nodes.iter().zip(&found).filter(|(_, own)| **own == mark).map(|(node, _)| node.name.as_str()).collect()
    };
    assert_eq!(marked(Mark::Multiplier), ["m", "n"]);
    assert_eq!(marked(Mark::Derivative), ["tied", "slave"]);
    let svg = bg_picture::svg(&graph, Level::Full);
    assert_eq!(svg.matches("class=\"node storage multiplier\"").count(), 2);
    assert_eq!(svg.matches("class=\"node storage derivative\"").count(), 2);
    assert!(svg.contains("under a multiplier</text>") && svg.contains("derivative causality</text>"));
}

#[test]
fn bonds_between_two_parts_are_one_link_that_says_only_what_all_of_them_say() {
    let mut maker = Maker::default();
    maker.part("body", "rod");
    maker.part("revolute z", "pin");
    for (kind, name) in [("1", "rod.translation"), ("1", "rod.rotation"), ("0", "pin.linear"), ("0", "pin.angular")] {
        maker.node(kind, name);
    }
    maker.node("Se", "wind");
    maker.bonds("rod.translation |=> pin.linear; rod.rotation |=> pin.angular; wind ->| rod.translation");
    let svg = bg_picture::svg(&maker.0, Level::Words);
    for text in ["<g class=\"bond multi\" data-bond=\"0 1\"", "<g class=\"bond\" data-bond=\"2\"", "data-element=\"4\""]
    {
        assert!(svg.contains(text), "{text}");
    }
    assert_eq!((svg.matches("class=\"stroke\"").count(), svg.matches("class=\"arrow\"").count()), (2, 2));
    maker.bonds("pin.linear |=> rod.rotation");
    let svg = bg_picture::svg(&maker.0, Level::Words);
    assert_eq!((svg.matches("class=\"stroke\"").count(), svg.matches("class=\"arrow\"").count()), (1, 1));
}

#[test]
fn the_dot_text_has_strokes_half_arrows_clusters_and_double_lines() {
    let graph = mechanism(1);
    let dot = bg_picture::dot(&graph, Level::Full);
    let node = |name: &str| graph.nodes.iter().position(|node| node.name == name).expect("a node");
    let (place, translation) = (node("ground.place"), node("ground.translation"));
    let line = dot.lines().find(|line| line.starts_with(&format!("  n{place} -> n{translation} "))).expect("the bond");
    assert!(line.contains("arrowhead=rnormal, arrowtail=tee") && line.contains("black:invis:black"), "{line}");
    let (slip, linear) = (node("pin0.slip"), node("pin0.linear"));
    let line = dot.lines().find(|line| line.starts_with(&format!("  n{slip} -> n{linear} "))).expect("the bond");
    assert!(line.contains("arrowhead=teernormal, arrowtail=none"), "{line}");
    assert_eq!(dot.matches("subgraph cluster_").count(), graph.parts.len());
    assert_eq!(dot.matches('{').count(), dot.matches('}').count());
}

#[test]
fn a_graph_is_the_same_after_its_text() {
    let mut graph = mechanism(2);
    graph.nodes[3].law = "if v < 0 { 1 } else { 2 }".into();
    graph.nodes[3].states = vec!["p_x kg*m/s".into(), "p_y kg*m/s".into()];
    let text = graph.to_string();
    assert_eq!(text.parse(), Ok(graph));
    for (from, to) in
        [("\nbond\t0", "\nbond\t999"), ("\nnode\t0", "\nnode\t99"), ("\tto\t", "\tup\t"), ("graph\t", "x\t")]
    {
        assert!(text.replacen(from, to, 1).parse::<Graph>().is_err(), "{from:?}");
    }
}
