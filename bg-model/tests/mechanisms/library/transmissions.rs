//! Gears, racks, screws, worms, belts, ropes.

use std::f64::consts::PI;

use bg_model::dynamics::Dynamics;

use super::super::hand::run;
use super::{Ran, after};

/// Inertia of the first shaft, kg*m^2, and what the second side has, kg*m^2 or kg.
const FIRST: f64 = 1e-3;
const SECOND: f64 = 0.5;

/// A part between two inertias.
struct Pair {
    library: &'static str,
    ratio: &'static str,
    ports: [&'static str; 2],
    domain: &'static str,
    /// The second speed over the first.
    k: f64,
}

/// The four kinds of pairs, whose parts have this word before them.
fn pairs(form: &str) -> [(Pair, String); 4] {
    let pair = |library, part: &str, ratio, ports, domain, k| {
        (Pair { library, ratio, ports, domain, k }, format!("{form}{part}"))
    };
    [
        pair("gears", "GearPair", "ratio = 4", ["first", "second"], "rotation", -0.25),
        pair("gears", "InternalGearPair", "ratio = 5", ["first", "second"], "rotation", 0.2),
        pair("gears", "RackAndPinion", "radius = 30 mm", ["pinion", "rack"], "translation", 0.03),
        pair("screws", "Screw", "lead = 50 mm/rev", ["shaft", "nut"], "translation", 0.05 / (2.0 * PI)),
    ]
}

/// A pair whose first shaft starts at `start` rad/s, under a torque on it and a force or torque on the second side.
fn moved(t_end: f64, (pair, part): &(Pair, String), more: &str, start: f64, torque: f64, load: f64) -> Ran {
    let Pair { library, ratio, ports: [first, second], domain, k, .. } = pair;
    // Of rigid pairs one of the two momenta is a state: the one with a start.
    let second_start = if part.starts_with("Elastic") || part.starts_with("Joint") {
        format!("start {}", SECOND * k * start)
    } else {
        String::new()
    };
    after(
        t_end,
        &format!("use {library};"),
        &format!(
            "part pair: {part} {{ {ratio}; {more} }} 1 a: rotation; 1 b: {domain};
            I one = {FIRST} start {}; I two = {SECOND} {second_start}; Se motor = {torque}; Se load = {load};
            motor -> a -> one; a -> pair.{first}; pair.{second} -> b -> two; load -> b;
            observe {{ a: rad/s = a.flow; b = b.flow; all of pair }}",
            FIRST * start
        ),
    )
}

#[test]
fn rigid_pairs_have_one_state_and_move_both_inertias() {
    for pair in pairs("") {
        let k = pair.0.k;
        let ran = moved(0.5, &pair, "", 0.0, 2.0, 0.0);
        assert_eq!(ran.states, 1, "{}", pair.1);
        let acceleration = 2.0 / (FIRST + k * k * SECOND);
        ran.is("a", 0.5 * acceleration, 1e-10);
        ran.is("b", 0.5 * acceleration * k, 1e-10);
        ran.is("pair.torque", k * k * SECOND * acceleration, 1e-10);
        if pair.0.domain == "translation" {
            ran.is("pair.force", k * SECOND * acceleration, 1e-10);
        }
    }
}

#[test]
fn pairs_between_joints_are_held_by_what_is_solved_for() {
    for pair in pairs("Joint") {
        let k = pair.0.k;
        let ran = moved(0.5, &pair, "", 3.0, 2.0, 0.0);
        assert_eq!(ran.states, 2, "{}", pair.1);
        let acceleration = 2.0 / (FIRST + k * k * SECOND);
        ran.is("a", 3.0 + 0.5 * acceleration, 1e-9);
        ran.is("b", k * (3.0 + 0.5 * acceleration), 1e-9);
        ran.is("pair.torque", k * k * SECOND * acceleration, 1e-9);
    }
}

#[test]
fn losses_go_with_the_direction_of_power() {
    for pair in pairs("Lossy") {
        let k = pair.0.k;
        let losses = "efficiency = 0.8; efficiency_back = 0.6;";
        // Forward the teeth get 0.8 of the first shaft's torque.
        let ran = moved(0.1, &pair, losses, 100.0, 2.0, 0.0);
        assert_eq!(ran.states, 1, "{}", pair.1);
        let acceleration = 2.0 / (FIRST + k * k * SECOND / 0.8);
        ran.is("a", 100.0 + 0.1 * acceleration, 1e-9);
        ran.is("pair.torque", k * k * SECOND * acceleration, 1e-9);
        ran.is("pair.lost", k * k * SECOND * acceleration * (1.0 / 0.8 - 1.0) * ran.of("a"), 1e-9);
        // Back the first shaft gets 0.6 of theirs, in either direction of motion.
        for way in [1.0, -1.0] {
            let load = way * 2.0 * k.signum();
            let ran = moved(0.1, &pair, losses, way * 100.0, 0.0, load);
            ran.is("a", way * 100.0 + 0.1 * load * k / (k * k * SECOND + FIRST / 0.6), 1e-9);
        }
    }
}

#[test]
fn elastic_teeth_swing_at_their_frequency() {
    for pair in pairs("Elastic") {
        let across = pair.0.k.powi(2) * SECOND;
        let more = "stiffness = 1000 N*m/rad; damping = 0; efficiency = 1; efficiency_back = 1;";
        // The second side starts at rest.
        let Pair { library, ratio, ports: [first, second], domain, .. } = &pair.0;
        let ran = after(
            0.05,
            &format!("use {library};"),
            &format!(
                "part pair: {} {{ {ratio}; {more} }} 1 a: rotation; 1 b: {domain}; I one = {FIRST} start 0.004;
                I two = {SECOND};
                a -> one; a -> pair.{first}; pair.{second} -> b -> two; observe {{ a: rad/s = a.flow; all of pair }}",
                pair.1
            ),
        );
        assert_eq!(ran.states, 3, "{}", pair.1);
        let w: f64 = (1000.0 * (1.0 / FIRST + 1.0 / across)).sqrt();
        let share = across / (FIRST + across);
        ran.is("pair.twist", 4.0 / w * (w * 0.05).sin(), 1e-9);
        ran.is("pair.torque", 1000.0 * 4.0 / w * (w * 0.05).sin(), 1e-8);
        ran.is("a", 4.0 * (1.0 - share + share * (w * 0.05).cos()), 1e-8);
    }
}

#[test]
fn backlash_is_free_and_both_flanks_bounce() {
    let pair = &pairs("Elastic")[0];
    let more = "stiffness = 1000 N*m/rad; damping = 0; efficiency = 1; efficiency_back = 1; backlash = 0.02 rad;";
    let twist = |t: f64| {
        let ran = after(
            t,
            "use gears;",
            &format!(
                "part pair: {} {{ ratio = 4; {more} }} 1 a: rotation; 1 b: rotation; I one = {FIRST} start 0.004;
                I two = {SECOND};
                a -> one; a -> pair.first; pair.second -> b -> two; observe {{ all of pair }}",
                pair.1
            ),
        );
        ran.of("pair.twist")
    };
    let w: f64 = (1000.0_f64 * (1.0 / FIRST + 16.0 / SECOND)).sqrt();
    let (free, touching) = (0.01 / 4.0, PI / w);
    assert!((twist(0.5 * free) - 0.005).abs() < 1e-10);
    assert!((twist(free + 0.3 * touching) - 0.01 - 4.0 / w * (0.3 * PI).sin()).abs() < 1e-9);
    // Back through the play, and into the other flank.
    let other = free + touching + 2.0 * free;
    assert!((twist(other - free) - 0.0).abs() < 1e-9);
    assert!((twist(other + 0.4 * touching) + 0.01 + 4.0 / w * (0.4 * PI).sin()).abs() < 1e-9);
}

/// An elastic pair of gears in motion, without sticking: angles are left out. Speeds a, b / k and the twist q.
struct Losing {
    torque: f64,
    load: f64,
    efficiency: f64,
    stiffness: f64,
    damping: f64,
}

impl Dynamics for Losing {
    fn states(&self) -> usize {
        3
    }

