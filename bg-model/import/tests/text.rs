//! The text that files become, and what is said of those that become none.
//!
//! Each file of `cases` with its text beside it, which `swing.rs` compiles. `RENEW=1 cargo test -p bg-import --test
//! text` writes the texts anew: read the difference.

use std::path::{Path, PathBuf};

use bg_compiler::pipeline;
use bg_compiler::source::syntax;
use bg_import::{Format, Imported, Options, import};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

/// The options of the texts that `swing.rs` runs: nothing from outside.
const PLAIN: Options = Options {
    free_base: false,
    keep_fixed: false,
    compliant: false,
    drives: false,
    limits: true,
    contacts: true,
    actuators: false,
    strict: false,
};

fn is_the_text(file: &str, text: &str, options: Options) {
    let format = if file.ends_with(".urdf") { Format::Urdf } else { Format::Mjcf };
    let source = std::fs::read_to_string(folder().join(file)).expect("the case is there");
    let made = import(format, file, &source, options).expect("the case is a robot").text;
    let path = folder().join(text);
    if std::env::var_os("RENEW").is_some() {
        std::fs::write(&path, &made).expect("the text can be written");
    }
    let wanted = std::fs::read_to_string(&path).expect("the text is there");
    assert!(made == wanted, "{text} is another one:\n{made}");
}

/// The tokens inside of `bond_graph! { .. }`.
fn tokens(text: &str) -> proc_macro2::TokenStream {
    let start = text.find("\nbond_graph! {").expect("there is a graph") + "\nbond_graph! {".len();
    let end = text.rfind('}').expect("it ends");
    text[start..end].parse().expect("tokens")
}

fn compiles(text: &str) {
    let source = syntax::parse(tokens(text)).unwrap_or_else(|faults| panic!("{faults:?}\n{text}"));
    if let Err(faults) = pipeline::models(&source) {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        panic!("{}\n{text}", faults.join("\n"));
    }
}

/// That there is no note, and a text has words, and has others not.
fn has(imported: &Imported, words: &[&str], others: &[&str]) {
    assert_eq!(imported.notes, [""; 0], "{}", imported.text);
    for word in words {
        assert!(imported.text.contains(word), "no `{word}` in\n{}", imported.text);
    }
    for word in others {
        assert!(!imported.text.contains(word), "`{word}` in\n{}", imported.text);
    }
}

/// The same of one that compiles.
fn compiles_with(imported: &Imported, words: &[&str], others: &[&str]) {
    has(imported, words, others);
    compiles(&imported.text);
}

#[path = "text/actuators.rs"]
mod actuators;
#[path = "text/attach.rs"]
mod attach;
#[path = "text/fitted.rs"]
mod fitted;
#[path = "text/kinds.rs"]
mod kinds;
#[path = "text/program.rs"]
mod program;
#[path = "text/safety.rs"]
mod safety;
#[path = "text/tendons.rs"]
mod tendons;

#[test]
fn a_urdf_with_skew_axes_and_merged_links() {
    is_the_text("double_pendulum.urdf", "double_pendulum.rs", PLAIN);
}

#[test]
fn an_mjcf_of_shapes_classes_and_turned_frames() {
    is_the_text("crane.xml", "crane.rs", PLAIN);
}

#[test]
fn an_mjcf_of_springs_dampers_and_a_joint_that_follows() {
    is_the_text("features.xml", "features.rs", PLAIN);
}

#[test]
fn loops_hinges_in_a_row_and_links_without_mass() {
    is_the_text("linkage.xml", "linkage.rs", Options::default());
    compiles(&std::fs::read_to_string(folder().join("linkage.rs")).expect("the text is there"));
}

#[test]
fn every_option_gives_a_text_that_compiles() {
    let urdf = std::fs::read_to_string(folder().join("double_pendulum.urdf")).expect("the case is there");
    let options = Options { free_base: true, keep_fixed: true, compliant: true, limits: false, ..Options::default() };
    let text = import(Format::Urdf, "double_pendulum.urdf", &urdf, options).expect("a robot").text;
    compiles(&text);
    let has = |words: &str| assert!(text.contains(words), "no `{words}` in\n{text}");
    has("joint forearm_to_tool: fixed (forearm.forearm_to_tool -> tool) {");
    has("stiffness joint_stiffness; damping joint_damping; tilt stiffness joint_tilt_stiffness;");
    has("scene DoublePendulumRigid {\n            rigid joints;");
    has("drive elbow_motor on elbow torque = elbow_torque;");
    has("body world {\n            mass 5;");
    assert!(!text.contains("stop "));
}

/// What is said of a URDF.
fn told(text: &str) -> String {
    match import(Format::Urdf, "robot.urdf", text, Options::default()) {
        Ok(imported) => [imported.notes, imported.remarks].concat().join(" "),
        Err(fault) => fault.to_string(),
    }
}

