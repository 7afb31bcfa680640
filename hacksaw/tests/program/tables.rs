//! What is said of the hacksaw's scenes and graphs.

use bg_workbench::scenes::Scene;
use bg_workbench::tables::{ScenePart, graph};
use clap::ValueEnum;
use hacksaw::command::program;

fn scenes() -> Vec<Scene> {
    program().models().scenes.clone()
}

#[test]
fn a_stroke_stands_at_the_end_that_receives_the_effort() {
    let bonds = graph(scenes().last().unwrap(), Some(ScenePart::Bonds));
    let line = |name: &str| bonds.lines().find(|line| line.contains(name)).unwrap().to_owned();
    // A flow source receives the effort; an inertia in integral causality does as well.
    assert!(line("ground.place ").contains("|->"), "{}", line("ground.place "));
    assert!(line(" crank.linear").contains("->|"), "{}", line(" crank.linear"));
}

#[test]
fn every_part_of_every_scene_has_text() {
    for scene in &scenes() {
        for part in ScenePart::value_variants() {
            assert!(graph(scene, Some(*part)).lines().count() > 3, "{} {part:?}", scene.name);
        }
    }
}
