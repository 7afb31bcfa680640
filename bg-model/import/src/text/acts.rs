//! What acts on joints and bodies: bearings, springs, rotors, stops, drives, couplings, fluids.

use nalgebra::Vector3;

use super::law::{energy, loose, odd, polynomial, sum, within};
use super::{JointNames, Writer, axis, coordinate, coordinate_word, effort, is_point, line};
use crate::number::{number, rotation, vector};
use crate::robot::{Actuator, Coupling, Drag, Joint, JointKind, Law, Length, Pose, Spring, Tendon};

impl Writer<'_> {
    /// What brakes a spherical joint: a resistance to the relative angular velocity.
    pub(super) fn ball_bearing(&self, joint: &Joint, name: &str) -> String {
        let (child, damping) = (&self.bodies[joint.child], number(joint.damping.0[0]));
        if joint.parent == 0 {
            return format!("R {name}_bearing = {damping}; {child}.rotation -> {name}_bearing;\n");
        }
        let parent = &self.bodies[joint.parent];
        format!(
            "R {name}_bearing = {damping}; 1 {name}_twist[3]: rotation; 0 {name}_moment[3]: rotation;\n\
             {name}_twist -> {name}_bearing; {name}_twist -> {name}_moment; \
             {parent}.rotation -> {name}_moment -> {child}.rotation;\n"
        )
    }

    /// What brakes a free body: a resistance to its angular velocity, and a joint to the ground that holds nothing.
    pub(super) fn drag(&self, joint: &Joint) -> String {
        if joint.damping.is_zero() {
            return String::new();
        }
        let (body, damping) = (&self.bodies[joint.child], number(joint.damping.0[0]));
        format!(
            "R {body}_drag = {damping}; {body}.rotation -> {body}_drag;\n\
             joint {body}_brake: spherical (ground -> {body}) {{ stiffness 0; damping {damping}; }}\n"
        )
    }

    /// A joint that follows another one: its speed is kept at the ratio of the leader's.
    pub(super) fn coupling(&self, coupling: &Coupling) -> String {
        let [(follower, name), (leader, other)] =
            [coupling.follower, coupling.leader].map(|joint| (&self.robot.joints[joint], &self.joints[joint].joint));
        let domain = if follower.kind == JointKind::Prismatic { "translation" } else { "rotation" };
        let mut text = String::new();
        line(&mut text, &format!("// `{name}` follows `{other}`."));
        let word = if coupling.is_linear() { "TF" } else { "MTF" };
        let ratio = polynomial(&coupling.slope(), &format!("{other}.{}", coordinate_word(leader)));
        line(&mut text, &format!("{word} {name}_ratio = {ratio}; 0 {name}_tie: {domain}; rSe {name}_follows = 0;"));
        let (axis, other_axis) = (axis(follower), axis(leader));
        line(
            &mut text,
            &format!(
                "{other}.{other_axis} -> {name}_ratio -> {name}_tie -> {name}.{axis}; {name}_follows -> {name}_tie;"
            ),
        );
        let start = polynomial(&coupling.polynomial, &self.joints[coupling.leader].start);
        line(
            &mut text,
            &format!("let {}: {} = {start};", self.joints[coupling.follower].start, coordinate(follower).1),
        );
        text
    }

    /// What drives joints by a control.
    pub(super) fn actuator(&self, actuator: &Actuator, name: &str) -> String {
        let Actuator { length, gain, bias, control, force, .. } = actuator;
        let mut text = String::new();
        let input = control.map_or_else(
            || name.to_owned(),
            |range| {
                line(&mut text, &format!("let {name}_control: 1 = {};", within(name, range)));
                format!("{name}_control")
            },
        );
        let [by_control, alone] = [gain, bias].map(|factors| self.affine(length, *factors));
        let mut terms = vec![(gain[0] + gain[1] * length.constant, input.clone())];
        if by_control.iter().any(|(factor, _)| *factor != 0.0) {
            terms.push((1.0, format!("{input} * ({})", sum(&by_control))));
        }
        terms.push((bias[0] + bias[1] * length.constant, String::new()));
        terms.extend(alone);
        let law = sum(&terms);
        let mut value = format!("({law})");
        let is_shared = length.parts.len() > 1;
        if force.is_some() || is_shared {
            line(&mut text, &format!("let {name}_effort: {} = {law};", self.unit_along(length)));
            value = format!("{name}_effort");
        }
        if let Some(range) = force {
            value = format!("({})", within(&value, *range));
        }
        for (k, &(joint, factor)) in length.parts.iter().enumerate() {
            let (word, _) = effort(&self.robot.joints[joint]);
            let on = &self.joints[joint].joint;
            let drive = if is_shared { format!("{name}_drive{}", k + 1) } else { format!("{name}_drive") };
            let value = if force.is_some() && factor == 1.0 && !is_shared {
                value[1..value.len() - 1].to_owned()
            } else {
                format!("{} * {value}", number(factor))
            };
            line(&mut text, &format!("drive {drive} on {on} {word} = {value};"));
        }
        text
    }

    /// What a length and its speed give, without what is constant.
    fn affine(&self, length: &Length, [_, place, speed]: [f64; 3]) -> Vec<(f64, String)> {
        let terms = |factor: f64, word: &dyn Fn(&Joint) -> &'static str| {
            let term = |&(joint, each): &(usize, f64)| {
                let (on, word) = (&self.joints[joint].joint, word(&self.robot.joints[joint]));
                (factor * each, format!("{on}.{word}"))
            };
            length.parts.iter().map(term).collect::<Vec<_>>()
        };
        let flow = |joint: &Joint| if joint.kind == JointKind::Prismatic { "slide.flow" } else { "spin.flow" };
        [terms(place, &coordinate_word), terms(speed, &flow)].concat()
    }

    /// The unit of a force along a length: that of a joint's effort where all are of one kind.
    fn unit_along(&self, length: &Length) -> &'static str {
        let is_turning = |part: &(usize, f64)| self.robot.joints[part.0].kind == JointKind::Revolute;
        if length.parts.iter().all(is_turning) { "N*m" } else { "N" }
    }

    /// What acts on the free axis of a joint.
    pub(super) fn actors(&self, text: &mut String, joint: &Joint, names: &JointNames) {
        let JointNames { joint: name, start, effort: input } = names;
        let flow = format!("{name}.{}", axis(joint));
        brakes(text, name, (name, &flow), &joint.damping, joint.friction);
        if let Some(spring) = joint.spring {
            line(text, &coil(name, &flow, &spring, 0.0, start));
        }
        if joint.armature > 0.0 {
            line(text, &format!("I {name}_rotor = {}; {flow} -> {name}_rotor;", number(joint.armature)));
        }
        if let Some(limits) = joint.limits.filter(|_| self.options.limits) {
            let start = if joint.kind == JointKind::Prismatic { "" } else { start };
            line(text, &stop(name, name, limits, start));
        }
        if self.has_drives() {
            let value = joint.effort.map_or_else(|| input.clone(), |most| within(input, (-most, most)));
            line(text, &format!("drive {name}_motor on {name} {} = {value};", effort(joint).0));
        }
    }

    /// What acts along several joints: a junction whose flow is the sum of theirs, each times a factor.
    pub(super) fn tendon(&self, tendon: &Tendon, name: &str) -> String {
        let Tendon { length, spring, slack, damping, friction, limits, .. } = tendon;
        let domain = if self.unit_along(length) == "N" { "translation" } else { "rotation" };
        let unit = if domain == "translation" { "m" } else { "rad" };
        let mut text = String::new();
        let joints = length.parts.iter().map(|part| (&self.robot.joints[part.0], &self.joints[part.0], part.1));
        let terms = |of: &dyn Fn(&JointNames) -> String| {
            joints.clone().map(|(_, names, each)| (each, of(names))).collect::<Vec<_>>()
        };
        let sums = sum(&terms(&|names| format!("`{}`", names.joint)));
        line(&mut text, &format!("// Along {sums}."));
        line(&mut text, &format!("0 {name}_sum: {domain}; 1 {name}_pull: {domain}; {name}_sum -> {name}_pull;"));
        for (k, (joint, names, each)) in joints.clone().enumerate() {
            let (ratio, flow) = (format!("{name}_ratio{}", k + 1), format!("{}.{}", names.joint, axis(joint)));
            line(&mut text, &format!("TF {ratio} = {}; {flow} -> {ratio} -> {name}_sum;", number(each)));
        }
        let start = format!("{name}_start");
        if spring.is_some() || limits.is_some() {
            line(&mut text, &format!("let {start}: {unit} = {};", sum(&terms(&|names| names.start.clone()))));
        }
        let flow = format!("{name}_pull");
        brakes(&mut text, name, (&flow, &flow), damping, *friction);
        if let Some(spring) = spring {
            line(&mut text, &coil(name, &flow, spring, *slack, &start));
        }
        if let Some(limits) = limits {
            line(&mut text, &stop(name, &flow, *limits, &start));
        }
        text
    }

    /// What a fluid does to a body: a force at a place and a torque, along axes of the body.
    pub(super) fn drag_by_fluid(&self, body: &str, name: &str, drag: &Drag) -> String {
        let axes = rotation(&drag.axes).map_or_else(String::new, |axes| format!(" * {axes}"));
        let at = if is_point(&Pose::at(drag.place)) { name } else { "origin" };
        let wind = self.robot.wind;
        let against = if wind == Vector3::zeros() {
            format!("{body}.{at}.velocity")
        } else {
            format!("({body}.{at}.velocity - {})", vector(&wind, 0.0))
        };
        let brakes = |[plain, square]: [f64; 2], sizes: &Vector3<f64>, of: &str| {
            let parts = ["x", "y", "z"].into_iter().zip(sizes.iter()).map(|(axis, size)| {
                let speed = format!("{name}_{of}.{axis}");
                let squared = format!("{speed} * abs({speed})");
                sum(&[(-plain, speed), (-square * size, squared)])
            });
            format!("[{}]", parts.collect::<Vec<_>>().join(", "))
        };
        let mut text = String::new();
        line(&mut text, &format!("let {name}_axes: 1 = {body}.orientation{axes};"));
        line(&mut text, &format!("let {name}_velocity: m/s = transpose({name}_axes) * {against};"));
        line(&mut text, &format!("let {name}_spin: rad/s = transpose({name}_axes) * {body}.angular_velocity;"));
        let target = if at == "origin" { body.to_owned() } else { format!("{body}.{at}") };
        let force = brakes(drag.force, &drag.areas, "velocity");
        line(&mut text, &format!("drive {name}_force on {target} force = {name}_axes * {force};"));
        let torque = brakes(drag.torque, &drag.turns, "spin");
        line(&mut text, &format!("drive {name}_torque on {body} torque = {name}_axes * {torque};"));
        text
    }
}

