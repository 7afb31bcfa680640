//! Contacts of shapes beside hand-written models: a cam from which its follower lifts off, restitutions, a
//! slider-crank with a clearance, what rubs at a contact.

use bg_model::dynamics::Dynamics;

use super::hand::run;
use super::text::{graphs, model, outputs};

/// The outputs of a text after each of these times, s.
pub fn after(text: &str, times: &[f64]) -> Vec<Vec<f64>> {
    let graphs = graphs(text);
    let model = model(&graphs, &graphs[0].name, &[]);
    let start = bg_model::dynamics::Machine::start(&*model).unwrap_or_else(|error| panic!("{error}"));
    let at = |&t: &f64| {
        let finish = run(&*model, &start, t);
        outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative)
    };
    times.iter().map(at).collect()
}

/// A hand-written law of contact: the force over depth, its rate and the speed of approach.
type Law = fn(f64, f64, f64) -> f64;

/// A system with one contact, whose last state is the speed of approach when the shapes last touched.
struct Pressed<F: Fn(&[f64]) -> [f64; 2], R: Fn(&[f64], f64, &mut [f64])> {
    states: usize,
    /// Distance of the shapes and its rate.
    gap: F,
    /// The rates under a force.
    rates: R,
    law: Law,
}

impl<F: Fn(&[f64]) -> [f64; 2], R: Fn(&[f64], f64, &mut [f64])> Dynamics for Pressed<F, R> {
    fn states(&self) -> usize {
        self.states
    }

    fn switches(&self) -> usize {
        1
    }

    fn guards(&self, _: f64, x: &[f64], _: &[bool], guards: &mut [f64]) {
        guards[0] = (self.gap)(x)[0];
    }

    fn rate(&self, _: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let [gap, rate] = (self.gap)(x);
        let last = self.states - 1;
        let force = if negative[0] { (self.law)(-gap, -rate, x[last]).max(0.0) } else { 0.0 };
        (self.rates)(x, force, dx);
        dx[last] = 0.0;
    }

    fn project(&self, _: f64, negative: &[bool], x: &mut [f64]) {
        if !negative[0] {
            x[self.states - 1] = -(self.gap)(x)[1];
        }
    }
}

/// An eccentric disc turns under a roller of 10 mm on a follower, which gravity and a spring hold down.
const RADIUS: f64 = 0.03;
const OFF: f64 = 0.002;
const ROLLER: f64 = 0.01;

/// Angle of the disc, height of the follower, force between them at these times.
fn disc_by_hand(is_flat: bool, times: &[f64]) -> Vec<[f64; 3]> {
    let (inertia, mass) = (1e-3, 0.3);
    // Direction from the disc's centre to the roller's, and distance of the shapes.
    let meet = move |x: &[f64]| {
        let center = [OFF * x[0].cos(), OFF * x[0].sin()];
        if is_flat {
            return (center, [0.0, 1.0], x[2] - center[1] - RADIUS);
        }
        let way = [-center[0], x[2] - center[1]];
        let distance = way[0].hypot(way[1]);
        (center, [way[0] / distance, way[1] / distance], distance - RADIUS - ROLLER)
    };
    let gap = move |x: &[f64]| {
        let (center, n, gap) = meet(x);
        let velocity = [center[1] * x[1], x[3] - center[0] * x[1]];
        [gap, n[0] * velocity[0] + n[1] * velocity[1]]
    };
    let rates = move |x: &[f64], force: f64, dx: &mut [f64]| {
        let (center, n, _) = meet(x);
        let torque = -force * (center[0] * n[1] - center[1] * n[0]);
        dx[..4].copy_from_slice(&[
            x[1],
            torque / inertia,
            x[3],
            force * n[1] / mass - 9.81 - 40.0 * (x[2] - 0.03) / mass,
        ]);
    };
    let law: Law = |depth, rate, _| 1e6 * depth * (1.0 + 1.5 * 0.2 * rate);
    let system = Pressed { states: 5, gap, rates, law };
    let height = RADIUS + if is_flat { 0.0 } else { ROLLER };
    let force = |x: &[f64]| {
        let [gap, rate] = gap(x);
        if gap < 0.0 { law(-gap, -rate, 0.0) } else { 0.0 }
    };
    let at = |&t: &f64| {
        let x = run(&system, &[0.0, 100.0, height, 0.2, 0.0], t).x;
        [x[0], x[2], force(x.as_slice())]
    };
    times.iter().map(at).collect()
}

/// The same as a text; `disc` and `follower` are the shapes.
fn disc(table: &str, contact: &str) -> String {
    format!(
        "graph Disc {{
            {table}
            gravity [0, -9.81, 0];
            ground {{ point O = [0, 0, 0]; point foot = [0, -0.97, 0]; }}
            body disc {{ mass 1; inertia [1, 1, 1e-3]; point middle = [0.002, 0, 0]; start spin [0, 0, 100]; }}
            body follower {{ mass 0.3; inertia [1e-4, 1e-4, 1e-4]; start at [0, HEIGHT, 0]; \
            start velocity [0, 0.2, 0]; }}
            joint shaft: revolute z (ground.O -> disc) {{ rigid; }}
            joint guide: prismatic y (ground.O -> follower) {{ rigid; }}
            spring back (ground.foot -> follower) {{ stiffness 40; length 1; }}
            contact tip ({contact}) {{ stiffness 1e6; dissipation 0.2; }}
            observe {{ angle: rad = shaft.angle; lift: m = follower.position.y; force: N = tip.pressed; \
            gap: m = tip.gap;
                total: J = stored_energy + integral(dissipated_power) - integral(supplied_power) }}
        }}"
    )
}

