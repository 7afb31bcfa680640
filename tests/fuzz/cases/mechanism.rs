//! Random mechanisms of one to three bodies that mostly make a valid graph.
//!
//! In: randomness. Out: a graph's text. Every body hangs on an earlier one or the ground by a joint; springs, drives,
//! contacts and scenes are added now and then.

use fastrand::Rng;

use super::draw::{number, one, rarely};
use super::expression::scalar;

/// The text of a mechanism.
pub(super) fn mechanism(rng: &mut Rng) -> String {
    let bodies = if rarely(rng, 50) { 3 } else { 1 + usize::from(rarely(rng, 8)) };
    let mut statements = vec![
        "param size: m = 0.3, above 0; param k: N/m = 1e5; param push: N = 2; param angle: rad = 0.4;".to_owned(),
        "ground { point O = [0, 0.1, 0]; point wall = [1, 0, 0]; }".to_owned(),
    ];
    if !rarely(rng, 4) {
        let gravity = one(rng, &["[0, -9.81, 0]", "[0, 0, -9.81]", "[0, 0, 0]", "[1, 2, 3]", "[0, -push / 2, 0]"]);
        statements.push(format!("gravity {gravity};"));
    }
    // Every parameter has to be used by something.
    if !rarely(rng, 20) {
        statements.push("let all = [size / 1, k / 1, push / 1]; let turned = angle;".to_owned());
    }
    for index in 0..bodies {
        statements.push(body(rng, index));
        if !rarely(rng, 8) {
            let clauses = clauses(rng);
            statements.push(joint(rng, index, &clauses));
        }
        extras(rng, index, &mut statements);
    }
    statements.push(observe(rng, bodies));
    rng.shuffle(&mut statements);
    for index in 0..rng.usize(..3).min(rng.usize(..3)) {
        statements.push(scene(rng, index, bodies));
    }
    format!("graph Mechanism {{\n    {}\n}}\n", statements.join("\n    "))
}

fn body(rng: &mut Rng, index: usize) -> String {
    let mass = match rng.u32(..5) {
        0 => format!("cuboid [size, 0.03, {}] density 7850;", number(rng)),
        1 => "cylinder radius 0.01 length size along y; sphere radius 0.1 at [size, 0, 0]; density 2700;".to_owned(),
        2 => "cuboid [1, 2, 3] at [0, size, 0] turned rotation_x(angle) density 1;".to_owned(),
        3 => format!("mass {}; inertia [0.1, 0.2, 0.3]; center [0, size, 0];", number(rng)),
        _ => "mass 2; inertia [[1, 0.1, 0], [0.1, 2, 0], [0, 0, 3]];".to_owned(),
    };
    let names = ["size".to_owned(), "angle".to_owned()];
    let start = match rng.u32(..6) {
        0 => "start at [guess(0.4), 0, 0];".to_owned(),
        1 => "start P at [0, 0.1, 0]; start turned rotation_z(angle);".to_owned(),
        2 => "start turned rotation_z(guess(angle)) * rotation_x(0.2); start spin [0, 0, 3];".to_owned(),
        3 => format!("start at [{}, 0, 0]; start velocity [1, 0, size / 1];", scalar(rng, &names, 2)),
        _ => String::new(),
    };
    format!("body b{index} {{ {mass} point P = [size, 0, 0]; point Q = [0, -size, {}]; {start} }}", number(rng))
}

/// An earlier body's end, or one of the ground's.
fn before(rng: &mut Rng, index: usize) -> String {
    if index > 0 && !rarely(rng, 3) {
        return format!("b{}{}", rng.usize(..index), one(rng, &["", ".P", ".Q"]));
    }
    one(rng, &["ground", "ground.O", "ground.wall"]).to_owned()
}

fn joint(rng: &mut Rng, index: usize, clauses: &str) -> String {
    let axis = one(rng, &["x", "y", "z", "z", "z"]);
    let kind = match rng.u32(..8) {
        0..=2 => format!("revolute {axis}"),
        3 => format!("prismatic {axis}"),
        4 => "spherical".to_owned(),
        5 => format!("cylindrical {axis}"),
        6 => format!("universal {axis} {}", if axis == "x" { "y" } else { "x" }),
        _ => "fixed".to_owned(),
    };
    let (from, to) = (before(rng, index), one(rng, &["", ".P", ".Q"]));
    let clauses = if kind == "spherical" {
        clauses.replace("tilt stiffness 1e3; tilt damping 2;", "")
    } else {
        clauses.to_owned()
    };
    format!("joint pin{index}: {kind} ({from} -> b{index}{to}) {{ {clauses} }}")
}

