//! Peaks of outputs: those of the solution, whatever the samples are.

use std::rc::Rc;

use crate::text::{graphs, model};
use bg_model::dynamics::Machine;
use bg_model::integrator::Integrator;
use bg_model::run::{Request, Simulation, Trajectory};
use bg_model::simulation::{Part, Peaks, Samples};

const MODELS: &str = "
    /// A damped oscillator of 5 rad/s and a damping of 0.1 s in the exponent, with a wheel that turns evenly.
    graph Ring {
        param k: N/m = 50.02; param none: N*m/rad = 0;
        1 slide: translation; I body = 2; C spring = k start 0.1; R damper = 0.4;
        slide -> body; slide -> spring; slide -> damper;
        1 shaft: rotation; I wheel = 1 start 3; C turn = none; shaft -> wheel; shaft -> turn;
        observe { x: m = spring.q; v: m/s = slide.flow; cam: 1 = sin(40 * turn.q); still: m = 0.25; turn: rad = turn.q }
    }
    /// A mass at an even speed, and an output that jumps where it passes 1 m.
    graph Jump {
        param none: N/m = 0;
        1 slide: translation; I body = 1 start 2; C way = none; slide -> body; slide -> way;
        observe { x: m = way.q; saw: m = if way.q < 1 { way.q } else { way.q - 5 } }
    }
    /// A ball that falls by 0.5 m and leaves the floor with half of its speed.
    graph Ball {
        gravity [0, -10, 0];
        ground { point floor = [0, 0, 0]; }
        body ball { mass 1; inertia [1, 1, 1]; start at [0, 0.5, 0]; }
        joint guide: prismatic y (ground.floor -> ball) { rigid; }
        stop bottom on guide { at least 0; restitution 0.5; }
        observe { height: m = ball.position.y; speed: m/s = ball.velocity.y }
    }
";

/// The start counts no more from here on, s.
const SETTLED: f64 = 1.0;

fn run(model: &Rc<impl Machine + 'static>, method: Integrator, samples: Samples, t_end: f64) -> Trajectory {
    let settled = Some(SETTLED);
    let request = Request { method, samples, t_end, rtol: 1e-9, peaks: true, settled, ..Request::default() };
    Simulation::over(Rc::clone(model) as Rc<dyn Machine>, request).run().unwrap_or_else(|fault| panic!("{fault}"))
}

fn peaks(run: &Trajectory, name: &str) -> Peaks {
    run.peaks(name).unwrap_or_else(|| panic!("no peaks of {name}"))
}

/// The least and the largest value.
fn values(run: &Trajectory, name: &str) -> [f64; 2] {
    let Peaks { least, largest } = peaks(run, name);
    [least.value, largest.value]
}

fn assert_near(found: [f64; 2], exact: [f64; 2], off: f64) {
    assert!(found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < off), "{found:?} {exact:?}");
}

#[test]
fn peaks_are_those_of_the_solution_by_every_kind_of_method_and_at_any_samples() {
    let graphs = graphs(MODELS);
    let ring = model(&graphs, "Ring", &[]);
    // x = 0.1 exp(-0.1 t) (cos 5 t + 0.02 sin 5 t), whose speed is -0.5002 exp(-0.1 t) sin 5 t: x turns at 0 and at
    // pi / 5, the speed where its slope is zero, tan 5 t = 50.
    let half = std::f64::consts::PI / 5.0;
    let x = [-0.1 * (-0.1 * half).exp(), 0.1];
    let fastest = |t: f64| -0.1 * 5.002 * (-0.1 * t).exp() * (5.0 * t).sin();
    let quarter = 50.0_f64.atan() / 5.0;
    for method in [
        Integrator::Dop853,
        Integrator::Nystrom,
        Integrator::Bs5,
        Integrator::Taylor,
        Integrator::Radau9,
        Integrator::Rodas5p,
        Integrator::Auto,
    ] {
        let unsampled = run(&ring, method, Samples::At(Vec::new()), 3.0);
        assert_near(values(&unsampled, "x"), x, 3e-9);
        assert!((peaks(&unsampled, "x").least.t - half).abs() < 1e-3, "{method:?}");
        assert_near(values(&unsampled, "v"), [fastest(quarter), fastest(quarter + half)], 3e-9);
        // From 1 s on it turns after two and three halves of a turn; the rest is below.
        let late = unsampled.columns[0].settled.expect("the run goes on");
        let turn = |halves: f64| 0.1 * (-0.1 * halves * half).exp();
        assert_near([late.least.value, late.largest.value], [-turn(3.0), turn(2.0)], 3e-9);
        let turned = unsampled.columns[4].settled.expect("the run goes on");
        assert_near([turned.least.value, turned.largest.value], [3.0 * SETTLED, 9.0], 1e-8);
        assert_near(values(&unsampled, "cam"), [-1.0, 1.0], 1e-7);
        assert_near(values(&unsampled, "turn"), [0.0, 9.0], 1e-8);
        assert_eq!(values(&unsampled, "still"), [0.25; 2]);
        for samples in [Samples::Every(0.37), Samples::Every(0.001), Samples::Steps] {
            let sampled = run(&ring, method, samples, 3.0);
            for column in &sampled.columns {
                let other = unsampled.columns.iter().find(|other| other.name == column.name).unwrap();
                let both = [column, other].map(|column| (column.peaks, column.settled));
                assert_eq!(both[0], both[1], "{method:?} {}", column.name);
                let Peaks { least, largest } = column.peaks.unwrap();
                let off = 1e-9 * (largest.value - least.value) + 1e-15;
                let is_inside = |value: &f64| *value >= least.value - off && *value <= largest.value + off;
                assert!(column.values.iter().all(is_inside), "{method:?} {}", column.name);
            }
        }
    }
}

#[test]
fn both_sides_of_a_jump_are_looked_at() {
    let graphs = graphs(MODELS);
    let jump = run(&model(&graphs, "Jump", &[]), Integrator::Dop853, Samples::At(Vec::new()), 2.0);
    assert_near(values(&jump, "saw"), [-4.0, 1.0], 1e-9);
    let Peaks { least, largest } = peaks(&jump, "saw");
    assert_near([least.t, largest.t], [0.5; 2], 1e-9);
    let ball = run(&model(&graphs, "Ball", &[]), Integrator::Dop853, Samples::Every(0.4), 0.8);
    let speed = 10.0_f64.sqrt();
    assert_near(values(&ball, "speed"), [-speed, 0.5 * speed], 1e-8);
    assert_near(values(&ball, "height"), [0.0, 0.5], 1e-8);
}

#[test]
fn peaks_stand_with_the_outputs_only() {
    let graphs = graphs(MODELS);
    let ring = model(&graphs, "Ring", &[]);
    let request = Request {
        parts: vec![Part::States, Part::Outputs, Part::Energy],
        peaks: true,
        t_end: 0.4,
        ..Request::default()
    };
    let run = Simulation::over(ring, request).run().unwrap();
    let outputs = ["x", "v", "cam", "still", "turn"];
    assert!(run.columns.iter().rev().skip(1).zip(outputs.iter().rev()).all(|(column, name)| column.name == *name));
    let states = run.columns.len() - 1 - outputs.len();
    let has_peaks = |column: &bg_model::simulation::Column| column.peaks.is_some();
    assert!(run.columns[states..][..outputs.len()].iter().all(has_peaks));
    assert!(!run.columns[..states].iter().chain(run.columns.last()).any(has_peaks));
    assert!(run.columns[0].values.len() > 1 && values(&run, "x")[0] < 0.0);
}
