//! Imported robots swing as in MuJoCo: angles to 1e-8 over half a second.
//!
//! The references are printed by `cases/references.py`.

use bg_model::mechanism::Mechanism;
use bg_model::run::Simulation;

#[path = "cases/crane.rs"]
mod crane;
#[path = "cases/double_pendulum.rs"]
mod double_pendulum;

use crane::{Crane, CraneParameters};
use double_pendulum::{DoublePendulum, DoublePendulumParameters};

/// Runs, and compares the outputs at each eighth of a second.
fn swings<Me: Mechanism>(model: &Me, outputs: [&str; 2], references: [[f64; 2]; 4]) {
    let run = Simulation::new(model).rtol(1e-11).atol(1e-12).every(0.125).until(0.5).run().expect("it runs");
    for (k, reference) in references.iter().enumerate() {
        for (output, reference) in outputs.iter().zip(reference) {
            let value = run[*output][k + 1];
            assert!((value - reference).abs() < 1e-8, "{output} at {}: {value}, not {reference}", run.times[k + 1]);
        }
    }
}

#[test]
fn a_double_pendulum_on_skew_axes_from_a_urdf() {
    let start = DoublePendulumParameters { shoulder_start: 0.5, elbow_start: -0.8 };
    let model = DoublePendulum::new(start).expect("the parameters are in range");
    swings(
        &model,
        ["shoulder", "elbow"],
        [
            [0.544_397_763_401_551_1, -0.739_428_224_652_723_7],
            [0.711_122_066_813_689_1, -0.474_832_431_853_005_7],
            [1.058_210_138_608_130_6, 0.167_214_113_734_389_5],
            [1.510_044_099_873_426_8, 1.128_514_172_505_687],
        ],
    );
}

#[test]
fn a_crane_with_a_spring_a_rotor_and_a_ball_joint_from_an_mjcf() {
    let model =
        Crane::new(CraneParameters { rail_start: 0.05, swing_start: 0.6 }).expect("the parameters are in range");
    swings(
        &model,
        ["rail", "swing"],
        [
            [0.075_438_042_723_330_3, 0.698_298_197_746_688_9],
            [0.133_792_512_523_602_89, 1.003_087_919_697_161_2],
            [0.194_036_842_266_186_98, 1.072_294_871_530_982_8],
            [0.246_535_118_208_107_36, 0.859_762_703_919_094_2],
        ],
    );
}
