//! Motors, clutch, brake, flywheel, cylinder and valve, controllers.

use std::f64::consts::PI;

use bg_model::dynamics::Dynamics;
use bg_model::nalgebra::{Matrix2, Vector2};

use super::super::hand::run;
use super::{after, refused};

/// What x' = a x makes of a start.
fn linear(a: Matrix2<f64>, start: Vector2<f64>, t: f64) -> Vector2<f64> {
    (a * t).exp() * start
}

#[test]
fn a_motor_of_direct_current_has_what_its_plate_says() {
    let ran = after(
        3.0,
        "use motors;",
        "part motor: DcMotor; Se battery = 24 V; battery -> motor.supply; 1 shaft: rotation; motor.shaft -> shaft;
        Se load = -0.35; load -> shaft; observe { all of motor }",
    );
    ran.is("motor.speed", 3000.0, 1e-9);
    ran.is("motor.current", 6.0, 1e-9);
    ran.is("motor.load", 100.0, 1e-9);
    ran.is("motor.heat", 18.0, 1e-9);
}

#[test]
fn it_runs_up_as_its_two_equations() {
    let t = 0.02;
    let ran = after(
        t,
        "use motors;",
        "part motor: DcMotor; Se battery = 24 V; battery -> motor.supply; 1 shaft: rotation; motor.shaft -> shaft;
        I wheel = 2e-4; shaft -> wheel; observe { all of motor }",
    );
    let (r, l, inertia): (f64, f64, f64) = (0.5, 1e-3, 3e-4);
    let k = (24.0 - r * 6.0) / (100.0 * PI);
    // The current that the friction needs; until then it stands.
    let idle = (6.0 * k - 0.35) / k;
    let wait = -l / r * (1.0 - idle * r / 24.0).ln();
    let speed = (24.0 - r * idle) / k;
    let a = Matrix2::new(-r / l, -k / l, k / inertia, 0.0);
    let x = linear(a, Vector2::new(0.0, -speed), t - wait) + Vector2::new(idle, speed);
    ran.is("motor.current", x[0], 1e-9);
    ran.is("motor.speed", x[1] * 30.0 / PI, 1e-9);
    ran.is("motor.torque", k * x[0], 1e-9);
}

#[test]
fn an_induction_motor_runs_up_by_kloss() {
    let part = "part motor: InductionMotor { synchronous_speed = 1500 rpm; rated_speed = 1425 rpm;
    rated_power = 1.5 kW; breakdown = 2.6; inertia = 0.01; }
        1 shaft: rotation; motor.shaft -> shaft; I wheel = 0.05; shaft -> wheel; observe { all of motor }";
    let field = 50.0 * PI;
    let rated = 1500.0 / (1425.0 * PI / 30.0);
    let slip = 0.05 * (2.6 + (2.6_f64 * 2.6 - 1.0).sqrt());
    // Until the slip is s.
    let time = |s: f64| 0.06 * field / (2.0 * 2.6 * rated) * ((1.0 - s * s) / (2.0 * slip) + slip * (1.0 / s).ln());
    for s in [0.7, 0.2, 0.03] {
        let ran = after(time(s), "use motors;", part);
        ran.is("motor.slip", 100.0 * s, 1e-9);
        ran.is("motor.torque", 2.0 * 2.6 * rated / (s / slip + slip / s), 1e-9);
    }
    let loaded = after(4.0, "use motors;", &format!("{part} Se load = -{rated}; load -> shaft;"));
    loaded.is("motor.speed", 1425.0, 1e-9);
    loaded.is("motor.load", 100.0, 1e-9);
    // At 70 % of the voltage half the torque.
    let weak = after(1e-9, "use motors;", &part.replace("inertia", "voltage = 70 percent; inertia"));
    weak.is("motor.torque", 0.49 * 2.0 * 2.6 * rated / (1.0 / slip + slip), 1e-9);
}