/// Points of the disc's outline by the angle about the shaft.
fn outline(count: u32) -> String {
    let radius = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k % count) / f64::from(count);
        OFF * angle.cos() + (RADIUS * RADIUS - (OFF * angle.sin()).powi(2)).sqrt()
    };
    let point = |k: u32| format!("[{:?}, {:?}]", 360.0 * f64::from(k) / f64::from(count), radius(k));
    let points: Vec<String> = (0..=count).map(point).collect();
    format!("table outline: deg -> m = [{}], spline, periodic;", points.join(", "))
}

const TIMES: [f64; 3] = [0.004, 0.02, 0.05];

#[test]
fn a_roller_lifts_off_an_eccentric_disc() {
    let expected = disc_by_hand(false, &TIMES);
    // It does so, comes back and is pressed again.
    assert!(expected.iter().any(|at| at[2] == 0.0) && expected.iter().any(|at| at[2] > 1.0), "{expected:?}");
    let text = disc("", "disc.middle circle 0.03 -> follower circle 0.01").replace("HEIGHT", "0.04");
    let found = after(&text, &TIMES);
    for (found, expected) in found.iter().zip(&expected) {
        let apart = [found[0] - expected[0], found[1] - expected[1], 1e-6 * (found[2] - expected[2])];
        assert!(apart.iter().all(|apart| apart.abs() < 1e-10), "{found:?} {expected:?}");
    }
    // The other way round.
    let text = disc("", "follower circle 0.01 -> disc.middle circle 0.03").replace("HEIGHT", "0.04");
    let swapped = after(&text, &TIMES[2..]);
    assert!((swapped[0][1] - found[2][1]).abs() < 1e-12 && (swapped[0][2] - found[2][2]).abs() < 1e-6);
}

/// How far a follower on a profile through so many points of the disc is from one on the disc, m; a flat face looks
/// down.
fn error_of_profile(is_flat: bool, shapes: &str, count: u32) -> f64 {
    let height = if is_flat { "0.03" } else { "0.04" };
    let face = "point face = [0, 0, 0] turned rotation_z(3.141592653589793); start at [0,";
    let text = disc(&outline(count), shapes).replace("HEIGHT", height).replace("start at [0,", face);
    let found = after(&text, &[&[0.0][..], &TIMES].concat());
    let expected = disc_by_hand(is_flat, &TIMES);
    let apart = found[1..].iter().zip(&expected).map(|(at, expected)| {
        // No truncation of the place of contact costs energy.
        assert!((at[4] - found[0][4]).abs() < 1e-9, "{at:?}");
        (at[1] - expected[1]).abs().max(OFF * (at[0] - expected[0]).abs())
    });
    apart.fold(0.0, f64::max)
}

#[test]
fn a_profile_through_points_of_a_disc_is_the_disc() {
    let [coarse, fine] =
        [18, 72].map(|count| error_of_profile(false, "disc profile outline -> follower circle 0.01", count));
    assert!(fine < 1e-8 && fine < coarse / 100.0, "{coarse:e} m, {fine:e} m");
    let swapped = error_of_profile(false, "follower circle 0.01 -> disc profile outline", 18);
    assert!((swapped - coarse).abs() < 1e-10, "{swapped:e} m, {coarse:e} m");
}

#[test]
fn a_flat_follower_on_a_profile_is_one_on_the_disc() {
    let [coarse, fine] =
        [18, 72].map(|count| error_of_profile(true, "disc profile outline -> follower.face line x", count));
    assert!(fine < 1e-8 && fine < coarse / 100.0, "{coarse:e} m, {fine:e} m");
    let swapped = error_of_profile(true, "follower.face line x -> disc profile outline", 18);
    assert!((swapped - coarse).abs() < 1e-10, "{swapped:e} m, {coarse:e} m");
}

#[test]
fn what_hits_parts_with_its_restitution() {
    let graph = |shapes: &str, law: &str| {
        format!(
            "graph Ball {{
                param e: 1 = 0.5;
                ground {{ point O = [0, 0, 0]; }}
                body wall {{ mass 0.7; inertia [1e-3, 1e-3, 1e-3]; start velocity [0, 0.4, 0]; }}
                body ball {{ mass 0.5; inertia [1e-3, 1e-3, 1e-3]; start at [0, 0.3, 0]; start velocity [0, -1.2, 0]; }}
                contact hit ({shapes}) {{ stiffness 1e6; restitution e; {law} }}
                observe {{ apart: m/s = ball.velocity.y - wall.velocity.y; gap: m = hit.gap;
                    momentum: N*s = ball.momentum.y + wall.momentum.y; energy: J = stored_energy; \
                    lost: J = integral(hit.damper.power) }}
            }}"
        )
    };
    let pairs = [
        ("wall circle 0.1 -> ball circle 0.1", ""),
        ("wall line x -> ball circle 0.1", "exponent 1.5;"),
        ("wall sphere 0.1 -> ball sphere 0.05", "exponent 1.5;"),
        ("ball sphere 0.1 -> wall plane y", "exponent 2.5;"),
    ];
    for (shapes, law) in pairs {
        let graphs = graphs(&graph(shapes, law));
        for tenth in 1..10 {
            let restitution = f64::from(tenth) / 10.0;
            let ball = model(&graphs, "Ball", &[("e", restitution)]);
            let start = bg_model::dynamics::Machine::start(&*ball).expect("a start");
            let finish = run(&*ball, &start, 0.4);
            let found = outputs(&*ball, finish.t, finish.x.as_slice(), &finish.negative);
            let [apart, gap, momentum, energy, lost] = found[..] else { panic!("five outputs") };
            assert!(gap > 0.0 && finish.statistics.events >= 2, "{found:?}");
            assert!((apart / 1.6 - restitution).abs() < 1e-8, "{shapes}: {} for {restitution}", apart / 1.6);
            assert!((momentum + 0.32).abs() < 1e-12 && (energy + lost - 0.416).abs() < 1e-9, "{found:?}");
        }
    }
}

