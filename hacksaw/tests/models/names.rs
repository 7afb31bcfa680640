//! Scenes, columns, kinds of columns and sources of parameters by their names.

use bg_model::mechanism::Mechanism;
use bg_model::parameters::Parameters;
use hacksaw::agreement::Deviation;
use hacksaw::columns::{continued, has_reference_columns};
use hacksaw::mechanism::{FreeRunParameters, HacksawParameters, PaperParameters};
use hacksaw::scenes::Scene;
use hacksaw::sources::source;

#[test]
fn every_name_leads_to_its_model() {
    let of = |scene: Scene| (scene.name(), scene.description().name, scene.description().states.len());
    let expected = [
        ("paper", "Paper", 31),
        ("motion", "Motion", 29),
        ("full", "Full", 83),
        ("angles", "Angles", 24),
        ("rigid", "Rigid", 9),
        ("free-run", "FreeRun", 29),
        ("literal", "Hacksaw", 85),
    ];
    for (scene, (name, model, states)) in Scene::ALL.into_iter().zip(expected) {
        assert_eq!(of(scene), (name.to_owned(), model, states));
    }
    let has_reference =
        |scene: &Scene| has_reference_columns(scene.description().outputs.iter().map(|output| output.name));
    let with_reference: Vec<Scene> = Scene::ALL.into_iter().filter(has_reference).collect();
    assert_eq!(with_reference, [Scene::Paper, Scene::Full, Scene::Literal]);
}

#[test]
fn parameters_go_over_by_name() {
    let mut values = HacksawParameters::default();
    values.set("r_return", 12.5).unwrap();
    let own: PaperParameters = Scene::Paper.parameters(&values).unwrap();
    assert_eq!(own.get("r_return"), Some(12.5));
    assert_eq!(own.get("rod_offset"), None);
}

#[test]
fn a_value_that_a_scene_keeps_is_refused_with_the_scene_that_takes_it() {
    let mut values = HacksawParameters::default();
    values.set("rod_offset", 0.025).unwrap();
    let fault = Scene::Paper.parameters::<PaperParameters>(&values).unwrap_err();
    assert_eq!(fault.to_string(), "scene `paper` keeps `rod_offset` fixed at 0 m; use --scene full");
    values.set("rod_offset", 0.0).unwrap();
    values.set("k_2", 2e7).unwrap();
    let fault = Scene::FreeRun.parameters::<FreeRunParameters>(&values).unwrap_err();
    assert_eq!(fault.to_string(), "scene `free-run` keeps `k_2` fixed at 1e7 N/m; use --scene paper");
}

#[test]
fn whole_turns_are_counted() {
    let angles = (0..100).map(|k| {
        let angle = f64::from(k) * 0.5;
        angle.sin().atan2(angle.cos())
    });
    assert!((continued(angles).last().unwrap() - 49.5).abs() < 1e-12);
}

#[test]
fn kinds_are_names_without_numbers() {
    let kind = |name: &str| {
        let deviation = Deviation { name: name.to_owned(), largest: 0.0, time: 0.0, magnitude: 0.0 };
        deviation.kind().to_owned()
    };
    let kinds = ["C2_x", "R3_11", "gap_12", "F45_x", "Fcut_x", "stored_energy", "crank_angle"].map(kind);
    assert_eq!(kinds, ["C", "R", "gap", "F", "Fcut", "stored_energy", "crank_angle"]);
}

/// The table of `docs/hacksaw.md` says the same of every parameter.
#[test]
fn the_document_says_the_same() {
    let text = include_str!("../../../docs/hacksaw.md");
    let rows = text.lines().filter(|line| line.ends_with("| P |") || line.ends_with("| A |"));
    let told: Vec<(&str, &str)> = rows
        .flat_map(|row| {
            let source = if row.ends_with("| P |") { "paper" } else { "assumed" };
            let names = row.split('|').nth(2).unwrap_or("").split(',').map(|name| name.trim().trim_matches('`'));
            names.filter(|name| !name.is_empty()).map(move |name| (name, source))
        })
        .collect();
    for info in <hacksaw::mechanism::Hacksaw as Mechanism>::Parameters::table() {
        assert!(told.contains(&(info.name, source(info.name))), "{}: {}", info.name, source(info.name));
    }
}
