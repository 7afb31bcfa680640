//! Planetary sets, and gears on bodies.

use std::f64::consts::PI;

use bg_model::nalgebra::{Matrix2, Vector2};

use super::{after, of_text};

/// A sun of 1e-3, a ring of 0.02 and a carrier of 0.05 kg*m^2.
fn set(t_end: f64, part: &str, more: &str, statements: &str) -> super::Ran {
    after(
        t_end,
        "use gears;",
        &format!(
            "part set: {part} {{ ratio = 3; {more} }} 1 sun: rotation; 1 ring: rotation; 1 carrier: rotation;
            sun -> set.sun; ring -> set.ring; set.carrier -> carrier; {statements}
            observe {{ sun: rad/s = sun.flow; ring: rad/s = ring.flow; carrier: rad/s = carrier.flow; all of set }}"
        ),
    )
}

const INERTIAS: &str = "I one = 1e-3; I two = 0.02; I three = 0.05; sun -> one; ring -> two; carrier -> three;";

#[test]
fn two_shafts_are_free_and_move_by_willis() {
    // Lagrange's equations in the speeds of sun and ring: the carrier has a quarter and three quarters of them.
    let ran = set(
        0.4,
        "PlanetarySet",
        "",
        &format!("Se motor = 0.7; motor -> sun; Se brake = -0.2; brake -> ring; {INERTIAS}"),
    );
    assert_eq!(ran.states, 2);
    let inertia = Matrix2::new(1e-3 + 0.05 / 16.0, 0.05 * 3.0 / 16.0, 0.05 * 3.0 / 16.0, 0.02 + 0.05 * 9.0 / 16.0);
    let speeds: Vector2<f64> = 0.4 * inertia.try_inverse().expect("definite") * Vector2::new(0.7, -0.2);
    ran.is("sun", speeds[0], 1e-10);
    ran.is("ring", speeds[1], 1e-10);
    ran.is("carrier", (speeds[0] + 3.0 * speeds[1]) / 4.0, 1e-10);
}

#[test]
fn each_of_three_shafts_may_be_held() {
    // Speeds by sources, torques by Willis: as 1, 3 and 4.
    let held = |driven: &str, held: &str, loaded: &str, load: f64| {
        set(
            1.0,
            "PlanetarySet",
            "",
            &format!(
                "Sf motor = 12; motor -> {driven}; Sf housing = 0; housing -> {held}; I wheel = 0.01;
                Se load = {load}; load -> {loaded};
                {loaded} -> wheel; observe {{ driving: N*m = motor.effort; holding: N*m = housing.effort }}"
            ),
        )
    };
    let ran = held("sun", "ring", "carrier", -8.0);
    ran.is("carrier", 3.0, 1e-12);
    ran.is("driving", 2.0, 1e-12);
    ran.is("holding", 6.0, 1e-12);
    let ran = held("sun", "carrier", "ring", 6.0);
    ran.is("ring", -4.0, 1e-12);
    ran.is("driving", 2.0, 1e-12);
    ran.is("holding", -8.0, 1e-12);
    let ran = held("ring", "sun", "carrier", -8.0);
    ran.is("carrier", 9.0, 1e-12);
    ran.is("driving", 6.0, 1e-12);
    ran.is("holding", 2.0, 1e-12);
}

#[test]
fn losses_are_those_with_the_carrier_held() {
    // H. W. Mueller, Epicyclic Drive Trains (1982): with a basic efficiency n the ring holds, the sun drives with
    // (1 + 3 n) / 4, and is driven with 4 / (1 + 3 / n).
    let more = "efficiency = 0.9; efficiency_back = 0.8; creep = 1e-6;";
    let ran = |statements: &str| set(1.0, "LossyPlanetarySet", more, statements);
    let forward = ran(
        "Sf motor = 12; motor -> sun; Sf housing = 0; housing -> ring; I wheel = 0.01; Se load = -8; load -> carrier;
        carrier -> wheel; observe { driving: N*m = motor.effort }",
    );
    forward.is("driving", 2.0 / ((1.0 + 3.0 * 0.9) / 4.0), 1e-10);
    let back = ran(
        "Sf motor = 3; motor -> carrier; Sf housing = 0; housing -> ring; I wheel = 0.01; Se load = -2; load -> sun;
        sun -> wheel; observe { driving: N*m = motor.effort }",
    );
    back.is("driving", 8.0 / (4.0 / (1.0 + 3.0 / 0.8)), 1e-10);
}

