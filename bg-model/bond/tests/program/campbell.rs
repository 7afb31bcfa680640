//! `campbell`: frequencies and critical speeds beside closed forms, what cannot be asked for; sweeps of three
//! parameters.

use super::{folder, refused, told, write};

/// A disc that may tilt in its bearing. With I about a diameter, 2 I about the axis, a stiffness k and the speed w the
/// tilt swings by I q'' -+ 2 I w q' i + k q = 0.
const ROTOR: &str = "
graph Rotor {
    param speed: rpm = 3000; param tilt: N*m/rad = 2000, above 0; param mass: kg = 5, above 0;
    ground { point bearing = [0, 0, 0]; }
    body disc { mass mass; inertia [0.02, 0.02, 0.04]; start spin [0, 0, speed]; }
    joint bearing: revolute z (ground.bearing -> disc) { stiffness 1e6; tilt stiffness tilt; }
    observe { x: rad = disc.z_axis.x; y: rad = disc.z_axis.y }
}";

/// Rows of a CSV file as numbers; a cell that is none is not-a-number.
fn rows(folder: &std::path::Path, file: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(file)).expect("a file");
    let cells = |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    text.lines().skip(1).map(cells).collect()
}

#[test]
fn a_tilting_disc_has_the_frequencies_and_critical_speeds_of_the_closed_form() {
    let folder = folder();
    write(&folder, "rotor.bond", ROTOR);
    let text = told(folder.path(), "campbell rotor.bond --by speed=0..12000 --points 41 --out o");
    let (own, turn) = (2000.0_f64 / 0.02, 2.0 * std::f64::consts::PI);
    for row in rows(folder.path(), "o/campbell.csv") {
        let [mode, rpm, frequency] = row[..3].try_into().expect("three numbers");
        let w = rpm * turn / 60.0;
        // Against the rotation, with it, three places of the bearing.
        let expected = match mode as u32 {
            1 => (w * w + own).sqrt() - w,
            2 => (w * w + own).sqrt() + w,
            _ => (1e6_f64 / 5.0).sqrt(),
        };
        assert!((frequency - expected / turn).abs() < 1e-9 * frequency, "{mode} at {rpm}: {frequency}");
    }
    // I w^2 n^2 + 2 I w^2 n = k against the rotation; with it the order 1 is never met and the order 2 is that of w =
    // infinity.
    let against = |order: f64| (own / (order * order + 2.0 * order)).sqrt() * 60.0 / turn;
    let places = |order: f64| (1e6_f64 / 5.0).sqrt() / order * 60.0 / turn;
    let expected: Vec<[f64; 2]> =
        [1.0, 2.0].iter().flat_map(|&n| [[n, against(n)], [n, places(n)], [n, places(n)], [n, places(n)]]).collect();
    let found = rows(folder.path(), "o/critical_speeds.csv");
    assert_eq!(found.len(), expected.len(), "{text}");
    for (row, [order, speed]) in found.iter().zip(expected) {
        assert!(row[0] == order && (row[1] - speed).abs() < 1e-9 * speed, "{row:?} {speed}");
    }
    assert!(text.contains("where an order of the speed meets a mode") && text.contains("1743.46"), "{text}");
    let svg = std::fs::read_to_string(folder.path().join("o/campbell.svg")).expect("a drawing");
    assert!(svg.contains("speed in rpm") && svg.contains("order 2") && svg.contains("critical speeds"), "{svg}");
}

#[test]
fn what_is_no_speed_has_no_orders_and_what_is_at_rest_no_slope() {
    let folder = folder();
    write(&folder, "rotor.bond", ROTOR);
    let text = told(folder.path(), "campbell rotor.bond --by speed=0..3000 --points 5 --start equilibrium");
    assert!(text.contains("no frequency depends on `speed`; at an equilibrium nothing moves"), "{text}");
    let text = told(folder.path(), "campbell rotor.bond --by tilt=500..4000 --points 5 --set speed=0 --out tilt");
    assert!(!text.contains("order"), "{text}");
    // Two frequencies that grow as the root.
    let tilting = rows(folder.path(), "tilt/campbell.csv").into_iter().filter(|row| row[0] < 3.0);
    assert!(tilting.clone().count() == 10);
    for row in tilting {
        assert!((row[2] - (row[1] / 0.02).sqrt() / std::f64::consts::TAU).abs() < 1e-9 * row[2], "{row:?}");
    }
    for (options, fault) in [
        ("--by tilt=500..4000 --orders 1", "--orders: `tilt` is in N*m/rad and no speed: leave --orders out"),
        ("--by sped=0..1", "--by: scene `literal` has no parameter `sped` to be asked for; did you mean `speed`?"),
        ("--by speed", "--by: speed: give it as NAME=FROM..TO, for example speed=0..3000"),
        ("--by speed=0..3000 --orders 0", "--orders 0: must be a number above 0"),
    ] {
        let told = refused(folder.path(), &format!("campbell rotor.bond {options}"), 2);
        assert!(told.contains(fault), "{told}");
    }
}

#[test]
fn a_sweep_of_three_parameters_has_parallel_axes() {
    let folder = folder();
    write(&folder, "rotor.bond", ROTOR);
    let grid = "t_end = 0.05\n[grid]\nspeed = [0, 1000, 2000]\ntilt = [1000, 2000]\nmass = [4, 5]\n";
    write(&folder, "plan.toml", &format!("{grid}[columns]\nx = ['max']\ny = ['max']\n"));
    let said = told(folder.path(), "sweep rotor.bond --plan plan.toml --out o");
    assert!(said.contains("`sweep rotor.bond show o` says what is there"), "{said}");
    assert!(told(folder.path(), "sweep rotor.bond show o").contains("runs     12 of 12"));
    let page = std::fs::read_to_string(folder.path().join("o/index.html")).expect("a page");
    // Of both numbers one figure with parallel axes, and one over each parameter.
    assert_eq!(page.matches("<figure>").count(), 8);
    assert!(page.contains("x_max of each run by speed, tilt, mass, in the colour of x_max"), "{page}");
}
