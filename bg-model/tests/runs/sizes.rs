//! The default error norm: it depends neither on units nor on the size of a machine, and knows each state's own size.

use bg_model::bond_graph;
use bg_model::input::{Input, Table};
use bg_model::integrator::{Integrator, Tolerances};
use bg_model::mechanism::Mechanism;
use bg_model::run::{Simulation, Trajectory};
use bg_model::simulation::{Observer, Part, Samples, Settings, Span, drive};
use bg_model::statistics::Statistics;

use crate::decades::exact;

bond_graph! {
    /// A charged capacitor, a coil and a resistance in one mesh.
    pub graph Mesh {
        param resistance: Ohm = 1; param inductance: H = 1e-6; param capacitance: F = 1e-9; param charged: V = 5;
        1 mesh: electrical;
        I coil = inductance; R wire = resistance; C plates = 1 / capacitance start capacitance * charged;
        mesh -> coil; mesh -> wire; mesh -> plates;
        observe { voltage: V = plates.effort; current: A = mesh.flow }
    }

    /// Ten sections of a line of resistances and capacitors, without charge at the start: the charge of the last one
    /// begins with the tenth power of the time, or with the eleventh where the source begins at zero.
    pub graph Line {
        input voltage: V;
        param resistance: Ohm = 1e3, above 0; param capacitance: F = 1e-9, above 0;
        Se source = voltage;
        1 m[k in 0..10]: electrical;
        R r[k in 0..10] = resistance;
        0 n[k in 0..10]: electrical;
        C c[k in 0..10] = 1 / capacitance;
        source -> m[0];
        for k in 0..10 { m[k] -> r[k]; m[k] -> n[k]; n[k] -> c[k]; }
        for k in 1..10 { n[k - 1] -> m[k]; }
        observe { last: V = c[9].effort; gone: V*s = integral(c[9].effort) }
    }

    /// A rod on a compliant pin, of any size: in the plane.
    pub graph Swinging {
        param size: m = 1, above 0; param heavy: kg = 1, above 0; param field: m/s^2 = 9.81;
        param losses: Hz = 50, at least 0;
        gravity [0, -field, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass heavy; inertia [heavy * size * size / 100, heavy * size * size / 12, heavy * size * size / 12];
            point end = [-size / 2, 0, 0]; start end at [0, 0, 0];
        }
        joint pin: revolute z (ground.pivot -> rod.end) {
            stiffness heavy * 1e6; damping heavy * losses; tilt stiffness heavy * size * size * 1e4;
        }
        observe { height: m = rod.position.y; pin.force }
        scenes only;
        scene Swinging { expect planar; tune { size, heavy, field, losses } }
    }
}

const METHODS: [Integrator; 8] = [
    Integrator::Auto,
    Integrator::Dop853,
    Integrator::Cfmr7,
    Integrator::Bs5,
    Integrator::Taylor,
    Integrator::Radau9,
    Integrator::Nystrom,
    Integrator::Rodas5p,
];

/// The voltage of the mesh at time `t` (s) in closed form, over that at the start.
fn discharged(MeshParameters { resistance, inductance, capacitance, .. }: &MeshParameters, t: f64) -> f64 {
    let decay = 0.5 * resistance / inductance;
    let squared = 1.0 / (inductance * capacitance) - decay * decay;
    if squared > 0.0 {
        let (sine, cosine) = (squared.sqrt() * t).sin_cos();
        return (-decay * t).exp() * (cosine + decay / squared.sqrt() * sine);
    }
    // The slow rate without the difference of two like numbers.
    let fast = decay + (-squared).sqrt();
    let slow = 1.0 / (inductance * capacitance * fast);
    (fast * (-slow * t).exp() - slow * (-fast * t).exp()) / (fast - slow)
}

/// The largest error of the voltage, in parts of the one at the start, over `rtol`.
fn error(parameters: MeshParameters, method: Integrator, rtol: f64, t_end: f64) -> f64 {
    let exact = parameters.clone();
    let model = Mesh::new(parameters).expect("in range");
    let run = Simulation::new(&model).method(method).rtol(rtol).every(t_end / 100.0).until(t_end).run().expect("a run");
    let wrong = run.times.iter().zip(&run["voltage"]);
    let wrong = wrong.map(|(t, voltage)| (voltage / exact.charged - discharged(&exact, *t)).abs());
    wrong.fold(0.0, f64::max) / rtol
}

#[test]
fn an_amplitude_does_not_matter() {
    for charged in [5.0, 5e-3, 5e-9, 5e6] {
        for method in METHODS {
            for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
                let error = error(MeshParameters { charged, ..MeshParameters::default() }, method, rtol, 2e-6);
                assert!(error < 3.0, "{method:?} at {rtol:e} from {charged} V: {error} tolerances");
            }
        }
    }
}

/// Numbers between 0 and 1, in a fixed order.
struct Drawn(u64);