#[test]
fn an_elastic_set_swings_between_three_inertias() {
    let more = "stiffness = 2000 N*m/rad; damping = 0; efficiency = 1; efficiency_back = 1;";
    let inertias = INERTIAS.replace("1e-3;", "1e-3 start 0.005;");
    let ran = set(0.011, "ElasticPlanetarySet", more, &inertias);
    assert_eq!(ran.states, 4);
    let w: f64 = (2000.0_f64 * (1.0 / 1e-3 + 9.0 / 0.02 + 16.0 / 0.05)).sqrt();
    ran.is("set.twist", 5.0 / w * (w * 0.011).sin(), 1e-9);
}

#[test]
fn a_gearbox_has_its_ratio_and_its_efficiency() {
    let ran = after(
        0.3,
        "use drives;",
        "part gearbox: PlanetaryGearbox { ratio = 5; efficiency = 0.9; inertia = 2e-3; } 1 a: rotation;
        1 b: rotation; Se motor = 1; I load = 0.5;
        I rotor = 1e-3 start 0.1; motor -> a -> rotor; a -> gearbox.fast; gearbox.slow -> b -> load;
        observe { a: rad/s = a.flow; b: rad/s = b.flow; all of gearbox }",
    );
    assert_eq!(ran.states, 1);
    let efficiency = (1.0 + 4.0 * 0.9) / 5.0;
    let acceleration = 1.0 / (3e-3 + 0.5 / 25.0 / efficiency);
    ran.is("a", 100.0 + 0.3 * acceleration, 1e-9);
    ran.is("b", ran.of("a") / 5.0, 1e-12);
    // The housing takes what the slow shaft gives more than the fast one has.
    let fast = 1.0 - 3e-3 * acceleration;
    ran.is("gearbox.held", 0.5 * acceleration / 5.0 - fast, 1e-8);
}

#[test]
fn gears_on_bodies_turn_in_their_carrier() {
    let ran = after(
        1.0,
        "use gears;",
        "ground { point O = [0, 0, 0]; }
            body carrier { mass 2; inertia [0.02, 0.02, 0.02]; point hole = [0.1, 0, 0]; start at [0, 0, 0];
            start spin [0, 0, 1]; }
            body planet { mass 0.5; inertia [1e-4, 1e-4, 2e-4]; start at [0.1, 0, 0]; start velocity [0, 0.1, 0];
            start spin [0, 0, guess(0)]; }
            body sun { mass 1; inertia [1e-3, 1e-3, 1e-3]; start at [0, 0, 0]; start spin [0, 0, 5]; }
            joint main: revolute z (ground.O -> carrier) { rigid; }
            joint sun_pin: revolute z (carrier -> sun) { rigid; }
            joint planet_pin: revolute z (carrier.hole -> planet) { rigid; }
            part pair: JointGearPair { ratio = 2; } sun_pin.spin -> pair.first; pair.second -> planet_pin.spin;
            drive motor on main torque = 0.1;
            observe { sun: rad/s = sun.angular_velocity.z; carrier: rad/s = carrier.angular_velocity.z;
            planet: rad/s = planet.angular_velocity.z }
            scenes only; scene Planar { expect planar; }",
    );
    // Against the carrier the planet turns half as fast as the sun, the other way.
    let [of_carrier, of_sun] = [1.5, -0.5];
    let inertia = Matrix2::new(
        0.02 + 0.5 * 0.01 + 2e-4 * of_carrier * of_carrier,
        2e-4 * of_carrier * of_sun,
        2e-4 * of_carrier * of_sun,
        1e-3 + 2e-4 * of_sun * of_sun,
    );
    let speeds: Vector2<f64> =
        Vector2::new(1.0, 5.0) + inertia.try_inverse().expect("definite") * Vector2::new(0.1, 0.0);
    ran.is("carrier", speeds[0], 1e-9);
    ran.is("sun", speeds[1], 1e-9);
    ran.is("planet", of_carrier * speeds[0] + of_sun * speeds[1], 1e-9);
}

