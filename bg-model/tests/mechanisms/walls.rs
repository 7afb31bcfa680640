//! Walls of finite length beside hand-written models: a disc at the ends and on both sides of segments and arcs and in
//! a slot, a Geneva wheel over two indexings.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use bg_model::dynamics::Dynamics;
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::simulation::{Settings, Span, drive};

use super::hand::run;
use super::shapes::after;
use super::text::{file, graphs, held, model, outputs, said};

/// The end of a run of hand-written equations, by a hundredth of the tolerances: corners multiply errors.
fn by_hand(model: &dyn Dynamics, start: &[f64], t_end: f64) -> Vec<f64> {
    let settings = Settings { tolerances: Tolerances::new(1e-13, 1e-14), ..Settings::default() };
    let span = Span { t0: 0.0, t_end };
    let finish = drive(model, &mut Dop853::new(), start, span, &settings, None, &mut ());
    finish.unwrap_or_else(|failure| panic!("{failure}")).x.as_slice().to_vec()
}

/// A vector in a plane.
type Plane = [f64; 2];

fn polar(radius: f64, angle: f64) -> Plane {
    [radius * angle.cos(), radius * angle.sin()]
}

/// From the nearest place of a segment that begins at the origin along the first axis.
fn from_segment(length: f64, place: Plane) -> Plane {
    [place[0] - place[0].clamp(0.0, length), place[1]]
}

/// From the nearest place of a part of a circle about the origin.
fn from_arc(radius: f64, from: f64, to: f64, place: Plane) -> Plane {
    let turns = |angle: f64| (angle - from).rem_euclid(TAU) + from;
    let angle = turns(place[1].atan2(place[0]));
    let away = |angle: f64| {
        let on = polar(radius, angle);
        [place[0] - on[0], place[1] - on[1]]
    };
    let ends = [away(from), away(to)];
    if angle <= to {
        away(angle)
    } else if ends[0][0].hypot(ends[0][1]) < ends[1][0].hypot(ends[1][1]) {
        ends[0]
    } else {
        ends[1]
    }
}

/// A disc of 20 mm falls on a shape of the ground, which is turned by 0.4 about a point 0.1 m from the origin.
const DISC: f64 = 0.02;
const TILT: f64 = 0.4;

/// Where the disc is nearest to a shape, in its axes: how far from it, and what is 0 where the nearest place goes from
/// a wall to its end, so that no step goes over it.
type Near = fn(Plane) -> (Plane, [f64; 2]);

/// The disc's places and velocities; the shape is around it where it is at most `far` away, or beside it.
struct Falls {
    near: Near,
    far: f64,
    is_around: bool,
}

impl Falls {
    /// Distance of the shapes, its gradient.
    fn gap(&self, x: &[f64]) -> (f64, Plane, [f64; 2]) {
        let [along, across] = [[TILT.cos(), TILT.sin()], [-TILT.sin(), TILT.cos()]];
        let place = [x[0] - 0.1, x[1]];
        let (away, seams) = (self.near)([along, across].map(|axis| axis[0] * place[0] + axis[1] * place[1]));
        let distance = away[0].hypot(away[1]).max(1e-12);
        let sign = if self.is_around { -1.0 } else { 1.0 };
        let n = [0, 1].map(|k| sign * (along[k] * away[0] + across[k] * away[1]) / distance);
        (sign * (distance - self.far), n, seams)
    }
}

impl Dynamics for Falls {
    fn states(&self) -> usize {
        4
    }

    fn switches(&self) -> usize {
        3
    }

    fn guards(&self, _: f64, x: &[f64], _: &[bool], guards: &mut [f64]) {
        let (gap, _, seams) = self.gap(x);
        guards.copy_from_slice(&[gap, seams[0], seams[1]]);
    }

    fn rate(&self, _: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let (gap, n, _) = self.gap(x);
        let rate = -(n[0] * x[2] + n[1] * x[3]);
        let force = if negative[0] { -1e5 * gap * (1.0 + 1.5 * 0.1 * rate) } else { 0.0 };
        dx.copy_from_slice(&[x[2], x[3], force * n[0] / 0.5, force * n[1] / 0.5 - 9.81]);
    }
}