/// Crank, rod and slider in the plane, with a pin in a hole of 0.5 mm play at the slider: an example of our own of what
/// P. Flores, J. Ambrosio, J. C. P. Claro, H. M. Lankarani, Influence of the contact-impact force model on the dynamic
/// response of multi-body systems, Proc. IMechE K 220 (2006) 21-34 looks at. The crank is free, with a flywheel.
const CRANK: f64 = 0.05;
const ROD: f64 = 0.12;
const PLAY: f64 = 5e-4;
const FLYWHEEL: f64 = 0.1;

fn slider_by_hand(law: Law, t_end: f64) -> Vec<f64> {
    let (rod, slider, about) = (0.21, 0.14, 2.5e-4);
    // States: angles of crank and rod, place of the slider, their rates, the speed of approach.
    let pin = |x: &[f64]| {
        let ([a, b], [v, w]) = ([x[0], x[1]], [x[3], x[4]]);
        let place = [CRANK * a.cos() + ROD * b.cos(), CRANK * a.sin() + ROD * b.sin()];
        let velocity = [-CRANK * a.sin() * v - ROD * b.sin() * w, CRANK * a.cos() * v + ROD * b.cos() * w];
        ([x[2] - place[0], -place[1]], [x[5] - velocity[0], -velocity[1]])
    };
    let gap = move |x: &[f64]| {
        let (d, v) = pin(x);
        let distance = d[0].hypot(d[1]).max(1e-12);
        [PLAY - distance, -(d[0] * v[0] + d[1] * v[1]) / distance]
    };
    let rates = move |x: &[f64], force: f64, dx: &mut [f64]| {
        let (d, _) = pin(x);
        let distance = d[0].hypot(d[1]).max(1e-12);
        // On the rod.
        let push = [force * d[0] / distance, force * d[1] / distance];
        let ([a, b], [v, w]) = ([x[0], x[1]], [x[3], x[4]]);
        let coupling = rod * CRANK * ROD / 2.0;
        let (m11, m12, m22) = (FLYWHEEL + rod * CRANK * CRANK, coupling * (a - b).cos(), rod * ROD * ROD / 4.0 + about);
        let moment = |length: f64, angle: f64| length * (angle.cos() * push[1] - angle.sin() * push[0]);
        let right =
            [moment(CRANK, a) - coupling * (a - b).sin() * w * w, moment(ROD, b) + coupling * (a - b).sin() * v * v];
        let determinant = m11 * m22 - m12 * m12;
        dx[..6].copy_from_slice(&[
            v,
            w,
            x[5],
            (m22 * right[0] - m12 * right[1]) / determinant,
            (m11 * right[1] - m12 * right[0]) / determinant,
            -push[0] / slider,
        ]);
    };
    let system = Pressed { states: 7, gap, rates, law };
    let speed = 5000.0 * std::f64::consts::PI / 30.0;
    // At the dead centre the rod turns back and the slider stands.
    let start = [0.0, 0.0, CRANK + ROD, speed, -speed * CRANK / ROD, 0.0, 0.0];
    run(&system, &start, t_end).x.as_slice().to_vec()
}

fn slider(joint: &str) -> String {
    format!(
        "graph Slider {{
            ground {{ point O = [0, 0, 0]; }}
            body crank {{ mass 1; inertia [0.1, 0.1, 0.1]; point A = [0.05, 0, 0]; start spin [0, 0, 5000 rpm]; }}
            body rod {{ mass 0.21; inertia [2.5e-4, 2.5e-4, 2.5e-4]; point A = [-0.06, 0, 0]; point B = [0.06, 0, 0];
                start A at [0.05, 0, 0]; start spin [0, 0, -(5000 rpm) * 0.05 / 0.12];
                start velocity [0, (5000 rpm) * (0.05 - 0.06 * 0.05 / 0.12), 0]; }}
            body slider {{ mass 0.14; inertia [1e-4, 1e-4, 1e-4]; start at [0.17, 0, 0]; }}
            joint main: revolute z (ground.O -> crank) {{ rigid; }}
            joint big_end: revolute z (crank.A -> rod.A) {{ rigid; }}
            joint guide: prismatic x (ground.O -> slider) {{ rigid; }}
            {joint}
            observe {{ crank: rad = main.angle; rod: rad = rod.angle; place: m = guide.travel; \
            speed: m/s = slider.velocity.x }}
        }}"
    )
}

