//! Stops with a restitution: impacts against closed forms, by every integrator; rest, release, many at once.

use crate::random::random_numbers;
use std::rc::Rc;

use bg_model::bond_graph;
use bg_model::dynamics::{Machine, shared};
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::run::Simulation;
use bg_model::simulation::{Observer, Settings, Span, Switching, drive, integrate};
use bg_model::system::Model;

bond_graph! {
    /// A ball that falls on a floor.
    graph Ball {
        param mass: kg = 2, above 0;
        param height: m = 1.25;
        param speed: m/s = 0;
        param give: 1 = 0.8;
        param lift: N/s = 0;
        let weight: N = mass * 9.81;
        1 fall: translation; I ball = mass start mass * speed; MSe load = lift * t - weight; load -> fall -> ball;
        stop floor on fall { at least 0; start height; restitution give; }
        observe {
            y: m = floor.place; v: m/s = fall.flow; floor.effort; stored: J = stored_energy;
            supplied: J = integral(supplied_power); lost: J = integral(dissipated_power);
            impulse: N*s = integral(floor.effort)
        }
    }
    /// Two rods in a chain; the upper one swings against a stop.
    graph Chain {
        param give: 1 = 0.6;
        param spin: rad/s = 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body upper { mass 2; inertia [0.05, 0.05, 0.05]; point a = [-0.3, 0, 0]; point b = [0.4, 0, 0];
            start a at [0, 0, 0]; }
        body lower { mass 1; inertia [0.02, 0.02, 0.02]; point b = [-0.2, 0, 0]; start b at [0.7, 0, 0];
            start turned rotation_z(guess(-0.5)); start velocity [guess(0), guess(0), 0]; start spin [0, 0, spin]; }
        joint shoulder: revolute z (ground.O -> upper.a) { rigid; }
        joint elbow: revolute z (upper.b -> lower.b) { rigid; }
        stop bumper on shoulder { at least -1.2; restitution give; }
        observe {
            angle: rad = shoulder.angle; other: rad = lower.angle; w1: rad/s = shoulder.speed;
            w2: rad/s = lower.angular_velocity.z;
            slip: m/s = norm(elbow.slip.flow); stored: J = stored_energy; supplied: J = integral(supplied_power);
            lost: J = integral(bumper.power); impulse: N*m*s = integral(bumper.effort);
            pull: N*s = integral(elbow.force.x)
        }
        scenes only;
        scene Chain { expect planar; }
        /// By its angles.
        scene Flat { expect planar; angles; }
    }
    /// A slider and a crank, a closed loop; the slider hits both ends of its guide.
    graph Loop {
        param give: 1 = 0.7;
        ground { point O = [0, 0, 0]; }
        body crank { mass 1; inertia [0.02, 0.02, 0.02]; point a = [-0.1, 0, 0]; point b = [0.1, 0, 0];
            start a at [0, 0, 0]; start turned rotation_z(1); start velocity [guess(0), guess(0), 0];
            start spin [0, 0, -8]; }
        body rod { mass 0.5; inertia [0.01, 0.01, 0.01]; point b = [-0.3, 0, 0]; point c = [0.3, 0, 0];
            start b at [0.2 * cos(1), 0.2 * sin(1), 0]; start turned rotation_z(guess(-0.3));
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, guess(0)]; }
        body slider { mass 0.7; inertia [0.01, 0.01, 0.01]; start at [guess(0.7), 0, 0];
            start velocity [guess(0), guess(0), 0]; }
        joint pin_o: revolute z (ground.O -> crank.a) { rigid; }
        joint pin_a: revolute z (crank.b -> rod.b) { rigid; }
        joint pin_b: revolute z (rod.c -> slider) { rigid; }
        joint guide: prismatic x (ground.O -> slider) { rigid; }
        stop ends on guide { at most 0.77; at least 0.5; restitution give; }
        observe {
            x: m = guide.travel; v: m/s = slider.velocity.x; slip: m/s = norm(pin_a.slip.flow);
            stored: J = stored_energy;
            lost: J = integral(dissipated_power); impulse: N*s = integral(ends.effort)
        }
        scenes only;
        scene Loop { expect planar; }
    }
    /// A flywheel behind a gear, whose inertia is in derivative causality.
    graph Geared {
        Se torque = 0.5; 1 shaft: rotation; I rotor = 1e-3; TF gear = 0.25; 1 hub: rotation; I wheel = 0.02;
        torque -> shaft -> rotor; shaft -> gear -> hub -> wheel;
        stop catch on hub { at most 2; restitution 0.5; rest below 1e-3; }
        observe { place: rad = catch.place; hub: rad/s = hub.flow; shaft: rad/s = shaft.flow;
            impulse: N*m*s = integral(catch.effort); catch.effort }
    }
    /// A bar on two supports under its ends.
    graph Bar {
        param give: 1 = 0.5;
        param height: m = 0.1;
        param tilt: rad = 0;
        param reach: m = 0.5;
        param fall: m/s = 0;
        param turn: rad/s = 0;
        param lift: N = 0;
        param twist: N*m = 0;
        param slow: m/s = 0.05;
        let weight: N = 2 * 9.81;
        // Both act where it does not fall, and by less than rounding where it falls at 2 m/s.
        MSe load = lift * exp(-(heave.flow / slow) * (heave.flow / slow)) - weight;
        MSe tilting = twist * exp(-(heave.flow / slow) * (heave.flow / slow));
        1 heave: translation; 1 pitch: rotation; I mass = 2 start 2 * fall; I moment = 0.1 start 0.1 * turn;
        load -> heave -> mass; tilting -> pitch -> moment;
        TF arm_a = reach; TF arm_b = -reach; 0 sum_a, sum_b: translation; 1 a, b: translation;
        heave -> sum_a -> a; pitch -> arm_a -> sum_a; heave -> sum_b -> b; pitch -> arm_b -> sum_b;
        stop left on a { at least 0; start height + reach * tilt; restitution give; }
        stop right on b { at least 0; start height - reach * tilt; restitution give; }
        observe {
            ya: m = left.place; yb: m = right.place; va: m/s = a.flow; vb: m/s = b.flow;
            la: N*s = integral(left.effort); lb: N*s = integral(right.effort);
            left.effort; right.effort; stored: J = stored_energy; supplied: J = integral(supplied_power);
            lost: J = integral(dissipated_power)
        }
    }
    /// Three masses in a row, each of which may hit the next.
    graph Cradle {
        param give: 1 = 1;
        param gap: m = 0.01;
        1 a, b, c: translation; I ma = 1 start 3; I mb = 1; I mc = 1; a -> ma; b -> mb; c -> mc;
        0 ab, bc: translation; 1 sab, sbc: translation; a -> ab -> b; ab -> sab; b -> bc -> c; bc -> sbc;
        stop first on sab { at most 0.1; restitution give; }
        stop second on sbc { at most gap; restitution give; }
        observe { va: m/s = a.flow; vb: m/s = b.flow; vc: m/s = c.flow; stored: J = stored_energy;
            lost: J = integral(dissipated_power) }
    }
    /// A block on a contact's line.
    graph Line {
        ground { point O = [0, 0, 0]; }
        body block { mass 3; inertia [0.1, 0.1, 0.1]; start velocity [-2, 0, 0]; }
        joint guide: prismatic x (ground.O -> block) { rigid; }
        contact plate (block -> ground along x) { x: R = 0; }
        stop end on plate { at most 0.5; at least -0.5; restitution 0.5; }
        observe { x: m = guide.travel; v: m/s = block.velocity.x }
    }
    /// Three masses on a floor, springs, friction and stops between them, drawn to and fro.
    graph Train {
        param m1: kg = 1, above 0; param m2: kg = 1, above 0; param m3: kg = 1, above 0;
        param k1: N/m = 10, at least 0; param k2: N/m = 10, at least 0;
        param f1: N = 1, at least 0; param f2: N = 1, at least 0; param f3: N = 1, at least 0;
        param g1: N = 1, at least 0;
        param e1: 1 = 0.5, at least 0, at most 1; param e2: 1 = 0.5, at least 0, at most 1;
        param e3: 1 = 0, at least 0, at most 1;
        param push: N = 4; param frequency: rad/s = 2; param v1: m/s = 0; param v3: m/s = 0;
        1 a, b, c: translation; I ma = m1 start m1 * v1; I mb = m2; I mc = m3 start m3 * v3;
        MSe pull = push * sin(frequency * t);
        R ra(v) = f1 holds f1; R rb(v) = f2 holds f2; R rc(v) = f3 + 0.1 * v holds f3;
        0 ab, bc: translation; 1 sab, sbc: translation;
        C kab = k1; C kbc = k2; R gab(v) = g1 holds g1;
        pull -> a -> ma; a -> ra; b -> mb; b -> rb; c -> mc; c -> rc;
        a -> ab -> b -> bc -> c; ab -> sab -> kab; sab -> gab; bc -> sbc -> kbc;
        stop between on sab { at most 0.1; at least -0.1; restitution e1; }
        stop coupling on sbc { at most 0.05; restitution e2; }
        stop wall on c { at most 0.2; at least -0.2; restitution e3; }
        observe {
            stored: J = stored_energy; supplied: J = integral(supplied_power); lost: J = integral(dissipated_power);
            between: m = between.place; coupling: m = coupling.place; wall: m = wall.place
        }
    }
}

