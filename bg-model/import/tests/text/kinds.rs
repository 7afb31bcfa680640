//! What is not understood is said, and what is, is done as MuJoCo and Pinocchio do it.

use bg_import::{Format, Imported, Options, import};

use super::{MASS, arm, compiles, compiles_with};

/// Without the note on contacts, which each shape makes.
pub(super) const NO_CONTACTS: Options = Options {
    free_base: false,
    keep_fixed: false,
    compliant: false,
    drives: true,
    limits: true,
    contacts: false,
    actuators: false,
    strict: false,
};

pub(super) fn made(text: &str) -> Imported {
    let format = if text.contains("<robot") { Format::Urdf } else { Format::Mjcf };
    import(format, "robot", text, NO_CONTACTS).unwrap_or_else(|fault| panic!("{fault}\n{text}"))
}

/// A rod on a hinge with these attributes and a head.
pub(super) fn rod(head: &str, body: &str, joint: &str) -> String {
    format!(
        "<mujoco>{head}<worldbody>\n<body name='rod' pos='0 0 1' {body}>\n<joint name='pin' axis='0 1 0' {joint}/>\n\
         <inertial pos='0.3 0 0' mass='2' diaginertia='0.01 0.05 0.05'/></body></worldbody></mujoco>"
    )
}

/// Two of them beside each other.
pub(super) fn rods(rest: &str) -> String {
    let second = "<body name='other' pos='1 0 1'><joint name='pin2' axis='0 1 0'/>\
                  <inertial pos='0.3 0 0' mass='2' diaginertia='0.01 0.05 0.05'/></body></worldbody>";
    rod("", "", "").replace("</worldbody>", &format!("{second}{rest}"))
}

/// A body of these shapes on a hinge.
pub(super) fn shapes(head: &str, shapes: &str) -> String {
    format!(
        "<mujoco>{head}<worldbody><body name='b'><joint name='pin' axis='0 1 0'/>{shapes}</body></worldbody></mujoco>"
    )
}

#[test]
fn what_is_not_used_is_a_note_with_its_line() {
    let cases = [
        (rod("", "", "colour='red'"), "line 3: `colour` of <joint> is not used."),
        (rod("", "weather='wet'", ""), "line 2: `weather` of <body> is not used."),
        (rod("<compiler magic='1'/>", "", ""), "line 1: `magic` of <compiler> is not used."),
        (rod("<spell/>", "", ""), "line 1: <spell> in <mujoco> is not used."),
        (
            rod("<default><joint springyield='1'/></default>", "", ""),
            "line 1: `springyield` of <joint> is not used: the spring does not yield.",
        ),
        (rod("", "", "type='ball' frictionloss='1'"), "line 3: `frictionloss` of <joint> is not used."),
        (rod("", "", "type='ball' armature='1'"), "line 3: `armature` of <joint> is not used."),
        (rod("", "", "type='free' stiffness='1'"), "line 3: `stiffness` of <joint> is not used."),
        (rod("", "", "").replace("<joint", "<flexcomp name='f'/><joint"), "line 3: <flexcomp> in <body> is not used."),
        (rod("", "", "").replace("<joint", "<plugin plugin='p'/><joint"), "line 3: <plugin> in <body> is not used."),
        (
            shapes("", "<geom size='0.1'/><geom type='box' mesh='m'/>"),
            "line 1: shape is a box fitted to a mesh `m` that is not there: its mass is not known and left out.",
        ),
        (
            arm(MASS, "continuous", "<limit effort='5'/>"),
            "line 4: `effort` of <limit> is not used: what drives a joint may give any effort; \
            with --actuators it is limited.",
        ),
        (
            arm(MASS, "continuous", "<limit velocity='5'/>"),
            "line 4: `velocity` of <limit> is not used: speeds are not limited.",
        ),
        (arm(MASS, "continuous", "<dynamics spring='5'/>"), "line 4: `spring` of <dynamics> is not used."),
        (
            arm(MASS, "continuous", "").replace("</robot>", "<mujoco/></robot>"),
            "line 4: <mujoco> in <robot> is not used: what it changes for MuJoCo is not done.",
        ),
        (
            arm(MASS, "continuous", "").replace("</robot>", "<constraint/></robot>"),
            "line 4: <constraint> in <robot> is not used: the loop that it closes is open.",
        ),
        (arm(MASS, "continuous", "<d:rotor_inertia value='3'/>"), "line 4: <d:rotor_inertia> in <joint> is not used."),
    ];
    for (text, note) in cases {
        let imported = made(&text);
        assert_eq!(imported.notes, [note], "{text}");
        compiles(&imported.text);
        assert!(imported.text.contains("// - "), "the head says it, too\n{}", imported.text);
    }
}

