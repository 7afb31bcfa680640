//! Inputs from tables: against closed forms, and the steps that end at their rows.

use crate::problems::{Record, settings};
use bg_model::bond_graph;
use bg_model::dynamics::{Machine, Over};
use bg_model::extended::{self, Accuracy};
use bg_model::input::{Input, Table, TableError};
use bg_model::integrator::{AnyMethod, Dop853, Integrator, Rk4};
use bg_model::nalgebra::SVector;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Ended, Finish, Samples, Settings, Span, integrate, integrate_until};
use bg_model::system::{Model, System};

bond_graph! {
    /// A mass that two forces push.
    graph Mass {
        param mass: kg = 2, above 0;
        input push: N;
        input pull: N;
        Se right = push; Se left = pull; 1 slide: translation; I body = mass;
        right -> slide -> body; slide -> left;
        observe { v: m/s = slide.flow; x: m = integral(slide.flow) }
    }
    /// A mass on a spring and a damper.
    graph Oscillator {
        param stiffness: N/m = 40;
        input force: N;
        Se push = force; 1 slide: translation; I body = 1; C spring = stiffness; R damper = 0.4;
        push -> slide -> body; slide -> spring; slide -> damper;
        observe { x: m = spring.q }
    }
}

const TIMES: [f64; 5] = [0.25, 0.5, 1.375, 1.5, 2.75];
const FORCES: [f64; 5] = [0.0, 8.0, 8.0, -5.0, 1.0];

fn mass(push: Input, pull: Input) -> Mass {
    Mass::new(MassParameters::default(), MassInputs { push, pull }).expect("in range")
}

fn linear(times: &[f64], values: &[f64]) -> Input {
    Input::table(Table::linear(times, values).expect("a table"))
}

/// Velocity and place of a mass of 2 kg at time `t` after the last row, driven by straight lines from rest: exact in
/// `S`.
fn closed_form<S: Scalar>(t: f64) -> [S; 2] {
    let s = S::from_f64;
    let (mut v, mut x, mut force) = (s(0.0), s(0.0), s(0.0));
    let mut from = s(0.0);
    for (time, next) in TIMES.into_iter().zip(FORCES).chain([(t, FORCES[4])]) {
        let (h, next) = (s(time) - from, s(next));
        x = x + h * (v + h * (force + force + next) / s(12.0));
        v = v + h * (force + next) / s(4.0);
        (from, force) = (s(time), next);
    }
    [v, x]
}

/// A run from rest at t = 0, with the steps it made.
fn run<Sys, const N: usize, const G: usize>(
    model: &Sys,
    mut method: AnyMethod,
    t_end: f64,
    settings: &Settings,
) -> (Finish, Record<N, G>)
where
    Sys: System<f64, N, G>,
{
    let (mut record, span) = (Record::default(), Span { t0: 0.0, t_end });
    let finish = integrate(model, &mut method, &SVector::zeros(), span, settings, &mut record).expect("the run ends");
    (finish, record)
}

fn outputs<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo, finish: &Finish) -> [f64; M]
where
    Mo: Model<f64, N, G, M>,
{
    let mut y = SVector::<f64, M>::zeros();
    model.outputs(finish.t, finish.state(), finish.branches(), &mut y);
    y.into()
}

/// Between two rows the velocity is a parabola: a method of order 3 or more is exact on it, however large its steps, as
/// long as none leads over a row.
#[test]
fn a_mass_driven_by_a_table_moves_as_the_closed_form_at_any_tolerance() {
    let model = mass(linear(&TIMES, &FORCES), Input::default());
    let [v, x] = closed_form::<f64>(4.0);
    for integrator in Integrator::ALL.into_iter().filter(|it| !matches!(it, Integrator::Taylor | Integrator::Ros2)) {
        let (finish, record) = run(&model, integrator.method(0.3), 4.0, &settings(1e-1));
        let [found_v, found_x] = outputs(&model, &finish);
        // The conditions of Nystrom's method hold to a part of their values only.
        let allowed = if integrator == Integrator::Nystrom { 3e-9 * x } else { 1e-13 };
        assert!((found_v - v).abs() < 1e-13, "{integrator:?}: {found_v} {v}");
        assert!((found_x - x).abs() < allowed, "{integrator:?}: {found_x} {x}");
        assert!(TIMES.iter().all(|time| record.steps.contains(time)), "{integrator:?}: {:?}", record.steps);
        assert_eq!(finish.statistics.rejected, 0, "{integrator:?}");
    }
}