/// The changes of branches and impacts: when, the outputs before and after, the switch.
type Impacts = Vec<(f64, Vec<f64>, Vec<f64>, usize)>;

/// Takes down the outputs before and after each event, and those after the first jump of the state.
struct Events {
    model: Rc<dyn Machine>,
    last: Vec<f64>,
    found: Impacts,
    jumped: Option<Vec<f64>>,
}

impl Observer for Events {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        self.last = outputs(&*self.model, t, x, negative);
    }

    fn event(&mut self, t: f64, x: &[f64], switch: usize, negative: &[bool]) {
        self.found.push((t, self.last.clone(), outputs(&*self.model, t, x, negative), switch));
    }

    fn switched(&mut self, Switching { after, negative_after, jumps, .. }: &Switching) {
        if *jumps && self.jumped.is_none() {
            self.jumped = Some(outputs(&*self.model, after.t, after.x.as_slice(), negative_after));
        }
    }
}

fn outputs(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<f64> {
    let mut y = vec![0.0; model.description().outputs.len()];
    model.outputs(t, x, negative, &mut y);
    y
}

/// The outputs where a run comes to until `end` (s), and its events.
fn run<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    integrator: Integrator,
    end: f64,
) -> (Vec<f64>, Impacts)
where
    Mo: Model<f64, N, G, M> + Clone + 'static,
{
    let (last, events) = run_within(model, integrator, end, Tolerances::new(1e-10, 1e-11));
    (last, events.found)
}