fn disc(shape: &str, start: [f64; 4], is_swapped: bool) -> String {
    let [x, y, u, v] = start;
    let (wall, disc) = (format!("ground.wall {shape}"), format!("disc circle {DISC:?}"));
    let ends = if is_swapped { format!("{disc} -> {wall}") } else { format!("{wall} -> {disc}") };
    format!(
        "graph Disc {{
            gravity [0, -9.81, 0];
            ground {{ point wall = [0.1, 0, 0] turned rotation_z({TILT:?}); }}
            body disc {{ mass 0.5; inertia [1e-4, 1e-4, 1e-4]; start at [{x:?}, {y:?}, 0]; \
            start velocity [{u:?}, {v:?}, 0]; }}
            contact hit ({ends}) {{ stiffness 1e5; dissipation 0.1; }}
            observe {{ x: m = disc.position.x; y: m = disc.position.y; u: m/s = disc.velocity.x; \
            v: m/s = disc.velocity.y;
                total: J = stored_energy + integral(dissipated_power) - integral(supplied_power) }}
        }}"
    )
}

/// The disc falls on a shape of the language as on the hand-written one.
fn disc_agrees(shape: &str, falls: &Falls, starts: &[([f64; 4], f64)]) {
    for &(start, t) in starts {
        let expected = by_hand(falls, &start, t);
        let flown = [start[0] + start[2] * t, start[1] + start[3] * t - 0.5 * 9.81 * t * t];
        assert!((expected[0] - flown[0]).hypot(expected[1] - flown[1]) > 1e-3, "it touches: {shape} {start:?}");
        for is_swapped in [false, true] {
            let found = after(&disc(shape, start, is_swapped), &[0.0, t]);
            for (found, expected) in found[1].iter().zip(expected.iter()) {
                assert!((found - expected).abs() < 1e-10, "{shape} {start:?} {t}: {found} {expected}");
            }
            assert!((found[1][4] - found[0][4]).abs() < 1e-9, "{found:?}");
        }
    }
}

#[test]
fn a_disc_meets_both_sides_and_both_ends_of_a_segment() {
    let starts = [
        // From above, from below, at the first end, at the last one, along the wall and over its end.
        ([0.16, 0.1, 0.0, 0.0], 0.3),
        ([0.16, -0.1, 0.0, 2.5], 0.2),
        ([0.085, 0.1, 0.0, 0.0], 0.3),
        ([0.215, 0.15, 0.0, 0.0], 0.3),
        ([0.205, 0.1, -0.1, -0.5], 0.25),
    ];
    let near: Near = |place| (from_segment(0.12, place), [place[0], 0.12 - place[0]]);
    disc_agrees("segment x 120 mm", &Falls { near, far: DISC, is_around: false }, &starts);
    // Along y: what is first for the hand-written wall is second here.
    let near: Near = |place| {
        let away = from_segment(0.12, [place[1], -place[0]]);
        ([-away[1], away[0]], [place[1], 0.12 - place[1]])
    };
    disc_agrees("segment y 0.12", &Falls { near, far: DISC, is_around: false }, &[([0.16, 0.06, -1.0, 0.0], 0.2)]);
}

#[test]
fn a_disc_in_a_slot_goes_round_its_ends() {
    let starts = [([0.15, 0.021, 1.0, 0.5], 0.2), ([0.13, 0.0127, -1.0, 0.0], 0.2)];
    let near: Near = |place| (from_segment(0.1, place), [place[0], 0.1 - place[0]]);
    disc_agrees("slot x 0.1 width 50 mm", &Falls { near, far: 0.005, is_around: true }, &starts);
}

#[test]
fn a_disc_meets_both_sides_and_both_ends_of_an_arc() {
    fn near(place: Plane, from: f64, to: f64) -> (Plane, [f64; 2]) {
        let [first, last] = [from, to].map(|angle| polar(1.0, angle)).map(|end| end[0] * place[1] - end[1] * place[0]);
        (from_arc(0.1, from, to, place), [first, last])
    }
    let starts = [
        // From outside, from inside, at the end after `to`, at the one after `from`, from behind the centre.
        ([0.1, 0.2, 0.0, 0.0], 0.3),
        ([0.1, 0.02, 0.0, 1.5], 0.15),
        ([0.02, 0.15, 0.0, 0.0], 0.3),
        ([0.175, 0.15, 0.0, 0.0], 0.3),
        ([0.09, -0.15, 0.1, 2.6], 0.2),
    ];
    let falls = Falls { near: |place| near(place, 0.3, 2.1), far: DISC, is_around: false };
    disc_agrees("arc 100 mm from 0.3 to 2.1", &falls, &starts);
    // More than half of a circle, from inside.
    let falls = Falls { near: |place| near(place, -0.5, 4.5), far: DISC, is_around: false };
    disc_agrees("arc 0.1 from -0.5 to 4.5", &falls, &[([0.1, 0.0, 1.0, 1.0], 0.3)]);
}