#[test]
fn what_changes_no_motion_is_no_note() {
    let head = "<visual><map znear='1'/></visual><statistic extent='1'/><size nconmax='3'/><option timestep='0.1' \
                solver='PGS'/><asset><material name='m'/><texture name='t'/></asset><sensor><jointpos \
                joint='pin'/></sensor><keyframe><key name='k' qpos='1'/></keyframe><custom><numeric name='n' \
                data='1'/></custom>";
    let inner =
        "<camera name='c'/><light pos='0 0 1'/><site name='s'/><geom name='g' size='0.1' rgba='1 0 0 1' friction='1'/>";
    let text = rod(head, "", "damping='0' range='0 0' user='1 2' group='2'")
        .replace("<inertial", &format!("{inner}<inertial"));
    assert_eq!(made(&text).notes, [""; 0]);
}

#[test]
fn strict_makes_a_note_an_error() {
    let strict = Options { strict: true, ..NO_CONTACTS };
    let text = rod("<option magic='3'/>", "", "colour='red'");
    let fault = import(Format::Mjcf, "r.xml", &text, strict).expect_err("there are notes");
    let told = "not all of the file can be kept, so nothing is written:\n  line 1: `magic` of <option> is not used.\n  \
                line 3: `colour` of <joint> is not used.";
    assert_eq!(fault.to_string(), told);
    assert!(import(Format::Mjcf, "r.xml", &rod("", "", ""), strict).is_ok());
}

/// That a text has words, and has others not.
fn has(text: &str, words: &[&str], others: &[&str]) {
    compiles_with(&made(text), words, others);
}

#[test]
fn flags_leave_out_what_they_disable() {
    let flag = |name: &str| format!("<option><flag {name}='disable'/></option>");
    let joint = "damping='3' stiffness='7' range='-90 90' frictionloss='0.5'";
    let (bearing, spring, stop, friction) = ("viscous 3", "C pin_spring", "stop pin_stop", "coulomb 0.5");
    has(&rod("", "", joint), &[bearing, spring, stop, friction, "gravity [0, 0, -9.81];"], &[]);
    has(
        &rod(&flag("gravity"), "gravcomp='1'", joint),
        &[bearing, spring],
        &["gravity", "potential", "drive rod_lifted"],
    );
    has(&rod(&flag("damper"), "", joint), &[spring, stop, friction], &["viscous"]);
    has(&rod(&flag("spring"), "", joint), &[bearing, stop, friction], &[spring]);
    has(&rod(&flag("limit"), "", joint), &[bearing, spring, friction], &[stop]);
    has(&rod(&flag("frictionloss"), "", joint), &["R pin_bearing = 3;", spring, stop], &[friction]);
    has(&rod(&flag("constraint"), "", joint), &["R pin_bearing = 3;", spring], &[friction, stop]);
    let tied = rods("<equality><connect body1='rod' body2='other' anchor='0.5 0 0'/></equality>");
    has(&tied, &["joint rod_other: spherical"], &[]);
    has(&tied.replace("<worldbody>", &format!("{}<worldbody>", flag("equality"))), &[], &["joint rod_other"]);
    has(&tied.replace("<connect", "<connect active='false'"), &[], &["joint rod_other"]);
}

