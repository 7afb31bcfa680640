//! What is said and where from: colours, JSON in place of texts, pictures and measurements on a page, the origin of a
//! run.

use std::process::Command;

use serde_json::Value;

use super::{SWING, bond, folder, refused, told, write};

#[test]
fn faults_and_help_are_coloured_where_that_is_asked_for() {
    let folder = folder();
    write(&folder, "bad.bond", "graph Bad { param mass: kgg = 2; }");
    let faults = |line: &str| String::from_utf8(bond(folder.path(), line).stderr).expect("text");
    let is_coloured = |text: &str| text.contains("\u{1b}[");
    // Neither is a terminal.
    assert!(!is_coloured(&faults("check bad.bond")));
    for line in ["check bad.bond --color always", "--color always check bad.bond", "run bad.bond --color=always"] {
        assert!(is_coloured(&faults(line)), "{line}");
    }
    assert!(!is_coloured(&faults("run bad.bond --color always --color never")), "the last one counts");
    assert!(is_coloured(&told(folder.path(), "--help --color always")) && !is_coloured(&told(folder.path(), "--help")));
    let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
    let output = command.current_dir(folder.path()).args(["check", "bad.bond"]).env("NO_COLOR", "1").output();
    assert!(!is_coloured(&String::from_utf8_lossy(&output.expect("the program starts").stderr)));
    assert!(faults("check bad.bond --color blue").contains("invalid value 'blue' for '--color <WHEN>'"));
}

#[test]
fn shells_and_manuals_know_every_command() {
    let folder = folder();
    for shell in ["bash", "zsh", "fish"] {
        let script = told(folder.path(), &format!("completions {shell}"));
        assert!(["campbell", "compare", "golden"].iter().all(|command| script.contains(command)), "{shell}");
    }
    told(folder.path(), "man --out manual");
    let page = |name: &str| std::fs::read_to_string(folder.path().join("manual").join(name)).expect(name);
    assert!(page("bond-campbell.1").contains("\\-\\-orders") && page("bond-compare.1").contains("FILE"));
    assert!(page("bond-golden-check.1").contains("FILE") && told(folder.path(), "man").contains("campbell"));
}

#[test]
fn what_is_text_is_json_where_that_is_asked_for() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    let json = |line: &str| -> Value { serde_json::from_str(&told(folder.path(), line)).expect(line) };
    assert_eq!(json("parameters swing.bond --json")["mass"]["unit"], "kg");
    let scenes = json("scene swing.bond --json");
    assert_eq!((&scenes[0]["states"], &scenes[0]["outputs"][1]["unit"]), (&2.into(), &"m/s".into()));
    // The root of 50 / 2 rad/s.
    let near = |value: &Value, expected: f64| {
        let value = value.as_f64().expect("a number");
        assert!((value - expected).abs() < 1e-6 * expected.abs(), "{value} {expected}");
    };
    near(&json("linearize swing.bond --json")["modes"][0]["imaginary"], 5.0);
    near(
        &json("campbell swing.bond --by stiffness=50..200 --points 3 --json -q")["modes"][2]["imaginary [rad/s]"],
        10.0,
    );
    let influences = json("sensitivity swing.bond --t-end 1 --by mass --output x --json");
    let last = influences.as_array().expect("rows").iter().find(|row| row["measure"] == "final").expect("a row");
    near(&last["value"], 0.1 * 5.0_f64.cos());
    near(&json("sensitivity swing.bond --of x --t-end 1 --json")[0]["value"], 0.1 * 5.0_f64.cos());
    told(folder.path(), "run swing.bond --t-end 1 --csv m.csv --no-figures");
    let fit = json("identify swing.bond m.csv --fit stiffness --set stiffness=55 --json");
    near(&fit["parameters"][0]["value"], 50.0);
    assert_eq!((&fit["converged"], &fit["columns"][0]["is_noise"]), (&true.into(), &true.into()));
    let best = json("optimize swing.bond --minimize final(x) --by stiffness=40..60 --t-end 0.5 --json");
    assert!(best["best"]["converged"] == true, "{best}");
    assert_eq!(json("compare swing.bond m.csv m.csv --json")[0]["largest_difference"], 0.0);
    write(&folder, "plan.toml", "t_end = 0.1\n[grid]\nmass = [1, 2, 3]\n");
    assert_eq!(json("sweep swing.bond --plan plan.toml --out s --json")["made"], 3);
    told(folder.path(), "golden record swing.bond --t-end 1");
    assert_eq!(json("golden check swing.bond --json")[0]["is_as_recorded"], true);
    assert_eq!(json("run swing.bond --t-end 1 --json -q")["steps"].as_u64().map(|steps| steps > 0), Some(true));
}