/// A Geneva drive of four slots: distance of the shafts, what the pin is off the driver's shaft, where the slots begin.
const SHAFTS: f64 = 0.1;
const OFF: f64 = SHAFTS * std::f64::consts::FRAC_1_SQRT_2;
const SLOT: f64 = 0.02;
/// Radius of the pin, half the play in the slots; radius of the wheel's corners.
const PIN: f64 = 0.005;
const PLAY: f64 = 5e-5;
const CORNER: f64 = 0.001;
/// Where the corners are: distance from the wheel's shaft, angle from the middle of their face; play at the drum.
const EDGE: f64 = 0.07;
const FACE: f64 = 0.64;
const LOOSE: f64 = 3e-5;
/// The drum has no wall this far to both sides of the pin.
const OPENING: f64 = 0.56;
const SPEED: f64 = 30.0;
const START: f64 = -1.4;
const DRAG: f64 = 0.05;
const DISSIPATION: f64 = 2.0;
const INERTIAS: [f64; 2] = [0.02, 1e-3];

fn drum() -> f64 {
    (SHAFTS * SHAFTS + EDGE * EDGE - 2.0 * SHAFTS * EDGE * FACE.cos()).sqrt() - CORNER - LOOSE
}

/// States: angle and speed of driver and wheel. A contact each of pin and wall, of corner and drum.
struct Geneva;

/// A contact: how far open, how the distance changes with the angles of driver and wheel; what is 0 where the nearest
/// place goes from a wall to its end.
struct Touch {
    gap: f64,
    by: [f64; 2],
    seams: [f64; 2],
}

impl Geneva {
    /// Corners with a radius and what they meet, `away` from it; both are turned by `angle` about the shaft at `x`.
    fn touch(place: Plane, away: Plane, radius: f64, seams: [f64; 2]) -> Touch {
        let distance = away[0].hypot(away[1]);
        let n = away.map(|part| part / distance);
        // The force on what is round goes along n, through its centre.
        let about = |x: f64| (place[0] - x) * n[1] - place[1] * n[0];
        Touch { gap: distance - radius, by: [about(0.0), -about(SHAFTS)], seams }
    }

    fn touches(x: &[f64]) -> Vec<Touch> {
        let [driver, wheel] = [x[0], x[2]];
        let pin = polar(OFF, driver);
        let walls = (0..8).map(|k| {
            let angle = wheel + FRAC_PI_4 + f64::from(k / 2) * FRAC_PI_2;
            let side = if k % 2 == 0 { PIN + PLAY } else { -(PIN + PLAY) };
            let (along, across) = (polar(1.0, angle), polar(1.0, angle + FRAC_PI_2));
            let from = [0, 1].map(|k| pin[k] - if k == 0 { SHAFTS } else { 0.0 });
            let inside =
                [from[0] * along[0] + from[1] * along[1] - SLOT, from[0] * across[0] + from[1] * across[1] - side];
            let away = from_segment(OFF - SLOT, inside);
            let seams = [inside[0], OFF - SLOT - inside[0]];
            Self::touch(pin, [0, 1].map(|k| along[k] * away[0] + across[k] * away[1]), PIN, seams)
        });
        let corners = (0..8).map(|k| {
            let angle = wheel + f64::from(k / 2) * FRAC_PI_2 + if k % 2 == 0 { FACE } else { -FACE };
            let off = polar(EDGE, angle);
            let corner = [SHAFTS + off[0], off[1]];
            let (x, y) = (polar(1.0, driver), polar(1.0, driver + FRAC_PI_2));
            let inside = [corner[0] * x[0] + corner[1] * x[1], corner[0] * y[0] + corner[1] * y[1]];
            let away = from_arc(drum(), OPENING, TAU - OPENING, inside);
            let seams = [inside[1], inside[0] - OPENING.cos() * inside[0].hypot(inside[1])];
            let touch = Self::touch(corner, [0, 1].map(|k| x[k] * away[0] + y[k] * away[1]), CORNER, seams);
            // What is round is the wheel's.
            Touch { by: touch.by.map(|arm| -arm), ..touch }
        });
        walls.chain(corners).collect()
    }
}

