//! Sweeps whose runs are made side by side: their files are those of runs made one by one.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use bg_model::bond_graph;
use bg_workbench::Program;
use bg_workbench::sweep::folder::Folder;
use bg_workbench::sweep::plan::Plan;
use bg_workbench::sweep::{Outcome, Share, recipe, sweep};

bond_graph! {
    /// A block on a spring, whose contact resists its two directions differently. It knows no speed above a limit.
    pub graph Block {
        param mass: kg = 1, above 0; param stiffness: N/m = 40, at least 0; param cut: N*s/m = 0.3;
        param limit: m/s = 9; param unit: m/s = 1;
        param start: m = 0.5;
        1 slide: translation; I block = mass; C spring = stiffness start start;
        R saw(v) = if v < 0 { cut * v * sqrt((limit + v) / unit) } else { 0.5 * cut * v };
        slide -> block; slide -> spring; slide -> saw;
        observe { x: m = spring.q; v: m/s = slide.flow; lost: J = integral(dissipated_power) }
        /// The place only.
        scene Place { observe { x: m = spring.q } tune { mass, limit } }
    }
}

const PLAN: &str = r#"
t_end = 2.0
step = 0.01
method = "nystrom"
rtol = 1e-5
shard = 37
event_times = 3
trajectories = ["x"]
[latin_hypercube]
count = 120
seed = 5
[latin_hypercube.ranges]
mass = { from = 0.5, to = 2.0 }
limit = { from = 2.0, to = 9.0 }
[columns]
x = ["max", "final", "integral"]
"#;

fn in_lanes() -> Program {
    Program::of::<Block>()
}

/// Makes the sweep of `plan` on so many threads; gives its files with their bytes.
fn made(program: &Program, plan: &str, threads: usize) -> (Outcome, BTreeMap<String, Vec<u8>>) {
    let folder = tempfile::tempdir().unwrap();
    let plan = Plan::parse(program, "plan.toml", Path::new(""), plan.to_owned()).unwrap();
    let claimed = Folder::claim(folder.path(), &recipe::of(program, &plan)).unwrap();
    let outcome = sweep(program, &plan, &claimed, Share::ALL, threads, &|_, _| true).unwrap();
    let entries = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
    let named =
        |path: std::path::PathBuf| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap());
    (outcome, entries.map(named).collect())
}

#[test]
fn files_are_those_of_runs_made_one_by_one() {
    for plan in [PLAN.to_owned(), format!("scene = \"place\"\n{PLAN}")] {
        let (alone, expected) = made(&Program::of::<Block>(), &plan, 1);
        assert!(expected.len() == 9 && alone.runs == 120 && alone.failed > 5 && alone.failed < 100, "{alone:?}");
        for threads in [1, 2] {
            let (together, files) = made(&in_lanes(), &plan, threads);
            assert_eq!(together, alone);
            assert!(files == expected, "{threads}");
        }
    }
}

#[test]
fn runs_without_a_model_have_their_reasons() {
    let plan = PLAN.replace("mass = { from = 0.5", "unit = { from = -1.0");
    let ((alone, expected), (together, files)) = (made(&Program::of::<Block>(), &plan, 1), made(&in_lanes(), &plan, 1));
    assert!(together == alone && alone.failed > 20, "{alone:?}");
    assert!(files == expected);
}