/// The outputs where a run comes to until `end` (s), and what happens in it.
fn run_within<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    integrator: Integrator,
    end: f64,
    tolerances: Tolerances,
) -> (Vec<f64>, Events)
where
    Mo: Model<f64, N, G, M> + Clone + 'static,
{
    let settings = Settings { tolerances, step_limit: 100_000, ..Settings::default() };
    let mut method: AnyMethod = integrator.method(1e-3);
    let machine = shared(model.clone());
    let mut events = Events { model: Rc::clone(&machine), last: Vec::new(), found: Vec::new(), jumped: None };
    let start = machine.start().expect("a start");
    let span = Span { t0: 0.0, t_end: end };
    let finish = drive(&*machine, &mut method, &start, span, &settings, None, &mut events);
    let finish = finish.unwrap_or_else(|failure| panic!("{}: {failure}", integrator.name()));
    (outputs(&*events.model, finish.t, finish.x.as_slice(), &finish.negative), events)
}

/// What times and places may be off; a method of order 2 with fixed steps follows no tolerance.
fn bound(integrator: Integrator) -> f64 {
    if integrator == Integrator::Ros2 { 1e-4 } else { 1e-8 }
}

fn ball(give: f64) -> Ball {
    Ball::new(BallParameters { give, ..Default::default() }).expect("in range")
}