#[test]
fn a_page_has_a_measurement_and_pictures_beside_the_run() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    write(&folder, "measured.csv", "t [ms],x [mm],weather\n0,100,1\n200,50,2\n");
    write(&folder, "other.csv", "t,weather\n0,1\n1,2\n");
    let pictures = ["--plot", "v over x", "--plot", "spectrum of x, 0.1..", "--plot", "orders of v over 20 * t / 1 s"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
    let options = [&["report", "swing.bond", "--t-end", "1", "--with", "measured.csv"][..], &pictures].concat();
    let output = command.current_dir(folder.path()).args(options).output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(folder.path().join("out/swing.html")).expect("a page");
    assert_eq!(page.matches("<img data-drawing=").count(), 3);
    assert!(page.contains("alt=\"spectrum of x, 0.1..\""), "every picture has its name");
    let others =
        "\"others\":[{\"name\":\"measured\",\"times\":[0.0,0.2],\"columns\":[{\"name\":\"x\",\"values\":[0.1,0.05]}]}]";
    assert!(page.contains(others) && page.contains("id=\"against\""), "in the units of the model");
    for (options, fault) in [
        (["--plot", "v over y"], "--plot: v over y: there is no output, parameter or measure `y`"),
        (["--plot", "orders of v"], "give its angle, as in `orders of x over crank.angle`"),
        (["--plot", "v, soon.."], "`soon` is no time in s"),
        (["--with", "other.csv"], "--with: other.csv has no column with the name of an output"),
        (["--with", "none.csv"], "cannot read none.csv"),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
        let output = command.current_dir(folder.path()).args(["run", "swing.bond"]).args(options).output();
        let output = output.expect("the program starts");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(fault), "{text}");
    }
}

#[test]
fn a_run_says_which_text_it_is_of_and_from_which_commit() {
    let folder = folder();
    let commit = "0123456789abcdef0123456789abcdef01234567";
    std::fs::create_dir(folder.path().join(".git")).expect("a folder");
    write(&folder, ".git/HEAD", &format!("{commit}\n"));
    write(&folder, "swing.bond", SWING);
    let text = told(folder.path(), "run swing.bond --t-end 1 --no-figures");
    assert!(text.contains("model          ") && text.contains(&format!(", commit {commit}\n")), "{text}");
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let recipe = &summary["recipe"];
    assert_eq!((&recipe["model_file"]["name"], &recipe["commit"]), (&"swing.bond".into(), &commit.into()));
    assert_eq!(recipe["parameters"]["stiffness"], serde_json::json!({ "value": 50.0, "unit": "N/m" }));
    told(folder.path(), "golden record swing.bond --t-end 1");
    let golden = std::fs::read_to_string(folder.path().join("golden/literal.toml")).expect("a record");
    assert!(golden.contains(&format!("commit = \"{commit}\"\n")), "{golden}");
    assert!(golden.contains("\"stiffness\" = { value = 50.0, unit = \"N/m\" }\n"), "{golden}");
    // Other words for the same model are the same run; another model is not.
    write(&folder, "swing.bond", &format!("// The same.\n{SWING}"));
    told(folder.path(), "run swing.bond --again out/summary.json --out again --no-figures");
    write(&folder, "swing.bond", &SWING.replace("C spring = stiffness", "C spring = 2 * stiffness"));
    let fault = refused(folder.path(), "run swing.bond --again out/summary.json --out again --no-figures", 2);
    assert!(fault.contains("the model has other equations or outputs than then"), "{fault}");
}

#[test]
fn a_report_has_the_name_of_its_file_and_in_its_title_the_scene() {
    let folder = folder();
    let (graph, scene) = (SWING.trim_end().trim_end_matches('}'), "scene Idle { observe { v: m/s = slide.flow } }");
    write(&folder, "swing.bond", &format!("{graph} {scene} }}"));
    let of = |line: &str| {
        told(folder.path(), line);
        std::fs::read_to_string(folder.path().join("out/swing.html")).expect("a page")
    };
    let (whole, idle) = (of("report swing.bond --t-end 0.1"), of("report swing.bond --scene idle --t-end 0.1"));
    let graph = SWING.split("graph ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a name");
    assert!(whole.contains(&format!("<h1>{graph}</h1>")) && whole.contains(&format!("<title>{graph}</title>")));
    assert!(idle.contains(&format!("<h1>{graph}: Idle</h1>")));
}
