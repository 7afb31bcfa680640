//! The gradient of the hacksaw's motion by all of its parameters, by the run followed backwards, against slopes that
//! follow the run: to the tolerance, as the gradient divides steps in which its weights ring. Slopes at 1e-12 give
//! 0.46314465581 where at 1e-8 slopes give ...649 and the gradient ...603.

use bg_model::integrator::Integrator;
use bg_model::run::Request;
use bg_model::sensitivity::{Direction, Objective, gradient, sensitivities};
use bg_model::simulation::Samples;
use hacksaw::mechanism::{Motion, MotionParameters};

#[test]
fn by_all_parameters_over_events() {
    let model = Motion::new(MotionParameters::default()).unwrap();
    let t_end = 0.25;
    let request = Request {
        method: Integrator::Dop853,
        t_end,
        rtol: 1e-8,
        samples: Samples::At(vec![0.0, t_end]),
        ..Request::default()
    };
    let all = Direction::parameters::<Motion>();
    assert_eq!(all.len(), 38);
    let forward = sensitivities(&model, &request, &all).unwrap();
    assert!(forward.trajectory.statistics.events > 0);
    for output in [0, 4] {
        let found = gradient(&model, &request, &Objective::last(output), &all).unwrap();
        let slope = |k: usize| forward.of(k, output)[1];
        let size = (0..all.len()).fold(0.0_f64, |size, k| size.max(slope(k).abs()));
        for (k, by) in found.by.iter().enumerate() {
            assert!((by - slope(k)).abs() < request.rtol * size, "output {output}, parameter {k}: {by} {}", slope(k));
        }
    }
}
