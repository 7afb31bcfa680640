use std::f64::consts::PI;

use bond_graph_tests::models::nonlinear::{
    Duffing, DuffingParameters, Pendulum, PendulumParameters, Rectifier, RectifierParameters, RelativisticMass,
    RelativisticMassParameters, UnequalDamper, UnequalDamperParameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{elliptic, root, turning_point, within};

#[test]
fn a_hardening_spring_swings_with_the_period_of_duffing() {
    let p = DuffingParameters::default();
    let (linear, cubic) = (p.stiffness / p.mass, p.hardening / p.mass * p.stretch * p.stretch);
    let period = 4.0 * elliptic((cubic / (2.0 * (linear + cubic))).sqrt()) / (linear + cubic).sqrt();
    let run = record(&Duffing::new(p.clone()).unwrap(), &instants(5.0 * period, 10), 1e-11);
    within("turning points", run.deviation("x", |t| p.stretch * (2.0 * PI * t / period).cos()), 1e-8);
    let energy = 0.5 * p.stiffness * p.stretch.powi(2) + 0.25 * p.hardening * p.stretch.powi(4);
    within("energy", run.deviation("stored", |_| energy), 1e-9);
    within("observed energy", run.deviation("energy", |_| energy), 1e-9);
}

#[test]
fn a_pendulum_swings_with_the_period_of_the_elliptic_integral() {
    let p = PendulumParameters::default();
    let period = 4.0 * (p.length / 9.81).sqrt() * elliptic((0.5 * p.angle).sin());
    let run = record(&Pendulum::new(p.clone()).unwrap(), &instants(4.0 * period, 8), 1e-11);
    within("turning points", run.deviation("angle", |t| p.angle * (2.0 * PI * t / period).cos()), 1e-8);
    within("energy", run.drift("stored"), 1e-9);
}

#[test]
fn a_nonlinear_inertia_follows_its_law() {
    let p = RelativisticMassParameters::default();
    let run = record(&RelativisticMass::new(p.clone()).unwrap(), &instants(4.0, 40), 1e-11);
    let heavy = |t: f64| (p.mass * p.mass + (p.force * t / p.light).powi(2)).sqrt();
    within("v", run.deviation("v", |t| p.force * t / heavy(t)), 1e-10);
    within("stored", run.deviation("stored", |t| p.light * p.light * (heavy(t) - p.mass)), 1e-9);
    within("energy", run.imbalance(), 1e-9);
}

#[test]
fn an_unequal_damper_switches_at_the_turning_points() {
    let p = UnequalDamperParameters::default();
    let turning = |count| turning_point(p.mass, p.stiffness, p.back, p.forth, p.stretch, count);
    let times: Vec<f64> = (0..=6).map(|count| turning(count).0).collect();
    let run = record(&UnequalDamper::new(p.clone()).unwrap(), &times, 1e-12);
    for (count, x) in (0..).zip(run.series("x")) {
        within("turning point", (x - turning(count).1).abs(), 1e-10);
    }
    assert!(run.events.len() >= 5, "{:?}", run.events);
    for (event, time) in run.events.iter().zip(&times[1..]) {
        within("event", (event - time).abs(), 1e-10);
    }
    within("energy", run.imbalance() / 50.0, 1e-11);
}

#[test]
fn a_rectifier_conducts_while_the_source_is_above_the_capacitor() {
    let p = RectifierParameters::default();
    let (w, rate) = (p.frequency, 1.0 / (p.forward * p.capacitance));
    // C u' = (U sin(w t) - u) / R from u(0) = 0, until the current is zero.
    let size = p.amplitude * rate / (rate * rate + w * w);
    let charging = move |t: f64| size * (rate * (w * t).sin() - w * (w * t).cos() + w * (-rate * t).exp());
    let stop = root(|t| p.amplitude * (w * t).sin() - charging(t), 0.3 * PI / w, PI / w);
    let full = charging(stop);
    let again = (2.0 * PI + (full / p.amplitude).asin()) / w;
    let run = record(&Rectifier::new(p).unwrap(), &instants(again, 100), 1e-11);
    within("voltage", run.deviation("voltage", |t| if t < stop { charging(t) } else { full }), 1e-9);
    within("stop", (run.events[0] - stop).abs(), 1e-11);
    let run = record(&Rectifier::new(RectifierParameters::default()).unwrap(), &[0.0, again + 1e-3], 1e-11);
    within("again", (run.events[1] - again).abs(), 1e-11);
}