impl Dynamics for Geneva {
    fn states(&self) -> usize {
        4
    }

    fn switches(&self) -> usize {
        48
    }

    fn guards(&self, _: f64, x: &[f64], _: &[bool], guards: &mut [f64]) {
        for (k, touch) in Self::touches(x).into_iter().enumerate() {
            guards[k] = touch.gap;
            guards[16 + 2 * k..18 + 2 * k].copy_from_slice(&touch.seams);
        }
    }

    fn rate(&self, _: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let mut torques = [0.0, -DRAG * x[3]];
        for (touch, _) in Self::touches(x).into_iter().zip(negative).filter(|(_, negative)| **negative) {
            let rate = -(touch.by[0] * x[1] + touch.by[1] * x[3]);
            let force = -1e6 * touch.gap * (1.0 + 1.5 * DISSIPATION * rate);
            for (torque, arm) in torques.iter_mut().zip(touch.by) {
                *torque += force.max(0.0) * arm;
            }
        }
        dx.copy_from_slice(&[x[1], torques[0] / INERTIAS[0], x[3], torques[1] / INERTIAS[1]]);
    }
}

fn geneva() -> String {
    let (mut points, mut contacts, mut gaps) = (String::new(), String::new(), Vec::new());
    for k in 0..4 {
        let quarter = f64::from(k) * FRAC_PI_2;
        let slot = format!("turned rotation_z({:?})", FRAC_PI_4 + quarter);
        for (side, sign) in [("l", 1.0), ("r", -1.0)] {
            let ([x, y], [u, v]) =
                (polar(SLOT, FRAC_PI_4 + quarter), polar(sign * (PIN + PLAY), 3.0 * FRAC_PI_4 + quarter));
            points += &format!("point {side}{k} = [{:?}, {:?}, 0] {slot};", x + u, y + v);
            let [x, y] = polar(EDGE, quarter + sign * FACE);
            points += &format!("point c{side}{k} = [{x:?}, {y:?}, 0];");
            contacts += &format!(
                "contact w{side}{k} (wheel.{side}{k} segment x {:?} -> driver.pin circle {PIN:?}) {{ LAW }}
                 contact d{side}{k} (driver arc {:?} from {OPENING:?} to {:?} -> wheel.c{side}{k} circle {CORNER:?}) \
                 {{ LAW }}",
                OFF - SLOT,
                drum(),
                TAU - OPENING
            );
            gaps.push(format!("w{side}{k}: m = w{side}{k}.gap; d{side}{k}: m = d{side}{k}.gap;"));
        }
    }
    let [driver, wheel] = INERTIAS;
    format!(
        "graph Geneva {{
            ground {{ point O = [0, 0, 0]; point P = [{SHAFTS:?}, 0, 0]; }}
            body driver {{ mass 1; inertia [{driver:?}, {driver:?}, {driver:?}]; point pin = [{OFF:?}, 0, 0];
                start turned rotation_z({START:?}); start spin [0, 0, {SPEED:?}]; }}
            body wheel {{ mass 1; inertia [{wheel:?}, {wheel:?}, {wheel:?}]; start at [{SHAFTS:?}, 0, 0]; {points} }}
            joint input: revolute z (ground.O -> driver) {{ rigid; }}
            joint output: revolute z (ground.P -> wheel) {{ rigid; }}
            R drag = {DRAG:?}; output.spin -> drag;
            {}
            observe {{ driver: rad = input.angle; wheel: rad = output.angle; {} }}
            scene Flat {{ observe {{ driver: rad = input.angle; wheel: rad = output.angle; \
            speed: rad/s = output.speed; {} }} expect planar; }}
        }}",
        contacts.replace("LAW", &format!("stiffness 1e6; dissipation {DISSIPATION:?};")),
        gaps.join(""),
        gaps.join("")
    )
}

