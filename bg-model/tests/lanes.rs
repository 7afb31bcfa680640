//! Runs side by side: each gives the bits that it gives by itself, whatever its neighbours do.

use bg_model::bond_graph;
use bg_model::input::Input;
use bg_model::integrator::Integrator;
use bg_model::mechanism::{InEachBuild, Mechanism};
use bg_model::parameters::Parameters;
use bg_model::run::{LaneError, Request, RunError, Simulation, Trajectory, in_lanes};
use bg_model::simulation::{Peaks, Samples};
use bg_model::statistics::Statistics;

bond_graph! {
    /// A block on a stiff spring, shaken; its contact resists its two directions differently, with a jump between them.
    graph Block {
        param mass: kg = 1, above 0; param stiffness: N/m = 400, at least 0; param cut: N*s/m = 5;
        param drop: N = -0.05; param start: m = 0.5;
        1 slide: translation; I block = mass; C spring = stiffness start start;
        MSe shaker = 3 * sin(2 * t) * exp(-0.1 * t);
        R saw(v) = if v < 0 { cut * v - drop } else { 0.4 * v + drop };
        shaker -> slide -> block; slide -> spring; slide -> saw;
        observe { x: m = spring.q; v: m/s = slide.flow; force: N = saw.effort; lost: J = integral(dissipated_power) }
    }
    /// An output that has no value while the spring is pressed by more than the limit.
    graph Rooted {
        param limit: m = 0.05; param stiffness: N/m = 50;
        1 slide: translation; I block = 2; C spring = stiffness start 0.1; slide -> block; slide -> spring;
        observe { x: m = spring.q; root: 1 = sqrt((spring.q + limit) / limit) }
    }
    /// A double pendulum on springs, its second joint much stiffer.
    graph Arms {
        param stiffness: N/m = 1e5; param damping: N*s/m = 20; param spin: rad/s = 1; param gravity: m/s^2 = 9.81;
        param turn: N*m/rad = 1e3; param drag: N*m*s/rad = 1; param rub: N*m*s/rad = 1;
        gravity [0, -gravity, 0];
        ground { point pivot = [0, 0, 0]; }
        body upper { cuboid [0.6, 0.03, 0.03] density 7850; point a = [-0.3, 0, 0]; point b = [0.3, 0, 0];
            start a at [0, 0, 0]; start spin [0, 0, spin]; }
        body lower { cuboid [0.4, 0.02, 0.02] density 7850; point b = [-0.2, 0, 0]; start b at [0.6, 0, 0]; }
        joint shoulder: revolute z (ground.pivot -> upper.a) { stiffness stiffness; damping damping;
            tilt stiffness turn; tilt damping drag; }
        joint elbow: revolute z (upper.b -> lower.b) { stiffness 10 * stiffness; damping damping; tilt stiffness turn;
            tilt damping drag; }
        drive brake on elbow torque = if elbow.speed < 0 { -rub * elbow.speed } else { -0.2 * rub * elbow.speed };
        observe { angle: rad = upper.angle; other: rad = lower.angle; force: N = elbow.force.x }
        scenes only;
        scene Arms { expect planar; }
    }
    /// A rod on a hinge that does not give, with a brake.
    graph Pendulum {
        param angle: rad = 0.4; param friction: N*m*s/rad = 0.05; param spin: rad/s = 1; param gravity: m/s^2 = 9.81;
        gravity [0, -gravity, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            cuboid [0.6, 0.03, 0.03] density 7850; point end = [-0.3, 0, 0]; start end at [0, 0, 0];
            start turned rotation_z(angle);
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, spin];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        drive brake on pin torque = -friction * pin.speed;
        observe { angle: rad = rod.angle; force: N = pin.force.y }
        scenes only;
        scene Pendulum { expect planar; }
    }
    /// A slider and a crank of rigid joints, whose loop the assembly closes.
    graph Crank {
        param angle: rad = 1; param spin: rad/s = -8; param drag: N*s/m = 2;
        ground { point O = [0, 0, 0]; }
        body crank { mass 1; inertia [0.02, 0.02, 0.02]; point a = [-0.1, 0, 0]; point b = [0.1, 0, 0];
            start a at [0, 0, 0]; start turned rotation_z(angle); start velocity [guess(0), guess(0), 0];
            start spin [0, 0, spin]; }
        body link { mass 0.5; inertia [0.01, 0.01, 0.01]; point b = [-0.3, 0, 0]; point c = [0.3, 0, 0];
            start b at [0.2 * cos(angle), 0.2 * sin(angle), 0]; start turned rotation_z(guess(-0.3));
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, guess(0)]; }
        body slider { mass 0.7; inertia [0.01, 0.01, 0.01]; start at [guess(0.7), 0, 0];
            start velocity [guess(0), guess(0), 0]; }
        joint pin_o: revolute z (ground.O -> crank.a) { rigid; }
        joint pin_a: revolute z (crank.b -> link.b) { rigid; }
        joint pin_b: revolute z (link.c -> slider) { rigid; }
        joint guide: prismatic x (ground.O -> slider) { rigid; }
        drive load on guide force = -drag * slider.velocity.x;
        observe { x: m = guide.travel; angle: rad = crank.angle }
        scenes only;
        scene Crank { expect planar; }
    }
    /// A slider and a crank with a link as long as the crank: where they lie on each other its pose is singular.
    graph Folding {
        param angle: rad = 1; param spin: rad/s = -8; param drag: N*s/m = 2;
        ground { point O = [0, 0, 0]; }
        body crank { mass 1; inertia [0.02, 0.02, 0.02]; point a = [-0.1, 0, 0]; point b = [0.1, 0, 0];
            start a at [0, 0, 0]; start turned rotation_z(angle); start velocity [guess(0), guess(0), 0];
            start spin [0, 0, spin]; }
        body link { mass 0.5; inertia [0.01, 0.01, 0.01]; point b = [-0.1, 0, 0]; point c = [0.1, 0, 0];
            start b at [0.2 * cos(angle), 0.2 * sin(angle), 0]; start turned rotation_z(guess(-1));
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, guess(8)]; }
        body slider { mass 0.7; inertia [0.01, 0.01, 0.01]; start at [guess(0.2), 0, 0];
            start velocity [guess(0), guess(0), 0]; }
        joint pin_o: revolute z (ground.O -> crank.a) { rigid; }
        joint pin_a: revolute z (crank.b -> link.b) { rigid; }
        joint pin_b: revolute z (link.c -> slider) { rigid; }
        joint guide: prismatic x (ground.O -> slider) { rigid; }
        drive load on guide force = -drag * slider.velocity.x;
        observe { x: m = guide.travel; angle: rad = crank.angle }
        scenes only;
        scene Folding { expect planar; }
    }
    /// A ball that falls on a floor.
    graph Ball {
        param mass: kg = 2, above 0; param height: m = 1.25; param give: 1 = 0.8;
        1 fall: translation; I ball = mass; Se weight = -mass * 9.81; weight -> fall -> ball;
        stop floor on fall { at least 0; start height; restitution give; }
        observe { y: m = floor.place; v: m/s = fall.flow; lost: J = integral(dissipated_power) }
    }
    /// A mass that a belt carries until its spring tears it off.
    graph Belt {
        param mass: kg = 2, above 0; param stiffness: N/m = 50, above 0; param belt: m/s = 0.1; param still: N = 6;
        1 slide: translation; I body = mass start mass * belt; C spring = stiffness;
        Sf drum = belt; 0 between: translation; 1 slip: translation;
        drum -> between -> slide -> body; slide -> spring; between -> slip;
        friction rub on slip { coulomb 4; static still; }
        observe { x: m = spring.q; v: m/s = slide.flow; force: N = rub.effort }
    }
    /// A mass whose damper knows no speed above a limit.
    graph Fragile {
        param mass: kg = 1, above 0; param limit: m/s = 3; param stiffness: N/m = 40; param damping: N*s/m = 0.1;
        param unit: m/s = 1;
        1 slide: translation; I body = mass; C spring = stiffness start 0.3;
        R damper(v) = damping * v * sqrt((limit - v) / unit);
        slide -> body; slide -> spring; slide -> damper;
        observe { x: m = spring.q; v: m/s = slide.flow }
    }
    /// A mass that something pushes.
    graph Pushed {
        param mass: kg = 1, above 0; param stiffness: N/m = 40;
        input push: N;
        1 slide: translation; I body = mass; C spring = stiffness start 0.3; MSe source = push;
        source -> slide -> body; slide -> spring;
        observe { x: m = spring.q }
    }
    /// A mass that is pushed by what follows from an equation that is not linear.
    graph Square {
        param g: m/N^2/s = 1; param fall: N/s = 0.1; param unit: N = 1;
        MSe source = unit + fall * t; 1 line: translation; R damper = 2; R square(effort e) = g * e * e;
        source -> line -> damper; line -> square;
        MSe push = 3 * square.effort; 1 slide: translation; I mass = 2; push -> slide -> mass;
        observe { effort: N = square.effort; v: m/s = slide.flow }
    }
}

