use std::f64::consts::PI;

use bond_graph_tests::models::orbit::{Orbit, OrbitParameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{apart, within};

#[test]
fn a_ball_circles_on_its_spring() {
    let mut p = OrbitParameters::default();
    let mass = 4.0 / 3.0 * PI * p.density * p.radius.powi(3);
    let pull = p.stiffness * (p.distance - p.length);
    p.speed = (pull * p.distance / mass).sqrt();
    let w = p.speed / p.distance;
    let run = record(&Orbit::new(p.clone()).unwrap(), &instants(3.0 * 2.0 * PI / w, 60), 1e-11);
    let circle = run.times.iter().map(|t| {
        let (x, s) = (p.distance * (w * t).cos(), p.distance * (w * t).sin());
        [0.1 + x, -0.2 + 0.6 * s, 0.3 + 0.8 * s]
    });
    within("position", apart(&run.vectors("position"), circle), 1e-8);
    within("mass", (run.series("mass")[0] / mass - 1.0).abs(), 1e-14);
    let force =
        run.vectors("force").iter().map(|f| (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt()).collect::<Vec<_>>();
    within("pull", force.iter().map(|f| (f / pull - 1.0).abs()).fold(0.0, f64::max), 1e-8);
    assert!(run.vectors("force")[0][0] < 0.0, "the spring pulls the second end towards the first");
    within("energy", run.drift("stored"), 1e-9);
}

#[test]
fn an_eccentric_orbit_keeps_its_energy() {
    let run = record(&Orbit::new(OrbitParameters::default()).unwrap(), &instants(5.0, 60), 1e-11);
    within("energy", run.drift("stored"), 1e-8);
}