impl Drawn {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number between 1e-6 and 1e6, its logarithm evenly.
    fn over_twelve_decades(&mut self) -> f64 {
        10.0_f64.powf(12.0 * self.next() - 6.0)
    }
}

#[test]
fn circuits_over_twelve_decades_are_within_thirty_tolerances() {
    let mut drawn = Drawn(7);
    for case in 0..200 {
        let [resistance, inductance, capacitance, charged] = std::array::from_fn(|_| drawn.over_twelve_decades());
        let parameters = MeshParameters { resistance, inductance, capacitance, charged };
        // Ten periods, or ten times the slow decay.
        let t_end = 10.0 * (inductance * capacitance).sqrt().max(resistance * capacitance);
        for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
            let error = error(parameters.clone(), Integrator::Auto, rtol, t_end);
            assert!(error < 30.0, "case {case} at {rtol:e}: {error} tolerances, {parameters:?}");
        }
    }
}

/// The counts of a run, and all that it has recorded, each column over a factor.
fn measured(run: &Trajectory, factors: &[f64]) -> (u64, u64, Vec<Vec<u64>>) {
    let bits = |(column, factor): (&Vec<f64>, &f64)| column.iter().map(|value| (value / factor).to_bits()).collect();
    let columns: Vec<&Vec<f64>> = run.recording.columns.iter().map(|column| &column.values).collect();
    assert_eq!(columns.len(), factors.len());
    (run.statistics.steps, run.statistics.rejected, columns.into_iter().zip(factors).map(bits).collect())
}

/// Factors are powers of two, so that nothing is rounded otherwise.
#[test]
fn a_circuit_in_other_units_takes_the_same_steps_to_the_same_bits() {
    for method in METHODS {
        let run = |volts: f64, amperes: f64| {
            let parameters = MeshParameters {
                resistance: volts / amperes,
                inductance: 1e-6 * volts / amperes,
                capacitance: 1e-9 * amperes / volts,
                charged: 5.0 * volts,
            };
            let model = Mesh::new(parameters).expect("in range");
            let parts = [Part::Outputs, Part::States, Part::Energy];
            let run = Simulation::new(&model).method(method).every(1e-7).until(2e-6).recording(&parts);
            // A second is a second: the charge is in amperes, the flux linkage in volts.
            let run = run.run().expect("a run");
            assert_eq!(run.recording.columns[2].name, "plates.q");
            measured(&run, &[volts, amperes, amperes, volts, volts * amperes])
        };
        let expected = run(1.0, 1.0);
        for [volts, amperes] in [[-40, 0], [40, 0], [0, -40], [0, 40], [-30, 20]] {
            let [volts, amperes] = [volts, amperes].map(|exponent| 2.0_f64.powi(exponent));
            assert_eq!(run(volts, amperes), expected, "{method:?}: {volts} V, {amperes} A");
        }
    }
}

/// A first step of a machine a million times faster or slower is as much longer or shorter.
#[test]
fn a_circuit_of_another_speed_takes_the_same_steps_to_the_same_bits() {
    for method in METHODS {
        let run = |second: f64| {
            let (inductance, capacitance) = (1e-6 * second, 1e-9 * second);
            let parameters = MeshParameters { inductance, capacitance, ..MeshParameters::default() };
            let model = Mesh::new(parameters).expect("in range");
            let parts = [Part::Outputs, Part::States, Part::Energy];
            let (step, end) = (2.0_f64.powi(-23) * second, 2.0_f64.powi(-19) * second);
            let run = Simulation::new(&model).method(method).every(step).until(end);
            measured(&run.recording(&parts).run().expect("a run"), &[1.0, 1.0, second, second, second])
        };
        let expected = run(1.0);
        for exponent in [-20, 20, 40] {
            assert_eq!(run(2.0_f64.powi(exponent)), expected, "{method:?}: 2^{exponent}");
        }
    }
}

#[test]
fn a_mechanism_of_another_size_takes_the_same_steps_to_the_same_bits() {
    for method in METHODS {
        let run = |size: f64, heavy: f64| {
            let parameters = SwingingParameters { size, heavy, field: 9.81 * size, ..SwingingParameters::default() };
            let model = Swinging::new(parameters).expect("in range");
            let run = Simulation::new(&model).method(method).rtol(1e-7).every(0.01).until(0.3).run().expect("a run");
            measured(&run, &[size, heavy * size, heavy * size, heavy * size])
        };
        let expected = run(1.0, 1.0);
        for [size, heavy] in [[-20, 0], [20, 0], [0, -20], [0, 20], [-20, -60], [7, 21]] {
            let [size, heavy] = [size, heavy].map(|exponent| 2.0_f64.powi(exponent));
            assert_eq!(run(size, heavy), expected, "{method:?}: {size} m, {heavy} kg");
        }
    }
}

