//! Parts of other models and copies have the names, classes and settings that MuJoCo 4.0.0 gives them.

use bg_import::{Format, Imported, Options, import, import_file};

use super::kinds::NO_CONTACTS;
use super::program::folder;
use super::{compiles, has};

const ASKED: Options = Options { actuators: true, ..NO_CONTACTS };

/// A model of two bodies, one in the other, and a third one.
const CHILD: &str = "<mujoco model='child'><compiler angle='radian' boundmass='1.5'/>\n\
    <default><joint damping='2'/><default class='a'><joint armature='3'/></default></default>\n\
    <worldbody><geom size='0.3' mass='7'/><frame name='far' pos='0 0 5'>\
    <body name='arm' childclass='a' pos='1 0 0' euler='0 0 1.5707963267948966'>\
    <joint name='j' range='-1 1' class='main'/><geom size='0.1' mass='1'/>\n\
    <body name='hand' pos='0 0 1'><joint name='k'/><geom size='0.1' mass='2'/></body></body></frame>\
    <body name='other' pos='9 0 0'><joint name='o'/><geom size='0.1' mass='5'/></body></worldbody>\n\
    <actuator><motor name='m' joint='j' gear='3'/><motor name='mo' joint='o'/></actuator>\
    <equality><joint name='e' joint1='j' joint2='k'/><weld body1='hand' body2='other'/></equality></mujoco>";

/// A body with what is attached to it, in a file beside the model.
fn made(name: &str, child: &str, inner: &str) -> Result<Imported, String> {
    let main = format!(
        "<mujoco><default><joint damping='5' armature='9'/><default class='z'><joint \
         stiffness='4'/></default></default><asset><model name='c' file='parts/child.xml'/></asset><worldbody>\n\
         <body name='base' childclass='z' pos='0 0 2'><joint name='b' range='-90 90'/><geom size='0.1' \
         mass='1'/>{inner}</body></worldbody></mujoco>"
    );
    let folder = folder(name, &[("main.xml", main.as_bytes()), ("parts/child.xml", child.as_bytes())]);
    import_file(Format::Mjcf, &folder.join("main.xml"), ASKED).map_err(|fault| fault.to_string())
}

#[test]
fn a_body_comes_with_its_names_classes_and_drives() {
    let imported = made("attach_body", CHILD, "<attach model='c' body='arm' prefix='p_'/>").expect("a robot");
    let words = [
        // The frame around it is left behind; its angle is in radians, the range of `b` in degrees.
        "point p_j = [1, 0, 0] turned rotation_z(1.5707963267948966);",
        "at least -1.57079632679; at most 1.57079632679;",
        "at least -1; at most 1;",
        // The class of the body around `p_arm` is that of the other model.
        "I b_rotor = 9; b.spin -> b_rotor;",
        "C b_spring(q) = 4 * q",
        "R p_j_bearing = 2;",
        "I p_k_rotor = 3;",
        // `boundmass` is of the other model alone.
        "body base {\n            mass 1;",
        "body p_arm {\n            mass 1.5;",
        "body p_hand {\n            mass 2;",
        "TF p_j_ratio = 1;",
        "drive p_m_drive on p_j torque = 3 * (1 * p_m);",
    ];
    compiles(&imported.text);
    has(&imported, &words, &["p_other", "p_mo", "joint p_hand_other", "p_j_rotor", "p_k_spring"]);
}

#[test]
fn a_body_inside_of_others_has_the_class_that_they_give_it() {
    let imported = made("attach_hand", CHILD, "<attach model='c' body='hand' prefix='p_'/>").expect("a robot");
    has(&imported, &["I p_k_rotor = 3;", "R p_k_bearing = 2;"], &["p_m", "p_arm"]);
}

#[test]
fn a_model_a_frame_and_two_copies_are_attached() {
    let all = made("attach_all", CHILD, "<frame pos='0 1 0'><attach model='c' prefix='p_'/></frame>").expect("a robot");
    let words =
        ["mass 8;", "p_other {", "drive p_mo_drive on p_o", "point p_j = [1, 1, 5]", "joint p_hand_p_other: fixed"];
    has(&all, &words, &[]);
    let frame = made("attach_frame", CHILD, "<attach model='c' frame='far' prefix='p_'/>").expect("a robot");
    has(&frame, &["point p_j = [1, 0, 5]"], &["p_other"]);
    let twice = "<attach model='c' body='arm' prefix='l_'/><attach model='c' body='arm' prefix='r_'/>";
    let twice = made("attach_twice", CHILD, twice).expect("a robot");
    has(&twice, &["drive l_m_drive on l_j", "drive r_m_drive on r_j"], &[]);
}

