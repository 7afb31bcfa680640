//! The program as it is called: what it writes, what it says, its exit code.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own, with these files.
pub(super) fn folder(name: &str, files: &[(&str, &[u8])]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("import").join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("an old folder can go");
    }
    for (file, bytes) in files {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().expect("it is in a folder")).expect("a folder");
        std::fs::write(path, bytes).expect("a file can be written");
    }
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bg-import"));
    command.current_dir(folder).args(arguments).output().expect("bg-import runs")
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

const PENDULUM: &str = "<mujoco><option magic='3'/><worldbody><body name='rod'><joint name='pin'/>\
                        <inertial pos='1 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";

#[test]
fn strict_writes_nothing_where_there_is_a_note() {
    let folder = folder("strict", &[("a.xml", PENDULUM.as_bytes())]);
    let output = run(&folder, &["mjcf", "a.xml", "-o", "a.rs", "--strict"]);
    assert_eq!(output.status.code(), Some(1));
    let message = "error: a.xml: not all of the file can be kept, so nothing is written:\n  line 1: `magic` of \
                   <option> is not used.\n";
    assert_eq!(told(&output), message);
    assert!(!folder.join("a.rs").exists());
    let output = run(&folder, &["mjcf", "a.xml", "-o", "a.rs"]);
    assert!(output.status.success() && folder.join("a.rs").exists());
    assert_eq!(told(&output), "note: line 1: `magic` of <option> is not used.\n");
}

#[test]
fn other_encodings_included_files_and_meshes_are_read() {
    let latin = b"<?xml version='1.0' encoding='ISO-8859-1'?><robot name='\xe9paule'><link name='a'/><link \
                  name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link><joint \
                  name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>";
    let main = "<mujoco><compiler meshdir='shapes'/><asset><mesh file='block.stl'/></asset>\n<include \
        file='parts/rod.xml'/></mujoco>";
    let rod = "<mujocoinclude>\n<worldbody><body name='rod' colour='red'><joint name='pin'/>\n<geom type='mesh' \
               mesh='block' density='6'/></body></worldbody></mujocoinclude>";
    let corner = |k: usize| ["0 0 0", "1 0 0", "0 1 0", "0 0 1"][k];
    let face = |[a, b, c]: [usize; 3]| {
        let corners = [a, b, c].map(|k| format!("vertex {}\n", corner(k))).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(face).concat();
    let stl = format!("solid block\n{faces}endsolid block\n");
    let folder = folder(
        "files",
        &[
            ("latin.urdf", &latin[..]),
            ("main.xml", main.as_bytes()),
            ("parts/rod.xml", rod.as_bytes()),
            ("shapes/block.stl", stl.as_bytes()),
        ],
    );
    let output = run(&folder, &["urdf", "latin.urdf"]);
    assert!(output.status.success(), "{}", told(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("The robot `épaule`"));
    let output = run(&folder, &["mjcf", "main.xml", "--no-contacts"]);
    assert_eq!(told(&output), "note: line 2 of parts/rod.xml: `colour` of <body> is not used.\n");
    assert!(String::from_utf8_lossy(&output.stdout).contains("mass 1;\n            center [0.25, 0.25, 0.25];"));
    std::fs::remove_file(folder.join("shapes/block.stl")).expect("it can go");
    let output = run(&folder, &["mjcf", "main.xml", "--no-contacts"]);
    assert!(
        told(&output).starts_with("error: main.xml: nothing moves") && !output.status.success(),
        "{}",
        told(&output)
    );
    let reason = "\n  line 3 of parts/rod.xml: shape is a mesh (block.stl: No such file";
    assert!(told(&output).contains(reason), "{}", told(&output));
}

#[test]
fn messages_do_not_write_to_the_screen_what_a_name_says() {
    let text = PENDULUM.replace("joint name='pin'", "joint name='pin' type='&#x202e;&#10;screw'");
    let folder = folder("names", &[("a.xml", text.as_bytes())]);
    let output = run(&folder, &["mjcf", "a.xml"]);
    assert!(!output.status.success());
    assert!(told(&output).contains("\\u{202e}") && !told(&output).contains('\u{202e}'), "{}", told(&output));
}
