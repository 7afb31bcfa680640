//! Machines of parameters over twelve decades, beside runs in double-double arithmetic: each state is right to some
//! tolerances of its own largest value.

use bg_model::bond_graph;
use bg_model::capability::Storages;
use bg_model::description::StateKind;
use bg_model::extended::{self, Accuracy};
use bg_model::integrator::Integrator;
use bg_model::mechanism::{Liftable, Mechanism, ModelVisitor};
use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::run::{Request, Simulation, Trajectory};
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Part, Samples, Span};
use bg_model::system::Model;

use crate::random::random_numbers;

bond_graph! {
    /// A rod that swings on a rigid pin with a spring and a damper.
    pub graph Arm {
        param length: m = 1, above 0; param mass: kg = 1, above 0; param field: m/s^2 = 9.81;
        param stiffness: N*m/rad = 3; param damping: N*m*s/rad = 0.1;
        gravity [0, -field, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass mass; inertia [mass * length * length / 100, mass * length * length / 12, mass * length * length / 12];
            point end = [-length / 2, 0, 0]; start end at [0, 0, 0];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        drive spring on pin torque = -stiffness * pin.angle - damping * pin.speed;
        observe { angle: rad = pin.angle }
        scenes only;
        scene Arm { expect planar; tune { length, mass, field, stiffness, damping } }
    }

    /// A motor that drives a wheel through a gear and a shaft that gives.
    pub graph Drive {
        param voltage: V = 24; param winding: Ohm = 1, above 0; param coil: H = 1e-3, above 0;
        param constant: V*s/rad = 0.05;
        param rotor: kg*m^2 = 1e-4, above 0; param ratio: 1 = 4, above 0; param stiffness: N*m/rad = 100, above 0;
        param wheel: kg*m^2 = 0.02, above 0; param bearing: N*m*s/rad = 1e-3, at least 0;
        Se supply = voltage; 1 armature: electrical; I inductance = coil; R resistance = winding;
        GY motor = constant; 1 turn: rotation; I inertia = rotor; TF gear = 1 / ratio;
        0 shaft: rotation; C bar = 1 / stiffness; 1 hub: rotation; I flywheel = wheel; R oil = bearing;
        supply -> armature -> motor -> turn -> gear -> shaft -> hub -> flywheel;
        armature -> inductance; armature -> resistance; turn -> inertia; shaft -> bar; hub -> oil;
        observe { speed: rad/s = hub.flow }
    }

    /// A cylinder behind a valve pushes a mass against a spring.
    pub graph Servo {
        param supply: Pa = 2e7; param opening: m^2 = 5e-6, above 0; param laminar: Pa = 1e4, above 0;
        param density: kg/m^3 = 870, above 0; param volume: m^3 = 5e-4, above 0; param bulk: Pa = 1.4e9, above 0;
        param area: m^2 = 2e-3, above 0; param mass: kg = 150, above 0; param friction: N*s/m = 4e3, at least 0;
        param stiffness: N/m = 2e6, above 0;
        Se pump = supply; 1 pipe: hydraulic; 0 chamber: hydraulic; C oil = volume / bulk;
        orifice valve on pipe { area opening; coefficient 0.62; density density; laminar laminar; }
        TF piston(effort p) = p * area; 1 rod: translation; I load = mass; R seal = friction; C spring = 1 / stiffness;
        pump -> pipe -> chamber -> piston -> rod -> load; chamber -> oil; rod -> seal; rod -> spring;
        observe { pressure: Pa = chamber.effort }
    }
}

/// How large each state of a run counts, in its unit: its largest value, or a billionth of where it counts beside the
/// others. For a storage that is where it would have all the energy that there was.
struct Counting<'a>(&'a Trajectory);

