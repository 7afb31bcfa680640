//! What the names of things have after their dot, as an editor shows it.
//!
//! In: an item's kind. Out: its quantities with shape, unit and meaning: those of the language's reference. A test
//! compiles a graph that observes each of them.

use crate::source::ast::{ElementKind, Item, Joint, JointKind, JunctionKind};

/// The shape of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar,
    Vector,
    Matrix,
    /// As many components as the bond has.
    OfBond,
}

/// A quantity: its name, shape and meaning.
pub(super) type Member = (&'static str, Shape, &'static str);

use Shape::{Matrix, OfBond, Scalar, Vector};

/// Of a point of a body.
pub(super) const POINT: [Member; 3] = [
    ("position", Vector, "Place, inertial axes. Unit: m."),
    ("velocity", Vector, "Velocity, inertial axes. Unit: m/s."),
    ("arm", Vector, "From the centre of mass to the point, inertial axes. Unit: m."),
];

const BODY: [Member; 17] = [
    ("position", Vector, "Place of the centre of mass, inertial axes. Unit: m."),
    ("velocity", Vector, "Velocity of the centre of mass, inertial axes. Unit: m/s."),
    ("orientation", Matrix, "Rotation matrix, body to inertial."),
    ("x_axis", Vector, "The body's x axis, inertial axes."),
    ("y_axis", Vector, "The body's y axis, inertial axes."),
    ("z_axis", Vector, "The body's z axis, inertial axes."),
    ("angular_velocity", Vector, "Angular velocity, inertial axes. Unit: rad/s."),
    ("angle", Scalar, "Angle of the body's x axis about the inertial z, with its turns. Unit: rad."),
    ("direction", Scalar, "The same in one turn, -pi to pi. Unit: rad."),
    ("momentum", Vector, "Momentum, inertial axes. Unit: kg*m/s."),
    ("angular_momentum", Vector, "Angular momentum about the centre of mass, inertial axes. Unit: kg*m^2/s."),
    ("p", Vector, "Momentum, inertial axes. Unit: kg*m/s."),
    ("h", Vector, "Angular momentum about the centre of mass, inertial axes. Unit: kg*m^2/s."),
    ("kinetic_energy", Scalar, "Kinetic energy. Unit: J."),
    ("mass", Scalar, "Mass. Unit: kg."),
    ("center", Vector, "Centre of mass, the body's axes. Unit: m."),
    ("tensor", Matrix, "Inertia about the centre of mass, the body's axes. Unit: kg*m^2."),
];

const FORCE: Member = ("force", Vector, "Force on the second body, inertial axes. Unit: N.");
const GAP: Member = ("gap", Vector, "Second end minus first end, inertial axes. Unit: m.");
const EFFORT: Member = ("effort", OfBond, "Effort of its bond, sign along the half arrow.");
const FLOW: Member = ("flow", OfBond, "Flow of its bond, sign along the half arrow.");
const POWER: Member = ("power", Scalar, "Power into it. Unit: W.");

/// What has a name in every graph and part, as `words::QUANTITIES` has it without what only templates name.
pub(super) const EVERYWHERE: [(&str, &str); 4] = [
    ("t", "The time. Unit: s."),
    ("stored_energy", "The energy of all storage elements, bodies and springs among them. Unit: J."),
    ("supplied_power", "The power of all sources into the model. Unit: W."),
    ("dissipated_power", "The power of all resistors out of the model. Unit: W."),
];

/// Of a sample, within its clock's block.
pub(super) const SAMPLE: [Member; 1] =
    [("last", Scalar, "What was held before the instant; only within a block `every`. Unit: the sample's own.")];

/// Of a table of one argument, which is given like the table's own.
const DERIVATIVES: [Member; 2] = [
    ("derivative", Scalar, "`NAME.derivative(a)`: the slope at the argument a. Unit: that of the value per argument."),
    (
        "second_derivative",
        Scalar,
        "`NAME.second_derivative(a)`: how the slope changes there. Unit: that of the value per argument, twice.",
    ),
];

/// What there is after the item's name and a dot.
pub(super) fn of(item: &Item) -> Vec<Member> {
    match item {
        Item::Body(_) => BODY.to_vec(),
        Item::Joint(joint) => of_joint(joint),
        Item::Spring(_) => vec![
            ("force", Vector, "Force on the second end, inertial axes. Unit: N."),
            ("distance", Scalar, "Distance of the two ends. Unit: m."),
        ],
        Item::Contact(_) => vec![FORCE, GAP, ("speed", Scalar, "Speed along the line. Unit: m/s.")],
        Item::ShapeContact(_) => of_shapes(),
        Item::Drive(_) => vec![("power", Scalar, "Minus the power that it gives. Unit: W.")],
        Item::Friction(_) => vec![EFFORT, POWER],
        Item::Stop(_) => vec![EFFORT],
        Item::Junction(junction) if junction.kind == JunctionKind::One => {
            let way = ("displacement", Scalar, "Integral of its flow since the start.");
            [FLOW].into_iter().chain((junction.cardinality == 1).then_some(way)).collect()
        }
        Item::Junction(_) => vec![EFFORT],
        Item::Element(element) => of_element(element.kind),
        Item::Table(table) if table.second.is_none() => DERIVATIVES.to_vec(),
        _ => Vec::new(),
    }
}

fn of_shapes() -> Vec<Member> {
    vec![
        FORCE,
        ("gap", Scalar, "Distance of the shapes, negative where they touch. Unit: m."),
        ("pressed", Scalar, "The force that presses. Unit: N."),
        ("speed", Scalar, "How fast the distance grows. Unit: m/s."),
        ("place", Vector, "Where they touch, or would, inertial axes. Unit: m."),
        ("normal", Vector, "From the first shape to the second, inertial axes."),
    ]
}