#[test]
fn plates_that_contradict_themselves_are_refused() {
    let shaft = "1 shaft: rotation; motor.shaft -> shaft; I wheel = 0.05; shaft -> wheel; observe { all of motor }";
    let said = |uses: &str, statements: &str, words: &[&str]| {
        let found = refused(uses, statements);
        words.iter().for_each(|word| assert!(found.contains(word), "{word}: {found}"));
    };
    let more_than_it_has = "part motor: DcMotor { rated_torque = 0.5; } Se battery = 24 V; battery -> motor.supply;";
    said(
        "use motors;",
        &format!("{more_than_it_has} {shaft}"),
        &["`friction` of part `plate: PlateFriction`", "negative"],
    );
    let faster_than_its_field = "part motor: InductionMotor { rated_speed = 1600 rpm; }";
    said("use motors;", &format!("{faster_than_its_field} {shaft}"), &["`slip` of part `plate: PlateSlip`"]);
    let rod = "part cylinder: HydraulicCylinder { bore = 50 mm; rod = 60 mm; } 1 end: translation; I load = 10;
    cylinder.end -> end -> load;
        0 a: hydraulic; 0 b: hydraulic; Sf shut_a = 0; Sf shut_b = 0; shut_a -> a -> cylinder.cap;
        shut_b -> b -> cylinder.annulus;
        observe { all of cylinder }";
    said("use hydraulics;", rod, &["`area` of part `beside_rod: RingArea`"]);
}

#[test]
fn a_clutch_slips_until_both_turn_alike_and_then_sticks() {
    let ran = |t: f64| {
        after(
            t,
            "use drives;",
            "part clutch: Clutch { closing = if t < 0.1 { 0 } else { 0.8 }; torque = 50; sticking = 1.2; }
            1 a: rotation; 1 b: rotation;
            I one = 0.2 start 20; I two = 0.3; a -> one; a -> clutch.first; clutch.second -> b -> two;
            Se load = -3; load -> b;
            observe { a: rad/s = a.flow; b: rad/s = b.flow; all of clutch; heat: J = integral(clutch.heat) }",
        )
    };
    // It is open for 0.1 s; then 40 N*m drive, and the load brakes the second shaft all the time.
    let slip = |t: f64| 100.0 - 200.0 * (t - 0.1) - (-1.0 + 37.0 / 0.3 * (t - 0.1));
    let end = 0.1 + 101.0 / (200.0 + 37.0 / 0.3);
    let early = ran(0.3);
    early.is("clutch.slip", slip(0.3) * 30.0 / PI, 1e-9);
    early.is("clutch.torque", 40.0, 1e-9);
    let late = ran(1.0);
    let alike = 100.0 - 200.0 * (end - 0.1);
    late.is("a", alike - 3.0 / 0.5 * (1.0 - end), 1e-9);
    late.is("b", late.of("a"), 1e-9);
    late.is("clutch.torque", 3.0 * 0.2 / 0.5, 1e-9);
    // The mean slip is half of the first one.
    late.is("heat", 40.0 * 101.0 / 2.0 * (end - 0.1), 1e-9);
}

#[test]
fn a_brake_stops_and_holds() {
    let ran = |t: f64, load: f64| {
        after(
            t,
            "use drives;",
            &format!(
                "part brake: Brake {{ closing = 0.5; torque = 40; sticking = 1.1; }} 1 a: rotation;
                I one = 0.2 start 10; a -> one; a -> brake.shaft;
                Se load = {load}; load -> a; observe {{ a: rad/s = a.flow; all of brake;
                heat: J = integral(brake.heat) }}"
            ),
        )
    };
    ran(0.3, 5.0).is("a", 50.0 - 0.3 * 75.0, 1e-9);
    let held = ran(2.0, 5.0);
    held.is("a", 0.0, 1e-9);
    held.is("brake.torque", 5.0, 1e-9);
    held.is("heat", 20.0 * 50.0 * (50.0 / 75.0) / 2.0, 1e-9);
    // More than it holds, 22 N*m.
    assert!(ran(3.0, 22.5).of("a") > 0.1 && ran(30.0, 19.5).of("a").abs() < 1e-9);
}