/// The bits of samples, of events and of the last states, and the counts.
type Told = ([Vec<u64>; 3], Statistics);

/// What a run gives, or why it gives nothing.
fn told<E: ToString>(run: &Result<Trajectory, E>) -> Result<Told, String> {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let run = run.as_ref().map_err(ToString::to_string)?;
    let columns = run.columns.iter().flat_map(|column| bits(&column.values));
    let branches = run.last.negative().unwrap_or_default();
    let branches = branches.into_iter().map(|negative| if negative { 1.0 } else { 0.0 });
    let last: Vec<f64> = run.last.values().into_iter().chain(run.last.largest.clone()).chain(branches).collect();
    let peaks = run.columns.iter().flat_map(|column| [column.peaks, column.settled]).flatten();
    let peaks = peaks.flat_map(|Peaks { least, largest }| bits(&[least.t, least.value, largest.t, largest.value]));
    let samples = bits(&run.times).into_iter().chain(columns).chain(peaks).collect();
    Ok(([samples, bits(&run.events), bits(&last)], run.statistics))
}

fn single<Me: Mechanism>(model: &Me, request: &Request, values: &[f64]) -> Result<Trajectory, LaneError> {
    let mut parameters = model.parameters().clone();
    values.iter().enumerate().for_each(|(index, &value)| parameters.set_value(index, value));
    let model = Me::make(parameters, &model.inputs())?;
    Ok(Simulation::of(&model, request.clone()).run()?)
}