#[test]
fn a_geneva_wheel_goes_on_by_two_quarters() {
    let graphs = graphs(&geneva());
    let flat = model(&graphs, "Flat", &[]);
    let start = bg_model::dynamics::Machine::start(&*flat).unwrap_or_else(|error| panic!("{error}"));
    let (mut indexed, step) = (0, 0.01);
    let (mut hand, mut state) = (vec![START, SPEED, 0.0, 0.0], start);
    let mut found = Vec::new();
    for k in 1..=42 {
        hand = by_hand(&Geneva, &hand, step);
        let finish = run(&*flat, &state, step);
        state = finish.x.as_slice().to_vec();
        found = outputs(&*flat, finish.t, &state, &finish.negative);
        let t = step * f64::from(k);
        assert!((found[0] - hand[0]).abs() < 1e-8 && (found[1] - hand[2]).abs() < 1e-8, "{t}: {found:?} {hand:?}");
        // Closed form: the pin's centre is off the middle of its slot by what is left beside the wall that it touches.
        let [driver, wheel] = [found[0], found[1]];
        let walls = (0..8).map(|k| (k, found[3 + 2 * k]));
        for (k, gap) in walls.filter(|(_, gap)| *gap < 0.0) {
            let pin = polar(OFF, driver);
            let along = (pin[1]).atan2(pin[0] - SHAFTS);
            let distance = pin[1].hypot(pin[0] - SHAFTS);
            #[expect(clippy::cast_precision_loss, reason = "a number below 4")]
            let middle = wheel + FRAC_PI_4 + (k / 2) as f64 * FRAC_PI_2;
            let side = if k % 2 == 0 { PLAY - gap } else { gap - PLAY };
            let off = (along - middle + PI).rem_euclid(TAU) - PI;
            if distance < 0.065 {
                assert!((off - (side / distance).asin()).abs() < 1e-9, "{t} s: {off} {side}");
                indexed += 1;
            }
        }
    }
    assert!(indexed > 5, "{indexed}");
    // Two quarters on, held by the drum within its play.
    assert!(found[0] > TAU + FRAC_PI_4 + 0.3, "{}", found[0]);
    assert!((found[1] + PI).abs() < 3.0 * LOOSE / (EDGE * FACE.sin()), "{}", found[1]);
}

#[test]
fn rigid_discs_part_along_the_line_of_their_centres() {
    let text = "graph Discs {
        param e: 1 = 0.6, at least 0, at most 1;
        body one { mass 0.7; inertia [1e-3, 1e-3, 1e-3]; start velocity [3, 1, 0]; start spin [0, 0, 20]; }
        body two { mass 0.3; inertia [1e-3, 1e-3, 1e-3]; start at [0.5, 0.05, 0]; start velocity [-1, 0.5, 0]; }
        contact hit (one circle 0.06 -> two circle 0.04) { rigid; restitution e; }
        observe { u: m/s = one.velocity; v: m/s = two.velocity; spin: rad/s = one.angular_velocity.z; gap: m = hit.gap;
            lost: J = integral(dissipated_power) }
    }";
    let graphs = graphs(text);
    for e in [0.0, 0.6, 1.0] {
        let discs = model(&graphs, "Discs", &[("e", e)]);
        let start = bg_model::dynamics::Machine::start(&*discs).expect("a start");
        let finish = run(&*discs, &start, 0.3);
        let found = outputs(&*discs, finish.t, finish.x.as_slice(), &finish.negative);
        // They touch where |d + w t| = 0.1.
        let (d, w) = ([0.5, 0.05], [-4.0, -0.5]);
        let (a, b, c) = (w[0] * w[0] + w[1] * w[1], d[0] * w[0] + d[1] * w[1], d[0] * d[0] + d[1] * d[1] - 0.01_f64);
        let t = (-b - (b * b - a * c).sqrt()) / a;
        let n = [0, 1].map(|k| (d[k] + w[k] * t) / 0.1);
        let speed = w[0] * n[0] + w[1] * n[1];
        let impulse = -(1.0 + e) * speed / (1.0 / 0.7 + 1.0 / 0.3);
        let expected = [
            3.0 - impulse * n[0] / 0.7,
            1.0 - impulse * n[1] / 0.7,
            -1.0 + impulse * n[0] / 0.3,
            0.5 + impulse * n[1] / 0.3,
        ];
        for (k, expected) in [0, 1, 3, 4].into_iter().zip(expected) {
            assert!((found[k] - expected).abs() < 1e-10, "{e}: {found:?} {expected}");
        }
        assert!((found[6] - 20.0).abs() < 1e-12 && found[7] > -1e-12, "{found:?}");
        let lost = 0.5 * (1.0 - e * e) * speed * speed / (1.0 / 0.7 + 1.0 / 0.3);
        assert!((found[8] - lost).abs() < 1e-10, "{e}: {found:?} {lost}");
    }
}