#[test]
fn a_slider_crank_rattles_in_the_play_of_its_pin() {
    // 6.61e10 N/m^1.5 are about two steel cylinders of 10 and 9.5 mm.
    let law: Law = |depth, rate, approach| {
        // x = 0.16648195068531.. for e = 0.9.
        6.61e10 * depth.powf(1.5) * (1.0 + 0.166_481_950_685_31 * rate / approach)
    };
    let contact =
        "contact pin (slider hole 10 mm -> rod.B circle 9.5 mm) { stiffness 6.61e10; exponent 1.5; restitution 0.9; }";
    for t_end in [0.002, 0.004, 0.006] {
        let expected = slider_by_hand(law, t_end);
        let found = after(&slider(contact), &[t_end]).remove(0);
        let expected = [expected[0], expected[1], expected[2], expected[5]];
        let sizes = [1.0, 1.0, 0.1, 10.0];
        for ((found, expected), size) in found.iter().zip(expected).zip(sizes) {
            assert!((found - expected).abs() < 1e-7 * size, "{t_end} s: {found} {expected}");
        }
    }
}

#[test]
fn a_clearance_is_a_pin_in_a_hole() {
    let law: Law = |depth, rate, _| 2e7 * depth + 300.0 * rate;
    let pin =
        "joint pin: revolute z (slider -> rod.B) { clearance 0.5 mm; stiffness 2e7; damping 300; tilt stiffness 0; }";
    let expected = slider_by_hand(law, 0.006);
    let found = after(&slider(pin), &[0.006]).remove(0);
    for (found, expected) in found.iter().zip([expected[0], expected[1], expected[2], expected[5]]) {
        assert!((found - expected).abs() < 1e-7, "{found} {expected}");
    }
}

#[test]
fn what_slides_on_an_incline_rubs_and_sticks() {
    // A disc that rolls or slips down an incline: with f = m g cos(a) mu above m g sin(a) / 3 it rolls.
    let graph = |friction: f64| {
        format!(
            "graph Incline {{
                gravity [0, -9.81, 0];
                ground {{ point foot = [0, 0, 0] turned rotation_z(-0.4); }}
                body disc {{ mass 2; inertia [1, 1, 0.01]; start at [0.1 * sin(0.4), 0.1 * cos(0.4), 0]; }}
                contact floor (ground.foot line x -> disc circle 0.1) {{ stiffness 1e5; damping 2 * sqrt(1e5 * 2); }}
                friction rub on floor {{ coulomb {friction:?}; }}
                observe {{ way: m = dot([cos(0.4), -sin(0.4), 0], disc.position); \
                spin: rad/s = disc.angular_velocity.z; pressed: N = floor.pressed }}
            }}"
        )
    };
    let (g, t): (f64, f64) = (9.81, 0.8);
    let settled = 2.0 * g * 0.4_f64.cos();
    let [rolling, slipping] = [0.3, 0.05].map(|friction| after(&graph(friction), &[t]).remove(0));
    assert!((rolling[2] - settled).abs() < 1e-6 && (slipping[2] - settled).abs() < 1e-6, "{rolling:?}");
    // What presses swings in initially: rolling does not depend on it, slipping by the impulse, which is that of the
    // weight but for the speed of sinking in, which has gone.
    let acceleration = g * 0.4_f64.sin() / 1.5;
    assert!((rolling[1] + acceleration * t / 0.1).abs() < 1e-3, "{rolling:?}");
    let speed = g * (0.4_f64.sin() - 0.05 * 0.4_f64.cos()) * t;
    assert!((slipping[1] + 0.05 * settled * 0.1 / 0.01 * t).abs() < 1e-6, "{slipping:?}");
    assert!((slipping[0] - 0.5 * speed * t).abs() < 1e-4, "{slipping:?}");
}

#[test]
fn a_memory_keeps_what_it_followed() {
    let text = "graph Kept {
        1 slide: translation; I block = 1 start 2; C spring = 9 N/m; slide -> block; slide -> spring;
        memory fastest: m/s = slide.flow while spring.q < 0.3 start 5;
        observe { place: m = spring.q; speed: m/s = slide.flow; fastest }
    }";
    // 2 cos(3 t); 0.3 m is reached at sin(3 t) = 0.45 and left again with the opposite speed.
    let at = |t: f64| after(text, &[t]).remove(0);
    assert!((at(0.1)[2] - 2.0 * 0.3_f64.cos()).abs() < 1e-9);
    let kept = 2.0 * (1.0 - 0.45_f64 * 0.45).sqrt();
    assert!((at(0.5)[2] - kept).abs() < 1e-9 && (at(0.8)[2] - kept).abs() < 1e-9, "{:?} {kept}", at(0.5));
    assert!((at(1.0)[2] - 2.0 * 3.0_f64.cos()).abs() < 1e-9);
}

