//! Units as hosts find them, where these are installed: packed, validated and simulated by FMPy (`pip install fmpy`),
//! in steps by libcosim (`pip install libcosimpy`). The variable `FMPY_PYTHON` names a Python that is not `python3`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::machines::{Ball, Pendulum, Shaker};
use bg_fmi::archive::archive;
use bg_fmi::{Described, Of, Packing, Version};
use bg_model::mechanism::Mechanism;
use bg_model::run::Simulation;

static PENDULUM: Of<Pendulum> = Of::NEW;
static BALL: Of<Ball> = Of::NEW;
static SHAKER: Of<Shaker> = Of::NEW;
const VERSIONS: [Version; 2] = [Version::Three, Version::Two];

fn python() -> String {
    std::env::var("FMPY_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

fn has(module: &str) -> bool {
    let import = format!("import {module}");
    let found = Command::new(python()).args(["-c", &import]).output().is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: {module} is not installed");
    }
    found
}

/// The library of the example, which Cargo builds beside the tests.
fn library() -> PathBuf {
    let tests = std::env::current_exe().unwrap();
    let folder = tests.parent().and_then(Path::parent).unwrap().join("examples");
    folder.join(format!("{}machines_fmu{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX))
}

/// The unit of a model, in a folder that goes away.
fn unit(model: &dyn Described, version: Version) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let identifier = model.description().name.to_lowercase();
    let path = folder.path().join(format!("{identifier}.fmu"));
    let packing = Packing { version, identifier, stop_time: 1.0 };
    std::fs::write(&path, archive(model, &packing, &std::fs::read(library()).unwrap(), &[]).unwrap()).unwrap();
    (folder, path)
}

/// What FMPy finds.
fn host(unit: &Path, arguments: &[&str]) -> Vec<String> {
    told_by("fmpy_check.py", unit, arguments)
}

/// What a host's script prints.
fn told_by(script: &str, unit: &Path, arguments: &[&str]) -> Vec<String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/units/hosts").join(script);
    let output: Output = Command::new(python()).arg(script).arg(unit).args(arguments).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    text.split_whitespace().map(str::to_owned).collect()
}

fn numbers(words: &[String]) -> Vec<f64> {
    words.iter().map(|word| word.parse().unwrap_or_else(|_| panic!("{words:?}"))).collect()
}

#[test]
fn units_are_valid() {
    if !has("fmpy") {
        return;
    }
    for model in [&PENDULUM as &dyn Described, &BALL, &SHAKER] {
        for version in VERSIONS {
            let (_folder, path) = unit(model, version);
            assert_eq!(host(&path, &["validate"]).join(" "), "no problems");
        }
    }
}

#[test]
fn a_host_comes_where_our_run_does() {
    if !has("fmpy") {
        return;
    }
    let pendulum = Pendulum::new(Default::default()).unwrap();
    let shaker = Shaker::make(Default::default(), &[]).unwrap();
    let ball = Ball::make(Default::default(), &[]).unwrap();
    let own = |run: Simulation<'_>| run.rtol(1e-11).at(&[1.0]).until(1.0).run().unwrap();
    let wanted = [
        (&PENDULUM as &dyn Described, "angle", own(Simulation::new(&pendulum))["angle"][0]),
        (&SHAKER, "x", Simulation::new(&shaker).rtol(1e-11).at(&[1.0]).until(1.0).run().unwrap()["x"][0]),
        (&BALL, "height", Simulation::new(&ball).rtol(1e-11).at(&[1.0]).until(1.0).run().unwrap()["height"][0]),
    ];
    let units = wanted.into_iter().flat_map(|unit| VERSIONS.map(|version| (unit, version)));
    for ((model, output, wanted), version) in units {
        let (_folder, path) = unit(model, version);
        for (kind, tolerance, allowed) in [("CoSimulation", "1e-9", 1e-8), ("ModelExchange", "1e-8", 1e-5)] {
            let found = numbers(&host(&path, &["simulate", kind, "1", "0.01", tolerance, output]));
            println!("{output} by {kind} of FMI {}: {:e} off", version.name(), found[1] - wanted);
            assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] - wanted).abs() < allowed, "{kind}: {found:?} {wanted}");
        }
    }
}

#[test]
fn a_host_gets_derivatives_and_saved_states() {
    if !has("fmpy") {
        return;
    }
    let models = [&PENDULUM as &dyn Described, &BALL, &SHAKER];
    for (model, version) in models.into_iter().flat_map(|model| VERSIONS.map(|version| (model, version))) {
        let (_folder, path) = unit(model, version);
        let jacobian = numbers(&host(&path, &["derivatives"]));
        assert!(jacobian[0] <= 1e-12 * jacobian[1] && jacobian[1] > 0.0, "{jacobian:?}");
        let states = host(&path, &["states"]);
        println!("from bytes: {} off", states[1]);
        assert!(states[0] == "True" && states[1].parse::<f64>().unwrap() < 1e-7, "{states:?}");
    }
}

#[test]
fn another_host_comes_there_too() {
    if !has("libcosimpy") {
        return;
    }
    let ball = Ball::make(Default::default(), &[]).unwrap();
    let wanted = Simulation::new(&ball).rtol(1e-11).at(&[1.0]).until(1.0).run().unwrap()["height"][0];
    let (_folder, path) = unit(&BALL, Version::Two);
    let found = numbers(&told_by("cosim_check.py", &path, &["1", "0.01", "height"]));
    println!("height by libcosim: {:e} off", found[1] - wanted);
    assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] - wanted).abs() < 1e-6, "{found:?} {wanted}");
}
