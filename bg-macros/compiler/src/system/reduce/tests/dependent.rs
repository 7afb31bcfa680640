//! Reductions of models with storages in derivative causality and algebraic loops.

use super::scene;

/// A bob on a pin whose rotor turns three times as fast, behind a rigid gear.
fn geared(joint: &str) -> String {
    format!(
        "param mass: kg = 2; param rotor: kg*m^2 = 0.05, above 0; param n: 1 = 3; param g: m/s^2 = 9.81;
         gravity [0, -g, 0]; ground {{ point O = [0, 0, 0]; }}
         body bob {{ mass mass; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0];
             start turned rotation_z(0.7); }}
         joint pin: revolute z (ground.O -> bob.top) {{ {joint} }}
         TF gear = n; 1 motor: rotation; I wheel = rotor; pin.spin -> gear -> motor -> wheel;
         observe {{ angle: rad = pin.direction; f: N = pin.force; tooth: N*m = wheel.effort; \
         stored: J = stored_energy }}"
    )
}

#[test]
fn the_motion_in_the_plane_is_found_with_a_dependent_rotor() {
    let joint = "stiffness 1e3; damping 2; tilt stiffness 1e2; tilt damping 1;";
    let scene = scene(&geared(joint), "tune { mass, rotor } expect planar;");
    assert_eq!(scene.left().len(), 7, "{}", scene.report);
    scene.agrees();
}

/// The rotor adds n^2 times its inertia to the bob's: w' = -m g l sin(a) / (J + m l^2 + n^2 I).
#[test]
fn reactions_are_those_with_the_rotor_counted_in() {
    for (clauses, states) in [("all reactions;", 7), ("", 3)] {
        let scene = scene(&geared("rigid;"), clauses);
        assert_eq!(scene.left().len(), states, "{}", scene.report);
        let (mass, length, angle) = (2.0, 0.5, 0.7_f64);
        let moment = 0.3 + mass * length * length + 9.0 * 0.05;
        let turn = -mass * 9.81 * length * angle.sin() / moment;
        let force = [mass * length * turn * angle.cos(), mass * (9.81 + length * turn * angle.sin())];
        let (full, reduced) = scene.starts();
        for outputs in [full, reduced] {
            let expected = [angle, force[0], force[1], 0.0, 0.05 * 3.0 * turn];
            for (found, expected) in outputs.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{outputs:?} {expected}");
            }
        }
        // Truncation of other states.
        scene.agrees_to(if clauses.is_empty() { 2e-6 } else { 1e-11 });
    }
}

#[test]
fn a_loop_of_resistors_folds_with_its_parameters() {
    let graph = "param a: Ohm = 2, above 0; param b: Ohm = 3, above 0; param c: Ohm = 4, above 0; Se u = 10; \
        1 line: electrical; R ra = a;
        0 tap: electrical; R rb = b; 1 coil: electrical; R rc = c; I l = 0.5; u -> line -> ra; line -> tap -> rb; \
        tap -> coil -> l; coil -> rc;
        observe { i: A = coil.flow; v: V = tap.effort; lost: J = integral(dissipated_power) }";
    for tuned in ["tune {}", "tune { b }", ""] {
        scene(graph, tuned).agrees();
    }
}