#[test]
fn what_does_not_count_there_is_told_and_what_is_not_there_is_refused() {
    let windy = CHILD.replace("<default>", "<option gravity='0 0 -1' timestep='1'/><default>");
    let imported = made("attach_option", &windy, "<attach model='c' body='arm' prefix='p_'/>").expect("a robot");
    assert_eq!(imported.notes, ["line 2 of parts/child.xml: `gravity` of <option> is not used."]);
    assert!(imported.text.contains("gravity [0, 0, -9.81];"), "{}", imported.text);
    let red = CHILD.replace("<body name='hand'", "<body name='hand' colour='red'");
    let imported = made("attach_unread", &red, "<attach model='c' body='arm' prefix='p_'/>").expect("a robot");
    assert_eq!(imported.notes, ["line 4 of parts/child.xml: `colour` of <body> is not used."]);
    let cases = [
        ("<attach model='c' body='arm'/>", "line 2: <attach> has no `prefix`: add it"),
        ("<attach model='x' body='arm' prefix='p_'/>", "line 2: there is no model `x`: check the spelling"),
        ("<attach model='c' body='x' prefix='p_'/>", "line 2: there is no body `x`: check the spelling"),
        ("<attach model='c' frame='x' prefix='p_'/>", "line 2: there is no frame `x`: check the spelling"),
        (
            "<attach body='base' prefix='p_'/>",
            "line 2: <attach> is not read here: save the model with MuJoCo (mj_saveLastXML), which writes out what is \
             attached to itself",
        ),
        (
            "<attach model='c' body='arm' prefix='p_'/><attach model='c' body='hand' prefix='p_'/>",
            "line 4 of parts/child.xml: a second joint `p_k`: rename one of the two",
        ),
    ];
    for (k, (inner, message)) in cases.into_iter().enumerate() {
        assert_eq!(made(&format!("attach_wrong{k}"), CHILD, inner).expect_err("it cannot"), message);
    }
    let own = CHILD.replace(
        "<worldbody>",
        "<asset><model name='c' file='child.xml'/></asset><worldbody><attach model='c' prefix='q_'/>",
    );
    let message =
        "line 3 of parts/child.xml: <model> is not read here: `child.xml` attaches itself: leave one of the two out";
    assert_eq!(
        made("attach_itself", &own, "<attach model='c' body='arm' prefix='p_'/>").expect_err("it cannot"),
        message
    );
    let text = "<mujoco><asset><model name='c' file='c.xml'/></asset><worldbody><body name='b'>\
                <attach model='c' prefix='p_'/></body></worldbody></mujoco>";
    let fault = import(Format::Mjcf, "r.xml", text, ASKED).expect_err("there is no folder");
    let message = "line 1: <model> is not read here: import the file from its folder, where the attached one is";
    assert_eq!(fault.to_string(), message);
}

#[test]
fn paths_count_from_the_folder_of_the_model() {
    let block = |edge: &str| {
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {edge}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").into_bytes()
    };
    let main = "<mujoco><asset><model name='c' file='sub/child.xml'/></asset><worldbody><body name='base'>\
                <attach model='c' body='arm' prefix='p_'/></body></worldbody></mujoco>";
    let child = "<mujoco model='child'><compiler meshdir='mesh'/><asset><mesh file='b.obj'/><model \
                 file='grand.xml'/></asset><worldbody><body name='arm'><joint name='j'/><geom type='mesh' mesh='b' \
                 density='6'/><attach model='g' body='leaf' prefix='g_'/></body></worldbody><include \
                 file='inc.xml'/></mujoco>";
    let grand = "<mujoco model='g'><worldbody><body name='leaf'><joint name='l'/><geom size='0.1'/></body></worldbody>\
                 <actuator><motor name='m' joint='l'/></actuator></mujoco>";
    let include = "<mujocoinclude><actuator><motor name='n' joint='j'/></actuator></mujocoinclude>";
    let folder = folder(
        "attach_paths",
        &[
            ("main.xml", main.as_bytes()),
            ("sub/child.xml", child.as_bytes()),
            ("sub/grand.xml", grand.as_bytes()),
            ("sub/inc.xml", include.as_bytes()),
            ("sub/mesh/b.obj", &block("1")),
            ("mesh/b.obj", &block("2")),
        ],
    );
    let imported = import_file(Format::Mjcf, &folder.join("main.xml"), ASKED).expect("a robot");
    has(&imported, &["body p_arm {\n            mass 1;", "drive p_g_m_drive on p_g_l", "drive p_n_drive on p_j"], &[]);
}

#[test]
fn what_names_copies_follows_them() {
    let text = |rest: &str| {
        format!(
            "<mujoco><worldbody><body name='out'><joint name='jo'/><geom size='0.1'/></body>\
             <replicate count='2' offset='1 0 0'><body name='x'><joint name='j'/><geom size='0.1'/>\
             <replicate count='2' offset='0 1 0' sep='-'><body name='y'><joint name='jy'/><geom \
             size='0.1'/></body></replicate></body></replicate></worldbody>\n{rest}</mujoco>"
        )
    };
    let import = |rest: &str| import(Format::Mjcf, "r.xml", &text(rest), ASKED).expect("a robot");
    let drives = import(
        "<actuator><motor name='m' joint='j'/><motor name='my' joint='jy'/><motor name='mo' joint='jo'/></actuator>",
    );
    let words =
        ["drive m0_drive on j0", "drive m1_drive on j1", "drive my_00_drive on jy_00", "drive my_11_drive on jy_11"];
    has(&drives, &[&words[..], &["drive mo_drive on jo"]].concat(), &["m2"]);
    let welded = import("<equality><weld body1='x' body2='world'/><joint joint1='j' joint2='jy'/></equality>");
    let note = "line 2: <joint> of <equality> names copies and something that is none: it is left out, as by MuJoCo.";
    assert_eq!(welded.notes, [note]);
    assert!(
        welded.text.contains("joint x0_world: fixed") && welded.text.contains("joint x1_world: fixed"),
        "{}",
        welded.text
    );
}
