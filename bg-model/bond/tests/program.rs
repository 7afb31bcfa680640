//! The program as a user calls it: in a folder of its own, by its name, on files.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use tempfile::TempDir;

#[path = "program/campbell.rs"]
mod campbell;
#[path = "program/identify.rs"]
mod identify;
#[path = "program/json.rs"]
mod json;
#[path = "program/optimize.rs"]
mod optimize;
#[path = "program/plot.rs"]
mod plot;
#[path = "program/tables.rs"]
mod tables;
#[path = "program/told.rs"]
mod told_of;

/// What the program gives in a folder.
fn bond(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
    command.current_dir(folder).args(line.split_whitespace()).output().expect("the program starts")
}

/// What it prints, where it succeeds.
fn told(folder: &Path, line: &str) -> String {
    let output = bond(folder, line);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}: {}\n{errors}", output.status);
    String::from_utf8(output.stdout).expect("text")
}

/// What it says of what cannot be used.
fn refused(folder: &Path, line: &str, code: i32) -> String {
    let output = bond(folder, line);
    assert_eq!(output.status.code(), Some(code), "{line}");
    String::from_utf8(output.stderr).expect("text")
}

fn folder() -> TempDir {
    TempDir::new().expect("a folder")
}

fn write(folder: &TempDir, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).expect("a file");
}

/// A mass on a spring with a damper: x(t) is known.
const SWING: &str = "
/// A mass on a spring.
pub graph Swing {
    /// The mass.
    param mass: kg = 2, above 0;
    /// Its force.
    /// Its spring.
    param stiffness: N/m = 50;
    input push: N;
    1 slide: translation;
    I body = mass start 0; C spring = stiffness start 0.1; Se force = push;
    force -> slide; slide -> body; slide -> spring;
    observe { x: m = spring.q; v: m/s = slide.flow }
}";

#[test]
fn a_unit_has_the_text_and_the_files_that_it_uses() {
    let folder = folder();
    write(&folder, "weight.bond", "pub part Weight { port slide: translation; I body = 2; slide -> body; }");
    let text = SWING
        .replace("param mass: kg = 2, above 0;", "")
        .replace("/// The mass.", "")
        .replace("I body = mass start 0;", "part weight: Weight;")
        .replace("slide -> body;", "slide -> weight.slide;");
    write(&folder, "swing.bond", &format!("use \"weight.bond\";{text}"));
    // What makes a library one is told by a symbol of it.
    write(&folder, "library.so", "fmi3InstantiateModelExchange fmi2Instantiate");
    for version in ["3.0", "2.0"] {
        let line = format!("fmu swing.bond --library library.so --fmi {version} --out {version}.fmu");
        assert!(told(folder.path(), &line).contains("Swing for FMI"));
        let unit = std::fs::read(folder.path().join(format!("{version}.fmu"))).expect("a unit");
        let named = told(folder.path(), "fmu swing.bond --library library.so");
        assert!(named.starts_with("swing.fmu: "), "{named}");
        let has = |name: &[u8]| unit.windows(name.len()).any(|bytes| bytes == name);
        assert!(has(b"resources/model.json") && has(b"modelDescription.xml") && has(b"binaries/"));
    }
}

#[test]
fn machine_code_and_interpreter_write_the_same_bytes() {
    let folder = folder();
    told(folder.path(), "new swing");
    let [machine_code, interpreted] = [("a.csv", ""), ("b.csv", " --interpreted")].map(|(csv, option)| {
        told(folder.path(), &format!("run swing.bond --t-end 2 --no-figures --csv {csv}{option}"));
        std::fs::read(folder.path().join(csv)).expect("it is written")
    });
    assert!(machine_code.len() > 1000 && machine_code == interpreted);
    assert!(told(folder.path(), "--help").contains("--interpreted"));
}

#[test]
fn a_new_file_runs_and_has_a_report() {
    let folder = folder();
    assert!(told(folder.path(), "new swing").contains("swing.bond"));
    let summary = told(folder.path(), "run swing.bond --set angle=0.3 --t-end 0.5");
    assert!(summary.contains("angle") && folder.path().join("out").is_dir(), "{summary}");
    told(folder.path(), "report swing.bond --t-end 0.2");
    assert!(refused(folder.path(), "new swing", 2).contains("cannot write swing.bond"));
}

