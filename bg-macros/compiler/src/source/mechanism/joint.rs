//! Compliant joints: relative motion, a C and an R on every held direction.
//!
//! In: `ast::Joint`. Out: bond-graph words. Flows and displacements are those of the second end relative to the first;
//! `NAME.force` and `NAME.moment` act on the second body. Directions are those of the first end's axes, which are its
//! body's where its point is not turned; a pin whose stiffness is one number has the same in all of them and is kept in
//! inertial axes. With `frame inertial` the held rotations are about inertial axes and their displacements integrate
//! the relative angular velocity; without it they are direction cosines of the two ends' axes, which the poses
//! determine.

use super::attachment::stiff;
use super::shapes::CENTER;
use super::{End, Expansion, MechanismFault, is_vector};
use crate::source::ast::{Axis, Expression, ExpressionKind, Item, Joint, JointKind};
use crate::source::clause::{Allowed, Clause, Given};

impl JointKind {
    /// The axis of the free rotation that a drive can turn.
    #[must_use]
    pub fn spin(self) -> Option<Axis> {
        match self {
            Self::Revolute(axis) | Self::Cylindrical(axis) => Some(axis),
            _ => None,
        }
    }

    /// The axis of the free translation that a drive can push along.
    #[must_use]
    pub fn slide(self) -> Option<Axis> {
        match self {
            Self::Prismatic(axis) | Self::Cylindrical(axis) => Some(axis),
            _ => None,
        }
    }

    /// Whether a drive can turn it about any axis.
    #[must_use]
    pub fn turns_freely(self) -> bool {
        matches!(self, Self::Spherical)
    }

    /// Whether it holds any rotation.
    fn holds_rotation(self) -> bool {
        !self.turns_freely()
    }
}

/// One held rotation: its name, the direction of its moment and its displacement as text.
struct HeldRotation {
    axis: Axis,
    label: String,
    direction: String,
    displacement: String,
}

