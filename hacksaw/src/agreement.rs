//! How far a scene is from the literal model: the measured side of what the compiler proves about it.
//!
//! In: a scene, parameter values, the steps to take. Out: for each output that the literal model has as well the
//! largest difference over the run. Both take the same method and tolerances; the energy integrals, which not every
//! scene has, have no part in the choice of the steps. The literal counterpart of a scene without a contact has that
//! contact's coefficients at zero and does not watch its switch.

use std::error::Error;

use bg_model::assembly::AssemblyError;
use bg_model::capability::Named;
use bg_model::description::{Description, StateInfo, StateKind};
use bg_model::dynamics::{Machine, shared};
use bg_model::integrator::{Absolute, Dop853, Tolerances};
use bg_model::mechanism::{Mechanism, MechanismVisitor};
use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::simulation::{Part, Recorder, Recording, Samples, Settings, Span, drive};
use bg_model::statistics::Statistics;
use bg_model::system::{Model, Powers, System};
use bg_workbench::compare;

use crate::columns::{AXES, add_angles};
use crate::mechanism::{Hacksaw, HacksawParameters};
use crate::scenes::Scene;

/// The steps that both models take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// Those of the run, Dormand and Prince's method of order 8 with steps by the estimated error: relative and
    /// absolute tolerance. Rounding in the estimate makes them differ a little between two models.
    ByError {
        /// Relative.
        rtol: f64,
        /// Absolute, in each state's SI unit.
        atol: f64,
    },
    /// The same method with this step, s, whatever the error: the same steps but for those that end at an event.
    Equal(f64),
}

/// The largest difference in one output.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The output's name.
    pub name: String,
    /// The largest |scene - literal|, in the output's unit.
    pub largest: f64,
    /// When, s.
    pub time: f64,
    /// The largest |literal| of the outputs of the same kind, in the same unit.
    pub magnitude: f64,
}

impl Deviation {
    /// The output's kind: its name without link and component, such as `C`, `R` or `gap`.
    #[must_use]
    pub fn kind(&self) -> &str {
        kind(&self.name)
    }
}

/// A run of one of the two.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its outputs at the instants.
    pub samples: Recording,
    /// What it took.
    pub statistics: Statistics,
}

/// A scene beside the literal model.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The scene's run.
    pub scene: Run,
    /// The literal model's.
    pub literal: Run,
    /// The outputs that both have, in the scene's order.
    pub deviations: Vec<Deviation>,
}

/// Runs `scene` and the literal model with the same `values` and compares them.
///
/// # Errors
/// Values that the scene does not take, and a run that fails.
// To be inlined, as `literal` is: compiled where it is called, since no program does.
#[inline]
pub fn compare(scene: Scene, values: &HacksawParameters, job: Job) -> Result<Agreement, Box<dyn Error>> {
    beside(scene, values, job, literal(scene, values, job)?)
}

/// Runs `scene` and compares it with the run that [`literal`] has given for the same `values` and `job`.
///
/// # Errors
/// Values that the scene does not take, and a run that fails.
#[inline]
pub fn beside(scene: Scene, values: &HacksawParameters, job: Job, literal: Run) -> Result<Agreement, Box<dyn Error>> {
    let reduced = scene.visit(Reduced { scene, values, job })?;
    let mut whole = literal.samples.clone();
    add_angles(&mut whole)?;
    let deviations = deviations(&reduced.samples, &whole)?;
    Ok(Agreement { scene: reduced, literal, deviations })
}

/// How long a comparison of `scene` means something, s: the paper's 5 s; with the blade off the work 1 s.
///
/// Without the blade's resistance the crank speeds up and the motion turns chaotic: between 1 and 1.5 s a difference in
/// the last bit grows by a factor of some 1e5, and by 2 s no digit is left, whatever the formulation.
#[must_use]
pub fn horizon(scene: Scene) -> f64 {
    if scene == Scene::FreeRun { 1.0 } else { 5.0 }
}

/// How both are run.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// How their steps are chosen.
    pub steps: Steps,
    /// Until when, s.
    pub t_end: f64,
    /// When they are compared, s.
    pub instants: &'a [f64],
}

impl Job<'_> {
    fn run(&self, model: &dyn Machine) -> Result<Run, Box<dyn Error>> {
        // Larger than any error: what has it does not shorten a step.
        const NEVER: f64 = 1e300;
        let (relative, absolute, step) = match self.steps {
            Steps::ByError { rtol, atol } => (rtol, atol, f64::INFINITY),
            Steps::Equal(step) => (1.0, NEVER, step),
        };
        let states = model.description().states;
        let of_state = |state: &StateInfo| if state.kind == StateKind::Integral { NEVER } else { absolute };
        let absolute = states.iter().map(of_state).collect();
        let settings = Settings {
            tolerances: Tolerances { relative, absolute: Absolute::PerState(absolute) },
            first_step: step.is_finite().then_some(step),
            largest_step: step,
            samples: Samples::At(self.instants.to_vec()),
            ..Settings::default()
        };
        let mut recorder = Recorder::new(model, &[Part::Outputs]);
        let span = Span { t0: 0.0, t_end: self.t_end };
        let finish = drive(model, &mut Dop853::new(), &model.start()?, span, &settings, None, &mut recorder);
        Ok(Run { samples: recorder.recording, statistics: finish?.statistics })
    }
}

