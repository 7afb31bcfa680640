//! Fixed tendons are transformers to a junction with what acts along them; others are told.

use bg_import::{Format, Imported, Options, import};

use super::compiles_with;
use super::kinds::NO_CONTACTS;

const ASKED: Options = Options { actuators: true, ..NO_CONTACTS };

/// A slide that carries a hinge, and a tendon of twice the one less the other.
fn robot(tendon: &str, rest: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='cart'><joint name='j' type='slide' axis='1 0 0' ref='0.5'/><geom size='0.1' \
         mass='2'/><body name='rod'><joint name='k' axis='0 1 0'/><geom size='0.1' mass='2' pos='0.3 0 \
         0'/></body></body></worldbody>\n\
         <tendon><fixed name='cord' {tendon}><joint joint='j' coef='2'/><joint joint='k' \
         coef='-1'/></fixed></tendon>{rest}</mujoco>"
    )
}

fn asked(text: &str) -> Result<Imported, String> {
    import(Format::Mjcf, "r.xml", text, ASKED).map_err(|fault| fault.to_string())
}

/// That there is no note, and a text has words, and has others not.
fn has(text: &str, words: &[&str], others: &[&str]) {
    compiles_with(&asked(text).expect("a robot"), words, others);
}

#[test]
fn a_spring_and_a_damper_are_on_the_sum_of_the_flows() {
    let words = [
        "0 cord_sum: translation; 1 cord_pull: translation; cord_sum -> cord_pull;",
        "TF cord_ratio1 = 2; j.slide -> cord_ratio1 -> cord_sum;",
        "TF cord_ratio2 = -1; k.spin -> cord_ratio2 -> cord_sum;",
        "let cord_start: m = 2 * j_start - 1 * k_start;",
        "C cord_spring(q) = 10 * q start cord_start; cord_pull -> cord_spring;",
        "R cord_bearing = 3; cord_pull -> cord_bearing;",
    ];
    has(&robot("stiffness='10' damping='3'", ""), &words, &["stop", "friction"]);
    // The length counts from the file's pose, where it is 1 for MuJoCo.
    has(&robot("stiffness='10' springlength='0.75'", ""), &["start cord_start + 0.25; cord_pull"], &[]);
    has(
        &robot("stiffness='10 2 3' damping='1 2 3'", ""),
        &["C cord_spring(q) = 10 * q + 2 * q * abs(q)", "R cord_bearing(w) = 1 * w"],
        &[],
    );
    let class = robot("", "").replace("<worldbody>", "<default><tendon stiffness='4'/></default><worldbody>");
    has(&class, &["C cord_spring(q) = 4 * q"], &[]);
    let off = robot("stiffness='10' damping='3'", "")
        .replace("<worldbody>", "<option><flag spring='disable'/></option><worldbody>");
    has(&off, &["R cord_bearing"], &["cord_spring"]);
    has(&robot("rgba='1 0 0 1'", ""), &[], &["cord_pull"]);
}

#[test]
fn slack_friction_and_limits_are_on_the_same_flow() {
    let slack = "C cord_spring(q) = if q > 0.5 { 10 * (q - 0.5) } else if q < 0 { 10 * q } else { 0 } start cord_start \
                 energy if q > 0.5 { 10 * pow(q - 0.5, 2) / 2 } else if q < 0 { 10 * pow(q, 2) / 2 } else { 0 }; \
                 cord_pull";
    has(&robot("stiffness='10' springlength='1 1.5'", ""), &[slack], &[]);
    let words = [
        "friction cord_friction on cord_pull { coulomb 4; viscous 3; }",
        "stop cord_stop on cord_pull { at least -1; at most 2; restitution 0; start cord_start; }",
    ];
    has(&robot("frictionloss='4' damping='3' range='0 3'", ""), &words, &["R cord_bearing"]);
    has(&robot("damping='3' range='0 3' limited='false'", ""), &[], &["cord_stop"]);
    let outside = asked(&robot("range='2 3'", "")).expect("a robot");
    assert_eq!(outside.notes, ["The limits of tendon `cord` are left out: it starts outside of them."]);
}

