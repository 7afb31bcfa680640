//! What acts on joints and bodies: bearings, springs, rotors, stops, drives, couplings, fluids.

use nalgebra::Vector3;

use super::law::{energy, odd, polynomial, sum, within};
use super::{JointNames, Writer, axis, coordinate, coordinate_word, effort, is_point, line};
use crate::number::{number, rotation, vector};
use crate::robot::{Actuator, Coupling, Drag, Joint, Kind, Length, Pose, Spring};

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
             {name}_twist -> {name}_bearing; {name}_twist -> {name}_moment; {parent}.rotation -> {name}_moment -> {child}.rotation;\n"
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
        let domain = if follower.kind == Kind::Prismatic { "translation" } else { "rotation" };
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
        let flow = |joint: &Joint| if joint.kind == Kind::Prismatic { "slide.flow" } else { "spin.flow" };
        [terms(place, &coordinate_word), terms(speed, &flow)].concat()
    }

    /// The unit of a force along a length: that of a joint's effort where all are of one kind.
    fn unit_along(&self, length: &Length) -> &'static str {
        let is_turning = |part: &(usize, f64)| self.robot.joints[part.0].kind == Kind::Revolute;
        if length.parts.iter().all(is_turning) { "N*m" } else { "N" }
    }

    /// What acts on the free axis of a joint.
    pub(super) fn actors(&self, text: &mut String, joint: &Joint, names: &JointNames) {
        let JointNames { joint: name, start, effort: input } = names;
        let slides = joint.kind == Kind::Prismatic;
        let axis = axis(joint);
        let is_plain = joint.damping.is_linear() && joint.damping.0[0] >= 0.0;
        if joint.friction > 0.0 {
            let viscous = if is_plain && !joint.damping.is_zero() {
                format!(" viscous {};", number(joint.damping.0[0]))
            } else {
                String::new()
            };
            line(
                text,
                &format!("friction {name}_friction on {name} {{ coulomb {};{viscous} }}", number(joint.friction)),
            );
        }
        let is_said = is_plain && joint.friction > 0.0;
        if !(is_said || joint.damping.is_zero()) {
            let law = if is_plain { format!(" = {}", number(joint.damping.0[0])) } else { odd(&joint.damping, "w") };
            line(text, &format!("R {name}_bearing{law}; {name}.{axis} -> {name}_bearing;"));
        }
        if let Some(Spring { law, rest }) = joint.spring {
            let from = match number(-rest) {
                zero if zero == "0" => start.clone(),
                rest if rest.starts_with('-') => format!("{start} - {}", &rest[1..]),
                rest => format!("{start} + {rest}"),
            };
            let (law, energy) = (odd(&law, "q"), energy(&law, "q"));
            line(text, &format!("C {name}_spring{law} start {from}{energy}; {name}.{axis} -> {name}_spring;"));
        }
        if joint.armature > 0.0 {
            line(text, &format!("I {name}_rotor = {}; {name}.{axis} -> {name}_rotor;", number(joint.armature)));
        }
        if let Some((least, most)) = joint.limits.filter(|_| self.options.limits) {
            let from = if slides { String::new() } else { format!(" start {start};") };
            let end = |word: &str, value: f64| {
                if value.is_finite() { format!("at {word} {}; ", number(value)) } else { String::new() }
            };
            let ends = end("least", least) + &end("most", most);
            line(text, &format!("stop {name}_stop on {name} {{ {ends}restitution 0;{from} }}"));
        }
        if self.has_drives() {
            let value = joint.effort.map_or_else(|| input.clone(), |most| within(input, (-most, most)));
            line(text, &format!("drive {name}_motor on {name} {} = {value};", effort(joint).0));
        }
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