/// Makes runs with values of these parameters between two ends, side by side and each by itself; gives what the runs
/// give and how many of them fail.
fn compared<Me: Mechanism>(model: &Me, request: &Request, between: &[(&str, [f64; 2])]) -> (Vec<Trajectory>, usize) {
    const RUNS: usize = 19;
    let table = Me::Parameters::table();
    let values = |run: usize| -> Vec<f64> {
        let value = |(index, name): (usize, &str)| {
            let own = between.iter().position(|(swept, _)| *swept == name);
            own.map_or(model.parameters().value(index), |own| {
                let part = (0.618_033_988_75 * (own + 1) as f64 * run as f64).fract();
                between[own].1[0] + part * (between[own].1[1] - between[own].1[0])
            })
        };
        table.iter().map(|info| info.name).enumerate().map(value).collect()
    };
    let values: Vec<Vec<f64>> = (0..RUNS).map(values).collect();
    // Of functions in vectors, and of those of each run by itself.
    let [runs, apart] = [in_lanes(&InEachBuild(model.clone()), request, &values), in_lanes(model, request, &values)];
    assert_eq!([runs.len(), apart.len()], [RUNS; 2]);
    for (number, ((run, apart), values)) in runs.iter().zip(&apart).zip(&values).enumerate() {
        let alone = told(&single(model, request, values));
        assert_eq!([told(run), told(apart)], [alone.clone(), alone], "run {number}: {values:?}");
    }
    let failed = runs.iter().filter(|run| run.is_err()).count();
    (runs.into_iter().filter_map(Result::ok).collect(), failed)
}

fn request(t_end: f64, rtol: f64) -> Request {
    by(Integrator::Nystrom, t_end, rtol)
}

fn by(method: Integrator, t_end: f64, rtol: f64) -> Request {
    Request { method, t_end, rtol, samples: Samples::Every(t_end / 7.0), ..Request::default() }
}