#[test]
fn a_run_is_what_theory_says() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    told(folder.path(), "run swing.bond --t-end 1 --step 0.5 --rtol 1e-10 --out out");
    let files: Vec<_> = std::fs::read_dir(folder.path().join("out")).expect("files").flatten().collect();
    let csv = files.iter().map(std::fs::DirEntry::path).find(|path| path.extension().is_some_and(|end| end == "csv"));
    let csv = std::fs::read_to_string(csv.expect("a CSV file")).expect("text");
    let last = csv.lines().last().expect("rows").split(',').map(|cell| cell.parse::<f64>().expect("a number"));
    let last: Vec<f64> = last.collect();
    // x = 0.1 cos(5 t), v = -0.5 sin(5 t).
    assert!((last[1] - 0.1 * 5.0_f64.cos()).abs() < 1e-9, "{csv}");
    assert!((last[2] + 0.5 * 5.0_f64.sin()).abs() < 1e-8, "{csv}");
}

#[test]
fn names_in_the_file_are_those_of_the_options() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    let help = told(folder.path(), "run swing.bond --help");
    assert!(help.contains("Usage: bond run swing.bond [OPTIONS]") && help.contains("mass"), "{help}");
    let fault = refused(folder.path(), "run swing.bond --set mas=1", 2);
    assert!(fault.contains("did you mean `mass`?"), "{fault}");
    let fault = refused(folder.path(), "run swing.bond --set mass=-1", 2);
    assert!(fault.contains("parameter `mass` = -1 kg is out of range"), "{fault}");
    assert!(told(folder.path(), "parameters swing.bond").contains("The mass."));
}

#[test]
fn a_linear_model_is_found_without_rustc() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    let modes = told(folder.path(), "linearize swing.bond");
    // 5 rad/s.
    assert!(modes.contains("0.79577") || modes.contains("0.7958"), "{modes}");
}

#[test]
fn faults_are_told_at_their_places() {
    let folder = folder();
    write(&folder, "good.bond", SWING);
    write(&folder, "bad.bond", &SWING.replace("slide -> spring;", "slide -> sprin;"));
    assert_eq!(told(folder.path(), "check good.bond"), "good.bond: Swing\n");
    let faults = refused(folder.path(), "check good.bond bad.bond", 1);
    assert!(faults.contains("bad.bond:12:45") && faults.contains("did you mean `spring`?"), "{faults}");
    assert!(refused(folder.path(), "run bad.bond", 2).contains("bad.bond:12:45"));
    let json = bond(folder.path(), "check bad.bond --json");
    let line: serde_json::Value = serde_json::from_slice(&json.stdout).expect("a line of JSON");
    assert_eq!((json.status.code(), line["line"].as_u64()), (Some(1), Some(12)));
}

/// A motor's torque on a shaft that stands in a file of its own.
const DRIVEN: &str = "
use \"parts/shaft.bond\";
graph Driven {
    part shaft: Shaft { inertia = 4; }
    Se drive = 2; 1 axle: rotation; drive -> axle -> shaft.end;
    observe { shaft.speed }
}";
const SHAFT: &str = "use \"wheel.bond\";
part Shaft {
    param inertia: kg*m^2 = 1;
    port end: rotation;
    part wheel: Wheel { inertia = inertia; }
    end -> wheel.rim;
    observe { speed: rad/s = wheel.disc.flow }
}
graph Alone { part shaft: Shaft; Se brake = -1; 1 axle: rotation; brake -> axle -> shaft.end; \
observe { shaft.speed } }";
const WHEEL: &str =
    "part Wheel {\n    param inertia: kg*m^2 = 1;\n    port rim: rotation; I disc = inertia; rim -> disc;\n}";

/// A folder with them.
fn driven() -> TempDir {
    let folder = folder();
    std::fs::create_dir(folder.path().join("parts")).expect("a folder");
    write(&folder, "driven.bond", DRIVEN);
    write(&folder, "parts/shaft.bond", SHAFT);
    write(&folder, "parts/wheel.bond", WHEEL);
    folder
}

#[test]
fn a_file_uses_parts_of_others() {
    let folder = driven();
    assert_eq!(
        told(folder.path(), "check driven.bond parts/shaft.bond parts/wheel.bond"),
        "driven.bond: Driven\nparts/shaft.bond: Alone\nparts/wheel.bond: only parts\n"
    );
    told(folder.path(), "run driven.bond --t-end 1 --step 1 --csv out.csv --no-figures");
    let csv = std::fs::read_to_string(folder.path().join("out.csv")).expect("a CSV file");
    let speed: f64 = csv.lines().last().and_then(|row| row.split(',').nth(1)?.parse().ok()).expect("a number");
    // dw/dt = 2 N*m / 4 kg*m^2.
    assert!((speed - 0.5).abs() < 1e-12, "{csv}");
}