#[test]
fn scenes_in_the_plane_touch_as_the_graph_does() {
    let scene = "scene Flat { observe { angle: rad = shaft.angle; lift: m = follower.position.y; \
        force: N = tip.pressed } expect planar; } }";
    for (law, shapes) in [
        ("dissipation 0.2;", "disc.middle circle 0.03 -> follower circle 0.01"),
        ("restitution 0.6;", "disc.middle circle 0.03 -> follower circle 0.01"),
        ("restitution 0.6;", "disc profile outline -> follower circle 0.01"),
    ] {
        let text = disc(&outline(12), shapes).replace("HEIGHT", "0.0401").replace("dissipation 0.2;", law);
        let text = format!("{}{scene}", text.trim_end().strip_suffix('}').expect("a graph"));
        let graphs = graphs(&text);
        let [whole, flat] = ["Disc", "Flat"].map(|name| model(&graphs, name, &[]));
        assert!(flat.states() < 20 && whole.states() > 36, "{} {}", flat.states(), whole.states());
        for t in TIMES {
            let [whole, flat] = [&whole, &flat].map(|model| {
                let start = bg_model::dynamics::Machine::start(&**model).expect("a start");
                let finish = run(&**model, &start, t);
                outputs(&**model, finish.t, finish.x.as_slice(), &finish.negative)
            });
            let apart = [whole[0] - flat[0], whole[1] - flat[1], 1e-6 * (whole[2] - flat[2])];
            assert!(apart.iter().all(|apart| apart.abs() < 1e-9), "{shapes} {law}: {whole:?} {flat:?}");
        }
    }
}

#[test]
fn a_memory_that_leads_out_of_its_branch_is_a_hysteresis() {
    let text = "graph Tank {
        memory running: 1 = if tank.effort < 1.5 bar { 1 } else { 0 } while abs(tank.effort - 1.5 bar) > 0.3 bar;
        MSf pump = running * 1 l/s; 0 tank: hydraulic; C water = 1e-7 m^3/Pa; R drain = 5e8 Pa*s/m^3; \
        pump -> tank -> water; tank -> drain;
        observe { pressure: bar = tank.effort; running }
    }";
    // Time constant 50 s; up towards 5 bar, down towards 0.
    let rise = |from: f64, to: f64| 50.0 * ((5.0 - from) / (5.0 - to)).ln();
    let (first, up, down) = (rise(0.0, 1.8), rise(1.2, 1.8), 50.0 * (1.8_f64 / 1.2).ln());
    for (turns, part) in [(0.0, 0.3), (0.0, 0.7), (3.0, 0.3), (3.0, 0.9)] {
        let since = (up + down) * part;
        let (pressure, running) = if since < down {
            (1.8 * (-since / 50.0).exp(), 0.0)
        } else {
            (5.0 - 3.8 * (-(since - down) / 50.0).exp(), 1.0)
        };
        let found = after(text, &[first + turns * (up + down) + since]).remove(0);
        assert!((found[0] - pressure).abs() < 1e-9 && found[1] == running, "{found:?} {pressure} {running}");
    }
}

/// A ball of 0.1 m that rubs on what is below it, with a coefficient of 0.3 and a creep of 1 mm/s.
fn ball(contact: &str, start: &str) -> String {
    format!(
        "graph Ball {{
            gravity [0, -9.81, 0];
            ground {{ point floor = [0, 0, 0]; point below = [0, -0.2, 0]; }}
            body ball {{ mass 0.7; inertia [2.8e-3, 2.8e-3, 2.8e-3]; {start} }}
            contact touch ({contact}) {{ stiffness 1e4; damping 20; }}
            friction rub on touch {{ coulomb 0.3; creep 1 mm/s; }}
            observe {{ position: m = ball.position; velocity: m/s = ball.velocity; spin: rad/s = ball.angular_velocity;
                pressed: N = touch.pressed; force: N = touch.force;
                total: J = stored_energy + integral(dissipated_power) - integral(supplied_power) }}
        }}"
    )
}

#[test]
fn a_ball_that_slides_rolls_with_five_sevenths_of_its_speed() {
    // It begins at its depth of rest, slides askew and spins about all axes.
    let [vx, vz] = [2.0, 1.0];
    let [wx, wy, wz] = [-3.0, 5.0, -4.0];
    let height = 0.1 - 0.7 * 9.81 / 1e4;
    let start = format!(
        "start at [0, {height:?}, 0]; start velocity [{vx:?}, 0, {vz:?}]; start spin [{wx:?}, {wy:?}, {wz:?}];"
    );
    for contact in ["ground.floor plane y -> ball sphere 0.1", "ball sphere 0.1 -> ground.floor plane y"] {
        let found = after(&ball(contact, &start), &[0.0, 0.2, 2.0]);
        let [begin, sliding, rolling] = &found[..] else { panic!("three times") };
        // What slides is v + w x [0, -0.1, 0]. Its direction stays, since the force is along it and the ball is round.
        let slip = |at: &[f64]| [at[3] + 0.1 * at[8], at[5] - 0.1 * at[6]];
        let [first, later] = [begin, sliding].map(|at| slip(at));
        assert!((first[0] - (vx + 0.1 * wz)).abs() < 1e-12 && (first[1] - (vz - 0.1 * wx)).abs() < 1e-12);
        assert!((first[0] * later[1] - first[1] * later[0]).abs() < 1e-9, "{first:?} {later:?}");
        // Its size s changes by -7/2 0.3 g s / sqrt(s^2 + c^2): sqrt(s^2 + c^2) - c asinh(c / s) falls linearly.
        let creep = 1e-3_f64;
        let falls = |[x, z]: [f64; 2]| x.hypot(z).hypot(creep) - creep * (creep / x.hypot(z)).asinh();
        let apart = falls(first) - falls(later) - 3.5 * 0.3 * 9.81 * 0.2;
        assert!(apart.abs() < 1e-9, "{apart:e} m/s");
        // The moment of momentum about the place of contact stays, so it rolls with 5/7 of its speed and 2/7 of what
        // its surface had.
        let expected = [5.0 / 7.0 * (vx - 0.4 * 0.1 * wz), 5.0 / 7.0 * (vz + 0.4 * 0.1 * wx)];
        assert!((rolling[3] - expected[0]).abs() < 1e-9 && (rolling[5] - expected[1]).abs() < 1e-9, "{rolling:?}");
        let rolls = [-10.0 * expected[0], 10.0 * expected[1]];
        assert!((rolling[8] - rolls[0]).abs() < 1e-8 && (rolling[6] - rolls[1]).abs() < 1e-8, "{rolling:?}");
        assert!((rolling[7] - wy).abs() < 1e-9, "nothing turns it about the normal: {rolling:?}");
        assert!((rolling[9] - 0.7 * 9.81).abs() < 1e-9, "{rolling:?}");
        assert!((rolling.last().expect("outputs") - begin.last().expect("outputs")).abs() < 1e-9, "{rolling:?}");
    }
}