#[test]
fn teeth_between_bodies_load_their_pins() {
    let ran = after(
        1.0,
        "use gears;",
        "ground { point O = [0, 0, 0]; }
        body carrier { mass 2; inertia [0.02, 0.02, 0.02]; point hole = [0.05, 0, 0]; start at [0, 0, 0];
        start spin [0, 0, 1]; }
        body planet { mass 0.5; inertia [1e-4, 1e-4, 2e-4]; start at [0.05, 0, 0]; start velocity [0, 0.05, 0];
        start spin [0, 0, guess(0)]; }
        body sun { mass 1; inertia [1e-3, 1e-3, 1e-3]; start at [0, 0, 0]; start spin [0, 0, guess(5)]; }
        body ring { mass 1; inertia [5e-3, 5e-3, 5e-3]; start at [0, 0, 0]; start spin [0, 0, 5]; }
        joint main: revolute z (ground.O -> carrier) { rigid; } joint sun_pin: revolute z (ground.O -> sun) { rigid; }
        joint ring_pin: revolute z (ground.O -> ring) { rigid; }
        joint pin: revolute z (carrier.hole -> planet) { rigid; }
        part inner: BodyGearPair { first_radius = 30 mm; second_radius = 20 mm;
            away_x = planet.position.x - sun.position.x; away_y = planet.position.y - sun.position.y; }
        part outer: BodyInternalGearPair { first_radius = 20 mm; second_radius = 70 mm;
            away_x = ring.position.x - planet.position.x; away_y = ring.position.y - planet.position.y; }
        sun.translation -> inner.first; sun.rotation -> inner.first_turn; planet.translation -> inner.second;
        planet.rotation -> inner.second_turn;
        planet.translation -> outer.first; planet.rotation -> outer.first_turn; ring.translation -> outer.second;
        ring.rotation -> outer.second_turn;
        drive motor on sun_pin torque = 0.1;
        observe { sun: rad/s = sun.angular_velocity.z; carrier: rad/s = carrier.angular_velocity.z;
        ring: rad/s = ring.angular_velocity.z;
            planet: rad/s = planet.angular_velocity.z; all of inner; all of outer;
            along: N = dot(carrier.x_axis, pin.force);
            across: N = dot(carrier.y_axis, pin.force); on_sun: N = norm(sun_pin.force) }
        scenes only; scene Planar { expect planar; }",
    );
    // Lagrange's equations in the speeds of carrier and ring.
    let ratio = 70.0 / 30.0;
    let sun: Vector2<f64> = Vector2::new(1.0 + ratio, -ratio);
    let planet: Vector2<f64> = Vector2::new(1.0, 0.0) - 1.5 * (sun - Vector2::new(1.0, 0.0));
    let inertia = Matrix2::new(0.02 + 0.5 * 0.05 * 0.05, 0.0, 0.0, 5e-3)
        + 1e-3 * sun * sun.transpose()
        + 2e-4 * planet * planet.transpose();
    let gains: Vector2<f64> = inertia.try_inverse().expect("definite") * sun * 0.1;
    let speeds = Vector2::new(1.0, 5.0) + gains;
    ran.is("carrier", speeds[0], 1e-9);
    ran.is("ring", speeds[1], 1e-9);
    ran.is("sun", sun.dot(&speeds), 1e-9);
    ran.is("planet", planet.dot(&speeds), 1e-9);
    // What sun and ring do not keep of their torques goes through the teeth, and both forces through the planet's pin.
    let inner = (0.1 - 1e-3 * sun.dot(&gains)) / 0.03;
    let outer = -5e-3 * gains[1] / 0.07;
    ran.is("inner.force", inner, 1e-9);
    ran.is("outer.force", outer, 1e-9);
    ran.is("on_sun", inner, 1e-9);
    ran.is("across", 0.5 * 0.05 * gains[0] - inner - outer, 1e-9);
    ran.is("along", -0.5 * 0.05 * speeds[0].powi(2), 1e-9);
}

#[test]
fn the_planetary_set_of_the_examples_has_one_freedom() {
    const TEXT: &str = include_str!("../../../bond/examples/planetary.bond");
    let ran = of_text(0.1, TEXT);
    // About the sun's speed w: the carrier has 0.3 of it, the planets -0.75.
    let gear = |radius: f64| {
        let disc = 7850.0 * PI * radius.powi(2) * 0.01;
        let mark = 7850.0 * 1.6 * radius * 0.006 * 0.014;
        (disc + mark, disc * radius.powi(2) / 2.0 + mark * ((1.6 * radius).powi(2) + 0.006_f64.powi(2)) / 12.0)
    };
    let ((_, sun), (mass, planet)) = (gear(0.03), gear(0.02));
    let inertia = sun + 0.3_f64.powi(2) * (4e-4 + 3.0 * mass * 0.05_f64.powi(2)) + 0.75_f64.powi(2) * 3.0 * planet;
    // The torque is between carrier and sun; the brake takes 0.05 N*m*s/rad of the carrier.
    let (last, decay) = (0.7 * 0.05 / (0.05 * 0.09), 0.05 * 0.09 / inertia);
    let w = last + (3.0 * PI - last) * (-decay * 0.1_f64).exp();
    ran.is("sun", w * 30.0 / PI, 1e-9);
    ran.is("carrier", 0.3 * w * 30.0 / PI, 1e-9);
    ran.is("planet", -0.75 * w * 30.0 / PI, 1e-9);
}

