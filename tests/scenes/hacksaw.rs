use bg_model::description::Description;
use bg_model::system::Model;
use hacksaw::mechanism::{
    Angles, AnglesParameters, FreeRun, FreeRunParameters, Full, FullParameters, Hacksaw, HacksawParameters, Paper,
    PaperParameters,
};

use super::twin::{Deviations, Table, compared, instants, run, run_unswitched, varied, widened};

const STEP: f64 = 1e-4;

/// Positions, angles, energies to 1e-12. Rounding of poses makes the joints of 1e8 N/m vibrate at 1e4 1/s: speeds and
/// momenta are held to 2e-10, forces to 5e-6 N, a stretch of 5e-14 m. The literal model departs as far from itself when
/// a parameter changes in its last digit.
fn small(worst: &Deviations) {
    assert!(worst.motion.0 < 1e-12 && worst.rates.0 < 2e-10 && worst.forces.0 < 5e-6, "{worst:?}");
}

#[test]
fn the_last_digit_of_a_parameter_does_as_much_to_the_literal_model() {
    let samples = instants(5.0, 500);
    let torque = HacksawParameters::default().torque.next_up();
    let (one, other) = (
        literal(HacksawParameters::default(), &samples),
        literal(HacksawParameters { torque, ..Default::default() }, &samples),
    );
    let worst = compared("Hacksaw and its torque's last digit", &one, &other, |_| None);
    assert!(worst.rates.0 > 1e-12 && worst.forces.0 > 1e-8, "{worst:?}");
}

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
        small(&worst);
    }
}

#[test]
fn full() {
    for (seed, samples) in cases() {
        let own = FullParameters { rod_offset: 0.0, ..varied(seed, 0.1) };
        let scene = run(&Full::new(own.clone()).unwrap(), STEP, &samples);
        let full = literal(widened(&own), &samples);
        assert_eq!(scene.events, full.events);
        small(&compared(&format!("Full {seed}"), &full, &scene, |_| None));
    }
}

#[test]
fn full_out_of_the_plane() {
    // Tilts decay within microseconds: the explicit method needs such steps.
    for (seed, rod_offset) in [(1, 0.02), (2, -0.01)] {
        let own = FullParameters { rod_offset, ..varied(seed, 0.1) };
        let samples = instants(0.04, 40);
        let scene = run(&Full::new(own.clone()).unwrap(), 1e-6, &samples);
        let full = run(&Hacksaw::new(widened(&own)).unwrap(), 1e-6, &samples);
        assert!(scene.series("C3_z").iter().any(|z| (z - rod_offset).abs() > 1e-9), "it leaves its plane");
        small(&compared(&format!("Full, rod offset {rod_offset}"), &full, &scene, |_| None));
    }
}

#[test]
fn angles() {
    for (seed, samples) in cases() {
        let own: AnglesParameters = varied(seed, 0.5);
        let scene = run(&Angles::new(own.clone()).unwrap(), STEP, &samples);
        let full = literal(widened(&own), &samples);
        let worst = compared(&format!("Angles {seed}"), &full, &scene, |name| angle(&full, &scene, name));
        small(&worst);
    }
}

#[test]
fn free_run_is_the_literal_model_with_a_contact_that_does_nothing() {
    // The default torque drives the free machine through its dead centres, where rounding grows e-fold in hundredths of
    // a second: 5 s at a small torque, a second at the default.
    for (torque, samples) in [(0.2, instants(5.0, 500)), (10.0, instants(1.0, 100)), (-6.0, instants(1.0, 100))] {
        let own = FreeRunParameters { torque, ..varied(0, 0.5) };
        let scene = run(&FreeRun::new(own.clone()).unwrap(), STEP, &samples);
        let free = HacksawParameters { k_work: 0.0, r_work: 0.0, r_cut: 0.0, r_return: 0.0, ..widened(&own) };
        let full = run_unswitched(Hacksaw::new(free).unwrap(), STEP, &samples);
        assert_eq!(scene.events, 0);
        small(&compared(&format!("FreeRun at {torque} N m"), &full, &scene, |_| None));
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
            "87 states: 46 constant; 8 equal up to sign; 9 recovered; 0 unwatched; 24 integrated; 0 for outputs only",
            "83 states: 46 constant; 8 equal up to sign; 0 recovered; 0 unwatched; 29 integrated; 0 for outputs only",
        ]
    );
}