impl ModelVisitor<f64> for Counting<'_> {
    type Output = Vec<f64>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Vec<f64>
    where
        Mo: Model<f64, N, G, M>,
    {
        let (storages, columns) = (model.storages().expect("it stores"), &self.0.recording.columns);
        let (mut most, mut curvatures) = (0.0_f64, SVector::zeros());
        for (k, &t) in self.0.times.iter().enumerate() {
            let x = SVector::from_fn(|i, _| columns[i].values[k]);
            most = most.max(storages.energy(t, &x, &[false; G], &mut curvatures));
        }
        let size = |i: usize| match storages.states()[i].kind {
            StateKind::Momentum(_) | StateKind::Displacement(_) => (2.0 * most / curvatures[i]).sqrt(),
            _ => 1.0,
        };
        let largest = |i: usize| columns[i].values.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        (0..N).map(|i| largest(i).max(1e-9 * size(i))).collect()
    }
}

/// The states of a model at some instants (s) in double-double arithmetic.
pub fn exact(model: &dyn Liftable<DoubleDouble>, instants: &[f64]) -> Vec<Vec<f64>> {
    let values: Vec<DoubleDouble> = model.values().into_iter().map(DoubleDouble::from_f64).collect();
    let system = model.lifted(&values).expect("in range");
    let start = system.start().expect("a start");
    let span = Span { t0: 0.0, t_end: *instants.last().expect("an instant") };
    let accuracy = Accuracy { columns: 10, tolerance: 1e-15 };
    let mut states = Vec::new();
    extended::integrate(&*system, &start, span, accuracy, instants, &mut |_, x, _| {
        states.push(x.iter().copied().map(DoubleDouble::to_f64).collect());
    })
    .expect("a run");
    states
}

/// The largest errors of a run up to `t_end` (s) over its tolerance, at the ends of some of its steps and between them:
/// of any state, in parts of what it counts.
fn errors<Me: Mechanism>(model: &Me, t_end: f64, method: Integrator, rtol: f64) -> [f64; 2] {
    const INSTANTS: usize = 20;
    const INSIDE: [f64; 3] = [0.2, 0.5, 0.8];
    let run = |samples: Samples| {
        let request = Request { method, rtol, t_end, samples, ..Request::default() };
        Simulation::of(model, request).recording(&[Part::States]).run().expect("a run")
    };
    let whole = run(Samples::Steps);
    let sizes = model.visit(Counting(&whole));
    let mut rows: Vec<usize> = (1..=INSTANTS).map(|k| (whole.times.len() - 1) * k / INSTANTS).collect();
    rows.retain(|&row| row > 0);
    rows.dedup();
    let step = |&row: &usize| [whole.times[row - 1], whole.times[row]];
    let between = rows.iter().map(step).flat_map(|[from, to]| INSIDE.map(|part| from + part * (to - from)));
    let ends: Vec<f64> = rows.iter().map(|&row| whole.times[row]).collect();
    [ends, between.collect()].map(|instants| {
        let sampled = run(Samples::At(instants.clone()));
        let exact = exact(model, &instants);
        let columns = sampled.recording.columns.iter().zip(&sizes).enumerate();
        let errors = columns.flat_map(|(state, (column, size))| {
            let both = column.values.iter().zip(&exact);
            both.map(move |(value, exact)| (value - exact[state]).abs() / size)
        });
        errors.fold(0.0, f64::max) / rtol
    })
}

/// Numbers whose logarithms lie evenly.
struct Drawn<F>(F);

impl<F: FnMut() -> f64> Drawn<F> {
    /// One over so many decades, about 1.
    fn over(&mut self, decades: f64) -> f64 {
        10.0_f64.powf(decades * ((self.0)() - 0.5))
    }

    fn over_twelve_decades(&mut self) -> f64 {
        self.over(12.0)
    }
}

/// Ten times the slowest of the angular frequencies and decay rates (1/s) of a machine, but not more than some swings
/// of the fastest, whose phase would leave it, and not so long that an explicit run takes many thousand steps.
fn long_enough(frequencies: &[f64], decays: &[f64]) -> f64 {
    const SWINGS: f64 = 30.0;
    const DECAYS: f64 = 1000.0;
    let fastest = |rates: &[f64]| rates.iter().copied().fold(0.0, f64::max);
    let slowest = frequencies.iter().chain(decays).copied().fold(f64::INFINITY, f64::min);
    (10.0 / slowest).min(SWINGS / fastest(frequencies)).min(DECAYS / fastest(decays))
}

