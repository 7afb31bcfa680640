//! A reduced scene is the literal model: its outputs are those of the literal model to rounding, over the same steps.
//!
//! What rounding comes to is known from a control, measured on the literal model alone: with gravity changed in its
//! last bit the same outputs change by C 4e-14 m, R 6e-13, p 9e-11 kg m/s, h 8e-12 N m s, F 9e-7 N, gaps 7e-15 m. The
//! pins' stiffness of 1e8 N/m makes a force of 1e-8 N of the last bit of a position, and they ring at 1e4 rad/s almost
//! without decay.

use std::sync::OnceLock;

use bg_model::integrator::Integrator;
use bg_model::mechanism::{Mechanism, MechanismVisitor};
use bg_model::parameters::Parameters;
use bg_model::run::{Simulation, sample_times};
use bg_model::system::{Model, switches};
use hacksaw::agreement::{Agreement, Job, Run, Steps, beside, compare, horizon, literal};
use hacksaw::mechanism::{HacksawParameters, Paper, PaperParameters};
use hacksaw::scenes::Scene;
use hacksaw_planar as planar;

/// The steps of both models, s: as many as the run takes at rtol 1e-10.
const STEP: f64 = 1e-4;

/// The allowed deviation over the larger of 1 and the magnitude of the kind: figures reached, with a factor of about
/// two.
fn allowed(kind: &str) -> f64 {
    match kind {
        // Measured: positions 3e-14, orientations 5e-13, angles 8e-13, energies 1e-13 and less of their size.
        "C" | "R" | "rod_angle" | "frame_angle" | "guide_angle" | "gap" => 1e-12,
        // Measured: 1.2e-12; the scene integrates the angle itself, 185 rad at the end.
        "crank_angle" => 2e-12,
        "stored_energy" | "supplied_energy" | "dissipated_energy" => 1e-12,
        // Measured: 6e-12, 3e-12, 1e-11 (free run) and 9e-12 of their size: what the ringing pins do to velocities.
        "p" | "h" | "crank_speed" | "slip" => 2e-11,
        // Measured: 7e-11 and less of their size, 5e-15 m of the pin's gap times its stiffness.
        "F" | "Fcut" => 2e-10,
        _ => panic!("an output of an unknown kind: {kind}"),
    }
}

fn check(scene: Scene, values: &HacksawParameters, t_end: f64) -> Agreement {
    let instants = sample_times(0.0, t_end / 50.0, t_end);
    assert_eq!(instants.len(), 51);
    let job = Job { steps: Steps::Equal(STEP), t_end, instants: &instants };
    let agreement = if *values == HacksawParameters::default() && scene != Scene::FreeRun {
        // One run of the literal model for all scenes that stand for it.
        static LITERAL: OnceLock<Run> = OnceLock::new();
        assert_eq!(t_end, horizon(Scene::Literal));
        let run = LITERAL.get_or_init(|| literal(scene, values, job).unwrap());
        beside(scene, values, job, run.clone()).unwrap()
    } else {
        compare(scene, values, job).unwrap()
    };
    let outputs = scene.description().outputs.len();
    assert_eq!(agreement.deviations.len(), outputs, "every output of {scene:?} is compared");
    assert_eq!(agreement.scene.statistics.steps, agreement.literal.statistics.steps);
    assert_eq!(agreement.scene.statistics.events, agreement.literal.statistics.events);
    for deviation in &agreement.deviations {
        let relative = deviation.largest / deviation.magnitude.max(1.0);
        assert!(
            relative <= allowed(deviation.kind()),
            "{scene:?}: {} is off by {relative:e} at {} s",
            deviation.name,
            deviation.time
        );
    }
    agreement
}

/// A test for each of these scenes, so that they run side by side: it equals the literal model.
macro_rules! reduced_scenes {
    ($($name:ident: $scene:ident;)*) => {
        const REDUCED: &[Scene] = &[$(Scene::$scene),*];
        $(
            #[test]
            fn $name() {
                check(Scene::$scene, &HacksawParameters::default(), horizon(Scene::$scene));
            }
        )*
    };
}

reduced_scenes! {
    paper_equals_the_literal_model: Paper;
    motion_equals_the_literal_model: Motion;
    full_equals_the_literal_model: Full;
    angles_equal_the_literal_model: Angles;
    a_free_run_equals_the_literal_model: FreeRun;
}

#[test]
fn no_reduced_scene_is_left_out() {
    let all = Scene::ALL.into_iter().filter(|scene| *scene != Scene::Literal && scene.is_compliant());
    assert_eq!(all.collect::<Vec<_>>(), REDUCED);
}

