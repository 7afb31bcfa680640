//! Criteria of runs of models of text: values against closed forms, derivatives against five-point differences, also
//! where a largest value lies at an event.

use std::f64::consts::PI;

use bg_analysis::criterion::of_run::{Found, Look};
use bg_analysis::criterion::{Criteria, Criterion};
use bg_loaded::{Interpreted, load};
use bg_model::mechanism::Differentiable;
use bg_model::run::Request;
use bg_model::sensitivity::Direction;

fn model(text: &str) -> Interpreted {
    let graphs = load(text).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let blueprint = graphs[0].models[0].blueprint.as_ref().expect("the graph was asked for");
    let defaults: Vec<f64> = graphs[0].models[0].description.parameters.iter().map(|info| info.default).collect();
    Interpreted::new(blueprint, &defaults, &[]).expect("defaults are possible")
}

struct Asked {
    model: Interpreted,
    look: Look,
    criteria: Vec<Criterion>,
    request: Request,
}

impl Asked {
    fn of(text: &str, criteria: &[&str], t_end: f64) -> Self {
        let model = model(text);
        let mut all = Criteria::new(model.description());
        let criteria =
            criteria.iter().map(|text| all.criterion(text).unwrap_or_else(|fault| panic!("{fault}"))).collect();
        let look = Look::new(all, 1e-3, t_end).expect("times in the run");
        let request = Request { t_end, rtol: 1e-12, ..Request::default() };
        Self { model, look, criteria, request }
    }

    fn run(&self, values: &[f64]) -> Found {
        let machine = self.model.tuned(values).expect("values are possible");
        self.look.run(&*machine, values, &self.request).expect("a run")
    }

    fn values(&self, values: &[f64]) -> Vec<f64> {
        let found = self.run(values);
        self.criteria.iter().map(|of| self.look.criteria().value(of, &found.known)).collect()
    }

    /// For each criterion its derivatives by all parameters.
    fn slopes(&self) -> Vec<Vec<f64>> {
        let values = self.model.values();
        let directions: Vec<Direction> = (0..values.len()).map(Direction::Parameter).collect();
        let found = self.run(&values);
        let slopes = self.look.slopes(&self.model, &values, &self.request, &directions, &found).expect("derivatives");
        self.criteria.iter().map(|of| slopes.of(self.look.criteria(), of)).collect()
    }

    /// The same by five-point differences of whole runs.
    fn differences(&self, part: f64) -> Vec<Vec<f64>> {
        let values = self.model.values();
        let mut by = vec![Vec::new(); self.criteria.len()];
        for k in 0..values.len() {
            let h = part * values[k].abs().max(1e-3);
            let at = |steps: f64| {
                let mut moved = values.clone();
                moved[k] += steps * h;
                self.values(&moved)
            };
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(at);
            for (n, of) in by.iter_mut().enumerate() {
                of.push((a[n] - 8.0 * b[n] + 8.0 * c[n] - d[n]) / (12.0 * h));
            }
        }
        by
    }
}

const SWING: &str = "
graph Swing {
    param mass: kg = 2, above 0; param stiffness: N/m = 50, above 0; param stretch: mm = 100;
    param harder: N*s/m = 3; param softer: N*s/m = 1;
    1 slide: translation;
    I body = mass; C spring = stiffness start stretch;
    R damper(v) = if v < 0 { harder * v } else { softer * v };
    slide -> body; slide -> spring; slide -> damper;
    observe { x: m = spring.q; v: m/s = slide.flow; force: N = spring.effort + damper.effort; \
    place = [spring.q, 2 * spring.q, 0] }
}";

#[test]
fn measures_are_those_of_theory() {
    let text = "
    graph Wave { param size: m = 0.3; param rate: 1/s = 2; 1 clock: translation; I mass = 1; clock -> mass;
        observe { x: m = size * sin(rate * t); vector = [3 * size * sin(rate * t), 4 * size * sin(rate * t), 0] } }";
    let size = 0.3;
    let known = [
        ("max x", size),
        ("min x", -size),
        ("range(x, 0..1)", size),
        ("mean(x, 0..1.5707963267948966)", size * 2.0 / PI),
        ("rms x", size / 2.0_f64.sqrt()),
        ("deviation x", size / 2.0_f64.sqrt()),
        ("integral |x|", size * 4.0),
        ("at(x, 0.5)", size * 1.0_f64.sin()),
        ("final x", size * (4.0 * PI).sin()),
        ("max |vector|", 5.0 * size),
        ("time_of_max(x, 0..2)", PI / 4.0),
        ("time_of_min(x, 0..3)", 3.0 * PI / 4.0),
        ("crossings x", 3.0),
        ("crossings(x, 0.1)", 4.0),
    ];
    let texts = known.map(|(text, _)| text);
    let found = Asked::of(text, &texts, 2.0 * PI);
    let values = found.values(&found.model.values());
    for ((text, known), value) in known.iter().zip(values) {
        // By straight lines between samples a millisecond apart.
        assert!((value - known).abs() < 1e-6, "{text}: {value}, not {known}");
    }
}

#[test]
fn derivatives_of_criteria_are_those_of_differences() {
    let texts = [
        "max x",
        "min x",
        "max |force|",
        "range v",
        "mean(x^2)",
        "rms v",
        "deviation x",
        "integral(force * v)",
        "final x",
        "at(v, 0.7)",
        "max(max x, -2 * min x)",
        "max |place|",
        "mean(x^2, 0.4..1.1) * stiffness",
        "max(force * x, 0.3..2)",
    ];
    let asked = Asked::of(SWING, &texts, 2.0);
    let (slopes, differences) = (asked.slopes(), asked.differences(1e-4));
    for (text, (slopes, differences)) in texts.iter().zip(slopes.iter().zip(&differences)) {
        let size = differences.iter().fold(0.0_f64, |size, by| size.max(by.abs()));
        for (slope, difference) in slopes.iter().zip(differences) {
            assert!((slope - difference).abs() < 1e-6 * size, "{text}: {slopes:?}, by differences {differences:?}");
        }
    }
}

#[test]
fn a_value_that_is_largest_at_an_event_moves_with_it() {
    let text = "
    graph Fall { param height: m = 2; param weight: m/s^2 = 10; param ridge: m = 0.7; param bump: m = 0.1;
        1 fall: translation; I body = 1; MSe pull = -weight * unit; C way = zero start height;
        let unit: kg = 1; let zero: N/m = 0;
        pull -> fall; fall -> body; fall -> way;
        observe {
            y: m = way.q;
            ridge: m = if way.q < ridge { way.q } else { 2 * ridge - way.q };
            step: m = if way.q < ridge { bump + way.q } else { way.q - height };
        } }";
    let asked = Asked::of(text, &["max(ridge)", "max(step)"], 0.6);
    let values = asked.values(&asked.model.values());
    assert!((values[0] - 0.7).abs() < 1e-10 && (values[1] - 0.8).abs() < 1e-10, "{values:?}");
    // The one is the ridge's height, the other one, which jumps there, that and the bump: neither weight nor height.
    let slopes = asked.slopes();
    let by = |k: usize, known: [f64; 4]| {
        let is_near = slopes[k].iter().zip(known).all(|(slope, known)| (slope - known).abs() < 1e-9);
        assert!(is_near, "{:?}, not {known:?}", slopes[k]);
    };
    by(0, [0.0, 0.0, 1.0, 0.0]);
    by(1, [0.0, 0.0, 1.0, 1.0]);
}