    fn switches(&self) -> usize {
        0
    }

    fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        let teeth = self.stiffness * x[2] + self.damping * (x[0] - x[1]);
        dx[0] = (self.torque - teeth / self.efficiency) / FIRST;
        dx[1] = (teeth - self.load) / (SECOND / 16.0);
        dx[2] = x[0] - x[1];
    }
}

#[test]
fn elastic_teeth_lose_as_equations_of_their_own() {
    let pair = &pairs("Elastic")[0];
    let hand = Losing { torque: 3.0, load: 2.0, efficiency: 0.9, stiffness: 1000.0, damping: 2.0 };
    let more = "stiffness = 1000 N*m/rad; damping = 2; efficiency = 0.9; efficiency_back = 0.5;";
    // 2 N*m about the first shaft are 8 N*m about the second one, which turns against it.
    let ran = moved(0.2, pair, more, 50.0, 3.0, 8.0);
    let x = run(&hand, &[50.0, 50.0, 0.0], 0.2).x;
    ran.is("a", x[0], 1e-8);
    ran.is("b", -0.25 * x[1], 1e-8);
    ran.is("pair.twist", x[2], 1e-8);
}

#[test]
fn at_rest_it_sticks_within_its_efficiencies() {
    let pair = &pairs("Elastic")[0];
    let more = "stiffness = 1000 N*m/rad; damping = 2; efficiency = 0.8; efficiency_back = 0.6;";
    // A load that is 2 N*m about the first shaft, which comes on slowly together with the motor's torque.
    let tried = |torque: f64| {
        let ran = after(
            3.0,
            "use gears;",
            &format!(
                "part pair: {} {{ ratio = 4; {more} }} 1 a: rotation; 1 b: rotation; I one = {FIRST}; I two = {SECOND};
                Se motor = {torque} * if t < 1 {{ t / (1 s) }} else {{ 1 }};
                Se load = 8 * if t < 1 {{ t / (1 s) }} else {{ 1 }};
                motor -> a -> one; a -> pair.first; pair.second -> b -> two; load -> b;
                observe {{ a: rad/s = a.flow; all of pair }}",
                pair.1
            ),
        );
        (ran.of("a"), ran.of("pair.torque"))
    };
    for torque in [1.21, 2.0, 2.49] {
        let (speed, teeth) = tried(torque);
        assert!(speed.abs() < 1e-9 && (teeth - 2.0).abs() < 1e-6, "{torque}: {speed} {teeth}");
    }
    assert!(tried(1.19).0 < -0.1 && tried(2.51).0 > 0.1);
}

