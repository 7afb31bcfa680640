use bg_model::nalgebra::SVector;
use bg_model::system::Model;
use bond_graph_tests::models::spinning_top::{SpinningTop, SpinningTopParameters as Parameters};
use bond_graph_tests::support::record::{Record, instants, record, record_from};

use super::truth::{apart, cross, dot, within};

/// The stretch of the tip's joint in regular precession (outward, upward), and the spin that keeps it up.
///
/// The joint's force carries the weight and keeps the centre of mass on its circle; its moment about the centre of mass
/// turns the angular momentum with the precession. Without compliance this is
/// (A + m l^2) W^2 cos(tilt) - C w3 W + m g l = 0 (Goldstein, section 5.7).
fn regular(p: &Parameters) -> ((f64, f64), f64) {
    let square = p.precession * p.precession;
    let outward = p.mass * square * p.arm * p.tilt.sin() / (p.stiffness - p.mass * square);
    let upward = -p.mass * p.gravity / p.stiffness;
    let moment = p.arm * p.mass * (p.gravity + p.tilt.cos() * square * (p.arm + outward / p.tilt.sin()));
    let axial_rate = (p.across * square * p.tilt.cos() + moment) / (p.precession * p.axial);
    ((outward, upward), axial_rate - p.precession * p.tilt.cos())
}

fn total_about_origin(p: &Parameters, run: &Record) -> Vec<[f64; 3]> {
    let (c, v, h) = (run.vectors("center"), run.vectors("velocity"), run.vectors("h"));
    (0..c.len())
        .map(|k| {
            let orbital = cross(c[k], v[k]);
            std::array::from_fn(|i| h[k][i] + p.mass * orbital[i])
        })
        .collect()
}

#[test]
fn regular_precession_keeps_its_tilt_and_rate() {
    for (tilt, precession, stiffness) in [(0.5, 3.0, 1e5), (1.2, -2.0, 1e5), (0.8, 6.0, 1e6)] {
        let mut p = Parameters { tilt, precession, stiffness, ..Parameters::default() };
        let ((outward, upward), spin) = regular(&p);
        p.spin = spin;
        let model = SpinningTop::new(p.clone()).unwrap();
        // The start of the model is unloaded; the stretch and the wider circle are those of the precession.
        let mut start: SVector<f64, _> = model.start().unwrap();
        let state = |name: &str| model.description().states.iter().position(|state| state.name == name).unwrap();
        start[state("top.position_x")] += outward;
        start[state("top.position_z")] += upward;
        start[state("top.linear.p_y")] += p.mass * precession * outward;
        let run = record_from(&model, start.as_slice(), &instants(2.0, 50), 1e-11);
        let radius = p.arm * tilt.sin() + outward;
        let height = p.arm * tilt.cos() + upward;
        let on_circle = |r: f64, z: f64| {
            run.times
                .iter()
                .map(move |t| [r * (precession * t).cos(), r * (precession * t).sin(), z])
                .collect::<Vec<_>>()
        };
        within("axis", apart(&run.vectors("axis"), on_circle(tilt.sin(), tilt.cos()).into_iter()), 1e-8);
        within("centre", apart(&run.vectors("center"), on_circle(radius, height).into_iter()), 1e-9);
    }
}

#[test]
fn the_spin_of_regular_precession_is_that_of_the_rigid_joint_to_first_order() {
    let rigid = |p: &Parameters| {
        let a = p.across + p.mass * p.arm * p.arm;
        let axial = (a * p.precession * p.precession * p.tilt.cos() + p.mass * p.gravity * p.arm) / p.precession;
        axial / p.axial - p.precession * p.tilt.cos()
    };
    let p = Parameters::default();
    let error = |stiffness| {
        let p = Parameters { stiffness, ..p.clone() };
        (regular(&p).1 / rigid(&p) - 1.0).abs()
    };
    within("1e5 N/m", error(1e5), 1e-5);
    within("as 1 / k", (error(1e5) / error(1e6) - 10.0).abs(), 0.01);
}

#[test]
fn a_nutating_top_keeps_its_moment_about_the_vertical_its_axial_spin_and_its_energy() {
    let p = Parameters { spin: 120.0, precession: 0.5, ..Parameters::default() };
    let run = record(&SpinningTop::new(p.clone()).unwrap(), &instants(2.0, 200), 1e-11);
    let vertical: Vec<f64> = total_about_origin(&p, &run).iter().map(|h| h[2]).collect();
    let drift = |values: &[f64]| values.iter().fold(0.0_f64, |largest, value| largest.max((value - values[0]).abs()));
    within("h_z", drift(&vertical) / vertical[0], 1e-9);
    let axial: Vec<f64> = run.vectors("axis").iter().zip(run.vectors("w")).map(|(axis, w)| dot(*axis, w)).collect();
    within("axial spin", drift(&axial) / axial[0], 1e-9);
    let (c, v, w, gap, axis) =
        (run.vectors("center"), run.vectors("velocity"), run.vectors("w"), run.vectors("gap"), run.vectors("axis"));
    let energy: Vec<f64> = (0..c.len())
        .map(|k| {
            let along = dot(axis[k], w[k]);
            0.5 * p.mass * dot(v[k], v[k])
                + 0.5 * p.across * (dot(w[k], w[k]) - along * along)
                + 0.5 * p.axial * along * along
                + p.mass * p.gravity * c[k][2]
                + 0.5 * p.stiffness * dot(gap[k], gap[k])
        })
        .collect();
    within("energy", drift(&energy) / energy[0], 1e-9);
    within("its own balance", run.imbalance() / energy[0], 1e-9);
    let tilts: Vec<f64> = axis.iter().map(|axis| axis[2].acos()).collect();
    assert!(drift(&tilts) > 0.01, "it nutates");
}
