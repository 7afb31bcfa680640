//! How a model and its build grow with the number of links: prints a table.
//!
//! `cargo bench -p bond-graph-tests --bench growth [-- --largest N] [WORD]`, for chains of 2, 4, 8 .. N links (16
//! unless said), of all kinds or those whose name contains the word. Each chain becomes a program of one file, in a
//! package of its own under the target folder, with the profiles of this repository; its dependencies are built before.
//! CPU time and memory are those of cargo with all its processes. Times of a rate and so on are minima of many batches
//! at the start state, in that program.
#![allow(missing_docs)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use bg_workbench::tables::table;
use wait4::{ResUse, Wait4 as _};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
const FOLDER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/growth");
const HEAD: [&str; 13] = [
    "chain",
    "links",
    "states",
    "operations of the rate",
    "of the Jacobian",
    "numbers of the factors",
    "rate, ns",
    "Jacobian, ns",
    "elimination and substitution, ns",
    "check, s",
    "MB",
    "release build, s",
    "MB",
];

/// A kind of chain.
struct Kind {
    name: &'static str,
    /// Of the scene that is measured; none where the graph itself is.
    scene: Option<&'static str>,
    /// The axes about which its hinges turn, by turns.
    axes: &'static [char],
}

/// Of every joint; a scene may make it rigid.
const JOINT: &str = "stiffness 1e5; damping 10; tilt stiffness 1e3; tilt damping 1;";
const KINDS: [Kind; 3] = [
    Kind { name: "compliant, in the plane", scene: Some("expect planar;"), axes: &['z'] },
    Kind { name: "compliant, in space", scene: None, axes: &['y', 'z'] },
    Kind { name: "rigid, in the plane", scene: Some("rigid joints; expect planar;"), axes: &['z'] },
];

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let (largest, words) = arguments();
    let chains: Vec<(&Kind, usize)> = KINDS
        .iter()
        .filter(|kind| words.iter().all(|word| kind.name.contains(word.as_str())))
        .flat_map(|kind| {
            (1..).map(|power| 1 << power).take_while(|links| *links <= largest).map(move |links| (kind, links))
        })
        .collect();
    prepare(&chains);
    let mut rows = vec![HEAD.map(str::to_owned)];
    for (number, (kind, links)) in chains.iter().enumerate() {
        eprintln!("{} of {}: {}, {links} links", number + 1, chains.len(), kind.name);
        rows.push(measured(kind, *links));
    }
    print!("{}", table(&rows));
}

/// The most links, and the words that a kind's name has to contain.
fn arguments() -> (usize, Vec<String>) {
    let mut arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let (mut largest, mut words) = (16, Vec::new());
    while let Some(argument) = arguments.next() {
        if argument == "--largest" {
            largest =
                arguments.next().and_then(|number| number.parse().ok()).expect("--largest takes a number of links");
        } else {
            words.push(argument);
        }
    }
    (largest, words)
}

/// Writes the package with a program for each chain, and builds its dependencies.
fn prepare(chains: &[(&Kind, usize)]) {
    let workspace = fs::read_to_string(Path::new(ROOT).join("Cargo.toml")).expect("the workspace's manifest");
    let profiles = workspace.find("[profile.release]").map_or("", |at| &workspace[at..]);
    let manifest = format!(
        "[package]\nname = \"growth\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\nbg-model = {{ path = \
        '{ROOT}/bg-model' }}\n\n{profiles}"
    );
    write("Cargo.toml", &manifest);
    write("src/bin/none.rs", "use bg_model as _;\nfn main() {}\n");
    for (kind, links) in chains {
        write(&format!("src/bin/{}.rs", file(kind, *links)), &program(kind, *links));
    }
    for arguments in [["check", "--quiet"].as_slice(), &["build", "--quiet", "--release"]] {
        run(arguments, "none");
    }
}

/// A row of the table.
fn measured(kind: &Kind, links: usize) -> [String; 13] {
    let name = file(kind, links);
    let check = run(&["check", "--quiet"], &name);
    let build = run(&["build", "--quiet", "--release"], &name);
    let program = PathBuf::from(FOLDER).join("target/release").join(&name);
    let output = Command::new(program).output().expect("the program that was built").stdout;
    let output = String::from_utf8(output).expect("numbers");
    let mut row = vec![kind.name.to_owned(), links.to_string()];
    row.extend(output.split_whitespace().map(str::to_owned));
    row.extend([used(&check), used(&build)].into_iter().flatten());
    row.try_into().expect("a cell for each column")
}