/// What brakes a flow: a resistance, dry friction, or both in one. `on` is what the friction acts on, and its junction.
fn brakes(text: &mut String, name: &str, (on, flow): (&str, &str), damping: &Law, friction: f64) {
    let is_plain = damping.is_linear() && damping.0[0] >= 0.0;
    if friction > 0.0 {
        let viscous =
            if is_plain && !damping.is_zero() { format!(" viscous {};", number(damping.0[0])) } else { String::new() };
        line(text, &format!("friction {name}_friction on {on} {{ coulomb {};{viscous} }}", number(friction)));
    }
    let is_said = is_plain && friction > 0.0;
    if !(is_said || damping.is_zero()) {
        let law = if is_plain { format!(" = {}", number(damping.0[0])) } else { odd(damping, "w") };
        line(text, &format!("R {name}_bearing{law}; {flow} -> {name}_bearing;"));
    }
}

/// A spring on a flow, from where the displacement is at the start; loose over some of it.
fn coil(name: &str, flow: &str, Spring { law, rest }: &Spring, slack: f64, start: &str) -> String {
    let from = match number(-rest) {
        zero if zero == "0" => start.to_owned(),
        rest if rest.starts_with('-') => format!("{start} - {}", &rest[1..]),
        rest => format!("{start} + {rest}"),
    };
    let (law, energy) = if slack > 0.0 { loose(law, "q", slack) } else { (odd(law, "q"), energy(law, "q")) };
    format!("C {name}_spring{law} start {from}{energy}; {flow} -> {name}_spring;")
}

/// A stop with an end or two.
fn stop(name: &str, on: &str, (least, most): (f64, f64), start: &str) -> String {
    let from = if start.is_empty() { String::new() } else { format!(" start {start};") };
    let end = |word: &str, value: f64| {
        if value.is_finite() { format!("at {word} {}; ", number(value)) } else { String::new() }
    };
    let ends = end("least", least) + &end("most", most);
    format!("stop {name}_stop on {on} {{ {ends}restitution 0;{from} }}")
}