#[test]
fn a_flywheel_runs_down_in_air_and_bearings() {
    let part = "part wheel: Flywheel { diameter = 500 mm; thickness = 40 mm; start_speed = 3000 rpm; bearing = 1.5;
    air = 2e-4; }
        1 a: rotation; a -> wheel.shaft; observe { all of wheel; lost: J = integral(wheel.lost) }";
    let inertia = 7850.0 * PI * 0.25_f64.powi(2) * 0.04 * 0.25_f64.powi(2) / 2.0;
    let start = 100.0 * PI;
    let first = after(0.0, "use drives;", part);
    first.is("wheel.energy", inertia * start * start / 2e3, 1e-12);
    first.is("wheel.rim_speed", 0.25 * start, 1e-12);
    first.is("wheel.stress", 3.3 / 8.0 * 7850.0 * (0.25 * start).powi(2) / 1e6, 1e-12);
    // w' = -(a + b w^2) / J
    let (a, b) = (1.5_f64, 2e-4_f64);
    let angle = |t: f64| (start * (b / a).sqrt()).atan() - (a * b).sqrt() * t / inertia;
    let w = (a / b).sqrt() * angle(40.0).tan();
    let later = after(40.0, "use drives;", part);
    later.is("wheel.speed", w * 30.0 / PI, 1e-9);
    later.is("lost", inertia * (start * start - w * w) / 2.0, 1e-9);
    let stands = inertia * (start * (b / a).sqrt()).atan() / (a * b).sqrt();
    after(stands + 5.0, "use drives;", part).is("wheel.speed", 0.0, 1e-9);
}

#[test]
fn a_cylinder_swings_on_its_oil() {
    let ran = after(
        0.013,
        "use hydraulics;",
        "part cylinder: HydraulicCylinder { bore = 63 mm; rod = 36 mm; cap_volume = 0.8 l; rod_volume = 0.4 l;
        mass = 4; }
        1 end: translation; I load = 396; Se push = -2000; cylinder.end -> end -> load; push -> end;
        0 a: hydraulic; 0 b: hydraulic; Sf shut_a = 0; Sf shut_b = 0; shut_a -> a -> cylinder.cap;
        shut_b -> b -> cylinder.annulus;
        observe { all of cylinder }",
    );
    let (cap, ring) = (PI / 4.0 * 0.063_f64.powi(2), PI / 4.0 * (0.063_f64.powi(2) - 0.036_f64.powi(2)));
    let (of_cap, of_ring) = (1400e6 / 0.8e-3, 1400e6 / 0.4e-3);
    let stiffness = cap * cap * of_cap + ring * ring * of_ring;
    let w = (stiffness / 400.0).sqrt();
    let way = -2000.0 / stiffness * (1.0 - (w * 0.013).cos());
    ran.is("cylinder.way", 1e3 * way, 1e-9);
    ran.is("cylinder.speed", -1e3 * 2000.0 / stiffness * w * (w * 0.013).sin(), 1e-9);
    ran.is("cylinder.cap_pressure", -cap * way * of_cap / 1e5, 1e-9);
    ran.is("cylinder.rod_pressure", ring * way * of_ring / 1e5, 1e-9);
}