#[test]
fn sections_of_one_kind_are_one() {
    has(&rod("<option gravity='0 0 -1.62'/><option timestep='0.001'/>", "", ""), &["gravity [0, 0, -1.62];"], &[]);
    has(&rod("<option gravity='0 0 -1'/><option gravity='0 0 -2'/>", "", ""), &["gravity [0, 0, -2];"], &[]);
    has(
        &rod("<compiler angle='radian'/><compiler autolimits='true'/>", "", "range='-1 1'"),
        &["at least -1; at most 1;"],
        &[],
    );
    let worlds = rods("").replace("<body name='other'", "</worldbody><worldbody><body name='other'");
    has(&worlds, &["body rod {", "body other {"], &[]);
    let defaults = "<default><joint damping='1'/></default><default><joint armature='2'/></default>";
    has(&rod(defaults, "", ""), &["R pin_bearing = 1;", "I pin_rotor = 2;"], &[]);
    // MuJoCo 4.0: a class has what stood around it before it; what follows in another section it has not.
    let later = "<default><joint damping='1'/><default class='a'><joint armature='3'/></default></default>\
                 <default><joint damping='5' stiffness='2'/></default>";
    has(&rod(later, "", "class='a'"), &["R pin_bearing = 1;", "I pin_rotor = 3;"], &["spring"]);
}

#[test]
fn gravity_compensation_is_a_force_at_the_centre_of_mass() {
    let words = ["point rod_lifted = [0.3, 0, 0];", "drive rod_lifted on rod.rod_lifted force = [0, 0, 9.81];"];
    has(&rod("", "gravcomp='0.5'", ""), &words, &[]);
    has(&rod("", "gravcomp='0.5'", ""), &["rod.mass * rod.position.z - 1 * rod.rod_lifted.position.z"], &[]);
}

#[test]
fn a_fluid_brakes_the_box_of_each_body() {
    // Sizes of the box by MuJoCo's documentation: sqrt(6 (I2 + I3 - I1) / m) of 0.01, 0.05, 0.05 and 2 kg.
    let edges = [0.27_f64.sqrt(), 0.03_f64.sqrt(), 0.03_f64.sqrt()];
    let fluid = "<option density='1000' viscosity='0.1' wind='1 0 0'/>";
    let imported = made(&rod(fluid, "", ""));
    assert_eq!(imported.notes, [""; 0]);
    compiles(&imported.text);
    let number = |start: &str| -> f64 {
        let after = imported.text.split(start).nth(1).unwrap_or_else(|| panic!("no `{start}` in\n{}", imported.text));
        after.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
    };
    let is_near = |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-9, "{found}, not {wanted}");
    let pi = std::f64::consts::PI;
    let diameter = edges.iter().sum::<f64>() / 3.0;
    is_near(number("force = rod_fluid_axes * [-"), 3.0 * pi * diameter * 0.1);
    is_near(number("rod_fluid_velocity.x - "), 500.0 * edges[1] * edges[2]);
    is_near(number("rod_fluid_velocity.y - "), 500.0 * edges[0] * edges[2]);
    is_near(number("torque = rod_fluid_axes * [-"), pi * diameter.powi(3) * 0.1);
    is_near(number("rod_fluid_spin.y - "), 1000.0 * edges[1] * (edges[0].powi(4) + edges[2].powi(4)) / 64.0);
    assert!(imported.text.contains("* (rod.rod_fluid.velocity - [1, 0, 0]);"), "{}", imported.text);
    let off = "<option density='1000'><flag spring='disable' damper='disable'/></option>";
    has(&rod(off, "", ""), &[], &["fluid"]);
    let round = shapes("<option density='1'/>", "<geom size='0.1'/><geom size='0.1' pos='1 0 0'/>");
    assert_eq!(
        made(&round).notes,
        ["The fluid around body `b` brakes along axes that MuJoCo may choose otherwise, since two of its moments \
            are equal."]
    );
    let ellipsoid = shapes("<option density='1'/>", "<geom size='0.1' fluidshape='ellipsoid'/>");
    assert_eq!(
        made(&ellipsoid).notes,
        ["line 1: body `b`: the fluid around its ellipsoids (fluidshape) does not act on it."]
    );
}

