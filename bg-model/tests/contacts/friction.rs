//! Dry friction that sticks: known motions, by every integrator; rest, reversal, many at once.

use crate::random::random_numbers;
use bg_model::bond_graph;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Observer, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    /// A block on an incline, thrown up it at the start.
    graph Block {
        param mass: kg = 2, above 0;
        param slope: rad = 0.6;
        param grip: 1 = 0.5, at least 0;
        param speed: m/s = 0;
        let normal: N = mass * 9.81 * cos(slope);
        1 slide: translation; I body = mass start -mass * speed;
        Se weight = mass * 9.81 * sin(slope); R rub(v) = grip * normal holds grip * normal;
        C travel(q) = 0 * q energy 0 * q * q;
        weight -> slide -> body; slide -> rub; slide -> travel;
        observe { v: m/s = slide.flow; x: m = travel.q; rub.effort; lost: J = integral(rub.power) }
    }
    /// A mass on a belt, drawn back by a spring.
    graph Belt {
        param mass: kg = 2, above 0;
        param spring: N/m = 50, above 0;
        param belt: m/s = 0.1;
        param kinetic: N = 4;
        param still: N = 6;
        1 slide: translation; I body = mass start mass * belt; C pull = spring; Sf drum = belt;
        0 between: translation; 1 rubbing: translation; R rub(v) = kinetic holds still;
        drum -> between -> slide -> body; slide -> pull; between -> rubbing -> rub;
        observe { x: m = pull.q; v: m/s = slide.flow; rub.effort }
    }
    /// A mass on a spring on a rough floor.
    graph Oscillator {
        param mass: kg = 2, above 0;
        param spring: N/m = 50, above 0;
        param rough: N = 3;
        param stretch: m = 1;
        1 slide: translation; I body = mass; C pull = spring start stretch; R rub(v) = rough holds rough;
        slide -> body; slide -> pull; slide -> rub;
        observe { x: m = pull.q; v: m/s = slide.flow; rub.effort }
    }
    /// A block on a block on the floor; the lower one is pushed more and more.
    graph Stack {
        param floor: N = 3;
        param grip: N = 2;
        1 lower, upper: translation; I base = 4; I load = 1; MSe push = 5 * t; R floor_rub(v) = floor holds floor;
        0 between: translation; 1 rubbing: translation; R rub(v) = grip holds grip;
        push -> lower -> base; lower -> floor_rub; lower -> between -> upper -> load; between -> rubbing -> rub;
        observe { v: m/s = lower.flow; u: m/s = upper.flow; rub.effort }
    }
    /// Two brakes on one shaft.
    graph Brakes {
        1 shaft: rotation; I rotor = 2; R first(w) = 3 holds 3; R second(w) = 1 + 1 * w holds 2;
        MSe motor = 8 * sin(t / 1);
        motor -> shaft -> rotor; shaft -> first; shaft -> second;
        observe { w: rad/s = shaft.flow; first.effort; second.effort }
    }
    /// Two shafts held together rigidly, a brake on each.
    graph Clutched {
        1 left, right: rotation; I one = 2; I two = 3; MSe motor = 5 * t;
        R first(w) = 3 holds 3; R second(w) = 2 holds 2; 0 tie: rotation; rSe rigid = 0;
        motor -> left -> one; left -> tie -> right -> two; rigid -> tie; left -> first; right -> second;
        observe { w: rad/s = left.flow; u: rad/s = right.flow; first.effort; second.effort }
    }
    /// A friction that is to hold less at rest than it gives while it slides.
    graph Weak {
        param load: N = 1.5;
        1 slide: translation; I body = 2; Se pull = load; R rub(v) = 2 holds 1; pull -> slide -> body; slide -> rub;
        observe { v: m/s = slide.flow }
    }
    /// Three masses on a floor, springs and friction between them, drawn to and fro.
    graph Train {
        param m1: kg = 1, above 0; param m2: kg = 1, above 0; param m3: kg = 1, above 0;
        param k1: N/m = 10, at least 0; param k2: N/m = 10, at least 0;
        param f1: N = 1, at least 0; param f2: N = 1, at least 0; param f3: N = 1, at least 0;
        param g1: N = 1, at least 0; param g2: N = 1, at least 0; param more: 1 = 1.2;
        param push: N = 4; param frequency: rad/s = 2; param v1: m/s = 0; param v3: m/s = 0;
        1 a, b, c: translation; I ma = m1 start m1 * v1; I mb = m2; I mc = m3 start m3 * v3;
        MSe pull = push * sin(frequency * t);
        R ra(v) = f1 holds more * f1; R rb(v) = f2 holds f2; R rc(v) = f3 + 0.1 * v holds f3;
        0 ab, bc: translation; 1 sab, sbc: translation;
        C kab = k1; C kbc = k2; R gab(v) = g1 holds more * g1; R gbc(v) = g2 holds g2;
        pull -> a -> ma; a -> ra; b -> mb; b -> rb; c -> mc; c -> rc;
        a -> ab -> b -> bc -> c; ab -> sab -> kab; sab -> gab; bc -> sbc -> kbc; sbc -> gbc;
        observe { stored: J = stored_energy; supplied: J = integral(supplied_power);
            lost: J = integral(dissipated_power) }
    }
}

