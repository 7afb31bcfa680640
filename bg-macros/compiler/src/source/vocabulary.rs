//! The words of the language, each with a sentence: what an editor shows and offers.
//!
//! In: the block in which a word stands, as messages call it, and the word. Out: what it says there. Of words that
//! belong together, `rest below`, it is the first one that is listed. A test holds the words of each block against this
//! list.

/// A word.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// The blocks in which it says this, as messages call them; all others where there are none.
    pub of: &'static [&'static str],
    /// What it says.
    pub meaning: &'static str,
}

const fn word(word: &'static str, meaning: &'static str) -> Word {
    Word { word, of: &[], meaning }
}

const fn of(of: &'static [&'static str], word: &'static str, meaning: &'static str) -> Word {
    Word { word, of, meaning }
}

const JOINT: &[&str] = &["a joint"];
const CONTACT: &[&str] = &["a contact of shapes"];
const FRICTION: &[&str] = &["a friction"];
const STOP: &[&str] = &["a stop"];
const BODY: &[&str] = &["a body"];
const ORIFICE: &[&str] = &["an orifice"];
const SCENE: &[&str] = &["a scene"];

/// All words. Where one stands twice, the first entry that is of its block counts.
pub const WORDS: &[Word] = &[
    // The call.
    word("graph", "A mechanism, machine or circuit: `graph NAME { .. }`. It becomes a model."),
    word(
        "part",
        "A piece of machine, described once: `part NAME { .. }`; or a use of one: `part NAME: PART { PARAMETER = \
        VALUE; }`.",
    ),
    // Statements.
    word(
        "param",
        "A parameter, the same during a run: `param length: mm = 600, above 0;`. `--set length=0.7m` changes it.",
    ),
    word(
        "input",
        "A function of time that is given at run time: `input torque: N*m;`. Steps end at the rows of its table.",
    ),
    word("let", "A name for an expression: `let force: N = area * pressure;`. A unit, where given, is checked."),
    word(
        "table",
        "A function by its points: `table curve: rpm -> N*m = [[0, 12], [1500, 0]], spline, held;`, called as \
        `curve(shaft.flow)`.",
    ),
    word("state", "A state of the graph's own, by its rate: `state angle: rad = shaft.flow start 0;`."),
    word(
        "memory",
        "Follows a value while a condition holds, and keeps it else: `memory peak: N = force while force > 10 N;`.",
    ),
    word(
        "every",
        "A digital controller's block: its samples are computed at instants and held in between: `every 1 ms { sample \
        .. }`.",
    ),
    word(
        "sample",
        "A value that is computed at each instant of its block: `sample seen: rad = shaft.displacement;`. `seen.last` \
        is the one before.",
    ),
    word("offset", "When the first instant of a block `every` is, s; 0 when left out."),
    word("while", "The condition of a `memory`: a comparison."),
    word("position", "A point that moves with a flow: the integral of a `1 NAME[3]` junction's velocity, m."),
    word("orientation", "A rotation matrix that turns with a `1 NAME[3]` junction's angular velocity."),
    word("close", "A gap that the start has to close, by changing its guesses."),
    of(
        SCENE,
        "observe",
        "The outputs of the scene: `observe { force: N = norm(pin.force) }`. What they do not need is left out.",
    ),
    word("observe", "The outputs: `observe { speed: rpm = pin.speed; force: N = pin.force.x }`."),
    word("ground", "What does not move, with its points: `ground { point pivot = [0, 1, 0]; }`."),
    word("gravity", "The acceleration of all bodies, inertial axes: `gravity [0, -9.81, 0];`."),
    word(
        "body",
        "A rigid body: solids or `mass` and `inertia`, points, a start: `body rod { cuboid [0.6, 0.03, 0.03] density \
        7850; }`.",
    ),
    word(
        "joint",
        "Joins a point of one body to a point of another: `joint pin: revolute z (ground.O -> rod.end) { rigid; }`.",
    ),
    word(
        "spring",
        "Pulls along the line between two points: `spring back (a.end -> b.end) { stiffness 1 N/mm; length 120 mm; }`.",
    ),
    word("drive", "A torque, force or speed on a joint or body: `drive motor on pin torque = 5;`."),
    word(
        "contact",
        "Two shapes that push and never pull: `contact tip (cam profile lift -> roller circle 5 mm) { stiffness 1e6; \
          damping 50; }`; or a point on a line: `contact c (a.P -> b.Q along x) { y: C = soft; }`.",
    ),
    word(
        "friction",
        "Dry friction that sticks, on a joint, contact or junction: `friction rub on pin { coulomb 0.1; radius 20 mm; \
        }`.",
    ),
    word("stop", "An end of the way of a joint or junction: `stop ends on guide { at most 0.2; restitution 0.6; }`."),
    word("orifice", "Flow through an opening, on a hydraulic 1-junction: `orifice valve on pipe { area 1e-6; .. }`."),
    of(STOP, "start", "The displacement at the start, m or rad: what the ends are counted from."),
    of(
        BODY,
        "start",
        "Where the body starts: `start at [0, 1, 0];`, `start turned rotation_z(0.5);`, `start velocity [1, 0, 0];`, \
        `start spin [0, 0, 9];`.",
    ),
    word("start", "A value at t = 0."),
    word("baumgarte", "A rate, 1/s, at which gaps of rigid joints close, in place of a projection after each step."),
    of(SCENE, "expect", "What the scene is to be, or it is a fault: `expect planar;`, `expect states = 9;`."),
    word("expect", "`expect integral causality;`: a storage in derivative causality is a fault."),
    word("use", "Parts of the library or of a file: `use gears;`, `use \"parts/shaft.bond\";`."),
    word("for", "A repetition: `for i in 1..10 { .. }`."),
    word("port", "A junction or point of a part at which others may join it."),
    word(
        "scene",
        "One use of the mechanism, reduced to what it needs: `scene Swing { observe { .. } expect planar; }`.",
    ),
    word("scenes", "`scenes only;`: the graph has its scenes as models, and not all of itself."),
    // Elements.
    word("Se", "A source of effort: force, torque, voltage, pressure, temperature. It depends on time and inputs."),
    word("Sf", "A source of flow: velocity, speed, current. It depends on time and inputs."),
    word("MSe", "A source of effort that may depend on everything, such as a motor by its curve."),
    word("MSf", "A source of flow that may depend on everything."),
    word("rSe", "A residual sink: the effort that keeps the flow at a value, a Lagrange multiplier."),
    word("I", "An inertia: mass, moment of inertia, inductance: flow = momentum / E."),
    word("C", "A spring or capacity: effort = E * displacement, or displacement / E; the unit of E says which."),
    word("R", "A resistor: damper, friction, resistance, throttle: effort = E * flow, or a law of a variable."),
    word("MR", "A resistor whose law may depend on everything."),
    word("TF", "A transformer, such as a gear or lever: flow out = E * flow in."),
    word("MTF", "A transformer whose ratio may depend on everything."),
    word("GY", "A gyrator, such as a motor's constant: effort in = E * flow out."),
    word("MGY", "A gyrator whose ratio may depend on everything."),
    // Tables.
    word("straight", "A table has straight lines between its points, also without this word."),
    word("monotone", "A table has cubics that rise and fall only where its points do."),
    word("spline", "A table is a cubic spline with a continuous second derivative."),
    word("held", "Beyond its points a table keeps the value at its end."),
    word("continued", "Beyond its points a table goes straight on with the slope there."),
    word("periodic", "Beyond its points a table begins again, as a cam after a turn."),
    // Joints.
    word("revolute", "A pin: free to turn about one axis: `revolute z`."),
    word("prismatic", "A slider: free to move along one axis: `prismatic x`."),
    word("spherical", "A ball joint: free to turn about all axes."),
    word("cylindrical", "Free to move along and to turn about one axis."),
    word("universal", "A Cardan joint: free to turn about two axes, one of each body: `universal x y`."),
    word("fixed", "Nothing is free."),
    of(SCENE, "rigid", "`rigid joints;` or `rigid { a, b }`: joints of the scene that do not give way."),
    of(CONTACT, "rigid", "The shapes do not give way: they part at once with a `restitution`, or rest on each other."),
    word("rigid", "The joint does not give way; its reactions are solved for."),
    word(
        "clearance",
        "The play of a pin or slider, m: within it nothing acts. `stiffness`, and a `damping` or `restitution`, are \
        those of the contact.",
    ),
    of(JOINT, "length", "Of a slider with play: how long it is, m."),
    word("length", "Of a solid, m."),
    of(&["a spring"], "length", "The unloaded length, m; 0 when left out."),
    of(
        JOINT,
        "stiffness",
        "Force over the gap, N/m, in the directions that are not free; with a `clearance` that of what touches.",
    ),
    of(CONTACT, "stiffness", "Force over the depth, N/m; with `exponent n` over the depth to the power n, N/m^n."),
    of(FRICTION, "stiffness", "Where shapes touch in space it sticks by a spring of this stiffness, N/m."),
    of(&["a speed drive"], "stiffness", "Of the coupling through which the speed acts, N*m/rad or N/m."),
    word("stiffness", "Force over the displacement, N/m; of a rotation torque over the angle, N*m/rad."),
    word("damping", "Force over the speed, N*s/m; of a rotation torque over the angular speed, N*m*s/rad."),
    word(
        "tilt",
        "`tilt stiffness` and `tilt damping` of a joint: against rotations that are not free, N*m/rad and N*m*s/rad.",
    ),
    of(JOINT, "frame", "`frame inertial;`: stiffness and damping act in inertial axes."),
    word("exponent", "n: the force of what touches is k d^n with the depth d; 1.5 is Hertz's for round shapes."),
    word(
        "dissipation",
        "a, s/m: the force of what touches is times 1 + 3/2 a v, with the rate v of the depth; \
        Hunt and Crossley's law.",
    ),
    of(STOP, "restitution", "The part of its speed, 0 to 1, with which what hits the stop leaves it."),
    word(
        "restitution",
        "The part of their speed, 0 to 1, with which two shapes part again; Lankarani and Nikravesh's law.",
    ),
    word(
        "rest",
        "`rest below`: a speed, m/s or rad/s, below which what hits does not rebound, or counts as that slow.",
    ),
    // Shapes.
    word("circle", "A circle around the end, in the plane across its z axis: `circle 5 mm`, the radius."),
    word("hole", "The inside of a circle or sphere: `hole 10 mm`, the radius."),
    of(BODY, "sphere", "A solid sphere: `sphere radius 0.02 density 7850;`."),
    word("sphere", "A sphere around the end: `sphere 5 mm`, the radius."),
    word("line", "A straight edge through the end: `line x`; free is what lies to its left."),
    word("plane", "A plane through the end: `plane z`, the axis that is its outward normal."),
    word("segment", "A thin wall from the end on: `segment x 20 mm`, its direction and length."),
    word("slot", "The inside of a slot: `slot x 30 mm width 8 mm`, from the end to the other rounded end."),
    word("width", "How wide a slot is, m."),
    word("arc", "A thin wall on a circle: `arc 20 mm from 0 to 90 deg`."),
    word("from", "Where an arc begins, rad."),
    word("to", "Where an arc ends, rad."),
    word(
        "profile",
        "A cam by its outline, a periodic table of the radius over the angle, or a track by its height: `profile \
        lift`.",
    ),
    word("along", "The axis along which something lies, acts or slides."),
    word("about", "The axis about which something acts."),
    // Bodies.
    word("cuboid", "A solid block: `cuboid [0.6, 0.03, 0.03] density 7850;`, its edges along the body's axes, m."),
    word("cylinder", "A solid cylinder: `cylinder radius 0.01 length 0.3 along x density 7850;`."),
    of(ORIFICE, "density", "Of the fluid, kg/m^3."),
    word("density", "Of a solid, or of all solids of the body, kg/m^3."),
    word("mass", "The body's mass, kg: `mass 842 g;`."),
    word("center", "The centre of mass, in the body's axes, m."),
    word("inertia", "Three moments or the tensor about the centre of mass, in the body's axes, kg*m^2."),
    word("point", "A named point of the body or the ground, m: `point end = [0.3, 0, 0];`."),
    word("turned", "The orientation of a start, point or solid, a rotation matrix: `turned rotation_z(30 deg)`."),
    // Friction, orifices.
    word(
        "coulomb",
        "The friction while it slides, N or N*m; with `normal`, with `radius` or on a contact a coefficient.",
    ),
    word("static", "The friction that holds at rest, N or N*m, or a coefficient; that of `coulomb` when left out."),
    word("stribeck", "The speed over which the friction falls from `static` to `coulomb`, m/s or rad/s."),
    word("viscous", "A friction that grows with the speed, N*s/m or N*m*s/rad."),
    word("normal", "The force that presses, N."),
    of(FRICTION, "radius", "Of a journal, m: the friction is a torque, pressed by the joint's force."),
    word("radius", "Of a solid, m."),
    word("creep", "A speed: the friction is smooth and creeps in place of sticking, m/s or rad/s."),
    of(STOP, "at", "`at most` and `at least`: the ends of the way, m or rad."),
    word("at", "Where something is, m."),
    word("area", "Of the opening, m^2."),
    word("coefficient", "The discharge coefficient, a pure number such as 0.62."),
    word("laminar", "The pressure below which the flow is laminar, Pa."),
    // Scenes.
    word(
        "tune",
        "The parameters that can still be set: `tune { length }`, `tune all but { mass }`. The others are their \
        defaults, as numbers.",
    ),
    word("without", "Elements and drives that the scene leaves out: `without { motor }`."),
    of(
        SCENE,
        "all",
        "`all reactions;`: each direction of a rigid joint has a reaction that is solved for in each rate.",
    ),
    word("all", "All states or outputs of something: `all of rod;`."),
    word(
        "dependent",
        "Bodies whose orientations follow from the others by loops in closed form: `dependent { coupler }`.",
    ),
    word("angles", "States of rotations in the plane are angles, not matrices."),
    word("planar", "The motion stays in the plane, which is proved."),
    word("states", "How many states the scene has: `expect states = 9;`."),
    word(
        "independent",
        "`expect independent speeds;`: no speed that a rigid joint determines is a state, or it is a fault.",
    ),
    // Uses and directions.
    word("on", "The joint, contact, body or junction on which something acts."),
];

/// What a word says in a block.
#[must_use]
pub fn meaning(block: &str, word: &str) -> Option<&'static str> {
    let known = || WORDS.iter().filter(|known| known.word == word);
    let of_block = known().find(|known| known.of.contains(&block));
    of_block.or_else(|| known().find(|known| known.of.is_empty())).map(|known| known.meaning)
}

/// The first ones of words with which statements begin.
pub fn first_words(beginnings: &[&'static str]) -> impl Iterator<Item = &'static str> {
    let first = beginnings.iter().filter_map(|words| words.split(' ').next());
    // Junctions and axes are no words.
    first.filter(|word| !["0", "1", "x", "y", "z"].contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax::BLOCKS_OF_WORDS;

    #[test]
    fn each_word_that_begins_a_statement_is_told() {
        let mut count = 0;
        for block in BLOCKS_OF_WORDS {
            for word in first_words(block.words) {
                assert!(meaning(block.name, word).is_some(), "`{word}` of {}", block.name);
                count += 1;
            }
        }
        assert!(count > 100, "{count}");
    }
}