#[test]
fn inertias_are_those_of_the_compiler() {
    let bound = "<compiler boundmass='1' boundinertia='0.1'/>";
    let ball = "<geom size='0.05' mass='0.1' pos='0.3 0 0'/>";
    has(&shapes(bound, ball), &["mass 1;", "center [0.3, 0, 0];", "inertia [0.1, 0.1, 0.1];"], &[]);
    let groups = "<compiler inertiagrouprange='0 0'/>";
    let two = "<geom size='0.1' mass='2'/><geom size='0.1' mass='5' group='2'/>";
    has(&shapes(groups, two), &["mass 2;"], &[]);
    let given = "<inertial pos='0 0 0' mass='3' diaginertia='1 1 1'/>";
    has(&shapes("<compiler inertiafromgeom='true'/>", given), &["mass 3;"], &[]);
    has(&shapes("<compiler inertiafromgeom='true'/>", &format!("{given}{ball}")), &["mass 0.1;"], &[]);
    has(&shapes("<compiler inertiafromgeom='false'/>", &format!("{given}{ball}")), &["mass 3;"], &[]);
    let odd = "<inertial pos='0 0 0' mass='1' diaginertia='0.01 0.01 0.1'/>";
    has(&shapes("<compiler balanceinertia='true'/>", odd), &["inertia [0.04, 0.04, 0.04];"], &[]);
    has(&shapes("<compiler settotalmass='6'/>", given), &["mass 6;", "inertia [2, 2, 2];"], &[]);
    // Shells, against MuJoCo 4.0.
    let shell = |shape: &str| shapes("", &format!("<geom {shape} mass='2' shellinertia='true'/>"));
    has(&shell("size='0.2'"), &["inertia [0.0533333333333, 0.0533333333333, 0.0533333333333];"], &[]);
    let cuboid = "inertia [0.0091864978903, 0.0763805907173, 0.0740717299578];";
    has(&shell("type='box' size='0.3 0.05 0.07'"), &[cuboid], &[]);
    has(&shell("type='capsule' size='0.1 0.3'"), &["inertia [0.115833333333, 0.115833333333, 0.0183333333333];"], &[]);
    has(
        &shell("type='cylinder' size='0.1 0.3'"),
        &["inertia [0.0864285714286, 0.0864285714286, 0.0185714285714];"],
        &[],
    );
}

#[test]
fn springs_and_dampers_are_mujocos() {
    // 0.23 kg m^2 about the pin and 0.1 of the rotor: 0.33 / (0.2 0.5)^2 and 2 0.33 / 0.2.
    has(
        &rod("", "", "springdamper='0.2 0.5' armature='0.1'"),
        &["C pin_spring(q) = 33 * q", "R pin_bearing = 3.3;"],
        &[],
    );
    has(
        &rod("", "", "stiffness='20 3 100' damping='2 0 5'"),
        &[
            "C pin_spring(q) = 20 * q + 3 * q * abs(q) + 100 * pow(q, 3) start pin_start energy 20 * pow(q, 2) / 2 + 3 \
             * abs(pow(q, 3)) / 3 + 100 * pow(q, 4) / 4;",
            "R pin_bearing(w) = 2 * w + 5 * pow(w, 3);",
        ],
        &[],
    );
    has(&rod("", "", "type='ball' damping='2'"), &["R pin_bearing = 2; rod.rotation -> pin_bearing;"], &[]);
    let on_another = rod("", "", "").replace(
        "</body>",
        "<body name='load'><joint name='hook' type='ball' damping='2'/><geom size='0.1'/></body></body>",
    );
    has(
        &on_another,
        &["hook_twist -> hook_bearing; hook_twist -> hook_moment; rod.rotation -> hook_moment -> load.rotation;"],
        &[],
    );
    has(
        &rod("", "", "type='free' damping='3' armature='0.5'"),
        &[
            "R rod_drag = 3; rod.rotation -> rod_drag;",
            "joint rod_brake: spherical (ground -> rod) { stiffness 0; damping 3; }",
            "mass 2.5;",
            "drive rod_lifted on rod force = [0, 0, 4.905];",
        ],
        &[],
    );
}