/// Falls for v / g, then the k-th bounce begins with e^k v and takes 2 e^k v / g: at rest after v / g (1 + e) / (1 -
/// e).
#[test]
fn a_ball_bounces_at_the_instants_of_its_closed_form_and_comes_to_rest() {
    let (gravity, height): (f64, f64) = (9.81, 1.25);
    let speed = (2.0 * gravity * height).sqrt();
    for integrator in Integrator::ALL {
        for give in [0.8_f64, 0.5, 0.0] {
            let end = speed / gravity * (1.0 + give) / (1.0 - give);
            let (last, events) = run(&ball(give), integrator, end + 1.0);
            let name = integrator.name();
            let (mut t, mut back) = (speed / gravity, speed);
            for (k, (at, before, after, _)) in events.iter().enumerate() {
                assert!((at - t).abs() < 1e-11, "{name} {give} {k}: {at} {t}");
                assert!((before[1] + back).abs() < 1e-11, "{name} {give} {k}: {before:?} {back}");
                back *= if k + 1 < events.len() { give } else { 0.0 };
                assert!(
                    (after[1] - back).abs() < 1e-11 && after[0].abs() < 1e-12,
                    "{name} {give} {k}: {after:?} {back}"
                );
                t += 2.0 * back / gravity;
            }
            let (rest, slow, ..) = events.last().expect("an impact");
            // What is left where it comes to rest rises less than 1e-12 m: a hundredth of the tolerance.
            let left = 2.0 * give * slow[1].abs() / gravity / (1.0 - give);
            assert!((rest + left - end).abs() < 1e-10, "{name} {give}: {rest} {end}");
            assert!(left < 1e-5, "{name} {give}: {left:e}");
            let weight = 2.0 * gravity;
            assert!(
                last[0].abs() + last[1].abs() < 1e-13 && (last[2] + weight).abs() < 1e-12,
                "{name} {give}: {last:?}"
            );
            assert!((last[5] - weight * height).abs() < 1e-9, "{name} {give}: {last:?}");
            assert!((last[3] - last[4] + last[5]).abs() < 1e-9, "{name} {give}: {last:?}");
            // The momentum is 0 again, so the floor has taken the weight's impulse.
            assert!((last[6] + weight * (end + 1.0)).abs() < 1e-9, "{name} {give}: {last:?}");
        }
    }
}

#[test]
fn a_hundred_elastic_bounces_keep_the_energy() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step()) {
        let flight = 2.0 * f64::sqrt(2.0 * 1.25 / 9.81);
        let (last, events) = run(&ball(1.0), integrator, 100.0 * flight);
        let energy = 24.525;
        assert_eq!(events.len(), 100, "{}", integrator.name());
        for (at, before, after, _) in &events {
            let kinetic = |y: &[f64]| y[1] * y[1];
            let name = integrator.name();
            assert!((kinetic(after) - energy).abs() < 1e-10 * energy, "{name} {at}: {:e}", kinetic(after) - energy);
            assert!(
                kinetic(before).to_bits() == kinetic(after).to_bits() || (before[3] - after[3]).abs() < 1e-14,
                "{name}"
            );
        }
        assert!(last[5].abs() < 1e-12, "{}: {last:?}", integrator.name());
    }
}

#[test]
fn what_rests_leaves_when_the_load_reverses() {
    for integrator in Integrator::ALL {
        let model = Ball::new(BallParameters { give: 0.3, height: 0.05, lift: 10.0, ..Default::default() });
        let (last, events) = run(&model.expect("in range"), integrator, 4.0);
        let (leaves, pressed, ..) = events.last().expect("it leaves");
        let name = integrator.name();
        assert!((leaves - 1.962).abs() < 1e-9 && pressed[2].abs() < 1e-7, "{name}: {leaves} {pressed:?}");
        // 10 (t - 1.962) N on 2 kg.
        let late: f64 = 4.0 - 1.962;
        assert!((last[1] - 2.5 * late * late).abs() < bound(integrator), "{name}: {last:?}");
        assert!((last[0] - 2.5 / 3.0 * late.powi(3)).abs() < bound(integrator), "{name}: {last:?}");
    }
}

