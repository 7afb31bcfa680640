//! Imported robots swing as in MuJoCo: angles to 1e-8 over half a second.
//!
//! The references are printed by `cases/references.py`.

use std::rc::Rc;

use bg_loaded::{Interpreted, load, macro_calls};
use bg_model::run::{Request, Simulation};

/// Runs the robot of the Rust text `file` with these values of parameters, as text: rustc would take a minute for the
/// three. Compares the outputs at each eighth of a second.
fn swings<const N: usize>(file: &str, values: &[(&str, f64)], outputs: [&str; N], references: [[f64; N]; 4]) {
    let call = macro_calls(file.parse().expect("tokens")).remove(0);
    let graph = load(&call.stream().to_string()).unwrap_or_else(|faults| panic!("{}", faults[0])).remove(0);
    let blueprint = graph.models[0].blueprint.clone().expect("all models are asked for");
    let mut of_model: Vec<f64> = blueprint.description().parameters.iter().map(|info| info.default).collect();
    for (name, value) in values {
        let place = blueprint.description().parameters.iter().position(|info| info.name == *name);
        of_model[place.expect(name)] = *value;
    }
    let model = Interpreted::<f64>::new(&blueprint, &of_model, &[]).expect("the parameters are in range");
    let simulation = Simulation::over(Rc::new(model), Request::default());
    let run = simulation.rtol(1e-11).atol(1e-12).every(0.125).until(0.5).run().expect("it runs");
    for (k, reference) in references.iter().enumerate() {
        for (output, reference) in outputs.iter().zip(reference) {
            let value = run[*output][k + 1];
            assert!((value - reference).abs() < 1e-8, "{output} at {}: {value}, not {reference}", run.times[k + 1]);
        }
    }
}

#[test]
fn a_double_pendulum_on_skew_axes_from_a_urdf() {
    swings(
        include_str!("cases/double_pendulum.rs"),
        &[("shoulder_start", 0.5), ("elbow_start", -0.8)],
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
    swings(
        include_str!("cases/crane.rs"),
        &[("rail_start", 0.05), ("swing_start", 0.6)],
        ["rail", "swing"],
        [
            [0.075_438_042_723_330_3, 0.698_298_197_746_688_9],
            [0.133_792_512_523_602_89, 1.003_087_919_697_161_2],
            [0.194_036_842_266_186_98, 1.072_294_871_530_982_8],
            [0.246_535_118_208_107_36, 0.859_762_703_919_094_2],
        ],
    );
}

#[test]
fn gravity_compensation_springs_dampers_and_a_joint_that_follows_from_an_mjcf() {
    // Two slides of 2 and 1 kg, of which the second moves by -0.5 of the first: 2.25 a = -1.5 g.
    let slides = |time: f64| {
        let leader = -9.81 * 1.5 / 2.25 * time * time / 2.0;
        [leader, 0.1 - 0.5 * leader]
    };
    let references = [
        [
            0.484_719_771_696_695_5,
            0.459_868_377_827_388,
            -0.001_324_768_414_763,
            -0.000_671_446_641_815,
            0.958_495_551_303_2,
        ],
        [
            0.354_591_284_673_291_5,
            0.572_269_230_872_314,
            -0.004_277_806_572_459,
            -0.002_159_583_548_255,
            0.843_399_849_516_2,
        ],
        [
            0.324_742_355_741_162_4,
            0.670_598_868_200_022,
            -0.006_706_894_650_913,
            -0.003_387_621_435_591,
            0.666_277_923_642_1,
        ],
        [
            0.374_753_605_380_139_3,
            0.728_512_510_885_175,
            -0.006_280_253_306_847,
            -0.003_190_714_988_306,
            0.436_471_736_524_8,
        ],
    ];
    let mut times = [0.125, 0.25, 0.375, 0.5].into_iter();
    let both = references.map(|[pin, tuned, x, y, z]| {
        let [leader, follower] = slides(times.next().unwrap_or_default());
        [pin, tuned, x, y, z, leader, follower]
    });
    let outputs = ["pin", "tuned", "float_position_x", "float_position_y", "float_position_z", "leader", "follower"];
    let start = [("pin_start", 0.6), ("tuned_start", 0.4), ("leader_start", 0.0)];
    swings(include_str!("cases/features.rs"), &start, outputs, both);
}