impl Expansion<'_> {
    /// Expands a joint.
    pub(super) fn joint(&mut self, joint: &Joint) {
        let name = &joint.name;
        if let JointKind::Universal(first, second) = joint.kind
            && first == second
        {
            self.fault(name.span, &MechanismFault::SameAxes { name: name.text.clone() });
        }
        let Some((a, b)) = self.ends(name, &joint.ends) else { return };
        let is_complete = self.clauses(joint);
        if self.play_fits(joint) && is_complete {
            self.translations(joint, &a, &b);
            let has_moment = self.rotations(joint, &a, &b);
            self.draw_joint((name, joint.kind.to_string()), &joint.ends, [&a.position, &b.position], has_moment);
            self.motion(joint, &a, &b);
        }
    }

    /// Binds the joint's stiffnesses and dampings; false where one is missing.
    fn clauses(&mut self, joint: &Joint) -> bool {
        let name = &joint.name.text;
        let mut complete = true;
        let missing = |clause, why| MechanismFault::MissingClause { word: "joint", name: name.clone(), clause, why };
        let clause = |what: &str, value: &Expression| {
            Clause::new(format!("the {what} of joint `{name}`"), if is_vector(value) { 3 } else { 1 })
        };
        // What a rigid joint does not use may be anything.
        let stiff = |clause: Clause| if joint.rigid { clause.given(Given::State) } else { stiff(clause) };
        let damped = |clause: Clause| if joint.rigid { clause } else { clause.allowed(Allowed::NotNegative) };
        match &joint.stiffness {
            Some(value) => self.bind(&format!("{name}.stiffness"), "N/m", value, stiff(clause("stiffness", value))),
            None if joint.rigid => {}
            None => {
                complete = false;
                self.fault(joint.name.span, &missing("stiffness", "its held translations need one"));
            }
        }
        if let Some(value) = &joint.damping {
            self.bind(&format!("{name}.damping"), "N*s/m", value, damped(clause("damping", value)));
        }
        let superfluous = |clause| MechanismFault::SuperfluousClause {
            word: "joint",
            name: name.clone(),
            clause,
            why: "it holds no rotation",
        };
        match (&joint.tilt_stiffness, joint.kind.holds_rotation()) {
            (Some(value), true) => {
                let clause = stiff(clause("tilt stiffness", value));
                self.bind(&format!("{name}.tilt_stiffness"), "N*m/rad", value, clause);
            }
            (Some(value), false) => self.fault(value.span, &superfluous("tilt stiffness")),
            (None, true) if joint.rigid => {}
            (None, true) => {
                complete = false;
                self.fault(joint.name.span, &missing("tilt stiffness", "its held rotations need one"));
            }
            (None, false) => {}
        }
        match (&joint.tilt_damping, joint.kind.holds_rotation()) {
            (Some(value), true) => {
                let clause = damped(clause("tilt damping", value));
                self.bind(&format!("{name}.tilt_damping"), "N*m*s/rad", value, clause);
            }
            (Some(value), false) => self.fault(value.span, &superfluous("tilt damping")),
            (None, _) => {}
        }
        complete
    }

    /// A pin in a hole that is wider: along its axis held as others, across it pushed back where the play ends.
    fn pin_with_play(&mut self, joint: &Joint, axis: Axis, a: &End, b: &End) {
        let (name, span) = (&joint.name.text, joint.name.span);
        self.force_junction(span, name, (a, b), (a.arm_to(&b.position), b.arm.clone()));
        let (letter, along) = (axis.letter(), format!("{}.{}_axis", a.axes, axis.letter()));
        self.text(
            span,
            &format!(
                "let {name}.gap: m = {} - {}; let {name}.{letter}_offset: m = dot({along}, {name}.gap);
                 close {name} = {name}.gap - {along} * {name}.{letter}_offset; close {name} = {name}.{letter}_offset;
                 1 {name}.{letter}: translation; MTF {name}.{letter}_axis(v) = dot({along}, v);
                 {name}.slip -> {name}.{letter}_axis -> {name}.{letter};
                 C {name}.{letter}_spring = {name}.stiffness at {name}.{letter}_offset;
                 {name}.{letter} -> {name}.{letter}_spring;
                 let {name}.eccentricity: m = sqrt(dot({name}.gap, {name}.gap) - pow({name}.{letter}_offset, 2)
                     + pow({CENTER} * {name}.clearance, 2));
                 let {name}.inward: 1 = ({along} * {name}.{letter}_offset - {name}.gap) / {name}.eccentricity;
                 1 {name}.approach: translation; MTF {name}.approach_axis(v) = dot({name}.inward, v);
                 {name}.slip -> {name}.approach_axis -> {name}.approach;",
                b.position, a.position
            ),
        );
        self.press(&joint.name, &joint.press_law(), (name, &format!("{name}.clearance - {name}.eccentricity")));
    }

    /// A slider between two guides across each axis that it holds: pushed back where the play ends, at its end, or
    /// where it has a length at two places that are so far apart.
    fn slider_with_play(&mut self, joint: &Joint, slide: Axis, a: &End, b: &End) {
        let (name, span) = (&joint.name.text, joint.name.span);
        self.text(span, &format!("let {name}.gap: m = {} - {};", b.position, a.position));
        let places = if joint.length.is_some() {
            let along = format!("{}.{}_axis", b.axes, slide.letter());
            let ends = [("front", "+"), ("rear", "-")];
            ends.map(|(end, sign)| (format!("{name}.{end}"), format!(" {sign} (0.5 * {name}.length) * {along}"))).into()
        } else {
            vec![(name.clone(), String::new())]
        };
        let mut pressed = Vec::new();
        for (place, from_end) in &places {
            let position = format!("({}{from_end})", b.position);
            self.force_junction(span, place, (a, b), (a.arm_to(&position), b.arm_to(&position)));
            for axis in Axis::ALL.into_iter().filter(|&axis| axis != slide) {
                let (letter, side) = (axis.letter(), format!("{place}.{}", axis.letter()));
                let across = format!("{}.{letter}_axis", a.axes);
                self.text(
                    span,
                    &format!(
                        "let {side}_offset: m = dot({across}, {position} - {}); close {name} = {side}_offset;
                         let {side}_off: m = sqrt(pow({side}_offset, 2) + pow({CENTER} * {name}.clearance, 2));
                         let {side}_inward: 1 = -{across} * ({side}_offset / {side}_off);
                         1 {side}.approach: translation; MTF {side}.axis(v) = dot({side}_inward, v);
                         {place}.slip -> {side}.axis -> {side}.approach;",
                        a.position
                    ),
                );
                self.press(&joint.name, &joint.press_law(), (&side, &format!("{name}.clearance - {side}_off")));
                pressed.push(format!("{side}.pressed"));
            }
        }
        if joint.length.is_some() {
            let middle = self.is_used(joint, "slide").then(|| format!("{name}.middle.force"));
            let forces: Vec<String> = places.iter().map(|(place, _)| format!("{place}.force")).chain(middle).collect();
            self.text(span, &format!("let {name}.force = {};", forces.join(" + ")));
        }
        self.text(span, &format!("let {name}.pressed: N = {};", pressed.join(" + ")));
    }

    /// Binds the clearance and what belongs to it; false, with a fault, where there can be none.
    fn play_fits(&mut self, joint: &Joint) -> bool {
        let name = &joint.name.text;
        let fault = |clause, why| MechanismFault::SuperfluousClause { word: "joint", name: name.clone(), clause, why };
        let faults = self.faults.len();
        let Some(clearance) = &joint.clearance else {
            let length = joint.length.as_ref().map(|value| ("length", value));
            let mut play = joint.play.clone();
            let clauses = play.play_mut().map(|(clause, value)| Some((clause, value.as_ref()?)));
            for (clause, value) in length.into_iter().chain(clauses.into_iter().flatten()) {
                self.fault(value.span, &fault(clause, "it has no `clearance`"));
            }
            return self.faults.len() == faults;
        };
        let is_slider = matches!(joint.kind, JointKind::Prismatic(_));
        if joint.rigid {
            self.fault(clearance.span, &fault("clearance", "a rigid joint has no play"));
        } else if !is_slider && !matches!(joint.kind, JointKind::Revolute(_)) {
            self.fault(clearance.span, &fault("clearance", "only revolute and prismatic joints have play"));
        }
        for (clause, value) in [("stiffness", &joint.stiffness), ("damping", &joint.damping)] {
            if let Some(value) = value.as_ref().filter(|value| is_vector(value)) {
                self.fault(value.span, &fault(clause, "with a `clearance` it is one number in all directions"));
            }
        }
        let clause = |what: &str| Clause::new(format!("the {what} of joint `{name}`"), 1).allowed(Allowed::Positive);
        self.bind(&format!("{name}.clearance"), "m", clearance, clause("clearance"));
        match &joint.length {
            Some(length) if is_slider => self.bind(&format!("{name}.length"), "m", length, clause("length")),
            Some(length) => self.fault(length.span, &fault("length", "a pin touches at one place only")),
            None => {}
        }
        self.press_options("joint", &joint.name, &joint.press_law());
        self.faults.len() == faults
    }

    fn translations(&mut self, joint: &Joint, a: &End, b: &End) {
        let (name, span) = (&joint.name.text, joint.name.span);
        let slide = joint.kind.slide();
        match joint.kind {
            JointKind::Revolute(axis) if joint.clearance.is_some() => return self.pin_with_play(joint, axis, a, b),
            JointKind::Prismatic(axis) if joint.clearance.is_some() => {
                self.slider_with_play(joint, axis, a, b);
                return self.free_slide(joint, axis, a, b);
            }
            _ => {}
        }
        let has_axes = |value: &Option<Expression>| value.as_ref().is_some_and(is_vector);
        let per_axis = !joint.rigid && (has_axes(&joint.stiffness) || has_axes(&joint.damping));
        if slide.is_none() && !per_axis {
            self.force_junction(span, name, (a, b), (a.arm.clone(), b.arm.clone()));
            self.text(span, &format!("let {name}.gap: m = {} - {};", b.position, a.position));
            if joint.rigid || !is_absent(joint.stiffness.as_ref(), Axis::X) {
                self.text(span, &format!("close {name} = {name}.gap;"));
            }
            if joint.rigid {
                self.text(
                    span,
                    &format!(
                        "rSe {name}.reaction = [0, 0, 0] at {name}.gap of {name}; {name}.slip -> {name}.reaction;"
                    ),
                );
                return;
            }
            self.text(
                span,
                &format!("C {name}.spring = {name}.stiffness at {name}.gap; {name}.slip -> {name}.spring;"),
            );
            if joint.damping.is_some() {
                self.text(span, &format!("R {name}.damper = {name}.damping; {name}.slip -> {name}.damper;"));
            }
            return;
        }
        // In the first body's axes the relative velocity is that of its point under the second end.
        self.force_junction(span, name, (a, b), (a.arm_to(&b.position), b.arm.clone()));
        self.text(span, &format!("let {name}.gap: m = {} - {};", b.position, a.position));
        for axis in Axis::ALL.into_iter().filter(|&axis| Some(axis) != slide) {
            let letter = axis.letter();
            let label = format!("{name}.{letter}");
            let direction = format!("{}.{letter}_axis", a.axes);
            self.text(
                span,
                &format!(
                    "1 {label}: translation; MTF {label}_axis(v) = dot({direction}, v);
                     {name}.slip -> {label}_axis -> {label};
                     let {label}_offset: m = dot({direction}, {name}.gap);"
                ),
            );
            if joint.rigid || !is_absent(joint.stiffness.as_ref(), axis) {
                self.text(span, &format!("close {name} = {label}_offset;"));
            }
            if joint.rigid {
                self.text(
                    span,
                    &format!(
                        "rSe {label}_reaction = 0 at {label}_offset of {name} along {letter};
                         {label} -> {label}_reaction;"
                    ),
                );
                continue;
            }
            let stiffness = of_axis(joint.stiffness.as_ref(), &format!("{name}.stiffness"), axis);
            self.text(span, &format!("C {label}_spring = {stiffness} at {label}_offset; {label} -> {label}_spring;"));
            if joint.damping.is_some() {
                let damping = of_axis(joint.damping.as_ref(), &format!("{name}.damping"), axis);
                self.text(span, &format!("R {label}_damper = {damping}; {label} -> {label}_damper;"));
            }
        }
        if let Some(axis) = slide {
            self.free_slide(joint, axis, a, b);
        }
    }

    /// The junction of the free translation, where something acts on it; of a slider with a length, which has no
    /// junction in its middle, with that.
    fn free_slide(&mut self, joint: &Joint, axis: Axis, a: &End, b: &End) {
        if !self.is_used(joint, "slide") {
            return;
        }
        let (name, span) = (&joint.name.text, joint.name.span);
        let middle = if joint.length.is_some() { format!("{name}.middle") } else { name.clone() };
        if joint.length.is_some() {
            self.force_junction(span, &middle, (a, b), (a.arm_to(&b.position), b.arm.clone()));
        }
        self.text(
            span,
            &format!(
                "1 {name}.slide: translation; MTF {name}.slide_axis(v) = dot({}.{}_axis, v);
                 {middle}.slip -> {name}.slide_axis -> {name}.slide;",
                a.axes,
                axis.letter()
            ),
        );
    }

    /// The held rotations and the free ones that something turns; false where there is neither.
    fn rotations(&mut self, joint: &Joint, a: &End, b: &End) -> bool {
        let (name, span) = (&joint.name.text, joint.name.span);
        let spin = joint.kind.spin().filter(|_| self.is_used(joint, "spin"));
        let (held, tilting): (Vec<_>, Vec<_>) = held_rotations(joint.kind, &a.axes, &b.axes)
            .into_iter()
            .partition(|rotation| joint.length.is_none() || joint.kind.slide() == Some(rotation.axis));
        for rotation in tilting {
            // It starts in the middle of its play.
            self.text(span, &format!("close {name} = {};", rotation.displacement));
        }
        let turned = joint.kind.turns_freely() && self.is_used(joint, "twist");
        if held.is_empty() && spin.is_none() && !turned {
            return false;
        }
        self.text(
            span,
            &format!(
                "0 {name}.angular[3]: rotation; 1 {name}.twist[3]: rotation;
                 {name}.twist -> {name}.angular; {}.rotation -> {name}.angular -> {}.rotation;
                 let {name}.moment = {name}.angular.effort;",
                a.body, b.body
            ),
        );
        for rotation in &held {
            if joint.rigid || !is_absent(joint.tilt_stiffness.as_ref(), rotation.axis) {
                self.text(span, &format!("close {name} = {};", rotation.displacement));
            }
        }
        let alike = joint.tilt_stiffness.as_ref().is_none_or(|value| !is_vector(value))
            && joint.tilt_damping.as_ref().is_none_or(|value| !is_vector(value));
        if joint.inertial && !joint.rigid && held.len() == 3 && alike {
            self.text(
                span,
                &format!("C {name}.tilt_spring = {name}.tilt_stiffness; {name}.twist -> {name}.tilt_spring;"),
            );
            if joint.tilt_damping.is_some() {
                self.text(
                    span,
                    &format!("R {name}.tilt_damper = {name}.tilt_damping; {name}.twist -> {name}.tilt_damper;"),
                );
            }
        } else {
            for rotation in &held {
                self.held_rotation(joint, rotation);
            }
        }
        if let Some(axis) = spin {
            self.text(
                span,
                &format!(
                    "1 {name}.spin: rotation; MTF {name}.spin_axis(w) = dot({}.{}_axis, w);
                     {name}.twist -> {name}.spin_axis -> {name}.spin;",
                    a.axes,
                    axis.letter()
                ),
            );
        }
        true
    }

    fn held_rotation(&mut self, joint: &Joint, rotation: &HeldRotation) {
        let (name, span) = (&joint.name.text, joint.name.span);
        let label = format!("{name}.{}", rotation.label);
        let axis = rotation.axis;
        if joint.rigid {
            let HeldRotation { direction, displacement, .. } = rotation;
            self.text(
                span,
                &format!(
                    "1 {label}: rotation; MTF {label}_axis(w) = dot({direction}, w);
                     {name}.twist -> {label}_axis -> {label};
                     rSe {label}_reaction = 0 at {displacement} of {name} about {};
                     {label} -> {label}_reaction;",
                    axis.letter()
                ),
            );
            return;
        }
        let (word, direction, at) = if joint.inertial {
            ("TF", format!("ground.{}_axis", axis.letter()), String::new())
        } else {
            ("MTF", rotation.direction.clone(), format!(" at {}", rotation.displacement))
        };
        let stiffness = of_axis(joint.tilt_stiffness.as_ref(), &format!("{name}.tilt_stiffness"), axis);
        self.text(
            span,
            &format!(
                "1 {label}: rotation; {word} {label}_axis(w) = dot({direction}, w);
                 {name}.twist -> {label}_axis -> {label};
                 C {label}_spring = {stiffness}{at}; {label} -> {label}_spring;"
            ),
        );
        if joint.tilt_damping.is_some() {
            let damping = of_axis(joint.tilt_damping.as_ref(), &format!("{name}.tilt_damping"), axis);
            self.text(span, &format!("R {label}_damper = {damping}; {label} -> {label}_damper;"));
        }
    }

    /// Names for the free motion: angle, direction and speed about, travel along the free axis.
    fn motion(&mut self, joint: &Joint, a: &End, b: &End) {
        let (name, span) = (&joint.name.text, joint.name.span);
        let (turns, carries, a, b) = (&b.body, &a.body, &a.axes, &b.axes);
        if let Some(axis) = joint.kind.spin() {
            let (along, across) = (axis.letter(), axis.next().letter());
            self.text(
                span,
                &format!(
                    "let {name}.sine: 1 = dot(cross({a}.{across}_axis, {b}.{across}_axis), {a}.{along}_axis);
                     let {name}.cosine: 1 = dot({a}.{across}_axis, {b}.{across}_axis);
                     let {name}.direction: rad = atan2({name}.sine, {name}.cosine);
                     let {name}.angle: rad = unwrapped({name}.sine, {name}.cosine, {name}.speed);
                     let {name}.speed: rad/s = dot({a}.{along}_axis, {turns}.angular_velocity - \
                     {carries}.angular_velocity);"
                ),
            );
        }
        if let Some(axis) = joint.kind.slide() {
            self.text(span, &format!("let {name}.travel: m = dot({a}.{}_axis, {name}.gap);", axis.letter()));
        }
    }

    /// Whether a bond, a drive, a friction or a stop uses the joint's free axis.
    fn is_used(&self, joint: &Joint, axis: &str) -> bool {
        let name = format!("{}.{axis}", joint.name.text);
        let is_named = self.source.items.iter().any(|item| match item {
            Item::Chain(chain) => chain.iter().any(|link| link.text == name),
            Item::Drive(drive) => drive.target.text == joint.name.text,
            _ => false,
        });
        is_named || self.is_braked(&name)
    }
}