struct Reduced<'a> {
    scene: Scene,
    values: &'a HacksawParameters,
    job: Job<'a>,
}

impl MechanismVisitor for Reduced<'_> {
    type Output = Result<Run, Box<dyn Error>>;

    fn visit<Sc: Mechanism>(self) -> Self::Output {
        self.job.run(&*Sc::make(self.scene.parameters(self.values)?, &[])?.machine())
    }
}

/// The run of the literal model that `scene` stands for: the same for all but the free run.
///
/// # Errors
/// Values that no machine has, and a run that fails.
#[inline]
pub fn literal(scene: Scene, values: &HacksawParameters, job: Job) -> Result<Run, Box<dyn Error>> {
    let mut values = values.clone();
    if scene != Scene::FreeRun {
        return job.run(&*Hacksaw::new(values)?.machine());
    }
    for name in ["r_cut", "r_return", "k_work", "r_work"] {
        values.set(name, 0.0)?;
    }
    job.run(&*shared(Unswitched(Hacksaw::new(values)?)))
}

/// A model with its one switch left in the branch of the positive guard: right where both branches are the same.
struct Unswitched<Mo>(Mo);

impl<Mo: System<f64, N, 1>, const N: usize> System<f64, N, 0> for Unswitched<Mo> {
    fn rate(&self, t: f64, x: &SVector<f64, N>, _negative: &[bool; 0], dx: &mut SVector<f64, N>) {
        self.0.rate(t, x, &[false], dx);
    }

    fn project(&self, t: f64, _negative: &[bool; 0], x: &mut SVector<f64, N>) {
        self.0.project(t, &[false], x);
    }

    fn named(&self) -> Option<&impl Named<f64, N, 0>> {
        Some(self)
    }
}

impl<Mo: System<f64, N, 1>, const N: usize> Named<f64, N, 0> for Unswitched<Mo> {
    fn state_name(&self, index: usize) -> &'static str {
        self.0.named().map_or("state", |named| named.state_name(index))
    }
}

impl<Mo: Model<f64, N, 1, M>, const N: usize, const M: usize> Model<f64, N, 0, M> for Unswitched<Mo> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn start(&self) -> Result<SVector<f64, N>, AssemblyError> {
        self.0.start()
    }

    fn outputs(&self, t: f64, x: &SVector<f64, N>, _negative: &[bool; 0], y: &mut SVector<f64, M>) {
        self.0.outputs(t, x, &[false], y);
    }

    fn stored_energy(&self, t: f64, x: &SVector<f64, N>, _negative: &[bool; 0]) -> f64 {
        self.0.stored_energy(t, x, &[false])
    }

    fn powers(&self, t: f64, x: &SVector<f64, N>, _negative: &[bool; 0]) -> Powers<f64> {
        self.0.powers(t, x, &[false])
    }
}

fn deviations(scene: &Recording, literal: &Recording) -> Result<Vec<Deviation>, Box<dyn Error>> {
    if scene.times != literal.times {
        return Err("the two runs have different instants".into());
    }
    let mut magnitudes: Vec<(&str, f64)> = Vec::new();
    for column in &literal.columns {
        let largest = column.values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        match magnitudes.iter_mut().find(|(other, _)| *other == kind(&column.name)) {
            Some((_, magnitude)) => *magnitude = magnitude.max(largest),
            None => magnitudes.push((kind(&column.name), largest)),
        }
    }
    let of_kind = |name: &str| magnitudes.iter().find(|(of, _)| *of == kind(name)).map_or(0.0, |(_, most)| *most);
    let found = compare::deviations(scene, literal).into_iter();
    Ok(found
        .map(|compare::Deviation { name, largest, time, .. }| {
            let magnitude = of_kind(&name);
            Deviation { name, largest, time, magnitude }
        })
        .collect())
}

/// A name without the link's number and the component.
fn kind(name: &str) -> &str {
    let word = name.find(|c: char| c.is_ascii_digit()).map_or(name, |digit| &name[..digit]);
    let word = AXES.iter().find_map(|axis| word.strip_suffix(axis)?.strip_suffix('_')).unwrap_or(word);
    word.trim_end_matches('_')
}
