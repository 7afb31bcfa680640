//! A run allocates its room at its start and for its end, and nothing for steps, samples and rejected attempts: a long
//! run as much as a short one. What is looked at closely, as an event is, may allocate.

use crate::problems::*;
use bg_model::integrator::{Ark5, Dop853, Gauss6, Method, Nystrom, Radau5, Radau9, Rk4};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{EachSample, Ended, Samples, Settings, Span, integrate, integrate_until};

/// The allocations of a run of this length, s; with its samples and events.
fn allocations<const G: usize>(system: &Flow<Rate<2, G>, G>, mut method: impl Method, t_end: f64) -> (u64, u64, u64) {
    let settings = Settings { samples: Samples::Every(0.01), ..settings(1e-9) };
    let (mut samples, mut events) = (0, 0);
    let mut observer = EachSample(|_, _: &[f64], _: &[bool]| samples += 1);
    let start = SVector::from([1.0, 0.0]);
    // So that the method has all its room.
    integrate(system, &mut method, &start, Span { t0: 0.0, t_end: 1.0 }, &settings, &mut ()).expect("a smooth system");
    let counted = allocation_counter::measure(|| {
        let finish = integrate(system, &mut method, &start, Span { t0: 0.0, t_end }, &settings, &mut observer);
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
fn steps_and_samples_allocate_nothing() {
    fn is_so<M: Method>(method: impl Fn() -> M) {
        let rate: Rate<2, 0> = |t, x, _| [x[1], -x[0] * (1.0 + 0.5 * x[0] * x[0]) + t.sin()];
        let of = |t_end| allocations(&smooth(rate), method(), t_end);
        let ((short, few, _), (long, many, _)) = (of(10.0), of(40.0));
        assert_eq!((few, many), (1001, 4001));
        assert_eq!(short, long, "{}", method().name());
    }
    is_so(Dop853::new);
    is_so(Nystrom::new);
    is_so(|| Rk4::new(0.01));
    is_so(Ark5::new);
    is_so(Radau5::new);
    is_so(Radau9::new);
    is_so(|| Gauss6::new(0.01));
}

#[test]
fn guards_allocate_nothing_as_long_as_they_keep_to_their_sides() {
    let rate: Rate<2, 1> = |_, x, _| [x[1], -x[0]];
    let system = switched([|_, x| x[0] + 10.0], rate);
    let of = |t_end| allocations(&system, Dop853::new(), t_end);
    assert_eq!(of(10.0).0, of(40.0).0);
    // Of `bilinear` an event each 2.4 s is located.
    let ((short, _, few), (long, _, many)) =
        (allocations(&bilinear(), Dop853::new(), 10.0), allocations(&bilinear(), Dop853::new(), 40.0));
    assert_eq!((few, many), (4, 17));
    assert!(long - short < 300 * (many - few), "{short} {long}");
}

#[test]
fn a_condition_allocates_nothing_before_it_is_near() {
    let (system, start) = (smooth((|_, x, _| [x[1], -x[0]]) as Rate<2, 0>), SVector::from([1.0, 0.0]));
    let (mut method, settings) = (Dop853::new(), settings(1e-9));
    let mut of = |t_end: f64| {
        let condition = |t: f64, _: &SVector<f64, 2>, _: &[bool; 0]| 1e3 - t;
        let mut ended = None;
        let counted = allocation_counter::measure(|| {
            let span = Span { t0: 0.0, t_end };
            let finish = integrate_until(&system, &mut method, &start, span, &settings, condition, &mut ());
            ended = finish.ok().map(|finish| finish.ended);
        });
        assert_eq!(ended, Some(Ended::AtEnd));
        counted.count_total
    };
    // Room for the stages, once.
    of(5.0);
    assert_eq!(of(10.0), of(40.0));
}
