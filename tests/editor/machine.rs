//! The crate that the editor opens: a machine with marks in front of names, `/*rod*/`, and Rust code that uses it.

use std::path::Path;

/// A place in the text: line and column, from 0.
pub type Position = (usize, usize);

/// The crate's `src/lib.rs`.
pub const TEXT: &str = "//! A machine.

use bg_model::bond_graph;

bond_graph! {
    use gears;
    /// A leg of the machine.
    part /*Leg*/Leg {
        /// How stiff the knee is.
        param /*rate*/rate: N/m = 3000;
        body /*foot*/foot { mass 1; inertia [1, 1, 1]; point /*tip*/tip = [0.1, 0, 0]; }
        ground { point /*floor*/floor = [0, 0, 0]; }
        spring /*knee*/knee (ground./*floor in knee*/floor -> /*foot in knee*/foot./*tip in knee*/tip) { stiffness \
        /*rate in knee*/rate; damping 10; length 0.1; }
        observe { /*way*/way: m = /*foot in way*/foot.position.x }
    }

    /// A rod on a pin.
    pub graph /*Machine*/Machine {
        /// Length of the rod.
        param /*length*/length: m = 0.6, above 0;
        param /*mass*/mass: kg = 2;
        /// What turns the pin.
        input /*torque*/torque: N*m;

        ground { point /*pivot*/pivot = [0, 1, 0]; }
        body /*rod*/rod {
            mass /*mass in rod*/mass;
            inertia [1, 1, 1];
            point /*end*/end = [-/*length in end*/length / 2, 0, 0];
            start /*end in start*/end at [0, 1, 0];
        }
        joint /*pin*/pin: /*revolute*/revolute z (ground./*pivot in pin*/pivot -> /*rod in pin*/rod./*end in pin*/end) {
            /*stiffness*/stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1;
        }
        drive /*motor*/motor on /*pin in motor*/pin torque = /*torque in motor*/torque;
        /*friction*/friction /*rub*/rub on /*pin in rub*/pin { coulomb 0.1; }
        part /*left*/left: /*Leg in left*/Leg { /*rate in left*/rate = 2000; }
        part /*row*/row[2]: /*Leg in row*/Leg;
        part /*pair*/pair: /*GearPair*/GearPair { /*ratio in pair*/ratio = 4; }
        table /*curve*/curve: rad/s -> N*m = [[0, 2], [50, 1]], /*held*/held;
        1 /*hub*/hub: rotation; I /*wheel*/wheel = 2;
        /*pin in chain*/pin.spin -> /*pair in chain*/pair.first; /*pair again in chain*/pair.second -> /*hub in \
        chain*/hub -> wheel;

        observe {
            /*angle*/angle: rad = /*rod in observe*/rod.angle;
            force: N = /*pin in observe*/pin./*force*/force.x;
            /*left in observe*/left./*way in observe*/way;
            /*pair in observe*/pair./*torque in observe*/torque;
            left_over: N*m = /*curve in observe*/curve(/*abs*/abs(hub.flow)) * /*sin*/sin(/*t*/t / 1 s);
            slope: N*m*s/rad = /*curve again in observe*/curve./*derivative*/derivative(/*delay*/delay(hub.flow, 20 \
            ms));
            high: m = /*row in observe*/row[1]./*foot in observe*/foot./*tip in observe*/tip.position.y;
        }

        scene /*Still*/Still {
            observe { force: N = norm(/*pin in scene*/pin.force) }
            tune { /*length in scene*/length }
            without { /*motor in scene*/motor, /*rub in scene*/rub }
        }
    }
}

/// A long machine.
#[must_use]
pub fn long() -> MachineParameters {
    MachineParameters { /*length in Rust*/length: 2.0, ..MachineParameters::default() }
}

/// A machine that nothing drives.
pub type Idle = /*Still in Rust*/Still;
";

/// A place in the word after a mark: after its first letter, since in front of it rust-analyzer may think of the mark.
pub fn at(mark: &str) -> Position {
    let sign = format!("/*{mark}*/");
    let at = TEXT.find(&sign).unwrap_or_else(|| panic!("no mark {mark}")) + sign.len();
    position(TEXT, at + 1)
}

/// The mark in front of a position; without one the line and column from 1.
pub fn mark_at((line, column): Position) -> String {
    let before = TEXT.lines().nth(line).and_then(|line| line.get(..column)).unwrap_or_default();
    let mark = before.strip_suffix("*/").and_then(|before| before.rsplit_once("/*"));
    mark.map_or_else(|| format!("{}:{}", line + 1, column + 1), |(_, mark)| mark.to_owned())
}

/// A byte of a text of ASCII letters as line and column.
pub fn position(text: &str, at: usize) -> Position {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    (text[..at].matches('\n').count(), at - start)
}

/// Writes the crate into a folder. It has the versions of this workspace.
pub fn write(folder: &Path) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let manifest = format!(
        "[package]\nname = \"machine\"\nedition = \"2024\"\n\n[dependencies]\nbg-model.path = {:?}\n\n[workspace]\n\n\
         [profile.dev.package.bg-compiler]\nopt-level = 1\n",
        root.join("bg-model")
    );
    std::fs::create_dir_all(folder.join("src")).expect("a folder");
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("written");
    std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("copied");
    std::fs::write(folder.join("src/lib.rs"), TEXT).expect("written");
}
