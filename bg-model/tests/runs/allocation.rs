//! A run of a method that has room for the states allocates the two lists of its scale and nothing else: neither for
//! steps nor for samples, events and rejected attempts.

use crate::problems::*;
use bg_model::integrator::{Ark5, Dop853, Gauss6, Method, Radau5, Radau9, Rk4};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{EachSample, Ended, Samples, Settings, Span, integrate, integrate_until};

fn allocations<M: Method>(mut method: M) -> (u64, u64, u64) {
    let settings = Settings { samples: Samples::Every(0.01), ..settings(1e-9) };
    let span = Span { t0: 0.0, t_end: 30.0 };
    let (mut samples, mut events) = (0, 0);
    let mut observer = EachSample(|_, _: &SVector<f64, 2>, _: &[bool; 1]| samples += 1);
    method.fit(2);
    let counted = allocation_counter::measure(|| {
        let finish = integrate(&bilinear(), &mut method, &SVector::from([1.0, 0.0]), span, &settings, &mut observer);
        events = finish.map_or(0, |finish| finish.statistics.events);
    });
    (counted.count_total, samples, events)
}

#[test]
fn the_counter_counts() {
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![1.0; 100])));
    assert_eq!(counted.count_total, 1);
}

#[test]
fn a_condition_allocates_nothing() {
    let (system, start, span) = (bilinear(), SVector::from([1.0, 0.0]), Span { t0: 0.0, t_end: 30.0 });
    let (mut method, settings) = (Dop853::new(), settings(1e-9));
    let condition = |t: f64, x: &SVector<f64, 2>, _: &[bool; 1]| if t < 20.0 { 1.0 } else { x[1] };
    let mut ended = None;
    method.fit(2);
    let counted = allocation_counter::measure(|| {
        let finish = integrate_until(&system, &mut method, &start, span, &settings, condition, &mut ());
        ended = finish.ok().map(|finish| finish.ended);
    });
    assert_eq!((counted.count_total, ended), (2, Some(Ended::ByCondition)));
}

#[test]
fn steps_samples_and_events_allocate_nothing() {
    let counts = |count: u64| (count, 3001, 13);
    assert_eq!(allocations(Dop853::new()), counts(2));
    assert_eq!(allocations(Rk4::new(0.01)), counts(2));
    // Room for the Jacobian, its slope and its differences, its places, and its entries there and at the one before,
    // once.
    assert_eq!(allocations(Ark5::new()), counts(12));
    // Room for the Jacobian, its slope and its differences, two numbers for each of the real and the complex factors,
    // once.
    assert_eq!(allocations(Radau5::new()), counts(10));
    assert_eq!(allocations(Radau9::new()), counts(12));
    assert_eq!(allocations(Gauss6::new(0.01)), counts(12));
}