/// M(q) of both rods by their angles: J = [1, 0], so that L = -(1 + e) v / (M^-1)_11, and the rates jump by M^-1 J^T L.
#[test]
fn a_chain_of_rigid_joints_is_hit_as_its_mass_matrix_says() {
    let check = |name: &str, give: f64, events: &Impacts| {
        assert!(events.len() > 3, "{name}: {}", events.len());
        for (at, before, after, _) in events.iter().take(8) {
            let (upper, lower) = (0.05 + 2.0 * 0.09 + 0.49, 0.02 + 0.04);
            let coupling = 0.7 * 0.2 * libm::cos(before[0] - before[1]);
            let determinant = upper * lower - coupling * coupling;
            let impulse = -(1.0 + give) * before[2] * determinant / lower;
            let expected = [before[2] + impulse * lower / determinant, before[3] - impulse * coupling / determinant];
            assert!((before[0] + 1.2).abs() < 1e-8, "{name} {at}: {before:?}");
            assert!((after[2] + give * before[2]).abs() < 1e-10, "{name} {at}: {after:?}");
            for (k, expected) in expected.into_iter().enumerate() {
                assert!((after[2 + k] - expected).abs() < 1e-7, "{name} {at} {k}: {after:?} {expected}");
            }
            // The rods stay together; the stop takes just what is lost.
            assert!(after[4] < 1e-9, "{name} {at}: {after:?}");
            let taken = after[7] - before[7];
            assert!((before[5] - after[5] - taken).abs() < 1e-9, "{name} {at}: {before:?} {after:?}");
            assert!(
                (taken - 0.5 * (1.0 - give) * impulse.abs() * before[2].abs()).abs() < 1e-7,
                "{name} {at}: {taken}"
            );
            assert!((after[8] - before[8] + impulse).abs() < 1e-7, "{name} {at}: {after:?} {impulse}");
            // What the elbow gives changes the lower rod's momentum.
            let moved = -0.2 * libm::sin(before[1]) * (after[3] - before[3])
                - 0.7 * libm::sin(before[0]) * (after[2] - before[2]);
            assert!((after[9] - before[9] - moved).abs() < 1e-7, "{name} {at}: {after:?} {moved}");
        }
    };
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step()) {
        for give in [0.6, 1.0] {
            let chain = Chain::new(ChainParameters { give, spin: 0.0 }).expect("in range");
            let (last, events) = run(&chain, integrator, 3.0);
            check(integrator.name(), give, &events);
            assert!((last[5] - last[6] + last[7]).abs() < 1e-6, "{}: {last:?}", integrator.name());
            let flat = Flat::new(FlatParameters { give, spin: 0.0 }).expect("in range");
            let (last, events) = run(&flat, integrator, 3.0);
            check(integrator.name(), give, &events);
            assert!((last[5] - last[6] + last[7]).abs() < 1e-6, "{}: {last:?}", integrator.name());
        }
    }
}

#[test]
fn a_closed_loop_of_rigid_joints_stays_closed_when_it_is_hit() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step()) {
        let model = Loop::new(LoopParameters::default()).expect("in range");
        let (last, events) = run(&model, integrator, 4.0);
        let name = integrator.name();
        assert!(events.len() > 4, "{name}: {}", events.len());
        let start = events[0].1[3];
        for (at, before, after, _) in &events {
            let end = if before[1] > 0.0 { 0.77 } else { 0.5 };
            assert!((before[0] - end).abs() < 1e-9 && after[2] < 1e-9, "{name} {at}: {before:?} {after:?}");
            assert!((after[1] + 0.7 * before[1]).abs() < 1e-9, "{name} {at}: {before:?} {after:?}");
            let taken = 0.5 * (after[5] - before[5]) * (before[1] + after[1]);
            assert!((before[3] - after[3] - taken).abs() < 1e-9, "{name} {at}: {before:?} {after:?} {taken}");
        }
        assert!((last[3] + last[4] - start).abs() < 1e-7 * start, "{name}: {last:?} {start}");
    }
}

/// 0.02 kg m^2 and 16 times the rotor behind the gear.
#[test]
fn a_storage_in_derivative_causality_takes_part() {
    let inertia = 0.02 + 16.0 * 1e-3;
    for integrator in Integrator::ALL {
        let model = Geared::new(GearedParameters::default()).expect("in range");
        let (last, events) = run(&model, integrator, 20.0);
        let (at, before, after, _) = &events[0];
        let (load, name) = (2.0 / inertia, integrator.name());
        let speed = f64::sqrt(2.0 * load * 2.0);
        assert!((at - speed / load).abs() < 1e-9 && (before[1] - speed).abs() < 1e-9, "{name}: {at} {before:?}");
        assert!((after[1] + 0.5 * speed).abs() < 1e-9 && (after[2] + 2.0 * speed).abs() < 1e-8, "{name}: {after:?}");
        assert!((after[3] - before[3] - 1.5 * speed * inertia).abs() < 1e-9, "{name}: {after:?}");
        // It rests from the bounce that would begin below 1e-3 rad/s on.
        let bounces = (speed / 1e-3).log2().ceil() as usize;
        assert_eq!(events.len(), bounces, "{name}");
        // The reaction draws what an impact leaves of the speed to zero within some seconds. One step of the series is
        // longer than that and errs by a part of the tolerance: 1e-11 of the rotor's momentum is 2.5e-9 rad/s of the
        // hub, for which the reaction gives 2e-10 N m.
        let [speed, effort] = if integrator == Integrator::Taylor { [2.5e-9, 2e-10] } else { [1e-13, 1e-12] };
        assert!(last[1].abs() < speed && (last[4] - 2.0).abs() < effort, "{name}: {last:?}");
    }
}

