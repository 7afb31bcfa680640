//! What is printed and written.

use std::io::Read;

use bg_workbench::linear::{StateSpace, logarithmic, responses_csv, responses_json};

use super::models::*;
use super::{at_rest, model};

fn oscillator() -> StateSpace {
    at_rest::<Oscillator>(&model(&[], &[3.0])).1
}

#[test]
fn the_table_shows_modes_and_what_is_left_out() {
    let text = at_rest::<Swing>(&model(&[("angle", -1.2)], &[])).1.table();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "Swing at t = 0.0 s: 6 states, 0 inputs, 2 outputs");
    assert_eq!(lines[1], "mode      real 1/s  imaginary rad/s  frequency Hz   damping  shape");
    let slow = "           4.9522       0.78816   0.00000  rod 100 %: position_x 1 m, rotation_z 3.33 rad";
    assert!(lines[2].starts_with("   1  ") && lines[2].ends_with(slow), "{text}");
    assert_eq!(lines.len(), 7, "{text}");
    assert_eq!(lines[5], "rod.orientation: 1 rotation for its 2 entries");
    assert_eq!(lines[6], "rod.angle: follows from the others");
}

#[test]
fn json_has_everything() {
    let linear = oscillator();
    let json: serde_json::Value = serde_json::from_str(&linear.json()).unwrap();
    assert_eq!(json["model"], "Oscillator");
    assert_eq!(json["states"][0]["name"], "spring.q");
    assert_eq!(json["states"][0]["unit"], "m");
    assert_eq!(json["a"][1][0], -200.0);
    assert_eq!(json["d"][3][0], 1.0);
    assert_eq!(json["point"][1]["value"], linear.point[1].value);
    assert_eq!(json["modes"][0]["shape"][1]["name"], "inertia.p");
    assert_eq!(json["modes"][0]["imaginary"], linear.modes[0].imaginary);
    let responses = linear.responses(&["force"], &["x", "v"], &[10.0]).unwrap();
    let json: serde_json::Value = serde_json::from_str(&responses_json(&responses)).unwrap();
    assert_eq!(json[1]["output"]["name"], "v");
}

#[test]
fn responses_are_columns() {
    let responses = oscillator().responses(&[], &["x"], &logarithmic(1.0, 100.0, 3)).unwrap();
    let text = responses_csv(&responses);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "angular_frequency (rad/s),frequency (Hz),x/force (m/(N)),phase of x/force (rad)");
    assert_eq!(lines.len(), 4);
    let row: Vec<f64> = lines[2].split(',').map(|number| number.parse().unwrap()).collect();
    // At its frequency: 1 / (c w), a quarter of a turn behind.
    assert!((row[0] - 10.0).abs() < 1e-13 && (row[2] - 1.0 / 40.0).abs() < 1e-15, "{text}");
    assert!((row[3] + std::f64::consts::FRAC_PI_2).abs() < 1e-13);
    let error = oscillator().responses(&["push"], &[], &[1.0]).unwrap_err();
    assert_eq!(error.to_string(), "there is no input `push`; the inputs are `force`");
    let (slowest, fastest) = oscillator().band();
    assert!((slowest - 1.0).abs() < 1e-12 && (fastest - 100.0).abs() < 1e-10);
}

/// The bytes of a file in an archive.
fn entry(archive: &[u8], name: &str) -> Vec<u8> {
    let zip = rawzip::ZipArchive::from_slice(archive).unwrap();
    let mut found = Vec::new();
    for entry in zip.entries() {
        let entry = entry.unwrap();
        if entry.file_path().as_ref() == name.as_bytes() {
            let entry_data = zip.get_entry(entry.wayfinder()).unwrap();
            entry_data.verifying_reader(entry_data.data()).read_to_end(&mut found).unwrap();
        }
    }
    found
}

#[test]
fn npz_has_the_arrays_of_numpy() {
    // `numpy.load` of numpy 2.4.6 reads these bytes: states ['spring.q' 'inertia.p'], A [[0, 0.5], [-200, -2]].
    let linear = oscillator();
    let bytes = linear.npz().unwrap();
    let a = entry(&bytes, "A.npy");
    assert_eq!(&a[..10], b"\x93NUMPY\x01\x00\x76\x00");
    let header = std::str::from_utf8(&a[10..128]).unwrap();
    assert!(
        header.starts_with("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2, ), }") && header.ends_with('\n')
    );
    let numbers = |bytes: &[u8]| {
        bytes.chunks(8).map(|number| f64::from_le_bytes(number.try_into().unwrap())).collect::<Vec<f64>>()
    };
    assert_eq!(numbers(&a[128..]), [0.0, 0.5, -200.0, -2.0]);
    let eigenvalues = entry(&bytes, "eigenvalues.npy");
    assert!(std::str::from_utf8(&eigenvalues[10..128]).unwrap().contains("'<c16'"));
    let mode = &linear.modes[0];
    assert_eq!(numbers(&eigenvalues[128..]), [mode.real, mode.imaginary, mode.real, -mode.imaginary]);
    let names = entry(&bytes, "states.npy");
    assert!(
        std::str::from_utf8(&names[10..128])
            .unwrap()
            .contains("'descr': '<U9', 'fortran_order': False, 'shape': (2, )")
    );
    assert_eq!(names[128..132], [b's', 0, 0, 0]);
    assert_eq!(names.len(), 128 + 2 * 9 * 4);
    assert!(!entry(&bytes, "point_names.npy").is_empty() && !entry(&bytes, "output_units.npy").is_empty());
}