#[test]
fn branches_and_functions_of_time_are_those_of_each_run() {
    let model = Block::new(BlockParameters::default()).unwrap();
    let swept = [("mass", [0.5, 2.0]), ("cut", [1.0, 9.0]), ("start", [-0.5, 0.5])];
    for rtol in [1e-4, 1e-9] {
        let (runs, failed) = compared(&model, &request(4.0, rtol), &swept);
        let events: Vec<usize> = runs.iter().map(|run| run.events.len()).collect();
        assert!(failed == 0 && events.iter().all(|&events| events > 10), "{events:?}");
    }
}

#[test]
fn stiff_joints_hold_each_run_to_its_own_step() {
    let model = Arms::new(ArmsParameters::default()).unwrap();
    let swept = [("stiffness", [1e4, 1e6]), ("spin", [-3.0, 3.0])];
    let (runs, failed) = compared(&model, &request(0.5, 1e-4), &swept);
    let steps: Vec<u64> = runs.iter().map(|run| run.statistics.steps).collect();
    assert_eq!(failed, 0);
    assert!(steps.iter().max() > steps.iter().min().map(|least| 4 * least).as_ref(), "{steps:?}");
}

#[test]
fn what_rigid_joints_hold_is_projected_for_each_run() {
    let model = Pendulum::new(PendulumParameters::default()).unwrap();
    let swept = [("angle", [-1.5, 1.5]), ("spin", [-3.0, 3.0]), ("friction", [0.0, 0.5])];
    assert_eq!(compared(&model, &request(3.0, 1e-7), &swept).1, 0);
}

#[test]
fn other_explicit_methods_take_the_steps_of_each_run() {
    let block = Block::new(BlockParameters::default()).unwrap();
    let swept = [("mass", [0.5, 2.0]), ("cut", [1.0, 9.0]), ("start", [-0.5, 0.5])];
    for method in [Integrator::Cfmr7, Integrator::Dop853] {
        for rtol in [1e-4, 1e-9] {
            let (runs, failed) = compared(&block, &by(method, 4.0, rtol), &swept);
            assert!(failed == 0 && runs.iter().all(|run| run.events.len() > 10), "{method}");
        }
    }
}

#[test]
fn joints_that_close_loops_are_looked_at_in_each_run() {
    let crank = Crank::new(CrankParameters::default()).unwrap();
    let folding = Folding::new(FoldingParameters::default()).unwrap();
    let swept = [("spin", [-9.0, 9.0]), ("angle", [0.3, 1.3])];
    for method in [Integrator::Nystrom, Integrator::Dop853] {
        assert_eq!(compared(&crank, &by(method, 1.5, 1e-6), &swept).1, 0, "{method}");
        // It goes through its singular poses, with samples in steps there.
        let (runs, _) = compared(&folding, &by(method, 1.5, 1e-6), &swept);
        let passes = |run: &&Trajectory| run.columns[0].values.iter().any(|x| *x < 0.0);
        assert!(runs.iter().filter(passes).count() > 5, "{method}");
    }
}

#[test]
fn impacts_and_friction_that_sticks_are_those_of_each_run() {
    let (ball, belt) = (Ball::new(BallParameters::default()).unwrap(), Belt::new(BeltParameters::default()).unwrap());
    let (runs, failed) = compared(&ball, &request(1.5, 1e-6), &[("height", [0.5, 2.0]), ("give", [0.3, 0.9])]);
    assert!(failed == 0 && runs.iter().all(|run| !run.events.is_empty()));
    let (runs, failed) = compared(&belt, &request(5.0, 1e-6), &[("still", [4.5, 8.0]), ("stiffness", [30.0, 90.0])]);
    assert!(failed == 0 && runs.iter().all(|run| run.events.len() > 2));
}

