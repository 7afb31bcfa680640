//! Terminals of units: what belongs together, in which sense values are shared and balanced, and whether hosts can read
//! it.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use bg_fmi::archive::archive;
use bg_fmi::{Described, Exported, Instance, Interface, Of, Packing, Version, model_description, terminals_and_icons};
use bg_model::bond_graph;
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

static MOTOR: Of<Motor> = Of::NEW;
static DRIVEN: Of<Driven> = Of::NEW;
static ARM: Of<Arm> = Of::NEW;
static TURNED: Of<Turned> = Of::NEW;
static WATCHED: Of<Watched> = Of::NEW;
static CLOSED: Of<Closed> = Of::NEW;
static PUSHED: Of<Pushed> = Of::NEW;
static LINKED: Of<Linked> = Of::NEW;
const VERSIONS: [Version; 2] = [Version::Three, Version::Two];

bond_graph! {
    /// A motor between an electrical network and a load, both left to the host.
    graph Motor {
        input voltage: V;
        input load: N*m;
        Se supply = voltage;
        1 armature: electrical; I winding = 0.002; R coil = 0.5; GY constant = 0.1;
        1 shaft: rotation; I rotor = 0.001; R bearing = 0.02; Se brake = load;
        supply -> armature -> winding; armature -> coil; armature -> constant -> shaft -> rotor; shaft -> bearing;
        shaft -> brake;
        observe { current: A = armature.flow; speed: rad/s = shaft.flow; friction = bearing.effort;
            supplied: W = supplied_power }
    }
}

bond_graph! {
    /// A mass on a spring whose other end the host moves. A parameter has the name of an output.
    graph Driven {
        param force: N = 1;
        param stiffness: N/m = 100;
        input speed: m/s;
        Sf end = speed;
        0 joint: translation; C spring = stiffness; 1 slide: translation; I mass = 2; Se pull = force;
        end -> joint -> spring; joint -> slide -> mass; pull -> slide;
        observe { force: N = joint.effort; velocity: m/s = slide.flow; end.effort; }
    }
}

bond_graph! {
    /// A rod on a pin: its pose, its angle, and the place alone of a second one.
    graph Arm {
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 1, 0]; }
        body rod { cuboid [0.6, 0.03, 0.03] density 7850; point end = [-0.3, 0, 0]; point tip = [0.3, 0, 0];
            start end at [0, 1, 0]; }
        body bob { cuboid [0.1, 0.1, 0.1] density 7850; start at [0.6, 1, 0]; }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        joint knot: spherical (rod.tip -> bob) { stiffness 1e6; damping 1e3; }
        observe { C: m = rod.position; R = rod.orientation; angle: rad = rod.angle; depth: m = bob.position.y;
            force: N = pin.force }
    }
}

bond_graph! {
    /// A rod on a driven pin, of which the speed is observed in both ways.
    graph Turned {
        input torque: N*m;
        ground { point pivot = [0, 1, 0]; }
        body rod { cuboid [0.6, 0.03, 0.03] density 7850; point end = [-0.3, 0, 0]; start end at [0, 1, 0]; }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        drive motor on pin torque = torque;
        observe { speed: rad/s = pin.speed; again: rad/s = motor.flow; supplied: W = supplied_power; }
        scene Watched { observe { speed: rad/s = pin.speed; R = rod.orientation; C: m = rod.position; } angles;
            expect planar; }
    }
}

bond_graph! {
    /// Efforts and flows, but not of one bond.
    graph Closed {
        param stiffness: N/m = 50;
        1 slide: translation; I mass = 2; C spring = stiffness start 0.1; R damper = 3;
        slide -> mass; slide -> spring; slide -> damper;
        observe { x: m = spring.q; v2 = slide.flow * slide.flow; spring.effort; }
    }
}

bond_graph! {
    /// A mass in space with vectors for effort and flow.
    graph Pushed {
        1 free[3]: translation; I mass = 2; R drag(v) = 0.5 * v;
        Se weight = [0, -19.62, 0];
        weight -> free -> mass; free -> drag;
        observe { v: m/s = free.flow; drag_y: N = drag.effort.y }
    }
}

