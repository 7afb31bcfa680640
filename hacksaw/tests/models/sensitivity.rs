//! Derivatives of the hacksaw's motion over its first switchings against differences of runs in double-double
//! arithmetic.

use bg_model::extended::Accuracy;
use bg_model::integrator::Integrator;
use bg_model::run::Request;
use bg_model::sensitivity::{Direction, differences, sensitivities};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters};

/// Two switchings of the cutting contact lie before it, s.
const END: f64 = 0.02;

#[test]
fn derivatives_are_differences_over_switchings() {
    let model = Motion::new(MotionParameters::default()).unwrap();
    let names = ["torque", "r_cut", "crank_angle"];
    let by = names.map(|name| Direction::parameter::<Motion>(name).unwrap());
    let samples = Samples::At(vec![END]);
    let method = Integrator::Dop853;
    let request = Request { method, t_end: END, rtol: 1e-12, samples, ..Request::default() };
    let found = sensitivities(&model, &request, &by).unwrap();
    assert!(found.trajectory.statistics.events >= 2, "{}", found.trajectory.statistics.events);
    for (k, (name, direction)) in names.into_iter().zip(by).enumerate() {
        let Direction::Parameter(index) = direction else { unreachable!("parameters were asked for") };
        let accuracy = Accuracy { columns: 8, tolerance: 1e-18 };
        let expected = differences(&model, index, END, 1e-4, accuracy).unwrap();
        let size = expected.iter().fold(0.0_f64, |size, slope| size.max(slope.abs()));
        for (output, slope) in expected.iter().enumerate() {
            let error = (found.of(k, output)[0] - slope).abs() / size;
            assert!(error < 1e-9, "{name}, output {output}: {error:e}");
        }
    }
}