/// Stiffness and damping as MuJoCo 4.0.0 has them: the inertia of a joint in a chain is that of one whose others are
/// free.
#[test]
fn springs_by_time_constants_feel_the_whole_mechanism() {
    let chain = "<body name='tip' pos='0.6 0 0' euler='0 0 40'>\
        <joint name='hook' axis='1 1 0' pos='0 0.1 0' springdamper='0.1 2'/><joint name='draw' type='slide' axis='0 1 \
        1'/><inertial pos='0.1 0.2 0' mass='1' diaginertia='0.02 0.03 0.04'/></body></body>";
    let floating = |kind: &str| {
        format!(
            "<body name='ball' pos='3 0 0'><joint name='b' type='{kind}'/><inertial pos='0 0.1 0' mass='2' \
             diaginertia='0.02 0.03 0.04'/><body name='arm' pos='1 0 0'><joint name='w' axis='0 1 0' springdamper='0.1 \
             1'/><inertial pos='0.1 0.2 0' mass='1' diaginertia='0.02 0.03 0.04'/></body></body></worldbody>"
        )
    };
    for (kind, stiffness) in [("ball", 2.427_480_916_030_542_6), ("free", 2.423_954_372_623_582_4)] {
        let text = rod("", "", "springdamper='0.2 0.5' armature='0.1'")
            .replace("</body>", chain)
            .replace("</worldbody>", &floating(kind));
        let made = made(&text).text;
        for (name, stiffness, damping) in [
            ("pin", 48.036_002_152_598_32, 4.803_600_215_259_833),
            ("hook", 0.593_276_184_149_105, 0.474_620_947_319_284_06),
            ("w", stiffness, 0.2 * stiffness),
        ] {
            let after = |words: String| -> f64 {
                let rest = made.split(&words).nth(1).unwrap_or_else(|| panic!("no `{words}` in\n{made}"));
                rest.split([' ', ';']).next().and_then(|word| word.parse().ok()).expect("a number")
            };
            let found = [after(format!("C {name}_spring(q) = ")), after(format!("R {name}_bearing = "))];
            assert!((found[0] / stiffness - 1.0).abs() < 1e-11, "{name}: {found:?}");
            assert!((found[1] / damping - 1.0).abs() < 1e-11, "{name}: {found:?}");
        }
    }
}

#[test]
fn joints_that_follow_others_are_rigid_rows() {
    let mimic = "<robot name='r'><link name='a'/><link name='b'>MASS</link><link name='c'>MASS</link>\
                 <joint name='left' type='prismatic'><parent link='a'/><child link='b'/><limit lower='0' \
                 upper='1'/></joint><joint name='right' type='prismatic'><parent link='a'/><child link='c'/><limit \
                 lower='-1' upper='0'/><mimic joint='left' multiplier='-2' offset='0.25'/></joint></robot>"
        .replace("MASS", MASS);
    has(
        &mimic,
        &[
            "TF right_ratio = -2; 0 right_tie: translation; rSe right_follows = 0;",
            "left.slide -> right_ratio -> right_tie -> right.slide; right_follows -> right_tie;",
            "let right_start: m = 0.25 - 2 * left_start;",
            "stop left_stop on left { at least 0.125; at most 0.625; restitution 0; }",
            "param left_start: m = 0.375;",
        ],
        &["param right_start", "stop right_stop"],
    );
    has(
        &rods("<equality><joint joint1='pin' joint2='pin2' polycoef='0.1 2 0 3'/></equality>"),
        &[
            "MTF pin_ratio = 2 + 9 * pow(pin2.angle, 2);",
            "let pin_start: rad = 0.1 + 2 * pin2_start + 3 * pow(pin2_start, 3);",
        ],
        &[],
    );
    let text = mimic.replace("joint='left' multiplier", "joint='right' multiplier");
    let fault = import(Format::Urdf, "r.urdf", &text, NO_CONTACTS).expect_err("it cannot");
    let message = "line 1: joint `right` follows itself: let it follow a joint that moves on its own";
    assert_eq!(fault.to_string(), message);
    let text = mimic.replace("joint='left' multiplier", "joint='middle' multiplier");
    let note = "line 1: joint `right` does not mimic `middle`, which is not there: it moves on its own.";
    assert_eq!(made(&text).notes, [note]);
}