#[test]
fn an_actuator_on_a_tendon_drives_all_its_joints() {
    let words = [
        "/// Controls `j`, `k`.",
        "let m_effort: N = 5 * m - 15 - 30 * j.travel + 15 * k.angle - 6 * j.slide.flow + 3 * k.spin.flow;",
        "drive m_drive1 on j force = 6 * m_effort;",
        "drive m_drive2 on k torque = -3 * m_effort;",
    ];
    let position = "<actuator><position name='m' tendon='cord' gear='3' kp='5' kv='1'/></actuator>";
    has(&robot("", position), &words, &["cord_pull"]);
    let limited = position.replace("kp=", "forcerange='-2 2' kp=");
    has(&robot("", &limited), &["drive m_drive2 on k torque = -3 * (if m_effort > 2 { 2 } else"], &[]);
    // MuJoCo 4.0.0: inertias of 4 kg along the slide and 0.188 kg m^2 about the hinge in 1 / sum(a^2 / m).
    let ratio = asked(&robot("", &position.replace("kv='1'", "dampratio='1'"))).expect("a robot").text;
    let kv = 2.0 * (5.0_f64 / (36.0 / 4.0 + 9.0 / 0.188)).sqrt();
    let found = ratio.split("15 * k.angle - ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a number");
    assert!((found.parse::<f64>().expect("a number") / (6.0 * kv) - 1.0).abs() < 1e-9, "{found}");
}

#[test]
fn an_equality_of_tendons_lets_one_of_two_joints_follow() {
    let second = |inner: &str, tied: &str| {
        robot(
            "",
            &format!(
                "<tendon><fixed name='b'>{inner}</fixed><fixed name='c'><joint joint='j' coef='4'/></fixed></tendon>\
                            <equality><tendon name='e' {tied}/></equality>"
            ),
        )
    };
    let hinge = "<joint joint='k' coef='3'/>";
    // Counted from the file's pose, as in MuJoCo 4.0.0: 2 j - k = 0.5, whatever the other coefficients.
    let alone = second(hinge, "tendon1='cord' polycoef='0.5 7 8'");
    has(&alone, &["let j_start: m = 0.25 + 0.5 * k_start;", "TF j_ratio = 0.5;"], &[]);
    // 4 j = 0.1 + 2 (3 k) + 4 (3 k)^2.
    let curved = second(hinge, "tendon1='c' tendon2='b' polycoef='0.1 2 4'");
    has(&curved, &["let j_start: m = 0.025 + 1.5 * k_start + 9 * pow(k_start, 2);"], &[]);
    // 2 j - k = 4 (3 k).
    let linear = second(hinge, "tendon1='cord' tendon2='b' polycoef='0 4'");
    has(&linear, &["let j_start: m = 6.5 * k_start;"], &[]);
    let class = linear.replace("<worldbody>", "<default><tendon stiffness='4'/></default><worldbody>");
    has(&class, &["let j_start: m = 6.5 * k_start;"], &[]);
    let one = asked(&second(hinge, "tendon1='b'")).expect("a robot");
    let note = "The equality `e` of the kind `tendon` is left out: two joints can follow each other here, and it ties \
        other numbers of them.";
    assert_eq!(one.notes, [note]);
    assert_eq!(
        asked(&second(hinge, "tendon1='x'")).expect_err("it is not there"),
        "line 2: there is no tendon `x`: check the spelling"
    );
}

#[test]
fn what_is_not_said_of_a_tendon_is_told() {
    let cases = [
        (robot("armature='4'", ""), "line 2: `armature` of <fixed> is not used: nothing moves along the tendon."),
        (
            robot("stiffness='1 2' springlength='0 1'", ""),
            "line 2: tendon `cord`: the spring is loose at one length alone, since its stiffness is no number.",
        ),
        (
            robot("", "").replace("<tendon>", "<tendon><spatial name='s'><site site='a'/><site site='b'/></spatial>"),
            "line 2: the spatial tendon `s` is left out: its length is no sum of joints' angles and travels.",
        ),
    ];
    for (text, note) in cases {
        assert_eq!(asked(&text).expect("a robot").notes, [note], "{text}");
    }
    let pulled = robot("", "<actuator><motor name='m' tendon='s'/></actuator>")
        .replace("<tendon>", "<tendon><spatial name='s'/>");
    let note = "line 2: the actuator `m` is left out: its tendon is no sum of joints.";
    assert_eq!(asked(&pulled).expect("a robot").notes[1], note);
    let wrong = [
        (robot("", "").replace("joint='k'", "joint='x'"), "line 2: there is no joint `x`: check the spelling"),
        (
            robot("", "").replace("joint='k'", "joint='j'"),
            "line 2: a second part with joint `j`: rename one of the two",
        ),
        (robot("", "").replace(" coef='2'", ""), "line 2: <joint> has no `coef`: add it"),
        (
            robot("springlength='2 1'", ""),
            "line 2: `springlength` of <fixed> is \"2 1\": it must be one length, or two with the smaller one first",
        ),
        (robot("", "<actuator><motor tendon='x'/></actuator>"), "line 2: there is no tendon `x`: check the spelling"),
    ];
    for (text, message) in wrong {
        assert_eq!(asked(&text).expect_err("it cannot"), message);
    }
}