#[test]
fn it_does_so_for_other_values_of_what_it_keeps_adjustable() {
    let mut values = HacksawParameters::default();
    for (name, value) in [
        ("torque", 14.0),
        ("crank_angle", 0.7),
        ("gravity", 1.62),
        ("density", 2700.0),
        ("k_45r", 0.0),
        ("r_cut", 60.0),
        ("r_return", 25.0),
    ] {
        values.set(name, value).unwrap();
    }
    check(Scene::Paper, &values, 0.5);
    // The three-dimensional scene keeps what an offset of the rod sets in motion.
    values.set("rod_offset", 1e-3).unwrap();
    let job = Job { steps: Steps::Equal(1e-7), t_end: 1e-4, instants: &[0.0, 5e-5, 1e-4] };
    let agreement = compare(Scene::Full, &values, job).unwrap();
    assert!(agreement.scene.samples.values("h3_x").unwrap()[2].abs() > 1e-9, "the rod leaves the plane");
    for deviation in &agreement.deviations {
        assert!(deviation.largest <= 1e-12 * deviation.magnitude.max(1.0), "{deviation:?}");
    }
}

#[test]
fn with_steps_by_the_error_only_rounding_in_the_estimate_tells_the_scenes_apart() {
    // The free run is chaotic: a difference in the steps grows to 3e-8 of its crank speed within 0.5 s.
    let tame = |scene: &Scene| scene.is_compliant() && *scene != Scene::FreeRun;
    let values = HacksawParameters::default();
    let (t_end, steps) = (1.0, Steps::ByError { rtol: 1e-10, atol: 1e-14 });
    let instants = sample_times(0.0, t_end / 50.0, t_end);
    let job = Job { steps, t_end, instants: &instants };
    let whole = literal(Scene::Literal, &values, job).unwrap();
    for scene in Scene::ALL.into_iter().filter(tame) {
        let agreement = beside(scene, &values, job, whole.clone()).unwrap();
        assert_eq!(agreement.scene.statistics.events, agreement.literal.statistics.events);
        // Measured over 5 s: 5e-10 (crank speed and pin forces).
        for deviation in &agreement.deviations {
            assert!(deviation.largest <= 5e-9 * deviation.magnitude.max(1.0), "{scene:?}: {deviation:?}");
        }
    }
}

/// The frame's place after `t_end` s with all joint stiffnesses times `factor`.
fn frame(scene: Scene, factor: f64, t_end: f64) -> f64 {
    let mut values = HacksawParameters::default();
    for name in ["k_2", "k_23", "k_34", "k_15", "k_45", "k_45r"] {
        let value = values.get(name).unwrap() * factor;
        values.set(name, value).unwrap();
    }
    scene.visit(FrameAt { values, t_end })
}

struct FrameAt {
    values: HacksawParameters,
    t_end: f64,
}

impl MechanismVisitor for FrameAt {
    type Output = f64;

    fn visit<Sc: Mechanism>(self) -> f64 {
        let mut own = Sc::Parameters::default();
        for info in Sc::Parameters::table() {
            own.set(info.name, self.values.get(info.name).unwrap()).unwrap();
        }
        let model = Sc::make(own, &[]).unwrap();
        let run = Simulation::new(&model).method(Integrator::Dop853).rtol(1e-10).atol(1e-14).at(&[self.t_end]);
        run.until(self.t_end).run().unwrap()["C4_x"][0]
    }
}

#[test]
fn compliant_joints_tend_to_the_rigid_ones_with_their_stiffness() {
    let rigid = frame(Scene::Rigid, 1.0, 0.1);
    let [soft, stiff] = [1.0, 10.0].map(|factor| (frame(Scene::Paper, factor, 0.1) - rigid).abs());
    // The difference goes as 1/k, apart from the ringing of the pins that is left.
    assert!((4.0..25.0).contains(&(soft / stiff)), "{soft:e} and {stiff:e} m");
}

#[test]
fn a_planar_model_written_by_hand_has_the_same_accelerations() {
    let mut values = PaperParameters::default();
    values.set("crank_angle", 0.3).unwrap();
    let model = Paper::new(values).unwrap();
    let start = model.start().unwrap();
    let settings = bg_model::simulation::Settings {
        samples: bg_model::simulation::Samples::Every(0.01),
        ..bg_model::simulation::Settings::default()
    };
    let span = bg_model::simulation::Span { t0: 0.0, t_end: 0.5 };
    let mut comparison = planar::Comparison::default();
    let mut observer = bg_model::simulation::EachSample(|t: f64, x: &[f64], negative: &[bool]| {
        // At the start only the weight and the torque act.
        if t > 0.0 {
            planar::beside(
                &model,
                model.parameters(),
                *bg_model::system::values(x),
                *switches(negative),
                &mut comparison,
            );
        }
    });
    bg_model::simulation::integrate(
        &model,
        &mut bg_model::integrator::Dop853::new(),
        &start,
        span,
        &settings,
        &mut observer,
    )
    .unwrap();
    assert!(comparison.relative() <= 1e-9, "{:e}", comparison.relative());
}