#[test]
fn a_worm_has_the_efficiency_of_its_lead_angle() {
    let worm = |part: &str, angle: f64, friction: f64, more: &str, statements: &str| {
        after(
            0.2,
            "use screws;",
            &format!(
                "part worm: {part} {{ ratio = 30; lead_angle = {angle} deg; friction = {friction}; {more} }}
                1 a: rotation; 1 b: rotation; I one = 1e-3 start 0.1; I two = 2; a -> one; a -> worm.worm;
                worm.wheel -> b {statements};
                observe {{ a: rad/s = a.flow; all of worm }}"
            ),
        )
    };
    let (angle, rough) = (10.0_f64.to_radians(), (0.05 / 20.0_f64.to_radians().cos()).atan());
    let (drives, driven) = (angle.tan() / (angle + rough).tan(), (angle - rough).tan() / angle.tan());
    let ran = worm("Worm", 10.0, 0.05, "", "-> two; Se motor = 1; motor -> a");
    ran.is("worm.efficiency", drives, 1e-12);
    ran.is("worm.efficiency_back", driven, 1e-12);
    ran.is("a", 100.0 + 0.2 / (1e-3 + 2.0 / 900.0 / drives), 1e-9);
    let ran = worm("Worm", 10.0, 0.05, "", "-> two; Se load = 60; load -> b");
    ran.is("a", 100.0 + 0.2 * (60.0 / 30.0) / (2.0 / 900.0 + 1e-3 / driven), 1e-9);
    assert!(worm("Worm", 4.0, 0.08, "", "-> two; Se load = 60; load -> b").of("worm.efficiency_back") < 0.0);
}

#[test]
fn a_worm_locks_itself_and_the_wheel_swings_on_its_teeth() {
    let ran = after(
        0.13,
        "use screws;",
        "part worm: ElasticWorm { ratio = 30; lead_angle = 4 deg; friction = 0.08; stiffness = 50 N*m/rad;
        damping = 0; }
        1 a: rotation; 1 b: rotation; I one = 1e-3; I two = 2; Se load = 60;
        a -> one; a -> worm.worm; worm.wheel -> b -> two; load -> b;
        observe { a: rad/s = a.flow; twist: rad = worm.twist }",
    );
    // About the worm the load is 2 N*m, the wheel 2 / 900 kg*m^2.
    let w = (50.0_f64 * 900.0 / 2.0).sqrt();
    ran.is("twist", -2.0 / 50.0 * (1.0 - (w * 0.13).cos()), 1e-9);
    ran.is("a", 0.0, 1e-9);
}

/// Two pulleys of 40 and 80 mm, the first of which starts at 100 rad/s.
fn belt(t_end: f64, part: &str, more: &str) -> Ran {
    after(
        t_end,
        "use belts;",
        &format!(
            "part belt: {part} {{ stiffness = 1e5 N/m; {more} }} 1 a: rotation; 1 b: rotation;
            I one = 1e-3 start 0.1; I two = 0.02;
            a -> one; a -> belt.first; belt.second -> b -> two; observe {{ all of belt }}"
        ),
    )
}