#[test]
fn a_loop_joint_of_a_urdf_closes_a_loop() {
    let text = arm(MASS, "continuous", "").replace(
        "</robot>",
        "<loop_joint name='tie' type='revolute'><link1 link='a' xyz='0.1 0 0'/><link2 link='b' xyz='0.1 0 0'/>\
         <axis xyz='0 1 0'/></loop_joint></robot>",
    );
    has(&text, &["joint tie: revolute z (ground.tie -> b.tie) {"], &[]);
    let open = made(&text.replace("link2 link='b' xyz='0.1 0 0'", "link2 link='b' xyz='0.1 0 0.25'"));
    let note = "Loop `tie` is open at the start, by 0.25 m or by an angle: make starts of its joints guesses, or give \
                them values that close it.";
    assert_eq!(open.notes, [note]);
    // What is open is a part of the machine.
    for size in [1e-9, 1e9] {
        let scaled = |gap: f64| {
            let ends = format!("link1 link='a' xyz='{size} 0 0'/><link2 link='b' xyz='{size} 0 {}'", gap * size);
            made(&text.replace("link1 link='a' xyz='0.1 0 0'/><link2 link='b' xyz='0.1 0 0'", &ends)).notes.len()
        };
        assert_eq!([scaled(1e-10), scaled(1e-8)], [0, 1], "{size} m");
    }
    let limited = rods("<equality><connect body1='rod' body2='other' anchor='0.5 0 0'/></equality>")
        .replace("name='pin'", "name='pin' range='10 20'");
    assert!(
        made(&limited).notes[0].starts_with("Loop `rod_other` is open at the start, by 0.13"),
        "{:?}",
        made(&limited).notes
    );
}

#[test]
fn a_motor_that_drake_reads_is_an_armature_and_told() {
    let text = arm(MASS, "continuous", "<drake:rotor_inertia value='0.3'/><drake:gear_ratio value='10'/>");
    let imported = made(&text);
    assert!(imported.text.contains("I j_rotor = 30; j.spin -> j_rotor;"), "{}", imported.text);
    compiles(&imported.text);
    let [note] = &imported.notes[..] else { panic!("{:?}", imported.notes) };
    assert!(note.contains("drake:rotor_inertia") && note.contains("drake:gear_ratio"), "{note}");
}

