//! The pictures of the hacksaw's graph, read back from their files and compared with the table of bonds that is
//! printed.

use std::fs;

use crate::support::{Picture, faults, faults_in_words, tables};
use assert_cmd::Command;
use bg_picture::Graph;

fn printed(arguments: &[&str]) -> String {
    let output = Command::cargo_bin("hacksaw").unwrap().args(arguments).assert().success().get_output().clone();
    String::from_utf8(output.stdout).unwrap()
}

fn drawn(scene: &str, level: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("graph.svg");
    printed(&["graph", "--scene", scene, "--level", level, "--svg", file.to_str().unwrap()]);
    fs::read_to_string(file).unwrap()
}

#[test]
fn the_pictures_are_legible_and_have_the_strokes_of_the_table() {
    for scene in ["literal", "rigid", "free-run"] {
        let rows = |part: &str| printed(&["graph", "--scene", scene, "--part", part]);
        let (svg, words) = (drawn(scene, "full"), drawn(scene, "words"));
        assert_eq!(faults(&tables(&rows("elements"), &rows("bonds")), &svg), [""; 0], "{scene}");
        assert_eq!(faults_in_words(&Graph::default(), &words), [""; 0], "{scene}");
        assert_eq!(svg, drawn(scene, "full"), "{scene}: the same bytes again");
        println!("{scene}: {:?}, {} and {} bytes", Picture::read(&svg).counts(), svg.len(), words.len());
        assert!(svg.len() < 100_000 && words.len() < 20_000, "{scene}: {} and {} bytes", svg.len(), words.len());
    }
}

#[test]
fn only_rigid_joints_put_inertias_under_multipliers() {
    let marked = |scene: &str| drawn(scene, "full").matches("class=\"node storage multiplier\"").count();
    assert_eq!((marked("literal"), marked("rigid")), (0, 8), "four bodies, linear and angular");
}
