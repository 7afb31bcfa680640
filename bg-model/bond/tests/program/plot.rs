//! `plot`: what is drawn, and what cannot be.

use std::path::Path;
use std::process::{Command, Output};

use super::{folder, write};

const SWING: &str = "
/// A mass on a spring and a damper, let go.
graph Swing {
    param mass: kg = 2, above 0; param stiffness: N/m = 50, above 0; param damping: N*s/m = 0.5, at least 0;
    1 slide: translation; I body = mass; C spring = stiffness start 0.1; R damper = damping;
    slide -> body; slide -> spring; slide -> damper;
    observe { x: m = spring.q; v: m/s = slide.flow; force: N = spring.effort }
}";

fn plot(folder: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
    command.current_dir(folder).args(["plot", "swing.bond"]).args(options).output().expect("the program starts")
}

#[test]
fn outputs_are_drawn_over_time_against_each_other_and_as_spectra() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    write(&folder, "measured.csv", "t,x,v\n0,0.1,0\n1,0.05,0.1\n2,-0.02,0\n3,0.01,0\n4,0,0\n");
    let drawn = |options: &[&str]| {
        let output = plot(folder.path(), options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(folder.path().join("out/plot.svg")).expect("a drawing")
    };
    let phase = drawn(&["--show", "v", "--over", "x"]);
    assert!(phase.contains("x in m") && phase.contains("v in m/s"), "{phase}");
    let both = drawn(&["--show", "x", "--show", "force / stiffness", "--from", "1"]);
    assert!(both.contains("x, force / stiffness in m"), "{both}");
    let beside = drawn(&["--show", "x", "--with", "measured.csv"]);
    assert!(beside.contains("measured") && beside.matches("<polyline").count() >= 2, "{beside}");
    let spectrum = drawn(&["--show", "x", "--spectrum", "--t-end", "20", "--up-to", "3", "--log"]);
    assert!(spectrum.contains("frequency in Hz") && spectrum.contains("amplitude of x in m"), "{spectrum}");
    let orders = drawn(&["--show", "v", "--order", "10 * t / 1 s + 0 * x / 1 m"]);
    assert!(orders.contains("order of 10 * t"), "{orders}");
}

#[test]
fn what_cannot_be_drawn_is_told() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    write(&folder, "measured.csv", "t,x\n0,0.1\n1,0.05\n");
    let told = |options: &[&str]| {
        let output = plot(folder.path(), options);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let text = told(&["--show", "max x"]);
    assert!(text.contains("--show: max x: `max x` is one number of a whole run"), "{text}");
    let text = told(&["--show", "y"]);
    assert!(text.contains("there is no output, parameter or measure `y`"), "{text}");
    let text = told(&["--show", "v", "--with", "measured.csv"]);
    assert!(text.contains("--with: measured.csv has no column `v`"), "{text}");
    let text = told(&["--show", "v", "--from", "9"]);
    assert!(text.contains("--from 9: must be a time in the run, 0 to 5 s"), "{text}");
}