/// A ball of 0.1 m and 0.7 kg with a spring of 1e6 N/m by which it sticks, on a plane that falls by `slope` (rad) along
/// x.
fn on_a_slope(inertia: f64, slope: f64, more: &str) -> String {
    let (along, down) = (9.81 * slope.sin(), -9.81 * slope.cos());
    let height = if more.contains("velocity") { 0.2 } else { 0.1 + 0.7 * down / 1e4 };
    format!(
        "graph Ball {{
            gravity [{along:?}, {down:?}, 0]; ground {{ point floor = [0, 0, 0]; }}
            body ball {{ mass 0.7; inertia [{inertia:?}, {inertia:?}, {inertia:?}]; start at [0, {height:?}, 0]; \
            {more} }}
            contact touch (ground.floor plane y -> ball sphere 0.1) {{ stiffness 1e4; damping 20; }}
            friction rub on touch {{ coulomb 0.3; stiffness 1e6; viscous 500; }}
            observe {{ x: m = ball.position.x; v: m/s = ball.velocity.x; rub: N = rub.effort.x;
                total: J = stored_energy + integral(dissipated_power) - integral(supplied_power) }}
        }}"
    )
}

/// Below the slope 0.3 it stands and does not creep, above it slides with the friction that is said; a ball that can
/// turn rolls.
#[test]
fn what_touches_in_space_sticks_by_a_spring() {
    let found = after(&on_a_slope(1e12, 0.2, ""), &[0.1, 0.2]);
    let held = 0.7 * 9.81 * 0.2_f64.sin();
    for found in &found {
        assert!(found[1].abs() < 1e-12 && (found[2] - held).abs() < 1e-9, "{found:?}");
    }
    assert!((found[0][0] - found[1][0]).abs() < 1e-12 && found[0][0] < 1e-5, "{found:?}");
    // It slides with the friction and 500 N*s/m of oil: at the speed at which these hold it.
    let found = after(&on_a_slope(1e12, 0.4, ""), &[0.1]).remove(0);
    let friction = 0.3 * 0.7 * 9.81 * 0.4_f64.cos();
    let speed = (0.7 * 9.81 * 0.4_f64.sin() - friction) / 500.0;
    assert!((found[2] / friction - 1.0).abs() < 1e-8 && (found[1] / speed - 1.0).abs() < 1e-8, "{found:?} {speed}");
    // Its spring gives way by less than a millionth of a metre.
    let found = after(&on_a_slope(2.8e-3, 0.2, ""), &[0.0, 0.2]);
    let rolls = 5.0 / 7.0 * 9.81 * 0.2_f64.sin();
    assert!((found[1][1] / (0.2 * rolls) - 1.0).abs() < 1e-9, "{found:?} {rolls}");
    assert!((found[1][0] - 0.02 * rolls).abs() < 5e-7 && (found[1][3] - found[0][3]).abs() < 1e-9, "{found:?}");
    // Thrown askew it bounces, and rubs while it touches.
    let found = after(&on_a_slope(2.8e-3, 0.0, "start velocity [2, 0, 1]; start spin [3, 0, 5];"), &[0.0, 0.2]);
    assert!((found[1][3] - found[0][3]).abs() < 1e-8 && found[1][1] < 1.9, "{found:?}");
}

#[test]
fn a_ball_on_a_ball_in_a_plane_is_a_disc_on_a_disc() {
    let start = "start at [0.01, -1e-5, 0]; start velocity [0.1, 0, 0]; start spin [0, 0, 2];";
    let [disc, sphere] = ["circle", "sphere"].map(|shape| {
        after(&ball(&format!("ground.below {shape} 0.1 -> ball {shape} 0.1"), start), &[0.1, 0.25]).remove(1)
    });
    assert!(sphere[1] < -3e-3 && sphere[9] > 1.0, "it rolls down and is still pressed: {sphere:?}");
    for (sphere, disc) in sphere.iter().zip(&disc) {
        assert!((sphere - disc).abs() < 1e-9, "{sphere} {disc}");
    }
}