#[test]
fn what_rests_on_a_rigid_shape_slides_along_it() {
    // In a hole it swings as a pendulum of the play's length, released at 60 degrees.
    let text = "graph Bowl {
        gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; }
        body disc { mass 0.4; inertia [1e-3, 1e-3, 1e-3]; start at [0.2 * sin(60 deg), -0.2 * cos(60 deg), 0]; }
        contact bowl (ground.O hole 0.25 -> disc circle 0.05) { rigid; restitution 0; }
        observe { angle: rad = atan2(disc.position.x, -disc.position.y); pressed: N = bowl.pressed; gap: m = bowl.gap }
    }";
    struct Pendulum;
    impl Dynamics for Pendulum {
        fn states(&self) -> usize {
            2
        }
        fn switches(&self) -> usize {
            0
        }
        fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
            dx.copy_from_slice(&[x[1], -9.81 / 0.2 * x[0].sin()]);
        }
    }
    for (found, t) in after(text, &[0.1, 0.7]).iter().zip([0.1, 0.7]) {
        let x = by_hand(&Pendulum, &[PI / 3.0, 0.0], t);
        assert!((found[0] - x[0]).abs() < 1e-8, "{t}: {found:?} {x:?}");
        assert!((found[1] - 0.4 * (9.81 * x[0].cos() + 0.2 * x[1] * x[1])).abs() < 1e-6, "{t}: {found:?} {x:?}");
    }
    // From a wall it falls off its end, with the speed of its slide.
    let text = "graph Slide {
        gravity [0, -9.81, 0]; ground { point wall = [0, 0, 0] turned rotation_z(-0.3); }
        body disc { mass 0.4; inertia [1e-3, 1e-3, 1e-3]; start at [0.05 * sin(0.3) + 0.1 * cos(0.3), 0.05 * cos(0.3) \
        - 0.1 * sin(0.3), 0]; }
        contact wall (ground.wall segment x 0.5 -> disc circle 0.05) { rigid; restitution 0; }
        observe { way: m = dot([cos(0.3), -sin(0.3), 0], disc.position); pressed: N = wall.pressed }
    }";
    for (found, t) in after(text, &[0.2, 0.5]).iter().zip([0.2_f64, 0.5]) {
        assert!((found[0] - 0.1 - 0.5 * 9.81 * 0.3_f64.sin() * t * t).abs() < 1e-9, "{found:?}");
        assert!((found[1] - 0.4 * 9.81 * 0.3_f64.cos()).abs() < 1e-7, "{found:?}");
    }
    let off = after(text, &[0.8]).remove(0);
    assert!(off[0] > 0.5 && off[1] == 0.0, "{off:?}");
}