/// A coarse run rests from the same bounce on.
#[test]
fn a_stop_that_says_when_something_rests_does_not_ask_the_tolerances() {
    let model = Geared::new(GearedParameters::default()).expect("in range");
    let [fine, coarse] = [1e-10, 1e-4].map(|rtol| {
        let (_, events) = run_within(&model, Integrator::Dop853, 20.0, Tolerances::new(rtol, 0.1 * rtol));
        events.found.len()
    });
    assert!(fine == coarse && fine > 10, "{fine} {coarse}");
}

#[test]
fn two_stops_at_once_give_back_both() {
    for integrator in Integrator::ALL {
        let model = Bar::new(BarParameters::default()).expect("in range");
        let (last, events) = run(&model, integrator, 3.0);
        let (name, speed) = (integrator.name(), f64::sqrt(2.0 * 9.81 * 0.1));
        let (before, after) = (&events[0].1, &events[0].2);
        assert!((before[2] + speed).abs() < 1e-10, "{name}: {before:?}");
        for k in [2, 3] {
            assert!((after[k] - 0.5 * speed).abs() < 1e-10, "{name}: {after:?}");
            assert!((after[k + 2] - before[k + 2] + 1.5 * speed).abs() < 1e-10, "{name}: {after:?}");
        }
        assert!((last[6] + 9.81).abs() < 1e-11 && (last[7] + 9.81).abs() < 1e-11, "{name}: {last:?}");
        assert!((last[8] - last[9] + last[10]).abs() < 1e-10, "{name}: {last:?}");
    }
}

/// It turns about the end on which it rests until the other end comes down, e = 0. That impulse L throws up the first
/// end by (1 / m - a^2 / J) L, or presses it down where that is negative.
#[test]
fn an_end_that_rests_stays_or_is_thrown_up() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step()) {
        for reach in [0.1, 0.5] {
            let parameters = BarParameters { give: 0.0, height: reach * 0.1, tilt: -0.1, reach, ..Default::default() };
            let (last, events) = run(&Bar::new(parameters).expect("in range"), integrator, 5.0);
            let name = integrator.name();
            let (_, before, after, _) =
                events.iter().find(|event| event.1[1] < 1e-9).expect("the other end comes down");
            assert!(before[2].abs() < 1e-12 && before[3] < -0.1, "{name} {reach}: {before:?}");
            assert!(after[3].abs() < 1e-12, "{name} {reach}: {after:?}");
            let (own, other) = (0.5 + reach * reach / 0.1, 0.5 - reach * reach / 0.1);
            let expected = -before[3] / own * other.max(0.0);
            assert!((after[2] - expected).abs() < 1e-10, "{name} {reach}: {before:?} {after:?} {expected}");
            assert!(last[2].abs() + last[3].abs() < 1e-9, "{name} {reach}: {last:?}");
            assert!((last[6] + 9.81).abs() < 1e-9 && (last[7] + 9.81).abs() < 1e-9, "{name} {reach}: {last:?}");
            assert!((last[8] - last[9] + last[10]).abs() < 1e-9, "{name} {reach}: {last:?}");
        }
    }
}

/// With 1 / m + a^2 / J = 0.6 and 1 / m - a^2 / J = 0.4 the left end's impulse, 1.5 * 4 / 0.6, throws the right end up
/// from -1 to 3: faster than its own restitution asks, so that its support has nothing to give.
#[test]
fn several_stops_give_no_impulse_that_pulls() {
    let parameters = BarParameters { height: 0.0, reach: 0.1, fall: -2.5, turn: -15.0, ..Default::default() };
    let model = Bar::new(parameters).expect("in range");
    let run = Simulation::new(&model).every(1e-3).until(1e-3).run().expect("a run");
    for (name, expected) in [("va", 2.0), ("vb", 3.0), ("la", -10.0), ("lb", 0.0)] {
        assert!((run[name][0] - expected).abs() < 1e-12, "{name}: {} {expected}", run[name][0]);
    }
}