#[test]
fn a_pinion_on_a_body_drives_a_rack_on_another() {
    for (library, part, ratio, ports, k) in [
        ("gears", "JointRackAndPinion", "radius = 30 mm", ["pinion", "rack"], 0.03),
        ("screws", "JointScrew", "lead = 50 mm/rev", ["shaft", "nut"], 0.05 / (2.0 * PI)),
    ] {
        let [first, second] = ports;
        let ran = after(
            0.5,
            &format!("use {library};"),
            &format!(
                "ground {{ point O = [0, 0, 0]; }} body wheel {{ mass 1; inertia [1e-3, 1e-3, 1e-3]; }}
                body bar {{ mass 2; inertia [1e-3, 1e-3, 1e-3]; }}
                joint pin: revolute z (ground.O -> wheel) {{ rigid; }}
                joint guide: prismatic x (ground.O -> bar) {{ rigid; }}
                part pair: {part} {{ {ratio}; }} pin.spin -> pair.{first}; pair.{second} -> guide.slide;
                drive motor on pin torque = 0.3;
                observe {{ speed: m/s = bar.velocity.x; force: N = pair.force }} scenes only;
                scene Planar {{ expect planar; }}"
            ),
        );
        let acceleration = 0.3 / (1e-3 + 2.0 * k * k);
        ran.is("speed", 0.5 * k * acceleration, 1e-9);
        ran.is("force", 2.0 * k * acceleration, 1e-9);
    }
}

#[test]
fn involute_teeth_push_their_gears_apart() {
    let ran = |torque: f64, angle: f64| {
        after(
            1.0,
            "use gears;",
            &format!(
                "ground {{ point O = [0, 0, 0]; point P = [0.072, 0.096, 0]; }}
                body pinion {{ mass 1; inertia [1e-3, 1e-3, 1e-3]; }}
                body wheel {{ mass 5; inertia [0.04, 0.04, 0.04]; start at [0.072, 0.096, 0]; }}
                joint first: revolute z (ground.O -> pinion) {{ rigid; }} joint second: revolute z (ground.P -> wheel) \
                {{ rigid; }}
                part pair: BodyInvolutePair {{ first_radius = 30 mm; second_radius = 90 mm; \
                pressure_angle = {angle:?} deg;
                    away_x = wheel.position.x - pinion.position.x; away_y = wheel.position.y - pinion.position.y; }}
                pinion.translation -> pair.first; pinion.rotation -> pair.first_turn; wheel.translation -> pair.second;
                wheel.rotation -> pair.second_turn;
                drive motor on first torque = {torque:?};
                let apart: 1 = [0.6, 0.8, 0]; let across: 1 = [-0.8, 0.6, 0];
                observe {{ pinion: rad/s = first.speed; wheel: rad/s = second.speed; all of pair;
                    first_apart: N = dot(apart, first.force); second_apart: N = dot(apart, second.force);
                    second_across: N = dot(across, second.force) }}
                scenes only; scene Planar {{ expect planar; }}"
            ),
        )
    };
    for (torque, angle) in [(2.0, 20.0_f64), (-2.0, -25.0), (2.0, 0.0)] {
        let ran = ran(torque, angle);
        let acceleration = torque / (1e-3 + 0.04 / 9.0);
        ran.is("pinion", acceleration, 1e-9);
        ran.is("wheel", -acceleration / 3.0, 1e-9);
        // The wheel gets its torque at 90 mm; across, the teeth push it, apart by the tangent of the angle.
        let across = 0.04 * acceleration / 3.0 / 0.09;
        ran.is("second_across", -across, 1e-9);
        ran.is("pair.force", across / angle.to_radians().cos(), 1e-9);
        let apart = across.abs() * angle.to_radians().tan().abs();
        ran.is("second_apart", -apart, 1e-9);
        ran.is("first_apart", apart, 1e-9);
    }
}