#[test]
fn moments_of_thin_rods_stay_as_they_are() {
    let moments = |moments: &str| format!("<inertial><mass value='1'/><inertia {moments}/></inertial>");
    let cases = [
        (
            "ixx='0' iyy='0.08' izz='0.08'",
            "inertia [8e-8, 0.08, 0.08];",
            "Link `b` has a moment of inertia of 0: here it is 8e-8 kg*m^2.",
        ),
        (
            "ixx='1e-18' iyy='0.08' izz='0.08'",
            "inertia [8e-8, 0.08, 0.08];",
            "Link `b` has a moment of inertia of 0: here it is 8e-8 kg*m^2.",
        ),
        (
            "ixx='0.1' iyy='0.1' izz='0.2' ixy='0.1'",
            "inertia [[0.1000001, 0.0999999, 0], [0.0999999, 0.1000001, 0], [0, 0, 0.2]];",
            "Link `b` has a moment of inertia of 0: here it is 2e-7 kg*m^2.",
        ),
        ("ixx='0'", "inertia [1e-8, 1e-8, 1e-8];", "Link `b` has no moments of inertia: here all are 1e-8 kg*m^2."),
        (
            "ixx='1e-18' iyy='1e-18' izz='1e-18'",
            "inertia [1e-8, 1e-8, 1e-8];",
            "Link `b` has no moments of inertia: here all are 1e-8 kg*m^2.",
        ),
        (
            "ixx='0' iyy='0.01' izz='0.02'",
            "inertia [0.01, 0.01, 0.01];",
            "Link `b` has moments of inertia that no body has: here all are 0.01 kg*m^2.",
        ),
        (
            "ixx='0' iyy='0' izz='0.03'",
            "inertia [0.01, 0.01, 0.01];",
            "Link `b` has moments of inertia that no body has: here all are 0.01 kg*m^2.",
        ),
        (
            "ixx='-0.02' iyy='0.01' izz='0.010000000001'",
            "inertia [0.01, 0.01, 0.01];",
            "Link `b` has moments of inertia that no body has: here all are 0.01 kg*m^2.",
        ),
    ];
    for (text, inertia, note) in cases {
        let imported = made(&arm(&moments(text), "continuous", ""));
        assert_eq!(imported.notes, [note], "{text}");
        assert!(imported.text.contains(inertia), "{text}\n{}", imported.text);
        compiles(&imported.text);
    }
    // Another link gives the whole mass, of which this one gets a millionth; its moments stay.
    let rotor = "<inertial><origin xyz='0.2 0 0'/><mass value='0'/><inertia ixx='0.5' iyy='0.5' izz='0.5'/></inertial>";
    let text = arm(rotor, "continuous", "").replace(
        "</robot>",
        &format!(
            "<link name='c'>{MASS}</link><joint name='k' type='continuous'><parent link='b'/><child \
            link='c'/></joint></robot>"
        ),
    );
    let imported = made(&text);
    assert!(
        imported.text.contains("mass 1e-6;\n            center [0.2, 0, 0];\n            inertia [0.5, 0.5, 0.5];"),
        "{}",
        imported.text
    );
    assert_eq!(imported.notes, ["Link `b` has moments of inertia and no mass: here it has 1e-6 kg, for its joints."]);
}

#[test]
fn hinges_in_a_row_are_one_joint_only_where_nothing_is_on_them() {
    let fork = |joints: &str| {
        shapes("<compiler angle='radian'/>", "<geom size='0.1'/>").replace("<joint name='pin' axis='0 1 0'/>", joints)
    };
    let bare = made(&fork("<joint name='pan' axis='0 0 1'/><joint name='tilt' axis='0 1 0'/>"));
    assert!(bare.text.contains("joint tilt: universal x y"), "{}", bare.text);
    for on in ["range='-1 1'", "damping='1'", "frictionloss='1'", "armature='1'", "stiffness='1'"] {
        let imported = made(&fork(&format!("<joint name='pan' axis='0 0 1'/><joint name='tilt' axis='0 1 0' {on}/>")));
        assert!(
            imported.text.contains("joint pan: revolute z") && imported.text.contains("joint tilt: revolute y"),
            "{on}"
        );
        compiles(&imported.text);
    }
}

#[test]
fn frames_and_copies_are_written_out() {
    let text = "<mujoco><worldbody><frame pos='1 0 0' euler='0 0 90'><frame pos='1 0 0'><body name='q' pos='1 0 \
                0'><joint name='a'/><frame pos='0 0 1'><geom type='capsule' fromto='0 0 0 1 0 0' size='.1'/><joint \
                name='l' axis='1 0 0' pos='0 1 0'/></frame></body></frame></frame></worldbody></mujoco>";
    let imported = made(text);
    // MuJoCo 4.0: the body at (1, 2, 0), its second joint at (0, 1, 1), its mass at (0.5, 0, 1).
    for words in [
        "= [1, 2, 0] turned rotation_z(1.5707963267948966)",
        "[0, 1, 1]",
        "mass 35.6047167407;\n            center [0.5, 0, 1];",
    ] {
        assert!(imported.text.contains(words), "no {words} in\n{}", imported.text);
    }
    let text = "<mujoco><worldbody><replicate count='3' offset='1 0 0' euler='0 0 30'><body name='b' pos='0 1 \
                0'><joint name='j'/><geom size='.1'/></body></replicate></worldbody></mujoco>";
    has(
        text,
        &[
            "body b0 {",
            "joint j2: revolute z",
            "point j1 = [0.5, 0.866025403784, 0] turned rotation_z(0.523598775598);",
            "point j2 = [1, 1, 0] turned rotation_z(1.0471975512);",
        ],
        &[],
    );
}