/// Two links and a joint of a type, with something in it.
fn arm(link: &str, kind: &str, joint: &str) -> String {
    format!(
        "<robot name='r'>\n<link name='a'/>\n<link name='b'>{link}</link>\n<joint name='j' type='{kind}'>\
         <parent link='a'/><child link='b'/>{joint}</joint></robot>"
    )
}

/// A link's mass and moments.
const MASS: &str = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>";

#[test]
fn what_is_wrong_with_a_urdf_is_told_with_its_line() {
    let cases = [
        ("<robot".to_owned(), "not XML: the document does not have a root node"),
        (
            "<mujoco/>".to_owned(),
            "the file begins with <mujoco>, not with <robot>: give a URDF, or use `mjcf` for MuJoCo's XML",
        ),
        (
            "<robot xmlns:xacro='http://ros.org/xacro'>\n<xacro:leg/></robot>".to_owned(),
            "line 2: <xacro:leg> is not read here: run `xacro FILE` first and give its result",
        ),
        ("<robot/>".to_owned(), "line 1: <robot> has no `link`: add it"),
        (arm("<inertial/>", "fixed", ""), "line 3: <inertial> has no `mass`: add it"),
        (
            arm("<inertial><mass value='heavy'/></inertial>", "fixed", ""),
            "line 3: `value` of <mass> is \"heavy\": it must be a number",
        ),
        (
            arm("<inertial><mass value='-1'/></inertial>", "fixed", ""),
            "line 3: `value` of <mass> is \"-1\": it must be 0 or more",
        ),
        (arm(MASS, "fixed", "<origin xyz='1 2'/>"), "line 4: `xyz` of <origin> is \"1 2\": it must be 3 numbers"),
        (
            arm(MASS, "hinge", ""),
            "line 4: `type` of <joint> is \"hinge\": it must be revolute, continuous, prismatic, fixed, floating or \
            planar",
        ),
        (
            arm(MASS, "continuous", "<axis xyz='0 0 0'/>"),
            "line 4: `axis` of <joint> is \"0 0 0\": it must be a direction, not zero",
        ),
        (
            arm(MASS, "fixed", "").replace("parent link='a'", "parent link='c'"),
            "line 4: there is no link `c`: check the spelling",
        ),
        (arm(MASS, "fixed", "").replace("name='b'", "name='a'"), "line 3: a second link `a`: rename one of the two"),
        (
            arm(MASS, "fixed", "").replace("parent link='a'", "parent link='b'"),
            "`b` carry each other in a ring: the joints of a URDF are a tree with one root",
        ),
        (
            arm(MASS, "fixed", "").replace("</robot>", "<link name='c'/></robot>"),
            "`a` and `c` are roots: the joints of a URDF are a tree with one root",
        ),
        (
            arm(MASS, "revolute", "<limit lower='1' upper='2'/>"),
            "Joint `j` starts at 1.5, inside of its limits: 0 is outside.",
        ),
        (
            arm(&MASS.replace("izz='1'", "izz='4'"), "continuous", ""),
            "Link `b` has moments of inertia that no body has: here all are 2 kg*m^2.",
        ),
        (
            arm(MASS, "continuous", "").replace(
                "</robot>",
                "<link name='c'/><joint name='k' type='continuous'><parent link='b'/><child link='c'/></joint></robot>",
            ),
            "Link `c` has no mass and carries nothing: it is left out with joint `k`.",
        ),
    ];
    for (text, message) in cases {
        assert_eq!(told(&text), message, "{text}");
    }
}

#[test]
fn what_is_wrong_with_an_mjcf_is_told_with_its_line() {
    let body = |inner: &str| format!("<mujoco><worldbody>\n<body name='b'>{inner}</body></worldbody></mujoco>");
    let cases = [
        (
            "<robot/>".to_owned(),
            "the file begins with <robot>, not with <mujoco>: give an MJCF file, or use `urdf` for a URDF",
        ),
        (
            body("<include file='x'/>"),
            "line 2: <include> is not read here: import the file from its folder, where the included one is",
        ),
        ("<mujoco/>".to_owned(), "line 1: <mujoco> has no `worldbody`: add it"),
        (
            body("<joint type='screw'/>"),
            "line 2: `type` of <joint> is \"screw\": it must be free, ball, slide or hinge",
        ),
        (body("<joint axis='0 0 0'/>"), "line 2: `axis` of <joint> is \"0 0 0\": it must be a direction, not zero"),
        (body("<joint/><inertial mass='1'/>"), "line 2: <inertial> has no `diaginertia`: add it"),
        (body("<geom quat='0 0 0 0'/>"), "line 2: `quat` of <geom> is \"0 0 0 0\": it must be not zero"),
        (body("<body name='b'/>"), "line 2: a second body `b`: rename one of the two"),
        (
            body("").replace("</mujoco>", "<equality>\n<weld body1='b' body2='c'/></equality></mujoco>"),
            "line 3: there is no body `c`: check the spelling",
        ),
    ];
    for (text, message) in cases {
        let fault = import(Format::Mjcf, "robot.xml", &text, Options::default()).expect_err(&text);
        assert_eq!(fault.to_string(), message, "{text}");
    }
}