fn clauses(rng: &mut Rng) -> String {
    let stiffness = one(rng, &["k", "1e6", "[k, k, 2 * k]", "2 * k"]);
    let frame = if rarely(rng, 4) { "frame inertial;" } else { "" };
    let rigid = if rarely(rng, 4) { "rigid;" } else { "" };
    format!("stiffness {stiffness}; damping 10; tilt stiffness 1e3; tilt damping 2; {frame} {rigid}")
}

fn extras(rng: &mut Rng, index: usize, statements: &mut Vec<String>) {
    if rarely(rng, 3) {
        let from = before(rng, index);
        statements
            .push(format!("spring coil{index} ({from} -> b{index}) {{ stiffness 200; damping 1; length size; }}"));
    }
    let names = ["push".to_owned(), "t".to_owned(), format!("b{index}.kinetic_energy")];
    if rarely(rng, 2) {
        let value = scalar(rng, &names, 2);
        statements.push(match rng.u32(..10) {
            0..=3 => format!("drive act{index} on b{index}.P force = [push, 0, {value}];"),
            4..=6 => format!("drive act{index} on b{index} torque = [0, 0, {value}];"),
            7 => format!("drive act{index} on pin{index} force = {value};"),
            8 => format!("drive act{index} on pin{index} speed = {value} {{ stiffness 50; damping 1; }}"),
            _ => format!("drive act{index} on pin{index} torque = {value};"),
        });
    }
    if rarely(rng, 4) {
        let clauses = one(
            rng,
            &[
                "coulomb 2;",
                "coulomb 0.2; radius size;",
                "coulomb 1; static 2; stribeck 0.1;",
                "coulomb push; creep 0.01;",
            ],
        );
        statements.push(format!("friction seat{index} on pin{index} {{ {clauses} }}"));
    }
    if rarely(rng, 6) {
        let clauses = one(rng, &["at most size; stiffness 1e4;", "at least -1; at most 1; stiffness 50; damping 0.3;"]);
        statements.push(format!("stop end{index} on pin{index} {{ {clauses} }}"));
    }
    if rarely(rng, 4) {
        let law = scalar(rng, &["v".to_owned(), "push".to_owned()], 2);
        let axis = one(rng, &["x", "y", "z"]);
        statements.push(format!(
            "contact rub{index} (ground.wall -> b{index}.P along {axis}) {{ x: R(v) = {law}; y: C = k, R = 10; \
            z: R = 1; }}"
        ));
    }
}

fn observe(rng: &mut Rng, bodies: usize) -> String {
    let mut outputs = Vec::new();
    for _ in 0..=rng.usize(..3) {
        let index = rng.usize(..bodies);
        outputs.push(match rng.u32(..24) {
            0..=3 => format!("b{index}.angle"),
            4..=7 => format!("b{index}.position"),
            8..=11 => format!("pin{index}.force"),
            12..=15 => format!("f{index} = norm(pin{index}.force)"),
            16 => format!("b{index}.orientation"),
            17..=19 => format!("w{index}: J = integral(1 * b{index}.P.velocity.x)"),
            20 => format!("pin{index}.angle"),
            _ => format!("b{index}.Q.position"),
        });
    }
    outputs.sort_unstable();
    outputs.dedup();
    if rng.bool() {
        outputs.push("stored_energy; lost: J = integral(dissipated_power)".to_owned());
    }
    format!("observe {{ {} }}", outputs.join("; "))
}

fn scene(rng: &mut Rng, index: usize, bodies: usize) -> String {
    let mut clauses = Vec::new();
    if rng.bool() {
        clauses.push(observe(rng, bodies));
    }
    let clause = |rng: &mut Rng, once_in: u32, texts: &[&str]| {
        if rarely(rng, once_in) { one(rng, texts).to_owned() } else { String::new() }
    };
    clauses.push(clause(rng, 2, &["tune {}", "tune { k }", "tune { angle, push }"]));
    clauses.push(clause(rng, 3, &["rigid joints;", "rigid { pin0 }"]));
    clauses.push(clause(rng, 4, &["without { coil0 }", "without { act0 }", "without { pin0 }", "without { seat0 }"]));
    clauses.push(clause(rng, 4, &["angles;"]));
    clauses.push(clause(rng, 8, &["dependent b0;", "dependent { b0, b1 }"]));
    clauses.push(clause(rng, 8, &["expect planar;", "expect states = 7;"]));
    format!("scene Scene{index} {{ {} }}", clauses.join(" "))
}