const CASES: usize = 67;
/// So many tolerances a run may err.
const WITHIN: f64 = 30.0;

fn all_are_within_thirty_tolerances<Me: Mechanism>(
    seed: u64,
    mut machine: impl FnMut(&mut Drawn<Box<dyn FnMut() -> f64>>) -> (Me, f64),
) {
    let mut drawn = Drawn(Box::new(random_numbers(seed)) as Box<dyn FnMut() -> f64>);
    for case in 0..CASES {
        let (model, t_end) = machine(&mut drawn);
        for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
            let [ends, between] = errors(&model, t_end, Integrator::Auto, rtol);
            let values = model.parameters().values();
            assert!(ends < WITHIN, "case {case} at {rtol:e}: {ends} tolerances, {values:?} to {t_end} s");
            assert!(between < WITHIN, "case {case} at {rtol:e}: {between} tolerances inside, {values:?} to {t_end} s");
        }
    }
}

#[test]
fn a_pendulum_with_a_spring_and_a_damper() {
    all_are_within_thirty_tolerances(1, |drawn| {
        let [length, mass, field] = std::array::from_fn(|_| drawn.over_twelve_decades());
        let (inertia, weight) = (mass * length * length / 3.0, mass * field * length / 2.0);
        // Beside these the spring leaves an angle that is none, or a motion without it.
        let stiffness = weight * drawn.over(8.0);
        let frequencies = [weight, stiffness].map(|stiffness| (stiffness / inertia).sqrt());
        let damping = inertia * frequencies[1] * drawn.over(4.0);
        let model = Arm::new(ArmParameters { length, mass, field, stiffness, damping }).expect("in range");
        (model, long_enough(&frequencies, &[damping / inertia]))
    });
}

#[test]
fn a_motor_with_a_gear_and_a_wheel() {
    all_are_within_thirty_tolerances(2, |drawn| {
        let [voltage, winding, coil, constant, rotor, stiffness, wheel, bearing] =
            std::array::from_fn(|_| drawn.over_twelve_decades());
        let ratio = drawn.over(4.0);
        let frequencies =
            [constant / (coil * rotor).sqrt(), (stiffness / rotor).sqrt() / ratio, (stiffness / wheel).sqrt()];
        let decays = [winding / coil, bearing / wheel];
        let parameters = DriveParameters { voltage, winding, coil, constant, rotor, ratio, stiffness, wheel, bearing };
        (Drive::new(parameters).expect("in range"), long_enough(&frequencies, &decays))
    });
}

#[test]
fn a_hydraulic_servo() {
    all_are_within_thirty_tolerances(3, |drawn| {
        let [supply, opening, density, volume, bulk, area, mass, friction, stiffness] =
            std::array::from_fn(|_| drawn.over_twelve_decades());
        let laminar = supply * 1e-3;
        let oil = volume / bulk;
        let frequencies = [area / (oil * mass).sqrt(), (stiffness / mass).sqrt()];
        let decays = [0.62 * opening * (2.0 / density / laminar).sqrt() / oil, friction / mass];
        let parameters =
            ServoParameters { supply, opening, laminar, density, volume, bulk, area, mass, friction, stiffness };
        (Servo::new(parameters).expect("in range"), long_enough(&frequencies, &decays))
    });
}

/// With one absolute tolerance of a tenth of `rtol` in SI its pressure was off by 9.7 kPa at 1e-6.
#[test]
fn a_servo_s_pressure_is_right() {
    let model = Servo::new(ServoParameters::default()).expect("in range");
    let methods = [Integrator::Auto, Integrator::Dop853, Integrator::Cfmr7, Integrator::Radau9, Integrator::Ark5];
    for method in methods {
        for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
            let [ends, between] = errors(&model, 0.3, method, rtol);
            assert!(ends < 10.0 && between < WITHIN, "{method:?} at {rtol:e}: {ends}, inside {between} tolerances");
        }
    }
}