#[test]
fn a_valve_drives_it_as_fast_as_its_edges_let() {
    let ran = |opening: f64| {
        after(
            4.0,
            "use hydraulics;",
            &format!(
                "part cylinder: HydraulicCylinder {{ bore = 63 mm; rod = 36 mm; leakage = 0; }}
                part valve: FourWayValve {{ opening = {opening}; rated_flow = 40 l/min; rated_drop = 35 bar;
                laminar = 1e-3 bar; }}
                1 end: translation; I load = 100; Se push = -5000; R guide = 4000; cylinder.end -> end -> load;
                push -> end; end -> guide;
                0 p: hydraulic; 0 r: hydraulic; Se pump = 150 bar; Se tank = 2 bar; pump -> p -> valve.pump;
                valve.tank -> r; tank -> r;
                valve.a -> cylinder.cap; valve.b -> cylinder.annulus; observe {{ all of cylinder; all of valve }}"
            ),
        )
    };
    let (cap, ring) = (PI / 4.0 * 0.063_f64.powi(2), PI / 4.0 * (0.063_f64.powi(2) - 0.036_f64.powi(2)));
    let edge = 40e-3 / 60.0 / 35e5_f64.sqrt();
    // v by the balance at the piston, where each edge drops (A v / (edge u))^2; the guide makes it a quadratic one.
    let speed = |filled: f64, emptied: f64, opening: f64, push: f64| {
        let square = (filled.powi(3) + emptied.powi(3)) / (edge * opening).powi(2);
        let free = 150e5 * filled - 2e5 * emptied + push;
        (-4000.0 + (4000.0_f64.powi(2) + 4.0 * square * free).sqrt()) / (2.0 * square)
    };
    let out = ran(0.4);
    let v = speed(cap, ring, 0.4, -5000.0);
    out.is("cylinder.speed", 1e3 * v, 1e-8);
    out.is("cylinder.cap_pressure", 150.0 - (cap * v / (0.4 * edge)).powi(2) / 1e5, 1e-8);
    out.is("valve.from_pump", cap * v * 6e4, 1e-8);
    out.is("valve.to_tank", ring * v * 6e4, 1e-8);
    let back = ran(-0.25);
    let v = speed(ring, cap, 0.25, 5000.0);
    back.is("cylinder.speed", -1e3 * v, 1e-8);
    back.is("cylinder.rod_pressure", 150.0 - (ring * v / (0.25 * edge)).powi(2) / 1e5, 1e-8);
}

#[test]
fn what_seals_and_leaks_does_to_a_cylinder() {
    // Its rod is pushed with less than the seals hold.
    let ran = |push: f64, leakage: f64| {
        after(
            6.0,
            "use hydraulics;",
            &format!(
                "part cylinder: HydraulicCylinder {{ friction = 300; leakage = {leakage}; }} 1 end: translation;
                I load = 10; Se push = {push};
                cylinder.end -> end -> load; push -> end; 0 a: hydraulic; 0 b: hydraulic; Se pipe_a = 0;
                R hose = 1e9; 1 c: hydraulic;
                a -> cylinder.cap; b -> cylinder.annulus; pipe_a -> c -> a; c -> hose; Sf shut = 0; shut -> b;
                observe {{ all of cylinder }}"
            ),
        )
    };
    assert!(ran(-250.0, 0.0).of("cylinder.way").abs() < 1e-9);
    // With the annulus shut only what leaks past the piston lets it go: it moves at last as the leak fills the annulus.
    let (cap, ring) = (PI / 4.0 * 0.05_f64.powi(2), PI / 4.0 * (0.05_f64.powi(2) - 0.028_f64.powi(2)));
    let leakage = 1e-12;
    let ran = ran(-900.0, leakage);
    // The cap's oil goes through the hose but for what the annulus takes.
    ran.is("cylinder.speed", -1e3 * 600.0 / (ring * ring / leakage + (cap - ring).powi(2) * 1e9), 1e-8);
}