#[test]
fn a_chain_swings_by_both_strands_and_by_one_where_the_other_is_loose() {
    let compliance = 0.04_f64.powi(2) / 1e-3 + 0.08_f64.powi(2) / 0.02;
    let (both, one): (f64, f64) = ((2e5 * compliance).sqrt(), (1e5 * compliance).sqrt());
    let (tension, speed) = (300.0, 4.0);
    let more = "damping = 0; tension = 300;";
    let ran = belt(4e-4, "ChainDrive", more);
    let stretch = speed / both * (both * 4e-4).sin();
    ran.is("belt.stretch", 1e3 * stretch, 1e-9);
    ran.is("belt.tight", tension + 1e5 * stretch, 1e-9);
    ran.is("belt.slack", tension - 1e5 * stretch, 1e-9);
    // A strand is loose where the stretch is 3 mm.
    let loose = (tension / 1e5 * both / speed).asin() / both;
    let left = speed * (both * loose).cos();
    let later = 0.002;
    let along = one * (later - loose);
    let stretch = -tension / 1e5 + 2.0 * tension / 1e5 * along.cos() + left / one * along.sin();
    assert!(later > loose && stretch > tension / 1e5, "{loose} {stretch}");
    let ran = belt(later, "ChainDrive", more);
    ran.is("belt.stretch", 1e3 * stretch, 1e-9);
    ran.is("belt.tight", tension + 1e5 * stretch, 1e-9);
    ran.is("belt.slack", 0.0, 1e-12);
}

#[test]
fn a_belt_slips_at_its_grip() {
    let ran = after(
        3.0,
        "use belts;",
        "part belt: BeltDrive { friction = 0.3; wrap = 160 deg; tension = 250 N; sliding = 20; } Sf motor = 10;
        Sf held = 0;
        1 a: rotation; 1 b: rotation; motor -> a -> belt.first; belt.second -> b; held -> b; observe { all of belt }",
    );
    ran.is("belt.slip", 0.4, 1e-9);
    let grip = ran.of("belt.pull") - 20.0 * 0.4;
    ran.is("belt.reserve", -8.0, 1e-9);
    // Euler and Eytelwein.
    let ratio = (250.0 + grip / 2.0) / (250.0 - grip / 2.0);
    assert!((ratio - (0.3 * 160.0_f64.to_radians()).exp()).abs() < 1e-9, "{ratio}");
    // Below the grip it does not slip, and is a chain.
    let more = "damping = 0; tension = 300;";
    let (belts, chain) = (belt(2e-4, "BeltDrive", more), belt(2e-4, "ChainDrive", more));
    assert!(belts.of("belt.slip") == 0.0 && belts.of("belt.stretch") == chain.of("belt.stretch"));
}

#[test]
fn a_fast_belt_lifts_off_its_pulleys() {
    let ran = |speed: f64| {
        after(
            3.0,
            "use belts;",
            &format!(
                "part belt: FastBeltDrive {{ friction = 0.3; wrap = 160 deg; tension = 250 N; sliding = 20; \
                mass = 0.2 kg/m; }}
                Sf motor = {speed:?}; Sf held = 0;
                1 a: rotation; 1 b: rotation; motor -> a -> belt.first; belt.second -> b; held -> b; \
                observe {{ all of belt }}"
            ),
        )
    };
    let slips = ran(500.0);
    slips.is("belt.centrifugal", 0.2 * 20.0 * 20.0, 1e-9);
    slips.is("belt.slip", 20.0, 1e-9);
    // Euler and Eytelwein, for what is left of the strands' tensions.
    let (grip, pressing) = (slips.of("belt.pull") - 20.0 * 20.0, 250.0 - 80.0);
    let ratio = (pressing + grip / 2.0) / (pressing - grip / 2.0);
    assert!((ratio - (0.3 * 160.0_f64.to_radians()).exp()).abs() < 1e-9, "{ratio}");
    // At 36 m/s nothing presses any more.
    let lifted = ran(900.0);
    lifted.is("belt.pull", 20.0 * 36.0, 1e-9);
}

#[test]
fn a_winch_swings_its_load_and_does_not_push() {
    let winch = |t: f64, drum: f64| {
        after(
            t,
            "use belts;",
            &format!(
                "part winch: Winch {{ radius = 150 mm; falls = 2; stiffness = 1e5 N/m; damping = 0; }}
                1 shaft: rotation; 1 hook: translation;
                Sf motor = {drum}; I mass = 100; Se weight = -981 N; motor -> shaft -> winch.drum;
                winch.load -> hook -> mass; weight -> hook;
                observe {{ speed: m/s = hook.flow; pull: N = winch.rope.pull; stretch: mm = winch.rope.stretch }}"
            ),
        )
    };
    // On two falls: half the weight each, four times the stiffness.
    let w = (4e5_f64 / 100.0).sqrt();
    let ran = winch(0.17, 0.0);
    ran.is("pull", 981.0 / 2.0 * (1.0 - (w * 0.17).cos()), 1e-9);
    ran.is("speed", -981.0 / 4.0 / 1e5 * w * (w * 0.17).sin(), 1e-9);
    // Off a drum that is faster it falls.
    let ran = winch(0.5, -100.0);
    ran.is("pull", 0.0, 1e-12);
    ran.is("speed", -9.81 * 0.5, 1e-12);
}