#[test]
fn peaks_are_those_of_each_run() {
    let block = Block::new(BlockParameters::default()).unwrap();
    let crank = Crank::new(CrankParameters::default()).unwrap();
    let ball = Ball::new(BallParameters::default()).unwrap();
    for method in [Integrator::Nystrom, Integrator::Dop853] {
        let asked = |t_end: f64| Request { peaks: true, settled: Some(0.31 * t_end), ..by(method, t_end, 1e-6) };
        let runs = [
            compared(&block, &asked(4.0), &[("mass", [0.5, 2.0]), ("start", [-0.5, 0.5])]),
            compared(&crank, &asked(1.5), &[("spin", [-9.0, 9.0])]),
            compared(&ball, &asked(1.5), &[("height", [0.5, 2.0]), ("give", [0.3, 0.9])]),
        ];
        for (runs, failed) in runs {
            assert_eq!(failed, 0, "{method}");
            let column = |run: &Trajectory| run.columns[0].peaks.zip(run.columns[0].settled);
            let differ = |run: &&Trajectory| column(run).is_some_and(|(all, late)| all != late);
            assert!(runs.iter().filter(differ).count() > 5, "{method}");
        }
    }
}

#[test]
fn a_run_fails_alone() {
    let model = Fragile::new(FragileParameters::default()).unwrap();
    let (runs, failed) = compared(&model, &request(4.0, 1e-6), &[("limit", [1.0, 3.0])]);
    assert!(failed > 3 && runs.len() > 3, "{failed} of {}", failed + runs.len());
    // Too many steps, no steps at all, values that cannot be.
    let few = Request { step_limit: 40, ..request(4.0, 1e-6) };
    assert_eq!(compared(&model, &few, &[("mass", [0.5, 2.0]), ("limit", [5.0, 9.0])]).1, 19);
    assert_eq!(compared(&model, &request(f64::NAN, 1e-6), &[]).1, 19);
    let none = Request { samples: Samples::Every(1.0), ..request(0.0, 1e-6) };
    let (runs, failed) = compared(&model, &none, &[("mass", [-1.0, 2.0])]);
    assert!(failed > 3 && runs.len() > 3, "{failed} of {}", failed + runs.len());
}

#[test]
fn a_run_whose_output_is_no_number_ends_alone() {
    let model = Rooted::new(RootedParameters::default()).unwrap();
    let (runs, failed) = compared(&model, &request(2.0, 1e-6), &[("limit", [0.05, 0.2])]);
    assert!(failed > 3 && runs.len() > 3, "{failed} of {}", failed + runs.len());
    assert!(
        runs.iter().all(|run| run.columns.iter().all(|column| column.values.iter().all(|value| value.is_finite())))
    );
    // It ends where it does by itself, and not with its neighbours.
    let values: Vec<Vec<f64>> = (1..=11).map(|k| vec![0.02 * f64::from(k), 50.0]).collect();
    let reached = |run: Result<Trajectory, LaneError>| match run {
        Err(LaneError::Run(RunError::Stopped(stopped))) => stopped.trajectory,
        run => run.unwrap(),
    };
    let request = request(2.0, 1e-6);
    for (run, values) in in_lanes(&model, &request, &values).into_iter().zip(&values) {
        let (run, alone) = (reached(run), reached(single(&model, &request, values)));
        assert_eq!((&run.times, run.statistics, &run.last), (&alone.times, alone.statistics, &alone.last));
    }
}

#[test]
fn what_cannot_be_side_by_side_is_made_one_after_the_other() {
    let pushed = |push: Input| Pushed::new(PushedParameters::default(), PushedInputs { push }).unwrap();
    let swept = [("mass", [0.5, 2.0])];
    for push in [Input::constant(2.0), Input::function(|t| t.sin())] {
        assert_eq!(compared(&pushed(push), &request(2.0, 1e-6), &swept).1, 0);
    }
    let block = Block::new(BlockParameters::default()).unwrap();
    let other = [
        Request { method: Integrator::Bs5, ..request(1.0, 1e-6) },
        Request { samples: Samples::Steps, ..request(1.0, 1e-6) },
        request(0.2, 1e-12),
    ];
    for request in other {
        assert_eq!(compared(&block, &request, &swept).1, 0);
    }
    let square = Square::new(SquareParameters::default()).unwrap();
    assert_eq!(compared(&square, &request(1.0, 1e-6), &[("unit", [1.0, 5.0])]).1, 0);
}