/// CPU time, s, and the largest memory of a process, MB.
fn used(used: &ResUse) -> [String; 2] {
    let time = (used.rusage.utime + used.rusage.stime).as_secs_f64();
    [format!("{time:.1}"), (used.rusage.maxrss / 1_000_000).to_string()]
}

/// Runs cargo for the program called `name`.
fn run(arguments: &[&str], name: &str) -> ResUse {
    let used = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--bin", name])
        .current_dir(FOLDER)
        .env("CARGO_TARGET_DIR", Path::new(FOLDER).join("target"))
        .stdin(Stdio::null())
        .spawn()
        .expect("cargo, which runs this")
        .wait4()
        .expect("its child");
    assert!(used.status.success(), "cargo {} --bin {name}", arguments.join(" "));
    used
}

/// Writes a file of the package, with a time that makes cargo build it.
fn write(path: &str, text: &str) {
    let path = Path::new(FOLDER).join(path);
    fs::create_dir_all(path.parent().expect("a folder")).expect("a folder under the target folder");
    fs::write(path, text).expect("a file under the target folder");
}

fn file(kind: &Kind, links: usize) -> String {
    let name: String = kind.name.chars().filter(|letter| *letter != ',').collect();
    format!("{}_{links}", name.replace(' ', "_"))
}

/// A program with a chain of links of 1 m and 1 kg, level at the start, held by the ground at one end.
fn program(kind: &Kind, links: usize) -> String {
    let mut parts = String::new();
    for link in 0..links {
        let held = if link == 0 { "ground.O".to_owned() } else { format!("link{}.right", link - 1) };
        let axis = kind.axes[link % kind.axes.len()];
        writeln!(
            parts,
            "        body link{link} {{ mass 1; inertia [1e-3, 1 / 12, 1 / 12]; point left = [-0.5, 0, 0]; \
             point right = [0.5, 0, 0]; start left at [{link}, 0, 0]; }}\n        \
             joint pin{link}: revolute {axis} ({held} -> link{link}.left) {{ {JOINT} }}"
        )
        .expect("a string");
    }
    let observe = format!("observe {{ end: m = link{}.position; }}", links - 1);
    let (graph, before, after) = match kind.scene {
        Some(scene) => ("Chain", "scenes only;", format!("{observe} scene Measured {{ {observe} tune {{}} {scene} }}")),
        None => ("Measured", "", observe),
    };
    format!(
        "bg_model::bond_graph! {{\n    graph {graph} {{\n        {before}\n        gravity [0, -9.81, 0];\n        \
         ground {{ point O = [0, 0, 0]; }}\n{parts}        {after}\n    }}\n}}\n{MEASURE}"
    )
}

/// The rest of each program: it prints states, counts and nanoseconds, in the order of the columns.
const MEASURE: &str = r#"
use std::hint::black_box;

use bg_model::capability::{Elimination, Linearised};
use bg_model::nalgebra::SVector;
use bg_model::system::Model;

fn nanoseconds(mut call: impl FnMut()) -> f64 {
    let mut batch = |calls: u32| {
        let start = std::time::Instant::now();
        (0..calls).for_each(|_| call());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(calls)
    };
    let calls = (1e6 / batch(3)).clamp(1.0, 1e5) as u32;
    (0..20).map(|_| batch(calls)).fold(f64::INFINITY, f64::min)
}

fn measure<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo)
where
    Mo: Model<f64, N, G, M>,
{
    let x = model.start().expect("the chain closes");
    let (negative, mut dx) = ([false; G], SVector::zeros());
    let rate = nanoseconds(|| model.rate(0.0, black_box(&x), &negative, black_box(&mut dx)));
    let linearised = model.linearised().expect("a model has a Jacobian");
    let mut entries = vec![0.0; linearised.sparsity().len(N)];
    let mut slope = SVector::zeros();
    let jacobian = nanoseconds(|| linearised.jacobian(0.0, black_box(&x), &negative, &mut entries, &mut slope));
    let elimination = linearised.elimination().expect("a model has an elimination");
    let mut factors = vec![0.0; elimination.factors()];
    let solve = nanoseconds(|| {
        let mut y = black_box([1.0; N]);
        assert!(elimination.eliminate(black_box(1e-4), black_box(&entries), &mut factors));
        elimination.substitute(&factors, &mut y);
        black_box(&y);
    });
    let count = |name: &str| {
        let counts = model.description().operations;
        counts.iter().find(|(function, _)| *function == name).map_or(0, |(_, count)| count.total())
    };
    println!("{N} {} {} {} {rate:.0} {jacobian:.0} {solve:.0}", count("rate"), count("jacobian"), factors.len());
}

fn main() {
    measure(&Measured::new(MeasuredParameters {}).expect("no parameters"));
}
"#;