/// The velocity is a parabola, which is what a method of order 2 gives exactly.
#[test]
fn a_method_of_second_order_meets_the_velocity() {
    let model = mass(linear(&TIMES, &FORCES), Input::default());
    let [v, _] = closed_form::<f64>(4.0);
    let (finish, _) = run(&model, Integrator::Ros2.method(0.5), 4.0, &settings(1.0));
    let [found, _] = outputs(&model, &finish);
    assert!((found - v).abs() < 1e-13, "{found} {v}");
}

#[test]
fn the_rows_of_all_inputs_end_steps() {
    let model = mass(linear(&[0.1, 0.7], &[0.0, 1.0]), linear(&[0.3, 0.9], &[0.0, -1.0]));
    let (_, record) = run(&model, Integrator::Dop853.method(1.0), 2.0, &settings(1e-3));
    assert!([0.1, 0.3, 0.7, 0.9].iter().all(|time| record.steps.contains(time)), "{:?}", record.steps);
    let next = |t| System::<f64, _, _>::next_break(&model, t);
    assert_eq!([0.0, 0.1, 0.5, 0.7, 0.9].map(next), [0.1, 0.3, 0.7, 0.9, f64::INFINITY]);
}

/// A triangular wave of 1 N in rows of 0.5 s.
fn triangles(rows: usize) -> Table {
    let times: Vec<f64> = (0..rows).map(|k| 0.5 * k as f64).collect();
    let values: Vec<f64> = (0..rows).map(|k| [0.0, 1.0, 0.0, -1.0][k % 4]).collect();
    Table::linear(&times, &values).expect("a table")
}

fn oscillator(force: Input) -> Oscillator {
    Oscillator::new(OscillatorParameters::default(), OscillatorInputs { force }).expect("in range")
}

#[test]
fn rows_save_the_rejected_steps_of_kinks_and_are_more_exact() {
    let table = triangles(41);
    let same = table.clone();
    let with_rows = oscillator(Input::table(table));
    let without = oscillator(Input::function(move |t| same.value(t)));
    let span = Span { t0: 0.0, t_end: 20.0 };
    let start = [DoubleDouble::from_f64(0.0); 2];
    let exact = Oscillator::<DoubleDouble>::in_scalar(
        OscillatorParameters::default(),
        OscillatorInputs { force: Input::table(triangles(41)) },
    );
    let accuracy = Accuracy { columns: 10, tolerance: 1e-20 };
    let exact = Over::<_, 2, 0, 0>(&exact.expect("in range"));
    let exact = extended::integrate(&exact, &start, span, accuracy, &[], &mut |_, _, _| {}).expect("the run ends");
    let exact = SVector::<f64, 2>::from_fn(|state, _| exact.x[state].to_f64());
    for integrator in [Integrator::Dop853, Integrator::Cfmr7, Integrator::Radau9, Integrator::Rodas5p] {
        let [(with_rows, _), (without, _)] =
            [&with_rows, &without].map(|model| run(model, integrator.method(1.0), span.t_end, &settings(1e-8)));
        let rejected = [with_rows.statistics.rejected, without.statistics.rejected];
        assert!(3 * rejected[0] < rejected[1], "{integrator:?}: {rejected:?}");
        assert!(with_rows.statistics.rate_evaluations < without.statistics.rate_evaluations, "{integrator:?}");
        let errors = [with_rows.x, without.x].map(|x| (x - exact).norm());
        // DOP853 sees each kink by its estimates, and takes steps so short that it errs less than it may.
        let most = if integrator == Integrator::Dop853 { 1e-8 } else { errors[1] };
        assert!(errors[0] < 1e-7 && errors[0] < most, "{integrator:?}: {errors:?}");
    }
}

