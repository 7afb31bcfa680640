//! What drives joints on request, and what is said of what does not.

use bg_import::{Format, Imported, Options, import};

use super::kinds::{NO_CONTACTS, rods};
use super::{MASS, arm, compiles, compiles_with};

const ASKED: Options = Options { actuators: true, ..NO_CONTACTS };

/// Two rods beside each other with these actuators.
fn actuators(inner: &str) -> String {
    rods(&format!("<actuator>\n{inner}</actuator>"))
}

fn asked(text: &str) -> Imported {
    import(Format::Mjcf, "r.xml", text, ASKED).unwrap_or_else(|fault| panic!("{fault}\n{text}"))
}

/// That there is no note, and a text has words.
fn has(text: &str, words: &[&str]) {
    compiles_with(&asked(text), words, &[]);
}

#[test]
fn actuators_are_drives_on_request() {
    let actuators = |inner: &str| rods(&format!("<actuator>\n{inner}</actuator>"));
    let asked = Options { actuators: true, ..NO_CONTACTS };
    let made = |text: &str| {
        let imported = import(Format::Mjcf, "r.xml", text, asked).unwrap_or_else(|fault| panic!("{fault}\n{text}"));
        compiles(&imported.text);
        imported
    };
    let cases = [
        (
            "<motor name='m' joint='pin' gear='30' ctrlrange='-1 2'/>",
            vec![
                "input m: 1;",
                "let m_control: 1 = if m > 2 { 2 } else if m < -1 { -1 } else { m };",
                "drive m_drive on pin torque = 30 * (1 * m_control);",
            ],
        ),
        (
            "<velocity joint='pin' kv='5'/>",
            vec!["drive pin_velocity_drive on pin torque = 1 * (5 * pin_velocity - 5 * pin.spin.flow);"],
        ),
        (
            "<position name='servo' joint='pin' kp='20' kv='2' gear='3' forcerange='-4 4'/>",
            vec![
                "let servo_effort: N*m = 20 * servo - 60 * pin.angle - 6 * pin.spin.flow;",
                "drive servo_drive on pin torque = 3 * (if servo_effort > 4 { 4 } else if servo_effort < -4 { -4 } \
                else { servo_effort });",
            ],
        ),
        (
            "<general name='g' joint='pin' gainprm='7' biastype='affine' biasprm='1 -2 -3'/>",
            vec!["drive g_drive on pin torque = 1 * (7 * g + 1 - 2 * pin.angle - 3 * pin.spin.flow);"],
        ),
    ];
    for (inner, words) in cases {
        let imported = made(&actuators(inner));
        assert_eq!(imported.notes, [""; 0], "{inner}");
        for word in words {
            assert!(imported.text.contains(word), "no `{word}` in\n{}", imported.text);
        }
        assert!(!imported.text.contains("pin_torque"), "{}", imported.text);
        let left_out = import(Format::Mjcf, "r.xml", &actuators(inner), NO_CONTACTS).expect("a robot");
        assert_eq!(left_out.notes.len(), 1, "{:?}", left_out.notes);
    }
    let muscle = made(&actuators("<muscle name='m' joint='pin'/>"));
    assert_eq!(
        muscle.notes,
        ["line 5: the actuator `m` is left out: a muscle has a state of its own and a force by curves of its length \
            and speed."]
    );
    // What is said of a joint's motor in a URDF.
    let text = arm(MASS, "continuous", "<limit effort='5'/>");
    let imported = import(Format::Urdf, "r.urdf", &text, asked).expect("a robot");
    compiles(&imported.text);
    assert_eq!(imported.notes, [""; 0]);
    let limited = "drive j_motor on j torque = if j_torque > 5 { 5 } else if j_torque < -5 { -5 } else { j_torque };";
    assert!(imported.text.contains(limited), "{}", imported.text);
}