/// The changes of branches.
#[derive(Default)]
struct Events(Vec<(f64, usize, bool)>);

impl Observer for Events {
    fn event(&mut self, t: f64, _: &[f64], switch: usize, negative: &[bool]) {
        self.0.push((t, switch, negative[switch]));
    }
}

/// The outputs where a run comes to until `end` (s), and its events.
fn run<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    integrator: Integrator,
    end: f64,
) -> (Vec<f64>, Vec<(f64, usize, bool)>)
where
    Mo: Model<f64, N, G, M>,
{
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let (mut method, mut events): (AnyMethod, _) = (integrator.method(1e-3), Events::default());
    let start = model.start().expect("a start");
    let span = Span { t0: 0.0, t_end: end };
    let finish = integrate(model, &mut method, &start, span, &settings, &mut events);
    let finish = finish.unwrap_or_else(|failure| panic!("{}: {failure}", integrator.name()));
    let mut outputs = SVector::zeros();
    model.outputs(finish.t, finish.state(), finish.branches(), &mut outputs);
    (outputs.as_slice().to_vec(), events.0)
}

/// What times and places may be off; a method of order 2 with fixed steps follows no tolerance.
fn bound(integrator: Integrator) -> f64 {
    if integrator == Integrator::Ros2 { 1e-5 } else { 1e-8 }
}

fn block(slope: f64, grip: f64, speed: f64) -> Block {
    Block::new(BlockParameters { slope, grip, speed, ..BlockParameters::default() }).expect("in range")
}

#[test]
fn a_block_sticks_below_the_angle_of_friction() {
    for integrator in Integrator::ALL {
        let end = if integrator.has_fixed_step() { 2.0 } else { 1000.0 };
        for slope in [0.4, -0.4, 0.5_f64.atan(), 0.0] {
            let (outputs, events) = run(&block(slope, 0.5, 0.0), integrator, end);
            assert!(events.is_empty(), "{} {slope}: {events:?}", integrator.name());
            assert!(outputs[0].abs() + outputs[1].abs() < 1e-14, "{} {slope}: {outputs:?}", integrator.name());
            assert!((outputs[2] - 2.0 * 9.81 * slope.sin()).abs() < 1e-9, "{} {slope}: {outputs:?}", integrator.name());
        }
    }
}

/// Up the slope at 2 m/s: it stops after v / (g (sin a + mu cos a)), then sticks or slides back.
#[test]
fn a_block_that_is_thrown_up_stops_and_sticks_or_slides_back() {
    let gravity = 9.81;
    for integrator in Integrator::ALL {
        for (slope, grip, events) in [(0.4_f64, 0.5, 1), (0.8, 0.5, 2), (0.6, 0.0, 2)] {
            let (along, across) = (gravity * slope.sin(), gravity * slope.cos());
            let stop = 2.0 / (along + grip * across);
            let (outputs, found) = run(&block(slope, grip, 2.0), integrator, 2.0);
            let name = integrator.name();
            assert_eq!(found.len(), events, "{name} {slope}: {found:?}");
            assert!(found.iter().all(|event| (event.0 - stop).abs() < 1e-9), "{name} {slope}: {found:?} {stop}");
            let speed = (along - grip * across).max(0.0) * (2.0 - stop);
            assert!((outputs[0] - speed).abs() < 1e-9, "{name} {slope}: {outputs:?} {speed}");
        }
    }
}