#[test]
fn faults_of_a_used_file_are_told_at_their_places_in_it() {
    let folder = driven();
    write(&folder, "parts/wheel.bond", &WHEEL.replace("-> disc", "-> disk"));
    let place = if cfg!(windows) { "parts\\wheel.bond" } else { "parts/wheel.bond" };
    for (line, code) in [("check driven.bond", 1), ("run driven.bond", 2)] {
        let fault = refused(folder.path(), line, code);
        assert!(fault.contains("wheel.bond:3:50") && fault.contains("did you mean `shaft.wheel.disc`?"), "{fault}");
    }
    let json = bond(folder.path(), "check driven.bond --json");
    let line: serde_json::Value = serde_json::from_slice(&json.stdout).expect("a line of JSON");
    assert_eq!(
        (line["file"].as_str(), line["line"].as_u64(), line["column"].as_u64()),
        (Some(place), Some(3), Some(50))
    );
    // Files that use each other, and one that is not there.
    write(&folder, "parts/wheel.bond", &format!("{WHEEL}\nuse \"../driven.bond\";"));
    let fault = refused(folder.path(), "check driven.bond", 1);
    assert!(fault.contains("error[BG0902]") && fault.contains("wheel.bond:5:5"), "{fault}");
    write(&folder, "parts/shaft.bond", &SHAFT.replace("wheel.bond", "whel.bond"));
    let fault = refused(folder.path(), "check driven.bond", 1);
    assert!(fault.contains("shaft.bond:1:5") && fault.contains("cannot read parts"), "{fault}");
}

#[test]
fn texts_are_brought_into_one_form() {
    let folder = folder();
    let (wild, tame) = ("graph A { // why\nSe f=1 ; 1 j:translation;f->j ;}", "graph A { // why\n    Se f = 1;\n");
    write(&folder, "wild.bond", wild);
    write(&folder, "faulty.bond", "graph A { wheel w; }");
    let output = bond(folder.path(), "fmt --check wild.bond");
    assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(1), b"wild.bond has another form\n".as_slice()));
    assert_eq!(std::fs::read_to_string(folder.path().join("wild.bond")).expect("a file"), wild);
    // What can be formatted is, whatever else is asked for.
    let fault = refused(folder.path(), "fmt faulty.bond wild.bond missing.bond", 2);
    assert!(fault.contains("faulty.bond:1:11") && fault.contains("cannot read missing.bond"), "{fault}");
    assert_eq!(std::fs::read_to_string(folder.path().join("faulty.bond")).expect("a file"), "graph A { wheel w; }");
    assert!(std::fs::read_to_string(folder.path().join("wild.bond")).expect("a file").starts_with(tame));
    told(folder.path(), "fmt --check wild.bond");
    write(&folder, "wild.rs", "fn main() {}");
    assert!(refused(folder.path(), "fmt wild.rs", 2).contains("no text of the language"));
}

#[test]
fn a_text_goes_through_a_pipe() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
    let command = command.args(["fmt", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(b"graph A {1 j;}").expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "graph A {\n    1 j;\n}\n");
}

#[test]
fn of_several_graphs_one_is_named() {
    let folder = folder();
    write(&folder, "two.bond", &format!("{SWING}{}", SWING.replace("Swing", "Other")));
    let fault = refused(folder.path(), "run two.bond", 2);
    assert!(fault.contains("Say --graph NAME: there are `Swing`, `Other`"), "{fault}");
    told(folder.path(), "run two.bond --graph Other --t-end 0.1");
    assert!(refused(folder.path(), "run two.bond --graph Third", 2).contains("there is no graph `Third`"));
}

#[test]
fn what_is_no_text_is_one_clear_error() {
    let folder = folder();
    std::fs::write(folder.path().join("bytes.bond"), [0xff, 0xfe, 0, 1]).expect("a file");
    write(&folder, "open.bond", "graph A { ");
    write(&folder, "deep.bond", &"(".repeat(100_000));
    write(&folder, "empty.bond", "");
    write(&folder, "other.bond", "fn main() {}");
    for (line, said) in [
        ("run bytes.bond", "no text in UTF-8"),
        ("run missing.bond", "cannot read missing.bond"),
        (
            "identify measured.csv --fit length",
            "measured.csv: data, no mechanism; the file of the mechanism comes first",
        ),
        ("run open.bond", "close what is open"),
        ("run deep.bond", "brackets in brackets"),
        ("run empty.bond", "graph"),
        ("run other.bond", "graph"),
        ("run .", "cannot read ."),
    ] {
        let fault = refused(folder.path(), line, 2);
        assert!(fault.contains(said) && !fault.contains("panicked"), "{line}: {fault}");
    }
}