#[test]
fn what_mujoco_refuses_is_refused_with_its_line() {
    let cases = [
        (shapes("", "\n<geom size='0.1' mass='-1'/>"), "line 2: `mass` of <geom> is \"-1\": it must be 0 or more"),
        (
            shapes("", "\n<geom size='0.1' density='-1'/>"),
            "line 2: `density` of <geom> is \"-1\": it must be 0 or more",
        ),
        (shapes("", "\n<geom size='-0.1'/>"), "line 2: `size` of <geom> is \"-0.1\": it must be above 0"),
        (
            shapes("", "\n<geom type='box' size='1 1'/>"),
            "line 2: `size` of <geom> is \"1 1\": it must be 3 numbers above 0",
        ),
        (
            shapes("", "\n<inertial pos='0 0 0' mass='-1' diaginertia='1 1 1'/>"),
            "line 2: `mass` of <inertial> is \"-1\": it must be 0 or more",
        ),
        (
            shapes("", "\n<inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/>"),
            "line 2: no body has the moments of inertia 1, 1, 3, of which one is larger than the others together: \
             correct them, or let balanceinertia=\"true\" of <compiler> replace them by their mean",
        ),
        (
            rod("<compiler eulerseq='xy'/>", "", ""),
            "line 1: `eulerseq` of <compiler> is \"xy\": it must be three of the letters x, y, z, X, Y, Z",
        ),
        (
            rod("<compiler angle='grad'/>", "", ""),
            "line 1: `angle` of <compiler> is \"grad\": it must be degree or radian",
        ),
        (
            rod("<compiler coordinate='global'/>", "", ""),
            "line 1: `coordinate` of <compiler> is \"global\": it must be local: let MuJoCo 2.3.3 or older write the \
            file anew",
        ),
        (
            rod("<option><flag gravity='off'/></option>", "", ""),
            "line 1: `gravity` of <flag> is \"off\": it must be enable or disable",
        ),
        (rod("", "", "class='steel'"), "line 3: there is no class `steel`: check the spelling"),
        (rod("", "childclass='steel'", ""), "line 2: there is no class `steel`: check the spelling"),
        (
            rod("<default><default class='a'/>\n<default class='a'/></default>", "", ""),
            "line 2: a second class `a`: rename one of the two",
        ),
        (rod("", "", "frictionloss='-1'"), "line 3: `frictionloss` of <joint> is \"-1\": it must be 0 or more"),
        (
            rod("", "", "limited='true' range='1 -1'"),
            "line 3: `range` of <joint> is \"1 -1\": it must be two numbers, the smaller one first",
        ),
        (
            rod("", "quat='1 0 0 0' euler='1 0 0'", ""),
            "line 2: <body> has `quat` and `euler`: leave one of the two out",
        ),
        (rods("").replace("pin2", "pin"), "line 4: a second joint `pin`: rename one of the two"),
        (
            rod("", "", "type='ball'").replace("<inertial", "<joint/><inertial"),
            "line 2: a body with a ball joint turns about nothing else after it: leave a joint out",
        ),
    ];
    for (text, message) in cases {
        let fault = match import(Format::Mjcf, "robot.xml", &text, NO_CONTACTS) {
            Ok(imported) => panic!("{message}\n{}", imported.text),
            Err(fault) => fault,
        };
        assert_eq!(fault.to_string(), message, "{text}");
    }
}

#[test]
fn what_other_readers_read_is_read() {
    let limits = made(&arm(MASS, "revolute", "<limit lower='-inf' upper='inf'/>"));
    assert!(!limits.text.contains("stop "), "{}", limits.text);
    has(
        &arm(MASS, "revolute", "<limit lower='-inf' upper='1'/>"),
        &["stop j_stop on j { at most 1; restitution 0; start j_start; }"],
        &[],
    );
    has(&format!("<!DOCTYPE robot>\n{}", arm(MASS, "continuous", "")), &["body b {"], &[]);
}
