//! Requests that cannot be: starts, spans, tolerances, steps, samples, limits.

use bg_model::integrator::{Absolute, Tolerances};
use bg_model::simulation::{Samples, Settings};

use super::support::{Expected, Request, Trial, oscillator, smooth};

/// cos 1, where the oscillator is after 1 s.
const AFTER: f64 = 0.540_302_305_868_139_8;

/// All of them.
pub fn trials() -> Vec<Trial> {
    [starts(), spans(), tolerances(), steps(), samples()].into_iter().flatten().collect()
}

#[test]
fn requests_are_refused_or_done() {
    trials().iter().for_each(Trial::check);
}

fn of_oscillator(name: String, expected: Expected, request: Request<2>) -> Trial {
    Trial::new(name, expected, oscillator(), request)
}

fn with_settings(name: String, expected: Expected, change: impl FnOnce(&mut Settings)) -> Trial {
    let mut request = Request::default();
    change(&mut request.settings);
    of_oscillator(name, expected, request)
}

fn starts() -> Vec<Trial> {
    let trial = |value: f64| {
        let request = Request { start: [1.0, value], ..Request::default() };
        of_oscillator(format!("start value {value:?}"), Expected::Refused, request)
    };
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(trial).into()
}

fn spans() -> Vec<Trial> {
    use Expected::{Either, Ends, Refused, RefusedIf};
    let inf = f64::INFINITY;
    let spans = [
        (0.0, 0.0, Ends(1.0)),
        (1.0, 0.0, Refused),
        (f64::NAN, 1.0, Refused),
        (0.0, f64::NAN, Refused),
        (-inf, 0.0, Refused),
        (0.0, inf, Refused),
        (-1.7e308, 1.7e308, Refused),
        (0.0, 1e-300, Ends(1.0)),
        (0.0, 5e-324, Ends(1.0)),
        // The time hardly has digits for the span.
        (1e6, 1e6 + 1e-9, Ends(1.0)),
        (1e17, 1e17 + 16.0, RefusedIf { has_fixed_step: true }),
        (0.0, 1e300, RefusedIf { has_fixed_step: true }),
    ];
    let trial = |(t0, t_end, expected): (f64, f64, Expected)| {
        let request = Request { span: [t0, t_end], ..Request::default() };
        of_oscillator(format!("span from {t0:?} to {t_end:?} s"), expected, request)
    };
    let mut trials: Vec<Trial> = spans.map(trial).into();
    // What does not change can be followed that long.
    let request = Request { span: [0.0, 1e300], step: 1e298, ..Request::default() };
    trials.push(Trial::new("span from 0.0 to 1e300 s, at rest", Ends(1.0), smooth(|_, _| [0.0; 2]), request));
    let request = Request { span: [1e17, 2e17], step: 1e15, ..Request::default() };
    trials.push(Trial::new("span from 1e17 to 2e17 s, slow", Either, smooth(|_, x| [-1e-17 * x[0], 0.0]), request));
    trials
}

fn tolerances() -> Vec<Trial> {
    use Expected::{Either, Ends, Refused};
    let relative = |value: f64, expected: Expected| {
        with_settings(format!("relative tolerance {value:?}"), expected, |settings| {
            settings.tolerances.relative = value;
        })
    };
    let absolute = |value: f64, expected: Expected| {
        with_settings(format!("absolute tolerance {value:?}"), expected, |settings| {
            settings.tolerances.absolute = Absolute::Scalar(value);
        })
    };
    let of_one_state = |value: f64, expected: Expected| {
        with_settings(format!("absolute tolerance {value:?} of the second state"), expected, |settings| {
            settings.tolerances.absolute = Absolute::PerState(vec![1e-9, value]);
        })
    };
    let bad = [f64::NAN, f64::INFINITY, 0.0, -1.0, 5e-324];
    let mut trials = Vec::new();
    for value in bad {
        trials.extend([relative(value, Refused), absolute(value, Refused), of_one_state(value, Refused)]);
    }
    trials.extend([
        relative(1e-15, Refused),
        relative(2.3e-15, Ends(AFTER)),
        relative(1e300, Ends(AFTER)),
        absolute(1e300, Ends(AFTER)),
        absolute(1e-20, Ends(AFTER)),
        absolute(1e-300, Either),
        with_settings("both tolerances at their smallest".to_owned(), Either, |settings| {
            settings.tolerances = Tolerances::new(2.3e-15, f64::MIN_POSITIVE);
        }),
    ]);
    trials
}

fn steps() -> Vec<Trial> {
    use Expected::{Either, Ends, Refused, RefusedIf};
    let mut trials = Vec::new();
    for value in [f64::NAN, 0.0, -1.0, 1e-16] {
        let request = Request { step: value, ..Request::default() };
        let name = format!("fixed step {value:?} s");
        trials.push(of_oscillator(name, RefusedIf { has_fixed_step: true }, request));
        let name = format!("first step {value:?} s");
        trials.push(with_settings(name, RefusedIf { has_fixed_step: false }, |settings| {
            settings.first_step = Some(value);
        }));
        trials.push(with_settings(format!("largest step {value:?} s"), Refused, |settings| {
            settings.largest_step = value;
        }));
    }
    let fixed = |value: f64, expected| {
        let request = Request { step: value, ..Request::default() };
        of_oscillator(format!("fixed step {value:?} s"), expected, request)
    };
    trials.push(fixed(f64::INFINITY, RefusedIf { has_fixed_step: true }));
    trials.push(fixed(1e9, Either));
    for value in [1e9, f64::INFINITY] {
        trials.push(with_settings(format!("first step {value:?} s"), Ends(AFTER), |settings| {
            settings.first_step = Some(value);
        }));
    }
    trials.push(with_settings("first step 1e-14 s".to_owned(), Ends(AFTER), |settings| {
        settings.first_step = Some(1e-14)
    }));
    trials.push(with_settings("largest step 1e-14 s".to_owned(), Expected::StopsAt(0.0, 1e-9), |settings| {
        settings.largest_step = 1e-14;
    }));
    for limit in [0, 1] {
        trials.push(with_settings(format!("limit of {limit} steps"), Expected::StopsAt(0.0, 0.1), |settings| {
            settings.step_limit = limit;
        }));
    }
    trials
}

fn samples() -> Vec<Trial> {
    use Expected::{Ends, Refused};
    let inf = f64::INFINITY;
    let intervals = [
        (f64::NAN, Refused),
        (0.0, Refused),
        (-1.0, Refused),
        (1e-16, Refused),
        (1e9, Ends(AFTER)),
        (inf, Ends(AFTER)),
    ];
    let lists: [(&[f64], Expected); 8] = [
        (&[], Ends(AFTER)),
        (&[0.0, 0.0, 0.5, 0.5, 1.0, 1.0], Ends(AFTER)),
        (&[0.5, 0.4], Refused),
        (&[-0.1], Refused),
        (&[1.1], Refused),
        (&[0.5, f64::NAN], Refused),
        (&[inf], Refused),
        (&[-inf], Refused),
    ];
    let every = intervals.map(|(value, expected)| {
        with_settings(format!("a sample every {value:?} s"), expected, |settings| {
            settings.samples = Samples::Every(value)
        })
    });
    let at = lists.map(|(instants, expected)| {
        with_settings(format!("samples at {instants:?} s"), expected, |settings| {
            settings.samples = Samples::At(instants.to_vec());
        })
    });
    every.into_iter().chain(at).collect()
}