/// A stiffness of one axis: the number itself, or its component.
fn of_axis(value: Option<&Expression>, name: &str, axis: Axis) -> String {
    if value.is_some_and(is_vector) { format!("{name}.{}", axis.letter()) } else { name.to_owned() }
}

/// Whether the stiffness of one axis is the number 0: no gap along it or about it is there to close. A parameter that
/// happens to be 0 closes as any other value of it does, so that the start pose does not depend on it.
fn is_absent(value: Option<&Expression>, axis: Axis) -> bool {
    let of_axis = value.map(|value| match &value.kind {
        ExpressionKind::Vector(parts) => parts.get(axis as usize).unwrap_or(value),
        _ => value,
    });
    of_axis.and_then(Expression::number) == Some(0.0)
}

/// The held rotations as direction cosines: for small angles each is the angle about its axis, and its rate is the
/// component of the relative angular velocity along `direction`.
fn held_rotations(kind: JointKind, a: &str, b: &str) -> Vec<HeldRotation> {
    // The cosine between axis j of a and axis k of b changes by w . (k_b x j_a); for (i, j, k) cyclic that is -w_i.
    let about = |i: Axis, j: Axis, k: Axis, sign: &str| {
        let (j, k) = (j.letter(), k.letter());
        let cross = if sign == "-" {
            format!("cross({a}.{j}_axis, {b}.{k}_axis)")
        } else {
            format!("cross({b}.{k}_axis, {a}.{j}_axis)")
        };
        HeldRotation {
            axis: i,
            label: format!("tilt_{}", i.letter()),
            direction: cross,
            displacement: format!("{sign}dot({a}.{j}_axis, {b}.{k}_axis)"),
        }
    };
    match kind {
        JointKind::Spherical => Vec::new(),
        JointKind::Revolute(k) | JointKind::Cylindrical(k) => {
            let (i, j) = (k.next(), k.next().next());
            vec![about(i, j, k, "-"), about(j, i, k, "")]
        }
        JointKind::Universal(first, second) => {
            let third = Axis::ALL.into_iter().find(|axis| ![first, second].contains(axis)).unwrap_or(Axis::Z);
            let sign = if third.next() == first { "-" } else { "" };
            vec![about(third, first, second, sign)]
        }
        JointKind::Prismatic(_) | JointKind::Fixed => {
            Axis::ALL.into_iter().map(|i| about(i, i.next(), i.next().next(), "-")).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::graph;
    use crate::source::{mechanism, syntax};

    /// What a graph observes, with units.
    fn observed(statements: &str) -> Vec<String> {
        let source = syntax::parse(format!("graph G {{ {statements} }}").parse().expect("tokens")).expect("syntax");
        let resolved = graph::resolve(&mechanism::expand(&source.graphs[0]).expect("words")).expect("names and units");
        resolved.observations.iter().map(|observation| format!("{} {}", observation.name, observation.unit)).collect()
    }

    #[test]
    fn a_joint_has_the_axes_of_points_that_are_turned() {
        let text = "graph G {
            ground { point foot = [0, 0, 1] turned rotation_x(0.3); }
            body rod { mass 1; inertia [1, 1, 1]; point top = [0, 1, 0] turned rotation_z(0.2); }
            joint pin: revolute z (ground.foot -> rod.top) { rigid; }
            observe { pin.angle }
        }";
        let parsed = |text: &str| syntax::parse(text.parse().expect("tokens")).expect("syntax");
        let source = parsed(text);
        let printed = source.graphs[0].to_string();
        assert_eq!(printed, parsed(&printed).graphs[0].to_string());
        let expanded = mechanism::expand(&source.graphs[0]).expect("words").to_string();
        let has = |words: &str| assert!(expanded.contains(words), "no `{words}` in\n{expanded}");
        has("let ground.foot.z_axis: 1 = ground.foot.turned * [0, 0, 1];");
        has("let rod.top.z_axis: 1 = rod.orientation * (rod.top.turned * [0, 0, 1]);");
        has("rSe pin.tilt_x_reaction = 0 at -dot(ground.foot.y_axis, rod.top.z_axis) of pin about x;");
        has("let pin.speed: rad/s = dot(ground.foot.z_axis, rod.angular_velocity - ground.angular_velocity);");
    }

    #[test]
    fn free_motion_has_its_unit_whatever_the_first_body_is() {
        for first in ["ground", "base"] {
            let text = format!(
                "body base {{ mass 1; inertia [1, 1, 1]; }} body rod {{ mass 1; inertia [1, 1, 1]; }}
                 joint j: cylindrical x ({first} -> rod) {{ stiffness 1; tilt stiffness 1; }}
                 joint k: fixed (ground -> base) {{ stiffness 1; tilt stiffness 1; }}
                 observe {{ j.travel; j.angle; j.speed; double = 2 * j.travel; j.gap }}"
            );
            // In an expression an angle is a pure number.
            assert_eq!(
                observed(&text),
                ["j.travel m", "j.angle rad", "j.speed rad/s", "double 1", "j.gap m"],
                "{first}"
            );
        }
    }
}