/// The last voltage 20 us after the source begins, which is constant, or a ramp: at the start, or at `begins` (s),
/// before which all is at rest.
fn last_of_line(method: Integrator, rtol: f64, begins: f64, is_ramp: bool) -> f64 {
    let voltage = if is_ramp {
        Input::table(Table::linear(&[0.0, begins, begins + 1e-5], &[0.0, 0.0, 1.0]).expect("a table"))
    } else {
        Input::constant(1.0)
    };
    let model = Line::new(LineParameters::default(), LineInputs { voltage }).expect("in range");
    let run = Simulation::new(&model).method(method).rtol(rtol).every(2e-5 + begins).until(2e-5 + begins).run();
    *run.expect("a run")["last"].last().expect("a sample")
}

#[test]
fn what_grows_from_nothing_is_controlled_from_the_first_step_on() {
    for (begins, is_ramp) in [(0.0, false), (1e-6, true), (3e-3, true)] {
        let exact = last_of_line(Integrator::Radau9, 1e-12, begins, is_ramp);
        // Series are of inputs that are constant.
        for method in METHODS.into_iter().filter(|method| !(is_ramp && *method == Integrator::Taylor)) {
            for rtol in [1e-4, 1e-6, 1e-8] {
                let last = last_of_line(method, rtol, begins, is_ramp);
                let error = (last / exact - 1.0).abs() / rtol;
                assert!(error < 100.0, "{method:?} at {rtol:e} from {begins} s: {error} tolerances");
            }
        }
    }
}

#[test]
fn states_whose_errors_were_never_controlled_are_named() {
    let model = Mesh::new(MeshParameters::default()).expect("in range");
    let run = Simulation::new(&model).every(1e-7).until(2e-6);
    assert!(run.run().expect("a run").uncontrolled.is_empty());
    let run = Simulation::new(&model).atol(1e-7).every(1e-7).until(2e-6).run().expect("a run");
    assert_eq!(run.uncontrolled, ["plates.q"]);
}

/// The voltage of a mesh falls by thirteen decades, and goes on falling.
#[test]
fn a_run_that_goes_on_measures_errors_as_the_whole_run_does() {
    let model = Mesh::new(MeshParameters { resistance: 10.0, ..MeshParameters::default() }).expect("in range");
    for method in METHODS {
        let until = |t: f64| Simulation::new(&model).method(method).every(1e-6).until(t);
        let [half, whole] = [6e-6, 12e-6].map(|t| until(t).run().expect("a run"));
        let mut pieces = half.clone();
        pieces.continue_until(&model, 12e-6).expect("a run");
        let more = pieces.statistics.steps.saturating_sub(whole.statistics.steps);
        // The first steps grow from an estimate, and a run's steps fall otherwise after a break.
        assert!(more <= 16, "{method:?}: {more} more");
        let mut anew = half.last.clone();
        anew.largest = anew.values();
        let anew = until(12e-6).from(&anew).run().expect("a run").statistics.steps;
        let rest = whole.statistics.steps - half.statistics.steps;
        assert!(anew > rest + 16, "{method:?}: {anew} steps that know of smaller states only, {rest} of the whole run");
    }
}

/// Ends a run with the first step that leads beyond a time, s.
struct Beyond {
    t: f64,
    has_passed: bool,
}

impl Observer for Beyond {
    fn step(&mut self, t: f64, _: f64, _: &Statistics) {
        self.has_passed = t > self.t;
    }
    fn is_done(&self) -> bool {
        self.has_passed
    }
}

/// From rest momenta move at once, positions later. Where only the former are looked at, the sizes of a first step are
/// those of a free fall to the end of the run, and its tolerances so much too large: BS5 erred by 165 at 1e-10.
#[test]
fn from_rest_a_stiff_pin_is_followed_as_exactly_in_a_long_run() {
    let model = Swinging::new(SwingingParameters { losses: 0.0, ..SwingingParameters::default() }).expect("in range");
    let machine = model.machine();
    let start = machine.start().expect("a start");
    let force = |t: f64, x: &[f64]| {
        let mut y = vec![0.0; machine.description().outputs.len()];
        machine.outputs(t, x, &[], &mut y);
        [y[1], y[2]]
    };
    for method in METHODS {
        for rtol in [1e-6, 1e-8, 1e-10] {
            let span = Span { t0: 0.0, t_end: 1e3 };
            let samples = Samples::Every(f64::INFINITY);
            let settings = Settings { tolerances: Tolerances::relative(rtol), samples, ..Settings::default() };
            let mut beyond = Beyond { t: 2e-3, has_passed: false };
            let finish =
                drive(&*machine, &mut method.method(1.0), &start, span, &settings, None, &mut beyond).expect("a run");
            let there = exact(&model, &[finish.t]).remove(0);
            let [found, exact] = [finish.x.as_slice(), &there].map(|x| force(finish.t, x));
            let off = (found[0] - exact[0]).hypot(found[1] - exact[1]) / exact[0].hypot(exact[1]) / rtol;
            assert!(off < 10.0, "{method:?} at {rtol:e}: {off} tolerances at {} s", finish.t);
        }
    }
}