fn of_joint(joint: &Joint) -> Vec<Member> {
    let mut members = vec![FORCE];
    if joint.kind != JointKind::Spherical {
        members.push(("moment", Vector, "Moment on the second body, inertial axes. Unit: N*m."));
    }
    members.push(GAP);
    if joint.kind.spin().is_some() {
        members.push(("angle", Scalar, "Angle of the free rotation, with its turns. Unit: rad."));
        members.push(("direction", Scalar, "The same in one turn, -pi to pi. Unit: rad."));
        members.push(("speed", Scalar, "Speed of the free rotation. Unit: rad/s."));
    }
    if joint.clearance.is_some() {
        members.push(("pressed", Scalar, "The force where its play is used up, the sum of all places. Unit: N."));
        if joint.kind.spin().is_some() {
            members.push(("eccentricity", Scalar, "How far the pin is from the middle of its hole. Unit: m."));
        }
    }
    if joint.kind.slide().is_some() {
        members.push(("travel", Scalar, "Way of the free translation. Unit: m."));
    }
    members
}

fn of_element(kind: ElementKind) -> Vec<Member> {
    let stored = match kind {
        ElementKind::I => Some(("p", OfBond, "Momentum: the state of an I.")),
        ElementKind::C => Some(("q", OfBond, "Displacement: the state of a C.")),
        _ => None,
    };
    let energy = stored.map(|_| ("energy", Scalar, "Stored energy. Unit: J."));
    [EFFORT, FLOW, POWER].into_iter().chain(stored).chain(energy).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax::parse;
    use crate::source::walk::{Met, walk};
    use crate::source::words::QUANTITIES;

    /// A graph with each kind of thing that has members.
    const GRAPH: &str = "
        table curve: rad -> m = [[0, 0], [1, 1], [2, 4]], spline;
        param soft: m/N = 1; param stiff: N*m = 1;
        ground { point O = [0, 0, 0]; point P = [1, 0, 0]; }
        body a { mass 1; inertia [1, 1, 1]; point end = [1, 0, 0]; }
        body b { mass 1; inertia [1, 1, 1]; }
        body c { mass 1; inertia [1, 1, 1]; }
        body d { mass 1; inertia [1, 1, 1]; }
        body e { mass 1; inertia [1, 1, 1]; }
        body f { mass 1; inertia [1, 1, 1]; }
        joint revolute: revolute z (ground.O -> a) { stiffness 1; damping 1; tilt stiffness 1; tilt damping 1; }
        joint loose: revolute z (a.end -> b) { stiffness 1; damping 1; clearance 1e-4; tilt stiffness 1; }
        joint gib: prismatic x (ground.O -> b) { stiffness 1; damping 1; clearance 1e-4; length 0.1; tilt stiffness 1; }
        joint prismatic: prismatic x (ground.O -> b) { stiffness 1; damping 1; tilt stiffness 1; tilt damping 1; }
        joint ball: spherical (ground.O -> c) { stiffness 1; damping 1; }
        joint cylindrical: cylindrical x (ground.O -> d) { stiffness 1; damping 1; tilt stiffness 1; tilt damping 1; }
        joint cross: universal x y (ground.O -> e) { stiffness 1; damping 1; tilt stiffness 1; tilt damping 1; }
        joint weld: fixed (ground.O -> f) { stiffness 1; damping 1; tilt stiffness 1; tilt damping 1; }
        spring coil (ground.P -> a.end) { stiffness 1; damping 1; length 0.1; }
        contact edge (a.end -> b along x) { y: C = soft, R = 1; }
        contact shapes (ground.P circle 0.1 -> b circle 0.2) { stiffness 1; damping 1; }
        contact wall (ground.P segment x 0.1 -> b circle 0.2) { stiffness 1; damping 1; }
        drive motor on revolute torque = 1;
        friction rub on prismatic { coulomb 1; }
        stop end on prismatic { at most 1; stiffness 1; }
        1 shaft: rotation; I wheel = 1; R loss = 1; C twist(q) = stiff * q; 0 twisted: rotation; I second = 1; \
        1 far: rotation;
        shaft -> wheel; shaft -> loss; shaft -> twisted -> far; twisted -> twist; far -> second;";

    #[test]
    fn what_is_everywhere_is_known() {
        let mut known = QUANTITIES.to_vec();
        known.retain(|name| *name != "gravity_field");
        assert_eq!(EVERYWHERE.map(|(name, _)| name).to_vec(), known);
    }

    #[test]
    fn each_member_can_be_observed() {
        let source = parse(format!("graph G {{ {GRAPH} }}").parse().expect("tokens")).expect("a graph");
        let mut paths = vec!["a.end.position".to_owned(), "a.end.velocity".to_owned(), "a.end.arm".to_owned()];
        assert_eq!(POINT.map(|(name, ..)| format!("a.end.{name}")).to_vec(), paths);
        for item in &source.graphs[0].items {
            walk(&mut item.clone(), &mut |met| {
                if let Met::Declared(name) = met {
                    paths.extend(of(item).iter().map(|(member, shape, _)| {
                        // A component of each vector, so that its shape is seen.
                        let component = if *shape == Vector { ".z" } else { "" };
                        let argument = if matches!(item, Item::Table(_)) { "(1)" } else { "" };
                        format!("{name}.{member}{component}{argument}")
                    }));
                }
            });
        }
        assert!(paths.len() > 150, "{paths:?}");
        let text = format!("graph G {{ {GRAPH} observe {{ {} }} }}", paths.join("; "));
        let faults = parse(text.parse().expect("tokens")).and_then(|source| crate::pipeline::models(&source)).err();
        let faults: Vec<String> = faults.into_iter().flatten().map(|fault| fault.to_string()).collect();
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }
}
