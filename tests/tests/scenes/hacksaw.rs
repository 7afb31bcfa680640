use bg_model::description::Description;
use bg_model::system::Model;
use hacksaw::mechanism::{
    Angles, AnglesParameters, FreeRun, FreeRunParameters, Full, FullParameters, Hacksaw, HacksawParameters, Paper,
    PaperParameters,
};

use super::twin::{Table, compared, instants, run, run_unswitched, varied, widened};

const STEP: f64 = 1e-4;
/// Part of a column's largest magnitude, or of 1.
const ROUNDING: f64 = 1e-12;

/// The defaults for 5 s, two other draws for 1 s.
fn cases() -> [(u64, Vec<f64>); 3] {
    [(0, instants(5.0, 500)), (1, instants(1.0, 100)), (2, instants(1.0, 100))]
}

fn literal(parameters: HacksawParameters, samples: &[f64]) -> Table {
    run(&Hacksaw::new(parameters).unwrap(), STEP, samples)
}

/// The angle of the link whose orientation the literal model observes.
fn angle(full: &Table, scene: &Table, name: &str) -> Option<Vec<f64>> {
    let link = ["crank_angle", "rod_angle", "frame_angle", "guide_angle"].iter().position(|known| *known == name)? + 2;
    let [cosine, sine] = ["11", "21"].map(|entry| full.series(&format!("R{link}_{entry}")));
    // Nearest to the scene's, whole turns apart.
    let turned = scene.series(name).into_iter().zip(sine.iter().zip(&cosine)).map(|(near, (sine, cosine))| {
        let angle = sine.atan2(*cosine);
        angle + std::f64::consts::TAU * ((near - angle) / std::f64::consts::TAU).round()
    });
    Some(turned.collect())
}

#[test]
fn paper() {
    for (seed, samples) in cases() {
        let own: PaperParameters = varied(seed, 0.1);
        let scene = run(&Paper::new(own.clone()).unwrap(), STEP, &samples);
        let full = literal(widened(&own), &samples);
        assert!(scene.events > 0 && scene.events == full.events);
        let worst = compared(&format!("Paper {seed}"), &full, &scene, |_| None);
        assert!(worst < ROUNDING, "{worst:e}");
    }
}

#[test]
fn full() {
    for (seed, samples) in cases() {
        let mut own: FullParameters = varied(seed, 0.1);
        own.rod_offset = [0.0, 0.02, -0.01][usize::try_from(seed).unwrap()];
        let scene = run(&Full::new(own.clone()).unwrap(), STEP, &samples);
        let full = literal(widened(&own), &samples);
        assert_eq!(scene.events, full.events);
        let worst = compared(&format!("Full {seed}"), &full, &scene, |_| None);
        assert!(worst < ROUNDING, "{worst:e}");
    }
}

#[test]
fn angles() {
    for (seed, samples) in cases() {
        let own: AnglesParameters = varied(seed, 0.5);
        let scene = run(&Angles::new(own.clone()).unwrap(), STEP, &samples);
        let full = literal(widened(&own), &samples);
        let worst = compared(&format!("Angles {seed}"), &full, &scene, |name| angle(&full, &scene, name));
        assert!(worst < ROUNDING, "{worst:e}");
    }
}

#[test]
fn free_run_is_the_literal_model_with_a_contact_that_does_nothing() {
    for (seed, samples) in cases() {
        let own: FreeRunParameters = varied(seed, 0.5);
        let scene = run(&FreeRun::new(own.clone()).unwrap(), STEP, &samples);
        let free = HacksawParameters { k_work: 0.0, r_work: 0.0, r_cut: 0.0, r_return: 0.0, ..widened(&own) };
        let full = run_unswitched(Hacksaw::new(free).unwrap(), STEP, &samples);
        assert_eq!(scene.events, 0);
        let worst = compared(&format!("FreeRun {seed}"), &full, &scene, |_| None);
        assert!(worst < ROUNDING, "{worst:e}");
    }
}

#[test]
fn the_reports_say_what_went() {
    let summary = |description: &Description| description.reduction.lines().next().unwrap_or_default().to_owned();
    let literal = Hacksaw::new(HacksawParameters::default()).unwrap();
    assert_eq!((literal.description().reduction, literal.description().states.len()), ("", 85));
    let reports = [
        summary(Paper::new(PaperParameters::default()).unwrap().description()),
        summary(Full::new(FullParameters::default()).unwrap().description()),
        summary(Angles::new(AnglesParameters::default()).unwrap().description()),
        summary(FreeRun::new(FreeRunParameters::default()).unwrap().description()),
    ];
    assert_eq!(
        reports,
        [
            "85 states: 46 constant; 8 equal up to sign; 0 recovered; 0 unwatched; 29 integrated; 2 for outputs only",
            "85 states: 0 constant; 0 equal up to sign; 2 recovered; 0 unwatched; 81 integrated; 2 for outputs only",
            "83 states: 46 constant; 8 equal up to sign; 0 recovered; 0 unwatched; 29 integrated; 0 for outputs only",
            "83 states: 46 constant; 8 equal up to sign; 0 recovered; 0 unwatched; 29 integrated; 0 for outputs only",
        ]
    );
}

#[test]
fn probe() {
    let own = FreeRunParameters::default();
    let samples = bond_graph_tests::record::instants(5.0, 500);
    let scene = run(&FreeRun::new(own.clone()).unwrap(), STEP, &samples);
    let free = HacksawParameters { k_work: 0.0, r_work: 0.0, r_cut: 0.0, r_return: 0.0, ..widened(&own) };
    let full = run_unswitched(Hacksaw::new(free).unwrap(), STEP, &samples);
    for k in (0..500).step_by(20) {
        for n in ["crank_speed", "C4_x", "F34_x"] {
            let (a, b) = (full.series(n)[k], scene.series(n)[k]);
            print!("{n} {a:.6e} {:.2e}; ", a - b);
        }
        println!();
    }
}