/// x'' m + k x = F while it slides; the amplitude falls by 2 F / k in each half period pi / w, until it is within F /
/// k.
#[test]
fn an_oscillator_comes_to_rest_where_the_spring_is_within_the_friction() {
    let half = std::f64::consts::PI / 5.0;
    for integrator in Integrator::ALL {
        for stretch in [1.0, -0.87, 0.05] {
            let model = Oscillator::new(OscillatorParameters { stretch, ..Default::default() }).expect("in range");
            let (outputs, events) = run(&model, integrator, 10.0);
            let turns = ((f64::abs(stretch) - 0.06) / 0.12).ceil().max(0.0);
            let rest = (1.0 - 2.0 * (turns % 2.0)) * (stretch.abs() - 0.12 * turns) * stretch.signum();
            let name = integrator.name();
            assert!((outputs[0] - rest).abs() < bound(integrator), "{name} {stretch}: {outputs:?} {rest}");
            assert!(outputs[1].abs() < 1e-12, "{name}: still moving, {outputs:?}");
            for (t, ..) in &events {
                let nearest = (t / half).round();
                assert!((t - nearest * half).abs() < bound(integrator), "{name} {stretch}: {t} {events:?}");
            }
            // One change of branch to begin to slide is none, the last one begins to stick, the others turn round.
            let expected = if turns == 0.0 { 0 } else { 2 * turns as usize - 1 };
            assert_eq!(events.len(), expected, "{name} {stretch}: {events:?}");
        }
    }
}

/// Sticking until the spring pulls with the limit, then half an oscillation about the place of the kinetic friction.
#[test]
fn stick_slip_has_the_period_of_its_closed_form() {
    let (mass, spring, belt, kinetic, still) = (2.0, 50.0, 0.1, 4.0, 6.0);
    let frequency = f64::sqrt(spring / mass);
    let excess = (still - kinetic) / spring;
    let slips = 2.0 / frequency * (std::f64::consts::PI - libm::atan(excess * frequency / belt));
    let sticks = 2.0 * excess / belt;
    let first = still / spring / belt;
    for integrator in Integrator::ALL {
        let model = Belt::new(BeltParameters::default()).expect("in range");
        let (_, events) = run(&model, integrator, 8.0);
        let name = integrator.name();
        for (k, (t, ..)) in events.iter().enumerate() {
            let (periods, half) = ((k / 2) as f64, (k % 2) as f64);
            let expected = first + periods * (slips + sticks) + half * slips;
            assert!((t - expected).abs() < bound(integrator), "{name} {k}: {t} {expected}");
        }
        let full = (8.0 - first) / (slips + sticks);
        let expected = 1 + 2 * full as usize + usize::from(full.fract() * (slips + sticks) > slips);
        assert_eq!(events.len(), expected, "{name}: {events:?}");
    }
}

/// The floor lets go at 3 N; the upper block stays until its part of the push beyond that, a fifth, is 2 N.
#[test]
fn a_block_on_a_block_goes_along_until_the_push_is_too_much() {
    for integrator in Integrator::ALL {
        let (outputs, events) = run(&Stack::new(StackParameters::default()).expect("in range"), integrator, 3.0);
        let name = integrator.name();
        let times: Vec<f64> = events.iter().map(|event| event.0).collect();
        assert!(
            times.len() == 2 && (times[0] - 0.6).abs() < 1e-10 && (times[1] - 2.6).abs() < 1e-9,
            "{name}: {times:?}"
        );
        // Together (5 t - 3) / 5, then (5 t - 5) / 4 below and 2 above.
        let both = 0.5 * (2.6 - 0.6) * (2.6 - 0.6);
        let lower = both + (2.5 * (3.0 * 3.0 - 2.6 * 2.6) - 5.0 * 0.4) / 4.0;
        assert!((outputs[0] - lower).abs() < 1e-8, "{name}: {outputs:?} {lower}");
        assert!((outputs[1] - both - 2.0 * 0.4).abs() < 1e-8 && outputs[2] == 2.0, "{name}: {outputs:?}");
    }
}