#[test]
fn what_would_not_end_is_one_clear_error() {
    let folder = folder();
    let many = "graph G { for i in 0..10000 { for j in 0..10000 { let a[i][j] = 1; } } }";
    write(&folder, "many.bond", many);
    let elements =
        "for i in 0..9999 { C a[i] = k; 0 b[i]: electrical; } for i in 1..9999 { b[i - 1] -> b[i] -> a[i]; }";
    write(
        &folder,
        "large.bond",
        &format!("graph G {{ param k: F = 1; {elements} {} }}", elements.replace("[i", "[9999 + i")),
    );
    for name in ["many", "large"] {
        let fault = refused(folder.path(), &format!("check {name}.bond"), 1);
        assert!(
            fault.contains("error[BG0815]: graph `G` has more than 20000 statements")
                && fault.contains("--limit-statements")
        );
    }
    write(&folder, "swing.bond", SWING);
    let fault = refused(folder.path(), "run swing.bond --limit-statements 5", 2);
    assert!(fault.contains("more than 5 statements"), "{fault}");
    told(folder.path(), "run swing.bond --limit-statements 50 --t-end 0.1");
    told(folder.path(), "check swing.bond --limit-statements 50");
    // Files in files.
    for k in 0..100 {
        write(&folder, &format!("{k}.bond"), &format!("use \"{}.bond\"; part P{k} {{ let a = 1; }}", k + 1));
    }
    assert!(refused(folder.path(), "check 0.bond", 1).contains("error[BG0903]"));
    // Numbers that are none.
    write(&folder, "values.toml", "mass = nan\n");
    for (line, said) in [
        ("--set mass=nan", "it must be a finite number"),
        ("--params values.toml", "it must be a finite number"),
        ("--input push=nan", "must be a finite number"),
        ("--t-end nan", "must be a finite number"),
        ("--t-end 1e300", "choose a longer one"),
    ] {
        let fault = refused(folder.path(), &format!("run swing.bond {line}"), 2);
        assert!(fault.contains(said), "{line}: {fault}");
    }
}

#[test]
fn a_robot_and_a_rust_file_are_run() {
    let folder = folder();
    write(
        &folder,
        "arm.urdf",
        r#"<robot name="arm"><link name="base"/><link name="upper"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
        <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>
        <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
        </robot>"#,
    );
    told(folder.path(), "run arm.urdf --t-end 0.2");
    assert!(refused(folder.path(), "report arm.urdf --live", 2).contains("the page that `bond serve` opens"));
    write(&folder, "swing.rs", &format!("bg_model::bond_graph! {{ {SWING} }} fn main() {{}}"));
    told(folder.path(), "run swing.rs --t-end 0.2");
}

#[test]
fn golden_outputs_are_recorded_and_checked() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    told(folder.path(), "golden record swing.bond --t-end 0.5");
    told(folder.path(), "golden check swing.bond");
    write(&folder, "swing.bond", &SWING.replace("= 50;", "= 51;"));
    refused(folder.path(), "golden check swing.bond", 1);
}

#[test]
fn derivatives_are_found_without_rustc() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    told(folder.path(), "sensitivity swing.bond --t-end 1 --step 0.5 --rtol 1e-10 --by mass --output x");
    let csv = std::fs::read_to_string(folder.path().join("out/sensitivity/sensitivity_over_time.csv"));
    let csv = csv.expect("the courses");
    let last: Vec<f64> =
        csv.lines().last().expect("rows").split(',').map(|cell| cell.parse().expect("a number")).collect();
    // x = 0.1 cos(w t), w = (k / m)^(1/2), dw/dm = -w / (2 m).
    let expected = 0.1 * 5.0_f64.sin() * 5.0 / 4.0;
    assert!((last[1] - expected).abs() < 1e-8, "{csv}");
}

/// A command of `bond` that serves a page of a folder; it is ended where this is dropped.
struct Watch {
    child: Child,
    /// `127.0.0.1:PORT`
    address: String,
    number: u64,
}

impl Watch {
    /// `bond watch` on a file.
    fn of(folder: &Path, line: &str) -> Self {
        Self::serving(folder, &format!("watch {line} --no-open --t-end 0.1"))
    }

