use bg_compiler::fault::Fault;
use bg_compiler::pipeline;
use bg_compiler::source::syntax;

const MARK: char = '▸';

/// All faults of the graph and its scenes, as the macro finds them.
fn faults(text: &str) -> Vec<Fault> {
    let source = syntax::parse(text.parse().expect("tokens")).expect("syntax");
    pipeline::models(&source).err().unwrap_or_default()
}

/// Line and column of the mark, from 1, and the text without it.
fn unmarked(text: &str) -> (String, String) {
    let at = text.find(MARK).expect("a mark");
    let line = text[..at].matches('\n').count() + 1;
    let column = text[..at].rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    (text.replace(MARK, ""), format!("{line}:{column}"))
}

const GRAPH: &str = "graph G {
param mass: kg = 2; param winding: N/m = 3; param aside: N = 0.1;
ground { point O = [0, 0, 0]; }
body bob { mass mass; inertia [0.1, 0.2, 0.3]; point top = [0, 1, 0]; start at [0, -1, 0]; start spin [0, 0, 1]; }
joint pivot: revolute z (ground.O -> bob.top) { stiffness 1e4; tilt stiffness 1e3; }
spring band (ground.O -> bob) { stiffness winding; length 0.5; }
observe { p: m = bob.position; }
";

/// Statements after those of `GRAPH`, in its sixth line and on; then what the one fault says.
const CASES: [(&str, &str); 14] = [
    ("scene A {}\nscene ▸A {}", "[BG0601] there are two models called `A`\nhelp: give one of them another name"),
    ("scene ▸G {}", "[BG0601] there are two models called `G`\nhelp: give one of them another name"),
    (
        "scene ▸GParameters {}",
        "[BG0601] `GParameters` would be a model and the parameters of `G`\nhelp: give one of the two models another \
        name",
    ),
    (
        "scene A {\n    without { band, ▸pivott }\n}",
        "[BG0602] there is no `pivott` to leave out\nhelp: did you mean `pivot`?",
    ),
    (
        "scene A { without ▸engine; }",
        "[BG0602] there is no `engine` to leave out\nhelp: name a joint, contact, spring, drive, friction, stop or \
        element",
    ),
    (
        "scene A { tune { mass, ▸windng } }",
        "[BG0603] there is no parameter `windng` to tune\nhelp: did you mean `winding`?",
    ),
    (
        "scene A { tune ▸voltage; }",
        "[BG0603] there is no parameter `voltage` to tune\nhelp: name a parameter of the graph",
    ),
    (
        "drive push on bob force = [0, 0, aside];\nscene A { expect ▸planar; }",
        "[BG0604] scene `A` is not planar: these are not proved constant: bob.position_z, bob.orientation_31, \
         bob.orientation_32, bob.orientation_33\nhelp: find what moves them: a tuned parameter out of the plane, a \
         start value, a force",
    ),
    (
        "scene A { expect planar; expect states = ▸8; }",
        "[BG0605] scene `A` integrates 7 states, not 8: bob.position_x, bob.position_y, bob.orientation_11, \
         bob.orientation_12, bob.linear.p_x, bob.linear.p_y, bob.angular.p_z\nhelp: correct the number, or what the \
         scene watches and tunes",
    ),
    ("scene A { rigid { ▸pivo } }", "[BG0606] there is no joint `pivo` to make rigid\nhelp: did you mean `pivot`?"),
    (
        "scene A { rigid { ▸band } }",
        "[BG0606] there is no joint `band` to make rigid\nhelp: name a joint of the graph, or write `rigid joints;`",
    ),
    (
        "scene A { expect ▸independent speeds; }",
        "[BG0611] scene `A` keeps the reactions of all rigid joints: no joint is rigid\nhelp: make joints rigid: \
         `rigid joints;`",
    ),
    (
        "scene A { rigid joints; all reactions; expect ▸independent speeds; }",
        "[BG0611] scene `A` keeps the reactions of all rigid joints: the scene says `all reactions;`\nhelp: leave out \
         `all reactions;`",
    ),
    (
        "scene A { rigid joints; expect ▸independent speeds; }",
        "[BG0611] scene `A` keeps the reactions of all rigid joints: start velocities may tear joint `pivot`\nhelp: \
         make its start velocities guesses, or give those of both bodies so that they fit",
    ),
];

#[test]
fn each_fault_of_a_scene_has_its_place_and_its_words() {
    for (statements, expected) in CASES {
        let (text, place) = unmarked(&format!("{GRAPH}{statements}\n}}"));
        let found: Vec<String> = faults(&text)
            .iter()
            .map(|fault| format!("{}:{} {fault}", fault.span.start().line, fault.span.start().column + 1))
            .collect();
        assert_eq!(found, [format!("{place} {expected}")], "{statements}");
    }
}

#[test]
fn faults_of_a_scene_s_lists_come_at_once() {
    let text = format!(
        "{GRAPH}scene A {{ without {{ engine }} rigid {{ wheel }} }}\nscene A {{}}\nscene B {{ without {{ engine }} \
        }}\n}}"
    );
    let codes: Vec<_> = faults(&text).iter().map(|fault| fault.code).collect();
    assert_eq!(codes, ["BG0601", "BG0602", "BG0606", "BG0602"]);
    let text = format!("{GRAPH}scene A {{ expect planar; expect states = 3; expect states = 4; }}\n}}");
    let codes: Vec<_> = faults(&text).iter().map(|fault| fault.code).collect();
    assert_eq!(codes, ["BG0605", "BG0605"]);
}

#[test]
fn a_scene_may_watch_only_what_there_is() {
    let text = format!("{GRAPH}scene A {{ observe {{ bob.positon }} }}\n}}");
    let found = faults(&text);
    assert_eq!(found.iter().map(|fault| fault.code).collect::<Vec<_>>().len(), 1);
    assert_eq!((found[0].span.start().line, found[0].span.start().column), (8, 20));
}
