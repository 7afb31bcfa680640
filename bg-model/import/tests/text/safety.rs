//! Whatever a file holds, its text is a graph or there is an error.

use bg_import::{Format, ImportError, Options, import};

use super::{MASS, compiles};

/// A pendulum of these names.
fn named(robot: &str, link: &str, joint: &str) -> String {
    format!(
        "<robot name='{robot}'><link name='a'/><link name='{link}'>{MASS}</link><joint name='{joint}' \
         type='continuous'><parent link='a'/><child link='{link}'/></joint></robot>"
    )
}

#[test]
fn names_that_break_lines_or_are_words_of_rust_stay_names() {
    let robots =
        ["self", "Self", "a&#10;fn main() {}", "a&#13;b", "x&#x202e;y", "*/ // `", "bond_graph! { }", "1", "", "crate"];
    let names = ["t", "fn", "b&#10;}}", "potential", "energy", "b c", "é", "self", "p&#x2066;q", "u&#10;"];
    for (robot, name) in robots.into_iter().zip(names) {
        let text =
            import(Format::Urdf, "a\nb.urdf", &named(robot, name, name), Options::default()).expect("a robot").text;
        compiles(&text);
        let mut outside = text.lines().take_while(|line| !line.starts_with("bond_graph!"));
        let is_comment = |line: &str| line.starts_with("// ") || line.is_empty() || line == "use bg_model::bond_graph;";
        assert!(outside.all(is_comment), "{text}");
        assert!(!text.chars().any(|c| ['\r', '\u{202e}', '\u{2066}'].contains(&c)), "{text}");
    }
}

#[test]
fn names_that_are_made_of_others_are_no_others() {
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<link name='{child}'>{MASS}</link><joint name='{name}' type='revolute'><parent link='{parent}'/><child \
             link='{child}'/><limit lower='-1' upper='1'/><dynamics damping='1' friction='1'/></joint>"
        )
    };
    let pieces = [
        joint("arm", "a", "arm_start"),
        joint("arm_motor", "arm_start", "arm_stop"),
        joint("arm_place", "arm_stop", "arm_turned"),
        joint("arm_turned_place", "arm_turned", "arm_start_turned"),
        joint("mass", "arm_start_turned", "t"),
    ];
    let text = format!("<robot name='r'><link name='a'/>{}</robot>", pieces.concat());
    compiles(&import(Format::Urdf, "r.urdf", &text, Options::default()).expect("a robot").text);
}

/// The error of an MJCF.
fn refused(text: &str) -> ImportError {
    match import(Format::Mjcf, "r.xml", text, Options::default()) {
        Ok(imported) => panic!("it became\n{}", imported.text),
        Err(fault) => fault,
    }
}

#[test]
fn numbers_of_any_size_become_a_graph_or_an_error() {
    let body = |body: &str, inner: &str| {
        format!(
            "<mujoco><worldbody><body name='b' {body}><joint name='j' axis='0 1 0'/><geom type='box' size='0.1 0.2 \
             0.3'/>{inner}</body></worldbody></mujoco>"
        )
    };
    let quaternion =
        import(Format::Mjcf, "r.xml", &body("quat='0 1e200 0 0'", ""), Options::default()).expect("a robot");
    compiles(&quaternion.text);
    assert!(quaternion.text.contains("rotation_x(3.141592653589793)"), "{}", quaternion.text);
    for size in ["1e200", "1e300", "-1e160"] {
        let text = body(&format!("pos='{size} 0 0'"), "");
        assert!(matches!(refused(&text), ImportError::TooLarge { .. }), "{text}");
        let text = body("", &format!("<body pos='{size} 0 0'><geom size='0.1'/></body>"));
        assert!(matches!(refused(&text), ImportError::TooLarge { .. }), "{text}");
    }
    let text = body("", "<geom size='1e-320' mass='1'/>");
    assert_eq!(refused(&text).to_string(), "line 1: `size` of <geom> is \"1e-320\": it must be above 0");
    let joint =
        |sizes: &str| text.replace("<joint", &format!("<joint {sizes}")).replace("<geom size='1e-320' mass='1'/>", "");
    for sizes in
        ["damping='1e-320'", "armature='1e-310'", "stiffness='1e-320'", "frictionloss='1e-320'", "range='0 1e-320'"]
    {
        compiles(&import(Format::Mjcf, "r.xml", &joint(sizes), Options::default()).expect("a robot").text);
    }
}

#[test]
fn a_robot_in_which_nothing_moves_is_refused() {
    let message = "nothing moves: no joint carries a link with mass; give the links a mass and a joint that is not \
                   fixed, or take --free-base for a URDF whose root moves";
    for text in [
        "<robot name='r'><link name='a'/></robot>".to_owned(),
        named("r", "b", "j").replace("continuous", "fixed"),
        named("r", "b", "j").replace(MASS, ""),
    ] {
        let fault = import(Format::Urdf, "r.urdf", &text, Options::default()).expect_err("nothing moves");
        assert!(fault.to_string().starts_with(message), "{fault}");
    }
    let left_out = "Link `b` has no mass and carries nothing: it is left out with joint `j`.";
    let fault = import(Format::Urdf, "r.urdf", &named("r", "b", "j").replace(MASS, ""), Options::default())
        .expect_err("no mass");
    assert_eq!(fault.to_string(), format!("{message}\nWhat is not there:\n  {left_out}"));
    assert_eq!(refused("<mujoco><worldbody/></mujoco>").to_string(), message);
}

#[test]
fn a_body_may_have_the_name_that_another_one_without_would_get() {
    let body = "<joint/><geom size='0.1'/></body>";
    let text = format!(
        "<mujoco><worldbody><body>{body}<body name='body1'>{body}<body name='body1_joint1'>{body}</worldbody></mujoco>"
    );
    let text = import(Format::Mjcf, "r.xml", &text, Options::default()).expect("a robot").text;
    compiles(&text);
    assert_eq!(text.matches("\n        body ").count(), 3);
}

#[test]
fn a_thousand_links_are_a_thousand_bodies() {
    let link = |k: usize| {
        format!(
            "<link name='l{k}'>{MASS}</link><joint name='j{k}' type='continuous'><origin xyz='0.2 0 0' rpy='0.1 0 0'/>\
             <parent link='l{}'/><child link='l{k}'/><axis xyz='0 1 0'/></joint>",
            k - 1
        )
    };
    let links: String = (1..=1000).map(link).collect();
    let urdf = format!("<robot name='chain'><link name='l0'/>{links}</robot>");
    let text = import(Format::Urdf, "chain.urdf", &urdf, Options::default()).expect("a robot").text;
    assert_eq!(text.matches("\n        body ").count(), 1000);
    // Each name of a start pose stands where it is made, once or twice in its child's and once in its body's.
    assert_eq!(text.matches("l500_turned").count(), 4);
    let fixed = urdf.replacen("continuous", "kept", 1).replace("continuous", "fixed").replace("kept", "continuous");
    let text = import(Format::Urdf, "chain.urdf", &fixed, Options::default()).expect("a robot").text;
    assert!(text.contains("mass 1000;"), "one body has all masses");
    let (open, close) = ("<body pos='0.1 0 0'><joint axis='0 1 0'/><geom size='0.1'/>", "</body>");
    let mjcf = format!("<mujoco><worldbody>{}{}</worldbody></mujoco>", open.repeat(1000), close.repeat(1000));
    let text = import(Format::Mjcf, "chain.xml", &mjcf, Options::default()).expect("a robot").text;
    assert_eq!(text.matches("\n        body ").count(), 1000);
}