/// Crank, rod and slider of P. Flores, R. Leine, C. Glocker, Modeling and analysis of planar rigid multibody systems
/// with translational clearance joints based on the non-smooth dynamics approach, Multibody System Dynamics 23 (2010)
/// 165-190: dimensions, masses, clearance, restitution and start. Here the slider touches without friction by springs,
/// where theirs is rigid, and it turns at the start, so that its ends touch one after the other.
const LINKS: [f64; 2] = [0.153, 0.306];
const MASSES: [f64; 3] = [0.038, 0.038, 0.076];
const INERTIAS: [f64; 3] = [7.4e-5, 5.9e-4, 2.7e-6];
/// Stiffness of the slider, N/m^1.5; the root of ln((1 + x) / (1 - 0.4 x)) = 1.4 x.
const HERTZ: f64 = 1e8;
const RETURN: f64 = 2.082_498_164_147_007;
/// Half the slider's length, its play to each side, m.
const HALF: f64 = 0.05;
const GAP: f64 = 0.001;

/// Four corners touch: states are the three angles, their rates and the speed of approach of each corner.
struct Guided;

impl Guided {
    /// How far each corner's place is from its guide and how fast that changes; how it changes with the angles.
    fn corners(x: &[f64]) -> [(f64, f64, [f64; 3]); 4] {
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(end, side)| {
            let height = LINKS[0] * x[0].sin() + LINKS[1] * x[1].sin() + end * HALF * x[2].sin();
            let by = [LINKS[0] * x[0].cos(), LINKS[1] * x[1].cos(), end * HALF * x[2].cos()].map(|by| -side * by);
            (GAP - side * height, by[0] * x[3] + by[1] * x[4] + by[2] * x[5], by)
        })
    }
}

impl Dynamics for Guided {
    fn states(&self) -> usize {
        10
    }

    fn switches(&self) -> usize {
        4
    }

    fn guards(&self, _: f64, x: &[f64], _: &[bool], guards: &mut [f64]) {
        for (guard, corner) in guards.iter_mut().zip(Self::corners(x)) {
            *guard = corner.0;
        }
    }

    fn rate(&self, _: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let ([m1, m2, m3], [l1, l2]) = (MASSES, LINKS);
        let coupling = (m2 / 2.0 + m3) * l1 * l2;
        let (sin, cos) = (x[1] - x[0]).sin_cos();
        let mut moments = [
            coupling * sin * x[4] * x[4] - (m1 / 2.0 + m2 + m3) * 9.81 * l1 * x[0].cos(),
            -coupling * sin * x[3] * x[3] - (m2 / 2.0 + m3) * 9.81 * l2 * x[1].cos(),
            0.0,
        ];
        for (k, (gap, rate, by)) in Self::corners(x).into_iter().enumerate().filter(|(k, _)| negative[*k]) {
            let force = HERTZ * (-gap).max(0.0).powf(1.5) * (1.0 - RETURN * rate / x[6 + k]);
            for (moment, by) in moments.iter_mut().zip(by) {
                *moment += force.max(0.0) * by;
            }
        }
        let (m11, m12, m22) =
            (INERTIAS[0] + (m1 / 4.0 + m2 + m3) * l1 * l1, coupling * cos, INERTIAS[1] + (m2 / 4.0 + m3) * l2 * l2);
        let determinant = m11 * m22 - m12 * m12;
        dx[..6].copy_from_slice(&[
            x[3],
            x[4],
            x[5],
            (m22 * moments[0] - m12 * moments[1]) / determinant,
            (m11 * moments[1] - m12 * moments[0]) / determinant,
            moments[2] / INERTIAS[2],
        ]);
        dx[6..].fill(0.0);
    }

    fn project(&self, _: f64, negative: &[bool], x: &mut [f64]) {
        for (k, (_, rate, _)) in Self::corners(x).into_iter().enumerate().filter(|(k, _)| !negative[*k]) {
            // What touches slower than 1 cm/s counts as that fast, as the reference of the language says.
            x[6 + k] = 0.01 * (1.0 + (-rate / 0.01).powi(8)).powf(0.125);
        }
    }
}

fn guided(joint: &str) -> String {
    let ([l1, l2], [m1, m2, m3], [j1, j2, j3]) = (LINKS, MASSES, INERTIAS);
    let inertia = |about: f64| format!("inertia [{about:?}, {about:?}, {about:?}];");
    format!(
        "graph Guided {{
            gravity [0, -9.81, 0];
            ground {{ point O = [0, 0, 0]; }}
            body crank {{ mass {m1:?}; {} point O = [-{l1:?} / 2, 0, 0]; point A = [{l1:?} / 2, 0, 0];
                start O at [0, 0, 0]; start spin [0, 0, 150]; start velocity [0, 75 * {l1:?}, 0]; }}
            body rod {{ mass {m2:?}; {} point A = [-{l2:?} / 2, 0, 0]; point B = [{l2:?} / 2, 0, 0];
                start A at [{l1:?}, 0, 0]; start spin [0, 0, -75]; start velocity [0, 37.5 * {l2:?}, 0]; }}
            body slider {{ mass {m3:?}; {} start at [{l1:?} + {l2:?}, 0, 0]; start spin [0, 0, 2]; }}
            joint main: revolute z (ground.O -> crank.O) {{ rigid; }}
            joint big_end: revolute z (crank.A -> rod.A) {{ rigid; }}
            joint small_end: revolute z (rod.B -> slider) {{ rigid; }}
            joint guide: prismatic x (ground.O -> slider) {{ {joint} }}
            scene Flat {{
                observe {{ crank: rad = main.angle; rod: rad = rod.angle; slider: rad = slider.angle; \
                travel: m = guide.travel;
                    pressed: N = guide.pressed; force: N = guide.force.y;
                    total: J = stored_energy + integral(dissipated_power) - integral(supplied_power) }}
                expect planar;
            }}
        }}",
        inertia(j1),
        inertia(j2),
        inertia(j3)
    )
}