bond_graph! {
    /// Two rods, the first one driven, on a pin and a soft knee, whose loads are observed.
    graph Linked {
        input torque: N*m;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 1, 0]; }
        body thigh { cuboid [0.6, 0.03, 0.03] density 7850; point hip = [-0.3, 0, 0]; point knee = [0.3, 0, 0];
            start hip at [0, 1, 0]; }
        body shank { cuboid [0.4, 0.03, 0.03] density 7850; point knee = [-0.2, 0, 0]; start at [0.8, 1, 0]; }
        joint pin: revolute z (ground.pivot -> thigh.hip) { rigid; }
        joint knee: revolute z (thigh.knee -> shank.knee) { stiffness 1e6; damping 200; tilt stiffness 1e4;
            tilt damping 5; }
        drive motor on pin torque = torque;
        observe {
            F: N = pin.force; M: N*m = pin.moment; v: m/s = thigh.hip.velocity; w: rad/s = thigh.angular_velocity;
            G: N = knee.force; L: N*m = knee.moment; a: m/s = thigh.knee.velocity; b: m/s = shank.knee.velocity;
            u: rad/s = shank.angular_velocity;
            motor: W = motor.power; dissipated: W = dissipated_power;
            stretch: m = knee.gap;
        }
    }
}

/// An element's attributes.
fn attributes(element: &BytesStart<'_>) -> BTreeMap<String, String> {
    let pairs = element.attributes().map(Result::unwrap);
    let text = |pair: Attribute<'_>| pair.normalized_value(XmlVersion::Explicit1_0).unwrap().into_owned();
    pairs.map(|pair| (pair.key.as_ref().to_owned(), text(pair))).collect()
}

/// The elements of a document of these names, in order.
fn elements(xml: &str, wanted: &[&str]) -> Vec<(String, BTreeMap<String, String>)> {
    let mut reader = Reader::from_str(xml);
    let mut found = Vec::new();
    loop {
        match reader.read_event().unwrap() {
            Event::Start(element) | Event::Empty(element) => {
                let name = element.name().as_ref().to_owned();
                if wanted.contains(&name.as_str()) {
                    found.push((name, attributes(&element)));
                }
            }
            Event::Eof => return found,
            _ => {}
        }
    }
}

/// A unit after 0.1 s of Co-Simulation, whose variables are called by their names.
struct Running {
    instance: Instance,
    references: BTreeMap<String, u32>,
}

impl Running {
    fn new(model: &'static dyn Exported, inputs: &[(&str, f64)]) -> Self {
        let description = model_description(model.described(), &Packing::default());
        let variables = elements(&description, &["Float64"]).into_iter();
        let references: BTreeMap<_, _> =
            variables.map(|(_, of)| (of["name"].clone(), of["valueReference"].parse().unwrap())).collect();
        let mut instance = Instance::new(model, Interface::CoSimulation);
        instance.enter_initialization(0.0, None).unwrap();
        for (name, value) in inputs {
            instance.set(&[references[*name]], &[*value]).unwrap();
        }
        instance.exit_initialization().unwrap();
        instance.step(0.0, 0.1).unwrap();
        Self { instance, references }
    }

    fn get(&mut self, name: &str) -> f64 {
        let mut value = [f64::NAN];
        self.instance.get(&[self.references[name]], &mut value).unwrap();
        value[0]
    }
}

/// A model's terminals, a line each: `NAME (RULE): MEMBER = VARIABLE KIND, ..`.
fn lines(model: &dyn Described) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (element, of) in elements(&terminals_and_icons(model).unwrap(), &["Terminal", "TerminalMemberVariable"]) {
        if element == "Terminal" {
            lines.push(format!("{} ({}):", of["name"], of["matchingRule"]));
        } else {
            *lines.last_mut().unwrap() +=
                &format!(" {} = {} {},", of["memberName"], of["variableName"], of["variableKind"]);
        }
    }
    lines
}

#[test]
fn sources_that_are_inputs_are_ports() {
    // Electrical: the voltage is shared, the current balanced; mechanical: the speed is shared, the moment balanced.
    let wanted = [
        "supply (plug): effort = voltage signal, flow = current inflow,",
        "bearing (bus): effort = friction signal, flow = speed signal,",
        "brake (plug): effort = load outflow, flow = speed signal,",
    ];
    assert_eq!(lines(&MOTOR), wanted);
}

#[test]
fn a_flow_can_be_the_input() {
    // The parameter of the output's name is no member; a bond between junctions is named by both.
    let wanted = [
        "end (plug): effort = end.effort inflow, flow = speed signal,",
        "joint -> slide (bus): effort = force signal, flow = velocity signal,",
    ];
    assert_eq!(lines(&DRIVEN), wanted);
}