#[test]
fn a_speed_control_does_not_wind_up() {
    let (gain, reset, limit, tracking, inertia, wanted): (f64, f64, f64, f64, f64, f64) =
        (2.0, 0.5, 8.0, 0.1, 0.4, 30.0);
    let part = format!(
        "part control: SpeedControl {{ wanted = {wanted}; measured = shaft.flow; gain = {gain}; reset = {reset};
        limit = {limit}; tracking = {tracking}; }}
        MSe motor = control.command; 1 shaft: rotation; I wheel = {inertia}; motor -> shaft -> wheel;
        observe {{ speed: rad/s = shaft.flow; all of control }}"
    );
    // At the limit the error falls evenly, and the integral i' = gain / reset * e + (limit - gain e - i) / tracking
    // follows.
    let error = |t: f64| wanted - limit / inertia * t;
    let slope = gain / reset - gain / tracking;
    let fall = -slope * limit / inertia;
    let along = |t: f64| {
        // The particular solution b + c t, and what decays.
        let c = fall * tracking;
        let b = (limit / tracking + slope * wanted - c) * tracking;
        b + c * t - b * (-t / tracking).exp()
    };
    let early = after(0.7, "use controllers;", &part);
    early.is("speed", limit / inertia * 0.7, 1e-9);
    early.is("control.command", limit, 1e-12);
    // It leaves the limit where the wish is the limit: by bisection.
    let (mut from, mut to) = (0.3, 1.6);
    for _ in 0..200 {
        let middle = 0.5 * (from + to);
        if gain * error(middle) + along(middle) > limit { from = middle } else { to = middle }
    }
    let a = Matrix2::new(-gain / inertia, -1.0 / inertia, gain / reset, 0.0);
    let x = linear(a, Vector2::new(error(from), along(from)), 2.0 - from);
    let late = after(2.0, "use controllers;", &part);
    assert!((0.5..1.5).contains(&from), "{from}");
    late.is("speed", wanted - x[0], 1e-9);
    late.is("control.command", gain * x[0] + x[1], 1e-9);
}

/// The equations of a cascade on a motor: current, speed, angle, the integrals of the controls of speed and current.
struct Cascade {
    /// V*s/rad.
    constant: f64,
    /// N*m.
    friction: f64,
}

impl Dynamics for Cascade {
    fn states(&self) -> usize {
        5
    }

    fn switches(&self) -> usize {
        0
    }

    fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        let [current, speed, angle, of_speed, of_current] = x[..] else { panic!("five states") };
        let fastest = 2000.0 * PI / 30.0;
        let missing = (12.0 * (4.0 * PI - angle)).clamp(-fastest, fastest) - speed;
        let wish = 0.05 * missing + of_speed;
        let torque = wish.clamp(-0.5, 0.5);
        let lacking = torque / self.constant - current;
        let wanted = 2.0 * lacking + of_current;
        let voltage = wanted.clamp(-24.0, 24.0);
        let driving = self.constant * current;
        let is_stuck = speed <= 0.0 && driving <= self.friction;
        dx[0] = (voltage - 0.5 * current - self.constant * speed) / 2e-3;
        dx[1] = if is_stuck { 0.0 } else { (driving - self.friction) / 1.1e-3 };
        dx[2] = speed;
        dx[3] = 0.5 * missing + (torque - wish) / 0.05;
        dx[4] = 500.0 * lacking + (voltage - wanted) / 0.005;
    }
}

#[test]
fn a_cascade_turns_a_motor_to_an_angle() {
    let ran = |t: f64| {
        after(
            t,
            "use controllers; use motors;",
            "part motor: DcMotor { inductance = 2 mH; }
            part position: PositionControl { wanted = 2 rev; measured = shaft.displacement; limit = 2000 rpm;
            gain = 12; }
            part speed: SpeedControl { wanted = position.command; measured = shaft.flow; gain = 0.05; reset = 0.1;
            limit = 0.5; tracking = 0.05; }
            part current: CurrentControl { wanted = speed.command / motor.constant; measured = motor.armature.flow;
            gain = 2; reset = 0.004; limit = 24; }
            MSe drive = current.command; drive -> motor.supply; 1 shaft: rotation; motor.shaft -> shaft;
            I load = 1e-3; shaft -> load;
            observe { angle: rad = shaft.displacement; speed: rad/s = shaft.flow; current: A = motor.current }",
        )
    };
    let constant = (24.0 - 3.0) / (100.0 * PI);
    let hand = Cascade { constant, friction: constant * 6.0 - 0.35 };
    // At the limits of torque and voltage, and on its way to the angle.
    for t in [0.05, 0.2] {
        let x = run(&hand, &[0.0; 5], t).x;
        let found = ran(t);
        found.is("current", x[0], 1e-7);
        found.is("speed", x[1], 1e-7);
        found.is("angle", x[2], 1e-7);
    }
    // Where it is to be, within what its friction holds.
    let late = ran(4.0);
    assert!((late.of("angle") - 4.0 * PI).abs() < 0.1 && late.of("speed").abs() < 0.1, "{}", late.of("angle"));
}

