use bg_model::input::Input;
use bond_graph_tests::models::double_pendulum::{DoublePendulum, RodAngles, RodAnglesParameters};
use bond_graph_tests::models::hacksaw_with_motor::{
    Current, CurrentInputs, CurrentParameters, HacksawWithMotor, HacksawWithMotorInputs,
};
use bond_graph_tests::models::slider_crank::{PlanarSliderCrank, PlanarSliderCrankParameters, SliderCrank};
use bond_graph_tests::models::spinning_top::{Nutation, NutationParameters, SpinningTop};

use super::twin::{compared, instants, run, varied, widened};

const ROUNDING: f64 = 1e-12;

#[test]
fn the_nutation_of_the_top() {
    for seed in 0..3 {
        let own: NutationParameters = varied(seed, 0.2);
        let samples = instants(2.0, 200);
        let scene = run(&Nutation::new(own.clone()).unwrap(), 2e-4, &samples);
        let full = run(&SpinningTop::new(widened(&own)).unwrap(), 2e-4, &samples);
        let worst = compared(&format!("Nutation {seed}"), &full, &scene, |_| Some(full.series("axis_z")));
        assert!(worst.motion.0 < ROUNDING && worst.rates.0 < ROUNDING, "{worst:?}");
    }
}

#[test]
fn the_angles_of_the_double_pendulum() {
    // Its motion is chaotic: rounding grows. The time is short beside that.
    for seed in 0..3 {
        let own: RodAnglesParameters = varied(seed, 0.2);
        let samples = instants(1.0, 100);
        let scene = run(&RodAngles::new(own.clone()).unwrap(), 2e-4, &samples);
        let full = run(&DoublePendulum::new(widened(&own)).unwrap(), 2e-4, &samples);
        let worst = compared(&format!("RodAngles {seed}"), &full, &scene, |_| None);
        assert!(worst.motion.0 < ROUNDING && worst.rates.0 < ROUNDING, "{worst:?}");
    }
}

#[test]
fn the_slider_crank_in_the_plane() {
    for seed in 0..3 {
        let own: PlanarSliderCrankParameters = varied(seed, 0.2);
        let samples = instants(1.0, 100);
        let scene = run(&PlanarSliderCrank::new(own.clone()).unwrap(), 1e-4, &samples);
        let full = run(&SliderCrank::new(widened(&own)).unwrap(), 1e-4, &samples);
        let worst = compared(&format!("PlanarSliderCrank {seed}"), &full, &scene, |_| None);
        assert!(worst.motion.0 < ROUNDING && worst.rates.0 < ROUNDING, "{worst:?}");
    }
}

#[test]
fn the_motor_s_current() {
    for seed in 0..3 {
        let own: CurrentParameters = varied(seed, 0.2);
        let samples = instants(1.0, 100);
        let voltage = || Input::function(|t| 24.0 + 6.0 * (20.0 * t).sin());
        let scene = Current::new(own.clone(), CurrentInputs { voltage: voltage() }).unwrap();
        let full = HacksawWithMotor::new(widened(&own), HacksawWithMotorInputs { voltage: voltage() }).unwrap();
        let (scene, full) = (run(&scene, 1e-4, &samples), run(&full, 1e-4, &samples));
        assert_eq!(scene.events, full.events);
        let worst = compared(&format!("Current {seed}"), &full, &scene, |_| None);
        assert!(worst.motion.0 < ROUNDING && worst.rates.0 < ROUNDING, "{worst:?}");
    }
}