    fn serving(folder: &Path, line: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bond"));
        command.current_dir(folder).args(line.split_whitespace());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the program starts");
        let mut told = String::new();
        BufReader::new(child.stdout.take().expect("a pipe")).read_line(&mut told).expect("a line");
        let address = told.strip_prefix("http://").and_then(|rest| rest.split('/').next()).expect("an address");
        Self { address: address.to_owned(), child, number: u64::MAX }
    }

    /// What stands at an address.
    fn get(&self, path: &str) -> String {
        self.answer(path).split_once("\r\n\r\n").expect("a head and a body").1.to_owned()
    }

    /// The same with its head.
    fn answer(&self, path: &str) -> String {
        let mut stream = TcpStream::connect(&self.address).expect("a server");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a time");
        write!(stream, "GET {path} HTTP/1.0\r\n\r\n").expect("it reads");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("an answer");
        answer
    }

    /// The next state in which nothing is being made.
    fn next(&mut self) -> serde_json::Value {
        loop {
            let state = self.get(&format!("/state?after={}", self.number));
            let state: serde_json::Value = serde_json::from_str(&state).expect("JSON");
            let number = state["number"].as_u64().expect("a number");
            let is_other = std::mem::replace(&mut self.number, number) != number;
            if is_other && number > 0 && state["is_making"] == false {
                return state;
            }
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.child.kill().and_then(|()| self.child.wait()).expect("it ran");
    }
}

#[test]
fn a_report_is_replaced_when_a_file_is_saved() {
    let folder = driven();
    let mut watch = Watch::of(folder.path(), "driven.bond");
    let first = watch.next();
    assert_eq!((first["report"].as_u64(), first["fault"].as_str()), (Some(1), None), "{first}");
    let page = watch.get("/report");
    assert!(page.contains("shaft.speed") && watch.get("/").contains("iframe"));
    // Its script is a file of the server, so that the next report takes its place without it.
    assert!(page.contains("<script src=\"report.js\">") && !page.contains("data-plays"), "{page}");
    assert!(["report.css", "beside.js", "report.js"].iter().all(|name| !watch.get(&format!("/{name}")).is_empty()));
    // A fault in a used file, which an editor replaces: the last report stays.
    write(&folder, "new.bond", &WHEEL.replace("-> disc", "-> disk"));
    std::fs::rename(folder.path().join("new.bond"), folder.path().join("parts/wheel.bond")).expect("a rename");
    let faulty = watch.next();
    let fault = faulty["fault"].as_str().expect("a fault");
    assert!(faulty["report"] == 1 && fault.contains("wheel.bond:3:50") && fault.contains("help: "), "{faulty}");
    assert!(watch.get("/report").contains("shaft.speed"));
    // Fixed, and another name of the output.
    write(&folder, "parts/wheel.bond", WHEEL);
    assert_eq!(watch.next()["report"], 2);
    write(&folder, "driven.bond", &DRIVEN.replace("observe { shaft.speed }", "observe { turns: rad/s = shaft.speed }"));
    assert_eq!(watch.next()["report"], 3);
    assert!(watch.get("/report").contains("turns"));
    // A run that is refused is told like a fault.
    drop(watch);
    let mut watch = Watch::of(folder.path(), "driven.bond --set nothing=1");
    let refused = watch.next();
    assert!(refused["fault"].as_str().is_some_and(|fault| fault.contains("nothing")), "{refused}");
}

#[test]
fn what_cannot_be_watched_is_said_at_once() {
    let folder = folder();
    assert!(refused(folder.path(), "watch missing.bond --no-open", 2).contains("cannot read missing.bond"));
    write(&folder, "swing.bond", SWING);
    let watch = Watch::of(folder.path(), "swing.bond");
    let port = watch.address.rsplit(':').next().expect("a port");
    assert!(refused(folder.path(), &format!("watch --port {port} swing.bond --no-open"), 2).contains("--port"));
}

#[test]
fn the_page_that_compiles_is_served_from_its_folder_and_from_nowhere_else() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("site")).expect("a folder");
    for (name, text) in
        [("site/index.html", "<h1>"), ("site/bond.wasm", "module"), ("site/.run", "kept"), ("secret", "s")]
    {
        write(&folder, name, text);
    }
    let page = Watch::serving(folder.path(), "serve --page site --no-open");
    for (path, kind, text) in [
        ("/", "text/html; charset=utf-8", "<h1>"),
        ("/?test", "text/html; charset=utf-8", "<h1>"),
        ("/bond.wasm", "application/wasm", "module"),
    ] {
        let answer = page.answer(path);
        assert!(answer.contains(" 200 ") && answer.contains(&format!("Content-Type: {kind}\r\n")), "{path}: {answer}");
        assert!(answer.ends_with(&format!("\r\n\r\n{text}")), "{path}: {answer}");
    }
    for path in ["/secret", "/../secret", "/%2e%2e/secret", "/.run", "/site/index.html", "//secret"] {
        assert!(page.answer(path).contains(" 404 "), "{path}");
    }
}