/// Beside difference equations: angle and speed of a wheel under a held torque are exact from instant to instant.
#[test]
fn sampled_controllers_are_their_difference_equations() {
    let ran = after(
        0.9,
        "use controllers;",
        "part place: SampledPositionControl { wanted = 2 rad; measured = shaft.displacement; period = 4; gain = 6; \
        limit = 5 rad/s; }
        part speed: SampledSpeedControl {
            wanted = place.command; measured = shaft.flow; period = 1; gain = 3; reset = 0.1 s; limit = 4 N*m; \
            tracking = 0.05 s;
        }
        MSe motor = speed.command; 1 shaft: rotation; I wheel = 0.1; motor -> shaft -> wheel;
        observe { angle: rad = shaft.displacement; turning: rad/s = shaft.flow; all of place; all of speed }",
    );
    let (inertia, period) = (0.1, 1e-3);
    let (mut angle, mut turning, mut wanted, mut integral, mut torque): (f64, f64, f64, f64, f64) =
        (0.0, 0.0, 0.0, 0.0, 0.0);
    for k in 0..=900 {
        if k > 0 {
            angle += period * turning + 0.5 * period * period * torque / inertia;
            turning += period * torque / inertia;
        }
        if k % 4 == 0 {
            wanted = (6.0 * (2.0 - angle)).clamp(-5.0, 5.0);
        }
        let error = wanted - turning;
        let wish = 3.0 * error + integral;
        torque = wish.clamp(-4.0, 4.0);
        integral += period * (3.0 / 0.1 * error + (torque - wish) / 0.05);
    }
    ran.is("angle", angle, 1e-9);
    ran.is("turning", turning, 1e-9);
    ran.is("speed.command", torque, 1e-8);
    ran.is("place.command", wanted * 30.0 / PI, 1e-8);
}

#[test]
fn a_sampled_current_control_holds_its_voltage() {
    let ran = after(
        0.02,
        "use controllers;",
        "part control: SampledCurrentControl { wanted = 3 A; measured = coil.flow; period = 0.5; gain = 2; \
        reset = 4 ms; limit = 12 V; tracking = 2 ms; }
        MSe bridge = control.command; 1 coil: electrical; I winding = 2e-3; R copper = 1.5; bridge -> coil -> winding; \
        coil -> copper;
        observe { current: A = coil.flow; all of control }",
    );
    let (stays, period): (f64, f64) = ((-1.5 * 0.5e-3 / 2e-3_f64).exp(), 0.5e-3);
    let (mut current, mut integral, mut volt): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for k in 0..=40 {
        if k > 0 {
            current = stays * current + (1.0 - stays) / 1.5 * volt;
        }
        let error = 3.0 - current;
        let wish = 2.0 * error + integral;
        volt = wish.clamp(-12.0, 12.0);
        integral += period * (2.0 / 4e-3 * error + (volt - wish) / 2e-3);
    }
    ran.is("current", current, 1e-9);
    ran.is("control.command", volt, 1e-9);
}

/// A part of the library cannot be given another parameter: what it has is said.
#[test]
fn a_parameter_that_a_part_has_not_is_answered_by_those_that_it_has() {
    let said = refused("use gears;", "part pair: GearPair { first_teeth = 20; } 1 j: rotation; pair.first -> j;");
    assert!(said.contains("[BG0802]") && said.contains("this part of the library has: `ratio`"), "{said}");
    assert!(!said.contains("declare"), "{said}");
}
