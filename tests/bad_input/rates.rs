//! Rates, Jacobians and guards that break on the way.

use bg_model::capability::{Linearised, Named};
use bg_model::nalgebra::SVector;
use bg_model::simulation::Settings;
use bg_model::system::System;
use bond_graph_tests::switching::flow::{Flow, Guard};

use super::support::{Expected, NAMES, Request, Trial, smooth};
use Expected::{Either, Ends, EndsOrStops, StopsAt, StopsAtUnlessFixed};

/// All of them.
pub fn trials() -> Vec<Trial> {
    [faults(), growth(), jumps(), derivatives(), guards(), nothing()].into_iter().flatten().collect()
}

#[test]
fn runs_stop_at_the_fault_or_get_over_it() {
    trials().iter().for_each(Trial::check);
}

fn trial(name: &str, expected: Expected, rate: impl Fn(f64, &[f64; 2]) -> [f64; 2] + 'static) -> Trial {
    Trial::new(name, expected, smooth(rate), Request::default())
}

/// Rates that are not finite.
fn faults() -> Vec<Trial> {
    let late = |value: f64| move |t: f64, x: &[f64; 2]| [x[1], if t > 0.5 { value } else { -x[0] }];
    // Of Rosenbrock methods df/dt, by differences, looks 1e-8 s ahead.
    let mut trials = vec![
        trial("a rate that is NaN from the start", StopsAt(0.0, 0.0), |_, x| [x[1], f64::NAN]),
        trial("a rate that is NaN after the start", StopsAt(0.0, 1e-12), |t, x| {
            [x[1], if t > 0.0 { f64::NAN } else { -x[0] }]
        }),
        trial("a rate that is NaN from 0.5 s on", StopsAt(0.5, 1e-7), late(f64::NAN)),
        trial("a rate that is inf from 0.5 s on", StopsAt(0.5, 1e-7), late(f64::INFINITY)),
        trial("a rate that is NaN at 0.5 s only", Either, |t, _| [if t == 0.5 { f64::NAN } else { 1.0 }, 0.0]),
    ];
    let ten = || Request { span: [0.0, 10.0], ..Request::default() };
    // x = cos t; the rate is a number within 1e-3 of it.
    let narrow = smooth(|t, x| {
        let off = x[0] - libm::cos(t);
        [if off.abs() > 1e-3 { f64::NAN } else { -10.0 * off - libm::sin(t) }, 0.0]
    });
    trials.push(Trial::new("a rate that is NaN beside the solution", Ends(-0.839_071_529_076_452_4), narrow, ten()));
    // The tank is empty at 2 s, where the root ends.
    let tank = smooth(|_, x| [-x[0].sqrt(), 0.0]);
    trials.push(Trial::new("a tank that is empty at 2 s", StopsAt(2.0, 2e-3), tank, ten()));
    trials
}

/// States and rates that get too large.
fn growth() -> Vec<Trial> {
    let two = || Request { span: [0.0, 2.0], ..Request::default() };
    let decay = |speed: f64| smooth(move |t, x| [-speed * (x[0] - libm::cos(t)), 0.0]);
    let huge = Request { start: [1e308, 1e308], ..Request::default() };
    vec![
        Trial::new("a pole at 1 s", StopsAtUnlessFixed(1.0, 1e-5), smooth(|_, x| [x[0] * x[0], 0.0]), two()),
        Trial::new("growth with 1e12 1/s", StopsAtUnlessFixed(0.0, 1e-6), smooth(|_, x| [1e12 * x[0], 0.0]), two()),
        // Known limits: an L-stable method steps over what grows faster than its smallest step, and a fixed step over
        // what grows faster than itself; no error estimate sees it.
        Trial::new("growth with 1e200 1/s", Either, smooth(|_, x| [1e200 * x[0], 0.0]), two()),
        Trial::new("decay to cos t with 1e20 1/s", EndsOrStops(libm::cos(2.0)), decay(1e20), two()),
        Trial::new("decay to cos t with 1e60 1/s", EndsOrStops(libm::cos(2.0)), decay(1e60), two()),
        Trial::new("decay to cos t with 1e200 1/s", EndsOrStops(libm::cos(2.0)), decay(1e200), two()),
        Trial::new("decay with 1e300 1/s", EndsOrStops(0.0), smooth(|_, x| [-1e300 * x[0], 0.0]), two()),
        Trial::new("a start at 1e308 that grows", Either, smooth(|_, x| [x[0], x[1]]), huge),
    ]
}

/// Rates that jump without a guard: the steps get short there, and the run goes on.
fn jumps() -> Vec<Trial> {
    let two = || Request { span: [0.0, 2.0], ..Request::default() };
    let one_point = smooth(|t, _| [if t == 1.0 { 1e9 } else { 1.0 }, 0.0]);
    let with_time = smooth(|t, _| [if t < 0.7 { 1.0 } else { -0.5 }, 0.0]);
    let with_state = smooth(|_, x| [if x[0] < 1.7 { 1.0 } else { 0.5 }, 0.0]);
    let sliding = smooth(|_, x| [if x[0] < 1.7 { 1.0 } else { -0.5 }, 0.0]);
    vec![
        Trial::new("a rate that is 1e9 at 1 s only", Either, one_point, two()),
        Trial::new("a rate that jumps at a time", Ends(1.05), with_time, Request { step: 1e-3, ..two() }),
        Trial::new("a rate that jumps at a state", Ends(2.35), with_state, Request { step: 1e-3, ..two() }),
        Trial::new("a rate that jumps and holds the state there", Either, sliding, two()),
    ]
}