#[test]
fn what_cannot_be_served_says_how_the_page_is_built() {
    let folder = folder();
    let told = refused(folder.path(), "serve --page nowhere --no-open", 2);
    assert!(
        told.contains("no page in nowhere") && told.contains("cargo run --release -p bond-page -- FOLDER"),
        "{told}"
    );
    assert!(refused(folder.path(), "serve --no-open", 2).contains("bond-site"));
}

/// The texts of the tasks for designers, each with the lines after it.
const TASKS: &str = include_str!("../../../docs/tasks.md");

/// The first text of the tasks with a line that begins with these words, and what that line goes on with.
fn task(begins: &str) -> (&'static str, &'static str) {
    let texts = TASKS.split("```bond\n").skip(1).filter_map(|rest| rest.split("```").next());
    let said = |text: &'static str| text.lines().find_map(|line| Some((text, line.strip_prefix(begins)?)));
    texts.filter_map(said).next().unwrap_or_else(|| panic!("a text says {begins}"))
}

/// The numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    let words = line.split(' ').map(|word| word.trim_end_matches(['.', ',']));
    words.filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_task_has_the_modes_that_it_says() {
    for (begins, options) in [("// Modes: ", ""), ("// Modes at 0 s: ", " --at 0")] {
        let folder = folder();
        let (text, said) = task(begins);
        write(&folder, "task.bond", text);
        told(folder.path(), &format!("linearize task.bond{options}"));
        let modes = std::fs::read_to_string(folder.path().join("out/linear/modes.txt")).expect("modes");
        // Number, real part, imaginary part, frequency.
        let rows = modes.lines().map(numbers).filter(|row| row.len() > 3 && row[0] > 0.0 && row[3] > 0.0);
        let found: Vec<f64> = rows.map(|row| row[3]).collect();
        for expected in numbers(said) {
            let is_near = |found: &f64| (found - expected).abs() <= 5e-4 * expected;
            assert!(found.iter().any(is_near), "{expected} Hz is none of {found:?}");
        }
    }
}

#[test]
fn a_task_is_fitted_to_its_measurement() {
    let folder = folder();
    let (text, said) = task("// Fitted: ");
    let measured = TASKS.split("```csv\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a table");
    write(&folder, "rundown.bond", text);
    write(&folder, "measured.csv", measured);
    let found = told(folder.path(), "identify rundown.bond measured.csv --fit air,bearing");
    let row = |name: &str| found.lines().find(|line| line.trim().starts_with(name)).map(numbers).expect("a row");
    let expected = numbers(said);
    for (name, expected) in ["air ", "bearing "].iter().zip(expected) {
        assert!((row(name)[0] - expected).abs() <= 5e-4 * expected, "{found}");
    }
}

#[test]
fn the_library_is_listed_and_its_parts_are_printed() {
    let folder = folder();
    let list = told(folder.path(), "parts");
    assert!(list.contains("use gears;\n") && list.contains("  GearPair ") && !list.contains("StickingLoss"), "{list}");
    let one = told(folder.path(), "parts GearPair");
    assert!(one.starts_with("use gears;\n\n/// A rigid pair of gears") && one.ends_with("}\n"), "{one}");
    let wrong = refused(folder.path(), "parts GearPar", 2);
    assert!(wrong.contains("the library has no part `GearPar`; did you mean `GearPair`?"), "{wrong}");
    // A file that uses it, here and from another folder.
    let geared = "use gears; graph G { part p: GearPair; Se m = 1; 1 a: rotation; 1 b: rotation; I i = 1; \
        m -> a -> p.first; p.second -> b -> i; }";
    write(&folder, "geared.bond", geared);
    assert!(told(folder.path(), "check geared.bond").contains("geared.bond"));
    write(&folder, "wrong.bond", &geared.replace("use gears", "use gear"));
    let fault = refused(folder.path(), "check wrong.bond", 1);
    assert!(fault.contains("error[BG0908]") && fault.contains("wrong.bond:1:5"), "{fault}");
}