/// It comes down flat and without a rebound, and then is lifted and turned: the efforts l of the supports and the
/// accelerations b towards them without any obey A l = b, where 3 is on A's diagonal and -2 beside it, or b is not
/// above 0 where l is 0.
#[test]
fn of_several_stops_those_bear_the_load_that_do_not_pull() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step()) {
        let name = integrator.name();
        let landed = |lift: f64, twist: f64| {
            let parameters = BarParameters { give: 0.0, fall: -2.0, lift, twist, ..Default::default() };
            let model = Bar::new(parameters).expect("in range");
            // What follows at once would put right what the impact leaves wrong, by a step that is none.
            let (_, Events { jumped, .. }) = run_within(&model, integrator, 0.1, Tolerances::new(1e-10, 1e-11));
            let after = jumped.expect("an impact");
            assert!(after[2].abs() + after[3].abs() < 1e-12, "{name}: {after:?}");
            // The supports press in the direction of what leaves.
            [-after[6], -after[7]]
        };
        // b = 9.81, 9.81; then the left one would pull by 4.9 N, and the right one bears (9.81 + 73.575) / 3 alone; the
        // same the other way. Lifted by 1 m/s^2 and turned by 4 rad/s^2, b = -3, 1: both would pull; without the right
        // one the left one would; without both the right one is moved towards, and bears 1 / 3.
        for (lift, twist, expected) in [
            (0.0, 0.0, [9.81, 9.81]),
            (0.0, 14.715, [0.0, 27.795]),
            (0.0, -14.715, [27.795, 0.0]),
            (21.62, 0.4, [0.0, 1.0 / 3.0]),
            (21.62, -0.4, [1.0 / 3.0, 0.0]),
        ] {
            let found = landed(lift, twist);
            let is_close = |k: usize| (found[k] - expected[k]).abs() < 1e-9;
            assert!(is_close(0) && is_close(1), "{name} {lift} {twist}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn speed_goes_through_a_row_of_masses() {
    for integrator in Integrator::ALL {
        let run_with = |give: f64| {
            let model = Cradle::new(CradleParameters { give, ..Default::default() }).expect("in range");
            run(&model, integrator, 1.0)
        };
        let name = integrator.name();
        let (last, events) = run_with(1.0);
        assert_eq!(events.len(), 2, "{name}");
        for (found, expected) in last.iter().zip([0.0, 0.0, 3.0, 4.5, 0.0]) {
            assert!((found - expected).abs() < 1e-10, "{name}: {last:?}");
        }
        let (last, events) = run_with(0.5);
        // 3, 0, 0; 0.75, 2.25, 0; 0.75, 0.5625, 1.6875; then the first catches up.
        assert_eq!(events.len(), 3, "{name}");
        assert!((last[0] - 0.609375).abs() + (last[1] - 0.703125).abs() < 1e-10, "{name}: {last:?}");
        assert!((last[2] - 1.6875).abs() < 1e-10 && (last[3] + last[4] - 4.5).abs() < 1e-10, "{name}: {last:?}");
        let (last, _) = run_with(0.0);
        assert!(last[..3].iter().all(|v| (v - 1.0).abs() < 1e-10), "{name}: {last:?}");
    }
}

#[test]
fn a_contact_s_line_has_stops() {
    for integrator in Integrator::ALL {
        let (_, events) = run(&Line::new(LineParameters::default()).expect("in range"), integrator, 3.0);
        let (name, mut t, mut speed) = (integrator.name(), 0.25, 2.0);
        for (at, _, after, _) in &events {
            assert!((at - t).abs() < 1e-9 && (after[0].abs() - 0.5).abs() < 1e-9, "{name}: {at} {t} {after:?}");
            speed *= 0.5;
            assert!((after[1].abs() - speed).abs() < 1e-9, "{name}: {after:?}");
            t += 1.0 / speed;
        }
        assert_eq!(events.len(), 2, "{name}");
    }
}

#[test]
fn trains_with_stops_and_friction_run_on_and_keep_their_energy() {
    let mut next = random_numbers(2026);
    let mut impacts = 0;
    for case in 0..120 {
        let mut some = |size: f64| if next() < 0.25 { 0.0 } else { size * next() };
        let [f1, f2, f3, g1] = std::array::from_fn(|_| 0.01 + some(2.0));
        let (k1, k2, push, v1, v3) = (some(50.0), some(50.0), some(8.0), some(2.0), -some(2.0));
        let [m1, m2, m3] = std::array::from_fn(|_| 0.2 + some(2.0));
        let [e1, e2, e3] = std::array::from_fn(|_| some(0.95));
        let frequency = 0.5 + some(5.0);
        let parameters = TrainParameters { m1, m2, m3, k1, k2, f1, f2, f3, g1, e1, e2, e3, push, frequency, v1, v3 };
        let model = Train::new(parameters.clone()).expect("in range");
        let integrator = [Integrator::Dop853, Integrator::Auto, Integrator::Bs5, Integrator::Radau5][case % 4];
        let (last, events) = run(&model, integrator, 10.0);
        let start = 0.5 * (m1 * v1 * v1 + m3 * v3 * v3);
        let balance = last[0] - start - last[1] + last[2];
        assert!(balance.abs() < 1e-7 * (1.0 + last[2]), "{case}: {balance:e} {last:?} {parameters:?}");
        for (at, before, ..) in &events {
            let beyond = (before[3].abs() - 0.1).max(before[4] - 0.05).max(before[5].abs() - 0.2);
            assert!(beyond < 1e-8, "{case} {at}: {beyond:e} {parameters:?}");
        }
        impacts += events.len();
    }
    assert!(impacts > 10_000, "there was something to do: {impacts}");
}

/// On the floor at the start: at rest it rests, thrown up it leaves, thrown down it is hit at once.
#[test]
fn a_start_at_the_end_is_decided_by_the_speed() {
    for integrator in Integrator::ALL {
        let name = integrator.name();
        let from = |speed: f64, height: f64| {
            let model = Ball::new(BallParameters { height, speed, ..Default::default() }).expect("in range");
            run(&model, integrator, 0.1)
        };
        let (last, events) = from(0.0, 0.0);
        assert!(events.is_empty() && last[1].abs() < 1e-15 && (last[2] + 19.62).abs() < 1e-12, "{name}: {last:?}");
        for speed in [2.0, -2.5] {
            let (last, events) = from(speed, 0.0);
            assert!(events.is_empty() && (last[1] - 2.0 + 0.981).abs() < 1e-9, "{name} {speed}: {last:?}");
        }
        // Closed to rounding only.
        for height in [1e-17, -1e-17] {
            let (last, _) = from(0.0, height);
            assert!(last[0].abs() + last[1].abs() < 1e-12, "{name} {height}: {last:?}");
        }
    }
    let sunk = Ball::new(BallParameters { height: -0.1, ..Default::default() });
    let Err(fault) = sunk else { panic!("below the floor") };
    assert_eq!(fault.to_string(), "the start of stop `floor.lower` must not be beyond its end; it depends on `height`");
}

/// A sample at the instant of an impact is before it; a run that goes on from there begins after it.
#[test]
fn a_sample_at_the_instant_of_an_impact_is_before_it() {
    let model = ball(0.5);
    let fall = f64::sqrt(2.0 * 1.25 / 9.81);
    let whole = Simulation::new(&model).rtol(1e-10).atol(1e-11).every(0.01).until(2.0).run().expect("a run");
    let mut first = Simulation::new(&model).rtol(1e-10).atol(1e-11).every(0.01).until(fall).run().expect("a run");
    let speed = *first["v"].last().expect("a sample");
    assert!((speed + 9.81 * fall).abs() < 1e-10, "{speed}");
    first = Simulation::new(&model).rtol(1e-10).atol(1e-11).every(0.01).until(fall + 1e-3).run().expect("a run");
    assert!((first["v"].last().expect("a sample") - 0.5 * 9.81 * fall + 9.81e-3).abs() < 1e-9);
    assert!(whole["y"].iter().all(|y| *y > -1e-12));
}

/// Room for the impacts once; what is looked at closely at one takes some, and gives it back.
#[test]
fn an_impact_allocates_little() {
    let model = ball(0.8);
    let start = model.start().expect("a start");
    let allocations = |end: f64| {
        let (settings, span) = (Settings::default(), Span { t0: 0.0, t_end: end });
        let mut method = bg_model::integrator::Dop853::new();
        let mut events = 0;
        let counted = allocation_counter::measure(|| {
            let finish = integrate(&model, &mut method, &start, span, &settings, &mut ());
            events = finish.map_or(0, |finish| finish.statistics.events);
        });
        (counted.count_total, events)
    };
    let (before, none) = allocations(0.4);
    let (all, impacts) = allocations(6.0);
    assert!(none == 0 && impacts > 40, "{impacts}");
    assert!(all - before < 300 * impacts, "{before} {all} {impacts}");
}