/// A row that cuts a step short costs that one step: the next one is as long as it was to be.
#[test]
fn a_row_does_not_disturb_the_size_of_the_steps_after_it() {
    let smooth = |t: f64| (3.0 * t).sin();
    let free = oscillator(Input::function(smooth));
    let rows: Vec<f64> = (0..9).map(|k| 1.1 * f64::from(k) + 0.05).collect();
    let still = linear(&rows, &[0.0; 9]);
    for integrator in [Integrator::Dop853, Integrator::Radau9, Integrator::Bs5] {
        let (plain, _) = run(&free, integrator.method(1.0), 10.0, &settings(1e-9));
        let cut = Cut { model: &free, rows: &still };
        let (cut, record) = run(&cut, integrator.method(1.0), 10.0, &settings(1e-9));
        assert!(rows.iter().all(|time| record.steps.contains(time)), "{integrator:?}");
        let [plain, cut] = [plain, cut].map(|finish| finish.statistics.steps + finish.statistics.rejected);
        assert!(cut <= plain + rows.len() as u64, "{integrator:?}: {plain} {cut}");
    }
}

/// A system whose steps end at rows that have no other effect.
struct Cut<'a> {
    model: &'a Oscillator,
    rows: &'a Input,
}

impl System<f64, { Oscillator::STATES }, 0> for Cut<'_> {
    fn rate(
        &self,
        t: f64,
        x: &SVector<f64, { Oscillator::STATES }>,
        negative: &[bool; 0],
        dx: &mut SVector<f64, { Oscillator::STATES }>,
    ) {
        self.model.rate(t, x, negative, dx);
    }
    fn next_break(&self, t: f64) -> f64 {
        self.rows.next_break(t)
    }
}

/// Rows at 0.1 k are not quite where the grid of a fixed step has its points; neither makes a sliver of a step.
#[test]
fn fixed_steps_end_at_rows_and_return_to_their_grid() {
    let times: Vec<f64> = (0..=20).map(|k| f64::from(k) / 10.0).collect();
    let values: Vec<f64> = (0..=20).map(|k| f64::from(k % 2)).collect();
    for (step, count) in [(0.1, 20), (0.05, 40), (0.025, 80), (0.03, 80)] {
        let model = mass(linear(&times, &values), Input::default());
        let (finish, record) = run(&model, Rk4::new(step).into(), 2.0, &settings(1.0));
        assert!(times[1..].iter().all(|time| record.steps.contains(time)), "{step}: {:?}", record.steps);
        assert!(finish.statistics.smallest_step > 0.009, "{step}: {}", finish.statistics);
        assert_eq!(finish.statistics.steps, count, "{step}: {:?}", record.steps);
        let on_grid = |k: u32| record.steps.iter().any(|t| (t - f64::from(k) * step).abs() < 1e-12);
        assert!((1..=(1.999 / step) as u32).all(on_grid), "{step}: {:?}", record.steps);
    }
}

#[test]
fn rows_beside_the_start_the_end_and_each_other_are_no_obstacle() {
    let ulp = f64::EPSILON;
    let times = [1.0, 1.0 + ulp, 1.5, 1.5 + 2.0 * ulp, 2.0 - ulp, 2.0];
    let model = mass(linear(&times, &[0.0, 1e-16, 1.0, 1.0, 2.0, 2.0]), Input::default());
    for t0 in [1.0 - 0.5 * ulp, 1.0, 1.0 + ulp] {
        let (mut record, span) = (Record::<2, 0>::default(), Span { t0, t_end: 2.0 });
        let finish = integrate(&model, &mut Dop853::new(), &SVector::zeros(), span, &settings(1e-6), &mut record);
        let finish = finish.expect("the run ends");
        assert!(finish.t == 2.0 && finish.statistics.rejected <= 1, "{}", finish.statistics);
        assert!(finish.statistics.smallest_step > 1e-7, "{}: {:?}", finish.statistics, record.steps);
    }
}

/// A system that gives no later instant has none.
#[test]
fn breaks_that_cannot_be_are_none() {
    struct Stubborn(f64);
    impl System<f64, 1, 0> for Stubborn {
        fn rate(&self, _: f64, _: &SVector<f64, 1>, _: &[bool; 0], dx: &mut SVector<f64, 1>) {
            dx[0] = 1.0;
        }
        fn next_break(&self, _: f64) -> f64 {
            self.0
        }
    }
    for stubborn in [f64::NAN, 0.5, -1.0, f64::NEG_INFINITY] {
        for method in [Integrator::Dop853.method(0.1), Integrator::Rk4.method(0.1)] {
            let (finish, _) = run(&Stubborn(stubborn), method, 1.0, &settings(1e-6));
            assert!((finish.x[0] - 1.0).abs() < 1e-14 && finish.ended == Ended::AtEnd, "{stubborn}");
        }
    }
}