/// The oscillator with a Jacobian that it says to have.
struct Derivatives {
    entries: [f64; 4],
    slope: f64,
}

impl System<f64, 2, 0> for Derivatives {
    fn rate(&self, _: f64, x: &SVector<f64, 2>, _: &[bool; 0], dx: &mut SVector<f64, 2>) {
        *dx = SVector::from([x[1], -x[0]]);
    }

    fn named(&self) -> Option<&impl Named<f64, 2, 0>> {
        Some(self)
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 2, 0>> {
        Some(self)
    }
}

impl Named<f64, 2, 0> for Derivatives {
    fn state_name(&self, index: usize) -> &'static str {
        NAMES[index]
    }
}

impl Linearised<f64, 2, 0> for Derivatives {
    fn jacobian(&self, _: f64, _: &SVector<f64, 2>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 2>) {
        entries.copy_from_slice(&self.entries);
        slope.fill(self.slope);
    }
}

fn derivatives() -> Vec<Trial> {
    let nan = Derivatives { entries: [0.0, f64::NAN, 1.0, 0.0], slope: 0.0 };
    let late = Derivatives { entries: [0.0, -1.0, 1.0, 0.0], slope: f64::NAN };
    let wrong = Derivatives { entries: [1e6, -1e6, 1e6, 1e6], slope: 0.0 };
    let trial = |name: &str, expected, system| Trial::new(name, expected, system, Request::default());
    vec![
        // Differences stand in for what is no number.
        trial("a Jacobian that is NaN", Ends(1.0_f64.cos()), nan),
        trial("a derivative by time that is NaN", Ends(1.0_f64.cos()), late),
        trial("a Jacobian that is wrong by a million", Either, wrong),
    ]
}

/// A rate that is NaN after the start has no derivative there either.
#[test]
fn a_derivative_that_is_no_number_is_named_by_those_who_need_it() {
    let trial = faults().into_iter().find(|trial| trial.name == "a rate that is NaN after the start");
    let messages = trial.expect("it is there").messages();
    let named = messages.iter().find(|(text, _)| text.starts_with("a derivative of the rate of `tank.flow` is NaN"));
    assert_eq!(named.map(|(_, names)| names.join(" ")), Some("rodas5p ros2".to_owned()), "{messages:?}");
}

/// The oscillator with a guard.
fn guarded(name: &str, expected: Expected, guard: Guard) -> Trial {
    Trial::new(name, expected, Flow::new(NAMES, [guard], |_, x, _: &[bool; 1]| [x[1], -x[0]]), Request::default())
}

fn guards() -> Vec<Trial> {
    const AFTER: f64 = 0.540_302_305_868_139_8;
    vec![
        guarded("a guard that is NaN from the start", StopsAt(0.0, 0.0), |_, _| f64::NAN),
        guarded("a guard that is inf from the start", StopsAt(0.0, 0.0), |_, _| f64::INFINITY),
        guarded("a guard that is NaN from 0.5 s on", StopsAt(0.5, 1e-9), |t, _| 1.0 + (0.5 - t).sqrt()),
        guarded(
            "a guard that is zero and then NaN",
            StopsAt(0.5, 1e-9),
            |t, _| if t > 0.5 { f64::NAN } else { 0.5 - t },
        ),
        guarded("a guard that is NaN beside the solution", Ends(AFTER), |_, x| 2.0 + (1.001 - x[0].hypot(x[1])).sqrt()),
        guarded("a guard of 1e308 a second", Ends(AFTER), |t, _| 1e308 * (t - 0.5)),
        guarded("a guard of 1e-300 a second", Ends(AFTER), |t, _| 1e-300 * (t - 0.5)),
        guarded("a guard of 5e-324", Ends(AFTER), |t, _| 5e-324 * (t - 0.5)),
        guarded("a guard that jumps from -1 to 1", Ends(AFTER), |t, _| if t < 0.5 { -1.0 } else { 1.0 }),
    ]
}

/// Systems without a state.
fn nothing() -> Vec<Trial> {
    let request = || Request::<0> { start: [], span: [0.0, 1.0], settings: Settings::default(), step: 0.01 };
    vec![
        Trial::new("no states", Either, Flow::new([], [], |_, _, _: &[bool; 0]| []), request()),
        Trial::new("no states and a switch", Either, Flow::new([], [|t, _| t - 0.5], |_, _, _| []), request()),
    ]
}

#[test]
fn systems_without_a_state_run() {
    for trial in nothing() {
        assert_eq!(trial.messages().len(), 1, "{:?}", trial.messages());
        assert_eq!(trial.messages()[0].0, "ends");
    }
}

/// The error names the state whose rate is no number, and never another.
#[test]
fn the_faulty_state_is_named() {
    for name in ["NaN", "inf"] {
        let trial = faults().into_iter().find(|trial| trial.name == format!("a rate that is {name} from 0.5 s on"));
        for (message, names) in trial.expect("it is there").messages() {
            assert!(message.contains("`tank.flow`") && message.contains(name), "{names:?}: {message}");
        }
    }
}