/// Numbers of MuJoCo 4.0.0, for the inertia 0.23 kg m^2 of the rod about its pin.
#[test]
fn gains_by_ratios_ranges_and_speeds_are_mujocos() {
    let kv = 2.0 * 0.7 * (5.0_f64 * 0.23).sqrt();
    let line = |name: &str, kv: f64| {
        format!(
            "drive {name}_drive on pin torque = 1 * (5 * {name} - 5 * pin.angle - {} * pin.spin.flow);",
            rounded(kv)
        )
    };
    has(&actuators("<position name='m' joint='pin' kp='5' dampratio='0.7'/>"), &[&line("m", kv)]);
    let general = "<general name='m' joint='pin' gainprm='5' biastype='affine' biasprm='0 -5 0.7'/>";
    has(&actuators(general), &[&line("m", kv)]);
    // With a gear the inertia is less by its square, of the rotor too, which gets the gear's square itself.
    let geared = "<position name='m' joint='pin' kp='5' dampratio='0.7' gear='2' armature='1'/>";
    let kv = 2.0 * 0.7 * (5.0_f64 * 4.23 / 4.0).sqrt();
    let words = format!("2 * (5 * m - 10 * pin.angle - {} * pin.spin.flow);", rounded(2.0 * kv));
    has(&actuators(geared), &[&words, "I pin_rotor = 4;"]);
    let ranged = actuators("<position name='m' joint='pin' inheritrange='0.5' gear='3'/>")
        .replace("name='pin'", "name='pin' range='-10 30' ref='5'")
        .replace("<worldbody>", "<compiler angle='radian'/><worldbody>");
    has(
        &ranged,
        &[
            "let m_control: 1 = if m > 20 { 20 } else if m < 0 { 0 } else { m };",
            "3 * (1 * m_control - 15 - 3 * pin.angle)",
        ],
    );
    let damper = "<damper name='m' joint='pin' kv='5' gear='3' ctrlrange='0 2'/>";
    has(&actuators(damper), &["drive m_drive on pin torque = 3 * (1 * m_control * (-15 * pin.spin.flow));"]);
    let affine = "<general name='m' jointinparent='pin' gaintype='affine' gainprm='2 3 4'/>";
    has(
        &actuators(affine),
        &["drive m_drive on pin torque = 1 * (2 * m + 1 * m * (3 * pin.angle + 4 * pin.spin.flow));"],
    );
    let free = actuators("<motor name='m' joint='pin' ctrlrange='-1 1'/>");
    let free = free.replace("<worldbody>", "<option><flag clampctrl='disable'/></option><worldbody>");
    has(&free, &["drive m_drive on pin torque = 1 * (1 * m);"]);
    let idle = actuators("<motor name='m' joint='pin' group='2'/><motor name='n' joint='pin'/>");
    let idle = asked(&idle.replace("<worldbody>", "<option actuatorgroupdisable='1 2'/><worldbody>"));
    assert!(!idle.text.contains("m_drive") && idle.text.contains("n_drive"), "{}", idle.text);
}

fn rounded(value: f64) -> String {
    let text = format!("{value:.11}");
    text.trim_end_matches('0').to_owned()
}

/// MuJoCo 4.0.0 counts each of the damping's numbers times the square of the gear, along the joint's speed.
#[test]
fn damping_and_armature_of_actuators_are_on_joints_whether_asked_or_not() {
    let text = actuators("<motor name='m' joint='pin' damping='1 2 3' armature='3' gear='-2'/>");
    for options in [ASKED, NO_CONTACTS] {
        let imported = import(Format::Mjcf, "r.xml", &text, options).expect("a robot");
        for words in ["R pin_bearing(w) = 4 * w + 8 * w * abs(w) + 12 * pow(w, 3);", "I pin_rotor = 12;"] {
            assert!(imported.text.contains(words), "no `{words}` in\n{}", imported.text);
        }
    }
    let ball = actuators("<motor name='m' joint='pin' armature='3'/>").replace("name='pin'", "name='pin' type='ball'");
    let note = "line 5: <motor>: its damping and armature are left out: it acts on no hinge and no slide.";
    assert_eq!(asked(&ball).notes[0], note);
}

#[test]
fn what_drives_nothing_is_told_with_its_reason() {
    let cases = [
        ("intvelocity name='m' joint='pin'", "it has a state of its own"),
        ("cylinder name='m' joint='pin'", "it has a state of its own"),
        ("position name='m' joint='pin' timeconst='1'", "it has a state of its own"),
        ("general name='m' joint='pin' dyntype='filter'", "it has a state of its own"),
        ("general name='m' joint='pin' gaintype='muscle'", "its gain is neither fixed nor affine"),
        ("general name='m' joint='pin' biastype='muscle'", "its bias is not affine"),
        ("motor name='m' site='s'", "it acts on no joint and no tendon"),
        ("adhesion name='m' body='rod'", "it sticks to what shapes touch, and shapes touch nothing"),
        ("pid name='m' joint='pin'", "it is a controller or a motor with states of its own: write it in the graph"),
        ("plugin name='m' joint='pin'", "it is of a kind that is not read"),
    ];
    for (inner, reason) in cases {
        let notes = asked(&actuators(&format!("<{inner}/>"))).notes;
        assert_eq!(notes, [format!("line 5: the actuator `m` is left out: {reason}.")], "{inner}");
    }
    let wrong = [
        ("damper joint='pin'", "`ctrlrange` of <damper> is \"\": it must be a range from 0 or above"),
        (
            "position joint='pin' kv='1' dampratio='1'",
            "`dampratio` of <position> is \"1\": it must be left out where there is a `kv`",
        ),
        ("position joint='pin' dampratio='-1'", "`dampratio` of <position> is \"-1\": it must be 0 or more"),
        (
            "position joint='pin' inheritrange='1'",
            "`inheritrange` of <position> is \"1\": it must be left out where its joint has no range",
        ),
    ];
    for (inner, message) in wrong {
        let fault =
            import(Format::Mjcf, "r.xml", &actuators(&format!("<{inner}/>")), ASKED).expect_err("MuJoCo refuses it");
        assert_eq!(fault.to_string(), format!("line 5: {message}"));
    }
}