#[test]
fn a_condition_and_samples_see_a_table_as_it_is() {
    // The table's own value passes through 4 N at the middle of its first slope.
    let model = mass(linear(&TIMES, &FORCES), Input::default());
    let push = linear(&TIMES, &FORCES);
    let condition = |t: f64, _: &SVector<f64, 2>, _: &[bool; 0]| push.value(t) - 4.0;
    let settings = Settings { samples: Samples::Every(0.1), ..settings(1e-6) };
    let (mut record, span) = (Record::<2, 0>::default(), Span { t0: 0.0, t_end: 4.0 });
    let start = SVector::zeros();
    let finish = integrate_until(&model, &mut Dop853::new(), &start, span, &settings, condition, &mut record);
    let finish = finish.expect("the run ends");
    assert!(finish.ended == Ended::ByCondition && (finish.t - 0.375).abs() < 1e-15, "{finish:?}");
    assert_eq!(record.samples.len(), 5);
}

#[test]
fn references_see_tables_beyond_double_precision() {
    let inputs = MassInputs { push: linear(&TIMES, &FORCES), pull: Input::default() };
    let model = Mass::<DoubleDouble>::in_scalar(MassParameters::default(), inputs).expect("in range");
    let start = [DoubleDouble::from_f64(0.0); 2];
    let accuracy = Accuracy { columns: 6, tolerance: 1e-26 };
    let span = Span { t0: 0.0, t_end: 4.0 };
    let model = Over::<_, 2, 0, 2>(&model);
    let finish = extended::integrate(&model, &start, span, accuracy, &[1.0], &mut |_, _, _| {}).expect("the run ends");
    let mut y = [DoubleDouble::from_f64(0.0); 2];
    model.outputs(DoubleDouble::from_f64(4.0), &finish.x, &finish.negative, &mut y);
    for (found, exact) in y.iter().zip(closed_form::<DoubleDouble>(4.0)) {
        let error = (*found - exact).to_f64().abs();
        assert!(error < 1e-27, "{error}");
    }
    assert!(finish.steps + finish.rejected < 200, "{finish:?}");
}

#[test]
fn rows_that_are_no_table_are_refused_by_number() {
    let said = |times: &[f64], values: &[f64]| {
        let [linear, cubic] = [Table::linear, Table::cubic].map(|make| make(times, values).unwrap_err().to_string());
        assert_eq!(linear, cubic);
        linear
    };
    assert_eq!(said(&[], &[]), "the table has 0 rows; give at least two");
    assert_eq!(said(&[1.0], &[1.0]), "the table has 1 row; give at least two");
    assert_eq!(said(&[1.0, 2.0], &[1.0]), "the table has 2 times but 1 values; give a value for each time");
    assert_eq!(
        said(&[0.0, 1.0, f64::NAN], &[1.0, 2.0, 3.0]),
        "the time in row 3 of the table is NaN; it must be a finite number"
    );
    assert_eq!(
        said(&[0.0, 1.0, 2.0], &[1.0, f64::INFINITY, 3.0]),
        "the value in row 2 of the table is inf; it must be a finite number"
    );
    for time in [1.0, 0.5] {
        assert_eq!(
            said(&[0.0, 1.0, time], &[1.0, 2.0, 3.0]),
            format!(
                "the times of the table do not ascend: row 3 has t = {time:?} s after t = 1.0 s; sort the rows, and \
                 keep one of those with the same time"
            )
        );
    }
    assert_eq!(
        said(&[0.0, 1e-200, 1.0], &[0.0, 1e200, 0.0]),
        "the table is too steep at row 2 for a number; move its time away from that of the rows beside it"
    );
    assert_eq!(Table::linear(&[0.0], &[0.0, 1.0]), Err(TableError::Lengths { times: 1, values: 2 }));
}
