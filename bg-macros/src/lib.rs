//! The procedural macro `bond_graph!`. Its documentation is the reference of the language; users get it as
//! `bg_model::bond_graph`, together with what generated code needs at run time.

use proc_macro::TokenStream;

/// Compiles multibond graphs of mechanisms, machines and circuits to Rust types that run.
///
/// A call holds graphs and parts. Each graph becomes a model type, a parameter struct and, where it has inputs, an input
/// struct ([generated items](#generated-items)); so does each of its [scenes](#scenes), the uses of one mechanism, of
/// which only what a use needs is calculated. A [part](#parts) is a piece of machine that graphs of this call, of the crate
/// and of other crates use, often if need be. Everything the compiler cannot accept is a compile error at the token
/// to change, with a code and one action as help ([faults](#faults)).
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A direct-current motor with friction in its bearing.
///     pub graph Motor {
///         param winding: Ohm = 0.8, above 0;
///         param coil: H = 2e-3, above 0;
///         param constant: N*m/A = 0.05;
///         param rotor: kg*m^2 = 1e-3, above 0;
///         input voltage: V;
///
///         Se supply = voltage;
///         1 armature; I L = coil; R Ra = winding;
///         GY motor = constant;
///         1 shaft; I J = rotor; R bearing(w) = 1e-3 * w + 0.02 * tanh(w / 0.1);
///
///         supply -> armature -> L; armature -> Ra; armature -> motor -> shaft -> J; shaft -> bearing;
///         observe { current: A = armature.flow; speed: rad/s = shaft.flow }
///     }
/// }
/// # fn main() { assert_eq!((Motor::STATES, Motor::OUTPUTS), (2, 2)); }
/// ```
///
/// The language has two vocabularies. **Bond-graph words** are the field's own: junctions, elements, half arrows.
/// **Mechanism words** (`body`, `joint`, ...) are shorthand for fragments of multibond graph; the compiler replaces
/// them by bond-graph words first, and `Description::graph` of every model is that expanded graph as text. Both mix
/// freely: a motor's shaft can be bonded to a joint's free axis.
///
/// # Statements
///
/// ```text
/// call      = { graph | part }
/// graph     = [visibility] "graph" NAME "{" { statement | scene } "}"
/// part      = [visibility] "part" NAME "{" { statement | port } "}"
/// statement = param | input | let | junction | element | chain | position | orientation | close | observe
///           | ground | gravity | body | joint | spring | drive | contact | friction | stop | orifice | start | baumgarte | expect | use | for
/// expect    = "expect" "integral" "causality" ";"
/// ```
///
/// Order is free: a name may be used before it is declared. Outputs keep the order of declaration; so do states of one
/// kind and unit, which stand side by side in the state vector: `description().states` names them. A statement ends with
/// `;`, or with its closing brace. Comments are Rust's. Documentation comments (`///`) stand in front of `graph`, `part`, `scene`,
/// `param` and `input` and become the documentation of the generated items.
///
/// Names are Rust identifiers, Rust's keywords excluded; `gen`, a keyword of the edition 2024 only, makes a field `r#gen`.
/// A graph, a scene or a parameter may be called `Option`, `f64` or whatever else: generated code means something else by
/// none of them. Names may have dots (`pin.slip`), but those of graphs, parts, scenes and points of bodies, and numbers in
/// brackets (`link[3].bar`, [arrays](#arrays-and-repetitions)). All of a graph's names are different, its outputs' among
/// themselves; `t` is the time.
///
/// ## `param`, `input`, `let`
///
/// ```text
/// param = "param" NAME ":" UNIT "=" NUMBERS { "," ("above" | "at" "least" | "below" | "at" "most") NUMBERS } ";"
/// input = "input" NAME ":" UNIT ";"
/// let   = "let" NAME [":" UNIT] "=" EXPRESSION ";"
/// ```
///
/// - A **parameter** stays the same during a run. Its default and the ends of its range are made of numbers and `+ - *
///   /`. The range is checked by the generated `new`. One that nothing in its graph uses is a fault, and so is such an input (BG0811).
/// - An **input** is a function of time, given at run time as a `bg_model::input::Input`: a constant, a closure, or a table
///   with straight lines or a cubic spline between its rows. Steps end at the rows of a table.
/// - A **let** names an expression. A unit, where given, is checked.
///
/// ## Junctions: `0`, `1`
///
/// ```text
/// junction = ("0" | "1") NAME ["[3]"] [":" DOMAIN] { "," NAME ["[3]"] [":" DOMAIN] } ";"
/// ```
///
/// A 0-junction has one effort, its flows balance; a 1-junction has one flow, its efforts balance. `[3]` makes a
/// multibond junction of three components. The domain fixes the units of effort and flow. It may be left out where a
/// source, a parameter or a neighbour behind a two-port fixes them.
///
/// | domain | effort | flow | displacement (C) | momentum (I) |
/// |---|---|---|---|---|
/// | `translation` | N | m/s | m | kg\*m/s |
/// | `rotation` | N\*m | rad/s | rad | kg\*m^2/s |
/// | `electrical` | V | A | C | Wb |
/// | `hydraulic` | Pa | m^3/s | m^3 | Pa\*s |
/// | `thermal` | K | W/K | J/K | K\*s |
///
/// ## Chains of half arrows
///
/// ```text
/// chain = NAME "->" NAME { "->" NAME } ";"
/// ```
///
/// Each `->` is a bond. **Power is positive along the half arrow, always.** A one-port (source, I, C, R) has exactly
/// one bond; a two-port (TF, GY) has one in and one out, so it stands inside a chain. No bond joins a node to itself.
/// Conventions: half arrows point from sources into the graph and from junctions into I, C and R. Then an R dissipates
/// positive power, and the momentum and displacement of I and C have the sign of the junction's effort and flow.
///
/// ## Elements
///
/// ```text
/// element = KIND NAME ["(" ["effort" | "flow"] NAME ")"] "=" EXPRESSION { clause } ";"
/// clause  = "in" EXPRESSION | "at" EXPRESSION | "start" EXPRESSION | "energy" EXPRESSION
///         | "of" JOINT [("along" | "about") AXIS] | "holds" EXPRESSION
///         | "restitution" EXPRESSION | "rest" "below" EXPRESSION
/// ```
///
/// Without a variable the law is linear in the expression. With one, `R bearing(w) = ...`, the expression is the law
/// itself.
///
/// | word | linear law `= E` | law of a variable |
/// |---|---|---|
/// | `Se`, `MSe` | effort E | - |
/// | `Sf`, `MSf` | flow E | - |
/// | `rSe` | residual sink: the effort that keeps the flow at E, a Lagrange multiplier | - |
/// | `I` | flow = momentum / E | `I a(p) = ...` flow from momentum |
/// | `C` | effort = E \* displacement, or displacement / E: the unit of E says whether it is a stiffness or a compliance; `2 * k` has the unit of k | `C a(q) = ...` effort from displacement |
/// | `R`, `MR` | effort = E \* flow, in either causality | `R a(f) = ...` effort from flow; `R a(effort e) = ...` flow from effort |
/// | `TF`, `MTF` | flow out = E \* flow in, effort in = E \* effort out | `TF a(f) = ...` flow out from flow in; `TF a(effort e) = ...` effort out from effort in |
/// | `GY`, `MGY` | effort in = E \* flow out, effort out = E \* flow in | - |
///
/// - A transformer's law must be linear in its variable; the other variable comes back through the transposed matrix,
///   so that power is conserved. It may change the cardinality: `TF lift(v) = dot([0, 1, 0], v)` joins a multibond to a
///   scalar one.
/// - What a law may depend on: `Se`, `Sf` on parameters, inputs and time; `TF`, `GY` and a linear `R` on parameters;
///   the words with an `M`, and the law of a variable of an R, on everything: states, flows, efforts, inputs, time; `I`
///   and `C` on everything but inputs.
/// - `in R` (only I): the matrix of the law is constant in the axes that the orientation R turns.
/// - `at E` (only C): the displacement is E, which the poses determine, and no state of its own. The compiler proves
///   that E changes with the flow of the C's bond: the difference of dE/dt, by the chain rule along the tracked
///   junctions, and that flow must vanish as a polynomial identity. Otherwise BG0505.
/// - `rSe NAME = FLOW at GAP` keeps the flow of its bond at FLOW: a rigid link, a wheel that does not slip. The effort
///   is solved for, so `NAME.effort` can be observed like any other. `at GAP` names the displacement that the poses
///   determine and that is to stay zero ([rigid joints](#rigid-joints)). FLOW may depend on parameters,
///   states and `t`, not on an input, whose rate is not known. The power of a sink whose FLOW is not 0 counts as
///   supplied.
/// - `of JOINT` (only rSe): the sink is part of this joint, whose gaps `close` states; messages name the joint, and
///   `along x` or `about x` the direction of a scalar sink. A sink of no joint is named by itself, and its GAP is closed
///   at the start.
/// - `holds E` (only an R or MR whose law is of its flow, on a scalar bond) makes it **dry friction**: while the flow is not 0
///   its effort is the law's, against the flow, `R rub(v) = 5 + 2 * v holds 6`; the law is asked for v above 0 and negated for
///   the other way. At rest it sticks: the effort is the one that keeps the flow at 0, up to E in either direction ([dry
///   friction](#dry-friction)). E and the law may depend on everything but reactions that the friction itself changes
///   (BG0515, of the law only). Where the law at 0 is more than E, it holds that. A momentum has to determine the flow, and no input (BG0516).
/// - `restitution E` (only a scalar rSe `= 0 at GAP` of no joint) makes it a **stop**, which acts one way only: GAP is how far its
///   end is passed, which stays at 0 or below ([stops with a restitution](#stops-with-a-restitution)). E is of parameters, from 0 to
///   1 (BG0704), and so is V of `rest below V`. A momentum has to determine the flow, and no input (BG0517).
/// - `start E` (I, C): momentum or displacement at t = 0, of parameters and the start pose only; 0 when left out.
/// - `energy E` (I, C with a law of a variable): the stored energy. For a scalar law that the compiler can integrate it
///   may be left out; the energy is then 0 at state 0. A given one is compared with the law: its derivative must be the
///   law (BG0504), and it must not jump where a comparison with the state switches the law (BG0506). Where law and
///   energy are polynomials in each branch, and each branch ends at a state that a linear comparison gives, both are
///   proved. Other functions, and branches that exclude each other, are checked by values: the derivative at 64 points
///   of both signs, sizes 1e-6 to 1e3 in the state's SI unit, and between all switches found along 12 lines; the energy
///   on both sides of each switch; with the parameters at their defaults and up to a fifth away. Points at which one of
///   the two is not finite count for nothing; fewer than 8 that are finite are BG0507.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A mass on a hardening spring, with dry friction and a force from outside.
///     graph Shaker {
///         param mass: kg = 2, above 0;
///         param stiffness: N/m = 500, above 0;
///         param hardening: N/m^3 = 1e4, at least 0;
///         input push: N;
///
///         1 slide: translation;
///         I body = mass start 0.1;
///         C spring(q) = stiffness * q + hardening * pow(q, 3);
///         R friction(v) = 5 * tanh(v / 0.01);
///         Se force = push;
///
///         force -> slide -> body; slide -> spring; slide -> friction;
///         observe { speed: m/s = slide.flow; spring.energy; friction.power }
///     }
///     /// A tank behind a throttle whose valve closes in time: a modulated R, a given energy.
///     graph Tank {
///         param throttle: Pa*s/m^3 = 2e6, above 0;
///         param capacity: m^3/Pa = 1e-6, above 0;
///         param closing: s = 10, above 0;
///         Se pump = 2e5;
///         1 pipe; MR valve = throttle * (1 + t / closing);
///         0 tank; C air(q) = q / capacity energy q * q / (2 * capacity);
///         pump -> pipe -> valve; pipe -> tank -> air;
///         observe { pressure: Pa = tank.effort }
///     }
/// }
/// # fn main() { assert_eq!((Shaker::STATES, Tank::STATES), (2, 1)); }
/// ```
///
/// ## `position`, `orientation`, `close`
///
/// ```text
/// position    = "position" NAME "of" JUNCTION ["start" EXPRESSION] ";"
/// orientation = "orientation" NAME "of" JUNCTION ["start" EXPRESSION] ";"
/// close       = "close" NAME "=" EXPRESSION ";"
/// ```
///
/// Tracks are kinematic states that follow a 1-junction of cardinality 3. A **position** is the integral of its flow:
/// three states. An **orientation** is the rotation matrix from the body's axes to the inertial ones, R' = \[w x\] R
/// with the angular velocity w in inertial axes: nine states. After each accepted step, and in dense output, the
/// integrator calls `System::project`: one Newton-Schulz step R (3 - R^T R) / 2 towards the nearest orthogonal matrix.
/// `close` states a gap, scalar or vector, that the assembly makes zero at the start ([start poses](#start-poses)).
///
/// # Expressions
///
/// | | |
/// |---|---|
/// | numbers | `2`, `0.05`, `2e-3`, `1_000` |
/// | operators | `+ - * /`, unary `-`, parentheses; products bind before sums. There is no `^`: write `pow(a, 3)` |
/// | vectors, matrices | `[a, b, c]`; a matrix is a vector of its three rows. The components of a named vector are `name.x`, `name.y`, `name.z` |
/// | choice | `if a < b { e } else { f }`, also `<= > >=`, `else if` ([events](#events)) |
/// | time and energy | `t` in s; `stored_energy` in J; `supplied_power`, `dissipated_power` in W |
/// | junctions | `NAME.flow` of a 1-junction, `NAME.effort` of a 0-junction; `NAME.displacement` of a scalar 1-junction, the integral of its flow since t = 0 ([ways](#angles-and-ways)) |
/// | elements | `NAME.flow`, `NAME.effort` of its bond (of a two-port's bond in), signs along the half arrow; `NAME.power` into it; `NAME.energy`, `NAME.q` of a C, `NAME.energy`, `NAME.p` of an I |
///
/// Shapes: scalars, vectors of three, 3 x 3 matrices. A scalar times anything, matrix times vector and matrix times
/// matrix are products; two vectors need `dot`, `cross` or `outer`. Sums want equal shapes.
///
/// | function | gives | units |
/// |---|---|---|
/// | `sin cos tan asin acos exp ln tanh` (a) | the function of a scalar, angles in rad | of a pure number; a pure number |
/// | `atan2(y, x)` | the angle of (x, y) in one turn, -pi to pi, rad | y and x alike |
/// | `unwrapped(y, x, w)` | the angle of (x, y) with its turns, rad, where w is its speed, or nearly; only in a `let` and in `observe` ([angles](#angles-and-ways)) | y and x alike, w in rad/s |
/// | `sqrt(a)`, `abs(a)` | of a scalar | the root; the same |
/// | `root(a, l)` | the square root of \|a\| with the sign of a, linear for a small beside l ([below](#the-square-root-at-zero)) | a and l alike; the root |
/// | `pow(a, b)` | a to the power b | any unit with a whole number b, else pure numbers |
/// | `dot(a, b)`, `cross(a, b)`, `outer(a, b)` | scalar, vector, matrix a b^T | the product |
/// | `norm(a)`, `skew(a)`, `diagonal(a)` | length; the matrix \[a x\]; the diagonal matrix, of a vector | the same |
/// | `transpose(A)`, `inverse(A)` | of a matrix | the same; its reciprocal |
/// | `identity()` | the unit matrix | any |
/// | `rotation_x(a)`, `rotation_y(a)`, `rotation_z(a)` | the rotation matrix about an axis, rad | of a pure number; a pure number |
/// | `guess(a)` | an unknown of the assembly, pose or velocity, first guessed as a; only in starts | the same |
/// | `integral(a)` | the time integral of a scalar since t = 0, a state of its own; only in `observe` | times s |
///
/// ## Angles and ways
///
/// An angle that a word of the language gives **counts turns**: it starts in (-pi, pi] and changes without a jump, so that a law of it, a
/// table, a switch or a stop acts on the third turn as on the first. What does not is called a **direction**: the same angle in one turn,
/// from -pi to pi, which jumps.
///
/// | with its turns | in one turn | of what |
/// |---|---|---|
/// | `PIN.angle` | `PIN.direction` | the free rotation of a revolute or cylindrical joint |
/// | `BODY.angle` | `BODY.direction` | a body's x axis about the inertial z; where the axis passes through z the angle has no meaning and may gain or lose half a turn |
/// | `unwrapped(y, x, w)` | `atan2(y, x)` | any, such as an angle of a spherical or universal joint, which have no names of their own |
/// | `J.displacement` | | the integral of the flow of a scalar 1-junction since t = 0, such as `PIN.spin.displacement` |
///
/// Each is a state, but only where something reads it: a law, an output. Its rate is the speed, from the angle at the start on. What is read
/// is the angle of the pose next to that state, so it is as exact as the pose, and an equilibrium or a linear model sees the pose alone. In
/// a scene in the plane the state is proved to be the angle, and where the scene has `angles;` or another state that differs from it by a
/// number, it is no state more; one that only outputs read does not count among the states that a scene expects. The w of `unwrapped` tells where the angle goes in a step: it may be off by what adds up to less than half a
/// turn there. Where an output needs no turns, such as that of a rocker, a direction costs no state.
///
/// ```
/// # use bg_model::bond_graph;
/// use bg_model::run::Simulation;
///
/// bond_graph! {
///     /// A flywheel that winds up a torsion spring, a turn and a half to each side.
///     graph Flywheel {
///         param stiffness: N*m/rad = 0.1, above 0;
///         ground { point pivot = [0, 0, 0]; }
///         body wheel { mass 1; inertia [0.1, 0.1, 0.1]; start spin [0, 0, 10]; }
///         joint pin: revolute z (ground.pivot -> wheel) { rigid; }
///         drive spring on pin torque = -stiffness * pin.angle;
///         observe { angle: rad = pin.angle; direction: rad = pin.direction }
///     }
/// }
/// let model = Flywheel::new(FlywheelParameters::default())?;
/// let run = Simulation::new(&model).every(0.5).until(6.0).run()?;
/// // 10 sin(t)
/// assert!((run["angle"][12] - 10.0 * 6.0_f64.sin()).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// ## The square root at zero
///
/// The flow through an orifice goes with the square root of the pressure, whose slope is infinite at rest, where every
/// hydraulic model starts. No implicit method and no Taylor series gets past that; nor does the physics go there, since
/// the flow is laminar first. `root(a, l)` is a / (a^2 + l^2)^(1/4): odd, monotone, differentiable any number of times, with the
/// slope 1 / sqrt(l) at zero. It differs from the root by 16 % at a = l, by 0.25 % at 10 l, by 2.5e-5 at 100 l. The laminar
/// range l must be above 0. Source: the Modelica Standard Library, `Modelica.Fluid.Utilities.regRoot`.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A tank behind an orifice, filled from rest.
///     graph Tank {
///         param pressure: Pa = 2e5;
///         param area: m^2 = 1e-6, above 0;
///         param density: kg/m^3 = 870, above 0;
///         param laminar: Pa = 100, above 0;
///         param capacity: m^3/Pa = 1e-12, above 0;
///         Se pump = pressure * sin(t / 1);
///         1 pipe: hydraulic; R orifice(effort p) = 0.62 * area * sqrt(2 / density) * root(p, laminar);
///         0 tank: hydraulic; C oil = capacity;
///         pump -> pipe -> orifice; pipe -> tank -> oil;
///         observe { pressure: Pa = tank.effort }
///     }
/// }
/// # fn main() { assert_eq!(Tank::STATES, 1); }
/// ```
///
/// # Units
///
/// Coherent SI only, so that no factor ever enters: `kg m s A K mol cd rad Hz N Pa J W C V F Ohm S Wb T H sr lm kat`,
/// joined by `*` and `/`, with whole powers: `kg*m^2/s`, `1/s`; `1` is a pure number. Each `/` is for the one factor
/// after it: `N*m*s/rad`, `W/m^2/K`. `rad` and `sr` are pure numbers, as in the SI, so a torque and an energy have the
/// same unit.
///
/// Every law, bond, start value and output is checked; a fault names the two units that disagree. A bare number takes
/// the unit that its place asks for. As a factor it may carry any unit, so a product with a bare number is not checked:
/// use a `param` or a `let` with a unit where a check is wanted.
///
/// # Mechanism words
///
/// ## `ground`, `gravity`
///
/// ```text
/// ground  = "ground" "{" { "point" NAME "=" EXPRESSION ["turned" EXPRESSION] ";" } "}"
/// gravity = "gravity" EXPRESSION ";"
/// ```
///
/// `ground` is the inertial frame with its named points (m). `gravity [0, -9.81, 0];` (m/s^2) gives every body a weight
/// at its centre of mass. A weight is an `Se`: its power counts as supplied, not as stored.
///
/// ## `body`
///
/// ```text
/// body  = "body" NAME "{" { solid | setting | point | start } "}"
/// solid = ( "cuboid" EDGES | "cylinder" "radius" E "length" E "along" AXIS | "sphere" "radius" E )
///         { "at" E | "turned" E | "density" E } ";"
/// setting = "density" E ";" | "mass" E ";" | "center" E ";" | "inertia" E ";"
/// point = "point" NAME "=" E ["turned" E] ";"
/// start = "start" [POINT] "at" E ";" | "start" "turned" E ";" | "start" ("velocity" | "spin") (E | "guess") ";"
/// ```
///
/// A rigid body. Its mass, centre of mass and inertia tensor are the sums over its **solids** (`at`: the solid's centre;
/// `turned`: its orientation; both in the body's axes), or **given**: `mass` (kg), `center` (m, the origin when left
/// out) and `inertia` about the centre (kg\*m^2: three principal moments or a matrix). The start pose is that of the
/// origin or of a point (m, inertial axes) and a rotation matrix; `velocity` (m/s) is that of the centre of mass,
/// `spin` (rad/s) the angular velocity, both in inertial axes. What is left out is zero, or unturned. A velocity that
/// the joints determine is a guess: `start velocity [guess(0), guess(0), 0];`, or `start velocity guess;` for all three
/// components ([start velocities](#start-velocities)). Clauses but those of the start depend on parameters and numbers only, the
/// start on guesses, too. What a body cannot have is [refused](#values-that-cannot-be).
///
/// It stands for two multibond 1-junctions, `NAME.translation` (velocity of the centre of mass) and `NAME.rotation`
/// (angular velocity), both in inertial axes, with `I NAME.linear`, and `I NAME.angular` whose tensor turns with the
/// body. There is no gyroscopic term, because h' is the sum of the moments in inertial axes.
///
/// | name | |
/// |---|---|
/// | `NAME.position`, `.velocity` | of the centre of mass, inertial axes |
/// | `NAME.orientation`, `.x_axis`, `.y_axis`, `.z_axis` | the rotation matrix, its columns |
/// | `NAME.angular_velocity` | inertial axes |
/// | `NAME.angle`, `.direction` | of the body's x axis about the inertial z, rad: with its turns, in one turn ([angles](#angles-and-ways)) |
/// | `NAME.momentum` or `.p`, `.angular_momentum` or `.h` | about the centre of mass, inertial axes |
/// | `NAME.kinetic_energy`, `.mass`, `.center`, `.tensor` | the last two in the body's axes |
/// | `NAME.POINT.position`, `.velocity`, `.arm` | of a point or of `origin`; the arm is from the centre of mass, inertial axes |
/// | `NAME.weight` | the `Se` of the weight |
///
/// ## `joint`
///
/// ```text
/// joint = "joint" NAME ":" KIND "(" END "->" END ")" "{" { clause } "}"
/// KIND  = "revolute" AXIS | "prismatic" AXIS | "spherical" | "cylindrical" AXIS | "universal" AXIS AXIS | "fixed"
/// END   = BODY ["." POINT] | "ground" ["." POINT]
/// clause = "stiffness" E ";" | "damping" E ";" | "tilt" "stiffness" E ";" | "tilt" "damping" E ";" | "frame" "inertial" ";"
///        | "rigid" ";"
/// ```
///
/// A compliant joint, unless it is [rigid](#rigid-joints): a C and an R on each direction that it holds. Stiffness
/// (N/m) holds translations, tilt stiffness (N\*m/rad) rotations; both are needed where the joint holds such a
/// direction. Damping may be left out. One number is for all directions, a vector has one for each axis. An end without a
/// point, or with the point `origin`, is the body's origin.
///
/// The number 0 as a stiffness, `stiffness [0, 1e6, 1e6];`, leaves its direction free: the start pose closes no gap there, so
/// that this holds a point on a line. A parameter that happens to be 0 closes as any other value of it, so that the
/// start pose does not depend on how stiff a joint is.
///
/// **The relative motion is that of the second end to the first, and forces and moments are those on the second body**,
/// their opposites act on the first. Axes are the first body's (`universal x y`: x of the first, y of the second body). Where
/// the point of an end is `turned`, they are those of the point, for this joint in place of its body's: so axes may be skew, and
/// what is held or an angle counts from the pose in which the two points' axes agree. A contact, too, takes the axes of such a point.
/// A pin whose stiffness is one number is kept in inertial axes. Held rotations are measured as direction cosines of
/// the two bodies' axes, which equal the angles while these are small, and cost no states. With `frame inertial` they
/// are the integrals of the relative angular velocity in inertial axes, one state each.
///
/// | name | |
/// |---|---|
/// | `NAME.force` | on the second body, inertial axes, N |
/// | `NAME.moment` | on the second body, inertial axes, N\*m; where the joint holds or drives a rotation |
/// | `NAME.gap` | second end minus first end, inertial axes, m |
/// | `NAME.x_offset` and its like | the gap in the first body's axes, of held axes of a joint with a slide or with a stiffness for each axis |
/// | `NAME.angle`, `.direction`, `.speed` | of the free rotation of revolute and cylindrical joints, rad, rad/s; the angle with its turns, the direction in one turn ([angles](#angles-and-ways)) |
/// | `NAME.travel` | of the free translation of prismatic and cylindrical joints, m |
/// | `NAME.spin`, `NAME.slide` | the 1-junctions of the free axes, to bond to: `gearbox -> pin.spin;` |
/// | `NAME.slip.flow`, `NAME.twist.flow` | relative velocity, relative angular velocity, inertial axes |
///
/// ### Rigid joints
///
/// With `rigid;` a joint gives way in no direction that it holds. It has a residual sink, `rSe`, on each held direction
/// in place of the C and the R; stiffnesses and dampings may be left out, and what is written is not used. The names of
/// the table stay, `NAME.force` and `NAME.moment` are the reactions; `NAME.x_offset` and its like are there for joints
/// with a slide only. A scene makes joints rigid with `rigid joints;`.
///
/// The reactions l are solved for at compile time. That the second derivative of each held gap vanishes is linear in
/// them, A l + b = 0, with A symmetric; A is factored as L D L^T in symbols, without pivots, and the solution is part
/// of the flat rate function. At the start, gaps and [velocities](#start-velocities) that do not fit are errors. What
/// truncation leaves of them is taken away after each step: the pose moves by the least motion, in the metric of kinetic
/// energy, that closes the gaps, then the momenta change by the impulses that bring the held velocities to zero. It costs
/// as much as about one rate a step. With `baumgarte 50;` in the graph, gaps and held velocities decay instead,
/// `v' = -2 a v - a^2 q`, here with a = 50 1/s; nothing is projected then.
///
/// Redundancy: joints may hold a motion twice, as two hinges of one door do, or a four-bar linkage of hinges in space.
/// Which rows follow from the others is found by `Model::new`, in the start pose and in poses near it; these rows take no
/// part in the rates. The motion is unique. Reactions are not, and those of least norm are given: of all reactions that
/// do, the ones with the least sum of squares, N and N m counted alike. `Model::redundant` names the joints, and so does
/// the summary of a run. A constraint out of the plane of a planar motion needs no reaction and gets zero, in scenes only.
///
/// A singular pose, such as that of a parallelogram that lies flat or of a crank at its dead centre, is passed by explicit methods and
/// by `taylor`, on the branch on which the mechanism comes. An implicit method may creep into it; the run then ends with
/// `Cause::Singular`. A start in such a pose is an error, `AssemblyError::Redundant`. If a motion that followed from the
/// others at the start does so no more, the run ends with `Cause::Torn`.
///
/// Joints that leave no motion at all, such as a parallelogram with a rod across, are an error of `start`,
/// `AssemblyError::Immobile`, which names those that clash. A frame that joints only fix may stand, and so may what sources of
/// flow move.
///
/// ## `spring`, `contact`
///
/// ```text
/// spring  = "spring" NAME "(" END "->" END ")" "{" { ("stiffness" | "damping" | "length") E ";" } "}"
/// contact = "contact" NAME "(" END "->" END "along" AXIS ")" "{" { AXIS ":" LAW { "," LAW } ";" } "}"
/// LAW     = ("C" | "R") ["(" VARIABLE ")"] "=" E
/// ```
///
/// A **spring** pulls along the line between its ends; `length` is the unloaded one (0 when left out). Names:
/// `NAME.force` on the second end, `NAME.distance`, `NAME.spring.energy`.
///
/// A **contact** lets the first end slide along a line of the second body: laws for each axis of the second body act at
/// the place of the first end. Names: `NAME.force` on the second body, `NAME.gap`, `NAME.speed` along the line, and for
/// each axis with laws the elements `NAME.x_damper`, `NAME.y_spring` and so on.
///
/// ## `friction`, `stop`
///
/// ```text
/// friction = "friction" NAME "on" TARGET "{" { ("coulomb" | "static" | "stribeck" | "viscous" | "normal" | "radius" | "creep") E ";" } "}"
/// stop     = "stop" NAME "on" TARGET "{" { ("at" "most" | "at" "least" | "stiffness" | "damping" | "restitution" | "rest" "below" | "start") E ";" } "}"
/// ```
///
/// The TARGET is a joint, for its free axis (of a cylindrical one the rotation; `pin.slide` is the other), a contact, for its line,
/// or a scalar 1-junction.
///
/// A **friction** is an R of that name, of [dry friction](#dry-friction). Against the speed v it gives
/// s + (h - s) exp(-(v / w)^2) + r v, and at rest it holds h:
///
/// | clause | |
/// |---|---|
/// | `coulomb` | s, in N or N\*m. With `normal` or `radius` it is a coefficient, a pure number, and so is `static` |
/// | `static` | h; s when left out, and where h is less |
/// | `stribeck` | w, the speed over which h falls to s; without it the friction falls at once when it slides |
/// | `viscous` | r |
/// | `normal` | the force that presses, N. What lifts off, a negative one, does not rub |
/// | `radius` | of a journal, m: the friction is a torque. Without `normal` the length of the joint's force presses |
/// | `creep` | c: the law is smooth and does not stick, (s + (h - s) exp(..)) v / sqrt(v^2 + c^2) + r v. Under a load F below s it creeps with c F / sqrt(s^2 - F^2) |
///
/// The force of a compliant joint follows from its stretch, so it can press. The reaction of a rigid one cannot (BG0515): it
/// depends on the friction.
///
/// A **stop** acts where the displacement goes beyond `at most` or `at least`, with a spring and, where `damping` is given, a
/// damper; the two together never pull. The displacement is the travel of a sliding joint; else it is a state, the angle or way
/// from `start` on. Left out that is the joint's angle at the start, so that ends are values of `pin.angle`, turns and all; 0 for a
/// junction. With sin p = d / (2 sqrt(k m)) a mass m that hits stiffness k and damping d leaves with
/// exp(-(pi - 2 p) tan p) of its speed, whatever that is: for 0.8 take sin p = 0.0744, for 0.5 sin p = 0.2553.
///
/// With `restitution e` in the place of stiffness and damping it does not give way: what hits it with a speed v leaves with e v,
/// 0 to 1, at the same instant; what is too slow rests on it ([stops with a restitution](#stops-with-a-restitution)).
///
/// | name | |
/// |---|---|
/// | `NAME.effort`, `.power` | of the friction, against the motion; of the stop only `.effort` |
/// | `NAME.pressed` | the force that presses, where there is one |
/// | `NAME.spring`, `NAME.damper` | the stop's elements; `NAME.spring.q` is the displacement |
/// | `NAME.upper`, `NAME.lower`, `NAME.place` | those of a stop with a restitution, one for each end, and the displacement; `NAME.power` |
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A pendulum that comes to rest in its journal, and a carriage between two ends.
///     graph Rough {
///         gravity [0, -9.81, 0];
///         ground { point pivot = [0, 1, 0]; }
///         body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 1, 0]; }
///         joint pin: revolute z (ground.pivot -> rod.end) { stiffness 1e5; damping 100; tilt stiffness 1e3; tilt damping 1; }
///         friction journal on pin { coulomb 0.1; static 0.15; stribeck 0.05; radius 0.02; }
///
///         body carriage { mass 3; inertia [0.1, 0.1, 0.1]; start velocity [2, 0, 0]; }
///         joint guide: prismatic x (ground -> carriage) { rigid; }
///         friction rub on guide { coulomb 5; }
///         stop ends on guide { at most 0.2; at least -0.1; restitution 0.6; }
///
///         observe { pin.angle; journal.effort; x: m = guide.travel; ends.effort }
///     }
/// }
/// # fn main() { assert_eq!(Rough::OUTPUTS, 4); }
/// ```
///
/// ## `orifice`
///
/// ```text
/// orifice = "orifice" NAME "on" JUNCTION "{" { ("area" | "coefficient" | "density" | "laminar") E ";" } "}"
/// ```
///
/// An R of that name at a hydraulic 1-junction, through which c a sqrt(2 / rho) `root(p, l)` flows: area a (m^2) and discharge
/// coefficient c, which may depend on everything, such as an input; density rho (kg/m^3); pressure l (Pa) below which the flow is
/// laminar ([above](#the-square-root-at-zero)).
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A valve that an input opens, in front of a tank.
///     graph Valve {
///         param capacity: m^3/Pa = 1e-11, above 0;
///         input opening: m^2;
///         Se pump = 2e5; 1 pipe: hydraulic; 0 tank: hydraulic; C oil = capacity;
///         pump -> pipe -> tank -> oil;
///         orifice valve on pipe { area opening; coefficient 0.62; density 870; laminar 100; }
///         observe { pressure: Pa = tank.effort; through: m^3/s = valve.flow }
///     }
/// }
/// # fn main() { assert_eq!(Valve::STATES, 1); }
/// ```
///
/// ## `drive`
///
/// ```text
/// drive = "drive" NAME "on" TARGET ("torque" | "force") "=" E ";"
///       | "drive" NAME "on" JOINT "speed" "=" E "{" "stiffness" E ";" ["damping" E ";"] "}"
/// ```
///
/// On a joint: a torque about or a force along its free axis, a scalar, on the second body, its opposite on the first.
/// On a body: a torque, a vector in inertial axes. On a point of a body, or a body for its origin: a force, a vector in
/// inertial axes. A prescribed speed acts through a compliant coupling, since an inertia behind a flow source would be
/// in derivative causality. `NAME` is the source's element; `NAME.power` is minus the power that it gives.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A crank at prescribed speed, a rod to a slider that rubs against a plate, a return spring.
///     pub graph SliderCrank {
///         param speed: rad/s = 6;
///         param rub: N*s/m = 20, at least 0;
///         gravity [0, -9.81, 0];
///         ground { point O = [0, 0, 0]; point wall = [0.8, 0, 0]; }
///         body crank {
///             cuboid [0.1, 0.03, 0.02] density 7850;
///             point O = [-0.05, 0, 0]; point A = [0.05, 0, 0];
///             start O at [0, 0, 0];
///         }
///         body rod {
///             cylinder radius 0.01 length 0.3 along x density 2700;
///             point A = [-0.15, 0, 0]; point B = [0.15, 0, 0];
///             start A at [0.1, 0, 0]; start turned rotation_z(guess(0));
///         }
///         body slider { mass 0.5; inertia [1e-3, 1e-3, 1e-3]; start at [guess(0.4), 0, 0]; }
///
///         joint pin_o: revolute z (ground.O -> crank.O) { stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1; }
///         joint pin_a: revolute z (crank.A -> rod.A) { stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1; }
///         joint pin_b: spherical (rod.B -> slider) { stiffness 1e6; damping 100; }
///         joint slide: prismatic x (ground.O -> slider) { stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1; }
///
///         drive motor on pin_o speed = speed { stiffness 50; damping 1; }
///         spring pull (ground.wall -> slider) { stiffness 200; length 0.4; }
///         contact plate (ground.O -> slider along x) { x: R(v) = if v < 0 { rub * v } else { 2 * rub * v }; }
///
///         observe { angle: rad = pin_o.angle; travel: m = slide.travel; force: N = norm(pin_b.force); plate.speed }
///     }
/// }
/// use bg_model::system::Model;
///
/// let model = SliderCrank::new(SliderCrankParameters { speed: 8.0, ..Default::default() })?;
/// assert!(model.start().is_ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Parts
///
/// ```text
/// part  = [visibility] "part" NAME "{" { statement | port } "}"
/// port  = "port" ["0" | "1"] NAME ["[3]"] ":" DOMAIN ";" | "port" NAME "=" PATH ";"
/// use   = "part" [NAME ["[" COUNT "]"] ":"] PART ( ";" | "{" { clause } "}" )
/// clause = NAME "=" E ";" | "start" PATH ( "at" | "turned" | "velocity" | "spin" ) E ";"
/// start = "start" PATH ( "at" | "turned" | "velocity" | "spin" ) E ";"
/// ```
///
/// A part describes a piece of machine once. It may hold whatever a graph may, other parts among it, but no scenes. A graph
/// or part uses it under a name of its own, as often as it likes. What is inside then has a path: in `part front: Leg` the
/// spring is `front.spring`, its flow `front.spring.flow`, a parameter `front.damping`. Nothing inside means anything of the
/// user's by accident: a name of the part is one of the part, only time, energies and the ground are everybody's.
///
/// - **Parameters and inputs.** `NAME = E;` gives one a value, an expression of the user's own names. It is then no parameter
///   of the graph any more, but a name for the value, whose unit is checked; of a parameter it is constant during a run and
///   inside of the range, which is checked here or, where it depends on parameters, by `new`. What is not given is a parameter
///   or input of the graph under its path: `--set front.damping=900` on the command line, `tune { front.damping }` in a scene,
///   the field `front_damping` in the parameter struct. Those of parts inside are given by their path: `inner.damping = 900;`.
///   A parameter that nothing in the part uses is a fault (BG0811).
/// - **Ports** are where a part meets the rest. `port hub: translation;` is a junction to bond to, `chassis -> front.hub;`: a
///   1-junction for translations and rotations, a 0-junction in electrical, hydraulic and thermal domains; `port 0` and
///   `port 1` say it. The user must bond each, or hand it on (BG0804). `port tip = bar.head;` is another name for a point, a
///   body, a junction or a free axis inside, such as `pin.spin`. Whatever has no port can be reached, too, by its path.
/// - **Bodies** of a part start where the user puts them: `start front.bar.head at [0, 1, 0];`, or inside of the use's braces
///   `start bar.head at [0, 1, 0];`. This takes the place of what the body says itself.
/// - **The ground** is one for all. Points that a part has on it are `ground.front.pivot` outside. Gravity, too, is the
///   graph's: one `gravity` for all parts together.
/// - **Outputs.** The `observe` of a part names what is worth seeing of it. A graph watches `front.length`, or
///   [all of it](#observe); it may also calculate with these names. An output may have the name of something in the part: `observe` then
///   means the output, any other expression the thing.
/// - **Without a name**, `part Leg;`, what is inside keeps its names and its parameters are those of the graph: a graph that
///   begins with a machine and adds what drives it and what is seen of it.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A spring leg under a vehicle.
///     pub part Leg {
///         param stiffness: N/m = 2e4, above 0;
///         param damping: N*s/m = 800, at least 0;
///         port hub: translation;
///         port foot: translation;
///         0 leg: translation; 1 squeeze: translation; C spring = stiffness; R damper = damping;
///         foot -> leg -> hub; leg -> squeeze -> spring; squeeze -> damper;
///         observe { length: m = spring.q; power: W = damper.power }
///     }
///     /// A beam on two of them, on a road that goes up and down.
///     pub graph Trolley {
///         param k: N/m = 2e4, above 0;
///         part front: Leg { stiffness = k; }
///         part rear: Leg { stiffness = 1.5 * k; damping = 900; }
///         1 beam: translation; I load = 200; 1 road: translation; Sf bumps = 0.1 * sin(t / 1);
///         bumps -> road; road -> front.foot; road -> rear.foot; front.hub -> beam; rear.hub -> beam; beam -> load;
///         observe { front.length; all of rear; speed: m/s = beam.flow }
///         scene Soft { tune all but k; }
///     }
/// }
/// use bg_model::system::Model;
///
/// // The parameters that were left open: `k` of the graph, `front.damping` of the part.
/// let trolley = Trolley::new(TrolleyParameters { k: 1e4, front_damping: 500.0 })?;
/// let outputs: Vec<&str> = trolley.description().outputs.iter().map(|output| output.name).collect();
/// assert_eq!(outputs, ["front.length", "rear.length", "rear.power", "speed"]);
/// assert!(Soft::new(SoftParameters { front_damping: 500.0 }).is_ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// ## Parts of other calls and crates
///
/// A `pub part` is an item of its module like a function: another call, of this crate or another, uses it by its path,
/// `part front: vehicles::Leg { .. }`, `part front: crate::legs::Leg;`. A name alone is that of a part of the same call; what
/// `use` has brought into the module is `self::Leg`. `pub(crate) part` is for this crate, `part` for its call alone. What a part
/// uses itself comes with it: its user needs neither those parts nor their crates. (The path is that of a macro with the
/// part's tokens. Where it leads nowhere rustc says so, and then misses the models of the call.)
///
/// Faults inside of a part are at the part's own tokens, told once for all uses of a call, and say in which one they are: `in
/// part front: Leg`. A part that no graph of its call uses is looked at by itself: names, shapes and units.
///
/// ## Arrays and repetitions
///
/// ```text
/// use   = "part" NAME "[" COUNT "]" ":" PART ...
/// for   = "for" INDEX "in" FROM ".." TO "{" { statement } "}"
/// array = a statement whose name is NAME "[" INDEX "in" FROM ".." TO "]"
/// ```
///
/// `part link[20]: Link;` are twenty links, `link[0]` to `link[19]`. `for i in 1..20 { .. }` stands for its statements once for
/// each number from 1 to 19; the index is a number in expressions, and in brackets of names sums and products of numbers and
/// indices, `link[i - 1].tail`. `joint pin[i in 1..20]: ..` is the same around one statement, of whatever kind. Numbers are
/// written out: none of them is known at run time only. An element that is not there is BG0805, with the length.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     part Link {
///         param length: m = 0.6, above 0;
///         body bar {
///             cylinder radius 0.005 length length along y density 7850;
///             point head = [0, length / 2, 0]; point tail = [0, -length / 2, 0];
///         }
///         observe { angle: rad = bar.angle }
///     }
///     /// A chain of six links that hangs from a point, its lowest link pulled aside.
///     pub graph Chain {
///         param length: m = 0.1, above 0;
///         gravity [0, -9.81, 0];
///         ground { point pivot = [0, 0, 0]; }
///         part link[i in 0..6]: Link { length = length; start bar.head at [0, -i * length, 0]; }
///         joint top: revolute z (ground.pivot -> link[0].bar.head) { stiffness 1e5; damping 10; tilt stiffness 1e3; }
///         joint pin[i in 1..6]: revolute z (link[i - 1].bar.tail -> link[i].bar.head) {
///             stiffness 1e5; damping 10; tilt stiffness 1e3;
///         }
///         drive pull on link[5].bar.tail force = [0.1, 0, 0];
///         observe { link[5].angle; pin[5].force }
///         scene Planar { observe { all of link } expect planar; }
///     }
/// }
/// # fn main() { assert_eq!((Chain::OUTPUTS, Planar::OUTPUTS), (4, 6)); }
/// ```
///
/// # Scenes
///
/// ```text
/// scene  = "scene" NAME "{" { clause } "}" | "scenes" "only" ";"
/// clause = observe | "tune" ["all" "but"] NAMES | "without" NAMES | "rigid" ( "joints" ";" | "{" NAME { "," NAME } "}" )
///        | "all" "reactions" ";" | "angles" ";" | "expect" "planar" ";" | "expect" "states" "=" COUNT ";"
///        | "expect" "independent" "speeds" ";" | "expect" "integral" "causality" ";"
/// NAMES  = "{" [NAME { "," NAME }] "}" | NAME { "," NAME } ";"
/// ```
///
/// A scene is one use of the graph: what is watched and what stays adjustable. It is a model type of its own, with its
/// own parameter struct, beside the literal model of the graph, from which the compiler leaves out what this use does
/// not need. The outputs are those of the literal model to rounding, for all values of the parameters that it keeps;
/// `without` and `rigid` make it another mechanism, whose own literal model is not generated.
///
/// With the statement **`scenes only;`** in the graph its scenes alone become code. The literal graph is checked, its name is no
/// type, and a scene may have it; the first scene stands for the graph, in a program of the workbench too, and keeps all parameters
/// that the others keep. A mechanism in the plane with rigid joints then compiles in a fraction of the time, since its literal model is
/// one in space.
///
/// | clause | |
/// |---|---|
/// | `observe { ... }` | the outputs, in place of the graph's; without it those of the graph |
/// | `tune { a, b }` | the parameters that stay adjustable, and the only fields of the scene's parameter struct; the others are their defaults, as numbers. Without it all stay; `tune {}` keeps none; `tune all but { c }` keeps the others |
/// | `without { a, b }` | joints, contacts, springs, drives, frictions, stops, orifices or elements that are not there, with their bonds |
/// | `rigid joints;`, `rigid { a, b }` | all joints, or these, are [rigid](#rigid-joints) |
/// | `all reactions;` | every momentum and position of a body stays a state, and every direction of a rigid joint has a reaction that is solved for in each rate. Without it, where that takes fewer operations, momenta and positions that rigid joints determine are expressions of the others, and rates need the reactions of joints that close loops only; outputs show all of them, with the same values |
/// | `expect independent speeds;` | an error (BG0611), with the reason, where that has not been done |
/// | `dependent rod;`, `dependent { coupler, rocker }` | the orientations of these bodies follow from the others by [loops in closed form](#loops-in-closed-form), also where no bounds prove it for all poses; an error (BG0613) where no loop gives them |
/// | `expect planar;` | an error (BG0604) unless all bodies are proved to stay in planes parallel to x-y |
/// | `expect integral causality;` | an error (BG0403) where a storage is in [derivative causality](#derivative-causality) |
/// | `angles;` | orientations that are proved to turn about one axis are integrated as angles: a state less each, for a sine and a cosine in the rate; displacements between them are then recovered |
/// | `expect states = 29;` | an error (BG0605) unless so many states are integrated, integrals and angles for outputs only not counted |
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A bob on a pin, pushed out of the plane where `aside` says so.
///     pub graph Bob {
///         param mass: kg = 2, above 0;
///         param angle: rad = 0.7;
///         param aside: N = 0;
///         gravity [0, -9.81, 0];
///         ground { point O = [0, 0, 0]; }
///         body bob {
///             mass mass; inertia [0.1, 0.2, 0.3];
///             point top = [0, 0.5, 0];
///             start top at [0, 0, 0]; start turned rotation_z(angle);
///         }
///         joint pin: revolute z (ground.O -> bob.top) { stiffness 1e5; damping 50; tilt stiffness 1e3; tilt damping 1; }
///         drive push on bob force = [0, 0, aside];
///         observe { bob.position; pin.force; lost: J = integral(dissipated_power) }
///
///         /// The motion in the plane.
///         scene Swing {
///             observe { angle: rad = pin.direction; force: N = norm(pin.force) }
///             tune { mass, angle }
///             expect planar;
///             expect states = 7;
///         }
///         /// On an ideal pin, with nobody who pushes.
///         scene Ideal {
///             without { push }
///             rigid joints;
///             observe { angle: rad = pin.direction; pin.force; pin.gap }
///             tune { mass, angle }
///             expect states = 3;
///         }
///     }
/// }
/// use bg_model::system::Model;
///
/// assert_eq!((Bob::STATES, Swing::STATES, Ideal::STATES), (19, 7, 3));
/// // The scene's parameters are what it tunes: there is no field `aside`.
/// let swing = Swing::new(SwingParameters { mass: 3.0, angle: 1.2 })?;
/// assert!(swing.description().reduction.starts_with("18 states: 9 constant; 2 equal up to sign;"));
/// assert!(Ideal::new(IdealParameters::default())?.description().graph.contains("rSe pin.reaction = [0, 0, 0] at pin.gap"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `Description::reduction` of a scene is the report on what went and why; it is empty for a literal model. For
/// `Swing`:
///
/// ```text
/// 18 states: 9 constant; 2 equal up to sign; 0 recovered; 0 unwatched; 7 integrated; 0 for outputs only
///   literal: 18 states, 121 operations a rate
///   parameters folded: 18 states, 120 operations a rate
///   constant states folded: 9 states, 30 operations a rate
///   equal states merged: 7 states, 25 operations a rate
///   affine states recovered: 7 states, 25 operations a rate
///   unwatched states dropped: 7 states, 25 operations a rate
///   bob.position_x: integrated
///   bob.position_y: integrated
///   bob.position_z: constant: its rate is zero while the constants hold, so it stays 0
///   bob.orientation_11: integrated
///   bob.orientation_12: integrated
///   bob.orientation_13: constant: its rate is zero while the constants hold, so it stays 0
///   bob.orientation_21: equal: it starts as -bob.orientation_12 and has its rate
///   (and 10 lines more, one a state)
/// ```
///
/// Each reduction is proved on the equations, never read off numbers. In this order:
///
/// | reduction | what is proved |
/// |---|---|
/// | parameters folded | nothing: a parameter that is not tuned is its default. A switch whose guard has become a number is decided |
/// | constant states | that the rates of all of them, and what `project` gives them, vanish or stay while all of them have their start values: the greatest such set, found by dropping what does not hold until nothing does. By induction in time they keep their values. A start value that depends on a `guess` is not taken for constant |
/// | turns counted | that a sine and a cosine turn with the speed of the state that counts the turns of their [angle](#angles-and-ways): the angle is then this state. Only where a scene reads an angle |
/// | equal states | that states with the same start value up to sign have the same rate up to sign, while all the equalities hold: classes are split until none splits |
/// | states of joints expressed | that a rigid joint determines the momentum of a body and its position, or two bodies turn alike by it, or a [loop](#loops-in-closed-form) gives the orientation and the momentum of a link: its row is solved for them, with a pivot that cannot vanish, and no rate needs its reaction. Not done where velocities at the start need not fit, where rows that close loops may hold all that is left, where an output shows a reaction that several joints may share, where the scene says `all reactions;`, or where rates would take more operations: the report then says which |
/// | reactions solved | nothing: this is where the multipliers of rigid joints are solved for, on what is left |
/// | affine states | that the rate of a displacement or integral is a combination, with fixed numbers, of the rates of other displacements, integrals, positions and orientations: the difference vanishes as a polynomial. It then is its start value plus what the others have changed |
/// | unwatched states | that no output depends on it, nor the rate, projection or switch of anything that an output depends on |
///
/// Operations are those of the rate function that would be generated at that point; before the reactions are solved,
/// these are unknowns there and cost nothing.
///
/// ## Loops in closed form
///
/// A joint that closes a loop of links in the plane leaves rows that no other joint needs: a slide or a slot one, a pin two. They give the
/// orientation and the momentum of a link as expressions of the others, by a square root: of the connecting rod of a slider-crank, with a pin
/// those of two links, the coupler and the rocker of a four-bar. A slider-crank is then left with three states, those of its crank, and rates
/// take neither reactions nor projections. On which of its two sides such a loop is assembled, the start pose says.
///
/// The root is zero where the link could turn either way: a rod perpendicular to its slide, a coupler and a rocker in line. So this is done
/// where bounds of the lengths prove that no pose comes near it, as those of a crank that is shorter than its rod, and where a rate with its
/// part of a projection takes fewer operations. Lengths have to be numbers for that, or parameters with ranges that leave no doubt. Where you know what
/// bounds do not show, say so in the scene: `dependent rod;`. A run that comes to such a pose all the same ends with an error that names
/// the joint.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A crank, a connecting rod and a piston.
///     graph Engine {
///         param torque: N*m = 3;
///         param rod: m = 0.3, above 0;
///         ground { point O = [0, 0, 0]; }
///         body crank { mass 2; inertia [0.02, 0.02, 0.02]; point pin = [0.1, 0, 0]; start at [0, 0, 0]; }
///         body link { mass 1; inertia [0.01, 0.01, 0.01]; point low = [-rod / 2, 0, 0]; point high = [rod / 2, 0, 0]; start low at [0.1, 0, 0]; }
///         body piston { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.1 + rod, 0, 0]; }
///         joint main: revolute z (ground.O -> crank) { rigid; }
///         joint big_end: revolute z (crank.pin -> link.low) { rigid; }
///         joint small_end: revolute z (link.high -> piston) { rigid; }
///         joint bore: prismatic x (ground.O -> piston) { rigid; }
///         drive starter on main torque = torque;
///         observe { angle: rad = crank.angle; x: m = piston.position.x; side: N = bore.force.y; }
///         scenes only;
///         scene AnyRod { dependent link; expect states = 3; }
///         scene Engine { tune { torque } expect states = 3; }
///     }
/// }
/// ```
///
/// What a scene does not do:
///
/// - An unwatched state is gone: what depends on it can be observed only by a scene that says so in `observe`.
/// - `stored_energy` and `powers` of the model are not-a-number in a scene that has lost a state or a switch on which
///   they depend. Observe one of the two to keep them.
/// - Equalities with factors other than 1 and -1, conserved quantities, and
///   what is true only for some values of the tuned parameters are not found.
///
/// # Start poses
///
/// Start values are expressions of parameters. `guess(E)` in a body's start pose is an unknown: before a run the assembly
/// moves all of them from their guesses until every joint's gap is closed to 1e-10 m or rad (`Model::start`). It names
/// the joint and its gap where that fails. Without guesses the gaps are only checked. The method is Gauss-Newton with
/// the least step, damped where needed.
///
/// A residual sink with `at GAP` that belongs to no joint is closed, or checked, in the same way.
///
/// # Start velocities
///
/// ```text
/// start = "start" "impulse" ";"
/// ```
///
/// When the pose is closed, the relative flows of the motions that joints hold are to be zero; of an `rSe` with a FLOW
/// their difference to it at t = 0:
///
/// - A **guess** in a start velocity or spin, or in the momentum of an I, is an unknown. All of them together move by
///   the least step from their guesses to where the flows of all rigid joints vanish, and those of the compliant joints
///   that a guessed velocity moves. Given velocities stay. Example: the crank's spin is given, all that it drives is
///   guessed.
/// - A **misfit** of more than 1e-9 of what the kinetic energy could move there is an error, `AssemblyError::Torn`:
///   *joint `pin` is torn apart at
///   -0.5 m/s in y*. Rigid joints are always looked at. A compliant one only where a guess moves it: without a guess a
///   spring may be in motion at the start.
/// - With the statement **`start impulse;`** in the graph, impulses of the rigid joints make the velocities fit, as in a
///   perfectly plastic impact: momenta change by J^T l, where A l + v = 0 for the misfit v. `Model::impulse_energy` is the
///   kinetic energy that this takes, l . v / 2 up to the sign; energies of a run count from after it. A graph without a rigid
///   joint, in none of its scenes either, cannot have it (BG0608).
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A bar that spins freely at 10 rad/s when a pin catches its end.
///     graph Caught {
///         ground { point O = [0, 0, 0]; }
///         body bar {
///             mass 2; inertia [0.05, 0.05, 0.05]; point end = [-0.05, 0, 0];
///             start end at [0, 0, 0]; start spin [0, 0, 10];
///         }
///         joint pin: revolute z (ground.O -> bar.end) { rigid; }
///         start impulse;
///         observe { speed: rad/s = pin.speed }
///     }
/// }
/// use bg_model::system::Model;
///
/// let model = Caught::new(CaughtParameters::default())?;
/// // 2.5 J before; the moment of momentum about the pin leaves 10 / 1.1 rad/s.
/// assert!((model.impulse_energy()? - 2.5 / 11.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Values that cannot be
///
/// What no physics allows is refused, where numbers say so at the token (BG0701 to BG0703), where parameters do by `new`, where
/// the assembly does by `start`, with the name of the element, body or joint and of the parameters that it depends on:
///
/// | value | must be |
/// |---|---|
/// | mass of a body; inertia of an I; compliance of a C; laminar range of `root` | above 0 |
/// | density, edges, radius, length of a solid | not negative: a solid may be nothing beside others |
/// | stiffness, damping, resistance | not negative; a resistance whose flow follows from its effort above 0 |
/// | inertia of a body | symmetric, positive definite, no principal moment larger than the other two together (by more than 1 % of their sum, as moments of three digits come out) |
/// | matrix of an I, compliance matrix | symmetric, positive definite |
/// | stiffness matrix | symmetric, no eigenvalue negative |
/// | resistance matrix | its symmetric part without a negative eigenvalue; with an inverse where its flow follows from its effort |
/// | start orientation, `turned`, the frame of an I | a rotation matrix, to six digits |
/// | restitution of a stop | from 0 to 1 |
///
/// A parameter's range that proves it, such as `above 0` for a mass, saves the check. What depends on states, inputs or time, or
/// on a comparison, is not looked at. An R that gives power on purpose is a law of its variable, `R r(f) = -3 * f`, or
/// a source.
///
/// # Causality
///
/// Strokes are assigned by the sequential procedure (SCAP): sources, residual sinks among them, then laws that work one
/// way only (laws of a variable), then I and C in integral causality, then what is left; each assignment is propagated
/// before the next. What is left is a choice, bond by bond in their order: the stroke is where the half arrow starts,
/// unless the rest could then not be completed. So a graph that has a valid assignment gets one. What no assignment
/// satisfies is a fault: two causes for one effort or flow (BG0401), none (BG0402), a law of a variable that would have to
/// run backwards (BG0404).
///
/// ## Derivative causality
///
/// Two inertias on one shaft, a rigid gear between flywheels, a mass on a rigid lever, a capacitor across a voltage source: others
/// determine the state of one of them, so it has no state to integrate. It is in **derivative causality**. Where integral causality
/// is possible for some storages only, those have it whose law may have no inverse (laws of a variable), then those with a `start`,
/// then the first declared.
///
/// - The momentum of an I in derivative causality is that of the flow that it receives, the displacement of a C that of its
///   effort. It gives the change of that, dp/dt or dq/dt. The compiler differentiates, and solves the linear system in which the storages
///   add up to equivalent ones. Laws may depend on poses and on all else, as the ratio of an `MTF`: the terms of its change are there.
/// - `wheel.p`, `wheel.effort`, `wheel.flow`, `wheel.power`, `wheel.energy` can be observed as ever; `wheel.effort` is the torque that the
///   shaft hands on to it. The printed equations say `wheel.p = 1.5*J.p, derivative causality`; in pictures it is red.
/// - A `start` is given for the storages that are integrated: elsewhere it is BG0509, which names those.
/// - A law that is not linear in its state keeps its state; what it gives is a multiplier that keeps the state in step, as the
///   residual sink of a rigid joint does. Its `start` must fit the others', or be a `guess`.
/// - Where what a storage receives depends on what it gives, as beside an R with a law of the effort, its state is free all
///   the same and stays.
/// - What has no derivative is a fault: a state that an input gives, whose slope may jump (BG0510), or that a comparison may make jump
///   (BG0511); what cannot be solved for is BG0512.
///
/// `expect integral causality;` in a graph or in a scene makes each such storage a fault, BG0403, with what determines it. A residual
/// sink is the other way to hold two inertias together, with a multiplier and two states: `rSe rigid = 0;`
/// `shaft -> gear -> tie -> hub -> wheel; rigid -> tie;` keeps the difference of the two flows at the 0-junction at zero.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// Two flywheels and a rigid gear.
///     graph Geared {
///         param ratio: 1 = 4, above 0;
///         Se torque = 0.5; 1 shaft: rotation; I rotor = 1e-3; TF gear = 1 / ratio; 1 hub: rotation; I wheel = 0.02;
///         torque -> shaft -> rotor; shaft -> gear -> hub -> wheel;
///         observe { tooth: N*m = wheel.effort }
///     }
/// }
/// use bg_model::run::Simulation;
///
/// let model = Geared::new(GearedParameters::default())?;
/// assert_eq!(Geared::STATES, 1);
/// let run = Simulation::new(&model).every(0.1).until(0.1).run()?;
/// // 4 * 0.5 N*m turn 0.02 kg*m^2 and 16 times the rotor.
/// assert!((run["tooth"][0] - 2.0 * 0.02 / (0.02 + 16.0 * 1e-3)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// ## Algebraic loops
///
/// A bond variable that needs itself, through resistors, two-ports or modulation, is solved for. It is in symbols where the equations of
/// the loop are linear in it: a divider, a bridge, resistors on both sides of a transformer. Parameters stay symbols. What the solution divides
/// by is checked by `new` where parameters can make it zero. A law with an `if` is linear branch by branch: the branch is that in which
/// the solution lies, and an event leads from one to the other.
///
/// A loop that is not linear, such as a diode or a turbulent valve in series with a resistor, is left to Newton's iteration, from zero on,
/// each time that a rate is evaluated. Its last step is part of the equations, so Jacobians, Taylor series and events are exact. Of
/// several solutions it is the one that this finds. Where it finds none, the run ends with an error that names the
/// loop, also where only an output depends on it: what cannot be calculated is no row of a run.
///
/// - A loop that is not linear and depends on the reaction of a rigid joint is BG0501, with its members.
/// - A loop that leaves its variables open, such as a closed ring of junctions, is BG0508.
///
/// # Events
///
/// The comparison of an `if` becomes a switch with a real-valued guard: `a - b` for `<` and `<=`, `b - a` for `>` and
/// `>=`; below zero the first branch holds. Equal comparisons share a switch. Within a step every switch keeps its
/// branch, so that the law is smooth there. Where a guard changes its sign, the step is repeated, shortened to that
/// instant, with real steps of the method until the guard is zero to rounding; then the branch is decided by the
/// guard's sign just after the event. A comparison that depends on parameters only has a switch, too, which never
/// changes.
///
/// ## Dry friction
///
/// An R that `holds` has two switches, *sliding forwards* and *sliding backwards*; where neither is in its first branch, it
/// sticks. Their guards depend on their own branches: while it slides, the flow, which has to come to zero; while it sticks,
/// what the effort leaves of the limit. So it goes from sliding to sticking, or through it to sliding back, at one instant, and
/// from sticking to sliding where the load is too much. At the start the sign of the flow decides; where that is 0 it sticks if
/// it can hold the load.
///
/// The effort of sticking is solved for together with the reactions of [rigid joints](#rigid-joints), by d/dt(flow) = 0. The flow
/// stays what the event has left of it, which is rounding, and decays with 1 1/s; no place is kept, so there is no creep
/// beyond that. Modes of a machine that sticks have this decay among them. A flow counts as zero where the friction would brake it within 1e-13 s. Of several frictions that hold one
/// motion, such as the four bearings of a crank mechanism, the first ones in the order of declaration bear the load, up to
/// their limits: how they share it is not determined, the motion is.
///
/// ## Stops with a restitution
///
/// Where something reaches the end of such a stop with a speed v, the momenta jump so that it leaves with e v: Newton's law of
/// impact. The impulse acts through the masses of the whole mechanism; rigid joints and storages in derivative causality take
/// part in it, with impulses of their own, so that all flows which they hold stay zero. Of several stops reached at one instant
/// each gives back its part or is left faster; none pulls. Compliant joints and springs give no impulse, nor does dry friction:
/// what these can bear is bounded. Friction that sticks slides after an impact which moves it.
///
/// Rebounds become lower and lower. One that would rise less than a hundredth of what the tolerances allow for the place (1e-10 m
/// where it is about 1 m, by default) counts as none, with `rest below V` one that begins with less than V. Then it **rests**: the stop
/// holds it by the reaction that keeps the flow at zero, solved for together with those of rigid joints and of
/// dry friction, until that would pull. `restitution 0` is a plastic stop. A stop has one switch for each end, *being clear of* it.
///
/// - **At the instant of an impact** a sample is of the state before it, an observer's event of the state after it, and so is the end
///   of a run: another one that goes on from there begins after the impact. At the start of a run the first sample is after it.
/// - **`NAME.effort`** is that of resting, with the sign of a spring's: positive at the upper end. An impact is no effort of finite size.
///   It is in integrals: `integral(NAME.effort)` jumps by the impulse, `integral(pin.force.x)` by that of a rigid joint. An integral of
///   what is not linear in the efforts, such as `norm(pin.force)`, does not.
/// - **Energy**: an impact takes (1 - e^2) of the energy that the speed v has there. `integral(NAME.power)` and `integral(dissipated_power)`
///   jump by it, so that stored = supplied - dissipated holds over a run; so does the small energy of a rebound that counts as none.
/// - The start must be between the ends, to 1e-9 m or rad (BG0704); a state that a run goes on from must be so to 1e-9
///   of the size of the machine, and what is beyond by less is moved onto the end.
/// - Not there: friction by the impulse of a stop, `extended::integrate`.
///
/// Sources: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (1996), chapter 8; C. Glocker, Set-Valued Force Laws
/// (2001); R. M. Brach, Mechanical Impact Dynamics (1991).
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A ball that is dropped on a floor.
///     graph Ball {
///         1 fall: translation; I ball = 2; Se weight = -19.62; weight -> fall -> ball;
///         stop floor on fall { at least 0; start 1.25; restitution 0.5; }
///         observe { height: m = floor.place; floor.effort; lost: J = integral(dissipated_power) }
///     }
/// }
/// use bg_model::run::Simulation;
///
/// let model = Ball::new(BallParameters::default())?;
/// let run = Simulation::new(&model).every(0.1).until(2.0).run()?;
/// // It rests after 1.514 s, when the floor has taken all of the energy.
/// assert!((run["lost"][20] - 2.0 * 9.81 * 1.25).abs() < 1e-6);
/// assert!((run["floor.effort"][20] + 19.62).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Energy
///
/// `stored_energy` is the energy in all I and C, `supplied_power` that of all sources into the model (weights and
/// drives included, and what modulated storages take up), `dissipated_power` that of all R and of stops with a restitution out of it: d(stored)/dt =
/// supplied - dissipated.
///
/// # `observe`
///
/// ```text
/// observe = "observe" "{" entry { (";" | ",") entry } "}" | "observe" "all" "of" NAME ";"
/// entry   = [NAME [":" UNIT] "="] EXPRESSION | "all" "of" NAME
/// ```
///
/// What the model's `outputs` gives, in the order of declaration. A name alone has the unit that it was declared with, such
/// as rad for `pin.angle` and m for `slide.travel`. In an expression a unit is worth writing: an angle reads as `1`
/// without it, and so does what has lost its unit in a product with a bare number, such as
/// `2 * slide.travel`. A vector becomes three outputs with the suffixes `_x _y _z`, a matrix nine, `_11` to `_33`. Without a
/// name the output is called like its expression.
///
/// `all of NAME` is what there is to see of it, each under its path: of a part what its own `observe` names, of an array that of
/// all elements; of a body `position`, `orientation`, `momentum`, `angular_momentum`; of a joint `force`, `moment`, `gap` and
/// the motion that is free; of a spring `force` and `distance`, of a contact `force`, `gap` and `speed`, of a drive its `power`;
/// of an I `p` and `flow`, of a C `q` and `effort`, of other elements `effort` and `flow`, of a junction what it has one of.
///
/// ```
/// # use bg_model::bond_graph;
/// bond_graph! {
///     /// A motor turns a pendulum: electrical circuit and 3-D mechanism in one graph.
///     graph Swing {
///         param constant: N*m/A = 0.2;
///         param winding: Ohm = 2, above 0;
///         input voltage: V;
///         gravity [0, -9.81, 0];
///         ground { point pivot = [0, 0, 0]; }
///         body arm { sphere radius 0.05 at [0.3, 0, 0] density 2700; point end = [0, 0, 0]; start end at [0, 0, 0]; }
///         joint pin: revolute z (ground.pivot -> arm.end) { stiffness 1e5; damping 50; tilt stiffness 1e3; tilt damping 1; }
///
///         Se supply = voltage; 1 armature; R Ra = winding; I coil = 1e-3; GY motor = constant;
///         supply -> armature -> Ra; armature -> coil; armature -> motor -> pin.spin;
///
///         observe { arm.angle; pin.force; electrical_energy: J = integral(-supply.power); lost: J = integral(dissipated_power) }
///     }
/// }
/// use bg_model::system::Model;
///
/// let model = Swing::new(SwingParameters::default(), SwingInputs { voltage: 12.0.into() })?;
/// let names: Vec<&str> = model.description().outputs.iter().map(|output| output.name).collect();
/// assert_eq!(names, ["arm.angle", "pin.force_x", "pin.force_y", "pin.force_z", "electrical_energy", "lost"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Generated items
///
/// For `pub graph Motor` with the visibility of the graph; for each of its scenes the same under the scene's name:
///
/// | item | |
/// |---|---|
/// | `MotorParameters` | a struct of `f64` fields with units and defaults in their documentation; `Default`, serde's `Serialize` and `Deserialize` (unknown names refused, missing ones default), `bg_model::parameters::Parameters` for access by name; of a scene only what it tunes. A parameter `link[3].length` of a part is the field `link_3_length` |
/// | `MotorInputs` | a struct of `bg_model::input::Input`; only where there are inputs |
/// | `Motor<S = f64>` | the model, generic over the scalar; its documentation has the tables of states and of operation counts |
/// | `Motor::STATES`, `SWITCHES`, `OUTPUTS` | the sizes |
/// | `Motor::new(parameters)`, `Motor::new(parameters, inputs)` | checks the ranges and [what cannot be](#values-that-cannot-be), and calculates what depends on parameters only; `in_scalar` is the same for any `S: Scalar`, `lifted` for parameters of `S`, which may be dual numbers |
/// | `impl System` | `rate`, `guards`, `project`, `state_name`, `switch_name`, `not_finite`, what joints hold and more; nothing is allocated |
/// | `impl Model` | `start`, `impulse_energy`, `outputs`, `stored_energy`, `powers`, `description` with the tables, the expanded graph and, of a scene, the report |
///
/// A part with a visibility becomes a macro of its name, by which other calls of `bond_graph!` ask for it.
///
/// Generated code names `::bg_model` only: a crate that uses the macro needs that one dependency.
///
/// # Faults
///
/// All faults of a stage are reported at once, each that is left when those before it have given way; a later stage looks
/// at a graph that the earlier ones accepted. The stages are the sections of the table, that of parts comes after the syntax; the
/// third has three in turn: names, then
/// ports and cardinalities, then shapes and units. An algebraic loop is one fault, however many circles its variables
/// make. With a fault, the promised items are still there as stubs, so that rustc adds no errors about missing types.
///
/// | code | meaning |
/// |---|---|
/// | **syntax** | |
/// | BG0101 | a word that begins no statement here |
/// | BG0102 | a token that does not fit here |
/// | BG0103 | a missing `;` |
/// | BG0104 | `^` or `**`: use `pow` |
/// | BG0105 | not a unit |
/// | BG0106 | an `if` without `else` |
/// | BG0107 | a comparison outside an `if` |
/// | BG0108 | a second comparison in an `if` |
/// | BG0109 | `==` or `!=` |
/// | BG0110 | a clause that stands twice |
/// | BG0111 | an unknown kind, such as of joint, drive, law or expectation |
/// | BG0112 | a missing axis |
/// | BG0113 | a parameter or input without a unit |
/// | BG0114 | a parameter without a default |
/// | BG0115 | a name with dots where none may be |
/// | BG0116 | a name that Rust reserves |
/// | BG0117 | not a decimal number, or beyond all floating-point numbers |
/// | BG0118 | an expression nested too deeply |
/// | BG0119 | a cardinality other than 1 and 3 |
/// | BG0120 | a documentation comment where none may be |
/// | BG0121 | an attribute |
/// | BG0122 | a call without a graph and without a part |
/// | **mechanism words** | |
/// | BG0201 | no such body |
/// | BG0202 | no such point of the body |
/// | BG0203 | a clause that is missing, such as a stiffness |
/// | BG0204 | a clause that cannot be there |
/// | BG0205 | a body without mass |
/// | BG0206 | a body with solids and given mass |
/// | BG0207 | `ground` or `gravity` given twice |
/// | BG0208 | a drive on something that is not there |
/// | BG0209 | a drive of the wrong kind for its target |
/// | BG0210 | both ends on one body |
/// | BG0211 | a universal joint with twice the same axis |
/// | BG0212 | a contact without a law |
/// | BG0213 | a friction or stop on a joint without a free axis |
/// | BG0214 | a stop with a restitution and a stiffness or damping |
/// | **names, ports, shapes, units** | |
/// | BG0301 | not a coherent SI unit |
/// | BG0302 | a name declared twice, or two outputs of one name |
/// | BG0303 | an unknown name |
/// | BG0304 | an unknown function |
/// | BG0305 | an unknown energy domain |
/// | BG0306 | a wrong number of arguments |
/// | BG0307 | a bond to something that is neither junction nor element |
/// | BG0308 | a one-port without a bond, or with several |
/// | BG0309 | a two-port without one half arrow in and one out |
/// | BG0310 | a junction without a bond |
/// | BG0311 | a bond between different cardinalities |
/// | BG0312 | a bond that joins a node to itself |
/// | BG0313 | two shapes that do not go together |
/// | BG0314 | a shape that does not fit its place |
/// | BG0315 | a component of something that is not a vector |
/// | BG0316 | two units that disagree |
/// | BG0317 | a function of a quantity with a unit |
/// | BG0318 | a square root that has no unit |
/// | BG0319 | a bond whose units nothing fixes |
/// | BG0320 | a law whose unit does not fit its bond |
/// | BG0321 | a bare number as the law of a C: it may be a stiffness or a compliance |
/// | BG0322 | a law that needs the modulated word |
/// | BG0323 | a start value or storage law that depends on what it may not |
/// | BG0324 | a `let` that is defined by itself |
/// | BG0325 | a track of something other than a 1-junction of cardinality 3 |
/// | BG0326 | a clause that this element cannot have |
/// | BG0327 | a range without a value |
/// | BG0328 | a default outside its range |
/// | BG0329 | a default or range that is not made of numbers |
/// | BG0330 | `guess` outside a start |
/// | BG0331 | `integral` outside `observe` |
/// | BG0332 | a law of a variable that the element cannot have |
/// | BG0333 | a graph without a bond |
/// | BG0334 | a name that the language reserves: `t`, the time |
/// | BG0335 | a rate of `baumgarte` that is no number above 0 |
/// | BG0336 | `unwrapped` outside of a `let` and of `observe` |
/// | **causality** | |
/// | BG0401 | causal conflict: two bonds determine one effort or flow |
/// | BG0402 | causal conflict: none determines it |
/// | BG0403 | derivative causality where integral causality is expected, or of a displacement from the poses |
/// | BG0404 | a law that would have to work the other way round |
/// | **equations** | |
/// | BG0501 | an algebraic loop that is not linear and depends on a reaction |
/// | BG0502 | a transformer's law that is not linear |
/// | BG0503 | a stored energy that the compiler cannot find |
/// | BG0504 | a given energy whose derivative is not the law |
/// | BG0505 | a given displacement that does not change with the flow |
/// | BG0506 | a given energy that jumps where the law switches |
/// | BG0507 | a given energy that could not be compared with the law |
/// | BG0508 | an algebraic loop that leaves its variables open |
/// | BG0509 | a start of a storage whose state others determine |
/// | BG0510 | a state that an input determines, whose rate of change is not known |
/// | BG0511 | a state that a comparison of others may make jump |
/// | BG0512 | a storage in derivative causality whose effort or flow cannot be solved for |
/// | BG0515 | friction that depends on a reaction which depends on the friction |
/// | BG0516 | friction that cannot stick, since no momentum determines its flow |
/// | BG0517 | a stop with a restitution that nothing can hit, since no momentum determines its flow |
/// | BG0518 | an `unwrapped` angle that is not known at the start |
/// | **scenes** | |
/// | BG0601 | two models of one name, or a model with the name of another one's parameter or input struct |
/// | BG0602 | no such thing to leave out |
/// | BG0603 | no such parameter to tune |
/// | BG0604 | a scene that is not planar as expected |
/// | BG0605 | a scene with another number of states than expected |
/// | BG0606 | no such joint to make rigid |
/// | BG0608 | `start impulse` where no joint is rigid |
/// | BG0609 | `scenes only` in a graph without a scene |
/// | BG0610 | with `scenes only`: a scene that adjusts what the first one does not |
/// | BG0611 | with `expect independent speeds`: a scene that keeps the reactions of all rigid joints |
/// | BG0612 | no body of this name to be `dependent` |
/// | BG0613 | a `dependent` body whose orientation no loop gives |
/// | **values** | |
/// | BG0701 | a number that no physics allows, such as a mass of 0 |
/// | BG0702 | a matrix that no physics allows |
/// | BG0703 | an orientation that is no rotation |
/// | BG0704 | a restitution outside of 0 to 1, or a start beyond the end of a stop |
/// | **parts** | |
/// | BG0801 | no such part |
/// | BG0802 | no such parameter or input of the part, or one that the part gives itself |
/// | BG0803 | a part that contains itself |
/// | BG0804 | a port without a bond |
/// | BG0805 | an element that the array does not have |
/// | BG0806 | brackets after what is no array, or an array without |
/// | BG0807 | a word in brackets that is no index, or an index twice |
/// | BG0808 | a range without a number, or with too many |
/// | BG0809 | two parameters or inputs that would be one field |
/// | BG0810 | a value outside of the parameter's range |
/// | BG0811 | a parameter or input that nothing in its graph or part uses |
/// | BG0812 | a start of something that is no body |
/// | BG0813 | a start given twice |
/// | BG0814 | nothing to watch |
#[proc_macro]
pub fn bond_graph(tokens: TokenStream) -> TokenStream {
    bg_compiler::compile(tokens.into()).into()
}

/// The picture of a bond graph as HTML, for the documentation of a generated model. Only generated code calls it.
#[doc(hidden)]
#[proc_macro]
pub fn picture(tokens: TokenStream) -> TokenStream {
    bg_compiler::emit::picture(tokens.into()).into()
}