/// The outputs of the scene of a text after each of these times, s.
fn flat_after(text: &str, times: &[f64]) -> Vec<Vec<f64>> {
    let graphs = graphs(text);
    let flat = model(&graphs, "Flat", &[]);
    let start = bg_model::dynamics::Machine::start(&*flat).unwrap_or_else(|error| panic!("{error}"));
    let at = |&t: &f64| {
        let finish = run(&*flat, &start, t);
        outputs(&*flat, finish.t, finish.x.as_slice(), &finish.negative)
    };
    times.iter().map(at).collect()
}

#[test]
fn a_slider_rattles_in_its_guide() {
    let times = [0.002, 0.005, 0.01, 0.02];
    let law = "clearance 1 mm; length 100 mm; stiffness 1e8; exponent 1.5; restitution 0.4; tilt stiffness 0;";
    let found = flat_after(&guided(law), &[&[0.0], &times[..]].concat());
    let mut touched = 0;
    for (found_at, t) in found[1..].iter().zip(times) {
        let x = run(&Guided, &[0.0, 0.0, 0.0, 150.0, -75.0, 2.0, 0.01, 0.01, 0.01, 0.01], t).x;
        let place = LINKS[0] * x[0].cos() + LINKS[1] * x[1].cos();
        for (found, expected) in found_at.iter().zip([x[0], x[1], x[2], place]) {
            assert!((found - expected).abs() < 1e-7, "{t} s: {found} {expected}");
        }
        // At one end it has met its guide: it does not turn as it did.
        touched += usize::from((x[5] - 2.0).abs() > 0.1);
        let total = found_at.last().expect("outputs") - found[0].last().expect("outputs");
        assert!(total.abs() < 1e-9, "{total:e} J");
    }
    assert!(touched > 1, "it meets its guide: {found:?}");
}

#[test]
fn a_slider_without_a_length_is_pushed_back_at_its_end_and_stays_upright() {
    // Within the play it falls; then it is a mass on a spring with a damper.
    let text = |joint: &str, more: &str| {
        format!(
            "graph Falls {{
                gravity [0, -9.81, 0];
                ground {{ point O = [0, 0, 0]; }}
                body slider {{ mass 0.5; inertia [1e-3, 1e-3, 1e-3]; start at [0.3, 0, 0]; start velocity [0.2, 0, 0]; \
                }}
                joint guide: prismatic x (ground.O -> slider) {{ {joint} tilt stiffness 1e3; tilt damping 1; }}
                {more}
                observe {{ travel: m = guide.travel; height: m = slider.position.y; pressed: N = guide.pressed }}
            }}"
        )
    };
    let joint = "clearance 2 mm; stiffness 1e4; damping 40;";
    let until = (2.0 * 2e-3 / 9.81_f64).sqrt();
    let law = |t: f64| {
        // From 2 mm on with its speed: m y'' = m g - k y - c y'.
        let (s, w) = (40.0, (1e4 / 0.5 - 40.0_f64.powi(2)).sqrt());
        let (rest, speed) = (0.5 * 9.81 / 1e4, 9.81 * until);
        let (a, b) = (-rest, (speed - s * rest) / w);
        -2e-3 - rest - (-s * t).exp() * (a * (w * t).cos() + b * (w * t).sin())
    };
    let found = after(&text(joint, ""), &[0.9 * until, until + 0.01]);
    assert!((found[0][1] + 0.5 * 9.81 * (0.9 * until).powi(2)).abs() < 1e-12 && found[0][2] == 0.0, "{found:?}");
    assert!((found[1][1] - law(0.01)).abs() < 1e-10 && found[1][2] > 1.0, "{found:?} {}", law(0.01));
    assert!((found[1][0] - 0.3 - 0.2 * (until + 0.01)).abs() < 1e-10, "{found:?}");
    // With a length it does the same at both ends, and what acts along it finds its junction.
    let joint = "clearance 2 mm; length 0.1; stiffness 5e3; damping 20;";
    let pushed = after(&text(joint, "drive push on guide force = 0.25;"), &[until + 0.01]).remove(0);
    assert!((pushed[1] - found[1][1]).abs() < 1e-10 && (pushed[2] - found[1][2]).abs() < 1e-7, "{pushed:?} {found:?}");
    let way = 0.3 + 0.2 * (until + 0.01) + 0.25 * (until + 0.01).powi(2);
    assert!((pushed[0] - way).abs() < 1e-10, "{pushed:?} {way}");
}

#[test]
fn a_pin_with_play_takes_the_laws_of_contacts() {
    let found = ["", "joint"].map(|joint| {
        let law = "stiffness 6.61e10; exponent 1.5; restitution 0.9;";
        let pin = if joint.is_empty() {
            format!("contact pin (slider hole 10 mm -> rod.B circle 9.5 mm) {{ {law} }}")
        } else {
            format!("joint pin: revolute z (slider -> rod.B) {{ clearance 0.5 mm; {law} tilt stiffness 0; }}")
        };
        after(&slider(&pin), &[0.003]).remove(0)
    });
    for (joint, contact) in found[1].iter().zip(&found[0]) {
        assert!((joint - contact).abs() < 1e-9, "{found:?}");
    }
}