#[test]
fn brakes_that_hold_the_same_share_the_load() {
    let begins = libm::asin(5.0 / 8.0);
    for integrator in Integrator::ALL {
        let model = Brakes::new(BrakesParameters::default()).expect("in range");
        let name = integrator.name();
        for part in [0.2, 0.5, 0.9, 0.99] {
            let (outputs, _) = run(&model, integrator, part * begins);
            let load = 8.0 * libm::sin(part * begins);
            assert!(outputs[0].abs() < 1e-12, "{name} {part}: {outputs:?}");
            assert!((outputs[1] + outputs[2] - load).abs() < 1e-9, "{name} {part}: {outputs:?} {load}");
            assert!(outputs[1] <= 3.0 + 1e-9 && outputs[2] <= 2.0 + 1e-9, "{name} {part}: {outputs:?}");
        }
        // It slides, comes to rest, slides back, for ten periods.
        let (outputs, events) = run(&model, integrator, 62.0);
        assert!(outputs[0].abs() < 10.0 && events.len() < 200, "{name}: {outputs:?} {}", events.len());
    }
}

#[test]
fn shafts_that_are_one_slide_when_both_brakes_give_way() {
    for integrator in Integrator::ALL {
        let model = Clutched::new(ClutchedParameters::default()).expect("in range");
        let name = integrator.name();
        let (outputs, _) = run(&model, integrator, 0.95);
        // The gap of rigid joints decays fast, so that explicit steps are limited by it and leave their tolerance.
        assert!(outputs[0].abs() + outputs[1].abs() < 1e-10, "{name}: {outputs:?}");
        assert!((outputs[2] + outputs[3] - 4.75).abs() < 1e-9, "{name}: {outputs:?}");
        let (outputs, _) = run(&model, integrator, 2.0);
        assert!((outputs[0] - 0.5).abs() < 1e-8 && (outputs[1] - 0.5).abs() < 1e-8, "{name}: {outputs:?}");
    }
}

/// Some of the springs, frictions and pushes of a train are missing.
fn random_train(next: &mut impl FnMut() -> f64) -> TrainParameters {
    let mut some = |size: f64| if next() < 0.25 { 0.0 } else { size * next() };
    let frictions: [f64; 5] = std::array::from_fn(|_| some(2.0));
    let [f1, f2, f3, g1, g2] = frictions;
    let (k1, k2, push, v1, v3) = (some(50.0), some(50.0), some(8.0), some(2.0), -some(2.0));
    let [m1, m2, m3] = std::array::from_fn(|_| 0.2 + some(2.0));
    let (more, frequency) = (1.0 + some(0.5), 0.5 + some(5.0));
    TrainParameters { m1, m2, m3, k1, k2, f1, f2, f3, g1, g2, more, push, frequency, v1, v3 }
}

#[test]
fn trains_of_all_kinds_stick_and_slide_without_end_and_keep_their_energy() {
    let mut next = random_numbers(2024);
    let mut changes = 0;
    for case in 0..300 {
        let parameters = random_train(&mut next);
        let model = Train::new(parameters.clone()).expect("in range");
        let integrator = [Integrator::Dop853, Integrator::Auto, Integrator::Bs5][case % 3];
        let (outputs, events) = run(&model, integrator, 20.0);
        let start =
            0.5 * (parameters.m1 * parameters.v1 * parameters.v1 + parameters.m3 * parameters.v3 * parameters.v3);
        let balance = outputs[0] - start - outputs[1] + outputs[2];
        assert!(balance.abs() < 1e-7 * (1.0 + outputs[2]), "{case}: {balance:e} {outputs:?} {parameters:?}");
        changes += events.len();
    }
    assert!(changes > 10_000, "there was something to do: {changes}");
}

/// With less at rest than while it slides, neither would be right at rest.
#[test]
fn friction_holds_what_it_gives_while_it_slides() {
    for (load, speed) in [(1.5, 0.0), (-1.9, 0.0), (2.5, 0.25)] {
        let model = Weak::new(WeakParameters { load }).expect("in range");
        let (outputs, events) = run(&model, Integrator::Dop853, 1.0);
        assert!((outputs[0] - speed).abs() < 1e-9 && events.is_empty(), "{load}: {outputs:?} {events:?}");
    }
}