/// Mistakes of beginners with shapes, play and friction: what is wrong, and the statement with it.
const MISTAKES: [(&str, &str); 35] = [
    ("segment: no length", "contact c (ground segment x -> ball circle 0.1) { stiffness 1e5; }"),
    ("segment: no axis", "contact c (ground segment 0.3 -> ball circle 0.1) { stiffness 1e5; }"),
    ("segment: along z", "contact c (ground segment z 0.3 -> ball circle 0.1) { stiffness 1e5; }"),
    ("segment: a point meets it", "contact c (ground segment x 0.3 -> ball) { stiffness 1e5; }"),
    ("segment: a length of 0", "contact c (ground segment x 0 -> ball circle 0.1) { stiffness 1e5; }"),
    ("slot: no width", "contact c (ground slot x 0.3 -> ball circle 0.1) { stiffness 1e5; }"),
    ("slot: a width in kg", "contact c (ground slot x 0.3 width 3 kg -> ball circle 0.1) { stiffness 1e5; }"),
    ("slot: a slip of the pen", "contact c (ground slott x 0.3 width 0.3 -> ball circle 0.1) { stiffness 1e5; }"),
    ("slot: in a slot", "contact c (ground slot x 0.3 width 0.3 -> ball slot x 0.1 width 0.1) { stiffness 1e5; }"),
    ("slot: of a sphere", "contact c (ground slot x 0.3 width 0.3 -> ball sphere 0.1) { stiffness 1e5; }"),
    ("arc: no angles", "contact c (ground arc 0.3 -> ball circle 0.1) { stiffness 1e5; }"),
    ("arc: one angle", "contact c (ground arc 0.3 from 20 deg -> ball circle 0.1) { stiffness 1e5; }"),
    ("arc: backwards", "contact c (ground arc 0.3 from 60 deg to 20 deg -> ball circle 0.1) { stiffness 1e5; }"),
    ("arc: an angle in m", "contact c (ground arc 0.3 from 1 m to 2 m -> ball circle 0.1) { stiffness 1e5; }"),
    ("arc: a point meets it", "contact c (ground arc 0.3 from 0 to 1 -> ball) { stiffness 1e5; }"),
    ("play: of a ball joint", "joint j: spherical (ground -> ball) { stiffness 1e5; clearance 0.1 mm; }"),
    ("play: of a rigid joint", "joint j: prismatic x (ground -> ball) { rigid; clearance 0.1 mm; }"),
    (
        "play: a length without it",
        "joint j: prismatic x (ground -> ball) { stiffness 1e5; tilt stiffness 1; length 0.1; }",
    ),
    (
        "play: the length of a pin",
        "joint j: revolute z (ground -> ball) { stiffness 1e5; tilt stiffness 1; clearance 0.1 mm; length 0.1; }",
    ),
    (
        "play: a stiffness for each axis",
        "joint j: prismatic x (ground -> ball) { stiffness [0, 1, 1]; tilt stiffness 1; clearance 0.1 mm; }",
    ),
    (
        "play: damping and restitution",
        "joint j: prismatic x (ground -> ball) { stiffness 1; damping 1; restitution 0.5; tilt stiffness 1; \
        clearance 0.1 mm; }",
    ),
    (
        "friction in space: neither stiffness nor creep",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; }",
    ),
    (
        "friction in space: stiffness and creep",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; \
        stiffness 1e6; creep 1e-3; }",
    ),
    (
        "friction in space: a stiffness of 0",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; stiffness 0; \
        }",
    ),
    (
        "friction in space: a stiffness in N",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; \
        stiffness 1e6 N; }",
    ),
    (
        "friction in space: static without stribeck",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; static 0.3; \
        stiffness 1e6; }",
    ),
    (
        "friction in the plane: a stiffness",
        "contact c (ground line x -> ball circle 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; stiffness 1e6; \
        }",
    ),
    (
        "friction in space: a stop",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } stop f on c { at most 1; stiffness 1; }",
    ),
    (
        "friction in space: a coefficient in N",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 2 N; creep 1e-4; }",
    ),
    (
        "friction in space: a creep of 0",
        "contact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; } friction f on c { coulomb 0.2; creep 0; }",
    ),
    ("rigid: no restitution", "contact c (ground line x -> ball circle 0.1) { rigid; }"),
    ("rigid: a stiffness", "contact c (ground line x -> ball circle 0.1) { rigid; stiffness 1e5; restitution 0; }"),
    ("rigid: a restitution of 2", "contact c (ground line x -> ball circle 0.1) { rigid; restitution 2; }"),
    ("rigid: twice", "contact c (ground line x -> ball circle 0.1) { rigid; rigid; restitution 0; }"),
    (
        "rigid: friction by its force",
        "contact c (ground line x -> ball circle 0.1) { rigid; restitution 0; } friction f on c { coulomb 0.2; }",
    ),
];

#[test]
fn beginners_are_told_what_to_do_about_walls_and_play() {
    let mut text = String::new();
    for (what, statement) in MISTAKES {
        let wrong = format!(
            "graph Wrong {{ body ball {{ mass 1; inertia [1, 1, 1]; }} {statement} observe {{ ball.position }} }}"
        );
        let found = said(&wrong);
        assert!(found.starts_with("[BG"), "{what}: {found}\n{wrong}");
        text += &format!("{what}\n{found}\n");
    }
    held(&file("mechanisms/contact_mistakes.txt"), &text);
}