#[test]
fn a_joints_speed_is_the_flow_of_what_drives_it() {
    let mut unit = Running::new(&TURNED, &[("torque", 40.0)]);
    assert!(unit.get("speed") > 0.1 && (unit.get("speed") - unit.get("again")).abs() < 1e-12);
}

#[test]
fn ports_tell_the_power_into_the_model() {
    // What goes in through all ports is what its sources supply: the signs are right.
    let motor = (&MOTOR as &'static dyn Exported, &[("voltage", 12.0), ("load", 0.3)][..]);
    for (model, inputs) in [motor, (&TURNED, &[("torque", 40.0)])] {
        let mut unit = Running::new(model, inputs);
        let text = terminals_and_icons(model.described()).unwrap();
        let mut power = 0.0;
        for group in elements(&text, &["Terminal", "TerminalMemberVariable"]).windows(3) {
            let [(_, terminal), (_, effort), (_, flow)] = group else { unreachable!("three of them") };
            if terminal.get("matchingRule").is_some_and(|rule| rule == "plug") {
                let product = unit.get(&effort["variableName"]) * unit.get(&flow["variableName"]);
                let is_inward = [effort, flow].iter().any(|member| member["variableKind"] == "inflow");
                power += if is_inward { product } else { -product };
            }
        }
        let supplied = unit.get("supplied");
        assert!(supplied > 0.1 && (power - supplied).abs() < 1e-12 * supplied, "{power} W, supplied {supplied} W");
    }
}

#[test]
fn a_scene_has_terminals_of_its_own() {
    let [motor, rod] = &lines(&WATCHED)[..] else { panic!("{:#?}", lines(&WATCHED)) };
    assert_eq!(motor, "motor (plug): effort = torque inflow, flow = speed signal,");
    assert!(rod.starts_with("rod (bus): position_x = C_x signal,"), "{rod}");
}

#[test]
fn bodies_with_place_and_direction_are_frames() {
    let place = "position_x = C_x signal, position_y = C_y signal, position_z = C_z signal";
    let matrix = ["11", "12", "13", "21", "22", "23", "31", "32", "33"];
    let matrix = matrix.map(|at| format!("orientation_{at} = R_{at} signal")).join(", ");
    assert_eq!(lines(&ARM), [format!("rod (bus): {place}, {matrix}, angle = angle signal,")]);
}

#[test]
fn vectors_are_read_only() {
    let components = "effort_y = drag_y signal, flow_x = v_x signal, flow_y = v_y signal, flow_z = v_z signal";
    assert_eq!(lines(&PUSHED), [format!("drag (bus): {components},")]);
}

#[test]
fn without_a_pair_there_is_no_file() {
    assert_eq!(terminals_and_icons(&CLOSED), None);
    let has_file = |model: &dyn Described, version| {
        let packing = Packing { version, ..Packing::default() };
        let bytes = archive(model, &packing, b"library", &[]).unwrap();
        let name = b"terminalsAndIcons/terminalsAndIcons.xml";
        bytes.windows(name.len()).any(|window| window == name)
    };
    for version in VERSIONS {
        assert!(!has_file(&CLOSED, version) && has_file(&MOTOR, version));
    }
}

/// The power through each end of a model's joints, W, by `JOINT.END`, where its unit stands.
fn through_ends(unit: &mut Running, model: &dyn Described) -> BTreeMap<String, f64> {
    let (mut joint, mut end, mut members) =
        (String::new(), String::new(), BTreeMap::<String, BTreeMap<String, f64>>::new());
    for (element, of) in elements(&terminals_and_icons(model).unwrap(), &["Terminal", "TerminalMemberVariable"]) {
        match (element.as_str(), of.get("terminalKind").map(String::as_str)) {
            ("Terminal", Some("_bg-fmi_joint")) => joint.clone_from(&of["name"]),
            ("Terminal", Some("_bg-fmi_end")) => end = format!("{joint}.{}", of["name"]),
            ("Terminal", _) => end.clear(),
            _ if !end.is_empty() => {
                let value = unit.get(&of["variableName"]);
                members.entry(end.clone()).or_default().insert(of["memberName"].clone(), value);
            }
            _ => {}
        }
    }
    let product = |of: &BTreeMap<String, f64>, [effort, flow]: [&str; 2]| -> f64 {
        ["x", "y", "z"].iter().map(|axis| of[&format!("{effort}_{axis}")] * of[&format!("{flow}_{axis}")]).sum()
    };
    let power =
        |of: &BTreeMap<String, f64>| product(of, ["force", "velocity"]) + product(of, ["moment", "angular_velocity"]);
    members.iter().map(|(end, of)| (end.clone(), power(of))).collect()
}

#[test]
fn the_ends_of_joints_are_terminals_inside_the_joints() {
    let lines = lines(&LINKED);
    let pin: Vec<&str> = lines.iter().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(pin, ["pin", "second", "knee", "first", "second"], "{lines:?}");
    assert!(
        lines[1].contains(" force_x = F_x signal,") && lines[1].contains(" velocity_y = v_y signal,"),
        "{}",
        lines[1]
    );
    assert!(
        lines[3].contains(" velocity_z = a_z signal,") && lines[4].contains(" velocity_z = b_z signal,"),
        "{lines:?}"
    );
    // Of a joint without all of its loads nothing is told.
    assert!(!terminals_and_icons(&ARM).unwrap().contains("_bg-fmi_joint"));
}

#[test]
fn the_power_through_joints_is_that_of_the_graph() {
    let mut unit = Running::new(&LINKED, &[("torque", 40.0)]);
    let power = through_ends(&mut unit, &LINKED);
    let near = |value: f64, wanted: f64| (value - wanted).abs() < 1e-12 * wanted.abs().max(1.0);
    // Into the thigh goes through the rigid pin what the motor gives.
    let supplied = -unit.get("motor");
    assert!(supplied > 1.0 && near(power["pin.second"], supplied), "{power:?} {supplied}");
    // The knee gives on what it takes, less what its dampers and its springs take: these are known by their laws.
    let kept = power["knee.first"] - power["knee.second"];
    let mut along = 0.0;
    for axis in ["x", "y", "z"] {
        let slip = unit.get(&format!("b_{axis}")) - unit.get(&format!("a_{axis}"));
        along += 1e6 * unit.get(&format!("stretch_{axis}")) * slip;
    }
    let lost = unit.get("dissipated");
    assert!(lost > 1e-9 && kept.abs() > 1e-9, "{lost} {kept}");
    assert!(near(kept, lost + along), "{kept} {lost} {along}");
}

#[test]
fn members_are_inputs_and_outputs_of_the_unit() {
    for model in [&MOTOR as &dyn Described, &DRIVEN, &ARM, &TURNED, &WATCHED, &PUSHED, &LINKED] {
        let description = model_description(model, &Packing::default());
        let variables = elements(&description, &["Float64"]).into_iter();
        let causalities: BTreeMap<_, _> =
            variables.map(|(_, of)| (of["name"].clone(), of["causality"].clone())).collect();
        let members = elements(&terminals_and_icons(model).unwrap(), &["TerminalMemberVariable"]);
        assert!(!members.is_empty());
        for (_, member) in members {
            let causality = causalities.get(&member["variableName"]).map(String::as_str);
            assert!(matches!(causality, Some("input" | "output")), "{member:?}: {causality:?}");
        }
    }
}

#[test]
fn hosts_can_read_it() {
    let python = std::env::var("FMPY_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let run = |arguments: &[&str]| Command::new(&python).args(arguments).output();
    if !run(&["-c", "import fmpy, lxml"]).is_ok_and(|output| output.status.success()) {
        println!("skipped: fmpy is not installed");
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/units/hosts/terminals_check.py");
    let folder = tempfile::tempdir().unwrap();
    for (model, count) in [
        (&MOTOR as &dyn Described, "3"),
        (&DRIVEN, "2"),
        (&ARM, "1"),
        (&TURNED, "1"),
        (&WATCHED, "2"),
        (&PUSHED, "1"),
        (&LINKED, "2"),
        (&CLOSED, "0"),
    ] {
        for version in VERSIONS {
            let path = folder.path().join("model.fmu");
            std::fs::write(&path, archive(model, &Packing { version, ..Packing::default() }, b"library", &[]).unwrap())
                .unwrap();
            let output = run(&[script.to_str().unwrap(), path.to_str().unwrap()]).unwrap();
            let errors = String::from_utf8_lossy(&output.stderr);
            assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), format!("{count} terminals"), "{errors}");
        }
    }
}
